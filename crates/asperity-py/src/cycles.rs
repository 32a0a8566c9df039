//! What the cycles of a load tell.

use asperity::cycles;
use pyo3::prelude::*;

use crate::error::Answer;

/// (start, end, work, stiffness, loss angle, work of the drift) of each full period.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn cycles_of(
    time: Vec<f64>,
    load: Vec<f64>,
    approach: Vec<f64>,
    frequency: f64,
    start: f64,
) -> Answer<Vec<(f64, f64, f64, f64, f64, f64)>> {
    let found = cycles::cycles(&time, &load, &approach, frequency, start);
    let numbers = |c: cycles::Cycle| {
        (c.span[0], c.span[1], c.dissipated_energy, c.stiffness, c.loss_angle, c.drift_work)
    };
    Ok(found?.into_iter().map(numbers).collect())
}
