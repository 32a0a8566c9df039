//! The leak of a seal, and from when on it is tight.

use asperity::Axis;
use asperity::quantities::Quantity;

use super::{Answer, Units};
use crate::leakage::LeakHistory;
use crate::store::{Reader, Result};

/// The spread of the last leak over the passes of the solver, relative, where cells without a steady access to the fluid are held.
fn spread(reader: &Reader, leaks: &LeakHistory) -> Result<f64> {
    let name = Quantity::LeakSpread.name();
    if reader.scalars().iter().all(|series| series.name != name) {
        return Ok(0.0);
    }
    let step = leaks.last("leak_step");
    Ok(reader.series(name)?.get(step as usize).copied().filter(|spread| spread.is_finite()).unwrap_or(0.0))
}

/// The leaks at the last of their times; none where the result holds none.
pub(super) fn of(reader: &Reader, units: &Units) -> Result<Vec<Answer>> {
    let Some(leaks) = LeakHistory::of(reader)? else { return Ok(vec![]) };
    let times = leaks.column("leak_time");
    let is_sweep = leaks.table.axis == Axis::Velocity;
    let percolates = leaks.column("percolates");
    let note = match is_sweep {
        true => format!(
            "at {}; {}",
            units.moment(leaks.table.axis.at(leaks.last("leak_time"))),
            leaks.note(units)
        ),
        false => leaks.note(units),
    };
    let mut answers: Vec<Answer> = leaks
        .table
        .series()
        .into_iter()
        .filter(|series| ["leak_rate", "leak_rate_standard", "hydraulic_gap"].contains(&series.name))
        .map(|series| Answer::new(series.name, leaks.last(series.name), series.units))
        .collect();
    let spread = spread(reader, &leaks)?;
    for answer in &mut answers {
        // A leak goes with the cube of its hydraulic gap.
        let share = if answer.name == "hydraulic_gap" { spread / 3.0 } else { spread };
        answer.of_cells = share * answer.value.abs();
    }
    // The rate that is counted at 0 °C is the usual one of a gas.
    answers.sort_by_key(|answer| answer.name != "leak_rate_standard");
    // Of the two rates of a gas one is shown.
    let noted = answers.iter().filter(|answer| answer.name != "hydraulic_gap").count().max(1);
    answers.iter_mut().take(noted).for_each(|answer| answer.note.clone_from(&note));
    let open = percolates.iter().rposition(|open| *open != 0.0);
    let first = open.map_or(0, |open| open + 1);
    if let Some(tight) = times.get(first).filter(|_| !is_sweep) {
        let between = leaks.tight(units);
        // Between the last time at which it leaks and the next one nothing is known.
        let distance = open.map_or(0.0, |open| tight - times[open]);
        let answer = Answer::new("tight_from", *tight, "s").with_note(between);
        answers.push(answer.of_rows(distance));
    }
    Ok(answers)
}

/// The row of the last leak.
pub(super) fn last_row(reader: &Reader) -> Result<Option<usize>> {
    Ok(LeakHistory::of(reader)?.and_then(|leaks| Some(*leaks.column("leak_step").last()? as usize)))
}
