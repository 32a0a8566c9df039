//! What a solve starts from, and how a pressure is made feasible: within its bounds and with its load.

use super::projection::Trial;
use super::search::Search;
use super::sweeps::feasible::Clip;
use super::{ContactState, Hardness, Problem, ProjectedCg};
use crate::error::{Error, Result};
use asperity_sweep::{Set, SetMut, each, each_with_sums, run, sums};

/// What is known of the state that a solve starts from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    /// The pressure is a guess: it is made feasible, and its displacement computed.
    Pressure,
    /// U = K p is known too, with the rounding error that the state tells, and the pressure has the load. Where it is not
    /// `feasible`, the solver takes one step onto the bounds before it iterates.
    Displacement { feasible: bool },
}

impl ProjectedCg {
    /// Gives a search a feasible state whose U is known.
    pub(super) fn start(&mut self, start: Start, search: &mut Search) -> Result<()> {
        // Fields hold what an earlier solve left: the first kernels overwrite all of it.
        self.working.fill(u8::MAX);
        self.working_old.fill(u8::MAX);
        match start {
            // A contact that moves may take cells with it that cannot touch any more.
            Start::Displacement { feasible }
                if !presses_on_nothing(search.problem, search.state)
                    && (feasible || self.step_onto_bounds(search)) => {}
            _ => {
                let cell_area = search.operator.grid().cell_area();
                make_feasible(search.problem, cell_area, search.state, &mut self.working)?;
                self.working.fill(u8::MAX);
                search.convolve();
            }
        }
        Ok(())
    }

    /// One step from a pressure outside its bounds, taken whole, which makes it feasible; false where there is none.
    fn step_onto_bounds(&mut self, search: &mut Search) -> bool {
        let report = self.residual_report(search);
        let Some(step) = self.conjugate_step(search, &report) else { return false };
        self.find_step(search, step);
        self.convolve_step(search);
        self.advance(search, step, 1.0);
        true
    }
}

/// Whether a cell that cannot touch has a pressure.
fn presses_on_nothing(problem: &Problem, state: &ContactState) -> bool {
    let of_cell = |p: f64, h: f64| f64::from(u8::from(p != 0.0 && h == f64::INFINITY));
    let [cells] = sums((&state.pressure[..], problem.gap), |(p, h)| [of_cell(p, h)]);
    cells > 0.0
}

/// Makes `state.pressure` feasible: zero where nothing can touch, within \[0, H\], with the load W. A pressure of zero
/// everywhere becomes uniform.
///
/// `touchable` comes back as the set of cells that can touch.
pub(super) fn make_feasible(
    problem: &Problem,
    cell_area: f64,
    state: &mut ContactState,
    touchable: &mut [u8],
) -> Result<()> {
    let Problem { gap, hardness, .. } = *problem;
    let p = &mut state.pressure;
    let [sum, cells] = run(Clip { p, gap, touchable: SetMut(touchable), hardness });
    let Some(target) = problem.sum(cell_area) else {
        return Ok(());
    };
    if sum <= 0.0 {
        let uniform = target / cells;
        each(&mut state.pressure, (Set(touchable), hardness), |p, (on, hardness)| {
            *p = if on { uniform.min(hardness) } else { 0.0 };
        });
        // Soft cells of a mixed surface carry less.
        if matches!(hardness, Hardness::Uniform(_)) {
            return Ok(());
        }
    }
    set_sum(&mut state.pressure, touchable, hardness, target).ok_or_else(|| Error::Infeasible {
        parameter: String::new(),
        load: target * cell_area,
        max: problem.extent().largest_sum * cell_area,
    })
}

/// Gives a pressure within \[0, H\] the sum `target`: by scaling the cells below H, which keeps open
/// cells open; where those cannot carry it, by a shift of all cells of `set`. `None` where neither does it.
pub(super) fn set_sum(p: &mut [f64], set: &[u8], hardness: Hardness, target: f64) -> Option<()> {
    for _ in 0..50 {
        let [below, capped] = sums((&*p, hardness), |(p, most)| if p < most { [p, 0.0] } else { [0.0, p] });
        let rest = target - capped;
        if below <= 0.0 || rest <= 0.0 {
            break;
        }
        let [beyond] = each_with_sums(p, hardness, |p, most| {
            let scaled = if *p < most { *p * (rest / below) } else { *p };
            *p = scaled.min(most);
            [f64::from(u8::from(most < scaled))]
        });
        if beyond == 0.0 {
            return Some(());
        }
    }
    let trial = Trial { pressure: p, direction: None, set, length: 0.0, hardness };
    let shift = trial.shift_to_sum(target, trial.clipped_sum(0.0))?;
    each(p, (Set(set), hardness), |p, (on, most)| *p = if on { shift.project_cell(*p, most) } else { 0.0 });
    Some(())
}
