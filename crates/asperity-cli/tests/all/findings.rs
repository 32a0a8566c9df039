//! Findings as a user meets them: on the terminal, in JSON, in the result, and as errors under --strict.

use std::path::{Path, PathBuf};
use std::process::Output;

use asperity::finding::CODES;
use asperity_io::store::{Reader, Status};
use serde_json::Value;

use crate::asperity;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn object(output: &Output) -> Value {
    serde_json::from_str(&stdout(output)).unwrap_or_else(|error| panic!("{error}: {}", stdout(output)))
}

fn codes(findings: &Value) -> Vec<&str> {
    findings.as_array().unwrap().iter().map(|finding| finding["code"].as_str().unwrap()).collect()
}

/// The starter case zener-step on a coarse grid: 0.1 N is sound, 1 N reaches the border.
fn zener(load: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(root().join("examples/zener-step.toml")).unwrap();
    let text =
        text.replace("[256, 256]", "[32, 32]").replace("steps = 50", "steps = 4").replace("0.1 N", load);
    std::fs::write(directory.path().join("case.toml"), text).unwrap();
    directory
}

#[test]
fn a_sound_case_has_no_findings() {
    let directory = zener("0.1 N");
    let check = asperity(directory.path(), &["check", "case.toml", "--json", "--strict"]);
    assert!(check.status.success(), "{}", stdout(&check));
    assert_eq!(object(&check)["findings"], serde_json::json!([]));
    let run = asperity(directory.path(), &["run", "case.toml", "-o", "a.zarr", "--json", "--strict"]);
    assert!(run.status.success(), "{}", stderr(&run));
    assert_eq!(object(&run)["findings"], serde_json::json!([]));
    assert!(!stderr(&run).contains("warning"), "{}", stderr(&run));
    let document = std::fs::read_to_string(directory.path().join("a.zarr/zarr.json")).unwrap();
    let document: Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["attributes"]["findings"], serde_json::json!([]));
}

#[test]
fn a_case_that_fills_its_domain_says_so_everywhere() {
    let directory = zener("1 N");
    let dir = directory.path();
    let check = asperity(dir, &["check", "case.toml"]);
    assert!(check.status.success() && stdout(&check).contains("[contact-at-border]"), "{}", stdout(&check));

    let run = asperity(dir, &["run", "case.toml", "-o", "a.zarr"]);
    assert!(run.status.success(), "{}", stderr(&run));
    assert!(
        stderr(&run).contains("warning: In rows 0 to 4 the contact reaches the border"),
        "{}",
        stderr(&run)
    );
    assert!(stdout(&run).contains("contact-at-border"), "{}", stdout(&run));

    // a^3 = 3 R W / (4 E*) with E* = 4 MPa relaxed, a = 1.23 mm; at 5 s nearly so.
    let run = asperity(dir, &["run", "case.toml", "-o", "b.zarr", "--json", "--quiet"]);
    assert!(run.status.success() && stderr(&run).is_empty(), "{}", stderr(&run));
    let found = object(&run)["findings"].clone();
    assert_eq!(codes(&found), ["contact-at-border"]);
    let border = &found[0];
    assert_eq!((&border["severity"], &border["rows"]), (&"warning".into(), &serde_json::json!([0, 4])));
    assert_eq!(border["value"], 2e-3);
    assert!((border["limit"].as_f64().unwrap() / (2.5 * 1.23e-3) - 1.0).abs() < 0.01, "{border}");
    assert!(border["text"].as_str().unwrap().contains("domain.size"));

    let reader = Reader::open(&dir.join("b.zarr")).unwrap();
    assert_eq!(asperity_io::finding::list(reader.findings()), found);
    let document = std::fs::read_to_string(dir.join("b.zarr/zarr.json")).unwrap();
    let document: Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["attributes"]["findings"], found);
    let show = asperity(dir, &["show", "b.zarr"]);
    assert!(stdout(&show).contains("[contact-at-border]"), "{}", stdout(&show));
    assert_eq!(object(&asperity(dir, &["show", "b.zarr", "--json"]))["findings"], found);
    assert!(asperity(dir, &["report", "b.zarr"]).status.success());
    let page = std::fs::read_to_string(dir.join("b.html")).unwrap();
    assert!(page.contains("contact-at-border"));
    // Formats without lists of objects hold it as text.
    assert!(asperity(dir, &["export", "b.zarr", "--to", "netcdf"]).status.success());
    let bytes = std::fs::read(dir.join("b.nc")).unwrap();
    assert!(bytes.windows(17).any(|window| window == b"contact-at-border"));
}

#[test]
fn strict_makes_warnings_errors_and_keeps_the_result() {
    let directory = zener("1 N");
    let check = asperity(directory.path(), &["check", "case.toml", "--strict"]);
    assert_eq!(check.status.code(), Some(1), "{}", stderr(&check));
    let run = asperity(directory.path(), &["run", "case.toml", "-o", "a.zarr", "--strict", "--json"]);
    assert_eq!(run.status.code(), Some(1), "{}", stderr(&run));
    assert!(stderr(&run).contains("error: 1 warning (--strict)"), "{}", stderr(&run));
    assert_eq!(object(&run)["status"], "complete");
    assert_eq!(Reader::open(&directory.path().join("a.zarr")).unwrap().status(), Status::Complete);
}

#[test]
fn check_repeats_what_a_slip_would_hide_in() {
    let directory = zener("0.1 N");
    let text = stdout(&asperity(directory.path(), &["check", "case.toml"]));
    for words in
        ["radius 10 mm", "100 mN at most, 25 kPa over the domain", "2 MPa instantaneous, 1 MPa relaxed"]
    {
        assert!(text.contains(words), "{words} in {text}");
    }
    // a^3 = 3 R W / (4 E*): 0.454 mm on 8 MPa, at 5 s 0.572 mm; 18 cells of 62.5 um.
    assert!(
        text.contains("contact radius 454.3 µm right after the load, 57") && text.contains("18 cells across"),
        "{text}"
    );
    let inputs = object(&asperity(directory.path(), &["check", "case.toml", "--json"]))["inputs"].clone();
    assert_eq!(inputs["surfaces"][0]["radius"], serde_json::json!([0.01, 0.01]));
    assert_eq!(inputs["largest_load"], 0.1);
    assert!(inputs["expected_pressure_over_modulus"].as_f64().unwrap() < 0.05);
}

#[test]
fn the_examples_are_sound_before_they_run() {
    for folder in ["examples", "examples/paper"] {
        for entry in std::fs::read_dir(root().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let check = asperity(&root(), &["check", path.to_str().unwrap(), "--json"]);
            assert!(check.status.success(), "{}: {}", path.display(), stderr(&check));
            let findings = object(&check)["findings"].clone();
            let warnings =
                findings.as_array().unwrap().iter().filter(|finding| finding["severity"] == "warning");
            let codes: Vec<&str> = warnings.filter_map(|finding| finding["code"].as_str()).collect();
            // Rubber on a rough road is beyond small strains where it is stiff, as every linear theory of it.
            let expected: &[&str] = match path.file_stem().and_then(|name| name.to_str()) {
                Some("rubber-friction") => &["large-strain"],
                _ => &[],
            };
            assert_eq!(codes, expected, "{}: {findings}", path.display());
        }
    }
}

#[test]
fn surfaces_are_judged_too() {
    let directory = tempfile::tempdir().unwrap();
    // A plane with one spike: outliers; its spectrum is that of a spike, flat, H = -1.
    let line = |i: usize| {
        let heights: Vec<&str> = (0..64).map(|j| if (i, j) == (30, 31) { "1e-6" } else { "0" }).collect();
        heights.join(" ")
    };
    let text: Vec<String> = (0..64).map(line).collect();
    std::fs::write(directory.path().join("spike.txt"), text.join("\n")).unwrap();
    let arguments = ["surface", "info", "spike.txt", "--size", "1 mm,1 mm", "--height-unit", "m", "--json"];
    let info = asperity(directory.path(), &arguments);
    assert!(info.status.success(), "{}", stderr(&info));
    let found = object(&info)["findings"].clone();
    assert!(codes(&found).contains(&"outliers") && codes(&found).contains(&"hurst-out-of-range"), "{found}");
    let info = asperity(directory.path(), &arguments[..7]);
    assert!(stdout(&info).contains("[outliers]"), "{}", stdout(&info));
}

#[test]
fn every_code_is_documented() {
    let page = std::fs::read_to_string(root().join("docs/findings.md")).unwrap();
    for code in CODES {
        assert!(page.contains(&format!("\n### `{code}`")), "{code} is not in docs/findings.md");
    }
}
