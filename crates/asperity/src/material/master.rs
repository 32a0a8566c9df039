//! Master curves: isotherms at several temperatures shifted along the logarithm of time or frequency
//! until they are one curve.
//!
//! J. D. Ferry, Viscoelastic Properties of Polymers (3rd ed., 1980), chapter 11. Relaxation is faster at higher temperatures: at
//! the temperature T the reduced time of t is t/a_T, and the reduced frequency of omega is omega a_T. The shift factors come from
//! a law ([`Shift`]) or from neighbouring isotherms ([`estimate_shift`](super::estimate_shift)).

use crate::error::{Error, Result, increasing, kelvin, positive, require};
use crate::material::shift::Shift;

/// The abscissa of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Abscissa {
    /// Time \[s\]: creep or relaxation.
    Time,
    /// Angular frequency \[rad/s\]: storage and loss.
    Frequency,
}

/// Curves measured at one temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct Isotherm {
    /// \[K\].
    pub temperature: f64,
    /// Times \[s\] or angular frequencies \[rad/s\], positive, in order.
    pub x: Vec<f64>,
    /// One curve (relaxation modulus or creep compliance) or two (storage and loss modulus), each with a
    /// positive value for every x.
    pub curves: Vec<Vec<f64>>,
}

/// Isotherms shifted to one temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct MasterCurve {
    /// Reduced times \[s\] or angular frequencies \[rad/s\], in order, without duplicates.
    pub x: Vec<f64>,
    /// The curves at these, in the order of the isotherms.
    pub curves: Vec<Vec<f64>>,
}

/// Shifts all isotherms to the reference temperature of a law.
///
/// ```
/// use asperity::material::{Abscissa, Isotherm, Shift, master_curve};
/// let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 };
/// let cold = Isotherm { temperature: 290.0, x: vec![1.0, 10.0], curves: vec![vec![3e9, 2e9]] };
/// let master = master_curve(&[cold], Abscissa::Time, &shift)?;
/// // Ten kelvin colder is 9.3 times slower, so its second is a tenth of a second at 300 K.
/// assert!((master.x[0] * shift.factor(290.0)? - 1.0).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if an isotherm is out of order, has values that are not positive or another number of curves than the
/// first, or if the shift is not defined at its temperature.
pub fn master_curve(isotherms: &[Isotherm], abscissa: Abscissa, shift: &Shift) -> Result<MasterCurve> {
    validate(isotherms, 1)?;
    let mut points: Vec<(f64, Vec<f64>)> = vec![];
    for isotherm in isotherms {
        let factor = shift.factor(isotherm.temperature)?;
        for (k, x) in isotherm.x.iter().enumerate() {
            let reduced = match abscissa {
                Abscissa::Time => x / factor,
                Abscissa::Frequency => x * factor,
            };
            if !(reduced.is_finite() && reduced >= f64::MIN_POSITIVE) {
                return Err(Error::invalid(
                    format!("reduced abscissa of point {} at {}", k + 1, kelvin(isotherm.temperature)),
                    reduced,
                    "within the range of floating-point numbers: check the constants of the shift",
                ));
            }
            points.push((reduced, isotherm.curves.iter().map(|c| c[k]).collect()));
        }
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(merge(points))
}

/// Checks isotherms of at least this many points.
pub(super) fn validate(isotherms: &[Isotherm], least: usize) -> Result<()> {
    let Some(first) = isotherms.first() else {
        return Err(Error::invalid("number of isotherms", 0, "at least 1"));
    };
    for isotherm in isotherms {
        positive("temperature of an isotherm", isotherm.temperature, "K (absolute)")?;
        let at = format!("the isotherm at {}", kelvin(isotherm.temperature));
        let (points, expected) = (isotherm.x.len(), format!("at least {least}"));
        require(points >= least, format!("number of points of {at}"), points, &expected)?;
        if isotherm.curves.is_empty() || isotherm.curves.len() != first.curves.len() {
            let expected = format!("{}, and at least 1, as in the first", first.curves.len());
            return Err(Error::invalid(format!("number of curves of {at}"), isotherm.curves.len(), expected));
        }
        for curve in &isotherm.curves {
            if curve.len() != isotherm.x.len() {
                let expected = format!("{}, one for each time or frequency", isotherm.x.len());
                return Err(Error::invalid(format!("number of values of {at}"), curve.len(), expected));
            }
        }
        for numbers in isotherm.curves.iter().chain([&isotherm.x]) {
            for (n, value) in numbers.iter().enumerate() {
                positive(&format!("point {} of {at}", n + 1), *value, "")?;
            }
        }
        let name = |n: usize| format!("abscissa of point {} of {at}", n + 1);
        increasing(isotherm.x.iter().copied(), name, |x| x.to_string())?;
    }
    Ok(())
}

/// Points with the same abscissa are averaged.
fn merge(points: Vec<(f64, Vec<f64>)>) -> MasterCurve {
    let count = points.first().map_or(0, |p| p.1.len());
    let mut master = MasterCurve { x: vec![], curves: vec![vec![]; count] };
    let mut same = 1.0;
    for (x, values) in points {
        let again = master.x.last() == Some(&x);
        same = if again { same + 1.0 } else { 1.0 };
        if !again {
            master.x.push(x);
        }
        for (curve, value) in master.curves.iter_mut().zip(values) {
            match curve.last_mut() {
                Some(mean) if again => *mean += (value - *mean) / same,
                _ => curve.push(value),
            }
        }
    }
    master
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_reduced_times_become_their_mean() {
        let law = Shift::Wlf { c1: 9.0, c2: 80.0, reference: 310.0 };
        let twice =
            |value: f64| Isotherm { temperature: 310.0, x: vec![1.0, 2.0], curves: vec![vec![value; 2]] };
        let master = master_curve(&[twice(1.0), twice(2.0), twice(6.0)], Abscissa::Time, &law).unwrap();
        assert_eq!((master.x, master.curves), (vec![1.0, 2.0], vec![vec![3.0, 3.0]]));
    }
}
