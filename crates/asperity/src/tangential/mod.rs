//! Tangential loads: friction and partial slip.
//!
//! Two bodies that press on each other are also loaded along their surfaces. Where the tangential traction is less than the limit of
//! friction, |q| < μ p, they stick; where it meets the limit they slip. Under a force less than μ W a part of the contact slips, most of
//! the time a ring at its edge (Cattaneo 1938; Mindlin 1949).
//!
//! ```text
//! u = C * K q        tangential displacement, both components        (kernel::cerruti)
//! |q| <= min(μ p, τ) in each cell; the slip of a step is opposite to q where equality holds
//! ```
//!
//! p is the contact pressure: what adhesion pulls, or a fluid carries, does not rub.
//!
//! Where the bodies differ (Dundurs' β is not 0), tangential tractions also displace the surfaces normally, and pressures tangentially. With
//! [`Coupling::Full`] pressure and tractions are found in turn until both agree (Panagiotopoulos 1975); otherwise this is neglected,
//! and both are off by the order of β. Poisson's ratio does not change in time.

mod discs;
mod freedom;
mod lateral;
mod operator;
mod pair;
mod row;
mod solver;
#[cfg(test)]
mod tests;
mod vector;

pub use pair::PairRatio;
pub use row::{SlipOutcome, SlipRow};

pub(crate) use freedom::EDGE;
pub(crate) use lateral::Lateral;
pub(crate) use solver::{Given, Slip, SlipProblem, SlipSolver};
pub(crate) use vector::{Vector, inner, length, minus, plus, times};

use ndarray::Array2;

use crate::contact::SAME_LOAD;
use crate::error::{Error, Of, Result, require};
use crate::grid::{Boundary, Grid};
use crate::load::{Control, Course, History, Stage};
use crate::simulation::Simulation;

/// Larger friction coefficients hold no more, and cost digits of the sum of the tractions.
const STICKS: f64 = 1e6;
/// Sines along x and y have a common period of at most so many of the longer one.
const MOST_PERIODS: u32 = 12;
/// Times at which force and load are compared before a run, besides those at which they turn.
const SAMPLES: u32 = 200;

/// Bytes that a step with friction takes, without what the bodies remember.
pub(crate) fn bytes(grid: &Grid, boundary: Boundary, law: &Tangential) -> usize {
    // The displacements beside those of the own tractions, one of them twice, and the shifted gap.
    let coupled = 8 * grid.len() * (2 + 3) + Lateral::bytes(operator::lengths(grid, boundary));
    // Ten fields of vectors and the freedom of cells in the solver; eleven fields of vectors and six numbers in the process.
    8 * grid.len() * (2 * 21 + 4 + 6)
        + if law.is_coupled() { coupled } else { 0 }
        + operator::VectorConvolution::bytes(operator::lengths(grid, boundary))
        + operator::VectorConvolution::bytes(grid.cells())
}

/// What is prescribed along the surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum TangentialControl {
    /// The force, in N.
    Force,
    /// The displacement of the bodies against each other, in m.
    Displacement,
}

/// What pressure and tangential tractions of bodies with different elastic constants do to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Coupling {
    /// Nothing: the pressure is that without tangential tractions.
    #[default]
    Neglect,
    /// Each displaces the surfaces also in the direction of the other; both are found in turn until they agree.
    Full,
}

/// Friction, and a tangential load over time.
///
/// ```
/// use std::sync::Arc;
/// use asperity::{drive::March, material::Creep, surface::{Part, Shape, undeformed_gap}, *};
/// use asperity::tangential::{Coupling, Tangential, TangentialControl};
/// // A sphere under 1 N, pulled along x with 0.6 of the force that makes it slide.
/// let grid = Grid::new([64, 64], [0.6e-3, 0.6e-3])?;
/// let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
/// let (pull, none) = (History::Ramp { value: 0.18, duration: 1.0 }, History::Step { value: 0.0 });
/// let mut march = March::new(Simulation {
///     creep: Creep::elastic(1e-9),
///     loading: Loading { control: Control::Load, history: History::Step { value: 1.0 } }.into(),
///     tangential: Some(Arc::new(Tangential {
///         coefficient: 0.3, coefficients: None, shear_limit: f64::INFINITY, poisson: 0.3, beta: 0.0,
///         coupling: Coupling::Neglect,
///         control: TangentialControl::Force, histories: [pull, none],
///     })),
///     ..Simulation::new(grid, undeformed_gap(&grid, &[sphere])?)
/// })?;
/// march.advance()?;
/// let row = march.advance()?.and_then(|step| step.slip_row()).unwrap();
/// // Cattaneo and Mindlin: a circle of (1 - 0.6)^(2/3) of the area sticks.
/// let share = row.stick_area / (row.stick_area + row.slip_area);
/// assert!((share / 0.4f64.powf(2.0 / 3.0) - 1.0).abs() < 0.05);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tangential {
    /// Friction coefficient μ.
    pub coefficient: f64,
    /// The same of each cell, where it differs, shape (nx, ny).
    pub coefficients: Option<Array2<f64>>,
    /// Largest traction \[Pa\]; infinite for none.
    pub shear_limit: f64,
    /// Poisson's ratio of the pair: the mean of both bodies, weighted by their shear compliances.
    pub poisson: f64,
    /// Dundurs' β: how much pressure and tangential traction act on each other.
    pub beta: f64,
    /// Whether they do in the run.
    pub coupling: Coupling,
    /// What is prescribed.
    pub control: TangentialControl,
    /// Its components along x and y over the time of the run.
    pub histories: [History; 2],
}

impl Tangential {
    /// Whether pressure and tangential tractions act on each other.
    pub(crate) fn is_coupled(&self) -> bool {
        self.coupling == Coupling::Full && self.beta != 0.0
    }

    /// The limit of the traction in a cell under a pressure.
    pub(crate) fn limit(&self, cell: usize, pressure: f64) -> f64 {
        let of_cells = self.coefficients.as_ref().and_then(|map| map.as_slice());
        let coefficient = of_cells.map_or(self.coefficient, |map| map[cell]);
        (coefficient * pressure.max(0.0)).min(self.shear_limit)
    }

    /// The largest friction coefficient of all cells.
    pub(crate) fn largest(&self) -> f64 {
        self.coefficients.iter().flatten().copied().fold(self.coefficient, f64::max)
    }

    /// What is prescribed at a time.
    pub(crate) fn at(&self, time: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.histories[axis].after(time))
    }

    /// The axis along which the force acts, where it has one component only until `end`.
    pub(crate) fn alone(&self, end: f64) -> Option<usize> {
        let is_zero = |axis: usize| self.histories[axis].range(end) == [0.0; 2];
        (self.control == TangentialControl::Force)
            .then(|| [0, 1].into_iter().find(|axis| is_zero(1 - axis)))
            .flatten()
    }

    /// The first time at which the force is more than friction holds, μ W or less, as far as it is known before the run: a force and a load
    /// that are prescribed for all of it, all of which presses the surfaces together.
    pub fn slides_at(&self, simulation: &Simulation) -> Option<f64> {
        if simulation.traction.is_some() {
            return None;
        }
        let [Stage { control, course: Course::Given(history), until: None, .. }] =
            &simulation.loading.stages[..]
        else {
            return None;
        };
        let area = match control {
            Control::Load => 1.0,
            Control::Pressure => simulation.grid.area(),
            Control::Approach => return None,
        };
        let coefficient = self.largest();
        let end = simulation.times.end();
        let mut times = [history.breaks(end), self.breaks(end), vec![0.0, end]].concat();
        times.extend((1..SAMPLES).map(|n| end * f64::from(n) / f64::from(SAMPLES)));
        times.sort_by(f64::total_cmp);
        let slides = |time: &f64| {
            length(self.at(*time)) > coefficient * area * history.after(*time) * (1.0 + SAME_LOAD)
        };
        times.into_iter().filter(|_| self.control == TangentialControl::Force).find(slides)
    }

    /// The period of what is prescribed, where all of it that changes is a sine with a common period.
    pub fn period(&self) -> Option<f64> {
        let mut periods = vec![];
        for history in &self.histories {
            match history {
                History::Sine { frequency, .. } => periods.push(1.0 / frequency),
                History::Step { .. } => {}
                _ => return None,
            }
        }
        let longest = periods.iter().copied().reduce(f64::max)?;
        // The least number of the longest period that all others fit into.
        let fits = |times: &f64| {
            periods.iter().all(|period| {
                let share = times * longest / period;
                (share - share.round()).abs() < 1e-9 * share
            })
        };
        (1..=MOST_PERIODS).map(f64::from).find(fits).map(|times| times * longest)
    }

    /// The times at which what is prescribed bends or turns.
    pub(crate) fn breaks(&self, end: f64) -> Vec<f64> {
        let of_one = |history: &History| [history.breaks(end), history.extremes(end)].concat();
        self.histories.iter().flat_map(of_one).collect()
    }

    /// Checks what can be known before the run.
    ///
    /// # Errors
    /// [`Error::Invalid`] with the key of the case.
    pub(crate) fn validate(&self, simulation: &Simulation) -> Result<()> {
        self.validate_numbers(simulation)?;
        self.validate_histories(simulation)?;
        let excludes = |holds: bool, what: &str, expected: &str| {
            require(holds, what, "given", expected).of("tangential")
        };
        let is_half_space = simulation.layers.is_none() && simulation.kernel.is_half_space();
        excludes(
            is_half_space,
            "layer under a tangential load",
            "none: only half-spaces are solved with friction",
        )?;
        excludes(
            simulation.motion.is_none(),
            "motion beside a tangential load",
            "none: slip follows from [tangential]",
        )?;
        let is_free_line = simulation.grid.is_line() && simulation.boundary == Boundary::Free;
        let expected = "periodic: on a free line the displacement is only known up to a constant";
        require(!is_free_line, "boundary of a line contact under a tangential load", "free", expected)
            .of("domain.boundary")?;
        let expected = "uniform, logarithmic or listed: the error of slip, by which they would be chosen, is not estimated";
        require(!simulation.is_adaptive(), "time steps under a tangential load", "adaptive", expected)
            .of("time")
    }

    fn validate_numbers(&self, simulation: &Simulation) -> Result<()> {
        let coefficient = |key: &str, what: String, value: f64| {
            let expected = format!("from 0 to {STICKS:e}, with which nothing slips");
            require((0.0..=STICKS).contains(&value), what, value, expected).of(key)
        };
        coefficient("friction.coefficient", "friction coefficient".into(), self.coefficient)?;
        if let Some(map) = &self.coefficients {
            let expected = format!("{:?}, one for each cell", simulation.grid.shape());
            let shape = format!("{:?}", map.dim());
            require(
                map.dim() == simulation.grid.shape(),
                "shape of the friction coefficients",
                shape,
                expected,
            )
            .of("friction.field")?;
            map.indexed_iter().try_for_each(|((i, j), value)| {
                coefficient("friction.field", format!("friction coefficient of cell ({i}, {j})"), *value)
            })?;
        }
        require(self.shear_limit > 0.0, "shear limit", format!("{} Pa", self.shear_limit), "greater than 0")
            .of("friction.shear_limit")?;
        let sound = self.poisson > -1.0 && self.poisson <= 0.5;
        require(sound, "Poisson's ratio of the pair", self.poisson, "greater than -1 and at most 0.5")?;
        require((-1.0..=1.0).contains(&self.beta), "Dundurs' beta", self.beta, "between -1 and 1")
    }

    fn validate_histories(&self, simulation: &Simulation) -> Result<()> {
        let end = simulation.times.end();
        for (history, axis) in self.histories.iter().zip(["x", "y"]) {
            let checked = history.validate().and_then(|()| {
                let jump = history.breaks(end).into_iter().find(|t| history.before(*t) != history.after(*t));
                jump.map_or(Ok(()), |t| {
                    let value = format!("{} to {} at t = {t} s", history.before(t), history.after(t));
                    let expected = "a ramp: after t = 0 a tangential load does not jump";
                    Err(Error::invalid("jump of the tangential load", value, expected))
                })
            });
            checked.of(&format!("tangential.{axis}"))?;
        }
        Ok(())
    }
}
