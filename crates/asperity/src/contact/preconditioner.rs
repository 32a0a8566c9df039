//! The preconditioner of the working set S: roughly the inverse of K restricted to S.
//!
//! M, the inverse of K's symbol, inverts K on all cells. Restricted to S it does not: the inverse of the restriction is the
//! Schur complement
//!
//! (K_SS)^-1 = M_SS - M_SC (M_CC)^-1 M_CS, C all other cells,
//!
//! and what M_SS lacks is what happens at the edges of S, where the pressure is steep. One step of steepest descent, itself
//! preconditioned, stands for the inverse inside: with b = M_CS r,
//!
//! z = M_SS r - a M_SC y, y = D G_CC D b, a = b'y / y'M y.
//!
//! G, the symbol 1/(M + c), is the screened compliance (S around the open cells screens it); D is less than 1 for cells
//! adjacent to S. a b'y never exceeds b'(M_CC)^-1 b, so z'r is positive whatever G is. z is not linear in r; the directions of
//! Polak and Ribiere do not need that.
//!
//! It costs three convolutions in f32 on the unpadded grid, and saves half of the iterations. The three are one chain: of what
//! lies between them only z is written to memory, and both products of a come from the spectra (Parseval).

use asperity_sweep::simd::vectorize;

use super::sweeps::preconditioner::{Add, Keep, Weigh};
use crate::grid::{Boundary, Grid};
use crate::operator::{ApproximateInverse, INVERSE, Operator, SCREENED};
use crate::set::find_adjacent;
use asperity_sweep::zeros;

/// z from r on a working set, both f32.
pub(super) struct Preconditioner {
    inverse: ApproximateInverse,
    /// The open cells adjacent to S.
    adjacent: Vec<u8>,
}

impl Preconditioner {
    pub(super) fn new(operator: &dyn Operator) -> Self {
        let inverse = operator.approximate_inverse();
        let cells = inverse.grid().len();
        Preconditioner { inverse, adjacent: zeros(cells.div_ceil(8)) }
    }

    /// Bytes that it takes at most.
    pub(super) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
        ApproximateInverse::bytes(grid, boundary) + grid.len() / 8
    }

    /// The unit of z, that of M, over the unit of r \[1/m\].
    pub(super) fn unit(&self) -> f64 {
        self.inverse.unit()
    }

    /// z from r, which is zero outside of S; what z holds there means nothing.
    pub(super) fn apply_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32]) {
        find_adjacent(set, self.inverse.grid().cells()[1], &mut self.adjacent);
        let adjacent = &self.adjacent[..];
        let part = |bits: &'_ [u8], first: usize, cells: usize| -> std::ops::Range<usize> {
            first / 8..(first + cells).div_ceil(8).min(bits.len())
        };
        let weigh = |first: usize, x: &mut [f32]| {
            let bytes = part(set, first, x.len());
            vectorize(Weigh { x, set: &set[bytes.clone()], adjacent: &adjacent[bytes] });
        };
        let mut chain = self.inverse.around(set).chain(r);
        chain.multiply(INVERSE);
        chain.modify(z, &|first, x, z| {
            vectorize(Keep { z, set: &set[part(set, first, x.len())], x });
            weigh(first, x);
        });
        let by = chain.multiply(SCREENED);
        chain.modify(&mut [], &|first, x, _| weigh(first, x));
        let ymy = chain.multiply(INVERSE);
        // Where nothing is open, b is zero.
        let a = if by > 0.0 && ymy > 0.0 { by / ymy } else { 0.0 };
        chain.finish(z, &|first, x, z| {
            vectorize(Add { z, set: &set[part(set, first, x.len())], x, t: -a });
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::half_space;
    use crate::set::tests::{is_in, set};

    fn noise(n: usize, seed: u32) -> f32 {
        let x = (n as u32).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(40_503));
        (x >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    /// r'z on a set, r as given there.
    fn rated(preconditioner: &mut Preconditioner, set: &[u8], r: &[f32]) -> f64 {
        let mut z = vec![0.0; r.len()];
        preconditioner.apply_into(r, set, &mut z);
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
            let mut preconditioner = Preconditioner::new(&*half_space(grid, boundary));
            for seed in 0..4 {
                // Smooth where the seed is even, noise where it is odd.
                let value = |k: usize| if seed % 2 == 0 { 1.0 } else { noise(k, seed) };
                let r: Vec<f32> = (0..n).map(|k| if is_in(&set, k) { value(k) } else { 0.0 }).collect();
                let mut z = vec![0.0; n];
                preconditioner.inverse.around(&set).apply_into(&r, &mut z);
                let whole = dot(&r, &z);
                // b'(M_CC)^-1 b, by conjugate gradients until nothing is left.
                let open = |z: &[f32]| -> Vec<f32> {
                    z.iter().enumerate().map(|(k, z)| if is_in(&set, k) { 0.0 } else { *z }).collect()
                };
                let mut rest = open(&z);
                let (mut d, mut taken, mut size) = (rest.clone(), 0.0, dot(&rest, &rest));
                let least = 1e-10 * size;
                while size > least {
                    preconditioner.inverse.around(&set).apply_into(&d, &mut z);
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
        let mut preconditioner = Preconditioner::new(&*half_space(grid, Boundary::Free));
        let r: Vec<f32> = (0..grid.len()).map(|n| noise(n, 1)).collect();
        let mut z = vec![0.0; grid.len()];
        preconditioner.inverse.around(&[u8::MAX; 60]).apply_into(&r, &mut z);
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
            let mut preconditioner = Preconditioner::new(&*half_space(grid, Boundary::Free));
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
