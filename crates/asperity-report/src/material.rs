//! Materials: relaxation, creep, storage and loss over decades, and fits beside the points that they are made of.

use asperity::indentation::{Given, IndentationFit};
use asperity::material::{Creep, MasterCurve, Material, Modulus, Relaxation};
use asperity_io::case::WaveReport;
use asperity_io::curve::{Curves as Measured, Fitted, Indentation, Kind};
use asperity_io::readable::counted;

use crate::figure::{Axis, Curves, Figure, Series, Style};

/// Points of a curve per decade.
const PER_DECADE: f64 = 20.0;
/// Longest curve.
const MOST: f64 = 4000.0;

/// Relaxation modulus, creep compliance, storage and loss modulus, and tan delta of materials, over times from
/// `window[0]` to `window[1]` \[s\] and the angular frequencies 1/t \[rad/s\].
///
/// ```
/// use asperity::material::{Material, Modulus, Relaxation};
/// use asperity_report::material::functions;
/// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
/// let pmma = Material::prony(Modulus::Young, pmma)?;
/// let figure = functions("PMMA", &[("PMMA", &pmma)], [0.1, 1000.0])?;
/// assert_eq!(figure.panels.len(), 4);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`asperity::Error`] where a creep function has no relaxation function.
pub fn functions(title: &str, materials: &[(&str, &Material)], window: [f64; 2]) -> asperity::Result<Figure> {
    let times = decades(window);
    let frequencies = decades([1.0 / window[1], 1.0 / window[0]]);
    let young = materials.iter().all(|(_, material)| material.measure() == Modulus::Young);
    let (modulus, compliance) = if young { ("E", "D") } else { ("modulus", "compliance") };
    let time = || Axis::log("time", "s");
    let frequency = || Axis::log("angular frequency", "rad/s");
    let mut relaxing = Curves::new("Relaxation", time(), Axis::log(format!("relaxation {modulus}"), "Pa"));
    let mut creeping = Curves::new("Creep", time(), Axis::log(format!("creep {compliance}"), "1/Pa"));
    let mut dynamic = Curves::new("Storage and loss", frequency(), Axis::log("modulus", "Pa"));
    let mut factor = Curves::new("Loss factor", frequency(), Axis::log("tan delta", ""));
    for (name, material) in materials {
        let relaxation = material.relaxation()?;
        let of = |f: &dyn Fn(f64) -> f64, xs: &[f64]| xs.iter().map(|x| f(*x)).collect::<Vec<f64>>();
        let line = |name: String, xs: &[f64], f: &dyn Fn(f64) -> f64| {
            Series::new(name, Style::Line, xs.to_vec(), of(f, xs))
        };
        relaxing = relaxing.with(line((*name).into(), &times, &|t| relaxation.value(t)));
        creeping = creeping.with(line((*name).into(), &times, &|t| material.creep().value(t)));
        let storage = |w: f64| relaxation.complex(w).0;
        let loss = |w: f64| relaxation.complex(w).1;
        dynamic = dynamic.with(line(format!("{name}, storage"), &frequencies, &storage));
        dynamic = dynamic.with(Series::new(
            format!("{name}, loss"),
            Style::Dashed,
            frequencies.clone(),
            of(&loss, &frequencies),
        ));
        factor = factor.with(line((*name).into(), &frequencies, &|w| loss(w) / storage(w)));
    }
    Ok(Figure::new(title).with(relaxing).with(creeping).with(dynamic).with(factor))
}

/// q C(q) of bodies of layers and the contact modulus 2/(q C) of the half-space that yields as much, over the length of the
/// wave.
pub fn layers(title: &str, waves: &[WaveReport]) -> Figure {
    let lengths: Vec<f64> = waves.iter().map(|wave| wave.length).collect();
    let relaxed: Vec<f64> = waves.iter().map(|wave| wave.relaxed_modulus).collect();
    let at_once: Vec<f64> =
        waves.iter().map(|wave| wave.instantaneous_modulus.unwrap_or(f64::INFINITY)).collect();
    let creeps = at_once.iter().zip(&relaxed).any(|(at_once, relaxed)| at_once != relaxed);
    let panel = |title: &str, axis: Axis, of: fn(f64) -> f64| {
        let line = |name: &str, moduli: &[f64]| {
            let values: Vec<f64> = moduli.iter().map(|modulus| of(*modulus)).collect();
            Series::new(name, Style::Line, lengths.clone(), values)
        };
        let panel = Curves::new(title, Axis::log("length of the wave", "m"), axis);
        match creeps {
            true => panel.with(line("at once", &at_once)).with(line("at last", &relaxed)),
            false => panel.with(line("", &relaxed)),
        }
    };
    Figure::new(title)
        .with(panel("Response of the layers", Axis::log("q C(q)", "1/Pa"), |modulus| 2.0 / modulus))
        .with(panel("Half-space that yields as much", Axis::log("contact modulus", "Pa"), |modulus| modulus))
}

/// Most temperatures that the legend of a picture names.
const MOST_NAMES: usize = 9;

/// Measured curves in the colours of their temperatures, from the coldest (dark) to the warmest (bright).
pub fn isotherms(title: &str, measured: &Measured) -> Figure {
    let (x, scale) = match measured.kind {
        Kind::Dma => (Axis::log("frequency", "Hz"), std::f64::consts::TAU),
        _ => (Axis::log("time", "s"), 1.0),
    };
    let panels = match measured.kind {
        Kind::Relaxation => vec![("Relaxation", Axis::log("relaxation modulus", "Pa"))],
        Kind::Creep => vec![("Creep", Axis::log("creep compliance", "1/Pa"))],
        Kind::Dma => {
            vec![("Storage", Axis::log("storage modulus", "Pa")), ("Loss", Axis::log("loss modulus", "Pa"))]
        }
    };
    let count = measured.sweeps.len();
    let every = count.div_ceil(MOST_NAMES).max(1);
    let panels = panels.iter().enumerate().map(|(n, (title, y))| {
        measured.sweeps.iter().enumerate().fold(
            Curves::new(*title, x.clone(), y.clone()),
            |panel, (k, sweep)| {
                let name = match sweep.temperature {
                    Some(kelvin) if k % every == 0 || k + 1 == count => format!("{:.0} °C", kelvin - 273.15),
                    _ => String::new(),
                };
                let places: Vec<f64> = sweep.x.iter().map(|x| x / scale).collect();
                let values = sweep.curves.get(n).cloned().unwrap_or_default();
                let colour = temperature_colour(k as f64 / (count.max(2) - 1) as f64);
                let points =
                    Series::new("", Style::Points, places.clone(), values.clone()).in_colour(colour.clone());
                panel.with(points).with(Series::new(name, Style::Line, places, values).in_colour(colour))
            },
        )
    });
    let caption = format!("{}, {}.", counted(count, "sweep"), counted(measured.points(), "point"));
    panels.fold(Figure::new(title), Figure::with).caption(caption)
}

/// From dark blue (0) over red to yellow (1), without the brightest end.
fn temperature_colour(share: f64) -> String {
    let colour = colorous::PLASMA.eval_continuous(0.88 * share.clamp(0.0, 1.0));
    format!("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b)
}

/// The measured points and the function fitted to them, and their relative distance.
///
/// # Errors
/// [`asperity::Error`] where a creep function has no relaxation function.
pub fn fit(title: &str, measured: &Measured, fitted: &Fitted) -> asperity::Result<Figure> {
    let relaxation = fitted.material.relaxation()?;
    let (x, curves): (Axis, Vec<(&str, &str, Function<'_>)>) = match measured.kind {
        Kind::Relaxation => {
            (Axis::log("time", "s"), vec![("relaxation modulus", "Pa", Function::Relaxation(&relaxation))])
        }
        Kind::Creep => (
            Axis::log("time", "s"),
            vec![("creep compliance", "1/Pa", Function::Creep(fitted.material.creep()))],
        ),
        Kind::Dma => (
            Axis::log("angular frequency", "rad/s"),
            vec![
                ("storage", "Pa", Function::Storage(&relaxation)),
                ("loss", "Pa", Function::Loss(&relaxation)),
            ],
        ),
    };
    let y = match curves.as_slice() {
        [(name, unit, _)] => Axis::log(*name, *unit),
        _ => Axis::log("modulus", "Pa"),
    };
    let MasterCurve { x: places, curves: values } = &fitted.data;
    let positive = places.iter().copied().filter(|x| *x > 0.0);
    let ends = [positive.clone().fold(f64::INFINITY, f64::min), positive.fold(0.0, f64::max)];
    let fine = decades(ends);
    let mut panel = Curves::new("Data and fit", x.clone(), y);
    let mut distance = Curves::new("Distance", x, Axis::linear("fit / data - 1", ""));
    for ((name, _, function), values) in curves.iter().zip(values) {
        let at = |xs: &[f64]| xs.iter().map(|x| function.value(*x)).collect::<Vec<f64>>();
        panel =
            panel.with(Series::new(format!("{name}, data"), Style::Points, places.clone(), values.clone()));
        panel = panel.with(Series::new(format!("{name}, fit"), Style::Line, fine.clone(), at(&fine)));
        let apart: Vec<f64> = at(places).iter().zip(values).map(|(fit, data)| fit / data - 1.0).collect();
        distance = distance.with(Series::new(*name, Style::Points, places.clone(), apart));
    }
    let columns: Vec<String> = fitted
        .columns
        .iter()
        .map(|(name, m)| format!("{name} {:.2} % rms, {:.2} % at most", 100.0 * m.rms, 100.0 * m.max))
        .collect();
    let caption = format!(
        "{}; misfit of {}; scatter of the data {:.2} %.",
        counted(fitted.terms(), "term"),
        columns.join("; "),
        100.0 * fitted.noise
    );
    Ok(Figure::new(title).with(panel).with(distance).caption(caption))
}

/// The record of an indentation and the model of its fitted channel: over time, over the depth, and their distance.
pub fn indentation(title: &str, record: &Indentation, fit: &IndentationFit) -> Figure {
    let pick = |column: &[f64]| -> Vec<f64> {
        fit.rows.iter().filter_map(|row| column.get(*row).copied()).collect()
    };
    let [times, loads, depths] = [&record.times, &record.loads, &record.depths].map(|column| pick(column));
    let (name, unit, measured) = match fit.given {
        Given::Depth => ("load", "N", &loads),
        Given::Load => ("depth", "m", &depths),
    };
    let points = |x: &[f64], y: &[f64]| Series::new("measured", Style::Points, x.to_vec(), y.to_vec());
    let line = |x: &[f64], y: &[f64]| Series::new("model", Style::Line, x.to_vec(), y.to_vec());
    let over_time = Curves::new("Over time", Axis::linear("time", "s"), Axis::linear(name, unit))
        .with(points(&times, measured))
        .with(line(&times, &fit.predicted));
    let (model_depths, model_loads) = match fit.given {
        Given::Depth => (&depths, &fit.predicted),
        Given::Load => (&fit.predicted, &loads),
    };
    let over_depth = Curves::new("Load over depth", Axis::linear("depth", "m"), Axis::linear("load", "N"))
        .with(points(&depths, &loads))
        .with(line(model_depths, model_loads));
    let distance: Vec<f64> =
        fit.predicted.iter().zip(measured).map(|(model, measured)| model - measured).collect();
    let apart = Curves::new("Model less measurement", Axis::linear("time", "s"), Axis::linear(name, unit))
        .with(Series::new("", Style::Points, times.clone(), distance));
    let caption = format!(
        "{}; misfit {:.2} % rms of the largest {name}; Durbin-Watson {:.2}.",
        counted(fit.terms.len(), "term"),
        100.0 * fit.relative_rms,
        fit.durbin_watson
    );
    Figure::new(title).with(over_time).with(over_depth).with(apart).caption(caption)
}

/// What a kind of measurement shows of a material.
enum Function<'a> {
    Relaxation(&'a Relaxation),
    Creep(&'a Creep),
    Storage(&'a Relaxation),
    Loss(&'a Relaxation),
}

impl Function<'_> {
    fn value(&self, x: f64) -> f64 {
        match self {
            Function::Relaxation(relaxation) => relaxation.value(x),
            Function::Creep(creep) => creep.value(x),
            Function::Storage(relaxation) => relaxation.complex(x).0,
            Function::Loss(relaxation) => relaxation.complex(x).1,
        }
    }
}

/// Places from one end to the other, evenly on a logarithmic scale.
fn decades([first, last]: [f64; 2]) -> Vec<f64> {
    let decades = (last / first).log10();
    if !(decades.is_finite() && decades > 0.0) {
        return vec![first, last];
    }
    let steps = (PER_DECADE * decades).ceil().clamp(1.0, MOST);
    (0..=steps as usize).map(|k| first * 10f64.powf(decades * k as f64 / steps)).collect()
}
