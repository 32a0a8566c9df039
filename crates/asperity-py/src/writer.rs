//! A result on disk, written row by row while Python solves.

use std::path::PathBuf;

use asperity::Axis;
use asperity::quantities::Column;
use asperity_io::store::{Field, FieldKind, Header, Outcome};
use ndarray::Array2;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::error::{Answer, Failure};
use crate::given::{Dict, List, Plane, choose, grid_of};
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
    fn new(
        py: Python<'_>,
        path: PathBuf,
        force: bool,
        title: String,
        setup: &str,
        size: Vec<f64>,
        initial_gap: Plane<'_>,
        fields: Vec<String>,
        quantities: Vec<(String, List<'_>)>,
        rows: Option<usize>,
    ) -> Answer<Writer> {
        let gap = initial_gap.as_array();
        let grid = grid_of(gap.dim(), &size)?;
        let kinds = fields.iter().map(|name| choose("field", name)).collect::<Answer<Vec<FieldKind>>>()?;
        let column = |(name, edges): &(String, List<'_>)| {
            Ok(Column { quantity: choose("quantity", name)?, edges: edges.as_array().to_vec() })
        };
        let header = Header {
            title,
            case_text: String::new(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            grid,
            fields: kinds.clone(),
            quantities: quantities.iter().map(column).collect::<Answer<Vec<Column>>>()?,
            rows_expected: rows,
            setup: serde_json::from_str(setup)?,
        };
        let created = detached(py, || asperity_io::store::Writer::create(&path, &header, gap, force))?;
        Ok(Writer { writer: Some(created?), kinds, axis: header.axis() })
    }

    /// Stores a row: its numbers by their names, those of its quantities one after the other, and its fields by their names where
    /// they are kept.
    fn append(
        &mut self,
        py: Python<'_>,
        row: &Dict<'_>,
        quantities: Vec<f64>,
        fields: &Dict<'_>,
    ) -> Answer<()> {
        let row = row_of(row, self.axis)?;
        let held = self.held(fields)?;
        let writer = open(&mut self.writer)?;
        let fields: Vec<Field<'_>> = held.iter().map(Held::field).collect();
        Ok(detached(py, || writer.append_with(&row, &quantities, &fields))??)
    }

    /// Stores the fields of a state between the last row and the next one.
    fn stage(&mut self, py: Python<'_>, time: f64, fields: &Dict<'_>) -> Answer<()> {
        let held = self.held(fields)?;
        let writer = open(&mut self.writer)?;
        let fields: Vec<Field<'_>> = held.iter().map(Held::field).collect();
        Ok(detached(py, || writer.stage(time, &fields))??)
    }

    /// Rows stored.
    #[getter]
    fn rows(&self) -> usize {
        self.writer.as_ref().map_or(0, asperity_io::store::Writer::len)
    }

    /// Ends the result as "complete", "interrupted" or "failed" with its findings, a JSON list, and a message.
    fn finish(
        &mut self,
        py: Python<'_>,
        status: &str,
        findings: &str,
        message: Option<String>,
    ) -> Answer<()> {
        let status = status_of(status);
        let findings = serde_json::from_str(findings)?;
        let mut writer = self.writer.take().ok_or_else(|| Failure::case("the result has ended"))?;
        writer.set_findings(asperity_io::finding::from_list(&findings));
        let outcome = Outcome { message, ..Outcome::new(status) };
        detached(py, || writer.finish(&outcome))??;
        Ok(())
    }
}

impl Writer {
    /// Fields by their names, all of them or none.
    fn held(&self, fields: &Dict<'_>) -> Answer<Vec<Held>> {
        let kept = self.kinds.iter().filter(|_| !fields.is_empty());
        let held = kept.map(|kind| {
            let found = fields.get_item(kind.name())?;
            let found =
                found.ok_or_else(|| Failure::case(format!("the field '{kind}' of the row is missing")))?;
            Ok(match kind {
                FieldKind::Contact => {
                    Held::Contact(found.extract::<PyReadonlyArray2<'_, u8>>()?.as_array().to_owned())
                }
                kind => Held::Real(*kind, found.extract::<Plane<'_>>()?.as_array().to_owned()),
            })
        });
        held.collect()
    }
}

fn open(writer: &mut Option<asperity_io::store::Writer>) -> Answer<&mut asperity_io::store::Writer> {
    writer.as_mut().ok_or_else(|| Failure::case("the result has ended"))
}
