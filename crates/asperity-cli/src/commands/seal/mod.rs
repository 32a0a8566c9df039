//! `asperity seal`: a whole seal, of which the case is a patch.

mod words;

use std::path::Path;

use asperity_io::case::Case;
use asperity_io::seal::{SealAnswer, SealError, sweep};
use asperity_io::study::Options;
use asperity_report::sheet::Sheet;

use super::answers::units;
use super::study::{told, usual};
use crate::args;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::counted;
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
                "{least} to {most} runs of the patch, {}, in {}",
                counted(plan.seeds, "seed"),
                folder.display()
            );
        }
        let mut tell = |event: &asperity_io::study::Event<'_>| {
            if !self.quiet {
                message!("{}", told(event, &units, |answer| answer.name == "hydraulic_gap"));
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
        sheet(&self.case, &answer, &rows, &figure).write(&folder.join("seal.html"), true)?;
        crate::print(&if self.json { format!("{}\n", answer.object()) } else { text(&rows, &folder) })?;
        super::findings::strict(self.strict, &answer.findings)
    }
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
    answer: &SealAnswer,
    rows: &[[String; 2]],
    figure: &asperity_report::figure::Figure,
) -> Sheet {
    let title = case.file_stem().unwrap_or_default().to_string_lossy();
    let table: Vec<Vec<String>> =
        [["answer".to_owned(), "value".to_owned()]].iter().chain(rows).map(|row| row.to_vec()).collect();
    let sheet = Sheet::new(title).table("Seal", &table);
    let sheet = answer.findings.iter().fold(sheet, |sheet, finding| sheet.note(&finding.to_string()));
    let sheet = answer.sweep.findings.iter().fold(sheet, |sheet, finding| sheet.note(&finding.to_string()));
    sheet.figure("Leak and pressure", figure)
}

fn text(rows: &[[String; 2]], folder: &Path) -> String {
    let lines: String = rows.iter().map(|[name, value]| super::answers::line(name, value)).collect();
    format!("{lines}\npage, figure and numbers in {}\n", folder.display())
}
