//! Numbers for people: SI values with the prefix that suits them, counts, bytes, durations.

use asperity::Coordinate;

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
const PREFIXED: [(&str, i32, i32); 13] = [
    ("m", -4, 0),
    ("s", -3, 0),
    ("m/s", -3, 1),
    ("N m", -3, 2),
    ("Pa", -1, 3),
    ("N", -3, 2),
    ("N/m", -3, 3),
    ("N/m2", -1, 3),
    ("J", -4, 1),
    ("J/m", -4, 1),
    ("W", -4, 1),
    ("W/m", -4, 1),
    ("Hz", -2, 3),
];

/// Units of long times: from so many seconds on, seconds in it, its name.
const LONG: [(f64, f64, &str); 3] =
    [(3.0 * 31_557_600.0, 31_557_600.0, "a"), (2.0 * 86_400.0, 86_400.0, "d"), (3.0 * 3600.0, 3600.0, "h")];

/// The unit to show numbers in whose largest magnitude is `largest` in the SI unit `unit`.
///
/// `unit` is one of m, s, m/s, N m, Pa, N, N/m, N/m2, J, J/m, W, W/m, Hz; the first ones with an exponent (`m2`) or below one (`1/Pa`, `1/m2`), or any other
/// text, which is shown as it is. Times of three hours and more are shown in hours, days or years.
///
/// ```
/// use asperity_files::readable::shown;
///
/// assert_eq!(shown("m", 3e-7).text, "nm");
/// assert_eq!(shown("m2", 3e-10).text, "µm²");
/// assert_eq!(shown("1/Pa", 5e-10).text, "1/GPa");
/// ```
pub fn shown(unit: &str, largest: f64) -> Shown {
    if let Some((_, seconds, text)) =
        LONG.iter().find(|long| unit == "s" && largest >= long.0 && largest.is_finite())
    {
        return Shown { factor: 1.0 / seconds, text: (*text).to_owned() };
    }
    let (inverse, base) = match unit.strip_prefix("1/") {
        Some(base) => (true, base),
        None => (false, unit),
    };
    // The prefix of a quotient is that of its first unit, to the first power.
    let trimmed = base.trim_end_matches(|c: char| c.is_ascii_digit());
    let letters = if base.contains('/') { base } else { trimmed };
    let power: i32 = base[letters.len()..].parse().unwrap_or(1);
    let known = PREFIXED.iter().find(|(name, ..)| *name == letters);
    let exponent = if inverse { -power } else { power };
    let prefix = known.map_or(0, |(_, least, most)| prefix(largest, exponent).clamp(*least, *most));
    let name = PREFIXES.iter().find(|(k, _)| *k == prefix).map_or("", |(_, name)| name);
    let power = if power == 1 { String::new() } else { superscript(power) };
    let text = match known {
        Some(_) => format!("{}{name}{}{power}", if inverse { "1/" } else { "" }, letters.replace("m2", "m²")),
        None => unit.replace("m2", "m²").replace("m3", "m³"),
    };
    Shown { factor: 10f64.powi(-3 * prefix * exponent), text }
}

/// The power of a thousand k for which `largest` / 1000^(k exponent) lies in \[1, 1000), of areas in \[0.01, 10^4), and of volumes in
/// \[0.001, 10^6).
fn prefix(largest: f64, exponent: i32) -> i32 {
    if !(largest.is_finite() && largest > 0.0) {
        return 0;
    }
    // Half of the fourth digit above: what four digits show as a thousand is one of the next prefix.
    let few = match exponent.abs() {
        power @ (2 | 3) => f64::from(power),
        _ => 0.0,
    };
    let decades = largest.log10() + 2.17e-5 + if exponent > 0 { few } else { -few };
    let steps = (decades / f64::from(3 * exponent.abs())).floor() as i32;
    if exponent > 0 { steps } else { -steps }
}

/// A whole number in superscript digits.
pub fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digit = |c: char| if c == '-' { '⁻' } else { DIGITS[c.to_digit(10).unwrap_or(0) as usize] };
    number.to_string().chars().map(digit).collect()
}

/// An SI value with four digits, its prefix and its unit: "12.3 mm", "5070 µm²".
///
/// ```
/// use asperity_files::readable::quantity;
/// assert_eq!(quantity(3e8, "Pa"), "300 MPa");
/// assert_eq!(quantity(5.07e-9, "m2"), "5070 µm²");
/// ```
pub fn quantity(value: f64, unit: &str) -> String {
    let shown = shown(unit, value.abs());
    // No minus before a zero.
    let number = value * shown.factor + 0.0;
    let digits =
        if number == 0.0 { 0 } else { (3.0 - number.abs().log10().floor()).clamp(0.0, 12.0) as usize };
    let text = format!("{number:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    let plain = number == 0.0 || !number.is_finite() || (1e-4..1e6).contains(&number.abs());
    let text = if plain { text.to_owned() } else { format!("{number:.3e}") };
    if shown.text.is_empty() { text } else { format!("{text} {}", shown.text) }
}

/// Where a row stands: "t = 2 ms", "v = 3 mm/s".
pub fn coordinate(at: Coordinate) -> String {
    format!("{} = {}", at.axis().symbol(), quantity(at.value(), at.axis().unit()))
}

/// So many of a thing: "1 term", "2 terms".
pub fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

/// Bytes in powers of 1024: "1.5 KiB".
pub fn bytes(count: f64) -> String {
    const UNITS: [&str; 7] = ["B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let step = (count.max(1.0).log2() / 10.0).floor().clamp(0.0, 6.0);
    let value = count / 1024f64.powf(step);
    let unit = UNITS[step as usize];
    if value >= 1e5 { format!("{value:.1e} {unit}") } else { format!("{value:.1} {unit}") }
}

/// A time on the clock \[s\] as hours, minutes or seconds: "1 h 02 min".
pub fn duration(seconds: f64) -> String {
    if seconds >= 3600.0 {
        format!("{:.0} h {:02.0} min", (seconds / 3600.0).floor(), ((seconds % 3600.0) / 60.0).floor())
    } else if seconds >= 60.0 {
        format!("{:.0} min {:02.0} s", (seconds / 60.0).floor(), (seconds % 60.0).floor())
    } else if seconds >= 0.9995 {
        format!("{seconds:.1} s")
    } else {
        quantity(seconds, "s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(unit: &str, largest: f64) -> (String, i32) {
        let shown = shown(unit, largest);
        (shown.text, shown.factor.log10().round() as i32)
    }

    #[test]
    fn a_zero_has_no_sign() {
        assert_eq!([quantity(-0.0, "m"), quantity(0.0, "N")], ["0 m", "0 N"]);
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
        let long = [1e4, 10800.0, 172_800.0, 1e8].map(|time| shown("s", time).text);
        assert_eq!(long, ["s", "h", "d", "a"]);
    }

    #[test]
    fn other_units_and_numbers_without_magnitude_stay_as_they_are() {
        assert_eq!(text("rad/s", 1e9), ("rad/s".into(), 0));
        assert_eq!(text("", 1e-9), (String::new(), 0));
        assert_eq!(text("m", 0.0), ("m".into(), 0));
        assert_eq!(text("m", f64::INFINITY), ("m".into(), 0));
    }

    #[test]
    fn numbers_have_four_digits_and_a_prefix() {
        assert_eq!(quantity(3.9312e-6, "m"), "3.931 µm");
        assert_eq!(quantity(0.5, "N"), "500 mN");
        assert_eq!(quantity(0.999_999_6, "N"), "1 N");
        assert_eq!(quantity(500.0, "s"), "500 s");
        assert_eq!(quantity(5.0696e-9, "m2"), "5070 µm²");
        assert_eq!(quantity(4.2e6, "N/m"), "4.2 MN/m");
        assert_eq!(quantity(4.2e6, "N/m2"), "4.2 MN/m²");
        assert_eq!(quantity(2e-3, "J/m"), "2 mJ/m");
        assert_eq!(quantity(0.0, "m"), "0 m");
        assert_eq!(quantity(f64::NAN, "m"), "NaN m");
        assert_eq!(quantity(86400.0, "s"), "24 h");
        assert_eq!(quantity(3e8, "s"), "9.506 a");
        assert_eq!(quantity(3e-4, "Pa"), "0.3 mPa");
        assert_eq!(quantity(-1.567e-20, "m"), "-1.567e-8 pm");
        assert_eq!(coordinate(Coordinate::Velocity(2e-3)), "v = 2 mm/s");
    }

    #[test]
    fn counts_bytes_and_durations_read_well() {
        assert_eq!(counted(1, "term") + " of " + &counted(0, "point"), "1 term of 0 points");
        assert_eq!(bytes(999.0), "999.0 B");
        assert_eq!(bytes(1536.0), "1.5 KiB");
        assert_eq!(bytes(2f64.powi(128)), "3.0e20 EiB");
        assert_eq!(duration(0.25), "250 ms");
        assert_eq!(duration(12.34), "12.3 s");
        assert_eq!(duration(3725.0), "1 h 02 min");
    }
}
