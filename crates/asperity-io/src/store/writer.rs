//! The writing end of a result.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use asperity::finding::Finding;
use asperity::step::{Checkpoint, Row};
use ndarray::ArrayView2;

use super::checkpoint;
use super::checksum::Sums;
use super::chunks::Chunks;
use super::column::Column;
use super::create;
use super::document::{Document, Pages};
use super::error::{Result, StoreError, input, io};
use super::field_kind::FieldKind;
use super::header::{Header, Progress, SCHEMA, Status, Work};
use super::layout::SCALARS;
use super::leftovers;
use super::replace::Way;
use super::stress::{self, StressSet};
use super::sync;

/// Steps that follow each other faster than this are committed the quick way (see [`super::replace`]).
const QUICK: Duration = Duration::from_millis(20);
/// The arrays' own documents are brought up to date when they have lagged this long.
const LAG: Duration = Duration::from_secs(1);
/// Least time between two synchronisations with the medium. One takes a tenth of a second for the
/// fields that a run of 1024 x 1024 cells stores in that time.
const SYNC_PAUSE: Duration = Duration::from_secs(5);
/// File systems may round the times of files by so much.
const CLOCK: Duration = Duration::from_secs(2);
/// A checkpoint is due when the time since the last is this many times what its writing took.
const CHECKPOINT_SHARE: u32 = 100;

/// A field of one step, to be kept.
#[derive(Clone, Copy, Debug)]
pub enum Field<'a> {
    /// A field of this kind, in its unit.
    Real(FieldKind, ArrayView2<'a, f64>),
    /// The contact state: 0 out of contact, 1 in contact, 2 at the hardness.
    Contact(ArrayView2<'a, u8>),
}

impl Field<'_> {
    /// Its kind.
    pub fn kind(&self) -> FieldKind {
        match self {
            Field::Real(kind, _) => *kind,
            Field::Contact(_) => FieldKind::Contact,
        }
    }

    fn dim(&self) -> (usize, usize) {
        match self {
            Field::Real(_, map) => map.dim(),
            Field::Contact(map) => map.dim(),
        }
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// How far it came.
    pub status: Status,
    /// Why it stopped, where it is not complete.
    pub message: Option<String>,
    /// Largest memory of the process \[byte\], where measured.
    pub peak_memory_bytes: Option<u64>,
    /// Threads used, where known.
    pub threads: Option<usize>,
}

impl Outcome {
    /// An end without further particulars.
    pub fn new(status: Status) -> Self {
        Outcome { status, message: None, peak_memory_bytes: None, threads: None }
    }
}

/// A result that is being written.
///
/// A step is handed to the operating system as a whole before [`append`](Self::append) returns, so that
/// a process killed at any instant leaves a readable result with every step appended before.
/// At a checkpoint, but no more often than every five seconds, all of that is also brought to the medium: a loss of
/// power takes what came after it.
/// Dropped without [`finish`](Self::finish), the result stays as that of a killed run.
pub struct Writer {
    root: PathBuf,
    pub(super) document: Document,
    pages: Pages,
    /// The [`SCALARS`] and the quantities that were asked for.
    per_row: Vec<Column>,
    /// `field_time` and `field_step`.
    per_map: [Column; 2],
    fields: Vec<(FieldKind, Chunks)>,
    /// The coordinate of the last row.
    last: f64,
    /// Maps written that the next row brings into the result, and the coordinate of the last of them.
    staged: usize,
    last_staged: f64,
    wall_before: f64,
    started: Instant,
    committed: Instant,
    documents_written: Instant,
    documents_behind: bool,
    checkpoint: Option<(Instant, Duration)>,
    /// When the result was brought to the medium last, by the clock of this process and by that of the files.
    synchronised: (Instant, SystemTime),
    /// The directory that is written: another one may take its path.
    directory: Option<Identity>,
    _lock: Option<File>,
}

/// Device and number of a directory, where the system tells.
type Identity = (u64, u64);

#[cfg(unix)]
fn identity(directory: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(directory).ok().map(|found| (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn identity(_: &Path) -> Option<Identity> {
    None
}

impl std::fmt::Debug for Writer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Writer").field("root", &self.root).field("rows", &self.len()).finish()
    }
}

impl Writer {
    /// Starts a result at `path`, with no rows yet. `initial_gap` \[m\] has the shape of the grid.
    ///
    /// With `force` a result that is there already is replaced. The directory appears as a whole:
    /// a failure on the way leaves what was there.
    ///
    /// # Errors
    /// [`StoreError::Exists`] where something is at `path` and `force` is not set;
    /// [`StoreError::Foreign`] where it is not a result or holds other files, which are never removed;
    /// [`StoreError::Busy`] where a run is writing it; [`StoreError::Input`] where the shape is wrong;
    /// [`StoreError::Io`] where the system refuses.
    pub fn create(
        path: &Path,
        header: &Header,
        initial_gap: ArrayView2<'_, f64>,
        force: bool,
    ) -> Result<Writer> {
        check_shape("shape of the initial gap", initial_gap.dim(), header)?;
        if let Some(kind) =
            header.fields.iter().find(|kind| header.fields.iter().filter(|k| k == kind).count() > 1)
        {
            return Err(input("fields of the result", format!("{kind} twice"), "each named once"));
        }
        let (header, progress) = (header.clone(), Progress::default());
        let document =
            Document { form: SCHEMA, header, progress, stress: None, leaks: None, error_bars: None };
        let lock = create::publish(path, force, |root| {
            create::write_constants(root, &document, initial_gap)?;
            Pages::publish(root, &document).map(drop)
        })?;
        Writer::attach(path, document, lock, f64::NEG_INFINITY)
    }

    /// A writer that goes on after the rows and fields of `document`.
    pub(super) fn attach(root: &Path, document: Document, lock: Option<File>, last: f64) -> Result<Writer> {
        let specs = document.arrays();
        let spec = |name: &'static str| {
            let name = document.header.stored(name);
            let found = specs.iter().find(|spec| spec.name() == name);
            found.ok_or_else(|| input("array", name, "one of a result"))
        };
        let Progress { rows, maps, sums, .. } = &document.progress;
        let column = |name: &'static str, rows| Ok(Column::new(root, spec(name)?, rows, sums));
        let quantities = document.header.quantities.iter().map(|column| column.quantity.name());
        let per_row = SCALARS.iter().map(|scalar| scalar.name).chain(quantities);
        let fields = document.header.fields.iter();
        let fields = fields.map(|kind| Ok((*kind, Chunks::new(root, spec(kind.name())?))));
        Ok(Writer {
            per_row: per_row.map(|name| column(name, *rows)).collect::<Result<_>>()?,
            per_map: [column("field_time", *maps)?, column("field_step", *maps)?],
            fields: fields.collect::<Result<_>>()?,
            root: root.to_owned(),
            last,
            staged: 0,
            last_staged: last,
            wall_before: document.progress.work.wall_s,
            started: Instant::now(),
            committed: Instant::now(),
            documents_written: Instant::now(),
            documents_behind: false,
            // The first one is not brought to the medium: it may not replace one that is.
            checkpoint: (*rows > 0).then(|| (Instant::now(), Duration::ZERO)),
            synchronised: (Instant::now(), SystemTime::UNIX_EPOCH),
            pages: Pages::new(&document),
            document,
            directory: identity(root),
            _lock: lock,
        })
    }

    /// Refuses to write where the result was moved or removed: its path may be that of another one now.
    fn check_place(&self) -> Result<()> {
        if identity(&self.root) == self.directory {
            return Ok(());
        }
        let source = std::io::Error::other("the result was moved or removed while it was written");
        Err(StoreError::Io { path: self.root.clone(), action: "write into", source })
    }

    /// Refuses a coordinate below the `last` one.
    fn check_order(&self, of: &str, at: f64, last: f64) -> Result<()> {
        if at >= last {
            return Ok(());
        }
        let axis = self.document.header.axis();
        let (name, unit) = (axis.name(), axis.unit());
        let expected = format!("not less than the {name} before it, {last} {unit}");
        Err(input(format!("{name} of the {of}"), format!("{at} {unit}"), expected))
    }

    /// The directory of the result.
    pub fn path(&self) -> &Path {
        &self.root
    }

    /// Rows stored so far.
    pub fn len(&self) -> usize {
        self.document.progress.rows
    }

    /// Whether no row is stored yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Work done so far, with that of the sessions before a resume.
    pub fn work(&self) -> &Work {
        &self.document.progress.work
    }

    /// Appends a step: its row and, where the step is one whose fields are kept, all fields of the
    /// header (in any order; none otherwise).
    ///
    /// # Errors
    /// [`StoreError::Input`] where the fields are not those of the header or time runs backwards;
    /// [`StoreError::Io`] where the system refuses, for example on a full disk. The step is then not
    /// stored, those before it are, and the same step may be appended again.
    pub fn append(&mut self, row: &Row, fields: &[Field<'_>]) -> Result<()> {
        self.append_with(row, &[], fields)
    }

    /// Appends a step with the quantities of the header: their numbers one after the other, as
    /// [`Step::quantities`](asperity::step::Step::quantities) gives them.
    ///
    /// # Errors
    /// As [`append`](Self::append); [`StoreError::Input`] where there are more or fewer numbers.
    pub fn append_with(&mut self, row: &Row, quantities: &[f64], fields: &[Field<'_>]) -> Result<()> {
        let wanted: usize = self.per_row.iter().skip(SCALARS.len()).map(Column::width).sum();
        if quantities.len() != wanted {
            let expected = format!("{wanted}, those of the header");
            return Err(input("numbers of the quantities", quantities.len(), expected));
        }
        let at = row.coordinate.value();
        self.check_order("row", at, self.last)?;
        self.check_place()?;
        self.check_fields(fields)?;
        if self.staged > 0 {
            self.check_order("row", at, self.last_staged)?;
        }
        let (rows, maps) = (self.len(), self.document.progress.maps + self.staged);
        let numbers: Vec<f64> =
            SCALARS.iter().map(|scalar| scalar.of(row)).chain(quantities.iter().copied()).collect();
        let mut rest = numbers.as_slice();
        for column in &mut self.per_row {
            let (own, after) = rest.split_at(column.width());
            column.put(rows, own)?;
            rest = after;
        }
        let mut progress = self.document.progress.clone();
        progress.maps = maps;
        if !fields.is_empty() {
            self.write_maps(maps, at, fields)?;
            progress.maps += 1;
        }
        progress.rows += 1;
        progress.work.iterations += row.iterations as u64;
        progress.work.convolutions += row.convolutions as u64;
        progress.work.wall_s = self.wall();
        if self.document.form > 1 {
            let (rows, maps, sums) = (progress.rows, progress.maps, &mut progress.sums);
            self.per_row.iter().for_each(|column| column.sum(rows, sums));
            self.per_map.iter().for_each(|column| column.sum(maps, sums));
        }
        let way = if self.committed.elapsed() < QUICK { Way::Quick } else { Way::Safe };
        self.pages.commit(&self.root, &progress, way)?;
        self.committed = Instant::now();
        self.per_row.iter_mut().for_each(|column| column.commit(progress.rows));
        self.per_map.iter_mut().for_each(|column| column.commit(progress.maps));
        self.document.progress = progress;
        self.staged = 0;
        self.last = at;
        self.documents_behind = true;
        if self.documents_written.elapsed() > LAG {
            self.flush_documents(Way::Quick)?;
        }
        Ok(())
    }

    /// Writes the fields of a state between the last row and the next, which is appended then and brings them into the
    /// result: their `field_step` is that row, their `field_time` is `time` \[s\].
    ///
    /// # Errors
    /// As of [`append`](Self::append); without fields nothing is done.
    pub fn stage(&mut self, time: f64, fields: &[Field<'_>]) -> Result<()> {
        self.check_order("fields", time, if self.staged > 0 { self.last_staged } else { self.last })?;
        self.check_place()?;
        self.check_fields(fields)?;
        if fields.is_empty() {
            return Ok(());
        }
        self.write_maps(self.document.progress.maps + self.staged, time, fields)?;
        self.staged += 1;
        self.last_staged = time;
        Ok(())
    }

    /// Writes the fields of number `map`.
    fn write_maps(&mut self, map: usize, time: f64, fields: &[Field<'_>]) -> Result<()> {
        for field in fields {
            let index = [map as u64];
            let Some((_, chunks)) = self.fields.iter().find(|(kind, _)| *kind == field.kind()) else {
                continue;
            };
            match field {
                Field::Contact(map) => chunks.write_map(&index, *map)?,
                Field::Real(_, map) => chunks.write_map(&index, *map)?,
            }
        }
        let numbers = [time, self.len() as f64];
        self.per_map.iter_mut().zip(numbers).try_for_each(|(column, number)| column.put(map, &[number]))
    }

    /// Sets the stress below the surface that readers see; `sums` are the checksums of its per-step arrays.
    pub(super) fn set_stress(&mut self, stress: Option<StressSet>, sums: Sums) -> Result<()> {
        let Document { form, progress, stress: known, .. } = &mut self.document;
        progress.sums.retain(|name, _| !stress::names().any(|own| own == name));
        if *form > 1 {
            progress.sums.extend(sums);
        }
        *known = stress;
        self.publish()
    }

    /// Replaces the documents of the result: arrays were added to it, or taken away.
    pub(super) fn publish(&mut self) -> Result<()> {
        // The errors of what it had before are those of other answers.
        self.document.error_bars = None;
        self.pages = Pages::publish(&self.root, &self.document)?;
        Ok(())
    }

    /// The findings of the run so far.
    pub fn findings(&self) -> &[Finding] {
        &self.document.progress.findings
    }

    /// Sets the findings of the run; readers see them with the next row, [`note`](Self::note) or end.
    pub fn set_findings(&mut self, findings: Vec<Finding>) {
        self.document.progress.findings = findings;
    }

    /// Sets the findings of the run, which readers see at once.
    ///
    /// # Errors
    /// [`StoreError::Io`] where the system refuses.
    pub fn note(&mut self, findings: Vec<Finding>) -> Result<()> {
        self.check_place()?;
        self.set_findings(findings);
        self.pages.commit(&self.root, &self.document.progress, Way::Quick)
    }

    /// Whether writing a checkpoint now keeps the writing of all of them below 1 % of the time. They are five seconds apart
    /// at least. A killed run repeats what came after its last checkpoint.
    pub fn checkpoint_due(&self) -> bool {
        self.checkpoint.is_none_or(|(at, cost)| at.elapsed() > (CHECKPOINT_SHARE * cost).max(SYNC_PAUSE))
    }

    /// Replaces the checkpoint by the state after the last row appended.
    ///
    /// # Errors
    /// [`StoreError::Input`] where the checkpoint is not of the rows stored; [`StoreError::Io`] where the
    /// system refuses (the checkpoint before it is kept).
    pub fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        if checkpoint.step != self.len() {
            let expected = format!("{}, the rows stored", self.len());
            return Err(input("rows of the checkpoint", checkpoint.step, expected));
        }
        self.check_place()?;
        let start = Instant::now();
        let is_synced = self.synchronised.0.elapsed() >= SYNC_PAUSE;
        if is_synced {
            self.synchronise()?;
            // First, so that no checkpoint is of more rows than the copy.
            self.pages.write_copy(&self.root)?;
        }
        checkpoint::write(&self.root, checkpoint, is_synced)?;
        self.checkpoint = Some((Instant::now(), start.elapsed()));
        Ok(())
    }

    /// Brings rows, fields and documents to the medium.
    fn synchronise(&mut self) -> Result<()> {
        let started = SystemTime::now();
        sync::result(&self.root, self.synchronised.1)?;
        self.synchronised = (Instant::now(), started.checked_sub(CLOCK).unwrap_or(SystemTime::UNIX_EPOCH));
        Ok(())
    }

    /// Ends the result. Where the run is complete its checkpoint is removed, and so is the complete result that it replaces;
    /// otherwise both are kept, the checkpoint for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`StoreError::Io`] where the system refuses.
    pub fn finish(mut self, outcome: &Outcome) -> Result<Work> {
        self.check_place()?;
        let wall = self.wall();
        let Progress { status, work, .. } = &mut self.document.progress;
        *status = outcome.status;
        work.message = outcome.message.clone();
        work.peak_memory_bytes = work.peak_memory_bytes.max(outcome.peak_memory_bytes);
        work.threads = outcome.threads.or(work.threads);
        work.wall_s = wall;
        // The documents of the arrays first: those of a complete result do not lag behind.
        self.flush_documents(Way::Safe)?;
        self.pages.commit(&self.root, &self.document.progress, Way::Safe)?;
        if self.synchronised.0.elapsed() >= SYNC_PAUSE {
            self.synchronise()?;
        }
        if outcome.status == Status::Complete {
            remove(&self.root.join(checkpoint::DIRECTORY))?;
            leftovers::remove_kept(&self.root);
        } else if let Some(kept) = leftovers::kept(&self.root) {
            tracing::warn!("the complete result that this one replaces is kept in {}", kept.display());
        }
        Ok(self.document.progress.work.clone())
    }

    fn wall(&self) -> f64 {
        self.wall_before + self.started.elapsed().as_secs_f64()
    }

    fn check_fields(&self, fields: &[Field<'_>]) -> Result<()> {
        let header = &self.document.header;
        for field in fields {
            check_shape(&format!("shape of the {}", field.kind()), field.dim(), header)?;
            if matches!(field, Field::Real(FieldKind::Contact, _)) {
                return Err(input("contact state", "a field of real numbers", "a `Field::Contact`"));
            }
        }
        let same = fields.len() == self.fields.len()
            && self.fields.iter().all(|(kind, _)| fields.iter().any(|field| field.kind() == *kind));
        if fields.is_empty() || same {
            return Ok(());
        }
        let names = |kinds: &[FieldKind]| kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ");
        let given: Vec<FieldKind> = fields.iter().map(Field::kind).collect();
        let expected = format!("those of the result: {}", names(&header.fields));
        Err(input("fields of the step", names(&given), expected))
    }

    fn flush_documents(&mut self, way: Way) -> Result<()> {
        self.pages.write_arrays(&self.root, way)?;
        self.documents_written = Instant::now();
        self.documents_behind = false;
        Ok(())
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        if self.documents_behind && self.check_place().is_ok() {
            // An error cannot be reported any more; readers of the group's document miss nothing.
            let _ = self.flush_documents(Way::Quick);
        }
    }
}

/// Takes the result at `root` for writing. The system frees it when the process ends, however it ends.
pub(super) fn lock(root: &Path) -> Result<Option<File>> {
    // Not every file system can lock, nor can every system open a directory: there, nothing is held.
    let Ok(directory) = File::open(root) else { return Ok(None) };
    // A reader that looks whether the result is being written holds it for an instant.
    for pause in [1, 5, 25, 100, 0] {
        match directory.try_lock() {
            Ok(()) => return Ok(Some(directory)),
            Err(TryLockError::Error(_)) => return Ok(None),
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(pause)),
        }
    }
    Err(StoreError::Busy { path: root.to_owned() })
}

fn check_shape(what: &str, (nx, ny): (usize, usize), header: &Header) -> Result<()> {
    if (nx, ny) == header.grid.shape() {
        return Ok(());
    }
    let [mx, my] = header.grid.cells();
    Err(input(what, format!("{nx} x {ny}"), format!("that of the grid, {mx} x {my}")))
}

/// Removes a file or directory of a result; nothing happens where it is absent.
pub(super) fn remove(path: &Path) -> Result<()> {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    match removed {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(io("remove", path)(error)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::Grid;
    use ndarray::Array2;

    #[test]
    fn a_checkpoint_after_the_pause_is_on_the_medium_with_a_copy_of_the_document() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("result.zarr");
        let header = Header {
            title: String::new(),
            case_text: String::new(),
            version: "0".into(),
            grid: Grid::new([4, 3], [1.0, 1.0]).unwrap(),
            fields: vec![FieldKind::Pressure],
            quantities: vec![],
            rows_expected: None,
            setup: Default::default(),
        };
        let map = Array2::zeros((4, 3));
        let mut writer = Writer::create(&path, &header, map.view(), false).unwrap();
        let copy = path.join(checkpoint::DIRECTORY).join(checkpoint::GROUP);
        for rows in 1..=2 {
            writer.append(&Row::default(), &[Field::Real(FieldKind::Pressure, map.view())]).unwrap();
            writer.checkpoint(&Checkpoint { step: rows, numbers: vec![], fields: vec![] }).unwrap();
            assert_eq!(copy.exists(), rows == 2);
            assert!(!writer.checkpoint_due());
            writer.synchronised.0 = Instant::now().checked_sub(SYNC_PAUSE).unwrap();
        }
        assert_eq!(fs::read(copy).unwrap(), fs::read(path.join("zarr.json")).unwrap());
        // Systems that synchronise file by file find all of them.
        sync::result_by_files(&path, SystemTime::UNIX_EPOCH).unwrap();
    }
}
