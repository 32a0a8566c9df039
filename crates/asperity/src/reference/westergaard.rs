//! A wave on an elastic half-space, gap D (1 - cos(2 pi x / l)): H. M. Westergaard, J. Appl. Mech. 6 (1939) 49; K. L. Johnson,
//! Contact Mechanics (Cambridge, 1985), section 13.2.
//!
//! The approach of a periodic contact uses the displacement relative to its mean (the mean displacement of a periodic half-space
//! is not determined): approach = D - mean gap.

use std::f64::consts::{PI, TAU};

use super::quadrature::integrate;
use crate::error::{Error, Result, non_negative, positive};
use crate::material::{Creep, Relaxation};

/// The wave D (1 - cos(2 pi x / l)) on an elastic half-space. With m = mean pressure / p*, p* = pi E* D / l, m < 1 (otherwise the
/// contact is full):
///
/// ```text
/// sin^2(pi a / l) = m,   p = 2 p* cos(psi) sqrt(m - sin^2 psi),   psi = pi x / l,
/// mean gap = D (1 - m + m ln m)
/// ```
///
/// where a is half the width of each contact strip (Johnson 1985, eqs 13.7-13.9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Westergaard {
    /// Amplitude D \[m\].
    pub amplitude: f64,
    /// Wavelength l \[m\].
    pub wavelength: f64,
    /// Mean pressure \[Pa\].
    pub mean_pressure: f64,
    /// Mean pressure that just closes the gap, p* = pi E* D / l \[Pa\].
    pub full_contact_pressure: f64,
}

impl Westergaard {
    /// From the mean pressure >= 0 \[Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if a length or the modulus is not positive or the pressure is negative.
    pub fn under_pressure(
        amplitude: f64,
        wavelength: f64,
        contact_modulus: f64,
        mean_pressure: f64,
    ) -> Result<Self> {
        positive("amplitude of the wave", amplitude, "m")?;
        positive("wavelength", wavelength, "m")?;
        positive("contact modulus", contact_modulus, "Pa")?;
        non_negative("mean pressure", mean_pressure, "Pa")?;
        let full_contact_pressure = PI * contact_modulus * amplitude / wavelength;
        Ok(Westergaard { amplitude, wavelength, mean_pressure, full_contact_pressure })
    }

    /// m = mean pressure / p*, at most 1.
    fn closure(&self) -> f64 {
        (self.mean_pressure / self.full_contact_pressure).min(1.0)
    }

    /// Half the width of a strip of contact a \[m\].
    pub fn half_width(&self) -> f64 {
        self.wavelength / PI * self.closure().sqrt().asin()
    }

    /// Fraction of the area in contact, 2 a / l.
    pub fn contact_fraction(&self) -> f64 {
        2.0 / PI * self.closure().sqrt().asin()
    }

    /// Pressure at the distance x from a crest \[Pa\].
    pub fn pressure(&self, x: f64) -> f64 {
        let (m, psi) = (self.closure(), PI * x / self.wavelength);
        let above_full = self.mean_pressure - m * self.full_contact_pressure;
        above_full + 2.0 * self.full_contact_pressure * strip(m, psi)
    }

    /// Mean gap \[m\].
    pub fn mean_gap(&self) -> f64 {
        mean_gap(self.amplitude, self.closure())
    }

    /// Approach, D - mean gap \[m\].
    pub fn approach(&self) -> f64 {
        self.amplitude - self.mean_gap()
    }
}

/// |cos psi| sqrt(m - sin^2 psi), 0 outside the contact.
fn strip(m: f64, psi: f64) -> f64 {
    let (sin, cos) = psi.sin_cos();
    cos.abs() * (m - sin * sin).max(0.0).sqrt()
}

fn mean_gap(amplitude: f64, m: f64) -> f64 {
    if m > 0.0 { amplitude * (1.0 - m + m * m.ln()) } else { amplitude }
}

/// The same wave on a viscoelastic half-space under a mean pressure that is applied at t = 0 and held.
///
/// The contact grows, so the elastic solution holds with C(t) in place of 1/E* (correspondence for growing contact: E. H. Lee and
/// J. R. M. Radok, J. Appl. Mech. 27 (1960) 438):
///
/// ```text
/// m(t) = mean pressure C(t) l / (pi D),   p(x, t) = (2 pi D / l) int E*(t - s) d[cos psi sqrt(m(s) - sin^2 psi)]
/// ```
///
/// as long as m < 1, that is the contact is not full.
#[derive(Clone, Debug, PartialEq)]
pub struct WestergaardStep {
    amplitude: f64,
    wavelength: f64,
    mean_pressure: f64,
    creep: Creep,
    relaxation: Relaxation,
}

impl WestergaardStep {
    /// From the mean pressure >= 0 \[Pa\] and the contact creep compliance C(t).
    ///
    /// # Errors
    /// [`Error::Invalid`] if a length is not positive, the pressure is negative, the creep function is
    /// invalid or has no instantaneous compliance.
    pub fn under_pressure(
        amplitude: f64,
        wavelength: f64,
        creep: &Creep,
        mean_pressure: f64,
    ) -> Result<Self> {
        positive("amplitude of the wave", amplitude, "m")?;
        positive("wavelength", wavelength, "m")?;
        non_negative("mean pressure", mean_pressure, "Pa")?;
        creep.validate()?;
        positive("instantaneous compliance", creep.instantaneous, "1/Pa")?;
        let relaxation = creep.to_relaxation()?;
        Ok(WestergaardStep { amplitude, wavelength, mean_pressure, creep: creep.clone(), relaxation })
    }

    /// m(t) = mean pressure C(t) l / (pi D).
    fn closure(&self, t: f64) -> f64 {
        self.mean_pressure * self.creep.value(t) * self.wavelength / (PI * self.amplitude)
    }

    /// The elastic contact with C(t) in place of 1/E*: its width, contact fraction, gap and approach are those of the
    /// viscoelastic contact at t (its pressure is not).
    ///
    /// # Errors
    /// [`Error::Invalid`] if t is negative or the contact is full by then.
    pub fn shape(&self, t: f64) -> Result<Westergaard> {
        non_negative("time", t, "s")?;
        if self.closure(t) > 1.0 {
            return Err(Error::invalid("time", format!("{t} s"), "before the contact becomes full"));
        }
        let modulus = 1.0 / self.creep.value(t);
        Westergaard::under_pressure(self.amplitude, self.wavelength, modulus, self.mean_pressure)
    }

    /// Pressure at the distance x from a crest and the time t \[Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if t is negative or the contact is full by then.
    pub fn pressure(&self, x: f64, t: f64) -> Result<f64> {
        self.shape(t)?;
        let psi = PI * x / self.wavelength;
        let q = |s: f64| strip(self.closure(s), psi);
        // The time at which x comes into contact: there the integrand starts as a square root.
        let touched = super::quadrature::root(0.0, t, |s| self.closure(s) - psi.sin().powi(2));
        let fading: f64 = self
            .relaxation
            .terms
            .iter()
            .map(|e| {
                let tau = e.relaxation_time;
                e.modulus / tau * integrate(touched, t, |s| ((s - t) / tau).exp() * q(s))
            })
            .sum();
        let scale = TAU * self.amplitude / self.wavelength;
        Ok(scale * (self.relaxation.instantaneous() * q(t) - fading))
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate_to;
    use super::*;
    use crate::material::CreepTerm;

    #[test]
    fn the_wave_has_westergaards_numbers() {
        // E* = 1, D = 0.01, l = 1: (m, a, fraction, p(0), p(a/2), mean gap), 15 digits.
        #[rustfmt::skip]
        let rows = [
            (0.05, 0.07178314656435314, 0.14356629312870628, 0.014049629462081452, 0.01206420434042321, 0.008002133863223005),
            (0.25, 0.16666666666666666, 0.3333333333333333, 0.031415926535897934, 0.025963561328514587, 0.004034264097200273),
            (0.5, 0.25, 0.5, 0.044428829381583664, 0.034516179394862866, 0.0015342640972002735),
            (0.9, 0.39758361765043326, 0.7951672353008665, 0.05960752959477661, 0.038079549988396674, 5.1755359079563265e-05),
        ];
        for (m, a, fraction, p0, p_half, gap) in rows {
            let p_star = PI * 0.01;
            let wave = Westergaard::under_pressure(0.01, 1.0, 1.0, m * p_star).unwrap();
            let near = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-14;
            assert!(near(wave.half_width(), a) && near(wave.contact_fraction(), fraction));
            assert!(near(wave.pressure(0.0), p0) && near(wave.pressure(0.5 * a), p_half));
            assert!((wave.mean_gap() - gap).abs() < 1e-17); // 1 - m + m ln m cancels two digits
            assert!((wave.approach() + gap - 0.01).abs() < 1e-17);
        }
    }

    #[test]
    fn beyond_full_contact_the_pressure_is_a_wave() {
        let wave = Westergaard::under_pressure(0.01, 1.0, 2.0, 0.1).unwrap();
        let p_star = wave.full_contact_pressure;
        assert_eq!(wave.contact_fraction(), 1.0);
        assert!(wave.mean_gap().abs() < 1e-17);
        for x in [0.0, 0.1, 0.37, 0.5] {
            let exact = 0.1 + p_star * (TAU * x).cos();
            assert!((wave.pressure(x) - exact).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn pressures_carry_the_mean_pressure() {
        let wave = Westergaard::under_pressure(0.01, 2.0, 3.0, 0.02).unwrap();
        let a = wave.half_width();
        let mean = 2.0 * integrate(0.0, a, |x| wave.pressure(x)) / 2.0;
        assert!((mean / 0.02 - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_held_pressure_makes_the_strips_grow() {
        // E*(t) = 2 + 2 exp(-t/0.5), D = 0.01, l = 1; the integrals with 15 digits.
        let creep = Creep {
            instantaneous: 0.25,
            terms: vec![CreepTerm { compliance: 0.25, retardation_time: 1.0 }],
            fluidity: 0.0,
        };
        let step = WestergaardStep::under_pressure(0.01, 1.0, &creep, 0.03769911184307752).unwrap();
        #[rustfmt::skip]
        let rows = [
            (0.0, 0.18450505978277268, 0.13765769302909142, 0.0033880815870221915),
            (0.25, 0.2069374921202763, 0.12341745351007627, 0.0026576393690198362),
            (1.0, 0.24670085343628875, 0.10400777393822314, 0.0016071822981607708),
            (4.0, 0.28026402932157124, 0.09736173501401177, 0.0009633669189177241),
        ];
        for (t, a, p0, gap) in rows {
            let shape = step.shape(t).unwrap();
            assert!((shape.half_width() / a - 1.0).abs() < 1e-13);
            assert!((shape.mean_gap() / gap - 1.0).abs() < 1e-13);
            let got = step.pressure(0.0, t).unwrap();
            assert!((got / p0 - 1.0).abs() < 1e-12, "{t}: {got} {p0}");
        }
        // The mean pressure does not change; p has a kink at the edge of the first contact.
        let [first, last] = [0.0, 1.0].map(|t| step.shape(t).unwrap().half_width());
        let strip = |from, to| integrate_to(1e-6, from, to, |p| step.pressure(p.x, 1.0).unwrap_or(f64::NAN));
        let mean = 2.0 * (strip(0.0, first) + strip(first, last));
        assert!((mean / 0.03769911184307752 - 1.0).abs() < 1e-9, "{mean}");
        assert!(step.pressure(0.0, -1.0).is_err());
    }
}
