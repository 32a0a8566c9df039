//! The prescribed quantity over time: a load, a mean pressure or an approach.
//!
//! A history is piecewise smooth. At a jump it has two values, `before(t)` and `after(t)`; in time stepping a jump is a step of
//! zero length. Every history is zero before t = 0.

mod programme;
mod time_grid;

pub(crate) use programme::of_stage;
pub use programme::{Course, Event, Programme, Stage};
pub(crate) use time_grid::SHORTEST;
pub use time_grid::TimeGrid;

use crate::error::{Error, Result, non_negative, positive, times_with_jumps};

/// The prescribed quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Control {
    /// Normal load W, in N.
    Load,
    /// Mean pressure over the domain, W / (Lx Ly), in Pa.
    Pressure,
    /// Rigid-body approach w, in m, 0 at first touch.
    Approach,
}

/// The extrema of a history with more than this number are not listed individually.
const MOST_EXTREMES: usize = 100_000;

/// A value over time, from t = 0 on.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum History {
    /// `value` from t = 0+ on.
    Step {
        /// Value held.
        value: f64,
    },
    /// Linear from 0 to `value` during `duration`, then held.
    Ramp {
        /// Value reached.
        value: f64,
        /// Time to reach it \[s\].
        duration: f64,
    },
    /// Linear from 0 to `peak` during `rise`, back to 0 during `fall`, then 0.
    Triangle {
        /// Largest value.
        peak: f64,
        /// Time up \[s\].
        rise: f64,
        /// Time down \[s\].
        fall: f64,
    },
    /// As the triangle, with `hold` at the peak.
    Trapezoid {
        /// Largest value.
        peak: f64,
        /// Time up \[s\].
        rise: f64,
        /// Time at the peak \[s\].
        hold: f64,
        /// Time down \[s\].
        fall: f64,
    },
    /// mean + amplitude sin(2 pi frequency t).
    Sine {
        /// Mean value.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Frequency \[Hz\].
        frequency: f64,
    },
    /// Linear between (time \[s\], value) points; two points at one time are a jump; held after the last.
    Table {
        /// Points in order of time, the first at t = 0.
        points: Vec<(f64, f64)>,
    },
}

/// A control and its history, for a whole run: the [`Programme`] of one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Loading {
    /// The prescribed quantity of the run.
    pub control: Control,
    /// Its value over time.
    pub history: History,
}

impl History {
    /// Checks that values and durations are finite and in order.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity.
    pub fn validate(&self) -> Result<()> {
        let finite = |what: &str, value: f64| {
            if value.is_finite() { Ok(()) } else { Err(Error::invalid(what, value, "finite")) }
        };
        match self {
            History::Step { value } => finite("value of the step", *value),
            History::Ramp { value, duration } => {
                positive("duration of the ramp", *duration, "s")?;
                finite("value of the ramp", *value)
            }
            History::Triangle { peak, rise, fall } => {
                positive("rise of the triangle", *rise, "s")?;
                positive("fall of the triangle", *fall, "s")?;
                finite("peak of the triangle", *peak)
            }
            History::Trapezoid { peak, rise, hold, fall } => {
                positive("rise of the trapezoid", *rise, "s")?;
                non_negative("hold of the trapezoid", *hold, "s")?;
                positive("fall of the trapezoid", *fall, "s")?;
                finite("peak of the trapezoid", *peak)
            }
            History::Sine { mean, amplitude, frequency } => {
                positive("frequency of the sine", *frequency, "Hz")?;
                finite("mean of the sine", *mean)?;
                finite("amplitude of the sine", *amplitude)
            }
            History::Table { points } => validate_table(points),
        }
    }

    /// Value just before t (the limit from the left); 0 at t = 0.
    pub fn before(&self, t: f64) -> f64 {
        if t <= 0.0 { 0.0 } else { self.limit(t, Side::Before) }
    }

    /// Value just after t (the limit from the right).
    pub fn after(&self, t: f64) -> f64 {
        if t < 0.0 { 0.0 } else { self.limit(t, Side::After) }
    }

    /// Times in (0, end) at which the history has a kink or a jump, in order.
    pub fn breaks(&self, end: f64) -> Vec<f64> {
        let mut times = match self {
            History::Step { .. } | History::Sine { .. } => vec![],
            History::Ramp { duration, .. } => vec![*duration],
            History::Triangle { rise, fall, .. } => vec![*rise, rise + fall],
            History::Trapezoid { rise, hold, fall, .. } => {
                vec![*rise, rise + hold, rise + hold + fall]
            }
            History::Table { points } => points.iter().map(|p| p.0).collect(),
        };
        times.retain(|t| *t > 0.0 && *t < end);
        times.dedup();
        times
    }

    /// Times in (0, end) at which the history has an extremum that is not a kink or jump, in order.
    pub(crate) fn extremes(&self, end: f64) -> Vec<f64> {
        let History::Sine { frequency, .. } = self else { return vec![] };
        let quarters = (0..).map(|n| (0.25 + 0.5 * f64::from(n)) / frequency);
        quarters.take_while(|t| *t < end).take(MOST_EXTREMES).collect()
    }

    /// Smallest and largest value over \[0, end\]; of a sine over a whole period.
    pub fn range(&self, end: f64) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut include = |v: f64| range = [range[0].min(v), range[1].max(v)];
        include(self.after(0.0));
        for t in self.breaks(end).into_iter().chain([end]) {
            include(self.before(t));
            include(self.after(t));
        }
        if let History::Sine { mean, amplitude, .. } = self {
            include(mean - amplitude.abs());
            include(mean + amplitude.abs());
        }
        range
    }

    /// The first time in \[0, end\] at which the value is the largest.
    pub fn time_of_largest(&self, end: f64) -> f64 {
        let value = |t: f64| self.before(t).max(self.after(t));
        let inside = self.breaks(end).into_iter().chain(self.extremes(end));
        let mut times: Vec<f64> = std::iter::once(0.0).chain(inside).chain([end]).collect();
        times.sort_by(f64::total_cmp);
        times
            .into_iter()
            .reduce(|best, t| if value(t) > value(best) + 1e-9 * value(best).abs() { t } else { best })
            .unwrap_or(end)
    }

    /// The argument that sets the largest value, in the words of case files: "peak", "points\[2\]\[1\]".
    pub(crate) fn largest_value(&self) -> String {
        match self {
            History::Step { .. } | History::Ramp { .. } => "value".to_owned(),
            History::Triangle { .. } | History::Trapezoid { .. } => "peak".to_owned(),
            History::Sine { .. } => "mean".to_owned(),
            History::Table { points } => {
                let values = points.iter().map(|point| point.1).enumerate();
                let largest = values.rev().max_by(|a, b| a.1.total_cmp(&b.1));
                format!("points[{}][1]", largest.map_or(0, |(n, _)| n))
            }
        }
    }

    fn limit(&self, t: f64, side: Side) -> f64 {
        match self {
            History::Step { value } => *value,
            History::Ramp { value, duration } => value * (t / duration).min(1.0),
            History::Triangle { peak, rise, fall } => trapezoid(t, *peak, *rise, 0.0, *fall),
            History::Trapezoid { peak, rise, hold, fall } => trapezoid(t, *peak, *rise, *hold, *fall),
            History::Sine { mean, amplitude, frequency } => {
                mean + amplitude * libm::sin(std::f64::consts::TAU * frequency * t)
            }
            History::Table { points } => interpolate(points, t, side),
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Before,
    After,
}

fn trapezoid(t: f64, peak: f64, rise: f64, hold: f64, fall: f64) -> f64 {
    if t >= rise + hold + fall {
        // Exact for any rounding of the times.
        0.0
    } else if t < rise {
        peak * t / rise
    } else if t <= rise + hold {
        peak
    } else {
        (peak * (1.0 - (t - rise - hold) / fall)).max(0.0f64.min(peak))
    }
}

fn interpolate(points: &[(f64, f64)], t: f64, side: Side) -> f64 {
    // The first point after t; at a jump, `Before` stops at the first point of the pair.
    let next = match side {
        Side::After => points.partition_point(|p| p.0 <= t),
        Side::Before => points.partition_point(|p| p.0 < t),
    };
    match next {
        0 => points[0].1,
        n if n == points.len() => points[n - 1].1,
        n => {
            let ((t0, v0), (t1, v1)) = (points[n - 1], points[n]);
            if t == t1 {
                return v1;
            }
            // Rounding must not exceed either end: a load that falls to 0 is not negative before.
            (v0 + (v1 - v0) * (t - t0) / (t1 - t0)).clamp(v0.min(v1), v0.max(v1))
        }
    }
}

fn validate_table(points: &[(f64, f64)]) -> Result<()> {
    if let Some(n) = points.iter().position(|(t, v)| !t.is_finite() || !v.is_finite()) {
        let (name, point) = (format!("point {} of the history's table", n + 1), format!("{:?}", points[n]));
        return Err(Error::invalid(name, point, "finite"));
    }
    times_with_jumps("the history's table", &points.iter().map(|point| point.0).collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_value_is_found_at_its_first_time() {
        // sin is largest after a quarter of a period, -sin after three quarters.
        let sine = |amplitude| History::Sine { mean: 2.0, amplitude, frequency: 0.05 };
        assert_eq!(sine(1.5).time_of_largest(100.0), 5.0);
        assert_eq!(sine(-1.5).time_of_largest(100.0), 15.0);
        assert_eq!(sine(1.5).time_of_largest(3.0), 3.0);
        assert_eq!(History::Step { value: 1.0 }.time_of_largest(1.0), 0.0);
        let history = History::Trapezoid { peak: 1.0, rise: 2.0, hold: 3.0, fall: 4.0 };
        assert_eq!(history.time_of_largest(9.0), 2.0);
        let falling = History::Table { points: vec![(0.0, 3.0), (2.0, 1.0)] };
        assert_eq!(falling.time_of_largest(2.0), 0.0);
    }

    #[test]
    fn a_history_that_ends_at_nothing_ends_there_exactly() {
        for n in 1..500 {
            let [rise, hold, fall] = [0.2, 0.3, 0.2].map(|t| t * (1.0 + 1e-3 * f64::from(n)));
            let history = History::Trapezoid { peak: 1.0, rise, hold, fall };
            let end = history.breaks(10.0)[2];
            assert_eq!((history.before(end), history.after(end)), (0.0, 0.0));
            let history = History::Triangle { peak: 1.0, rise, fall };
            assert_eq!(history.before(history.breaks(10.0)[1]), 0.0);
        }
    }

    #[test]
    fn a_sine_turns_every_half_period() {
        let sine = History::Sine { mean: 1.0, amplitude: -0.5, frequency: 2.0 };
        assert_eq!(sine.extremes(1.0), [0.125, 0.375, 0.625, 0.875]);
        assert!(History::Step { value: 1.0 }.extremes(1.0).is_empty());
    }

    #[test]
    fn a_table_meets_its_points_to_the_last_bit_and_stays_between_them() {
        for k in 1..2000 {
            let start = 0.2 * (1.0 + f64::from(k) * f64::EPSILON);
            let end = 0.4 + 1e-4 * f64::from(k);
            let history = History::Table { points: vec![(0.0, start), (end, 0.0), (2.0, 0.7)] };
            assert_eq!(history.before(end), 0.0);
            let just_before = history.before(end * (1.0 - f64::EPSILON));
            assert!((0.0..1e-15).contains(&just_before), "{just_before:e}");
            assert_eq!(history.before(2.0), 0.7);
        }
    }
}
