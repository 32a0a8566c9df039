//! The load of the free sphere before the fit: a straight line over the depth, and where the contact begins.
//!
//! ```text
//! W = F0 + s (d - d0) + E* φ(d - d0)        φ: load of the indenter for E* = 1, 0 before first touch
//! ```
//!
//! is linear in E*, F0 and s for each depth of first touch d0. The best of all d0 of the record is therefore found without a start. A
//! record shows the line if its rows reject that all of them are in contact.

use super::least_squares::damped_step;
use super::spectrum::correlation;
use crate::material::dot;
use crate::numbers::extent;

/// What of the load of the free sphere is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Baseline {
    /// Nothing: the record does not show the free sphere, and its load is 0.
    Unknown,
    /// One load: the free rows are too few for a slope.
    Flat,
    /// A straight line over the depth.
    Tilted,
}

/// A straight line: load at the depth 0 \[N\], and slope \[N/m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) load: f64,
    pub(crate) slope: f64,
}

impl Line {
    pub(crate) const ZERO: Line = Line { load: 0.0, slope: 0.0 };

    pub(crate) fn at(&self, depth: f64) -> f64 {
        self.load + self.slope * depth
    }

    /// Least squares.
    pub(crate) fn through(rows: &[[f64; 2]]) -> Self {
        let n = rows.len() as f64;
        let [load, depth] = [0, 1].map(|k| rows.iter().map(|row| row[k]).sum::<f64>() / n);
        let [mut along, mut squares] = [0.0; 2];
        for [w, d] in rows {
            along += (w - load) * (d - depth);
            squares += (d - depth).powi(2);
        }
        let slope = if squares > 0.0 { along / squares } else { 0.0 };
        Line { load: load - slope * depth, slope }
    }
}

/// Where an elastic curve begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) baseline: Baseline,
    pub(crate) modulus: f64,
    pub(crate) touch: f64,
    pub(crate) line: Line,
}

/// Rows of the search at most: means of neighbours of a longer branch.
const MOST: usize = 20_000;
/// Depths of first touch that are tried, and how often the best of them is looked for more closely.
const TRIED: usize = 80;
const CLOSER: usize = 4;
/// Smallest number of free rows and of rows in contact.
const FREE: usize = 5;
const PRESSED: usize = 10;
/// Growth of the sum of squares, in variances of a row, that rejects a contact from the first row on.
const REJECTED: f64 = 20.0;
/// Lengths of the contact that a first touch may be before the first row of a search without a baseline.
const BEFORE: f64 = 2.0;

/// The best elastic curve through rows (load, depth); `unit` is the load \[m²\] over the depth from first touch for E* = 1. `None` if no load grows with
/// the depth.
pub(crate) fn start(unit: &dyn Fn(f64) -> f64, rows: &[[f64; 2]]) -> Option<Start> {
    let count = rows.len().div_ceil(MOST);
    let means = rows
        .chunks(count)
        .map(|rows| [0, 1].map(|k| rows.iter().map(|r| r[k]).sum::<f64>() / rows.len() as f64));
    let rows: Vec<[f64; 2]> = means.collect();
    let mut depths: Vec<f64> = rows.iter().map(|row| row[1]).collect();
    depths.sort_by(f64::total_cmp);
    let n = depths.len();
    let (first, last) = (depths[FREE.min(n - 1)], depths[n.saturating_sub(PRESSED)]);
    for baseline in [Baseline::Tilted, Baseline::Flat] {
        let search = Search { unit, rows: &rows, baseline };
        let Some(best) = search.best([first, last]) else { continue };
        let all = search.fit(depths[0]).map_or(f64::INFINITY, |fit| fit.squares);
        let variance = best.squares / (n as f64 - 4.0) * correlation(&best.residuals);
        if best.start.touch > first && all - best.squares > REJECTED * variance {
            return Some(best.start);
        }
    }
    let [low, high] = extent(depths.iter().copied());
    let search = Search { unit, rows: &rows, baseline: Baseline::Unknown };
    search.best([low - BEFORE * (high - low), last]).map(|best| best.start)
}

struct Search<'a> {
    unit: &'a dyn Fn(f64) -> f64,
    rows: &'a [[f64; 2]],
    baseline: Baseline,
}

struct Fit {
    start: Start,
    squares: f64,
    residuals: Vec<f64>,
}

impl Search<'_> {
    /// The best first touch between these depths.
    fn best(&self, [mut low, mut high]: [f64; 2]) -> Option<Fit> {
        let mut best: Option<Fit> = None;
        for _ in 0..CLOSER {
            let step = (high - low) / TRIED as f64;
            let tried = (0..=TRIED).filter_map(|k| self.fit(low + step * k as f64));
            best = tried.chain(best).min_by(|a, b| a.squares.total_cmp(&b.squares));
            let touch = best.as_ref()?.start.touch;
            (low, high) = ((touch - step).max(low), (touch + step).min(high));
        }
        best
    }

    /// Least squares for this first touch; `None` if the body is not stiffer than nothing.
    fn fit(&self, touch: f64) -> Option<Fit> {
        let columns: Vec<Vec<f64>> = {
            let unit = self.rows.iter().map(|row| (self.unit)((row[1] - touch).max(0.0)));
            let ones = vec![1.0; self.rows.len()];
            let depths = self.rows.iter().map(|row| row[1] - touch);
            match self.baseline {
                Baseline::Unknown => vec![unit.collect()],
                Baseline::Flat => vec![unit.collect(), ones],
                Baseline::Tilted => vec![unit.collect(), ones, depths.collect()],
            }
        };
        let norms: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
        let scaled: Vec<Vec<f64>> = columns
            .iter()
            .zip(&norms)
            .map(|(column, norm)| column.iter().map(|x| x / norm).collect())
            .collect();
        let loads: Vec<f64> = self.rows.iter().map(|row| -row[0]).collect();
        let found = damped_step(&scaled, &loads, 0.0)?;
        let mut residuals = loads;
        for (column, x) in scaled.iter().zip(&found) {
            residuals.iter_mut().zip(column).for_each(|(r, c)| *r += x * c);
        }
        let number = |k: usize| found.get(k).map_or(0.0, |x| x / norms[k]);
        let [modulus, load, slope] = [0, 1, 2].map(number);
        let line = Line { load: load - slope * touch, slope };
        let start = Start { baseline: self.baseline, modulus, touch, line };
        let squares = dot(&residuals, &residuals);
        (modulus > 0.0 && modulus.is_finite()).then_some(Fit { start, squares, residuals })
    }
}
