//! The arguments of the application in the browser.

use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct App {
    /// The folder to work in: its cases, data and results are shown, and new ones are written there
    #[arg(default_value = ".")]
    pub folder: PathBuf,
    /// Port to listen at, on this machine only; 0 chooses a free one
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// Only print the address, and open no browser
    #[arg(long)]
    pub no_open: bool,
}
