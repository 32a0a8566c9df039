//! Adhesion: cells that snap one by one, laws that converge slowly, attraction beyond the border.

use super::words::{digits, rows, si};
use super::{ADHESION_AT_BORDER, ADHESION_UNRESOLVED, Finding};
use crate::grid::Boundary;
use crate::simulation::Simulation;
use crate::step::Step;
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
#[derive(Clone, Debug, Default)]
pub(super) struct Border {
    /// The largest share of the strength, and the rows in which it is too large.
    worst: f64,
    at: Option<[usize; 2]>,
}

impl Border {
    pub(super) fn see(&mut self, step: &Step<'_>) {
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
        if largest > CUT {
            self.worst = self.worst.max(largest);
            let index = step.index();
            self.at = Some([self.at.map_or(index, |at| at[0]), index]);
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let at = self.at?;
        let text = format!(
            "In {} the attraction at the border of the free domain is {} of its largest value, more than {CUT}: the attraction beyond the \
             border is missing. Enlarge the domain, or take a law or a range that falls faster.",
            rows(at),
            digits(self.worst)
        );
        Some(Finding::warning(ADHESION_AT_BORDER, self.worst, CUT, text).at(at))
    }

    /// Takes over the finding of an earlier session.
    pub(super) fn resume(&mut self, finding: &Finding) {
        self.worst = finding.value.unwrap_or(0.0);
        self.at = finding.rows;
    }
}
