//! One elastic contact.

use std::sync::atomic::AtomicBool;

use asperity::contact::Hardness;
use asperity::operator::half_space;
use asperity::{Boundary, ContactState, Prescribed, Problem, Solver};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, raised};
use crate::march::{choose, grid_of, solver as solver_of};
use crate::wait::without_python;

/// Pressure, displacement and approach of an elastic contact, and how good they are.
#[pyfunction]
#[pyo3(signature = (gap, size, contact_modulus, load, approach, hardness, hardness_map, boundary, method, tolerance, max_iterations))]
#[allow(clippy::too_many_arguments)]
pub fn elastic<'py>(
    py: Python<'py>,
    gap: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    contact_modulus: f64,
    load: Option<f64>,
    approach: Option<f64>,
    hardness: f64,
    hardness_map: Option<PyReadonlyArray2<'_, f64>>,
    boundary: &str,
    method: &str,
    tolerance: f64,
    max_iterations: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (nx, ny) = gap.as_array().dim();
    let grid = grid_of(py, (nx, ny), &size)?;
    let boundary: Boundary = choose("boundary", boundary)?;
    let free_line = grid.is_line() && boundary == Boundary::Free;
    if free_line && (approach.is_some() || nx < 2) {
        return Err(CaseError::new_err(
            "a free line contact needs two cells at least, and a load: under a load on a line a half-space moves endlessly, so the \
             approach is known up to a constant; boundary=\"periodic\" has no such limit",
        ));
    }
    let prescribed = match (load, approach) {
        (Some(load), None) => Prescribed::Load(load),
        (None, Some(approach)) => Prescribed::Approach(approach),
        _ => return Err(CaseError::new_err("give load or approach, exactly one of them")),
    };
    for (what, value) in [("contact modulus", contact_modulus), ("hardness", hardness)] {
        if value.is_nan() || value <= 0.0 || (what == "contact modulus" && value.is_infinite()) {
            return Err(CaseError::new_err(format!("{what} is {value}, but must be greater than 0 Pa")));
        }
    }
    let cells: Vec<f64> = gap.as_array().iter().copied().collect();
    if let Some(value) = cells.iter().find(|h| h.is_nan() || **h == f64::NEG_INFINITY) {
        let words = "finite, or infinite where a cell cannot touch";
        return Err(CaseError::new_err(format!("gap holds {value}, but must be {words}")));
    }
    let hardnesses: Option<Vec<f64>> = match &hardness_map {
        Some(map) if map.as_array().dim() != (nx, ny) => {
            let found = map.as_array().dim();
            let words =
                format!("hardness has shape {found:?}, but must have {:?}, one for each cell", (nx, ny));
            return Err(CaseError::new_err(words));
        }
        Some(map) => Some(map.as_array().iter().copied().collect()),
        None => None,
    };
    if let Some(value) = hardnesses.iter().flatten().find(|h| !(h.is_finite() && **h > 0.0)) {
        let words = format!("hardness holds {value}, but must be finite and greater than 0 Pa in every cell");
        return Err(CaseError::new_err(words));
    }
    let options = solver_of(method, tolerance, max_iterations)?;
    options.validate().map_err(|error| raised(py, error))?;
    let interrupt = AtomicBool::new(false);
    let mut state = ContactState::new(grid.len());
    let solved = without_python(py, &interrupt, || {
        let mut operator = half_space(grid, boundary);
        let mut solver = Solver::new(options.method, &*operator);
        let hardness = hardnesses.as_deref().map_or(hardness.into(), Hardness::Cells);
        let problem = Problem { gap: &cells, compliance: 1.0 / contact_modulus, hardness, prescribed };
        solver.solve(&mut *operator, &problem, &options, &mut state, Some(&interrupt))
    })?;
    let map = |values: Vec<f64>| {
        let array = ndarray::Array2::from_shape_vec(grid.shape(), values);
        array.map(|array| array.into_pyarray(py)).map_err(|error| CaseError::new_err(error.to_string()))
    };
    let outcome = match solved {
        Ok(outcome) => outcome,
        Err(error) => {
            let raised = raised(py, error);
            let _ = map(state.pressure).and_then(|best| raised.value(py).setattr("best", best));
            return Err(raised);
        }
    };
    // Of a free line contact displacements are measured from the domain's end, x = L, as those of a march are.
    let datum = match state.unit_displacement.as_slice() {
        [.., before, last] if free_line => (last + 0.5 * (last - before)) / contact_modulus,
        _ => 0.0,
    };
    let out = PyDict::new(py);
    let sum: f64 = state.pressure.iter().sum();
    let touching = state.pressure.iter().filter(|p| **p > 0.0).count();
    out.set_item("load", sum * grid.cell_area())?;
    out.set_item("approach", state.approach - datum)?;
    out.set_item("contact_area", touching as f64 * grid.cell_area())?;
    let displacement = state.unit_displacement.iter().map(|u| u / contact_modulus - datum).collect();
    out.set_item("displacement", map(displacement)?)?;
    out.set_item("pressure", map(state.pressure)?)?;
    out.set_item("residual", outcome.residual)?;
    out.set_item("certificate", outcome.certificate)?;
    out.set_item("iterations", outcome.iterations)?;
    out.set_item("convolutions", outcome.convolutions)?;
    Ok(out)
}
