//! Decimal numbers as text, so that scaling by a power of ten is exact.
//!
//! 0.3 times 1e-3 is not the double nearest to 0.0003; the text "0.3e-3" is.

/// Mantissa and power of ten.
pub struct Decimal<'t> {
    mantissa: &'t str,
    exponent: i64,
}

impl<'t> Decimal<'t> {
    /// The longest number at the start of `text`, and the rest.
    pub fn split(text: &'t str) -> Option<(Self, &'t str)> {
        let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
        let sign = text.len() - unsigned.len();
        if let Some(rest) = unsigned.strip_prefix("inf") {
            let rest = rest.strip_prefix("inity").unwrap_or(rest);
            return Some((Decimal { mantissa: &text[..sign + 3], exponent: 0 }, rest));
        }
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let whole = digits(unsigned);
        let fraction = unsigned[whole..].strip_prefix('.').map(digits);
        if whole + fraction.unwrap_or(0) == 0 {
            return None;
        }
        let length = whole + fraction.map_or(0, |count| 1 + count);
        let mantissa = &text[..sign + length];
        let mut rest = &unsigned[length..];
        let mut exponent = 0;
        // An `e` is an exponent only where digits follow it.
        if let Some(after) = rest.strip_prefix(['e', 'E']) {
            let signed = after.strip_prefix(['+', '-']).unwrap_or(after);
            let count = digits(signed);
            if count > 0 {
                let sign = after.len() - signed.len();
                let text = &after[..sign + count];
                // Beyond this the value is 0 or too large, whatever the mantissa.
                let beyond = if text.starts_with('-') { -1_000_000_000 } else { 1_000_000_000 };
                exponent = text.parse().unwrap_or(beyond).clamp(-1_000_000_000, 1_000_000_000);
                rest = &signed[count..];
            }
        }
        Some((Decimal { mantissa, exponent }, rest))
    }

    pub fn infinite(&self) -> bool {
        self.mantissa.ends_with("inf")
    }

    /// The nearest double to the number times 10^shift.
    pub fn scaled(&self, shift: i32) -> f64 {
        let text = match self.infinite() {
            true => self.mantissa.to_owned(),
            false => format!("{}e{}", self.mantissa, self.exponent + i64::from(shift)),
        };
        text.parse().unwrap_or(f64::NAN) // `new` refuses NaN; `split` leaves only what parses
    }
}
