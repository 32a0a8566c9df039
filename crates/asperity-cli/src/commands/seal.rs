//! `asperity seal`: a whole seal, of which the case is a patch.

use std::path::Path;

use asperity::seal::{Opens, SealState};
use asperity_io::answer::Units;
use asperity_io::case::Case;
use asperity_io::seal::{MILLILITRES_A_YEAR, SealAnswer, SealError, Spread, sweep};
use asperity_io::study::Options;
use asperity_report::sheet::Sheet;

use super::answers::units;
use super::study::{told, usual};
use crate::args;
use crate::failure::Failure;
use crate::files::Files;
use crate::format::{counted, quantity};
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
        let units = units(&self.unit)?;
        units.check_leak(&["m3/s"])?;
        let case = Case::read(&self.case, &self.common.set).map_err(Failure::Case)?;
        let Some(plan) = &case.seal else {
            let help = "write [seal] with profile, peak, width and length into the case";
            return Err(Failure::input(format!("{} has no [seal]; {help}", self.case.display())));
        };
        let folder = self.output.clone().unwrap_or_else(|| usual(&self.case, "seal"));
        let options = Options {
            jobs: self.jobs.map(usize::from),
            interrupt: crate::interrupt::flag(),
            ..Options::default()
        };
        if !self.quiet {
            message!(
                "{} pressures and {} in {}",
                plan.pressures,
                counted(plan.seeds, "seed"),
                folder.display()
            );
        }
        let mut tell = |event: &asperity_io::study::Event<'_>| {
            if !self.quiet {
                message!("{}", told(event, &units));
            }
        };
        let swept =
            sweep(&self.case, &self.common.set, plan, &folder, &options, &mut tell).map_err(failure)?;
        for words in swept.findings.iter().filter(|_| !self.quiet) {
            message!("patch: {words}");
        }
        let answer = SealAnswer::of(plan, swept).map_err(failure)?;
        answer.write(&folder)?;
        super::findings::print(&answer.findings);
        let rows = lines(&answer, &units);
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
    let title = answer_title(case);
    let table: Vec<Vec<String>> =
        [["answer".to_owned(), "value".to_owned()]].iter().chain(rows).map(|row| row.to_vec()).collect();
    let sheet = Sheet::new(title).table("Seal", &table);
    let sheet = answer.findings.iter().fold(sheet, |sheet, finding| sheet.note(&finding.to_string()));
    let sheet = answer.sweep.findings.iter().fold(sheet, |sheet, words| sheet.note(words));
    sheet.figure("Leak and pressure", figure)
}

fn answer_title(case: &Path) -> String {
    case.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn text(rows: &[[String; 2]], folder: &Path) -> String {
    let lines: String = rows.iter().map(|[name, value]| super::answers::line(name, value)).collect();
    format!("{lines}\npage, figure and numbers in {}\n", folder.display())
}

/// The answers in words, the leak first.
fn lines(answer: &SealAnswer, units: &Units) -> Vec<[String; 2]> {
    let plan = &answer.plan;
    let [inlet, outlet] = plan.ends;
    let pa = |pressure: f64| quantity(pressure, "Pa");
    let mut rows: Vec<[String; 2]> = vec![];
    let mut row = |name: &str, value: String| rows.push([name.to_owned(), value]);
    let leak = |spread: &Spread| with_spread(spread, |leak| units.number(leak, "m3/s"));
    let leaks = answer.leak.largest.is_finite() && answer.leak.largest > 0.0;
    let lifted = answer.flows.iter().any(|flow| flow.state == SealState::Lifted);
    let first = if answer.is(SealState::Tight) {
        "none: tight".to_owned()
    } else if leaks {
        leak(&answer.leak)
    } else if lifted {
        "not bounded: the fluid lifts the seal".to_owned()
    } else {
        "not known: see the findings".to_owned()
    };
    row("leak of the seal", first);
    if leaks {
        let per = |factor: f64, spread: &Spread| Spread {
            mean: factor * spread.mean,
            least: factor * spread.least,
            largest: factor * spread.largest,
        };
        row("per metre", leak(&per(1.0 / plan.length, &answer.leak)));
        row(
            "in a year",
            format!("{} ml", with_spread(&per(MILLILITRES_A_YEAR, &answer.leak), |ml| quantity(ml, ""))),
        );
    }
    row("opening pressure", opening(answer));
    let time = answer.sweep.times.last().map_or(String::new(), |time| format!("t = {}, ", units.time(*time)));
    row(
        "at",
        format!("{time}inlet {}, outlet {}, above the pressure around the seal", pa(inlet), pa(outlet)),
    );
    let choked: Vec<_> = answer.flows.iter().filter_map(|flow| flow.choke).collect();
    if let (true, Some(first)) = (leaks, choked.first()) {
        let x = quantity(first.x, "m");
        let of = if answer.flows.len() > 1 { ", with the first seed" } else { "" };
        let width = quantity(plan.profile.width(), "m");
        row("narrowest", format!("at {x} of {width} from the inlet, pressed with {}{of}", pa(first.pressed)));
    }
    if leaks && answer.one_way.mean > 0.0 {
        let ratio = quantity(answer.leak.mean / answer.one_way.mean, "");
        row("opened by the fluid", format!("{ratio} times the leak of the contact that it does not open"));
    }
    if leaks && answer.growth.is_finite() {
        let growth = quantity(answer.growth, "");
        row("in proportion to", "length, 1/viscosity, and 1/width at the same contact pressures".into());
        row("a tenth more pressure", format!("{growth} times the leak"));
    }
    let seeds: Vec<f64> =
        answer.sweep.seeds.iter().filter_map(|seed| seed.seed.map(|seed| seed as f64)).collect();
    if seeds.len() > 1 {
        row("seeds", format!("{}; in brackets the least and the largest of them", seeds.len()));
    }
    row("tightness over time", over_time(answer, units));
    rows
}

/// "3 ml/year (1 ml/year to 5 ml/year)".
fn with_spread(spread: &Spread, words: impl Fn(f64) -> String) -> String {
    match spread.least == spread.largest {
        true => words(spread.mean),
        false => format!("{} ({} to {})", words(spread.mean), words(spread.least), words(spread.largest)),
    }
}

fn opening(answer: &SealAnswer) -> String {
    let every = |is: fn(&Opens) -> bool| answer.opens.iter().all(is);
    match answer.opening {
        _ if every(|opens| *opens == Opens::Always) => "none: the seal leaks at every pressure".into(),
        _ if every(|opens| *opens == Opens::Never) => "none: the seal is tight at every pressure".into(),
        None => "not known of every seed: see the findings".into(),
        Some(opening) => {
            let first = with_spread(&opening, |pressure| quantity(pressure, "Pa"));
            let high = answer
                .opens
                .iter()
                .filter_map(|opens| if let Opens::Between(_, high) = opens { Some(*high) } else { None });
            let high = high.fold(0.0, f64::max);
            match high.is_finite() && high > 0.0 {
                true => format!("{first}; all of them leak from {} on", quantity(high, "Pa")),
                false => first,
            }
        }
    }
}

/// "closes between t = 1 s and 10 s".
fn over_time(answer: &SealAnswer, units: &Units) -> String {
    let list = &answer.by_time;
    let times: Vec<f64> = list.iter().map(|over| over.at).collect();
    let open: Vec<f64> = list.iter().map(|over| f64::from(u8::from(over.leak.largest != 0.0))).collect();
    match asperity_io::leakage::words::tight(&times, &open, units) {
        words if !words.is_empty() => words,
        _ if times.len() == 1 => format!("leaks at t = {}, the only stored time", units.time(times[0])),
        _ => format!(
            "leaks from t = {} to {}; at first {}",
            units.time(times[0]),
            units.time(times[times.len() - 1]),
            units.number(list[0].leak.mean, "m3/s")
        ),
    }
}
