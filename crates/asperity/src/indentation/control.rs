//! Detection of the channel that the test controlled.
//!
//! A controller applies ramps and holds: its channel is piecewise straight, while the response of the body is curved (it relaxes
//! or creeps, and is proportional to a power of the depth). The channel that needs fewer straight pieces to be described within
//! its noise is therefore the controlled one. If both need the same number (a sine, an elastic cone), it is the one with less
//! noise.

use std::cmp::Ordering;

use super::{Given, noise};

/// Largest number of straight pieces of a history.
const PIECES: usize = 8;
/// Number of rows used.
const ROWS: usize = 200;
/// Misfit over the largest value that counts as zero.
const STRAIGHT: f64 = 1e-4;

/// The channel that the test controlled.
pub(super) fn controlled(times: &[f64], loads: &[f64], depths: &[f64]) -> Given {
    let channel = |values: &[f64]| {
        let variances = noise::variances(times, values);
        (pieces_needed(times, values, &variances), noise::relative(&variances, values))
    };
    let ((load_pieces, load_noise), (depth_pieces, depth_noise)) = (channel(loads), channel(depths));
    match depth_pieces.cmp(&load_pieces) {
        Ordering::Less => Given::Depth,
        Ordering::Greater => Given::Load,
        Ordering::Equal if depth_noise <= load_noise => Given::Depth,
        Ordering::Equal => Given::Load,
    }
}

/// The smallest number of straight pieces whose misfit is within the noise, or one more than [`PIECES`].
fn pieces_needed(times: &[f64], values: &[f64], variances: &[f64]) -> usize {
    let every = times.len().div_ceil(ROWS);
    let pick = |column: &[f64]| column.iter().copied().step_by(every).collect::<Vec<f64>>();
    let [t, y, noise] = [times, values, variances].map(pick);
    let n = t.len() as f64;
    let largest = y.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    // The noise itself is only known approximately; a sum of n squares scatters by sqrt(2/n).
    let noise = noise.iter().sum::<f64>() / n * (1.1 + 3.0 * (2.0 / n).sqrt());
    let enough = n * (noise + (STRAIGHT * largest).powi(2));
    let found = straight_pieces(&t, &y).iter().position(|left| *left <= enough);
    found.map_or(PIECES + 1, |place| place + 1)
}

/// Smallest sum of squares about 1, 2, ..., [`PIECES`] straight lines, each through separate rows, by dynamic programming.
fn straight_pieces(t: &[f64], y: &[f64]) -> Vec<f64> {
    let n = t.len();
    let sums = Sums::of(t, y);
    // Least squares of the first `end` rows in this number of pieces.
    let mut best: Vec<f64> = (0..=n).map(|end| sums.about_line(0, end)).collect();
    let mut left = vec![best[n]];
    for _ in 1..PIECES {
        best = (0..=n)
            .map(|end| {
                let last = (0..end).map(|start| best[start] + sums.about_line(start, end));
                last.fold(best[end], f64::min)
            })
            .collect();
        left.push(best[n]);
    }
    left
}

/// Running sums of 1, t, y, t², t y, y².
struct Sums(Vec<[f64; 5]>);

impl Sums {
    fn of(t: &[f64], y: &[f64]) -> Self {
        let mut sum = [0.0; 5];
        let mut sums = vec![sum];
        for (t, y) in t.iter().zip(y) {
            for (s, x) in sum.iter_mut().zip([*t, *y, t * t, t * y, y * y]) {
                *s += x;
            }
            sums.push(sum);
        }
        Sums(sums)
    }

    /// Sum of squares of the rows `start..end` about their straight line.
    fn about_line(&self, start: usize, end: usize) -> f64 {
        let n = (end - start) as f64;
        if n < 3.0 {
            return 0.0;
        }
        let [t, y, tt, ty, yy]: [f64; 5] = std::array::from_fn(|k| self.0[end][k] - self.0[start][k]);
        let (tt, ty, yy) = (tt - t * t / n, ty - t * y / n, yy - y * y / n);
        (yy - if tt > 0.0 { ty * ty / tt } else { 0.0 }).max(0.0)
    }
}
