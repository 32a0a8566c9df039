//! The cycles of a result whose load is a sine, or has stages that are: from the stored rows, of a run under way too.

use asperity::cycles::{Cycle, cycles};

use crate::store::{Reader, StoreError};

/// The cycles of one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Cyclic {
    /// Number of the stage, from 0.
    pub stage: usize,
    /// When it starts \[s\], and the frequency of its sine \[Hz\].
    pub start: f64,
    /// See above.
    pub frequency: f64,
    /// The full cycles stored so far.
    pub cycles: Vec<Cycle>,
}

/// The cycles of each stage with a sine, in order; none where the result has no such stage.
///
/// # Errors
/// Those of [`Reader::rows`].
pub fn of_result(reader: &Reader) -> Result<Vec<Cyclic>, StoreError> {
    let listed = reader.header().setup.get("sines").and_then(|sines| sines.as_array());
    let Some(listed) = listed else { return Ok(vec![]) };
    if listed.is_empty() {
        return Ok(vec![]);
    }
    let rows = reader.rows()?;
    let mut found = vec![];
    for sine in listed {
        let stage = sine.get("stage").and_then(|n| n.as_u64()).and_then(|n| usize::try_from(n).ok());
        let frequency = sine.get("frequency").and_then(|f| f.as_f64());
        let (Some(stage), Some(frequency)) = (stage, frequency) else { continue };
        // The stage starts where the one before ended; its own rows follow.
        let first = rows.partition_point(|row| row.stage < stage);
        let last = rows.partition_point(|row| row.stage <= stage);
        let start = if stage == 0 { 0.0 } else { first.checked_sub(1).map_or(0.0, |n| rows[n].time()) };
        // A jump at the start is a row of the stage; without one the stage begins with the last row before.
        let from = if first < last && rows[first].time() > start { first.saturating_sub(1) } else { first };
        let of = &rows[from..last];
        let column = |value: fn(&crate::store::Row) -> f64| of.iter().map(value).collect::<Vec<f64>>();
        let [time, load, approach] =
            [column(|row| row.time()), column(|row| row.load), column(|row| row.approach)];
        if let Ok(cycles) = cycles(&time, &load, &approach, frequency, start) {
            found.push(Cyclic { stage, start, frequency, cycles });
        }
    }
    Ok(found)
}
