//! The stress below the surface.

use std::sync::atomic::AtomicBool;

use asperity::stress::{
    Extreme, PressureHistory, StressQuantity, SubsurfaceStress, SurveyOptions, automatic_depths,
    check_depths, contact_box, survey,
};
use asperity::{Boundary, Error, Grid};
use ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, raised};
use crate::given::{choose, entries};
use crate::wait::without_python;

/// Where the Poisson's ratio changes with time, int nu(t - s) dp(s) \[Pa\] in each cell and the lateral pressure \[Pa\] that
/// belongs to the mean pressure: [`SubsurfaceStress::set_transverse`].
type Transverse<'py> = Option<(PyReadonlyArray2<'py, f64>, f64)>;

/// Pressure, grid and transforms. A line has one length.
fn planned(
    py: Python<'_>,
    pressure: &PyReadonlyArray2<'_, f64>,
    size: &[f64],
    boundary: &str,
    poisson: f64,
    transverse: &Transverse<'_>,
) -> PyResult<(Grid, Boundary, Vec<f64>, SubsurfaceStress)> {
    let (nx, ny) = pressure.as_array().dim();
    let boundary = choose("boundary", boundary)?;
    let cells: Vec<f64> = pressure.as_array().iter().copied().collect();
    let planned = || -> Result<_, Error> {
        let grid = match *size {
            [length] => Grid::line(nx, length)?,
            [x, y] => Grid::new([nx, ny], [x, y])?,
            _ => return Err(Error::invalid("size", format!("{size:?}"), "one or two lengths")),
        };
        let mut stress = SubsurfaceStress::new(grid, boundary, poisson)?;
        match transverse {
            None => stress.set_pressure(&cells)?,
            Some((transverse, confined)) => {
                let transverse: Vec<f64> = transverse.as_array().iter().copied().collect();
                stress.set_transverse(&cells, &transverse, *confined)?;
            }
        }
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
    size: Vec<f64>,
    boundary: &str,
) -> PyResult<Vec<f64>> {
    let (grid, boundary, cells, _) = planned(py, &pressure, &size, boundary, 0.0, &None)?;
    Ok(automatic_depths(&grid, boundary, contact_box(&grid, &cells)))
}

/// Checks all numbers of a stress.
#[pyfunction]
pub fn stress_check(
    py: Python<'_>,
    pressure: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    boundary: &str,
    poisson: f64,
    transverse: Transverse<'_>,
    depths: Vec<f64>,
) -> PyResult<()> {
    let (grid, ..) = planned(py, &pressure, &size, boundary, poisson, &transverse)?;
    check_depths(&grid, &depths).map_err(|error| raised(py, error))
}

/// int nu(t - s) dp(s) \[Pa\] in each cell at the last of the times, and the lateral pressure \[Pa\] of the mean pressure without
/// lateral strain, for a body whose Poisson's ratio changes with time; `creep` are its functions as JSON, as the setup of a result
/// has them.
#[pyfunction]
pub fn stress_transverse<'py>(
    py: Python<'py>,
    creep: &str,
    times: Vec<f64>,
    pressures: PyReadonlyArray3<'_, f64>,
) -> PyResult<(Bound<'py, PyArray2<f64>>, f64)> {
    let creep = serde_json::from_str(creep).map_err(|error| CaseError::new_err(error.to_string()))?;
    let (rows, nx, ny) = pressures.as_array().dim();
    if rows != times.len() {
        return Err(CaseError::new_err(format!("{rows} pressures, but {} times", times.len())));
    }
    let mut history = PressureHistory::new(creep, nx * ny);
    for (time, pressure) in times.iter().zip(pressures.as_array().outer_iter()) {
        let cells: Vec<f64> = pressure.iter().copied().collect();
        history.advance(*time, &cells).map_err(|error| raised(py, error))?;
    }
    let field = Array2::from_shape_vec((nx, ny), history.transverse());
    let field = field.map_err(|error| CaseError::new_err(error.to_string()))?;
    Ok((field.into_pyarray(py), history.confined()))
}

/// One field of shape (depth, x, y): a component ("xx", ...), "mises", "tresca", "tension" or "pressure".
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn stress_field<'py>(
    py: Python<'py>,
    name: &str,
    pressure: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    boundary: &str,
    poisson: f64,
    transverse: Transverse<'_>,
    depths: Vec<f64>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let (grid, _, _, mut stress) = planned(py, &pressure, &size, boundary, poisson, &transverse)?;
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
    size: Vec<f64>,
    boundary: &str,
    poisson: f64,
    transverse: Transverse<'_>,
    depths: Vec<f64>,
    threshold: Option<f64>,
    rolling: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
    let (grid, _, _, mut stress) = planned(py, &pressure, &size, boundary, poisson, &transverse)?;
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
        if !grid.is_line() {
            out.set_item(format!("max_{name}_y"), grid.y(cell % ny))?;
        }
    }
    entries!(out, found; mises_by_depth tresca_by_depth tension_by_depth stressed_volume at_the_deepest unresolved);
    if let Some(shear) = found.orthogonal_shear {
        out.set_item("orthogonal_shear", shear.largest.value)?;
        out.set_item("orthogonal_shear_depth", shear.largest.depth)?;
        out.set_item("orthogonal_shear_by_depth", shear.by_depth)?;
    }
    Ok(out)
}
