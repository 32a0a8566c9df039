//! Steps as long as their error allows (docs/theory.md, "Steps that follow their error").
//!
//! The error of a step falls with the square of its length, so the next one is 0.9 sqrt(allowed/error) times as long, at
//! most twice and at least a fifth. After t = 0, a jump, a kink, a switch or an event, where no third state is known, a step is
//! solved at twice its length first.
//!
//! Where the contact itself changes at once (a body without instantaneous compliance whose cells touch one by one), no step is
//! short enough. So none is shorter than a millionth of the time since the smooth piece began; a step of that length is taken
//! with the error that it has, which `time_error` tells.

use crate::time::SHORTEST;

/// Steps grow at most, and shrink at least, by these factors.
const GROWTH: f64 = 2.0;
const SHRINK: f64 = 0.2;
/// Share of the step that the tolerance would allow.
const SAFETY: f64 = 0.9;
/// Each step may take this share: the errors of steps add up while the material remembers them, and those of single cells are larger than
/// that of the sum.
const SHARE: f64 = 0.08;

/// ln of the rate of a clock may change in a step by this times the root of the tolerance: the error of the step is about 0.15
/// times the square of the change.
const DRIFT: f64 = 2.0;

/// No step is shorter than this share of the time since the smooth piece began.
const FINEST: f64 = 1e-6;

/// Chooses the length of the next step by the error of the last.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StepSizeControl {
    /// The largest error that a step may have.
    allowed: f64,
    /// The first step of a smooth piece is no longer \[s\].
    first: f64,
    shortest: f64,
    /// No step is longer \[s\]: a share of the period of a cyclic course.
    longest: f64,
    /// Length of the next step \[s\].
    pub(super) dt: f64,
    /// Time since the smooth piece began \[s\].
    pub(super) elapsed: f64,
}

impl StepSizeControl {
    pub(super) fn new(tolerance: f64, first: f64, end: f64, longest: f64) -> Self {
        let first = first.min(longest);
        StepSizeControl {
            allowed: SHARE * tolerance,
            first,
            shortest: SHORTEST * end,
            longest,
            dt: first,
            elapsed: 0.0,
        }
    }

    /// How far ln of the rate of a clock may go in a step.
    pub(super) fn drift(&self) -> f64 {
        DRIFT * (self.allowed / SHARE).sqrt()
    }

    /// The shortest step that is tried now.
    fn shortest(&self) -> f64 {
        self.shortest.max(FINEST * self.elapsed)
    }

    /// A smooth piece begins whose first step may be `dt` long; it is solved at twice its length first.
    pub(super) fn restart(&mut self, dt: f64) {
        self.elapsed = 0.0;
        self.dt = 2.0 * dt.min(self.first).max(self.shortest);
    }

    /// The length to try instead of `dt`, where the error is too large.
    pub(super) fn rejects(&self, dt: f64, error: f64) -> Option<f64> {
        let excess = error / self.allowed;
        if excess <= 1.0 || dt <= self.shortest() {
            return None;
        }
        Some((dt * (SAFETY / excess.sqrt()).clamp(SHRINK, SAFETY)).max(self.shortest()))
    }

    /// Takes the step `dt`, which may have ended early at a stop, and plans the next.
    pub(super) fn accept(&mut self, dt: f64, error: f64) {
        self.elapsed += dt;
        let factor = (SAFETY / (error / self.allowed).sqrt()).clamp(SHRINK, GROWTH);
        // A step that a stop cut short says little of a longer one.
        let cut = dt < 0.999 * self.dt && factor >= 1.0;
        let next = if cut { self.dt.max(factor * dt) } else { factor * dt };
        self.dt = next.max(self.shortest()).min(self.longest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_grow_at_most_twofold_shrink_on_error_and_start_afresh() {
        let mut control = StepSizeControl::new(12.5e-3, 1e-3, 10.0, f64::INFINITY);
        control.accept(1e-3, 0.0);
        assert_eq!(control.dt, 2e-3);
        control.accept(2e-3, 1e-12);
        assert_eq!(control.dt, 4e-3);
        // An error 4 times too large: half the step and a margin.
        let shorter = control.rejects(4e-3, 4e-3).unwrap();
        assert!((shorter - 0.9 * 2e-3).abs() < 1e-12);
        assert_eq!(control.rejects(4e-3, 0.99e-3), None);
        // Cut short by a stop: the length before is kept.
        control.accept(1e-5, 1e-9);
        assert_eq!(control.dt, 4e-3);
        // After 4e-3 s no step is shorter than 4e-9 s.
        assert_eq!(control.rejects(3e-9, 1.0), None);
        control.restart(1.0);
        assert_eq!(control.dt, 2e-3);
        control.restart(1e-4);
        assert_eq!(control.dt, 2e-4);
    }
}
