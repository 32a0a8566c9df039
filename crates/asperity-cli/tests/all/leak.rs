//! `asperity leak` and `[leakage]`.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn asperity(arguments: &[&str], directory: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.args(arguments).current_dir(directory).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[track_caller]
fn data(arguments: &[&str], directory: &Path) -> Value {
    let done = asperity(arguments, directory);
    assert!(done.status.success(), "{arguments:?}: {}", text(&done.stderr));
    serde_json::from_slice(&done.stdout).unwrap()
}

#[track_caller]
fn refused(arguments: &[&str], directory: &Path, words: &[&str]) {
    let done = asperity(arguments, directory);
    let told = text(&done.stderr);
    assert_eq!(done.status.code(), Some(2), "{arguments:?}: {told}");
    words.iter().for_each(|word| assert!(told.contains(word), "{arguments:?}: {told}"));
}

/// A map of 16 x 4 cells: a wave along x, the gap from 0.5 to 1.5 um.
fn map(directory: &Path) {
    let line = |i: usize| 1.0 + 0.5 * (std::f64::consts::TAU * (i as f64 + 0.5) / 16.0).cos();
    // Lines of a text file run along x.
    let row: Vec<String> = (0..16).map(|i| format!("{}", line(i))).collect();
    let rows = vec![row.join(" "); 4].join("\n");
    std::fs::write(directory.join("gap.txt"), rows + "\n").unwrap();
}

#[test]
fn a_map_of_the_gap_leaks_as_its_closed_form() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    map(directory);
    let of_map = ["leak", "--gap", "gap.txt", "--size", "160 um,40 um", "--height-unit", "um", "--json"];
    let told =
        data(&[&of_map[..], &["--pressure-drop", "2 bar", "--viscosity", "1 mPa s"]].concat(), directory);
    // (1 - e^2)^(5/2)/(1 + e^2/2) with e = 1/2; 16 cells over the period leave 1e-3 at most.
    let transmissivity = told["hydraulic_gap"].as_f64().unwrap().powi(3);
    assert!((transmissivity / 0.433_012_701_892e-18 - 1.0).abs() < 2e-3, "{told}");
    let rate = told["leak_rate"].as_f64().unwrap();
    assert!((rate / (transmissivity * 2e5 * 0.25 / 12e-3) - 1.0).abs() < 1e-12, "{told}");
    // Along the waves: the mean of the cubes, 1 + 3 e^2/2.
    let along = data(&[&of_map[..], &["--direction", "y"]].concat(), directory);
    let transmissivity = along["hydraulic_gap"].as_f64().unwrap().powi(3);
    assert!((transmissivity / 1.375e-18 - 1.0).abs() < 1e-12 && along["leak_rate"].is_null(), "{along}");
    let gas = ["--gas", "helium", "--inlet", "2 bar", "--outlet", "1 bar", "--plot", "flow.svg"];
    let gas = data(&[&of_map[..], &gas].concat(), directory);
    // At the constriction of 0.5 um helium is rarefied: more than the continuum's.
    let continuum =
        ["--gas", "helium", "--inlet", "2 bar", "--outlet", "1 bar", "--rarefaction", "continuum"];
    let continuum = data(&[&of_map[..], &continuum].concat(), directory);
    let ratio = gas["leak_rate"].as_f64().unwrap() / continuum["leak_rate"].as_f64().unwrap();
    assert!((1.5..4.0).contains(&ratio) && gas["knudsen_number"].as_f64().unwrap() > 0.1, "{gas}");
    assert!(std::fs::read_to_string(directory.join("flow.svg")).unwrap().contains("Flow"));
    // Sealed: 0, and no error.
    let sealed = data(
        &[&of_map[..], &["--smallest-gap", "0.6 um", "--gas", "air", "--inlet", "1 bar", "--outlet", "0"]]
            .concat(),
        directory,
    );
    assert!(sealed["percolates"] == false && sealed["leak_rate"] == 0.0 && sealed["critical_gap"].is_null());

    let fault = |more: &[&str], words: &[&str]| refused(&[&of_map[..], more].concat(), directory, words);
    fault(&["--pressure-drop", "2 bar"], &["viscosity"]);
    fault(&["--pressure-drop", "2 bar", "--viscosity", "0"], &["--viscosity", "greater than 0"]);
    fault(&["--gas", "air", "--inlet", "1 bar", "--outlet", "2 bar"], &["not above", "exchange"]);
    fault(&["--gas", "air", "--inlet", "1 bar"], &["outlet"]);
    fault(&["--gas", "air", "--pressure-drop", "1 bar"], &["inlet and outlet"]);
    refused(&["leak", "nothing.zarr"], directory, &["no such"]);
    refused(&["leak"], directory, &["RESULT"]);
    fault(&["--field"], &["--field"]);
    fault(&["--times", "1 s"], &["--times"]);

    // A map of one column of open cells: the grid does not resolve it.
    let row = |open: &str| ["0", "0", open, "0", "0", "0"].join(" ");
    std::fs::write(directory.join("thin.txt"), vec![row("1"); 6].join("\n") + "\n").unwrap();
    let thin =
        ["leak", "--gap", "thin.txt", "--size", "6 um,6 um", "--height-unit", "um", "--direction", "y"];
    let told = data(&[&thin[..], &["--json"]].concat(), directory);
    assert!(told["leak_resolved"] == false && told["percolates"] == true, "{told}");
    assert_eq!(told["findings"][0]["code"], "constriction-unresolved");
    let words = told["findings"][0]["text"].as_str().unwrap();
    assert!(words.contains("1 cell wide, less than 4") && !words.contains("row"), "{words}");
}

const CASE: &str = r#"
title = "seal"
[domain]
cells = [32, 32]
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
end = "10 s"
steps = 20
spacing = "log"
[solver]
tolerance = 1e-9
[leakage]
pressure_drop = "30 Pa"
viscosity = "1 mPa s"
field = true
[output]
every = 4
"#;

#[test]
fn a_run_stores_its_leaks_and_other_fluids_can_follow() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    std::fs::write(directory.join("seal.toml"), CASE).unwrap();
    data(&["run", "seal.toml", "--json", "--quiet"], directory);
    // What the case asks for, again: the same numbers.
    let told = data(&["leak", "seal.zarr", "--json"], directory);
    let column = |told: &Value, name: &str| -> Vec<f64> {
        told[name].as_array().unwrap().iter().map(|v| v.as_f64().unwrap_or(f64::NAN)).collect()
    };
    let rates = column(&told, "leak_rate");
    let steps = column(&told, "leak_step");
    assert_eq!(steps, [0.0, 4.0, 8.0, 12.0, 16.0, 20.0]);
    // The rubber creeps: less and less.
    assert!(rates[0] > 0.0 && rates.windows(2).all(|pair| pair[1] <= pair[0]), "{rates:?}");
    assert!(rates[5] < 0.7 * rates[0], "{rates:?}");
    assert!(told["leak_resolved"].as_array().unwrap().iter().all(|good| good == true), "{told}");
    // Another fluid takes its place, in other units.
    let gas = data(
        &["leak", "seal.zarr", "--gas", "air", "--inlet", "1.001 bar", "--outlet", "1 bar", "--json"],
        directory,
    );
    assert!(gas["leak_rate_standard"].as_array().unwrap()[0].as_f64().unwrap() > 0.0);
    let shown = text(&asperity(&["leak", "seal.zarr"], directory).stdout);
    assert!(shown.contains("mbar l/s"), "{shown}");
    for what in ["seal.svg", "seal.html"] {
        let done = match what {
            "seal.svg" => asperity(&["plot", "seal.zarr", "leak", "-o", what], directory),
            _ => asperity(&["report", "seal.zarr", "-o", what], directory),
        };
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert!(std::fs::read_to_string(directory.join(what)).unwrap().contains("Leak rate"));
    }
    // Time as asked for; evenly spaced times are on a linear axis otherwise. A map has no such axis.
    let drawn = |options: &[&str]| {
        let start = ["plot", "seal.zarr", "leak", "--force", "-o", "axis.svg"];
        let done = asperity(&[&start[..], options].concat(), directory);
        assert!(done.status.success(), "{}", text(&done.stderr));
        std::fs::read_to_string(directory.join("axis.svg")).unwrap()
    };
    let [usual, linear, log] = [drawn(&[]), drawn(&["--linear-time"]), drawn(&["--log-time"])];
    assert!(usual == linear && usual != log);
    refused(&["plot", "seal.zarr", "gap", "--log-time"], directory, &["--log-time", "over time"]);
    // An option changes what it names and nothing else: the inlet of the air, whose pressure is stored as the case asks.
    let changed = asperity(&["leak", "seal.zarr", "--inlet", "1.002 bar", "--json"], directory);
    let told: Value = serde_json::from_slice(&changed.stdout).unwrap();
    let fluid = &told["leakage"]["fluid"]["gas"];
    assert!(fluid["inlet"] == 100_200.0 && fluid["outlet"] == 100_000.0, "{told}");
    assert!(fluid["kind"]["known"] == "air" && told["leakage"]["field"] == true, "{told}");
    let ratio = column(&told, "leak_rate")[0] / column(&gas, "leak_rate")[0];
    // Twice the drop, and nearly the same mean pressure.
    assert!((ratio / 2.0 - 1.0).abs() < 1e-3, "{ratio}");
    assert!(text(&changed.stderr).contains("replaces the stored leakage: air"), "{}", text(&changed.stderr));
    // Without storing; at some of the stored times; both conductances.
    let some = ["leak", "seal.zarr", "--times", "0 s,10 s", "--direction", "both", "--no-store", "--json"];
    let some = data(&some, directory);
    assert_eq!(some["leak_time"], serde_json::json!([0.0, 10.0]));
    let tensor = |n: usize, i: usize, j: usize| some["conductance"][n][i][j].as_f64().unwrap();
    // The wave is the same along both axes.
    assert!((tensor(0, 0, 0) / tensor(0, 1, 1) - 1.0).abs() < 1e-6, "{some}");
    assert_eq!(data(&["leak", "seal.zarr", "--json"], directory)["leak_step"].as_array().unwrap().len(), 6);
    let shown = text(&asperity(&["show", "seal.zarr"], directory).stdout);
    assert!(shown.contains("mbar l/s (at 0 °C) (air at 20 °C"), "{shown}");
    refused(&["leak", "seal.zarr", "--times", "3 s"], directory, &["t = 3 s", "those at"]);
    refused(&["leak", "seal.zarr", "--plot", "a.png"], directory, &["asperity plot RESULT leak"]);
    refused(&["leak", "seal.zarr", "--size", "1 m,1 m"], directory, &["--size"]);
    // The numbers and the field go out.
    for (format, file) in [("csv", "out_leak_time.csv"), ("netcdf", "out.nc"), ("npz", "out.npz")] {
        let name = if format == "csv" { "out.csv" } else { file };
        let done = asperity(&["export", "seal.zarr", "--to", format, "-o", name], directory);
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert_eq!(text(&done.stderr).contains("fluid_pressure"), format == "csv", "{}", text(&done.stderr));
        let bytes = std::fs::read(directory.join(file)).unwrap();
        assert!(String::from_utf8_lossy(&bytes).contains("hydraulic_gap"), "{file}");
    }
    // A drop above 0.02 of the mean pressure is found, in the result too.
    let large = data(
        &["leak", "seal.zarr", "--pressure-drop", "1 bar", "--viscosity", "1 mPa s", "--json"],
        directory,
    );
    assert_eq!(large["findings"][0]["code"], "fluid-uncoupled");
    assert_eq!(large["leak_resolved"][0], false);
    let stored = data(&["show", "seal.zarr", "--json"], directory);
    assert_eq!(stored["findings"].as_array().unwrap().len(), 1, "{stored}");
    // A result with leaks is replaced like any other.
    data(&["run", "seal.toml", "--json", "--quiet", "--force"], directory);
    let without = asperity(
        &["run", "seal.toml", "--force", "--quiet", "--set", "output.fields=[\"pressure\"]"],
        directory,
    );
    assert_eq!(without.status.code(), Some(2));
    assert!(text(&without.stderr).contains("output.fields"));
}

#[test]
fn keys_that_contradict_each_other_are_named() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    std::fs::write(directory.join("seal.toml"), CASE).unwrap();
    let fault = |set: &str, words: &[&str]| {
        refused(&["check", "seal.toml", "--set", set], directory, words);
    };
    fault("leakage.gas=air", &["leakage", "pressure_drop", "gas"]);
    fault("leakage.viscosity=1 bar", &["leakage.viscosity", "a viscosity"]);
    fault("leakage.direction=z", &["leakage.direction"]);
    fault("leakage.smallest_gap=-1 nm", &["leakage.smallest_gap", "not less than 0"]);
    fault("leakage.times=all", &["leakage.times", "output.every = 1"]);
    fault("leakage.times=[\"1 s\"]", &["leakage.times", "output.times"]);
}

#[test]
fn a_tight_seal_is_said_to_be_tight_everywhere() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    // The wave is flat from a few kPa on. No fluid; the first and the last row.
    let case = CASE
        .replace("1.8 kPa", "1 MPa")
        .replace("pressure_drop = \"30 Pa\"\nviscosity = \"1 mPa s\"", "times = [\"0 s\", \"10 s\"]");
    std::fs::write(directory.join("seal.toml"), case).unwrap();
    let run = asperity(&["run", "seal.toml", "--quiet"], directory);
    assert!(
        text(&run.stdout).contains("tight from                 0 s (tight at all times)"),
        "{}",
        text(&run.stdout)
    );
    let told = text(&asperity(&["leak", "seal.zarr"], directory).stdout);
    assert!(told.starts_with("Leakage of no fluid, the gap alone, along x, periodic sides"), "{told}");
    assert!(told.contains("tight at all times"), "{told}");
    let drawn = asperity(&["plot", "seal.zarr", "leak", "-o", "tight.svg"], directory);
    assert!(drawn.status.success(), "{}", text(&drawn.stderr));
    let picture = std::fs::read_to_string(directory.join("tight.svg")).unwrap();
    assert!(
        picture.contains("Inlet and") && picture.contains("closed") && !picture.contains("Leak rate"),
        "{picture}"
    );
    let pictures = asperity(&["export", "seal.zarr", "--to", "png", "-o", "pictures"], directory);
    assert!(
        pictures.status.success() && directory.join("pictures/leak.png").exists(),
        "{}",
        text(&pictures.stderr)
    );
}

#[test]
fn a_leak_is_said_to_be_of_a_patch_and_given_per_metre_of_seal() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    std::fs::write(directory.join("seal.toml"), CASE).unwrap();
    let patch = ["--set", "domain.size=[\"2 mm\", \"1 mm\"]", "--set", "domain.cells=[32, 16]"];
    let few = ["--set", "time.steps=2", "--set", "output.every=1", "--set", "solver.tolerance=1e-8"];
    let run = [&["run", "seal.toml", "--quiet"][..], &patch, &few].concat();
    let told = text(&asperity(&run, directory).stdout);
    assert!(told.contains("of a patch 1 mm wide and 2 mm along the flow; per m of such a seal "), "{told}");
    // What is printed has four digits.
    let per_metre = |direction: &str, more: &[&str]| -> f64 {
        let leak = [&["leak", "seal.zarr", "--no-store", "--direction", direction][..], more].concat();
        let told = text(&asperity(&leak, directory).stdout);
        let number = told.split("per m of such a seal ").nth(1).and_then(|rest| rest.split(' ').next());
        number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{told}"))
    };
    let (x, y) = (per_metre("x", &[]), per_metre("y", &[]));
    // The waves are the same along both axes, so the conductance of a square is too: a metre of seal leaks with the drop over the length.
    assert!((y / x / 2.0 - 1.0).abs() < 1e-3, "{x} {y}");
    let rate = data(&["leak", "seal.zarr", "--json"], directory)["leak_rate"].clone();
    let last = rate.as_array().unwrap().last().unwrap().as_f64().unwrap();
    assert!((x * 1e-3 / last - 1.0).abs() < 1e-3, "{x} {rate}");
    // A year has 365.25 days; a ml is 1e-6 m³.
    let year = per_metre("x", &["--unit", "leak=ml/year"]);
    assert!((year / x / (1e6 * 31_557_600.0) - 1.0).abs() < 2e-3, "{year} {x}");
    assert!(asperity(&["report", "seal.zarr", "-o", "seal.html"], directory).status.success());
    assert!(std::fs::read_to_string(directory.join("seal.html")).unwrap().contains("of a patch 1 mm wide"));
    // What flows round a contact with closed sides is no property of a metre.
    let closed = text(&asperity(&["leak", "seal.zarr", "--no-store", "--sides", "closed"], directory).stdout);
    assert!(closed.contains("the leak rate is of a patch") && !closed.contains("per m"), "{closed}");
    // Nothing has a liquid as a mass, and a map has no time.
    refused(&["leak", "seal.zarr", "--unit", "leak=g/year"], directory, &["--unit", "density is not known"]);
    map(directory);
    let of_map = ["leak", "--gap", "gap.txt", "--size", "160 um,40 um", "--height-unit", "um"];
    let water =
        ["--pressure-drop", "2 bar", "--viscosity", "1 mPa s", "--unit", "leak=ml/h", "--unit", "time=h"];
    let output = asperity(&[&of_map[..], &water].concat(), directory);
    assert!(text(&output.stderr).contains("time=h changes nothing"), "{}", text(&output.stderr));
    // 0.433e-18 m³ · 2e5 Pa / (12 · 1e-3 Pa s) · 40/160 in ml/h.
    assert!(text(&output.stdout).contains("leak rate             0.00649"), "{}", text(&output.stdout));
}

#[test]
fn a_fluid_that_acts_is_drawn_with_the_contact_and_what_says_nothing_is_not() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let acts =
        "inlet = \"1.005 bar\"\noutlet = \"1 bar\"\ncoupling = \"two-way\"\nopening = true\none_way = true\n";
    let acting = CASE.replace("pressure_drop = \"30 Pa\"\n", acts);
    std::fs::write(directory.join("dry.toml"), CASE).unwrap();
    std::fs::write(directory.join("wet.toml"), acting).unwrap();
    data(&["run", "dry.toml", "--json", "--quiet"], directory);
    let told = data(&["run", "wet.toml", "--json", "--quiet"], directory);
    let answers: Vec<&str> =
        told["answers"].as_array().unwrap().iter().map(|answer| answer["name"].as_str().unwrap()).collect();
    assert!(
        ["leak_rate_one_way", "fluid_load", "opening_pressure"].iter().all(|name| answers.contains(name)),
        "{answers:?}"
    );

    let drawn = asperity(&["plot", "wet.zarr", "fluid", "-o", "fluid.svg"], directory);
    assert!(drawn.status.success(), "{}", text(&drawn.stderr));
    let svg = std::fs::read_to_string(directory.join("fluid.svg")).unwrap();
    for words in ["contact</text>", "pressure of the fluid", "at the left", "of the load"] {
        assert!(svg.contains(words), "{words}");
    }
    refused(&["plot", "dry.zarr", "fluid", "-o", "no.svg"], directory, &["coupling", "two-way"]);
    // The rows with a fluid have 11 numbers that nobody asked for: those that stay what they are have no panel, and how the solver fared is
    // told with its work.
    let drawn = asperity(&["plot", "wet.zarr", "quantities", "-o", "numbers.svg"], directory);
    let numbers = std::fs::read_to_string(directory.join("numbers.svg")).unwrap();
    assert!(drawn.status.success() && numbers.contains("Parts of the load"), "{}", text(&drawn.stderr));
    for words in ["Film", "Held cells", "passes", "Pressure of the fluid", "last pass"] {
        assert!(!numbers.contains(words), "{words}");
    }
    asperity(&["plot", "wet.zarr", "work", "-o", "work.svg"], directory);
    let work = std::fs::read_to_string(directory.join("work.svg")).unwrap();
    assert!(work.contains("passes over the tractions") && work.contains("fluid (last pass)"));
    assert!(asperity(&["report", "wet.zarr"], directory).status.success());
    let page = std::fs::read_to_string(directory.join("wet.html")).unwrap();
    assert!(page.contains("\"fluid_map\":\"") && page.contains("\"leak_rate_one_way\":{"));
}
