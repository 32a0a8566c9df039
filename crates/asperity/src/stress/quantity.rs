//! The fields of the stress at a depth: a component, or an invariant of the tensor.

use super::{Component, Invariants, invariants};
use asperity_sweep::each;

/// A field of the stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum StressQuantity {
    /// von Mises stress.
    Mises,
    /// Largest shear stress (s1 - s3)/2.
    Tresca,
    /// Largest principal stress; positive in tension.
    Tension,
    /// Minus the mean of the normal stresses; positive in compression.
    Pressure,
    /// Normal stress along x.
    Xx,
    /// Normal stress along y.
    Yy,
    /// Normal stress along z.
    Zz,
    /// Shear stress in the plane.
    Xy,
    /// Shear stress on planes parallel to the surface, along x.
    Xz,
    /// Shear stress on planes parallel to the surface, along y.
    Yz,
}

impl StressQuantity {
    /// All of them.
    pub const ALL: [StressQuantity; 10] = [
        StressQuantity::Mises,
        StressQuantity::Tresca,
        StressQuantity::Tension,
        StressQuantity::Pressure,
        StressQuantity::Xx,
        StressQuantity::Yy,
        StressQuantity::Zz,
        StressQuantity::Xy,
        StressQuantity::Xz,
        StressQuantity::Yz,
    ];

    /// Its name: "mises", "xx", ...
    pub fn name(self) -> &'static str {
        match (self, self.component()) {
            (_, Some(component)) => component.name(),
            (StressQuantity::Mises, _) => "mises",
            (StressQuantity::Tresca, _) => "tresca",
            (StressQuantity::Tension, _) => "tension",
            _ => "pressure",
        }
    }

    /// Its description for axes and legends.
    pub fn long_name(self) -> &'static str {
        match self {
            StressQuantity::Mises => "von Mises stress",
            StressQuantity::Tresca => "largest shear stress (Tresca)",
            StressQuantity::Tension => "largest principal stress",
            StressQuantity::Pressure => "hydrostatic pressure",
            StressQuantity::Xx => "normal stress xx",
            StressQuantity::Yy => "normal stress yy",
            StressQuantity::Zz => "normal stress zz",
            StressQuantity::Xy => "shear stress xy",
            StressQuantity::Xz => "shear stress xz",
            StressQuantity::Yz => "shear stress yz",
        }
    }

    /// The quantity of that name.
    pub fn from_name(name: &str) -> Option<StressQuantity> {
        StressQuantity::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// The component, if it is one.
    pub fn component(self) -> Option<Component> {
        // The components follow the four invariants, in the order of `Component::ALL`.
        (self as usize).checked_sub(4).map(|n| Component::ALL[n])
    }

    /// Its field, from the six components in the order of [`Component::ALL`]; all of one length.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn field_into(self, six: &[Vec<f64>; 6], out: &mut [f64]) {
        if let Some(component) = self.component() {
            out.copy_from_slice(&six[component as usize]);
            return;
        }
        let pick: fn(&Invariants) -> f64 = match self {
            StressQuantity::Mises => |whole| whole.mises,
            StressQuantity::Tresca => |whole| whole.tresca,
            StressQuantity::Tension => |whole| whole.tension,
            _ => |whole| whole.pressure,
        };
        assert!(six.iter().all(|field| field.len() == out.len()), "all fields have one length");
        let [xx, yy, zz, xy, xz, yz] = six.each_ref().map(Vec::as_slice);
        each(out, (xx, yy, zz, xy, xz, yz), |out, (xx, yy, zz, xy, xz, yz)| {
            *out = pick(&invariants([xx, yy, zz, xy, xz, yz]));
        });
    }
}
