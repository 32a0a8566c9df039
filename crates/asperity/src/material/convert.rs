//! Exact conversion between relaxation and creep.
//!
//! In the Laplace domain the two are reciprocal, s^2 E^(s) C^(s) = 1 (B. Gross, Mathematical Structure
//! of the Theories of Viscoelasticity, 1953). With s = -1/x, both sides become a function
//!
//! F(x) = c + sum_k w_k / (p_k - x),   w_k > 0, c >= 0,
//!
//! of which the p_k are the times of one representation (and 0, for a dashpot or a spring) and the
//! roots are the times of the other:
//!
//! - relaxation: s E^(s) = F(lambda) with c = E_inf, (p, w) = (0, viscosity), (tau_i, E_i tau_i);
//!   C_j = 1 / (lambda_j F'(lambda_j));
//! - creep: -s C^(s) / tau = F(tau) with c = 1/eta, (p, w) = (0, C0), (lambda_j, C_j);
//!   E_i = 1 / (tau_i^2 F'(tau_i)).
//!
//! F increases between its poles, so exactly one root lies between each neighbouring pair, and one beyond the last pole if c > 0
//! (the roots interlace the poles). Each root is bracketed. It is computed as the distance from the nearer pole, by bisection
//! over the floating-point numbers. This gives full relative accuracy of the distance, which the weights need, over any number of
//! decades.

use crate::error::{Error, Result, require};
use crate::material::{Creep, CreepTerm, Relaxation, RelaxationTerm};

impl Relaxation {
    /// The creep function of the same material, exactly (a Prony series of the same kind).
    ///
    /// Without an equilibrium modulus the material flows (`fluidity` > 0); with a viscosity its instantaneous compliance is 0.
    ///
    /// ```
    /// use asperity::material::Relaxation;
    /// // A Maxwell element: 1/E + t/(E tau).
    /// let creep = Relaxation::absolute(0.0, &[(2e6, 5.0)])?.to_creep()?;
    /// assert_eq!((creep.instantaneous, creep.fluidity), (0.5e-6, 1e-7));
    /// // The reciprocal relation in the Laplace domain, at s = i omega: E*(omega) J*(omega) = 1.
    /// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
    /// let ((e1, e2), (j1, j2)) = (pmma.complex(0.03), pmma.to_creep()?.complex(0.03));
    /// assert!((e1 * j1 + e2 * j2 - 1.0).abs() < 1e-14 && (e2 * j1 - e1 * j2).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] as [`Relaxation::validate`], or where the result leaves the range of doubles.
    pub fn to_creep(&self) -> Result<Creep> {
        self.validate()?;
        let relaxation = self.tidy();
        let mut poles = vec![];
        if relaxation.viscosity > 0.0 {
            poles.push((0.0, relaxation.viscosity));
        }
        poles.extend(relaxation.terms.iter().map(|e| (e.relaxation_time, e.modulus * e.relaxation_time)));
        let terms = interlacing_roots(relaxation.equilibrium, &poles)?
            .into_iter()
            .map(|root| CreepTerm { compliance: 1.0 / (root.x * root.slope), retardation_time: root.x });
        let creep = Creep {
            instantaneous: if relaxation.viscosity > 0.0 { 0.0 } else { 1.0 / relaxation.instantaneous() },
            terms: terms.filter(|c| c.compliance > 0.0).collect(),
            fluidity: if relaxation.equilibrium > 0.0 {
                0.0
            } else {
                1.0 / poles.iter().map(|p| p.1).sum::<f64>()
            },
        };
        creep.validate().map_err(|e| out_of_range("creep", &e))?;
        Ok(creep)
    }
}

impl Creep {
    /// The relaxation function of the same material, exactly (a Prony series of the same kind).
    ///
    /// With a flow term there is no equilibrium modulus. Without an instantaneous compliance there is a `viscosity`, and the
    /// modulus at t = 0 is infinite.
    ///
    /// ```
    /// use asperity::material::{Creep, CreepTerm};
    /// // A Zener solid with J0 = J1: E(t) = E0/2 (1 + exp(-2 t / lambda)).
    /// let term = CreepTerm { compliance: 1e-6, retardation_time: 3.0 };
    /// let zener = Creep { instantaneous: 1e-6, terms: vec![term], fluidity: 0.0 };
    /// let relaxation = zener.to_relaxation()?;
    /// assert!((relaxation.value(1.0) - 0.5e6 * (1.0 + (-2.0f64 / 3.0).exp())).abs() < 1e-9);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] as [`Creep::validate`], for a rigid body (no compliance at all), or where the
    /// result leaves the range of doubles.
    pub fn to_relaxation(&self) -> Result<Relaxation> {
        self.validate()?;
        let creep = self.tidy();
        require(
            creep.long_time() > 0.0,
            "creep function",
            "0 at all times (rigid)",
            "a compliance greater than 0 1/Pa, to have a modulus",
        )?;
        let (mut relaxation, _) = relaxation_of(&creep)?;
        relaxation.terms.retain(|e| e.modulus > 0.0);
        relaxation.validate().map_err(|e| out_of_range("relaxation", &e))?;
        Ok(relaxation)
    }
}

/// The relaxation function of a creep function whose terms are in order of time without duplicates, with one term for every root,
/// and the roots.
pub(super) fn relaxation_of(creep: &Creep) -> Result<(Relaxation, Vec<Root>)> {
    let mut poles = vec![];
    if creep.instantaneous > 0.0 {
        poles.push((0.0, creep.instantaneous));
    }
    poles.extend(creep.terms.iter().map(|c| (c.retardation_time, c.compliance)));
    let roots = interlacing_roots(creep.fluidity, &poles)?;
    let term = |root: &Root| RelaxationTerm {
        modulus: 1.0 / (root.x * (root.x * root.slope)),
        relaxation_time: root.x,
    };
    let relaxation = Relaxation {
        equilibrium: if creep.fluidity > 0.0 { 0.0 } else { 1.0 / creep.long_time() },
        terms: roots.iter().map(term).collect(),
        viscosity: if creep.instantaneous > 0.0 { 0.0 } else { 1.0 / creep.rate(0.0) },
    };
    Ok((relaxation, roots))
}

fn out_of_range(which: &str, error: &Error) -> Error {
    Error::invalid(
        format!("{which} function of the material"),
        format!("out of the range of floating-point numbers ({error})"),
        "within that range: check the sizes of moduli and times",
    )
}

/// A root x of F and F'(x).
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    x: f64,
    slope: f64,
    /// The nearest pole, and x minus that pole to full relative accuracy.
    pub(super) pole: f64,
    pub(super) distance: f64,
}

/// The roots of F(x) = c + sum w_k/(p_k - x) for increasing poles p_k >= 0.
fn interlacing_roots(c: f64, poles: &[(f64, f64)]) -> Result<Vec<Root>> {
    if let Some((time, weight)) = poles.iter().find(|(_, w)| !(*w > 0.0 && w.is_finite())) {
        let weight = Error::invalid(format!("weight at {time} s"), weight, "positive and finite");
        return Err(out_of_range("converted", &weight));
    }
    let last = poles.len().saturating_sub(1);
    let mut roots = Vec::with_capacity(poles.len());
    for (k, &(pole, _)) in poles.iter().enumerate() {
        let function = Offset::new(c, poles, k);
        let distance = if k < last {
            let gap = poles[k + 1].0 - pole;
            if function.value(0.5 * gap) < 0.0 {
                // Nearer to the next pole: measure the distance from there, downwards.
                let function = Offset::new(c, poles, k + 1);
                let below = bisect(0.5 * gap, |d| function.value(-d) > 0.0);
                let (next, slope) = (poles[k + 1].0, function.slope(-below));
                roots.push(Root { x: next - below, slope, pole: next, distance: -below });
                continue;
            }
            bisect(0.5 * gap, |d| function.value(d) < 0.0)
        } else if c > 0.0 {
            // 0 = c - sum w/(x - p) and x - p >= x - p_last give x - p_last <= sum w / c.
            let bound = 2.0 * poles.iter().map(|p| p.1).sum::<f64>() / c;
            bisect(bound.min(f64::MAX), |d| function.value(d) < 0.0)
        } else {
            break;
        };
        roots.push(Root { x: pole + distance, slope: function.slope(distance), pole, distance });
    }
    match roots.iter().find(|r| !(r.x > 0.0 && r.x < f64::MAX && r.slope > 0.0)) {
        Some(root) => Err(out_of_range("converted", &Error::invalid("time", root.x, "positive and finite"))),
        None => Ok(roots),
    }
}

/// F as a function of the distance from one of its poles.
///
/// Evaluated with about twice the digits of a double (T. J. Dekker, Numer. Math. 18, 1971): if two poles have a relative distance
/// g, the term that determines the root between them is only g times the other terms, which cancel around it.
struct Offset {
    c: f64,
    /// (p_k - origin as high and low part, w_k).
    poles: Vec<(f64, f64, f64)>,
}

impl Offset {
    fn new(c: f64, poles: &[(f64, f64)], origin: usize) -> Self {
        let zero = poles[origin].0;
        let offset = |&(p, w): &(f64, f64)| {
            let (high, low) = exact_sum(p, -zero);
            (high, low, w)
        };
        Offset { c, poles: poles.iter().map(offset).collect() }
    }

    fn value(&self, d: f64) -> f64 {
        let (mut sum, mut rest) = (self.c, 0.0);
        for &(high, low, w) in &self.poles {
            let (distance, error) = exact_sum(high, -d);
            let quotient = w / distance;
            if quotient.is_infinite() {
                return quotient; // on the pole
            }
            let remainder = (-quotient).mul_add(distance, w) - quotient * (error + low);
            let (next, rounding) = exact_sum(sum, quotient);
            sum = next;
            rest += rounding + remainder / distance;
        }
        sum + rest
    }

    fn slope(&self, d: f64) -> f64 {
        let distance = |high: f64, low: f64| {
            let (distance, error) = exact_sum(high, -d);
            distance + (error + low)
        };
        self.poles.iter().map(|&(high, low, w)| w / distance(high, low) / distance(high, low)).sum()
    }
}

/// a + b as its rounded value and the rounding error, exactly (D. E. Knuth).
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The distance in (0, `upper`] at which `is_before_root` changes from true to false. The integers that represent positive
/// doubles are ordered as the doubles are, so 63 halvings reach the last digit.
fn bisect(upper: f64, is_before_root: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (f64::MIN_POSITIVE.to_bits(), upper.max(f64::MIN_POSITIVE).to_bits());
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is_before_root(f64::from_bits(middle)) { low = middle } else { high = middle }
    }
    f64::from_bits(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::series::tests::random;

    fn relative(a: f64, b: f64) -> f64 {
        (a - b).abs() / b.abs().max(f64::MIN_POSITIVE)
    }

    /// The largest relative difference of any number in the two.
    fn difference(a: &Relaxation, b: &Relaxation) -> f64 {
        assert_eq!(a.terms.len(), b.terms.len());
        let terms =
            a.terms.iter().zip(&b.terms).map(|(a, b)| {
                relative(a.modulus, b.modulus).max(relative(a.relaxation_time, b.relaxation_time))
            });
        terms.fold(relative(a.equilibrium, b.equilibrium).max(relative(a.viscosity, b.viscosity)), f64::max)
    }

    fn round_trip(relaxation: &Relaxation) -> f64 {
        difference(&relaxation.to_creep().unwrap().to_relaxation().unwrap(), relaxation)
    }

    #[test]
    fn pmma_converts_to_its_known_creep() {
        // Converted with 50 digits: D(t) in 1/MPa of 1973 + 254.776 e^(-t/8.93) + 263.6628 e^(-t/117.96).
        let pmma = Relaxation::absolute(1973.0, &[(254.776, 8.93), (263.6628, 117.96)]).unwrap();
        let creep = pmma.to_creep().unwrap();
        let expected = [
            (creep.instantaneous, 4.013_744_989_441_442e-4),
            (creep.terms[0].compliance, 4.474_062_327_446_717_5e-5),
            (creep.terms[0].retardation_time, 9.936_295_903_145_377),
            (creep.terms[1].compliance, 6.072_724_980_368_965e-5),
            (creep.terms[1].retardation_time, 133.870_487_456_205_86),
            (creep.value(50.0), 4.647_503_862_279_336_4e-4),
            (creep.value(1000.0), 5.068_077_586_017_327e-4),
        ];
        for (value, exact) in expected {
            // A few roundings; the weights lose the digits in which root and pole agree (one here).
            assert!(relative(value, exact) < 1e-14, "{value} {exact}");
        }
        assert_eq!(creep.fluidity, 0.0);
    }

    #[test]
    fn sixty_terms_over_twenty_decades_return_from_creep() {
        for seed in 0..20 {
            let mut random = random(seed);
            let count = 60;
            let terms: Vec<_> = (0..count)
                .map(|k| {
                    let decade = -10.0 + 20.0 * (k as f64 + 0.8 * random()) / count as f64;
                    (10f64.powf(6.0 + 3.0 * random()), 10f64.powf(decade))
                })
                .collect();
            let solid = Relaxation::absolute(1e6, &terms).unwrap();
            let fluid = Relaxation::absolute(0.0, &terms).unwrap();
            let viscous = Relaxation { viscosity: 1e-6, ..solid.clone() };
            for relaxation in [solid, fluid, viscous] {
                // The documented accuracy; a rounding of each time is amplified by time over distance, up to 1e2.
                let error = round_trip(&relaxation);
                assert!(error < 1e-12, "seed {seed}: {error:e}");
            }
        }
    }

    #[test]
    fn weights_of_very_different_size_return_from_creep() {
        // With tiny terms roots nearly coincide with poles: only the distance from the pole determines the weight.
        let terms = [(1e-9, 1e-4), (1e9, 1e-2), (1e-3, 1.0), (1e3, 1e3), (1e-12, 1e9)];
        let relaxation = Relaxation::absolute(1e6, &terms).unwrap();
        let error = round_trip(&relaxation);
        assert!(error < 1e-13, "{error:e}");
    }

    #[test]
    fn modulus_and_compliance_are_reciprocal_in_the_laplace_domain() {
        let mut random = random(7);
        let terms: Vec<_> =
            (0..30).map(|_| (10f64.powf(9.0 * random()), 10f64.powf(18.0 * random() - 9.0))).collect();
        for (equilibrium, viscosity) in [(1e5, 0.0), (0.0, 0.0), (1e5, 3.0), (0.0, 3.0)] {
            let relaxation = Relaxation { viscosity, ..Relaxation::absolute(equilibrium, &terms).unwrap() };
            let creep = relaxation.to_creep().unwrap();
            for decade in -12..=12 {
                let s = 10f64.powi(decade);
                let modulus = relaxation.equilibrium
                    + viscosity * s
                    + relaxation
                        .terms
                        .iter()
                        .map(|e| e.modulus * s * e.relaxation_time / (1.0 + s * e.relaxation_time))
                        .sum::<f64>();
                let compliance = creep.instantaneous
                    + creep.fluidity / s
                    + creep.terms.iter().map(|c| c.compliance / (1.0 + s * c.retardation_time)).sum::<f64>();
                // Sums of positive terms have only rounding errors, for any terms.
                assert!((modulus * compliance - 1.0).abs() < 1e-13, "{s}: {}", modulus * compliance - 1.0);
            }
        }
    }

    #[test]
    fn close_times_do_not_spoil_the_function() {
        for gap in [0.0, 1e-15, 1e-12, 1e-9, 2e-9, 1e-8, 1e-6, 1e-3] {
            let relaxation = Relaxation {
                equilibrium: 1.0,
                ..Relaxation::absolute(1.0, &[(2.0, 5.0), (3.0, 5.0 * (1.0 + gap))]).unwrap()
            };
            let creep = relaxation.to_creep().unwrap();
            let single =
                Relaxation::absolute(1.0, &[(5.0, 5.0 * (1.0 + 0.6 * gap))]).unwrap().to_creep().unwrap();
            for t in [0.0, 0.1, 5.0, 30.0, 1e3] {
                // Two terms this close are one term up to the square of their distance.
                assert!(relative(creep.value(t), single.value(t)) < 1e-14 + gap * gap, "{gap} {t}");
            }
            let error = (0..50)
                .map(|k| 10f64.powf(0.1 * k as f64 - 2.0))
                .map(|t| relative(creep.to_relaxation().unwrap().value(t), relaxation.value(t)))
                .fold(0.0, f64::max);
            assert!(error < 1e-12, "{gap}: {error:e}");
        }
    }

    #[test]
    fn springs_and_dashpots_convert_into_themselves() {
        let spring = Relaxation { equilibrium: 4.0, ..Relaxation::default() };
        assert_eq!(spring.to_creep().unwrap(), Creep::elastic(0.25));
        assert_eq!(Creep::elastic(0.25).to_relaxation().unwrap(), spring);
        let dashpot = Relaxation { viscosity: 4.0, ..Relaxation::default() };
        let flow = Creep { fluidity: 0.25, ..Creep::default() };
        assert_eq!(dashpot.to_creep().unwrap(), flow);
        assert_eq!(flow.to_relaxation().unwrap(), dashpot);
        let kelvin_voigt = Relaxation { equilibrium: 2.0, viscosity: 6.0, ..Relaxation::default() };
        let creep = kelvin_voigt.to_creep().unwrap();
        assert_eq!((creep.instantaneous, creep.fluidity), (0.0, 0.0));
        assert_eq!(creep.terms, vec![CreepTerm { compliance: 0.5, retardation_time: 3.0 }]);
        assert_eq!(creep.to_relaxation().unwrap(), kelvin_voigt);
    }

    #[test]
    fn absurd_sizes_are_answered() {
        let huge = Relaxation::absolute(1.0, &[(1e300, 1e300)]).unwrap();
        assert!(huge.to_creep().unwrap_err().to_string().contains("range"));
        assert!(Creep::default().to_relaxation().unwrap_err().to_string().contains("rigid"));
    }
}
