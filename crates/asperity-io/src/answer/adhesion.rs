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
    let at = rows.iter().rposition(|row| row.load < 0.0 && row.load <= least * (1.0 - SAME));
    let Some((at, row)) =
        at.map(|at| (at, &rows[at])).filter(|_| header.adhesion().is_some() && header.axis() == Axis::Time)
    else {
        return vec![];
    };
    let comes_off = rows[at..].iter().any(|row| row.contact_fraction == 0.0);
    let note =
        if comes_off { "" } else { "the largest tension of a run in which the surfaces do not come off" };
    vec![
        Answer::new("pull_off_force", row.load, header.grid.units("N")).with_note(note).at(row),
        Answer::new("pull_off_approach", row.approach, "m").at(row),
    ]
}
