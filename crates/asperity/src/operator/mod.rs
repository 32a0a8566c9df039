//! The operator K of the half-space: u = K p for unit contact modulus.
//!
//! Everything elastic and geometric is in K; the material enters as the scalar compliance that
//! multiplies it (theory: space and time separate).

mod dense;
mod free;
mod periodic;

pub use dense::Dense;
pub use free::Free;
pub use periodic::Periodic;

use ndarray::Array2;
use ndarray::parallel::prelude::*;

use crate::convolution::lanes::{Journey, Lanes, Sums};
use crate::grid::{Boundary, Grid};
use crate::kernel::inverse_kernel;

/// u = K p: symmetric, positive (semi)definite, in metres times the pressure's unit.
pub trait Operator: Send {
    /// The grid that the operator works on.
    fn grid(&self) -> &Grid;

    /// Free or periodic.
    fn boundary(&self) -> Boundary;

    /// u = K p; both C-order of nx ny cells.
    fn apply_into(&mut self, p: &[f64], u: &mut [f64]);

    /// The same in f32, to about 1e-7 of the largest u.
    fn apply_single_into(&mut self, p: &[f32], u: &mut [f32]);

    /// A pressure x and its displacement K x on the way, as [`Journey`] says; where rows are not taken on the way, in fields of
    /// its own.
    fn carry(&mut self, journey: Journey<f64>) -> Option<Sums> {
        journey.at_once(|x, u| self.apply_into(x, u))
    }

    /// The same in f32.
    fn carry_single(&mut self, journey: Journey<f32>) -> Option<Sums> {
        journey.at_once(|x, u| self.apply_single_into(x, u))
    }

    /// Displacement of a cell under its own unit pressure \[m\].
    fn self_influence(&self) -> f64;
}

/// The operator of a grid and its boundary.
pub fn half_space(grid: Grid, boundary: Boundary) -> Box<dyn Operator> {
    match boundary {
        Boundary::Free => Box::new(Free::new(grid)),
        Boundary::Periodic => Box::new(Periodic::new(grid)),
    }
}

/// The same, with its form in f32 planned at once, from the same kernel.
pub fn half_space_with_single(grid: Grid, boundary: Boundary) -> Box<dyn Operator> {
    match boundary {
        Boundary::Free => Box::new(Free::with_single(grid)),
        Boundary::Periodic => Box::new(Periodic::with_single(grid)),
    }
}

/// A convolution in f32 beside the one in f64, planned with it or when it is first wanted.
struct Single(Option<Lanes<f32>>);

impl Single {
    fn planned(&mut self, plan: impl FnOnce() -> Lanes<f32>) -> &mut Lanes<f32> {
        self.0.get_or_insert_with(plan)
    }
}

/// S(kx, ky) = `symbol`(qx, qy) on the wave vectors of a torus of `cells` and `size`.
pub(crate) fn wave_spectrum(
    [nx, ny]: [usize; 2],
    [lx, ly]: [f64; 2],
    symbol: impl Fn(f64, f64) -> f64 + Sync,
) -> Array2<f64> {
    let tau = std::f64::consts::TAU;
    let mut spectrum = Array2::zeros((nx / 2 + 1, ny / 2 + 1));
    spectrum.outer_iter_mut().into_par_iter().enumerate().for_each(|(kx, mut row)| {
        let qx = tau * kx as f64 / lx;
        row.iter_mut().enumerate().for_each(|(ky, s)| *s = symbol(qx, tau * ky as f64 / ly));
    });
    spectrum
}

/// Cells around a free pressure that keep its opposite ends apart in [`ApproximateInverse`].
pub(crate) const APART: usize = 16;

/// c of [`ApproximateInverse::plan_with_screened`], of |q|/2 of the shortest wave: a length of some ten cells.
const SCREEN: f64 = 0.03;

/// The approximate inverse of K: the symbol |q|/2, the mean like half the first wave.
///
/// It falls off as the third power of the distance: a free domain need not be padded to twice its cells, only so far that
/// the opposite ends of a pressure do not see each other. A third of a free convolution, and as good a preconditioner as the
/// padded one.
pub(crate) struct ApproximateInverse {
    cells: [usize; 2],
    lengths: [usize; 2],
    /// |q|/2 \[1/m\].
    spectrum: Array2<f64>,
    /// That of the grid's shortest wave \[1/m\], which no other exceeds.
    sharpest: f64,
    /// The least value of it.
    least: f64,
}

impl ApproximateInverse {
    /// For any pressure on the domain.
    pub(crate) fn new(grid: &Grid, boundary: Boundary) -> Self {
        Self::on(grid, Self::lengths(grid, boundary, APART))
    }

    /// The torus that leaves `apart` cells beyond a free domain.
    pub(crate) fn lengths(grid: &Grid, boundary: Boundary, apart: usize) -> [usize; 2] {
        match boundary {
            Boundary::Free => grid.cells().map(|n| Lanes::<f32>::good_length(n + apart)),
            Boundary::Periodic => grid.cells(),
        }
    }

    /// On a torus of these lengths.
    pub(crate) fn on(grid: &Grid, lengths: [usize; 2]) -> Self {
        let [dx, dy] = grid.spacing();
        let size = [dx * lengths[0] as f64, dy * lengths[1] as f64];
        let mean = 0.25 * std::f64::consts::TAU / size[0].max(size[1]);
        let spectrum = wave_spectrum(lengths, size, |qx, qy| inverse_kernel(qx, qy, mean));
        let least = spectrum.iter().fold(f64::INFINITY, |least, s| least.min(*s));
        ApproximateInverse { cells: grid.cells(), lengths, spectrum, sharpest: Self::sharpest(grid), least }
    }

    /// |q|/2 of the grid's shortest wave \[1/m\]: the unit of the plans.
    pub(crate) fn sharpest(grid: &Grid) -> f64 {
        let [qx, qy] = grid.spacing().map(|d| std::f64::consts::PI / d);
        0.5 * (qx * qx + qy * qy).sqrt()
    }

    /// It, over that of the shortest wave.
    pub(crate) fn plan(self) -> Lanes<f32> {
        let (cells, lengths) = (self.cells, self.lengths);
        Lanes::new(cells, lengths, self.scaled().view())
    }

    /// It, over that of the shortest wave, and the compliance 1/(|q|/2 + c) on the same torus, over its largest value. The
    /// compliance falls off as the third power of the distance beyond the length 1/(2 c).
    pub(crate) fn plan_with_screened(self) -> Lanes<f32> {
        let (cells, lengths) = (self.cells, self.lengths);
        let screen = SCREEN * self.sharpest;
        let mut screened = self.spectrum.clone();
        let peak = 1.0 / (screen + self.least);
        screened.par_mapv_inplace(|s| 1.0 / (s + screen) / peak);
        Lanes::with_spectra(cells, lengths, &[self.scaled().view(), screened.view()])
    }

    fn scaled(mut self) -> Array2<f64> {
        self.spectrum.par_mapv_inplace(|s| s / self.sharpest);
        self.spectrum
    }
}
