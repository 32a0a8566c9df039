//! The command as a user meets it, in one program.

mod answers;
mod app;
mod cli;
mod findings;
mod indentation;
mod leak;
mod line;
mod material;
mod new;
mod peers;
mod plot;
mod seal;
mod stress;
mod study;
mod surface;
mod validity;

use std::path::Path;
use std::process::{Command, Output};

/// The program with these arguments, in a directory.
fn command(directory: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.args(arguments).current_dir(directory);
    command
}

fn asperity(directory: &Path, arguments: &[&str]) -> Output {
    command(directory, arguments).output().unwrap()
}
