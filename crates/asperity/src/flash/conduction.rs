//! The temperature of the surface of one body under a field of heat.

use std::cmp::Ordering;
use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex64;

use super::Conductor;
use super::kernel::Source;
use crate::convolution::torus::{Spectrum, Torus};
use crate::grid::{Boundary, Grid};
use crate::kernel::gauss::GAUSS_4;
use crate::sliding::Direction;

/// Transforms of the heat on a domain.
pub(super) struct Conduction {
    grid: Grid,
    boundary: Boundary,
    direction: Direction,
    heated_for: Option<f64>,
    torus: Torus,
}

impl Conduction {
    pub(super) fn new(
        grid: &Grid,
        boundary: Boundary,
        direction: Direction,
        heated_for: Option<f64>,
    ) -> Self {
        let cells = grid.cells();
        let lengths = match boundary {
            Boundary::Periodic => cells,
            Boundary::Free => cells.map(|n| if n > 1 { 2 * n } else { 1 }),
        };
        Conduction { grid: *grid, boundary, direction, heated_for, torus: Torus::new(cells, lengths) }
    }

    /// T^/q^ of a body over which the heat moves with this velocity: on a periodic domain 1/(k √s), s = |q|² - i q.v/χ, and where it has been
    /// heated for a time t only, that times erf √(s χ t). Waves along the motion, which pass no place, take as long as the mean to become steady.
    pub(super) fn spectrum(&mut self, body: Conductor, velocity: f64) -> Spectrum {
        match self.boundary {
            Boundary::Periodic => self.of_waves(body, velocity),
            Boundary::Free => self.of_cells(body, velocity),
        }
    }

    /// Means over the cells of the temperature under a flux that is even in each cell.
    fn of_waves(&self, body: Conductor, velocity: f64) -> Spectrum {
        let Conductor { conductivity: k, diffusivity: chi } = body;
        let ([lx, ly], [cx, cy], [nx, ny]) = (self.grid.size(), self.direction.unit(), self.grid.cells());
        let (erf, time) = (ErrorFunction::new(), self.heated_for);
        // The mean of an even flux since the heating began.
        let mean = time.map_or(0.0, |time| 2.0 * (chi * time / PI).sqrt() / k);
        let wave = |qx: f64, qy: f64| {
            let rate = Complex64::new(qx * qx + qy * qy, -(cx * qx + cy * qy) * velocity / chi);
            let begun = time.map_or(Complex64::ONE, |time| erf.of_root(rate * (chi * time)));
            begun * rate.sqrt().inv() / k
        };
        let [along, across]: [Vec<_>; 2] =
            [(nx, lx), (ny, ly)].map(|(n, length)| (0..n).map(|k| aliases(k, n, length)).collect());
        self.torus.spectrum(|kx, ky| {
            if kx == 0 && ky == 0 {
                return Complex64::new(mean, 0.0);
            }
            let place = |k: i64, n: usize| k.rem_euclid(n as i64) as usize;
            let (xs, ys) = (&along[place(kx, nx)], &across[place(ky, ny)]);
            xs.iter().flat_map(|x| ys.iter().map(move |y| wave(x.0, y.0) * (x.1 * y.1))).sum()
        })
    }

    fn of_cells(&mut self, body: Conductor, velocity: f64) -> Spectrum {
        let Conductor { conductivity: k, diffusivity: chi } = body;
        let axis = self.direction.axis();
        let source = Source::new(&self.grid, axis, velocity.abs() / (2.0 * chi));
        let influence = source.influence();
        let ([mx, my], [along, across]) = (self.torus.lengths(), source.cells);
        let sign = if velocity < 0.0 { -1 } else { 1 };
        // From places on the torus to distances; the place in its middle stands for two and is not seen.
        let signed = |n: usize, m: usize| if 2 * n > m { n as i64 - m as i64 } else { n as i64 };
        let value = |n: usize| {
            let place = [signed(n / my, mx), signed(n % my, my)];
            let (i, j) = (sign * place[axis], place[1 - axis].unsigned_abs() as usize);
            let (i, j) = (i.clamp(1 - along as i64, along as i64 - 1), j.min(across - 1));
            influence[(i + along as i64 - 1) as usize * across + j] / k
        };
        let coefficients: Vec<f64> = (0..mx * my).map(value).collect();
        Torus::new([mx, my], [mx, my]).transform(&coefficients)
    }

    /// T of a field of heat.
    pub(super) fn apply_into(&mut self, spectrum: &Spectrum, heat: &[f64], to: &mut [f64]) {
        self.torus.apply_into(spectrum, heat, to);
    }
}

/// The wave numbers that cells take for wave k of n on a length, and the share of each in their means: q + 2πm/side with sin²(x)/x²,
/// x = q side/2 + πm, all in all 1. Those of |m| > 1 are a density in m, summed up in 1/m. The shortest wave is also its own opposite.
fn aliases(k: usize, n: usize, length: f64) -> Vec<(f64, f64)> {
    if k == 0 {
        return vec![(0.0, 1.0)];
    }
    let of = |k: f64| {
        let half = PI * k / n as f64;
        let share = |m: f64| (libm::sin(half) / (half + PI * m)).powi(2);
        let at = |m: f64| TAU * (k + m * n as f64) / length;
        let near = [-1.0, 0.0, 1.0].map(|m| (at(m), share(m)));
        let far = GAUSS_4.iter().flat_map(|(x, w)| {
            let m = 3.0 / (1.0 + x);
            [-m, m].map(|m| (at(m), w * share(m) * m * m))
        });
        let far: Vec<(f64, f64)> = far.collect();
        let [within, beyond] =
            [&near[..], &far].map(|waves| waves.iter().map(|(_, share)| share).sum::<f64>());
        let far = far.into_iter().map(move |(q, share)| (q, share * (1.0 - within) / beyond));
        near.into_iter().chain(far)
    };
    match (2 * k).cmp(&n) {
        Ordering::Less => of(k as f64).collect(),
        Ordering::Greater => of(k as f64 - n as f64).collect(),
        Ordering::Equal => of(k as f64).chain(of(-(k as f64))).map(|(q, share)| (q, 0.5 * share)).collect(),
    }
}

/// Terms of the series of [`ErrorFunction`].
const TERMS: usize = 32;

/// The error function of complex numbers with a real part that is not negative: erf z = 1 - exp(-z²) w(iz), with w by
/// J. A. C. Weideman, SIAM J. Numer. Anal. 31 (1994) 1497, to 1e-12.
struct ErrorFunction {
    scale: f64,
    series: [f64; TERMS],
}

impl ErrorFunction {
    fn new() -> Self {
        let scale = (TERMS as f64 / std::f64::consts::SQRT_2).sqrt();
        let count = 2 * TERMS as i32;
        let series = std::array::from_fn(|n| {
            let of = |k: i32| {
                let angle = f64::from(k) * PI / f64::from(count);
                let t = scale * libm::tan(0.5 * angle);
                libm::exp(-t * t) * (scale * scale + t * t) * libm::cos((n + 1) as f64 * angle)
            };
            (1 - count..count).map(of).sum::<f64>() / f64::from(2 * count)
        });
        ErrorFunction { scale, series }
    }

    /// erf √square.
    fn of_root(&self, square: Complex64) -> Complex64 {
        // Less than the error of the series.
        const FLAT: f64 = 30.0;
        if square.re > FLAT {
            return Complex64::ONE;
        }
        let z = square.sqrt();
        let (below, above) = (self.scale + z, self.scale - z);
        let ratio = above / below;
        let sum = self.series.iter().rev().fold(Complex64::ZERO, |sum, term| sum * ratio + term);
        let w = sum * 2.0 / (below * below) + PI.sqrt().recip() / below;
        Complex64::ONE - (-square).exp() * w
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_function_of_complex_numbers() {
        let erf = ErrorFunction::new();
        for x in [0.0, 0.1, 1.0, 3.0, 5.4, 5.5, 30.0] {
            assert!((erf.of_root((x * x).into()) - libm::erf(x)).norm() < 1e-12, "{x}");
        }
        // On the diagonal: the integrals of Fresnel, erf(√(i π/2) u) = √(2i) (C(u) - i S(u)); C(1), S(1) of Abramowitz & Stegun, table 7.8.
        let exact =
            Complex64::new(0.0, 2.0).sqrt() * Complex64::new(0.779_893_400_376_8, -0.438_259_147_390_4);
        assert!((erf.of_root(Complex64::new(0.0, PI / 2.0)) - exact).norm() < 1e-12);
    }
}
