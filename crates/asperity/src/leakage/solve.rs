//! The linear system of a network: conjugate gradients around a factorisation, or around a multigrid cycle if the factor would
//! not fit into memory.
//!
//! The residual is not a measure of the error of the leak: at a residual of 1e-6 the error of the flux may exceed 100 %. The
//! power that the flow dissipates, the sum of t dP^2 over all faces, is an upper bound of the leak with an error that is
//! quadratic in that of the pressure (Dirichlet's principle), so the iteration ends when this power has converged.

use super::cholesky::{Cholesky, factor_bytes};
use super::multigrid::Multigrid;
use super::network::Network;
use crate::error::{Error, NotConverged, Result};
use asperity_sweep::{add, dot, each};

/// Options of the flow solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowOptions {
    /// Memory that a factorisation may take \[bytes\]; above it the solution is iterative. Default 4 GB, for about 5 million open
    /// cells.
    pub memory: f64,
    /// Largest number of iterations of a linear system. Default 2000.
    pub max_iterations: usize,
}

impl Default for FlowOptions {
    fn default() -> Self {
        FlowOptions { memory: 4e9, max_iterations: 2000 }
    }
}

/// An approximate inverse of a network's matrix.
pub(super) enum Inverse {
    /// Exact up to rounding; cells that the network has since are scaled by one over their diagonal.
    Factor(Box<Cholesky>, Vec<(usize, f64)>),
    /// One cycle.
    Cycle(Multigrid),
}

impl Inverse {
    pub fn new(network: &Network, options: &FlowOptions) -> Inverse {
        let unknowns = network.diagonal().iter().filter(|d| **d > 0.0).count();
        let factor = if factor_bytes(unknowns) <= options.memory { Cholesky::new(network) } else { None };
        match factor {
            Some(factor) => Inverse::Factor(Box::new(factor), vec![]),
            None => Inverse::Cycle(Multigrid::new(network)),
        }
    }

    /// The same for a network that differs little from the one that was factorised.
    fn renew(&mut self, network: &Network) {
        match self {
            Inverse::Factor(factor, added) => {
                let diagonal = network.diagonal();
                let mut is_new: Vec<bool> = diagonal.iter().map(|d| *d > 0.0).collect();
                factor.cells().for_each(|cell| is_new[cell] = false);
                let cells = (0..diagonal.len()).filter(|cell| is_new[*cell]);
                *added = cells.map(|cell| (cell, diagonal[cell].recip())).collect();
            }
            Inverse::Cycle(multigrid) => *multigrid = Multigrid::new(network),
        }
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        match self {
            Inverse::Factor(factor, added) => {
                factor.solve(r, z);
                added.iter().for_each(|(cell, inverse)| z[*cell] = inverse * r[*cell]);
            }
            Inverse::Cycle(multigrid) => multigrid.cycle(r, z),
        }
    }

    /// The power has converged if it changes by less than this fraction over this number of iterations.
    fn settled(&self) -> (f64, usize) {
        match self {
            Inverse::Factor(..) => (1e-12, 1),
            Inverse::Cycle(_) => (1e-8, 10),
        }
    }
}

/// What a flow leaves for the next one through a gap that differs little: its solution, and the factorisation that it used.
#[derive(Default)]
pub(crate) struct Previous {
    pub(super) x: Vec<f64>,
    inverse: Option<Inverse>,
}

/// Iterations with an old factorisation after which a new one is made.
const WORN: usize = 12;

impl Previous {
    /// The next flow depends on nothing before.
    pub(crate) fn forget(&mut self) {
        self.x.clear();
        self.inverse = None;
    }

    /// Solves A x = b by [`solve`] from the last x on.
    pub(super) fn solve(
        &mut self,
        network: &Network,
        b: &[f64],
        power: &dyn Fn(&[f64]) -> f64,
        options: &FlowOptions,
    ) -> Result<(f64, usize)> {
        self.x.resize(b.len(), 0.0);
        if let Some(inverse) = &mut self.inverse {
            inverse.renew(network);
            let few = FlowOptions { max_iterations: WORN.min(options.max_iterations), ..*options };
            let limits = if matches!(inverse, Inverse::Cycle(_)) { options } else { &few };
            match solve(network, inverse, b, &mut self.x, power, limits) {
                Err(Error::NotConverged(_)) => {}
                solved => return solved,
            }
        }
        let inverse = self.inverse.insert(Inverse::new(network, options));
        solve(network, inverse, b, &mut self.x, power, options)
    }
}

/// Solves A x = b, starting from the given x. `power` computes the dissipation of the flow of an x, in any unit. Returns the
/// power and the number of iterations.
///
/// Flexible conjugate gradients (Polak-Ribiere) are used because a multigrid cycle is not exactly linear. The residual is
/// computed again each time, because updated residuals drift if conductances span many decades.
pub(super) fn solve(
    network: &Network,
    inverse: &mut Inverse,
    b: &[f64],
    x: &mut [f64],
    power: &dyn Fn(&[f64]) -> f64,
    options: &FlowOptions,
) -> Result<(f64, usize)> {
    let cells = x.len();
    let [mut r, mut old, mut z, mut p, mut q] = std::array::from_fn(|_| vec![0.0; cells]);
    network.residual(b, x, &mut r);
    let (share, window) = inverse.settled();
    let mut powers = vec![power(x)];
    let mut rho = 0.0;
    for iteration in 1..=options.max_iterations {
        inverse.apply(&r, &mut z);
        let new = dot(&r, &z);
        let beta = if rho > 0.0 { (new - dot(&old, &z)) / rho } else { 0.0 };
        let beta = if beta.is_finite() { beta.max(0.0) } else { 0.0 };
        each(&mut p, &z[..], |p, z| *p = z + beta * *p);
        network.apply(&p, &mut q);
        let curvature = dot(&p, &q);
        if !(new > 0.0 && curvature > 0.0) {
            return Ok((powers[powers.len() - 1], iteration)); // the residual is 0
        }
        let before = x.to_vec();
        add(x, dot(&r, &p) / curvature, &p);
        rho = new;
        std::mem::swap(&mut old, &mut r);
        network.residual(b, x, &mut r);
        let now = power(x);
        let last = powers[powers.len() - 1];
        // The power decreases in every exact step: if it rises, only rounding is left.
        if now > last && iteration > 1 {
            x.copy_from_slice(&before);
            return Ok((last, iteration));
        }
        powers.push(now);
        let past = powers.len().checked_sub(1 + window).map(|k| powers[k]);
        if iteration > 1 && past.is_some_and(|past| (past - now).abs() <= share * now) {
            return Ok((now, iteration));
        }
    }
    Err(NotConverged::of(
        "the flow through the gap",
        options.max_iterations,
        (dot(&r, &r) / dot(b, b)).sqrt(),
        share,
    )
    .into())
}
