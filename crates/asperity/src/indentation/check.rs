//! Checks of the record and of the options.

use super::{IndentationOptions, IndentationRecord, noise};
use crate::error::{Error, Result, increasing, require};
use crate::material::LongTime;

/// Smallest number of rows.
const FEWEST: usize = 10;
const MOST: usize = 10_000_000;
/// Larger numbers, and loads or depths below its inverse, are not plausible measurements.
pub(super) const LARGEST: f64 = 1e30;
/// A single record does not determine more terms.
pub(super) const MOST_TERMS: usize = 6;
/// Loads below minus this fraction of the largest are not noise.
const PULL: f64 = 0.05;
/// Standard deviations of the noise beyond which a load is not noise.
const SEEN: f64 = 6.0;

pub(super) fn options(options: &IndentationOptions) -> Result<()> {
    if options.terms.is_some_and(|terms| terms > MOST_TERMS) {
        let terms = options.terms.unwrap_or_default();
        return Err(Error::invalid("number of terms", terms, format!("at most {MOST_TERMS}")));
    }
    require(
        (20..=10_000).contains(&options.springs),
        "number of springs",
        options.springs,
        "between 20 and 10000",
    )?;

    require(
        options.limit > 0.0 && options.limit.is_finite(),
        "largest misfit",
        options.limit,
        "finite and greater than 0",
    )?;

    require(
        options.terms != Some(0) || options.long_time != LongTime::Fluid,
        "number of terms",
        0,
        "at least 1 for a fluid",
    )?;
    super::stated::check(options)
}

/// Checks the columns as they are.
pub(super) fn columns(record: &IndentationRecord) -> Result<()> {
    let n = record.times.len();
    for (name, column) in [("loads", record.loads), ("depths", record.depths)] {
        require(
            column.len() == n,
            format!("number of {name}"),
            column.len(),
            format!("{n}, that of the times"),
        )?;
    }
    require(
        (FEWEST..=MOST).contains(&n),
        "number of rows of the record",
        n,
        format!("between {FEWEST} and {MOST}"),
    )?;
    let columns = [("time", "s", record.times), ("load", "N", record.loads), ("depth", "m", record.depths)];
    for (name, unit, column) in columns {
        if let Some((row, value)) =
            column.iter().enumerate().find(|(_, value)| value.is_nan() || value.abs() > LARGEST)
        {
            return Err(Error::invalid(
                format!("{name} of row {}", row + 1),
                value,
                format!("a number, at most {LARGEST:e} {unit}"),
            ));
        }
    }
    increasing(
        record.times.iter().copied(),
        |row| format!("time of row {}", row + 1),
        |time| format!("{time} s"),
    )
}

/// Checks that the body is pressed; loads are those without a baseline, depths from first touch. The first `free` rows are those of a free indenter.
pub(super) fn signs(record: &IndentationRecord, free: usize) -> Result<()> {
    let largest = |column: &[f64]| column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (name, unit, column) in [("load", "N", record.loads), ("depth", "m", record.depths)] {
        require(
            largest(column) >= 1.0 / LARGEST,
            format!("largest {name}"),
            format!("{} {unit}", largest(column)),
            "greater than 0: pressing is positive (turn the sign of the column)",
        )?;
    }
    let most = largest(record.loads);
    let noise = noise::deviation(record.times, record.loads);
    let least = (PULL * most).max(SEEN * noise);
    if let Some((row, load)) = record.loads.iter().enumerate().skip(free).find(|(_, load)| **load < -least) {
        return Err(Error::invalid(
            format!("load of row {}", row + 1),
            format!("{load} N"),
            format!(
                "above -{:.0} % of the largest ({most:e} N): adhesion is not part of the model",
                100.0 * least / most
            ),
        ));
    }
    let pressed = record.loads.iter().filter(|load| **load > 0.02 * most).count();
    require(
        pressed >= FEWEST,
        "number of rows in contact",
        pressed,
        format!("at least {FEWEST} with more than 2 % of the largest load"),
    )?;
    Ok(())
}
