//! A run that was interrupted goes on only with the files that it began with.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity_io::case::Case;
use asperity_io::session::{RunError, RunOptions, run};
use asperity_io::store::Status;

const CASE: &str = r#"
[domain]
cells = [24, 24]
size = ["2 mm", "2 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
[body.material]
model = "relaxation-table"
path = "test.csv"
modulus = "young"
shift = { model = "table", path = "shift.csv" }
[temperature]
history = { kind = "file", path = "warm.csv" }
[load]
control = "load"
history = { kind = "file", path = "load.csv" }
[wear]
coefficient = "1e-15 m2/N"
velocity = { kind = "file", path = "slide.csv" }
[time]
end = "10 s"
steps = 5
"#;

fn write(dir: &Path, name: &str, text: &str) {
    std::fs::write(dir.join(name), text).unwrap();
}

#[test]
fn a_changed_file_of_a_case_is_noticed_by_resume() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let test = "t [s], E [MPa]\n0.1, 3\n1, 2\n10, 1.5\n100, 1.2\n1000, 1.1\n";
    let files = [
        ("test.csv", test),
        ("shift.csv", "T [°C], log aT\n10, 1\n20, 0\n40, -1\n"),
        ("warm.csv", "0 s, 20 °C\n10 s, 30 °C\n"),
        ("load.csv", "0, 0\n10, 0.1\n"),
        ("slide.csv", "0 s, 0.1 m/s\n10 s, 0.2 m/s\n"),
    ];
    files.iter().for_each(|(name, text)| write(dir, name, text));
    let case = || Case::parse(CASE, dir, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let result = dir.join("result.zarr");
    let interrupt = Arc::new(AtomicBool::new(true));
    let options = RunOptions { output: Some(result.clone()), interrupt, ..RunOptions::default() };
    let summary = run(&case(), &options, |_| {}).unwrap();
    assert_eq!(summary.status, Status::Interrupted);

    let resume = RunOptions { output: Some(result), resume: true, ..RunOptions::default() };
    for (name, text) in files {
        // A remark changes no number, but nobody can know that before reading it all.
        write(dir, name, &format!("{text}# again\n"));
        let error = run(&case(), &resume, |_| {}).unwrap_err();
        assert!(matches!(error, RunError::Output(_)), "{error}");
        let message = error.to_string();
        assert!(message.contains("md5_of_files") && message.contains(name), "{message}");
        write(dir, name, text);
    }
    let summary = run(&case(), &resume, |_| {}).unwrap();
    assert_eq!(summary.status, Status::Complete);
}
