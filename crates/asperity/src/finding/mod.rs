//! Findings: reports of a run where its numbers may be off.
//!
//! A solver converges on any input, even if its theory does not cover it, its grid does not resolve it, or a unit is wrong. The
//! checks of this module look for such cases: before a run in the gap, the bodies and the steps ([`Diagnostics::new`]), and
//! during it in each row ([`Diagnostics::see`]). A finding states the number, its limit and what to do. The checks change no
//! number and need no convolution.
//!
//! | file | checks |
//! |---|---|
//! | `domain` | the border of the domain: contact there, gaps that are not periodic, surfaces that do not end before it |
//! | `surface` | waves that the grid does not resolve, slopes, outliers, sizes that suggest a wrong unit |
//! | `contact` | contacts and contact spots of a few cells |
//! | `strain` | deformations and slopes beyond linear theory |
//! | `material` | moduli, and the quality and coverage of fits of measured data |
//! | `stress` | the stress below the surface: its resolution, and yielding |
//! | `time` | steps that are too long for the history and the material |
//! | `energy` | the energy balance |
//! | `leak` | leaks that are unreliable because of gap, grid or fluid pressure |
//! | `motion` | friction that the grid does not resolve, bodies on their own track |
//! | `thin` | half-spaces of finite thickness |
//! | `expected` | an estimate of the contact before the run |
//!
//! docs/findings.md lists all codes with their limits.

mod contact;
mod diagnostics;
mod domain;
mod energy;
mod expected;
mod leak;
mod material;
mod motion;
mod strain;
mod stress;
mod surface;
mod thin;
mod time;
mod words;

use std::borrow::Cow;

pub use diagnostics::{Diagnostics, Known};
pub use expected::{Contact, Expected};
pub use leak::{LeakDiagnostics, LeakState};
pub use material::{
    beyond_data, contradiction, misfit, points_left_out, unlikely_modulus, unlikely_temperature,
};
pub use motion::{friction_zero, own_track};
pub use stress::{stress_at_deepest, stress_times_miss_peak, stress_unresolved, yield_exceeded};
pub use surface::{hurst, of_heights};
pub use thin::thin_body;

/// The severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Severity {
    /// Useful information; the numbers are valid.
    Note,
    /// The numbers may be off.
    Warning,
}

impl Severity {
    /// "note" or "warning".
    pub fn as_str(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
        }
    }
}

impl std::fmt::Display for Severity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A report about a run that the user should know before relying on its numbers.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Finding {
    /// One of [`CODES`].
    pub code: Cow<'static, str>,
    /// Its severity.
    pub severity: Severity,
    /// One or two sentences: what was found, how it may affect the result, what to do about it.
    pub text: String,
    /// The number that was checked, in SI units; the table of docs/findings.md states which.
    pub value: Option<f64>,
    /// The limit that it exceeds, in the same unit.
    pub limit: Option<f64>,
    /// First and last row concerned; `None` if the finding concerns the case.
    pub rows: Option<[usize; 2]>,
}

impl Finding {
    /// A warning about a number beyond its limit.
    pub fn warning(code: &'static str, value: f64, limit: f64, text: impl Into<String>) -> Self {
        let number = |x: f64| x.is_finite().then_some(x);
        Finding {
            code: code.into(),
            severity: Severity::Warning,
            text: text.into(),
            value: number(value),
            limit: number(limit),
            rows: None,
        }
    }

    /// The same as a note.
    #[must_use]
    pub fn as_note(self) -> Self {
        Finding { severity: Severity::Note, ..self }
    }

    /// The same finding, for these rows.
    #[must_use]
    pub fn at(self, rows: [usize; 2]) -> Self {
        Finding { rows: Some(rows), ..self }
    }

    /// Whether it is a warning.
    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {} [{}]", self.severity, self.text, self.code)
    }
}

/// All codes. The meaning of a code does not change.
pub const CODES: [&str; 29] = [
    CONTACT_AT_BORDER,
    GAP_NOT_PERIODIC,
    ROUGH_ON_FREE_DOMAIN,
    SHORTEST_WAVE_UNRESOLVED,
    SPOTS_UNRESOLVED,
    FEW_CONTACT_CELLS,
    LARGE_SLOPE,
    LARGE_STRAIN,
    ENERGY_BALANCE,
    STEPS_TOO_LONG,
    ALIASED_HISTORY,
    MATERIAL_MISFIT,
    BEYOND_MATERIAL_DATA,
    POINTS_LEFT_OUT,
    HURST_OUT_OF_RANGE,
    HURST_UNCERTAIN,
    OUTLIERS,
    UNLIKELY_UNIT,
    STRESS_UNRESOLVED,
    STRESS_AT_DEEPEST,
    STRESS_TIMES_MISS_PEAK,
    YIELD_EXCEEDED,
    LEAK_BELOW_GAP_ERROR,
    CONSTRICTION_UNRESOLVED,
    FLUID_PRESSURE_LARGE,
    THIN_BODY,
    FRICTION_UNCERTAIN,
    FRICTION_ZERO,
    OWN_TRACK,
];

/// Contact, or the expected contact, reaches the border of a free domain.
pub const CONTACT_AT_BORDER: &str = "contact-at-border";
/// The gap of a periodic domain is not continuous across its border.
pub const GAP_NOT_PERIODIC: &str = "gap-not-periodic";
/// Only the end of the free domain confines the contact.
pub const ROUGH_ON_FREE_DOMAIN: &str = "rough-on-free-domain";
/// Waves shorter than four cells.
pub const SHORTEST_WAVE_UNRESOLVED: &str = "shortest-wave-unresolved";
/// Contact spots narrower than four cells.
pub const SPOTS_UNRESOLVED: &str = "spots-unresolved";
/// A contact of only a few cells.
pub const FEW_CONTACT_CELLS: &str = "few-contact-cells";
/// Slopes beyond linear theory.
pub const LARGE_SLOPE: &str = "large-slope";
/// Deformations beyond linear theory.
pub const LARGE_STRAIN: &str = "large-strain";
/// The work of the load differs from the energy stored and dissipated.
pub const ENERGY_BALANCE: &str = "energy-balance";
/// Too few steps while history and material change.
pub const STEPS_TOO_LONG: &str = "steps-too-long";
/// Too few steps per period.
pub const ALIASED_HISTORY: &str = "aliased-history";
/// The material does not fit the measured data.
pub const MATERIAL_MISFIT: &str = "material-misfit";
/// The run needs the material at times that were not measured.
pub const BEYOND_MATERIAL_DATA: &str = "beyond-material-data";
/// Measured points without a number.
pub const POINTS_LEFT_OUT: &str = "points-left-out";
/// A Hurst exponent outside of (0, 1].
pub const HURST_OUT_OF_RANGE: &str = "hurst-out-of-range";
/// A Hurst exponent that is determined by window, levelling or band.
pub const HURST_UNCERTAIN: &str = "hurst-uncertain";
/// Heights far from all others.
pub const OUTLIERS: &str = "outliers";
/// A number that suggests a wrong unit.
pub const UNLIKELY_UNIT: &str = "unlikely-unit";
/// The largest stress below the surface lies less than two cells deep.
pub const STRESS_UNRESOLVED: &str = "stress-unresolved";
/// The largest stress lies at the deepest of the given depths.
pub const STRESS_AT_DEEPEST: &str = "stress-at-deepest";
/// The largest pressure of a run is not among the times at which the stress is computed.
pub const STRESS_TIMES_MISS_PEAK: &str = "stress-times-miss-peak";
/// The von Mises stress below the surface exceeds the yield stress.
pub const YIELD_EXCEEDED: &str = "yield-exceeded";
/// A half-space that is too thin for the contact or the waves.
pub const THIN_BODY: &str = "thin-body";

/// Two estimates of the friction force differ.
pub const FRICTION_UNCERTAIN: &str = "friction-uncertain";
/// No viscoelastic body moves.
pub const FRICTION_ZERO: &str = "friction-zero";
/// A single body on a periodic domain runs over its own track.
pub const OWN_TRACK: &str = "own-track";

/// The gap at the critical constriction of a leak is less than 30 times the error of the gap.
pub const LEAK_BELOW_GAP_ERROR: &str = "leak-below-gap-error";
/// The critical constriction of a leak is less than four cells wide.
pub const CONSTRICTION_UNRESOLVED: &str = "constriction-unresolved";
/// The pressure drop of the fluid is more than a tenth of the mean pressure in the contact.
pub const FLUID_PRESSURE_LARGE: &str = "fluid-pressure-large";

#[cfg(test)]
mod tests;
