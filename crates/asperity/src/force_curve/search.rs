//! The curve that is nearest to the rows: distance of a row from the curve, start of the search, Levenberg-Marquardt (D. W. Marquardt, J.
//! SIAM 11 (1963) 431) and the covariance.

use std::f64::consts::PI;

use super::rows::Rows;
use super::{ForceModel, ForceOptions, invalid};
use crate::error::Result;
use crate::indentation::{durbin_watson, invert};
use crate::material::dot;
use crate::reference::{AdhesiveModel, AdhesiveSphere, BarPoint, maugis_lambda};

/// Points of the curve among which the nearest is looked for first.
const POINTS: usize = 64;
const MOST_ITERATIONS: usize = 100;
/// Steps of the differences of the parameters.
const STEP: f64 = 1e-5;
/// Values of λ from which the search begins, and its limits: beyond, DMT and JKR differ from Maugis' model by less than any record.
const STARTS: [f64; 3] = [0.15, 0.8, 4.0];
const LAMBDA: [f64; 2] = [1e-3, 300.0];
/// A residual correlation beyond which the number of independent rows is not known.
const CORRELATED: f64 = 0.98;
/// 95 % of the chi-squared distribution of one degree of freedom.
const CHI: f64 = 3.841_459;

/// Rows and model. Parameters: ln E*, ln w, ln λ (of Maugis without a range), then depth of first touch and load of the free sphere over
/// the spans of the record.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    radius: f64,
    rows: &'a Rows,
    options: &'a ForceOptions,
    /// Whether λ stays where the search begins.
    held: bool,
}

/// The best parameters.
pub(super) struct Found {
    pub(super) at: Vec<f64>,
    /// (J'J)⁻¹ times the variance of the residuals; `None` where the record does not determine the parameters.
    covariance: Option<Vec<Vec<f64>>>,
    /// The parameters that the covariance has; the others are fixed or have no effect.
    kept: Vec<usize>,
    squares: f64,
    /// Of a residual, larger where neighbours are alike.
    scatter: f64,
    pub(super) durbin_watson: f64,
}

impl Found {
    /// ln E*, ln w.
    pub(super) fn logarithms(&self) -> [f64; 2] {
        [self.at[0], self.at[1]]
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

    fn deviation(&self, k: usize) -> f64 {
        let mut direction = vec![0.0; self.at.len()];
        direction[k] = 1.0;
        self.variance(&direction).sqrt()
    }
}

/// The points of the curve nearest to the rows.
pub(super) struct Nearest {
    /// Of contact, then of the free sphere \[N\].
    pub(super) loads: Vec<f64>,
    pub(super) contact_radius: f64,
}

/// The curve at some parameters, in the units of the record.
struct Curve {
    model: AdhesiveModel,
    units: [f64; 2],
    shifts: [f64; 2],
    noise: [f64; 2],
    ends: [f64; 2],
    table: Vec<(f64, BarPoint)>,
}

impl Curve {
    /// Distance of load and depth in standard deviations at a parameter of the curve, and its slopes.
    fn apart(&self, [load, depth]: [f64; 2], point: &BarPoint) -> ([f64; 2], [f64; 2]) {
        let scale = [0, 1].map(|k| self.units[k] / self.noise[k]);
        let measured = [(load - self.shifts[1]) / self.units[0], (depth - self.shifts[0]) / self.units[1]];
        let distance = [scale[0] * (measured[0] - point.load), scale[1] * (measured[1] - point.depth)];
        (distance, [scale[0] * point.load_slope, scale[1] * point.depth_slope])
    }

    /// The nearest point of the stable branch.
    fn nearest(&self, row: [f64; 2]) -> ([f64; 2], BarPoint) {
        let squares = |point: &BarPoint| {
            let ([x, y], _) = self.apart(row, point);
            x * x + y * y
        };
        let mut start = self.ends[0];
        let mut least = f64::INFINITY;
        for (u, point) in &self.table {
            let distance = squares(point);
            if distance < least {
                (start, least) = (*u, distance);
            }
        }
        let mut u = start;
        let mut point = self.model.at(u);
        for _ in 0..40 {
            let (distance, slope) = self.apart(row, &point);
            let length = slope[0] * slope[0] + slope[1] * slope[1];
            let full = (distance[0] * slope[0] + distance[1] * slope[1]) / length;
            let mut step = full;
            let mut moved = false;
            for _ in 0..30 {
                let next = (u + step).clamp(self.ends[0], self.ends[1]);
                let there = self.model.at(next);
                let distance = squares(&there);
                if distance <= least && next != u {
                    moved = (next - u).abs() > 1e-13 * (1.0 + u.abs());
                    (u, point, least) = (next, there, distance);
                    break;
                }
                step *= 0.5;
            }
            if !moved {
                break;
            }
        }
        (self.apart(row, &point).0, point)
    }
}

impl<'a> Problem<'a> {
    pub(super) fn new(radius: f64, rows: &'a Rows, options: &'a ForceOptions) -> Self {
        Problem { radius, rows, options, held: false }
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
        let wanted = [true, self.adhesive(), self.free_lambda() && !self.held, true, self.rows.baseline];
        (0..5).filter(|k| wanted[*k]).collect()
    }

    pub(super) fn model(&self, at: &[f64]) -> AdhesiveModel {
        match self.options.model {
            ForceModel::Hertz => AdhesiveModel::Hertz,
            ForceModel::Dmt => AdhesiveModel::Dmt,
            ForceModel::Jkr => AdhesiveModel::Jkr,
            ForceModel::Maugis => {
                let own = self
                    .options
                    .range
                    .map(|range| maugis_lambda(self.radius, at[0].exp(), at[1].exp(), range));
                AdhesiveModel::Maugis { lambda: own.unwrap_or(at[2].exp()).clamp(LAMBDA[0], LAMBDA[1]) }
            }
        }
    }

    pub(super) fn work(&self, at: &[f64]) -> f64 {
        at[1].exp()
    }

    /// Depth of first touch \[m\] and load of the free sphere \[N\].
    pub(super) fn shifts(&self, at: &[f64]) -> [f64; 2] {
        [at[3] * self.rows.spans[1], at[4] * self.rows.spans[0]]
    }

    pub(super) fn shift_deviations(&self, found: &Found) -> [f64; 2] {
        let baseline = if self.rows.baseline { found.deviation(4) * self.rows.spans[0] } else { 0.0 };
        [found.deviation(3) * self.rows.spans[1], baseline]
    }

    fn curve(&self, at: &[f64]) -> Curve {
        let model = self.model(at);
        let units = AdhesiveSphere::of(model, self.radius, at[0].exp(), at[1].exp()).units();
        let [touch, baseline] = self.shifts(at);
        let largest = |k: usize| self.rows.contact.iter().map(|row| row[k]).fold(f64::NEG_INFINITY, f64::max);
        let smallest = self.rows.contact.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
        let deepest = (largest(1) - touch) / units[1];
        let last = model.beyond(deepest + 0.05 * self.rows.spans[1] / units[1]);
        let first = match model {
            AdhesiveModel::Hertz => ((smallest - touch) / units[1]).min(0.0) - 1.0,
            // Any control comes off before the smallest depth, or there.
            _ => model.end(f64::INFINITY),
        };
        let last = last.max(first + 1e-6);
        let point = |k: usize| {
            // Closer where the curve bends, at its lower end.
            let x = k as f64 / (POINTS - 1) as f64;
            let u = first + (last - first) * if model == AdhesiveModel::Hertz { x } else { x * x };
            (u, model.at(u))
        };
        Curve {
            model,
            units,
            shifts: [touch, baseline],
            noise: self.rows.noise,
            ends: [first, last],
            table: (0..POINTS).map(point).collect(),
        }
    }

    /// Distances in standard deviations: load and depth of each row in contact, then loads of free rows.
    fn residuals(&self, at: &[f64]) -> Vec<f64> {
        let curve = self.curve(at);
        let contact = self.rows.contact.iter().flat_map(|row| curve.nearest(*row).0);
        let free = self.rows.free.iter().map(|w| (w - curve.shifts[1]) / self.rows.noise[0]);
        contact.chain(free).collect()
    }

    pub(super) fn nearest(&self, at: &[f64]) -> Nearest {
        let curve = self.curve(at);
        let points: Vec<BarPoint> = self.rows.contact.iter().map(|row| curve.nearest(*row).1).collect();
        let unit = (curve.units[1] * self.radius).sqrt();
        let loads = points.iter().map(|point| curve.shifts[1] + curve.units[0] * point.load);
        Nearest {
            loads: loads.chain(self.rows.free.iter().map(|_| curve.shifts[1])).collect(),
            contact_radius: unit * points.iter().map(|point| point.radius).fold(0.0, f64::max),
        }
    }

    /// Root mean square of the distance, each channel over its range.
    pub(super) fn misfit(&self, at: &[f64]) -> f64 {
        let curve = self.curve(at);
        let share = |k: usize| self.rows.noise[k] / self.rows.spans[k];
        let sum: f64 = self
            .rows
            .contact
            .iter()
            .map(|row| {
                let [x, y] = curve.nearest(*row).0;
                (x * share(0)).powi(2) + (y * share(1)).powi(2)
            })
            .sum();
        (sum / self.rows.contact.len() as f64).sqrt()
    }

    /// From the largest load, the smallest one and the depths between.
    fn start(&self, lambda: f64) -> Option<Vec<f64>> {
        let rows = &self.rows.contact;
        let rest = self.rows.rest;
        let top = rows.first()?;
        let shift = |at: [f64; 2], touch: f64| {
            vec![at[0], at[1], lambda.ln(), touch / self.rows.spans[1], rest / self.rows.spans[0]]
        };
        let largest = top[0] - rest;
        if largest <= 0.0 {
            return None;
        }
        if !self.adhesive() {
            // W ∝ depth^(3/2): a quarter of the load is at 0.397 of the depth.
            let quarter = rows.iter().rev().find(|row| row[0] - rest > 0.25 * largest)?;
            let depth = (top[1] - quarter[1]) / (1.0 - 0.25f64.powf(2.0 / 3.0));
            if depth <= 0.0 {
                return None;
            }
            let modulus = 0.75 * largest / (self.radius.sqrt() * depth.powf(1.5));
            return Some(shift([modulus.ln(), (largest / (PI * self.radius)).ln()], top[1] - depth));
        }
        let lowest = rows.iter().min_by(|a, b| a[0].total_cmp(&b[0]))?;
        let model = match self.options.model {
            ForceModel::Maugis => AdhesiveModel::Maugis { lambda },
            _ => self.model(&[0.0; 5]),
        };
        let end = model.at(model.end(0.0));
        let unit = (rest - lowest[0]) / -end.load;
        let (mut low, mut high) = (model.end(0.0), model.beyond((largest / unit).powf(2.0 / 3.0) + 10.0));
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if model.at(middle).load < largest / unit { low = middle } else { high = middle }
        }
        let pressed = model.at(low);
        let depth = (top[1] - lowest[1]) / (pressed.depth - end.depth);
        if !(unit > 0.0 && depth > 0.0 && depth.is_finite()) {
            return None;
        }
        let work = unit / (PI * self.radius);
        // depth³ = π² w² R/K²
        let modulus = 0.75 * PI * work * (self.radius / depth.powi(3)).sqrt();
        Some(shift([modulus.ln(), work.ln()], top[1] - pressed.depth * depth))
    }

    /// The best of the searches.
    pub(super) fn solve(&self) -> Result<Found> {
        let starts = if self.options.model == ForceModel::Maugis { &STARTS[..] } else { &STARTS[..1] };
        let found = starts.iter().filter_map(|lambda| self.solve_from(&self.start(*lambda)?).ok());
        match found.min_by(|a, b| a.squares.total_cmp(&b.squares)) {
            Some(found) => Ok(found),
            None => invalid(
                "depth of the force curve",
                "not larger where the load is larger",
                "larger where the sphere is pressed deeper: depth = height less deflection; turn the sign of the column",
            ),
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
        let beyond = |other: &Found| other.squares > best.squares + CHI * found.scatter;
        let end = |side: f64, limit: f64| -> Result<(Found, bool)> {
            let mut inside = at(found.at[2], found)?;
            let mut step = 0.1;
            loop {
                let next = inside.at[2] + side * step;
                let last = side * next >= side * limit;
                let there = at(if last { limit } else { next }, &inside)?;
                if beyond(&there) {
                    // The interval ends between the two.
                    let mut outside = there;
                    for _ in 0..4 {
                        let middle = at(0.5 * (inside.at[2] + outside.at[2]), &inside)?;
                        if beyond(&middle) {
                            outside = middle;
                        } else {
                            inside = middle;
                        }
                    }
                    return Ok((outside, true));
                }
                inside = there;
                if last {
                    return Ok((inside, false));
                }
                step *= 2.0;
            }
        };
        let (low, closed_below) = end(-1.0, LAMBDA[0].ln())?;
        let (high, closed_above) = end(1.0, LAMBDA[1].ln())?;
        Ok(([best, low, high], [closed_below, closed_above]))
    }

    pub(super) fn solve_from(&self, start: &[f64]) -> Result<Found> {
        let fitted = self.fitted();
        let mut at = start.to_vec();
        let mut residuals = self.residuals(&at);
        let (mut damping, mut slow) = (1e-3, 0);
        let mut columns = self.slopes(&at, &fitted);
        for _ in 0..MOST_ITERATIONS {
            let normal = normal(&columns);
            let gradient: Vec<f64> = columns.iter().map(|column| dot(column, &residuals)).collect();
            let largest = (0..normal.len()).map(|k| normal[k][k]).fold(0.0, f64::max);
            let mut damped = normal;
            for (k, line) in damped.iter_mut().enumerate() {
                line[k] += damping * line[k] + 1e-14 * largest;
            }
            let Some(inverse) = invert(damped) else {
                damping *= 10.0;
                if damping > 1e10 {
                    break;
                }
                continue;
            };
            let step: Vec<f64> = inverse.iter().map(|line| -dot(line, &gradient)).collect();
            let longest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            let share = if longest > 1.0 { 1.0 / longest } else { 1.0 };
            let mut trial = at.clone();
            fitted.iter().zip(&step).for_each(|(k, s)| trial[*k] += share * s);
            trial[2] = trial[2].clamp(LAMBDA[0].ln(), LAMBDA[1].ln());
            let moved = self.residuals(&trial);
            let (before, after) = (dot(&residuals, &residuals), dot(&moved, &moved));
            if after < before {
                (at, residuals) = (trial, moved);
                damping = (damping * 0.2).max(1e-12);
                slow = if after > before * (1.0 - 1e-6) { slow + 1 } else { 0 };
                if slow == 3 || longest < 1e-10 {
                    break;
                }
                columns = self.slopes(&at, &fitted);
            } else {
                damping *= 8.0;
                if damping > 1e10 || longest < 1e-11 {
                    break;
                }
            }
        }
        let columns = self.slopes(&at, &fitted);
        // λ at a limit of the transition has no effect.
        let weight = |k: usize| dot(&columns[k], &columns[k]).sqrt();
        let inside = at[2] > LAMBDA[0].ln() + 0.1 && at[2] < LAMBDA[1].ln() - 0.1;
        let kept: Vec<usize> = (0..fitted.len())
            .filter(|k| weight(*k) > 0.0 && (fitted[*k] != 2 || inside && weight(*k) > 1.0))
            .collect();
        let own: Vec<Vec<f64>> = kept.iter().map(|k| columns[*k].clone()).collect();
        let apart = self.signed(&residuals);
        let squares = dot(&residuals, &residuals);
        let variance = squares / (apart.len() as f64 - own.len() as f64).max(1.0);
        let durbin_watson = durbin_watson(&apart);
        let alike = (1.0 - 0.5 * durbin_watson).clamp(0.0, CORRELATED);
        let wider = variance * (1.0 + alike) / (1.0 - alike);
        let covariance = invert(normal(&own)).map(|inverse| {
            inverse.into_iter().map(|line| line.into_iter().map(|x| x * wider).collect()).collect()
        });
        let kept = kept.into_iter().map(|k| fitted[k]).collect();
        Ok(Found { at, covariance, kept, squares, scatter: wider, durbin_watson })
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

    /// Columns of the derivatives of the residuals, by central differences.
    fn slopes(&self, at: &[f64], fitted: &[usize]) -> Vec<Vec<f64>> {
        let column = |k: &usize| {
            let [up, down] = [STEP, -STEP].map(|step| {
                let mut there = at.to_vec();
                there[*k] += step;
                self.residuals(&there)
            });
            up.iter().zip(&down).map(|(up, down)| (up - down) / (2.0 * STEP)).collect()
        };
        fitted.iter().map(column).collect()
    }
}

fn normal(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect()
}
