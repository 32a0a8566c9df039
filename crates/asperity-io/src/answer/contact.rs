//! Area, pressure, approach and load of a contact.

use asperity::quantities::ROW_COLUMNS;
use asperity::step::Row;
use asperity::{Axis, Control};
use ndarray::ArrayView2;

use super::Answer;
use crate::store::{At, Reader, Result};

/// A prescribed value is held where it stays the same but for its rounding.
const HELD: f64 = 1e-9;

/// A smaller relaxation is what the solver leaves open.
const NOISE: f64 = 1e-5;

/// The answers of the row `n`.
pub(super) fn of(reader: &Reader, rows: &[Row], n: usize) -> Result<Vec<Answer>> {
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
    let edge = edge(reader, row)?;
    for answer in &mut answers {
        answer.resolution = match answer.name.as_str() {
            "contact_area" | "contact_area_corrected" => edge,
            "contact_fraction" => edge / grid.extents().iter().product::<f64>(),
            _ => 0.0,
        };
    }
    answers.extend(while_held(&rows[..=n], held_approach).map(|answer| answer.at(row)));
    Ok(answers)
}

/// How far the counted area may be off because cells touch as a whole \[m², on a line m\]: each straight piece of the edge of the contact
/// lies somewhere within half a cell of where it is counted, independently of the others. With pieces of l cells this is
/// sqrt(sum l²)/2 cells. 0 where the result stores no map of the contact.
fn edge(reader: &Reader, row: &Row) -> Result<f64> {
    if reader.contact_kind().is_none() || reader.field_times().is_empty() {
        return Ok(0.0);
    }
    let states = reader.contact_states(At::Time(row.coordinate.value()))?;
    let touches = states.mapv(|state| state > 0);
    let pieces = squares_of_pieces(touches.view()) + squares_of_pieces(touches.t());
    Ok(0.5 * pieces.sqrt() * reader.header().grid.cell_area())
}

/// Sum of the squares of the lengths of the pieces of edge between one row of cells and the next.
fn squares_of_pieces(touches: ArrayView2<'_, bool>) -> f64 {
    let mut sum = 0.0;
    for (one, next) in touches.outer_iter().zip(touches.outer_iter().skip(1)) {
        let (mut length, mut side) = (0_u32, 0);
        for (a, b) in one.iter().zip(next) {
            let now = i32::from(*a) - i32::from(*b);
            if now != side {
                sum += f64::from(length).powi(2);
                (length, side) = (0, now);
            }
            length += u32::from(now != 0);
        }
        sum += f64::from(length).powi(2);
    }
    sum
}

/// How much the approach has grown since the load is held, or which share of the load has relaxed since the approach is held.
fn while_held(rows: &[Row], held_approach: bool) -> Option<Answer> {
    let given = |row: &Row| if held_approach { row.approach } else { row.load };
    let last = rows.last()?;
    let is_held =
        |row: &Row| row.stage == last.stage && (given(row) - given(last)).abs() <= HELD * given(last).abs();
    if last.coordinate.axis() != Axis::Time {
        return None;
    }
    let first = rows.iter().rev().take_while(|row| is_held(row)).last()?;
    if last.coordinate.value() <= first.coordinate.value() || given(last) == 0.0 {
        return None;
    }
    Some(match held_approach {
        true => Answer::new("relaxation", 1.0 - last.load / first.load, "1"),
        false => Answer::new("creep", last.approach - first.approach, "m"),
    })
    .filter(|answer| answer.value != 0.0 && (answer.unit != "1" || answer.value.abs() > NOISE))
}
