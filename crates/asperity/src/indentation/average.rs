//! Intervals that include the choice of the model: an average over the numbers of terms, for solids and fluids.
//!
//! A record seldom determines the number of terms of a material. Each number of terms, with and without E∞, is a model with a
//! probability (see [`super::nested`]); an interval is that of draws from all of them, each model with its probability (J. A.
//! Hoeting et al., Stat. Sci. 14 (1999) 382). Before the record is seen
//!
//! ```text
//! numbers of terms       equally probable
//! solid or fluid         equally probable
//! ln τ                   uniform from the step of the record to three times its length
//! E_i                    sqrt(E_i) uniform up to 4 E*(0) of the best fit
//! E∞                     uniform up to 2 E*(0)
//! ```
//!
//! The intervals of E*(0) and E∞ are those of all models. Those of E_i and τ_i are from the models with the number of terms of
//! the best fit and from those with more terms that are more probable. Solids and fluids are different kinds: if a record allows
//! both, an interval spans that of the solids and that of the fluids.

use rayon::prelude::*;

use super::check::MOST_TERMS;
use super::least_squares::Solution;
use super::model::Model;
use super::nested::{self, add_logarithms};
use super::parameters::{Law, Parameters};
use super::spectrum::Spectrum;
use super::{IndentationOptions, Interval};
use crate::error::Result;
use crate::material::LongTime;

/// Longest time over the length of the record.
const BEYOND: f64 = 3.0;
/// Largest modulus of a term, and in equilibrium, over E*(0) of the best fit.
const STIFFEST: [f64; 2] = [4.0, 2.0];
/// Number of additional terms, beyond those of the best fit, that are tried.
const MORE: usize = 2;
/// Prior range of the depth of first touch: this many standard deviations from its best value, over the largest depth.
const TOUCH: f64 = 6.0;
/// Probability of a number of terms below which another one takes its place.
pub(super) const EXCLUDED: f64 = 0.05;
/// Fractions of the draws below and above an interval: less than 2.5 %, because the noise itself is only known approximately.
const TAIL: f64 = 0.015;

/// A possible material of the record.
pub(super) struct Draw {
    /// ln of its weight.
    weight: f64,
    pub(super) equilibrium: f64,
    /// (E_i, τ_i), times increasing.
    terms: Vec<[f64; 2]>,
    pub(super) touch: f64,
}

impl Draw {
    /// E*(0).
    pub(super) fn instantaneous(&self) -> f64 {
        self.equilibrium + self.terms.iter().map(|term| term[0]).sum::<f64>()
    }
}

/// All possible materials of the record.
pub(super) struct Average {
    draws: Vec<Draw>,
    /// Terms of the best fit.
    terms: usize,
}

impl Average {
    /// Draws about the best fit; `whole` are the residuals of all rows of the record.
    pub(super) fn new(
        model: &Model,
        best: &Solution,
        whole: &[f64],
        options: &IndentationOptions,
    ) -> Result<Self> {
        let [step, length] = model.window();
        let window = [step, BEYOND * length];
        let spectrum = Spectrum::new(model, best, whole, window)?;
        let parameters = best.parameters;
        let half = TOUCH * parameters.touch(&best.deviations).min(1.0);
        let prior = Prior {
            window,
            stiffest: STIFFEST.map(|times| times * best.relaxation().instantaneous()),
            touch: [best.touch() - half, best.touch() + half],
        };
        let numbers = match options.terms {
            Some(terms) => terms..=terms,
            None => 0..=MOST_TERMS.min(parameters.terms + MORE),
        };
        let kinds: Vec<Parameters> = numbers
            .flat_map(|terms| [true, false].map(|solid| Parameters { terms, solid, ..parameters }))
            .filter(|kind| match options.long_time {
                LongTime::Free => kind.solid || kind.terms > 0,
                LongTime::Solid => kind.solid,
                LongTime::Fluid => !kind.solid && kind.terms > 0,
            })
            .collect();
        let draws = kinds.par_iter().map(|kind| prior.draws(*kind, &spectrum)).collect::<Vec<_>>();
        let mut draws: Vec<Draw> = draws.into_iter().flatten().collect();
        let whole = draws.iter().fold(f64::NEG_INFINITY, |sum, draw| add_logarithms(sum, draw.weight));
        draws.iter_mut().for_each(|draw| draw.weight -= whole);
        Ok(Average { draws, terms: parameters.terms })
    }

    /// Probability of each number of terms, from 0 on.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let mut shares = vec![0.0; MOST_TERMS + 1];
        for draw in &self.draws {
            shares[draw.terms.len()] += draw.weight.exp();
        }
        shares
    }

    /// The most probable number of terms in place of one that is practically excluded.
    pub(super) fn instead_of(&self, terms: usize) -> Option<usize> {
        let numbers = self.numbers();
        let likeliest = (0..numbers.len()).max_by(|a, b| numbers[*a].total_cmp(&numbers[*b]))?;
        (numbers[terms] < EXCLUDED && likeliest != terms).then_some(likeliest)
    }

    /// The modulus (part 0) or time (part 1) of a term of the best fit. If a draw has more terms, its largest ones are used.
    pub(super) fn term(&self, value: f64, k: usize, part: usize) -> Interval {
        let numbers = self.numbers();
        self.interval(value, |draw| {
            let counts = draw.terms.len() >= self.terms && numbers[draw.terms.len()] >= numbers[self.terms];
            counts.then(|| largest(&draw.terms, self.terms)[k][part])
        })
    }

    /// The interval of a property of the draws, around the value of the best fit.
    pub(super) fn interval(&self, value: f64, of: impl Fn(&Draw) -> Option<f64>) -> Interval {
        let values = |fluid: bool| -> Vec<(f64, f64)> {
            let alike = self.draws.iter().filter(|draw| (draw.equilibrium == 0.0) == fluid);
            alike.filter_map(|draw| Some((of(draw)?, draw.weight.exp()))).collect()
        };
        let families = [values(false), values(true)];
        let share = |family: &[(f64, f64)]| family.iter().map(|(_, weight)| weight).sum::<f64>();
        let whole: f64 = families.iter().map(|family| share(family)).sum();
        let likely = families.into_iter().filter(|family| share(family) > TAIL * whole);
        let ends = likely.map(quantiles).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let [low, high] = ends.unwrap_or([0.0, f64::INFINITY]);
        Interval::new(value, [low.min(value), high.max(value)])
    }
}

/// This number of terms with the largest moduli, in order of increasing times.
fn largest(terms: &[[f64; 2]], count: usize) -> Vec<[f64; 2]> {
    let mut terms = terms.to_vec();
    terms.sort_by(|a, b| b[0].total_cmp(&a[0]));
    terms.truncate(count);
    terms.sort_by(|a, b| a[1].total_cmp(&b[1]));
    terms
}

/// Bounds of weighted values without the tails.
fn quantiles(mut values: Vec<(f64, f64)>) -> [f64; 2] {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = values.iter().map(|(_, weight)| weight).sum();
    [TAIL, 1.0 - TAIL].map(|share| {
        let mut below = 0.0;
        let found = values.iter().find(|(_, weight)| {
            below += weight;
            below >= share * whole
        });
        found.or(values.last()).map_or(f64::NAN, |(value, _)| *value)
    })
}

/// The prior.
struct Prior {
    window: [f64; 2],
    stiffest: [f64; 2],
    touch: [f64; 2],
}

impl Prior {
    /// Terms (E_i, ln τ_i), E∞ and touch of a point of the unit cube: times, then moduli of the terms, E∞, touch.
    fn material(&self, kind: Parameters, point: &[f64]) -> (Vec<[f64; 2]>, f64, f64) {
        let modulus = |u: f64| self.stiffest[0] * u * u;
        let [first, last] = self.window.map(f64::ln);
        let n = kind.terms;
        let terms = (0..n).map(|k| [modulus(point[n + k]), first + (last - first) * point[k]]).collect();
        let equilibrium = if kind.solid { self.stiffest[1] * point[2 * n] } else { 0.0 };
        let [low, high] = self.touch;
        let touch = if kind.touch { low + (high - low) * kind.touch(point) } else { 0.0 };
        (terms, equilibrium, touch)
    }

    fn draws(&self, kind: Parameters, spectrum: &Spectrum) -> Vec<Draw> {
        let likelihood = |point: &[f64]| {
            let (terms, equilibrium, touch) = self.material(kind, point);
            spectrum.log_likelihood(equilibrium, &terms, touch)
        };
        let seed = 2 * kind.terms as u64 + u64::from(kind.solid);
        let found = nested::sample(kind.len(), kind.terms, seed, likelihood);
        let draw = |(weight, point): (f64, Vec<f64>)| {
            let (mut terms, equilibrium, touch) = self.material(kind, &point);
            terms.iter_mut().for_each(|term| term[1] = term[1].exp());
            Draw { weight, equilibrium, terms, touch }
        };
        found.into_iter().map(draw).collect()
    }
}
