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
//! assert_eq!(case.grid.spacing(), [1e-3 / 32.0; 2]); // metres
//! assert_eq!(case.loading.stages[0].course.resolve(0.0).after(0.0), 8.0); // newtons
//!
//! let errors = Case::parse(&text.replace("210 GPa", "210 mm"), ".".as_ref(), &[]).unwrap_err();
//! assert_eq!(errors.errors[0].key, "body[0].material.young");
//! assert_eq!(errors.errors[0].line, Some(10));
//! # Ok::<(), asperity_io::case::CaseErrors>(())
//! ```

mod assemble;
mod body;
mod cost;
mod describe;
mod document;
mod domain;
mod error;
mod examine;
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
mod memory;
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
mod shift;
mod specimen;
mod stored_times;
mod stress;
mod surface;
mod temperature;
mod text;
mod time;
mod warmth;
mod words;

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::finding::Finding;
use asperity::kernel::{HalfSpace, Kernel};
use asperity::layer::{Layered, NonseparableLayers};
use asperity::material::{Body, Creep, ThermalCreep};
use asperity::quantities::{Quantities, Quantity};
use asperity::sliding::{MovingGap, SteadyMotion};
use asperity::surface::{Part, undeformed_gap};
use asperity::{
    Axis, Boundary, Error, Grid, Plasticity, Programme, Scheme, Simulation, SolverOptions, TimeGrid,
};
use ndarray::Array2;

pub use cost::CostEstimate;
pub use describe::{Description, MaterialReport, Preparation, WaveReport};
pub use error::{CaseError, CaseErrors};
pub use examine::{Examination, Inputs, ModulusInput, SurfaceInput};
pub use given::Arrays;
pub use leakage::{LeakageKeys, leak};
pub use measured::Measured;
pub use plan::{Motion, Output, Rows, Surface, Travel};
pub use schema::schema;
pub use specimen::{Specimen, specimens};
pub use words::nearest;

use crate::leakage::Leak;
use crate::stress::StressPlan;
use document::Document;
use output::Conditions;
use overrides::Override;
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
    /// The computational domain.
    pub grid: Grid,
    /// What surrounds it.
    pub boundary: Boundary,
    /// The parts of the undeformed gap.
    pub surfaces: Vec<Surface>,
    /// What the deformable bodies, one or two, consist of: each half-space, layer and base.
    pub bodies: Vec<Body>,
    /// How the bodies yield in space, where they have layers; half-spaces otherwise.
    pub layers: Option<Arc<Layered>>,
    /// How waves on the layers creep, where waves of different lengths creep differently.
    pub waves: Option<Arc<NonseparableLayers>>,
    /// Thickness of the thinnest body that is taken as a half-space \[m\], where it is known.
    pub thickness: Option<f64>,
    /// Contact creep compliance C(t) of the pair \[1/Pa\]; without the bodies of `thermal`.
    pub creep: Creep,
    /// Bodies whose temperature changes.
    pub thermal: Vec<ThermalCreep>,
    /// Temperature of the run, where it has one: (time \[s\], temperature \[K\]), straight in between.
    pub temperatures: Option<Vec<(f64, f64)>>,
    /// Where the materials come from, and how well they are known.
    pub materials: Vec<MaterialReport>,
    /// What was found about the materials.
    pub findings: Vec<Finding>,
    /// Files that hold numbers of the case (not surfaces), as it names them, and their MD5.
    pub files: Vec<(String, String)>,
    /// Cut-off H of the pressure \[Pa\], the softer body's; infinite without.
    pub hardness: f64,
    /// Cut-off of the pressure in each cell \[Pa\], where a file gives it; the lesser of it and `hardness` holds.
    pub hardness_map: Option<Array2<f64>>,
    /// What is prescribed over time.
    pub loading: Programme,
    /// The instants of the solution.
    pub times: TimeGrid,
    /// Instants that are steps besides \[s\]: those of `output.times`, unless steps are adaptive.
    pub include: Vec<f64>,
    /// How the pressure goes over a step.
    pub scheme: Scheme,
    /// What flattening at the cut-off leaves behind.
    pub plasticity: Plasticity,
    /// How each step is solved.
    pub solver: SolverOptions,
    /// What is stored, and where.
    pub output: Output,
    /// The stress below the surface, where it is asked for.
    pub stress: Option<StressPlan>,
    /// The flow through the gap, where it is wanted.
    pub leakage: Option<Leak>,
    /// How the contact moves, where it does.
    pub motion: Option<Motion>,
    /// Rows of the result, where known beforehand.
    rows: Option<usize>,
    /// About as many.
    usual_rows: usize,
    /// Path of the key that holds what is prescribed.
    history: String,
}

impl Case {
    /// Reads a case file, with `overrides` of the form `KEY=VALUE` applied to it.
    ///
    /// # Errors
    /// [`CaseErrors`] where the file cannot be read, or with what is wrong in it.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Case, CaseErrors> {
        let name = path.display().to_string();
        let text = file_text(path)
            .map_err(|(reason, help)| CaseErrors::without_place(&name, reason, "a case file", Some(help)))?;
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
        let (source, set) = overridden(name, source, overrides)?;
        let result = Text::parse(&source).and_then(|text| {
            let document = Document::read(&text)?;
            assemble::case(&text, &document, dir, output)
        });
        match result {
            Ok(case) => Ok(Case { name: name.to_owned(), ..case }),
            Err(mut errors) => {
                for error in &mut errors {
                    if set.iter().any(|key| is_inside(&error.key, key)) {
                        let help = error.help.take().map(|help| format!("; {help}")).unwrap_or_default();
                        error.help = Some(format!("set by an override{help}"));
                    }
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
            Surface::Part(part) => Ok(part.clone()),
            Surface::File(file) => file.part(&self.grid).map_err(|reason| self.fault(&file.key, reason)),
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
        undeformed_gap(&self.grid, parts).map_err(|error| {
            CaseErrors::without_place(&self.name, format!("surface: {error}"), "a gap that can close", None)
        })
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
        let gap = match &self.motion {
            Some(motion) => self.moving_gap(parts, motion)?,
            None => self.gap_of(parts)?,
        };
        let simulation = Simulation { motion: self.motion_of(parts)?, ..self.with_gap(gap) };
        let simulation = Simulation { quantities: self.quantities(&simulation), ..simulation };
        match simulation.validate() {
            Ok(()) => Ok(simulation),
            // Under a punch only a part of the domain bears.
            Err(error @ Error::Infeasible { .. }) => Err(self.fault(&self.history, error.to_string())),
            Err(error) => Err(CaseErrors::without_place(&self.name, error.to_string(), "", None)),
        }
    }

    /// The gap of parts that may move.
    fn moving(&self, parts: &[Part], motion: &Motion) -> Result<MovingGap, CaseErrors> {
        let parts: Vec<(Part, bool)> = parts.iter().cloned().zip(motion.moves.iter().copied()).collect();
        MovingGap::new(&self.grid, self.boundary, &parts)
            .map_err(|error| self.fault("motion", error.to_string()))
    }

    /// The gap at the start of a motion.
    fn moving_gap(&self, parts: &[Part], motion: &Motion) -> Result<Array2<f64>, CaseErrors> {
        Ok(self.moving(parts, motion)?.at(0.0, motion.direction).0)
    }

    /// The motion in time, where there is one.
    fn motion_of(&self, parts: &[Part]) -> Result<Option<asperity::process::Motion>, CaseErrors> {
        let Some((motion, Travel::Path(path))) = self.motion.as_ref().map(|motion| (motion, &motion.travel))
        else {
            return Ok(None);
        };
        Ok(Some(asperity::process::Motion {
            path: path.clone(),
            direction: motion.direction,
            gap: self.moving(parts, motion)?,
            cells_per_step: motion.cells_per_step,
            shear_stress: motion.shear_stress,
        }))
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
        let Some((motion, Travel::Steady(velocities))) =
            self.motion.as_ref().map(|motion| (motion, &motion.travel))
        else {
            return Ok(None);
        };
        let (_, slopes) = self.moving(parts, motion)?.at(0.0, motion.direction);
        let steady = SteadyMotion {
            direction: motion.direction,
            velocities: velocities.clone(),
            slopes,
            shear_stress: motion.shear_stress,
        };
        match steady.validate(simulation) {
            Ok(()) => Ok(Some(steady)),
            Err(error) => Err(self.fault("motion", error.to_string())),
        }
    }

    /// What the rows of its run follow one another in.
    pub fn axis(&self) -> Axis {
        match self.motion.as_ref().map(|motion| &motion.travel) {
            Some(Travel::Steady(_)) => Axis::Velocity,
            Some(Travel::Path(_)) | None => Axis::Time,
        }
    }

    /// How the bodies yield in space.
    pub fn kernel(&self) -> Arc<dyn Kernel> {
        match &self.layers {
            Some(layers) => layers.clone(),
            None => Arc::new(HalfSpace),
        }
    }

    /// The simulation with a gap, without the quantities that are asked for.
    fn with_gap(&self, gap: Array2<f64>) -> Simulation {
        Simulation {
            boundary: self.boundary,
            kernel: self.kernel(),
            layers: self.waves.clone(),
            creep: self.creep.clone(),
            thermal: self.thermal.clone(),
            hardness: self.hardness,
            hardness_map: self.hardness_map.clone(),
            loading: self.loading.clone(),
            times: self.times.clone(),
            include: self.include.clone(),
            scheme: self.scheme,
            plasticity: self.plasticity,
            solver: self.solver,
            ..Simulation::new(self.grid, gap)
        }
    }

    /// The quantities that are asked for, of this simulation.
    fn quantities(&self, simulation: &Simulation) -> Quantities {
        let steady = self.axis() == Axis::Velocity;
        let mut wanted = self.output.quantities.clone();
        if self.output.all_quantities {
            let conditions = Conditions {
                scheme: simulation.scheme,
                up_to_a_constant: simulation.is_up_to_a_constant(),
                waves: self.waves.is_some(),
                moves: self.motion.is_some(),
            };
            let possible = |quantity: &Quantity| {
                let alone = Quantities { list: vec![*quantity], ..wanted.clone() };
                // Steady motion has no history.
                conditions.refuse(*quantity).is_none()
                    && !(steady && quantity.is_of_time())
                    && simulation.columns_of(&alone).is_ok()
            };
            wanted.list = Quantity::at_rest().filter(possible).collect();
        }
        if let Some(motion) = &self.motion {
            // What steady states have no row of, or what displacements that are known up to a constant do not determine.
            let known = |quantity: &Quantity| match quantity {
                Quantity::Velocity | Quantity::SlidingDistance => !steady,
                Quantity::DissipatedPower => {
                    steady || simulation.scheme != Scheme::Direct && !simulation.is_up_to_a_constant()
                }
                _ => true,
            };
            wanted.list.retain(|quantity| !quantity.is_of_motion());
            wanted.list.extend(Quantity::of_motion().filter(known));
            wanted.list.extend(motion.shear_stress.map(|_| Quantity::FrictionCoefficientTotal));
        }
        wanted
    }

    fn fault(&self, key: &str, reason: String) -> CaseErrors {
        let errors = match Text::parse(&self.source) {
            Ok(text) => vec![text.fault(text.of(key), &reason, "", "")],
            Err(errors) => errors, // cannot be: the source was read before
        };
        CaseErrors { name: self.name.clone(), source: self.source.clone(), errors }
    }
}

/// Whether `key` is `outer` or a key below it.
fn is_inside(key: &str, outer: &str) -> bool {
    key.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// The text with the overrides applied, and the keys that they set.
fn overridden(name: &str, source: String, overrides: &[String]) -> Result<(String, Vec<String>), CaseErrors> {
    if overrides.is_empty() {
        return Ok((source, Vec::new()));
    }
    // What is no TOML is reported by the reader, with its place.
    let Ok(mut document) = source.parse::<toml_edit::DocumentMut>() else { return Ok((source, Vec::new())) };
    let mut keys = Vec::with_capacity(overrides.len());
    for text in overrides {
        let change = Override::parse(text).and_then(|change| change.apply(&mut document).map(|()| change));
        match change {
            Ok(change) => keys.push(change.key),
            Err(reason) => {
                let message = format!("cannot set {reason}");
                return Err(CaseErrors::without_place(name, message, "KEY=VALUE", None));
            }
        }
    }
    Ok((document.to_string(), keys))
}

/// The text of the file; or what is wrong and what to do.
fn file_text(path: &Path) -> Result<String, (String, String)> {
    let file = crate::resources::open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            ("there is no such file".to_owned(), "`asperity new TEMPLATE` writes a starter case".to_owned())
        }
        std::io::ErrorKind::IsADirectory if path.join("zarr.json").exists() => (
            "it is a result, not a case file".to_owned(),
            "asperity show and asperity report read it".to_owned(),
        ),
        std::io::ErrorKind::IsADirectory => (error.to_string(), "name a case file".to_owned()),
        _ => (format!("the file cannot be read: {error}"), "check the path and its permissions".to_owned()),
    })?;
    let mut bytes = Vec::new();
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| {
        (format!("the file cannot be read: {error}"), "check the path and its permissions".to_owned())
    })?;
    if bytes.len() as u64 > MOST_BYTES {
        let reason = format!("the file is larger than {} MB, the limit for a case file", MOST_BYTES >> 20);
        return Err((reason, "name a TOML case file".to_owned()));
    }
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count();
        (
            format!("the file is not UTF-8 text (line {line}, byte {byte})"),
            "name a TOML case file, saved as UTF-8".to_owned(),
        )
    })
}
