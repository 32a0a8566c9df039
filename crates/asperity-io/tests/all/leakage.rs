//! The leakage of a run that stopped before it.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::Boundary;
use asperity::finding::{Finding, WINDOW_IN_LEAK};
use asperity::surface::Operation;
use asperity::surface::process::Window;
use asperity_io::answer::Units;
use asperity_io::case::Case;
use asperity_io::leakage::{Beside, LeakError, LeakHistory, compute};
use asperity_io::session::{RunError, RunOptions, run};
use asperity_io::store::{At, FieldKind, Reader, Status};
use asperity_io::topography::{Format, Topography, write};

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

/// A sealed, creeping seal whose inlet goes up and down.
const SEALED: &str = r#"
[domain]
cells = [48, 48]
size = ["0.2 mm", "0.2 mm"]
boundary = "periodic"
[[surface]]
kind = "self-affine"
rms_height = "0.5 um"
hurst = 0.8
longest = "0.1 mm"
shortest = "20 um"
seed = 3
[[body]]
poisson = 0.5
material = { model = "zener", shear = "3 MPa", shear_kelvin = "3 MPa", retardation_time = "1 s" }
[load]
control = "pressure"
history = { kind = "ramp", value = "0.25 MPa", duration = "2 s" }
[time]
end = "10 s"
steps = 10
[output]
every = 1
fields = ["gap", "pressure", "contact_pressure"]
[leakage]
viscosity = "1 mPa s"
inlet = { kind = "table", points = [["0 s", "1 bar"], ["5 s", "2 bar"], ["10 s", "1.5 bar"]] }
outlet = "1 bar"
coupling = "two-way"
pockets = "sealed"
bulk_modulus = "2 GPa"
"#;

#[test]
fn a_fluid_that_acts_on_the_surfaces_is_resumed_after_any_row_with_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let case = Case::parse(SEALED, Path::new("."), &[]).unwrap();
    let options = |name: &str| RunOptions {
        output: Some(directory.path().join(name)),
        interrupt: Arc::new(AtomicBool::new(false)),
        ..RunOptions::default()
    };
    let whole = run(&case, &options("whole.zarr"), |_| ()).unwrap();
    for row in 1..whole.rows {
        let parts = RunOptions { resume: row > 1, ..options("parts.zarr") };
        let stopped =
            run(&case, &parts, |progress| parts.interrupt.store(progress.done >= row, Ordering::Relaxed));
        assert_eq!(stopped.unwrap().status, Status::Interrupted, "{row}");
    }
    run(&case, &RunOptions { resume: true, ..options("parts.zarr") }, |_| ()).unwrap();
    let [whole, parts] =
        ["whole.zarr", "parts.zarr"].map(|name| Reader::open(&directory.path().join(name)).unwrap());
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    for series in whole.scalars() {
        let [a, b] = [&whole, &parts].map(|reader| bits(&reader.series(series.name).unwrap()));
        assert_eq!(a, b, "{}", series.name);
    }
    for index in 0..whole.field_times().len() {
        for field in [FieldKind::Gap, FieldKind::Pressure, FieldKind::ContactPressure] {
            let [a, b] = [&whole, &parts].map(|reader| reader.field(field, At::Index(index)).unwrap());
            assert_eq!(a, b, "{field:?} {index}");
        }
    }
}

#[test]
fn the_stored_gap_is_open_where_it_was_to_the_fluid() {
    let directory = tempfile::tempdir().unwrap();
    let case = Case::parse(SEALED, Path::new("."), &[]).unwrap();
    let output = Some(directory.path().join("sealed.zarr"));
    let summary = run(&case, &RunOptions { output, ..RunOptions::default() }, |_| ()).unwrap();
    let reader = Reader::open(&summary.result).unwrap();
    let leaks = LeakHistory::of(&reader).unwrap().unwrap();
    let pockets = reader.series("pocket_area").unwrap();
    assert_eq!(leaks.column("percolates"), reader.series("connected").unwrap());
    let trapped = leaks.column("trapped_area");
    assert!(trapped.iter().any(|area| *area > 0.0));
    // The same number of cells, in sums of another order.
    let same = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-12 * a.abs();
    assert!(trapped.iter().zip(&pockets).all(same), "{trapped:?} {pockets:?}");
}

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

/// Water between rough surfaces.
const WET: &str = r#"
[domain]
cells = [32, 32]
size = ["0.2 mm", "0.2 mm"]
boundary = "periodic"
[[surface]]
kind = "self-affine"
rms_height = "0.5 um"
hurst = 0.8
longest = "100 um"
shortest = "30 um"
seed = 1
[[body]]
poisson = 0.5
material = MATERIAL
[load]
control = "pressure"
history = { kind = "table", points = [["0 s", "HIGH"], ["1 s", "HIGH"], ["1 s", "LOW"]] }
[time]
end = "2 s"
steps = 4
[leakage]
viscosity = "1 mPa s"
inlet = "1.1 bar"
outlet = "1 bar"
coupling = "two-way"
KEYS
[output]
every = 1
fields = ["gap", "pressure", "contact"]
"#;

#[test]
fn beside_the_leak_stand_that_of_a_fluid_that_does_not_act_and_the_pressure_that_opens() {
    let directory = tempfile::tempdir().unwrap();
    let leaks = |name: &str, text: &str| {
        let case = Case::parse(text, Path::new("."), &[]).unwrap();
        let output = Some(directory.path().join(name));
        run(&case, &RunOptions { output, ..RunOptions::default() }, |_| ()).unwrap();
        let reader = Reader::open(&directory.path().join(name)).unwrap();
        LeakHistory::of(&reader).unwrap().unwrap().table
    };
    let of = |material: &str, keys: &str, [high, low]: [&str; 2]| {
        let text = WET.replace("MATERIAL", material).replace("KEYS", keys);
        text.replace("HIGH", high).replace("LOW", low)
    };
    let zener =
        "{ model = \"zener\", shear = \"3 MPa\", shear_kelvin = \"3 MPa\", retardation_time = \"1 s\" }";
    let two_way = leaks("two.zarr", &of(zener, "one_way = true", ["0.08 MPa", "0.05 MPa"]));
    let one_way = leaks("one.zarr", &of(zener, "", ["0.08 MPa", "0.05 MPa"]).replace("two-way", "one-way"));
    // The same run, with both rows of the jump.
    let [beside, alone] = [&two_way, &one_way].map(|table| table.get("leak_time").unwrap().to_vec());
    assert_eq!(beside, alone);
    assert_eq!(beside.iter().filter(|time| **time == 1.0).count(), 2, "{beside:?}");
    let [beside, alone] = [(&two_way, "leak_rate_one_way"), (&one_way, "leak_rate")]
        .map(|(table, name)| table.get(name).unwrap().to_vec());
    assert_eq!(beside, alone);
    assert!(beside.iter().any(|rate| *rate > 0.0), "{beside:?}");
    let own = two_way.get("leak_rate").unwrap();
    assert!(own.iter().zip(&alone).all(|(own, alone)| own >= alone), "{own:?} {alone:?}");

    // What opens an elastic contact does not depend on whether the fluid acts on it.
    let elastic = "{ model = \"elastic\", shear = \"3 MPa\" }";
    let acting = leaks("acting.zarr", &of(elastic, "opening = true", ["0.9 MPa", "0.6 MPa"]));
    let text = of(elastic, "opening = true", ["0.9 MPa", "0.6 MPa"]).replace("two-way", "one-way");
    let resting = leaks("resting.zarr", &text);
    let [acting, resting] = [acting, resting].map(|table| table.get("opening_pressure").unwrap().to_vec());
    for (acting, resting) in acting.iter().zip(&resting) {
        // Each is known to 1e-3, and the gap from which the first one begins to the tolerance of the loop.
        assert!(((acting - 1e5) / (resting - 1e5) - 1.0).abs() < 5e-3, "{acting} {resting}");
    }
    assert!(resting[0] > resting[4] && resting[4] > 1e5, "{resting:?}");
    // A later leakage of the same flow keeps it, one of another fluid does not.
    let path = directory.path().join("resting.zarr");
    let settings = asperity_io::leakage::settings(&Reader::open(&path).unwrap()).unwrap();
    let again = |keys: &str| {
        let leak = settings.changed(serde_json::from_str(keys).unwrap(), Boundary::Periodic).unwrap();
        let stop = AtomicBool::new(false);
        asperity_io::leakage::store(&path, &leak, Beside::default(), &stop, |_, _| ()).unwrap().table
    };
    assert_eq!(again("{\"field\": true}").get("opening_pressure").unwrap(), resting);
    assert_eq!(again("{\"viscosity\": 2.0}").get("opening_pressure"), None);
}

/// A groove 0.1 mm wide and 8 um deep across a flat patch of 0.2 mm.
fn groove(directory: &Path, name: &str, history: &[&str]) {
    let heights =
        ndarray::Array2::from_shape_fn((16, 16), |(_, j)| if (4..12).contains(&j) { -8e-6 } else { 0.0 });
    let (format, size) = (Format::Npz, [2e-4, 2e-4]);
    let mut map = Topography { format, heights, size, channel: None, channels: vec![], metadata: vec![] };
    map.record(history.iter().map(|step| (*step).to_owned()));
    write(&directory.join(name), &map, format).unwrap();
}

const GROOVE: &str = r#"
[domain]
boundary = "periodic"
[[surface]]
kind = "file"
path = "groove.npz"
level = "none"
BORDER
[[body]]
poisson = 0.5
material = { model = "elastic", young = "4.8 MPa" }
[load]
control = "pressure"
history = { kind = "step", value = "0.1 MPa" }
[time]
end = "1 s"
steps = 1
[leakage]
pressure_drop = "1 kPa"
viscosity = "1 mPa s"
"#;

/// A window closes the groove, which is said before the run, with the answer, in the result and when the leak is computed again; the
/// mirrored patch leaks, and nothing is said.
#[test]
fn a_leak_through_a_window_is_told_wherever_it_is_seen() {
    let directory = tempfile::tempdir().unwrap();
    let tukey = Operation::Window(Window::Tukey { share: 0.1 }).to_string();
    groove(directory.path(), "groove.npz", &[]);
    groove(directory.path(), "windowed.npz", &[&tukey]);
    let told = |findings: &[Finding]| findings.iter().filter(|found| found.code == WINDOW_IN_LEAK).count();
    for (name, border, windowed) in
        [("window", "window = { shape = \"hann\" }", true), ("mirror", "border = \"mirror\"", false)]
    {
        let case = Case::parse(&GROOVE.replace("BORDER", border), directory.path(), &[]).unwrap();
        let count = usize::from(windowed);
        assert_eq!((told(&case.findings), told(&case.examine().unwrap().findings)), (count, count));
        let path = directory.path().join(name);
        let done =
            run(&case, &RunOptions { output: Some(path.clone()), ..RunOptions::default() }, |_| ()).unwrap();
        let reader = Reader::open(&path).unwrap();
        let stored = LeakHistory::of(&reader).unwrap().unwrap();
        assert_eq!([told(&done.findings), told(reader.findings()), told(&stored.findings)], [count; 3]);
        assert_eq!(stored.last("percolates") == 0.0, windowed);
        assert_eq!(stored.last("leak_resolved") == 0.0, windowed);
        assert_eq!(stored.sentence(&Units::default()).contains("not valid"), windowed);
        let again = compute(&reader, &stored.leak, &AtomicBool::new(false), |_, _| ()).unwrap();
        assert_eq!(told(&again.findings), count);
    }
    // A file that says that it was windowed; without a leak there is nothing to say.
    let told_of = |text: &str| told(&Case::parse(text, directory.path(), &[]).unwrap().findings);
    let text = GROOVE.replace("BORDER", "").replace("groove.npz", "windowed.npz");
    assert_eq!((told_of(&text), told_of(text.split("[leakage]").next().unwrap())), (1, 0));
}
