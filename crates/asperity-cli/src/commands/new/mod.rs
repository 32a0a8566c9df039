//! `asperity new`: a starter case, or a case with one's own files.

mod adhesion;
mod own;

use std::path::PathBuf;

use asperity_examples::{TEMPLATES, Template};
use asperity_io::output::write_all;

use crate::args::New;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::input::meant;
use crate::verb::{Threads, Verb};

impl Verb for New {
    fn threads(&self) -> Threads {
        Threads::None
    }

    fn files(&self) -> Files {
        Files::default().reads(self.from.iter().chain(&self.material))
    }

    /// Writes the starter case, or lists them; or writes a case with own files.
    fn run(&self) -> Result<(), Failure> {
        if let (Some(purpose), Some(from), Some(material)) = (self.purpose, &self.from, &self.material) {
            return own::write(self, purpose, from, material);
        }
        let Some(name) = &self.template else {
            let width = TEMPLATES.iter().map(|t| t.name.len()).max().unwrap_or(0);
            let list: String =
                TEMPLATES.iter().map(|t| format!("{:width$}  {}\n", t.name, t.title())).collect();
            return crate::print(&list);
        };
        let Some(template) = Template::find(name) else {
            let names: Vec<_> = TEMPLATES.iter().map(|t| t.name).collect();
            refuse!(
                "there is no starter case \"{name}\"{}; choose one of {}",
                meant(name, &names),
                names.join(", ")
            );
        };
        let path = self.path.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.toml")));
        write_all(&path, self.force, template.text.as_bytes())?;
        crate::messages::message!("wrote {}; run it with: asperity run {}", path.display(), path.display());
        Ok(())
    }
}
