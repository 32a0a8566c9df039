//! Time-temperature superposition: the dependence of the times of a material on temperature.
//!
//! In a thermorheologically simple material all times scale by one shift factor a_T: E(t, T) = E(t/a_T, T_r) and E*(omega, T) =
//! E*(omega a_T, T_r). Above the glass transition a_T follows M. L. Williams, R. F. Landel & J. D. Ferry, J. Am. Chem. Soc. 77
//! (1955) 3701, log10 a_T = -c1 (T - T_r) / (c2 + T - T_r), and otherwise often S. Arrhenius, ln a_T = (E_a/R) (1/T - 1/T_r).

use crate::error::{Error, Result, increasing, kelvin, positive, require};
use std::f64::consts::LN_10;

/// Gas constant R \[J/(mol K)\], exact in the SI of 2019.
pub const GAS_CONSTANT: f64 = 8.314_462_618_153_24;

/// A shift factor a_T as a function of temperature \[K\].
///
/// ```
/// use asperity::material::Shift;
/// // Ten kelvin above the glass transition many polymers are about 700 times faster.
/// let shift = Shift::universal(373.15);
/// assert!((1.0 / shift.factor(383.15)? - 678.0).abs() < 1.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Shift {
    /// log10 a_T = -c1 (T - T_r) / (c2 + T - T_r), for T > T_r - c2.
    Wlf {
        /// c1, without unit.
        c1: f64,
        /// c2 \[K\].
        c2: f64,
        /// T_r \[K\].
        reference: f64,
    },
    /// ln a_T = (E_a/R) (1/T - 1/T_r).
    Arrhenius {
        /// E_a \[J/mol\].
        activation_energy: f64,
        /// T_r \[K\].
        reference: f64,
    },
    /// ln a_T, linear between (temperature \[K\], ln a_T) points in order of temperature.
    Table {
        /// The points; one of them is (T_r, 0) for a reference temperature of that name.
        points: Vec<(f64, f64)>,
    },
}

impl Shift {
    /// The WLF equation with the constants common to many polymers, c1 = 17.44 and c2 = 51.6 K, relative to the glass transition
    /// temperature \[K\].
    pub fn universal(glass_transition: f64) -> Self {
        Shift::Wlf { c1: 17.44, c2: 51.6, reference: glass_transition }
    }

    /// Checks the constants.
    ///
    /// # Errors
    /// [`Error::Invalid`] if a constant is not finite and positive, or a table has fewer than two
    /// points or points out of order.
    pub fn validate(&self) -> Result<()> {
        match self {
            Shift::Wlf { c1, c2, reference } => {
                positive("c1 of the WLF shift", *c1, "")?;
                positive("c2 of the WLF shift", *c2, "K")?;
                positive("reference temperature of the WLF shift", *reference, "K").map(|_| ())
            }
            Shift::Arrhenius { activation_energy, reference } => {
                positive("activation energy of the Arrhenius shift", *activation_energy, "J/mol")?;
                positive("reference temperature of the Arrhenius shift", *reference, "K").map(|_| ())
            }
            Shift::Table { points } => validate_table(points),
        }
    }

    /// ln a_T at the temperature \[K\].
    ///
    /// # Errors
    /// [`Error::Invalid`] as [`Shift::validate`], and for a temperature where the shift is not defined:
    /// not positive, not above T_r - c2 (WLF), or outside the table.
    pub fn ln_factor(&self, temperature: f64) -> Result<f64> {
        self.validate()?;
        let [low, high] = self.domain();
        positive("temperature", temperature, "K (absolute)")?;
        let inside = match self {
            Shift::Table { .. } => temperature >= low && temperature <= high,
            _ => temperature > low,
        };
        if !inside {
            return Err(Error::invalid(
                "temperature",
                kelvin(temperature),
                match self {
                    Shift::Table { .. } => {
                        format!("from {} to {}, as the shift factors are", kelvin(low), kelvin(high))
                    }
                    _ => format!("above {}, where the WLF shift T_r - c2 diverges", kelvin(low)),
                },
            ));
        }
        Ok(self.ln_factor_unchecked(temperature))
    }

    /// a_T at the temperature \[K\]: processes take a_T times as long as at the reference temperature.
    ///
    /// # Errors
    /// As [`Shift::ln_factor`].
    pub fn factor(&self, temperature: f64) -> Result<f64> {
        self.ln_factor(temperature).map(f64::exp)
    }

    /// The same law relative to another reference temperature \[K\]: a_T is 1 there.
    ///
    /// ```
    /// use asperity::material::Shift;
    /// // Ferry: c1' = c1 c2 / (c2 + T' - T), c2' = c2 + T' - T.
    /// let moved = Shift::universal(373.15).about(423.15)?;
    /// let Shift::Wlf { c1, c2, .. } = moved else { unreachable!() };
    /// assert!((c2 - 101.6).abs() < 1e-12 && (c1 - 8.8573).abs() < 1e-4);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Shift::ln_factor`].
    pub fn about(&self, temperature: f64) -> Result<Self> {
        let zero = self.ln_factor(temperature)?;
        Ok(match self {
            Shift::Wlf { c1, c2, reference } => {
                let moved = c2 + temperature - reference;
                Shift::Wlf { c1: c1 * c2 / moved, c2: moved, reference: temperature }
            }
            Shift::Arrhenius { activation_energy, .. } => {
                Shift::Arrhenius { activation_energy: *activation_energy, reference: temperature }
            }
            Shift::Table { points } => {
                Shift::Table { points: points.iter().map(|(t, ln)| (*t, ln - zero)).collect() }
            }
        })
    }

    /// The temperature at which a_T is 1 \[K\]: the reference of a law, or the temperature at which the factors of a table pass
    /// 1, if any.
    pub fn reference(&self) -> Option<f64> {
        match self {
            Shift::Wlf { reference, .. } | Shift::Arrhenius { reference, .. } => Some(*reference),
            Shift::Table { points } => {
                let exact = points.iter().find(|point| point.1 == 0.0).map(|point| point.0);
                exact.or_else(|| {
                    let pair = points.windows(2).find(|pair| pair[0].1 * pair[1].1 < 0.0)?;
                    Some(pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1))
                })
            }
        }
    }

    /// ln a_T inside the domain.
    pub(super) fn ln_factor_unchecked(&self, temperature: f64) -> f64 {
        match self {
            Shift::Wlf { c1, c2, reference } => {
                let warmer = temperature - reference;
                -LN_10 * c1 * warmer / (c2 + warmer)
            }
            Shift::Arrhenius { activation_energy, reference } => {
                // 1/T - 1/T_r without cancellation.
                activation_energy / GAS_CONSTANT * (reference - temperature) / (temperature * reference)
            }
            Shift::Table { points } => interpolated(points, temperature),
        }
    }

    /// Lower and upper end of the temperatures; the laws are singular at the lower one.
    pub(super) fn domain(&self) -> [f64; 2] {
        match self {
            Shift::Wlf { c2, reference, .. } => [(reference - c2).max(0.0), f64::INFINITY],
            Shift::Arrhenius { .. } => [0.0, f64::INFINITY],
            Shift::Table { points } => [points[0].0, points[points.len() - 1].0],
        }
    }
}

fn validate_table(points: &[(f64, f64)]) -> Result<()> {
    require(points.len() >= 2, "number of shift factors", points.len(), "at least 2")?;
    validate_points(points)?;
    increasing_temperatures("shift factor", points)
}

fn validate_points(points: &[(f64, f64)]) -> Result<()> {
    for (n, (temperature, ln)) in points.iter().enumerate() {
        positive(&format!("temperature of shift factor {}", n + 1), *temperature, "K (absolute)")?;
        if !ln.is_finite() {
            return Err(Error::invalid(format!("logarithm of shift factor {}", n + 1), ln, "finite"));
        }
    }
    Ok(())
}

/// Checks that the temperatures of a table increase; `factor` names one of its points.
pub(super) fn increasing_temperatures(factor: &str, points: &[(f64, f64)]) -> Result<()> {
    let name = |n: usize| format!("temperature of {factor} {}", n + 1);
    increasing(points.iter().map(|point| point.0), name, kelvin)
}

/// Linear between the points of a table, constant beyond its ends.
pub(super) fn interpolated(points: &[(f64, f64)], temperature: f64) -> f64 {
    let [first, .., last] = points else { return points.first().map_or(0.0, |point| point.1) };
    let temperature = temperature.clamp(first.0, last.0);
    let next = points.partition_point(|p| p.0 <= temperature).clamp(1, points.len() - 1);
    let ((t0, v0), (t1, v1)) = (points[next - 1], points[next]);
    v0 + (v1 - v0) * (temperature - t0) / (t1 - t0)
}

/// A law fitted to shift factors.
#[derive(Clone, Debug, PartialEq)]
pub struct ShiftFit {
    /// The law.
    pub shift: Shift,
    /// Root mean square of its deviation from the factors, in decades (log10 a_T).
    pub rms: f64,
}

/// The WLF equation through (temperature \[K\], ln a_T) points, with a_T = 1 at `reference` \[K\].
///
/// ```
/// use asperity::material::{Shift, fit_wlf};
/// let law = Shift::universal(373.15);
/// let points: Vec<(f64, f64)> =
///     [373.15, 383.15, 393.15, 413.15].iter().map(|t| (*t, law.ln_factor(*t).unwrap())).collect();
/// let fit = fit_wlf(&points, 373.15)?;
/// let Shift::Wlf { c1, c2, .. } = fit.shift else { unreachable!() };
/// assert!((c1 / 17.44 - 1.0).abs() < 1e-6 && (c2 / 51.6 - 1.0).abs() < 1e-6 && fit.rms < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if there are fewer than three points besides the reference, or if relaxation is not faster at higher
/// temperatures.
pub fn fit_wlf(points: &[(f64, f64)], reference: f64) -> Result<ShiftFit> {
    let points = usable(points, reference, 3)?;
    let coldest = points.iter().map(|p| reference - p.0).fold(0.0, f64::max);
    // For a given c2 the best c1 is a linear regression. The remaining unknown is c2, which is searched on a logarithmic scale
    // above the smallest value that the coldest point allows.
    let at = |c2: f64| {
        let slope = |t: f64| -LN_10 * (t - reference) / (c2 + t - reference);
        let c1 = regression(&points, slope);
        (c1, rms(&points, |t| c1 * slope(t)))
    };
    let c2_of = |u: f64| coldest + u.exp();
    let (low, high) = (1e-3f64.ln(), 1e5f64.ln());
    let u = minimise(low, high, 400, |u| at(c2_of(u)).1);
    let ((c1, rms), c2) = (at(c2_of(u)), c2_of(u));
    let shift = Shift::Wlf { c1, c2, reference };
    slower_when_colder(c1)?;
    shift.validate()?;
    Ok(ShiftFit { shift, rms })
}

/// The Arrhenius law through (temperature \[K\], ln a_T) points, with a_T = 1 at `reference` \[K\].
///
/// ```
/// use asperity::material::{GAS_CONSTANT, Shift, fit_arrhenius};
/// // Twice as fast from 300 K to 310 K.
/// let fit = fit_arrhenius(&[(300.0, 0.0), (310.0, -(2f64.ln()))], 300.0)?;
/// let Shift::Arrhenius { activation_energy, .. } = fit.shift else { unreachable!() };
/// let exact = GAS_CONSTANT * 2f64.ln() / (1.0 / 300.0 - 1.0 / 310.0);
/// assert!((activation_energy / exact - 1.0).abs() < 1e-12); // 53.6 kJ/mol
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if there is no point besides the reference, or if relaxation is not faster at higher temperatures.
pub fn fit_arrhenius(points: &[(f64, f64)], reference: f64) -> Result<ShiftFit> {
    let points = usable(points, reference, 1)?;
    let slope = |t: f64| (reference - t) / (t * reference) / GAS_CONSTANT;
    let activation_energy = regression(&points, slope);
    slower_when_colder(activation_energy)?;
    let shift = Shift::Arrhenius { activation_energy, reference };
    let rms = rms(&points, |t| activation_energy * slope(t));
    Ok(ShiftFit { shift, rms })
}

fn usable(points: &[(f64, f64)], reference: f64, least: usize) -> Result<Vec<(f64, f64)>> {
    positive("reference temperature", reference, "K (absolute)")?;
    validate_points(points)?;
    let points: Vec<_> = points.iter().filter(|p| p.0 != reference).copied().collect();
    require(
        points.len() >= least,
        "number of shift factors besides the reference",
        points.len(),
        format!("at least {least}"),
    )?;
    Ok(points)
}

/// The factor of `slope` that fits the points best.
fn regression(points: &[(f64, f64)], slope: impl Fn(f64) -> f64) -> f64 {
    let (mut above, mut below) = (0.0, 0.0);
    for (t, ln) in points {
        above += slope(*t) * ln;
        below += slope(*t) * slope(*t);
    }
    above / below
}

fn rms(points: &[(f64, f64)], law: impl Fn(f64) -> f64) -> f64 {
    let squares: f64 = points.iter().map(|(t, ln)| (law(*t) - ln).powi(2)).sum();
    (squares / points.len() as f64).sqrt() / LN_10
}

fn slower_when_colder(constant: f64) -> Result<()> {
    if constant > 0.0 && constant.is_finite() {
        return Ok(());
    }
    Err(Error::invalid(
        "trend of the shift factors",
        "not falling with temperature",
        "falling: a warmer material is faster (check the order of the temperatures and the unit)",
    ))
}

/// The minimum of f on \[low, high\]: the best of `steps` points, then golden sections around it.
pub(super) fn minimise(low: f64, high: f64, steps: usize, f: impl Fn(f64) -> f64) -> f64 {
    let place = |k: usize| low + (high - low) * k as f64 / steps as f64;
    let best = (0..=steps).min_by(|a, b| f(place(*a)).total_cmp(&f(place(*b)))).unwrap_or(0);
    let (mut a, mut b) = (place(best.saturating_sub(1)), place((best + 1).min(steps)));
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    // 50 sections: the width shrinks by 0.618^50 = 4e-11.
    for _ in 0..50 {
        let (left, right) = (b - golden * (b - a), a + golden * (b - a));
        if f(left) <= f(right) { b = right } else { a = left }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_laws_have_their_closed_forms() {
        let wlf = Shift::Wlf { c1: 10.0, c2: 100.0, reference: 300.0 };
        assert_eq!(wlf.factor(300.0).unwrap(), 1.0);
        // -10 * 100/200 decades.
        assert!((wlf.factor(400.0).unwrap() * 1e5 - 1.0).abs() < 1e-13);
        let arrhenius = Shift::Arrhenius { activation_energy: 1e5, reference: 300.0 };
        let exact = 1e5 / GAS_CONSTANT * (1.0 / 330.0 - 1.0 / 300.0);
        assert!((arrhenius.ln_factor(330.0).unwrap() / exact - 1.0).abs() < 1e-13);
        let table = Shift::Table { points: vec![(300.0, 2.0), (310.0, 0.0), (330.0, -1.0)] };
        assert_eq!(table.ln_factor(305.0).unwrap(), 1.0);
        assert_eq!(table.ln_factor(330.0).unwrap(), -1.0);
    }

    #[test]
    fn another_reference_is_the_same_law() {
        for shift in [
            Shift::Wlf { c1: 10.0, c2: 100.0, reference: 300.0 },
            Shift::Arrhenius { activation_energy: 1e5, reference: 300.0 },
            Shift::Table { points: vec![(250.0, 9.0), (310.0, 0.0), (400.0, -5.0)] },
        ] {
            let moved = shift.about(320.0).unwrap();
            for t in [280.0, 320.0, 390.0] {
                let exact = shift.ln_factor(t).unwrap() - shift.ln_factor(320.0).unwrap();
                assert!((moved.ln_factor(t).unwrap() - exact).abs() < 1e-12, "{shift:?} {t}");
            }
        }
    }

    #[test]
    fn constants_come_back_from_their_factors() {
        let temperatures = [290.0, 300.0, 305.0, 310.0, 320.0, 340.0, 360.0];
        let wlf = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 310.0 };
        let points: Vec<_> = temperatures.iter().map(|t| (*t, wlf.ln_factor(*t).unwrap())).collect();
        let fit = fit_wlf(&points, 310.0).unwrap();
        let Shift::Wlf { c1, c2, .. } = fit.shift else { panic!("{fit:?}") };
        // The golden section ends where the squares are flat: half of the digits.
        assert!((c1 / 8.86 - 1.0).abs() < 1e-6 && (c2 / 101.6 - 1.0).abs() < 1e-6, "{fit:?}");
        let arrhenius = Shift::Arrhenius { activation_energy: 2e5, reference: 310.0 };
        let points: Vec<_> = temperatures.iter().map(|t| (*t, arrhenius.ln_factor(*t).unwrap())).collect();
        let fit = fit_arrhenius(&points, 310.0).unwrap();
        let Shift::Arrhenius { activation_energy, .. } = fit.shift else { panic!("{fit:?}") };
        assert!((activation_energy / 2e5 - 1.0).abs() < 1e-13 && fit.rms < 1e-12);
        assert!(fit_arrhenius(&[(300.0, -1.0)], 310.0).is_err());
        assert!(fit_wlf(&points[..2], 310.0).is_err());
    }

    #[test]
    fn temperatures_outside_are_named() {
        let says = |shift: Shift, temperature: f64, words: &str| {
            let error = shift.ln_factor(temperature).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        let wlf = Shift::universal(373.0);
        says(wlf.clone(), 321.4, "above 321.4 K");
        says(wlf.clone(), 20.0, "temperature is 20 K");
        says(wlf, -3.0, "absolute");
        says(Shift::Table { points: vec![(300.0, 1.0), (310.0, 0.0)] }, 320.0, "300 K to 310 K");
        says(Shift::Table { points: vec![(300.0, 1.0), (300.0, 0.0)] }, 300.0, "shift factor 2");
        says(Shift::Table { points: vec![] }, 300.0, "at least 2");
        says(Shift::Wlf { c1: 0.0, c2: 1.0, reference: 300.0 }, 300.0, "c1");
        says(Shift::Arrhenius { activation_energy: f64::NAN, reference: 300.0 }, 300.0, "activation");
    }
}
