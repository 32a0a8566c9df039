//! Cases whose rows are found as the run goes: stages with events, adaptive steps, fields at output times.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::step::Row;
use asperity_examples::Template;
use asperity_io::case::Case;
use asperity_io::session::{RunError, RunOptions, run};
use asperity_io::store::{At, FieldKind, Reader, Status};

fn case(more: &[&str]) -> Case {
    let text = Template::find("press-hold-retract").unwrap().text;
    let mut overrides = vec!["domain.cells=[48,48]".to_owned(), "time.tolerance=0.01".to_owned()];
    overrides.extend(more.iter().map(|text| (*text).to_owned()));
    Case::parse(text, Path::new("."), &overrides).unwrap_or_else(|errors| panic!("{errors}"))
}

fn options(path: &Path) -> RunOptions {
    RunOptions { output: Some(path.to_owned()), ..RunOptions::default() }
}

#[test]
fn a_programme_of_stages_is_run_stored_interrupted_and_resumed_to_the_same_bits() {
    let dir = tempfile::tempdir().unwrap();
    let (whole, parts) = (dir.path().join("whole.zarr"), dir.path().join("parts.zarr"));
    let case = case(&[]);
    let mut shares = vec![];
    let summary = run(&case, &options(&whole), |progress| {
        assert_eq!(progress.total, None);
        shares.push(progress.row.time() / progress.end);
    })
    .unwrap();
    assert_eq!(summary.status, Status::Complete);
    assert!(shares.windows(2).all(|pair| pair[1] >= pair[0]) && *shares.last().unwrap() <= 1.0);

    // Stopped in every third row, until it is done.
    let mut options = RunOptions { interrupt: Arc::new(AtomicBool::new(false)), ..options(&parts) };
    let mut sessions = 0;
    loop {
        let mut rows = 0;
        let flag = options.interrupt.clone();
        let summary = run(&case, &options, |_| {
            rows += 1;
            flag.store(rows >= 11, Ordering::Relaxed);
        })
        .unwrap();
        options.interrupt.store(false, Ordering::Relaxed);
        options.resume = true;
        sessions += 1;
        if summary.status == Status::Complete {
            break;
        }
        assert!(sessions < 200);
    }
    assert!(sessions > 3, "{sessions}");

    let (whole, parts) = (Reader::open(&whole).unwrap(), Reader::open(&parts).unwrap());
    assert_eq!(parts.rows().unwrap(), whole.rows().unwrap());
    assert_eq!(parts.field_times(), whole.field_times());
    assert_eq!(parts.field_steps(), whole.field_steps());
    for index in 0..whole.field_times().len() {
        for kind in [FieldKind::Pressure, FieldKind::Gap] {
            let [one, other] = [&parts, &whole].map(|r| r.field(kind, At::Index(index)).unwrap());
            assert_eq!(one, other, "{kind} {index}");
        }
    }

    // Fields at the instants asked for, each of its row; the first and the last row besides.
    let rows = whole.rows().unwrap();
    let times = whole.field_times();
    assert_eq!(times.len(), 6);
    assert_eq!(times[1..5], [5.0, 65.0, 70.0, 100.0]);
    for (time, step) in times.iter().zip(whole.field_steps()) {
        assert_eq!(rows[*step].time(), *time);
    }
    // Both stages that press, hold, retract, wait and press again are there; while apart nothing is pressed.
    let stages: Vec<usize> = rows.iter().map(|row| row.stage).collect();
    assert!(stages.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(stages.last(), Some(&4));
    assert!(rows.iter().filter(|row| row.stage == 3).all(|row| row.load == 0.0));
    assert!((rows.last().unwrap().load - 1.0).abs() < 1e-5);
    assert_eq!(whole.header().rows_expected, None);
    let errors = whole.series("time_error").unwrap();
    assert!(errors.iter().any(|error| *error > 0.0));
    assert!(errors.iter().all(|error| *error <= 0.01), "none is NaN, none above the tolerance: {errors:?}");
}

#[test]
fn steps_end_at_output_times_and_the_rest_of_the_run_stays_within_the_tolerance() {
    let dir = tempfile::tempdir().unwrap();
    let rows = |name: &str, times: &str| {
        let path = dir.path().join(name);
        run(&case(&[times]), &options(&path), |_| {}).unwrap();
        Reader::open(&path).unwrap().rows().unwrap()
    };
    let few = rows("few", "output.times=[\"70 s\"]");
    let wanted: Vec<f64> = (1..60).map(|n| f64::from(2 * n)).collect();
    let many = rows("many", &format!("output.times={wanted:?}"));
    assert!(wanted.iter().all(|t| many.iter().any(|row| row.time() == *t)));
    let at = |rows: &[Row]| rows.iter().find(|row| row.time() == 70.0).unwrap().load;
    let largest = few.iter().map(|row| row.load).fold(0.0, f64::max);
    // The tolerance of the steps.
    assert!((at(&few) - at(&many)).abs() < 0.01 * largest, "{} {}", at(&few), at(&many));
}

#[test]
fn an_event_that_does_not_come_fails_the_run_and_keeps_its_rows() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("result");
    let case = case(&["load.stages.2.history.value=6 um"]);
    let Err(RunError::Solve { source, summary, .. }) = run(&case, &options(&path), |_| {}) else { panic!() };
    assert!(source.to_string().contains("stage 3 waits for loss of contact"), "{source}");
    assert_eq!(summary.status, Status::Failed);
    let reader = Reader::open(&path).unwrap();
    assert_eq!(reader.rows().unwrap().last().unwrap().time(), 200.0);
    assert!(reader.work().message.as_ref().unwrap().contains("stage 3"));
}

#[test]
fn a_run_that_stops_in_a_stage_that_waits_for_an_area_resumes_to_the_same_event() {
    let dir = tempfile::tempdir().unwrap();
    let (whole, parts) = (dir.path().join("whole.zarr"), dir.path().join("parts.zarr"));
    let text = r#"
        domain = { cells = [48, 48], size = ["1 mm", "1 mm"] }
        surface = [{ kind = "sphere", radius = "10 mm" }]
        body = [{ poisson = 0.5, material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s" } }]
        time = { end = "4 s", steps = 40 }
        output.quantities = ["contact_perimeter"]
        [load]
        stages = [
            { control = "approach", history = { kind = "ramp", value = "8 um", duration = "4 s" }, until = { contact_fraction = 0.1 } },
            { control = "approach", history = { kind = "hold" } },
        ]
    "#;
    let case = Case::parse(text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    run(&case, &options(&whole), |_| {}).unwrap();
    let mut options = RunOptions { interrupt: Arc::new(AtomicBool::new(false)), ..options(&parts) };
    let flag = options.interrupt.clone();
    let summary = run(&case, &options, |progress| flag.store(progress.row.time() >= 0.7, Ordering::Relaxed));
    assert_eq!(summary.unwrap().status, Status::Interrupted);
    options.interrupt.store(false, Ordering::Relaxed);
    options.resume = true;
    assert_eq!(run(&case, &options, |_| {}).unwrap().status, Status::Complete);
    let [whole, parts] = [&whole, &parts].map(|path| Reader::open(path).unwrap().rows().unwrap());
    assert_eq!(parts, whole);
    // A sphere pressed in has the area pi R w whatever the material does: 10 % of 1 mm2 at 3.2 um, at 1.6 s. The area changes by
    // whole cells, so the event lies within the steps of the counted area there: 8 cells that are symmetric to each other, 3.5 % of it.
    let switch = whole.iter().position(|row| row.stage == 1).unwrap();
    let approach = 0.1 * 1e-6 / (std::f64::consts::PI * 10e-3);
    assert!((whole[switch].approach / approach - 1.0).abs() < 0.07, "{}", whole[switch].approach);
    assert!(whole[switch - 1].contact_fraction <= whole[switch].contact_fraction);
}
