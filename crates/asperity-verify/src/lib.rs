//! Comparison of the solver with independent facts: closed forms, one-dimensional solutions, and invariants that hold on every
//! grid.
//!
//! `asperity verify` prints these checks and the tests assert them. Each tolerance follows from the discretisation, never from
//! the observed error: approach and peak pressure converge as (dx/a)^2, an area is known to a fraction of its last ring of cells,
//! and invariants hold to the tolerance of the solver.

mod adhesion;
mod elastic;
mod energy;
mod flash;
mod fluid;
mod invariants;
mod line;
mod loads;
mod springs;
mod tangential;
mod temperature;
mod viscoelastic;
mod wear;

use asperity::drive::{Drive, March};
use asperity::error::Result;
use asperity::grid::Grid;
use asperity::load::{Control, History, Loading, Programme};
use asperity::material::{Creep, CreepTerm, Relaxation, RelaxationTerm};
use asperity::quantities::Quantity;
use asperity::simulation::Simulation;
use asperity::step::{Row, Step};
use asperity::surface::{Part, Shape, undeformed_gap};

/// One compared quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The case.
    pub case: &'static str,
    /// The compared quantity, with its time if there is one.
    pub quantity: String,
    /// The independent fact and its source.
    pub fact: &'static str,
    /// |found/expected - 1|, or the difference in the unit that the quantity names.
    pub error: f64,
    /// The tolerance, from the discretisation.
    pub tolerance: f64,
}

impl Check {
    /// True if the error is within the tolerance (a NaN is not).
    pub fn ok(&self) -> bool {
        self.error <= self.tolerance
    }
}

/// A case: its name and the function that runs it.
pub type Case = (&'static str, fn() -> Result<Vec<Check>>);

/// All cases, in the order of the documentation.
pub const CASES: &[Case] = &[
    ("hertz-sphere", elastic::hertz_sphere),
    ("hertz-ellipse", elastic::hertz_ellipse),
    ("cone", elastic::cone),
    ("flat-punch", elastic::flat_punch),
    ("westergaard-wave", elastic::westergaard_wave),
    ("capped-hertz", elastic::capped_hertz),
    ("hertz-line", line::hertz),
    ("strip-punch", line::strip_punch),
    ("westergaard-line", elastic::westergaard_line),
    ("ting-step", viscoelastic::ting_step),
    ("ting-triangle", viscoelastic::ting_triangle),
    ("westergaard-creep", viscoelastic::westergaard_creep),
    ("held-approach", viscoelastic::held_approach),
    ("stiff-held-approach", viscoelastic::stiff_held_approach),
    ("flat-punch-history", viscoelastic::flat_punch_history),
    ("springs-sphere", springs::sphere_under_load),
    ("springs-cone", springs::cone_under_approach),
    ("temperature-step-load", temperature::temperature_step_load),
    ("temperature-springs", temperature::temperature_springs),
    ("press-hold", loads::press_and_hold),
    ("event", loads::event),
    ("pull-off", loads::pull_off),
    ("loss-angle", loads::loss_angle),
    ("adaptive-steps", loads::adaptive),
    ("order-in-time", viscoelastic::order_in_time),
    ("one-elastic-solve", invariants::one_elastic_solve),
    ("long-time-limit", invariants::long_time_limit),
    ("duality", invariants::duality),
    ("hertz-energy", energy::hertz),
    ("energy-balance", energy::balance),
    ("lasting-dents", energy::dents),
    ("jkr-wave", adhesion::wave),
    ("maugis-sphere", adhesion::maugis),
    ("adhesive-sphere", adhesion::adhesive_sphere),
    ("adhesive-retraction", adhesion::retraction),
    ("fluid-wave", fluid::wave),
    ("fluid-channel", fluid::channel),
    ("fluid-strip", fluid::strip),
    ("fluid-sealed", fluid::sealed),
    ("cattaneo-mindlin", tangential::sphere),
    ("tangential-rough", tangential::rough),
    ("glued-punch", tangential::punch),
    ("bonded-contact", tangential::bonded),
    ("wear", wear::archard),
    ("jaeger-band", flash::band),
];

/// The checks of one case.
struct Checks {
    case: &'static str,
    fact: &'static str,
    list: Vec<Check>,
}

impl Checks {
    fn new(case: &'static str, fact: &'static str) -> Self {
        Checks { case, fact, list: vec![] }
    }

    /// Compares |found/expected - 1| with a tolerance.
    fn relative(&mut self, quantity: impl Into<String>, found: f64, expected: f64, tolerance: f64) {
        self.absolute(quantity, (found / expected - 1.0).abs(), tolerance);
    }

    /// Compares an error with a tolerance.
    fn absolute(&mut self, quantity: impl Into<String>, error: f64, tolerance: f64) {
        let (case, fact) = (self.case, self.fact);
        self.list.push(Check { case, quantity: quantity.into(), fact, error, tolerance });
    }
}

/// E*(t) = 2 + 2 exp(-t/0.5), so C(t) = 1/4 + (1 - exp(-t))/4: a Zener solid with G = G_K = tau = 1.
fn zener() -> Creep {
    with_one_time(0.25, 0.25)
}

/// A body with one retarded term, of a retardation time of 1 s.
fn with_one_time(instantaneous: f64, compliance: f64) -> Creep {
    let terms = vec![CreepTerm { compliance, retardation_time: 1.0 }];
    Creep { instantaneous, terms, fluidity: 0.0 }
}

/// The relaxation modulus of [`zener`].
fn zener_relaxation() -> Relaxation {
    let terms = vec![RelaxationTerm { modulus: 2.0, relaxation_time: 0.5 }];
    Relaxation { equilibrium: 2.0, terms, viscosity: 0.0 }
}

/// One shape on a square domain of n x n cells.
fn shape_on(n: usize, size: f64, shape: Shape) -> Result<Simulation> {
    on_grid(Grid::new([n, n], [size, size])?, shape)
}

fn on_grid(grid: Grid, shape: Shape) -> Result<Simulation> {
    let gap = undeformed_gap(&grid, &[Part::Shape { shape, center: [0.0, 0.0] }])?;
    Ok(Simulation::new(grid, gap))
}

fn step_load(value: f64) -> Programme {
    held(Control::Load, value)
}

fn held(control: Control, value: f64) -> Programme {
    under(control, History::Step { value })
}

/// Straight between these points of time and value.
fn along(control: Control, points: &[(f64, f64)]) -> Programme {
    under(control, History::Table { points: points.to_vec() })
}

fn under(control: Control, history: History) -> Programme {
    Loading { control, history }.into()
}

/// The rows of a simulation.
fn rows(simulation: Simulation) -> Result<Vec<Row>> {
    let mut march = March::new(simulation)?;
    let mut rows = Vec::with_capacity(march.rows_expected().unwrap_or(0));
    while let Some(step) = march.advance()? {
        rows.push(step.row());
    }
    Ok(rows)
}

/// What `of` says of the last row of a simulation.
fn last<T>(simulation: Simulation, of: impl FnOnce(&Step<'_>) -> Result<T>) -> Result<Option<T>> {
    let mut march = March::new(simulation)?;
    while march.advance()?.is_some() {}
    march.last().as_ref().map(of).transpose()
}

/// A quantity that is one number, of a row.
fn number(step: &Step<'_>, quantity: Quantity) -> f64 {
    step.quantity(quantity).and_then(|values| values.first().copied()).unwrap_or(f64::NAN)
}

/// The first row of a simulation, its pressure and its displacement, cell by cell.
fn first(simulation: Simulation) -> Result<(Row, Vec<f64>, Vec<f64>)> {
    let mut displacement = ndarray::Array2::zeros(simulation.grid.shape());
    let mut march = March::new(simulation)?;
    let Some(step) = march.advance()? else { return Ok(Default::default()) };
    step.displacement_into(&mut displacement);
    let pressure = step.pressure().iter().copied().collect();
    Ok((step.row(), pressure, displacement.into_raw_vec_and_offset().0))
}

/// An elastic contact of unit modulus under a load: its row and the pressure along the middle row.
fn elastic_contact(simulation: Simulation, load: f64) -> Result<(Row, Vec<f64>)> {
    let [nx, ny] = simulation.grid.cells();
    let (row, pressure, _) = first(Simulation { loading: step_load(load), ..simulation })?;
    Ok((row, pressure[nx / 2 * ny..][..ny].to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_holds() {
        for (name, run) in CASES {
            for check in run().unwrap() {
                assert_eq!(check.case, *name);
                assert!(check.ok(), "{name}, {}: {:e} > {:e}", check.quantity, check.error, check.tolerance);
            }
        }
    }
}
