//! Force curves from the files of instruments that this package reads itself.

use std::path::PathBuf;

use asperity_io::curve::{Calibration, InstrumentCurve, read_curve_file};
use asperity_io::topography::Problem;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::Dict;
use crate::wait::detached;

/// The curves of a Nanoscope file, with numbers in place of its own where they are given; None of a file of another kind.
#[pyfunction]
pub fn read_force_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    spring_constant: Option<f64>,
    sensitivity: Option<f64>,
) -> Answer<Option<Vec<Dict<'py>>>> {
    let read = detached(py, || read_curve_file(&path, Calibration { spring_constant, sensitivity }))?;
    // What a file holds is a matter of the curves, not of the system.
    let read = read.map_err(|error| match error.problem {
        Problem::Io(_) => Failure::from(error),
        _ => Failure::case(error),
    })?;
    let Some(curves) = read else { return Ok(None) };
    Ok(Some(curves.into_iter().map(|curve| of(py, curve)).collect::<PyResult<_>>()?))
}

fn of(py: Python<'_>, curve: InstrumentCurve) -> PyResult<Dict<'_>> {
    let out = PyDict::new(py);
    out.set_item("height", curve.height.into_pyarray(py))?;
    out.set_item("deflection", curve.deflection.into_pyarray(py))?;
    out.set_item("time", curve.time.map(|time| time.into_pyarray(py)))?;
    out.set_item("approach", curve.approach)?;
    out.set_item("spring_constant", curve.spring_constant)?;
    out.set_item("sensitivity", curve.sensitivity)?;
    let place = curve.place.map(|place| {
        let [x, y] = place.index;
        let [nx, ny] = place.shape;
        ((x, y), (nx, ny), place.size.map(|[lx, ly]| (lx, ly)))
    });
    out.set_item("place", place)?;
    Ok(out)
}
