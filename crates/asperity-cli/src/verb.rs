//! A verb of the command line: its arguments say which files it reads and writes, how many threads it takes, and how it runs.
//!
//! A new one is an implementation of [`Verb`] in a file of `commands`, its arguments, and a line in the list of `args`.

use crate::failure::Failure;
use crate::files::Files;
use crate::threads;

/// Arguments that can be carried out.
pub trait Verb {
    /// Does it.
    fn run(&self) -> Result<(), Failure>;

    /// The files that it reads, and those that it writes unless they exist.
    fn files(&self) -> Files {
        Files::default()
    }

    /// The threads that it takes.
    fn threads(&self) -> Threads {
        Threads::Default
    }

    /// Does it, once its files are checked and its threads have started.
    fn carry_out(&self) -> Result<(), Failure> {
        self.files().check()?;
        threads::start(self.threads())?;
        self.run()
    }
}

/// The threads that a verb takes.
pub enum Threads {
    /// It computes nothing.
    None,
    /// As many as the variable `RAYON_NUM_THREADS` says, else one per core that a launcher or the system gives the process.
    Default,
    /// As many as an option says.
    Number(u16),
}

impl Threads {
    /// Those of an option --threads.
    pub fn of(option: Option<u16>) -> Threads {
        option.map_or(Threads::Default, Threads::Number)
    }
}
