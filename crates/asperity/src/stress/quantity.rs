//! The fields of the stress at a depth: a component, or an invariant of the tensor.

use super::{Component, Invariants, invariants};
use asperity_sweep::each;

/// Declares the fields: for each its meaning, its name, and its description for axes and legends.
macro_rules! stress_quantities {
    ($($(#[$doc:meta])* $variant:ident = $name:literal: $long_name:literal;)+) => {
        /// A field of the stress.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(
            feature = "serde",
            derive(serde::Serialize, serde::Deserialize),
            serde(rename_all = "kebab-case")
        )]
        #[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
        pub enum StressQuantity {
            $($(#[$doc])* $variant,)+
        }

        impl StressQuantity {
            /// All of them.
            pub const ALL: [StressQuantity; [$($name),+].len()] = [$(StressQuantity::$variant),+];

            /// Its name: "mises", "xx", ...
            pub fn name(self) -> &'static str {
                match self { $(StressQuantity::$variant => $name,)+ }
            }

            /// The name of its field in results: "stress_mises", "stress_xx", ...
            pub fn field_name(self) -> &'static str {
                match self { $(StressQuantity::$variant => concat!("stress_", $name),)+ }
            }

            /// Its description for axes and legends.
            pub fn long_name(self) -> &'static str {
                match self { $(StressQuantity::$variant => $long_name,)+ }
            }
        }
    };
}

// The invariants, then the components in the order of `Component::ALL`.
stress_quantities! {
    /// von Mises stress.
    Mises = "mises": "von Mises stress";
    /// Largest shear stress (s1 - s3)/2.
    Tresca = "tresca": "largest shear stress (Tresca)";
    /// Largest principal stress; positive in tension.
    Tension = "tension": "largest principal stress";
    /// Minus the mean of the normal stresses; positive in compression.
    Pressure = "pressure": "hydrostatic pressure";
    /// Normal stress along x.
    Xx = "xx": "normal stress xx";
    /// Normal stress along y.
    Yy = "yy": "normal stress yy";
    /// Normal stress along z.
    Zz = "zz": "normal stress zz";
    /// Shear stress in the plane.
    Xy = "xy": "shear stress xy";
    /// Shear stress on planes parallel to the surface, along x.
    Xz = "xz": "shear stress xz";
    /// Shear stress on planes parallel to the surface, along y.
    Yz = "yz": "shear stress yz";
}

impl StressQuantity {
    /// The quantity of that name.
    pub fn from_name(name: &str) -> Option<StressQuantity> {
        StressQuantity::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// The component, if it is one.
    pub fn component(self) -> Option<Component> {
        (self as usize).checked_sub(StressQuantity::Xx as usize).map(|n| Component::ALL[n])
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
