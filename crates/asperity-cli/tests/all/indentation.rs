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
    says(&["--radius", "5 mm", "--column", "load=9"], &record(), &["column 9", "--column load=N"]);
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
        (&["--indenter", "cone", "--angle", "84 deg", "--model", "dmt"], "--indenter cone"),
        (&["--indenter", "cone", "--angle", "84"], "84 deg"),
        (&["--indenter", "pyramid", "--radius", "10 um"], "--radius"),
        (&["--indenter", "pyramid"], "--angle is needed"),
        (&["--indenter", "cone", "--angle", "90 deg"], "less than 90 degrees"),
        (&["--radius", "10 um", "--model", "power-law", "--terms", "2"], "--terms"),
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

/// A power law under a cone, W = (2/π) tan α E* 2 v² t^(2 - a)/((1 - a)(2 - a)), as a text table; it becomes the material of a case.
#[test]
fn a_power_law_under_a_cone_becomes_a_material() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("cell.csv");
    let (young, a) = (1e3, 0.2);
    let mut table = "t [s],load [nN],depth [nm]\n".to_owned();
    for k in 0..=200 {
        let t = 0.01 * f64::from(k);
        let unit = std::f64::consts::FRAC_2_PI * 35f64.to_radians().tan() * 2e-12;
        let load = unit * young / 0.75 * t.powf(2.0 - a) / ((1.0 - a) * (2.0 - a));
        table += &format!("{t:e},{:e},{:e}\n", load * 1e9, 1e3 * t);
    }
    std::fs::write(&path, table).unwrap();
    let cone = ["--indenter", "cone", "--angle", "35 deg", "--model", "power-law"];
    let output =
        fit(dir.path(), &path, &[&cone[..], &["--json", "-o", "cell.toml", "--plot", "cell.svg"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    // 150 springs and a sum that is exact to 1e-4.
    assert!((found["modulus_at_1_s"][0].as_f64().unwrap() / young - 1.0).abs() < 1e-3, "{found}");
    assert!((found["exponent"][0].as_f64().unwrap() - a).abs() < 1e-3, "{found}");
    assert_eq!((found["indenter"].as_str(), found["model"].as_str()), (Some("cone"), Some("power-law")));
    assert!(dir.path().join("cell.svg").exists());
    let words = text(&fit(dir.path(), &path, &cone).stdout);
    for word in ["E_1 ", "alpha", "cone, half angle 35 deg", "springpot"] {
        assert!(words.contains(word), "{words}");
    }
    // The relaxation modulus of the file is the power law: 2^(1/0.2) = 32 times as late it is half.
    let run = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
        let output = command.args(words).current_dir(dir.path()).output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let shown: Value = serde_json::from_str(&run(&[
        "material",
        "show",
        "cell.toml",
        "--from",
        "1 s",
        "--to",
        "10 s",
        "--json",
    ]))
    .unwrap();
    let first = shown[0]["relaxation_modulus"][0].as_f64().unwrap();
    assert!((first / young - 1.0).abs() < 3e-3, "{shown}");
    run(&["new", "--from", "cell.csv", "--material", "cell.toml", "--for", "indentation", "own.toml"]);
    let own = std::fs::read_to_string(dir.path().join("own.toml")).unwrap();
    // cot 35°.
    assert!(own.contains("kind = \"cone\"\nslope = 1.428"), "{own}");
    run(&["check", "own.toml"]);
}

/// The ball pressed to its radius, by Sneddon's closed form, in a force curve and over time; a pyramid by Bilodeau's.
#[test]
fn indenters_of_other_shapes_give_the_modulus_back() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("curve.csv");
    let contact = 1e3 / 0.75;
    let write = |load: &dyn Fn(f64) -> f64| {
        let mut table = "t [s],load [nN],depth [nm]\n".to_owned();
        for k in 0..=200 {
            let depth = 5e-6 * (1.0 - f64::from(k) / 150.0);
            let load = if depth > 0.0 { contact * load(depth) } else { 0.0 };
            table += &format!("{},{:e},{:e}\n", 0.01 * f64::from(k), load * 1e9, depth * 1e9);
        }
        std::fs::write(&path, table).unwrap();
    };
    let young = |arguments: &[&str]| {
        let output = fit(
            dir.path(),
            &path,
            &[&["--model", "hertz", "--json", "--plot", "f.svg", "--force"], arguments].concat(),
        );
        assert!(output.status.success(), "{}", text(&output.stderr));
        let found: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
        (found["young"][0].as_f64().unwrap() / 1e3, found["notes"].to_string())
    };
    let ball = |depth: f64| {
        let r = 5e-6_f64;
        let (mut low, mut high) = (0.0, r);
        for _ in 0..100 {
            let a: f64 = 0.5 * (low + high);
            if 0.5 * a * ((r + a) / (r - a)).ln() < depth { low = a } else { high = a }
        }
        0.5 * (low * low + r * r) * ((r + low) / (r - low)).ln() - low * r
    };
    write(&ball);
    let (found, notes) = young(&["--radius", "5 um"]);
    // Twelve digits in the file; the fit takes 1e-7 of the ranges as noise.
    assert!((found - 1.0).abs() < 1e-4 && notes.contains("as wide as the ball"), "{found} {notes}");
    let (paraboloid, notes) = young(&["--radius", "5 um", "--indenter", "paraboloid"]);
    assert!(paraboloid < 0.97 && notes.contains("take the indenter `sphere`"), "{paraboloid} {notes}");
    write(&|depth: f64| 0.7453 * 20f64.to_radians().tan() * depth * depth);
    let (pyramid, _) = young(&["--indenter", "pyramid", "--angle", "20 deg"]);
    assert!((pyramid - 1.0).abs() < 1e-4, "{pyramid}");
    // 5 % of the slope are 5 % of the modulus.
    let output = fit(
        dir.path(),
        &path,
        &[
            "--indenter",
            "pyramid",
            "--angle",
            "20 deg",
            "--model",
            "hertz",
            "--radius-uncertainty",
            "5 %",
            "--json",
        ],
    );
    let stated: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    let half = (stated["young"][2].as_f64().unwrap() / stated["young"][0].as_f64().unwrap()).ln() / 1.959_964;
    assert!((half - 0.05).abs() < 1e-4, "{half}");
}
