//! Friction of moving contacts.

use asperity::Grid;
use asperity::reference::{self, Correction};
use asperity::sliding::Direction;
use asperity::surface::Surface;
use numpy::IntoPyArray;
use pyo3::prelude::*;

use crate::error::Answer;
use crate::given::{Dict, List, Numbers, Plane};
use crate::material::bodies;
use crate::wait::detached;

/// A direction in the plane: an axis, 'x' or 'y', or an angle from x towards y \[rad\].
#[derive(FromPyObject)]
pub enum Along {
    Axis(char),
    Angle(f64),
}

/// Persson's theory for one surface, material and nominal pressure.
#[pyclass(frozen)]
pub struct Persson {
    inner: reference::Persson,
}

#[pymethods]
impl Persson {
    /// `keys` are `body` and `temperature`; the strain in partial contact may be `corrected` as by Yang and Persson.
    #[new]
    fn new(
        py: Python<'_>,
        heights: Plane<'_>,
        size: [f64; 2],
        keys: Dict<'_>,
        pressure: f64,
        direction: Along,
        corrected: bool,
    ) -> Answer<Self> {
        let correction = if corrected { Correction::YangPersson } else { Correction::None };
        let direction = match direction {
            Along::Axis('x') => Direction::X,
            Along::Axis(_) => Direction::Y,
            Along::Angle(angle) => Direction::Angle(angle),
        };
        let creep = bodies(&keys, None)?.creep;
        let heights = heights.as_array().to_owned();
        let inner = detached(py, || {
            let (nx, ny) = heights.dim();
            let surface = Surface::new(Grid::new([nx, ny], size)?, heights)?;
            reference::Persson::of_surface(&surface, direction, &creep, pressure, correction)
        })?;
        Ok(Persson { inner: inner? })
    }

    /// Friction coefficients and contact fractions at velocities.
    fn sweep<'py>(&self, py: Python<'py>, velocities: List<'_>) -> Answer<(Numbers<'py>, Numbers<'py>)> {
        let velocities: Vec<f64> = velocities.as_array().to_vec();
        let found = detached(py, || self.inner.sweep(&velocities))??;
        let (friction, contact): (Vec<f64>, Vec<f64>) =
            found.iter().map(|at| (at.friction_coefficient, at.contact_fraction)).unzip();
        Ok((friction.into_pyarray(py), contact.into_pyarray(py)))
    }

    /// Wave numbers, contact fractions and friction coefficients over the magnification.
    fn magnification<'py>(
        &self,
        py: Python<'py>,
        velocity: f64,
    ) -> Answer<(Numbers<'py>, Numbers<'py>, Numbers<'py>)> {
        let curve = detached(py, || self.inner.magnification(velocity))??;
        Ok((
            curve.wave_number.into_pyarray(py),
            curve.contact_fraction.into_pyarray(py),
            curve.friction_coefficient.into_pyarray(py),
        ))
    }
}
