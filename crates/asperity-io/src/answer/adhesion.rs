//! Where an adhesive contact pulls off.

use asperity::step::Row;
use asperity::{Axis, Control};

use super::extreme::{Course, Extreme};
use super::{Answer, SAME};
use crate::store::Reader;

/// Pull-off force, the least load of the run (negative: tension), and the approach there; none without adhesion, or where nothing pulls.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Vec<Answer> {
    let header = reader.header();
    // Of loads that are equal but for rounding the last.
    let least = rows.iter().map(|row| row.load).fold(0.0, f64::min);
    let at = rows.iter().rposition(|row| row.load < 0.0 && row.load <= least * (1.0 - SAME));
    let Some(at) = at.filter(|_| header.adhesion().is_some() && header.axis() == Axis::Time) else {
        return vec![];
    };
    let row = &rows[at];
    let times: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
    let pulls: Vec<f64> = rows.iter().map(|row| -row.load).collect();
    let approaches: Vec<f64> = rows.iter().map(|row| row.approach).collect();
    let course = Course::of(reader, rows, &times);
    let mut top = course.largest(&pulls, at);
    let approach = course.between(&approaches, top.at);
    let mut approach_error =
        [-1.0, 1.0].map(|side| course.between(&approaches, top.at + side * top.at_error) - approach);
    // Under a load the surfaces come off somewhere after the last equilibrium that was found, less than a step away.
    let is_loaded = header.controls().get(row.stage).is_some_and(|control| *control != Control::Approach);
    let is_left = rows.get(at + 1).is_none_or(|next| next.stage != row.stage);
    if let (true, true, Some(before)) = (is_loaded, is_left, at.checked_sub(1).map(|before| &rows[before])) {
        top = Extreme { error: (row.load - before.load).abs(), ..top };
        approach_error = [row.approach - before.approach; 2];
    }
    let comes_off = rows[at..].iter().any(|row| row.contact_fraction == 0.0);
    let note =
        if comes_off { "" } else { "the largest tension of a run in which the surfaces do not come off" };
    let force = Answer::new("pull_off_force", -top.value, header.grid.units("N")).with_note(note);
    let error = approach_error.into_iter().fold(0.0, |most: f64, error| most.max(error.abs()));
    vec![
        force.of_rows(top.error).at(row),
        Answer::new("pull_off_approach", approach, "m").of_rows(error).at(row),
    ]
}
