//! How far the contact has moved: a path, or a velocity, over time.

use crate::error::{Error, Result, require};
use crate::load::History;
use crate::numbers::bisect;

/// Where the contact is over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Velocity \[m/s\], or position \[m\], over the time since `start`.
    history: History,
    of_velocity: bool,
    start: f64,
}

/// Cells that a run may travel.
const MOST: f64 = 1e7;
/// Quarters of a period of a sine that are looked at, at most.
const MOST_QUARTERS: i64 = 10_000_000;

impl Path {
    /// A velocity \[m/s\] over the time since `start` \[s\]; before it nothing moves.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the history or the start is.
    pub fn of_velocity(history: History, start: f64) -> Result<Self> {
        Path::new(history, true, start)
    }

    /// A position \[m\] over the time since `start` \[s\]; it begins with 0 and has no jumps.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the history or the start is, or the position jumps.
    pub fn of_position(history: History, start: f64) -> Result<Self> {
        let mut times = history.breaks(f64::INFINITY);
        times.push(0.0);
        let jump = times.into_iter().find(|t| (history.after(*t) - history.before(*t)).abs() > 0.0);
        if let Some(t) = jump {
            return Err(Error::invalid(
                format!("jump of the path at {t} s"),
                format!("{} m to {} m", history.before(t), history.after(t)),
                "none: a body moves with a finite velocity, from 0 m",
            ));
        }
        Path::new(history, false, start)
    }

    fn new(history: History, of_velocity: bool, start: f64) -> Result<Self> {
        history.validate()?;
        let sound = start.is_finite() && start >= 0.0;
        require(sound, "start of the motion", format!("{start} s"), "finite and not negative")?;
        Ok(Path { history, of_velocity, start })
    }

    /// When the motion starts \[s\].
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Distance moved at time t \[m\]; less where the motion turns back.
    pub fn position(&self, t: f64) -> f64 {
        let inside = t - self.start;
        if inside <= 0.0 {
            return 0.0;
        }
        if !self.of_velocity {
            return self.history.before(inside);
        }
        if let History::Sine { mean, amplitude, frequency } = self.history {
            let omega = std::f64::consts::TAU * frequency;
            // Sines begin at their mean.
            return mean * inside + amplitude * (1.0 - libm::cos(omega * inside)) / omega;
        }
        let mut sum = 0.0;
        let mut last = 0.0;
        for end in self.history.breaks(inside).into_iter().filter(|t| *t < inside).chain([inside]) {
            sum += 0.5 * (self.history.after(last) + self.history.before(end)) * (end - last);
            last = end;
        }
        sum
    }

    /// Length of the way between two times \[m\], to and fro.
    pub fn travel(&self, from: f64, to: f64) -> f64 {
        // Whole periods are all alike.
        if let History::Sine { frequency, .. } = self.history {
            let from = from.max(self.start);
            let periods = ((to - from) * frequency).floor();
            if periods > 1.0 {
                let period = 1.0 / frequency;
                let one = self.travel(self.start, self.start + period);
                return periods * one + self.travel(from + periods * period, to.max(from + periods * period));
            }
        }
        self.ways(&self.turning_points(from, to)).sum()
    }

    /// The times from `from` to `to` between which the motion goes one way, smoothly.
    fn turning_points(&self, from: f64, to: f64) -> Vec<f64> {
        let bends = self.breaks(to).into_iter().filter(|t| *t > from);
        let ends: Vec<f64> = std::iter::once(from).chain(bends).chain([to]).collect();
        let mut turns = vec![from];
        for pair in ends.windows(2) {
            turns.extend(self.turns(pair[0], pair[1]));
            turns.push(pair[1]);
        }
        turns
    }

    /// Lengths of the ways between these times \[m\].
    fn ways(&self, times: &[f64]) -> impl Iterator<Item = f64> {
        times.windows(2).map(|t| (self.position(t[1]) - self.position(t[0])).abs())
    }

    /// Velocity at time t \[m/s\], from before it.
    pub fn velocity(&self, t: f64) -> f64 {
        let inside = t - self.start;
        if inside <= 0.0 {
            return 0.0;
        }
        if self.of_velocity {
            return self.history.before(inside);
        }
        let last = self.history.breaks(inside).into_iter().filter(|t| *t < inside).fold(0.0, f64::max);
        match self.history {
            History::Sine { amplitude, frequency, .. } => {
                let omega = std::f64::consts::TAU * frequency;
                amplitude * omega * libm::cos(omega * inside)
            }
            _ => {
                let dt = 0.5 * (inside - last);
                (self.history.before(inside) - self.history.after(inside - dt)) / dt
            }
        }
    }

    /// The sense of the motion at time t: the sign of its velocity before it, or where that is 0 of a given velocity after it; 0 at rest.
    pub(crate) fn sense(&self, t: f64) -> f64 {
        let (before, inside) = (self.velocity(t), t - self.start);
        let after = if self.of_velocity && inside >= 0.0 { self.history.after(inside) } else { 0.0 };
        match if before == 0.0 { after } else { before } {
            0.0 => 0.0,
            velocity => velocity.signum(),
        }
    }

    /// Where the motion starts, bends or jumps, up to `end` \[s\].
    pub fn breaks(&self, end: f64) -> Vec<f64> {
        let inside = self.history.breaks(end - self.start).into_iter().map(|t| self.start + t);
        std::iter::once(self.start).filter(|t| *t > 0.0).chain(inside).filter(|t| *t < end).collect()
    }

    /// The instants up to `end` \[s\] at which the position is a multiple of `step` \[m\].
    ///
    /// # Errors
    /// [`Error::Invalid`] where they are more than ten millions.
    pub fn crossings(&self, step: f64, end: f64) -> Result<Vec<f64>> {
        let turns = self.turning_points(self.start.min(end), end);
        let travel: f64 = self.ways(&turns).sum();
        let expected = format!("at most {MOST:e}; a steady state ([motion.steady]) needs no travel");
        let cells = travel / step;
        require(cells <= MOST, "travel in cells", format!("{cells:e}"), expected)?;
        let mut found = vec![];
        for pair in turns.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|t| self.position(t) / step);
            let (low, high) = (a.min(b), a.max(b));
            let mut marks: Vec<f64> = ((low - 1e-9).ceil() as i64..=(high + 1e-9).floor() as i64)
                .map(|k| k as f64)
                .filter(|k| *k > low + 1e-9 && *k < high - 1e-9)
                .map(|k| self.reaches(k * step, pair[0], pair[1]))
                .collect();
            marks.sort_by(f64::total_cmp);
            found.extend(marks);
            found.push(pair[1]);
        }
        found.retain(|t| *t > 0.0 && *t <= end);
        found.dedup();
        Ok(found)
    }

    /// Where the velocity changes its sign within a smooth piece.
    fn turns(&self, from: f64, to: f64) -> Vec<f64> {
        // Between quarters of a period the velocity rises or falls throughout.
        let mut ends = vec![from];
        if let History::Sine { frequency, .. } = self.history {
            let quarter = 0.25 / frequency;
            let count = |t: f64| (t - self.start) / quarter;
            let first = count(from).floor() as i64 + 1;
            let last = (count(to).ceil() as i64 - 1).min(first + MOST_QUARTERS);
            ends.extend(
                (first..=last).map(|k| self.start + k as f64 * quarter).filter(|t| *t > from && *t < to),
            );
        }
        ends.push(to);
        let just = |t: f64, side: f64, piece: f64| self.velocity(t + side * 1e-9 * piece);
        let mut turns = vec![];
        for (k, pair) in ends.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            let piece = b - a;
            let sign = just(a, 1.0, piece);
            if k > 0 && just(a, -1.0, piece) * sign < 0.0 {
                turns.push(a);
            }
            if sign * just(b, -1.0, piece) < 0.0 {
                let [a, b] = bisect([a, b], 80, |t| self.velocity(t) * sign > 0.0);
                turns.push(0.5 * (a + b));
            }
        }
        turns
    }

    /// The instant in a piece without turns at which the position is `x`.
    fn reaches(&self, x: f64, from: f64, to: f64) -> f64 {
        let rising = self.position(to) > self.position(from);
        let [from, to] = bisect([from, to], 80, |t| (self.position(t) < x) == rising);
        0.5 * (from + to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_travel_is_the_integral_of_the_speed() {
        let tau = std::f64::consts::TAU;
        for (mean, frequency) in [(0.0, 0.01), (0.3, 0.7), (0.99, 2.3), (1.5, 0.2), (-0.4, 11.0)] {
            let path = Path::of_velocity(History::Sine { mean, amplitude: 1.0, frequency }, 2.0).unwrap();
            let speed = |t: f64| (mean + (tau * frequency * (t - 2.0)).sin()).abs();
            for (from, to) in [(0.0, 12.0), (2.0, 102.0), (3.0, 3.5), (2.0, 252.0), (7.7, 7.7)] {
                let n = (400.0 * frequency * (to - from)).max(4000.0) as usize;
                let dt = (to - f64::max(from, 2.0)) / n as f64;
                let sum: f64 = (0..n).map(|k| speed(f64::max(from, 2.0) + (k as f64 + 0.5) * dt) * dt).sum();
                // the rule of midpoints across kinks
                assert!(
                    (path.travel(from, to) - sum).abs() < 1e-5 * sum.max(1.0),
                    "{mean} {frequency} {from} {to}"
                );
                let halves =
                    path.travel(from, 0.4 * from + 0.6 * to) + path.travel(0.4 * from + 0.6 * to, to);
                assert!((path.travel(from, to) - halves).abs() < 1e-9 * sum.max(1.0));
            }
            // Each way to and fro of a position is four amplitudes.
            let there =
                Path::of_position(History::Sine { mean: 0.0, amplitude: 0.5, frequency }, 0.0).unwrap();
            assert!((there.travel(0.0, 5.0 / frequency) / 10.0 - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_sine_crosses_each_place_on_every_way() {
        // From 0 to 2 A/ω and back, ten times; turns are crossings too.
        let path =
            Path::of_velocity(History::Sine { mean: 0.0, amplitude: 0.1, frequency: 0.01 }, 0.0).unwrap();
        let far = path.position(50.0);
        let crossings = path.crossings(far / 3.5, 1000.0).unwrap();
        assert_eq!(crossings.iter().filter(|t| (path.velocity(**t)).abs() > 1e-6).count(), 10 * 6);
    }

    #[test]
    fn the_position_is_the_integral_of_the_velocity() {
        let table = History::Table { points: vec![(0.0, 0.0), (1.0, 2.0), (3.0, 2.0), (5.0, -2.0)] };
        for history in [
            History::Step { value: 3.0 },
            History::Ramp { value: 2.0, duration: 1.5 },
            History::Triangle { peak: 1.0, rise: 1.0, fall: 2.0 },
            History::Sine { mean: 0.5, amplitude: 1.0, frequency: 0.3 },
            table,
        ] {
            let path = Path::of_velocity(history.clone(), 0.7).unwrap();
            for t in [0.2, 0.9, 2.0, 4.4, 6.0] {
                let n = 200_000;
                let dt = t / f64::from(n);
                let sum: f64 = (0..n).map(|k| path.velocity((f64::from(k) + 0.5) * dt) * dt).sum();
                // the midpoint rule across a jump
                assert!((path.position(t) - sum).abs() < 1e-4, "{history:?} {t}: {} {sum}", path.position(t));
            }
        }
    }

    #[test]
    fn crossings_are_whole_steps_there_and_back() {
        let points = vec![(0.0, 1.0), (2.0, 1.0), (4.0, -1.0), (6.0, -1.0)];
        let path = Path::of_velocity(History::Table { points }, 1.0).unwrap();
        let times = path.crossings(0.25, 6.0).unwrap();
        assert!(times.windows(2).all(|t| t[0] < t[1]));
        for pair in times.windows(2) {
            let moved = path.position(pair[1]) - path.position(pair[0]);
            assert!(moved.abs() <= 0.25 + 1e-9, "{pair:?}: {moved}");
        }
        let whole = times.iter().filter(|t| (path.position(**t) / 0.25).fract().abs() < 1e-6).count();
        assert!(whole > 12, "{times:?}");
        assert!(path.crossings(1e-9, 6.0).is_err());
    }
}
