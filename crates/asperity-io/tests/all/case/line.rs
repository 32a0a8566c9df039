//! Line contacts: one value in `cells` and `size`, loads per length, and what is refused on a line.

use std::path::Path;

use asperity::quantities::RowNumber;
use asperity::{Control, Event, Grid};
use asperity_io::Code;
use asperity_io::case::{Case, CaseError};

const GOOD: &str = r#"
[domain]
cells = [64]
size = ["2 mm"]
[[surface]]
kind = "cylinder"
radius = "10 mm"
[[body]]
poisson = 0.5
material = { model = "elastic", young = "100 MPa" }
[load]
control = "load"
history = { kind = "ramp", value = "2 N/mm", duration = "1 s" }
[time]
end = "1 s"
steps = 2
"#;

fn case(text: &str) -> Case {
    Case::parse(text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn edited(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    GOOD.replace(from, to)
}

fn fault(text: &str) -> CaseError {
    let errors =
        Case::parse(text, Path::new("."), &[]).err().unwrap_or_else(|| panic!("accepted:\n{text}")).errors;
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.into_iter().next().unwrap()
}

#[test]
fn one_value_in_cells_and_size_is_a_line() {
    let case = case(GOOD);
    assert_eq!(case.conditions.grid, Grid::line(64, 2e-3).unwrap());
    let simulation = case.simulation().unwrap();
    assert_eq!(simulation.gap.dim(), (64, 1));
    // A cell beside the middle: x^2 / 2 R, less the least, which is there.
    assert_eq!(simulation.gap[(31, 0)], 0.0);
    let description = case.describe();
    assert_eq!((description.cells, description.size), (vec![64], vec![2e-3]));
}

#[test]
fn loads_are_per_length_in_every_place() {
    let largest = |text: &str| case(text).conditions.loading.stages[0].course.resolve(0.0).range(1.0)[1];
    for (history, newtons_per_metre) in [
        ("{ kind = \"step\", value = \"2 N/mm\" }", 2000.0),
        ("{ kind = \"step\", value = \"3 kN/m\" }", 3000.0),
        ("{ kind = \"step\", value = 7 }", 7.0),
        ("{ kind = \"triangle\", peak = \"2 N/mm\", rise = \"0.5 s\", fall = \"0.5 s\" }", 2000.0),
        ("{ kind = \"table\", points = [[\"0 s\", \"0 N/m\"], [\"1 s\", \"5 mN/um\"]] }", 5000.0),
    ] {
        let text = edited("{ kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }", history);
        assert_eq!(largest(&text), newtons_per_metre, "{history}");
    }
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("load.csv"), "time [s], load [N/mm]\n0, 0\n1, 4\n").unwrap();
    let text = edited(
        "{ kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }",
        "{ kind = \"file\", path = \"load.csv\" }",
    );
    let case = Case::parse(&text, directory.path(), &[]).unwrap();
    assert_eq!(case.conditions.loading.stages[0].course.resolve(0.0).range(1.0)[1], 4000.0);
    let stages = edited(
        "control = \"load\"\nhistory = { kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }",
        "stages = [{ control = \"load\", history = { kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }, until = { load = \"1 N/mm\" } }]",
    );
    let case = self::case(&stages);
    assert_eq!(case.conditions.loading.stages[0].until, Some(Event::Load(1000.0)));
    assert_eq!(case.conditions.loading.stages[0].control, Control::Load);
}

#[test]
fn a_load_of_the_wrong_kind_names_the_right_one() {
    let error = fault(&edited("\"2 N/mm\"", "\"2 N\""));
    assert_eq!((error.key.as_str(), error.line), ("load.history.value", Some(13)));
    assert!(error.expected.contains("a force per length"), "{error:?}");
    assert!(error.help.as_deref().is_some_and(|help| help.contains("the load is per length")), "{error:?}");

    let plane = GOOD.replace("[64]", "[64, 64]").replace("[\"2 mm\"]", "[\"2 mm\", \"2 mm\"]");
    let error = fault(&plane);
    assert!(error.expected.starts_with("a force not less than 0"), "{error:?}");
    assert!(error.help.as_deref().is_some_and(|help| help.contains("for a line contact")), "{error:?}");

    let until = edited(
        "control = \"load\"\nhistory = { kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }",
        "stages = [{ control = \"load\", history = { kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }, until = { load = \"1 N\" } }]",
    );
    let error = fault(&until);
    assert_eq!(error.key, "load.stages[0].until.load");
}

#[test]
fn a_stage_of_a_line_contact_waits_for_numbers_in_its_units() {
    // An area is a length, a perimeter a number of ends; the domain is 2 mm long.
    let waits = |until: &str| {
        edited(
            "control = \"load\"\nhistory = { kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }",
            &format!(
                "stages = [{{ control = \"load\", history = {{ kind = \"ramp\", value = \"2 N/mm\", duration = \"1 s\" }}, until = {{ {until} }} }}]"
            ),
        )
    };
    for (until, name, value) in [
        ("contact_area = \"0.1 mm\"", "contact_area", 1e-4),
        ("contact_perimeter = 4", "contact_perimeter", 4.0),
        ("max_pressure = \"1 MPa\"", "max_pressure", 1e6),
    ] {
        let number = RowNumber::from_name(name).unwrap();
        let stages = case(&waits(until)).conditions.loading.stages;
        assert_eq!(stages[0].until, Some(Event::Number(number, value)));
    }
    for (until, code) in [
        ("contact_area = \"0.1 mm2\"", Code::WrongUnit),
        ("contact_area = \"3 mm\"", Code::OutOfRange),
        ("contact_perimeter = \"4 mm\"", Code::WrongUnit),
    ] {
        let error = fault(&waits(until));
        let key = until.split(' ').next().unwrap();
        assert_eq!((error.key, error.code), (format!("load.stages[0].until.{key}"), code), "{until}");
    }
}

#[test]
fn lists_have_one_value_on_a_line_and_two_on_a_plane() {
    let table = [
        ("size = [\"2 mm\"]", "size = [\"2 mm\", \"2 mm\"]", "domain.size", "one value"),
        ("cells = [64]", "cells = [64, 64]", "domain.size", "two values"),
        ("cells = [64]", "cells = [64, 64, 64]", "domain.cells", "two values"),
        ("cells = [64]", "cells = []", "domain.cells", "two values"),
        (
            "radius = \"10 mm\"",
            "radius = \"10 mm\"\ncenter = [\"0 mm\", \"0 mm\"]",
            "surface[0].center",
            "one value",
        ),
        (
            "kind = \"cylinder\"\nradius = \"10 mm\"",
            "kind = \"wave\"\namplitude = \"1 um\"\nwavelength = [\"1 mm\", \"1 mm\"]",
            "surface[0].wavelength",
            "one value",
        ),
        (
            "kind = \"cylinder\"\nradius = \"10 mm\"",
            "kind = \"flat-punch\"\nsize = [\"1 mm\", \"1 mm\"]",
            "surface[0].size",
            "one value",
        ),
    ];
    for (from, to, key, words) in table {
        // Two numbers of cells make a plane, whose load is a force.
        let text = edited(from, to);
        let text = if to == "cells = [64, 64]" { text.replace("N/mm", "N") } else { text };
        let error = fault(&text);
        assert_eq!(error.key, key, "{to}: {error:?}");
        assert!(error.expected.contains(words), "{to}: {error:?}");
        assert!(error.line.is_some());
    }
    for shape in [
        "kind = \"wedge\"\nslope = 0.1",
        "kind = \"flat-punch\"\nsize = [\"1 mm\"]\ncenter = [\"0.1 mm\"]",
        "kind = \"flat-punch\"\nradius = \"0.5 mm\"",
        "kind = \"wave\"\namplitude = \"1 um\"\nwavelength = [\"0.5 mm\"]",
        "kind = \"self-affine\"\nhurst = 0.8\nrms_height = \"1 um\"\nlongest = \"1 mm\"\nshortest = \"0.2 mm\"\nseed = 1",
    ] {
        let case = case(&edited("kind = \"cylinder\"\nradius = \"10 mm\"", shape));
        assert!(case.simulation().is_ok(), "{shape}");
    }
    // A cylinder and a wedge are straight along y on a plane too.
    let plane = edited("\"2 N/mm\"", "\"2 N\"")
        .replace("[64]", "[64, 32]")
        .replace("[\"2 mm\"]", "[\"2 mm\", \"1 mm\"]");
    let gap = case(&plane).gap().unwrap();
    assert!((0..64).all(|i| (0..32).all(|j| gap[(i, j)] == gap[(i, 0)])) && gap[(0, 0)] > 0.0);
}

#[test]
fn what_a_line_contact_cannot_do_is_refused_where_it_stands() {
    let table = [
        ("kind = \"cylinder\"", "kind = \"sphere\"", "surface[0]", "straight along y"),
        (
            "[time]",
            "[leakage]\npressure_drop = \"1 bar\"\nviscosity = \"1 mPa s\"\n[time]",
            "leakage",
            "plane",
        ),
        ("[time]", "[stress]\nrolling = \"y\"\n[time]", "stress.rolling", "along x"),
        (
            "[time]",
            "[output]\nquantities = [\"external_work\"]\n[time]",
            "output.quantities[0]",
            "does not depend on displacements",
        ),
    ];
    for (from, to, key, words) in table {
        let error = fault(&edited(from, to));
        assert_eq!(error.key, key, "{error:?}");
        assert!(error.message.contains(words), "{error:?}");
    }
    // A free line contact has no approach to prescribe; a periodic one has.
    let approach = GOOD.replace("control = \"load\"", "control = \"approach\"").replace("2 N/mm", "2 um");
    assert_eq!(fault(&approach).key, "load.control");
    let periodic = approach.replace("size = [\"2 mm\"]", "size = [\"2 mm\"]\nboundary = \"periodic\"");
    assert!(case(&periodic).simulation().is_ok());
}

#[test]
fn a_profile_from_a_file_gives_cells_and_size() {
    let directory = tempfile::tempdir().unwrap();
    // A round of radius 10 mm with a ripple, as a stylus file.
    let rows: String = (0..200)
        .map(|i| {
            let x = (f64::from(i) - 99.5) * 10e-6;
            let ripple = 1e-6 * (std::f64::consts::TAU * f64::from(i) / 20.0).cos();
            format!("{:.3}, {:.9}\n", 10.0 * f64::from(i), 1e6 * (-0.5 * x * x / 10e-3 + ripple))
        })
        .collect();
    let file = format!("META\nLateral um, Total Profile um\n{rows}");
    std::fs::write(directory.path().join("roller.csv"), file).unwrap();
    let text = edited("cells = [64]\nsize = [\"2 mm\"]\n", "boundary = \"periodic\"\n").replace(
        "kind = \"cylinder\"\nradius = \"10 mm\"",
        "kind = \"file\"\npath = \"roller.csv\"\ncircle = {}",
    );
    let case = Case::parse(&text, directory.path(), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(case.conditions.grid.cells(), [200, 1]);
    assert!(case.conditions.grid.is_line() && (case.conditions.grid.size()[0] / 2e-3 - 1.0).abs() < 1e-9);
    let gap = case.gap().unwrap();
    // The round is gone, the ripple left: from 0 to 2 um, up to what the circle takes of the ripple (a hundredth).
    let highest = gap.iter().copied().fold(0.0, f64::max);
    assert!((highest / 2e-6 - 1.0).abs() < 0.03, "{highest:e}");
    let history = case.describe().preparation[0].steps.join("; ");
    assert!(history.contains("subtract a circle of radius"), "{history}");

    // On a plane a profile is refused, with words; a size of two values too.
    let plane = text.replace("boundary = \"periodic\"", "cells = [200, 200]\nsize = [\"2 mm\", \"2 mm\"]");
    let plane = plane.replace("2 N/mm", "2 N").replace("\ncircle = {}", "");
    let message = Case::parse(&plane, directory.path(), &[]).unwrap().gap().unwrap_err().to_string();
    assert!(message.contains("holds a profile"), "{message}");
    let sized = text.replace("circle = {}", "size = [\"2 mm\", \"2 mm\"]");
    let errors = Case::parse(&sized, directory.path(), &[]).unwrap_err();
    assert!(errors.errors[0].message.contains("one value"), "{errors}");
}
