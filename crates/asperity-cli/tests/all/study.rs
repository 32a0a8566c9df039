//! `asperity study`: runs of many values in one folder, stopped, shared and gone on with.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use asperity_io::answer::{self, Units};
use asperity_io::store::Reader;
use serde_json::Value;

use crate::{asperity, command};

/// A rough ball on rubber, some hundredths of a second.
const CASE: &str = r#"
title = "ball"
[domain]
cells = [40, 32]
size = ["1 mm", "0.8 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.05
longest = "0.5 mm"
shortest = "0.1 mm"
seed = 4
[[body]]
name = "rubber"
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "2 MPa", retardation_time = "3 s" }
[load]
control = "load"
history = { kind = "ramp", value = "0.2 N", duration = "4 s" }
[time]
end = "10 s"
steps = 20
"#;

const LOADS: &str = "load.history.value=0.05 N,0.2 N";
const SEEDS: &str = "surface.1.seed=1..3";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.toml"), CASE).unwrap();
    folder
}

fn study(folder: &Path, arguments: &[&str]) -> Output {
    asperity(folder, &[&["study", "ball.toml", "--vary", LOADS, "--vary", SEEDS], arguments].concat())
}

fn csv(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name).join("study.csv")).unwrap()
}

/// The rows of a table by the names of its columns.
fn rows(csv: &str) -> Vec<BTreeMap<&str, &str>> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(|line| names.iter().copied().zip(line.split(',')).collect()).collect()
}

/// Starts a study one run at a time and waits until its first run has ended.
fn begun(folder: &Path, name: &str) -> Child {
    let all = ["study", "ball.toml", "--vary", LOADS, "--vary", SEEDS, "--jobs", "1", "-o", name];
    let mut child = command(folder, &all).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let first = lines.find(|line| line.as_ref().unwrap().starts_with("1/6"));
    assert!(first.is_some());
    // What is written after that goes nowhere.
    std::thread::spawn(move || lines.for_each(drop));
    child
}

#[test]
fn a_study_that_was_killed_goes_on_to_the_same_table() {
    let folder = folder();
    let path = folder.path();
    let whole = study(path, &["-o", "whole"]);
    assert_eq!(whole.status.code(), Some(0), "{}", String::from_utf8_lossy(&whole.stderr));

    let mut child = begun(path, "parts");
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    let left = asperity(path, &["study", "status", "parts", "--json"]);
    let left: Value = serde_json::from_slice(&left.stdout).unwrap();
    assert!(
        left["counts"]["done"].as_u64().unwrap() >= 1 && left["counts"]["done"].as_u64().unwrap() < 6,
        "{left}"
    );
    let resumed = study(path, &["-o", "parts"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", String::from_utf8_lossy(&resumed.stderr));
    assert_eq!(csv(path, "parts"), csv(path, "whole"));

    // The numbers are those of single runs.
    let table = csv(path, "whole");
    let rows = rows(&table);
    assert_eq!(rows.len(), 6);
    for row in [&rows[0], &rows[4]] {
        let (load, seed) = (row["load.history.value [N]"], row["surface.1.seed"]);
        let keys = [format!("load.history.value={load}"), format!("surface.1.seed={seed}")];
        let run =
            ["run", "ball.toml", "-q", "--force", "-o", "one.zarr", "--set", &keys[0], "--set", &keys[1]];
        assert!(asperity(path, &run).status.success());
        let reader = Reader::open(&path.join("one.zarr")).unwrap();
        let answers = answer::of(&reader, &Units::default()).unwrap();
        assert!(answers.len() > 3);
        for answer in answers {
            let unit = if answer.unit == "1" { String::new() } else { format!(" [{}]", answer.unit) };
            let stored: f64 = row[format!("{}{unit}", answer.name).as_str()].parse().unwrap();
            assert_eq!(stored.to_bits(), answer.value.to_bits(), "{}", answer.name);
        }
        // What the result says of its case is a case of its own.
        let result = Reader::open(&path.join("whole").join(row["path"])).unwrap();
        std::fs::write(path.join("alone.toml"), &result.header().case_text).unwrap();
        assert!(asperity(path, &["check", "alone.toml"]).status.success());
    }
    for name in ["study.png", "study.json", "study.zarr/zarr.json"] {
        assert!(path.join("whole").join(name).is_file(), "{name}");
    }
}

#[test]
#[cfg(unix)]
fn a_signal_stops_a_study_and_what_is_done_stays() {
    let folder = folder();
    let mut child = begun(folder.path(), "parts");
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let table = csv(folder.path(), "parts");
    let done = rows(&table).iter().filter(|row| row["status"] == "done").count();
    assert!((1..6).contains(&done), "{table}");
}

#[test]
fn processes_that_share_a_folder_make_the_whole_study() {
    let folder = folder();
    let path = folder.path();
    assert!(study(path, &["-o", "whole", "-q"]).status.success());
    let shard = |shard| {
        let all = ["study", "ball.toml", "--vary", LOADS, "--vary", SEEDS, "-o", "parts", "--shard", shard];
        command(path, &all).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap()
    };
    let told = ["1/2", "2/2"].map(shard).map(|child| {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    });
    assert!(told.iter().all(|told| told.contains("3/3") && !told.contains("4/")), "{told:?}");
    assert_eq!(csv(path, "parts"), csv(path, "whole"));
    // Both processes may also do whatever is left, and none of the runs twice.
    let both = [0, 1].map(|_| {
        let all = ["study", "ball.toml", "--vary", LOADS, "--vary", SEEDS, "-o", "both", "-q"];
        command(path, &all).stdout(Stdio::null()).spawn().unwrap()
    });
    for mut child in both {
        assert!(child.wait().unwrap().success());
    }
    assert!(asperity(path, &["study", "collect", "both"]).status.success());
    assert_eq!(csv(path, "both"), csv(path, "whole"));
}

#[test]
fn processes_of_a_launcher_divide_a_study_and_the_last_one_draws_it() {
    let folder = folder();
    let path = folder.path();
    assert!(study(path, &["-o", "whole", "-q"]).status.success());
    let all = ["study", "ball.toml", "--vary", LOADS, "--vary", SEEDS, "-o", "ranks"];
    for rank in 0..3 {
        let variables = [("SLURM_PROCID", rank.to_string()), ("SLURM_NTASKS", "3".to_owned())];
        let output = command(path, &all).envs(variables).output().unwrap();
        let [told, shown] =
            [&output.stderr, &output.stdout].map(|text| String::from_utf8_lossy(text).into_owned());
        assert!(output.status.success(), "{told}");
        assert!(
            told.contains(&format!("share {}/3, as Slurm says", rank + 1)) && told.contains("2/2"),
            "{told}"
        );
        let is_last = rank == 2;
        assert_eq!(
            [!shown.is_empty(), path.join("ranks/study.png").exists()],
            [is_last; 2],
            "{rank}: {shown}"
        );
    }
    assert_eq!(csv(path, "ranks"), csv(path, "whole"));
}

#[test]
fn runs_of_a_killed_process_are_taken_up_by_the_next_launch() {
    let folder = folder();
    let path = folder.path();
    assert!(study(path, &["-o", "whole", "-q"]).status.success());
    let all = ["study", "ball.toml", "--vary", LOADS, "--vary", SEEDS, "-o", "ranks", "-q"];
    let launch = |rank: usize, count: usize| {
        let variables = [("OMPI_COMM_WORLD_RANK", rank), ("OMPI_COMM_WORLD_SIZE", count)];
        let output =
            command(path, &all).envs(variables.map(|(name, n)| (name, n.to_string()))).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    // Rank 1 of 3 never comes to its runs.
    launch(0, 3);
    launch(2, 3);
    assert!(!path.join("ranks/study.zarr").exists());
    launch(0, 2);
    launch(1, 2);
    assert_eq!(csv(path, "ranks"), csv(path, "whole"));
    assert!(path.join("ranks/study.zarr").exists());
}

#[test]
fn one_contact_on_several_processes_is_refused() {
    let folder = folder();
    let path = folder.path();
    let run = |variables: &[(&str, &str)]| {
        let variables = variables.iter().copied();
        let output = command(path, &["run", "ball.toml", "--force", "-q"]).envs(variables).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, told) = run(&[("PMI_RANK", "1"), ("PMI_SIZE", "8")]);
    assert_eq!(code, Some(2), "{told}");
    assert!(
        told.contains("MPICH has started 8 processes of it (PMI_SIZE=8)") && told.contains("asperity study"),
        "{told}"
    );
    assert!(!path.join("ball.zarr").exists());
    // One process, and a job of an array, are runs of their own.
    assert_eq!(run(&[("PMI_RANK", "0"), ("PMI_SIZE", "1")]).0, Some(0));
    assert_eq!(
        run(&[("SLURM_ARRAY_TASK_ID", "3"), ("SLURM_ARRAY_TASK_MIN", "1"), ("SLURM_ARRAY_TASK_MAX", "8")]).0,
        Some(0)
    );
}

#[test]
fn a_run_that_fails_does_not_stop_the_others() {
    let folder = folder();
    let path = folder.path();
    let vary = ["study", "ball.toml", "--vary", "solver.max_iterations=1,200", "-o", "s"];
    for _ in 0..2 {
        let output = asperity(path, &vary);
        assert_eq!(output.status.code(), Some(1));
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(told.contains("error: 1 of 2 runs failed"), "{told}");
        let table = csv(path, "s");
        let rows = rows(&table);
        assert_eq!([rows[0]["status"], rows[1]["status"]], ["failed", "done"]);
        assert!(rows[0]["error"].contains("iteration") && rows[1]["error"].is_empty(), "{table}");
    }
}

#[test]
fn keys_and_values_are_checked_before_the_first_run() {
    let folder = folder();
    let path = folder.path();
    for (vary, words) in [
        (&["load.history.valu=1 N,2 N"][..], &["`valu`"][..]),
        (&["load.history.value=0.1 N,2 m"], &["load.history.value is \"2 m\""]),
        (&["surface.7.seed=1..3"], &["surface[7].seed", "no element 7"]),
        (&["load.history.value"], &["--vary \"load.history.value\" has no \"=\""]),
        (&["load.history.value=1 N:2 N:1"], &["load.history.value", "from 2 to"]),
        (&["load.history.value=1 N", "load.history.value=2 N"], &["load.history.value is given twice"]),
        (&[], &["nothing varies"]),
    ] {
        let options: Vec<&str> = vary.iter().flat_map(|vary| ["--vary", *vary]).collect();
        let output = asperity(path, &[&["study", "ball.toml", "-o", "s"], &options[..]].concat());
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{vary:?}: {told}");
        assert!(words.iter().all(|word| told.contains(word)), "{vary:?}: {told}");
        assert!(!path.join("s").exists(), "{vary:?}");
    }
    let file = study(path, &["-o", "ball.toml"]);
    let told = String::from_utf8_lossy(&file.stderr);
    assert_eq!(file.status.code(), Some(2));
    assert!(told.contains("-o ball.toml is no folder"), "{told}");
    let zip = study(path, &["--zip", "-o", "s"]);
    let told = String::from_utf8_lossy(&zip.stderr);
    assert_eq!(zip.status.code(), Some(2));
    assert!(told.contains("load.history.value has 2 values, surface.1.seed has 3 values"), "{told}");
}

#[test]
fn a_case_may_hold_its_study_and_a_folder_only_that() {
    let folder = folder();
    let path = folder.path();
    let section = "[study]\nzip = true\nvary = { \"surface.1.seed\" = \"1..2\", \"load.history.value\" = [\"0.1 N\", 0.2] }\n";
    std::fs::write(path.join("ball.toml"), format!("{CASE}{section}")).unwrap();
    assert!(asperity(path, &["run", "ball.toml", "-q"]).status.success());
    let output = asperity(path, &["study", "ball.toml", "-q"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = csv(path, "ball-study");
    let rows = rows(&table);
    let values: Vec<_> =
        rows.iter().map(|row| (row["surface.1.seed"], row["load.history.value [N]"])).collect();
    // In the order of the section.
    assert!(table.starts_with("surface.1.seed,load"), "{table}");
    assert_eq!(values, [("1", "0.1"), ("2", "0.2")]);

    // Values may be added; another case, other keys and fewer values are another study.
    let add = ["--vary", "surface.1.seed=1..3", "--vary", "load.history.value=0.1 N,0.2,0.3 N"];
    let study = |more: &[&str]| asperity(path, &[&["study", "ball.toml", "-q"], more].concat());
    assert!(study(&[]).status.success());
    for (more, words) in [
        (&["--set", "time.steps=10"][..], "line 25 was `steps = 20` and is `steps = 10`"),
        (&["--product"], "made with --zip"),
        (&["--vary", "time.steps=5,10"], "it varies surface.1.seed, load.history.value, not"),
        (&["--vary", "surface.1.seed=1,7"], "a run with seed = 2, load = 0.2"),
    ] {
        let output = study(more);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{more:?}: {told}");
        assert!(told.contains(words) && told.contains("another folder"), "{more:?}: {told}");
    }
    let output = study(&add[..]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(csv(path, "ball-study").lines().count(), 4);
}

#[test]
#[cfg(unix)]
fn a_run_stays_whose_error_bars_fail_and_gets_them_later() {
    let folder = folder();
    let path = folder.path();
    let vary = ["study", "ball.toml", "--vary", "load.history.value=0.2 N", "--error-bars", "-o", "s"];
    // Without a place for the other grids.
    let output = crate::command(path, &vary).env("TMPDIR", path.join("nowhere")).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && told.contains("no error bars: no temporary directory"), "{told}");
    let names = || std::fs::read_dir(path.join("s")).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(
        !names().any(|name| name.to_string_lossy().ends_with(".error")),
        "{:?}",
        names().collect::<Vec<_>>()
    );
    assert_eq!(rows(&csv(path, "s"))[0]["status"], "done");
    assert!(asperity(path, &vary).status.success());
    assert!(csv(path, "s").contains("contact_area_error"));
}

#[test]
fn a_study_carries_errors_and_findings() {
    let folder = folder();
    let path = folder.path();
    // Of 24 x 20 cells the contact has few, and the shortest wave is left out so that the grid can be halved.
    let smooth =
        CASE.replace("shortest = \"0.1 mm\"", "shortest = \"0.4 mm\"").replace("[40, 32]", "[24, 20]");
    std::fs::write(path.join("ball.toml"), smooth).unwrap();
    let vary = ["study", "ball.toml", "--vary", "load.history.value=0.5 mN,0.2 N", "-q", "-o", "s"];
    assert!(asperity(path, &vary).status.success());
    assert!(!csv(path, "s").contains("contact_area_error"));
    // The runs that are done get their errors.
    let output = asperity(path, &[&vary[..], &["--error-bars"]].concat());
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && told.contains(" ± "), "{told}");
    assert!(told.contains("runs have findings: ") || told.contains("runs has findings: "), "{told}");
    let table = csv(path, "s");
    for row in rows(&table) {
        let reader = Reader::open(&path.join("s").join(row["path"])).unwrap();
        let bar = reader.error_bars().into_iter().find(|bar| bar.name == "contact_area").unwrap();
        let stored: f64 = row["contact_area_error [m2]"].parse().unwrap();
        assert_eq!(Some(stored), bar.error);
        let codes = reader.findings().iter().map(|finding| finding.code.to_string());
        assert!(
            codes.into_iter().all(|code| row["finding_codes"].split(' ').any(|own| own == code)),
            "{row:?}"
        );
    }
    assert!(rows(&table)[0]["finding_codes"].contains("few-contact-cells"), "{table}");
    assert!(path.join("s/study.zarr/contact_area_error/zarr.json").is_file());
    let status = asperity(path, &["study", "status", "s"]);
    assert!(String::from_utf8(status.stdout).unwrap().contains("few-contact-cells ("));
    assert!(std::fs::read_to_string(path.join("s/study.html")).unwrap().contains("few-contact-cells"));
    // A comparison says whether the loads matter.
    let (first, second) = (rows(&table)[0]["path"].to_owned(), rows(&table)[1]["path"].to_owned());
    let output = asperity(path, &["compare", &format!("s/{first}"), &format!("s/{second}")]);
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("more than the errors"), "{told}");
    // As `compare s/*`: what is no result is left out, and told.
    let others = ["study.csv", "study.json", "study.png", "study.html", "study.zarr"];
    let names =
        others.iter().copied().chain([first.as_str(), second.as_str()]).map(|name| format!("s/{name}"));
    let all: Vec<String> = ["compare".to_owned()].into_iter().chain(names).collect();
    let output = asperity(path, &all.iter().map(String::as_str).collect::<Vec<_>>());
    let left_out = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && left_out.contains("s/study.zarr"), "{left_out}");
    assert_eq!(String::from_utf8(output.stdout).unwrap(), told);
}
