//! The operators of one velocity: A, its approximate inverse, and the symmetric operator M of the metric step.
//!
//! On a periodic domain A^ = K^(q) C~(q.v) is known. On a free one A is made of influence coefficients on a torus of at least
//! twice the domain ([`coefficients`](super::coefficients)). What the torus holds beyond the domain does not count, but M needs
//! Re A^ > 0 there, and 1/A^ is the better an inverse the more the torus is like the endless body. Where the memory reaches
//! far, v λ beyond the domain, the torus is made longer along the motion, up to a bound; what is left of Re A^ <= 0 then is
//! replaced by K^ Re C~ in M and in the inverse. A itself is exact on every torus.

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndarray::Array2;
use rustfft::num_complex::Complex64;

use super::coefficients::{self, OnTorus};
use crate::contact::Solver;
use crate::contact::stop_at;
use crate::convolution::Convolution;
use crate::convolution::torus::{Spectrum, Torus};
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::operator::Convolved;
use crate::simulation::Simulation;
use crate::sliding::metric::{MetricKernel, metric};
use crate::sliding::{Direction, Streaming};

/// The torus of a free domain along the motion over the shortest one, at most, and the memory that makes it longer at most \[bytes\].
const LONGEST: usize = 16;
const TORUS_BYTES: usize = 1 << 30;
/// The same where A is hard to invert, at least.
const LONG: usize = 8;

/// A body that streams by, and how fast.
#[derive(Clone, Copy)]
pub(super) struct Stream<'a> {
    pub(super) simulation: &'a Simulation,
    pub(super) streaming: &'a Streaming,
    pub(super) direction: Direction,
    /// \[m/s\]
    pub(super) velocity: f64,
}

/// A and what goes with it, over the relaxed compliance.
pub(super) struct Operators {
    torus: Torus,
    steady: Spectrum,
    inverse: Spectrum,
    /// M.
    pub(super) metric: Box<Convolved>,
    /// The kernel of the loss of a free domain, for [`Stream::loss`].
    pub(super) loss: Option<Array2<f64>>,
}

impl Operators {
    /// Of one velocity; `long` takes a torus on which the inverse is good.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::error::Error::Interrupted).
    pub(super) fn plan(stream: &Stream, long: bool, interrupt: Option<&AtomicBool>) -> Result<Self> {
        let Simulation { grid, boundary, kernel, .. } = stream.simulation;
        let (torus, steady, loss) = match boundary {
            Boundary::Periodic => {
                let torus = Torus::new(grid.cells(), grid.cells());
                let steady = stream.periodic(&torus);
                (torus, steady, None)
            }
            Boundary::Free => {
                let (torus, OnTorus { steady, loss }) = stream.free(long, interrupt)?;
                (torus, steady, Some(loss))
            }
        };
        stop_at(interrupt)?;
        let positive = stream.positive(&torus, &steady);
        let reciprocal = |a: &Complex64| if a.norm_sqr() > 0.0 { a.inv() } else { Complex64::ZERO };
        let metric_kernel = MetricKernel {
            elastic: kernel.clone(),
            streaming: stream.streaming.clone(),
            velocity: stream.velocities(),
            unit: stream.streaming.relaxed(),
        };
        Ok(Operators {
            inverse: Spectrum(positive.0.iter().map(reciprocal).collect()),
            metric: metric(*grid, *boundary, &positive, torus.lengths(), Arc::new(metric_kernel)),
            torus,
            steady,
            loss,
        })
    }

    /// u = A p.
    pub(super) fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.torus.apply_into(&self.steady, p, u);
    }

    /// p, roughly the pressure with A p = u.
    pub(super) fn invert_into(&mut self, u: &[f64], p: &mut [f64]) {
        self.torus.apply_into(&self.inverse, u, p);
    }

    /// Bytes that the operators and a solver of M take at most.
    pub(super) fn bytes(simulation: &Simulation, direction: Direction) -> usize {
        let Simulation { grid, boundary, solver, .. } = simulation;
        let torus = match boundary {
            Boundary::Periodic => torus_bytes(grid, grid.cells()),
            Boundary::Free => {
                let mut lengths = shortest(grid);
                while let Some(longer) = lengthened(grid, lengths, direction) {
                    lengths = longer;
                }
                torus_bytes(grid, lengths)
            }
        };
        torus + Solver::bytes(solver.method, grid, *boundary)
    }
}

/// Two transforms, four spectra while they are planned, M, and both kernels of a free domain.
fn torus_bytes(grid: &Grid, [mx, my]: [usize; 2]) -> usize {
    let half = my / 2 + 1;
    32 * grid.cells()[0] * half
        + 64 * mx * half
        + Convolution::bytes(grid.cells(), [mx, my], 1)
        + 8 * mx * my
        + 16 * (mx + 1) * half
}

/// Lengths of the shortest torus of a free domain.
fn shortest(grid: &Grid) -> [usize; 2] {
    let even = |cells: usize| 2 * Convolution::good_length(cells);
    let [nx, ny] = grid.cells();
    [even(nx), if grid.is_line() { 1 } else { even(ny) }]
}

/// Twice as long along the motion, where that is allowed.
fn lengthened(grid: &Grid, mut lengths: [usize; 2], direction: Direction) -> Option<[usize; 2]> {
    let axis = direction.axis();
    lengths[axis] *= 2;
    let allowed =
        lengths[axis] <= LONGEST * shortest(grid)[axis] && torus_bytes(grid, lengths) <= TORUS_BYTES;
    allowed.then_some(lengths)
}

impl Stream<'_> {
    /// Velocity along x and y.
    fn velocities(&self) -> [f64; 2] {
        self.direction.unit().map(|c| c * self.velocity)
    }

    /// A on a periodic domain, from its symbol.
    fn periodic(&self, torus: &Torus) -> Spectrum {
        let Simulation { grid, kernel, .. } = self.simulation;
        let (unit, along, fundamental) =
            (self.streaming.relaxed(), self.velocities(), fundamental(grid, grid.size()));
        let q = |k: i64, axis: usize| k as f64 * fundamental[axis];
        // A wave of two cells is the mean of its two directions.
        let signs = |k: i64, axis: usize| if alternates(grid, k, axis) { [1, -1] } else { [1, 1] };
        torus.spectrum(|kx, ky| {
            if (kx, ky) == (0, 0) {
                return (kernel.uniform().unwrap_or(0.0) * self.streaming.at(0.0) / unit).re.into();
            }
            let mut compliance = Complex64::ZERO;
            for sx in signs(kx, 0) {
                for sy in signs(ky, 1) {
                    let omega = along[0] * q(sx * kx, 0) + along[1] * q(sy * ky, 1);
                    compliance += 0.25 * self.streaming.at(omega);
                }
            }
            compliance * kernel.symbol(q(kx, 0).abs(), q(ky, 1).abs()) / unit
        })
    }

    /// A on a free domain, on the shortest torus on which its real part is positive, or the longest that is allowed.
    fn free(&self, long: bool, interrupt: Option<&AtomicBool>) -> Result<(Torus, OnTorus)> {
        let (grid, axis) = (&self.simulation.grid, self.direction.axis());
        let mut lengths = shortest(grid);
        let enough = lengths[axis] * if long { LONG } else { 1 };
        loop {
            let longer = lengthened(grid, lengths, self.direction);
            if lengths[axis] >= enough || longer.is_none() {
                let found = coefficients::on_torus(self, lengths, shortest(grid), interrupt)?;
                if longer.is_none() || found.steady.0.iter().all(|a| a.re > 0.0) {
                    return Ok((Torus::new(grid.cells(), lengths), found));
                }
            }
            lengths = longer.unwrap_or(lengths);
        }
    }

    /// The spectrum of A; where its real part is not positive, that is raised to K^ Re C~.
    fn positive<'s>(&self, torus: &Torus, spectrum: &'s Spectrum) -> Cow<'s, Spectrum> {
        let Simulation { grid, boundary, kernel, .. } = self.simulation;
        if *boundary == Boundary::Periodic || spectrum.0.iter().all(|a| a.re > 0.0) {
            return Cow::Borrowed(spectrum);
        }
        let (along, unit) = (self.velocities(), self.streaming.relaxed());
        let size = [0, 1].map(|axis| torus.lengths()[axis] as f64 * grid.spacing()[axis]);
        let fundamental = fundamental(grid, size);
        let endless = torus.spectrum(|kx, ky| {
            if (kx, ky) == (0, 0) {
                return Complex64::ZERO;
            }
            let [qx, qy] = [kx as f64 * fundamental[0], ky as f64 * fundamental[1]];
            let compliance = self.streaming.at(along[0] * qx + along[1] * qy).re / unit;
            (kernel.symbol(qx.abs(), qy.abs()) * compliance).into()
        });
        let raised = |(a, least): (&Complex64, &Complex64)| Complex64::new(a.re.max(least.re), a.im);
        Cow::Owned(Spectrum(spectrum.0.iter().zip(&endless.0).map(raised).collect()))
    }

    /// What is lost per distance in the bodies \[N\]: Σ (q.s) Im A |p^|² on a periodic domain, on a free one the quadratic form of the
    /// kernel of its operators. It is not negative.
    pub(super) fn loss(&self, pressure: &[f64], kernel: Option<&Array2<f64>>) -> f64 {
        let (grid, unit) = (&self.simulation.grid, self.streaming.relaxed());
        let (mut torus, spectrum) = match kernel {
            Some(kernel) => on_shortest(grid, kernel),
            None => self.loss_of_waves(),
        };
        unit * torus.energy(&spectrum, pressure) * grid.cell_area()
    }

    /// (q.s) Im A of a periodic domain.
    fn loss_of_waves(&self) -> (Torus, Spectrum) {
        let Simulation { grid, kernel, .. } = self.simulation;
        let torus = Torus::new(grid.cells(), grid.cells());
        let (direction, fundamental) = (self.direction.unit(), fundamental(grid, grid.size()));
        let spectrum = torus.spectrum(|kx, ky| {
            let q = |k: i64, axis: usize| k as f64 * fundamental[axis];
            let slope = |k: i64, axis: usize| if alternates(grid, k, axis) { 0.0 } else { q(k, axis) };
            let along = direction[0] * slope(kx, 0) + direction[1] * slope(ky, 1);
            if along == 0.0 {
                return Complex64::ZERO;
            }
            let compliance = self.streaming.at(along * self.velocity).im / self.streaming.relaxed();
            (along * kernel.symbol(q(kx, 0).abs(), q(ky, 1).abs()) * compliance).into()
        });
        (torus, spectrum)
    }
}

/// An even kernel, given for cells that are (i, j) apart, on the shortest torus.
fn on_shortest(grid: &Grid, kernel: &Array2<f64>) -> (Torus, Spectrum) {
    let [mx, my] = shortest(grid);
    let apart = |n: usize, m: usize| n.min(m - n);
    let all: Vec<f64> = (0..mx * my)
        .map(|n| kernel.get((apart(n / my, mx), apart(n % my, my))).copied().unwrap_or(0.0))
        .collect();
    (Torus::new(grid.cells(), [mx, my]), Torus::new([mx, my], [mx, my]).transform(&all))
}

/// The wave numbers of the longest waves along x and y of a period; 0 across a line.
fn fundamental(grid: &Grid, period: [f64; 2]) -> [f64; 2] {
    [TAU / period[0], if grid.is_line() { 0.0 } else { TAU / period[1] }]
}

/// Whether the k-th wave along an axis of a periodic domain is two cells long.
fn alternates(grid: &Grid, k: i64, axis: usize) -> bool {
    2 * k.unsigned_abs() as usize == grid.cells()[axis]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use crate::material::{Creep, CreepTerm};

    /// A body of a hundred times the compliance at once, and one term of time 1.
    fn simulation(grid: Grid) -> Simulation {
        let terms = vec![CreepTerm { compliance: 0.99, retardation_time: 1.0 }];
        let creep = Creep { instantaneous: 0.01, terms, fluidity: 0.0 };
        Simulation { creep, ..Simulation::new(grid, Array2::zeros(grid.shape())) }
    }

    #[test]
    fn a_longer_torus_is_the_same_operator_on_the_domain() {
        for (grid, direction) in [
            (Grid::line(33, 1.0).unwrap(), Direction::X),
            (Grid::new([20, 9], [2.0, 1.0]).unwrap(), Direction::X),
            (Grid::new([9, 20], [1.0, 2.0]).unwrap(), Direction::Y),
        ] {
            let simulation = simulation(grid);
            let streaming = Streaming::new(&simulation).unwrap();
            for velocity in [0.0, 0.1, 3.0, 100.0] {
                let stream = Stream { simulation: &simulation, streaming: &streaming, direction, velocity };
                let mut p: Vec<f64> = (0..grid.len()).map(|n| (n * 37 % 11) as f64).collect();
                let mean = p.iter().sum::<f64>() / p.len() as f64;
                p.iter_mut().for_each(|p| *p -= mean);
                let [short, long] = [1, LONGEST].map(|times| {
                    let mut lengths = shortest(&grid);
                    lengths[direction.axis()] *= times;
                    let OnTorus { steady: spectrum, .. } =
                        coefficients::on_torus(&stream, lengths, shortest(&grid), None).unwrap();
                    let mut u = vec![0.0; p.len()];
                    Torus::new(grid.cells(), lengths).apply_into(&spectrum, &p, &mut u);
                    u
                });
                let largest = short.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
                // A pressure without a mean does not see the constant of a line contact; the rest are roundings of transforms.
                let apart = short.iter().zip(&long).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(apart < 1e-12 * largest, "{direction:?} {velocity}: {apart:e} of {largest:e}");
            }
        }
    }

    #[test]
    fn planning_is_interrupted_and_the_torus_is_bounded() {
        let grid = Grid::new([16, 16], [1.0, 1.0]).unwrap();
        let simulation = simulation(grid);
        let streaming = Streaming::new(&simulation).unwrap();
        let of = |velocity| Stream {
            simulation: &simulation,
            streaming: &streaming,
            direction: Direction::X,
            velocity,
        };
        let stopped = Operators::plan(&of(1.0), false, Some(&AtomicBool::new(true)));
        assert!(matches!(stopped, Err(Error::Interrupted)));
        for decade in -6..=9 {
            let operators = Operators::plan(&of(10f64.powi(decade)), false, None).unwrap();
            let [mx, my] = operators.torus.lengths();
            assert!(mx <= LONGEST * 32 && my == 32, "{decade}: {mx} x {my}");
        }
        let wide = Grid::new([4096, 4096], [1.0, 1.0]).unwrap();
        assert_eq!(lengthened(&wide, shortest(&wide), Direction::X), None);
    }
}
