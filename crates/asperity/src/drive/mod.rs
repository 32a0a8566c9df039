//! The drives: loops that make rows.
//!
//! A row is one solved contact. In time ([`March`]) one step follows another; over velocities
//! ([`Steady`]) each row is a steady state of motion; elastic contacts ([`Elastic`]) have neither. All lend their rows through [`Drive`], so that whoever stores, judges
//! or shows rows needs one loop:
//!
//! ```text
//! let mut drive = drive::of(simulation, None)?;
//! while let Some(step) = drive.advance()? { record(step.row()) }
//! ```

mod coordinate;
mod elastic;
mod in_time;

pub use coordinate::{Axis, Coordinate};
pub use elastic::Elastic;
pub use in_time::March;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::error::{Error, Result};
use crate::load::Stage;
use crate::simulation::Simulation;
use crate::sliding::{Steady, SteadyMotion, Streaming};
use crate::step::{Checkpoint, Step};

/// What makes one row after the other.
pub trait Drive: Send {
    /// The next row, or `None` at the end.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the coordinate; [`last`](Self::last) then has the best state
    /// reached. [`Error::Undetermined`], [`Error::Interrupted`],
    /// [`Error::Missed`], [`Error::Invalid`].
    fn advance(&mut self) -> Result<Option<Step<'_>>>;

    /// The last row; after an error the state that the failed solve reached. `None` before the first.
    fn last(&self) -> Option<Step<'_>>;

    /// What is simulated.
    fn simulation(&self) -> &Simulation;

    /// The coordinates of all rows, as far as they are known beforehand.
    fn planned(&self) -> Vec<f64>;

    /// Number of rows in all, where it is known beforehand.
    fn rows_expected(&self) -> Option<usize>;

    /// Rows done.
    fn done(&self) -> usize;

    /// Whether the last row is done.
    fn finished(&self) -> bool;

    /// From the last row on this is prescribed, in place of what was to come: a stage that begins here. Without times of its own it has those
    /// of the run. Where it ends before the run, by its event or its duration, the value reached is held, until another stage is prescribed.
    ///
    /// ```
    /// use asperity::{drive::{Drive, March}, load::Stage, material::Creep, surface::{Part, Shape, undeformed_gap}, *};
    /// // A feedback: the load is chosen from row to row such that the approach of a creeping contact stays at 3 um.
    /// let grid = Grid::new([32, 32], [2e-3, 2e-3])?;
    /// let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
    /// let creep = Creep { instantaneous: 1e-8, terms: vec![asperity::material::CreepTerm { compliance: 1e-8, retardation_time: 1.0 }], fluidity: 0.0 };
    /// let mut march = March::new(Simulation {
    ///     loading: Loading { control: Control::Load, history: History::Step { value: 1.0 } }.into(), creep,
    ///     times: TimeGrid::Uniform { end: 4.0, steps: 40 },
    ///     ..Simulation::new(grid, undeformed_gap(&grid, &[sphere])?)
    /// })?;
    /// let mut approach = 0.0;
    /// while let Some(row) = march.advance()?.map(|step| step.row()) {
    ///     approach = row.approach;
    ///     if row.coordinate.value() < 4.0 {
    ///         // W is proportional to w^(3/2).
    ///         let value = row.load * (3e-6 / approach).powf(1.5);
    ///         march.prescribe(Stage::new(Control::Load, History::Step { value }))?;
    ///         march.advance()?;
    ///     }
    /// }
    /// assert!((approach / 3e-6 - 1.0).abs() < 0.01);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] by the rules of a stage; before the first row and after the last; where rows do not
    /// follow one another in time.
    fn prescribe(&mut self, stage: Stage) -> Result<()> {
        let expected = "a march in time: other rows do not follow one another";
        Err(Error::invalid("prescribed quantity", format!("{:?}", stage.control).to_lowercase(), expected))
    }

    /// Stops, within one iteration of the solver, when `flag` becomes true.
    fn interrupt_with(&mut self, flag: Arc<AtomicBool>);

    /// Everything that the rows to come depend on: resumed from it ([`resume`]), they have the same bits.
    fn checkpoint(&self) -> Checkpoint<'_>;

    /// The creep functions of the bodies that stream through a contact in steady motion.
    fn streaming(&self) -> Option<&Streaming> {
        None
    }
}

/// The drive of a simulation: in time, or over the velocities of `steady`.
///
/// # Errors
/// As [`March::new`] and [`Steady::new`].
pub fn of(simulation: Simulation, steady: Option<SteadyMotion>) -> Result<Box<dyn Drive>> {
    Ok(match steady {
        None => Box::new(March::new(simulation)?),
        Some(motion) => Box::new(Steady::new(simulation, motion)?),
    })
}

/// Goes on where a checkpoint of the same simulation was taken.
///
/// # Errors
/// As [`of`]; [`Error::Invalid`] where the checkpoint belongs to another simulation.
pub fn resume(
    simulation: Simulation,
    steady: Option<SteadyMotion>,
    checkpoint: &Checkpoint,
) -> Result<Box<dyn Drive>> {
    Ok(match steady {
        None => Box::new(March::resume(simulation, checkpoint)?),
        Some(motion) => Box::new(Steady::resume(simulation, motion, checkpoint)?),
    })
}
