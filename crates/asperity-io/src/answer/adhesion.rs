//! Where an adhesive contact pulls off.

use asperity::Axis;
use asperity::step::Row;

use super::{Answer, SAME};
use crate::store::Reader;

/// Pull-off force, the least load of the run (negative: tension), and the approach there; none without adhesion, or where nothing pulls.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Vec<Answer> {
    let header = reader.header();
    // Of loads that are equal but for rounding the last.
    let least = rows.iter().map(|row| row.load).fold(0.0, f64::min);
    let least = rows.iter().rfind(|row| row.load < 0.0 && row.load <= least * (1.0 - SAME));
    let Some(row) = least.filter(|_| header.adhesion().is_some() && header.axis() == Axis::Time) else {
        return vec![];
    };
    let is_open =
        rows.last().is_some_and(|last| last.coordinate == row.coordinate && last.contact_fraction > 0.0);
    let note = if is_open { "still in contact there, at the end of the run" } else { "" };
    vec![
        Answer::new("pull_off_force", row.load, header.grid.units("N")).with_note(note).at(row),
        Answer::new("pull_off_approach", row.approach, "m").at(row),
    ]
}
