//! Extrapolation of a fixed-point iteration b <- B(b) from its last passes (D. G. Anderson, J. ACM 12 (1965) 547).

use asperity_sweep::{dot, each, zeros};

/// Passes that are looked back to.
const DEPTH: usize = 2;

/// The last passes, latest last: b and f = B - b; and fields of passes that are forgotten.
#[derive(Default)]
pub(crate) struct Extrapolation {
    passes: Vec<[Vec<f64>; 2]>,
    free: Vec<[Vec<f64>; 2]>,
    /// The pass of the least residual, and the share of its f that is tried next where a pass fails.
    best: Option<[Vec<f64>; 2]>,
    share: f64,
}

impl Extrapolation {
    pub(crate) fn clear(&mut self) {
        self.free.append(&mut self.passes);
        self.free.extend(self.best.take());
    }

    /// Sets `bound` to B of the last pass, where `bound` was extrapolated beyond it, and forgets the others; `false` where it was not.
    pub(crate) fn take_back(&mut self, bound: &mut [f64]) -> bool {
        if self.passes.len() < 2 {
            return false;
        }
        let Some([b, f]) = self.passes.last() else { return false };
        each(bound, (&b[..], &f[..]), |to, (b, f)| *to = b + f);
        self.clear();
        true
    }

    /// Sets `bound` to the next b after a pass that gave `next` = B(b). Where the pass `failed`, half a plain step from the best pass so
    /// far, then a quarter, and so on.
    pub(crate) fn step(&mut self, bound: &mut [f64], next: &[f64], failed: bool, is_best: bool) {
        if failed && let Some([b, f]) = &self.best {
            self.share *= 0.5;
            let share = self.share;
            each(bound, (&b[..], &f[..]), |to, (b, f)| *to = b + share * f);
            self.free.append(&mut self.passes);
            return;
        }
        if is_best {
            let [mut b, mut f] = self.best.take().unwrap_or_else(|| self.spare(bound.len()));
            b.copy_from_slice(bound);
            each(&mut f, (next, &b[..]), |f, (next, b)| *f = next - b);
            (self.best, self.share) = (Some([b, f]), 1.0);
        }
        if self.passes.len() > DEPTH {
            self.free.push(self.passes.remove(0));
        }
        let [mut b, mut f] = self.spare(bound.len());
        b.copy_from_slice(bound);
        each(&mut f, (next, &b[..]), |f, (next, b)| *f = next - b);
        self.passes.push([b, f]);
        let weights = self.weights();
        bound.fill(0.0);
        for ([b, f], weight) in self.passes.iter().zip(&weights) {
            each(bound, (&b[..], &f[..]), |to, (b, f)| *to += weight * (b + f));
        }
    }

    fn spare(&mut self, cells: usize) -> [Vec<f64>; 2] {
        self.free.pop().unwrap_or_else(|| [zeros(cells), zeros(cells)])
    }

    /// Weights of sum 1 whose combination of the f is least: 1 for the latest, less what those of the passes before it take.
    fn weights(&self) -> Vec<f64> {
        let last = self.passes.len() - 1;
        let product = |i: usize, j: usize| dot(&self.passes[i][1], &self.passes[j][1]);
        // Differences from the latest f: at most two unknowns.
        let own = product(last, last);
        let matrix = |i: usize, j: usize| product(i, j) - product(i, last) - product(last, j) + own;
        let right = |i: usize| own - product(i, last);
        let mut weights = match last {
            0 => vec![],
            1 => vec![right(0) / matrix(0, 0)],
            _ => {
                let (a, b, d) = (matrix(0, 0), matrix(0, 1), matrix(1, 1));
                let (x, y) = (right(0), right(1));
                let determinant = a * d - b * b;
                match determinant > 1e-12 * a * d {
                    true => vec![(x * d - y * b) / determinant, (y * a - x * b) / determinant],
                    false => vec![0.0, y / d],
                }
            }
        };
        if weights.iter().any(|weight| !weight.is_finite()) {
            weights.fill(0.0);
        }
        weights.push(1.0 - weights.iter().sum::<f64>());
        weights
    }
}
