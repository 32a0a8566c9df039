//! Shift factors that a file holds: a table of temperature and factor, or the constants of the WLF law.

use std::f64::consts::LN_10;
use std::path::Path;

use asperity::material::Shift;

use super::bytes;
use super::error::{CurveError, Remedy, fault};
use super::names::split_unit;
use super::role::{Role, bare};
use super::table::{Heading, Table};
use super::units::{kelvin, tidy};
use super::workbook::{Sheet, sheets};
use crate::topography::leading_number;

/// The shift that a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeldShift {
    /// Its list of factors.
    pub list: Option<Shift>,
    /// Its constants of the WLF law.
    pub wlf: Option<Shift>,
    /// Why a list of factors of the file cannot be used.
    pub refused: Option<String>,
}

impl HeldShift {
    /// The list, which is measured, or else the law.
    pub fn shift(&self) -> Option<&Shift> {
        self.list.as_ref().or(self.wlf.as_ref())
    }
}

/// Shift factors from a table with a column of temperatures and one of log10 a_T (log_aT), ln a_T or a_T; a_T is the factor
/// by which processes take longer than at the reference temperature, so that it falls with temperature.
///
/// # Errors
/// [`CurveError`] if there are no such columns, the unit is not one of temperature, the factors rise with temperature, or a
/// temperature occurs twice.
pub fn read_shift_table(path: &Path) -> Result<Shift, CurveError> {
    let read = || -> Result<Shift, CurveError> {
        let mut last = None;
        for sheet in sheets(&bytes(path)?, None)? {
            match sheet.table.and_then(|table| factors(&table, None)) {
                Ok(shift) => return Ok(shift),
                Err(fault) => last = Some(fault),
            }
        }
        Err(last.unwrap_or_else(|| fault("the file holds no table")))
    };
    read().map_err(|fault| fault.of(path))
}

/// The shift that the sheets of a spreadsheet hold.
pub(super) fn held(sheets: &[Sheet]) -> HeldShift {
    let mut found = HeldShift::default();
    for sheet in sheets {
        let reference =
            labelled(&sheet.cells, &["reftemp", "referencetemperature", "tref", "referenztemperatur"]);
        let reference =
            reference.and_then(|(value, unit)| kelvin(value, &tidy(Role::Temperature, "", &unit)).ok());
        if let (Some(c1), Some(c2), Some(reference)) =
            (constant(&sheet.cells, "c1"), constant(&sheet.cells, "c2"), reference)
        {
            let wlf = Shift::Wlf { c1, c2, reference };
            found.wlf = found.wlf.or(Some(wlf).filter(|shift| shift.validate().is_ok()));
        }
        if let Ok(table) = &sheet.table {
            let celsius = reference.is_some().then_some("°C");
            match factors(table, celsius) {
                Ok(shift) => found.list = found.list.or(Some(shift)),
                Err(_) if !told_by(table) => {}
                Err(_) => {
                    let vertical = vertical_free(table).err().map(|fault| fault.message);
                    found.refused = found.refused.or(vertical);
                }
            }
        }
    }
    found
}

/// The value with a label: in the next cell that is not empty, or below it under a line of units. A unit may stand behind the number, in
/// the label ("Tref [°C]"), or between them.
fn labelled(cells: &[Vec<String>], labels: &[&str]) -> Option<(f64, String)> {
    let labels_it = |cell: &str| labels.contains(&bare(split_unit(cell).0).as_str());
    let place = |(n, row): (usize, &Vec<String>)| {
        let at = row.iter().position(|cell| labels_it(cell))?;
        let mut unit = split_unit(&row[at]).1.to_owned();
        if let Some(found) = row[at + 1..].iter().find(|cell| !cell.is_empty()).and_then(|cell| number(cell))
        {
            return Some((found.0, if found.1.is_empty() { unit } else { found.1 }));
        }
        for below in cells[n + 1..].iter().take(2).filter_map(|row| row.get(at)) {
            match number(below) {
                Some((value, own)) => return Some((value, if own.is_empty() { unit } else { own })),
                None => unit = below.trim_matches(['[', ']', '(', ')', ' ']).to_owned(),
            }
        }
        None
    };
    cells.iter().enumerate().find_map(place)
}

/// "25.0 °C" or "13,5": a number, and what follows it.
fn number(text: &str) -> Option<(f64, String)> {
    leading_number(text.trim_start_matches([':', '=', ' '])).map(|(value, rest)| (value, rest.to_owned()))
}

/// The number of "C1 : 13.50" or of "C1" and "13.50" in another cell.
fn constant(cells: &[Vec<String>], name: &str) -> Option<f64> {
    let joined = |cell: &String| {
        let rest = cell
            .get(..name.len())
            .filter(|start| start.eq_ignore_ascii_case(name))
            .map(|_| &cell[name.len()..])?;
        number(rest)
    };
    let found = cells.iter().flatten().find_map(joined).or_else(|| labelled(cells, &[name]));
    found.map(|(value, _)| value)
}

/// ln a_T at the reference temperature, at most.
const SAME: f64 = 1e-9;

/// How a column of factors is written.
#[derive(Clone, Copy)]
enum Written {
    Log10,
    Ln,
    Plain,
}

/// How a column of this name writes factors.
fn written(name: &str) -> Option<Written> {
    match bare(name).as_str() {
        "logat" | "log10at" | "lgat" | "logshift" | "logshiftfactor" | "shift" => Some(Written::Log10),
        "lnat" => Some(Written::Ln),
        "at" | "shiftfactor" | "shiftfactorat" => Some(Written::Plain),
        _ => None,
    }
}

/// The column of factors, and how they are written.
fn column_of_factors(table: &Table) -> Option<(usize, Written)> {
    table.headings.iter().enumerate().find_map(|(n, heading)| {
        let by_name = || match (written(&heading.name)?, heading.base) {
            (Written::Plain, Some(10.0)) => Some(Written::Log10),
            (Written::Plain, Some(_)) => Some(Written::Ln),
            (how, _) => Some(how),
        };
        // The brackets of "log10(aT)" hold no unit.
        Some((n, written(&heading.header).or_else(by_name)?))
    })
}

/// Whether a table has a column of shift factors.
pub(super) fn told_by(table: &Table) -> bool {
    column_of_factors(table).is_some()
}

/// The factors of a table; temperatures without a unit are in `unit`, or kelvin.
fn factors(table: &Table, unit: Option<&str>) -> Result<Shift, CurveError> {
    let is_temperature = |heading: &Heading| {
        ["t", "temp", "temperature", "temperatur"].contains(&bare(&heading.name).as_str())
    };
    let temperature = table.headings.iter().position(is_temperature);
    let factor = column_of_factors(table);
    let (Some(temperature), Some((column, how))) = (temperature, factor) else {
        return Err(fault(format!(
            "a table of shift factors has a column of temperatures (T) and one of log_aT, ln_aT or aT; the file has {}",
            table.listed()
        )));
    };
    let unit = match tidy(Role::Temperature, "", &table.headings[temperature].unit) {
        none if none.is_empty() => unit.unwrap_or_default().to_owned(),
        unit => unit,
    };
    vertical_free(table)?;
    let mut points = Vec::with_capacity(table.rows.len());
    let numbers = table.numbers(temperature)?.into_iter().zip(table.numbers(column)?);
    for ((value, factor), row) in numbers.zip(&table.rows) {
        let kelvin = kelvin(value, &unit).map_err(|why| {
            fault(format!("temperature: {why}")).remedy(Remedy::Unit(Role::Temperature)).at(row.line)
        })?;
        let ln = match how {
            Written::Log10 => factor * LN_10,
            Written::Ln => factor,
            Written::Plain if factor > 0.0 => factor.ln(),
            Written::Plain => {
                return Err(fault(format!("the shift factor {factor} must be greater than 0")).at(row.line));
            }
        };
        points.push((kelvin, ln));
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let rises = points.first().zip(points.last()).is_some_and(|(cold, warm)| warm.1 > cold.1);
    if rises {
        return Err(fault(
            "the shift factors rise with temperature; a_T is the factor by which processes take longer than at the \
             reference, and falls (give one over it, or the logarithm with the other sign)",
        ));
    }
    let signs = points.iter().map(|(_, ln)| ln.signum() * f64::from(u8::from(ln.abs() > SAME)));
    if let Some(sign) = signs.reduce(|a, b| if a == b { a } else { 0.0 }).filter(|sign| *sign != 0.0) {
        let word = if sign > 0.0 { "above" } else { "below" };
        return Err(fault(format!(
            "all shift factors are {word} 1: the reference temperature, where a_T = 1 (log_aT = 0), is neither in the table nor between \
             its temperatures; add it"
        )));
    }
    let shift = Shift::Table { points };
    shift.validate().map_err(|error| fault(error.to_string()))?;
    Ok(shift)
}

/// Refuses a table whose moduli shift too, by a column of b_T that holds more than b_T = 1.
fn vertical_free(table: &Table) -> Result<(), CurveError> {
    for (n, Heading { name, base, .. }) in table.headings.iter().enumerate() {
        let whole = bare(name);
        let plain = ["log10", "log", "lg", "ln"].iter().find_map(|prefix| whole.strip_prefix(prefix));
        if !is_vertical(plain.unwrap_or(&whole)) {
            continue;
        }
        let logarithmic = plain.is_some() || base.is_some();
        let same = if logarithmic { 0.0 } else { 1.0 };
        if table.numbers(n).is_ok_and(|factors| factors.iter().all(|factor| (factor - same).abs() < SAME)) {
            continue;
        }
        return Err(fault(format!(
            "the table holds vertical factors too (\"{name}\"), which are not read from a file, because programs write b_T and one over \
             it, and without them the moduli are wrong; take the column out and give --vertical (density or free), or a list in a case, \
             as in vertical = [[\"0 °C\", 1.05], [\"20 °C\", 1.0]]"
        )));
    }
    Ok(())
}

/// Whether a bare name is that of factors of moduli: "bT", "vertical shift", "v_shift", "modulus factor".
fn is_vertical(name: &str) -> bool {
    ["b", "v", "y", "vshift", "yshift"].contains(&name)
        || ["bt", "vert", "modulus", "moduli", "modul"].iter().any(|start| name.starts_with(start))
        || name.ends_with("bt")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Shift, CurveError> {
        factors(&Table::parse(text.as_bytes()).unwrap(), None)
    }

    #[test]
    fn logarithms_and_factors_are_told_by_their_names() {
        let points = vec![(273.15, LN_10), (293.15, 0.0)];
        for text in [
            "T [°C];log aT (1)\n0;1\n20;0\n",
            "T [°F];log_aT\n32;1\n68;0\n",
            "\u{feff}T,log_aT\nC, -\n20,0\n0,1\n",
            "T [°C];log10(aT)\n0;1\n20;0\n",
            "Temperature (K), aT\n273.15, 10\n293.15, 1\n",
            "T [°C], log_aT, b_T\n0,1,1\n20,0,1\n",
        ] {
            let Shift::Table { points: found } = read(text).unwrap() else { panic!("{text}") };
            for (found, wanted) in found.iter().zip(&points) {
                assert!((found.0 - wanted.0).abs() < 1e-9 && (found.1 - wanted.1).abs() < 1e-12, "{text}");
            }
        }
    }

    #[test]
    fn a_wrong_table_is_named() {
        for (text, words) in [
            ("T [°C], log_aT\n0,-1\n20,0\n", "rise with temperature"),
            ("T [°C], factor\n0,1\n20,0\n", "log_aT, ln_aT or aT"),
            ("T [°C], aT\n0,10\n20,0\n", "greater than 0"),
            ("T, log_aT\n-20,1\n20,0\n", "temperature"),
            ("T [°C], log_aT\n0,4\n20,3\n", "all shift factors are above 1"),
            ("T [°C], log_aT, b_T\n0,1,1.05\n20,0,1\n", "vertical factors too (\"b_T\")"),
            ("T [°C], log_aT, log bT\n0,1,0.02\n20,0,0\n", "vertical factors too"),
            ("T [°C], log_aT, vertical\n0,1,1.05\n20,0,1\n", "vertical factors too"),
            ("T [°C], log_aT, vertical shift factor b_T\n0,1,1.05\n20,0,1\n", "vertical factors too"),
            ("T [°C], log_aT, v_shift\n0,1,1.05\n20,0,1\n", "vertical factors too"),
        ] {
            let fault = read(text).unwrap_err();
            assert!(fault.message.contains(words), "{text}: {fault:?}");
        }
    }

    #[test]
    fn constants_stand_in_cells_of_their_own_or_not() {
        let cells = |rows: &[&[&str]]| -> Vec<Vec<String>> {
            rows.iter().map(|row| row.iter().map(|cell| (*cell).to_owned()).collect()).collect()
        };
        for rows in [
            cells(&[&["Ref.Temp.", "25.0 °C"], &["WLF", "C1 : 13.50", "C2 : 141.19 K"]]),
            cells(&[&["Ref. Temp.", "25.0 °C"], &["C1", "13,5"], &["C2", "141.19"]]),
            cells(&[&["C1", "13.5"], &["C2", "141.19"], &["Tref [°C]", "25"]]),
            cells(&[&["C1", "C2", "Reference temperature"], &["", "K", "°C"], &["13.5", "141.19", "25"]]),
        ] {
            let sheet = Sheet { name: None, cells: rows, table: Err(fault("")) };
            let wlf = held(&[sheet]).wlf.unwrap();
            assert_eq!(wlf, Shift::Wlf { c1: 13.5, c2: 141.19, reference: 298.15 });
        }
    }
}
