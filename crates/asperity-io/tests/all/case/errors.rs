//! A table of faults: an edit of a good case, and what the error must say about it.

use std::path::Path;

use asperity_io::Code;
use asperity_io::case::{Case, CaseError, CaseErrors};

use crate::wording;

/// A good case with one of everything that the faults below need.
const GOOD: &str = r#"title = "good"
[domain]
cells = [32, 16]
size = ["2 mm", "1 mm"]
boundary = "free"
[[surface]]
kind = "sphere"
radius = "10 mm"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.01
longest = "0.5 mm"
shortest = "0.2 mm"
seed = 1
[[body]]
name = "first"
poisson = 0.4
hardness = "10 MPa"
material = { model = "zener", shear = "2 MPa", shear_kelvin = "2 MPa", retardation_time = "1 s" }
[[body]]
poisson = 0.3
[body.material]
model = "prony"
modulus = "young"
equilibrium = "1 GPa"
terms = [
  { modulus = "1 GPa", time = "1 s" },
  { modulus = "2 GPa", time = "10 s" },
]
[load]
control = "load"
history = { kind = "table", points = [
  ["0 s", "0 N"],
  ["1 s", "2 N"],
  ["2 s", "1 N"],
] }
[time]
end = "10 s"
steps = 20
[solver]
method = "projected-cg"
tolerance = 1e-6
[output]
fields = ["pressure"]
times = ["1 s", "5 s"]
"#;

fn errors(text: &str) -> Vec<CaseError> {
    match Case::parse(text, Path::new("."), &[]) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(errors) => errors.errors,
    }
}

/// Replaces `old` by `new` in the good case; the first error has the key, the line, the code and the numbers.
#[track_caller]
fn says(old: &str, new: &str, key: &str, line: usize, code: &str, numbers: &[&str]) {
    assert!(GOOD.contains(old), "{old:?} is not in the good case");
    let text = GOOD.replacen(old, new, 1);
    let found = &errors(&text)[0];
    let shown = found.to_string();
    assert_eq!((found.key.as_str(), found.line), (key, Some(line)), "{shown}");
    assert_eq!(found.code.to_string(), code, "{shown}");
    for number in numbers {
        assert!(shown.contains(number), "{shown:?} lacks {number:?}");
    }
    let input = if new.is_empty() { format!("without {old}") } else { new.to_owned() };
    wording::check(&input, Path::new("."), found);
    assert!(shown.contains(key) || key.contains('.'), "{shown:?} does not name {key}");
    let span = found.span.clone().unwrap();
    assert!(text.get(span.clone()).is_some_and(|there| !there.is_empty()), "{shown}: {span:?}");
    assert_eq!(text[..span.start].matches('\n').count() + 1, line);
}

#[test]
fn the_good_case_is_good() {
    let case = Case::parse(GOOD, Path::new("."), &[]).unwrap();
    assert_eq!(case.bodies.len(), 2);
    case.simulation().unwrap();
}

#[test]
fn units_and_numbers() {
    says(
        "\"10 MPa\"",
        "\"10 m\"",
        "body[0].hardness",
        19,
        "wrong-unit",
        &["\"10 m\"", "a pressure greater than 0", "such as \"300 MPa\""],
    );
    says("\"10 MPa\"", "\"10 mpa\"", "body[0].hardness", 19, "wrong-unit", &[]);
    says("\"10 mm\"", "\"10,5 mm\"", "surface[0].radius", 8, "wrong-type", &[]);
    says("\"10 mm\"", "\"ten mm\"", "surface[0].radius", 8, "wrong-type", &[]);
    says("\"10 mm\"", "true", "surface[0].radius", 8, "wrong-type", &["a length greater than 0"]);
    says("\"10 mm\"", "2020-01-01", "surface[0].radius", 8, "wrong-type", &["a length greater than 0"]);
    says("\"10 mm\"", "nan", "surface[0].radius", 8, "out-of-range", &[]);
    says("\"10 mm\"", "-inf", "surface[0].radius", 8, "out-of-range", &[]);
    says("0.4", "nan", "body[0].poisson", 18, "out-of-range", &[]);
    says("1e-6", "inf", "solver.tolerance", 43, "out-of-range", &[]);
    says("\"10 mm\"", "-0.01", "surface[0].radius", 8, "out-of-range", &["is -0.01"]);
    says(
        "\"1 s\" }",
        "\"inf\" }",
        "body[0].material.retardation_time",
        20,
        "out-of-range",
        &["a time greater than 0"],
    );
    says("0.8", "1.2", "surface[1].hurst", 11, "out-of-range", &["greater than 0 and at most 1"]);
    says("0.4", "0.51", "body[0].poisson", 18, "out-of-range", &["is 0.51", "at most 0.5"]);
    says("1e-6", "1", "solver.tolerance", 43, "out-of-range", &["from 1e-14 to 0.1"]);
    says("seed = 1", "seed = -1", "surface[1].seed", 15, "out-of-range", &["a whole number, 0 or more"]);
    says("seed = 1", "seed = 1.5", "surface[1].seed", 15, "wrong-type", &["a whole number, 0 or more"]);
}

#[test]
fn keys_and_words() {
    says("hardness", "hardnes", "body[0].hardnes", 19, "unknown-key", &["body[0] has no key `hardnes`"]);
    says("shear_kelvin", "shear2", "body[0].material.shear2", 20, "unknown-key", &["has no key `shear2`"]);
    says(
        "modulus = \"1 GPa\"",
        "moduls = \"1 GPa\"",
        "body[1].material.terms[0].moduls",
        28,
        "unknown-key",
        &[],
    );
    says("[solver]", "[sovler]", "sovler", 41, "unknown-key", &[]);
    says("[solver]", "[wheel]", "wheel", 41, "unknown-key", &[]);
    says("\"zener\"", "\"zenner\"", "body[0].material.model", 20, "unknown-kind", &[]);
    says("\"load\"", "\"force\"", "load.control", 32, "unknown-kind", &[]);
    says("\"free\"", "3", "domain.boundary", 5, "wrong-type", &[]);
    says("title = \"good\"", "title = 50 N", "", 1, "syntax", &[]);
    says("[\"pressure\"]", "[\"presure\"]", "output.fields[0]", 45, "unknown-kind", &[]);
    says("poisson = 0.4\n", "", "body[0]", 16, "missing-key", &[]);
    says("radius = \"10 mm\"\n", "", "surface[0].radius", 6, "missing-key", &["add radius = \"0.5 mm\""]);
    says("kind = \"sphere\"\n", "", "surface[0].kind", 6, "missing-key", &[]);
    says("control = \"load\"\n", "", "load.control", 31, "missing-key", &[]);
    says("steps = 20\n", "", "time.steps", 38, "missing-key", &["add steps = 100"]);
    says("title = \"good\"", "title = good", "", 1, "syntax", &[]);
    says("title = \"good\"", "title = \"good\"\ntitle = \"twice\"", "", 2, "syntax", &[]);
    says("poisson = 0.3", "poisson = 0.3\nbulk_modulus = \"4 GPa\"", "body[1]", 21, "conflict", &[]);
    says("rms_gradient = 0.01", "rms_gradient = 0.01\nrms_height = 1e-6", "surface[1]", 9, "conflict", &[]);
}

#[test]
fn a_retired_key_says_what_to_do() {
    says("tolerance = 1e-6", "precision = \"mixed\"", "solver.precision", 43, "unknown-key", &[]);
    let overridden = Case::parse(GOOD, Path::new("."), &["solver.precision=double".into()]).unwrap_err();
    assert_eq!(overridden.errors[0].code, Code::UnknownKey);
}

#[test]
fn a_missing_section_is_named_with_its_header() {
    for (start, end, words) in [
        ("[domain]", "[[surface]]", "the section [domain] is missing"),
        ("[[surface]]", "[[body]]", "the section [[surface]] is missing"),
        ("[[body]]", "[load]", "the section [[body]] is missing"),
        ("[load]", "[time]", "the section [load] is missing"),
        ("[time]", "[solver]", "the section [time] is missing"),
    ] {
        let (from, to) = (GOOD.find(start).unwrap(), GOOD.find(end).unwrap());
        let found = errors(&format!("{}{}", &GOOD[..from], &GOOD[to..]));
        assert!(found[0].to_string().contains(words), "{found:?}");
    }
    let found = errors("");
    assert_eq!(found.len(), 5, "{found:?}");
}

#[test]
fn shapes_of_values() {
    says("[32, 16]", "[32]", "domain.size", 4, "out-of-range", &[]);
    says("[32, 16]", "[32, 16, 8]", "domain.cells", 3, "wrong-type", &[]);
    says("[32, 16]", "32", "domain.cells", 3, "wrong-type", &[]);
    says("[32, 16]", "[32, 0]", "domain.cells[1]", 3, "out-of-range", &["is 0", "a whole number, 1 or more"]);
    says(
        "[32, 16]",
        "[32, -5]",
        "domain.cells[1]",
        3,
        "out-of-range",
        &["is -5", "a whole number, 1 or more"],
    );
    says("[32, 16]", "[32, \"16\"]", "domain.cells[1]", 3, "wrong-type", &["a whole number, 1 or more"]);
    says("\"1 mm\"]", "\"0 mm\"]", "domain.size[1]", 4, "out-of-range", &["a length greater than 0"]);
    says("[[surface]]\nkind = \"self-affine\"", "[x]\nkind = \"self-affine\"", "x", 9, "unknown-key", &[]);
    says("[\"1 s\", \"2 N\"]", "[\"1 s\"]", "load.history.points[1]", 35, "wrong-type", &[]);
    says("fields = [\"pressure\"]", "fields = \"pressure\"", "output.fields", 45, "wrong-type", &[]);
    says("name = \"first\"", "name = 1", "body[0].name", 17, "wrong-type", &[]);
    says("[\"1 s\", \"5 s\"]", "[]\ncheckpoint = \"yes\"", "output.checkpoint", 47, "wrong-type", &[]);
    let surface = "[surface]\nkind = \"sphere\"\n";
    let from = GOOD.find("[[surface]]").unwrap();
    let to = GOOD.find("[[body]]").unwrap();
    let found = errors(&format!("{}{surface}{}", &GOOD[..from], &GOOD[to..]));
    assert!(found[0].to_string().contains("begin each with a line [[surface]]"), "{found:?}");
}

#[test]
fn sizes() {
    // 2 bodies of 1 and 2 terms: 3 fields. 1e6 * 1e6 * (200 + 48) bytes = 248 TB.
    says(
        "[32, 16]",
        "[1000000, 1000000]",
        "domain.cells",
        3,
        "too-large",
        &["1000000 x 1000000 cells", "50.9 TiB"],
    );
    says(
        "[32, 16]",
        "[9223372036854775807, 9223372036854775807]",
        "domain.cells",
        3,
        "too-large",
        &["9223372036854775807 x 9223372036854775807"],
    );
    says(
        "[32, 16]",
        "[10000000, 1]",
        "domain.cells",
        3,
        "out-of-range",
        &["no longer than 1000 times its width"],
    );
    says(
        "steps = 20",
        "steps = 1000000000000",
        "time.steps",
        40,
        "out-of-range",
        &["is 1000000000000", "10000000"],
    );
    // 2400 x 1600 cells, 1e6 pressure fields of 8 bytes per cell: 28 TiB
    let direct = GOOD
        .replace("steps = 20", "steps = 1000000\nscheme = \"direct\"")
        .replace("[32, 16]", "[2400, 1600]");
    let found = &errors(&direct)[0];
    assert_eq!((found.code, found.key.as_str(), found.line), (Code::TooLarge, "domain.cells", Some(3)));
    assert!(found.message.contains("27.9 TiB"), "{found}");
    wording::check("scheme = \"direct\"", Path::new("."), found);
    let long = format!("title = \"{}\"", "ä".repeat(1001));
    says("title = \"good\"", &long, "title", 1, "out-of-range", &["1001 letters", "1000"]);
    says("\"0.2 mm\"", "\"0.1 mm\"", "surface[1].shortest", 14, "out-of-range", &[]);
    says("\"0.5 mm\"", "\"3 mm\"", "surface[1].longest", 13, "out-of-range", &[]);
}

#[test]
fn loads() {
    let at = "load.history.points[1][1]";
    says("\"2 N\"", "\"-2 N\"", at, 35, "out-of-range", &["\"-2 N\"", "not less than 0"]);
    says("\"2 N\"", "\"2 MPa\"", at, 35, "wrong-unit", &[]);
    // 10 MPa on 2 mm^2 is 20 N
    says("\"2 N\"", "\"21 N\"", at, 35, "infeasible", &["21 N", "20 N"]);
    says(
        "\"1 s\", \"2 N\"",
        "\"3 s\", \"2 N\"",
        "load.history.points[2]",
        36,
        "out-of-range",
        &["at 3 s or later"],
    );
    says(
        "\"0 s\", \"0 N\"",
        "\"0.5 s\", \"0 N\"",
        "load.history.points[0]",
        34,
        "out-of-range",
        &["a point at 0 s"],
    );
    says(
        "[\"2 s\", \"1 N\"]",
        "[\"1 s\", \"3 N\"],\n [\"1 s\", \"4 N\"]",
        "load.history",
        33,
        "out-of-range",
        &[],
    );
    says(
        "control = \"load\"",
        "control = \"pressure\"",
        "load.history.points[0][1]",
        34,
        "wrong-unit",
        &["a pressure not less than 0"],
    );
    says("control = \"load\"", "control = \"approach\"", "load.history.points[0][1]", 34, "wrong-unit", &[]);
    let table = &GOOD[GOOD.find("history = ").unwrap()..GOOD.find("[time]").unwrap()];
    let sine =
        "history = { kind = \"sine\", mean = \"1 N\", amplitude = \"2 N\", frequency = \"0.05 Hz\" }\n";
    says(table, sine, "load.history.amplitude", 33, "out-of-range", &["-1 N"]);
    let flat = "history = { kind = \"ramp\", value = \"1 N\", duration = \"0 s\" }\n";
    says(table, flat, "load.history.duration", 33, "out-of-range", &["a time greater than 0"]);
    let missing = "history = { kind = \"file\", path = \"nowhere.csv\" }\n";
    says(table, missing, "load.history.path", 33, "file", &[]);
}

#[test]
fn a_jump_needs_bodies_that_yield_at_once() {
    let from = GOOD.find("[[body]]").unwrap();
    let to = GOOD.find("[load]").unwrap();
    let kelvin = "[[body]]\npoisson = 0.5\nmaterial = { model = \"kelvin-voigt\", young = \"1 MPa\", retardation_time = 1 }\n";
    let ramped = format!("{}{kelvin}{}", &GOOD[..from], &GOOD[to..]);
    Case::parse(&ramped, Path::new("."), &[]).unwrap(); // the table has no jump
    for (old, new, at) in [
        ("[\"0 s\", \"0 N\"]", "[\"0 s\", \"1 N\"]", "t = 0 s is 0 to 1"),
        ("[\"2 s\", \"1 N\"]", "[\"1 s\", \"1 N\"]", "t = 1 s is 2 to 1"),
    ] {
        let found = errors(&ramped.replacen(old, new, 1));
        assert_eq!(found[0].key, "load.history");
        assert!(found[0].message.contains(at), "{}", found[0]);
        wording::check(new, Path::new("."), &found[0]);
    }
}

#[test]
fn times() {
    let grid = "end = \"10 s\"\nsteps = 20\n";
    says(
        grid,
        "times = [\"1 s\", \"3 s\", \"2 s\"]\n",
        "time.times[2]",
        39,
        "out-of-range",
        &["is \"2 s\"", "later than the time before it, 3 s"],
    );
    says(
        grid,
        "times = [\"0 s\", \"3 s\"]\n",
        "time.times[0]",
        39,
        "out-of-range",
        &["a time greater than 0"],
    );
    says(grid, "times = []\n", "time.times", 39, "out-of-range", &[]);
    says(grid, "times = [1]\nsteps = 3\n", "time.steps", 40, "conflict", &[]);
    says("steps = 20", "steps = 20\nfirst = \"1 s\"", "time.first", 41, "conflict", &[]);
    says(
        "steps = 20",
        "steps = 20\nspacing = \"log\"\nfirst = \"11 s\"",
        "time.first",
        42,
        "out-of-range",
        &["10 s"],
    );
    says(
        "[\"1 s\", \"5 s\"]",
        "[\"5 s\", \"1 s\"]",
        "output.times[1]",
        46,
        "out-of-range",
        &["later than the time before it, 5 s"],
    );
    says(
        "[\"1 s\", \"5 s\"]",
        "[\"5 s\", \"15 s\"]",
        "output.times[1]",
        46,
        "out-of-range",
        &["the end of the run, 10 s"],
    );
    says("[\"1 s\", \"5 s\"]", "[\"5 s\"]\nevery = 3", "output.times", 46, "conflict", &[]);
    says(
        "[\"1 s\", \"5 s\"]",
        "[]\nevery = 0",
        "output.every",
        47,
        "out-of-range",
        &["a whole number, 1 or more"],
    );
    says("[\"1 s\", \"5 s\"]", "[]\npath = \"\"", "output.path", 47, "out-of-range", &[]);
}

#[test]
fn materials() {
    let material = "body[0].material";
    says("shear_kelvin", "young_kelvin", material, 20, "conflict", &[]);
    says("shear = \"2 MPa\", ", "", material, 20, "missing-key", &[]);
    says("shear = \"2 MPa\", ", "shear = 1, young = 2, ", material, 20, "conflict", &[]);
    says("{ modulus = \"2 GPa\"", "{ fraction = 0.5", "body[1].material.terms[1]", 29, "missing-key", &[]);
    says("equilibrium = \"1 GPa\"\n", "", "body[1].material", 23, "missing-key", &[]);
    says(
        "equilibrium = \"1 GPa\"",
        "equilibrium = \"-1 GPa\"",
        "body[1].material.equilibrium",
        26,
        "out-of-range",
        &["not less than 0"],
    );
    let prony = &GOOD[GOOD.find("equilibrium").unwrap()..GOOD.find("[load]").unwrap()];
    let fractions =
        "instantaneous = \"1 GPa\"\nterms = [{ fraction = 0.7, time = 1 }, { fraction = 0.4, time = 2 }]\n";
    says(prony, fractions, "body[1].material", 23, "out-of-range", &["1.1", "at most 1"]);
    let soft = "poisson = 0.3\n";
    says(soft, "bulk_modulus = \"1 MPa\"\n", "body[1]", 21, "out-of-range", &["bulk modulus of body 2"]);
    let rigid = "{ model = \"creep\", compliance = \"shear\", instantaneous = 0, terms = [] }";
    let zener = &GOOD[GOOD.find("{ model").unwrap()..GOOD.find("\n[[body]]\npoisson").unwrap()];
    says(zener, rigid, material, 20, "out-of-range", &[]);
    let third = "[[body]]\npoisson = 0.3\nmaterial = { model = \"elastic\", young = 1 }\n[load]";
    says("[load]", third, "body[2]", 31, "conflict", &[]);
    let many = format!("terms = [{}]\n", "{ modulus = 1, time = 1 },".repeat(2000));
    let terms = &GOOD[GOOD.find("terms").unwrap()..GOOD.find("[load]").unwrap()];
    says(terms, &many, "body[1].material.terms", 27, "conflict", &["2000 terms", "may have 1000"]);
}

#[test]
fn what_this_version_lacks_is_refused_not_ignored() {
    says("\"sphere\"", "\"array\"", "surface[0].kind", 7, "unknown-kind", &[]);
}

#[test]
fn what_a_quantity_or_a_dent_needs_is_said() {
    let of = |list: &str| format!("fields = [\"pressure\"]\nquantities = [{list}]");
    let fields = "fields = [\"pressure\"]";
    says(fields, &of("\"contact_stifness\""), "output.quantities[0]", 46, "unknown-kind", &[]);
    let bins = format!("{}\nhistogram = {{ bins = 20000 }}", of("\"gap_histogram\""));
    says(fields, &bins, "output.histogram.bins", 47, "out-of-range", &["20000", "10000"]);
    let flat = format!("{}\nhistogram = {{ pressure = \"0 Pa\" }}", of("\"pressure_histogram\""));
    says(fields, &flat, "output.histogram.pressure", 47, "out-of-range", &["0 Pa"]);
    says(fields, "fields = [\"flattening\"]", "output.fields[0]", 45, "conflict", &[]);
    let soft = GOOD.replace("hardness = \"10 MPa\"\n", "");
    let asked = soft.replace(fields, &of("\"all\", \"pressure_histogram\""));
    let direct = GOOD.replace("steps = 20", "steps = 20\nscheme = \"direct\"");
    for (text, key, code) in [
        (asked, "output.quantities", Code::OutOfRange),
        (soft.replace("1e-6", "1e-6\nplasticity = \"accumulate\""), "solver.plasticity", Code::OutOfRange),
        (direct.replace(fields, &of("\"elastic_energy\"")), "output.quantities[0]", Code::OutOfRange),
    ] {
        let found = &errors(&text)[0];
        assert_eq!((found.key.as_str(), found.code), (key, code), "{found}");
        wording::check(key, Path::new("."), found);
    }
}

#[test]
fn stages_and_adaptive_steps() {
    let old = &GOOD[GOOD.find("control = \"load\"").unwrap()..GOOD.find("[time]").unwrap()];
    let stages = |stages: &str| format!("stages = [\n{stages}\n]\n");
    let hold = r#"{ control = "approach", history = { kind = "hold" } }"#;
    let press = r#"{ control = "load", history = { kind = "step", value = "1 N" }, duration = "1 s" }"#;
    says(old, &stages(""), "load.stages", 32, "out-of-range", &[]);
    says(
        "control = \"load\"",
        &format!("control = \"load\"\nstages = [{hold}]"),
        "load.control",
        32,
        "conflict",
        &[],
    );
    says(old, "", "load.control", 31, "missing-key", &[]);
    says(old, &stages(&format!("{hold},\n{press}")), "load.stages[0]", 33, "conflict", &[]);
    let edit = |from: &str, to: &str| stages(&format!("{press},\n{}", hold.replacen(from, to, 1)));
    let at = "load.stages[1]";
    says(old, &edit("\"hold\"", "\"holt\""), "load.stages[1].history.kind", 34, "unknown-kind", &[]);
    let until = |until: &str| edit(" } }", &format!(" }}, until = {until} }}"));
    says(old, &until("\"contact-last\""), "load.stages[1].until", 34, "unknown-kind", &[]);
    says(old, &until("{ load = \"2 um\" }"), "load.stages[1].until.load", 34, "wrong-unit", &[]);
    says(old, &until("{ load = 1, approach = 2 }"), "load.stages[1].until", 34, "wrong-type", &[]);
    // Values that no row can have: a share above 1, more than the domain, a negative area, more than the hardness of 10 MPa bears.
    for (number, value, key) in [
        ("contact_fraction", "2", "load.stages[1].until.contact_fraction"),
        ("contact_area", "\"1 m2\"", "load.stages[1].until.contact_area"),
        ("largest_spot", "\"-1 mm2\"", "load.stages[1].until.largest_spot"),
        ("contact_percolation", "4", "load.stages[1].until.contact_percolation"),
        ("max_pressure", "\"11 MPa\"", "load.stages[1].until.max_pressure"),
        ("pressure", "\"11 MPa\"", "load.stages[1].until.pressure"),
    ] {
        says(
            old,
            &until(&format!("{{ {number} = {value} }}")),
            key,
            34,
            "out-of-range",
            &["values that it can have"],
        );
    }
    for good in
        ["contact_fraction = 1", "max_pressure = \"10 MPa\"", "mean_gap = \"-1 nm\"", "contact_spots = 3"]
    {
        let text = GOOD.replacen(old, &until(&format!("{{ {good} }}")), 1);
        assert!(Case::parse(&text, Path::new("."), &[]).is_ok(), "{good}");
    }
    says(
        old,
        &until("{ contact_area = \"1 um\" }"),
        "load.stages[1].until.contact_area",
        34,
        "wrong-unit",
        &[],
    );
    says(old, &until("{ friction_force = \"1 N\" }"), "load.stages[1].until", 34, "out-of-range", &[]);
    says(old, &edit(" } }", " }, steps = 5 }"), at, 34, "conflict", &[]);
    let ends = |more: &str| edit(" } }", &format!(" }}, duration = 5, {more} }}"));
    says(old, &ends("spacing = \"log\""), "load.stages[1].steps", 34, "missing-key", &[]);
    says(old, &ends("steps = 5, tolerance = 1e-3"), "load.stages[1].tolerance", 34, "conflict", &[]);
    let jump = r#"{ control = "load", history = { kind = "step", value = "30 N" } }"#;
    says(
        old,
        &stages(&format!("{press},\n{jump}")),
        "load.stages[1].history.value",
        34,
        "infeasible",
        &["20 N"],
    );
    // The grid of the run.
    says("steps = 20", "steps = 20\nspacing = \"adaptive\"", "time.steps", 40, "conflict", &[]);
    says(
        "steps = 20",
        "spacing = \"adaptive\"\ntolerance = 0.5",
        "time.tolerance",
        41,
        "out-of-range",
        &["between 1e-9 and 0.1"],
    );
    says("steps = 20", "steps = 20\ntolerance = 1e-3", "time.tolerance", 41, "conflict", &[]);
    says(
        "steps = 20",
        "spacing = \"adaptive\"\nscheme = \"constant\"",
        "time.scheme",
        41,
        "out-of-range",
        &[],
    );
    says("steps = 20", "spacing = \"adaptive\"\nfirst = \"11 s\"", "time.first", 41, "out-of-range", &[]);
    let hold = "control = \"load\"\nhistory = { kind = \"hold\" }\n";
    says(old, hold, "load.history", 33, "conflict", &[]);
}

#[test]
fn several_sections_report_at_once_in_order_of_place() {
    let text = GOOD
        .replace("0.8", "8")
        .replace("\"10 MPa\"", "\"10 m\"")
        .replace("steps = 20", "steps = 0")
        .replace("\"projected-cg\"", "\"cg\"");
    let found = errors(&text);
    let keys: Vec<&str> = found.iter().map(|error| error.key.as_str()).collect();
    assert_eq!(keys, ["surface[1].hurst", "body[0].hardness", "time.steps", "solver.method"]);

    let text = GOOD.replace("\"2 N\"", "\"21 N\"").replace("\"5 s\"]", "\"15 s\"]").replace("\"3 mm\"", "");
    let found = errors(&text);
    let keys: Vec<&str> = found.iter().map(|error| error.key.as_str()).collect();
    assert_eq!(keys, ["load.history.points[1][1]", "output.times[1]"]);
}

#[test]
fn a_long_bad_list_does_not_drown_the_user() {
    let points: String = (0..20_000).map(|n| format!("[\"{n} s\", \"-1 N\"],\n")).collect();
    let table = &GOOD[GOOD.find("history = ").unwrap()..GOOD.find("[time]").unwrap()];
    let text = GOOD.replace(table, &format!("history = {{ kind = \"table\", points = [{points}] }}\n"));
    assert!(errors(&text).len() <= 20);
    let surfaces = format!("{GOOD}\n{}", "[[surface]]\nkind = \"cone\"\nslope = -1\n".repeat(5000));
    assert!(errors(&surfaces).len() <= 20);
}

#[test]
fn the_display_names_the_file_and_every_fault() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("my case.toml");
    std::fs::write(&path, GOOD.replace("0.4", "4").replace("1e-6", "1")).unwrap();
    let errors: CaseErrors = Case::read(&path, &[]).unwrap_err();
    let shown = errors.to_string();
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!(lines.len(), 2, "{shown}");
    assert!(lines.iter().all(|line| line.starts_with(&path.display().to_string())));
    assert!(lines[0].ends_with(
        "my case.toml: line 18: body[0].poisson is 4, but must be a number greater than -1 and at most 0.5, such as 0.38"
    ));
}

#[test]
fn a_file_that_is_none_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let says = |path: &Path, words: &[&str]| {
        let shown = Case::read(path, &[]).unwrap_err().to_string();
        for word in words {
            assert!(shown.contains(word), "{shown}");
        }
    };
    says(&dir.path().join("none.toml"), &["none.toml: the file does not exist", "asperity new"]);
    says(dir.path(), &["is a directory, not a file", "name a case file"]);
    let binary = dir.path().join("binary.toml");
    std::fs::write(&binary, b"title = 1\nx = \xff\xfe").unwrap();
    says(&binary, &["not UTF-8 text (line 2, byte 14)"]);
    let large = dir.path().join("large.toml");
    std::fs::File::create(&large).unwrap().set_len(17 << 20).unwrap();
    says(&large, &["larger than 16 MB"]);
}

#[test]
fn overrides_are_read_as_if_written() {
    let with = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|text| text.to_string()).collect();
        Case::parse(GOOD, Path::new("."), &overrides)
    };
    let case = with(&["domain.cells=[64,8]", "body.0.hardness=20 MPa", "output.fields=[]"]);
    // 2 mm / 64 would need a shortest wavelength of two cells of 1 mm / 8
    let shown = case.unwrap_err().to_string();
    assert!(shown.contains("surface[1].shortest") && shown.contains("line 14"), "{shown}");
    let case = with(&["domain.cells=[64,32]", "body[0].hardness=20 MPa", "output.fields=[]"]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.conditions.hardness), ([64, 32], 20e6));
    assert!(case.output.fields.is_empty() && case.source.contains("cells = [64,32]"));

    // A new key moves the lines behind it, but not their numbers.
    let error = &with(&["time.scheme=linear", "body.1.name=x", "solver.tolerance=1"]).unwrap_err().errors[0];
    assert_eq!((error.key.as_str(), error.line), ("solver.tolerance", Some(43)));
    let error = &with(&["body.0.hardnes=20 MPa"]).unwrap_err().errors[0];
    assert_eq!(error.key, "body[0].hardnes");
    assert_eq!(error.help.as_deref(), Some("set by an override; did you mean `hardness`?"));
    let shown = with(&["body.7.name=x"]).unwrap_err().to_string();
    assert!(shown.contains("body[7].name cannot be set: there is no element 7, the list has 2"), "{shown}");
    assert!(with(&["nonsense"]).unwrap_err().to_string().contains("KEY=VALUE"));
}

#[test]
fn a_table_that_is_a_list_is_refused_at_any_depth() {
    let (start, end) = (GOOD.find("history = ").unwrap(), GOOD.find("[time]").unwrap());
    for (old, new, key) in [
        ("[body.material]", "[[body.material]]", "body[1].material"),
        ("[time]", "[[motion.steady]]\nvelocities = [\"1 m/s\"]\n[time]", "motion.steady"),
        (&GOOD[start..end], "[[load.history]]\nkind = \"step\"\nvalue = \"1 N\"\n", "load.history"),
    ] {
        assert!(GOOD.contains(old));
        let text = GOOD.replacen(old, new, 1);
        let errors = Case::parse(&text, Path::new("."), &[]).unwrap_err().errors;
        let found = errors.iter().find(|error| error.key == key);
        assert!(
            found.is_some_and(|error| error.message.contains("a table, not a list")),
            "{key}: {errors:?}"
        );
    }
}

#[test]
fn a_section_that_is_a_list_is_refused_as_one() {
    for section in ["domain", "load", "time"] {
        let text = GOOD.replace(&format!("[{section}]"), &format!("[[{section}]]"));
        let errors = Case::parse(&text, Path::new("."), &[]).unwrap_err().to_string();
        let wanted = format!("{section} is");
        assert!(errors.contains(&wanted) || errors.contains(&format!("{section} must be")), "{errors}");
        assert!(
            errors.contains("a table, not a list") && errors.contains(&format!("[{section}]")),
            "{errors}"
        );
    }
}

#[test]
fn numbers_that_cannot_be_meant_are_refused_at_their_key() {
    for (set, key) in [
        ("domain.size=[\"1e300 m\", \"1 m\"]", "domain.size[0]"),
        ("domain.size=[\"1 m\", \"1e-300 m\"]", "domain.size[1]"),
        ("load.history={ kind = \"step\", value = \"1e300 N\" }", "load.history.value"),
        ("body.0.hardness=1e307 Pa", "body[0].hardness"),
        ("time.end=1e300 s", "time.end"),
    ] {
        let errors = Case::parse(GOOD, Path::new("."), &[set.to_owned()]).unwrap_err().to_string();
        assert!(
            errors.contains(key) && errors.contains("no quantity of a contact is that"),
            "{set}: {errors}"
        );
    }
}
