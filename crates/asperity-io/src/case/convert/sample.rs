//! A material between its keys and the bodies of the contact.

use asperity::material::{Fractional, Material, Modulus, Shift, VerticalShift};

use crate::curve::Fitted;

/// A material as the case gives it, at its reference temperature.
pub struct Sample {
    pub model: Model,
    /// "zener", "dma", ...
    pub name: &'static str,
    /// How its times depend on temperature.
    pub shift: Option<Shift>,
    /// How its moduli do.
    pub vertical: Option<VerticalShift>,
    /// Its own constant temperature [K].
    pub temperature: Option<f64>,
    /// The file that it was fitted to, and its MD5.
    pub file: Option<(String, String)>,
}

/// What is known of it.
pub enum Model {
    /// All.
    Known(Material),
    /// A fractional model, which becomes a Prony sum over the times of the run.
    Fractional { measure: Modulus, model: Fractional, time: f64, tolerance: f64 },
    /// A fit of measured curves from a file.
    Fitted { fitted: Box<Fitted>, file: String },
}
