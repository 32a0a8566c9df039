//! `cargo xtask peers`: other programs and this one on the same surfaces, to the same accuracy, taking turns.
//!
//! The programs live in a virtual environment below target/peers. An elastic case is compared twice: to the same accuracy,
//! each program, ours too, with tighter and tighter tolerances until its contact area lies within 1e-4 of the reference
//! (ours at 1e-10); and at the same tolerance, 1e-6, for those that do not take long. A program that cannot be installed or
//! does not get there is told in the table.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

use crate::{Done, at, cargo, environment, output, root, run};

/// Programs, their packages, and the packages that building them needs.
const PEERS: [(&str, &str); 3] =
    [("tamaas", "tamaas"), ("contactmechanics", "ContactMechanics"), ("aspher", "aspher")];
/// Headers of Eigen, for aspher.
const EIGEN: &str = "cmeel-eigen";
const TOLERANCES: [f64; 7] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// Relative difference of contact areas that counts as the same.
const SAME: f64 = 1e-4;
/// What all are compared at besides, and a viscoelastic case, whose error is that of the step, alone.
const TIGHT: f64 = 1e-6;
/// Turns of each case.
const TURNS: usize = 3;
/// A run that takes longer decides its own turn \[s\]: it is not repeated.
const LONG: f64 = 20.0;

struct Case {
    boundary: &'static str,
    cells: usize,
    /// Steps of the viscoelastic case; 0 for the elastic one.
    steps: usize,
}

pub fn peers(quick: bool) -> Done {
    let directory = root().join("target/peers");
    std::fs::create_dir_all(&directory).map_err(at(&directory))?;
    let python = with_programs()?;
    run(&mut cargo(&["build", "--release", "-p", "asperity", "--example", "gap_file"]))?;
    let cells = if quick { 256 } else { 1024 };
    let cases = [
        Case { boundary: "free", cells, steps: 0 },
        Case { boundary: "periodic", cells, steps: 0 },
        Case { boundary: "periodic", cells: cells / 2, steps: if quick { 20 } else { 100 } },
    ];
    let mut table = String::from(
        "| case | to | program | version | tolerance | time | area, of the reference | times ours |\n|---|---|---|---|---|---|---|---|\n",
    );
    for case in &cases {
        table += &compare(case, &directory, &python)?;
    }
    let text = format!("{}\n\n{table}", machine());
    println!("{text}");
    std::fs::write(directory.join("peers.md"), text).map_err(|e| e.to_string())
}

/// A Python with those of the programs that can be installed.
fn with_programs() -> Result<PathBuf, String> {
    let python = environment("target/peers/environment")?;
    let installed =
        |package: &str| output(Command::new(&python).args(["-m", "pip", "show", "--quiet", package])).is_ok();
    for package in [EIGEN, "tamaas", "ContactMechanics", "aspher"] {
        if installed(package) {
            continue;
        }
        // The package of headers lies beside the others; aspher looks for it where these variables say.
        let prefix = "import sysconfig; print(sysconfig.get_path('purelib') + '/cmeel.prefix')";
        let prefix = output(Command::new(&python).args(["-c", prefix]))?;
        let prefix = prefix.trim();
        let install = run(Command::new(&python)
            .args(["-m", "pip", "install", "--quiet", package])
            .env("CMAKE_PREFIX_PATH", prefix)
            .env("CPLUS_INCLUDE_PATH", format!("{prefix}/include/eigen3")));
        if let Err(message) = install {
            eprintln!("xtask: {package} is left out: {message}");
        }
    }
    Ok(python)
}

/// The rows of one case.
fn compare(case: &Case, directory: &Path, python: &Path) -> Result<String, String> {
    let gap = directory.join(format!("gap-{}.f64", case.cells));
    run(ours(&["write"]).arg(&gap).arg(case.cells.to_string()))?;
    let own = |tolerance: f64, steps: usize| {
        let mut command = ours(&["solve"]);
        command.arg(&gap).args([
            &case.cells.to_string(),
            case.boundary,
            &PRESSURE.to_string(),
            &tolerance.to_string(),
            &steps.to_string(),
        ]);
        answer(&mut command)
    };
    let reference = own(1e-10, case.steps)?;
    let peer = |name: &str, tolerance: f64| {
        let description = json!({
            "case": if case.steps == 0 { "elastic" } else { "viscoelastic" },
            "gap": gap, "cells": case.cells, "boundary": case.boundary, "pressure": PRESSURE,
            "tolerance": tolerance, "steps": case.steps,
        });
        let driver = root().join(format!("xtask/peers/{name}_driver.py"));
        answer(Command::new(python).arg(driver).arg(description.to_string()))
    };

    let mut programs: Vec<(String, Box<Run>)> = Vec::new();
    programs.push(("asperity".into(), Box::new(move |tolerance| own(tolerance, case.steps))));
    for (name, package) in PEERS {
        if case.steps == 0 || name == "tamaas" {
            programs.push((package.into(), Box::new(move |tolerance| peer(name, tolerance))));
        }
    }
    let (mut tight, mut accurate) = (Vec::new(), Vec::new());
    let mut failures = String::new();
    let failure = |name: &str, tolerance: f64, message: &str| {
        format!("| {} | | {name} | | {tolerance:e} | {message} | | |\n", case.title())
    };
    for (name, run) in &programs {
        let mut tried = |tolerance: f64| -> Option<Entry> {
            match run(tolerance) {
                Ok(first) => Some(Entry { name, run, tolerance, runs: vec![first] }),
                Err(message) => {
                    let last = message.lines().last().unwrap_or_default().replace('|', "/");
                    failures += &failure(name, tolerance, &last);
                    None
                }
            }
        };
        if case.steps > 0 {
            tight.extend(tried(TIGHT));
            continue;
        }
        let off = |entry: &Entry| (entry.runs[0].fraction / reference.fraction - 1.0).abs();
        let mut found = None;
        for tolerance in TOLERANCES {
            found = tried(tolerance);
            if found.as_ref().is_none_or(|entry| off(entry) <= SAME) {
                break;
            }
        }
        let Some(found) = found else { continue };
        if found.runs[0].seconds < LONG {
            tight.extend(tried(TIGHT));
        }
        if off(&found) <= SAME {
            accurate.push(found);
        } else {
            failures += &failure(name, found.tolerance, &format!("its area stays {:.1e} off", off(&found)));
        }
    }
    let mut rows = String::new();
    for (what, mut entries) in [("the same area", accurate), ("the same tolerance", tight)] {
        for _ in 1..TURNS {
            for entry in entries.iter_mut().filter(|entry| entry.runs.iter().all(|run| run.seconds < LONG)) {
                entry.runs.push((entry.run)(entry.tolerance)?);
            }
        }
        let base = entries.first().map_or(f64::NAN, Entry::least);
        for entry in &entries {
            rows += &format!(
                "| {} | {what} | {} | {} | {:e} | {:.3} s | {:.6} | {:.1} |\n",
                case.title(),
                entry.name,
                entry.runs[0].version,
                entry.tolerance,
                entry.least(),
                entry.runs[0].fraction / reference.fraction,
                entry.least() / base,
            );
        }
    }
    Ok(rows + &failures)
}

/// Mean pressure over E*: some tenth of the area is in contact.
const PRESSURE: f64 = 0.005;

/// A program on a case, with a tolerance.
type Run<'a> = dyn Fn(f64) -> Result<Answer, String> + 'a;

/// What is compared: a program at a tolerance.
struct Entry<'a> {
    name: &'a str,
    run: &'a Run<'a>,
    tolerance: f64,
    runs: Vec<Answer>,
}

impl Entry<'_> {
    fn least(&self) -> f64 {
        self.runs.iter().map(|run| run.seconds).fold(f64::INFINITY, f64::min)
    }
}

struct Answer {
    seconds: f64,
    fraction: f64,
    version: String,
}

/// What a program prints on its last line.
fn answer(command: &mut Command) -> Result<Answer, String> {
    eprintln!("xtask: {command:?}");
    let text = output(command.current_dir(root()))?;
    let value: Value =
        serde_json::from_str(text.lines().last().unwrap_or_default()).map_err(|e| format!("{e}: {text}"))?;
    let number = |key: &str| value[key].as_f64().ok_or_else(|| format!("no {key} in {value}"));
    Ok(Answer {
        seconds: number("seconds")?,
        fraction: number("fraction")?,
        version: value["version"].as_str().unwrap_or_default().into(),
    })
}

fn ours(arguments: &[&str]) -> Command {
    let mut command = Command::new(root().join("target/release/examples/gap_file"));
    command.args(arguments);
    command
}

impl Case {
    fn title(&self) -> String {
        let Case { boundary, cells, steps } = self;
        if *steps == 0 {
            format!("elastic, {boundary}, {cells} x {cells}")
        } else {
            format!("viscoelastic, {boundary}, {cells} x {cells}, {steps} steps")
        }
    }
}

/// The machine, as far as it tells.
fn machine() -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processor.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or(": unknown");
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "Processor {}, {threads} threads; least time of {TURNS} turns.",
        model.trim_start_matches([' ', '\t', ':'])
    )
}
