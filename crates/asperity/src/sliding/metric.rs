//! The symmetric operator M = |A|²/Re A of the metric iteration, as the contact solver takes it.

use std::sync::Arc;

use ndarray::Array2;

use super::streaming::Streaming;
use crate::convolution::torus::Spectrum;
use crate::error::{Error, Result};
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;
use crate::operator::{Body, Convolved, default_backend};

/// M from the spectrum of A on a torus of these lengths; `kernel` is near M on an endless plane.
pub(super) fn metric(
    grid: Grid,
    boundary: Boundary,
    spectrum: &Spectrum,
    [mx, my]: [usize; 2],
    kernel: Arc<dyn Kernel>,
) -> Box<Convolved> {
    let of = |(kx, ky): (usize, usize)| {
        let a = spectrum.0[ky * mx + kx];
        if a.re > 0.0 { a.norm_sqr() / a.re } else { 0.0 }
    };
    let quarter = Array2::from_shape_fn((mx / 2 + 1, my / 2 + 1), of);
    let body = Body { grid, boundary, backend: default_backend(), kernel, has_coarser: false };
    Convolved::new(body, [mx, my], &quarter)
}

/// The symbol of M on an endless plane, for the preconditioner.
#[derive(Debug)]
pub(super) struct MetricKernel {
    /// That of the elastic bodies.
    pub(super) elastic: Arc<dyn Kernel>,
    pub(super) streaming: Streaming,
    /// Velocity of the material along x and y \[m/s\].
    pub(super) velocity: [f64; 2],
    /// The compliance that counts as 1 \[1/Pa\].
    pub(super) unit: f64,
}

impl MetricKernel {
    fn over(&self, omega: f64) -> f64 {
        let c = self.streaming.at(omega);
        c.norm_sqr() / (c.re * self.unit)
    }
}

impl Kernel for MetricKernel {
    fn influence(&self, _cell: [f64; 2], _count: [usize; 2]) -> Result<Array2<f64>> {
        Err(Error::invalid("kernel of the metric", "influence coefficients", "its symbol"))
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        self.elastic.symbol(qx, qy) * self.over(qx * self.velocity[0] + qy * self.velocity[1])
    }

    fn uniform(&self) -> Option<f64> {
        self.elastic.uniform().map(|uniform| uniform * self.over(0.0))
    }
}
