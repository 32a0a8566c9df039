//! The memory of the bodies: one field of relaxing displacements q_i for each relaxation time.
//!
//! ```text
//! τ_i dq_i/dt + q_i = u,      U = Kp = E_inf u + Σ E_i (u - q_i) + ζ du/dt
//! ```
//!
//! Over a step u runs linearly in time under approach control, and linearly in L = ∫ C dW under load control
//! (see [`shape`]). Then u_(n+1) = c U_(n+1) + g with a number c and a field g that are known before the solve
//! (see [`rules`]): positive and monotone for every spectrum and every length of the step, and exact for a held
//! approach, a held load and a growing contact. The load W itself is one more cell, whose u is L.
//!
//! Without pressure the strains e_j of the creep form fade each by itself, so that any time without contact is one
//! step: the states stay as they are when contact is lost, and are brought up to date when pressure comes back.
//!
//! The update of the last step and the g of the next are one sweep, which reads and writes each branch once. Until then
//! the step can be taken again at another length.

pub(super) mod branches;
mod energy;
mod estimate;
pub(super) mod load_cell;
mod pair;
mod response;
pub(super) mod rules;
pub(super) mod shape;
mod survey;
mod total_error;

pub(super) use estimate::{FLOOR, LATE, ROUNDING, growing, remembered_defect, soon};

use branches::{Branches, Combination, Ending};
use energy::{Products, transition};
use estimate::Survey;
use load_cell::LoadCell;
use pair::Pair;
use rules::{Driver, Rules};
use total_error::TotalError;

use super::clocks::Clocks;
use super::{Ends, Exchange, History, Law, ThirdState, third_state};
use crate::contact::ContactState;
use crate::error::Result;
use crate::material::Dual;
use crate::simulation::Simulation;
use crate::step::{Interval, Load, Loader, Piece, Saved, Saver, saved};
use asperity_sweep::zeros;

/// The memory of a pair of bodies as branches that relax.
pub(crate) struct Relaxation {
    clocks: Clocks,
    pair: Pair,
    /// How fast the clocks go, over the fastest; the pair as one material at these rates.
    rates: Vec<f64>,
    dual: Dual,
    /// q_i and u at the start of the step under way; no u where nothing remembers.
    states: Branches,
    displacement: Vec<f64>,
    /// u of a third instant, where the error of steps is estimated.
    third: Vec<f64>,
    reference: Option<Reference>,
    /// Time from the last kink of the course to the start of the step under way, on the fastest clock.
    since_kink: f64,
    /// How far the clocks have gone without pressure since the states were those of the cells.
    gone: Vec<f64>,
    cell: LoadCell,
    under_way: UnderWay,
    rules: Rules,
    /// How far the clocks go in the step under way.
    elapsed: Vec<f64>,
    /// The rules of the next step, while the last one ends.
    next: Rules,
    left: Vec<f64>,
    /// The account of the energy, where it is kept.
    products: Option<Products>,
    /// That of the solver.
    tolerance: f64,
    cell_area: f64,
    is_line: bool,
    /// Whether displacements are known up to a constant only: then the approach is taken off them.
    is_relative: bool,
    /// The approach at the start of the step under way \[m\], and L.
    started_at: [f64; 2],
    /// Of the step that was solved last, and the error of all steps.
    survey: Survey,
    total_error: TotalError,
}

/// The step whose end is not yet in the states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum UnderWay {
    Nothing,
    Contact,
    Apart,
}

/// When the third state is, seen from the start of the step under way: before it (a negative length), or after it; and
/// how u ran in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reference {
    pub(crate) length: f64,
    pub(crate) driver: Driver,
    /// Its approach \[m\], and L.
    pub(crate) approach: f64,
    pub(crate) driven: f64,
}

impl Relaxation {
    /// At rest.
    pub(super) fn new(simulation: &Simulation) -> Result<Self> {
        let pair = Pair::new(simulation);
        let rates = vec![1.0; pair.count()];
        let dual = Dual::of(pair.creep(&rates))?;
        let (count, cells) = (dual.states(), simulation.grid.len());
        let elastic = count == 0 && dual.relaxation.viscosity == 0.0;
        Ok(Relaxation {
            clocks: Clocks::new(simulation),
            gone: vec![0.0; pair.count()],
            elapsed: vec![0.0; pair.count()],
            rates,
            states: Branches::new(count, cells),
            displacement: zeros(if elastic { 0 } else { cells }),
            third: zeros(if elastic { 0 } else { cells }),
            reference: None,
            since_kink: 0.0,
            cell: LoadCell::at_rest(&dual),
            under_way: UnderWay::Nothing,
            rules: Rules::new(count),
            next: Rules::new(count),
            left: Vec::with_capacity(dual.strains()),
            products: None,
            tolerance: simulation.solver.tolerance,
            cell_area: simulation.grid.cell_area(),
            is_line: simulation.grid.is_line(),
            is_relative: simulation.is_up_to_a_constant(),
            started_at: [0.0; 2],
            survey: Survey::default(),
            total_error: TotalError::new(count),
            pair,
            dual,
        })
    }

    /// Whether nothing is remembered.
    fn is_elastic(&self) -> bool {
        self.displacement.is_empty()
    }

    /// Sets the rules of the step measured last, which starts from the states.
    fn plan(&mut self, load: Load) {
        let lengths = &self.clocks.lengths;
        let x = self.pair.length(lengths);
        self.elapsed.iter_mut().zip(self.pair.own(lengths)).for_each(|(e, x)| *e = x);
        if load == Load::Apart {
            self.under_way = UnderWay::Apart;
            let rows = self.recovery();
            self.next.set(&self.dual, x, Driver::Time, &self.cell.shape);
            self.next.set_apart(&rows[rows.len() - 1]);
            return;
        }
        self.under_way = UnderWay::Contact;
        if self.gone.iter().any(|gone| *gone > 0.0) {
            self.recast(None);
        }
        let load = if let Load::Total(load) = load { Some(load) } else { None };
        let driver = self.cell.driver(&self.dual, load, x);
        self.next.set(&self.dual, x, driver, &self.cell.shape);
    }

    /// Weights of (q, u) in the states, and last in the displacement, that are left when the step without pressure ends.
    fn recovery(&self) -> Vec<Vec<f64>> {
        let gone: Vec<f64> = self.gone.iter().zip(&self.elapsed).map(|(gone, x)| gone + x).collect();
        self.transition(&self.dual, &gone)
    }

    /// Ends the last step with the state `last`, and finds the gap of the planned one where it is wanted, from the rigid one.
    fn end(&mut self, last: &ContactState, next: Option<(&[f64], &mut [f64])>) {
        let next = next.map(|(rigid, gap)| (self.next.recalled(), rigid, gap));
        self.states.end(
            self.rules.ending(),
            &last.unit_displacement,
            &self.displacement,
            &mut self.third,
            next,
        );
        std::mem::swap(&mut self.displacement, &mut self.third);
    }

    /// What becomes of (q, u) without pressure while the clocks go so far, with the states of `new` after it.
    fn transition(&self, new: &Dual, gone: &[f64]) -> Vec<Vec<f64>> {
        let mut left = vec![];
        self.pair.fading(gone, &mut left);
        transition(&self.dual, new, &left)
    }

    /// Brings the states up to date after a time without pressure, and makes them those of another pair of rates.
    fn recast(&mut self, dual: Option<Dual>) {
        let new = dual.as_ref().unwrap_or(&self.dual);
        let mut rows = self.transition(new, &self.gone);
        if self.gone.iter().all(|gone| *gone == 0.0) {
            rows.pop();
        }
        self.states.recast(&rows, &mut self.displacement);
        // The load as a cell is up to date already.
        self.dual.to_strains(&self.cell.start.states, self.cell.start.driver, &mut self.cell.strains);
        new.to_states(&self.cell.strains, &mut self.cell.start.states);
        self.gone.fill(0.0);
        if let Some(dual) = dual {
            self.dual = dual;
        }
    }

    /// `gap` = `rigid` + g of some rules.
    fn recall(&self, rules: &Rules, rigid: Option<&[f64]>, gap: &mut [f64]) {
        match rigid {
            _ if !self.is_elastic() => self.states.combine(rules.recalled(), &self.displacement, rigid, gap),
            Some(_) if gap.is_empty() => {}
            Some(rigid) => gap.copy_from_slice(rigid),
            None => gap.fill(0.0),
        }
    }
}

saved! {
    Relaxation {
        "under_way": under_way;
        "since_kink": since_kink;
        "rates": rates;
        "gone": gone;
        "elapsed": elapsed;
        "rules": rules;
        "error_left": total_error.left, total_error.left_alone, total_error.left_peak;
        "started_at": started_at;
        "solver_left": total_error.solver;
    }
}

impl Saved for UnderWay {
    fn save(&self, to: &mut Vec<f64>) {
        to.push(*self as u8 as f64);
    }
    fn load(&mut self, from: &mut std::slice::Iter<'_, f64>) -> Option<()> {
        let all = [UnderWay::Nothing, UnderWay::Contact, UnderWay::Apart];
        *self = *all.get(*from.next()? as usize)?;
        Some(())
    }
}

impl History for Relaxation {
    fn open(&mut self, step: &Interval, last: &ContactState, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        self.clocks.measure(step);
        self.cell.begin();
        self.since_kink = if step.is_smooth { self.since_kink + self.rules.length } else { 0.0 };
        let ends = self.under_way == UnderWay::Contact && !self.is_elastic();
        let start = [last.approach, self.cell.start.driver];
        let [approach, driven] = std::mem::replace(&mut self.started_at, start);
        let before = Reference { length: -self.rules.length, driver: self.rules.driver, approach, driven };
        self.reference = (ends && step.is_smooth).then_some(before);
        if self.under_way == UnderWay::Apart {
            self.gone.iter_mut().zip(&self.elapsed).for_each(|(gone, x)| *gone += x);
        }
        self.under_way = UnderWay::Nothing;
        let new_rates = self.pair.set_rates(&self.clocks.lengths, &mut self.rates);
        if new_rates {
            if ends {
                self.end(last, None);
            }
            self.recast(Some(Dual::of(self.pair.creep(&self.rates))?));
        }
        self.plan(step.load);
        if ends && !new_rates {
            self.end(last, Some((rigid, gap)));
        } else {
            self.recall(&self.next, Some(rigid), gap);
        }
        std::mem::swap(&mut self.rules, &mut self.next);
        Ok(Law::of(self.rules.compliance))
    }

    fn reopen(&mut self, step: &Interval, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        self.clocks.measure(step);
        if self.pair.set_rates(&self.clocks.lengths, &mut self.rates) {
            self.recast(Some(Dual::of(self.pair.creep(&self.rates))?));
        }
        self.plan(step.load);
        std::mem::swap(&mut self.rules, &mut self.next);
        self.recall(&self.rules, Some(rigid), gap);
        Ok(Law::of(self.rules.compliance))
    }

    fn time_error(&self) -> Option<f64> {
        Some(self.total_error.value)
    }

    /// The load as a cell goes on to the end of the step.
    fn close(&mut self, ends: &Ends<'_>) {
        self.add_error();
        let rules = Some(&self.rules).filter(|_| self.under_way == UnderWay::Contact);
        self.cell.close(ends.loads[1], rules);
        if self.under_way == UnderWay::Apart {
            let LoadCell { start, end, strains, .. } = &mut self.cell;
            self.dual.to_strains(&start.states, start.driver, strains);
            self.pair.fading(&self.elapsed, &mut self.left);
            strains.iter_mut().zip(&self.left).for_each(|(e, left)| *e *= left);
            self.dual.to_states(strains, &mut end.states);
            end.driver = strains.iter().sum();
        }
    }

    fn remembers(&self) -> bool {
        !self.is_elastic()
    }

    fn recalled(&self, g: &mut [f64]) {
        self.recall(&self.rules, None, g);
    }

    fn recovers_in_one_step(&self) -> bool {
        true
    }

    fn third_state(&self, step: &Interval) -> Option<ThirdState> {
        let in_contact = self.under_way == UnderWay::Contact;
        third_state(step, in_contact, self.rules.length).filter(|_| !self.is_elastic())
    }

    fn keep_as_third(&mut self, ends: &Ends<'_>) {
        self.keep(ends);
    }

    fn error(&mut self, step: &Interval, ends: &Ends<'_>) -> Option<f64> {
        if !self.is_elastic() {
            self.survey = self.survey(ends);
        }
        let error = if step.instant.jump { 0.0 } else { self.estimate(&self.survey) };
        self.total_error.adaptive = step.is_adaptive.then_some(error);
        Some(error)
    }

    fn first_step(&mut self, piece: &Piece) -> Option<f64> {
        Some(self.longest_first_step(piece))
    }

    fn track_energy(&mut self) -> bool {
        self.products = Some(Products::at_rest(&self.rates, &self.dual));
        true
    }

    fn exchange(&mut self, ends: &Ends<'_>) -> Option<Exchange> {
        let mut products = self.products.take()?;
        let exchange = self.exchanged(&mut products, ends);
        self.products = Some(products);
        Some(exchange)
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>) {
        self.save_own(to);
        self.cell.save_own(to);
        if let Some(products) = &self.products {
            to.value("energy_products", &products.list);
        }
        self.states.save(to, "state");
        if !self.is_elastic() {
            to.field("displacement", &self.displacement);
        }
    }

    fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        self.load_own(from)?;
        self.cell.load_own(from)?;
        self.dual = Dual::of(self.pair.creep(&self.rates))?;
        if let Some(products) = &mut self.products {
            (products.rates, products.dual) = (self.rates.clone(), self.dual.clone());
            from.values_into("energy_products", &mut [&mut products.list])?;
        }
        self.states.load(from, "state")?;
        if !self.is_elastic() {
            from.field_into("displacement", &mut self.displacement)?;
        }
        Ok(())
    }
}
