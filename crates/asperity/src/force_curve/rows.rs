//! The rows of a branch: which are in contact and which are free, and the noise of both channels.

use super::body::Body;
use super::{Branch, ForceModel, ForceOptions, ForceRecord, Weights, invalid, turned};
use crate::error::{Result, require};
use crate::indentation::{Baseline, Line, Start, correlation, noise, start};
use crate::material::dot;
use crate::numbers::extent;
use crate::reference::MdrProfile;

/// Smallest number of rows of the branch, and of rows that are free before the baseline is fitted.
const FEWEST: usize = 20;
const FREE: usize = 5;
const MOST: usize = 1_000_000;
/// The fit takes means of neighbouring rows, so that no more than these numbers of rows in contact and of free ones are left: between them the
/// curve is straight.
const FITTED: [usize; 2] = [700, 300];
/// Larger numbers are not plausible measurements.
const LARGEST: f64 = 1e30;
/// Standard deviations of the load beyond which an attraction is not noise: a million normal numbers reach 5.
const SEEN: f64 = 5.0;
/// Free rows drift by less than this fraction of the attraction.
const FLAT: f64 = 0.1;
/// Noise below this fraction of the range of a channel is that of rounding.
const EXACT: f64 = 1e-7;
/// With adhesion, no channel is taken as known so many times as well as the other one, each over its range: of exact depths every row near
/// pull-off would bound the curve, though it lies anywhere between two rows.
const BETTER: f64 = 3.0;
/// A value this number of standard deviations and this part of the range below the largest belongs to a pause, which has more rows than the first
/// number, and more than this number of times those of twice that way further on.
const PAUSED: [f64; 2] = [4.0, 0.01];
const LONGER: [usize; 2] = [10, 4];
/// Rows this fraction of the largest depth before first touch are free in any case.
const MARGIN: f64 = 0.1;
/// Free rows over this fraction of the depths in contact show the slope of the baseline.
const LONG: f64 = 0.2;

/// The rows of the branch, from the largest load to the free sphere.
pub(super) struct Rows {
    /// (load, depth) \[N, m\]
    pub(super) contact: Vec<[f64; 2]>,
    /// The same of the free sphere; empty where the record does not show it.
    pub(super) free: Vec<[f64; 2]>,
    /// What of the load of the free sphere is fitted, and where the search begins.
    pub(super) baseline: Baseline,
    pub(super) line: Line,
    /// Where the search for a curve without adhesion begins.
    pub(super) start: Option<Start>,
    /// Standard deviations of load and depth in contact, and of the load of the free sphere.
    pub(super) noise: [f64; 2],
    pub(super) free_noise: f64,
    /// Largest less smallest load and depth in contact.
    pub(super) spans: [f64; 2],
    /// How much the load of the free sphere bends away from a straight line over its rows \[N\]; 0 where that may be noise.
    pub(super) bend: f64,
    /// Smallest and largest depth in contact.
    pub(super) depths: [f64; 2],
    /// Number of rows of a pause that are left out.
    pub(super) paused: usize,
    numbers: Vec<usize>,
}

/// Whether a branch has loads below zero beyond its noise.
fn is_pulled(loads: &[f64]) -> bool {
    let noise = deviation(loads);
    loads.iter().any(|load| *load < -SEEN * noise)
}

/// Standard deviation of the noise of a column.
fn deviation(values: &[f64]) -> f64 {
    let steps: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
    noise::deviation(&steps, values)
}

/// Numbers of the rows of the branch, from the largest load on, and how many rows of a pause are left out there.
fn branch(record: &ForceRecord, options: &ForceOptions) -> Result<(Vec<usize>, usize)> {
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
        if let Some((row, value)) = column.iter().enumerate().find(|(_, x)| x.is_nan() || x.abs() > LARGEST) {
            return invalid(&format!("{name} of row {}", row + 1), value, "a finite number");
        }
    }
    let loads = record.loads;
    let top = (0..n).max_by(|a, b| loads[*a].total_cmp(&loads[*b])).unwrap_or(0);
    let all: Vec<usize> = match options.branch {
        Branch::Retraction => (top..n).collect(),
        Branch::Approach => (0..=top).rev().collect(),
    };
    let paused = pause(&all, record, options.branch);
    let numbers = all[paused..].to_vec();
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
    Ok((numbers, paused))
}

/// Number of the first rows of a branch that belong to a pause: the load (before a retraction the depth) stays near its largest value longer than
/// the branch takes for the same way. A body that relaxes or creeps there is no elastic one.
fn pause(numbers: &[usize], record: &ForceRecord, branch: Branch) -> usize {
    let column = if branch == Branch::Retraction { record.depths } else { record.loads };
    let own: Vec<f64> = numbers.iter().map(|row| column[*row]).collect();
    let n = own.len();
    if n < FEWEST {
        return 0;
    }
    let most = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let [low, high] = extent(own.iter().copied());
    let steps: Vec<f64> = (0..n).map(|k| k as f64).collect();
    let noise = noise::variances(&steps, &own).into_iter().fold(0.0, f64::max).sqrt();
    let near = PAUSED[0] * noise + PAUSED[1] * (high - low);
    let end = own.iter().rposition(|x| *x >= most - near).unwrap_or(0);
    let next = own.iter().rposition(|x| *x >= most - 3.0 * near).unwrap_or(n);
    // What remains is a branch.
    let pauses = end >= LONGER[0] && end > LONGER[1] * (next - end) && n - end >= FEWEST;
    if pauses { end } else { 0 }
}

impl Rows {
    pub(super) fn new(
        profile: MdrProfile,
        record: &ForceRecord,
        options: &ForceOptions,
    ) -> Result<(Self, Body)> {
        let (numbers, paused) = branch(record, options)?;
        let rows: Vec<[f64; 2]> =
            numbers.iter().map(|row| [record.loads[*row], record.depths[*row]]).collect();
        require_direction(&rows)?;
        let adhesive = options.model != ForceModel::Hertz;
        let (body, found) = match adhesive {
            true => (Body::half_space(profile), split(&rows)),
            false => split_elastic(profile, &rows, options)?,
        };
        let Split { last, mut baseline, line, start } = found;
        let contact = rows[..last].to_vec();
        let free = rows[last..].to_vec();
        let [loads, depths] = [0, 1].map(|k| extent(contact.iter().map(|row| row[k])));
        let spans = [loads, depths].map(|[low, high]| high - low);
        let noise = noise_of(&contact, spans, adhesive);
        require(
            noise[0] > 0.0 && noise[1] > 0.0,
            "load and depth of the branch",
            "constant",
            "a sphere that is pressed and taken off",
        )?;
        let free_noise = match free.len() >= FEWEST {
            true => deviation(&free.iter().map(|row| row[0]).collect::<Vec<_>>()).max(EXACT * spans[0]),
            false => noise[0],
        };
        let away = |row: &[f64; 2]| row[0] - line.at(row[1]);
        let smallest = contact.iter().map(away).fold(f64::INFINITY, f64::min);
        if adhesive && -smallest < SEEN * noise[0] {
            return invalid(
                "attraction of the force curve",
                format!("{:.3e} N at most, with a noise of {:.3e} N", -smallest, noise[0]),
                format!(
                    "at least {SEEN} times the noise; where the sphere is pulled, the load must be negative: turn the sign of the column; without adhesion use the model `hertz`"
                ),
            );
        }
        require(
            contact.len() >= FEWEST / 2 && spans[0] > 3.0 * noise[0] && spans[1] > 0.0,
            "number of rows in contact",
            contact.len(),
            format!("at least {}, with loads above the noise", FEWEST / 2),
        )?;
        let [low, high] = extent(free.iter().map(|row| row[1]));
        if adhesive && baseline == Baseline::Tilted && high - low < LONG * spans[1] {
            baseline = Baseline::Flat;
        }
        let bend = bend(&free, baseline);
        let rows = Rows {
            contact,
            free,
            baseline,
            line,
            start,
            noise,
            free_noise,
            spans,
            bend,
            depths,
            paused,
            numbers,
        };
        Ok((rows, body))
    }

    /// Means of neighbouring rows, as many as are fitted.
    pub(super) fn averaged(&self) -> Rows {
        let count = |rows: &[[f64; 2]], most: usize| rows.len().div_ceil(most).max(1);
        let [of_contact, of_free] = [count(&self.contact, FITTED[0]), count(&self.free, FITTED[1])];
        let means = |rows: &[[f64; 2]], count: usize| {
            let means = rows.chunks(count).map(|rows| [0, 1].map(|k| mean_of(rows.iter().map(|row| row[k]))));
            means.collect::<Vec<_>>()
        };
        let smaller = |deviation: f64, count: usize| deviation / (count as f64).sqrt();
        Rows {
            contact: means(&self.contact, of_contact),
            free: means(&self.free, of_free),
            noise: self.noise.map(|deviation| smaller(deviation, of_contact)),
            free_noise: smaller(self.free_noise, of_free),
            numbers: vec![],
            ..*self
        }
    }

    /// The same rows with this many times the noise in contact and off it.
    pub(super) fn weighted(self, [contact, free]: [f64; 2]) -> Rows {
        Rows {
            noise: self.noise.map(|deviation| contact * deviation),
            free_noise: free * self.free_noise,
            ..self
        }
    }

    /// The same rows whose loads count alike, and whose depths are exact without adhesion.
    pub(super) fn alike(self, options: &ForceOptions) -> Rows {
        match options.weights {
            Weights::Noise => self,
            Weights::None => {
                let exact = options.model == ForceModel::Hertz;
                let of_depth = if exact { EXACT * self.spans[1] } else { self.noise[1] };
                Rows { noise: [self.noise[0], of_depth], free_noise: self.noise[0], ..self }
            }
        }
    }

    /// Loads and depths with the scale of the deflection larger by this fraction.
    pub(super) fn with_deflection(&self, change: f64, stiffness: f64) -> Rows {
        let move_all = |rows: &[[f64; 2]]| -> Vec<[f64; 2]> {
            rows.iter().map(|[w, d]| [w * (1.0 + change), d - change * w / stiffness]).collect()
        };
        let contact = move_all(&self.contact);
        let depths = extent(contact.iter().map(|row| row[1]));
        Rows { contact, depths, free: move_all(&self.free), numbers: vec![], ..*self }
    }

    pub(super) fn numbers(&self) -> Vec<usize> {
        self.numbers.clone()
    }

    /// Loads in contact without those of a free sphere.
    pub(super) fn pressed(&self, line: Line) -> impl Iterator<Item = f64> {
        self.contact.iter().map(move |row| row[0] - line.at(row[1]))
    }
}

/// Standard deviations of load and depth in contact.
fn noise_of(contact: &[[f64; 2]], spans: [f64; 2], adhesive: bool) -> [f64; 2] {
    let share = |k: usize| {
        let own = deviation(&contact.iter().map(|row| row[k]).collect::<Vec<_>>());
        if spans[k] > 0.0 { (own / spans[k]).max(EXACT) } else { 0.0 }
    };
    let shares = [share(0), share(1)];
    let better = if adhesive { BETTER } else { f64::INFINITY };
    [0, 1].map(|k| spans[k] * shares[k].max(shares[1 - k] / better))
}

/// Number of rows in contact, and the load of the free sphere.
struct Split {
    last: usize,
    baseline: Baseline,
    line: Line,
    start: Option<Start>,
}

/// Of a curve with pull-off: from the last row below half of the pull-off force on the sphere is free. On all stable branches the attraction
/// is more than half of its largest value (JKR: 5/9).
fn split(rows: &[[f64; 2]]) -> Split {
    let n = rows.len();
    let noise = deviation(&rows.iter().map(|row| row[0]).collect::<Vec<_>>());
    let line = free_end(rows, noise);
    let away: Vec<f64> = rows.iter().map(|row| row[0] - line.at(row[1])).collect();
    let lowest = (0..n).min_by(|a, b| away[*a].total_cmp(&away[*b])).unwrap_or(0);
    let last = (0..n).rev().find(|row| away[*row] < 0.5 * away[lowest]).map_or(n, |row| row + 1);
    let free = &rows[last..];
    let third = free.len() / 3;
    let unknown = Split { last: n, baseline: Baseline::Unknown, line: Line::ZERO, start: None };
    // A branch that only ends in the record goes on rising.
    let flat = |line: Line| {
        let away: Vec<f64> = free.iter().map(|row| row[0] - line.at(row[1])).collect();
        drift(&away, third) < FLAT * -away_of(&rows[lowest], line) + scatter(noise, third)
    };
    if free.len() < FREE || third == 0 || away[lowest] > -SEEN * noise {
        return unknown;
    }
    let line = Line::through(free);
    match flat(line) {
        true => Split { last, baseline: Baseline::Tilted, line, start: None },
        false => unknown,
    }
}

fn away_of(row: &[f64; 2], line: Line) -> f64 {
    row[0] - line.at(row[1])
}

/// The line through the last rows, as many as lie on one within their noise.
fn free_end(rows: &[[f64; 2]], noise: f64) -> Line {
    let n = rows.len();
    let block = (n / 40).max(FREE);
    let mut first = n.saturating_sub(2 * block);
    let mut line = Line::through(&rows[first..]);
    while first > 0 {
        let next = first.saturating_sub(block);
        let own = &rows[first..];
        let spread =
            (own.iter().map(|row| away_of(row, line).powi(2)).sum::<f64>() / own.len() as f64).sqrt();
        let away = mean_of(rows[next..first].iter().map(|row| away_of(row, line)));
        if away.abs() > SEEN * spread.max(noise) {
            break;
        }
        first = next;
        line = Line::through(&rows[first..]);
    }
    line
}

/// Of a curve without adhesion: what lies well before the first touch of the best curve.
fn split_elastic(profile: MdrProfile, rows: &[[f64; 2]], options: &ForceOptions) -> Result<(Body, Split)> {
    let n = rows.len();
    let deepest = rows.iter().map(|row| row[1]).fold(f64::NEG_INFINITY, f64::max);
    let mut body = Body::half_space(profile);
    let mut found = start(&|depth| body.load(depth), rows);
    // How deep the contact is decides about the table of a thin sample.
    if let (Some(half_space), true) = (found, options.layer.is_some()) {
        body = Body::new(profile, options.layer, deepest - half_space.touch)?;
        found = start(&|depth| body.load(depth), rows);
    }
    let Some(start) = found else {
        return Ok((body, Split { last: n, baseline: Baseline::Unknown, line: Line::ZERO, start: None }));
    };
    let Start { baseline, touch, line, .. } = start;
    let bound = touch - MARGIN * (deepest - touch);
    let last = match baseline {
        Baseline::Unknown => n,
        _ => rows.iter().rposition(|row| row[1] > bound).map_or(n, |row| row + 1),
    };
    Ok((body, Split { last, baseline, line, start: Some(start) }))
}

/// How far free rows bend away from a straight line; 0 where that may be noise.
fn bend(free: &[[f64; 2]], baseline: Baseline) -> f64 {
    let n = free.len();
    if n < FEWEST || baseline != Baseline::Tilted {
        return 0.0;
    }
    let [low, high] = extent(free.iter().map(|row| row[1]));
    // From -1 to 1; a parabola in it less its straight line.
    let across = |row: &[f64; 2]| (2.0 * row[1] - low - high) / (high - low);
    let square: Vec<[f64; 2]> = free.iter().map(|row| [across(row).powi(2), row[1]]).collect();
    let [of_loads, of_square] = [free, &square].map(|rows| {
        let line = Line::through(rows);
        rows.iter().map(|row| away_of(row, line)).collect::<Vec<f64>>()
    });
    let squares = dot(&of_square, &of_square);
    let found = dot(&of_loads, &of_square) / squares;
    let rest: Vec<f64> = of_loads.iter().zip(&of_square).map(|(w, x)| w - found * x).collect();
    let noise = (dot(&rest, &rest) / n as f64 * correlation(&rest) / squares).sqrt();
    // How far its ends lie from its middle.
    if found.abs() > SEEN * noise { found.abs() } else { 0.0 }
}

/// Refuses rows, from the largest load on, whose depth is not larger where the load is.
fn require_direction(rows: &[[f64; 2]]) -> Result<()> {
    let n = rows.len();
    let depth = |rows: &[[f64; 2]]| mean_of(rows.iter().map(|row| row[1]));
    match depth(&rows[..n.div_ceil(10)]) > depth(&rows[n / 2..]) {
        true => Ok(()),
        false => turned(),
    }
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
