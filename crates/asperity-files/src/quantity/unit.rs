//! Unit expressions: `mm`, `N/mm^2`, `1/(Pa s)`, `kHz`, `MPa^-1`.
//!
//! A unit is 10^exponent * numerator / denominator times powers of metre, kilogram, second, kelvin
//! and mole. The
//! power of ten is kept apart, so that a decimal text is scaled by moving its exponent: "0.3 mm" is the
//! very number that `0.3e-3` is, to the last bit.

use std::iter::Peekable;
use std::str::Chars;

/// Powers of metre, kilogram, second, kelvin and mole.
pub type Powers = [i32; 5];

/// The scale to SI and the dimension of a unit expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Power of ten of the scale.
    pub exponent: i32,
    /// What of the scale is no power of ten (60 for the minute), above the fraction line.
    pub numerator: f64,
    /// The same below the fraction line.
    pub denominator: f64,
    /// Powers of metre, kilogram, second, kelvin and mole.
    pub powers: Powers,
}

/// A year of 365.25 days \[s\].
const YEAR: f64 = 31_557_600.0;

/// Symbols that take SI prefixes: name, power of ten, powers of metre, kilogram, second, kelvin, mole.
const PREFIXED: &[(&str, i32, Powers)] = &[
    ("m", 0, [1, 0, 0, 0, 0]),
    ("l", -3, [3, 0, 0, 0, 0]),
    ("g", -3, [0, 1, 0, 0, 0]),
    ("s", 0, [0, 0, 1, 0, 0]),
    ("Hz", 0, [0, 0, -1, 0, 0]),
    ("N", 0, [1, 1, -2, 0, 0]),
    ("Pa", 0, [-1, 1, -2, 0, 0]),
    ("bar", 5, [-1, 1, -2, 0, 0]),
    ("J", 0, [2, 1, -2, 0, 0]),
    ("W", 0, [2, 1, -3, 0, 0]),
    ("K", 0, [0, 0, 0, 1, 0]),
    ("mol", 0, [0, 0, 0, 0, 1]),
];

/// Symbols that stand alone: name, factor, power of ten, powers.
const PLAIN: &[(&str, f64, i32, Powers)] = &[
    ("min", 60.0, 0, [0, 0, 1, 0, 0]),
    ("h", 3600.0, 0, [0, 0, 1, 0, 0]),
    ("d", 86400.0, 0, [0, 0, 1, 0, 0]),
    ("day", 86400.0, 0, [0, 0, 1, 0, 0]),
    ("days", 86400.0, 0, [0, 0, 1, 0, 0]),
    ("a", YEAR, 0, [0, 0, 1, 0, 0]),
    ("year", YEAR, 0, [0, 0, 1, 0, 0]),
    ("years", YEAR, 0, [0, 0, 1, 0, 0]),
    // A cubic centimetre per minute of a gas at 0 °C and one atmosphere, as pressure times volume.
    ("sccm", 1.688_75, -3, [2, 1, -3, 0, 0]),
    ("psi", 6.894_757_293_168_361, 3, [-1, 1, -2, 0, 0]),
    ("ksi", 6.894_757_293_168_361, 6, [-1, 1, -2, 0, 0]),
    ("dyn", 1.0, -5, [1, 1, -2, 0, 0]),
    ("Å", 1.0, -10, [1, 0, 0, 0, 0]),
    ("cal", 4.184, 0, [2, 1, -2, 0, 0]),
    ("kcal", 4.184, 3, [2, 1, -2, 0, 0]),
    ("%", 1.0, -2, [0, 0, 0, 0, 0]),
    ("1", 1.0, 0, [0, 0, 0, 0, 0]),
];

const PREFIXES: &[(&str, i32)] = &[
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6), // micro sign
    ("μ", -6), // Greek mu
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("da", 1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// No exponent of a unit is larger; keeps the powers far from overflow.
const LARGEST_EXPONENT: i32 = 9;
/// Factors in one expression, brackets included.
const MOST_FACTORS: usize = 16;

impl Unit {
    const ONE: Unit = Unit { exponent: 0, numerator: 1.0, denominator: 1.0, powers: [0; 5] };

    /// The unit that `text` writes; empty text is 1.
    ///
    /// # Errors
    /// A sentence that names the part that was not understood.
    pub fn parse(text: &str) -> Result<Unit, String> {
        let text = text.trim();
        if text.is_empty() {
            return Ok(Unit::ONE);
        }
        let mut parser = Parser { characters: text.chars().peekable(), factors: 0 };
        let unit = parser.product()?;
        match parser.characters.peek() {
            None => Ok(unit),
            Some(c) => Err(format!("\"{text}\" is not a unit: \"{c}\" is out of place")),
        }
    }

    /// How many SI units it is.
    pub fn scale(&self) -> f64 {
        self.numerator / self.denominator * 10f64.powi(self.exponent)
    }

    fn symbol(name: &str) -> Result<Unit, String> {
        if let Some((_, factor, exponent, powers)) = PLAIN.iter().find(|plain| plain.0 == name) {
            return Ok(Unit { exponent: *exponent, numerator: *factor, denominator: 1.0, powers: *powers });
        }
        for (base, exponent, powers) in PREFIXED {
            let Some(prefix) = name.strip_suffix(base) else { continue };
            let shift = match PREFIXES.iter().find(|known| known.0 == prefix) {
                Some((_, shift)) => *shift,
                None if prefix.is_empty() => 0,
                None => continue,
            };
            return Ok(Unit { exponent: exponent + shift, powers: *powers, ..Unit::ONE });
        }
        Err(format!("\"{name}\" is not a known unit"))
    }

    fn times(self, other: Unit) -> Unit {
        Unit {
            exponent: self.exponent.saturating_add(other.exponent),
            numerator: self.numerator * other.numerator,
            denominator: self.denominator * other.denominator,
            powers: std::array::from_fn(|n| self.powers[n].saturating_add(other.powers[n])),
        }
    }

    fn power(self, n: i32) -> Unit {
        let (above, below) = match n >= 0 {
            true => (self.numerator, self.denominator),
            false => (self.denominator, self.numerator),
        };
        Unit {
            exponent: self.exponent.saturating_mul(n),
            numerator: above.powi(n.abs()),
            denominator: below.powi(n.abs()),
            powers: self.powers.map(|p| p.saturating_mul(n)),
        }
    }
}

struct Parser<'t> {
    characters: Peekable<Chars<'t>>,
    factors: usize,
}

impl Parser<'_> {
    /// factor { (* | / | blank) factor }, also with a leading `/`: "2 /MPa".
    fn product(&mut self) -> Result<Unit, String> {
        let mut unit = Unit::ONE;
        let mut first = true;
        loop {
            self.blanks();
            let next = self.characters.peek().copied().filter(|next| *next != ')');
            let Some(next) = next else { break };
            if next == '/' || (!first && matches!(next, '*' | '·' | '.')) {
                self.characters.next();
                self.blanks();
            }
            unit = unit.times(self.factor()?.power(if next == '/' { -1 } else { 1 }));
            first = false;
        }
        match first {
            false => Ok(unit),
            true => Err("a unit is missing".into()),
        }
    }

    /// symbol [exponent], or a product in brackets.
    fn factor(&mut self) -> Result<Unit, String> {
        self.factors += 1;
        if self.factors > MOST_FACTORS {
            return Err(format!("the unit has more than {MOST_FACTORS} factors"));
        }
        let unit = if self.characters.next_if_eq(&'(').is_some() {
            let unit = self.product()?;
            if self.characters.next_if_eq(&')').is_none() {
                return Err("a closing bracket is missing".into());
            }
            unit
        } else if self.characters.next_if_eq(&'1').is_some() {
            // A number such as 1000 belongs before the unit.
            if let Some(c) =
                self.characters.peek().filter(|c| c.is_ascii_digit() || matches!(c, '.' | ',' | 'e' | 'E'))
            {
                return Err(format!("\"{c}\" is out of place in the unit: a unit holds no number but 1"));
            }
            Unit::ONE
        } else {
            let mut name = String::new();
            while let Some(c) = self.characters.next_if(|c| c.is_alphabetic() || matches!(c, '%' | 'µ')) {
                name.push(c);
            }
            if name.is_empty() {
                return Err(match self.characters.peek() {
                    Some(c) => format!("\"{c}\" is out of place in the unit"),
                    None => "the unit ends too early".into(),
                });
            }
            Unit::symbol(&name)?
        };
        Ok(unit.power(self.exponent()?))
    }

    /// `^2`, `^-1`, `-1`, `2`, `²`, `⁻¹`; 1 where nothing is written.
    fn exponent(&mut self) -> Result<i32, String> {
        let hat = self.characters.next_if_eq(&'^').is_some();
        let mut text = String::new();
        while let Some(c) = self.characters.peek().copied() {
            let plain = match c {
                '⁻' => '-',
                '¹' => '1',
                '²' => '2',
                '³' => '3',
                '⁴'..='⁹' => char::from(b'4' + (c as u32 - '⁴' as u32) as u8),
                '-' | '0'..='9' => c,
                _ => break,
            };
            text.push(plain);
            self.characters.next();
        }
        if text.is_empty() && !hat {
            return Ok(1);
        }
        match text.parse::<i32>() {
            Ok(n) if n.abs() <= LARGEST_EXPONENT => Ok(n),
            _ => Err(format!(
                "\"{text}\" is no exponent of a unit (a whole number from -{LARGEST_EXPONENT} to {LARGEST_EXPONENT})"
            )),
        }
    }

    fn blanks(&mut self) {
        while self.characters.next_if(|c| c.is_whitespace()).is_some() {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(text: &str) -> (f64, Powers) {
        let unit = Unit::parse(text).unwrap();
        (unit.scale(), unit.powers)
    }

    #[test]
    fn symbols_take_the_usual_prefixes() {
        assert_eq!(scale("m"), (1.0, [1, 0, 0, 0, 0]));
        assert_eq!(scale("mm"), (1e-3, [1, 0, 0, 0, 0]));
        assert_eq!(scale("um"), scale("µm"));
        assert_eq!(scale("µm"), scale("μm"));
        assert_eq!(scale("ms"), (1e-3, [0, 0, 1, 0, 0]));
        assert_eq!(scale("min"), (60.0, [0, 0, 1, 0, 0]));
        assert_eq!(scale("MPa"), (1e6, [-1, 1, -2, 0, 0]));
        assert_eq!(scale("mPa"), (1e-3, [-1, 1, -2, 0, 0]));
        assert_eq!(scale("kg"), (1.0, [0, 1, 0, 0, 0]));
        assert_eq!(scale("mbar"), scale("hPa"));
        assert_eq!(scale("kJ/mol"), (1e3, [2, 1, -2, 0, -1]));
        assert_eq!(scale("kcal/mol"), (4184.0, [2, 1, -2, 0, -1]));
        assert_eq!(scale("mK"), (1e-3, [0, 0, 0, 1, 0]));
        assert_eq!(scale("ml"), (1e-6, [3, 0, 0, 0, 0]));
        assert_eq!(scale("year"), (365.25 * 86400.0, [0, 0, 1, 0, 0]));
        // 1 cm³ of 101 325 Pa in 60 s.
        assert!((scale("sccm").0 / (101_325.0 * 1e-6 / 60.0) - 1.0).abs() < 1e-15);
        assert_eq!(scale("sccm").1, scale("mbar l/s").1);
        assert_eq!(scale("%"), (1e-2, [0, 0, 0, 0, 0]));
    }

    #[test]
    fn products_quotients_and_powers() {
        let mpa = scale("MPa");
        for text in ["N/mm^2", "N/mm2", "N mm^-2", "N·mm⁻²", "N*mm-2", "MN/m²", "kg/(mm s^2)*km/m"] {
            let (value, powers) = scale(text);
            assert!((value / mpa.0 - 1.0).abs() < 1e-15, "{text}: {value}");
            assert_eq!(powers, mpa.1, "{text}");
        }
        assert_eq!(scale("1/(Pa s)"), (1.0, [1, -1, 1, 0, 0]));
        assert_eq!(scale("1/MPa").1, [1, -1, 2, 0, 0]);
        assert_eq!(scale("/MPa"), scale("MPa^-1"));
        // left to right, as everywhere: (1/Pa) s
        assert_eq!(scale("1/Pa s").1, [1, -1, 3, 0, 0]);
        // A number is no part of a unit.
        for text in ["1000 Pa", "10*MPa", "1.5 Pa", "1e3 Pa", "m/10 s"] {
            assert!(Unit::parse(text).is_err(), "{text}");
        }
        assert_eq!(scale(""), (1.0, [0, 0, 0, 0, 0]));
    }

    #[test]
    fn what_is_no_unit_is_said() {
        for text in ["mpa", "parsec", "N//m", "1/", "(Pa s", "Pa)", "m^", "m^99", "m^x", "^2", "*m", "½"] {
            let reason = Unit::parse(text).unwrap_err();
            assert!(!reason.is_empty(), "{text}");
        }
        let deep = "(".repeat(100_000);
        assert!(Unit::parse(&deep).is_err());
        assert!(Unit::parse(&"m ".repeat(1000)).is_err());
        let high = format!("{}m{}", "(".repeat(14), "^9)".repeat(14)); // saturates
        assert_eq!(Unit::parse(&high).unwrap().powers[0], i32::MAX);
    }
}
