//! `asperity schema`.

use crate::args::Schema;
use crate::failure::Failure;
use crate::verb::{Threads, Verb};

impl Verb for Schema {
    fn threads(&self) -> Threads {
        Threads::None
    }

    /// Prints the JSON Schema of the case file.
    fn run(&self) -> Result<(), Failure> {
        let schema = asperity_io::case::schema();
        crate::print(&format!("{}\n", serde_json::to_string_pretty(&schema)?))
    }
}
