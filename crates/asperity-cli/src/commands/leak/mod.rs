//! `asperity leak`: leakage of a result, or of a map of the gap.

mod gap;
mod options;

use std::path::Path;

use asperity::Boundary;
use asperity::finding::Finding;
use asperity_io::answer::{Units, Validity};
use asperity_io::case::leak as checked;
use asperity_io::choice;
use asperity_io::finding;
use asperity_io::leakage::{Beside, Leak, LeakError, LeakHistory, compute, settings, store};
use asperity_io::store::{LeakTable, Reader};
use serde_json::{Map, Value, json};

use crate::args;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::quantity;
use crate::input::with_options;
use crate::messages::message;
use crate::verb::{Threads, Verb};

impl Verb for args::Leak {
    fn files(&self) -> Files {
        Files::default()
            .reads(self.result.iter().chain(&self.gap).chain(&self.contact))
            .draws(&self.plot)
            .force(self.force)
    }

    fn threads(&self) -> Threads {
        Threads::of(self.threads)
    }

    /// Computes the leakage, or shows the one that is stored.
    fn run(&self) -> Result<(), Failure> {
        match (&self.result, &self.gap) {
            (Some(_), _) if self.plot.is_some() => refuse!(
                "--plot draws a map of the gap (--gap FILE); the figure of a result is drawn by: asperity plot RESULT leak"
            ),
            (Some(result), _) => result_leak(self, result),
            (None, Some(path)) => gap::run(self, path),
            (None, None) => refuse!("name a result, or a map of the gap with --gap FILE"),
        }
    }
}

fn result_leak(args: &args::Leak, path: &Path) -> Result<(), Failure> {
    let reader = Reader::open(path)?;
    let leak = asked(args, &reader)?;
    let units = Units::of(&reader, &super::answers::units(&args.unit)?);
    let history = match LeakHistory::of(&reader)? {
        Some(stored) if stored.leak == leak => stored,
        stored => {
            if let Some(stored) = stored.filter(|_| !args.no_store) {
                message!(
                    "replaces the stored leakage: {} (--no-store computes without storing)",
                    stored.leak.words()
                );
            }
            let interrupt = crate::interrupt::flag();
            let found = if args.no_store {
                compute(&reader, &leak, &interrupt, observe)
            } else {
                drop(reader);
                store(path, &leak, Beside::default(), &interrupt, observe)
            };
            found.map_err(failure)?
        }
    };
    super::findings::print(&history.all_findings().cloned().collect::<Vec<_>>());
    let series = history.table.series();
    let rates: Vec<&str> =
        series.iter().filter(|one| one.name.starts_with("leak_rate")).map(|one| one.units).collect();
    check(&units, &rates)?;
    let text = if args.json { object(path, &history) } else { text(&history, &units) };
    crate::print(&text)
}

/// What is asked for: the options given change what is stored, or what the case asks for.
fn asked(args: &args::Leak, reader: &Reader) -> Result<Leak, Failure> {
    let boundary = reader.header().setup.get("boundary").and_then(Value::as_str).and_then(choice::parse);
    let boundary = boundary.unwrap_or(Boundary::Periodic);
    let given = options::keys(&args.fluid);
    let leak = match settings(reader) {
        Some(earlier) => earlier.changed(given, boundary),
        None => checked(&given, boundary),
    };
    let leak = leak.map_err(|message| Failure::Input(with_options(&message)))?;
    Ok(match &args.times {
        Some(list) => Leak { times: super::times(list)?, ..leak },
        None => leak,
    })
}

/// Refuses a unit for leaks in which none of these rates can be given, and notes one where there is no rate.
fn check(units: &Units, rates: &[&str]) -> Result<(), Failure> {
    if let (Some(unit), true) = (units.text("leak"), rates.is_empty()) {
        message!("note: the unit {unit} for leaks changes nothing: without a fluid there is no leak rate");
    }
    units.check_leak(rates).map_err(Failure::about("--unit"))
}

fn observe(done: usize, of: usize) {
    if std::io::IsTerminal::is_terminal(&std::io::stderr()) {
        eprint!("\rleakage {done}/{of}{}", if done == of { "\n" } else { "" });
    }
}

fn failure(error: LeakError) -> Failure {
    match error {
        LeakError::Interrupted => Failure::Interrupted("the result is as it was".into()),
        LeakError::Solve { source: asperity::Error::Invalid { .. }, .. } | LeakError::Store(_) => {
            Failure::input(error.to_string())
        }
        LeakError::Solve { .. } | LeakError::Beside { .. } => Failure::Solve(error.to_string()),
    }
}

fn object(path: &Path, history: &LeakHistory) -> String {
    let table = &history.table;
    let names = table.series().into_iter().map(|series| series.name);
    let mut object: Map<String, Value> =
        names.filter_map(|name| Some((name.to_owned(), numbers(name, table.get(name)?)))).collect();
    if let Some(all) = table.get("conductance") {
        let tensors = all.chunks(4).map(|tensor| tensor.chunks(2).map(|row| json!(row)).collect::<Value>());
        object.insert("conductance".into(), tensors.collect());
    }
    object.insert("leakage".into(), serde_json::to_value(&history.leak).unwrap_or_default());
    let findings: Vec<Finding> = history.all_findings().cloned().collect();
    object.insert("findings".into(), finding::list(&findings));
    object.insert("leak_valid".into(), history.of_each_time().iter().map(Validity::is_valid).collect());
    object.insert("result".into(), json!(path.to_string_lossy()));
    // What the findings say of the last leak.
    if let Value::Object(marks) = json!(history.validity("leak_rate")) {
        object.extend(marks);
    }
    format!("{}\n", Value::Object(object))
}

/// A column as JSON: flags as true and false, NaN as null.
fn numbers(name: &str, values: &[f64]) -> Value {
    match name {
        "percolates" | "leak_resolved" => values.iter().map(|v| json!(*v > 0.0)).collect(),
        "leak_step" => values.iter().map(|v| json!(*v as u64)).collect(),
        _ => json!(values),
    }
}

/// What was asked for, a table of the times, and when the seal is tight.
fn text(history: &LeakHistory, units: &Units) -> String {
    let table = &history.table;
    let column = |name: &str| table.get(name).unwrap_or_default();
    let times = column("leak_time");
    let standard = table.get("leak_rate_standard");
    let fluid = history.leak.fluid.is_some();
    let validity = history.of_each_time();
    let is_doubted = |n: usize| match &validity[n] {
        Validity::Holds => column("leak_resolved")[n] == 0.0,
        of => of.is_valid(),
    };
    let mut text = format!("Leakage of {}\n\n{:>12}", history.leak.words(), table.axis.name());
    if fluid {
        text += &format!("{:>34}", "leak rate");
    }
    text += &format!("{:>15}{:>15}{:>14}\n", "hydraulic gap", "critical gap", "trapped area");
    for n in 0..table.len() {
        text += &format!("{:>12}", units.coordinate(table.axis.at(times[n])));
        let tight = column("percolates")[n] == 0.0;
        let taken = !validity[n].is_valid();
        let mark = if is_doubted(n) { " ?" } else { "  " };
        if fluid {
            let words = match tight {
                _ if taken => validity[n].cell(String::new()),
                true => "tight".to_owned(),
                false => units.rate(column("leak_rate")[n], standard.map(|standard| standard[n])),
            };
            text += &format!("{:>34}", words + mark);
        }
        let gap = |name: &str| match (tight, fluid, name) {
            _ if taken && name == "hydraulic_gap" => "not valid".to_owned(),
            _ if taken => "-".to_owned(),
            (false, ..) => quantity(column(name)[n], "m"),
            (true, false, "hydraulic_gap") => "tight".to_owned(),
            (true, ..) => "-".to_owned(),
        };
        text += &format!("{:>15}{:>15}", gap("hydraulic_gap"), gap("critical_gap"));
        text += &format!("{:>14}\n", quantity(column("trapped_area")[n], "m2"));
    }
    if (0..table.len()).any(is_doubted) {
        text += "? see the findings\n";
    }
    let last = history.validity("leak_rate");
    if !last.is_valid() {
        text += &format!("the last leak is {}\n", last.mark(String::new()));
    }
    if let Some(patch) = history.patch(units) {
        text += &format!("the leak rate is {patch}\n");
    }
    let tight = history.tight(units);
    if !tight.is_empty() && last.is_valid() {
        text += &format!("{}\n", history.validity("tight_from").mark(tight));
    }
    text + &tensors(table)
}

/// The conductance at each time.
fn tensors(table: &LeakTable) -> String {
    let Some(all) = table.get("conductance") else { return String::new() };
    let times = table.get("leak_time").unwrap_or_default();
    let mut text = format!(
        "\nconductance [m3]\n{:>12}{:>14}{:>14}{:>14}{:>14}\n",
        table.axis.name(),
        "xx",
        "xy",
        "yx",
        "yy"
    );
    for (time, tensor) in times.iter().zip(all.chunks(4)) {
        text += &format!("{:>12}", quantity(*time, table.axis.unit()));
        tensor.iter().for_each(|entry| text += &format!("{entry:>14.4e}"));
        text.push('\n');
    }
    text
}
