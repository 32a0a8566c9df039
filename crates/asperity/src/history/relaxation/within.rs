//! The state within the step that was solved last: u between its values at the ends, on the clock in which it ran.

use super::rules::Rules;
use super::{Relaxation, UnderWay};
use crate::history::{Ends, Moment};
use asperity_sweep::each;

impl Relaxation {
    /// The moment that lies this far into the step, in laboratory time and on the clock of each body.
    pub(super) fn moment(&self, lengths: &[f64]) -> Moment {
        let x = self.pair.length(lengths);
        let whole = self.rules.length;
        if self.under_way != UnderWay::Contact || x >= whole {
            return Moment { share: 1.0, load: self.cell.end.load };
        }
        let (share, driver) = self.cell.gone(&self.dual, self.rules.driver, x, whole);
        self.cell.moment(&self.dual, x, share, driver)
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
