//! Area, pressure, approach and load of a contact.

use std::f64::consts::{FRAC_PI_4, PI};

use asperity::quantities::ROW_COLUMNS;
use asperity::spots::labels;
use asperity::step::Row;
use asperity::{Axis, Boundary, Control};
use ndarray::ArrayView2;

use super::Answer;
use crate::readable::quantity;
use crate::store::{At, Reader, Result};

/// A prescribed value is held where it stays the same but for its rounding.
const HELD: f64 = 1e-9;

/// A smaller relaxation is what the solver leaves open.
const NOISE: f64 = 1e-5;
/// A load below this share of the largest one is next to nothing.
const SMALL: f64 = 1e-3;

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
    let Edge { open, rim } = Edge::of(reader, row)?;
    let share = of_rim(rim, row.contact_area);
    for answer in &mut answers {
        answer.of_cells = match answer.name.as_str() {
            "contact_area" | "contact_area_corrected" => open,
            "contact_fraction" => open / grid.extents().iter().product::<f64>(),
            "max_pressure" | "approach" | "load" => share * answer.value.abs(),
            _ => 0.0,
        };
    }
    // What wears approaches and relaxes without creep.
    if !reader.header().wears() {
        match while_held(&rows[..=n], held_approach, grid.units("N")) {
            Some(Held::Answer(answer)) => answers.push(answer.at(row)),
            Some(Held::Note(note)) => {
                answers
                    .iter_mut()
                    .filter(|own| own.name == answer)
                    .for_each(|own| own.note.clone_from(&note));
            }
            None => {}
        }
    }
    Ok(answers)
}

/// How far areas may be off because cells touch as a whole \[m², on a line m\].
struct Edge {
    /// Of the counted area: along its rim towards cells that do not touch.
    open: f64,
    /// The same with the border of a free domain that the contact reaches: no area lies beyond it, but a sharp edge.
    rim: f64,
}

impl Edge {
    /// The rim of a spot lies within half a cell of where it is counted, and the whole rim of a small or regular spot may lie off in the same
    /// direction: then the area of the spot is off by half a cell times the length of the rim. That is π/4 of the length of the cells' sides,
    /// which is 4/π of that of the rim in the mean over its directions; on a line both ends count. The spots are independent of each
    /// other, so the squares add. Where the result stores no map of the contact, it is that of one round spot, which is that of any number
    /// of round ones.
    fn of(reader: &Reader, row: &Row) -> Result<Edge> {
        let header = reader.header();
        let (grid, cell) = (&header.grid, header.grid.cell_area());
        if reader.contact_kind().is_none() || reader.field_times().is_empty() {
            let cells = row.contact_area / cell;
            let edge = if grid.is_line() { cells.min(1.0) } else { (PI * cells).sqrt() };
            return Ok(Edge { open: edge * cell, rim: edge * cell });
        }
        let states = reader.contact_states(At::Time(row.coordinate.value()))?;
        let boundary = if header.is_periodic() { Boundary::Periodic } else { Boundary::Free };
        let spots = labels(boundary, states.view(), |state| *state > 0);
        let (sides, at_border) = sides_of_spots(spots.view(), boundary);
        let along = if grid.is_line() { 1.0 } else { FRAC_PI_4 };
        let squares = |sides: &mut dyn Iterator<Item = u32>| -> f64 {
            let squares: f64 = sides.map(|n| (0.5 * along * f64::from(n)).powi(2)).sum();
            squares.sqrt() * cell
        };
        Ok(Edge {
            open: squares(&mut sides.iter().copied()),
            rim: squares(&mut sides.iter().zip(&at_border).map(|(own, border)| own + border)),
        })
    }
}

/// How far approach, load and pressure may be off, relative, because cells touch as a whole. With the radius a off by da the approach
/// under a given load, a²/(3 R) + F/(2 E* a), is off by (da/a)² of it (Hertz: it is least at the right radius). A contact of a few cells
/// may have its rim one cell off; `edge`, half a cell along the rim, is the share da/a of the area then.
fn of_rim(edge: f64, area: f64) -> f64 {
    if area > 0.0 { (edge / area).min(1.0).powi(2) } else { 0.0 }
}

/// How many sides of cells each spot has towards cells that do not touch, and how many at the border of a free domain.
fn sides_of_spots(spots: ArrayView2<'_, u32>, boundary: Boundary) -> (Vec<u32>, Vec<u32>) {
    let count = spots.iter().max().map_or(0, |most| *most as usize);
    let (mut sides, mut at_border) = (vec![0; count], vec![0; count]);
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
        if boundary == Boundary::Free && count > 1 {
            let ends = [0, count - 1].into_iter().flat_map(|n| lines.row(n).to_vec());
            ends.filter(|spot| *spot > 0).for_each(|spot| at_border[spot as usize - 1] += 1);
        }
    }
    (sides, at_border)
}

/// What a held value did to the other one.
enum Held {
    /// How much the approach has grown, or which share of the load has relaxed.
    Answer(Answer),
    /// What the load was before, where it is no share of it.
    Note(String),
}

/// How much the approach has grown since the load is held, or which share of the load has relaxed since the approach is held. Where
/// the load has grown or changed its sign, or began with next to nothing, a share of it says nothing.
fn while_held(rows: &[Row], held_approach: bool, unit: &str) -> Option<Held> {
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
    if !held_approach {
        let creep = Answer::new("creep", last.approach - first.approach, "m");
        return Some(Held::Answer(creep))
            .filter(|_| (last.approach - first.approach).abs() > NOISE * last.approach.abs());
    }
    let largest = rows.iter().fold(0.0_f64, |most, row| most.max(row.load.abs()));
    let change = last.load - first.load;
    if change.abs() <= NOISE * first.load.abs().max(NOISE * largest) {
        return None;
    }
    let relaxes = first.load > SMALL * largest && (0.0..=first.load).contains(&last.load);
    Some(match relaxes {
        true => Held::Answer(Answer::new("relaxation", 1.0 - last.load / first.load, "1")),
        false => {
            let [load, time] = [quantity(first.load, unit), quantity(first.coordinate.value(), "s")];
            Held::Note(format!("{load} at {time}, since when the approach is held"))
        }
    })
}

#[cfg(test)]
mod tests {
    use asperity::Coordinate;
    use ndarray::array;

    use super::*;

    /// What is said of loads over the time of a held approach.
    fn held(loads: &[f64]) -> Option<Result<f64, String>> {
        let row = |(n, load): (usize, &f64)| Row {
            coordinate: Coordinate::Time(n as f64),
            approach: 1e-6,
            load: *load,
            ..Row::default()
        };
        let rows: Vec<Row> = loads.iter().enumerate().map(row).collect();
        while_held(&rows, true, "N").map(|held| match held {
            Held::Answer(answer) => Ok(answer.value),
            Held::Note(note) => Err(note),
        })
    }

    #[test]
    fn a_relaxation_is_a_share_of_a_load_that_decays() {
        assert_eq!(held(&[4.0, 3.0]).unwrap().unwrap(), 0.25);
        assert_eq!(held(&[4.0, 0.0]).unwrap().unwrap(), 1.0);
        assert!(held(&[4.0, 4.0]).is_none());
        // Loads that grow, change their sign, pull, or begin with nothing are no base of a share.
        for loads in [[3.0, 4.0], [1e-3, -0.3], [-1.0, -0.5], [0.0, 2.0], [1e-9, 3e-7]] {
            assert!(
                held(&loads).unwrap().unwrap_err().contains("since when the approach is held"),
                "{loads:?}"
            );
        }
    }

    #[test]
    fn sides_are_counted_spot_by_spot() {
        // A spot of three cells and one of one cell.
        let spots = array![[0, 0, 0, 0], [1, 1, 0, 0], [1, 0, 0, 2], [0, 0, 0, 0]];
        assert_eq!(sides_of_spots(spots.view(), Boundary::Free), (vec![6, 3], vec![2, 1]));
        // The border of a free domain is no side, and a periodic domain has none.
        let whole = array![[0, 0, 0, 0], [1, 1, 0, 0], [1, 0, 0, 1], [0, 0, 0, 0]];
        let none = (vec![10], vec![0]);
        assert_eq!(sides_of_spots(whole.view(), Boundary::Periodic), none);
        assert_eq!(sides_of_spots(array![[0], [1], [1], [0]].view(), Boundary::Periodic), (vec![2], vec![0]));
        // A body that is in contact all over has its whole border as its rim.
        assert_eq!(sides_of_spots(array![[1, 1], [1, 1]].view(), Boundary::Free), (vec![0], vec![8]));
    }
}
