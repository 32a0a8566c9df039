//! Adhesion: an attraction σ(g) between the surfaces that falls with the gap g.
//!
//! Each law is a potential γ(g) per area with γ(0) = -w, the work of adhesion, and σ = dγ/dg >= 0:
//!
//! | law | γ(g) | σ(g) | range |
//! |---|---|---|---|
//! | exponential | -w exp(-g/ρ) | (w/ρ) exp(-g/ρ) | ρ |
//! | Dugdale | -w + s g up to g = w/s, then 0 | s, then 0 | w/s |
//! | linear | -w + s g - s² g²/(4 w) up to g = 2 w/s, then 0 | s - s² g/(2 w), then 0 | w/s |
//! | van der Waals | -w (1 + g/ρ)⁻² | (2 w/ρ) (1 + g/ρ)⁻³ | ρ |
//!
//! All are concave for g >= 0, so each pass of the loop of [`super`], which replaces γ by its tangent, lowers the energy
//!
//! ```text
//! Π = 1/2 <t, c K t> + A Σ γ(g)      under a prescribed approach w;  less W w under a prescribed load W
//! ```
//!
//! and the state stays on the branch of equilibria that is connected with the step before: contacts jump in and pull off where their
//! branch ends.
//!
//! Sources: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243 (Dugdale); V. Rey, G. Anciaux & J.-F. Molinari, Comput. Mech. 60
//! (2017) 69 (exponential).

use super::{SurfaceTraction, TractionLaw};
use crate::error::{Error, Of, Result, positive, require};
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;
use crate::operator::plan;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use asperity_sweep::{each, sums};
use std::sync::Arc;

/// A cell snaps on its own above a trap number of 1; below this one the answer does not depend on the grid.
pub const FINE_TRAP: f64 = 0.5;
/// Larger works of adhesion \[J/m²\] are seldom meant.
const MOST_WORK: f64 = 10.0;
/// Above this number no run begins, unless it is allowed.
pub const LARGEST_TRAP: f64 = 1.0;

/// How the attraction falls with the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum AdhesionLaw {
    /// It falls exponentially; best on grids.
    #[default]
    Exponential,
    /// It is constant up to the range (Maugis); converges only in proportion to the cell.
    Dugdale,
    /// It falls linearly to 0.
    Linear,
    /// It falls with the third power of the gap, as between flat bodies that attract each other by van der Waals forces.
    VanDerWaals,
}

/// Adhesion between the surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adhesion {
    /// w \[J/m²\]; 0 for none.
    pub work: f64,
    /// How it falls.
    pub law: AdhesionLaw,
    /// ρ, or w/s of the laws `Dugdale` and `Linear` \[m\].
    pub range: f64,
    /// Whether a run begins though cells are so large that each of them snaps on its own.
    pub allow_unresolved: bool,
    /// Of the sum of |σ| over the cells, relative.
    pub tolerance: f64,
}

impl Adhesion {
    /// The default law with this work of adhesion \[J/m²\] and range \[m\].
    pub fn new(work: f64, range: f64) -> Self {
        Adhesion { work, law: AdhesionLaw::default(), range, allow_unresolved: false, tolerance: 1e-4 }
    }

    /// The largest attraction, σ(0) \[Pa\].
    pub fn strength(&self) -> f64 {
        match self.law {
            AdhesionLaw::VanDerWaals => 2.0 * self.work / self.range,
            _ => self.work / self.range,
        }
    }

    /// σ and γ at a gap \[Pa\], \[J/m²\].
    fn at(&self, g: f64) -> [f64; 2] {
        let (w, s, x) = (self.work, self.strength(), g / self.range);
        if x == f64::INFINITY {
            return [0.0; 2];
        }
        match self.law {
            AdhesionLaw::Exponential => {
                let left = libm::exp(-x);
                [s * left, -w * left]
            }
            AdhesionLaw::Dugdale if x <= 1.0 => [s, w * (x - 1.0)],
            AdhesionLaw::Linear if x <= 2.0 => [s * (1.0 - 0.5 * x), -w * (1.0 - 0.5 * x).powi(2)],
            AdhesionLaw::Dugdale | AdhesionLaw::Linear => [0.0; 2],
            AdhesionLaw::VanDerWaals => {
                let left = 1.0 / (1.0 + x);
                [s * left.powi(3), -w * left.powi(2)]
            }
        }
    }

    /// The largest |dσ/dg| \[Pa/m\]; of the law `Dugdale`, which jumps, the mean one over the range.
    pub fn steepest(&self) -> f64 {
        let mean = self.strength() / self.range;
        match self.law {
            AdhesionLaw::Exponential | AdhesionLaw::Dugdale => mean,
            AdhesionLaw::Linear => 0.5 * mean,
            AdhesionLaw::VanDerWaals => 3.0 * mean,
        }
    }

    /// c k max|dσ/dg|: how far a cell of self-compliance c k \[m/Pa\] is from snapping on its own (1).
    pub fn trap(&self, compliance: f64, own: f64) -> f64 {
        compliance * own * self.steepest()
    }

    /// # Errors
    /// [`Error::Invalid`] that names the argument.
    pub fn validate(&self) -> Result<()> {
        let work = self.work;
        require(
            work.is_finite() && work >= 0.0,
            "work of adhesion",
            format!("{work} J/m2"),
            "0 J/m2 or more",
        )
        .of("work")?;
        positive("range of the adhesion", self.range, "m").of("range")?;
        let strength = self.strength();
        require(
            strength.is_finite(),
            "strength of the adhesion",
            format!("{strength} Pa"),
            "finite; enlarge the range",
        )
        .of("range")?;
        let tolerance = self.tolerance;
        require(
            (1e-14..=0.1).contains(&tolerance),
            "tolerance of the adhesion",
            tolerance,
            "from 1e-14 to 0.1",
        )
        .of("tolerance")
    }
}

/// k: the displacement of a cell under its own unit pressure, on a body of unit compliance \[m\].
///
/// # Errors
/// Those of the kernel.
pub fn own_response(grid: &Grid, boundary: Boundary, kernel: &Arc<dyn Kernel>) -> Result<f64> {
    // The cells around a cell hardly matter, but of a line contact the whole domain does.
    let cells = if grid.is_line() { grid.cells() } else { grid.cells().map(|n| n.min(16)) };
    let (grid, boundary) = match grid.is_line() {
        true => (*grid, boundary),
        false => {
            let [dx, dy] = grid.spacing();
            (Grid::new(cells, [cells[0] as f64 * dx, cells[1] as f64 * dy])?, Boundary::Free)
        }
    };
    let mut operator = plan(grid, boundary, kernel.clone())?;
    let mut unit = vec![0.0; grid.len()];
    let middle = cells[0] / 2 * cells[1] + cells[1] / 2;
    unit[middle] = 1.0;
    let mut response = vec![0.0; grid.len()];
    operator.apply_into(&unit, &mut response);
    Ok(response[middle])
}

/// Cells along x and y with which a trap number on this grid falls to [`FINE_TRAP`].
pub(super) fn cells_needed(grid: &Grid, trap: f64) -> [usize; 2] {
    let factor = (trap / FINE_TRAP).max(1.0);
    grid.cells().map(|n| if n == 1 { 1 } else { (n as f64 * factor).ceil() as usize })
}

impl TractionLaw for Adhesion {
    fn start(&self, _grid: &Grid) -> Box<dyn SurfaceTraction> {
        Box::new(*self)
    }

    fn tolerances(&self, _contact: f64) -> [f64; 2] {
        [self.tolerance, 0.1 * self.tolerance]
    }

    fn quantities(&self) -> Vec<Quantity> {
        Quantity::of_adhesion().collect()
    }

    fn as_adhesion(&self) -> Option<&Adhesion> {
        Some(self)
    }

    fn check(&self, simulation: &Simulation) -> Result<()> {
        self.validate().of("adhesion")?;
        let [hardness, _] = simulation.hardness_range();
        if self.work > 0.0 && hardness <= self.strength() {
            let expected = format!(
                "more than the strength of the adhesion, {:e} Pa: where the attraction exceeds it, cells in contact only pull. Raise \
                 the hardness or the range",
                self.strength()
            );
            return Err(Error::invalid("hardness", format!("{hardness:e} Pa"), expected).of("adhesion.range"));
        }
        let own = own_response(&simulation.grid, simulation.boundary, &simulation.kernel)?;
        let trap = self.trap(simulation.relaxed(), own);
        if trap <= LARGEST_TRAP || self.allow_unresolved {
            return Ok(());
        }
        let [nx, ny] = cells_needed(&simulation.grid, trap);
        let doubt = match self.work > MOST_WORK {
            true => {
                format!(" Is the work of adhesion meant, {} J/m2? Surfaces have 0.001 to 1 J/m2.", self.work)
            }
            false => String::new(),
        };
        let expected = format!(
            "at most {LARGEST_TRAP}, better {FINE_TRAP}: these cells snap into and out of contact one by one, which makes false forces and \
             hysteresis. Take {nx} x {ny} cells, or a longer range; allow_unresolved = true runs it all the same.{doubt}"
        );
        Err(Error::invalid("trap number of the adhesion", format!("{trap:.3}"), expected)
            .of("adhesion.range"))
    }
}

impl SurfaceTraction for Adhesion {
    fn bound(&mut self, gap: &[f64], _contact: &[f64], out: &mut [f64]) -> Result<()> {
        let law = *self;
        each(out, gap, |b, g| *b = -law.at(g)[0]);
        Ok(())
    }

    fn energy(&self, gap: &[f64]) -> Option<f64> {
        let law = *self;
        Some(sums(gap, |g| [law.at(g)[1]])[0])
    }

    fn limits(&self) -> [f64; 2] {
        [-self.strength(), 0.0]
    }

    fn is_attraction(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAWS: [AdhesionLaw; 4] =
        [AdhesionLaw::Exponential, AdhesionLaw::Dugdale, AdhesionLaw::Linear, AdhesionLaw::VanDerWaals];

    #[test]
    fn the_attraction_is_the_slope_of_a_concave_potential_whose_depth_is_the_work() {
        for law in LAWS {
            let own = Adhesion { law, ..Adhesion::new(0.05, 2e-9) };
            assert_eq!(own.at(0.0)[1], -0.05);
            assert!((own.at(0.0)[0] / own.strength() - 1.0).abs() < 1e-15);
            let d = 1e-14;
            let mut last = own.at(0.0)[0];
            for k in 1..200 {
                let g = 5e-11 * k as f64;
                let slope = (own.at(g + d)[1] - own.at(g - d)[1]) / (2.0 * d);
                let s = own.at(g)[0];
                // Rounding: 1e-16 of 0.05 over 2e-14; and where Dugdale's law jumps neither side is right.
                let jumps = law == AdhesionLaw::Dugdale && (g / own.range - 1.0).abs() < 1e-4;
                assert!((slope - s).abs() < 1e-3 * own.strength() || jumps, "{law:?} {g}: {slope} {s}");
                assert!(
                    s <= last && (last - s) <= own.steepest() * 5e-11 * 1.001 || law == AdhesionLaw::Dugdale
                );
                last = s;
            }
            assert_eq!(own.at(f64::INFINITY), [0.0; 2]);
        }
    }

    #[test]
    fn the_own_response_of_a_square_cell_is_loves() {
        let grid = Grid::new([64, 64], [1.0, 1.0]).unwrap();
        let kernel: Arc<dyn Kernel> = Arc::new(crate::kernel::HalfSpace);
        let own = own_response(&grid, Boundary::Free, &kernel).unwrap();
        // 4 ln(1 + sqrt 2)/pi; the single precision of the plan.
        assert!((own * 64.0 / 1.122_199_5 - 1.0).abs() < 1e-6, "{}", own * 64.0);
    }

    #[test]
    fn the_own_response_of_a_periodic_line_is_the_sum_of_its_waves() {
        let (n, side) = (128_usize, 2e-4);
        let kernel: Arc<dyn Kernel> = Arc::new(crate::kernel::HalfSpace);
        let own = own_response(&Grid::line(n, side).unwrap(), Boundary::Periodic, &kernel).unwrap();
        // u = 2 p/|q| of each of n waves with the amplitude p/n, but for the mean.
        let waves = (1..n / 2).map(|m| 2.0 / m as f64).sum::<f64>() + 2.0 / n as f64;
        let sum = side / (std::f64::consts::PI * n as f64) * waves;
        assert!((own / sum - 1.0).abs() < 1e-12, "{own} {sum}");
    }
}
