//! `[leakage]` of a fluid that acts on the surfaces.

use std::path::Path;

use asperity::History;
use asperity::traction::{Action, Pockets};
use asperity_io::case::{Case, CaseError};

const CASE: &str = r#"
[domain]
cells = [16, 16]
size = ["1 mm", "1 mm"]
boundary = "periodic"
[[surface]]
kind = "wave"
amplitude = "1 um"
wavelength = ["1 mm", "1 mm"]
[[body]]
poisson = 0.5
material = { model = "elastic", shear = "1 MPa" }
[load]
control = "pressure"
history = { kind = "step", value = "8 kPa" }
[time]
end = "2 s"
steps = 2
[leakage]
viscosity = "1 mPa s"
inlet = "1.02 bar"
outlet = "1 bar"
coupling = "two-way"
"#;

fn fault(text: &str) -> CaseError {
    Case::parse(text, Path::new("."), &[]).map(|_| ()).unwrap_err().errors.remove(0)
}

#[test]
fn its_keys_are_the_law_of_the_simulation() {
    let law = |text: &str| {
        let simulation = Case::parse(text, Path::new("."), &[]).unwrap().simulation().unwrap();
        simulation.traction.unwrap().as_fluid().unwrap().clone()
    };
    let usual = law(CASE);
    assert_eq!((usual.inlet, usual.outlet, usual.reference), (History::Step { value: 1.02e5 }, 1e5, 1e5));
    assert_eq!((usual.action, usual.viscosity, usual.gas), (Action::Gaps(Pockets::Kept), 1e-3, None));
    let table = "inlet = { kind = \"ramp\", value = \"1.02 bar\", duration = \"1 s\" }\nreference = \"vacuum\"\npockets = \"drained\"";
    let other =
        law(&CASE.replace("inlet = \"1.02 bar\"", table).replace("outlet = \"1 bar\"", "outlet = \"0 bar\""));
    assert_eq!(other.inlet, History::Ramp { value: 1.02e5, duration: 1.0 });
    assert_eq!((other.reference, other.action), (0.0, Action::Gaps(Pockets::Drained)));
    // From the outlet on, where nothing flows, and back to it.
    let triangle = "inlet = { kind = \"triangle\", peak = \"1.02 bar\", rise = \"1 s\", fall = \"0.5 s\" }";
    let triangle = law(&CASE.replace("inlet = \"1.02 bar\"", triangle));
    assert_eq!(triangle.inlet, History::Table { points: vec![(0.0, 1e5), (1.0, 1.02e5), (1.5, 1e5)] });
    let sealed = "two-way\"\npockets = \"sealed\"\nbulk_modulus = \"2 GPa";
    let sealed = law(&CASE.replace("two-way", sealed));
    assert_eq!((sealed.action, sealed.bulk_modulus), (Action::Gaps(Pockets::Sealed), Some(2e9)));
    let uniform = law(&CASE.replace("two-way", "uniform").replace("1.02 bar", "1 bar"));
    assert_eq!((uniform.action, uniform.outlet), (Action::Everywhere, 1e5));
    let drop = law(&CASE
        .replace("inlet = \"1.02 bar\"", "pressure_drop = \"2 kPa\"")
        .replace("outlet = \"1 bar\"\n", ""));
    assert_eq!((drop.inlet, drop.outlet, drop.reference), (History::Step { value: 2e3 }, 0.0, 0.0));
    let gas = law(&CASE.replace("viscosity = \"1 mPa s\"", "gas = \"air\"\ntemperature = \"20 degC\""));
    assert!(gas.gas.is_some_and(|(gas, _)| gas.viscosity == gas.viscosity && (gas.temperature - 293.15).abs() < 1e-9));
}

#[test]
fn what_does_not_go_with_it_is_refused_where_it_stands() {
    let one_way = CASE.replace("two-way", "one-way");
    let adheres = "[adhesion]\nwork = \"1 uJ/m2\"\nrange = \"1 um\"\n[leakage]";
    let moves = "[motion]\nvelocity = \"1 mm/s\"\n[leakage]";
    let rows = [
        (CASE.replace("1.02 bar", "0.9 bar"), "leakage"),
        (CASE.replace("inlet = \"1.02 bar\"", "inlet = { kind = \"step\" }"), "leakage.inlet.value"),
        (
            CASE.replace("inlet = \"1.02 bar\"", "inlet = { kind = \"step\", value = \"2 N\" }"),
            "leakage.inlet.value",
        ),
        (CASE.replace("viscosity = \"1 mPa s\"", "viscosity = \"18 uPa s\""), "leakage"),
        (CASE.replace("outlet = \"1 bar\"\n", ""), "leakage"),
        (CASE.replace("\"two-way\"", "\"twoway\""), "leakage.coupling"),
        (CASE.replace("\"two-way\"", "\"two-way\"\npockets = \"connected\""), "leakage"),
        (one_way.clone() + "pockets = \"kept\"\n", "leakage"),
        (CASE.to_owned() + "pockets = \"sealed\"\n", "leakage"),
        (CASE.to_owned() + "bulk_modulus = \"2 GPa\"\n", "leakage"),
        (one_way.clone() + "bulk_modulus = \"2 GPa\"\n", "leakage"),
        (
            CASE.replace("viscosity = \"1 mPa s\"", "gas = \"air\"")
                + "pockets = \"sealed\"\nbulk_modulus = \"2 GPa\"\n",
            "leakage",
        ),
        (CASE.to_owned() + "pockets = \"sealed\"\nbulk_modulus = \"0 GPa\"\n", "leakage.bulk_modulus"),
        (CASE.to_owned() + "pockets = \"sealed\"\nbulk_modulus = \"2 mm\"\n", "leakage.bulk_modulus"),
        (
            CASE.replace("poisson = 0.5", "poisson = 0.5\nhardness = \"5 MPa\"")
                + "pockets = \"sealed\"\nbulk_modulus = \"2 GPa\"\n",
            "leakage.pockets",
        ),
        (one_way.clone() + "one_way = true\n", "leakage"),
        (CASE.replace("two-way", "uniform") + "opening = true\n", "leakage"),
        (CASE.to_owned() + "opening = true\n[output]\nfields = [\"gap\"]\n", "leakage.opening"),
        (
            CASE.replace(
                "\"elastic\", shear = \"1 MPa\"",
                "\"kelvin-voigt\", shear = \"1 MPa\", retardation_time = \"1 s\"",
            )
            .replace(
                "{ kind = \"step\", value = \"8 kPa\" }",
                "{ kind = \"ramp\", value = \"8 kPa\", duration = \"1 s\" }",
            ) + "opening = true\n",
            "leakage.opening",
        ),
        (one_way.clone() + "reference = \"vacuum\"\n", "leakage"),
        (one_way.replace("\"1.02 bar\"", "{ kind = \"step\", value = \"1.02 bar\" }"), "leakage"),
        (CASE.replace("[leakage]", adheres), "leakage.coupling"),
        (CASE.replace("[leakage]", moves), "motion"),
        (
            CASE.replace(
                "inlet = \"1.02 bar\"",
                "inlet = { kind = \"table\", points = [[0, 101e3], [1, 101e3], [1, 102e3]] }",
            ),
            "leakage.inlet",
        ),
    ];
    for (text, key) in rows {
        let error = fault(&text);
        assert_eq!(error.key, key, "{error:?}\n{text}");
        assert!(error.line.is_some(), "{error:?}");
    }
}
