//! The picture of a surface: height map, power spectrum, height distribution and bearing curve.

use std::f64::consts::TAU;

use asperity::surface::Surface;
use asperity::surface::statistics::{BearingCurve, Summary, height_distribution};

use crate::figure::{Axis, Colours, Curves, Figure, Map, Series, Style};

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
/// let figure = asperity_report::surface::picture("rough", &surface, &summary, &BearingCurve::of(&surface, 100)?);
/// assert_eq!(figure.panels.len(), 4);
/// assert!(figure.to_svg().contains("height [µm]"));
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn picture(title: &str, surface: &Surface, summary: &Summary, bearing: &BearingCurve) -> Figure {
    let size = surface.grid().size();
    let map = Map::new("Heights", ["height", "m"], Colours::Sequential, surface.heights(), size);
    let mut figure = Figure::new(title).with(map);
    if let Some(waves) = &summary.waves {
        figure = figure.with(spectrum(waves));
    }
    // A flat has no density.
    if let Ok((heights, density)) = height_distribution(surface, BINS) {
        figure = figure.with(distribution(summary, heights, density));
    }
    let shares: Vec<f64> = bearing.share.iter().map(|share| 100.0 * share).collect();
    let curve = Curves::new(
        "Bearing area",
        Axis::linear("share of the surface above [%]", "").between(0.0, 100.0),
        Axis::linear("height", "m"),
    )
    .with(Series::new("", Style::Line, shares, bearing.heights.clone()));
    figure.with(curve).caption(caption(surface, summary))
}

fn spectrum(waves: &asperity::surface::statistics::Waves) -> Curves {
    let spectrum = &waves.spectrum;
    let largest = spectrum.power.iter().copied().fold(0.0, f64::max);
    let kept: Vec<usize> =
        (0..spectrum.power.len()).filter(|n| spectrum.power[*n] > ROUNDING * largest).collect();
    let pick = |values: &[f64]| kept.iter().map(|n| values[*n]).collect::<Vec<f64>>();
    let (q, power) = (pick(&spectrum.wave_number), pick(&spectrum.power));
    let (title, along) = match waves.lay.is_clear() {
        true => ("Power spectrum, average over ellipses", "wave number across the lay"),
        false => ("Power spectrum, radial average", "wave number"),
    };
    let mut curves = Curves::new(title, Axis::log(along, "1/m"), Axis::log("power", "m4")).with(Series::new(
        "",
        Style::Points,
        q.clone(),
        power,
    ));
    if let (Some(fit), Some(first), Some(last)) = (&waves.fit, q.first(), q.last()) {
        let bend = TAU / fit.roll_off;
        let at = |q: f64| fit.plateau * (q / bend).max(1.0).powf(-2.0 * (1.0 + fit.hurst));
        let places: Vec<f64> =
            [*first, bend, *last].into_iter().filter(|q| (*first..=*last).contains(q)).collect();
        let values: Vec<f64> = places.iter().map(|q| at(*q)).collect();
        let name = format!("H = {:.2} \u{b1} {:.2}", fit.hurst, fit.error);
        curves = curves.with(Series::new(name, Style::Dashed, places, values));
    }
    curves
}

fn distribution(summary: &Summary, heights: Vec<f64>, density: Vec<f64>) -> Curves {
    let (mean, sq) = (summary.heights.mean, summary.heights.sq);
    let gauss = |z: f64| (-0.5 * ((z - mean) / sq).powi(2)).exp() / (sq * TAU.sqrt());
    let normal: Vec<f64> = heights.iter().map(|z| gauss(*z)).collect();
    let highest = density.iter().chain(&normal).copied().fold(0.0, f64::max);
    // Nothing to draw for an empty bin; room for the legend above the curves.
    let density: Vec<f64> = density.into_iter().map(|d| if d > 0.0 { d } else { f64::NAN }).collect();
    let up = Axis::linear("density", "1/m").between(0.0, 1.25 * highest);
    Curves::new("Height distribution", Axis::linear("height", "m"), up)
        .with(Series::new("", Style::Bars, heights.clone(), density))
        .with(Series::new("Gaussian of the same Sq", Style::Reference, heights, normal))
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
    if summary.waves.is_none() {
        text += " No spectrum: more than a quarter of the points are undefined.";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::Grid;
    use asperity::surface::statistics::Extent;
    use asperity::surface::{Roughness, SelfAffine};
    use ndarray::Array2;

    fn figure(surface: &Surface) -> Figure {
        let summary = Summary::of(surface, Extent::Finite).unwrap();
        picture("a surface", surface, &summary, &BearingCurve::of(surface, 50).unwrap())
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
        let svg = picture("", &surface, &summary, &BearingCurve::of(&surface, 50).unwrap()).to_svg();
        assert!(svg.contains(&format!("H = {:.2}", fit.hurst)));
    }
}
