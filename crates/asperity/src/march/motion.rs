//! A contact that moves over a body in time.
//!
//! The memory stays with the material, and the grid with it: the gap moves, h(x, t) = h(x - X(t)), and each step is the elastic
//! contact that it would be anyway. Nothing is carried along, so nothing is lost on the way. Steps end where the gap has moved
//! by whole cells: the contact of a step is then that of the last one, moved, but for what the material remembers.

use ndarray::{Array2, ArrayView2};

use super::{March, Scheme, Simulation, Step};
use crate::contact::Start;
use crate::error::{Error, Result};
use crate::grid::Boundary;
use crate::march::Plasticity;
use crate::material::Creep;
use crate::sliding::{ContactForces, Direction, Friction, MovingGap, Path, SecondEstimate, Slopes};
use crate::time::Instant;

/// How a contact moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// How far, over time.
    pub path: Path,
    /// Which way.
    pub direction: Direction,
    /// The gap, wherever its moving parts are; that of the simulation is its gap at the start.
    pub gap: MovingGap,
    /// Cells that the gap moves in a step, at most.
    pub cells_per_step: f64,
    /// A shear stress on the area in contact \[Pa\], for [`Friction::total`].
    pub shear_stress: Option<f64>,
}

impl Motion {
    /// Length of a step along the path, at most \[m\].
    fn step(&self, simulation: &Simulation) -> f64 {
        self.cells_per_step * self.direction.cell(&simulation.grid)
    }

    /// The instants at which steps end because of the motion, and those of them at which the velocity bends or jumps.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the travel is too long.
    pub(super) fn stops(&self, simulation: &Simulation) -> Result<Vec<f64>> {
        self.path.crossings(self.step(simulation), simulation.times.end())
    }

    /// Checks what can be known before the run.
    pub(super) fn validate(&self, simulation: &Simulation) -> Result<()> {
        if !(self.cells_per_step.is_finite() && self.cells_per_step > 0.0 && self.cells_per_step <= 8.0) {
            return Err(Error::invalid(
                "cells_per_step",
                self.cells_per_step,
                "greater than 0 and at most 8",
            ));
        }
        let stops = self.stops(simulation)?;
        if simulation.scheme != Scheme::Linear {
            return Err(Error::invalid(
                "scheme of a contact in motion",
                format!("{:?}", simulation.scheme).to_lowercase(),
                "linear: with a pressure that is constant in each step friction is wrong by tens of per cent",
            ));
        }
        if simulation.plasticity == Plasticity::Accumulate {
            return Err(Error::invalid(
                "plasticity of a contact in motion",
                "accumulate",
                "cap: which of the two bodies keeps the dents is not known",
            ));
        }
        if simulation.grid.is_line() && self.direction != Direction::X {
            return Err(Error::invalid("direction of motion of a line contact", "not x", "x"));
        }
        if simulation.boundary == Boundary::Free {
            if let Direction::Angle(angle) = self.direction {
                return Err(Error::invalid(
                    "direction of motion on a free domain",
                    format!("{} degrees", rounded(angle.to_degrees())),
                    "x or y; other directions need a periodic domain",
                ));
            }
            let axis = usize::from(self.direction == Direction::Y);
            let (length, start) = (simulation.grid.size()[axis], self.gap.centre()[axis]);
            let places = stops.iter().map(|t| start + self.path.position(*t));
            let [least, most] = places.fold([start; 2], |[least, most], x| [least.min(x), most.max(x)]);
            if least < 0.0 || most > length {
                return Err(Error::invalid(
                    "place of the moving body on a free domain",
                    format!("{} m to {} m", rounded(least), rounded(most)),
                    format!(
                        "within 0 m and {length} m, its track: the grid does not go with the body. Take a domain that holds the travel of \
                         {} m and the contact, let the body start elsewhere (center), or take a periodic domain or steady states \
                         ([motion.steady])",
                        rounded(most - least)
                    ),
                ));
            }
        }
        Ok(())
    }
}

/// To four digits.
fn rounded(x: f64) -> String {
    format!("{x:.3e}").parse::<f64>().map_or_else(|_| x.to_string(), |x| x.to_string())
}

/// The gap at the end of the step under way.
pub(super) struct Moving {
    pub(super) gap: Vec<f64>,
    slopes: Slopes,
    /// How far it has moved \[m\].
    distance: f64,
    /// How far it had at the end of the last row.
    before: f64,
}

impl Moving {
    pub(super) fn new(motion: &Motion) -> Result<Self> {
        let (gap, slopes) = motion.gap.at(0.0, motion.direction)?;
        Ok(Moving { gap: gap.iter().copied().collect(), slopes, distance: 0.0, before: 0.0 })
    }

    /// The row that is done ended here.
    pub(super) fn settle(&mut self) {
        self.before = self.distance;
    }
}

impl Step<'_> {
    /// Cells along x and y that the contact has moved, rounded: fields in its frame are taken there (see
    /// [`in_contact_frame`]). 0 where nothing moves.
    pub fn frame_shift(&self) -> [isize; 2] {
        let (Some(motion), Some(friction)) = (&self.simulation.motion, self.friction) else { return [0; 2] };
        let cells = motion.direction.unit().into_iter().zip(self.simulation.grid.spacing());
        let mut shift = [0; 2];
        shift.iter_mut().zip(cells).for_each(|(s, (c, d))| *s = (c * friction.distance / d).round() as isize);
        shift
    }
}

impl March {
    /// Whether the gap moves in the step that ends at `instant`.
    pub(super) fn moves(&self, instant: Instant) -> bool {
        match (&self.simulation.motion, &self.moving) {
            (Some(motion), Some(moving)) => motion.path.position(instant.time) != moving.before,
            _ => false,
        }
    }

    /// Moves the gap to where it is at that instant.
    pub(super) fn move_gap(&mut self, time: f64) -> Result<()> {
        let (Some(motion), Some(moving)) = (&self.simulation.motion, &mut self.moving) else { return Ok(()) };
        let distance = motion.path.position(time);
        if distance == moving.distance {
            return Ok(());
        }
        let (gap, slopes) = motion.gap.at(distance, motion.direction)?;
        moving.gap.iter_mut().zip(&gap).for_each(|(to, h)| *to = *h);
        (moving.slopes, moving.distance) = (slopes, distance);
        Ok(())
    }

    /// The guess of a step in which the gap moves: the last pressure, moved by whole cells. `None` where it does not move.
    pub(super) fn guess_moved(&mut self, instant: Instant) -> Option<Start> {
        let (motion, moving) = (self.simulation.motion.as_ref()?, self.moving.as_ref()?);
        let grid = &self.simulation.grid;
        let gone = moving.distance - moving.before;
        let cells = motion
            .direction
            .unit()
            .into_iter()
            .zip(grid.spacing())
            .map(|(c, d)| (c * gone / d).round() as isize);
        let shift: Vec<isize> = cells.collect();
        if shift.iter().all(|s| *s == 0) || sum_is_zero(&self.previous.pressure) {
            return None;
        }
        let (shape, boundary) = (grid.shape(), self.simulation.boundary);
        let (from, to) = (&self.previous, &mut self.state);
        roll(shape, boundary, [shift[0], shift[1]], &from.pressure, &mut to.pressure);
        roll(shape, boundary, [shift[0], shift[1]], &from.unit_displacement, &mut to.unit_displacement);
        to.rounding = from.rounding + 1.0;
        to.approach = from.approach;
        let load = match self.prescribed(instant) {
            crate::contact::Prescribed::Load(load) => {
                let found = asperity_sweep::sum(&self.state.pressure) * self.simulation.grid.cell_area();
                (found / load - 1.0).abs() <= crate::contact::SAME_LOAD
            }
            crate::contact::Prescribed::Approach(_) => true,
        };
        let known =
            boundary == Boundary::Periodic && load && self.state.is_precise(self.simulation.solver.tolerance);
        Some(if known { Start::Displacement { feasible: true } } else { Start::Pressure })
    }

    /// The forces at the end of the row that was just solved.
    pub(super) fn find_friction(&mut self, instant: Instant) {
        let (Some(motion), Some(moving)) = (&self.simulation.motion, &mut self.moving) else { return };
        let Simulation { grid, boundary, .. } = &self.simulation;
        let remembers = |creep: &Creep| !creep.terms.is_empty() || creep.fluidity != 0.0;
        let contact = ContactForces {
            grid,
            boundary: *boundary,
            direction: motion.direction,
            slopes: &moving.slopes,
            pressure: &self.state.pressure,
            gap: &self.gap,
            compliance: self.compliance,
            unit_displacement: &self.state.unit_displacement,
            remembers: self.simulation.parts().any(remembers),
            velocity: motion.path.velocity(instant.time),
            distance: moving.distance,
            shear_stress: motion.shear_stress,
        };
        let friction = Friction::of(&contact, SecondEstimate::Differences);
        let before = std::mem::replace(&mut moving.before, moving.distance);
        self.slid = Slid {
            work: 0.5 * (self.friction.force + friction.force) * (moving.distance - before),
            dt: instant.dt,
        };
        self.friction = friction;
    }
}

/// What a step did along the path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slid {
    /// Work of the friction force in the step \[J\].
    pub(super) work: f64,
    /// Its length \[s\].
    pub(super) dt: f64,
}

fn sum_is_zero(p: &[f64]) -> bool {
    p.iter().all(|p| *p == 0.0)
}

/// A field of the body in the frame of the contact, which has moved by `shift` cells: (i, j) is the field's (i + shift x,
/// j + shift y). What comes from beyond the ends of a free domain is `beyond`.
pub fn in_contact_frame<T: Copy>(
    field: ArrayView2<'_, T>,
    boundary: Boundary,
    shift: [isize; 2],
    beyond: T,
) -> Array2<T> {
    let (nx, ny) = field.dim();
    Array2::from_shape_fn((nx, ny), |(i, j)| {
        let (a, b) = (source(i, -shift[0], nx, boundary), source(j, -shift[1], ny, boundary));
        a.zip(b).map_or(beyond, |at| field[at])
    })
}

/// The cell that cell n of a field moved by `shift` cells had been.
fn source(n: usize, shift: isize, count: usize, boundary: Boundary) -> Option<usize> {
    let m = n as isize - shift;
    match boundary {
        Boundary::Periodic => Some(m.rem_euclid(count as isize) as usize),
        Boundary::Free => (0..count as isize).contains(&m).then_some(m as usize),
    }
}

/// `to` = `from` moved by `shift` cells; beyond the ends of a free domain there is 0.
fn roll((nx, ny): (usize, usize), boundary: Boundary, shift: [isize; 2], from: &[f64], to: &mut [f64]) {
    for (i, row) in to.chunks_mut(ny).enumerate() {
        let Some(a) = source(i, shift[0], nx, boundary) else {
            row.fill(0.0);
            continue;
        };
        for (j, to) in row.iter_mut().enumerate() {
            *to = source(j, shift[1], ny, boundary).map_or(0.0, |b| from[a * ny + b]);
        }
    }
}
