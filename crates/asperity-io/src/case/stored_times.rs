//! Times of stored fields, of which stress and leakage are computed after the run.

use super::keys::*;
use super::plan::{Output, Rows};

/// Stored times at which something is computed from the fields.
pub type StoredTimes = Form<Stored, Vec<Time<NonNegative>>>;

/// Stored times.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Stored {
    /// The times of the stored fields.
    Fields,
    /// All rows; needs output.every = 1.
    All,
}

impl Word for Stored {
    const FORMS: &'static str = "\"fields\", \"all\" or a list of times";
}

/// The times asked for \[s\], the inner `None` for all that are stored; the outer one is a fault.
pub fn stored_times(
    at: &Place<'_>,
    times: Option<&StoredTimes>,
    output: &Output,
    end: f64,
) -> Option<Option<Vec<f64>>> {
    let list = match times {
        None | Some(Form::Word(Stored::Fields)) => return Some(None),
        Some(Form::Word(Stored::All)) if output.rows == Rows::Every(1) => return Some(None),
        Some(Form::Word(Stored::All)) => {
            let message = "\"all\" asks for all rows, but not all of them have stored fields";
            return at.fault(message, "\"fields\" or a list of times", "set output.every = 1");
        }
        Some(Form::List(list)) => list,
        Some(Form::Table(never)) => match *never {},
    };
    let instants = at.increasing(list.iter().map(|time| time.get()))?;
    if instants.is_empty() {
        return at.wrong("\"fields\", \"all\" or a list of at least one time", "");
    }
    let stored = |time: f64| {
        let listed = matches!(output.rows, Rows::At(_)) && output.rows.holds(1, false, time);
        time == 0.0 || time == end || listed
    };
    match instants.iter().position(|time| !stored(*time)) {
        None => Some(Some(instants)),
        Some(n) => at.item(n).wrong(
            "a time at which fields are stored: 0, the end, or one of output.times",
            "add it to output.times; with output.every use times = \"fields\" or \"all\"",
        ),
    }
}
