//! A stage that waits for a number that none of its rows has: it ends by its duration.

use super::worst::Watch;
use super::{EVENT_WITHOUT_VALUE, Finding};
use crate::load::Event;
use crate::simulation::Simulation;
use crate::step::{Row, Step};

/// What the stages wait for.
#[derive(Default)]
pub(super) struct Waits {
    /// Stages whose rows so far have no value of it: number of the stage, first and last row.
    without: Vec<(usize, [usize; 2])>,
    /// Stage of the last row.
    last: Option<usize>,
    earlier: Vec<Finding>,
}

impl Watch for Waits {
    fn see(&mut self, step: &Step<'_>, row: &Row) {
        let (index, stage) = (step.index(), row.stage);
        // What an earlier session saw of the stage under way is known by its finding alone.
        let first = match self.last {
            Some(last) => (last != stage).then_some(index),
            None if index == 0 => Some(0),
            None => {
                let goes_on =
                    self.earlier.iter().position(|own| own.rows.is_some_and(|rows| rows[1] + 1 == index));
                goes_on.and_then(|at| Some(self.earlier.remove(at).rows?[0]))
            }
        };
        self.last = Some(stage);
        let Some(value) = step.awaited() else { return };
        if let Some(first) = first {
            self.without.push((stage, [first, index]));
        }
        match value.is_nan() {
            true => self.without.iter_mut().filter(|own| own.0 == stage).for_each(|own| own.1[1] = index),
            false => self.without.retain(|own| own.0 != stage),
        }
    }

    fn findings(&self, simulation: &Simulation) -> Vec<Finding> {
        let stages = &simulation.loading.stages;
        let found = self.without.iter().filter_map(|(stage, rows)| {
            let Some(Event::Number(number, _)) = stages.get(*stage)?.until else { return None };
            let name = number.name();
            let text = format!(
                "Stage {} waits for {name}, which has no value in any of its rows: it cannot end by that. Wait for another number.",
                stage + 1
            );
            Some(Finding::warning(EVENT_WITHOUT_VALUE, f64::NAN, f64::NAN, text).at(*rows))
        });
        found.chain(self.earlier.clone()).collect()
    }

    fn resume(&mut self, finding: &Finding) {
        if finding.code == EVENT_WITHOUT_VALUE {
            self.earlier.push(finding.clone());
        }
    }
}
