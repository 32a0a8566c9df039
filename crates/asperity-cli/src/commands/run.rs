//! `asperity run`.

use asperity::finding::Finding;
use asperity::step::Row;
use asperity_io::case::Case;
use asperity_io::converge::Convergence;
use asperity_io::leakage::LeakError;
use asperity_io::session::{RunError, RunOptions, Summary, run as run_case};
use asperity_io::store::{Status, store_error_bars};
use serde_json::{Value, json};

use crate::args::Run;
use crate::failure::Failure;
use crate::format::{bytes, coordinate, counted, duration, quantity};
use crate::progress::ProgressDisplay;
use crate::verb::{Threads, Verb};

impl Verb for Run {
    fn threads(&self) -> Threads {
        Threads::of(self.common.threads)
    }

    /// Runs the case, tells the progress on stderr and a summary on stdout.
    fn run(&self) -> Result<(), Failure> {
        crate::launcher::refuse_several("run")?;
        let mut set = self.common.set.clone();
        let units = super::answers::units(&self.unit)?;
        set.extend(super::answers::keys(&units));
        let case = Case::read(&self.case, &set)?;
        print_materials(self, &case);
        let known = print_findings(self, &case.findings, &[]);
        let options = RunOptions {
            output: self.output.clone(),
            force: self.force,
            resume: self.resume,
            interrupt: crate::interrupt::flag(),
        };
        let mut display = ProgressDisplay::new(self.quiet, self.verbose > 0);
        let done = run_case(&case, &options, |progress| display.update(&progress));
        display.end();
        match done {
            Ok(summary) => {
                print_findings(self, &summary.findings, &known);
                super::answers::note_unused(&units, &summary.answers);
                let bars = match self.error_bars && summary.status == Status::Complete {
                    true => Some(error_bars(self, &set, &summary)?),
                    false => None,
                };
                print_summary(self, &case, &summary, bars.as_ref(), None)?;
                if summary.status != Status::Interrupted {
                    return super::findings::strict(self.strict, &summary.findings);
                }
                let (rows, result) = (summary.rows, summary.result.display());
                let kept = if rows == 1 { "1 row is".to_owned() } else { format!("{rows} rows are") };
                Err(Failure::Interrupted(format!("{kept} in {result}; continue with --resume")))
            }
            Err(RunError::Case(errors)) => Err(Failure::Case(errors)),
            Err(error @ RunError::Output(_)) => Err(error.into()),
            Err(error) => {
                let message = match &error {
                    RunError::Solve { best: Some(best), .. } => {
                        format!("{error}\n{}", best_state(best, &case))
                    }
                    _ => error.to_string(),
                };
                if let RunError::Leakage { source: LeakError::Interrupted, .. } = error {
                    return Err(Failure::Interrupted(message));
                }
                if let RunError::Solve { summary, .. }
                | RunError::Storage { summary, .. }
                | RunError::Leakage { summary, .. } = &error
                {
                    print_findings(self, &summary.findings, &known);
                    print_summary(self, &case, summary, None, Some(&error))?;
                }
                Err(Failure::Solve(message))
            }
        }
    }
}

/// Prints the findings that are not printed yet on stderr, and returns them.
fn print_findings(args: &Run, findings: &[Finding], printed: &[Finding]) -> Vec<Finding> {
    let new: Vec<Finding> = findings.iter().filter(|finding| !printed.contains(finding)).cloned().collect();
    if !args.quiet {
        super::findings::print(&new);
    }
    new
}

/// What stands for measured and fractional materials, and how well.
fn print_materials(args: &Run, case: &Case) {
    for report in case.materials.iter().filter(|_| !args.quiet) {
        for line in super::material::source(report) {
            crate::messages::message!("{}: {line}", report.body);
        }
    }
}

fn best_state(best: &Row, case: &Case) -> String {
    let grid = &case.conditions.grid;
    format!(
        "  best state at {}: load {}, approach {}, contact {:.4} %, largest pressure {}",
        coordinate(best.coordinate),
        quantity(best.load, grid.units("N")),
        quantity(best.approach, "m"),
        100.0 * best.contact_fraction,
        quantity(best.max_pressure, "Pa"),
    )
}

/// The errors of the answers, stored in the result.
fn error_bars(args: &Run, set: &[String], summary: &Summary) -> Result<Convergence, Failure> {
    let found = super::converge::of_case(&args.case, set, Some(&summary.result), false, args.quiet)?;
    store_error_bars(&summary.result, json!(found.bars))?;
    Ok(found)
}

fn print_summary(
    args: &Run,
    case: &Case,
    summary: &Summary,
    bars: Option<&Convergence>,
    error: Option<&RunError>,
) -> Result<(), Failure> {
    if args.json {
        return crate::print(&format!("{}\n", json_object(summary, bars, error)));
    }
    if summary.status != Status::Complete {
        return Ok(());
    }
    if let Err(error) = case.output.units.check(&summary.answers) {
        crate::messages::message!("note: {error}");
    }
    let mut text = String::new();
    match bars {
        Some(bars) => text += &super::converge::text(bars, &case.output.units),
        None => {
            let answers = super::answers::lines(&summary.answers, &[], &case.output.units);
            text.extend(answers.iter().map(|[name, value]| super::answers::line(name, value)));
        }
    }
    let mut line = |name: &str, value: String| text += &super::answers::line(name, value);
    if let Some(row) = super::answers::row(
        &summary.answers,
        &case.output.units,
        &case.conditions.grid,
        summary.last.as_ref(),
        summary.rows,
    ) {
        line("of the row at", row);
    }
    let memory = summary.peak_memory_bytes.map(|b| format!(", {}", bytes(b as f64))).unwrap_or_default();
    line(
        "work",
        format!(
            "{}, {} iterations, {} convolutions ({:.1} per row) in {}{memory}",
            counted(summary.rows, "row"),
            summary.iterations,
            summary.convolutions,
            summary.convolutions as f64 / summary.rows.max(1) as f64,
            duration(summary.wall_s)
        ),
    );
    if !summary.findings.is_empty() {
        line("findings", super::findings::counted(&summary.findings));
    }
    line("result", summary.result.display().to_string());
    crate::print(&text)
}

fn json_object(summary: &Summary, bars: Option<&Convergence>, error: Option<&RunError>) -> Value {
    let mut object = json!({
        "answers": summary.answers,
        "status": summary.status.as_str(),
        "steps": summary.rows,
        "wall_s": summary.wall_s,
        "convolutions": summary.convolutions,
        "iterations": summary.iterations,
        "peak_memory_bytes": summary.peak_memory_bytes,
        "result": summary.result.to_string_lossy(),
        "findings": asperity_io::finding::list(&summary.findings),
    });
    if let Some(bars) = bars {
        object["error_bars"] = super::answers::bars(&bars.answers, &bars.bars);
    }
    if let Some(error) = error {
        object["error"] = json!(error.to_string());
    }
    if let Some(RunError::Solve { best: Some(best), .. }) = error {
        object["best"] = json!({
            "time": best.coordinate.value(),
            "load": best.load,
            "approach": best.approach,
            "contact_area": best.contact_area,
            "max_pressure": best.max_pressure,
            "residual": best.residual,
            "certificate": best.certificate,
        });
    }
    object
}
