//! Leakage of a gap.

use std::sync::atomic::AtomicBool;

use asperity::finding::{LeakDiagnostics, LeakState};
use asperity::{Boundary, Error, Grid};
use asperity_io::case::{LeakageKeys, leak as checked};
use asperity_io::leakage::Leak;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, raised};
use crate::wait::without_python;

/// The leak of one state. `keys` are those of `[leakage]` as JSON.
#[pyfunction]
pub fn leakage<'py>(
    py: Python<'py>,
    gap: PyReadonlyArray2<'_, f64>,
    contact: Option<PyReadonlyArray2<'_, u8>>,
    size: [f64; 2],
    keys: &str,
    temperatures: Vec<(f64, f64)>,
    time: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let wrong = |error: &dyn std::fmt::Display| CaseError::new_err(format!("leakage: {error}"));
    let keys: LeakageKeys = serde_json::from_str(keys).map_err(|error| wrong(&error))?;
    let leak = checked(&keys, Boundary::Periodic).map_err(|error| wrong(&error))?;
    let leak = Leak { temperatures, ..leak };
    let (gap, contact) = (gap.as_array(), contact.as_ref().map(|contact| contact.as_array()));
    let (nx, ny) = gap.dim();
    let solved = without_python(py, &AtomicBool::new(false), || -> Result<_, Error> {
        let grid = Grid::new([nx, ny], size)?;
        leak.of_gap(&grid, gap, contact, time)
    })?;
    let state = solved.map_err(|error| raised(py, error))?;
    let mut diagnostics = LeakDiagnostics::default();
    let resolved = diagnostics.see(&state.alone());
    let out = PyDict::new(py);
    out.set_item("leak_resolved", resolved)?;
    out.set_item("findings", asperity_io::finding::list(&diagnostics.findings()).to_string())?;
    out.set_item("percolates", state.percolates)?;
    out.set_item("hydraulic_gap", state.hydraulic_gap)?;
    out.set_item("critical_gap", state.critical_gap)?;
    out.set_item("critical_x", state.critical[0])?;
    out.set_item("critical_y", state.critical[1])?;
    out.set_item("critical_width", state.critical_width)?;
    out.set_item("medium_gap", state.medium_gap)?;
    out.set_item("open_fraction", state.open_fraction)?;
    out.set_item("trapped_area", state.trapped_area)?;
    out.set_item("trapped_volume", state.trapped_volume)?;
    out.set_item("conductance", state.conductance)?;
    out.set_item("leak_rate", state.leak_rate)?;
    out.set_item("leak_rate_standard", state.leak_rate_standard)?;
    out.set_item("leak_estimate_junction", state.leak_estimate_junction)?;
    out.set_item("leak_estimate_medium", state.leak_estimate_medium)?;
    out.set_item("knudsen_number", state.knudsen)?;
    out.set_item("pressure", state.pressure.into_pyarray(py))?;
    out.set_item("cells", state.cells.mapv(|kind| kind as u8).into_pyarray(py))?;
    Ok(out)
}

/// A state for the diagnostics: row (none for a gap of no run), critical gap (none where tight), cells across it, error of the gap, pressure drop, contact pressure.
type State = (Option<usize>, Option<f64>, Option<usize>, f64, Option<f64>, f64);

/// Which leaks the numbers carry, and what was found against the others (a JSON list).
#[pyfunction]
pub fn judge_leaks(states: Vec<State>) -> (Vec<bool>, String) {
    let mut diagnostics = LeakDiagnostics::default();
    let resolved = states.into_iter().map(|(row, gap, width, gap_error, pressure_drop, contact_pressure)| {
        let constriction = gap.map(|gap| (gap, width));
        diagnostics.see(&LeakState { row, constriction, gap_error, pressure_drop, contact_pressure })
    });
    let resolved = resolved.collect();
    (resolved, asperity_io::finding::list(&diagnostics.findings()).to_string())
}
