//! Answers first, their units and their errors.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const CASE: &str = r#"
[domain]
cells = [48, 48]
size = ["1 mm", "1 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 day" }
[load]
control = "load"
history = { kind = "step", value = "10 mN" }
[time]
end = "2 day"
steps = 8
"#;

fn asperity(arguments: &[&str], directory: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(directory).output().unwrap()
}

#[track_caller]
fn done(arguments: &[&str], directory: &Path) -> String {
    let output = asperity(arguments, directory);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn object(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn answers_come_first_in_the_units_wanted() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    std::fs::write(directory.join("ball.toml"), CASE).unwrap();
    let told = done(&["run", "ball.toml", "--quiet", "--unit", "time=h"], directory);
    assert!(told.starts_with("contact area "), "{told}");
    assert!(told.contains("t = 48 h, the last of 9, under 10 mN"), "{told}");
    // The unit is kept in the result, another one can be asked for.
    assert!(done(&["show", "ball.zarr"], directory).contains("t = 48 h"));
    assert!(done(&["show", "ball.zarr", "--unit", "time=day"], directory).contains("t = 2 day"));
    let plot = ["plot", "ball.zarr", "evolution", "--unit", "time=min", "-o", "a.svg"];
    done(&plot, directory);
    assert!(std::fs::read_to_string(directory.join("a.svg")).unwrap().contains("time [min]"));
    let json = done(&["run", "ball.toml", "--quiet", "--force", "--json"], directory);
    assert!(json.starts_with("{\"answers\":[{\"name\":\"contact_area\",\"value\":"), "{json}");
    let answers = &object(&json)["answers"];
    let value = |name: &str| {
        answers.as_array().unwrap().iter().find(|a| a["name"] == name).unwrap()["value"].as_f64().unwrap()
    };
    // The approach creeps from that of C(0) by the power 2/3 of the compliance, 1 + 1 - e^-2 times as large.
    let creep = 1.0 - (2.0 - (-2.0_f64).exp()).powf(-2.0 / 3.0);
    // Steps of a quarter of the retardation time.
    assert!((value("creep") / value("approach") / creep - 1.0).abs() < 5e-3, "{answers}");
    for (option, words) in
        [("leak=mm", "no unit of a leak"), ("area=mm^2", "leak or time"), ("hours", "--unit")]
    {
        let refused = asperity(&["show", "ball.zarr", "--unit", option], directory);
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(refused.status.code() == Some(2) && told.contains(words), "{told}");
    }
    // A second unit for the same, and a unit of what the result does not have.
    for command in [&["show", "ball.zarr"][..], &["run", "ball.toml", "--force"], &["converge", "ball.toml"]]
    {
        let twice = [command, &["--unit", "time=h", "--unit", "time = day"]].concat();
        let refused = asperity(&twice, directory);
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(refused.status.code() == Some(2) && told.contains("time has the unit h already"), "{told}");
    }
    let plot = ["plot", "ball.zarr", "evolution", "--force", "-o", "a.svg"];
    let run = ["run", "ball.toml", "--force", "--json"];
    for command in [&["show", "ball.zarr"][..], &["compare", "ball.zarr", "ball.zarr"], &plot, &run] {
        let idle = asperity(&[command, &["--unit", "leak=ml/year", "--unit", "time=h"]].concat(), directory);
        let told = String::from_utf8_lossy(&idle.stderr).into_owned();
        assert!(
            idle.status.success() && told.contains("note: --unit leak=ml/year changes nothing"),
            "{told}"
        );
        assert!(!told.contains("time=h changes nothing"), "{told}");
    }
    let refused = asperity(&["check", "ball.toml", "--set", "output.units.time=m"], directory);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && told.contains("output.units.time"), "{told}");
    // A map that is not stored at the time asked for.
    let near = asperity(&["show", "ball.zarr", "--time", "25 h"], directory);
    let told = String::from_utf8_lossy(&near.stderr).into_owned();
    assert!(told.contains("no map is stored at t = 25 h; this is the nearest one, at t = 24 h"), "{told}");
}

#[test]
fn errors_of_answers_are_printed_and_stored() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    std::fs::write(directory.join("ball.toml"), CASE).unwrap();
    let found = object(&done(&["converge", "ball.toml", "--quiet", "--json"], directory));
    let bars = found["answers"].as_array().unwrap();
    for key in ["name", "value", "unit", "error", "grid", "time", "solver"] {
        assert!(bars.iter().all(|bar| bar.get(key).is_some_and(|value| !value.is_null())), "{key}: {found}");
    }
    assert!(found["cost"].as_f64().unwrap() < 1.0, "{found}");
    let told = done(&["run", "ball.toml", "--quiet", "--error-bars"], directory);
    assert!(told.contains(" ± ") && told.contains("(grid "), "{told}");
    let attributes: Value = object(&std::fs::read_to_string(directory.join("ball.zarr/zarr.json")).unwrap());
    let stored = attributes["attributes"]["error_bars"].as_array().unwrap();
    assert_eq!((stored.len(), &stored[0]), (bars.len(), &bars[0]));
    // An answer and its error stand in one line, once.
    let shown = done(&["show", "ball.zarr"], directory);
    let areas: Vec<&str> = shown.lines().filter(|line| line.starts_with("contact area  ")).collect();
    assert!(areas.len() == 1 && areas[0].contains(" ± ") && areas[0].contains("(grid "), "{shown}");
    // It says of which row.
    let told = done(&["converge", "ball.toml", "--quiet"], directory);
    assert!(told.contains("t = 2 d, the last of 9, under 10 mN"), "{told}");
    done(&["verify-result", "ball.zarr"], directory);
    // Other formats take the list as a text.
    done(&["export", "ball.zarr", "--to", "netcdf"], directory);
    done(&["report", "ball.zarr"], directory);
    assert!(std::fs::read_to_string(directory.join("ball.html")).unwrap().contains(" ± "));
    assert!(
        done(&["check", "ball.toml"], directory).contains("--error-bars takes about 0.7 times the run more")
    );
}
