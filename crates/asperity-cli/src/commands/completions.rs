//! `asperity completions`.

use clap::CommandFactory;

use crate::args::{Args, Completions};
use crate::failure::Failure;
use crate::verb::{Threads, Verb};

impl Verb for Completions {
    fn threads(&self) -> Threads {
        Threads::None
    }

    /// Prints the completions for a shell.
    fn run(&self) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Args::command(), "asperity", &mut script);
        crate::print(&String::from_utf8_lossy(&script))
    }
}
