//! The preconditioner of the working set S: roughly the inverse of K restricted to S.
//!
//! M, the symbol |q|/2, inverts K on all cells. Restricted to S it does not: the inverse of the restriction is the Schur
//! complement
//!
//! (K_SS)^-1 = M_SS - M_SC (M_CC)^-1 M_CS, C all other cells,
//!
//! and what M_SS lacks is what happens at the ends of S, where the pressure is steep. One step of steepest descent, itself
//! preconditioned, stands for the inverse inside: with b = M_CS r,
//!
//! z = M_SS r - a M_SC y, y = D G_CC D b, a = b'y / y'M y.
//!
//! G, the symbol 1/(|q|/2 + c), is the compliance screened, for S around the open cells ends its reach; D is less than 1 for
//! cells beside S, which it holds most.
//! a b'y never exceeds b'(M_CC)^-1 b, so z'r is positive whatever G is. z is not linear in r; the directions of Polak and
//! Ribiere do not ask for it.
//!
//! It costs two more convolutions in f32 on the unpadded grid, and saves half of the iterations. The three are one chain:
//! of what lies between them only z is ever in memory, and both products of a come from the spectra.

use asperity_convolution::Visit;
use asperity_convolution::eights::{Eight, Mask, Work, vectorize};
use asperity_convolution::lanes::Sums;

use super::neighbours::find_beside;
use super::torus::{G, M, Tori};
use crate::field::zeros;
use crate::grid::{Boundary, Grid};
use crate::operator::ApproximateInverse;

/// D of an open cell that touches one of S with a side or a corner.
const BESIDE: f64 = 0.67;

/// z from r on a working set, both f32.
pub(super) struct Preconditioner {
    /// The plans of M and G.
    tori: Tori,
    /// The unit of M \[1/m\].
    pub sharpest: f64,
    /// Cells of a row.
    row: usize,
    /// The open cells beside S.
    beside: Vec<u8>,
}

impl Preconditioner {
    pub(super) fn new(grid: &Grid, boundary: Boundary) -> Self {
        Preconditioner {
            tori: Tori::new(grid, boundary),
            sharpest: ApproximateInverse::sharpest(grid),
            row: grid.cells()[1],
            beside: zeros(grid.len().div_ceil(8)),
        }
    }

    /// z; what is beyond S means nothing. `r` is zero there. `visit(first, z)` meets some rows of z at a time, of which
    /// `first` is the number of the first cell; returns the totals of its sums.
    pub(super) fn apply_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32], visit: &Visit<f32>) -> Sums {
        find_beside(set, self.row, &mut self.beside);
        let open = Open { set, beside: &self.beside };
        let mut chain = self.tori.around(set).chain(r);
        chain.times(M);
        chain.turn(z, &|first, x, z| {
            let open = open.of(first, z);
            vectorize(Keep { z, set: open.set, x });
            vectorize(Weigh { x, open });
            Sums::default()
        });
        let by = chain.times_measured(G);
        chain.turn(&mut [], &|first, x, _| {
            let open = open.of(first, x);
            vectorize(Weigh { x, open });
            Sums::default()
        });
        let ymy = chain.times_measured(M);
        // Where nothing is open, b is zero.
        let a = if by > 0.0 && ymy > 0.0 { by / ymy } else { 0.0 };
        chain.end(z, &|first, x, z| {
            let set = open.of(first, z).set;
            vectorize(Add { z, set, x, t: -a });
            visit(first, z)
        })
    }
}

/// C as bits: what is not of the set, and of that what is beside it.
#[derive(Clone, Copy)]
struct Open<'a> {
    set: &'a [u8],
    beside: &'a [u8],
}

impl<'a> Open<'a> {
    /// From a cell on, a multiple of eight, as many as there are `cells`.
    fn of(self, first: usize, cells: &[f32]) -> Self {
        let bytes = first / 8..(first + cells.len()).div_ceil(8);
        Open { set: &self.set[bytes.clone()], beside: &self.beside[bytes] }
    }
}

/// z = x where a group of cells has one of S.
struct Keep<'a> {
    z: &'a mut [f32],
    set: &'a [u8],
    x: &'a [f32],
}

impl Work for Keep<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        for (n, _) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            V::load(self.x, n, 0.0).store(self.z, n);
        }
    }
}

/// x becomes D x, 0 on S.
struct Weigh<'a> {
    x: &'a mut [f32],
    open: Open<'a>,
}

impl Work for Weigh<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        for ((n, set), beside) in (0..).step_by(8).zip(self.open.set).zip(self.open.beside) {
            let [beside, open] = [*beside, !set].map(V::Mask::from_bits);
            let weights = V::select(beside, V::splat(BESIDE), V::splat(1.0)).only(open);
            (V::load(self.x, n, 0.0) * weights).store(self.x, n);
        }
    }
}

/// z += t x on S.
struct Add<'a> {
    z: &'a mut [f32],
    x: &'a [f32],
    set: &'a [u8],
    t: f64,
}

impl Work for Add<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        let t = V::splat(self.t);
        for (n, _) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            (V::load(self.z, n, 0.0) + t * V::load(self.x, n, 0.0)).store(self.z, n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::neighbours::tests::{is_in, set};

    fn noise(n: usize, seed: u32) -> f32 {
        let x = (n as u32).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(40_503));
        (x >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    /// r'z on a set, r as given there.
    fn rated(preconditioner: &mut Preconditioner, set: &[u8], r: &[f32]) -> f64 {
        let mut z = vec![0.0; r.len()];
        preconditioner.apply_into(r, set, &mut z, &|_, _| Sums::default());
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
            let mut preconditioner = Preconditioner::new(&grid, boundary);
            for seed in 0..4 {
                // Smooth where the seed is even, noise where it is odd.
                let value = |k: usize| if seed % 2 == 0 { 1.0 } else { noise(k, seed) };
                let r: Vec<f32> = (0..n).map(|k| if is_in(&set, k) { value(k) } else { 0.0 }).collect();
                let mut z = vec![0.0; n];
                preconditioner.tori.around(&set).apply_into(&r, &mut z);
                let whole = dot(&r, &z);
                // b'(M_CC)^-1 b, by conjugate gradients until nothing is left.
                let open = |z: &[f32]| -> Vec<f32> {
                    z.iter().enumerate().map(|(k, z)| if is_in(&set, k) { 0.0 } else { *z }).collect()
                };
                let mut rest = open(&z);
                let (mut d, mut taken, mut size) = (rest.clone(), 0.0, dot(&rest, &rest));
                let least = 1e-10 * size;
                while size > least {
                    preconditioner.tori.around(&set).apply_into(&d, &mut z);
                    let md = open(&z);
                    let step = size / dot(&d, &md);
                    taken += step * size;
                    rest.iter_mut().zip(&md).for_each(|(rest, md)| *rest -= step as f32 * md);
                    let next = dot(&rest, &rest);
                    d.iter_mut().zip(&rest).for_each(|(d, rest)| *d = rest + (next / size) as f32 * *d);
                    size = next;
                }
                let found = rated(&mut preconditioner, &set, &r);
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
        let mut preconditioner = Preconditioner::new(&grid, Boundary::Free);
        let r: Vec<f32> = (0..grid.len()).map(|n| noise(n, 1)).collect();
        let mut z = vec![0.0; grid.len()];
        preconditioner.tori.around(&[u8::MAX; 60]).apply_into(&r, &mut z);
        assert_eq!(rated(&mut preconditioner, &[u8::MAX; 60], &r), dot(&r, &z));
        assert_eq!(rated(&mut preconditioner, &[0; 60], &[0.0; 480]), 0.0);
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
                let product = rated(&mut preconditioner, &set, &r);
                assert!(product > 0.0, "{aspect} {product}");
            }
        }
    }
}
