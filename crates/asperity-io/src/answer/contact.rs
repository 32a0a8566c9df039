//! Area, pressure, approach and load of a contact.

use asperity::Control;
use asperity::quantities::ROW_COLUMNS;
use asperity::step::Row;

use super::Answer;
use crate::store::Reader;

/// A prescribed value is held where it stays the same but for its rounding.
const HELD: f64 = 1e-9;

/// The answers of the row `n`.
pub(super) fn of(reader: &Reader, rows: &[Row], n: usize) -> Vec<Answer> {
    let grid = &reader.header().grid;
    let row = &rows[n];
    let column = |name: &str| {
        let column = ROW_COLUMNS.iter().find(|column| column.name == name)?;
        Some(Answer::new(column.name, column.of(row), grid.units(column.units)).at(row))
    };
    let held_approach = reader.header().controls().get(row.stage) == Some(&Control::Approach);
    let answer = if held_approach { "load" } else { "approach" };
    let mut names =
        vec!["contact_area", "contact_area_corrected", "contact_fraction", "max_pressure", answer];
    names.retain(|name| !(grid.is_line() && *name == "contact_area_corrected"));
    if row.capped_area > 0.0 {
        names.push("capped_area");
    }
    let mut answers: Vec<Answer> = names.into_iter().filter_map(column).collect();
    answers.extend(while_held(&rows[..=n], held_approach).map(|answer| answer.at(row)));
    answers
}

/// How much the approach has grown since the load is held, or which share of the load has relaxed since the approach is held.
fn while_held(rows: &[Row], held_approach: bool) -> Option<Answer> {
    let given = |row: &Row| if held_approach { row.approach } else { row.load };
    let last = rows.last()?;
    let is_held =
        |row: &Row| row.stage == last.stage && (given(row) - given(last)).abs() <= HELD * given(last).abs();
    let first = rows.iter().rev().take_while(|row| is_held(row)).last()?;
    if last.coordinate.value() <= first.coordinate.value() || given(last) == 0.0 {
        return None;
    }
    Some(match held_approach {
        true => Answer::new("relaxation", 1.0 - last.load / first.load, "1"),
        false => Answer::new("creep", last.approach - first.approach, "m"),
    })
    .filter(|answer| answer.value != 0.0)
}
