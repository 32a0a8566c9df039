//! What uncertain lengths of the test mean for the moduli.
//!
//! The modulus is the measured load over that of a body of unit modulus at the same depth, W1(d; R, h). A length L with the relative
//! standard uncertainty s so adds (s d ln W1/d ln L)² to the variance of its logarithm, here at the largest depth: s/2 of the radius of a
//! sphere on a half-space.

use super::{IndentationOptions, SampleLayer};
use crate::error::Result;
use crate::reference::{LayerContact, MdrProfile};

/// Relative change of a length for its effect on the load.
const CHANGE: f64 = 1e-3;

/// The variance of ln E*.
///
/// # Errors
/// Those of the contact of the layer.
pub(super) fn variance(profile: MdrProfile, options: &IndentationOptions, depth: f64) -> Result<f64> {
    let effect = |of_radius: f64, of_thickness: f64| -> Result<f64> {
        let load = |change: f64| -> Result<f64> {
            let profile = match profile {
                MdrProfile::Sphere { radius } => {
                    MdrProfile::Sphere { radius: radius * (1.0 + of_radius * change) }
                }
                cone => cone,
            };
            match options.layer {
                None => Ok(profile.unit_load(depth)),
                Some(SampleLayer { thickness, poisson, interface }) => {
                    let thickness = thickness * (1.0 + of_thickness * change);
                    Ok(LayerContact::new(profile, thickness, poisson, interface, 1.2 * depth)?.load(depth))
                }
            }
        };
        Ok((load(CHANGE)? / load(-CHANGE)?).ln() / (2.0 * CHANGE))
    };
    let mut sum = 0.0;
    for (uncertainty, of) in
        [(options.radius_uncertainty, [1.0, 0.0]), (options.thickness_uncertainty, [0.0, 1.0])]
    {
        if uncertainty > 0.0 {
            sum += (uncertainty * effect(of[0], of[1])?).powi(2);
        }
    }
    Ok(sum)
}
