//! What the branches store, and the work that the bodies take up over a step.
//!
//! With <a, b> = Σ a K⁻¹ b over the cells, the springs of the relaxation form hold
//!
//! ```text
//! stored = 1/2 [ E_inf <u, u> + Σ E_i <u - q_i, u - q_i> ]
//! ```
//!
//! which is the energy of the springs of the creep form too: the two are changed into each other by an orthogonal matrix. The
//! products of the states and u are a few numbers that go from step to step as the states do; what a step adds to
//! them needs only products with its pressure, K⁻¹ U' = p'. Over a step u = u_n + r(s) Δu, and the pressure does the work
//!
//! ```text
//! ∫ <U, du> = E_inf (<u_n, Δu> + <Δu, Δu>/2) + Σ E_i ( <u_n - q_i, Δu> ∫ exp(-s/τ_i) dr + <Δu, Δu> ∫ (r - Γ_i) dr ) + ζ <Δu, Δu> ∫ r'² ds
//! Γ_i(s) = ∫ exp(-(s - s')/τ_i) r(s') ds'/τ_i
//! ```
//!
//! What of it is not stored has become heat. The same sum for the load as a cell is the mean of W over the step.

use super::rules::Driver;
use super::shape::moment;
use super::{Relaxation, UnderWay};
use crate::history::{Ends, Exchange};
use crate::material::{Dual, integrate};
use asperity_sweep::dot;

/// Products of the states q_i and u (the last) with each other, at the end of a step.
#[derive(Clone, Debug)]
pub(super) struct Products {
    pub(super) rates: Vec<f64>,
    pub(super) dual: Dual,
    pub(super) list: Vec<Vec<f64>>,
}

/// Integrals of a branch over the course of a step: ∫ exp(-s/τ) dr and ∫ (r - Γ) dr.
#[derive(Clone, Copy)]
struct Followed {
    fading: f64,
    growing: f64,
}

impl Relaxation {
    /// What the step under way, which has just been solved, did; brings `products` to its end.
    pub(super) fn exchanged(&self, products: &mut Products, ends: &Ends<'_>) -> Exchange {
        let (p, unit) = (&ends.now.pressure[..], &ends.now.unit_displacement[..]);
        let energy = dot(p, unit);
        if self.is_elastic() {
            let own = &mut products.list[0][0];
            let before = std::mem::replace(own, 0.5 * self.rules.compliance * energy);
            let mean_load = 0.5 * (self.cell.start.load + self.cell.end.load);
            return Exchange { stored: *own, work: *own - before, heat: 0.0, mean_load };
        }
        if products.rates != self.rates {
            let one = vec![1.0; self.dual.strains()];
            let mut rows = transition(&products.dual, &self.dual, &one);
            let count = self.dual.states();
            rows[count].fill(0.0);
            rows[count][count] = 1.0;
            products.carry(&rows);
            (products.rates, products.dual) = (self.rates.clone(), self.dual.clone());
        }
        let before = products.stored();
        if self.under_way != UnderWay::Contact {
            let mut left = vec![];
            self.pair.fading(&self.elapsed, &mut left);
            products.carry(&transition(&self.dual, &self.dual, &left));
            let stored = products.stored();
            return Exchange { stored, heat: (before - stored).max(0.0), ..Exchange::default() };
        }
        // u' = c U' + Σ w x over the states and u: its products with these, and with itself.
        let count = self.dual.states();
        let with_pressure = self.states.products(&self.displacement, p);
        let compliance = self.rules.compliance;
        let recalled = self.rules.recalled();
        let weights: Vec<f64> = recalled.weights.iter().copied().chain([recalled.own]).collect();
        let sum = |a: &[f64]| a.iter().zip(&weights).map(|(a, w)| a * w).sum::<f64>();
        let of_end: Vec<f64> =
            products.list.iter().zip(&with_pressure).map(|(row, a)| compliance * a + sum(row)).collect();
        let itself = compliance * (compliance * energy + sum(&with_pressure)) + sum(&of_end);
        // Products with Δu.
        let start = &products.list[count];
        let change: Vec<f64> = of_end.iter().zip(start).map(|(end, start)| end - start).collect();
        let square = itself - 2.0 * of_end[count] + start[count];
        let (followed, speed) = self.follow();
        let relaxation = &self.dual.relaxation;
        let dashpot = relaxation.viscosity * speed;
        let of = |own: f64, square: f64, with: &dyn Fn(usize) -> f64| {
            let branches = relaxation
                .terms
                .iter()
                .zip(&followed)
                .enumerate()
                .map(|(i, (e, f))| e.modulus * ((own - with(i)) * f.fading + square * f.growing));
            relaxation.equilibrium * (own + 0.5 * square) + branches.sum::<f64>() + dashpot * square
        };
        let mut work = of(change[count], square, &|i| change[i]);
        let driven = self.cell.end.driver - self.cell.start.driver;
        // Of L itself, not of its square.
        let mean_load = of(self.cell.start.driver, driven, &|i| self.cell.start.states[i]);
        products.list.iter_mut().zip(&of_end).for_each(|(row, end)| row.push(*end));
        let mut last = of_end;
        last.push(itself);
        products.list.push(last);
        products.carry(&self.rows());
        let stored = products.stored();
        if self.rules.length <= 0.0 {
            work = stored - before;
        }
        Exchange { stored, work, heat: (work - (stored - before)).max(0.0), mean_load }
    }

    /// The states and u at the end of the step by those at its start and u at its end.
    fn rows(&self) -> Vec<Vec<f64>> {
        let count = self.dual.states();
        let mut rows = vec![vec![0.0; count + 2]; count + 1];
        for (i, update) in self.rules.ending().updates.iter().enumerate() {
            (rows[i][i], rows[i][count], rows[i][count + 1]) = (update.keep, update.old, update.new);
        }
        rows[count][count + 1] = 1.0;
        rows
    }

    /// Integrals over the course of the step: of each branch, and ∫ r'² ds.
    fn follow(&self) -> (Vec<Followed>, f64) {
        let (x, terms) = (self.rules.length, &self.dual.relaxation.terms);
        if x <= 0.0 {
            return (vec![Followed { fading: 1.0, growing: 0.5 }; terms.len()], 0.0);
        }
        let Driver::Load(change) = self.rules.driver else {
            let of = |y: f64| Followed { fading: moment(0, y) / y, growing: moment(1, y) / y };
            return (terms.iter().map(|term| of(x / term.relaxation_time)).collect(), 1.0 / x);
        };
        // Panels of a decade down to the shortest time that matters.
        let retardation = self.dual.creep.terms.iter().map(|term| term.retardation_time);
        let shortest = retardation.chain(terms.iter().map(|term| term.relaxation_time)).fold(x, f64::min);
        let mut edges = vec![x];
        while edges.last().is_some_and(|edge| *edge > 0.1 * shortest && *edge > 1e-15 * x) {
            edges.extend(edges.last().map(|edge| 0.1 * edge));
        }
        edges.push(0.0);
        let along = |f: &dyn Fn(f64) -> f64| -> f64 {
            edges.windows(2).map(|edge| integrate(edge[1], edge[0], f)).sum()
        };
        let speed = |s: f64| self.cell.shape.slope(&self.dual, s) / change;
        let of = |i: usize| Followed {
            fading: along(&|s| libm::exp(-s / terms[i].relaxation_time) * speed(s)),
            growing: along(&|s| {
                let gone = self.cell.shape.change(&self.dual, s);
                self.cell.shape.share(&self.dual, i, s, gone).left * gone / change * speed(s)
            }),
        };
        let viscous = self.dual.relaxation.viscosity > 0.0;
        let square = if viscous { along(&|s| speed(s) * speed(s)) } else { 0.0 };
        ((0..terms.len()).map(of).collect(), square)
    }
}

/// What becomes of (q, u) where that much is left of each strain, with the states of `new` after it: a row of weights for each
/// state, and one for u without pressure.
pub(super) fn transition(old: &Dual, new: &Dual, left: &[f64]) -> Vec<Vec<f64>> {
    let count = old.states();
    let (mut q, mut fresh, mut strains) = (vec![0.0; count], vec![0.0; count], vec![0.0; old.strains()]);
    let mut rows = vec![vec![0.0; count + 1]; count + 1];
    for k in 0..=count {
        q.fill(0.0);
        // One state at a time, then u.
        let u = f64::from(u8::from(k == count));
        q.iter_mut().skip(k).take(1).for_each(|q| *q = 1.0);
        old.to_strains(&q, u, &mut strains);
        strains.iter_mut().zip(left).for_each(|(e, left)| *e *= left);
        new.to_states(&strains, &mut fresh);
        rows.iter_mut().zip(&fresh).for_each(|(row, q)| row[k] = *q);
        rows[count][k] = strains.iter().sum();
    }
    rows
}

impl Products {
    /// Of bodies at rest.
    pub(super) fn at_rest(rates: &[f64], dual: &Dual) -> Products {
        let n = dual.states() + 1;
        Products { rates: rates.to_vec(), dual: dual.clone(), list: vec![vec![0.0; n]; n] }
    }

    /// The products of `rows` times what they were of.
    fn carry(&mut self, rows: &[Vec<f64>]) {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let half: Vec<Vec<f64>> =
            rows.iter().map(|row| self.list.iter().map(|column| dot(row, column)).collect()).collect();
        self.list = half.iter().map(|a| rows.iter().map(|row| dot(a, row)).collect()).collect();
    }

    fn stored(&self) -> f64 {
        let relaxation = &self.dual.relaxation;
        let count = relaxation.terms.len();
        let own = self.list[count][count];
        let branch = |i: usize| own - 2.0 * self.list[count][i] + self.list[i][i];
        let branches: f64 =
            relaxation.terms.iter().enumerate().map(|(i, e)| e.modulus * branch(i).max(0.0)).sum();
        0.5 * (relaxation.equilibrium * own + branches)
    }
}
