//! `asperity stress` and what runs, checks and reports say of the stress below the surface.

use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use crate::asperity;

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The starter case on a coarse grid.
fn solved(directory: &Path) -> PathBuf {
    assert!(asperity(directory, &["new", "subsurface-stress"]).status.success());
    let run = asperity(
        directory,
        &["run", "subsurface-stress.toml", "-q", "--set", "domain.cells=[48, 48]", "-o", "s.zarr"],
    );
    assert!(run.status.success(), "{}", err(&run));
    assert!(out(&run).contains("first yield between"), "{}", out(&run));
    directory.join("s.zarr")
}

#[test]
fn the_stress_of_the_starter_case_is_that_of_hertz() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    solved(at);
    let shown = asperity(at, &["stress", "s.zarr"]);
    assert!(shown.status.success(), "{}", err(&shown));
    let text = out(&shown);
    for part in [
        "von Mises",
        "stressed volume",
        "orthogonal shear",
        "yield stress 1 GPa: first yield between",
        "hardness",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let object: Value = serde_json::from_str(&out(&asperity(at, &["stress", "s.zarr", "--json"]))).unwrap();
    let last = |key: &str| object[key].as_array().unwrap().last().unwrap().as_f64().unwrap();
    // p0 = 1.8606 GPa and a = 0.25329 mm of 250 N; 0.6200 p0 at 0.4809 a. 17 cells per radius: an error of 0.3 %, and
    // the place between depths.
    assert!((last("max_mises") / (0.62 * 1.8606e9) - 1.0).abs() < 0.01, "{}", last("max_mises"));
    assert!((last("max_mises_depth") / (0.4809 * 0.25329e-3) - 1.0).abs() < 0.05);
    assert!((last("orthogonal_shear") / (0.42778 * 1.8606e9) - 1.0).abs() < 0.01);
    // The ring of tension around the contact, (1 - 2 nu) p0/3, lies between cells of the surface: within a tenth.
    assert!((last("max_tension") / (0.4 / 3.0 * 1.8606e9) - 1.0).abs() < 0.15, "{}", last("max_tension"));
    // 0.62 p0 is 1 GPa at 163 N.
    let loads: Vec<f64> =
        object["first_yield"]["loads"].as_array().unwrap().iter().map(|w| w.as_f64().unwrap()).collect();
    assert!(loads[0] < 163.0 && loads[1] > 163.0, "{loads:?}");
    assert_eq!(object["findings"][0]["code"], "yield-exceeded");
    assert!(out(&asperity(at, &["show", "s.zarr"])).contains("largest von Mises"));
}

#[test]
fn options_compute_the_stress_again_and_keep_what_is_not_said() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    solved(at);
    let arguments =
        ["stress", "s.zarr", "--depths", "0,0.1 mm", "--times", "1 s", "--components", "zz", "--json"];
    let object: Value = serde_json::from_str(&out(&asperity(at, &arguments))).unwrap();
    assert_eq!(object["depths"], serde_json::json!([0.0, 1e-4]));
    assert_eq!(object["times"], serde_json::json!([1.0]));
    assert_eq!(object["yield_stress"], 1e9);
    assert!(at.join("s.zarr/stress_zz").exists());
    let other = ["stress", "s.zarr", "--poisson", "0.5", "--no-store", "--json"];
    let other: Value = serde_json::from_str(&out(&asperity(at, &other))).unwrap();
    assert_eq!(other["poisson"], 0.5);
    let again = asperity(at, &["stress", "s.zarr", "--yield-stress", "none", "--json"]);
    assert!(
        err(&again).contains("replaces the stored stress") && err(&again).contains("t = 1 s"),
        "{}",
        err(&again)
    );
    let object_again: Value = serde_json::from_str(&out(&again)).unwrap();
    assert_eq!((&object_again["yield_stress"], &object_again["times"]), (&Value::Null, &object["times"]));
    let all: Value = serde_json::from_str(&out(&asperity(
        at,
        &["stress", "s.zarr", "--times", "fields", "--no-store", "--json"],
    )))
    .unwrap();
    assert!(all["times"].as_array().unwrap().len() > 2, "{all}");
    let stored: Value = serde_json::from_str(&out(&asperity(at, &["stress", "s.zarr", "--json"]))).unwrap();
    assert_eq!((&stored["poisson"], &stored["depths"]), (&Value::from(0.3), &object["depths"]));
    for (arguments, told) in [
        (vec!["--depths", "1 um"], "a quarter of a cell"),
        (vec!["--depths", "5 kg"], "a length"),
        (vec!["--depths", "-1 um"], "not less than 0"),
        (vec!["--depths", "1e40"], "times the domain"),
        (vec!["--components", "mizes"], "did you mean \"mises\"?"),
        (vec!["--yield-stress", "-1 MPa"], "greater than 0"),
        (vec!["--rolling", "z"], "\"x\""),
        (vec!["--body", "bearing"], "\"plate\" (0) or \"ball\" (1)"),
        (vec!["--poisson", "0.6"], "0.6"),
        (vec!["--times", "soon"], "--times"),
        (vec!["--output", "a.vtk", "--no-store"], ".vti"),
        (vec!["--plot", "a.txt"], "svg"),
    ] {
        let given = [&["stress", "s.zarr"], arguments.as_slice()].concat();
        let output = asperity(at, &given);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", err(&output));
        assert!(err(&output).contains(told), "{arguments:?}: {}", err(&output));
    }
}

#[test]
fn pictures_volumes_and_the_page_show_the_stress() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    solved(at);
    let drawn = asperity(at, &["stress", "s.zarr", "--plot", "s.svg", "-o", "s.vti"]);
    assert!(drawn.status.success(), "{}", err(&drawn));
    let picture = std::fs::read_to_string(at.join("s.svg")).unwrap();
    for part in ["Section y =", "Section x =", "depth [", "von Mises stress [", "Largest at each depth"] {
        assert!(picture.contains(part), "{part}");
    }
    assert!(asperity(at, &["plot", "s.zarr", "stress", "--time", "0.5 s", "-o", "p.png"]).status.success());
    assert!(asperity(at, &["report", "s.zarr", "-o", "s.html"]).status.success());
    let page = std::fs::read_to_string(at.join("s.html")).unwrap();
    assert!(page.contains("\"svg\":\"") && page.contains("Largest von Mises stress"));
    let table = asperity(at, &["export", "s.zarr", "--to", "csv", "-o", "t.csv"]);
    assert!(table.status.success(), "{}", err(&table));
    let text = std::fs::read_to_string(at.join("t_field_time.csv")).unwrap();
    assert!(text.starts_with("field_time [s],field_step,max_mises [Pa],max_mises_depth [m]"), "{text}");
    let text = std::fs::read_to_string(at.join("t_mises_by_depth.csv")).unwrap();
    assert!(text.starts_with("field_time [s] / depth [m],0,"), "{text}");
    let volume = asperity(at, &["export", "s.zarr", "--to", "vtk", "-o", "t.pvd"]);
    assert!(err(&volume).contains("asperity stress RESULT -o"), "{}", err(&volume));
    let again = asperity(at, &["stress", "s.zarr", "-o", "s.vti"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(err(&again).contains("--force"));
}

#[test]
fn check_states_what_the_stress_takes() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    assert!(asperity(at, &["new", "subsurface-stress", "case.toml"]).status.success());
    let text = out(&asperity(at, &["check", "case.toml", "--set", "stress.components=[\"mises\"]"]));
    for part in [
        "stress",
        "of plate (Poisson's ratio 0.3)",
        "25 depths",
        "at 11 times",
        "stored at each depth: mises",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let object: Value = serde_json::from_str(&out(&asperity(at, &["check", "case.toml", "--json"]))).unwrap();
    assert_eq!(object["stress"]["depth_count"], 25);
    // A result without pressures has no stress.
    let bare = ["--set", "output.fields=[\"gap\"]", "--set", "domain.cells=[24,24]", "-q", "-o", "bare.zarr"];
    let case = std::fs::read_to_string(at.join("case.toml")).unwrap();
    std::fs::write(at.join("bare.toml"), case.split("[stress]").next().unwrap()).unwrap();
    assert!(asperity(at, &[&["run", "bare.toml"], &bare[..]].concat()).status.success());
    let refused = asperity(at, &["stress", "bare.zarr"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(err(&refused).contains("pressure"), "{}", err(&refused));
}
