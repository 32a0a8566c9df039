//! How warm friction makes the surfaces.

use asperity::quantities::Quantity;
use asperity::step::Row;

use super::Answer;
use crate::store::{Reader, Result};

/// The largest temperatures of all rows; none where friction does not warm the surfaces.
pub(super) fn of(reader: &Reader, rows: &[Row]) -> Result<Vec<Answer>> {
    if !reader.header().warms() {
        return Ok(vec![]);
    }
    let largest = |quantity: Quantity, note: &str| -> Result<Answer> {
        let values = reader.series(quantity.name())?;
        let warmest = (0..values.len()).reduce(|a, b| if values[b] > values[a] { b } else { a }).unwrap_or(0);
        let answer = Answer::new(quantity.name(), values[warmest], "K");
        Ok(answer.at(&rows[warmest]).with_note(note))
    };
    Ok(vec![
        largest(Quantity::FlashTemperatureMax, "above the surroundings, the largest of all rows")?,
        largest(Quantity::FlashTemperatureMean, "over the contact, the largest of all rows")?,
    ])
}
