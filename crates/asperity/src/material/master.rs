//! Master curves: isotherms at several temperatures shifted along the logarithm of time or frequency
//! until they are one curve.
//!
//! J. D. Ferry, Viscoelastic Properties of Polymers (3rd ed., 1980), chapter 11. Warmer is faster: at
//! the temperature T the time t counts as t/a_T, the frequency omega as omega a_T. The shift factors come
//! from a law ([`Shift`]) or from the overlap of neighbouring isotherms.

use crate::error::{Error, Result, positive};
use crate::material::shift::{self, Shift};
use std::f64::consts::LN_10;

/// What the abscissa of a curve is.
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
    /// Reduced times \[s\] or angular frequencies \[rad/s\], in order, none twice.
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
/// [`Error::Invalid`] where an isotherm is out of order, has values that are not positive or another
/// number of curves than the first, or where the shift is not defined at its temperature.
pub fn master_curve(isotherms: &[Isotherm], abscissa: Abscissa, shift: &Shift) -> Result<MasterCurve> {
    validate(isotherms)?;
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
                    format!("reduced abscissa of point {} at {} K", k + 1, isotherm.temperature),
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

/// The shift factors that bring neighbouring isotherms into line, as a table with a_T = 1 at the
/// `reference` temperature \[K\], which must be that of an isotherm.
///
/// Each pair of neighbours in temperature is shifted to the least mean square of the difference of the
/// logarithms of all curves where they overlap; factors multiply from pair to pair.
/// [`fit_wlf`](crate::material::fit_wlf) and [`fit_arrhenius`](crate::material::fit_arrhenius) turn the
/// table into a law.
///
/// ```
/// use asperity::material::{Abscissa, Isotherm, estimate_shift};
/// // Power-law relaxation t^-0.3, ten times as fast at the warmer temperature.
/// let x: Vec<f64> = (0..13).map(|k| 10f64.powf(k as f64 / 4.0)).collect();
/// let curve = |a: f64| vec![x.iter().map(|t| 1e6 / (1.0 + (t / a).powf(0.3))).collect()];
/// let cold = Isotherm { temperature: 290.0, x: x.clone(), curves: curve(10.0) };
/// let warm = Isotherm { temperature: 300.0, x: x.clone(), curves: curve(1.0) };
/// let shift = estimate_shift(&[cold, warm], Abscissa::Time, 300.0)?;
/// assert!((shift.factor(290.0)? / 10.0 - 1.0).abs() < 0.01); // chords over a quarter of a decade
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] as [`master_curve`]; for fewer than two isotherms; where two neighbours share no
/// values (measure at temperatures closer to each other), or hardly change where they do.
pub fn estimate_shift(isotherms: &[Isotherm], abscissa: Abscissa, reference: f64) -> Result<Shift> {
    validate(isotherms)?;
    let mut sorted: Vec<&Isotherm> = isotherms.iter().collect();
    sorted.sort_by(|a, b| a.temperature.total_cmp(&b.temperature));
    if sorted.len() < 2 {
        return Err(Error::invalid("number of isotherms", sorted.len(), "at least 2"));
    }
    let mut points = vec![(sorted[0].temperature, 0.0)];
    let mut sum = 0.0;
    for pair in sorted.windows(2) {
        let (cold, warm) = (pair[0], pair[1]);
        if cold.temperature == warm.temperature {
            let value = format!("{} K twice", cold.temperature);
            return Err(Error::invalid("temperature of the isotherms", value, "each once"));
        }
        // The distance by which the warm curve moves along ln x to lie on the cold one: forwards in
        // frequency if ln a_T falls, backwards in time.
        let moved = align(&Logarithms::of(cold), &Logarithms::of(warm), [cold, warm])?;
        sum += match abscissa {
            Abscissa::Time => -moved,
            Abscissa::Frequency => moved,
        };
        points.push((warm.temperature, sum));
    }
    let Some((_, zero)) = points.iter().find(|p| p.0 == reference).copied() else {
        let known: Vec<String> = points.iter().map(|p| format!("{} K", p.0)).collect();
        let expected = format!("one of the isotherms: {}", known.join(", "));
        return Err(Error::invalid("reference temperature", format!("{reference} K"), expected));
    };
    Ok(Shift::Table { points: points.into_iter().map(|(t, ln)| (t, ln - zero)).collect() })
}

/// Curves as logarithms.
struct Logarithms {
    x: Vec<f64>,
    curves: Vec<Vec<f64>>,
}

impl Logarithms {
    fn of(isotherm: &Isotherm) -> Self {
        let ln = |values: &Vec<f64>| values.iter().map(|v| v.ln()).collect();
        Logarithms { x: ln(&isotherm.x), curves: isotherm.curves.iter().map(ln).collect() }
    }

    fn ends(&self) -> [f64; 2] {
        [self.x[0], self.x[self.x.len() - 1]]
    }

    /// Squares of the distances of the points of `other`, moved by d, from this curve, and their number.
    fn squares(&self, other: &Logarithms, d: f64) -> (f64, usize) {
        let [first, last] = self.ends();
        let (mut squares, mut count) = (0.0, 0);
        for (k, x) in other.x.iter().map(|x| x + d).enumerate().filter(|(_, x)| *x >= first && *x <= last) {
            let next = self.x.partition_point(|own| *own <= x).clamp(1, self.x.len() - 1);
            let share = (x - self.x[next - 1]) / (self.x[next] - self.x[next - 1]);
            for (own, others) in self.curves.iter().zip(&other.curves) {
                let value = own[next - 1] + share * (own[next] - own[next - 1]);
                squares += (value - others[k]).powi(2);
                count += 1;
            }
        }
        (squares, count)
    }

    /// Largest change of any curve over a range of ln x.
    fn change(&self, first: f64, last: f64) -> f64 {
        let inside: Vec<usize> =
            (0..self.x.len()).filter(|k| self.x[*k] >= first && self.x[*k] <= last).collect();
        let range = |curve: &Vec<f64>| {
            let values = || inside.iter().map(|k| curve[*k]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        self.curves.iter().map(range).fold(0.0, f64::max)
    }
}

/// Overlaps below this share of the shorter curve are chance.
const LEAST_OVERLAP: f64 = 0.2;

/// How far `warm` moves along ln x to lie on `cold`.
fn align(cold: &Logarithms, warm: &Logarithms, names: [&Isotherm; 2]) -> Result<f64> {
    let ([c0, c1], [w0, w1]) = (cold.ends(), warm.ends());
    let least = LEAST_OVERLAP * (c1 - c0).min(w1 - w0);
    let overlap = |d: f64| [c0.max(w0 + d), c1.min(w1 + d)];
    // Both ways: the chords of one curve lie inside its bends, those of the other too.
    let mismatch = |d: f64| {
        let (forth, back) = (cold.squares(warm, d), warm.squares(cold, -d));
        let count = forth.1 + back.1;
        if count < 4 { f64::INFINITY } else { (forth.0 + back.0) / count as f64 }
    };
    let (low, high) = (c0 + least - w1, c1 - least - w0);
    let moved = shift::minimise(low, high, 600, mismatch);
    let [first, last] = overlap(moved);
    let pair = format!("isotherms at {} K and {} K", names[0].temperature, names[1].temperature);
    let apart = mismatch(moved).sqrt();
    // A good overlap misses by scatter; 0.2 is a factor 1.2.
    if apart.is_nan() || apart > 0.2 {
        return Err(Error::invalid(
            pair,
            format!("apart by {:.0} % at best", 100.0 * apart.exp_m1()),
            "overlapping: measure at temperatures closer to each other, or give the shift",
        ));
    }
    let change = cold.change(first, last).max(warm.change(first - moved, last - moved));
    if change < (3.0 * apart).max(0.01) {
        return Err(Error::invalid(
            pair,
            format!(
                "changing by {:.1} % only where they overlap, over {:.1} decades",
                100.0 * change.exp_m1(),
                (last - first) / LN_10
            ),
            "curves with a slope, from which a shift can be told: leave one out, or give the shift",
        ));
    }
    Ok(moved)
}

fn validate(isotherms: &[Isotherm]) -> Result<()> {
    let Some(first) = isotherms.first() else {
        return Err(Error::invalid("number of isotherms", 0, "at least 1"));
    };
    for isotherm in isotherms {
        positive("temperature of an isotherm", isotherm.temperature, "K (absolute)")?;
        let at = format!("the isotherm at {} K", isotherm.temperature);
        if isotherm.x.len() < 2 {
            return Err(Error::invalid(format!("number of points of {at}"), isotherm.x.len(), "at least 2"));
        }
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
        for (n, pair) in isotherm.x.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                let expected =
                    format!("greater than the one before it, {:e} (in order, none twice)", pair[0]);
                return Err(Error::invalid(
                    format!("abscissa of point {} of {at}", n + 2),
                    pair[1],
                    expected,
                ));
            }
        }
    }
    Ok(())
}

/// Points that fall on the same abscissa become their mean.
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
    use crate::material::series::tests::random;
    use crate::material::{FitOptions, Relaxation, fit_dma, fit_relaxation, fit_wlf};

    /// A transition over six decades.
    fn polymer() -> Relaxation {
        let weights = [2e8, 5e8, 9e8, 7e8, 4e8, 1e8, 3e7, 6e6, 1e6];
        let terms: Vec<_> =
            weights.iter().enumerate().map(|(k, w)| (*w, 4.0 * 10f64.powi(k as i32 - 4))).collect();
        Relaxation::absolute(1e6, &terms).unwrap()
    }

    fn law() -> Shift {
        Shift::Wlf { c1: 9.0, c2: 80.0, reference: 310.0 }
    }

    const TEMPERATURES: [f64; 8] = [295.0, 300.0, 305.0, 310.0, 315.0, 320.0, 330.0, 340.0];

    /// DMA sweeps from 0.1 to 100 Hz with 1 % scatter.
    fn sweeps() -> Vec<Isotherm> {
        let mut random = random(8);
        let mut scatter =
            move || 1.0 + 0.01 * (random() + random() + random() + random() - 2.0) * 3f64.sqrt();
        let sweep = |temperature: f64| {
            let a = law().factor(temperature).unwrap();
            let x: Vec<f64> = (0..19).map(|k| 0.628 * 10f64.powf(f64::from(k) / 6.0)).collect();
            let (storage, loss): (Vec<_>, Vec<_>) = x
                .iter()
                .map(|w| polymer().complex(w * a))
                .map(|(s, l)| (s * scatter(), l * scatter()))
                .unzip();
            Isotherm { temperature, x, curves: vec![storage, loss] }
        };
        TEMPERATURES.map(sweep).to_vec()
    }

    #[test]
    fn sweeps_at_eight_temperatures_give_the_law_and_the_material() {
        let table = estimate_shift(&sweeps(), Abscissa::Frequency, 310.0).unwrap();
        for t in TEMPERATURES {
            let error = (table.ln_factor(t).unwrap() - law().ln_factor(t).unwrap()) / LN_10;
            // 1 % of scatter on slopes of 1/4 and more, averaged over some 20 points and summed over
            // at most four pairs; chords over a sixth of a decade.
            assert!(error.abs() < 0.03, "{t} K: {error} decades");
        }
        let Shift::Table { points } = &table else { panic!("{table:?}") };
        let fit = fit_wlf(points, 310.0).unwrap();
        assert!(fit.rms < 0.02, "{fit:?}");
        let master = master_curve(&sweeps(), Abscissa::Frequency, &fit.shift).unwrap();
        assert!(master.x.windows(2).all(|p| p[0] < p[1]) && master.x.len() == 8 * 19);
        let options = FitOptions::default();
        let fit = fit_dma(&master.x, &master.curves[0], &master.curves[1], &options).unwrap();
        for t in [3e-4, 1e-2, 1.0, 1e2, 3e2] {
            let error = fit.function.value(t) / polymer().value(t) - 1.0;
            // 0.02 decades along slopes up to 1 are 5 %.
            assert!(error.abs() < 0.05, "{t} {error}");
        }
    }

    #[test]
    fn relaxation_in_time_shifts_the_other_way() {
        let isotherms: Vec<Isotherm> = [300.0, 305.0, 310.0]
            .iter()
            .map(|temperature| {
                let a = law().factor(*temperature).unwrap();
                let x: Vec<f64> = (0..21).map(|k| 10f64.powf(-1.0 + 0.15 * f64::from(k))).collect();
                let curve = x.iter().map(|t| polymer().value(t / a)).collect();
                Isotherm { temperature: *temperature, x, curves: vec![curve] }
            })
            .collect();
        let table = estimate_shift(&isotherms, Abscissa::Time, 310.0).unwrap();
        let error = table.ln_factor(300.0).unwrap() / law().ln_factor(300.0).unwrap() - 1.0;
        // No scatter; chords over 0.15 decades.
        assert!(error.abs() < 2e-3, "{error}");
        let master = master_curve(&isotherms, Abscissa::Time, &law()).unwrap();
        let fit = fit_relaxation(&master.x, &master.curves[0], &FitOptions::default()).unwrap();
        assert!(fit.misfit.max < 1e-3, "{:?}", fit.misfit);
    }

    #[test]
    fn what_cannot_be_shifted_is_told() {
        let isotherm = |temperature: f64, x: &[f64], curve: &[f64]| Isotherm {
            temperature,
            x: x.to_vec(),
            curves: vec![curve.to_vec()],
        };
        let says = |isotherms: &[Isotherm], reference: f64, words: &str| {
            let error = estimate_shift(isotherms, Abscissa::Time, reference).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        let x = [1.0, 2.0, 4.0, 8.0];
        let high = isotherm(300.0, &x, &[9e9, 8e9, 7e9, 6e9]);
        let low = isotherm(400.0, &x, &[4e6, 3e6, 2e6, 1e6]);
        says(&[high.clone(), low.clone()], 300.0, "isotherms at 300 K and 400 K");
        let flat = |t: f64| isotherm(t, &x, &[1e9; 4]);
        says(&[flat(300.0), flat(310.0)], 300.0, "slope");
        let next = isotherm(310.0, &x, &[7e9, 6e9, 5e9, 4e9]);
        says(&[high.clone(), next.clone()], 305.0, "one of the isotherms: 300 K, 310 K");
        says(&[high.clone(), high.clone()], 300.0, "300 K twice");
        says(std::slice::from_ref(&high), 300.0, "number of isotherms is 1");
        says(&[isotherm(300.0, &[1.0, 1.0], &[1.0, 1.0])], 300.0, "abscissa of point 2");
        says(&[isotherm(300.0, &[1.0, 2.0], &[1.0, -1.0])], 300.0, "point 2 of the isotherm at 300 K");
        says(&[isotherm(300.0, &x, &[1.0])], 300.0, "number of values");
        says(&[], 300.0, "number of isotherms is 0");
        assert!(estimate_shift(&[high, next], Abscissa::Time, 310.0).is_ok());
    }

    #[test]
    fn equal_reduced_times_become_their_mean() {
        let twice =
            |value: f64| Isotherm { temperature: 310.0, x: vec![1.0, 2.0], curves: vec![vec![value; 2]] };
        let master = master_curve(&[twice(1.0), twice(2.0), twice(6.0)], Abscissa::Time, &law()).unwrap();
        assert_eq!((master.x, master.curves), (vec![1.0, 2.0], vec![vec![3.0, 3.0]]));
    }
}
