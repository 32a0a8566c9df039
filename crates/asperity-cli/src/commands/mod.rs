//! One file per command.

pub mod check;
pub mod completions;
pub mod export;
pub mod findings;
pub mod fit_indentation;
pub mod leak;
pub mod material;
pub mod new;
mod patience;
pub mod plot;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod schema;
pub mod show;
pub mod stress;
pub mod surface;
pub mod verify;
pub mod verify_result;
pub mod view;

use std::path::Path;

use crate::failure::Failure;

/// Refuses a path where there is something already that `force` does not allow to replace.
fn free(path: &Path, force: bool) -> Result<(), Failure> {
    if path.exists() && !force {
        let path = path.display();
        return Err(Failure::input(format!("{path} already exists; choose another file or use --force")));
    }
    Ok(())
}
