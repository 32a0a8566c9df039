//! The errors, with the numbers that a user needs to correct the input.

use thiserror::Error;

/// The error of every fallible call of this crate.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// An argument is outside its domain.
    #[error("{what} is {value}, but must be {expected}")]
    Invalid {
        /// Path of the argument among those of the call, in the names of case files ("longest", "histogram.bins",
        /// "body\[0\].layer\[1\]"); empty if it concerns the whole.
        parameter: String,
        /// The quantity, in terms of the field ("Poisson's ratio", "radius").
        what: String,
        /// The value as given.
        value: String,
        /// The accepted values, with unit.
        expected: String,
    },
    /// The contact cannot carry the load: W > H A (no solution exists).
    #[error(
        "the load {} N exceeds {} N, the hardness times the area that can touch; \
         lower the load, raise the hardness or enlarge the domain",
        four(*load), four(*max)
    )]
    Infeasible {
        /// Path of the argument that prescribes the load, as for [`Error::Invalid`]; empty where only the load is known.
        parameter: String,
        /// Prescribed load \[N\].
        load: f64,
        /// Largest load that the hardness allows \[N\].
        max: f64,
    },
    /// A periodic body is pressed into full contact under approach control: the approach does not determine the mean pressure.
    #[error(
        "the approach {} m closes the whole periodic gap (largest with a determined load: \
         {} m); use load control for full contact",
        four(*approach), four(*max)
    )]
    Undetermined {
        /// Prescribed approach \[m\].
        approach: f64,
        /// The approach at which the mean gap closes \[m\].
        max: f64,
    },
    /// The solver stopped before it reached its tolerance; the caller keeps the state reached.
    #[error(transparent)]
    NotConverged(#[from] NotConverged),
    /// The event that ends a stage did not occur; the rows so far are complete.
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
    /// The run was interrupted on request; the rows so far are complete.
    #[error("interrupted")]
    Interrupted,
}

/// State of a solve that did not reach its tolerance.
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
    /// Required tolerance.
    pub tolerance: f64,
    /// Certified relative energy-norm error of the state reached.
    pub certificate: f64,
    /// Time of the step \[s\], if the solve belongs to a run over time.
    pub time: Option<f64>,
    /// Velocity of a steady state of motion \[m/s\].
    pub velocity: Option<f64>,
}

/// Result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// The error that `what` is `value`, but must be `expected`.
    pub fn invalid(
        what: impl Into<String>,
        value: impl std::fmt::Display,
        expected: impl Into<String>,
    ) -> Self {
        let (what, value, expected) = (what.into(), short(&value.to_string()), short(&expected.into()));
        Error::Invalid { parameter: String::new(), what, value, expected }
    }

    /// The same error, for the argument `outer` or one inside it.
    #[must_use]
    pub fn of(self, outer: &str) -> Self {
        let mut error = self;
        if let Error::Invalid { parameter, .. } | Error::Infeasible { parameter, .. } = &mut error {
            let dot = if parameter.is_empty() { "" } else { "." };
            *parameter = format!("{outer}{dot}{parameter}");
        }
        error
    }

    /// Path of the argument that is wrong, as far as it is known: see [`Error::Invalid`].
    pub fn parameter(&self) -> &str {
        match self {
            Error::Invalid { parameter, .. } | Error::Infeasible { parameter, .. } => parameter,
            _ => "",
        }
    }

    /// A word for the kind of error, which stays the same when the message changes: "out-of-range", "infeasible", ...
    pub fn code(&self) -> &'static str {
        match self {
            Error::Invalid { .. } => "out-of-range",
            Error::Infeasible { .. } => "infeasible",
            Error::Undetermined { .. } => "undetermined",
            Error::NotConverged(_) => "not-converged",
            Error::Missed { .. } => "missed-event",
            Error::Interrupted => "interrupted",
        }
    }
}

/// The error that `what` is `value`, but must be `expected`, unless `holds` is true.
pub(crate) fn require(
    holds: bool,
    what: impl Into<String>,
    value: impl std::fmt::Display,
    expected: impl Into<String>,
) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::invalid(what, value, expected)) }
}

/// `Ok(value)` if it is finite and > 0.
pub(crate) fn positive(what: &str, value: f64, unit: &str) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Error::invalid(what, value, format!("finite and greater than 0 {unit}").trim_end()))
    }
}

/// `Ok(value)` for a valid length of a body: products of four such lengths do not overflow or underflow.
pub(crate) fn length(what: &str, value: f64) -> Result<f64> {
    const LENGTHS: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
    match LENGTHS.contains(&value) {
        true => Ok(value),
        false => Err(Error::invalid(what, value, "greater than 0 m: from 1e-60 m to 1e60 m")),
    }
}

/// `Ok(value)` if it is finite and >= 0.
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

/// The text with numbers of very many digits written with a power of ten.
fn short(text: &str) -> String {
    const LONGEST: usize = 24;
    let word = |word: &str| match word.parse::<f64>() {
        Ok(number) if word.len() > LONGEST && number.is_finite() => format!("{number:e}"),
        _ => word.to_owned(),
    };
    if text.len() <= LONGEST {
        text.to_owned()
    } else {
        text.split(' ').map(word).collect::<Vec<_>>().join(" ")
    }
}

/// A number to four digits, as short as it can be written.
pub(crate) fn rounded(x: f64) -> String {
    format!("{x:.3e}").parse::<f64>().map_or_else(|_| x.to_string(), |x| x.to_string())
}

/// A number with four digits: "5", "0.025", "1.234e-7".
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
