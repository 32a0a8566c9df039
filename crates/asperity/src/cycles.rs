//! Cyclic loading: evaluation of one period of load and approach.
//!
//! Over a period T = 1/f the external work is the area of the hysteresis loop, integral W dw. If the cycle is closed, it is the
//! energy dissipated (J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed., Wiley 1980, chapter 1). If the approach drifts
//! by dw over the period, the integral includes the work of the mean load over this drift, mean(W) dw, which is not part of the
//! loop. The first harmonics W_1, w_1, complex amplitudes of exp(i 2 pi f t), give the dynamic stiffness K* = W_1/w_1 =
//! |K*| exp(i delta) with the loss angle delta: the load leads the approach. In full contact tan delta is that of
//! the material, E''/E'. If the contact area changes within the cycle it is not, and there are higher harmonics, which are ignored.

use crate::error::{Error, Result, positive};

/// One full period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Start and end \[s\].
    pub span: [f64; 2],
    /// External work integral W dw over the period, on cubics through the rows \[J\]: the dissipated energy, plus the energy
    /// stored in a cycle that is not closed.
    pub dissipated_energy: f64,
    /// Part of `dissipated_energy` that is the work of the mean load over the drift of the approach from start to end \[J\]: 0 if
    /// the cycle is closed.
    pub drift_work: f64,
    /// Dynamic stiffness |K*| of the first harmonics \[N/m\].
    pub stiffness: f64,
    /// Loss angle delta of the first harmonics \[rad\].
    pub loss_angle: f64,
}

/// Smallest number of rows within a period that determine its first harmonic.
const FEWEST: usize = 8;

/// The full periods from `start` \[s\] on, of rows in order of `time` \[s\] with `load` \[N\] and `approach` \[m\]; steps need
/// not be equal, and ends of periods need not be rows. Periods with fewer than 8 steps are left out.
///
/// Each first harmonic is the least-squares fit of mean, drift, cosine and sine to the rows of the period, weighted by their
/// steps: exact for a harmonic on a straight line, for any steps.
///
/// ```
/// // K* = 100 exp(0.3 i) N/m at 2 Hz, an amplitude of 1 um: a cycle dissipates pi |K*| sin(delta) w1^2.
/// let time: Vec<f64> = (0..=400).map(|n| f64::from(n) / 400.0).collect();
/// let phase = |t: f64| std::f64::consts::TAU * 2.0 * t;
/// let approach: Vec<f64> = time.iter().map(|t| 5e-6 + 1e-6 * phase(*t).sin()).collect();
/// let load: Vec<f64> = time.iter().map(|t| 1e-3 + 1e-4 * (phase(*t) + 0.3).sin()).collect();
/// let cycles = asperity::cycles::cycles(&time, &load, &approach, 2.0, 0.0)?;
/// assert_eq!(cycles.len(), 2);
/// assert!((cycles[1].stiffness - 100.0).abs() < 1e-6 && (cycles[1].loss_angle - 0.3).abs() < 1e-9);
/// let energy = std::f64::consts::PI * 100.0 * 0.3_f64.sin() * 1e-12;
/// assert!((cycles[1].dissipated_energy / energy - 1.0).abs() < 1e-3);
/// assert!(cycles[1].drift_work.abs() < 1e-9 * energy);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if the frequency is not positive, the lists differ in length, or times decrease.
pub fn cycles(
    time: &[f64],
    load: &[f64],
    approach: &[f64],
    frequency: f64,
    start: f64,
) -> Result<Vec<Cycle>> {
    positive("frequency", frequency, "Hz")?;
    if load.len() != time.len() || approach.len() != time.len() {
        let lengths = format!("{} loads, {} approaches", load.len(), approach.len());
        return Err(Error::invalid("rows", lengths, format!("as many as times, {}", time.len())));
    }
    if let Some(n) = time.windows(2).position(|pair| pair[1] < pair[0] || pair.iter().any(|t| t.is_nan())) {
        return Err(Error::invalid(
            format!("time of row {}", n + 1),
            format!("{} s", time[n + 1]),
            format!("not less than {} s", time[n]),
        ));
    }
    let Some(end) = time.last() else { return Ok(vec![]) };
    let period = 1.0 / frequency;
    let rows = Rows { time, load, approach };
    let mut found = vec![];
    // A time past the end by rounding counts as the end.
    let last = end + 1e-9 * period;
    // Only periods that contain rows: there may be a billion others.
    let mut numbers: Vec<f64> = time.iter().map(|t| ((t - start) / period).floor()).collect();
    numbers.dedup();
    for n in numbers.into_iter().filter(|n| *n >= 0.0) {
        let span = [start + n * period, start + (n + 1.0) * period];
        if span[1] <= last {
            found.extend(rows.period(span, std::f64::consts::TAU * frequency));
        }
    }
    Ok(found)
}

struct Rows<'a> {
    time: &'a [f64],
    load: &'a [f64],
    approach: &'a [f64],
}

/// Time, load, approach.
type Point = [f64; 3];

impl Rows<'_> {
    fn at(&self, n: usize) -> Point {
        [self.time[n], self.load[n], self.approach[n]]
    }

    /// The point at a time between the rows `next` - 1 and `next`: on the cubic through four rows, or the line through two.
    fn between(&self, next: usize, time: f64) -> Option<Point> {
        let (a, b) = (self.at(next.checked_sub(1)?), (next < self.time.len()).then(|| self.at(next))?);
        let around: Vec<Point> =
            (next.saturating_sub(2)..self.time.len().min(next + 2)).map(|n| self.at(n)).collect();
        if apart(&around, b[0] - a[0]) {
            return Some([time, cubic(&around, 1, time)[0], cubic(&around, 2, time)[0]]);
        }
        let share = if b[0] > a[0] { (time - a[0]) / (b[0] - a[0]) } else { 0.0 };
        Some(std::array::from_fn(|k| a[k] + share * (b[k] - a[k])))
    }

    fn period(&self, [start, end]: [f64; 2], omega: f64) -> Option<Cycle> {
        let close = 1e-9 * (end - start);
        let first = self.time.partition_point(|t| *t < start - close);
        let last = self.time.partition_point(|t| *t <= end + close);
        if last < first + FEWEST {
            return None;
        }
        let mut points: Vec<Point> = (first..last).map(|n| self.at(n)).collect();
        // Ends of periods that are not rows lie between rows.
        if points.first()?[0] > start + close {
            points.insert(0, self.between(first, start)?);
        }
        if points.last()?[0] < end - close {
            points.push(self.between(last, end)?);
        }
        let [load, approach] = [1, 2].map(|which| harmonic(&points, which, omega));
        let (load, approach) = (load?, approach?);
        // Amplitudes a - i b of a cos + b sin.
        let size = |[a, b]: [f64; 2]| a.hypot(b);
        let phase = |[a, b]: [f64; 2]| libm::atan2(-b, a);
        let turn = phase(load) - phase(approach);
        let loss_angle = turn - std::f64::consts::TAU * libm::round(turn / std::f64::consts::TAU);
        let (a, b) = (points.first()?, points.last()?);
        let mean_load =
            points.windows(2).map(|pair| 0.5 * (pair[0][1] + pair[1][1]) * (pair[1][0] - pair[0][0]));
        let mean_load = mean_load.sum::<f64>() / (end - start);
        Some(Cycle {
            span: [start, end],
            drift_work: mean_load * (b[2] - a[2]),
            dissipated_energy: (1..points.len()).map(|n| work(&points, n)).sum(),
            stiffness: size(load) / size(approach),
            loss_angle,
        })
        .filter(|cycle| cycle.stiffness.is_finite())
    }
}

/// Integral of W dw from point n - 1 to n, on the cubics in time through the four surrounding points: chords alone would be too
/// small by a relative (2 pi/N)^2/6 with N rows per period. The chord is used next to a jump and if the four points are not far
/// enough apart.
fn work(points: &[Point], n: usize) -> f64 {
    let [a, b] = [points[n - 1], points[n]];
    let chord = 0.5 * (a[1] + b[1]) * (b[2] - a[2]);
    let first = n.saturating_sub(2).min(points.len().saturating_sub(4));
    let Some(around) = points.get(first..first + 4) else { return chord };
    let step = b[0] - a[0];
    if !apart(around, step) {
        return chord;
    }
    // Gauss' rule of three points: exact for the product of a cubic and the slope of one.
    let node = 0.6f64.sqrt();
    let middle = 0.5 * (a[0] + b[0]);
    let at = |x: f64| {
        let t = middle + 0.5 * step * x;
        cubic(around, 1, t)[0] * cubic(around, 2, t)[1]
    };
    0.5 * step * (5.0 * at(-node) + 8.0 * at(0.0) + 5.0 * at(node)) / 9.0
}

/// Whether four points are far enough apart for a cubic, relative to the step.
fn apart(around: &[Point], step: f64) -> bool {
    around.len() == 4 && around.windows(2).all(|pair| pair[1][0] - pair[0][0] >= 0.05 * step)
}

/// Value and slope at time t of the cubic through a column of four points.
fn cubic(around: &[Point], column: usize, t: f64) -> [f64; 2] {
    let (mut value, mut slope) = (0.0, 0.0);
    for (i, p) in around.iter().enumerate() {
        let others = || around.iter().enumerate().filter(move |(k, _)| *k != i);
        let basis: f64 = others().map(|(_, q)| (t - q[0]) / (p[0] - q[0])).product();
        let terms = others().map(|(k, q)| {
            let rest = others().filter(move |(l, _)| *l != k);
            rest.map(|(_, r)| (t - r[0]) / (p[0] - r[0])).product::<f64>() / (p[0] - q[0])
        });
        value += p[column] * basis;
        slope += p[column] * terms.sum::<f64>();
    }
    [value, slope]
}

/// Cosine and sine amplitudes of column `which`, fitted with a mean and a drift.
fn harmonic(points: &[Point], which: usize, omega: f64) -> Option<[f64; 2]> {
    let (start, end) = (points.first()?[0], points.last()?[0]);
    let middle = 0.5 * (start + end);
    // Of the order of one, so that the normal equations are well scaled.
    let scale = points.iter().map(|p| p[which].abs()).fold(0.0, f64::max);
    let mut normal = [[0.0; 5]; 4];
    for (n, point) in points.iter().enumerate() {
        let before = points[n.saturating_sub(1)][0];
        let after = points[(n + 1).min(points.len() - 1)][0];
        let weight = 0.5 * (after - before) / (end - start);
        let phase = omega * point[0];
        let basis = [1.0, 2.0 * (point[0] - middle) / (end - start), libm::cos(phase), libm::sin(phase)];
        for (row, b) in normal.iter_mut().zip(basis) {
            for (entry, c) in row.iter_mut().zip(basis.into_iter().chain([point[which] / scale])) {
                *entry += weight * b * c;
            }
        }
    }
    let solution = solve(normal)?;
    Some([scale * solution[2], scale * solution[3]])
}

/// Gaussian elimination with pivots; `None` if the rows do not determine the solution.
fn solve(mut m: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    for k in 0..4 {
        let pivot = (k..4).max_by(|a, b| m[*a][k].abs().total_cmp(&m[*b][k].abs()))?;
        m.swap(k, pivot);
        if m[k][k].abs() <= 1e-12 || m[k][k].is_nan() {
            return None;
        }
        let row = m[k];
        for other in m.iter_mut().skip(k + 1) {
            let factor = other[k] / row[k];
            other.iter_mut().zip(row).for_each(|(entry, r)| *entry -= factor * r);
        }
    }
    let mut x = [0.0; 4];
    for k in (0..4).rev() {
        let known: f64 = (k + 1..4).map(|j| m[k][j] * x[j]).sum();
        x[k] = (m[k][4] - known) / m[k][k];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_on_a_drift_are_found_from_uneven_rows_with_a_jump() {
        let (f, start) = (0.25, 1.0);
        let omega = std::f64::consts::TAU * f;
        // Uneven, ends of periods are no rows, a row given twice.
        let mut time: Vec<f64> =
            (0..130).map(|n| 0.1 * f64::from(n) + 0.03 * (1.7 * f64::from(n)).sin()).collect();
        time.insert(40, time[40]);
        let approach: Vec<f64> = time.iter().map(|t| 2.0 + 0.1 * t + 0.5 * (omega * t).cos()).collect();
        let load: Vec<f64> = time.iter().map(|t| 7.0 - 0.3 * t + 3.0 * (omega * t + 0.8).cos()).collect();
        let found = cycles(&time, &load, &approach, f, start).unwrap();
        assert_eq!(found.len(), 2); // to 5 s, to 9 s; the rows end near 12.9 s
        for cycle in &found {
            // Fitted to uneven rows; the ends lie on cubics.
            assert!((cycle.stiffness / 6.0 - 1.0).abs() < 1e-3, "{cycle:?}");
            assert!((cycle.loss_angle - 0.8).abs() < 1e-3, "{cycle:?}");
        }
        assert_eq!(found[1].span, [5.0, 9.0]);
    }

    #[test]
    fn the_loop_of_forty_rows_has_its_area_to_a_thousandth() {
        let f = 0.5;
        let omega = std::f64::consts::TAU * f;
        for uneven in [0.0, 0.3] {
            let time: Vec<f64> =
                (0..=120).map(|n| 0.05 * (f64::from(n) + uneven * (1.7 * f64::from(n)).sin())).collect();
            // With a second harmonic, as in a contact whose area changes.
            let approach: Vec<f64> =
                time.iter().map(|t| (omega * t).cos() + 0.2 * (2.0 * omega * t).cos()).collect();
            let load: Vec<f64> =
                time.iter().map(|t| (omega * t + 0.3).cos() + 0.2 * (2.0 * omega * t + 0.4).cos()).collect();
            let exact = std::f64::consts::PI * (0.3f64.sin() + 2.0 * 0.04 * 0.4f64.sin());
            let found = cycles(&time, &load, &approach, f, 2.0).unwrap();
            // (2 pi/40)^4/6 of the first harmonic, sixteen times that of the second's tenth; a few times more where uneven.
            assert!((found[0].dissipated_energy / exact - 1.0).abs() < 1e-3, "{:?} {exact}", found[0]);
        }
    }

    #[test]
    fn a_billion_periods_without_rows_take_no_time() {
        // Two periods with rows at either end of 10^12.
        let mut time: Vec<f64> = (0..=10).map(|n| 0.1 * f64::from(n)).collect();
        time.extend((0..=10).map(|n| 1e12 + 0.1 * f64::from(n)));
        let wave: Vec<f64> = time.iter().map(|t| (std::f64::consts::TAU * t.fract()).sin()).collect();
        let found = cycles(&time, &wave, &wave, 1.0, 0.0).unwrap();
        assert_eq!(found.iter().map(|cycle| cycle.span[0]).collect::<Vec<_>>(), [0.0, 1e12]);
    }

    #[test]
    fn too_few_rows_say_nothing_and_wrong_rows_are_refused() {
        let time: Vec<f64> = (0..6).map(f64::from).collect();
        assert_eq!(cycles(&time, &time, &time, 0.2, 0.0).unwrap(), []);
        assert_eq!(cycles(&[], &[], &[], 1.0, 0.0).unwrap(), []);
        // Nothing moves: no stiffness.
        let long: Vec<f64> = (0..60).map(f64::from).collect();
        assert_eq!(cycles(&long, &vec![1.0; 60], &vec![0.0; 60], 0.05, 0.0).unwrap(), []);
        assert!(cycles(&time, &time[1..], &time, 1.0, 0.0).is_err());
        assert!(cycles(&[0.0, 2.0, 1.0], &[0.0; 3], &[0.0; 3], 1.0, 0.0).is_err());
        assert!(cycles(&time, &time, &time, 0.0, 0.0).is_err());
    }
}
