//! The stored instants that stress and leakage are computed at, after a run.

use crate::readable::quantity;
use crate::store::{At, Reader, StoreError};

/// Numbers of the stored instants at these times \[s\], rising and each once; `None` for all of them.
///
/// # Errors
/// [`StoreError::Missing`] where no fields are stored at a time, or none at all.
pub(crate) fn stored(reader: &Reader, times: Option<&[f64]>) -> Result<Vec<usize>, StoreError> {
    let mut instants: Vec<usize> = match times {
        None => (0..reader.field_times().len()).collect(),
        Some(times) => times.iter().map(|time| at(reader, *time)).collect::<Result<_, _>>()?,
    };
    instants.sort_unstable();
    instants.dedup();
    if instants.is_empty() {
        return Err(reader.missing("fields".into(), "none is stored yet".into()));
    }
    Ok(instants)
}

/// The instant of that time \[s\], up to rounding.
fn at(reader: &Reader, time: f64) -> Result<usize, StoreError> {
    let index = reader.index(At::Time(time))?;
    let times = reader.field_times();
    if (times[index] - time).abs() <= 1e-9 * times.iter().fold(time.abs(), |most, t| most.max(t.abs())) {
        return Ok(index);
    }
    let available: Vec<String> = times.iter().take(12).map(|time| quantity(*time, "s")).collect();
    let more = if times.len() > available.len() { ", ..." } else { "" };
    Err(reader.missing(
        format!("fields at t = {}", quantity(time, "s")),
        format!("it holds those at {}{more}", available.join(", ")),
    ))
}
