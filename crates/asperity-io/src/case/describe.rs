//! What a case will do, in numbers: for `asperity check`.

use asperity::kernel::Kernel;
use asperity::layer::{Base, Interface, Layered, Stack};
use asperity::material::{Body, Creep, Shift, VerticalShift};
use asperity::quantities::Quantity;
use asperity::sliding::Steady;
use asperity::tangential::{Coupling, TangentialControl};
use asperity::{Axis, Course, History, Simulation};
use ndarray::Array2;
use serde::{Deserialize, Serialize};

use super::plan::Surface;
use super::{Case, Rows};
use crate::choice;
use crate::readable::quantity;
use crate::store::FieldKind;
use crate::stress::StressDescription;

/// Where the material of a body comes from, and how well it is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MaterialReport {
    /// Name of the body.
    pub body: String,
    /// "zener", "dma", ...
    pub model: &'static str,
    /// Retarded terms of its creep function.
    pub terms: usize,
    /// Largest relative error of the Prony sum that stands for a fractional model, over `window`.
    pub error: Option<f64>,
    /// Largest relative distance between measured points and the fit.
    pub max_misfit: Option<f64>,
    /// Root of the mean square of these distances.
    pub rms_misfit: Option<f64>,
    /// Rms and largest misfit of each column, fitted or not.
    pub columns: Vec<(String, [f64; 2])>,
    /// The modulus of a dma that was not fitted, and its rms misfit.
    pub other_misfit: Option<(String, f64)>,
    /// Relative scatter of the measured points (standard deviation).
    pub noise: Option<f64>,
    /// First and last time that the error or the measurement covers, at the reference temperature \[s\].
    pub window: Option<[f64; 2]>,
    /// Measured points.
    pub points: Option<usize>,
    /// Temperatures at which they were measured \[K\].
    pub temperatures: Vec<f64>,
    /// The file that holds them, as the case names it.
    pub file: Option<String>,
    /// The law of the shift, where a measured material has one.
    pub shift: Option<String>,
    /// The shift of the material, where it has one.
    #[serde(skip)]
    pub law: Option<Shift>,
    /// Shift factor a_T at the constant temperature of the body, where it has a shift.
    pub shift_factor: Option<f64>,
    /// How the moduli of the material depend on temperature, where they do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical: Option<String>,
    /// The same as a law.
    #[serde(skip)]
    pub vertical_law: Option<VerticalShift>,
    /// Vertical shift factor b_T at the constant temperature of the body, where it has one: its moduli are divided by it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical_factor: Option<f64>,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// What will be solved, and what it takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// Title of the case.
    pub title: Option<String>,
    /// Number of cells along x and y; of a line along x.
    pub cells: Vec<usize>,
    /// Size of the domain \[m\], likewise.
    pub size: Vec<f64>,
    /// Size of a cell \[m\], likewise.
    pub spacing: Vec<f64>,
    /// "free" or "periodic".
    pub boundary: &'static str,
    /// The parts of the gap ("sphere", "self-affine", a file's path).
    pub surfaces: Vec<String>,
    /// What was done to each measured surface; empty until the gap is built.
    pub preparation: Vec<Preparation>,
    /// Names of the deformable bodies.
    pub bodies: Vec<String>,
    /// Poisson's ratio of each of them; null where it changes with time (constant bulk modulus).
    pub poisson: Vec<Option<f64>>,
    /// Contact modulus right after a load, 1/C(0) \[Pa\]; absent for bodies that do not yield at once.
    pub instantaneous_modulus: Option<f64>,
    /// Contact modulus after all creep, 1/C(infinity) \[Pa\]; 0 for a fluid.
    pub relaxed_modulus: f64,
    /// How the layers of the bodies yield, where they have any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layers: Option<LayerReport>,
    /// Retardation times of the pair \[s\], of bodies whose temperature changes at their reference.
    pub retardation_times: Vec<f64>,
    /// Where the materials come from.
    pub materials: Vec<MaterialReport>,
    /// Warnings about the numbers.
    pub warnings: Vec<String>,
    /// Lowest and highest temperature of the run \[K\], where it has any.
    pub temperature: Option<[f64; 2]>,
    /// Cut-off of the pressure \[Pa\].
    pub hardness: Option<f64>,
    /// Least and largest cut-off of the cells \[Pa\], where a file gives them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness_of_cells: Option<[f64; 2]>,
    /// The load along the surfaces, where the case has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionReport>,
    /// Stages whose history is a sine.
    pub sines: Vec<Sine>,
    /// Last instant \[s\].
    pub end: f64,
    /// Rows of the result: the state at 0+, one per step, one more per jump; absent where they are found as the run
    /// goes (adaptive steps, events).
    pub rows: Option<usize>,
    /// Expected number of rows.
    pub usual_rows: usize,
    /// Stages of the load.
    pub stages: usize,
    /// "linear", "constant" or "direct".
    pub scheme: &'static str,
    /// Rows whose fields are stored; absent where not known beforehand.
    pub stored_rows: Option<usize>,
    /// Fields that are stored.
    pub fields: Vec<&'static str>,
    /// Memory of the run, estimated from above \[bytes\].
    pub memory_bytes: u64,
    /// Stored fields before compression \[bytes\]; absent where not known beforehand.
    pub result_bytes: Option<u64>,
    /// The stress below the surface, where it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stress: Option<StressDescription>,
}

/// A load along the surfaces, and what friction is to hold it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrictionReport {
    /// Least and largest friction coefficient of the cells.
    pub coefficient: [f64; 2],
    /// What is prescribed.
    pub control: TangentialControl,
    /// Largest magnitude of its components along x and y \[N; of a line contact N/m; m\].
    pub largest: [f64; 2],
    /// The first time at which the force is more than friction holds \[s\], as far as it is known before the run.
    pub slides_at: Option<f64>,
    /// Dundurs' β: how much pressure and tangential tractions act on each other.
    pub beta: f64,
    /// Whether they do in the run.
    pub coupling: Coupling,
}

/// A stage whose history is a sine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sine {
    /// Number of the stage, from 0.
    pub stage: usize,
    /// Frequency \[Hz\].
    pub frequency: f64,
}

/// How layers yield, compared with a half-space of the material at the surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerReport {
    /// The layers of each body in words.
    pub bodies: Vec<String>,
    /// Whether the response is a function of space times one of time.
    pub separable: bool,
    /// Largest relative error of the creep of the waves, where they creep differently.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub misfit: Option<f64>,
    /// Number of retardation times that all waves have in common, where they creep differently.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<usize>,
    /// The longest and the shortest wave of the domain.
    pub waves: [WaveReport; 2],
}

/// The moduli of the half-space that a wave of pressure deflects as much as the bodies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WaveReport {
    /// Length of the wave \[m\].
    pub length: f64,
    /// Its contact modulus right after a load \[Pa\]; absent for bodies that do not yield at once.
    pub instantaneous_modulus: Option<f64>,
    /// Its contact modulus after all creep \[Pa\]; 0 for a fluid.
    pub relaxed_modulus: f64,
}

/// What was done to a measured surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Preparation {
    /// The file.
    pub surface: String,
    /// One sentence per step, in the order in which they were done.
    pub steps: Vec<String>,
}

/// Memory of the program itself, of its threads and of what small fields leave behind, whatever the case \[bytes\].
const PROGRAM: usize = 40 << 20;
/// Bytes of a row until the run ends: its time, what the march keeps of it, its numbers in the result.
const ROW: usize = 120;

impl Case {
    /// The memory that a run takes at its peak \[bytes\]: what its plans say, and what storing takes.
    pub(crate) fn memory_of_run(&self) -> u64 {
        let (conditions, cells) = (&self.conditions, self.conditions.grid.len());
        let mut quantities = conditions.quantities.clone();
        if self.output.all_quantities {
            quantities.list = Quantity::at_rest().collect();
        }
        let simulation = Simulation { quantities, ..conditions.clone() };
        let stress = self.stress.as_ref().map_or(0, |plan| plan.bytes(conditions));
        let own = match &self.motion {
            Some(motion) if self.axis() == Axis::Velocity => Steady::bytes(&simulation, motion.direction),
            _ => simulation.bytes(),
        };
        // As it was given, as the solver takes it, and as it was read.
        let map = if conditions.hardness_map.is_some() { 3 * 8 * cells } else { 0 };
        let run = own + self.copies() * cells + stress + map;
        // The run has given its memory back when the leakage is computed.
        let leak = self.leakage.as_ref().map_or(0, |leak| leak.bytes(cells) as usize);
        let rows = self.usual_rows.saturating_mul(ROW);
        (run.max(leak).saturating_add(rows).saturating_add(PROGRAM)) as u64
    }

    /// Bytes per cell that are copied where rows with fields are stored: the pressure is stored from where it is, unless it moves.
    fn copies(&self) -> usize {
        let moves = self.motion.is_some();
        let copied = self.output.fields.iter().filter(|kind| moves || **kind != FieldKind::Pressure);
        let shifted = if moves { FieldKind::Gap.bytes() } else { 0 };
        (copied.map(|kind| kind.bytes()).sum::<u64>() + shifted) as usize
    }

    /// What the case will do.
    pub fn describe(&self) -> Description {
        let Simulation { grid, boundary, hardness, hardness_map, .. } = &self.conditions;
        let stress = self.stress.as_ref().map(|plan| {
            let instants = plan.times.as_ref().map(Vec::len).or(self.stored_rows());
            plan.describe(&self.conditions, instants)
        });
        let stored_rows = self.stored_rows();
        let creep = self.reference_creep();
        let largest = |history: &History| {
            let [low, high] = history.range(self.conditions.times.end());
            low.abs().max(high.abs())
        };
        let field_bytes: u64 = self.output.fields.iter().map(|field| field.bytes()).sum();
        Description {
            title: self.title.clone(),
            cells: grid.cells()[..grid.dimensions()].to_vec(),
            size: grid.extents().to_vec(),
            spacing: grid.cell_sides().collect(),
            boundary: choice::word(boundary),
            surfaces: self.surfaces.iter().map(Surface::name).collect(),
            preparation: self.surfaces.iter().filter_map(preparation).collect(),
            bodies: self.bodies.iter().map(|body| body.name.clone()).collect(),
            poisson: self.bodies.iter().map(Body::poisson).collect(),
            instantaneous_modulus: (creep.instantaneous > 0.0).then(|| 1.0 / creep.instantaneous),
            relaxed_modulus: 1.0 / creep.long_time(),
            layers: self.layers.as_ref().map(|layers| self.layer_report(layers, &creep)),
            retardation_times: creep.terms.iter().map(|term| term.retardation_time).collect(),
            materials: self.materials.clone(),
            warnings: self.findings.iter().map(|finding| finding.text.clone()).collect(),
            temperature: self.temperature_range(),
            hardness: hardness.is_finite().then_some(*hardness),
            hardness_of_cells: hardness_map
                .as_ref()
                .map(|map| extent(map).map(|of_cell| of_cell.min(*hardness))),
            friction: self.conditions.tangential.as_ref().map(|law| FrictionReport {
                coefficient: law.coefficients.as_ref().map_or([law.coefficient; 2], extent),
                control: law.control,
                largest: law.histories.each_ref().map(largest),
                slides_at: law.slides_at(&self.conditions),
                beta: law.beta,
                coupling: law.coupling,
            }),
            sines: self.sines(),
            end: self.conditions.times.end(),
            rows: self.rows,
            usual_rows: self.usual_rows,
            stages: self.conditions.loading.stages.len(),
            scheme: choice::word(&self.conditions.scheme),
            stored_rows,
            fields: self.output.fields.iter().map(|field| field.name()).collect(),
            memory_bytes: self.memory_of_run(),
            // initial_gap is always stored
            result_bytes: stored_rows
                .map(|stored| (grid.len() as u64).saturating_mul(8 + stored as u64 * field_bytes)),
            stress,
        }
    }

    fn layer_report(&self, layers: &Layered, creep: &Creep) -> LayerReport {
        let longest = self.conditions.grid.longest_side();
        let shortest = 2.0 * self.conditions.grid.cell_sides().fold(0.0, f64::max);
        let wave = |length| self.wave_report(layers, creep, length);
        LayerReport {
            bodies: layers.stacks().iter().map(words_of).collect(),
            separable: self.conditions.layers.is_none(),
            misfit: self.conditions.layers.as_ref().map(|waves| waves.misfit()),
            nodes: self.conditions.layers.as_ref().map(|waves| waves.nodes()),
            waves: [longest, shortest].map(wave),
        }
    }

    /// The half-space that yields as much as the layers under a wave of this length \[m\]; `None` without layers.
    pub fn wave(&self, length: f64) -> Option<WaveReport> {
        Some(self.wave_report(self.layers.as_ref()?, &self.reference_creep(), length))
    }

    fn wave_report(&self, layers: &Layered, creep: &Creep, length: f64) -> WaveReport {
        let q = std::f64::consts::TAU / length;
        let own = self.conditions.layers.as_ref().and_then(|waves| waves.creep(q).ok());
        // C(q) of a half-space of unit contact modulus is 2/q.
        let of_wave = own.map(|own| own.scaled(0.5 * q));
        let of_wave = of_wave.unwrap_or_else(|| creep.scaled(0.5 * q * layers.symbol(q, 0.0)));
        WaveReport {
            length,
            instantaneous_modulus: (of_wave.instantaneous > 0.0).then(|| 1.0 / of_wave.instantaneous),
            relaxed_modulus: 1.0 / of_wave.long_time(),
        }
    }

    /// C of the pair, of bodies whose temperature changes at their reference temperature.
    fn reference_creep(&self) -> Creep {
        self.conditions.thermal.iter().fold(self.conditions.creep.clone(), |sum, body| sum.sum(&body.creep))
    }

    fn sines(&self) -> Vec<Sine> {
        let stages = self.conditions.loading.stages.iter().enumerate();
        let sine = |(stage, course): (usize, &asperity::Stage)| match course.course {
            Course::Given(History::Sine { frequency, .. }) => Some(Sine { stage, frequency }),
            _ => None,
        };
        stages.filter_map(sine).collect()
    }

    fn temperature_range(&self) -> Option<[f64; 2]> {
        let points = self.temperatures.as_ref()?.iter().map(|point| point.1);
        Some([points.clone().fold(f64::INFINITY, f64::min), points.fold(0.0, f64::max)])
    }

    fn stored_rows(&self) -> Option<usize> {
        match (&self.output.rows, self.rows) {
            (Rows::Every(n), Some(rows)) => Some((1 + (rows - 1).div_ceil((*n).max(1))).min(rows)),
            (Rows::Every(_), None) => None,
            (Rows::At(times), rows) => {
                let inner = times.iter().filter(|t| **t > 0.0 && **t < self.conditions.times.end()).count();
                Some(rows.map_or(inner + 2, |rows| rows.min(inner + 2)))
            }
        }
    }
}

/// Least and largest of the cells.
fn extent(map: &Array2<f64>) -> [f64; 2] {
    let pick = |f: fn(f64, f64) -> f64| map.iter().copied().reduce(f).unwrap_or(f64::NAN);
    [pick(f64::min), pick(f64::max)]
}

/// "10 mm bonded to 2 mm slipping on a rigid base".
fn words_of(stack: &Stack) -> String {
    let on = |interface: Interface| match interface {
        Interface::Bonded => "bonded to",
        Interface::Slip => "slipping on",
    };
    let layers = stack.layers().iter();
    let layers: Vec<String> =
        layers.map(|layer| format!("{} {} ", quantity(layer.thickness, "m"), on(layer.interface))).collect();
    let base = match stack.base() {
        Base::Rigid => "a rigid base",
        Base::HalfSpace { .. } => "a half-space",
    };
    layers.concat() + base
}

fn preparation(surface: &Surface) -> Option<Preparation> {
    Some(Preparation { surface: surface.name(), steps: surface.history()? })
}
