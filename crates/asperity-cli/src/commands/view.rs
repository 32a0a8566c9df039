//! `asperity view`: the page of a result, served to a browser on this machine.

use std::convert::Infallible;
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
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
use tokio::sync::Semaphore;

use crate::args::View;
use crate::failure::Failure;

/// Connections at a time: more than browsers open.
const CONNECTIONS: usize = 32;
/// Time for a request to arrive.
const PATIENCE: Duration = Duration::from_secs(20);

/// Serves until it is interrupted.
pub fn run(args: &View) -> Result<(), Failure> {
    // What cannot be shown is told before anything listens.
    Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    let told = |error: std::io::Error| Failure::input(format!("cannot listen at {}: {error}", args.host));
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(told)?;
    runtime.block_on(async {
        let listener = TcpListener::bind(SocketAddr::new(args.host, args.port)).await.map_err(told)?;
        let address = listener.local_addr().map_err(told)?;
        crate::print(&format!("http://{address}/\n"))?;
        crate::talk::say!("open this address in a browser; press Ctrl-C to stop");
        serve(listener, Live::new(&args.result), args.host).await;
        Ok(())
    })
}

async fn serve(listener: TcpListener, live: Live, host: IpAddr) {
    let live = Arc::new(live);
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    loop {
        let Ok(place) = places.clone().acquire_owned().await else { return };
        let Ok((stream, _)) = listener.accept().await else {
            // Out of file handles, say: wait instead of asking again and again.
            tokio::time::sleep(Duration::from_millis(100)).await;
            continue;
        };
        let live = live.clone();
        tokio::spawn(async move {
            let service = service_fn(|request| answer(request, live.clone(), host));
            let mut connection = http1::Builder::new();
            connection.timer(TokioTimer::new()).header_read_timeout(PATIENCE).keep_alive(false);
            // A browser that hangs up early is no failure.
            let _ = connection.serve_connection(TokioIo::new(stream), service).await;
            drop(place);
        });
    }
}

async fn answer(
    request: Request<Incoming>,
    live: Arc<Live>,
    host: IpAddr,
) -> Result<Response<Full<Bytes>>, Infallible> {
    let asked = request.headers().get(header::HOST).and_then(|host| host.to_str().ok());
    if host.is_loopback() && !is_this_machine(asked) {
        // A page from elsewhere whose name leads here must not read results.
        return Ok(text(StatusCode::FORBIDDEN, "only requests to localhost are answered".into()));
    }
    if request.method() != Method::GET {
        return Ok(text(StatusCode::METHOD_NOT_ALLOWED, "only GET".into()));
    }
    let path = request.uri().path().to_owned();
    // Reading and packing a map takes a while; others are answered meanwhile.
    let answered = tokio::task::spawn_blocking(move || live.answer(&path)).await;
    Ok(match answered {
        Ok(Ok(Some(answer))) => content(answer),
        Ok(Ok(None)) => text(StatusCode::NOT_FOUND, "there is nothing here".into()),
        Ok(Err(error)) => text(StatusCode::NOT_FOUND, error.to_string()),
        Err(error) => text(StatusCode::INTERNAL_SERVER_ERROR, error.to_string()),
    })
}

/// Whether a request names this machine as the one it wants.
fn is_this_machine(host: Option<&str>) -> bool {
    let Some(host) = host else { return false };
    let name =
        host.rsplit_once(':').filter(|(_, port)| port.parse::<u16>().is_ok()).map_or(host, |(name, _)| name);
    let address = name.trim_start_matches('[').trim_end_matches(']');
    name == "localhost" || address.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}

fn content(answer: Answer) -> Response<Full<Bytes>> {
    response(StatusCode::OK, answer.content_type, answer.content)
}

fn text(status: StatusCode, words: String) -> Response<Full<Bytes>> {
    response(status, "text/plain; charset=utf-8", words.into_bytes())
}

fn response(status: StatusCode, content_type: &'static str, content: Vec<u8>) -> Response<Full<Bytes>> {
    let mut response = Response::new(Full::new(Bytes::from(content)));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(content_type));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(
        header::CONTENT_SECURITY_POLICY,
        HeaderValue::from_static("default-src 'self' 'unsafe-inline'; frame-ancestors 'none'"),
    );
    response
}

#[cfg(test)]
mod tests {
    use super::is_this_machine;

    #[test]
    fn only_names_of_this_machine_are_answered() {
        for name in ["localhost", "localhost:8000", "127.0.0.1", "127.0.0.1:80", "[::1]:9000", "[::1]"] {
            assert!(is_this_machine(Some(name)), "{name}");
        }
        for name in ["example.org", "localhost.example.org:80", "192.168.1.4", "127.0.0.1.example.org", ""] {
            assert!(!is_this_machine(Some(name)), "{name}");
        }
        assert!(!is_this_machine(None));
    }
}
