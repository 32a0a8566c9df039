//! Which features go together: every pair as a case, and what the case says. docs/combinations.md holds the table.
//!
//! After a change, `ASPERITY_COMBINATIONS=write cargo test -p asperity-io --test all combinations` writes the page; read the difference.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use asperity_io::case::Case;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/combinations.md");

const HEAD: &str = "# What goes together

Each feature with each other one, as a case that `asperity check` accepts (`·`) or refuses (a letter: the reason is below). A blank is a pair of
which a case has one or the other. A test checks every pair and writes this page.

```text
";

/// Name, what only one of can be chosen, and what it sets.
type Feature = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

const FEATURES: [Feature; 36] = [
    ("free domain", "domain", &[("boundary", "free")]),
    ("line", "domain", &[("line", "yes")]),
    ("line, free domain", "domain", &[("boundary", "free"), ("line", "yes")]),
    ("elastic body", "material", &[("material", "elastic")]),
    ("constant bulk modulus", "lateral", &[("lateral", "bulk_modulus = '2 GPa'")]),
    ("temperature ramp", "temperature", &[("warms", "yes")]),
    ("two viscoelastic bodies", "bodies", &[("two", "yes")]),
    ("layer of the same law", "layer", &[("layer", "same")]),
    ("layer of another law", "layer", &[("layer", "other")]),
    ("load control", "control", &[("control", "load")]),
    ("approach control", "control", &[("control", "approach")]),
    ("stages with an event", "event", &[("event", "yes")]),
    ("adaptive steps", "steps", &[("steps", "spacing = 'adaptive'\ntolerance = 1e-2")]),
    ("logarithmic steps", "steps", &[("steps", "steps = 5\nspacing = 'log'\nfirst = '0.1 s'")]),
    ("scheme = constant", "scheme", &[("scheme", "constant")]),
    ("scheme = direct", "scheme", &[("scheme", "direct")]),
    ("hardness", "hardness", &[("hardness", "hardness = '0.8 MPa'")]),
    ("dents that stay", "hardness", &[("hardness", "hardness = '0.8 MPa'"), ("plasticity", "accumulate")]),
    ("adhesion", "adhesion", &[("adhesion", "yes")]),
    ("partial slip", "tangential", &[("slip", "neglect")]),
    ("partial slip, coupled", "tangential", &[("slip", "full")]),
    ("wear along a path", "wear", &[("wear", "velocity")]),
    ("wear by slip", "wear", &[("wear", "slip"), ("slip", "neglect")]),
    ("wear in motion", "wear", &[("wear", "motion"), ("motion", "slide")]),
    ("sliding", "motion", &[("motion", "slide")]),
    ("rolling", "motion", &[("motion", "roll")]),
    ("steady sliding", "motion", &[("motion", "steady")]),
    ("flash, steady", "flash", &[("flash", "yes"), ("motion", "steady")]),
    ("flash in time", "flash", &[("flash", "yes"), ("motion", "slide")]),
    ("leak of a liquid", "leak", &[("leak", "liquid")]),
    ("leak of a gas", "leak", &[("leak", "gas")]),
    ("fluid, uniform", "leak", &[("leak", "liquid"), ("coupling", "uniform")]),
    ("fluid, two-way", "leak", &[("leak", "liquid"), ("coupling", "two-way")]),
    ("stress", "stress", &[("stress", "yes")]),
    ("energies", "energies", &[("energies", "yes")]),
    ("contact stiffness", "stiffness", &[("stiffness", "yes")]),
];

const SOFT: &str = "model = 'zener', shear = '5 MPa', shear_kelvin = '2 MPa', retardation_time = '10 s'";
const STIFF: &str = "model = 'zener', shear = '50 MPa', shear_kelvin = '9 MPa', retardation_time = '2 s'";

/// What a case has; nothing is "".
struct Chosen(BTreeMap<&'static str, &'static str>);

impl Chosen {
    /// `None` where features contradict each other.
    fn of(features: &[&Feature]) -> Option<Chosen> {
        let mut chosen = BTreeMap::new();
        for (key, value) in features.iter().flat_map(|feature| feature.2) {
            if chosen.insert(*key, *value).is_some_and(|before| before != *value) {
                return None;
            }
        }
        Some(Chosen(chosen))
    }

    fn get(&self, key: &str) -> &'static str {
        self.0.get(key).copied().unwrap_or_default()
    }

    fn has(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }

    fn case(&self) -> String {
        [self.geometry(), self.bodies(), self.course(), self.effects(), self.output()].concat()
    }

    fn geometry(&self) -> String {
        let (line, free) = (self.has("line"), self.get("boundary") == "free");
        let (cells, size) = if line { ("[64]", "['100 um']") } else { ("[24, 24]", "['100 um', '100 um']") };
        let boundary = if free { "free" } else { "periodic" };
        let surface = match (line, free) {
            (false, true) => "kind = 'sphere'\nradius = '500 um'",
            (true, true) => "kind = 'cylinder'\nradius = '500 um'",
            _ => {
                "kind = 'self-affine'\nhurst = 0.8\nrms_height = '0.4 um'\nlongest = '50 um'\nshortest = '18 um'\nseed = 3"
            }
        };
        format!("[domain]\ncells = {cells}\nsize = {size}\nboundary = '{boundary}'\n[[surface]]\n{surface}\n")
    }

    fn bodies(&self) -> String {
        let lateral = if self.has("lateral") { self.get("lateral") } else { "poisson = 0.45" };
        let shift = match self.has("warms") {
            true => ", shift = { model = 'wlf', c1 = 8.86, c2 = '101.6 K', reference = '20 °C' }",
            false => "",
        };
        let material = match self.get("material") == "elastic" && !self.has("warms") {
            true => "{ model = 'elastic', young = '20 MPa' }".to_owned(),
            false => format!("{{ {SOFT}{shift} }}"),
        };
        let mut text =
            format!("[[body]]\nname = 'a'\n{lateral}\n{}\nmaterial = {material}\n", self.get("hardness"));
        if self.has("layer") {
            let own = if self.get("layer") == "same" { material } else { format!("{{ {STIFF} }}") };
            let _ = write!(text, "[[body.layer]]\nthickness = '20 um'\npoisson = 0.45\nmaterial = {own}\n");
        }
        if self.has("two") {
            let _ = write!(text, "[[body]]\nname = 'b'\npoisson = 0.3\nmaterial = {{ {STIFF} }}\n");
        }
        text
    }

    fn course(&self) -> String {
        let steady = self.get("motion") == "steady";
        let (control, value) = match self.get("control") {
            "load" if self.has("line") => ("load", "10 N/m"),
            "load" => ("load", "1 mN"),
            "approach" => ("approach", "0.6 um"),
            _ => ("pressure", "0.1 MPa"),
        };
        let mut text = if self.has("event") {
            format!(
                "[load]\nstages = [{{ control = '{control}', history = {{ kind = 'ramp', value = '{value}', duration = '5 s' }}, \
                 until = {{ contact_fraction = 0.05 }} }}, {{ control = '{control}', history = {{ kind = 'hold' }}, duration = '5 s' }}]\n"
            )
        } else {
            let course = if steady { "kind = 'step'" } else { "kind = 'ramp', duration = '2 s'" };
            format!("[load]\ncontrol = '{control}'\nhistory = {{ {course}, value = '{value}' }}\n")
        };
        if self.has("warms") {
            text += match steady {
                true => "[temperature]\nhistory = { kind = 'constant', value = '40 °C' }\n",
                false => {
                    "[temperature]\nhistory = { kind = 'ramp', from = '20 °C', to = '60 °C', duration = '5 s' }\n"
                }
            };
        }
        if !steady {
            let steps = if self.has("steps") { self.get("steps") } else { "steps = 5" };
            let _ = write!(text, "[time]\nend = '10 s'\n{steps}\n");
            if self.has("scheme") {
                let _ = writeln!(text, "scheme = '{}'", self.get("scheme"));
            }
        }
        text += "[solver]\ntolerance = 1e-4\n";
        if self.has("plasticity") {
            text += "plasticity = 'accumulate'\n";
        }
        text
    }

    fn effects(&self) -> String {
        let mut text = String::new();
        if self.has("adhesion") {
            text += "[adhesion]\nwork = '20 mJ/m2'\nrange = '0.5 um'\n";
        }
        if self.has("slip") {
            let _ = write!(text, "[friction]\ncoefficient = 0.5\ncoupling = '{}'\n", self.get("slip"));
            text += "[tangential]\ncontrol = 'displacement'\nx = { kind = 'ramp', value = '0.05 um', duration = '5 s' }\n";
        }
        if self.has("wear") {
            let k = if self.has("two") { "['1e-15 m2/N', '1e-15 m2/N']" } else { "'1e-15 m2/N'" };
            let velocity = if self.get("wear") == "velocity" { "velocity = '1 mm/s'\n" } else { "" };
            let _ = write!(text, "[wear]\ncoefficient = {k}\n{velocity}");
        }
        let shear = if self.has("flash") { "shear_stress = '50 kPa'\n" } else { "" };
        match self.get("motion") {
            "" => {}
            "steady" => {
                let _ = write!(text, "[motion]\ndirection = 'x'\n{shear}");
                text += "[motion.steady]\nvelocities = ['1 um/s', '10 um/s']\n";
            }
            kind => {
                let _ = write!(text, "[motion]\nvelocity = '1 um/s'\nkind = '{kind}'\n{shear}");
            }
        }
        if self.has("flash") {
            text += "[flash]\nconductivity = ['40 W/(m K)', '0.3 W/(m K)']\ndiffusivity = ['1e-5 m2/s', '1e-7 m2/s']\n";
            text += if self.get("boundary") == "free" { "" } else { "heated_for = '10 ms'\n" };
        }
        if self.has("leak") {
            text += match self.get("leak") {
                "liquid" => "[leakage]\ndirection = 'x'\npressure_drop = '1 kPa'\nviscosity = '1 mPa s'\n",
                _ => "[leakage]\ndirection = 'x'\ngas = 'air'\ninlet = '1.01 bar'\noutlet = '1 bar'\n",
            };
            if self.has("coupling") {
                let _ = writeln!(text, "coupling = '{}'", self.get("coupling"));
            }
        }
        if self.has("stress") {
            text += "[stress]\ndepths = ['5 um', '20 um']\n";
        }
        text
    }

    fn output(&self) -> String {
        let mut quantities = vec![];
        if self.has("energies") {
            quantities.extend(["elastic_energy", "dissipated_energy"]);
        }
        if self.has("stiffness") {
            quantities.push("contact_stiffness");
        }
        format!("[output]\nfields = ['pressure', 'gap']\nevery = 2\nquantities = {quantities:?}\n")
    }
}

/// Why a case with these features is refused; the outer `None` where it cannot have both.
fn refusal(features: &[&Feature]) -> Option<Option<String>> {
    let text = Chosen::of(features)?.case();
    let checked = Case::parse(&text, Path::new("."), &[]).and_then(|case| case.examine().map(|_| ()));
    Some(checked.err().map(|errors| {
        let error = &errors.errors[0];
        match &error.help {
            Some(help) => format!("{} ({help})", error.message),
            None => error.message.clone(),
        }
    }))
}

fn page() -> String {
    let names = ('a'..='z').chain('A'..='Z').collect::<Vec<char>>();
    let mut reasons: Vec<String> = vec![];
    let (mut runs, mut refused) = (0, 0);
    let width = FEATURES.iter().map(|feature| feature.0.len()).max().unwrap();
    let mut text = HEAD.to_owned();
    for (row, feature) in FEATURES.iter().enumerate() {
        assert_eq!(refusal(&[feature]), Some(None), "{} alone", feature.0);
        let _ = write!(text, "{:>2} {:width$}", row + 1, feature.0);
        for other in &FEATURES[..row] {
            let found = if other.1 == feature.1 { None } else { refusal(&[other, feature]) };
            let sign = match found {
                None => ' ',
                Some(None) => {
                    runs += 1;
                    '·'
                }
                Some(Some(why)) => {
                    refused += 1;
                    let known = reasons.iter().position(|reason| *reason == why);
                    names[known.unwrap_or_else(|| {
                        reasons.push(why);
                        reasons.len() - 1
                    })]
                }
            };
            let _ = write!(text, "  {sign}");
        }
        text.truncate(text.trim_end().len());
        text += "\n";
    }
    let _ = write!(text, "   {:width$}", "");
    (1..FEATURES.len()).for_each(|column| {
        let _ = write!(text, " {column:>2}");
    });
    let _ = write!(text, "\n```\n\n{runs} of {} pairs run.\n\n| | why not |\n|---|---|\n", runs + refused);
    for (name, reason) in names.iter().zip(&reasons) {
        let _ = writeln!(text, "| {name} | {} |", reason.replace('|', "\\|"));
    }
    text
}

#[test]
fn the_page_of_combinations_says_which_features_go_together() {
    let page = page();
    if std::env::var("ASPERITY_COMBINATIONS").is_ok_and(|word| word == "write") {
        std::fs::write(PAGE, &page).unwrap();
    }
    let known = std::fs::read_to_string(PAGE).unwrap_or_default();
    assert_eq!(known, page, "ASPERITY_COMBINATIONS=write writes docs/combinations.md");
}
