//! What U may be off by where it is not that of one convolution: a guess combines those of solutions, and every step adds
//! its image.
//!
//! Counted in roundings of a convolution in f64: the share eps of the largest U. The image of a step in f32 is off by some
//! roundings of f32, of a U that is as much smaller as the step is.

/// The share of the solver's tolerance that roundings may take.
const SPARE: f64 = 1e-2;
/// Rows that what a row changes is to be small for. Where the rows go on as they did, guesses add it up: it is better known
/// before U itself is off, and after U was found afresh it still holds what the row before was off by.
const AHEAD: f64 = 4.0;

/// Of a state, of the one before, and of their difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Roundings {
    /// Of the state.
    pub here: f64,
    /// Of the row before the one under way.
    last: f64,
    /// Of the difference of the two.
    pub change: f64,
}

/// f x, also where x is infinite.
fn times(f: f64, x: f64) -> f64 {
    if f == 0.0 { 0.0 } else { f.abs() * x }
}

impl Roundings {
    /// Of a row.
    pub(crate) fn new(here: f64, change: f64) -> Self {
        Roundings { here, last: f64::INFINITY, change }
    }

    /// Of a U that one convolution found, with nothing before.
    pub(super) fn of_convolution() -> Self {
        Roundings { here: 1.0, last: 0.0, change: 1.0 }
    }

    /// A row begins.
    pub(crate) fn begin(self) -> Self {
        Roundings { last: self.here, ..self }
    }

    /// Of the guess a x + f (x - x') for x this row and x' the one before.
    pub(crate) fn combined(self, [a, f]: [f64; 2]) -> Self {
        let along = times(f, self.change) + 1.0;
        Roundings {
            here: times(a, self.last) + along,
            last: self.last,
            change: times(a - 1.0, self.last) + along,
        }
    }

    /// With a step of which U grows by that `share` of itself, whose numbers have that `epsilon`.
    pub(super) fn with_step(self, share: f64, epsilon: f64) -> Self {
        let more = 1.0 + epsilon / f64::EPSILON * share;
        Roundings { here: self.here + more, change: self.change + more, ..self }
    }

    /// With U found afresh.
    pub(super) fn afresh(self) -> Self {
        Roundings { here: 1.0, change: 1.0 + self.last, ..self }
    }

    /// Of the row that was solved from a guess with these; of its U the solver says `found`.
    pub(crate) fn solved(self, found: f64) -> Self {
        let change = if found >= self.here { self.change + (found - self.here) } else { found + self.last };
        Roundings { here: found, change, ..self }
    }

    /// Whether U shows where to go, though it may be found afresh.
    pub(crate) fn are_moderate(self, tolerance: f64) -> bool {
        f64::EPSILON * self.here <= tolerance
    }

    /// Whether nobody will see them, here and in the rows to come.
    pub(super) fn are_small(self, tolerance: f64) -> bool {
        f64::EPSILON * (self.here + AHEAD * self.change) <= SPARE * tolerance
    }

    /// Whether U is as good as it can be.
    pub(super) fn are_least(self) -> bool {
        self.here <= 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roundings_are_no_larger_than_they_are_said_to_be() {
        for factor in [0.5, 1.0, 1.1] {
            let mut said = Roundings::new(3.0, 2.0);
            let mut errors = [1.0, 3.0];
            for row in 0..40 {
                said = said.begin().combined([1.0, factor]);
                let sign = if row % 7 < 4 { 1.0 } else { -1.0 };
                errors = [errors[1], errors[1] + factor * (errors[1] - errors[0]) + sign * 3.0];
                said = said.solved(said.here + 2.0);
                assert!(errors[1].abs() <= said.here, "{factor} {row}: {errors:?} {}", said.here);
            }
        }
    }

    /// Rows that each end as the solver ends them; how often U is found afresh, and the most that is left.
    fn rows(count: usize, share: f64, epsilon: f64, tolerance: f64) -> (usize, f64) {
        let mut said = Roundings::new(1.0, 2.0);
        let (mut found, mut most) = (0, 0.0_f64);
        for _ in 0..count {
            let mut row = said.begin().combined([1.0, 1.0]);
            let guess = row;
            row = row.with_step(share, epsilon);
            if !row.are_small(tolerance) {
                row = row.afresh();
                found += 1;
            }
            said = guess.solved(row.here);
            assert!((said.change / row.change - 1.0).abs() < 1e-12);
            most = most.max(f64::EPSILON * said.here / tolerance);
        }
        (found, most)
    }

    #[test]
    fn u_is_found_afresh_in_pairs_of_rows_before_roundings_are_seen() {
        // 2.2e-14 of a U that f64 holds to 2.2e-16, by rows that each add two: a hundred rows and more without.
        assert!(rows(100, 1e-2, f64::EPSILON, 1e-9).0 == 0);
        // In f32 a step of 1e-4 costs 1.2e-11; of tolerance 1e-6 one row in five has a convolution more.
        let (found, most) = rows(200, 1e-4, f32::EPSILON.into(), 1e-6);
        assert!((4..40).contains(&found), "{found}");
        assert!(most <= SPARE, "{most}");
        // Of a tolerance near rounding every row has one.
        assert_eq!(rows(20, 1e-4, f64::EPSILON, 1e-13).0, 20);
    }
}
