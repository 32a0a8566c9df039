//! Small cases of every kind of run, whose numbers are frozen.
//!
//! `cases/NAME.toml` is a case, `numbers/NAME.json` what it gave (see [`frozen`]). A change of the solver that is not meant to change
//! results leaves all numbers within [`frozen::TOLERANCE`]. Counts of iterations and convolutions are compared apart, to the last one.
//!
//! `ASPERITY_GOLDEN=freeze cargo test -p asperity-io --test all golden` writes all files of numbers again, and `ASPERITY_GOLDEN=work`
//! the counts alone; a commit that does either says why. `cargo xtask golden OLD NEW` compares the results of two programs bit by bit.

mod frozen;
mod programs;
mod result;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::{LazyLock, OnceLock};
use std::thread;

use asperity_io::case::Case;
use asperity_io::session::{RunOptions, run};
use asperity_io::store::Status;

use self::frozen::Frozen;
use self::result::Stored;

/// Beside this file.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/all/golden")
}

/// A run is stopped and resumed this often; one whose surfaces have other tractions, whose loops hold more, after each row.
const PARTS: usize = 3;

/// A case, and its result once a test has needed it.
struct Golden {
    name: String,
    path: PathBuf,
    whole: OnceLock<Stored>,
}

impl Golden {
    fn case(&self, keys: &[String]) -> Case {
        Case::read(&self.path, keys).unwrap_or_else(|errors| panic!("{}: {errors}", self.name))
    }

    /// The result of a run that is not stopped, and waits for no checkpoint.
    fn whole(&self) -> &Stored {
        self.whole.get_or_init(|| {
            let place = tempfile::tempdir().unwrap();
            let options =
                RunOptions { output: Some(place.path().join("whole.zarr")), ..RunOptions::default() };
            let summary = run(&self.case(&["output.checkpoint=false".into()]), &options, |_| {})
                .unwrap_or_else(|e| panic!("{}: {e}", self.name));
            assert_eq!(summary.status, Status::Complete, "{}", self.name);
            Stored::read(&summary.result)
        })
    }

    fn numbers(&self) -> PathBuf {
        folder().join("numbers").join(format!("{}.json", self.name))
    }

    /// What of this case is no longer as it was frozen.
    fn changes(&self) -> Vec<String> {
        let text = fs::read_to_string(self.numbers()).unwrap_or_else(|error| {
            panic!("{}: {error}; ASPERITY_GOLDEN=freeze writes it", self.numbers().display())
        });
        let frozen = Frozen::parse(&text);
        let found = Frozen::of(self.whole());
        let changes = frozen.changes(&found, self.case(&[]).conditions.solver.tolerance);
        changes.into_iter().map(|change| format!("{}: {change}", self.name)).collect()
    }
}

/// All cases, by name.
static CASES: LazyLock<Vec<Golden>> = LazyLock::new(|| {
    let paths = fs::read_dir(folder().join("cases")).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    let golden = |path: PathBuf| Golden {
        name: path.file_stem().unwrap().to_string_lossy().into_owned(),
        path,
        whole: OnceLock::new(),
    };
    paths.into_iter().map(golden).collect()
});

#[test]
fn numbers_are_as_they_were_frozen() {
    let changes: Vec<String> = match std::env::var("ASPERITY_GOLDEN").as_deref() {
        Ok("freeze") => {
            for golden in CASES.iter() {
                fs::write(golden.numbers(), Frozen::of(golden.whole()).text()).unwrap();
            }
            vec![]
        }
        Ok("work") => {
            for golden in CASES.iter() {
                let mut frozen = Frozen::parse(&fs::read_to_string(golden.numbers()).unwrap());
                frozen.work = Frozen::of(golden.whole()).work;
                fs::write(golden.numbers(), frozen.text()).unwrap();
            }
            vec![]
        }
        Ok(other) => panic!("ASPERITY_GOLDEN is {other:?}, but must be \"freeze\" or \"work\""),
        Err(_) => CASES.iter().flat_map(Golden::changes).collect(),
    };
    assert!(changes.is_empty(), "{} changes:\n{}", changes.len(), changes.join("\n"));
}

#[test]
fn every_file_of_numbers_has_a_case() {
    let stems = |folder: PathBuf, end: &str| {
        let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let paths = paths.filter(|path| path.extension().is_some_and(|e| e == end));
        let mut stems: Vec<_> = paths.map(|path| path.file_stem().unwrap().to_owned()).collect();
        stems.sort();
        stems
    };
    assert_eq!(stems(folder().join("numbers"), "json"), stems(folder().join("cases"), "toml"));
}

impl Golden {
    /// Stops after so many parts of the rows, goes on each time, and says what is other than in a run that is not stopped.
    fn resumed(&self) -> Option<String> {
        let rows = self.whole().rows();
        let place = tempfile::tempdir().unwrap();
        let output = Some(place.path().join("resumed.zarr"));
        let case = self.case(&[]);
        let parts = if self.case(&[]).conditions.traction.is_some() { rows } else { PARTS.min(rows) };
        let mut before = 0;
        // The last part is the rest.
        for part in 1..=parts {
            let until = (part * rows).div_ceil(parts);
            let options = RunOptions { output: output.clone(), resume: part > 1, ..RunOptions::default() };
            let stop = options.interrupt.clone();
            let mut resumed = 0;
            let summary = run(&case, &options, |progress| {
                resumed = progress.resumed;
                stop.store(until < rows && progress.done >= until, Ordering::Relaxed);
            });
            let summary = summary.unwrap_or_else(|error| panic!("{}: {error}", self.name));
            let status = if part == parts { Status::Complete } else { Status::Interrupted };
            assert_eq!((summary.status, resumed), (status, before), "{}", self.name);
            before = until;
        }
        let change = self.whole().compare(&Stored::read(&place.path().join("resumed.zarr")));
        change.map(|change| format!("{}: {change}", self.name))
    }
}

#[test]
fn a_run_that_is_stopped_and_resumed_ends_with_the_same_bits() {
    // Checkpoints wait for the disk: others go on meanwhile. From the last case on, as the other test begins with the first.
    const WORKERS: usize = 4;
    let part =
        |worker| CASES.iter().rev().skip(worker).step_by(WORKERS).filter_map(Golden::resumed).collect();
    let changes: Vec<String> = thread::scope(|scope| {
        let workers: Vec<_> =
            (0..WORKERS).map(|worker| scope.spawn(move || -> Vec<String> { part(worker) })).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    assert!(changes.is_empty(), "not the same bits:\n{}", changes.join("\n"));
}
