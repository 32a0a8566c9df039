//! Fractional models: power laws and their transitions, and the Prony sums that approximate them.
//!
//! A springpot (G. W. Scott Blair 1947; R. C. Koeller, J. Appl. Mech. 51 (1984) 299) is intermediate between spring and dashpot:
//! its complex modulus is G (i omega tau)^alpha, its creep function J(t) = (t/tau)^alpha / (G Gamma(1 + alpha)). In series or
//! parallel with springs it gives, with the Mittag-Leffler function M(x) = E_alpha(-x^alpha),
//!
//! | model | complex modulus, z = (i omega tau)^alpha | creep J(t) | relaxation G(t) |
//! |---|---|---|---|
//! | springpot | G z | x^alpha / (G Gamma(1 + alpha)) | G x^-alpha / Gamma(1 - alpha) |
//! | Maxwell | G z/(1 + z) | (1 + x^alpha / Gamma(1 + alpha)) / G | G M(x) |
//! | Zener | G_inf + (G_0 - G_inf) z/(1 + z) | 1/G_0 + (1/G_inf - 1/G_0) (1 - M(x_c)) | G_inf + (G_0 - G_inf) M(x) |
//!
//! where x = t/tau and x_c = x (G_inf/G_0)^(1/alpha): a fractional Zener solid retards as it relaxes. All are completely
//! monotone, so Prony series with positive weights approximate them to any accuracy.

use crate::error::{Result, positive, require};
use crate::material::mittag_leffler::{LEAST_ORDER, mittag_leffler};
use crate::material::prony_sum::{self, ColeCole, Exact, PowerLaw};
use crate::material::{Creep, CreepTerm};

/// A fractional model; its moduli are of the kind (Young's or shear) of the material for which it is used.
///
/// ```
/// use asperity::material::Fractional;
/// let springpot = Fractional::Springpot { modulus: 2e6, time: 3.0, order: 0.4 };
/// // A power law: a decade in time is a factor 10^0.4 in creep ...
/// let prony = springpot.to_prony([1e-2, 1e2], 1e-3)?;
/// let growth = prony.creep.value(10.0) / prony.creep.value(1.0);
/// assert!((growth / 10f64.powf(0.4) - 1.0).abs() < 2e-3);
/// // ... and the phase angle is 0.4 times 90 degrees at any frequency.
/// let (storage, loss) = springpot.complex(7.0);
/// assert!((loss.atan2(storage).to_degrees() - 36.0).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fractional {
    /// Between spring and dashpot: J = (t/`time`)^`order` / (`modulus` Gamma(1 + `order`)).
    Springpot {
        /// G \[Pa\].
        modulus: f64,
        /// tau \[s\], the time at which J = 1/(G Gamma(1 + order)).
        time: f64,
        /// alpha, 0 < alpha <= 1.
        order: f64,
    },
    /// Spring and springpot in series.
    Maxwell {
        /// G of the spring \[Pa\].
        modulus: f64,
        /// tau \[s\].
        time: f64,
        /// alpha, 0 < alpha <= 1.
        order: f64,
    },
    /// A spring in parallel with a fractional Maxwell element (Cole-Cole relaxation).
    Zener {
        /// G_inf \[Pa\].
        equilibrium: f64,
        /// G_0 > G_inf \[Pa\].
        instantaneous: f64,
        /// tau \[s\].
        time: f64,
        /// alpha, 0 < alpha <= 1.
        order: f64,
    },
}

/// A Prony sum in place of an exact creep function.
#[derive(Clone, Debug, PartialEq)]
pub struct Approximation {
    /// The sum.
    pub creep: Creep,
    /// Largest relative error of creep AND relaxation over the window.
    pub error: f64,
    /// First and last time for which the error holds \[s\].
    pub window: [f64; 2],
}

/// The spring G_inf (0 without one) and the modulus of the springpot, which is also that of the spring in series.
struct Elements {
    equilibrium: f64,
    relaxing: f64,
    time: f64,
    order: f64,
}

impl Fractional {
    /// J(t) \[1/Pa\], exactly; 0 for t < 0.
    ///
    /// ```
    /// use asperity::material::Fractional;
    /// // A fractional Maxwell element of order 1/2 at t = tau: (1 + 1/Gamma(3/2))/G, Gamma(3/2) = sqrt(pi)/2.
    /// let element = Fractional::Maxwell { modulus: 2e6, time: 3.0, order: 0.5 };
    /// let exact = (1.0 + 2.0 / std::f64::consts::PI.sqrt()) / 2e6;
    /// assert!((element.creep(3.0) / exact - 1.0).abs() < 1e-13);
    /// ```
    pub fn creep(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        match *self {
            Fractional::Springpot { modulus, time, order } => power(t / time, order) / modulus,
            Fractional::Maxwell { modulus, time, order } => (1.0 + power(t / time, order)) / modulus,
            Fractional::Zener { equilibrium, instantaneous, time, order } => {
                let ln_power = order * (t / time).ln() + (equilibrium / instantaneous).ln();
                let retarded = 1.0 / equilibrium - 1.0 / instantaneous;
                1.0 / instantaneous + retarded * mittag_leffler(order, ln_power).1
            }
        }
    }

    /// G(t) \[Pa\] for t > 0, exactly (without the impulse at t = 0 of a springpot of order 1).
    ///
    /// ```
    /// use asperity::material::Fractional;
    /// // A fractional Zener solid of order 1/2 at t = tau: Ginf + (G0 - Ginf) e erfc(1).
    /// let rubber = Fractional::Zener { equilibrium: 1e6, instantaneous: 1e9, time: 1e-3, order: 0.5 };
    /// let exact = 1e6 + 999e6 * 0.427_583_576_155_807;
    /// assert!((rubber.relaxation(1e-3) / exact - 1.0).abs() < 1e-12);
    /// ```
    pub fn relaxation(&self, t: f64) -> f64 {
        match *self {
            Fractional::Springpot { order, .. } if order >= 1.0 => 0.0,
            Fractional::Springpot { modulus, time, order } => {
                modulus * (t / time).powf(-order) / libm::tgamma(1.0 - order)
            }
            _ => {
                let Elements { equilibrium, relaxing, time, order } = self.elements();
                equilibrium + relaxing * mittag_leffler(order, order * (t / time).ln()).0
            }
        }
    }

    /// Storage and loss modulus \[Pa\] at the angular frequency `omega` \[rad/s\], exactly.
    pub fn complex(&self, omega: f64) -> (f64, f64) {
        // i^alpha = exp(i pi alpha / 2); z/(1 + z) = (z + |z|^2) / |1 + z|^2.
        let Elements { equilibrium, relaxing, time, order } = self.elements();
        let (sine, cosine) = (std::f64::consts::FRAC_PI_2 * order).sin_cos();
        let size = (omega * time).powf(order);
        let (re, im) = (size * cosine, size * sine);
        if matches!(self, Fractional::Springpot { .. }) {
            return (relaxing * re, relaxing * im);
        }
        let square = 1.0 + 2.0 * re + re * re + im * im;
        (equilibrium + relaxing * ((re + re * re + im * im) / square), relaxing * (im / square))
    }

    /// A Prony sum with a relative error below `tolerance` (1e-3 is a good value) in creep and in
    /// relaxation at all times of `window` = \[first, last\] in seconds, with few terms.
    ///
    /// Outside the window it becomes a spring at short times and, for springpot and Maxwell, a dashpot at long times: J(0) > 0,
    /// so a jump of the load has a solution.
    ///
    /// ```
    /// use asperity::material::Fractional;
    /// let model = Fractional::Maxwell { modulus: 1e9, time: 1.0, order: 0.3 };
    /// let sum = model.to_prony([1e-3, 1e3], 1e-3)?;
    /// assert!(sum.error <= 1e-3 && sum.creep.terms.len() < 26);
    /// // Storage and loss agree too, although only times were looked at.
    /// let (storage, loss) = sum.creep.to_relaxation()?.complex(1.0);
    /// let (exact_storage, exact_loss) = model.complex(1.0);
    /// assert!((storage / exact_storage - 1.0).abs() < 3e-3 && (loss / exact_loss - 1.0).abs() < 3e-3);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if an argument is out of its range, or if the tolerance is too small.
    pub fn to_prony(&self, window: [f64; 2], tolerance: f64) -> Result<Approximation> {
        self.validate()?;
        let Elements { equilibrium, relaxing, time, order } = self.elements();
        if order == 1.0 {
            return Ok(Approximation { creep: self.classical(), error: 0.0, window });
        }
        let order = order.max(LEAST_ORDER);
        let relaxation = |t| self.relaxation(t);
        let exact = Exact::new(&|t| self.creep(t), &relaxation, window, tolerance)?;
        match *self {
            Fractional::Springpot { modulus, .. } | Fractional::Maxwell { modulus, .. } => {
                let constant = if matches!(self, Fractional::Maxwell { .. }) { 1.0 / modulus } else { 0.0 };
                prony_sum::by_quadrature(&exact, &PowerLaw { order, time, constant, factor: 1.0 / modulus })
            }
            Fractional::Zener { .. } => {
                let law = ColeCole { order, time, equilibrium, relaxing };
                prony_sum::by_fit(&exact, true).or_else(|_| prony_sum::by_quadrature(&exact, &law))
            }
        }
    }

    fn elements(&self) -> Elements {
        match *self {
            Fractional::Springpot { modulus, time, order } | Fractional::Maxwell { modulus, time, order } => {
                Elements { equilibrium: 0.0, relaxing: modulus, time, order }
            }
            Fractional::Zener { equilibrium, instantaneous, time, order } => {
                Elements { equilibrium, relaxing: instantaneous - equilibrium, time, order }
            }
        }
    }

    fn validate(&self) -> Result<()> {
        let Elements { time, order, .. } = self.elements();
        positive("time of the fractional model", time, "s")?;
        require(
            order > 0.0 && order <= 1.0,
            "order of the fractional model",
            order,
            "greater than 0 (a spring) and not greater than 1 (a dashpot)",
        )?;
        match *self {
            Fractional::Springpot { modulus, .. } | Fractional::Maxwell { modulus, .. } => {
                positive("modulus of the fractional model", modulus, "Pa").map(|_| ())
            }
            Fractional::Zener { equilibrium, instantaneous, .. } => {
                positive("equilibrium modulus of the fractional model", equilibrium, "Pa")?;
                positive("instantaneous modulus of the fractional model", instantaneous, "Pa")?;
                require(
                    instantaneous > equilibrium,
                    "instantaneous modulus of the fractional model",
                    format!("{instantaneous:e} Pa"),
                    format!("greater than the equilibrium modulus, {equilibrium:e} Pa"),
                )?;
                Ok(())
            }
        }
    }

    /// Order 1: dashpot, Maxwell element, Zener solid.
    fn classical(&self) -> Creep {
        match *self {
            Fractional::Springpot { modulus, time, .. } => {
                Creep { fluidity: 1.0 / modulus / time, ..Creep::default() }
            }
            Fractional::Maxwell { modulus, time, .. } => {
                Creep { fluidity: 1.0 / modulus / time, ..Creep::elastic(1.0 / modulus) }
            }
            Fractional::Zener { equilibrium, instantaneous, time, .. } => Creep {
                terms: vec![CreepTerm {
                    compliance: 1.0 / equilibrium - 1.0 / instantaneous,
                    retardation_time: time * instantaneous / equilibrium,
                }],
                ..Creep::elastic(1.0 / instantaneous)
            },
        }
    }
}

/// x^a / Gamma(1 + a)
fn power(x: f64, a: f64) -> f64 {
    x.powf(a) / libm::tgamma(1.0 + a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn models(order: f64) -> [Fractional; 3] {
        [
            Fractional::Springpot { modulus: 2e6, time: 3.0, order },
            Fractional::Maxwell { modulus: 2e6, time: 3.0, order },
            Fractional::Zener { equilibrium: 1e6, instantaneous: 1e9, time: 1e-2, order },
        ]
    }

    #[test]
    fn creep_and_relaxation_belong_together() {
        // int_0^t G(t - s) J(s) ds = t for every material. With t - s = t v^m the power of G at its end
        // is gone; the midpoint rule then errs by n^-(1 + order), from the power of J at the other.
        for order in [0.3, 0.6, 0.9] {
            for model in models(order) {
                for t in [1e-3, 0.7, 40.0] {
                    let (n, m) = (2000, 1.0 / (1.0 - order));
                    let sum: f64 = (0..n)
                        .map(|k| (f64::from(k) + 0.5) / f64::from(n))
                        .map(|v: f64| (v.powf(m), m * v.powf(m - 1.0)))
                        .map(|(r, slope)| model.relaxation(t * r) * model.creep(t * (1.0 - r)) * slope)
                        .sum();
                    let error = sum / f64::from(n) - 1.0;
                    assert!(error.abs() < 1e-4, "{model:?} {t} {error}");
                }
            }
        }
    }

    #[test]
    fn the_complex_modulus_is_that_of_the_prony_sum() {
        for order in [0.2, 0.5, 0.95] {
            for model in models(order) {
                let prony = model.to_prony([1e-4, 1e4], 1e-3).unwrap();
                let relaxation = prony.creep.to_relaxation().unwrap();
                for omega in [0.1, 1.0, 7.0] {
                    let ((e1, e2), (p1, p2)) = (model.complex(omega), relaxation.complex(omega));
                    let error = (e1 - p1).hypot(e2 - p2) / e1.hypot(e2);
                    // A modulus at omega depends on times around 1/omega, each within 1e-3; the distance in the complex plane
                    // adds up a few of them.
                    assert!(error < 3e-3, "{model:?} {omega} {error}");
                }
            }
        }
    }

    #[test]
    fn prony_sums_keep_their_error_with_few_terms() {
        // Six decades to 1e-3: at most 1.5 terms per decade inside, and those of the margins.
        for order in [0.05, 0.5, 0.95] {
            for model in models(order) {
                let prony = model.to_prony([1e-3, 1e3], 1e-3).unwrap();
                assert!(prony.creep.terms.len() <= 26, "{model:?} {}", prony.creep.terms.len());
                let relaxation = prony.creep.to_relaxation().unwrap();
                for k in 0..=600 {
                    let t = 10f64.powf(-3.0 + 0.01 * f64::from(k));
                    let error = (prony.creep.value(t) / model.creep(t) - 1.0)
                        .abs()
                        .max((relaxation.value(t) / model.relaxation(t) - 1.0).abs());
                    // Measured on 20 times per decade, checked on 100: the error is smooth in between.
                    assert!(error < 1.05e-3, "{model:?} {t} {error}");
                }
            }
        }
    }

    #[test]
    fn a_tight_tolerance_is_met() {
        for model in models(0.5) {
            let prony = model.to_prony([1e-2, 1e2], 1e-6).unwrap();
            assert!(prony.error <= 1e-6 && prony.creep.terms.len() < 60, "{prony:?}");
        }
    }

    #[test]
    fn order_one_is_the_classical_model_exactly() {
        for model in models(1.0) {
            let prony = model.to_prony([1e-3, 1e3], 1e-3).unwrap();
            assert!(prony.error == 0.0 && prony.creep.terms.len() <= 1);
            for t in [0.0, 0.01, 3.0] {
                let (sum, exact) = (prony.creep.value(t), model.creep(t));
                assert!((sum - exact).abs() <= 1e-14 * exact, "{model:?} {t}");
            }
        }
        // And the limit is continuous.
        let [_, _, nearly] = models(1.0 - 1e-9);
        let [_, _, classical] = models(1.0);
        assert!((nearly.creep(0.3) / classical.creep(0.3) - 1.0).abs() < 1e-7);
    }

    #[test]
    fn any_order_above_zero_is_answered() {
        // Orders from those with 1/order terms in the sum to those whose scales are out of the range of doubles.
        for order in [f64::MIN_POSITIVE, 1e-100, 1e-9, 1e-3, 1.0 - 1e-9, 1.0 - f64::EPSILON] {
            for model in models(order) {
                for tolerance in [1e-3, 1e-6] {
                    let prony = model.to_prony([1e-3, 1e3], tolerance).unwrap();
                    assert!(prony.error <= tolerance && prony.creep.terms.len() < 70, "{model:?} {prony:?}");
                }
            }
        }
        // Almost a spring: half of the relaxing part has relaxed at any time.
        let [_, _, zener] = models(1e-100);
        assert!((zener.relaxation(1e-3) / (0.5 * (1e6 + 1e9)) - 1.0).abs() < 1e-12);
        assert!((zener.creep(1e3) * zener.relaxation(1e3) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_two_ways_to_a_prony_sum_agree() {
        // Cole and Cole's law by the trapezoidal rule, its tails summed to infinity.
        for order in [1e-6, 0.01, 0.1, 0.24, 0.5] {
            let [_, _, model] = models(order);
            let Fractional::Zener { equilibrium, instantaneous, time, order } = model else { unreachable!() };
            let law = ColeCole { order, time, equilibrium, relaxing: instantaneous - equilibrium };
            let relaxation = |t| model.relaxation(t);
            let exact = Exact::new(&|t| model.creep(t), &relaxation, [1e-3, 1e3], 1e-6).unwrap();
            let sum = prony_sum::by_quadrature(&exact, &law).unwrap();
            assert!(sum.error <= 1e-6, "{order} {}", sum.error);
            // The instantaneous modulus is the sum of all weights, that is the rule for the whole line, exact to 1e-9.
            let modulus = 1.0 / sum.creep.instantaneous;
            assert!((modulus / instantaneous - 1.0).abs() < 1e-6, "{order} {modulus:e}");
        }
    }

    #[test]
    fn a_transition_far_outside_the_window_is_a_spring() {
        let late = Fractional::Zener { equilibrium: 1e6, instantaneous: 1e9, time: 1e30, order: 0.7 };
        let prony = late.to_prony([1e-3, 1e3], 1e-3).unwrap();
        assert!(prony.creep.terms.is_empty());
        assert!((prony.creep.value(1.0) / 1e-9 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn bad_arguments_are_named() {
        let says = |model: Fractional, window: [f64; 2], tolerance: f64, words: &str| {
            let error = model.to_prony(window, tolerance).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        let [springpot, maxwell, zener] = models(0.5);
        says(Fractional::Springpot { modulus: 1.0, time: 1.0, order: 0.0 }, [1.0, 2.0], 1e-3, "order");
        says(Fractional::Springpot { modulus: 1.0, time: 1.0, order: 1.1 }, [1.0, 2.0], 1e-3, "order");
        says(Fractional::Maxwell { modulus: -1.0, time: 1.0, order: 0.5 }, [1.0, 2.0], 1e-3, "modulus");
        says(Fractional::Maxwell { modulus: 1.0, time: 0.0, order: 0.5 }, [1.0, 2.0], 1e-3, "time");
        says(
            Fractional::Zener { equilibrium: 2.0, instantaneous: 1.0, time: 1.0, order: 0.5 },
            [1.0, 2.0],
            1e-3,
            "greater than the equilibrium modulus",
        );
        says(springpot, [0.0, 1.0], 1e-3, "window");
        says(maxwell, [1.0, 1.0], 1e-3, "window");
        says(zener, [1.0, f64::INFINITY], 1e-3, "window");
        says(springpot, [1.0, 2.0], 0.0, "error allowed");
        says(springpot, [1.0, 2.0], f64::NAN, "error allowed");
    }
}
