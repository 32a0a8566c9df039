//! A march, row by row.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use asperity::finding::{Diagnostics, Known};
use asperity::quantities::{Quantities, Quantity};
use asperity::sliding::{Direction, MovingGap, Path, SteadyMotion};
use asperity::surface::Part;
use asperity::{
    Boundary, Course, Drive, Event, Grid, History, Programme, Simulation, SolverOptions, Stage, TimeGrid,
    drive, material, process, step,
};
use asperity_io::choice::{self, Choice};
use asperity_io::resources;
use asperity_io::store::{FieldKind, SCALARS};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, raised};
use crate::material::{Body, Pair};
use crate::wait::{detached, without_python};

/// The march of one simulation, or its sweep over velocities.
#[pyclass]
pub struct March {
    /// Locked where threads of Python share it.
    march: Mutex<Box<dyn Drive>>,
    diagnostics: Diagnostics,
    /// The numbers of the last row.
    last: Option<step::Row>,
    /// Whether the state is that of the last row.
    settled: bool,
    interrupt: Arc<AtomicBool>,
}

/// The choice that a keyword names, or an error with the words that it takes.
pub fn choose<T: Choice>(what: &str, word: &str) -> PyResult<T> {
    choice::parse(word).ok_or_else(|| no_choice(what, word, choice::words::<T>()))
}

/// The choice that a keyword names, out of a list of names and values.
pub fn choose_among<T: Copy>(what: &str, word: &str, choices: &[(&str, T)]) -> PyResult<T> {
    let found = choices.iter().find(|(name, _)| *name == word);
    let names = || choices.iter().map(|(name, _)| *name).collect::<Vec<_>>();
    found.map(|(_, value)| *value).ok_or_else(|| no_choice(what, word, &names()))
}

fn no_choice(what: &str, word: &str, words: &[&str]) -> PyErr {
    let words: Vec<_> = words.iter().map(|word| format!("'{word}'")).collect();
    CaseError::new_err(format!("{what} is '{word}', but must be {}", words.join(" or ")))
}

pub fn solver(method: &str, tolerance: f64, max_iterations: usize) -> PyResult<SolverOptions> {
    let method = choose("method", method)?;
    Ok(SolverOptions { method, tolerance, max_iterations })
}

/// The grid of a field: a plane with two lengths, a line with one.
pub fn grid_of(py: Python<'_>, (nx, ny): (usize, usize), size: &[f64]) -> PyResult<Grid> {
    let grid = match *size {
        [length] if ny == 1 => Grid::line(nx, length),
        [lx, ly] => Grid::new([nx, ny], [lx, ly]),
        _ => {
            return Err(CaseError::new_err(
                "size needs two lengths, along x and y, or one for a line of cells",
            ));
        }
    };
    let grid = grid.map_err(|error| raised(py, error))?;
    // Heights, and a copy of them.
    memory(&grid, 16 * grid.len())?;
    Ok(grid)
}

/// Refuses work on a grid that takes more memory than there is.
pub fn memory(grid: &Grid, bytes: usize) -> PyResult<()> {
    let [nx, ny] = grid.cells();
    let refused = |reason: String| CaseError::new_err(format!("{reason}; take fewer cells"));
    resources::check_memory(&format!("{nx} x {ny} cells"), bytes as u64).map_err(refused)
}

/// (name, unit, meaning, whether it is a histogram) of all quantities.
#[pyfunction]
pub fn quantities() -> Vec<(&'static str, &'static str, &'static str, bool)> {
    let words = |q: Quantity| (q.name(), q.units(), q.long_name(), q.is_histogram());
    Quantity::ALL.into_iter().map(words).collect()
}

fn history(kind: &str, numbers: &[f64], points: Vec<(f64, f64)>) -> PyResult<History> {
    Ok(match (kind, numbers) {
        ("step", [value]) => History::Step { value: *value },
        ("ramp", [value, duration]) => History::Ramp { value: *value, duration: *duration },
        ("triangle", [peak, rise, fall]) => History::Triangle { peak: *peak, rise: *rise, fall: *fall },
        ("trapezoid", [peak, rise, hold, fall]) => {
            History::Trapezoid { peak: *peak, rise: *rise, hold: *hold, fall: *fall }
        }
        ("sine", [mean, amplitude, frequency]) => {
            History::Sine { mean: *mean, amplitude: *amplitude, frequency: *frequency }
        }
        ("table", []) => History::Table { points },
        _ => {
            return Err(CaseError::new_err(format!(
                "there is no history '{kind}' of {} numbers",
                numbers.len()
            )));
        }
    })
}

fn times(kind: &str, numbers: &[f64]) -> PyResult<TimeGrid> {
    // Counts come as numbers; what is no count is refused by the grid's own check.
    let count = |n: f64| if n.fract() == 0.0 && n >= 0.0 { n as usize } else { 0 };
    let grid = match (kind, numbers) {
        ("uniform", [end, steps]) => TimeGrid::Uniform { end: *end, steps: count(*steps) },
        ("log", [end, steps, first]) => {
            TimeGrid::Logarithmic { end: *end, steps: count(*steps), first: *first }
        }
        ("list", list) => TimeGrid::List(list.to_vec()),
        ("adaptive", [end, tolerance, first]) => {
            TimeGrid::Adaptive { end: *end, tolerance: *tolerance, first: *first }
        }
        _ => {
            return Err(CaseError::new_err(format!(
                "there is no time grid '{kind}' of {} numbers",
                numbers.len()
            )));
        }
    };
    // Before anything is planned on it, which takes memory for each step.
    grid.validate().map_err(|error| CaseError::new_err(error.to_string()))?;
    Ok(grid)
}

/// A list of numbers with the word that says what they are.
type Numbers = (String, Vec<f64>);
/// A stage: control, history, points of a table, duration, event with its value, whether it counts only after a jump, time grid.
type StageParts =
    (String, Numbers, Vec<(f64, f64)>, Option<f64>, Option<(String, f64)>, bool, Option<Numbers>);

/// A motion: "velocity" or "path" with a history (kind, numbers) and the points of a table, or "steady" with velocities; its start;
/// the direction ("x", "y" or "angle" with an angle in rad); cells to a step; a shear stress; whether it rolls.
type MotionParts = (String, Numbers, Vec<(f64, f64)>, f64, (String, f64), f64, Option<f64>, bool);

/// A motion in time, or steady states.
enum Moves {
    Path(Box<process::Motion>),
    Steady(SteadyMotion),
}

fn motion(
    (what, (kind, numbers), points, start, (direction, angle), cells_per_step, shear_stress, _): MotionParts,
    grid: &Grid,
    boundary: Boundary,
    gap: &ndarray::Array2<f64>,
) -> PyResult<asperity::Result<Moves>> {
    let directions = [("x", Direction::X), ("y", Direction::Y), ("angle", Direction::Angle(angle))];
    let direction = choose_among("direction", &direction, &directions)?;
    let heights = Part::Heights { name: "the surface".into(), heights: gap.mapv(|h| -h) };
    let moving = match MovingGap::new(grid, boundary, &[(heights, true)]) {
        Ok(moving) => moving,
        Err(error) => return Ok(Err(error)),
    };
    if what == "steady" {
        let slopes = moving.at(0.0, direction).map(|(_, slopes)| slopes);
        let steady = |slopes| SteadyMotion { direction, velocities: numbers, slopes, shear_stress };
        return Ok(slopes.map(|slopes| Moves::Steady(steady(slopes))));
    }
    let history = history(&kind, &numbers, points)?;
    let path = match what.as_str() {
        "path" => Path::of_position(history, start),
        _ => Path::of_velocity(history, start),
    };
    Ok(path.map(|path| {
        Moves::Path(Box::new(process::Motion { path, direction, gap: moving, cells_per_step, shear_stress }))
    }))
}

fn stage(
    (control, (kind, numbers), points, duration, until, after_jump, grid): StageParts,
) -> PyResult<Stage> {
    let course = match (kind.as_str(), numbers.as_slice()) {
        ("hold", []) => Course::Hold,
        ("ramp-to", [value, duration]) => Course::RampTo { value: *value, duration: *duration },
        _ => Course::Given(history(&kind, &numbers, points)?),
    };
    let until = match until {
        None => None,
        Some((event, value)) => {
            let events = [
                ("approach", Event::Approach(value)),
                ("load", Event::Load(value)),
                ("pressure", Event::Pressure(value)),
                ("contact-lost", Event::ContactLost),
            ];
            Some(choose_among("until", &event, &events)?)
        }
    };
    Ok(Stage {
        control: choose("control", &control)?,
        course,
        duration,
        until,
        after_jump,
        times: grid.map(|(kind, numbers)| times(&kind, &numbers)).transpose()?,
    })
}

#[pymethods]
impl March {
    #[new]
    #[pyo3(signature = (*, gap, size, boundary, bodies, stacks, stages, times, times_numbers, include, temperatures, scheme, method, tolerance,
                        max_iterations, hardness_map, plasticity, quantities, bins, largest_pressure, largest_gap, motion))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        gap: PyReadonlyArray2<'_, f64>,
        size: Vec<f64>,
        boundary: &str,
        bodies: Vec<PyRef<'_, Body>>,
        stacks: Vec<crate::material::StackParts>,
        stages: Vec<StageParts>,
        times: &str,
        times_numbers: Vec<f64>,
        include: Vec<f64>,
        temperatures: Vec<(f64, f64)>,
        scheme: &str,
        method: &str,
        tolerance: f64,
        max_iterations: usize,
        hardness_map: Option<PyReadonlyArray2<'_, f64>>,
        plasticity: &str,
        quantities: Vec<String>,
        bins: usize,
        largest_pressure: Option<f64>,
        largest_gap: Option<f64>,
        motion: Option<MotionParts>,
    ) -> PyResult<March> {
        let gap = gap.as_array().as_standard_layout().into_owned();
        if !temperatures.is_empty() && !bodies.iter().any(|body| body.is_thermal()) {
            return Err(CaseError::new_err(
                "temperature is given, but no body depends on it: none has a shift (without a temperature of its \
                 own); give a material shift=asperity.wlf(...), or leave the temperature out",
            ));
        }
        if let Some((.., false)) = &motion
            && crate::material::creeping(&bodies, &stacks) == 2
        {
            return Err(CaseError::new_err(
                "both bodies are viscoelastic and slide over each other, so one memory moves over the other: give kind=\"roll\", or \
                 make the body that slides elastic with its relaxed modulus (its memory stands still in the frame of the contact)",
            ));
        }
        let Pair { kernel, waves, creep, thermal } =
            crate::material::pair(&bodies, &stacks, &temperatures)?.map_err(|error| raised(py, error))?;
        let bodies: Vec<material::Body> = bodies.iter().map(|body| body.inner.clone()).collect();
        let grid = grid_of(py, gap.dim(), &size)?;
        let list =
            quantities.iter().map(|name| choose("quantity", name)).collect::<PyResult<Vec<Quantity>>>()?;
        let stages = stages.into_iter().map(stage).collect::<PyResult<Vec<Stage>>>()?;
        let simulation = Simulation {
            boundary: choose("boundary", boundary)?,
            kernel,
            layers: waves,
            creep,
            thermal,
            hardness: material::pair_hardness(&bodies),
            loading: Programme::new(stages),
            times: self::times(times, &times_numbers)?,
            include,
            scheme: choose("scheme", scheme)?,
            solver: solver(method, tolerance, max_iterations)?,
            hardness_map: hardness_map.map(|map| map.as_array().as_standard_layout().into_owned()),
            plasticity: choose("plasticity", plasticity)?,
            quantities: Quantities { list, bins, largest_pressure, largest_gap },
            ..Simulation::new(grid, gap)
        };
        memory(&simulation.grid, simulation.bytes())?;
        let moves =
            motion.map(|parts| self::motion(parts, &simulation.grid, simulation.boundary, &simulation.gap));
        let moves = moves.transpose()?.transpose().map_err(|error| raised(py, error))?;
        let interrupt = Arc::new(AtomicBool::new(false));
        let made = without_python(py, &interrupt, || {
            let diagnostics = Diagnostics::new(&simulation, Known { bodies: &bodies, ..Known::default() });
            let (motion, steady) = match moves {
                None => (None, None),
                Some(Moves::Path(motion)) => (Some(*motion), None),
                Some(Moves::Steady(motion)) => (None, Some(motion)),
            };
            let drive = drive::of(Simulation { motion, ..simulation }, steady)?;
            let diagnostics = match drive.streaming() {
                Some(streaming) => diagnostics.of_sweep(streaming.clone()),
                None => diagnostics,
            };
            Ok((drive, diagnostics))
        })?;
        let (mut march, diagnostics) = made.map_err(|error| raised(py, error))?;
        march.interrupt_with(interrupt.clone());
        Ok(March { march: Mutex::new(march), diagnostics, last: None, settled: false, interrupt })
    }

    /// Goes on by one row; False at the end.
    fn advance(&mut self, py: Python<'_>) -> PyResult<bool> {
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
            let raised = raised(py, error);
            if raised.is_instance_of::<crate::error::ConvergenceError>(py) {
                let march = &mut *march;
                let last = move || march.last().map(|step| (step.row(), step.pressure().to_owned()));
                if let Ok(Some((row, pressure))) = detached(py, last) {
                    let best = PyDict::new(py);
                    let filled =
                        fill(&best, &row).and_then(|()| best.set_item("pressure", pressure.into_pyarray(py)));
                    let _ = filled.and_then(|()| raised.value(py).setattr("best", best));
                }
            }
            raised
        })
    }

    /// The creep functions of the pair: (instantaneous, [(compliance, time)], fluidity) of the bodies of constant
    /// temperature, then of each on a clock of its own.
    #[allow(clippy::type_complexity)]
    fn creep(&self) -> Vec<(f64, Vec<(f64, f64)>, f64)> {
        let march = self.locked();
        let simulation = march.simulation();
        let parts =
            std::iter::once(&simulation.creep).chain(simulation.thermal.iter().map(|body| &body.creep));
        let terms = |creep: &material::Creep| {
            creep.terms.iter().map(|term| (term.compliance, term.retardation_time)).collect()
        };
        parts.map(|creep| (creep.instantaneous, terms(creep), creep.fluidity)).collect()
    }

    /// Largest relative error of the creep of the waves of layers, where they creep differently.
    fn layer_misfit(&self) -> Option<f64> {
        self.locked().simulation().layers.as_ref().map(|layers| layers.misfit())
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
        asperity_io::finding::list(&self.diagnostics.findings(march.simulation())).to_string()
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
    fn row<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let out = PyDict::new(py);
        let last = detached(py, || {
            let march = self.locked();
            let step = march.last()?;
            let columns =
                step.columns().iter().map(|column| (column.quantity.name(), column.edges.is_empty()));
            let numbers = columns.zip(step.columns()).map(|((name, single), column)| {
                (name, single, step.quantity(column.quantity).map(<[f64]>::to_vec).unwrap_or_default())
            });
            Some((self.last.unwrap_or_else(|| step.row()), numbers.collect::<Vec<_>>()))
        })?;
        if let Some((row, quantities)) = last {
            fill(&out, &row)?;
            for (name, single, numbers) in quantities {
                match (single, numbers.first()) {
                    (true, Some(number)) => out.set_item(name, number)?,
                    _ => out.set_item(name, numbers.into_pyarray(py))?,
                }
            }
        }
        Ok(out)
    }

    /// A field of the last row, by its name in results.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let kind = choose("field", name)?;
        let found = detached(py, || {
            let march = self.locked();
            let step = march.last()?;
            let shape = march.simulation().grid.shape();
            if kind == FieldKind::Contact {
                let mut states = ndarray::Array2::<u8>::zeros(shape);
                step.contact_into(&mut states);
                let boundary = march.simulation().boundary;
                return Some(Map::Contact(process::in_contact_frame(
                    states.view(),
                    boundary,
                    step.frame_shift(),
                    0,
                )));
            }
            let mut field = ndarray::Array2::zeros(shape);
            let (shift, boundary) = (step.frame_shift(), march.simulation().boundary);
            match kind {
                FieldKind::Gap => step.gap_into(&mut field),
                FieldKind::Displacement => step.displacement_into(&mut field),
                FieldKind::Flattening => step.flattening_into(&mut field),
                FieldKind::Pressure | FieldKind::Contact => field.assign(&step.pressure()),
            }
            // Of a contact that moves, in its frame.
            let beyond = if kind == FieldKind::Pressure { 0.0 } else { f64::NAN };
            Some(Map::Real(process::in_contact_frame(field.view(), boundary, shift, beyond)))
        })?;
        match found {
            Some(Map::Real(field)) => Ok(field.into_pyarray(py).into_any()),
            Some(Map::Contact(states)) => Ok(states.into_pyarray(py).into_any()),
            None => Err(CaseError::new_err("there is no row yet: advance first")),
        }
    }
}

/// A field on its way to Python.
enum Map {
    Real(ndarray::Array2<f64>),
    Contact(ndarray::Array2<u8>),
}

impl March {
    fn locked(&self) -> MutexGuard<'_, Box<dyn Drive>> {
        self.march.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The numbers of a row by their names in results.
pub fn fill(into: &Bound<'_, PyDict>, row: &step::Row) -> PyResult<()> {
    for scalar in SCALARS {
        match scalar.is_count() {
            true => into.set_item(scalar.name, scalar.of(row) as u64)?,
            false => into.set_item(scalar.name, scalar.of(row))?,
        }
    }
    Ok(())
}
