//! What `asperity stress` prints.

use asperity_io::finding;
use asperity_io::stress::{Below, Instant, first_yield};
use serde_json::{Map, Value, json};

use crate::format::{columns, counted, quantity};

/// The JSON object.
pub fn object(below: &Below, written: &[String]) -> Value {
    let set = &below.set;
    let over = |number: &dyn Fn(&Instant) -> Value| below.instants.iter().map(number).collect::<Value>();
    let mut object = Map::new();
    object.insert("body".into(), json!(set.body));
    object.insert("poisson".into(), json!(set.poisson));
    object.insert("depths".into(), json!(set.depths));
    object.insert(below.axis.plural().into(), over(&|instant| json!(instant.time)));
    object.insert("loads".into(), over(&|instant| json!(instant.load)));
    for series in set.scalars() {
        object.insert(series.name.into(), over(&|instant| json!(below.number(instant, series.name))));
    }
    for series in set.profiles() {
        object.insert(series.name.into(), over(&|instant| json!(below.profile(instant, series.name))));
    }
    object.insert("threshold".into(), json!(set.threshold));
    object.insert("yield_stress".into(), json!(set.yield_stress));
    object.insert("first_yield".into(), first_yield(below).map_or(Value::Null, |first| first.to_json(set)));
    object.insert("findings".into(), finding::list(&below.findings()));
    object.insert("written".into(), json!(written));
    Value::Object(object)
}

/// A number with its unit; a dash where there is none.
fn number(value: f64, unit: &str) -> String {
    if value.is_finite() { quantity(value, unit) } else { "-".into() }
}

/// Share of the largest von Mises stress that is rounding.
const NOISE: f64 = 1e-12;
/// Most lines of a table over time.
const MOST_LINES: usize = 24;

/// The largest values over time and the profile at the time `shown`; where that is `drawn`, its largest values alone.
pub fn text(below: &Below, shown: Option<&Instant>, drawn: bool) -> String {
    let set = &below.set;
    let ends =
        [set.depths.first(), set.depths.last()].map(|depth| number(depth.copied().unwrap_or(f64::NAN), "m"));
    let mut text = format!(
        "Stress below the surface of {} (Poisson's ratio {}), {} from {} to {}\n\n",
        set.body,
        set.poisson,
        counted(set.depths.len(), "depth"),
        ends[0],
        ends[1]
    );
    let instants: Vec<&Instant> = match shown.filter(|_| drawn) {
        Some(shown) => vec![shown],
        None => {
            let every = below.instants.len().div_ceil(MOST_LINES).max(1);
            let kept = |(n, instant): &(usize, &Instant)| {
                n % every == 0
                    || n + 1 == below.instants.len()
                    || shown.is_some_and(|s| s.index == instant.index)
            };
            below.instants.iter().enumerate().filter(kept).map(|(_, instant)| instant).collect()
        }
    };
    let maxima =
        [("von Mises", "max_mises"), ("shear (s1 - s3)/2", "max_tresca"), ("principal", "max_tension")];
    let axis = below.axis;
    let mut head = vec![axis.name().to_owned(), "load".to_owned()];
    head.extend(maxima.iter().flat_map(|(name, _)| [format!("largest {name}"), "depth".to_owned()]));
    // What is rounding beside the largest stress is 0.
    let noise =
        NOISE * below.instants.iter().map(|instant| below.number(instant, "max_mises")).fold(0.0, f64::max);
    let number = |value: f64, unit: &str| match unit {
        "Pa" if value.abs() < noise => number(0.0, unit),
        _ => number(value, unit),
    };
    let when = |instant: &Instant| format!("{} = {}", axis.symbol(), number(instant.time, axis.unit()));
    let extra = set.extra_scalars();
    let force = if set.line { "N/m" } else { "N" };
    head.extend(extra.iter().map(|series| series.name.replace('_', " ")));
    let line = |instant: &&Instant| {
        let mut words = vec![number(instant.time, axis.unit()), number(instant.load, force)];
        for (_, key) in maxima {
            words.push(number(below.number(instant, key), "Pa"));
            words.push(number(below.number(instant, &format!("{key}_depth")), "m"));
        }
        words.extend(extra.iter().map(|series| number(below.number(instant, series.name), series.units)));
        words
    };
    text += &columns(&std::iter::once(head).chain(instants.iter().map(line)).collect::<Vec<_>>(), "  ");
    if instants.len() < below.instants.len() {
        let words =
            format!("{} of {} {}; --json prints all", instants.len(), below.instants.len(), axis.plural());
        text += &format!("  ({words})\n");
    }
    text.push('\n');
    if let Some(instant) = shown {
        let place =
            |key: &str| ["x", "y"].map(|axis| number(below.number(instant, &format!("{key}_{axis}")), "m"));
        for (name, key) in maxima {
            let [x, y] = place(key);
            let y = if set.line { String::new() } else { format!(", y = {y}") };
            text += &format!("  largest {name} at {}: x = {x}{y}\n", when(instant));
        }
        text.push('\n');
    }
    if let Some(threshold) = set.threshold {
        text += &format!(
            "stressed {}: where the von Mises stress exceeds {}\n\n",
            if set.line { "area" } else { "volume" },
            quantity(threshold, "Pa")
        );
    }
    if let Some(instant) = shown.filter(|_| !drawn) {
        text += &format!("largest stress by depth at {}\n", when(instant));
        let profiles = set.profiles();
        let head = profiles.iter().map(|series| {
            series.name.trim_end_matches("_by_depth").replace('_', " ").replace("tresca", "shear (s1 - s3)/2")
        });
        let mut lines = vec![std::iter::once("depth".to_owned()).chain(head).collect::<Vec<_>>()];
        for (n, depth) in set.depths.iter().enumerate() {
            let numbers = profiles.iter().map(|series| number(below.profile(instant, series.name)[n], "Pa"));
            lines.push(std::iter::once(number(*depth, "m")).chain(numbers).collect());
        }
        text += &columns(&lines, "  ");
        text.push('\n');
    }
    if let (Some(limit), Some(first)) = (set.yield_stress, first_yield(below)) {
        text += &format!("yield stress {}: {}\n", quantity(limit, "Pa"), first.sentence(below));
        text += "(the hardness, which limits the pressure, is another number: about 2.8 times the yield stress of a metal)\n";
    }
    text
}
