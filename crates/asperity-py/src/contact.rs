//! Elastic contacts of one surface, one after the other.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use asperity::drive::Elastic as Contacts;
use asperity::finding::{Diagnostics, Known};
use asperity::kernel::{HalfSpace, Kernel};
use asperity::material::Creep;
use asperity::quantities::ContactStiffness;
use asperity::step::Row;
use asperity::{Boundary, Control, Drive, Simulation, Solver};
use ndarray::{Array2, ArrayView2};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::{Dict, Plane, choose, grid_of, memory};
use crate::kernel::Table;
use crate::march::fill;
use crate::trace::{Iteration, traced};
use crate::wait::without_python;

/// The contact of one surface: what is planned and set once, for any number of loads.
#[pyclass(frozen)]
pub struct Elastic {
    /// Locked where threads of Python share it.
    planned: Mutex<Planned>,
    shape: (usize, usize),
    is_free_line: bool,
}

struct Planned {
    contacts: Contacts,
    /// Whether the body is the half-space: what findings are about.
    half_space: bool,
    stiffness: Option<ContactStiffness>,
}

/// A solution: the numbers of its row, pressure and displacement, findings as a JSON list, and the iterations if they were asked for.
struct Solution {
    row: Row,
    pressure: Array2<f64>,
    displacement: Array2<f64>,
    findings: String,
    iterations: Vec<Iteration>,
}

#[pymethods]
impl Elastic {
    #[new]
    #[pyo3(signature = (*, gap, size, contact_modulus, hardness, hardness_map, boundary, method, tolerance, max_iterations, kernel))]
    fn new(
        py: Python<'_>,
        gap: Plane<'_>,
        size: Vec<f64>,
        contact_modulus: f64,
        hardness: f64,
        hardness_map: Option<Plane<'_>>,
        boundary: &str,
        method: &str,
        tolerance: f64,
        max_iterations: usize,
        kernel: Option<Plane<'_>>,
    ) -> Answer<Elastic> {
        let gap = gap.as_array().as_standard_layout().into_owned();
        let grid = grid_of(gap.dim(), &size)?;
        let boundary: Boundary = choose("boundary", boundary)?;
        if grid.is_line() && boundary == Boundary::Free && grid.len() < 2 {
            return Err(Failure::case(FREE_LINE));
        }
        if !(contact_modulus.is_finite() && contact_modulus > 0.0) {
            let expected = "finite and greater than 0 Pa";
            return Err(Failure::case(format!(
                "contact modulus is {contact_modulus}, but must be {expected}"
            )));
        }
        let hardness_map = hardness_map.map(|map| map.as_array().as_standard_layout().into_owned());
        let options =
            asperity::SolverOptions { method: choose("method", method)?, tolerance, max_iterations };
        let kernel = kernel.map(|values| Table::new(grid, boundary, values.as_array().to_owned()));
        let kernel = kernel.transpose()?;
        let half_space = kernel.is_none();
        let kernel: Arc<dyn Kernel> = match kernel {
            None => Arc::new(HalfSpace),
            Some(table) => Arc::new(table),
        };
        let bytes =
            asperity::operator::bytes(&grid, boundary) + Solver::bytes(options.method, &grid, boundary);
        memory(&grid, bytes)?;
        let planned = without_python(py, &AtomicBool::new(false), || -> asperity::Result<_> {
            let creep = Creep::elastic(1.0 / contact_modulus);
            let simulation = Simulation {
                boundary,
                kernel,
                creep,
                hardness,
                hardness_map,
                solver: options,
                ..Simulation::new(grid, gap)
            };
            Ok(Planned { contacts: Contacts::new(simulation, [])?, half_space, stiffness: None })
        })?;
        let planned = Mutex::new(planned?);
        let is_free_line = grid.is_line() && boundary == Boundary::Free;
        Ok(Elastic { planned, shape: grid.shape(), is_free_line })
    }

    /// The contact under a load \[N\] or an approach \[m\], starting from a pressure; the numbers of its row by their names, and the
    /// fields; with `history` its iterations.
    fn solve<'py>(
        &self,
        py: Python<'py>,
        control: &str,
        value: f64,
        start: Option<Plane<'_>>,
        history: bool,
    ) -> Answer<Dict<'py>> {
        let start: Option<Vec<f64>> = start.map(|pressure| pressure.as_array().iter().copied().collect());
        let control = choose("control", control)?;
        if control == Control::Approach && self.is_free_line {
            return Err(Failure::case(FREE_LINE));
        }
        let shape = self.shape;
        if start.as_ref().is_some_and(|start| start.len() != shape.0 * shape.1) {
            return Err(Failure::case(format!("the start needs a pressure of shape {shape:?}")));
        }
        let interrupt = Arc::new(AtomicBool::new(false));
        let solved = without_python(py, &interrupt, || {
            let mut planned = self.planned.lock().unwrap_or_else(PoisonError::into_inner);
            planned.solve((control, value), start, history, interrupt.clone())
        })?;
        let Solution { row, pressure, displacement, findings, iterations } = match solved {
            Ok(solution) => solution,
            Err(failed) => {
                let (error, best) = *failed;
                return Err(Failure::from(error).with_best(py, || Ok(best.into_pyarray(py).into_any())));
            }
        };
        let out = PyDict::new(py);
        fill(&out, &row)?;
        out.set_item("pressure", pressure.into_pyarray(py))?;
        out.set_item("displacement", displacement.into_pyarray(py))?;
        out.set_item("findings", findings)?;
        let entry = |one: Iteration| (one.number, one.residual, one.working, one.step, one.convolutions);
        out.set_item("history", iterations.into_iter().map(entry).collect::<Vec<_>>())?;
        Ok(out)
    }

    /// dW/dw \[N/m\] of the contact that has this pressure.
    fn stiffness(&self, py: Python<'_>, pressure: Plane<'_>) -> Answer<f64> {
        let pressure: Vec<f64> = pressure.as_array().iter().copied().collect();
        let interrupt = AtomicBool::new(false);
        let found = without_python(py, &interrupt, || {
            self.planned.lock().unwrap_or_else(PoisonError::into_inner).stiffness(&pressure, &interrupt)
        })?;
        Ok(found?)
    }
}

const FREE_LINE: &str = "a free line contact needs two cells at least, and a load: under a load on a line a half-space moves endlessly, \
                         so the approach is known up to a constant; boundary=\"periodic\" has no such limit";

impl Planned {
    fn solve(
        &mut self,
        (control, value): (Control, f64),
        start: Option<Vec<f64>>,
        history: bool,
        interrupt: Arc<AtomicBool>,
    ) -> Result<Solution, Box<(asperity::Error, Array2<f64>)>> {
        let contacts = &mut self.contacts;
        let grid = contacts.simulation().grid;
        contacts.interrupt_with(interrupt);
        contacts.ask(control, value, &start.unwrap_or_else(|| vec![0.0; grid.len()]));
        let mut solve = || contacts.advance().map(|_| ());
        let (solved, mut iterations) = if history { traced(solve) } else { (solve(), vec![]) };
        let mut displacement = Array2::zeros(grid.shape());
        let step = contacts.last();
        let pressure = step.map_or(displacement.clone(), |step| step.pressure().to_owned());
        let row = match (solved, step) {
            (Ok(()), Some(step)) => {
                step.displacement_into(&mut displacement);
                step.row()
            }
            (Ok(()), None) => Row::default(),
            (Err(error), _) => return Err(Box::new((error, pressure))),
        };
        if history {
            iterations.push(last(&row, &iterations));
        }
        let findings = match self.half_space {
            true => judged(contacts.simulation(), control, &row, pressure.view()),
            false => "[]".into(),
        };
        Ok(Solution { row, pressure, displacement, findings, iterations })
    }

    fn stiffness(&mut self, pressure: &[f64], interrupt: &AtomicBool) -> asperity::Result<f64> {
        let Planned { contacts, stiffness, .. } = self;
        let simulation = contacts.simulation();
        let (compliance, all) = (simulation.creep.instantaneous, simulation.hardness);
        let hardness = simulation.hardness_map.as_ref().map(|map| map.iter().copied().collect::<Vec<f64>>());
        let below = |n: usize| pressure[n] < hardness.as_ref().map_or(all, |map| map[n]);
        let bears = |n: usize| pressure[n] > 0.0 && below(n);
        let operator = contacts.operator();
        let solver = stiffness.get_or_insert_with(|| ContactStiffness::new(operator));
        Ok(solver.of(operator, compliance, bears, Some(interrupt))?.0)
    }
}

/// The state at the end as one more entry of the history.
fn last(row: &Row, iterations: &[Iteration]) -> Iteration {
    Iteration {
        number: row.iterations as u64,
        residual: row.residual,
        working: iterations.last().map_or(0.0, |before| before.working),
        step: "converged".into(),
        convolutions: row.convolutions as u64,
    }
}

/// What is to be said of a contact, as a JSON list.
fn judged(simulation: &Simulation, control: Control, row: &Row, pressure: ArrayView2<'_, f64>) -> String {
    let mut diagnostics = Diagnostics::new(simulation, Known::default());
    diagnostics.see_contact(0, row, pressure, control, simulation.creep.instantaneous);
    asperity_io::finding::list(&diagnostics.findings(simulation)).to_string()
}

/// The number of the spot of each cell with pressure, 1 for the largest, 0 elsewhere.
#[pyfunction]
pub fn spot_labels<'py>(
    py: Python<'py>,
    pressure: Plane<'_>,
    boundary: &str,
) -> Answer<Bound<'py, numpy::PyArray2<u32>>> {
    let boundary = choose("boundary", boundary)?;
    let pressure = pressure.as_array();
    let labels = crate::wait::detached(py, || asperity::spots::labels(boundary, pressure, |p| *p > 0.0))?;
    Ok(labels.into_pyarray(py))
}
