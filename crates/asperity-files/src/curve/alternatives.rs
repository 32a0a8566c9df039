//! A quantity that stands in several columns: in two units, as frequency and as angular frequency, as E and as G, as the time of the step and of
//! the whole test.
//!
//! The column whose unit is known is taken. The others must hold the same, or the caller must say which is meant. A loss factor beside both
//! moduli must be their quotient, or a unit is wrong.

use std::collections::BTreeMap;

use super::columns::{Columns, Form, means, powers, unit_of};
use super::error::{Remedy, Result, fault};
use super::role::{self, Role};
use super::sweeps::SAME_TEMPERATURE;
use super::table::{Table, half_digit};
use super::units::convert;

/// Numbers of one quantity differ by no more, besides the rounding of their last digits.
const SAME: f64 = 0.02;
/// A loss factor differs from the quotient of the moduli by no more: programs smooth both.
const SAME_QUOTIENT: f64 = 0.1;

/// The column of these that holds a quantity best.
pub(super) fn best(
    table: &Table,
    role: Role,
    candidates: impl Iterator<Item = usize>,
    said: &Columns,
) -> Option<usize> {
    let candidates: Vec<usize> = candidates.collect();
    if let [only] = candidates[..] {
        return Some(only);
    }
    let worth = |column: &usize| {
        let unit = unit_of(&table.headings[*column], role, said);
        let is_known = convert(role, &unit, Vec::new()).is_ok();
        let numbers = table.sparse(*column).map_or(0, |numbers| numbers.iter().flatten().count());
        (is_known, is_specific(table, *column, role), !unit.is_empty(), 2 * numbers > table.rows.len())
    };
    // Of several, the first.
    candidates.into_iter().rev().max_by_key(worth)
}

/// Whether a name says that a time is that of the step, or a temperature that of the sample: other ones may differ.
fn is_specific(table: &Table, column: usize, role: Role) -> bool {
    let starts: &[&str] = match role {
        Role::Time => &["step", "relax", "creep"],
        Role::Temperature => &["sample", "probe", "tsample", "tprobe", "ts"],
        _ => return false,
    };
    let name = role::bare(&table.headings[column].name);
    starts.iter().any(|start| name.starts_with(start))
}

/// Whether the name of a column is that of another one and says what was done to it.
fn is_treated(table: &Table, column: usize, other: usize) -> bool {
    const WORDS: [&str; 8] = ["corr", "korr", "raw", "roh", "smooth", "filter", "avg", "shifted"];
    let [name, other] = [column, other].map(|column| role::bare(&table.headings[column].name));
    let rest = other.strip_prefix(&name).or_else(|| other.strip_suffix(&name));
    !name.is_empty() && rest.is_some_and(|rest| WORDS.iter().any(|word| rest.starts_with(word)))
}

/// Notes on columns that hold another time or temperature and are not read.
///
/// # Errors
/// Where another column of a quantity holds something else, or a loss factor is not the quotient of the moduli.
pub(super) fn agree(
    table: &Table,
    form: Form,
    places: &BTreeMap<Role, usize>,
    said: &Columns,
) -> Result<Vec<String>> {
    let mut notes = Vec::new();
    for (role, column) in places {
        if *role == Role::Set || said.columns.contains_key(role) {
            continue;
        }
        let is_other = |other: &usize| {
            (means(table, *other, *role, form) || is_treated(table, *column, *other))
                && !places.values().any(|used| used == other)
        };
        for other in (0..table.headings.len()).filter(is_other) {
            let Some((line, here, there)) = difference(table, *role, [*column, other], said) else {
                continue;
            };
            let (name, places) = (role.name(), [*column, other].map(|column| place(table, column)));
            if is_specific(table, *column, *role) && !is_specific(table, other, *role) {
                notes.push(format!("{name} is that of {}; that of {} is another one", places[0], places[1]));
                continue;
            }
            return Err(fault(format!(
                "{} and {} are both named as {name}, and hold different values, {here:.6e} and {there:.6e} {}: which one is it?",
                places[0],
                places[1],
                role.si()
            ))
            .remedy(Remedy::Column(*role))
            .at(line));
        }
    }
    quotient(table, form, places, said).map(|()| notes)
}

fn place(table: &Table, column: usize) -> String {
    format!("column {}{}", column + 1, table.quoted(column))
}

/// The first line on which two columns of a quantity differ, and both values in SI; none where they agree or a unit is not known.
fn difference(
    table: &Table,
    role: Role,
    [first, second]: [usize; 2],
    said: &Columns,
) -> Option<(usize, f64, f64)> {
    let rows = common(table, [first, second])?;
    // What the caller says of the unit holds for the column that is read.
    let (a, b) =
        (in_si(table, role, first, &rows, said)?, in_si(table, role, second, &rows, &Columns::default())?);
    let most = |a: f64, b: f64| match role {
        Role::Temperature => SAME_TEMPERATURE,
        _ => SAME * a.abs().max(b.abs()),
    };
    let differ = |n: &usize| (a[*n][0] - b[*n][0]).abs() > most(a[*n][0], b[*n][0]) + a[*n][1] + b[*n][1];
    let n = (0..rows.len()).find(differ)?;
    Some((table.rows[rows[n]].line, a[n][0], b[n][0]))
}

/// The rows in which all of the columns hold numbers.
fn common<const N: usize>(table: &Table, columns: [usize; N]) -> Option<Vec<usize>> {
    let numbers: Vec<Vec<Option<f64>>> =
        columns.iter().map(|column| table.sparse(*column)).collect::<Result<_>>().ok()?;
    Some((0..table.rows.len()).filter(|row| numbers.iter().all(|column| column[*row].is_some())).collect())
}

/// Numbers of a column in SI, and how much half of their last digits is.
fn in_si(table: &Table, role: Role, column: usize, rows: &[usize], said: &Columns) -> Option<Vec<[f64; 2]>> {
    let heading = &table.headings[column];
    let unit = unit_of(heading, role, said);
    let convert = |numbers: Vec<f64>| -> Option<Vec<f64>> {
        let numbers = match heading.base {
            Some(base) => powers(base, &numbers).ok()?,
            None => numbers,
        };
        convert(role, &unit, numbers).ok()
    };
    let numbers: Vec<f64> =
        rows.iter().map(|row| table.number(&table.rows[*row], column)).collect::<Result<_>>().ok()?;
    let half = |(row, number): (&usize, &f64)| number + half_digit(table.cell(&table.rows[*row], column));
    let halves = convert(rows.iter().zip(&numbers).map(half).collect())?;
    let values = convert(numbers)?;
    Some(values.iter().zip(halves).map(|(value, half)| [*value, (half - value).abs()]).collect())
}

/// # Errors
/// Where a column of loss factors stands beside both moduli, and is not their quotient.
fn quotient(table: &Table, form: Form, places: &BTreeMap<Role, usize>, said: &Columns) -> Result<()> {
    let (Some(storage), Some(loss)) = (places.get(&Role::Storage), places.get(&Role::Loss)) else {
        return Ok(());
    };
    let said_so = [Role::Storage, Role::Loss].iter().any(|role| said.columns.contains_key(role));
    let Some(tan) = (0..table.headings.len()).find(|column| means(table, *column, Role::TanDelta, form))
    else {
        return Ok(());
    };
    // Quotients over loss factors, each with what its digits leave open.
    let ratios = || -> Option<Vec<[f64; 2]>> {
        let rows = common(table, [*storage, *loss, tan])?;
        let a = in_si(table, Role::Storage, *storage, &rows, said)?;
        let b = in_si(table, Role::Loss, *loss, &rows, said)?;
        let t = in_si(table, Role::TanDelta, tan, &rows, said)?;
        let triples = a.iter().zip(&b).zip(&t).map(|((a, b), t)| [*a, *b, *t]);
        let positive = triples.filter(|triple| triple.iter().all(|[value, _]| *value > 0.0));
        let ratio = |[a, b, t]: [[f64; 2]; 3]| {
            let open: f64 = [a, b, t].iter().map(|[value, half]| half / value).sum();
            [b[0] / a[0] / t[0], SAME_QUOTIENT + open]
        };
        Some(positive.map(ratio).collect())
    };
    let mut ratios = ratios().filter(|_| !said_so).unwrap_or_default();
    let is_wrong = |[ratio, open]: &&[f64; 2]| *ratio > 1.0 + open || *ratio * (1.0 + open) < 1.0;
    let wrong = ratios.iter().filter(is_wrong).count();
    ratios.sort_by(|a, b| a[0].total_cmp(&b[0]));
    match ratios.get(ratios.len() / 2) {
        Some([median, _]) if 2 * wrong > ratios.len() => Err(fault(format!(
            "{} over {} is {median:.3e} times the loss factor of {}: is the unit of a modulus wrong? (columns that are named to \
             be read are not compared)",
            place(table, *loss),
            place(table, *storage),
            place(table, tan)
        ))
        .remedy(Remedy::Unit(Role::Loss))),
        _ => Ok(()),
    }
}
