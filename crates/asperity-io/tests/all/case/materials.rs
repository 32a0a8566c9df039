//! Materials of a case: fractional models, measured curves, temperature.

use asperity::Drive;
use std::fmt::Write;
use std::path::Path;

use asperity::March;
use asperity::material::{Fractional, Lateral, Relaxation, Shift};
use asperity_io::Code;
use asperity_io::case::{Case, CaseError};

use crate::wording;

/// A case with these bodies and further sections, 10 steps to 100 s.
fn text(bodies: &str, more: &str) -> String {
    format!(
        r#"
[domain]
cells = [16, 16]
size = ["2 mm", "2 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
{bodies}
[load]
control = "load"
history = {{ kind = "ramp", value = "0.1 N", duration = "10 s" }}
[time]
end = "100 s"
steps = 10
{more}"#
    )
}

/// An incompressible body: C = J/4 = 3 D/4.
fn body(material: &str) -> String {
    format!("[[body]]\npoisson = 0.5\nmaterial = {material}\n")
}

#[track_caller]
fn case_in(dir: &Path, bodies: &str, more: &str) -> Case {
    Case::parse(&text(bodies, more), dir, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

#[track_caller]
fn case(bodies: &str, more: &str) -> Case {
    case_in(Path::new("."), bodies, more)
}

fn files(list: &[(&str, &str)]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in list {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    dir
}

/// E(t) = 1 MPa + 2 MPa exp(-t/5 s).
fn solid() -> Relaxation {
    Relaxation::absolute(1e6, &[(2e6, 5.0)]).unwrap()
}

fn wlf() -> Shift {
    Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 }
}

const WLF: &str = r#"{ model = "wlf", c1 = 8.86, c2 = "101.6 K", reference = "20 °C" }"#;

/// G0, G∞ and the relaxation time τ are a Zener solid of G = G0, G_K = G0 G∞/(G0 - G∞), λ = τ G0/G∞.
#[test]
fn a_standard_linear_solid_is_a_zener_solid() {
    let solid = |more: &str| {
        format!(
            r#"{{ model = "standard-linear-solid", shear_equilibrium = "1 MPa", relaxation_time = "2 s"{more} }}"#
        )
    };
    let zener = r#"{ model = "zener", shear = "4 MPa", shear_kelvin = 1.3333333333333333e6, retardation_time = "8 s" }"#;
    let (found, known) = (
        case(&body(&solid(", shear_instantaneous = \"4 MPa\"")), "").conditions.creep,
        case(&body(zener), "").conditions.creep,
    );
    for t in [0.0, 0.5, 8.0, 1e3] {
        // Rounding of the conversion.
        assert!((found.value(t) / known.value(t) - 1.0).abs() < 1e-13, "{t}");
    }
    let dir = Path::new(".");
    let at = "body[0].material";
    says(dir, &solid(""), at, "missing-key", &[]);
    says(dir, &solid(", shear_instantaneous = 1e5"), at, "conflict", &[]);
}

/// 60 points from 10 ms to 1000 s of a function of time.
fn curve(header: &str, value: impl Fn(f64) -> f64) -> String {
    let mut text = format!("{header}\n");
    for k in 0..60 {
        let t = 10f64.powf(-2.0 + 5.0 * f64::from(k) / 59.0);
        writeln!(text, "{t:.9e}, {:.9e}", value(t)).unwrap();
    }
    text
}

/// Sweeps of [`solid`] from 1 mHz to 10 Hz at these temperatures in °C.
fn sweeps(temperatures: &[f64]) -> String {
    let mut text = "T [°C]\tf [Hz]\tE' [MPa]\tE'' [MPa]\n".to_owned();
    for celsius in temperatures {
        let a = wlf().factor(celsius + 273.15).unwrap();
        for k in 0..25 {
            let hertz = 10f64.powf(-3.0 + f64::from(k) / 6.0);
            let (storage, loss) = solid().complex(std::f64::consts::TAU * hertz * a);
            writeln!(text, "{celsius}\t{hertz:.9e}\t{:.9e}\t{:.9e}", 1e-6 * storage, 1e-6 * loss).unwrap();
        }
    }
    text.replace('.', ",")
}

#[test]
fn fractional_models_keep_their_error_over_the_run() {
    let springpot = Fractional::Springpot { modulus: 1e6, time: 2.0, order: 0.3 };
    let maxwell = Fractional::Maxwell { modulus: 1e6, time: 2.0, order: 0.3 };
    let zener = Fractional::Zener { equilibrium: 1e6, instantaneous: 1e9, time: 1e-3, order: 0.5 };
    for (model, text, tolerance) in [
        (springpot, r#"{ model = "springpot", shear = "1 MPa", time = "2 s", order = 0.3 }"#, 1e-3),
        (
            springpot,
            r#"{ model = "springpot", shear = "1 MPa", time = "2 s", order = 0.3, tolerance = 1e-5 }"#,
            1e-5,
        ),
        (maxwell, r#"{ model = "fractional-maxwell", shear = "1 MPa", time = "2 s", order = 0.3 }"#, 1e-3),
        (
            zener,
            r#"{ model = "fractional-zener", shear_equilibrium = "1 MPa", shear_instantaneous = "1 GPa", time = "1 ms", order = 0.5 }"#,
            1e-3,
        ),
    ] {
        let case = case(&body(text), "");
        for t in [10.0, 25.0, 63.0, 100.0] {
            let error = (case.conditions.creep.value(t) / (0.25 * model.creep(t)) - 1.0).abs();
            assert!(error <= 1.05 * tolerance, "{text}: {error:e} at {t}");
        }
        let description = case.describe();
        let report = &description.materials[0];
        // From the smallest step to the end.
        assert_eq!(report.window, Some([10.0, 100.0]), "{text}");
        assert!(report.error.unwrap() <= tolerance && report.terms > 1, "{report:?}");
        assert!(case.conditions.creep.instantaneous > 0.0 && description.warnings.is_empty());
    }
    // Half the time per step on the clock at a_T = 2: a window of half the times.
    let shifted = format!(
        r#"{{ model = "springpot", shear = "1 MPa", time = "2 s", order = 0.3, shift = {{ model = "table", points = [["0 °C", {}], ["20 °C", 0.0]] }}, temperature = "0 °C" }}"#,
        2f64.log10()
    );
    let case = case(&body(&shifted), "");
    let [first, last] = case.describe().materials[0].window.unwrap();
    assert!((first - 5.0).abs() < 1e-12 && (last - 50.0).abs() < 1e-12, "{first} {last}");
    assert!((case.conditions.creep.value(80.0) / (0.25 * springpot.creep(40.0)) - 1.0).abs() < 1.05e-3);
}

#[test]
fn a_prony_table_relative_to_the_relaxed_modulus() {
    let ratio = r#"{ model = "prony", modulus = "young", equilibrium = "1 MPa", terms = [{ ratio = 2, time = "5 s" }] }"#;
    let absolute = r#"{ model = "prony", modulus = "young", equilibrium = "1 MPa", terms = [{ modulus = "2 MPa", time = "5 s" }] }"#;
    assert_eq!(case(&body(ratio), "").conditions.creep, case(&body(absolute), "").conditions.creep);
}

#[test]
fn tables_of_relaxation_and_creep_become_materials() {
    let creep = solid().to_creep().unwrap();
    let relaxation = |t: f64| 1e-6 * solid().value(t);
    let compliance = |t: f64| 1e6 * creep.value(t);
    let dir = files(&[
        ("named.csv", &curve("t [s], E [MPa]", relaxation)),
        ("swapped.csv", &curve("y, x", relaxation)),
        ("creep.csv", &curve("# measured in May\ntime [s], D [1/MPa]", compliance)),
        ("comma.csv", &curve("t/s, E/MPa", relaxation).replace(", ", ";").replace('.', ",")),
    ]);
    for material in [
        r#"{ model = "relaxation-table", path = "named.csv", modulus = "young" }"#,
        r#"{ model = "relaxation-table", path = "comma.csv", modulus = "young", fit = { max_terms = 3, long_time = "solid" } }"#,
        r#"{ model = "relaxation-table", path = "swapped.csv", modulus = "young", columns = { time = "y", modulus = 2 }, units = { time = "s", modulus = "MPa" } }"#,
        r#"{ model = "creep-table", path = "creep.csv", compliance = "young" }"#,
    ] {
        let case = case_in(dir.path(), &body(material), "");
        for t in [0.0, 0.1, 3.0, 80.0, 1e3] {
            let wanted = 0.75 * creep.value(t);
            // Nine digits in the file; the fit ends at residuals of 1e-7.
            assert!((case.conditions.creep.value(t) / wanted - 1.0).abs() < 1e-5, "{material} {t}");
        }
        let report = &case.describe().materials[0];
        assert_eq!((report.terms, report.points), (1, Some(60)), "{report:?}");
        assert!(report.max_misfit.unwrap() < 1e-6 && report.rms_misfit <= report.max_misfit);
        assert_eq!(case.files.len(), 1);
    }
}

#[test]
fn a_part_of_a_curve_is_fitted_where_the_window_says_so() {
    let dir = files(&[("named.csv", &curve("t [s], E [MPa]", |t| 1e-6 * solid().value(t)))]);
    let material = r#"{ model = "relaxation-table", path = "named.csv", modulus = "young", fit = { window = ["1 s", "100 s"] } }"#;
    let report = case_in(dir.path(), &body(material), "").describe().materials[0].clone();
    // Twelve points per decade of five.
    assert_eq!(report.points, Some(24), "{report:?}");
    let [first, last] = report.window.unwrap();
    assert!(first >= 1.0 && last <= 100.0);
}

#[test]
fn dma_sweeps_at_several_temperatures_become_one_material() {
    let dir = files(&[("one.csv", &sweeps(&[20.0])), ("five.csv", &sweeps(&[0.0, 10.0, 20.0, 30.0, 40.0]))]);
    let creep = solid().to_creep().unwrap();
    let check = |material: &str, tolerance: f64| {
        let case = case_in(dir.path(), &body(material), "");
        for t in [0.1, 3.0, 80.0] {
            let error = (case.conditions.creep.value(t) / (0.75 * creep.value(t)) - 1.0).abs();
            assert!(error < tolerance, "{material} {t}: {error}");
        }
        case.describe().materials[0].clone()
    };
    check(r#"{ model = "dma", path = "one.csv", modulus = "young" }"#, 1e-5);
    let report =
        check(&format!(r#"{{ model = "dma", path = "five.csv", modulus = "young", shift = {WLF} }}"#), 1e-5);
    assert_eq!((report.temperatures.len(), report.points), (5, Some(125)));
    // Shifts from polynomials in place of the curves, over up to two pairs.
    let estimated = r#"{ model = "dma", path = "five.csv", modulus = "young", shift = { model = "estimated", reference = "20 °C" } }"#;
    let report = check(estimated, 0.02);
    assert!(report.shift.unwrap().contains("WLF"));
}

#[test]
fn what_a_fit_knows_of_its_data_is_a_finding_of_the_case() {
    // Between 30 and 70 °C, by two decades, the sweeps hardly overlap.
    let wide = sweeps(&[0.0, 10.0, 20.0, 30.0, 70.0]);
    let dir =
        files(&[("wide.csv", &wide), ("young.csv", &curve("t [s], E [MPa]", |t| 1e-6 * solid().value(t)))]);
    let codes = |material: &str| -> Vec<String> {
        let case = case_in(dir.path(), &body(material), "");
        case.examine().unwrap().findings.iter().map(|finding| finding.code.to_string()).collect()
    };
    let estimated = r#"{ model = "dma", path = "wide.csv", modulus = "young", shift = { model = "estimated", reference = "20 °C" } }"#;
    let found = codes(estimated);
    assert!(found.contains(&"shift-uncertain".to_owned()), "{found:?}");
    let table = |modulus: &str| {
        format!("{{ model = \"relaxation-table\", path = \"young.csv\", modulus = \"{modulus}\" }}")
    };
    assert!(codes(&table("shear")).contains(&"modulus-kind".to_owned()));
    assert!(!codes(&table("young")).contains(&"modulus-kind".to_owned()));
}

#[test]
fn the_loss_factor_stands_for_the_loss_modulus() {
    let mut text = "angular frequency [rad/s], E' [MPa], tan(delta) [-]\n".to_owned();
    for k in 0..40 {
        let omega = 10f64.powf(-2.0 + 0.1 * f64::from(k));
        let (storage, loss) = solid().complex(omega);
        writeln!(text, "{omega:.9e}, {:.9e}, {:.9e}", 1e-6 * storage, loss / storage).unwrap();
    }
    let dir = files(&[("tan.csv", &text)]);
    let case = case_in(dir.path(), &body(r#"{ model = "dma", path = "tan.csv", modulus = "young" }"#), "");
    let wanted = 0.75 * solid().to_creep().unwrap().value(7.0);
    assert!((case.conditions.creep.value(7.0) / wanted - 1.0).abs() < 1e-5);
}

/// A Zener solid with a shift; more keys.
fn shifted(more: &str) -> String {
    format!(
        r#"{{ model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "2 s", shift = {WLF}{more} }}"#
    )
}

#[test]
fn a_constant_temperature_stretches_the_times() {
    let at = |celsius: f64| 0.25e-6 * (2.0 - (-3.0 / (2.0 * wlf().factor(celsius + 273.15).unwrap())).exp());
    let constant = "[temperature]\nhistory = { kind = \"constant\", value = \"35 °C\" }\n";
    let kelvin =
        "[temperature]\nhistory = { kind = \"table\", points = [[0, 308.15], [\"50 s\", \"308.15 K\"]] }\n";
    for (material, more, celsius) in [
        (shifted(""), "", 20.0), // and a note says so, see below
        (shifted(", temperature = \"35 °C\""), "", 35.0),
        (shifted(""), constant, 35.0),
        (shifted(""), kelvin, 35.0),
    ] {
        let case = case(&body(&material), more);
        assert!(case.conditions.thermal.is_empty());
        assert!((case.conditions.creep.value(3.0) / at(celsius) - 1.0).abs() < 1e-12, "{material} {more}");
        let untold: Vec<_> =
            case.findings.iter().filter(|finding| finding.code == "at-reference-temperature").collect();
        let told = celsius != 20.0;
        assert!(untold.len() == usize::from(!told), "{material} {more}: {untold:?}");
        assert!(untold.iter().all(|finding| !finding.is_warning() && finding.text.contains("20 °C")));
        let factor = case.describe().materials[0].shift_factor.unwrap();
        assert!((factor / wlf().factor(celsius + 273.15).unwrap() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_vertical_shift_divides_the_moduli_at_a_constant_temperature() {
    let with = |vertical: &str, more: &str| {
        shifted(more)
            .replace("reference = \"20 °C\" }", &format!("reference = \"20 °C\", vertical = {vertical} }}"))
    };
    let warm = ", temperature = \"80 °C\"";
    let plain = case(&body(&shifted(warm)), "").conditions.creep;
    let volume = 1.0 + 6e-4 * 60.0;
    for (vertical, b) in [
        ("\"density\"", 293.15 / 353.15),
        ("{ expansion = \"6e-4 1/K\" }", 293.15 / 353.15 * volume),
        ("[[\"20 °C\", 1.0], [\"100 °C\", 0.81]]", 0.9f64.powf(1.5)),
    ] {
        let case = case(&body(&with(vertical, warm)), "");
        for t in [0.0, 1e-3, 3.0, 100.0] {
            // Moduli over b_T: compliances times b_T.
            assert!(
                (case.conditions.creep.value(t) / (b * plain.value(t)) - 1.0).abs() < 1e-12,
                "{vertical} {t}"
            );
        }
        let report = &case.describe().materials[0];
        assert!((report.vertical_factor.unwrap() / b - 1.0).abs() < 1e-12 && report.vertical.is_some());
    }
    // At the reference there is no change.
    assert_eq!(
        case(&body(&with("\"density\"", "")), "").conditions.creep,
        case(&body(&shifted("")), "").conditions.creep
    );
    let refused = |material: &str, more: &str, words: &str| {
        let Err(errors) = Case::parse(&text(&body(material), more), Path::new(""), &[]) else {
            panic!("accepted: {material} {more}")
        };
        assert!(errors.to_string().contains(words), "{errors}");
    };
    let ramp = "[temperature]\nhistory = { kind = \"ramp\", from = \"10 °C\", to = \"30 °C\", duration = \"35 s\" }\n";
    refused(&with("\"density\"", ""), ramp, "moduli that change during a run are not solved");
    refused(&with("\"free\"", ""), "", "only from a file with several temperatures");
    refused(&with("\"dense\"", ""), "", "pairs [temperature, b_T]");
    refused(&with("[[\"20 °C\", 1.0], [\"40 °C\", 0.9]]", warm), "", "as the vertical shift factors are");
    refused(&with("[[\"20 °C\", -1.0]]", warm), "", "shift.vertical[0][1] is -1.0");
}

#[test]
fn a_temperature_history_gives_each_body_its_clock() {
    let dir = files(&[("t.csv", "time [min], T [°C]\n0, 10\n1, 30\n1, 20\n")]);
    let other = r#"{ model = "maxwell", young = "1 GPa", relaxation_time = "9 s", shift = { model = "arrhenius", energy = "120 kJ/mol", reference = "20 °C" } }"#;
    let elastic = r#"{ model = "elastic", young = "70 GPa" }"#;
    let history = "[temperature]\nhistory = { kind = \"file\", path = \"t.csv\" }\n";
    let case = case_in(dir.path(), &(body(&shifted("")) + &body(other)), history);
    assert_eq!(case.conditions.thermal.len(), 2);
    assert_eq!(case.conditions.creep.instantaneous, 0.0);
    let arrhenius = Shift::Arrhenius { activation_energy: 120e3, reference: 293.15 };
    // From 60 s on 20 °C is the reference of both.
    for (body, law) in case.conditions.thermal.iter().zip([wlf(), arrhenius]) {
        assert!((body.clock.elapsed(60.0, 100.0) - 40.0).abs() < 1e-12);
        assert!(body.clock.value(1.0) < 1.001 / law.factor(283.15).unwrap() + 0.1);
    }
    assert_eq!(case.describe().temperature, Some([283.15, 303.15]));
    assert_eq!(case.files[0].0, "t.csv");

    // An elastic counter-body has no clock; the break of the temperature is a step.
    let case = case_in(dir.path(), &(body(&shifted("")) + &body(elastic)), history);
    assert_eq!((case.conditions.thermal.len(), case.conditions.creep.terms.len()), (1, 0));
    assert!(case.conditions.creep.instantaneous > 0.0);
    let ramp = "[temperature]\nhistory = { kind = \"ramp\", from = \"10 °C\", to = \"30 °C\", duration = \"35 s\" }\n";
    let case = case_in(dir.path(), &body(&shifted("")), ramp);
    let mut march = March::new(case.simulation().unwrap()).unwrap();
    assert_eq!(march.rows_expected(), case.describe().rows);
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    assert!(rows.iter().any(|row| row.time() == 35.0));
    // After the load has risen to 0.1 N at 10 s the contact only grows, to the solver's tolerance.
    assert!(rows[1..].windows(2).all(|pair| pair[0].approach <= pair[1].approach * (1.0 + 1e-5)));
}

#[test]
fn a_bulk_modulus_goes_with_every_model() {
    let bulk = |material: &str| format!("[[body]]\nbulk_modulus = \"4 GPa\"\nmaterial = {material}\n");
    let case = case(&bulk(&shifted(", temperature = \"35 °C\"")), "");
    assert_eq!(case.bodies[0].lateral, Lateral::BulkModulus(4e9));
    // C(0) = (1/4) [1/G + 3/(3 B + G)]
    let wanted = 0.25 * (1e-6 + 3.0 / (12e9 + 1e6));
    assert!((case.conditions.creep.instantaneous / wanted - 1.0).abs() < 1e-12);
}

#[test]
fn a_run_beyond_the_data_is_warned_of_with_the_numbers() {
    let dir = files(&[("named.csv", &curve("t [s], E [MPa]", |t| 1e-6 * solid().value(t)))]);
    let material = r#"{ model = "relaxation-table", path = "named.csv", modulus = "young" }"#;
    assert!(case_in(dir.path(), &body(material), "").describe().warnings.is_empty());
    let long = text(&body(material), "").replace("\"100 s\"", "\"5000 s\"");
    let warnings = Case::parse(&long, dir.path(), &[]).unwrap().describe().warnings;
    assert!(warnings[0].contains("to 5000 s") && warnings[0].contains("0.01 s to 1000 s"), "{warnings:?}");
    assert!(warnings[0].starts_with("body 1: "));
}

/// The first error of a case with this material; the line counts from the material's.
#[track_caller]
fn says(dir: &Path, material: &str, key: &str, code: &str, numbers: &[&str]) -> CaseError {
    let errors = match Case::parse(&text(&body(material), ""), dir, &[]) {
        Ok(_) => panic!("accepted: {material}"),
        Err(errors) => errors.errors,
    };
    let found = &errors[0];
    let shown = found.to_string();
    assert_eq!((found.key.as_str(), found.line), (key, Some(10)), "{shown}");
    assert_eq!(found.code.to_string(), code, "{shown}");
    for number in numbers {
        assert!(shown.contains(number), "{shown:?} lacks {number:?}");
    }
    wording::check(material, dir, found);
    found.clone()
}

#[test]
fn faults_of_models_are_named() {
    let dir = files(&[]);
    let dir = dir.path();
    let at = "body[0].material";
    let springpot = |keys: &str| format!(r#"{{ model = "springpot", shear = "1 MPa", time = "2 s"{keys} }}"#);
    says(
        dir,
        &springpot(", order = 1.5"),
        "body[0].material.order",
        "out-of-range",
        &["greater than 0 and at most 1"],
    );
    says(
        dir,
        &springpot(", order = 0.3, tolerance = 0.5"),
        "body[0].material.tolerance",
        "out-of-range",
        &["from 1e-14 to 0.1"],
    );
    says(dir, &springpot(", order = 0.3, tolerance = 1e-14"), at, "out-of-range", &[]);
    says(dir, &springpot(""), "body[0].material.order", "missing-key", &[]);
    says(
        dir,
        r#"{ model = "fractional-zener", shear_equilibrium = "1 MPa", young_instantaneous = "1 GPa", time = "1 s", order = 0.5 }"#,
        at,
        "conflict",
        &[],
    );
    says(
        dir,
        r#"{ model = "fractional-zener", shear_equilibrium = "2 MPa", shear_instantaneous = "1 MPa", time = "1 s", order = 0.5 }"#,
        at,
        "out-of-range",
        &[],
    );
    let prony = |keys: &str| format!(r#"{{ model = "prony", modulus = "young", {keys} }}"#);
    says(
        dir,
        &prony(
            r#"equilibrium = "1 MPa", terms = [{ ratio = 2, time = 1 }, { modulus = "1 MPa", time = 2 }]"#,
        ),
        "body[0].material.terms[1]",
        "missing-key",
        &[],
    );
    says(
        dir,
        &prony(r#"equilibrium = "1 MPa", terms = [{ fraction = 0.2, time = 1 }]"#),
        "body[0].material.terms[0]",
        "missing-key",
        &[],
    );
    says(
        dir,
        &prony(r#"instantaneous = "1 MPa", terms = [{ ratio = 0.2, time = 1 }]"#),
        "body[0].material.terms[0]",
        "missing-key",
        &[],
    );
    says(
        dir,
        &prony(
            r#"instantaneous = "1 MPa", terms = [{ fraction = 0.7, time = 1 }, { fraction = 0.7, time = 2 }]"#,
        ),
        at,
        "out-of-range",
        &["at most 1"],
    );
    says(
        dir,
        &prony(r#"equilibrium = "1 MPa", terms = [{ modulus = "-1 MPa", time = 1 }]"#),
        "body[0].material.terms[0].modulus",
        "out-of-range",
        &["greater than 0"],
    );
    says(
        dir,
        &prony(r#"equilibrium = "1 MPa", terms = [{ modulus = "1 MPa", time = 0 }]"#),
        "body[0].material.terms[0].time",
        "out-of-range",
        &["greater than 0"],
    );
}

#[test]
fn faults_of_temperature_are_named() {
    let dir = files(&[]);
    let dir = dir.path();
    says(
        dir,
        &shifted("").replace("\"101.6 K\"", "\"101.6 °C\""),
        "body[0].material.shift.c2",
        "wrong-unit",
        &[],
    );
    says(
        dir,
        &shifted("").replace("\"wlf\"", "\"wfl\""),
        "body[0].material.shift.model",
        "unknown-kind",
        &[],
    );
    says(dir, &shifted("").replace("c1 = 8.86, ", ""), "body[0].material.shift.c1", "missing-key", &[]);
    says(
        dir,
        &shifted("").replace("\"20 °C\"", "\"20 C\""),
        "body[0].material.shift.reference",
        "wrong-unit",
        &[],
    );
    // 20 °C - 101.6 K = -81.6 °C, where the WLF law ends.
    says(
        dir,
        &shifted(", temperature = \"-90 °C\""),
        "body[0].material.temperature",
        "out-of-range",
        &["temperature is 183.15", "above 191.5"],
    );
    says(
        dir,
        r#"{ model = "maxwell", shear = "1 MPa", relaxation_time = "1 s", temperature = "30 °C" }"#,
        "body[0].material.temperature",
        "conflict",
        &[],
    );
    says(
        dir,
        r#"{ model = "maxwell", shear = "1 MPa", relaxation_time = "1 s", shift = { model = "estimated", reference = "20 °C" } }"#,
        "body[0].material.shift",
        "conflict",
        &[],
    );
    says(
        dir,
        r#"{ model = "maxwell", shear = "1 MPa", relaxation_time = "1 s", shift = { model = "table", points = [["20 °C", 0], ["10 °C", 1]] } }"#,
        "body[0].material.shift",
        "out-of-range",
        &[],
    );
    says(
        dir,
        r#"{ model = "elastic", shear = "1 MPa", shift = { model = "arrhenius", energy = 1e5, reference = 300 } }"#,
        "body[0].material.shift",
        "conflict",
        &[],
    );

    let section = |material: &str, history: &str, key: &str, words: &[&str]| {
        let more = format!("[temperature]\nhistory = {history}\n");
        let errors = Case::parse(&text(&body(material), &more), dir, &[]).unwrap_err().errors;
        let shown = errors[0].to_string();
        assert!(errors[0].key.starts_with(key), "{shown}: {}", errors[0].key);
        assert!(words.iter().all(|word| shown.contains(word)), "{shown}");
    };
    let zener = shifted("");
    section(
        &zener,
        r#"{ kind = "constant", value = "20 MPa" }"#,
        "temperature.history.value",
        &["a temperature"],
    );
    section(
        &zener,
        r#"{ kind = "constant", value = "-280 °C" }"#,
        "temperature.history.value",
        &["above 0 K"],
    );
    section(&zener, r#"{ kind = "step", value = "20 °C" }"#, "temperature.history", &["constant"]);
    section(
        &zener,
        r#"{ kind = "table", points = [["1 s", "20 °C"]] }"#,
        "temperature.history.points[0]",
        &["a point at 0 s"],
    );
    section(
        &zener,
        r#"{ kind = "table", points = [["0 s", "20 °C"], ["2 s", "20 °C"], ["1 s", "20 °C"]] }"#,
        "temperature.history.points[2]",
        &["2 s or later"],
    );
    section(&zener, r#"{ kind = "table", points = [] }"#, "temperature.history.points", &["one point"]);
    section(
        &zener,
        r#"{ kind = "ramp", from = "20 °C", to = "-100 °C", duration = "1 s" }"#,
        "temperature.history.to",
        &["temperature is 173.15", "above 191.5"],
    );
    section(
        &zener,
        r#"{ kind = "file", path = "none.csv" }"#,
        "temperature.history.path",
        &["does not exist"],
    );
    section(
        r#"{ model = "elastic", shear = "1 MPa" }"#,
        r#"{ kind = "constant", value = "20 °C" }"#,
        "temperature",
        &["none has a `shift`"],
    );
}

#[test]
fn faults_of_measured_curves_are_named_with_their_line() {
    let good = "t [s], E [MPa]\n0.1, 3\n1, 2\n10, 1.5\n100, 1.2\n1000, 1.1\n";
    let dir = files(&[
        ("good.csv", good),
        ("letters.csv", &good.replace("1.5", "soft")),
        ("kilo.csv", &good.replace("1.5", "1500 kPa")),
        ("unit.csv", &good.replace("MPa", "mm")),
        ("typo.csv", &good.replace("MPa", "mpa")),
        ("growing.csv", &good.replace("1.2", "1.9")),
        ("negative.csv", &good.replace("1.5", "-1.5")),
        ("twice.csv", &good.replace("100,", "10,")),
        ("disorder.csv", &good.replace("100,", "5,")),
        ("zero.csv", &good.replace("1, 2", "0, 2")),
        ("short.csv", &good.replace("1, 2", "1")),
        ("point.csv", "t [s], E [MPa]\n1, 2\n"),
        ("empty.csv", ""),
        ("names.csv", "a [s], b [MPa]\n1, 2\n2, 1\n3, 0.9\n"),
        ("hertz.csv", "f [1/s], E' [MPa], E'' [MPa]\n1, 2, 0.1\n2, 2.1, 0.1\n"),
        ("five.csv", &sweeps(&[0.0, 20.0, 40.0])),
        ("sweep.csv", "f [Hz], E' [MPa], E'' [MPa]\n0.1, 1, 0.1\n1, 1.5, 0.1\n1, 2.6, 0.1\n100, 3, 0.1\n"),
        ("falling.csv", "t [s], D [1/MPa]\n1, 2\n10, 1\n100, 0.5\n"),
        ("sudden.csv", &curve("t [s], E [MPa]", |t| if t < 1.0 { 2.0 } else { 1.0 })),
        ("loss.csv", &curve("f [Hz], E' [MPa], E'' [MPa]", |_| 1.0).replace(", 1.000000000e0", ", 1, 3")),
    ]);
    let dir = dir.path();
    let at = "body[0].material.path";
    let relaxation =
        |name: &str| format!(r#"{{ model = "relaxation-table", path = "{name}", modulus = "young" }}"#);
    for (name, numbers) in [
        ("letters.csv", &["letters.csv, line 4", "column 2"][..]),
        ("kilo.csv", &["line 4", "1500 kPa"]),
        ("unit.csv", &["column 2"]),
        ("typo.csv", &[]),
        ("growing.csv", &["line 5", "point 4"]),
        ("negative.csv", &["line 4", "-1.5e6 Pa", "greater than 0"]),
        ("twice.csv", &["line 5", "line 4"]),
        ("disorder.csv", &["line 5", "point 4 is 5e0 s"]),
        ("zero.csv", &["line 3", "point 2 is 0"]),
        ("short.csv", &["line 3", "1 cell, but 2"]),
        ("point.csv", &["is 1"]),
        ("empty.csv", &[]),
        ("none.csv", &[]),
        ("sudden.csv", &[]),
    ] {
        let code = if name == "none.csv" { "file" } else { "data" };
        says(dir, &relaxation(name), at, code, numbers);
    }
    says(
        dir,
        r#"{ model = "creep-table", path = "falling.csv", compliance = "young" }"#,
        at,
        "data",
        &["line 3"],
    );
    let dma =
        |name: &str, keys: &str| format!(r#"{{ model = "dma", path = "{name}", modulus = "young"{keys} }}"#);
    says(dir, &dma("hertz.csv", ""), at, "data", &[]);
    says(dir, &dma("good.csv", ""), at, "data", &["column 1, \"t [s]\"", "2 \"E [MPa]\""]);
    says(dir, &dma("sweep.csv", ""), at, "data", &["line 4", "the frequency is that of line 3"]);
    says(dir, &dma("loss.csv", ""), at, "data", &[]);
    says(dir, &dma("five.csv", ""), at, "data", &["3 temperatures (0.0 °C, 20.0 °C, 40.0 °C)"]);
    says(
        dir,
        &dma("five.csv", ", columns = { frequency = 7 }"),
        at,
        "data",
        &["frequency must be column 7", "1 \"T [°C]\""],
    );
    says(dir, &dma("five.csv", ", columns = { storage = \"G'\" }"), at, "data", &[]);
    says(
        dir,
        &dma("five.csv", ", columns = { loss = 4, tan_delta = 3 }"),
        "body[0].material.columns",
        "conflict",
        &[],
    );
    says(
        dir,
        &dma("five.csv", ", columns = { time = 4 }"),
        "body[0].material.columns.time",
        "unknown-key",
        &[],
    );
    says(dir, &relaxation("good.csv").replace(" }", ", units = { time = \"MPa\" } }"), at, "data", &[]);
    says(
        dir,
        &relaxation("good.csv").replace(" }", ", fit = { window = [\"10 s\", \"1 s\"] } }"),
        "body[0].material.fit.window[1]",
        "out-of-range",
        &[],
    );
    says(
        dir,
        &relaxation("good.csv").replace(" }", ", fit = { window = [\"2 s\", \"3 s\"] } }"),
        at,
        "data",
        &["0 points lie in the window", "1e-1 to 1e3"],
    );
    says(
        dir,
        &relaxation("good.csv").replace(" }", ", fit = { max_terms = 0 } }"),
        "body[0].material.fit.max_terms",
        "out-of-range",
        &["1 or more"],
    );
    says(
        dir,
        r#"{ model = "relaxation-table", path = "good.csv" }"#,
        "body[0].material.modulus",
        "missing-key",
        &[],
    );
}

#[test]
fn shift_factors_stand_in_a_file_and_one_modulus_is_fitted() {
    let temperatures = [0.0, 10.0, 20.0, 30.0, 40.0];
    // log10 a_T = -8.86 (T - 20)/(101.6 + T - 20), to the last digit.
    let factor = |t: f64| format!("{t},{:?}\n", -8.86 * (t - 20.0) / (101.6 + t - 20.0));
    let factors: String = temperatures.iter().rev().map(|t| factor(*t)).collect();
    // A loss modulus that is half as large again.
    // The loss moduli times this factor.
    let contradicting = |factor: f64| -> String {
        sweeps(&temperatures)
            .lines()
            .map(|line| match line.rsplit_once('\t') {
                Some((before, loss)) => match loss.replace(',', ".").parse::<f64>() {
                    Ok(value) => {
                        format!("{before}\t{}\n", format!("{:.9e}", factor * value).replace('.', ","))
                    }
                    Err(_) => format!("{line}\n"),
                },
                None => format!("{line}\n"),
            })
            .collect()
    };
    let dir = files(&[
        ("five.csv", &sweeps(&temperatures)),
        ("half.csv", &contradicting(1.5)),
        ("apart.csv", &contradicting(4.0)),
        ("shift.csv", &format!("T,log_aT\nC,-\n{factors}")),
    ]);
    let shift = "shift = { model = \"table\", path = \"shift.csv\" }";
    let five = format!(r#"{{ model = "dma", path = "five.csv", modulus = "young", {shift} }}"#);
    let half = format!(
        r#"{{ model = "dma", path = "half.csv", modulus = "young", fit = {{ moduli = "storage" }}, {shift} }}"#
    );
    let creep = solid().to_creep().unwrap();
    for (material, findings) in [(&five, 0), (&half, 1)] {
        let case = case_in(dir.path(), &body(material), "");
        for t in [0.1, 3.0, 80.0] {
            // Nine digits in the file, as with the law itself.
            assert!(
                (case.conditions.creep.value(t) / (0.75 * creep.value(t)) - 1.0).abs() < 1e-5,
                "{material} {t}"
            );
        }
        let contradictions = case.findings.iter().filter(|finding| finding.text.contains("Kramers-Kronig"));
        assert_eq!(contradictions.count(), findings, "{material}");
    }
    let both = half.replace("\"storage\"", "\"both\"");
    let case = case_in(dir.path(), &body(&both), "");
    assert!(
        case.findings.iter().any(|finding| finding.text.contains("from the loss modulus by")),
        "{:?}",
        case.findings
    );
    says(dir.path(), &both.replace("half.csv", "apart.csv"), "body[0].material.path", "data", &[]);
    let both = five
        .replace("path = \"shift.csv\"", "path = \"shift.csv\", points = [[\"0 °C\", 1], [\"20 °C\", 0]]");
    says(dir.path(), &both, "body[0].material.shift", "conflict", &[]);
}

#[test]
fn a_body_without_instantaneous_compliance_refuses_a_jump() {
    let springpot = r#"{ model = "springpot", shear = "1 MPa", time = "2 s", order = 1 }"#;
    let jump = text(&body(springpot), "")
        .replace("ramp\", value = \"0.1 N\", duration = \"10 s\"", "step\", value = \"0.1 N\"");
    let errors = Case::parse(&jump, Path::new("."), &[]).unwrap_err();
    assert_eq!(errors.errors[0].key, "load.history");
    assert!(errors.to_string().contains("no instantaneous compliance"), "{errors}");
}

#[test]
fn a_bare_number_of_degrees_is_told() {
    let of = |reference: &str, temperature: &str| {
        let material = format!(
            r#"{{ model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s", shift = {{ model = "wlf", c1 = 8.86, c2 = 101.6, reference = {reference} }} }}"#
        );
        let more = format!("[temperature]\nhistory = {{ kind = \"constant\", value = {temperature} }}\n");
        let case = case_in(Path::new("."), &body(&material), &more);
        case.findings.iter().filter(|finding| finding.code == "unlikely-unit").count()
    };
    assert_eq!(of("\"20 °C\"", "\"25 °C\""), 0);
    assert_eq!(of("293.15", "298.15"), 0);
    // Kelvins, where degrees are meant.
    assert_eq!(of("20", "25"), 1);
    // No polymer is used at 727 °C.
    assert_eq!(of("293.15", "1000"), 1);
}

#[test]
fn a_temperature_that_a_shift_does_not_have_is_refused_at_its_key() {
    let wlf = r#"{ model = "wlf", c1 = 8.86, c2 = 101.6, reference = "20 °C" }"#;
    let table = r#"{ model = "table", points = [["0 °C", 2], ["20 °C", 0], ["60 °C", -3]] }"#;
    for (shift, own, history, key) in [
        (wlf, "", r#"{ kind = "constant", value = 40 }"#, "value"),
        (table, "", r#"{ kind = "constant", value = 40.0 }"#, "value"),
        (wlf, "", r#"{ kind = "ramp", from = "20 °C", to = 40, duration = "1 s" }"#, "to"),
        (wlf, "", r#"{ kind = "table", points = [["0 s", "20 °C"], ["1 s", 40]] }"#, "points[1]"),
        (wlf, ", temperature = 40", "", "temperature"),
    ] {
        let material = format!(
            r#"{{ model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s", shift = {shift}{own} }}"#
        );
        let (more, table) = match history {
            "" => (String::new(), "body[0].material"),
            _ => (format!("[temperature]\nhistory = {history}\n"), "temperature.history"),
        };
        let errors = Case::parse(&text(&body(&material), &more), Path::new("."), &[]).unwrap_err().errors;
        assert_eq!((errors.len(), errors[0].code), (1, Code::OutOfRange), "{}", errors[0]);
        assert_eq!(errors[0].key, format!("{table}.{key}"));
        assert!(errors[0].help.as_ref().unwrap().contains("\"40 °C\""), "{}", errors[0]);
        wording::check(&format!("{history}{own}"), Path::new("."), &errors[0]);
    }
}

#[test]
fn a_temperature_that_is_no_table_is_shown_as_one() {
    let material = r#"{ model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s", shift = { model = "arrhenius", energy = "100 kJ/mol", reference = "20 °C" } }"#;
    let good = text(&body(material), "");
    for (section, key, line, written) in [
        ("temperature = 40", "temperature", 2, "\"40 °C\" } }, or \"40 K\""),
        ("temperature = '40 °C'", "temperature", 2, "value = \"40 °C\""),
        ("temperature.history = 40", "temperature.history", 2, "\"40 °C\" }, or \"40 K\""),
        ("temperature.history = 313", "temperature.history", 2, "\"313 K\""),
        ("temperature.value = 40", "temperature.value", 2, "\"40 °C\" }, or \"40 K\""),
    ] {
        let case = format!("\n{section}{good}");
        let error = &Case::parse(&case, Path::new("."), &[]).unwrap_err().errors[0];
        assert_eq!((error.key.as_str(), error.line), (key, Some(line)), "{error}");
        let help = error.help.as_ref().unwrap();
        assert!(help.contains("history = { kind = \"constant\"") && help.contains(written), "{error}");
        wording::check(section, Path::new("."), error);
    }
}
