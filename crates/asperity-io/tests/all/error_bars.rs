//! Error bars of answers against the true errors: random cases with closed forms.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write as _;

use asperity::History;
use asperity::reference::{HertzSphere, HunterCylinder, Ting, Westergaard};
use asperity_io::case::Case;
use asperity_io::converge::{ConvergeOptions, Convergence, ErrorBar, converge, expected_cost};

use super::common::noise;

/// Names and exact values of answers.
type Exact = Vec<(&'static str, f64)>;

/// A random case and the exact values of its answers.
struct Known {
    kind: &'static str,
    text: String,
    exact: fn(&Case, &[f64]) -> Exact,
    numbers: Vec<f64>,
}

/// Random numbers of one case.
struct Random(usize);

impl Random {
    fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 += 1;
        from + (to - from) * noise(self.0)
    }

    fn log(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }
}

const ELASTIC: &str = "[[body]]\npoisson = 0.3\nmaterial = { model = \"elastic\", young = \"1 MPa\" }\n";
const ZENER: &str = "[[body]]\npoisson = 0.5\nmaterial = { model = \"zener\", shear = \"1 MPa\", shear_kelvin = \"0.2 MPa\", retardation_time = \"1 s\" }\n";

/// The case of number `seed`: spheres, waves, spheres pressed and released, sliding cylinders and seals in turn.
fn case(seed: usize) -> Known {
    let mut random = Random(1000 * seed);
    let cells = 4 * (8.0 * random.log(1.0, 2.5)) as usize;
    match seed % 5 {
        0 => {
            // A contact of a quarter to nearly all of the half side.
            let (radius, reach) = (0.1, random.between(0.25, 0.9));
            let modulus = 1e6 / (1.0 - 0.09);
            let load = 4.0 / 3.0 * modulus * (reach * 0.5e-3_f64).powi(3) / radius;
            let text = format!(
                "domain = {{ cells = [{cells}, {cells}], size = [1e-3, 1e-3] }}\nsurface = [{{ kind = \"sphere\", radius = {radius} }}]\nload = {{ control = \"load\", history = {{ kind = \"step\", value = {load:e} }} }}\ntime = {{ times = [1.0] }}\n{ELASTIC}"
            );
            Known { kind: "sphere (Hertz)", text, exact: hertz, numbers: vec![radius, load] }
        }
        1 => {
            let (amplitude, length) = (1e-6, 1e-3);
            let cells = 2 * cells;
            let modulus = 1e6 / (1.0 - 0.09);
            let pressure = random.between(0.05, 0.9) * PI * modulus * amplitude / length;
            let text = format!(
                "domain = {{ cells = [{cells}], size = [{length}], boundary = \"periodic\" }}\nsurface = [{{ kind = \"wave\", amplitude = {amplitude}, wavelength = [{length}] }}]\nload = {{ control = \"pressure\", history = {{ kind = \"step\", value = {pressure:e} }} }}\ntime = {{ times = [1.0] }}\n{ELASTIC}"
            );
            Known {
                kind: "wave (Westergaard)",
                text,
                exact: westergaard,
                numbers: vec![amplitude, length, pressure],
            }
        }
        2 => {
            let (radius, reach) = (0.1, random.between(0.3, 0.8));
            let load = 8.0 / 3.0 * 0.4e6 * (reach * 0.5e-3_f64).powi(3) / radius;
            let (rise, steps) = (random.log(0.1, 3.0), random.log(8.0, 80.0) as usize);
            let end = rise * random.between(0.5, 1.8);
            let text = format!(
                "domain = {{ cells = [{cells}, {cells}], size = [1e-3, 1e-3] }}\nsurface = [{{ kind = \"sphere\", radius = {radius} }}]\nload = {{ control = \"load\", history = {{ kind = \"triangle\", peak = {load:e}, rise = {rise}, fall = {rise} }} }}\ntime = {{ end = {end}, steps = {steps} }}\n{ZENER}"
            );
            Known { kind: "sphere in time (Ting)", text, exact: ting, numbers: vec![radius, load, rise, end] }
        }
        3 => {
            let radius = 0.01;
            let reach = random.between(0.3, 0.7);
            let cells = 4 * cells;
            let load = PI * (reach * 0.5e-3_f64).powi(2) / (4.0 * radius) * 4e6 / 6.0;
            let velocity = random.log(1e-5, 1e-2);
            let text = format!(
                "domain = {{ cells = [{cells}], size = [1e-3] }}\nsurface = [{{ kind = \"cylinder\", radius = {radius} }}]\nload = {{ control = \"load\", history = {{ kind = \"step\", value = {load:e} }} }}\nmotion = {{ steady = {{ velocities = [{velocity:e}] }} }}\n{ZENER}"
            );
            Known {
                kind: "sliding cylinder (Hunter)",
                text,
                exact: hunter,
                numbers: vec![radius, velocity, load],
            }
        }
        _ => {
            let (amplitude, length) = (1e-6, 1e-3);
            let modulus = 1e6 / (1.0 - 0.09);
            let pressure = random.between(0.05, 0.7) * PI * modulus * amplitude / length;
            let text = format!(
                "domain = {{ cells = [{cells}, {cells}], size = [{length}, {length}], boundary = \"periodic\" }}\nsurface = [{{ kind = \"wave\", amplitude = {amplitude}, wavelength = [inf, {length}] }}]\nload = {{ control = \"pressure\", history = {{ kind = \"step\", value = {pressure:e} }} }}\ntime = {{ times = [1.0] }}\nleakage = {{ direction = \"x\", pressure_drop = 1e5, viscosity = 1e-3 }}\n{ELASTIC}"
            );
            Known { kind: "seal channel", text, exact: channel, numbers: vec![amplitude, length, pressure] }
        }
    }
}

/// 1/C of an elastic case.
fn modulus(case: &Case) -> f64 {
    1.0 / case.conditions.creep.long_time()
}

fn area_of(radius: f64) -> [(&'static str, f64); 2] {
    let area = PI * radius * radius;
    [("contact_area", area), ("contact_area_corrected", area)]
}

fn hertz(case: &Case, numbers: &[f64]) -> Exact {
    let [radius, load] = numbers else { unreachable!() };
    let exact = HertzSphere::under_load(*radius, modulus(case), *load).unwrap();
    let more = [("approach", exact.approach), ("max_pressure", exact.peak_pressure)];
    area_of(exact.contact_radius).into_iter().chain(more).collect()
}

fn westergaard(case: &Case, numbers: &[f64]) -> Exact {
    let [amplitude, length, pressure] = numbers else { unreachable!() };
    let exact = Westergaard::under_pressure(*amplitude, *length, modulus(case), *pressure).unwrap();
    vec![
        ("contact_fraction", exact.contact_fraction()),
        ("contact_area", 2.0 * exact.half_width()),
        ("max_pressure", exact.pressure(0.0)),
        ("approach", exact.approach()),
    ]
}

fn ting(case: &Case, numbers: &[f64]) -> Exact {
    let [radius, peak, rise, end] = *numbers else { unreachable!() };
    let history = History::Triangle { peak, rise, fall: rise };
    let exact = Ting::new(radius, &case.conditions.creep, &history, end).unwrap().at(end).unwrap();
    let more = [("approach", exact.approach), ("max_pressure", exact.peak_pressure)];
    area_of(exact.contact_radius).into_iter().chain(more).collect()
}

fn hunter(case: &Case, numbers: &[f64]) -> Exact {
    let [radius, velocity, load] = *numbers else { unreachable!() };
    let exact = HunterCylinder::under_load(radius, &case.conditions.creep, velocity, load).unwrap();
    vec![
        ("friction_coefficient", exact.friction_coefficient()),
        ("friction_force", load * exact.friction_coefficient()),
        ("contact_area", 2.0 * exact.half_width),
        ("max_pressure", exact.peak().1),
    ]
}

/// The flow along the furrows of a wave in contact: dp/(12 mu Lx) times the integral of h³ over y. The gap beside a strip of contact
/// follows from the slope dh/dy = 4 p cos(psi) sqrt(sin² psi - sin² psi_a)/(E* sin² psi_a) with psi = pi y/l, whose pressure under the
/// strip is Westergaard's.
fn channel(case: &Case, numbers: &[f64]) -> Exact {
    let [amplitude, length, pressure] = *numbers else { unreachable!() };
    let modulus = modulus(case);
    let exact = Westergaard::under_pressure(amplitude, length, modulus, pressure).unwrap();
    let edge = (PI * exact.half_width() / length).sin();
    let gap = |y: f64| {
        let s = (PI * y / length).sin();
        let root = ((s - edge) * (s + edge)).sqrt();
        let integral = 0.5 * (s * root - edge * edge * ((s + root) / edge).ln());
        4.0 * pressure * length / (PI * modulus * edge * edge) * integral
    };
    // Simpson's rule; the gap rises from the edge as a power of 3/2.
    let (from, to, n) = (exact.half_width(), length / 2.0, 2000);
    let step = (to - from) / n as f64;
    let weight = |k: usize| if k == 0 || k == n { 1.0 } else { [2.0, 4.0][k % 2] };
    let sum: f64 = (1..=n).map(|k| weight(k) * gap(from + step * k as f64).powi(3)).sum();
    let cubes = 2.0 * sum * step / 3.0;
    vec![
        ("leak_rate", 1e5 * cubes / (12.0 * 1e-3 * length)),
        ("hydraulic_gap", (cubes / length).cbrt()),
        ("contact_fraction", exact.contact_fraction()),
    ]
}

/// Stated and true error of each answer of a case whose exact value is known; no stated one where it is not known.
fn errors(known: &Known) -> Vec<(&'static str, Option<f64>, f64)> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("case.toml");
    // Inline tables stand before the sections.
    std::fs::write(&path, &known.text).unwrap();
    let case = Case::read(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", known.text));
    let options = ConvergeOptions::default();
    let read = |keys: &[String]| Case::read(&path, keys);
    let found = converge(&read, None, &options, &mut |_| {}).unwrap();
    let bar = |name: &str| -> &ErrorBar { found.bars.iter().find(|bar| bar.name == name).unwrap() };
    let exact = (known.exact)(&case, &known.numbers);
    let stated = exact.into_iter().map(|(name, exact)| {
        let bar = bar(name);
        let stated = bar.error.map(|error| error / exact.abs());
        (name, stated, (bar.value.unwrap() - exact).abs() / exact.abs())
    });
    stated.collect()
}

/// How many random cases: more where the table of the documentation is written.
fn count() -> usize {
    std::env::var("ASPERITY_ERROR_BARS").ok().and_then(|text| text.parse().ok()).unwrap_or(20)
}

#[test]
fn the_stated_error_of_answers_covers_the_true_one() {
    let mut table: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    let mut missed = String::new();
    for seed in 0..count() {
        let known = case(seed);
        let errors = errors(&known);
        // Of a case the answer is the first one.
        for (name, stated, off) in &errors {
            let row = table.entry(known.kind).or_default();
            row[0] += 1;
            let Some(stated) = stated else {
                writeln!(missed, "{} {seed}: {name} is off by {off:.1e}, unknown", known.kind).unwrap();
                row[3] += 1;
                continue;
            };
            if off > stated {
                writeln!(missed, "{} {seed}: {name} is off by {off:.1e}, stated {stated:.1e}", known.kind)
                    .unwrap();
            }
            row[1] += usize::from(off <= stated);
            // Below 1e-3 nobody asks how large an error is.
            row[2] += usize::from(*stated <= (10.0 * off).max(1e-3));
        }
    }
    let mut sum = [0; 4];
    for (kind, row) in &table {
        let [answers, within, close, unknown] = row;
        println!("| {kind} | {answers} | {within} | {close} | {unknown} |");
        sum.iter_mut().zip(row).for_each(|(sum, number)| *sum += number);
    }
    let [all, covered, close, unknown] = sum;
    println!("| all | {all} | {covered} | {close} | {unknown} |");
    println!("{missed}");
    // 95 of 100 of those that are stated, and these are 95 of 100: all of them have limits.
    let known = all - unknown;
    assert!(20 * covered >= 19 * known && 20 * known >= 19 * all, "{covered} of {known} of {all}\n{missed}");
}

fn found(text: &str, refine: bool) -> Convergence {
    let read = |keys: &[String]| Case::parse(text, "case.toml".as_ref(), keys);
    let options = ConvergeOptions { refine, ..ConvergeOptions::default() };
    converge(&read, None, &options, &mut |_| {}).unwrap()
}

const SPHERE: &str = r#"
domain = { cells = [48, 48], size = [1e-3, 1e-3] }
surface = [{ kind = "sphere", radius = 0.1 }]
body = [{ poisson = 0.5, material = { model = "zener", shear = "1 MPa", shear_kelvin = "0.2 MPa", retardation_time = "1 s" } }]
load = { control = "load", history = { kind = "ramp", value = 1e-4, duration = 1.0 } }
time = { end = 2.0, steps = 16 }
"#;

#[test]
fn refined_grids_extrapolate_and_coarser_ones_cost_less_than_the_run() {
    let (coarse, fine) = (found(SPHERE, false), found(SPHERE, true));
    assert!(coarse.cost < 1.0 && coarse.notes.is_empty(), "{} {:?}", coarse.cost, coarse.notes);
    assert!(fine.cost > 4.0, "twice the cells are four times as many: {}", fine.cost);
    let of =
        |found: &Convergence, name: &str| found.bars.iter().find(|bar| bar.name == name).unwrap().clone();
    let case = Case::parse(SPHERE, "case.toml".as_ref(), &[]).unwrap();
    let history = History::Ramp { value: 1e-4, duration: 1.0 };
    let exact = Ting::new(0.1, &case.conditions.creep, &history, 2.0).unwrap().at(2.0).unwrap().approach;
    let [rough, extrapolated] = [&coarse, &fine].map(|found| of(found, "approach"));
    let off = |bar: &ErrorBar| (bar.value.unwrap() - exact).abs();
    assert!(off(&extrapolated) < 0.5 * off(&rough), "{} {}", off(&extrapolated), off(&rough));
    assert!(extrapolated.order.is_some() && off(&extrapolated) <= extrapolated.error.unwrap());
    // A held load creeps: the steps matter to it.
    assert!(of(&coarse, "creep").time.unwrap() > 0.0);
}

#[test]
fn a_grid_that_cannot_be_halved_is_refined() {
    let text = SPHERE.replace(
        "surface = [{ kind = \"sphere\", radius = 0.1 }]",
        "surface = [{ kind = \"self-affine\", hurst = 0.8, rms_gradient = 0.05, longest = 5e-4, shortest = 6e-5, seed = 1 }]",
    );
    let found = found(&text, false);
    assert!(found.notes[0].starts_with("half the cells along each side: not possible"), "{:?}", found.notes);
    assert!(found.cost > 4.0, "{}", found.cost);
    assert!(found.bars.iter().all(|bar| bar.error.is_some()), "{:?}", found.bars);
}

/// A case with another line in place of one that begins so.
fn with(line: &str) -> String {
    let key = line.split('=').next().unwrap();
    let lines = SPHERE.lines().map(|own| if own.starts_with(key) { line } else { own });
    lines.collect::<Vec<_>>().join("\n")
}

fn time_error(found: &Convergence, name: &str) -> Option<f64> {
    found.bars.iter().find(|bar| bar.name == name).unwrap().time
}

#[test]
fn steps_that_cannot_be_longer_are_halved() {
    // One step, and a stage with one given time beside one with many: Ting's closed form at their ends.
    let stages = r#"load = { stages = [
  { control = "load", history = { kind = "ramp", value = 1e-4, duration = 1.0 }, duration = 1.0, time = { times = [1.0] } },
  { control = "load", history = { kind = "hold" }, duration = 1.0, steps = 8 } ] }"#;
    for text in [with("time = { end = 2.0, steps = 1 }"), with("time = { times = [\"1 s\"] }"), with(stages)]
    {
        let found = found(&text, false);
        assert!(found.notes.iter().any(|note| note.contains("instead")), "{:?}", found.notes);
        let case = Case::parse(&text, "case.toml".as_ref(), &[]).unwrap();
        let (end, history) =
            (found.last.unwrap().coordinate.value(), History::Ramp { value: 1e-4, duration: 1.0 });
        let exact = Ting::new(0.1, &case.conditions.creep, &history, end).unwrap().at(end).unwrap().approach;
        let bar = found.bars.iter().find(|bar| bar.name == "approach").unwrap();
        assert!(bar.time.unwrap() > 0.0, "{bar:?}");
        assert!((bar.value.unwrap() - exact).abs() <= bar.error.unwrap(), "{bar:?} {exact}");
    }
}

#[test]
fn elastic_bodies_need_no_other_steps() {
    let body = "body = [{ poisson = 0.5, material = { model = \"elastic\", young = \"3 MPa\" } }]";
    let text = with(body);
    let mut solved = vec![];
    let read = |keys: &[String]| Case::parse(&text, "case.toml".as_ref(), keys);
    let found =
        converge(&read, None, &ConvergeOptions::default(), &mut |what| solved.push(what.to_owned())).unwrap();
    assert!(solved.iter().all(|what| !what.contains("steps")), "{solved:?}");
    assert!(found.bars.iter().all(|bar| bar.time == Some(0.0)), "{:?}", found.bars);
    let cost = |text: &str| {
        let read = |keys: &[String]| Case::parse(text, "case.toml".as_ref(), keys);
        expected_cost(&read(&[]).unwrap(), &read)
    };
    // Half of the cells twice, and a quarter of them.
    assert_eq!(cost(&text), 0.25 * 2.0 + 0.0625);
    assert_eq!(cost(SPHERE), 0.25 * 2.5 + 0.0625);
}

#[test]
fn bodies_with_a_clock_or_layers_have_an_error_of_their_steps() {
    // Warming rubber, whose creep is kept apart from that of the pair.
    let warm = format!(
        "{}\ntemperature = {{ history = {{ kind = \"table\", points = [[\"0 s\", \"20 °C\"], [\"2 s\", \"40 °C\"]] }} }}",
        SPHERE.replace("retardation_time = \"1 s\" }", "retardation_time = \"1 s\", shift = { model = \"arrhenius\", energy = \"100 kJ/mol\", reference = \"20 °C\" } }")
    );
    // A layer on a soft base of another material: waves of different lengths creep differently.
    let layered = SPHERE.replace(
        "body = [{ poisson = 0.5, material",
        "body = [{ base = \"half-space\", poisson = 0.5, layer = [{ thickness = \"0.1 mm\", poisson = 0.45, material = { model = \"elastic\", young = \"3 MPa\" } }], material",
    );
    for text in [warm, layered] {
        let found = found(&text, false);
        assert!(time_error(&found, "approach").unwrap() > 0.0, "{:?} {:?}", found.bars, found.notes);
    }
}

/// A sphere (Hertz) or a cone (Sneddon), in contact over 1 to 6 cells across, anywhere between the cells.
fn small(seed: usize) -> Known {
    let mut random = Random(7919 + 1000 * seed);
    let (cells, size) = (32, 1e-3);
    let radius_of_contact = random.between(0.5, 3.0) * size / f64::from(cells);
    let center =
        [random.between(-0.5, 0.5), random.between(-0.5, 0.5)].map(|share| share * size / f64::from(cells));
    let modulus = 1e6 / (1.0 - 0.09);
    let (surface, load, exact, first): (_, _, fn(&Case, &[f64]) -> Exact, _) = match seed % 2 {
        0 => {
            let radius = 0.1;
            let load = 4.0 / 3.0 * modulus * radius_of_contact.powi(3) / radius;
            (format!("kind = \"sphere\", radius = {radius}"), load, hertz, radius)
        }
        _ => {
            // F = pi/2 E* a² slope (Sneddon 1965).
            let slope = 0.01;
            let load = 0.5 * PI * modulus * radius_of_contact.powi(2) * slope;
            (format!("kind = \"cone\", slope = {slope}"), load, sneddon, slope)
        }
    };
    let text = format!(
        "domain = {{ cells = [{cells}, {cells}], size = [{size}, {size}] }}\nsurface = [{{ {surface}, center = {center:?} }}]\nload = {{ control = \"load\", history = {{ kind = \"step\", value = {load:e} }} }}\ntime = {{ times = [1.0] }}\n{ELASTIC}"
    );
    Known { kind: "small", text, exact, numbers: vec![first, load] }
}

/// Radius and depth under a cone: a² = 2 F/(pi E* slope), depth = pi/2 a slope.
fn sneddon(case: &Case, numbers: &[f64]) -> Exact {
    let [slope, load] = *numbers else { unreachable!() };
    let radius = (2.0 * load / (PI * modulus(case) * slope)).sqrt();
    area_of(radius).into_iter().chain([("approach", 0.5 * PI * radius * slope)]).collect()
}

#[test]
fn contacts_of_a_few_cells_lie_within_the_stated_error() {
    let (mut all, mut known, mut covered, mut missed) = (0, 0, 0, String::new());
    for seed in 0..count() {
        for (name, stated, off) in errors(&small(seed)) {
            all += 1;
            let Some(stated) = stated else {
                writeln!(missed, "{seed} {name}: off by {off:.2}, unknown").unwrap();
                continue;
            };
            known += 1;
            covered += usize::from(off <= stated);
            if off > stated {
                writeln!(missed, "{seed} {name}: off by {off:.2}, stated {stated:.2}").unwrap();
            }
        }
    }
    println!("{covered} of {known} of {all}\n{missed}");
    assert!(20 * covered >= 19 * known, "{covered} of {known} of {all}\n{missed}");
}

#[test]
fn the_pressure_at_a_sharp_edge_is_not_resolved() {
    let punch = with("surface = [{ kind = \"flat-punch\", radius = 2e-4 }]");
    for (text, is_resolved) in [
        (punch.clone(), false),
        // A hardness that the edge reaches limits it, and a sphere has no edge.
        (punch.replace("poisson = 0.5,", "poisson = 0.5, hardness = \"1 kPa\","), true),
        (SPHERE.to_owned(), true),
    ] {
        let found = found(&text, false);
        let bar = found.bars.iter().find(|bar| bar.name == "max_pressure").unwrap();
        assert_eq!(
            (bar.error.is_some(), bar.note.contains("sharp edge")),
            (is_resolved, !is_resolved),
            "{bar:?}"
        );
        // The depth of the punch is that of the theory, F/(2 E* a).
        assert!(
            found.bars.iter().all(|bar| bar.name == "max_pressure" || bar.error.is_some()),
            "{:?}",
            found.bars
        );
    }
}

/// A case without a closed form: its true answers are those on cells of a quarter of the length.
fn open_form(seed: usize) -> (&'static str, String, usize) {
    let mut random = Random(104_729 + 1000 * seed);
    let cells = [20, 24, 32, 40][(4.0 * random.between(0.0, 1.0)) as usize];
    let (side, modulus) = (1e-3, 1e6 / (1.0 - 0.09));
    let domain = |boundary: &str| {
        format!(
            "domain = {{ cells = [{cells}, {cells}], size = [{side}, {side}], boundary = \"{boundary}\" }}\n"
        )
    };
    let step = |control: &str, value: f64| {
        format!("load = {{ control = \"{control}\", history = {{ kind = \"step\", value = {value:e} }} }}\n")
    };
    let once = "time = { times = [1.0] }\n";
    let rough = |random: &mut Random, height: &str| {
        let shortest = side / cells as f64 * random.between(4.0, 9.0);
        let longest = (0.5 * side).max(2.0 * shortest);
        format!(
            "surface = [{{ kind = \"self-affine\", hurst = 0.8, {height}, longest = {longest:e}, shortest = {shortest:e}, seed = {seed} }}]\n"
        )
    };
    let round = |random: &mut Random, from: f64, to: f64| {
        let reach = 0.5 * side * random.between(from, to);
        (4.0 / 3.0 * modulus * reach.powi(3) / 0.01, "surface = [{ kind = \"sphere\", radius = 0.01 }]\n")
    };
    let (kind, text) = match seed % 8 {
        0 => {
            let surface = rough(&mut random, "rms_gradient = 0.02");
            let load = step("pressure", random.between(0.02, 0.5) * 0.01 * modulus);
            ("rough, under a load", [&domain("periodic"), &surface, &load, once, ELASTIC].concat())
        }
        1 => {
            let surface = rough(&mut random, "rms_height = 1e-6");
            let load = step("approach", random.between(0.5e-6, 2e-6));
            ("rough, under an approach", [&domain("periodic"), &surface, &load, once, ELASTIC].concat())
        }
        2 => {
            let ratio = random.between(1.0, 4.0);
            let (load, _) = round(&mut random, 0.85, 1.5);
            let surface = format!(
                "surface = [{{ kind = \"ellipsoid\", radius_x = 0.01, radius_y = {:e} }}]\n",
                0.01 * ratio
            );
            (
                "contact up to the border",
                [&domain("free"), &surface, &step("load", load * ratio.sqrt()), once, ELASTIC].concat(),
            )
        }
        3 => {
            let radius = 0.5 * side * random.between(0.2, 0.9);
            let surface = format!("surface = [{{ kind = \"flat-punch\", radius = {radius:e} }}]\n");
            ("flat punch", [&domain("free"), &surface, &step("load", 1e-3), once, ELASTIC].concat())
        }
        4 => {
            let (load, surface) = round(&mut random, 0.25, 0.7);
            let velocity = random.log(3e-6, 3e-2);
            let motion = format!("motion = {{ steady = {{ velocities = [{velocity:e}] }} }}\n");
            ("sliding sphere", [&domain("free"), surface, &step("load", load), &motion, ZENER].concat())
        }
        5 => {
            let (load, surface) = round(&mut random, 0.2, 0.8);
            let (thickness, young) = (side * random.between(0.1, 0.6), random.log(1e5, 1e7));
            let layer = format!(
                "[[body.layer]]\nthickness = {thickness:e}\npoisson = 0.4\nmaterial = {{ model = \"elastic\", young = {young:e} }}\ninterface = \"bonded\"\n"
            );
            (
                "sphere on a layer",
                [&domain("free"), surface, &step("load", load), once, ELASTIC, &layer].concat(),
            )
        }
        6 => {
            let work = random.log(1e-3, 2e-2);
            let range = (work / modulus * 4.8 * side / cells as f64).sqrt() * random.between(1.6, 2.5);
            let adhesion = format!("adhesion = {{ work = {work:e}, range = {range:e} }}\n");
            let surface = "surface = [{ kind = \"sphere\", radius = 0.01 }]\n";
            let load = step("approach", random.between(0.5e-6, 4e-6));
            ("sphere that adheres", [&domain("free"), surface, &load, once, &adhesion, ELASTIC].concat())
        }
        _ => {
            let surface = rough(&mut random, "rms_gradient = 0.02");
            let load = step("pressure", random.between(0.02, 0.2) * 0.02 * modulus);
            let leak = "leakage = { pressure_drop = 1e5, viscosity = 1e-3 }\n";
            ("rough seal", [&domain("periodic"), &surface, &load, once, leak, ELASTIC].concat())
        }
    };
    (kind, text, cells)
}

/// The answers of a case on other cells.
fn answers_on(text: &str, cells: usize) -> Vec<asperity_io::answer::Answer> {
    use asperity_io::session::{RunOptions, run};
    let directory = tempfile::tempdir().unwrap();
    let case =
        Case::parse(text, "case.toml".as_ref(), &[format!("domain.cells=[{cells}, {cells}]")]).unwrap();
    let output = Some(directory.path().join("fine.zarr"));
    let summary = run(&case, &RunOptions { output, ..RunOptions::default() }, |_| ()).unwrap();
    summary.answers
}

#[test]
fn the_stated_error_covers_the_distance_from_four_times_finer_cells() {
    let mut table: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    let mut missed = String::new();
    for seed in 0..count() {
        let (kind, text, cells) = open_form(seed);
        let fine = answers_on(&text, 4 * cells);
        let is_singular = ["contact up to the border", "flat punch"].contains(&kind);
        for bar in found(&text, false).bars {
            let Some((value, exact)) = bar.value.zip(fine.iter().find(|answer| answer.name == bar.name))
            else {
                continue;
            };
            let off = (value - exact.value).abs();
            let row = table.entry(kind).or_default();
            row[0] += 1;
            match bar.error {
                None => row[3] += 1,
                Some(error) => {
                    row[1] += usize::from(off <= error);
                    row[2] += usize::from(error <= (10.0 * off).max(1e-3 * exact.value.abs()));
                    if off > error {
                        writeln!(
                            missed,
                            "{kind} {seed}: {} is off by {off:.2e}, stated {error:.2e}",
                            bar.name
                        )
                        .unwrap();
                    }
                }
            }
            if is_singular && bar.name == "max_pressure" {
                assert!(bar.error.is_none() && bar.note.contains("without end"), "{kind} {seed}: {bar:?}");
            }
        }
    }
    let mut sum = [0; 4];
    for (kind, row) in &table {
        println!("| {kind} | {} | {} | {} | {} |", row[0], row[1], row[2], row[3]);
        sum.iter_mut().zip(row).for_each(|(sum, number)| *sum += number);
    }
    let [all, covered, close, unknown] = sum;
    println!("| all | {all} | {covered} | {close} | {unknown} |\n{missed}");
    // 95 of 100 of those that are stated.
    assert!(20 * covered >= 19 * (all - unknown), "{covered} of {all}, {unknown} unknown\n{missed}");
}

#[test]
fn the_pressure_of_a_contact_that_reaches_the_border_is_not_resolved() {
    // The sharp edge of the body is not seen on these grids: they have 19.57, 19.62 and 19.66 kPa, in the middle; cells of a quarter 29.
    let text = r#"
domain = { cells = [40, 40], size = ["1 mm", "1 mm"] }
surface = [{ kind = "ellipsoid", radius_x = "10 mm", radius_y = "20 mm" }]
body = [{ poisson = 0.3, material = { model = "elastic", young = "0.8568 MPa" } }]
load = { control = "load", history = { kind = "step", value = "8.45532 mN" } }
time = { end = "1 s", steps = 1 }
"#;
    let bar =
        |text: &str, name: &str| found(text, false).bars.into_iter().find(|bar| bar.name == name).unwrap();
    let pressure = bar(text, "max_pressure");
    assert!(pressure.error.is_none() && pressure.note.contains("border of the free domain"), "{pressure:?}");
    // Area and approach have their limits, and a hardness limits the pressure where cells reach it.
    assert!(bar(text, "approach").error.is_some() && bar(text, "contact_area").error.is_some());
    for (hardness, is_known) in [("15 kPa", true), ("25 kPa", false)] {
        let hard = text.replace("poisson = 0.3,", &format!("poisson = 0.3, hardness = \"{hardness}\","));
        assert_eq!(bar(&hard, "max_pressure").error.is_some(), is_known, "{hardness}");
    }
}

#[test]
fn the_friction_of_a_row_is_known_no_better_than_the_row_says() {
    let text = r#"
domain = { cells = [24, 24], size = ["1 mm", "1 mm"] }
surface = [{ kind = "sphere", radius = "10 mm" }]
body = [{ poisson = 0.3, material = { model = "zener", shear = "1 MPa", shear_kelvin = "0.440211 MPa", retardation_time = "0.152949 s" } }]
load = { control = "load", history = { kind = "step", value = "10 mN" } }
motion = { steady = { velocities = ["0.0953596 mm/s"] } }
"#;
    let found = found(text, false);
    let own = found.answers.iter().find(|answer| answer.name == "friction_coefficient").unwrap();
    assert!(own.of_cells > 0.05 * own.value, "{own:?}");
    for name in ["friction_coefficient", "friction_force"] {
        let bar = found.bars.iter().find(|bar| bar.name == name).unwrap();
        let exact = answers_on(text, 192).into_iter().find(|answer| answer.name == name).unwrap().value;
        let value = bar.value.unwrap();
        // The two ways to compute the force differ by 7 %.
        assert!(
            bar.error.unwrap() >= 0.07 * value && (value - exact).abs() <= bar.error.unwrap(),
            "{bar:?} {exact}"
        );
    }
}

#[test]
fn the_stiffness_along_the_surfaces_of_bodies_that_relax_has_no_limit_where_the_motion_turns() {
    let case = |body: &str, kind: &str| {
        format!(
            "domain = {{ cells = [12, 12], size = [1e-3, 1e-3] }}\nsurface = [{{ kind = \"flat-punch\", radius = 1.0 }}]\nload = {{ control = \"load\", history = {{ kind = \"step\", value = 5e-3 }} }}\nfriction = {{ coefficient = 0.4 }}\ntangential = {{ control = \"force\", x = {kind} }}\ntime = {{ end = 2.25, steps = 18 }}\n{body}"
        )
    };
    let sine = "{ kind = \"sine\", mean = 0.0, amplitude = 1e-3, frequency = 1.0 }";
    let ramp = "{ kind = \"ramp\", value = 1e-3, duration = 2.25 }";
    for (body, history, is_known) in [(ZENER, sine, false), (ZENER, ramp, true), (ELASTIC, sine, true)] {
        let found = found(&case(body, history), false);
        let bar = found.bars.iter().find(|bar| bar.name == "tangential_stiffness").unwrap();
        assert_eq!(bar.error.is_some(), is_known, "{bar:?}");
        if let Some(energy) = found.bars.iter().find(|bar| bar.name == "loop_energy").filter(|_| !is_known) {
            // 8 rows in a loop: straight lines take 10 % off an ellipse.
            assert!(energy.error.unwrap() > 0.1 * energy.value.unwrap(), "{energy:?}");
        }
    }
}
