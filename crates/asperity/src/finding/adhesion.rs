//! Adhesion: cells that snap one by one, laws that converge slowly, attraction beyond the border.

use super::words::{digits, si};
use super::worst::{Watch, Worst};
use super::{ADHESION_AT_BORDER, ADHESION_UNRESOLVED, Finding};
use crate::grid::Boundary;
use crate::simulation::Simulation;
use crate::step::{Row, Step};
use crate::traction::{AdhesionLaw, AdhesionScale, FINE_TRAP};

/// Largest attraction at the border of a free domain, over the largest of the law.
const CUT: f64 = 1e-3;

/// What the law and the cells say before the run.
pub(super) fn before(simulation: &Simulation) -> Option<Finding> {
    let law = *simulation.traction.as_ref()?.as_adhesion()?;
    let scale = AdhesionScale::of(simulation).ok()??;
    let [nx, ny] = scale.cells_needed;
    if law.work == 0.0 {
        return None;
    }
    let trap = digits(scale.trap);
    if scale.trap > FINE_TRAP {
        let text = format!(
            "The trap number of the adhesion is {trap}, more than {FINE_TRAP}: cells snap into and out of contact one by one, which makes \
             false forces and hysteresis. Take {nx} x {ny} cells, or a longer range than {}.",
            si(law.range, "m")
        );
        return Some(Finding::warning(ADHESION_UNRESOLVED, scale.trap, FINE_TRAP, text));
    }
    (law.law == AdhesionLaw::Dugdale).then(|| {
        let text = format!(
            "The attraction of the law \"dugdale\" ends at once, so that each cell snaps on its own: forces converge only in proportion to the \
             cell (mean trap number {trap}). Compare with half the cells, or take the law \"exponential\"."
        );
        Finding::warning(ADHESION_UNRESOLVED, scale.trap, FINE_TRAP, text).as_note()
    })
}

/// The attraction at the border of a free domain.
#[derive(Default)]
pub(super) struct Border(Worst);

impl Watch for Border {
    fn see(&mut self, step: &Step<'_>, _: &Row) {
        let simulation = step.simulation();
        let law = simulation.traction.as_ref().and_then(|law| law.as_adhesion());
        let (Some(law), Some(bound)) = (law, step.other_traction()) else { return };
        if simulation.boundary != Boundary::Free {
            return;
        }
        let (nx, ny) = bound.dim();
        let is_line = simulation.grid.is_line();
        let ends = (0..ny).flat_map(|j| [(0, j), (nx - 1, j)]);
        let sides = (0..nx).filter(|_| !is_line).flat_map(|i| [(i, 0), (i, ny - 1)]);
        let largest = ends.chain(sides).map(|cell| -bound[cell]).fold(0.0, f64::max) / law.strength();
        self.0.above(step.index(), largest, CUT);
    }

    fn findings(&self, _: &Simulation) -> Vec<Finding> {
        let cut = self.0.warning(ADHESION_AT_BORDER, |cut| {
            format!(
                "In {} the attraction at the border of the free domain is {} of its largest value, more than {CUT}: the attraction beyond the \
                 border is missing. Enlarge the domain, or take a law or a range that falls faster.",
                cut.which_rows(),
                digits(cut.value)
            )
        });
        cut.into_iter().collect()
    }

    fn resume(&mut self, finding: &Finding) {
        self.0.resume(ADHESION_AT_BORDER, finding);
    }
}
