//! The largest stress below the surface, and the load at which the body yields.

use asperity::Axis;

use super::Answer;
use super::extreme::Course;
use crate::readable::quantity;
use crate::store::{Reader, Result};
use crate::stress::{Below, FirstYield, first_yield};

/// The answers at the time of the largest von Mises stress; none where no stress was computed.
pub(super) fn of(reader: &Reader) -> Result<Vec<Answer>> {
    let Some(below) = Below::of(reader)? else { return Ok(vec![]) };
    let Some(worst) = below.worst() else { return Ok(vec![]) };
    let values: Vec<f64> = below.instants.iter().map(|instant| below.number(instant, "max_mises")).collect();
    let times: Vec<f64> = below.instants.iter().map(|instant| instant.time).collect();
    let largest = below.instants.iter().position(|instant| std::ptr::eq(instant, worst)).unwrap_or_default();
    let open = Course::along(&times, vec![values.clone()]).open_at(&values, largest);
    let number = |name: &'static str, unit| Answer::new(name, below.number(worst, name), unit);
    let rows = reader.rows()?;
    let at = rows.get(worst.row).map(|row| row.coordinate);
    let when = at
        .map_or(String::new(), |at| format!(", at {}", quantity(at.value(), reader.header().axis().unit())));
    let note = format!("of {}, the largest of all computed {}{when}", below.set.body, below.axis.plural());
    let mut answers: Vec<Answer> =
        [number("max_mises", "Pa").of_rows(open).with_note(note), number("max_mises_depth", "m")]
            .map(|answer| Answer { at, ..answer })
            .into();
    if let Some(first) = first_yield(&below) {
        let load = match first {
            FirstYield::Never { .. } => f64::NAN,
            FirstYield::AtOnce([_, load]) | FirstYield::Between([_, [_, load]]) => load,
        };
        let answer = Answer::new("first_yield_load", load, below.grid.units("N"));
        let open = match first {
            FirstYield::Between([[_, before], [_, load]]) => (load - before).abs(),
            _ => 0.0,
        };
        // Over velocities the load is the same.
        if below.axis == Axis::Time {
            answers.push(answer.of_rows(open).with_note(first.sentence(&below)));
        }
    }
    Ok(answers)
}
