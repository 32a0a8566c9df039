//! What the solve of a row starts from: the last two rows, prolonged linearly in time.
//!
//! U = K p is linear, so that U of the guess is known without a convolution. Its roundings grow with every row that takes its U
//! this way; before they are seen, two rows find it afresh.

use asperity_convolution::eights::{Eight, Work, vectorize};

use super::{March, cap};
use crate::contact::{Hardness, Start};
use crate::field::sweep;

/// Largest multiple of the last step that is prolonged.
const FARTHEST: f64 = 4.0;
/// The share of the solver's tolerance that roundings may take.
const SPARE: f64 = 1e-2;
/// Rows that a change from row to row is to be small for.
const AHEAD: f64 = 100.0;
/// The share of the pressure that may lie beyond its bounds: the first iteration does not see what comes of leading it back.
const BEYOND: f64 = 1e-4;

/// What U of a row may be off by, and what that has changed by since the row before: in roundings of a convolution.
#[derive(Clone, Copy)]
pub(super) struct Roundings {
    pub of_row: f64,
    pub change: f64,
}

impl Roundings {
    /// Nothing is known.
    pub(super) const UNKNOWN: Self = Roundings { of_row: f64::INFINITY, change: f64::INFINITY };

    /// Of U prolonged by `factor` times the last step.
    fn prolonged(self, factor: f64) -> Self {
        // A factor of zero leaves nothing of the row before, whatever its roundings.
        let change = 1.0 + if factor > 0.0 { factor * self.change } else { 0.0 };
        Roundings { of_row: self.of_row + change, change }
    }

    /// Of the row that was solved from a guess with these; of U the solver says `found`.
    pub(super) fn solved(self, found: f64) -> Self {
        let change = if found >= self.of_row {
            self.change + (found - self.of_row)
        } else if self.of_row < f64::INFINITY {
            // U was found afresh, beside that of the row before.
            found + (self.of_row - self.change)
        } else {
            f64::INFINITY
        };
        Roundings { of_row: found, change }
    }

    /// Whether nobody will see them.
    fn are_small(self, tolerance: f64) -> bool {
        f64::EPSILON * self.of_row.max(AHEAD * self.change) <= SPARE * tolerance
    }
}

impl March {
    /// Makes the guess of a step of length `now` in `self.state`, which holds the row before the last one; after a jump it is the
    /// last row.
    pub(super) fn guess(&mut self, now: f64) -> Start {
        let before = self.timeline.last().map_or(0.0, |last| last.dt);
        let factor = if before > 0.0 { (now / before).min(FARTHEST) } else { 0.0 };
        let hardness = cap(&self.simulation, &self.hardness);
        let (state, last) = (&mut self.state, &self.previous);
        let [allowed, beyond] = sweep(
            (
                (&mut state.pressure[..], &mut state.unit_displacement[..]),
                &last.pressure[..],
                &last.unit_displacement[..],
                hardness,
            ),
            &|((p, u), p_last, u_last, hardness): ((&mut [f64], &mut [f64]), &[f64], &[f64], Hardness)| {
                vectorize(Prolong { factor, p, u, p_last, u_last, hardness })
            },
        );
        self.roundings = self.roundings.prolonged(factor);
        let small = self.roundings.are_small(self.simulation.solver.tolerance);
        if small && beyond <= BEYOND * allowed {
            Start::Known { roundings: self.roundings.of_row, beyond: beyond > 0.0 }
        } else {
            Start::Guess
        }
    }
}

/// p and U prolonged by `factor` times the last step; yields the sums of what lies within the bounds and beyond.
struct Prolong<'a> {
    factor: f64,
    p: &'a mut [f64],
    u: &'a mut [f64],
    p_last: &'a [f64],
    u_last: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for Prolong<'_> {
    type Yield = [f64; 2];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 2] {
        let (zero, factor) = (V::splat(0.0), V::splat(self.factor));
        let mut sums = [zero; 2];
        for n in (0..self.p.len()).step_by(8) {
            let [p, p_last] = [&*self.p, self.p_last].map(|f| V::load(f, n, 0.0));
            let [u, u_last] = [&*self.u, self.u_last].map(|f| V::load(f, n, 0.0));
            let p = p_last + factor * (p_last - p);
            p.store(self.p, n);
            (u_last + factor * (u_last - u)).store(self.u, n);
            let allowed = p.clip(self.hardness.eight::<V>(n));
            sums = [sums[0] + allowed, sums[1] + (p - allowed).abs()];
        }
        sums.map(V::sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Boundary, Grid};
    use crate::load::{Control, History};
    use crate::march::Simulation;
    use crate::material::{Creep, CreepTerm};
    use crate::time::TimeGrid;

    /// A rough gap that creeps under a load, 120 rows of it.
    fn creep(boundary: Boundary, hardness: f64) -> March {
        let grid = Grid::new([48, 40], [1.0, 1.0]).unwrap();
        let gap = ndarray::Array2::from_shape_fn(grid.shape(), |(i, j)| {
            let (x, y) = (grid.x(i) - 0.5, grid.y(j) - 0.5);
            0.5 * (x * x + y * y) + 4e-3 * (1.0 - (41.0 * x + 0.3).cos() * (37.0 * y + 0.7).cos())
        });
        let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 2.0 }];
        March::new(Simulation {
            boundary,
            hardness,
            creep: Creep { instantaneous: 1.0, terms, fluidity: 0.0 },
            loading: crate::Loading { control: Control::Load, history: History::Step { value: 0.02 } }.into(),
            times: TimeGrid::Uniform { end: 4.0, steps: 120 },
            ..Simulation::new(grid, gap)
        })
        .unwrap()
    }

    #[test]
    fn a_row_takes_no_convolution_but_those_of_its_steps_and_its_displacement_is_that_of_its_pressure() {
        for (boundary, hardness) in [(Boundary::Free, 0.25), (Boundary::Periodic, f64::INFINITY)] {
            let mut march = creep(boundary, hardness);
            let mut fresh = vec![0.0; march.simulation.grid.len()];
            let mut rows = 0;
            while let Some(step) = march.advance().unwrap() {
                let row = step.row();
                rows += usize::from(row.convolutions == row.iterations);
                march.operator.apply_into(&march.state.pressure, &mut fresh);
                let largest = fresh.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
                let off = fresh.iter().zip(&march.state.unit_displacement).map(|(a, b)| (a - b).abs());
                let off = off.fold(0.0, f64::max);
                // A convolution is off by some roundings itself.
                let bound = 4.0 * f64::EPSILON * march.roundings.of_row;
                assert!(off <= bound * largest, "{} s: {off} {bound}", row.time);
            }
            assert!(rows > 110, "{boundary:?}: {rows}");
            assert!(march.roundings.of_row > 100.0);
        }
    }

    #[test]
    fn roundings_are_no_larger_than_they_are_said_to_be() {
        for factor in [0.5, 1.0, 1.1] {
            let mut said = Roundings::UNKNOWN.prolonged(0.0).solved(1.0).prolonged(0.0).solved(3.0);
            let mut errors = [1.0, 3.0];
            for row in 0..40 {
                said = said.prolonged(factor);
                let sign = if row % 7 < 4 { 1.0 } else { -1.0 };
                errors = [errors[1], errors[1] + factor * (errors[1] - errors[0]) + sign * 3.0];
                said = said.solved(said.of_row + 2.0);
                assert!(errors[1].abs() <= said.of_row, "{factor} {row}: {errors:?} {}", said.of_row);
            }
        }
    }

    #[test]
    fn two_rows_found_afresh_leave_none_of_the_roundings() {
        let mut said = Roundings { of_row: 5.0, change: 1.0 };
        let mut rows = 0;
        while said.prolonged(1.0).are_small(1e-9) {
            said = said.prolonged(1.0);
            said = said.solved(said.of_row + 5.0);
            rows += 1;
        }
        assert!(rows > 20, "{rows}");
        said = said.prolonged(1.0).solved(6.0);
        assert!(!said.prolonged(1.0).are_small(1e-9));
        said = said.prolonged(1.0).solved(6.0);
        assert!(said.prolonged(1.0).are_small(1e-9));
        // A tolerance near rounding leaves nothing to spare.
        assert!(!said.prolonged(1.0).are_small(1e-13));
    }
}
