//! The stress below the surface.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use asperity::load::Control;
use asperity::stress::{
    Extreme, StressQuantity, SubsurfaceStress, SurveyOptions, automatic_depths, check_depths, contact_box,
    survey,
};
use asperity::{Boundary, Error, Grid};
use asperity_io::stress::ChangingRatio;
use ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray3, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::{Dict, Map, Plane, choose, entries, grid_of};
use crate::wait::without_python;

/// Where the Poisson's ratio changes with time, int nu(t - s) dp(s) \[Pa\] in each cell and the lateral pressure \[Pa\] that
/// belongs to the mean pressure: [`SubsurfaceStress::set_transverse`].
type Transverse<'py> = Option<(Plane<'py>, f64)>;

/// The stress below one pressure.
#[pyclass(frozen)]
pub struct Stress {
    grid: Grid,
    boundary: Boundary,
    pressure: Vec<f64>,
    /// Locked where threads of Python share it.
    stress: Mutex<SubsurfaceStress>,
}

#[pymethods]
impl Stress {
    /// Of a pressure on a plane, or on a line, whose size is one length.
    #[new]
    fn new(
        pressure: Plane<'_>,
        size: Vec<f64>,
        boundary: &str,
        poisson: f64,
        transverse: Transverse<'_>,
        tractions: Option<[Plane<'_>; 2]>,
    ) -> Answer<Stress> {
        let boundary = choose("boundary", boundary)?;
        let grid = grid_of(pressure.as_array().dim(), &size)?;
        let pressure: Vec<f64> = pressure.as_array().iter().copied().collect();
        let planned = || -> Result<_, Error> {
            let mut stress = SubsurfaceStress::new(grid, boundary, poisson)?;
            match transverse {
                None => stress.set_pressure(&pressure)?,
                Some((transverse, confined)) => {
                    let transverse: Vec<f64> = transverse.as_array().iter().copied().collect();
                    stress.set_transverse(&pressure, &transverse, confined)?;
                }
            }
            if let Some(tractions) = &tractions {
                let [x, y] = tractions.each_ref().map(|q| q.as_array().iter().copied().collect::<Vec<f64>>());
                stress.add_tractions([&x, &y])?;
            }
            Ok(Mutex::new(stress))
        };
        let stress = planned()?;
        Ok(Stress { grid, boundary, pressure, stress })
    }

    /// Depths that suit the contact.
    fn automatic_depths(&self) -> Vec<f64> {
        automatic_depths(&self.grid, self.boundary, contact_box(&self.grid, &self.pressure))
    }

    /// Checks depths.
    fn check_depths(&self, depths: Vec<f64>) -> Answer<()> {
        Ok(check_depths(&self.grid, &depths)?)
    }

    /// One field of shape (depth, x, y): a component ("xx", ...), "mises", "tresca", "tension" or "pressure".
    fn field<'py>(&self, py: Python<'py>, name: &str, depths: Vec<f64>) -> Answer<Bound<'py, PyArray3<f64>>> {
        let [nx, ny] = self.grid.cells();
        let mut field = vec![0.0; depths.len() * self.grid.len()];
        let quantity = StressQuantity::from_name(name)
            .ok_or_else(|| Failure::case(format!("there is no stress '{name}'")))?;
        self.solve(py, |stress| {
            let mut six = std::array::from_fn(|_| Vec::new());
            for (depth, out) in depths.iter().zip(field.chunks_mut(self.grid.len())) {
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
        let field = Array3::from_shape_vec((depths.len(), nx, ny), field);
        Ok(field?.into_pyarray(py))
    }

    /// Maxima with their places, and the profile over depth.
    fn survey<'py>(
        &self,
        py: Python<'py>,
        depths: Vec<f64>,
        threshold: Option<f64>,
        rolling: Option<&str>,
    ) -> Answer<Dict<'py>> {
        let rolling = rolling.map(|word| choose("rolling", word)).transpose()?;
        let options = SurveyOptions { threshold, rolling };
        let found = self.solve(py, |stress| survey(stress, &depths, &options))?;
        let out = PyDict::new(py);
        let (grid, ny) = (self.grid, self.grid.cells()[1]);
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
        entries!(out, found; mises_by_depth tresca_by_depth tension_by_depth stressed_volume unseen unresolved);
        if let Some(shear) = found.orthogonal_shear {
            out.set_item("orthogonal_shear", shear.largest.value)?;
            out.set_item("orthogonal_shear_depth", shear.largest.depth)?;
            out.set_item("orthogonal_shear_by_depth", shear.by_depth)?;
        }
        Ok(out)
    }
}

impl Stress {
    /// What `work` finds while other threads of Python run.
    fn solve<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut SubsurfaceStress) -> Result<T, Error> + Send,
    ) -> Answer<T> {
        let locked = || work(&mut self.stress.lock().unwrap_or_else(PoisonError::into_inner));
        Ok(without_python(py, &AtomicBool::new(false), locked)??)
    }
}

/// int nu(t - s) dp(s) \[Pa\] in each cell at the last of the times, and the lateral pressure \[Pa\] of the mean pressure without
/// lateral strain, for a body whose Poisson's ratio changes with time; `creep` are its functions as JSON, as the setup of a result
/// has them, and `stages` the stage of each of the times, `controls` what is prescribed in each stage.
#[pyfunction]
pub fn stress_transverse<'py>(
    py: Python<'py>,
    creep: &str,
    controls: &str,
    stages: Vec<usize>,
    times: Vec<f64>,
    pressures: PyReadonlyArray3<'_, f64>,
) -> Answer<(Map<'py>, f64)> {
    let changing: ChangingRatio = serde_json::from_str(creep)?;
    let controls: Vec<Control> = serde_json::from_str(controls)?;
    let (rows, nx, ny) = pressures.as_array().dim();
    if rows != times.len() {
        return Err(Failure::case(format!("{rows} pressures, but {} times", times.len())));
    }
    let grid = Grid::new([nx, ny], [nx as f64, ny as f64])?;
    let mut history = changing.history(grid)?;
    let fields = pressures.as_array();
    for ((time, stage), pressure) in times.iter().zip(&stages).zip(fields.outer_iter()) {
        let cells: Vec<f64> = pressure.iter().copied().collect();
        let control = controls.get(*stage).copied().unwrap_or(Control::Load);
        history.advance(*time, control, &cells)?;
    }
    let field = Array2::from_shape_vec((nx, ny), history.transverse());
    let field = field?;
    Ok((field.into_pyarray(py), history.confined()))
}
