//! Answers on the terminal, and the option --unit.

use asperity::step::Row;
use asperity::{Axis, Grid};
use asperity_io::answer::{Answer, Units};
use asperity_io::converge::ErrorBar;

use crate::failure::Failure;
use crate::format::quantity;

/// Letters of the first column of a summary.
const WIDTH: usize = 26;

/// A line of a summary.
pub fn line(name: &str, value: impl std::fmt::Display) -> String {
    format!("{name:<WIDTH$} {value}\n")
}

/// Name and words of each answer, with its error where one of `bars` has it.
pub fn lines(answers: &[Answer], bars: &[ErrorBar], units: &Units) -> Vec<[String; 2]> {
    let words = |answer: &Answer| match bars.iter().find(|bar| bar.name == answer.name) {
        Some(bar) => with_error(answer, bar, units),
        None => alone(answer, units),
    };
    units.without_second_rate(answers).map(|answer| [answer.label(), words(answer)]).collect()
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
        _ => format!("{place}, with the largest load; nothing touches at the end"),
    })
}

/// The units of the options `--unit leak=ml/year`.
pub fn units(options: &[String]) -> Result<Units, Failure> {
    let mut units = Units::default();
    for option in options {
        let Some((name, unit)) = option.split_once('=') else {
            let message = "expected a name and a unit, e.g. --unit leak=ml/year or --unit time=h";
            return Err(Failure::input(format!("--unit {option}: {message}")));
        };
        let chosen = units.choose(name.trim(), unit.trim());
        chosen.map_err(|error| Failure::input(format!("--unit {option}: {error}")))?;
    }
    Ok(units)
}

/// The same as keys of a case.
pub fn keys(options: &[String]) -> Result<Vec<String>, Failure> {
    units(options)?;
    Ok(options.iter().map(|option| format!("output.units.{option}")).collect())
}
