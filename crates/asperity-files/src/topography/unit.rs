//! Units of length as instruments and programs write them.

/// Whether a lone `A` is the ångström (as contact.engineering writes it) or the ampere (as Gwyddion does).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LoneA {
    Angstrom,
    Ampere,
}

/// Metres per `label`, or `None` where it is no unit of length.
pub(super) fn metres(label: &str, lone_a: LoneA) -> Option<f64> {
    let label = label.trim_matches(|c: char| c.is_whitespace() || c == '\0' || c == '"');
    // Greek mu, the micro sign, and the code pages' ways to spell it ("æm": MS-DOS read as Latin-1; "~m": Olympus).
    let label = label.replace(['\u{3bc}', '\u{e6}', '~'], "\u{b5}");
    Some(match label.as_str() {
        "km" => 1e3,
        "m" => 1.0,
        "dm" => 1e-1,
        "cm" => 1e-2,
        "mm" => 1e-3,
        "\u{b5}m" | "um" | "\u{b5}" => 1e-6,
        "nm" => 1e-9,
        "\u{c5}" | "\u{212b}" => 1e-10,
        "A" if lone_a == LoneA::Angstrom => 1e-10,
        "pm" => 1e-12,
        "fm" => 1e-15,
        "in" => 0.0254,
        "mil" => 25.4e-6,
        _ => match label.to_ascii_lowercase().as_str() {
            "meter" | "meters" | "metre" | "metres" => 1.0,
            "millimeter" | "millimeters" | "millimetre" | "millimetres" => 1e-3,
            "micrometer" | "micrometers" | "micrometre" | "micrometres" | "micro_meter" | "micron"
            | "microns" => 1e-6,
            "nanometer" | "nanometers" | "nanometre" | "nanometres" => 1e-9,
            "angstrom" | "angstroms" | "\u{e5}ngstr\u{f6}m" => 1e-10,
            "inch" | "inches" => 0.0254,
            _ => return None,
        },
    })
}

/// The first line of a header that names a unit of length, which may be one of the numbers below: single letters are none.
pub(super) fn line_with_length(metadata: &[(String, String)]) -> Option<String> {
    let is_length =
        |word: &str| word.chars().count() > 1 && word != "in" && metres(word, LoneA::Ampere).is_some();
    let lines = metadata
        .iter()
        .map(|(key, value)| if key.is_empty() { value.clone() } else { format!("{key}: {value}") });
    let mut named = lines.filter(|line| line.split(|c: char| !c.is_alphanumeric()).any(is_length));
    named.next().map(|line| line.chars().take(60).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_the_micrometre_is_the_micrometre() {
        for label in ["um", "\u{b5}m", "\u{3bc}m", "\u{e6}m", "~m", " um\0\0", "Micrometers", "micron"] {
            assert_eq!(metres(label, LoneA::Ampere), Some(1e-6), "{label:?}");
        }
    }

    #[test]
    fn an_ampere_is_no_length() {
        assert_eq!(metres("A", LoneA::Ampere), None);
        assert_eq!(metres("A", LoneA::Angstrom), Some(1e-10));
        for label in ["", "V", "rad", "Mm", "MM", "s"] {
            assert_eq!(metres(label, LoneA::Angstrom), None, "{label:?}");
        }
    }
}
