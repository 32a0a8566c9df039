//! Layers that creep differently: C(q, t) is not a function of q times one of t.
//!
//! By the correspondence principle the transform of the creep compliance at s > 0 is that of the elastic stack with the moduli
//! μ~_i(s). It is a Stieltjes function of s: with K_i the positive stiffness of part i and f the load, C~ = f' (Σ μ~_i(s) K_i)^-1
//! f is real and finite wherever all μ~_i(s) are positive, and Im C~ has one sign in the half plane. Therefore
//!
//! ```text
//! C(q, t) = S_0(q) + Σ S_j(q) (1 - exp(-t/λ_j)),   S_j >= 0
//! ```
//!
//! and all times λ_j lie between a relaxation time of a material and the next retardation time, because outside these intervals
//! all μ~_i are positive on the negative axis. (A constant bulk modulus is one more positive K_i.) Here nodes λ_j, equally spaced
//! in ln λ, cover the intervals. The weights of each wave follow from C~(q, s) by least squares with S_j >= 0: at s = 1/λ_j, and
//! in the middle between separate intervals, where C~ determines the sum of the preceding weights. The values at t = 0 and for
//! long times are exact.

use std::sync::Arc;

use super::body::{LayeredBody, stack};
use super::{Layered, Stack};
use crate::error::{Error, Result};
use crate::kernel::Kernel;
use crate::material::{Body, Creep, CreepTerm, Lateral, least_squares};

/// Largest relative error of C~(q, s) that is accepted.
pub(crate) const TOLERANCE: f64 = 1e-3;
/// Error at which the spacing of the nodes is not refined further: for the first three spacings, and for the narrow ones, which
/// take longer to plan.
const WANTED: [f64; 2] = [3e-5, 3e-4];
/// Spacings of ln λ that are tried.
const SPACINGS: [f64; 5] = [0.4, 0.3, 0.2, 0.1, 0.06];
/// Largest number of nodes: if more are needed, the spacing is wider.
const MOST: usize = 96;
/// Weight of the row that sets the relaxed compliance, over the other rows.
const EXACT: f64 = 1e3;
/// A wave whose compliance rises by less than this fraction does not creep.
const STILL: f64 = 1e-6;
/// Weights below this fraction of the relaxed compliance are left out.
const NONE: f64 = 1e-10;
/// Number of waves on which the fit is checked.
const JUDGED: usize = 64;
/// Nodes with a larger ratio are separate: C~ is fitted between them as well.
const APART: f64 = 5.0;

/// Creep compliance of bodies whose waves creep differently.
#[derive(Clone, Debug)]
pub struct NonseparableLayers {
    /// λ_j \[s\], ascending.
    nodes: Vec<f64>,
    /// The s at which C~ is fitted, besides ∞ and 0 \[1/s\].
    pub(crate) frequencies: Vec<f64>,
    /// The elastic bodies at s = ∞, 0 and `frequencies`: a kernel, and the compliance \[1/Pa\] that multiplies it.
    pub(crate) stages: Vec<(Arc<Layered>, f64)>,
    misfit: f64,
}

impl NonseparableLayers {
    /// The layers of one body against a rigid one, or of two bodies.
    pub(super) fn new(bodies: &[LayeredBody]) -> Result<Self> {
        let intervals = intervals(bodies)?;
        let mut best: Option<NonseparableLayers> = None;
        for spacing in SPACINGS {
            let nodes = nodes(&intervals, spacing);
            let between = nodes.windows(2).filter(|pair| pair[1] > APART * pair[0]);
            let between = between.map(|pair| (pair[0] * pair[1]).sqrt());
            let frequencies: Vec<f64> = nodes.iter().copied().chain(between).map(|time| 1.0 / time).collect();
            let all = [f64::INFINITY, 0.0].into_iter().chain(frequencies.iter().copied());
            let stages = all.map(|s| elastic(bodies, s)).collect::<Result<Vec<_>>>()?;
            let mut tried = NonseparableLayers { nodes, frequencies, stages, misfit: 0.0 };
            tried.misfit = tried.misfit_of(bodies)?;
            if best.as_ref().is_none_or(|best| tried.misfit < best.misfit) {
                best = Some(tried);
            }
            let wanted = WANTED[usize::from(spacing <= SPACINGS[2])];
            if best.as_ref().is_some_and(|best| best.misfit < wanted) {
                break;
            }
        }
        best.filter(|best| best.misfit <= TOLERANCE).ok_or_else(|| {
            let first = bodies.iter().flat_map(LayeredBody::materials).next();
            Error::invalid(
                format!("creep of the layers of {}", first.map_or("", |material| &material.name)),
                "not described by a sum of exponentials",
                format!("a sum that is exact to {TOLERANCE:e}: use materials with fewer or closer relaxation times"),
            )
        })
    }

    /// The elastic bodies of short times: the kernel of the instantaneous response.
    pub(crate) fn glassy(&self) -> &Layered {
        &self.stages[0].0
    }

    /// The bending length of the stiff layers on the soft ones after all creep \[m\]: total thickness times the cube root of the
    /// largest ratio of the moduli.
    pub(crate) fn bending_length(&self) -> f64 {
        let length = |stack: &Stack| {
            let total: f64 = stack.layers().iter().map(|layer| layer.thickness).sum();
            total * libm::cbrt(stack.contrast())
        };
        self.stages[1].0.stacks().iter().map(length).fold(0.0, f64::max)
    }

    /// Whether the displacement far from a load creeps: that of a half-space below the layers.
    pub(crate) fn creeps_far_away(&self) -> bool {
        let long_waves = |(kernel, compliance): &(Arc<Layered>, f64)| {
            let stacks = kernel.stacks().iter();
            let [long, short] =
                [Stack::long_waves, Stack::short_waves].map(|of| stacks.clone().map(of).sum::<f64>());
            compliance * long / short
        };
        let [glassy, relaxed] = [0, 1].map(|stage| long_waves(&self.stages[stage]));
        relaxed - glassy > TOLERANCE * relaxed
    }

    /// The shortest and the longest retardation time \[s\].
    pub fn times(&self) -> [f64; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Largest relative error of the fitted compliance over all waves and frequencies.
    pub fn misfit(&self) -> f64 {
        self.misfit
    }

    /// C(q, t) \[m/Pa\] of waves of wave number q > 0 \[rad/m\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if q is so extreme that the compliance is out of range.
    pub fn creep(&self, q: f64) -> Result<Creep> {
        let values: Vec<f64> = self.stages.iter().map(|(kernel, c)| c * kernel.symbol(q, 0.0)).collect();
        self.fit(&values).map(|(creep, _)| creep).ok_or_else(|| {
            Error::invalid("wave number", format!("{q:e} rad/m"), "one whose compliance is positive")
        })
    }

    /// The creep function with these values of C~ at the `stages`, and its largest relative error there; `None`
    /// if it is not that of a passive body.
    pub(crate) fn fit(&self, values: &[f64]) -> Option<(Creep, f64)> {
        let [glassy, relaxed, between @ ..] = values else { return None };
        let rise = relaxed - glassy;
        if !(*glassy > 0.0 && relaxed.is_finite() && rise >= -TOLERANCE * relaxed) {
            return None;
        }
        if rise <= STILL * relaxed {
            return Some((Creep::elastic(*glassy), rise.abs() / relaxed));
        }
        // Rows of C~ - S_0 over C~.
        let rows: Vec<(f64, f64, f64)> = std::iter::once((0.0, rise, EXACT / relaxed))
            .chain(between.iter().zip(&self.frequencies).map(|(c, s)| (*s, c - glassy, 1.0 / c.abs())))
            .collect();
        let column = |time: &f64| rows.iter().map(|(s, _, weight)| weight / (1.0 + s * time)).collect();
        let columns: Vec<Vec<f64>> = self.nodes.iter().map(column).collect();
        let wanted: Vec<f64> = rows.iter().map(|(_, value, weight)| weight * value).collect();
        let weights = least_squares(&columns, &wanted);
        let terms = self.nodes.iter().zip(&weights).filter(|(_, weight)| **weight > NONE * relaxed);
        let terms: Vec<CreepTerm> =
            terms.map(|(time, weight)| CreepTerm { compliance: *weight, retardation_time: *time }).collect();
        let fitted = |s: f64| -> f64 {
            terms.iter().map(|term| term.compliance / (1.0 + s * term.retardation_time)).sum()
        };
        let misfit = |(s, value, weight): &(f64, f64, f64)| weight * (fitted(*s) - value).abs();
        let worst = rows[1..].iter().map(misfit).fold((fitted(0.0) - rise).abs() / relaxed, f64::max);
        Some((Creep { instantaneous: *glassy, terms, fluidity: 0.0 }, worst))
    }

    /// Largest relative error of C~ over the waves, at frequencies beside those of the fit.
    fn misfit_of(&self, bodies: &[LayeredBody]) -> Result<f64> {
        let [shortest, longest] = self.times();
        // In the middle between two nodes, or on both sides of the value of s that is fitted there.
        let between = self.nodes.windows(2).flat_map(|pair| {
            let ratio = pair[1] / pair[0];
            let parts: &[f64] = if ratio > APART { &[0.25, 0.75] } else { &[0.5] };
            parts.iter().map(move |part| 1.0 / (pair[0] * libm::pow(ratio, *part)))
        });
        let frequencies: Vec<f64> = between.chain([0.2 / longest, 5.0 / shortest]).collect();
        let checks = frequencies.iter().map(|s| elastic(bodies, *s)).collect::<Result<Vec<_>>>()?;
        let layers = || bodies.iter().flat_map(|body| &body.layers).map(|layer| layer.thickness);
        let (thinnest, total) = (layers().fold(f64::INFINITY, f64::min), layers().sum::<f64>());
        let (first, last) = (libm::log(1e-3 / total), libm::log(30.0 / thinnest));
        let mut worst = 0.0_f64;
        for n in 0..JUDGED {
            let q = libm::exp(first + (last - first) * n as f64 / (JUDGED - 1) as f64);
            let creep = self.creep(q)?;
            for (s, (kernel, c)) in frequencies.iter().zip(&checks) {
                let exact = c * kernel.symbol(q, 0.0);
                let terms =
                    creep.terms.iter().map(|term| term.compliance / (1.0 + s * term.retardation_time));
                worst = worst.max(((creep.instantaneous + terms.sum::<f64>()) / exact - 1.0).abs());
            }
        }
        Ok(worst)
    }
}

/// The elastic bodies with the moduli at s, 0 <= s <= ∞, as a kernel and its compliance.
fn elastic(bodies: &[LayeredBody], s: f64) -> Result<(Arc<Layered>, f64)> {
    let stacks = bodies.iter().map(|body| {
        let moduli = body.materials().map(|material| moduli(material, s)).collect::<Result<Vec<_>>>()?;
        stack(body, &moduli)
    });
    let stacks = stacks.collect::<Result<Vec<Stack>>>()?;
    let compliance = 0.5 * stacks.iter().map(Stack::short_waves).sum::<f64>();
    Ok((Arc::new(Layered::new(stacks)?), compliance))
}

/// Shear modulus and Poisson's ratio at s.
fn moduli(material: &Body, s: f64) -> Result<(f64, f64)> {
    let creep = material.shear()?;
    let terms = creep.terms.iter().map(|term| match s.is_infinite() {
        true => 0.0,
        false => term.compliance / (1.0 + s * term.retardation_time),
    });
    let shear = 1.0 / (creep.instantaneous + terms.sum::<f64>());
    Ok(match material.lateral {
        Lateral::Poisson(nu) => (shear, nu),
        Lateral::BulkModulus(bulk) => (shear, (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))),
    })
}

/// The intervals of the retardation times of all waves \[s\]: disjoint and ascending.
fn intervals(bodies: &[LayeredBody]) -> Result<Vec<[f64; 2]>> {
    let mut all = vec![];
    let materials = bodies.iter().enumerate().flat_map(|(n, body)| {
        body.materials().enumerate().map(move |(k, material)| (body.place(n, k), material))
    });
    for (place, material) in materials {
        let creep = material.shear()?.tidy();
        let flows = creep.fluidity > 0.0;
        if flows || creep.instantaneous <= 0.0 {
            let what =
                if flows { "one that flows without end" } else { "one without an instantaneous compliance" };
            return Err(Error::invalid(
                format!("creep function of {}", material.name),
                what,
                "one with an instantaneous compliance and a limit for long times, where layers creep differently: add an equilibrium \
                 modulus, or a spring in series",
            )
            .of(&place));
        }
        let relaxation = creep.to_relaxation()?;
        let (e, c) = (&relaxation.terms, &creep.terms);
        match e.len() == c.len() {
            true => all.extend(e.iter().zip(c).map(|(e, c)| [e.relaxation_time, c.retardation_time])),
            // A term from rounding has no partner.
            false => {
                all.extend(e.first().zip(c.last()).map(|(e, c)| [e.relaxation_time, c.retardation_time]))
            }
        }
    }
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut merged: Vec<[f64; 2]> = vec![];
    for [start, end] in all {
        match merged.last_mut() {
            Some(last) if start <= last[1] => last[1] = last[1].max(end),
            _ => merged.push([start, end]),
        }
    }
    Ok(merged)
}

/// Nodes on the intervals, ends included.
fn nodes(intervals: &[[f64; 2]], spacing: f64) -> Vec<f64> {
    let length = |[a, b]: &[f64; 2]| libm::log(b / a);
    let total: f64 = intervals.iter().map(length).sum();
    let spare = MOST.saturating_sub(2 * intervals.len()).max(1);
    let spacing = spacing.max(total / spare as f64);
    let of_one = |interval: &[f64; 2]| {
        let ([start, _], whole) = (*interval, length(interval));
        // For a narrow interval, the ends are as accurate as the middle.
        let parts = if whole < 1e-6 { 0 } else { (whole / spacing).ceil().max(1.0) as usize };
        let node = move |n: usize| start * libm::exp(whole * n as f64 / parts.max(1) as f64);
        (0..=parts).map(node).collect::<Vec<f64>>()
    };
    intervals.iter().flat_map(of_one).collect()
}
