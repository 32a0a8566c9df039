//! Numbers as a person reads and writes them.

use crate::failure::Failure;

/// A quantity with the SI prefix that leaves one to three digits before the point.
///
/// The exponent `power` of the unit (2 for an area) scales the prefix.
pub fn quantity(value: f64, unit: &str, power: i32) -> String {
    const PREFIXES: [(&str, i32); 10] = [
        ("p", -12),
        ("n", -9),
        ("µ", -6),
        ("m", -3),
        ("", 0),
        ("k", 3),
        ("M", 6),
        ("G", 9),
        ("T", 12),
        ("P", 15),
    ];
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {unit}");
    }
    let scale = |exponent: i32| 10f64.powi(exponent * power);
    let fits = PREFIXES.iter().rev().find(|(_, e)| value.abs() >= scale(*e) * 0.9995);
    let (prefix, exponent) = fits.unwrap_or(&PREFIXES[0]);
    let mantissa = value / scale(*exponent);
    let digits = if mantissa.abs() >= 99.95 {
        1
    } else if mantissa.abs() >= 9.995 {
        2
    } else {
        3
    };
    format!("{mantissa:.digits$} {prefix}{unit}")
}

/// So many of a thing: `1 term`, `2 terms`.
pub fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

/// Bytes in powers of 1024.
pub fn bytes(count: f64) -> String {
    let units = ["B", "KiB", "MiB", "GiB", "TiB", "PiB"];
    let step = (count.max(1.0).log2() / 10.0).floor().clamp(0.0, 5.0);
    format!("{:.1} {}", count / 1024f64.powf(step), units[step as usize])
}

/// Seconds as hours, minutes or seconds.
pub fn duration(seconds: f64) -> String {
    if seconds >= 3600.0 {
        format!("{:.0} h {:02.0} min", (seconds / 3600.0).floor(), ((seconds % 3600.0) / 60.0).floor())
    } else if seconds >= 60.0 {
        format!("{:.0} min {:02.0} s", (seconds / 60.0).floor(), (seconds % 60.0).floor())
    } else if seconds >= 0.9995 {
        format!("{seconds:.1} s")
    } else {
        quantity(seconds, "s", 1)
    }
}

/// A quantity of the command line; `example` shows how the flag is used.
pub fn read<Q: std::str::FromStr<Err: std::fmt::Display>>(
    flag: &str,
    text: &str,
    example: &str,
) -> Result<Q, Failure> {
    let told =
        |error| Failure::input(format!("{flag} is \"{text}\": {error}; write e.g. {flag} '{example}'"));
    text.trim().parse().map_err(told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(quantity(0.0123, "m", 1), "12.30 mm");
        assert_eq!(quantity(3.95e-6, "m", 1), "3.950 µm");
        assert_eq!(quantity(300e6, "Pa", 1), "300.0 MPa");
        assert_eq!(quantity(4.9e-9, "m²", 2), "4900.0 µm²");
        assert_eq!(quantity(0.0, "N", 1), "0 N");
        assert_eq!(bytes(1536.0), "1.5 KiB");
        assert_eq!(duration(0.25), "250.0 ms");
        assert_eq!(duration(12.34), "12.3 s");
        assert_eq!(duration(3725.0), "1 h 02 min");
    }
}
