//! A verb of the command line: its arguments say what it reads and writes, how many threads it takes, and how it runs.
//!
//! A new one is an implementation of [`Verb`] in a file of `commands`, its arguments, and a line in the list of `args`.

use std::path::PathBuf;

use crate::failure::Failure;
use crate::{output_paths, threads};

/// Paths, some of which may not be given.
pub type Paths<'a> = Vec<Option<&'a PathBuf>>;

/// Arguments that can be carried out.
pub trait Verb {
    /// Does it.
    fn run(&self) -> Result<(), Failure>;

    /// The files and results that it reads and may not replace.
    fn reads(&self) -> Paths<'_> {
        vec![]
    }

    /// The files that an option tells it to write.
    fn writes(&self) -> Paths<'_> {
        vec![]
    }

    /// The threads that it takes.
    fn threads(&self) -> Threads {
        Threads::Default
    }

    /// Does it, once its outputs replace no input and its threads have started.
    fn carry_out(&self) -> Result<(), Failure> {
        output_paths::check(&self.reads(), &self.writes())?;
        threads::start(self.threads())?;
        self.run()
    }
}

/// The threads that a verb takes.
pub enum Threads {
    /// It computes nothing.
    None,
    /// As many as the variable `RAYON_NUM_THREADS` says, else one per core.
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
