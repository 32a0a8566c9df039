//! The error of a step of waves that creep differently, from three states of u: no solve of its own.
//!
//! The estimate of [`super::super::relaxation::estimate`], wave by wave. Over a step of length x the displacement runs linearly in z (time, or L under load
//! control). What that leaves out of the pressure is, to leading order, for each wave
//!
//! ```text
//! ε^ = 2 u^[z0, z1, z2] Δz² Σ E_i b(x/τ_i)
//! error = Σ |ε| / max( Σ p', 0.1 Σ p_n, 0.1 Σ |E_inf u'| )
//! ```
//!
//! with the sums of the sizes over the cells with a traction at either end, b and its growth with the time since the smooth piece began as there.

use rustfft::num_complex::Complex64;

use super::Spectral;
use crate::convolution::torus::{Spectrum, Torus};
use crate::history::Ends;
use crate::history::relaxation::rules::{Driver, Share};
use crate::history::relaxation::{FLOOR, LATE, Reference, UnderWay, remembered_defect};

impl Spectral {
    /// Keeps the state just solved as the third one, for another step from the same start.
    pub(super) fn keep(&mut self, pressure: &[f64]) {
        self.reference =
            Some(Reference { length: self.length, driver: self.driver, approach: 0.0, driven: 0.0 });
        self.third = self.fresh(pressure).1;
    }

    /// The transform of the pressure at the end of the step under way, and that of u.
    pub(super) fn fresh(&mut self, pressure: &[f64]) -> (Spectrum, Vec<Complex64>) {
        let transform = self.torus.transform(pressure);
        let u = self.end_of(&transform.0);
        (transform, u)
    }

    /// The transform of u at the end of the step under way, under that of the pressure.
    pub(super) fn end_of(&self, p: &[Complex64]) -> Vec<Complex64> {
        let compliance = self.compliance.as_slice().unwrap_or_default();
        let waves = self.recalled.iter().zip(p).enumerate();
        waves.map(|(n, (g, p))| g + compliance[self.waves.quarter_of(n)] * p).collect()
    }

    /// The estimated error of the step under way, which has just been solved; 0 where there is no third state.
    pub(super) fn estimate(&mut self, ends: &Ends<'_>) -> f64 {
        let (before_p, now_p, rigid) = (&ends.before.pressure, &ends.now.pressure, ends.rigid);
        let Some(reference) = self.reference else { return 0.0 };
        if self.under_way != UnderWay::Contact || self.length <= 0.0 || self.third.is_empty() {
            return 0.0;
        }
        let (step, third) = reference.clock(self.length, self.driver);
        let whole = self.length + self.since_kink;
        let b = |tau: f64| Share { taken: 2.0 * remembered_defect(self.length, whole, tau), left: 0.0 };
        let weights = self.waves.sum_of_new(&self.waves.table(self.length, b));
        let (Spectrum(p), u) = self.fresh(now_p);
        // ε^, and the mean of the weights over the pressure.
        let mut curved = Vec::with_capacity(u.len());
        let (mut weighted, mut square) = (0.0, 0.0);
        for (n, u_now) in u.iter().enumerate() {
            let (start, weight, size) =
                (self.displacement[n], weights[self.waves.quarter_of(n)], p[n].norm_sqr());
            let second =
                ((self.third[n] - start) / third - (u_now - start) / step) / (third - step) * step * step;
            curved.push(second * weight);
            weighted += weight * size;
            square += size;
        }
        let weight = if square > 0.0 { weighted / square } else { 0.0 };
        let curved = field_of(&mut self.torus, rigid.len(), |n| curved[n]);
        let touched = (0..rigid.len()).filter(|k| before_p[*k] != 0.0 || now_p[*k] != 0.0);
        let [now, before] = [now_p, before_p].map(|p| p.iter().map(|p| p.abs()).sum::<f64>());
        // E_inf u' counts where the pressure has fallen far below it.
        let relaxed: f64 = match now < before {
            true => {
                let relaxed = |n: usize| u[n] * self.waves.relaxed_modulus(self.waves.quarter_of(n));
                let field = field_of(&mut self.torus, rigid.len(), relaxed);
                touched.map(|k| field[k].abs()).sum()
            }
            false => 0.0,
        };
        // u' - u counts where the approach moves in time.
        let advance = if self.driver == Driver::Time { ends.advance().abs() } else { 0.0 };
        let change = |n: usize| u[n] - self.displacement[n];
        let change = (advance > 0.0).then(|| field_of(&mut self.torus, rigid.len(), change));
        // What the errors of the solves make of it.
        let spread = ((1.0 / third).abs() + (1.0 / step).abs()) / (third - step).abs();
        let rounding = weight * self.noise * ends.now.approach.abs() * spread * step * step;
        let mut error = 0.0;
        for (k, (p, p_now)) in before_p.iter().zip(now_p).enumerate() {
            let presses = *p != 0.0 || *p_now != 0.0;
            if !(presses || rigid[k] < ends.now.approach) {
                continue;
            }
            let own = if curved[k].abs() > rounding { curved[k].abs() } else { 0.0 };
            let late = match &change {
                Some(change) if presses && *p == 0.0 => weight * LATE * (advance - change[k].abs()),
                _ => 0.0,
            };
            error += own.max(late);
        }
        let scale = f64::max(now, FLOOR * before).max(FLOOR * relaxed);
        if scale > 0.0 { error / scale } else { 0.0 }
    }
}

/// The field of `cells` cells with these waves.
fn field_of(torus: &mut Torus, cells: usize, wave: impl Fn(usize) -> Complex64 + Sync) -> Vec<f64> {
    let mut field = vec![0.0; cells];
    torus.back(wave, &mut field);
    field
}
