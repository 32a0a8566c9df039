//! Friction under a load along the surfaces.

use std::ops::RangeInclusive;

use asperity::quantities::Quantity;
use asperity::step::Row;

use super::Answer;
use crate::readable::quantity;
use crate::store::{Reader, Result};

/// Displacements that differ by less than this share of their range are the same end of a loop.
const CLOSED: f64 = 1e-2;
/// Smaller steps than this share of the range are none.
const ROUNDING: f64 = 1e-9;

/// The answers of a run with a load along the surfaces; none of another.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Result<Vec<Answer>> {
    let has = |quantity| reader.header().quantities.iter().any(|column| column.quantity == quantity);
    if !has(Quantity::TangentialForce) {
        return Ok(vec![]);
    }
    let grid = &reader.header().grid;
    let [force, displacement] =
        [vectors(reader, Quantity::TangentialForce)?, vectors(reader, Quantity::TangentialDisplacement)?];
    let [work, stick, slip] =
        [Quantity::SlipWork, Quantity::StickArea, Quantity::SlipArea].map(|own| reader.series(own.name()));
    let (work, stick, slip) = (work?, stick?, slip?);
    let sizes = |vectors: &[[f64; 2]]| vectors.iter().map(|[x, y]| x.hypot(*y)).collect::<Vec<_>>();
    let (forces, ways) = (sizes(&force), sizes(&displacement));
    // Of equal ones the first: later ones of a cycle differ by rounding.
    let largest = |values: &[f64]| {
        let most = values.iter().copied().fold(0.0, f64::max);
        values.iter().position(|value| *value >= most * (1.0 - super::SAME)).unwrap_or(0)
    };
    let (pulled, moved) = (largest(&forces), largest(&ways));
    let mut answers = vec![];
    if let Some(cycle) = last_loop(&displacement) {
        let (from, to) = (*cycle.start(), *cycle.end());
        let taken = work[to] - work[from];
        let times = [from, to].map(|row| quantity(rows[row].coordinate.value(), "s"));
        let note = format!(
            "the loop from {} to {}; the work of friction in it is {}",
            times[0],
            times[1],
            quantity(taken, grid.units("J"))
        );
        answers.push(
            Answer::new("loop_energy", area(&force, &displacement, cycle), grid.units("J")).with_note(note),
        );
    }
    let share = slip[pulled] / (stick[pulled] + slip[pulled]);
    answers.extend([
        Answer::new("largest_tangential_force", forces[pulled], grid.units("N")).at(&rows[pulled]),
        Answer::new("largest_tangential_displacement", ways[moved], "m").at(&rows[moved]),
        Answer::new("slip_share", share, "1")
            .at(&rows[pulled])
            .with_note("of the contact, under the largest tangential force"),
        Answer::new(Quantity::SlipWork.name(), work[rows.len() - 1], grid.units("J"))
            .at(&rows[rows.len() - 1]),
    ]);
    Ok(answers)
}

/// A quantity along x and y.
fn vectors(reader: &Reader, quantity: Quantity) -> Result<Vec<[f64; 2]>> {
    let [[x, _], [y, _]] = quantity.components().unwrap_or_default();
    Ok(reader.series(x)?.into_iter().zip(reader.series(y)?).map(|(x, y)| [x, y]).collect())
}

/// The rows of the last loop, from one turn of the displacement to the next on the same side; `None` where it does not come back.
pub(crate) fn last_loop(displacement: &[[f64; 2]]) -> Option<RangeInclusive<usize>> {
    let range = |axis: usize| {
        let values = displacement.iter().map(|d| d[axis]);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let axis = if range(1) > range(0) { 1 } else { 0 };
    let (along, range) = (|row: usize| displacement[row][axis], range(axis));
    let last = displacement.len().checked_sub(1)?;
    let (mut turns, mut direction) = (vec![], 0.0);
    for row in 1..=last {
        let step = along(row) - along(row - 1);
        if step.abs() > ROUNDING * range {
            if step * direction < 0.0 {
                turns.push(row - 1);
            }
            direction = step;
        }
    }
    turns.push(last);
    // The last row ends a loop only where it comes back to the turn before the last.
    let ends = turns.len().checked_sub(3).map(|n| (turns[n], turns[n + 2]));
    let inner = turns.len().checked_sub(4).map(|n| (turns[n], turns[n + 2]));
    let closes = |(from, to): &(usize, usize)| (along(*to) - along(*from)).abs() <= CLOSED * range;
    ends.filter(closes).or(inner.filter(closes)).map(|(from, to)| from..=to)
}

/// The integral of force over displacement, by trapezoids.
fn area(force: &[[f64; 2]], displacement: &[[f64; 2]], rows: RangeInclusive<usize>) -> f64 {
    let (force, displacement) = (&force[rows.clone()], &displacement[rows]);
    let step = |axis: usize, n: usize| {
        0.5 * (force[n][axis] + force[n + 1][axis]) * (displacement[n + 1][axis] - displacement[n][axis])
    };
    (0..force.len() - 1).map(|n| step(0, n) + step(1, n)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(end: f64) -> Vec<[f64; 2]> {
        let rows = (end * 40.0).round() as usize;
        (0..=rows).map(|n| [(std::f64::consts::TAU * n as f64 / 40.0).sin(), 0.1]).collect()
    }

    #[test]
    fn the_last_loop_goes_from_turn_to_turn() {
        // 2.25 cycles end at a turn, 2 cycles between two.
        assert_eq!(last_loop(&course(2.25)), Some(50..=90));
        assert_eq!(last_loop(&course(2.0)), Some(30..=70));
        assert_eq!(last_loop(&course(1.0)), None);
        assert_eq!(last_loop(&[]), None);
        assert_eq!(last_loop(&[[1.0, 0.0]]), None);
    }

    #[test]
    fn the_area_of_an_ellipse() {
        let rows = 4000;
        let at = |n: usize, shift: f64| (std::f64::consts::TAU * n as f64 / rows as f64 + shift).sin();
        let force: Vec<[f64; 2]> = (0..=rows).map(|n| [3.0 * at(n, 0.5), 0.0]).collect();
        let way: Vec<[f64; 2]> = (0..=rows).map(|n| [2.0 * at(n, 0.0), 0.0]).collect();
        // π A B sin φ
        let exact = std::f64::consts::PI * 6.0 * 0.5f64.sin();
        assert!((area(&force, &way, 0..=rows) / exact - 1.0).abs() < 1e-5);
    }
}
