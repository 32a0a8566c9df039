//! A study: a case run for several values of some of its keys, in one folder.
//!
//! ```text
//! study.json        what the study is: text of the case, keys, values
//! NAME.zarr         the result of each run; its name says its values
//! NAME.error        why a run failed
//! study.csv         a row for each run: values, status, answers
//! study.zarr        the same for xarray, with the keys as dimensions
//! ```
//!
//! Several processes, on one machine or on many that share the folder, may work on one study: the store lets one process at a time
//! write a result, so no run is computed twice. A run that was stopped or killed goes on from its checkpoint.
//!
//! `asperity study` and the Python package run studies through here.

mod dataset;
mod folder;
mod plan;
mod rows;
mod table;
mod values;
mod work;

use std::io;
use std::path::PathBuf;

use crate::case::CaseErrors;
use crate::store::StoreError;

pub use dataset::is_dataset;
pub use folder::Study;
pub use plan::{Plan, Run, Varied};
pub use rows::{Row, State};
pub use table::{Column, Table};
pub use values::Value;
pub use work::{Event, Options, Outcome};

/// Why a study cannot be made or go on. Single runs that fail are no error of the study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The case is wrong, or a value that a key takes.
    #[error(transparent)]
    Case(#[from] CaseErrors),
    /// What was asked for is wrong: keys, values, a folder that belongs to another study.
    #[error("{0}")]
    Input(String),
    /// A file of the folder cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried: "read", "write".
        action: &'static str,
        /// What the system reports.
        source: io::Error,
    },
    /// A result is damaged.
    #[error(transparent)]
    Store(#[from] StoreError),
}
