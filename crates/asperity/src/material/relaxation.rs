//! Relaxation functions as a Prony series.
//!
//! E(t) = E_inf + sum_i E_i exp(-t/tau_i): a spring and Maxwell elements in parallel (the generalised Maxwell or Wiechert model).
//! See J. D. Ferry, Viscoelastic Properties of Polymers (3rd ed., 1980), chapter 3. "E" is either modulus, Young's or shear.
//!
//! Prony tables have three forms. Each has its own constructor, so that they are not confused: moduli ([`Relaxation::absolute`]),
//! fractions of the instantaneous modulus ([`Relaxation::from_instantaneous`]; g_i of Abaqus, alpha_i of Ansys) and ratios to the
//! relaxed modulus ([`Relaxation::from_equilibrium`]).

use crate::error::{Result, non_negative, positive, require};
use crate::material::series;

/// E(t) = E_inf + sum_i E_i exp(-t/tau_i) + viscosity delta(t), in pascal; 0 for t < 0.
///
/// ```
/// use asperity::material::Relaxation;
/// // PMMA, uniaxial: E(0) = 2491.44 MPa.
/// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
/// assert!((pmma.instantaneous() - 2491.4388e6).abs() < 1.0);
/// assert!((pmma.to_creep()?.instantaneous * 1e6 - 4.013744989e-4).abs() < 1e-13);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Relaxation {
    /// E_inf \[Pa\].
    pub equilibrium: f64,
    /// The relaxing terms, in order of relaxation time.
    pub terms: Vec<RelaxationTerm>,
    /// Newtonian dashpot in parallel \[Pa s\] (Kelvin-Voigt); 0 if the modulus at t = 0 is finite.
    pub viscosity: f64,
}

/// One relaxing term E_i exp(-t/tau_i).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxationTerm {
    /// E_i \[Pa\].
    pub modulus: f64,
    /// tau_i \[s\].
    pub relaxation_time: f64,
}

impl Relaxation {
    /// From the equilibrium modulus \[Pa\] and (modulus \[Pa\], relaxation time \[s\]) terms.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a modulus is negative, a time not positive, or all moduli are zero.
    pub fn absolute(equilibrium: f64, terms: &[(f64, f64)]) -> Result<Self> {
        let terms =
            terms.iter().map(|&(modulus, relaxation_time)| RelaxationTerm { modulus, relaxation_time });
        let relaxation = Relaxation { equilibrium, terms: terms.collect(), viscosity: 0.0 };
        relaxation.validate()?;
        Ok(relaxation.tidy())
    }

    /// From the instantaneous modulus E(0) \[Pa\] and (fraction g_i, relaxation time \[s\]) terms:
    /// E_i = g_i E(0), E_inf = (1 - sum g_i) E(0). This is the form of Abaqus and Ansys.
    ///
    /// ```
    /// use asperity::material::Relaxation;
    /// let r = Relaxation::from_instantaneous(10e6, &[(0.5, 1.0), (0.3, 10.0)])?;
    /// assert!((r.equilibrium / 2e6 - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a fraction is negative, their sum exceeds 1 (by more than 1e-12, which
    /// is rounding and taken as 1), a time is not positive, or the modulus is not positive.
    pub fn from_instantaneous(instantaneous: f64, fractions: &[(f64, f64)]) -> Result<Self> {
        positive("instantaneous modulus", instantaneous, "Pa")?;
        for (n, (fraction, _)) in fractions.iter().enumerate() {
            non_negative(
                &format!("fraction of term {}", n + 1),
                *fraction,
                "(of the instantaneous modulus)",
            )?;
        }
        let sum: f64 = fractions.iter().map(|f| f.0).sum();
        require(
            sum <= 1.0 + 1e-12,
            "sum of the fractions of the instantaneous modulus",
            sum,
            "at most 1, what remains is the equilibrium modulus (if the terms are relative to the \
                 relaxed modulus or are moduli, say so)",
        )?;
        // A remainder of rounding size means a fluid whose decimal fractions add up to 1.
        let remainder = if 1.0 - sum > 1e-12 { 1.0 - sum } else { 0.0 };
        let terms: Vec<_> = fractions.iter().map(|f| (f.0 * instantaneous, f.1)).collect();
        Relaxation::absolute(remainder * instantaneous, &terms)
    }

    /// From the relaxed (equilibrium) modulus E_inf \[Pa\] and (ratio E_i / E_inf, relaxation time \[s\])
    /// terms; the ratios may add up to any value.
    ///
    /// ```
    /// use asperity::material::Relaxation;
    /// let r = Relaxation::from_equilibrium(2e6, &[(2.5, 1.0), (1.5, 10.0)])?;
    /// assert!((r.instantaneous() / 10e6 - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a ratio is negative, a time not positive, or the modulus not positive.
    pub fn from_equilibrium(equilibrium: f64, ratios: &[(f64, f64)]) -> Result<Self> {
        positive("equilibrium modulus", equilibrium, "Pa")?;
        for (n, (ratio, _)) in ratios.iter().enumerate() {
            non_negative(&format!("ratio of term {}", n + 1), *ratio, "(to the equilibrium modulus)")?;
        }
        let terms: Vec<_> = ratios.iter().map(|r| (r.0 * equilibrium, r.1)).collect();
        Relaxation::absolute(equilibrium, &terms)
    }

    /// E(t) \[Pa\]; 0 for t < 0. The impulse of a viscosity at t = 0 is left out.
    pub fn value(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        self.equilibrium
            + self.terms.iter().map(|e| e.modulus * libm::exp(-t / e.relaxation_time)).sum::<f64>()
    }

    /// E(0) = E_inf + sum E_i \[Pa\]; `f64::INFINITY` with a viscosity.
    pub fn instantaneous(&self) -> f64 {
        if self.viscosity > 0.0 {
            return f64::INFINITY;
        }
        self.equilibrium + self.terms.iter().map(|e| e.modulus).sum::<f64>()
    }

    /// Storage and loss modulus (E', E'') \[Pa\] at the angular frequency `omega` \[rad/s\]: the complex
    /// modulus is E' + i E'' = E_inf + sum_i E_i i omega tau_i / (1 + i omega tau_i) + i omega viscosity.
    ///
    /// ```
    /// use asperity::material::Relaxation;
    /// // A Maxwell element loses most at omega = 1/tau, where E' = E'' = E/2.
    /// let maxwell = Relaxation::absolute(0.0, &[(1e6, 4.0)])?;
    /// assert_eq!(maxwell.complex(0.25), (0.5e6, 0.5e6));
    /// // Kramers and Kronig: E'(infinity) - E'(0) = (2/pi) int E''(omega) d ln omega.
    /// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
    /// let loss: f64 = (0..800).map(|k| pmma.complex((-20.0 + 0.05 * k as f64).exp()).1 * 0.05).sum();
    /// let relaxing = pmma.instantaneous() - pmma.equilibrium;
    /// assert!((2.0 / std::f64::consts::PI * loss / relaxing - 1.0).abs() < 1e-6);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn complex(&self, omega: f64) -> (f64, f64) {
        let viscous = if self.viscosity > 0.0 { self.viscosity * omega } else { 0.0 };
        self.terms.iter().fold((self.equilibrium, viscous), |(storage, loss), e| {
            // i x / (1 + i x) with x = omega tau is 1/(1 - i y) with y = 1/x.
            let (real, imaginary) = series::debye(1.0 / (omega * e.relaxation_time));
            (storage + e.modulus * real, loss + e.modulus * imaginary)
        })
    }

    /// The same function with its terms in order, without zero terms, and with equal times merged (times that differ by less than
    /// a relative 1e-9 are equal: the change is below rounding).
    #[must_use]
    pub fn tidy(&self) -> Relaxation {
        let pairs = self.terms.iter().map(|e| (e.relaxation_time, e.modulus));
        Relaxation {
            terms: series::tidy(pairs)
                .into_iter()
                .map(|(relaxation_time, modulus)| RelaxationTerm { modulus, relaxation_time })
                .collect(),
            ..*self
        }
    }

    /// `factor` E(t).
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Relaxation {
        Relaxation {
            equilibrium: factor * self.equilibrium,
            terms: self.terms.iter().map(|e| RelaxationTerm { modulus: factor * e.modulus, ..*e }).collect(),
            viscosity: factor * self.viscosity,
        }
    }

    /// Checks that every modulus is finite and not negative, that every time is finite and positive, and that not all moduli are
    /// zero.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) naming the term (counted from 1) and its value.
    pub fn validate(&self) -> Result<()> {
        non_negative("equilibrium modulus", self.equilibrium, "Pa")?;
        non_negative("viscosity", self.viscosity, "Pa s")?;
        for (n, e) in self.terms.iter().enumerate() {
            series::validate_term(
                n + 1,
                ("modulus", e.modulus, "Pa"),
                ("relaxation time", e.relaxation_time),
            )?;
        }
        let all = self.equilibrium + self.terms.iter().map(|e| e.modulus).sum::<f64>() + self.viscosity;
        require(all > 0.0 && all.is_finite(), "sum of the moduli", all, "finite and greater than 0 Pa")?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_forms_of_a_prony_table_are_one_material() {
        let absolute = Relaxation::absolute(2e6, &[(5e6, 1.0), (3e6, 10.0)]).unwrap();
        let instantaneous = Relaxation::from_instantaneous(10e6, &[(0.5, 1.0), (0.3, 10.0)]).unwrap();
        let equilibrium = Relaxation::from_equilibrium(2e6, &[(2.5, 1.0), (1.5, 10.0)]).unwrap();
        for t in [0.0, 0.3, 4.0, 1e3] {
            for other in [&instantaneous, &equilibrium] {
                // The fractions 0.3 and 1 - 0.8 are rounded: two units in the last place of E(0).
                assert!((other.value(t) - absolute.value(t)).abs() < 5e-9, "{t}");
            }
        }
    }

    #[test]
    fn fractions_that_add_up_to_one_are_a_fluid() {
        let tenth = [(0.1, 1.0); 10].map(|(g, t)| (g, t)).to_vec();
        let times: Vec<_> = tenth.iter().enumerate().map(|(k, (g, _))| (*g, 10f64.powi(k as i32))).collect();
        assert_eq!(Relaxation::from_instantaneous(1e6, &times).unwrap().equilibrium, 0.0);
        let error = Relaxation::from_instantaneous(1e6, &[(0.6, 1.0), (0.5, 2.0)]).unwrap_err();
        assert!(error.to_string().contains("at most 1"), "{error}");
    }

    #[test]
    fn storage_and_loss_have_their_limits() {
        let r = Relaxation::absolute(1.0, &[(2.0, 1e-3), (4.0, 1e3)]).unwrap();
        assert_eq!(r.complex(0.0), (1.0, 0.0));
        assert_eq!(r.complex(1e200), (7.0, 1e-200 * (2.0 / 1e-3 + 4.0 / 1e3)));
    }

    #[test]
    fn bad_tables_are_named() {
        for (equilibrium, term, says) in [
            (-1.0, (1.0, 1.0), "equilibrium modulus is -1"),
            (1.0, (-2.0, 1.0), "modulus of term 1 is -2"),
            (1.0, (2.0, 0.0), "relaxation time of term 1 is 0"),
            (1.0, (2.0, f64::NAN), "relaxation time of term 1 is NaN"),
            (0.0, (0.0, 1.0), "sum of the moduli is 0"),
        ] {
            let error = Relaxation::absolute(equilibrium, &[term]).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
