//! The linear system of a Newton step on a contact set D: A p = w - h there, the load kept, by right-preconditioned GMRES
//! (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856).
//!
//! The unknown is a change d of the pressure on D of zero sum. With P the projection that takes the mean over D away, the
//! equation is P A d = -P r, and P F⁻¹[1/A^] the preconditioner.

use asperity_sweep::{dot, each, sum, sweep};

use super::contact::{SteadyContact, Workspace};
use super::operators::Operators;
use crate::contact::stop_at;
use crate::error::Result;

/// The residual falls by this factor, in at most so many vectors.
const REDUCTION: f64 = 0.02;
const VECTORS: usize = 40;
/// Fields that a solve takes, were all cells in contact.
pub(super) const FIELDS: usize = 2 * VECTORS;

impl SteadyContact<'_> {
    /// P A x on the cells of D, or the approximate inverse of it.
    fn apply_on(
        &mut self,
        apply_into: fn(&mut Operators, &[f64], &mut [f64]),
        cells: &[usize],
        x: &[f64],
        on: &mut Workspace,
    ) -> Vec<f64> {
        let [input, output] = &mut on.work;
        input.fill(0.0);
        cells.iter().zip(x).for_each(|(cell, x)| input[*cell] = *x);
        apply_into(&mut on.operators, input, output);
        // The preconditioner costs as much as the operator on the torus.
        self.spent.convolutions += 1;
        let mut y: Vec<f64> = cells.iter().map(|cell| output[*cell]).collect();
        centre(&mut y);
        y
    }

    /// d of zero sum on the cells of D with P A d = -P `residual`, roughly.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::error::Error::Interrupted).
    pub(super) fn change_on(
        &mut self,
        cells: &[usize],
        residual: &[f64],
        on: &mut Workspace,
    ) -> Result<Vec<f64>> {
        self.spent.iterations += 1;
        let mut v: Vec<f64> = residual.iter().map(|r| -r).collect();
        centre(&mut v);
        let size = norm(&v);
        if size == 0.0 {
            return Ok(v);
        }
        scale(&mut v, 1.0 / size);
        let mut basis = vec![v];
        let mut preconditioned: Vec<Vec<f64>> = vec![];
        // Columns of the triangular factor, rotations, and the rotated right-hand side.
        let (mut triangle, mut rotations): (Vec<Vec<f64>>, Vec<[f64; 2]>) = (vec![], vec![]);
        let mut right = vec![size];
        for k in 0..VECTORS.min(residual.len()) {
            stop_at(self.interrupt)?;
            let z = self.apply_on(Operators::invert_into, cells, &basis[k], on);
            let mut y = self.apply_on(Operators::apply_into, cells, &z, on);
            preconditioned.push(z);
            let mut column = Vec::with_capacity(k + 2);
            for v in &basis {
                let product = dot(v, &y);
                add(-product, v, &mut y);
                column.push(product);
            }
            let length = norm(&y);
            column.push(length);
            for (i, [c, s]) in rotations.iter().enumerate() {
                let [a, b] = [column[i], column[i + 1]];
                (column[i], column[i + 1]) = (c * a + s * b, c * b - s * a);
            }
            let radius = libm::hypot(column[k], length);
            if !(radius > 0.0 && radius.is_finite()) {
                preconditioned.pop();
                break;
            }
            let [c, s] = [column[k] / radius, length / radius];
            column[k] = radius;
            column.truncate(k + 1);
            rotations.push([c, s]);
            triangle.push(column);
            let last = right[k];
            right[k] = c * last;
            right.push(-s * last);
            if right[k + 1].abs() <= REDUCTION * size || length <= f64::EPSILON * radius {
                break;
            }
            scale(&mut y, 1.0 / length);
            basis.push(y);
        }
        let mut weights = vec![0.0; triangle.len()];
        for i in (0..triangle.len()).rev() {
            let known: f64 = (i + 1..triangle.len()).map(|j| triangle[j][i] * weights[j]).sum();
            weights[i] = (right[i] - known) / triangle[i][i];
        }
        let mut d = vec![0.0; residual.len()];
        for (z, weight) in preconditioned.iter().zip(&weights) {
            add(*weight, z, &mut d);
        }
        Ok(d)
    }
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// y += factor x.
fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    each(y, x, |y, x| *y += factor * x);
}

fn scale(a: &mut [f64], factor: f64) {
    sweep(a, &|a: &mut [f64]| a.iter_mut().for_each(|a| *a *= factor));
}

/// Takes the mean away.
fn centre(a: &mut [f64]) {
    let mean = sum(a) / a.len().max(1) as f64;
    sweep(a, &|a: &mut [f64]| a.iter_mut().for_each(|a| *a -= mean));
}
