//! Name and unit of a column from its header, in the ways that people and programs write them.

use super::{role, units};
use crate::quantity::unit::Unit;

/// A cell without the quotes around it.
pub(super) fn unquoted(cell: &str) -> &str {
    cell.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(cell)
}

/// "MPa" of "[MPa]" or "(MPa)".
pub(super) fn bare_unit(cell: &str) -> &str {
    cell.trim_matches(['[', ']', '(', ')']).trim()
}

/// Whether a header cell is nothing but a unit (or says that there is none).
pub(super) fn is_unit(cell: &str) -> bool {
    const UNITS: [&str; 15] =
        ["", "-", "1", "s", "sec", "K", "h", "°C", "degC", "rad/s", "mrad/s", "rad", "mrad", "deg", "°"];
    let unit = bare_unit(cell);
    let unit = units::spelled(unit);
    // One letter is rather a name: t, T, f.
    UNITS.contains(&&*unit) || (unit.chars().count() > 1 && Unit::parse(&unit).is_ok())
}

/// Name and unit of "load [mN]", "load (mN)", "load/mN", "load, mN", "load in mN", "load_mN" or "load mN".
pub(super) fn split_unit(header: &str) -> (&str, &str) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        // The last bracket: "E(t) (MPa)".
        if let Some((name, rest)) = header.rsplit_once(open)
            && !name.trim().is_empty()
            && let Some((unit, "")) = rest.rsplit_once(close).map(|(unit, after)| (unit, after.trim()))
        {
            return match unit.trim() {
                // A part of a name: "Re(E*)".
                part if !is_unit(part)
                    && role::bare(header) != role::bare(name)
                    && role::Role::ALL.iter().any(|role| role.is_called(header)) =>
                {
                    (header.trim(), "")
                }
                // A function of something, not a quantity in a unit.
                "t" | "w" | "f" | "T" | "ω" | "omega" | "delta" | "δ" => (header.trim(), ""),
                unit => (name.trim(), unit),
            };
        }
    }
    // "omega_rad_s", "eta_Pa_s"
    let lower = header.to_lowercase();
    for (end, unit) in [
        ("rad_s", "rad/s"),
        ("rad_per_s", "rad/s"),
        ("rad_per_sec", "rad/s"),
        ("rad_sec", "rad/s"),
        ("pa_s", "Pa s"),
    ] {
        let at = lower.len().saturating_sub(end.len());
        if lower.len() == header.len() && lower.ends_with(end) && header[..at].ends_with('_') && at > 1 {
            return (header[..at - 1].trim(), unit);
        }
    }
    if let Some((name, unit)) = header.rsplit_once([' ', ',', ';', '_'])
        && is_unit_of(name, unit)
    {
        let name = name.trim_end_matches([' ', ',', ';', '_', '/']);
        return (name.strip_suffix(" in").or(name.strip_suffix("_in")).unwrap_or(name).trim(), unit);
    }
    match header.split_once('/') {
        Some((name, unit)) if !name.trim().is_empty() => (name.trim(), bare_unit(unit.trim())),
        _ => (header.trim(), ""),
    }
}

/// Whether the word after a name is its unit, and not the second word of the name ("E min", "T g").
fn is_unit_of(name: &str, unit: &str) -> bool {
    let named = !name.trim_matches([' ', ',', ';', '_', '/']).is_empty();
    let plain = name.trim_end_matches([' ', ',', ';', '_', '/']);
    let plain = plain.strip_suffix(" in").or(plain.strip_suffix("_in")).unwrap_or(plain);
    let time = name.trim().to_lowercase().starts_with('t') || role::Role::Time.is_called(plain);
    named
        && match unit {
            "" | "-" | "1" | "%" | "d" | "g" | "day" | "days" | "cal" => false,
            // "temperature_C"
            "C" | "c" | "F" | "f" => plain == "T" || role::Role::Temperature.is_called(plain),
            "min" | "sec" | "h" => time,
            "s" | "K" | "N" | "m" => true,
            unit => is_unit(unit),
        }
}
