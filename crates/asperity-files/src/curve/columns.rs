//! Which column is what, and in which unit.

use std::collections::BTreeMap;

use asperity::material::Modulus;

use super::{alternatives, kind};

use super::error::{Remedy, Result, fault};
use super::role::{self, Role, unnumbered};
use super::sweeps::{DYNAMIC, Pair};
use super::table::{Heading, Table};
use super::units::{convert, is_angular, spelled, taken, tidy};
use super::{Kind, Whole};
use crate::quantity::unit::Unit;
use crate::quantity::{Dimension, dimension};

/// The columns of a kind of file.
#[derive(Clone, Copy)]
pub(super) struct Form {
    /// "relaxation"
    pub(super) name: &'static str,
    /// What its columns must hold, in their order where the file does not name them.
    pub(super) needed: &'static [Role],
    /// Pairs of columns: the file must hold one of these too. The first that it holds is taken; without names, the first of all.
    pub(super) pairs: &'static [Pair],
    /// What it may hold besides.
    pub(super) optional: &'static [Role],
    /// What "t" means.
    pub(super) t: Role,
}

impl From<Kind> for Form {
    fn from(kind: Kind) -> Self {
        let optional = &[Role::Temperature, Role::Set];
        let form = |needed, pairs, t| Form { name: kind.name(), needed, pairs, optional, t };
        match kind {
            Kind::Relaxation => form(&[Role::Time, Role::Modulus], &[], Role::Time),
            Kind::Creep => form(&[Role::Time, Role::Compliance], &[], Role::Time),
            Kind::Dma => form(&[Role::Frequency], &DYNAMIC, Role::Temperature),
        }
    }
}

impl Form {
    fn pairs(&self) -> impl Iterator<Item = &'static [Role; 2]> + Clone + use<> {
        self.pairs.iter().map(|(pair, _)| pair)
    }

    /// All that its columns may hold, each once.
    fn roles(&self) -> Vec<Role> {
        let all = self.needed.iter().chain(self.pairs().flatten()).chain(self.optional);
        let place = |role: &Role| all.clone().position(|other| other == role);
        all.clone().enumerate().filter(|(n, role)| place(role) == Some(*n)).map(|(_, role)| *role).collect()
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

/// What the caller says about the table; the rest is found from the header.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Columns {
    /// Where the quantities stand.
    pub columns: BTreeMap<Role, Column>,
    /// Their units, which replace those of the header.
    pub units: BTreeMap<Role, String>,
    /// The sheet of a spreadsheet, by its name; the first with a curve if the caller names none.
    pub sheet: Option<String>,
    /// The step or sweep that is read of a table that holds several below each other, from 1; all of them if the caller names none.
    pub segment: Option<usize>,
}

/// The numbers of a role in SI, per row.
pub(super) type Values = BTreeMap<Role, Vec<f64>>;

/// A column that was used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// What it holds.
    pub role: Role,
    /// Its number, from 1.
    pub column: usize,
    /// Its header; empty if it has none.
    pub header: String,
    /// The unit in which its numbers are taken.
    pub unit: String,
    /// Whether the file or the caller names the unit.
    pub named: bool,
}

/// The values of all quantities of a curve of `form` in SI, the columns that hold them, and what was assumed.
pub(super) fn values(table: &Table, form: Form, said: &Columns) -> Result<Read> {
    let places = places(table, form, said)?;
    let (kept, mut notes) = complete(table, &places)?;
    notes.extend(table.notes.iter().cloned());
    notes.extend(in_order(table, form, &places, said));
    notes.extend(alternatives::agree(table, form, &places, said)?);
    let unread = table.unread.as_deref().filter(|_| table.is_named()).map(shown);
    notes.extend(unread.as_ref().map(|line| {
        format!("the line {line:?}, between the names of the columns and the points, is not read")
    }));
    let (mut values, mut used) = (Values::new(), Vec::new());
    for (role, column) in places {
        let heading = &table.headings[column];
        let Heading { header, name, base, .. } = heading;
        if role == Role::Modulus && kind::is_creep_modulus(name) {
            return Err(kind::creep_modulus(table, column));
        }
        let unit = unit_of(heading, role, said);
        let place = format!("column {}{}", column + 1, table.quoted(column));
        if let (true, Some(line), false) =
            (unit.is_empty(), &unread, matches!(role, Role::TanDelta | Role::Set))
        {
            return Err(fault(format!(
                "{} ({place}) names no unit, and the line {line:?} above the points, which is not understood, may hold it",
                role.name()
            ))
            .remedy(Remedy::Unit(role)));
        }
        let numbers = match role {
            Role::Set => table.labels(column),
            _ => table.sparse(column)?.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect(),
        };
        let numbers: Vec<f64> = kept.iter().map(|row| numbers[*row]).collect();
        let numbers = match base {
            Some(base) => {
                let word = if *base == 10.0 { "10" } else { "e" };
                let name = role.name();
                notes.push(format!("{name} ({place}) holds logarithms, of base {word}, as its name says"));
                powers(*base, &numbers).map_err(|why| fault(format!("{} ({place}) {why}", role.name())))?
            }
            None => numbers,
        };
        let converted = convert(role, &unit, numbers).map_err(|(row, why)| {
            let line = row.map(|row| table.rows[kept[row]].line);
            let angular = role == Role::Frequency && unit.is_empty() && is_angular(name);
            // Of 1/s it is only open whether cycles or radians are counted.
            let is_open = unit.is_empty() || matches!(unit.as_str(), "1/s" | "s^-1" | "s-1");
            let remedy = match (angular, is_open || said.units.contains_key(&role)) {
                (true, _) => Remedy::Radians,
                (false, true) => Remedy::Unit(role),
                (false, false) => Remedy::Convert(role),
            };
            // Without a unit, or with that of a time, the column itself may be a wrong one.
            let columns = match unit.is_empty() || role == Role::Frequency {
                true => format!("; the columns are {}", table.listed()),
                false => String::new(),
            };
            let whole = if is_open { whole(table, form, said) } else { None };
            fault(format!("{} ({place}): {why}{columns}", role.name())).remedy(remedy).whole(whole).at(line)
        })?;
        let own = &heading.unit;
        if let Some(given) = said.units.get(&role)
            && !own.is_empty()
            && base.is_none()
            && tidy(role, name, given) != tidy(role, name, own)
        {
            let name = role.name();
            notes.push(format!(
                "{name} ({place}) is taken in {given}, as you say, and not in {own}, as its header says"
            ));
        }
        if unit.is_empty() && !matches!(role, Role::TanDelta | Role::Set) {
            notes.push(format!("{} ({place}) names no unit and is taken in {}", role.name(), taken(role)));
        }
        values.insert(role, converted);
        let named = !unit.is_empty();
        let unit = if named { unit } else { taken(role).to_owned() };
        used.push(Place { role, column: column + 1, header: header.clone(), unit, named });
    }
    let of = |role: Role| used.iter().find(|place| place.role == role);
    if let (Some(storage), Some(loss)) = (of(Role::Storage), of(Role::Loss))
        && storage.named != loss.named
    {
        let (bare, other) = if storage.named { (loss, storage) } else { (storage, loss) };
        if other.unit != taken(bare.role) {
            let quoted = table.quoted(bare.column - 1);
            return Err(fault(format!(
                "{} (column {}{quoted}) names no unit, and {} is in {}: taken in Pa it may be wrong by powers of ten",
                bare.role.name(),
                bare.column,
                other.role.name(),
                other.unit
            ))
            .remedy(Remedy::Unit(bare.role)));
        }
    }
    let lines = kept.iter().map(|row| table.rows[*row].line).collect();
    Ok(Read { values, places: used, lines, left_out: table.rows.len() - kept.len(), notes })
}

/// A note where the columns have names, but none that is known.
fn in_order(table: &Table, form: Form, places: &BTreeMap<Role, usize>, said: &Columns) -> Option<String> {
    let known = |(role, column): (&Role, &usize)| means(table, *column, *role, form);
    if !table.is_named() || !said.columns.is_empty() || places.iter().any(known) {
        return None;
    }
    let place = |(role, column): (&Role, &usize)| {
        format!("{}{} is {}", column + 1, table.quoted(*column), role.name())
    };
    let places: Vec<String> = places.iter().map(place).collect();
    Some(format!(
        "no name of a column is known: they are taken in the order of a {} file, {}",
        form.name,
        places.join("; ")
    ))
}

/// The unit of a column: as the caller says, or else as its heading does; empty if neither does.
pub(super) fn unit_of(heading: &Heading, role: Role, said: &Columns) -> String {
    let Heading { name, unit: own, base, .. } = heading;
    // "[log Pa]" under "log G'".
    let header_unit = if base.is_some() { role::logarithm(own).1 } else { own };
    match (said.units.get(&role), role) {
        (Some(unit), _) => tidy(role, name, unit.trim()),
        // "tan(delta) [-]": a ratio, unless the brackets hold per cent or a number.
        (None, Role::TanDelta) if is_ratio(header_unit) => String::new(),
        (None, _) => tidy(role, name, header_unit),
    }
}

/// A line of the file as a message shows it.
fn shown(line: impl AsRef<str>) -> String {
    line.as_ref().chars().take(60).collect()
}

/// Whether a word of a line is a unit of time, frequency, temperature, modulus or compliance, as a heading has.
fn holds_unit(line: &str) -> bool {
    let parts = line.split(|c: char| c.is_whitespace() || ",;|[](){}".contains(c));
    parts.filter(|word| word.chars().count() > 1).any(|word| {
        let pressure = [-1, 1, -2, 0, 0];
        let known = |unit: Unit| {
            unit.powers == pressure
                || unit.powers == pressure.map(|power| -power)
                || [dimension::Time::POWERS, dimension::Frequency::POWERS].contains(&unit.powers)
        };
        matches!(word, "°C" | "°F" | "rad/s") || Unit::parse(&spelled(word)).is_ok_and(known)
    })
}

/// Whether the unit of a ratio says nothing.
fn is_ratio(unit: &str) -> bool {
    unit == "1" || !unit.contains(|c: char| matches!(c, '%' | '‰') || c.is_ascii_digit())
}

/// What the columns of a table hold.
pub(super) struct Read {
    pub values: Values,
    pub places: Vec<Place>,
    /// The line of each point.
    pub lines: Vec<usize>,
    /// Points that lack a number.
    pub left_out: usize,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// The rows with a number in each of the columns, and a note on the others.
fn complete(table: &Table, places: &BTreeMap<Role, usize>) -> Result<(Vec<usize>, Vec<String>)> {
    let mut whole = vec![true; table.rows.len()];
    let mut most = (0, String::new());
    for (role, column) in places.iter().filter(|(role, _)| **role != Role::Set) {
        let numbers = table.sparse(*column)?;
        let missing = numbers.iter().filter(|number| number.is_none()).count();
        if missing > most.0 {
            most = (missing, format!("{} (column {}{})", role.name(), column + 1, table.quoted(*column)));
        }
        for (whole, number) in whole.iter_mut().zip(numbers) {
            *whole &= number.is_some();
        }
    }
    let (kept, lacking): (Vec<usize>, Vec<usize>) = (0..whole.len()).partition(|row| whole[*row]);
    let Some(first) = lacking.first() else { return Ok((kept, Vec::new())) };
    if 2 * lacking.len() > whole.len() {
        let (missing, column) = most;
        return Err(fault(format!(
            "{} of {} points lack a number in one of the columns that are read, {missing} of them that of {column}; every point needs all of \
             them: take the others out, or put the quantities that were measured at the same points beside each other",
            lacking.len(),
            whole.len()
        ))
        .at(table.rows[*first].line));
    }
    let lines: Vec<String> = lacking.iter().take(10).map(|row| table.rows[*row].line.to_string()).collect();
    let more = if lacking.len() > lines.len() { ", ..." } else { "" };
    let (count, of, lines) = (lacking.len(), whole.len(), lines.join(", "));
    let note = match count {
        1 => format!("1 of {of} points lacks a number and is left out (line {lines})"),
        _ => format!("{count} of {of} points lack a number and are left out (lines {lines}{more})"),
    };
    Ok((kept, vec![note]))
}

/// The numbers of their logarithms.
pub(super) fn powers(base: f64, logarithms: &[f64]) -> Result<Vec<f64>, String> {
    /// More decades than any quantity of a curve spans.
    const MOST: f64 = 60.0;
    let ends = logarithms.iter().fold([0.0, 0.0], |[low, high]: [f64; 2], v| [low.min(*v), high.max(*v)]);
    let decades = base.log10() * (ends[1] - ends[0]);
    match decades <= MOST {
        true => Ok(logarithms.iter().map(|v| libm::pow(base, *v)).collect()),
        false => Err(format!(
            "is named as a logarithm, but its numbers would span {decades:.0} decades: rename the column if it holds the values"
        )),
    }
}

/// The column of each quantity: as said; else by the names in the header; else in order.
pub(super) fn places(table: &Table, form: Form, said: &Columns) -> Result<BTreeMap<Role, usize>> {
    let possible = form.roles();
    for role in said.columns.keys().chain(said.units.keys()) {
        if !possible.contains(role) {
            let (role, columns) = (role.name(), role::listed(&possible));
            return Err(fault(format!("a {} file has no `{role}`; its columns are {columns}", form.name)));
        }
    }
    let mut places = BTreeMap::new();
    for (role, column) in &said.columns {
        places.insert(*role, find(table, *role, column)?);
    }
    for role in &possible {
        let taken = |n: &usize| places.values().any(|place| place == n);
        let candidates = (0..table.headings.len()).filter(|n| means(table, *n, *role, form) && !taken(n));
        let column = alternatives::best(table, *role, candidates, said);
        if let (false, Some(column)) = (places.contains_key(role), column) {
            places.insert(*role, column);
        }
    }
    if places.keys().all(|role| form.optional.contains(role)) && said.columns.is_empty() {
        if let Some(line) = table.unread.as_ref().filter(|line| line.contains("log") || holds_unit(line)) {
            return Err(fault(format!(
                "the line before the numbers, {:?}, does not name {} columns, and it may hold a unit",
                shown(line),
                table.headings.len()
            ))
            .remedy(Remedy::Header));
        }
        // Without names, the columns are in the order of the documentation.
        let order = form.needed.iter().chain(form.pairs().next().into_iter().flatten());
        let (needed, there) = (order.clone().count(), table.headings.len());
        // Which ones they are nobody says: the first ones may be a counter and a time.
        if there > needed {
            return Err(fault(format!(
                "no column is named as one of a {} file, and there are {there}, more than the {needed} that are needed ({}); the file has \
                 {}",
                form.name,
                role::listed(order),
                table.listed()
            ))
            .remedy(Remedy::Column(form.needed[0]))
            .whole(whole(table, form, said)));
        }
        for (n, role) in order.enumerate() {
            if n < table.headings.len() && !places.values().any(|place| *place == n) {
                places.insert(*role, n);
            }
        }
    }
    let missing = form.needed.iter().find(|role| !places.contains_key(role)).copied();
    let missing = missing.or_else(|| one_pair(&mut places, form, said));
    if let (None, Some(role)) = (missing, said.units.keys().find(|role| !places.contains_key(*role))) {
        return Err(fault(format!(
            "a unit is given for `{}`, but no column holds it; the file has {}",
            role.name(),
            table.listed()
        )));
    }
    match missing {
        None => once(table, &places, said).map(|()| places),
        Some(role) => {
            let columns = table.listed();
            let message = format!("no column is recognised as {}; the file has {columns}", role.name());
            Err(fault(message).remedy(Remedy::Column(role)).whole(whole(table, form, said)))
        }
    }
}

/// All that a file of a kind of its own leaves open.
fn whole(table: &Table, form: Form, said: &Columns) -> Option<Whole> {
    let kind =
        [Kind::Relaxation, Kind::Creep, Kind::Dma].into_iter().find(|kind| kind.name() == form.name)?;
    Whole::of(table, kind, said, false)
}

/// # Errors
/// Where a column was found by a heading that another one has too, with other numbers.
fn once(table: &Table, places: &BTreeMap<Role, usize>, said: &Columns) -> Result<()> {
    let header = |column: usize| unnumbered(&table.headings[column].header);
    let numbered = |role: &Role| matches!(said.columns.get(role), Some(Column::Number(_)));
    for (role, column) in places.iter().filter(|(role, _)| **role != Role::Set && !numbered(role)) {
        let differs =
            |other: &usize| table.rows.iter().any(|row| table.cell(row, *column) != table.cell(row, *other));
        let alike = |other: &usize| {
            let name = header(*column);
            other != column && !name.is_empty() && header(*other) == name
        };
        let others = (0..table.headings.len()).filter(alike).filter(differs);
        let others: Vec<String> = others.map(|other| (other + 1).to_string()).collect();
        if !others.is_empty() {
            let (name, first, others) = (header(*column), column + 1, others.join(", "));
            return Err(fault(format!(
                "the heading {name:?} stands above column {first} and again above other numbers (column {others}): which is {}? sweeps \
                 at several temperatures need a temperature above each, as in \"20 °C\", or a column of temperatures",
                role.name()
            ))
            .remedy(Remedy::Column(*role)));
        }
    }
    Ok(())
}

/// Keeps one complete pair of columns and drops all others: the pair with most columns that the caller named, or else the first.
/// Without a complete pair, returns what is missing.
fn one_pair(places: &mut BTreeMap<Role, usize>, form: Form, said: &Columns) -> Option<Role> {
    let told = |pair: &[Role; 2]| pair.iter().filter(|role| said.columns.contains_key(role)).count();
    let complete = form.pairs().filter(|pair| pair.iter().all(|role| places.contains_key(role)));
    let most = complete.clone().map(told).max();
    match complete.clone().find(|pair| Some(told(pair)) == most) {
        Some(pair) => {
            places.retain(|role, _| pair.contains(role) || !form.pairs().flatten().any(|r| r == role));
            None
        }
        // A storage modulus alone can be fitted; the fit says what is missing.
        None if form.pairs.iter().any(|(pair, _)| pair[0] == Role::Storage)
            && places.contains_key(&Role::Storage) =>
        {
            places.retain(|role, _| *role == Role::Storage || !form.pairs().flatten().any(|r| r == role));
            None
        }
        // The other one of a pair that has one, else the first of all.
        None => {
            let half =
                form.pairs().find_map(|[a, b]| match (places.contains_key(a), places.contains_key(b)) {
                    (true, false) => Some(*b),
                    (false, true) => Some(*a),
                    _ => None,
                });
            half.or_else(|| form.pairs().next().map(|pair| pair[0]))
        }
    }
}

/// Whether the name of a column says that it holds the role.
pub(super) fn means(table: &Table, column: usize, role: Role, form: Form) -> bool {
    let name = table.headings[column].name.trim();
    match role::bare(name).as_str() {
        "t" => time_or_temperature(table, column, form) == role,
        _ => role.is_called(name),
    }
}

/// What a column called t or T holds: as its unit says; else T is a temperature where another column is a time.
fn time_or_temperature(table: &Table, column: usize, form: Form) -> Role {
    let Heading { name, unit, .. } = &table.headings[column];
    let is_time = |name: &str| name == "t" || Role::Time.is_called(name);
    let mut others = table.headings.iter().enumerate().filter(|(n, _)| *n != column);
    match tidy(Role::Temperature, "", unit).as_str() {
        "K" | "°C" | "°F" => Role::Temperature,
        unit if Unit::parse(unit).is_ok_and(|unit| unit.powers == dimension::Time::POWERS) => Role::Time,
        _ if name == "T" && others.any(|(_, other)| is_time(&other.name)) => Role::Temperature,
        _ => form.t,
    }
}

/// What the names of the columns call the modulus or compliance: E and D are Young's, G and J shear.
///
/// # Errors
/// Where one column is called one and another the other.
pub(super) fn measure(used: &[Place], table: &Table) -> Result<Option<Modulus>> {
    let called = |place: &&Place| {
        let is_modulus = !matches!(
            place.role,
            Role::Time | Role::Frequency | Role::TanDelta | Role::Phase | Role::Temperature | Role::Set
        );
        role::measure_of(&table.headings[place.column - 1].name).filter(|_| is_modulus)
    };
    let of = |measure: Modulus| used.iter().find(|place| called(place) == Some(measure));
    if let (Some(young), Some(shear)) = (of(Modulus::Young), of(Modulus::Shear)) {
        return Err(fault(format!(
            "column {} ({:?}) is named as a Young's modulus, and column {} ({:?}) as a shear modulus; they differ by \
             2 (1 + Poisson's ratio), and cannot be fitted together",
            young.column, young.header, shear.column, shear.header
        )));
    }
    Ok(said(used, table))
}

fn said(used: &[Place], table: &Table) -> Option<Modulus> {
    let moduli = [
        Role::Storage,
        Role::Modulus,
        Role::Compliance,
        Role::ComplexModulus,
        Role::StorageCompliance,
        Role::Loss,
    ];
    let place = moduli.iter().find_map(|role| used.iter().find(|place| place.role == *role));
    match place {
        Some(place) => {
            let named = role::measure_of(&table.headings[place.column - 1].name);
            named.or_else(|| is_sheared(table).then_some(Modulus::Shear))
        }
        // Viscosities of rheometers are those of shear.
        None => used.iter().any(|place| place.role.name().ends_with("viscosity")).then_some(Modulus::Shear),
    }
}

/// Whether other columns say that the test was one in shear: its strain, its stress, or a torque.
fn is_sheared(table: &Table) -> bool {
    let words = ["shearstr", "torque", "scher", "schubspannung", "drehmoment"];
    let names = table.headings.iter().map(|heading| role::bare(&heading.name));
    names.into_iter().any(|name| words.iter().any(|word| name.starts_with(word)))
}

/// Whether the header names storage and loss modulus, or what stands in their place.
pub(super) fn is_dynamic(table: &Table) -> bool {
    names_pair(table, Kind::Dma.into())
}

/// Whether the header names all that a file of this kind needs.
pub(super) fn named(table: &Table, kind: Kind) -> bool {
    let form = Form::from(kind);
    form.needed.iter().all(|role| names(table, *role, form))
        && (form.pairs.is_empty() || names_pair(table, form) || names(table, Role::Storage, form))
}

/// The column that is named as one of the role, among those of a kind.
pub(super) fn named_column(table: &Table, role: Role, kind: Kind) -> Option<usize> {
    let form = Form::from(kind);
    (0..table.headings.len()).find(|column| means(table, *column, role, form))
}

fn names_pair(table: &Table, form: Form) -> bool {
    form.pairs().any(|pair| pair.iter().all(|role| names(table, *role, form)))
}

/// Whether a column is named as one of the role.
fn names(table: &Table, role: Role, form: Form) -> bool {
    (0..table.headings.len()).any(|column| means(table, column, role, form))
}

pub(super) fn find(table: &Table, role: Role, column: &Column) -> Result<usize> {
    let wrong = |what: String| {
        let message = format!("{} must be {what}, but the columns are {}", role.name(), table.listed());
        fault(message).remedy(Remedy::Column(role))
    };
    match column {
        Column::Number(n) if *n >= 1 && *n <= table.headings.len() => Ok(n - 1),
        Column::Number(n) => Err(wrong(format!("column {n}"))),
        Column::Name(name) => {
            let wanted = name.trim();
            let mut headings = table.headings.iter();
            let whole = headings.clone().position(|heading| heading.header.trim() == wanted);
            let found = whole.or_else(|| headings.position(|heading| heading.name.trim() == wanted));
            found.ok_or_else(|| wrong(format!("in the column {wanted:?}")))
        }
    }
}
