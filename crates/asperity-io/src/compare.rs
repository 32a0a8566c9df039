//! What differs between two results: in their cases, at their ends, and at the times that both have.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::store::{At, FieldKind, Reader, StoreError};

/// The differences of a second result from a first one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Keys of the cases that have different values, with both; `None` where a case lacks the key.
    pub case: BTreeMap<String, [Option<String>; 2]>,
    /// Numbers of the rows, in the order of the results.
    pub numbers: Vec<Number>,
    /// Rows of the first result at whose time the second has a row too.
    pub common_rows: usize,
    /// Largest difference of the last stored pressures, relative to the largest pressure of the first result; `None` where the
    /// grids differ or a result stores no pressure.
    pub pressure: Option<f64>,
}

/// A number of the rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Number {
    /// Its name in results.
    pub name: String,
    /// Its unit; "1" where it has none.
    pub units: String,
    /// Its last value in both.
    pub last: [f64; 2],
    /// Largest difference at a common time, relative to the largest magnitude of the first result there; `None` without common times.
    pub largest_difference: Option<f64>,
}

/// Rows are at the same time within this share of it: rounding of times that were computed differently.
const SAME: f64 = 1e-12;
/// Numbers that say how a row was solved, not what it is.
const WORK: [&str; 6] = ["iterations", "convolutions", "residual", "certificate", "time_error", "stage"];

/// Compares two results.
///
/// # Errors
/// [`StoreError`] where one has no row or is damaged.
pub fn compare(first: &Reader, second: &Reader) -> Result<Comparison, StoreError> {
    let readers = [first, second];
    if let Some(empty) = readers.into_iter().find(|reader| reader.is_empty()) {
        return Err(empty.no_rows());
    }
    let times = [first.series("time")?, second.series("time")?];
    let common = common(&times);
    let theirs: Vec<&'static str> = second.scalars().iter().map(|series| series.name).collect();
    let mut numbers = vec![];
    for series in first.scalars() {
        if WORK.contains(&series.name) || !theirs.contains(&series.name) {
            continue;
        }
        let [a, b] = [first.series(series.name)?, second.series(series.name)?];
        let largest = common.iter().map(|[n, _]| a[*n].abs()).fold(0.0, f64::max);
        let off = common.iter().map(|[n, m]| (a[*n] - b[*m]).abs()).fold(0.0, f64::max);
        let share = if off == 0.0 { 0.0 } else { off / largest };
        numbers.push(Number {
            name: series.name.to_owned(),
            units: series.units.to_owned(),
            last: [a, b].map(|values| values.last().copied().unwrap_or(f64::NAN)),
            largest_difference: (!common.is_empty()).then_some(share),
        });
    }
    Ok(Comparison { case: cases(readers), numbers, common_rows: common.len(), pressure: pressure(readers)? })
}

/// Rows of both at the same times; of the two rows of a jump the first ones and the second ones.
fn common(times: &[Vec<f64>; 2]) -> Vec<[usize; 2]> {
    let (mut pairs, mut m) = (vec![], 0);
    for (n, time) in times[0].iter().enumerate() {
        while times[1].get(m).is_some_and(|other| *other < time * (1.0 - SAME)) {
            m += 1;
        }
        if times[1].get(m).is_some_and(|other| (other - time).abs() <= SAME * time.abs()) {
            pairs.push([n, m]);
            m += 1;
        }
    }
    pairs
}

fn pressure(readers: [&Reader; 2]) -> Result<Option<f64>, StoreError> {
    let [a, b] = readers.map(Reader::header);
    let stored = |reader: &Reader| {
        reader.header().fields.contains(&FieldKind::Pressure) && !reader.field_times().is_empty()
    };
    if a.grid != b.grid || !readers.into_iter().all(stored) {
        return Ok(None);
    }
    let [a, b] = readers.map(|reader| reader.field(FieldKind::Pressure, At::Last));
    let (a, b) = (a?, b?);
    let largest = a.iter().copied().fold(0.0, f64::max);
    let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    Ok(Some(if off == 0.0 { 0.0 } else { off / largest }))
}

/// Keys with different values: of the case files, or, where a result was not made from one, of what results say of their case.
fn cases(readers: [&Reader; 2]) -> BTreeMap<String, [Option<String>; 2]> {
    let texts = readers.map(|reader| reader.header().case_text.parse::<toml::Table>().ok());
    let keys = match texts {
        [Some(a), Some(b)] if !a.is_empty() && !b.is_empty() => [a, b].map(|table| {
            let value = serde_json::to_value(table).unwrap_or_default();
            flat(&value)
        }),
        _ => readers.map(|reader| flat(&serde_json::Value::Object(reader.header().setup.clone()))),
    };
    let mut found = BTreeMap::new();
    for key in keys[0].keys().chain(keys[1].keys()) {
        let pair = [0, 1].map(|n| keys[n].get(key).cloned());
        if pair[0] != pair[1] {
            found.insert(key.clone(), pair);
        }
    }
    found
}

/// Every number and text of a table by its dotted key.
fn flat(value: &serde_json::Value) -> BTreeMap<String, String> {
    fn walk(value: &serde_json::Value, path: &str, into: &mut BTreeMap<String, String>) {
        match value {
            serde_json::Value::Object(table) => {
                for (key, value) in table {
                    let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                    walk(value, &path, into);
                }
            }
            serde_json::Value::Array(list) if list.iter().any(serde_json::Value::is_object) => {
                list.iter().enumerate().for_each(|(n, value)| walk(value, &format!("{path}[{n}]"), into));
            }
            value => {
                into.insert(path.to_owned(), value.to_string());
            }
        }
    }
    let mut into = BTreeMap::new();
    walk(value, "", &mut into);
    into
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_at_the_same_times_are_paired_and_those_of_a_jump_in_order() {
        let times = [vec![0.0, 1.0, 2.0, 2.0, 3.0], vec![0.0, 0.5, 1.0 + 1e-14, 2.0, 2.0, 2.5]];
        assert_eq!(common(&times), [[0, 0], [1, 2], [2, 3], [3, 4]]);
    }

    #[test]
    fn tables_become_dotted_keys() {
        let table: toml::Table = "[a]\nb = 1\n[[c]]\nd = \"x\"\n[[c]]\nd = [1, 2]".parse().unwrap();
        let keys = flat(&serde_json::to_value(table).unwrap());
        let expected = [("a.b", "1"), ("c[0].d", "\"x\""), ("c[1].d", "[1,2]")];
        assert_eq!(keys, expected.map(|(key, value)| (key.to_owned(), value.to_owned())).into());
    }
}
