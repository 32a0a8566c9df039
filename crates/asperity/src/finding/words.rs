//! Numbers in the texts of findings.

use crate::error::significant;

/// Three digits and a prefix: `si(2.5e-5, "m")` is "25 µm". Powers of a unit have no prefix.
pub(crate) fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [(&str, i32); 8] =
        [("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9), ("T", 12)];
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {unit}");
    }
    let size = value.abs() * (1.0 + 5e-4);
    let (prefix, exponent) =
        PREFIXES.iter().rev().find(|(_, exponent)| size >= 10f64.powi(*exponent)).unwrap_or(&PREFIXES[0]);
    let mantissa = digits(value / 10f64.powi(*exponent));
    format!("{mantissa} {prefix}{unit}")
}

/// Three digits, without zeros at the end: 0.123, 12.3, 123, 1.2e7.
pub(super) fn digits(value: f64) -> String {
    significant(value, 3)
}

/// "row 3" or "rows 3 to 7".
pub(super) fn rows([first, last]: [usize; 2]) -> String {
    if first == last { format!("row {first}") } else { format!("rows {first} to {last}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(si(2.5e-5, "m"), "25 µm");
        assert_eq!(si(0.999_999, "N"), "1 N");
        assert_eq!(si(0.0, "Pa"), "0 Pa");
        assert_eq!(si(0.12345, "m"), "123 mm");
        assert_eq!(si(2e-13, "m"), "0.0002 nm");
        assert_eq!(si(1e17, "Pa"), "100000 TPa");
        assert_eq!(digits(229_159.0), "229000");
        assert_eq!(digits(0.000_045_6), "4.56e-5");
    }
}
