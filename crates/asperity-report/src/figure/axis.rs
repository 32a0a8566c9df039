//! Axes: from values to places, with ticks at round numbers.

use asperity_io::readable::{Shown, shown, superscript};

use super::{SMALL, font};

/// How values become places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By the logarithm; values that are not positive are left out.
    Log,
}

/// What an axis shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity, `time`.
    pub label: String,
    /// Its SI unit, see [`shown`](shown()); empty for a plain number.
    pub unit: String,
    /// How values become places.
    pub scale: Scale,
    /// Ends of what the axis shows \[SI\]; `None` for those of the data.
    pub range: Option<[f64; 2]>,
    /// Whether the frame is at these ends; else there is room between them and the frame.
    pub exact: bool,
    /// Names of the values 0, 1, 2 ... in place of numbers; empty for numbers.
    pub names: Vec<String>,
    /// The unit that it is shown in; `None` for one that suits its range.
    pub chosen: Option<Shown>,
    /// Whether it counts something: its ticks are whole numbers then.
    pub counts: bool,
}

/// A logarithmic axis of more decades on both sides of 1 keeps the unit without a prefix: its numbers are powers of ten in any
/// case.
const DECADES_WITHOUT_PREFIX: f64 = 6.0;

/// Times below this are shown in seconds or less \[s\].
const SECONDS: f64 = 1e4;

/// Over less decades ticks stand at 2 and 5 times a power of ten too.
const FEW: f64 = 2.0;

/// Smaller numbers are 0 on a linear axis: the steps between their ticks have no digits left.
const NOTHING: f64 = 1e-250;

impl Axis {
    /// A linear axis over the range of the data.
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Axis {
        let (scale, range, exact, names, counts) = (Scale::Linear, None, false, vec![], false);
        Axis { label: label.into(), unit: unit.into(), scale, range, exact, names, counts, chosen: None }
    }

    /// A logarithmic axis over the range of the data.
    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis { scale: Scale::Log, ..Axis::linear(label, unit) }
    }

    /// An axis of states 0, 1, 2 ..., each with its name.
    pub fn states(label: impl Into<String>, names: &[&str]) -> Axis {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let last = names.len() as f64 - 1.0;
        Axis { names, ..Axis::linear(label, "").between(-0.2, last + 0.2) }
    }

    /// The same axis for a number of things, without ticks between whole numbers.
    pub fn counting(self) -> Axis {
        Axis { counts: true, ..self }
    }

    /// The same axis in a unit that was chosen.
    pub fn shown_in(self, chosen: Option<Shown>) -> Axis {
        Axis { chosen, ..self }
    }

    /// The same axis with its frame at these ends \[SI\].
    pub fn between(self, from: f64, to: f64) -> Axis {
        Axis { range: Some([from, to]), exact: true, ..self }
    }

    /// The same axis for values between these \[SI\], whatever the data are, and room beyond them.
    pub fn spanning(self, from: f64, to: f64) -> Axis {
        Axis { range: Some([from, to]), exact: false, ..self }
    }
}

/// An axis laid out: values to points on paper, ticks, title.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
    scale: Scale,
    /// Ends in values, after the scale.
    ends: [f64; 2],
    /// Ends in points on paper.
    places: [f64; 2],
    /// Its unit with the prefix, without a power of ten.
    pub(super) unit: Shown,
    /// SI values and texts of the labelled ticks.
    pub(super) ticks: Vec<(f64, String)>,
    /// SI values of the ticks between.
    pub(super) minor: Vec<f64>,
    /// Label with unit.
    pub(super) title: String,
}

impl Ruler {
    /// Lays an axis over `data`, the least and the largest value that it must show, with room for
    /// about `wanted` ticks. `margin` is the share of the range that stays free at each end. Its numbers have the prefix and the
    /// power of ten that suit them.
    pub(super) fn new(axis: &Axis, data: [f64; 2], margin: f64, wanted: f64) -> Ruler {
        let ends = ends(axis, data, margin);
        let unit = prefixed(axis, ends);
        let numbers = match axis.scale {
            // Their ticks are 1, 2 and 5 times a power of ten, which is wide beside each.
            Scale::Log if axis.names.is_empty() && ends[1] - ends[0] < FEW => {
                with_power(&unit, 10f64.powf(ends[1]))
            }
            Scale::Linear if axis.names.is_empty() => with_power(&unit, ends[0].abs().max(ends[1].abs())),
            _ => unit.clone(),
        };
        Ruler::laid(axis, ends, wanted, unit, numbers)
    }

    /// The same in this unit, without a power of ten of its own.
    pub(super) fn exactly(axis: &Axis, data: [f64; 2], margin: f64, wanted: f64, unit: Shown) -> Ruler {
        Ruler::laid(axis, ends(axis, data, margin), wanted, unit.clone(), unit)
    }

    /// `unit` is that of the axis, and `numbers` the same with a power of ten where the numbers need it.
    fn laid(axis: &Axis, ends: [f64; 2], wanted: f64, unit: Shown, numbers: Shown) -> Ruler {
        let (mut ticks, mut minor) = match axis.scale {
            _ if !axis.names.is_empty() => {
                ((0u32..).map(f64::from).zip(axis.names.clone()).collect(), vec![])
            }
            Scale::Log => decades(ends, numbers.factor, wanted),
            Scale::Linear => steps(ends, numbers.factor, wanted),
        };
        if axis.counts && numbers.text.is_empty() {
            ticks.retain(|(value, _)| is_whole(*value));
            ticks.iter_mut().for_each(|(value, text)| *text = format!("{:.0}", value.abs()));
            minor.retain(|value| is_whole(*value));
        }
        let title = match numbers.text.as_str() {
            "" => axis.label.clone(),
            text => format!("{} [{text}]", axis.label),
        };
        Ruler { scale: axis.scale, ends, places: [0.0, 1.0], unit, ticks, minor, title }
    }

    /// Width of the widest number \[points\].
    pub(super) fn widest(&self) -> f64 {
        self.ticks.iter().map(|(_, text)| font::width(text, SMALL)).fold(0.0, f64::max)
    }

    /// The same ruler between two points on paper.
    pub(super) fn placed(self, from: f64, to: f64) -> Ruler {
        Ruler { places: [from, to], ..self }
    }

    /// Ends of the axis \[SI\].
    pub(super) fn reach(&self) -> [f64; 2] {
        if self.scale == Scale::Log { self.ends.map(|end| 10f64.powf(end)) } else { self.ends }
    }

    /// Where a value lies on paper; `None` for one that the scale cannot show.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let value = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => value.log10(),
            Scale::Log => return None,
        };
        let share = (value - self.ends[0]) / (self.ends[1] - self.ends[0]);
        // Far outside is as good as a little outside, and keeps the numbers of the drawing small.
        let share = share.clamp(-10.0, 11.0);
        share.is_finite().then(|| self.places[0] + share * (self.places[1] - self.places[0]))
    }
}

/// Ends of an axis, after its scale.
fn ends(axis: &Axis, data: [f64; 2], margin: f64) -> [f64; 2] {
    let log = axis.scale == Scale::Log;
    let forward = |v: f64| if log { v.log10() } else { v };
    let [low, high] = axis.range.unwrap_or(data).map(forward);
    let largest = high.abs().max(low.abs());
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    if !log && largest < NOTHING {
        return [-margin, 1.0];
    }
    if high - low <= 1e-9 * largest {
        let room = match (log, axis.counts) {
            (true, _) => 0.5,
            (false, true) => f64::max(1.0, 0.1 * largest),
            (false, false) => 0.1 * largest,
        };
        return [low - room, high + room];
    }
    let room = if axis.exact { 0.0 } else { margin * (high - low) };
    [low - room, high + room]
}

/// Whether a tick is a whole number but for rounding.
fn is_whole(value: f64) -> bool {
    (value - value.round()).abs() < 1e-9 * value.abs().max(1.0)
}

/// The unit of an axis with the prefix that suits its ends.
fn prefixed(axis: &Axis, [low, high]: [f64; 2]) -> Shown {
    let log = axis.scale == Scale::Log;
    let plain = log && high - low > DECADES_WITHOUT_PREFIX && low < 0.0 && high > 0.0;
    let largest = if log { 10f64.powf(high) } else { low.abs().max(high.abs()) };
    match &axis.chosen {
        Some(chosen) => chosen.clone(),
        // Decades of time are those of the second.
        None if log && axis.unit == "s" => shown("s", if plain { 1.0 } else { largest.min(SECONDS) }),
        None => shown(&axis.unit, if plain { 1.0 } else { largest }),
    }
}

/// A unit with a power of ten before it where numbers up to `largest` \[SI\] would have more than five digits.
pub(super) fn with_power(unit: &Shown, largest: f64) -> Shown {
    /// Numbers in the unit that need no power of ten.
    const SHORT: std::ops::Range<f64> = 1e-3..1e5;
    let number = largest * unit.factor;
    if !number.is_finite() || number <= 0.0 || SHORT.contains(&number) {
        return unit.clone();
    }
    let power = 3 * ((number.log10() + 1e-9) / 3.0).floor() as i32;
    let text = format!("10{} {}", superscript(power), unit.text);
    Shown { factor: unit.factor * 10f64.powi(-power), text: text.trim_end().to_owned() }
}

type Ticks = (Vec<(f64, String)>, Vec<f64>);

/// Least ticks with a number on an axis: one alone gives no scale.
const FEWEST: usize = 2;

/// Ticks at 1, 2 or 5 times a power of ten, two at least.
fn steps(ends: [f64; 2], factor: f64, wanted: f64) -> Ticks {
    let ends = ends.map(|v| v * factor);
    let rough = (ends[1] - ends[0]) / wanted.max(1.0);
    let (mut power, mut digit) = (rough.log10().floor() as i32, 10);
    while digit > 1 && rough <= f64::from(finer(digit)) * 10f64.powi(power) {
        digit = finer(digit);
    }
    loop {
        let found = multiples(ends, factor, digit, power);
        // Of the multiples of a tenth of the length there are nine at least inside.
        if found.0.len() >= FEWEST || 10f64.powi(power) < 0.01 * (ends[1] - ends[0]) {
            return found;
        }
        (power, digit) = if digit == 1 { (power - 1, 5) } else { (power, finer(digit)) };
    }
}

/// The next finer step of 10, 5, 2 and 1.
fn finer(digit: u32) -> u32 {
    match digit {
        10 => 5,
        5 => 2,
        _ => 1,
    }
}

/// Ticks at the multiples of `digit` times a power of ten.
fn multiples(ends: [f64; 2], factor: f64, digit: u32, power: i32) -> Ticks {
    let step = f64::from(digit) * 10f64.powi(power);
    let parts = if digit == 2 { 4 } else { 5 };
    let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    let inside = |v: f64| v >= ends[0] - 1e-9 * step && v <= ends[1] + 1e-9 * step;
    let first = (ends[0] / step).floor() as i64;
    let last = (ends[1] / step).ceil() as i64;
    let mut ticks = Vec::new();
    let mut minor = Vec::new();
    for n in first..=last.min(first.saturating_add(1000)) {
        let value = n as f64 * step;
        if inside(value) {
            ticks.push((value / factor, number(value, decimals)));
        }
        minor.extend(
            (1..parts)
                .map(|k| value + f64::from(k) * step / f64::from(parts))
                .filter(|v| inside(*v))
                .map(|v| v / factor),
        );
    }
    (ticks, minor)
}

/// Ticks at powers of ten, two at least; over less than two decades also at 2 and 5 times them.
fn decades(ends: [f64; 2], factor: f64, wanted: f64) -> Ticks {
    // Not whole where the unit is a minute or an hour.
    let shift = factor.log10();
    let ends = [ends[0] + shift, ends[1] + shift];
    let span = ends[1] - ends[0];
    let coarsest = (span / wanted.max(1.0)).ceil().max(1.0) as i64;
    let all = |every: i64| powers(ends, factor, every);
    let (ticks, minor) =
        (1..=coarsest).rev().map(all).find(|(ticks, _)| ticks.len() >= FEWEST).unwrap_or_else(|| all(1));
    if ticks.len() < FEWEST && span < 1.0 {
        let linear = ends.map(|v| 10f64.powf(v));
        let (ticks, minor) = steps(linear, 1.0, wanted);
        let back = |v: f64| v / factor;
        return (
            ticks.into_iter().map(|(v, text)| (back(v), text)).filter(|(v, _)| *v > 0.0).collect(),
            minor.into_iter().map(back).filter(|v| *v > 0.0).collect(),
        );
    }
    (ticks, minor)
}

/// Ticks at every so many powers of ten; over less than two decades also at 2 and 5 times them.
fn powers(ends: [f64; 2], factor: f64, every: i64) -> Ticks {
    let inside = |v: f64| v >= ends[0] - 1e-9 && v <= ends[1] + 1e-9;
    let span = ends[1] - ends[0];
    let mut ticks = Vec::new();
    let mut minor = Vec::new();
    let first = ends[0].floor() as i64;
    let last = (ends[1].ceil() as i64).min(first + 700);
    for n in first..=last {
        let decade = n as f64;
        for (digit, ahead) in (1..10).map(|d| (d, f64::from(d).log10())) {
            let place = decade + ahead;
            if !inside(place) {
                continue;
            }
            let value = 10f64.powf(place) / factor;
            let labelled = match digit {
                1 => n.rem_euclid(every) == 0,
                2 | 5 => span < FEW,
                _ => false,
            };
            if labelled {
                ticks.push((value, power(digit, n as i32, span < FEW)));
            } else if every == 1 || digit == 1 {
                minor.push(value);
            }
        }
    }
    (ticks, minor)
}

fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// "20", "0.05", "10⁶"; on a `short` axis, which has 2 and 5 too, "0.005" in place of a power of ten.
fn power(digit: i32, exponent: i32, short: bool) -> String {
    let plain = if short { 3 } else { 2 };
    match exponent {
        0.. if exponent <= plain => (f64::from(digit) * 10f64.powi(exponent)).to_string(),
        ..0 if exponent >= -plain => number(f64::from(digit) * 10f64.powi(exponent), (-exponent) as usize),
        _ if digit == 1 => format!("10{}", superscript(exponent)),
        _ => format!("{digit}×10{}", superscript(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, data: [f64; 2]) -> (String, Vec<String>) {
        let ruler = Ruler::new(axis, data, 0.0, 5.0);
        (ruler.title, ruler.ticks.into_iter().map(|(_, text)| text).collect())
    }

    #[test]
    fn a_short_logarithmic_axis_has_its_power_of_ten_in_the_unit() {
        let (title, ticks) = texts(&Axis::log("leak", "m3/s"), [1.1e-14, 2.6e-13]);
        assert_eq!(title, "leak [10⁻¹⁵ m³/s]");
        assert_eq!(ticks, ["20", "50", "100", "200"]);
    }

    #[test]
    fn ticks_are_round_numbers_in_the_unit_shown() {
        let (title, ticks) = texts(&Axis::linear("approach", "m"), [0.0, 3.2e-6]);
        assert_eq!(title, "approach [µm]");
        assert_eq!(ticks, ["0", "1", "2", "3"]);
        let (_, ticks) = texts(&Axis::linear("height", "m"), [-2.4e-7, 2.6e-7]);
        assert_eq!(ticks, ["−200", "−100", "0", "100", "200"]);
        let (_, ticks) = texts(&Axis::linear("contact fraction", ""), [0.1, 0.14]);
        assert_eq!(ticks, ["0.10", "0.11", "0.12", "0.13", "0.14"]);
    }

    #[test]
    fn decades_are_labelled_and_thinned() {
        let (title, ticks) = texts(&Axis::log("time", "s"), [1e-4, 1e3]);
        assert_eq!(title, "time [s]");
        assert_eq!(ticks, ["10⁻⁴", "0.01", "1", "100"]);
        let (_, ticks) = texts(&Axis::log("modulus", "Pa"), [1e6, 3e9]);
        assert_eq!(ticks, ["10⁻³", "0.01", "0.1", "1"]);
        let (_, ticks) = texts(&Axis::log("modulus", "Pa"), [1.1e9, 1.9e9]);
        assert_eq!(ticks, ["1.2", "1.4", "1.6", "1.8"]);
    }

    #[test]
    fn ticks_in_a_unit_that_is_no_power_of_ten_stand_on_the_axis() {
        let [low, high] = [7.2e3, 3e6];
        let days = Shown { factor: 1.0 / 86400.0, text: "d".to_owned() };
        let axis = Axis::log("time", "s").shown_in(Some(days));
        let ruler = Ruler::new(&axis, [low, high], 0.0, 5.0);
        assert_eq!(ruler.title, "time [d]");
        let all = ruler.ticks.iter().map(|(value, _)| *value).chain(ruler.minor.iter().copied());
        assert!(all.into_iter().all(|value| value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9)));
        let day = ruler.ticks.iter().find(|(_, text)| text == "1").unwrap().0;
        assert!((day / 86400.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn states_have_names_in_place_of_numbers() {
        let (title, ticks) = texts(&Axis::states("contact", &["open", "closed"]), [0.0, 1.0]);
        assert_eq!((title.as_str(), ticks), ("contact", vec!["open".to_owned(), "closed".to_owned()]));
    }

    #[test]
    fn a_plain_number_far_from_one_takes_its_power_of_ten_into_the_title() {
        let (title, ticks) = texts(&Axis::linear("misfit", ""), [0.0, 4e-7]);
        assert_eq!(title, "misfit [10⁻⁹]");
        assert_eq!(ticks, ["0", "100", "200", "300", "400"]);
    }

    #[test]
    fn numbers_beyond_the_prefixes_of_their_unit_take_a_power_of_ten() {
        let (title, ticks) = texts(&Axis::linear("area", "m2"), [0.0, 2.2e11]);
        assert_eq!(title, "area [10⁹ m²]");
        assert_eq!(ticks, ["0", "50", "100", "150", "200"]);
        let (title, ticks) = texts(&Axis::linear("energy", "J"), [0.0, 4e-25]);
        assert_eq!(title, "energy [10⁻¹⁵ pJ]");
        assert_eq!(ticks, ["0", "100", "200", "300", "400"]);
        // As long as five signs are enough there is none.
        let (title, ticks) = texts(&Axis::linear("energy", "J"), [0.0, 4e-15]);
        assert_eq!((title.as_str(), ticks[1].as_str()), ("energy [pJ]", "0.001"));
    }

    #[test]
    fn every_axis_has_two_numbers_at_least() {
        let count = |axis: Axis, data, wanted| Ruler::new(&axis, data, 0.0, wanted).ticks.len();
        for wanted in [0.1, 1.0, 1.3, 2.0, 3.0] {
            for data in
                [[-3.9, 1.9], [0.0, 9.9], [0.11, 0.19], [3.0, 7.0], [1e-4, 3e4], [0.02, 0.3], [0.7, 70.0]]
            {
                for axis in [Axis::linear("x", "m"), Axis::log("x", "m"), Axis::log("x", "s")] {
                    assert!(
                        axis.scale == Scale::Log && data[0] < 0.0 || count(axis.clone(), data, wanted) >= 2,
                        "{data:?} {axis:?} {wanted}"
                    );
                }
            }
        }
    }

    #[test]
    fn ranges_without_width_or_numbers_still_make_an_axis() {
        for data in
            [[2.0, 2.0], [0.0, 0.0], [-3.0, -3.0], [f64::INFINITY, f64::NEG_INFINITY], [f64::NAN, 1.0]]
        {
            for axis in [Axis::linear("x", "m"), Axis::log("x", "m")] {
                let ruler = Ruler::new(&axis, data, 0.05, 5.0).placed(0.0, 100.0);
                assert!(!ruler.ticks.is_empty(), "{data:?} {axis:?}");
                assert!(ruler.ticks.iter().all(|(v, _)| ruler.place(*v).is_some()));
            }
        }
    }

    #[test]
    fn values_are_placed_in_proportion_and_by_logarithm() {
        let linear = Ruler::new(&Axis::linear("x", ""), [0.0, 4.0], 0.0, 5.0).placed(10.0, 50.0);
        assert_eq!(linear.place(1.0), Some(20.0));
        let log = Ruler::new(&Axis::log("x", ""), [1.0, 100.0], 0.0, 5.0).placed(100.0, 0.0);
        assert!((log.place(10.0).unwrap() - 50.0).abs() < 1e-12);
        assert_eq!(log.place(0.0), None);
    }

    #[test]
    fn an_axis_that_counts_has_whole_numbers() {
        let texts = |axis: Axis, ends: [f64; 2]| -> Vec<String> {
            Ruler::new(&axis.counting(), ends, 0.0, 6.0).ticks.into_iter().map(|(_, text)| text).collect()
        };
        assert_eq!(texts(Axis::linear("row", ""), [1.0, 3.0]), ["1", "2", "3"]);
        // One value, of one thing: from none to two.
        assert_eq!(texts(Axis::linear("number", ""), [1.0, 1.0]), ["0", "1", "2"]);
        assert!(!texts(Axis::log("number", ""), [1.0, 1.0]).contains(&"0.5".to_owned()));
    }
}
