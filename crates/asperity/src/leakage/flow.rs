//! Flow of a liquid: pressure and leak for a unit pressure drop.
//!
//! ```text
//! P = 1 at the inlet, half a cell before the first row; P = 0 at the outlet, half a cell behind the last row
//! T = L/W sum over faces of t dP^2
//! ```
//!
//! Mobilities are relative to that of the critical gap. They are limited to 3e13: the resistance of such a cell is below rounding
//! in double precision. Cells with less than a millionth of the critical gap are closed ([`Passages`]).

use ndarray::{Array2, ArrayView2};

use super::network::{Network, harmonic};
use super::opening::{Opening, Sides};
use super::passages::{CellKind, Passages};
use super::solve::{FlowOptions, Previous};
use crate::error::{Result, positive};

/// Largest mobility, relative to that of the critical gap.
const LARGEST_MOBILITY: f64 = 3e13;

/// The flow of a liquid through a gap.
#[derive(Clone, Debug)]
pub struct Flow {
    /// T \[m^3\]; exactly 0 if the seal is tight.
    pub transmissivity: f64,
    /// Pressure over the pressure drop, 1 at the inlet to 0 at the outlet, shape (nx, ny); NaN in contact and in pockets.
    pub pressure: Array2<f64>,
    /// Iterations of the linear system.
    pub iterations: usize,
}

impl Flow {
    /// The gap of parallel plates with the same leak, T^(1/3) \[m\].
    pub fn hydraulic_gap(&self) -> f64 {
        libm::cbrt(self.transmissivity)
    }

    /// Q = T dP W/(12 mu L) \[m^3/s\] of a pressure drop \[Pa\] and a viscosity \[Pa s\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if either is not positive.
    pub fn leak_rate(&self, opening: &Opening, pressure_drop: f64, viscosity: f64) -> Result<f64> {
        leak_rate(self.transmissivity, opening, pressure_drop, viscosity)
    }
}

/// Q = T dP W/(12 mu L) \[m^3/s\] of a transmissivity T \[m^3\], a pressure drop \[Pa\] and a viscosity \[Pa s\].
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if drop or viscosity is not positive.
pub fn leak_rate(transmissivity: f64, opening: &Opening, pressure_drop: f64, viscosity: f64) -> Result<f64> {
    let drop = positive("pressure drop", pressure_drop, "Pa")?;
    let mu = positive("viscosity", viscosity, "Pa s")?;
    let [length, width] = opening.size();
    Ok(transmissivity * drop * width / (12.0 * mu * length))
}

/// Solves the flow of a liquid.
///
/// # Errors
/// [`Error::NotConverged`](crate::Error::NotConverged) if the iteration (used if the memory does not suffice for a factorisation)
/// does not converge.
pub fn liquid(opening: &Opening, passages: &Passages, options: &FlowOptions) -> Result<Flow> {
    liquid_after(opening, passages, options, &mut Previous::default())
}

/// The same after a flow through a gap that differs little.
pub(crate) fn liquid_after(
    opening: &Opening,
    passages: &Passages,
    options: &FlowOptions,
    previous: &mut Previous,
) -> Result<Flow> {
    let Some(constriction) = passages.constriction else {
        return Ok(Flow { transmissivity: 0.0, pressure: still(opening, passages, None), iterations: 0 });
    };
    let mobility = mobility(opening, passages, constriction.gap);
    let (conductance, iterations) = Channel::new(opening, &mobility).solve(previous, options)?;
    let [length, width] = opening.size();
    let transmissivity = constriction.gap.powi(3) * conductance * length / width;
    let pressure = still(opening, passages, Some((&mobility, &previous.x)));
    Ok(Flow { transmissivity, pressure, iterations })
}

/// (h/h_c)^3 of the cells through which fluid flows, 0 elsewhere.
pub(super) fn mobility(opening: &Opening, passages: &Passages, critical: f64) -> Vec<f64> {
    let relative = |(h, kind): (&f64, &CellKind)| match h / critical {
        ratio if *kind == CellKind::Through => (ratio * ratio * ratio).min(LARGEST_MOBILITY),
        _ => 0.0,
    };
    opening.gap.iter().zip(&passages.kinds).map(relative).collect()
}

/// The network with inlet and outlet.
pub(super) struct Channel {
    pub network: Network,
    /// Conductances of the half cells to inlet and outlet.
    inlet: Vec<f64>,
    outlet: Vec<f64>,
    b: Vec<f64>,
}

impl Channel {
    pub fn new(opening: &Opening, mobility: &[f64]) -> Channel {
        let [n, m] = opening.cells;
        let aspect = opening.spacing[1] / opening.spacing[0];
        let wraps = [false, opening.sides == Sides::Periodic];
        let mut network = Network::of(opening.cells, opening.spacing, wraps, mobility);
        let half =
            |row: usize| mobility[row * m..][..m].iter().map(|k| 2.0 * aspect * k).collect::<Vec<f64>>();
        let (inlet, outlet) = (half(0), half(n - 1));
        let mut b = vec![0.0; n * m];
        for j in 0..m {
            network.ground[j] += inlet[j];
            network.ground[(n - 1) * m + j] += outlet[j];
        }
        b[..m].copy_from_slice(&inlet[..m]);
        Channel { network, inlet, outlet, b }
    }

    /// Solves for the pressure, which `previous` then holds; returns the conductance, which is the power for a unit drop.
    pub fn solve(&self, previous: &mut Previous, options: &FlowOptions) -> Result<(f64, usize)> {
        let last = self.b.len() - self.outlet.len();
        let power = |x: &[f64]| -> f64 {
            let at_inlet: f64 = self.inlet.iter().zip(x).map(|(t, x)| t * (1.0 - x).powi(2)).sum();
            let at_outlet: f64 = self.outlet.iter().zip(&x[last..]).map(|(t, x)| t * x * x).sum();
            self.network.power(x, [0.0; 2]) + at_inlet + at_outlet
        };
        previous.solve(&self.network, &self.b, &power, options)
    }
}

/// The pressure everywhere, from that of the cells through which fluid flows.
pub(super) fn still(
    opening: &Opening,
    passages: &Passages,
    flowing: Option<(&[f64], &[f64])>,
) -> Array2<f64> {
    let value = |(cell, kind): (usize, &CellKind)| match kind {
        CellKind::Through => match flowing {
            Some((mobility, x)) if mobility[cell] > 0.0 => x[cell].clamp(0.0, 1.0),
            _ => f64::NAN,
        },
        CellKind::AtInlet => 1.0,
        CellKind::AtOutlet => 0.0,
        CellKind::Closed | CellKind::Pocket => f64::NAN,
    };
    let pressure: Vec<f64> = passages.kinds.iter().enumerate().map(value).collect();
    opening.turned_back(&pressure)
}

/// |h^3 grad P| of each cell, for figures: the mean over its faces, with `size` the lengths of the domain \[m\], the gap \[m\] and
/// the pressure (NaN if there is none), shape (nx, ny).
pub fn flux(size: [f64; 2], gap: ArrayView2<'_, f64>, pressure: ArrayView2<'_, f64>) -> Array2<f64> {
    let (nx, ny) = gap.dim();
    let [dx, dy] = [size[0] / nx as f64, size[1] / ny as f64];
    let face = |a: (usize, usize), b: (usize, usize), distance: f64| {
        let drop = pressure[a] - pressure[b];
        if drop.is_nan() { 0.0 } else { harmonic(gap[a].powi(3), gap[b].powi(3)) * drop / distance }
    };
    // A face at the border has no neighbour: the opposite face is used for both.
    let mean = |before: Option<f64>, after: Option<f64>| match (before, after) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (one, other) => one.or(other).unwrap_or(0.0),
    };
    Array2::from_shape_fn((nx, ny), |(i, j)| {
        if pressure[(i, j)].is_nan() {
            return f64::NAN;
        }
        let x = mean(
            (i > 0).then(|| face((i - 1, j), (i, j), dx)),
            (i + 1 < nx).then(|| face((i, j), (i + 1, j), dx)),
        );
        let y = mean(
            (j > 0).then(|| face((i, j - 1), (i, j), dy)),
            (j + 1 < ny).then(|| face((i, j), (i, j + 1), dy)),
        );
        x.hypot(y)
    })
}
