//! Materials to look at: those of a case, or of a file that holds the lines of a `[[body]]`, as the fits
//! write them.

use std::path::Path;

use asperity::material::{Lateral, Material, Shift};

use super::place::Checks;
use super::text::Text;
use super::{Case, CaseErrors, MaterialReport, document, file_text, overridden, warmth};

/// A material with its name and where it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Specimen {
    /// Name of the body, or of the file.
    pub name: String,
    /// The material as the run has it: at the temperature of the body where it is constant, else at the reference
    /// temperature of its shift.
    pub material: Material,
    /// Poisson's ratio or bulk modulus of the body, where the file is a case.
    pub lateral: Option<Lateral>,
    /// Where it comes from, and how well it is known.
    pub report: MaterialReport,
    /// Warnings about the numbers.
    pub warnings: Vec<String>,
}

impl Specimen {
    /// The material at the reference temperature of its shift, and the shift.
    ///
    /// # Errors
    /// [`asperity::Error`] where its times leave the range of numbers.
    pub fn at_reference(&self) -> asperity::Result<(Material, Option<&Shift>)> {
        let factor = self.report.shift_factor.unwrap_or(1.0);
        let moduli = self.report.vertical_factor.unwrap_or(1.0);
        Ok((self.material.stretched(1.0 / factor)?.scaled(moduli)?, self.report.law.as_ref()))
    }
}

/// The materials of a case file, or the one of a file that holds `material = { ... }` and other lines of a `[[body]]`. Fractional
/// models are Prony sums over the times of the run; in a file of their own over `window` \[s\], or else eight decades about
/// their time.
///
/// # Errors
/// [`CaseErrors`] where the file cannot be read, or with what is wrong in it.
pub fn specimens(
    path: &Path,
    overrides: &[String],
    window: Option<[f64; 2]>,
) -> Result<Vec<Specimen>, CaseErrors> {
    let (name, text) = file_text(path, "a case file, or a file with a material")?;
    let source = overridden(&name, text, overrides)?.text;
    let alone = Text::parse(&source)
        .is_ok_and(|text| text.root.get("material").is_some() && text.root.get("domain").is_none());
    if !alone {
        let case = Case::read(path, overrides)?;
        let bodies = case.bodies.into_iter().zip(case.materials);
        let mut specimens: Vec<Specimen> = bodies
            .map(|(body, report)| Specimen {
                name: body.name,
                material: body.material,
                lateral: Some(body.lateral),
                report,
                warnings: Vec::new(),
            })
            .collect();
        if let Some(first) = specimens.first_mut() {
            first.warnings = case.findings.into_iter().map(|finding| finding.text).collect();
        }
        return Ok(specimens);
    }
    let stem = path.file_stem().map_or("material".into(), |stem| stem.to_string_lossy().into_owned());
    let dir = path.parent().unwrap_or(Path::new(""));
    let made = Text::parse(&source).and_then(|text| {
        let (material, checks) = (document::material(&text)?, Checks::new(&text, dir));
        let place = checks.at("material");
        checks.finish(material.sample(&place).and_then(|sample| warmth::alone(&place, &sample, window)))
    });
    match made {
        Ok((material, report)) => {
            let report = MaterialReport { body: stem.clone(), ..report };
            Ok(vec![Specimen { name: stem, material, lateral: None, report, warnings: Vec::new() }])
        }
        Err(errors) => Err(CaseErrors { name, source, errors }),
    }
}
