//! The largest value of a number that is known at the rows of a run: between them, with what the distance of the rows leaves open.
//!
//! ```text
//! smooth at the largest row k   the top of the parabola through k - 1, k, k + 1; off by no more than the tops of the parabolas through
//!                               k - 2, k - 1, k and k, k + 1, k + 2 are off it, and than the correction itself
//! a jump between k and k + 1    the parabola through k - 2, k - 1, k goes on up to the jump, somewhere before k + 1: halfway between k
//!                               and its top there, off by their distance and the second difference (likewise before k)
//! a bend of the course at k     each side by itself: the row, unless a parabola has its top inside a step next to it
//! ```
//!
//! Next to a jump the parabola of the other side is convex: it describes no top.

use asperity::step::Row;
use asperity::{Axis, Control};

use crate::store::Reader;

/// A change of the slope is a bend where it is that much larger than those of the steps beside it.
const BEND: f64 = 4.0;
/// Slopes that differ by less than this share are equal.
const STRAIGHT: f64 = 1e-6;

/// A parabola that bends that much more than another lies across a jump.
const JUMP: f64 = 8.0;

/// A largest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extreme {
    /// Where it lies on the axis of the rows.
    pub(super) at: f64,
    pub(super) value: f64,
    /// How far both may be off because of the distance of the rows.
    pub(super) at_error: f64,
    pub(super) error: f64,
}

/// Rows that follow one another, and what is known of the course between them.
pub(super) struct Course<'a> {
    /// Where the rows stand on their axis, in order; a jump is two rows at one place.
    pub(super) at: &'a [f64],
    /// Numbers of the rows that are prescribed or respond without a jump: where they bend, others bend too.
    pub(super) drivers: Vec<Vec<f64>>,
    /// Whether the row is the last one of its stage.
    pub(super) ends: Vec<bool>,
}

impl<'a> Course<'a> {
    /// Of rows in time or over velocities, whose places are `at`.
    pub(super) fn of(reader: &Reader, rows: &[Row], at: &'a [f64]) -> Self {
        let controls = reader.header().controls();
        let given = |row: &Row| match controls.get(row.stage) {
            Some(Control::Approach) => row.approach,
            _ => row.load,
        };
        let in_time = reader.header().axis() == Axis::Time;
        let drivers = if in_time { vec![rows.iter().map(given).collect()] } else { vec![] };
        let ends = (0..rows.len()).map(|n| rows.get(n + 1).is_some_and(|next| next.stage != rows[n].stage));
        Course { at, drivers, ends: ends.collect() }
    }

    /// Of numbers that stand at these places, where these others bend.
    pub(super) fn along(at: &'a [f64], drivers: Vec<Vec<f64>>) -> Self {
        Course { at, drivers, ends: vec![false; at.len()] }
    }

    /// What the distance of the rows leaves open of the value of the row `k`, the largest one.
    pub(super) fn open_at(&self, values: &[f64], k: usize) -> f64 {
        let top = self.largest(values, k);
        top.value - values[k] + top.error
    }

    /// Whether rows `n` and `n + 1` are apart on the axis.
    fn joins(&self, n: usize) -> bool {
        self.at.get(n + 1).is_some_and(|next| *next > self.at[n])
    }

    /// Whether the course bends at a row.
    fn bends(&self, n: usize) -> bool {
        self.ends[n] || self.drivers.iter().any(|driver| self.has_bend(driver, n))
    }

    fn has_bend(&self, driver: &[f64], n: usize) -> bool {
        let slope =
            |n: usize| self.joins(n).then(|| (driver[n + 1] - driver[n]) / (self.at[n + 1] - self.at[n]));
        let (Some(before), Some(after)) = (n.checked_sub(1).and_then(slope), slope(n)) else { return false };
        let change = |a: Option<f64>, b: f64| a.map_or(0.0, |a| (b - a).abs());
        let beside = change(n.checked_sub(2).and_then(slope), before).max(change(slope(n + 1), after));
        (after - before).abs() > BEND * beside + STRAIGHT * before.abs().max(after.abs())
    }

    /// The rows around `k` between which nothing jumps or bends.
    fn piece(&self, k: usize) -> [usize; 2] {
        let (mut first, mut last) = (k, k);
        while first > 0 && self.joins(first - 1) && (first == k || !self.bends(first)) {
            first -= 1;
        }
        while self.joins(last) && (last == k || !self.bends(last)) {
            last += 1;
        }
        [first, last]
    }

    /// The largest value, which is at or next to the row `k`, the largest one.
    pub(super) fn largest(&self, values: &[f64], k: usize) -> Extreme {
        let [first, last] = self.piece(k);
        let row = Extreme { at: self.at[k], value: values[k], at_error: 0.0, error: 0.0 };
        let through = |n: usize| Parabola::through([n, n + 1, n + 2].map(|n| [self.at[n], values[n]]));
        let left = (first + 2 <= k).then(|| through(k - 2));
        let right = (k + 2 <= last).then(|| through(k));
        if first == k || last == k || self.bends(k) {
            let tops = [
                left.map(|left| left.top([self.at[k - 1], self.at[k]])),
                right.map(|right| right.top([self.at[k], self.at[k + 1]])),
            ];
            let highest = tops
                .into_iter()
                .flatten()
                .fold(row, |a, b| if b[1] > a.value { Extreme { at: b[0], value: b[1], ..a } } else { a });
            return Extreme {
                at_error: (highest.at - row.at).abs(),
                error: highest.value - row.value,
                ..highest
            };
        }
        let around = [self.at[k - 1], self.at[k + 1]];
        let middle = through(k - 1);
        let [at, value] = middle.top(around);
        let sides: Vec<Parabola> = [left, right].into_iter().flatten().collect();
        let concave: Vec<&Parabola> = sides.iter().filter(|side| side.curvature < 0.0).collect();
        match (&concave[..], sides.len()) {
            // The other one is beyond a jump, or the end of a slope that flattens.
            ([side], 2) => {
                let top = side.top(around);
                let between = 0.5 * (row.at + top[0]);
                // Its second difference is what a step may change besides.
                let bent = 2.0 * side.curvature.abs() * (around[1] - row.at) * (row.at - around[0]);
                Extreme {
                    at: between,
                    value: 0.5 * (row.value + top[1]),
                    at_error: 0.5 * (around[1] - around[0]),
                    error: top[1] - row.value + bent,
                }
            }
            (_, 0) => Extreme {
                at,
                value,
                at_error: around.map(|end| (end - row.at).abs()).into_iter().fold(0.0, f64::max),
                error: (value - row.value).max(row.value - values[k - 1].max(values[k + 1])),
            },
            _ => {
                // A side that bends far more than the middle is one across a jump.
                let is_smooth = |side: &&Parabola| side.curvature.abs() <= JUMP * middle.curvature.abs();
                let smooth: Vec<&Parabola> = concave.into_iter().filter(is_smooth).collect();
                let told = if smooth.is_empty() { sides.iter().collect() } else { smooth };
                let tops: Vec<[f64; 2]> = told.iter().map(|side| side.top(around)).collect();
                let most = |axis: usize, from: f64, own: f64| {
                    tops.iter().map(|top| (top[axis] - from).abs()).fold((own - from).abs(), f64::max)
                };
                Extreme { at, value, at_error: most(0, at, row.at), error: most(1, value, row.value) }
            }
        }
    }

    /// The value at a place between the rows, on straight lines.
    pub(super) fn between(&self, values: &[f64], at: f64) -> f64 {
        let next = self.at.partition_point(|own| *own < at).clamp(1, self.at.len().max(2) - 1);
        match (self.at.get(next), self.at.get(next - 1)) {
            (Some(to), Some(from)) if to > from => {
                values[next - 1] + (values[next] - values[next - 1]) * (at - from) / (to - from)
            }
            _ => values[next.min(values.len() - 1)],
        }
    }
}

/// y = y0 + slope (x - x0) + curvature (x - x0)(x - x1).
struct Parabola {
    ends: [f64; 2],
    start: f64,
    slope: f64,
    curvature: f64,
}

impl Parabola {
    fn through([a, b, c]: [[f64; 2]; 3]) -> Self {
        let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
        let curvature = (slope(b, c) - slope(a, b)) / (c[0] - a[0]);
        Parabola { ends: [a[0], b[0]], start: a[1], slope: slope(a, b), curvature }
    }

    fn at(&self, x: f64) -> f64 {
        self.start + (self.slope + self.curvature * (x - self.ends[1])) * (x - self.ends[0])
    }

    /// The highest point within an interval.
    fn top(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        let x = match self.curvature < 0.0 {
            true => 0.5 * (self.ends[0] + self.ends[1] - self.slope / self.curvature),
            false if self.at(high) > self.at(low) => high,
            false => low,
        };
        let x = x.clamp(low, high);
        [x, self.at(x)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The extreme of a function at rows of a distance, and how far its value and its place are off.
    fn found(
        f: fn(f64) -> f64,
        driver: fn(f64) -> f64,
        [step, shift]: [f64; 2],
        exact: [f64; 2],
    ) -> (Extreme, [f64; 2]) {
        let at: Vec<f64> = (-30..30).map(|n| step * (f64::from(n) + shift)).collect();
        let values: Vec<f64> = at.iter().map(|x| f(*x)).collect();
        let most = (0..at.len()).reduce(|a, b| if values[b] > values[a] { b } else { a }).unwrap();
        let course = Course::along(&at, vec![at.iter().map(|x| driver(*x)).collect()]);
        let top = course.largest(&values, most);
        (top, [(top.value - exact[1]).abs(), (top.at - exact[0]).abs()])
    }

    #[test]
    fn errors_cover_what_lies_between_the_rows() {
        type Case = (&'static str, fn(f64) -> f64, [f64; 2]);
        let cases: [Case; 4] = [
            ("a smooth top", |x| libm::exp(-0.5 * x * x), [0.0, 1.0]),
            ("an uneven top", |x| (x + 1.0) * libm::exp(-x), [0.0, 1.0]),
            (
                "a top before a jump",
                |x| if x < 0.3 { 1.0 + 0.1 * x - 0.2 * x * x } else { 0.0 },
                [0.25, 1.0125],
            ),
            (
                "a jump on the way up",
                |x| if x < 0.1 { 1.0 + 0.5 * x - 0.2 * x * x } else { 0.0 },
                [0.1, 1.048],
            ),
        ];
        for (name, f, exact) in cases {
            for n in 0..60 {
                let step = 0.02 + 0.38 * f64::from(n) / 60.0;
                let (top, [off, place]) = found(f, |x| x, [step, 0.618 * f64::from(n) % 1.0], exact);
                assert!(off <= top.error + 1e-12, "{name}, {step}: {top:?} {off}");
                assert!(place <= top.at_error + 1e-12, "{name}, {step}: {top:?} {place}");
                // The place is known to a row, the value to what it changes there.
                assert!(top.at_error <= 1.5 * step && top.error <= 0.7 * step, "{name}, {step}: {top:?}");
            }
        }
    }

    #[test]
    fn a_top_at_a_bend_of_the_course_is_the_row() {
        // Up to 0, where a row is, and down three times as fast.
        let saw = |x: f64| if x < 0.0 { 1.0 + x } else { 1.0 - 3.0 * x };
        let (top, [off, place]) = found(saw, |x| -x.abs(), [0.25, 0.0], [0.0, 1.0]);
        assert_eq!((top.error, top.at_error, off, place), (0.0, 0.0, 0.0, 0.0));
        // A top shortly before the bend is that of its own side.
        let early = |x: f64| if x < 0.0 { 1.0 - (x + 0.1) * (x + 0.1) } else { 0.99 - 3.0 * x };
        let (top, [off, _]) = found(early, |x| -x.abs(), [0.25, 0.0], [-0.1, 1.0]);
        assert!(off < 1e-12 && top.error >= 0.01 - 1e-12, "{top:?}");
        // A smooth course has none: a sine at its turn.
        let (top, [off, _]) =
            found(|x| libm::exp(-0.5 * x * x), |x| libm::exp(-0.5 * x * x), [0.3, 0.4], [0.0, 1.0]);
        assert!(off <= top.error && off < 1e-3, "{top:?}");
    }

    #[test]
    fn few_rows_and_jumps_of_no_time_leave_the_row() {
        let course = |at: &'static [f64]| Course::along(at, vec![]);
        assert_eq!(
            course(&[1.0]).largest(&[3.0], 0),
            Extreme { at: 1.0, value: 3.0, at_error: 0.0, error: 0.0 }
        );
        let top = course(&[0.0, 1.0, 1.0, 2.0]).largest(&[1.0, 2.0, 4.0, 3.0], 2);
        assert_eq!((top.at, top.value, top.error), (1.0, 4.0, 0.0));
        // Three rows alone: known to the nearest of them.
        let top = course(&[0.0, 1.0, 2.0]).largest(&[0.0, 3.0, 1.0], 1);
        assert!(top.value > 3.0 && top.error == 2.0 && top.at_error == 1.0, "{top:?}");
    }
}
