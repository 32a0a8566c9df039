//! A result on disk, written row by row while Python solves.

use std::path::PathBuf;

use asperity::Axis;
use asperity::quantities::Column;
use asperity_io::store::{Field, FieldKind, Header, Outcome};
use ndarray::Array2;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, file};
use crate::given::{choose, grid_of};
use crate::store::{row_of, status_of};
use crate::wait::detached;

/// A result that grows.
#[pyclass]
pub struct Writer {
    writer: Option<asperity_io::store::Writer>,
    kinds: Vec<FieldKind>,
    axis: Axis,
}

/// A field as Python holds it.
enum Held {
    Real(FieldKind, Array2<f64>),
    Contact(Array2<u8>),
}

impl Held {
    fn field(&self) -> Field<'_> {
        match self {
            Held::Real(kind, map) => Field::Real(*kind, map.view()),
            Held::Contact(map) => Field::Contact(map.view()),
        }
    }
}

#[pymethods]
impl Writer {
    /// Begins a result. `quantities` are names with the ends of their bins, `setup` is JSON.
    #[new]
    #[pyo3(signature = (path, force, title, setup, size, initial_gap, fields, quantities, rows))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        force: bool,
        title: String,
        setup: &str,
        size: Vec<f64>,
        initial_gap: PyReadonlyArray2<'_, f64>,
        fields: Vec<String>,
        quantities: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        rows: Option<usize>,
    ) -> PyResult<Writer> {
        let gap = initial_gap.as_array();
        let grid = grid_of(py, gap.dim(), &size)?;
        let kinds = fields.iter().map(|name| choose("field", name)).collect::<PyResult<Vec<FieldKind>>>()?;
        let column = |(name, edges): &(String, PyReadonlyArray1<'_, f64>)| {
            Ok(Column { quantity: choose("quantity", name)?, edges: edges.as_array().to_vec() })
        };
        let header = Header {
            title,
            case_text: String::new(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            grid,
            fields: kinds.clone(),
            quantities: quantities.iter().map(column).collect::<PyResult<Vec<Column>>>()?,
            rows_expected: rows,
            setup: serde_json::from_str(setup).map_err(|error| CaseError::new_err(error.to_string()))?,
        };
        let created = detached(py, || asperity_io::store::Writer::create(&path, &header, gap, force))?;
        Ok(Writer { writer: Some(created.map_err(file)?), kinds, axis: header.axis() })
    }

    /// Stores a row: its numbers by their names, those of its quantities one after the other, and its fields by their names where
    /// they are kept.
    fn append(
        &mut self,
        py: Python<'_>,
        row: &Bound<'_, PyDict>,
        quantities: Vec<f64>,
        fields: &Bound<'_, PyDict>,
    ) -> PyResult<()> {
        let row = row_of(row, self.axis)?;
        let held = self.held(fields)?;
        let writer = open(&mut self.writer)?;
        detached(py, || {
            let fields: Vec<Field<'_>> = held.iter().map(Held::field).collect();
            writer.append_with(&row, &quantities, &fields)
        })?
        .map_err(file)
    }

    /// Stores the fields of a state between the last row and the next one.
    fn stage(&mut self, py: Python<'_>, time: f64, fields: &Bound<'_, PyDict>) -> PyResult<()> {
        let held = self.held(fields)?;
        let writer = open(&mut self.writer)?;
        detached(py, || writer.stage(time, &held.iter().map(Held::field).collect::<Vec<_>>()))?.map_err(file)
    }

    /// Rows stored.
    #[getter]
    fn rows(&self) -> usize {
        self.writer.as_ref().map_or(0, asperity_io::store::Writer::len)
    }

    /// Ends the result as "complete", "interrupted" or "failed" with its findings, a JSON list, and a message.
    #[pyo3(signature = (status, findings, message))]
    fn finish(
        &mut self,
        py: Python<'_>,
        status: &str,
        findings: &str,
        message: Option<String>,
    ) -> PyResult<()> {
        let status = status_of(status);
        let findings =
            serde_json::from_str(findings).map_err(|error| CaseError::new_err(error.to_string()))?;
        let mut writer = self.writer.take().ok_or_else(|| CaseError::new_err("the result has ended"))?;
        writer.set_findings(asperity_io::finding::from_list(&findings));
        let outcome = Outcome { message, ..Outcome::new(status) };
        detached(py, || writer.finish(&outcome))?.map(drop).map_err(file)
    }
}

impl Writer {
    /// Fields by their names, all of them or none.
    fn held(&self, fields: &Bound<'_, PyDict>) -> PyResult<Vec<Held>> {
        let kept = self.kinds.iter().filter(|_| !fields.is_empty());
        let held = kept.map(|kind| {
            let found = fields.get_item(kind.name())?;
            let found = found
                .ok_or_else(|| CaseError::new_err(format!("the field '{kind}' of the row is missing")))?;
            Ok(match kind {
                FieldKind::Contact => {
                    Held::Contact(found.extract::<PyReadonlyArray2<'_, u8>>()?.as_array().to_owned())
                }
                kind => {
                    Held::Real(*kind, found.extract::<PyReadonlyArray2<'_, f64>>()?.as_array().to_owned())
                }
            })
        });
        held.collect()
    }
}

fn open(writer: &mut Option<asperity_io::store::Writer>) -> PyResult<&mut asperity_io::store::Writer> {
    writer.as_mut().ok_or_else(|| CaseError::new_err("the result has ended"))
}
