//! How many may be served at a time.

use std::collections::VecDeque;
use std::net::{Shutdown, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError, Weak};
use std::time::Duration;

/// An open connection.
pub struct Connection {
    stream: TcpStream,
    has_asked: AtomicBool,
}

impl Connection {
    pub fn stream(&self) -> &TcpStream {
        &self.stream
    }

    /// Notes that its request has arrived.
    pub fn has_asked(&self) {
        self.has_asked.store(true, Ordering::Relaxed);
    }
}

/// The open connections, the oldest first.
#[derive(Default)]
pub struct Open(VecDeque<Weak<Connection>>);

impl Open {
    /// A connection more; it is open until it is dropped.
    pub fn add(&mut self, stream: TcpStream) -> Arc<Connection> {
        let connection = Arc::new(Connection { stream, has_asked: AtomicBool::new(false) });
        self.0.push_back(Arc::downgrade(&connection));
        connection
    }

    pub fn count(&mut self) -> usize {
        self.0.retain(|connection| connection.strong_count() > 0);
        self.0.len()
    }

    /// Closes the oldest connection whose request has not arrived: those who open many and ask nothing keep nobody out.
    pub fn close_a_silent_one(&self) {
        let mut open = self.0.iter().filter_map(Weak::upgrade);
        if let Some(silent) = open.find(|connection| !connection.has_asked.load(Ordering::Relaxed)) {
            let _ = silent.stream.shutdown(Shutdown::Both);
        }
    }
}

/// A number of places, of which each is taken by one at a time.
pub struct Places {
    free: Mutex<usize>,
    freed: Condvar,
}

/// A place that is free again when this is dropped.
pub struct Place<'a>(&'a Places);

impl Places {
    pub fn new(free: usize) -> Places {
        Places { free: Mutex::new(free), freed: Condvar::new() }
    }

    /// A place; `None` where none becomes free for so long.
    pub fn take(&self, longest: Duration) -> Option<Place<'_>> {
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.freed.wait_timeout_while(free, longest, |free| *free == 0);
        let (mut free, _) = waited.unwrap_or_else(PoisonError::into_inner);
        *free = free.checked_sub(1)?;
        Some(Place(self))
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        *self.0.free.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        self.0.freed.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;
    use std::net::TcpListener;

    use super::*;

    #[test]
    fn the_oldest_connection_without_a_request_is_closed() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut clients = vec![];
        let mut open = Open::default();
        let [asked, first, second] = [true, false, false].map(|has_asked| {
            clients.push(TcpStream::connect(listener.local_addr().unwrap()).unwrap());
            let connection = open.add(listener.accept().unwrap().0);
            if has_asked {
                connection.has_asked();
            }
            connection
        });
        let is_closed = |connection: &Connection| {
            connection.stream.set_nonblocking(true).unwrap();
            matches!(connection.stream().read(&mut [0]), Ok(0))
        };
        assert_eq!(open.count(), 3);
        open.close_a_silent_one();
        assert!(is_closed(&first) && !is_closed(&second) && !is_closed(&asked));
        drop(first);
        assert_eq!(open.count(), 2);
        open.close_a_silent_one();
        assert!(is_closed(&second) && !is_closed(&asked));
        drop(second);
        open.close_a_silent_one();
        assert!(!is_closed(&asked));
    }

    #[test]
    fn a_place_is_taken_by_one_at_a_time() {
        let places = Places::new(1);
        let place = places.take(Duration::ZERO);
        assert!(place.is_some() && places.take(Duration::from_millis(1)).is_none());
        drop(place);
        assert!(places.take(Duration::ZERO).is_some());
    }
}
