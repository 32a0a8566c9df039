//! Bodies of layers in case files: what they come to, and what is refused.

use std::path::Path;

use asperity::kernel::Kernel;
use asperity::layer::{Base, Interface};
use asperity_io::case::{Case, CaseErrors};

use crate::wording;

const TREAD: &str = r#"[domain]
cells = [32, 32]
size = ["40 mm", "40 mm"]
[[surface]]
kind = "sphere"
radius = "100 mm"
[[body]]
name = "tread"
base = "rigid"
hardness = "10 MPa"
[[body.layer]]
thickness = "10 mm"
poisson = 0.49
material = { model = "zener", shear = "5 MPa", shear_kelvin = "2 MPa", retardation_time = "10 s" }
[[body.layer]]
thickness = "5 mm"
poisson = 0.4
material = { model = "zener", shear = "10 MPa", shear_kelvin = "4 MPa", retardation_time = "10 s" }
interface = "slip"
[load]
control = "load"
history = { kind = "step", value = "5 N" }
[time]
end = "1 s"
steps = 1
"#;

fn parse(text: &str) -> Result<Case, CaseErrors> {
    Case::parse(text, Path::new("."), &[])
}

/// Replaces `old` by `new`; the first error has the key, the code and the numbers.
#[track_caller]
fn says(old: &str, new: &str, key: &str, code: &str, numbers: &[&str]) {
    assert!(TREAD.contains(old), "{old:?} is not in the case");
    let errors = parse(&TREAD.replacen(old, new, 1)).expect_err("it is refused").errors;
    let shown: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(errors[0].key, key, "{shown:?}");
    assert_eq!(errors[0].code.to_string(), code, "{shown:?}");
    for number in numbers {
        assert!(shown[0].contains(number), "{:?} lacks {number:?}", shown[0]);
    }
    wording::check(new, Path::new("."), &errors[0]);
}

#[test]
fn layers_become_a_stack_from_the_surface_down() {
    let case = parse(TREAD).unwrap_or_else(|errors| panic!("{errors}"));
    let layers = case.layers.as_ref().unwrap();
    let stack = &layers.stacks()[0];
    assert_eq!(stack.base(), Base::Rigid);
    let [top, below] = stack.layers() else { panic!("{stack:?}") };
    assert_eq!((top.thickness, top.poisson, top.interface), (10e-3, 0.49, Interface::Bonded));
    assert_eq!((below.thickness, below.poisson, below.interface), (5e-3, 0.4, Interface::Slip));
    assert!((below.shear / top.shear - 2.0).abs() < 1e-12);
    // C(0) = (1 - nu)/(2 G) of the surface.
    assert!((case.conditions.creep.instantaneous / (0.51 / 10e6) - 1.0).abs() < 1e-14);
    assert_eq!(case.conditions.hardness, 10e6);
    let names: Vec<&str> = case.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["tread, layer 1", "tread, layer 2"]);
    let report = case.describe().layers.unwrap();
    assert_eq!(report.bodies, ["10 mm bonded to 5 mm slipping on a rigid base"]);
    // The longest wave is carried by the base, the shortest sees the top layer.
    let [longest, shortest] = report.waves.map(|wave| wave.instantaneous_modulus.unwrap());
    assert!(longest > 1.3 * shortest && (shortest * case.conditions.creep.instantaneous - 1.0).abs() < 1e-3);
    let simulation = case.simulation().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(simulation.kernel.symbol(100.0, 0.0), layers.symbol(100.0, 0.0));
}

#[test]
fn a_base_of_the_same_law_and_a_second_body_may_be_half_spaces() {
    let material = "material = { model = \"zener\", shear = \"50 MPa\", shear_kelvin = \"20 MPa\", retardation_time = \"10 s\" }";
    let coated = TREAD.replace("base = \"rigid\"", &format!("poisson = 0.3\n{material}"));
    let pair = coated.replace("[load]", &format!("[[body]]\npoisson = 0.2\n{material}\n[load]"));
    let case = parse(&pair).unwrap_or_else(|errors| panic!("{errors}"));
    let [coated, plain] = case.layers.as_ref().unwrap().stacks() else { panic!("two bodies") };
    assert!(matches!(coated.base(), Base::HalfSpace { poisson: 0.3, .. }) && coated.layers().len() == 2);
    assert!(matches!(plain.base(), Base::HalfSpace { poisson: 0.2, .. }) && plain.layers().is_empty());
    assert!((case.conditions.creep.instantaneous / (0.51 / 10e6 + 0.8 / 100e6) - 1.0).abs() < 1e-14);
    let names: Vec<&str> = case.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["tread, layer 1", "tread, layer 2", "tread, base", "body 2"]);
}

#[test]
fn what_is_wrong_with_layers_is_named() {
    says("\"10 mm\"", "\"0 mm\"", "body[0].layer[0].thickness", "out-of-range", &["is \"0 mm\""]);
    says("\"10 mm\"", "\"-1 mm\"", "body[0].layer[0].thickness", "out-of-range", &["-1 mm"]);
    says("\"10 mm\"", "nan", "body[0].layer[0].thickness", "out-of-range", &[]);
    says("\"10 mm\"", "\"10 MPa\"", "body[0].layer[0].thickness", "wrong-unit", &[]);
    says("poisson = 0.49\n", "", "body[0].layer[0]", "missing-key", &[]);
    says(
        "poisson = 0.49\n",
        "poisson = 0.51\n",
        "body[0].layer[0].poisson",
        "out-of-range",
        &["at most 0.5"],
    );
    says("interface = \"slip\"", "interface = \"glued\"", "body[0].layer[1].interface", "unknown-kind", &[]);
    says("base = \"rigid\"", "base = \"hard\"", "body[0].base", "unknown-kind", &[]);
    says("base = \"rigid\"\n", "", "body[0].material", "missing-key", &[]);
    says("base = \"rigid\"", "base = \"rigid\"\npoisson = 0.3", "body[0]", "conflict", &[]);
    says("[load]", "[stress]\n[load]", "stress", "conflict", &[]);
    // A cell of 1.25 mm.
    says("\"10 mm\"", "\"0.3 mm\"", "body[0].layer[0]", "conflict", &["more than 4 times the thickness"]);
}

#[test]
fn layers_that_creep_differently_are_described_by_their_waves() {
    let slower = TREAD.replacen("\"10 s\" }\n[[body.layer]]", "\"11 s\" }\n[[body.layer]]", 1);
    for text in [slower.clone(), TREAD.replacen("poisson = 0.49", "bulk_modulus = \"2 GPa\"", 1)] {
        let case = parse(&text).unwrap_or_else(|errors| panic!("{errors}"));
        let report = case.describe().layers.unwrap();
        assert!(!report.separable && report.misfit.unwrap() < 1e-3 && report.nodes.unwrap() > 1);
        let [longest, shortest] = report.waves;
        // The relaxed modulus is 2/7 of the instantaneous one; with a bulk modulus Poisson's ratio goes towards 1/2.
        let rise = shortest.instantaneous_modulus.unwrap() / shortest.relaxed_modulus;
        assert!(rise > 3.3 && rise < 3.6, "{rise}");
        assert!(longest.relaxed_modulus > shortest.relaxed_modulus);
        assert!(case.simulation().unwrap_or_else(|errors| panic!("{errors}")).layers.is_some());
    }
    let constant = slower.replace("steps = 1", "steps = 1\nscheme = \"constant\"");
    let errors = parse(&constant).expect_err("not solved").errors;
    assert!(errors[0].to_string().contains("layers that creep differently"), "{}", errors[0]);
    let fluid = TREAD.replacen(
        "{ model = \"zener\", shear = \"10 MPa\", shear_kelvin = \"4 MPa\", retardation_time = \"10 s\" }",
        "{ model = \"maxwell\", shear = \"10 MPa\", relaxation_time = \"10 s\" }",
        1,
    );
    let errors = parse(&fluid).expect_err("it flows").errors;
    assert_eq!(errors[0].key, "body[0].layer[1]", "{}", errors[0]);
    assert!(errors[0].to_string().contains("one that flows without end"), "{}", errors[0]);
}

#[test]
fn a_free_line_contact_on_a_rigid_base_takes_an_approach() {
    let line = TREAD
        .replace("cells = [32, 32]", "cells = [32]")
        .replace("size = [\"40 mm\", \"40 mm\"]", "size = [\"40 mm\"]")
        .replace("\"sphere\"", "\"cylinder\"")
        .replace("\"5 N\"", "\"5 N/mm\"");
    let case = parse(&line).unwrap_or_else(|errors| panic!("{errors}"));
    let simulation = case.simulation().unwrap_or_else(|errors| panic!("{errors}"));
    assert!(!simulation.is_up_to_a_constant());
    let approach =
        line.replace("control = \"load\"", "control = \"approach\"").replace("\"5 N/mm\"", "\"0.1 mm\"");
    assert!(parse(&approach).is_ok());
    // On a half-space the approach of a line is known up to a constant.
    let rubber = "poisson = 0.5\nmaterial = { model = \"zener\", shear = \"10 MPa\", shear_kelvin = \"4 MPa\", retardation_time = \"10 s\" }";
    let coated = |text: &str| parse(&text.replace("base = \"rigid\"", rubber));
    assert!(coated(&line).is_ok());
    assert_eq!(coated(&approach).expect_err("it is not known").errors[0].key, "load.control");
    // Cells of 1.25 mm.
    let thin = line.replace("\"10 mm\"", "\"0.3 mm\"");
    let errors = parse(&thin).expect_err("not resolved").errors;
    assert!(errors[0].to_string().contains("domain.cells to [34] or more"), "{}", errors[0]);
}

#[test]
fn a_rigid_base_needs_a_layer() {
    let bare = "[domain]\ncells = [8, 8]\nsize = [1, 1]\n[[surface]]\nkind = \"sphere\"\nradius = 9\n[[body]]\nbase = \"rigid\"\n\
                [load]\ncontrol = \"load\"\nhistory = { kind = \"step\", value = 1 }\n[time]\nend = 1\nsteps = 1\n";
    let errors = parse(bare).expect_err("nothing yields").errors;
    assert!(errors[0].to_string().contains("needs a [[body.layer]]"), "{}", errors[0]);
}

#[test]
fn a_stiff_coating_on_rubber_that_a_domain_is_too_narrow_for_is_named() {
    let coated = |young: &str| {
        let rubber = "material = { model = \"zener\", shear = \"1 MPa\", shear_kelvin = \"0.3 MPa\", retardation_time = \"10 s\" }";
        let layer = format!(
            "[[body.layer]]\nthickness = \"2 mm\"\npoisson = 0.3\nmaterial = {{ model = \"elastic\", young = \"{young}\" }}\n"
        );
        let first = TREAD.find("[[body.layer]]").unwrap_or_default();
        let last = TREAD.find("[load]").unwrap_or_default();
        let (before, after) = (TREAD[..first].replace("base = \"rigid\"", ""), &TREAD[last..]);
        format!("{before}poisson = 0.5\n{rubber}\n{layer}{after}")
    };
    parse(&coated("20 MPa")).unwrap_or_else(|errors| panic!("{errors}"));
    let errors = parse(&coated("200 GPa")).expect_err("it bends beyond the domain").errors;
    assert_eq!(errors[0].key, "body[0].layer[0]", "{}", errors[0]);
    let shown = errors[0].to_string();
    assert!(shown.contains("bend") && shown.contains("boundary = \"periodic\""), "{shown}");
    let periodic = coated("200 GPa").replace("[[surface]]", "boundary = \"periodic\"\n[[surface]]");
    parse(&periodic).unwrap_or_else(|errors| panic!("{errors}"));
}
