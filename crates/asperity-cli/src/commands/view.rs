//! `asperity view`: the page of a result, served to a browser.
//!
//! Whoever knows the address may read the result. Its first part is a random token, as other users of the machine can find
//! the port. The header `Host` must name this machine, so that no page of another name that leads here reads results.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use asperity_io::store::Reader;
use asperity_report::page::{Answer, Live};
use http_body_util::Full;
use hyper::body::{Bytes, Incoming};
use hyper::header::{self, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::TcpListener;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::AbortHandle;
use tokio::time::timeout;

use super::write_timeout::WriteTimeout;
use crate::args::View;
use crate::failure::Failure;

/// Connections at a time: more than browsers open.
const CONNECTIONS: usize = 128;
/// Answers at a time that may be as large as a map; they are held in memory until they are sent.
const LARGE_ANSWERS: usize = 4;
/// Time for a request to arrive, for a client to take more of an answer, and for a large answer to find a place.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);
/// Time for an answer to be sent in all.
const LONGEST: Duration = Duration::from_secs(600);

/// Serves until it is interrupted.
pub fn run(args: &View) -> Result<(), Failure> {
    // What cannot be shown is told before anything listens.
    Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    let failed = |error: std::io::Error| Failure::input(format!("cannot listen at {}: {error}", args.host));
    let token = token()?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(failed)?;
    runtime.block_on(async {
        let listener = TcpListener::bind(SocketAddr::new(args.host, args.port)).await.map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        crate::print(&format!("http://{address}/{token}/\n"))?;
        crate::messages::message!(
            "open this address in a browser; who knows it can read the result; press Ctrl-C to stop"
        );
        serve(listener, Server::new(&args.result, args.host, token)).await;
        Ok(())
    })
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
    large: Arc<Semaphore>,
}

impl Server {
    fn new(result: &Path, host: IpAddr, token: String) -> Server {
        let name = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
        Server {
            live: Live::new(result),
            host,
            token,
            name: name.map(|name| name.trim().to_lowercase()),
            large: Arc::new(Semaphore::new(LARGE_ANSWERS)),
        }
    }
}

async fn serve(listener: TcpListener, server: Server) {
    let server = Arc::new(server);
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut open = Open::default();
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // Out of file handles, say: wait instead of asking again and again.
            tokio::time::sleep(Duration::from_millis(100)).await;
            continue;
        };
        if places.available_permits() == 0 {
            open.close_a_silent_one();
        }
        let Ok(place) = places.clone().acquire_owned().await else { return };
        let server = server.clone();
        let has_asked = Arc::new(AtomicBool::new(false));
        let asks = has_asked.clone();
        let task = tokio::spawn(async move {
            let service = service_fn(|request| {
                asks.store(true, Ordering::Relaxed);
                answer(request, server.clone())
            });
            let mut connection = http1::Builder::new();
            connection.timer(TokioTimer::new()).header_read_timeout(WRITE_TIMEOUT).keep_alive(false);
            let stream = WriteTimeout::new(TokioIo::new(stream), WRITE_TIMEOUT);
            // A browser that hangs up early is no failure.
            let _ = timeout(LONGEST, connection.serve_connection(stream, service)).await;
            drop(place);
        });
        open.add(task.abort_handle(), has_asked);
    }
}

/// The open connections, the oldest first, each with whether its request has arrived.
#[derive(Default)]
struct Open(VecDeque<(AbortHandle, Arc<AtomicBool>)>);

impl Open {
    fn add(&mut self, task: AbortHandle, has_asked: Arc<AtomicBool>) {
        self.0.retain(|(task, _)| !task.is_finished());
        self.0.push_back((task, has_asked));
    }

    /// Closes the oldest connection whose request has not arrived: those who open many and ask nothing keep nobody out.
    fn close_a_silent_one(&mut self) {
        let is_silent = |(task, has_asked): &&(AbortHandle, Arc<AtomicBool>)| {
            !task.is_finished() && !has_asked.load(Ordering::Relaxed)
        };
        if let Some((task, _)) = self.0.iter().find(is_silent) {
            task.abort();
        }
    }
}

async fn answer(
    request: Request<Incoming>,
    server: Arc<Server>,
) -> Result<Response<Full<Bytes>>, Infallible> {
    let header = |name| request.headers().get(name).and_then(|value: &HeaderValue| value.to_str().ok());
    if !is_this_machine(header("host"), server.host, server.name.as_deref()) {
        return Ok(text(StatusCode::FORBIDDEN, "only requests to this machine by its name are answered"));
    }
    if header("sec-fetch-site") == Some("cross-site") {
        return Ok(text(StatusCode::FORBIDDEN, "requests of other sites are not answered"));
    }
    if request.method() != Method::GET {
        return Ok(text(StatusCode::METHOD_NOT_ALLOWED, "only GET"));
    }
    let path = request.uri().path().strip_prefix('/').unwrap_or_default();
    let (token, path) = path.split_at_checked(server.token.len()).unwrap_or_default();
    if !same(token, &server.token) || !path.starts_with('/') {
        return Ok(text(StatusCode::FORBIDDEN, "open the address that `asperity view` printed, all of it"));
    }
    let path = path.to_owned();
    let place = match timeout(WRITE_TIMEOUT, server.large.clone().acquire_owned()).await {
        Ok(Ok(place)) => place,
        _ => return Ok(text(StatusCode::SERVICE_UNAVAILABLE, "too many requests at a time; try again")),
    };
    // Reading and packing a map takes a while; others are answered meanwhile.
    let answered = tokio::task::spawn_blocking(move || server.live.answer(&path)).await;
    Ok(match answered {
        Ok(Ok(Some(answer))) => content(answer, place),
        Ok(Ok(None)) => text(StatusCode::NOT_FOUND, "there is nothing here"),
        Ok(Err(error)) => text(StatusCode::NOT_FOUND, &error.to_string()),
        Err(error) => text(StatusCode::INTERNAL_SERVER_ERROR, &error.to_string()),
    })
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

/// An answer, whose place among the large ones is free again when it is sent or given up.
struct Held {
    content: Vec<u8>,
    _place: OwnedSemaphorePermit,
}

impl AsRef<[u8]> for Held {
    fn as_ref(&self) -> &[u8] {
        &self.content
    }
}

fn content(answer: Answer, place: OwnedSemaphorePermit) -> Response<Full<Bytes>> {
    let held = Held { content: answer.content, _place: place };
    response(StatusCode::OK, answer.content_type, Bytes::from_owner(held))
}

fn text(status: StatusCode, words: &str) -> Response<Full<Bytes>> {
    response(status, "text/plain; charset=utf-8", words.to_owned().into())
}

fn response(status: StatusCode, content_type: &'static str, content: Bytes) -> Response<Full<Bytes>> {
    let mut response = Response::new(Full::new(content));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(content_type));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    // The address holds the token.
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(
        header::CONTENT_SECURITY_POLICY,
        HeaderValue::from_static("default-src 'self' 'unsafe-inline'; frame-ancestors 'none'"),
    );
    response
}

#[cfg(test)]
mod tests {
    use super::{Open, is_this_machine, same, token};
    use std::net::IpAddr;
    use std::sync::Arc;

    #[test]
    fn the_oldest_connection_without_a_request_is_closed() {
        let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
        runtime.block_on(async {
            let mut open = Open::default();
            let [asked, first, second] = [true, false, false].map(|has_asked| {
                let task = tokio::spawn(std::future::pending::<()>());
                open.add(task.abort_handle(), Arc::new(has_asked.into()));
                task
            });
            open.close_a_silent_one();
            assert!(first.await.unwrap_err().is_cancelled());
            assert!(!asked.is_finished() && !second.is_finished());
            open.close_a_silent_one();
            assert!(second.await.unwrap_err().is_cancelled());
            open.close_a_silent_one();
            assert!(!asked.is_finished());
        });
    }

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
