//! Leakage in a result: one number per time and array, over the dimension `leak_time`.
//!
//! | array | dimensions | unit |
//! |---|---|---|
//! | `leak_time`, `leak_step` | `leak_time` | time and row of the fields that the leak was computed from |
//! | `leak_rate` | `leak_time` | m3/s, of a gas kg/s |
//! | `leak_rate_standard` | `leak_time` | Pa m3/s at 0 degC, of a gas |
//! | `leak_estimate_junction`, `leak_estimate_medium` | `leak_time` | as `leak_rate` |
//! | `hydraulic_gap`, `critical_gap`, `critical_x`, `critical_y` | `leak_time` | m |
//! | `percolates`, `leak_resolved` | `leak_time` | 0 or 1 |
//! | `open_fraction`, `trapped_area`, `trapped_volume` | `leak_time` | 1, m2, m3 |
//! | `conductance` | `leak_time`, `flow_direction`, `gradient_direction` | m3 |
//! | `fluid_pressure` | `leak_time`, `x`, `y` | Pa |
//!
//! They are written when a run is complete, or later, and appear together: the group's document names them last.

use std::fs;
use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::finding::{CONSTRICTION_UNRESOLVED, FLUID_PRESSURE_LARGE, Finding, LEAK_BELOW_GAP_ERROR};
use ndarray::ArrayView2;
use serde_json::{Map, Value, json};

use super::chunks::Chunks;
use super::document;
use super::error::Result;
use super::layout::{ArraySpec, DataType, Series, side};
use super::reader::Reader;
use super::writer::{lock, remove};
use crate::finding;
use crate::leakage::Leakage;

/// Codes of the findings about leaks.
const CODES: [&str; 3] = [LEAK_BELOW_GAP_ERROR, CONSTRICTION_UNRESOLVED, FLUID_PRESSURE_LARGE];
/// Attribute of the group that holds what was asked for, as JSON text.
const ATTRIBUTE: &str = "leakage";

/// Names, units and meanings of the numbers; those of a gas have the unit in `gas_units`.
struct Number {
    name: &'static str,
    units: &'static str,
    gas_units: &'static str,
    long_name: &'static str,
    data_type: DataType,
}

const fn number(name: &'static str, units: &'static str, long_name: &'static str) -> Number {
    Number { name, units, gas_units: units, long_name, data_type: DataType::Float64 }
}

const fn rate(name: &'static str, long_name: &'static str) -> Number {
    Number { name, units: "m3/s", gas_units: "kg/s", long_name, data_type: DataType::Float64 }
}

const fn count(name: &'static str, long_name: &'static str) -> Number {
    Number { name, units: "1", gas_units: "1", long_name, data_type: DataType::Int64 }
}

const NUMBERS: [Number; 17] = [
    number("leak_time", "s", "time of the leak"),
    count("leak_step", "row of the leak"),
    rate("leak_rate", "leak rate"),
    number("leak_rate_standard", "Pa m3/s", "leak rate at 0 degC"),
    rate("leak_estimate_junction", "leak rate of plates at the critical gap"),
    rate("leak_estimate_medium", "leak rate of the effective medium"),
    number("hydraulic_gap", "m", "gap of plates that leak as much"),
    number("critical_gap", "m", "gap at the critical constriction"),
    number("critical_x", "m", "x of the critical constriction"),
    number("critical_y", "m", "y of the critical constriction"),
    count("percolates", "whether inlet and outlet are connected"),
    count("leak_resolved", "whether gap, grid and fluid pressure carry the leak"),
    number("open_fraction", "1", "share of the cells that are open"),
    number("trapped_area", "m2", "open area connected to neither inlet nor outlet"),
    number("trapped_volume", "m3", "volume of it"),
    number("knudsen_number", "1", "mean free path over critical gap"),
    number("conductance", "m3", "effective conductance"),
];

/// What a leak of a gas, or of a liquid, may have one number of.
pub fn leak_series(gas: bool) -> impl Iterator<Item = Series> {
    let own = NUMBERS.iter().filter(|number| number.name != "conductance");
    own.map(move |number| Series {
        name: number.name,
        units: if gas { number.gas_units } else { number.units },
        long_name: number.long_name,
    })
}

/// The pressure of the fluid.
const PRESSURE: &str = "fluid_pressure";

/// Whether a result may have an array of that name.
pub(super) fn owns(name: &str) -> bool {
    name == PRESSURE || NUMBERS.iter().any(|number| number.name == name)
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
}

impl Leaks {
    /// What the documents of a group say.
    pub(super) fn of(attributes: &Map<String, Value>, metadata: &Map<String, Value>) -> Option<Leaks> {
        let rows = metadata.get("leak_time")?.pointer("/shape/0")?.as_u64()?;
        let settings = attributes.get(ATTRIBUTE).and_then(Value::as_str);
        let all = NUMBERS.iter().map(|number| number.name).chain([PRESSURE]);
        Some(Leaks {
            rows: usize::try_from(rows).ok()?,
            settings: settings.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default(),
            names: all.filter(|name| metadata.contains_key(*name)).collect(),
            gas: metadata.contains_key("leak_rate_standard"),
        })
    }

    /// What each leak has one number of.
    pub fn series(&self) -> Vec<Series> {
        leak_series(self.gas).filter(|series| self.names.contains(&series.name)).collect()
    }

    /// Whether the pressure of the fluid is stored.
    pub fn has_pressure(&self) -> bool {
        self.names.contains(&PRESSURE)
    }

    /// The attribute of the group that says what was asked for.
    pub(super) fn attribute(&self) -> (String, Value) {
        (ATTRIBUTE.to_owned(), json!(self.settings.to_string()))
    }

    pub(super) fn arrays(&self, grid: &Grid) -> Vec<ArraySpec> {
        self.names.iter().map(|name| spec(name, self.rows, grid, self.gas)).collect()
    }
}

fn spec(name: &'static str, rows: usize, grid: &Grid, gas: bool) -> ArraySpec {
    let [nx, ny] = grid.cells();
    if name == PRESSURE {
        let attributes = json!({"units": "Pa", "long_name": "pressure of the fluid"});
        return ArraySpec {
            name,
            data_type: DataType::Float64,
            dimensions: &["leak_time", "x", "y"],
            shape: vec![rows, nx, ny],
            chunk: vec![1, side(nx), side(ny)],
            compressed: true,
            summed: true,
            attributes,
        };
    }
    let known = NUMBERS.iter().find(|number| number.name == name).unwrap_or(&NUMBERS[0]);
    let tensor = name == "conductance";
    ArraySpec {
        name,
        data_type: known.data_type,
        dimensions: if tensor {
            &["leak_time", "flow_direction", "gradient_direction"]
        } else {
            &["leak_time"]
        },
        shape: if tensor { vec![rows, 2, 2] } else { vec![rows] },
        chunk: if tensor { vec![rows.max(1), 2, 2] } else { vec![rows.max(1)] },
        compressed: false,
        summed: true,
        attributes: json!({
            "units": if gas { known.gas_units } else { known.units },
            "long_name": known.long_name,
        }),
    }
}

/// Leaks over time, by name.
#[derive(Clone, Debug, PartialEq)]
pub struct LeakTable {
    /// One column per array.
    columns: Vec<(&'static str, Vec<f64>)>,
    gas: bool,
}

impl LeakTable {
    /// An empty table, of a liquid or a gas, or without a fluid; with the effective conductance or without.
    pub fn new(gas: Option<bool>, both: bool) -> LeakTable {
        let wanted = |name: &str| match name {
            "leak_rate" | "leak_estimate_junction" | "leak_estimate_medium" => gas.is_some(),
            "leak_rate_standard" | "knudsen_number" => gas == Some(true),
            "conductance" => both,
            _ => true,
        };
        let names = NUMBERS.iter().map(|number| number.name).filter(|name| wanted(name));
        LeakTable { columns: names.map(|name| (name, vec![])).collect(), gas: gas == Some(true) }
    }

    /// The leaks that a result holds.
    ///
    /// # Errors
    /// [`StoreError::Corrupt`](super::StoreError::Corrupt) where a file is damaged.
    pub fn of(reader: &Reader) -> Result<Option<LeakTable>> {
        let Some(leaks) = reader.leaks() else { return Ok(None) };
        let names = leaks.names.iter().filter(|name| **name != PRESSURE);
        let columns = names.map(|name| Ok((*name, reader.leak(name)?))).collect::<Result<_>>()?;
        Ok(Some(LeakTable { columns, gas: leaks.gas }))
    }

    /// Whether a finding of this code is about leaks.
    pub fn is_judged_by(code: &str) -> bool {
        CODES.contains(&code)
    }

    /// Adds the leak at a time.
    pub fn push(&mut self, time: f64, step: usize, leak: &Leakage, resolved: bool) {
        let flag = |flag: bool| f64::from(u8::from(flag));
        for (name, column) in &mut self.columns {
            column.push(match *name {
                "leak_time" => time,
                "leak_step" => step as f64,
                "leak_rate" => leak.leak_rate.unwrap_or(f64::NAN),
                "leak_rate_standard" => leak.leak_rate_standard.unwrap_or(f64::NAN),
                "leak_estimate_junction" => leak.leak_estimate_junction.unwrap_or(f64::NAN),
                "leak_estimate_medium" => leak.leak_estimate_medium.unwrap_or(f64::NAN),
                "hydraulic_gap" => leak.hydraulic_gap,
                "critical_gap" => leak.critical_gap,
                "critical_x" => leak.critical[0],
                "critical_y" => leak.critical[1],
                "percolates" => flag(leak.percolates),
                "leak_resolved" => flag(resolved),
                "open_fraction" => leak.open_fraction,
                "trapped_area" => leak.trapped_area,
                "trapped_volume" => leak.trapped_volume,
                "knudsen_number" => leak.knudsen.unwrap_or(f64::NAN),
                _ => {
                    column.extend(leak.conductance.unwrap_or([[f64::NAN; 2]; 2]).as_flattened());
                    continue;
                }
            });
        }
    }

    /// The numbers of that name; the conductance as xx, xy, yx, yy of each time.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.0 == name).map(|column| column.1.as_slice())
    }

    /// Times.
    pub fn len(&self) -> usize {
        self.columns[0].1.len()
    }

    /// Whether it has no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Names, units and meanings.
    pub fn series(&self) -> Vec<Series> {
        let names = self.columns.iter().map(|column| column.0).collect();
        Leaks { rows: self.len(), settings: Value::Null, names, gas: self.gas }.series()
    }
}

/// Brings leaks into a result.
pub struct LeakWriter {
    root: PathBuf,
    grid: Grid,
    field: bool,
    /// Form of the result.
    form: u64,
    _lock: Option<fs::File>,
}

impl LeakWriter {
    /// Takes the result at `root` for writing. The leaks that it has stay until [`finish`](Self::finish), but for their fields.
    ///
    /// # Errors
    /// [`StoreError::Busy`](super::StoreError::Busy) where a run is writing it, [`StoreError::Io`](super::StoreError::Io).
    pub fn new(root: &Path, grid: &Grid, field: bool) -> Result<LeakWriter> {
        let held = lock(root)?;
        let form = document::Document::read(root)?.form;
        Ok(LeakWriter { root: root.to_owned(), grid: *grid, field, form, _lock: held })
    }

    /// Writes the pressure of the fluid \[Pa\] of number `index`.
    ///
    /// # Errors
    /// [`StoreError::Io`](super::StoreError::Io) where the system refuses.
    pub fn put_pressure(&self, index: usize, pressure: ArrayView2<'_, f64>) -> Result<()> {
        let spec = spec(PRESSURE, index + 1, &self.grid, false).of_form(self.form);
        Chunks::new(&self.root, &spec).write_map(&[index as u64], pressure)
    }

    /// Writes the numbers and makes all of it visible.
    ///
    /// # Errors
    /// [`StoreError::Io`](super::StoreError::Io) where the system refuses.
    pub fn finish(self, table: &LeakTable, settings: Value, findings: &[Finding]) -> Result<()> {
        let rows = table.len();
        let mut specs = vec![];
        for (name, numbers) in &table.columns {
            let spec = spec(name, rows, &self.grid, table.gas).of_form(self.form);
            let chunks = Chunks::new(&self.root, &spec);
            let index = vec![0; spec.shape.len()];
            match spec.data_type {
                DataType::Int64 => {
                    chunks.write(&index, &numbers.iter().map(|x| *x as i64).collect::<Vec<_>>())?;
                }
                _ => chunks.write(&index, numbers)?,
            }
            specs.push(spec);
        }
        if self.field {
            specs.push(spec(PRESSURE, rows, &self.grid, table.gas).of_form(self.form));
        }
        let add_findings = |attributes: &mut Map<String, Value>| {
            let earlier = attributes.get("findings").map(finding::from_list).unwrap_or_default();
            let kept = earlier.into_iter().filter(|finding| !CODES.contains(&finding.code.as_ref()));
            let all: Vec<Finding> = kept.chain(findings.iter().cloned()).collect();
            attributes.insert("findings".into(), finding::list(&all));
            attributes.insert(ATTRIBUTE.into(), json!(settings.to_string()));
        };
        let dropped = document::exchange_arrays(&self.root, owns, &specs, add_findings)?;
        for name in dropped {
            remove(&self.root.join(name))?;
        }
        Ok(())
    }
}
