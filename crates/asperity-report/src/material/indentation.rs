//! The record of an indentation and the model fitted to it.

use asperity::indentation::{Given, IndentationFit, PowerLawFit};
use asperity_io::curve::Indentation;
use asperity_io::readable::counted;

use crate::figure::{Axis, Curves, Figure, Series, Style};

/// What a fit says of a record.
struct Fitted<'a> {
    given: Given,
    rows: &'a [usize],
    predicted: &'a [f64],
    caption: String,
}

/// The record of an indentation and the Prony series fitted to it.
pub fn indentation(title: &str, record: &Indentation, fit: &IndentationFit) -> Figure {
    let law = counted(fit.terms.len(), "term");
    let caption = caption(law, fit.given, fit.relative_rms, fit.durbin_watson);
    drawn(title, record, &Fitted { given: fit.given, rows: &fit.rows, predicted: &fit.predicted, caption })
}

/// The record of an indentation and the power law fitted to it.
pub fn power_law(title: &str, record: &Indentation, fit: &PowerLawFit) -> Figure {
    let law = format!("Power law t^-{:.3}", fit.exponent.value);
    let caption = caption(law, fit.given, fit.relative_rms, fit.durbin_watson);
    drawn(title, record, &Fitted { given: fit.given, rows: &fit.rows, predicted: &fit.predicted, caption })
}

fn caption(law: String, given: Given, misfit: f64, durbin_watson: f64) -> String {
    let name = if given == Given::Depth { "load" } else { "depth" };
    format!(
        "{law}; misfit {:.2} % rms of the largest {name}; Durbin-Watson {durbin_watson:.2}.",
        100.0 * misfit
    )
}

/// Record and model of the fitted channel: over time, over the depth, and their distance.
fn drawn(title: &str, record: &Indentation, fit: &Fitted<'_>) -> Figure {
    let pick = |column: &[f64]| -> Vec<f64> {
        fit.rows.iter().filter_map(|row| column.get(*row).copied()).collect()
    };
    let [times, loads, depths] = [&record.times, &record.loads, &record.depths].map(|column| pick(column));
    let (name, unit, measured) = match fit.given {
        Given::Depth => ("load", "N", &loads),
        Given::Load => ("depth", "m", &depths),
    };
    let points = |x: &[f64], y: &[f64]| Series::new("measured", Style::Points, x, y);
    let line = |x: &[f64], y: &[f64]| Series::new("model", Style::Line, x, y);
    let over_time = Curves::new("Over time", Axis::linear("time", "s"), Axis::linear(name, unit))
        .with(points(&times, measured))
        .with(line(&times, fit.predicted));
    let (model_depths, model_loads) = match fit.given {
        Given::Depth => (&depths[..], fit.predicted),
        Given::Load => (fit.predicted, &loads[..]),
    };
    let over_depth = Curves::new("Load over depth", Axis::linear("depth", "m"), Axis::linear("load", "N"))
        .with(points(&depths, &loads))
        .with(line(model_depths, model_loads));
    let distance: Vec<f64> =
        fit.predicted.iter().zip(measured).map(|(model, measured)| model - measured).collect();
    let apart = Curves::new("Model less measurement", Axis::linear("time", "s"), Axis::linear(name, unit))
        .with(Series::new("", Style::Points, &times, distance));
    Figure::new(title).with(over_time).with(over_depth).with(apart).caption(fit.caption.clone())
}
