//! The answers about a seal in words.

use asperity::drive::Coordinate;
use asperity::seal::{Opens, SealState};
use asperity_io::answer::Units;
use asperity_io::leakage::words::tight;
use asperity_io::seal::{SealAnswer, Spread, yearly};

use crate::format::quantity;

/// cm^3/min at 0 degC and one atmosphere.
const SCCM: &str = "cm³/min at 0 °C and 1 atm (sccm)";

/// A ratio that is known to this factor is stated without its bounds.
const KNOWN: f64 = 1.2;

/// Name and words of each answer, the leak first.
pub(super) fn lines(answer: &SealAnswer, units: &Units) -> Vec<[String; 2]> {
    let words = Words { answer, units };
    let leak = answer.validity("seal_leak");
    // What only repeats a leak that is taken back, or follows from it, is left out.
    let follows = |words: Option<String>| words.filter(|_| leak.is_valid());
    let rows = [
        ("leak of the seal", Some(leak.mark(words.leak()))),
        ("by the sweep", follows(words.by_the_sweep())),
        ("per metre", follows(words.per_metre())),
        ("as a volume", follows(words.volume())),
        ("in a year", follows(words.in_a_year())),
        ("opening pressure", Some(answer.validity("seal_opening_pressure").mark(words.opening()))),
        ("at", Some(words.at())),
        ("narrowest", follows(words.narrowest())),
        ("Knudsen number", follows(words.knudsen())),
        ("opened by the fluid", follows(words.opened())),
        ("in proportion to", follows(words.proportion())),
        ("a tenth more pressure", follows(words.growth())),
        ("seeds", words.seeds()),
        ("tightness over time", follows(words.over_time())),
    ];
    rows.into_iter().filter_map(|(name, words)| Some([name.to_owned(), words?])).collect()
}

struct Words<'a> {
    answer: &'a SealAnswer,
    units: &'a Units,
}

impl Words<'_> {
    fn leak(&self) -> String {
        match self.answer.flows.iter().find(|flow| flow.state != SealState::Tight).map(|flow| flow.state) {
            None => "none: tight".to_owned(),
            Some(SealState::Lifted) => "not bounded: the fluid lifts the seal".to_owned(),
            _ if self.leaks() => self.rate(&self.answer.leak),
            _ => "not known: see the findings".to_owned(),
        }
    }

    fn leaks(&self) -> bool {
        self.answer.leak.largest.is_finite() && self.answer.leak.largest > 0.0
    }

    /// A leak in the unit that is chosen for leaks.
    fn rate(&self, leak: &Spread) -> String {
        let standard = self.answer.plan.standard();
        with_spread(leak, |leak| self.units.rate(leak, standard.map(|standard| standard * leak)))
    }

    /// "1.8e-15 m³/s to 1.9e-15 m³/s: what its pressures leave open".
    fn by_the_sweep(&self) -> Option<String> {
        let standard = self.answer.plan.standard();
        let [low, high] =
            self.answer.bounds.map(|leak| self.units.rate(leak, standard.map(|one| one * leak)));
        self.leaks().then(|| format!("{low} to {high}: what its pressures leave open"))
    }

    fn per_metre(&self) -> Option<String> {
        self.leaks().then(|| self.rate(&self.answer.leak.times(1.0 / self.answer.plan.length)))
    }

    fn volume(&self) -> Option<String> {
        let sccm = self.answer.plan.sccm().filter(|_| self.leaks())?;
        Some(format!("{} {SCCM}", with_spread(&self.answer.leak.times(sccm), number)))
    }

    fn in_a_year(&self) -> Option<String> {
        let (factor, unit) = yearly(&self.answer.plan);
        self.leaks().then(|| format!("{} {unit}", with_spread(&self.answer.leak.times(factor), number)))
    }

    /// "2 bar (1.8 bar to 2.2 bar); all seeds leak from 2.5 bar on".
    fn opening(&self) -> String {
        let opens = &self.answer.opens;
        let every = |is: Opens| opens.iter().all(|opens| *opens == is);
        let all_leak = opens.iter().map(|opens| match opens {
            Opens::Between(_, leaks) => *leaks,
            Opens::Always => f64::NEG_INFINITY,
            Opens::Never | Opens::Unknown => f64::INFINITY,
        });
        let all_leak = all_leak.fold(f64::NEG_INFINITY, f64::max);
        match self.answer.opening {
            _ if every(Opens::Always) => "none: the seal leaks at every pressure".into(),
            _ if every(Opens::Never) => "none: the seal is tight at every pressure".into(),
            None => "not known of every seed: see the findings".into(),
            Some(opening) if all_leak.is_finite() => {
                let leaks = format!("{} from {} on", self.they("leak"), pa(all_leak));
                match opening.largest > self.answer.plan.ends[1] {
                    true => format!("{}; {leaks}", with_spread(&opening, pa)),
                    false => format!("not known: {leaks}, below that the sweep does not tell"),
                }
            }
            Some(opening) => with_spread(&opening, pa),
        }
    }

    /// "it leaks", or "all seeds leak".
    fn they(&self, verb: &str) -> String {
        if self.answer.flows.len() > 1 { format!("all seeds {verb}") } else { format!("it {verb}s") }
    }

    fn at(&self) -> String {
        let plan = &self.answer.plan;
        let [inlet, outlet] = plan.ends;
        let time = self
            .answer
            .sweep
            .times
            .last()
            .map_or(String::new(), |time| format!("t = {}, ", self.units.time(*time)));
        match plan.around() {
            Some(around) => {
                format!("{time}{}; pressures of the seal count from {}", plan.leak.fluid_words(), pa(around))
            }
            None => format!(
                "{time}inlet {}, outlet {}, above the pressure around the seal",
                pa(inlet),
                pa(outlet)
            ),
        }
    }

    fn narrowest(&self) -> Option<String> {
        let choke = self.answer.flows.iter().find_map(|flow| flow.choke).filter(|_| self.leaks())?;
        let [x, width] = [choke.x, self.answer.plan.profile.width()].map(|length| quantity(length, "m"));
        let of = if self.answer.flows.len() > 1 { ", with the first seed that leaks" } else { "" };
        Some(format!("at {x} of {width} from the inlet, pressed with {}{of}", pa(choke.pressed)))
    }

    fn knudsen(&self) -> Option<String> {
        let knudsen = Some(self.answer.knudsen).filter(|knudsen| knudsen.is_finite())?;
        Some(format!("{} at the narrowest place: mean free path over critical gap", number(knudsen)))
    }

    fn opened(&self) -> Option<String> {
        let held = self.answer.one_way.mean;
        let leak = self.answer.leak.mean;
        let [least, most] = self.answer.one_way_bounds.map(|held| leak / held);
        (self.leaks() && !held.is_nan()).then(|| match held > 0.0 {
            true if least <= KNOWN * most => {
                format!("{} times the leak of the contact that it does not open", number(leak / held))
            }
            true => format!(
                "about {} times the leak of the contact that it does not open (the sweep leaves {} to {} open)",
                number(leak / held),
                number(most),
                number(least)
            ),
            false => "the contact that it does not open is tight".to_owned(),
        })
    }

    fn proportion(&self) -> Option<String> {
        let what = match self.answer.plan.is_gas() {
            true => "length, and 1/width at the same contact pressures",
            false => "length, 1/viscosity, and 1/width at the same contact pressures",
        };
        self.leaks().then(|| what.to_owned())
    }

    fn growth(&self) -> Option<String> {
        let known = self.leaks() && self.answer.growth.is_finite();
        known.then(|| format!("{} times the leak", number(self.answer.growth)))
    }

    fn seeds(&self) -> Option<String> {
        let seeds = self.answer.sweep.seeds.len();
        (seeds > 1).then(|| format!("{seeds}; in brackets the least and the largest of them"))
    }

    /// "closes between t = 1 s and 10 s"; none where the leak is not known at every time.
    fn over_time(&self) -> Option<String> {
        let list = &self.answer.by_time;
        let times: Vec<Coordinate> = list.iter().map(|over| Coordinate::Time(over.at)).collect();
        let open: Vec<f64> = list.iter().map(|over| f64::from(u8::from(over.leak.largest > 0.0))).collect();
        let ends = [times.first()?, times.last()?].map(|time| self.units.coordinate(*time));
        Some(match tight(&times, &open, self.units) {
            _ if list.iter().any(|over| !over.leak.mean.is_finite()) => return None,
            words if !words.is_empty() => words,
            _ if times.len() == 1 => format!("leaks at t = {}, the only stored time", ends[0]),
            _ => format!("leaks from t = {} to {}; at first {}", ends[0], ends[1], self.rate(&list[0].leak)),
        })
    }
}

/// "3 (1 to 5) ml/year".
fn with_spread(spread: &Spread, words: impl Fn(f64) -> String) -> String {
    let [mean, least, largest] = [spread.mean, spread.least, spread.largest].map(words);
    let split =
        |words: &'_ str| words.split_once(' ').map(|(number, unit)| [number.to_owned(), unit.to_owned()]);
    match [&mean, &least, &largest].map(|words| split(words)) {
        _ if spread.least == spread.largest => mean,
        [Some([mean, unit]), Some([least, same]), Some([largest, again])]
            if unit == same && unit == again =>
        {
            format!("{mean} ({least} to {largest}) {unit}")
        }
        _ => format!("{mean} ({least} to {largest})"),
    }
}

fn pa(pressure: f64) -> String {
    quantity(pressure, "Pa")
}

fn number(number: f64) -> String {
    quantity(number, "")
}
