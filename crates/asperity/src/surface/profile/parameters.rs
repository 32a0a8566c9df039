//! Parameters of a profile (ISO 21920-2:2021) and the filter before them (ISO 16610-21:2011).
//!
//! ```text
//! Ra = <|z|>, Rq = <z^2>^1/2, Rsk = <z^3>/Rq^3, Rku = <z^4>/Rq^4      z about its mean line
//! Rz = mean over five sections of highest less lowest height, Rt = the same of the whole profile
//! Rsm = mean length of a profile element, a peak and the pit after it
//! Rdq = <(dz/dx)^2>^1/2, dz/dx = (z_3 - 9 z_2 + 45 z_1 - 45 z_-1 + 9 z_-2 - z_-3)/(60 dx)
//! ```
//!
//! A peak or pit counts for Rsm if its distance from the mean line is larger than a tenth of Rz. Without [`roughness`] before,
//! these are the parameters of the primary profile (Pa, Pq, ...).

use std::f64::consts::{LN_2, PI};

use super::super::spectrum::check_defined;
use crate::error::{Result, positive, require};
use crate::numbers::extent;

/// Sections of a profile, for Rz.
const SECTIONS: usize = 5;
/// Fraction of Rz beyond which a peak or a pit counts.
const COUNTS: f64 = 0.1;

/// Parameters of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileParameters {
    /// Ra: mean of the absolute height \[m\].
    pub ra: f64,
    /// Rq: root mean square of the height \[m\].
    pub rq: f64,
    /// Rz: highest minus lowest height, mean over five sections \[m\].
    pub rz: f64,
    /// Rt: highest minus lowest height \[m\].
    pub rt: f64,
    /// Rsk: skewness; 0 for a flat.
    pub rsk: f64,
    /// Rku: kurtosis; 0 for a flat.
    pub rku: f64,
    /// Rsm: mean length of a profile element \[m\]; `None` if there is no complete one.
    pub rsm: Option<f64>,
    /// Rdq: root mean square of the slope; `None` for fewer than seven points.
    pub rdq: Option<f64>,
}

impl ProfileParameters {
    /// From evenly spaced heights \[m\], relative to their mean.
    ///
    /// ```
    /// use asperity::surface::ProfileParameters;
    /// let sine: Vec<f64> = (0..1000).map(|i| (0.02 * std::f64::consts::PI * f64::from(i)).sin()).collect();
    /// let found = ProfileParameters::of(&sine, 1e-6)?;
    /// assert!((found.rq - 0.5f64.sqrt()).abs() < 1e-12);
    /// assert!((found.rku - 1.5).abs() < 1e-12);
    /// assert!((found.rsm.unwrap() / 100e-6 - 1.0).abs() < 1e-2); // a hundred points
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for fewer than five heights, undefined ones, or a spacing that is not positive.
    pub fn of(heights: &[f64], spacing: f64) -> Result<ProfileParameters> {
        positive("spacing of the profile", spacing, "m")?;
        check(heights, SECTIONS)?;
        let n = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / n;
        let z: Vec<f64> = heights.iter().map(|z| z - mean).collect();
        let moment = |power: i32| z.iter().map(|z| z.powi(power)).sum::<f64>() / n;
        let rq = moment(2).sqrt();
        let range = |part: &[f64]| {
            let [low, high] = extent(part.iter().copied());
            high - low
        };
        let sections = (0..SECTIONS).map(|k| &z[k * z.len() / SECTIONS..(k + 1) * z.len() / SECTIONS]);
        let rz = sections.map(range).sum::<f64>() / SECTIONS as f64;
        let over = |moment: f64, power: i32| if rq > 0.0 { moment / rq.powi(power) } else { 0.0 };
        Ok(ProfileParameters {
            ra: z.iter().map(|z| z.abs()).sum::<f64>() / n,
            rq,
            rz,
            rt: range(&z),
            rsk: over(moment(3), 3),
            rku: over(moment(4), 4),
            rsm: element_length(&z, COUNTS * rz).map(|points| points * spacing),
            rdq: slope(&z).map(|slope| slope / spacing),
        })
    }
}

/// Mean number of points of a profile element: from the point at which the height rises above `limit` to the next such point
/// after it has been below -`limit`.
fn element_length(z: &[f64], limit: f64) -> Option<f64> {
    let (mut below, mut starts) = (false, vec![]);
    for (i, z) in z.iter().enumerate() {
        if *z < -limit {
            below = true;
        } else if *z > limit && below {
            starts.push(i);
            below = false;
        }
    }
    let (first, last) = (starts.first()?, starts.last()?);
    (starts.len() > 1).then(|| (last - first) as f64 / (starts.len() - 1) as f64)
}

/// Root mean square of the slope, for a spacing of 1.
fn slope(z: &[f64]) -> Option<f64> {
    let slope = |w: &[f64]| (w[6] - 9.0 * w[5] + 45.0 * w[4] - 45.0 * w[2] + 9.0 * w[1] - w[0]) / 60.0;
    let slopes = z.windows(7);
    let count = slopes.len();
    (count > 0).then(|| (slopes.map(|w| slope(w).powi(2)).sum::<f64>() / count as f64).sqrt())
}

/// Heights \[m\] minus their Gaussian mean line of this cut-off \[m\]; waves of the cut-off wavelength keep half their amplitude.
/// At the ends the weights are those inside, scaled to a sum of 1.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) for undefined heights, or where spacing or cut-off are not positive,
/// or the cut-off is below two points or above the length of the profile, which has no such waves.
pub fn roughness(heights: &[f64], spacing: f64, cutoff: f64) -> Result<Vec<f64>> {
    positive("spacing of the profile", spacing, "m")?;
    positive("cut-off of the profile", cutoff, "m")?;
    check(heights, 1)?;
    let (shortest, longest) = (2.0 * spacing, spacing * heights.len() as f64);
    require(
        (shortest * (1.0 - 1e-9)..=longest * (1.0 + 1e-9)).contains(&cutoff),
        "cut-off of the profile",
        format!("{cutoff:e} m"),
        format!(
            "between {shortest:e} m (two points) and {longest:e} m (the length): the profile has no waves beyond; leave it out"
        ),
    )?;
    let width = (LN_2 / PI).sqrt() * cutoff / spacing; // alpha lambda_c, in points
    // Beyond, a weight is below 1e-13 of the largest.
    let reach = ((3.1 * width).ceil() as usize).min(heights.len());
    let weights: Vec<f64> = (0..=reach).map(|k| libm::exp(-PI * (k as f64 / width).powi(2))).collect();
    let less_mean = |(i, z): (usize, &f64)| {
        let part = i.saturating_sub(reach)..(i + reach + 1).min(heights.len());
        let (sum, weight) = part.fold((0.0, 0.0), |(sum, total), j| {
            let weight = weights[i.abs_diff(j)];
            (sum + weight * heights[j], total + weight)
        });
        z - sum / weight
    };
    Ok(heights.iter().enumerate().map(less_mean).collect())
}

/// Refuses undefined heights, and fewer than `least`.
pub(super) fn check(heights: &[f64], least: usize) -> Result<()> {
    require(
        heights.len() >= least,
        "number of heights of the profile",
        heights.len(),
        format!("{least} at least"),
    )?;
    check_defined(heights.iter())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(points: usize, length: usize) -> Vec<f64> {
        (0..points).map(|i| (std::f64::consts::TAU * i as f64 / length as f64).sin()).collect()
    }

    #[test]
    fn a_sine_has_the_parameters_of_a_sine() {
        let found = ProfileParameters::of(&sine(20_000, 1000), 1e-6).unwrap();
        // Sums over whole periods: rounding; the extremes lie on points.
        // A kink at each zero: h^2/(6 pi) with h = 2 pi/1000.
        assert!((found.ra - 2.0 / PI).abs() < 3e-6, "{found:?}");
        assert!((found.rz - 2.0).abs() < 1e-9 && (found.rt - 2.0).abs() < 1e-9);
        assert!(found.rsk.abs() < 1e-12);
        assert_eq!(found.rsm, Some(1000.0 * 1e-6));
        // The formula is of sixth order in 2 pi/1000; six of 20000 slopes, the steepest, are missing at the ends.
        let slope = std::f64::consts::TAU / 1e-3 * 0.5f64.sqrt();
        assert!((found.rdq.unwrap() / slope - 1.0).abs() < 3e-4, "{found:?}");
    }

    #[test]
    fn small_peaks_do_not_count_as_elements() {
        // A ripple of 5 % of Rz on a wave of 200 points.
        let z: Vec<f64> =
            sine(4000, 200).iter().zip(sine(4000, 10)).map(|(wave, ripple)| wave + 0.05 * ripple).collect();
        let found = ProfileParameters::of(&z, 1.0).unwrap();
        assert!((found.rsm.unwrap() - 200.0).abs() < 1.0, "{found:?}"); // an end is known to a few points of many periods
        assert_eq!(ProfileParameters::of(&[1.0; 10], 1.0).unwrap().rsm, None);
        assert_eq!(ProfileParameters::of(&[1.0; 6], 1.0).unwrap().rdq, None);
    }

    #[test]
    fn the_filter_keeps_half_of_a_wave_of_the_cut_off() {
        let kept = |length: usize| {
            let z = roughness(&sine(6000, length), 1.0, 100.0).unwrap();
            // Away from the ends, whole periods.
            let inside = &z[1500..4500];
            (2.0 * inside.iter().map(|z| z * z).sum::<f64>() / inside.len() as f64).sqrt()
        };
        assert!((kept(100) - 0.5).abs() < 1e-9, "{}", kept(100));
        // 1 - exp(-pi (alpha cutoff / length)^2)
        let wanted = 1.0 - (-LN_2 * (100.0f64 / 300.0).powi(2)).exp();
        assert!((kept(300) - wanted).abs() < 1e-9);
        assert!(roughness(&[0.0, f64::NAN], 1.0, 1.0).is_err() && roughness(&[0.0], 1.0, 0.0).is_err());
    }
}
