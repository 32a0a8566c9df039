//! The threads of the whole command, started before anything else: a system that refuses them is told, where the first
//! parallel loop would panic.

use crate::failure::Failure;
use crate::verb::Threads;

/// The limit of `--threads`, and of the variable `RAYON_NUM_THREADS`.
pub const MOST: u16 = 1024;

/// Starts the threads of a verb.
pub fn start(threads: Threads) -> Result<(), Failure> {
    let threads = match threads {
        Threads::None => return Ok(()),
        Threads::Default => of_variable(std::env::var("RAYON_NUM_THREADS").ok()),
        Threads::Number(number) => usize::from(number),
    };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(|error| {
        let many = if threads == 0 { "one thread per core".to_owned() } else { format!("{threads} threads") };
        Failure::System(format!(
            "cannot start {many}: {error}; ask for fewer with --threads or RAYON_NUM_THREADS"
        ))
    })
}

/// The number in the variable, at most [`MOST`]; 0, one per core, where it holds none.
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
