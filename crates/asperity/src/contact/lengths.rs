//! How far the conjugate steps of a solve go.
//!
//! A step is clipped before its image is known, at a length that must be guessed: too long, and cells are clipped that
//! should not be. From row to row of a march the lengths that turn out to be right hardly change, iteration by iteration
//! (0.52, 0.82, 0.63, .. in a creep run, while the preconditioner alone says 1): they are remembered.

/// The first length of a solve that nothing is known of.
const FIRST: f64 = 0.75;
/// Iterations that are remembered.
pub(crate) const REMEMBERED: usize = 16;

/// Step lengths in units of the preconditioned direction.
#[derive(Default)]
pub(super) struct Lengths {
    /// Of the last solves, by iteration; 0 where there was none.
    found: [f64; REMEMBERED],
    /// Conjugate steps taken in this solve.
    taken: usize,
    /// What the last step asks of the next one.
    last: Option<f64>,
}

impl Lengths {
    /// A solve begins.
    pub(super) fn begin(&mut self) {
        (self.taken, self.last) = (0, None);
    }

    /// For the next conjugate step.
    pub(super) fn next(&self) -> f64 {
        match self.found.get(self.taken) {
            Some(found) if *found > 0.0 => *found,
            _ => self.last.unwrap_or(FIRST),
        }
    }

    /// The step of length [`Self::next`], `straight` or clipped, has its minimum at so many times this length.
    pub(super) fn learn(&mut self, straight: bool, exact: f64) {
        let length = self.next();
        // Along a clipped step, half of what it asks for, in logarithms: the next one is another.
        let (factor, next) = if straight {
            (exact, (length * exact).clamp(0.05, 20.0))
        } else {
            let root = exact.max(0.0).sqrt();
            (root, length * root.clamp(0.3, 1.5))
        };
        self.last = Some(next);
        if let Some(found) = self.found.get_mut(self.taken) {
            let new = (length * factor).clamp(0.1, 3.0);
            *found = if *found > 0.0 { 0.5 * (*found + new) } else { new };
        }
        self.taken += 1;
    }

    /// What the next solve knows.
    pub(super) fn save(&self) -> [f64; REMEMBERED] {
        self.found
    }

    pub(super) fn load(&mut self, found: [f64; REMEMBERED]) {
        self.found = found;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_that_were_right_are_found_again() {
        let right = [0.52, 0.82, 0.63];
        let mut lengths = Lengths::default();
        // The worst guess of a solve in which every length is so much of `right`.
        let solve = |lengths: &mut Lengths, share: f64| {
            lengths.begin();
            let miss = |right: f64| {
                let exact = share * right / lengths.next();
                lengths.learn(true, exact);
                (exact - 1.0).abs()
            };
            right.map(miss).into_iter().fold(0.0, f64::max)
        };
        assert!(solve(&mut lengths, 1.0) > 0.3);
        assert!(solve(&mut lengths, 1.0) < 1e-12);
        // The mean of old and new: one solve that is unlike the others misleads the next by half, then by a quarter.
        assert!((solve(&mut lengths, 1.2) - 0.2).abs() < 1e-12);
        assert!((solve(&mut lengths, 1.0) - 0.1 / 1.1).abs() < 1e-12);
        assert!((solve(&mut lengths, 1.0) - 0.05 / 1.05).abs() < 1e-12);
        let mut resumed = Lengths::default();
        resumed.load(lengths.save());
        resumed.begin();
        lengths.begin();
        assert_eq!(resumed.next(), lengths.next());
        lengths.load([0.0; REMEMBERED]);
        assert_eq!(lengths.next(), FIRST);
    }

    #[test]
    fn the_last_step_tells_where_nothing_is_remembered() {
        let mut lengths = Lengths::default();
        lengths.begin();
        lengths.learn(true, 2.0);
        assert_eq!(lengths.next(), 2.0 * FIRST);
        lengths.learn(false, 0.25);
        assert_eq!(lengths.next(), FIRST);
        for _ in 0..2 * REMEMBERED {
            lengths.learn(false, 0.0);
        }
        assert!(lengths.next() > 0.0);
    }
}
