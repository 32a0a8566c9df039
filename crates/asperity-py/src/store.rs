//! Stored results.

use std::path::PathBuf;

use asperity_io::store::{At, FieldKind, Reader};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::error::file;

/// A result on disk, read as it is asked for.
#[pyclass(frozen)]
pub struct Store {
    reader: Reader,
}

#[pymethods]
impl Store {
    #[new]
    fn new(path: PathBuf) -> PyResult<Store> {
        Ok(Store { reader: Reader::open(&path).map_err(file)? })
    }

    /// A number of every row.
    fn series<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.reader.series(name).map_err(file)?.into_pyarray(py))
    }

    /// A field at a stored instant, by its number.
    fn field<'py>(&self, py: Python<'py>, name: &str, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let names = "pressure, gap, displacement, contact";
        let kind = FieldKind::from_name(name)
            .ok_or_else(|| file(format!("there is no field '{name}'; choose from {names}")))?;
        let at = At::Index(index);
        Ok(match kind {
            FieldKind::Contact => {
                py.detach(|| self.reader.contact(at)).map_err(file)?.into_pyarray(py).into_any()
            }
            kind => py.detach(|| self.reader.field(kind, at)).map_err(file)?.into_pyarray(py).into_any(),
        })
    }

    fn initial_gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        Ok(py.detach(|| self.reader.initial_gap()).map_err(file)?.into_pyarray(py))
    }

    #[getter]
    fn field_steps(&self) -> Vec<usize> {
        self.reader.field_steps().to_vec()
    }

    #[getter]
    fn fields(&self) -> Vec<&'static str> {
        self.reader.header().fields.iter().map(|kind| kind.name()).collect()
    }

    #[getter]
    fn cells(&self) -> [usize; 2] {
        self.reader.header().grid.cells()
    }

    #[getter]
    fn size(&self) -> [f64; 2] {
        self.reader.header().grid.size()
    }

    /// The attributes of the group, as JSON.
    #[getter]
    fn attributes(&self) -> String {
        serde_json::Value::Object(self.reader.attributes()).to_string()
    }
}
