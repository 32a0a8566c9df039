//! The pressure of the fluid across a seal: a march from the outlet to the inlet. In a cell of width dx with contact pressure p0
//!
//! ```text
//! int_{P outlet side}^{P inlet side} k(p0 - P, P) dP = F dx,   k = sigma(p0 - P) of a liquid
//! ```
//!
//! is exact. P rises in each cell, so a cell that chokes the flow is no stiff step: there P jumps to where sigma begins. F is the flow
//! with which the march arrives at the inlet pressure.

use std::ops::Range;

use super::conductance::Pressed;
use super::{Conductance, Profile};
use crate::error::{Error, Result};
use crate::kernel::gauss::GAUSS_8;

/// Cells across the seal.
pub const CELLS: usize = 400;
/// Largest number of marches; usually a dozen.
const MARCHES: usize = 200;
/// The march has arrived if the drop is met within this share.
const ARRIVED: f64 = 1e-12;
/// How the seal is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum SealState {
    /// Nothing flows.
    Tight,
    /// The fluid flows.
    Leaks,
    /// The inlet pressure is not below the contact pressure anywhere: the fluid lifts the seal.
    Lifted,
    /// The seal is pressed less than all pressures of a sweep that is tight: not known.
    Unknown,
}

/// The flow across a seal at an inlet and an outlet pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct SealFlow {
    /// How the seal is.
    pub state: SealState,
    /// F \[Pa m^2\], so that F/(12 mu) is the leak per length \[m^2/s\]; of a gas \[Pa^2 m^2\], F/(12 mu R_s T) \[kg/(m s)\]. Infinite
    /// where the seal is lifted, NaN where it is not known.
    pub flow: f64,
    /// F with the contact of the dry seal, which the fluid does not open.
    pub one_way: f64,
    /// Pressure of the fluid \[Pa\] at the ends of the cells, [`CELLS`] + 1 numbers.
    pub pressure: Vec<f64>,
    /// Where the pressure falls the most, of a seal that leaks.
    pub choke: Option<Choke>,
    /// Least and largest p0 - P \[Pa\] in the contact.
    pub pressed: [f64; 2],
}

/// Where the pressure of the fluid falls the most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choke {
    /// Place across the seal \[m\] from the inlet.
    pub x: f64,
    /// p0 - P there \[Pa\], where the fluid enters the cell.
    pub pressed: f64,
    /// P there \[Pa\], likewise.
    pub fluid: f64,
}

/// The flow between two pressures \[Pa\], inlet and outlet, both counted as the contact pressure is.
///
/// # Errors
/// [`Error::Invalid`]: an inlet pressure that is not above the outlet pressure, or one that the profile has no table for.
pub fn flow(sigma: &Conductance, profile: &Profile, ends: [f64; 2]) -> Result<SealFlow> {
    let seal = Opened::new(sigma, profile, ends)?;
    let largest = profile.largest(ends[0]).unwrap_or(f64::NAN);
    Ok(SealFlow { one_way: one_way(sigma, &seal.p0, largest, seal.dx, ends), ..seal.flow })
}

/// The least and the largest flow that the points of the sweep allow ([`Conductance::low`], [`Conductance::high`]).
///
/// # Errors
/// As [`flow`].
pub fn bounds(sigma: &Conductance, profile: &Profile, ends: [f64; 2]) -> Result<[f64; 2]> {
    let of = |sigma: Conductance| Opened::new(&sigma, profile, ends).map(|seal| seal.flow.flow);
    Ok([of(sigma.low())?, of(sigma.high())?])
}

/// A seal that the fluid opens.
pub(super) struct Opened {
    /// Contact pressure in the cells.
    pub(super) p0: Vec<f64>,
    pub(super) dx: f64,
    /// The flow, without that of the contact which is not opened.
    pub(super) flow: SealFlow,
}

impl Opened {
    pub(super) fn new(sigma: &Conductance, profile: &Profile, [inlet, outlet]: [f64; 2]) -> Result<Opened> {
        if !(inlet > outlet && outlet.is_finite() && inlet.is_finite()) {
            let expected = format!("a pressure above that of the outlet, {outlet} Pa");
            return Err(Error::invalid("the pressure at the inlet", inlet, expected).of("inlet"));
        }
        profile.validate()?;
        let (Some(p0), Some(largest)) = (profile.pressures(CELLS, inlet), profile.largest(inlet)) else {
            let [from, to] = profile.inlets().unwrap_or_default();
            let expected = format!("a pressure from {from} Pa to {to} Pa, as the profile has");
            return Err(Error::invalid("the pressure at the inlet", inlet, expected).of("inlet"));
        };
        let dx = profile.width() / CELLS as f64;
        let flow = opened(sigma, &p0, largest, dx, [inlet, outlet]);
        Ok(Opened { p0, dx, flow })
    }

    /// The cells in contact that the fluid flows through: it moves the edges of the contact to where it is pressed.
    pub(super) fn contact(p0: &[f64], [inlet, outlet]: [f64; 2]) -> Option<Range<usize>> {
        let start = p0.iter().position(|p0| *p0 > inlet)?;
        Some(start..p0.iter().rposition(|p0| *p0 > outlet).map_or(p0.len(), |last| last + 1))
    }
}

/// The flow that opens the contact.
fn opened(sigma: &Conductance, p0: &[f64], largest: f64, dx: f64, [inlet, outlet]: [f64; 2]) -> SealFlow {
    let ended = |state, flow, pressure, pressed| SealFlow {
        state,
        flow,
        one_way: f64::NAN,
        pressure,
        choke: None,
        pressed,
    };
    let Some(cells) = Opened::contact(p0, [inlet, outlet]) else {
        return ended(SealState::Lifted, f64::INFINITY, vec![inlet; CELLS + 1], [0.0; 2]);
    };
    if let Some(tight) = sigma.sealing_pressure() {
        if largest - inlet >= tight {
            let top = || (0..CELLS).max_by(|a, b| p0[*a].total_cmp(&p0[*b])).unwrap_or(0);
            let closed = p0.iter().position(|p0| p0 - inlet >= tight).unwrap_or_else(top);
            let pressure = (0..=CELLS).map(|n| if n <= closed { inlet } else { outlet }).collect();
            return ended(SealState::Tight, 0.0, pressure, [tight, largest - outlet]);
        }
        if sigma.last_leaking().is_none() {
            let pressed = [largest - inlet, tight];
            return ended(SealState::Unknown, f64::NAN, vec![f64::NAN; CELLS + 1], pressed);
        }
    }
    let march = March { sigma, p0: &p0[cells.clone()], dx, ends: [inlet, outlet], opens: true };
    let flow = march.flow();
    let mut pressure = vec![inlet; cells.start];
    pressure.extend(march.pressures(flow));
    pressure[cells.start] = inlet;
    pressure.resize(CELLS + 1, outlet);
    let steepest = cells.clone().max_by(|a, b| {
        let drop = |n: usize| pressure[n] - pressure[n + 1];
        drop(*a).total_cmp(&drop(*b))
    });
    let choke = steepest.map(|n| Choke {
        x: (n as f64 + 0.5) * dx,
        pressed: p0[n] - pressure[n],
        fluid: pressure[n],
    });
    let pressed = |n: usize| p0[n] - 0.5 * (pressure[n] + pressure[n + 1]);
    let all = cells.map(pressed);
    let pressed = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
    SealFlow { choke, ..ended(SealState::Leaks, flow, pressure, pressed) }
}

/// F where the fluid does not open the contact.
fn one_way(sigma: &Conductance, p0: &[f64], largest: f64, dx: f64, ends: [f64; 2]) -> f64 {
    match (sigma.sealing_pressure(), sigma.last_leaking()) {
        (Some(tight), _) if largest >= tight => 0.0,
        (_, None) => f64::NAN,
        _ => March { sigma, p0, dx, ends, opens: false }.flow(),
    }
}

/// A march over cells in which something flows at every pressure above that at which the seal closes.
pub(super) struct March<'a> {
    pub(super) sigma: &'a Conductance,
    /// Contact pressure in the cells.
    pub(super) p0: &'a [f64],
    pub(super) dx: f64,
    pub(super) ends: [f64; 2],
    /// Whether the fluid opens the contact.
    pub(super) opens: bool,
}

impl March<'_> {
    /// The pressures at the ends of the cells, inlet first, that belong to a flow.
    fn pressures(&self, flow: f64) -> Vec<f64> {
        let mut pressure = vec![self.ends[1]];
        for p0 in self.p0.iter().rev() {
            let cell = Cell::new(self, *p0);
            pressure.push(cell.rise(pressure[pressure.len() - 1], flow * self.dx));
        }
        pressure.reverse();
        pressure
    }

    /// The flow with which the march arrives at the inlet.
    fn flow(&self) -> f64 {
        let [inlet, outlet] = self.ends;
        let missed = |log: f64| ((self.pressures(log.exp())[0] - outlet) / (inlet - outlet)).ln();
        // In a single cell as wide as all of them the flow would be this.
        let alone =
            |p0: &f64| (Cell::new(self, *p0).through(outlet, inlet) / (self.dx * self.p0.len() as f64)).ln();
        let all = self.p0.iter().map(alone);
        let [mut low, mut high] =
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], flow| [low.min(flow), high.max(flow)]);
        let (mut under, mut over) = (missed(low), missed(high));
        for step in (0..64).map(|n| f64::from(1 << n.min(9))) {
            if under > 0.0 {
                (high, over) = (low, under);
                low -= step;
                under = missed(low);
            } else if over < 0.0 {
                (low, under) = (high, over);
                high += step;
                over = missed(high);
            }
        }
        // Illinois: an end that stays counts half.
        for _ in 0..MARCHES {
            if high - low <= ARRIVED {
                break;
            }
            let chord = (low * over - high * under) / (over - under);
            let middle = if chord > low && chord < high { chord } else { 0.5 * (low + high) };
            let off = missed(middle);
            if off.abs() <= ARRIVED {
                return middle.exp();
            }
            if off > 0.0 {
                (high, over, under) = (middle, off, 0.5 * under);
            } else {
                (low, under, over) = (middle, off, 0.5 * over);
            }
        }
        (0.5 * (low + high)).exp()
    }
}

/// A cell of a march.
pub(super) struct Cell<'a> {
    march: &'a March<'a>,
    p0: f64,
    /// The surface, where the fluid does not open it.
    held: Option<Pressed<'a>>,
}

impl<'a> Cell<'a> {
    pub(super) fn new(march: &'a March<'a>, p0: f64) -> Self {
        Cell { march, p0, held: (!march.opens).then(|| march.sigma.pressed(p0)) }
    }

    /// k at a pressure of the fluid.
    pub(super) fn k(&self, fluid: f64) -> f64 {
        self.held.unwrap_or_else(|| self.march.sigma.pressed(self.p0 - fluid)).flux(fluid)
    }

    /// Pressures of the fluid above `from` between which k is smooth, rising.
    fn breaks(&self, from: f64) -> impl Iterator<Item = f64> {
        let all = self.march.opens.then(|| self.march.sigma.breaks().map(|p| self.p0 - p));
        all.into_iter().flatten().filter(move |fluid| *fluid > from)
    }

    /// The integral of k over the pressure of the fluid.
    fn through(&self, from: f64, to: f64) -> f64 {
        self.parts(from, to).map(|[from, to]| self.integral(from, to)).sum()
    }

    /// The parts between two pressures of the fluid in which k is smooth.
    pub(super) fn parts(&self, from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> {
        let ends = self.breaks(from).take_while(move |fluid| *fluid < to).chain([to]);
        ends.scan(from, |low, high| Some([std::mem::replace(low, high), high]))
    }

    /// The pressure of the fluid from which the integral of k down to `from` is `amount`.
    fn rise(&self, from: f64, amount: f64) -> f64 {
        let (mut low, mut left) = (from, amount);
        // Beyond the last break sigma is constant.
        let mut step = 0.5 * (self.march.ends[0] - self.march.ends[1]);
        let mut breaks = self.breaks(from);
        while low.is_finite() {
            let high = breaks.next().unwrap_or_else(|| {
                step *= 2.0;
                low + step
            });
            if let Some(there) = self.within([low, high], left) {
                return there;
            }
            left -= self.integral(low, high);
            low = high;
        }
        low
    }

    /// The same between two pressures, by Newton's steps that stay between them; `None` where the integral over all is less.
    fn within(&self, [from, to]: [f64; 2], amount: f64) -> Option<f64> {
        let [mut low, mut high] = [from, to];
        let mut guess = from + amount / self.k(from);
        if !(guess > from && guess < to) {
            if self.integral(from, to) < amount {
                return None;
            }
            guess = 0.5 * (from + to);
        }
        for _ in 0..200 {
            let error = self.integral(from, guess) - amount;
            if error.abs() <= 1e-13 * amount {
                return Some(guess);
            }
            if error > 0.0 {
                high = guess
            } else {
                low = guess
            }
            let newton = guess - error / self.k(guess);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == guess {
                break;
            }
            guess = next;
        }
        // Where k falls, the guesses may have gone up to the end.
        (high < to).then_some(guess)
    }

    /// The integral of k where it is smooth.
    fn integral(&self, from: f64, to: f64) -> f64 {
        let [middle, half] = [0.5 * (from + to), 0.5 * (to - from)];
        half * GAUSS_8.iter().map(|(x, weight)| weight * self.k(middle + half * x)).sum::<f64>()
    }
}
