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
//! | `histogram` | histograms that end below the largest value |
//! | `strain` | deformations and slopes beyond linear theory |
//! | `material` | moduli, and the quality and coverage of fits of measured data |
//! | `stress` | the stress below the surface: its resolution, and yielding |
//! | `time` | steps that are too long for the history and the material |
//! | `energy` | the energy balance |
//! | `event` | stages that wait for a number without a value |
//! | `leak` | leaks that are unreliable because of gap, grid or fluid pressure |
//! | `tangential` | forces that friction does not hold, tangential tractions that act on the pressure |
//! | `wear` | steps in which much wears, tracks that stay under the contact |
//! | `flash` | materials that are taken colder than they become |
//! | `adhesion` | cells that snap one by one, attraction beyond the border |
//! | `motion` | friction that the grid does not resolve, bodies on their own track |
//! | `thin` | half-spaces of finite thickness |
//! | `plausible` | magnitudes that suggest a wrong unit: one table of all |
//! | `expected` | an estimate of the contact before the run |
//!
//! docs/findings.md lists all codes with their limits.

mod adhesion;
mod contact;
mod diagnostics;
mod domain;
mod energy;
mod event;
mod expected;
mod flash;
mod fluid;
mod histogram;
mod leak;
mod material;
mod motion;
mod plausible;
mod profile;
mod strain;
mod stress;
mod surface;
mod tangential;
mod thin;
mod time;
mod wear;
mod words;
mod worst;

use std::borrow::Cow;

pub use diagnostics::{Diagnostics, Known};
pub use domain::repeats;
pub use expected::{Contact, Expected};
pub use leak::{LeakDiagnostics, LeakState, window_in_leak};
pub use material::{
    at_reference, beyond_data, celsius_meant, contradiction, misfit, misfit_of_both, modulus_kind,
    points_left_out, reversal, shift_uncertain, too_few_points, unlikely_data, unlikely_modulus,
    unlikely_temperature,
};
pub use motion::{friction_zero, leak_in_motion, own_track};
pub use plausible::TEMPERATURES;
pub use profile::{gaps_of_profile, of_profile, unlike_profile};
pub use stress::{
    OF_STRESS, depths_between, stress_depths, stress_times_miss_peak, stress_unresolved, yield_exceeded,
};
pub use surface::{hurst, of_heights};
pub use thin::thin_body;
pub(crate) use words::si;

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
    /// The number that was checked, in SI units; docs/findings.md states which.
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

    /// The same finding, for these rows; `None` if it concerns the case.
    #[must_use]
    pub fn at(self, rows: impl Into<Option<[usize; 2]>>) -> Self {
        Finding { rows: rows.into(), ..self }
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

/// Declares the codes, each with its meaning, and the list of all of them.
macro_rules! codes {
    ($($(#[$meaning:meta])* $name:ident = $code:literal;)*) => {
        $($(#[$meaning])* pub const $name: &str = $code;)*

        /// All codes. The meaning of a code does not change.
        pub const CODES: &[&str] = &[$($name),*];
    };
}

codes! {
    /// Contact, or the expected contact, reaches the border of a free domain.
    CONTACT_AT_BORDER = "contact-at-border";
    /// The gap of a periodic domain is not continuous across its border.
    GAP_NOT_PERIODIC = "gap-not-periodic";
    /// A lay at an angle to the axes becomes a herringbone by the reflections of its surface.
    LAY_MIRRORED = "lay-mirrored";
    /// Only the end of the free domain confines the contact.
    ROUGH_ON_FREE_DOMAIN = "rough-on-free-domain";
    /// Waves shorter than four cells.
    SHORTEST_WAVE_UNRESOLVED = "shortest-wave-unresolved";
    /// Contact spots narrower than four cells.
    SPOTS_UNRESOLVED = "spots-unresolved";
    /// No row has contact.
    NO_CONTACT = "no-contact";
    /// A histogram ends below the largest value.
    BEYOND_HISTOGRAM = "beyond-histogram";
    /// A contact of only a few cells.
    FEW_CONTACT_CELLS = "few-contact-cells";
    /// Slopes beyond linear theory.
    LARGE_SLOPE = "large-slope";
    /// Deformations beyond linear theory.
    LARGE_STRAIN = "large-strain";
    /// The work of the load differs from the energy stored and dissipated.
    ENERGY_BALANCE = "energy-balance";
    /// A stage waits for a number that has no value.
    EVENT_WITHOUT_VALUE = "event-without-value";
    /// Too few steps while history and material change.
    STEPS_TOO_LONG = "steps-too-long";
    /// Too few steps per period.
    ALIASED_HISTORY = "aliased-history";
    /// The material does not fit the measured data.
    MATERIAL_MISFIT = "material-misfit";
    /// Measured values change in a direction in which those of a passive material do not.
    DATA_SCATTER = "data-scatter";
    /// Shift factors that were estimated are uncertain.
    SHIFT_UNCERTAIN = "shift-uncertain";
    /// A material that depends on temperature in a run without a temperature.
    AT_REFERENCE_TEMPERATURE = "at-reference-temperature";
    /// The header of a file names another modulus than the one that its numbers are taken as.
    MODULUS_KIND = "modulus-kind";
    /// The run needs the material at times that were not measured.
    BEYOND_MATERIAL_DATA = "beyond-material-data";
    /// Measured points without a number.
    POINTS_LEFT_OUT = "points-left-out";
    /// A fit with as many unknowns as measured numbers.
    TOO_FEW_POINTS = "too-few-points";
    /// A Hurst exponent outside of (0, 1].
    HURST_OUT_OF_RANGE = "hurst-out-of-range";
    /// A Hurst exponent that is determined by window, levelling or band.
    HURST_UNCERTAIN = "hurst-uncertain";
    /// Heights far from all others.
    OUTLIERS = "outliers";
    /// Parts of a profile were not measured.
    PROFILE_GAPS = "profile-gaps";
    /// A map made from a profile has another height or slope than the profile.
    UNLIKE_PROFILE = "unlike-profile";
    /// A number that suggests a wrong unit.
    UNLIKELY_UNIT = "unlikely-unit";
    /// The largest stress below the surface lies less than two cells deep.
    STRESS_UNRESOLVED = "stress-unresolved";
    /// The largest stress lies at the deepest of the given depths.
    STRESS_AT_DEEPEST = "stress-at-deepest";
    /// The depths around the largest stress are far apart.
    STRESS_DEPTHS_COARSE = "stress-depths-coarse";
    /// The largest pressure of a run is not among the times at which the stress is computed.
    STRESS_TIMES_MISS_PEAK = "stress-times-miss-peak";
    /// The von Mises stress below the surface exceeds the yield stress.
    YIELD_EXCEEDED = "yield-exceeded";
    /// The gap at the critical constriction of a leak is less than 30 times the error of the gap.
    LEAK_BELOW_GAP_ERROR = "leak-below-gap-error";
    /// Gaps of a leak that are below the error of the gap count as closed.
    GAPS_BELOW_ERROR = "gaps-below-error";
    /// The critical constriction of a leak is less than four cells wide.
    CONSTRICTION_UNRESOLVED = "constriction-unresolved";
    /// A leak through a surface that was windowed.
    WINDOW_IN_LEAK = "window-in-leak";
    /// A leak through a contact that moves.
    LEAK_IN_MOTION = "leak-in-motion";
    /// The pressure drop of a fluid that does not load the bodies is more than 0.02 of the mean pressure.
    FLUID_UNCOUPLED = "fluid-uncoupled";
    /// The fluid lifts a seal.
    SEAL_LIFTED = "seal-lifted";
    /// A seal is pressed less than a sweep of its patch begins, and that matters.
    SEAL_BELOW_SWEEP = "seal-below-sweep";
    /// A seal is pressed more than a sweep of its patch goes, which leaks to its end.
    SEAL_BEYOND_SWEEP = "seal-beyond-sweep";
    /// The pressures of a sweep leave the leak of a seal open.
    SEAL_SWEEP_COARSE = "seal-sweep-coarse";
    /// The pressures of a sweep leave the leak of a seal open at other inlet pressures than that of the case.
    SEAL_CURVE_COARSE = "seal-curve-coarse";
    /// The patch of a seal is tight at no pressure of the sweep.
    SEAL_NEVER_TIGHT = "seal-never-tight";
    /// A seal is not wide against its patch.
    SEAL_NARROW = "seal-narrow";
    /// The patch of a seal is not large against the longest wave.
    SEAL_PATCH_SMALL = "seal-patch-small";
    /// A half-space that is too thin for the contact or the waves.
    THIN_BODY = "thin-body";
    /// The friction force is uncertain.
    FRICTION_UNCERTAIN = "friction-uncertain";
    /// No viscoelastic body moves.
    FRICTION_ZERO = "friction-zero";
    /// A single body on a periodic domain runs over its own track.
    OWN_TRACK = "own-track";
    /// Cells that adhere or part one by one.
    ADHESION_UNRESOLVED = "adhesion-unresolved";
    /// Attraction at the border of a free domain.
    ADHESION_AT_BORDER = "adhesion-at-border";
    /// The fluid carries all of the load in a film.
    FLUID_LIFTS = "fluid-lifts";
    /// The inlet has a pressure at which no film holds the load.
    FLUID_MAY_RUN_AWAY = "fluid-may-run-away";
    /// Cells whose access to the fluid has no steady state.
    FLUID_CHATTER = "fluid-chatter";
    /// A sealed pocket has more room than its liquid fills.
    POCKET_TENSION = "pocket-tension";
    /// A prescribed approach fixes the mean gap of a periodic contact, whatever the fluid does.
    FLUID_APPROACH_HELD = "fluid-approach-held";
    /// The fluid acts on the cells of a free domain only.
    FLUID_ACTS_ON_DOMAIN = "fluid-acts-on-domain";
    /// The fluid flows out of the gap more slowly than the gap closes.
    SQUEEZE_SLOW = "squeeze-slow";
    /// A tangential force that friction will not hold.
    FORCE_BEYOND_FRICTION = "force-beyond-friction";
    /// Tangential tractions act on the pressure, which is neglected.
    NORMAL_COUPLING = "normal-coupling";
    /// Slip in a ring that is about one cell wide, or in none.
    SLIP_UNRESOLVED = "slip-unresolved";
    /// So much wears in a step that the place of the worn volume is uncertain.
    WEAR_STEPS = "wear-steps";
    /// A counterbody whose wear stays under a contact that slides far.
    WEAR_TRACK = "wear-track";
    /// More than a tenth of a layer is worn off.
    LAYER_WORN = "layer-worn";
    /// A contact that becomes much warmer than its material is taken.
    FLASH_WARM = "flash-warm";
    /// Steady states of which there are several at one velocity, because friction warms the material.
    FLASH_STATES = "flash-states";
    /// Flash temperatures of rows before which the motion was not steady.
    FLASH_STEADY = "flash-steady";
}

#[cfg(test)]
mod tests;
