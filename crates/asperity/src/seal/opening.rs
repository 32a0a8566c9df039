//! The inlet pressure at which a seal opens: where the largest contact pressure less the inlet pressure falls to the sealing pressure,
//!
//! ```text
//! max p0(x; P) - P = p_s
//! ```

use super::{Conductance, Profile};

/// When a seal opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opens {
    /// It is tight below the first pressure \[Pa\], and leaks above the second one; between them the sweep does not tell.
    Between(f64, f64),
    /// It leaks at every inlet pressure.
    Always,
    /// It is tight at every inlet pressure, or at all that the profile is known for.
    Never,
    /// No pressure of the sweep is tight, and the seal is pressed more than all of them: not known.
    Unknown,
}

/// When a seal with this profile opens.
pub fn opening(sigma: &Conductance, profile: &Profile) -> Opens {
    let most = profile.inlets().map_or(0.0, |[least, _]| least);
    let Some(largest) = profile.largest(most.max(0.0)) else { return Opens::Unknown };
    let Some(tight) = sigma.sealing_pressure() else {
        return if largest <= sigma.ends()[1] * (1.0 + 1e-9) { Opens::Always } else { Opens::Unknown };
    };
    let (Some(low), high) = (at(profile, tight), sigma.last_leaking()) else { return Opens::Never };
    let high = match high {
        Some(leaking) => at(profile, leaking),
        None => at(profile, 0.0),
    };
    match (low, high.unwrap_or(f64::INFINITY)) {
        (_, high) if high <= 0.0 => Opens::Always,
        (low, high) => Opens::Between(low.max(0.0), high),
    }
}

/// The inlet pressure at which the seal is pressed with `pressed`; `None` where it is pressed more at every one.
fn at(profile: &Profile, pressed: f64) -> Option<f64> {
    let Some([from, to]) = profile.inlets() else {
        let missing = profile.largest(0.0)? - pressed;
        return match profile.energising {
            _ if missing <= 0.0 => Some(0.0),
            share if share < 1.0 => Some(missing / (1.0 - share)),
            _ => None,
        };
    };
    let excess = |inlet: f64| profile.largest(inlet).map(|largest| largest - inlet - pressed);
    let [mut low, mut high] = [from, to];
    if excess(low)? <= 0.0 {
        return Some(low);
    }
    if excess(high)? > 0.0 {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle)? > 0.0 { low = middle } else { high = middle }
    }
    Some(low)
}
