//! A fluid that acts on the surfaces: films, held access, slow squeezing, what it acts on.

use super::plausible::unlikely_liquid;
use super::words::{digits, si};
use super::worst::{Watch, Worst};
use super::{
    FLUID_ACTS_ON_DOMAIN, FLUID_APPROACH_HELD, FLUID_CHATTER, FLUID_LIFTS, FLUID_MAY_RUN_AWAY, Finding,
    POCKET_TENSION, SQUEEZE_SLOW,
};
use crate::grid::Boundary;
use crate::load::{Control, Course};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Row, Step};
use crate::traction::FluidPressure;

/// Share of the drop of the fluid's pressure that its squeezing out may take.
const SQUEEZE_SHARE: f64 = 0.1;
/// Share of the volume of the gap that may be vapour.
const VAPOUR_SHARE: f64 = 1e-6;

/// What is known before the run.
pub(super) fn before(simulation: &Simulation) -> Vec<Finding> {
    let Some(fluid) = simulation.traction.as_ref().and_then(|law| law.as_fluid()) else { return vec![] };
    let Simulation { grid, boundary, loading, .. } = simulation;
    let is_held = loading.stages.iter().any(|stage| stage.control == Control::Approach);
    let mut found = vec![];
    if *boundary == Boundary::Free {
        let text = format!(
            "On a free domain the fluid acts on all of its cells, {}, and nowhere beyond: its force grows with the domain. Make the domain as \
             large as the part that the fluid wets.",
            si(grid.area(), grid.units("m2"))
        );
        found.push(Finding::warning(FLUID_ACTS_ON_DOMAIN, grid.area(), f64::NAN, text).as_note());
    } else if is_held && simulation.kernel.uniform().is_none() {
        let text = "On a periodic domain the approach fixes the mean gap: the fluid moves gap from one place to another, but cannot open \
                    the contact as a whole. Prescribe the load to see it open."
            .to_owned();
        found.push(Finding::warning(FLUID_APPROACH_HELD, f64::NAN, f64::NAN, text));
    }
    found.extend(runaway(simulation, fluid));
    found.extend(fluid.bulk_modulus.and_then(unlikely_liquid));
    found
}

/// Whether a film on a periodic domain could no longer hold the load.
fn runaway(simulation: &Simulation, fluid: &FluidPressure) -> Option<Finding> {
    let [stage] = &simulation.loading.stages[..] else { return None };
    let Course::Given(history) = &stage.course else { return None };
    let area = match stage.control {
        Control::Load => simulation.grid.area(),
        Control::Pressure => 1.0,
        Control::Approach => return None,
    };
    let mean = |time: f64| history.after(time) / area;
    let excess = |time: &f64| fluid.inlet.after(*time) - fluid.lift_off(mean(*time));
    let times = simulation.plan().instants.into_iter().map(|instant| instant.time);
    let presses = |time: &f64| fluid.inlet.after(*time) > fluid.reference;
    let worst = times.filter(presses).max_by(|a, b| excess(a).total_cmp(&excess(b)))?;
    let [inlet, lifts] = [fluid.inlet.after(worst), fluid.lift_off(mean(worst))];
    let text = || {
        format!(
            "At t = {} the inlet has {}, and under the mean pressure of {} no film holds {} or more: a fluid that gets in lifts the surfaces \
             without limit, and the run ends there. Raise the load, or lower the pressure.",
            si(worst, "s"),
            si(inlet, "Pa"),
            si(mean(worst), "Pa"),
            si(lifts, "Pa"),
        )
    };
    let periodic = simulation.boundary == Boundary::Periodic && inlet >= lifts;
    periodic.then(|| Finding::warning(FLUID_MAY_RUN_AWAY, inlet, lifts, text()))
}

/// What the rows say.
#[derive(Default)]
pub(super) struct Wet {
    films: Worst,
    held: Worst,
    /// Spread of the leak in the worst of these rows.
    spread: f64,
    squeezed: Worst,
    /// Vapour in sealed pockets, over the volume of the gap.
    vapour: Worst,
    /// Of the row before \[m\].
    mean_gap: Option<f64>,
}

impl Watch for Wet {
    fn see(&mut self, step: &Step<'_>, row: &Row) {
        let simulation = step.simulation();
        let Some(law) = simulation.traction.as_ref().and_then(|law| law.as_fluid()) else { return };
        let of = |quantity| step.of_process(quantity).unwrap_or(0.0);
        let index = step.index();
        if row.load > 0.0 {
            self.films.above(index, of(Quantity::Film), 0.0);
        }
        let held = of(Quantity::LatchedCells);
        if self.held.above(index, held, 0.5) && self.held.value == held {
            self.spread = self.spread.max(of(Quantity::LeakSpread));
        }
        let share = of(Quantity::PocketVapour) / (row.mean_gap * simulation.grid.area());
        self.vapour.above(index, share, VAPOUR_SHARE);
        // Pressure that drives the fluid out of the closing gap of parallel plates, against that of the fluid.
        let before = self.mean_gap.replace(row.mean_gap);
        let length = simulation.grid.size().into_iter().fold(0.0, f64::max);
        if let (Some(before), Some(instant)) = (before, step.instant().filter(|instant| instant.dt > 0.0)) {
            let rate = (row.mean_gap - before) / instant.dt;
            let squeeze = 12.0 * law.viscosity * rate.abs() * (length / row.mean_gap).powi(2) / row.mean_gap;
            let pressure = of(Quantity::InletPressure) - law.outlet;
            if squeeze.is_finite() && of(Quantity::Connected) == 1.0 {
                self.squeezed.above(index, squeeze, SQUEEZE_SHARE * pressure);
            }
        }
    }

    fn findings(&self, _: &Simulation) -> Vec<Finding> {
        let films = self.films.warning(FLUID_LIFTS, |films| {
            format!(
                "In {} the fluid carries all of the load in a film without contact: the seal is lifted. Raise the load, or lower the \
                 pressure.",
                films.which_rows()
            )
        });
        let chatter = self.held.warning(FLUID_CHATTER, |worst| {
            format!(
                "In the solver's loop the access of {} cells to the fluid changed again and again{}: it has no steady state, or several. They \
                 were held. {}A finer grid may help.",
                digits(worst.value),
                worst.place(),
                if self.spread > 0.0 {
                    format!("The conductances of the last passes differ by {} of the largest. ", digits(self.spread))
                } else {
                    String::new()
                }
            )
        });
        let squeezed = self.squeezed.warning(SQUEEZE_SLOW, |worst| {
            format!(
                "The gap changes so fast that moving the fluid takes a pressure of about {}{}, more than {SQUEEZE_SHARE} of the drop from \
                 inlet to outlet. The flow is taken as steady: the fluid would delay the motion. Take slower loads, or a fluid of less viscosity.",
                si(worst.value, "Pa"),
                worst.place(),
            )
        });
        let tension = self.vapour.warning(POCKET_TENSION, |worst| {
            format!(
                "Sealed pockets have more room than their liquid fills, by {} of the volume of the gap{}: it would be in tension. Its pressure is taken as 0, that of \
                 a vacuum, the rest as vapour; a liquid may hold tension for a while, or give off gas before. Where it should not be so, raise the \
                 pressure in which the surfaces are brought together, or unload them less.",
                digits(worst.value),
                worst.place(),
            )
        });
        [films, chatter, tension, squeezed].into_iter().flatten().collect()
    }

    fn recall(&mut self, last: &Row) {
        self.mean_gap = Some(last.mean_gap);
    }

    fn resume(&mut self, finding: &Finding) {
        self.films.resume(FLUID_LIFTS, finding);
        self.held.resume(FLUID_CHATTER, finding);
        self.squeezed.resume(SQUEEZE_SLOW, finding);
        self.vapour.resume(POCKET_TENSION, finding);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ndarray::Array2;

    use super::*;
    use crate::grid::Grid;
    use crate::leakage::{Direction, Sides};
    use crate::load::{History, Loading};
    use crate::traction::{Action, Pockets};

    #[test]
    fn a_gap_that_closed_too_fast_is_told_after_the_run_was_resumed() {
        let grid = Grid::new([8, 8], [2.0, 2.0]).unwrap();
        let simulation = Simulation::new(grid, Array2::zeros(grid.shape()));
        let mut watch = Wet::default();
        watch.recall(&Row { mean_gap: 0.5, ..Row::default() });
        watch.resume(&Finding::warning(SQUEEZE_SLOW, 8.0, 2.0, String::new()).at(Some([3, 4])));
        // The next row is compared with the last one of the session before.
        assert_eq!(watch.mean_gap, Some(0.5));
        let [finding] = &watch.findings(&simulation)[..] else { panic!() };
        assert_eq!(
            (finding.code.as_ref(), finding.value, finding.rows),
            (SQUEEZE_SLOW, Some(8.0), Some([3, 4]))
        );
        // A smaller value keeps the worst one, and is one of its rows.
        assert!(watch.squeezed.above(6, 3.0, 2.0));
        let [finding] = &watch.findings(&simulation)[..] else { panic!() };
        assert_eq!((finding.value, finding.rows), (Some(8.0), Some([3, 6])));
    }

    #[test]
    fn a_fluid_may_run_away_from_twice_the_mean_pressure_on() {
        let codes = |action: Action, control: Control, inlet: f64, outlet: f64, boundary: Boundary| {
            let points = vec![(0.0, outlet), (0.5, inlet), (1.0, outlet)];
            let fluid = FluidPressure {
                inlet: History::Table { points },
                outlet,
                reference: 1.0,
                gas: None,
                viscosity: 1.0,
                direction: Direction::X,
                sides: Sides::Periodic,
                smallest_gap: 0.0,
                action,
                bulk_modulus: None,
            };
            let grid = Grid::new([8, 8], [2.0, 2.0]).unwrap();
            // A mean pressure of 3.
            let value = if control == Control::Load { 12.0 } else { 3.0 };
            let found = before(&Simulation {
                boundary,
                loading: Loading { control, history: History::Step { value } }.into(),
                times: crate::TimeGrid::Uniform { end: 1.0, steps: 4 },
                traction: Some(Arc::new(fluid)),
                ..Simulation::new(grid, Array2::zeros(grid.shape()))
            });
            found.iter().any(|finding| finding.code == FLUID_MAY_RUN_AWAY)
        };
        let (gaps, periodic) = (Action::Gaps(Pockets::Kept), Boundary::Periodic);
        for control in [Control::Load, Control::Pressure] {
            // Above the reference: 5.9 and 0 are held, 6 and 0, or 4 and 2, are not.
            assert!(!codes(gaps, control, 6.9, 1.0, periodic));
            assert!(codes(gaps, control, 7.0, 1.0, periodic) && codes(gaps, control, 5.0, 3.0, periodic));
            assert!(codes(Action::Everywhere, control, 4.0, 1.0, periodic));
            assert!(!codes(Action::Everywhere, control, 3.9, 1.0, periodic));
        }
        assert!(!codes(gaps, Control::Approach, 9.0, 1.0, periodic));
        assert!(!codes(gaps, Control::Load, 9.0, 1.0, Boundary::Free));
    }
}
