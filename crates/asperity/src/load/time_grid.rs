//! The times of the steps of a run or of one of its stages.

use crate::error::{Error, Result, positive, require};

/// The times after t = 0 to which a run steps.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeGrid {
    /// `steps` equal steps to `end`.
    Uniform {
        /// Last time \[s\].
        end: f64,
        /// Number of steps.
        steps: usize,
    },
    /// `steps` times in geometric progression from `first` to `end`.
    Logarithmic {
        /// Last time \[s\].
        end: f64,
        /// Number of steps.
        steps: usize,
        /// First time \[s\].
        first: f64,
    },
    /// The times themselves, increasing.
    List(Vec<f64>),
    /// Steps as long as the tolerance of their local error allows (see docs/theory.md, section 5), to `end`.
    Adaptive {
        /// Last time \[s\].
        end: f64,
        /// Largest error of the stress, relative (see [`crate::step::Row::time_error`]).
        tolerance: f64,
        /// Largest first step after t = 0 and after each kink or jump \[s\]; the step is shorter if the material or the history
        /// requires it.
        first: f64,
    },
}

/// The shortest step of an adaptive grid is this fraction of its end.
pub(crate) const SHORTEST: f64 = 1e-15;

impl TimeGrid {
    /// Checks counts and order.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the wrong quantity.
    pub fn validate(&self) -> Result<()> {
        let steps_in_range = |steps: usize| {
            require((1..=10_000_000).contains(&steps), "number of steps", steps, "between 1 and 10000000")
                .map_err(|error| error.of("steps"))
        };
        let first_in_range = |first: f64, end: f64| {
            positive("first step", first, "s")?;
            require(first <= end, "first step", format!("{first} s"), format!("at most {end} s"))
        };
        match self {
            TimeGrid::Uniform { end, steps } => {
                positive("end of the run", *end, "s")?;
                steps_in_range(*steps)
            }
            TimeGrid::Logarithmic { end, steps, first } => {
                positive("end of the run", *end, "s")?;
                first_in_range(*first, *end)?;
                steps_in_range(*steps)
            }
            TimeGrid::Adaptive { end, tolerance, first } => {
                positive("end of the run", *end, "s")?;
                first_in_range(*first, *end)?;
                if *first < SHORTEST * end {
                    let least = format!("at least {:e} s, {SHORTEST:e} of the end", SHORTEST * end);
                    return Err(Error::invalid("first step", format!("{first:e} s"), least).of("first"));
                }
                require(
                    (1e-9..=0.1).contains(tolerance),
                    "tolerance of the steps",
                    tolerance,
                    "between 1e-9 and 0.1",
                )
                .map_err(|error| error.of("tolerance"))
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

    /// Last time \[s\].
    pub fn end(&self) -> f64 {
        match self {
            TimeGrid::Uniform { end, .. }
            | TimeGrid::Logarithmic { end, .. }
            | TimeGrid::Adaptive { end, .. } => *end,
            TimeGrid::List(times) => times.last().copied().unwrap_or(0.0),
        }
    }

    /// Whether the steps are chosen during the run.
    pub fn is_adaptive(&self) -> bool {
        matches!(self, TimeGrid::Adaptive { .. })
    }

    /// The times of the grid, in order; for an adaptive grid, the end.
    pub fn times(&self) -> Vec<f64> {
        match self {
            TimeGrid::Uniform { end, steps } => {
                (1..=*steps).map(|k| end * (k as f64 / *steps as f64)).collect()
            }
            TimeGrid::Logarithmic { end, steps: 1, .. } | TimeGrid::Adaptive { end, .. } => vec![*end],
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_logarithmic_grid_has_its_ends_exactly() {
        let times = TimeGrid::Logarithmic { end: 500.0, steps: 7, first: 5e-4 }.times();
        assert_eq!((times[0], times[6]), (5e-4, 500.0));
        // a decade each
        assert!(times.windows(2).all(|t| (t[1] / t[0] - 10.0).abs() < 1e-12));
    }

    #[test]
    fn an_adaptive_grid_is_checked() {
        let grid = |tolerance, first| TimeGrid::Adaptive { end: 1.0, tolerance, first }.validate();
        assert!(grid(1e-3, 1e-6).is_ok());
        assert!(grid(1e-3, 2.0).is_err());
        assert!(grid(1e-3, 1e-17).is_err());
        assert!(grid(f64::NAN, 1e-6).is_err());
        assert!(grid(0.5, 1e-6).unwrap_err().to_string().contains("between 1e-9 and 0.1"));
    }
}
