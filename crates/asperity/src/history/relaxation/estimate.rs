//! The error of a step, from three states of u: no solve of its own.
//!
//! Over a step of length x, u runs linearly in z (time, or L under load control). What that leaves out of the stress is, to
//! leading order,
//!
//! ```text
//! ε = 2 |u[z0, z1, z2]| Δz² [ Σ E_i b(x/τ_i) + ζ/(2x) ],    b(y) = [y - 2 + (y + 2) exp(-y)]/(2 y²)
//! error = Σ ε / max( Σ U', 0.1 Σ U_n, 0.1 E_inf Σ |u'|, 0.1 a Σ p' )
//! ```
//!
//! with b(y) taken (1 - exp(-(T + x)/τ_i))/(1 - exp(-y)) times: the errors of the steps before add up as long as the branch
//! remembers them, and T is how long the smooth piece of the course has lasted, 15 steps at most. Here u\[z0, z1, z2\] is the second divided
//! difference of three states, and the sums of the stress go over the cells in contact at either end: an error of the stress
//! over the stress, not of the displacement over the approach. The second and third bound keep it finite
//! where contact ends or begins, the fourth, with the size a of the contact, where an even pressure on a periodic domain has no U.
//!
//! The sum of ε goes over those cells and over the cells apart whose undeformed surfaces would overlap, h0 < w: a surface that
//! has recovered there touches again, and its error then is one of the pressure.
//!
//! Where the material has no instantaneous compliance, the error that the solver leaves in u makes an error ζ/x times as large of the
//! stress. No step is rejected whose estimate is below that: shorter ones would be worse.
//!
//! A cell that comes into contact during the step moves with the approach w only from then on, and so faster than u' - u over
//! the whole step says. Where u runs linearly in time, a quarter of its gap before the step replaces |u\[z0, z1, z2\]| Δz² if it is
//! larger. (A quarter, because this error does not add up over the steps.)

use super::rules::Driver;
use super::shape::{Shape, moment};
use super::survey::{Clock, Sums};
use super::{Reference, Relaxation};
use crate::history::Ends;
use crate::material::Dual;
use crate::step::Piece;
use asperity_sweep::{each, run, sums};

/// Share of the stress at the start, and of the relaxed one, that an error is measured by at the least.
pub(crate) const FLOOR: f64 = 0.1;
/// Errors of so many steps add up: the curvature of a longer course changes its sign.
const ALIKE: f64 = 16.0;
/// Relative rounding error of u, which a contact closes to some units in the last place of the approach.
pub(crate) const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Share of the error of a cell that comes into contact during the step: the others' errors add up over four steps and more.
pub(crate) const LATE: f64 = 0.25;
/// L may grow by this share in the first step of a smooth piece.
const GROWTH: f64 = 0.2;
/// The first step after a jump is this share of the mean relaxation time.
const FIRST: f64 = 0.2;

/// Sums over the cells at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Survey {
    /// Of what bends the course of u: the cells in contact at either end, and those apart that would overlap.
    bends: f64,
    /// Of the stress.
    stress: f64,
    /// Of what bends the course of u in cells in contact at the end, and of their stress.
    pub(super) own: f64,
    pub(super) pressed: f64,
    /// The pressure that these cells could carry at most, over that of all: no error is larger.
    pub(super) largest: f64,
    /// Share of the cells in contact at the start that still are at the end.
    pub(super) staying: f64,
    /// What the dashpot ζ makes of the errors that the solver leaves in u at both ends.
    noise: f64,
    /// That error at the end \[m\].
    pub(super) left: f64,
}

impl Relaxation {
    /// Keeps the state just solved as the third one, for a shorter step from the same start.
    pub(super) fn keep(&mut self, ends: &Ends<'_>) {
        self.reference = Some(Reference { length: self.rules.length, driver: self.rules.driver });
        let compliance = self.rules.compliance;
        if self.third.is_empty() {
            return;
        }
        let unit = &ends.now.unit_displacement[..];
        each(&mut self.third, (unit, ends.gap, ends.rigid), |third, (unit, gap, rigid)| {
            // A cell that cannot touch has no finite gap, and no say.
            let g = gap - rigid;
            *third = if g.is_finite() { compliance * unit + g } else { 0.0 };
        });
    }

    /// Surveys the cells at the end of the step under way, which has just been solved.
    pub(super) fn survey(&self, ends: &Ends<'_>) -> Survey {
        let Some(reference) = self.reference.filter(|_| self.rules.length > 0.0) else {
            return self.survey_from(ends, [1.0, f64::INFINITY]);
        };
        let (step, third) = reference.clock(self.rules.length, self.rules.driver);
        self.survey_from(ends, [step, third])
    }

    fn survey_from(&self, ends: &Ends<'_>, [step, third]: [f64; 2]) -> Survey {
        let spread = ((1.0 / third).abs() + (1.0 / step).abs()) / (third - step).abs();
        // What the solver leaves of u.
        let [energy, pressure] =
            sums((&ends.now.pressure[..], &ends.now.unit_displacement[..]), |(p, unit)| [p * unit, p.abs()]);
        let compliance = self.rules.compliance;
        let left = if pressure > 0.0 { self.tolerance * compliance * energy / pressure } else { 0.0 };
        let sums = run(Sums {
            u: &self.displacement,
            third: &self.third,
            rigid_before: ends.rigid_before,
            p: ends.pressures[0],
            unit: &ends.before.unit_displacement,
            p_now: ends.pressures[1],
            unit_now: &ends.now.unit_displacement,
            gap: ends.gap,
            rigid: ends.rigid,
            hardness: ends.hardness,
            compliance,
            approaches: ends.approaches(),
            clock: Clock {
                step,
                third,
                spread,
                left,
                in_time: self.rules.driver == Driver::Time,
                lasts: self.rules.length > 0.0,
            },
        });
        let [bends, now, before, displaced, own, touching, most, touched, stay] = sums;
        let staying = if touched > 0.0 { stay / touched } else { 1.0 };
        // U under pressures all over a contact of this size. (On a periodic domain an even pressure has none.)
        let contact = match self.is_line {
            true => touching * self.cell_area,
            false => (touching * self.cell_area).sqrt(),
        };
        let relaxed = self.dual.relaxation.equilibrium * displaced;
        // Where surfaces pull at each other U may be negative.
        let (now, before) = (now.abs(), before.abs());
        let least = FLOOR * before.max(relaxed).max(pressure * contact);
        let mean = if pressure > 0.0 { touching * energy / pressure } else { 0.0 };
        let pressed = if touching > 0.0 { mean.max(least) } else { 0.0 };
        let largest = if pressure > 0.0 { most / pressure } else { 0.0 };
        let x = self.rules.length;
        let noise = match x > 0.0 {
            true => self.dual.relaxation.viscosity * (self.total_error.solver + left) * touching / x,
            false => 0.0,
        };
        Survey { bends, stress: now.max(least), own, pressed, largest, staying, noise, left }
    }

    /// The estimated error of the step that was surveyed, without those of the steps before; 0 where nothing is remembered.
    pub(super) fn estimate(&self, survey: &Survey) -> f64 {
        let is_known = self.reference.is_some() && self.rules.length > 0.0 && survey.stress > 0.0;
        let bends = 2.0 * self.defect() * survey.bends;
        // Shorter steps have less of the one, but more of the other.
        if is_known && bends > survey.noise { bends / survey.stress } else { 0.0 }
    }

    /// The error of the stress that the solver leaves, relative.
    pub(super) fn noise(&self) -> f64 {
        if self.survey.stress > 0.0 { self.survey.noise / self.survey.stress } else { 0.0 }
    }

    /// Σ E_i b(x/τ_i) + ζ/(2x), with what is remembered of the steps before.
    fn defect(&self) -> f64 {
        let (x, relaxation) = (self.rules.length, &self.dual.relaxation);
        let whole = x + self.since_kink;
        let terms = relaxation.terms.iter();
        let terms = terms.map(|e| e.modulus * remembered_defect(x, whole, e.relaxation_time));
        terms.sum::<f64>() + 0.5 * relaxation.viscosity / x
    }

    /// How long the first step of a smooth piece may be \[s\]: a twentieth of the piece at most, or as the material and the load
    /// say.
    pub(super) fn longest_first_step(&mut self, piece: &Piece) -> f64 {
        let longest = piece.length / 20.0;
        let soon = 1e-3 * longest;
        let rate = self.clocks.fastest(piece.start, soon, self.pair.laboratory());
        if self.is_elastic() || rate.is_nan() || rate <= 0.0 {
            return longest;
        }
        let relaxed = if piece.is_after_jump { self::soon(&self.dual, longest, rate) } else { longest };
        let Some(slope) = piece.load_rate(soon) else { return relaxed };
        self.cell.go_on(&self.dual, slope / rate);
        growing(&self.dual, &self.cell.shape, self.cell.end.driver, [relaxed, longest], rate)
    }
}

impl Reference {
    /// The end of the step under way and the third state on one clock: L where it ran one and the same way in both, else time.
    pub(crate) fn clock(self, length: f64, driver: Driver) -> (f64, f64) {
        match (driver, self.driver) {
            (Driver::Load(step), Driver::Load(other)) if step * other > 0.0 => {
                (step, if self.length < 0.0 { -other } else { other })
            }
            _ => (length, self.length),
        }
    }
}

/// The first step after a jump, as far as the material says \[s\].
pub(crate) fn soon(dual: &Dual, longest: f64, rate: f64) -> f64 {
    let relaxation = &dual.relaxation;
    let decay: f64 = relaxation.terms.iter().map(|e| e.modulus / e.relaxation_time).sum();
    match decay > 0.0 && relaxation.viscosity == 0.0 {
        true => longest.min(FIRST * relaxation.instantaneous() / decay / rate),
        false => longest,
    }
}

/// The first step \[s\], at most `first`, in which L does not grow too much from `start`.
pub(crate) fn growing(dual: &Dual, shape: &Shape, start: f64, [first, longest]: [f64; 2], rate: f64) -> f64 {
    let grows = |dt: f64| shape.change(dual, dt * rate).abs() > GROWTH * start.abs();
    let mut first = first;
    while start != 0.0 && grows(first) && first > 1e-15 * longest {
        first *= 0.5;
    }
    first
}

/// b(x/τ) of a step of length x, with what a branch remembers of the steps before: the smooth piece is `whole` long.
pub(crate) fn remembered_defect(x: f64, whole: f64, tau: f64) -> f64 {
    let y = x / tau;
    chord_defect(y) * (moment(0, whole.min(ALIKE * x) / tau) / moment(0, y))
}

/// b(y) = \[y - 2 + (y + 2) exp(-y)\] / (2 y²), y/12 for small y.
pub(super) fn chord_defect(y: f64) -> f64 {
    if y < 0.1 {
        // sum over k >= 3 of (-1)^(k+1) (k - 2)/k! y^k, over 2 y²: six terms leave less than 1e-10 of the first.
        let (mut sum, mut power, mut factorial) = (0.0, y, 6.0);
        for k in 3..9_i32 {
            let sign = if k % 2 == 1 { 1.0 } else { -1.0 };
            sum += sign * f64::from(k - 2) / factorial * power;
            power *= y;
            factorial *= f64::from(k + 1);
        }
        0.5 * sum
    } else {
        (y - 2.0 + (y + 2.0) * libm::exp(-y)) / (2.0 * y * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defect_of_a_chord_is_that_of_a_parabola() {
        // u = t² on [0, 1] under its chord t: integral of (t - t²) exp(-(1 - t) y) y dt, over u'' = 2.
        for y in [1e-6, 0.01, 0.0999999, 0.1, 0.7, 30.0, 1e6] {
            let n = 20_000;
            let f = |k: usize| {
                let t = k as f64 / n as f64;
                // graded towards the end, where the kernel is steep
                let s = 1.0 - (1.0 - t) * (1.0 - t);
                (s - s * s) * (-(1.0 - s) * y).exp() * y * 2.0 * (1.0 - t)
            };
            let sum: f64 = (1..n).map(|k| if k % 2 == 1 { 4.0 * f(k) } else { 2.0 * f(k) }).sum();
            let exact = (sum + f(0) + f(n)) / (3.0 * n as f64) / 2.0;
            // Simpson's rule at y = 1e6 has 14 panels over the kernel's width
            let tolerance = if y > 1e5 { 1e-3 } else { 1e-6 };
            assert!((chord_defect(y) / exact - 1.0).abs() < tolerance, "{y} {} {exact}", chord_defect(y));
        }
    }
}
