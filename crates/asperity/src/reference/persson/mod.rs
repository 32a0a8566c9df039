//! Persson's theory of rubber friction and contact: B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840; the factor S of
//! partial contact: C. Yang and B. N. J. Persson, J. Phys.: Condens. Matter 20 (2008) 215214.
//!
//! For a rigid rough surface that slides at the speed v over a half-space of complex contact modulus E*(w) under the nominal
//! pressure s0:
//!
//! ```text
//! G(q) = (1/8) int_(|k| < q) d2k k^2 C(k) |E*(k_e v)/s0|^2
//! P(q) = erf(1 / (2 sqrt G)),   S(q) = 1/2 + P^2/2
//! mu   = (1/(2 s0)) int d2q |q| q_e C(q) S(q) P(q) E''(q_e v)
//! ```
//!
//! with k_e the component of k along the motion and <h^2> = int C d2q. P(q) is the fraction of the nominal area that is in
//! contact if waves shorter than 2 pi/q are ignored. With P = S = 1, at high pressure, mu s0 is exact
//! ([`full_contact_friction`](crate::reference::full_contact_friction)). In partial contact it is an estimate: the theory does
//! not include the shape of the contact spots, and it is not valid if the motion itself shrinks the contact (S. Sukhomlinov and
//! M. H. Mueser, Appl. Surf. Sci. Adv. 6 (2021) 100182).

mod shells;

use std::sync::Arc;

use rayon::prelude::*;

use crate::error::{Error, Result, positive, require};
use crate::material::{Creep, integrate};
use crate::sliding::Direction;
use crate::surface::Surface;
use shells::{Fineness, Isotropic, Shells, Waves};

/// The reduction of the strain below partial contact compared with full contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Correction {
    /// S = 1 (Persson 2001).
    None,
    /// S = 1/2 + P^2/2 (Yang and Persson 2008).
    #[default]
    YangPersson,
}

/// Persson's theory for one surface, material and nominal pressure.
///
/// ```
/// use asperity::material::{Creep, CreepTerm};
/// use asperity::reference::{Correction, Persson};
/// use asperity::sliding::Direction;
/// use asperity::surface::{Roughness, SelfAffine, Surface};
/// let grid = asperity::Grid::new([64, 64], [1e-3, 1e-3])?;
/// let roughness = SelfAffine {
///     hurst: 0.8,
///     roughness: Roughness::RmsGradient(0.1),
///     longest: 5e-4,
///     roll_off: 5e-4,
///     shortest: 5e-5,
///     seed: 1,
/// };
/// let surface = Surface::new(grid, roughness.heights(&grid)?)?;
/// let terms = vec![CreepTerm { compliance: 0.9e-6, retardation_time: 1e-3 }];
/// let rubber = Creep { instantaneous: 0.1e-6, terms, fluidity: 0.0 };
/// let theory = Persson::of_surface(&surface, Direction::X, &rubber, 1e4, Correction::YangPersson)?;
/// let slow = theory.at(1e-4)?;
/// let fast = theory.at(1.0)?;
/// // A tenfold modulus, a tenth of the contact: erf(x) ~ x.
/// assert!(fast.contact_fraction < 0.15 * slow.contact_fraction);
/// assert!(fast.friction_coefficient > 0.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Persson {
    shells: Arc<dyn Shells>,
    creep: Creep,
    pressure: f64,
    correction: Correction,
}

/// Friction and contact at one velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerssonFriction {
    /// Velocity \[m/s\].
    pub velocity: f64,
    /// Friction coefficient, not negative: the friction opposes a motion of either sign.
    pub friction_coefficient: f64,
    /// Share of the nominal area in contact.
    pub contact_fraction: f64,
}

/// Friction and contact as a function of the magnification, at one velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Magnification {
    /// Wave number up to which waves are included \[1/m\].
    pub wave_number: Vec<f64>,
    /// Share of the nominal area in contact.
    pub contact_fraction: Vec<f64>,
    /// Friction coefficient of these waves; the last value is that of all waves.
    pub friction_coefficient: Vec<f64>,
}

impl Persson {
    /// From the waves of a periodic surface that slides in a direction. Each wave has its own direction, so the friction of an
    /// anisotropic surface depends on the direction. Level a measured surface first and continue it by its reflections, because
    /// its borders otherwise act as steps.
    ///
    /// `creep` is the contact creep compliance at the temperature of the contact ([`Creep::stretched`]), `pressure` the nominal
    /// one \[Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if the surface is flat or has an undefined point, the angle is not finite, the pressure is not
    /// positive, or the creep function is that of a fluid or of a rigid body.
    pub fn of_surface(
        surface: &Surface,
        direction: Direction,
        creep: &Creep,
        pressure: f64,
        correction: Correction,
    ) -> Result<Self> {
        Persson::new(Arc::new(Waves::of(surface, direction)?), creep, pressure, correction)
    }

    /// From an isotropic spectrum C(q) \[m^4\] at increasing wave numbers \[1/m\], normalised as in
    /// [`RadialSpectrum`](crate::surface::statistics::RadialSpectrum): <h^2> = int C d2q/(2 pi)^2, so (2 pi)^2 times the C of
    /// Persson's papers. C is a power law between the points and 0 outside.
    ///
    /// ```
    /// use asperity::material::Creep;
    /// use asperity::reference::{Correction, Persson};
    /// // Elastic, C = q^-4 on a decade: <|grad h|^2> = ln(10) / (2 pi), G = <|grad h|^2> (E*/s0)^2 / 8.
    /// let (q, c) = ([1.0, 10.0], [1.0, 1e-4]);
    /// let theory = Persson::of_spectrum(&q, &c, &Creep::elastic(1.0), 0.1, Correction::None)?;
    /// let g = 10f64.ln() / std::f64::consts::TAU / 8.0 / 0.01;
    /// let expected = libm::erf(0.5 / g.sqrt());
    /// assert!((theory.at(1.0)?.contact_fraction / expected - 1.0).abs() < 1e-7);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if the wave numbers do not increase, C is negative, or C is 0 everywhere, the pressure is not positive,
    /// or the creep function is that of a fluid or of a rigid body.
    pub fn of_spectrum(
        wave_number: &[f64],
        power: &[f64],
        creep: &Creep,
        pressure: f64,
        correction: Correction,
    ) -> Result<Self> {
        let spectrum = Isotropic::new(wave_number, power, Fineness::default())?;
        Persson::new(Arc::new(spectrum), creep, pressure, correction)
    }

    fn new(shells: Arc<dyn Shells>, creep: &Creep, pressure: f64, correction: Correction) -> Result<Self> {
        creep.validate_solid()?;
        positive("nominal pressure", pressure, "Pa")?;
        Ok(Persson { shells, creep: creep.tidy(), pressure, correction })
    }

    /// Friction and contact at a velocity \[m/s\]; only its absolute value matters. At rest the friction is 0.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the velocity is not finite, or the pressure is so small that G overflows.
    pub fn at(&self, velocity: f64) -> Result<PerssonFriction> {
        let (contact_fraction, friction_coefficient) = self.accumulate(velocity, |_, _, _| {})?;
        Ok(PerssonFriction { velocity, friction_coefficient, contact_fraction })
    }

    /// Friction and contact at several velocities, in parallel.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub fn sweep(&self, velocities: &[f64]) -> Result<Vec<PerssonFriction>> {
        velocities.par_iter().map(|v| self.at(*v)).collect()
    }

    /// Friction and contact over the magnification, at one velocity.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub fn magnification(&self, velocity: f64) -> Result<Magnification> {
        let mut curve =
            Magnification { wave_number: vec![], contact_fraction: vec![], friction_coefficient: vec![] };
        self.accumulate(velocity, |wave_number, contact, friction| {
            curve.wave_number.push(wave_number);
            curve.contact_fraction.push(contact);
            curve.friction_coefficient.push(friction);
        })?;
        Ok(curve)
    }

    /// Contact fraction and friction coefficient; calls `visit` with those at the end of each shell.
    fn accumulate(&self, velocity: f64, mut visit: impl FnMut(f64, f64, f64)) -> Result<(f64, f64)> {
        require(velocity.is_finite(), "velocity", velocity, "finite, in m/s")?;
        let (mut root, mut friction) = (0.0, 0.0);
        self.shells.each(&self.creep, velocity.abs(), &mut |shell| {
            // sqrt(G), which does not overflow if G would.
            let next = libm::hypot(root, shell.square.sqrt() / self.pressure);
            friction += shell.stress / self.pressure * self.mean_share(root, next);
            root = next;
            visit(shell.wave_number, contact_fraction(root), friction);
        });
        if !(root.is_finite() && friction.is_finite()) {
            let expected = format!("large enough for the modulus of the material: sqrt(G) is {root:e}");
            return Err(Error::invalid("nominal pressure", format!("{:e} Pa", self.pressure), expected));
        }
        Ok((contact_fraction(root), friction))
    }

    /// Mean of S P over a shell in which G increases linearly between the squares of two roots.
    fn mean_share(&self, from: f64, to: f64) -> f64 {
        /// Below this width the middle represents the shell, to about 1e-7.
        const NARROW: f64 = 1e-3;
        if !to.is_finite() {
            return 0.0;
        }
        if to - from < NARROW {
            return self.share(0.5 * (from + to));
        }
        // dG = 2 root droot; S P root is smooth on pieces that grow with their distance from 0.
        let (mut sum, mut start) = (0.0, from);
        while start < to {
            let end = to.min(start + start.max(0.5));
            sum += integrate(start, end, |root| 2.0 * root * self.share(root));
            start = end;
        }
        sum / ((to - from) * (to + from))
    }

    /// S P at the root of G.
    fn share(&self, root: f64) -> f64 {
        let contact = contact_fraction(root);
        match self.correction {
            Correction::None => contact,
            Correction::YangPersson => contact * (0.5 + 0.5 * contact * contact),
        }
    }
}

/// P at the root of G.
fn contact_fraction(root: f64) -> f64 {
    libm::erf(0.5 / root)
}

#[cfg(test)]
mod tests;
