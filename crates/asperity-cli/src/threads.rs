//! The threads of the whole command, started before anything else: a system that refuses them is told, where the first
//! parallel loop would panic.

use std::thread::available_parallelism;

use crate::failure::Failure;
use crate::launcher;
use crate::verb::Threads;

/// The limit of `--threads`, and of the variable `RAYON_NUM_THREADS`.
pub const MOST: u16 = 1024;

/// Starts the threads of a verb.
pub fn start(threads: Threads) -> Result<(), Failure> {
    let threads = match threads {
        Threads::None => return Ok(()),
        Threads::Default => match of_variable(std::env::var("RAYON_NUM_THREADS").ok()) {
            0 => of_cores(),
            given => given,
        },
        Threads::Number(number) => usize::from(number),
    };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(|error| {
        let many = if threads == 0 { "one thread per core".to_owned() } else { format!("{threads} threads") };
        Failure::System(format!(
            "cannot start {many}: {error}; ask for fewer with --threads or RAYON_NUM_THREADS"
        ))
    })
}

/// One per core that a launcher or the system (affinity, control group) gives this process; 0 where the system does not tell.
fn of_cores() -> usize {
    let Ok(cores) = available_parallelism() else { return 0 };
    launcher::threads(cores.get(), online().unwrap_or(cores.get())).min(usize::from(MOST))
}

/// Cores of the machine (Linux).
fn online() -> Option<usize> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    Some(text.lines().filter(|line| line.starts_with("processor")).count()).filter(|count| *count > 0)
}

/// The number in the variable, at most [`MOST`]; 0 where it holds none.
fn of_variable(value: Option<String>) -> usize {
    value.and_then(|text| text.trim().parse::<usize>().ok()).unwrap_or(0).min(usize::from(MOST))
}

#[cfg(test)]
mod tests {
    use super::of_variable;

    #[test]
    fn the_variable_is_capped_as_the_option_is() {
        let threads = |text: &str| of_variable(Some(text.to_owned()));
        assert_eq!((threads("3"), threads("1000000"), threads("-1"), threads("")), (3, 1024, 0, 0));
        assert_eq!(of_variable(None), 0);
    }
}
