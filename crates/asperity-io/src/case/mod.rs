//! Case files: TOML text with units to the objects of the solver.
//!
//! ```text
//! text --overrides--> text --read--> Document --assemble--> Case --simulation--> asperity's Simulation
//!                                     (one key)   (many keys)      (files, gap)
//! ```
//!
//! A fault is reported with its key, line and value, what was expected and what to do: see [`CaseErrors`].
//! The format is described by its JSON [`schema`], which is made from the same structs that read it, one for each table, and by
//! the commented examples of the crate `asperity-examples`.
//!
//! ```
//! use asperity_io::case::Case;
//!
//! let text = r#"
//!     [domain]
//!     cells = [32, 32]
//!     size = ["1 mm", "1 mm"]
//!     [[surface]]
//!     kind = "sphere"
//!     radius = "10 mm"
//!     [[body]]
//!     poisson = 0.3
//!     material = { model = "elastic", young = "210 GPa" }
//!     [load]
//!     control = "load"
//!     history = { kind = "step", value = "5 N" }
//!     [time]
//!     end = "1 s"
//!     steps = 1
//! "#;
//! let case = Case::parse(text, ".".as_ref(), &["load.history.value=8 N".into()])?;
//! assert_eq!(case.conditions.grid.spacing(), [1e-3 / 32.0; 2]); // metres
//! assert_eq!(case.conditions.loading.stages[0].course.resolve(0.0).after(0.0), 8.0); // newtons
//!
//! let errors = Case::parse(&text.replace("210 GPa", "210 mm"), ".".as_ref(), &[]).unwrap_err();
//! assert_eq!(errors.errors[0].key, "body[0].material.young");
//! assert_eq!(errors.errors[0].line, Some(10));
//! # Ok::<(), asperity_io::case::CaseErrors>(())
//! ```

mod adhesion;
mod assemble;
mod bare;
mod body;
mod border;
mod cost;
mod describe;
mod document;
mod domain;
mod edit;
mod error;
mod examine;
mod flash;
mod form;
pub mod fragment;
pub mod given;
mod hardness;
mod history;
mod history_file;
mod keys;
mod leak_keys;
mod leakage;
mod list;
mod load;
mod material;
mod measured;
mod motion;
mod output;
mod overrides;
mod pair;
mod place;
mod plan;
mod prepare;
mod read;
mod roughness;
mod schema;
mod seal;
mod shear;
mod shift;
mod small_table;
mod specimen;
mod stored_times;
mod stress;
pub(crate) mod study;
mod surface;
mod tangential;
mod temperature;
mod text;
mod time;
mod until;
mod warmth;
mod wear;
mod words;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::finding::Finding;
use asperity::layer::Layered;
use asperity::material::Body;
use asperity::quantities::{Quantities, Quantity};
use asperity::sliding::{MovingGap, SteadyMotion};
use asperity::surface::{Part, undeformed_gap};
use asperity::{Axis, Error, Scheme, Simulation};
use ndarray::Array2;

pub use bare::bare_numbers;
pub use cost::CostEstimate;
pub use describe::{Description, MaterialReport, Preparation, WaveReport};
pub use edit::{Entry, entries, with_key};
pub use error::{CaseError, CaseErrors};
pub use examine::{Examination, Inputs, ModulusInput, SurfaceInput};
pub use form::Form;
pub use given::Arrays;
pub use leakage::{LeakageKeys, leak};
pub use measured::Measured;
pub use pair::Pair;
pub use plan::{Motion, Output, Rows, Surface, Travel};
pub use schema::schema;
pub use specimen::{Specimen, specimens};
pub use words::nearest;

use crate::Code;
use crate::leakage::Leak;
use crate::seal::SealPlan;
use crate::stress::StressPlan;
use document::Document;
use overrides::Override;
use place::{Checks, Place};
use text::Text;

/// A case file is text that a person writes; more is a mistake.
const MOST_BYTES: u64 = 16 << 20;

/// A checked case: everything in SI.
#[derive(Clone, Debug)]
pub struct Case {
    /// Title, where the file has one.
    pub title: Option<String>,
    /// Name of the file.
    pub name: String,
    /// Text of the file after the overrides.
    pub source: String,
    /// The simulation without its gap and motion; its quantities are those that the case names.
    pub conditions: Simulation,
    /// The parts of the undeformed gap.
    pub surfaces: Vec<Surface>,
    /// What the deformable bodies, one or two, consist of: each half-space, layer and base.
    pub bodies: Vec<Body>,
    /// How the bodies yield in space, where they have layers; half-spaces otherwise.
    pub layers: Option<Arc<Layered>>,
    /// Thickness of the thinnest body that is taken as a half-space \[m\], where it is known.
    pub thickness: Option<f64>,
    /// Temperature of the run, where it has one: (time \[s\], temperature \[K\]), straight in between.
    pub temperatures: Option<Vec<(f64, f64)>>,
    /// Where the materials come from, and how well they are known.
    pub materials: Vec<MaterialReport>,
    /// What was found about the materials.
    pub findings: Vec<Finding>,
    /// Files that hold numbers of the case (not surfaces), as it names them, and their MD5.
    pub files: Vec<(String, String)>,
    /// What is stored, and where.
    pub output: Output,
    /// The stress below the surface, where it is asked for.
    pub stress: Option<StressPlan>,
    /// The flow through the gap, where it is wanted.
    pub leakage: Option<Leak>,
    /// The whole seal of which it is a patch, where it is given.
    pub seal: Option<SealPlan>,
    /// How the contact moves, where it does.
    pub motion: Option<Motion>,
    /// Rows of the result, where known beforehand.
    rows: Option<usize>,
    /// Expected number of rows.
    usual_rows: usize,
}

impl Case {
    /// Reads a case file, with `overrides` of the form `KEY=VALUE` applied to it.
    ///
    /// # Errors
    /// [`CaseErrors`] where the file cannot be read, or with what is wrong in it.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Case, CaseErrors> {
        let (name, text) = file_text(path, "a case file")?;
        let dir = path.parent().unwrap_or(Path::new(""));
        let stem = path.file_stem().map_or("result".into(), |stem| stem.to_string_lossy());
        Case::from_text(&name, text, dir, format!("{stem}.zarr").into(), overrides)
    }

    /// A case from text; relative paths in it begin at `dir`, and the result's path is "result.zarr" where the
    /// text names none.
    ///
    /// # Errors
    /// [`CaseErrors`] with what is wrong in it.
    pub fn parse(text: &str, dir: &Path, overrides: &[String]) -> Result<Case, CaseErrors> {
        Case::from_text("case", text.to_owned(), dir, "result.zarr".into(), overrides)
    }

    fn from_text(
        name: &str,
        source: String,
        dir: &Path,
        output: PathBuf,
        overrides: &[String],
    ) -> Result<Case, CaseErrors> {
        let Overridden { text: source, keys, added } = overridden(name, source, overrides)?;
        let result = Text::parse(&source).and_then(|text| {
            let document = Document::read(&text)?;
            assemble::case(&text, &document, dir, output)
        });
        match result {
            Ok(case) => Ok(Case { name: name.to_owned(), ..case }),
            Err(mut errors) => {
                for error in &mut errors {
                    if keys.iter().any(|key| is_inside(&error.key, key)) {
                        let help = error.help.take().map(|help| format!("; {help}")).unwrap_or_default();
                        error.help = Some(format!("set by an override{help}"));
                    }
                    error.line = error.line.map(|line| line_of_file(line, &added)).filter(|line| *line > 0);
                }
                Err(CaseErrors { name: name.to_owned(), source, errors })
            }
        }
    }

    /// The parts of the undeformed gap. Reads the topography files.
    ///
    /// # Errors
    /// [`CaseErrors`] where a file cannot be read or does not fit the domain.
    pub fn parts(&self) -> Result<Vec<Part>, CaseErrors> {
        let part = |surface: &Surface| match surface {
            Surface::Part(part) | Surface::Given(part, _) => Ok(part.clone()),
            Surface::File(file) => file.part(&self.conditions.grid).map_err(|reason| {
                self.faults(&file.key, |place| place.data(Err(reason), "a surface of the domain"))
            }),
        };
        self.surfaces.iter().map(part).collect()
    }

    /// The undeformed gap \[m\], shape (nx, ny), smallest value 0, infinite where a cell cannot touch. Reads
    /// the topography files and makes the synthetic roughness.
    ///
    /// # Errors
    /// [`CaseErrors`] where a file cannot be read or does not fit the domain, or no cell can touch.
    pub fn gap(&self) -> Result<Array2<f64>, CaseErrors> {
        self.gap_of(&self.parts()?)
    }

    fn gap_of(&self, parts: &[Part]) -> Result<Array2<f64>, CaseErrors> {
        undeformed_gap(&self.conditions.grid, parts).map_err(|error| self.refused("", error))
    }

    /// The simulation of the case, checked: the gap is built here.
    ///
    /// # Errors
    /// As [`gap`](Self::gap); a load above the hardness times the area that can touch.
    pub fn simulation(&self) -> Result<Simulation, CaseErrors> {
        self.simulation_of(&self.parts()?)
    }

    /// The same with the parts that [`parts`](Self::parts) gave.
    ///
    /// # Errors
    /// As [`simulation`](Self::simulation).
    pub fn simulation_of(&self, parts: &[Part]) -> Result<Simulation, CaseErrors> {
        let (gap, motion) = match &self.motion {
            None => (self.gap_of(parts)?, None),
            Some(motion) => {
                let moving = self.moving(parts, motion)?;
                (moving.at(0.0, motion.direction).0, motion.in_time(moving))
            }
        };
        let simulation = Simulation { gap, motion, ..self.conditions.clone() };
        let simulation = Simulation { quantities: self.quantities(&simulation), ..simulation };
        simulation.validate().map_err(|error| self.refused("", error))?;
        Ok(simulation)
    }

    /// The gap of parts that may move.
    fn moving(&self, parts: &[Part], motion: &Motion) -> Result<MovingGap, CaseErrors> {
        let parts: Vec<(Part, bool)> = parts.iter().cloned().zip(motion.moves.iter().copied()).collect();
        MovingGap::new(&self.conditions.grid, self.conditions.boundary, &parts).map_err(|error| {
            let of_motion = error.parameter().is_empty();
            self.refused(if of_motion { "motion" } else { "" }, error)
        })
    }

    /// The steady states of motion that are asked for, with the slopes of their gap.
    ///
    /// # Errors
    /// [`CaseErrors`] where the gap cannot move.
    pub fn steady_of(
        &self,
        parts: &[Part],
        simulation: &Simulation,
    ) -> Result<Option<SteadyMotion>, CaseErrors> {
        let Some(motion @ Motion { travel: Travel::Steady(velocities), .. }) = &self.motion else {
            return Ok(None);
        };
        let (_, slopes) = self.moving(parts, motion)?.at(0.0, motion.direction);
        let steady = SteadyMotion {
            direction: motion.direction,
            velocities: velocities.clone(),
            slopes,
            shear_stress: motion.shear_stress.clone(),
        };
        steady.validate(simulation).map_err(|error| self.refused("motion", error))?;
        Ok(Some(steady))
    }

    /// The axis along which the rows of its run are ordered.
    pub fn axis(&self) -> Axis {
        match self.motion.as_ref().map(|motion| &motion.travel) {
            Some(Travel::Steady(_)) => Axis::Velocity,
            Some(Travel::Path(_)) | None => Axis::Time,
        }
    }

    /// The quantities that are asked for, of this simulation.
    fn quantities(&self, simulation: &Simulation) -> Quantities {
        let steady = self.axis() == Axis::Velocity;
        let mut wanted = simulation.quantities.clone();
        if self.output.all_quantities {
            let possible = |quantity: &Quantity| {
                let alone = Quantities { list: vec![*quantity], ..wanted.clone() };
                // Steady motion has no history.
                simulation.allows(*quantity).is_ok()
                    && !(steady && quantity.is_of_time())
                    && simulation.columns_of(&alone).is_ok()
            };
            wanted.list = Quantity::at_rest().filter(possible).collect();
        }
        let slips = simulation.tangential.is_some();
        let mut of_laws = vec![];
        if let Some(traction) = &simulation.traction {
            let of_rows = traction.quantities().into_iter().chain([Quantity::ElasticEnergy]);
            of_laws.extend(of_rows.filter(|quantity| simulation.allows(*quantity).is_ok()));
        }
        if let Some(law) = &simulation.wear {
            of_laws.extend(Quantity::of_wear().filter(|own| law.has(*own, slips)));
        }
        of_laws.extend(Quantity::of_tangential().filter(|_| slips));
        of_laws.retain(|quantity| !wanted.list.contains(quantity));
        wanted.list.extend(of_laws);
        if let Some(flash) = &simulation.flash {
            wanted.list.retain(|quantity| !quantity.is_of_flash());
            wanted.list.extend(Quantity::of_flash());
            wanted.list.extend(flash.feedback.as_ref().map(|_| Quantity::MaterialTemperature));
        }
        if let Some(motion) = &self.motion {
            // What steady states have no row of, or what displacements that are known up to a constant do not determine.
            let known = |quantity: &Quantity| match quantity {
                Quantity::Velocity | Quantity::SlidingDistance => !steady,
                Quantity::DissipatedPower => {
                    steady || simulation.scheme != Scheme::Direct && simulation.allows(*quantity).is_ok()
                }
                _ => true,
            };
            wanted.list.retain(|quantity| !quantity.is_of_motion());
            wanted.list.extend(Quantity::of_motion().filter(known));
            let rubs = motion.shear_stress.is_some()
                || simulation.flash.as_ref().is_some_and(|flash| flash.friction > 0.0);
            wanted.list.extend(rubs.then_some(Quantity::FrictionCoefficientTotal));
        }
        wanted
    }

    /// The error that the solver's own check gives, at the key that it names below `key`.
    fn refused(&self, key: &str, error: Error) -> CaseErrors {
        self.faults(key, |place| place.core(Err(error)))
    }

    /// The errors that `report` gives at a key of the case.
    fn faults(&self, key: &str, report: impl FnOnce(&Place<'_>) -> Option<()>) -> CaseErrors {
        let reported = Text::parse(&self.source).and_then(|text| {
            let checks = Checks::new(&text, Path::new(""));
            checks.finish(report(&checks.at(key)))
        });
        let errors = reported.err().unwrap_or_default();
        CaseErrors { name: self.name.clone(), source: self.source.clone(), errors }
    }
}

/// Whether `key` is `outer` or a key below it.
fn is_inside(key: &str, outer: &str) -> bool {
    key.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// A text with overrides applied.
#[derive(Default)]
struct Overridden {
    text: String,
    /// The keys that they set.
    keys: Vec<String>,
    /// For each override that added lines: the line after which they stand, and how many.
    added: Vec<[usize; 2]>,
}

fn overridden(name: &str, source: String, overrides: &[String]) -> Result<Overridden, CaseErrors> {
    let mut result = Overridden { text: source, ..Overridden::default() };
    if overrides.is_empty() {
        return Ok(result);
    }
    // What is no TOML is reported by the reader, with its place.
    let Ok(mut document) = result.text.parse::<toml_edit::DocumentMut>() else { return Ok(result) };
    for change in overrides {
        let change = Override::parse(change).and_then(|change| change.apply(&mut document).map(|()| change));
        let change = change
            .map_err(|reason| CaseErrors::without_place(Code::Syntax, name, reason, "KEY=VALUE", None))?;
        let text = document.to_string();
        let same = text.lines().zip(result.text.lines()).take_while(|(new, old)| new == old).count();
        let more = text.lines().count().saturating_sub(result.text.lines().count());
        result.added.push([same, more]);
        result.keys.push(change.key);
        result.text = text;
    }
    Ok(result)
}

/// The line of the file that a line of the text with overrides was, or that stands before it.
fn line_of_file(line: usize, added: &[[usize; 2]]) -> usize {
    added.iter().rev().fold(line, |line, [after, count]| line.saturating_sub(*count).max(line.min(*after)))
}

/// The name and the text of a case file; `expected` says what else it may be.
fn file_text(path: &Path, expected: &str) -> Result<(String, String), CaseErrors> {
    let name = path.display().to_string();
    match crate::resources::text(path, MOST_BYTES) {
        Ok(text) => Ok((name, text)),
        Err(reason) => {
            let help = if !path.exists() {
                "`asperity new TEMPLATE` writes a starter case"
            } else if path.join("zarr.json").exists() {
                "this is a result; asperity show and asperity report read it"
            } else {
                "name a case file: TOML, saved as UTF-8"
            };
            Err(CaseErrors::without_place(Code::File, &name, reason, expected, Some(help.to_owned())))
        }
    }
}
