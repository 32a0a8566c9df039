//! The picture of a surface: height map, power spectrum, height distribution, bearing curve and autocorrelation.

use std::f64::consts::{LN_2, TAU};

use asperity::Grid;
use asperity::surface::statistics::{
    Autocorrelation, BearingCurve, Extent, RadialSpectrum, SelfAffineFit, Summary,
};
use asperity::surface::{Fill, Level, Surface, fill, level};
use asperity_io::readable::quantity;

use crate::figure::{Axes, Axis, Colours, Curves, Figure, Map, Series, Style, block, extent, means, robust};
use crate::histogram;

/// Bins of the height distribution.
const BINS: usize = 64;
/// Powers below this share of the largest lie beyond a cut-off of the surface: rounding, no roughness.
const ROUNDING: f64 = 1e-16;

/// The figure of a surface with its statistics (of `summary`) and its bearing curve.
///
/// ```
/// use asperity::{Grid, surface::{Roughness, SelfAffine, Surface}};
/// use asperity::surface::statistics::{BearingCurve, Extent, Summary};
///
/// let grid = Grid::new([64, 64], [1e-3, 1e-3])?;
/// let roughness = SelfAffine {
///     hurst: 0.8,
///     roughness: Roughness::RmsHeight(1e-6),
///     longest: 1e-3,
///     shortest: 4e-5,
///     roll_off: 5e-4,
///     seed: 1,
/// };
/// let surface = Surface::new(grid, roughness.heights(&grid)?)?;
/// let summary = Summary::of(&surface, Extent::Periodic)?;
/// let bearing = BearingCurve::of(&surface, 100)?;
/// let figure = asperity_report::surface::picture("rough", &surface, Extent::Periodic, &summary, &bearing);
/// assert_eq!(figure.panels.len(), 6);
/// assert!(figure.to_svg().contains("height [µm]"));
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn picture(
    title: &str,
    surface: &Surface,
    extent: Extent,
    summary: &Summary,
    bearing: &BearingCurve,
) -> Figure {
    let size = surface.grid().size();
    let map = Map::new("Heights", ["height", "m"], Colours::Sequential, surface.heights(), size);
    let mut figure = Figure::new(title).columns(3).with(map);
    if let Some(waves) = &summary.waves {
        figure = figure.with(spectrum(waves));
    }
    let (panel, beyond) = distribution(surface, summary);
    figure = figure.with(panel);
    let shares: Vec<f64> = bearing.share.iter().map(|share| 100.0 * share).collect();
    let curve = Curves::new(
        "Bearing area",
        Axis::linear("share of the surface above [%]", "").spanning(0.0, 100.0),
        Axis::linear("height", "m"),
    )
    .with(Series::new("", Style::Line, shares, &bearing.heights));
    figure = figure.with(curve);
    let mut words = caption(surface, summary) + &beyond;
    match correlation(surface, extent, summary) {
        Some((coarse, correlation)) => {
            figure = figure.with(radial(&correlation)).with(lags(&coarse, &correlation));
        }
        None => words += " No autocorrelation: the surface is flat, or too many points are undefined.",
    }
    figure.caption(words)
}

/// Most points of a side of the surface whose autocorrelation is drawn.
const FINEST: usize = 1024;

/// The autocorrelation about the mean plane (of a periodic surface about the mean), with undefined points filled; a large surface
/// as means of blocks.
fn correlation(surface: &Surface, extent: Extent, summary: &Summary) -> Option<(Surface, Autocorrelation)> {
    summary.waves.as_ref()?;
    let heights = surface.heights();
    let [nx, ny] = surface.grid().cells();
    let by = nx.max(ny).div_ceil(FINEST).max(block(heights));
    let coarse = means(heights, by);
    let (cells, spacing) = (coarse.dim(), surface.grid().spacing());
    let size = [cells.0 as f64 * spacing[0] * by as f64, cells.1 as f64 * spacing[1] * by as f64];
    let grid = Grid::new([cells.0, cells.1], size).ok()?;
    let flat = match extent {
        Extent::Periodic => coarse,
        Extent::Finite => level(coarse.view(), Level::Plane).ok()?,
    };
    let whole = match flat.iter().all(|z| z.is_finite()) {
        true => flat,
        false => fill(&grid, flat.view(), Fill::Harmonic, 1.0).ok()?,
    };
    let surface = Surface::new(grid, whole).ok()?;
    let correlation = Autocorrelation::of(&surface, extent).ok()?;
    Some((surface, correlation))
}

/// The autocorrelation averaged over all directions, that along the direction in which it falls first, and Sal, where it falls to 0.2.
fn radial(correlation: &Autocorrelation) -> Curves {
    /// The level of the autocorrelation length of ISO 25178-2.
    const LEVEL: f64 = 0.2;
    let (lags, mean) = correlation.radial();
    let last = lags.last().copied().unwrap_or(0.0);
    let panel = Curves::new("Autocorrelation", Axis::linear("lag", "m"), Axis::linear("autocorrelation", ""));
    let Some((angle, length)) = correlation.fastest_decay() else {
        let name = "0.2, not reached in any direction";
        return panel.with(Series::new("mean of all directions", Style::Line, lags, mean)).with(Series::new(
            name,
            Style::Reference,
            [0.0, last],
            [LEVEL; 2],
        ));
    };
    let (sin, cos) = angle.sin_cos();
    let along: Vec<f64> =
        lags.iter().map(|lag| correlation.at(lag * cos, lag * sin).unwrap_or(f64::NAN)).collect();
    let foot = mean.iter().chain(&along).copied().fold(0.0, f64::min);
    let name = format!("0.2 is reached at Sal = {}", quantity(length, "m"));
    let fastest = format!("fastest fall, at {:.0}° from x", angle.to_degrees());
    panel
        .with(Series::new("mean of all directions", Style::Line, &lags, mean))
        .with(Series::new(fastest, Style::Dashed, lags, along))
        .with(Series::new(name, Style::Reference, [0.0, length, length], [LEVEL, LEVEL, foot]))
}

/// The autocorrelation over lags in both directions.
fn lags(surface: &Surface, correlation: &Autocorrelation) -> Map {
    let (what, size) = (["autocorrelation", ""], surface.grid().size());
    let map = Map::new("Autocorrelation", what, Colours::Diverging, correlation.values.view(), size);
    map.over(Axes::Lags).between([-1.0, 1.0])
}

/// Whether the spectrum is that of a self-affine surface: a Hurst exponent between 0 and 1 within its uncertainty, and known to
/// a quarter, and a spectrum within a factor of two of the fit, at the many short waves and at the few long ones.
fn fits(fit: &SelfAffineFit) -> bool {
    let within = fit.hurst + fit.error > 0.0 && fit.hurst - fit.error < 1.0;
    within && fit.error < 0.25 && fit.misfit < LN_2 && fit.stray < LN_2
}

/// Wave numbers and powers of a spectrum without those that are rounding errors.
pub(crate) fn roughness(spectrum: &RadialSpectrum) -> (Vec<f64>, Vec<f64>) {
    let largest = spectrum.power.iter().copied().fold(0.0, f64::max);
    let all = spectrum.wave_number.iter().copied().zip(spectrum.power.iter().copied());
    all.filter(|(_, power)| *power > ROUNDING * largest).unzip()
}

fn spectrum(waves: &asperity::surface::statistics::Waves) -> Curves {
    let (q, power) = roughness(&waves.spectrum);
    let (title, along) = match waves.lay.is_clear() {
        true => ("Power spectrum, average over ellipses", "wave number across the lay"),
        false => ("Power spectrum, radial average", "wave number"),
    };
    let mut curves = Curves::new(title, Axis::log(along, "1/m"), Axis::log("power", "m4")).with(Series::new(
        "",
        Style::Points,
        &q,
        power,
    ));
    // A line through a spectrum that is no power law says nothing.
    let fit = waves.fit.as_ref().filter(|fit| fits(fit));
    if let (Some(fit), Some(first), Some(last)) = (fit, q.first(), q.last()) {
        let bend = TAU / fit.roll_off;
        let at = |q: f64| fit.plateau * (q / bend).max(1.0).powf(-2.0 * (1.0 + fit.hurst));
        let places = [*first, bend, *last].into_iter().filter(|q| (*first..=*last).contains(q));
        let name = format!("fitted slope: H = {:.2} \u{b1} {:.2}", fit.hurst, fit.error);
        curves = curves.with(Series::through(name, Style::Dashed, places.map(|q| [q, at(q)])));
    }
    curves
}

/// The distribution of the heights, without the few that lie far out; these are told.
fn distribution(surface: &Surface, summary: &Summary) -> (Curves, String) {
    let (mean, sq) = (summary.heights.mean, summary.heights.sq);
    let heights: Vec<f64> = surface.heights().iter().copied().filter(|z| z.is_finite()).collect();
    let whole = extent(heights.iter().copied());
    let kept = robust(heights.iter().copied());
    let [low, high] = kept.unwrap_or(whole);
    let panel =
        Curves::new("Height distribution", Axis::linear("height", "m"), Axis::linear("density", "1/m"))
            .or_say("all heights are the same");
    let panel = histogram::bars(panel, histogram::density(&heights, low..=high, BINS));
    let beyond = match kept {
        Some([low, high]) => format!(
            " Distribution without the lowest and highest thousandth, which go from {} to {}.",
            quantity(whole[0].min(low), "m"),
            quantity(whole[1].max(high), "m")
        ),
        None => String::new(),
    };
    if sq <= 0.0 {
        return (panel, beyond);
    }
    let places: Vec<f64> = (0..=100).map(|k| low + (high - low) * f64::from(k) / 100.0).collect();
    let gauss = |z: f64| (-0.5 * ((z - mean) / sq).powi(2)).exp() / (sq * TAU.sqrt());
    (panel.with(Series::of("Gaussian of the same Sq", Style::Reference, &places, gauss)), beyond)
}

fn caption(surface: &Surface, summary: &Summary) -> String {
    let [nx, ny] = surface.grid().cells();
    let h = &summary.heights;
    let undefined = surface.grid().len() - h.defined;
    let mut text = format!("{nx} x {ny} points");
    if undefined > 0 {
        text += &format!(", {undefined} of them undefined (grey)");
    }
    text += &format!(". Skewness {:.2}, kurtosis {:.2}.", h.ssk, h.sku);
    match summary.waves.as_ref().map(|waves| waves.fit.as_ref().is_some_and(fits)) {
        None => text += " No spectrum: more than a quarter of the points are undefined.",
        Some(false) => text += " The spectrum is not one power law: no slope is drawn.",
        Some(true) => {}
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::surface::{Roughness, SelfAffine};
    use ndarray::Array2;

    fn figure(surface: &Surface) -> Figure {
        let summary = Summary::of(surface, Extent::Finite).unwrap();
        picture("a surface", surface, Extent::Finite, &summary, &BearingCurve::of(surface, 50).unwrap())
    }

    #[test]
    fn holes_and_flats_are_drawn_too() {
        let grid = Grid::new([20, 30], [2e-5, 3e-5]).unwrap();
        let flat = Surface::new(grid, Array2::from_elem((20, 30), 1e-6)).unwrap();
        assert!(figure(&flat).to_svg().contains("</svg>"));
        let holed = Array2::from_shape_fn((20, 30), |(i, j)| if i < 12 { f64::NAN } else { 1e-9 * j as f64 });
        let drawn = figure(&Surface::new(grid, holed).unwrap());
        assert!(drawn.caption.contains("360 of them undefined") && drawn.caption.contains("No spectrum"));
        assert_eq!(drawn.panels.len(), 3);
        assert!(drawn.to_svg().contains("</svg>"));
    }

    #[test]
    fn the_fitted_slope_is_drawn_with_its_exponent() {
        let grid = Grid::new([128, 128], [1e-3, 1e-3]).unwrap();
        let roughness = SelfAffine {
            hurst: 0.7,
            roughness: Roughness::RmsGradient(0.1),
            longest: 1e-3,
            shortest: 1.6e-5,
            roll_off: 3e-4,
            seed: 2,
        };
        let surface = Surface::new(grid, roughness.heights(&grid).unwrap()).unwrap();
        let summary = Summary::of(&surface, Extent::Periodic).unwrap();
        let fit = summary.waves.as_ref().unwrap().fit.unwrap();
        assert!((fit.hurst - 0.7).abs() < 0.1, "{fit:?}"); // some thousand waves
        let bearing = BearingCurve::of(&surface, 50).unwrap();
        let svg = picture("", &surface, Extent::Periodic, &summary, &bearing).to_svg();
        assert!(svg.contains(&format!("H = {:.2}", fit.hurst)));
    }
}
