//! Which column is what, and in which unit.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::str::FromStr;

use asperity::material::Modulus;

use super::Kind;
use super::error::{Fault, fault};
use super::table::Table;
use crate::case::quantity::unit::Unit;
use crate::case::quantity::{Dimension, Quantity, QuantityError, Temperature, dimension, range};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Time since the step.
    Time,
    /// Relaxation modulus.
    Modulus,
    /// Creep compliance.
    Compliance,
    /// Frequency, in Hz or rad/s.
    Frequency,
    /// Storage modulus.
    Storage,
    /// Loss modulus.
    Loss,
    /// Loss factor E''/E', in place of the loss modulus.
    TanDelta,
    /// Temperature of the point.
    Temperature,
    /// Load of an indentation.
    Load,
    /// Depth of an indentation.
    Depth,
}

/// The columns of a kind of file.
#[derive(Clone, Copy)]
pub(super) struct Form {
    /// "relaxation"
    pub(super) name: &'static str,
    /// What its columns hold or may hold, in their order.
    pub(super) roles: &'static [Role],
    /// What "t" means.
    pub(super) t: Role,
}

impl From<Kind> for Form {
    fn from(kind: Kind) -> Self {
        let t = if kind == Kind::Dma { Role::Temperature } else { Role::Time };
        Form { name: kind.name(), roles: kind.roles(), t }
    }
}

impl Role {
    const ALL: [Role; 10] = [
        Role::Time,
        Role::Modulus,
        Role::Compliance,
        Role::Frequency,
        Role::Storage,
        Role::Loss,
        Role::TanDelta,
        Role::Temperature,
        Role::Load,
        Role::Depth,
    ];

    /// Its key in case files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Role::Time => "time",
            Role::Modulus => "modulus",
            Role::Compliance => "compliance",
            Role::Frequency => "frequency",
            Role::Storage => "storage",
            Role::Loss => "loss",
            Role::TanDelta => "tan_delta",
            Role::Temperature => "temperature",
            Role::Load => "load",
            Role::Depth => "depth",
        }
    }

    /// Names of columns that mean nothing else in a file of this kind.
    fn aliases(self, form: Form) -> &'static [&'static str] {
        match (self, form.t) {
            (Role::Time, Role::Time) => &["time", "t"],
            (Role::Time, _) => &["time"],
            (Role::Modulus, _) => &["modulus", "relaxation modulus", "e", "g", "e(t)", "g(t)"],
            (Role::Compliance, _) => &["compliance", "creep compliance", "d", "j", "d(t)", "j(t)"],
            (Role::Frequency, _) => {
                &["frequency", "freq", "freq.", "f", "angular frequency", "omega", "ω", "w"]
            }
            (Role::Storage, _) => &["storage", "storage modulus", "e'", "g'", "e′", "g′"],
            (Role::Loss, _) => {
                &["loss", "loss modulus", "e''", "g''", "e\"", "g\"", "e″", "g″", "e′′", "g′′"]
            }
            (Role::TanDelta, _) => {
                &["tan_delta", "tan delta", "tan(delta)", "tandelta", "tan δ", "tan(δ)", "loss factor"]
            }
            (Role::Temperature, Role::Temperature) => &["temperature", "temp", "temp.", "t"],
            (Role::Temperature, _) => &["temperature", "temp", "temp."],
            (Role::Load, _) => &["load", "force", "normal load", "normal force", "w", "p", "f", "fn"],
            (Role::Depth, _) => {
                &["depth", "indentation", "displacement", "indentation depth", "approach", "h", "d"]
            }
        }
    }
}

impl FromStr for Role {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Role::ALL.into_iter().find(|role| role.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Role::ALL.iter().map(|role| role.name()).collect();
            format!("\"{name}\" is no quantity of a curve; there are {}", names.join(", "))
        })
    }
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Column {
    /// By its header, with or without the unit.
    Name(String),
    /// By its number, from 1.
    Number(usize),
}

/// What is said about the columns; the rest is found from the header.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Columns {
    /// Where the quantities stand.
    pub columns: BTreeMap<Role, Column>,
    /// Their units, which go before those of the header.
    pub units: BTreeMap<Role, String>,
}

/// The numbers of a role in SI, per row.
pub(super) type Values = BTreeMap<Role, Vec<f64>>;

/// The values of all quantities of a curve of `kind`, in SI, and what was assumed.
pub(super) fn values(table: &Table, form: Form, said: &Columns) -> Result<(Values, Vec<String>), Fault> {
    let places = places(table, form, said)?;
    for (role, column) in &places {
        if table.names.get(*column).is_some_and(|name| is_logarithm(name)) {
            let column = format!("column {}{}", column + 1, table.quoted(*column));
            return Err(fault(format!(
                "{} ({column}) is named as a logarithm; give the values themselves, in a column with their unit",
                role.name()
            )));
        }
    }
    let (mut values, mut notes) = (Values::new(), Vec::new());
    for (role, column) in places {
        let header_unit = table.units.get(column).map_or("", String::as_str);
        let unit = match (said.units.get(&role), role) {
            (Some(unit), _) => unit.trim(),
            // "tan(delta) [-]": a ratio whatever the brackets say, but for per cent.
            (None, Role::TanDelta) if header_unit != "%" => "",
            (None, _) => header_unit,
        };
        let numbers = table.numbers(column)?;
        let place = format!("column {}{}", column + 1, table.quoted(column));
        let converted = convert(role, unit, numbers).map_err(|(row, why)| {
            let help = format!(
                "name the unit in the header, as in \"{} [{}]\", or in `units`",
                role.name(),
                example(role)
            );
            let fault = fault(format!("{} ({place}): {why}; {help}", role.name()));
            match row {
                Some(row) => fault.at(table.rows[row].line),
                None => fault,
            }
        })?;
        if unit.is_empty() && role != Role::TanDelta {
            notes.push(format!("{} ({place}) names no unit and is taken in {}", role.name(), si(role)));
        }
        values.insert(role, converted);
    }
    Ok((values, notes))
}

/// The column of each quantity: as said; else by the names in the header; else in order.
fn places(table: &Table, form: Form, said: &Columns) -> Result<BTreeMap<Role, usize>, Fault> {
    let mut places = BTreeMap::new();
    let possible = form.roles;
    for role in said.columns.keys().chain(said.units.keys()) {
        if !possible.contains(role) {
            let names: Vec<&str> = possible.iter().map(|role| role.name()).collect();
            let message = format!(
                "a {} file has no `{}`; its columns are {}",
                form.name,
                role.name(),
                names.join(", ")
            );
            return Err(fault(message));
        }
    }
    for (role, column) in &said.columns {
        places.insert(*role, find(table, *role, column)?);
    }
    for role in possible {
        let known = |name: &String| role.aliases(form).contains(&name.to_lowercase().as_str());
        let taken = |n: &usize| places.values().any(|place| place == n);
        let both = matches!(role, Role::TanDelta) && places.contains_key(&Role::Loss)
            || matches!(role, Role::Loss) && places.contains_key(&Role::TanDelta);
        let column = (0..table.names.len()).find(|n| known(&table.names[*n]) && !taken(n));
        if let (false, false, Some(column)) = (places.contains_key(role), both, column) {
            places.insert(*role, column);
        }
    }
    let required = |places: &BTreeMap<Role, usize>| -> Vec<Role> {
        let missing = |role: &Role| match role {
            Role::Temperature | Role::TanDelta => false,
            Role::Loss => !places.contains_key(role) && !places.contains_key(&Role::TanDelta),
            _ => !places.contains_key(role),
        };
        possible.iter().copied().filter(missing).collect()
    };
    if places.keys().all(|role| *role == Role::Temperature) && said.columns.is_empty() {
        if let Some(line) = table.unread.as_ref().filter(|line| line.contains("Pa") || line.contains("log")) {
            let shown: String = line.chars().take(60).collect();
            return Err(fault(format!(
                "the line before the numbers, {shown:?}, does not name {} columns, and it may hold a unit; name each column \
                 with its unit, as in \"modulus [MPa]\", or say columns = {{ ... }} and units = {{ ... }}",
                table.columns
            )));
        }
        // No names: the columns in the order of the documentation.
        for (n, role) in required(&places).into_iter().enumerate() {
            if n < table.columns && !places.values().any(|place| *place == n) {
                places.insert(role, n);
            }
        }
    }
    match required(&places).first() {
        None => Ok(places),
        Some(role) => {
            let name = role.name();
            let columns = table.listed();
            let message = format!(
                "no column is recognised as {name}; the file has {columns}; name it as in columns = {{ {name} = 1 }}, by \
                 number or header"
            );
            Err(fault(message))
        }
    }
}

/// What the names of the columns call the modulus or compliance: E and D are Young's, G and J shear.
pub(super) fn measure(table: &Table, form: Form, said: &Columns) -> Option<Modulus> {
    let places = places(table, form, said).ok()?;
    let of = |role: &Role| places.get(role).and_then(|column| table.names.get(*column));
    let name = [Role::Storage, Role::Modulus, Role::Compliance].iter().find_map(of)?.to_lowercase();
    let mut letters = name.chars();
    let symbol = letters.next()?;
    match symbol {
        _ if name.contains("shear") => Some(Modulus::Shear),
        _ if name.contains("young") || name.contains("tensile") => Some(Modulus::Young),
        _ if letters.next().is_some_and(char::is_alphanumeric) => None,
        'g' | 'j' => Some(Modulus::Shear),
        'e' | 'd' => Some(Modulus::Young),
        _ => None,
    }
}

/// Whether a name is that of a logarithm: "log E", "lg(t)", "ln G'".
fn is_logarithm(name: &str) -> bool {
    let name = name.to_lowercase();
    let rest = ["log10", "log", "lg", "ln"].iter().find_map(|start| name.strip_prefix(start));
    rest.is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

/// Whether the header names all that a file of this kind needs.
pub(super) fn named(table: &Table, kind: Kind) -> bool {
    let has = |role: Role| {
        table.names.iter().any(|name| role.aliases(kind.into()).contains(&name.to_lowercase().as_str()))
    };
    match kind {
        Kind::Relaxation => has(Role::Time) && has(Role::Modulus),
        Kind::Creep => has(Role::Time) && has(Role::Compliance),
        Kind::Dma => has(Role::Frequency) && has(Role::Storage) && (has(Role::Loss) || has(Role::TanDelta)),
    }
}

fn find(table: &Table, role: Role, column: &Column) -> Result<usize, Fault> {
    let wrong = |what: String| {
        fault(format!("{} must be {what}, but the columns are {}", role.name(), table.listed()))
    };
    match column {
        Column::Number(n) if *n >= 1 && *n <= table.columns => Ok(n - 1),
        Column::Number(n) => Err(wrong(format!("column {n}"))),
        Column::Name(name) => {
            let wanted = name.trim();
            let same = |text: &String| text.trim() == wanted;
            let found = table.headers.iter().position(same).or_else(|| table.names.iter().position(same));
            found.ok_or_else(|| wrong(format!("in the column {wanted:?}")))
        }
    }
}

/// The numbers in SI, or the row and why not.
fn convert(role: Role, unit: &str, numbers: Vec<f64>) -> Result<Vec<f64>, (Option<usize>, String)> {
    let whole = |why: String| (None, why);
    let factor = match role {
        Role::Temperature => {
            let kelvin = |(row, value): (usize, &f64)| {
                let temperature = Temperature::from_unit(*value, unit);
                temperature.map(Temperature::get).map_err(|error| {
                    let why = error.help.unwrap_or_else(|| format!("{value} must be {}", error.expected));
                    (Some(row), why)
                })
            };
            return numbers.iter().enumerate().map(kelvin).collect();
        }
        Role::Frequency => frequency(unit).map_err(whole)?,
        Role::Time => scale::<dimension::Time>(unit).map_err(whole)?,
        Role::Modulus | Role::Storage | Role::Loss => scale::<dimension::Pressure>(unit).map_err(whole)?,
        Role::Compliance => scale::<dimension::Compliance>(unit).map_err(whole)?,
        Role::TanDelta => scale::<dimension::Number>(unit).map_err(whole)?,
        Role::Load => scale::<dimension::Force>(unit).map_err(whole)?,
        Role::Depth => scale::<dimension::Length>(unit).map_err(whole)?,
    };
    Ok(numbers.into_iter().map(|value| factor * value).collect())
}

/// SI of one unit.
fn scale<D: Dimension>(unit: &str) -> Result<f64, String> {
    let one = format!("1 {}", if unit == "-" { "" } else { unit });
    let quantity = one.parse::<Quantity<D, range::Positive>>();
    quantity.map(Quantity::get).map_err(|error| error.help.unwrap_or(error.expected))
}

/// rad/s of one unit: cycles and radians are told apart, never guessed.
fn frequency(unit: &str) -> Result<f64, String> {
    let radians = unit.contains("rad");
    if !radians && !unit.contains("Hz") {
        return Err(match unit {
            "" => "has no unit: give Hz (cycles per second) or rad/s (radians per second)".to_owned(),
            _ => format!("\"{unit}\" may mean cycles (Hz) or radians (rad/s)"),
        });
    }
    let parsed = Unit::parse(&unit.replace("rad", "1"));
    match parsed {
        Ok(parsed) if parsed.powers == dimension::Frequency::POWERS => {
            let scale = parsed.numerator / parsed.denominator * 10f64.powi(parsed.exponent);
            Ok(if radians { scale } else { TAU * scale })
        }
        _ => Err(format!("\"{unit}\" is not a unit of frequency (Hz, kHz, rad/s)")),
    }
}

/// "0.1 Hz" or "2 rad/s" as angular frequency \[rad/s\], greater than 0.
///
/// # Errors
/// [`QuantityError`] for another dimension, or a unit that does not tell cycles from radians.
pub fn angular_frequency(text: &str) -> Result<f64, QuantityError> {
    let expected = || QuantityError {
        expected: "a frequency greater than 0, such as \"0.1 Hz\" or \"2 rad/s\"".to_owned(),
        help: None,
    };
    let text = text.trim();
    let end = text.find(|c: char| c.is_whitespace()).unwrap_or(text.len());
    let value: f64 = text[..end].parse().map_err(|_| expected())?;
    let factor =
        frequency(text[end..].trim()).map_err(|help| QuantityError { help: Some(help), ..expected() })?;
    match value.is_finite() && value > 0.0 {
        true => Ok(factor * value),
        false => Err(expected()),
    }
}

fn si(role: Role) -> &'static str {
    match role {
        Role::Time => "s",
        Role::Modulus | Role::Storage | Role::Loss => "Pa",
        Role::Compliance => "1/Pa",
        Role::Frequency => "Hz",
        Role::TanDelta => "",
        Role::Temperature => "K",
        Role::Load => "N",
        Role::Depth => "m",
    }
}

fn example(role: Role) -> &'static str {
    match role {
        Role::Modulus | Role::Storage | Role::Loss => "MPa",
        Role::Compliance => "1/MPa",
        Role::TanDelta => "-",
        Role::Temperature => "°C",
        Role::Load => "mN",
        Role::Depth => "um",
        role => si(role),
    }
}
