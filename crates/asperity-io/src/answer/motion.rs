//! Friction of a contact in motion.

use asperity::Axis;
use asperity::sliding::Friction;
use asperity::step::Row;

use super::Answer;
use super::extreme::Course;
use crate::readable::quantity;
use crate::store::{Reader, Result};

/// A sweep over at most so many velocities has an answer for each.
const FEW: usize = 5;

/// The friction coefficient of each row, with the friction of the surfaces where they have any.
pub(super) fn coefficients(reader: &Reader) -> Result<Vec<f64>> {
    Ok(reader.frictions()?.iter().map(Friction::of_all).collect())
}

/// What the row itself leaves open of its friction, whose bulk part is `bulk`.
fn known_to(friction: &Friction, bulk: f64) -> f64 {
    let off = friction.uncertainty * bulk.abs();
    // Nothing of nothing.
    if off.is_nan() { 0.0 } else { off }
}

/// The answers of the row `n`; none where nothing moves.
pub(super) fn of(reader: &Reader, rows: &[Row], n: usize) -> Result<Vec<Answer>> {
    let frictions = reader.frictions()?;
    let Some(friction) = frictions.get(n) else { return Ok(vec![]) };
    let row = &rows[n];
    let coefficients = coefficients(reader)?;
    let sweep = reader.header().axis() == Axis::Velocity;
    let largest = if sweep && rows.len() > 1 { "the largest of the sweep; " } else { "" };
    let error = quantity(100.0 * friction.uncertainty, "");
    let note = format!("{largest}the force is known to {error} %");
    let unit = reader.header().grid.units("N");
    let force = |name: &str, newton: f64| {
        let answer = Answer::new(name, newton, unit).at(row);
        Answer { of_cells: known_to(friction, friction.force), ..answer }
    };
    let coefficient = |name: String, row: usize| {
        let answer = Answer::new(name, coefficients[row], "1");
        Answer { of_cells: known_to(&frictions[row], frictions[row].coefficient), ..answer }
    };
    let open = if sweep { between(rows, &coefficients, n) } else { 0.0 };
    let largest = coefficient("friction_coefficient".into(), n).of_rows(open);
    let mut answers = vec![largest.at(row).with_note(note)];
    if friction.total.is_nan() {
        answers.push(force("friction_force", friction.force));
    } else {
        answers.push(force("friction_force_total", friction.total * row.load));
        answers.push(force("friction_force", friction.force).with_note("of it, of the loss in the bulk"));
    }
    if sweep && rows.len() > 1 {
        let velocity = |n: usize| rows.get(n).map(|row| row.coordinate.value());
        let own = row.coordinate.value();
        let neighbours = [n.checked_sub(1).and_then(velocity), velocity(n + 1)];
        // Where the friction differs by less than it is known to, the largest may be too, or at the row beyond.
        let off = |row: usize| known_to(&frictions[row], frictions[row].coefficient);
        let may_be_largest = |row: usize| coefficients[row] + off(row) >= coefficients[n] - off(n);
        let first = (0..n).rev().take_while(|row| may_be_largest(*row)).last().unwrap_or(n);
        let last = (n..rows.len()).take_while(|row| may_be_largest(*row)).last().unwrap_or(n);
        let ends = [first.saturating_sub(1), (last + 1).min(rows.len() - 1)];
        let of_rows = ends.into_iter().filter_map(velocity).map(|v| (v - own).abs()).fold(0.0, f64::max);
        let note = match neighbours {
            [Some(_), Some(_)] => "",
            _ => "at the end of the sweep: the friction may be larger beyond it",
        };
        let answer = Answer::new("velocity_of_largest_friction", own, "m/s").with_note(note);
        answers.push(answer.of_rows(of_rows));
        let few = rows.iter().enumerate().filter(|_| rows.len() <= FEW);
        answers.extend(few.map(|(n, row)| {
            let name = format!("friction_coefficient_at_{}", quantity(row.coordinate.value(), "m/s"));
            coefficient(name.replace(' ', "_"), n)
        }));
    }
    Ok(answers)
}

/// How much larger the friction may be between the velocities of a sweep than at the row `n`, where it is the largest.
fn between(rows: &[Row], coefficients: &[f64], n: usize) -> f64 {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|a, b| rows[*a].coordinate.value().total_cmp(&rows[*b].coordinate.value()));
    let places: Vec<f64> = order.iter().map(|row| rows[*row].coordinate.value().ln()).collect();
    let values: Vec<f64> = order.iter().map(|row| coefficients[*row]).collect();
    let at = order.iter().position(|row| *row == n);
    at.map_or(0.0, |at| Course::along(&places, vec![]).open_at(&values, at))
}
