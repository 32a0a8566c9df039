//! Stored results.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use asperity_io::leakage;
use asperity_io::store::{At, FieldKind, Reader, Row, SCALARS, Status, Writer};
use asperity_io::stress::{self, StressPlan};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::{Dict, Map, Numbers, choose};
use crate::wait::detached;

/// The ends of the bins, and the numbers of all rows.
type Histogram<'py> = (Numbers<'py>, Map<'py>);

/// A result on disk, read as it is asked for.
#[pyclass(frozen)]
pub struct Store {
    reader: Reader,
    /// The directory that was opened.
    #[cfg(unix)]
    directory: std::fs::File,
}

impl Store {
    /// The reader. An error if another result has replaced the one that was opened: otherwise rows of one would be combined with
    /// fields of the other.
    fn unchanged(&self) -> Answer<&Reader> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            let path = self.reader.path();
            let (opened, here) = (self.directory.metadata()?, std::fs::metadata(path));
            if !here.is_ok_and(|here| (here.dev(), here.ino()) == (opened.dev(), opened.ino())) {
                let path = path.display();
                return Err(Failure::file(format!(
                    "{path} was replaced or removed since it was opened: open it again"
                )));
            }
        }
        Ok(&self.reader)
    }
}

#[pymethods]
impl Store {
    #[new]
    fn new(path: PathBuf) -> Answer<Store> {
        let reader = Reader::open(&path).map_err(|error| Failure::of_path(&path, error))?;
        Ok(Store {
            #[cfg(unix)]
            directory: std::fs::File::open(&path)?,
            reader,
        })
    }

    /// A number of every row; counts are integers.
    fn series<'py>(&self, py: Python<'py>, name: &str) -> Answer<Bound<'py, PyAny>> {
        let numbers = self.reader.series(name)?;
        if SCALARS.iter().any(|scalar| scalar.name == name && scalar.is_count()) {
            let counts: Vec<i64> = numbers.into_iter().map(|number| number as i64).collect();
            return Ok(counts.into_pyarray(py).into_any());
        }
        Ok(numbers.into_pyarray(py).into_any())
    }

    /// Names of the quantities that were asked for.
    #[getter]
    fn quantities(&self) -> Vec<&'static str> {
        self.reader.header().quantities.iter().map(|column| column.quantity.name()).collect()
    }

    /// A histogram: the ends of its bins, and its rows.
    fn histogram<'py>(&self, py: Python<'py>, name: &str) -> Answer<Histogram<'py>> {
        let (edges, rows) = self.reader.histogram(choose("quantity", name)?)?;
        Ok((edges.into_pyarray(py), rows.into_pyarray(py)))
    }

    /// A field at a stored instant, by its number.
    fn field<'py>(&self, py: Python<'py>, name: &str, index: usize) -> Answer<Bound<'py, PyAny>> {
        let kind =
            FieldKind::from_name(name).ok_or_else(|| Failure::file(format!("there is no field '{name}'")))?;
        let (reader, at) = (self.unchanged()?, At::Index(index));
        Ok(match kind {
            FieldKind::Contact => detached(py, || reader.contact(at))??.into_pyarray(py).into_any(),
            kind => detached(py, || reader.field(kind, at))??.into_pyarray(py).into_any(),
        })
    }

    fn initial_gap<'py>(&self, py: Python<'py>) -> Answer<Map<'py>> {
        let reader = self.unchanged()?;
        Ok(detached(py, || reader.initial_gap())??.into_pyarray(py))
    }

    /// The stress below the surface, where it was computed: depth, and by name what each instant of the fields has, NaN where it
    /// was not computed; numbers have one dimension, profiles over depth two.
    fn stress<'py>(&self, py: Python<'py>) -> Answer<Option<Dict<'py>>> {
        let Some(set) = self.reader.stress() else { return Ok(None) };
        let out = PyDict::new(py);
        out.set_item("depth", set.depths.clone().into_pyarray(py))?;
        for series in set.scalars() {
            let numbers = self.reader.stress_series(series.name)?;
            out.set_item(series.name, numbers.into_pyarray(py))?;
        }
        for series in set.profiles() {
            let profile = self.reader.stress_profile(series.name)?;
            out.set_item(series.name, profile.into_pyarray(py))?;
        }
        Ok(Some(out))
    }

    /// Names of the stress fields.
    #[getter]
    fn stress_fields(&self) -> Vec<&'static str> {
        let fields = self.reader.stress().map(|set| set.fields()).unwrap_or_default();
        fields.into_iter().map(|(_, series)| series.name).collect()
    }

    /// A stress field of the instant of number `index` at the depth of number `depth`.
    fn stress_field<'py>(&self, py: Python<'py>, name: &str, index: usize, depth: usize) -> Answer<Map<'py>> {
        let fields = self.reader.stress().map(|set| set.fields()).unwrap_or_default();
        let found = fields.into_iter().find(|(_, series)| series.name == name);
        let (quantity, _) =
            found.ok_or_else(|| Failure::file(format!("there is no stress field '{name}'")))?;
        let reader = self.unchanged()?;
        let read = || reader.stress_field(quantity, At::Index(index), depth);
        Ok(detached(py, read)??.into_pyarray(py))
    }

    /// Whether the pressure of the fluid is stored with the leaks.
    #[getter]
    fn has_fluid_pressure(&self) -> bool {
        self.reader.leaks().is_some_and(|leaks| leaks.has_pressure())
    }

    #[getter]
    fn field_steps(&self) -> Vec<usize> {
        self.reader.field_steps().to_vec()
    }

    #[getter]
    fn field_times(&self) -> Vec<f64> {
        self.reader.field_times().to_vec()
    }

    #[getter]
    fn fields(&self) -> Vec<&'static str> {
        self.reader.header().fields.iter().map(|kind| kind.name()).collect()
    }

    #[getter]
    fn cells(&self) -> Vec<usize> {
        let grid = &self.reader.header().grid;
        grid.cells()[..grid.dimensions()].to_vec()
    }

    #[getter]
    fn size(&self) -> Vec<f64> {
        self.reader.header().grid.extents().to_vec()
    }

    /// Leaks over time by name, where they are stored; `conductance` as xx, xy, yx, yy of each time.
    fn leaks<'py>(&self, py: Python<'py>) -> Answer<HashMap<&'static str, Numbers<'py>>> {
        let Some(leaks) = self.reader.leaks() else { return Ok(HashMap::new()) };
        let mut names: Vec<_> = leaks.series().into_iter().map(|series| series.name).collect();
        names.extend(self.reader.leak("conductance").is_ok().then_some("conductance"));
        let read = |name| Ok((name, self.reader.leak(name)?.into_pyarray(py)));
        names.into_iter().map(read).collect()
    }

    /// Pressure of the fluid at a leak, by its number.
    fn fluid_pressure<'py>(&self, py: Python<'py>, index: usize) -> Answer<Map<'py>> {
        let reader = self.unchanged()?;
        Ok(detached(py, || reader.fluid_pressure(index))??.into_pyarray(py))
    }

    /// The attributes of the group, as JSON.
    #[getter]
    fn attributes(&self) -> String {
        serde_json::Value::Object(self.reader.attributes()).to_string()
    }
}

/// Computes the stress and the leaks of the result at `source` again in its copy.
#[pyfunction]
pub fn derive_again(py: Python<'_>, source: PathBuf, copy: PathBuf) -> Answer<()> {
    let never = AtomicBool::new(false);
    detached(py, || {
        let reader = Reader::open(&source)?;
        if let Some(set) = reader.stress() {
            let mut writer = Writer::amend(&copy)?;
            let plan = StressPlan::of(set, &reader);
            stress::evaluate(&mut writer, &plan, &never, |_, _| {})?;
        }
        if let Some(leak) = reader.leaks().and_then(|_| leakage::settings(&reader)) {
            let beside = leakage::Beside::of_result(&reader)?;
            leakage::store(&copy, &leak, beside, &never, |_, _| {})?;
        }
        Ok(())
    })?
}

/// How a run ended.
pub fn status_of(word: &str) -> Status {
    match word {
        "complete" => Status::Complete,
        "interrupted" => Status::Interrupted,
        _ => Status::Failed,
    }
}

/// A row of numbers by their names: the inverse of [`crate::march::fill`].
pub fn row_of(numbers: &Dict<'_>, axis: asperity::Axis) -> Answer<Row> {
    let mut row = Row { coordinate: axis.at(0.0), ..Row::default() };
    for scalar in SCALARS {
        let found = numbers.get_item(scalar.name)?;
        let found = found.ok_or_else(|| Failure::case(format!("the row has no '{}'", scalar.name)))?;
        scalar.set(&mut row, found.extract()?);
    }
    Ok(row)
}
