//! A multigrid cycle for networks too large to factorise.
//!
//! Blocks of two by two cells become one cell. The coarse face has half of the total conductance of its fine faces, which is
//! exact for a constant gap; conductances to ground are added. A level does one red-black Gauss-Seidel sweep before and the
//! reverse one after the coarser level, which takes two steps of flexible conjugate gradients (K-cycle; Y. Notay & P. S.
//! Vassilevski, Numer. Linear Algebra Appl. 15 (2008) 473) and is factorised if it is small enough.

use super::cholesky::Cholesky;
use super::network::Network;
use asperity_sweep::{add, dot};

/// Largest number of cells that are factorised: 150 MB. Tests use a small number to have several levels.
const FACTORISED: usize = if cfg!(test) { 1 << 7 } else { 1 << 18 };

/// A level and those below it.
pub(super) struct Multigrid {
    network: Network,
    /// One over the diagonal, and 0 for cells that are not unknowns.
    inverse: Vec<f64>,
    below: Below,
}

enum Below {
    Factor(Box<Cholesky>),
    Level(Box<Multigrid>),
    /// If there is not enough memory for either: only the sweeps of this level.
    Nothing,
}

impl Multigrid {
    pub fn new(network: &Network) -> Multigrid {
        let coarse = coarser(network);
        let factor = if coarse.along.len() <= FACTORISED { Cholesky::new(&coarse) } else { None };
        let below = match factor {
            Some(factor) => Below::Factor(Box::new(factor)),
            None if coarse.along.len() > FACTORISED => Below::Level(Box::new(Multigrid::new(&coarse))),
            None => Below::Nothing,
        };
        let inverse = network.diagonal().iter().map(|d| if *d > 0.0 { d.recip() } else { 0.0 }).collect();
        Multigrid { network: network.clone(), inverse, below }
    }

    /// x = approximately A^-1 b.
    pub fn cycle(&mut self, b: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        self.relax(b, x, [0, 1]);
        let mut r = vec![0.0; x.len()];
        self.network.residual(b, x, &mut r);
        let coarse = restricted(&r, self.network.cells);
        let mut correction = vec![0.0; coarse.len()];
        match &mut self.below {
            Below::Factor(factor) => factor.solve(&coarse, &mut correction),
            Below::Level(level) => level.two_steps(&coarse, &mut correction),
            Below::Nothing => {}
        }
        let m = self.network.cells[1];
        let columns = m.div_ceil(2);
        let coarse_of = |i: usize, j: usize| (i / 2) * columns + j / 2;
        self.network.each(&mut r, |i, j, here| x[here] + correction[coarse_of(i, j)]);
        x.copy_from_slice(&r);
        self.relax(b, x, [1, 0]);
    }

    /// One Gauss-Seidel sweep over the cells of each colour in turn.
    fn relax(&self, b: &[f64], x: &mut [f64], colours: [usize; 2]) {
        let mut old = x.to_vec();
        for colour in colours {
            old.copy_from_slice(x);
            self.network.each(x, |i, j, here| {
                if (i + j) % 2 == colour {
                    old[here] + self.inverse[here] * (b[here] - self.network.outflow(&old, i, j))
                } else {
                    old[here]
                }
            });
        }
    }

    /// Two steps of flexible conjugate gradients.
    fn two_steps(&mut self, b: &[f64], x: &mut [f64]) {
        let n = b.len();
        let [mut first, mut a_first, mut r] = [vec![0.0; n], vec![0.0; n], b.to_vec()];
        self.cycle(&r, &mut first);
        self.network.apply(&first, &mut a_first);
        let curvature = dot(&first, &a_first);
        if curvature.is_nan() || curvature <= 0.0 {
            return;
        }
        let length = dot(&first, b) / curvature;
        add(x, length, &first);
        add(&mut r, -length, &a_first);
        let [mut second, mut a_second] = [vec![0.0; n], vec![0.0; n]];
        self.cycle(&r, &mut second);
        let overlap = dot(&second, &a_first) / curvature;
        add(&mut second, -overlap, &first);
        self.network.apply(&second, &mut a_second);
        let curvature = dot(&second, &a_second);
        if curvature > 0.0 {
            add(x, dot(&second, &r) / curvature, &second);
        }
    }
}

/// Sums over two by two cells.
fn restricted(fine: &[f64], [n, m]: [usize; 2]) -> Vec<f64> {
    let columns = m.div_ceil(2);
    let mut coarse = vec![0.0; n.div_ceil(2) * columns];
    for i in 0..n {
        for j in 0..m {
            coarse[(i / 2) * columns + j / 2] += fine[i * m + j];
        }
    }
    coarse
}

/// The network of two by two cells.
fn coarser(network: &Network) -> Network {
    let [n, m] = network.cells;
    let [rows, columns] = [n.div_ceil(2), m.div_ceil(2)];
    let mut coarse = Network {
        cells: [rows, columns],
        along: vec![0.0; rows * columns],
        across: vec![0.0; rows * columns],
        ground: restricted(&network.ground, network.cells),
    };
    for i in 0..n {
        for j in 0..m {
            let (here, block) = (i * m + j, (i / 2) * columns + j / 2);
            // Faces inside a block are omitted; a block has no face with itself.
            if (i % 2 == 1 || i + 1 == n) && rows > 1 {
                coarse.along[block] += 0.5 * network.along[here];
            }
            if (j % 2 == 1 || j + 1 == m) && columns > 1 {
                coarse.across[block] += 0.5 * network.across[here];
            }
        }
    }
    coarse
}
