//! The command as a user meets it: what it prints, writes and returns.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use asperity_io::store::{At, FieldKind, Reader, Status};
use serde_json::Value;

use crate::asperity;

/// The repository's root.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn example(name: &str) -> PathBuf {
    root().join("examples").join(name)
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A rough viscoelastic case with a cap, small enough for a test.
const SMALL: &str = r#"
title = "small"
[domain]
cells = [60, 48]
size = ["1 mm", "1 mm"]
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
hardness = "2 MPa"
material = { model = "zener", shear = "1 MPa", shear_kelvin = "2 MPa", retardation_time = "3 s" }
[load]
control = "load"
history = { kind = "trapezoid", peak = "0.5 N", rise = "1 s", hold = "4 s", fall = "2 s" }
[time]
end = "8 s"
steps = 16
[output]
path = "small.zarr"
fields = ["pressure", "gap", "displacement", "contact"]
every = 4
checkpoint = true
"#;

fn small() -> (tempfile::TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("small.toml"), SMALL).unwrap();
    let path = directory.path().to_owned();
    (directory, path)
}

/// Everything a result holds, to the bit (the time it took aside).
fn content(path: &Path) -> (String, Vec<Vec<u64>>) {
    let reader = Reader::open(path).unwrap();
    let mut maps = vec![];
    for index in 0..reader.field_times().len() {
        for kind in [FieldKind::Pressure, FieldKind::Gap, FieldKind::Displacement] {
            let map = reader.field(kind, At::Index(index)).unwrap();
            maps.push(map.iter().map(|v| v.to_bits()).collect());
        }
    }
    (format!("{:?}", reader.rows().unwrap()), maps)
}

#[test]
fn a_run_prints_a_summary_and_leaves_a_result() {
    let (_keep, dir) = small();
    let output = asperity(&dir, &["run", "small.toml"]);
    assert!(output.status.success(), "{}", stderr(&output));
    for word in ["approach", "contact area", "convolutions", "small.zarr"] {
        assert!(stdout(&output).contains(word), "{word} in {}", stdout(&output));
    }
    assert!(stderr(&output).contains("row 17/17"), "{}", stderr(&output));
    let reader = Reader::open(&dir.join("small.zarr")).unwrap();
    assert_eq!(reader.status(), Status::Complete);
    let rows = reader.rows().unwrap();
    assert_eq!((rows.len(), rows[0].time(), rows[16].time()), (17, 0.0, 8.0));
    // At t = 4 s the load is whole and some cells are at the hardness; at 8 s all is open.
    assert!((rows[8].load - 0.5).abs() < 1e-12 && rows[8].max_pressure == 2e6);
    assert_eq!((rows[16].load, rows[16].contact_area), (0.0, 0.0));
    assert!(rows.iter().all(|r| r.residual <= 1e-6 && r.certificate < 0.01));
    assert_eq!(reader.field_times(), [0.0, 2.0, 4.0, 6.0, 8.0]);
}

#[test]
fn json_output_is_one_object() {
    let (_keep, dir) = small();
    let output = asperity(&dir, &["run", "small.toml", "--json", "-o", "there.zarr", "--quiet"]);
    assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
    let object: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(object["status"], "complete");
    assert_eq!(object["steps"], 17);
    assert_eq!(object["result"], "there.zarr");
    for key in ["wall_s", "convolutions", "iterations"] {
        assert!(object[key].as_f64().unwrap() > 0.0, "{key}");
    }
    assert!(object.as_object().unwrap().contains_key("peak_memory_bytes"));
    assert!(dir.join("there.zarr").is_dir());
    let check = asperity(&dir, &["check", "small.toml", "--json"]);
    let object: Value = serde_json::from_str(&stdout(&check)).unwrap();
    assert_eq!(object["rows"], 17);
    assert!(object["memory_bytes"].as_f64().unwrap() > 60.0 * 48.0 * 100.0);
}

#[test]
fn the_result_has_the_same_bits_for_any_number_of_threads() {
    let (_keep, dir) = small();
    for threads in ["1", "2", "3"] {
        let path = format!("{threads}.zarr");
        let output = asperity(&dir, &["run", "small.toml", "--threads", threads, "-o", &path, "-q"]);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let one = content(&dir.join("1.zarr"));
    assert_eq!(one, content(&dir.join("2.zarr")));
    assert_eq!(one, content(&dir.join("3.zarr")));
}

#[test]
fn results_are_not_overwritten_unless_told() {
    let (_keep, dir) = small();
    assert!(asperity(&dir, &["run", "small.toml", "-q"]).status.success());
    let again = asperity(&dir, &["run", "small.toml", "-q"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("--force"), "{}", stderr(&again));
    assert!(asperity(&dir, &["run", "small.toml", "-q", "--force"]).status.success());
    // A directory that is something else is left alone, even with --force.
    std::fs::create_dir(dir.join("photos")).unwrap();
    std::fs::write(dir.join("photos/me.jpg"), "x").unwrap();
    let foreign = asperity(&dir, &["run", "small.toml", "-q", "--force", "-o", "photos"]);
    assert_eq!(foreign.status.code(), Some(2));
    assert!(dir.join("photos/me.jpg").exists());
    // Nor is a place that does not exist made up.
    let nowhere = asperity(&dir, &["run", "small.toml", "-q", "-o", "no/such/place.zarr"]);
    assert_eq!(nowhere.status.code(), Some(2), "{}", stderr(&nowhere));
    assert!(stderr(&nowhere).contains("no/such"), "{}", stderr(&nowhere));
}

#[test]
fn wrong_input_is_told_with_key_line_and_value() {
    let (_keep, dir) = small();
    for (set, words) in [
        ("body.0.hardness=2 mm", vec!["body[0].hardness", "2 mm"]),
        ("domain.cels=3", vec!["cels", "cells"]),
        ("load.history.peak=-1 N", vec!["load.history", "-1"]),
        ("load.history.peak=5 kN", vec!["2"]),
        ("domain.cells=[0, 4]", vec!["domain.cells", "0"]),
        ("domain.cells=[900000, 900000]", vec!["domain.cells"]),
        ("body.0.poisson=0.7", vec!["poisson", "0.7"]),
    ] {
        let output = asperity(&dir, &["run", "small.toml", "--set", set]);
        assert_eq!(output.status.code(), Some(2), "{set}: {}", stderr(&output));
        let told = stderr(&output);
        assert!(words.iter().all(|w| told.contains(w)), "{set}: {told}");
        assert!(!told.contains("panicked"), "{told}");
        assert!(!dir.join("small.zarr").exists(), "{set} left a result");
    }
    let missing = asperity(&dir, &["run", "nothing.toml"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(stderr(&missing).contains("nothing.toml"));
    assert_eq!(asperity(&dir, &["run", "small.toml", "--threads", "0"]).status.code(), Some(2));
}

#[test]
fn a_solve_that_does_not_converge_is_exit_code_1_with_its_numbers() {
    let (_keep, dir) = small();
    let output = asperity(&dir, &["run", "small.toml", "--set", "solver.max_iterations=2", "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("residual") && stderr(&output).contains("best state"));
    let object: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(object["status"], "failed");
    assert!(object["best"]["residual"].as_f64().unwrap() > 1e-6);
    let reader = Reader::open(&dir.join("small.zarr")).unwrap();
    assert_eq!(reader.status(), Status::Failed);
}

/// Rows of [`long`]: the state at 0+ and the steps; the breaks of the load are among them.
const LONG: usize = 65;

/// A run that takes some seconds.
fn long() -> Vec<String> {
    let set = ["domain.cells=[256, 256]", "time.steps=64", "output.every=1"];
    let mut arguments = vec!["run".to_owned(), "small.toml".to_owned()];
    arguments.extend(set.iter().flat_map(|s| ["--set".to_owned(), (*s).to_owned()]));
    arguments
}

/// Starts a long run and waits for some rows of it.
fn started(dir: &Path, rows: usize) -> std::process::Child {
    let child = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(long())
        .current_dir(dir)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while Reader::open(&dir.join("small.zarr")).map_or(0, |r| r.len()) < rows {
        assert!(start.elapsed() < Duration::from_secs(100), "no rows appear");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

#[test]
fn a_killed_run_is_readable_and_resumes_to_the_same_bits() {
    let (_keep, dir) = small();
    let mut child = started(&dir, 5);
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    let rows = Reader::open(&dir.join("small.zarr")).unwrap().len();
    assert!((5..LONG).contains(&rows), "{rows} rows");
    let mut arguments = long();
    arguments.push("--resume".into());
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let resumed = asperity(&dir, &arguments);
    assert!(resumed.status.success(), "{}", stderr(&resumed));
    let mut whole: Vec<&str> = arguments[..arguments.len() - 1].to_vec();
    whole.extend(["-o", "whole.zarr"]);
    assert!(asperity(&dir, &whole).status.success());
    assert_eq!(content(&dir.join("small.zarr")), content(&dir.join("whole.zarr")));
    // A script may repeat the command: nothing is left to resume, and this is said. Another case does not resume it.
    let again = asperity(&dir, &arguments);
    assert!(
        again.status.success() && stderr(&again).contains("nothing is left to resume"),
        "{}",
        stderr(&again)
    );
    let other: Vec<&str> =
        arguments.iter().copied().chain(["--set", "load.history.value=\"0.7 N\""]).collect();
    assert_eq!(asperity(&dir, &other).status.code(), Some(2));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_ends_with_130_and_goes_on() {
    let (_keep, dir) = small();
    let child = started(&dir, 3);
    // Not SIGINT, which is ignored where the tests themselves run in the background of a script.
    let kill = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stderr(&output).contains("--resume"), "{}", stderr(&output));
    assert_eq!(Reader::open(&dir.join("small.zarr")).unwrap().status(), Status::Interrupted);
    let mut arguments = long();
    arguments.push("--resume".into());
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let resumed = asperity(&dir, &arguments);
    assert!(resumed.status.success(), "{}", stderr(&resumed));
    assert_eq!(Reader::open(&dir.join("small.zarr")).unwrap().len(), LONG);
}

/// `nohup` starts a process with SIGHUP ignored.
#[cfg(unix)]
#[test]
fn a_signal_that_is_ignored_stays_ignored() {
    let (_keep, dir) = small();
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_asperity"), "run", "small.toml"])
        .args(["--verbose", "--set", "time.steps=400"])
        .current_dir(&dir)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(child.stderr.take().unwrap()));
    lines.find(|line| line.as_ref().is_ok_and(|line| line.starts_with("row "))).unwrap().unwrap();
    assert!(Command::new("kill").args(["-HUP", &child.id().to_string()]).status().unwrap().success());
    lines.for_each(drop);
    assert!(child.wait().unwrap().success());
    assert_eq!(Reader::open(&dir.join("small.zarr")).unwrap().status(), Status::Complete);
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_not_utf_8_is_told_in_json() {
    use std::os::unix::ffi::OsStrExt;
    let (_keep, dir) = small();
    let output = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(["run", "small.toml", "--json", "--quiet", "-o"])
        .arg(std::ffi::OsStr::from_bytes(b"r\xff.zarr"))
        .current_dir(&dir)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let object: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&object["status"], &object["result"]), (&"complete".into(), &"r\u{fffd}.zarr".into()));
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_at_once() {
    let (_keep, dir) = small();
    assert!(Command::new("mkfifo").arg(dir.join("pipe")).status().unwrap().success());
    for (arguments, word) in [
        (&["run", "pipe"][..], "a pipe"),
        (&["check", "/dev/zero"], "a device"),
        (&["surface", "info", "pipe"], "a pipe"),
        (&["surface", "info", "/dev/zero"], "a device"),
        (&["material", "fit", "pipe"], "a pipe"),
    ] {
        let output = asperity(&dir, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(word), "{arguments:?}: {}", stderr(&output));
    }
}

/// A file of unknown format is not read beyond its head, however long: here 1 TiB that takes no space on the disk.
#[cfg(target_os = "linux")]
#[test]
fn a_long_file_of_unknown_format_is_refused_by_its_head() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::File::create(dir.path().join("long.dat")).unwrap().set_len(1 << 40).unwrap();
    let output = asperity(dir.path(), &["surface", "info", "long.dat"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("none of the known formats"), "{}", stderr(&output));
    // Of a format that the user names, it is the memory that does not do.
    std::fs::write(dir.path().join("head.npy"), b"\x93NUMPY\x01\0").unwrap();
    let file = std::fs::OpenOptions::new().write(true).open(dir.path().join("head.npy")).unwrap();
    file.set_len(1 << 40).unwrap();
    let output = asperity(dir.path(), &["surface", "info", "head.npy"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("need about 3.0 TiB of memory"), "{}", stderr(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_no_disk_holds_is_refused_before_the_run() {
    let (_keep, dir) = small();
    let output = asperity(
        &dir,
        &[
            &["run", "small.toml", "--set", "domain.cells=[1024, 1024]"][..],
            &["--set", "time.steps=10000000", "--set", "output.every=1"],
        ]
        .concat(),
    );
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("free on its disk"), "{}", stderr(&output));
    assert!(!dir.join("small.zarr").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn threads_that_the_system_refuses_are_told() {
    let (_keep, dir) = small();
    // Stacks of 8 GB each have no place in an address space of 4 GB.
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 4000000; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_asperity")])
        .args(["run", "small.toml", "--threads", "4"])
        .env("RUST_MIN_STACK", "8000000000")
        .current_dir(&dir)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("cannot start 4 threads"), "{}", stderr(&output));
}

#[test]
fn a_result_is_verified_and_its_damage_listed() {
    let (_keep, dir) = small();
    assert!(asperity(&dir, &["run", "small.toml", "--quiet"]).status.success());
    let output = asperity(&dir, &["verify-result", "small.zarr"]);
    assert!(
        output.status.success() && stdout(&output).contains("all with their checksums"),
        "{}",
        stdout(&output)
    );
    for file in ["max_pressure/c/0", "gap/c/1/0/0"] {
        let path = dir.join("small.zarr").join(file);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[40] ^= 1;
        std::fs::write(&path, bytes).unwrap();
    }
    let output = asperity(&dir, &["verify-result", "small.zarr", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let object: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&object["ok"], object["damage"].as_array().unwrap().len()), (&false.into(), 2));
    let text = stdout(&asperity(&dir, &["verify-result", "small.zarr"]));
    assert!(text.contains("max_pressure") && text.contains("gap/c/1/0/0"), "{text}");
    for command in ["show", "report", "export"] {
        let to: &[&str] = if command == "export" { &["--to", "npz"] } else { &[] };
        let output = asperity(&dir, &[&[command, "small.zarr"], to].concat());
        assert_eq!(output.status.code(), Some(2), "{command}");
        assert!(stderr(&output).contains("is damaged"), "{command}: {}", stderr(&output));
    }
    assert_eq!(asperity(&dir, &["verify-result", "small.toml"]).status.code(), Some(2));
}

/// An override that gives a case so many cells along each axis that its size has.
fn coarse(case: &str, cells: usize) -> String {
    let line = case
        .lines()
        .any(|line| line.starts_with("size = [") && !line.split('#').next().unwrap().contains(','));
    if line { format!("domain.cells=[{cells}]") } else { format!("domain.cells=[{cells}, {cells}]") }
}

#[test]
fn every_starter_case_is_written_and_checks() {
    let dir = tempfile::tempdir().unwrap();
    let list = stdout(&asperity(dir.path(), &["new"]));
    assert!(list.lines().count() >= 5, "{list}");
    for name in list.lines().filter_map(|line| line.split_whitespace().next()) {
        assert!(asperity(dir.path(), &["new", name]).status.success());
        let file = format!("{name}.toml");
        let cells = coarse(&std::fs::read_to_string(dir.path().join(&file)).unwrap(), 256);
        let check = asperity(dir.path(), &["check", &file, "--set", &cells]);
        assert!(check.status.success(), "{name}: {}", stderr(&check));
        assert!(stdout(&check).contains("memory"));
        assert_eq!(asperity(dir.path(), &["new", name]).status.code(), Some(2), "{name} was overwritten");
    }
    let unknown = asperity(dir.path(), &["new", "nonsense"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(stderr(&unknown).contains("hertz"));
}

#[test]
fn every_example_runs_on_a_coarse_grid() {
    let dir = tempfile::tempdir().unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(root().join("examples")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        count += 1;
        let mut arguments = vec!["run", path.to_str().unwrap(), "-q", "--force", "-o", "out.zarr"];
        let cells = coarse(&std::fs::read_to_string(&path).unwrap(), 128);
        arguments.extend(["--set", &cells]);
        // Waves long enough for the coarse grid, where the case has roughness.
        match path.file_stem().and_then(|stem| stem.to_str()) {
            Some("rough-pmma") => arguments.extend(["--set", "surface.1.shortest=2 um"]),
            Some("periodic-rough" | "seal") => arguments.extend(["--set", "surface.0.shortest=16 um"]),
            _ => {}
        }
        let output = asperity(dir.path(), &arguments);
        assert!(output.status.success(), "{}: {}", path.display(), stderr(&output));
    }
    assert!(count >= 5);
}

#[test]
fn schema_and_completions_are_printed() {
    let dir = tempfile::tempdir().unwrap();
    let schema: Value = serde_json::from_str(&stdout(&asperity(dir.path(), &["schema"]))).unwrap();
    assert!(schema["properties"]["domain"].is_object());
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(stdout(&asperity(dir.path(), &["completions", shell])).contains("asperity"), "{shell}");
    }
}

#[test]
fn verify_prints_checks_that_hold() {
    let dir = tempfile::tempdir().unwrap();
    let output = asperity(dir.path(), &["verify", "hertz-sphere", "flat-punch-history", "--json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let list: Vec<Value> = serde_json::from_str(&stdout(&output)).unwrap();
    assert!(list.len() > 10);
    assert!(list.iter().all(|check| check["ok"] == true
        && check["error"].as_f64().unwrap() <= check["tolerance"].as_f64().unwrap()));
    assert_eq!(asperity(dir.path(), &["verify", "nonsense"]).status.code(), Some(2));
}

#[test]
fn the_case_of_the_readme_is_an_example() {
    assert!(example("rough-pmma.toml").exists() && example("hertz.toml").exists());
}

#[test]
fn a_surface_is_looked_at_and_converted() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("heights.txt"), "1 2 3 4\n4 5 6 1\n7 8 nan 2\n2 1 0 3\n").unwrap();
    // Size and unit are asked for by name.
    let asked = asperity(dir.path(), &["surface", "info", "heights.txt"]);
    assert_eq!(asked.status.code(), Some(2));
    assert!(stderr(&asked).contains("--height-unit"), "{}", stderr(&asked));
    let asked = asperity(dir.path(), &["surface", "info", "heights.txt", "--height-unit", "um"]);
    assert_eq!(asked.status.code(), Some(2));
    assert!(stderr(&asked).contains("--size"), "{}", stderr(&asked));
    let given = ["--size", "3 mm,4 mm", "--height-unit", "um"];
    let mut arguments = vec!["surface", "info", "heights.txt", "--json"];
    arguments.extend(given);
    let info = asperity(dir.path(), &arguments);
    assert!(info.status.success(), "{}", stderr(&info));
    let object: Value = serde_json::from_str(&stdout(&info)).unwrap();
    assert_eq!(object["format"], "asc");
    assert_eq!(object["shape"], serde_json::json!([4, 4]));
    assert_eq!(object["size"], serde_json::json!([3e-3, 4e-3]));
    assert_eq!((&object["undefined"], &object["h10"]), (&1.into(), &2e-6.into()));
    assert_eq!((&object["min"], &object["max"]), (&0.0.into(), &8e-6.into()));
    // mean 49/15, mean square 239/15, in um
    let sq = (239.0 / 15.0 - (49.0 / 15.0f64).powi(2)).sqrt() * 1e-6;
    assert!((object["sq"].as_f64().unwrap() / sq - 1.0).abs() < 1e-12);
    let mut arguments = vec!["surface", "convert", "heights.txt", "heights.gwy"];
    arguments.extend(given);
    assert!(asperity(dir.path(), &arguments).status.success());
    assert_eq!(asperity(dir.path(), &arguments).status.code(), Some(2), "overwritten");
    let again = asperity(dir.path(), &["surface", "info", "heights.gwy", "--json"]);
    let again: Value = serde_json::from_str(&stdout(&again)).unwrap();
    assert_eq!((&again["format"], &again["h01"]), (&"gwy".into(), &4e-6.into()));
}

#[test]
fn a_result_is_exported() {
    let (_keep, dir) = small();
    assert!(asperity(&dir, &["run", "small.toml", "-q"]).status.success());
    for (format, file) in [
        ("netcdf", "small.nc"),
        ("hdf5", "small.h5"),
        ("npz", "small.npz"),
        ("csv", "small.csv"),
        ("vtk", "small.pvd"),
    ] {
        let output = asperity(&dir, &["export", "small.zarr", "--to", format]);
        assert!(output.status.success(), "{format}: {}", stderr(&output));
        assert!(dir.join(file).exists() && stdout(&output).contains(file), "{}", stdout(&output));
    }
    let table = std::fs::read_to_string(dir.join("small.csv")).unwrap();
    assert!(table.contains("approach") && table.lines().count() >= 18, "{table}");
    let unknown = asperity(&dir, &["export", "small.zarr", "--to", "xlsx"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(stderr(&unknown).contains("netcdf"));
    assert_eq!(asperity(&dir, &["export", "nothing.zarr", "--to", "csv"]).status.code(), Some(2));
}

#[test]
fn a_result_is_shown_plotted_and_reported() {
    let (dir, _) = small();
    assert!(asperity(dir.path(), &["run", "small.toml", "--quiet"]).status.success());

    let shown = stdout(&asperity(dir.path(), &["show", "small.zarr"]));
    for words in ["complete, 17 of 17 rows", "60 x 48 cells", "approach", "contact at t = ", "└───"] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
    let object: Value =
        serde_json::from_str(&stdout(&asperity(dir.path(), &["show", "small.zarr", "--json"]))).unwrap();
    let reader = Reader::open(&dir.path().join("small.zarr")).unwrap();
    assert_eq!(object["last"]["approach"].as_f64(), reader.series("approach").unwrap().last().copied());

    for (what, file, more) in [
        ("evolution", "a.svg", &[][..]),
        ("pressure", "b.png", &["--time", "4 s"]),
        ("spots", "c.pdf", &["--time", "4 s"]),
    ] {
        let plot = asperity(dir.path(), &[&["plot", "small.zarr", what, "-o", file], more].concat());
        assert!(plot.status.success(), "{}", stderr(&plot));
        let starts: &[u8] = match &file[2..] {
            "svg" => b"<svg",
            "png" => b"\x89PNG",
            _ => b"%PDF-",
        };
        assert!(std::fs::read(dir.path().join(file)).unwrap().starts_with(starts), "{file}");
    }
    let svg = std::fs::read_to_string(dir.path().join("a.svg")).unwrap();
    assert!(svg.contains("contact area [") && svg.contains("time [s]"));

    assert!(asperity(dir.path(), &["report", "small.zarr"]).status.success());
    let page = std::fs::read_to_string(dir.path().join("small.html")).unwrap();
    assert!(page.contains("id=\"blob-pressure-0\"") && page.trim_end().ends_with("</html>"));

    assert!(
        asperity(dir.path(), &["export", "small.zarr", "--to", "png", "--fields", "contact"])
            .status
            .success()
    );
    let pictures = std::fs::read_dir(dir.path().join("small.pictures")).unwrap().count();
    assert_eq!(pictures, 1 + reader.field_times().len());
}

#[test]
fn the_cycles_of_a_sine_are_shown() {
    let dir = tempfile::tempdir().unwrap();
    assert!(asperity(dir.path(), &["new", "cyclic", "cyclic.toml"]).status.success());
    let run = asperity(dir.path(), &["run", "cyclic.toml", "--quiet", "--set", "domain.cells=[32,32]"]);
    assert!(run.status.success(), "{}", stderr(&run));
    let shown = stdout(&asperity(dir.path(), &["show", "cyclic.zarr"]));
    assert!(shown.contains("cycles at 0.0500 Hz") && shown.contains("loss angle"), "{shown}");
    let object: Value =
        serde_json::from_str(&stdout(&asperity(dir.path(), &["show", "cyclic.zarr", "--json"]))).unwrap();
    let cycles = object["cycles"][0]["cycles"].as_array().unwrap();
    assert_eq!(cycles.len(), 5);
    let last = |key: &str| cycles[4][key].as_f64().unwrap();
    // PMMA at 0.05 Hz, about its retardation times: tan(delta) of the material is 0.029; the contact area, which
    // changes within the cycle, takes little of it.
    assert!(last("loss_angle") > 0.01 && last("loss_angle") < 0.05, "{}", last("loss_angle"));
    assert!(last("dissipated_energy") > 0.0 && last("stiffness") > 0.0);
    assert_eq!((cycles[4]["start"].as_f64(), cycles[4]["end"].as_f64()), (Some(80.0), Some(100.0)));
}

#[test]
fn what_a_result_does_not_hold_is_told() {
    let (dir, _) = small();
    let fields = ["--set", "output.fields=[\"displacement\"]"];
    assert!(
        asperity(dir.path(), &[&["run", "small.toml", "--quiet"], &fields[..]].concat()).status.success()
    );
    let told = |arguments: &[&str], words: &[&str]| {
        let output = asperity(dir.path(), arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        words.iter().for_each(|word| assert!(text.contains(word), "{arguments:?}: {text}"));
    };
    told(&["plot", "small.zarr", "pressure"], &["pressure", "displacement"]);
    told(&["plot", "small.zarr", "spots"], &["displacement"]);
    told(&["plot", "small.zarr", "area"], &["no figure \"area\"", "evolution"]);
    told(&["plot", "small.zarr", "evolution", "-o", "x.jpg"], &["x.jpg", ".svg, .png or .pdf"]);
    told(&["plot", "small.zarr", "profile", "--at", "3 mm"], &["outside", "y ="]);
    told(&["plot", "small.zarr", "profile", "--at", "3 s"], &["--at", "3 s"]);
    told(&["plot", "nothing.zarr", "evolution"], &["nothing.zarr"]);
    told(&["report", "small.toml"], &["small.toml"]);
    told(&["show", "small.zarr", "--time", "soon"], &["--time", "soon"]);
    // Nothing is replaced unless told, and nothing is left of what failed.
    std::fs::write(dir.path().join("taken.png"), "mine").unwrap();
    told(&["plot", "small.zarr", "evolution", "-o", "taken.png"], &["taken.png", "--force"]);
    assert_eq!(std::fs::read_to_string(dir.path().join("taken.png")).unwrap(), "mine");
    assert!(asperity(dir.path(), &["report", "small.zarr"]).status.success(), "curves alone make a report");
    assert!(asperity(dir.path(), &["show", "small.zarr"]).status.success());
    // A truncated array.
    let array = dir.path().join("small.zarr/approach/c/0");
    let bytes = std::fs::read(&array).unwrap();
    std::fs::write(&array, &bytes[..bytes.len() / 2]).unwrap();
    told(&["report", "small.zarr", "--force"], &["approach", "damaged"]);
    told(&["plot", "small.zarr", "evolution"], &["approach", "damaged"]);
}

/// Status and content of the answer to a request; `host` may hold further headers.
fn ask_plain(address: &str, path: &str, host: &str) -> (String, Vec<u8>) {
    use std::io::{Read, Write};
    let mut stream = std::net::TcpStream::connect(address).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let end = answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap();
    let status = String::from_utf8_lossy(&answer[9..12]).into_owned();
    (status, answer[end + 4..].to_vec())
}

#[test]
fn a_result_is_served_to_those_who_know_its_address() {
    use std::io::{BufRead, BufReader};
    let (dir, _) = small();
    assert!(asperity(dir.path(), &["run", "small.toml", "--quiet"]).status.success());
    let mut server = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(["view", "small.zarr"])
        .current_dir(dir.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut url = String::new();
    BufReader::new(server.stdout.take().unwrap()).read_line(&mut url).unwrap();
    let (address, token) = url.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
    let address = address.to_owned();
    assert!(address.starts_with("127.0.0.1:") && token.len() == 33 && token.ends_with('/'), "{url}");
    let ask = |path: &str, host: &str| {
        let path = format!("/{token}{}", path.strip_prefix('/').unwrap());
        ask_plain(&address, &path, host)
    };
    let (status, page) = ask("/", &address);
    assert_eq!(status, "200");
    assert!(String::from_utf8(page).unwrap().contains("\"live\":true"));
    let (status, state) = ask("/state", "localhost");
    let state: Value = serde_json::from_slice(&state).unwrap();
    assert_eq!((status.as_str(), &state["running"]), ("200", &Value::Bool(false)));
    let (status, map) = ask("/map/pressure-2", &address);
    assert_eq!(status, "200");
    let reader = Reader::open(&dir.path().join("small.zarr")).unwrap();
    let field = reader.field(FieldKind::Pressure, At::Index(2)).unwrap();
    let largest = field.iter().copied().fold(0.0, f64::max);
    assert_eq!(map[8..16], largest.to_le_bytes(), "full resolution, its ends exact");
    assert_eq!(map[16..24], [60, 0, 0, 0, 48, 0, 0, 0]);
    for path in ["/map/pressure-99", "/map/../small.toml", "/etc/passwd", "/map/", "/map/pressure-x"] {
        assert_eq!(ask(path, &address).0, "404", "{path}");
    }
    assert_eq!(ask("/", "example.org").0, "403");
    // Without the token nothing is read, nor from the pages of others.
    for path in
        ["/", "/state", "/map/pressure-2", &format!("/{}/state", "0".repeat(32)), &format!("/{token}x")]
    {
        assert_eq!(
            ask_plain(&address, path, &address).0,
            if path.ends_with('x') { "404" } else { "403" },
            "{path}"
        );
    }
    let foreign = format!("{address}\r\nSec-Fetch-Site: cross-site");
    assert_eq!(ask("/state", &foreign).0, "403");
    server.kill().unwrap();
    server.wait().unwrap();
}

#[test]
fn several_results_are_compared_and_reported() {
    let (_keep, dir) = small();
    for (load, seed, name) in [("0.5 N", 4, "a.zarr"), ("0.25 N", 4, "b.zarr"), ("0.25 N", 5, "c.zarr")] {
        let set = [format!("load.history.peak={load}"), format!("surface.1.seed={seed}")];
        let output =
            asperity(&dir, &["run", "small.toml", "-q", "-o", name, "--set", &set[0], "--set", &set[1]]);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let all = ["compare", "a.zarr", "b.zarr", "c.zarr"];
    let output = asperity(&dir, &[&all[..], &["--json"]].concat());
    let object: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(object["case"]["surface[1].seed"], serde_json::json!(["4", "4", "5"]));
    assert_eq!(object["labels"][2], "peak = 0.25 N, seed = 5");
    assert_eq!(object["comparisons"].as_array().unwrap().len(), 2);
    assert_eq!(object["answers"][0]["values"].as_array().unwrap().len(), 3);
    let text = stdout(&asperity(&dir, &all));
    assert!(text.contains("surface[1].seed") && text.contains("contact area"), "{text}");

    let report = asperity(&dir, &["report", "a.zarr", "b.zarr", "c.zarr"]);
    assert!(report.status.success(), "{}", stderr(&report));
    let page = std::fs::read_to_string(dir.join("report.html")).unwrap();
    for words in [
        "<th>peak = 0.25 N, seed = 5</th>",
        ">contact area</td>",
        ">load.history.peak</td>",
        "data:image/svg",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let again = asperity(&dir, &["report", "a.zarr", "b.zarr"]);
    assert_eq!(again.status.code(), Some(2), "{}", stderr(&again));
}

#[test]
fn two_results_are_compared_and_drawn_together() {
    let (_keep, dir) = small();
    for (load, name) in [("0.5 N", "a.zarr"), ("0.25 N", "b.zarr")] {
        let set = format!("load.history.peak=\"{load}\"");
        let output = asperity(&dir, &["run", "small.toml", "-q", "-o", name, "--set", &set]);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let output = asperity(&dir, &["compare", "a.zarr", "b.zarr", "--json"]);
    let object: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(object["case"].as_object().unwrap().len(), 1, "{object}");
    assert_eq!(object["case"]["load.history.peak"], serde_json::json!(["\"0.5 N\"", "\"0.25 N\""]));
    assert_eq!(object["common_rows"], 17);
    let number = |name: &str| {
        let list = object["numbers"].as_array().unwrap();
        list.iter().find(|number| number["name"] == name).unwrap().clone()
    };
    // Half of the load in every row; nothing touches at the end.
    assert!((number("load")["largest_difference"].as_f64().unwrap() - 0.5).abs() < 1e-12);
    assert_eq!(number("load")["last"], serde_json::json!([0.0, 0.0]));
    // The answers stand side by side; both answer for the end of the peak.
    let answers = object["answers"].as_array().unwrap();
    let pressure = answers.iter().find(|answer| answer["name"] == "max_pressure").unwrap();
    let [a, b] = [0, 1].map(|n| pressure["values"][n].as_f64().unwrap());
    assert!((pressure["changes"][1].as_f64().unwrap() - (b / a - 1.0)).abs() < 1e-15 && a > b, "{pressure}");
    assert_eq!(object["labels"], serde_json::json!(["peak = 0.5 N", "peak = 0.25 N"]));
    let same = asperity(&dir, &["compare", "a.zarr", "a.zarr"]);
    assert!(stdout(&same).starts_with("The cases are the same."), "{}", stdout(&same));
    assert!(stdout(&same).lines().filter(|line| line.ends_with("none")).count() > 5, "{}", stdout(&same));

    // Newtons are no newtons per metre.
    assert!(asperity(&dir, &["new", "cylinder", "line.toml"]).status.success());
    let line = asperity(&dir, &["run", "line.toml", "-q", "-o", "line.zarr", "--set", "domain.cells=[64]"]);
    assert!(line.status.success(), "{}", stderr(&line));
    let other = asperity(&dir, &["compare", "a.zarr", "line.zarr"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(stderr(&other).contains("line.zarr is a line contact"), "{}", stderr(&other));

    let output = asperity(&dir, &["plot", "a.zarr", "b.zarr", "evolution", "-o", "both.svg"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let figure = std::fs::read_to_string(dir.join("both.svg")).unwrap();
    // Four panels, as of one result; each tells which curve is whose, by what differs.
    assert_eq!(figure.matches(">peak = 0.5 N<").count(), 4);
    assert_eq!(figure.matches(">peak = 0.25 N<").count(), 4);
    assert_eq!(figure.matches(">time [s]<").count(), 4);
    let named = ["plot", "a.zarr", "b.zarr", "evolution", "-o", "named.svg", "--label", "heavy", "--label"];
    assert!(asperity(&dir, &[&named[..], &["light"]].concat()).status.success());
    assert_eq!(std::fs::read_to_string(dir.join("named.svg")).unwrap().matches(">heavy<").count(), 4);
    let few = asperity(&dir, &["compare", "a.zarr", "b.zarr", "--label", "heavy"]);
    assert_eq!(few.status.code(), Some(2));
    assert!(stderr(&few).contains("there are 1 label, but 2 results"), "{}", stderr(&few));
    let maps = asperity(&dir, &["plot", "a.zarr", "b.zarr", "pressure"]);
    assert!(maps.status.success() && dir.join("a-b-pressure.png").is_file(), "{}", stderr(&maps));
    let none = asperity(&dir, &["plot", "evolution"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(stderr(&none).contains("<RESULT>"), "{}", stderr(&none));
    for results in [&["a.zarr"][..], &["a.zarr", "b.zarr"]] {
        let what = asperity(&dir, &[&["plot"], results].concat());
        assert_eq!(what.status.code(), Some(2));
        assert!(stderr(&what).contains("what to draw is missing"), "{}", stderr(&what));
    }
}
