//! Leakage of a gap map, and of a stored result over time.
//!
//! What is asked for ([`Leak`]) comes from `[leakage]` of a case or from the command line; one state is answered by
//! [`Leak::of_gap`], a result by [`store`], which stores its answer in the result ([`crate::store`]), or [`compute`].

mod beside;
mod result;
pub mod words;

use asperity::finding::LeakState;
use asperity::leakage::{
    CellKind, Direction, FlowOptions, Gas, Opening, Passages, Rarefaction, Sides, Species, conductance,
    effective_medium, factor_bytes, gas_flow, leak_rate, liquid, plate, standard,
};
use asperity::traction::{Action, FluidPressure, OpeningPressure, Pockets};
use asperity::{Grid, History, Result};
use ndarray::{Array2, ArrayView2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use beside::Beside;
pub use result::{LeakError, LeakHistory, compute, settings, store, through_windows};

/// Fields of the gap, the network and the iteration that a flow holds besides the factor, about.
const FIELDS: f64 = 20.0;
/// 20 degC \[K\].
const ROOM: f64 = 293.15;

/// Where the fluid flows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeakDirection {
    /// Along x.
    #[default]
    X,
    /// Along y.
    Y,
    /// Along x, and the effective conductance in both directions; on periodic domains.
    Both,
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leak {
    /// Where the fluid flows.
    pub direction: LeakDirection,
    /// What bounds it.
    pub sides: Sides,
    /// Gaps up to it are closed \[m\].
    pub smallest_gap: f64,
    /// The fluid; without one only the gap is assessed.
    pub fluid: Option<Fluid>,
    /// How the fluid acts on the surfaces, where it does.
    #[serde(default)]
    pub coupling: Option<Coupling>,
    /// Whether the pressure of the fluid is stored.
    pub field: bool,
    /// Whether the pressure that opens the contact is computed, which needs the bodies: with a run.
    #[serde(default)]
    pub opening: bool,
    /// Whether the leak without the pressure of the fluid on the surfaces is computed too, likewise.
    #[serde(default)]
    pub one_way: bool,
    /// Temperature of the run over time (\[s\], \[K\]), straight in between; may be empty.
    #[serde(default)]
    pub temperatures: Vec<(f64, f64)>,
    /// Times \[s\] of stored fields; `None` for all that are stored.
    #[serde(default)]
    pub times: Option<Vec<f64>>,
}

/// How a fluid acts on the surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coupling {
    /// Where.
    pub action: Action,
    /// Pressure of the inlet over time \[Pa, absolute\].
    pub inlet: History,
    /// Pressure of the outlet \[Pa, absolute\].
    pub outlet: f64,
    /// Pressure that the load does not contain \[Pa, absolute\].
    pub reference: f64,
    /// Bulk modulus of a liquid in sealed pockets \[Pa\].
    #[serde(default)]
    pub bulk_modulus: Option<f64>,
}

/// A fluid and what drives it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fluid {
    /// Newtonian and incompressible.
    Liquid {
        /// \[Pa\].
        pressure_drop: f64,
        /// \[Pa s\].
        viscosity: f64,
        /// Pressure of the outlet \[Pa\]; 0 where only the drop is given.
        #[serde(default, skip_serializing_if = "is_zero")]
        outlet: f64,
    },
    /// Ideal and isothermal.
    Gas {
        /// Which.
        kind: GasKind,
        /// \[K\]; `None` for that of the run.
        temperature: Option<f64>,
        /// Absolute pressure \[Pa\].
        inlet: f64,
        /// Absolute pressure \[Pa\].
        outlet: f64,
        /// The law of the flow.
        rarefaction: Rarefaction,
    },
}

fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

/// Properties of a gas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GasKind {
    /// Known.
    Known(Species),
    /// Given.
    Other {
        /// \[Pa s\].
        viscosity: f64,
        /// \[kg/mol\].
        molar_mass: f64,
    },
}

impl Fluid {
    /// Pressure of the inlet less that of the outlet \[Pa\].
    pub fn pressure_drop(&self) -> f64 {
        match self {
            Fluid::Liquid { pressure_drop, .. } => *pressure_drop,
            Fluid::Gas { inlet, outlet, .. } => inlet - outlet,
        }
    }
}

/// The leak of one state.
#[derive(Clone, Debug)]
pub struct Leakage {
    /// Whether inlet and outlet are connected.
    pub percolates: bool,
    /// Hydraulic gap \[m\]: parallel plates at this distance have the same leak rate of a liquid.
    pub hydraulic_gap: f64,
    /// Gap of the critical constriction \[m\]; NaN where the seal is tight.
    pub critical_gap: f64,
    /// Its place x, y \[m\].
    pub critical: [f64; 2],
    /// Open cells across it, where they are bounded.
    pub critical_width: Option<usize>,
    /// Hydraulic gap of Bruggeman's effective medium \[m\].
    pub medium_gap: f64,
    /// Area of the pockets \[m^2\].
    pub trapped_area: f64,
    /// Their volume \[m^3\].
    pub trapped_volume: f64,
    /// Share of the cells that are open.
    pub open_fraction: f64,
    /// The error of the gap that the gap itself tells \[m\], and the number of cells that are closed because of it.
    pub closed: (f64, usize),
    /// Effective conductance \[m^3\]; `None` unless both directions were asked for.
    pub conductance: Option<[[f64; 2]; 2]>,
    /// Leak rate \[m^3/s; gas kg/s\]; `None` without a fluid.
    pub leak_rate: Option<f64>,
    /// Leak of a gas \[Pa m^3/s at 0 degC\].
    pub leak_rate_standard: Option<f64>,
    /// Leak of parallel plates at the critical gap, unit as `leak_rate`.
    pub leak_estimate_junction: Option<f64>,
    /// Leak of the effective medium, likewise.
    pub leak_estimate_medium: Option<f64>,
    /// Mean free path over critical gap, of a gas.
    pub knudsen: Option<f64>,
    /// Leak of the run whose fluid does not act on the surfaces, unit as `leak_rate`; NaN if it has no such row. `None` if not asked for.
    pub leak_rate_one_way: Option<f64>,
    /// Pressure of the inlet that opens the contact \[Pa, as the inlet\]; `None` if not asked for.
    pub opening_pressure: Option<f64>,
    /// Pressure of the fluid \[Pa\]; without a fluid, from 1 at the inlet to 0 at the outlet. NaN in closed cells and pockets.
    pub pressure: Array2<f64>,
    /// What each cell is connected to.
    pub cells: Array2<CellKind>,
}

impl Leakage {
    /// What the diagnostics can judge without a result: the cells across the constriction.
    pub fn alone(&self) -> LeakState {
        LeakState {
            row: None,
            constriction: self.percolates.then_some((self.critical_gap, self.critical_width)),
            gap_error: self.closed.0,
            closed: self.closed.1,
            pressure_drop: None,
            mean_pressure: 0.0,
        }
    }
}

impl Leak {
    /// Memory that it takes at most, of so many cells \[bytes\].
    pub fn bytes(&self, cells: usize) -> f64 {
        let opening = if self.opening { OpeningPressure::bytes(cells) } else { 0.0 };
        factor_bytes(cells).min(FlowOptions::default().memory) + FIELDS * 8.0 * cells as f64 + opening
    }

    /// The leak through a gap \[m\] with a contact (nonzero where the bodies touch; without it, where the gap is not positive),
    /// at a time \[s\], which decides the temperature of a gas.
    ///
    /// # Errors
    /// As of [`Opening::new`] and the flows.
    pub fn of_gap(
        &self,
        grid: &Grid,
        gap: ArrayView2<'_, f64>,
        contact: Option<ArrayView2<'_, u8>>,
        time: f64,
    ) -> Result<Leakage> {
        let opening = Opening::new(grid, gap, contact, self.axis(), self.sides, self.smallest_gap)?;
        let passages = Passages::of(&opening);
        let options = FlowOptions::default();
        let flow = liquid(&opening, &passages, &options)?;
        let critical = passages.constriction.map_or(0.0, |constriction| constriction.gap);
        let medium = effective_medium(&opening).cbrt();
        let place = passages.constriction.map_or([f64::NAN; 2], |c| [grid.x(c.cell[0]), grid.y(c.cell[1])]);
        let hydraulic_gap = flow.hydraulic_gap();
        let (pressure, rates) = match self.fluid_at(time) {
            None => (flow.pressure, [None; 5]),
            Some(Fluid::Liquid { pressure_drop, viscosity, .. }) => {
                // Without a drop nothing flows.
                let of = |t: f64| match pressure_drop > 0.0 {
                    true => leak_rate(t, &opening, pressure_drop, viscosity).map(Some),
                    false => Ok(Some(0.0)),
                };
                let rates = [flow.transmissivity, critical.powi(3), medium.powi(3)].map(of);
                let [rate, junction, medium] = rates;
                let outlet = self.coupling.as_ref().map_or(0.0, |coupling| coupling.outlet);
                (flow.pressure * pressure_drop + outlet, [rate?, None, junction?, medium?, None])
            }
            Some(Fluid::Gas { kind, temperature, inlet, outlet, rarefaction }) => {
                drop(flow);
                let gas = self.gas(kind, temperature, time)?;
                let ends = [inlet, outlet];
                let flow = gas_flow(&opening, &passages, &gas, rarefaction, ends, &options)?;
                let of = |gap: f64| plate(&gas, rarefaction, gap, opening.size(), ends);
                let (rate, standard) = (flow.leak_rate, standard(flow.leak_rate, &gas));
                (flow.pressure, [rate, standard, of(critical)?, of(medium)?, flow.knudsen].map(Some))
            }
        };
        let [leak_rate, leak_rate_standard, leak_estimate_junction, leak_estimate_medium, knudsen] = rates;
        Ok(Leakage {
            percolates: passages.percolates(),
            hydraulic_gap,
            critical_gap: if passages.percolates() { critical } else { f64::NAN },
            critical: place,
            critical_width: passages.constriction.and_then(|constriction| constriction.width),
            medium_gap: medium,
            trapped_area: passages.trapped_area,
            trapped_volume: passages.trapped_volume,
            open_fraction: passages.open_fraction(),
            closed: opening.closed(),
            conductance: match self.direction {
                LeakDirection::Both => Some(conductance(&opening, &options)?),
                _ => None,
            },
            leak_rate,
            leak_rate_standard,
            leak_estimate_junction,
            leak_estimate_medium,
            knudsen,
            leak_rate_one_way: None,
            opening_pressure: None,
            cells: passages.map(&opening),
            pressure,
        })
    }

    /// What the cells of a gap \[m\] with a contact are connected to.
    ///
    /// # Errors
    /// As of [`Opening::new`].
    pub fn kinds(
        &self,
        grid: &Grid,
        gap: ArrayView2<'_, f64>,
        contact: ArrayView2<'_, u8>,
    ) -> Result<Array2<CellKind>> {
        let opening = Opening::new(grid, gap, Some(contact), self.axis(), self.sides, self.smallest_gap)?;
        Ok(Passages::of(&opening).map(&opening))
    }

    /// Whether each pass of a contact solves the flow too.
    pub(crate) fn flows_with_the_contact(&self) -> bool {
        matches!(self.coupling, Some(Coupling { action: Action::Gaps(_), .. }))
    }

    /// Direction of the flow that is computed first.
    pub fn axis(&self) -> Direction {
        match self.direction {
            LeakDirection::Y => Direction::Y,
            LeakDirection::X | LeakDirection::Both => Direction::X,
        }
    }

    /// The fluid with its pressures at a time \[s\].
    fn fluid_at(&self, time: f64) -> Option<Fluid> {
        let now = self.coupling.as_ref().map(|coupling| (coupling.inlet.after(time), coupling.outlet));
        match (self.fluid?, now) {
            (Fluid::Liquid { viscosity, .. }, Some((inlet, outlet))) => {
                Some(Fluid::Liquid { pressure_drop: inlet - outlet, viscosity, outlet })
            }
            (Fluid::Gas { kind, temperature, rarefaction, .. }, Some((inlet, outlet))) => {
                Some(Fluid::Gas { kind, temperature, inlet, outlet, rarefaction })
            }
            (fluid, None) => Some(fluid),
        }
    }

    /// What acts on the surfaces, where the fluid does.
    pub(crate) fn traction(&self) -> Result<Option<FluidPressure>> {
        self.coupling.clone().map(|coupling| self.acting(coupling)).transpose()
    }

    /// What would act on the surfaces, where the fluid does not: its pressure above that of the outlet.
    pub(crate) fn opening_traction(&self) -> Result<FluidPressure> {
        let outlet = match self.fluid {
            Some(Fluid::Gas { outlet, .. } | Fluid::Liquid { outlet, .. }) => outlet,
            None => 0.0,
        };
        let at_rest = Coupling {
            action: Action::Gaps(Pockets::Drained),
            inlet: History::Step { value: outlet },
            outlet,
            reference: outlet,
            bulk_modulus: None,
        };
        self.acting(self.coupling.clone().unwrap_or(at_rest))
    }

    fn acting(&self, coupling: Coupling) -> Result<FluidPressure> {
        let (gas, viscosity) = match self.fluid {
            Some(Fluid::Gas { kind, temperature, rarefaction, .. }) => {
                let gas = self.gas(kind, temperature, 0.0)?;
                (Some((gas, rarefaction)), gas.viscosity)
            }
            Some(Fluid::Liquid { viscosity, .. }) => (None, viscosity),
            None => (None, 0.0),
        };
        Ok(FluidPressure {
            inlet: coupling.inlet,
            outlet: coupling.outlet,
            reference: coupling.reference,
            gas,
            viscosity,
            direction: self.axis(),
            sides: self.sides,
            smallest_gap: self.smallest_gap,
            action: coupling.action,
            bulk_modulus: coupling.bulk_modulus,
        })
    }

    pub(crate) fn gas(&self, kind: GasKind, temperature: Option<f64>, time: f64) -> Result<Gas> {
        let temperature = temperature.or_else(|| at(&self.temperatures, time)).unwrap_or(ROOM);
        match kind {
            GasKind::Known(species) => Gas::of(species, temperature),
            GasKind::Other { viscosity, molar_mass } => Gas::new(viscosity, molar_mass, temperature),
        }
    }
}

/// The temperature at a time, straight between points; the later of two at the same time.
fn at(points: &[(f64, f64)], time: f64) -> Option<f64> {
    let after = points.partition_point(|point| point.0 <= time);
    Some(match (after.checked_sub(1).and_then(|n| points.get(n)), points.get(after)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (time - a.0) / (b.0 - a.0),
        (Some(a), None) => a.1,
        (None, Some(b)) => b.1,
        (None, None) => return None,
    })
}
