//! What a good case comes to: every kind of surface, material, history and time grid, in SI.

use std::path::Path;

use asperity::material::Lateral;
use asperity::quantities::{Quantities, Quantity};
use asperity::surface::{Part, Punch, Roughness, Shape};
use asperity::{Boundary, Control, Course, Event, History, Method, Plasticity, Scheme, Stage, TimeGrid};
use asperity_io::case::{Case, Rows, Surface};
use asperity_io::store::FieldKind;

const FRAME: &str = r#"
domain = { cells = [40, 20], size = ["2 mm", "1 mm"], boundary = "periodic" }
surface = [SURFACE]
body = [BODY]
load = { control = "CONTROL", history = HISTORY }
time = TIME
"#;

struct Parts {
    surface: &'static str,
    body: &'static str,
    control: &'static str,
    history: &'static str,
    time: &'static str,
    more: &'static str,
}

const PARTS: Parts = Parts {
    surface: r#"{ kind = "sphere", radius = "1 cm" }"#,
    body: r#"{ poisson = 0.5, material = { model = "elastic", shear = "1 MPa" } }"#,
    control: "load",
    history: r#"{ kind = "step", value = "10 mN" }"#,
    time: r#"{ end = "1 min", steps = 10 }"#,
    more: "",
};

fn case_in(dir: &Path, parts: Parts) -> Case {
    let text = FRAME
        .replace("SURFACE", parts.surface)
        .replace("BODY", parts.body)
        .replace("CONTROL", parts.control)
        .replace("HISTORY", parts.history)
        .replace("TIME", parts.time);
    Case::parse(&format!("{text}{}", parts.more), dir, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn case(parts: Parts) -> Case {
    case_in(Path::new("."), parts)
}

fn shape(surface: &'static str) -> (Shape, [f64; 2]) {
    match &case(Parts { surface, ..PARTS }).surfaces[..] {
        [Surface::Part(Part::Shape { shape, center })] => (*shape, *center),
        other => panic!("{other:?}"),
    }
}

#[test]
fn shapes() {
    let origin = [0.0, 0.0];
    assert_eq!(shape(r#"{ kind = "sphere", radius = "1 cm" }"#), (Shape::Sphere { radius: 1e-2 }, origin));
    assert_eq!(
        shape(r#"{ kind = "sphere", radius = "inf", center = ["1 um", -2e-6] }"#),
        (Shape::Sphere { radius: f64::INFINITY }, [1e-6, -2e-6])
    );
    assert_eq!(shape(r#"{ kind = "sphere", radius = inf }"#).0, Shape::Sphere { radius: f64::INFINITY });
    assert_eq!(
        shape(r#"{ kind = "ellipsoid", radius_x = "1 mm", radius_y = "inf" }"#).0,
        Shape::Ellipsoid { radius_x: 1e-3, radius_y: f64::INFINITY }
    );
    assert_eq!(shape(r#"{ kind = "cone", slope = "5 %" }"#).0, Shape::Cone { slope: 0.05 });
    assert_eq!(
        shape(r#"{ kind = "flat-punch", radius = "0.2 mm" }"#).0,
        Shape::FlatPunch(Punch::Circle { radius: 0.2e-3 })
    );
    assert_eq!(
        shape(r#"{ kind = "flat-punch", size = ["0.2 mm", 0.1e-3] }"#).0,
        Shape::FlatPunch(Punch::Rectangle { size: [0.2e-3, 0.1e-3] })
    );
    assert_eq!(
        shape(r#"{ kind = "wave", amplitude = "30 nm", wavelength = ["1 mm", "inf"] }"#).0,
        Shape::Wave { amplitude: 30e-9, wavelength: [1e-3, f64::INFINITY] }
    );
}

#[test]
fn roughness() {
    let surface = r#"{ kind = "self-affine", hurst = 1, rms_height = "1 um", longest = "1 mm", shortest = "0.2 mm", seed = 7 }"#;
    let case = case(Parts { surface, ..PARTS });
    let [Surface::Part(Part::SelfAffine(rough))] = &case.surfaces[..] else { panic!() };
    assert_eq!((rough.hurst, rough.roughness, rough.seed), (1.0, Roughness::RmsHeight(1e-6), 7));
    assert_eq!((rough.longest, rough.roll_off, rough.shortest), (1e-3, 1e-3, 0.2e-3)); // roll_off = longest
}

#[test]
fn measured_surfaces_are_levelled_and_must_fit() {
    let dir = tempfile::tempdir().unwrap();
    // A tilted plane with one peak, in um; x runs along a line.
    let text: String = (0..20)
        .map(|j| {
            (0..40).map(|i| format!("{} ", if (i, j) == (10, 5) { 100 } else { i })).collect::<String>()
                + "\n"
        })
        .collect();
    std::fs::write(dir.path().join("peak.txt"), text).unwrap();
    let surface = r#"{ kind = "file", path = "peak.txt", size = ["2 mm", "1 mm"], height_unit = "um" }"#;
    let gap = case_in(dir.path(), Parts { surface, ..PARTS }).gap().unwrap();
    assert_eq!((gap.dim(), gap[[10, 5]]), ((40, 20), 0.0)); // the peak touches first
    let around = [gap[[0, 0]], gap[[39, 0]], gap[[0, 19]], gap[[39, 19]]];
    // Levelled: the corners lie 90 um below the peak, up to the tilt that the peak itself gives the plane.
    assert!(around.iter().all(|h| (h / 90e-6 - 1.0).abs() < 0.01), "{around:?}");

    let raw = r#"{ kind = "file", path = "peak.txt", size = ["2 mm", "1 mm"], height_unit = "um", level = "none", invert = true }"#;
    let gap = case_in(dir.path(), Parts { surface: raw, ..PARTS }).gap().unwrap();
    // Upside down the pit is deepest and x = 0 is highest.
    assert_eq!(gap[[0, 0]], 0.0);
    assert!((gap[[10, 5]] - 100e-6).abs() < 1e-18 && (gap[[39, 3]] - 39e-6).abs() < 1e-18); // rounding

    for (surface, words) in [
        (r#"{ kind = "file", path = "peak.txt", size = ["2 mm", "1 mm"] }"#, "height_unit"),
        (r#"{ kind = "file", path = "peak.txt", height_unit = "um" }"#, "size"),
        (
            r#"{ kind = "file", path = "peak.txt", size = ["1 mm", "1 mm"], height_unit = "um" }"#,
            "domain.size",
        ),
    ] {
        let errors = case_in(dir.path(), Parts { surface, ..PARTS }).simulation().unwrap_err();
        assert_eq!(errors.errors[0].key, "surface[0].path");
        assert!(errors.to_string().contains(words), "{errors}");
    }
    std::fs::write(dir.path().join("small.txt"), "1 2 3 4\n5 6 7 8\n9 8 7 6\n").unwrap();
    let surface = r#"{ kind = "file", path = "small.txt", size = ["2 mm", "1 mm"], height_unit = "um" }"#;
    let errors = case_in(dir.path(), Parts { surface, ..PARTS }).gap().unwrap_err();
    assert!(errors.to_string().contains("4 x 3 points, but the domain has 40 x 20 cells"), "{errors}");
}

/// (C(0), C(3 s), C(infinity)) of an incompressible body, where C = J/4 = 3 D/4.
fn creep(material: &str) -> [f64; 3] {
    let body = format!("{{ poisson = 0.5, material = {material} }}");
    let creep = case(Parts { body: body.leak(), ..PARTS }).conditions.creep;
    [creep.value(0.0), creep.value(3.0), creep.long_time()]
}

#[test]
fn materials() {
    let close = |found: [f64; 3], wanted: [f64; 3]| {
        for (f, w) in found.iter().zip(wanted) {
            // rounding, and the root finding of the Prony conversion
            assert!(*f == w || (f / w - 1.0).abs() < 1e-12, "{found:?} {wanted:?}");
        }
    };
    let inf = f64::INFINITY;
    let grown = |rate: f64| 1.0 - (-3.0 * rate).exp();
    close(creep(r#"{ model = "elastic", shear = "1 MPa" }"#), [0.25e-6; 3]);
    close(creep(r#"{ model = "elastic", young = "3 MPa" }"#), [0.25e-6; 3]);
    close(
        creep(r#"{ model = "maxwell", shear = "1 MPa", relaxation_time = "2 s" }"#),
        [0.25e-6, 0.25e-6 * 2.5, inf],
    );
    let zener = r#"{ model = "zener", shear = "1 MPa", shear_kelvin = "2 MPa", retardation_time = "2 s" }"#;
    close(creep(zener), [0.25e-6, 0.25e-6 + 0.125e-6 * grown(0.5), 0.375e-6]);
    let burgers = r#"{ model = "burgers", young = "3 MPa", relaxation_time = "6 s", young_kelvin = "6 MPa", retardation_time = "2 s" }"#;
    close(creep(burgers), [0.25e-6, 0.25e-6 * 1.5 + 0.125e-6 * grown(0.5), inf]);
    let series = r#"{ model = "creep", compliance = "shear", instantaneous = "1 1/MPa", terms = [{ compliance = "0.5 1/MPa", time = "2 s" }], fluidity = "0.1 1/(MPa s)" }"#;
    close(creep(series), [0.25e-6, 0.25e-6 + 0.125e-6 * grown(0.5) + 0.075e-6, inf]);
    // Zener: relaxation 2/3 + 1/3 exp(-t / (4/3 s)) MPa has the creep above.
    let absolute = r#"{ model = "prony", modulus = "shear", equilibrium = 0.6666666666666666e6, terms = [{ modulus = 0.3333333333333333e6, time = 1.3333333333333333 }] }"#;
    let relative = r#"{ model = "prony", modulus = "shear", instantaneous = "1 MPa", terms = [{ fraction = 0.3333333333333333, time = 1.3333333333333333 }] }"#;
    close(creep(absolute), creep(zener));
    close(creep(relative), creep(zener));
    let [at_once, ..] = creep(r#"{ model = "prony", modulus = "young", equilibrium = "3 MPa", terms = [] }"#);
    assert!((at_once / 0.25e-6 - 1.0).abs() < 1e-12);
}

#[test]
fn pairs_of_bodies() {
    let body = r#"
        { name = "soft", poisson = 0.5, hardness = "3 MPa", material = { model = "elastic", shear = "1 MPa" } },
        { bulk_modulus = "1 GPa", hardness = "2 MPa", material = { model = "elastic", young = "1 GPa" } }"#;
    let case = case(Parts { body, ..PARTS });
    assert_eq!(case.conditions.hardness, 2e6); // the softer one yields
    assert_eq!(case.bodies[1].name, "body 2");
    assert_eq!(case.bodies[1].lateral, Lateral::BulkModulus(1e9));
    // nu = 1/2 - E/(6 B) = 1/3, C = (1 - 1/9) / 1 GPa
    let wanted = 0.25e-6 + 8.0 / 9.0 * 1e-9;
    assert!((case.conditions.creep.value(0.0) / wanted - 1.0).abs() < 1e-12);
    assert_eq!(super::values::case(PARTS).conditions.hardness, f64::INFINITY);
}

fn history(control: &'static str, history: &'static str) -> History {
    history_of(&case(Parts { control, history, ..PARTS }))
}

/// The history of a case of one stage.
pub fn history_of(case: &Case) -> History {
    let [stage] = case.conditions.loading.stages.as_slice() else { panic!("{:?}", case.conditions.loading) };
    let Course::Given(history) = &stage.course else { panic!("{stage:?}") };
    history.clone()
}

#[test]
fn histories() {
    assert_eq!(history("pressure", r#"{ kind = "step", value = "2 kPa" }"#), History::Step { value: 2e3 });
    assert_eq!(
        history("approach", r#"{ kind = "ramp", value = "-1 um", duration = "1 ms" }"#),
        History::Ramp { value: -1e-6, duration: 1e-3 }
    );
    assert_eq!(
        history("load", r#"{ kind = "triangle", peak = 1, rise = "1 s", fall = 2 }"#),
        History::Triangle { peak: 1.0, rise: 1.0, fall: 2.0 }
    );
    assert_eq!(
        history("load", r#"{ kind = "trapezoid", peak = 1, rise = 1, hold = 0, fall = 2 }"#),
        History::Trapezoid { peak: 1.0, rise: 1.0, hold: 0.0, fall: 2.0 }
    );
    assert_eq!(
        history("load", r#"{ kind = "sine", mean = 1, amplitude = 1, frequency = "2 mHz" }"#),
        History::Sine { mean: 1.0, amplitude: 1.0, frequency: 2e-3 }
    );
    assert_eq!(
        history("load", r#"{ kind = "table", points = [[0, 0], ["1 min", "1 N"], ["1 min", "0 N"]] }"#),
        History::Table { points: vec![(0.0, 0.0), (60.0, 1.0), (60.0, 0.0)] }
    );
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("h.csv"), "time [min], load [mN]\n0, 0\n1, 5\n").unwrap();
    let parts = Parts { history: r#"{ kind = "file", path = "h.csv" }"#, ..PARTS };
    let case = case_in(dir.path(), parts);
    assert_eq!(case.conditions.loading.stages[0].control, Control::Load);
    assert_eq!(history_of(&case), History::Table { points: vec![(0.0, 0.0), (60.0, 5e-3)] });
}

#[test]
fn times_schemes_and_solver() {
    let plain = case(PARTS);
    assert_eq!(plain.conditions.times, TimeGrid::Uniform { end: 60.0, steps: 10 });
    assert_eq!((plain.conditions.scheme, plain.conditions.boundary), (Scheme::Linear, Boundary::Periodic));
    assert_eq!(
        (plain.conditions.solver.method, plain.conditions.solver.tolerance),
        (Method::ProjectedCg, 1e-6)
    );
    assert_eq!(plain.output.rows, Rows::Every(1)); // 10 steps: about ten fields
    assert_eq!(plain.output.path, Path::new("result.zarr"));
    assert_eq!(
        plain.output.fields.iter().copied().collect::<Vec<_>>(),
        [FieldKind::Pressure, FieldKind::Gap]
    );

    let listed = case(Parts { time: r#"{ times = ["1 s", 5], scheme = "constant" }"#, ..PARTS });
    assert_eq!(
        (listed.conditions.times, listed.conditions.scheme),
        (TimeGrid::List(vec![1.0, 5.0]), Scheme::Constant)
    );
    let log = r#"{ end = 100, steps = 5, spacing = "log", first = "10 ms", scheme = "direct" }"#;
    let log = case(Parts { time: log, ..PARTS });
    assert_eq!(log.conditions.times, TimeGrid::Logarithmic { end: 100.0, steps: 5, first: 0.01 });
    assert_eq!(log.conditions.scheme, Scheme::Direct);
    // A tenth of the shortest retardation time; a uniform step or a twentieth of the ramp where that is shorter.
    let body =
        r#"{ poisson = 0.5, material = { model = "kelvin-voigt", shear = 1e6, retardation_time = "2 s" } }"#;
    let (slow, fast) =
        (r#"{ kind = "ramp", value = 1, duration = 10 }"#, r#"{ kind = "ramp", value = 1, duration = 1 }"#);
    let (few, many) =
        (r#"{ end = 100, steps = 5, spacing = "log" }"#, r#"{ end = 100, steps = 1000, spacing = "log" }"#);
    for (steps, time, history, first) in [(5, few, slow, 0.2), (1000, many, slow, 0.1), (5, few, fast, 0.05)]
    {
        let found = case(Parts { body, time, history, ..PARTS }).conditions.times;
        assert_eq!(found, TimeGrid::Logarithmic { end: 100.0, steps, first });
    }

    let more = r#"
solver = { method = "polonsky-keer", tolerance = 1e-8, max_iterations = 77, plasticity = "cap" }
output = { path = "a/b.zarr", fields = ["contact", "contact"], times = ["0 s", "7 s", "12 s"], checkpoint = false }
"#;
    let case = case(Parts { more, ..PARTS });
    assert_eq!(
        (
            case.conditions.solver.method,
            case.conditions.solver.tolerance,
            case.conditions.solver.max_iterations
        ),
        (Method::PolonskyKeer, 1e-8, 77)
    );
    assert_eq!((case.output.path.as_path(), case.output.checkpoint), (Path::new("a/b.zarr"), false));
    assert_eq!(case.output.fields.len(), 1);
    let instants: Vec<f64> = case.simulation().unwrap().plan().instants.iter().map(|i| i.time).collect();
    assert!(instants.contains(&7.0) && instants.contains(&12.0) && instants.contains(&6.0));
    let stored = instants
        .iter()
        .enumerate()
        .filter(|(n, t)| case.output.rows.holds(*n, *n == instants.len() - 1, **t));
    assert_eq!(stored.map(|(_, t)| *t).collect::<Vec<_>>(), [0.0, 7.0, 12.0, 60.0]);
    assert_eq!((case.describe().rows, case.describe().stored_rows), (Some(12), Some(4))); // 10 steps, 0+, 7 s
}

#[test]
fn stages() {
    let stages = r#"stages = [
  { control = "load", history = { kind = "ramp", value = "1 N", duration = "2 s" }, until = { approach = "2 um" }, duration = 2 },
  { control = "approach", history = { kind = "hold" }, duration = "10 s", steps = 5, spacing = "log", first = "0.1 s" },
  { control = "approach", history = { kind = "ramp", from = "current", value = "-1 um", duration = 1 }, until = "contact-lost" },
  { control = "pressure", history = { kind = "step", value = "1 kPa" }, until = { load = "2 mN" } },
  { control = "load", history = { kind = "hold" }, until = { pressure = "1 MPa" }, duration = 3, spacing = "adaptive", tolerance = 1e-4, first = 0.01 },
]"#;
    let text = FRAME
        .replace("SURFACE", PARTS.surface)
        .replace("BODY", PARTS.body)
        .replace(r#"control = "CONTROL", history = HISTORY"#, stages)
        .replace("TIME", PARTS.time);
    let case = Case::parse(&text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let ramp = Stage {
        duration: Some(2.0),
        until: Some(Event::Approach(2e-6)),
        ..Stage::new(Control::Load, History::Ramp { value: 1.0, duration: 2.0 })
    };
    let hold = Stage {
        duration: Some(10.0),
        times: Some(TimeGrid::Logarithmic { end: 10.0, steps: 5, first: 0.1 }),
        ..Stage::new(Control::Approach, Course::Hold)
    };
    let retract = Stage {
        until: Some(Event::ContactLost),
        ..Stage::new(Control::Approach, Course::RampTo { value: -1e-6, duration: 1.0 })
    };
    let press = Stage {
        until: Some(Event::Load(2e-3)),
        ..Stage::new(Control::Pressure, History::Step { value: 1e3 })
    };
    let last = Stage {
        duration: Some(3.0),
        until: Some(Event::Pressure(1e6)),
        times: Some(TimeGrid::Adaptive { end: 3.0, tolerance: 1e-4, first: 0.01 }),
        ..Stage::new(Control::Load, Course::Hold)
    };
    assert_eq!(case.conditions.loading.stages, [ramp, hold, retract, press, last]);
    let description = case.describe();
    assert_eq!((description.rows, description.stages), (None, 5));
}

#[test]
fn adaptive_steps() {
    let grid = |time| case(Parts { time, ..PARTS }).conditions.times;
    let adaptive = |tolerance, first| TimeGrid::Adaptive { end: 60.0, tolerance, first };
    let text = r#"{ end = "1 min", spacing = "adaptive", tolerance = 1e-4, first = "1 ms" }"#;
    assert_eq!(grid(text), adaptive(1e-4, 1e-3));
    assert_eq!(grid(r#"{ end = "1 min", spacing = "adaptive" }"#), adaptive(1e-3, 0.06));
    // Steps end at the output times.
    let more = "output = { times = [7] }";
    let case = case(Parts { time: r#"{ end = "1 min", spacing = "adaptive" }"#, more, ..PARTS });
    assert!(case.conditions.include == [7.0] && case.describe().rows.is_none());
    assert_eq!(case.describe().stored_rows, Some(3));
}

#[test]
fn quantities_are_those_named_or_all_that_the_case_allows() {
    let simulation =
        |more: &'static str, body: &'static str| case(Parts { more, body, ..PARTS }).simulation().unwrap();
    let soft = PARTS.body;
    let hard = r#"{ poisson = 0.5, hardness = "1 MPa", material = { model = "elastic", shear = "1 MPa" } }"#;
    assert_eq!(simulation("", soft).quantities, Quantities::default());
    let named = simulation("output = { quantities = [\"rms_gap\", \"contact_spots\", \"rms_gap\"] }", soft);
    assert_eq!(named.quantities.list, [Quantity::RmsGap, Quantity::ContactSpots]);
    let all = "output = { quantities = [\"all\"], histogram = { bins = 7, gap = \"1 um\" } }";
    // Without a hardness nothing bounds the pressure.
    let list = simulation(all, soft).quantities.list;
    // Nothing is flattened for good with "cap".
    let possible = || Quantity::at_rest().filter(|quantity| *quantity != Quantity::PlasticVolume);
    assert_eq!(list.len(), possible().count() - 1);
    assert!(!list.contains(&Quantity::PressureHistogram));
    let all = simulation(all, hard);
    assert!(all.quantities.list.iter().copied().eq(possible()));
    let columns = all.columns().unwrap();
    let edges = |quantity| &columns.iter().find(|c| c.quantity == quantity).unwrap().edges;
    assert_eq!((edges(Quantity::PressureHistogram)[7], edges(Quantity::GapHistogram)[7]), (1e6, 1e-6));
    let dented = "solver = { plasticity = \"accumulate\" }\noutput = { fields = [\"flattening\"] }";
    let case = case(Parts { more: dented, body: hard, ..PARTS });
    assert_eq!(case.conditions.plasticity, Plasticity::Accumulate);
    assert_eq!(case.output.fields.iter().copied().collect::<Vec<_>>(), [FieldKind::Flattening]);
}

#[test]
fn the_result_lies_beside_the_user_under_the_case_s_name() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run.v2.toml");
    std::fs::write(&path, asperity_examples::Template::find("hertz").unwrap().text).unwrap();
    assert_eq!(Case::read(&path, &[]).unwrap().output.path, Path::new("run.v2.zarr"));
}

#[test]
fn a_punch_bears_only_under_its_face() {
    let parts = Parts {
        surface: r#"{ kind = "flat-punch", size = ["0.2 mm", "0.2 mm"] }"#,
        body: r#"{ poisson = 0.5, hardness = "1 MPa", material = { model = "elastic", shear = "1 MPa" } }"#,
        history: r#"{ kind = "step", value = "0.1 N" }"#, // 0.04 mm^2 bear 0.04 N, the domain 2 N
        ..PARTS
    };
    let errors = case(parts).simulation().unwrap_err();
    assert_eq!(errors.errors[0].key, "load.history.value");
    assert!(errors.to_string().contains("hardness times the area that can touch"), "{errors}");
}

#[test]
fn a_file_gives_each_cell_its_hardness() {
    let dir = tempfile::tempdir().unwrap();
    // MPa; x runs along a line: 1 in the left half, 3 in the right.
    let line = (0..40).map(|i| if i < 20 { "1 " } else { "3 " }).collect::<String>();
    let write = |name: &str, line: &str, lines: usize| {
        std::fs::write(dir.path().join(name), format!("{line}\n").repeat(lines)).unwrap();
    };
    write("map.txt", &line, 20);
    let body = r#"{ poisson = 0.5, hardness = "2 MPa", hardness_file = { path = "map.txt", unit = "1 MPa" }, material = { model = "elastic", shear = "1 MPa" } }"#;
    let case = case_in(dir.path(), Parts { body, ..PARTS });
    let map = case.conditions.hardness_map.as_ref().unwrap();
    assert_eq!((map.dim(), map[[19, 3]], map[[20, 3]]), ((40, 20), 1e6, 3e6));
    assert_eq!(case.describe().hardness_of_cells, Some([1e6, 2e6])); // the lesser of both holds
    assert_eq!(case.files[0].0, "map.txt");
    let simulation = case.simulation().unwrap();
    assert_eq!(simulation.hardness_map.as_ref(), Some(map));

    write("short.txt", &line, 19);
    write("negative.txt", &line.replacen('3', "-3", 1), 20);
    for (path, words) in [
        ("short.txt", "40 x 19 numbers, but the domain has 40 x 20 cells"),
        ("negative.txt", "the hardness of cell (20, 0)"),
        ("none.txt", "does not exist"),
    ] {
        let text = format!(
            r#"
            domain = {{ cells = [40, 20], size = ["2 mm", "1 mm"] }}
            surface = [{{ kind = "sphere", radius = "1 cm" }}]
            body = [{{ poisson = 0.5, hardness_file = {{ path = "{path}" }}, material = {{ model = "elastic", shear = "1 MPa" }} }}]
            load = {{ control = "load", history = {{ kind = "step", value = "10 mN" }} }}
            time = {{ end = "1 min", steps = 10 }}
            "#
        );
        let errors = Case::parse(&text, dir.path(), &[]).unwrap_err();
        assert_eq!(errors.errors[0].key, "body[0].hardness_file.path");
        assert!(errors.to_string().contains(words), "{errors}");
    }
}
