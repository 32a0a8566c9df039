//! What wears, and by how much.

use ndarray::Array2;

use crate::contact::Solver;
use crate::error::{Error, Of, Result, require};
use crate::grid::Grid;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::sliding::Path;

/// Cycles that a computed one may stand for.
const MOST_CYCLES: f64 = 1e9;

/// Archard's law for both bodies.
///
/// ```
/// use std::sync::Arc;
/// use asperity::{drive::March, material::Creep, sliding::Path, surface::{Part, Shape, undeformed_gap}, wear::Wear, *};
/// // A sphere under 1 N slides at 1 m/s for 10 s: k W s = 1e-13 m²/N x 1 N x 10 m.
/// let grid = Grid::new([32, 32], [0.6e-3, 0.6e-3])?;
/// let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
/// let path = Path::of_velocity(History::Step { value: 1.0 }, 0.0)?;
/// let mut march = March::new(Simulation {
///     creep: Creep::elastic(1e-9),
///     loading: Loading { control: Control::Load, history: History::Step { value: 1.0 } }.into(),
///     times: TimeGrid::Uniform { end: 10.0, steps: 5 },
///     wear: Some(Arc::new(Wear { path: Some(path), ..Wear::new([1e-13, 0.0]) })),
///     quantities: quantities::Quantities::of([quantities::Quantity::WearVolume]),
///     ..Simulation::new(grid, undeformed_gap(&grid, &[sphere])?)
/// })?;
/// let mut volume = 0.0;
/// while let Some(step) = march.advance()? {
///     volume = step.quantity(quantities::Quantity::WearVolume).unwrap()[0];
/// }
/// assert!((volume / 1e-12 - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Wear {
    /// k of the body, which moves with the contact, and of the counterbody \[m²/N\].
    pub coefficients: [f64; 2],
    /// Factor of both in each cell, shape (nx, ny); 1 if not given.
    pub map: Option<Array2<f64>>,
    /// Pressure below which nothing wears \[Pa\].
    pub threshold: f64,
    /// The sliding distance over time; `None` where the motion of the contact or its slip gives it.
    pub path: Option<Path>,
    /// Cycles of slip that a computed one stands for, at most.
    pub cycles: f64,
    /// Share of what a cycle wears whose place may be uncertain: the cycles that each computed one stands for follow from it. They are
    /// always as many as `cycles` where this is `None`.
    pub cycles_tolerance: Option<f64>,
    /// The depth at which a body is worn out \[m\]; it only says when that is.
    pub depth_limit: Option<f64>,
}

/// What slides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sliding {
    /// The bodies, along a path, while the contact stays in its place on the grid.
    Path,
    /// The contact, over the grid.
    Motion,
    /// Each cell, by its slip under a tangential load.
    Slip,
}

impl Wear {
    /// Of these coefficients, without threshold; the sliding distance is that of motion or slip.
    pub fn new(coefficients: [f64; 2]) -> Self {
        Wear {
            coefficients,
            map: None,
            threshold: 0.0,
            path: None,
            cycles: 1.0,
            cycles_tolerance: None,
            depth_limit: None,
        }
    }

    /// Whether a quantity of wear says anything: that of the counterbody where it wears, cycles where the surfaces slip under a load that
    /// repeats, else the distance.
    pub fn has(&self, quantity: Quantity, slips: bool) -> bool {
        match quantity {
            Quantity::CounterbodyWearVolume => self.coefficients[1] > 0.0,
            Quantity::WearCycles => slips,
            Quantity::WearDistance => !slips,
            quantity => quantity.is_of_wear(),
        }
    }

    pub(crate) fn sliding(&self, simulation: &Simulation) -> Sliding {
        match (&simulation.motion, &simulation.tangential) {
            (Some(_), _) => Sliding::Motion,
            (None, Some(_)) => Sliding::Slip,
            (None, None) => Sliding::Path,
        }
    }

    /// Sliding distance between two times \[m\]; 0 where slip decides.
    pub(crate) fn distance(&self, simulation: &Simulation, from: f64, to: f64) -> f64 {
        let path = simulation.motion.as_ref().map(|motion| &motion.path).or(self.path.as_ref());
        path.map_or(0.0, |path| path.travel(from, to))
    }

    /// The share of the worn depth that either body takes where both wear in the same place.
    pub(crate) fn shares(&self) -> [f64; 2] {
        self.coefficients.map(|k| k / self.total())
    }

    /// k of both together.
    pub(crate) fn total(&self) -> f64 {
        self.coefficients.iter().sum()
    }

    /// The times at which the sliding velocity bends or jumps.
    pub(crate) fn breaks(&self, end: f64) -> Vec<f64> {
        self.path.iter().flat_map(|path| path.breaks(end)).collect()
    }

    /// Bytes that a run with wear takes besides.
    pub(crate) fn bytes(&self, grid: &Grid, simulation: &Simulation) -> usize {
        let bodies = self.coefficients.iter().filter(|k| **k > 0.0).count();
        // the gap and that before the step, a copy for the bed, cells above the threshold
        let fields = 3 + bodies + if self.threshold > 0.0 { 2 } else { 0 };
        let slips = self.sliding(simulation) == Sliding::Slip;
        // the contact of the worn surfaces with a solver of its own, and the slip
        let slip = if slips { 5 } else { 0 };
        let solver = match slips {
            true => Solver::bytes(simulation.solver.method, grid, simulation.boundary),
            false => 0,
        };
        8 * grid.len() * (fields + slip) + solver
    }

    /// Checks what can be known before the run; of the sliding distance once the motion is known.
    ///
    /// # Errors
    /// [`Error::Invalid`] with the key of the case.
    pub(crate) fn validate(&self, simulation: &Simulation) -> Result<()> {
        self.validate_numbers(simulation)?;
        let is_coupled = simulation.tangential.as_ref().is_some_and(|law| law.is_coupled());
        let expected = "\"neglect\" where the surfaces wear";
        require(!is_coupled, "coupling of pressure and traction", "\"full\"", expected)
            .of("friction.coupling")
    }

    /// Checks what slides.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub(crate) fn validate_sliding(&self, simulation: &Simulation) -> Result<()> {
        let sliding = self.sliding(simulation);
        let expected = "a velocity, or a motion of the contact, or a load along the surfaces";
        let known = self.path.is_some() || sliding != Sliding::Path;
        require(known, "sliding distance of wear", "not given", expected).of("wear")?;
        let expected = "left out: the sliding distance is that of [motion], or the slip under [tangential]";
        let alone = self.path.is_none() || sliding == Sliding::Path;
        require(alone, "velocity of wear", "given", expected).of("wear.velocity")?;
        let expected = "left out: it belongs to places of bodies that do not move";
        let in_place = self.map.is_none() || sliding != Sliding::Motion;
        require(in_place, "map of wear beside [motion]", "given", expected).of("wear.map")?;
        let expected = "1 where no slip repeats; without [tangential] a longer time step or a larger velocity does the same";
        require(self.cycles == 1.0 || sliding == Sliding::Slip, "cycles per step", self.cycles, expected)
            .of("wear.cycles_per_step")?;
        let period = simulation.tangential.as_ref().and_then(|tangential| tangential.period());
        let expected = "left out, or a load along the surfaces that is a sine with a period";
        require(self.cycles_tolerance.is_none() || period.is_some(), "cycles_tolerance", "given", expected)
            .of("wear.cycles_tolerance")?;
        let expected =
            "left out, or cycles_per_step, the largest number of cycles that a computed one stands for";
        require(self.cycles_tolerance.is_none() || self.cycles > 1.0, "cycles_tolerance", "given", expected)
            .of("wear.cycles_tolerance")
    }

    fn validate_numbers(&self, simulation: &Simulation) -> Result<()> {
        for k in self.coefficients {
            let sound = k.is_finite() && k >= 0.0;
            require(sound, "wear coefficient", format!("{k} m2/N"), "finite and not negative")
                .of("wear.coefficient")?;
        }
        require(self.total() > 0.0, "wear coefficient", "0 of both bodies", "greater than 0 of one of them")
            .of("wear.coefficient")?;
        let sound = self.threshold.is_finite() && self.threshold >= 0.0;
        require(sound, "threshold of wear", format!("{} Pa", self.threshold), "finite and not negative")
            .of("wear.threshold")?;
        let [_, hardest] = simulation.hardness_range();
        let expected =
            format!("less than the hardness, {hardest} Pa: above it there is no pressure, and nothing wears");
        require(self.threshold < hardest, "threshold of wear", format!("{} Pa", self.threshold), expected)
            .of("wear.threshold")?;
        let sound = (1.0..=MOST_CYCLES).contains(&self.cycles);
        require(sound, "cycles per step", self.cycles, format!("between 1 and {MOST_CYCLES:e}"))
            .of("wear.cycles_per_step")?;
        let sound = self.cycles_tolerance.is_none_or(|share| share > 0.0 && share <= 1.0);
        require(
            sound,
            "tolerance of the cycles",
            self.cycles_tolerance.unwrap_or_default(),
            "greater than 0 and at most 1",
        )
        .of("wear.cycles_tolerance")?;
        let sound = self.depth_limit.is_none_or(|depth| depth.is_finite() && depth > 0.0);
        require(
            sound,
            "depth limit of wear",
            format!("{:?} m", self.depth_limit),
            "finite and greater than 0",
        )
        .of("wear.depth_limit")?;
        let Some(map) = &self.map else { return Ok(()) };
        let shape = simulation.grid.shape();
        require(
            map.dim() == shape,
            "shape of the map of wear",
            format!("{:?}", map.dim()),
            format!("{shape:?}, one for each cell"),
        )
        .of("wear.map")?;
        match map.indexed_iter().find(|(_, factor)| !(factor.is_finite() && **factor >= 0.0)) {
            Some(((i, j), factor)) => {
                let what = format!("factor of wear of cell ({i}, {j})");
                Err(Error::invalid(what, factor, "finite and not negative").of("wear.map"))
            }
            None => Ok(()),
        }
    }
}
