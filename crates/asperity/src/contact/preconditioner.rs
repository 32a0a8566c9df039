//! The preconditioner of the working set S: roughly the inverse of K restricted to S.
//!
//! M, the symbol |q|/2, inverts K on all cells. Restricted to S it does not: the inverse of the restriction is the Schur
//! complement
//!
//! (K_SS)^-1 = M_SS - M_SC (M_CC)^-1 M_CS, C all other cells,
//!
//! and what M_SS lacks is what happens at the ends of S, where the pressure is steep. M falls off as the third power of
//! the distance, so its nine nearest entries m stand for it inside the inverse, and a polynomial p of second degree for
//! that inverse:
//!
//! z = M_SS r + M_SC x, x = -p(m_CC) M_CS r.
//!
//! 1 - t p(t) = (1 + T_3)/(1 + T_3(0)) with the Chebyshev polynomial T_3 over the spectrum of m: never negative, so that
//! p(m) stays below the inverse of m and the whole is positive.
//!
//! It costs a second convolution in f32 on the unpadded grid and a pass over rows, and saves a quarter to a third of the
//! iterations. That pays where the convolution of a step is the padded one of a free domain; on a periodic one
//! z = M_SS r.

use asperity_convolution::eights::{Eight, Work, vectorize};
use asperity_convolution::lanes::Lanes;
use rayon::prelude::*;

use crate::grid::{Boundary, Grid};
use crate::kernel::inverse_kernel;
use crate::operator::approximate_inverse;

/// Rows of a block, which one thread works on.
const ROWS: usize = 32;
/// The degree of p: how often m is applied. The third saves 6 % of the iterations more, and costs more.
const DEGREE: usize = 2;
/// Rows of each step that are kept.
const KEPT: usize = DEGREE + 2;
/// The eigenvalues of m that p heeds, from this share of the largest.
const LEAST: f64 = 0.1;

/// z from r on a working set, both f32.
pub(super) struct Preconditioner {
    inverse: Lanes<f32>,
    /// Largest of the symbol of M \[1/m\], which `inverse` has as 1.
    pub sharpest: f64,
    ends: Option<Ends>,
}

/// What the ends of the working set need.
struct Ends {
    /// Cells of a row.
    cells: usize,
    stencil: Stencil,
    /// r on S, x elsewhere.
    folded: Vec<f32>,
    /// KEPT rows of every step for each block of rows, with a cell more at either end.
    rows: Vec<f32>,
}

/// m and p(m), m in units of the largest of the symbol.
#[derive(Clone, Copy)]
struct Stencil {
    /// The entries (0, 0), (1, 0), (0, 1) and (1, 1).
    nearest: [f32; 4],
    /// The coefficients of p, the constant first.
    polynomial: [f32; DEGREE + 1],
}

impl Preconditioner {
    pub(super) fn new(grid: &Grid, boundary: Boundary) -> Self {
        let (inverse, sharpest) = approximate_inverse(grid, boundary);
        let ends = (boundary == Boundary::Free).then(|| {
            let [nx, ny] = grid.cells();
            Ends {
                cells: ny,
                stencil: Stencil::new(grid.spacing(), sharpest),
                folded: vec![0.0; grid.len()],
                rows: vec![0.0; nx.div_ceil(ROWS) * (DEGREE + 1) * KEPT * (ny + 2)],
            }
        });
        Preconditioner { inverse, sharpest, ends }
    }

    /// z; what is beyond S means nothing. `r` is zero there.
    pub(super) fn apply_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32]) {
        self.inverse.apply_into(r, z);
        if let Some(Ends { cells, stencil, folded, rows }) = &mut self.ends {
            let blocks = folded.par_chunks_mut(ROWS * *cells);
            let rows = rows.par_chunks_mut((DEGREE + 1) * KEPT * (*cells + 2));
            blocks.zip(rows).enumerate().for_each(|(block, (folded, rows))| {
                let first = block * ROWS;
                vectorize(Fold { r, z, set, folded, rows, first, cells: *cells, stencil: *stencil });
            });
            self.inverse.apply_into(folded, z);
        }
    }
}

impl Stencil {
    fn new(spacing: [f64; 2], sharpest: f64) -> Self {
        let nearest = nearest_entries(spacing).map(|m| m / sharpest);
        let [m, mx, my, md] = nearest;
        // Linear in either cosine, the symbol of m is largest in a corner of the Brillouin zone.
        let corner = |(x, y): (f64, f64)| m + 2.0 * (mx * x + my * y) + 4.0 * md * x * y;
        let largest =
            [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(corner).into_iter().fold(0.0, f64::max);
        Stencil { nearest: nearest.map(|m| m as f32), polynomial: polynomial(largest).map(|c| c as f32) }
    }
}

/// The entries (0, 0), (1, 0), (0, 1), (1, 1) of M \[1/m\] on an infinite grid.
fn nearest_entries([dx, dy]: [f64; 2]) -> [f64; 4] {
    const SAMPLES: usize = 64;
    let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / SAMPLES as f64;
    let mut entries = [0.0; 4];
    for (a, b) in (0..SAMPLES * SAMPLES).map(|n| (angle(n / SAMPLES), angle(n % SAMPLES))) {
        let m = inverse_kernel(a / dx, b / dy, 0.0) / (SAMPLES * SAMPLES) as f64;
        let (x, y) = (libm::cos(a), libm::cos(b));
        entries = [entries[0] + m, entries[1] + m * x, entries[2] + m * y, entries[3] + m * x * y];
    }
    entries
}

/// The coefficients of p for a spectrum up to `largest`, the constant first.
fn polynomial(largest: f64) -> [f64; DEGREE + 1] {
    // T_3(x) = 4 x^3 - 3 x of x = a + b t.
    let (a, b) = ((1.0 + LEAST) / (1.0 - LEAST), -2.0 / (largest * (1.0 - LEAST)));
    let scale = -1.0 / (1.0 + 4.0 * a * a * a - 3.0 * a);
    [scale * (12.0 * a * a - 3.0) * b, scale * 12.0 * a * b * b, scale * 4.0 * b * b * b]
}

/// r + x on a block of rows, x = p(m_CC) b with b = -(M r)_C, by Horner's rule.
struct Fold<'a> {
    r: &'a [f32],
    /// M r.
    z: &'a [f32],
    set: &'a [u8],
    folded: &'a mut [f32],
    /// KEPT rows of: what is open, b, and the steps but for the last.
    rows: &'a mut [f32],
    /// The first row of the block.
    first: usize,
    cells: usize,
    stencil: Stencil,
}

impl Work for Fold<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        let ny = self.cells;
        let width = ny + 2;
        let (nx, count) = (self.z.len() / ny, self.folded.len() / ny);
        let (open, steps) = self.rows.split_at_mut(KEPT * width);
        // Rows are counted from DEGREE above the block: b there is what the block's first row needs.
        let row = |n: usize| (self.first + n).checked_sub(DEGREE).filter(|row| *row < nx);
        for n in 0..count + 2 * DEGREE {
            let (open_now, b) = (kept(open, width, n), kept(steps, width, n));
            match row(n) {
                Some(row) => {
                    openness(self.set, row * ny, &mut open_now[1..=ny]);
                    let z = &self.z[row * ny..][..ny];
                    for ((b, z), open) in b[1..=ny].iter_mut().zip(z).zip(&open_now[1..=ny]) {
                        *b = -z * open;
                    }
                }
                None => b.fill(0.0),
            }
            // A step's row needs the rows around it of the step before.
            for step in 1..=DEGREE.min(n / 2) {
                let n = n - step;
                let (before, now) = steps.split_at_mut(step * KEPT * width);
                let b = &before[n % KEPT * width..][1..=ny];
                let last = &before[(step - 1) * KEPT * width..];
                let around = [n - 1, n, n + 1].map(|n| &last[n % KEPT * width..][..width]);
                let open = &open[n % KEPT * width..][1..=ny];
                let own = self.stencil.polynomial[DEGREE - step];
                let highest = if step == 1 { self.stencil.polynomial[DEGREE] } else { 1.0 };
                let m = self.stencil.nearest.map(|m| highest * m);
                if step == DEGREE {
                    let folded = &mut self.folded[(n - DEGREE) * ny..][..ny];
                    nine(m, around, folded);
                    let r = &self.r[(self.first + n - DEGREE) * ny..][..ny];
                    for (((x, r), b), open) in folded.iter_mut().zip(r).zip(b).zip(open) {
                        *x = r + (own * b + *x) * open;
                    }
                    continue;
                }
                let now = kept(now, width, n);
                match row(n) {
                    Some(_) => {
                        nine(m, around, &mut now[1..=ny]);
                        for ((x, b), open) in now[1..=ny].iter_mut().zip(b).zip(open) {
                            *x = (own * b + *x) * open;
                        }
                    }
                    None => now.fill(0.0),
                }
            }
        }
    }
}

/// The place of row n among those that are kept.
#[inline(always)]
fn kept(rows: &mut [f32], width: usize, n: usize) -> &mut [f32] {
    &mut rows[n % KEPT * width..][..width]
}

/// m on one row; the rows around it have a cell more at either end, and so many that are zero.
#[inline(always)]
fn nine([m, mx, my, md]: [f32; 4], [above, here, below]: [&[f32]; 3], to: &mut [f32]) {
    let n = to.len();
    let (above, here, below) = (&above[..n + 2], &here[..n + 2], &below[..n + 2]);
    for j in 0..n {
        let corners = (above[j] + above[j + 2]) + (below[j] + below[j + 2]);
        let beside = mx * (above[j + 1] + below[j + 1]) + my * (here[j] + here[j + 2]);
        to[j] = m * here[j + 1] + (beside + md * corners);
    }
}

/// Of eight cells, by the byte of their set: 0 where a cell is in it, else 1.
static OPEN: [[f32; 8]; 256] = {
    let mut table = [[0.0; 8]; 256];
    let mut n = 0;
    while n < 8 * 256 {
        table[n / 8][n % 8] = (1 - (((n / 8) >> (n % 8)) & 1)) as f32;
        n += 1;
    }
    table
};

/// The same for the cells of a row that starts at cell `start`.
#[inline(always)]
fn openness(set: &[u8], start: usize, open: &mut [f32]) {
    if start.is_multiple_of(8) && open.len().is_multiple_of(8) {
        for (open, bits) in open.chunks_exact_mut(8).zip(&set[start / 8..]) {
            open.copy_from_slice(&OPEN[usize::from(*bits)]);
        }
    } else {
        for (n, open) in (start..).zip(open) {
            *open = OPEN[usize::from(set[n / 8])][n % 8];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A set of blobs on nx x ny cells.
    fn set([nx, ny]: [usize; 2]) -> Vec<u8> {
        let mut set = vec![0; (nx * ny).div_ceil(8)];
        for n in 0..nx * ny {
            let (x, y) = ((n / ny) as f64, (n % ny) as f64);
            if (0.31 * x).sin() + (0.23 * y + 0.1 * x).cos() > 0.4 {
                set[n / 8] |= 1 << (n % 8);
            }
        }
        set
    }

    fn is_in(set: &[u8], n: usize) -> bool {
        set[n / 8] >> (n % 8) & 1 == 1
    }

    fn noise(n: usize, seed: u32) -> f32 {
        let x = (n as u32).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(40_503));
        (x >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    #[test]
    fn rows_in_blocks_are_the_polynomial_of_the_stencil() {
        for cells in [[70, 48], [33, 21], [3, 5], [1, 40]] {
            let [nx, ny] = cells;
            let set = set(cells);
            let z: Vec<f32> = (0..nx * ny).map(|n| noise(n, 1)).collect();
            let r: Vec<f32> = (0..nx * ny).map(|n| if is_in(&set, n) { noise(n, 2) } else { 0.0 }).collect();
            let stencil = Stencil::new([1.0, 0.8], 3.0);
            let mut folded = vec![0.0_f32; nx * ny];
            let mut rows = vec![0.0; (DEGREE + 1) * KEPT * (ny + 2)];
            for (block, folded) in folded.chunks_mut(ROWS * ny).enumerate() {
                let first = block * ROWS;
                let fold =
                    Fold { r: &r, z: &z, set: &set, folded, rows: &mut rows, first, cells: ny, stencil };
                vectorize(fold);
            }
            // The same, cell by cell in f64.
            let open = |n: usize| if is_in(&set, n) { 0.0 } else { 1.0 };
            let times_m = |x: &[f64]| -> Vec<f64> {
                let entry = |a: usize, b: usize| match (
                    a.abs_diff(b / ny * ny + a % ny) / ny,
                    (a % ny).abs_diff(b % ny),
                ) {
                    (i @ 0..=1, j @ 0..=1) => f64::from(stencil.nearest[i + 2 * j]),
                    _ => 0.0,
                };
                (0..nx * ny)
                    .map(|a| (0..nx * ny).map(|b| entry(a, b) * x[b]).sum::<f64>() * open(a))
                    .collect()
            };
            let b: Vec<f64> = (0..nx * ny).map(|n| -f64::from(z[n]) * open(n)).collect();
            let mut x: Vec<f64> = b.iter().map(|b| f64::from(stencil.polynomial[DEGREE]) * b).collect();
            for c in stencil.polynomial[..DEGREE].iter().rev() {
                x = times_m(&x).iter().zip(&b).map(|(x, b)| x + f64::from(*c) * b).collect();
            }
            for n in 0..nx * ny {
                let exact = f64::from(r[n]) + x[n];
                // A dozen roundings of f32 in numbers of order one.
                assert!((f64::from(folded[n]) - exact).abs() < 3e-6, "{cells:?} {n}: {} {exact}", folded[n]);
            }
        }
    }

    #[test]
    fn it_is_symmetric_and_positive() {
        for (cells, boundary) in
            [([64, 48], Boundary::Free), ([37, 50], Boundary::Free), ([32, 32], Boundary::Periodic)]
        {
            let grid = Grid::new(cells, [1.0, 2.0]).unwrap();
            let set = set(cells);
            let mut preconditioner = Preconditioner::new(&grid, boundary);
            let mut of = |seed: u32| {
                let r: Vec<f32> =
                    (0..grid.len()).map(|n| if is_in(&set, n) { noise(n, seed) } else { 0.0 }).collect();
                let mut z = vec![0.0; grid.len()];
                preconditioner.apply_into(&r, &set, &mut z);
                (r, z)
            };
            let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| f64::from(a * b)).sum::<f64>();
            let ((r, z), (s, y)) = (of(3), of(4));
            assert!(dot(&r, &z) > 0.0 && dot(&s, &y) > 0.0);
            let size = (dot(&r, &z) * dot(&s, &y)).sqrt();
            assert!((dot(&r, &y) - dot(&s, &z)).abs() < 1e-5 * size, "{} {}", dot(&r, &y), dot(&s, &z));
        }
    }

    /// Where S and C alternate, an even pressure on S is nearly without displacement, and what C takes back is nearly all:
    /// the least that positivity has to spare.
    #[test]
    fn it_is_positive_on_stripes_and_checkerboards() {
        let n = 128;
        for aspect in [1.0, 3.0] {
            let grid = Grid::new([n, n], [1.0, aspect]).unwrap();
            let mut preconditioner = Preconditioner::new(&grid, Boundary::Free);
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
                let mut z = vec![0.0; n * n];
                preconditioner.apply_into(&r, &set, &mut z);
                let product: f64 = r.iter().zip(&z).map(|(r, z)| f64::from(r * z)).sum();
                assert!(product > 0.0, "{aspect} {product}");
            }
        }
    }

    /// 1 - t p(t) between 0 and 1: what is taken for the inverse of m is never more than it.
    #[test]
    fn the_polynomial_stays_below_the_inverse() {
        let c = polynomial(2.0);
        for k in 0..=1000 {
            let t = 2e-3 * f64::from(k);
            let rest = 1.0 - t * (c[0] + t * (c[1] + t * c[2]));
            assert!((-1e-12..=1.0 + 1e-12).contains(&rest), "{t}: {rest}");
        }
    }
}
