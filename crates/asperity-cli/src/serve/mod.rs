//! Pages for browsers: what `asperity view` and `asperity app` serve.
//!
//! Whoever knows the address may use them. Its first part is a random token, as other users of the machine can find the port. The
//! header `Host` must name this machine, and `Origin` the same server, so that no page of another name reads or changes anything.

mod connection;
mod places;

use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::time::Duration;

pub use self::connection::{Body, FOREIGN, Request, Response};
use self::places::{Open, Places};
use crate::failure::Failure;

/// Connections at a time: more than browsers open.
const CONNECTIONS: usize = 128;
/// Answers at a time that may be as large as a map; they are held in memory until they are sent.
const LARGE_ANSWERS: usize = 8;
/// Time that a large answer waits for a place.
const LONGEST_WAIT: Duration = Duration::from_secs(10);
/// Pause before the next connection is taken where none can be.
const PAUSE: Duration = Duration::from_millis(20);

/// What answers.
pub trait Site: Send + Sync + 'static {
    /// The answer to a request; `path` is what follows the token.
    fn answer(&self, request: &Request, path: &str, body: Body<'_>) -> Response;

    /// The methods that are answered.
    fn methods(&self) -> &'static [&'static str] {
        &["GET"]
    }
}

/// An address of its own, at which nobody is answered yet.
pub struct Opened {
    listener: TcpListener,
    host: IpAddr,
    token: String,
    /// "http://127.0.0.1:40123/TOKEN/".
    pub address: String,
}

/// Listens at a port of an address; 0 chooses a free one.
pub fn open(host: IpAddr, port: u16) -> Result<Opened, Failure> {
    let failed = |error: std::io::Error| Failure::input(format!("cannot listen at {host}: {error}"));
    let token = token()?;
    let listener = TcpListener::bind(SocketAddr::new(host, port)).map_err(failed)?;
    let address = format!("http://{}/{token}/", listener.local_addr().map_err(failed)?);
    Ok(Opened { listener, host, token, address })
}

impl Opened {
    /// Answers until the process ends.
    pub fn serve(self, site: impl Site) -> ! {
        let Opened { listener, host, token, .. } = self;
        let name = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
        let name = name.map(|name| name.trim().to_lowercase());
        serve(&listener, &Arc::new(Server { site, host, token, name, large: Places::new(LARGE_ANSWERS) }))
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
struct Server<S> {
    site: S,
    host: IpAddr,
    token: String,
    /// Name of this machine, where the system tells.
    name: Option<String>,
    large: Places,
}

impl<S: Site> Server<S> {
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
        let response = self.site.answer(&request, path, Body::of(&request, stream));
        connection::write(stream, &response)
    }

    /// What is asked for, below the token, where the request may ask for it.
    fn permitted<'a>(&self, request: &'a Request) -> Result<&'a str, Response> {
        let refuse = |words| Err(Response::text("403 Forbidden", words));
        if !is_this_machine(request.host.as_deref(), self.host, self.name.as_deref()) {
            return refuse("only requests to this machine by its name are answered");
        }
        let own = request.host.as_ref().map(|host| format!("http://{host}"));
        let is_foreign = request.origin.is_some() && request.origin != own;
        if is_foreign || request.fetch_site.as_deref() == Some("cross-site") {
            return refuse("requests of other sites are not answered");
        }
        let methods = self.site.methods();
        if !methods.contains(&request.method.as_str()) {
            return Err(Response::text("405 Method Not Allowed", &format!("only {}", methods.join(", "))));
        }
        let path = request.path.strip_prefix('/').unwrap_or_default();
        let (token, path) = path.split_at_checked(self.token.len()).unwrap_or_default();
        if !same(token, &self.token) || !path.starts_with('/') {
            return refuse("open the address that asperity printed, all of it");
        }
        Ok(path)
    }
}

/// Takes connections, each on a thread of its own.
fn serve<S: Site>(listener: &TcpListener, server: &Arc<Server<S>>) -> ! {
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
        let _ = std::thread::Builder::new().stack_size(crate::STACK).spawn(move || {
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
