//! Comma-separated values (RFC 4180), for spreadsheets.
//!
//! One row per step under a line of names with units. Chosen fields go to files beside it, as matrices: the
//! first line holds y, the first column x, in metres; of a line contact, as two columns, x and the value.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::contents::{Contents, Data, Map, TIME, Variable};
use super::error::{Result, WriteError};
use super::output::{self, Output};

pub(super) fn export(contents: &Contents<'_>, path: &Path, force: bool) -> Result<Vec<PathBuf>> {
    // Said before anything is written.
    let maps: Vec<_> = contents
        .variables
        .iter()
        .filter(|variable| matches!(variable.data, Data::Field(_)))
        .flat_map(|variable| (0..contents.instants.len()).map(move |n| (variable, n)))
        .map(|(variable, n)| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let name = format!("{stem}_{}_{:04}.csv", variable.name, contents.instants[n]);
            (variable, n, path.with_file_name(name))
        })
        .collect();
    maps.iter().try_for_each(|(.., path)| output::check(path, force))?;
    let mut made = output::file(path, force, |file| series(contents, file))?;
    for (variable, n, path) in &maps {
        let heading = named(variable);
        made.extend(output::file(path, force, |file| match contents.map(&variable.data, *n)? {
            Some(Map::Real(map)) => matrix(contents, file, &heading, |i, j| number(map[(i, j)])),
            Some(Map::Byte(map)) => matrix(contents, file, &heading, |i, j| map[(i, j)].to_string()),
            None => Ok(()),
        })?);
    }
    Ok(made)
}

fn series(contents: &Contents<'_>, file: &mut Output) -> Result<(), WriteError> {
    let columns: Vec<_> = contents.variables.iter().filter(|v| v.dimensions == [TIME]).collect();
    line(file, columns.iter().map(|variable| named(variable)))?;
    for row in 0..contents.dimensions[TIME].1 {
        line(
            file,
            columns.iter().map(|column| match &column.data {
                Data::Reals(reals) => number(reals[row]),
                Data::Counts(counts) => counts[row].to_string(),
                _ => String::new(),
            }),
        )?;
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
    file: &mut Output,
    heading: &str,
    cell: impl Fn(usize, usize) -> String,
) -> Result<(), WriteError> {
    let grid = &contents.reader().header().grid;
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

fn line(file: &mut Output, cells: impl Iterator<Item = String>) -> Result<(), WriteError> {
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
