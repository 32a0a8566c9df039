//! Friction of moving contacts.

use asperity::Grid;
use asperity::reference::{self, Correction};
use asperity::sliding::Direction;
use asperity::surface::Surface;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::raised;
use crate::given::choose_among;
use crate::material::bodies;
use crate::wait::detached;

type Curve<'py> = Bound<'py, PyArray1<f64>>;

/// Persson's theory for one surface, material and nominal pressure.
#[pyclass(frozen)]
pub struct Persson {
    inner: reference::Persson,
}

#[pymethods]
impl Persson {
    /// `direction` is "x", "y" or "angle", with its `angle` in rad; `keys` are `body` and `temperature`.
    #[new]
    #[pyo3(signature = (heights, size, keys, pressure, direction, angle, correction))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        heights: PyReadonlyArray2<'_, f64>,
        size: [f64; 2],
        keys: Bound<'_, PyDict>,
        pressure: f64,
        direction: &str,
        angle: f64,
        correction: &str,
    ) -> PyResult<Self> {
        let corrections = [("yang-persson", Correction::YangPersson), ("none", Correction::None)];
        let correction = choose_among("correction", correction, &corrections)?;
        let directions = [("x", Direction::X), ("y", Direction::Y), ("angle", Direction::Angle(angle))];
        let direction = choose_among("direction", direction, &directions)?;
        let creep = bodies(&keys, None)?.creep;
        let heights = heights.as_array().to_owned();
        let inner = detached(py, || {
            let (nx, ny) = heights.dim();
            let surface = Surface::new(Grid::new([nx, ny], size)?, heights)?;
            reference::Persson::of_surface(&surface, direction, &creep, pressure, correction)
        })?;
        Ok(Persson { inner: inner.map_err(|error| raised(py, error))? })
    }

    /// Friction coefficients and contact fractions at velocities.
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        velocities: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(Curve<'py>, Curve<'py>)> {
        let velocities: Vec<f64> = velocities.as_array().to_vec();
        let found = detached(py, || self.inner.sweep(&velocities))?.map_err(|error| raised(py, error))?;
        let (friction, contact): (Vec<f64>, Vec<f64>) =
            found.iter().map(|at| (at.friction_coefficient, at.contact_fraction)).unzip();
        Ok((friction.into_pyarray(py), contact.into_pyarray(py)))
    }

    /// Wave numbers, contact fractions and friction coefficients over the magnification.
    fn magnification<'py>(
        &self,
        py: Python<'py>,
        velocity: f64,
    ) -> PyResult<(Curve<'py>, Curve<'py>, Curve<'py>)> {
        let curve =
            detached(py, || self.inner.magnification(velocity))?.map_err(|error| raised(py, error))?;
        Ok((
            curve.wave_number.into_pyarray(py),
            curve.contact_fraction.into_pyarray(py),
            curve.friction_coefficient.into_pyarray(py),
        ))
    }
}
