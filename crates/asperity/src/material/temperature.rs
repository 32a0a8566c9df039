//! A material at a constant temperature: E(t, T) = E(t/a_T, T_r) / b_T.

use super::{Material, Shift, VerticalShift};
use crate::error::{Error, Result, require};

/// The effect of a constant temperature on a material: its times are multiplied by a_T, its moduli are divided by b_T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemperatureFactors {
    /// a_T.
    pub times: f64,
    /// b_T.
    pub moduli: f64,
}

impl TemperatureFactors {
    /// The factors at the reference temperature.
    pub const NONE: Self = TemperatureFactors { times: 1.0, moduli: 1.0 };

    /// The factors at a temperature \[K\].
    ///
    /// ```
    /// use asperity::material::{Shift, TemperatureFactors, VerticalShift};
    /// let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    /// let rubber = VerticalShift::Density { reference: 293.15, expansion: 0.0 };
    /// let warm = TemperatureFactors::at(&shift, Some(&rubber), 318.15)?;
    /// assert_eq!((warm.times, warm.moduli), (shift.factor(318.15)?, 293.15 / 318.15));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if a shift is not defined at this temperature, or a_T is not a number.
    pub fn at(shift: &Shift, vertical: Option<&VerticalShift>, kelvin: f64) -> Result<Self> {
        let times = shift.factor(kelvin)?;
        let moduli = vertical.map_or(Ok(1.0), |vertical| vertical.factor(kelvin))?;
        let expected = "within the range of floating-point numbers: check the constants of the shift";
        require(times.is_finite() && times > 0.0, format!("shift factor at {kelvin:.2} K"), times, expected)?;
        Ok(TemperatureFactors { times, moduli })
    }

    /// The material that is `reference` at the reference temperature.
    ///
    /// # Errors
    /// [`Error::Invalid`] if its times or moduli are out of range.
    pub fn of(self, reference: &Material) -> Result<Material> {
        let stretched =
            if self.times == 1.0 { reference.clone() } else { reference.stretched(self.times)? };
        if self.moduli == 1.0 { Ok(stretched) } else { stretched.scaled(1.0 / self.moduli) }
    }

    /// The error for a material with a vertical shift whose temperature changes.
    pub fn not_constant() -> Error {
        Error::invalid(
            "temperature of a material with a vertical shift",
            "changing during the run",
            "constant: moduli that change during a run are not solved; hold the temperature, or leave `vertical` out (then only \
             the times of the material depend on temperature)",
        )
    }
}
