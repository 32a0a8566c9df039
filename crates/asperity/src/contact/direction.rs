//! The conjugate direction on the working set, after Polak and Ribiere, from the preconditioned residual.

use super::ProjectedCg;
use super::search::Search;
use super::sweeps::direction::{Conjugate, Products};
use super::workspace::preconditioned;
use asperity_sweep::{Set, run};

impl ProjectedCg {
    /// d <- z + beta d on S, a set of so many `cells`; beta = max(0, <z, r - r_old> / <z_old, r_old>), 0 where `search.product` =
    /// <z_old, r_old> is not known, which becomes <z, r>. `None`, with d as it was, where z is no descent direction.
    ///
    /// Where the load is given, z and d have their means over S removed; r comes without.
    pub(super) fn make_conjugate(&mut self, search: &mut Search, cells: f64) -> Option<()> {
        let mean_free = search.sum.is_some();
        let ProjectedCg { residual: r, residual_old: r_old, direction: d, image, .. } = self;
        let z = &*preconditioned(image);
        let (set, set_old) = (&self.working, &self.working_old);
        let [sum_z, zr, zr_old, sum_r_old, sum_d_old] =
            run(Products { z, r, r_old, d_old: d, set: Set(set) });
        let mean_z = if mean_free { sum_z / cells } else { 0.0 };
        if zr <= 0.0 || zr.is_nan() {
            return None;
        }
        let beta = match search.product {
            Some(old) => ((zr - (zr_old - mean_z * sum_r_old)) / old).max(0.0),
            None => 0.0,
        };
        let mean = if mean_free { mean_z + beta * sum_d_old / cells } else { 0.0 };
        run(Conjugate { d, z, set: Set(set), set_old: Set(set_old), beta, mean });
        search.product = Some(zr);
        Some(())
    }
}
