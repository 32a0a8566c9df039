//! Where the stress is largest: maxima over depths, refined between them, and the profile over depth.

use rayon::prelude::*;

use super::{Invariants, SubsurfaceStress, invariants};
use crate::error::{Error, Result};
use crate::grid::{Boundary, Grid};
use asperity_sweep::{Merge, sweep};

/// Depths of [`automatic_depths`] below the surface.
const AUTOMATIC: usize = 24;
/// Further depths at which a maximum is looked for.
const REFINED: usize = 3;

/// A largest value and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The stress \[Pa\].
    pub value: f64,
    /// Depth \[m\].
    pub depth: f64,
    /// Number of the cell, C-order.
    pub cell: usize,
}

/// What a survey over depths finds.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Depths \[m\], rising.
    pub depths: Vec<f64>,
    /// Largest von Mises stress at each of them \[Pa\].
    pub mises_by_depth: Vec<f64>,
    /// Largest von Mises stress, its depth refined between the depths.
    pub mises: Extreme,
    /// Largest Tresca stress (s1 - s3)/2, refined likewise.
    pub tresca: Extreme,
    /// Largest principal stress, at one of the depths.
    pub tension: Extreme,
    /// True where the largest von Mises stress lies at the deepest depth: the survey should go deeper.
    pub at_the_deepest: bool,
    /// True where its depth is below two cells but not 0: the grid is too coarse for it.
    pub unresolved: bool,
    /// Volume with a von Mises stress above the threshold \[m^3\], by the trapezoidal rule over the depths.
    pub stressed_volume: Option<f64>,
}

/// The first largest value of a field.
#[derive(Clone, Copy)]
struct First {
    value: f64,
    cell: usize,
}

impl Merge for First {
    fn merge(self, next: Self) -> Self {
        if next.value > self.value { next } else { self }
    }
}

/// Maxima of one depth, and the cells above a threshold.
#[derive(Clone, Copy)]
struct Slab {
    mises: First,
    tresca: First,
    tension: First,
    above: f64,
}

impl Merge for Slab {
    fn merge(self, next: Self) -> Self {
        Slab {
            mises: self.mises.merge(next.mises),
            tresca: self.tresca.merge(next.tresca),
            tension: self.tension.merge(next.tension),
            above: self.above + next.above,
        }
    }
}

/// 0, and 24 depths in geometric progression from half a cell: on a free domain to 2 sqrt(A/pi), A the area of the rectangle
/// around the contact (where there is no contact, of the domain); on a periodic one to half its shorter side.
pub fn automatic_depths(grid: &Grid, boundary: Boundary, pressure: &[f64]) -> Vec<f64> {
    let ([dx, dy], [lx, ly]) = (grid.spacing(), grid.size());
    let deepest = match boundary {
        Boundary::Periodic => 0.5 * lx.min(ly),
        Boundary::Free => 2.0 * (contact_box(grid, pressure) / std::f64::consts::PI).sqrt(),
    };
    let first = 0.5 * dx.max(dy);
    let deepest = deepest.max(2.0 * first);
    let ratio = libm::log(deepest / first) / (AUTOMATIC - 1) as f64;
    std::iter::once(0.0).chain((0..AUTOMATIC).map(|k| first * libm::exp(ratio * k as f64))).collect()
}

/// Area of the rectangle around the cells under pressure; the domain's where there are none.
fn contact_box(grid: &Grid, pressure: &[f64]) -> f64 {
    let ny = grid.cells()[1];
    let touching = || pressure.iter().enumerate().filter(|(_, p)| **p > 0.0).map(|(n, _)| [n / ny, n % ny]);
    let ends = |axis: usize| {
        touching().fold((usize::MAX, 0), |(least, most), at| (least.min(at[axis]), most.max(at[axis])))
    };
    let [(x0, x1), (y0, y1)] = [ends(0), ends(1)];
    if x0 > x1 { grid.area() } else { ((x1 - x0 + 1) * (y1 - y0 + 1)) as f64 * grid.cell_area() }
}

/// Surveys the stress below the pressure that `stress` holds, at `depths` (rising, at least one). Where a `threshold` \[Pa\] is
/// given, the volume above it is measured.
///
/// # Errors
/// [`Error::Invalid`] for depths that do not rise, and as [`SubsurfaceStress::component_into`].
pub fn survey(stress: &mut SubsurfaceStress, depths: &[f64], threshold: Option<f64>) -> Result<Survey> {
    if depths.is_empty() || depths.windows(2).any(|two| two[0] >= two[1]) {
        return Err(Error::invalid(
            "depths",
            format!("{depths:?}"),
            "at least one, each deeper than the one before",
        ));
    }
    let mut fields = std::array::from_fn(|_| Vec::new());
    let mut slabs = Vec::with_capacity(depths.len());
    for depth in depths {
        stress.at(*depth, &mut fields)?;
        slabs.push(slab(&fields, threshold));
    }
    let best = |of: fn(&Slab) -> First| {
        let number =
            (0..slabs.len()).reduce(|a, b| if of(&slabs[b]).value > of(&slabs[a]).value { b } else { a });
        number.unwrap_or(0)
    };
    let at = |n: usize, of: fn(&Slab) -> First| {
        let First { value, cell } = of(&slabs[n]);
        Extreme { value, depth: depths[n], cell }
    };
    let deepest = depths.len() - 1;
    let mises_at = best(|s| s.mises);
    let mut refined = |of: fn(&Slab) -> First| -> Result<Extreme> {
        let n = best(of);
        let mut points: Vec<(f64, First)> =
            (n.saturating_sub(1)..=(n + 1).min(deepest)).map(|k| (depths[k], of(&slabs[k]))).collect();
        let mut found = at(n, of);
        for _ in 0..REFINED {
            let Some(depth) = vertex(&points) else { break };
            stress.at(depth, &mut fields)?;
            let new = of(&slab(&fields, None));
            if new.value > found.value {
                found = Extreme { value: new.value, depth, cell: new.cell };
            }
            narrow(&mut points, (depth, new));
        }
        Ok(found)
    };
    let (mises, tresca) = (refined(|s| s.mises)?, refined(|s| s.tresca)?);
    let [dx, dy] = stress.grid().spacing();
    let cell_area = stress.grid().cell_area();
    let volume = |_| {
        let area = |n: usize| slabs[n].above * cell_area;
        (1..depths.len()).map(|n| 0.5 * (area(n) + area(n - 1)) * (depths[n] - depths[n - 1])).sum()
    };
    Ok(Survey {
        mises_by_depth: slabs.iter().map(|slab| slab.mises.value).collect(),
        tension: at(best(|s| s.tension), |s| s.tension),
        at_the_deepest: mises_at == deepest && deepest > 0,
        unresolved: mises.depth > 0.0 && mises.depth < 2.0 * dx.max(dy),
        stressed_volume: threshold.map(volume),
        depths: depths.to_vec(),
        mises,
        tresca,
    })
}

/// Maxima and the count above a threshold of one depth.
fn slab(fields: &[Vec<f64>; 6], threshold: Option<f64>) -> Slab {
    let cells: Vec<usize> = (0..fields[0].len()).into_par_iter().collect();
    let nothing = First { value: f64::NEG_INFINITY, cell: 0 };
    sweep(&cells[..], &|cells: &[usize]| {
        let mut found = Slab { mises: nothing, tresca: nothing, tension: nothing, above: 0.0 };
        for cell in cells.iter().copied() {
            let Invariants { mises, tresca, tension, .. } =
                invariants(std::array::from_fn(|component| fields[component][cell]));
            found = found.merge(Slab {
                mises: First { value: mises, cell },
                tresca: First { value: tresca, cell },
                tension: First { value: tension, cell },
                above: f64::from(u8::from(threshold.is_some_and(|threshold| mises > threshold))),
            });
        }
        found
    })
}

/// The depth at which the parabola through three points, in the logarithm of the depth, is highest; `None` where there are not
/// three below the surface, or it has no maximum between them.
fn vertex(points: &[(f64, First)]) -> Option<f64> {
    let [(z0, f0), (z1, f1), (z2, f2)] = points else { return None };
    if *z0 <= 0.0 {
        return None;
    }
    let [a, b, c] = [z0, z1, z2].map(|z| libm::log(*z));
    let (left, right) = ((f1.value - f0.value) / (b - a), (f2.value - f1.value) / (c - b));
    let curvature = (right - left) / (c - a);
    let at = 0.5 * (a + b) - 0.5 * left / curvature;
    let depth = libm::exp(at);
    (curvature < 0.0 && depth > *z0 && depth < *z2 && (depth / z1 - 1.0).abs() > 1e-9).then_some(depth)
}

/// Takes in a point between three, and keeps the three around the highest.
fn narrow(points: &mut Vec<(f64, First)>, new: (f64, First)) {
    points.push(new);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = (0..points.len()).reduce(|a, b| if points[b].1.value > points[a].1.value { b } else { a });
    let start = best.unwrap_or(0).saturating_sub(1).min(points.len() - 3);
    *points = points[start..start + 3].to_vec();
}
