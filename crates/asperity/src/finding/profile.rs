//! Profiles, and the isotropic maps that are made from them.

use super::surface::slope;
use super::words::{digits, si};
use super::{Finding, OUTLIERS, PROFILE_GAPS, UNLIKE_PROFILE};
use crate::surface::process::Outliers;
use crate::surface::profile::ProfileSurface;
use crate::surface::{Fill, Level, Operation, Surface};

/// Largest difference of slopes and heights that is not told. The contact area at a given load is inverse to the slope: within a
/// tenth it is known to a tenth. The rings of the spectrum of a profile give the slope of a map to 4 %.
const SHARE: f64 = 0.1;

/// The points of a profile that stand far from the straight line through their neighbours, by the rule for maps
/// ([`remove_outliers`](crate::surface::process::remove_outliers)), where they raise its rms slope by more than a tenth. `name` is the name
/// of the profile.
pub fn of_profile(name: &str, profile: &Surface) -> Option<Finding> {
    let steps = [
        Operation::Level(Level::Plane),
        Operation::RemoveOutliers(Outliers::default()),
        Operation::Fill { method: Fill::Harmonic, largest_share: 1.0 },
    ];
    let levelled = steps[0].apply(profile).ok()?;
    let cleaned = steps[1].apply(&levelled).ok()?;
    let count = cleaned.undefined() - levelled.undefined();
    let filled = steps[2].apply(&cleaned).ok()?;
    let [with, without] = [&levelled, &filled]
        .map(|surface| slope(surface.grid(), &surface.heights().to_owned(), f64::INFINITY));
    (count > 0 && with > (1.0 + SHARE) * without).then(|| {
        let text = format!(
            "{count} points of {name} stand far from the straight line through their neighbours (spikes, pits, steps): the rms \
             slope is {} with them and {} without. A map made from the profile would have them as roughness everywhere. Remove \
             them (outliers, then fill), or check that they are real.",
            digits(with),
            digits(without)
        );
        Finding::warning(OUTLIERS, with, (1.0 + SHARE) * without, text)
    })
}

/// A profile parts of which were not measured: `bridged` is the share of its length that lies in gaps, which straight lines bridge.
pub fn gaps_of_profile(name: &str, bridged: f64) -> Option<Finding> {
    (bridged > 0.0).then(|| {
        let text = format!(
            "{} % of the length of {name} lies in gaps between its points, which fills bridge by straight lines: these have no short waves, \
             so slopes are too low by about half of this share, and places in the gaps are a guess. Measure again, or crop the profile to a part \
             without gaps.",
            digits(100.0 * bridged)
        );
        Finding::warning(PROFILE_GAPS, bridged, 0.0, text)
    })
}

/// Slope and height of a map that differ from those of its profile by more than a tenth.
pub fn unlike_profile(made: &ProfileSurface) -> Vec<Finding> {
    let [held, whole] = made.rms_slope;
    let [height, whole_height] = made.rms_height;
    let [longest, shortest] = made.waves.map(|length| si(length, "m"));
    let mut found = vec![];
    if held < (1.0 - SHARE) * whole {
        let text = format!(
            "The map holds the waves of {shortest} to {longest} only. The rms slope of the profile is {} of all its waves, {} of those that \
             the map holds: areas are too large and pressures too small, unless the other waves do not matter. More cells hold shorter \
             waves, a longer map longer ones.",
            digits(whole),
            digits(held)
        );
        found.push(Finding::warning(UNLIKE_PROFILE, held, (1.0 - SHARE) * whole, text));
    }
    if height < (1.0 - SHARE) * whole_height {
        let text = format!(
            "The map has the rms height {}, the profile {}: the map holds the waves of {shortest} to {longest} only. A map as \
             long as the profile, with its spacing, holds them all.",
            si(height, "m"),
            si(whole_height, "m")
        );
        found.push(Finding::warning(UNLIKE_PROFILE, height, (1.0 - SHARE) * whole_height, text));
    }
    if (made.slope - held).abs() > SHARE * held {
        let text = format!(
            "The map has the rms slope {} along each direction, the profile {}. {}",
            digits(made.slope),
            digits(held),
            reasons(made)
        );
        let limit = held * (1.0 + SHARE.copysign(made.slope - held));
        found.push(Finding::warning(UNLIKE_PROFILE, made.slope, limit, text));
    }
    found
}

/// Why a map has another slope than its profile: its waves lie elsewhere than those of the profile; or the height of the profile was
/// given to it by its long waves, which are part of the slope.
fn reasons(made: &ProfileSurface) -> String {
    let ([height, slope], held) = (made.isotropic, made.rms_slope[0]);
    let mut found = vec![];
    if (slope - held).abs() > 0.5 * SHARE * held {
        let text =
            "The waves of the map lie elsewhere in the rings of the spectrum than those of the profile";
        found.push(format!(
            "{text}: with them the slope is {}. A longer map has more of them.",
            digits(slope)
        ));
    }
    if (made.slope - slope).abs() > 0.5 * SHARE * held {
        let [changed, way] = match made.slope < slope {
            true => ["lowered", "higher"],
            false => ["raised", "lower"],
        };
        found.push(format!(
            "An isotropic surface with the spectrum of this profile is {way}, of the rms height {} and the slope {}: to give it the \
             height of the profile, {}, the waves longer than {} were {changed}, and they are part of the slope. If the surface has a lay \
             (ground, turned), generate one with a lay, or use the profile in a line contact; if these waves are form, filter them first.",
            si(height, "m"),
            digits(slope),
            si(made.rms_height[0], "m"),
            si(made.changed_beyond, "m")
        ));
    }
    found.join(" ")
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use ndarray::Array2;

    use super::*;
    use crate::Grid;
    use crate::surface::profile::ProfileSpectrum;
    use crate::surface::statistics::rms_gradient;
    use crate::surface::{Roughness, SelfAffine};

    /// Heights every micrometre.
    fn line(heights: &[f64]) -> Surface {
        let n = heights.len();
        let column = Array2::from_shape_vec((n, 1), heights.to_vec()).unwrap();
        Surface::new(Grid::line(n, 1e-6 * n as f64).unwrap(), column).unwrap()
    }

    fn map(heights: &[f64], cells: usize, size: f64) -> (Grid, ProfileSurface) {
        let grid = Grid::new([cells; 2], [size; 2]).unwrap();
        (grid, ProfileSpectrum::of(heights, 1e-6, true, 16).unwrap().surface(&grid, 1).unwrap())
    }

    /// A line of an isotropic rough surface.
    fn rough(seed: u64) -> Vec<f64> {
        let grid = Grid::new([512, 512], [5.12e-4; 2]).unwrap();
        let roughness = Roughness::RmsHeight(2e-7);
        let surface =
            SelfAffine { hurst: 0.8, roughness, longest: 2.5e-4, shortest: 8e-6, roll_off: 1e-4, seed };
        surface.heights(&grid).unwrap().column(100).to_vec()
    }

    fn told(made: &ProfileSurface) -> Vec<f64> {
        unlike_profile(made).into_iter().map(|finding| finding.value.unwrap()).collect()
    }

    #[test]
    fn a_map_of_one_sine_is_told_and_one_of_a_rough_surface_is_not() {
        let sine: Vec<f64> = (0..500).map(|i| 1e-6 * (TAU * f64::from(i) / 50.0).sin()).collect();
        let (grid, made) = map(&sine, 500, 5e-4);
        // Slope of the sine, 1e-6 q / 2^(1/2), in the middle of its ring: to half of its width, 1/32 of a decade.
        let slope = 1e-6 * TAU / 50e-6 / 2f64.sqrt();
        assert!((made.rms_slope[1] / slope - 1.0).abs() < 0.08, "{:?}", made.rms_slope);
        // Of the map by differences of cells, 50 to a wave: they are lower by 1 - (sin(q/2)/(q/2))^2 < 1 %; and by direction.
        let found = rms_gradient(&grid, made.heights.view()).unwrap() / 2f64.sqrt();
        assert!((made.slope / found - 1.0).abs() < 0.03, "{} {found}", made.slope);
        assert_eq!(told(&made), [made.slope]);
        assert!(made.slope < 0.8 * slope);
        // Without the height of the profile the map has its slope, and the text says that the height took it away.
        assert!((made.isotropic[1] / made.rms_slope[0] - 1.0).abs() < 0.05, "{made:?}");
        assert!(made.isotropic[0] > made.rms_height[0], "{made:?}");
        let [finding] = &unlike_profile(&made)[..] else { panic!("{made:?}") };
        assert!(
            finding.text.contains("were lowered") && !finding.text.contains("lie elsewhere"),
            "{finding}"
        );
        for seed in 0..4 {
            let (_, made) = map(&rough(seed), 512, 5.12e-4);
            assert_eq!(told(&made), [0.0; 0], "{seed}: {made:?}");
        }
    }

    #[test]
    fn waves_that_the_map_leaves_out_are_told() {
        let z = rough(1);
        // Cells of 32 um: waves of 64 um and more. A side of 64 um leaves out the long ones.
        let (_, coarse) = map(&z, 16, 5.12e-4);
        let (_, short) = map(&z, 64, 6.4e-5);
        assert!(told(&coarse).contains(&coarse.rms_slope[0]), "{coarse:?}");
        assert!(told(&short).contains(&short.rms_height[0]), "{short:?}");
    }

    #[test]
    fn spikes_and_steps_of_a_profile_are_told_with_the_slope_that_they_make() {
        let z = rough(2);
        // The straight line of a profile has its own slope.
        let tilted: Vec<f64> = z.iter().enumerate().map(|(i, z)| z + 0.3e-6 * i as f64).collect();
        assert_eq!([of_profile("it", &line(&z)), of_profile("it", &line(&tilted))], [None, None]);
        for (from, to, high) in [(200, 201, 1e-5), (200, 203, -1e-5), (200, 512, 1e-5)] {
            let mut z = tilted.clone();
            z[from..to].iter_mut().for_each(|z| *z += high);
            let found = of_profile("it", &line(&z)).unwrap();
            // Edges of `high` from one cell to the next over 511 differences; the roughness is a hundredth of their square.
            let edges = if to < 512 { 2.0 } else { 1.0 };
            let slope = (edges / 511.0f64).sqrt() * 10.0;
            // The straight line through a step takes 3 steps over the length: 3 % of an edge.
            assert!((found.value.unwrap() / slope - 1.0).abs() < 0.05, "{found:?} {slope}");
            assert_eq!(found.code, OUTLIERS);
        }
    }
}
