//! What a case will do, in numbers: for `asperity check`.

use asperity::surface::Part;
use asperity::{Boundary, Scheme};
use serde::Serialize;

use super::plan::Surface;
use super::{Case, Rows};

/// What will be solved, and what it takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// Title of the case.
    pub title: Option<String>,
    /// Number of cells along x and y.
    pub cells: [usize; 2],
    /// Size of the domain \[m\].
    pub size: [f64; 2],
    /// Size of a cell \[m\].
    pub spacing: [f64; 2],
    /// "free" or "periodic".
    pub boundary: &'static str,
    /// The parts of the gap ("sphere", "self-affine", a file's path).
    pub surfaces: Vec<String>,
    /// Names of the deformable bodies.
    pub bodies: Vec<String>,
    /// Contact modulus right after a load, 1/C(0) \[Pa\]; absent for bodies that do not yield at once.
    pub instantaneous_modulus: Option<f64>,
    /// Contact modulus after all creep, 1/C(infinity) \[Pa\]; 0 for a fluid.
    pub relaxed_modulus: f64,
    /// Retardation times of the pair \[s\].
    pub retardation_times: Vec<f64>,
    /// Cut-off of the pressure \[Pa\].
    pub hardness: Option<f64>,
    /// Last instant \[s\].
    pub end: f64,
    /// Rows of the result: the state at 0+, one per step, one more per jump.
    pub rows: usize,
    /// "linear", "constant" or "direct".
    pub scheme: &'static str,
    /// Rows whose fields are stored.
    pub stored_rows: usize,
    /// Fields that are stored.
    pub fields: Vec<&'static str>,
    /// Memory of the run, estimated from above \[bytes\].
    pub memory_bytes: u64,
    /// Stored fields before compression \[bytes\].
    pub result_bytes: u64,
}

impl Case {
    /// What the case will do.
    pub fn describe(&self) -> Description {
        let stored_rows = self.stored_rows();
        let field_bytes: u64 = self.output.fields.iter().map(|field| field.bytes()).sum();
        Description {
            title: self.title.clone(),
            cells: self.grid.cells(),
            size: self.grid.size(),
            spacing: self.grid.spacing(),
            boundary: match self.boundary {
                Boundary::Free => "free",
                Boundary::Periodic => "periodic",
            },
            surfaces: self.surfaces.iter().map(name).collect(),
            bodies: self.bodies.iter().map(|body| body.name.clone()).collect(),
            instantaneous_modulus: (self.creep.instantaneous > 0.0).then(|| 1.0 / self.creep.instantaneous),
            relaxed_modulus: 1.0 / self.creep.long_time(),
            retardation_times: self.creep.terms.iter().map(|term| term.retardation_time).collect(),
            hardness: self.hardness.is_finite().then_some(self.hardness),
            end: self.times.end(),
            rows: self.rows,
            scheme: match self.scheme {
                Scheme::Linear => "linear",
                Scheme::Constant => "constant",
                Scheme::Direct => "direct",
            },
            stored_rows,
            fields: self.output.fields.iter().map(|field| field.name()).collect(),
            memory_bytes: u64::try_from(self.memory).unwrap_or(u64::MAX),
            // initial_gap is always stored
            result_bytes: (self.grid.len() as u64).saturating_mul(8 + stored_rows as u64 * field_bytes),
        }
    }

    fn stored_rows(&self) -> usize {
        let last = self.rows - 1;
        match &self.output.rows {
            Rows::Every(n) => 1 + last.div_ceil((*n).max(1)),
            Rows::At(times) => times.iter().filter(|t| **t > 0.0 && **t < self.times.end()).count() + 2,
        }
        .min(self.rows)
    }
}

fn name(surface: &Surface) -> String {
    match surface {
        Surface::File(file) => file.path.display().to_string(),
        Surface::Part(Part::Shape { shape, .. }) => shape.name().to_owned(),
        Surface::Part(Part::SelfAffine(_) | Part::Synthesis(_)) => "self-affine".to_owned(),
        Surface::Part(Part::Heights { name, .. }) => name.clone(),
    }
}
