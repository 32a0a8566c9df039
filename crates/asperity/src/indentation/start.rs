//! The start of the iteration: the best times of a grid for the part of the record in which the contact grows, where load and
//! depth are linear in the weights (theory of Lee and Radok, see [`super`]).

use super::Given;
use super::least_squares::{invert, normal};
use super::model::Model;
use super::parameters::Parameters;
use crate::error::{Error, Result};
use crate::material::{Creep, CreepTerm, Relaxation, RelaxationTerm, dot};

/// Times of the grid per decade.
const PER_DECADE: f64 = 4.0;
/// A depth below this fraction of the largest so far ends the growing part.
const SHRINKS: f64 = 0.95;

/// Parameters to start from.
pub(super) fn start(model: &Model, parameters: Parameters) -> Result<Vec<f64>> {
    let growing = Growing::of(model);
    let grid = growing.grid();
    let found = match model.given {
        Given::Depth => growing.relaxation(parameters, &grid),
        Given::Load => growing.creep(parameters, &grid),
    };
    let start = found.and_then(|relaxation| parameters.of(&relaxation));
    start.or_else(|| growing.spread(parameters)).ok_or_else(|| {
        Error::invalid(
            "record of the indentation",
            "one whose load does not grow with the depth",
            "an indentation from first touch on (check the signs of load and depth)",
        )
    })
}

/// The part of a record in which the contact grows: φ(d), the loads, and the weight of each row.
struct Growing {
    times: Vec<f64>,
    loads: Vec<f64>,
    unit: Vec<f64>,
    weights: Vec<f64>,
    length: f64,
}

impl Growing {
    fn of(model: &Model) -> Self {
        let most = model.depth_scale();
        let (mut end, mut deepest) = (0, 0.0_f64);
        for depth in &model.depths {
            deepest = deepest.max(*depth);
            if deepest > 0.2 * most && *depth < SHRINKS * deepest {
                break;
            }
            end += 1;
        }
        let pairs: Vec<(f64, f64)> =
            model.depths[..end].iter().map(|depth| model.unit_load(*depth)).collect();
        let widest = pairs.iter().fold(0.0, |m: f64, (_, slope)| m.max(*slope));
        let weight = |slope: f64| match model.given {
            Given::Depth => 1.0,
            // An error of the depth is an error of φ times its slope.
            Given::Load => 1.0 / slope.max(0.05 * widest),
        };
        Growing {
            times: model.times[..end].to_vec(),
            loads: model.loads[..end].iter().map(|load| load.max(0.0)).collect(),
            weights: pairs
                .iter()
                .zip(&model.counts)
                .map(|((_, slope), n)| n.sqrt() * weight(*slope))
                .collect(),
            unit: pairs.into_iter().map(|(unit, _)| unit).collect(),
            length: model.window()[1],
        }
    }

    /// Times from the shortest step to three times the record.
    fn grid(&self) -> Vec<f64> {
        let steps = self.times.windows(2).map(|pair| pair[1] - pair[0]);
        let shortest = steps.fold(self.length, f64::min).max(1e-9 * self.length);
        let (first, last) = (shortest.ln(), (3.0 * self.length).ln());
        let count = (PER_DECADE * (last - first) / std::f64::consts::LN_10).ceil().clamp(4.0, 60.0) as usize;
        (0..=count).map(|k| (first + (last - first) * k as f64 / count as f64).exp()).collect()
    }

    /// ∫ exp(-(t - s)/time) df(s) at every row, with f linear between the rows.
    fn faded(&self, f: &[f64], time: f64) -> Vec<f64> {
        let mut z = 0.0;
        (0..f.len())
            .map(|n| {
                z = if n == 0 {
                    f[0]
                } else {
                    let x = (self.times[n] - self.times[n - 1]) / time;
                    let phi = if x > 1e-9 { -(-x).exp_m1() / x } else { 1.0 };
                    (-x).exp() * z + phi * (f[n] - f[n - 1])
                };
                z
            })
            .collect()
    }

    fn weighted(&self, column: Vec<f64>) -> Vec<f64> {
        column.iter().zip(&self.weights).map(|(c, w)| c * w).collect()
    }

    /// W = E∞ φ + Σ E_i ∫ exp(-(t - s)/τ_i) dφ.
    fn relaxation(&self, parameters: Parameters, grid: &[f64]) -> Option<Relaxation> {
        let fixed = if parameters.solid { vec![self.weighted(self.unit.clone())] } else { vec![] };
        let columns = grid.iter().map(|time| self.weighted(self.faded(&self.unit, *time))).collect();
        let system = System { target: self.weighted(self.loads.clone()), fixed, columns };
        let (chosen, weights) = system.best(parameters.terms)?;
        let first = usize::from(parameters.solid);
        let term = |(k, n): (usize, &usize)| RelaxationTerm {
            modulus: weights[first + k],
            relaxation_time: grid[*n],
        };
        Some(Relaxation {
            equilibrium: if parameters.solid { weights[0] } else { 0.0 },
            terms: chosen.iter().enumerate().map(term).collect(),
            viscosity: 0.0,
        })
    }

    /// φ = C0 W + Σ C_j ∫ (1 - exp(-(t - s)/λ_j)) dW (+ ∫ W dt/η), then its relaxation function. A fluid of n terms has n - 1
    /// retarded ones.
    fn creep(&self, parameters: Parameters, grid: &[f64]) -> Option<Relaxation> {
        let mut fixed = vec![self.weighted(self.loads.clone())];
        let mut terms = parameters.terms;
        if !parameters.solid {
            terms = terms.checked_sub(1)?;
            let mut sum = 0.0;
            let flow = (0..self.loads.len()).map(|n| {
                if n > 0 {
                    sum += 0.5 * (self.loads[n] + self.loads[n - 1]) * (self.times[n] - self.times[n - 1]);
                }
                sum
            });
            fixed.push(self.weighted(flow.collect()));
        }
        let late = |time: &f64| {
            let faded = self.faded(&self.loads, *time);
            self.weighted(self.loads.iter().zip(faded).map(|(load, z)| load - z).collect())
        };
        let first = fixed.len();
        let columns = grid.iter().map(late).collect();
        let system = System { target: self.weighted(self.unit.clone()), fixed, columns };
        let (chosen, weights) = system.best(terms)?;
        let term = |(k, n): (usize, &usize)| CreepTerm {
            compliance: weights[first + k],
            retardation_time: grid[*n],
        };
        let creep = Creep {
            instantaneous: weights[0],
            terms: chosen.iter().enumerate().map(term).collect(),
            fluidity: if parameters.solid { 0.0 } else { weights[1] },
        };
        creep.to_relaxation().ok()
    }

    /// Fallback: the overall stiffness, with the terms spread over the record.
    fn spread(&self, parameters: Parameters) -> Option<Vec<f64>> {
        let mean = dot(&self.unit, &self.loads) / dot(&self.unit, &self.unit);
        if !(mean > 0.0 && mean.is_finite()) {
            return None;
        }
        let n = parameters.terms;
        let [first, last] = [0.003 * self.length, 0.5 * self.length];
        let time = |k: usize| first * (last / first).powf((k as f64 + 0.5) / n as f64);
        let terms = (0..n).map(|k| RelaxationTerm { modulus: mean / n as f64, relaxation_time: time(k) });
        let equilibrium = if parameters.solid { mean } else { 0.0 };
        parameters.of(&Relaxation { equilibrium, terms: terms.collect(), viscosity: 0.0 })
    }
}

/// Columns that are always included, and columns to choose from.
struct System {
    target: Vec<f64>,
    fixed: Vec<Vec<f64>>,
    columns: Vec<Vec<f64>>,
}

impl System {
    /// The `count` columns with the smallest remainder for non-negative weights: the best single one or pair, then the best one
    /// to add each time. The weights are those of the fixed columns, then those of the chosen ones.
    fn best(&self, count: usize) -> Option<(Vec<usize>, Vec<f64>)> {
        let mut chosen: Vec<usize> = vec![];
        let mut weights = if count == 0 { self.fit(&[])?.1 } else { vec![] };
        while chosen.len() < count {
            let n = self.columns.len();
            let candidates: Vec<Vec<usize>> = match (chosen.len(), count) {
                (0, 2..) => (0..n).flat_map(|a| (a + 1..n).map(move |b| vec![a, b])).collect(),
                _ => {
                    let others = (0..n).filter(|k| !chosen.contains(k));
                    others.map(|k| chosen.iter().copied().chain([k]).collect()).collect()
                }
            };
            let fits =
                candidates.into_iter().filter_map(|candidate| Some((self.fit(&candidate)?, candidate)));
            let ((_, found), candidate) = fits.min_by(|a, b| a.0.0.total_cmp(&b.0.0))?;
            (chosen, weights) = (candidate, found);
        }
        Some((chosen, weights))
    }

    /// The remainder and the weights; `None` if one is not positive.
    fn fit(&self, chosen: &[usize]) -> Option<(f64, Vec<f64>)> {
        let columns: Vec<&Vec<f64>> =
            self.fixed.iter().chain(chosen.iter().map(|k| &self.columns[*k])).collect();
        let right: Vec<f64> = columns.iter().map(|a| dot(a, &self.target)).collect();
        let inverse = invert(normal(&columns))?;
        let weights: Vec<f64> = inverse.iter().map(|row| dot(row, &right)).collect();
        let left = dot(&self.target, &self.target) - dot(&weights, &right);
        weights.iter().all(|w| *w > 0.0).then_some((left, weights))
    }
}
