//! Axisymmetric contact under any history by the method of dimensionality reduction: V. L. Popov and
//! M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction (Springer, 2015),
//! chapters 3 and 7; I. I. Argatov and V. L. Popov, Z. Angew. Math. Mech. 96 (2016) 956 (rebound).
//!
//! A rigid body of revolution on a viscoelastic half-space is equivalent to a row of independent springs along x under the
//! profile g(x) (sphere x^2/R, cone (pi/2) slope |x|). Each spring has the law of the material: its force per length is q(x, t) =
//! int E*(t - s) du(x, s). Then
//!
//! ```text
//! in contact (q > 0): u = approach - g(x);   out of contact: q = 0, the spring recovers freely, u >= approach - g
//! W = 2 int_0^a q dx,   p(r) = -(1/pi) int_r^a q'(x) / sqrt(x^2 - r^2) dx,
//! u(r) = (2/pi) int_0^r u(x) / sqrt(r^2 - x^2) dx
//! ```
//!
//! This is exact for every history, including unloading and reloading, as long as the contact is one disc; [`Mdr::step`] refuses
//! a history that would open it from within.
//!
//! In time a spring's displacement is linear over a step, so that with e = exp(-h/tau), phi = (1 - e) tau / h the force is
//! exactly q = E_inf u + sum E_i z_i, z_i <- e z_i + phi (u_new - u_old): exact under a piecewise linear approach, second order
//! under a load. In space q is linear in g between neighbouring springs, which makes the elastic contact exact; if the previous
//! contact ends within a cell, the error of the edge is a fraction of the cell, and that of load and approach is of second order
//! in the cell over the radius.

use std::f64::consts::{FRAC_PI_2, PI};

use super::layer_contact::SpringProfile;
use super::quadrature::root;
use crate::error::{Error, Result, non_negative, positive, require};
use crate::material::Relaxation;

mod march;
mod profile;
#[cfg(test)]
mod tests;

pub use march::MdrOptions;
pub use profile::MdrProfile;

/// The contact at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MdrState {
    /// Time \[s\].
    pub time: f64,
    /// Load W \[N\].
    pub load: f64,
    /// Approach \[m\]; without contact under load control, that of the apex that just touches.
    pub approach: f64,
    /// Radius of the contact a \[m\].
    pub contact_radius: f64,
}

/// The prescribed quantity at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MdrTarget {
    /// The load W >= 0 \[N\].
    Load(f64),
    /// The approach \[m\].
    Approach(f64),
}

/// A row of springs with their history.
///
/// ```
/// use asperity::material::Relaxation;
/// use asperity::reference::{Mdr, MdrProfile, MdrTarget};
/// // E*(t) = 2 + 2 exp(-t/0.5), a sphere of radius 1 held at the approach 0.04: W ~ E*(t).
/// let relaxation = Relaxation::absolute(2.0, &[(2.0, 0.5)])?;
/// let mut springs = Mdr::new(MdrProfile::Paraboloid { radius: 1.0 }, &relaxation, 0.3, 500)?;
/// let first = springs.step(0.0, MdrTarget::Approach(0.04))?;
/// let later = springs.step(1.0, MdrTarget::Approach(0.04))?;
/// assert!((first.load - 0.042666666666666665).abs() < 1e-14);
/// assert!((later.load / 0.024220486042381074 - 1.0).abs() < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Mdr {
    profile: MdrProfile,
    /// The profile of springs, if the body is a layer.
    layer: Option<SpringProfile>,
    relaxation: Relaxation,
    spacing: f64,
    most_springs: usize,
    time: f64,
    /// Per spring: displacement u, and force per length q.
    displacement: Vec<f64>,
    force: Vec<f64>,
    /// Per spring, then per branch: z_i.
    branches: Vec<f64>,
    /// Position at which q falls to zero.
    contact_radius: f64,
}

/// Largest growth of the row relative to its initial length; beyond it, the estimate of the length is an error.
const GROWTH: usize = 32;

impl Mdr {
    /// An undisturbed row of `springs` springs up to `largest_radius` \[m\]; it is lengthened automatically (up to 32 times) if
    /// the contact grows beyond.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a number is not positive, the relaxation function is invalid, or the
    /// springs are fewer than 2 or more than a million.
    pub fn new(
        profile: MdrProfile,
        relaxation: &Relaxation,
        largest_radius: f64,
        springs: usize,
    ) -> Result<Self> {
        profile.validate()?;
        relaxation.validate()?;
        positive("largest contact radius", largest_radius, "m")?;
        require((2..=1_000_000).contains(&springs), "number of springs", springs, "between 2 and 1000000")?;
        let mut row = Mdr {
            profile,
            layer: None,
            relaxation: relaxation.clone(),
            spacing: largest_radius / springs as f64,
            most_springs: GROWTH * springs + 1,
            time: 0.0,
            displacement: vec![],
            force: vec![],
            branches: vec![],
            contact_radius: 0.0,
        };
        row.lengthen(springs + 1)?;
        Ok(row)
    }

    /// A row that is equivalent to a layer: its radii are ρ, half of the stiffness for E* = 1, and it has no pressure.
    ///
    /// # Errors
    /// As [`Mdr::new`].
    pub(crate) fn on_layer(
        layer: SpringProfile,
        relaxation: &Relaxation,
        largest_radius: f64,
        springs: usize,
    ) -> Result<Self> {
        let row = Mdr::new(MdrProfile::Paraboloid { radius: 1.0 }, relaxation, largest_radius, springs)?;
        Ok(Mdr { layer: Some(layer), ..row })
    }

    /// Advances by `dt` >= 0 \[s\] (0: a jump) to the target.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if `dt` is negative, the load is negative, the target is not finite, a relaxation function with a
    /// viscosity has a jump, the contact would open from within (it would no longer be one disc), or it grows beyond the row.
    pub fn step(&mut self, dt: f64, target: MdrTarget) -> Result<MdrState> {
        non_negative("time step", dt, "s")?;
        self.step_to(self.time + dt, target)
    }

    fn step_to(&mut self, time: f64, target: MdrTarget) -> Result<MdrState> {
        let dt = time - self.time;
        let value = match target {
            MdrTarget::Load(load) => non_negative("load", load, "N")?,
            MdrTarget::Approach(approach) if approach.is_finite() => approach,
            MdrTarget::Approach(approach) => {
                return Err(Error::invalid("approach", approach, "finite, in m"));
            }
        };
        if dt == 0.0 && self.relaxation.viscosity > 0.0 && value != 0.0 {
            return Err(Error::invalid(
                "step of a body without instantaneous compliance",
                "a jump",
                "a ramp of finite duration",
            ));
        }
        let factors = Factors::new(&self.relaxation, dt);
        let mut free = self.free_displacements(&factors);
        // b = g + u_free: the approach at which a spring touches.
        let (approach, edge) = loop {
            let touch: Vec<f64> = free.iter().enumerate().map(|(k, u)| self.height(k) + u).collect();
            let found = match target {
                MdrTarget::Load(load) => self.approach_under(&touch, factors.stiffness, load),
                MdrTarget::Approach(approach) => self.edge_at(&touch, approach).map(|edge| (approach, edge)),
            };
            if let Some((approach, edge)) = found {
                self.require_disc(&touch, approach, edge)?;
                break (approach, edge);
            }
            // New springs are undisturbed.
            self.lengthen(2 * free.len())?;
            free.resize(self.displacement.len(), 0.0);
        };
        self.update(&factors, &free, approach);
        self.time = time;
        self.contact_radius = edge;
        Ok(MdrState { time, load: self.load(), approach, contact_radius: edge })
    }

    fn x(&self, k: usize) -> f64 {
        k as f64 * self.spacing
    }

    fn height(&self, k: usize) -> f64 {
        self.layer.as_ref().map_or_else(|| self.profile.height(self.x(k)), |layer| layer.height(self.x(k)))
    }

    fn reach(&self, height: f64) -> f64 {
        self.layer.as_ref().map_or_else(|| self.profile.reach(height), |layer| layer.reach(height))
    }

    fn lean(&self, x0: f64, x1: f64) -> f64 {
        self.layer.as_ref().map_or_else(|| self.profile.lean(x0, x1), |layer| layer.lean(x0, x1))
    }

    fn lengthen(&mut self, springs: usize) -> Result<()> {
        if springs > self.most_springs {
            let reach = self.x(self.most_springs);
            return Err(Error::invalid(
                "contact radius",
                format!("more than {reach:e} m"),
                "within 32 times the largest radius that the row was made for",
            ));
        }
        self.displacement.resize(springs, 0.0);
        self.force.resize(springs, 0.0);
        self.branches.resize(springs * self.relaxation.terms.len(), 0.0);
        Ok(())
    }

    /// Displacements at the end of a step at which every spring has zero force.
    fn free_displacements(&self, factors: &Factors) -> Vec<f64> {
        let per_spring = self.relaxation.terms.len();
        (0..self.displacement.len())
            .map(|k| {
                let old = self.displacement[k];
                let branches = &self.branches[k * per_spring..(k + 1) * per_spring];
                let memory: f64 = factors
                    .branches
                    .iter()
                    .zip(branches)
                    .map(|(f, z)| f.modulus * (f.decay * z - f.share * old))
                    .sum();
                (factors.drag * old - memory) / factors.stiffness
            })
            .collect()
    }

    /// Position at which the forces of the springs end at this approach; `None` beyond the row.
    fn edge_at(&self, touch: &[f64], approach: f64) -> Option<f64> {
        if approach <= touch[0] {
            return Some(0.0);
        }
        let m = touch.iter().position(|b| *b >= approach)?;
        Some(self.edge_in(touch, m - 1, approach))
    }

    /// The edge within the cell after spring k: b is linear in g there.
    fn edge_in(&self, touch: &[f64], k: usize, approach: f64) -> f64 {
        let share = ((approach - touch[k]) / (touch[k + 1] - touch[k])).clamp(0.0, 1.0);
        let height = self.height(k) + share * (self.height(k + 1) - self.height(k));
        self.reach(height).clamp(self.x(k), self.x(k + 1))
    }

    /// The approach and edge at which the springs carry the load; `None` beyond the row.
    fn approach_under(&self, touch: &[f64], stiffness: f64, load: f64) -> Option<(f64, f64)> {
        if load == 0.0 {
            return Some((touch[0], 0.0));
        }
        // Half the load over the stiffness, int_0^x (approach - b) dx, with the edge at spring k.
        let wanted = 0.5 * load / stiffness;
        let mut below = 0.0; // int_0^(x_k) b dx
        for k in 0..touch.len() - 1 {
            let (x0, x1) = (self.x(k), self.x(k + 1));
            let lean = self.lean(x0, x1);
            let cell = (x1 - x0) * ((1.0 - lean) * touch[k] + lean * touch[k + 1]);
            if touch[k + 1] * x1 - below - cell < wanted {
                below += cell;
                continue;
            }
            let carried = |approach: f64| {
                let edge = self.edge_in(touch, k, approach);
                let lean = self.lean(x0, edge);
                let part = (edge - x0) * ((1.0 - lean) * touch[k] + lean * approach);
                approach * edge - below - if edge > x0 { part } else { 0.0 }
            };
            let approach = root(touch[k], touch[k + 1], |approach| carried(approach) - wanted);
            return Some((approach, self.edge_in(touch, k, approach)));
        }
        None
    }

    /// Springs beyond the edge must not touch; springs within must touch.
    fn require_disc(&self, touch: &[f64], approach: f64, edge: f64) -> Result<()> {
        let slack = 1e-9 * (approach - touch[0]).abs().max(self.height(1));
        let wrong = touch.iter().enumerate().find(|(k, b)| {
            let x = self.x(*k);
            (x > edge && **b < approach - slack) || (x < edge && **b > approach + slack)
        });
        match wrong {
            None => Ok(()),
            Some((k, _)) => Err(Error::invalid(
                format!("contact at the time {} s", self.time),
                format!("open at {edge:e} m and closed at {:e} m from the axis, or the reverse", self.x(k)),
                "one disc; the one-dimensional equivalent holds for no other",
            )),
        }
    }

    fn update(&mut self, factors: &Factors, free: &[f64], approach: f64) {
        let per_spring = self.relaxation.terms.len();
        for (k, free) in free.iter().enumerate() {
            let pressed = approach - self.height(k);
            let touches = pressed > *free;
            let new = if touches { pressed } else { *free };
            let moved = new - self.displacement[k];
            for (f, z) in factors.branches.iter().zip(&mut self.branches[k * per_spring..]) {
                *z = f.decay * *z + f.share * moved;
            }
            self.displacement[k] = new;
            self.force[k] = if touches { factors.stiffness * (pressed - free) } else { 0.0 };
        }
    }

    /// Cells of the contact (x0, x1, q0, q1); the last one ends at the edge with q = 0.
    fn cells(&self) -> impl Iterator<Item = (f64, f64, f64, f64)> {
        let last = self.contact_radius;
        (0..self.force.len() - 1).map_while(move |k| {
            let (x0, x1) = (self.x(k), self.x(k + 1));
            let ends_here = x1 >= last;
            let cell = if ends_here {
                (x0, last, self.force[k], 0.0)
            } else {
                (x0, x1, self.force[k], self.force[k + 1])
            };
            (x0 < last).then_some(cell)
        })
    }

    /// Load W = 2 int_0^a q dx \[N\].
    pub fn load(&self) -> f64 {
        let cell = |(x0, x1, q0, q1): (f64, f64, f64, f64)| {
            let lean = self.lean(x0, x1);
            (x1 - x0) * ((1.0 - lean) * q0 + lean * q1)
        };
        // A sum of no cells is -0.
        0.0 + 2.0 * self.cells().map(cell).sum::<f64>()
    }

    /// Pressure at the distance r from the axis \[Pa\]; infinite on the axis of a cone.
    pub fn pressure(&self, r: f64) -> f64 {
        let cell = |(x0, x1, q0, q1): (f64, f64, f64, f64)| {
            if x1 <= r || x1 <= x0 {
                return 0.0;
            }
            let slope = (q1 - q0) / (self.profile.height(x1) - self.profile.height(x0));
            slope * self.profile.slope_seen(x0.max(r), x1, r)
        };
        // A sum of no cells is -0; the pressure out of contact is 0.
        0.0 - self.cells().map(cell).sum::<f64>() / PI
    }

    /// Normal displacement of the half-space at the distance r from the axis \[m\].
    pub fn displacement(&self, r: f64) -> f64 {
        if r <= 0.0 {
            return self.displacement[0];
        }
        let mut sum = 0.0;
        for k in 0..self.displacement.len() - 1 {
            let (x0, x1) = (self.x(k), self.x(k + 1));
            if x0 >= r {
                break;
            }
            let (g0, g1) = (self.height(k), self.height(k + 1));
            let (u0, u1) = (self.displacement[k], self.displacement[k + 1]);
            let slope = (u1 - u0) / (g1 - g0);
            let [ones, heights] = self.profile.weights_seen(x0, x1.min(r), r);
            sum += (u0 - slope * g0) * ones + slope * heights;
        }
        sum / FRAC_PI_2
    }
}

/// The coefficients of a step, which are the same for every spring.
struct Factors {
    branches: Vec<Branch>,
    /// dq/du over the step: E_inf + sum E_i phi_i + viscosity / dt.
    stiffness: f64,
    /// viscosity / dt.
    drag: f64,
}

struct Branch {
    modulus: f64,
    /// exp(-dt/tau).
    decay: f64,
    /// phi = (1 - exp(-dt/tau)) tau / dt.
    share: f64,
}

impl Factors {
    fn new(relaxation: &Relaxation, dt: f64) -> Self {
        let branches: Vec<Branch> = relaxation
            .terms
            .iter()
            .map(|e| {
                let x = dt / e.relaxation_time;
                let share = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
                Branch { modulus: e.modulus, decay: (-x).exp(), share }
            })
            .collect();
        let drag = if relaxation.viscosity > 0.0 && dt > 0.0 { relaxation.viscosity / dt } else { 0.0 };
        let stiffness =
            relaxation.equilibrium + drag + branches.iter().map(|b| b.modulus * b.share).sum::<f64>();
        Factors { branches, stiffness, drag }
    }
}
