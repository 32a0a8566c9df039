//! A contact that moves over a body in time.
//!
//! The memory stays with the material, and the grid with it: the gap moves, h(x, t) = h(x - X(t)), and each step is the elastic
//! contact that it would be anyway. Nothing is carried along, so nothing is lost on the way. Steps end where the gap has moved
//! by whole cells: the contact patch only shifts, and just the history changes.

use asperity_sweep::{each, zeros};
use ndarray::{Array2, ArrayView2};

use super::{Process, Solved};
use crate::error::{Of, Result, require, significant};
use crate::flash::{FlashSolver, Rise, Rubbing};
use crate::grid::{Boundary, Grid};
use crate::quantities::Quantity;
use crate::simulation::{Plasticity, Scheme, Simulation};
use crate::sliding::{ContactForces, Direction, Friction, MovingGap, Path, ShearStress, Slopes};
use crate::step::{Interval, Loader, Saver, UndeformedGap, saved};

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
    /// A shear stress on the area in contact, for [`Friction::total`].
    pub shear_stress: Option<ShearStress>,
}

impl Motion {
    /// Whether steps may be as long as this number of cells.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) where it is not above 0 and at most 8.
    pub fn check_cells_per_step(cells: f64) -> Result<()> {
        let fine = cells > 0.0 && cells <= 8.0;
        require(fine, "cells_per_step", cells, "greater than 0 and at most 8").of("cells_per_step")
    }

    /// Cells along x and y that the contact has gone at a time.
    pub(crate) fn cells_gone(&self, grid: &Grid, time: f64) -> [f64; 2] {
        let (gone, spacing, unit) = (self.path.position(time), grid.spacing(), self.direction.unit());
        [0, 1].map(|axis| near_whole(unit[axis] * gone / spacing[axis]))
    }

    /// Length of a step along the path, at most \[m\].
    fn step(&self, simulation: &Simulation) -> f64 {
        self.cells_per_step * self.direction.cell(&simulation.grid)
    }

    /// The instants at which steps end because of the motion, and those of them at which the velocity bends or jumps.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the travel is too long.
    pub(crate) fn stops(&self, simulation: &Simulation) -> Result<Vec<f64>> {
        self.path.crossings(self.step(simulation), simulation.times.end())
    }

    /// Checks what can be known before the run.
    pub(crate) fn validate(&self, simulation: &Simulation) -> Result<()> {
        Motion::check_cells_per_step(self.cells_per_step)?;
        let stays = simulation.wear.is_some() || simulation.plasticity == Plasticity::Accumulate;
        require(
            !stays || self.cells_per_step <= 1.0,
            "cells_per_step of surfaces that wear or keep their dents",
            self.cells_per_step,
            "at most 1: longer steps leave stripes",
        )
        .of("cells_per_step")?;
        let stops = self.stops(simulation)?;
        require(
            simulation.scheme == Scheme::Linear,
            "scheme of a contact in motion",
            format!("{:?}", simulation.scheme).to_lowercase(),
            "linear: with a pressure that is constant in each step friction is wrong by tens of per cent",
        )?;
        self.direction.validate(simulation)?;
        self.shear_stress.iter().try_for_each(ShearStress::validate).of("shear_stress")?;
        let follows = self.gap.follows();
        // A smooth slider over a contact that stays is everywhere alike.
        let is_alike = !follows && !self.gap.moves_and_stands()[0] && !stays;
        if simulation.boundary == Boundary::Free && !is_alike {
            let axis = self.direction.axis();
            let (length, start) = (simulation.grid.size()[axis], self.gap.centre()[axis]);
            // Of the contact on the track, or on the body that moves over a contact that stays.
            let (sense, what) = match follows {
                true => (1.0, "place of the moving body on a free domain"),
                false => (-1.0, "place of the contact on the moving body on a free domain"),
            };
            let places = stops.iter().map(|t| start + sense * self.path.position(*t));
            let [least, most] = places.fold([start; 2], |[least, most], x| [least.min(x), most.max(x)]);
            let expected = format!(
                "within 0 m and {length} m, its track: the grid does not go with the body. Take a domain that holds the travel of \
                 {} m and the contact, let the body start elsewhere (center), or take a periodic domain or steady states \
                 ([motion.steady])",
                significant(most - least, 4)
            );
            let track = format!("{} m to {} m", significant(least, 4), significant(most, 4));
            let on_track = least >= 0.0 && most <= length;
            require(on_track, what, track, expected)?;
        }
        Ok(())
    }
}

/// The contact in motion: where the gap is at the end of the step under way, and the forces of the last row.
pub(super) struct Moving {
    motion: Motion,
    spacing: [f64; 2],
    slopes: Slopes,
    /// Whether wear or dents change the gap besides.
    changes: bool,
    /// How far it has moved \[m\].
    distance: f64,
    /// How far it had at the end of the last row.
    before: f64,
    friction: Friction,
    /// Error of the stress of the last row because of the time steps: a short step does not take it back.
    time_error: f64,
    swing: Swing,
    flash: Option<FlashSolver>,
}

/// The largest error of the force over the last cell of the way.
///
/// Between two cells the force swings as cells enter and leave the contact. What a row knows of its error swings too, but it may be
/// smallest where the error is largest. So a row states the largest error since the start of the cell of the way before.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    /// Where this cell of the way began \[m\].
    start: f64,
    /// Largest error in this cell and in the one before \[N\].
    errors: [f64; 2],
}

impl Swing {
    /// Takes in the error of a row after a step along `way`; returns what the row states.
    fn see(&mut self, way: [f64; 2], cell: f64, error: f64) -> f64 {
        let [before, now] = way;
        let gone = (now - self.start).abs();
        if now == before || gone > 2.0 * cell {
            *self = Swing { start: now, errors: [0.0; 2] };
        } else if gone > (1.0 - 1e-9) * cell {
            *self = Swing { start: now, errors: [0.0, self.errors[0]] };
        }
        self.errors[0] = self.errors[0].max(error);
        self.errors[0].max(self.errors[1])
    }
}

saved! {
    Moving {
        "distance": before;
        "force": friction.force;
        "time_error": time_error;
        "swing": swing.start, swing.errors;
    }
}

impl Moving {
    pub(super) fn new(simulation: &Simulation, motion: &Motion) -> Self {
        let (_, slopes) = motion.gap.at(0.0, motion.direction);
        let flash = FlashSolver::of(simulation, motion.direction);
        let (motion, spacing) = (motion.clone(), simulation.grid.spacing());
        Moving {
            motion,
            spacing,
            slopes,
            changes: simulation.wear.is_some() || simulation.plasticity == Plasticity::Accumulate,
            distance: 0.0,
            before: 0.0,
            friction: Friction::default(),
            time_error: 0.0,
            swing: Swing::default(),
            flash,
        }
    }

    /// The forces at the end of a step; `held` is the error that they state for one that is known of them.
    fn forces(&self, row: &Solved<'_>, time_error: f64, held: impl FnOnce(f64) -> f64) -> Friction {
        let velocity = self.motion.path.velocity(row.step.instant.time);
        let is_wet = row.simulation.traction.as_ref().is_some_and(|law| law.as_fluid().is_some());
        let contact = &row.contact.pressure[..];
        let changed = row.undeformed.own_slopes.as_ref().map(|own| self.slopes.and(own));
        let contact = ContactForces {
            simulation: row.simulation,
            direction: self.motion.direction,
            slopes: changed.as_ref().unwrap_or(&self.slopes),
            state: row.now,
            pressure: if is_wet { contact } else { &row.now.pressure },
            contact,
            fluid_load: if is_wet { row.loads[1] - row.contact_loads()[1] } else { 0.0 },
            gap: row.gap(),
            compliance: row.compliance,
            loses: row.simulation.loses(),
            velocity,
            sense: self.motion.path.sense(row.step.instant.time),
            distance: self.distance,
            shear_stress: self.motion.shear_stress.as_ref().map(|law| law.at(velocity, 1.0)),
        };
        Friction::in_time(&contact, time_error, held)
    }

    /// Finds how warm the surfaces are after as long a time at the velocity of the row as they need.
    fn warm(&mut self, row: &Solved<'_>, friction: Friction) -> Result<()> {
        let Some(flash) = &mut self.flash else { return Ok(()) };
        let velocity = friction.velocity;
        // All the heat arises under the contact pressure.
        let coefficient = match row.simulation.traction {
            None => friction.coefficient,
            Some(_) => friction.force / row.contact_loads()[1].max(f64::MIN_POSITIVE),
        };
        flash.warm(Rubbing {
            velocity,
            pressure: &row.contact.pressure,
            shear: self.motion.shear_stress.as_ref().map_or(0.0, |law| law.at(velocity, 1.0)),
            loss: coefficient * velocity.signum(),
        })
    }

    fn move_to(&mut self, distance: f64, gap: &mut UndeformedGap) {
        if distance == self.distance && !self.changes {
            return;
        }
        gap.own_slopes = None;
        let (moved, slopes) = self.motion.gap.at(distance, self.motion.direction);
        gap.own_mut().iter_mut().zip(&moved).for_each(|(to, h)| *to = *h);
        (self.slopes, self.distance) = (slopes, distance);
    }
}

impl Process for Moving {
    fn open(&mut self, step: &Interval, gap: &mut UndeformedGap) -> Result<()> {
        self.move_to(self.motion.path.position(step.instant.time), gap);
        Ok(())
    }

    fn shift(&self, step: &Interval) -> Option<[isize; 2]> {
        let gone = self.motion.path.position(step.instant.time) - self.before;
        let gone_with = if self.motion.gap.follows() { gone } else { 0.0 };
        (gone != 0.0).then(|| cells(self.motion.direction, self.spacing, gone_with))
    }

    /// Finds how warm the row is.
    fn prepare(&mut self, row: &mut Solved<'_>) -> Result<()> {
        if self.flash.is_some() {
            self.warm(row, self.forces(row, 0.0, |error| error))?;
        }
        Ok(())
    }

    /// Finds the forces at the end of the row.
    fn accept(&mut self, row: &mut Solved<'_>) {
        let time_error = row.time_error.unwrap_or(0.0);
        let (way, cell) = ([self.before, self.distance], self.motion.direction.cell(&row.simulation.grid));
        let mut swing = self.swing;
        let friction = self.forces(row, time_error.max(self.time_error), |error| swing.see(way, cell, error));
        self.swing = swing;
        let before = std::mem::replace(&mut self.before, self.distance);
        let way = self.distance - before;
        row.other_work += 0.5 * (self.friction.force + friction.force) * way;
        if row.simulation.traction.is_some() {
            // Where in the step surfaces that adhere have jumped is not known.
            row.unknown_work += 0.5 * ((friction.force - self.friction.force) * way).abs();
        }
        (self.friction, self.time_error) = (friction, time_error);
    }

    fn preview(&mut self, quantity: Quantity, row: &mut Solved<'_>) -> Result<Option<f64>> {
        if quantity.is_of_flash() {
            let rise = self.flash.as_ref().map(|flash| flash.rise.clone());
            self.warm(row, self.forces(row, 0.0, |error| error))?;
            let found = self.rise().and_then(|rise| rise.row.quantity(quantity));
            self.flash.iter_mut().zip(rise).for_each(|(flash, rise)| flash.rise = rise);
            return Ok(found);
        }
        let is_own = quantity.is_of_motion() && quantity != Quantity::DissipatedPower;
        Ok(is_own.then(|| self.forces(row, 0.0, |error| error).quantity(quantity)).flatten())
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        if let Some(found) = self.rise().and_then(|rise| rise.row.quantity(quantity)) {
            return Some(found);
        }
        self.friction.quantity(quantity).filter(|_| quantity != Quantity::DissipatedPower)
    }

    fn rise(&self) -> Option<&Rise> {
        self.flash.as_ref().map(|flash| &flash.rise)
    }

    fn name(&self) -> &'static str {
        "motion"
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>, _gap: &'a UndeformedGap) {
        self.save_own(to);
    }

    fn load(&mut self, from: &mut Loader<'_>, gap: &mut UndeformedGap) -> Result<()> {
        self.load_own(from)?;
        self.move_to(self.before, gap);
        Ok(())
    }
}

/// The number itself, or the whole number that it is up to rounding.
fn near_whole(cells: f64) -> f64 {
    if (cells - cells.round()).abs() < 1e-6 { cells.round() } else { cells }
}

/// A distance in this direction, in cells along x and y, rounded.
pub(crate) fn cells(direction: Direction, spacing: [f64; 2], distance: f64) -> [isize; 2] {
    let unit = direction.unit();
    [0, 1].map(|axis| (unit[axis] * distance / spacing[axis]).round() as isize)
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
        let at = boundary.beside(i, shift[0], nx).zip(boundary.beside(j, shift[1], ny));
        at.map_or(beyond, |at| field[at])
    })
}

/// `to` = `from` moved by `shift` cells; beyond the ends of a free domain there is 0.
pub(crate) fn roll(
    (nx, ny): (usize, usize),
    boundary: Boundary,
    shift: [isize; 2],
    from: &[f64],
    to: &mut [f64],
) {
    for (i, row) in to.chunks_mut(ny).enumerate() {
        let Some(a) = boundary.beside(i, -shift[0], nx) else {
            row.fill(0.0);
            continue;
        };
        for (j, to) in row.iter_mut().enumerate() {
            *to = boundary.beside(j, -shift[1], ny).map_or(0.0, |b| from[a * ny + b]);
        }
    }
}

/// A field moved by these cells along x and y, between cells linearly; beyond the ends of a free domain there is 0.
pub(crate) fn carry(grid: &Grid, boundary: Boundary, offset: [f64; 2], field: &[f64]) -> Vec<f64> {
    let whole = offset.map(f64::floor);
    let part = [0, 1].map(|axis| offset[axis] - whole[axis]);
    let (mut sum, mut corner): (Vec<f64>, Vec<f64>) = (zeros(field.len()), zeros(field.len()));
    for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let weight = |next: i32, part: f64| if next == 1 { part } else { 1.0 - part };
        let weight = weight(i, part[0]) * weight(j, part[1]);
        if weight != 0.0 {
            let shift = [whole[0] as isize + i as isize, whole[1] as isize + j as isize];
            roll(grid.shape(), boundary, shift, field, &mut corner);
            each(&mut sum, &corner[..], |to, from| *to += weight * from);
        }
    }
    sum
}
