//! The influence coefficients of a half-space whose material streams by, for free domains.
//!
//! ```text
//! k_v = C0 k + Σ C_j k_j,    k_j(x) = ∫ e^(-s/l)/l k(x + s) ds over s > 0,    l = λ_j v
//! ```
//!
//! with k the coefficient of the elastic half-space as a function of x: the memory looks ahead, since the point below x was
//! earlier at x + s. On cells the integral goes backwards,
//!
//! k_j(x_i) = e^(-dx/l) k_j(x_(i+1)) + ∫ e^(-s/l)/l k(x_i + s) ds over 0 < s < dx,
//!
//! which is stable. What is lost per distance is the quadratic form of the even part of
//!
//! Σ C_j (k - k_j)/l_j = -∂k_v/∂x + C0 ∂k/∂x,
//!
//! since the derivative of k is odd. k has kinks x ln|x| at the ends of a cell, ±dx/2, towards which the panels of the quadrature are graded.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::contact::stop_at;
use crate::error::Result;
use crate::grid::Grid;
use crate::kernel::{love, strip_at};

/// Nodes and weights of the Gauss-Legendre rule of 12 points on [-1, 1], one half (Abramowitz & Stegun, table 25.4).
const GAUSS: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_77),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_5, 0.203_167_426_723_065_92),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_23),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_43),
    (0.981_560_634_246_719_3, 0.047_175_336_386_511_83),
];
/// Cells beside the kinks whose panels are graded.
const NEAR: i64 = 3;
/// Grading of the panels towards a kink, and their number.
const RATIO: f64 = 0.25;
const PANELS: i32 = 14;
/// e^(-45) is a rounding error.
const END: f64 = 45.0;

/// One branch: its compliance \[1/Pa\] and how far its memory reaches, l \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Branch {
    pub(super) compliance: f64,
    pub(super) length: f64,
}

/// A memory shorter than this share of a cell counts by its first moment alone.
const SHORT: f64 = 1e-4;

/// C0 and the branches of a body that streams by.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Memory {
    instantaneous: f64,
    branches: Vec<Branch>,
}

impl Memory {
    /// On cells of length `dx` \[m\]. A branch with l < l* = `SHORT` dx is replaced by one of length l* with the share l/l* of its
    /// compliance, the rest of which is instantaneous: k_j keeps its first moment, and its error is below l*² k''/4.
    pub(super) fn new(mut instantaneous: f64, branches: impl Iterator<Item = Branch>, dx: f64) -> Self {
        let mut short = Branch { compliance: 0.0, length: SHORT * dx };
        let mut kept = vec![];
        for branch in branches {
            if branch.length < short.length {
                let share = branch.length / short.length;
                instantaneous += (1.0 - share) * branch.compliance;
                short.compliance += share * branch.compliance;
            } else {
                kept.push(branch);
            }
        }
        kept.extend((short.compliance > 0.0).then_some(short));
        Memory { instantaneous, branches: kept }
    }
}

/// The coefficients at (i dx, j dy), -N <= i <= N with N = `reach`\[0\], 0 <= j <= `reach`\[1\], in rows of constant j: at
/// `j * (2 N + 1) + i + N`.
pub(super) struct Influence {
    /// k_v \[m/Pa\].
    pub(super) displacement: Vec<f64>,
    /// Σ C_j (k - k_j)/l_j \[1/Pa\].
    pub(super) loss: Vec<f64>,
}

/// The coefficients of a body.
///
/// Of a line contact a constant is free; that of k is chosen here as its value N cells away.
///
/// # Errors
/// [`Error::Interrupted`] soon after `interrupt` has become true.
pub(super) fn influence(
    grid: &Grid,
    reach: [usize; 2],
    memory: &Memory,
    interrupt: Option<&AtomicBool>,
) -> Result<Influence> {
    let [dx, dy] = grid.spacing();
    let (n, rows) = (reach[0], reach[1] + 1);
    let mut all = [0, 1].map(|_| vec![0.0; (2 * n + 1) * rows]);
    let far = strip_at(n as f64 * dx, dx);
    let quadrature = Quadrature::new(dx, memory);
    let [displacement, loss] = all.each_mut().map(|all| all.par_chunks_mut(2 * n + 1));
    displacement.zip(loss).enumerate().try_for_each(|(j, rows)| {
        let y = j as f64 * dy;
        let k = |x: f64| if grid.is_line() { strip_at(x, dx) - far } else { love(x, y, [dx, dy]) };
        quadrature.fill(rows, &k, interrupt)
    })?;
    let [displacement, loss] = all;
    Ok(Influence { displacement, loss })
}

/// Cells after which an interruption is looked for.
const WATCH: i64 = 512;

/// What the integrals over all cells share.
struct Quadrature<'a> {
    dx: f64,
    instantaneous: f64,
    branches: &'a [Branch],
    /// Of cells beside the kinks, and of all others.
    rules: [Rule; 2],
}

/// The nodes in one cell.
struct Rule {
    panels: Vec<(f64, f64)>,
    /// s, 0 < s < dx.
    places: Vec<f64>,
    /// The weights of a place times e^(-s/l), for each branch.
    weights: Vec<Vec<f64>>,
}

impl Rule {
    fn new(panels: Vec<(f64, f64)>, branches: &[Branch]) -> Self {
        let mut nodes = vec![];
        panels.iter().for_each(|(a, b)| gauss(*a, *b, |s, weight| nodes.push((s, weight))));
        let of = |branch: &Branch| nodes.iter().map(|(s, w)| w * libm::exp(-s / branch.length)).collect();
        Rule {
            weights: branches.iter().map(of).collect(),
            places: nodes.iter().map(|(s, _)| *s).collect(),
            panels,
        }
    }
}

impl<'a> Quadrature<'a> {
    fn new(dx: f64, Memory { instantaneous, branches }: &'a Memory) -> Self {
        let rules = [true, false].map(|near| Rule::new(panels(near, dx), branches));
        Quadrature { dx, instantaneous: *instantaneous, branches, rules }
    }

    /// C0 k + Σ C_j k_j and Σ C_j (k - k_j)/l_j of a row.
    fn fill(
        &self,
        (row, loss): (&mut [f64], &mut [f64]),
        k: &impl Fn(f64) -> f64,
        interrupt: Option<&AtomicBool>,
    ) -> Result<()> {
        let (dx, n) = (self.dx, (row.len() / 2) as i64);
        let decays: Vec<f64> = self.branches.iter().map(|b| libm::exp(-dx / b.length)).collect();
        let mut ahead: Vec<f64> =
            self.branches.iter().map(|b| self.ahead(n as f64 * dx, b.length, k)).collect();
        let mut values = vec![];
        for i in (-n..=n).rev() {
            if i % WATCH == 0 {
                stop_at(interrupt)?;
            }
            let x = i as f64 * dx;
            let (to, lost) = (&mut row[(i + n) as usize], &mut loss[(i + n) as usize]);
            let own = k(x);
            *to = self.instantaneous * own;
            let rule = &self.rules[usize::from(!(-1 - NEAR..=NEAR).contains(&i))];
            if i < n && !self.branches.is_empty() {
                values.clear();
                values.extend(rule.places.iter().map(|s| k(x + s)));
            }
            for (b, Branch { compliance, length: l }) in self.branches.iter().enumerate() {
                if i < n {
                    let gained = if *l >= 0.5 * dx {
                        rule.weights[b].iter().zip(&values).map(|(w, k)| w * k).sum::<f64>() / l
                    } else {
                        within(x, *l, &rule.panels, k)
                    };
                    ahead[b] = decays[b] * ahead[b] + gained;
                }
                *to += compliance * ahead[b];
                *lost += compliance * (own - ahead[b]) / l;
            }
        }
        Ok(())
    }

    /// ∫ e^(-s/l)/l k(x + s) ds over s > 0 where k is smooth ahead of x.
    fn ahead(&self, x: f64, l: f64, k: &impl Fn(f64) -> f64) -> f64 {
        let (mut sum, mut start, mut panel) = (0.0, 0.0, (0.5 * x).min(l));
        while start < END * l {
            let end = (start + panel).min(END * l);
            gauss(start, end, |s, weight| sum += weight * libm::exp(-s / l) * k(x + s));
            (start, panel) = (end, (1.5 * panel).min(2.0 * l));
        }
        sum / l
    }
}

/// ∫ e^(-s/l)/l k(x + s) ds over a cell that is long against l.
fn within(x: f64, l: f64, panels: &[(f64, f64)], k: &impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for (a, b) in panels {
        let (mut start, end) = (*a, b.min(END * l));
        while start < end {
            let stop = (start + 2.0 * l).min(end);
            gauss(start, stop, |s, weight| sum += weight * libm::exp(-s / l) * k(x + s));
            start = stop;
        }
    }
    sum / l
}

/// The panels of a cell i, 0 < s < dx: two halves; `near` the kinks graded towards the middle. The kinks at x = -dx/2 and dx/2
/// are the middles of the cells -1 and 0; those beside them are graded too, which costs little.
fn panels(near: bool, dx: f64) -> Vec<(f64, f64)> {
    let middle = 0.5 * dx;
    if !near {
        return vec![(0.0, middle), (middle, dx)];
    }
    let widths: Vec<f64> = (1..=PANELS).map(|k| middle * RATIO.powi(k)).collect();
    let below = widths.iter().map(|width| middle - width);
    let above = widths.iter().rev().map(|width| middle + width);
    let ends: Vec<f64> = [0.0].into_iter().chain(below).chain([middle]).chain(above).chain([dx]).collect();
    ends.windows(2).map(|pair| (pair[0], pair[1])).collect()
}

/// Calls `at(s, weight)` for the nodes of a panel.
fn gauss(a: f64, b: f64, mut at: impl FnMut(f64, f64)) {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    for (node, weight) in GAUSS {
        at(middle - half * node, half * weight);
        at(middle + half * node, half * weight);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A branch of unit compliance.
    fn one(length: f64, grid: &Grid) -> Memory {
        Memory::new(0.0, [Branch { compliance: 1.0, length }].into_iter(), grid.spacing()[0])
    }

    /// ∫ e^(-s/l)/l k(x + s) ds by a fine midpoint rule in t = e^(-s/l) away from the kinks.
    fn slow(k: &dyn Fn(f64) -> f64, x: f64, l: f64) -> f64 {
        let n = 400_000;
        (0..n).map(|m| k(x - l * ((m as f64 + 0.5) / n as f64).ln())).sum::<f64>() / n as f64
    }

    #[test]
    fn the_recursion_is_the_integral() {
        for grid in [Grid::new([8, 8], [8.0, 4.0]).unwrap(), Grid::line(8, 8.0).unwrap()] {
            for l in [0.02, 0.3, 1.0, 7.0, 300.0] {
                let n = 8;
                let found = influence(&grid, [n, 3], &one(l, &grid), None).unwrap().displacement;
                for (i, j) in [(-8_i64, 0_usize), (-3, 2), (0, 0), (-1, 0), (1, 1), (8, 3)] {
                    let j = if grid.is_line() { 0 } else { j };
                    let dy = grid.spacing()[1];
                    let k = |x: f64| match grid.is_line() {
                        true => strip_at(x, 1.0) - strip_at(8.0, 1.0),
                        false => love(x, j as f64 * dy, [1.0, dy]),
                    };
                    let exact = slow(&k, i as f64, l);
                    let value = found[j * (2 * n + 1) + (i + n as i64) as usize];
                    // the midpoint rule's error, of coefficients of order 1
                    assert!((value - exact).abs() < 3e-5, "{i} {j} l = {l}: {value} {exact}");
                }
            }
        }
    }

    #[test]
    fn a_short_memory_is_the_elastic_body_and_a_long_one_none() {
        let grid = Grid::new([4, 4], [4.0, 4.0]).unwrap();
        let of = |l: f64| influence(&grid, [4, 0], &one(l, &grid), None).unwrap().displacement;
        let short = of(1e-6);
        assert!((short[4] - love(0.0, 0.0, [1.0, 1.0])).abs() < 1e-5);
        assert!(of(1e9).iter().all(|k| k.abs() < 1e-6));
    }

    #[test]
    fn an_interruption_is_seen_while_coefficients_are_computed() {
        let (grid, flag) = (Grid::new([4, 4], [4.0, 4.0]).unwrap(), AtomicBool::new(true));
        let stopped = influence(&grid, [1 << 14, 8], &one(1.0, &grid), Some(&flag));
        assert!(matches!(stopped, Err(crate::error::Error::Interrupted)));
    }
}
