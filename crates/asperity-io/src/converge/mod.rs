//! Error bars of answers: the same case solved with other cells, other steps and another tolerance.
//!
//! Three things limit an answer Q: the size of the cells h, the length of the steps, and the tolerance of the solver. Each is made
//! coarser on its own, and an answer's error is estimated from how much it moves:
//!
//! - **grid**: half and a quarter of the cells along each side; where a quarter is not possible, three quarters. Where the cells cannot be
//!   halved (roughness whose shortest wave has too few cells then) the grid is refined instead.
//! - **time**: steps twice as long; where that is not possible, half as long. Elastic contacts at rest that do not wear have no such error.
//! - **solver**: ten times the tolerance.
//!
//! The second and the third are measured on the coarser grid, where they cost little. All together take less than the run itself where
//! the grid is coarsened. P. J. Roache, J. Fluids Eng. 116 (1994) 405.

mod estimate;
mod variation;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity::Coordinate;
use asperity::finding::{CONTACT_AT_BORDER, Finding};
use asperity::step::Row;
use serde::{Deserialize, Serialize};

use crate::answer::{self, Answer, Units};
use crate::case::{Case, CaseErrors};
use crate::session::{RunError, RunOptions, run};
use crate::store::{Reader, Status, StoreError};
use estimate::{Runs, Steps, bar};
pub use variation::Change;
use variation::{has_singular_pressure, steps_matter};

/// An answer with its error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorBar {
    /// Its name.
    pub name: String,
    /// Its value, SI; extrapolated where the grid was refined for that.
    pub value: Option<f64>,
    /// Its SI unit; "1" if it has none.
    pub unit: String,
    /// Its estimated error, SI; `None` where it is not known.
    pub error: Option<f64>,
    /// How much of it the grid causes; `None` where no other grid gave the answer.
    pub grid: Option<f64>,
    /// How much of it the steps in time cause.
    pub time: Option<f64>,
    /// How much of it the tolerance of the solver causes.
    pub solver: Option<f64>,
    /// The time \[s\] or velocity \[m/s\] of the row that it belongs to.
    #[serde(default)]
    pub at: Option<f64>,
    /// Observed order of convergence with the cells, where three grids show it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub order: Option<f64>,
    /// What limits the estimate, in words; empty if nothing does.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
}

impl ErrorBar {
    /// An answer with an error whose causes are not told apart.
    pub fn of(answer: &Answer, error: f64) -> ErrorBar {
        ErrorBar {
            name: answer.name.clone(),
            value: Some(answer.value),
            unit: answer.unit.to_owned(),
            error: Some(error),
            grid: None,
            time: None,
            solver: None,
            at: answer.at.map(|at| at.value()),
            order: None,
            note: String::new(),
        }
    }
}

/// The error bars of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// Its answers.
    pub answers: Vec<Answer>,
    /// The same with their errors.
    pub bars: Vec<ErrorBar>,
    /// How many rows the case has.
    pub rows: usize,
    /// The last of them.
    pub last: Option<Row>,
    /// Where the numbers of the case may be off.
    pub findings: Vec<Finding>,
    /// What was solved in addition to the case, and what could not be, in words.
    pub notes: Vec<String>,
    /// Convolutions of the additional runs, each counted as a share of one of the case's size: over those of the case.
    pub cost: f64,
}

/// Why there are no error bars.
#[derive(Debug, thiserror::Error)]
pub enum ConvergeError {
    /// The case is wrong.
    #[error(transparent)]
    Case(#[from] CaseErrors),
    /// A run failed.
    #[error("{change}: {source}")]
    Run {
        /// Which one.
        change: String,
        /// Why.
        source: Box<RunError>,
    },
    /// A result cannot be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A temporary directory cannot be made.
    #[error("no temporary directory: {0}")]
    Temporary(#[from] std::io::Error),
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The run has no answer.
    #[error("the run has no row, and so no answer")]
    NoAnswer,
}

/// How error bars are found.
#[derive(Clone, Debug, Default)]
pub struct ConvergeOptions {
    /// Solve a grid of half the cell size as well and extrapolate.
    pub refine: bool,
    /// Stops the work when it becomes true.
    pub interrupt: Arc<AtomicBool>,
}

/// Reads the case with these further keys (`KEY=VALUE`).
pub type Read<'a> = dyn Fn(&[String]) -> Result<Case, CaseErrors> + 'a;

/// The case and its variations on disk.
struct Work<'a> {
    read: &'a Read<'a>,
    case: &'a Case,
    options: &'a ConvergeOptions,
    directory: tempfile::TempDir,
    observe: &'a mut dyn FnMut(&str),
    /// Convolutions over all variations, in units of a convolution of the case.
    spent: f64,
}

/// What a run answers, and what it took.
struct Solved {
    answers: Vec<Answer>,
    /// Where its rows are, and the last of them.
    at: Vec<Coordinate>,
    /// Whether any of its cells is at the hardness.
    capped: Vec<bool>,
    last: Option<Row>,
    findings: Vec<Finding>,
    convolutions: u64,
}

/// The error bars of the case that `read` reads. `result` is its complete result; without one it is solved first. `observe` hears
/// what is solved next.
///
/// # Errors
/// [`ConvergeError`].
pub fn converge(
    read: &Read<'_>,
    result: Option<&Path>,
    options: &ConvergeOptions,
    observe: &mut dyn FnMut(&str),
) -> Result<Convergence, ConvergeError> {
    let case = read(&[])?;
    let directory = tempfile::tempdir()?;
    let mut work = Work { read, case: &case, options, directory, observe, spent: 0.0 };
    let base = match result {
        Some(result) => solved(&Reader::open(result)?)?,
        None => work.solve("the case", &[])?.ok_or(ConvergeError::NoAnswer)?,
    };
    work.spent = 0.0;
    let mut notes = vec![];
    let half = work.vary(&[Change::HalfCells], &mut notes)?;
    // A quarter only sharpens the estimate: that it is not possible is not worth a note.
    let quarter = match half {
        Some(_) => work.vary(&[Change::QuarterCells], &mut vec![])?,
        None => None,
    };
    // Two grids may agree by chance: another one between them.
    let three_quarters = match quarter {
        Some(_) => None,
        None => work.vary(&[Change::ThreeQuartersOfCells], &mut vec![])?,
    };
    let double = match options.refine || half.is_none() {
        true => work.vary(&[Change::DoubleCells], &mut notes)?,
        false => None,
    };
    let coarse: &[Change] = if half.is_some() { &[Change::HalfCells] } else { &[] };
    let with = |change| [coarse, &[change]].concat();
    let steps = match steps_matter(&case) {
        true => work.other_steps(coarse, half.as_ref().unwrap_or(&base), &mut notes)?,
        false => Steps::Nothing,
    };
    let loose = work.vary(&with(Change::LooseSolver), &mut notes)?;
    if options.refine && half.is_none() {
        notes.push("not extrapolated: that needs an answer with half the cells too".into());
    }
    let answers = |solved: Option<Solved>| solved.map(|solved| solved.answers);
    let runs = Runs {
        half: answers(half),
        quarter: answers(quarter),
        three_quarters: answers(three_quarters),
        double: answers(double),
        steps,
        loose: answers(loose),
    };
    let cost = work.spent / (base.convolutions.max(1) as f64);
    let of = |answer: &Answer| bar(answer, base.why_singular(&case, answer), &runs, options.refine);
    let bars = base.answers.iter().map(of).collect();
    let Solved { answers, at, last, findings, .. } = base;
    Ok(Convergence { answers, bars, rows: at.len(), last, findings, notes, cost })
}

/// Answers that have no value on ever finer grids where the pressure is singular, by how their names begin: the depth worn follows the
/// pressure of its cell.
const OF_LARGEST_PRESSURE: [&str; 5] =
    ["max_pressure", "max_mises", "first_yield", "wear_depth", "wear_life"];
/// What wears where the pressure is above a threshold follows the largest pressures too.
const ABOVE_THRESHOLD: &str = "wear_";

impl Solved {
    /// Why an answer has no value on ever finer grids; `None` where nothing is known to say so.
    fn why_singular(&self, case: &Case, answer: &Answer) -> Option<&'static str> {
        let is_above = case.conditions.wear.as_ref().is_some_and(|wear| wear.threshold > 0.0)
            && answer.name.starts_with(ABOVE_THRESHOLD);
        if is_above && answer.value == 0.0 {
            return Some("no pressure reaches the threshold on this grid, but on a finer one it may");
        }
        let is_largest = is_above || OF_LARGEST_PRESSURE.iter().any(|begin| answer.name.starts_with(begin));
        // The largest pressure is the hardness where cells have reached it.
        if !is_largest || self.is_capped(answer) {
            return None;
        }
        if has_singular_pressure(case) {
            return Some("at a sharp edge or tip the pressure grows without end as the cells shrink");
        }
        let border = self.findings.iter().find(|finding| finding.code == CONTACT_AT_BORDER)?;
        // An answer of no row is one of all rows.
        let is_within = border.rows.zip(answer.at).is_none_or(|([first, last], at)| {
            let mut rows = self.at.iter().enumerate().filter(|(_, own)| **own == at);
            rows.any(|(row, _)| (first..=last).contains(&row))
        });
        is_within.then_some(
            "where the contact reaches the border of the free domain the body ends in a sharp edge, at which the pressure grows without end \
             as the cells shrink",
        )
    }

    /// Whether cells are at the hardness in a row of an answer; in any row where it is one of all rows.
    fn is_capped(&self, answer: &Answer) -> bool {
        let rows = self.at.iter().zip(&self.capped);
        rows.filter(|(at, _)| answer.at.is_none_or(|own| own == **at)).any(|(_, is_capped)| *is_capped)
    }
}

/// What the error bars of a case take, about, over what the case itself takes.
pub fn expected_cost(case: &Case, read: &Read<'_>) -> f64 {
    let is_possible = |change: Change| change.overrides(case).is_ok_and(|keys| read(&keys).is_ok());
    let steps = match steps_matter(case) {
        true if is_possible(Change::LongSteps) => 0.5,
        true => 2.0,
        false => 0.0,
    };
    // A looser tolerance takes less, but never more.
    match is_possible(Change::HalfCells) {
        true => 0.25 * (2.0 + steps) + if is_possible(Change::QuarterCells) { 0.0625 } else { 0.5625 },
        false => 4.0 + 1.0 + steps + if is_possible(Change::ThreeQuartersOfCells) { 0.5625 } else { 0.0 },
    }
}

impl Work<'_> {
    /// The answers with steps of twice the length, or, where those are not possible or no fewer, of half the length.
    fn other_steps(
        &mut self,
        coarse: &[Change],
        before: &Solved,
        notes: &mut Vec<String>,
    ) -> Result<Steps, ConvergeError> {
        let mut why = vec![];
        if let Some(long) = self.vary(&[coarse, &[Change::LongSteps]].concat(), &mut why)? {
            if long.at.len() < before.at.len() {
                return Ok(Steps::Varied { answers: long.answers, factor: 1.0 });
            }
            why.push(
                "steps of twice the length: there are no fewer of them: the history, the material or the motion asks for them"
                    .into(),
            );
        }
        notes.extend(why);
        // Breaks of the history may lie where steps of half the length end.
        for change in [Change::HalfSteps, Change::QuarterSteps] {
            let Some(short) = self.vary(&[coarse, &[change]].concat(), notes)? else { break };
            if short.at.len() > before.at.len() {
                let name = change.name();
                notes.push(format!("{name} instead: their error is twice what they move an answer"));
                return Ok(Steps::Varied { answers: short.answers, factor: 2.0 });
            }
        }
        notes.push(
            "the steps were not varied: neither longer nor shorter ones change the number of rows".into(),
        );
        Ok(Steps::Unknown)
    }

    /// The answers with these changes; `None` and a note where the case does not allow them.
    fn vary(&mut self, changes: &[Change], notes: &mut Vec<String>) -> Result<Option<Solved>, ConvergeError> {
        let names: Vec<&str> = changes.iter().map(|change| change.name()).collect();
        let mut overrides = vec![];
        for change in changes {
            match change.overrides(self.case) {
                Ok(more) => overrides.extend(more),
                Err(why) => {
                    notes.push(format!("{}: {why}", change.name()));
                    return Ok(None);
                }
            }
        }
        let what = names.join(", ");
        match self.solve(&what, &overrides) {
            Ok(solved) => Ok(solved),
            Err(ConvergeError::Case(errors)) => {
                let why = errors.errors.first().map_or(String::new(), |error| error.message.clone());
                notes.push(format!("{what}: not possible: {why}"));
                Ok(None)
            }
            Err(ConvergeError::Run { source, .. }) if matches!(*source, RunError::Solve { .. }) => {
                notes.push(format!("{what}: {source}"));
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// The answers with these further keys.
    fn solve(&mut self, what: &str, more: &[String]) -> Result<Option<Solved>, ConvergeError> {
        (self.observe)(what);
        let case = (self.read)(&[more, &["output.checkpoint=false".to_owned()]].concat())?;
        let output: PathBuf = self.directory.path().join("run.zarr");
        let options = RunOptions {
            output: Some(output.clone()),
            force: true,
            resume: false,
            interrupt: self.options.interrupt.clone(),
        };
        let summary = run(&case, &options, |_| {}).map_err(|source| match source {
            RunError::Case(errors) => ConvergeError::Case(errors),
            source => ConvergeError::Run { change: what.to_owned(), source: Box::new(source) },
        })?;
        if summary.status == Status::Interrupted {
            return Err(ConvergeError::Interrupted);
        }
        let solved = solved(&Reader::open(&output)?)?;
        let share = case.conditions.grid.len() as f64 / self.case.conditions.grid.len() as f64;
        self.spent += share * solved.convolutions as f64;
        Ok(Some(solved).filter(|solved| !solved.answers.is_empty()))
    }
}

fn solved(reader: &Reader) -> Result<Solved, ConvergeError> {
    let answers = answer::of(reader, &Units::default())?;
    let findings = reader.findings().to_vec();
    let rows = reader.rows()?;
    let at = rows.iter().map(|row| row.coordinate).collect();
    let capped = rows.iter().map(|row| row.capped_area > 0.0).collect();
    let last = rows.last().copied();
    Ok(Solved { answers, at, capped, last, findings, convolutions: reader.work().convolutions })
}
