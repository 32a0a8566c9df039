//! Sums of the retarded strains at the end of the step that was closed last.

use super::{Combination, Ending, Relaxation, UnderWay};
use asperity_sweep::each;

impl Relaxation {
    /// The retardation times λ_j of the pair, in the order of its terms.
    pub(in crate::history) fn retardation_times(&self) -> impl Iterator<Item = f64> + '_ {
        self.dual.creep.terms.iter().map(|term| term.retardation_time)
    }

    /// Writes Σ f_j e_j/C_j with e_j/C_j = Σ_i E_i τ_i/(λ_j - τ_i) q_i + (ζ/λ_j) u; `terms` are the (j, f_j), `unit` is U at the end.
    pub(in crate::history) fn retarded(&self, terms: &[(usize, f64)], unit: &[f64], sum: &mut [f64]) {
        let relaxation = &self.dual.relaxation;
        // The sum is Σ states_i q_i + own u of the end of the step.
        let mut states = vec![0.0; self.dual.states()];
        let mut own = 0.0;
        for (j, f) in terms {
            let gaps = self.dual.gaps(*j).iter().zip(&relaxation.terms);
            let factors = gaps.map(|(gap, branch)| branch.modulus * (branch.relaxation_time / gap));
            states.iter_mut().zip(factors).for_each(|(state, factor)| *state += f * factor);
            own += f * relaxation.viscosity / self.dual.creep.terms[*j].retardation_time;
        }
        // In terms of q and u at its start, and of U.
        let (weights, of_u, of_unit) = match self.under_way {
            UnderWay::Nothing => return sum.fill(0.0),
            UnderWay::Contact => {
                let Ending { compliance, recalled, updates } = self.rules.ending();
                let of_end = own + states.iter().zip(updates).map(|(b, update)| b * update.new).sum::<f64>();
                let kept = states.iter().zip(updates).zip(recalled.weights);
                let old: f64 = states.iter().zip(updates).map(|(b, update)| b * update.old).sum();
                (
                    kept.map(|((b, update), weight)| b * update.keep + of_end * weight).collect(),
                    old + of_end * recalled.own,
                    of_end * compliance,
                )
            }
            UnderWay::Apart => {
                let rows = self.recovery();
                let all = states.iter().chain([&own]);
                let mut both = vec![0.0; states.len() + 1];
                for (factor, row) in all.zip(&rows) {
                    both.iter_mut().zip(row).for_each(|(sum, weight)| *sum += factor * weight);
                }
                let of_u = both.pop().unwrap_or_default();
                (both, of_u, 0.0)
            }
        };
        let start = Combination { weights: &weights, own: of_u };
        self.states.combine(start, &self.displacement, None, sum);
        each(sum, unit, |sum, unit| *sum += of_unit * unit);
    }
}
