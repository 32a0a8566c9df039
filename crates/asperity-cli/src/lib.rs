//! The command `asperity`, as a function: the program of this crate calls it, and so does the Python package, whose wheel
//! carries the command in this way.
//!
//! Data goes to stdout, messages to stderr. Exit codes: 0 done; 1 the solve or the system failed, or a result is damaged; 2 the
//! input is wrong; 130 interrupted.

mod args;
mod commands;
mod failure;
mod files;
mod format;
mod input;
mod interrupt;
mod launcher;
mod messages;
mod progress;
mod serve;
mod terminal;
mod threads;
mod trace;
mod verb;

use std::ffi::OsString;
use std::io::Write;
use std::thread::JoinHandle;

use clap::Parser;

use args::{Args, Command};
use failure::Failure;

/// Runs a command line, whose first word is the name of the program, and returns the exit code. It starts the threads of
/// the process and listens to its signals, so a process calls it once and ends with what it returns.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    interrupt::outlive_large_files();
    // The stack of the process may be as small as its user's limit.
    let thread = std::thread::Builder::new().name("asperity".into()).stack_size(STACK);
    let own = words.clone();
    match thread.spawn(move || command_here(&own)).map(JoinHandle::join) {
        Ok(Ok(code)) => code,
        Ok(Err(panic)) => std::panic::resume_unwind(panic),
        Err(_) => command_here(&words),
    }
}

/// As much as the systems give a process.
const STACK: usize = 8 << 20;

fn command_here(words: &[OsString]) -> u8 {
    let code = match Args::try_parse_from(words) {
        Ok(args) => obey(&args),
        Err(error) if commands::plot::lacks_figure(words, &error) => {
            let failure = commands::plot::no_figure();
            failure.print();
            failure.code()
        }
        Err(error) => {
            if words.iter().any(|word| word.to_string_lossy().contains(messages::hidden)) {
                messages::write(&messages::printable(&error.to_string()));
            } else {
                // A reader that has gone needs no help text.
                let _ = error.print();
            }
            u8::try_from(error.exit_code()).unwrap_or(2)
        }
    };
    // A program of its own would flush at its end; inside of another one nobody does.
    let _ = std::io::stdout().flush();
    code
}

fn obey(args: &Args) -> u8 {
    trace::listen(if let Command::Run(run) = &args.command { run.verbose } else { 0 });
    match args.command.verb().carry_out() {
        Ok(()) => 0,
        Err(failure) => {
            failure.print();
            failure.code()
        }
    }
}

/// Writes data to stdout. A reader that has gone (`asperity schema | head`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout()
        .write_all(messages::printable(text).as_bytes())
        .and_then(|()| std::io::stdout().flush())
    {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::System(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
