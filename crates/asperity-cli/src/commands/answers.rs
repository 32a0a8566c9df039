//! Answers on the terminal, and the option --unit.

use asperity::Axis;
use asperity::step::Row;
use asperity_io::answer::{Answer, Units};

use crate::failure::Failure;

/// Letters of the first column of a summary.
const WIDTH: usize = 27;

/// A line of a summary.
pub fn line(name: &str, value: impl std::fmt::Display) -> String {
    format!("{name:<WIDTH$}{value}\n")
}

/// Name and words of each answer.
pub fn lines(answers: &[Answer], units: &Units) -> Vec<[String; 2]> {
    let words = |answer: &Answer| {
        let value = answer.words(units);
        match answer.note.as_str() {
            "" => value,
            note if answer.value.is_nan() => note.to_owned(),
            note => format!("{value} ({note})"),
        }
    };
    // Of a gas one of its two rates is enough.
    let gas = answers.iter().any(|answer| answer.name == "leak_rate_standard");
    let mass = units.is_mass_of_gas();
    let hidden = |answer: &&Answer| match answer.name.as_str() {
        "leak_rate" => gas && !mass,
        "leak_rate_standard" => mass,
        _ => false,
    };
    answers.iter().filter(|answer| !hidden(answer)).map(|answer| [answer.label(), words(answer)]).collect()
}

/// The row that the answers about the contact belong to: "t = 10 s, the last of 20".
pub fn row(answers: &[Answer], units: &Units, last: Option<&Row>, rows: usize) -> Option<String> {
    let at = answers.iter().find(|answer| answer.name == "contact_area")?.at?;
    let why = match (at.axis(), last) {
        (_, Some(last)) if last.coordinate == at => format!("the last of {rows}"),
        (Axis::Velocity, _) => "with the largest friction".into(),
        _ => "with the largest load; nothing touches at the end".into(),
    };
    let axis = at.axis();
    Some(format!("{} = {}, {why}", axis.symbol(), units.number(at.value(), axis.unit())))
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
