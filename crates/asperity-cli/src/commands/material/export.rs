//! `asperity material export`: a material for another program.

use asperity::material::Lateral;
use asperity_io::case::{Specimen, specimens};
use asperity_io::material_export::{Exported, text};
use asperity_io::output::write_all;

use crate::args::MaterialExport;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::verb::Verb;

impl Verb for MaterialExport {
    fn files(&self) -> Files {
        Files::default().reads([&self.file]).writes(&self.output).force(self.force)
    }

    /// Writes or prints it.
    fn run(&self) -> Result<(), Failure> {
        let specimens = specimens(&self.file, &self.set, None)?;
        let specimen = chosen(&specimens, self)?;
        let poisson = self.poisson.map(|poisson| Lateral::Poisson(poisson.get()));
        let (material, shift) = specimen.at_reference()?;
        let lateral = poisson.or(specimen.lateral);
        let vertical = specimen.report.vertical_law.as_ref();
        let exported = Exported { name: &specimen.name, material: &material, lateral, shift, vertical };
        let help = if lateral.is_none() { " (--poisson NU)" } else { "" };
        let text = text(&exported, self.to)
            .map_err(|error| Failure::input(format!("{}: {error}{help}", self.file.display())))?;
        match &self.output {
            Some(path) => Ok(write_all(path, self.force, text.as_bytes())?),
            None => crate::print(&text),
        }
    }
}

/// The body that is named, or the only one that is viscoelastic.
fn chosen<'a>(specimens: &'a [Specimen], args: &MaterialExport) -> Result<&'a Specimen, Failure> {
    let names: Vec<&str> = specimens.iter().map(|specimen| specimen.name.as_str()).collect();
    let names = names.join(", ");
    let is_viscoelastic = |specimen: &Specimen| {
        let creep = specimen.material.creep();
        !creep.terms.is_empty() || creep.fluidity > 0.0
    };
    let mut suited = specimens.iter().filter(|specimen| match &args.body {
        Some(name) => specimen.name == *name,
        None => is_viscoelastic(specimen),
    });
    let path = args.file.display();
    match (suited.next(), suited.next(), &args.body) {
        (Some(found), None, _) | (Some(found), _, Some(_)) => Ok(found),
        (None, _, Some(name)) => {
            refuse!("--body is \"{name}\", but the bodies are {names}")
        }
        (None, _, None) => refuse!("{path}: no body is viscoelastic ({names})"),
        (Some(_), Some(_), None) => {
            refuse!("{path}: one body must be chosen with --body: {names}")
        }
    }
}
