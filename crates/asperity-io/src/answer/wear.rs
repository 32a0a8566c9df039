//! What has worn, and when a given depth is reached.

use asperity::quantities::Quantity;
use asperity::step::Row;
use serde_json::Value;

use super::Answer;
use crate::readable::quantity;
use crate::store::{Header, Reader, Result};

/// The answers of a run whose surfaces wear; none of another.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Result<Vec<Answer>> {
    let Some(wear) = reader.header().setup.get(Header::WEAR) else { return Ok(vec![]) };
    let grid = &reader.header().grid;
    let last = rows.len() - 1;
    let of_rows = |quantity: Quantity| reader.series(quantity.name());
    let [volume, track, depth, distance] = [
        Quantity::WearVolume,
        Quantity::CounterbodyWearVolume,
        Quantity::WearDepthMax,
        Quantity::WearDistance,
    ]
    .map(of_rows);
    let (volume, depth, distance) = (volume?, depth?, distance?);
    let track = track.ok().and_then(|track| track.last().copied());
    let error = of_rows(Quantity::WearError)?[last];
    let number = |key: &str| wear.get(key).and_then(Value::as_f64);
    let cycles = reader.header().wear_cycles();
    let way = match distance[last] {
        0.0 => format!("after {}", after(rows[last].coordinate.value(), cycles)),
        way => format!("after sliding {}", quantity(way, "m")),
    };
    let mut answers = vec![Answer::new("wear_volume", volume[last], grid.units("m3")).with_note(way)];
    let of_track = |track| Answer::new("counterbody_wear_volume", track, grid.units("m3")).with_note("of it");
    answers.extend(track.map(of_track));
    let note = format!("known to {} %", quantity(100.0 * error, ""));
    answers.push(Answer::new("wear_depth_max", depth[last], "m").with_note(note));
    if let Some(limit) = number("depth_limit") {
        let times: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
        let (time, note) = match reached(limit, &depth, &times) {
            Some((time, is_extrapolated)) => {
                let way = reached(limit, &depth, &distance).map_or(0.0, |(way, _)| way);
                let slid =
                    if way > 0.0 { format!(", after sliding {}", quantity(way, "m")) } else { String::new() };
                let how = if is_extrapolated { "; at the rate of the last row" } else { "" };
                let all = if cycles == 1.0 { "" } else { ", the time of all cycles" };
                (time, format!("to a depth of {}{slid}{all}{how}", quantity(limit, "m")))
            }
            None => (f64::NAN, "nothing wears at the end".to_owned()),
        };
        answers.insert(0, Answer::new("wear_life", time * cycles, "s").with_note(note));
    }
    Ok(answers)
}

/// "10 s", or with cycles that stand for many "10000 s (1000 computed ones times as many)".
fn after(time: f64, cycles: f64) -> String {
    match cycles {
        1.0 => quantity(time, "s"),
        cycles => format!(
            "{} ({} computed, times {})",
            quantity(time * cycles, "s"),
            quantity(time, "s"),
            quantity(cycles, "")
        ),
    }
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
