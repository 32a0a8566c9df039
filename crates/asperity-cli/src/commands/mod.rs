//! One file per command.

pub mod check;
pub mod completions;
pub mod export;
pub mod findings;
pub mod fit_indentation;
pub mod leak;
pub mod material;
pub mod new;
pub mod plot;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod schema;
pub mod show;
pub mod stress;
pub mod surface;
pub mod verify;
pub mod view;

use std::path::Path;

use crate::failure::Failure;

/// Sets the number of threads of the whole command.
fn use_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|error| Failure::input(format!("cannot start {threads} threads: {error}")))
}

/// Refuses a path where there is something already that `force` does not allow to replace.
fn free(path: &Path, force: bool) -> Result<(), Failure> {
    if path.exists() && !force {
        let path = path.display();
        return Err(Failure::input(format!("{path} already exists; choose another file or use --force")));
    }
    Ok(())
}
