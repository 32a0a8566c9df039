//! `asperity material` as a user meets it.

use std::path::{Path, PathBuf};
use std::process::Output;

use asperity_io::case::{Case, specimens};
use serde_json::Value;

use crate::asperity;

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[track_caller]
fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", stderr(output));
    serde_json::from_str(&stdout(output)).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The value at a place of a table.
fn at(table: &Value, places: &str, values: &str, place: f64) -> f64 {
    let places = numbers(&table[places]);
    let n = places.iter().position(|x| (x / place - 1.0).abs() < 1e-9).unwrap();
    numbers(&table[values])[n]
}

#[test]
fn pmma_creeps_as_in_the_third_figure_of_the_paper() {
    let dir = tempfile::tempdir().unwrap();
    let case = examples().join("pmma-indentation.toml");
    let case = case.to_str().unwrap();
    let shown = json(&asperity(dir.path(), &["material", "show", case, "--json"]));
    let pmma = &shown[0];
    // Exact conversion of the relaxation modulus 1973 + 254.776 exp(-t/8.93) + 263.6628 exp(-t/117.96) MPa:
    // D0 + D1 (1 - exp(-t/9.936295903)) + D2 (1 - exp(-t/133.8704875)), ten digits given.
    let creep = |t: f64| {
        1e-6 * (4.013744989e-4
            + 4.474062327e-5 * (1.0 - (-t / 9.936295903).exp())
            + 6.072724980e-5 * (1.0 - (-t / 133.8704875).exp()))
    };
    for t in [0.1, 1.0, 10.0, 100.0, 1000.0] {
        let found = at(pmma, "time", "creep_compliance", t);
        assert!((found / creep(t) - 1.0).abs() < 1e-9, "{t}: {found}");
        let relaxation = 1e6 * (1973.0 + 254.776 * (-t / 8.93).exp() + 263.6628 * (-t / 117.96).exp());
        assert!((at(pmma, "time", "relaxation_modulus", t) / relaxation - 1.0).abs() < 1e-9);
    }
    // E'' at 1/tau_1: half of the first term and what is left of the second.
    let loss = |w: f64| {
        let term = |e: f64, tau: f64| e * w * tau / (1.0 + (w * tau).powi(2));
        1e6 * (term(254.776, 8.93) + term(263.6628, 117.96))
    };
    assert!((at(pmma, "angular_frequency", "loss_modulus", 0.1) / loss(0.1) - 1.0).abs() < 1e-12);
    let tan = at(pmma, "angular_frequency", "tan_delta", 0.1);
    assert!((tan * at(pmma, "angular_frequency", "storage_modulus", 0.1) / loss(0.1) - 1.0).abs() < 1e-12);

    let text = asperity(
        dir.path(),
        &["material", "show", case, "--from", "1 s", "--to", "100 s", "--plot", "p.svg"],
    );
    let text = stdout(&text);
    assert!(text.contains("D(t) [1/Pa]") && text.contains("tan delta") && text.contains("prony"), "{text}");
    let svg = std::fs::read_to_string(dir.path().join("p.svg")).unwrap();
    assert!(svg.contains("tan delta") && svg.contains("creep"), "{svg}");
}

#[test]
fn a_fit_becomes_a_block_that_a_case_takes() {
    let dir = tempfile::tempdir().unwrap();
    let data = examples().join("data/rubber-dma.csv");
    let data = data.to_str().unwrap();
    let wlf = ["--wlf", "8.86, 101.6 K, 20 °C"];
    let fit = |more: &[&str]| {
        let arguments = [&["material", "fit", data, "--modulus", "shear"], more].concat();
        asperity(dir.path(), &arguments)
    };
    let output = fit(&[&wlf[..], &["-o", "fitted.toml", "--plot", "fit.png", "--json"]].concat());
    let object = json(&output);
    // 2 % of scatter, stated in the file; the largest of 208 normal deviates is below four of them.
    let misfit = |kind: &str| object["misfit"][kind].as_f64().unwrap();
    assert!((0.015..0.025).contains(&misfit("rms")) && misfit("max") < 0.09, "{object}");
    assert_eq!((object["kind"].as_str(), object["points"].as_u64()), (Some("dma"), Some(104)));
    assert!(dir.path().join("fit.png").exists());

    // The block stands alone ...
    let path = dir.path().join("fitted.toml");
    let alone = specimens(&path, &[], None).unwrap_or_else(|errors| panic!("{errors}"));
    let block = std::fs::read_to_string(&path).unwrap();
    // ... and in a case, where it is the material that the data give there.
    let rubber = std::fs::read_to_string(examples().join("rubber-dma.toml")).unwrap();
    let (start, end) = (rubber.find("[body.material]").unwrap(), rubber.find("[load]").unwrap());
    let pasted = format!("{}{block}{}", &rubber[..start], &rubber[end..]);
    let read = |text: &str| Case::parse(text, &examples(), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let (from_data, from_block) = (read(&rubber), read(&pasted));
    let creep = |case: &Case| case.conditions.thermal[0].creep.clone();
    for t in [1e-6, 1e-2, 10.0] {
        // Shortest decimal numbers give the same doubles back; the conversion is exact to rounding.
        assert!((creep(&from_block).value(t) / creep(&from_data).value(t) - 1.0).abs() < 1e-12);
        let value = alone[0].material.creep().value(t);
        assert!((value / from_data.bodies[0].material.creep().value(t) - 1.0).abs() < 1e-12);
    }
    std::fs::write(dir.path().join("case.toml"), &pasted).unwrap();
    let check = asperity(dir.path(), &["check", "case.toml"]);
    assert!(check.status.success(), "{}", stderr(&check));

    // Nothing is overwritten unasked.
    let again = fit(&[&wlf[..], &["-o", "fitted.toml"]].concat());
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("--force"), "{}", stderr(&again));
    assert!(fit(&[&wlf[..], &["-o", "fitted.toml", "--force"]].concat()).status.success());

    // The overlap of the sweeps tells the shift; the law behind the data is c1 = 8.86, c2 = 101.6 K.
    let object = json(&fit(&["--estimate-shift", "20 °C", "--json"]));
    let shift = asperity::material::Shift::Wlf {
        c1: object["shift"]["c1"].as_f64().unwrap(),
        c2: object["shift"]["c2"].as_f64().unwrap(),
        reference: object["shift"]["reference"].as_f64().unwrap(),
    };
    let truth = asperity::material::Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    for kelvin in [253.15, 273.15, 313.15] {
        // 2 % of scatter on slopes of 0.5 at most, over up to five pairs of sweeps.
        let decades = (shift.ln_factor(kelvin).unwrap() - truth.ln_factor(kelvin).unwrap()) / 10f64.ln();
        assert!(decades.abs() < 0.25, "{kelvin}: {decades}");
    }
    // The factors are about the reference, also where it lies between two sweeps.
    let object = json(&fit(&["--estimate-shift", "2 °C", "--json"]));
    for factor in object["shift_factors"].as_array().unwrap() {
        let kelvin = factor["temperature"].as_f64().unwrap();
        let exact = (truth.ln_factor(kelvin).unwrap() - truth.ln_factor(275.15).unwrap()) / 10f64.ln();
        let decades = factor["log10_factor"].as_f64().unwrap() - exact;
        // The warmest pair is known to 0.22 decades.
        assert!(decades.abs() < 0.25, "{kelvin}: {decades}");
    }
    // Without -o the block is printed after the report.
    let text = stdout(&fit(&[&wlf[..], &["--max-terms", "6", "--max-misfit", "0.9"]].concat()));
    assert!(
        text.contains("terms       6") && text.contains("material = {") && text.contains("wlf"),
        "{text}"
    );
}

#[test]
fn a_fit_says_what_is_wrong() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    write("plain.csv", "1, 3\n10, 2\n100, 1\n");
    write("soft.csv", "t [s], E [MPa]\n1, 3\n10, x\n100, 1\n");
    let rubber = examples().join("data/rubber-dma.csv");
    let rubber = rubber.to_str().unwrap();
    for (arguments, words) in [
        (&["plain.csv"][..], &["--kind"][..]),
        (&["soft.csv"], &["soft.csv, line 3", "\"x\" is not a finite number"]),
        (&["none.csv"], &["none.csv", "does not exist"]),
        (&[rubber, "--wlf", "8.86, 20 °C"], &["--wlf", "8.86, 101.6 K, 20 °C"]),
        (&[rubber, "--wlf", "8.86, 101.6 °C, 20 °C"], &["c2 of --wlf", "difference of temperatures"]),
        (&[rubber, "--estimate-shift", "20"], &["--estimate-shift is \"20\"", "20 °C"]),
        (&[rubber, "--wlf", "8.86, 101.6, 20"], &["reference of --wlf", "20 °C"]),
        (&["plain.csv", "--kind", "creep", "--column", "tim=1"], &["--column", "tim", "time, modulus"]),
        (&["plain.csv", "--kind", "creep", "--unit", "time"], &["--unit", "QUANTITY="]),
        (
            &["plain.csv", "--kind", "relaxation", "--unit", "time=s", "--unit", "time=h"],
            &["--unit is given twice for time", "\"s\""],
        ),
        (
            &["plain.csv", "--kind", "relaxation", "--unit", "temperature=K"],
            &["a unit is given", "temperature"],
        ),
        (&["plain.csv", "--kind", "relaxation", "--window", "1 s"], &["--window"]),
        (&["plain.csv", "--kind", "relaxation", "--max-terms", "0"], &["most terms"]),
        (&["plain.csv", "--kind", "relaxation", "--plot", "p.gif"], &["p.gif: the ending"]),
    ] {
        let output = asperity(dir.path(), &[&["material", "fit"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        for word in words {
            assert!(stderr(&output).contains(word), "{arguments:?}: {}", stderr(&output));
        }
    }
    // Hints are options of the command.
    write("half.csv", "f [Hz], E' [MPa]\n1, 2\n2, 3\n");
    let output = asperity(dir.path(), &["material", "fit", "half.csv", "--kind", "dma"]);
    assert!(stderr(&output).contains("--column loss=N"), "{}", stderr(&output));
    // A frequency without a unit may be cycles or radians; the columns are named.
    write("good.csv", "frequency,storage,loss\n1,2e6,3e5\n2,3e6,4e5\n");
    let output = asperity(dir.path(), &["material", "fit", "good.csv"]);
    for words in ["give Hz", "the columns are 1 \"frequency\", 2 \"storage\", 3 \"loss\""] {
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
    // A loss modulus without a unit is not taken in Pa beside a storage modulus in MPa.
    write("mixed.csv", "f [Hz],E' [MPa],E''\n1,2,0.3\n2,3,0.4\n");
    let output = asperity(dir.path(), &["material", "fit", "mixed.csv"]);
    for words in ["loss (column 3, \"E''\") names no unit, and storage is in MPa", "--unit 'loss="] {
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
    // Without units the numbers are SI, and that is said.
    let output = asperity(dir.path(), &["material", "fit", "plain.csv", "--kind", "relaxation"]);
    assert!(stdout(&output).contains("names no unit and is taken in Pa"), "{}", stdout(&output));
    let output = asperity(dir.path(), &["material", "show", "plain.csv"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let output = asperity(dir.path(), &["material", "show", rubber, "--from", "1 Pa"]);
    assert!(stderr(&output).contains("--from"), "{}", stderr(&output));
}

#[test]
fn check_and_run_tell_where_a_material_comes_from() {
    let dir = tempfile::tempdir().unwrap();
    let case = examples().join("rubber-dma.toml");
    let case = case.to_str().unwrap();
    let small = ["--set", "domain.cells=[32, 32]", "--set", "time.steps=11"];
    let text = stdout(&asperity(dir.path(), &[&["check", case], &small[..]].concat()));
    for word in
        ["fit of data/rubber-dma.csv: 104 points", "misfit", "8 temperatures", "-15.00 °C to 20.00 °C"]
    {
        assert!(text.contains(word), "{word}: {text}");
    }
    let long = ["--set", "time.end=10000 s"];
    let run = asperity(dir.path(), &[&["run", case, "-o", "r.zarr"], &small[..], &long[..]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    let said = stderr(&run);
    assert!(said.contains("warning: rubber: the run needs") && said.contains("fit of data"), "{said}");
    // The result says it too.
    let group = std::fs::read_to_string(dir.path().join("r.zarr/zarr.json")).unwrap();
    let group: Value = serde_json::from_str(&group).unwrap();
    let setup: Value = serde_json::from_str(group["attributes"]["setup"].as_str().unwrap()).unwrap();
    assert!(setup["materials"][0]["rms_misfit"].as_f64().unwrap() < 0.03, "{setup}");
    assert!(setup["md5_of_files"]["data/rubber-dma.csv"].is_string() && setup["warnings"][0].is_string());
}

/// A shear modulus taken as Young's makes a rubber three times too soft.
#[test]
fn the_header_says_which_modulus_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let curve = |symbol: &str| {
        let rows: String = (0..20)
            .map(|k| 10f64.powf(f64::from(k) / 6.0))
            .map(|t| format!("{t},{}\n", 1.0 + 2.0 * (-t / 10.0).exp()))
            .collect();
        format!("t [s],{symbol} [MPa]\n{rows}")
    };
    let fit = |symbol: &str, more: &[&str]| {
        std::fs::write(dir.path().join("data.csv"), curve(symbol)).unwrap();
        let kind = ["material", "fit", "data.csv", "--kind", "relaxation", "--json"];
        let object = json(&asperity(dir.path(), &[&kind[..], more].concat()));
        let block = object["material"].as_str().unwrap().to_owned();
        let modulus = if block.contains("\"shear\"") { "shear" } else { "young" };
        (modulus, object["notes"].to_string() + &object["findings"].to_string())
    };
    for (symbol, options, modulus, note) in [
        ("G(t)", &[][..], "shear", ""),
        ("E", &[], "young", ""),
        ("shear modulus", &["--column", "modulus=2"], "shear", ""),
        ("modulus", &[], "young", "does not say which"),
        (
            "G(t)",
            &["--modulus", "young"],
            "young",
            "names shear moduli (G), but the numbers are taken as Young's",
        ),
        (
            "E",
            &["--modulus", "shear"],
            "shear",
            "names Young's moduli (E), but the numbers are taken as shear",
        ),
    ] {
        let (found, notes) = fit(symbol, options);
        assert_eq!(found, modulus, "{symbol} {options:?}");
        assert!(notes.contains(note) && (note.is_empty() != notes.contains("header")), "{symbol}: {notes}");
    }
}

/// A polymer with a glass transition: 13 terms over twelve decades.
fn polymer() -> asperity::material::Relaxation {
    let weights = [3.0, 8.0, 20.0, 60.0, 90.0, 40.0, 25.0, 10.0, 6.0, 3.0, 1.5, 0.8, 0.3];
    let terms: Vec<(f64, f64)> =
        weights.iter().enumerate().map(|(k, w)| (1e7 * w, 2.3 * 10f64.powi(k as i32 - 7))).collect();
    asperity::material::Relaxation::absolute(5e6, &terms).unwrap()
}

/// A master curve as a user of Python keeps it: a line of units under the names, a loss modulus that contradicts the storage
/// modulus, and its shift factors in a file of their own.
fn master(dir: &Path) {
    let mut text = "f, E_stor, E_loss\nHz, MPa, MPa\n".to_owned();
    for k in 0..150 {
        let f = 10f64.powf(-7.0 + 14.0 * f64::from(k) / 149.0);
        let (storage, loss) = polymer().complex(std::f64::consts::TAU * f);
        text += &format!("{f:e},{},{}\n", 1e-6 * storage, 1.5e-6 * loss);
    }
    std::fs::write(dir.join("master.csv"), text).unwrap();
    let factors = "\u{feff}T,log_aT\nC, -\n60,-4.5\n40,-2.5\n20,0\n0,4.2\n";
    std::fs::write(dir.join("shift.csv"), factors).unwrap();
}

#[test]
fn moduli_that_contradict_each_other_are_fitted_one_at_a_time() {
    let dir = tempfile::tempdir().unwrap();
    master(dir.path());
    let fit = |more: &[&str]| asperity(dir.path(), &[&["material", "fit", "master.csv"], more].concat());
    // The loss moduli of the file times a factor.
    let text = std::fs::read_to_string(dir.path().join("master.csv")).unwrap();
    let write = |name: &str, factor: f64| {
        let line = |line: &str| {
            let mut words: Vec<String> = line.split(',').map(str::to_owned).collect();
            if let Ok(loss) = words[2].parse::<f64>() {
                words[2] = (factor * loss).to_string();
            }
            words.join(",") + "\n"
        };
        std::fs::write(dir.path().join(name), text.lines().map(line).collect::<String>()).unwrap();
    };
    // 1.3 times that of the material: between both moduli, and told.
    write("between.csv", 1.3 / 1.5);
    let object = json(&asperity(dir.path(), &["material", "fit", "between.csv", "--json"]));
    let told = object["findings"][0]["text"].as_str().unwrap();
    for words in
        ["from the storage modulus by", "from the loss modulus by", "Kramers-Kronig", "--fit storage"]
    {
        assert!(told.contains(words), "{words}: {told}");
    }
    // 4.5 times: refused.
    write("apart.csv", 3.0);
    let refused = asperity(dir.path(), &["material", "fit", "apart.csv"]);
    assert_eq!(refused.status.code(), Some(2));
    let words = stderr(&refused);
    for word in ["storage modulus alone is fitted to", "Kramers-Kronig", "--fit storage"] {
        assert!(words.contains(word), "{word}: {words}");
    }
    let object = json(&fit(&["--fit", "storage", "--shift-table", "shift.csv", "-o", "m.toml", "--json"]));
    let column = |name: &str, key: &str| object["columns"][name][key].as_f64().unwrap();
    // Nothing scatters; two terms per decade of 14 reach the digits that the criterion counts.
    assert!(column("storage", "misfit_rms") < 0.02, "{object}");
    assert!(object["terms"].as_u64().unwrap() <= 28);
    // 1/1.5 - 1.
    assert!((column("loss", "misfit_rms") - 1.0 / 3.0).abs() < 0.02, "{object}");
    assert!(object["findings"][0]["text"].as_str().unwrap().contains("loss modulus deviates"), "{object}");
    let Value::Array(factors) = &object["shift"]["ln_factors"] else { panic!("{object}") };
    assert_eq!(factors.len(), 4);
    // The material stands in a file, and leaves it for another program.
    let to = |to: &str| {
        let output = asperity(dir.path(), &["material", "export", "m.toml", "--to", to, "--poisson", "0.45"]);
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output)
    };
    assert!(to("abaqus").contains("*VISCOELASTIC, TIME=PRONY") && to("ansys").contains("TB,PRONY,1,1,"));
    assert!(
        to("comsol").lines().any(|line| line.starts_with("1 "))
            && to("csv").contains("time [s],modulus [Pa]")
    );
    let output = asperity(dir.path(), &["material", "export", "m.toml", "--to", "abaqus"]);
    assert!(stderr(&output).contains("--poisson"), "{}", stderr(&output));
    // The fewest terms for two per cent are fewer than for a tenth of it.
    let terms = |misfit: &str| {
        let object = json(&fit(&["--fit", "storage", "--misfit", misfit, "--json"]));
        let rms = object["columns"]["storage"]["misfit_rms"].as_f64().unwrap();
        assert!(rms <= misfit.parse::<f64>().unwrap(), "{misfit}: {rms}");
        object["terms"].as_u64().unwrap()
    };
    assert!(terms("0.02") < terms("0.002"));
}

#[test]
fn relaxation_at_several_temperatures_needs_no_option() {
    let dir = tempfile::tempdir().unwrap();
    let law = asperity::material::Shift::Wlf { c1: 10.0, c2: 110.0, reference: 293.15 };
    let mut text = "t,E_relax,T,Set\ns,MPa,°C,-\n".to_owned();
    let temperatures = [-12.0, -4.0, 4.0, 12.0, 20.0, 28.0, 36.0];
    for (set, celsius) in temperatures.iter().enumerate() {
        let a = law.factor(celsius + 273.15).unwrap();
        // As a machine saves them: the last time first, the temperature not quite held.
        for k in (0..13).rev() {
            let t = 10f64.powf(-2.0 + 0.25 * f64::from(k));
            let value = 1e-6 * polymer().value(t / a);
            text += &format!("{t},{value},{},{set}\n", celsius + 0.02 * f64::from(k % 3));
        }
    }
    std::fs::write(dir.path().join("raw.csv"), text).unwrap();
    let shown = stdout(&asperity(dir.path(), &["material", "show", "raw.csv", "--plot", "raw.svg"]));
    for word in ["\"E_relax\"", "modulus", "[MPa]", "set", "28.0 °C: 13 points", "Young's"] {
        assert!(shown.contains(word), "{word}: {shown}");
    }
    let svg = std::fs::read_to_string(dir.path().join("raw.svg")).unwrap();
    assert!(svg.contains("temperature [°C]") && svg.contains("7 sweeps, 91 points"), "{svg}");
    let object = json(&asperity(dir.path(), &["material", "fit", "raw.csv", "--json"]));
    assert!(object["notes"].to_string().contains("about 20.0 °C"), "{object}");
    for factor in object["shift_factors"].as_array().unwrap() {
        let number = |key: &str| factor[key].as_f64().unwrap();
        let truth = law.ln_factor(number("temperature")).unwrap() / 10f64.ln();
        // What is asked of an estimate where sweeps overlap by half a decade.
        assert!((number("log10_factor") - truth).abs() < 0.3, "{factor}: {truth}");
    }
    let below = asperity(dir.path(), &["material", "fit", "raw.csv", "--estimate-shift", "-4 °C", "--json"]);
    assert!(json(&below)["shift"].to_string().contains("269.15"), "{}", stdout(&below));
}

#[test]
fn moduli_that_grow_with_temperature_take_a_vertical_shift() {
    let dir = tempfile::tempdir().unwrap();
    let law = asperity::material::Shift::Wlf { c1: 10.0, c2: 110.0, reference: 293.15 };
    let mut text = "f [Hz],E' [MPa],E'' [MPa],T [°C]\n".to_owned();
    for celsius in [0.0, 10.0, 20.0, 30.0, 45.0, 60.0] {
        let kelvin = celsius + 273.15;
        for k in 0..25 {
            let f = 10f64.powf(-3.0 + 0.2 * f64::from(k));
            let (storage, loss) = polymer().complex(std::f64::consts::TAU * f * law.factor(kelvin).unwrap());
            let scale = 1e-6 * kelvin / 293.15;
            text += &format!("{f:e},{},{},{celsius}\n", scale * storage, scale * loss);
        }
    }
    std::fs::write(dir.path().join("warm.csv"), text).unwrap();
    let fit = |more: &[&str]| {
        let same = ["material", "fit", "warm.csv", "--wlf", "10,110K,20°C"];
        asperity(dir.path(), &[&same, more].concat())
    };
    let rms = |more: &[&str]| json(&fit(&[more, &["--json"]].concat()))["misfit"]["rms"].as_f64().unwrap();
    let (none, density, free) =
        (rms(&[]), rms(&["--vertical", "density"]), rms(&["--vertical", "free", "--plot", "free.svg"]));
    // Exact but for the terms that stand for the polymer's; free factors come from polynomials.
    assert!(density < 1e-3 && free < 0.3 * none && none > 0.01, "{none} {density} {free}");
    let svg = std::fs::read_to_string(dir.path().join("free.svg")).unwrap();
    assert!(svg.contains("vertical shift factor b_T"));
    let report = stdout(&fit(&["--vertical", "density", "--window", "0.1Hz,100Hz", "-o", "m.toml"]));
    assert!(
        report.contains("60.0 °C  b_T = 0.8799") && report.contains("1.000e-1 Hz to 1.000e2 Hz"),
        "{report}"
    );
    let block = std::fs::read_to_string(dir.path().join("m.toml")).unwrap();
    assert!(block.contains("vertical = \"density\""), "{block}");
    // What is written is read, and told to another program.
    let exported = asperity(dir.path(), &["material", "export", "m.toml", "--to", "csv"]);
    assert!(stdout(&exported).contains("over b_T"), "{}", stderr(&exported));
    let alone = stderr(&fit(&["--expansion", "6e-4 1/K"]));
    assert!(alone.contains("--vertical density"), "{alone}");
}

#[test]
fn a_temperature_ramp_is_shown_over_temperature() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let rows: String =
        (0..21).map(|n| format!("{}, 1, {}, {}\n", 3 * n - 30, 400 - 15 * n, 80 - 3 * n)).collect();
    std::fs::write(
        path.join("ramp.csv"),
        format!("temperature [°C], frequency [Hz], storage [MPa], loss [MPa]\n{rows}"),
    )
    .unwrap();
    let output = asperity(path, &["material", "show", "ramp.csv", "--plot", "ramp.svg"]);
    let told = String::from_utf8(output.stdout).unwrap();
    let ramp = "a temperature ramp, -30.0 °C to 30.0 °C: 21 temperatures, 21 points, 1 Hz";
    assert!(output.status.success() && told.contains(ramp) && !told.contains("1 point,"), "{told}");
    // No two of its temperatures overlap.
    let output = asperity(path, &["material", "fit", "ramp.csv"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("a ramp"), "{}", stderr(&output));
    let picture = std::fs::read_to_string(path.join("ramp.svg")).unwrap();
    assert!(picture.contains("temperature [°C]") && !picture.contains("frequency [Hz]"));
}
