//! The pressure history of a body whose Poisson's ratio changes with time, in the form that the stress needs.
//!
//! The stress of an elastic body is S0 p + nu S1 p. By the correspondence principle a viscoelastic one has
//!
//! ```text
//! sigma(t) = S0 p(t) + S1 P(t),   P(t) = int nu(t - s) dp(s) = nu(0) p + sum_j nu_j r_j,   r_j = int (1 - exp(-(t - s)/lambda_j)) dp(s)
//! ```
//!
//! (E. H. Lee & J. R. M. Radok 1960). The pressure is linear between two known states, which gives r_j' = E r_j + (phi - E) p +
//! (1 - phi) p' with E = exp(-x), phi = (1 - E)/x, x = dt/lambda_j; of second order in the time step. The uniform part of a
//! periodic pressure acts without lateral strain, so it has nu/(1 - nu) in place of nu ([`PoissonCreep`]).

use crate::error::{Error, Result, require};
use crate::material::{Creep, CreepTerm, PoissonCreep};

/// Stores the pressure history of a body from the beginning on, for
/// [`SubsurfaceStress::set_history`](super::SubsurfaceStress::set_history).
///
/// ```
/// use asperity::material::{Body, Lateral, Material, Modulus};
/// use asperity::stress::PressureHistory;
/// let material = Material::zener(Modulus::Shear, 1e9, 1e9, 2.0)?;
/// let body = Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(5e9), hardness: None };
/// let mut history = PressureHistory::new(body.poisson_creep()?, 1);
/// history.advance(0.0, &[1e6])?;
/// history.advance(1e3, &[1e6])?;
/// // In the end Poisson's ratio is that of G = 0.5 GPa.
/// assert!((history.transverse()[0] - 14.0 / 31.0 * 1e6).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct PressureHistory {
    creep: PoissonCreep,
    /// Time of the pressure \[s\]; `None` before the first.
    time: Option<f64>,
    pressure: Vec<f64>,
    /// r_j of each term of nu(t).
    retarded: Vec<Vec<f64>>,
    /// The same for the mean pressure, for each term of k(t).
    retarded_mean: Vec<f64>,
}

impl PressureHistory {
    /// Starts without pressure, for fields of `cells` cells.
    pub fn new(creep: PoissonCreep, cells: usize) -> Self {
        PressureHistory {
            time: None,
            pressure: vec![0.0; cells],
            retarded: vec![vec![0.0; cells]; creep.ratio.terms.len()],
            retarded_mean: vec![0.0; creep.confined.terms.len()],
            creep,
        }
    }

    /// Its size in bytes.
    pub fn bytes(creep: &PoissonCreep, cells: usize) -> usize {
        8 * cells * (1 + creep.ratio.terms.len())
    }

    /// Adds the pressure p \[Pa\] at the time t \[s\], which must not be before the last one. A second pressure at the same time
    /// is a jump. The first pressure is applied suddenly.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a time before the last, another number of pressures, or a pressure that is not finite.
    pub fn advance(&mut self, time: f64, p: &[f64]) -> Result<()> {
        let last = self.time.unwrap_or(time);
        require(time >= last, "time", format!("{time} s"), format!("not before the last, {last} s"))?;

        check_pressure(p, self.pressure.len())?;
        let dt = time - last;
        let [mean, new_mean] = [mean(&self.pressure), mean(p)];
        for (r, term) in self.retarded_mean.iter_mut().zip(&self.creep.confined.terms) {
            let [keep, before, after] = weights(term, dt);
            *r = keep * *r + before * mean + after * new_mean;
        }
        for (r, term) in self.retarded.iter_mut().zip(&self.creep.ratio.terms) {
            let [keep, before, after] = weights(term, dt);
            for ((r, old), new) in r.iter_mut().zip(&self.pressure).zip(p) {
                *r = keep * *r + before * old + after * new;
            }
        }
        self.pressure.copy_from_slice(p);
        self.time = Some(time);
        Ok(())
    }

    /// The present pressure p \[Pa\].
    pub fn pressure(&self) -> &[f64] {
        &self.pressure
    }

    /// P = int nu(t - s) dp(s) in each cell \[Pa\].
    pub fn transverse(&self) -> Vec<f64> {
        let Creep { instantaneous, terms, .. } = &self.creep.ratio;
        let mut sum: Vec<f64> = self.pressure.iter().map(|p| instantaneous * p).collect();
        for (r, term) in self.retarded.iter().zip(terms) {
            sum.iter_mut().zip(r).for_each(|(sum, r)| *sum += term.compliance * r);
        }
        sum
    }

    /// The lateral pressure under the mean of p without lateral strain, int k(t - s) d(mean p)(s) \[Pa\].
    pub fn confined(&self) -> f64 {
        let Creep { instantaneous, terms, .. } = &self.creep.confined;
        let retarded: f64 = self.retarded_mean.iter().zip(terms).map(|(r, term)| term.compliance * r).sum();
        instantaneous * mean(&self.pressure) + retarded
    }
}

/// Checks that there is a finite pressure for each cell.
pub(super) fn check_pressure(p: &[f64], cells: usize) -> Result<()> {
    require(p.len() == cells, "number of pressures", p.len(), format!("{cells}, one for each cell"))?;
    match p.iter().find(|p| !p.is_finite()) {
        Some(p) => Err(Error::invalid("pressure", format!("{p} Pa"), "finite in every cell")),
        None => Ok(()),
    }
}

/// Mean of a field.
pub(super) fn mean(field: &[f64]) -> f64 {
    field.iter().sum::<f64>() / field.len().max(1) as f64
}

/// E, phi - E and 1 - phi of a step.
fn weights(term: &CreepTerm, dt: f64) -> [f64; 3] {
    let x = dt / term.retardation_time;
    if x == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (keep, phi) = (libm::exp(-x), -libm::expm1(-x) / x);
    [keep, phi - keep, 1.0 - phi]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Boundary, Grid};
    use crate::material::{Body, Lateral, Material, Modulus, Relaxation, RelaxationTerm};
    use crate::stress::{Component, SubsurfaceStress};

    /// G(t) = 1 + 3 exp(-t/1.5), B = 2.
    fn body() -> Body {
        let terms = vec![RelaxationTerm { modulus: 3.0, relaxation_time: 1.5 }];
        let relaxation = Relaxation { equilibrium: 1.0, terms, viscosity: 0.0 };
        let material = Material::prony(Modulus::Shear, relaxation).unwrap();
        Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(2.0), hardness: None }
    }

    /// t, nu(t), and s_xx, s_yy, s_xy at (0.3, 0.2, 0.4) under unit pressure on |x|, |y| <= 1 since t = 0: quadrature of the
    /// point load with nu(t) in closed form.
    const STEP: [(f64, f64, [f64; 3]); 4] = [
        (0.0, -0.1, [-0.09863873100808426, -0.10643677727120675, 0.00682065062231734]),
        (0.5, -0.019728832729901447, [-0.1499256572085411, -0.15781115219564304, 0.005002531279493583]),
        (5.0, 0.24831081239515784, [-0.3211817877201298, -0.3293592894854963, -0.0010684912310638028]),
        (50.0, 0.2857142856859243, [-0.3450796484283156, -0.35329789814992724, -0.0019156693722500715]),
    ];

    #[test]
    fn a_step_of_pressure_is_that_of_the_closed_form() {
        // Cells of 0.2/3 have their centres at odd multiples of 0.1/3 from the middle; x = 0.3 is the ninth.
        let n = 30;
        let grid = Grid::new([n, n], [2.0, 2.0]).unwrap();
        let place = |i: usize| grid.x(i) - 1.0;
        let near = |at: f64| (0..n).find(|i| (place(*i) - at).abs() < 1e-12);
        let (i, below) = (near(0.3).unwrap(), (0..n).filter(|j| place(*j) < 0.2).count() - 1);
        let mut history = PressureHistory::new(body().poisson_creep().unwrap(), n * n);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.0).unwrap();
        for (time, nu, expected) in STEP {
            history.advance(time, &vec![1.0; n * n]).unwrap();
            assert!((history.transverse()[7] - nu).abs() < 1e-12, "{time}");
            stress.set_history(&history).unwrap();
            for (component, expected) in
                [Component::Xx, Component::Yy, Component::Xy].into_iter().zip(expected)
            {
                let mut field = vec![0.0; n * n];
                stress.component_into(component, 0.4, &mut field).unwrap();
                // y = 0.2 lies on the border of two cells; the cubic through the four centres around it has an error of
                // the fourth power of a cell, 2e-5, times derivatives of order one.
                let row = |k: usize| field[i * n + below + k - 1];
                let found = (9.0 * (row(1) + row(2)) - row(0) - row(3)) / 16.0;
                assert!((found - expected).abs() < 3e-5, "{time} {component:?}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_constant_ratio_needs_no_history() {
        let grid = Grid::new([12, 9], [3.0, 2.0]).unwrap();
        let p: Vec<f64> = (0..grid.len()).map(|n| ((n * 37 % 11) as f64 - 3.0).max(0.0)).collect();
        let body = Body { lateral: Lateral::Poisson(0.3), ..body() };
        let mut history = PressureHistory::new(body.poisson_creep().unwrap(), grid.len());
        for time in [0.0, 1.0, 2.5] {
            history.advance(time, &p).unwrap();
        }
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let mut stress = SubsurfaceStress::new(grid, boundary, 0.3).unwrap();
            let [mut by_history, mut plain] = [0, 1].map(|_| vec![0.0; grid.len()]);
            for component in Component::ALL {
                stress.set_pressure(&p).unwrap();
                stress.component_into(component, 0.3, &mut plain).unwrap();
                stress.set_history(&history).unwrap();
                stress.component_into(component, 0.3, &mut by_history).unwrap();
                for (a, b) in plain.iter().zip(&by_history) {
                    // Rounding of pressures up to 7.
                    assert!((a - b).abs() < 1e-13, "{boundary:?} {component:?}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn a_uniform_periodic_pressure_is_confined() {
        // s_xx = s_yy = -(3 B - 2 G)/(3 B + 4 G) p with the instantaneous and the long-time moduli.
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let mut history = PressureHistory::new(body().poisson_creep().unwrap(), 16);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Periodic, 0.0).unwrap();
        for (time, shear) in [(0.0, 4.0), (1e3, 1.0)] {
            history.advance(time, &[2.0; 16]).unwrap();
            stress.set_history(&history).unwrap();
            let mut six = std::array::from_fn(|_| vec![]);
            stress.at(0.3, &mut six).unwrap();
            let lateral = -2.0 * (6.0 - 2.0 * shear) / (6.0 + 4.0 * shear);
            assert!((six[0][3] - lateral).abs() < 1e-12 && (six[1][3] - lateral).abs() < 1e-12, "{six:?}");
            assert!((six[2][3] + 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_ramp_is_exact_and_any_path_of_second_order() {
        let creep = body().poisson_creep().unwrap();
        // p = t: P = the integral of nu. The scheme is exact for it in any steps.
        let mut history = PressureHistory::new(creep.clone(), 1);
        for time in [0.0, 0.1, 0.4, 2.0] {
            history.advance(time, &[time]).unwrap();
        }
        assert!((history.transverse()[0] - creep.ratio.integral(2.0)).abs() < 1e-14);
        // p = sin t over 2 s against 4096 steps.
        let of = |steps: u32| {
            let mut history = PressureHistory::new(creep.clone(), 1);
            for k in 0..=steps {
                let time = 2.0 * f64::from(k) / f64::from(steps);
                history.advance(time, &[time.sin()]).unwrap();
            }
            history.transverse()[0]
        };
        let exact = of(4096);
        let (coarse, fine) = ((of(16) - exact).abs(), (of(32) - exact).abs());
        assert!(coarse / fine > 3.8 && coarse / fine < 4.2, "{coarse:e} {fine:e}");
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let mut history = PressureHistory::new(body().poisson_creep().unwrap(), 2);
        history.advance(1.0, &[0.0; 2]).unwrap();
        assert!(history.advance(0.5, &[0.0; 2]).is_err() && history.advance(f64::NAN, &[0.0; 2]).is_err());
        assert!(history.advance(2.0, &[0.0; 3]).is_err() && history.advance(2.0, &[0.0, f64::NAN]).is_err());
    }
}
