//! The state within the step that was solved last: u between its values at the ends, on the clock in which it ran.

use super::rules::{Driver, Rules};
use super::{Relaxation, UnderWay};
use crate::history::{Ends, Moment};
use asperity_sweep::each;

impl Relaxation {
    /// The moment that lies this far into the step, in laboratory time and on the clock of each body.
    pub(super) fn moment(&self, lengths: &[f64]) -> Moment {
        let x = self.pair.length(lengths);
        let whole = self.rules.length;
        if self.under_way != UnderWay::Contact || x >= whole {
            return Moment { share: 1.0, load: self.end.load };
        }
        let (share, driver) = match self.rules.driver {
            Driver::Time => (x / whole, Driver::Time),
            Driver::Load(change) => {
                let part = self.shape.change(&self.dual, x);
                (part / change, Driver::Load(part))
            }
        };
        let mut rules = Rules::new(self.dual.states());
        rules.set(&self.dual, x, driver, &self.shape);
        let driver = self.total.driver + share * (self.end.driver - self.total.driver);
        let recalled = rules.recalled();
        let sum: f64 = recalled.weights.iter().zip(&self.total.states).map(|(w, q)| w * q).sum();
        let load = (driver - sum - recalled.own * self.total.driver) / rules.compliance;
        Moment { share, load: load.max(0.0) }
    }

    /// Writes u that lies `lengths` into the step, where `moment` is.
    pub(super) fn displaced(&self, lengths: &[f64], moment: Moment, ends: &Ends<'_>, u: &mut [f64]) {
        let (compliance, share) = (self.rules.compliance, moment.share);
        let unit = &ends.now.unit_displacement[..];
        match self.under_way {
            UnderWay::Apart => {
                let elapsed: Vec<f64> = self.pair.own(lengths).collect();
                let recalled = self.recovered(&elapsed);
                let mut rules = Rules::new(self.dual.states());
                rules.set_apart(&recalled);
                self.recall(&rules, None, u);
            }
            _ if self.is_elastic() => {
                let fields = (&ends.before.unit_displacement[..], unit);
                each(u, fields, |u, (start, end)| *u = compliance * (start + share * (end - start)));
            }
            _ => {
                let fields = (&self.displacement[..], unit, ends.gap, ends.rigid);
                each(u, fields, |u, (start, unit, gap, rigid)| {
                    let g = gap - rigid;
                    let end = compliance * unit + if g.is_finite() { g } else { 0.0 };
                    *u = start + share * (end - start);
                });
            }
        }
    }
}
