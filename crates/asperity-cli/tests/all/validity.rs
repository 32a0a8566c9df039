//! Answers that a finding takes back, wherever they are shown.

use std::path::Path;

use serde_json::Value;

use super::asperity;

/// A wave in full contact under 40 kPa, which closes at 31.4 kPa, and a fluid of 1.5 times that pressure, which is left out.
const CASE: &str = r#"
[domain]
cells = [2, 64]
size = ["0.3125 um", "10 um"]
boundary = "periodic"
[[surface]]
kind = "wave"
amplitude = "0.1 um"
wavelength = ["inf", "10 um"]
[[body]]
poisson = 0.5
material = { model = "elastic", young = "0.75 MPa" }
[load]
control = "pressure"
history = { kind = "step", value = "40 kPa" }
[time]
end = "1 s"
steps = 2
[leakage]
pressure_drop = "60 kPa"
viscosity = "1 mPa s"
"#;

fn told(directory: &Path, arguments: &[&str]) -> String {
    let done = asperity(directory, arguments);
    assert!(done.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr)
}

fn data(directory: &Path, arguments: &[&str]) -> Value {
    let done = asperity(directory, arguments);
    assert!(done.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
    serde_json::from_slice(&done.stdout).unwrap()
}

fn answer<'v>(answers: &'v Value, name: &str) -> &'v Value {
    answers.as_array().unwrap().iter().find(|answer| answer["name"] == name).unwrap()
}

#[test]
fn a_leak_without_the_fluid_that_lifts_the_seal_is_no_answer_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("wave.toml"), CASE).unwrap();
    assert!(told(folder, &["check", "wave.toml"]).contains("[fluid-uncoupled]"));
    let words = "not valid: the fluid lifts the seal [fluid-uncoupled]";
    let run = told(folder, &["run", "wave.toml", "--threads", "1"]);
    assert!(run.contains(words) && !run.contains("none: tight"), "{run}");
    for arguments in [&["show", "wave.zarr"][..], &["leak", "wave.zarr"]] {
        assert!(told(folder, arguments).contains(words), "{arguments:?}");
    }
    let shown = data(folder, &["show", "wave.zarr", "--json"]);
    for name in ["leak_rate", "tight_from"] {
        let leak = answer(&shown["answers"], name);
        assert_eq!(leak["valid"], false);
        assert_eq!(leak["why"], "fluid-uncoupled: the fluid lifts the seal");
        assert_eq!(leak["value"], 0.0);
    }
    // The contact does not depend on it.
    let area = answer(&shown["answers"], "contact_area");
    assert!(area.get("valid").is_none() && area.get("see").is_none(), "{area}");
    let leak = data(folder, &["leak", "wave.zarr", "--json"]);
    assert_eq!(leak["why"], "fluid-uncoupled: the fluid lifts the seal");
    told(folder, &["report", "wave.zarr", "-o", "wave.html"]);
    assert!(std::fs::read_to_string(folder.join("wave.html")).unwrap().contains(words));
    // In a study and a comparison.
    let vary = ["study", "wave.toml", "--vary", "leakage.pressure_drop=0.1 kPa, 60 kPa", "-o", "drops"];
    let table = told(folder, &[&vary[..], &["--threads", "1"]].concat());
    assert!(table.contains("not valid [fluid-uncoupled]"), "{table}");
    let csv = std::fs::read_to_string(folder.join("drops/study.csv")).unwrap();
    let taken: Vec<&str> =
        csv.lines().filter(|line| line.contains("leak_rate hydraulic_gap tight_from")).collect();
    assert!(csv.contains(",not_valid,") && taken.len() == 1, "{csv}");
    let runs: Vec<String> = data(folder, &["study", "status", "drops", "--json"])["runs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|run| run["result"].as_str().unwrap().to_owned())
        .collect();
    let compared = data(folder, &["compare", &runs[0], &runs[1], "--json"]);
    let leak = answer(&compared["answers"], "leak_rate");
    assert_eq!(leak["validity"][1]["valid"], false);
    assert!(leak["validity"][0].get("valid").is_none() && leak["changes"][1].is_null(), "{leak}");
    assert!(told(folder, &["compare", &runs[0], &runs[1]]).contains("not valid [fluid-uncoupled]"));
}

/// The rows of a result that stopped are no answer to those of a complete one.
#[test]
fn a_result_that_is_not_complete_is_compared_without_changes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("wave.toml"), CASE.split("[leakage]").next().unwrap()).unwrap();
    told(folder, &["run", "wave.toml", "-o", "a.zarr", "--threads", "1"]);
    told(
        folder,
        &["run", "wave.toml", "-o", "b.zarr", "--threads", "1", "--set", "load.history.value=20 kPa"],
    );
    let path = folder.join("b.zarr/zarr.json");
    let text = std::fs::read_to_string(&path).unwrap();
    let stopped = text.replacen("\"complete\"", "\"interrupted\"", 1);
    assert_ne!(text, stopped);
    std::fs::write(&path, stopped).unwrap();
    let compared = data(folder, &["compare", "a.zarr", "b.zarr", "--json"]);
    assert!(answer(&compared["answers"], "contact_area")["changes"][1].is_null(), "{compared}");
    let words = told(folder, &["compare", "a.zarr", "b.zarr"]);
    assert!(
        words.contains("interrupted") && words.contains("not complete") && !words.contains(" %)"),
        "{words}"
    );
}

/// The same where the answer is drawn, in tables of rows and beside its error.
#[test]
fn a_leak_that_is_taken_back_is_drawn_and_listed_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("wave.toml"), CASE).unwrap();
    let run = data(folder, &["run", "wave.toml", "--threads", "1", "--error-bars", "--json", "--quiet"]);
    let shown = data(folder, &["show", "wave.zarr", "--json"]);
    for bars in [&run["error_bars"], &shown["error_bars"]] {
        assert_eq!(answer(bars, "leak_rate")["valid"], false, "{bars}");
        assert!(answer(bars, "contact_area").get("valid").is_none(), "{bars}");
    }
    let table = told(folder, &["leak", "wave.zarr"]);
    let rows: Vec<&str> = table.lines().filter(|line| line.contains("not valid [fluid-uncoupled]")).collect();
    assert!(rows.len() == 3 && rows.iter().all(|row| !row.contains("tight")), "{table}");
    let leak = data(folder, &["leak", "wave.zarr", "--json"]);
    assert_eq!(leak["leak_valid"], serde_json::json!([false, false, false]));
    told(folder, &["plot", "wave.zarr", "leak", "-o", "leak.svg"]);
    let figure = std::fs::read_to_string(folder.join("leak.svg")).unwrap();
    assert!(figure.contains("not valid: the fluid lifts the seal"), "{figure}");
    assert!(!figure.contains("Tight") && !figure.contains("tight"), "{figure}");
    told(folder, &["report", "wave.zarr", "-o", "wave.html"]);
    let page = std::fs::read_to_string(folder.join("wave.html")).unwrap();
    assert!(page.contains("Not valid: the fluid lifts the seal") && !page.contains("Tight, liquid"));
    // The summary, without the note of the answer.
    let headline = page.split_once("\"headline\":").unwrap().1.split("]]").next().unwrap();
    assert!(headline.contains("not valid") && !headline.contains("tight at all times"), "{headline}");
}

/// A wave of the slope 2.7, more than 5 times the limit: no number of its rows is an answer, but for what the case prescribes.
#[test]
fn numbers_of_rows_that_are_taken_back_are_not_compared() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("wave.toml"), CASE.split("[leakage]").next().unwrap()).unwrap();
    told(folder, &["run", "wave.toml", "-o", "flat.zarr", "--threads", "1"]);
    let steep =
        ["run", "wave.toml", "-o", "steep.zarr", "--threads", "1", "--set", "surface.0.amplitude=6 um"];
    told(folder, &steep);
    let compared = data(folder, &["compare", "flat.zarr", "steep.zarr", "--json"]);
    let number = |name: &str| answer(&compared["numbers"], name).clone();
    assert_eq!(number("contact_area")["validity"][1]["valid"], false);
    assert!(number("contact_area")["validity"][0].get("valid").is_none());
    assert!(number("load")["validity"][1].get("valid").is_none());
    let text = told(folder, &["compare", "flat.zarr", "steep.zarr"]);
    let (_, table) = text.split_once("at the end").unwrap();
    let row = table.lines().find(|line| line.starts_with("contact_area")).unwrap();
    assert!(row.contains("not valid [large-slope]") && !row.contains('%'), "{table}");
    told(folder, &["plot", "steep.zarr", "evolution", "-o", "steep.svg"]);
    let figure = std::fs::read_to_string(folder.join("steep.svg")).unwrap();
    assert!(figure.contains("The contact area is not valid"), "{figure}");
}
