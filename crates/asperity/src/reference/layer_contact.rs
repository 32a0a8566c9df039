//! A rigid body of revolution on an elastic layer: depth, load and stiffness over the radius of the contact.
//!
//! With φ(t), 0 <= t <= a, the pressure that is regular at its edge is p^(q) = ∫ φ(t) cos(q t) dt. It is zero outside the
//! contact, and inside it gives the shape of the indenter if (I. N. Sneddon, Fourier Transforms, 1951, section 52; the layer is
//! included as in N. N. Lebedev & Ia. S. Ufliand, J. Appl. Math. Mech. 22 (1958) 442)
//!
//! ```text
//! φ(t) + (2/π) ∫_0^a φ(s) ∫_0^∞ G(q) cos(q t) cos(q s) dq ds = (2/(π c)) (δ - g(t)),   G = q C(q)/c - 1,  c = lim q C(q)
//! ```
//!
//! g is the equivalent plane profile of the shape ([`MdrProfile`]) and δ is the depth, which follows from
//! φ(a) = 0. G decays as exp(-2 q d). With φ_1 the solution for the right-hand side 1, the stiffness of the contact is dW/dδ = 2 E* ∫
//! φ_1 dt = 2 E* ρ. The layer therefore responds like a half-space of the same E* = 2/c with a contact of radius ρ. (The
//! stiffness of a growing contact is that of the flat punch of its radius.)

use std::f64::consts::{FRAC_2_PI, PI};
use std::sync::Arc;

use super::MdrProfile;
use crate::error::{Result, positive, require};
use crate::layer::{Base, Interface, Layer, Stack};
use crate::linear;
use crate::numbers::bisect;

/// Radii of the table.
const RADII: usize = 48;
/// Largest radius of the contact over the thickness.
const WIDEST: f64 = 30.0;
/// Widest contact of a sphere over its diameter.
const BALL: f64 = 0.9;
/// q d from which on G < 1e-16.
const LAST: f64 = 20.0;
/// Points of a panel of the integral over q.
const PANEL: usize = 12;
/// Number of heights of the profile of springs.
const FINE: usize = 2000;

/// A rigid indenter on an elastic layer that lies on a rigid base, in units of E* = 1: E* = 2 G/(1 - ν) of the layer.
///
/// ```
/// use asperity::layer::Interface;
/// use asperity::reference::{LayerContact, MdrProfile};
/// // An incompressible layer under a contact 0.3 times as wide as it is thick: 1.02 times the load of the half-space at that
/// // radius, at a depth of 0.79 of its.
/// let profile = MdrProfile::Paraboloid { radius: 1.0 };
/// let layer = LayerContact::new(profile, 0.1, 0.5, Interface::Bonded, 1e-3)?;
/// let a = 0.03;
/// assert!((layer.depth(a) / (a * a) - 0.794467).abs() < 2e-6);
/// assert!((layer.load(layer.depth(a)) * 2.0 / a.powi(3) - 2.719267).abs() < 2e-5);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct LayerContact {
    profile: MdrProfile,
    table: Arc<Table>,
}

/// The profile of a row of springs that is equivalent to a layer.
#[derive(Clone, Debug)]
pub(crate) struct SpringProfile {
    profile: MdrProfile,
    spacing: f64,
    /// Height over that of `profile`, at equidistant x.
    ratios: Arc<[f64]>,
}

impl SpringProfile {
    /// Height at x \[m\].
    pub(crate) fn height(&self, x: f64) -> f64 {
        let place = x / self.spacing;
        let n = (place as usize).min(self.ratios.len() - 2);
        let share = place - n as f64;
        self.profile.height(x) * (self.ratios[n] + share * (self.ratios[n + 1] - self.ratios[n]))
    }

    /// The x >= 0 of a height.
    pub(crate) fn reach(&self, height: f64) -> f64 {
        let mut high = self.spacing;
        while self.height(high) < height {
            high *= 2.0;
        }
        inverse(high, height, |x| self.height(x))
    }

    /// Mean of (g - g(x0)) / (g(x1) - g(x0)) over x0 < x < x1, by Simpson's rule.
    pub(crate) fn lean(&self, x0: f64, x1: f64) -> f64 {
        let [g0, middle, g1] = [x0, 0.5 * (x0 + x1), x1].map(|x| self.height(x));
        if g1 > g0 { (1.0 + 4.0 * (middle - g0) / (g1 - g0)) / 6.0 } else { 0.5 }
    }
}

/// At equidistant radii a: δ over g(a), ρ/a, and the load over that of the half-space at the depth δ.
#[derive(Debug)]
struct Table {
    spacing: f64,
    depth: Vec<f64>,
    stiffness: Vec<f64>,
    load: Vec<f64>,
}

impl LayerContact {
    /// A layer of this thickness \[m\] and Poisson's ratio on a rigid base, for depths up to `deepest` \[m\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a number is not positive, Poisson's ratio is outside (-1, 0.5], or the width of the contact exceeds
    /// 30 times the thickness of the layer.
    pub fn new(
        profile: MdrProfile,
        thickness: f64,
        poisson: f64,
        interface: Interface,
        deepest: f64,
    ) -> Result<Self> {
        positive("largest depth", deepest, "m")?;
        positive("thickness", thickness, "m")?;
        let layer = Layer { thickness: 1.0, shear: 1.0, poisson, interface };
        let stack = Stack::new(vec![layer], Base::Rigid)?;
        // On a layer the contact of a paraboloid is at most twice as wide as on a half-space at the same depth: its depth is at least
        // a²/(4 R), and that of a cone at least slope a/2. A sphere is steeper than its paraboloid.
        let widest = match profile.apex() {
            MdrProfile::Paraboloid { radius } => 2.0 * (radius * deepest).sqrt(),
            cone => PI * cone.reach(deepest),
        };
        let widest = match profile {
            MdrProfile::Sphere { radius } => widest.min(BALL * radius),
            _ => widest,
        };
        require(
            widest <= WIDEST * thickness,
            "radius of the largest contact on the layer",
            format!("up to {widest:e} m"),
            format!("at most {WIDEST} times its thickness, {thickness:e} m"),
        )?;
        let spacing = widest / RADII as f64;
        let rows: Vec<[f64; 3]> = (1..=RADII + 3)
            .map(|n| solve(&stack, profile, thickness, spacing * n as f64 / thickness))
            .collect();
        // Even functions; for a half-space they are 1.
        let column = |k: usize| std::iter::once(1.0).chain(rows.iter().map(|row| row[k])).collect();
        let table = Table { spacing, depth: column(0), stiffness: column(1), load: column(2) };
        let layer = LayerContact { profile, table: Arc::new(table) };
        let most = layer.depth(widest);
        require(
            most >= deepest || !matches!(profile, MdrProfile::Sphere { .. }),
            "largest depth of the sphere on the layer",
            format!("{deepest:e} m"),
            format!("at most {most:e} m, where the contact is {BALL} times as wide as the sphere"),
        )?;
        Ok(layer)
    }

    /// Depth δ \[m\] at which the contact has the radius `a` \[m\].
    pub fn depth(&self, a: f64) -> f64 {
        self.profile.height(a) * self.at(&self.table.depth, a)
    }

    /// Half of the stiffness dW/dδ of the contact of the radius `a` for E* = 1 \[m\]: `a` itself on a half-space.
    pub fn stiffness(&self, a: f64) -> f64 {
        a * self.at(&self.table.stiffness, a)
    }

    /// Load at the depth `depth` for E* = 1 \[m²\].
    pub fn load(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        self.profile.unit_load(depth) * self.at(&self.table.load, self.radius(depth))
    }

    /// Radius of the contact at a depth \[m\].
    pub fn radius(&self, depth: f64) -> f64 {
        self.inverse(depth, |a| self.depth(a))
    }

    /// The profile with which a half-space responds like the layer to every history of depth or load.
    ///
    /// Each spring of [`super::Mdr`] at x represents the increase of the stiffness when the contact reaches a radius whose ρ is
    /// x, and it touches at the depth of that radius. Because the layer has one creep function and a constant Poisson's ratio,
    /// flat punches of all radii relax alike, and the state inside a contact does not depend on the outside: the springs are
    /// independent, as on a half-space.
    pub(crate) fn springs(&self) -> SpringProfile {
        let last = self.stiffness(self.table.spacing * RADII as f64);
        // ρ may exceed the radius of a sphere.
        let apex = self.profile.apex();
        let ratio = |n: usize| match n {
            0 => 1.0,
            _ => {
                let rho = last * n as f64 / FINE as f64;
                self.depth(self.inverse(rho, |a| self.stiffness(a))) / apex.height(rho)
            }
        };
        SpringProfile {
            profile: apex,
            spacing: last / FINE as f64,
            ratios: (0..=FINE).map(ratio).collect::<Vec<f64>>().into(),
        }
    }

    /// The a with f(a) = value for an increasing function.
    fn inverse(&self, value: f64, f: impl Fn(f64) -> f64) -> f64 {
        inverse(self.table.spacing * (RADII + 3) as f64, value, f)
    }

    fn at(&self, column: &[f64], a: f64) -> f64 {
        let place = (a / self.table.spacing).min((column.len() - 1) as f64);
        let n = (place as usize).saturating_sub(2).min(column.len() - 6);
        let t = place - n as f64;
        // Lagrange's interpolation by six points.
        (0..6)
            .map(|i| {
                let others = (0..6).filter(|j| *j != i);
                let weight: f64 = others.map(|j| (t - j as f64) / (i as f64 - j as f64)).product();
                weight * column[n + i]
            })
            .sum()
    }
}

/// The x between 0 and `high` with f(x) = value for an increasing function, by bisection.
fn inverse(high: f64, value: f64, f: impl Fn(f64) -> f64) -> f64 {
    let [low, high] = bisect([0.0, high], 60, |x| f(x) < value);
    0.5 * (low + high)
}

/// δ/g(a), ρ/a and the load over that of the half-space at the depth δ, for a contact radius of `x` times the thickness of the
/// layer.
fn solve(stack: &Stack, profile: MdrProfile, thickness: f64, x: f64) -> [f64; 3] {
    let count = 16 + (6.0 * x) as usize;
    let rule = gauss(count);
    let nodes: Vec<(f64, f64)> = rule.iter().map(|(t, w)| (0.5 * x * (1.0 + t), 0.5 * x * w)).collect();
    // Panels over q that resolve cos(2 x q).
    let panels = (LAST * x.max(1.0) / 2.0).ceil();
    let length = LAST / panels;
    let inner = gauss(PANEL);
    let unit = stack.short_waves();
    let waves: Vec<(f64, f64)> = (0..panels as usize)
        .flat_map(|n| {
            inner.iter().map(move |(t, w)| (length * (n as f64 + 0.5 * (1.0 + t)), 0.5 * length * w))
        })
        .map(|(q, w)| (q, w * (q * stack.compliance(q) / unit - 1.0)))
        .collect();
    let row = |t: f64| -> Vec<f64> { waves.iter().map(|(q, _)| libm::cos(q * t)).collect() };
    let cosines: Vec<Vec<f64>> = nodes.iter().map(|(t, _)| row(*t)).collect();
    let coupled = |a: &[f64], b: &[f64]| -> f64 {
        FRAC_2_PI * a.iter().zip(b).zip(&waves).map(|((a, b), (_, w))| a * b * w).sum::<f64>()
    };
    // The profile over its value at the edge.
    let at_the_edge = profile.height(x * thickness);
    let shape = |t: f64| profile.height(t * thickness) / at_the_edge;
    let mut rows: Vec<Vec<f64>> = vec![vec![0.0; count + 2]; count];
    for i in 0..count {
        for j in 0..=i {
            let k = coupled(&cosines[i], &cosines[j]);
            rows[i][j] = k * nodes[j].1;
            rows[j][i] = k * nodes[i].1;
        }
        rows[i][i] += 1.0;
        rows[i][count..].copy_from_slice(&[1.0, shape(nodes[i].0)]);
    }
    let [ones, shapes] = linear::solve(rows);
    let edge = row(x);
    let at_edge = |of: &[f64], right: f64| {
        let sum: f64 = (0..count).map(|j| coupled(&edge, &cosines[j]) * nodes[j].1 * of[j]).sum();
        right - sum
    };
    let depth = at_edge(&shapes, 1.0) / at_edge(&ones, 1.0);
    let integral = |of: &[f64]| of.iter().zip(&nodes).map(|(f, (_, w))| f * w).sum::<f64>();
    // W = 2 E* ∫ (δ φ_1 - φ_g) dt.
    let load = 2.0 * (depth * integral(&ones) - integral(&shapes));
    let half_space = profile.unit_load(depth * at_the_edge) / (at_the_edge * thickness);
    [depth, integral(&ones) / x, load / half_space]
}

/// Nodes and weights of Gauss and Legendre on \[-1, 1\], by Newton's method.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    (1..=count)
        .map(|k| {
            let mut x = libm::cos(PI * (k as f64 - 0.25) / (n + 0.5));
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut p, mut before) = (1.0, 0.0);
                for j in 1..=count {
                    let j = j as f64;
                    (p, before) = (((2.0 * j - 1.0) * x * p - (j - 1.0) * before) / j, p);
                }
                slope = n * (x * p - before) / (x * x - 1.0);
                let step = p / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// Poisson's ratio, interface, and (a/d, R δ/a², W c R/a³) of the same equation to 12 digits.
    struct Family(f64, Interface, [[f64; 3]; 4]);

    const FAMILIES: [Family; 3] = [
        Family(
            0.3,
            Interface::Bonded,
            [
                [0.3, 0.838359, 2.701232],
                [1.0, 0.647622, 3.357249],
                [3.0, 0.547169, 6.843446],
                [10.0, 0.512937, 20.206795],
            ],
        ),
        Family(
            0.5,
            Interface::Bonded,
            [
                [0.3, 0.794467, 2.719267],
                [1.0, 0.559415, 3.761334],
                [3.0, 0.407478, 11.626395],
                [10.0, 0.312260, 109.62703],
            ],
        ),
        Family(
            0.2,
            Interface::Slip,
            [
                [0.3, 0.860304, 2.688922],
                [1.0, 0.673981, 3.156245],
                [3.0, 0.560116, 5.950058],
                [10.0, 0.517851, 16.852836],
            ],
        ),
    ];

    #[test]
    fn depth_and_load_of_a_sphere_are_those_of_the_tables() {
        for Family(poisson, interface, rows) in FAMILIES {
            for [x, depth, load] in rows {
                let profile = MdrProfile::Paraboloid { radius: 1.0 };
                let thickness = 1e-2;
                let a = x * thickness;
                let layer =
                    LayerContact::new(profile, thickness, poisson, interface, 1.1 * depth * a * a).unwrap();
                let [found, w] = [layer.depth(a) / (a * a), 2.0 * layer.load(layer.depth(a)) / a.powi(3)];
                // The digits of the table, and interpolation between 48 radii.
                assert!((found / depth - 1.0).abs() < 3e-6, "{poisson} {x}: {found} {depth}");
                assert!((w / load - 1.0).abs() < 3e-6, "{poisson} {x}: {w} {load}");
            }
        }
    }

    #[test]
    fn the_stiffness_is_the_slope_of_the_load() {
        for profile in [MdrProfile::Paraboloid { radius: 1.0 }, MdrProfile::Cone { slope: 0.1 }] {
            let layer = LayerContact::new(profile, 0.02, 0.45, Interface::Bonded, 4e-3).unwrap();
            for depth in [1e-4, 1e-3, 3e-3] {
                let h = 1e-3 * depth;
                let slope = (layer.load(depth + h) - layer.load(depth - h)) / (2.0 * h);
                let stiffness = 2.0 * layer.stiffness(layer.radius(depth));
                // Second order in the step of the difference.
                assert!((slope / stiffness - 1.0).abs() < 1e-5, "{profile:?} {depth}: {slope} {stiffness}");
            }
        }
    }

    #[test]
    fn a_thick_layer_is_a_half_space_and_a_thin_one_is_refused() {
        let profile = MdrProfile::Cone { slope: 0.2 };
        let layer = LayerContact::new(profile, 1e3, 0.3, Interface::Bonded, 1e-3).unwrap();
        let half_space = 1e-3 * profile.reach(1e-3);
        // The contribution of the layer is of order a/d.
        assert!((layer.load(1e-3) / half_space - 1.0).abs() < 1e-4);
        assert!((profile.reach(1e-3) - 1e-3 / (FRAC_PI_2 * 0.2)).abs() < 1e-15);
        assert!(LayerContact::new(profile, 1e-5, 0.3, Interface::Bonded, 1e-3).is_err());
    }
}
