//! The record as a function of the parameters.
//!
//! Both channels are noisy. Noise δ of the given channel changes the model in proportion to its slope S = d model/d given, so the
//! residual of a row has the variance ("effective variance"; J. Orear, Am. J. Phys. 50 (1982) 912)
//!
//! ```text
//! v_k = σ_fitted² + S_k² σ_given²
//! ```
//!
//! S_k = 2 a_k ∫ E* over the step under a given depth, one over it under a given load; a_k is the radius of the contact. It
//! changes with the parameters: with a fixed radius, the noise of the given channel would make the body appear too soft.

use super::blocks::{blocks, means};
use super::check::LARGEST;
use super::noise;
use super::parameters::Law;
use super::{Given, IndentationOptions, SampleLayer};
use crate::error::{Error, Result, require};
use crate::material::Relaxation;
use crate::reference::{LayerContact, Mdr, MdrProfile, MdrTarget, SpringProfile};

/// Steps between two rows if the load is given: the response is of second order in the step (under a given depth one step is
/// exact).
const SUBSTEPS: usize = 2;

/// Largest depth of a sphere over its radius: noise may pass the radius, and deeper the sphere is below the surface.
const DEEPEST: f64 = 1.1;

/// If the load is given, loads below this fraction of the largest, or this number of standard deviations of the noise, count as no load.
const LOADED: f64 = 0.02;
const NOISE: f64 = 6.0;

/// Smallest assumed noise of the fitted channel, over its largest value: the error of the model and of the digits.
const LEAST_NOISE: f64 = 1e-4;
/// Smallest noise (squared) of a row, over the largest of all rows: noise never vanishes completely with the value.
const LEAST_SHARE: f64 = 0.01;

/// Records of more rows are averaged to at most about this number of blocks.
const MANY: usize = 2000;

/// A record, and the rule that predicts one of its channels from the other.
#[derive(Clone)]
pub(super) struct Model {
    profile: MdrProfile,
    /// The body, if it is a layer.
    layer: Option<(LayerContact, SpringProfile)>,
    /// Times from the first row on \[s\].
    pub(super) times: Vec<f64>,
    pub(super) loads: Vec<f64>,
    pub(super) depths: Vec<f64>,
    pub(super) given: Given,
    pub(super) fit_touch: bool,
    springs: usize,
    reach: f64,
    /// Largest measured value of the predicted channel.
    pub(super) scale: f64,
    /// Rows where model and measurement are compared.
    compared: Vec<bool>,
    /// Variance of the noise at each row: of the fitted channel, and of the given one.
    fitted_noise: Vec<f64>,
    pub(super) given_noise: Vec<f64>,
    /// Mean variance of the noise of a row of the fitted channel.
    typical: f64,
    /// Number of rows whose mean each row is.
    pub(super) counts: Vec<f64>,
    window: [f64; 2],
}

/// The fitted channel according to the model.
pub(super) struct Prediction {
    pub(super) values: Vec<f64>,
    /// Change of a value per change of the given channel of its row.
    slopes: Vec<f64>,
}

impl Model {
    pub(super) fn new(
        profile: MdrProfile,
        mut times: Vec<f64>,
        loads: Vec<f64>,
        depths: Vec<f64>,
        given: Given,
        options: &IndentationOptions,
    ) -> Result<Self> {
        profile.validate()?;
        if let Some(radius) = profile.radius()
            && let Some(depth) = depths.iter().find(|depth| **depth > DEEPEST * radius)
        {
            return Err(Error::invalid(
                "depth",
                format!("{depth:e} m"),
                format!("at most {DEEPEST} times the radius of the sphere, {radius:e} m (check their units)"),
            ));
        }
        let start = times[0];
        times.iter_mut().for_each(|time| *time -= start);
        let largest = |column: &[f64]| column.iter().copied().fold(0.0, f64::max);
        let layer = match options.layer {
            None => None,
            Some(SampleLayer { thickness, poisson, interface }) => {
                // The fit may change the depth of first touch.
                let deepest = 1.2 * largest(&depths);
                let layer = LayerContact::new(profile, thickness, poisson, interface, deepest)?;
                let springs = layer.springs();
                Some((layer, springs))
            }
        };
        let reach = 1.05
            * match &layer {
                None => profile.reach(largest(&depths)),
                Some((_, springs)) => springs.reach(largest(&depths)),
            };
        require(
            (1.0 / LARGEST..=LARGEST).contains(&reach),
            "radius of the largest contact",
            format!("{reach:e} m"),
            "one that can be measured (check the units of depth, radius and slope)",
        )?;
        let scale = match given {
            Given::Depth => largest(&loads),
            Given::Load => largest(&depths),
        };
        // Without load the depth contains no information: the indenter may be anywhere above the surface.
        let small = noise::smallest(&noise::variances(&times, &loads)).sqrt();
        let least = (LOADED * largest(&loads)).max(NOISE * small);
        let compared = loads.iter().map(|load| given == Given::Depth || *load > least).collect();
        let (fitted, taken) = match given {
            Given::Depth => (&loads, &depths),
            Given::Load => (&depths, &loads),
        };
        let mut fitted_noise = noise::variances(&times, fitted);
        let given_noise = noise::variances(&times, taken);
        let most = fitted_noise.iter().copied().fold((LEAST_NOISE * scale).powi(2), f64::max);
        let least = (LEAST_NOISE * scale).powi(2).max(LEAST_SHARE * most);
        fitted_noise.iter_mut().for_each(|variance| *variance = variance.max(least));
        let (fit_touch, springs) = (options.fit_touch, options.springs);
        let typical = fitted_noise.iter().sum::<f64>() / fitted_noise.len() as f64;
        let (counts, window) = (vec![1.0; times.len()], window(&times));
        Ok(Model {
            profile,
            layer,
            times,
            loads,
            depths,
            given,
            fit_touch,
            springs,
            reach,
            scale,
            compared,
            fitted_noise,
            given_noise,
            typical,
            counts,
            window,
        })
    }

    /// The model of the means of the blocks of a long record, and the number of the middle row of each block; of a short record the
    /// model as it is.
    pub(super) fn averaged(&self) -> (Self, Vec<usize>) {
        if self.times.len() <= MANY {
            return (self.clone(), (0..self.times.len()).collect());
        }
        let (fitted, given) =
            ((self.measured(), &self.fitted_noise[..]), (self.taken(), &self.given_noise[..]));
        let blocks = blocks(&self.times, &[fitted, given], MANY);
        let mean = |column: &[f64]| means(column, &blocks);
        let variance = |column: &[f64]| -> Vec<f64> {
            mean(column).into_iter().zip(&blocks).map(|(v, rows)| v / rows.len() as f64).collect()
        };
        let middle = blocks.iter().map(|rows| (rows.start + rows.end - 1) / 2).collect::<Vec<_>>();
        let averaged = Model {
            times: mean(&self.times),
            loads: mean(&self.loads),
            depths: mean(&self.depths),
            compared: middle.iter().map(|row| self.compared[*row]).collect(),
            fitted_noise: variance(&self.fitted_noise),
            given_noise: variance(&self.given_noise),
            counts: blocks.iter().map(|rows| rows.len() as f64).collect(),
            layer: self.layer.clone(),
            ..*self
        };
        (averaged, middle)
    }

    /// The same rows of another test: the model with this indenter, sample, loads and depths.
    pub(super) fn with(
        &self,
        profile: MdrProfile,
        options: &IndentationOptions,
        [loads, depths]: [Vec<f64>; 2],
    ) -> Result<Self> {
        let changed = Model::new(profile, self.times.clone(), loads, depths, self.given, options)?;
        let Model { compared, fitted_noise, given_noise, typical, counts, window, .. } = self.clone();
        Ok(Model { compared, fitted_noise, given_noise, typical, counts, window, ..changed })
    }

    pub(super) fn depth_scale(&self) -> f64 {
        self.depths.iter().copied().fold(0.0, f64::max)
    }

    /// The channel that is predicted.
    pub(super) fn measured(&self) -> &[f64] {
        match self.given {
            Given::Depth => &self.loads,
            Given::Load => &self.depths,
        }
    }

    /// The channel that is taken as measured.
    pub(super) fn taken(&self) -> &[f64] {
        match self.given {
            Given::Depth => &self.depths,
            Given::Load => &self.loads,
        }
    }

    /// Step and length of the record \[s\]: nine of ten steps between its rows are longer.
    pub(super) fn window(&self) -> [f64; 2] {
        self.window
    }

    /// Number of rows of the record where model and measurement are compared.
    pub(super) fn rows(&self) -> f64 {
        self.of_compared(&self.counts).iter().sum()
    }

    /// phi(d) = 2 int_0^a (d - g) dx, the load at the depth d for E* = 1 \[m²\], and its slope 2 a \[m\].
    pub(super) fn unit_load(&self, depth: f64) -> (f64, f64) {
        if depth <= 0.0 {
            return (0.0, 0.0);
        }
        if let Some((layer, _)) = &self.layer {
            return (layer.load(depth), 2.0 * layer.stiffness(layer.radius(depth)));
        }
        (self.profile.unit_load(depth), 2.0 * self.profile.reach(depth))
    }

    /// Model minus measurement at each row where they are compared, over the largest measured value, and weighted: rows with more
    /// noise than the mean of the fitted channel have less weight, the mean of n rows has sqrt(n) times that of one.
    pub(super) fn residuals<L: Law>(&self, parameters: L, at: &[f64]) -> Result<Vec<f64>> {
        let predicted = self.predict(parameters, at)?;
        let apart = predicted.values.iter().zip(self.measured()).map(|(model, measured)| model - measured);
        let weighted: Vec<f64> = apart.zip(self.weights(&predicted)).map(|(apart, w)| apart * w).collect();
        Ok(self.of_compared(&weighted))
    }

    /// Weights of the residuals of all rows.
    pub(super) fn weights(&self, predicted: &Prediction) -> Vec<f64> {
        let rows = predicted.slopes.iter().zip(&self.fitted_noise).zip(&self.given_noise);
        rows.map(|((slope, fitted), given)| {
            (self.typical / (fitted + slope.min(1e100).powi(2) * given)).sqrt() / self.scale
        })
        .collect()
    }

    /// The rows where model and measurement are compared.
    pub(super) fn of_compared(&self, column: &[f64]) -> Vec<f64> {
        column.iter().zip(&self.compared).filter(|(_, compared)| **compared).map(|(x, _)| *x).collect()
    }

    /// The same rows without a comparison at the first one.
    pub(super) fn without_first(&self) -> Self {
        let mut model = self.clone();
        model.compared.iter_mut().take(1).for_each(|compared| *compared = false);
        model
    }

    /// The same rows with another number of springs.
    pub(super) fn with_springs(&self, springs: usize) -> Self {
        Model { springs, ..self.clone() }
    }

    /// The profile of the indenter.
    pub(super) fn profile(&self) -> MdrProfile {
        self.profile
    }

    /// Number of rows where model and measurement are compared.
    pub(super) fn compared(&self) -> usize {
        self.compared.iter().filter(|compared| **compared).count()
    }

    /// The channel that is not given, at each row.
    pub(super) fn predict<L: Law>(&self, parameters: L, at: &[f64]) -> Result<Prediction> {
        let touch = self.depth_scale() * parameters.touch(at);
        self.respond(&parameters.body(at)?, touch, self.taken(), self.springs)
    }

    /// The response of a body to a history of the given channel, with the surface at the depth `touch`.
    pub(super) fn respond(
        &self,
        relaxation: &Relaxation,
        touch: f64,
        history: &[f64],
        springs: usize,
    ) -> Result<Prediction> {
        let mut row = match &self.layer {
            None => Mdr::new(self.profile, relaxation, self.reach, springs)?,
            Some((_, layer)) => Mdr::on_layer(layer.clone(), relaxation, self.reach, springs)?,
        };
        let mut prediction = Prediction { values: vec![], slopes: vec![] };
        for n in 0..self.times.len() {
            let dt = if n == 0 { 0.0 } else { self.times[n] - self.times[n - 1] };
            // Load over depth, both changed within the step.
            let stiffness = |radius: f64| 2.0 * radius * step_modulus(relaxation, dt);
            let (value, slope) = match self.given {
                Given::Depth => {
                    let state = row.step(dt, MdrTarget::Approach(history[n] - touch))?;
                    (state.load, stiffness(state.contact_radius))
                }
                Given::Load => {
                    let load = history[n].max(0.0);
                    let before = if n == 0 { load } else { history[n - 1].max(0.0) };
                    let substeps = if n == 0 { 1 } else { SUBSTEPS };
                    let (mut depth, mut radius) = (0.0, 0.0);
                    for k in 1..=substeps {
                        let share = k as f64 / substeps as f64;
                        let target = MdrTarget::Load(before + share * (load - before));
                        let state = row.step(dt / substeps as f64, target)?;
                        (depth, radius) = (state.approach, state.contact_radius);
                    }
                    (depth + touch, if radius > 0.0 { 1.0 / stiffness(radius) } else { 0.0 })
                }
            };
            prediction.values.push(value);
            prediction.slopes.push(slope);
        }
        match prediction.values.iter().all(|value| (value / self.scale).abs() < 1e100) {
            true => Ok(prediction),
            false => {
                Err(Error::invalid("model of the record", "not finite", "finite (check units and radius)"))
            }
        }
    }
}

/// Mean of E*(t) over a step: the effective modulus for a ramp within it.
fn step_modulus(relaxation: &Relaxation, dt: f64) -> f64 {
    let share = |x: f64| if x > 1e-9 { -(-x).exp_m1() / x } else { 1.0 };
    let terms = relaxation.terms.iter().map(|term| term.modulus * share(dt / term.relaxation_time));
    relaxation.equilibrium + terms.sum::<f64>()
}

/// Step \[s\], which nine of ten steps exceed, and length of a record.
fn window(times: &[f64]) -> [f64; 2] {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let tenth = steps.len() / 10;
    let step = *steps.select_nth_unstable_by(tenth, f64::total_cmp).1;
    [step, times[times.len() - 1]]
}
