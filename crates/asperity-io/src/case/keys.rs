//! What the tables of a case are made of: serde, the units, lists, and the place where faults are reported.

pub use schemars::JsonSchema;
pub use serde::Deserialize;

pub use super::form::{Form, Never, Word};
pub use super::list::{Axes, Two};
pub use super::place::Place;
pub use crate::quantity::range::{
    Decades, Density, Finite, Hurst, NonNegative, Order, Poisson, Positive, PositiveOrInfinite, Share,
    Tolerance,
};
pub use crate::quantity::scalar::Scalar;
pub(crate) use crate::quantity::scalar::deserialize;
pub use crate::quantity::{
    Angle, Compliance, Dimension, EnergyPerArea, Expansion, Fluidity, Frequency, Label, Length, MolarEnergy,
    MolarMass, Number, Prescribed, Pressure, QuantityError, Signed, Temperature, TemperatureDifference, Time,
    Velocity, Viscosity, Whole, dimension,
};
