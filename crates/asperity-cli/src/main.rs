//! The command `asperity`.
//!
//! Data goes to stdout, talk to stderr. Exit codes: 0 done; 1 the solve or the system failed, or a result is damaged; 2 the
//! input is wrong; 130 interrupted.

mod args;
mod commands;
mod failure;
mod interrupt;
mod progress;
mod talk;
mod terminal;
mod threads;
mod trace;
mod words;

use std::process::ExitCode;

use clap::Parser;

use args::{Args, Command};
use failure::Failure;

fn main() -> ExitCode {
    let args = Args::parse();
    trace::listen(if let Command::Run(run) = &args.command { run.verbose } else { 0 });
    match threads::start(&args.command).and_then(|()| run(args.command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.tell();
            ExitCode::from(failure.code())
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Run(run) => commands::run::run(&run),
        Command::Check(check) => commands::check::run(&check),
        Command::New(new) => commands::new::run(&new),
        Command::Verify(verify) => commands::verify::run(&verify),
        Command::Surface(surface) => commands::surface::run(&surface),
        Command::Show(show) => commands::show::run(&show),
        Command::VerifyResult(verify) => commands::verify_result::run(&verify),
        Command::Report(report) => commands::report::run(&report),
        Command::View(view) => commands::view::run(&view),
        Command::Stress(stress) => commands::stress::run(&stress),
        Command::Compare(compare) => commands::compare::run(&compare),
        Command::Plot(plot) => commands::plot::run(&plot),
        Command::Leak(leak) => commands::leak::run(&leak),
        Command::Material(material) => commands::material::run(&material),
        Command::FitIndentation(fit) => commands::fit_indentation::run(&fit),
        Command::Export(export) => commands::export::run(&export),
        Command::Reproduce(reproduce) => commands::reproduce::run(&reproduce),
        Command::Schema => commands::schema::run(),
        Command::Completions { shell } => commands::completions::run(shell),
    }
}

/// Writes data to stdout. A reader that has gone (`asperity schema | head`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match std::io::stdout()
        .write_all(talk::printable(text).as_bytes())
        .and_then(|()| std::io::stdout().flush())
    {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::input(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
