//! What is kept of a result: every number of every row, and of each map, as of each row of a histogram, five numbers (see [`measures`]).
//!
//! A file has one line for each array, with 11 digits:
//!
//! ```json
//! {"columns": {"load": [..]}, "maps": {"pressure": [[..], ..]}, "errors": {"residual": 1e-12}, "work": {"iterations": [..]}}
//! ```

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::result::{Numbers, Stored};

/// Largest change of a number, relative to the largest of its column. The steps are solved to 1e-11 of the mean displacement, in KKT
/// residual. Pressures are that residual times the condition of the discrete operator, some 100 on these grids, and steps add up over
/// the run: 1e-8. Summation in another order, or another path of the solver to the same tolerance, stays below it tenfold.
pub(crate) const TOLERANCE: f64 = 1e-7;

/// Estimated errors are differences of two solutions, some 1e-3 of them.
const TOLERANCE_OF_ESTIMATES: f64 = 1e-4;

/// Exact, and compared apart.
const WORK: [&str; 2] = ["iterations", "convolutions"];
/// How exactly a step is solved: not reproduced, but no worse.
const ERRORS: [&str; 2] = ["residual", "certificate"];

pub(crate) type Columns = BTreeMap<String, Vec<f64>>;

pub(crate) struct Frozen {
    /// One number for each row.
    columns: Columns,
    /// The measures of each map.
    maps: BTreeMap<String, Vec<[f64; 5]>>,
    /// The largest of each.
    errors: BTreeMap<String, f64>,
    /// Iterations and convolutions of each row.
    pub(crate) work: Columns,
}

/// Of a map: number of cells that hold a number, their sum, mean square, largest size, and sum weighted by a number in [0, 1) of each
/// cell, which tells where the others are. Sums are over the number of cells.
fn measures(map: &[f64]) -> [f64; 5] {
    const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
    let mut measures = [0.0; 5];
    for (n, value) in map.iter().enumerate().filter(|(_, value)| value.is_finite()) {
        let weight = ((n + 1) as f64 * GOLDEN_RATIO).fract();
        measures[0] += 1.0;
        measures[1] += value;
        measures[2] += value * value;
        measures[3] = value.abs().max(measures[3]);
        measures[4] += weight * value;
    }
    let cells = measures[0].max(1.0);
    for n in [1, 2, 4] {
        measures[n] /= cells;
    }
    measures
}

/// The row-like parts of an array, and whether each is one number.
fn parts(numbers: &Numbers) -> Vec<&[f64]> {
    let over_rows = matches!(
        numbers.dimensions[0].as_str(),
        "time" | "velocity" | "field_time" | "field_velocity" | "leak_time"
    );
    match over_rows {
        true => numbers.values.chunks(numbers.shape[1..].iter().product::<usize>().max(1)).collect(),
        false => vec![&numbers.values],
    }
}

impl Frozen {
    pub(crate) fn of(result: &Stored) -> Frozen {
        let mut frozen = Frozen {
            columns: Columns::new(),
            maps: BTreeMap::new(),
            errors: BTreeMap::new(),
            work: Columns::new(),
        };
        for (name, numbers) in &result.0 {
            let (key, parts) = (name.clone(), parts(numbers));
            if WORK.contains(&name.as_str()) {
                frozen.work.insert(key, numbers.values.clone());
            } else if ERRORS.contains(&name.as_str()) {
                let largest = numbers.values.iter().copied().filter(|x| !x.is_nan()).fold(0.0, f64::max);
                frozen.errors.insert(key, largest);
            } else if parts.iter().all(|part| part.len() == 1) {
                frozen.columns.insert(key, numbers.values.clone());
            } else {
                frozen.maps.insert(key, parts.into_iter().map(measures).collect());
            }
        }
        frozen
    }

    pub(crate) fn text(&self) -> String {
        let lists = |columns: &Columns| {
            columns.iter().map(|(name, values)| format!("\"{name}\": {}", list(values))).collect::<Vec<_>>()
        };
        let maps = self.maps.iter().map(|(name, maps)| {
            let maps: Vec<String> = maps.iter().map(|measures| list(measures)).collect();
            format!("\"{name}\": [{}]", maps.join(", "))
        });
        let errors = self.errors.iter().map(|(name, largest)| format!("\"{name}\": {}", number(*largest)));
        let section = |name, lines: Vec<String>| format!("\"{name}\": {{\n{}\n}}", lines.join(",\n"));
        let sections = [
            section("columns", lists(&self.columns)),
            section("maps", maps.collect()),
            section("errors", errors.collect()),
            section("work", lists(&self.work)),
        ];
        format!("{{{}}}\n", sections.join(",\n"))
    }

    pub(crate) fn parse(text: &str) -> Frozen {
        let document: Value = serde_json::from_str(text).unwrap();
        let section = |name: &str| document[name].as_object().unwrap();
        let columns = |section: &Map<String, Value>| {
            section.iter().map(|(name, values)| (name.clone(), numbers(values))).collect()
        };
        let maps = |value: &Value| {
            let maps = value.as_array().unwrap().iter();
            maps.map(|measures| numbers(measures).try_into().unwrap()).collect()
        };
        Frozen {
            columns: columns(section("columns")),
            maps: section("maps").iter().map(|(name, value)| (name.clone(), maps(value))).collect(),
            errors: section("errors").iter().map(|(name, value)| (name.clone(), from_json(value))).collect(),
            work: columns(section("work")),
        }
    }

    /// The size of a column: that of its largest number, or where this vanishes by symmetry a thousandth of what it is a part of.
    fn size(&self, name: &str) -> f64 {
        let whole = match name {
            "mean_gap" => "approach",
            "friction_force" | "side_force" => "load",
            _ => name,
        };
        let of = |name| self.columns.get(name).map_or(0.0, |column| size(column));
        of(name).max(1e-3 * of(whole))
    }

    /// What `found` has otherwise, a line each; of a run with this tolerance of the solver.
    pub(crate) fn changes(&self, found: &Frozen, solver_tolerance: f64) -> Vec<String> {
        let mut changes = names(&self.columns, &found.columns);
        changes.extend(names(&self.maps, &found.maps));
        for (name, old) in &self.columns {
            let Some(new) = found.columns.get(name) else { continue };
            let allowed = match name.as_str() {
                "time_error" | "friction_uncertainty" => TOLERANCE_OF_ESTIMATES,
                _ => TOLERANCE,
            };
            changes.extend(column(name, old, new, allowed * self.size(name)));
        }
        for (name, old) in &self.maps {
            let Some(new) = found.maps.get(name) else { continue };
            let of = |maps: &[[f64; 5]], n: usize| maps.iter().map(|map| map[n]).collect::<Vec<f64>>();
            // Means may vanish by symmetry: their size is the root of the mean square.
            let [mean, square] = [size(&of(old, 2)).sqrt(), size(&of(old, 2))];
            let sizes = [0.0, mean, square, size(&of(old, 3)), mean];
            let measures = ["cells", "mean", "mean square", "largest", "weighted mean"];
            for (n, (measure, size)) in measures.into_iter().zip(sizes).enumerate() {
                let name = format!("{name} ({measure})");
                changes.extend(column(&name, &of(old, n), &of(new, n), TOLERANCE * size));
            }
        }
        for (name, old) in &self.errors {
            let (new, limit) =
                (found.errors.get(name).copied().unwrap_or(f64::NAN), 10.0 * old.max(solver_tolerance));
            if new.is_nan() || new > limit {
                changes.push(format!("{name}: {old:e} at most was frozen, {new:e} found"));
            }
        }
        for (name, old) in &self.work {
            let new = found.work.get(name).cloned().unwrap_or_default();
            if *old != new {
                let [frozen, found] = [old, &new].map(|counts| counts.iter().sum::<f64>());
                let row = old.iter().zip(&new).position(|(old, new)| old != new).unwrap_or(0);
                changes.push(format!(
                    "{name}: {frozen} in all were frozen, {found} found, other ones from row {row} on \
                     (if that is meant: ASPERITY_GOLDEN=work)"
                ));
            }
        }
        changes
    }
}

/// The names that one of two has alone.
fn names<T>(old: &BTreeMap<String, T>, new: &BTreeMap<String, T>) -> Vec<String> {
    let lost = old.keys().filter(|name| !new.contains_key(*name)).map(|name| format!("{name} is missing"));
    let more =
        new.keys().filter(|name| !old.contains_key(*name)).map(|name| format!("{name} was not frozen"));
    lost.chain(more).collect()
}

/// The row of a column with the largest change, if it is more than allowed.
fn column(name: &str, old: &[f64], new: &[f64], allowed: f64) -> Option<String> {
    if old.len() != new.len() {
        return Some(format!("{name}: {} rows were frozen, {} found", old.len(), new.len()));
    }
    let apart = |old: f64, new: f64| match old == new || old.is_nan() && new.is_nan() {
        true => 0.0,
        false if (old - new).is_nan() => f64::INFINITY,
        false => (old - new).abs(),
    };
    let all = old.iter().zip(new).map(|(old, new)| apart(*old, *new)).enumerate();
    let (row, change) = all.fold((0, 0.0), |most, this| if this.1 > most.1 { this } else { most });
    (change > allowed).then(|| {
        format!(
            "{name}, row {row}: {:e} was frozen, {:e} found, {allowed:.1e} apart at most",
            old[row], new[row]
        )
    })
}

/// The largest size of a number of a column.
fn size(column: &[f64]) -> f64 {
    column.iter().filter(|value| value.is_finite()).fold(0.0, |size, value| value.abs().max(size))
}

fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", "))
}

/// Eleven digits; what is no number as text.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return format!("\"{value}\"");
    }
    let rounded: f64 = format!("{value:.10e}").parse().unwrap();
    match rounded.fract() == 0.0 && rounded.abs() < 1e11 {
        true => format!("{}", rounded as i64),
        false => format!("{rounded:e}"),
    }
}

fn numbers(values: &Value) -> Vec<f64> {
    values.as_array().unwrap().iter().map(from_json).collect()
}

fn from_json(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}
