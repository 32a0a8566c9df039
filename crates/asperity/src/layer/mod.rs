//! Bodies of layers: a tread on its belt, a gasket on its flange, a gel on glass, a coating on steel.
//!
//! A wave of pressure cos(q x) on the surface of a body of plane layers causes a displacement C(q) cos(q x). On a half-space C is
//! (1 - nu)/(mu q); layers change it for waves that are longer than their thickness:
//!
//! ```text
//! short waves   C -> (1 - nu1)/(mu1 q)      of the top layer
//! long waves    C -> (1 - nub)/(mub q)      on a half-space as base
//!               C -> d/M, or 0              on a rigid base (compressible, incompressible)
//! ```
//!
//! | file | content |
//! |---|---|
//! | `compliance` | C(q) of any stack of layers |
//! | `body` | bodies of viscoelastic layers, and whether space and time are separable |
//! | `nonseparable` | the creep of each wave if they are not |
//! | `kernel` | the [`Kernel`](crate::kernel::Kernel) of one or two such bodies |
//! | `hankel` | from C(q) to the displacement around a point load or line load |
//! | `series` | C(q) as a series whose terms have known transforms |
//!
//! Theory: docs/layers.md.

mod body;
mod compliance;
mod hankel;
mod kernel;
mod nonseparable;
#[cfg(test)]
mod samples;
mod series;

pub use body::{BodyLayer, LayeredBody, Response, response};
pub use kernel::Layered;
pub use nonseparable::NonseparableLayers;
pub(crate) use nonseparable::TOLERANCE;

use crate::error::{Error, Result, length, positive, require};
use crate::numbers::extent;

/// The interface between the lower face of a layer and the material below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Interface {
    /// Bonded: both displacements are continuous.
    #[default]
    Bonded,
    /// It slides without friction and remains in contact: the normal displacement is continuous, the shear stress is zero.
    Slip,
}

/// An elastic layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness \[m\].
    pub thickness: f64,
    /// Shear modulus \[Pa\].
    pub shear: f64,
    /// Poisson's ratio, -1 < nu <= 0.5 (0.5: incompressible).
    pub poisson: f64,
    /// The interface to the material below.
    pub interface: Interface,
}

/// The support of the layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base {
    /// A rigid base.
    Rigid,
    /// An elastic half-space.
    HalfSpace {
        /// Shear modulus \[Pa\].
        shear: f64,
        /// Poisson's ratio, -1 < nu <= 0.5.
        poisson: f64,
    },
}

/// Elastic layers on a base. A half-space is a stack without layers.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    layers: Vec<Layer>,
    base: Base,
}

impl Stack {
    /// A stack of layers, from the surface downwards, and their base.
    ///
    /// ```
    /// use asperity::layer::{Base, Interface, Layer, Stack};
    /// // A gasket of rubber, 2 mm on a flange: long waves feel its thickness, d (1 - 2 nu)/(2 mu (1 - nu)).
    /// let rubber = Layer { thickness: 2e-3, shear: 1e6, poisson: 0.45, interface: Interface::Bonded };
    /// let gasket = Stack::new(vec![rubber], Base::Rigid)?;
    /// let long = gasket.compliance(1.0);
    /// assert!((long / (2e-3 * 0.1 / (2e6 * 0.55)) - 1.0).abs() < 1e-4);
    /// // Short ones do not: (1 - nu)/(mu q).
    /// assert!((gasket.compliance(1e5) / (0.55 / (1e6 * 1e5)) - 1.0).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if a thickness or a modulus is not positive and finite, Poisson's ratio is outside (-1, 0.5], or a
    /// rigid base has no layer.
    pub fn new(layers: Vec<Layer>, base: Base) -> Result<Self> {
        for (n, layer) in layers.iter().enumerate() {
            let of = |what: &str| format!("{what} of layer {}", n + 1);
            length(&of("thickness"), layer.thickness)?;
            elasticity(of, layer.shear, layer.poisson)?;
        }
        match base {
            Base::HalfSpace { shear, poisson } => {
                elasticity(|what| format!("{what} of the base"), shear, poisson)?
            }
            Base::Rigid if layers.is_empty() => {
                return Err(Error::invalid("number of layers on a rigid base", 0, "at least 1"));
            }
            Base::Rigid => {}
        }
        Ok(Stack { layers, base })
    }

    /// The layers from the surface down.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The support of the layers.
    pub fn base(&self) -> Base {
        self.base
    }

    /// q C(q) for short waves, (1 - nu)/mu of the material at the surface \[1/Pa\].
    pub fn short_waves(&self) -> f64 {
        match (self.layers.first(), self.base) {
            (Some(top), _) => (1.0 - top.poisson) / top.shear,
            (None, Base::HalfSpace { shear, poisson }) => (1.0 - poisson) / shear,
            (None, Base::Rigid) => 0.0,
        }
    }

    /// q C(q) for long waves: (1 - nu)/mu of a half-space as base, 0 on a rigid base \[1/Pa\].
    pub fn long_waves(&self) -> f64 {
        match self.base {
            Base::HalfSpace { shear, poisson } => (1.0 - poisson) / shear,
            Base::Rigid => 0.0,
        }
    }

    /// Ratio of the largest to the smallest shear modulus of the layers and the base.
    fn contrast(&self) -> f64 {
        let base = match self.base {
            Base::HalfSpace { shear, .. } => Some(shear),
            Base::Rigid => None,
        };
        let [least, most] = extent(self.layers.iter().map(|layer| layer.shear).chain(base));
        most / least
    }

    /// Displacement under a uniform unit pressure that compresses the layers without lateral strain \[m/Pa\], the sum of d (1 - 2
    /// nu)/(2 mu (1 - nu)); `None` on a half-space, where it is undetermined.
    pub fn uniform(&self) -> Option<f64> {
        match self.base {
            Base::Rigid => Some(self.layers.iter().map(Layer::squeezed).sum()),
            Base::HalfSpace { .. } => None,
        }
    }
}

impl Layer {
    /// d/M, where M is the modulus without lateral strain.
    fn squeezed(&self) -> f64 {
        self.thickness * (1.0 - 2.0 * self.poisson) / (2.0 * self.shear * (1.0 - self.poisson))
    }
}

fn elasticity(of: impl Fn(&str) -> String, shear: f64, poisson: f64) -> Result<()> {
    positive(&of("shear modulus"), shear, "Pa")?;
    let expected = "greater than -1 and not greater than 0.5";
    require(poisson > -1.0 && poisson <= 0.5, of("Poisson's ratio"), poisson, expected)
}
