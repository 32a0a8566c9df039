//! Leakage of a gap.

use std::sync::atomic::AtomicBool;

use asperity::finding::{LeakDiagnostics, LeakState};
use asperity::{Boundary, Error, Grid};
use asperity_io::case::{LeakageKeys, leak as checked};
use asperity_io::leakage::{Leak, through_windows};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::{Dict, Plane, entries};
use crate::wait::without_python;

/// The leak of one state. `keys` are those of `[leakage]` as JSON.
#[pyfunction]
pub fn leakage<'py>(
    py: Python<'py>,
    gap: Plane<'_>,
    contact: Option<PyReadonlyArray2<'_, u8>>,
    size: [f64; 2],
    keys: &str,
    temperatures: Vec<(f64, f64)>,
    time: f64,
) -> Answer<Dict<'py>> {
    let wrong = |error: &dyn std::fmt::Display| Failure::case(format!("leakage: {error}"));
    let keys: LeakageKeys = serde_json::from_str(keys).map_err(|error| {
        // The last line is a code, with a place in a text that nobody wrote.
        let said = error.to_string();
        wrong(&said.rsplit_once('\n').map_or(said.as_str(), |(said, _)| said.trim_end()))
    })?;
    let leak = checked(&keys, Boundary::Periodic).map_err(|error| wrong(&error))?;
    let leak = Leak { temperatures, ..leak };
    let (gap, contact) = (gap.as_array(), contact.as_ref().map(|contact| contact.as_array()));
    let (nx, ny) = gap.dim();
    let solved = without_python(py, &AtomicBool::new(false), || -> Result<_, Error> {
        let grid = Grid::new([nx, ny], size)?;
        leak.of_gap(&grid, gap, contact, time)
    })?;
    let state = solved?;
    let mut diagnostics = LeakDiagnostics::default();
    let resolved = diagnostics.see(&state.alone());
    let out = PyDict::new(py);
    out.set_item("leak_resolved", resolved)?;
    out.set_item("findings", asperity_io::finding::list(&diagnostics.findings()).to_string())?;
    entries!(out, state; percolates hydraulic_gap critical_gap critical_width medium_gap open_fraction);
    entries!(out, state; trapped_area trapped_volume conductance leak_rate leak_rate_standard);
    entries!(out, state; leak_estimate_junction leak_estimate_medium);
    out.set_item("critical_x", state.critical[0])?;
    out.set_item("critical_y", state.critical[1])?;
    out.set_item("knudsen_number", state.knudsen)?;
    out.set_item("pressure", state.pressure.into_pyarray(py))?;
    out.set_item("cells", state.cells.mapv(|kind| kind as u8).into_pyarray(py))?;
    Ok(out)
}

/// A state for the diagnostics: row (none for a gap without a run), critical gap (none if nothing passes), cells across it, error
/// of the gap, pressure drop, mean pressure.
type State = (Option<usize>, Option<f64>, Option<usize>, f64, Option<f64>, f64);

/// Which leaks the numbers carry, and what was found against the others (a JSON list). `preparation` is what was done to the surfaces, as
/// JSON of the setup of a result.
#[pyfunction]
pub fn judge_leaks(states: Vec<State>, preparation: &str) -> (Vec<bool>, String) {
    let mut diagnostics = LeakDiagnostics::default();
    let resolved = states.into_iter().map(|(row, gap, width, gap_error, pressure_drop, mean_pressure)| {
        let constriction = gap.map(|gap| (gap, width));
        diagnostics.see(&LeakState { row, constriction, gap_error, closed: 0, pressure_drop, mean_pressure })
    });
    let windows = serde_json::from_str(preparation).ok().and_then(|setup| through_windows(&setup));
    let resolved = resolved.map(|sound| sound && windows.is_none()).collect();
    let findings: Vec<_> = diagnostics.findings().into_iter().chain(windows).collect();
    (resolved, asperity_io::finding::list(&findings).to_string())
}
