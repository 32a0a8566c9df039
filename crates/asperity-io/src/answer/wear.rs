//! What has worn, and when a given depth is reached.

use asperity::quantities::Quantity;
use asperity::step::Row;
use serde_json::Value;

use super::Answer;
use crate::readable::quantity;
use crate::store::{Header, Reader, Result};

/// What wear goes on over, at each row: the sliding distance, the cycles of slip, or the time of all cycles; what it is called, and its unit.
///
/// # Errors
/// [`StoreError`](crate::store::StoreError) where the result is damaged.
pub fn course(reader: &Reader) -> Result<(Vec<f64>, &'static str, &'static str)> {
    let has = |own: Quantity| reader.header().quantities.iter().any(|column| column.quantity == own);
    if has(Quantity::WearDistance) {
        return Ok((reader.series(Quantity::WearDistance.name())?, "sliding distance", "m"));
    }
    let cycles = reader.series(Quantity::WearCycles.name())?;
    if cycles.iter().all(|count| count.is_finite()) {
        return Ok((cycles, "cycles", "1"));
    }
    let factor = number(reader, Header::WEAR, "cycles").unwrap_or(1.0);
    Ok((reader.series("time")?.iter().map(|time| factor * time).collect(), "time of all cycles", "s"))
}

/// A number of the setup.
fn number(reader: &Reader, of: &str, key: &str) -> Option<f64> {
    reader.header().setup.get(of)?.get(key).and_then(Value::as_f64)
}

/// The answers of a run whose surfaces wear; none of another.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Result<Vec<Answer>> {
    if !reader.header().wears() {
        return Ok(vec![]);
    }
    let grid = &reader.header().grid;
    let last = rows.len() - 1;
    let of_rows = |quantity: Quantity| reader.series(quantity.name());
    let (volume, depth) = (of_rows(Quantity::WearVolume)?, of_rows(Quantity::WearDepthMax)?);
    let track = of_rows(Quantity::CounterbodyWearVolume).ok().and_then(|track| track.last().copied());
    let error = of_rows(Quantity::WearError)?[last];
    let (course, _, unit) = course(reader)?;
    let after = |way: f64| match unit {
        "m" => format!("after sliding {}", quantity(way, "m")),
        "1" => format!("after {} cycles", quantity(way, "")),
        unit => format!("after {} of all cycles", quantity(way, unit)),
    };
    let mut answers =
        vec![Answer::new("wear_volume", volume[last], grid.units("m3")).with_note(after(course[last]))];
    let of_track = |track| Answer::new("counterbody_wear_volume", track, grid.units("m3")).with_note("of it");
    answers.extend(track.map(of_track));
    let note = format!("known to {} %", quantity(100.0 * error, ""));
    answers.push(Answer::new("wear_depth_max", depth[last], "m").with_note(note));
    if let Some(limit) = number(reader, Header::WEAR, "depth_limit") {
        // The time of a cycle that stands for many is that of all of them.
        let times: Vec<f64> = match (unit, number(reader, Header::FRICTION, "period")) {
            ("1", Some(period)) => course.iter().map(|cycles| cycles * period).collect(),
            ("s", _) => course.clone(),
            _ => rows.iter().map(|row| row.coordinate.value()).collect(),
        };
        let of = quantity(limit, "m");
        let (time, note) = match (reached(limit, &depth, &times), reached(limit, &depth, &course)) {
            (Some((time, is_extrapolated)), Some((way, _))) => {
                let how = if is_extrapolated { "; at the rate of the last row" } else { "" };
                (time, format!("to a depth of {of}, {}{how}", after(way)))
            }
            _ => (f64::NAN, format!("to a depth of {of}: nothing wears at the end")),
        };
        answers.insert(0, Answer::new("wear_life", time, "s").with_note(note));
    }
    Ok(answers)
}

/// Where a depth that grows along `way` reaches a limit, between the rows on a straight line; beyond the last row at its rate, and that it
/// is so. `None` where it does not grow.
fn reached(limit: f64, depth: &[f64], way: &[f64]) -> Option<(f64, bool)> {
    let beyond = depth.iter().position(|depth| *depth >= limit);
    let n = beyond.unwrap_or(depth.len() - 1);
    let grows = (1..=n).rev().find(|n| depth[*n] > depth[n - 1])?;
    if beyond.is_none() && grows != n {
        return None;
    }
    let share = (limit - depth[grows - 1]) / (depth[grows] - depth[grows - 1]);
    Some((way[grows - 1] + share * (way[grows] - way[grows - 1]), beyond.is_none()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_reached_between_rows_or_beyond_the_last() {
        let (depth, way) = ([0.0, 1.0, 2.0, 2.5], [0.0, 1.0, 3.0, 5.0]);
        assert_eq!(reached(1.5, &depth, &way), Some((2.0, false)));
        assert_eq!(reached(3.0, &depth, &way), Some((7.0, true)));
        assert_eq!(reached(3.0, &[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0]), None);
        assert_eq!(reached(3.0, &[0.0, 0.0], &[0.0, 1.0]), None);
    }
}
