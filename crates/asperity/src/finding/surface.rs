//! Surfaces: waves that the grid does not resolve, steep slopes, outliers, sizes that suggest a wrong unit.

use std::f64::consts::FRAC_PI_2;

use ndarray::{Array2, s};

use super::plausible::{DEEPEST, FLATTEST, LARGEST_RADIUS, SLOPES, exceeded};
use super::words::{digits, si};
use super::{
    Finding, HURST_OUT_OF_RANGE, HURST_UNCERTAIN, LARGE_SLOPE, LAY_MIRRORED, OUTLIERS,
    SHORTEST_WAVE_UNRESOLVED, UNLIKELY_UNIT,
};
use crate::grid::Grid;
use crate::surface::statistics::{Extent, HeightStatistics, PowerSpectrum, SelfAffineFit, SlopeStatistics};
use crate::surface::{Part, Roughness, SelfAffine, Shape, Surface};

/// Smallest number of cells per shortest wave: with four, the error of the curvature of its crests is 10 %.
pub(super) const CELLS_PER_WAVE: f64 = 4.0;
/// Rms slope beyond which a half-space is no longer a good approximation of the body.
pub(super) const STEEPEST: f64 = 0.5;
/// Kurtosis of the heights: 3 for a Gaussian surface, tens for spikes.
const OUTLYING: f64 = 20.0;
/// The findings from the parts of a gap.
pub(super) fn of_part(grid: &Grid, part: &Part) -> Vec<Finding> {
    match part {
        Part::Shape { shape, .. } => of_shape(grid, shape),
        Part::SelfAffine(surface) => of_spectrum(grid, surface),
        Part::Synthesis(surface) => of_spectrum(grid, &surface.spectrum),
        Part::Heights { name, heights } => match Surface::new(*grid, heights.clone()) {
            Ok(surface) => of_heights(name, &surface),
            Err(_) => vec![], // refused with the gap
        },
    }
}

fn of_shape(grid: &Grid, shape: &Shape) -> Vec<Finding> {
    let [dx, dy] = grid.spacing();
    let (size, cell) = (grid.longest_side(), grid.cell_sides().fold(f64::INFINITY, f64::min));
    let radius = |name: &str, radius: f64| {
        let large = radius.is_finite() && (radius >= LARGEST_RADIUS || radius > FLATTEST * size);
        let (limit, against) = match (large, radius < cell) {
            (true, _) => (LARGEST_RADIUS.min(FLATTEST * size), format!("on a domain of {}", si(size, "m"))),
            (_, true) => (cell, format!("on cells of {}", si(cell, "m"))),
            _ => return None,
        };
        let text = format!(
            "The radius of the {name} is {} {against}. Check its unit and that of domain.size.",
            si(radius, "m")
        );
        Some(Finding::warning(UNLIKELY_UNIT, radius, limit, text))
    };
    match shape {
        Shape::Sphere { radius: r } => radius("sphere", *r).into_iter().collect(),
        Shape::Ellipsoid { radius_x, radius_y } => {
            [("ellipsoid along x", *radius_x), ("ellipsoid along y", *radius_y)]
                .into_iter()
                .filter_map(|(name, r)| radius(name, r))
                .collect()
        }
        Shape::Cylinder { radius: r } => radius("cylinder", *r).into_iter().collect(),
        Shape::Wedge { slope } => steep("the wedge", *slope).into_iter().collect(),
        Shape::Cone { slope } => steep("the cone", *slope).into_iter().collect(),
        Shape::FlatPunch(_) => vec![],
        Shape::Wave { amplitude, wavelength } => {
            let cells = [wavelength[0] / dx, wavelength[1] / dy];
            let cells = if grid.is_line() { [cells[0]; 2] } else { cells };
            // Mean square of the gradient of A cos(qx x) cos(qy y), and of A cos(qx x).
            let waves = wavelength.iter().filter(|l| l.is_finite()).count() as f64;
            let square: f64 =
                wavelength.iter().map(|l| (std::f64::consts::TAU * amplitude / l).powi(2)).sum();
            let slope = (square / 2.0 / waves.max(1.0)).sqrt();
            let short = unresolved("wave", cells[0].min(cells[1]));
            short.into_iter().chain(steep("the wave", slope)).collect()
        }
    }
}

fn of_spectrum(grid: &Grid, surface: &SelfAffine) -> Vec<Finding> {
    let cell = grid.longest_cell();
    let slope = match surface.roughness {
        Roughness::RmsGradient(gradient) => steep("the self-affine surface", gradient),
        // Known once the surface is made: see `of_given_height`.
        Roughness::RmsHeight(_) => None,
    };
    let short = unresolved("self-affine surface", surface.shortest / cell);
    short.into_iter().chain(slope).collect()
}

/// The findings from given heights: outliers, slopes, and heights that suggest a wrong unit. `name` is the name of the surface.
pub fn of_heights(name: &str, surface: &Surface) -> Vec<Finding> {
    let Ok(heights) = HeightStatistics::of(surface) else { return vec![] };
    let slope = SlopeStatistics::of(surface).map_or(0.0, |slopes| slopes.sdq);
    let mut found = vec![];
    if heights.sku > OUTLYING {
        let text = format!(
            "The heights of {name} have a kurtosis of {} (3 is Gaussian): single points stand far from the others and \
             carry the load first. Remove spikes (outliers) and holes (fill), or check that they are real.",
            digits(heights.sku)
        );
        found.push(Finding::warning(OUTLIERS, heights.sku, OUTLYING, text));
    }
    let Some(limit) = exceeded(SLOPES, slope).filter(|_| slope > 0.0) else {
        found.extend(steep(name, slope));
        return found;
    };
    let text = format!(
        "The heights of {name} have an rms slope of {} and span {}{}: check their unit (height_unit) and the size of the surface.",
        digits(slope),
        si(heights.sz, "m"),
        if slope < limit { ", flatter than any real surface" } else { "" }
    );
    found.push(Finding::warning(UNLIKELY_UNIT, slope, limit, text));
    found
}

/// The findings from the gap as a whole that do not follow from its parts: `unknown` if the parts are not known.
pub(super) fn of_gap(grid: &Grid, gap: &Array2<f64>, unknown: bool) -> Vec<Finding> {
    let deepest = gap.iter().filter(|h| h.is_finite()).fold(0.0, |most: f64, h| most.max(*h));
    let size = grid.longest_side();
    let mut found = vec![];
    if deepest > DEEPEST * size {
        let text = format!(
            "The undeformed gap is up to {} deep on a domain of {}: check the units of radii, heights and domain.size.",
            si(deepest, "m"),
            si(size, "m")
        );
        found.push(Finding::warning(UNLIKELY_UNIT, deepest, DEEPEST * size, text));
    }
    if unknown && let Some(cells) = shortest_wave(gap) {
        found.extend(unresolved("gap", cells));
    }
    found
}

/// The gap of a surface that was continued by its reflections, whose lay runs at an angle to the axes: it runs at the opposite angle in
/// the reflections.
pub(super) fn lay_mirrored(grid: &Grid, gap: &Array2<f64>) -> Option<Finding> {
    /// Smallest angle between a lay and the axes \[rad\]: sin² of it is 3 %.
    const OBLIQUE: f64 = 10.0 / 180.0 * std::f64::consts::PI;
    let ([nx, ny], [dx, dy]) = (grid.cells().map(|n| n / 2), grid.spacing());
    let quarter = Grid::new([nx, ny], [dx * nx as f64, dy * ny as f64]).ok()?;
    let heights = gap.slice(s![..nx, ..ny]).to_owned();
    let lay = PowerSpectrum::within(&Surface::new(quarter, heights).ok()?, Extent::Finite).ok()?.lay();
    // The gap has the lay of the heights.
    let from_axis = lay.angle.abs().min(FRAC_PI_2 - lay.angle.abs());
    if !lay.is_clear() || from_axis <= OBLIQUE {
        return None;
    }
    let text = format!(
        "The lay of the surface runs at {} degrees from x, so that its reflections (border = \"mirror\") make a herringbone, which conducts and \
         slides differently. Turn the sample under the instrument until the lay runs along an axis, or regard the numbers as those of a \
         herringbone.",
        digits(lay.angle.to_degrees())
    );
    Some(Finding::warning(LAY_MIRRORED, from_axis, OBLIQUE, text))
}

/// Self-affine parts of a given rms height: their slope follows from the gap.
pub(super) fn of_given_height(grid: &Grid, gap: &Array2<f64>, parts: &[Part]) -> Option<Finding> {
    let by_height =
        |part: &Part| matches!(part, Part::SelfAffine(SelfAffine { roughness: Roughness::RmsHeight(_), .. }));
    let slope = parts.iter().any(by_height).then(|| slope(grid, gap, f64::INFINITY))?;
    if slope <= SLOPES[1] {
        return steep("the gap", slope);
    }
    let text = format!(
        "The gap has an rms slope of {}: check the units of rms_height, of the wavelengths and of domain.size.",
        digits(slope)
    );
    Some(Finding::warning(UNLIKELY_UNIT, slope, SLOPES[1], text))
}

/// Number of cells of the wave whose curvature behaves like that of the gap: along an axis, a wave of m cells has second
/// differences over two cells that are 4 cos²(pi/m) times those over one; the wave numbers of both axes add up by their squares.
/// For an isotropic self-affine surface it is 1.1 to 1.4 times the shortest wave. `None` if the curvature is concentrated in a
/// few places: edges are not waves.
fn shortest_wave(gap: &Array2<f64>) -> Option<f64> {
    /// Smallest fraction of the cells that has the curvature: for a Gaussian surface it is a third.
    const SPREAD: f64 = 0.1;
    let waves = [0, 1].into_iter().filter_map(|axis| {
        let [mut near, mut far, mut fourth, mut count] = [0.0_f64; 4];
        for line in gap.lanes(ndarray::Axis(axis)) {
            for n in 2..line.len().saturating_sub(2) {
                let bend = |lag: usize| line[n - lag] - 2.0 * line[n] + line[n + lag];
                let (one, two) = (bend(1).powi(2), bend(2).powi(2));
                if one.is_finite() && two.is_finite() {
                    (near, far, fourth, count) = (near + one, far + two, fourth + one * one, count + 1.0);
                }
            }
        }
        let spread = near * near / (fourth * count);
        let cosine = (0.25 * (far / near).sqrt()).min(1.0).sqrt();
        (near > 0.0 && spread > SPREAD).then(|| std::f64::consts::PI / libm::acos(cosine))
    });
    let square: f64 = waves.map(|cells| 1.0 / (cells * cells)).sum();
    (square > 0.0).then(|| 1.0 / square.sqrt())
}

fn unresolved(name: &str, cells: f64) -> Option<Finding> {
    (cells < CELLS_PER_WAVE).then(|| {
        let text = format!(
            "The shortest waves of the {name} are {} cells long, less than {CELLS_PER_WAVE}: the contact of their crests \
             is not resolved, and area and largest pressure depend on the grid. Refine the grid (domain.cells) or leave \
             short waves out (shortest, filter).",
            digits(cells)
        );
        Finding::warning(SHORTEST_WAVE_UNRESOLVED, cells, CELLS_PER_WAVE, text)
    })
}

/// A slope beyond linear theory.
pub(super) fn steep(name: &str, slope: f64) -> Option<Finding> {
    (slope > STEEPEST).then(|| {
        let text = format!(
            "The rms slope of {name} is {}: the theory assumes small slopes, and beyond {STEEPEST} its pressures and \
             areas are only estimates.",
            digits(slope)
        );
        Finding::warning(LARGE_SLOPE, slope, STEEPEST, text)
    })
}

/// Root mean square slope of the cells whose gap is at most `deepest` \[m\], where the surfaces come close.
pub(super) fn slope(grid: &Grid, gap: &Array2<f64>, deepest: f64) -> f64 {
    let [dx, dy] = grid.spacing();
    let (mut squares, mut counts) = ([0.0; 2], [0.0_f64; 2]);
    let mut add = |axis: usize, here: f64, next: f64, step: f64| {
        if here <= deepest && next <= deepest && next.is_finite() && here.is_finite() {
            squares[axis] += ((next - here) / step).powi(2);
            counts[axis] += 1.0;
        }
    };
    let rows = gap.nrows();
    for i in 0..rows {
        let row = gap.row(i);
        if i + 1 < rows {
            row.iter().zip(gap.row(i + 1)).for_each(|(here, next)| add(0, *here, *next, dx));
        }
        row.iter().zip(row.iter().skip(1)).for_each(|(here, next)| add(1, *here, *next, dy));
    }
    (squares[0] / counts[0].max(1.0) + squares[1] / counts[1].max(1.0)).sqrt()
}

/// The slope of the surfaces where they come close, for the largest approach of a run \[m\].
pub(super) fn near(grid: &Grid, gap: &Array2<f64>, deepest: f64) -> Option<Finding> {
    steep("gap, where the bodies are close to each other,", slope(grid, gap, deepest))
}

/// The reliability of a Hurst exponent fitted to a spectrum.
pub fn hurst(fit: &SelfAffineFit) -> Option<Finding> {
    /// After windowing and levelling, the power falls at least as q^-4, so H = 1 is the largest exponent that they can show.
    const END: f64 = 0.95;
    /// A misfit of ln C of this size is a factor of two about the spectrum.
    const MISFIT: f64 = 0.7;
    let text = |what: String| {
        format!(
            "{what} Fit a range of wavelengths in which the spectrum is straight (surface info: --longest, --shortest)."
        )
    };
    if !(fit.hurst > 0.0 && fit.hurst <= 1.0) {
        let what = format!(
            "The Hurst exponent of the fit is {}, but that of a self-affine surface lies between 0 and 1: the spectrum is \
             not self-affine over the range of the fit.",
            digits(fit.hurst)
        );
        let limit = if fit.hurst > 1.0 { 1.0 } else { 0.0 };
        return Some(Finding::warning(HURST_OUT_OF_RANGE, fit.hurst, limit, text(what)));
    }
    let stray = fit.misfit.max(fit.stray);
    let (value, limit, why) = match (stray > MISFIT, fit.hurst > END) {
        (true, _) => {
            (stray, MISFIT, format!("the spectrum deviates from the fit by {} in ln C", digits(stray)))
        }
        (_, true) => {
            (fit.hurst, END, "near 1 it depends on levelling and window as much as on the surface".to_owned())
        }
        _ => return None,
    };
    let what = format!("The Hurst exponent of the fit, {}, is uncertain: {why}.", digits(fit.hurst));
    Some(Finding::warning(HURST_UNCERTAIN, value, limit, text(what)).as_note())
}
