//! What is known of an adhesive contact before it is solved: how fine its cells are, and how it will pull off.

use ndarray::Array2;

use super::adhesion::{AdhesionLaw, cells_needed, own_response};
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::reference::{AdhesiveModel, AdhesiveSphere, maugis_lambda, tabor};
use crate::simulation::Simulation;

/// Curvatures of a single round body differ by less than this share.
const ROUND: f64 = 0.1;

/// The numbers that an adhesive contact depends on, SI.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct AdhesionScale {
    /// The law of the attraction.
    pub law: AdhesionLaw,
    /// Work of adhesion \[J/m²\].
    pub work: f64,
    /// Range of the attraction \[m\], and its largest value \[Pa\].
    pub range: f64,
    /// The largest attraction \[Pa\].
    pub strength: f64,
    /// c k max|dσ/dg| of the relaxed bodies: 1 where each cell snaps on its own.
    pub trap: f64,
    /// Cells along x and y with which it is [`FINE_TRAP`](super::FINE_TRAP).
    pub cells_needed: [usize; 2],
    /// One over the rms curvature of the gap \[m\]; infinite where it is flat.
    pub radius: f64,
    /// Tabor's number of that radius and the relaxed bodies, of half-spaces: the elastic lengthening at pull-off over the range.
    pub tabor: Option<f64>,
    /// Pull-off force of a sphere of that radius \[N\] by Maugis' model, where the gap is that of a sphere on half-spaces.
    pub expected_pull_off: Option<f64>,
}

impl AdhesionScale {
    /// Of a simulation with its gap; `None` without adhesion.
    ///
    /// # Errors
    /// Those of the kernel.
    pub fn of(simulation: &Simulation) -> Result<Option<AdhesionScale>> {
        let Some(law) = simulation.traction.as_ref().and_then(|law| law.as_adhesion()) else {
            return Ok(None);
        };
        let Simulation { grid, boundary, kernel, gap, .. } = simulation;
        let compliance = simulation.relaxed();
        let trap = law.trap(compliance, own_response(grid, *boundary, kernel)?);
        let [rms, middle] = curvatures(grid, *boundary, gap);
        let (radius, modulus) = (1.0 / rms, 1.0 / compliance);
        let is_half_space = kernel.is_half_space();
        let is_round = !grid.is_line() && (rms / middle - 1.0).abs() < ROUND && is_half_space;
        let pull_off = || {
            let lambda = maugis_lambda(radius, modulus, law.work, law.range);
            let sphere =
                AdhesiveSphere::new(AdhesiveModel::Maugis { lambda }, radius, modulus, law.work).ok()?;
            Some(-sphere.pull_off(0.0).load)
        };
        Ok(Some(AdhesionScale {
            law: law.law,
            work: law.work,
            range: law.range,
            strength: law.strength(),
            trap,
            cells_needed: cells_needed(grid, trap),
            radius,
            tabor: is_half_space
                .then(|| tabor(radius, modulus, law.work, law.range))
                .filter(|tabor| tabor.is_finite()),
            expected_pull_off: is_round.then(pull_off).flatten().filter(|force| *force > 0.0),
        }))
    }
}

/// The rms curvature of the gap over its cells, and that where the gap is least \[1/m\]; NaN where too few cells can touch.
fn curvatures(grid: &Grid, boundary: Boundary, gap: &Array2<f64>) -> [f64; 2] {
    let [dx, dy] = grid.spacing();
    let (nx, ny) = gap.dim();
    let second = |(i, j): (usize, usize), along_x: bool| {
        let at = |step: isize| match along_x {
            true => boundary.beside(i, step, nx).map(|i| gap[(i, j)]),
            false => boundary.beside(j, step, ny).map(|j| gap[(i, j)]),
        };
        let d = if along_x { dx } else { dy };
        Some((at(-1)? - 2.0 * gap[(i, j)] + at(1)?) / (d * d)).filter(|curvature| curvature.is_finite())
    };
    let curvature = |cell: (usize, usize)| match grid.is_line() {
        true => second(cell, true),
        false => Some(0.5 * (second(cell, true)? + second(cell, false)?)),
    };
    let (mut sum, mut count, mut lowest, mut least) = (0.0, 0.0, f64::INFINITY, f64::NAN);
    for (cell, h) in gap.indexed_iter() {
        let Some(own) = curvature(cell) else { continue };
        sum += own * own;
        count += 1.0;
        if *h < lowest {
            (lowest, least) = (*h, own);
        }
    }
    [(sum / count).sqrt(), least]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Part, Shape, undeformed_gap};
    use crate::traction::Adhesion;
    use std::sync::Arc;

    #[test]
    fn a_sphere_has_its_radius_and_its_pull_off() {
        let grid = Grid::new([64, 64], [0.4, 0.4]).unwrap();
        let sphere = Part::Shape { shape: Shape::Sphere { radius: 2.0 }, center: [0.0, 0.0] };
        let gap = undeformed_gap(&grid, &[sphere]).unwrap();
        let law = Adhesion::new(1e-4, 1e-3);
        let simulation = Simulation { traction: Some(Arc::new(law)), ..Simulation::new(grid, gap) };
        let scale = AdhesionScale::of(&simulation).unwrap().unwrap();
        assert!((scale.radius / 2.0 - 1.0).abs() < 0.02, "{}", scale.radius);
        // (R w²/(E*² ρ³))^(1/3) with E* = 1.
        assert!((scale.tabor.unwrap() / libm::cbrt(2.0 * 1e-8 / 1e-9) - 1.0).abs() < 0.02);
        // 1.122 dx w/ρ².
        assert!((scale.trap / (1.1222 * 0.4 / 64.0 * 1e-4 / 1e-6) - 1.0).abs() < 1e-3, "{}", scale.trap);
        let force = scale.expected_pull_off.unwrap() / (std::f64::consts::PI * 1e-4 * scale.radius);
        assert!(force > 1.5 && force < 1.6);
    }
}
