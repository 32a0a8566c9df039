//! Contacts in motion.
//!
//! Friction is the small difference of large forces in front of and behind each asperity. Each row states how uncertain it is
//! ([`Friction`](crate::sliding::Friction)). On a periodic domain the material
//! returns to the contact before it has recovered. This is correct for a rough surface, but not for a single body.

use super::words::{digits, rows, si};
use super::{FRICTION_UNCERTAIN, FRICTION_ZERO, Finding, LEAK_IN_MOTION, OWN_TRACK};
use crate::drive::Coordinate;
use crate::grid::Grid;
use crate::sliding::{Direction, Friction};

/// Largest uncertainty of friction.
const UNCERTAIN: f64 = 0.1;
/// Below this, a friction coefficient is only the error of the solve.
const NONE: f64 = 1e-7;
/// In time, rows with less than this fraction of the largest force are ignored, because friction changes its sign there.
const SMALL: f64 = 0.1;
/// Memory length over the way back to its own track from which on a body meets what it has left there. Beyond many such ways the whole
/// track stays relaxed.
const REACH: f64 = 0.1;
/// Smallest fraction of the compliance of a relevant branch.
const SHARE: f64 = 0.05;

/// The friction of the rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Slides {
    /// Number of a row of a motion in time, the size of its force \[N\], and its uncertainty.
    rows: Vec<(usize, f64, f64)>,
    /// Number and uncertainty of a steady state.
    steady: Vec<(usize, f64)>,
}

impl Slides {
    pub(super) fn see(&mut self, index: usize, coordinate: Coordinate, friction: &Friction) {
        if friction.coefficient.abs() <= NONE {
            return;
        }
        match coordinate {
            Coordinate::Velocity(_) => self.steady.push((index, friction.uncertainty)),
            _ => self.rows.push((index, friction.force.abs(), friction.uncertainty)),
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let largest = self.rows.iter().map(|row| row.1).fold(0.0, f64::max);
        let in_time = self.rows.iter().filter(|(_, force, _)| *force > SMALL * largest);
        let judged = in_time.map(|(index, _, off)| (*index, *off)).chain(self.steady.iter().copied());
        let found: Vec<(usize, f64)> = judged.filter(|(_, off)| *off > UNCERTAIN).collect();
        let at = [found.first()?.0, found.last()?.0];
        let worst = found.iter().map(|row| row.1).fold(0.0, f64::max);
        let text = format!(
            "The friction force is uncertain by up to {} of it ({}), more than {UNCERTAIN}: the cells do not resolve the edges of the \
             contact, or the time steps are long for the material. Refine the grid (domain.cells), leave short waves out, or take \
             shorter steps (motion.cells_per_step).",
            digits(worst),
            rows(at)
        );
        Some(Finding::warning(FRICTION_UNCERTAIN, worst, UNCERTAIN, text).at(at))
    }
}

/// A single body that moves this way on a periodic domain at these velocities \[m/s\], over material with branches of compliance
/// \[1/Pa\] and retardation time \[s\].
pub fn own_track(
    grid: &Grid,
    direction: Direction,
    velocities: &[f64],
    branches: &[(f64, f64)],
    instantaneous: f64,
) -> Option<Finding> {
    let total: f64 = instantaneous + branches.iter().map(|branch| branch.0).sum::<f64>();
    let length = direction.return_length(grid);
    let reaches = |v: f64| {
        let counting = branches.iter().filter(|(compliance, _)| *compliance > SHARE * total);
        counting.map(|(_, time)| v * time / length).filter(|share| *share > REACH).fold(0.0, f64::max)
    };
    let worst = velocities.iter().map(|v| reaches(*v)).fold(0.0, f64::max);
    (worst > 0.0).then(|| {
        let text = format!(
            "On the periodic domain the body meets its own track every {}, before the material has recovered: within a retardation \
             time it moves {} times that way. For a single body use boundary = \
             \"free\" (a steady state needs no track) or a longer domain. For one of many bodies in a row this is correct.",
            si(length, "m"),
            digits(worst)
        );
        Finding::warning(OWN_TRACK, worst, REACH, text)
    })
}

/// A leak through a contact that moves.
pub fn leak_in_motion() -> Finding {
    let text = "The leak is that of a gap that stands still under the pressure drop: the flow that the moving surfaces drag along is not \
                solved. It counts where velocity x viscosity x length / gap² is not small against the pressure drop.";
    Finding::warning(LEAK_IN_MOTION, f64::NAN, f64::NAN, text).as_note()
}

/// A motion in which no viscoelastic body moves through the contact.
pub fn friction_zero() -> Finding {
    let text = "No viscoelastic body moves through the contact, so the bulk friction is zero at any velocity: the bodies are \
                elastic, or the viscoelastic body is at rest relative to the contact (motion.over, motion.kind).";
    Finding::warning(FRICTION_ZERO, 0.0, f64::NAN, text).as_note()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_meets_its_track_after_the_side_along_its_motion() {
        let grid = Grid::new([32, 8], [8.0, 2.0]).unwrap();
        // Half the compliance, with a memory of 0.3 at unit velocity: 0.15 of the short side, 0.04 of the long one.
        let found = |direction| own_track(&grid, direction, &[1.0], &[(1.0, 0.3)], 1.0);
        assert!(found(Direction::X).is_none());
        let along_y = found(Direction::Y).unwrap();
        assert!((along_y.value.unwrap() - 0.15).abs() < 1e-12 && along_y.text.contains("every 2 m"));
        // A memory of many ways leaves the whole track relaxed.
        assert!(own_track(&grid, Direction::X, &[1.0], &[(1.0, 1e4)], 1.0).is_some());
        // atan(1/4) is the diagonal; at 45 degrees (8, 8) is the first image on the way, as (0, 2) lies beside it by 1.4; at 80 degrees (0, 2) lies beside it by 0.35.
        let length = |degrees: f64| Direction::Angle(degrees.to_radians()).return_length(&grid);
        let diagonal = f64::hypot(8.0, 2.0);
        for (degrees, exact) in [
            (0.25_f64.atan().to_degrees(), diagonal),
            (45.0, 128.0_f64.sqrt()),
            (80.0, 2.0 * 80.0_f64.to_radians().sin()),
            (180.0, 8.0),
            (-90.0, 2.0),
        ] {
            assert!((length(degrees) - exact).abs() < 1e-9, "{degrees}: {} {exact}", length(degrees));
        }
    }
}
