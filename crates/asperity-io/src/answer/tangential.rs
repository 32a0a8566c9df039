//! Friction under a load along the surfaces.

use std::ops::RangeInclusive;

use asperity::quantities::Quantity;
use asperity::step::Row;
use serde_json::Value;

use super::Answer;
use super::extreme::Course;
use crate::readable::quantity;
use crate::store::{Header, Reader, Result};

/// States that differ by less than this share of the ranges of displacement, force and load are the ends of a loop; a loop leads away
/// from them by more than this share.
const CLOSED: f64 = 1e-2;
const AWAY: f64 = 0.1;
/// Fewer rows than this are few for a loop.
const FEW: usize = 20;
/// With fewer rows than this a loop of bodies that relax says nothing of its area.
const LEAST: usize = 8;
/// Smaller steps than this share of the range are none.
const ROUNDING: f64 = 1e-9;

/// The answers of a run with a load along the surfaces; none of another.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Result<Vec<Answer>> {
    if !reader.header().slips() {
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
    // Of equal ones the last: the peaks of cycles differ by rounding.
    let largest = |values: &[f64]| {
        let most = values.iter().copied().fold(0.0, f64::max);
        values.iter().rposition(|value| *value >= most * (1.0 - super::SAME)).unwrap_or(0)
    };
    let (pulled, moved) = (largest(&forces), largest(&ways));
    let friction = reader.header().setup.get(Header::FRICTION);
    let period = friction.and_then(|friction| friction.get("period")?.as_f64());
    let load = reader.series("load")?;
    let cycle = match period {
        Some(period) => last_period(rows, period).filter(|cycle| comes_back(&load, cycle)),
        None => last_loop(&displacement, &force, &load),
    };
    let mut answers = vec![];
    let stiffness = reader.series(Quantity::TangentialStiffness.name())?;
    if let Some(cycle) = cycle {
        let (from, to) = (*cycle.start(), *cycle.end());
        let times = [from, to].map(|row| quantity(rows[row].coordinate.value(), "s"));
        let taken = work[to] - work[from];
        // The energy of elastic bodies is that of friction, which each step knows; between the rows the loop is known to straight lines.
        let (energy, of) = match is_elastic(reader) {
            true => (taken, String::new()),
            false => {
                let friction = quantity(taken, grid.units("J"));
                (area(&force, &displacement, cycle), format!("; {friction} of it by friction"))
            }
        };
        let few = if to - from < FEW { ", which are few" } else { "" };
        let note = format!("in the loop from {} to {}, {} rows{few}{of}", times[0], times[1], to - from);
        let lines = match to - from {
            _ if is_elastic(reader) => 0.0,
            rows if rows < LEAST => f64::INFINITY,
            rows => of_lines(rows) * energy.abs(),
        };
        let answer = Answer::new("loop_energy", energy, grid.units("J")).with_note(note);
        answers.push(Answer { of_rows: lines, ..answer });
    }
    let has_limit = is_elastic(reader) || !turns(&displacement);
    let stiffest = (0..stiffness.len())
        .filter(|row| stiffness[*row].is_finite())
        .max_by(|a, b| stiffness[*a].total_cmp(&stiffness[*b]));
    answers.extend(stiffest.map(|row| {
        // The stiffness of a step is that of its middle: the next one on the same way tells how much it changes in a step.
        let beside = [row.checked_sub(1), Some(row + 1)].into_iter().flatten();
        let changes = beside.filter_map(|n| Some((stiffness.get(n)? - stiffness[row]).abs()));
        let open = changes.filter(|change| change.is_finite()).reduce(f64::min).unwrap_or(0.0);
        let to = quantity(rows[row].coordinate.value(), "s");
        let (why, of_rows) = match has_limit {
            true => ("", open),
            false => (
                "; where the displacement turns while the bodies relax it grows as steps become shorter",
                f64::INFINITY,
            ),
        };
        let note = format!("the largest of a step, to {to}{why}");
        let answer = Answer::new(Quantity::TangentialStiffness.name(), stiffness[row], grid.units("N/m"));
        answer.of_rows(of_rows).with_note(note)
    }));
    let times: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
    let open = |values: &[f64], at: usize| {
        let along = |axis: usize| displacement.iter().map(|own| own[axis]).collect();
        Course::along(&times, vec![along(0), along(1), values.to_vec()]).open_at(values, at)
    };
    let (pull_open, way_open) = (open(&forces, pulled), open(&ways, moved));
    let share = slip[pulled] / (stick[pulled] + slip[pulled]);
    answers.extend([
        Answer::new("largest_tangential_force", forces[pulled], grid.units("N"))
            .of_rows(pull_open)
            .at(&rows[pulled]),
        Answer::new("largest_tangential_displacement", ways[moved], "m").of_rows(way_open).at(&rows[moved]),
        Answer::new("slip_share", share, "1").with_note("of the contact, under the largest tangential force"),
        Answer::new(Quantity::SlipWork.name(), work[rows.len() - 1], grid.units("J")).with_note(
            if reader.header().wears() { "since t = 0, of the computed cycles" } else { "since t = 0" },
        ),
    ]);
    Ok(answers)
}

/// What straight lines between so many rows leave open of the area of a loop, relative, twice that of an ellipse:
/// 2 (1 - sin(a)/a) with a = 2 pi/rows, about a²/3.
fn of_lines(rows: usize) -> f64 {
    let angle = std::f64::consts::TAU / rows.max(1) as f64;
    angle * angle / 3.0
}

/// Whether a course turns back: a step against the one before.
fn turns(course: &[[f64; 2]]) -> bool {
    let steps = course.windows(2).map(|pair| [0, 1].map(|axis| pair[1][axis] - pair[0][axis]));
    let moves: Vec<[f64; 2]> = steps.filter(|[x, y]| *x != 0.0 || *y != 0.0).collect();
    moves.windows(2).any(|pair| pair[0][0] * pair[1][0] + pair[0][1] * pair[1][1] < 0.0)
}

/// Whether the bodies have no retardation times.
fn is_elastic(reader: &Reader) -> bool {
    let setup = &reader.header().setup;
    let creeps =
        setup.get("retardation_times").and_then(Value::as_array).is_some_and(|times| !times.is_empty());
    let flows = setup.get("relaxed_modulus").and_then(Value::as_f64) == Some(0.0);
    !creeps && !flows
}

/// The rows of the last period; `None` where the run is shorter, or no row stands at its beginning.
fn last_period(rows: &[Row], period: f64) -> Option<RangeInclusive<usize>> {
    let time = |row: usize| rows[row].coordinate.value();
    let last = rows.len().checked_sub(1)?;
    let begins = |row: &usize| (time(last) - period - time(*row)).abs() <= 1e-9 * time(last);
    (0..last).rev().find(begins).map(|first| first..=last)
}

/// Whether the load at the end of a cycle is that at its beginning.
fn comes_back(load: &[f64], cycle: &RangeInclusive<usize>) -> bool {
    let heavy = load.iter().copied().fold(0.0, f64::max);
    (load[*cycle.end()] - load[*cycle.start()]).abs() <= CLOSED * heavy
}

/// A quantity along x and y.
fn vectors(reader: &Reader, quantity: Quantity) -> Result<Vec<[f64; 2]>> {
    let [[x, _], [y, _]] = quantity.components().unwrap_or_default();
    Ok(reader.series(x)?.into_iter().zip(reader.series(y)?).map(|(x, y)| [x, y]).collect())
}

/// The rows of the last loop: up to the last row at which the displacement changes, from the row before at which displacement, force and
/// load were the same and moved the same way; `None` where there is none.
fn last_loop(displacement: &[[f64; 2]], force: &[[f64; 2]], load: &[f64]) -> Option<RangeInclusive<usize>> {
    let range = |of: &dyn Fn(usize) -> f64| {
        let values = (0..load.len()).map(of);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let widest = |field: &[[f64; 2]]| (0..2).map(|axis| range(&|row| field[row][axis])).fold(0.0, f64::max);
    let (far, strong) = (widest(displacement), widest(force));
    let heavy = load.iter().copied().fold(0.0, f64::max);
    let step = |row: usize| [0, 1].map(|axis| displacement[row][axis] - displacement[row - 1][axis]);
    let end = (1..load.len()).rev().find(|row| step(*row).iter().any(|way| way.abs() > ROUNDING * far))?;
    let distance = |row: usize| {
        let of = |field: &[[f64; 2]], whole: f64| {
            (0..2).map(|axis| (field[row][axis] - field[end][axis]).abs() / whole).fold(0.0, f64::max)
        };
        of(displacement, far).max(of(force, strong)).max((load[row] - load[end]).abs() / heavy)
    };
    let goes_along = |row: usize| {
        let ([x, y], [own_x, own_y]) = (step(row), step(end));
        x * own_x + y * own_y > 0.0
    };
    let (mut is_away, mut found) = (false, None);
    for row in (1..end).rev() {
        let own = distance(row);
        if own > AWAY {
            if found.is_some() {
                break;
            }
            is_away = true;
        } else if is_away && own <= CLOSED && goes_along(row) && found.is_none_or(|(_, least)| own < least) {
            found = Some((row, own));
        }
    }
    found.map(|(row, _)| row..=end)
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
        let of = |course: &[[f64; 2]]| last_loop(course, course, &vec![1.0; course.len()]);
        // 2.25 cycles end at a turn, 2 cycles between two; what is held at the end is no part.
        assert_eq!(of(&course(2.25)), Some(50..=90));
        assert_eq!(of(&course(2.0)), Some(40..=80));
        let held = [course(2.25), vec![course(2.25)[90]; 7]].concat();
        assert_eq!(of(&held), Some(50..=90));
        // A circle turns along x and y at other times.
        let round: Vec<[f64; 2]> = (0..=90)
            .map(|n| {
                let at = std::f64::consts::TAU * f64::from(n) / 40.0;
                [at.cos(), at.sin()]
            })
            .collect();
        assert_eq!(of(&round), Some(50..=90));
        assert_eq!(of(&course(1.0)), None);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[[1.0, 0.0]]), None);
        // Where the force or the load has another value at its end, it is none.
        let (way, mut force) = (course(2.25), course(2.25));
        force[90][1] = 0.5;
        assert_eq!(last_loop(&way, &force, &[1.0; 91]), None);
        let falling: Vec<f64> = (0..=90).map(|n| 1.0 - 0.01 * f64::from(n)).collect();
        assert_eq!(last_loop(&way, &way, &falling), None);
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
