//! When the state is computed: the time grid, joined with the breaks and jumps of the history.

use crate::error::{Error, Result, positive};
use crate::load::History;

/// The instants after t = 0 that a march steps to.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeGrid {
    /// `steps` equal steps to `end`.
    Uniform {
        /// Last instant \[s\].
        end: f64,
        /// Number of steps.
        steps: usize,
    },
    /// `steps` instants in geometric progression from `first` to `end`.
    Logarithmic {
        /// Last instant \[s\].
        end: f64,
        /// Number of steps.
        steps: usize,
        /// First instant \[s\].
        first: f64,
    },
    /// The instants themselves, increasing.
    List(Vec<f64>),
}

/// One row of the result: a step in time, or a jump in none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// t \[s\].
    pub time: f64,
    /// Length of the step that leads here \[s\]; 0 at t = 0+ and for a jump.
    pub dt: f64,
    /// The prescribed value.
    pub value: f64,
    /// True at t = 0+ and where the history jumps.
    pub jump: bool,
}

/// Share of the last time below which two instants are one.
const SAME: f64 = 1e-12;

impl TimeGrid {
    /// Checks counts and order.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming what is wrong.
    pub fn validate(&self) -> Result<()> {
        let steps_in_range = |steps: usize| {
            if (1..=10_000_000).contains(&steps) {
                Ok(())
            } else {
                Err(Error::invalid("number of steps", steps, "between 1 and 10 000 000"))
            }
        };
        match self {
            TimeGrid::Uniform { end, steps } => {
                positive("end of the run", *end, "s")?;
                steps_in_range(*steps)
            }
            TimeGrid::Logarithmic { end, steps, first } => {
                positive("end of the run", *end, "s")?;
                positive("first step", *first, "s")?;
                if first > end {
                    return Err(Error::invalid(
                        "first step",
                        format!("{first} s"),
                        format!("at most {end} s"),
                    ));
                }
                steps_in_range(*steps)
            }
            TimeGrid::List(times) => {
                steps_in_range(times.len())?;
                let mut last = 0.0;
                for (n, t) in times.iter().enumerate() {
                    if !(t.is_finite() && *t > last) {
                        return Err(Error::invalid(
                            format!("time {}", n + 1),
                            format!("{t} s"),
                            format!("later than the one before it ({last} s)"),
                        ));
                    }
                    last = *t;
                }
                Ok(())
            }
        }
    }

    /// Last instant \[s\].
    pub fn end(&self) -> f64 {
        match self {
            TimeGrid::Uniform { end, .. } | TimeGrid::Logarithmic { end, .. } => *end,
            TimeGrid::List(times) => times.last().copied().unwrap_or(0.0),
        }
    }

    /// The grid's own instants, in order.
    pub fn times(&self) -> Vec<f64> {
        match self {
            TimeGrid::Uniform { end, steps } => {
                (1..=*steps).map(|k| end * (k as f64 / *steps as f64)).collect()
            }
            TimeGrid::Logarithmic { end, steps: 1, .. } => vec![*end],
            TimeGrid::Logarithmic { end, steps, first } => {
                let ratio = libm::log(end / first);
                let last = *steps - 1;
                (0..*steps)
                    .map(|k| match k {
                        0 => *first,
                        k if k == last => *end,
                        k => first * libm::exp(ratio * (k as f64 / last as f64)),
                    })
                    .collect()
            }
            TimeGrid::List(times) => times.clone(),
        }
    }

    /// All rows of a run: t = 0+, then every instant of the grid, every break of the history and every
    /// time of `include`; a jump adds a row of zero length after the row that leads to it.
    pub fn instants(&self, history: &History, include: &[f64]) -> Vec<Instant> {
        let end = self.end();
        let breaks = history.breaks(end * (1.0 + SAME));
        let mut times = breaks.clone();
        times.extend(include.iter().copied().filter(|t| *t > 0.0 && *t <= end));
        times.extend(self.times());
        // Stable: where a grid time falls on a break, the break comes first and is kept.
        times.sort_by(f64::total_cmp);
        let mut merged: Vec<f64> = Vec::with_capacity(times.len());
        for t in times {
            match merged.last_mut() {
                Some(last) if t - *last <= SAME * end => {
                    if breaks.contains(&t) {
                        *last = t;
                    }
                }
                _ => merged.push(t),
            }
        }
        let mut instants = vec![Instant { time: 0.0, dt: 0.0, value: history.after(0.0), jump: true }];
        let mut last = 0.0;
        for t in merged {
            let (before, after) = (history.before(t), history.after(t));
            instants.push(Instant { time: t, dt: t - last, value: before, jump: false });
            if (after - before).abs() > 1e-12 * after.abs().max(before.abs()) && t < end {
                instants.push(Instant { time: t, dt: 0.0, value: after, jump: true });
            }
            last = t;
        }
        instants
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn breaks_and_jumps_are_rows() {
        let history = History::Table { points: vec![(0.0, 1.0), (2.5, 1.0), (2.5, 3.0), (4.0, 0.0)] };
        let rows = TimeGrid::Uniform { end: 5.0, steps: 5 }.instants(&history, &[0.5]);
        let shown: Vec<_> = rows.iter().map(|r| (r.time, r.value, r.jump)).collect();
        assert_eq!(
            shown,
            [
                (0.0, 1.0, true),
                (0.5, 1.0, false),
                (1.0, 1.0, false),
                (2.0, 1.0, false),
                (2.5, 1.0, false),
                (2.5, 3.0, true),
                (3.0, 2.0, false),
                (4.0, 0.0, false),
                (5.0, 0.0, false),
            ]
        );
    }

    #[test]
    fn a_break_on_the_grid_is_one_row() {
        let history = History::Triangle { peak: 1.0, rise: 0.3, fall: 0.7 };
        let rows = TimeGrid::Uniform { end: 1.0, steps: 10 }.instants(&history, &[]);
        assert_eq!(rows.len(), 11);
        assert_eq!(rows[3].time, 0.3);
        assert_eq!(rows[10].value, 0.0);
    }

    #[test]
    fn a_logarithmic_grid_has_its_ends_exactly() {
        let times = TimeGrid::Logarithmic { end: 500.0, steps: 7, first: 5e-4 }.times();
        assert_eq!((times[0], times[6]), (5e-4, 500.0));
        // a decade each
        assert!(times.windows(2).all(|t| (t[1] / t[0] - 10.0).abs() < 1e-12));
    }
}
