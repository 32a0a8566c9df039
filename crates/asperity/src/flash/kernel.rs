//! The temperature that a cell of unit heat flux leaves on the surface of a half-space over which it moves.
//!
//! A point source of power Q that moves along +x over the body heats the surface around it, in its own frame, by
//!
//! T = Q exp(-v (r + x)/2χ)/(2π k r)                                     (Carslaw & Jaeger, Conduction of Heat in Solids, 10.7)
//!
//! Over a cell a < x < b, c < y < d the sum over the moments since which the heat has spread, s = √(4χt), has neither a singularity
//! nor an exponential that overflows, and is a product in x and y for each s:
//!
//! T = 1/(4k√π) ∫ ds [erf((b + vt)/s) - erf((a + vt)/s)] [erf(d/s) - erf(c/s)]
//!
//! vt/s = v s/4χ. One rule for s serves all cells. On a line of cells the second bracket is 2.

use std::f64::consts::PI;

use libm::erf;
use rayon::prelude::*;

use crate::grid::Grid;
use crate::kernel::gauss::GAUSS_8;

/// Relative length of a panel; the brackets are smooth functions of ln s.
const GROWTH: f64 = 0.35;
/// Edges of the passing source, of width 1/a in s, are resolved, down to this share of the passage of a cell.
const FINEST: f64 = 1.0 / 16.0;
/// erf(x) is 1 beyond this x.
const FLAT: f64 = 6.0;
/// The moments end here, over the length of the domain, for a source that stands still.
const LONG: f64 = 1e6;
/// Nodes that are summed up together.
const TOGETHER: usize = 512;

/// Source and cell, as far as the body that it moves over sees them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    /// v/2χ \[1/m\], 0 or more.
    pub(super) advection: f64,
    /// Cells along the motion and across it, and their sides \[m\].
    pub(super) cells: [usize; 2],
    pub(super) sides: [f64; 2],
    /// Whether the cells are a line along the motion.
    pub(super) is_line: bool,
}

impl Source {
    /// A source that moves along `axis` of the grid.
    pub(super) fn new(grid: &Grid, axis: usize, advection: f64) -> Self {
        let (cells, sides) = (grid.cells(), grid.spacing());
        let turned = [axis, 1 - axis];
        Source {
            advection,
            cells: turned.map(|n| cells[n]),
            sides: turned.map(|n| sides[n]),
            is_line: grid.is_line(),
        }
    }

    /// k T at the middle of a cell that lies i cells before the source and j beside it, of unit heat flux: at
    /// `(i + cells - 1) * across + j`, -cells < i < cells, 0 <= j < across.
    pub(super) fn influence(&self) -> Vec<f64> {
        let ([along, across], [dx, dy]) = (self.cells, self.sides);
        let mut sum = vec![0.0; (2 * along - 1) * across];
        let nodes = self.nodes();
        for nodes in nodes.chunks(TOGETHER) {
            let beside: Vec<f64> = nodes
                .iter()
                .flat_map(|(s, weight)| (0..across).map(move |j| (j as f64, *s, *weight)))
                .map(|(j, s, weight)| weight * if self.is_line { 2.0 } else { bracket(j * dy, dy, s) })
                .collect();
            sum.par_chunks_mut(across).enumerate().for_each(|(i, row)| {
                let x = (i as f64 - (along - 1) as f64) * dx;
                for ((s, _), beside) in nodes.iter().zip(beside.chunks(across)) {
                    let share = bracket(x + 0.5 * self.advection * s * s, dx, *s);
                    if share > 0.0 {
                        row.iter_mut().zip(beside).for_each(|(sum, beside)| *sum += share * beside);
                    }
                }
            });
        }
        // Of later moments a source that stands still leaves 4 dx dy/(π s²).
        let end = nodes.last().map_or(f64::INFINITY, |node| node.0);
        let later = if self.is_line { 0.0 } else { 4.0 * dx * dy / (PI * end) };
        let later = later * libm::exp(-0.25 * (self.advection * end).powi(2));
        sum.iter_mut().for_each(|sum| *sum = (*sum + later) / (4.0 * PI.sqrt()));
        sum
    }

    /// Nodes and weights in s, from 0 to where nothing of the source is left on the domain.
    fn nodes(&self) -> Vec<(f64, f64)> {
        let ([along, _], [dx, dy], a) = (self.cells, self.sides, self.advection);
        let (way, length) = (along as f64 * dx, (along as f64 * dx).max(self.cells[1] as f64 * dy));
        // The edges of cells pass the source when a s²/2 = (m + 1/2) dx.
        let passage = |m: f64| (2.0 * (m + 0.5) * dx / a).sqrt();
        let mut nodes = vec![];
        let mut from = 0.0;
        let first = dx.min(if self.is_line { dx } else { dy }) / (4.0 * FLAT);
        let mut next = if a > 0.0 { first.min(FINEST * passage(0.0)) } else { first };
        loop {
            let to = next;
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            nodes.extend(GAUSS_8.iter().map(|(x, w)| (middle + half * x, half * w)));
            let is_past = 0.5 * a * to * to - way > FLAT * to;
            if is_past || to > LONG * length {
                // A node at the end, without weight.
                nodes.push((to, 0.0));
                return nodes;
            }
            from = to;
            let grown = (1.0 + GROWTH) * to;
            next = grown;
            if a > 0.0 {
                let m = (0.5 * a * to * to / dx - 0.5).floor() + 1.0;
                let m = if passage(m) > to * (1.0 + 1e-9) { m } else { m + 1.0 };
                let (edge, passing) = (passage(m), passage(m) - if m > 0.0 { passage(m - 1.0) } else { 0.0 });
                let is_sharp = FINEST * passing > 2.0 / a;
                let fine = to + (2.0 / a).max(FINEST * passing);
                // Resolved edges need no panel that ends with them.
                next = if is_sharp { fine.min(edge) } else { fine }.min(grown);
            }
        }
    }
}

/// erf((x + side/2)/s) - erf((x - side/2)/s), 0 where both are 1.
fn bracket(x: f64, side: f64, s: f64) -> f64 {
    let (low, high) = ((x - 0.5 * side) / s, (x + 0.5 * side) / s);
    if low > FLAT || high < -FLAT {
        return 0.0;
    }
    match low > 0.5 {
        true => libm::erfc(low) - libm::erfc(high),
        false if high < -0.5 => libm::erfc(-high) - libm::erfc(-low),
        false => erf(high) - erf(low),
    }
}
