//! The largest stresses: maxima over depths, refined between them, and the profile over depth.

use super::depths::RESOLVED;
use super::slab::{First, MISES, SHEAR, Slab, TENSION, TRESCA};
use super::{Component, SubsurfaceStress, check_depths, unseen_depths};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// Number of additional depths for the search of a maximum.
const REFINED: usize = 3;
/// A depth closer than this to a known one, in the logarithm, gives no more information: the error of a maximum is of second
/// order.
const NEAR: f64 = 2e-3;

/// A largest value and its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The stress \[Pa\].
    pub value: f64,
    /// Depth \[m\].
    pub depth: f64,
    /// Number of the cell, C-order; the first of several.
    pub cell: usize,
}

/// Direction in which a contact rolls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Rolling {
    /// Along x.
    X,
    /// Along y.
    Y,
}

impl Rolling {
    /// The orthogonal shear stress: on planes parallel to the surface, along the direction of rolling.
    pub fn component(self) -> Component {
        match self {
            Rolling::X => Component::Xz,
            Rolling::Y => Component::Yz,
        }
    }
}

/// Additional results of a survey besides the maxima. Default: none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurveyOptions {
    /// Threshold of the von Mises stress for the stressed volume \[Pa\].
    pub threshold: Option<f64>,
    /// Rolling direction for the range of the orthogonal shear stress.
    pub rolling: Option<Rolling>,
}

/// The result of a survey over depths.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Depths \[m\], increasing.
    pub depths: Vec<f64>,
    /// Largest von Mises stress at each of them \[Pa\].
    pub mises_by_depth: Vec<f64>,
    /// Largest Tresca stress at each of them \[Pa\].
    pub tresca_by_depth: Vec<f64>,
    /// Largest principal stress at each of them \[Pa\].
    pub tension_by_depth: Vec<f64>,
    /// Largest von Mises stress, its depth refined between the depths.
    pub mises: Extreme,
    /// Largest Tresca stress (s1 - s3)/2, refined likewise.
    pub tresca: Extreme,
    /// Largest principal stress, at one of the computed depths.
    pub tension: Extreme,
    /// Depths \[m\] between which the von Mises stress may be larger than the value found, see [`unseen_depths`].
    pub unseen: Option<[f64; 2]>,
    /// True if its depth is less than two cells but not 0: the grid is too coarse for it.
    pub unresolved: bool,
    /// Volume with a von Mises stress above the threshold \[m^3\], for a line per length \[m^2\], by the trapezoidal rule over
    /// the depths.
    pub stressed_volume: Option<f64>,
    /// The orthogonal shear stress of rolling.
    pub orthogonal_shear: Option<OrthogonalShear>,
}

/// The range of the orthogonal shear stress at a point of the body while the contact rolls over it: the largest minus the
/// smallest value on a line along the direction of rolling (G. Lundberg & A. Palmgren, Dynamic capacity of rolling bearings,
/// 1947). The pressure is the present one, and must move without change.
#[derive(Clone, Debug, PartialEq)]
pub struct OrthogonalShear {
    /// Largest range at each of the depths \[Pa\].
    pub by_depth: Vec<f64>,
    /// The largest of them, refined between the depths; its cell is on the line.
    pub largest: Extreme,
}

/// Surveys the stress below the pressure set in `stress`, at `depths` (increasing, at least one).
///
/// # Errors
/// [`Error::Invalid`] for depths that do not increase, and as [`SubsurfaceStress::component_into`].
pub fn survey(stress: &mut SubsurfaceStress, depths: &[f64], options: &SurveyOptions) -> Result<Survey> {
    survey_with(stress, depths, options, |_, _| Ok(()))
}

/// The same, and calls `visit` with the six components at each of the depths, numbered from 0 (not at the additional depths for
/// the search of a maximum). An error of `visit` ends the survey.
///
/// # Errors
/// The errors of [`survey`] and of `visit`.
pub fn survey_with<E: From<Error>>(
    stress: &mut SubsurfaceStress,
    depths: &[f64],
    options: &SurveyOptions,
    mut visit: impl FnMut(usize, &[Vec<f64>; 6]) -> Result<(), E>,
) -> Result<Survey, E> {
    let grid = *stress.grid();
    check_depths(&grid, depths)?;
    let mut fields = std::array::from_fn(|_| Vec::new());
    let mut known = Known(Vec::with_capacity(depths.len() + 3 * REFINED));
    for (n, depth) in depths.iter().enumerate() {
        stress.at(*depth, &mut fields)?;
        visit(n, &fields)?;
        known.0.push((*depth, Slab::of(&grid, &fields, options)));
    }
    let slabs: Vec<Slab> = known.0.iter().map(|(_, slab)| *slab).collect();
    let shear = options.rolling.map(|_| SHEAR);
    for of in [MISES, TRESCA].into_iter().chain(shear) {
        for _ in 0..REFINED {
            let Some(depth) = known.vertex(of) else { break };
            stress.at(depth, &mut fields)?;
            known.insert(depth, Slab::of(&grid, &fields, options));
        }
    }
    let by_depth = |of: usize| slabs.iter().map(|slab| slab.maxima[of].value).collect::<Vec<f64>>();
    let (mises, mises_by_depth) = (known.largest(MISES), by_depth(MISES));
    Ok(Survey {
        depths: depths.to_vec(),
        unseen: unseen_depths(depths, &mises_by_depth, grid.longest_cell()),
        mises_by_depth,
        tresca_by_depth: by_depth(TRESCA),
        tension_by_depth: by_depth(TENSION),
        tresca: known.largest(TRESCA),
        tension: known.largest(TENSION),
        unresolved: is_unresolved(&grid, mises.depth),
        stressed_volume: options.threshold.map(|_| volume(&grid, depths, &slabs)),
        orthogonal_shear: options
            .rolling
            .map(|_| OrthogonalShear { by_depth: by_depth(SHEAR), largest: known.largest(SHEAR) }),
        mises,
    })
}

/// Whether a maximum at this depth is less than two cells below the surface, but not at the surface.
fn is_unresolved(grid: &Grid, depth: f64) -> bool {
    depth > 0.0 && depth < RESOLVED * grid.longest_cell()
}

/// Trapezoidal rule over the depths.
fn volume(grid: &Grid, depths: &[f64], slabs: &[Slab]) -> f64 {
    let area = |n: usize| slabs[n].above * grid.cell_area();
    (1..depths.len()).map(|n| 0.5 * (area(n) + area(n - 1)) * (depths[n] - depths[n - 1])).sum()
}

/// The results at the computed depths, in order of depth.
struct Known(Vec<(f64, Slab)>);

impl Known {
    /// Number of the depth at which `of` is largest; the first of several.
    fn best(&self, of: usize) -> usize {
        let value = |n: usize| self.0[n].1.maxima[of].value;
        (1..self.0.len()).fold(0, |best, n| if value(n) > value(best) { n } else { best })
    }

    fn largest(&self, of: usize) -> Extreme {
        let (depth, slab) = &self.0[self.best(of)];
        let First { value, cell } = slab.maxima[of];
        Extreme { value, depth: *depth, cell }
    }

    /// The depth at which the parabola through the largest value and its neighbours, in the logarithm of the depth, is highest;
    /// `None` if the three are not all below the surface, or if the new depth gives no more information.
    fn vertex(&self, of: usize) -> Option<f64> {
        let best = self.best(of);
        let three = self.0.get(best.checked_sub(1)?..best + 2)?;
        let [(z0, s0), (z1, s1), (z2, s2)] = three else { return None };
        if *z0 <= 0.0 {
            return None;
        }
        let [a, b, c] = [z0, z1, z2].map(|z| libm::log(*z));
        let [f, g, h] = [s0, s1, s2].map(|slab| slab.maxima[of].value);
        let (left, right) = ((g - f) / (b - a), (h - g) / (c - b));
        let curvature = (right - left) / (c - a);
        let at = 0.5 * (a + b) - 0.5 * left / curvature;
        let new = [a, b, c].iter().all(|known| (at - known).abs() > NEAR);
        (curvature < 0.0 && at > a && at < c && new).then(|| libm::exp(at))
    }

    fn insert(&mut self, depth: f64, slab: Slab) {
        let place = self.0.partition_point(|(known, _)| *known < depth);
        self.0.insert(place, (depth, slab));
    }
}
