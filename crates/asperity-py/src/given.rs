//! What Python gives, as the library takes it: keys and values of a case, words, grids.

use asperity::Grid;
use asperity_io::choice::{self, Choice};
use asperity_io::resources;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::{Table, Value};

use crate::error::{Answer, Failure};

/// Numbers in a row and of cells that Python gives, and a dictionary.
pub type List<'py> = PyReadonlyArray1<'py, f64>;
pub type Plane<'py> = PyReadonlyArray2<'py, f64>;
pub type Dict<'py> = Bound<'py, PyDict>;
/// Numbers in a row and of cells, for Python.
pub type Numbers<'py> = Bound<'py, PyArray1<f64>>;
pub type Map<'py> = Bound<'py, PyArray2<f64>>;

/// A dictionary as the keys of a case; numbers keep every bit.
pub fn table(given: &Dict<'_>) -> Answer<Table> {
    inside("", given)
}

/// The table at this path.
fn inside(path: &str, given: &Dict<'_>) -> Answer<Table> {
    let entry = |(key, given): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key = key.str()?.to_string();
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        Ok((key, value(&path, &given)?))
    };
    given.iter().map(entry).collect()
}

/// The deepest table or list of a case lies above this; what is deeper may hold itself.
const DEEPEST: usize = 32;

fn value(path: &str, given: &Bound<'_, PyAny>) -> Answer<Value> {
    if path.matches(['.', '[']).count() > DEEPEST {
        let words =
            format!("{path} lies more than {DEEPEST} tables and lists deep, which no key of a case does");
        return Err(Failure::case(words));
    }
    if let Ok(table) = given.cast::<PyDict>() {
        return inside(path, table).map(Value::Table);
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        let list = given.try_iter()?.enumerate();
        return list
            .map(|(n, one)| value(&format!("{path}[{n}]"), &one?))
            .collect::<Answer<_>>()
            .map(Value::Array);
    }
    if given.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.is_instance_of::<PyString>() {
        return Ok(Value::String(given.extract()?));
    }
    if given.is_instance_of::<PyInt>() {
        // What is larger than any count is a number.
        return Ok(given.extract().map(Value::Integer).or_else(|_| given.extract().map(Value::Float))?);
    }
    let wrong = match given.cast::<PyFloat>().map(|number| number.extract::<f64>()) {
        Ok(number) => match number? {
            number if number.is_nan() => "NaN, but must be a number".to_owned(),
            number => return Ok(Value::Float(number)),
        },
        Err(_) if given.is_none() => "None, but a case is a table of keys and values".to_owned(),
        Err(_) => {
            format!("{}, which a case file cannot hold; write quantities as text with units", given.repr()?)
        }
    };
    Err(Failure::case(format!("{path} is {wrong}")))
}

/// The keys of a table as a dictionary.
pub fn dictionary<'py>(py: Python<'py>, table: &Table) -> PyResult<Dict<'py>> {
    let out = PyDict::new(py);
    for (key, value) in table {
        out.set_item(key, object(py, value)?)?;
    }
    Ok(out)
}

fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Table(table) => dictionary(py, table)?.into_any(),
        Value::Array(list) => {
            let list = list.iter().map(|one| object(py, one)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, list)?.into_any()
        }
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(truth) => truth.into_pyobject(py)?.to_owned().into_any(),
        other => other.as_str().unwrap_or_default().into_pyobject(py)?.into_any(),
    })
}

/// The choice that a keyword names, or an error with the words that it takes.
pub fn choose<T: Choice>(what: &str, word: &str) -> Answer<T> {
    choice::parse(word).ok_or_else(|| {
        let words: Vec<_> = choice::words::<T>().iter().map(|word| format!("'{word}'")).collect();
        Failure::case(format!("{what} is '{word}', but must be {}", words.join(" or ")))
    })
}

/// The grid of a field: a plane with two lengths, a line with one.
pub fn grid_of((nx, ny): (usize, usize), size: &[f64]) -> Answer<Grid> {
    let grid = match *size {
        [length] if ny == 1 => Grid::line(nx, length),
        [lx, ly] => Grid::new([nx, ny], [lx, ly]),
        _ => {
            return Err(Failure::case("size needs two lengths, along x and y, or one for a line of cells"));
        }
    };
    let grid = grid?;
    // Heights, and a copy of them.
    memory(&grid, 16 * grid.len())?;
    Ok(grid)
}

/// Refuses work on a grid that takes more memory than there is.
pub fn memory(grid: &Grid, bytes: usize) -> Answer<()> {
    let [nx, ny] = grid.cells();
    let refused = |reason: String| Failure::case(format!("{reason}; take fewer cells"));
    resources::check_memory(&format!("{nx} x {ny} cells"), bytes as u64).map_err(refused)
}

/// Sets items of a dictionary to the fields of these names.
macro_rules! entries {
    ($out:expr, $from:expr; $($name:ident)*) => {
        $($out.set_item(stringify!($name), &$from.$name)?;)*
    };
}
pub(crate) use entries;
