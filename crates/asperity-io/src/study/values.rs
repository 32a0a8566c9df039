//! The values that a key takes in a study, as they are written: `A,B,C`, `FROM:TO:COUNT[:log]`, `1..10`.
//!
//! A list is split at commas outside of quotes and brackets. A value is that of `--set`: TOML, or else text. Numbers of a sweep are
//! rounded to six digits, or more where that would move them by a thousandth of their distance; the runs use the rounded numbers.

use serde::{Deserialize, Serialize};

use crate::quantity::in_si;

/// A value that a key takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Value(String);

/// No study varies a key over more values.
const MOST: usize = 100_000;
/// Digits of the numbers of a sweep at least and at most.
const DIGITS: std::ops::RangeInclusive<usize> = 6..=15;

impl Value {
    /// A value as an override has it. A text in quotes that is the same without them loses them: a value has one form.
    pub(super) fn new(source: &str) -> Value {
        let source = source.trim();
        let bare = match source.parse::<toml_edit::Value>() {
            Ok(toml_edit::Value::String(text)) => Some(text.into_value()),
            _ => None,
        };
        let is_text = |text: &String| text.trim() == text && text.parse::<toml_edit::Value>().is_err();
        Value(bare.filter(is_text).unwrap_or_else(|| source.to_owned()))
    }

    /// Its text as an override has it: TOML, or else text.
    pub fn source(&self) -> &str {
        &self.0
    }

    /// Its text for people, without the quotes of TOML.
    pub fn text(&self) -> String {
        match self.0.parse::<toml_edit::Value>() {
            Ok(toml_edit::Value::String(text)) => text.into_value(),
            _ => self.0.clone(),
        }
    }

    /// Its number in SI and the unit, empty for a pure number; `None` for what is no quantity.
    pub fn number(&self) -> Option<(f64, &'static str)> {
        in_si(&self.text())
    }

    /// Whether it says the same as another one.
    pub(super) fn is(&self, other: &Value) -> bool {
        match (self.number(), other.number()) {
            (Some((a, unit)), Some((b, other))) => {
                a == b && (unit == other || unit.is_empty() || other.is_empty())
            }
            (None, None) => self.text() == other.text(),
            _ => false,
        }
    }
}

/// The values that a text lists.
///
/// # Errors
/// A sentence: what is wrong, and what was expected.
pub(super) fn read(text: &str) -> Result<Vec<Value>, String> {
    let mut values = vec![];
    for item in split(text, ',')? {
        if item.trim().is_empty() {
            return Err(format!("{text:?} has an empty value; write A,B,C"));
        }
        values.extend(item_of(item.trim())?);
        if values.len() > MOST {
            return Err(format!("{text:?} has more than {MOST} values; take fewer"));
        }
    }
    Ok(values)
}

/// One value, a sweep, or a range of whole numbers.
fn item_of(item: &str) -> Result<Vec<Value>, String> {
    if let Some((from, to)) = item.split_once("..")
        && let (Ok(from), Ok(to)) = (from.trim().parse::<i64>(), to.trim().parse::<i64>())
    {
        let count = i128::from(to) - i128::from(from) + 1;
        return match count {
            ..=0 => Err(format!("{item:?} ends before it begins; write the smaller number first")),
            count if count > MOST as i128 => {
                Err(format!("{item:?} has {count} values; at most {MOST} are possible"))
            }
            _ => Ok((from..=to).map(|number| Value(number.to_string())).collect()),
        };
    }
    let parts = split(item, ':')?;
    match parts[..] {
        [from, to, count] if is_number(from) && is_number(to) => sweep(item, from, to, count, false),
        [from, to, count, spacing] if is_number(from) && is_number(to) => match spacing.trim() {
            "log" => sweep(item, from, to, count, true),
            "linear" => sweep(item, from, to, count, false),
            _ => Err(format!(
                "{item:?} ends with {spacing:?}, but must end with log or linear, or with the count"
            )),
        },
        [from, to] if is_number(from) && is_number(to) => Err(format!(
            "{item:?} does not say how many values there are; write FROM:TO:COUNT, e.g. \"0.1 N:10 N:5:log\""
        )),
        _ => Ok(vec![Value::new(item)]),
    }
}

fn is_number(text: &str) -> bool {
    Number::of(text).is_some()
}

/// Numbers of `count` values between two ends, equally far apart or, `log`, by equal factors.
fn sweep(item: &str, from: &str, to: &str, count: &str, log: bool) -> Result<Vec<Value>, String> {
    let count: usize = match count.trim().parse() {
        Ok(count) if (2..=MOST).contains(&count) => count,
        _ => {
            return Err(format!(
                "{item:?} has the count {count:?}, but it must be a whole number from 2 to {MOST}"
            ));
        }
    };
    let (Some(first), Some(last)) = (Number::of(from), Number::of(to)) else {
        return Err(format!("{item:?} must begin with two numbers, e.g. \"0.1 N:10 N:5:log\""));
    };
    let Some(end) = last.in_unit_of(&first) else {
        return Err(format!(
            "{item:?} goes from {:?} to {:?}; both ends need a unit of the same kind",
            from.trim(),
            to.trim()
        ));
    };
    if log && !(first.value > 0.0 && end > 0.0) {
        return Err(format!("{item:?} is logarithmic, so both ends must be greater than 0"));
    }
    let at = |n: usize| {
        let share = n as f64 / (count - 1) as f64;
        match log {
            true => first.value * libm::pow(end / first.value, share),
            false => first.value + share * (end - first.value),
        }
    };
    // Rounding to d digits moves a number by half of 10^(1-d) of it at most.
    let apart = (1..count).map(|n| (at(n) - at(n - 1)).abs() / at(n).abs().max(at(n - 1).abs()));
    let closest = apart.fold(1.0, f64::min).max(f64::MIN_POSITIVE);
    let digits = ((4.0 - closest.log10()).ceil() as usize).clamp(*DIGITS.start(), *DIGITS.end());
    let mut values: Vec<Value> = (0..count).map(|n| first.with(at(n), digits)).collect();
    // The ends are as they were written.
    (values[0], values[count - 1]) = (Value::new(from), Value::new(to));
    Ok(values)
}

/// A number with the text of its unit.
struct Number<'t> {
    value: f64,
    unit: &'t str,
    text: &'t str,
}

impl<'t> Number<'t> {
    fn of(text: &'t str) -> Option<Number<'t>> {
        let text = text.trim();
        in_si(text)?;
        // The number is the longest beginning that is one.
        let ends = (1..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
        let (end, value) =
            ends.into_iter().find_map(|end| Some((end, text[..end].trim().parse::<f64>().ok()?)))?;
        value.is_finite().then_some(Number { value, unit: text[end..].trim(), text })
    }

    /// Its value in the unit of another number; `None` where that has another dimension.
    fn in_unit_of(&self, other: &Number<'_>) -> Option<f64> {
        if self.unit == other.unit {
            return Some(self.value);
        }
        let ((own, dimension), (_, wanted)) = (in_si(self.text)?, in_si(other.text)?);
        let at = |value: f64| in_si(&format!("{value:?} {}", other.unit)).map(|(si, _)| si);
        let (zero, one) = (at(0.0)?, at(1.0)?);
        (dimension == wanted && !self.unit.is_empty() && !other.unit.is_empty())
            .then(|| (own - zero) / (one - zero))
    }

    /// Another value with its unit, rounded to so many digits.
    fn with(&self, value: f64, digits: usize) -> Value {
        let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
        let number = match rounded == 0.0 || (1e-3..1e7).contains(&rounded.abs()) {
            true => format!("{rounded}"),
            false => format!("{rounded:e}"),
        };
        Value(format!("{number} {}", self.unit).trim_end().to_owned())
    }
}

/// The parts of a text between these characters, outside of quotes and brackets.
fn split(text: &str, at: char) -> Result<Vec<&str>, String> {
    let (mut parts, mut begin, mut depth, mut quote, mut escaped) = (vec![], 0, 0, None, false);
    for (n, c) in text.char_indices() {
        match (quote, c) {
            _ if escaped => escaped = false,
            (Some('"'), '\\') => escaped = true,
            (Some(open), _) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, _) if c == at && depth == 0 => {
                parts.push(&text[begin..n]);
                begin = n + c.len_utf8();
            }
            _ => {}
        }
    }
    if quote.is_some() || depth != 0 {
        return Err(format!("{text:?} has a quote or a bracket that is not closed"));
    }
    parts.push(&text[begin..]);
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<String> {
        read(text).unwrap_or_else(|error| panic!("{error}")).iter().map(Value::text).collect()
    }

    #[test]
    fn lists_are_split_outside_of_quotes_and_brackets() {
        assert_eq!(texts("0.1 N, 0.3 N,1 N"), ["0.1 N", "0.3 N", "1 N"]);
        assert_eq!(texts("[1, 2],[3,4]"), ["[1, 2]", "[3,4]"]);
        assert_eq!(texts("{ a = \"x,}\" }, b"), ["{ a = \"x,}\" }", "b"]);
        assert_eq!(texts(r#""a, \"b", 'c,d', true"#), ["a, \"b", "c,d", "true"]);
        assert_eq!(texts("../heights:1.csv,C:\\map.sdf"), ["../heights:1.csv", "C:\\map.sdf"]);
    }

    #[test]
    fn whole_numbers_have_both_ends() {
        assert_eq!(texts("1..4"), ["1", "2", "3", "4"]);
        assert_eq!(texts("-1..1, 7"), ["-1", "0", "1", "7"]);
    }

    #[test]
    fn sweeps_have_round_numbers_and_the_ends_as_written() {
        assert_eq!(texts("0:1:11").join(" "), "0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1");
        assert_eq!(texts("0.1 N:10 N:3:log"), ["0.1 N", "1 N", "10 N"]);
        assert_eq!(texts("1e-9 m : 1 um : 4 : log"), ["1e-9 m", "1e-8 m", "1e-7 m", "1 um"]);
        assert_eq!(texts("20 °C:80 °C:3"), ["20 °C", "50 °C", "80 °C"]);
        assert_eq!(texts("0 °C:300.15 K:4"), ["0 °C", "9 °C", "18 °C", "300.15 K"]);
        assert_eq!(texts("10 N:1 N:4:linear"), ["10 N", "7 N", "4 N", "1 N"]);
        assert_eq!(texts("1 N:10 N:3:log")[1], "3.16228 N");
        assert_eq!(texts("1 m:1.0000003 m:4").join(" "), "1 m 1.0000001 m 1.0000002 m 1.0000003 m");
        assert_eq!(texts("-1:1:5").join(" "), "-1 -0.5 0 0.5 1");
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, words) in [
            ("", "empty value"),
            ("1,,2", "empty value"),
            ("5..1", "ends before it begins"),
            ("1..9000000000", "at most 100000"),
            ("0.1 N:1 N", "how many"),
            ("0.1 N:1 N:1", "from 2 to"),
            ("0.1 N:1 N:few", "count \"few\""),
            ("0.1 N:1:3", "same kind"),
            ("0.1 N:1 m:3", "same kind"),
            ("0 N:1 N:3:log", "greater than 0"),
            ("1 N:2 N:3:loge", "log or linear"),
            ("[1, 2", "not closed"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(words), "{text}: {message}");
        }
    }

    #[test]
    fn the_same_value_in_other_units_is_the_same() {
        let value = Value::new;
        assert!(value("\"0.1 N\"") == value("0.1 N"));
        assert!(value("\"1\"") != value("1") && value("\" a\"") != value("a"));
        assert!(
            value("100 mN").is(&value("0.1 N"))
                && value("\"a\"").is(&value("a"))
                && value("1").is(&value("1.0"))
        );
        assert!(
            !value("100 mN").is(&value("0.1 m"))
                && !value("a").is(&value("1"))
                && !value("1 N").is(&value("2 N"))
        );
    }
}
