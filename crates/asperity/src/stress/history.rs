//! The pressure history of a body whose Poisson's ratio changes with time, in the form that the stress needs.
//!
//! The stress of an elastic body is S0 p + nu S1 p. By the correspondence principle a viscoelastic one has
//!
//! ```text
//! sigma(t) = S0 p(t) + S1 P(t),   P(t) = int nu(t - s) dp(s)
//! ```
//!
//! (E. H. Lee & J. R. M. Radok 1960). Between two known states the pressures relax and redistribute as they do in a step of the march
//! (`history::Retarded`): exact under a held approach, else of second order in the time step. The uniform part of a periodic pressure acts
//! without lateral strain, so it has nu/(1 - nu) in place of nu ([`PoissonCreep`]).

use crate::error::{Error, Result, require};
use crate::grid::Grid;
use crate::history::Retarded;
use crate::load::Control;
use crate::material::{Creep, PoissonCreep};

/// Stores the pressure history of a body from the beginning on, for
/// [`SubsurfaceStress::set_history`](super::SubsurfaceStress::set_history).
///
/// ```
/// use asperity::{Grid, load::Control, material::{Body, Lateral, Material, Modulus}, stress::PressureHistory};
/// let material = Material::zener(Modulus::Shear, 1e9, 1e9, 2.0)?;
/// let body = Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(5e9), hardness: None };
/// let grid = Grid::new([1, 1], [1.0, 1.0])?;
/// let mut history = PressureHistory::new(&body.poisson_creep()?, &body.contact_creep()?, grid)?;
/// history.advance(0.0, Control::Load, &[1e6])?;
/// history.advance(1e3, Control::Load, &[1e6])?;
/// // In the end Poisson's ratio is that of G = 0.5 GPa.
/// assert!((history.transverse()[0] - 14.0 / 31.0 * 1e6).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct PressureHistory {
    /// Time of the pressure \[s\]; `None` before the first.
    time: Option<f64>,
    cells: Retarded,
    /// Of the mean pressure.
    mean: Retarded,
}

impl PressureHistory {
    /// Starts without pressure, on the cells of `grid`, for a body with these functions in a pair with the contact creep compliance
    /// `contact` \[1/Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] where `contact` is that of a rigid pair.
    pub fn new(creep: &PoissonCreep, contact: &Creep, grid: Grid) -> Result<Self> {
        let whole = Grid::new([1, 1], [1.0; 2])?;
        Ok(PressureHistory {
            time: None,
            cells: Retarded::new(&creep.ratio, contact, grid)?,
            mean: Retarded::new(&creep.confined, contact, whole)?,
        })
    }

    /// Its size in bytes.
    pub fn bytes(creep: &PoissonCreep, contact: &Creep, grid: &Grid) -> usize {
        8 * grid.len() * Retarded::fields(&creep.ratio, contact)
    }

    /// Adds the pressure p \[Pa\] at the time t \[s\], which must not be before the last one, and what was prescribed in the step to
    /// it. A second pressure at the same time is a jump. The first pressure is applied suddenly.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a time before the last, another number of pressures, or a pressure that is not finite.
    pub fn advance(&mut self, time: f64, control: Control, p: &[f64]) -> Result<()> {
        let last = self.time.unwrap_or(time);
        require(time >= last, "time", format!("{time} s"), format!("not before the last, {last} s"))?;
        check_pressure(p, self.pressure().len())?;
        self.cells.advance(time, time - last, control, p)?;
        self.mean.advance(time, time - last, control, &[mean(p)])?;
        self.time = Some(time);
        Ok(())
    }

    /// The present pressure p \[Pa\].
    pub fn pressure(&self) -> &[f64] {
        self.cells.pressure()
    }

    /// P = int nu(t - s) dp(s) in each cell \[Pa\].
    pub fn transverse(&self) -> Vec<f64> {
        self.cells.value()
    }

    /// The lateral pressure under the mean of p without lateral strain, int k(t - s) d(mean p)(s) \[Pa\].
    pub fn confined(&self) -> f64 {
        mean(&self.mean.value())
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

    fn history(body: &Body, grid: Grid) -> PressureHistory {
        PressureHistory::new(&body.poisson_creep().unwrap(), &body.contact_creep().unwrap(), grid).unwrap()
    }

    fn cells(n: usize) -> Grid {
        Grid::new([n, 1], [n as f64, 1.0]).unwrap()
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
        let mut history = history(&body(), grid);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.0).unwrap();
        for (time, nu, expected) in STEP {
            history.advance(time, Control::Load, &vec![1.0; n * n]).unwrap();
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
        let mut history = history(&body, grid);
        for time in [0.0, 1.0, 2.5] {
            history.advance(time, Control::Load, &p).unwrap();
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
        let mut history = history(&body(), grid);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Periodic, 0.0).unwrap();
        for (time, shear) in [(0.0, 4.0), (1e3, 1.0)] {
            history.advance(time, Control::Load, &[2.0; 16]).unwrap();
            stress.set_history(&history).unwrap();
            let mut six = std::array::from_fn(|_| vec![]);
            stress.at(0.3, &mut six).unwrap();
            let lateral = -2.0 * (6.0 - 2.0 * shear) / (6.0 + 4.0 * shear);
            assert!((six[0][3] - lateral).abs() < 1e-12 && (six[1][3] - lateral).abs() < 1e-12, "{six:?}");
            assert!((six[2][3] + 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_ramp_of_the_load_is_exact_and_any_path_of_second_order() {
        // p = t: P = the integral of nu, in any steps.
        let ratio = body().poisson_creep().unwrap().ratio;
        let mut ramp = history(&body(), cells(1));
        for time in [0.0, 0.1, 0.4, 2.0] {
            ramp.advance(time, Control::Load, &[time]).unwrap();
        }
        assert!((ramp.transverse()[0] - ratio.integral(2.0)).abs() < 1e-12);
        // p = sin t over 2 s against 4096 steps.
        let of = |steps: u32| {
            let mut sine = history(&body(), cells(1));
            for k in 0..=steps {
                let time = 2.0 * f64::from(k) / f64::from(steps);
                sine.advance(time, Control::Load, &[time.sin()]).unwrap();
            }
            sine.transverse()[0]
        };
        let exact = of(4096);
        let (coarse, fine) = ((of(16) - exact).abs(), (of(32) - exact).abs());
        assert!(coarse / fine > 3.8 && coarse / fine < 4.2, "{coarse:e} {fine:e}");
    }

    /// int f(t - s) dp(s) up to `end` of p(0+) = 1 that then goes as `p`, by the midpoint rule on a grid of the squares of equal steps.
    fn quadrature(f: &Creep, end: f64, p: impl Fn(f64) -> f64) -> f64 {
        let parts = 20_000;
        let at = |n: usize| end * (n as f64 / parts as f64).powi(2);
        let steps = (0..parts).map(|n| (at(n), at(n + 1)));
        let rest: f64 = steps.map(|(a, b)| f.value(end - 0.5 * (a + b)) * (p(b) - p(a))).sum();
        f.value(end) + rest
    }

    #[test]
    fn a_held_approach_is_exact_in_one_step_or_many() {
        // The pressure relaxes as E*(t)/E*(0), the relaxation function of the contact.
        let creep = body().poisson_creep().unwrap();
        let relaxation = body().contact_creep().unwrap().to_relaxation().unwrap();
        let pressure = |t: f64| relaxation.value(t) / relaxation.instantaneous();
        for times in [vec![5.0], vec![0.7, 0.9, 5.0], (1..=50).map(|n| 0.1 * f64::from(n)).collect()] {
            let mut held = history(&body(), cells(2));
            held.advance(0.0, Control::Approach, &[1.0, 0.5]).unwrap();
            for time in times {
                held.advance(time, Control::Approach, &[pressure(time), 0.5 * pressure(time)]).unwrap();
            }
            let exact = quadrature(&creep.ratio, 5.0, pressure);
            let found = held.transverse();
            // The midpoint rule, 1e-9.
            assert!(
                (found[0] - exact).abs() < 1e-8 && (found[1] - 0.5 * exact).abs() < 1e-8,
                "{found:?} {exact}"
            );
            let confined = 0.75 * quadrature(&creep.confined, 5.0, pressure);
            assert!((held.confined() - confined).abs() < 1e-8, "{} {confined}", held.confined());
        }
    }

    #[test]
    fn a_time_without_pressure_is_one_step() {
        // Pressure 1 from 0 to 1 s: P = nu(t) - nu(t - 1 s) afterwards.
        let ratio = body().poisson_creep().unwrap().ratio;
        let mut pulse = history(&body(), cells(1));
        for (time, p) in [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (2.5, 0.0), (4.0, 0.0)] {
            pulse.advance(time, Control::Load, &[p]).unwrap();
            if p == 0.0 {
                let exact = ratio.value(time) - ratio.value(time - 1.0);
                let found = pulse.transverse()[0];
                assert!((found - exact).abs() < 1e-12, "{time}: {found} {exact}");
            }
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let mut refused = history(&body(), cells(2));
        let mut advance = |time, p: &[f64]| refused.advance(time, Control::Load, p);
        advance(1.0, &[0.0; 2]).unwrap();
        assert!(advance(0.5, &[0.0; 2]).is_err() && advance(f64::NAN, &[0.0; 2]).is_err());
        assert!(advance(2.0, &[0.0; 3]).is_err() && advance(2.0, &[0.0, f64::NAN]).is_err());
    }
}
