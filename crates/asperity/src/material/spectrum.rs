//! Discrete spectra from data: the times and weights of a Prony series that fits the rows.
//!
//! 1. Weights on a fixed logarithmic grid of times by non-negative least squares ([`super::nnls`]):
//!    convex, so no start values and no local minima.
//! 2. Parsimony: neighbours are merged and terms left out, one at a time and the cheapest first, each
//!    time refitted with free times ([`super::refine`]), as long as a criterion allows it.
//!
//! Rows are weighted so that residuals are relative. I. Emri & N. W. Tschoegl, Rheologica Acta 32 (1993)
//! 311 (line spectra on a grid); M. Baumgaertel & H. H. Winter, Rheologica Acta 28 (1989) 511
//! (parsimonious spectra with free times).

use crate::material::{nnls, refine, series};

/// The contribution of a term of time tau and weight 1 to one kind of data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kernel {
    /// exp(-t/tau)
    Relaxation,
    /// 1 - exp(-t/tau)
    Creep,
    /// (omega tau)^2 / (1 + (omega tau)^2)
    Storage,
    /// omega tau / (1 + (omega tau)^2)
    Loss,
}

impl Kernel {
    /// Value at x (a time, or an angular frequency).
    pub(super) fn value(self, x: f64, tau: f64) -> f64 {
        match self {
            Kernel::Relaxation => (-x / tau).exp(),
            Kernel::Creep => -(-x / tau).exp_m1(),
            Kernel::Storage => series::debye(1.0 / (x * tau)).0,
            Kernel::Loss => series::debye(x * tau).1,
        }
    }

    /// Value and its derivative by ln tau.
    pub(super) fn value_and_slope(self, x: f64, tau: f64) -> (f64, f64) {
        let value = self.value(x, tau);
        let fast = || series::debye(x * tau).0;
        let slope = match self {
            Kernel::Relaxation => x / tau * value,
            Kernel::Creep => x / tau * (value - 1.0),
            Kernel::Storage => 2.0 * value * fast(),
            Kernel::Loss => value * (2.0 * fast() - 1.0),
        };
        (value, slope)
    }

    /// Contribution of a constant: equilibrium modulus or instantaneous compliance.
    fn constant(self) -> f64 {
        if self == Kernel::Loss { 0.0 } else { 1.0 }
    }

    /// Contribution of the flow t/eta.
    fn flow(self, x: f64) -> f64 {
        if self == Kernel::Creep { x } else { 0.0 }
    }
}

/// One value to be fitted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub kernel: Kernel,
    /// Time \[s\] or angular frequency \[rad/s\].
    pub x: f64,
    pub value: f64,
    /// One over the scale of the value: residuals are relative.
    pub weight: f64,
    /// Number of points that it represents.
    pub count: f64,
}

/// constant + flow x + sum of weights at times.
#[derive(Clone, Debug, Default)]
pub(super) struct Spectrum {
    pub constant: f64,
    pub flow: f64,
    /// (time, weight), in order of time.
    pub terms: Vec<(f64, f64)>,
}

impl Spectrum {
    /// The value of one kind of data at x.
    pub(super) fn value(&self, kernel: Kernel, x: f64) -> f64 {
        let terms: f64 = self.terms.iter().map(|(time, weight)| weight * kernel.value(x, *time)).sum();
        terms + self.constant * kernel.constant() + self.flow * kernel.flow(x)
    }
}

/// Times evenly spaced in the logarithm, both ends included.
pub(super) fn times([first, last]: [f64; 2], per_decade: f64) -> Vec<f64> {
    let decades = (last / first).log10();
    let steps = (decades * per_decade).ceil().max(1.0);
    (0..=steps as usize).map(|k| first * 10f64.powf(decades * k as f64 / steps)).collect()
}

/// Relative accuracy of data; smaller residuals do not count as better.
const DIGITS: f64 = 1e-7;

/// Rows and the terms allowed to fit them.
#[derive(Clone, Debug)]
pub(super) struct Problem {
    pub rows: Vec<Row>,
    pub constant: bool,
    pub flow: bool,
    /// Shortest and longest time of the spectrum \[s\].
    pub range: [f64; 2],
}

impl Problem {
    /// The simplest spectrum that the rows require, from a grid of `per_decade` times, with at most `most` terms.
    pub(super) fn fit(&self, per_decade: f64, most: usize) -> Spectrum {
        let mut best = refine::refine(self, self.weigh(&times(self.range, per_decade)), 10);
        loop {
            let limit = self.information(&best);
            let Some(simpler) = self.fewer(&best, |trial| self.information(trial) <= limit) else { break };
            best = simpler;
        }
        while best.terms.len() > most {
            let Some(fewer) = self.reductions(&best).into_iter().next() else { break };
            best = refine::refine(self, fewer, 100);
        }
        let mut best = refine::refine(self, best, 60);
        // A constant or a flow that the data do not determine would still dominate at all longer times.
        let leaner = [
            Problem { flow: false, ..self.clone() },
            Problem { constant: false, ..self.clone() },
            Problem { flow: false, constant: false, ..self.clone() },
        ];
        for problem in leaner {
            let times: Vec<f64> = best.terms.iter().map(|t| t.0).collect();
            let trial = refine::refine(&problem, problem.weigh(&times), 60);
            if self.information(&trial) < self.information(&best) {
                best = trial;
            }
        }
        best
    }

    /// The fewest terms whose rms residual is at most `misfit`, from a grid of `per_decade` times, left out or merged one at a
    /// time, the least important first; the whole grid if its misfit is larger.
    pub(super) fn fit_within(&self, per_decade: f64, misfit: f64) -> Spectrum {
        let mut best = self.fit_grid(per_decade);
        let within = |spectrum: &Spectrum| self.rms(spectrum) <= misfit;
        while within(&best) && best.terms.len() > 1 {
            let Some(fewer) = self.fewer(&best, within) else { break };
            best = fewer;
        }
        best
    }

    /// Root mean square of the relative residuals; means of several points count with their number.
    fn rms(&self, spectrum: &Spectrum) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0);
        for (residual, row) in self.residuals(spectrum).iter().zip(&self.rows) {
            squares += residual * residual;
            count += row.count;
        }
        f64::sqrt(squares / count)
    }

    /// A spectrum with one term fewer that is good enough.
    fn fewer(&self, spectrum: &Spectrum, enough: impl Fn(&Spectrum) -> bool) -> Option<Spectrum> {
        let trials = self.reductions(spectrum);
        // Usually the least important term can be removed after a few iterations; a long iteration decides at the end.
        [(0, 15), (1, 15), (2, 15), (0, 100)].into_iter().find_map(|(k, iterations)| {
            let trial = refine::refine(self, trials.get(k)?.clone(), iterations);
            enough(&trial).then_some(trial)
        })
    }

    /// The best spectrum from a grid of `per_decade` times, with any number of terms.
    pub(super) fn fit_grid(&self, per_decade: f64) -> Spectrum {
        refine::refine(self, self.weigh(&times(self.range, per_decade)), 60)
    }

    /// The Bayesian information criterion (G. Schwarz, Annals of Statistics 6 (1978) 461): lower is
    /// better; a term has two parameters, constant and flow one each.
    fn information(&self, spectrum: &Spectrum) -> f64 {
        let count = self.rows.len() as f64;
        let squares: f64 = self.residuals(spectrum).iter().map(|r| r * r).sum();
        let fixed = [spectrum.constant, spectrum.flow].iter().filter(|v| **v > 0.0).count();
        let parameters = 2 * spectrum.terms.len() + fixed;
        count * (squares + count * DIGITS * DIGITS).ln() + parameters as f64 * count.ln()
    }

    /// The spectra with one term fewer (left out, or merged with its neighbour), with refitted weights but unchanged times, best
    /// first.
    fn reductions(&self, spectrum: &Spectrum) -> Vec<Spectrum> {
        let n = spectrum.terms.len();
        let times: Vec<f64> = spectrum.terms.iter().map(|t| t.0).collect();
        let merged = spectrum.terms.windows(2).map(|pair| {
            let [(t1, w1), (t2, w2)] = [pair[0], pair[1]];
            t1 * (t2 / t1).powf(w2 / (w1 + w2))
        });
        let all: Vec<f64> = times.iter().copied().chain(merged).collect();
        // One orthogonal reduction is enough for all trials: they use subsets of these columns.
        let (columns, b) = nnls::reduce(&self.columns(&all), &self.targets());
        let fixed = all.len()..columns.len();
        let trials = (0..n).map(|k| (0..n).filter(|j| *j != k).collect::<Vec<_>>());
        let merges = (1..n).map(|k| {
            let merged = n + k - 1;
            (0..k - 1).chain([merged]).chain(k + 1..n).collect::<Vec<_>>()
        });
        let mut spectra: Vec<(f64, Spectrum)> = trials
            .chain(merges)
            .map(|terms| {
                let chosen: Vec<usize> = terms.iter().copied().chain(fixed.clone()).collect();
                let subset: Vec<Vec<f64>> = chosen.iter().map(|j| columns[*j].clone()).collect();
                let x = nnls::solve(&subset, &b);
                let misfit: f64 = (0..b.len())
                    .map(|row| b[row] - subset.iter().zip(&x).map(|(c, x)| c[row] * x).sum::<f64>())
                    .map(|r| r * r)
                    .sum();
                let times: Vec<f64> = terms.iter().map(|j| all[*j]).collect();
                (misfit, self.spectrum(&times, &x))
            })
            .collect();
        spectra.sort_by(|a, b| a.0.total_cmp(&b.0));
        spectra.into_iter().map(|(_, spectrum)| spectrum).collect()
    }

    /// The best weights at given times.
    pub(super) fn weigh(&self, times: &[f64]) -> Spectrum {
        let x = nnls::solve(&self.columns(times), &self.targets());
        self.spectrum(times, &x)
    }

    fn columns(&self, times: &[f64]) -> Vec<Vec<f64>> {
        let column = |f: &dyn Fn(&Row) -> f64| self.rows.iter().map(|r| r.weight * f(r)).collect();
        let mut columns: Vec<Vec<f64>> =
            times.iter().map(|tau| column(&|r| r.kernel.value(r.x, *tau))).collect();
        if self.constant {
            columns.push(column(&|r| r.kernel.constant()));
        }
        if self.flow {
            columns.push(column(&|r| r.kernel.flow(r.x)));
        }
        columns
    }

    fn targets(&self) -> Vec<f64> {
        self.rows.iter().map(|r| r.weight * r.value).collect()
    }

    fn spectrum(&self, times: &[f64], x: &[f64]) -> Spectrum {
        let (weights, fixed) = x.split_at(times.len());
        Spectrum {
            constant: if self.constant { fixed[0] } else { 0.0 },
            flow: if self.flow { fixed[usize::from(self.constant)] } else { 0.0 },
            terms: series::tidy(times.iter().copied().zip(weights.iter().copied())),
        }
    }

    /// Weighted residuals (model - value), row by row.
    pub(super) fn residuals(&self, spectrum: &Spectrum) -> Vec<f64> {
        self.rows.iter().map(|r| r.weight * (spectrum.value(r.kernel, r.x) - r.value)).collect()
    }

    /// Derivatives of the residual of one row by the logarithms of constant, flow, weights and times,
    /// appended to `jacobian`; returns the residual.
    pub(super) fn linearise(&self, row: &Row, spectrum: &Spectrum, jacobian: &mut Vec<f64>) -> f64 {
        jacobian.clear();
        jacobian.push(row.weight * spectrum.constant * row.kernel.constant());
        jacobian.push(row.weight * spectrum.flow * row.kernel.flow(row.x));
        let mut sum = jacobian[0] + jacobian[1] - row.weight * row.value;
        for (tau, w) in &spectrum.terms {
            let (value, slope) = row.kernel.value_and_slope(row.x, *tau);
            jacobian.push(row.weight * w * value);
            jacobian.push(row.weight * w * slope);
            sum += row.weight * w * value;
        }
        sum
    }
}
