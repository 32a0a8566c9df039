//! What is prescribed over time, and whether bodies and times can follow it.

use std::ops::Range;

use asperity::{Control, Grid, History, Loading, TimeGrid};

use super::body::Pair;
use super::{Checks, history_file};
use crate::case::quantity::range::{Finite, NonNegative};
use crate::case::quantity::{Prescribed, QuantityError, dimension};
use crate::case::raw::{self, At, Two};
use crate::case::words::number;

/// What is prescribed, and where in the case its largest value stands.
pub struct Prescription {
    pub loading: Loading,
    place: Range<usize>,
    /// Path as written and MD5 of a file that holds the history.
    pub file: Option<(String, String)>,
}

pub fn prescription(checks: &mut Checks<'_, '_>, load: &raw::Load) -> Option<Prescription> {
    let control = match load.control {
        raw::Control::Load => Control::Load,
        raw::Control::Pressure => Control::Pressure,
        raw::Control::Approach => Control::Approach,
    };
    let mut file = None;
    let (history, place) = history(checks, control, &load.history, &mut file)?;
    let history = checks.core(&load.history.span, history.validate().map(|()| history))?;
    Some(Prescription { loading: Loading { control, history }, place, file })
}

/// Whether the bodies can follow what is prescribed.
pub fn possible(
    checks: &mut Checks<'_, '_>,
    load: &raw::Load,
    prescription: &Prescription,
    times: &TimeGrid,
    grid: Option<&Grid>,
    pair: &Pair,
) {
    let Prescription { loading, place, .. } = prescription;
    if let Some(grid) = grid {
        bearable(checks, loading, place, times.end(), grid, pair);
    }
    jumps(checks, loading, &load.history.span, times.end(), pair);
}

/// The history, and the place of its largest value.
fn history(
    checks: &mut Checks<'_, '_>,
    control: Control,
    at: &At<raw::History>,
    read: &mut Option<(String, String)>,
) -> Option<(History, Range<usize>)> {
    let one = |checks: &mut Checks<'_, '_>, value: &At<Prescribed>| {
        checks.quantity(value, resolve(&value.value, control))
    };
    Some(match &at.value {
        raw::History::Step(step) => {
            (History::Step { value: one(checks, &step.value)? }, step.value.span.clone())
        }
        raw::History::Ramp(ramp) => {
            let value = one(checks, &ramp.value)?;
            (History::Ramp { value, duration: ramp.duration.get() }, ramp.value.span.clone())
        }
        raw::History::Triangle(triangle) => {
            let peak = one(checks, &triangle.peak)?;
            let [rise, fall] = [triangle.rise.get(), triangle.fall.get()];
            (History::Triangle { peak, rise, fall }, triangle.peak.span.clone())
        }
        raw::History::Trapezoid(trapezoid) => {
            let peak = one(checks, &trapezoid.peak)?;
            let [rise, hold, fall] = [trapezoid.rise.get(), trapezoid.hold.get(), trapezoid.fall.get()];
            (History::Trapezoid { peak, rise, hold, fall }, trapezoid.peak.span.clone())
        }
        raw::History::Sine(sine) => (sinusoid(checks, control, sine)?, sine.mean.span.clone()),
        raw::History::Table(table) => table_points(checks, control, table)?,
        raw::History::File(file) => {
            let path = checks.file(&file.path)?;
            match history_file::read(&path, |value| resolve(value, control)) {
                Ok(history) => {
                    *read = Some((file.path.value.clone(), history.digest));
                    (History::Table { points: history.points }, file.path.span.clone())
                }
                Err(reason) => {
                    let message = format!("{}: {reason}", path.display());
                    checks.fault(&file.path.span, message, "a file of two columns, time and value", None);
                    return None;
                }
            }
        }
    })
}

/// The value in SI, in the dimension that the control has. A load presses; an approach may be negative.
fn resolve(value: &Prescribed, control: Control) -> Result<f64, QuantityError> {
    match control {
        Control::Load => value.resolve::<dimension::Force, NonNegative>().map(|v| v.get()),
        Control::Pressure => value.resolve::<dimension::Pressure, NonNegative>().map(|v| v.get()),
        Control::Approach => value.resolve::<dimension::Length, Finite>().map(|v| v.get()),
    }
    .map_err(|error| match (control, error.help) {
        (Control::Load | Control::Pressure, None) => {
            let help = "the bodies do not adhere; to pull them apart prescribe the approach";
            QuantityError { expected: error.expected, help: Some(help.into()) }
        }
        (_, help) => QuantityError { expected: error.expected, help },
    })
}

fn sinusoid(checks: &mut Checks<'_, '_>, control: Control, sine: &raw::Sine) -> Option<History> {
    let mean = checks.quantity(&sine.mean, resolve(&sine.mean.value, control));
    let amplitude = checks.quantity(&sine.amplitude, resolve(&sine.amplitude.value, control));
    let (mean, amplitude) = (mean?, amplitude?);
    if control != Control::Approach && amplitude > mean {
        let help = "the load would become negative; raise the mean or lower the amplitude";
        checks.wrong(
            &sine.amplitude.span,
            &format!("at most the mean, {} {}", number(mean), unit(control)),
            Some(help),
        );
        return None;
    }
    Some(History::Sine { mean, amplitude, frequency: sine.frequency.get() })
}

fn table_points(
    checks: &mut Checks<'_, '_>,
    control: Control,
    table: &raw::Table,
) -> Option<(History, Range<usize>)> {
    let mut points = Vec::with_capacity(table.points.value.len());
    let mut good = true;
    let mut largest = (f64::NEG_INFINITY, table.points.span.clone());
    for point in &table.points.value {
        let Two(time, value) = &point.value;
        let time = time.get();
        if let Some((before, _)) = points.last()
            && time < *before
        {
            good = false;
            let expected = format!("a point at {} s or later, as the point before it", number(*before));
            checks.wrong(&point.span, &expected, Some("list the points in order of time"));
        }
        match checks.quantity(value, resolve(&value.value, control)) {
            Some(value_si) => {
                if value_si > largest.0 {
                    largest = (value_si, value.span.clone());
                }
                points.push((time, value_si));
            }
            None => good = false,
        }
    }
    if let (Some(first), Some((time, _))) = (table.points.value.first(), points.first())
        && good
        && *time != 0.0
    {
        good = false;
        checks.wrong(&first.span, "a point at 0 s", Some("say what the value is at the start"));
    }
    good.then_some((History::Table { points }, largest.1))
}

/// No solution exists above hardness times area.
fn bearable(
    checks: &mut Checks<'_, '_>,
    loading: &Loading,
    place: &Range<usize>,
    end: f64,
    grid: &Grid,
    pair: &Pair,
) {
    let limit = match loading.control {
        Control::Load => pair.hardness * grid.area(),
        Control::Pressure => pair.hardness,
        Control::Approach => return,
    };
    let [_, largest] = loading.history.range(end);
    // Equality within rounding is the limit itself, which has a solution.
    if largest <= limit * (1.0 + 1e-12) {
        return;
    }
    let unit = unit(loading.control);
    let [reached, limit, hardness] = [largest, limit, pair.hardness].map(number);
    let area = match loading.control {
        Control::Load => format!(" times the area {} m^2", number(grid.area())),
        _ => String::new(),
    };
    let message = format!(
        "the history reaches {reached} {unit}, but the bodies bear at most {limit} {unit}, the hardness \
         {hardness} Pa{area}"
    );
    let help = "lower the load, raise the hardness or enlarge the domain";
    checks.fault(place, message, &format!("{limit} {unit} at most"), Some(help));
}

/// Bodies that do not yield at once cannot follow a jump: no state exists right after it.
fn jumps(checks: &mut Checks<'_, '_>, loading: &Loading, place: &Range<usize>, end: f64, pair: &Pair) {
    if pair.instantaneous() > 0.0 {
        return;
    }
    let history = &loading.history;
    let instants = std::iter::once(0.0).chain(history.breaks(end));
    let jump = instants.map(|t| (t, history.before(t), history.after(t))).find(|(_, b, a)| a != b);
    let Some((t, before, after)) = jump else { return };
    let unit = unit(loading.control);
    let [t, before, after] = [t, before, after].map(number);
    let message = format!(
        "the history jumps from {before} to {after} {unit} at t = {t} s, but the bodies do not yield at once \
         (Kelvin-Voigt: no instantaneous compliance), so no state exists right after the jump"
    );
    let help = "use a ramp, or a material with an instantaneous modulus (zener, prony)";
    checks.fault(place, message, "a history without jumps", Some(help));
}

fn unit(control: Control) -> &'static str {
    match control {
        Control::Load => "N",
        Control::Pressure => "Pa",
        Control::Approach => "m",
    }
}
