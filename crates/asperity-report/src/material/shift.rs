//! Shift factors a_T over the temperature.

use asperity::material::{Shift, VerticalShift};

use crate::figure::{Axis, Curves, Series, Style};

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

/// "20.0 °C" of a temperature \[K\].
pub(super) fn celsius(kelvin: f64) -> String {
    format!("{:.1} °C", kelvin - 273.15)
}

/// How far a law without a measurement is drawn from its reference temperature \[K\].
const AROUND: f64 = 40.0;

/// The panel of one shift or several: factors as points with bars of a standard deviation, laws as lines. `None` where there is
/// nothing to draw.
pub fn shift_factors(all: &[Factors]) -> Option<Curves> {
    let axis = Axis::log("shift factor a_T", "");
    let references: Vec<Option<f64>> = all.iter().map(|factors| factors.law.reference()).collect();
    let one = references.first().copied().flatten().filter(|one| references.iter().all(|r| *r == Some(*one)));
    let title = one
        .map_or("Shift factors".to_owned(), |kelvin| format!("Shift factors, reference {}", celsius(kelvin)));
    let mut panel = Curves::new(title, Axis::linear("temperature [°C]", ""), axis);
    for (n, factors) in all.iter().enumerate() {
        let colour = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"][n % 4];
        // Several references stand in the legend.
        let own = factors.law.reference().filter(|_| one.is_none());
        let about = own.map_or(String::new(), |kelvin| format!(" about {}", celsius(kelvin)));
        let named = |what: &str| match factors.name {
            "" => format!("{what}{about}"),
            name => format!("{name}: {what}{about}"),
        };
        let points: Vec<(f64, f64)> = match factors.law {
            _ if !factors.found.is_empty() => {
                factors.found.iter().map(|[kelvin, decades, _]| (*kelvin, 10f64.powf(*decades))).collect()
            }
            Shift::Table { points } => points.iter().map(|(kelvin, ln)| (*kelvin, ln.exp())).collect(),
            Shift::Wlf { .. } | Shift::Arrhenius { .. } => vec![],
        };
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|(kelvin, a)| (kelvin - 273.15, *a)).unzip();
        let law = line(factors).map(|(x, y)| {
            let word = match factors.law {
                Shift::Wlf { .. } => "WLF",
                Shift::Arrhenius { .. } => "Arrhenius",
                Shift::Table { .. } => "",
            };
            let name = if word.is_empty() { String::new() } else { named(word) };
            Series::new(name, Style::Line, x, y).in_colour(if points.is_empty() { colour } else { "#222222" })
        });
        panel = law.into_iter().fold(panel, |panel, line| panel.with(line));
        panel = factors.found.iter().fold(panel, |panel, [kelvin, decades, deviation]| {
            let ends = [decades - deviation, decades + deviation].map(|decades| 10f64.powf(decades));
            let bar = Series::new("", Style::Line, vec![kelvin - 273.15; 2], ends.to_vec());
            if *deviation > 0.0 { panel.with(bar.in_colour(colour)) } else { panel }
        });
        if !x.is_empty() {
            let word = if factors.found.is_empty() { "given" } else { "from the sweeps" };
            panel = panel.with(Series::new(named(word), Style::Points, x, y).in_colour(colour));
        }
    }
    (!panel.series.is_empty()).then_some(panel)
}

/// The panel of vertical shift factors b_T: those of the sweeps (temperature \[K\], b_T, relative standard deviation) as points with
/// bars of a standard deviation, the law as a line. `None` of fewer than two sweeps.
pub fn vertical_shift_factors(law: &VerticalShift, found: &[[f64; 3]]) -> Option<Curves> {
    let (low, high) = (found.first()?[0], found.last()?[0]);
    if low >= high {
        return None;
    }
    let axes = [Axis::linear("temperature [°C]", ""), Axis::linear("vertical shift factor b_T", "")];
    let [x, y] = axes;
    let places = (0..=200).map(|k| low + (high - low) * f64::from(k) / 200.0);
    let known = places.filter_map(|kelvin| Some((kelvin - 273.15, law.factor(kelvin).ok()?)));
    let (line_x, line_y): (Vec<f64>, Vec<f64>) = known.unzip();
    let (name, points) = match law {
        VerticalShift::Density { .. } => ("density times temperature", "at the sweeps"),
        VerticalShift::Table { .. } => ("", "from the sweeps"),
    };
    let panel = Curves::new("Moduli are divided by b_T", x, y)
        .with(Series::new(name, Style::Line, line_x, line_y).in_colour("#222222"));
    let panel =
        found.iter().filter(|[.., share]| *share > 0.0).fold(panel, |panel, [kelvin, factor, share]| {
            let ends = vec![factor * (1.0 - share), factor * (1.0 + share)];
            panel.with(Series::new("", Style::Line, vec![kelvin - 273.15; 2], ends).in_colour("#0072b2"))
        });
    let (x, y): (Vec<f64>, Vec<f64>) =
        found.iter().map(|[kelvin, factor, _]| (kelvin - 273.15, *factor)).unzip();
    Some(panel.with(Series::new(points, Style::Points, x, y).in_colour("#0072b2")))
}

/// The law over the temperatures measured, or about its reference; a list from its first to its last temperature.
fn line(factors: &Factors) -> Option<(Vec<f64>, Vec<f64>)> {
    let measured = |fold: fn(f64, f64) -> f64| factors.temperatures.iter().copied().reduce(fold);
    let about = match factors.law {
        // The law ends at T_r - c2.
        Shift::Wlf { c2, reference, .. } => [reference - (0.6 * c2).min(AROUND), reference + AROUND],
        Shift::Arrhenius { reference, .. } => [(reference - AROUND).max(1.0), reference + AROUND],
        Shift::Table { points } => [points.first()?.0, points.last()?.0],
    };
    let [low, high] = match (measured(f64::min), measured(f64::max), factors.law) {
        (Some(low), Some(high), Shift::Wlf { .. } | Shift::Arrhenius { .. }) if low < high => [low, high],
        _ => about,
    };
    let places = (0..=200).map(|k| low + (high - low) * f64::from(k) / 200.0);
    let known = places.filter_map(|kelvin| Some((kelvin - 273.15, factors.law.factor(kelvin).ok()?)));
    let (x, y): (Vec<f64>, Vec<f64>) = known.unzip();
    (!x.is_empty()).then_some((x, y))
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
