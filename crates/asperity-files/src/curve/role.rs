//! What a column holds, and the names that programs and people give it.
//!
//! Names are compared without case, blanks, brackets and other marks: "Tan(Delta)", "tan_delta" and "tan delta" are one.
//! The names are those of the exports of DMAs and rheometers (TA, Netzsch, Anton Paar, Mettler) in English and German and
//! of the tables of Python and Matlab users.

mod table;

use std::str::FromStr;

use asperity::material::Modulus;

pub use table::Role;

impl Role {
    /// Whether a name means it.
    pub(super) fn is_called(self, name: &str) -> bool {
        let known = |name: &str| {
            let name = bare(name);
            self.names().any(|known| known == name)
        };
        // A name and its symbol: "Relaxation modulus, E", "Angular frequency (ω)", "Time, t".
        let symbol = |text: &str| {
            let text = text.trim_matches([' ', '(', ')', '[', ']', ',', ':', '=']);
            known(text) || matches!((self, text), (Role::Time, "t") | (Role::Temperature, "T"))
        };
        let parts = || name.trim_end().rsplit_once([',', ' ', '(', ':']);
        known(name) || parts().is_some_and(|(words, last)| known(words) && symbol(last))
    }

    /// Whether it is a modulus or a compliance.
    pub(super) fn is_modulus(self) -> bool {
        matches!(
            self,
            Role::Modulus
                | Role::Storage
                | Role::Loss
                | Role::ComplexModulus
                | Role::Compliance
                | Role::StorageCompliance
                | Role::LossCompliance
        )
    }
}

/// Names of roles, for messages.
pub(super) fn listed<'a>(roles: impl IntoIterator<Item = &'a Role>) -> String {
    roles.into_iter().map(|role| role.name()).collect::<Vec<_>>().join(", ")
}

impl FromStr for Role {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Role::ALL.into_iter().find(|role| role.name() == name);
        known.ok_or_else(|| format!("\"{name}\" is no quantity of a curve; there are {}", listed(&Role::ALL)))
    }
}

/// The base of the logarithm that a header names, and what it is the logarithm of: "log f", "lg(G')", "ln(E' [MPa])", "logE'".
pub(super) fn logarithm(header: &str) -> (Option<f64>, &str) {
    let header = header.trim();
    let bases = [("log10", 10.0), ("log", 10.0), ("lg", 10.0), ("ln", std::f64::consts::E)];
    for (word, base) in bases {
        let Some((start, rest)) = header.split_at_checked(word.len()) else { continue };
        let apart = !rest.starts_with(char::is_alphanumeric);
        let joined = || word != "ln" && Role::ALL.iter().any(|role| role.is_called(rest));
        if !start.eq_ignore_ascii_case(word)
            || rest.trim().is_empty()
            || !(apart || word == "log10" || joined())
        {
            continue;
        }
        let rest = rest.trim_start_matches([' ', '_', '-', '.']);
        let inner = [('(', ')'), ('[', ']')].into_iter().find_map(|(open, close)| {
            let inner = rest.strip_prefix(open)?.strip_suffix(close)?;
            // The brackets are one pair around everything.
            let mut depth = 1;
            let closed = inner.chars().any(|c| {
                depth += i32::from(c == open) - i32::from(c == close);
                depth == 0
            });
            (!closed).then_some(inner)
        });
        return (Some(base), inner.unwrap_or(rest).trim());
    }
    (None, header)
}

/// A name in lower case, primes written in one way, without blanks, brackets and other marks.
pub(super) fn bare(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars().flat_map(char::to_lowercase) {
        match c {
            '\u{2032}' | '\u{2019}' | '\u{b4}' | '`' | '\u{2b9}' => text.push('\''),
            '\u{2033}' | '"' | '\u{2ba}' | '\u{201d}' => text.push_str("''"),
            '*' | '\'' => text.push(c),
            c if c.is_alphanumeric() => text.push(c),
            _ => {}
        }
    }
    text
}

/// A header without the number that programs add where it occurs twice: "f [Hz].1", "f.1 [Hz]".
pub(super) fn unnumbered(header: &str) -> String {
    let without = |text: &str| -> Option<String> {
        let (start, digits) = text.trim_end().rsplit_once('.')?;
        let counts = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
        (counts && !start.ends_with(|c: char| c.is_ascii_digit())).then(|| start.trim_end().to_owned())
    };
    let (name, unit) = header.split_at(header.find(['[', '(']).unwrap_or(header.len()));
    match (without(header), without(name)) {
        (Some(whole), _) => whole,
        (None, Some(name)) => format!("{name} {unit}").trim_end().to_owned(),
        (None, None) => header.to_owned(),
    }
}

/// What a name calls the modulus or compliance: E and D are Young's, G and J shear.
pub(super) fn measure_of(name: &str) -> Option<Modulus> {
    /// What may follow the symbol.
    const REST: &str =
        "1 2 ' '' * t r rel relax stor storage loss creep complex prime doubleprime star modul modulus";
    let name = bare(name);
    if ["shear", "schub", "cisaillement"].iter().any(|word| name.contains(word)) {
        return Some(Modulus::Shear);
    }
    if ["young", "tensile", "bending", "elastizität", "zugmodul"].iter().any(|word| name.contains(word)) {
        return Some(Modulus::Young);
    }
    // "Re(E*)"
    let parts = ["real", "imag", "abs", "re", "im"];
    let name = parts
        .iter()
        .find_map(|part| name.strip_prefix(part).filter(|rest| rest.ends_with('*')))
        .unwrap_or(&name);
    let of = |symbol: char| match symbol {
        'g' | 'j' => Some(Modulus::Shear),
        'e' | 'd' => Some(Modulus::Young),
        _ => None,
    };
    let (symbol, rest) = (name.chars().next()?, name.get(1..).unwrap_or_default());
    if rest.is_empty() || REST.split(' ').any(|known| known == rest) {
        return of(symbol);
    }
    // "Relaxation modulus E(t)"
    for (end, measure) in
        [("et", 'e'), ("gt", 'g'), ("jt", 'j'), ("dt", 'd'), ("e", 'e'), ("g", 'g'), ("j", 'j'), ("d", 'd')]
    {
        let words = name.strip_suffix(end).unwrap_or_default();
        if ["modulus", "modul", "compliance", "nachgiebigkeit"].iter().any(|word| words.ends_with(word)) {
            return of(measure);
        }
    }
    // "Storage modulus G'"
    let end = name.trim_end_matches(['\'', '*']);
    if end.len() < name.len() { of(end.chars().next_back()?) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_call_a_quantity_by_many_names() {
        for (role, names) in [
            (
                Role::Storage,
                &[
                    "E'",
                    "G′",
                    "E_stor",
                    "Storage Modulus",
                    "Storage modulus G'",
                    "Speichermodul",
                    "E1",
                    "Re(E*)",
                ][..],
            ),
            (Role::Loss, &["E''", "E″", "G\"", "E_loss", "Loss Modulus", "Verlustmodul G''", "Im(G*)"]),
            (Role::TanDelta, &["tan delta", "Tan(δ)", "tan_delta", "tan d", "Loss Factor", "Verlustfaktor"]),
            (Role::ComplexModulus, &["|E*|", "G*", "Complex Modulus"]),
            (Role::ComplexViscosity, &["|η*|", "Complex Viscosity"]),
            (
                Role::Frequency,
                &["f", "freq.", "Angular Frequency", "Ang. frequency", "omega", "ω", "Kreisfrequenz"],
            ),
            (Role::Modulus, &["E_relax", "G(t)", "Relaxation Modulus", "E-Modul"]),
            (Role::Compliance, &["J(t)", "D", "Creep compliance"]),
            (Role::Temperature, &["Temp.", "Temperature", "Temperatur"]),
            (Role::Set, &["Set", "run"]),
        ] {
            for name in names {
                assert!(role.is_called(name), "{name}");
            }
        }
        // Instruments have other columns too.
        for name in ["F stat.", "Strain dyn", "|J*|", "T2", "Lo", "Nr"] {
            assert!(!Role::ALL.iter().any(|role| role.is_called(name)), "{name}");
        }
    }

    #[test]
    fn logarithms_are_told_from_names_that_begin_alike() {
        let ten = Some(10.0);
        for (header, found) in [
            ("log f", (ten, "f")),
            ("lg(G')", (ten, "G'")),
            ("log10 E'", (ten, "E'")),
            ("log10E'", (ten, "E'")),
            ("logG\"", (ten, "G\"")),
            ("log(f [Hz])", (ten, "f [Hz]")),
            ("log (f) [Hz]", (ten, "(f) [Hz]")),
            ("Log_t", (ten, "t")),
            ("ln(E'/MPa)", (Some(std::f64::consts::E), "E'/MPa")),
            ("Logger time", (None, "Logger time")),
            ("ln", (None, "ln")),
            ("length", (None, "length")),
            ("loss", (None, "loss")),
        ] {
            assert_eq!(logarithm(header), found, "{header}");
        }
    }

    #[test]
    fn numbers_of_repeated_headers_are_dropped() {
        for (header, plain) in [
            ("f [Hz].1", "f [Hz]"),
            ("f.12 [Hz]", "f [Hz]"),
            ("E'.1", "E'"),
            ("E'(0.1 Hz)", "E'(0.1 Hz)"),
            ("E' 10.5", "E' 10.5"),
            ("f [Hz]", "f [Hz]"),
        ] {
            assert_eq!(unnumbered(header), plain, "{header}");
        }
    }

    #[test]
    fn a_name_says_which_modulus_it_is() {
        for name in [
            "E'",
            "E_stor",
            "|E*|",
            "Storage modulus E'",
            "tensile storage modulus",
            "D(t)",
            "E-Modul",
            "Re(E*)",
            "E1",
            "Relaxation Modulus E(t)",
        ] {
            assert_eq!(measure_of(name), Some(Modulus::Young), "{name}");
        }
        for name in ["G(t)", "Storage modulus G'", "J'", "Schubmodul", "G_relax", "Im(G*)", "|G*|"] {
            assert_eq!(measure_of(name), Some(Modulus::Shear), "{name}");
        }
        for name in ["storage modulus", "dynamic modulus", "modulus", "Speichermodul"] {
            assert_eq!(measure_of(name), None, "{name}");
        }
    }
}
