//! Texts on paper: in lines that fit, shortened, and with powers of ten.

use asperity_io::readable::superscript;

use super::font;

/// A text of a size in lines of this width \[points\]; a word that is longer than a line is broken.
pub(super) fn lines(text: &str, size: f64, room: f64) -> Vec<String> {
    let fits = |text: &str| font::width(text, size) <= room;
    let mut lines: Vec<String> = vec![];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if fits(&format!("{line} {word}")) => *line += &format!(" {word}"),
            _ if fits(word) => lines.push(word.to_owned()),
            _ => {
                let mut line = String::new();
                for c in word.chars() {
                    if !line.is_empty() && !fits(&format!("{line}{c}")) {
                        lines.push(std::mem::take(&mut line));
                    }
                    line.push(c);
                }
                lines.push(line);
            }
        }
    }
    lines
}

/// A text of a size, cut short where it is wider than this \[points\].
pub(super) fn shortened(text: &str, size: f64, room: f64) -> String {
    if font::width(text, size) <= room {
        return text.to_owned();
    }
    let mut kept: String = text.to_owned();
    while !kept.is_empty() && font::width(&format!("{kept}…"), size) > room {
        kept.pop();
    }
    kept + "…"
}

/// A text with its numbers as they are printed: "4.9e-10 N" as "4.9×10⁻¹⁰ N".
pub(crate) fn typeset(text: &str) -> String {
    text.split(' ').map(number).collect::<Vec<_>>().join(" ")
}

/// A number with a power of ten as it is printed; any other word as it is.
fn number(word: &str) -> String {
    let parts = || {
        let (digits, power) = word.split_once('e')?;
        digits.parse::<f64>().ok()?;
        Some(format!("{}×10{}", digits.replace('-', "−"), superscript(power.parse().ok()?)))
    };
    parts().unwrap_or_else(|| word.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_hold_every_letter_and_fit() {
        let text = "contact of a rough sphere with a plane, loaded twice and held".repeat(4);
        let found = lines(&text, 9.0, 120.0);
        assert!(found.len() > 5 && found.iter().all(|line| font::width(line, 9.0) <= 120.0), "{found:?}");
        assert_eq!(found.join(" "), text);
        let long = "接触".repeat(100);
        let found = lines(&long, 9.0, 120.0);
        assert!(found.iter().all(|line| font::width(line, 9.0) <= 120.0));
        assert_eq!(found.concat(), long);
        assert!(lines("", 9.0, 120.0).is_empty());
    }

    #[test]
    fn a_text_that_is_too_wide_ends_in_dots() {
        assert_eq!(shortened("short", 8.0, 100.0), "short");
        let cut = shortened("mean over the contact", 8.0, 60.0);
        assert!(cut.ends_with('…') && cut.starts_with("mean") && font::width(&cut, 8.0) <= 60.0, "{cut}");
    }

    #[test]
    fn numbers_are_printed_with_powers_of_ten() {
        assert_eq!(typeset("load 4.862e-10 nN, 3.000e8 s"), "load 4.862×10⁻¹⁰ nN, 3.000×10⁸ s");
        assert_eq!(typeset("rate -1.0e0 m³/s of the seal, NaN"), "rate −1.0×10⁰ m³/s of the seal, NaN");
    }
}
