//! The connected open cells, and the constriction that determines the leak.
//!
//! Cells that share an edge are connected; if the sides are periodic, so are the cells at opposite sides. Open cells belong to
//! passages from inlet to outlet, to dead ends at one of them, or to pockets. The critical constriction is found by opening the
//! cells in order of decreasing gap until inlet and outlet are connected: the cell that connects them has the largest gap that
//! every path must pass (bottleneck path; B. N. J. Persson & C. Yang, J. Phys.: Condens. Matter 20 (2008) 315011). Cells with less than a
//! millionth of it are closed: their conductance is below 1e-18 of its own, and what lies behind them is a pocket.

use ndarray::Array2;
use rayon::prelude::*;

use super::opening::{Opening, Sides};
use crate::spots::Forest;

/// Smallest gap of an open cell, relative to the critical one.
const NARROWEST: f64 = 1e-6;

/// The connections of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum CellKind {
    /// In contact, or closed.
    Closed = 0,
    /// Connected to inlet and outlet: fluid flows, or could.
    Through = 1,
    /// Connected only to the inlet, at its pressure.
    AtInlet = 2,
    /// Connected only to the outlet, at its pressure.
    AtOutlet = 3,
    /// Connected to neither.
    Pocket = 4,
}

/// The narrowest place of the widest path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constriction {
    /// Its gap \[m\].
    pub gap: f64,
    /// Its cell (i, j) on the grid.
    pub cell: [usize; 2],
    /// Its width in cells: the shortest row of open cells through it, along both axes and both diagonals; `None` if none of these
    /// rows ends at contact on both sides.
    pub width: Option<usize>,
}

/// The connected parts of an opening.
#[derive(Clone, Debug)]
pub struct Passages {
    /// The critical constriction; `None` if the seal is tight.
    pub constriction: Option<Constriction>,
    /// Area of the pockets \[m^2\].
    pub trapped_area: f64,
    /// Their volume \[m^3\].
    pub trapped_volume: f64,
    /// Kind of each cell, in the orientation of the opening.
    pub(super) kinds: Vec<CellKind>,
}

impl Passages {
    /// Finds the passages of an opening.
    pub fn of(opening: &Opening) -> Passages {
        let mut kinds = self::kinds(opening);
        let through = kinds.contains(&CellKind::Through);
        let constriction = if through { constriction(opening, &kinds) } else { None };
        let least = constriction.map_or(0.0, |constriction| NARROWEST * constriction.gap);
        if opening.gap.iter().any(|h| *h > 0.0 && *h < least) {
            let gap = opening.gap.iter().map(|h| if *h < least { 0.0 } else { *h }).collect();
            kinds = self::kinds(&Opening { gap, ..opening.clone() });
        }
        let cell_area = opening.spacing[0] * opening.spacing[1];
        let pockets = kinds.iter().zip(&opening.gap).filter(|(kind, _)| **kind == CellKind::Pocket);
        let (count, sum) = pockets.fold((0usize, 0.0), |(count, sum), (_, h)| (count + 1, sum + h));
        Passages {
            constriction,
            trapped_area: count as f64 * cell_area,
            trapped_volume: sum * cell_area,
            kinds,
        }
    }

    /// Fraction of the cells that are open.
    pub fn open_fraction(&self) -> f64 {
        self.kinds.iter().filter(|kind| **kind != CellKind::Closed).count() as f64 / self.kinds.len() as f64
    }

    /// Whether inlet and outlet are connected.
    pub fn percolates(&self) -> bool {
        self.constriction.is_some()
    }

    /// Kind of each cell, shape (nx, ny).
    pub fn map(&self, opening: &Opening) -> Array2<CellKind> {
        opening.turned_back(&self.kinds)
    }
}

/// The neighbours of a cell, also across the sides.
fn neighbours(opening: &Opening, cell: usize) -> impl Iterator<Item = usize> {
    let [n, m] = opening.cells;
    let (i, j) = (cell / m, cell % m);
    let wraps = opening.sides == Sides::Periodic && m > 1;
    let above = (i > 0).then(|| cell - m);
    let below = (i + 1 < n).then(|| cell + m);
    let before = if j > 0 { Some(cell - 1) } else { wraps.then(|| cell + m - 1) };
    let after = if j + 1 < m { Some(cell + 1) } else { wraps.then(|| cell + 1 - m) };
    [above, below, before, after].into_iter().flatten()
}

/// Kind of each cell, from the connected parts and the borders that they reach.
fn kinds(opening: &Opening) -> Vec<CellKind> {
    let [n, m] = opening.cells;
    let open = |cell: usize| opening.gap[cell] > 0.0;
    let wraps = [false, opening.sides == Sides::Periodic];
    let mut forest = Forest::of([n, m], wraps, |i, j| open(i * m + j));
    let mut reaches = vec![0u8; n * m];
    for j in 0..m {
        let (first, last) = (j, (n - 1) * m + j);
        if open(first) {
            reaches[forest.root(first)] |= 1;
        }
        if open(last) {
            reaches[forest.root(last)] |= 2;
        }
    }
    let kind = |cell: usize| match (open(cell), reaches[forest.root(cell)]) {
        (false, _) => CellKind::Closed,
        (true, 3) => CellKind::Through,
        (true, 1) => CellKind::AtInlet,
        (true, 2) => CellKind::AtOutlet,
        (true, _) => CellKind::Pocket,
    };
    (0..n * m).map(kind).collect()
}

/// Opens the passages in order of decreasing gap, equal gaps in C-order.
fn constriction(opening: &Opening, kinds: &[CellKind]) -> Option<Constriction> {
    let [n, m] = opening.cells;
    let (inlet, outlet) = (n * m, n * m + 1);
    // The bits of positive numbers increase with the numbers.
    let mut order: Vec<(u64, usize)> = (0..n * m)
        .into_par_iter()
        .filter(|cell| kinds[*cell] == CellKind::Through)
        .map(|cell| (!opening.gap[cell].to_bits(), cell))
        .collect();
    order.par_sort_unstable();
    let mut forest = Forest::new(n * m + 2);
    let mut opened = vec![false; n * m];
    for (_, cell) in order {
        opened[cell] = true;
        neighbours(opening, cell).filter(|other| opened[*other]).for_each(|other| forest.join(other, cell));
        if cell < m {
            forest.join(cell, inlet);
        }
        if cell >= (n - 1) * m {
            forest.join(cell, outlet);
        }
        if forest.root(inlet) == forest.root(outlet) {
            let (gap, width) = (opening.gap[cell], width(opening, cell));
            return Some(Constriction { gap, cell: opening.cell(cell), width });
        }
    }
    None
}

/// The shortest open row through a cell, along both axes and both diagonals, in cell widths. A row that ends at the border of the
/// domain is not bounded by contact, and does not count.
fn width(opening: &Opening, cell: usize) -> Option<usize> {
    let [n, m] = opening.cells.map(|cells| cells as isize);
    let (i, j) = (cell as isize / m, cell as isize % m);
    let wraps = opening.sides == Sides::Periodic;
    // Number of open cells from the next one to the first closed one; `None` if the row leaves the domain or returns to its
    // start.
    let count = |di: isize, dj: isize| {
        (1..n.max(m) + 1).find_map(|step| {
            let (i, j) = (i + step * di, j + step * dj);
            let j = if wraps { j.rem_euclid(m) } else { j };
            let inside = (0..n).contains(&i) && (0..m).contains(&j);
            match inside && opening.gap[(i * m + j) as usize] > 0.0 {
                true => None,
                false => Some(inside.then_some(step as usize - 1)),
            }
        })?
    };
    let rows = [
        ([1, 0], 1.0),
        ([0, 1], 1.0),
        ([1, 1], std::f64::consts::SQRT_2),
        ([1, -1], std::f64::consts::SQRT_2),
    ];
    let length = |([di, dj], cell): ([isize; 2], f64)| {
        let cells = 1 + count(di, dj)? + count(-di, -dj)?;
        Some((cells as f64 * cell) as usize)
    };
    rows.into_iter().filter_map(length).min()
}
