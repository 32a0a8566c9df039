//! The program `asperity`.

fn main() -> std::process::ExitCode {
    asperity_cli::command(std::env::args_os()).into()
}
