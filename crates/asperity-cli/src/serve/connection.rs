//! One request of HTTP/1 and its answer on a connection, which then ends. No part of it takes longer than its limit, however slow
//! the other end is.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Time for a request to arrive.
const REQUEST: Duration = Duration::from_secs(10);
/// Time for a client to take more of an answer, and all of it.
const PAUSE: Duration = Duration::from_secs(10);
const ANSWER: Duration = Duration::from_secs(600);
/// Time for all of what is sent with a request.
const BODY: Duration = Duration::from_secs(600);
/// Time for the rest of a request after its answer.
const REST: Duration = Duration::from_secs(1);
/// Longest head of a request \[bytes\], and most headers in it.
const LONGEST_HEAD: usize = 16 << 10;
const MOST_HEADERS: usize = 100;

/// What is asked for.
#[derive(Debug, Default, PartialEq)]
pub struct Request {
    pub method: String,
    /// The path of the address, without what follows a question mark.
    pub path: String,
    /// What follows the question mark.
    pub query: String,
    /// The headers `Host`, `Origin` and `Sec-Fetch-Site`.
    pub host: Option<String>,
    pub origin: Option<String>,
    pub fetch_site: Option<String>,
    /// The header `Content-Length` \[bytes\]; 0 where there is none.
    pub length: u64,
    /// The part of what is sent with it that came with its head.
    begun: Vec<u8>,
}

/// What is sent with a request.
pub struct Body<'a> {
    stream: &'a TcpStream,
    begun: &'a [u8],
    left: u64,
    last: Instant,
}

impl<'a> Body<'a> {
    pub fn of(request: &'a Request, stream: &'a TcpStream) -> Body<'a> {
        Body { stream, begun: &request.begun, left: request.length, last: Instant::now() + BODY }
    }
}

impl Read for Body<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let wanted = usize::try_from(self.left).unwrap_or(usize::MAX).min(into.len());
        let length = match self.begun.is_empty() || wanted == 0 {
            false => (&mut self.begun).read(&mut into[..wanted])?,
            true if wanted == 0 => return Ok(0),
            true => {
                self.stream.set_read_timeout(Some(left(self.last)?.min(PAUSE)))?;
                (&mut &*self.stream).read(&mut into[..wanted])?
            }
        };
        if length == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        self.left -= length as u64;
        Ok(length)
    }
}

/// What is answered.
pub struct Response {
    /// Code and name of its status.
    pub status: &'static str,
    pub content_type: &'static str,
    pub content: Vec<u8>,
    /// What the content may do in a browser.
    pub policy: &'static str,
}

/// Of the program's own pages: they use what this server sends, and no other page shows them in a frame.
pub const OWN: &str = "default-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'self'";
/// Of files that others may have written: they may draw, but reach nothing of this server.
pub const FOREIGN: &str =
    "sandbox allow-scripts allow-downloads; default-src 'unsafe-inline' data: blob:; frame-ancestors 'self'";

impl Response {
    /// A few words.
    pub fn text(status: &'static str, words: &str) -> Response {
        Response { status, ..Response::of("text/plain; charset=utf-8", words) }
    }

    /// What was asked for.
    pub fn of(content_type: &'static str, content: impl Into<Vec<u8>>) -> Response {
        Response { status: "200 OK", content_type, content: content.into(), policy: OWN }
    }

    fn head(&self) -> String {
        // The address holds the token, so no other page may learn it.
        format!(
            "HTTP/1.1 {}\r\n\
             content-type: {}\r\n\
             content-length: {}\r\n\
             connection: close\r\n\
             cache-control: no-store\r\n\
             x-content-type-options: nosniff\r\n\
             referrer-policy: no-referrer\r\n\
             content-security-policy: {}\r\n\r\n",
            self.status,
            self.content_type,
            self.content.len(),
            self.policy,
        )
    }
}

/// Reads the head of a request; `None` where it is none.
pub fn read(mut stream: &TcpStream) -> io::Result<Option<Request>> {
    let last = Instant::now() + REQUEST;
    let mut head = Vec::new();
    let mut part = [0; 1024];
    loop {
        stream.set_read_timeout(Some(left(last)?))?;
        let length = stream.read(&mut part)?;
        head.extend_from_slice(&part[..length]);
        match parse(&head) {
            Ok(None) if length > 0 && head.len() < LONGEST_HEAD => {}
            parsed => return Ok(parsed.ok().flatten()),
        }
    }
}

/// The request of a head; `None` where more of it is to come.
fn parse(head: &[u8]) -> Result<Option<Request>, httparse::Error> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let httparse::Status::Complete(end) = parsed.parse(head)? else { return Ok(None) };
    let path = parsed.path.unwrap_or_default();
    let (path, query) = path.split_once('?').unwrap_or((path, ""));
    let mut request = Request {
        method: parsed.method.unwrap_or_default().to_owned(),
        path: path.to_owned(),
        query: query.to_owned(),
        begun: head[end..].to_vec(),
        ..Request::default()
    };
    let mut length = None;
    for header in parsed.headers {
        let place = match header.name.to_ascii_lowercase().as_str() {
            "host" => &mut request.host,
            "origin" => &mut request.origin,
            "content-length" => &mut length,
            "sec-fetch-site" => &mut request.fetch_site,
            // A body whose length is not told.
            "transfer-encoding" => return Err(httparse::Error::HeaderValue),
            _ => continue,
        };
        // If a header is repeated, the first one counts.
        place.get_or_insert_with(|| String::from_utf8_lossy(header.value).into_owned());
    }
    request.length =
        length.map_or(Ok(0), |text| text.trim().parse()).map_err(|_| httparse::Error::HeaderValue)?;
    Ok(Some(request))
}

/// Sends an answer.
pub fn write(mut stream: &TcpStream, response: &Response) -> io::Result<()> {
    let last = Instant::now() + ANSWER;
    for mut part in [response.head().as_bytes(), &response.content] {
        while !part.is_empty() {
            stream.set_write_timeout(Some(left(last)?.min(PAUSE)))?;
            match stream.write(part)? {
                0 => return Err(io::ErrorKind::WriteZero.into()),
                sent => part = &part[sent..],
            }
        }
    }
    Ok(())
}

/// Ends a connection. Closing it with unread bytes of the request would cut the answer off: they are read, for a short time.
pub fn end(mut stream: &TcpStream) -> io::Result<()> {
    stream.shutdown(Shutdown::Write)?;
    let last = Instant::now() + REST;
    let mut part = [0; 1024];
    loop {
        stream.set_read_timeout(Some(left(last)?))?;
        if stream.read(&mut part)? == 0 {
            return Ok(());
        }
    }
}

/// The time until then; an error where it has passed.
fn left(last: Instant) -> io::Result<Duration> {
    let left = last.saturating_duration_since(Instant::now());
    if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(left) }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    /// Both ends of a connection.
    fn ends() -> (TcpStream, TcpStream) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        (client, listener.accept().unwrap().0)
    }

    #[test]
    fn a_request_is_read_from_its_pieces() {
        let (mut client, server) = ends();
        for piece in ["GET /abc/state?n=2 HTTP/1.1\r\nHo", "st: localhost:80\r\nSec-Fetch-Site: none\r\n\r\n"]
        {
            client.write_all(piece.as_bytes()).unwrap();
        }
        let request = read(&server).unwrap().unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str()), ("GET", "/abc/state"));
        assert_eq!(request.host.as_deref(), Some("localhost:80"));
        assert_eq!(request.fetch_site.as_deref(), Some("none"));
    }

    #[test]
    fn a_body_is_as_long_as_it_was_said_to_be() {
        let (mut client, server) = ends();
        client.write_all(b"POST /save HTTP/1.1\r\nContent-Length: 7\r\n\r\nabc").unwrap();
        let request = read(&server).unwrap().unwrap();
        client.write_all(b"defg and more").unwrap();
        let mut text = String::new();
        Body::of(&request, &server).read_to_string(&mut text).unwrap();
        assert_eq!((request.length, text.as_str()), (7, "abcdefg"));
        let (mut client, server) = ends();
        client.write_all(b"POST / HTTP/1.1\r\nContent-Length: 7\r\n\r\nabc").unwrap();
        let request = read(&server).unwrap().unwrap();
        client.shutdown(Shutdown::Write).unwrap();
        let error = Body::of(&request, &server).read_to_end(&mut vec![]).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof, "one that ends early is no whole one");
    }

    #[test]
    fn what_is_no_request_is_none() {
        for text in [
            "GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
            "\0\0\r\n\r\n",
            "GET /\r\n\r\n",
            "GET / HTTP/1.1\r\nHost",
            &"a".repeat(LONGEST_HEAD),
        ] {
            let (mut client, server) = ends();
            client.write_all(text.as_bytes()).unwrap();
            client.shutdown(Shutdown::Write).unwrap();
            assert_eq!(read(&server).unwrap(), None, "{text}");
        }
    }

    #[test]
    fn a_client_that_takes_nothing_is_given_up() {
        let (_client, server) = ends();
        let mut stream = &server;
        stream.set_write_timeout(Some(Duration::from_millis(20))).unwrap();
        let mut sent = Ok(());
        while sent.is_ok() {
            sent = stream.write_all(&[0; 1 << 16]);
        }
        let kind = sent.unwrap_err().kind();
        assert!(matches!(kind, io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut), "{kind:?}");
    }
}
