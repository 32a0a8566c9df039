//! What a column holds, and the names that programs and people give it.
//!
//! Names are compared without case, blanks, brackets and other marks: "Tan(Delta)", "tan_delta" and "tan delta" are one.
//! The names are those of the exports of DMAs and rheometers (TA, Netzsch, Anton Paar, Mettler) in English and German and
//! of the tables of Python and Matlab users.

mod names;

use std::str::FromStr;

use asperity::material::Modulus;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Time since the step.
    Time,
    /// Relaxation modulus.
    Modulus,
    /// Creep compliance.
    Compliance,
    /// Frequency, in Hz or rad/s.
    Frequency,
    /// Storage modulus.
    Storage,
    /// Loss modulus.
    Loss,
    /// Loss factor E''/E', in place of the loss modulus.
    TanDelta,
    /// Phase angle, in place of the loss factor.
    Phase,
    /// Absolute value of the complex modulus, in place of the storage modulus.
    ComplexModulus,
    /// Real part of the complex compliance.
    StorageCompliance,
    /// Imaginary part of the complex compliance.
    LossCompliance,
    /// Absolute value of the complex viscosity.
    ComplexViscosity,
    /// Real part of the complex viscosity, loss modulus over angular frequency.
    RealViscosity,
    /// Imaginary part of the complex viscosity, storage modulus over angular frequency.
    ImaginaryViscosity,
    /// Temperature of the point.
    Temperature,
    /// Number or name of the sweep that the point belongs to.
    Set,
    /// Load of an indentation.
    Load,
    /// Depth of an indentation.
    Depth,
}

impl Role {
    /// All of them.
    pub const ALL: [Role; 18] = [
        Role::Time,
        Role::Modulus,
        Role::Compliance,
        Role::Frequency,
        Role::Storage,
        Role::Loss,
        Role::TanDelta,
        Role::Phase,
        Role::ComplexModulus,
        Role::StorageCompliance,
        Role::LossCompliance,
        Role::ComplexViscosity,
        Role::RealViscosity,
        Role::ImaginaryViscosity,
        Role::Temperature,
        Role::Set,
        Role::Load,
        Role::Depth,
    ];

    /// Its key in case files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Role::Time => "time",
            Role::Modulus => "modulus",
            Role::Compliance => "compliance",
            Role::Frequency => "frequency",
            Role::Storage => "storage",
            Role::Loss => "loss",
            Role::TanDelta => "tan_delta",
            Role::Phase => "phase",
            Role::ComplexModulus => "complex_modulus",
            Role::StorageCompliance => "storage_compliance",
            Role::LossCompliance => "loss_compliance",
            Role::ComplexViscosity => "complex_viscosity",
            Role::RealViscosity => "real_viscosity",
            Role::ImaginaryViscosity => "imaginary_viscosity",
            Role::Temperature => "temperature",
            Role::Set => "set",
            Role::Load => "load",
            Role::Depth => "depth",
        }
    }

    /// Unit in which a number without one is taken.
    pub(super) fn si(self) -> &'static str {
        match self {
            Role::Time => "s",
            Role::Modulus | Role::Storage | Role::Loss | Role::ComplexModulus => "Pa",
            Role::Compliance | Role::StorageCompliance | Role::LossCompliance => "1/Pa",
            Role::ComplexViscosity | Role::RealViscosity | Role::ImaginaryViscosity => "Pa s",
            Role::Frequency => "Hz",
            Role::TanDelta | Role::Set => "",
            Role::Phase => "rad",
            Role::Temperature => "K",
            Role::Load => "N",
            Role::Depth => "m",
        }
    }

    /// A unit of an example.
    pub(super) fn example(self) -> &'static str {
        match self {
            Role::Modulus | Role::Storage | Role::Loss | Role::ComplexModulus => "MPa",
            Role::Compliance | Role::StorageCompliance | Role::LossCompliance => "1/MPa",
            Role::TanDelta | Role::Set => "-",
            Role::Phase => "deg",
            Role::Temperature => "°C",
            Role::Load => "mN",
            Role::Depth => "um",
            role => role.si(),
        }
    }

    /// Whether a name means it.
    pub(super) fn is_called(self, name: &str) -> bool {
        names::of(self).contains(&bare(name).as_str())
    }
}

impl FromStr for Role {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Role::ALL.into_iter().find(|role| role.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Role::ALL.iter().map(|role| role.name()).collect();
            format!("\"{name}\" is no quantity of a curve; there are {}", names.join(", "))
        })
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
    const REST: [&str; 20] = [
        "1",
        "2",
        "",
        "'",
        "''",
        "*",
        "t",
        "r",
        "rel",
        "relax",
        "stor",
        "storage",
        "loss",
        "creep",
        "complex",
        "prime",
        "doubleprime",
        "star",
        "modul",
        "modulus",
    ];
    let name = bare(name);
    if name.contains("shear") || name.contains("schub") {
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
    if REST.contains(&rest) {
        return of(symbol);
    }
    // "Relaxation modulus E(t)"
    for (end, measure) in [("et", 'e'), ("gt", 'g'), ("jt", 'j'), ("dt", 'd')] {
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
