//! `asperity view`: the page of a result, served to a browser.
//!
//! Whoever knows the address may read the result. Its first part is a random token, as other users of the machine can find
//! the port. The header `Host` must name this machine, so that no page of another name that leads here reads results.

mod connection;
mod places;

use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use asperity_io::store::Reader;
use asperity_report::page::Live;

use self::connection::{Request, Response};
use self::places::{Open, Places};
use crate::args::View;
use crate::failure::Failure;
use crate::verb::Verb;

/// Connections at a time: more than browsers open.
const CONNECTIONS: usize = 128;
/// Answers at a time that may be as large as a map; they are held in memory until they are sent.
const LARGE_ANSWERS: usize = 4;
/// Time that a large answer waits for a place.
const LONGEST_WAIT: Duration = Duration::from_secs(10);
/// Pause before the next connection is taken where none can be.
const PAUSE: Duration = Duration::from_millis(20);

impl Verb for View {
    /// Serves until it is interrupted.
    fn run(&self) -> Result<(), Failure> {
        // What cannot be shown is told before anything listens.
        Reader::open(&self.result)?;
        let failed =
            |error: std::io::Error| Failure::input(format!("cannot listen at {}: {error}", self.host));
        let token = token()?;
        let listener = TcpListener::bind(SocketAddr::new(self.host, self.port)).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        crate::print(&format!("http://{address}/{token}/\n"))?;
        crate::messages::message!(
            "open this address in a browser; who knows it can read the result; press Ctrl-C to stop"
        );
        serve(&listener, &Arc::new(Server::new(&self.result, self.host, token)))
    }
}

/// 128 random bits.
fn token() -> Result<String, Failure> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)
        .map_err(|error| Failure::System(format!("the system gives no random numbers: {error}")))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// What is served, and to whom.
struct Server {
    live: Live,
    host: IpAddr,
    token: String,
    /// Name of this machine, where the system tells.
    name: Option<String>,
    large: Places,
}

impl Server {
    fn new(result: &Path, host: IpAddr, token: String) -> Server {
        let name = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
        Server {
            live: Live::new(result),
            host,
            token,
            name: name.map(|name| name.trim().to_lowercase()),
            large: Places::new(LARGE_ANSWERS),
        }
    }

    /// Reads the request of a connection and answers it.
    fn answer(&self, stream: &TcpStream, has_asked: impl FnOnce()) -> std::io::Result<()> {
        let Some(request) = connection::read(stream)? else {
            return connection::write(
                stream,
                &Response::text("400 Bad Request", "this is no request of HTTP/1"),
            );
        };
        has_asked();
        let path = match self.permitted(&request) {
            Ok(path) => path,
            Err(refusal) => return connection::write(stream, &refusal),
        };
        // The place is held until the answer is sent.
        let Some(_place) = self.large.take(LONGEST_WAIT) else {
            let busy = Response::text("503 Service Unavailable", "too many requests at a time; try again");
            return connection::write(stream, &busy);
        };
        let response = match self.live.answer(path) {
            Ok(Some(answer)) => {
                Response { status: "200 OK", content_type: answer.content_type, content: answer.content }
            }
            Ok(None) => Response::text("404 Not Found", "there is nothing here"),
            Err(error) => Response::text("404 Not Found", &error.to_string()),
        };
        connection::write(stream, &response)
    }

    /// What is asked for, below the token, where the request may ask for it.
    fn permitted<'a>(&self, request: &'a Request) -> Result<&'a str, Response> {
        let refuse = |words| Err(Response::text("403 Forbidden", words));
        if !is_this_machine(request.host.as_deref(), self.host, self.name.as_deref()) {
            return refuse("only requests to this machine by its name are answered");
        }
        if request.fetch_site.as_deref() == Some("cross-site") {
            return refuse("requests of other sites are not answered");
        }
        if request.method != "GET" {
            return Err(Response::text("405 Method Not Allowed", "only GET"));
        }
        let path = request.path.strip_prefix('/').unwrap_or_default();
        let (token, path) = path.split_at_checked(self.token.len()).unwrap_or_default();
        if !same(token, &self.token) || !path.starts_with('/') {
            return refuse("open the address that `asperity view` printed, all of it");
        }
        Ok(path)
    }
}

/// Takes connections, each on a thread of its own.
fn serve(listener: &TcpListener, server: &Arc<Server>) -> ! {
    let mut open = Open::default();
    loop {
        // Fails where there are no file handles left, for instance.
        let Ok((stream, _)) = listener.accept() else {
            std::thread::sleep(PAUSE);
            continue;
        };
        while open.count() >= CONNECTIONS {
            open.close_a_silent_one();
            std::thread::sleep(PAUSE);
        }
        let connection = open.add(stream);
        let server = server.clone();
        // A connection without a thread is closed. A browser that hangs up early is no failure.
        let _ = std::thread::Builder::new().spawn(move || {
            let answered = server.answer(connection.stream(), || connection.has_asked());
            answered.and_then(|()| connection::end(connection.stream()))
        });
    }
}

/// Whether two texts are the same, in a time that does not tell where they differ.
fn same(one: &str, other: &str) -> bool {
    let differences = one.bytes().zip(other.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    one.len() == other.len() && differences == 0
}

/// Whether a request names this machine as the one it wants. A server for this machine alone answers to its loopback names;
/// one for others also to addresses, which no foreign page can have as its name, and to the `machine`'s own name.
fn is_this_machine(host: Option<&str>, listening: IpAddr, machine: Option<&str>) -> bool {
    let Some(host) = host else { return false };
    let name =
        host.rsplit_once(':').filter(|(_, port)| port.parse::<u16>().is_ok()).map_or(host, |(name, _)| name);
    let address = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
    if name == "localhost" || address.as_ref().is_ok_and(IpAddr::is_loopback) {
        return true;
    }
    let name = name.to_lowercase();
    let first = |name: &str| name.split('.').next().unwrap_or_default().to_owned();
    let is_named =
        machine.is_some_and(|machine| !machine.is_empty() && (name == machine || name == first(machine)));
    !listening.is_loopback() && (address.is_ok() || is_named)
}

#[cfg(test)]
mod tests {
    use std::net::IpAddr;

    use super::{is_this_machine, same, token};

    #[test]
    fn only_names_of_this_machine_are_answered() {
        let loopback: IpAddr = "127.0.0.1".parse().unwrap();
        let any: IpAddr = "0.0.0.0".parse().unwrap();
        let named = |name: &str, listening| is_this_machine(Some(name), listening, Some("lab7.example.org"));
        for name in ["localhost", "localhost:8000", "127.0.0.1", "127.0.0.1:80", "[::1]:9000", "[::1]"] {
            assert!(named(name, loopback) && named(name, any), "{name}");
        }
        for name in ["192.168.1.4", "192.168.1.4:8000", "[fe80::1]:80", "lab7", "LAB7.example.org:80"] {
            assert!(!named(name, loopback) && named(name, any), "{name}");
        }
        for name in ["example.org", "localhost.example.org:80", "127.0.0.1.example.org", "lab7.evil.org", ""]
        {
            assert!(!named(name, loopback) && !named(name, any), "{name}");
        }
        assert!(!is_this_machine(None, any, None));
    }

    #[test]
    fn tokens_are_long_and_differ() {
        let (one, other) = (token().unwrap(), token().unwrap());
        assert_eq!(one.len(), 32);
        assert!(same(&one, &one) && !same(&one, &other) && !same(&one, &one[1..]) && !same("", &one));
    }
}
