//! What a run finds about itself is stored with it, and a resumed run ends with the findings of one that never stopped.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity_io::case::Case;
use asperity_io::session::{RunOptions, Summary, run};
use asperity_io::store::{Reader, Status};

/// A sphere that fills its domain in the middle of a triangle.
const CASE: &str = r#"
[domain]
cells = [24, 24]
size = ["2 mm", "2 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "2 MPa", shear_kelvin = "2 MPa", retardation_time = "1 s" }
[load]
control = "load"
history = { kind = "triangle", peak = "1.5 N", rise = "5 s", fall = "5 s" }
[time]
end = "10 s"
steps = 20
[output]
fields = []
checkpoint = true
"#;

fn case() -> Case {
    Case::parse(CASE, ".".as_ref(), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn codes(summary: &Summary) -> Vec<&str> {
    summary.findings.iter().map(|finding| finding.code.as_ref()).collect()
}

#[test]
fn a_resumed_run_keeps_its_findings() {
    let directory = tempfile::tempdir().unwrap();
    let options =
        |name: &str| RunOptions { output: Some(directory.path().join(name)), ..RunOptions::default() };
    let whole = run(&case(), &options("whole.zarr"), |_| {}).unwrap();
    assert_eq!(codes(&whole), ["contact-at-border"]);
    let [first, last] = whole.findings[0].rows.unwrap();
    assert!(first > 1 && last < 20 && first < 8 && last > 12, "{:?}", whole.findings);

    let interrupt = Arc::new(AtomicBool::new(false));
    let stopped = RunOptions { interrupt: interrupt.clone(), ..options("parts.zarr") };
    let halves =
        run(&case(), &stopped, |progress| interrupt.store(progress.done == 10, Ordering::Relaxed)).unwrap();
    assert_eq!((halves.status, codes(&halves)), (Status::Interrupted, vec!["contact-at-border"]));
    let path = directory.path().join("parts.zarr");
    assert_eq!(Reader::open(&path).unwrap().findings(), halves.findings);

    let ended = run(&case(), &RunOptions { resume: true, ..options("parts.zarr") }, |_| {}).unwrap();
    assert_eq!((ended.status, &ended.findings), (Status::Complete, &whole.findings));
    assert_eq!(Reader::open(&path).unwrap().findings(), whole.findings);
}

/// A rough line that starts to slide: the first rows, after the jump, have the largest and least certain forces.
const SLIDING: &str = r#"
[domain]
cells = [64]
size = ["1 mm"]
boundary = "periodic"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.1
longest = "1 mm"
shortest = "0.1 mm"
seed = 3
[[body]]
poisson = 0.5
material = { model = "zener", shear = "4 MPa", shear_kelvin = "1 MPa", retardation_time = "20 ms" }
[motion]
velocity = "10 mm/s"
[load]
control = "load"
history = { kind = "step", value = "0.1 N/mm" }
[time]
end = "30 ms"
steps = 5
[output]
fields = []
checkpoint = true
"#;

#[test]
fn friction_of_a_resumed_run_is_judged_over_all_rows() {
    let case = Case::parse(SLIDING, ".".as_ref(), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let directory = tempfile::tempdir().unwrap();
    let options =
        |name: String| RunOptions { output: Some(directory.path().join(name)), ..RunOptions::default() };
    let whole = run(&case, &options("whole.zarr".into()), |_| {}).unwrap();
    assert!(codes(&whole).contains(&"friction-uncertain"), "{:?}", whole.findings);
    let rows = Reader::open(&directory.path().join("whole.zarr")).unwrap().rows().unwrap();
    // Stopped in the rows that the finding concerns, and after them.
    for stop in [2, rows.len() / 2, rows.len() - 2] {
        let name = format!("{stop}.zarr");
        let interrupt = Arc::new(AtomicBool::new(false));
        let stopped = RunOptions { interrupt: interrupt.clone(), ..options(name.clone()) };
        run(&case, &stopped, |progress| interrupt.store(progress.done >= stop, Ordering::Relaxed)).unwrap();
        let ended = run(&case, &RunOptions { resume: true, ..options(name.clone()) }, |_| {}).unwrap();
        assert_eq!((ended.status, &ended.findings), (Status::Complete, &whole.findings), "{stop}");
        assert_eq!(Reader::open(&directory.path().join(name)).unwrap().rows().unwrap(), rows, "{stop}");
    }
}

#[test]
fn data_files_name_their_units_or_are_asked_for_them() {
    use asperity_io::curve::{Columns, Curves, Kind};
    let rows: String = (0..20)
        .map(|k| {
            let t = 10f64.powf(-1.0 + 0.2 * f64::from(k));
            format!("{t:.4e}, {:.6}\n", 1.0 + 2.0 * (-t / 10.0).exp())
        })
        .collect();
    let read = |header: &str| {
        let text = format!("{header}\n{rows}");
        Curves::parse("it.csv".as_ref(), text.as_bytes(), Kind::Relaxation, &Columns::default())
    };
    for header in [
        "t [s], E [MPa]",
        "\"t, s\", \"E, MPa\"",
        "t in s, E in MPa",
        "t_s, E_MPa",
        "t, s, E, MPa",
        "t s, E MPa",
    ] {
        let curves = read(header).unwrap_or_else(|error| panic!("{header}: {error}"));
        // E(0.1 s) is 2.98 MPa.
        assert!((curves.sweeps[0].curves[0][0] / 2.98e6 - 1.0).abs() < 1e-3, "{header}");
    }
    // What cannot be read is asked for, and not taken in Pa.
    for (header, words) in [
        ("log t, log E", "logarithm"),
        ("t [s], log Q", "no column is recognised as modulus"),
        ("t, E relaxed, all in MPa", "does not name 2 columns"),
    ] {
        let error = read(header).unwrap_err().to_string();
        assert!(error.contains(words), "{header}: {error}");
    }
}

#[test]
fn a_fit_that_misses_its_data_is_refused() {
    use asperity::material::FitOptions;
    use asperity_io::curve::{Columns, Curves, Kind, Request};
    // Two per cent of regular scatter about a Prony series, and one of a factor of two.
    let curves = |scatter: f64| {
        let row = |k: i32| {
            let t = 10f64.powf(-1.0 + 0.05 * f64::from(k));
            let sign = [1.0, -1.0, -1.0, 1.0][(k % 4) as usize];
            format!("{t:.6e}, {:.8}\n", (1.0 + 2.0 * (-t / 10.0).exp()) * (1.0 + scatter * sign))
        };
        let text = format!("t [s], E [MPa]\n{}", (0..80).map(row).collect::<String>());
        Curves::parse("it.csv".as_ref(), text.as_bytes(), Kind::Relaxation, &Columns::default()).unwrap()
    };
    let fit = |scatter: f64, limit: f64| {
        let options = FitOptions { limit, ..FitOptions::default() };
        Request { options, ..Request::default() }.fit(&curves(scatter)).map_err(|error| error.to_string())
    };
    assert!(fit(0.02, 0.1).is_ok());
    assert!(fit(0.02, 0.01).unwrap_err().contains("rms misfit"));
    assert!(fit(0.3, 0.1).unwrap_err().contains("misfit"));
}
