//! The runs of a study side by side: as many as memory allows, each on its share of the threads. The numbers of a run do not depend
//! on how many threads it has, so they are those of a single run.

use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::StudyError;
use super::folder::Study;
use super::plan::Run;
use super::rows::{self, Row, State};
use super::table::Table;
use crate::converge::{ConvergeOptions, converge};
use crate::output::write_all;
use crate::resources::available_memory;
use crate::session::{self, RunError, RunOptions};
use crate::store::{Status, StoreError, store_error_bars};

/// How a study is worked on.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Runs side by side at most; default: one per thread, as many as memory allows.
    pub jobs: Option<usize>,
    /// Threads of all runs together; default: one per core.
    pub threads: Option<usize>,
    /// Only every n-th run, from the k-th on, k from 1: the share (k, n) of one process of several.
    pub shard: Option<[usize; 2]>,
    /// Processes that work on this machine side by side, and share its memory; 0 counts as 1, this process alone.
    pub neighbours: usize,
    /// Whether the errors of the answers are computed too, also of runs that are done without them.
    pub error_bars: bool,
    /// Stops all runs, within one iteration, when it becomes true.
    pub interrupt: Arc<AtomicBool>,
}

/// A run that has ended.
pub struct Event<'a> {
    /// What tells it from the others: "value = 0.3 N, seed = 2".
    pub label: String,
    /// What came of it.
    pub row: &'a Row,
    /// Why its answers have no errors, where they were wanted.
    pub no_errors: Option<String>,
    /// So many runs of this process have ended, these before it included that were done already.
    pub ended: usize,
    /// Runs of this process.
    pub of: usize,
    /// Time on the clock \[s\].
    pub seconds: f64,
}

/// What a call did.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The study as it is now.
    pub table: Table,
    /// Whether it was stopped.
    pub interrupted: bool,
}

/// How long a worker waits before it looks again whether it is to stop.
const PAUSE: Duration = Duration::from_millis(100);
/// The table is written after a run, unless that would take more than one part in so many of the time: studies of many thousand runs.
const TABLE: u32 = 20;
/// The share of the free memory that runs may take.
const SHARE: f64 = 0.9;

/// What the workers share.
struct Shared<'a> {
    /// Numbers of the runs that are left, the first one last.
    left: Vec<usize>,
    /// Memory of the runs under way \[byte\], and how many they are.
    taken: u64,
    working: usize,
    ended: usize,
    known: Vec<Option<Row>>,
    /// The table is not written before then.
    rest: Instant,
    /// Why the study stops.
    failure: Option<StudyError>,
    observe: &'a mut (dyn FnMut(&Event<'_>) + Send),
}

impl Study {
    /// Computes what is missing, and writes the table after each run.
    ///
    /// # Errors
    /// [`StudyError`] where the table cannot be written. A run that fails is a row of the table.
    pub fn work(
        &self,
        options: &Options,
        observe: &mut (dyn FnMut(&Event<'_>) + Send),
    ) -> Result<Outcome, StudyError> {
        let [share, shares] = options.shard.unwrap_or([1, 1]);
        let own: Vec<usize> = (0..self.runs.len()).filter(|n| n % shares == share - 1).collect();
        let before = self.rows();
        let is_left = |n: &usize| match before[*n].state {
            State::Done => options.error_bars && before[*n].bars.is_empty(),
            State::Running => false,
            _ => true,
        };
        let left: Vec<usize> = own.iter().copied().filter(is_left).rev().collect();
        let threads = options.threads.filter(|n| *n > 0).unwrap_or_else(rayon::current_num_threads);
        let jobs = options.jobs.unwrap_or(threads).min(left.len()).max(1);
        let known =
            before.iter().map(|row| Some(row.clone()).filter(|row| row.state == State::Done)).collect();
        let ended = own.len() - left.len();
        let shared = Mutex::new(Shared {
            left,
            taken: 0,
            working: 0,
            ended,
            known,
            rest: Instant::now(),
            failure: None,
            observe,
        });
        let changed = Condvar::new();
        let budget = (SHARE * available_memory() as f64 / options.neighbours.max(1) as f64) as u64;
        thread::scope(|scope| {
            for worker in 0..jobs {
                // The remainder goes to the first ones.
                let own_threads = (threads / jobs + usize::from(worker < threads % jobs)).max(1);
                let (shared, changed, before, of) = (&shared, &changed, &before, own.len());
                scope.spawn(move || {
                    let pool = match rayon::ThreadPoolBuilder::new().num_threads(own_threads).build() {
                        Ok(pool) => pool,
                        Err(error) => {
                            let message = format!(
                                "cannot start {own_threads} threads: {error}; ask for fewer with --threads"
                            );
                            hold(shared).failure.get_or_insert(StudyError::Input(message));
                            return;
                        }
                    };
                    while let Some(n) = self.take(shared, changed, budget, &options.interrupt) {
                        let started = Instant::now();
                        let done = pool.install(|| self.finish(&self.runs[n], &before[n], options));
                        let mut shared = hold(shared);
                        shared.taken -= self.memory.get(n).copied().unwrap_or(0);
                        shared.working -= 1;
                        let seconds = started.elapsed().as_secs_f64();
                        self.note(n, done, &mut shared, of, seconds, &options.interrupt);
                        changed.notify_all();
                    }
                });
            }
        });
        let failure = shared.into_inner().unwrap_or_else(PoisonError::into_inner).failure;
        // What is done stays in the table, whatever stops the study; of several processes the last one writes the dataset.
        let interrupted = options.interrupt.load(Ordering::Relaxed);
        let table = self.collect_if(|table| options.shard.is_none() || interrupted || table.has_ended());
        match failure {
            Some(failure) => Err(failure),
            None => Ok(Outcome { table: table?, interrupted }),
        }
    }

    /// The next run, once there is memory for it; `None` where none is left or the study stops.
    fn take(
        &self,
        shared: &Mutex<Shared<'_>>,
        changed: &Condvar,
        budget: u64,
        interrupt: &AtomicBool,
    ) -> Option<usize> {
        let mut shared = hold(shared);
        loop {
            if interrupt.load(Ordering::Relaxed) || shared.failure.is_some() {
                return None;
            }
            let next = *shared.left.last()?;
            let needed = self.memory.get(next).copied().unwrap_or(0);
            if shared.working == 0 || shared.taken.saturating_add(needed) <= budget {
                shared.left.pop();
                shared.taken += needed;
                shared.working += 1;
                return Some(next);
            }
            shared = changed.wait_timeout(shared, PAUSE).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Runs a case, and computes the errors of its answers where they are wanted. An error is the reason why the run failed; a text
    /// is the reason why its answers have no errors.
    fn finish(&self, run: &Run, before: &Row, options: &Options) -> Result<Option<String>, String> {
        self.compute(run, before, &options.interrupt)?;
        let now = rows::of(self, run);
        let Some(base) = self.base.as_ref() else { return Ok(None) };
        if !options.error_bars || now.state != State::Done || !now.bars.is_empty() {
            return Ok(None);
        }
        let path = self.result(run);
        let overrides = self.plan.overrides(run);
        let read = |more: &[String]| base.case(&[&overrides, more].concat());
        let how = ConvergeOptions { refine: false, interrupt: options.interrupt.clone() };
        let found = converge(&read, Some(&path), &how, &mut |_| {}).map_err(|error| error.to_string());
        let stored = found.and_then(|found| {
            store_error_bars(&path, serde_json::json!(found.bars)).map_err(|error| error.to_string())
        });
        Ok(stored.err().filter(|_| !options.interrupt.load(Ordering::Relaxed)))
    }

    /// Runs a case, or goes on with it. An error is the reason why it failed.
    fn compute(&self, run: &Run, before: &Row, interrupt: &Arc<AtomicBool>) -> Result<(), String> {
        // Another process may have done it since this one began.
        let now = rows::of(self, run);
        let is_left = match now.state {
            State::Missing | State::Unfinished => true,
            State::Failed(_) => now.state == before.state,
            State::Done | State::Running => false,
        };
        if !is_left {
            return Ok(());
        }
        let case = match self.case(run) {
            Ok(Some(case)) => case,
            Ok(None) => return Ok(()),
            Err(error) => return Err(error.to_string()),
        };
        let path = self.result(run);
        let options = RunOptions {
            resume: path.exists(),
            output: Some(path),
            force: false,
            interrupt: interrupt.clone(),
        };
        let _ = fs::remove_file(self.error_file(run));
        match session::run(&case, &options, |_| {}) {
            Ok(summary) if summary.status == Status::Interrupted => Ok(()),
            // Another process computes it, or has computed it.
            Ok(_) | Err(RunError::Output(StoreError::Busy { .. } | StoreError::Exists { .. })) => Ok(()),
            Err(_) if interrupt.load(Ordering::Relaxed) => Ok(()),
            Err(error) => Err(error.to_string()),
        }
    }

    /// Writes what came of a run, and tells it.
    fn note(
        &self,
        n: usize,
        done: Result<Option<String>, String>,
        shared: &mut MutexGuard<'_, Shared<'_>>,
        of: usize,
        seconds: f64,
        interrupt: &AtomicBool,
    ) {
        let run = &self.runs[n];
        let shared = &mut **shared;
        if let Err(why) = &done
            && let Err(error) = write_all(&self.error_file(run), true, format!("{why}\n").as_bytes())
        {
            shared.failure.get_or_insert(StudyError::Input(error.to_string()));
        }
        let now = Instant::now();
        if now >= shared.rest {
            if let Err(error) = self.write_table(&mut shared.known) {
                shared.failure.get_or_insert(error);
            }
            shared.rest = Instant::now() + TABLE * now.elapsed();
        }
        if interrupt.load(Ordering::Relaxed) {
            return;
        }
        shared.ended += 1;
        let row = rows::of(self, run);
        let label = self.plan.label(run);
        let no_errors = done.ok().flatten();
        (shared.observe)(&Event { label, row: &row, no_errors, ended: shared.ended, of, seconds });
    }
}

fn hold<'m, 's>(shared: &'m Mutex<Shared<'s>>) -> MutexGuard<'m, Shared<'s>> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
