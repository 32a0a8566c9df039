//! Where a fit goes: its material into a file or on the screen, its figure into a file, its numbers as one object or in lines.

use asperity_io::output::write_all;
use asperity_report::figure::Figure;
use serde_json::{Value, json};

use crate::args::FitOutput;
use crate::commands::picture;
use crate::failure::Failure;
use crate::files::Files;

impl FitOutput {
    /// The files that are written.
    pub fn files(&self) -> Files {
        Files::default().writes(&self.output).draws(&self.plot).force(self.force)
    }

    /// Writes, draws and prints a fit; `block` is its material for a case.
    pub fn deliver(
        &self,
        block: &str,
        figure: impl FnOnce() -> asperity::Result<Figure>,
        object: impl FnOnce() -> Value,
        report: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        if let Some(path) = &self.output {
            write_all(path, self.force, block.as_bytes())?;
        }
        if let Some(path) = &self.plot {
            picture::write(&figure()?, path, self.force)?;
        }
        if self.json {
            let mut object = object();
            object["output"] = json!(self.output);
            object["material"] = json!(block);
            return crate::print(&format!("{object}\n"));
        }
        let end = match &self.output {
            Some(path) => format!("written     {}\n", path.display()),
            None => format!("\n{block}"),
        };
        crate::print(&(report() + &end))
    }
}
