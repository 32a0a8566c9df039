//! The temperature of a run over time.

use asperity_io::store::{Reader, StoreError};
use serde::Deserialize;
use serde_json::Value;

use super::Rows;
use crate::figure::{Axis, Curves, Series, Style};

/// From K to °C.
const ZERO: f64 = 273.15;

/// The temperature of a run, or its lowest and its highest: "20.0 °C", "-15.0 °C to 20.0 °C"; `None` where the material has none.
pub fn temperatures(reader: &Reader) -> Option<String> {
    ends(&reader.header().setup)
}

fn ends(setup: &serde_json::Map<String, Value>) -> Option<String> {
    // Kelvin, or points of time and kelvin.
    let kelvin = |value: &Value| value.as_f64().or_else(|| value.get(1)?.as_f64());
    let known: Vec<f64> = setup.get("temperature")?.as_array()?.iter().filter_map(kelvin).collect();
    let [low, high] = [known.iter().copied().reduce(f64::min)?, known.iter().copied().reduce(f64::max)?];
    let celsius = |kelvin: f64| format!("{:.1} °C", kelvin - ZERO);
    Some(if low < high { format!("{} to {}", celsius(low), celsius(high)) } else { celsius(low) })
}

/// The course of the temperature as the result holds it: (time \[s\], temperature \[K\]), straight in between and held after the
/// last; `None` where there is none, or it is constant.
fn course(reader: &Reader) -> Option<Vec<[f64; 2]>> {
    let setup = &reader.header().setup;
    // Results of Python have the points in place of the lowest and the highest temperature.
    let stored = setup.get("temperature_course").or(setup.get("temperature"))?;
    let course = Vec::<[f64; 2]>::deserialize(stored).ok()?;
    let changes = course.iter().any(|point| point[1] != course[0][1]);
    (reader.header().axis() == asperity::Axis::Time && changes).then_some(course)
}

/// The temperature \[K\] at a time; after a jump where one is there.
fn at(course: &[[f64; 2]], time: f64) -> f64 {
    let next = course.partition_point(|point| point[0] <= time);
    match (next.checked_sub(1).map(|n| course[n]), course.get(next)) {
        (Some([from, before]), Some([to, after])) => before + (after - before) * (time - from) / (to - from),
        (Some([_, last]), None) => last,
        (None, first) => first.map_or(f64::NAN, |point| point[1]),
    }
}

/// The temperature \[°C\] at each row; `None` where it does not change.
pub(crate) fn at_rows(reader: &Reader) -> Result<Option<Vec<f64>>, StoreError> {
    let Some(course) = course(reader) else { return Ok(None) };
    Ok(Some(reader.series("time")?.iter().map(|time| at(&course, *time) - ZERO).collect()))
}

/// The panel of the temperature at the rows and at the corners of its course between them; `None` where it does not change.
pub(super) fn panel(reader: &Reader, rows: Rows, log: Option<bool>) -> Result<Option<Curves>, StoreError> {
    let Some(course) = course(reader) else { return Ok(None) };
    let points = through(&course, &reader.series("time")?);
    let points = points.into_iter().map(|[time, kelvin]| [time, kelvin - ZERO]);
    let panel = Curves::new("Temperature", rows.axis(log), Axis::linear("temperature [°C]", ""));
    Ok(Some(panel.with(Series::through("", Style::Line, points))))
}

/// The course at these times and at its own points up to the last of them.
fn through(course: &[[f64; 2]], times: &[f64]) -> Vec<[f64; 2]> {
    let last = times.last().copied().unwrap_or(0.0);
    let own = course.iter().copied().filter(|point| point[0] <= last);
    let is_new = |time: &f64| !course.iter().any(|point| point[0] == *time);
    let rows = times.iter().copied().filter(is_new).map(|time| [time, at(course, time)]);
    let mut points: Vec<[f64; 2]> = own.chain(rows).collect();
    // The two points of a jump keep their order.
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_and_the_highest_temperature_are_told_of_ends_and_of_points() {
        let told = |stored: Value| ends(serde_json::json!({ "temperature": stored }).as_object().unwrap());
        let both = Some("-15.0 °C to 20.0 °C".to_owned());
        assert_eq!(told(serde_json::json!([258.15, 293.15])), both);
        assert_eq!(told(serde_json::json!([[0.0, 293.15], [60.0, 258.15]])), both);
        assert_eq!(told(serde_json::json!([293.15, 293.15])), Some("20.0 °C".to_owned()));
        assert_eq!(told(Value::Null), None);
    }

    #[test]
    fn a_course_is_straight_between_its_points_jumps_and_is_held_at_the_end() {
        let course = [[0.0, 280.0], [10.0, 300.0], [10.0, 320.0], [20.0, 320.0]];
        assert_eq!([0.0, 5.0, 10.0, 30.0].map(|time| at(&course, time)), [280.0, 290.0, 320.0, 320.0]);
        let points = through(&course, &[0.0, 5.0, 15.0]);
        let expected = [[0.0, 280.0], [5.0, 290.0], [10.0, 300.0], [10.0, 320.0], [15.0, 320.0]];
        assert_eq!(points, expected);
    }
}
