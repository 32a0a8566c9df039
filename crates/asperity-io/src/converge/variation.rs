//! The keys of a case that make its grid, its steps or its solver coarser.

use asperity::surface::Part;
use asperity::{Axis, Course, History, Plasticity, Simulation};
use toml::{Table, Value};

use crate::case::{Case, Surface};
use crate::quantity::in_si;

/// What is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Half the cells along each side.
    HalfCells,
    /// A quarter of them.
    QuarterCells,
    /// Three quarters of them.
    ThreeQuartersOfCells,
    /// Twice the cells along each side.
    DoubleCells,
    /// Steps of twice the length, or more where their number is odd.
    LongSteps,
    /// Steps of half the length.
    HalfSteps,
    /// Steps of a quarter of the length.
    QuarterSteps,
    /// Ten times the tolerance of the solver.
    LooseSolver,
}

/// Fewer cells along a side than this are no contact.
const FEWEST_CELLS: usize = 8;
/// What a case has that does not name the key.
const ADAPTIVE_TOLERANCE: f64 = 1e-3;

impl Change {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Change::HalfCells => "half the cells along each side",
            Change::QuarterCells => "a quarter of the cells along each side",
            Change::ThreeQuartersOfCells => "three quarters of the cells along each side",
            Change::DoubleCells => "twice the cells along each side",
            Change::LongSteps => "steps of twice the length",
            Change::HalfSteps => "steps of half the length",
            Change::QuarterSteps => "steps of a quarter of the length",
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
            Change::ThreeQuartersOfCells => cells(case, &table, |n| (3 * n).div_ceil(4)),
            Change::DoubleCells => cells(case, &table, |n| 2 * n),
            Change::LongSteps => steps(&table, &LONGER),
            Change::HalfSteps => steps(&table, &HALF),
            Change::QuarterSteps => steps(&table, &QUARTER),
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

/// Whether the length of the steps can change an answer: bodies that remember, a contact that moves, surfaces that wear, stay flattened or
/// attract each other, and answers about the cycles of a sine. The rows of an elastic contact do not depend on those before them, and a
/// sweep over velocities has no steps.
pub(super) fn steps_matter(case: &Case) -> bool {
    let Simulation { creep, thermal, layers, traction, loading, .. } = &case.conditions;
    let remembers =
        !creep.terms.is_empty() || creep.fluidity != 0.0 || !thermal.is_empty() || layers.is_some();
    let has_path = traction.is_some() || case.conditions.plasticity == Plasticity::Accumulate;
    let is_sine = |course: &Course| matches!(course, Course::Given(History::Sine { .. }));
    let has_cycles = loading.stages.iter().any(|stage| is_sine(&stage.course));
    case.axis() == Axis::Time
        && (remembers || has_path || has_cycles || case.motion.is_some() || case.conditions.wear.is_some())
}

/// Whether a shape of the case has an edge or a tip where the pressure grows without end.
pub(super) fn has_singular_pressure(case: &Case) -> bool {
    let is_singular = |surface: &Surface| match surface {
        Surface::Part(Part::Shape { shape, .. }) => shape.has_singular_pressure(),
        Surface::Part(_) | Surface::File(_) | Surface::Given(..) => false,
    };
    case.surfaces.iter().any(is_singular)
}

/// How the keys that give steps change with the length of the steps.
struct Stretch {
    /// The length of the new steps over that of the old ones.
    length: f64,
    /// Another number of equal steps, where there is one.
    count: fn(i64) -> Option<i64>,
    /// Another list of times, where there is one.
    list: fn(&[Value]) -> Option<Vec<Value>>,
    /// Why there is none.
    why_not: &'static str,
}

const LONGER: Stretch = Stretch {
    length: 2.0,
    // At least twice as long: of 5 steps 2 remain.
    count: |steps| (steps > 1).then_some(steps / 2),
    list: every_second,
    why_not: "a part of the run has one step",
};

const HALF: Stretch = Stretch {
    length: 0.5,
    count: |steps| steps.checked_mul(2),
    list: with_midpoints,
    why_not: "a list of times has a text that is no time",
};

const QUARTER: Stretch = Stretch {
    length: 0.25,
    count: |steps| steps.checked_mul(4),
    list: |times| with_midpoints(&with_midpoints(times)?),
    ..HALF
};

/// The keys that stretch every step of the run and of its stages.
fn steps(table: &Table, stretch: &Stretch) -> Result<Vec<String>, String> {
    let mut keys = vec![];
    if let Some(times) = table.get("time").and_then(Value::as_table) {
        keys.extend(stretch.keys("time", times)?);
    }
    let stages = table.get("load").and_then(|load| load.get("stages")).and_then(Value::as_array);
    for (n, stage) in stages.into_iter().flatten().enumerate() {
        let path = format!("load.stages.{n}");
        if let Some(stage) = stage.as_table() {
            keys.extend(stretch.keys(&path, stage)?);
        }
        if let Some(own) = stage.get("time").and_then(Value::as_table) {
            keys.extend(stretch.keys(&format!("{path}.time"), own)?);
        }
    }
    if let Some(motion) = table.get("motion") {
        let per_cell = motion.get("cells_per_step").and_then(number).unwrap_or(1.0);
        keys.push(format!("motion.cells_per_step={}", stretch.length * per_cell));
    }
    if keys.is_empty() {
        return Err(stretch.why_not.to_owned());
    }
    Ok(keys)
}

impl Stretch {
    /// The key that stretches the steps of a table; none where it has no steps of its own.
    fn keys(&self, path: &str, times: &Table) -> Result<Option<String>, String> {
        let why_not = || format!("{}: {path}", self.why_not);
        if let Some(list) = times.get("times").and_then(Value::as_array) {
            let other = (self.list)(list).ok_or_else(why_not)?;
            return Ok(Some(format!("{path}.times={}", Value::Array(other))));
        }
        if times.get("spacing").and_then(Value::as_str) == Some("adaptive") {
            let tolerance = times.get("tolerance").and_then(number).unwrap_or(ADAPTIVE_TOLERANCE);
            // The error of a step grows with the square of its length.
            return Ok(Some(format!("{path}.tolerance={:e}", self.length * self.length * tolerance)));
        }
        let Some(steps) = times.get("steps").and_then(Value::as_integer) else { return Ok(None) };
        (self.count)(steps).ok_or_else(why_not).map(|steps| Some(format!("{path}.steps={steps}")))
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|n| n as f64))
}

/// Every second time; of an odd number the last interval is longer still.
fn every_second(times: &[Value]) -> Option<Vec<Value>> {
    let (last, _) = times.split_last().filter(|(_, before)| !before.is_empty())?;
    let kept = times.iter().skip(1).step_by(2).take(times.len() / 2 - 1);
    Some(kept.chain([last]).cloned().collect())
}

/// The times and those halfway between them, from 0 on.
fn with_midpoints(times: &[Value]) -> Option<Vec<Value>> {
    let seconds = |value: &Value| match value.as_str() {
        Some(text) => in_si(text).map(|(seconds, _)| seconds),
        None => number(value),
    };
    let (mut all, mut before) = (vec![], 0.0);
    for value in times {
        let time = seconds(value)?;
        all.extend([Value::Float(before + 0.5 * (time - before)), value.clone()]);
        before = time;
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_times_are_halved_and_doubled() {
        let list = |text: &str| text.parse::<Value>().unwrap().as_array().unwrap().clone();
        let seconds = |values: Option<Vec<Value>>| {
            values.map(|v| v.iter().map(|v| v.as_float().unwrap()).collect::<Vec<f64>>())
        };
        assert_eq!(seconds(every_second(&list("[1.0, 2.0, 3.0, 4.0]"))).unwrap(), [2.0, 4.0]);
        // No interval is shorter than two of the old ones.
        assert_eq!(seconds(every_second(&list("[1.0, 2.0, 3.0, 4.0, 5.0]"))).unwrap(), [2.0, 5.0]);
        assert_eq!(seconds(every_second(&list("[1.0, 2.0, 3.0]"))).unwrap(), [3.0]);
        assert_eq!(every_second(&list("[1.0]")), None);
        let halved = with_midpoints(&list("[\"1 min\", 100]")).unwrap();
        assert_eq!(halved[0].as_float(), Some(30.0));
        assert_eq!(halved[2].as_float(), Some(80.0));
        assert_eq!((halved.len(), halved[1].as_str()), (4, Some("1 min")));
        assert_eq!(with_midpoints(&list("[\"soon\"]")), None);
    }
}
