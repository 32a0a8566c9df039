//! The errors, with the numbers that a user needs to correct the input.

use crate::finding::si;
use thiserror::Error;

/// The method that finds pressure and friction in turn.
pub(crate) const COUPLING: &str = "coupling of pressure and friction";
/// That of the cells above a threshold of wear.
pub(crate) const WEAR_THRESHOLD: &str = "cells above the threshold of wear";

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
        significant(*load, 4), significant(*max, 4)
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
        significant(*approach, 4), significant(*max, 4)
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
         {load:e} N{}); end the run later, change the event, or give the stage a duration",
        number.map_or(String::new(), |(name, value)| match value.is_nan() {
            true => format!("; {name} has no value there"),
            false => format!("; {name} {value:e}"),
        })
    )]
    Missed {
        /// Number of the stage, from 1.
        stage: usize,
        /// The event in words.
        event: String,
        /// The number of the rows that it waits for, by its name, at the end; NaN where it has no value.
        number: Option<(&'static str, f64)>,
        /// End of the run \[s\].
        end: f64,
        /// Approach at the end \[m\].
        approach: f64,
        /// Load at the end \[N\].
        load: f64,
    },
    /// No equilibrium under the prescribed load: the surfaces that adhered are pulled off; the rows so far are complete.
    #[error(
        "no equilibrium at t = {time} s: under {} the surfaces come off{}; prescribe the approach to follow the contact through its \
         largest tension, or let a stage that begins under a weaker pull end with until = \"contact-lost\"",
        si(*load, unit),
        last.map_or(String::new(), |[load, approach]| {
            format!(" (last row: {} at an approach of {})", si(load, unit), si(approach, "m"))
        })
    )]
    PulledOff {
        /// Prescribed load \[N\], per length \[N/m\] on a line of cells.
        load: f64,
        /// The unit of loads.
        unit: &'static str,
        /// Time \[s\].
        time: f64,
        /// Load and approach \[m\] of the last row in contact; `None` where there is none.
        last: Option<[f64; 2]>,
    },
    /// No equilibrium under the prescribed load: the fluid in the gap lifts the surfaces off; the rows so far are complete.
    #[error(
        "no equilibrium at t = {time} s: the fluid carries {} more than the load of {} however wide the gap becomes, and lifts the \
         surfaces off; lower the pressure of the fluid (a film holds the load as long as the mean of the pressure from inlet to outlet is below the mean \
         pressure, of a liquid half of their sum), raise the load, let the load come before the pressure (`inlet` over time), or prescribe the approach",
        si(*excess, unit),
        si(*load, unit)
    )]
    LiftedOff {
        /// Prescribed load \[N\], per length \[N/m\] on a line of cells.
        load: f64,
        /// The unit of loads.
        unit: &'static str,
        /// What the fluid carries beyond it in the widest gap that was tried.
        excess: f64,
        /// Time \[s\].
        time: f64,
    },
    /// Friction does not hold the prescribed tangential force; the rows so far are complete.
    #[error(
        "gross sliding at t = {time} s: the tangential force {} is {} more than friction holds; lower it, raise the load or the friction \
         coefficient, or prescribe the displacement (tangential.control = \"displacement\")",
        si(*force, unit), si(*force - *max, unit)
    )]
    Sliding {
        /// Prescribed tangential force \[N\], per length \[N/m\] on a line of cells.
        force: f64,
        /// The largest one.
        max: f64,
        /// The unit of forces.
        unit: &'static str,
        /// Time \[s\].
        time: f64,
    },
    /// The run was interrupted on request; the rows so far are complete.
    #[error("interrupted")]
    Interrupted,
}

/// State of a solve that did not reach its tolerance.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{method} stopped after {iterations} iterations at residual {residual:.2e} (tolerance {tolerance:.1e}, \
     certified energy-norm error {certificate:.1e}){}; {advice}",
    match (.time, .velocity) {
        (Some(t), _) => format!(" at t = {t} s"),
        (None, Some(v)) => format!(" at {v} m/s"),
        (None, None) => String::new(),
    },
    advice = match *.method {
        COUPLING => "loosen the tolerance, lower the friction coefficient, or take friction.coupling = \"neglect\"",
        _ => "loosen the tolerance or allow more iterations",
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

impl NotConverged {
    /// A solve other than that of the contact, which has no certificate.
    pub(crate) fn of(method: &'static str, iterations: usize, residual: f64, tolerance: f64) -> Self {
        let certificate = f64::NAN;
        NotConverged { method, iterations, residual, tolerance, certificate, time: None, velocity: None }
    }
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

    /// The same error, of a solve at this time \[s\].
    pub(crate) fn at(self, now: f64) -> Self {
        let mut error = self;
        match &mut error {
            Error::NotConverged(report) => report.time = Some(now),
            Error::PulledOff { time, .. } | Error::LiftedOff { time, .. } => *time = now,
            _ => {}
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
            Error::PulledOff { .. } => "pulled-off",
            Error::LiftedOff { .. } => "fluid-runaway",
            Error::Sliding { .. } => "gross-sliding",
            Error::Interrupted => "interrupted",
        }
    }
}

/// Names the argument that an error concerns: see [`Error::of`].
pub(crate) trait Of {
    /// The same, with an error for the argument `outer` or one inside it.
    fn of(self, outer: &str) -> Self;
}

impl<T> Of for Result<T> {
    fn of(self, outer: &str) -> Self {
        self.map_err(|error| error.of(outer))
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

/// Checks that numbers increase. `name` names number n, counted from 0; `show` writes a number with its unit.
pub(crate) fn increasing(
    numbers: impl IntoIterator<Item = f64>,
    name: impl Fn(usize) -> String,
    show: impl Fn(f64) -> String,
) -> Result<()> {
    let mut last = f64::NEG_INFINITY;
    for (n, x) in numbers.into_iter().enumerate() {
        if x <= last {
            let expected = format!("greater than the one before it, {} (in order, none twice)", show(last));
            return Err(Error::invalid(name(n), show(x), expected));
        }
        last = x;
    }
    Ok(())
}

/// Checks the times \[s\] of a table in which two equal times are a jump: the first is 0, and they do not decrease.
pub(crate) fn times_with_jumps(table: &str, times: &[f64]) -> Result<()> {
    let name = |n: usize| format!("time of point {} of {table}", n + 1);
    let Some(first) = times.first() else { return Err(Error::invalid(table, "empty", "one point at least")) };
    require(*first == 0.0, format!("first time of {table}"), format!("{first} s"), "0 s")?;
    for (n, t) in times.iter().enumerate().skip(1) {
        if !t.is_finite() {
            return Err(Error::invalid(name(n), t, "finite"));
        }
        if *t < times[n - 1] {
            let expected = format!("not less than the time before it, {} s", times[n - 1]);
            return Err(Error::invalid(name(n), format!("{t} s"), expected));
        }
        if n > 1 && *t == times[n - 2] {
            let expected = "given at most twice (a jump has one value before and one after)";
            return Err(Error::invalid(name(n), format!("{t} s"), expected));
        }
    }
    Ok(())
}

/// `Ok(value)` if it is finite and > 0.
pub(crate) fn positive(what: &str, value: f64, unit: &str) -> Result<f64> {
    let expected = format!("finite and greater than 0 {unit}");
    require(value.is_finite() && value > 0.0, what, value, expected.trim_end()).map(|()| value)
}

/// `Ok(value)` for a valid length of a body: products of four such lengths do not overflow or underflow.
pub(crate) fn length(what: &str, value: f64) -> Result<f64> {
    const LENGTHS: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
    let expected = "greater than 0 m: from 1e-60 m to 1e60 m";
    require(LENGTHS.contains(&value), what, value, expected).map(|()| value)
}

/// `Ok(value)` if it is finite and >= 0.
pub(crate) fn non_negative(what: &str, value: f64, unit: &str) -> Result<f64> {
    let expected = format!("finite and not less than 0 {unit}");
    require(value.is_finite() && value >= 0.0, what, value, expected.trim_end()).map(|()| value)
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

/// A number with this many significant digits, without zeros at the end: "5", "0.025", "1.234e-7".
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    match rounded.abs() {
        1e-4..1e6 => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}
