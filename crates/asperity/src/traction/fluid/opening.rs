//! The pressure of the inlet at which a contact opens under the load that it carries.
//!
//! Without flow more pressure never closes a gap: from the dry contact on, each pass wets cells and lets none dry,
//!
//! ```text
//! g = contact of c K, h' + c K b, load W/A - sum b;   b <- max(b, B(g)),   B of inlet, outlet, and of drained pockets
//! ```
//!
//! up to the least state that the pressures allow, or until inlet and outlet are connected. So there is one pressure below which the
//! contact holds and above which it opens; it is enclosed by bisection, each trial from the state of the largest pressure that
//! holds. The edge of a wetted part holds a little more on coarse cells than it should, which falls with their square root. The bodies respond as they do to a sudden change, by the compliance c = C(0+): h' = g - c K t + w of the state at hand holds
//! what they remember.

use std::sync::atomic::AtomicBool;

use ndarray::ArrayView2;

use super::{Action, FluidPressure, InGap, Pockets, SMALL, TOLERANCES};
use crate::contact::{ContactState, Hardness, Prescribed, Problem, Solver, SolverOptions, stop_at};
use crate::error::{Error, NotConverged, Result, require};
use crate::operator::{Operator, plan};
use crate::simulation::{Plasticity, Simulation};
use crate::traction::{SurfaceTraction, Tractions};
use asperity_sweep::{each, sum, zeros};

/// The pressure is known to this share of itself above that of the outlet.
const SHARE: f64 = 1e-3;

/// Finds the opening pressures of the states of a run.
pub struct OpeningPressure {
    fluid: InGap,
    operator: Box<dyn Operator>,
    solver: Solver,
    options: SolverOptions,
    /// C(0+) \[1/Pa\].
    compliance: f64,
    /// Cut-off of the pressure \[Pa\], the least of all cells, and of each where it is finite.
    hardness: f64,
    hardness_of_cells: Option<Vec<f64>>,
    /// h', the same with c K b, K b, g, B and the cut-off of q.
    undeformed: Vec<f64>,
    shifted: Vec<f64>,
    image: Vec<f64>,
    gap: Vec<f64>,
    next: Vec<f64>,
    cap: Vec<f64>,
    /// The state of the largest pressure that holds, and that of the trial.
    held: Tractions,
    trial: Tractions,
}

impl OpeningPressure {
    /// Of a fluid, whose inlet may have any pressure, between the surfaces of a simulation.
    ///
    /// # Errors
    /// As of [`check`](Self::check); where the operator cannot be planned.
    pub fn new(fluid: FluidPressure, simulation: &Simulation) -> Result<Self> {
        Self::check(simulation)?;
        let grid = simulation.grid;
        let operator = plan(grid, simulation.boundary, simulation.kernel.clone())?;
        let [hardness, _] = simulation.hardness_range();
        let field = || zeros(grid.len());
        let tolerance = (TOLERANCES[1] * simulation.solver.tolerance).max(1e-14);
        Ok(OpeningPressure {
            fluid: InGap::new(FluidPressure { action: Action::Gaps(Pockets::Drained), ..fluid }, &grid),
            solver: Solver::new(simulation.solver.method, &*operator),
            operator,
            options: SolverOptions { tolerance, ..simulation.solver },
            compliance: simulation.instantaneous(),
            hardness_of_cells: hardness
                .is_finite()
                .then(|| simulation.hardness_of_cells().unwrap_or_else(|| vec![hardness; grid.len()])),
            hardness,
            undeformed: field(),
            shifted: field(),
            image: field(),
            gap: field(),
            next: field(),
            cap: field(),
            held: Tractions::none(grid.len()),
            trial: Tractions::none(grid.len()),
        })
    }

    /// Whether the opening pressure of a simulation can be computed.
    ///
    /// # Errors
    /// [`Error::Invalid`] with what stands against it; its parameter is a key of the case.
    pub fn check(simulation: &Simulation) -> Result<()> {
        let attracts = simulation.traction.as_ref().is_some_and(|law| law.as_adhesion().is_some());
        let (value, expected) = if attracts {
            ("of surfaces that adhere", "none: the attraction changes as they open")
        } else if simulation.motion.is_some() {
            ("of a contact in motion", "none: the flow that a moving surface drags along is not solved")
        } else if simulation.layers.is_some() {
            ("of layers that creep differently", "none, or layers and bodies of the same relative creep")
        } else if simulation.plasticity == Plasticity::Accumulate {
            ("of surfaces whose dents stay", "none, or plasticity = \"cap\"")
        } else if simulation.instantaneous() <= 0.0 {
            (
                "of bodies that do not yield at once",
                "a material that does: it is the answer to a sudden rise of the pressure",
            )
        } else if simulation.gap.iter().any(|h| !h.is_finite()) {
            ("of a gap with holes", "a gap that is finite: fluid acts on all of the domain")
        } else {
            return Ok(());
        };
        Err(Error::invalid("opening pressure", value, expected).of("leakage.opening"))
    }

    /// Memory that it takes \[bytes\], besides the operator and the solver.
    pub fn bytes(cells: usize) -> f64 {
        // Its fields, two states, and those of the fluid.
        40.0 * 8.0 * cells as f64
    }

    /// The pressure of the inlet \[Pa, absolute\] up to which a state holds: with a gap g \[m\] under a total traction t \[Pa\], at an
    /// approach \[m\] under a load \[N\] that is held. That of the outlet where inlet and outlet are connected already.
    ///
    /// # Errors
    /// Those of the contact.
    pub fn of(
        &mut self,
        gap: ArrayView2<'_, f64>,
        traction: ArrayView2<'_, f64>,
        approach: f64,
        load: f64,
        interrupt: Option<&AtomicBool>,
    ) -> Result<f64> {
        let sound = gap.len() == self.gap.len() && traction.len() == gap.len();
        require(sound, "fields of a state", gap.len(), "one number for each cell")?;
        self.take(gap, traction, approach);
        let outlet = self.fluid.law.outlet;
        let mean = load / self.operator.grid().area();
        if mean <= 0.0 || self.opens(outlet, load, interrupt)? {
            return Ok(outlet);
        }
        let (mut low, mut high) = (outlet, outlet + mean);
        // The end: the cells at the inlet alone carry the load.
        while !self.opens(high, load, interrupt)? {
            (low, high) = (high, outlet + 2.0 * (high - outlet));
        }
        while high - low > SHARE * (high - outlet) {
            let middle = 0.5 * (low + high);
            match self.opens(middle, load, interrupt)? {
                true => high = middle,
                false => low = middle,
            }
        }
        Ok(low)
    }

    /// Takes over a state: h' = g - c K t + w.
    fn take(&mut self, gap: ArrayView2<'_, f64>, traction: ArrayView2<'_, f64>, approach: f64) {
        self.held.bound.fill(0.0);
        self.held.contact = ContactState::new(self.gap.len());
        self.next.iter_mut().zip(traction).for_each(|(to, t)| *to = *t);
        self.held.contact.pressure.iter_mut().zip(&self.next).for_each(|(q, t)| *q = t.max(0.0));
        self.operator.apply_into(&self.next, &mut self.image);
        let c = self.compliance;
        let states = gap.iter().zip(&self.image);
        self.undeformed.iter_mut().zip(states).for_each(|(h, (g, u))| *h = g - c * u + approach);
    }

    /// Whether a pressure of the inlet opens the contact, connects inlet and outlet or lifts the surfaces; where it does not, its state
    /// becomes the one that holds.
    fn opens(&mut self, inlet: f64, load: f64, interrupt: Option<&AtomicBool>) -> Result<bool> {
        let most = inlet - self.fluid.law.reference;
        if most >= self.hardness {
            // No contact presses more.
            return Ok(true);
        }
        self.fluid.inlet = inlet;
        self.trial.copy_from(&self.held);
        // Each pass wets a cell, or raises the pressure at an edge.
        let passes = 10 * self.gap.len();
        for _ in 0..passes {
            stop_at(interrupt)?;
            self.fluid.begin_loop();
            if !self.touch(load, interrupt)? {
                return Ok(true);
            }
            let contact = &self.trial.contact.pressure;
            if self.fluid.passages(None, &self.gap, contact)?.1.percolates() {
                return Ok(true);
            }
            self.fluid.bound(&self.gap, contact, &mut self.next)?;
            let mut rises = false;
            for (b, next) in self.trial.bound.iter_mut().zip(&self.next) {
                if *next > *b + SMALL * most {
                    (*b, rises) = (*next, true);
                }
            }
            if !rises {
                std::mem::swap(&mut self.held, &mut self.trial);
                return Ok(false);
            }
        }
        Err(NotConverged::of("opening pressure", passes, f64::NAN, SMALL).into())
    }

    /// The contact under the traction of the trial, and its gap; `false` where the fluid leaves no load to it.
    fn touch(&mut self, load: f64, interrupt: Option<&AtomicBool>) -> Result<bool> {
        let (c, Tractions { bound, contact }) = (self.compliance, &mut self.trial);
        let carried = load - self.operator.grid().cell_area() * sum(bound);
        if carried <= 0.0 {
            return Ok(false);
        }
        self.operator.apply_into(bound, &mut self.image);
        each(&mut self.shifted, (&self.undeformed[..], &self.image[..]), |to, (h, u)| *to = h + c * u);
        let hardness = match &self.hardness_of_cells {
            None => Hardness::Uniform(f64::INFINITY),
            Some(cells) => {
                each(&mut self.cap, (&cells[..], &bound[..]), |cap, (hardness, b)| *cap = hardness - b);
                Hardness::Cells(&self.cap)
            }
        };
        let prescribed = Prescribed::Load(carried);
        let problem = Problem { gap: &self.shifted, compliance: c, hardness, prescribed };
        match self.solver.solve(&mut *self.operator, &problem, &self.options, contact, interrupt) {
            // No contact that is limited by the hardness carries the rest of the load: none holds.
            Err(Error::Infeasible { .. }) => return Ok(false),
            solved => solved?,
        };
        let (w, fields) = (contact.approach, (&self.shifted[..], &contact.unit_displacement[..]));
        each(&mut self.gap, fields, |to, (h, u)| *to = (h + c * u - w).max(0.0));
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::super::tests::{liquid, on_rough, wave};
    use super::*;
    use crate::drive::{Drive, March};
    use crate::load::{Control, History, Loading};
    use crate::material::{Creep, CreepTerm};
    use crate::quantities::Quantity;
    use crate::time::TimeGrid;

    /// The opening pressure of the last state of a run.
    fn opening(simulation: Simulation, fluid: FluidPressure) -> f64 {
        let mut opening = OpeningPressure::new(fluid, &simulation).unwrap();
        let mut march = March::new(simulation).unwrap();
        while march.advance().unwrap().is_some() {}
        let (step, row) = (march.last().unwrap(), march.last().unwrap().row());
        let mut gap = Array2::zeros(step.simulation().grid.shape());
        step.gap_into(&mut gap);
        opening.of(gap.view(), step.pressure(), row.approach, row.load, None).unwrap()
    }

    fn dry(simulation: Simulation) -> Simulation {
        let mut dry = Simulation { traction: None, ..simulation };
        dry.quantities.list.clear();
        dry
    }

    #[test]
    fn a_closed_wave_opens_where_its_valleys_press_less_than_the_fluid() {
        // In full contact the pressure is p0 - p* in the valleys, p* = 1, along which the fluid runs from the inlet. Its front holds by a cell,
        // as a tough one would: that falls with the square root of the cell, so twice the value on cells of a quarter, less the other, has
        // none of it. The pressures count from the outlet.
        for (mean, outlet) in [(1.2, 0.0), (1.4, 0.3)] {
            let [coarse, fine] = [32, 128].map(|n| {
                let fluid = FluidPressure { reference: outlet, ..liquid(outlet, outlet) };
                opening(dry(wave([n, 64], 1.0, mean, liquid(0.0, 0.0))), fluid) - outlet
            });
            let exact = mean - 1.0;
            assert!(coarse > fine && fine > exact, "{coarse} {fine}");
            // The next order is the cell: 1/128, and there are twice that of the first one.
            assert!((2.0 * fine - coarse - exact).abs() < 0.016, "{coarse} {fine}");
        }
    }

    #[test]
    fn below_it_a_rough_contact_holds_and_above_it_opens() {
        // Under loads of 1.2 and 1.6 of that which seals, elastic and after it has crept for two of its times: held, then the pressure rises
        // at once, within 1e-6 of that time.
        let seals = {
            let closed = |mean: f64| {
                let fluid = liquid(0.0, 0.0);
                opening(dry(on_rough(32, mean, None)), fluid) > 0.0
            };
            let (mut low, mut high) = (0.1, 20.0);
            while high - low > 1e-3 * high {
                let middle = 0.5 * (low + high);
                if closed(middle) { high = middle } else { low = middle }
            }
            high
        };
        let elastic = Creep::elastic(1.0);
        let terms = vec![CreepTerm { compliance: 0.5, retardation_time: 0.5 }];
        let creeps = Creep { instantaneous: 1.0, terms, fluidity: 0.0 };
        for (creep, over) in [(&elastic, 1.2), (&elastic, 1.6), (&creeps, 1.2)] {
            let mean = over * seals;
            let times = TimeGrid::Uniform { end: 1.0, steps: 4 };
            let base = dry(on_rough(32, mean, None));
            let found = opening(
                Simulation { creep: creep.clone(), times: times.clone(), ..base.clone() },
                liquid(0.0, 0.0),
            );
            // The contact presses least where it seals with nothing to spare: it opens no earlier than a contact of the mean pressure p - P.
            assert!(found > 0.98 * (mean - seals) && found < mean, "{found} {mean} {seals}");
            for (share, opens) in [(0.97, 0.0), (1.03, 1.0)] {
                let end = 1.0 + 1e-6;
                let points = vec![(0.0, 0.0), (1.0, 0.0), (end, share * found)];
                let action = Action::Gaps(Pockets::Drained);
                let fluid = FluidPressure { inlet: History::Table { points }, action, ..liquid(0.0, 0.0) };
                let wet = on_rough(32, mean, Some(fluid));
                let times = TimeGrid::List(vec![0.25, 0.5, 0.75, 1.0, end]);
                let mut march = March::new(Simulation { creep: creep.clone(), times, ..wet }).unwrap();
                while march.advance().unwrap().is_some() {}
                let connected = march.last().unwrap().quantity(Quantity::Connected).unwrap()[0];
                assert_eq!(connected, opens, "{share} of {found}, {over} {creep:?}");
            }
        }
    }

    #[test]
    fn what_is_open_opens_at_the_pressure_of_the_outlet() {
        assert_eq!(opening(dry(on_rough(32, 0.2, None)), liquid(0.3, 0.3)), 0.3);
        let loading = Loading { control: Control::Load, history: History::Step { value: 0.0 } };
        let apart = Simulation { loading: loading.into(), ..dry(on_rough(32, 0.2, None)) };
        assert_eq!(opening(apart, liquid(0.0, 0.0)), 0.0);
    }

    #[test]
    fn a_hardness_is_the_most_that_a_contact_holds() {
        let base = dry(wave([32, 64], 1.0, 1.4, liquid(0.0, 0.0)));
        // Without it the wave would hold up to 2 and what the cells add.
        let mean = Loading { control: Control::Pressure, history: History::Step { value: 3.0 } };
        let capped = Simulation { hardness: 3.5, loading: mean.into(), ..base };
        let found = opening(capped, liquid(0.0, 0.0));
        assert!(found < 3.5, "{found}");
    }

    #[test]
    fn what_it_does_not_go_with_is_named() {
        let base = dry(on_rough(32, 1.0, None));
        let delayed = Creep {
            instantaneous: 0.0,
            terms: vec![CreepTerm { compliance: 1.0, retardation_time: 1.0 }],
            fluidity: 0.0,
        };
        let faults = [
            Simulation { creep: delayed, ..base.clone() },
            Simulation { plasticity: Plasticity::Accumulate, hardness: 3.0, ..base.clone() },
        ];
        for fault in faults {
            let error = OpeningPressure::check(&fault).unwrap_err();
            assert_eq!(error.parameter(), "leakage.opening", "{error}");
        }
        assert!(OpeningPressure::check(&base).is_ok());
    }
}
