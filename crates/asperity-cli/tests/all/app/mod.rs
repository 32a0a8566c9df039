//! The application in the browser: what it refuses, and a whole piece of work in a real browser.

#[cfg(unix)]
mod browser;
mod pictures;
mod server;
#[cfg(unix)]
mod work;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};

use serde_json::Value;

/// An application on a folder, which ends with the test.
pub struct App {
    child: Child,
    /// "127.0.0.1:40123" and the token.
    pub host: String,
    pub token: String,
}

impl App {
    pub fn start(folder: &Path) -> App {
        let mut child = crate::command(folder, &["app", "--no-open"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let (host, token) = address.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
        App { child, host: host.to_owned(), token: token.trim_end_matches('/').to_owned() }
    }

    #[cfg(unix)]
    pub fn address(&self) -> String {
        format!("http://{}/{}/", self.host, self.token)
    }

    /// Status and content of an answer; `head` may hold further headers.
    pub fn ask(&self, method: &str, path: &str, head: &str, body: &[u8]) -> (u16, Vec<u8>) {
        let path = format!("/{}/{path}", self.token);
        raw(
            &self.host,
            &format!(
                "{method} {path} HTTP/1.1\r\nHost: {}\r\n{head}Content-Length: {}\r\n\r\n",
                self.host,
                body.len()
            ),
            body,
        )
    }

    pub fn get(&self, path: &str) -> (u16, String) {
        let (status, content) = self.ask("GET", path, "", b"");
        (status, String::from_utf8_lossy(&content).into_owned())
    }

    pub fn post(&self, path: &str, content: &Value) -> (u16, Value) {
        let (status, content) = self.ask("POST", path, "", content.to_string().as_bytes());
        let text = String::from_utf8_lossy(&content).into_owned();
        (status, serde_json::from_str(&text).unwrap_or(Value::String(text)))
    }

    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for App {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Status and content of the answer to these bytes.
fn raw(host: &str, head: &str, body: &[u8]) -> (u16, Vec<u8>) {
    let mut stream = TcpStream::connect(host).unwrap();
    stream.write_all(head.as_bytes()).unwrap();
    // A refusal may come before all is sent.
    let _ = stream.write_all(body);
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let end =
        answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap_or_else(|| panic!("no answer to {head}"));
    (String::from_utf8_lossy(&answer[9..12]).parse().unwrap(), answer[end + 4..].to_vec())
}
