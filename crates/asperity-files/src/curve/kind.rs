//! What was measured, from the names of the columns and of the step.
//!
//! Rheometers write a compliance and its reciprocal, "modulus", in one table, whatever the step was. Only the constant quantity tells what they are:
//! in creep, J(t) = strain/stress is a material function and 1/J is not G; in relaxation, G(t) = stress/strain is one and 1/G is not J.

use super::Kind;
use super::columns::{self, named_column};
use super::error::{Remedy, Result, fault};
use super::role::{self, Role};
use super::table::Table;

/// A quantity that a step holds changes by no more than the first share, and one that answers by no less than the second.
const HELD: f64 = 0.02;
const ANSWERS: f64 = 0.05;

/// What a table holds according to its header; `sheet` is its name in a spreadsheet.
///
/// # Errors
/// A modulus and a compliance over time, if nothing says whether the step was one of relaxation or of creep, or strain and stress
/// say that it was the other one.
pub(super) fn of(table: &Table, sheet: Option<&str>) -> Result<Option<Kind>> {
    // An instrument that gives storage and loss modulus also gives times.
    if columns::is_dynamic(table) && !columns::named(table, Kind::Dma) {
        return Ok(None);
    }
    let named = |kind: Kind| columns::named(table, kind);
    if named(Kind::Dma) {
        return Ok(Some(Kind::Dma));
    }
    let (relaxation, creep) = (named(Kind::Relaxation), named(Kind::Creep));
    let (called, answered) = (called(table, sheet), answered(table));
    match (relaxation, creep) {
        (false, false) => {
            match (0..table.headings.len()).find(|column| is_creep_modulus(&table.headings[*column].name)) {
                Some(column) => Err(creep_modulus(table, column)),
                None => Ok(None),
            }
        }
        (true, true) => match (called, answered) {
            (Some(kind), None) => Ok(Some(kind)),
            (Some(kind), Some((by, _))) if kind == by => Ok(Some(kind)),
            (called, answered) => Err(both(table, called, answered)),
        },
        _ => {
            let kind = if relaxation { Kind::Relaxation } else { Kind::Creep };
            match answered {
                Some((by, why)) if by != kind && called != Some(kind) => Err(fault(format!(
                    "{why}: a step of {}, in which the {} over time is not that of the material, but one over its {}; add a column of that, {} over {}",
                    name(by),
                    quantity(kind),
                    quantity(by),
                    if by == Kind::Creep { "strain" } else { "stress" },
                    if by == Kind::Creep { "stress" } else { "strain" },
                ))
                .remedy(Remedy::Kind)),
                _ => Ok(Some(kind)),
            }
        }
    }
}

/// Whether a column is named as a creep modulus, the stress over a strain that grows.
pub(super) fn is_creep_modulus(name: &str) -> bool {
    let name = role::bare(name);
    ["creepmodul", "kriechmodul", "moduledefluage"].iter().any(|start| name.starts_with(start))
}

/// The error for a creep modulus, which is no relaxation modulus.
pub(super) fn creep_modulus(table: &Table, column: usize) -> super::error::CurveError {
    fault(format!(
        "column {}{} holds a creep modulus, stress over the strain that grows: it is no relaxation modulus, but its reciprocal is the creep \
         compliance; write that to a column, as in \"creep compliance [1/MPa]\"",
        column + 1,
        table.quoted(column)
    ))
}

/// What a table most likely holds whose header does not say it: a table of two columns or of times no DMA.
pub(super) fn likely(table: &Table) -> Kind {
    match table.headings.len() <= 2 || named_column(table, Role::Time, Kind::Relaxation).is_some() {
        true => Kind::Relaxation,
        false => Kind::Dma,
    }
}

fn name(kind: Kind) -> &'static str {
    if kind == Kind::Creep { "creep" } else { "relaxation" }
}

fn quantity(kind: Kind) -> &'static str {
    if kind == Kind::Creep { "compliance" } else { "modulus" }
}

/// The error for a modulus and a compliance.
fn both(table: &Table, called: Option<Kind>, answered: Option<(Kind, String)>) -> super::error::CurveError {
    let column = |role: Role, kind: Kind| {
        named_column(table, role, kind)
            .map_or(String::new(), |column| format!("column {}{}", column + 1, table.quoted(column)))
    };
    let (modulus, compliance) =
        (column(Role::Modulus, Kind::Relaxation), column(Role::Compliance, Kind::Creep));
    let hint = match (called, answered) {
        (Some(called), Some((_, why))) => format!("; the step is called one of {}, but {why}", name(called)),
        (None, Some((kind, why))) => format!("; {why}, as in {}", name(kind)),
        _ => String::new(),
    };
    fault(format!(
        "the file holds a modulus ({modulus}) and a compliance ({compliance}) over time, one of which is only the reciprocal of the other: in a \
         relaxation test (constant strain) the modulus is that of the material, in a creep test (constant stress) the compliance{hint}"
    ))
    .remedy(Remedy::Kind)
}

/// What the sheet, the lines above the table and the names of its columns call the step.
fn called(table: &Table, sheet: Option<&str>) -> Option<Kind> {
    let headings = table.headings.iter().map(|heading| heading.header.as_str());
    let words = table
        .above()
        .map(str::to_lowercase)
        .chain(headings.map(str::to_lowercase))
        .chain(sheet.map(str::to_lowercase));
    let (mut relaxation, mut creep) = (false, false);
    for text in words {
        relaxation |= text.contains("relax");
        creep |= ["creep", "kriech", "retardation"].iter().any(|word| text.contains(word));
    }
    match (relaxation, creep) {
        (true, false) => Some(Kind::Relaxation),
        (false, true) => Some(Kind::Creep),
        _ => None,
    }
}

/// What strain and stress say of the step, and why in words.
fn answered(table: &Table) -> Option<(Kind, String)> {
    // Steps at several temperatures may differ in strain and stress.
    if named_column(table, Role::Temperature, Kind::Relaxation).is_some_and(|column| {
        change(&table.sparse(column).unwrap_or_default()).is_none_or(|change| change > HELD)
    }) {
        return None;
    }
    let of = |starts: &[&str], not: &[&str]| {
        let is = |column: &usize| {
            let name = role::bare(&table.headings[*column].name);
            starts.iter().any(|start| name.starts_with(start)) && !not.iter().any(|word| name.contains(word))
        };
        let column = (0..table.headings.len()).find(is)?;
        let change = change(&table.sparse(column).ok()?)?;
        Some((change, table.headings[column].header.clone()))
    };
    let strain =
        of(&["strain", "shearstrain", "dehnung", "scherdehnung", "deformation", "scherung"], &["rate"]);
    let stress = of(&["stress", "shearstress", "spannung", "schubspannung"], &["relax"]);
    let grows = |(change, header): (f64, String)| {
        format!("{header:?} changes by {:.0} % during the step", 100.0 * change)
    };
    let rests = |(_, header): (f64, String)| format!("{header:?} is constant during the step");
    let held = |found: &(f64, String)| found.0 <= HELD;
    let moved = |found: &(f64, String)| found.0 >= ANSWERS;
    match (strain, stress) {
        (Some(strain), Some(stress)) if moved(&strain) && held(&stress) => {
            Some((Kind::Creep, format!("{} and {}", grows(strain), rests(stress))))
        }
        (Some(strain), Some(stress)) if held(&strain) && moved(&stress) => {
            Some((Kind::Relaxation, format!("{} and {}", rests(strain), grows(stress))))
        }
        (Some(strain), None) if moved(&strain) => Some((Kind::Creep, grows(strain))),
        (None, Some(stress)) if moved(&stress) => Some((Kind::Relaxation, grows(stress))),
        _ => None,
    }
}

/// The range of a column after its first tenth, in which a step is applied, as a share of its largest value.
fn change(numbers: &[Option<f64>]) -> Option<f64> {
    let numbers: Vec<f64> = numbers.iter().flatten().copied().collect();
    let rest = &numbers[numbers.len() / 10..];
    let [low, high] =
        rest.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
    let size = low.abs().max(high.abs());
    (rest.len() >= 5 && size > 0.0).then(|| (high - low) / size)
}
