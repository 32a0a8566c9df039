//! From the keys of a measured surface to the steps of its preparation.

use std::ops::Range;

use asperity::surface::process::{Band, Outliers, Window};
use asperity::surface::{Level, Operation};

use super::Checks;
use crate::case::raw::prepare as raw;
use crate::case::raw::{At, File};
use crate::preparation::{Crop, Step};

/// More of a surface than this is not filled unless told: it would be invention, not measurement.
const FILL_SHARE: f64 = 0.25;
/// Share of the length over which Tukey's window rises and falls.
const TUKEY_SHARE: f64 = 0.1;

/// The steps in the order in which they are done.
///
/// Without `process`: crop, flip, rotate, invert, level, outliers (and level again without them), fill, circle, filter,
/// window, resample.
pub fn steps(checks: &mut Checks<'_, '_>, file: &File) -> Option<Vec<Step>> {
    let Some(process) = &file.process else { return plain(checks, file) };
    let beside: [(&str, Option<&Range<usize>>); 12] = [
        ("crop", file.crop.as_ref().map(|at| &at.span)),
        ("flip", file.flip.as_ref().map(|at| &at.span)),
        ("rotate", file.rotate.as_ref().map(|at| &at.span)),
        ("invert", file.invert.as_ref().map(|at| &at.span)),
        ("level", file.level.as_ref().map(|at| &at.span)),
        ("outliers", file.outliers.as_ref().map(|at| &at.span)),
        ("fill", file.fill.as_ref().map(|at| &at.span)),
        ("fill_share", file.fill_share.as_ref().map(|at| &at.span)),
        ("circle", file.circle.as_ref().map(|at| &at.span)),
        ("filter", file.filter.as_ref().map(|at| &at.span)),
        ("window", file.window.as_ref().map(|at| &at.span)),
        ("resample", file.resample.as_ref().map(|at| &at.span)),
    ];
    let mut clash = false;
    for (key, span) in beside {
        if let Some(span) = span {
            clash = true;
            let help = "add it to `process` as a step, in the order wanted";
            let message = format!("`{key}` cannot be combined with `process`, which lists all steps");
            checks.fault(span, message, "either `process` or single keys", Some(help));
        }
    }
    let steps: Vec<_> = process.value.iter().map(|at| operation(checks, at)).collect();
    let steps: Option<Vec<Step>> = steps.into_iter().collect();
    steps.filter(|_| !clash)
}

fn plain(checks: &mut Checks<'_, '_>, file: &File) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut whole = true;
    let mut push = |step: Option<Step>| match step {
        Some(step) => steps.push(step),
        None => whole = false,
    };
    if let Some(at) = &file.crop {
        push(crop(checks, at));
    }
    if let Some(at) = &file.flip {
        push(Some(Step::Operation(Operation::Flip(at.value))));
    }
    if let Some(at) = &file.rotate {
        push(Some(Step::Operation(Operation::Rotate { quarter_turns: at.value.get() })));
    }
    if file.invert.as_ref().is_some_and(|at| at.value) {
        push(Some(Step::Operation(Operation::Invert)));
    }
    let form = file.level.as_ref().map_or(Level::Plane, |at| at.value);
    let levelling = (form != Level::None).then_some(Step::Operation(Operation::Level(form)));
    if let Some(step) = levelling.clone() {
        push(Some(step));
    }
    if let Some(at) = &file.outliers {
        // Spikes tilt the form; without them it is fitted anew.
        push(Some(outliers(&at.value)));
        if let Some(step) = levelling {
            push(Some(step));
        }
    }
    let method = file.fill.as_ref().map(|at| at.value).unwrap_or_default();
    let largest_share = file.fill_share.as_ref().map_or(FILL_SHARE, |at| at.value.get());
    push(Some(Step::Operation(Operation::Fill { method, largest_share })));
    if let Some(at) = &file.circle {
        push(Some(Step::Circle { radius: at.value.radius.map(|radius| radius.get()) }));
    }
    if let Some(at) = &file.filter {
        push(filter(checks, at));
    }
    if let Some(at) = &file.window {
        push(window(checks, at));
    }
    if let Some(at) = &file.resample {
        push(Some(Step::Resample { cells: None, method: at.value }));
    }
    whole.then_some(steps)
}

/// One step of `process`.
pub fn operation(checks: &mut Checks<'_, '_>, at: &At<raw::Operation>) -> Option<Step> {
    Some(match &at.value {
        raw::Operation::Level(step) => Step::Operation(Operation::Level(step.form.unwrap_or(Level::Plane))),
        raw::Operation::Fill(step) => Step::Operation(Operation::Fill {
            method: step.method.unwrap_or_default(),
            largest_share: step.share.map_or(FILL_SHARE, |share| share.get()),
        }),
        raw::Operation::Crop(at) => return crop(checks, at),
        raw::Operation::Resample(step) => Step::Resample {
            cells: step.cells.map(|cells| cells.map(|count| count.count())),
            method: step.method.unwrap_or_default(),
        },
        raw::Operation::Filter(at) => return filter(checks, at),
        raw::Operation::Flip(step) => Step::Operation(Operation::Flip(step.axis)),
        raw::Operation::Rotate(step) => Step::Operation(Operation::Rotate {
            quarter_turns: step.quarter_turns.map_or(1, |turns| turns.get()),
        }),
        raw::Operation::Invert(_) => Step::Operation(Operation::Invert),
        raw::Operation::Window(at) => return window(checks, at),
        raw::Operation::Outliers(step) => outliers(step),
        raw::Operation::Circle(step) => Step::Circle { radius: step.radius.map(|radius| radius.get()) },
    })
}

fn crop(checks: &mut Checks<'_, '_>, at: &At<raw::Crop>) -> Option<Step> {
    let raw = &at.value;
    let defined = raw.defined == Some(true);
    let keys = [("cells", raw.cells.is_some()), ("size", raw.size.is_some()), ("defined", defined)];
    checks.exactly_one(&at.span, &keys)?;
    let stray = [("from", raw.from.is_some() && raw.cells.is_none(), "cells")]
        .into_iter()
        .chain([("corner", raw.corner.is_some() && raw.size.is_none(), "size")])
        .find(|(_, stray, _)| *stray);
    if let Some((key, _, partner)) = stray {
        let message = format!("`{key}` belongs to `{partner}`, which is not given");
        let help = "`cells` with `from` counts cells, `size` with `corner` measures lengths";
        checks.fault(&at.span, message, "cells and from, or size and corner", Some(help));
        return None;
    }
    Some(Step::Crop(match (raw.cells, raw.size) {
        (Some(cells), _) => Crop::Cells {
            cells: cells.map(|count| count.count()),
            from: raw.from.map(|from| from.map(|count| count.count())),
        },
        (None, Some(size)) => Crop::Lengths {
            size: size.map(|length| length.get()),
            corner: raw.corner.map(|corner| corner.map(|length| length.get())),
        },
        (None, None) => Crop::Defined,
    }))
}

fn filter(checks: &mut Checks<'_, '_>, at: &At<raw::Filter>) -> Option<Step> {
    let raw = &at.value;
    let [longest, shortest] = [raw.longest, raw.shortest].map(|length| length.map(|length| length.get()));
    match (longest, shortest) {
        (None, None) => {
            let help = "longest drops long waves (high-pass), shortest drops short ones (low-pass)";
            checks.fault(&at.span, "needs `longest` or `shortest`".into(), "a wavelength", Some(help));
            return None;
        }
        (Some(longest), Some(shortest)) if longest < shortest => {
            let message = format!("longest is {longest:e} m, shorter than shortest, {shortest:e} m");
            checks.fault(&at.span, message, "longest >= shortest", Some("exchange the two"));
            return None;
        }
        _ => {}
    }
    let band = Band { longest, shortest, edge: raw.edge.unwrap_or_default() };
    Some(Step::Operation(Operation::Filter(band)))
}

fn window(checks: &mut Checks<'_, '_>, at: &At<raw::Window>) -> Option<Step> {
    let share = at.value.share.map(|share| share.get());
    let window = match (at.value.shape, share) {
        (raw::WindowShape::Hann, None) => Window::Hann,
        (raw::WindowShape::Hann, Some(_)) => {
            let help = "write shape = \"tukey\", or leave share out";
            checks.fault(&at.span, "`share` belongs to Tukey's window".into(), "no share", Some(help));
            return None;
        }
        (raw::WindowShape::Tukey, share) => Window::Tukey { share: share.unwrap_or(TUKEY_SHARE) },
    };
    Some(Step::Operation(Operation::Window(window)))
}

fn outliers(raw: &raw::Outliers) -> Step {
    let default = Outliers::default();
    Step::Operation(Operation::RemoveOutliers(Outliers {
        threshold: raw.threshold.map_or(default.threshold, |threshold| threshold.get()),
        radius: raw.radius.map_or(default.radius, |radius| radius.count()),
    }))
}
