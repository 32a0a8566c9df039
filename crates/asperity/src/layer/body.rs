//! Bodies of viscoelastic layers whose response is separable in space and time.
//!
//! If the shear creep functions of all layers (and of the base) are multiples of one function, J_i(t) = s_i J(t), and Poisson's
//! ratios are constant, time multiplies C(q) by one number (correspondence principle: all moduli scale together, and C is
//! inversely proportional to them):
//!
//! ```text
//! C(q, t) = K(q) C(t),   C(t) = sum over the bodies of (1 - nu) J(t)/2 of the material at the surface.
//! ```
//!
//! K is the [`Layered`] kernel of the elastic stacks with moduli 1/s_i. Time stepping with K and the contact creep function C(t)
//! is therefore exact. Elastic stacks are the case of a constant J. In other stacks waves of different lengths creep differently:
//! see [`NonseparableLayers`].

use std::sync::Arc;

use super::{Base, Interface, Layer, Layered, NonseparableLayers, Stack};
use crate::error::{Result, positive};
use crate::material::{Body, Creep};

/// Relative difference of two creep functions that counts as rounding.
const SAME: f64 = 1e-9;

/// A layer of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyLayer {
    /// Thickness \[m\].
    pub thickness: f64,
    /// The interface at its lower face.
    pub interface: Interface,
    /// Its material; the name is that of the layer.
    pub material: Body,
}

/// A body of layers. Without layers it is a half-space.
#[derive(Clone, Debug, PartialEq)]
pub struct LayeredBody {
    /// From the surface down.
    pub layers: Vec<BodyLayer>,
    /// The half-space below; `None` for a rigid base.
    pub base: Option<Body>,
}

impl From<Body> for LayeredBody {
    fn from(body: Body) -> Self {
        LayeredBody { layers: vec![], base: Some(body) }
    }
}

impl LayeredBody {
    /// Its layers and base, from the surface downwards.
    pub fn materials(&self) -> impl Iterator<Item = &Body> {
        self.layers.iter().map(|layer| &layer.material).chain(&self.base)
    }

    /// Path of the `k`th material of the `n`th body in errors.
    pub(super) fn place(&self, n: usize, k: usize) -> String {
        if k < self.layers.len() { format!("body[{n}].layer[{k}]") } else { format!("body[{n}]") }
    }
}

/// The compliance of bodies in space and time.
#[derive(Clone, Debug)]
pub struct Response {
    /// K(q), with unit contact modulus for short waves: at all times if `waves` is `None`, otherwise at t = 0.
    pub kernel: Layered,
    /// Contact creep compliance C(t) that multiplies K \[1/Pa\]: that of the materials at the surface.
    pub creep: Creep,
    /// The creep of each wave, if waves of different lengths creep differently.
    pub waves: Option<Arc<NonseparableLayers>>,
}

/// The response of a body against a rigid one, or of two bodies.
///
/// ```
/// use asperity::layer::{BodyLayer, Interface, LayeredBody, response};
/// use asperity::kernel::Kernel;
/// use asperity::material::{Body, Lateral, Material, Modulus};
/// let rubber = Body {
///     name: "tread".into(),
///     material: Material::zener(Modulus::Shear, 5e6, 2e6, 10.0)?,
///     lateral: Lateral::Poisson(0.49),
///     hardness: None,
/// };
/// let layer = BodyLayer { thickness: 10e-3, interface: Interface::Bonded, material: rubber.clone() };
/// let tread = response(&[LayeredBody { layers: vec![layer.clone()], base: None }])?;
/// assert_eq!(tread.creep, rubber.contact_creep()?);
/// // A uniform pressure squeezes it by d (1 - 2 nu)/(2 G (1 - nu)).
/// let squeezed = tread.kernel.uniform().unwrap_or_default() * tread.creep.value(0.0);
/// assert!((squeezed / (10e-3 * 0.02 / (2.0 * 5e6 * 0.51)) - 1.0).abs() < 1e-14);
/// // On steel its waves creep differently: short ones as rubber, long ones not at all.
/// let material = Material::elastic(Modulus::Young, 210e9)?;
/// let steel = Body { name: "steel".into(), material, lateral: Lateral::Poisson(0.3), hardness: None };
/// let coated = response(&[LayeredBody { layers: vec![layer], base: Some(steel) }])?.waves.ok_or("separable").unwrap();
/// let rise = |q: f64| coated.creep(q).map(|c| c.long_time() / c.instantaneous);
/// assert!((rise(1e4)? - 3.5).abs() < 1e-9 && rise(1e-3)? < 1.02);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if layers creep differently in an unsupported way, naming the layer; as [`Stack::new`] and
/// [`Body::contact_creep`].
pub fn response(bodies: &[LayeredBody]) -> Result<Response> {
    let mut common: Option<Creep> = None;
    let mut separable = true;
    let mut creep = Creep::default();
    let mut stacks = Vec::new();
    for (n, body) in bodies.iter().enumerate() {
        let mut moduli = Vec::new();
        for (k, material) in body.materials().enumerate() {
            material.contact_creep().map_err(|error| error.of(&body.place(n, k)))?;
            let shear = material.shear()?;
            let of_first = common.get_or_insert_with(|| shear.clone());
            match (ratio(&shear, of_first), material.poisson()) {
                (Some(ratio), Some(poisson)) => moduli.push((1.0 / (ratio * size(of_first)), poisson)),
                _ => {
                    separable = false;
                    // Checked like any other layer; its numbers have no effect.
                    moduli.push((1.0 / size(&shear), 0.0));
                }
            }
        }
        if let Some(surface) = body.materials().next() {
            creep = creep.sum(&surface.contact_creep()?);
        }
        stacks.push(stack(body, &moduli)?);
    }
    let kernel = Layered::new(stacks)?;
    if separable {
        return Ok(Response { kernel, creep, waves: None });
    }
    let waves = NonseparableLayers::new(bodies)?;
    Ok(Response { kernel: waves.glassy().clone(), creep, waves: Some(Arc::new(waves)) })
}

/// The elastic stack with these shear moduli and Poisson's ratios.
pub(super) fn stack(body: &LayeredBody, moduli: &[(f64, f64)]) -> Result<Stack> {
    let layer = |(layer, &(shear, poisson)): (&BodyLayer, &(f64, f64))| -> Result<Layer> {
        let thickness = positive(&format!("thickness of {}", layer.material.name), layer.thickness, "m")?;
        Ok(Layer { thickness, shear, poisson, interface: layer.interface })
    };
    let layers = body.layers.iter().zip(moduli).map(layer).collect::<Result<Vec<Layer>>>()?;
    let base = match (&body.base, moduli.last()) {
        (Some(_), Some(&(shear, poisson))) => Base::HalfSpace { shear, poisson },
        _ => Base::Rigid,
    };
    Stack::new(layers, base)
}

/// The largest part of a creep function.
fn size(creep: &Creep) -> f64 {
    creep.terms.iter().map(|term| term.compliance).fold(creep.instantaneous.max(0.0), f64::max).max(
        match creep {
            // Only a dashpot.
            Creep { instantaneous: 0.0, terms, fluidity } if terms.is_empty() => *fluidity,
            _ => 0.0,
        },
    )
}

/// s in a(t) = s b(t); `None` if there is no such s.
fn ratio(a: &Creep, b: &Creep) -> Option<f64> {
    let s = size(a) / size(b);
    let close = |x: f64, y: f64, scale: f64| (x - y).abs() <= SAME * scale;
    let same_terms = a.terms.len() == b.terms.len()
        && a.terms.iter().zip(&b.terms).all(|(of_a, of_b)| {
            close(of_a.retardation_time, of_b.retardation_time, of_b.retardation_time)
                && close(of_a.compliance, s * of_b.compliance, s * size(b))
        });
    let same = same_terms
        && close(a.instantaneous, s * b.instantaneous, s * size(b))
        && close(a.fluidity, s * b.fluidity, s * b.fluidity);
    same.then_some(s).filter(|s| s.is_finite() && *s > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Kernel;
    use crate::material::{Lateral, Material, Modulus};

    fn body(name: &str, material: Material, nu: f64) -> Body {
        Body { name: name.into(), material, lateral: Lateral::Poisson(nu), hardness: None }
    }

    fn layer(thickness: f64, material: Body) -> BodyLayer {
        BodyLayer { thickness, interface: Interface::Bonded, material }
    }

    fn elastic(shear: f64) -> Material {
        Material::elastic(Modulus::Shear, shear).unwrap()
    }

    fn zener(shear: f64, time: f64) -> Material {
        Material::zener(Modulus::Shear, shear, 0.5 * shear, time).unwrap()
    }

    #[test]
    fn a_stack_of_one_relative_creep_separates_whatever_its_moduli_and_ratios() {
        let top = body("top", zener(2e6, 3.0), 0.5);
        // The same law, as Young's moduli: E = 2 (1 + nu) G.
        let young = Material::zener(Modulus::Young, 2.6e6, 1.3e6, 3.0).unwrap();
        let stack =
            LayeredBody { layers: vec![layer(1e-3, top.clone())], base: Some(body("base", young, 0.3)) };
        let separated = response(&[stack]).unwrap();
        assert_eq!(separated.creep, top.contact_creep().unwrap());
        let elastic = Layer { thickness: 1e-3, shear: 2.0, poisson: 0.5, interface: Interface::Bonded };
        let exact = Stack::new(vec![elastic], Base::HalfSpace { shear: 1.0, poisson: 0.3 }).unwrap();
        for q in [10.0, 1e3, 1e5] {
            // Unit contact modulus of the top layer: (1 - nu)/mu = 1/4. Roundings of the ratio of the moduli.
            let k = separated.kernel.symbol(q, 0.0) / (8.0 * exact.compliance(q));
            assert!((k - 1.0).abs() < 1e-13, "{q}: {k}");
        }
    }

    #[test]
    fn two_bodies_add_their_compliance_at_every_wave() {
        let coated = LayeredBody {
            layers: vec![layer(1e-5, body("coating", elastic(2e11), 0.2))],
            base: Some(body("shaft", elastic(8e10), 0.3)),
        };
        let plain = body("glass", elastic(3e10), 0.22);
        let pair = response(&[coated.clone(), plain.clone().into()]).unwrap();
        let own = response(&[coated]).unwrap();
        let glass = plain.contact_creep().unwrap().value(0.0);
        for q in [1e2, 1e5, 1e7] {
            let both = pair.creep.value(0.0) * pair.kernel.symbol(q, 0.0);
            let sum = own.creep.value(0.0) * own.kernel.symbol(q, 0.0) + glass * 2.0 / q;
            assert!((both / sum - 1.0).abs() < 1e-14, "{q}");
        }
        assert_eq!(pair.kernel.uniform(), None);
    }

    #[test]
    fn stacks_that_creep_differently_are_told_and_bad_ones_refused_by_name() {
        let refused = |layers: Vec<BodyLayer>, base: Option<Body>, words: &str| {
            let error = response(&[LayeredBody { layers, base }]).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        let separable = |layers: Vec<BodyLayer>, base: Option<Body>| {
            response(&[LayeredBody { layers, base }]).unwrap().waves.is_none()
        };
        let rubber = body("rubber", zener(1e6, 1.0), 0.5);
        let steel = body("steel", elastic(8e10), 0.3);
        assert!(!separable(vec![layer(1e-3, rubber.clone())], Some(steel.clone())));
        assert!(!separable(vec![layer(1e-3, steel)], Some(rubber.clone())));
        let slower = body("slower", zener(1e6, 1.1), 0.5);
        assert!(!separable(vec![layer(1e-3, rubber.clone()), layer(1e-3, slower)], None));
        let bulk = Body { lateral: Lateral::BulkModulus(1e9), ..rubber.clone() };
        assert!(!separable(vec![layer(1e-3, bulk)], None));
        let fluid = body("fluid", Material::maxwell(Modulus::Shear, 1e6, 1.0).unwrap(), 0.5);
        refused(vec![layer(1e-3, rubber.clone())], Some(fluid), "creep function of fluid");
        for thickness in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
            refused(vec![layer(thickness, rubber.clone())], None, "thickness of rubber");
        }
        refused(vec![], None, "number of layers");
        refused(vec![layer(1.0, body("foam", elastic(1.0), 0.6))], None, "Poisson's ratio of foam");
    }

    #[test]
    fn an_elastic_layer_may_have_a_bulk_modulus() {
        let (shear, nu) = (1e6, 0.4);
        let bulk = 2.0 * shear * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
        for material in [elastic(shear), Material::elastic(Modulus::Young, 2.0 * shear * (1.0 + nu)).unwrap()]
        {
            let by_bulk = Body { lateral: Lateral::BulkModulus(bulk), ..body("a", material, 0.0) };
            let of = |body: Body| {
                response(&[LayeredBody { layers: vec![layer(1e-3, body)], base: None }]).unwrap()
            };
            let [a, b] = [of(by_bulk), of(body("a", elastic(shear), nu))];
            let ratio = a.kernel.symbol(100.0, 0.0) / b.kernel.symbol(100.0, 0.0);
            // Roundings, times 1/(1 - 2 nu).
            assert!(
                (ratio - 1.0).abs() < 1e-13 && (a.creep.value(0.0) / b.creep.value(0.0) - 1.0).abs() < 1e-13
            );
        }
    }
}
