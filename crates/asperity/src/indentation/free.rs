//! The load of the free indenter before first touch: a straight line over the depth that is taken off the record.
//!
//! An offset of the load is one of the modulus: at the beginning of a ramp it is larger than the load of the contact. The rows before first
//! touch give the line by least squares; what they do not know about it is in the intervals (see [`super::stated`]).

use super::baseline::{Baseline, Line, Start, start};
use super::noise;
use super::spectrum::correlation;
use super::{IndentationRecord, Interval, WIDTH};
use crate::reference::MdrProfile;

/// Smallest number of free rows, and of rows up to the largest load where first touch is looked for.
const FREE: usize = 5;
const FEWEST: usize = 20;
/// Load of the end of the rows in which first touch is looked for, over the largest.
const PRESSED: f64 = 0.9;
/// Part of the largest depth before first touch within which rows are not taken as free, where first touch is fitted; else standard deviations.
const MARGIN: f64 = 0.1;
const NOISE: f64 = 3.0;
/// Free rows over this part of the largest depth show the slope.
const LONG: f64 = 0.2;

/// What is taken off a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Free {
    /// Depth of first touch in the zero of the record, where it is fitted: the fit begins there \[m\].
    pub(super) shift: f64,
    /// Load over the depth from there \[N\].
    line: Line,
    /// Mean depth of the free rows; there the errors of load and slope are independent.
    centre: f64,
    /// Standard deviations of the load at the centre \[N\] and of the slope \[N/m\].
    pub(super) deviations: [f64; 2],
    /// Number of rows in the beginning that are free.
    pub(super) rows: usize,
}

impl Free {
    const NONE: Free = Free { shift: 0.0, line: Line::ZERO, centre: 0.0, deviations: [0.0; 2], rows: 0 };

    /// From the rows before first touch, which is at the depth 0 or is looked for.
    pub(super) fn of(profile: MdrProfile, record: &IndentationRecord, fit_touch: bool) -> Self {
        let (loads, depths) = (record.loads, record.depths);
        let largest = loads.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let end = loads.iter().position(|load| *load >= PRESSED * largest).map_or(0, |row| row + 1);
        let (shift, bound) = match fit_touch {
            false => (0.0, -NOISE * noise::deviation(record.times, depths)),
            true if end < FEWEST => return Free::NONE,
            true => {
                let rows: Vec<[f64; 2]> = (0..end).rev().map(|row| [loads[row], depths[row]]).collect();
                let Some(Start { baseline, touch, .. }) = start(&|depth| profile.unit_load(depth), &rows)
                else {
                    return Free::NONE;
                };
                if baseline == Baseline::Unknown {
                    return Free::NONE;
                }
                let deepest = depths[..end].iter().copied().fold(touch, f64::max);
                (touch, -MARGIN * (deepest - touch))
            }
        };
        let rows = depths[..end].iter().position(|depth| depth - shift >= bound).unwrap_or(end);
        let free: Vec<[f64; 2]> = (0..rows).map(|row| [loads[row], depths[row] - shift]).collect();
        let deepest = depths.iter().copied().fold(shift, f64::max) - shift;
        Free { shift, rows, ..Free::through(&free, deepest) }
    }

    /// Least squares of these rows (load, depth).
    fn through(free: &[[f64; 2]], deepest: f64) -> Self {
        let n = free.len() as f64;
        if free.len() < FREE {
            return Free::NONE;
        }
        let [load, centre] = [0, 1].map(|k| free.iter().map(|row| row[k]).sum::<f64>() / n);
        let depths = || free.iter().map(|row| row[1]);
        let length = depths().fold(f64::NEG_INFINITY, f64::max) - depths().fold(f64::INFINITY, f64::min);
        let tilted = free.len() >= 2 * FREE && length > LONG * deepest;
        let line = if tilted { Line::through(free) } else { Line { load, slope: 0.0 } };
        let away: Vec<f64> = free.iter().map(|row| row[0] - line.at(row[1])).collect();
        let squares: f64 = away.iter().map(|x| x * x).sum();
        let variance = squares / (n - if tilted { 2.0 } else { 1.0 }) * correlation(&away);
        let spread: f64 = depths().map(|depth| (depth - centre).powi(2)).sum();
        let of_slope = if tilted { (variance / spread).sqrt() } else { 0.0 };
        Free { line, centre, deviations: [(variance / n).sqrt(), of_slope], ..Free::NONE }
    }

    /// Load of the free indenter at a depth from first touch.
    pub(super) fn load(&self, depth: f64) -> f64 {
        self.line.at(depth)
    }

    /// One standard deviation of that load by its offset (part 0) or its slope.
    pub(super) fn change(&self, part: usize, depth: f64) -> f64 {
        self.deviations[part] * if part == 0 { 1.0 } else { depth - self.centre }
    }

    /// Loads without the line, and depths from first touch.
    pub(super) fn taken_off(&self, record: &IndentationRecord) -> [Vec<f64>; 2] {
        let depths: Vec<f64> = record.depths.iter().map(|depth| depth - self.shift).collect();
        let loads = record.loads.iter().zip(&depths).map(|(load, depth)| load - self.load(*depth));
        [loads.collect(), depths]
    }

    /// The same loads, which are 0 in free rows: there a given load would press the body by its noise.
    pub(super) fn unloaded(&self, mut loads: Vec<f64>) -> Vec<f64> {
        loads[..self.rows].fill(0.0);
        loads
    }

    /// First touch in the zero of the record, the load of the free indenter there, and its slope.
    pub(super) fn intervals(&self, touch: Interval) -> [Interval; 3] {
        let moved = |x: f64| x + self.shift;
        let Interval { value, low, high, determined } = touch;
        let about = |value: f64, deviation: f64| {
            let half = WIDTH * deviation;
            Interval { value, low: value - half, high: value + half, determined: true }
        };
        let deviation = self.change(0, value).hypot(self.change(1, value));
        [
            Interval { value: moved(value), low: moved(low), high: moved(high), determined },
            about(self.load(value), deviation),
            about(self.line.slope, self.deviations[1]),
        ]
    }
}
