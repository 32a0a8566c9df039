//! Contacts in motion in case files: what is refused.

use std::path::Path;

use asperity_io::case::Case;

use crate::wording;

const ROLLER: &str = r#"[domain]
cells = [64]
size = ["2 mm"]
[[surface]]
kind = "cylinder"
radius = "5 mm"
[[body]]
name = "rubber"
poisson = 0.5
material = { model = "zener", shear = "10 MPa", shear_kelvin = "1 MPa", retardation_time = "10 ms" }
[[body]]
name = "belt"
poisson = 0.5
material = { model = "zener", shear = "20 MPa", shear_kelvin = "2 MPa", retardation_time = "1 s" }
[load]
control = "load"
history = { kind = "step", value = "100 N/m" }
[motion]
over = "rubber"
[motion.steady]
velocities = ["1 mm/s", "1 m/s"]
"#;

/// Replaces `old` by `new`; the first error has the key, the code and the numbers.
#[track_caller]
fn says(old: &str, new: &str, key: &str, code: &str, numbers: &[&str]) {
    assert!(ROLLER.contains(old), "{old:?} is not in the case");
    let errors = Case::parse(&ROLLER.replacen(old, new, 1), Path::new("."), &[]).expect_err("it is refused");
    let shown: Vec<String> = errors.errors.iter().map(ToString::to_string).collect();
    assert_eq!(errors.errors[0].key, key, "{shown:?}");
    assert_eq!(errors.errors[0].code.to_string(), code, "{shown:?}");
    for number in numbers {
        assert!(shown[0].contains(number), "{:?} lacks {number:?}", shown[0]);
    }
    wording::check(new, Path::new("."), &errors.errors[0]);
}

#[test]
fn the_body_that_stands_still_in_the_frame_has_relaxed() {
    let case = Case::parse(ROLLER, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    // C = 1/(4 G) where incompressible: that of the rubber at once, and that of the belt relaxed.
    let expected = 1.0 / 40e6 + 1.0 / 80e6 + 1.0 / 8e6;
    assert!(
        (case.conditions.creep.instantaneous / expected - 1.0).abs() < 1e-14,
        "{:?}",
        case.conditions.creep
    );
    assert_eq!(case.conditions.creep.terms.len(), 1);
}

#[test]
fn the_length_of_a_step_is_limited_at_its_key() {
    let steady = "[motion.steady]\nvelocities = [\"1 mm/s\", \"1 m/s\"]\n";
    let in_time = "velocity = \"1 mm/s\"\ncells_per_step = 9\n[time]\nend = \"1 s\"\nsteps = 2\n";
    says(steady, in_time, "motion.cells_per_step", "out-of-range", &["9", "at most 8"]);
}

#[test]
fn a_date_is_named_where_a_table_belongs() {
    says(
        "history = { kind = \"step\", value = \"100 N/m\" }",
        "history = 1979-05-27",
        "load.history",
        "wrong-type",
        &["1979-05-27"],
    );
    says("[\"1 mm/s\", \"1 m/s\"]", "1979-05-27", "motion.steady.velocities", "wrong-type", &["1979-05-27"]);
}

#[test]
fn what_is_wrong_with_a_motion_is_named() {
    says("\"belt\"", "\"rubber\"", "motion.over", "conflict", &[]);
    says("over = \"rubber\"", "over = \"road\"", "motion.over", "out-of-range", &[]);
    says(
        "{ model = \"zener\", shear = \"20 MPa\", shear_kelvin = \"2 MPa\", retardation_time = \"1 s\" }",
        "{ model = \"maxwell\", shear = \"20 MPa\", relaxation_time = \"1 s\" }",
        "body[1]",
        "conflict",
        &[],
    );
}

#[test]
fn what_does_not_go_with_a_moving_contact_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("map.txt"), "1e6 1e6 1e6 1e6\n".repeat(4)).unwrap();
    let case = |boundary: &str, slider: &str, rest: &str| {
        let body = "poisson = 0.5, material = { model = \"elastic\", shear = \"1 MPa\" }";
        let text = format!(
            r#"domain = {{ cells = [4, 4], size = ["1 mm", "1 mm"], boundary = "{boundary}" }}
surface = [{{ kind = "sphere", radius = "5 mm" }}]
body = [{{ {body} }}, {{ {body}{slider} }}]
load = {{ control = "load", history = {{ kind = "step", value = "1 mN" }} }}
time = {{ end = "1 s", steps = 2 }}
motion = {{ velocity = "0.1 mm/s" }}
{rest}"#
        );
        Case::parse(&text, directory.path(), &[]).map_err(|errors| errors.errors[0].key.clone())
    };
    let leak =
        |more: &str| format!("leakage = {{ viscosity = \"1 mPa s\", pressure_drop = \"1 bar\"{more} }}");
    let slow = case("periodic", "", &leak("")).unwrap();
    assert!(slow.findings.iter().any(|finding| finding.code == "leak-in-motion"), "{:?}", slow.findings);
    assert_eq!(case("free", "", &leak("")).unwrap_err(), "leakage");
    assert_eq!(case("periodic", "", &leak(", opening = true")).unwrap_err(), "leakage.opening");
    let map = ", hardness_file = { path = \"map.txt\" }";
    assert_eq!(case("periodic", map, "").unwrap_err(), "body[1].hardness_file");
}
