//! The approximate inverse of K: the inverse of its symbol, by convolutions in f32 on a torus of little more than the domain.
//!
//! M = 1/K^(q) (|q|/2 on a half-space) falls off as the third power of the distance. So a free domain need not be padded to
//! twice its cells, only so far that the opposite ends of a pressure do not interact: a third of a free convolution, and as
//! good a preconditioner as the padded one. G = 1/(M + c) is the compliance, screened beyond the length of some ten cells.

use std::sync::Arc;

use super::wave_spectrum;
use crate::convolution::batched::BatchedFft;
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;
use crate::set::margins;

/// Spectrum number of M in a plan of [`ApproximateInverse::around`], over its value at the grid's shortest wave.
pub(crate) const INVERSE: usize = 0;
/// Spectrum number of G, over its largest value.
pub(crate) const SCREENED: usize = 1;

/// Empty lines of cells that keep the opposite ends of a free pressure from interacting around the torus.
const APART: usize = 16;
/// c of G, as a share of M at the shortest wave.
const SCREEN: f64 = 0.03;

/// Plans of M and G. A set of cells whose own margins keep its ends apart is served by a torus of the domain's size, any other
/// by a wider one, with a fourth more cells at 1024 x 1024. The choice depends on the set alone; each torus is planned when it
/// is first wanted.
pub struct ApproximateInverse {
    grid: Grid,
    kernel: Arc<dyn Kernel>,
    close: Torus,
    wide: Torus,
}

struct Torus {
    lengths: [usize; 2],
    plan: Option<BatchedFft<f32>>,
}

impl ApproximateInverse {
    /// For the operator with that kernel.
    pub fn new(grid: Grid, boundary: Boundary, kernel: Arc<dyn Kernel>) -> Self {
        let torus = |apart| Torus { lengths: lengths(&grid, boundary, apart), plan: None };
        ApproximateInverse { grid, kernel, close: torus(0), wide: torus(APART) }
    }

    /// Bytes that the plans take at most.
    pub(crate) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
        let [close, wide] = [0, APART].map(|apart| lengths(grid, boundary, apart));
        let bytes = |lengths| BatchedFft::<f32>::bytes(grid.cells(), lengths, 2);
        bytes(wide) + if close == wide { 0 } else { bytes(close) }
    }

    /// The grid that it works on.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// M at the grid's shortest wave \[1/m\], which no other wave exceeds: the unit of M in the plans.
    pub fn unit(&self) -> f64 {
        let [qx, qy] = self.grid.spacing().map(|d| std::f64::consts::PI / d);
        let qy = if self.grid.is_line() { 0.0 } else { qy };
        1.0 / self.kernel.symbol(qx, qy)
    }

    /// z = M r / [`unit`](Self::unit).
    pub fn apply_into(&mut self, r: &[f32], z: &mut [f32]) {
        let unit = self.unit();
        let (grid, kernel) = (&self.grid, &*self.kernel);
        self.wide.planned(grid, kernel, unit).apply_into(r, z);
    }

    /// The plan for pressures on a set of cells (bits, eight in a byte).
    pub(crate) fn around(&mut self, set: &[u8]) -> &mut BatchedFft<f32> {
        let unit = self.unit();
        let torus = if self.is_apart(set) { &mut self.close } else { &mut self.wide };
        torus.planned(&self.grid, &*self.kernel, unit)
    }

    /// True where the close torus differs from the wide one and keeps the ends of the set apart.
    fn is_apart(&self, set: &[u8]) -> bool {
        let (cells, lengths) = (self.grid.cells(), self.close.lengths);
        let margins = || margins(set, cells, APART);
        lengths != self.wide.lengths
            && margins().iter().zip(lengths).zip(cells).all(|((margin, m), n)| margin + m - n >= APART)
    }
}

/// The torus that leaves `apart` cells beyond a free domain.
fn lengths(grid: &Grid, boundary: Boundary, apart: usize) -> [usize; 2] {
    match boundary {
        Boundary::Free if grid.is_line() => [BatchedFft::<f32>::good_length(grid.cells()[0] + apart), 1],
        Boundary::Free => grid.cells().map(|n| BatchedFft::<f32>::good_length(n + apart)),
        Boundary::Periodic => grid.cells(),
    }
}

impl Torus {
    fn planned(&mut self, grid: &Grid, kernel: &dyn Kernel, unit: f64) -> &mut BatchedFft<f32> {
        let lengths = self.lengths;
        self.plan.get_or_insert_with(|| {
            let [dx, dy] = grid.spacing();
            let size = [dx * lengths[0] as f64, dy * lengths[1] as f64];
            // Where a uniform pressure has no displacement of its own: half of M at the longest wave.
            let longest = std::f64::consts::TAU / if grid.is_line() { size[0] } else { size[0].max(size[1]) };
            let own = kernel.uniform().filter(|uniform| *uniform > 0.0);
            let uniform = own.map_or(0.5 / kernel.symbol(longest, 0.0), |u| 1.0 / u);
            let inverse =
                wave_spectrum(lengths, size, uniform / unit, |qx, qy| 1.0 / (kernel.symbol(qx, qy) * unit));
            let least = inverse.iter().fold(f64::INFINITY, |least, s| least.min(*s));
            let screened = inverse.mapv(|s| (least + SCREEN) / (s + SCREEN));
            BatchedFft::with_spectra(grid.cells(), lengths, &[inverse.view(), screened.view()])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::HalfSpace;

    /// Which tori are planned after a set of these rows, `left` columns in from both sides.
    fn planned(
        boundary: Boundary,
        cells: [usize; 2],
        rows: std::ops::Range<usize>,
        left: usize,
    ) -> [bool; 2] {
        let [nx, ny] = cells;
        let mut set = vec![0; (nx * ny).div_ceil(8)];
        for n in rows.flat_map(|i| (left..ny - left).map(move |j| i * ny + j)) {
            set[n / 8] |= 1 << (n % 8);
        }
        let grid = Grid::new(cells, [1.0, 1.0]).unwrap();
        let mut inverse = ApproximateInverse::new(grid, boundary, Arc::new(HalfSpace));
        inverse.around(&set);
        [inverse.close, inverse.wide].map(|torus| torus.plan.is_some())
    }

    #[test]
    fn a_set_with_margins_of_its_own_needs_no_wider_torus() {
        let (close, wide) = ([true, false], [false, true]);
        assert_eq!(planned(Boundary::Free, [128, 64], 8..120, 8), close);
        assert_eq!(planned(Boundary::Free, [128, 64], 16..128, 8), close);
        assert_eq!(planned(Boundary::Free, [128, 64], 15..128, 8), wide);
        assert_eq!(planned(Boundary::Free, [128, 64], 8..120, 7), wide);
        // 120 rows are transformed as 128 anyway.
        assert_eq!(planned(Boundary::Free, [120, 64], 4..116, 8), close);
        assert_eq!(planned(Boundary::Free, [112, 48], 0..112, 0), wide);
        assert_eq!(planned(Boundary::Periodic, [128, 64], 20..100, 20), wide);
    }
}
