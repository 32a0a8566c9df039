//! The memory of a Prony series: one field per branch, in displacement space.
//!
//! Branch strains obey lambda de/dt + e = C U; flow obeys dv/dt = U/eta. Over a step both become
//! e' = keep e + old U_n + new U_(n+1), exact for the pressure assumed in between:
//!
//! - piecewise linear (second order): x = dt/lambda, E = exp(-x), phi = (1 - E)/x;
//!   keep = E, old = C (phi - E), new = C (1 - phi); flow: keep = 1, old = new = dt/(2 eta);
//! - piecewise constant (SC17's assumption; first order, L-stable): keep = E, old = 0,
//!   new = C (1 - E); flow: keep = 1, old = 0, new = dt/eta.
//!
//! A body whose temperature changes lives in its reduced time xi: the same rules hold with the length of
//! the step on its clock in place of dt, exact for U linear (or constant) in xi. Each branch belongs to a
//! part of the creep function, and each part has its length.
//!
//! So c = C0 + sum new, g = sum (keep e + old U_n). The update of the last step and the history of the
//! next are one sweep: each branch is read and written once per step.

use crate::field::{BLOCK, Cells, strands, sweep};
use crate::march::Scheme;
use crate::march::adaptive::{Defect, chord_defect};
use crate::material::Creep;

/// Share of the retarded compliance below which the instantaneous one is too small for the linear
/// scheme, which would ring: such steps take the pressure as constant.
const STIFFEST: f64 = 0.05;

pub(super) struct Memory {
    instantaneous: f64,
    branches: Vec<Branch>,
    scheme: Scheme,
    cells: usize,
    /// Branch fields, interleaved by blocks of cells: \[block\]\[branch\]\[cell\].
    strains: Vec<f64>,
    /// Scheme of the step whose end state is not yet in `strains`, and its length on each clock.
    pending: Option<Scheme>,
    lengths: Vec<f64>,
    /// The rules of the pending step and, during a sweep, of the next.
    update: Vec<Rule>,
    next: Vec<Rule>,
}

#[derive(Clone, Copy)]
struct Branch {
    element: Element,
    /// The part of the creep function that it belongs to, whose clock it keeps.
    part: usize,
}

#[derive(Clone, Copy)]
enum Element {
    Retarded { compliance: f64, time: f64 },
    Flow { fluidity: f64 },
}

/// e' = keep e + old U_n + new U_(n+1).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rule {
    keep: f64,
    old: f64,
    new: f64,
}

/// A branch over the pending step, for the energy of the bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) stretch: Stretch,
    /// Whether U runs linearly over the step; otherwise it has its end's value from the start on.
    pub(super) linear: bool,
    /// <e, p> of the strain e at the start of the step with the pressure there, and with that at its end \[m Pa\].
    pub(super) old: f64,
    pub(super) new: f64,
}

/// How a branch goes through a step of length x = dt/lambda.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stretch {
    /// E = exp(-x), phi = (1 - E)/x, 1 - phi, and (1/x^2) int_0^x (1 - exp(-s))^2 ds.
    Retarded { compliance: f64, keep: f64, phi: f64, rest: f64, share: f64 },
    /// What a held U would add \[1/Pa\].
    Flow { creep: f64 },
}

impl Rule {
    /// The state as it is.
    const IDENTITY: Rule = Rule { keep: 1.0, old: 0.0, new: 0.0 };
}

impl Branch {
    fn rule(self, lengths: &[f64], scheme: Scheme) -> Rule {
        self.element.rule(lengths[self.part], scheme)
    }
}

impl Element {
    fn rule(self, dt: f64, scheme: Scheme) -> Rule {
        match (self, scheme) {
            (Element::Retarded { compliance, time }, Scheme::Linear) => {
                let x = dt / time;
                let keep = libm::exp(-x);
                let (phi, one_minus_phi) = mean_decay(x);
                Rule { keep, old: compliance * (phi - keep), new: compliance * one_minus_phi }
            }
            (Element::Retarded { compliance, time }, _) => {
                let x = dt / time;
                Rule { keep: libm::exp(-x), old: 0.0, new: -compliance * libm::expm1(-x) }
            }
            (Element::Flow { fluidity }, Scheme::Linear) => {
                Rule { keep: 1.0, old: 0.5 * fluidity * dt, new: 0.5 * fluidity * dt }
            }
            (Element::Flow { fluidity }, _) => Rule { keep: 1.0, old: 0.0, new: fluidity * dt },
        }
    }
}

/// phi = (1 - exp(-x))/x and 1 - phi, each to full precision.
fn mean_decay(x: f64) -> (f64, f64) {
    if x < 1e-2 {
        // 1 - phi = x/2 - x^2/6 + x^3/24 - ...: seven terms leave less than 1e-16 of the first.
        let mut term = 0.5 * x;
        let mut sum = term;
        for k in 3..9 {
            term *= -x / f64::from(k);
            sum += term;
        }
        (1.0 - sum, sum)
    } else {
        let phi = -libm::expm1(-x) / x;
        (phi, 1.0 - phi)
    }
}

/// (1/x^2) int_0^x (1 - exp(-s))^2 ds = \[x - 2 (1 - E) + (1 - E^2)/2\]/x^2 to full precision.
fn mean_square_growth(x: f64) -> f64 {
    if x < 0.05 {
        // sum over k >= 3 of (-1)^(k+1) (2^(k-1) - 2)/k! x^(k-2): nine terms leave less than 1e-16 of the first.
        let (mut power, mut factorial, mut two, mut sum) = (-1.0, 2.0, 2.0, 0.0);
        for k in 3..12 {
            power *= -x;
            factorial *= f64::from(k);
            two *= 2.0;
            sum += power * (two - 2.0) / factorial;
        }
        sum
    } else {
        let fade = -libm::expm1(-x);
        let twice = -libm::expm1(-2.0 * x);
        (x - 2.0 * fade + 0.5 * twice) / (x * x)
    }
}

impl Memory {
    /// The memory of the sum of `parts`, each on a clock of its own.
    pub(super) fn new<'c>(parts: impl Iterator<Item = &'c Creep>, scheme: Scheme, cells: usize) -> Self {
        let (mut instantaneous, mut branches, mut count) = (0.0, Vec::new(), 0);
        for (part, creep) in parts.enumerate() {
            let retarded = creep
                .terms
                .iter()
                .map(|t| Element::Retarded { compliance: t.compliance, time: t.retardation_time });
            let flow = (creep.fluidity > 0.0).then_some(Element::Flow { fluidity: creep.fluidity });
            branches.extend(retarded.chain(flow).map(|element| Branch { element, part }));
            instantaneous += creep.instantaneous;
            count += 1;
        }
        Memory {
            instantaneous,
            scheme,
            cells,
            strains: vec![0.0; cells * branches.len()],
            update: vec![Rule::IDENTITY; branches.len()],
            next: vec![Rule::IDENTITY; branches.len()],
            branches,
            pending: None,
            lengths: vec![0.0; count],
        }
    }

    /// The scheme that a step of these lengths can take without ringing.
    fn scheme_of(&self, lengths: &[f64]) -> Scheme {
        if self.scheme == Scheme::Linear {
            let retarded: f64 = self.branches.iter().map(|b| b.rule(lengths, Scheme::Linear).new).sum();
            if self.instantaneous >= STIFFEST * retarded {
                return Scheme::Linear;
            }
        }
        Scheme::Constant
    }

    /// Takes in the step before, with `unit` = U_n and `previous` = U_(n-1); writes
    /// `gap` = `rigid` + g for a step that is `lengths` long on the clocks, and returns its compliance c.
    pub(super) fn history(
        &mut self,
        lengths: &[f64],
        previous: &[f64],
        unit: &[f64],
        rigid: &[f64],
        gap: &mut [f64],
    ) -> f64 {
        let scheme = self.scheme_of(lengths);
        let branches = &self.branches;
        self.next.iter_mut().zip(branches).for_each(|(rule, b)| *rule = b.rule(lengths, scheme));
        let (update, next) = (&self.update, &self.next);
        let strains =
            Interleaved { cells: self.cells, branches: self.branches.len(), data: &mut self.strains };
        sweep((strains, (previous, unit), rigid, gap), &|(strains, (previous, unit), rigid, gap): (
            Interleaved,
            (&[f64], &[f64]),
            &[f64],
            &mut [f64],
        )| {
            let n = gap.len();
            let (previous, unit) = (&previous[..n], &unit[..n]);
            gap.copy_from_slice(rigid);
            for ((e, update), next) in strains.data.chunks_exact_mut(n).zip(update).zip(next) {
                for i in 0..n {
                    e[i] = update.keep * e[i] + update.old * previous[i] + update.new * unit[i];
                    gap[i] += next.keep * e[i] + next.old * unit[i];
                }
            }
        });
        std::mem::swap(&mut self.update, &mut self.next);
        self.pending = Some(scheme);
        self.lengths.copy_from_slice(lengths);
        self.instantaneous + self.update.iter().map(|r| r.new).sum::<f64>()
    }

    /// As [`Memory::history`] for the pending step at another length: what came before it is taken in already.
    pub(super) fn retry(&mut self, lengths: &[f64], unit: &[f64], rigid: &[f64], gap: &mut [f64]) -> f64 {
        self.update.fill(Rule::IDENTITY);
        self.history(lengths, unit, unit, rigid, gap)
    }

    /// As [`Memory::history`] for a part of the pending step, `lengths` long, with nothing changed.
    pub(super) fn partial(&self, lengths: &[f64], unit: &[f64], rigid: &[f64], gap: &mut [f64]) -> f64 {
        let scheme = self.pending.unwrap_or(self.scheme);
        let rules: Vec<Rule> = self.branches.iter().map(|b| b.rule(lengths, scheme)).collect();
        gap.copy_from_slice(rigid);
        add_history(&rules, &self.strains, unit, gap);
        self.instantaneous + rules.iter().map(|r| r.new).sum::<f64>()
    }

    /// Whether the pending step takes U as linear.
    pub(super) fn is_linear(&self) -> bool {
        self.pending == Some(Scheme::Linear)
    }

    /// What the scheme of the pending step, `dt` long in the laboratory, leaves out.
    pub(super) fn defect(&self, dt: f64) -> Defect {
        let branches = self.branches.iter().map(|b| (b.element, self.lengths[b.part]));
        if self.pending == Some(Scheme::Linear) {
            let weight = branches.map(|(element, length)| match element {
                Element::Retarded { compliance, time } => compliance * chord_defect(length / time),
                Element::Flow { fluidity } => fluidity * length / 12.0,
            });
            Defect::Curvature(dt * dt * weight.sum::<f64>())
        } else {
            let weight = self.branches.iter().map(|b| b.rule(&self.lengths, Scheme::Linear).old);
            Defect::Change(weight.sum())
        }
    }

    /// g of the pending step, with `unit` = U at its beginning.
    pub(super) fn remembered(&self, unit: &[f64], g: &mut [f64]) {
        g.fill(0.0);
        add_history(&self.update, &self.strains, unit, g);
    }

    /// Number of branches.
    pub(super) fn branches(&self) -> usize {
        self.branches.len()
    }

    /// The branches over the pending step, which begins under the pressure `before` and ends under `now`.
    pub(super) fn parts(&self, before: &[f64], now: &[f64]) -> Vec<Part> {
        use rayon::prelude::*;
        let count = self.branches.len();
        if count == 0 {
            return vec![];
        }
        // One block after the other, summed in their order: the same bits on any number of threads.
        let blocks: Vec<Vec<[f64; 2]>> = self
            .strains
            .par_chunks(BLOCK * count)
            .zip(before.par_chunks(BLOCK).zip(now.par_chunks(BLOCK)))
            .map(|(strains, (before, now))| {
                let products = |e: &[f64]| {
                    let (e, now) = (&e[..before.len()], &now[..before.len()]);
                    strands(before.len(), |i| [e[i] * before[i], e[i] * now[i]])
                };
                strains.chunks(before.len()).map(products).collect()
            })
            .collect();
        let sum = |branch: usize| {
            blocks.iter().fold([0.0; 2], |[a, b], block| [a + block[branch][0], b + block[branch][1]])
        };
        let linear = self.pending == Some(Scheme::Linear);
        let part = |(k, branch): (usize, &Branch)| {
            let length = self.lengths[branch.part];
            let stretch = match branch.element {
                Element::Retarded { compliance, time } => {
                    let x = length / time;
                    let (phi, rest) = mean_decay(x);
                    let share = mean_square_growth(x);
                    Stretch::Retarded { compliance, keep: libm::exp(-x), phi, rest, share }
                }
                Element::Flow { fluidity } => Stretch::Flow { creep: fluidity * length },
            };
            let [old, new] = sum(k);
            Part { stretch, linear, old, new }
        };
        self.branches.iter().enumerate().map(part).collect()
    }

    /// Scalars and branch fields.
    pub(super) fn save(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let scalars = match self.pending {
            Some(scheme) => {
                let linear = f64::from(u8::from(scheme == Scheme::Linear));
                self.lengths.iter().copied().chain([linear]).collect()
            }
            None => vec![],
        };
        let mut fields = vec![Vec::with_capacity(self.cells); self.branches.len()];
        let mut rest = &self.strains[..];
        while !rest.is_empty() {
            let n = BLOCK.min(rest.len() / self.branches.len());
            for field in &mut fields {
                let (block, after) = rest.split_at(n);
                field.extend_from_slice(block);
                rest = after;
            }
        }
        (scalars, fields)
    }

    /// Takes back what [`Memory::save`] gave; false where it does not fit.
    pub(super) fn load(&mut self, scalars: &[f64], fields: &[Vec<f64>]) -> bool {
        if fields.len() != self.branches.len() || fields.iter().any(|f| f.len() != self.cells) {
            return false;
        }
        self.pending = match scalars {
            [] => None,
            [lengths @ .., linear] if lengths.len() == self.lengths.len() => {
                let scheme = if *linear == 1.0 { Scheme::Linear } else { Scheme::Constant };
                let rules = self.update.iter_mut().zip(&self.branches);
                rules.for_each(|(rule, b)| *rule = b.rule(lengths, scheme));
                self.lengths.copy_from_slice(lengths);
                Some(scheme)
            }
            _ => return false,
        };
        self.strains.clear();
        for start in (0..self.cells).step_by(BLOCK) {
            let end = self.cells.min(start + BLOCK);
            fields.iter().for_each(|f| self.strains.extend_from_slice(&f[start..end]));
        }
        true
    }
}

/// Adds sum (keep e + old U) to `g`.
fn add_history(rules: &[Rule], mut strains: &[f64], unit: &[f64], g: &mut [f64]) {
    for (g, unit) in g.chunks_mut(BLOCK).zip(unit.chunks(BLOCK)) {
        for rule in rules {
            let (e, rest) = strains.split_at(g.len());
            g.iter_mut().zip(e).zip(unit).for_each(|((g, e), u)| *g += rule.keep * e + rule.old * u);
            strains = rest;
        }
    }
}

/// Branch fields whose blocks of cells lie side by side, so that a sweep's block is one slice.
struct Interleaved<'a> {
    cells: usize,
    branches: usize,
    data: &'a mut [f64],
}

impl Cells for Interleaved<'_> {
    fn cells(&self) -> usize {
        self.cells
    }

    fn split(self, mid: usize) -> (Self, Self) {
        let (first, second) = self.data.split_at_mut(mid * self.branches);
        (
            Interleaved { cells: mid, branches: self.branches, data: first },
            Interleaved { cells: self.cells - mid, branches: self.branches, data: second },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::CreepTerm;

    fn zener(instantaneous: f64) -> Creep {
        let terms = vec![
            CreepTerm { compliance: 1.0, retardation_time: 0.5 },
            CreepTerm { compliance: 0.3, retardation_time: 7.0 },
        ];
        Creep { instantaneous, terms, fluidity: 0.1 }
    }

    #[test]
    fn both_forms_of_the_mean_decay_agree_where_they_meet() {
        for x in [1e-9, 1e-4, 0.00999999, 0.0100001, 0.3, 40.0] {
            let (phi, rest) = mean_decay(x);
            // integral of exp(-x s) over [0, 1] by Simpson's rule on 2000 panels (error < x^4 1e-14)
            let n = 2000;
            let f = |k: usize| (-x * k as f64 / n as f64).exp();
            let sum: f64 =
                (1..n).map(|k| if k % 2 == 1 { 4.0 * f(k) } else { 2.0 * f(k) }).sum::<f64>() + f(0) + f(n);
            assert!((phi - sum / (3.0 * n as f64)).abs() < 1e-9, "{x}");
            assert!((phi + rest - 1.0).abs() < 1e-15);
            assert!((rest / (0.5 * x) - 1.0).abs() < 0.34 * x + 1e-15);
        }
    }

    #[test]
    fn a_ramp_of_displacement_history_is_exact_in_the_linear_scheme() {
        // U(t) = t: u(t) = integral C = creep.integral(t), whatever the steps; several blocks of cells.
        let creep = zener(2.0);
        let n = 2 * BLOCK + 3;
        let mut memory = Memory::new([&creep].into_iter(), Scheme::Linear, n);
        let rigid = vec![0.25; n];
        let (mut before, mut last, mut gap) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let mut t = 0.0;
        for dt in [0.1, 0.03, 2.0, 1e-7, 0.5] {
            let c = memory.history(&[dt], &before, &last, &rigid, &mut gap);
            t += dt;
            std::mem::swap(&mut before, &mut last);
            last.fill(t);
            for (cell, gap) in gap.iter().enumerate() {
                let u = c * t + gap - 0.25;
                assert!((u - creep.integral(t)).abs() < 1e-13, "cell {cell}, t = {t}");
            }
        }
        // A checkpoint on the way changes no bit.
        let (scalars, fields) = memory.save();
        let mut copy = Memory::new([&creep].into_iter(), Scheme::Linear, n);
        assert!(copy.load(&scalars, &fields));
        let mut again = vec![0.0; n];
        let c = memory.history(&[0.7], &before, &last, &rigid, &mut gap);
        assert_eq!(c, copy.history(&[0.7], &before, &last, &rigid, &mut again));
        assert_eq!(gap, again);
    }

    #[test]
    fn a_step_of_displacement_history_is_exact_in_the_constant_scheme() {
        let creep = zener(0.0);
        let mut memory = Memory::new([&creep].into_iter(), Scheme::Constant, 1);
        let (mut before, mut last, mut gap) = (vec![0.0], vec![0.0], vec![0.0]);
        let mut t = 0.0;
        for dt in [0.1, 0.03, 2.0, 0.5] {
            let c = memory.history(&[dt], &before, &last, &[0.0], &mut gap);
            t += dt;
            std::mem::swap(&mut before, &mut last);
            last[0] = 1.0;
            assert!((c + gap[0] - creep.value(t)).abs() < 1e-14);
        }
    }

    #[test]
    fn a_step_tried_again_at_another_length_leaves_no_trace() {
        let creep = zener(2.0);
        let n = BLOCK + 5;
        let new = || Memory::new([&creep].into_iter(), Scheme::Linear, n);
        let (mut once, mut twice) = (new(), new());
        let rigid = vec![0.25; n];
        let (before, last) = (vec![0.0; n], vec![1.5; n]);
        let (mut gap, mut again, mut part) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for memory in [&mut once, &mut twice] {
            memory.history(&[0.3], &before, &before, &rigid, &mut gap);
        }
        let c = once.history(&[0.2], &before, &last, &rigid, &mut gap);
        twice.history(&[0.7], &before, &last, &rigid, &mut again);
        let partial = twice.partial(&[0.2], &last, &rigid, &mut part);
        assert_eq!(twice.retry(&[0.2], &last, &rigid, &mut again), c);
        assert_eq!(partial, c);
        assert_eq!(gap, again);
        // One sum in another order.
        assert!(part.iter().zip(&gap).all(|(a, b)| (a - b).abs() < 1e-15));
    }

    #[test]
    fn the_defect_is_what_a_parabola_leaves_over() {
        // U = t^2 in one step of 0.2 from rest: the exact strain less that of the chord is the defect times U'' = 2.
        let creep = zener(2.0);
        let dt = 0.2;
        let mut memory = Memory::new([&creep].into_iter(), Scheme::Linear, 1);
        let mut gap = [0.0];
        let c = memory.history(&[dt], &[0.0], &[0.0], &[0.0], &mut gap);
        // u(dt) = integral of C(dt - s) 2 s ds = 2 x the second integral of C; by Simpson's rule.
        let n = 1000;
        let f = |k: usize| {
            let s = dt * k as f64 / n as f64;
            2.0 * s * creep.value(dt - s)
        };
        let sum: f64 =
            (1..n).map(|k| if k % 2 == 1 { 4.0 * f(k) } else { 2.0 * f(k) }).sum::<f64>() + f(0) + f(n);
        let exact = sum * dt / (3.0 * n as f64);
        let Defect::Curvature(weight) = memory.defect(dt) else { panic!() };
        let chord = c * dt * dt + gap[0];
        assert!((chord - exact - 2.0 * weight).abs() < 1e-12, "{chord} {exact} {weight}");
        let mut stiff = Memory::new([&zener(0.0)].into_iter(), Scheme::Linear, 1);
        stiff.history(&[dt], &[0.0], &[0.0], &[0.0], &mut gap);
        assert!(matches!(stiff.defect(dt), Defect::Change(weight) if weight > 0.0));
    }

    #[test]
    fn a_soft_start_switches_to_the_constant_scheme() {
        assert_eq!(
            Memory::new([&zener(0.0)].into_iter(), Scheme::Linear, 1).scheme_of(&[0.1]),
            Scheme::Constant
        );
        assert_eq!(
            Memory::new([&zener(2.0)].into_iter(), Scheme::Linear, 1).scheme_of(&[100.0]),
            Scheme::Linear
        );
    }

    #[test]
    fn the_growth_is_right_where_its_forms_meet() {
        for x in [1e-9, 1e-3, 0.04999999, 0.0500001, 0.7, 30.0] {
            // Simpson's rule on 2000 panels of (1 - exp(-x s))^2/... over \[0, 1\]: error < x^4 1e-13.
            let n = 2000;
            let f = |k: usize| (-x * k as f64 / n as f64).exp_m1().powi(2);
            let sum: f64 =
                (1..n).map(|k| if k % 2 == 1 { 4.0 * f(k) } else { 2.0 * f(k) }).sum::<f64>() + f(0) + f(n);
            let exact = sum / (3.0 * n as f64 * x);
            assert!((mean_square_growth(x) / exact - 1.0).abs() < 1e-8, "{x}");
        }
        assert_eq!(mean_square_growth(0.0), 0.0);
    }

    #[test]
    fn every_part_keeps_its_own_clock() {
        // Two bodies under U(t) = t, one clock fast, one slow: on each clock U runs as xi over its
        // speed, so that u = sum of its integral over the speed.
        let (first, second) = (zener(2.0), zener(0.5));
        let speeds = [3.0, 0.5];
        let mut memory = Memory::new([&first, &second].into_iter(), Scheme::Linear, 1);
        let (mut before, mut last, mut gap) = (vec![0.0], vec![0.0], vec![0.0]);
        let mut t = 0.0;
        for dt in [0.1, 0.03, 2.0, 1e-7, 0.5] {
            let c = memory.history(&speeds.map(|v| v * dt), &before, &last, &[0.0], &mut gap);
            t += dt;
            std::mem::swap(&mut before, &mut last);
            last.fill(t);
            let parts = [&first, &second].into_iter().zip(speeds);
            let exact: f64 = parts.map(|(creep, v)| creep.integral(v * t) / v).sum();
            // A few roundings of numbers up to 20.
            assert!((c * t + gap[0] - exact).abs() < 1e-13, "t = {t}");
        }
    }
}
