//! Stacks for tests.

use super::{Base, Interface, Layer, Stack};

/// A bonded layer.
pub(super) fn layer(thickness: f64, shear: f64, poisson: f64) -> Layer {
    Layer { thickness, shear, poisson, interface: Interface::Bonded }
}

pub(super) fn stack(layers: &[Layer], base: Base) -> Stack {
    Stack::new(layers.to_vec(), base).unwrap()
}

/// A half-space with Poisson's ratio 0.3.
pub(super) fn half_space(shear: f64) -> Base {
    Base::HalfSpace { shear, poisson: 0.3 }
}
