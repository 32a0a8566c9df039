//! Ctrl-C, a closed terminal, and the end of a session: they raise a flag, and a run stops after the iteration under way.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A flag that the first signal raises; the second ends the process at once with exit code 130. Signals that whoever
/// started the process had it ignore (`nohup`) stay ignored.
pub fn flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    listen(&flag);
    flag
}

/// Lets a write beyond the largest size of a file (`ulimit -f`) be an error, where the system would end the process.
pub fn outlive_large_files() {
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

#[cfg(unix)]
fn listen(flag: &Arc<AtomicBool>) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let ignored = ignored(&std::fs::read_to_string("/proc/self/status").unwrap_or_default());
    for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored & (1 << (signal - 1)) == 0) {
        // Without a handler the signal still ends the process, and the result stays readable. The shutdown comes first: it
        // looks whether an earlier signal raised the flag.
        let _ = signal_hook::flag::register_conditional_shutdown(signal, 130, flag.clone());
        let _ = signal_hook::flag::register(signal, flag.clone());
    }
}

#[cfg(not(unix))]
fn listen(flag: &Arc<AtomicBool>) {
    use std::sync::atomic::Ordering;
    let raised = flag.clone();
    let _ = ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}

/// The ignored signals in /proc/self/status, bit n - 1 for signal n; none where the system has no such file.
#[cfg(unix)]
fn ignored(status: &str) -> u64 {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(all(test, unix))]
mod tests {
    #[test]
    fn ignored_signals_are_read_from_the_status() {
        assert_eq!(super::ignored("Name: a\nSigBlk: 0000000000000002\nSigIgn:\t0000000000001001\n"), 0x1001);
        assert_eq!(super::ignored(""), 0);
    }
}
