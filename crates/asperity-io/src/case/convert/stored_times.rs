//! Times of stored fields, of which stress and leakage are computed after the run.

use super::{Checks, time};
use crate::case::plan::{Output, Rows};
use crate::case::raw::{At, StoredTimes};

/// The times asked for \[s\], the inner `None` for all that are stored; the outer one is a fault.
pub fn stored_times(
    checks: &mut Checks<'_, '_>,
    at: Option<&At<StoredTimes>>,
    output: &Output,
    end: f64,
) -> Option<Option<Vec<f64>>> {
    let Some(times) = at else { return Some(None) };
    match &times.value {
        StoredTimes::Fields => Some(None),
        StoredTimes::All if output.rows == Rows::Every(1) => Some(None),
        StoredTimes::All => {
            let message = "\"all\" asks for all rows, but not all of them have stored fields".to_owned();
            let help = "set output.every = 1";
            checks.fault(&times.span, message, "\"fields\" or a list of times", Some(help));
            None
        }
        StoredTimes::List(list) => {
            let instants = time::increasing(checks, list, |time| time.get())?;
            if instants.is_empty() {
                checks.wrong(&times.span, "\"fields\", \"all\" or a list of at least one time", None);
                return None;
            }
            let stored = |time: f64| {
                let listed = matches!(output.rows, Rows::At(_)) && output.rows.holds(1, false, time);
                time == 0.0 || time == end || listed
            };
            if let Some(missing) = list.iter().find(|at| !stored(at.value.get())) {
                let expected = "a time at which fields are stored: 0, the end, or one of output.times";
                let help = "add it to output.times; with output.every use times = \"fields\" or \"all\"";
                checks.wrong(&missing.span, expected, Some(help));
                return None;
            }
            Some(Some(instants))
        }
    }
}
