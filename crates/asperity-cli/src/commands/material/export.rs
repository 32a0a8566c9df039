//! `asperity material export`: a material for another program.

use asperity::material::Lateral;
use asperity_io::case::{Specimen, specimens};
use asperity_io::material_export::{Exported, Program, text};
use asperity_io::quantity::{Number, range};

use super::{failed, parsed, write};
use crate::args::{MaterialExport, To};
use crate::failure::Failure;
use crate::verb::{Paths, Verb};

impl Verb for MaterialExport {
    fn reads(&self) -> Paths<'_> {
        vec![Some(&self.file)]
    }

    fn writes(&self) -> Paths<'_> {
        vec![self.output.as_ref()]
    }

    /// Writes or prints it.
    fn run(&self) -> Result<(), Failure> {
        if let Some(path) = &self.output {
            crate::commands::free(path, self.force)?;
        }
        let specimens = specimens(&self.file, &self.set, None)?;
        let specimen = chosen(&specimens, self)?;
        let poisson = match &self.poisson {
            Some(text) => Some(Lateral::Poisson(parsed::<Number<range::Poisson>>("--poisson", text)?.get())),
            None => None,
        };
        let (material, shift) = specimen.at_reference().map_err(failed)?;
        let lateral = poisson.or(specimen.lateral);
        let vertical = specimen.report.vertical_law.as_ref();
        let exported = Exported { name: &specimen.name, material: &material, lateral, shift, vertical };
        let program = match self.to {
            To::Abaqus => Program::Abaqus,
            To::Ansys => Program::Ansys,
            To::Comsol => Program::Comsol,
            To::Csv => Program::Csv,
        };
        let help = if lateral.is_none() { " (--poisson NU)" } else { "" };
        let text = text(&exported, program)
            .map_err(|error| Failure::input(format!("{}: {error}{help}", self.file.display())))?;
        match &self.output {
            Some(path) => write(path, &text, self.force),
            None => crate::print(&text),
        }
    }
}

/// The body that is named, or the only one that is viscoelastic.
fn chosen<'a>(specimens: &'a [Specimen], args: &MaterialExport) -> Result<&'a Specimen, Failure> {
    let names: Vec<&str> = specimens.iter().map(|specimen| specimen.name.as_str()).collect();
    let names = names.join(", ");
    let viscoelastic = |specimen: &&Specimen| {
        let creep = specimen.material.creep();
        !creep.terms.is_empty() || creep.fluidity > 0.0
    };
    match &args.body {
        Some(name) => specimens
            .iter()
            .find(|specimen| specimen.name == *name)
            .ok_or_else(|| Failure::input(format!("--body is \"{name}\", but the bodies are {names}"))),
        None => {
            let mut several = specimens.iter().filter(viscoelastic);
            match (several.next(), several.next()) {
                (Some(only), None) => Ok(only),
                (None, _) => {
                    Err(Failure::input(format!("{}: no body is viscoelastic ({names})", args.file.display())))
                }
                _ => Err(Failure::input(format!(
                    "{}: one body must be chosen with --body: {names}",
                    args.file.display()
                ))),
            }
        }
    }
}
