//! Long work while Python goes on: other threads of Python run, and Ctrl-C is heard.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often Python is asked whether somebody pressed Ctrl-C.
const PAUSE: Duration = Duration::from_millis(50);

/// Does `work` on another thread without holding Python; Ctrl-C raises `interrupt` and is passed on after the work
/// has ended.
pub fn without_python<T: Send>(
    py: Python<'_>,
    interrupt: &AtomicBool,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    py.detach(|| {
        std::thread::scope(|scope| {
            let (done, wait) = channel();
            // Inside the pool: a sweep called from a worker starts sooner.
            scope.spawn(move || done.send(rayon::scope(|_| work())));
            let mut signal = Ok(());
            loop {
                match wait.recv_timeout(PAUSE) {
                    Ok(value) => return signal.map(|()| value),
                    Err(RecvTimeoutError::Timeout) if signal.is_ok() => {
                        signal = Python::attach(|py| py.check_signals());
                        interrupt.store(signal.is_err(), Ordering::Relaxed);
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(PyRuntimeError::new_err(
                            "the work ended without an answer: a fault of asperity",
                        ));
                    }
                }
            }
        })
    })
}
