//! Time stepping of a row of springs through a load or approach history.

use super::{Mdr, MdrProfile, MdrState, MdrTarget};
use crate::error::{Error, Result, increasing, positive, require};
use crate::load::{Control, Loading};
use crate::material::Relaxation;

/// The resolution of the row of springs and of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MdrOptions {
    /// Springs between the axis and the largest expected contact radius. Default 1000.
    pub springs: usize,
    /// Steps between two requested times. Default 20. After a kink or jump of the history the steps grow quadratically.
    pub substeps: usize,
}

impl Default for MdrOptions {
    fn default() -> Self {
        MdrOptions { springs: 1000, substeps: 20 }
    }
}

/// Fraction of the last time, or of the value, below which two times or values are equal.
const SAME: f64 = 1e-12;

impl Mdr {
    /// Rows at t = 0+, at every requested time, and at every kink or jump of the history before the last time. A jump gives two
    /// rows, before and after it.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the loading is invalid, controls the mean pressure (a single contact has no area to average over),
    /// requires a negative load, or the times are not increasing and positive; as [`step`](Self::step) otherwise.
    pub fn march(
        profile: MdrProfile,
        relaxation: &Relaxation,
        loading: &Loading,
        times: &[f64],
        options: MdrOptions,
    ) -> Result<Vec<MdrState>> {
        loading.history.validate()?;
        let end = check_times(times)?;
        let reach = Self::estimate(profile, relaxation, loading, end)?;
        let mut row = Mdr::new(profile, relaxation, reach, options.springs)?;
        let history = &loading.history;
        let target = |value: f64| match loading.control {
            Control::Approach => MdrTarget::Approach(value),
            Control::Load | Control::Pressure => MdrTarget::Load(value),
        };
        let breaks = history.breaks(end);
        // Times that equal a kink or jump except for rounding are set to it.
        let is_break = |t: f64| breaks.iter().any(|b| (t - b).abs() <= SAME * end);
        let mut stops: Vec<f64> = times.iter().copied().filter(|t| !is_break(*t)).collect();
        stops.extend(&breaks);
        stops.sort_by(f64::total_cmp);
        let mut states = vec![row.step(0.0, target(history.after(0.0)))?];
        let mut start = 0.0;
        for stop in stops {
            // Rates are unbounded just after a kink or jump, so the steps grow.
            let graded = start == 0.0 || breaks.contains(&start);
            let substeps = options.substeps.max(1);
            for n in 1..=substeps {
                let share = n as f64 / substeps as f64;
                let next = start + (stop - start) * if graded { share * share } else { share };
                let value = if n == substeps { history.before(stop) } else { history.after(next) };
                let state = row.step_to(if n == substeps { stop } else { next }, target(value))?;
                if n == substeps {
                    states.push(state);
                }
            }
            let (before, after) = (history.before(stop), history.after(stop));
            if stop < end && (after - before).abs() > SAME * before.abs().max(after.abs()) {
                states.push(row.step(0.0, target(after))?);
            }
            start = stop;
        }
        Ok(states)
    }

    /// An upper bound of the contact radius: the largest load held from the start, or the largest
    /// approach.
    fn estimate(profile: MdrProfile, relaxation: &Relaxation, loading: &Loading, end: f64) -> Result<f64> {
        profile.validate()?;
        relaxation.validate()?;
        let [lowest, highest] = loading.history.range(end);
        let reach = match loading.control {
            Control::Pressure => {
                return Err(Error::invalid("control", "the mean pressure", "the load or the approach"));
            }
            Control::Approach => profile.reach(highest.max(0.0)),
            Control::Load => {
                require(lowest >= 0.0, "smallest load of the history", format!("{lowest} N"), "0 N or more")?;
                profile.elastic_radius(highest, relaxation.to_creep()?.value(end))
            }
        };
        // There is never contact: any length is possible.
        Ok(if reach > 0.0 { 1.01 * reach } else { 1.0 })
    }
}

fn check_times(times: &[f64]) -> Result<f64> {
    let name = |n: usize| format!("time {} of the list", n + 1);
    for (n, t) in times.iter().enumerate() {
        positive(&name(n), *t, "s")?;
    }
    increasing(times.iter().copied(), name, |t| format!("{t} s"))?;
    times.last().copied().ok_or_else(|| Error::invalid("list of times", "empty", "one time at least"))
}
