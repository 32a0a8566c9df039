//! Creep functions as a Prony (Dirichlet) series.
//!
//! C(t) = C0 + sum_j C_j (1 - exp(-t/lambda_j)) + t/eta: a spring, Kelvin-Voigt elements and a
//! dashpot in series (the generalised Kelvin model). See J. D. Ferry, Viscoelastic Properties of
//! Polymers (3rd ed., 1980), chapter 3.

use crate::error::{Error, Result, non_negative, positive, require};
use crate::material::series;

/// C(t) = C0 + sum_j C_j (1 - exp(-t/lambda_j)) + t/eta, per pascal; 0 for t < 0.
///
/// ```
/// use asperity::material::{Creep, CreepTerm};
/// // PMMA, uniaxial.
/// let creep = Creep {
///     instantaneous: 4.013744989e-10,
///     terms: vec![
///         CreepTerm { compliance: 4.474062327e-11, retardation_time: 9.936295903 },
///         CreepTerm { compliance: 6.072724980e-11, retardation_time: 133.8704875 },
///     ],
///     fluidity: 0.0,
/// };
/// assert!((creep.value(100.0) / 4.780684900e-10 - 1.0).abs() < 1e-9);
/// // At long times the compliance is one over the equilibrium modulus, 1973 MPa.
/// assert!((creep.long_time() * 1973e6 - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Creep {
    /// C0 \[1/Pa\].
    pub instantaneous: f64,
    /// The retarded terms, in order of retardation time.
    pub terms: Vec<CreepTerm>,
    /// 1/eta \[1/(Pa s)\]; 0 for a solid.
    pub fluidity: f64,
}

/// One retarded term C_j (1 - exp(-t/lambda_j)).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CreepTerm {
    /// C_j \[1/Pa\].
    pub compliance: f64,
    /// lambda_j \[s\].
    pub retardation_time: f64,
}

impl Creep {
    /// A constant compliance \[1/Pa\]: an elastic body, or a rigid one if it is 0.
    pub fn elastic(compliance: f64) -> Self {
        Creep { instantaneous: compliance, ..Creep::default() }
    }

    /// C(t) \[1/Pa\]; 0 for t < 0.
    pub fn value(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        let retarded: f64 =
            self.terms.iter().map(|c| -c.compliance * libm::expm1(-t / c.retardation_time)).sum();
        self.instantaneous + retarded + self.fluidity * t
    }

    /// dC/dt \[1/(Pa s)\] for t > 0, its limit at t = 0, and 0 before.
    pub fn rate(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        let retarded: f64 = self
            .terms
            .iter()
            .map(|c| c.compliance / c.retardation_time * libm::exp(-t / c.retardation_time))
            .sum();
        retarded + self.fluidity
    }

    /// Integral of C from 0 to t \[s/Pa\]; 0 for t < 0.
    pub fn integral(&self, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let retarded: f64 = self
            .terms
            .iter()
            .map(|c| {
                c.compliance * c.retardation_time * series::exponential_remainder(t / c.retardation_time)
            })
            .sum();
        self.instantaneous * t + retarded + self.fluidity * t * (0.5 * t)
    }

    /// C at infinite time \[1/Pa\]; `f64::INFINITY` for a fluid.
    pub fn long_time(&self) -> f64 {
        if self.fluidity > 0.0 {
            return f64::INFINITY;
        }
        self.instantaneous + self.terms.iter().map(|c| c.compliance).sum::<f64>()
    }

    /// Whether it changes in time.
    pub fn remembers(&self) -> bool {
        !self.terms.is_empty() || self.fluidity > 0.0
    }

    /// Storage and loss compliance (J', J'') \[1/Pa\] at the angular frequency `omega` > 0 \[rad/s\]:
    /// the complex compliance is J' - i J'' = C0 + sum_j C_j / (1 + i omega lambda_j) + 1/(i omega eta).
    pub fn complex(&self, omega: f64) -> (f64, f64) {
        let flow = if self.fluidity > 0.0 { self.fluidity / omega } else { 0.0 };
        self.terms.iter().fold((self.instantaneous, flow), |(storage, loss), c| {
            let (real, imaginary) = series::debye(omega * c.retardation_time);
            (storage + c.compliance * real, loss + c.compliance * imaginary)
        })
    }

    /// Storage and loss modulus (E', E'') \[Pa\] at the angular frequency `omega` > 0 \[rad/s\]:
    /// E' + i E'' = 1 / (J' - i J'') of [`complex`](Self::complex); tan delta = E''/E' = J''/J'.
    ///
    /// ```
    /// use asperity::material::{Creep, CreepTerm};
    /// // Maxwell's element J = 1/G + t/(G tau): E'' = E' = G/2 where omega tau = 1.
    /// let maxwell = Creep { instantaneous: 1e-6, terms: vec![], fluidity: 0.5e-6 };
    /// let (storage, loss) = maxwell.modulus(0.5);
    /// assert!((storage / 0.5e6 - 1.0).abs() < 1e-15 && (loss / storage - 1.0).abs() < 1e-15);
    /// ```
    pub fn modulus(&self, omega: f64) -> (f64, f64) {
        let (storage, loss) = self.complex(omega);
        let square = storage * storage + loss * loss;
        (storage / square, loss / square)
    }

    /// C(t) + other(t): two bodies in contact, or elements in series. Equal times become one term.
    #[must_use]
    pub fn sum(&self, other: &Creep) -> Creep {
        Creep {
            instantaneous: self.instantaneous + other.instantaneous,
            terms: self.terms.iter().chain(&other.terms).copied().collect(),
            fluidity: self.fluidity + other.fluidity,
        }
        .tidy()
    }

    /// `factor` C(t).
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Creep {
        Creep {
            instantaneous: factor * self.instantaneous,
            terms: self.terms.iter().map(|c| CreepTerm { compliance: factor * c.compliance, ..*c }).collect(),
            fluidity: factor * self.fluidity,
        }
    }

    /// C(t/`factor`): the function at a temperature whose shift factor a_T is `factor`.
    ///
    /// ```
    /// use asperity::material::{Creep, CreepTerm};
    /// let terms = vec![CreepTerm { compliance: 1e-9, retardation_time: 2.0 }];
    /// let creep = Creep { instantaneous: 1e-9, terms, fluidity: 1e-11 };
    /// // Ten times slower.
    /// assert!((creep.stretched(10.0).value(30.0) / creep.value(3.0) - 1.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn stretched(&self, factor: f64) -> Creep {
        Creep {
            instantaneous: self.instantaneous,
            terms: self
                .terms
                .iter()
                .map(|c| CreepTerm { retardation_time: factor * c.retardation_time, ..*c })
                .collect(),
            fluidity: self.fluidity / factor,
        }
    }

    /// The same function with its terms in order, without zero terms, and with equal times merged (times that differ by less than
    /// a relative 1e-9 are equal: the change is below rounding).
    #[must_use]
    pub fn tidy(&self) -> Creep {
        let pairs = self.terms.iter().map(|c| (c.retardation_time, c.compliance));
        Creep {
            terms: series::tidy(pairs)
                .into_iter()
                .map(|(retardation_time, compliance)| CreepTerm { compliance, retardation_time })
                .collect(),
            ..*self
        }
    }

    /// Checks that every compliance is finite and not negative and every time is finite and positive, as for every passive
    /// material. All zero is allowed and means a rigid body.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the term (counted from 1) and its value.
    pub fn validate(&self) -> Result<()> {
        non_negative("instantaneous compliance", self.instantaneous, "1/Pa")?;
        non_negative("fluidity", self.fluidity, "1/(Pa s)")?;
        for (n, c) in self.terms.iter().enumerate() {
            series::validate_term(
                n + 1,
                ("compliance", c.compliance, "1/Pa"),
                ("retardation time", c.retardation_time),
            )?;
        }
        let all = self.terms.iter().map(|c| c.compliance).sum::<f64>() + self.instantaneous;
        require(all.is_finite(), "sum of the compliances", all, "finite")?;
        Ok(())
    }

    /// Also refuses a fluid, whose indentation grows without limit, and a rigid body.
    pub(crate) fn validate_solid(&self) -> Result<()> {
        self.validate()?;
        if self.fluidity > 0.0 {
            let expected =
                "0 1/(Pa s): a fluid has no steady state of motion; give the material an equilibrium modulus";
            return Err(Error::invalid("fluidity", self.fluidity, expected));
        }
        positive("compliance at long times", self.long_time(), "1/Pa").map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn burgers() -> Creep {
        Creep {
            instantaneous: 2.0,
            terms: vec![CreepTerm { compliance: 3.0, retardation_time: 0.5 }],
            fluidity: 0.25,
        }
    }

    #[test]
    fn burgers_creeps_as_its_closed_form() {
        let t = 0.7_f64;
        let decay = (-t / 0.5).exp();
        // Closed forms, with a few roundings each.
        assert!((burgers().value(t) - (2.0 + 3.0 * (1.0 - decay) + 0.25 * t)).abs() < 4e-15);
        assert!((burgers().rate(t) - (6.0 * decay + 0.25)).abs() < 4e-15);
        let integral = 2.0 * t + 3.0 * (t - 0.5 * (1.0 - decay)) + 0.125 * t * t;
        assert!((burgers().integral(t) - integral).abs() < 4e-15);
        assert_eq!(burgers().long_time(), f64::INFINITY);
        assert_eq!(burgers().value(-1.0), 0.0);
    }

    #[test]
    fn a_sum_of_equal_spectra_is_twice_the_spectrum() {
        assert_eq!(burgers().sum(&burgers()), burgers().scaled(2.0));
    }

    #[test]
    fn a_split_term_and_a_zero_term_change_nothing() {
        let mut split = burgers();
        split.terms = [1.0, 2.0, 0.0]
            .iter()
            .map(|c| CreepTerm { compliance: *c, retardation_time: if *c > 0.0 { 0.5 } else { 7.0 } })
            .collect();
        assert_eq!(split.tidy(), burgers());
    }

    #[test]
    fn bad_terms_are_named() {
        let with = |compliance, retardation_time| {
            let mut creep = burgers();
            creep.terms.push(CreepTerm { compliance, retardation_time });
            creep.validate().map_err(|e| e.to_string())
        };
        assert!(with(1.0, 1.0).is_ok());
        for (compliance, time, says) in [
            (-1.0, 1.0, "compliance of term 2 is -1"),
            (f64::NAN, 1.0, "compliance of term 2 is NaN"),
            (1.0, 0.0, "retardation time of term 2 is 0"),
            (1.0, f64::INFINITY, "retardation time of term 2 is inf"),
            (1.0, -3.0, "retardation time of term 2 is -3"),
        ] {
            let error = with(compliance, time).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }
}
