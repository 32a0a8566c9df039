//! Which answers a finding takes back.
//!
//! An answer is taken back where the number may be wrong by more than it says: "not valid", with the reason in place of the number. Where it
//! may be off by less, it names the finding. Both follow from one table; a finding counts for the answers of the rows that it concerns.

use asperity::Coordinate;
use asperity::finding::*;
use asperity::step::Row;
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::Answer;

/// What the findings say of an answer; as JSON nothing, `see` or `valid`, `why`.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Validity {
    /// Nothing.
    #[default]
    Holds,
    /// That it may be off: the codes of the findings.
    See(Vec<String>),
    /// That it does not hold.
    TakenBack {
        /// Code of the finding.
        code: String,
        /// Why, in a few words.
        why: &'static str,
    },
}

impl Validity {
    /// Whether it is not taken back.
    pub fn is_valid(&self) -> bool {
        !matches!(self, Validity::TakenBack { .. })
    }

    /// The number in words, with what must be known of it; in place of one that does not hold the reason.
    pub fn mark(&self, words: String) -> String {
        match self {
            Validity::Holds => words,
            Validity::See(codes) => format!("{words} [see {}]", codes.join(", ")),
            Validity::TakenBack { code, why } => format!("not valid: {why} [{code}]"),
        }
    }

    /// The same in a cell of a table.
    pub fn cell(&self, words: String) -> String {
        match self {
            Validity::TakenBack { code, .. } => format!("not valid [{code}]"),
            _ => self.mark(words),
        }
    }

    /// The same on a card: the number, and below it what must be known.
    pub fn card(&self, words: String) -> [String; 2] {
        match self {
            Validity::Holds => [words, String::new()],
            Validity::See(codes) => [words, format!(" [see {}]", codes.join(", "))],
            Validity::TakenBack { code, why } => ["not valid".to_owned(), format!(": {why} [{code}]")],
        }
    }

    /// The same of findings about a part of what the answer is of: they are named, and take nothing back.
    #[must_use]
    pub fn of_a_part(self) -> Validity {
        match self {
            Validity::TakenBack { code, .. } => Validity::See(vec![code]),
            other => other,
        }
    }

    /// What both say: taken back where one takes it back, else the findings of both.
    #[must_use]
    pub fn and(self, other: Validity) -> Validity {
        match (self, other) {
            (taken @ Validity::TakenBack { .. }, _) | (_, taken @ Validity::TakenBack { .. }) => taken,
            (Validity::Holds, other) | (other, Validity::Holds) => other,
            (Validity::See(mut codes), Validity::See(more)) => {
                codes.extend(more.into_iter().filter(|code| !codes.contains(code)).collect::<Vec<_>>());
                Validity::See(codes)
            }
        }
    }

    /// What these findings say of the answer `name` at a row.
    pub fn at_row<'f>(
        name: &str,
        row: usize,
        findings: impl Iterator<Item = &'f Finding> + Clone,
    ) -> Validity {
        let concerns = |finding: &&Finding| finding.rows.is_none_or(|[from, to]| from <= row && row <= to);
        Validity::of(name, findings.filter(concerns))
    }

    /// What these findings say of the answer `name`.
    pub fn of<'f>(name: &str, findings: impl Iterator<Item = &'f Finding> + Clone) -> Validity {
        let is_of = |rule: &Rule, finding: &Finding| {
            rule.code == finding.code && rule.answers.iter().any(|pattern| covers(pattern, name))
        };
        let rule = |finding: &Finding| {
            RULES
                .iter()
                .find(|rule| is_of(rule, finding) && excess(finding) >= rule.from)
                .map(|rule| rule.why)
        };
        let taken = findings.clone().find_map(|finding| Some((finding, rule(finding)??)));
        if let Some((finding, why)) = taken {
            return Validity::TakenBack { code: finding.code.to_string(), why };
        }
        let mut codes: Vec<String> = vec![];
        for finding in findings.filter(|finding| rule(finding).is_some()) {
            if !codes.contains(&finding.code.to_string()) {
                codes.push(finding.code.to_string());
            }
        }
        if codes.is_empty() { Validity::Holds } else { Validity::See(codes) }
    }
}

impl Serialize for Validity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        match self {
            Validity::Holds => {}
            Validity::See(codes) => map.serialize_entry("see", codes)?,
            Validity::TakenBack { code, why } => {
                map.serialize_entry("valid", &false)?;
                map.serialize_entry("why", &format!("{code}: {why}"))?;
            }
        }
        map.end()
    }
}

/// Marks the answers of a result. `leak_row` is the row of the last leak.
pub(super) fn mark(answers: &mut [Answer], findings: &[Finding], rows: &[Row], leak_row: Option<usize>) {
    for answer in answers {
        let own = match answer.at {
            Some(at) => span(rows, at),
            None if LAST_LEAK.iter().any(|pattern| covers(pattern, &answer.name)) => {
                leak_row.map(|row| [row; 2])
            }
            None => None,
        };
        let concerns = |finding: &&Finding| match (finding.rows, own) {
            (Some([first, last]), Some([from, to])) => first <= to && from <= last,
            _ => true,
        };
        answer.validity = Validity::of(&answer.name, findings.iter().filter(concerns));
    }
}

/// The rows at a coordinate: two at a jump.
fn span(rows: &[Row], at: Coordinate) -> Option<[usize; 2]> {
    let is_there = |row: &Row| row.coordinate == at;
    Some([rows.iter().position(is_there)?, rows.iter().rposition(is_there)?])
}

/// How many times a number is beyond its limit, on whichever side; 1 without numbers.
fn excess(finding: &Finding) -> f64 {
    match (finding.value, finding.limit) {
        (Some(value), Some(limit)) => (value / limit).abs().max((limit / value).abs()),
        _ => 1.0,
    }
}

/// Whether a pattern, a name or the beginning of one before "*", is that of a name.
fn covers(pattern: &str, name: &str) -> bool {
    pattern.strip_suffix('*').map_or(pattern == name, |start| name.starts_with(start))
}

/// That a finding takes answers back, or that they name it.
struct Rule {
    code: &'static str,
    answers: &'static [&'static str],
    /// From so many times its limit on.
    from: f64,
    /// Why they are taken back; `None` where they name it.
    why: Option<&'static str>,
}

const fn takes(code: &'static str, answers: &'static [&'static str], from: f64, why: &'static str) -> Rule {
    Rule { code, answers, from, why: Some(why) }
}

const fn see(code: &'static str, answers: &'static [&'static str]) -> Rule {
    Rule { code, answers, from: 0.0, why: None }
}

const ALL: &[&str] = &["*"];
const CONTACT: &[&str] = &[
    "contact_area*",
    "contact_fraction",
    "max_pressure",
    "approach",
    "creep",
    "load",
    "relaxation",
    "dynamic_stiffness",
];
const AREA: &[&str] = &["contact_area*", "contact_fraction", "max_pressure", "max_mises*"];
const DEPTH: &[&str] = &["approach", "creep", "load", "relaxation", "dynamic_stiffness"];
const LEAK: &[&str] = &["leak_rate*", "hydraulic_gap", "tight_from"];
const LAST_LEAK: &[&str] = &["leak_rate*", "hydraulic_gap"];
const SEAL: &[&str] = &["seal_leak*", "leak_growth", "seal_opening_pressure"];
const SEAL_CURVE: &[&str] = &["leak_over_inlet"];
const SEAL_LEAK: &[&str] = &["seal_leak*", "leak_growth"];
const FLUID: &[&str] = &["leak_rate*", "fluid_load", "time_opened", "closing_pressure"];
const FRICTION: &[&str] = &["friction_*", "velocity_of_largest_friction"];
const CYCLE: &[&str] = &["loss_angle", "dissipated_energy", "dynamic_stiffness", "loop_energy"];
const STRESS: &[&str] = &["max_mises*", "first_yield_load"];
const SLIP: &[&str] = &["loop_energy", "slip_*", "tangential_stiffness", "largest_tangential_*"];
const ADHESION: &[&str] = &["pull_off_*"];
const WEAR: &[&str] = &["wear_depth_max", "wear_life"];
const FLASH: &[&str] = &["flash_*"];

const BEYOND_THEORY: &str = "deformations are far beyond linear theory";

/// The first rule of a finding and an answer decides.
const RULES: &[Rule] = &[
    takes(FLUID_UNCOUPLED, LEAK, 50.0, "the fluid lifts the seal"),
    takes(FLUID_UNCOUPLED, LEAK, 10.0, "the fluid opens the contact, which is left out"),
    see(FLUID_UNCOUPLED, LEAK),
    takes(LEAK_BELOW_GAP_ERROR, LEAK, 30.0, "the gap is less than its error"),
    see(LEAK_BELOW_GAP_ERROR, LEAK),
    takes(WINDOW_IN_LEAK, LEAK, 0.0, "the window of the surface dams the flow"),
    see(CONSTRICTION_UNRESOLVED, LEAK),
    see(LEAK_IN_MOTION, LEAK),
    see(SQUEEZE_SLOW, FLUID),
    see(FLUID_CHATTER, FLUID),
    see(FLUID_APPROACH_HELD, FLUID),
    see(POCKET_TENSION, FLUID),
    takes(SEAL_LIFTED, SEAL_LEAK, 0.0, "the fluid lifts the seal"),
    takes(SEAL_BEYOND_SWEEP, SEAL, 0.0, "the sweep ends below the pressure in the seal"),
    takes(SEAL_BELOW_SWEEP, SEAL_LEAK, 50.0, "the sweep begins above the pressure in the seal"),
    see(SEAL_BELOW_SWEEP, SEAL),
    takes(SEAL_SWEEP_COARSE, SEAL_LEAK, 5.0, "the pressures of the sweep leave it open"),
    see(SEAL_SWEEP_COARSE, SEAL_LEAK),
    see(SEAL_CURVE_COARSE, SEAL_CURVE),
    takes(SEAL_NARROW, SEAL, 4.0, "the seal is narrower than its patch"),
    see(SEAL_NARROW, SEAL),
    see(SEAL_PATCH_SMALL, SEAL),
    see(CONTACT_AT_BORDER, CONTACT),
    see(GAP_NOT_PERIODIC, AREA),
    see(GAP_NOT_PERIODIC, LEAK),
    see(LAY_MIRRORED, LEAK),
    see(LAY_MIRRORED, FRICTION),
    see(ROUGH_ON_FREE_DOMAIN, CONTACT),
    see(SHORTEST_WAVE_UNRESOLVED, AREA),
    see(SHORTEST_WAVE_UNRESOLVED, LEAK),
    see(SHORTEST_WAVE_UNRESOLVED, FRICTION),
    see(SPOTS_UNRESOLVED, AREA),
    see(FEW_CONTACT_CELLS, AREA),
    takes(LARGE_STRAIN, ALL, 10.0, BEYOND_THEORY),
    see(LARGE_STRAIN, CONTACT),
    takes(LARGE_SLOPE, ALL, 5.0, BEYOND_THEORY),
    see(LARGE_SLOPE, CONTACT),
    takes(THIN_BODY, DEPTH, 10.0, "the body is thinner than the contact is wide"),
    see(THIN_BODY, CONTACT),
    takes(ENERGY_BALANCE, CYCLE, 5.0, "the energies miss each other by more than a tenth of the work"),
    see(ENERGY_BALANCE, CYCLE),
    see(STEPS_TOO_LONG, CONTACT),
    see(STEPS_TOO_LONG, CYCLE),
    takes(ALIASED_HISTORY, CYCLE, 4.0, "a period has five steps or fewer"),
    see(ALIASED_HISTORY, CYCLE),
    takes(FRICTION_UNCERTAIN, FRICTION, 10.0, "its uncertainty is as large as itself"),
    see(FRICTION_UNCERTAIN, FRICTION),
    takes(OWN_TRACK, FRICTION, 10.0, "the body runs over its own track"),
    see(OWN_TRACK, FRICTION),
    see(STRESS_UNRESOLVED, STRESS),
    see(STRESS_AT_DEEPEST, STRESS),
    see(STRESS_DEPTHS_COARSE, STRESS),
    see(STRESS_TIMES_MISS_PEAK, STRESS),
    see(YIELD_EXCEEDED, &["max_mises*", "max_pressure"]),
    see(ADHESION_UNRESOLVED, ADHESION),
    see(ADHESION_AT_BORDER, ADHESION),
    see(SLIP_UNRESOLVED, SLIP),
    see(NORMAL_COUPLING, SLIP),
    see(WEAR_STEPS, WEAR),
    see(WEAR_TRACK, WEAR),
    see(LAYER_WORN, WEAR),
    see(LAYER_WORN, CONTACT),
    see(FLASH_WARM, FLASH),
    see(FLASH_WARM, FRICTION),
    see(FLASH_STATES, FLASH),
    see(FLASH_STATES, FRICTION),
    see(FLASH_STEADY, FLASH),
];

/// Findings that mark no answer: about the input, which concern all numbers alike, and those that say what the numbers are of.
#[cfg(test)]
const SILENT: &[&str] = &[
    NO_CONTACT,
    BEYOND_HISTOGRAM,
    MATERIAL_MISFIT,
    DATA_SCATTER,
    SHIFT_UNCERTAIN,
    AT_REFERENCE_TEMPERATURE,
    MODULUS_KIND,
    BEYOND_MATERIAL_DATA,
    POINTS_LEFT_OUT,
    TOO_FEW_POINTS,
    HURST_OUT_OF_RANGE,
    HURST_UNCERTAIN,
    OUTLIERS,
    PROFILE_GAPS,
    UNLIKE_PROFILE,
    UNLIKELY_UNIT,
    SEAL_NEVER_TIGHT,
    GAPS_BELOW_ERROR,
    EVENT_WITHOUT_VALUE,
    FRICTION_ZERO,
    FLUID_LIFTS,
    FLUID_MAY_RUN_AWAY,
    FLUID_ACTS_ON_DOMAIN,
    FORCE_BEYOND_FRICTION,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_finding_is_decided_once() {
        for code in CODES {
            let ruled = RULES.iter().any(|rule| rule.code == *code);
            assert!(ruled != SILENT.contains(code), "{code}: in RULES or in SILENT");
        }
    }

    /// A drop of 0.02, 0.2 and 1 times the mean pressure.
    #[test]
    fn a_leak_without_the_fluids_pressure_is_doubted_and_taken_back() {
        let of = |share: f64| [Finding::warning(FLUID_UNCOUPLED, share, 0.02, "")];
        let words = |share: f64| Validity::of("tight_from", of(share).iter()).mark("1 s".into());
        assert_eq!(words(0.03), "1 s [see fluid-uncoupled]");
        assert_eq!(words(0.2), "not valid: the fluid opens the contact, which is left out [fluid-uncoupled]");
        assert_eq!(words(4.0), "not valid: the fluid lifts the seal [fluid-uncoupled]");
        assert_eq!(Validity::of("contact_area", of(4.0).iter()), Validity::Holds);
        let json = |validity: Validity| serde_json::to_value(validity).unwrap();
        let taken = json(Validity::of("leak_rate", of(4.0).iter()));
        assert_eq!(
            taken,
            serde_json::json!({ "valid": false, "why": "fluid-uncoupled: the fluid lifts the seal" })
        );
        assert_eq!(json(Validity::Holds), serde_json::json!({}));
        assert_eq!(
            json(Validity::of("leak_rate", of(0.03).iter())),
            serde_json::json!({ "see": ["fluid-uncoupled"] })
        );
    }

    #[test]
    fn the_findings_of_a_part_are_named_and_those_of_both_joined() {
        let of = |code: &'static str, excess: f64| {
            Validity::of("leak_rate", [Finding::warning(code, excess, 1.0, "")].iter())
        };
        let [taken, see] = [of(WINDOW_IN_LEAK, 1.0), of(LAY_MIRRORED, 1.0)];
        assert_eq!(taken.clone().of_a_part(), Validity::See(vec!["window-in-leak".into()]));
        assert_eq!(see.clone().and(taken.clone()), taken);
        assert_eq!(
            see.clone().and(of(CONSTRICTION_UNRESOLVED, 1.0)).and(see.clone()),
            Validity::See(vec!["lay-mirrored".into(), "constriction-unresolved".into()])
        );
        let rows = [Finding::warning(WINDOW_IN_LEAK, 1.0, 1.0, "").at(Some([1, 2]))];
        let at = |row: usize| Validity::at_row("leak_rate", row, rows.iter()).is_valid();
        assert_eq!([0, 1, 2, 3].map(at), [true, false, false, true]);
    }

    #[test]
    fn a_finding_counts_for_the_rows_that_it_concerns() {
        let at = Coordinate::Time(2.0);
        let row = |time: f64| Row { coordinate: Coordinate::Time(time), ..Row::default() };
        let rows = [0.0, 1.0, 2.0].map(row);
        let of = |span: Option<[usize; 2]>| {
            let mut answers = [Answer { at: Some(at), ..Answer::new("contact_area", 1.0, "m2") }];
            mark(&mut answers, &[Finding::warning(SPOTS_UNRESOLVED, 1.0, 4.0, "").at(span)], &rows, None);
            answers[0].validity != Validity::Holds
        };
        assert!(of(None) && of(Some([1, 2])) && of(Some([2, 5])) && !of(Some([0, 1])));
    }
}
