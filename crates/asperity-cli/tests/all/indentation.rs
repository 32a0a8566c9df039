//! `asperity fit-indentation` as a user meets it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use asperity_io::case::Case;
use serde_json::Value;

fn record() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/data/silicone-indentation.csv")
}

fn fit(directory: &Path, record: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.arg("fit-indentation").arg(record).args(arguments).current_dir(directory).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn holds(interval: &Value, value: f64) -> bool {
    let [low, high] = [1, 2].map(|k| interval[k].as_f64().unwrap());
    low <= value && value <= high
}

#[test]
fn the_example_gives_its_material_back() {
    // examples/data/README.md: E = 1.2 + 0.8 exp(-t/0.6 s) + 0.5 exp(-t/8 s) MPa, 1 % of noise.
    let dir = tempfile::tempdir().unwrap();
    let output =
        fit(dir.path(), &record(), &["--radius", "5 mm", "--json", "-o", "pad.toml", "--plot", "fit.svg"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    assert_eq!((found["given"].as_str(), found["modulus"].as_str()), (Some("depth"), Some("young")));
    assert!(holds(&found["equilibrium"], 1.2e6) && holds(&found["instantaneous"], 2.5e6), "{found}");
    let terms = found["terms"].as_array().unwrap();
    assert_eq!(terms.len(), 2, "{found}");
    for (term, (modulus, time)) in terms.iter().zip([(0.8e6, 0.6), (0.5e6, 8.0)]) {
        assert!(holds(&term["modulus"], modulus) && holds(&term["time"], time), "{term}");
    }
    assert!((found["relative_rms"].as_f64().unwrap() - 0.01).abs() < 0.001);
    assert!(std::fs::read_to_string(dir.path().join("fit.svg")).unwrap().contains("Load over depth"));
    // The block stands under a body of a case.
    let block = std::fs::read_to_string(dir.path().join("pad.toml")).unwrap();
    let case = format!(
        "[domain]\ncells = [8, 8]\nsize = [1e-3, 1e-3]\n[[surface]]\nkind = \"sphere\"\nradius = 1\n[[body]]\n{block}\
         [load]\ncontrol = \"load\"\nhistory = {{ kind = \"step\", value = 1e-3 }}\n[time]\nend = 1\nsteps = 1\n"
    );
    let case = Case::parse(&case, dir.path(), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let young = 1.0 / case.conditions.creep.instantaneous * 0.75;
    assert!((young / found["instantaneous"][0].as_f64().unwrap() - 1.0).abs() < 1e-12);
    // And `material show` reads it as it is: E at once and relaxed.
    let mut show = Command::new(env!("CARGO_BIN_EXE_asperity"));
    let shown =
        show.args(["material", "show", "pad.toml", "--json"]).current_dir(dir.path()).output().unwrap();
    assert!(shown.status.success(), "{}", text(&shown.stderr));
    let shown: Value = serde_json::from_str(&text(&shown.stdout)).unwrap();
    let relaxed = shown[0]["relaxation_modulus"].as_array().unwrap().last().unwrap().as_f64().unwrap();
    // The table ends a decade after the longest time: e^-10 is left.
    assert!((relaxed / found["equilibrium"][0].as_f64().unwrap() - 1.0).abs() < 1e-4, "{shown}");
    // Shear moduli are a third of Young's where nu = 0.5.
    let output =
        fit(dir.path(), &record(), &["--radius", "5 mm", "--json", "--modulus", "shear", "--terms", "2"]);
    let shear: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    let ratio = shear["equilibrium"][0].as_f64().unwrap() / found["equilibrium"][0].as_f64().unwrap();
    assert!((ratio * 3.0 - 1.0).abs() < 1e-9, "{ratio}");
    // In words.
    let output = fit(dir.path(), &record(), &["--radius", "5 mm"]);
    let words = text(&output.stdout);
    for word in ["E(inf)", "tau_2", "95 % interval", "depth; the load is fitted", "model = \"prony\""] {
        assert!(words.contains(word), "{words}");
    }
}

#[test]
fn the_file_keeps_the_test_and_both_ways_to_read_a_thin_sample_are_cases() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = ["--radius", "5 mm", "--thickness", "2 mm", "--interface", "slip", "-o", "pad.toml"];
    let output = fit(dir.path(), &record(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let block = std::fs::read_to_string(dir.path().join("pad.toml")).unwrap();
    for words in ["radius = \"5e-3 m\"", "\nthickness = \"2e-3 m\"\n", "silicone-indentation.csv"] {
        assert!(block.contains(words), "{words}: {block}");
    }
    // What `check` says of a case with this body, in a contact of some millimetres.
    let check = |body: &str| {
        let case = format!(
            "[domain]\ncells = [16, 16]\nsize = [\"8 mm\", \"8 mm\"]\n[[surface]]\nkind = \"sphere\"\nradius = \"5 mm\"\n[[body]]\n{body}\
             [load]\ncontrol = \"load\"\nhistory = {{ kind = \"step\", value = 1 }}\n[time]\nend = 1\nsteps = 1\n"
        );
        std::fs::write(dir.path().join("case.toml"), case).unwrap();
        let mut check = Command::new(env!("CARGO_BIN_EXE_asperity"));
        let output = check.args(["check", "case.toml"]).current_dir(dir.path()).output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout) + &text(&output.stderr)
    };
    let half_space = check(&block);
    assert!(half_space.contains("thin-body") && !half_space.contains("slipping"), "{half_space}");
    // The layer, as the remarks tell it.
    let layer = check(&format!("base = \"rigid\"\n[[body.layer]]\ninterface = \"slip\"\n{block}"));
    assert!(layer.contains("2 mm") && !layer.contains("thin-body"), "{layer}");
    // Also alone.
    let mut show = Command::new(env!("CARGO_BIN_EXE_asperity"));
    let shown = show.args(["material", "show", "pad.toml"]).current_dir(dir.path()).output().unwrap();
    assert!(shown.status.success(), "{}", text(&shown.stderr));
}

#[test]
fn slips_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let says = |arguments: &[&str], record: &Path, words: &[&str]| {
        let output = fit(dir.path(), record, arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        for word in words {
            assert!(said.contains(word), "{said:?} lacks {word:?}");
        }
    };
    says(&[], &record(), &["--radius"]);
    says(&["--radius", "5 s"], &record(), &["--radius", "5 s", "length"]);
    says(&["--radius", "5 mm", "--poisson", "0.6"], &record(), &["--poisson", "0.6"]);
    says(&["--radius", "5 mm", "--terms", "7"], &record(), &["number of terms is 7"]);
    // What to do is said as options of the command.
    says(&["--radius", "5 mm", "--column", "load=9"], &record(), &["column 9", "--column load=1"]);
    says(&["--radius", "5 mm", "--unit", "load=mm"], &record(), &["load", "mm"]);
    says(&["--radius", "5 mm", "--column", "depth=4"], &record(), &["depth", "column 4"]);
    let turned = dir.path().join("turned.csv");
    let good = std::fs::read_to_string(record()).unwrap();
    std::fs::write(&turned, good.replace("load [mN]", "load [Pa]")).unwrap();
    says(&["--radius", "5 mm"], &turned, &["load", "a pressure"]);
    std::fs::write(&turned, good.lines().take(8).collect::<Vec<_>>().join("\n")).unwrap();
    says(&["--radius", "5 mm"], &turned, &["turned.csv", "number of rows"]);
}

/// Height and deflection of a cantilever of 0.5 N/m, 50 nm/V, on a JKR contact: its points at radii of contact, without noise.
fn force_curve() -> String {
    use asperity::reference::{AdhesiveModel, AdhesiveSphere};
    let sphere = AdhesiveSphere::new(AdhesiveModel::Jkr, 10e-6, 1e6 / 0.75, 5e-3).unwrap();
    let mut text = "height [um],deflection [V]\n".to_owned();
    for k in 0..300 {
        let depth = 0.4e-6 - 2.5e-9 * f64::from(k);
        let load = sphere.at_approach(depth).unwrap().map_or(0.0, |point| point.load);
        let bent = load / 0.5;
        text += &format!("{:.9e},{:.9e}\n", (depth + bent) * 1e6, bent / 50e-9);
    }
    text
}

#[test]
fn a_force_curve_gives_modulus_and_work() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("curve.csv");
    std::fs::write(&path, force_curve()).unwrap();
    let spring = ["--radius", "10 um", "--model", "jkr", "--spring-constant", "0.5 N/m"];
    let json = |arguments: &[&str]| -> Value {
        let arguments = [&spring[..], &["--sensitivity", "50 nm", "--json"], arguments].concat();
        let output = fit(dir.path(), &path, &arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_str(&text(&output.stdout)).unwrap()
    };
    let found = json(&["-o", "pad.toml", "--plot", "fit.svg"]);
    // Exact but for ten digits: the fit is limited by the rounding that it takes as noise, 1e-7 of the ranges.
    assert!((found["young"][0].as_f64().unwrap() / 1e6 - 1.0).abs() < 1e-4, "{found}");
    assert!((found["work"][0].as_f64().unwrap() / 5e-3 - 1.0).abs() < 1e-4, "{found}");
    assert!(std::fs::read_to_string(dir.path().join("pad.toml")).unwrap().contains("elastic"));
    assert!(dir.path().join("fit.svg").exists());
    // Stated uncertainties: w ∝ k/R, 1.96 standard deviations of ln w.
    let stated = json(&["--radius-uncertainty", "3 %", "--spring-constant-uncertainty", "0.02 N/m"]);
    let half = (stated["work"][2].as_f64().unwrap() / stated["work"][0].as_f64().unwrap()).ln() / 1.959_964;
    assert!((half - 0.05).abs() < 1e-4, "{half}");
    for (arguments, words) in [
        (&spring[..], "volt"),
        (&["--radius", "10 um", "--model", "jkr", "--terms", "1"], "--terms"),
        (&["--radius", "10 um", "--range", "1 nm"], "--range"),
        (&["--cone", "0.1", "--model", "dmt"], "--cone"),
        (&["--radius", "10 um", "--model", "jkr", "--radius-uncertainty", "2 N"], "--radius-uncertainty"),
        (&["--radius", "10 um", "--model", "jkr", "--thickness", "5 um"], "half-space"),
        (&["--radius", "10 um", "--spring-constant-uncertainty", "0.1 N/m"], "state it in %"),
    ] {
        let output = fit(dir.path(), &path, arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains(words), "{}", text(&output.stderr));
    }
}

/// E goes as R^(-1/2) and as the scale of the load.
#[test]
fn intervals_of_a_relaxation_contain_stated_uncertainties() {
    let dir = tempfile::tempdir().unwrap();
    let half = |more: &[&str]| {
        let arguments = [&["--radius", "5 mm", "--terms", "2", "--json"], more].concat();
        let output = fit(dir.path(), &record(), &arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let found: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
        let [value, high] = [0, 2].map(|k| found["equilibrium"][k].as_f64().unwrap());
        (high / value).ln() / 1.959_964
    };
    let stated = half(&["--radius-uncertainty", "0.4 mm", "--spring-constant-uncertainty", "3 %"]);
    // Half of 8 %, and 3 %; the search ends where the sum of squares falls by 1e-4 or less.
    assert!(((stated.powi(2) - half(&[]).powi(2)).sqrt() - 0.05).abs() < 2e-3, "{stated}");
}
