//! The stress below the surface.

use std::sync::atomic::AtomicBool;

use asperity::stress::{Component, Extreme, SubsurfaceStress, automatic_depths, invariants, survey};
use asperity::{Boundary, Error, Grid};
use ndarray::Array3;
use numpy::{IntoPyArray, PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, raised};
use crate::march::choose;
use crate::wait::without_python;

/// Pressure, grid and transforms.
fn planned(
    py: Python<'_>,
    pressure: &PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    boundary: &str,
    poisson: f64,
) -> PyResult<(Grid, Boundary, Vec<f64>, SubsurfaceStress)> {
    let (nx, ny) = pressure.as_array().dim();
    let boundary = choose("boundary", boundary)?;
    let cells: Vec<f64> = pressure.as_array().iter().copied().collect();
    let planned = || -> Result<_, Error> {
        let grid = Grid::new([nx, ny], size)?;
        let mut stress = SubsurfaceStress::new(grid, boundary, poisson)?;
        stress.set_pressure(&cells)?;
        Ok((grid, stress))
    };
    let (grid, stress) = planned().map_err(|error| raised(py, error))?;
    Ok((grid, boundary, cells, stress))
}

/// Depths of a survey that the user leaves to the program.
#[pyfunction]
pub fn stress_depths(
    py: Python<'_>,
    pressure: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    boundary: &str,
) -> PyResult<Vec<f64>> {
    let (grid, boundary, cells, _) = planned(py, &pressure, size, boundary, 0.0)?;
    Ok(automatic_depths(&grid, boundary, &cells))
}

/// One field of shape (depth, x, y): a component ("xx", ...), "mises", "tresca", "tension" or "pressure".
#[pyfunction]
pub fn stress_field<'py>(
    py: Python<'py>,
    name: &str,
    pressure: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    boundary: &str,
    poisson: f64,
    depths: Vec<f64>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let (grid, _, _, mut stress) = planned(py, &pressure, size, boundary, poisson)?;
    let [nx, ny] = grid.cells();
    let mut field = vec![0.0; depths.len() * grid.len()];
    let component = Component::ALL.into_iter().find(|component| component.name() == name);
    let solved = without_python(py, &AtomicBool::new(false), || -> Result<(), Error> {
        let mut six = std::array::from_fn(|_| Vec::new());
        for (depth, out) in depths.iter().zip(field.chunks_mut(grid.len())) {
            match component {
                Some(component) => stress.component_into(component, *depth, out)?,
                None => {
                    stress.at(*depth, &mut six)?;
                    for (cell, out) in out.iter_mut().enumerate() {
                        let whole = invariants(std::array::from_fn(|k| six[k][cell]));
                        *out = match name {
                            "mises" => whole.mises,
                            "tresca" => whole.tresca,
                            "tension" => whole.tension,
                            _ => whole.pressure,
                        };
                    }
                }
            }
        }
        Ok(())
    })?;
    solved.map_err(|error| raised(py, error))?;
    let field = Array3::from_shape_vec((depths.len(), nx, ny), field);
    field.map(|field| field.into_pyarray(py)).map_err(|error| CaseError::new_err(error.to_string()))
}

/// Maxima with their places, and the profile over depth.
#[pyfunction]
pub fn stress_survey<'py>(
    py: Python<'py>,
    pressure: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    boundary: &str,
    poisson: f64,
    depths: Vec<f64>,
    threshold: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let (grid, _, _, mut stress) = planned(py, &pressure, size, boundary, poisson)?;
    let found = without_python(py, &AtomicBool::new(false), || survey(&mut stress, &depths, threshold))?;
    let found = found.map_err(|error| raised(py, error))?;
    let out = PyDict::new(py);
    let ny = grid.cells()[1];
    for (name, Extreme { value, depth, cell }) in
        [("mises", found.mises), ("tresca", found.tresca), ("tension", found.tension)]
    {
        out.set_item(format!("max_{name}"), value)?;
        out.set_item(format!("max_{name}_depth"), depth)?;
        out.set_item(format!("max_{name}_x"), grid.x(cell / ny))?;
        out.set_item(format!("max_{name}_y"), grid.y(cell % ny))?;
    }
    out.set_item("mises_by_depth", found.mises_by_depth)?;
    out.set_item("stressed_volume", found.stressed_volume)?;
    out.set_item("at_the_deepest", found.at_the_deepest)?;
    out.set_item("unresolved", found.unresolved)?;
    Ok(out)
}
