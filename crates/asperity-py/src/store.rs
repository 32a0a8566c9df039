//! Stored results.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use asperity::quantities::Column;
use asperity_io::leakage;
use asperity_io::store::{At, Field, FieldKind, Header, Outcome, Reader, Row, SCALARS, Status, Writer};
use asperity_io::stress::{self, StressPlan};
use ndarray::{ArrayView3, Axis};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, file};
use crate::march::{choose, grid_of};
use crate::wait::detached;

/// The ends of the bins, and the numbers of all rows.
type Histogram<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>);

/// A result on disk, read as it is asked for.
#[pyclass(frozen)]
pub struct Store {
    reader: Reader,
    /// The directory that was opened.
    #[cfg(unix)]
    directory: std::fs::File,
}

impl Store {
    /// The reader, unless another result stands in the place of the one that was opened: rows of one and fields of the other would
    /// be mixed.
    fn unchanged(&self) -> PyResult<&Reader> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            let path = self.reader.path();
            let (opened, here) = (self.directory.metadata().map_err(file)?, std::fs::metadata(path));
            if !here.is_ok_and(|here| (here.dev(), here.ino()) == (opened.dev(), opened.ino())) {
                let path = path.display();
                return Err(file(format!(
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
    fn new(path: PathBuf) -> PyResult<Store> {
        let reader = Reader::open(&path).map_err(file)?;
        Ok(Store {
            #[cfg(unix)]
            directory: std::fs::File::open(&path).map_err(file)?,
            reader,
        })
    }

    /// A number of every row.
    fn series<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.reader.series(name).map_err(file)?.into_pyarray(py))
    }

    /// Names of the quantities that were asked for.
    #[getter]
    fn quantities(&self) -> Vec<&'static str> {
        self.reader.header().quantities.iter().map(|column| column.quantity.name()).collect()
    }

    /// A histogram: the ends of its bins, and its rows.
    fn histogram<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Histogram<'py>> {
        let (edges, rows) = self.reader.histogram(choose("quantity", name)?).map_err(file)?;
        Ok((edges.into_pyarray(py), rows.into_pyarray(py)))
    }

    /// A field at a stored instant, by its number.
    fn field<'py>(&self, py: Python<'py>, name: &str, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let kind = FieldKind::from_name(name).ok_or_else(|| file(format!("there is no field '{name}'")))?;
        let (reader, at) = (self.unchanged()?, At::Index(index));
        Ok(match kind {
            FieldKind::Contact => {
                detached(py, || reader.contact(at))?.map_err(file)?.into_pyarray(py).into_any()
            }
            kind => detached(py, || reader.field(kind, at))?.map_err(file)?.into_pyarray(py).into_any(),
        })
    }

    fn initial_gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let reader = self.unchanged()?;
        Ok(detached(py, || reader.initial_gap())?.map_err(file)?.into_pyarray(py))
    }

    /// The stress below the surface, where it was computed: depth, and by name what each instant of the fields has, NaN where it
    /// was not computed; numbers have one dimension, profiles over depth two.
    fn stress<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(set) = self.reader.stress() else { return Ok(None) };
        let out = PyDict::new(py);
        out.set_item("depth", set.depths.clone().into_pyarray(py))?;
        for series in set.scalars() {
            let numbers = self.reader.stress_series(series.name).map_err(file)?;
            out.set_item(series.name, numbers.into_pyarray(py))?;
        }
        for series in set.profiles() {
            let profile = self.reader.stress_profile(series.name).map_err(file)?;
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
    fn stress_field<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        index: usize,
        depth: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let fields = self.reader.stress().map(|set| set.fields()).unwrap_or_default();
        let found = fields.into_iter().find(|(_, series)| series.name == name);
        let (quantity, _) = found.ok_or_else(|| file(format!("there is no stress field '{name}'")))?;
        let reader = self.unchanged()?;
        let read = || reader.stress_field(quantity, At::Index(index), depth);
        Ok(detached(py, read)?.map_err(file)?.into_pyarray(py))
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
    fn leaks<'py>(&self, py: Python<'py>) -> PyResult<HashMap<&'static str, Bound<'py, PyArray1<f64>>>> {
        let Some(leaks) = self.reader.leaks() else { return Ok(HashMap::new()) };
        let mut names: Vec<_> = leaks.series().into_iter().map(|series| series.name).collect();
        names.extend(self.reader.leak("conductance").is_ok().then_some("conductance"));
        let read = |name| Ok((name, self.reader.leak(name).map_err(file)?.into_pyarray(py)));
        names.into_iter().map(read).collect()
    }

    /// Pressure of the fluid at a leak, by its number.
    fn fluid_pressure<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let reader = self.unchanged()?;
        Ok(detached(py, || reader.fluid_pressure(index))?.map_err(file)?.into_pyarray(py))
    }

    /// The attributes of the group, as JSON.
    #[getter]
    fn attributes(&self) -> String {
        serde_json::Value::Object(self.reader.attributes()).to_string()
    }
}

/// A stack of fields, (kept instants, nx, ny), as Python holds it.
enum Held<'py> {
    Real(FieldKind, PyReadonlyArray3<'py, f64>),
    Contact(PyReadonlyArray3<'py, u8>),
}

/// The same without Python.
#[derive(Clone, Copy)]
enum Stack<'a> {
    Real(FieldKind, ArrayView3<'a, f64>),
    Contact(ArrayView3<'a, u8>),
}

impl<'a> Stack<'a> {
    /// The field of the kept instant number `k`.
    fn field(self, k: usize) -> Field<'a> {
        let at = Axis(0);
        match self {
            Stack::Real(FieldKind::Gap, maps) => Field::Gap(maps.index_axis_move(at, k)),
            Stack::Real(FieldKind::Displacement, maps) => Field::Displacement(maps.index_axis_move(at, k)),
            Stack::Real(FieldKind::Flattening, maps) => Field::Flattening(maps.index_axis_move(at, k)),
            Stack::Real(_, maps) => Field::Pressure(maps.index_axis_move(at, k)),
            Stack::Contact(maps) => Field::Contact(maps.index_axis_move(at, k)),
        }
    }

    fn kind(&self) -> FieldKind {
        match self {
            Stack::Real(kind, _) => *kind,
            Stack::Contact(_) => FieldKind::Contact,
        }
    }

    fn dim(&self) -> (usize, usize, usize) {
        match self {
            Stack::Real(_, maps) => maps.dim(),
            Stack::Contact(maps) => maps.dim(),
        }
    }
}

/// A quantity: its name, the ends of its bins (none for a single number), and its rows.
type Asked<'py> = (String, PyReadonlyArray1<'py, f64>, PyReadonlyArray2<'py, f64>);

/// Writes a result that was in memory. `columns` are the numbers of all rows by their names, `fields` the stacks of
/// the rows `field_steps`; `setup` is JSON that says what was solved, `findings` a JSON list, `status` how the run ended.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn save(
    py: Python<'_>,
    path: PathBuf,
    force: bool,
    title: String,
    setup: &str,
    size: Vec<f64>,
    initial_gap: PyReadonlyArray2<'_, f64>,
    columns: HashMap<String, PyReadonlyArray1<'_, f64>>,
    fields: Vec<(String, Bound<'_, PyAny>)>,
    field_steps: Vec<usize>,
    field_times: Vec<f64>,
    quantities: Vec<Asked<'_>>,
    findings: &str,
    status: &str,
) -> PyResult<()> {
    let status = status_of(status);
    let (nx, ny) = initial_gap.as_array().dim();
    let grid = grid_of(py, (nx, ny), &size)?;
    let setup = serde_json::from_str(setup).map_err(|error| CaseError::new_err(error.to_string()))?;
    let findings = serde_json::from_str(findings).map_err(|error| CaseError::new_err(error.to_string()))?;
    let findings = asperity_io::finding::from_list(&findings);
    let mut header = Header {
        title,
        case_text: String::new(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        grid,
        fields: vec![],
        quantities: vec![],
        rows_expected: None,
        setup,
    };
    let rows = rows(&columns, header.axis())?;
    let mut held = Vec::new();
    for (name, stack) in &fields {
        let kind = FieldKind::from_name(name)
            .ok_or_else(|| CaseError::new_err(format!("there is no field '{name}' in results")))?;
        held.push(match kind {
            FieldKind::Contact => Held::Contact(stack.extract()?),
            kind => Held::Real(kind, stack.extract()?),
        });
    }
    let stacks = held.iter().map(|held| match held {
        Held::Real(kind, stack) => Stack::Real(*kind, stack.as_array()),
        Held::Contact(stack) => Stack::Contact(stack.as_array()),
    });
    let stacks: Vec<Stack> = stacks.collect();
    if let Some(stack) = stacks.iter().find(|stack| stack.dim() != (field_steps.len(), nx, ny)) {
        let expected = format!("({}, {nx}, {ny})", field_steps.len());
        let (kind, found) = (stack.kind(), stack.dim());
        return Err(CaseError::new_err(format!(
            "the field '{kind}' has shape {found:?}, but must have {expected}"
        )));
    }
    let mut asked = Vec::new();
    for (name, edges, values) in &quantities {
        let column = Column { quantity: choose("quantity", name)?, edges: edges.as_array().to_vec() };
        let (found, width) = (values.as_array().dim(), column.width());
        if found != (rows.len(), width) {
            let expected = format!("({}, {width})", rows.len());
            return Err(CaseError::new_err(format!(
                "'{name}' has shape {found:?}, but must have {expected}"
            )));
        }
        asked.push(column);
    }
    let numbers: Vec<_> = quantities.iter().map(|(_, _, values)| values.as_array()).collect();
    header.fields = stacks.iter().map(Stack::kind).collect();
    header.quantities = asked;
    header.rows_expected = Some(rows.len());
    if field_times.len() != field_steps.len() {
        return Err(CaseError::new_err("the number of times must equal the number of rows of the fields"));
    }
    let gap = initial_gap.as_array();
    detached(py, || {
        let mut writer = Writer::create(&path, &header, gap, force)?;
        for (n, row) in rows.iter().enumerate() {
            let mut fields: Vec<Field> = vec![];
            for (k, time) in field_times.iter().enumerate().filter(|(k, _)| field_steps[*k] == n) {
                let maps: Vec<Field> = stacks.iter().map(|stack| stack.field(k)).collect();
                // A state between the row before and this one has a time of its own.
                if *time < row.coordinate.value() {
                    writer.stage(*time, &maps)?;
                } else {
                    fields = maps;
                }
            }
            let numbers: Vec<f64> = numbers.iter().flat_map(|values| values.row(n).to_vec()).collect();
            writer.append_with(row, &numbers, &fields)?;
        }
        writer.set_findings(findings);
        writer.finish(&Outcome::new(status))
    })?
    .map(drop)
    .map_err(file)
}

/// Computes the stress and the leaks of the result at `source` again in its copy.
#[pyfunction]
pub fn derive_again(py: Python<'_>, source: PathBuf, copy: PathBuf) -> PyResult<()> {
    let never = AtomicBool::new(false);
    let derived = || -> Result<(), String> {
        let told = |error: &dyn std::fmt::Display| error.to_string();
        let reader = Reader::open(&source).map_err(|error| told(&error))?;
        if let Some(set) = reader.stress() {
            let mut writer = Writer::amend(&copy).map_err(|error| told(&error))?;
            let plan = StressPlan::of(set, &reader);
            stress::evaluate(&mut writer, &plan, &never, |_, _| {}).map_err(|error| told(&error))?;
        }
        if let Some(leak) = reader.leaks().and_then(|_| leakage::settings(&reader)) {
            leakage::store(&copy, &leak, &never, |_, _| {}).map_err(|error| told(&error))?;
        }
        Ok(())
    };
    detached(py, derived)?.map_err(file)
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
pub fn row_of(numbers: &Bound<'_, PyDict>, axis: asperity::Axis) -> PyResult<Row> {
    let mut row = Row { coordinate: axis.at(0.0), ..Row::default() };
    for scalar in SCALARS {
        let found = numbers.get_item(scalar.name)?;
        let found = found.ok_or_else(|| CaseError::new_err(format!("the row has no '{}'", scalar.name)))?;
        scalar.set(&mut row, found.extract()?);
    }
    Ok(row)
}

/// The rows of columns of equal length: the inverse of [`crate::march::fill`].
fn rows(columns: &HashMap<String, PyReadonlyArray1<'_, f64>>, axis: asperity::Axis) -> PyResult<Vec<Row>> {
    let mut rows: Option<Vec<Row>> = None;
    for scalar in SCALARS {
        let name = scalar.name;
        let column = columns
            .get(name)
            .ok_or_else(|| CaseError::new_err(format!("the result has no column '{name}'")))?
            .as_array();
        let (found, template) = (column.len(), Row { coordinate: axis.at(0.0), ..Row::default() });
        let rows = rows.get_or_insert_with(|| vec![template; found]);
        if found != rows.len() {
            let length = rows.len();
            return Err(CaseError::new_err(format!("'{name}' has {found} rows, but time has {length}")));
        }
        rows.iter_mut().zip(column).for_each(|(row, value)| scalar.set(row, *value));
    }
    Ok(rows.unwrap_or_default())
}
