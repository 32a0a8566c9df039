//! The undeformed surface: heights without form, their spectrum and statistics.

use asperity::Boundary;
use asperity::surface::process::window_for_spectrum;
use asperity::surface::statistics::{HeightStatistics, RadialSpectrum, Rings, SlopeStatistics};
use asperity::surface::{Level, Surface, level};
use asperity_io::readable::quantity;
use asperity_io::store::{Reader, StoreError};
use ndarray::Array2;
use serde_json::{Value, json};

use crate::result::boundary;
use crate::surface::roughness;

/// Roughness below this share of the gap's range is rounding.
const SMOOTH: f64 = 1e-9;

/// Heights without their form, and what is said of them; `None` for smooth or mostly undefined surfaces. A surface that repeats has
/// no form but its mean; of any other it is the best-fitting paraboloid.
pub(super) fn surface(reader: &Reader) -> Result<Option<(Array2<f64>, Value)>, StoreError> {
    if reader.header().grid.is_line() {
        return Ok(None);
    }
    // Heights of one rough surface against a plane: the gap upside down.
    let gap = reader.initial_gap()?;
    let periodic = boundary(reader) == Boundary::Periodic;
    let (form, words) = match periodic {
        true => (Level::Mean, "mean"),
        false => (Level::Quadratic, "best-fitting paraboloid"),
    };
    let Ok(heights) = level(gap.mapv(|h| -h).view(), form) else { return Ok(None) };
    let Ok(map) = Surface::new(reader.header().grid, heights.clone()) else { return Ok(None) };
    let Ok(statistics) = HeightStatistics::of(&map) else { return Ok(None) };
    let highest = gap.iter().copied().filter(|h| h.is_finite()).fold(0.0, f64::max);
    if statistics.sq <= SMOOTH * highest {
        return Ok(None);
    }
    let mut lines = vec![
        ("Sq, rms height", quantity(statistics.sq, "m")),
        ("Sa, mean height", quantity(statistics.sa, "m")),
        ("Sz, height range", quantity(statistics.sz, "m")),
        ("Ssk, skewness", quantity(statistics.ssk, "")),
        ("Sku, kurtosis", quantity(statistics.sku, "")),
    ];
    if let Ok(slopes) = SlopeStatistics::of(&map) {
        lines.push(("Sdq, rms slope", quantity(slopes.sdq, "")));
        lines.push(("Sdr, developed area ratio", format!("{} %", quantity(100.0 * slopes.sdr, ""))));
    }
    let seen = if periodic { map } else { window_for_spectrum(&map) };
    let spectrum = RadialSpectrum::of(&seen, Rings::PerDecade(16)).ok();
    let note = format!(
        "Heights: the undeformed gap upside down, less its {words}.{}",
        if spectrum.is_some() && !periodic {
            " The spectrum is of the heights under a Hann window."
        } else {
            ""
        }
    );
    let (wave_number, power) = spectrum.as_ref().map(roughness).unzip();
    let value = json!({
        "note": note,
        "statistics": lines,
        "wave_number": wave_number,
        "power": power,
    });
    Ok(Some((heights, value)))
}
