//! Both forms of one material, and the relation of their internal states.
//!
//! Under a displacement u and the corresponding pressure measure U = Kp, the retarded strains e_j and the flow v of the creep
//! form, and the relaxing displacements q_i of the relaxation form, obey
//!
//! ```text
//! λ_j de_j/dt + e_j = C_j U,   dv/dt = U/η,       u = C0 U + Σ e_j + v
//! τ_i dq_i/dt + q_i = u,                          U = E_inf u + Σ E_i (u - q_i) + ζ du/dt
//! ```
//!
//! They are two bases of the same state space. Partial fractions of their transfer functions give
//!
//! ```text
//! q_i = Σ_j λ_j/(λ_j - τ_i) e_j + v
//! e_j = C_j [ Σ_i E_i τ_i/(λ_j - τ_i) q_i + (ζ/λ_j) u ],    v = (1/η) [ Σ E_i τ_i q_i + ζ u ]
//! ```
//!
//! and sqrt(E_i τ_i) λ_j/(λ_j - τ_i) sqrt(C_j/λ_j) is an orthogonal matrix: the conversion loses no digits if λ_j - τ_i is taken
//! from the root finder's distance to the pole, never by subtraction.

use crate::error::{Result, require};
use crate::material::convert::relaxation_of;
use crate::material::{Creep, Relaxation};

/// Smallest relative distance of retardation times; closer ones are moved apart.
const APART: f64 = 1e-9;

/// A creep function, its relaxation function, and the conversion between their states.
#[derive(Clone, Debug)]
pub(crate) struct Dual {
    /// The terms in the order that was given.
    pub(crate) creep: Creep,
    /// One term for each state q_i.
    pub(crate) relaxation: Relaxation,
    /// λ_j - τ_i, \[j\]\[i\].
    gaps: Vec<f64>,
}

impl Dual {
    /// Both forms of a creep function without zero terms; equal times are moved apart by a billionth.
    pub(crate) fn of(mut creep: Creep) -> Result<Self> {
        creep.validate()?;
        require(
            creep.long_time() > 0.0,
            "contact creep compliance",
            0,
            "greater than 0 (both bodies are rigid)",
        )?;
        let mut order: Vec<usize> = (0..creep.terms.len()).collect();
        order.sort_by(|a, b| creep.terms[*a].retardation_time.total_cmp(&creep.terms[*b].retardation_time));
        for pair in order.windows(2) {
            let least = creep.terms[pair[0]].retardation_time * (1.0 + APART);
            let time = &mut creep.terms[pair[1]].retardation_time;
            *time = time.max(least);
        }
        let sorted = Creep { terms: order.iter().map(|j| creep.terms[*j]).collect(), ..creep };
        let (relaxation, roots) = relaxation_of(&sorted)?;
        let gap = |time: f64| roots.iter().map(move |root| (time - root.pole) - root.distance);
        let gaps = creep.terms.iter().flat_map(|term| gap(term.retardation_time)).collect();
        Ok(Dual { creep, relaxation, gaps })
    }

    /// Number of states q_i.
    pub(crate) fn states(&self) -> usize {
        self.relaxation.terms.len()
    }

    /// Number of strains: the e_j, and v of a fluid.
    pub(crate) fn strains(&self) -> usize {
        self.creep.terms.len() + usize::from(self.creep.fluidity > 0.0)
    }

    /// λ_j - τ_i of all i.
    pub(crate) fn gaps(&self, j: usize) -> &[f64] {
        &self.gaps[j * self.states()..(j + 1) * self.states()]
    }

    /// Writes the strains (the e_j, then v) that belong to the states `q` under the displacement `u`.
    pub(crate) fn to_strains(&self, q: &[f64], u: f64, strains: &mut [f64]) {
        let zeta = self.relaxation.viscosity;
        let states = || self.relaxation.terms.iter().zip(q);
        for (j, (term, e)) in self.creep.terms.iter().zip(&mut *strains).enumerate() {
            let sum: f64 = states()
                .zip(self.gaps(j))
                .map(|((branch, q), gap)| branch.modulus * (branch.relaxation_time / gap) * q)
                .sum();
            *e = term.compliance * (sum + zeta / term.retardation_time * u);
        }
        if let Some(v) = strains.get_mut(self.creep.terms.len()) {
            let sum: f64 = states().map(|(branch, q)| branch.modulus * branch.relaxation_time * q).sum();
            *v = self.creep.fluidity * (sum + zeta * u);
        }
    }

    /// Writes the states q_i that belong to the strains.
    pub(crate) fn to_states(&self, strains: &[f64], q: &mut [f64]) {
        let flow = strains.get(self.creep.terms.len()).copied().unwrap_or(0.0);
        q.fill(flow);
        for (j, (term, e)) in self.creep.terms.iter().zip(strains).enumerate() {
            let gaps = self.gaps(j);
            q.iter_mut().zip(gaps).for_each(|(q, gap)| *q += term.retardation_time / gap * e);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::CreepTerm;
    use crate::material::series::tests::random;

    fn spectrum(seed: u64, count: usize, decades: f64) -> Vec<CreepTerm> {
        let mut random = random(seed);
        let term = |k: usize| CreepTerm {
            compliance: libm::pow(10.0, 3.0 * random() - 6.0),
            retardation_time: libm::pow(10.0, decades * ((k as f64 + 0.8 * random()) / count as f64 - 0.5)),
        };
        (0..count).map(term).collect()
    }

    #[test]
    fn the_change_of_states_is_orthogonal_for_eighty_terms_over_twenty_decades() {
        for seed in 0..6 {
            for (instantaneous, fluidity) in [(1e-6, 0.0), (1e-6, 1e-14)] {
                let dual =
                    Dual::of(Creep { instantaneous, terms: spectrum(seed, 80, 20.0), fluidity }).unwrap();
                let scale: Vec<f64> = dual
                    .creep
                    .terms
                    .iter()
                    .map(|c| (c.compliance / c.retardation_time).sqrt())
                    .chain((fluidity > 0.0).then_some(fluidity.sqrt()))
                    .collect();
                let mut columns = vec![];
                for j in 0..dual.strains() {
                    let mut strains = vec![0.0; dual.strains()];
                    strains[j] = scale[j];
                    let mut q = vec![0.0; dual.states()];
                    dual.to_states(&strains, &mut q);
                    let weigh = |(q, e): (&f64, &crate::material::RelaxationTerm)| {
                        q * (e.modulus * e.relaxation_time).sqrt()
                    };
                    columns.push(q.iter().zip(&dual.relaxation.terms).map(weigh).collect::<Vec<f64>>());
                    // There and back.
                    let mut back = vec![0.0; dual.strains()];
                    dual.to_strains(&q, 0.0, &mut back);
                    for (k, (found, scale)) in back.iter().zip(&scale).enumerate() {
                        let exact = f64::from(u8::from(k == j));
                        assert!((found / scale - exact).abs() < 1e-13, "{seed} {j} {k} {}", found / scale);
                    }
                }
                for (j, a) in columns.iter().enumerate() {
                    for (k, b) in columns.iter().enumerate() {
                        let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                        let exact = f64::from(u8::from(k == j));
                        assert!((product - exact).abs() < 1e-13, "{seed} {j} {k} {product}");
                    }
                }
            }
        }
    }

    #[test]
    fn both_forms_give_one_displacement_with_and_without_a_spring_at_once() {
        // At U = 0 the displacement is that of the strains; if C0 = 0 this holds at any U.
        for (instantaneous, fluidity) in [(1e-6, 0.0), (0.0, 0.0), (0.0, 1e-7), (1e-6, 1e-7)] {
            let dual = Dual::of(Creep { instantaneous, terms: spectrum(3, 5, 6.0), fluidity }).unwrap();
            let mut random = random(11);
            let strains: Vec<f64> = (0..dual.strains()).map(|_| random()).collect();
            let u: f64 = strains.iter().sum();
            let mut q = vec![0.0; dual.states()];
            dual.to_states(&strains, &mut q);
            if instantaneous > 0.0 {
                let sum: f64 = dual.relaxation.terms.iter().zip(&q).map(|(e, q)| e.modulus * q).sum();
                // A few roundings of terms of both signs.
                assert!((sum * instantaneous / u - 1.0).abs() < 1e-11, "{} {u}", sum * instantaneous);
            }
            let mut back = vec![0.0; dual.strains()];
            dual.to_strains(&q, u, &mut back);
            for (a, b) in back.iter().zip(&strains) {
                assert!((a - b).abs() < 1e-12, "{a} {b}");
            }
        }
    }

    #[test]
    fn equal_times_of_two_bodies_are_two_states() {
        let term = |compliance, retardation_time| CreepTerm { compliance, retardation_time };
        let terms = vec![term(2.0, 3.0), term(1.0, 0.5), term(0.7, 3.0)];
        let dual = Dual::of(Creep { instantaneous: 1.0, terms, fluidity: 0.0 }).unwrap();
        assert_eq!(dual.states(), 3);
        let mut q = [0.0; 3];
        dual.to_states(&[0.3, 0.2, 0.9], &mut q);
        let mut back = [0.0; 3];
        dual.to_strains(&q, 0.0, &mut back);
        // Times a billionth apart: states of 1e9 have nine digits fewer.
        assert!((back[0] - 0.3).abs() < 1e-6 && (back[2] - 0.9).abs() < 1e-6, "{back:?}");
    }
}
