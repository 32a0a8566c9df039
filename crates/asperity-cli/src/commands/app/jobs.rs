//! The runs: one at a time, the others wait. A run is a process of this program that outlives the page and the application; what
//! became of it stands in a file, so that coming back finds it.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use asperity_io::output::write_all;
use asperity_io::store::Reader;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::action::Action;
use super::case::{changed, ready};
use super::folder::Folder;
use crate::failure::Failure;

/// Pause between two looks at the queue.
const PAUSE: Duration = Duration::from_millis(100);
/// A process whose log is younger may be the run, even if it does not write its result at the moment.
const YOUNG: Duration = Duration::from_secs(30);
/// Finished runs that are kept.
const KEPT: usize = 30;
/// Bytes of the end of a log that are looked at.
const TAIL: usize = 4000;

/// A run.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Job {
    id: u64,
    /// What is run: its command line is made and checked anew when it begins.
    action: Action,
    /// The command line and its Python, for copying.
    shell: String,
    python: String,
    case: String,
    result: String,
    state: State,
    pid: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum State {
    Waiting,
    Running,
    Done,
    Stopped,
    Failed,
}

/// The queue.
#[derive(Clone)]
pub struct Jobs {
    folder: Folder,
    /// Where the list and the logs are.
    place: PathBuf,
    list: Arc<Mutex<Vec<Job>>>,
}

impl Jobs {
    /// The queue as it was left. What waits in it waits for a click: who writes into the folder starts nothing.
    pub fn start(folder: &Folder, place: PathBuf) -> Result<Jobs, Failure> {
        let known = own_text(&place.join("runs.json"));
        let mut list: Vec<Job> =
            known.and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default();
        list.iter_mut().filter(|job| job.state == State::Waiting).for_each(|job| job.state = State::Stopped);
        let jobs = Jobs { folder: folder.clone(), place, list: Arc::new(Mutex::new(list)) };
        let worker = jobs.clone();
        let started = std::thread::Builder::new().spawn(move || worker.work());
        started.map_err(|error| Failure::System(format!("cannot start a thread: {error}")))?;
        Ok(jobs)
    }

    fn list(&self) -> MutexGuard<'_, Vec<Job>> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a run at the end of the queue, unless one writes the same result.
    pub fn add(&self, action: Action, shell: String, python: String) -> Result<u64, String> {
        let Some([case, result]) = action.run().map(|names| names.map(str::to_owned)) else {
            return Err("this is no run".to_owned());
        };
        let mut list = self.list();
        let is_open = |job: &&Job| matches!(job.state, State::Waiting | State::Running);
        if let Some(job) = list.iter().filter(is_open).find(|job| job.result == result) {
            return Err(format!(
                "{result} is written by the run of {} already; choose another name",
                job.case
            ));
        }
        let id = list.iter().map(|job| job.id).max().unwrap_or(0).saturating_add(1);
        list.push(Job { id, action, shell, python, case, result, state: State::Waiting, pid: None });
        let over = list.iter().filter(|job| !is_open(job)).count().saturating_sub(KEPT);
        let mut left = over;
        list.retain(|job| {
            is_open(&job) || left == 0 || {
                left -= 1;
                false
            }
        });
        self.save(&list);
        Ok(id)
    }

    /// Stops a run after the row that it is at, or takes it out of the queue.
    pub fn stop(&self, id: u64) -> Result<(), String> {
        let mut list = self.list();
        let job = list.iter_mut().find(|job| job.id == id).ok_or("there is no such run")?;
        match (job.state, job.pid) {
            (State::Waiting, _) => job.state = State::Stopped,
            (State::Running, Some(pid)) if self.is_alive(job) => interrupt(pid)?,
            _ => return Err("this run has ended already".to_owned()),
        }
        self.save(&list);
        Ok(())
    }

    /// Puts a run that has ended into the queue again: it goes on with what it has written.
    pub fn again(&self, id: u64) -> Result<(), String> {
        let mut list = self.list();
        let job = list.iter_mut().find(|job| job.id == id).ok_or("there is no such run")?;
        if matches!(job.state, State::Waiting | State::Running) {
            return Err("this run has not ended".to_owned());
        }
        let has_begun = self.folder.find(&job.result).is_ok();
        let action = if has_begun { job.action.clone().again(None) } else { job.action.clone() };
        ready(&self.folder, &action)?;
        job.action = action;
        job.state = State::Waiting;
        self.save(&list);
        Ok(())
    }

    /// What a run was asked for.
    pub fn action(&self, id: u64) -> Result<Action, String> {
        let list = self.list();
        list.iter()
            .find(|job| job.id == id)
            .map(|job| job.action.clone())
            .ok_or("there is no such run".to_owned())
    }

    /// The case of the last run that wrote a result.
    pub fn case_of(&self, result: &str) -> Option<String> {
        self.list().iter().rev().find(|job| job.result == result).map(|job| job.case.clone())
    }

    /// All runs with how far they are, the latest first.
    pub fn told(&self) -> Value {
        let list = self.list().clone();
        let told = |job: &Job| {
            let log = self.end_of_log(job.id);
            let rows = log.lines().rev().find(|line| line.starts_with("row ")).unwrap_or_default().to_owned();
            let share = rows.split([' ', ':']).nth(1).and_then(|part| part.split_once('/'));
            let share =
                share.and_then(|(done, all)| Some(done.parse::<f64>().ok()? / all.parse::<f64>().ok()?));
            let has_rows = self
                .folder
                .find(&job.result)
                .is_ok_and(|path| Reader::open(&path).is_ok_and(|r| !r.is_empty()));
            let has_stopped = matches!(job.state, State::Stopped | State::Failed) && has_rows;
            let changed = if has_stopped { changed(&self.folder, &job.case, &job.result) } else { None };
            json!({
                "changed": changed,
                "id": job.id, "case": job.case, "result": job.result, "state": job.state, "shell": job.shell,
                "python": job.python, "progress": rows, "share": share, "has_rows": has_rows,
                "log": log, "out": own_text(&self.file(job.id, "out")).map(|out| String::from_utf8_lossy(&out).into_owned()),
            })
        };
        list.iter().rev().map(told).collect()
    }

    fn file(&self, id: u64, ending: &str) -> PathBuf {
        self.place.join(format!("run-{id}.{ending}"))
    }

    fn end_of_log(&self, id: u64) -> String {
        let text = own_text(&self.file(id, "log")).unwrap_or_default();
        String::from_utf8_lossy(&text[text.len().saturating_sub(TAIL)..]).into_owned()
    }

    /// Writes the list; where the disk is full, it is still in memory.
    fn save(&self, list: &[Job]) {
        let text = serde_json::to_vec_pretty(list).unwrap_or_default();
        let _ = fs::create_dir(&self.place);
        if let Err(error) = write_all(&self.place.join("runs.json"), true, &text) {
            crate::messages::message!("warning: the list of runs cannot be stored: {error}");
        }
    }

    /// Runs one after the other, for ever.
    fn work(&self) {
        let mut own: Option<(u64, Child)> = None;
        loop {
            std::thread::sleep(PAUSE);
            let mut list = self.list();
            if let Some((id, child)) = &mut own
                && let Ok(Some(ended)) = child.try_wait()
            {
                self.end(&mut list, *id, ended.code());
                own = None;
            }
            // Runs that an earlier application started.
            let own_id = own.as_ref().map(|(id, _)| *id);
            let is_left = |job: &&Job| job.state == State::Running && Some(job.id) != own_id;
            let left: Vec<Job> = list.iter().filter(is_left).cloned().collect();
            let gone: Vec<u64> = left.iter().filter(|job| !self.is_alive(job)).map(|job| job.id).collect();
            gone.iter().for_each(|id| self.end(&mut list, *id, None));
            if own.is_none()
                && left.len() == gone.len()
                && let Some(job) = list.iter_mut().find(|job| job.state == State::Waiting)
            {
                match self.spawn(job) {
                    Ok(child) => {
                        (job.state, job.pid) = (State::Running, Some(child.id()));
                        own = Some((job.id, child));
                    }
                    Err(error) => {
                        job.state = State::Failed;
                        let told = own_file(&self.file(job.id, "log"))
                            .and_then(|mut log| writeln!(log, "error: cannot start the run: {error}"));
                        if let Err(error) = told {
                            crate::messages::message!("warning: a run cannot be started: {error}");
                        }
                    }
                }
                self.save(&list);
            }
        }
    }

    /// Notes how a run ended; without its exit code its result says it.
    fn end(&self, list: &mut [Job], id: u64, code: Option<i32>) {
        let Some(job) = list.iter_mut().find(|job| job.id == id) else { return };
        let state =
            self.folder.find(&job.result).ok().and_then(|path| Some(Reader::open(&path).ok()?.state()));
        job.state = match (code, state.as_deref()) {
            (Some(0), _) | (None, Some("complete")) => State::Done,
            (Some(130), _) | (None, Some(_)) => State::Stopped,
            _ => State::Failed,
        };
        self.save(list);
    }

    fn spawn(&self, job: &Job) -> std::io::Result<Child> {
        let line = job.action.line(&self.folder, "").map_err(std::io::Error::other)?;
        let mut command = program()?;
        command.args(line.words()).current_dir(self.folder.path()).stdin(Stdio::null());
        command.stdout(own_file(&self.file(job.id, "out"))?).stderr(own_file(&self.file(job.id, "log"))?);
        detach(&mut command);
        command.spawn()
    }

    /// Whether the process of a run is there: its number alone may be that of another one by now.
    fn is_alive(&self, job: &Job) -> bool {
        let is_written = || {
            self.folder
                .find(&job.result)
                .is_ok_and(|path| Reader::open(&path).is_ok_and(|r| r.is_being_written()))
        };
        let is_young = || {
            let changed = self.file(job.id, "log").metadata().and_then(|data| data.modified()).ok();
            changed.is_some_and(|at| SystemTime::now().duration_since(at).is_ok_and(|age| age < YOUNG))
        };
        job.pid.is_some_and(exists) && (is_written() || is_young())
    }
}

/// A file of the application's own folder, empty; what stands in its place is removed, and no link is followed.
pub fn own_file(path: &Path) -> std::io::Result<File> {
    // The folder may have been removed meanwhile.
    path.parent().map(fs::create_dir).transpose().ok();
    if path.symlink_metadata().is_ok_and(|data| !data.is_file()) {
        fs::remove_file(path)?;
    }
    File::options().read(true).write(true).create(true).truncate(true).open(path)
}

/// What such a file holds; `None` of a link, a pipe and the like.
fn own_text(path: &Path) -> Option<Vec<u8>> {
    path.symlink_metadata().ok().filter(fs::Metadata::is_file)?;
    fs::read(path).ok()
}

/// This program.
pub fn program() -> std::io::Result<Command> {
    let own = std::env::current_exe()?;
    let is_python = own.file_stem().is_some_and(|stem| stem.to_string_lossy().starts_with("python"));
    let mut command = Command::new(own);
    if is_python {
        command.args(["-m", "asperity"]);
    }
    Ok(command)
}

/// Ctrl-C in the terminal of the application is not for the run.
#[cfg(unix)]
fn detach(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

#[cfg(windows)]
fn detach(command: &mut Command) {
    const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
    std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP);
}

#[cfg(not(any(unix, windows)))]
fn detach(_: &mut Command) {}

/// Asks a run to stop, as Ctrl-C does; that itself is ignored where the application was started in the background.
#[cfg(unix)]
fn interrupt(pid: u32) -> Result<(), String> {
    let pid = process(pid).ok_or("there is no such process")?;
    rustix::process::kill_process(pid, rustix::process::Signal::TERM).map_err(|error| error.to_string())
}

/// Ends a run: there is no Ctrl-C between processes here. Its rows are stored, and it can be resumed.
#[cfg(not(unix))]
fn interrupt(pid: u32) -> Result<(), String> {
    let ended = Command::new("taskkill").args(["/F", "/PID", &pid.to_string()]).output();
    ended.map(drop).map_err(|error| error.to_string())
}

#[cfg(unix)]
fn process(pid: u32) -> Option<rustix::process::Pid> {
    rustix::process::Pid::from_raw(i32::try_from(pid).ok()?)
}

#[cfg(unix)]
fn exists(pid: u32) -> bool {
    process(pid).is_some_and(|pid| rustix::process::test_kill_process(pid).is_ok())
}

#[cfg(not(unix))]
fn exists(_: u32) -> bool {
    true
}

/// Removes what earlier uses left for looking at.
pub fn sweep(place: &Path) {
    for entry in place.read_dir().into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with("look-") {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}
