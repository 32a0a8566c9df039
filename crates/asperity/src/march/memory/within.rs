//! The state within the step that was solved last: u between its values at the ends, on the clock in which it ran.

use super::{Course, Memory, Rules, UnderWay};
use asperity_sweep::sweep;

/// A moment within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::march) struct Moment {
    /// How far u is from its value at the start (0) to that at the end (1).
    pub(in crate::march) share: f64,
    /// The load then \[N\].
    pub(in crate::march) load: f64,
}

impl Memory {
    /// The moment that lies this far into the step, in laboratory time and on the clock of each body.
    pub(in crate::march) fn moment(&self, lengths: &[f64]) -> Moment {
        let x = self.clocks.length(lengths);
        let whole = self.rules.length;
        if self.under_way != UnderWay::Contact || x >= whole {
            return Moment { share: 1.0, load: self.end.load };
        }
        let (share, course) = match self.rules.course {
            Course::Time => (x / whole, Course::Time),
            Course::Load(change) => {
                let part = self.shape.change(&self.dual, x);
                (part / change, Course::Load(part))
            }
        };
        let mut rules = Rules::new(self.dual.states());
        rules.set(&self.dual, x, course, &self.shape);
        let driver = self.total.driver + share * (self.end.driver - self.total.driver);
        let recalled = rules.recalled();
        let sum: f64 = recalled.weights.iter().zip(&self.total.states).map(|(w, q)| w * q).sum();
        let load = (driver - sum - recalled.own * self.total.driver) / rules.compliance;
        Moment { share, load: load.max(0.0) }
    }

    /// Writes u that lies `lengths` into the step, where `moment` is; `unit` is U at its end, `gap` less `rigid` g.
    pub(in crate::march) fn displaced(
        &self,
        lengths: &[f64],
        moment: Moment,
        (unit, gap, rigid): (&[f64], &[f64], &[f64]),
        u: &mut [f64],
    ) {
        let compliance = self.rules.compliance;
        match self.under_way {
            UnderWay::Apart => {
                let elapsed: Vec<f64> = self.clocks.own(lengths).collect();
                let recalled = self.recovered(&elapsed);
                let mut rules = Rules::new(self.dual.states());
                rules.set_apart(&recalled);
                self.look(&rules, None, u);
            }
            _ if self.is_elastic() => {
                sweep((u, unit), &|(u, unit): (&mut [f64], &[f64])| {
                    u.iter_mut().zip(unit).for_each(|(u, unit)| *u = compliance * unit);
                });
            }
            _ => {
                let fields = (u, &self.displacement[..], unit, gap, rigid);
                sweep(fields, &|(u, start, unit, gap, rigid): (
                    &mut [f64],
                    &[f64],
                    &[f64],
                    &[f64],
                    &[f64],
                )| {
                    for (k, u) in u.iter_mut().enumerate() {
                        let g = gap[k] - rigid[k];
                        let end = compliance * unit[k] + if g.is_finite() { g } else { 0.0 };
                        *u = start[k] + moment.share * (end - start[k]);
                    }
                });
            }
        }
    }
}
