//! What is computed from the fields of steady states of motion: leak and stress over the velocity.

use std::path::Path;

use asperity::Axis;
use asperity_io::answer::{self, Units};
use asperity_io::case::Case;
use asperity_io::leakage::LeakHistory;
use asperity_io::session::{RunOptions, run};
use asperity_io::store::{At, FieldKind, Reader};
use asperity_io::stress::Below;

const CASE: &str = r#"
[domain]
cells = [32, 32]
size = ["100 um", "100 um"]
boundary = "periodic"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_height = "0.4 um"
longest = "50 um"
shortest = "12 um"
seed = 3
[[body]]
name = "a"
poisson = 0.45
material = { model = "zener", shear = "5 MPa", shear_kelvin = "2 MPa", retardation_time = "10 s" }
[load]
control = "pressure"
history = { kind = "step", value = "0.1 MPa" }
[motion.steady]
velocities = ["0.1 um/s", "10 um/s"]
[leakage]
viscosity = "1 mPa s"
pressure_drop = "1 kPa"
[stress]
yield_stress = "0.7 MPa"
"#;

fn stored(directory: &Path) -> Reader {
    let case = Case::parse(CASE, Path::new("."), &[]).unwrap();
    let output = directory.join("steady.zarr");
    run(&case, &RunOptions { output: Some(output.clone()), ..RunOptions::default() }, |_| ()).unwrap();
    Reader::open(&output).unwrap()
}

#[test]
fn leak_and_stress_of_steady_states_are_those_of_each_stored_velocity() {
    let directory = tempfile::tempdir().unwrap();
    let reader = stored(directory.path());
    let leaks = LeakHistory::of(&reader).unwrap().unwrap();
    assert_eq!(leaks.table.axis, Axis::Velocity);
    assert_eq!(leaks.column("leak_time"), [1e-7, 1e-5]);
    assert_eq!(reader.leak("leak_velocity").unwrap(), [1e-7, 1e-5]);
    let names: Vec<&str> = leaks.table.series().iter().map(|series| series.name).collect();
    assert!(names.contains(&"leak_velocity") && !names.contains(&"leak_time"), "{names:?}");
    for (n, rate) in leaks.column("leak_rate").iter().enumerate() {
        let gap = reader.field(FieldKind::Gap, At::Index(n)).unwrap();
        let contact = reader.contact_states(At::Index(n)).unwrap();
        let own = leaks.leak.of_gap(&reader.header().grid, gap.view(), Some(contact.view()), 0.0).unwrap();
        assert_eq!(Some(*rate), own.leak_rate);
    }
    let below = Below::of(&reader).unwrap().unwrap();
    assert_eq!((below.axis, below.instants.len()), (Axis::Velocity, 2));
    let answers = answer::of(&reader, &Units::default()).unwrap();
    let note = |name: &str| {
        let answer = answers.iter().find(|answer| answer.name == name);
        answer.map(|answer| answer.note.clone())
    };
    assert!(note("leak_rate").unwrap().starts_with("at v = 10 µm/s; "), "{:?}", note("leak_rate"));
    assert!(note("max_mises").unwrap().ends_with("velocities, at 10 µm/s"), "{:?}", note("max_mises"));
    // The load is the same at all velocities, and a sweep has no time from which on it is tight.
    assert_eq!((note("first_yield_load"), note("tight_from")), (None, None));
    assert!(reader.findings().iter().any(|finding| finding.code == "leak-in-motion"));
}

#[test]
fn times_of_leaks_and_stress_are_refused_over_velocities() {
    for (section, key) in [("[leakage]", "leakage"), ("[stress]", "stress")] {
        let text = CASE.replace(section, &format!("{section}\ntimes = [\"1 s\"]"));
        let refused = Case::parse(&text, Path::new("."), &[]).err().unwrap().to_string();
        assert!(refused.contains(&format!("{key}.times")) || refused.contains("steady states"), "{refused}");
    }
}
