//! The shear stress on the area in contact, which adds the adhesive share of friction.

use crate::error::{Of, Result, positive, require};

/// A shear stress over the velocity.
#[derive(Clone, Debug, PartialEq)]
pub enum ShearStress {
    /// The same at all velocities \[Pa\].
    Constant(f64),
    /// Linear in the logarithm of the velocity between points, and held beyond them.
    Table {
        /// (velocity \[m/s\], stress \[Pa\]), velocities above 0 in rising order.
        points: Vec<(f64, f64)>,
    },
    /// τ = peak exp(-(log10(v/velocity)/width)²), of rubber: B. Lorenz, Y. R. Oh, S. K. Nam, S. H. Jeon & B. N. J. Persson, J. Chem.
    /// Phys. 142 (2015) 194701, with c = 1/width². With temperature the velocity shifts as the material does.
    Gaussian {
        /// Largest stress \[Pa\].
        peak: f64,
        /// The velocity at which it acts \[m/s\], at the temperature of the run.
        velocity: f64,
        /// Decades of velocity over which it falls to 1/e.
        width: f64,
    },
}

impl ShearStress {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) naming the key.
    pub fn validate(&self) -> Result<()> {
        let sound = |stress: f64| {
            require(
                stress >= 0.0 && stress.is_finite(),
                "shear stress",
                format!("{stress} Pa"),
                "finite and not negative",
            )
        };
        match self {
            ShearStress::Constant(stress) => sound(*stress),
            ShearStress::Table { points } => {
                require(
                    points.len() > 1,
                    "points of the shear stress",
                    format!("{} in number", points.len()),
                    "two at least",
                )
                .of("points")?;
                points.iter().try_for_each(|(_, stress)| sound(*stress)).of("points")?;
                let rising = points[0].0 > 0.0 && points.windows(2).all(|pair| pair[0].0 < pair[1].0);
                require(
                    rising,
                    "order of the points of the shear stress",
                    "not that of their velocities",
                    "by rising velocities above 0, each once",
                )
                .of("points")
            }
            ShearStress::Gaussian { peak, velocity, width } => {
                sound(*peak).of("peak")?;
                positive("velocity of the largest shear stress", *velocity, "m/s").of("velocity")?;
                positive("width of the shear stress", *width, "decades").of("width")?;
                Ok(())
            }
        }
    }

    /// τ at a velocity \[Pa\]; `slowing` is how much slower a material that is warmer than the run sees it.
    pub fn at(&self, velocity: f64, slowing: f64) -> f64 {
        let v = velocity.abs();
        match self {
            ShearStress::Constant(stress) => *stress,
            ShearStress::Table { points } => {
                let after = points.partition_point(|point| point.0 <= v);
                match (after.checked_sub(1).map(|n| points[n]), points.get(after)) {
                    (Some((v0, t0)), Some((v1, t1))) => {
                        t0 + (t1 - t0) * libm::log(v / v0) / libm::log(v1 / v0)
                    }
                    (Some((_, held)), None) | (None, Some(&(_, held))) => held,
                    (None, None) => f64::NAN,
                }
            }
            ShearStress::Gaussian { .. } if v == 0.0 => 0.0,
            ShearStress::Gaussian { peak, velocity, width } => {
                let decades = libm::log10(v * slowing / velocity) / width;
                peak * libm::exp(-decades * decades)
            }
        }
    }

    /// The velocities of the first and the last point of a table \[m/s\].
    pub fn known(&self) -> Option<[f64; 2]> {
        match self {
            ShearStress::Table { points } => Some([points.first()?.0, points.last()?.0]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gaussian_falls_by_e_over_its_width_and_shifts_with_the_material() {
        let law = ShearStress::Gaussian { peak: 2.0, velocity: 1e-2, width: 1.5 };
        assert_eq!(law.at(1e-2, 1.0), 2.0);
        let decades = |n: f64| 10f64.powf(n);
        // Powers of ten are known to roundings.
        assert!((law.at(-1e-2 * decades(1.5), 1.0) - 2.0 / std::f64::consts::E).abs() < 1e-14);
        assert!((law.at(1.0, 1e-2) - 2.0).abs() < 1e-14);
        assert_eq!(law.at(0.0, 1.0), 0.0);
    }

    #[test]
    fn a_table_is_linear_in_the_logarithm_and_held_at_its_ends() {
        let law = ShearStress::Table { points: vec![(1e-3, 1.0), (1e-1, 5.0)] };
        assert!((law.at(1e-2, 1.0) - 3.0).abs() < 1e-14);
        assert_eq!([law.at(0.0, 1.0), law.at(1.0, 0.1)], [1.0, 5.0]);
        let wrong = ShearStress::Table { points: vec![(1e-3, 1.0), (1e-3, 5.0)] };
        assert!(law.validate().is_ok() && wrong.validate().is_err());
    }
}
