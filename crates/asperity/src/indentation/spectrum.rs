//! A record as a linear function of the relaxation spectrum.
//!
//! Near the best fit the fitted channel y is linear in the moduli (exactly under a given depth while the contact grows; otherwise
//! to second order in the change of y, which is within the noise for every relevant material):
//!
//! ```text
//! y(E∞, E_i, τ_i) - y_best = E∞ a(∞) + Σ E_i a(τ_i) - (the same of the best fit)
//! ```
//!
//! a(τ), the response to a small term of this time, is computed at ten times per decade and is smooth in between. A sum of
//! squares only needs the scalar products of these columns and of the residuals. A pivoted Cholesky factorisation of their Gram
//! matrix replaces hundreds of rows by a dozen coordinates with the same scalar products. A sum of squares then takes a hundred
//! nanoseconds instead of milliseconds.

use rayon::prelude::*;

use super::blocks::smoothed;
use super::least_squares::Solution;
use super::model::Model;
use super::parameters::Law;
use super::select::MODEL_ERROR;
use crate::error::Result;
use crate::material::{Relaxation, RelaxationTerm, dot};

/// Times of the grid per decade.
const PER_DECADE: f64 = 10.0;
/// Springs of the model for the columns.
const SPRINGS: usize = 60;
/// Size of the small term over E*(0).
const SMALL: f64 = 1e-3;
/// Squared length of a coordinate, in units of the noise, that is left out.
const NOTHING: f64 = 1e-4;
/// Largest accepted correlation of neighbours in the noise.
const MOST_ALIKE: f64 = 0.95;
/// Largest number of rows that count as one.
const MOST_CORRELATED: f64 = 100.0;

/// The log-likelihood of any relaxation function.
pub(super) struct Spectrum {
    /// ln τ of the first column, and between columns.
    first: f64,
    step: f64,
    /// Columns a(τ), a(∞), and that of the depth of first touch (over the largest depth), in coordinates in which the noise
    /// has the variance 1.
    columns: Vec<Vec<f64>>,
    equilibrium: Vec<f64>,
    touch: Option<Vec<f64>>,
    /// The right-hand side for the columns.
    target: Vec<f64>,
}

impl Spectrum {
    /// Linearises around the best fit, for times within `window` \[s\]. `whole`: the residuals of all rows of the record, of whose
    /// means `best` is the fit. The larger of both standard deviations counts: the rows show how neighbours are correlated, their
    /// means what varies slowly.
    pub(super) fn new(model: &Model, best: &Solution, whole: &[f64], window: [f64; 2]) -> Result<Self> {
        let (relaxation, parameters) = (best.relaxation(), best.parameters);
        let times = || relaxation.terms.iter().map(|term| term.relaxation_time);
        let first = times().fold(window[0], f64::min).ln();
        let last = times().fold(window[1], f64::max).ln();
        let count = (PER_DECADE * (last - first) / std::f64::consts::LN_10).ceil().clamp(4.0, 120.0) as usize;
        let step = (last - first) / count as f64;

        let (touch, depth) = (best.touch(), model.depth_scale());
        // Without its noise, which would make the columns of short times noisy.
        let history = smoothed(&model.times, (model.taken(), &model.given_noise));
        let respond = |relaxation: &Relaxation, touch: f64| {
            model.respond(relaxation, depth * touch, &history, SPRINGS).map(|prediction| prediction.values)
        };
        let small = SMALL * relaxation.instantaneous();
        let base = respond(&relaxation, touch)?;
        let sd = deviation(&best.residuals, parameters.len()).max(deviation(whole, parameters.len()));
        let weights: Vec<f64> =
            model.weights(&model.predict(best.parameters, &best.at)?).iter().map(|w| w / sd).collect();
        let column = |changed: Vec<f64>, by: f64| {
            let rows = changed.iter().zip(&base).zip(&weights);
            model.of_compared(&rows.map(|((there, here), w)| (there - here) / by * w).collect::<Vec<f64>>())
        };
        let mut columns: Vec<Vec<f64>> = (0..=count)
            .into_par_iter()
            .map(|k| {
                let mut more = relaxation.clone();
                let relaxation_time = (first + k as f64 * step).exp();
                more.terms.push(RelaxationTerm { modulus: small, relaxation_time });
                Ok(column(respond(&more, touch)?, small))
            })
            .collect::<Result<_>>()?;
        let stiffer = Relaxation { equilibrium: relaxation.equilibrium + small, ..relaxation.clone() };
        columns.push(column(respond(&stiffer, touch)?, small));
        if parameters.touch {
            columns.push(column(respond(&relaxation, touch + SMALL)?, SMALL));
        }
        columns.push(best.residuals.iter().map(|r| -r / sd).collect());

        let mut coordinates = compressed(&columns, relaxation.instantaneous());
        let mut pop = || coordinates.pop().unwrap_or_default();
        let target = pop();
        let touch_column = parameters.touch.then(&mut pop);
        let equilibrium = pop();
        let mut spectrum =
            Spectrum { first, step, columns: coordinates, equilibrium, touch: touch_column, target };
        // The residuals are those of the best fit.
        let terms: Vec<[f64; 2]> =
            relaxation.terms.iter().map(|term| [term.modulus, term.relaxation_time.ln()]).collect();
        let mut whole = vec![0.0; spectrum.target.len()];
        spectrum.add(&mut whole, relaxation.equilibrium, &terms, touch);
        spectrum.target.iter_mut().zip(&whole).for_each(|(t, w)| *t += w);
        Ok(spectrum)
    }

    /// -χ²/2 of E∞, terms (E_i, ln τ_i), and the depth of first touch over the largest depth.
    pub(super) fn log_likelihood(&self, equilibrium: f64, terms: &[[f64; 2]], touch: f64) -> f64 {
        let mut left: Vec<f64> = self.target.iter().map(|t| -t).collect();
        self.add(&mut left, equilibrium, terms, touch);
        -0.5 * dot(&left, &left)
    }

    fn add(&self, to: &mut [f64], equilibrium: f64, terms: &[[f64; 2]], touch: f64) {
        add(to, equilibrium, &self.equilibrium);
        if let Some(column) = &self.touch {
            add(to, touch, column);
        }
        for [modulus, ln_time] in terms {
            // Cubic (Catmull-Rom) between the columns.
            let place = ((ln_time - self.first) / self.step).clamp(0.0, (self.columns.len() - 1) as f64);
            let k = (place as usize).min(self.columns.len() - 2);
            let s = place - k as f64;
            let (s2, s3) = (s * s, s * s * s);
            let weights = [
                0.5 * (-s3 + 2.0 * s2 - s),
                0.5 * (3.0 * s3 - 5.0 * s2 + 2.0),
                0.5 * (-3.0 * s3 + 4.0 * s2 + s),
                0.5 * (s3 - s2),
            ];
            for (i, weight) in weights.into_iter().enumerate() {
                let column = (k + i).saturating_sub(1).min(self.columns.len() - 1);
                add(to, modulus * weight, &self.columns[column]);
            }
        }
    }
}

fn add(to: &mut [f64], factor: f64, column: &[f64]) {
    to.iter_mut().zip(column).for_each(|(t, c)| *t += factor * c);
}

/// Standard deviation of a weighted residual, where this many numbers were fitted. Correlated neighbours contain less information than independent ones: with the
/// correlation ρ of one row with the next, n rows are equivalent to n (1 - ρ)/(1 + ρ) independent ones.
pub(super) fn deviation(residuals: &[f64], parameters: usize) -> f64 {
    let k = parameters as f64;
    let alike = (1.0 - 0.5 * durbin_watson(residuals)).clamp(0.0, MOST_ALIKE);
    let variance = dot(residuals, residuals) / (residuals.len() as f64 - k) * (1.0 + alike) / (1.0 - alike);
    variance.sqrt().max(MODEL_ERROR)
}

/// Σ (r_k - r_(k-1))²/Σ r_k², 2 (1 - ρ) where ρ is the correlation of neighbours (J. Durbin & G. S. Watson, Biometrika 37
/// (1950) 409).
pub(crate) fn durbin_watson(residuals: &[f64]) -> f64 {
    let squares = dot(residuals, residuals);
    let jumps: f64 = residuals.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    if squares > 0.0 { jumps / squares } else { 2.0 }
}

/// Variance of a mean of residuals over that of independent ones, 1 + 2 Σ ρ_k: the correlations ρ_k of rows k apart, up to the first that is not
/// greater than 0 (C. J. Geyer, Stat. Sci. 7 (1992) 473). It also finds what varies slowly.
pub(crate) fn correlation(residuals: &[f64]) -> f64 {
    let squares = dot(residuals, residuals);
    let mut sum = 1.0;
    for apart in 1..=residuals.len() / 4 {
        let alike = dot(&residuals[apart..], &residuals[..residuals.len() - apart]);
        if alike.is_nan() || alike <= 0.0 || sum > MOST_CORRELATED {
            break;
        }
        sum += 2.0 * alike / squares;
    }
    sum.min(MOST_CORRELATED)
}

/// Coordinates with the same scalar products, by a pivoted Cholesky factorisation of the Gram matrix; all columns but the
/// last are multiplied by numbers up to `scale`.
fn compressed(columns: &[Vec<f64>], scale: f64) -> Vec<Vec<f64>> {
    let n = columns.len();
    let size = |k: usize| if k + 1 == n { 1.0 } else { scale };
    let gram: Vec<Vec<f64>> =
        columns.par_iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
    let mut left: Vec<f64> = (0..n).map(|k| gram[k][k]).collect();
    let mut coordinates: Vec<Vec<f64>> = vec![vec![]; n];
    for rank in 0..n {
        let longest = |k: &usize| left[*k] * size(*k) * size(*k);
        let Some(pivot) = (0..n).max_by(|a, b| longest(a).total_cmp(&longest(b))) else { break };
        // If a column depends linearly on the others, the remainder is rounding.
        if longest(&pivot).is_nan() || longest(&pivot) < NOTHING || left[pivot] < 1e-13 * gram[pivot][pivot] {
            break;
        }
        let root = left[pivot].sqrt();
        let along: Vec<f64> = (0..n)
            .map(|k| {
                let known = dot(&coordinates[k][..rank], &coordinates[pivot][..rank]);
                (gram[k][pivot] - known) / root
            })
            .collect();
        for (k, x) in along.into_iter().enumerate() {
            coordinates[k].push(x);
            left[k] = (left[k] - x * x).max(0.0);
        }
    }
    coordinates
}
