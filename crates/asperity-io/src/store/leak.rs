//! Leakage in a result: one number per time and array, over the dimension `leak_time`.
//!
//! | array | dimensions | unit |
//! |---|---|---|
//! | `leak_time`, `leak_step` | `leak_time` | time and row of the fields that the leak was computed from |
//! | `leak_rate` | `leak_time` | m3/s, of a gas kg/s |
//! | `leak_rate_standard` | `leak_time` | Pa m3/s at 0 degC, of a gas |
//! | `leak_rate_one_way`, `leak_estimate_junction`, `leak_estimate_medium` | `leak_time` | as `leak_rate` |
//! | `opening_pressure` | `leak_time` | Pa |
//! | `hydraulic_gap`, `critical_gap`, `critical_x`, `critical_y` | `leak_time` | m |
//! | `percolates`, `leak_resolved` | `leak_time` | 0 or 1 |
//! | `open_fraction`, `trapped_area`, `trapped_volume` | `leak_time` | 1, m2, m3 |
//! | `conductance` | `leak_time`, `flow_direction`, `gradient_direction` | m3 |
//! | `fluid_pressure` | `leak_time`, `x`, `y` | Pa |
//!
//! In a sweep over velocities `leak_velocity` \[m/s\] stands in place of `leak_time`. They are written when a run is complete, or later, and appear together: the group's document names them last.

use std::path::Path;

use asperity::finding::{
    CONSTRICTION_UNRESOLVED, FLUID_UNCOUPLED, Finding, GAPS_BELOW_ERROR, LEAK_BELOW_GAP_ERROR, WINDOW_IN_LEAK,
};
use asperity::{Axis, Grid};
use ndarray::ArrayView2;
use serde_json::{Map, Value, json};

use super::chunks::Chunks;
use super::document::Document;
use super::error::Result;
use super::layout::{ArraySpec, DataType, Series, Storage, cells};
use super::reader::Reader;
use super::writer::{Writer, remove};
use crate::leakage::Leakage;

/// Codes of the findings about leaks.
const CODES: [&str; 5] =
    [LEAK_BELOW_GAP_ERROR, GAPS_BELOW_ERROR, CONSTRICTION_UNRESOLVED, FLUID_UNCOUPLED, WINDOW_IN_LEAK];
/// Attribute of the group that holds what was asked for, as JSON text.
const ATTRIBUTE: &str = "leakage";

/// The leak of one stored time, as the numbers of the arrays follow from it.
struct State<'a> {
    time: f64,
    step: usize,
    leak: &'a Leakage,
    resolved: bool,
}

/// A number of each leak: name, units (of a liquid and of a gas) and meaning; it is stored where `of` gives one.
struct Number {
    name: &'static str,
    units: [&'static str; 2],
    long_name: &'static str,
    data_type: DataType,
    of: fn(&State) -> Option<f64>,
}

const fn number(
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    of: fn(&State) -> Option<f64>,
) -> Number {
    Number { name, units: [units; 2], long_name, data_type: DataType::Float64, of }
}

const fn rate(name: &'static str, long_name: &'static str, of: fn(&State) -> Option<f64>) -> Number {
    Number { units: ["m3/s", "kg/s"], ..number(name, "", long_name, of) }
}

const fn count(name: &'static str, long_name: &'static str, of: fn(&State) -> Option<f64>) -> Number {
    Number { data_type: DataType::Int64, ..number(name, "1", long_name, of) }
}

const NUMBERS: [Number; 18] = [
    number("leak_time", "s", "time of the leak", |at| Some(at.time)),
    count("leak_step", "row of the leak", |at| Some(at.step as f64)),
    rate("leak_rate", "leak rate", |at| at.leak.leak_rate),
    rate("leak_rate_one_way", "leak rate of a fluid that does not act on the surfaces", |at| {
        at.leak.leak_rate_one_way
    }),
    number("leak_rate_standard", "Pa m3/s", "leak rate at 0 degC", |at| at.leak.leak_rate_standard),
    rate("leak_estimate_junction", "leak rate of plates at the critical gap", |at| {
        at.leak.leak_estimate_junction
    }),
    rate("leak_estimate_medium", "leak rate of the effective medium", |at| at.leak.leak_estimate_medium),
    number("opening_pressure", "Pa", "pressure of the inlet that opens the contact", |at| {
        at.leak.opening_pressure
    }),
    number("hydraulic_gap", "m", "gap of plates that leak as much", |at| Some(at.leak.hydraulic_gap)),
    number("critical_gap", "m", "gap at the critical constriction", |at| Some(at.leak.critical_gap)),
    number("critical_x", "m", "x of the critical constriction", |at| Some(at.leak.critical[0])),
    number("critical_y", "m", "y of the critical constriction", |at| Some(at.leak.critical[1])),
    count("percolates", "whether inlet and outlet are connected", |at| Some(flag(at.leak.percolates))),
    count("leak_resolved", "whether gap, grid and fluid pressure carry the leak", |at| {
        Some(flag(at.resolved))
    }),
    number("open_fraction", "1", "share of the cells that are open", |at| Some(at.leak.open_fraction)),
    number("trapped_area", "m2", "open area connected to neither inlet nor outlet", |at| {
        Some(at.leak.trapped_area)
    }),
    number("trapped_volume", "m3", "volume of it", |at| Some(at.leak.trapped_volume)),
    number("knudsen_number", "1", "mean free path over critical gap", |at| at.leak.knudsen),
];

fn flag(flag: bool) -> f64 {
    f64::from(u8::from(flag))
}

/// What a leak of a gas, or of a liquid, may have one number of.
pub fn leak_series(gas: bool) -> impl Iterator<Item = Series> {
    NUMBERS.iter().map(move |number| number.series(gas))
}

/// The effective conductance: xx, xy, yx, yy of each leak.
const CONDUCTANCE: Series = Series::new("conductance", "m3", "effective conductance");
/// The pressure of the fluid.
const PRESSURE: Series = Series::new("fluid_pressure", "Pa", "pressure of the fluid");

/// What stands in place of `leak_time` in a sweep over velocities.
pub(super) const VELOCITY: Series = Series::new("leak_velocity", "m/s", "velocity of the leak");

/// The names of all arrays, in their order.
fn names() -> impl Iterator<Item = &'static str> {
    NUMBERS.iter().map(|number| number.name).chain([CONDUCTANCE.name, PRESSURE.name])
}

/// Whether a result may have an array of that name.
pub(super) fn owns(name: &str) -> bool {
    name == VELOCITY.name || names().any(|known| known == name)
}

/// What a result holds about leaks.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaks {
    /// Times.
    pub rows: usize,
    /// What was asked for, as `[leakage]` in numbers.
    pub settings: Value,
    /// The arrays.
    pub(super) names: Vec<&'static str>,
    /// Whether the fluid is a gas.
    pub(super) gas: bool,
    /// What its rows follow one another in.
    pub(super) axis: Axis,
}

impl Leaks {
    /// What the documents of a group say.
    pub(super) fn of(attributes: &Map<String, Value>, metadata: &Map<String, Value>) -> Option<Leaks> {
        let is_sweep = metadata.contains_key(VELOCITY.name);
        let along = if is_sweep { VELOCITY.name } else { NUMBERS[0].name };
        let rows = metadata.get(along)?.pointer("/shape/0")?.as_u64()?;
        let has =
            |name: &&'static str| metadata.contains_key(if *name == NUMBERS[0].name { along } else { *name });
        let settings = attributes.get(ATTRIBUTE).and_then(Value::as_str);
        Some(Leaks {
            rows: usize::try_from(rows).ok()?,
            settings: settings.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default(),
            names: names().filter(has).collect(),
            gas: metadata.contains_key("leak_rate_standard"),
            axis: if is_sweep { Axis::Velocity } else { Axis::Time },
        })
    }

    /// What each leak has one number of.
    pub fn series(&self) -> Vec<Series> {
        let own = NUMBERS.iter().filter(|number| self.names.contains(&number.name));
        own.map(|number| number.along(self.axis, self.gas)).collect()
    }

    /// Whether the pressure of the fluid is stored.
    pub fn has_pressure(&self) -> bool {
        self.names.contains(&PRESSURE.name)
    }

    /// The attribute of the group that says what was asked for.
    pub(super) fn attribute(&self) -> (String, Value) {
        (ATTRIBUTE.to_owned(), json!(self.settings.to_string()))
    }

    pub(super) fn arrays(&self, grid: &Grid) -> Vec<ArraySpec> {
        self.names.iter().map(|name| spec(name, self.rows, grid, (self.axis, self.gas))).collect()
    }
}

impl Number {
    fn series(&self, gas: bool) -> Series {
        Series::new(self.name, self.units[usize::from(gas)], self.long_name)
    }

    /// The same of a result whose rows follow one another in this.
    fn along(&self, axis: Axis, gas: bool) -> Series {
        match (self.name, axis) {
            ("leak_time", Axis::Velocity) => VELOCITY,
            _ => self.series(gas),
        }
    }
}

fn spec(name: &'static str, rows: usize, grid: &Grid, (axis, gas): (Axis, bool)) -> ArraySpec {
    let leaks = (NUMBERS[0].along(axis, gas).name, rows);
    if let Some(number) = NUMBERS.iter().find(|number| number.name == name) {
        return ArraySpec::new(number.along(axis, gas), Storage::Whole, &[leaks]).of_type(number.data_type);
    }
    if name == PRESSURE.name {
        return ArraySpec::new(PRESSURE, Storage::Maps, &[&[leaks], cells(grid).as_slice()].concat());
    }
    let tensor = [leaks, ("flow_direction", 2), ("gradient_direction", 2)];
    ArraySpec::new(CONDUCTANCE, Storage::Whole, &tensor)
}

/// Leaks over time, by name.
#[derive(Clone, Debug, PartialEq)]
pub struct LeakTable {
    /// What its rows follow one another in: times, or the velocities of a sweep, which stand in the column `leak_time` too.
    pub axis: Axis,
    /// One column per array.
    columns: Vec<(&'static str, Vec<f64>)>,
    gas: bool,
}

impl LeakTable {
    /// No leaks yet.
    pub fn new(axis: Axis) -> Self {
        LeakTable { axis, columns: vec![], gas: false }
    }

    /// The leaks that a result holds.
    ///
    /// # Errors
    /// [`StoreError::Corrupt`](super::StoreError::Corrupt) where a file is damaged.
    pub fn of(reader: &Reader) -> Result<Option<LeakTable>> {
        let Some(leaks) = reader.leaks() else { return Ok(None) };
        let names = leaks.names.iter().filter(|name| **name != PRESSURE.name);
        let columns = names.map(|name| Ok((*name, reader.leak(name)?))).collect::<Result<_>>()?;
        Ok(Some(LeakTable { axis: leaks.axis, columns, gas: leaks.gas }))
    }

    /// Whether a finding of this code is about leaks.
    pub fn is_judged_by(code: &str) -> bool {
        CODES.contains(&code)
    }

    /// Adds the leak at a time. The first one decides which numbers are kept: those of its fluid and direction.
    pub fn push(&mut self, time: f64, step: usize, leak: &Leakage, resolved: bool) {
        let state = State { time, step, leak, resolved };
        if self.columns.is_empty() {
            let stored = NUMBERS.iter().filter(|number| (number.of)(&state).is_some());
            let names = stored.map(|number| number.name).chain(leak.conductance.map(|_| CONDUCTANCE.name));
            self.columns = names.map(|name| (name, vec![])).collect();
            self.gas = leak.leak_rate_standard.is_some();
        }
        for (name, column) in &mut self.columns {
            match NUMBERS.iter().find(|number| number.name == *name) {
                Some(number) => column.push((number.of)(&state).unwrap_or(f64::NAN)),
                None => column.extend(leak.conductance.unwrap_or([[f64::NAN; 2]; 2]).as_flattened()),
            }
        }
    }

    /// The numbers of that name; the conductance as xx, xy, yx, yy of each time.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.0 == name).map(|column| column.1.as_slice())
    }

    /// Times.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |(_, times)| times.len())
    }

    /// Whether it has no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Names, units and meanings.
    pub fn series(&self) -> Vec<Series> {
        let names = self.columns.iter().map(|column| column.0).collect();
        let (rows, axis) = (self.len(), self.axis);
        Leaks { rows, settings: Value::Null, names, gas: self.gas, axis }.series()
    }
}

/// Brings leaks into a result.
pub struct LeakWriter {
    writer: Writer,
    field: bool,
}

impl LeakWriter {
    /// Takes the result at `root` for writing. The leaks that it has stay until [`finish`](Self::finish), except their fields.
    ///
    /// # Errors
    /// As of [`Writer::amend`].
    pub fn new(root: &Path, field: bool) -> Result<LeakWriter> {
        Ok(LeakWriter { writer: Writer::amend(root)?, field })
    }

    /// Writes the pressure of the fluid \[Pa\] of number `index`.
    ///
    /// # Errors
    /// [`StoreError::Io`](super::StoreError::Io) where the system refuses.
    pub fn put_pressure(&self, index: usize, pressure: ArrayView2<'_, f64>) -> Result<()> {
        self.chunks(PRESSURE.name, index + 1, false).write_map(&[index as u64], pressure)
    }

    fn chunks(&self, name: &'static str, rows: usize, gas: bool) -> Chunks {
        let Document { header, form, .. } = &self.writer.document;
        Chunks::new(self.writer.path(), &spec(name, rows, &header.grid, (header.axis(), gas)).of_form(*form))
    }

    /// Writes the numbers and makes all of it visible.
    ///
    /// # Errors
    /// [`StoreError::Io`](super::StoreError::Io) where the system refuses.
    pub fn finish(mut self, table: &LeakTable, settings: Value, findings: &[Finding]) -> Result<()> {
        let (rows, gas) = (table.len(), table.gas);
        for (name, numbers) in &table.columns {
            self.chunks(name, rows, gas).write_whole(numbers)?;
        }
        let stored = table.columns.iter().map(|column| column.0).chain(self.field.then_some(PRESSURE.name));
        let leaks = Leaks { rows, settings, names: stored.collect(), gas, axis: table.axis };
        let gone: Vec<_> = names().filter(|name| !leaks.names.contains(name)).collect();
        let Document { progress, leaks: known, .. } = &mut self.writer.document;
        *known = Some(leaks);
        progress.findings.retain(|finding| !CODES.contains(&finding.code.as_ref()));
        progress.findings.extend(findings.iter().cloned());
        self.writer.publish()?;
        gone.into_iter().try_for_each(|name| remove(&self.writer.path().join(name)))
    }
}
