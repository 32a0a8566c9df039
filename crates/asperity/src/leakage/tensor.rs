//! The effective conductance of a gap that is periodic in both directions.
//!
//! ```text
//! div(h^3 (e_k + grad chi_k)) = 0, chi_k periodic;   K_jk = mean of h^3 (e_j . (e_k + grad chi_k)) \[m^3\]
//! ```
//!
//! for k = x, y, so that the flow per width under a gradient is -K grad P/(12 mu). Only parts of the gap that wind around the
//! torus carry flow. The others are left out, so K is exactly 0 if no part winds around.

use super::network::Network;
use super::opening::Opening;
use super::solve::{FlowOptions, Inverse, solve};
use crate::error::Result;
use asperity_sweep::add;

/// K \[m^3\], rows and columns x, y.
///
/// The sides of the opening are ignored: the gap is periodic in both directions.
///
/// # Errors
/// [`Error::NotConverged`](crate::Error::NotConverged) as for a [`liquid`](super::liquid).
pub fn conductance(opening: &Opening, options: &FlowOptions) -> Result<[[f64; 2]; 2]> {
    let scale = opening.largest();
    if scale == 0.0 {
        return Ok([[0.0; 2]; 2]);
    }
    let mobility: Vec<f64> = opening.gap.iter().map(|h| (h / scale).powi(3)).collect();
    let network = Network::of(opening.cells, opening.spacing, [true; 2], &mobility);
    let aspect = opening.spacing[1] / opening.spacing[0];
    let [[a, b], [c, d]] = network_conductance(network, options)?;
    let unit = scale.powi(3);
    let (a, b, c, d) = (a / aspect * unit, b * unit, c * unit, d * aspect * unit);
    Ok(match opening.direction {
        super::Direction::X => [[a, b], [c, d]],
        super::Direction::Y => [[d, c], [b, a]],
    })
}

/// A conductance below this fraction of that in the other direction counts as 0.
const NOTHING: f64 = 1e-28;

/// Conductance of a network on a torus per cell: mean flux per face in direction j under a drop of 1 per cell in direction k.
pub(super) fn network_conductance(mut network: Network, options: &FlowOptions) -> Result<[[f64; 2]; 2]> {
    let [n, m] = network.cells;
    if !keep_winding(&mut network) {
        return Ok([[0.0; 2]; 2]);
    }
    let mut inverse = Inverse::new(&network, options);
    let mut corrector = |drop: [f64; 2]| -> Result<(Vec<f64>, f64)> {
        // The inflow of each cell due to the prescribed drop.
        let mut b = vec![0.0; n * m];
        network.each(&mut b, |i, j, _| {
            let [(above, _), (before, _), (after, _), (below, _)] = network.faces(i, j);
            drop[0] * (above - below) + drop[1] * (before - after)
        });
        let mut chi = vec![0.0; n * m];
        let power = |chi: &[f64]| network.power(chi, drop);
        let (power, _) = solve(&network, &mut inverse, &b, &mut chi, &power, options)?;
        Ok((chi, power))
    };
    let (mut chi, xx) = corrector([1.0, 0.0])?;
    let (other, yy) = corrector([0.0, 1.0])?;
    add(&mut chi, 1.0, &other);
    // Powers have errors that are quadratic in those of chi, also that of both drops together, xx + 2 xy + yy.
    let xy = 0.5 * (network.power(&chi, [1.0; 2]) - xx - yy);
    // In a direction in which nothing winds around the torus the power is the square of a rounding error.
    let none = NOTHING * xx.max(yy);
    let number = |k: f64| if k.abs() <= none { 0.0 } else { k / (n * m) as f64 };
    Ok([[xx, xy], [xy, yy]].map(|row| row.map(number)))
}

/// Keeps only the parts of a torus that wind around it. Each is grounded at its first cell (which carries no current, because the
/// sources of a part add up to 0). Returns whether there are any.
fn keep_winding(network: &mut Network) -> bool {
    let [n, m] = network.cells;
    let mut parts = Winding::new(n * m);
    for i in 0..n {
        for j in 0..m {
            let here = i * m + j;
            if network.along[here] > 0.0 {
                let wraps = i32::from(i + 1 == n);
                parts.join(here, ((i + 1) % n) * m + j, [wraps, 0]);
            }
            if network.across[here] > 0.0 {
                let wraps = i32::from(j + 1 == m);
                parts.join(here, i * m + (j + 1) % m, [0, wraps]);
            }
        }
    }
    let winds: Vec<bool> = (0..n * m)
        .map(|cell| {
            let root = parts.root(cell).0;
            parts.winds[root]
        })
        .collect();
    for cell in (0..n * m).filter(|cell| !winds[*cell]) {
        network.along[cell] = 0.0;
        network.across[cell] = 0.0;
    }
    let diagonal = network.diagonal();
    for cell in (0..n * m).filter(|cell| winds[*cell] && parts.root(*cell).0 == *cell) {
        network.ground[cell] = diagonal[cell];
    }
    winds.contains(&true)
}

/// Connected parts of a torus, with the number of times that the path from each cell to the first cell of its part wraps around.
struct Winding {
    parent: Vec<usize>,
    /// Turns from the parent to the cell.
    turns: Vec<[i32; 2]>,
    winds: Vec<bool>,
}

impl Winding {
    fn new(cells: usize) -> Winding {
        Winding { parent: (0..cells).collect(), turns: vec![[0; 2]; cells], winds: vec![false; cells] }
    }

    /// First cell of the part, and the turns from it.
    fn root(&mut self, cell: usize) -> (usize, [i32; 2]) {
        let (mut at, mut turns) = (cell, [0; 2]);
        while self.parent[at] != at {
            let up = self.parent[at];
            // Halve the path on the way.
            let (over, more) = (self.parent[up], self.turns[up]);
            if over != up {
                self.parent[at] = over;
                self.turns[at] = sum(self.turns[at], more);
            }
            turns = sum(turns, self.turns[at]);
            at = self.parent[at];
        }
        (at, turns)
    }

    /// Joins the parts of two cells; from a to b the path makes these turns.
    fn join(&mut self, a: usize, b: usize, step: [i32; 2]) {
        let ((first, from_first), (second, from_second)) = (self.root(a), self.root(b));
        // From the first cell of a's part to that of b's: to a, over to b, back.
        let between = sum(sum(from_first, step), from_second.map(|t| -t));
        if first == second {
            self.winds[first] |= between != [0; 2];
            return;
        }
        let winds = self.winds[first] || self.winds[second];
        let (root, child, turns) =
            if first < second { (first, second, between) } else { (second, first, between.map(|t| -t)) };
        self.parent[child] = root;
        self.turns[child] = turns;
        self.winds[root] = winds;
    }
}

fn sum(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}
