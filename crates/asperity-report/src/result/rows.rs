//! What the rows of a result follow: time, or the velocities of a sweep.

use asperity_io::answer::Units;
use asperity_io::readable::Shown;
use asperity_io::store::{Reader, StoreError};

use super::{Options, PlotError};
use crate::figure::Axis;

/// The axis of the rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rows {
    pub(crate) of: asperity::Axis,
    /// Whether a logarithmic axis shows them better.
    pub(crate) log: bool,
    /// Ends of the axis; `None` for those of the data.
    range: Option<[f64; 2]>,
    /// The unit chosen for times.
    unit: Option<Shown>,
}

impl Rows {
    pub(crate) fn of(reader: &Reader) -> Result<Rows, StoreError> {
        Ok(Rows::over(reader, &reader.series("time")?, &Units::default()))
    }

    /// Those of a window.
    ///
    /// # Errors
    /// [`PlotError::Refused`] where no row lies in it.
    pub(crate) fn within(reader: &Reader, options: &Options) -> Result<Rows, PlotError> {
        let values = reader.series("time")?;
        if options.window == [None, None] {
            return Ok(Rows::over(reader, &values, &options.units));
        }
        let inside: Vec<f64> = values.iter().copied().filter(|value| options.shows(*value)).collect();
        let (Some(first), Some(last)) = (inside.first(), inside.last()) else {
            let ends = [values.first(), values.last()];
            let [start, end] = ends.map(|end| super::moment(reader, *end.unwrap_or(&0.0)));
            let words = format!("no row lies in this window; the rows go from {start} to {end}");
            return Err(PlotError::Refused(words));
        };
        let rows = Rows::over(reader, &inside, &options.units);
        // A logarithmic axis begins at the first row after 0.
        let positive = inside.iter().copied().find(|value| *value > 0.0).unwrap_or(*first);
        let start = if options.log.unwrap_or(rows.log) { positive } else { *first };
        let from = options.window[0].filter(|from| *from > 0.0).unwrap_or(start);
        Ok(Rows { range: Some([from, options.window[1].unwrap_or(*last)]), ..rows })
    }

    fn over(reader: &Reader, values: &[f64], units: &Units) -> Rows {
        let of = reader.header().axis();
        let unit = Units::of(reader, units).shown("time").filter(|_| of == asperity::Axis::Time);
        Rows { of, log: is_logarithmic(values, of), range: None, unit }
    }

    /// The axis of a panel; `log` where that was asked for.
    pub(crate) fn axis(&self, log: Option<bool>) -> Axis {
        let axis = match log.unwrap_or(self.log) {
            true => Axis::log(self.of.name(), self.of.unit()),
            false => Axis::linear(self.of.name(), self.of.unit()),
        };
        Axis { range: self.range, chosen: self.unit.clone(), ..axis }
    }
}

/// Whether a logarithmic axis shows these coordinates of rows better than a linear one.
pub fn is_logarithmic(values: &[f64], of: asperity::Axis) -> bool {
    match of {
        asperity::Axis::Velocity => spans_a_decade(values),
        asperity::Axis::Time | asperity::Axis::None => crowds_the_start(values),
    }
}

fn spans_a_decade(values: &[f64]) -> bool {
    matches!((values.first(), values.last()), (Some(first), Some(last)) if *first > 0.0 && *last >= 10.0 * first)
}

/// Whether half of the times lie in the first tenth of the run: a linear axis would draw them on top of one another.
fn crowds_the_start(times: &[f64]) -> bool {
    let positive: Vec<f64> = times.iter().copied().filter(|time| *time > 0.0).collect();
    match (positive.get(positive.len() / 2), positive.last()) {
        (Some(middle), Some(last)) => positive.len() > 4 && *middle < 0.1 * last,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_of_time_ask_for_a_logarithmic_axis_and_even_steps_do_not() {
        let decades: Vec<f64> = (0..40).map(|n| 10f64.powf(0.2 * f64::from(n) - 4.0)).collect();
        assert!(crowds_the_start(&decades));
        let even: Vec<f64> = (0..40).map(f64::from).collect();
        assert!(!crowds_the_start(&even));
        assert!(!crowds_the_start(&[0.0, 1e-6, 1.0]), "three rows are too few to tell");
        assert!(spans_a_decade(&[0.01, 0.1]) && !spans_a_decade(&[0.0, 0.1]) && !spans_a_decade(&[1.0, 2.0]));
    }
}
