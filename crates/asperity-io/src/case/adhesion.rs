//! `[adhesion]`: an attraction between the surfaces that falls with the gap.

use asperity::traction::{Adhesion as Law, AdhesionLaw};

use super::keys::*;

/// An attraction between the surfaces.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Work of adhesion: the energy that parts a unit area of the surfaces.
    #[schemars(example = "50 mJ/m2")]
    work: EnergyPerArea<NonNegative>,
    /// How the attraction falls with the gap: "exponential", "dugdale", "linear" or "van-der-waals"; "exponential" if not given.
    #[serde(default)]
    law: AdhesionLaw,
    /// Gap over which it falls; of "dugdale" and "linear" the work over the strength. This or `strength`.
    #[schemars(example = "5 nm")]
    range: Option<Length<Positive>>,
    /// Largest attraction, where the surfaces touch. This or `range`.
    #[schemars(example = "10 MPa")]
    strength: Option<Pressure<Positive>>,
    /// Whether to run on cells that snap into contact one by one; false if not given.
    #[serde(default)]
    #[schemars(example = true)]
    allow_unresolved: bool,
    /// Largest change of the attraction in the last pass, relative to all forces; 1e-4 if not given.
    #[schemars(example = 1e-5)]
    tolerance: Option<Number<Tolerance>>,
}

impl Adhesion {
    /// The law.
    pub fn law(&self, at: &Place<'_>) -> Option<Law> {
        at.exactly_one(&["range", "strength"])?;
        let work = self.work.get();
        let range = match (self.range, self.strength) {
            (Some(range), _) => range.get(),
            (None, Some(strength)) => {
                Law { law: self.law, ..Law::new(work, 1.0) }.strength() / strength.get()
            }
            (None, None) => return None,
        };
        if range == 0.0 {
            let help = "give `range`, or leave the section out";
            let message = "a strength gives no range where the work is 0";
            return at.key("strength").fault(message, "a work above 0", help);
        }
        let usual = Law::new(work, range);
        let law = Law {
            law: self.law,
            allow_unresolved: self.allow_unresolved,
            tolerance: self.tolerance.map_or(usual.tolerance, Number::get),
            ..usual
        };
        at.core(law.validate())?;
        Some(law)
    }
}
