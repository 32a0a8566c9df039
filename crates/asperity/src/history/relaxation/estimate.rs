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
//!
//! **Lines.** On a line one or two cells come into contact at a time, and the error of a cell alone is one of a pressure ε/dx, with those of
//! its neighbours of the other sign (π/3 ε/dx in all, from the operator of the half-space). So the cells that come into contact are a sum of
//! their own, over Σ p' dx. Where the displacement is known up to a constant (a free line, always under a load), u - w takes the place of u: the
//! constant drops out of it, and cells that stay in contact have none. What bends the course of all cells alike is |L\[z0, z1, z2\]| Δz² over W, which
//! is 0 where u runs linearly in L. The stress is
//!
//! ```text
//! max( a Σ p', 0.1 a_n Σ p_n, 0.1 a E_inf |L|/dx )/3
//! ```
//!
//! (Under Hertz's pressure U falls by 0.64 a p from the middle to the ends of the contact.)
//!
//! **Tractions on open cells** (adhesion, fluids) are part of the stress. There all cells with a traction count, those apart before first touch
//! too, each with the size of its tractions as its weight, so that those far away do not dilute the error of the others. The largest traction
//! there is that of a cell at the rim, whose error no sum over the cells shows. It has an estimate of its own: what bends the course of u in a
//! cell, times its traction over the largest one, over the displacement of that cell under its own traction.

use super::load_cell::LoadCell;
use super::rules::{Driver, Rules};
use super::shape::{Shape, moment};
use super::survey::{Clock, Found, Sums};
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

/// Share of Σ p' a that is the stress of a line whose displacement is known up to a constant: between the whole fall of U over the contact and
/// its mean.
const FALL: f64 = 1.0 / 3.0;
/// Displacement of a square cell under its own pressure, over the pressure, the side and the compliance: 4 ln(1 + sqrt 2)/π (Love 1929).
const OWN: f64 = 1.122;

/// Sums over the cells at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Survey {
    /// Of what bends the course of u over the stress: in the cells in contact at either end and those apart that would overlap, and in those
    /// that come into contact, where these count alone.
    bends: f64,
    bends_alone: f64,
    /// The stress.
    stress: f64,
    /// Of what bends the course of u in cells in contact at the end, and of their stress; the same of those that count alone.
    pub(super) own: f64,
    pub(super) pressed: f64,
    pub(super) alone: f64,
    pub(super) pressed_alone: f64,
    /// Of what bends it in the cell with the largest traction, or in another one by its traction over the largest; and the displacement of that
    /// cell under its own traction. 0 where tractions act on cells in contact only.
    pub(super) peak: f64,
    pub(super) pressed_peak: f64,
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
        let (approach, driven) = (ends.now.approach, self.driven(ends));
        let Rules { length, driver, .. } = self.rules;
        self.reference = Some(Reference { length, driver, approach, driven });
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
        let [energy, pressure, pressure_before] = sums(
            (&ends.now.pressure[..], &ends.now.unit_displacement[..], &ends.before.pressure[..]),
            |(p, unit, before)| [p * unit, p.abs(), before.abs()],
        );
        let compliance = self.rules.compliance;
        let left = if pressure > 0.0 { self.tolerance * compliance * energy / pressure } else { 0.0 };
        let found = self.found(ends, left);
        let Found { touching, touched, .. } = found;
        let mean = if pressure > 0.0 { touching * energy / pressure } else { 0.0 };
        let relaxed = self.dual.relaxation.equilibrium * found.displaced;
        // Where surfaces pull at each other U may be negative.
        let (now, before) = (if ends.pulls { mean } else { found.now.abs() }, found.before.abs());
        let least = FLOOR * before.max(relaxed).max(pressure * self.size_of(touching));
        let [stress, pressed] = match self.is_relative {
            true => [self.fall([touching, touched], [pressure, pressure_before]); 2],
            false => [now.max(least), mean.max(least)],
        };
        let x = self.rules.length;
        let noise = match x > 0.0 {
            true => self.dual.relaxation.viscosity * (self.total_error.solver + left) * touching / x,
            false => 0.0,
        };
        let weight = if ends.pulls && found.weight > 0.0 { touching / found.weight } else { 1.0 };
        let pressed_alone = self.cell_area * pressure.max(FLOOR * pressure_before);
        let mut survey = Survey {
            bends: weight * found.bends,
            bends_alone: 0.0,
            stress,
            own: weight * (found.own_of_old + found.own_of_new),
            pressed: if touching > 0.0 { pressed } else { 0.0 },
            alone: 0.0,
            pressed_alone,
            peak: if found.largest > 0.0 { found.peak / found.largest } else { 0.0 },
            pressed_peak: match ends.pulls && !self.is_line {
                true => OWN * self.cell_area.sqrt() * found.largest,
                false => 0.0,
            },
            largest: if pressure > 0.0 { found.most / pressure } else { 0.0 },
            staying: if touched > 0.0 { found.stay / touched } else { 1.0 },
            noise,
            left,
        };
        if self.is_line {
            (survey.bends, survey.own) = (weight * found.bends_of_old, weight * found.own_of_old);
            (survey.bends_alone, survey.alone) = (LATE * found.own_of_new, found.own_of_new);
        }
        if self.is_relative {
            // Over the stress: |L[z0, z1, z2]| Δz² over W.
            let bends = self.bends_of_all(ends) * touching * FALL;
            (survey.bends, survey.own) = (survey.bends + bends, survey.own + bends);
        }
        survey
    }

    /// L at the end of the step under way.
    fn driven(&self, ends: &Ends<'_>) -> f64 {
        let LoadCell { start, .. } = &self.cell;
        self.rules.reach(ends.loads[1], start.driver, &start.states)
    }

    /// |L\[z0, z1, z2\]| Δz²: what bends the course of u in all cells alike.
    fn bends_of_all(&self, ends: &Ends<'_>) -> f64 {
        let Some((reference, [step, third])) = self.third_on_clock() else { return 0.0 };
        let (start, end) = (self.cell.start.driver, self.driven(ends));
        let (before, now) = (reference.driven - start, end - start);
        let second = ((before / third - now / step) / (third - step)).abs();
        let spread = ((1.0 / third).abs() + (1.0 / step).abs()) / (third - step).abs();
        let is_rounding = second <= ROUNDING * start.abs().max(end.abs()) * spread;
        if is_rounding { 0.0 } else { second * step * step }
    }

    /// The third state, where there is one, and the end of the step and it on one clock.
    fn third_on_clock(&self) -> Option<(Reference, [f64; 2])> {
        let reference = self.reference.filter(|_| self.rules.length > 0.0)?;
        let (step, third) = reference.clock(self.rules.length, self.rules.driver);
        Some((reference, [step, third]))
    }

    fn found(&self, ends: &Ends<'_>, left: f64) -> Found {
        let known = self.third_on_clock();
        let [step, third] = known.map_or([1.0, f64::INFINITY], |(_, clock)| clock);
        let spread = ((1.0 / third).abs() + (1.0 / step).abs()) / (third - step).abs();
        let [w_before, w] = ends.approaches();
        let w_third = known.map_or(w_before, |(reference, _)| reference.approach);
        let run = run(Sums {
            u: &self.displacement,
            third: &self.third,
            rigid_before: ends.rigid_before,
            traction: &ends.before.pressure,
            traction_now: &ends.now.pressure,
            p: ends.pressures[0],
            p_now: ends.pressures[1],
            unit: &ends.before.unit_displacement,
            unit_now: &ends.now.unit_displacement,
            gap: ends.gap,
            rigid: ends.rigid,
            hardness: ends.hardness,
            compliance: self.rules.compliance,
            approaches: [w_before, w],
            shifts: if self.is_relative { [w_third - w_before, w - w_before] } else { [0.0; 2] },
            is_weighted: ends.pulls,
            is_line: self.is_line,
            clock: Clock {
                step,
                third,
                spread,
                left,
                in_time: self.rules.driver == Driver::Time,
                lasts: self.rules.length > 0.0,
            },
        });
        Found::from(run)
    }

    /// The size of a contact of so many cells \[m\]. Pressures all over it have U about as large as their sum times it (on a periodic domain an
    /// even pressure has none).
    fn size_of(&self, cells: f64) -> f64 {
        match self.is_line {
            true => cells * self.cell_area,
            false => (cells * self.cell_area).sqrt(),
        }
    }

    /// The stress as the fall of U over the contact, of this many cells with these pressures in all, at the end and at the start of the step.
    fn fall(&self, cells: [f64; 2], [now, before]: [f64; 2]) -> f64 {
        let [size, size_before] = cells.map(|cells| self.size_of(cells));
        let relaxed = self.dual.relaxation.equilibrium * self.cell.start.driver.abs() / self.cell_area;
        FALL * (now * size).max(FLOOR * size_before * before).max(FLOOR * relaxed * size.max(size_before))
    }

    /// The estimated error of the step that was surveyed, without those of the steps before; 0 where nothing is remembered.
    pub(super) fn estimate(&self, survey: &Survey) -> f64 {
        let is_known = self.reference.is_some() && self.rules.length > 0.0 && survey.stress > 0.0;
        let defect = 2.0 * self.defect();
        let bends = defect * survey.bends;
        // Shorter steps have less of the one, but more of the other.
        if !(is_known && bends + defect * survey.bends_alone > survey.noise) {
            return 0.0;
        }
        let alone = if survey.bends_alone > 0.0 { survey.bends_alone / survey.pressed_alone } else { 0.0 };
        bends / survey.stress + defect * alone
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
