//! Answers on the terminal, and the option --unit.

use asperity::step::Row;
use asperity::{Axis, Grid};
use asperity_io::answer::{self, Answer, Units};
use asperity_io::converge::ErrorBar;
use asperity_io::store::Reader;
use serde_json::{Value, json};

use crate::failure::{Failure, refuse};
use crate::format::quantity;

/// Letters of the first column of a summary.
const WIDTH: usize = 26;

/// A line of a summary.
pub fn line(name: &str, value: impl std::fmt::Display) -> String {
    format!("{name:<WIDTH$} {value}\n")
}

/// Name and words of each answer, with its error where one of `bars` has it, and with what the findings say of it.
pub fn lines(answers: &[Answer], bars: &[ErrorBar], units: &Units) -> Vec<[String; 2]> {
    let words = |answer: &Answer| {
        let bar = bars.iter().find(|bar| bar.name == answer.name);
        answer.validity.mark(bar.map_or_else(|| alone(answer, units), |bar| with_error(answer, bar, units)))
    };
    units.without_second_rate(answers).map(|answer| [answer.label(), words(answer)]).collect()
}

/// The errors of answers as JSON, each with what the findings say of its answer.
pub fn bars(answers: &[Answer], bars: &[ErrorBar]) -> Value {
    let told = |bar: &ErrorBar| {
        let mut object = json!(bar);
        let answer = answers.iter().find(|answer| answer.name == bar.name);
        if let (Some(told), Value::Object(marks)) =
            (object.as_object_mut(), json!(answer.map(|answer| &answer.validity)))
        {
            told.extend(marks);
        }
        object
    };
    bars.iter().map(told).collect()
}

fn alone(answer: &Answer, units: &Units) -> String {
    let value = answer.words(units);
    match answer.note.as_str() {
        "" => value,
        note if answer.value.is_nan() => note.to_owned(),
        note => format!("{value} ({note})"),
    }
}

fn with_error(answer: &Answer, bar: &ErrorBar, units: &Units) -> String {
    let order = bar.order.map_or(String::new(), |order| format!("order {order:.1}"));
    let more = [order, bar.note.clone(), answer.note.clone()].into_iter().filter(|text| !text.is_empty());
    [units.with_error(bar)].into_iter().chain(more).collect::<Vec<_>>().join("; ")
}

/// The row that the answers about the contact belong to: "t = 10 s, the last of 20, under 2 N".
pub fn row(
    answers: &[Answer],
    units: &Units,
    grid: &Grid,
    last: Option<&Row>,
    rows: usize,
) -> Option<String> {
    let at = answers.iter().find(|answer| answer.name == "contact_area")?.at?;
    let axis = at.axis();
    let place = format!("{} = {}", axis.symbol(), units.number(at.value(), axis.unit()));
    Some(match (axis, last) {
        (_, Some(last)) if last.coordinate == at => {
            format!("{place}, the last of {rows}, under {}", quantity(last.load, grid.units("N")))
        }
        (Axis::Velocity, _) => format!("{place}, with the largest friction"),
        _ => {
            let adheres = answers.iter().any(|answer| answer.name == "pull_off_force");
            let largest = if adheres { "approach" } else { "load" };
            format!("{place}, with the largest {largest}; nothing touches at the end")
        }
    })
}

/// The units of the options `--unit leak=ml/year`.
pub fn units(options: &[String]) -> Result<Units, Failure> {
    let mut units = Units::default();
    for option in options {
        let Some((name, unit)) = option.split_once('=') else {
            let message = "expected a name and a unit, e.g. --unit leak=ml/year or --unit time=h";
            refuse!("--unit {option}: {message}");
        };
        let name = name.trim();
        if let Some(earlier) = units.text(name) {
            let message = format!("{name} has the unit {earlier} already; give one unit for each");
            refuse!("--unit {option}: {message}");
        }
        let chosen = units.choose(name, unit.trim());
        chosen.map_err(Failure::about(format!("--unit {option}")))?;
    }
    Ok(units)
}

/// The units of a command for results: those of the options, with which the others of the case of the first result hold. A unit that no
/// number of any result has is noted.
pub fn units_of(options: &[String], readers: &[Reader]) -> Result<Units, Failure> {
    let given = units(options)?;
    if !given.is_empty() {
        let mut found = vec![];
        for reader in readers {
            found.extend(answer::of(reader, &given)?);
        }
        note_unused(&given, &found);
    }
    Ok(readers.first().map_or(given.clone(), |first| Units::of(first, &given)))
}

/// Notes each unit of the options that none of the answers can be given in: of leaks where nothing leaks, of times where no time passes.
pub fn note_unused(given: &Units, answers: &[Answer]) {
    let is_used = |name: &str| match name {
        "leak" => answers.iter().any(|answer| answer.name.starts_with("leak_rate")),
        _ => answers
            .iter()
            .any(|answer| answer.unit == "s" || answer.at.is_some_and(|at| at.axis() == Axis::Time)),
    };
    for (name, unit) in given.chosen().filter(|(name, _)| !answers.is_empty() && !is_used(name)) {
        let why = if name == "leak" { "there is no leak rate" } else { "no time passes" };
        crate::messages::message!("note: --unit {name}={unit} changes nothing: {why} in what is shown");
    }
}

/// The same as keys of a case.
pub fn keys(units: &Units) -> Vec<String> {
    units.chosen().map(|(name, unit)| format!("output.units.{name}={unit}")).collect()
}
