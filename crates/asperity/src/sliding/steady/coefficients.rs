//! The operator A of a free domain on a torus, from its influence coefficients.
//!
//! Coefficients that no two cells of the domain are apart by are free. On a torus longer than needed, with M cells to each
//! side, they go over smoothly into the mean of the coefficients of both ends,
//!
//! k(i) -> k̄ + (1 - s) (k(i) - k̄),    s from 0 at the domain's length to 1 at M,    k̄ = (k(-M) + k(M))/2,
//!
//! so that the torus has neither a jump nor an edge where its ends meet: those take the positive real part from the waves in
//! which the body is stiff.

use std::sync::atomic::AtomicBool;

use ndarray::Array2;

use super::operators::Stream;
use crate::convolution::torus::{Spectrum, Torus};
use crate::error::Result;
use crate::grid::Grid;
use crate::sliding::Direction;
use crate::sliding::influence::{Branch, Influence, Memory, influence};

/// The coefficients of a free domain.
pub(super) struct OnTorus {
    /// A over the relaxed compliance on the torus.
    pub(super) steady: Spectrum,
    /// The kernel of the loss over the relaxed compliance: its even part, between cells that are (i, j) apart.
    pub(super) loss: Array2<f64>,
}

/// The coefficients on a torus of `lengths`, which is longer than the `shortest` along the motion, or equal.
///
/// # Errors
/// [`Error::Interrupted`](crate::error::Error::Interrupted).
pub(super) fn on_torus(
    stream: &Stream,
    lengths: [usize; 2],
    shortest: [usize; 2],
    interrupt: Option<&AtomicBool>,
) -> Result<OnTorus> {
    let (grid, unit) = (&stream.simulation.grid, stream.streaming.relaxed());
    let [mx, my] = lengths;
    let along_y = stream.direction == Direction::Y;
    // Along y the coefficients are those of the turned grid along x.
    let (turned, [m, across]) = match along_y {
        false => (*grid, [mx, my]),
        true => (transposed(grid), [my, mx]),
    };
    let branches = stream
        .streaming
        .branches()
        .map(|(compliance, time)| Branch { compliance: compliance / unit, length: time * stream.velocity });
    let memory = Memory::new(stream.streaming.instantaneous() / unit, branches, turned.spacing()[0]);
    let reach = [m / 2, across / 2];
    let Influence { displacement: k, loss } = influence(&turned, reach, &memory, interrupt)?;
    let even = |i: usize, j: usize| {
        let row = &loss[j * (m + 1)..][..m + 1];
        0.5 * (row[m / 2 + i] + row[m / 2 - i])
    };
    let loss = Array2::from_shape_fn(grid.shape(), |(i, j)| if along_y { even(j, i) } else { even(i, j) });
    let row = |j: usize| &k[j * (m + 1)..][..m + 1];
    let least =
        if grid.is_line() { row(0).iter().fold(f64::INFINITY, |least, k| least.min(*k)) } else { 0.0 };
    let seen = match m > shortest[stream.direction.axis()] {
        true => turned.cells()[0],
        false => m / 2,
    };
    let mut torus = vec![0.0; mx * my];
    for j in 0..across {
        let from = row(j.min(across - j));
        // The place -m/2 stands for both ends: their mean keeps the real part of the spectrum positive.
        let end = 0.5 * (from[0] + from[m]);
        for i in 0..m {
            let distance = i.min(m - i);
            let value = if 2 * i == m { end } else { from[(i + m / 2) % m] };
            let value = if distance > seen {
                let beyond = (distance - seen) as f64 / (m / 2 - seen) as f64;
                end + (value - end) * (1.0 - smooth_step(beyond))
            } else {
                value
            };
            torus[if along_y { j * my + i } else { i * my + j }] = value - least;
        }
    }
    Ok(OnTorus { steady: Torus::new([mx, my], [mx, my]).transform(&torus), loss })
}

/// From 0 at 0 to 1 at 1, with three derivatives that are 0 at both ends.
fn smooth_step(t: f64) -> f64 {
    t * t * t * t * (35.0 - 84.0 * t + 70.0 * t * t - 20.0 * t * t * t)
}

/// The grid with x and y exchanged.
fn transposed(grid: &Grid) -> Grid {
    let ([nx, ny], [lx, ly]) = (grid.cells(), grid.size());
    Grid::new([ny, nx], [ly, lx]).unwrap_or(*grid)
}
