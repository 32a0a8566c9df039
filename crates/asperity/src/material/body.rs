//! The contact creep compliance C(t) of a half-space, from its material.
//!
//! The compliance of the surface of an elastic half-space is 1/E* = (1 - nu^2)/E = (1 - nu)/(2 G) (K. L. Johnson, Contact
//! Mechanics, 1985, section 3.2). By the correspondence principle (E. H. Lee & J. R. M. Radok 1960) the same holds for Laplace
//! transforms, which gives
//!
//! - Poisson's ratio constant in time: C(t) = (1 - nu^2) D(t) = (1 - nu) J(t) / 2;
//! - bulk modulus B constant in time: C(t) = (1/4) \[J_G(t) + 3 J_(3B+G)(t)\], where J_X is the creep
//!   function that belongs to the relaxation function X(t), since
//!   (1 - nu)/(2 G) = (3 B + 4 G)/(4 G (3 B + G)) = (1/4) \[1/G + 3/(3 B + G)\].

use crate::error::{Error, Result, positive, require};
use crate::material::{Creep, Material, Modulus};

/// The second elastic constant of an isotropic body, constant in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lateral {
    /// Poisson's ratio, -1 < nu <= 0.5 (0.5: incompressible).
    Poisson(f64),
    /// Bulk modulus \[Pa\].
    BulkModulus(f64),
}

/// Poisson's ratio nu(t) as a function of time, and the function k(t) that belongs to nu/(1 - nu): the lateral stress that a
/// unit step of pressure on a body without lateral strain causes. Both without unit, as series of the form of [`Creep`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoissonCreep {
    /// nu(t).
    pub ratio: Creep,
    /// k(t).
    pub confined: Creep,
}

/// One deformable half-space.
///
/// ```
/// use asperity::material::{Body, Lateral, Material, Modulus};
/// let steel = Body {
///     name: "steel".into(),
///     material: Material::elastic(Modulus::Young, 210e9)?,
///     lateral: Lateral::Poisson(0.3),
///     hardness: None,
/// };
/// let contact_modulus = 1.0 / steel.contact_creep()?.value(0.0);
/// assert!((contact_modulus / 230.769e9 - 1.0).abs() < 1e-5); // E / (1 - nu^2)
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name in messages.
    pub name: String,
    /// Its creep function.
    pub material: Material,
    /// Poisson's ratio or bulk modulus.
    pub lateral: Lateral,
    /// Largest pressure on the surface \[Pa\]; `None`: no limit.
    pub hardness: Option<f64>,
}

impl Body {
    /// Poisson's ratio if it is constant in time: the given one, or that of an elastic body with this bulk modulus B: (3 B - 2
    /// G)/(2 (3 B + G)) = 1/2 - E/(6 B).
    ///
    /// ```
    /// use asperity::material::{Body, Lateral, Material, Modulus};
    /// let material = Material::elastic(Modulus::Shear, 1e9)?;
    /// let body = Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(5e9), hardness: None };
    /// assert!((body.poisson().unwrap() - 13.0 / 32.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn poisson(&self) -> Option<f64> {
        let creep = self.material.creep();
        match self.lateral {
            Lateral::Poisson(poisson) => Some(poisson),
            Lateral::BulkModulus(_) if !creep.terms.is_empty() || creep.fluidity > 0.0 => None,
            Lateral::BulkModulus(bulk) => Some(match self.material.measure() {
                Modulus::Young => 0.5 - 1.0 / (6.0 * bulk * creep.instantaneous),
                Modulus::Shear => {
                    let three = 3.0 * bulk * creep.instantaneous;
                    (three - 2.0) / (2.0 * (three + 1.0))
                }
            }),
        }
    }

    /// Poisson's ratio as a function of time, as measured after a step of uniaxial tension.
    ///
    /// A bulk modulus B constant in time has, by the correspondence principle, nu(t) = -1 + (9 B/2) J_(3B+G)(t), since
    /// nu = (3 B - 2 G)/(2 (3 B + G)) = -1 + (9 B/2)/(3 B + G); and without lateral strain
    /// nu/(1 - nu) = (3 B - 2 G)/(3 B + 4 G) = -1/2 + (9 B/2)/(3 B + 4 G).
    ///
    /// ```
    /// use asperity::material::{Body, Lateral, Material, Modulus};
    /// // G = 1 GPa at once, 0.5 GPa in the end; B = 5 GPa: nu = 13/32 and 14/31.
    /// let material = Material::zener(Modulus::Shear, 1e9, 1e9, 2.0)?;
    /// let body = Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(5e9), hardness: None };
    /// let ratio = body.poisson_creep()?.ratio;
    /// assert!((ratio.value(0.0) - 13.0 / 32.0).abs() < 1e-12 && (ratio.long_time() - 14.0 / 31.0).abs() < 1e-12);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`contact_creep`](Self::contact_creep).
    pub fn poisson_creep(&self) -> Result<PoissonCreep> {
        match self.lateral {
            Lateral::Poisson(nu) => {
                Ok(PoissonCreep { ratio: Creep::elastic(nu), confined: Creep::elastic(nu / (1.0 - nu)) })
            }
            Lateral::BulkModulus(bulk) => {
                positive(&format!("bulk modulus of {}", self.name), bulk, "Pa")?;
                let shear = self.shear_creep(bulk)?.to_relaxation()?;
                // (9 B/2) J of the relaxation function 3 B + factor G, less `offset`.
                let of = |factor: f64, offset: f64| -> Result<Creep> {
                    let mut stiffer = shear.scaled(factor);
                    stiffer.equilibrium += 3.0 * bulk;
                    let creep = stiffer.to_creep()?.scaled(4.5 * bulk);
                    Ok(Creep { instantaneous: creep.instantaneous - offset, ..creep })
                };
                Ok(PoissonCreep { ratio: of(1.0, 1.0)?, confined: of(4.0, 0.5)? })
            }
        }
    }

    /// C(t) of this body against a rigid one \[1/Pa\].
    ///
    /// ```
    /// use asperity::material::{Body, Lateral, Material, Modulus};
    /// // Bulk modulus 5 GPa: C(0) = (1/4) [1/G + 3/(3 B + G)], which is (1 - nu)/(2 G) of the same body.
    /// let material = Material::zener(Modulus::Shear, 1e9, 1e9, 2.0)?;
    /// let body = Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(5e9), hardness: None };
    /// let nu = (15e9 - 2e9) / (2.0 * 16e9);
    /// assert!((body.contact_creep()?.instantaneous / ((1.0 - nu) / 2e9) - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if Poisson's ratio is outside (-1, 0.5], the bulk modulus or the hardness
    /// is not positive, or the bulk modulus is too small for the Young's moduli (9 B > E(0) is needed).
    pub fn contact_creep(&self) -> Result<Creep> {
        let hardness = self.hardness.unwrap_or(f64::INFINITY);
        let expected = "greater than 0 Pa (leave it out for no limit)";
        require(hardness > 0.0, format!("hardness of {}", self.name), hardness, expected)?;
        let creep = self.material.creep();
        match self.lateral {
            Lateral::Poisson(nu) if nu > -1.0 && nu <= 0.5 => {
                Ok(creep.scaled(match self.material.measure() {
                    Modulus::Young => 1.0 - nu * nu,
                    Modulus::Shear => 0.5 * (1.0 - nu),
                }))
            }
            Lateral::Poisson(nu) => Err(Error::invalid(
                format!("Poisson's ratio of {}", self.name),
                nu,
                "greater than -1 and not greater than 0.5",
            )),
            Lateral::BulkModulus(bulk) => {
                positive(&format!("bulk modulus of {}", self.name), bulk, "Pa")?;
                let shear_creep = self.shear_creep(bulk)?;
                let mut stiffer = shear_creep.to_relaxation()?;
                stiffer.equilibrium += 3.0 * bulk;
                Ok(shear_creep.sum(&stiffer.to_creep()?.scaled(3.0)).scaled(0.25))
            }
        }
    }

    /// D(t) or J(t), the creep function of Young's or of the shear modulus \[1/Pa\]. From J(t) with a constant Poisson's ratio nu it is
    /// D = J/(2 (1 + nu)), with a bulk modulus B it is D = J/3 + 1/(9 B), which is 1/E = 1/(3 G) + 1/(9 B).
    ///
    /// ```
    /// use asperity::material::{Body, Lateral, Material, Modulus};
    /// let material = Material::elastic(Modulus::Shear, 1e9)?;
    /// let body = Body { name: "resin".into(), material, lateral: Lateral::BulkModulus(5e9), hardness: None };
    /// let young = 9.0 * 5e9 * 1e9 / (3.0 * 5e9 + 1e9);
    /// assert!((body.creep(Modulus::Young)?.instantaneous * young - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if the bulk modulus is too small for the Young's moduli (9 B > E(0) is needed).
    pub fn creep(&self, measure: Modulus) -> Result<Creep> {
        let own = self.material.creep();
        match (measure, self.lateral) {
            _ if measure == self.material.measure() => Ok(own.clone()),
            (Modulus::Shear, _) => self.shear(),
            (Modulus::Young, Lateral::Poisson(nu)) => Ok(own.scaled(0.5 / (1.0 + nu))),
            (Modulus::Young, Lateral::BulkModulus(bulk)) => {
                let third = own.scaled(1.0 / 3.0);
                Ok(Creep { instantaneous: third.instantaneous + 1.0 / (9.0 * bulk), ..third })
            }
        }
    }

    /// J(t), the shear creep function.
    pub(crate) fn shear(&self) -> Result<Creep> {
        match (self.lateral, self.material.measure()) {
            (Lateral::BulkModulus(bulk), _) => self.shear_creep(bulk),
            (Lateral::Poisson(_), Modulus::Shear) => Ok(self.material.creep().clone()),
            (Lateral::Poisson(nu), Modulus::Young) => Ok(self.material.creep().scaled(2.0 * (1.0 + nu))),
        }
    }

    /// J(t) of a body of bulk modulus B: from D(t), J = 3 D - 1/(3 B), which is 1/G = 3/E - 1/(3 B).
    fn shear_creep(&self, bulk: f64) -> Result<Creep> {
        let creep = self.material.creep();
        match self.material.measure() {
            Modulus::Shear => Ok(creep.clone()),
            Modulus::Young => {
                let instantaneous = 3.0 * creep.instantaneous - 1.0 / (3.0 * bulk);
                // Below this, G(0) would be rounding noise or negative (Poisson's ratio at its end, -1).
                if instantaneous <= 1e-12 * creep.instantaneous {
                    return Err(Error::invalid(
                        format!("bulk modulus of {}", self.name),
                        format!("{bulk:e} Pa"),
                        format!(
                            "greater than a ninth of the instantaneous Young's modulus, {:e} Pa",
                            1.0 / (9.0 * creep.instantaneous)
                        ),
                    ));
                }
                Ok(Creep { instantaneous, ..creep.scaled(3.0) })
            }
        }
    }
}

/// The hardness of the softer body \[Pa\]; `f64::INFINITY` if neither has one.
pub fn pair_hardness(bodies: &[Body]) -> f64 {
    bodies.iter().filter_map(|b| b.hardness).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Relaxation;

    fn body(material: Material, lateral: Lateral) -> Body {
        Body { name: "sample".into(), material, lateral, hardness: None }
    }

    fn zener(measure: Modulus) -> Material {
        Material::zener(measure, 6e6, 3e6, 2.0).unwrap()
    }

    #[test]
    fn poisson_scales_the_creep_function() {
        for (measure, factor) in [(Modulus::Young, 1.0 - 0.38 * 0.38), (Modulus::Shear, 0.31)] {
            let creep = body(zener(measure), Lateral::Poisson(0.38)).contact_creep().unwrap();
            for t in [0.0, 1.0, 50.0] {
                assert!((creep.value(t) / (factor * zener(measure).creep().value(t)) - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_bulk_modulus_gives_the_elastic_value_at_every_laplace_variable() {
        let bulk = 5e6;
        for measure in [Modulus::Young, Modulus::Shear] {
            let material = zener(measure);
            let creep = body(material.clone(), Lateral::BulkModulus(bulk)).contact_creep().unwrap();
            let laplace = |c: &Creep, s: f64| {
                c.instantaneous
                    + c.terms.iter().map(|c| c.compliance / (1.0 + s * c.retardation_time)).sum::<f64>()
            };
            for s in [1e-6, 0.1, 0.7, 3.0, 1e6] {
                let modulus = 1.0 / laplace(material.creep(), s);
                let shear = match measure {
                    Modulus::Young => 3.0 * bulk * modulus / (9.0 * bulk - modulus),
                    Modulus::Shear => modulus,
                };
                let nu = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
                let exact = (1.0 - nu) / (2.0 * shear);
                // Roundings of a handful of operations.
                assert!((laplace(&creep, s) / exact - 1.0).abs() < 1e-14, "{measure:?} {s}");
            }
        }
    }

    #[test]
    fn an_infinite_bulk_modulus_is_incompressible() {
        let incompressible = body(zener(Modulus::Young), Lateral::Poisson(0.5)).contact_creep().unwrap();
        let stiff = body(zener(Modulus::Young), Lateral::BulkModulus(1e20)).contact_creep().unwrap();
        for t in [0.0, 1.0, 50.0] {
            // G/B = 2e-14 apart.
            assert!((stiff.value(t) / incompressible.value(t) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn a_kelvin_voigt_and_a_fluid_body_take_a_bulk_modulus() {
        let kelvin_voigt = Material::kelvin_voigt(Modulus::Shear, 3e6, 2.0).unwrap();
        let creep = body(kelvin_voigt, Lateral::BulkModulus(5e6)).contact_creep().unwrap();
        assert_eq!(creep.instantaneous, 0.0);
        // At long times it is elastic: (1/4) [1/G + 3/(3 B + G)].
        assert!((creep.long_time() / (0.25 * (1.0 / 3e6 + 3.0 / 18e6)) - 1.0).abs() < 1e-15);
        let fluid = Relaxation::absolute(0.0, &[(3e6, 2.0)]).unwrap();
        let creep = body(Material::prony(Modulus::Shear, fluid).unwrap(), Lateral::BulkModulus(5e6));
        // Flow is shear flow: a quarter of 1/(G tau).
        assert!((creep.contact_creep().unwrap().fluidity * 24e6 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn two_bodies_add_their_compliance_and_the_softer_one_yields() {
        let mut polymer = body(zener(Modulus::Young), Lateral::Poisson(0.4));
        polymer.hardness = Some(3e8);
        let steel = body(Material::elastic(Modulus::Young, 210e9).unwrap(), Lateral::Poisson(0.3));
        let creep = |body: &Body| body.contact_creep().unwrap();
        let pair = creep(&polymer).sum(&creep(&steel));
        for t in [0.0, 1.0, 50.0] {
            let sum = creep(&polymer).value(t) + 0.91 / 210e9;
            assert!((pair.value(t) / sum - 1.0).abs() < 1e-15);
        }
        assert_eq!(creep(&polymer).sum(&creep(&polymer)).terms.len(), 1);
        assert_eq!(pair_hardness(&[steel.clone(), polymer]), 3e8);
        assert_eq!(pair_hardness(&[steel]), f64::INFINITY);
    }

    #[test]
    fn bad_bodies_are_named() {
        let says = |lateral, hardness, words: &str| {
            let bad = Body { hardness, ..body(zener(Modulus::Young), lateral) };
            let error = bad.contact_creep().unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        says(Lateral::Poisson(0.51), None, "Poisson's ratio of sample is 0.51");
        says(Lateral::Poisson(-1.0), None, "Poisson's ratio of sample is -1");
        says(Lateral::Poisson(f64::NAN), None, "Poisson's ratio of sample is NaN");
        says(Lateral::BulkModulus(0.0), None, "bulk modulus of sample is 0");
        // 9 B = E(0) needs an infinite shear modulus.
        says(Lateral::BulkModulus(6e6 / 9.0), None, "greater than a ninth");
        says(Lateral::Poisson(0.3), Some(-1.0), "hardness of sample is -1");
        says(Lateral::Poisson(0.3), Some(f64::NAN), "hardness of sample is NaN");
    }
}
