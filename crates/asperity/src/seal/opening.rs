//! The inlet pressure at which a seal opens: where the largest contact pressure less the inlet pressure falls to the sealing pressure,
//!
//! ```text
//! max p0(x; P) - P = p_s
//! ```

use super::{Conductance, Profile};
use crate::numbers::bisect;

/// When a seal opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opens {
    /// It is tight up to the first pressure \[Pa\], and leaks at the second one; between them the sweep does not tell.
    Between(f64, f64),
    /// It leaks at every inlet pressure that the profile is known for.
    Always,
    /// It is tight at every inlet pressure that the profile is known for.
    Never,
    /// No pressure of the sweep is tight, and the seal is pressed more than all of them: not known.
    Unknown,
}

/// Steps between the inlet pressures of two tables, in which the seal may open and close again.
const STEPS: usize = 64;

/// When a seal with this profile opens, while the inlet pressure rises from that of the outlet.
pub fn opening(sigma: &Conductance, profile: &Profile, outlet: f64) -> Opens {
    let start = profile.inlets().map_or(outlet, |[least, _]| least.max(outlet));
    let Some(pressed) = profile.pressed(start) else { return Opens::Unknown };
    let Some(tight) = sigma.sealing_pressure() else {
        return if pressed <= sigma.ends()[1] * (1.0 + 1e-9) { Opens::Always } else { Opens::Unknown };
    };
    let leaking = sigma.last_leaking();
    if leaking.is_some_and(|leaking| pressed <= leaking) {
        return Opens::Always;
    }
    let leaks = falls(profile, start, leaking.unwrap_or(0.0)).unwrap_or(f64::INFINITY);
    match falls(profile, start, tight) {
        _ if pressed < tight => Opens::Between(outlet, leaks),
        Some(opens) => Opens::Between(opens, leaks),
        None => Opens::Never,
    }
}

/// The first inlet pressure from `start` on at which the seal is pressed with `level` at most; `None` where it is pressed more at every one.
fn falls(profile: &Profile, start: f64, level: f64) -> Option<f64> {
    let excess = |inlet: f64| profile.pressed(inlet).map(|pressed| pressed - level);
    if excess(start)? <= 0.0 {
        return Some(start);
    }
    let Some(inlets) = profile.inlets_of_tables() else {
        let share = 1.0 - profile.energising;
        return (share > 0.0).then(|| excess(start).map(|missing| start + missing / share)).flatten();
    };
    let between = |pair: &[f64]| {
        let [from, to] = [pair[0].max(start), pair[1].max(start)];
        (1..=STEPS).map(move |n| from + (to - from) * n as f64 / STEPS as f64)
    };
    let mut low = start;
    for inlet in inlets.windows(2).flat_map(between) {
        if excess(inlet)? <= 0.0 {
            let [opens, _] =
                bisect([low, inlet], 60, |inlet| excess(inlet).is_some_and(|excess| excess > 0.0));
            return Some(opens);
        }
        low = inlet;
    }
    None
}
