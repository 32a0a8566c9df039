//! The pressure of a fluid in the gap, which opens the contact.
//!
//! ```text
//! open cells that reach both reservoirs     Reynolds: div(g³ grad P) = 0, of a gas div(g³ Q grad P²/2) = 0
//! that reach one of them                    the pressure of that reservoir
//! that reach neither, a pocket              by its rule, say what it had when it was cut off (see `pockets`)
//! contact cells beside open ones            b = mean of the pressures beside them (see `beside`)
//! contact cells inside                      b = 0: fluid gets in only from an edge, one cell per pass
//! ```
//!
//! Pressures of the fluid are absolute; the surfaces feel P less the reference, which the load does not contain. Without the rule of
//! the edges a contact cell could hold any pressure between 0 and that of the fluid, and the edge would be stuck as if the
//! contact were tough, an error that falls only with the square root of the cell.
//!
//! Under a uniform pressure P of all the gap the total pressure of a periodic contact is P + that of the dry contact under the load
//! W - P A, whatever the bodies remember: there the loop ends after two passes.
//!
//! Flow has no energy: the safeguard of the loop is its residual. Where the access of a cell to the fluid changes again and again
//! from pass to pass, no fixed point exists; such cells are held (see `latch`).
//!
//! Sources: A. G. Shvarts & V. A. Yastrebov, J. Mech. Phys. Solids 113 (2018) 140 (trapped fluid) and Tribol. Int. 126 (2018) 116 (flow
//! and contact).

mod beside;
mod latch;
mod opening;
mod pockets;
mod sealed;
#[cfg(test)]
mod sealed_tests;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use ndarray::Array2;

pub use opening::OpeningPressure;
pub use pockets::Pockets;

use super::{SurfaceTraction, TractionLaw};
use crate::error::{Error, Of, Result, non_negative, require};
use crate::grid::Grid;
use crate::leakage::{
    CellKind, Direction, FlowOptions, Gas, Opening, Passages, Previous, Rarefaction, Sides, factor_bytes,
    gas_flow_after, liquid_after,
};
use crate::load::History;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::time::Instant;
use beside::Beside;
use latch::Latch;
use pockets::Contents;
use sealed::{Fluid, Found, Sealed};

/// Tolerances of the loop and of the contact of a pass over that of a contact alone: gaps at the narrowest places are small.
const TOLERANCES: [f64; 2] = [10.0, 0.1];
/// Changes of a pressure below this share of the largest one are none.
const SMALL: f64 = 1e-5;
/// Passes over which the spread of the conductance is told, after cells may be held.
const RECENT: usize = 20;

/// Where the fluid acts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Action {
    /// The pressure of the inlet acts everywhere, also between cells in contact: exact where inlet and outlet have the same
    /// pressure and the fluid reaches all of the gap.
    Everywhere,
    /// In the open cells, by the flow between the reservoirs; and in pockets.
    Gaps(Pockets),
}

/// A fluid that acts on the surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct FluidPressure {
    /// Pressure of the inlet over time \[Pa, absolute\].
    pub inlet: History,
    /// Pressure of the outlet \[Pa, absolute\].
    pub outlet: f64,
    /// Pressure that the load does not contain, that of the surroundings \[Pa, absolute\].
    pub reference: f64,
    /// A gas and how its rarefaction counts; `None` for a liquid.
    pub gas: Option<(Gas, Rarefaction)>,
    /// Viscosity \[Pa s\], from which it is judged whether the flow may be taken as steady.
    pub viscosity: f64,
    /// Direction of the flow.
    pub direction: Direction,
    /// What bounds it at the sides.
    pub sides: Sides,
    /// Gaps up to it are closed \[m\].
    pub smallest_gap: f64,
    /// Where it acts.
    pub action: Action,
    /// Bulk modulus of a liquid \[Pa\], where pockets are sealed.
    pub bulk_modulus: Option<f64>,
}

impl FluidPressure {
    /// # Errors
    /// [`Error::Invalid`] that names the argument.
    fn validate(&self, end: f64) -> Result<()> {
        let outlet = non_negative("pressure of the outlet", self.outlet, "Pa").of("outlet")?;
        let [least, most] = self.inlet.range(end);
        let holds = least.is_finite() && most.is_finite() && least >= outlet;
        let expected = format!(
            "not below that of the outlet, {outlet} Pa, at all times; exchange them for a flow in the other direction"
        );
        require(holds, "pressure of the inlet", format!("{least} Pa"), expected).of("inlet")?;
        let jump = self.inlet.breaks(end).into_iter().find(|t| self.inlet.before(*t) != self.inlet.after(*t));
        let expected = "none: give the change a time, as a ramp";
        require(jump.is_none(), "jump of the pressure of the inlet", jump.map_or(0.0, |t| t), expected)
            .of("inlet")?;
        let lowest = format!("{} Pa", self.reference);
        let expected = "0 (vacuum) up to the pressure of the outlet";
        require((0.0..=outlet).contains(&self.reference), "reference of the pressure", lowest, expected)
            .of("reference")?;
        non_negative("smallest gap that lets the fluid pass", self.smallest_gap, "m").of("smallest_gap")?;
        if let Action::Gaps(pockets) = self.action {
            pockets.validate(self.smallest_gap)?;
        }
        let modulus = self.bulk_modulus;
        let is_sealed = self.action == Action::Gaps(Pockets::Sealed);
        let sound = match modulus {
            Some(modulus) => is_sealed && self.gas.is_none() && modulus > 0.0 && modulus.is_finite(),
            None => !is_sealed || self.gas.is_some(),
        };
        let given = modulus.map_or("none".to_owned(), |modulus| format!("{modulus} Pa"));
        let expected = "positive and finite for a liquid in sealed pockets, and none else";
        require(sound, "bulk modulus", given, expected).of("bulk_modulus")
    }

    /// The pressure of the inlet \[Pa, absolute\] from which on a film without contact on a periodic domain does not hold a mean pressure
    /// \[Pa\], however wide it is: then the pressure falls evenly, in a liquid by P, in a gas by P², and its mean is `mean`. A film that
    /// becomes wider along the flow may hold a little more.
    pub fn lift_off(&self, mean: f64) -> f64 {
        let (mean, outlet) = (mean + self.reference, self.outlet);
        match (self.action, &self.gas) {
            (Action::Everywhere, _) => mean,
            // The outlet alone has more.
            _ if mean <= outlet => mean,
            (Action::Gaps(_), None) => 2.0 * mean - outlet,
            // 2/3 (P_in² + P_in P_out + P_out²)/(P_in + P_out) = mean.
            (Action::Gaps(_), Some(_)) => {
                let half = 0.5 * (1.5 * mean - outlet);
                half + (half * half + (1.5 * mean - outlet) * outlet).sqrt()
            }
        }
    }

    /// What sealed pockets hold.
    fn in_pockets(&self) -> Option<Fluid> {
        let sealed = Action::Gaps(Pockets::Sealed);
        let liquid = || self.bulk_modulus.map(|bulk_modulus| Fluid::Liquid { bulk_modulus });
        (self.action == sealed).then(|| if self.gas.is_some() { Some(Fluid::Gas) } else { liquid() })?
    }
}

impl TractionLaw for FluidPressure {
    fn start(&self, grid: &Grid) -> Box<dyn SurfaceTraction> {
        Box::new(InGap::new(self.clone(), grid))
    }

    fn tolerances(&self, contact: f64) -> [f64; 2] {
        TOLERANCES.map(|share| share * contact)
    }

    fn as_fluid(&self) -> Option<&FluidPressure> {
        Some(self)
    }

    fn quantities(&self) -> Vec<Quantity> {
        Quantity::of_fluid().collect()
    }

    fn breaks(&self, end: f64) -> Vec<f64> {
        self.inlet.breaks(end)
    }

    fn bytes(&self, grid: &Grid) -> usize {
        // The factorisation, and about 30 fields: gap, network, iteration, pressures, pockets, the access of the cells; 12 of sealed pockets.
        let fields = if self.in_pockets().is_some() { 42 } else { 30 };
        let factor = factor_bytes(grid.len()).min(FlowOptions::default().memory);
        if self.action == Action::Everywhere { 0 } else { factor as usize + fields * 8 * grid.len() }
    }

    fn check(&self, simulation: &Simulation) -> Result<()> {
        let end = simulation.times.end();
        self.validate(end).of("leakage")?;
        if simulation.motion.is_some() && self.action != Action::Everywhere {
            let expected = "none: the flow that a sliding surface drags along is not solved";
            return Err(
                Error::invalid("motion of a contact that a fluid acts on", "given", expected).of("motion")
            );
        }
        let untouchable = simulation.gap.iter().any(|h| !h.is_finite());
        let expected = "finite: fluid acts on all of the domain. Cut the surface, or fill its holes";
        require(!untouchable, "gap of cells that a fluid acts on", "infinite in places", expected)
            .of("leakage.coupling")?;
        let expected =
            "\"kept\" or \"drained\" where the hardness limits the pressure: a sealed pocket may exceed it";
        let sealed = self.action == Action::Gaps(Pockets::Sealed);
        require(!(sealed && simulation.is_capped()), "pockets", "\"sealed\"", expected)
            .of("leakage.pockets")?;
        let most = self.inlet.range(end)[1] - self.reference;
        let [hardness, _] = simulation.hardness_range();
        let expected = format!("more than the pressure of the fluid, {most} Pa: no contact could hold it");
        require(hardness > most, "hardness", format!("{hardness} Pa"), expected).of("leakage.inlet")
    }
}

/// The fluid of a run.
struct InGap {
    law: FluidPressure,
    grid: Grid,
    beside: Beside,
    previous: Previous,
    contents: Contents,
    latch: Latch,
    /// Of the instant \[Pa\].
    inlet: f64,
    /// Absolute pressure of each cell of the last pass \[Pa\], NaN in contact; and whether the fluid of a reservoir reaches it.
    pressure: Vec<f64>,
    reached: Vec<bool>,
    /// The pressure that acts on each open cell, with those that are held \[Pa\]; NaN in contact.
    acting: Vec<f64>,
    /// That of the flow through contacts, where fluid passes through them.
    inside: Option<Vec<f64>>,
    /// The least and the largest b that may be.
    limits: [f64; 2],
    percolates: bool,
    /// Conductances of the last passes, of any unit.
    conductances: VecDeque<f64>,
}

impl InGap {
    fn new(law: FluidPressure, grid: &Grid) -> Self {
        let cells = grid.len();
        let wraps = law.sides == Sides::Periodic;
        let rule = match law.action {
            Action::Everywhere => Pockets::default(),
            Action::Gaps(pockets) => pockets,
        };
        InGap {
            beside: Beside::new(grid, law.direction, wraps),
            previous: Previous::default(),
            contents: match law.in_pockets() {
                Some(fluid) => Contents::sealed(fluid, law.reference, grid.cell_area(), cells),
                None => Contents::new(rule, law.reference, law.smallest_gap, cells),
            },
            latch: Latch::new(cells),
            inlet: law.inlet.after(0.0),
            pressure: vec![f64::NAN; cells],
            reached: vec![false; cells],
            acting: vec![f64::NAN; cells],
            inside: None,
            limits: [0.0; 2],
            percolates: false,
            conductances: VecDeque::new(),
            grid: *grid,
            law,
        }
    }

    /// Pressures of the cells that fluid flows through, NaN elsewhere, and the conductance.
    fn flow(&mut self, opening: &Opening, passages: &Passages) -> Result<(Array2<f64>, f64)> {
        let (options, previous) = (FlowOptions::default(), &mut self.previous);
        let [inlet, outlet] = [self.inlet, self.law.outlet];
        match &self.law.gas {
            Some((gas, rarefaction)) => {
                let ends = [inlet, outlet];
                let flow = gas_flow_after(opening, passages, gas, *rarefaction, ends, &options, previous)?;
                Ok((flow.pressure, flow.leak_rate))
            }
            None => {
                let flow = liquid_after(opening, passages, &options, previous)?;
                Ok((flow.pressure.mapv_into(|x| outlet + (inlet - outlet) * x), flow.transmissivity))
            }
        }
    }

    /// The open cells and what they are connected to; with a `floor` all cells, those in contact too, have that gap at least.
    fn passages(&self, floor: Option<f64>, gap: &[f64], contact: &[f64]) -> Result<(Opening, Passages)> {
        let (shape, FluidPressure { direction, sides, .. }) = (self.grid.shape(), &self.law);
        let (least, smallest_gap) = (floor.unwrap_or(0.0), floor.map_or(self.law.smallest_gap, |_| 0.0));
        let gap = Array2::from_shape_fn(shape, |(i, j)| {
            let cell = i * shape.1 + j;
            if contact[cell] > 0.0 { least } else { gap[cell].max(least) }
        });
        let opening = Opening::new(&self.grid, gap.view(), None, *direction, *sides, smallest_gap)?;
        let passages = Passages::of(&opening);
        Ok((opening, passages))
    }

    /// Sets `pressure` and `reached` from the gap, the contact pressure and the traction of the pass.
    fn find_pressures(&mut self, gap: &[f64], contact: &[f64], traction: &[f64]) -> Result<()> {
        let (opening, passages) = self.passages(None, gap, contact)?;
        self.percolates = passages.percolates();
        let (opening, passages) = match self.contents.floor() {
            None => (opening, passages),
            floor => self.passages(floor, gap, contact)?,
        };
        let (flowing, conductance) = self.flow(&opening, &passages)?;
        if self.conductances.len() == RECENT {
            self.conductances.pop_front();
        }
        if !self.latch.may_hold() {
            self.conductances.clear();
        }
        self.conductances.push_back(conductance);
        let kinds = passages.map(&opening);
        for (cell, (kind, own)) in kinds.iter().zip(&flowing).enumerate() {
            let is_closed = contact[cell] > 0.0;
            self.pressure[cell] = match kind {
                _ if is_closed => f64::NAN,
                CellKind::Through => *own,
                CellKind::AtInlet => self.inlet,
                CellKind::AtOutlet => self.law.outlet,
                CellKind::Closed | CellKind::Pocket => f64::NAN,
            };
            self.reached[cell] = !self.pressure[cell].is_nan();
        }
        let is_pocket: Vec<bool> = kinds.iter().map(|kind| *kind == CellKind::Pocket).collect();
        let vented = |cell: usize| self.latch.vented(cell).map(|b| b + self.law.reference);
        let found =
            Found { is_pocket: &is_pocket, reached: &self.reached, vented: &vented, gap, contact, traction };
        self.contents.fill(&self.beside, &found, &mut self.pressure);
        self.inside = self.contents.floor().map(|_| flowing.into_iter().collect());
        Ok(())
    }

    /// The pressure that a cell without fluid takes when it opens, and whether that of a reservoir reaches it; `None` away from fluid.
    fn at_edge(&self, cell: usize) -> Option<(f64, bool)> {
        // In the narrowest gaps a gas flows in proportion to its pressure, without rarefaction to the square of it.
        let is_square = matches!(self.law.gas, Some((_, Rarefaction::Continuum)));
        let [to, from]: [fn(f64) -> f64; 2] = if is_square { [|p| p * p, f64::sqrt] } else { [|p| p, |p| p] };
        let ends = [self.inlet, self.law.outlet];
        let (mut sum, mut weights, mut reached) = (0.0, 0.0, false);
        for (weight, other) in self.beside.of(cell) {
            let (p, is_reached) = match other {
                beside::Other::Cell(other) => (self.pressure[other], self.reached[other]),
                beside::Other::Reservoir(end) => (ends[end], true),
            };
            if !p.is_nan() {
                sum += weight * to(p);
                weights += weight;
                reached |= is_reached;
            }
        }
        let own = self.inside.as_ref().map(|cells| cells[cell]).filter(|p| !p.is_nan());
        (weights > 0.0).then(|| (own.unwrap_or_else(|| from(sum / weights)), reached))
    }
}

impl SurfaceTraction for InGap {
    fn begin(&mut self, at: &Instant) {
        // Steps end at kinks, and the history has no jumps.
        self.inlet = self.law.inlet.after(at.time);
    }

    fn begin_solve(&mut self, compliance: f64, rise: f64, traction: &mut [f64]) {
        // A solve depends on what is saved of the last row alone, so that a run resumed there has the same bits.
        self.previous.forget();
        self.contents.begin(&self.beside, compliance, rise, traction);
    }

    fn begin_loop(&mut self) {
        self.contents.sealed.iter_mut().for_each(Sealed::begin_loop);
        self.latch.clear();
        self.conductances.clear();
    }

    fn bound(&mut self, gap: &[f64], contact: &[f64], out: &mut [f64]) -> Result<()> {
        let reference = self.law.reference;
        if self.law.action == Action::Everywhere {
            out.fill(self.inlet - reference);
            self.limits = [self.inlet - reference; 2];
            self.percolates = contact.contains(&0.0);
            return Ok(());
        }
        self.find_pressures(gap, contact, out)?;
        let largest = (self.inlet - reference).abs().max(self.law.outlet - reference);
        let limits = [SMALL * largest, largest];
        for (cell, b) in out.iter_mut().enumerate() {
            let (p, reached) = match self.pressure[cell] {
                p if p.is_nan() => self.at_edge(cell).unwrap_or((reference, false)),
                p => (p, self.reached[cell]),
            };
            *b = self.latch.hold(cell, reached, p - reference, limits);
            // What acts on open cells is what they remember.
            self.acting[cell] = if contact[cell] > 0.0 { f64::NAN } else { *b + reference };
        }
        self.latch.pass();
        self.limits = out.iter().fold([0.0_f64; 2], |[least, most], b| [least.min(*b), most.max(*b)]);
        Ok(())
    }

    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    fn is_settled(&self) -> bool {
        self.latch.held > 0 || self.contents.sealed.as_ref().is_none_or(|sealed| sealed.is_settled())
    }

    fn is_displaced(&self) -> bool {
        true
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        Some(match quantity {
            Quantity::InletPressure => self.inlet,
            Quantity::Connected => f64::from(u8::from(self.percolates)),
            Quantity::PocketArea => self.contents.cells as f64 * self.grid.cell_area(),
            Quantity::PocketPressureMax => self.contents.largest,
            Quantity::PocketVapour => self.contents.sealed.as_ref().map_or(0.0, |sealed| sealed.vapour),
            Quantity::LatchedCells => self.latch.held as f64,
            Quantity::LeakSpread => {
                let [least, most] = self
                    .conductances
                    .iter()
                    .fold([f64::INFINITY, 0.0_f64], |[least, most], t| [least.min(*t), most.max(*t)]);
                if self.latch.held > 0 && most > 0.0 { (most - least) / most } else { 0.0 }
            }
            _ => return None,
        })
    }

    fn commit(&mut self) {
        self.contents.commit(&self.acting);
    }

    fn memory(&self) -> Vec<&[f64]> {
        self.contents.memory()
    }

    fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        self.contents.memory_mut()
    }
}
