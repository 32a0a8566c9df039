//! Vertical shift factors from measured isotherms whose times follow a known shift.
//!
//! At the distance of the shift, the curves of each pair of neighbours have one polynomial per quantity and one factor between
//! them ([`align::raised`]). Factors are multiplied from the reference on. The variances of their logarithms are added; they
//! include the effect of the uncertainty of the shift along the slope of the curves.

use super::{Abscissa, Isotherm, Result, Shift, align, kelvin, pairs, sorted};
use crate::error::Error;
use crate::material::VerticalShift;
use crate::material::shift::interpolated;
use std::f64::consts::LN_10;

/// Vertical shift factors found from isotherms.
#[derive(Clone, Debug, PartialEq)]
pub struct VerticalEstimate {
    /// The factors as a table, b_T = 1 at the reference temperature of the shift.
    pub vertical: VerticalShift,
    /// Relative standard deviation of each factor, in the order of the table; 0 at the isotherm nearest to the reference.
    pub uncertainty: Vec<f64>,
}

/// Standard deviation of ln b_T beyond which it is refused: a factor of two.
const MOST_UNCERTAIN_MODULUS: f64 = std::f64::consts::LN_2;

/// Factors by which the moduli of isotherms change with temperature if their times follow a `shift` whose factors have these
/// standard deviations \[decades\], in order of temperature (empty if the shift is known). The factor of a compliance applies to
/// its values: it is one over that of the modulus.
///
/// ```
/// use asperity::material::{Abscissa, Isotherm, Shift, estimate_vertical};
/// // A rubber that is 20 % stiffer at the warmer temperature, and ten times as fast.
/// let x: Vec<f64> = (0..13).map(|k| 10f64.powf(k as f64 / 4.0)).collect();
/// let curve = |a: f64, b: f64| vec![x.iter().map(|t| 1e6 / (1.0 + (t / a).powf(0.3)) / b).collect()];
/// let cold = Isotherm { temperature: 290.0, x: x.clone(), curves: curve(10.0, 1.2) };
/// let warm = Isotherm { temperature: 300.0, x: x.clone(), curves: curve(1.0, 1.0) };
/// let shift = Shift::Table { points: vec![(290.0, 10f64.ln()), (300.0, 0.0)] };
/// let found = estimate_vertical(&[cold, warm], Abscissa::Time, &shift, &[])?;
/// assert!((found.vertical.factor(290.0)? / 1.2 - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] as [`estimate_shift`](crate::material::estimate_shift); if the shift is not defined at a temperature; if a
/// factor is uncertain by more than a factor of two, naming the pair of isotherms with the least information.
pub fn estimate_vertical(
    isotherms: &[Isotherm],
    abscissa: Abscissa,
    shift: &Shift,
    uncertainty: &[f64],
) -> Result<VerticalEstimate> {
    let sorted = sorted(isotherms)?;
    let ln: Vec<f64> = sorted.iter().map(|i| shift.ln_factor(i.temperature)).collect::<Result<_>>()?;
    // Variances of factors add up from the reference: their differences are those of the pairs.
    let variance = |k: usize| uncertainty.get(k).map_or(0.0, |decades| (LN_10 * decades).powi(2));
    let (mut value, mut deviation) = (vec![0.0], vec![0.0]);
    for (k, pair) in sorted.windows(2).enumerate() {
        let raised = align::raised(&pairs(pair[0], pair[1], abscissa), ln[k] - ln[k + 1]);
        let time = (variance(k + 1) - variance(k)).abs() * raised.slope * raised.slope;
        value.push(value[k] + raised.value);
        deviation.push((raised.deviation.powi(2) + time).sqrt());
    }
    let temperatures: Vec<f64> = sorted.iter().map(|isotherm| isotherm.temperature).collect();
    let reference = shift.reference().unwrap_or(temperatures[0]);
    let distance = |k: &usize| (temperatures[*k] - reference).abs();
    let anchor = (0..temperatures.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    let uncertainty: Vec<f64> = (0..temperatures.len())
        .map(|k| {
            let between = if k < anchor { k + 1..=anchor } else { anchor + 1..=k };
            between.map(|pair| deviation[pair] * deviation[pair]).sum::<f64>().sqrt()
        })
        .collect();
    let worst = (1..deviation.len()).max_by(|a, b| deviation[*a].total_cmp(&deviation[*b])).unwrap_or(1);
    if uncertainty.iter().any(|ln| ln.is_nan() || *ln > MOST_UNCERTAIN_MODULUS) {
        let [cold, warm] = [temperatures[worst - 1], temperatures[worst]].map(kelvin);
        return Err(Error::invalid(
            format!("factor between the moduli of the isotherms at {cold} and {warm}"),
            format!("uncertain by a factor of {:.1}", libm::exp(deviation[worst].min(7.0))),
            "known to a factor of 2: isotherms that overlap at these shift factors; correct by the density instead, or leave \
             vertical shifts out",
        ));
    }
    let points: Vec<(f64, f64)> = temperatures.iter().copied().zip(value).collect();
    let zero = interpolated(&points, reference);
    let vertical = VerticalShift::Table { points: points.iter().map(|(t, ln)| (*t, ln - zero)).collect() };
    vertical.validate()?;
    Ok(VerticalEstimate { vertical, uncertainty })
}
