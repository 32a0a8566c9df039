//! The leakage of a run that stopped before it.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity_io::case::Case;
use asperity_io::leakage::{LeakError, LeakHistory};
use asperity_io::session::{RunError, RunOptions, run};
use asperity_io::store::{Reader, Status};

const CASE: &str = r#"
[domain]
cells = [16, 16]
size = ["1 mm", "1 mm"]
boundary = "periodic"
[[surface]]
kind = "wave"
amplitude = "1 um"
wavelength = ["1 mm", "1 mm"]
[[body]]
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "3 MPa", retardation_time = "1 s" }
[load]
control = "pressure"
history = { kind = "step", value = "1.8 kPa" }
[time]
end = "2 s"
steps = 3
[leakage]
pressure_drop = "100 Pa"
viscosity = "1 mPa s"
[output]
every = 1
"#;

#[test]
fn a_run_that_stops_before_its_leakage_says_so_and_is_resumed_to_the_same_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let case = Case::parse(CASE, Path::new("."), &[]).unwrap();
    let options =
        |name: &str| RunOptions { output: Some(directory.path().join(name)), ..RunOptions::default() };
    let whole = run(&case, &options("whole.zarr"), |_| ()).unwrap();

    // Interrupted with the last row: all rows are stored, nothing leaks yet.
    let stop = RunOptions { interrupt: Arc::new(AtomicBool::new(false)), ..options("parts.zarr") };
    let stopped = run(&case, &stop, |progress| {
        if progress.finished {
            stop.interrupt.store(true, Ordering::Relaxed);
        }
    });
    assert!(matches!(stopped, Err(RunError::Leakage { source: LeakError::Interrupted, .. })), "{stopped:?}");
    let open = |name: &str| Reader::open(&directory.path().join(name)).unwrap();
    assert!(open("parts.zarr").lacks_leakage() && !open("whole.zarr").lacks_leakage());

    let resumed = run(&case, &RunOptions { resume: true, ..options("parts.zarr") }, |_| ()).unwrap();
    assert_eq!((resumed.status, resumed.rows), (Status::Complete, whole.rows));
    assert_eq!((&resumed.answers, &resumed.findings), (&whole.answers, &whole.findings));
    let table = |name: &str| LeakHistory::of(&open(name)).unwrap().unwrap().table;
    assert_eq!(table("parts.zarr"), table("whole.zarr"));
    assert!(!open("parts.zarr").lacks_leakage());
    // Now nothing is left, and a second resume says what there is.
    let again = run(&case, &RunOptions { resume: true, ..options("parts.zarr") }, |_| ()).unwrap();
    assert_eq!(
        (again.status, again.rows, again.convolutions),
        (Status::Complete, whole.rows, whole.convolutions)
    );
}
