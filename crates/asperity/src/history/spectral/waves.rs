//! Waves that relax differently: each wave of the displacement is a viscoelastic body of its own.
//!
//! On the torus of the convolution every wave k has a creep function C_k(t), and the relaxation function that belongs to it,
//! E_k(t) = E_inf + Σ E_i exp(-t/τ_i), with times of its own. Over a step in which u runs from its value at the start (0) to that
//! at the end (1) as r(s), the rules of [`super::super::relaxation::rules`] hold for each wave:
//!
//! ```text
//! q_i' = E q_i + (1 - E - γ_i) u_n + γ_i u_(n+1),    E = exp(-x/τ_i)
//! u_(n+1) = (p_(n+1) + h)/e,    e = E_inf + Σ E_i (1 - γ_i),    h = Σ E_i [E q_i + (1 - E - γ_i) u_n]
//! ```
//!
//! E, γ_i and 1 - γ_i are functions of τ_i alone. They are tabulated over ln τ once for each step.

use ndarray::Array2;
use rayon::prelude::*;
use rustfft::num_complex::Complex64;

use crate::error::{Error, Result};
use crate::grid::{Boundary, Grid};
use crate::history::relaxation::rules::Share;
use crate::kernel::Kernel;
use crate::layer::{NonseparableLayers, TOLERANCE};
use crate::operator::{eigenvalues, torus, wide};

/// Spacing of ln τ in the tables: six points interpolate to 1e-9.
const SPACING: f64 = 0.04;
/// Nodes of the table before the shortest time.
const BEFORE: f64 = 2.0;
/// Share of the largest compliance of a wave below which a uniform pressure moves nothing.
const NO_YIELD: f64 = 1e-2;
/// Cells along a side on which a case is checked before it runs.
const COARSE: usize = 48;

/// A term E_i exp(-t/τ_i) of a wave.
#[derive(Clone, Copy, Debug)]
struct Term {
    modulus: f64,
    /// Of ln τ in the tables.
    place: f64,
}

/// Which torus the waves are of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Width {
    /// That of the convolution.
    Narrow,
    /// The wide one of a free domain, on which the kernel fades out smoothly.
    Wide,
}

/// The relaxation functions of the waves of a torus.
pub(super) struct Waves {
    /// mx, my.
    pub(super) lengths: [usize; 2],
    pub(super) width: Width,
    /// ln τ of the first node of the tables, and their nodes.
    first: f64,
    nodes: usize,
    /// Terms of each wave, one at least; those that a wave does not have are 0.
    pub(super) terms: usize,
    /// E_inf \[Pa/m\] of a quarter of the waves, \[kx\]\[ky\]; infinite for a wave that yields to nothing.
    equilibrium: Vec<f64>,
    /// \[kx\]\[ky\]\[term\].
    relaxing: Vec<Term>,
}

/// What a step does to a state, by its relaxation time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table(pub(super) Vec<[f64; 3]>);

/// E, γ and 1 - γ of a state.
#[derive(Clone, Copy, Default)]
struct Rule {
    keep: f64,
    new: f64,
    left: f64,
}

impl Table {
    fn at(&self, place: f64) -> Rule {
        if self.0.is_empty() {
            // No time passes.
            return Rule { keep: 1.0, new: 0.0, left: 1.0 };
        }
        let n = (place as usize).clamp(BEFORE as usize, self.0.len() - 4) - BEFORE as usize;
        let t = place - n as f64 - BEFORE;
        let [a, b, c, d, e, f] = [t + 2.0, t + 1.0, t, t - 1.0, t - 2.0, t - 3.0];
        let (ab, ef) = (a * b, e * f);
        let (left, right) = (ab * c, d * ef);
        let weights = [
            -b * c * right / 120.0,
            a * c * right / 24.0,
            -ab * right / 12.0,
            left * ef / 12.0,
            -left * d * f / 24.0,
            left * d * e / 120.0,
        ];
        let sum = |column: usize| weights.iter().zip(&self.0[n..n + 6]).map(|(w, row)| w * row[column]).sum();
        Rule { keep: sum(0), new: sum(1), left: sum(2) }
    }
}

impl Waves {
    /// Of a domain, and the displacement \[m\] of a cell under its own unit pressure at t = 0, times the modulus at the surface.
    ///
    /// # Errors
    /// [`Error::Invalid`] where a wave does not creep like a body, and as [`plan`](crate::operator::plan).
    pub(super) fn new(grid: &Grid, boundary: Boundary, layers: &NonseparableLayers) -> Result<(Self, f64)> {
        let tori: &[Width] = match boundary {
            Boundary::Free if layers.creeps_far_away() => &[Width::Wide],
            Boundary::Free => &[Width::Narrow, Width::Wide],
            Boundary::Periodic => &[Width::Narrow],
        };
        for width in tori {
            if let Some(found) = Waves::on(grid, boundary, *width, layers)? {
                return Ok(found);
            }
        }
        Err(unlike_a_body(grid, boundary, layers))
    }

    /// The same on a torus; `None` where a wave of it does not creep like a body.
    fn on(
        grid: &Grid,
        boundary: Boundary,
        width: Width,
        layers: &NonseparableLayers,
    ) -> Result<Option<(Self, f64)>> {
        let lengths = match width {
            Width::Narrow => torus(grid, boundary),
            Width::Wide => wide::lengths(grid),
        };
        let mut stages: Vec<Array2<f64>> = vec![];
        let mut own = 0.0;
        for (kernel, compliance) in layers.stages.iter().cloned() {
            let mut unit = match width {
                Width::Narrow => eigenvalues(grid, boundary, &*kernel)?,
                Width::Wide => wide::eigenvalues(grid, &kernel)?,
            };
            if grid.is_line() && boundary == Boundary::Free && kernel.depth().is_none() {
                // A constant is free, and with it the response to a uniform pressure: it creeps as the longest wave does.
                (0..unit.ncols()).for_each(|ky| unit[(0, ky)] = 2.0 * unit[(1, ky)]);
            }
            if stages.is_empty() {
                own = crate::operator::mean(lengths, unit.view());
            }
            stages.push(unit * compliance);
        }
        let (rows, columns) = stages[0].dim();
        let most: Vec<f64> =
            stages.iter().map(|stage| stage.iter().copied().fold(0.0, |most, c| c.abs().max(most))).collect();
        // A square of square cells is symmetric: the upper triangle tells all.
        let [dx, dy] = grid.spacing();
        let mirrored = rows == columns && dx == dy;
        let of_row = |kx: usize| {
            let wave = |ky: usize| {
                let values: Vec<f64> = stages.iter().map(|stage| stage[(kx, ky)]).collect();
                let uniform = kx == 0 && (ky == 0 || grid.is_line());
                // Incompressible layers on a rigid base do not yield to a uniform pressure; what a torus leaves of that is no creep.
                let yields = values.iter().zip(&most).any(|(value, most)| value.abs() > NO_YIELD * most);
                match uniform && !yields {
                    true => Some((f64::INFINITY, vec![])),
                    false => relaxation(layers, &values),
                }
            };
            (if mirrored { kx } else { 0 }..columns).map(wave).collect::<Option<Vec<_>>>()
        };
        let all = (0..rows).into_par_iter().map(of_row).collect::<Option<Vec<_>>>();
        let Some(all) = all else { return Ok(None) };
        let terms = all.iter().flatten().map(|(_, terms)| terms.len()).max().unwrap_or(0).max(1);
        let times = || all.iter().flatten().flat_map(|(_, terms)| terms.iter().map(|term| libm::log(term.1)));
        let shortest = times().fold(f64::INFINITY, f64::min);
        let longest = times().fold(f64::NEG_INFINITY, f64::max).max(shortest);
        let (shortest, longest) = if shortest.is_finite() { (shortest, longest) } else { (0.0, 0.0) };
        let mut relaxing = Vec::with_capacity(rows * columns * terms);
        let mut equilibrium = Vec::with_capacity(rows * columns);
        let place = |time: f64| (libm::log(time) - shortest) / SPACING + BEFORE;
        let none = Term { modulus: 0.0, place: BEFORE };
        for (kx, ky) in (0..rows).flat_map(|kx| (0..columns).map(move |ky| (kx, ky))) {
            let (relaxed, own) = match mirrored {
                true => &all[kx.min(ky)][kx.max(ky) - kx.min(ky)],
                false => &all[kx][ky],
            };
            equilibrium.push(*relaxed);
            let own = own.iter().map(|(modulus, time)| Term { modulus: *modulus, place: place(*time) });
            relaxing.extend(own.chain(std::iter::repeat(none)).take(terms));
        }
        let nodes = ((longest - shortest) / SPACING) as usize + 6;
        let waves =
            Waves { lengths, width, first: shortest - BEFORE * SPACING, nodes, terms, equilibrium, relaxing };
        Ok(Some((waves, own)))
    }

    /// Waves of a transform of the torus.
    pub(super) fn count(&self) -> usize {
        self.lengths[0] * (self.lengths[1] / 2 + 1)
    }

    /// Waves of a quarter.
    fn quarter(&self) -> (usize, usize) {
        (self.lengths[0] / 2 + 1, self.lengths[1] / 2 + 1)
    }

    /// The table of a step of length x > 0 in which the states take these shares.
    pub(super) fn table(&self, x: f64, share: impl Fn(f64) -> Share + Sync) -> Table {
        let row = |n: usize| {
            let time = libm::exp(self.first + n as f64 * SPACING);
            let Share { taken, left } = share(time);
            [libm::exp(-x / time), taken, left]
        };
        Table((0..self.nodes).into_par_iter().map(row).collect())
    }

    /// 1/e of each wave of a quarter.
    pub(super) fn compliance(&self, step: &Table) -> Array2<f64> {
        let (rows, columns) = self.quarter();
        let of = |n: usize| {
            let relaxing = self.terms_of(n).iter().map(|e| e.modulus * step.at(e.place).left);
            1.0 / (self.equilibrium[n] + relaxing.sum::<f64>())
        };
        let values: Vec<f64> = (0..rows * columns).into_par_iter().map(of).collect();
        Array2::from_shape_fn((rows, columns), |(kx, ky)| values[kx * columns + ky])
    }

    /// Σ E_i times what a table has for the change of u, of each wave of a quarter.
    pub(super) fn sum_of_new(&self, table: &Table) -> Vec<f64> {
        let of = |n: usize| self.terms_of(n).iter().map(|e| e.modulus * table.at(e.place).new).sum();
        (0..self.equilibrium.len()).into_par_iter().map(of).collect()
    }

    /// E_inf of a wave of a quarter; 0 of one that does not yield.
    pub(super) fn relaxed_modulus(&self, wave: usize) -> f64 {
        Some(self.equilibrium[wave]).filter(|modulus| modulus.is_finite()).unwrap_or(0.0)
    }

    /// The number in the quarter of the n-th wave of the transform.
    pub(super) fn quarter_of(&self, n: usize) -> usize {
        self.place(n % self.lengths[0], n / self.lengths[0])
    }

    /// The number of a wave of the transform in the quarter.
    fn place(&self, kx: usize, ky: usize) -> usize {
        kx.min(self.lengths[0] - kx) * self.quarter().1 + ky
    }

    /// The two waves of a column of the transform that have the same rules, kx and mx - kx; one where they are the same.
    fn pair(&self, kx: usize) -> impl Iterator<Item = usize> {
        let mirrored = Some(self.lengths[0] - kx).filter(|other| kx > 0 && *other != kx);
        std::iter::once(kx).chain(mirrored)
    }

    /// The terms of a wave of the quarter.
    fn terms_of(&self, wave: usize) -> &[Term] {
        &self.relaxing[wave * self.terms..(wave + 1) * self.terms]
    }

    /// One step of a wave: its displacement under the pressure `p` at the end, which its states take in.
    fn step(
        &self,
        wave: usize,
        rules: &[Rule],
        p: Complex64,
        u: Complex64,
        q: &mut [Complex64],
    ) -> Complex64 {
        let mut modulus = self.equilibrium[wave];
        if modulus.is_infinite() {
            return Complex64::ZERO;
        }
        let terms = self.terms_of(wave);
        let mut held = p;
        for ((e, rule), q) in terms.iter().zip(rules).zip(&mut *q) {
            modulus += e.modulus * rule.left;
            // What the state is without the change of u.
            *q = rule.keep * *q + (1.0 - rule.keep - rule.new).max(0.0) * u;
            held += e.modulus * *q;
        }
        let fresh = held / modulus;
        rules.iter().zip(q).for_each(|(rule, q)| *q += rule.new * fresh);
        fresh
    }

    /// The displacement after these steps under the pressure `p` (none where it is `None`), and the states; `states` are those of
    /// all waves, \[wave\]\[term\].
    pub(super) fn end(
        &self,
        steps: &[Table],
        p: Option<&[Complex64]>,
        u: &mut [Complex64],
        states: &mut [Complex64],
    ) {
        let mx = self.lengths[0];
        let columns = u.par_chunks_mut(mx).zip(states.par_chunks_mut(mx * self.terms));
        columns.enumerate().for_each(|(ky, (u, states))| self.end_column(ky, steps, p, u, states));
    }

    /// What the displacement after these steps is without pressure.
    pub(super) fn recall(
        &self,
        steps: &[Table],
        u: &[Complex64],
        states: &[Complex64],
        recalled: &mut [Complex64],
    ) {
        recalled.copy_from_slice(u);
        let mx = self.lengths[0];
        let columns = recalled.par_chunks_mut(mx).zip(states.par_chunks(mx * self.terms));
        columns.enumerate().for_each(|(ky, (u, states))| {
            self.end_column(ky, steps, None, u, &mut states.to_vec());
        });
    }

    fn end_column(
        &self,
        ky: usize,
        steps: &[Table],
        p: Option<&[Complex64]>,
        u: &mut [Complex64],
        states: &mut [Complex64],
    ) {
        let mut rules = vec![Rule::default(); self.terms];
        for (first, step) in (0..=u.len() / 2).flat_map(|kx| steps.iter().map(move |step| (kx, step))) {
            let wave = self.place(first, ky);
            let terms = self.terms_of(wave);
            terms.iter().zip(&mut rules).for_each(|(term, rule)| *rule = step.at(term.place));
            for kx in self.pair(first) {
                let p = p.map_or(Complex64::ZERO, |p| p[ky * u.len() + kx]);
                let q = &mut states[kx * self.terms..(kx + 1) * self.terms];
                u[kx] = self.step(wave, &rules, p, u[kx], q);
            }
        }
    }

    /// Mean of 1/E~(s) over the waves, each with the weight |p|²; at s = ∞, 0 and `frequencies`.
    pub(super) fn mean(&self, p: &[Complex64], frequencies: impl Iterator<Item = f64>) -> Vec<f64> {
        let [mx, my] = self.lengths;
        let time = |place: f64| libm::exp(self.first + place * SPACING);
        let at = |s: f64| {
            let column = |ky: usize| {
                let twice = if ky == 0 || 2 * ky == my { 1.0 } else { 2.0 };
                let wave = |kx: usize| {
                    let n = self.place(kx, ky);
                    let share = |e: &Term| {
                        let y = s * time(e.place);
                        if y.is_infinite() { e.modulus } else { e.modulus * y / (1.0 + y) }
                    };
                    let modulus = self.equilibrium[n] + self.terms_of(n).iter().map(share).sum::<f64>();
                    twice * p[ky * mx + kx].norm_sqr() / modulus
                };
                (0..mx).map(wave).sum::<f64>()
            };
            (0..my / 2 + 1).into_par_iter().map(column).collect::<Vec<f64>>().iter().sum::<f64>()
        };
        [f64::INFINITY, 0.0].into_iter().chain(frequencies).map(at).collect()
    }
}

/// E_inf and the terms (E_i, τ_i) of a wave with these values of C~; `None` where it does not creep like a body.
fn relaxation(layers: &NonseparableLayers, values: &[f64]) -> Option<(f64, Vec<(f64, f64)>)> {
    let (creep, _) = layers.fit(values).filter(|(_, misfit)| *misfit <= TOLERANCE)?;
    let relaxation = creep.to_relaxation().ok()?;
    let terms = relaxation.terms.iter().map(|term| (term.modulus, term.relaxation_time));
    Some((relaxation.equilibrium, terms.collect()))
}

/// Whether layers that creep differently are solved on a domain, as far as a coarse grid tells.
///
/// # Errors
/// [`Error::Invalid`] where a wave does not creep like a body.
pub fn check_layers(grid: &Grid, boundary: Boundary, layers: &NonseparableLayers) -> Result<()> {
    if boundary == Boundary::Periodic {
        return Ok(());
    }
    let longest = layers.glassy().longest_cell();
    let coarse = |n: usize, side: f64| n.min(COARSE.max((side / longest).ceil() as usize));
    let ([nx, ny], [lx, ly]) = (grid.cells(), grid.size());
    let cells = [coarse(nx, lx), coarse(ny, ly)];
    Waves::new(&grid.with_cells(cells)?, boundary, layers).map(|_| ())
}

fn unlike_a_body(grid: &Grid, boundary: Boundary, layers: &NonseparableLayers) -> Error {
    match boundary {
        Boundary::Free => {
            let side = grid.longest_side();
            Error::invalid(
                "side of a free domain over layers that creep differently",
                format!("{side:e} m"),
                format!(
                    "several times the length over which the layers bend, {:.2e} m: a stiff layer on a softer one spreads the \
                     pressure beyond the domain, where its creep is not followed. Take a larger domain with the same cells, or \
                     boundary = \"periodic\" and a domain several times as wide as that length and the contact",
                    layers.bending_length()
                ),
            )
        }
        Boundary::Periodic => Error::invalid(
            "misfit of the creep of a wave",
            format!("more than {TOLERANCE:e}"),
            "less: use materials with fewer or closer relaxation times",
        ),
    }
}
