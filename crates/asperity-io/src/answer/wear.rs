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
    let times: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
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
    let note = format!("{} % of the volume may be in another place", quantity(100.0 * error, ""));
    let depth_max = Answer::new("wear_depth_max", depth[last], "m").with_note(note);
    answers.push(Answer { of_rows: error.max(0.0) * depth[last], ..depth_max });
    if let Some(limit) = number(reader, Header::WEAR, "depth_limit") {
        // Slip is fastest in the middle of a way, so the rate is that of the last computed cycle.
        let period = number(reader, Header::FRICTION, "period");
        let from = period.and_then(|period| {
            let begin = times[last] - period;
            times.iter().rposition(|time| *time <= begin * (1.0 + 1e-9))
        });
        let of = quantity(limit, "m");
        let (time, note) = match reached(limit, &depth, &course, from) {
            Some(way) => {
                let share = way / course[last];
                let time = match (unit, period) {
                    ("1", Some(period)) => way * period,
                    ("s", _) => way,
                    // At the mean velocity of the run.
                    _ if share > 1.0 => share * times[last],
                    _ => reached(limit, &depth, &times, None).unwrap_or(f64::NAN),
                };
                let how = match share > 1.0 {
                    true => {
                        format!("; extrapolated to {} times the run at its last rate", quantity(share, ""))
                    }
                    false => String::new(),
                };
                (time, format!("to a depth of {of}, {}{how}", after(way)))
            }
            None => (f64::NAN, format!("to a depth of {of}: nothing wears at the end")),
        };
        answers.insert(0, Answer::new("wear_life", time, "s").with_note(note));
    }
    Ok(answers)
}

/// Where a depth that grows along `way` reaches a limit, between the rows as a power, as depths of running-in grow; beyond the last row at its mean rate since
/// the row `from`, or since the row before. `None` where it does not grow.
fn reached(limit: f64, depth: &[f64], way: &[f64], from: Option<usize>) -> Option<f64> {
    let last = depth.len().checked_sub(1)?;
    let [first, end] = match depth.iter().position(|depth| *depth >= limit) {
        Some(n) => [n.checked_sub(1)?, n],
        None => [from.unwrap_or(last.checked_sub(1)?), last],
    };
    let grows = depth[end] - depth[first];
    let is_inside = depth[end] >= limit;
    let after = if depth[first] > 0.0 && way[first] > 0.0 { end } else { end + 1 };
    if let (true, Some(next), Some(to)) = (is_inside, depth.get(after), way.get(after)) {
        // Before the first row that is worn as in the step after it.
        let power = (to / way[after - 1]).ln() / (next / depth[after - 1]).ln();
        if power.is_finite() && power > 0.0 {
            return Some(way[after - 1] * (limit / depth[after - 1]).powf(power));
        }
    }
    (grows > 0.0).then(|| way[first] + (limit - depth[first]) / grows * (way[end] - way[first]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_reached_between_rows_or_beyond_the_last() {
        let (depth, way) = ([0.0, 1.0, 2.0, 2.5], [0.0, 1.0, 3.0, 5.0]);
        let between = reached(1.5, &depth, &way, None).unwrap();
        // ln 1.5/ln 2 of the way from 1 to 3 on a logarithmic scale.
        assert!((between - libm::pow(3.0, 1.5f64.ln() / 2f64.ln())).abs() < 1e-12);
        // Before the first one likewise: ln 3/ln 2 powers of a half.
        assert!((reached(0.5, &depth, &way, None).unwrap() - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(reached(3.0, &depth, &way, None), Some(7.0));
        // At the mean rate since the second row.
        assert_eq!(reached(4.0, &depth, &way, Some(1)), Some(9.0));
        assert_eq!(reached(3.0, &[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0], None), None);
        assert_eq!(reached(3.0, &[0.0, 0.0], &[0.0, 1.0], None), None);
    }
}
