//! Units as they stand on an axis: SI values with the prefix that suits them.

/// A unit with its prefix: the number shown is `factor` times the SI value.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Shown number per SI value.
    pub factor: f64,
    /// The unit's text, `µm²`; empty for a plain number.
    pub text: String,
}

/// Prefixes by their power of a thousand, from pico to giga.
const PREFIXES: [(i32, &str); 8] =
    [(-4, "p"), (-3, "n"), (-2, "µ"), (-1, "m"), (0, ""), (1, "k"), (2, "M"), (3, "G")];

/// Units that take prefixes, with the smallest and the largest that is in use.
const PREFIXED: [(&str, i32, i32); 7] =
    [("m", -4, 0), ("s", -3, 0), ("Pa", -1, 3), ("N", -3, 2), ("J", -4, 1), ("W", -4, 1), ("Hz", -2, 3)];

/// The unit to show numbers in whose largest magnitude is `largest` in the SI unit `unit`.
///
/// `unit` is one of m, s, Pa, N, J, W, Hz with an exponent (`m2`) or below one (`1/Pa`, `1/m2`), or any other
/// text, which is shown as it is.
///
/// ```
/// use asperity_report::figure::shown;
///
/// assert_eq!(shown("m", 3e-7).text, "nm");
/// assert_eq!(shown("m2", 3e-10).text, "µm²");
/// assert_eq!(shown("1/Pa", 5e-10).text, "1/GPa");
/// ```
pub fn shown(unit: &str, largest: f64) -> Shown {
    let (inverse, base) = match unit.strip_prefix("1/") {
        Some(base) => (true, base),
        None => (false, unit),
    };
    let letters = base.trim_end_matches(|c: char| c.is_ascii_digit());
    let power: i32 = base[letters.len()..].parse().unwrap_or(1);
    let known = PREFIXED.iter().find(|(name, ..)| *name == letters);
    let exponent = if inverse { -power } else { power };
    let prefix = known.map_or(0, |(_, least, most)| prefix(largest, exponent).clamp(*least, *most));
    let name = PREFIXES.iter().find(|(k, _)| *k == prefix).map_or("", |(_, name)| name);
    let power = if power == 1 { String::new() } else { superscript(power) };
    let text = match known {
        Some(_) => format!("{}{name}{letters}{power}", if inverse { "1/" } else { "" }),
        None => unit.to_owned(),
    };
    Shown { factor: 10f64.powi(-3 * prefix * exponent), text }
}

/// The power of a thousand k for which `largest` / 1000^(k exponent) lies in \[1, 1000^|exponent|).
fn prefix(largest: f64, exponent: i32) -> i32 {
    if !(largest.is_finite() && largest > 0.0) {
        return 0;
    }
    // Half of the fourth digit above: what four digits show as a thousand is one of the next prefix.
    let decades = largest.log10() + 2.17e-5;
    let steps = (decades / f64::from(3 * exponent.abs())).floor() as i32;
    if exponent > 0 { steps } else { -steps }
}

/// A whole number in superscript digits.
pub(super) fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digit = |c: char| if c == '-' { '⁻' } else { DIGITS[c.to_digit(10).unwrap_or(0) as usize] };
    number.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(unit: &str, largest: f64) -> (String, i32) {
        let shown = shown(unit, largest);
        (shown.text, shown.factor.log10().round() as i32)
    }

    #[test]
    fn the_prefix_makes_the_largest_number_lie_between_one_and_a_thousand() {
        assert_eq!(text("m", 1e-6), ("µm".into(), 6));
        assert_eq!(text("N", 0.999_98), ("N".into(), 0));
        assert_eq!(text("N", 0.999_9), ("mN".into(), 3));
        assert_eq!(text("m", 0.999e-6), ("nm".into(), 9));
        assert_eq!(text("m", 2e3), ("m".into(), 0));
        assert_eq!(text("Pa", 3e8), ("MPa".into(), -6));
        assert_eq!(text("m2", 5e-9), ("µm²".into(), 12));
        assert_eq!(text("m2", 5e-6), ("mm²".into(), 6));
        assert_eq!(text("1/Pa", 5e-10), ("1/GPa".into(), 9));
        assert_eq!(text("1/Pa", 5e-8), ("1/GPa".into(), 9));
        assert_eq!(text("1/m", 5e5), ("1/mm".into(), -3));
        assert_eq!(text("1/m", 5e6), ("1/µm".into(), -6));
        assert_eq!(text("m4", 1e-26), ("nm⁴".into(), 36));
        assert_eq!(text("s", 5e4), ("s".into(), 0));
    }

    #[test]
    fn other_units_and_numbers_without_magnitude_stay_as_they_are() {
        assert_eq!(text("rad/s", 1e9), ("rad/s".into(), 0));
        assert_eq!(text("", 1e-9), (String::new(), 0));
        assert_eq!(text("m", 0.0), ("m".into(), 0));
        assert_eq!(text("m", f64::INFINITY), ("m".into(), 0));
    }
}
