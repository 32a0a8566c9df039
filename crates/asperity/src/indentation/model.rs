//! The record as a function of the parameters.

use super::{Given, IndentationOptions, LARGEST};
use crate::error::{Error, Result, positive};
use crate::material::{Relaxation, RelaxationTerm};
use crate::reference::{Mdr, MdrProfile, MdrTarget};

/// Steps between two rows where the load is given: its response is of second order in them (under a given depth one
/// step is exact).
const SUBSTEPS: usize = 2;

/// Loads below this share of the largest are none, where the load is given.
const LOADED: f64 = 0.02;

/// A record, and the rule that predicts one of its channels from the other.
pub(super) struct Model {
    profile: MdrProfile,
    /// From the first row on \[s\].
    pub(super) times: Vec<f64>,
    pub(super) loads: Vec<f64>,
    pub(super) depths: Vec<f64>,
    given: Given,
    fit_touch: bool,
    springs: usize,
    reach: f64,
    /// Largest measured value of the predicted channel.
    scale: f64,
    /// Rows where model and measurement are compared.
    compared: Vec<bool>,
}

/// Which numbers are sought: \[ln E∞\], ln E_i, ln τ_i, \[depth of first touch over the largest depth\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parameters {
    pub(super) solid: bool,
    pub(super) terms: usize,
    pub(super) touch: bool,
}

impl Parameters {
    pub(super) fn len(&self) -> usize {
        usize::from(self.solid) + 2 * self.terms + usize::from(self.touch)
    }

    pub(super) fn relaxation(&self, at: &[f64]) -> Relaxation {
        let first = usize::from(self.solid);
        let term = |k: usize| RelaxationTerm {
            modulus: at[first + k].exp(),
            relaxation_time: at[first + self.terms + k].exp(),
        };
        let mut terms: Vec<RelaxationTerm> = (0..self.terms).map(term).collect();
        terms.sort_by(|a, b| a.relaxation_time.total_cmp(&b.relaxation_time));
        Relaxation { equilibrium: if self.solid { at[0].exp() } else { 0.0 }, terms, viscosity: 0.0 }
    }

    /// The parameters of a relaxation function; `None` where it has another form.
    pub(super) fn of(&self, relaxation: &Relaxation) -> Option<Vec<f64>> {
        let positive = |x: f64| (x > 0.0 && x.is_finite()).then(|| x.ln());
        let mut at = vec![];
        if relaxation.viscosity > 0.0 || relaxation.terms.len() != self.terms {
            return None;
        }
        match self.solid {
            true => at.push(positive(relaxation.equilibrium)?),
            false if relaxation.equilibrium == 0.0 => {}
            false => return None,
        }
        for term in &relaxation.terms {
            at.push(positive(term.modulus)?);
        }
        for term in &relaxation.terms {
            at.push(positive(term.relaxation_time)?);
        }
        at.extend(self.touch.then_some(0.0));
        Some(at)
    }

    /// The modulus or time that is known least, with its standard deviation.
    pub(super) fn worst(&self, deviations: &[f64]) -> Option<(String, f64)> {
        let first = usize::from(self.solid);
        let name = |k: usize| match k {
            0 if self.solid => "the equilibrium modulus".to_owned(),
            k if k < first + self.terms => format!("the modulus of term {}", k - first + 1),
            k => format!("the time of term {}", k - first - self.terms + 1),
        };
        let known = deviations.iter().take(first + 2 * self.terms).enumerate();
        let worst = known.max_by(|a, b| a.1.total_cmp(b.1))?;
        Some((name(worst.0), *worst.1))
    }
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
        match profile {
            MdrProfile::Sphere { radius } => positive("radius of the sphere", radius, "m")?,
            MdrProfile::Cone { slope } => positive("slope of the cone", slope, "")?,
        };
        if let MdrProfile::Sphere { radius } = profile
            && let Some(depth) = depths.iter().find(|depth| **depth > radius)
        {
            return Err(Error::invalid(
                "depth",
                format!("{depth:e} m"),
                format!("less than the radius of the sphere, {radius:e} m (check their units)"),
            ));
        }
        let start = times[0];
        times.iter_mut().for_each(|time| *time -= start);
        let largest = |column: &[f64]| column.iter().copied().fold(0.0, f64::max);
        let reach = 1.05 * profile.reach(largest(&depths));
        if !(1.0 / LARGEST..=LARGEST).contains(&reach) {
            return Err(Error::invalid(
                "radius of the largest contact",
                format!("{reach:e} m"),
                "one that can be measured (check the units of depth, radius and slope)",
            ));
        }
        let scale = match given {
            Given::Depth => largest(&loads),
            Given::Load => largest(&depths),
        };
        // Without load a depth tells nothing: the indenter may be anywhere above the surface.
        let least = LOADED * largest(&loads);
        let compared = loads.iter().map(|load| given == Given::Depth || *load > least).collect();
        let (fit_touch, springs) = (options.fit_touch, options.springs);
        Ok(Model { profile, times, loads, depths, given, fit_touch, springs, reach, scale, compared })
    }

    pub(super) fn given(&self) -> Given {
        self.given
    }

    pub(super) fn fits_touch(&self) -> bool {
        self.fit_touch
    }

    pub(super) fn scale(&self) -> f64 {
        self.scale
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

    /// Shortest step and length of the record \[s\].
    pub(super) fn window(&self) -> [f64; 2] {
        let steps = self.times.windows(2).map(|pair| pair[1] - pair[0]);
        [steps.fold(f64::INFINITY, f64::min), self.times[self.times.len() - 1]]
    }

    /// phi(d) = 2 int_0^a (d - g) dx, the load at the depth d for E* = 1 \[m²\], and its slope 2 a \[m\].
    pub(super) fn unit_load(&self, depth: f64) -> (f64, f64) {
        if depth <= 0.0 {
            return (0.0, 0.0);
        }
        let a = self.profile.reach(depth);
        match self.profile {
            MdrProfile::Sphere { .. } => (4.0 / 3.0 * depth * a, 2.0 * a),
            MdrProfile::Cone { .. } => (depth * a, 2.0 * a),
        }
    }

    /// Model less measurement over the largest measured value, at each row where they are compared.
    pub(super) fn residuals(&self, parameters: &Parameters, at: &[f64]) -> Result<Vec<f64>> {
        let predicted = self.predict(parameters, at)?;
        let rows =
            predicted.iter().zip(self.measured()).zip(&self.compared).filter(|(_, compared)| **compared);
        Ok(rows.map(|((model, measured), _)| (model - measured) / self.scale).collect())
    }

    /// Number of rows where model and measurement are compared.
    pub(super) fn compared(&self) -> usize {
        self.compared.iter().filter(|compared| **compared).count()
    }

    /// The channel that is not given, at each row.
    pub(super) fn predict(&self, parameters: &Parameters, at: &[f64]) -> Result<Vec<f64>> {
        let relaxation = parameters.relaxation(at);
        let touch = if parameters.touch { self.depth_scale() * at[parameters.len() - 1] } else { 0.0 };
        let mut springs = Mdr::new(self.profile, &relaxation, self.reach, self.springs)?;
        let mut predicted = Vec::with_capacity(self.times.len());
        for n in 0..self.times.len() {
            let dt = if n == 0 { 0.0 } else { self.times[n] - self.times[n - 1] };
            let value = match self.given {
                Given::Depth => springs.step(dt, MdrTarget::Approach(self.depths[n] - touch))?.load,
                Given::Load => {
                    let load = self.loads[n].max(0.0);
                    let before = if n == 0 { load } else { self.loads[n - 1].max(0.0) };
                    let substeps = if n == 0 { 1 } else { SUBSTEPS };
                    let mut depth = 0.0;
                    for k in 1..=substeps {
                        let share = k as f64 / substeps as f64;
                        let target = MdrTarget::Load(before + share * (load - before));
                        depth = springs.step(dt / substeps as f64, target)?.approach;
                    }
                    depth + touch
                }
            };
            predicted.push(value);
        }
        match predicted.iter().all(|value| (value / self.scale).abs() < 1e100) {
            true => Ok(predicted),
            false => {
                Err(Error::invalid("model of the record", "not finite", "finite (check units and radius)"))
            }
        }
    }
}
