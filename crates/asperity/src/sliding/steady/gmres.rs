//! The linear system of a Newton step on a contact set D: A p = w - h there, the load kept, by right-preconditioned GMRES.
//!
//! The unknown is a change d of the pressure on D of zero sum. With P the projection that takes the mean over D away, the
//! equation is P A d = -P r, and P F⁻¹[1/A^] the preconditioner.

use asperity_sweep::{sum, sweep};

use super::contact::{SteadyContact, Workspace};
use super::operators::Operators;
use crate::contact::stop_at;
use crate::error::Result;
use crate::linear::{Limits, gmres};

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
        let mut right: Vec<f64> = residual.iter().map(|r| -r).collect();
        centre(&mut right);
        let limits = Limits { reduction: REDUCTION, vectors: VECTORS };
        let (d, _) = gmres(&right, limits, |v| {
            stop_at(self.interrupt)?;
            let z = self.apply_on(Operators::invert_into, cells, v, on);
            let y = self.apply_on(Operators::apply_into, cells, &z, on);
            Ok([z, y])
        })?;
        Ok(d)
    }
}

/// Takes the mean away.
fn centre(a: &mut [f64]) {
    let mean = sum(a) / a.len().max(1) as f64;
    sweep(a, &|a: &mut [f64]| a.iter_mut().for_each(|a| *a -= mean));
}
