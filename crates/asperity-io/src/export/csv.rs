//! Comma-separated values (RFC 4180), for spreadsheets.
//!
//! One row per step under a line of names with units. Other numbers go to files beside it: `NAME_field_time.csv` (stress) and
//! `NAME_leak_time.csv` have one row per stored time; what depends on two numbers (stress by depth, histograms) and chosen
//! fields are matrices, whose first line and first column hold the coordinates in SI units (of a line contact, two columns: x and
//! the value).

use std::io::Write;
use std::path::{Path, PathBuf};

use super::contents::{Contents, Data, Map, TIME, Variable};
use super::error::{ExportError, Result};
use crate::output::{Output, PartialFile};

pub(super) fn export(contents: &Contents<'_>, path: &Path, force: bool) -> Result<Vec<PathBuf>> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let beside = |name: &str| path.with_file_name(format!("{stem}_{name}.csv"));
    // More than the coordinates of the dimension.
    let lists = |(n, (name, _)): (usize, &(&'static str, usize))| {
        let numbers =
            contents.variables.iter().filter(|v| v.dimensions == [n] && !v.name.starts_with("field_"));
        (n > TIME && numbers.filter(|v| !v.name.ends_with("_edge")).count() > 1).then(|| (n, beside(name)))
    };
    let lists: Vec<_> = contents.dimensions.iter().enumerate().filter_map(lists).collect();
    let table = |v: &&Variable| v.dimensions.len() == 2 && matches!(v.data, Data::Reals(_));
    let tables: Vec<_> = contents.variables.iter().filter(table).map(|v| (v, beside(v.name))).collect();
    // All are written before the first gets its name.
    let mut made = Vec::new();
    let mut make = |path: &Path, fill: &dyn Fn(&mut Output<'_>) -> Result<()>| {
        let partial = PartialFile::filled(path, force, fill).map_err(|error| error.at(path))?;
        made.push((partial, path.to_owned()));
        Ok::<(), ExportError>(())
    };
    make(path, &|file| series(contents, TIME, file))?;
    for (dimension, path) in &lists {
        make(path, &|file| series(contents, *dimension, file))?;
    }
    for (variable, path) in &tables {
        make(path, &|file| by_two(contents, variable, file))?;
    }
    for variable in contents.variables.iter().filter(|variable| variable.is_field()) {
        let heading = named(variable);
        for (n, instant) in contents.instants.iter().enumerate() {
            make(&beside(&format!("{}_{instant:04}", variable.name)), &|file| match contents
                .map(variable, n)?
            {
                Map::Real(map) => matrix(contents, file, &heading, |i, j| number(map[(i, j)])),
                Map::Byte(map) => matrix(contents, file, &heading, |i, j| map[(i, j)].to_string()),
            })?;
        }
    }
    let finish = |(partial, path): (PartialFile, PathBuf)| match partial.finish() {
        Ok(()) => Ok(path),
        Err(error) => Err(ExportError::from(error).at(&path)),
    };
    made.into_iter().map(finish).collect()
}

/// The numbers over one dimension; tensors over it with a column for each entry.
fn series(contents: &Contents<'_>, dimension: usize, file: &mut Output<'_>) -> Result<()> {
    let is_of = |v: &&Variable| {
        v.dimensions == [dimension] || v.dimensions.first() == Some(&dimension) && v.dimensions.len() == 3
    };
    let numbers = |v: &&Variable| matches!(v.data, Data::Reals(_) | Data::Counts(_));
    let columns: Vec<&Variable> = contents.variables.iter().filter(is_of).filter(numbers).collect();
    let names = columns.iter().flat_map(|v| match v.dimensions.len() {
        1 => vec![named(v)],
        _ => ["xx", "xy", "yx", "yy"]
            .map(|entry| named(v).replacen(v.name, &format!("{}_{entry}", v.name), 1))
            .to_vec(),
    });
    line(file, names)?;
    let rows = contents.dimensions[dimension].1;
    for row in 0..rows {
        let cells = columns.iter().flat_map(|column| match &column.data {
            Data::Reals(reals) => {
                let width = reals.len() / rows;
                reals[row * width..(row + 1) * width].iter().map(|x| number(*x)).collect()
            }
            Data::Counts(counts) => vec![counts[row].to_string()],
            _ => vec![],
        });
        line(file, cells)?;
    }
    Ok(())
}

/// The numbers of a variable over two dimensions.
fn by_two(contents: &Contents<'_>, variable: &Variable, file: &mut Output<'_>) -> Result<()> {
    let Data::Reals(numbers) = &variable.data else { return Ok(()) };
    let [rows, columns] = [0, 1].map(|axis| contents.dimensions[variable.dimensions[axis]]);
    let coordinate = |(name, length): (&str, usize)| {
        let found = contents.variables.iter().find(|v| v.name == name);
        match found.map(|v| (&v.data, v.units)) {
            Some((Data::Reals(places), units)) => (places.clone(), units),
            _ => ((0..length).map(|n| n as f64).collect(), "1"),
        }
    };
    let ((first, first_units), (second, second_units)) = (coordinate(rows), coordinate(columns));
    let corner = format!("{} [{first_units}] / {} [{second_units}]", rows.0, columns.0);
    line(file, std::iter::once(corner).chain(second.iter().map(|x| number(*x))))?;
    for (place, row) in first.iter().zip(numbers.chunks(columns.1.max(1))) {
        line(file, std::iter::once(number(*place)).chain(row.iter().map(|x| number(*x))))?;
    }
    Ok(())
}

/// "pressure [Pa]".
fn named(variable: &Variable) -> String {
    match variable.units {
        "1" => variable.name.to_owned(),
        units => format!("{} [{units}]", variable.name),
    }
}

/// A map as a matrix; on a line a column of places and one of values.
fn matrix(
    contents: &Contents<'_>,
    file: &mut Output<'_>,
    heading: &str,
    cell: impl Fn(usize, usize) -> String,
) -> Result<()> {
    let grid = &contents.reader.header().grid;
    let [nx, ny] = grid.cells();
    if grid.is_line() {
        line(file, ["x [m]".to_owned(), heading.to_owned()].into_iter())?;
        return (0..nx).try_for_each(|i| line(file, [number(grid.x(i)), cell(i, 0)].into_iter()));
    }
    let corner = std::iter::once("x [m] / y [m]".to_owned());
    line(file, corner.chain((0..ny).map(|j| number(grid.y(j)))))?;
    for i in 0..nx {
        line(file, std::iter::once(number(grid.x(i))).chain((0..ny).map(|j| cell(i, j))))?;
    }
    Ok(())
}

fn line(file: &mut Output<'_>, cells: impl Iterator<Item = String>) -> Result<()> {
    for (n, cell) in cells.enumerate() {
        let comma = if n > 0 { "," } else { "" };
        write!(file, "{comma}{cell}")?;
    }
    Ok(file.write_all(b"\r\n")?)
}

/// The shortest text that reads back to the same bits.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e7).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}
