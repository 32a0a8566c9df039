//! Extrapolation of a fixed-point iteration b <- B(b) from its last passes (D. G. Anderson, J. ACM 12 (1965) 547).

use asperity_sweep::{dot, each};

/// Passes that are looked back to.
const DEPTH: usize = 2;

/// The last passes, latest last: b and f = B - b.
#[derive(Default)]
pub(super) struct Extrapolation {
    passes: Vec<[Vec<f64>; 2]>,
}

impl Extrapolation {
    pub(super) fn clear(&mut self) {
        self.passes.clear();
    }

    /// Sets `bound` to the next b after a pass that gave `next` = B(b). Where the pass `failed`, half a plain step from the pass
    /// before it.
    pub(super) fn step(&mut self, bound: &mut [f64], next: &[f64], failed: bool) {
        if failed && let Some([b, f]) = self.passes.pop() {
            bound.iter_mut().zip(b.iter().zip(&f)).for_each(|(to, (b, f))| *to = b + 0.5 * f);
            self.passes.clear();
            return;
        }
        let f: Vec<f64> = next.iter().zip(&*bound).map(|(next, b)| next - b).collect();
        if self.passes.len() > DEPTH {
            self.passes.remove(0);
        }
        self.passes.push([bound.to_vec(), f]);
        let weights = self.weights();
        bound.fill(0.0);
        for ([b, f], weight) in self.passes.iter().zip(&weights) {
            each(bound, (&b[..], &f[..]), |to, (b, f)| *to += weight * (b + f));
        }
    }

    /// Weights of sum 1 whose combination of the f is least.
    fn weights(&self) -> Vec<f64> {
        let count = self.passes.len();
        let product = |i: usize, j: usize| dot(&self.passes[i][1], &self.passes[j][1]);
        let mut plain = vec![0.0; count];
        if let Some(last) = plain.last_mut() {
            *last = 1.0;
        }
        // Differences from the latest f: at most two unknowns.
        let last = count - 1;
        let own = product(last, last);
        let columns: Vec<usize> = (0..last).collect();
        let matrix = |i: usize, j: usize| product(i, j) - product(i, last) - product(last, j) + own;
        let right = |i: usize| own - product(i, last);
        let found = match columns[..] {
            [] => vec![],
            [i] => vec![right(i) / matrix(i, i)],
            _ => {
                let [i, j] = [last - 2, last - 1];
                let (a, b, d) = (matrix(i, i), matrix(i, j), matrix(j, j));
                let determinant = a * d - b * b;
                match determinant > 1e-12 * a * d {
                    true => vec![
                        (right(i) * d - right(j) * b) / determinant,
                        (right(j) * a - right(i) * b) / determinant,
                    ],
                    false => vec![0.0, right(j) / d],
                }
            }
        };
        if found.iter().any(|weight| !weight.is_finite()) {
            return plain;
        }
        let rest: f64 = 1.0 - found.iter().sum::<f64>();
        let offset = last - found.len();
        let mut weights = vec![0.0; count];
        found.iter().enumerate().for_each(|(n, weight)| weights[offset + n] = *weight);
        weights[last] = rest;
        weights
    }
}
