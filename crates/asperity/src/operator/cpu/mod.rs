//! The back end of this machine's processor: batched transforms on all threads.

mod inverse;
mod kernels;

use ndarray::{Array2, ArrayView2};

use super::backend::{Backend, ConvolutionPlan, InversePlan};
use crate::convolution::Convolution;
use crate::convolution::batched::BatchedFft;
use inverse::CpuInverse;

/// The processor, in the widest vectors that it has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cpu;

impl Backend for Cpu {
    fn plan(
        &self,
        cells: [usize; 2],
        lengths: [usize; 2],
        spectrum: ArrayView2<f64>,
    ) -> Box<dyn ConvolutionPlan> {
        Box::new(Convolution::new(cells, lengths, spectrum))
    }

    fn bytes(&self, cells: [usize; 2], lengths: [usize; 2]) -> usize {
        Convolution::bytes(cells, lengths, 1)
    }

    fn plan_inverse(
        &self,
        cells: [usize; 2],
        lengths: [usize; 2],
        inverse: Array2<f64>,
        screened: Array2<f64>,
    ) -> Box<dyn InversePlan> {
        Box::new(CpuInverse::new(cells, lengths, inverse, screened))
    }

    fn inverse_bytes(&self, cells: [usize; 2], lengths: [usize; 2]) -> usize {
        // It is planned when all else is, and the operator before anything else.
        let planning = BatchedFft::<f32>::converting_bytes(cells, lengths);
        BatchedFft::<f32>::bytes(cells, lengths, 2) + planning + (cells[0] * cells[1]).div_ceil(8)
    }
}

impl ConvolutionPlan for Convolution {
    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        Convolution::apply_into(self, p, u);
    }

    fn apply_in_place(&mut self, x: &mut [f64]) {
        Convolution::apply_in_place(self, x);
    }
}
