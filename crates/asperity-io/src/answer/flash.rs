//! How warm friction makes the surfaces.

use asperity::quantities::Quantity;
use asperity::step::Row;

use super::Answer;
use super::extreme::Course;
use crate::readable::quantity;
use crate::store::{Reader, Result};

/// The largest temperatures of all rows; none where friction does not warm the surfaces.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Result<Vec<Answer>> {
    if !reader.header().warms() {
        return Ok(vec![]);
    }
    let largest = |own: Quantity, note: &str| -> Result<Answer> {
        let values = reader.series(own.name())?;
        let warmest = (0..values.len()).reduce(|a, b| if values[b] > values[a] { b } else { a }).unwrap_or(0);
        let places: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
        let open = Course::along(&places, vec![values.clone()]).open_at(&values, warmest);
        let answer = Answer::new(own.name(), values[warmest], "K").of_rows(open);
        let at = quantity(rows[warmest].coordinate.value(), reader.header().axis().unit());
        Ok(answer.at(&rows[warmest]).with_note(format!("{note}, the largest of all rows, at {at}")))
    };
    let mut answers = vec![
        largest(Quantity::FlashTemperatureMax, "above the surroundings")?,
        largest(Quantity::FlashTemperatureMean, "over the contact")?,
    ];
    if reader.header().quantities.iter().any(|column| column.quantity == Quantity::MaterialTemperature) {
        answers.push(largest(Quantity::MaterialTemperature, "at which the feedback takes the material")?);
    }
    Ok(answers)
}
