//! Contacts in motion.
//!
//! Friction is the small difference of large forces in front of and behind each asperity. Two estimates of it agree to the extent
//! that the grid resolves the edges of the contact, so their difference measures the accuracy. On a periodic domain the material
//! returns to the contact before it has recovered. This is correct for a rough surface, but not for a single body.

use super::words::{digits, rows, si};
use super::{FRICTION_UNCERTAIN, FRICTION_ZERO, Finding, OWN_TRACK};
use crate::grid::Grid;
use crate::sliding::Friction;

/// Largest relative difference of the two estimates of friction.
const UNCERTAIN: f64 = 0.1;
/// Below this, a friction coefficient is only the error of the solve.
const NONE: f64 = 1e-7;
/// Rows with less than this fraction of the largest force are ignored, because friction changes its sign there.
const SMALL: f64 = 0.1;
/// Range of memory length over domain in which the previous contact still has an effect at the next one.
const REACH: std::ops::Range<f64> = 0.1..10.0;
/// Smallest fraction of the compliance of a relevant branch.
const SHARE: f64 = 0.05;

/// The friction of the rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Slides {
    /// Number of a row, the size of its force \[N\], and its uncertainty.
    rows: Vec<(usize, f64, f64)>,
}

impl Slides {
    pub(super) fn see(&mut self, index: usize, friction: &Friction) {
        if friction.coefficient.abs() > NONE {
            self.rows.push((index, friction.force.abs(), friction.uncertainty));
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let largest = self.rows.iter().map(|row| row.1).fold(0.0, f64::max);
        let uncertain =
            self.rows.iter().filter(|(_, force, off)| *force > SMALL * largest && *off > UNCERTAIN);
        let found: Vec<_> = uncertain.collect();
        let at = [found.first()?.0, found.last()?.0];
        let worst = found.iter().map(|row| row.2).fold(0.0, f64::max);
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

/// A single body on a periodic domain along which it moves at these velocities \[m/s\], over material with branches of compliance
/// \[1/Pa\] and retardation time \[s\].
pub fn own_track(
    grid: &Grid,
    velocities: &[f64],
    branches: &[(f64, f64)],
    instantaneous: f64,
) -> Option<Finding> {
    let total: f64 = instantaneous + branches.iter().map(|branch| branch.0).sum::<f64>();
    let length = grid.size()[0];
    let reaches = |v: f64| {
        let counting = branches.iter().filter(|(compliance, _)| *compliance > SHARE * total);
        counting.map(|(_, time)| v * time / length).filter(|share| REACH.contains(share)).fold(0.0, f64::max)
    };
    let worst = velocities.iter().map(|v| reaches(*v)).fold(0.0, f64::max);
    (worst > 0.0).then(|| {
        let text = format!(
            "On the periodic domain of {} the material returns to the contact before it has recovered: within its retardation time it \
             moves by {} of the length of the domain, so the body runs over its own track. For a single body use boundary = \
             \"free\" (a steady state needs no track) or a longer domain. For one of many bodies in a row this is correct.",
            si(length, "m"),
            digits(worst)
        );
        Finding::warning(OWN_TRACK, worst, REACH.start, text)
    })
}

/// A motion in which no viscoelastic body moves through the contact.
pub fn friction_zero() -> Finding {
    let text = "No viscoelastic body moves through the contact, so the bulk friction is zero at any velocity: the bodies are \
                elastic, or the viscoelastic body is at rest relative to the contact (motion.over, motion.kind).";
    Finding::warning(FRICTION_ZERO, 0.0, f64::NAN, text).as_note()
}
