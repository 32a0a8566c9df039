//! Where an adhesive contact pulls off.

use asperity::Axis;
use asperity::step::Row;

use super::Answer;
use crate::store::Reader;

/// Pull-off force, the least load of the run (negative: tension), and the approach there; none without adhesion, or where nothing pulls.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Vec<Answer> {
    let header = reader.header();
    let least = rows.iter().min_by(|a, b| a.load.total_cmp(&b.load)).filter(|row| row.load < 0.0);
    let Some(row) = least.filter(|_| header.adhesion().is_some() && header.axis() == Axis::Time) else {
        return vec![];
    };
    let is_last = rows.last().is_some_and(|last| last.coordinate == row.coordinate);
    let note = if is_last { "the run ends there" } else { "" };
    vec![
        Answer::new("pull_off_force", row.load, header.grid.units("N")).with_note(note).at(row),
        Answer::new("pull_off_approach", row.approach, "m").at(row),
    ]
}
