//! `asperity seal`: a whole seal, of which the case is a patch.

mod words;

use std::path::Path;

use asperity_io::case::Case;
use asperity_io::seal::{SealAnswer, SealError, label, sweep};
use asperity_io::study::{Event, Options, State};
use asperity_report::sheet::Sheet;

use super::answers::units;
use super::study::usual;
use crate::args;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::{duration, quantity};
use crate::messages::message;
use crate::verb::{Threads, Verb};

impl Verb for args::Seal {
    fn files(&self) -> Files {
        Files::default().reads([&self.case])
    }

    fn threads(&self) -> Threads {
        Threads::of(self.common.threads)
    }

    /// Runs the patch, and prints the leak, the opening pressure and what they depend on.
    fn run(&self) -> Result<(), Failure> {
        crate::launcher::refuse_several("seal")?;
        let units = units(&self.unit)?;
        let case = Case::read(&self.case, &self.common.set).map_err(Failure::Case)?;
        let Some(plan) = &case.seal else {
            let help = "write [seal] with profile, peak, width and length into the case";
            refuse!("{} has no [seal]; {help}", self.case.display());
        };
        units.check_leak(if plan.is_gas() { &["kg/s", "Pa m3/s"] } else { &["m3/s"] })?;
        let folder = self.output.clone().unwrap_or_else(|| usual(&self.case, "seal"));
        let options = Options {
            jobs: self.jobs.map(usize::from),
            interrupt: crate::interrupt::flag(),
            ..Options::default()
        };
        if !self.quiet {
            let [least, most] = plan.runs();
            message!(
                "the patch of {} runs {least} to {most} times; the results are in {}",
                self.case.display(),
                folder.display()
            );
        }
        let (mut done, rough) = (0, plan.rough.is_some());
        let mut tell = |event: &Event<'_>| {
            done += 1;
            if !self.quiet {
                message!("run {done}, {}", told(event, rough));
            }
        };
        let swept =
            sweep(&self.case, &self.common.set, plan, &folder, &options, &mut tell).map_err(failure)?;
        for finding in swept.findings.iter().filter(|_| !self.quiet) {
            message!("{finding}");
        }
        let answer = SealAnswer::of(plan, swept).map_err(failure)?;
        answer.write(&folder)?;
        super::findings::print(&answer.findings);
        let rows = words::lines(&answer, &units);
        let figure = asperity_report::seal::figure(&answer, &units);
        super::picture::write(&figure, &folder.join("seal.png"), true)?;
        let title = case.title.as_deref();
        sheet(&self.case, title, &answer, &rows, &figure).write(&folder.join("seal.html"), true)?;
        crate::print(&if self.json { format!("{}\n", answer.object()) } else { text(&rows, &folder) })?;
        super::findings::strict(self.strict, &answer.findings)
    }
}

/// How a run of the patch ended: "patch at 1 kPa, seed 2: hydraulic gap 960 nm (140 ms)". What was found of all runs is told at the end.
fn told(event: &Event<'_>, rough: bool) -> String {
    let row = event.row;
    let came = match &row.state {
        State::Done => match row.answers.iter().find(|answer| answer.name == "hydraulic_gap") {
            Some(gap) if gap.value > 0.0 => format!("hydraulic gap {}", quantity(gap.value, "m")),
            Some(_) => "tight".to_owned(),
            None => "done".to_owned(),
        },
        State::Failed(why) => format!("failed: {why}"),
        state => state.word().to_owned(),
    };
    format!("patch at {}: {came} ({})", label(row, rough), duration(event.seconds))
}

fn failure(error: SealError) -> Failure {
    match error {
        SealError::Case(errors) => Failure::Case(errors),
        SealError::Study(error) => super::study::failure(error),
        SealError::Failed(message) => Failure::Solve(message),
        SealError::Interrupted => Failure::Interrupted("the same command goes on".into()),
        error => error.into(),
    }
}

fn sheet(
    case: &Path,
    title: Option<&str>,
    answer: &SealAnswer,
    rows: &[[String; 2]],
    figure: &asperity_report::figure::Figure,
) -> Sheet {
    let name = case.file_stem().unwrap_or_default().to_string_lossy();
    let title = title.map_or(name.into_owned(), str::to_owned);
    // Name and value need no head.
    let table: Vec<Vec<String>> =
        [[String::new(), String::new()]].iter().chain(rows).map(|row| row.to_vec()).collect();
    let sheet = Sheet::new(title).table("Seal", &table);
    let sheet = answer.findings.iter().fold(sheet, |sheet, finding| sheet.note(&finding.to_string()));
    let sheet = answer.sweep.findings.iter().fold(sheet, |sheet, finding| sheet.note(&finding.to_string()));
    sheet.figure("Leak and pressure", figure)
}

fn text(rows: &[[String; 2]], folder: &Path) -> String {
    let lines: String = rows.iter().map(|[name, value]| super::answers::line(name, value)).collect();
    format!("{lines}\npage, figure and numbers in {}\n", folder.display())
}
