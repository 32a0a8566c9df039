//! Vertical shifts: the dependence of the moduli of a material on temperature, in addition to its times.
//!
//! ```text
//! E(t, T) = E(t/a_T, T_r) / b_T
//! ```
//!
//! b_T is the factor that reduces a modulus measured at T to the reference temperature T_r (J. D. Ferry, Viscoelastic
//! Properties of Polymers, 3rd ed., 1980, chapter 11). The elasticity of a rubber comes from entropy, so its moduli grow as
//! density times absolute temperature:
//!
//! ```text
//! b_T = T_r rho(T_r) / (T rho(T)) = (T_r/T) (1 + expansion (T - T_r))
//! ```
//!
//! with the expansion of the volume per kelvin. The moduli of a glass do not follow this law.

use super::shift::{increasing_temperatures, interpolated};
use crate::error::{Error, Result, kelvin, positive, require};

/// A vertical shift factor b_T as a function of temperature: moduli at T are those at the reference temperature divided by b_T.
#[derive(Clone, Debug, PartialEq)]
pub enum VerticalShift {
    /// Entropic elasticity: b_T = (T_r/T) (1 + expansion (T - T_r)).
    Density {
        /// T_r \[K\].
        reference: f64,
        /// Relative growth of the volume per kelvin \[1/K\]; 0 for a constant density.
        expansion: f64,
    },
    /// Factors at temperatures, with ln b_T linear in between.
    Table {
        /// (temperature \[K\], ln b_T), in order of temperature.
        points: Vec<(f64, f64)>,
    },
}

impl VerticalShift {
    /// Checks the constants.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a reference that is not positive, an expansion outside the range 0 to 0.01 per kelvin, and a table
    /// without points, out of order, or with factors beyond a thousand.
    pub fn validate(&self) -> Result<()> {
        match self {
            VerticalShift::Density { reference, expansion } => {
                positive("reference temperature of the vertical shift", *reference, "K")?;
                require(
                    (0.0..=0.01).contains(expansion),
                    "expansion of the vertical shift",
                    format!("{expansion:e} 1/K"),
                    "from 0 to 0.01 1/K: the relative growth of the volume per kelvin, about 6e-4 1/K for rubbers",
                )
            }
            VerticalShift::Table { points } => validate_table(points),
        }
    }

    /// b_T at the temperature \[K\].
    ///
    /// ```
    /// use asperity::material::VerticalShift;
    /// // A rubber is stiffer where it is warmer: 20 °C to 80 °C, by 20 %.
    /// let rubber = VerticalShift::Density { reference: 293.15, expansion: 0.0 };
    /// assert!((1.0 / rubber.factor(353.15)? - 353.15 / 293.15).abs() < 1e-15);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`validate`](Self::validate), and for a temperature that is not positive, outside a table, or at which the density
    /// would not be positive.
    pub fn factor(&self, temperature: f64) -> Result<f64> {
        self.validate()?;
        positive("temperature", temperature, "K (absolute)")?;
        match self {
            VerticalShift::Density { reference, expansion } => {
                let volume = 1.0 + expansion * (temperature - reference);
                positive("volume of the vertical shift, relative to the reference", volume, "")?;
                Ok(reference / temperature * volume)
            }
            VerticalShift::Table { points } => {
                let [low, high] = [points[0].0, points[points.len() - 1].0];
                if !(low..=high).contains(&temperature) {
                    return Err(Error::invalid(
                        "temperature",
                        kelvin(temperature),
                        format!(
                            "from {} to {}, as the vertical shift factors are",
                            kelvin(low),
                            kelvin(high)
                        ),
                    ));
                }
                Ok(libm::exp(interpolated(points, temperature)))
            }
        }
    }
}

/// Largest |ln b_T|: moduli of one master curve do not differ by more than a thousand for the same reduced time.
const MOST: f64 = 6.9;

fn validate_table(points: &[(f64, f64)]) -> Result<()> {
    require(!points.is_empty(), "number of vertical shift factors", 0, "at least 1")?;
    for (n, (temperature, ln)) in points.iter().enumerate() {
        positive(&format!("temperature of vertical shift factor {}", n + 1), *temperature, "K (absolute)")?;
        if ln.is_nan() || ln.abs() > MOST {
            let name = format!("vertical shift factor {}", n + 1);
            return Err(Error::invalid(name, libm::exp(*ln), "positive, and from 0.001 to 1000"));
        }
    }
    increasing_temperatures("vertical shift factor", points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_in_the_logarithm_and_ends_at_its_ends() {
        let table = VerticalShift::Table { points: vec![(300.0, 0.2), (310.0, 0.0), (330.0, -0.4)] };
        assert!((table.factor(305.0).unwrap() - 0.1f64.exp()).abs() < 1e-15);
        assert!((table.factor(330.0).unwrap() - (-0.4f64).exp()).abs() < 1e-15);
        assert!(table.factor(331.0).unwrap_err().to_string().contains("300 K to 330 K"));
    }

    #[test]
    fn bad_constants_are_named() {
        let says = |shift: VerticalShift, words: &str| {
            let error = shift.factor(300.0).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        says(VerticalShift::Density { reference: 0.0, expansion: 0.0 }, "reference temperature");
        says(VerticalShift::Density { reference: 300.0, expansion: -1e-4 }, "expansion");
        says(VerticalShift::Table { points: vec![] }, "at least 1");
        says(VerticalShift::Table { points: vec![(300.0, 0.0), (300.0, 0.0)] }, "factor 2");
        says(VerticalShift::Table { points: vec![(300.0, f64::NAN)] }, "factor 1");
    }
}
