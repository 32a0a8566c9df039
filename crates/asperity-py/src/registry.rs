//! What results may hold, as the library declares it.

use std::collections::BTreeMap;

use asperity::Grid;
use asperity::quantities::{Column, Quantity, RowNumber};
use asperity::stress::Rolling;
use asperity_io::store::{FieldKind, SCALARS, Series, StressSet, coordinates, leak_series};
use asperity_io::stress::Ratio;
use numpy::IntoPyArray;
use pyo3::prelude::*;

use crate::error::Answer;
use crate::given::{List, Numbers, choose};

/// Name, unit, unit on a line of cells, meaning, and kind: "real", "count", "vector" or "histogram".
type Entry = (&'static str, &'static str, &'static str, &'static str, &'static str);

/// All columns and fields by the part of a result that they belong to.
#[pyfunction]
pub fn registry() -> Answer<BTreeMap<&'static str, Vec<Entry>>> {
    let line = Grid::line(2, 1.0)?;
    let rows = SCALARS.iter().map(|scalar| {
        let kind = if scalar.is_count() { "count" } else { "real" };
        (scalar.name, scalar.units, line.units(scalar.units), scalar.long_name, kind)
    });
    let quantities = Quantity::ALL.map(|quantity| {
        let kind = match (quantity.components(), quantity.is_histogram()) {
            (Some(_), _) => "vector",
            (None, true) => "histogram",
            (None, false) => "real",
        };
        (quantity.name(), quantity.units(), quantity.units_on(&line), quantity.long_name(), kind)
    });
    let fields =
        FieldKind::ALL.map(|field| real(field.name(), field.units(), field.units(), field.long_name()));
    let on_line = stress(true);
    let stress = stress(false).into_iter().map(|Series { name, units, long_name }| {
        let line = on_line.iter().find(|series| series.name == name);
        real(name, units, line.map_or(units, |series| series.units), long_name)
    });
    let depth = real("depth", "m", "m", "depth below the surface");
    let leaks =
        |gas| leak_series(gas).map(|series| real(series.name, series.units, series.units, series.long_name));
    Ok(BTreeMap::from([
        ("rows", rows.collect()),
        ("quantities", quantities.to_vec()),
        ("fields", fields.to_vec()),
        ("stress", stress.chain([depth]).collect()),
        ("leaks", leaks(false).collect()),
        ("leaks of a gas", leaks(true).collect()),
    ]))
}

/// Name, unit and unit on a line of cells of the numbers that a stage can wait for.
#[pyfunction]
pub fn waitable() -> Answer<Vec<(&'static str, &'static str, &'static str)>> {
    let line = Grid::line(2, 1.0)?;
    let on_line = |number: RowNumber| match number {
        RowNumber::Column(column) => line.units(column.units),
        RowNumber::Quantity(quantity) => quantity.units_on(&line),
    };
    Ok(RowNumber::all().map(|number| (number.name(), number.units(), on_line(number))).collect())
}

fn real(name: &'static str, units: &'static str, on_line: &'static str, words: &'static str) -> Entry {
    (name, units, on_line, words, "real")
}

/// All that a result may hold of the stress below a plane contact, or a line contact.
fn stress(line: bool) -> Vec<Series> {
    let set = StressSet {
        body: String::new(),
        poisson: Ratio::Constant(0.0),
        line,
        depths: vec![],
        quantities: vec![],
        threshold: Some(0.0),
        yield_stress: None,
        rolling: Some(Rolling::X),
        instants: vec![],
    };
    [set.scalars(), set.profiles()].concat()
}

/// Name, unit, meaning and numbers of a coordinate.
type Coordinate<'py> = (&'static str, &'static str, &'static str, Numbers<'py>);

/// The coordinates of a histogram whose bins have these ends: the middles of its bins, and the ends.
#[pyfunction]
pub fn histogram_coordinates<'py>(
    py: Python<'py>,
    name: &str,
    edges: List<'_>,
    line: bool,
) -> Answer<Vec<Coordinate<'py>>> {
    let grid = if line { Grid::line(2, 1.0) } else { Grid::new([2, 2], [1.0, 1.0]) };
    let column = Column { quantity: choose("quantity", name)?, edges: edges.as_array().to_vec() };
    let found = coordinates(&column, &grid?);
    Ok(found
        .into_iter()
        .map(|(s, numbers)| (s.name, s.units, s.long_name, numbers.into_pyarray(py)))
        .collect())
}
