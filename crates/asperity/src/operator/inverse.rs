//! The approximate inverse of K, on all cells and restricted to a set of them: what preconditions a solver.
//!
//! M, the inverse of K's symbol (|q|/2 on a half-space), inverts K on all cells. It falls off as the third power of the
//! distance. So a free domain need not be padded to twice its cells, only so far that the opposite ends of a pressure do not
//! interact: a third of a free convolution, and as good a preconditioner as the padded one.
//!
//! Restricted to a set S it does not invert K: the inverse of the restriction is the Schur complement
//!
//! (K_SS)^-1 = M_SS - M_SC (M_CC)^-1 M_CS, C all other cells,
//!
//! and what M_SS lacks is what happens at the edges of S, where the pressure is steep. One step of steepest descent, itself
//! preconditioned, stands for the inverse inside: with b = M_CS r,
//!
//! z = M_SS r - a M_SC y, y = D G_CC D b, a = b'y / y'M y.
//!
//! G, the symbol 1/(M + c), is the compliance, screened beyond the length of some ten cells (S around the open cells screens
//! it); D is less than 1 for cells adjacent to S. a b'y never exceeds b'(M_CC)^-1 b, so z'r is positive whatever G is. z is not
//! linear in r; the directions of Polak and Ribiere do not need that. It costs three convolutions on the small torus, in single
//! precision, and saves half of the iterations.

use std::sync::Arc;

use super::backend::{Backend, InversePlan};
use super::{default_backend, wave_spectrum};
use crate::convolution::Convolution;
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;
use crate::set::margins;
use asperity_sweep::minimum;

/// Empty lines of cells that keep the opposite ends of a free pressure from interacting around the torus.
const SEPARATION: usize = 16;
/// c of G, as a share of M at the shortest wave.
const SCREENING: f64 = 0.03;

/// Plans of M and G. A set of cells whose own margins keep its ends apart is served by a torus of the domain's size, any other
/// by a wider one, with a fourth more cells at 1024 x 1024. The choice depends on the set alone; each torus is planned when it
/// is first wanted.
pub struct ApproximateInverse {
    grid: Grid,
    backend: Arc<dyn Backend>,
    kernel: Arc<dyn Kernel>,
    close: Torus,
    wide: Torus,
}

struct Torus {
    lengths: [usize; 2],
    plan: Option<Box<dyn InversePlan>>,
}

impl ApproximateInverse {
    /// For the operator with that kernel, on the same back end.
    pub fn new(backend: Arc<dyn Backend>, grid: Grid, boundary: Boundary, kernel: Arc<dyn Kernel>) -> Self {
        let torus = |separation| Torus { lengths: lengths(&grid, boundary, separation), plan: None };
        ApproximateInverse { grid, backend, kernel, close: torus(0), wide: torus(SEPARATION) }
    }

    /// The same for another kernel.
    pub(crate) fn of(self, kernel: impl FnOnce(Arc<dyn Kernel>) -> Arc<dyn Kernel>) -> Self {
        let [close, wide] = [self.close, self.wide].map(|torus| Torus { plan: None, ..torus });
        ApproximateInverse { kernel: kernel(self.kernel), close, wide, ..self }
    }

    /// Bytes that the plans take at most.
    pub(crate) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
        let [close, wide] = [0, SEPARATION].map(|separation| lengths(grid, boundary, separation));
        let bytes = |lengths| default_backend().inverse_bytes(grid.cells(), lengths);
        bytes(wide) + if close == wide { 0 } else { bytes(close) }
    }

    /// M at the grid's shortest wave \[1/m\], which no other wave exceeds: the unit of z over that of r.
    pub fn unit(&self) -> f64 {
        let [qx, qy] = self.grid.spacing().map(|d| std::f64::consts::PI / d);
        let qy = if self.grid.is_line() { 0.0 } else { qy };
        1.0 / self.kernel.symbol(qx, qy)
    }

    /// z = M r / [`unit`](Self::unit).
    pub fn apply_into(&mut self, r: &[f32], z: &mut [f32]) {
        self.planned(false).apply_into(r, z);
    }

    /// z, roughly the inverse of K restricted to a set of cells (bits, eight in a byte) times r, over [`unit`](Self::unit); r is
    /// zero outside of the set, and what z holds there means nothing.
    pub fn apply_on_set_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32]) {
        self.around(set).apply_on_set_into(r, set, z);
    }

    /// The plan for pressures on a set of cells.
    fn around(&mut self, set: &[u8]) -> &mut dyn InversePlan {
        self.planned(self.is_separate(set))
    }

    /// The plan on the close torus or on the wide one.
    fn planned(&mut self, is_close: bool) -> &mut dyn InversePlan {
        let unit = self.unit();
        let ApproximateInverse { grid, backend, kernel, close, wide } = self;
        let Torus { lengths, plan } = if is_close { close } else { wide };
        let plan = plan.get_or_insert_with(|| {
            let [dx, dy] = grid.spacing();
            let size = [dx * lengths[0] as f64, dy * lengths[1] as f64];
            // Where a uniform pressure has no displacement of its own: half of M at the longest wave.
            let longest = std::f64::consts::TAU / if grid.is_line() { size[0] } else { size[0].max(size[1]) };
            let own = kernel.uniform().filter(|uniform| *uniform > 0.0);
            let uniform = own.map_or(0.5 / kernel.symbol(longest, 0.0), |u| 1.0 / u);
            let inverse =
                wave_spectrum(*lengths, size, uniform / unit, |qx, qy| 1.0 / (kernel.symbol(qx, qy) * unit));
            let least = minimum(inverse.as_slice().unwrap_or_default());
            let screened = inverse.mapv(|s| (least + SCREENING) / (s + SCREENING));
            backend.plan_inverse(grid.cells(), *lengths, inverse, screened)
        });
        &mut **plan
    }

    /// True where the close torus differs from the wide one and keeps the ends of the set apart.
    fn is_separate(&self, set: &[u8]) -> bool {
        let (cells, lengths) = (self.grid.cells(), self.close.lengths);
        let margins = || margins(set, cells, SEPARATION);
        lengths != self.wide.lengths
            && margins().iter().zip(lengths).zip(cells).all(|((margin, m), n)| margin + m - n >= SEPARATION)
    }
}

/// The torus that leaves `separation` cells beyond a free domain.
fn lengths(grid: &Grid, boundary: Boundary, separation: usize) -> [usize; 2] {
    match boundary {
        Boundary::Free if grid.is_line() => [Convolution::good_length(grid.cells()[0] + separation), 1],
        Boundary::Free => grid.cells().map(|n| Convolution::good_length(n + separation)),
        Boundary::Periodic => grid.cells(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::half_space;
    use super::*;
    use crate::kernel::HalfSpace;
    use crate::set::tests::{is_in, set};

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
        let mut inverse = ApproximateInverse::new(default_backend(), grid, boundary, Arc::new(HalfSpace));
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

    fn noise(n: usize, seed: u32) -> f32 {
        let x = (n as u32).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(40_503));
        (x >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    /// r'z on a set, r as given there.
    fn rated(inverse: &mut ApproximateInverse, set: &[u8], r: &[f32]) -> f64 {
        let mut z = vec![0.0; r.len()];
        inverse.apply_on_set_into(r, set, &mut z);
        assert!(z.iter().all(|z| z.is_finite()));
        dot(r, &z)
    }

    fn dot(x: &[f32], y: &[f32]) -> f64 {
        x.iter().zip(y).map(|(x, y)| f64::from(*x) * f64::from(*y)).sum()
    }

    /// r'z lies between that of the Schur complement and that of M_SS, and most of the way to the former.
    #[test]
    fn it_is_near_the_inverse_on_the_set() {
        for (cells, boundary) in
            [([48, 40], Boundary::Free), ([37, 50], Boundary::Free), ([32, 32], Boundary::Periodic)]
        {
            let grid = Grid::new(cells, [1.0, 2.0]).unwrap();
            let (set, n) = (set(cells), grid.len());
            let mut inverse = half_space(grid, boundary).approximate_inverse();
            for seed in 0..4 {
                // Smooth where the seed is even, noise where it is odd.
                let value = |k: usize| if seed % 2 == 0 { 1.0 } else { noise(k, seed) };
                let r: Vec<f32> = (0..n).map(|k| if is_in(&set, k) { value(k) } else { 0.0 }).collect();
                let mut z = vec![0.0; n];
                inverse.around(&set).apply_into(&r, &mut z);
                let whole = dot(&r, &z);
                // b'(M_CC)^-1 b, by conjugate gradients until nothing is left.
                let open = |z: &[f32]| -> Vec<f32> {
                    z.iter().enumerate().map(|(k, z)| if is_in(&set, k) { 0.0 } else { *z }).collect()
                };
                let mut rest = open(&z);
                let (mut d, mut taken, mut size) = (rest.clone(), 0.0, dot(&rest, &rest));
                let least = 1e-10 * size;
                while size > least {
                    inverse.around(&set).apply_into(&d, &mut z);
                    let md = open(&z);
                    let step = size / dot(&d, &md);
                    taken += step * size;
                    rest.iter_mut().zip(&md).for_each(|(rest, md)| *rest -= step as f32 * md);
                    let next = dot(&rest, &rest);
                    d.iter_mut().zip(&rest).for_each(|(d, rest)| *d = rest + (next / size) as f32 * *d);
                    size = next;
                }
                let found = rated(&mut inverse, &set, &r);
                let share = (whole - found) / taken;
                // More than the whole is rounding of f32; 0.89 is the least of these cases.
                assert!((0.85..1.0 + 1e-4).contains(&share), "{cells:?} {boundary:?} {seed}: {share}");
                assert!(found > 0.0);
            }
        }
    }

    #[test]
    fn all_cells_or_none() {
        let grid = Grid::new([24, 20], [1.0, 1.0]).unwrap();
        let mut inverse = half_space(grid, Boundary::Free).approximate_inverse();
        let r: Vec<f32> = (0..grid.len()).map(|n| noise(n, 1)).collect();
        let mut z = vec![0.0; grid.len()];
        inverse.around(&[u8::MAX; 60]).apply_into(&r, &mut z);
        assert_eq!(rated(&mut inverse, &[u8::MAX; 60], &r), dot(&r, &z));
        assert_eq!(rated(&mut inverse, &[0; 60], &[0.0; 480]), 0.0);
    }

    /// Where S and C alternate, an even pressure on S is nearly without displacement, and what C takes back is nearly all:
    /// the least that positivity has to spare.
    #[test]
    fn it_is_positive_on_stripes_and_checkerboards() {
        let n = 128;
        for aspect in [1.0, 3.0] {
            let grid = Grid::new([n, n], [1.0, aspect]).unwrap();
            let mut inverse = half_space(grid, Boundary::Free).approximate_inverse();
            let patterns: [fn(usize, usize) -> bool; 4] = [
                |i, _| i % 2 == 0,
                |_, j| j % 2 == 0,
                |i, j| (i + j) % 2 == 0,
                |i, j| i % 2 == 0 && j % 2 == 0,
            ];
            for pattern in patterns {
                let mut set = vec![0; n * n / 8];
                let mut r = vec![0.0; n * n];
                for k in (0..n * n).filter(|k| pattern(k / n, k % n)) {
                    set[k / 8] |= 1 << (k % 8);
                    r[k] = 1.0;
                }
                let product = rated(&mut inverse, &set, &r);
                assert!(product > 0.0, "{aspect} {product}");
            }
        }
    }
}
