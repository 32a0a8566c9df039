//! Load and stiffness of an elastic half-space, or of a thin sample on a rigid base, for E* = 1.

use crate::error::Result;
use crate::indentation::SampleLayer;
use crate::reference::{LayerContact, MdrProfile};

/// Points of the table of a thin sample, evenly spaced in the root of the depth: between them its ratios to the half-space are straight.
const POINTS: usize = 400;
/// Depths of the table over that of the contact as a half-space would have it; the first for which the contact is one of the theory.
const DEEPER: [f64; 3] = [2.0, 1.4, 1.1];
/// A change for its effect on the load.
const CHANGE: f64 = 1e-3;

/// An elastic body under an indenter.
pub(super) struct Body {
    pub(super) profile: MdrProfile,
    layer: Option<Ratios>,
}

/// Load and stiffness of a thin sample over those of the half-space.
struct Ratios {
    deepest: f64,
    load: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Body {
    pub(super) fn half_space(profile: MdrProfile) -> Self {
        Body { profile, layer: None }
    }

    /// A thin sample for depths of about this size.
    pub(super) fn new(profile: MdrProfile, layer: Option<SampleLayer>, depth: f64) -> Result<Self> {
        let Some(sample) = layer else { return Ok(Body::half_space(profile)) };
        let mut tried = DEEPER.iter().map(|times| {
            let deepest = times * depth;
            contact(profile, sample, deepest).map(|contact| (contact, deepest))
        });
        let last = contact(profile, sample, depth);
        let (contact, deepest) = match tried.find_map(Result::ok) {
            Some(found) => found,
            None => (last?, depth),
        };
        let at = |k: usize| deepest * (k as f64 / POINTS as f64).powi(2);
        let of = |ratio: &dyn Fn(f64) -> f64| {
            let inside = (1..=POINTS).map(|k| ratio(at(k)));
            // At the apex the sample is a half-space.
            std::iter::once(1.0).chain(inside).collect::<Vec<f64>>()
        };
        let load = of(&|depth| contact.load(depth) / profile.unit_load(depth));
        let stiffness = of(&|depth| contact.stiffness(contact.radius(depth)) / profile.reach(depth));
        Ok(Body { profile, layer: Some(Ratios { deepest, load, stiffness }) })
    }

    /// Load \[m²\] at a depth \[m\].
    pub(super) fn load(&self, depth: f64) -> f64 {
        let depth = depth.max(0.0);
        self.profile.unit_load(depth) * self.layer.as_ref().map_or(1.0, |layer| layer.at(&layer.load, depth))
    }

    /// Half of the stiffness \[m\], on a half-space the radius of the contact.
    pub(super) fn reach(&self, depth: f64) -> f64 {
        let depth = depth.max(0.0);
        self.profile.reach(depth) * self.layer.as_ref().map_or(1.0, |layer| layer.at(&layer.stiffness, depth))
    }
}

impl Ratios {
    fn at(&self, table: &[f64], depth: f64) -> f64 {
        let place = POINTS as f64 * (depth / self.deepest).sqrt().min(1.0);
        let k = (place as usize).min(POINTS - 1);
        table[k] + (place - k as f64) * (table[k + 1] - table[k])
    }
}

fn contact(profile: MdrProfile, sample: SampleLayer, deepest: f64) -> Result<LayerContact> {
    let SampleLayer { thickness, poisson, interface } = sample;
    LayerContact::new(profile, thickness, poisson, interface, deepest)
}

/// d ln E*/d ln x of a record of this depth, of the size of the indenter and of the thickness of a sample: the load is the same.
pub(super) fn exponents(profile: MdrProfile, layer: Option<SampleLayer>, depth: f64) -> Result<[f64; 2]> {
    let load = |times: [f64; 2]| -> Result<f64> {
        let profile = profile.scaled(times[0]);
        match layer {
            None => Ok(profile.unit_load(depth)),
            Some(sample) => {
                let sample = SampleLayer { thickness: sample.thickness * times[1], ..sample };
                Ok(contact(profile, sample, depth)?.load(depth))
            }
        }
    };
    let (up, down) = (1.0 + CHANGE, 1.0 - CHANGE);
    let by_size = load([down, 1.0])? / load([up, 1.0])?;
    let by_thickness = load([1.0, down])? / load([1.0, up])?;
    Ok([by_size, by_thickness].map(|ratio| ratio.ln() / (2.0 * CHANGE)))
}
