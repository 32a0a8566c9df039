//! The reading end of a result.

use std::fs::File;
use std::path::{Path, PathBuf};

use asperity::Axis;
use asperity::finding::Finding;
use asperity::quantities::Quantity;
use asperity::sliding::Friction;
use asperity::step::Row;
use ndarray::Array2;
use serde_json::{Map, Value};

use super::chunks::Chunks;
use super::codec::Number;
use super::column;
use super::document::{Document, ERROR_BARS};
use super::error::{Result, StoreError, corrupt};
use super::field_kind::FieldKind;
use super::header::{self, Header, Status, Work};
use super::layout::{ArraySpec, SCALARS, Series, Storage};
use super::leak::Leaks;
use super::leftovers;
use crate::converge::ErrorBar;
use crate::readable::quantity;

/// A result as it is at the instant of opening; a run that goes on is seen by opening it again.
#[derive(Clone, Debug)]
pub struct Reader {
    root: PathBuf,
    document: Document,
    field_times: Vec<f64>,
    field_steps: Vec<usize>,
}

/// Which of the stored instants of a field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum At {
    /// Number of the instant, from 0.
    Index(usize),
    /// The stored instant that is nearest to this time \[s\]; of two at the same time (before and after a
    /// jump) the later.
    Time(f64),
    /// The last one.
    #[default]
    Last,
}

impl Reader {
    /// Opens the result at `path`, finished or not.
    ///
    /// # Errors
    /// [`StoreError::NotAResult`] where there is none, [`StoreError::Newer`] where it is of a later form,
    /// [`StoreError::Corrupt`] where it is damaged, [`StoreError::Io`] where the system refuses.
    pub fn open(path: &Path) -> Result<Reader> {
        let document = Document::read(path)?;
        let mut reader =
            Reader { root: path.to_owned(), document, field_times: Vec::new(), field_steps: Vec::new() };
        reader.field_times = reader.numbers("field_time")?;
        let rows = reader.len();
        let step = |step: f64| (0.0..rows as f64).contains(&step).then_some(step as usize);
        let steps: Option<Vec<usize>> = reader.numbers("field_step")?.into_iter().map(step).collect();
        reader.field_steps =
            steps.ok_or_else(|| corrupt(&path.join("field_step"), "a number in it is not that of a row"))?;
        Ok(reader)
    }

    /// The directory of the result.
    pub fn path(&self) -> &Path {
        &self.root
    }

    /// What the result says of its case.
    pub fn header(&self) -> &Header {
        &self.document.header
    }

    /// How far the run has come, as it says itself.
    pub fn status(&self) -> Status {
        self.document.progress.status
    }

    /// The attributes of the group, as in the file: `title`, `case`, `version`, `status`, `work_...`.
    pub fn attributes(&self) -> Map<String, Value> {
        let mut attributes = header::attributes(self.header(), self.document.form);
        header::put_progress(&mut attributes, &self.document.progress);
        attributes.extend(self.document.stress_attribute());
        attributes.extend(self.document.error_bars.clone().map(|bars| (ERROR_BARS.to_owned(), bars)));
        attributes
    }

    /// The error bars of its answers; none where they were not computed.
    pub fn error_bars(&self) -> Vec<ErrorBar> {
        let bars = self.document.error_bars.clone();
        bars.and_then(|bars| serde_json::from_value(bars).ok()).unwrap_or_default()
    }

    /// The findings of the run so far.
    pub fn findings(&self) -> &[Finding] {
        &self.document.progress.findings
    }

    /// The work that it took.
    pub fn work(&self) -> &Work {
        &self.document.progress.work
    }

    /// Whether a process is writing the result now. A result that says [`Status::Running`] without that
    /// was killed. (False as well where the file system has no locks.)
    pub fn is_being_written(&self) -> bool {
        let shared = File::open(&self.root).map(|directory| directory.try_lock_shared());
        matches!(shared, Ok(Err(std::fs::TryLockError::WouldBlock)))
    }

    /// The complete result that this one replaces; it is kept until this one is complete.
    pub fn replaces(&self) -> Option<PathBuf> {
        leftovers::kept(&self.root).filter(|_| self.status() != Status::Complete)
    }

    /// Whether all rows are stored, but not the leakage that its case asks for.
    pub fn lacks_leakage(&self) -> bool {
        let asked = self.header().setup.get("leakage").is_some_and(|leakage| !leakage.is_null());
        self.status() == Status::Complete && asked && self.leaks().is_none()
    }

    /// How far it is, in words: "complete"; "interrupted; continue with asperity run --resume".
    pub fn state(&self) -> String {
        let state = match self.status() {
            Status::Complete if self.lacks_leakage() => "without its leakage",
            Status::Complete => return "complete".to_owned(),
            Status::Running if self.is_being_written() => return "running".to_owned(),
            Status::Running => "incomplete: its run was killed",
            Status::Interrupted => "incomplete: its run was interrupted",
            Status::Failed => return "incomplete: its run failed".to_owned(),
        };
        // Without a stored case file no run can continue it.
        let is_of_case = !self.header().case_text.is_empty();
        format!("{state}{}", if is_of_case { "; continue with asperity run --resume" } else { "" })
    }

    /// Rows.
    pub fn len(&self) -> usize {
        self.document.progress.rows
    }

    /// Whether no row is stored yet.
    pub fn is_empty(&self) -> bool {
        self.document.progress.rows == 0
    }

    /// All rows, in order of time.
    ///
    /// # Errors
    /// [`StoreError::Corrupt`] where a file is missing or damaged, [`StoreError::Io`] where the system refuses.
    pub fn rows(&self) -> Result<Vec<Row>> {
        let mut rows = Vec::new();
        for scalar in SCALARS {
            let numbers = self.numbers(scalar.name)?;
            if scalar.is_count() && numbers.iter().any(|count| *count < 0.0) {
                return Err(corrupt(&self.root.join(scalar.name), "a count in it is negative"));
            }
            // The length is trusted once the files have shown to hold it.
            rows.resize(numbers.len(), Row { coordinate: self.header().axis().at(0.0), ..Row::default() });
            rows.iter_mut().zip(numbers).for_each(|(row, number)| scalar.set(row, number));
        }
        // Bytes that did not reach the disk before a loss of power read as zeros.
        let coordinate = |row: &Row| row.coordinate.value();
        if let Some(n) = rows.windows(2).position(|pair| coordinate(&pair[1]) < coordinate(&pair[0])) {
            let (name, what) = (self.header().stored("time"), self.header().axis().plural());
            return Err(corrupt(&self.root.join(name), format_args!("{what} decrease after row {n}")));
        }
        Ok(rows)
    }

    /// What each row has one number of: the [`SCALARS`], the quantities that were asked for, and the components of those that are
    /// vectors; with the units that they have on the grid of the result.
    pub fn scalars(&self) -> Vec<Series> {
        let header = self.header();
        let asked = header.quantities.iter().map(|column| column.quantity);
        let asked = asked.flat_map(|quantity| Series::of_numbers(quantity, &header.grid));
        SCALARS.iter().map(|scalar| Series::of_scalar(scalar, header)).chain(asked).collect()
    }

    /// A histogram that was asked for: the ends of its bins, and its rows (shape: rows, bins).
    ///
    /// # Errors
    /// [`StoreError::Missing`] where it was not asked for, and those of [`rows`](Self::rows).
    pub fn histogram(&self, quantity: Quantity) -> Result<(Vec<f64>, Array2<f64>)> {
        let column = self.header().quantities.iter().find(|column| column.quantity == quantity);
        let Some(column) = column.filter(|_| quantity.is_histogram()) else {
            let kept = self.header().quantities.iter().map(|column| column.quantity);
            let names = kept.filter(|q| q.is_histogram()).map(Quantity::name);
            let how = "name it in output.quantities of the case, and run that again";
            return Err(self.missing(format!("histogram `{quantity}`"), holds(names, how)));
        };
        let numbers = self.numbers(quantity.name())?;
        let shape = (numbers.len() / column.width(), column.width());
        let rows = Array2::from_shape_vec(shape, numbers)
            .map_err(|error| corrupt(&self.root.join(quantity.name()), error))?;
        Ok((column.edges.clone(), rows))
    }

    /// One scalar of every row, by its name in [`scalars`](Self::scalars), in its unit.
    ///
    /// # Errors
    /// [`StoreError::Missing`] where there is no such scalar, and those of [`rows`](Self::rows).
    pub fn series(&self, name: &str) -> Result<Vec<f64>> {
        // The velocities of a sweep stand in place of the times.
        let name = if name == "time" { self.header().stored("time") } else { name };
        let known = self.scalars();
        if !known.iter().any(|series| series.name == name) {
            let names = known.iter().map(|series| series.name);
            return Err(self.missing(format!("series `{name}`"), holds(names, "")));
        }
        for column in &self.header().quantities {
            let quantity = column.quantity;
            let components = quantity.components().unwrap_or_default();
            if let Some(axis) = components.iter().position(|[component, _]| *component == name) {
                let numbers = self.numbers(quantity.name())?;
                return Ok(numbers.chunks_exact(components.len()).map(|vector| vector[axis]).collect());
            }
        }
        self.numbers(name)
    }

    /// The mean pressure over the contact of every row \[Pa\], NaN where nothing touches: of the load on the cells in contact where a fluid
    /// carries the rest, and of surfaces that adhere less their attraction there, which is the largest.
    ///
    /// # Errors
    /// As of [`series`](Self::series).
    pub fn contact_pressures(&self) -> Result<Vec<f64>> {
        let strength = self.header().adhesion().and_then(|adhesion| adhesion.get("strength")?.as_f64());
        let has = |name: &&str| self.scalars().iter().any(|series| series.name == *name);
        let loads = [Quantity::RepulsiveLoad, Quantity::ContactLoad].map(Quantity::name);
        let rows = self.series(loads.into_iter().find(has).unwrap_or("load"))?.into_iter();
        let rows = rows.zip(self.series("contact_area")?);
        let pressure = |(load, area): (f64, f64)| {
            if area > 0.0 { load / area - strength.unwrap_or(0.0) } else { f64::NAN }
        };
        Ok(rows.map(pressure).collect())
    }

    /// Times of the stored fields \[s\].
    pub fn field_times(&self) -> &[f64] {
        &self.field_times
    }

    /// Rows of the stored fields.
    pub fn field_steps(&self) -> &[usize] {
        &self.field_steps
    }

    /// Number of the stored instant that `at` means; of a time within the run the nearest one.
    ///
    /// # Errors
    /// [`StoreError::Missing`] where there is none, and for a time outside of the run.
    pub fn index(&self, at: At) -> Result<usize> {
        let times = &self.field_times;
        let found = match at {
            At::Index(index) => (index < times.len()).then_some(index),
            At::Last => times.len().checked_sub(1),
            At::Time(time) if !self.is_within(time)? => None,
            At::Time(time) => {
                let distance = |t: &f64| match self.header().axis() {
                    Axis::Velocity if *t > 0.0 && time > 0.0 => libm::log(t / time).abs(),
                    _ => (t - time).abs(),
                };
                let candidates = times.iter().enumerate().filter(|(_, t)| distance(t).is_finite());
                // The last of several at the same distance.
                let nearest = candidates.rev().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
                nearest.map(|(index, _)| index)
            }
        };
        found.ok_or_else(|| {
            let axis = self.header().axis();
            let (unit, several) = (axis.unit(), axis.plural());
            let words = |value: &f64| quantity(*value, unit);
            let what = match at {
                At::Index(index) => format!("fields of number {index}"),
                At::Time(time) => format!("fields at {}", words(&time)),
                At::Last => "fields".to_owned(),
            };
            let instead = match times[..] {
                [] => "no field is stored yet".to_owned(),
                [first, .., last] => {
                    let count = times.len();
                    format!("it holds fields at {count} {several} from {} to {}", words(&first), words(&last))
                }
                [only] => format!("it holds fields at {}", words(&only)),
            };
            self.missing(what, instead)
        })
    }

    /// Whether a time is one of the run, from 0 to its last row.
    fn is_within(&self, time: f64) -> Result<bool> {
        /// A time that is written with 12 digits is inside too.
        const DIGITS: f64 = 1e-12;
        let rows = self.series("time")?;
        let end = rows.iter().chain(&self.field_times).copied().fold(0.0, f64::max);
        Ok((-DIGITS * end..=(1.0 + DIGITS) * end).contains(&time))
    }

    /// A field at a stored instant, in the unit of its kind (shape of the grid, axes x and y).
    /// The contact state comes as 0, 1, 2.
    ///
    /// # Errors
    /// [`StoreError::Missing`] where the kind or the instant was not kept, [`StoreError::Corrupt`] where a
    /// file is missing or damaged, [`StoreError::Io`] where the system refuses.
    pub fn field(&self, kind: FieldKind, at: At) -> Result<Array2<f64>> {
        if kind == FieldKind::Contact {
            return Ok(self.contact(at)?.mapv(f64::from));
        }
        self.field_map(kind, at)
    }

    /// The contact state at a stored instant: 0 out of contact, 1 in contact, 2 at the hardness.
    ///
    /// # Errors
    /// As of [`field`](Self::field).
    pub fn contact(&self, at: At) -> Result<Array2<u8>> {
        self.field_map(FieldKind::Contact, at)
    }

    /// The field that shows the contact: the states if they were kept, else the pressure, where other tractions act too that of the cells in
    /// contact, else the gap.
    pub fn contact_kind(&self) -> Option<FieldKind> {
        let kept = &self.header().fields;
        let pressure = match self.header().has_other_tractions() {
            true => FieldKind::ContactPressure,
            false => FieldKind::Pressure,
        };
        [FieldKind::Contact, pressure, FieldKind::Gap].into_iter().find(|kind| kept.contains(kind))
    }

    /// The contact states at a stored instant (0 open, 1 in contact, 2 at the hardness), from the field of
    /// [`contact_kind`](Self::contact_kind). The gap of a cell in contact is zero to rounding, and below zero at the hardness.
    ///
    /// # Errors
    /// As of [`field`](Self::field).
    pub fn contact_states(&self, at: At) -> Result<Array2<u8>> {
        let hardness = self.header().setup.get("hardness").and_then(Value::as_f64).unwrap_or(f64::INFINITY);
        Ok(match self.contact_kind() {
            Some(FieldKind::Contact) | None => self.contact(at)?,
            Some(kind @ (FieldKind::Pressure | FieldKind::ContactPressure)) => self
                .field(kind, at)?
                .mapv(|p| u8::from(p > 0.0) + u8::from(p > 0.0 && p >= hardness * (1.0 - 1e-12))),
            Some(kind) => {
                let gap = self.field(kind, at)?;
                let deepest =
                    gap.iter().copied().filter(|h| h.is_finite()).fold(0.0, |a: f64, h| a.max(h.abs()));
                gap.mapv(|h| u8::from(h <= 1e-9 * deepest))
            }
        })
    }

    /// The leaks that were computed from the fields of this result.
    pub fn leaks(&self) -> Option<&Leaks> {
        self.document.leaks.as_ref()
    }

    /// One number of every leak, by its name in [`Leaks::series`]; of `conductance` xx, xy, yx, yy each.
    ///
    /// # Errors
    /// [`StoreError::Missing`] where it is not stored, [`StoreError::Corrupt`] where a file is missing or damaged.
    pub fn leak(&self, name: &str) -> Result<Vec<f64>> {
        let along = self.header().stored("leak_time");
        let own = if name == along { "leak_time" } else { name };
        match self.leaks() {
            Some(leaks) if leaks.names.contains(&own) => {
                self.numbers(if own == "leak_time" { along } else { name })
            }
            Some(_) => Err(self.missing(format!("leakage `{name}`"), "its leakage lacks this number".into())),
            None => Err(self.no_leaks()),
        }
    }

    /// Pressure of the fluid \[Pa\] of leak number `index` (shape of the grid).
    ///
    /// # Errors
    /// As of [`leak`](Self::leak).
    pub fn fluid_pressure(&self, index: usize) -> Result<Array2<f64>> {
        if !self.leaks().is_some_and(|leaks| leaks.has_pressure() && index < leaks.rows) {
            let how = "set leakage.field = true in the case, or store it by `asperity leak RESULT --field`";
            return Err(self.missing(format!("fluid pressure {index}"), how.into()));
        }
        self.map("fluid_pressure", &[index as u64])
    }

    /// The undeformed gap \[m\].
    ///
    /// # Errors
    /// [`StoreError::Corrupt`] where a file is missing or damaged, [`StoreError::Io`] where the system refuses.
    pub fn initial_gap(&self) -> Result<Array2<f64>> {
        self.map("initial_gap", &[])
    }

    /// All arrays of the result.
    pub(crate) fn arrays(&self) -> Vec<ArraySpec> {
        self.document.arrays()
    }

    /// The friction of each row; none where nothing moves.
    ///
    /// # Errors
    /// [`StoreError`] where a column cannot be read or is damaged.
    pub fn frictions(&self) -> Result<Vec<Friction>> {
        let stored =
            |quantity: &Quantity| self.header().quantities.iter().any(|column| column.quantity == *quantity);
        let mut columns: Vec<(Quantity, Vec<f64>)> = Quantity::of_motion()
            .chain([Quantity::FrictionCoefficientTotal])
            .filter(stored)
            .map(|quantity| Ok((quantity, self.numbers(quantity.name())?)))
            .collect::<Result<_>>()?;
        if self.header().axis() == Axis::Velocity {
            columns.push((Quantity::Velocity, self.series("time")?));
        }
        let of_row = |row: usize| {
            Friction::from_quantities(|quantity| {
                let (_, numbers) = columns.iter().find(|(name, _)| *name == quantity)?;
                numbers.get(row).copied()
            })
        };
        Ok((0..self.len()).map_while(of_row).collect())
    }

    /// The numbers of an array that holds no maps.
    pub(crate) fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        let spec = self.spec(name)?;
        if spec.storage == Storage::Rows {
            let rows = self.column(&spec)?;
            return Ok(rows.into_iter().map(|bytes| spec.data_type.number(bytes)).collect());
        }
        let mut numbers = Chunks::new(&self.root, &spec).read_whole()?;
        numbers.truncate(spec.shape().iter().product());
        Ok(numbers)
    }

    /// All rows of a per-step array, as the bytes of their numbers.
    pub(super) fn column(&self, spec: &ArraySpec) -> Result<Vec<[u8; 8]>> {
        column::read(&self.root, spec, &self.document.progress.sums)
    }

    /// A map at an index of the dimensions before x.
    pub(crate) fn map<T: Number>(&self, name: &str, index: &[u64]) -> Result<Array2<T>> {
        Chunks::new(&self.root, &self.spec(name)?).read_map(index, self.header().grid.shape())
    }

    /// Compares a map at an index with its checksums.
    pub(super) fn verify_map(&self, name: &str, index: &[u64]) -> Result<()> {
        Chunks::new(&self.root, &self.spec(name)?).verify_map(index, self.header().grid.shape())
    }

    /// Whether the map at an index is stored: the stress may be computed at some of the instants only.
    pub(crate) fn has_map(&self, name: &str, index: &[u64]) -> bool {
        let of_stress = self.document.stress.as_ref().filter(|_| name.starts_with("stress_"));
        of_stress.is_none_or(|set| set.instants.contains(&(index[0] as usize)))
    }

    pub(super) fn document(&self) -> &Document {
        &self.document
    }

    pub(super) fn into_document(self) -> Document {
        self.document
    }

    fn field_map<T: Number>(&self, kind: FieldKind, at: At) -> Result<Array2<T>> {
        if !self.header().fields.contains(&kind) {
            return Err(self.no_field(kind));
        }
        self.map(kind.name(), &[self.index(at)? as u64])
    }

    /// The error of a result that has no row yet.
    pub fn no_rows(&self) -> StoreError {
        self.missing("steps".into(), "its run has not come to one yet".into())
    }

    /// The error of a field that was not kept.
    pub fn no_field(&self, kind: FieldKind) -> StoreError {
        let names: Vec<_> = self.header().fields.iter().map(|kind| kind.name()).collect();
        let how = "name it in output.fields of the case, and run that again";
        let how = match &names[..] {
            [] => how.to_owned(),
            names => format!("it holds the fields {}; {how}", names.join(", ")),
        };
        self.missing(format!("field `{kind}`"), how)
    }

    /// The error of a result without leaks.
    pub fn no_leaks(&self) -> StoreError {
        self.missing("leakage".into(), "`asperity leak RESULT` computes it".into())
    }

    /// The error of a result whose case asked for no quantities.
    pub fn no_quantities(&self) -> StoreError {
        let how = "name some in output.quantities of the case, and run that again";
        self.missing("quantities".into(), how.into())
    }

    fn spec(&self, name: &str) -> Result<ArraySpec> {
        let name = match name {
            "time" => self.header().stored("time"),
            "field_time" => self.header().stored("field_time"),
            name => name,
        };
        let spec = self.arrays().into_iter().find(|spec| spec.name() == name);
        spec.ok_or_else(|| self.missing(format!("array `{name}`"), "it is no array of a result".into()))
    }

    /// The error of a line contact that lacks what needs a plane.
    pub(crate) fn on_line(&self, what: &str) -> StoreError {
        self.missing(what.into(), "it is a line contact".into())
    }

    pub(crate) fn missing(&self, what: String, instead: String) -> StoreError {
        StoreError::Missing { path: self.root.clone(), what, instead }
    }
}

/// What a result holds instead, or what to do where it holds nothing of the kind.
pub(super) fn holds<'n>(names: impl Iterator<Item = &'n str>, otherwise: &str) -> String {
    match &names.collect::<Vec<_>>()[..] {
        [] => otherwise.to_owned(),
        names => format!("it holds {}", names.join(", ")),
    }
}
