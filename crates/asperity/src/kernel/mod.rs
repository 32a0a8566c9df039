//! Influence functions for unit contact modulus E* = 1: the displacement due to a pressure on the surface.
//!
//! They are pure functions of the geometry, without grid, material or time.

mod boussinesq;
mod cerruti;
pub(crate) mod gauss;
mod lateral;
mod line;
mod periodic;

pub use boussinesq::love;
pub(crate) use cerruti::{Cerruti, Tangential};
pub(crate) use lateral::{lateral, lateral_symbol};
pub use line::strip;
pub(crate) use line::strip_at;
pub use periodic::wave_kernel;

use ndarray::Array2;
use ndarray::parallel::prelude::*;

use crate::error::{Error, Result};

/// The elastic response of the surface of a body, from which an [`Operator`](crate::operator::Operator) is planned.
///
/// A free domain uses its influence coefficients, a periodic one its symbol. Both describe the same body: the symbol is the
/// Fourier transform of the response to a point load.
pub trait Kernel: std::fmt::Debug + Send + Sync {
    /// Displacements K(i dx, j dy) \[m\] at distances of i < `count[0]` and j < `count[1]` cells from the centre of a
    /// cell of sides `cell` = \[dx, dy\] \[m\] under unit pressure.
    ///
    /// # Errors
    /// [`Error::Invalid`] if they cannot be computed.
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>>;

    /// Displacements \[m\] at the centres of the cells 0, 1, ... `count` - 1 away from a strip of width `dx` \[m\] under unit
    /// pressure, in plane strain. Without [`depth`](Self::depth) a constant is undetermined: it is chosen such that the smallest
    /// displacement is 0.
    ///
    /// # Errors
    /// [`Error::Invalid`] if they cannot be computed.
    fn strip(&self, _dx: f64, _count: usize) -> Result<Vec<f64>> {
        Err(Error::invalid(
            "kernel of a line contact on a free domain",
            "without influence coefficients of a strip",
            "one that has them, or boundary = \"periodic\"",
        ))
    }

    /// Amplitude of the displacement \[m\] under a pressure wave cos(q.x) of unit amplitude; `q` = (qx, qy) \[rad/m\] is not
    /// zero. Positive.
    fn symbol(&self, qx: f64, qy: f64) -> f64;

    /// Displacement \[m\] under a uniform unit pressure on a periodic domain, not negative; `None` if it is not determined, as on
    /// a half-space. Displacements are then measured from their mean.
    fn uniform(&self) -> Option<f64> {
        None
    }

    /// Total thickness \[m\] of the layers of both bodies on rigid bases; `None` if a body has no rigid base.
    fn depth(&self) -> Option<f64> {
        None
    }

    /// Thickness \[m\] of the thinnest layer at a surface; `None` without layers.
    fn top_layer(&self) -> Option<f64> {
        None
    }

    /// Whether this is the elastic half-space, for estimates that only hold for it.
    fn is_half_space(&self) -> bool {
        false
    }

    /// Whether cells of a free domain whose longest side is `longest` \[m\] resolve the body.
    ///
    /// # Errors
    /// [`Error::Invalid`] if they do not.
    fn check(&self, _longest: f64) -> Result<()> {
        Ok(())
    }
}

/// The elastic half-space: [`love`] and [`wave_kernel`].
#[derive(Clone, Copy, Debug, Default)]
pub struct HalfSpace;

impl Kernel for HalfSpace {
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>> {
        Ok(self.coefficients(cell, count))
    }

    fn strip(&self, dx: f64, count: usize) -> Result<Vec<f64>> {
        Ok(line::strip(dx, count))
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        wave_kernel(qx, qy)
    }

    fn is_half_space(&self) -> bool {
        true
    }
}

impl HalfSpace {
    /// Its influence coefficients.
    pub(crate) fn coefficients(self, [dx, dy]: [f64; 2], count: [usize; 2]) -> Array2<f64> {
        let mut kernel = Array2::zeros((count[0], count[1]));
        kernel.outer_iter_mut().into_par_iter().enumerate().for_each(|(i, mut row)| {
            for (j, k) in row.iter_mut().enumerate() {
                *k = love(i as f64 * dx, j as f64 * dy, [dx, dy]);
            }
        });
        kernel
    }
}
