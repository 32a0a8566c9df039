//! Area, pressure, approach and load of a contact.

use std::f64::consts::FRAC_PI_4;

use asperity::quantities::ROW_COLUMNS;
use asperity::spots::labels;
use asperity::step::Row;
use asperity::{Axis, Boundary, Control};
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
    let share = of_rim(edge, row.contact_area);
    for answer in &mut answers {
        answer.resolution = match answer.name.as_str() {
            "contact_area" | "contact_area_corrected" => edge,
            "contact_fraction" => edge / grid.extents().iter().product::<f64>(),
            "max_pressure" | "approach" | "load" => share * answer.value.abs(),
            _ => 0.0,
        };
    }
    // What wears approaches and relaxes without creep.
    let held = while_held(&rows[..=n], held_approach).filter(|_| !reader.header().wears());
    answers.extend(held.map(|answer| answer.at(row)));
    Ok(answers)
}

/// How far the counted area may be off because cells touch as a whole \[m², on a line m\]. The rim of a spot lies within half a cell of
/// where it is counted, and the whole rim of a small or regular spot may lie off in the same direction: then the area of the spot is off
/// by half a cell times the length of the rim. That is π/4 of the length of the cells' sides, which is 4/π of that of the rim in the mean
/// over its directions; on a line both ends count. The spots are independent of each other, so the squares add. 0 where the result stores
/// no map of the contact.
fn edge(reader: &Reader, row: &Row) -> Result<f64> {
    if reader.contact_kind().is_none() || reader.field_times().is_empty() {
        return Ok(0.0);
    }
    let header = reader.header();
    let states = reader.contact_states(At::Time(row.coordinate.value()))?;
    let boundary = if header.is_periodic() { Boundary::Periodic } else { Boundary::Free };
    let sides = sides_of_spots(labels(boundary, states.view(), |state| *state > 0).view(), boundary);
    let along = if header.grid.is_line() { 1.0 } else { FRAC_PI_4 };
    let squares: f64 = sides.iter().map(|n| (0.5 * along * f64::from(*n)).powi(2)).sum();
    Ok(squares.sqrt() * header.grid.cell_area())
}

/// How far approach, load and pressure may be off, relative, because cells touch as a whole. With the radius a off by da the approach
/// under a given load, a²/(3 R) + F/(2 E* a), is off by (da/a)² of it (Hertz: it is least at the right radius). A contact of a few cells
/// may have its rim one cell off; `edge`, half a cell along the rim, is the share da/a of the area then.
fn of_rim(edge: f64, area: f64) -> f64 {
    if area > 0.0 { (edge / area).min(1.0).powi(2) } else { 0.0 }
}

/// How many sides of cells each spot has towards cells that do not touch.
fn sides_of_spots(spots: ArrayView2<'_, u32>, boundary: Boundary) -> Vec<u32> {
    let mut sides = vec![0; spots.iter().max().map_or(0, |most| *most as usize)];
    for lines in [spots, spots.t()] {
        let count = lines.nrows();
        // A line of cells has no sides along itself.
        let pairs = if boundary == Boundary::Periodic && count > 1 { count } else { count.saturating_sub(1) };
        for n in 0..pairs {
            for (a, b) in lines.row(n).iter().zip(lines.row((n + 1) % count)) {
                match [*a, *b] {
                    [spot, 0] | [0, spot] if spot > 0 => sides[spot as usize - 1] += 1,
                    _ => {}
                }
            }
        }
    }
    sides
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
    .filter(|answer| {
        answer.value != 0.0
            && answer.value.abs() > NOISE * if answer.unit == "1" { 1.0 } else { last.approach.abs() }
    })
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::*;

    #[test]
    fn sides_are_counted_spot_by_spot() {
        // A spot of three cells and one of one cell.
        let spots = array![[0, 0, 0, 0], [1, 1, 0, 0], [1, 0, 0, 2], [0, 0, 0, 0]];
        assert_eq!(sides_of_spots(spots.view(), Boundary::Free), [6, 3]);
        // The border of a free domain is no side, and a periodic domain has none.
        let whole = array![[0, 0, 0, 0], [1, 1, 0, 0], [1, 0, 0, 1], [0, 0, 0, 0]];
        assert_eq!(sides_of_spots(whole.view(), Boundary::Periodic), [10]);
        assert_eq!(sides_of_spots(array![[0], [1], [1], [0]].view(), Boundary::Periodic), [2]);
    }
}
