//! Measured curves, and the functions fitted to them.

use std::f64::consts::TAU;

use asperity::material::{MasterCurve, Shift};
use asperity_io::curve::{Curves as Measured, Fitted, Kind, Sweep};
use asperity_io::readable::{counted, quantity};

use super::decades;
use super::shift::{self, Factors, celsius, shift_factors, vertical_shift_factors};
use crate::figure::{Axis, COLOURS, Curves, Figure, Key, Palette, Series, Style, extent};

/// Measured curves in the colours of their temperatures, from the coldest (dark) to the warmest (bright).
pub fn isotherms(title: &str, measured: &Measured) -> Figure {
    if let Some(figure) = over_temperature(title, measured) {
        return figure;
    }
    let (x, scale) = match measured.kind {
        Kind::Dma => (Axis::log("frequency", "Hz"), TAU),
        _ => (Axis::log("time", "s"), 1.0),
    };
    let panels: &[Dynamic] = match measured.kind {
        Kind::Relaxation => &[("Relaxation", "relaxation modulus", "Pa", |[modulus, _]| modulus)],
        Kind::Creep => &[("Creep", "creep compliance", "1/Pa", |[compliance, _]| compliance)],
        // A storage modulus alone.
        Kind::Dma if measured.sweeps.iter().all(|sweep| sweep.curves.len() == 1) => &DYNAMIC[..1],
        Kind::Dma => &DYNAMIC,
    };
    let key = key(measured.sweeps.iter().filter_map(|sweep| sweep.temperature));
    let panels = panels.iter().map(|(title, y, unit, value)| {
        let mut panel = Curves::new(*title, x.clone(), Axis::log(*y, *unit));
        for sweep in &measured.sweeps {
            let places: Vec<f64> = sweep.x.iter().map(|x| x / scale).collect();
            // A curve alone, or storage and loss.
            let curves = sweep.curves.first().zip(sweep.curves.last());
            let rows = curves.into_iter().flat_map(|(first, last)| first.iter().zip(last));
            let values: Vec<f64> = rows.map(|(first, last)| value([*first, *last])).collect();
            let colour = match (&key, sweep.temperature) {
                (Some(key), Some(kelvin)) => key.colour(celsius(kelvin)),
                _ => PLAIN.to_owned(),
            };
            for style in [Style::Line, Style::Points] {
                panel = panel.with(Series::new("", style, &places, &values).in_colour(&colour));
            }
        }
        panel.key.clone_from(&key);
        panel
    });
    let caption = match measured.sweeps.as_slice() {
        [Sweep { temperature: Some(kelvin), .. }] => format!(" at {:.1} °C", celsius(*kelvin)),
        _ => String::new(),
    };
    let caption = format!(
        "{}{caption}, {}.",
        counted(measured.sweeps.len(), "sweep"),
        counted(measured.points(), "point")
    );
    Figure::new(title).with_all(panels).caption(caption)
}

/// A panel of measured curves: its title, quantity and unit, and the quantity of a row of curves.
type Dynamic = (&'static str, &'static str, &'static str, fn([f64; 2]) -> f64);

/// Of storage and loss modulus.
const DYNAMIC: [Dynamic; 3] = [
    ("Storage", "storage modulus", "Pa", |[storage, _]| storage),
    ("Loss", "loss modulus", "Pa", |[_, loss]| loss),
    ("Loss factor", "tan delta", "", |[storage, loss]| loss / storage),
];

/// Frequencies that agree to this share are one: instruments round them.
const SAME: f64 = 0.01;

/// A temperature ramp: storage, loss and loss factor over temperature, a line for each frequency. `None` for what is none, or has many
/// frequencies.
fn over_temperature(title: &str, measured: &Measured) -> Option<Figure> {
    let mut points: Vec<[f64; 4]> = vec![];
    for sweep in measured.sweeps.iter().filter(|_| measured.is_over_temperature()) {
        let (kelvin, [storage, loss]) = (sweep.temperature?, sweep.curves.as_slice()) else { return None };
        let rows = sweep.x.iter().zip(storage).zip(loss);
        points.extend(rows.map(|((x, storage), loss)| [x / TAU, celsius(kelvin), *storage, *loss]));
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let lines: Vec<Vec<[f64; 4]>> =
        points.chunk_by(|a, b| b[0] - a[0] <= SAME * a[0]).map(<[[f64; 4]]>::to_vec).collect();
    if lines.is_empty() || lines.len() > COLOURS.len() {
        return None;
    }
    let panels = DYNAMIC.map(|(name, y, unit, value)| {
        let mut panel = Curves::new(name, Axis::linear("temperature [°C]", ""), Axis::log(y, unit));
        for (n, line) in lines.iter().enumerate() {
            let mut line = line.clone();
            line.sort_by(|a, b| a[1].total_cmp(&b[1]));
            let name = if lines.len() > 1 { quantity(line[0][0], "Hz") } else { String::new() };
            for (name, style) in [(name, Style::Line), (String::new(), Style::Points)] {
                let through = line.iter().map(|point| [point[1], value([point[2], point[3]])]);
                panel = panel.with(Series::through(name, style, through).in_colour(COLOURS[n]));
            }
        }
        panel
    });
    let at = if lines.len() == 1 { format!(" at {}", quantity(lines[0][0][0], "Hz")) } else { String::new() };
    let caption = format!("Temperature ramp{at}, {}.", counted(measured.points(), "point"));
    Some(Figure::new(title).with_all(panels).caption(caption))
}

/// Colour of points without a temperature.
const PLAIN: &str = "#0072b2";

/// The colour bar of several temperatures \[K\]; `None` of one, or none.
fn key(temperatures: impl Iterator<Item = f64>) -> Option<Key> {
    let ends = extent(temperatures.map(celsius));
    let (label, unit) = ("temperature".to_owned(), "°C".to_owned());
    (ends[0] < ends[1]).then_some(Key { label, unit, palette: Palette::Plasma, ends })
}

/// Reduced places, values of each column, and colour of every sweep of several, with their colour bar.
type Shifted = (Vec<(Vec<f64>, Vec<Vec<f64>>, String)>, Key);

/// The points of several sweeps, shifted as for the fit and within its window.
fn shifted(measured: &Measured, fitted: &Fitted) -> Option<Shifted> {
    let key = key(measured.sweeps.iter().filter_map(|sweep| sweep.temperature))?;
    let [first, last] = [fitted.data.x.first()?, fitted.data.x.last()?];
    let one = |sweep: &Sweep| {
        let kelvin = sweep.temperature?;
        let factor = fitted.shift_factor(kelvin)?;
        let factor = if measured.kind == Kind::Dma { factor } else { 1.0 / factor };
        let reduced: Vec<f64> = sweep.x.iter().map(|x| x * factor).collect();
        let inside = |x: f64| x >= first * (1.0 - 1e-9) && x <= last * (1.0 + 1e-9);
        let kept: Vec<usize> = (0..reduced.len()).filter(|n| inside(reduced[*n])).collect();
        let pick = |values: &Vec<f64>| kept.iter().map(|n| values[*n]).collect::<Vec<f64>>();
        let raise = fitted.value_factor(measured.kind, kelvin);
        let raised = |values: &Vec<f64>| pick(values).into_iter().map(|value| raise * value).collect();
        Some((pick(&reduced), sweep.curves.iter().map(raised).collect(), key.colour(celsius(kelvin))))
    };
    Some((measured.sweeps.iter().map(one).collect::<Option<_>>()?, key))
}

/// The measured points and the function fitted to them, their relative distance, and the shift factors of several sweeps. The
/// points of several sweeps have the colours of their temperatures.
///
/// # Errors
/// [`asperity::Error`] where a creep function has no relaxation function.
pub fn fit(title: &str, measured: &Measured, fitted: &Fitted) -> asperity::Result<Figure> {
    let relaxation = fitted.material.relaxation()?;
    let time = || Axis::log("time", "s");
    let (x, curves): (Axis, Vec<(&str, &str, Function<'_>)>) = match measured.kind {
        Kind::Relaxation => (time(), vec![("relaxation modulus", "Pa", Box::new(|t| relaxation.value(t)))]),
        Kind::Creep => {
            (time(), vec![("creep compliance", "1/Pa", Box::new(|t| fitted.material.creep().value(t)))])
        }
        Kind::Dma => (
            Axis::log("angular frequency", "rad/s"),
            vec![
                ("storage", "Pa", Box::new(|w| relaxation.complex(w).0)),
                ("loss", "Pa", Box::new(|w| relaxation.complex(w).1)),
            ],
        ),
    };
    let y = match curves.as_slice() {
        [(name, unit, _)] => Axis::log(*name, *unit),
        _ => Axis::log("modulus", "Pa"),
    };
    let MasterCurve { x: places, curves: values } = &fitted.data;
    let fine = decades(extent(places.iter().copied().filter(|x| *x > 0.0)));
    let dynamic = measured.kind == Kind::Dma;
    let hertz = |panel: Curves| if dynamic { panel.beside("Hz", 1.0 / TAU) } else { panel };
    let sweeps = shifted(measured, fitted);
    let reference = fitted.shift.as_ref().and_then(Shift::reference);
    let title_of = match (&sweeps, reference) {
        (Some(_), Some(kelvin)) => format!("Master curve at {} and fit", shift::shown(kelvin)),
        (Some(_), None) => "Master curve and fit".to_owned(),
        (None, _) => "Data and fit".to_owned(),
    };
    let mut panel = hertz(Curves::new(title_of, x.clone(), y));
    if let Some((sweeps, key)) = &sweeps {
        for (reduced, values, colour) in sweeps {
            for values in values {
                panel = panel.with(Series::new("", Style::Points, reduced, values).in_colour(colour));
            }
        }
        panel.key = Some(key.clone());
    }
    let left = fitted.other().map(|(column, _)| column);
    let mut distance = hertz(Curves::new("Distance", x, Axis::linear("fit / data - 1", "")));
    for (n, ((name, _, function), values)) in curves.iter().zip(values).enumerate() {
        let left_out = left.is_some_and(|column| column == *name);
        // Data and distance of a curve in one colour; its fit in black over the data, the second one dashed.
        let colour = ["#0072b2", "#d55e00"][n.min(1)];
        if sweeps.is_none() {
            let points = Series::new(format!("{name}, data"), Style::Points, places, values);
            panel = panel.with(points.in_colour(colour));
        }
        let word = if left_out { "follows from the fit" } else { "fit" };
        let style = if n == 0 { Style::Line } else { Style::Dashed };
        let line = Series::of(format!("{name}, {word}"), style, &fine, function);
        panel = panel.with(line.in_colour("#222222"));
        if !left_out {
            let apart = places.iter().zip(values).map(|(x, data)| [*x, function(*x) / data - 1.0]);
            distance = distance.with(Series::through(*name, Style::Points, apart).in_colour(colour));
        }
    }
    let columns: Vec<String> = fitted
        .columns
        .iter()
        .map(|(name, m)| format!("{name} {:.2} % rms, {:.2} % at most", 100.0 * m.rms, 100.0 * m.max))
        .collect();
    let left = left.map_or(String::new(), |column| format!(" The {column} modulus was not fitted."));
    let caption = format!(
        "{}; misfit of {}; scatter of the data {:.2} %.{left}",
        counted(fitted.terms(), "term"),
        columns.join("; "),
        100.0 * fitted.noise
    );
    let figure = Figure::new(title).with(panel).with(distance);
    let (found, temperatures) = (&fitted.factors, &fitted.temperatures);
    let factors = fitted
        .shift
        .as_ref()
        .and_then(|law| shift_factors(&[Factors { name: "", law, found, temperatures }]));
    let vertical =
        fitted.vertical.as_ref().and_then(|law| vertical_shift_factors(law, &fitted.vertical_factors));
    Ok(figure.with_all(factors).with_all(vertical).caption(caption))
}

/// What a kind of measurement shows of a material.
type Function<'a> = Box<dyn Fn(f64) -> f64 + 'a>;
