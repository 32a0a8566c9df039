//! The keys of a case that make its grid, its steps or its solver coarser.

use asperity::Axis;
use toml::{Table, Value};

use crate::case::Case;

/// What is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Half the cells along each side.
    HalfCells,
    /// A quarter of them.
    QuarterCells,
    /// Twice the cells along each side.
    DoubleCells,
    /// Steps of twice the length.
    LongSteps,
    /// Ten times the tolerance of the solver.
    LooseSolver,
}

/// Fewer cells along a side than this are no contact.
const FEWEST_CELLS: usize = 8;
/// The error of adaptive steps grows with the square of their length.
const TOLERANCE_OF_LONG_STEPS: f64 = 4.0;
/// What a case has that does not name the key.
const ADAPTIVE_TOLERANCE: f64 = 1e-3;

impl Change {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Change::HalfCells => "half the cells along each side",
            Change::QuarterCells => "a quarter of the cells along each side",
            Change::DoubleCells => "twice the cells along each side",
            Change::LongSteps => "steps of twice the length",
            Change::LooseSolver => "ten times the tolerance",
        }
    }

    /// The keys that make it, as `--set` takes them.
    ///
    /// # Errors
    /// A sentence where the case does not allow it.
    pub(super) fn overrides(self, case: &Case) -> Result<Vec<String>, String> {
        let table: Table = case.source.parse().map_err(|_| "the case is no text".to_owned())?;
        match self {
            Change::HalfCells => cells(case, &table, |n| n.div_ceil(2)),
            Change::QuarterCells => cells(case, &table, |n| n.div_ceil(4)),
            Change::DoubleCells => cells(case, &table, |n| 2 * n),
            Change::LongSteps => long_steps(case, &table),
            Change::LooseSolver => {
                Ok(vec![format!("solver.tolerance={:e}", 10.0 * case.conditions.solver.tolerance)])
            }
        }
    }
}

/// Another number of cells; measured surfaces are resampled by their spectrum.
fn cells(case: &Case, table: &Table, change: impl Fn(usize) -> usize) -> Result<Vec<String>, String> {
    let grid = case.conditions.grid;
    let cells: Vec<usize> = grid.cells()[..grid.dimensions()].iter().map(|n| change(*n)).collect();
    if cells.iter().any(|n| *n < FEWEST_CELLS) {
        return Err(format!("a grid of {cells:?} cells is too coarse"));
    }
    let mut keys = vec![format!("domain.cells={cells:?}")];
    let surfaces = table.get("surface").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    for (n, surface) in surfaces.iter().enumerate() {
        let is_file = surface.get("kind").and_then(Value::as_str) == Some("file");
        if !is_file || surface.get("resample").is_some() {
            continue;
        }
        match surface.get("process").and_then(Value::as_array) {
            None => keys.push(format!("surface.{n}.resample=\"band-limited\"")),
            Some(steps) => {
                let mut steps = steps.clone();
                steps.push(Value::Table(Table::from_iter([("op".into(), "resample".into())])));
                keys.push(format!("surface.{n}.process={}", Value::Array(steps)));
            }
        }
    }
    Ok(keys)
}

/// Steps of twice the length, in the run and in each stage with steps of its own.
fn long_steps(case: &Case, table: &Table) -> Result<Vec<String>, String> {
    if case.axis() == Axis::Velocity {
        return Err("a sweep over velocities has no steps in time".into());
    }
    let mut keys = vec![];
    if let Some(times) = table.get("time").and_then(Value::as_table) {
        keys.extend(longer("time", times));
    }
    let stages = table.get("load").and_then(|load| load.get("stages")).and_then(Value::as_array);
    for (n, stage) in stages.into_iter().flatten().enumerate() {
        let path = format!("load.stages.{n}");
        keys.extend(stage.as_table().and_then(|stage| longer(&path, stage)));
        let own = stage.get("time").and_then(Value::as_table);
        keys.extend(own.and_then(|times| longer(&format!("{path}.time"), times)));
    }
    if let Some(motion) = table.get("motion") {
        let per_cell = motion.get("cells_per_step").and_then(number).unwrap_or(1.0);
        keys.push(format!("motion.cells_per_step={}", 2.0 * per_cell));
    }
    if keys.is_empty() {
        return Err("the steps cannot be longer: there is one".into());
    }
    Ok(keys)
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|n| n as f64))
}

/// The key that makes the steps of a table longer; `None` where it has one step, or none of its own.
fn longer(path: &str, times: &Table) -> Option<String> {
    if let Some(list) = times.get("times").and_then(Value::as_array) {
        // Every second one, and the last.
        let kept: Vec<Value> = list.iter().rev().step_by(2).rev().cloned().collect();
        return (kept.len() < list.len()).then(|| format!("{path}.times={}", Value::Array(kept)));
    }
    if times.get("spacing").and_then(Value::as_str) == Some("adaptive") {
        let tolerance = times.get("tolerance").and_then(number).unwrap_or(ADAPTIVE_TOLERANCE);
        return Some(format!("{path}.tolerance={:e}", TOLERANCE_OF_LONG_STEPS * tolerance));
    }
    let steps = times.get("steps").and_then(Value::as_integer).filter(|steps| *steps > 1)?;
    Some(format!("{path}.steps={}", (steps + 1) / 2))
}
