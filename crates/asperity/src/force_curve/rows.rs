//! The rows of a branch: which are in contact and which are free, and the noise of both channels.

use super::{Branch, ForceModel, ForceOptions, ForceRecord, invalid};
use crate::error::{Result, require};
use crate::indentation::noise;
use crate::numbers::{self, extent};

/// Smallest number of rows of the branch, and of rows that are free before the baseline is fitted.
const FEWEST: usize = 20;
const FREE: usize = 5;
const MOST: usize = 1_000_000;
/// The fit takes means of neighbouring rows, so that no more than this number are left: between them the curve is straight.
const FITTED: usize = 1000;
/// Larger numbers are not plausible measurements.
const LARGEST: f64 = 1e30;
/// Standard deviations of the load beyond which an attraction is not noise: a million normal numbers reach 5.
const SEEN: f64 = 5.0;
/// Free rows drift by less than this fraction of the attraction.
const FLAT: f64 = 0.1;
/// Noise below this fraction of the range of a channel is that of rounding.
const EXACT: f64 = 1e-7;
/// No channel is taken as known so many times as well as the other one, each over its range: of exact depths every row near pull-off would
/// bound the curve, though it lies anywhere between two rows.
const BETTER: f64 = 3.0;

/// The rows of the branch, from the largest load to the free sphere.
pub(super) struct Rows {
    /// (load, depth) \[N, m\]
    pub(super) contact: Vec<[f64; 2]>,
    /// Loads of the free sphere; empty where the record does not show it, or for Hertz, whose curve goes on to free rows.
    pub(super) free: Vec<f64>,
    /// Whether the load of the free sphere can be fitted.
    pub(super) baseline: bool,
    /// Standard deviations of load and depth.
    pub(super) noise: [f64; 2],
    /// Largest less smallest load and depth in contact.
    pub(super) spans: [f64; 2],
    /// How much the load of the free sphere changes over its rows \[N\]; 0 where that may be noise.
    pub(super) drift: f64,
    /// Smallest and largest depth in contact.
    pub(super) depths: [f64; 2],
    /// Load of the free sphere, to begin with.
    pub(super) rest: f64,
    numbers: Vec<usize>,
}

/// Whether a branch has loads below zero beyond its noise.
fn is_pulled(loads: &[f64]) -> bool {
    let steps: Vec<f64> = (0..loads.len()).map(|k| k as f64).collect();
    let variances = noise::variances(&steps, loads);
    let noise = (variances.iter().sum::<f64>() / variances.len() as f64).sqrt();
    loads.iter().any(|load| *load < -SEEN * noise)
}

impl Rows {
    pub(super) fn new(record: &ForceRecord, options: &ForceOptions) -> Result<Self> {
        let n = record.loads.len();
        require(
            record.depths.len() == n,
            "number of depths",
            record.depths.len(),
            format!("{n}, that of the loads"),
        )?;
        require(
            (FEWEST..=MOST).contains(&n),
            "number of rows of the record",
            n,
            format!("between {FEWEST} and {MOST}"),
        )?;
        for (name, column) in [("load", record.loads), ("depth", record.depths)] {
            if let Some((row, value)) =
                column.iter().enumerate().find(|(_, x)| x.is_nan() || x.abs() > LARGEST)
            {
                return invalid(&format!("{name} of row {}", row + 1), value, "a finite number");
            }
        }
        let loads = record.loads;
        let top = (0..n).max_by(|a, b| loads[*a].total_cmp(&loads[*b])).unwrap_or(0);
        let numbers: Vec<usize> = match options.branch {
            Branch::Retraction => (top..n).collect(),
            Branch::Approach => (0..=top).rev().collect(),
        };
        let (part, other, rows) = match options.branch {
            Branch::Retraction => ("after", "approach", &loads[..=top]),
            Branch::Approach => ("before", "retraction", &loads[top..]),
        };
        // Where the other one has rows enough, and the attraction that the model needs.
        let help = match rows.len() >= FEWEST && (options.model == ForceModel::Hertz || is_pulled(rows)) {
            true => format!("; the other branch is `{other}`"),
            false => String::new(),
        };
        require(
            numbers.len() >= FEWEST,
            "number of rows of the branch",
            format!("{} {part} the largest load", numbers.len()),
            format!("at least {FEWEST}{help}"),
        )?;
        let pick = |column: &[f64]| numbers.iter().map(|row| column[*row]).collect::<Vec<_>>();
        let (loads, depths) = (pick(record.loads), pick(record.depths));
        let steps: Vec<f64> = (0..loads.len()).map(|k| k as f64).collect();
        let ranges = [&loads, &depths].map(|values| {
            let [low, high] = extent(values.iter().copied());
            high - low
        });
        let share = |k: usize, values: &[f64]| {
            let variances = noise::variances(&steps, values);
            ((variances.iter().sum::<f64>() / variances.len() as f64).sqrt() / ranges[k]).max(EXACT)
        };
        let shares = [share(0, &loads), share(1, &depths)];
        let noise = [0, 1].map(|k| ranges[k] * shares[k].max(shares[1 - k] / BETTER));
        require(
            noise[0] > 0.0 && noise[1] > 0.0,
            "load and depth of the branch",
            "constant",
            "a sphere that is pressed and taken off",
        )?;
        let adhesive = options.model != ForceModel::Hertz;
        let (last, rest, baseline) =
            if adhesive { split(&loads, noise[0]) } else { free_of_hertz(&loads, noise[0]) };
        let contact: Vec<[f64; 2]> = loads.iter().zip(&depths).take(last).map(|(w, d)| [*w, *d]).collect();
        let free = loads[last..].to_vec();
        let smallest = contact.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min);
        if adhesive && rest - smallest < SEEN * noise[0] {
            return invalid(
                "attraction of the force curve",
                format!("{:.3e} N at most, with a noise of {:.3e} N", rest - smallest, noise[0]),
                format!(
                    "at least {SEEN} times the noise; where the sphere is pulled, the load must be negative: turn the sign of the column; without adhesion use the model `hertz`"
                ),
            );
        }
        let [loads, depths] = [0, 1].map(|k| extent(contact.iter().map(|row| row[k])));
        let [of_loads, of_depths] = [loads, depths].map(|[low, high]| high - low);
        require(
            contact.len() >= FEWEST / 2 && of_loads > 3.0 * noise[0] && of_depths > 0.0,
            "number of rows in contact",
            contact.len(),
            format!("at least {}, with loads above the noise", FEWEST / 2),
        )?;
        let numbers = numbers.into_iter().take(contact.len() + free.len()).collect();
        let third = free.len() / 3;
        // The means of the first and the last third are two thirds of the rows apart.
        let drift = if third > 0 { 1.5 * drift(&free, third) } else { 0.0 };
        let drift = if drift > 1.5 * scatter(noise[0], third) { drift } else { 0.0 };
        Ok(Rows {
            contact,
            free,
            baseline,
            noise,
            spans: [of_loads, of_depths],
            depths,
            rest,
            drift,
            numbers,
        })
    }

    /// Means of neighbouring rows, as many as are fitted.
    pub(super) fn averaged(&self) -> Rows {
        let count = (self.contact.len() + self.free.len()).div_ceil(FITTED);
        let contact =
            self.contact.chunks(count).map(|rows| [0, 1].map(|k| mean_of(rows.iter().map(|row| row[k]))));
        Rows {
            contact: contact.collect(),
            free: self.free.chunks(count).map(mean).collect(),
            noise: self.noise.map(|deviation| deviation / (count as f64).sqrt()),
            numbers: vec![],
            ..*self
        }
    }

    /// Loads and depths with the scale of the deflection larger by this fraction.
    pub(super) fn with_deflection(&self, change: f64, stiffness: f64) -> Rows {
        let moved = self.contact.iter().map(|[w, d]| [w * (1.0 + change), d - change * w / stiffness]);
        let contact: Vec<[f64; 2]> = moved.collect();
        let depths = extent(contact.iter().map(|row| row[1]));
        Rows {
            contact,
            depths,
            free: self.free.iter().map(|w| w * (1.0 + change)).collect(),
            numbers: vec![],
            rest: self.rest * (1.0 + change),
            ..*self
        }
    }

    /// About this number of rows, evenly spaced; `None` where there are few.
    pub(super) fn thinned(&self, count: usize) -> Option<Rows> {
        let every = self.contact.len() / count;
        let thin = |length: usize| (0..length).step_by(every.max(1));
        (every > 1).then(|| Rows {
            contact: thin(self.contact.len()).map(|row| self.contact[row]).collect(),
            free: thin(self.free.len()).map(|row| self.free[row]).collect(),
            numbers: vec![],
            ..*self
        })
    }

    pub(super) fn numbers(&self) -> Vec<usize> {
        self.numbers.clone()
    }

    pub(super) fn smallest_load(&self) -> f64 {
        self.contact.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min)
    }
}

/// The number of rows in contact, the load of the free sphere and whether the record shows it: from the last row below half of the pull-off
/// force on the sphere is free. On all stable branches the attraction is more than half of its largest value (JKR: 5/9).
fn split(loads: &[f64], noise: f64) -> (usize, f64, bool) {
    let n = loads.len();
    let lowest = (0..n).min_by(|a, b| loads[*a].total_cmp(&loads[*b])).unwrap_or(0);
    let rest = median(&loads[lowest + (n - lowest) / 2..]);
    let half = 0.5 * (rest + loads[lowest]);
    let last = (0..n).rev().find(|row| loads[*row] < half).map_or(n, |row| row + 1);
    let free = &loads[last..];
    let third = free.len() / 3;
    // A branch that only ends in the record goes on rising.
    let flat = || drift(free, third) < FLAT * (rest - loads[lowest]) + scatter(noise, third);
    if free.len() >= FREE && third > 0 && flat() { (last, median(free), true) } else { (n, 0.0, false) }
}

/// All rows: the curve goes on to the free sphere. Its load is fitted where the last eighth of the rows is flat.
fn free_of_hertz(loads: &[f64], noise: f64) -> (usize, f64, bool) {
    let n = loads.len();
    let end = &loads[n - (n / 8).max(FREE)..];
    let third = (end.len() / 3).max(1);
    // A contact that lasts to the end would still lose more of the load there: (1/8)^(3/2) is 4 %.
    let flat = drift(end, third) < 0.01 * (loads[0] - median(end)) + scatter(noise, third);
    if flat { (n, median(end), true) } else { (n, 0.0, false) }
}

/// Mean of the first rows less that of the last.
fn drift(values: &[f64], count: usize) -> f64 {
    (mean(&values[..count]) - mean(&values[values.len() - count..])).abs()
}

/// Three standard deviations of the difference of two means.
fn scatter(noise: f64, count: usize) -> f64 {
    3.0 * noise * (2.0 / count.max(1) as f64).sqrt()
}

fn mean(values: &[f64]) -> f64 {
    mean_of(values.iter().copied())
}

fn mean_of(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn median(values: &[f64]) -> f64 {
    numbers::median(&mut values.to_vec())
}
