//! Shift factors a_T over the temperature.

use asperity::material::{Shift, VerticalShift};

use crate::figure::{Axis, COLOURS, Curves, INK, Series, Style, extent};

/// The shift of a material.
#[derive(Clone, Copy, Debug)]
pub struct Factors<'a> {
    /// What it is called; empty for the only one.
    pub name: &'a str,
    /// The law or list.
    pub law: &'a Shift,
    /// Temperature \[K\], log10 a_T and standard deviation \[decades\] of the factors found from sweeps, where there are any.
    pub found: &'a [[f64; 3]],
    /// Temperatures of the measurement \[K\], where there is one.
    pub temperatures: &'a [f64],
}

/// A temperature in °C.
pub(super) fn celsius(kelvin: f64) -> f64 {
    kelvin - 273.15
}

/// "20.0 °C" of a temperature \[K\].
pub(super) fn shown(kelvin: f64) -> String {
    format!("{:.1} °C", celsius(kelvin))
}

/// How far a law without a measurement is drawn from its reference temperature \[K\].
const AROUND: f64 = 40.0;

/// The panel of one shift or several: factors as points with bars of a standard deviation, laws as lines. `None` where there is
/// nothing to draw.
pub fn shift_factors(all: &[Factors]) -> Option<Curves> {
    let axis = Axis::log("shift factor a_T", "");
    let references: Vec<Option<f64>> = all.iter().map(|factors| factors.law.reference()).collect();
    let one = references.first().copied().flatten().filter(|one| references.iter().all(|r| *r == Some(*one)));
    let title = one.map_or("Shift factors".into(), |at| format!("Shift factors, reference {}", shown(at)));
    let mut panel = Curves::new(title, Axis::linear("temperature [°C]", ""), axis);
    for (n, factors) in all.iter().enumerate() {
        // Several references stand in the legend.
        let own = factors.law.reference().filter(|_| one.is_none());
        let about = own.map_or(String::new(), |kelvin| format!(" about {}", shown(kelvin)));
        let named = |what: &str| match (factors.name, what) {
            (_, "") => String::new(),
            ("", what) => format!("{what}{about}"),
            (name, what) => format!("{name}: {what}{about}"),
        };
        let power = |decades: f64| 10f64.powf(decades);
        let of_sweep = |[kelvin, decades, deviation]: &[f64; 3]| {
            let ends = [decades - deviation, decades + deviation].map(power);
            Point { kelvin: *kelvin, factor: power(*decades), ends: (*deviation > 0.0).then_some(ends) }
        };
        let given = |(kelvin, ln): &(f64, f64)| Point { kelvin: *kelvin, factor: ln.exp(), ends: None };
        let (points, word): (Vec<Point>, &str) = match factors.law {
            _ if !factors.found.is_empty() => {
                (factors.found.iter().map(of_sweep).collect(), "from the sweeps")
            }
            Shift::Table { points } => (points.iter().map(given).collect(), "given"),
            Shift::Wlf { .. } | Shift::Arrhenius { .. } => (vec![], ""),
        };
        let name = match factors.law {
            Shift::Wlf { .. } => "WLF",
            Shift::Arrhenius { .. } => "Arrhenius",
            Shift::Table { .. } => "",
        };
        let law = over(drawn(factors), &|kelvin| factors.law.factor(kelvin).ok());
        panel = with_law(panel, (named(name), law), (named(word), points), COLOURS[n % 4]);
    }
    (!panel.series.is_empty()).then_some(panel)
}

/// A factor at a temperature \[K\], and where its bar of a standard deviation ends.
struct Point {
    kelvin: f64,
    factor: f64,
    ends: Option<[f64; 2]>,
}

/// The panel with a law as a line, black where there are points, and with points and their bars in a colour.
fn with_law(
    mut panel: Curves,
    (name, law): (String, Vec<[f64; 2]>),
    (word, points): (String, Vec<Point>),
    colour: &str,
) -> Curves {
    if !law.is_empty() {
        let own = if points.is_empty() { colour } else { INK };
        panel = panel.with(Series::through(name, Style::Line, law).in_colour(own));
    }
    for point in &points {
        if let Some(ends) = point.ends {
            let bar = Series::new("", Style::Line, [celsius(point.kelvin); 2], ends);
            panel = panel.with(bar.in_colour(colour));
        }
    }
    if points.is_empty() {
        return panel;
    }
    let points = points.iter().map(|point| [celsius(point.kelvin), point.factor]);
    panel.with(Series::through(word, Style::Points, points).in_colour(colour))
}

/// The panel of vertical shift factors b_T: those of the sweeps (temperature \[K\], b_T, relative standard deviation) as points with
/// bars of a standard deviation, the law as a line. `None` of fewer than two sweeps.
pub fn vertical_shift_factors(law: &VerticalShift, found: &[[f64; 3]]) -> Option<Curves> {
    let ends = [found.first()?[0], found.last()?[0]];
    if ends[0] >= ends[1] {
        return None;
    }
    let (x, y) = (Axis::linear("temperature [°C]", ""), Axis::linear("vertical shift factor b_T", ""));
    let (name, word) = match law {
        VerticalShift::Density { .. } => ("density times temperature", "at the sweeps"),
        VerticalShift::Table { .. } => ("", "from the sweeps"),
    };
    let point = |[kelvin, factor, share]: &[f64; 3]| {
        let ends = [factor * (1.0 - share), factor * (1.0 + share)];
        Point { kelvin: *kelvin, factor: *factor, ends: (*share > 0.0).then_some(ends) }
    };
    let line = over(Some(ends), &|kelvin| law.factor(kelvin).ok());
    let points = found.iter().map(point).collect();
    let panel = Curves::new("Moduli are divided by b_T", x, y);
    Some(with_law(panel, (name.into(), line), (word.into(), points), COLOURS[0]))
}

/// A law \[°C, factor\] over temperatures \[K\], where it holds.
fn over(ends: Option<[f64; 2]>, law: &dyn Fn(f64) -> Option<f64>) -> Vec<[f64; 2]> {
    let Some([low, high]) = ends else { return vec![] };
    let places = (0..=200).map(|k| low + (high - low) * f64::from(k) / 200.0);
    places.filter_map(|kelvin| Some([celsius(kelvin), law(kelvin)?])).collect()
}

/// The temperatures over which a law is drawn: those measured, or some about its reference; those of a list.
fn drawn(factors: &Factors) -> Option<[f64; 2]> {
    let measured = extent(factors.temperatures.iter().copied());
    Some(match factors.law {
        Shift::Table { points } => [points.first()?.0, points.last()?.0],
        _ if measured[0] < measured[1] => measured,
        // The law ends at T_r - c2.
        Shift::Wlf { c2, reference, .. } => [reference - (0.6 * c2).min(AROUND), reference + AROUND],
        Shift::Arrhenius { reference, .. } => [(reference - AROUND).max(1.0), reference + AROUND],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_on_the_law_that_they_come_from() {
        let law = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
        let found: Vec<[f64; 3]> = [273.15, 293.15, 313.15]
            .map(|kelvin| [kelvin, law.factor(kelvin).unwrap().log10(), 0.05])
            .to_vec();
        let factors = Factors { name: "", law: &law, found: &found, temperatures: &[273.15, 313.15] };
        let panel = shift_factors(&[factors]).unwrap();
        let line = &panel.series[0];
        assert_eq!(panel.title, "Shift factors, reference 20.0 °C");
        assert_eq!((line.x[0], *line.x.last().unwrap()), (0.0, 313.15 - 273.15));
        let points = panel.series.last().unwrap();
        assert_eq!(points.style, Style::Points);
        // The first place of the law is the first temperature; a power of ten of its logarithm rounds in the last digits.
        assert!((points.y[0] / line.y[0] - 1.0).abs() < 1e-12);
        // A bar of a standard deviation at each of the three.
        assert_eq!(panel.series.len(), 5);
        let empty =
            Factors { name: "", law: &Shift::Table { points: vec![] }, found: &[], temperatures: &[] };
        assert!(shift_factors(&[empty]).is_none());
    }
}
