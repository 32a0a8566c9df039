//! The stress below the surface.

use std::sync::atomic::AtomicBool;

use asperity::stress::{
    Extreme, StressQuantity, SubsurfaceStress, SurveyOptions, automatic_depths, check_depths, contact_box,
    survey,
};
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
    Ok(automatic_depths(&grid, boundary, contact_box(&grid, &cells)))
}

/// Checks all numbers of a stress.
#[pyfunction]
pub fn stress_check(
    py: Python<'_>,
    pressure: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    boundary: &str,
    poisson: f64,
    depths: Vec<f64>,
) -> PyResult<()> {
    let (grid, ..) = planned(py, &pressure, size, boundary, poisson)?;
    check_depths(&grid, &depths).map_err(|error| raised(py, error))
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
    let quantity = StressQuantity::from_name(name)
        .ok_or_else(|| CaseError::new_err(format!("there is no stress '{name}'")))?;
    let solved = without_python(py, &AtomicBool::new(false), || -> Result<(), Error> {
        let mut six = std::array::from_fn(|_| Vec::new());
        for (depth, out) in depths.iter().zip(field.chunks_mut(grid.len())) {
            match quantity.component() {
                Some(component) => stress.component_into(component, *depth, out)?,
                None => {
                    stress.at(*depth, &mut six)?;
                    quantity.field_into(&six, out);
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
#[allow(clippy::too_many_arguments)]
pub fn stress_survey<'py>(
    py: Python<'py>,
    pressure: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    boundary: &str,
    poisson: f64,
    depths: Vec<f64>,
    threshold: Option<f64>,
    rolling: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
    let (grid, _, _, mut stress) = planned(py, &pressure, size, boundary, poisson)?;
    let rolling = rolling.map(|word| choose("rolling", word)).transpose()?;
    let options = SurveyOptions { threshold, rolling };
    let found = without_python(py, &AtomicBool::new(false), || survey(&mut stress, &depths, &options))?;
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
    out.set_item("tresca_by_depth", found.tresca_by_depth)?;
    out.set_item("tension_by_depth", found.tension_by_depth)?;
    out.set_item("stressed_volume", found.stressed_volume)?;
    if let Some(shear) = found.orthogonal_shear {
        out.set_item("orthogonal_shear", shear.largest.value)?;
        out.set_item("orthogonal_shear_depth", shear.largest.depth)?;
        out.set_item("orthogonal_shear_by_depth", shear.by_depth)?;
    }
    out.set_item("at_the_deepest", found.at_the_deepest)?;
    out.set_item("unresolved", found.unresolved)?;
    Ok(out)
}
