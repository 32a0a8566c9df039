//! First yield: the load at which the von Mises stress below the surface reaches the yield stress.

use asperity::finding::depths_between;
use serde_json::{Value, json};

use super::Below;
use crate::readable::quantity;
use crate::store::StressSet;

/// Where the body begins to yield, as far as the times tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstYield {
    /// At none of the times.
    Never {
        /// The yield stress is this many times the largest von Mises stress.
        safety: f64,
        /// How many times were computed.
        times: usize,
        /// Time \[s\] and load \[N\] of the largest pressure, where it is not among them.
        missed: Option<[f64; 2]>,
        /// Depths \[m\] between which the stress may be larger: [`Below::unseen`].
        unseen: Option<[f64; 2]>,
    },
    /// At the first of the times already, or before it: (time \[s\], load \[N\]).
    AtOnce([f64; 2]),
    /// Between two of the times: (time \[s\], load \[N\]) of both.
    Between([[f64; 2]; 2]),
}

/// First yield of what was found; `None` where no yield stress is given, or no time.
pub fn first_yield(below: &Below) -> Option<FirstYield> {
    let limit = below.set.yield_stress?;
    let mises: Vec<f64> = below.instants.iter().map(|instant| below.number(instant, "max_mises")).collect();
    let state = |n: usize| [below.instants[n].time, below.instants[n].load];
    Some(match mises.iter().position(|mises| *mises >= limit) {
        Some(0) => FirstYield::AtOnce(state(0)),
        Some(n) => FirstYield::Between([state(n - 1), state(n)]),
        None => FirstYield::Never {
            times: mises.len(),
            safety: limit / mises.into_iter().reduce(f64::max)?,
            missed: below.missed,
            unseen: below.unseen(),
        },
    })
}

impl FirstYield {
    /// One sentence, about what was found.
    pub fn sentence(&self, below: &Below) -> String {
        let unit = if below.set.line { "N/m" } else { "N" };
        let (axis, what) = (below.axis, below.axis.plural());
        let state = |[at, load]: [f64; 2]| {
            format!("{} = {} (load {})", axis.symbol(), quantity(at, axis.unit()), quantity(load, unit))
        };
        match self {
            FirstYield::Never { safety, times, missed, unseen } => {
                let at = match times {
                    1 => format!("at the one computed {}", axis.name()),
                    times => format!("at the {times} computed {what}"),
                };
                let mut sentence = if safety.is_finite() && *safety < 1e6 {
                    let found = match unseen {
                        Some(_) => "yield is not excluded",
                        None => "no yield",
                    };
                    format!(
                        "{found} {at}: the yield stress is {safety:.3} times the largest von Mises stress"
                    )
                } else {
                    format!("no yield {at}: there is no contact, or next to no stress")
                };
                if let Some(unseen) = unseen {
                    sentence +=
                        &format!(" at the computed depths, but it may be larger {}", depths_between(*unseen));
                }
                if let Some(missed) = missed {
                    sentence +=
                        &format!("; the largest pressure, at {}, is not among the {what}", state(*missed));
                }
                sentence
            }
            FirstYield::AtOnce(first) => format!("first yield at or before {}", state(*first)),
            FirstYield::Between([before, after]) => {
                format!("first yield between {} and {}", state(*before), state(*after))
            }
        }
    }

    /// As an object: `safety`, with the depths between which the stress was not seen (null: no end), or `times` and `loads`, the two states that first yield lies between (one: at or before it).
    pub fn to_json(self, set: &StressSet) -> Value {
        match self {
            FirstYield::Never { safety, missed, unseen, .. } => {
                let deepest = unseen.filter(|[_, below]| below.is_infinite()).and_then(|_| set.depths.last());
                json!({ "yields": false, "safety": safety, "missed": missed, "deepest": deepest, "unseen": unseen })
            }
            FirstYield::AtOnce([time, load]) => json!({ "yields": true, "times": [time], "loads": [load] }),
            FirstYield::Between([[t0, w0], [t1, w1]]) => {
                json!({ "yields": true, "times": [t0, t1], "loads": [w0, w1] })
            }
        }
    }
}
