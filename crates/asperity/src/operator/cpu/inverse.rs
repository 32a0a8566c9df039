//! The approximate inverse on the processor: three convolutions in f32 that are one chain. Of what lies between them only z is
//! written to memory, and both products of a come from the spectra (Parseval).

use std::ops::Range;

use asperity_sweep::simd::vectorize;
use asperity_sweep::{Set, zeros};
use ndarray::Array2;

use super::super::backend::InversePlan;
use super::kernels::{Add, Keep, Weigh};
use crate::convolution::batched::BatchedFft;
use crate::set::find_adjacent;

/// Numbers of the two spectra in the plan.
const INVERSE: usize = 0;
const SCREENED: usize = 1;

pub(super) struct CpuInverse {
    fft: BatchedFft<f32>,
    /// Cells of a row.
    row: usize,
    /// The open cells adjacent to the set.
    adjacent: Vec<u8>,
}

impl CpuInverse {
    pub(super) fn new(
        cells: [usize; 2],
        lengths: [usize; 2],
        inverse: Array2<f64>,
        screened: Array2<f64>,
    ) -> Self {
        CpuInverse {
            fft: BatchedFft::with_spectra(cells, lengths, vec![inverse.into(), screened.into()]),
            row: cells[1],
            adjacent: zeros((cells[0] * cells[1]).div_ceil(8)),
        }
    }
}

impl InversePlan for CpuInverse {
    fn apply_into(&mut self, r: &[f32], z: &mut [f32]) {
        self.fft.apply_into(r, z);
    }

    fn apply_on_set_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32]) {
        find_adjacent(set, self.row, &mut self.adjacent);
        let adjacent = &self.adjacent[..];
        let part = |bits: &'_ [u8], first: usize, cells: usize| -> Range<usize> {
            first / 8..(first + cells).div_ceil(8).min(bits.len())
        };
        let set = |first: usize, x: &[f32]| Set(&set[part(set, first, x.len())]);
        let weigh = |first: usize, x: &mut [f32]| {
            let adjacent = Set(&adjacent[part(adjacent, first, x.len())]);
            vectorize(Weigh { set: set(first, x), adjacent, x });
        };
        let mut chain = self.fft.chain(r);
        chain.multiply(INVERSE);
        chain.modify(z, &|first, x, z| {
            vectorize(Keep { z, set: set(first, x), x });
            weigh(first, x);
        });
        let by = chain.multiply(SCREENED);
        chain.modify(&mut [], &|first, x, _| weigh(first, x));
        let ymy = chain.multiply(INVERSE);
        // Where nothing is open, b is zero.
        let a = if by > 0.0 && ymy > 0.0 { by / ymy } else { 0.0 };
        chain.finish(z, &|first, x, z| {
            vectorize(Add { z, set: set(first, x), x, t: -a });
        });
    }
}
