//! The stiffness of a contact: dW/dw with the contact set as it is.
//!
//! In cells whose pressure is between its bounds the gap stays closed, so a small change dw of the approach displaces all of them
//! equally, c K dp = dw, while the other cells keep their pressure. With the unit distribution
//!
//! ```text
//! K_SS q = 1 on the set S,     dW/dw = (dx dy / c) Σ q
//! ```
//!
//! (the set itself changes with dw, but at its border the pressure is 0: to first order that changes nothing).
//! Conjugate gradients from q = 0. The preconditioner z = M r is the approximate inverse of K on all cells, the symbol |q|/2
//! of single precision, restricted to S; unlike that of the contact solver it has no Schur complement. Each iteration adds
//! α <r, z> to Σ q, which rises to its limit as the square of the error in the energy norm.

use std::sync::atomic::AtomicBool;

use crate::contact::stop_at;
use crate::error::{NotConverged, Result};
use crate::grid::{Boundary, Grid};
use crate::operator::{ApproximateInverse, Operator};
use asperity_sweep::{dot, each, sums};

/// Iterations end where one adds less than this share of the sum: its relative error is then of that size.
const SMALLEST_SHARE: f64 = 1e-7;
/// More than any contact needs; some ten are usual.
const MOST_ITERATIONS: usize = 1000;

/// Solves for the stiffness of contacts on one grid, with its own working memory.
pub struct ContactStiffness {
    inverse: ApproximateInverse,
    set: Vec<bool>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    moved: Vec<f64>,
    single: Vec<f32>,
    image: Vec<f32>,
}

impl ContactStiffness {
    /// Plans the solve for an operator.
    pub fn new(operator: &dyn Operator) -> Self {
        let n = operator.grid().len();
        ContactStiffness {
            inverse: operator.approximate_inverse(),
            set: vec![false; n],
            residual: vec![0.0; n],
            direction: vec![0.0; n],
            moved: vec![0.0; n],
            single: vec![0.0; n],
            image: vec![0.0; n],
        }
    }

    /// Bytes that it takes on that grid, without the operator.
    pub(crate) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
        ApproximateInverse::bytes(grid, boundary) + 33 * grid.len()
    }

    /// dW/dw \[N/m\] of the cells for which `responds` is true, with a compliance \[1/Pa\], and the number of applications of K.
    ///
    /// 0 if no cell responds; infinite without compliance, and if every cell of a periodic domain responds.
    ///
    /// ```
    /// use asperity::{Boundary, Grid, operator::half_space, quantities::ContactStiffness};
    /// // A flat punch of radius a: dW/dw = 2 a E* (Sneddon 1965).
    /// let grid = Grid::new([64, 64], [2.0, 2.0])?;
    /// let mut operator = half_space(grid, Boundary::Free);
    /// let inside = |k: usize| f64::hypot(grid.x(k / 64) - 1.0, grid.y(k % 64) - 1.0) < 0.7;
    /// let (stiffness, _) = ContactStiffness::new(&*operator).of(&mut *operator, 1e-9, inside, None)?;
    /// assert!((stiffness / (2.0 * 0.7 * 1e9) - 1.0).abs() < 0.02);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted) where `interrupt` becomes true; [`Error::NotConverged`](crate::Error::NotConverged).
    pub fn of(
        &mut self,
        operator: &mut dyn Operator,
        compliance: f64,
        responds: impl Fn(usize) -> bool,
        interrupt: Option<&AtomicBool>,
    ) -> Result<(f64, usize)> {
        let mut cells = 0;
        for (k, (set, residual)) in self.set.iter_mut().zip(&mut self.residual).enumerate() {
            *set = responds(k);
            *residual = f64::from(u8::from(*set));
            cells += usize::from(*set);
        }
        if cells == 0 {
            return Ok((0.0, 0));
        }
        if compliance <= 0.0 || (!operator.determines_mean() && cells == self.set.len()) {
            return Ok((f64::INFINITY, 0));
        }
        self.direction.fill(0.0);
        let (mut sum, mut product) = (0.0, f64::INFINITY);
        for iteration in 1..=MOST_ITERATIONS {
            stop_at(interrupt)?;
            self.single.iter_mut().zip(&self.residual).for_each(|(single, r)| *single = *r as f32);
            self.inverse.apply_into(&self.single, &mut self.image);
            let last = std::mem::replace(
                &mut product,
                sums((&self.residual[..], &self.image[..]), |(r, z)| [r * f64::from(z)])[0],
            );
            self.turn(product / last);
            operator.apply_into(&self.direction, &mut self.moved);
            let curvature = dot(&self.direction, &self.moved);
            if !(product > 0.0 && curvature > 0.0) {
                // Nothing but rounding is left.
                return Ok((operator.grid().cell_area() * sum / compliance, iteration));
            }
            let length = product / curvature;
            sum += length * product;
            if length * product <= SMALLEST_SHARE * sum {
                return Ok((operator.grid().cell_area() * sum / compliance, iteration));
            }
            each(&mut self.residual, (&self.moved[..], &self.set[..]), |r, (moved, on)| {
                *r -= if on { length * moved } else { 0.0 };
            });
        }
        Err(NotConverged::of("contact stiffness", MOST_ITERATIONS, f64::NAN, SMALLEST_SHARE).into())
    }

    /// d = z + beta d on S.
    fn turn(&mut self, beta: f64) {
        each(&mut self.direction, (&self.image[..], &self.set[..]), |d, (z, on)| {
            *d = if on { f64::from(z) + beta * *d } else { 0.0 };
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::half_space;
    use crate::reference::Dense;

    #[test]
    fn the_sum_meets_the_direct_solution() {
        // A ragged set on a small grid of oblong cells, against Gaussian elimination of K_SS q = 1.
        let grid = Grid::new([9, 7], [9.0, 10.5]).unwrap();
        let on = |k: usize| !(k * k + k / 3).is_multiple_of(3);
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let mut operator = half_space(grid, boundary);
            let cells: Vec<usize> = (0..grid.len()).filter(|k| on(*k)).collect();
            let truth = Dense::new(grid, boundary);
            let mut matrix: Vec<Vec<f64>> = cells
                .iter()
                .map(|k| cells.iter().map(|l| truth.row(*k)[*l]).chain([1.0]).collect())
                .collect();
            let n = cells.len();
            for k in 0..n {
                // K_SS is positive definite: no pivoting.
                let pivot = matrix[k].clone();
                for (row, cells) in matrix.iter_mut().enumerate().filter(|(row, _)| *row != k) {
                    let factor = cells[k] / pivot[k];
                    assert!(factor.is_finite(), "{row}");
                    cells.iter_mut().zip(&pivot).for_each(|(c, p)| *c -= factor * p);
                }
            }
            let exact: f64 =
                (0..n).map(|k| matrix[k][n] / matrix[k][k]).sum::<f64>() * grid.cell_area() / 0.25;
            let (found, convolutions) =
                ContactStiffness::new(&*operator).of(&mut *operator, 0.25, on, None).unwrap();
            // The last iteration added less than 1e-7.
            assert!((found / exact - 1.0).abs() < 1e-6, "{boundary:?}: {found} {exact}");
            assert!(convolutions <= 25, "{convolutions}");
        }
    }

    #[test]
    fn limits_are_answered() {
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let mut periodic = half_space(grid, Boundary::Periodic);
        let mut stiffness = ContactStiffness::new(&*periodic);
        assert_eq!(stiffness.of(&mut *periodic, 1.0, |_| false, None).unwrap(), (0.0, 0));
        assert_eq!(stiffness.of(&mut *periodic, 1.0, |_| true, None).unwrap(), (f64::INFINITY, 0));
        assert_eq!(stiffness.of(&mut *periodic, 0.0, |k| k == 1, None).unwrap(), (f64::INFINITY, 0));
        let flag = AtomicBool::new(true);
        let stopped = stiffness.of(&mut *periodic, 1.0, |k| k == 1, Some(&flag));
        assert!(matches!(stopped, Err(crate::Error::Interrupted)));
    }
}
