//! Named models: springs and dashpots, each reduced to its creep function.
//!
//! SC17 (Spinu & Cerlinca 2017) eq. (20) with the retardation time tau = eta_K / G_K of the Kelvin
//! element; the stress relaxation time of a Zener solid is the shorter eta_K / (G + G_K).

use crate::error::{Result, positive};
use crate::material::{Creep, CreepTerm, Relaxation};

/// The kind of deformation that a modulus or compliance belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Modulus {
    /// Uniaxial tension: Young's modulus E(t), creep compliance D(t).
    Young,
    /// Shear: modulus G(t), creep compliance J(t).
    Shear,
}

impl Modulus {
    /// "Young's modulus" or "shear modulus".
    pub fn name(self) -> &'static str {
        match self {
            Modulus::Young => "Young's modulus",
            Modulus::Shear => "shear modulus",
        }
    }
}

/// A linear viscoelastic material: its creep function D(t) or J(t), and which of them it is.
///
/// ```
/// use asperity::material::{Material, Modulus};
/// // Spring G in series with a Kelvin element G_K: relaxes from G to G G_K / (G + G_K),
/// // with the relaxation time tau G_K / (G + G_K).
/// let zener = Material::zener(Modulus::Shear, 6e6, 3e6, 9.0)?;
/// let relaxation = zener.relaxation()?;
/// assert!((relaxation.instantaneous() / 6e6 - 1.0).abs() < 1e-15);
/// assert!((relaxation.equilibrium / 2e6 - 1.0).abs() < 1e-15);
/// assert!((relaxation.terms[0].relaxation_time / 3.0 - 1.0).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    measure: Modulus,
    creep: Creep,
}

impl Material {
    /// A spring: `modulus` \[Pa\] at all times.
    ///
    /// ```
    /// use asperity::material::{Material, Modulus};
    /// let glass = Material::elastic(Modulus::Young, 70e9)?;
    /// assert_eq!(glass.creep().value(1e3) * 70e9, 1.0);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// `Invalid` if the modulus is not finite and positive.
    pub fn elastic(measure: Modulus, modulus: f64) -> Result<Self> {
        positive(measure.name(), modulus, "Pa")?;
        Self::generalised_kelvin(measure, Creep::elastic(1.0 / modulus))
    }

    /// Spring and dashpot in series: J = 1/G + t/(G `relaxation_time`).
    ///
    /// ```
    /// use asperity::material::{Material, Modulus};
    /// // G(t) = G exp(-t/tau): a share 1/e of the modulus is left after tau.
    /// let melt = Material::maxwell(Modulus::Shear, 1e5, 20.0)?;
    /// assert!((melt.relaxation()?.value(20.0) / 1e5 - (-1f64).exp()).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// `Invalid` if an argument is not finite and positive.
    pub fn maxwell(measure: Modulus, modulus: f64, relaxation_time: f64) -> Result<Self> {
        positive(measure.name(), modulus, "Pa")?;
        positive("relaxation time", relaxation_time, "s")?;
        let fluidity = 1.0 / modulus / relaxation_time;
        Self::generalised_kelvin(measure, Creep { fluidity, ..Creep::elastic(1.0 / modulus) })
    }

    /// Spring and dashpot in parallel: J = (1 - exp(-t/`retardation_time`))/G. Its compliance is zero at t = 0+, so a jump of the
    /// load has no solution.
    ///
    /// ```
    /// use asperity::material::{Material, Modulus};
    /// // E* = G + i omega eta, eta = G lambda.
    /// let gel = Material::kelvin_voigt(Modulus::Shear, 2e3, 0.5)?;
    /// let (storage, loss) = gel.relaxation()?.complex(3.0);
    /// assert!((storage / 2e3 - 1.0).abs() < 1e-14 && (loss / 3e3 - 1.0).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// `Invalid` if an argument is not finite and positive.
    pub fn kelvin_voigt(measure: Modulus, modulus: f64, retardation_time: f64) -> Result<Self> {
        positive(measure.name(), modulus, "Pa")?;
        let terms = vec![CreepTerm { compliance: 1.0 / modulus, retardation_time }];
        Self::generalised_kelvin(measure, Creep { terms, ..Creep::default() })
    }

    /// The standard linear solid: spring `modulus` in series with a Kelvin-Voigt element of
    /// `modulus_kelvin`: J = 1/G + (1 - exp(-t/`retardation_time`))/G_K.
    ///
    /// ```
    /// use asperity::material::{Material, Modulus};
    /// // The loss factor is largest, (G0 - Ginf) / (2 sqrt(G0 Ginf)), at omega = 1/sqrt(tau lambda).
    /// let zener = Material::zener(Modulus::Shear, 6e6, 3e6, 9.0)?; // Ginf = 2 MPa, tau = 3 s
    /// let (storage, loss) = zener.relaxation()?.complex(1.0 / 27f64.sqrt());
    /// assert!((loss / storage - 4.0 / (2.0 * 12f64.sqrt())).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// `Invalid` if an argument is not finite and positive.
    pub fn zener(measure: Modulus, modulus: f64, modulus_kelvin: f64, retardation_time: f64) -> Result<Self> {
        let spring = Self::elastic(measure, modulus)?;
        let kelvin = Self::kelvin_voigt(measure, modulus_kelvin, retardation_time)?;
        Self::generalised_kelvin(measure, spring.creep.sum(&kelvin.creep))
    }

    /// A Maxwell element (`modulus`, `relaxation_time`) in series with a Kelvin-Voigt element:
    /// J = 1/G + t/(G `relaxation_time`) + (1 - exp(-t/`retardation_time`))/G_K.
    ///
    /// ```
    /// use asperity::material::{Material, Modulus};
    /// // At long times it flows with the viscosity G tau of its dashpot.
    /// let asphalt = Material::burgers(Modulus::Shear, 1e9, 100.0, 2e8, 5.0)?;
    /// assert!((asphalt.creep().rate(1e3) * 1e11 - 1.0).abs() < 1e-12);
    /// assert!((asphalt.relaxation()?.instantaneous() / 1e9 - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// `Invalid` if an argument is not finite and positive.
    pub fn burgers(
        measure: Modulus,
        modulus: f64,
        relaxation_time: f64,
        modulus_kelvin: f64,
        retardation_time: f64,
    ) -> Result<Self> {
        let maxwell = Self::maxwell(measure, modulus, relaxation_time)?;
        let kelvin = Self::kelvin_voigt(measure, modulus_kelvin, retardation_time)?;
        Self::generalised_kelvin(measure, maxwell.creep.sum(&kelvin.creep))
    }

    /// Any relaxation function as a Prony series (generalised Maxwell, Wiechert).
    ///
    /// ```
    /// use asperity::material::{Material, Modulus, Relaxation};
    /// // PMMA (uniaxial): the compliance after 100 s.
    /// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
    /// let pmma = Material::prony(Modulus::Young, pmma)?;
    /// assert!((pmma.creep().value(100.0) / 4.780684900e-10 - 1.0).abs() < 1e-9);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Relaxation::validate`].
    pub fn prony(measure: Modulus, relaxation: Relaxation) -> Result<Self> {
        Self::generalised_kelvin(measure, relaxation.to_creep()?)
    }

    /// Any creep function as a Prony series (generalised Kelvin).
    ///
    /// ```
    /// use asperity::material::{Creep, CreepTerm, Material, Modulus};
    /// let terms = vec![CreepTerm { compliance: 3e-9, retardation_time: 10.0 }];
    /// let creep = Creep { instantaneous: 1e-9, terms, fluidity: 0.0 };
    /// let material = Material::generalised_kelvin(Modulus::Shear, creep)?;
    /// assert!((material.relaxation()?.equilibrium * 4e-9 - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Creep::validate`], or if the creep function is 0 at all times.
    pub fn generalised_kelvin(measure: Modulus, creep: Creep) -> Result<Self> {
        creep.validate()?;
        let creep = creep.tidy();
        positive("largest creep compliance", creep.long_time().min(f64::MAX), "1/Pa")?;
        Ok(Material { measure, creep })
    }

    /// The material at a temperature whose shift factor a_T is `factor`: all its times are multiplied by this factor.
    ///
    /// # Errors
    /// `Invalid` if a time leaves the range of floating-point numbers.
    pub fn stretched(&self, factor: f64) -> Result<Self> {
        positive("shift factor", factor, "")?;
        Self::generalised_kelvin(self.measure, self.creep.stretched(factor))
    }

    /// The material with all moduli multiplied by `factor`: 1/b_T at a temperature with a
    /// [`VerticalShift`](super::VerticalShift).
    ///
    /// ```
    /// use asperity::material::{Material, Modulus};
    /// let stiffer = Material::zener(Modulus::Shear, 6e6, 3e6, 9.0)?.scaled(1.2)?;
    /// assert!((stiffer.relaxation()?.equilibrium / 2.4e6 - 1.0).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// `Invalid` if the factor is not finite and positive, or a compliance leaves the range of floating-point numbers.
    pub fn scaled(&self, factor: f64) -> Result<Self> {
        positive("factor of the moduli", factor, "")?;
        Self::generalised_kelvin(self.measure, self.creep.scaled(1.0 / factor))
    }

    /// Whether the moduli are Young's or shear moduli.
    pub fn measure(&self) -> Modulus {
        self.measure
    }

    /// D(t) or J(t).
    pub fn creep(&self) -> &Creep {
        &self.creep
    }

    /// E(t) or G(t), converted exactly.
    ///
    /// # Errors
    /// As [`Creep::to_relaxation`].
    pub fn relaxation(&self) -> Result<Relaxation> {
        self.creep.to_relaxation()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_models_have_their_closed_forms() {
        let (g, gk, tau, t) = (6.0, 3.0, 2.0, 1.3_f64);
        let kelvin = 1.0 - (-t / tau).exp();
        let m = Modulus::Shear;
        let cases = [
            (Material::elastic(m, g), 1.0 / g),
            (Material::maxwell(m, g, 7.0), 1.0 / g + t / (7.0 * g)),
            (Material::kelvin_voigt(m, gk, tau), kelvin / gk),
            (Material::zener(m, g, gk, tau), 1.0 / g + kelvin / gk),
            (Material::burgers(m, g, 7.0, gk, tau), 1.0 / g + t / (7.0 * g) + kelvin / gk),
        ];
        for (material, compliance) in cases {
            let material = material.unwrap();
            // A few roundings.
            assert!((material.creep().value(t) / compliance - 1.0).abs() < 1e-15, "{material:?}");
        }
    }

    #[test]
    fn burgers_relaxes_as_its_closed_form() {
        // G(t) = [(q1 - q2 r1) e^(-r1 t) - (q1 - q2 r2) e^(-r2 t)] / A of the Burgers model
        // (Findley, Lai & Onaran 1976, table 5.1), here with R1, R2 springs and e1, e2 dashpots.
        let (r1, e1, r2, e2) = (6.0, 42.0, 3.0, 6.0_f64);
        let burgers = Material::burgers(Modulus::Shear, r1, e1 / r1, r2, e2 / r2).unwrap();
        let (p1, p2) = (e1 / r1 + e1 / r2 + e2 / r2, e1 * e2 / (r1 * r2));
        let (q1, q2) = (e1, e1 * e2 / r2);
        let a = (p1 * p1 - 4.0 * p2).sqrt();
        let (s1, s2) = ((p1 - a) / (2.0 * p2), (p1 + a) / (2.0 * p2));
        let relaxation = burgers.relaxation().unwrap();
        for t in [0.0, 0.5, 3.0, 20.0] {
            let exact = ((q1 - q2 * s1) * (-s1 * t).exp() - (q1 - q2 * s2) * (-s2 * t).exp()) / a;
            // The closed form itself cancels a digit.
            assert!((relaxation.value(t) - exact).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn bad_arguments_are_named() {
        let says = |result: Result<Material>, words: &str| {
            let error = result.unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        says(Material::elastic(Modulus::Young, 0.0), "Young's modulus is 0");
        says(Material::maxwell(Modulus::Shear, -1.0, 1.0), "shear modulus is -1");
        says(Material::maxwell(Modulus::Shear, 1.0, f64::NAN), "relaxation time is NaN");
        says(Material::zener(Modulus::Shear, 1.0, 1.0, 0.0), "retardation time of term 1 is 0");
        says(Material::generalised_kelvin(Modulus::Shear, Creep::default()), "compliance is 0");
    }
}
