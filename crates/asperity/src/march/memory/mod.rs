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

pub(in crate::march) mod branches;
mod checkpoint;
mod clocks;
mod curvature;
mod energy;
mod estimate;
mod mean;
mod rules;
mod shape;
mod spectral;
mod waves;
mod within;

use branches::Branches;
use clocks::Clocks;
use energy::transition;
pub(in crate::march) use energy::{Exchange, Products};
use rules::{Course, Rules};
use shape::Shape;
pub(in crate::march) use spectral::Spectral;
pub use waves::check_layers;

use crate::error::Result;
use crate::march::Simulation;
use crate::material::Dual;
use asperity_sweep::zeros;

pub(in crate::march) struct Memory {
    clocks: Clocks,
    /// How fast the clocks go, over the fastest; the pair as one material at these rates.
    rates: Vec<f64>,
    dual: Dual,
    /// q_i and u at the start of the step under way; no u where nothing remembers.
    states: Branches,
    displacement: Vec<f64>,
    /// u of a third instant, where the error of steps is estimated.
    third: Vec<f64>,
    reference: Option<Reference>,
    /// How long the smooth piece of the course has lasted at the start of the step under way; none of a piece that begins.
    piece: Option<f64>,
    /// How far the clocks have gone without pressure since the states were those of the cells.
    gone: Vec<f64>,
    /// The load as a cell at the start of the step under way, and at its end.
    total: Total,
    end: Total,
    under_way: UnderWay,
    rules: Rules,
    /// How far the clocks go in the step under way.
    elapsed: Vec<f64>,
    /// The rules of the next step, while the last one ends.
    next: Rules,
    shape: Shape,
    strains: Vec<f64>,
    left: Vec<f64>,
}

/// The step whose end is not yet in the states.
#[derive(Clone, Copy, Debug, PartialEq)]
enum UnderWay {
    Nothing,
    Contact,
    Apart,
}

/// The load W, its driver L and its states.
#[derive(Clone, Debug, PartialEq)]
struct Total {
    load: f64,
    driver: f64,
    states: Vec<f64>,
}

/// When the third state is, seen from the start of the step under way: before it (a negative length), or after it; and
/// how u ran in between.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reference {
    length: f64,
    course: Course,
}

/// A step that is to be taken.
#[derive(Clone, Copy)]
pub(in crate::march) struct Interval<'a> {
    /// Its length in laboratory time and on the clock of each body with a temperature.
    pub(in crate::march) lengths: &'a [f64],
    pub(in crate::march) drive: Imposed,
}

/// What is known of a step before it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::march) enum Imposed {
    /// There is no pressure at either end.
    Apart,
    /// The approach is prescribed.
    Approach,
    /// It is that of the row before.
    Held,
    /// The load at the end.
    Load(f64),
}

/// Pressure and U = Kp at both ends of a step, the approach at its end \[m\] and how far the bodies approach in it \[m\].
#[derive(Clone, Copy)]
pub(in crate::march) struct Ends<'a> {
    pub(in crate::march) approach: f64,
    pub(in crate::march) advance: f64,
    pub(in crate::march) before: (&'a [f64], &'a [f64]),
    pub(in crate::march) now: (&'a [f64], &'a [f64]),
}

impl Total {
    fn set(&mut self, other: &Total) {
        (self.load, self.driver) = (other.load, other.driver);
        self.states.copy_from_slice(&other.states);
    }
}

impl Memory {
    /// The memory of the pair; `estimates` where the error of steps is estimated.
    pub(in crate::march) fn new(simulation: &Simulation, estimates: bool) -> Result<Self> {
        let clocks = Clocks::new(simulation);
        let rates = vec![1.0; clocks.count()];
        let dual = Dual::of(clocks.creep(&rates))?;
        let (count, cells) = (dual.states(), simulation.grid.len());
        let elastic = count == 0 && dual.relaxation.viscosity == 0.0;
        let total = Total { load: 0.0, driver: 0.0, states: vec![0.0; count] };
        Ok(Memory {
            gone: vec![0.0; clocks.count()],
            elapsed: vec![0.0; clocks.count()],
            rates,
            states: Branches::new(count, cells),
            displacement: zeros(if elastic { 0 } else { cells }),
            third: zeros(if elastic || !estimates { 0 } else { cells }),
            reference: None,
            piece: None,
            end: total.clone(),
            total,
            under_way: UnderWay::Nothing,
            rules: Rules::new(count),
            next: Rules::new(count),
            shape: Shape::new(dual.creep.terms.len()),
            strains: vec![0.0; dual.strains()],
            left: Vec::with_capacity(dual.strains()),
            clocks,
            dual,
        })
    }

    /// Whether nothing is remembered.
    pub(in crate::march) fn is_elastic(&self) -> bool {
        self.displacement.is_empty()
    }

    /// Whether the step under way has no pressure at either end.
    pub(in crate::march) fn is_apart(&self) -> bool {
        self.under_way == UnderWay::Apart
    }

    /// Whether the third state is that before the step that ended last.
    pub(in crate::march) fn has_third(&self) -> bool {
        self.reference.is_some_and(|reference| reference.length < 0.0)
    }

    /// The load at the end of the last step.
    pub(in crate::march) fn load(&self) -> f64 {
        self.end.load
    }

    /// Takes in the end of the step before, where `unit` = U; writes `gap` = `rigid` + g for the next one; returns c.
    pub(in crate::march) fn begin(
        &mut self,
        step: Interval<'_>,
        unit: &[f64],
        rigid: &[f64],
        gap: &mut [f64],
    ) -> Result<f64> {
        self.total.set(&self.end);
        self.piece = Some(self.piece.map_or(0.0, |lasted| lasted + self.rules.length));
        let ends = self.under_way == UnderWay::Contact;
        self.reference = ends.then(|| Reference { length: -self.rules.length, course: self.rules.course });
        if self.under_way == UnderWay::Apart {
            self.gone.iter_mut().zip(&self.elapsed).for_each(|(gone, x)| *gone += x);
        }
        self.under_way = UnderWay::Nothing;
        let new_rates = self.clocks.set_rates(step.lengths, &mut self.rates);
        if self.is_elastic() {
            self.plan(step);
            gap.copy_from_slice(rigid);
        } else if ends && !new_rates {
            self.plan(step);
            let third = Some(&mut self.third[..]).filter(|third| !third.is_empty());
            let next = Some((self.next.recalled(), rigid, gap));
            self.states.end(self.rules.ending(), unit, &mut self.displacement, third, next);
        } else {
            if ends {
                let third = Some(&mut self.third[..]).filter(|third| !third.is_empty());
                self.states.end(self.rules.ending(), unit, &mut self.displacement, third, None);
            }
            if new_rates {
                self.recast(Some(Dual::of(self.clocks.creep(&self.rates))?));
            }
            self.plan(step);
            self.look(&self.next, Some(rigid), gap);
        }
        std::mem::swap(&mut self.rules, &mut self.next);
        Ok(self.rules.compliance)
    }

    /// As [`Memory::begin`] for the step under way at another length: what came before it is taken in already.
    pub(in crate::march) fn retry(
        &mut self,
        step: Interval<'_>,
        rigid: &[f64],
        gap: &mut [f64],
    ) -> Result<f64> {
        if self.clocks.set_rates(step.lengths, &mut self.rates) {
            self.recast(Some(Dual::of(self.clocks.creep(&self.rates))?));
        }
        self.plan(step);
        std::mem::swap(&mut self.rules, &mut self.next);
        self.look(&self.rules, Some(rigid), gap);
        Ok(self.rules.compliance)
    }

    /// Sets the rules of a step that starts from the states.
    fn plan(&mut self, step: Interval<'_>) {
        let x = self.clocks.length(step.lengths);
        self.elapsed.iter_mut().zip(self.clocks.own(step.lengths)).for_each(|(e, x)| *e = x);
        if step.drive == Imposed::Apart {
            self.under_way = UnderWay::Apart;
            let recalled = self.recovered(&self.elapsed);
            self.next.set(&self.dual, x, Course::Time, &self.shape);
            self.next.set_apart(&recalled);
            return;
        }
        self.under_way = UnderWay::Contact;
        if self.gone.iter().any(|gone| *gone > 0.0) {
            self.recast(None);
        }
        let course = match step.drive {
            Imposed::Load(load) if x > 0.0 => {
                self.dual.to_strains(&self.total.states, self.total.driver, &mut self.strains);
                let slope = (load - self.total.load) / x;
                self.shape.set(&self.dual, self.total.load, slope, &self.strains);
                match self.shape.runs_one_way(&self.dual, self.total.driver, x) {
                    true => Course::Load(self.shape.change(&self.dual, x)),
                    false => Course::Time,
                }
            }
            _ => Course::Time,
        };
        self.next.set(&self.dual, x, course, &self.shape);
    }

    /// Weights of (q, u) in the displacement that is left when a step without pressure, so long on the clocks, ends.
    fn recovered(&self, elapsed: &[f64]) -> Vec<f64> {
        let gone: Vec<f64> = self.gone.iter().zip(elapsed).map(|(gone, x)| gone + x).collect();
        let rows = self.transition(&self.dual, &gone);
        rows.last().cloned().unwrap_or_default()
    }

    /// What becomes of (q, u) without pressure while the clocks go so far, with the states of `new` after it.
    fn transition(&self, new: &Dual, gone: &[f64]) -> Vec<Vec<f64>> {
        let mut left = vec![];
        self.clocks.fading(gone, &mut left);
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
        self.dual.to_strains(&self.total.states, self.total.driver, &mut self.strains);
        new.to_states(&self.strains, &mut self.total.states);
        self.gone.fill(0.0);
        if let Some(dual) = dual {
            self.dual = dual;
        }
    }

    /// `gap` = `rigid` + g of some rules.
    fn look(&self, rules: &Rules, rigid: Option<&[f64]>, gap: &mut [f64]) {
        match rigid {
            _ if !self.is_elastic() => self.states.combine(rules.recalled(), &self.displacement, rigid, gap),
            Some(rigid) => gap.copy_from_slice(rigid),
            None => gap.fill(0.0),
        }
    }

    /// g of the step under way.
    pub(in crate::march) fn remembered(&self, g: &mut [f64]) {
        self.look(&self.rules, None, g);
    }

    /// The step under way ends under this load.
    pub(in crate::march) fn settle(&mut self, load: f64) {
        self.end.set(&self.total);
        self.end.load = load;
        match self.under_way {
            UnderWay::Contact => {
                self.end.driver = self.rules.end(load, self.total.driver, &mut self.end.states);
            }
            UnderWay::Apart => {
                self.dual.to_strains(&self.total.states, self.total.driver, &mut self.strains);
                self.clocks.fading(&self.elapsed, &mut self.left);
                self.strains.iter_mut().zip(&self.left).for_each(|(e, left)| *e *= left);
                self.dual.to_states(&self.strains, &mut self.end.states);
                self.end.driver = self.strains.iter().sum();
            }
            UnderWay::Nothing => {}
        }
    }
}
