//! Everything that must be said of a file, in one example: the header leaves several things open, and the error about the first of them
//! names them all.

use std::path::PathBuf;

use super::Kind;
use super::columns::{Column, Columns, Form, find, means, unit_of};
use super::role::Role;
use super::table::Table;
use super::units::is_angular;

/// What must be said of a file that is read as one of this kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Whole {
    /// The file.
    pub path: PathBuf,
    /// What was measured.
    pub kind: Kind,
    /// The columns; `None` where the caller must say which one it is.
    pub columns: Vec<(Role, Option<Column>)>,
    /// The units, those that the file leaves open as examples.
    pub units: Vec<(Role, String)>,
    /// The sheet, where the caller named it.
    pub sheet: Option<String>,
}

impl Whole {
    /// Of a table, where it leaves more than one thing open (`kind_open`: also the kind).
    pub(super) fn of(table: &Table, kind: Kind, said: &Columns, kind_open: bool) -> Option<Whole> {
        let form = Form::from(kind);
        let found = |role: Role| match said.columns.get(&role) {
            Some(column) => find(table, role, column).ok(),
            None => (0..table.headings.len()).find(|column| means(table, *column, role, form)),
        };
        let pair = form.pairs.iter().map(|(pair, _)| pair);
        let held = |pair: &&[Role; 2]| pair.iter().filter(|role| found(**role).is_some()).count();
        // The first of those with most columns.
        let pair = pair.rev().max_by_key(held).into_iter().flatten();
        let roles: Vec<Role> = form.needed.iter().chain(pair).copied().collect();
        let in_order = !table.is_named() && said.columns.is_empty() && table.headings.len() == roles.len();
        let place = |(n, role): (usize, Role)| if in_order { Some(n) } else { found(role) };
        let places: Vec<(Role, Option<usize>)> =
            roles.iter().enumerate().map(|(n, role)| (*role, place((n, *role)))).collect();
        let columns: Vec<(Role, Option<Column>)> = places
            .iter()
            .filter(|(role, place)| place.is_none() || said.columns.contains_key(role))
            .map(|(role, _)| (*role, said.columns.get(role).cloned()))
            .collect();
        let has_units = table.headings.iter().any(|heading| !heading.unit.is_empty());
        let units: Vec<(Role, String)> = places
            .iter()
            .filter_map(|(role, place)| open_unit(table, *role, *place, said, has_units))
            .collect();
        let open = columns.iter().filter(|(_, column)| column.is_none()).count()
            + units.iter().filter(|(role, _)| !said.units.contains_key(role)).count()
            + usize::from(kind_open);
        let sheet = said.sheet.clone();
        (open > 1).then(|| Whole { path: PathBuf::new(), kind, columns, units, sheet })
    }

    /// In the words of a case file, of the command and of Python.
    pub(super) fn words(&self) -> [String; 3] {
        let column = |column: &Option<Column>, named: fn(&str) -> String| match column {
            Some(Column::Number(n)) => n.to_string(),
            Some(Column::Name(name)) => named(name),
            None => "N".to_owned(),
        };
        let joined = |parts: Vec<String>, open: &str, close: &str| match parts.is_empty() {
            true => String::new(),
            false => format!("{open}{}{close}", parts.join(", ")),
        };
        let list = |pair: fn(&str, &str) -> String, quoted: fn(&str) -> String| {
            let columns =
                self.columns.iter().map(|(role, place)| pair(role.name(), &column(place, quoted))).collect();
            let units = self.units.iter().map(|(role, unit)| pair(role.name(), &quoted(unit))).collect();
            [columns, units]
        };
        let quoted = |text: &str| format!("{text:?}");
        let [columns, units] = list(|key, value| format!("{key} = {value}"), quoted);
        let kind = self.kind.name();
        let case = [joined(columns, "columns = { ", " }"), joined(units, "units = { ", " }")];
        let [columns, units] = list(|key, value| format!("\"{key}\": {value}"), quoted);
        let python =
            [format!("kind=\"{kind}\""), joined(columns, "columns={", "}"), joined(units, "units={", "}")];
        let mut command =
            format!("asperity material fit {} --kind {kind}", shell(&self.path.display().to_string()));
        command += &self.sheet.as_ref().map_or(String::new(), |sheet| format!(" --sheet {}", shell(sheet)));
        for (role, place) in &self.columns {
            command +=
                &format!(" --column {}", shell(&format!("{}={}", role.name(), column(place, str::to_owned))));
        }
        for (role, unit) in &self.units {
            command += &format!(" --unit {}", shell(&format!("{}={unit}", role.name())));
        }
        let number = match self.columns.iter().any(|(_, column)| column.is_none()) {
            true => ", N the number of a column or, in quotes, its header",
            false => "",
        };
        let whole = |parts: &[String]| {
            let parts: Vec<&str> = parts.iter().map(String::as_str).filter(|part| !part.is_empty()).collect();
            format!("all that the file leaves open: {}{number}", parts.join(", "))
        };
        [whole(&case), whole(&[command]), whole(&python)]
    }
}

/// The unit that is said, or an example where nobody says it.
fn open_unit(
    table: &Table,
    role: Role,
    place: Option<usize>,
    said: &Columns,
    has_units: bool,
) -> Option<(Role, String)> {
    if let Some(unit) = said.units.get(&role) {
        return Some((role, unit.clone()));
    }
    let heading = place.map(|column| &table.headings[column]);
    let is_open = match heading {
        Some(heading) => unit_of(heading, role, said).is_empty(),
        // Which column it is decides it.
        None => !has_units,
    };
    let angular = role == Role::Frequency && heading.is_some_and(|heading| is_angular(&heading.name));
    let unit = if angular { "rad/s" } else { role.example() };
    (is_open && !matches!(role, Role::TanDelta | Role::Set)).then(|| (role, unit.to_owned()))
}

/// A word of a command line.
fn shell(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "=-_./:,+%".contains(c);
    match word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}
