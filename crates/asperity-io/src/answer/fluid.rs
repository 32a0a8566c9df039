//! A fluid that acts on the surfaces: what it carries, when it opens the contact, and at which pressure that closes again.

use asperity::Axis;
use asperity::load::Control;
use asperity::quantities::Quantity;
use asperity::step::Row;

use super::{Answer, Units};
use crate::leakage::LeakHistory;
use crate::store::{Reader, Result};

/// What a reader must know of the pressure that lifts the surfaces off.
const NOTE: &str = "from this inlet pressure on no film holds the load";

/// The answers of the row `n`, and of all rows; none without a fluid that acts.
pub(super) fn of(reader: &Reader, rows: &[Row], n: usize, units: &Units) -> Result<Vec<Answer>> {
    let mut answers = vec![];
    if let Some(leaks) = LeakHistory::of(reader)? {
        answers.extend(lift_off(reader, &leaks, &rows[n]));
        if let Some(pressure) = leaks.column("opening_pressure").last() {
            let note = match leaks.last("percolates") == 1.0 {
                true => "inlet and outlet are connected already",
                false => "up to this inlet pressure the contact holds, if it rises suddenly",
            };
            answers.push(Answer::new("opening_pressure", *pressure, "Pa").with_note(note));
        }
        if let Some((rate, unit)) = one_way(&leaks) {
            let note = "if the fluid did not act on the surfaces";
            answers.push(Answer::new("leak_rate_one_way", rate, unit).with_note(note));
        }
    }
    let acts = reader.scalars().iter().any(|series| series.name == Quantity::Connected.name());
    if !acts || reader.header().axis() != Axis::Time {
        return Ok(answers);
    }
    let series = |quantity: Quantity| reader.series(quantity.name());
    let (load, connected) = (series(Quantity::FluidLoad)?, series(Quantity::Connected)?);
    let inlet = series(Quantity::InletPressure)?;
    answers.push(Answer::new("fluid_load", load[n], reader.header().grid.units("N")).at(&rows[n]));
    let turns = |to: f64| {
        let connected = &connected;
        (1..rows.len()).filter(move |k| connected[*k] == to && connected[*k - 1] != to)
    };
    if let Some(k) = turns(1.0).next() {
        let [before, time] = [k - 1, k].map(|k| rows[k].coordinate.value());
        let note = format!("the inlet has {} then", units.number(inlet[k], "Pa"));
        let answer = Answer::new("time_opened", time, "s").with_note(note);
        answers.push(answer.of_rows(time - before));
    }
    // Where the pressure falls.
    if let Some(k) = turns(0.0).rfind(|k| inlet[*k] < inlet[*k - 1]) {
        let note = format!("of the inlet, at t = {}", units.time(rows[k].coordinate.value()));
        let answer = Answer::new("closing_pressure", inlet[k], "Pa").with_note(note);
        answers.push(answer.of_rows(inlet[k - 1] - inlet[k]));
    }
    Ok(answers)
}

/// The pressure of the inlet from which on no film holds the load of a row: known on a periodic domain whose load is prescribed.
fn lift_off(reader: &Reader, leaks: &LeakHistory, row: &Row) -> Option<Answer> {
    let header = reader.header();
    let is_loaded = header.controls().get(row.stage).is_some_and(|control| *control != Control::Approach);
    let fluid = leaks.leak.traction().ok()??;
    let pressure = fluid.lift_off(row.load / header.grid.area());
    let answer = || Answer::new("lift_off_pressure", pressure, "Pa").with_note(NOTE).at(row);
    (is_loaded && header.is_periodic()).then(answer)
}

/// The last leak of a fluid that does not act, with its unit: of a gas the rate at 0 °C, as that of the leak.
fn one_way(leaks: &LeakHistory) -> Option<(f64, &'static str)> {
    let rate = *leaks.column("leak_rate_one_way").last()?;
    let Some(standard) = leaks.table.get("leak_rate_standard") else { return Some((rate, "m3/s")) };
    // The gas alone decides it.
    let mut ratios = standard.iter().zip(leaks.column("leak_rate")).map(|(standard, rate)| standard / rate);
    Some((rate * ratios.find(|ratio| ratio.is_finite()).unwrap_or(f64::NAN), "Pa m3/s"))
}
