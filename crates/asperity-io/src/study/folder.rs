//! The folder of a study: `study.json` says what the study is, so that a call with another case or other keys is refused.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::plan::{Plan, Run};
use super::rows::{self, Row, State};
use super::table::Table;
use super::{StudyError, dataset};
use crate::case::study::Base;
use crate::case::{Case, Surface};
use crate::compare::other_line;
use crate::digest::md5;
use crate::output::{WriteError, write_all};
use crate::resources;

const NAME: &str = "study.json";
const LOCK: &str = ".study.lock";
/// The form of `study.json`.
const FORM: u64 = 1;
/// A larger file is none of ours \[byte\].
const LARGEST: u64 = 256 << 20;

/// A study and its folder.
pub struct Study {
    /// The folder.
    pub folder: PathBuf,
    /// What varies.
    pub plan: Plan,
    /// The runs, in order.
    pub runs: Vec<Run>,
    /// The case; `None` where only the folder is looked at.
    pub(super) base: Option<Base>,
    /// Memory that each run takes \[byte\], where the case is known.
    pub(super) memory: Vec<u64>,
}

/// What `study.json` holds.
#[derive(Serialize, Deserialize)]
struct Stored {
    form: u64,
    asperity: String,
    /// Text of the case without what varies.
    case: String,
    #[serde(flatten)]
    plan: Plan,
    /// MD5 of the files that the cases name.
    files: BTreeMap<String, String>,
}

impl Study {
    /// The study of a case, in a folder that is made, or that holds the same study already. All of its cases are checked. `vary` are
    /// `KEY=VALUES`, `set` are overrides of the case, and `zip` is `None` where the case decides.
    ///
    /// # Errors
    /// [`StudyError`]: the case, a key or a value is wrong; the folder holds another study.
    pub fn new(
        case: &Path,
        vary: &[String],
        zip: Option<bool>,
        set: &[String],
        folder: &Path,
    ) -> Result<Study, StudyError> {
        let base = Base::read(case, set)?;
        let plan = Plan::of(&base, vary, zip)?;
        let runs = plan.runs();
        let (mut memory, mut files) = (vec![], BTreeMap::new());
        for run in &runs {
            let case = base.case(&plan.overrides(run))?;
            memory.push(case.memory_of_run());
            note_files(&case, &mut files);
        }
        let (form, asperity) = (FORM, env!("CARGO_PKG_VERSION").to_owned());
        let stored = Stored { form, asperity, case: base.text()?, plan: plan.clone(), files };
        if folder.exists() && !folder.is_dir() {
            let message = format!("-o {} is no folder; name a folder for the results", folder.display());
            return Err(StudyError::Input(message));
        }
        fs::create_dir_all(folder).map_err(failed("make", folder))?;
        let study = Study { folder: folder.to_owned(), plan, runs, base: Some(base), memory };
        let _held = study.lock();
        // Looked for first: where the file system has no locks, another process may write study.json and then its table meanwhile.
        let foreign = study.foreign();
        match (Stored::read(folder)?, foreign) {
            (Some(old), _) => study.check(&old, &stored)?,
            (None, Some(name)) => {
                let message = format!(
                    "{} has a {name}, but no study.json: it would be replaced; choose another folder with -o",
                    folder.display()
                );
                return Err(StudyError::Input(message));
            }
            (None, None) => {}
        }
        let text = serde_json::to_string_pretty(&stored).unwrap_or_default();
        study.write(NAME, text.as_bytes())?;
        Ok(study)
    }

    /// The number of runs of the study of a case that is this text, of which the first ones, so many as `checked` says, are
    /// checked; its files are relative to `directory`.
    ///
    /// # Errors
    /// Where case, keys or values are wrong, as [`Study::new`].
    pub fn runs_of(
        text: &str,
        directory: &Path,
        vary: &[String],
        checked: usize,
    ) -> Result<usize, StudyError> {
        let base = Base::of("case".to_owned(), text.to_owned(), directory, &[])?;
        let plan = Plan::of(&base, vary, None)?;
        let runs = plan.runs();
        runs.iter().take(checked).try_for_each(|run| base.case(&plan.overrides(run)).map(drop))?;
        Ok(runs.len())
    }

    /// The study in a folder.
    ///
    /// # Errors
    /// [`StudyError`]: there is none.
    pub fn open(folder: &Path) -> Result<Study, StudyError> {
        let Some(stored) = Stored::read(folder)? else {
            let why = if folder.is_dir() { "it has no study.json" } else { "there is no such folder" };
            return Err(StudyError::Input(format!(
                "{} is not the folder of a study: {why}; `asperity study CASE -o DIR` makes one",
                folder.display()
            )));
        };
        let runs = stored.plan.runs();
        Ok(Study { folder: folder.to_owned(), plan: stored.plan, runs, base: None, memory: vec![] })
    }

    /// Refuses to go on with another study; values may be added.
    fn check(&self, old: &Stored, new: &Stored) -> Result<(), StudyError> {
        let refused = |what: String| {
            Err(StudyError::Input(format!(
                "{} holds another study: {what}; choose another folder with -o",
                self.folder.display()
            )))
        };
        let keys = |plan: &Plan| plan.vary.iter().map(|varied| varied.key.clone()).collect::<Vec<_>>();
        let (before, now) = (keys(&old.plan), keys(&new.plan));
        if before != now {
            return refused(format!("it varies {}, not {}", before.join(", "), now.join(", ")));
        }
        if old.plan.zip != new.plan.zip {
            let words = |zip| if zip { "--zip" } else { "--product" };
            return refused(format!("it was made with {}, not {}", words(old.plan.zip), words(new.plan.zip)));
        }
        if old.case != new.case {
            let told = match other_line(&old.case, &new.case) {
                Some((n, [before, now])) => format!("line {n} was {before} and is {now}"),
                None => "its line ends".to_owned(),
            };
            return refused(format!("the case has changed: {told}"));
        }
        let changed =
            |(path, digest): (&String, &String)| old.files.get(path).is_some_and(|old| old != digest);
        if let Some((path, _)) = new.files.iter().find(|file| changed(*file)) {
            return refused(format!("the file {path} has changed"));
        }
        let names: std::collections::HashSet<&str> = self.runs.iter().map(|run| run.name.as_str()).collect();
        let runs = old.plan.runs();
        if let Some(gone) = runs.iter().find(|run| !names.contains(run.name.as_str())) {
            let label = old.plan.label(gone);
            return refused(format!(
                "it has a run with {label}, which is not asked for; values can only be added"
            ));
        }
        Ok(())
    }

    /// A file that a study would replace.
    fn foreign(&self) -> Option<&'static str> {
        ["study.csv", dataset::NAME, "study.png", "study.html"]
            .into_iter()
            .find(|name| self.folder.join(name).exists())
    }

    /// The case of a run.
    pub(super) fn case(&self, run: &Run) -> Result<Option<Case>, StudyError> {
        Ok(self.base.as_ref().map(|base| base.case(&self.plan.overrides(run))).transpose()?)
    }

    /// The result of a run.
    pub fn result(&self, run: &Run) -> PathBuf {
        self.folder.join(&run.name)
    }

    /// Where the reason stands why a run failed.
    pub(super) fn error_file(&self, run: &Run) -> PathBuf {
        self.result(run).with_extension("error")
    }

    /// Every run as its result says.
    pub fn rows(&self) -> Vec<Row> {
        self.runs.iter().map(|run| rows::of(self, run)).collect()
    }

    /// The runs as a table.
    pub fn table(&self, rows: Vec<Row>) -> Table {
        Table::new(self, rows)
    }

    /// Writes `study.csv`, of runs that end as this process reads them. `known` are the rows of runs that have ended; they are
    /// completed.
    pub(super) fn write_table(&self, known: &mut [Option<Row>]) -> Result<(), StudyError> {
        // What is read and what is written go together: another process does the same.
        let _held = self.lock();
        let mut rows = vec![];
        for (run, known) in self.runs.iter().zip(known) {
            let row = known.clone().unwrap_or_else(|| rows::of(self, run));
            if row.state == State::Done {
                *known = Some(row.clone());
            }
            rows.push(row);
        }
        self.write("study.csv", self.table(rows).csv().as_bytes())
    }

    /// Writes `study.csv` and `study.zarr` of what is there, and returns the table.
    ///
    /// # Errors
    /// [`StudyError::Io`].
    pub fn collect(&self) -> Result<Table, StudyError> {
        self.collect_if(|_| true)
    }

    /// Writes `study.csv`, and `study.zarr` if it is time for that.
    pub(super) fn collect_if(&self, is_time: impl Fn(&Table) -> bool) -> Result<Table, StudyError> {
        let _held = self.lock();
        let table = self.table(self.rows());
        self.write("study.csv", table.csv().as_bytes())?;
        if is_time(&table) {
            dataset::write(self, &table)?;
        }
        Ok(table)
    }

    /// Held while files of the whole study are written; nothing where the file system has no locks.
    fn lock(&self) -> Option<File> {
        let file = File::create(self.folder.join(LOCK)).ok()?;
        file.lock().ok()?;
        Some(file)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        write_all(&self.folder.join(name), true, bytes).map_err(|error| match error {
            WriteError::Io { path, source } => StudyError::Io { path, action: "write", source },
            error @ WriteError::Exists { .. } => StudyError::Input(error.to_string()),
        })
    }
}

impl Stored {
    /// What the folder holds; `None` where it is no study.
    fn read(folder: &Path) -> Result<Option<Stored>, StudyError> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Ok(None);
        }
        let damaged =
            |why: String| StudyError::Input(format!("{} is not that of a study: {why}", path.display()));
        let text = resources::text(&path, LARGEST).map_err(damaged)?;
        let stored: Stored = serde_json::from_str(&text).map_err(|error| damaged(error.to_string()))?;
        match stored.form {
            FORM => Ok(Some(stored)),
            form => Err(damaged(format!("it has the form {form}, which a later version wrote"))),
        }
    }
}

/// Notes the files that a case names, with their digests; one that cannot be read is an error of its run.
fn note_files(case: &Case, files: &mut BTreeMap<String, String>) {
    for (path, digest) in &case.files {
        files.insert(path.clone(), digest.clone());
    }
    for surface in &case.surfaces {
        if let Surface::File(file) = surface {
            let path = file.path.display().to_string();
            if !files.contains_key(&path)
                && let Ok(bytes) = resources::read(&file.path)
            {
                files.insert(path, md5(&bytes));
            }
        }
    }
}

/// The error of a file.
pub(super) fn failed(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> StudyError {
    let path = path.to_owned();
    move |source| StudyError::Io { path: path.clone(), action, source }
}
