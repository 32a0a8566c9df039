//! Long records: rows are averaged where they lie on a straight line, and kept one by one where a channel bends.
//!
//! **Pieces.** Each 16 neighbouring rows are a piece. Two pieces of one size that follow each other become one as long as both
//! are straight and the joined one is. Straight means for n rows whose four quarters have the means y_q at the times t_q
//!
//! ```text
//! χ² = Σ_q (y_q - line(t_q))²/(4 σ²/n)     two degrees of freedom     χ² ≤ LIMIT
//! ```
//!
//! with the line of least squares through the four points and the variance σ² of the noise of a row. A piece of 16 rows is
//! straight if its halves and quarters are straight too, so that no short bend is hidden in its noise.
//!
//! **Blocks.** A straight piece is divided into 16 blocks; of other pieces each row is a block. The mean of a block of length h
//! differs from the value at its mean time by y'' h²/24. In a piece the noise may hide a curvature that moves the mean of the
//! whole by sqrt(LIMIT) (4/3) σ/sqrt(n); in a block this is 256 times less, 0.03 of the standard deviation of the mean of the
//! piece. The mean of n rows has the variance σ²/n.

use std::ops::Range;

/// Rows of the smallest piece, and blocks of a piece.
const PARTS: usize = 16;
/// Largest χ² of a straight piece: exceeded by chance once in 270 000.
const LIMIT: f64 = 25.0;
/// Smallest standard deviation of the mean of rows, over the largest value.
const LEAST: f64 = 1e-4;

/// A channel of a record: its values and the variances of their noise.
pub(super) type Channel<'a> = (&'a [f64], &'a [f64]);

/// A straight piece, or rows that are none.
struct Piece {
    rows: Range<usize>,
    straight: bool,
}

/// The rows of each block: at most about `most` blocks. The first row and the last are blocks of their own.
pub(super) fn blocks(times: &[f64], channels: &[Channel], most: usize) -> Vec<Range<usize>> {
    let sums: Vec<Sums> = channels.iter().map(|channel| Sums::of(times, *channel)).collect();
    let last = times.len() - 1;
    let mut limit = LIMIT;
    loop {
        let first = 0..1;
        let mut blocks = vec![first];
        for piece in pieces(&sums, 1..last, limit) {
            let parts = if piece.straight { PARTS.min(piece.rows.len()) } else { piece.rows.len() };
            let at = |part: usize| piece.rows.start + part * piece.rows.len() / parts;
            blocks.extend((0..parts).map(|part| at(part)..at(part + 1)));
        }
        blocks.push(last..last + 1);
        // More blocks than wanted: the noise is smaller than the digits, or it is not white. Accept more curvature.
        if blocks.len() <= most || limit.is_infinite() {
            return blocks;
        }
        limit *= 4.0;
    }
}

/// The mean of a column in each block.
pub(super) fn means(column: &[f64], blocks: &[Range<usize>]) -> Vec<f64> {
    let mean = |rows: &Range<usize>| column[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
    blocks.iter().map(mean).collect()
}

/// A channel without most of its noise: the line of least squares through each straight piece, and the rows elsewhere.
pub(super) fn smoothed(times: &[f64], channel: Channel) -> Vec<f64> {
    let mut smooth = channel.0.to_vec();
    let sums = [Sums::of(times, channel)];
    for piece in pieces(&sums, 1..times.len(), LIMIT).into_iter().filter(|piece| piece.straight) {
        let [t, y, tt, ty] = sums[0].moments(&piece.rows);
        let slope = if tt > 0.0 { ty / tt } else { 0.0 };
        piece.rows.for_each(|row| smooth[row] = y + slope * (times[row] - t));
    }
    smooth
}

fn pieces(sums: &[Sums], rows: Range<usize>, limit: f64) -> Vec<Piece> {
    let straight = |rows: &Range<usize>| sums.iter().all(|sums| sums.bend(rows) <= limit);
    let mut pieces: Vec<Piece> = vec![];
    for start in rows.clone().step_by(PARTS) {
        let end = (start + PARTS).min(rows.end);
        let within =
            [4, 8, PARTS].into_iter().flat_map(|n| (start..end).step_by(n).map(move |a| a..(a + n).min(end)));
        pieces.push(Piece { rows: start..end, straight: within.into_iter().all(|rows| straight(&rows)) });
        while let [.., left, right] = &pieces[..] {
            let joined = left.rows.start..right.rows.end;
            let alike = left.straight && right.straight && left.rows.len() == right.rows.len();
            if !(alike && straight(&joined)) {
                break;
            }
            pieces.truncate(pieces.len() - 2);
            pieces.push(Piece { rows: joined, straight: true });
        }
    }
    pieces
}

/// Running sums of t, y, t², t y and the variance, of times and values less the first ones.
struct Sums {
    sums: Vec<[f64; 5]>,
    start: [f64; 2],
    least: f64,
}

impl Sums {
    fn of(times: &[f64], (values, variances): Channel) -> Self {
        let start = [times[0], values[0]];
        let mut sum = [0.0; 5];
        let mut sums = vec![sum];
        for ((t, y), variance) in times.iter().zip(values).zip(variances) {
            let (t, y) = (t - start[0], y - start[1]);
            for (s, x) in sum.iter_mut().zip([t, y, t * t, t * y, *variance]) {
                *s += x;
            }
            sums.push(sum);
        }
        let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        Sums { sums, start, least: (LEAST * largest).powi(2) }
    }

    fn mean(&self, rows: &Range<usize>, k: usize) -> f64 {
        (self.sums[rows.end][k] - self.sums[rows.start][k]) / rows.len() as f64
    }

    /// Means of t and y, variance of t, covariance of t and y.
    fn moments(&self, rows: &Range<usize>) -> [f64; 4] {
        let [t, y, tt, ty] = [0, 1, 2, 3].map(|k| self.mean(rows, k));
        [t + self.start[0], y + self.start[1], tt - t * t, ty - t * y]
    }

    /// χ² of the four quarters about their straight line; 0 of fewer than four rows.
    fn bend(&self, rows: &Range<usize>) -> f64 {
        let n = rows.len();
        if n < 4 {
            return 0.0;
        }
        let quarter = |q: usize| rows.start + q * n / 4..rows.start + (q + 1) * n / 4;
        let points = [0, 1, 2, 3].map(|q| [self.mean(&quarter(q), 0), self.mean(&quarter(q), 1)]);
        let centre = [0, 1].map(|k| points.iter().map(|point| point[k]).sum::<f64>() / 4.0);
        let [tt, ty, yy] = [[0, 0], [0, 1], [1, 1]].map(|[a, b]| {
            points.iter().map(|point| (point[a] - centre[a]) * (point[b] - centre[b])).sum::<f64>()
        });
        let left = yy - if tt > 0.0 { ty * ty / tt } else { 0.0 };
        left.max(0.0) / (4.0 * self.mean(rows, 4) / n as f64 + self.least)
    }
}
