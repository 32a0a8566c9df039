//! The curve that is nearest to the rows: distance of a row from the curve, start of the search, Levenberg-Marquardt (D. W. Marquardt, J.
//! SIAM 11 (1963) 431) and the covariance.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::body::Body;
use super::rows::Rows;
use super::{ForceModel, ForceOptions, turned};
use crate::error::Result;
use crate::indentation::{Baseline, correlation, covariance, damped_step, durbin_watson};
use crate::material::dot;
use crate::numbers::bisect;
use crate::reference::{AdhesiveModel, AdhesiveSphere, BarPoint, maugis_lambda};

/// Points of the curve among which the nearest is looked for first.
const POINTS: usize = 64;
/// Step of the parameter of the curve below which its nearest point is found.
const NEAR: f64 = 1e-12;
const MOST_ITERATIONS: usize = 100;
/// A decrease of the sum of squares below this is slow; this number of consecutive slow decreases ends the search.
const SLOW: f64 = 1e-8;
const PATIENCE: usize = 2;
/// Steps of the differences of the parameters.
const STEP: f64 = 1e-5;
/// Values of λ from which the search begins, and its limits: beyond, DMT and JKR differ from Maugis' model by less than any record.
const STARTS: [f64; 3] = [0.15, 0.8, 4.0];
const LAMBDA: [f64; 2] = [1e-3, 300.0];
/// Scatters in contact and off it that differ by this many of their standard errors are two.
const SAME: f64 = 2.0;
/// Fewer rows in contact, or free ones, have the scatter of all.
const OWN: usize = 8;
/// Degrees of freedom at least: where fewer are left the correlation itself is not known.
const LEAST_FREEDOM: f64 = 3.0;
/// Smallest scatter in units of the noise: the noise itself may be that of rounding.
const LEAST: f64 = 0.1;
/// 95 % of the chi-squared distribution of one degree of freedom.
const CHI: f64 = 3.841_459;

/// Rows and model. Parameters: ln E*, ln w, ln λ (of Maugis without a range), then depth of first touch, load of the free sphere there and the
/// slope of that load, over the spans of the record.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    body: &'a Body,
    /// Of the sphere, with adhesion.
    radius: f64,
    rows: &'a Rows,
    options: &'a ForceOptions,
    /// Whether λ stays where the search begins.
    held: bool,
}

/// The best parameters.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) at: Vec<f64>,
    /// (J'J)⁻¹ times the variance of the residuals; `None` where the record does not determine the parameters.
    covariance: Option<Vec<Vec<f64>>>,
    /// The parameters that the covariance has; the others are fixed or have no effect.
    kept: Vec<usize>,
    squares: f64,
    /// Standard deviations of a residual in contact and off it, larger where neighbours are alike.
    pub(super) scatter: [f64; 2],
    pub(super) durbin_watson: f64,
}

impl Found {
    /// ln E*, ln w.
    pub(super) fn logarithms(&self) -> [f64; 2] {
        [self.at[0], self.at[1]]
    }

    /// Of the parameters that are fitted.
    pub(super) fn deviation(&self, k: usize) -> f64 {
        let mut direction = vec![0.0; self.at.len()];
        direction[k] = 1.0;
        self.variance(&direction).sqrt()
    }

    /// Variance of the sum of the parameters with these factors.
    pub(super) fn variance(&self, direction: &[f64]) -> f64 {
        let Some(covariance) = &self.covariance else { return f64::INFINITY };
        // A direction along a parameter without an effect has no bound.
        if direction.iter().enumerate().any(|(k, x)| *x != 0.0 && !self.kept.contains(&k)) {
            return f64::INFINITY;
        }
        let factor = |k: &usize| direction.get(*k).copied().unwrap_or(0.0);
        let own: Vec<f64> = self.kept.iter().map(factor).collect();
        covariance.iter().zip(&own).map(|(line, x)| x * dot(line, &own)).sum::<f64>().max(0.0)
    }
}

/// The points of the curve nearest to the rows.
pub(super) struct Nearest {
    /// Of contact, then of the free sphere \[N\].
    pub(super) loads: Vec<f64>,
    pub(super) contact_radius: f64,
}

/// A curve of load over depth in bars, by a parameter that grows with the depth.
#[derive(Clone, Copy)]
enum Law<'a> {
    /// An elastic contact without adhesion; the parameter is the depth, in the unit of length `unit` \[m\].
    Elastic { body: &'a Body, unit: f64 },
    /// A sphere that adheres.
    Adhesive(AdhesiveModel),
}

impl Law<'_> {
    fn at(self, u: f64) -> BarPoint {
        match self {
            Law::Elastic { body, unit } => {
                let radius = body.reach(u * unit) / unit;
                let load = body.load(u * unit) / (unit * unit);
                BarPoint { radius, load, depth: u, load_slope: 2.0 * radius, depth_slope: 1.0 }
            }
            Law::Adhesive(model) => model.at(u),
        }
    }

    /// Whether it is another curve.
    fn differs(self, other: Law) -> bool {
        matches!((self, other), (Law::Adhesive(one), Law::Adhesive(two)) if one != two)
    }

    /// The ends of the part of the curve between these depths; it ends where the sphere comes off under any control.
    fn between(self, [smallest, deepest]: [f64; 2]) -> [f64; 2] {
        match self {
            Law::Elastic { .. } => [smallest.min(0.0) - 1.0, deepest.max(0.0) + 1.0],
            Law::Adhesive(model) => [model.end(f64::INFINITY), model.beyond(deepest)],
        }
    }
}

/// Depth of first touch \[m\], load of the free sphere there \[N\] and the slope of that load over the depth \[N/m\].
#[derive(Clone, Copy)]
pub(super) struct Shifts {
    pub(super) touch: f64,
    pub(super) load: f64,
    pub(super) slope: f64,
}

/// Where the curve lies in the units of the record.
#[derive(Clone, Copy)]
struct Frame<'a> {
    law: Law<'a>,
    units: [f64; 2],
    /// Unit of the radius of the contact \[m\].
    width: f64,
    shifts: Shifts,
    noise: [f64; 2],
}

impl Frame<'_> {
    /// Load at a point of the curve, with that of the free sphere.
    fn load(&self, point: &BarPoint) -> f64 {
        self.shifts.load + self.shifts.slope * self.units[1] * point.depth + self.units[0] * point.load
    }

    /// Load of a free row less that of the free sphere.
    fn off(&self, [load, depth]: [f64; 2]) -> f64 {
        load - self.shifts.load - self.shifts.slope * (depth - self.shifts.touch)
    }

    /// Distance of load and depth from a point of the curve, in standard deviations.
    fn apart(&self, [load, depth]: [f64; 2], point: &BarPoint) -> [f64; 2] {
        let into = self.units[1] * point.depth;
        [(load - self.load(point)) / self.noise[0], (depth - self.shifts.touch - into) / self.noise[1]]
    }

    /// Change of the curve along its parameter, in standard deviations.
    fn along(&self, point: &BarPoint) -> [f64; 2] {
        let depth = self.units[1] * point.depth_slope;
        [
            (self.units[0] * point.load_slope + self.shifts.slope * depth) / self.noise[0],
            depth / self.noise[1],
        ]
    }
}

/// The stable branch at some parameters.
struct Curve<'a> {
    frame: Frame<'a>,
    ends: [f64; 2],
    table: Vec<(f64, BarPoint)>,
}

/// The point of the curve that is nearest to a row, at the parameter `u`, and the distance of the row.
struct Foot {
    u: f64,
    point: BarPoint,
    apart: [f64; 2],
    /// Whether the branch ends there, so that the distance may have a part along the curve.
    last: bool,
}

impl Curve<'_> {
    fn nearest(&self, row: [f64; 2]) -> Foot {
        let Frame { law, .. } = self.frame;
        let distance = |point: &BarPoint| {
            let [x, y] = self.frame.apart(row, point);
            x * x + y * y
        };
        let (mut u, mut least) = (self.ends[0], f64::INFINITY);
        for (there, point) in &self.table {
            let distance = distance(point);
            if distance < least {
                (u, least) = (*there, distance);
            }
        }
        let mut point = law.at(u);
        'steps: for _ in 0..40 {
            let (apart, along) = (self.frame.apart(row, &point), self.frame.along(&point));
            let mut step = inner(apart, along) / inner(along, along);
            loop {
                let next = (u + step).clamp(self.ends[0], self.ends[1]);
                if (next - u).abs() <= NEAR * (1.0 + u.abs()) {
                    break 'steps;
                }
                let there = law.at(next);
                let distance = distance(&there);
                if distance <= least {
                    (u, point, least) = (next, there, distance);
                    break;
                }
                step *= 0.5;
            }
        }
        Foot { u, point, apart: self.frame.apart(row, &point), last: u == self.ends[0] }
    }
}

fn inner([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * c + b * d
}

impl<'a> Problem<'a> {
    pub(super) fn new(body: &'a Body, rows: &'a Rows, options: &'a ForceOptions) -> Self {
        Problem { body, radius: body.profile.radius().unwrap_or(1.0), rows, options, held: false }
    }

    fn adhesive(&self) -> bool {
        self.options.model != ForceModel::Hertz
    }

    /// Whether λ is a parameter.
    pub(super) fn free_lambda(&self) -> bool {
        self.options.model == ForceModel::Maugis && self.options.range.is_none()
    }

    /// Numbers of the parameters that are fitted.
    fn fitted(&self) -> Vec<usize> {
        let [offset, tilt] = match self.rows.baseline {
            Baseline::Unknown => [false; 2],
            Baseline::Flat => [true, false],
            Baseline::Tilted => [true; 2],
        };
        let wanted = [true, self.adhesive(), self.free_lambda() && !self.held, true, offset, tilt];
        (0..wanted.len()).filter(|k| wanted[*k]).collect()
    }

    /// The model of adhesion; `None` without.
    pub(super) fn model(&self, at: &[f64]) -> Option<AdhesiveModel> {
        Some(match self.options.model {
            ForceModel::Hertz => return None,
            ForceModel::Dmt => AdhesiveModel::Dmt,
            ForceModel::Jkr => AdhesiveModel::Jkr,
            ForceModel::Maugis => {
                let own = self
                    .options
                    .range
                    .map(|range| maugis_lambda(self.radius, at[0].exp(), at[1].exp(), range));
                AdhesiveModel::Maugis { lambda: own.unwrap_or(at[2].exp()).clamp(LAMBDA[0], LAMBDA[1]) }
            }
        })
    }

    pub(super) fn work(&self, at: &[f64]) -> f64 {
        at[1].exp()
    }

    /// Units of the last three parameters.
    fn shift_units(&self) -> [f64; 3] {
        let [load, depth] = self.rows.spans;
        [depth, load, load / depth]
    }

    pub(super) fn shifts(&self, at: &[f64]) -> Shifts {
        let [of_touch, of_load, of_slope] = self.shift_units();
        Shifts { touch: at[3] * of_touch, load: at[4] * of_load, slope: at[5] * of_slope }
    }

    /// Standard deviations of touch, load and slope; 0 of what is not fitted.
    pub(super) fn shift_deviations(&self, found: &Found) -> [f64; 3] {
        let (units, fitted) = (self.shift_units(), self.fitted());
        [0, 1, 2].map(|k| if fitted.contains(&(3 + k)) { found.deviation(3 + k) * units[k] } else { 0.0 })
    }

    fn frame(&self, at: &[f64]) -> Frame<'a> {
        let modulus = at[0].exp();
        let (law, units, width) = match self.model(at) {
            None => {
                let unit = self.rows.spans[1];
                (Law::Elastic { body: self.body, unit }, [modulus * unit * unit, unit], unit)
            }
            Some(model) => {
                let units = AdhesiveSphere::of(model, self.radius, modulus, self.work(at)).units();
                (Law::Adhesive(model), units, (units[1] * self.radius).sqrt())
            }
        };
        Frame { law, units, width, shifts: self.shifts(at), noise: self.rows.noise }
    }

    fn curve(&self, at: &[f64]) -> Curve<'a> {
        let frame = self.frame(at);
        let Frame { law, units, shifts: Shifts { touch, .. }, .. } = frame;
        let [smallest, largest] = self.rows.depths;
        let deepest = largest + 0.05 * self.rows.spans[1];
        let [first, last] = law.between([smallest, deepest].map(|depth| (depth - touch) / units[1]));
        let last = last.max(first + 1e-6);
        let point = |k: usize| {
            // Closer where the curve bends, at its lower end.
            let x = k as f64 / (POINTS - 1) as f64;
            let u = first + (last - first) * if self.adhesive() { x * x } else { x };
            (u, law.at(u))
        };
        Curve { frame, ends: [first, last], table: (0..POINTS).map(point).collect() }
    }

    /// The nearest points of the rows in contact.
    fn feet(&self, at: &[f64]) -> Vec<Foot> {
        let curve = self.curve(at);
        self.rows.contact.par_iter().with_min_len(256).map(|row| curve.nearest(*row)).collect()
    }

    /// Distances in standard deviations: load and depth of each row in contact, then loads of free rows.
    fn residuals(&self, at: &[f64], feet: &[Foot]) -> Vec<f64> {
        let frame = self.frame(at);
        let free = self.rows.free.iter().map(|row| frame.off(*row) / self.rows.free_noise);
        feet.iter().flat_map(|foot| foot.apart).chain(free).collect()
    }

    pub(super) fn nearest(&self, at: &[f64]) -> Nearest {
        let (frame, feet) = (self.frame(at), self.feet(at));
        let loads = feet.iter().map(|foot| frame.load(&foot.point));
        Nearest {
            loads: loads.chain(self.rows.free.iter().map(|row| row[0] - frame.off(*row))).collect(),
            contact_radius: frame.width * feet.iter().map(|foot| foot.point.radius).fold(0.0, f64::max),
        }
    }

    /// Root mean square of the distance, each channel over its range.
    pub(super) fn misfit(&self, at: &[f64]) -> f64 {
        let share = [0, 1].map(|k| self.rows.noise[k] / self.rows.spans[k]);
        let square = |foot: &Foot| {
            let [x, y] = foot.apart;
            (x * share[0]).powi(2) + (y * share[1]).powi(2)
        };
        let sum: f64 = self.feet(at).iter().map(square).sum();
        (sum / self.rows.contact.len() as f64).sqrt()
    }

    /// Without adhesion that of the rows; with it from the largest load, the smallest one and the depths between.
    fn start(&self, lambda: f64) -> Option<Vec<f64>> {
        let line = self.rows.line;
        let shift = |[modulus, work]: [f64; 2], touch: f64| {
            let [of_touch, of_load, of_slope] = self.shift_units();
            let shifts = [touch / of_touch, line.at(touch) / of_load, line.slope / of_slope];
            [modulus.ln(), work.ln(), lambda.ln()].into_iter().chain(shifts).collect::<Vec<f64>>()
        };
        if let Some(start) = self.rows.start {
            return Some(shift([start.modulus, 1.0], start.touch));
        }
        if !self.adhesive() {
            return None;
        }
        let rows: Vec<[f64; 2]> = self.rows.contact.iter().map(|[w, d]| [w - line.at(*d), *d]).collect();
        let top = rows.first()?;
        let largest = top[0];
        if largest <= 0.0 {
            return None;
        }
        let lowest = rows.iter().min_by(|a, b| a[0].total_cmp(&b[0]))?;
        let model = match self.options.model {
            ForceModel::Maugis => AdhesiveModel::Maugis { lambda },
            _ => self.model(&[0.0; 6])?,
        };
        let end = model.at(model.end(0.0));
        let unit = lowest[0] / end.load;
        let ends = [model.end(0.0), model.beyond((largest / unit).powf(2.0 / 3.0) + 10.0)];
        let pressed = model.at(bisect(ends, 80, |u| model.at(u).load < largest / unit)[0]);
        let depth = (top[1] - lowest[1]) / (pressed.depth - end.depth);
        if !(unit > 0.0 && depth > 0.0 && depth.is_finite()) {
            return None;
        }
        let work = unit / (PI * self.radius);
        // depth³ = π² w² R/K²
        let modulus = 0.75 * PI * work * (self.radius / depth.powi(3)).sqrt();
        Some(shift([modulus, work], top[1] - pressed.depth * depth))
    }

    /// The best of the searches.
    pub(super) fn solve(&self) -> Result<Found> {
        let starts = if self.free_lambda() { &STARTS[..] } else { &STARTS[..1] };
        let found = starts.iter().filter_map(|lambda| self.solve_from(&self.start(*lambda)?).ok());
        match found.min_by(|a, b| a.squares.total_cmp(&b.squares)) {
            Some(found) => Ok(found),
            None => turned(),
        }
    }

    /// The best fits at the best λ and at the ends of its 95 % interval, and whether that has a lower and an upper end: there the sum of squares
    /// has grown by 3.84 variances (profile likelihood). Far from quadratic in ln λ, it is not told by the covariance.
    pub(super) fn profile(&self, found: &Found) -> Result<([Found; 3], [bool; 2])> {
        let held = Problem { held: true, ..*self };
        let at = |lambda: f64, start: &Found| {
            let mut there = start.at.clone();
            there[2] = lambda;
            held.solve_from(&there)
        };
        let best = at(found.at[2], found)?;
        let beyond = |other: &Found| other.squares > best.squares + CHI * best.scatter[0].powi(2);
        let end = |side: f64, limit: f64| -> Result<(Found, bool)> {
            let (mut inside, mut step) = (best.clone(), 0.1);
            let mut outside = loop {
                let next = inside.at[2] + side * step;
                let last = side * next >= side * limit;
                let there = at(if last { limit } else { next }, &inside)?;
                match beyond(&there) {
                    true => break there,
                    false if last => return Ok((there, false)),
                    false => (inside, step) = (there, 2.0 * step),
                }
            };
            // The interval ends between the two.
            for _ in 0..4 {
                let middle = at(0.5 * (inside.at[2] + outside.at[2]), &inside)?;
                if beyond(&middle) { outside = middle } else { inside = middle }
            }
            Ok((outside, true))
        };
        let (low, closed_below) = end(-1.0, LAMBDA[0].ln())?;
        let (high, closed_above) = end(1.0, LAMBDA[1].ln())?;
        Ok(([best, low, high], [closed_below, closed_above]))
    }

    pub(super) fn solve_from(&self, start: &[f64]) -> Result<Found> {
        let fitted = self.fitted();
        let mut at = start.to_vec();
        let mut feet = self.feet(&at);
        let mut residuals = self.residuals(&at, &feet);
        let (mut damping, mut slow) = (1e-3, 0);
        let mut columns = self.slopes(&at, &feet, &fitted);
        for _ in 0..MOST_ITERATIONS {
            let Some(step) = damped_step(&columns, &residuals, damping) else {
                damping *= 10.0;
                if damping > 1e10 {
                    break;
                }
                continue;
            };
            let longest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            let share = if longest > 1.0 { 1.0 / longest } else { 1.0 };
            let mut trial = at.clone();
            fitted.iter().zip(&step).for_each(|(k, s)| trial[*k] += share * s);
            trial[2] = trial[2].clamp(LAMBDA[0].ln(), LAMBDA[1].ln());
            let there = self.feet(&trial);
            let moved = self.residuals(&trial, &there);
            let (before, after) = (dot(&residuals, &residuals), dot(&moved, &moved));
            if after < before {
                (at, feet, residuals) = (trial, there, moved);
                damping = (damping * 0.2).max(1e-12);
                slow = if after > before * (1.0 - SLOW) { slow + 1 } else { 0 };
                if slow == PATIENCE || longest < 1e-10 {
                    break;
                }
                columns = self.slopes(&at, &feet, &fitted);
            } else {
                damping *= 8.0;
                if damping > 1e10 || longest < 1e-11 {
                    break;
                }
            }
        }
        let columns = self.slopes(&at, &feet, &fitted);
        // λ at a limit of the transition has no effect.
        let weight = |k: usize| dot(&columns[k], &columns[k]).sqrt();
        let inside = at[2] > LAMBDA[0].ln() + 0.1 && at[2] < LAMBDA[1].ln() - 0.1;
        let kept: Vec<usize> = (0..fitted.len())
            .filter(|k| weight(*k) > 0.0 && (fitted[*k] != 2 || inside && weight(*k) > 1.0))
            .collect();
        let apart = self.signed(&residuals);
        let squares = dot(&residuals, &residuals);
        let [scatter, wide] = self.scatter(&apart, kept.len());
        let of_contact = 2 * self.rows.contact.len();
        let own = |k: &usize| {
            let rows = columns[*k].iter().enumerate();
            rows.map(|(row, x)| x / wide[usize::from(row >= of_contact)]).collect::<Vec<f64>>()
        };
        let covariance = covariance(&kept.iter().map(own).collect::<Vec<_>>(), 1.0);
        let kept = kept.into_iter().map(|k| fitted[k]).collect();
        let durbin_watson = durbin_watson(&apart[..self.rows.contact.len()]);
        Ok(Found { at, covariance, kept, squares, scatter, durbin_watson })
    }

    /// Standard deviations of a residual in contact and off it, and the same with what is not known about them: the model may bend away from the contact, and what varies slowly far from
    /// the body says nothing about the few rows of a contact.
    fn scatter(&self, apart: &[f64], parameters: usize) -> [[f64; 2]; 2] {
        let of = |rows: &[f64], parameters: usize| {
            let (n, alike) = (rows.len() as f64, correlation(rows));
            let freedom = n - parameters as f64;
            let scatter = (dot(rows, rows) / freedom.max(1.0) * alike).sqrt().max(LEAST);
            [scatter, scatter * student(freedom / alike)]
        };
        let of_line = self.fitted().iter().filter(|k| **k >= 4).count().min(parameters);
        let (contact, free) = apart.split_at(self.rows.contact.len());
        let [contact, free] = match contact.len() < OWN || free.len() < OWN {
            true => [of(apart, parameters); 2],
            false => [of(contact, parameters - of_line), of(free, of_line)],
        };
        // Two that differ by no more than their own errors are one, which all rows tell.
        let error =
            [self.rows.contact.len(), apart.len() - self.rows.contact.len()].map(|n| 0.5 / n.max(1) as f64);
        if (contact[0] / free[0]).ln().abs() < SAME * (error[0] + error[1]).sqrt() {
            let all = of(apart, parameters);
            return [[all[0]; 2], [all[1]; 2]];
        }
        [[contact[0], free[0]], [contact[1], free[1]]]
    }

    /// One signed distance per row.
    fn signed(&self, residuals: &[f64]) -> Vec<f64> {
        let (contact, free) = residuals.split_at(2 * self.rows.contact.len());
        // Above the curve the load is too large, or the depth too small.
        let distance = |pair: &[f64]| {
            let side = if pair[0] - pair[1] < 0.0 { -1.0 } else { 1.0 };
            side * pair[0].hypot(pair[1])
        };
        contact.chunks_exact(2).map(distance).chain(free.iter().copied()).collect()
    }

    /// Columns of the derivatives of the residuals. A distance is perpendicular to the curve and changes with the part of the curve's motion
    /// that is: where the nearest point goes along the curve has no effect on it. At the end of the branch the point moves with the end.
    fn slopes(&self, at: &[f64], feet: &[Foot], fitted: &[usize]) -> Vec<Vec<f64>> {
        let frame = self.frame(at);
        let column = |k: &usize| {
            let sides @ [up, down] = [STEP, -STEP].map(|step| {
                let mut there = at.to_vec();
                there[*k] += step;
                self.frame(&there)
            });
            let bends = up.law.differs(down.law);
            let [high, low] = match bends && feet.iter().any(|foot| foot.last) {
                true => sides.map(|side| side.law.between([0.0; 2])[0]),
                false => [0.0; 2],
            };
            let end = (high - low) / (2.0 * STEP);
            let row = |(row, foot): (&[f64; 2], &Foot)| {
                let [up, down] = sides.map(|side| match bends {
                    true => side.apart(*row, &side.law.at(foot.u)),
                    false => side.apart(*row, &foot.point),
                });
                let moved = [0, 1].map(|k| (up[k] - down[k]) / (2.0 * STEP));
                let along = frame.along(&foot.point);
                let share = if foot.last { end } else { inner(moved, along) / inner(along, along) };
                [moved[0] - share * along[0], moved[1] - share * along[1]]
            };
            let rows = self.rows.contact.par_iter().with_min_len(256).zip(feet.par_iter()).map(row);
            let contact: Vec<[f64; 2]> = rows.collect();
            let free = self
                .rows
                .free
                .iter()
                .map(|row| (up.off(*row) - down.off(*row)) / (2.0 * STEP * self.rows.free_noise));
            contact.into_iter().flatten().chain(free).collect()
        };
        fitted.iter().map(column).collect()
    }
}

/// Half width of a 95 % interval of Student's t distribution over that of a normal one (R. A. Fisher & E. A. Cornish, Technometrics 2 (1960) 209): few
/// independent rows know their own scatter badly.
fn student(freedom: f64) -> f64 {
    let x = 1.0 / freedom.max(LEAST_FREEDOM);
    1.0 + x * (1.210 + x * (1.440 + x * 1.304))
}

#[cfg(test)]
mod tests {
    use super::super::{ForceRecord, PullOffControl};
    use super::*;
    use crate::reference::MdrProfile;

    /// The gradient of the sum of squares follows from the slopes: compared with its differences, at a distance from the best fit, where
    /// some rows are nearest to the end of the branch.
    #[test]
    fn slopes_give_the_gradient() {
        let sphere = AdhesiveSphere::new(AdhesiveModel::Maugis { lambda: 0.9 }, 10e-6, 1e6, 5e-3).unwrap();
        let depths: Vec<f64> = (0..120).map(|k| 0.5e-6 - 9e-9 * f64::from(k)).collect();
        let load = |depth: &f64| sphere.at_approach(*depth).unwrap().map_or(0.0, |point| point.load);
        let loads: Vec<f64> = depths.iter().map(load).collect();
        let mut ends = 0;
        for (model, range) in [
            (ForceModel::Hertz, None),
            (ForceModel::Dmt, None),
            (ForceModel::Jkr, None),
            (ForceModel::Maugis, None),
            (ForceModel::Maugis, Some(5e-9)),
        ] {
            let control = Some(PullOffControl::Displacement);
            let options = ForceOptions { model, range, control, ..Default::default() };
            let profile = MdrProfile::Paraboloid { radius: 10e-6 };
            let record = ForceRecord { loads: &loads, depths: &depths };
            let (mut rows, body) = Rows::new(profile, &record, &options).unwrap();
            (rows.noise, rows.free_noise) = ([2e-9, 2e-9], 2e-9);
            let problem = Problem::new(&body, &rows, &options);
            let at = vec![1.1e6f64.ln(), 4.7e-3f64.ln(), 0.7f64.ln(), 0.01, 0.003, 0.004];
            let squares = |at: &[f64]| {
                let residuals = problem.residuals(at, &problem.feet(at));
                0.5 * dot(&residuals, &residuals)
            };
            let (fitted, feet) = (problem.fitted(), problem.feet(&at));
            ends += feet.iter().filter(|foot| foot.last).count();
            let residuals = problem.residuals(&at, &feet);
            for (k, column) in fitted.iter().zip(problem.slopes(&at, &feet, &fitted)) {
                let [up, down] = [STEP, -STEP].map(|step| {
                    let mut there = at.clone();
                    there[*k] += step;
                    squares(&there)
                });
                let (told, found) = (dot(&column, &residuals), (up - down) / (2.0 * STEP));
                // Differences of a step of 1e-5 have an error of its square, and of a row whose nearest point reaches the end within it.
                assert!((told - found).abs() < 1e-3 * found.abs().max(1.0), "{model:?} {k} {told} {found}");
            }
        }
        assert!(ends > 0);
    }
}
