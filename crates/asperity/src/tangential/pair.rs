//! The pair of bodies under tangential tractions.

use crate::error::{Error, Result};
use crate::material::Body;

/// Poisson's ratio of a pair, and how much pressure and tangential traction act on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairRatio {
    /// The mean of both bodies, weighted by their shear compliances 1/G.
    pub poisson: f64,
    /// Dundurs' β = \[(1 - 2 ν1)/G1 - (1 - 2 ν2)/G2\] / \[2 (1 - ν1)/G1 + 2 (1 - ν2)/G2\]; where it changes in time, the larger one of that
    /// at t = 0+ and that of the retarded strains.
    pub beta: f64,
    /// Whether β changes in time: the bodies creep, and not alike.
    pub changes: bool,
}

impl PairRatio {
    /// Of one body on a rigid one, or of two.
    ///
    /// ```
    /// use asperity::material::{Body, Lateral, Material, Modulus};
    /// use asperity::tangential::PairRatio;
    /// let body = |young, ratio| Body {
    ///     name: "body".into(), hardness: None,
    ///     material: Material::elastic(Modulus::Young, young).unwrap(), lateral: Lateral::Poisson(ratio),
    /// };
    /// // Equal bodies do not act on each other; a rubber and a rigid body hardly do.
    /// let alike = PairRatio::of(&[body(1e9, 0.3), body(1e9, 0.3)])?;
    /// assert!((alike.poisson - 0.3).abs() < 1e-15 && alike.beta == 0.0);
    /// let stiff = PairRatio::of(&[body(1e9, 0.25)])?;
    /// assert!((stiff.beta - 1.0 / 3.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] where Poisson's ratio of a body or of the pair changes in time.
    pub fn of(bodies: &[Body]) -> Result<PairRatio> {
        let [mut shear, mut weighted] = [0.0; 2];
        // [(1 - 2 ν1)/G1 - (1 - 2 ν2)/G2, 2 (1 - ν1)/G1 + 2 (1 - ν2)/G2] at t = 0+ and of the retarded strains.
        let mut dundurs = [[0.0; 2]; 2];
        let (mut ratios, mut creeps) = (vec![], vec![]);
        for (body, sign) in bodies.iter().zip([1.0, -1.0]) {
            let Some(nu) = body.poisson() else {
                let expected = "constant in time under a tangential load: the response along the surface would change its form. Give \
                                poisson in place of bulk_modulus";
                return Err(Error::invalid(
                    format!("Poisson's ratio of {}", body.name),
                    "changing in time",
                    expected,
                ));
            };
            let own = body.contact_creep()?;
            // 1/G = 2 C/(1 - ν)
            let compliance = 2.0 * own.instantaneous / (1.0 - nu);
            shear += compliance;
            weighted += nu * compliance;
            let late = own.instantaneous + own.terms.iter().map(|term| term.compliance).sum::<f64>();
            for ([difference, sum], c) in dundurs.iter_mut().zip([own.instantaneous, late]) {
                *difference += sign * (1.0 - 2.0 * nu) * 2.0 * c / (1.0 - nu);
                *sum += 4.0 * c;
            }
            ratios.push((nu, !own.remembers()));
            creeps.push(own);
        }
        let are_alike = ratios.windows(2).all(|pair| (pair[0].0 - pair[1].0).abs() <= 1e-12);
        let are_elastic = ratios.iter().all(|(_, elastic)| *elastic);
        if !are_alike && !are_elastic {
            let values = ratios.iter().map(|(nu, _)| nu.to_string()).collect::<Vec<_>>().join(" and ");
            let expected = "the same of both bodies under a tangential load, where one of them is viscoelastic: that of the pair would \
                            change in time. Leave out a body that is much stiffer: it is rigid then";
            return Err(Error::invalid("Poisson's ratio of the bodies", values, expected));
        }
        let poisson = match ratios.first() {
            Some((nu, _)) if are_alike => *nu,
            _ => weighted / shear,
        };
        let [early, late] = dundurs.map(|[difference, sum]| if sum > 0.0 { difference / sum } else { 0.0 });
        let beta = if late.abs() > early.abs() { late } else { early };
        // Bodies of like materials, and incompressible ones, do not act on each other at any time.
        let changes = !are_elastic && creeps.windows(2).any(|pair| pair[0] != pair[1]) && poisson < 0.5;
        Ok(PairRatio { poisson, beta, changes })
    }
}
