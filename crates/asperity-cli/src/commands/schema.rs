//! `asperity schema`.

use crate::failure::Failure;

/// Prints the JSON Schema of the case file.
pub fn run() -> Result<(), Failure> {
    let schema = asperity_io::case::schema();
    let text = serde_json::to_string_pretty(&schema)
        .map_err(|error| Failure::input(format!("cannot write the schema: {error}")))?;
    crate::print(&format!("{text}\n"))
}
