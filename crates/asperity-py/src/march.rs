//! A march, row by row.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use asperity::finding::{Diagnostics, Finding, Known};
use asperity::{Drive, drive, process, step};
use asperity_io::case::{Case, CaseErrors, given};
use asperity_io::session;
use asperity_io::store::{FieldKind, SCALARS};
use ndarray::Array2;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{self, Answer, Failure};
use crate::given::{Dict, Plane, choose, table};
use crate::wait::{detached, without_python};

/// The march of one simulation, or its sweep over velocities.
#[pyclass]
pub struct March {
    /// Locked where threads of Python share it.
    march: Mutex<Box<dyn Drive>>,
    diagnostics: Diagnostics,
    /// What was found before the run.
    found: Vec<Finding>,
    setup: String,
    /// The numbers of the last row.
    last: Option<step::Row>,
    /// Whether the state is that of the last row.
    settled: bool,
    interrupt: Arc<AtomicBool>,
}

#[pymethods]
impl March {
    /// Of the keys of a case and the arrays that they name; times of `include` are steps besides.
    #[new]
    fn new(
        py: Python<'_>,
        keys: Dict<'_>,
        arrays: BTreeMap<String, Plane<'_>>,
        include: Vec<f64>,
    ) -> Answer<March> {
        let keys = table(&keys)?;
        let arrays = arrays.into_iter().map(|(name, array)| (name, array.as_array().to_owned())).collect();
        let interrupt = Arc::new(AtomicBool::new(false));
        let made = without_python(py, &interrupt, || -> Result<_, CaseErrors> {
            let mut case = Case::given(&keys, &arrays, Path::new(""))?;
            case.conditions.include = include;
            let parts = case.parts()?;
            let simulation = case.simulation_of(&parts)?;
            let setup = serde_json::Value::Object(session::setup(&case, &simulation)).to_string();
            let steady = case.steady_of(&parts, &simulation)?;
            // An array does not tell what it is made of.
            let known = Known {
                parts: &[],
                bodies: &case.bodies,
                thickness: case.thickness,
                mirrored: case.is_mirrored(),
            };
            let diagnostics = Diagnostics::new(&simulation, known);
            let found = case.findings;
            drop(parts);
            let drive = match drive::of(simulation, steady) {
                Ok(drive) => drive,
                Err(source) => return Ok(Err(source)),
            };
            let diagnostics = match drive.streaming() {
                Some(streaming) => diagnostics.of_sweep(streaming.clone()),
                None => diagnostics,
            };
            Ok(Ok((drive, diagnostics, found, setup)))
        })?;
        let (mut march, diagnostics, found, setup) = made.map_err(error::given)??;
        march.interrupt_with(interrupt.clone());
        let march = Mutex::new(march);
        Ok(March { march, diagnostics, found, setup, last: None, settled: false, interrupt })
    }

    /// Goes on by one row; False at the end.
    fn advance(&mut self, py: Python<'_>) -> Answer<bool> {
        self.interrupt.store(false, Ordering::Relaxed);
        let march = self.march.get_mut().unwrap_or_else(PoisonError::into_inner);
        let (diagnostics, last, settled) = (&mut self.diagnostics, &mut self.last, &mut self.settled);
        let done = without_python(py, &self.interrupt, || -> asperity::Result<bool> {
            let before = std::mem::replace(settled, false);
            let step = march.advance()?;
            *settled = before || step.is_some();
            let Some(step) = step else { return Ok(false) };
            let row = step.row();
            diagnostics.see(&step, &row);
            *last = Some(row);
            Ok(true)
        })?;
        done.map_err(|error| {
            Failure::from(error).with_best(py, || {
                let (best, march) = (PyDict::new(py), &mut *march);
                let last = move || march.last().map(|step| (step.row(), step.pressure().to_owned()));
                let Some((row, pressure)) = detached(py, last)? else { return Ok(py.None().into_bound(py)) };
                fill(&best, &row)?;
                best.set_item("pressure", pressure.into_pyarray(py))?;
                Ok(best.into_any())
            })
        })
    }

    /// From the last row on this is prescribed: the keys of a stage.
    fn prescribe(&mut self, keys: Dict<'_>) -> Answer<()> {
        let keys = table(&keys)?;
        let march = self.march.get_mut().unwrap_or_else(PoisonError::into_inner);
        let stage = given::prescribed(keys, march.simulation()).map_err(error::alone)?;
        Ok(march.prescribe(stage)?)
    }

    /// The run in numbers, as JSON: the attribute `setup` of its result.
    #[getter]
    fn setup(&self) -> &str {
        &self.setup
    }

    /// The quantities of each row: name and ends of its bins, none for a single number.
    fn columns(&self) -> Vec<(&'static str, Vec<f64>)> {
        let march = self.locked();
        let columns = march.simulation().columns().unwrap_or_default();
        columns.into_iter().map(|column| (column.quantity.name(), column.edges)).collect()
    }

    /// What was found so far, as a JSON list.
    fn findings(&self) -> String {
        let march = self.locked();
        let of_run = self.diagnostics.findings(march.simulation());
        asperity_io::finding::list(&[self.found.clone(), of_run].concat()).to_string()
    }

    /// Rows in all.
    fn __len__(&self) -> usize {
        let march = self.locked();
        march.rows_expected().unwrap_or(march.done())
    }

    /// Rows in all, where they are known beforehand.
    #[getter]
    fn rows_expected(&self) -> Option<usize> {
        self.locked().rows_expected()
    }

    /// Whether the last row is done.
    #[getter]
    fn finished(&self) -> bool {
        self.locked().finished()
    }

    /// Whether the fields are those of the last row, and not those of a step that was interrupted or did not converge.
    #[getter]
    fn settled(&self) -> bool {
        self.settled
    }

    /// Rows done.
    #[getter]
    fn done(&self) -> usize {
        self.locked().done()
    }

    /// Times of all rows, as far as they are known beforehand; of a sweep its velocities.
    fn times(&self) -> Vec<f64> {
        self.locked().planned()
    }

    /// The numbers of the last row.
    fn row<'py>(&self, py: Python<'py>) -> Answer<Dict<'py>> {
        let out = PyDict::new(py);
        let last = detached(py, || {
            let march = self.locked();
            let step = march.last()?;
            let numbers = step.columns().iter().map(|column| {
                let numbers = step.quantity(column.quantity).map(<[f64]>::to_vec);
                (column.quantity.name(), numbers.unwrap_or_default())
            });
            Some((self.last.unwrap_or_else(|| step.row()), numbers.collect::<Vec<_>>()))
        })?;
        if let Some((row, quantities)) = last {
            fill(&out, &row)?;
            for (name, numbers) in quantities {
                match numbers[..] {
                    [number] => out.set_item(name, number)?,
                    _ => out.set_item(name, numbers.into_pyarray(py))?,
                }
            }
        }
        Ok(out)
    }

    /// A field of the last row, by its name in results.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> Answer<Bound<'py, PyAny>> {
        let kind: FieldKind = choose("field", name)?;
        let found = detached(py, || {
            let march = self.locked();
            let step = march.last()?;
            let (grid, boundary) = (march.simulation().grid, march.simulation().boundary);
            // Of a contact that moves, in its frame.
            let shift = kind.shift(&step);
            Some(match kind {
                FieldKind::Contact => {
                    let mut states = Array2::zeros(grid.shape());
                    step.contact_into(&mut states);
                    Field::Contact(process::in_contact_frame(states.view(), boundary, shift, 0))
                }
                kind => {
                    let mut field = Array2::zeros(grid.shape());
                    kind.of_step(&step, &mut field);
                    Field::Real(process::in_contact_frame(field.view(), boundary, shift, kind.beyond()))
                }
            })
        })?;
        match found {
            Some(Field::Real(field)) => Ok(field.into_pyarray(py).into_any()),
            Some(Field::Contact(states)) => Ok(states.into_pyarray(py).into_any()),
            None => Err(Failure::case("there is no row yet: advance first")),
        }
    }
}

/// A field on its way to Python.
enum Field {
    Real(Array2<f64>),
    Contact(Array2<u8>),
}

impl March {
    fn locked(&self) -> MutexGuard<'_, Box<dyn Drive>> {
        self.march.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The numbers of a row by their names in results.
pub fn fill(into: &Dict<'_>, row: &step::Row) -> Answer<()> {
    for scalar in SCALARS {
        match scalar.is_count() {
            true => into.set_item(scalar.name, scalar.of(row) as u64)?,
            false => into.set_item(scalar.name, scalar.of(row))?,
        }
    }
    Ok(())
}
