//! Fewer points of a record, with its corners.
//!
//! Of the points between two that are kept, the one farthest from the straight line between these is kept too, until all lie on the lines to
//! within an error (U. Ramer, Computer Graphics and Image Processing 1, 244, 1972; D. H. Douglas & T. K. Peucker, 1973). Distances are those
//! of the values: a corner keeps its time.

/// Relative error of a record without noise: the rounding of its file.
const ROUNDING: f64 = 1e-6;

/// The numbers of the points that are kept, `most` at most, and the largest distance of the others from the straight lines between
/// them: not above the noise of the values, unless there are too many points for that.
///
/// ```
/// use asperity_files::curve::thinned;
/// // Up within 1 s, and held.
/// let times: Vec<f64> = (0..=400).map(|k| 0.05 * f64::from(k)).collect();
/// let values: Vec<f64> = times.iter().map(|t| t.min(1.0)).collect();
/// assert_eq!(thinned(&times, &values, 100).0, [0, 20, 400]);
/// ```
pub fn thinned(times: &[f64], values: &[f64], most: usize) -> (Vec<usize>, f64) {
    let range = values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - values.iter().copied().fold(f64::INFINITY, f64::min);
    let mut error = noise(times, values).max(ROUNDING * range);
    loop {
        let kept = corners(times, values, error);
        if kept.len() <= most.max(2) || error >= range || !range.is_finite() {
            let farthest =
                kept.windows(2).map(|pair| farthest(times, values, [pair[0], pair[1]]).1).fold(0.0, f64::max);
            return (kept, farthest);
        }
        error *= 2.0;
    }
}

/// The ends, and all points that are needed for this error.
fn corners(times: &[f64], values: &[f64], error: f64) -> Vec<usize> {
    let count = times.len().min(values.len());
    let mut kept = vec![false; count];
    let mut open = Vec::new();
    if let Some(last) = count.checked_sub(1) {
        (kept[0], kept[last]) = (true, true);
        open.push([0, last]);
    }
    while let Some([from, to]) = open.pop() {
        let (corner, distance) = farthest(times, values, [from, to]);
        if distance > error {
            kept[corner] = true;
            open.extend([[from, corner], [corner, to]]);
        }
    }
    (0..count).filter(|n| kept[*n]).collect()
}

/// The point between two that is farthest from the straight line between them, and its distance.
fn farthest(times: &[f64], values: &[f64], [from, to]: [usize; 2]) -> (usize, f64) {
    let span = times[to] - times[from];
    let line = |n: usize| {
        let share = if span > 0.0 { (times[n] - times[from]) / span } else { 0.0 };
        values[from] + share * (values[to] - values[from])
    };
    let distance = |n: usize| (n, (values[n] - line(n)).abs());
    (from + 1..to).map(distance).fold((from, 0.0), |best, other| if other.1 > best.1 { other } else { best })
}

/// Standard deviation of the noise: a smooth record is nearly a parabola through four neighbours, and the median leaves corners out.
fn noise(times: &[f64], values: &[f64]) -> f64 {
    let count = times.len().min(values.len());
    let distance = |n: usize| {
        let (t, y) = (&times[n..n + 4], &values[n..n + 4]);
        // The value at t[1] of the parabola through the others.
        let weight = |i: usize| -> f64 {
            [0, 2, 3].iter().filter(|j| **j != i).map(|j| (t[1] - t[*j]) / (t[i] - t[*j])).product()
        };
        let weights = [0, 2, 3].map(weight);
        let parabola: f64 = [0, 2, 3].iter().zip(weights).map(|(i, w)| w * y[*i]).sum();
        (y[1] - parabola).abs() / (1.0 + weights.iter().map(|w| w * w).sum::<f64>()).sqrt()
    };
    let mut distances: Vec<f64> =
        (0..count.saturating_sub(3)).map(distance).filter(|d| d.is_finite()).collect();
    distances.sort_by(f64::total_cmp);
    // The median of the absolute value of a normal variable is 0.6745 of its standard deviation.
    distances.get(distances.len() / 2).map_or(0.0, |median| median / 0.6745)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ramp, hold, retraction: 401 rows over 20 s.
    fn record(noise: f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..=400).map(|k| 0.05 * f64::from(k)).collect();
        let mut state = 1u64;
        // Twelve uniform numbers: nearly normal.
        let mut normal = move || {
            let mut uniform = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 11) as f64 / (1u64 << 53) as f64
            };
            (0..12).map(|_| uniform()).sum::<f64>() - 6.0
        };
        let of = |t: f64| if t < 15.0 { t.min(1.0) } else { (1.0 - 0.5 * (t - 15.0)).max(0.0) };
        let values = times.iter().map(|t| of(*t) + noise * normal()).collect();
        (times, values)
    }

    #[test]
    fn corners_are_kept_and_straight_parts_are_not() {
        let (times, values) = record(0.0);
        let (kept, error) = thinned(&times, &values, 1000);
        // 1 s, 15 s and 17 s.
        assert_eq!(kept, [0, 20, 300, 340, 400]);
        assert!(error < 1e-6);
    }

    #[test]
    fn the_error_is_not_above_the_noise() {
        let (times, values) = record(0.01);
        // A median of 398 distances is known to a few per cent.
        let found = noise(&times, &values);
        assert!((found / 0.01 - 1.0).abs() < 0.2, "{found}");
        let (kept, error) = thinned(&times, &values, 1000);
        assert!(error <= found && kept.len() < times.len(), "{error} {}", kept.len());
        // Fewer points are had by a larger error, which is stated.
        let (fewer, larger) = thinned(&times, &values, 20);
        assert!(fewer.len() <= 20 && larger > error && larger < 0.2, "{larger} {}", fewer.len());
    }

    #[test]
    fn records_of_few_or_equal_times_are_answered() {
        assert_eq!(thinned(&[], &[], 10).0, [0; 0]);
        assert_eq!(thinned(&[1.0], &[2.0], 10).0, [0]);
        assert_eq!(thinned(&[1.0, 1.0, 1.0], &[0.0, 5.0, 1.0], 10).0, [0, 1, 2]);
    }
}
