//! Long work while Python goes on: other threads of Python run, and Ctrl-C is heard.
//!
//! The work runs in a pool of threads that Python can size ([`set_threads`]). A forked process has none of its
//! parent's threads: it gets a pool of its own, else its first call would wait for ever.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Answer, Failure};

/// How often Python is asked whether somebody pressed Ctrl-C.
const PAUSE: Duration = Duration::from_millis(50);

/// The threads of this process.
struct Pool {
    /// The process that made it.
    process: u32,
    /// Number of threads asked for; 0: as many as there are processors, or as RAYON_NUM_THREADS says.
    size: usize,
    threads: Arc<ThreadPool>,
}

static POOL: Mutex<Option<Pool>> = Mutex::new(None);
/// More threads than any machine has.
const MOST_THREADS: usize = 4096;

fn made(size: usize) -> PyResult<Pool> {
    let threads = ThreadPoolBuilder::new().num_threads(size).build();
    let threads = threads.map_err(|error| PyRuntimeError::new_err(format!("no threads: {error}")))?;
    Ok(Pool { process: std::process::id(), size, threads: Arc::new(threads) })
}

fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut held = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let size = match held.take() {
        Some(pool) if pool.process == std::process::id() => {
            let threads = pool.threads.clone();
            *held = Some(pool);
            return Ok(threads);
        }
        Some(forked) => {
            let size = forked.size;
            // Its threads are the parent's: nothing here to end.
            std::mem::forget(forked);
            size
        }
        None => 0,
    };
    let new = made(size)?;
    let threads = new.threads.clone();
    *held = Some(new);
    Ok(threads)
}

/// Sets the number of threads of this process; None: as many as there are processors.
#[pyfunction]
pub fn set_threads(number: Option<usize>) -> Answer<()> {
    if let Some(number) = number.filter(|n| *n == 0 || *n > MOST_THREADS) {
        return Err(Failure::case(format!(
            "number of threads is {number}, but must be from 1 to {MOST_THREADS}"
        )));
    }
    pool()?; // of a forked process, so that none is ended that is not here
    let new = made(number.unwrap_or(0))?;
    *POOL.lock().unwrap_or_else(PoisonError::into_inner) = Some(new);
    Ok(())
}

/// Number of threads that work in this process.
#[pyfunction]
pub fn threads() -> PyResult<usize> {
    Ok(pool()?.current_num_threads())
}

/// Does short `work` in the pool without holding Python.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = pool()?;
    Ok(py.detach(|| pool.install(work)))
}

/// Does `work` on another thread without holding Python; Ctrl-C raises `interrupt` and is passed on after the work
/// has ended.
pub fn without_python<T: Send>(
    py: Python<'_>,
    interrupt: &AtomicBool,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let pool = pool()?;
    py.detach(|| {
        std::thread::scope(|scope| {
            let (done, wait) = channel();
            // Inside the pool: a sweep called from a worker starts sooner.
            let pool = &*pool;
            scope.spawn(move || done.send(pool.install(work)));
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
                            "internal error: the computation ended without a result; please report it",
                        ));
                    }
                }
            }
        })
    })
}
