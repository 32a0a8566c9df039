//! What can go wrong, with the numbers that a user needs to mend it.

use thiserror::Error;

/// The error of every fallible call of this crate.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// An argument is outside its domain.
    #[error("{what} is {value}, but must be {expected}")]
    Invalid {
        /// The quantity, in the field's words ("Poisson's ratio", "radius").
        what: String,
        /// The value as given.
        value: String,
        /// What is accepted, with unit.
        expected: String,
    },
    /// The load cannot be carried: W > H A (no solution exists).
    #[error(
        "the load {} N exceeds {} N, the hardness times the area that can touch; \
         lower the load, raise the hardness or enlarge the domain",
        four(*load), four(*max)
    )]
    Infeasible {
        /// Load asked for \[N\].
        load: f64,
        /// Largest load that the hardness allows \[N\].
        max: f64,
    },
    /// A periodic body pressed into full contact under approach control: the mean pressure is
    /// not determined by the approach.
    #[error(
        "the approach {} m closes the whole periodic gap (largest with a determined load: \
         {} m); use load control for full contact",
        four(*approach), four(*max)
    )]
    Undetermined {
        /// Approach asked for \[m\].
        approach: f64,
        /// The approach at which the mean gap closes \[m\].
        max: f64,
    },
    /// The solver stopped before it met its tolerance; the state that it reached is kept by the caller.
    #[error(transparent)]
    NotConverged(#[from] NotConverged),
    /// A stage waited for an event that did not come; the rows so far are complete.
    #[error(
        "stage {stage} waits for {event}, but the run ends at t = {end} s without it (approach {approach:e} m, load \
         {load:e} N); end the run later, change the event, or give the stage a duration"
    )]
    Missed {
        /// Number of the stage, from 1.
        stage: usize,
        /// The event in words.
        event: String,
        /// End of the run \[s\].
        end: f64,
        /// Approach at the end \[m\].
        approach: f64,
        /// Load at the end \[N\].
        load: f64,
    },
    /// Somebody asked to stop; the rows so far are complete.
    #[error("interrupted")]
    Interrupted,
}

/// Where a solve stopped that did not meet its tolerance.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{method} stopped after {iterations} iterations at residual {residual:.2e} (tolerance {tolerance:.1e}, \
     certified energy-norm error {certificate:.1e}){}; loosen the tolerance or allow more iterations",
    match (.time, .velocity) {
        (Some(t), _) => format!(" at t = {t} s"),
        (None, Some(v)) => format!(" at {v} m/s"),
        (None, None) => String::new(),
    }
)]
pub struct NotConverged {
    /// Solver name.
    pub method: &'static str,
    /// Iterations done.
    pub iterations: usize,
    /// KKT residual of the state reached (see `contact`).
    pub residual: f64,
    /// Tolerance asked for.
    pub tolerance: f64,
    /// Certified relative energy-norm error of the state reached.
    pub certificate: f64,
    /// Time of the step, where the solve belongs to a march \[s\].
    pub time: Option<f64>,
    /// Velocity of a steady state of motion \[m/s\].
    pub velocity: Option<f64>,
}

/// Result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// `what` is `value`, but must be `expected`.
    pub fn invalid(
        what: impl Into<String>,
        value: impl std::fmt::Display,
        expected: impl Into<String>,
    ) -> Self {
        Error::Invalid { what: what.into(), value: value.to_string(), expected: expected.into() }
    }
}

/// The error of a `what` that is `value`, but must be `expected`, unless that `holds`.
pub(crate) fn require(
    holds: bool,
    what: impl Into<String>,
    value: impl std::fmt::Display,
    expected: impl Into<String>,
) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::invalid(what, value, expected)) }
}

/// `Ok(value)` where it is finite and > 0.
pub(crate) fn positive(what: &str, value: f64, unit: &str) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Error::invalid(what, value, format!("finite and greater than 0 {unit}").trim_end()))
    }
}

/// `Ok(value)` for a length that bodies may have: products of four of them do not overflow or vanish.
pub(crate) fn length(what: &str, value: f64) -> Result<f64> {
    const LENGTHS: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
    match LENGTHS.contains(&value) {
        true => Ok(value),
        false => Err(Error::invalid(what, value, "greater than 0 m: from 1e-60 m to 1e60 m")),
    }
}

/// `Ok(value)` where it is finite and >= 0.
pub(crate) fn non_negative(what: &str, value: f64, unit: &str) -> Result<f64> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(Error::invalid(what, value, format!("finite and not less than 0 {unit}").trim_end()))
    }
}

/// A temperature \[K\] to a hundredth: "293.15 K".
pub(crate) fn kelvin(temperature: f64) -> String {
    format!("{} K", (100.0 * temperature).round() / 100.0)
}

/// A number to four digits, as short as it can be written.
pub(crate) fn rounded(x: f64) -> String {
    format!("{x:.3e}").parse::<f64>().map_or_else(|_| x.to_string(), |x| x.to_string())
}

/// A number in four digits: "5", "0.025", "1.234e-7".
fn four(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e5).contains(&size) {
        let digits = if size == 0.0 { 0.0 } else { (3.0 - size.log10().floor()).clamp(0.0, 6.0) };
        let text = format!("{value:.*}", digits as usize);
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    let text = format!("{value:.3e}");
    match text.split_once('e') {
        Some((digits, power)) if digits.contains('.') => {
            format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text,
    }
}
