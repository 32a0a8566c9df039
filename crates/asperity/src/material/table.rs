//! A measured creep function without any model. It is used in the full hereditary sum, which needs only C(t), and to check a fit.

use crate::error::Result;
use crate::material::data::{Curve, Kind, check_abscissae};

/// C(t), linear between measured points, and constant before the first and after the last point.
///
/// ```
/// use asperity::material::CreepTable;
/// let table = CreepTable::new(&[0.0, 1.0, 3.0], &[1e-9, 2e-9, 3e-9])?;
/// assert_eq!(table.value(2.0), 2.5e-9);
/// assert!((table.integral(3.0) / 6.5e-9 - 1.0).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CreepTable {
    times: Vec<f64>,
    values: Vec<f64>,
    /// Integral from 0 to each time.
    integrals: Vec<f64>,
}

impl CreepTable {
    /// From increasing times \[s\] (0 may be the first) and compliances \[1/Pa\] that never decrease.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) naming the point: fewer than two points, times not in order or repeated, or a compliance that is
    /// negative, not finite, or smaller than the previous one (noise must be smoothed or fitted first).
    pub fn new(times: &[f64], compliances: &[f64]) -> Result<Self> {
        check_abscissae(Kind::CREEP, times, true)?;
        let curve = Curve::new(Kind::CREEP, times, compliances, true)?;
        for (n, pair) in compliances.windows(2).enumerate() {
            if pair[1] < pair[0] {
                let expected = format!(
                    "not less than the one before it, {:e} 1/Pa: in a passive material it does not fall (smooth the data, or fit them)",
                    pair[0]
                );
                return Err(curve.wrong(n + 1, expected));
            }
        }
        let mut sum = times[0] * compliances[0];
        let mut integrals = vec![sum];
        for (t, c) in times.windows(2).zip(compliances.windows(2)) {
            sum += 0.5 * (c[0] + c[1]) * (t[1] - t[0]);
            integrals.push(sum);
        }
        Ok(CreepTable { times: times.to_vec(), values: compliances.to_vec(), integrals })
    }

    /// C(t) \[1/Pa\]; 0 for t < 0.
    pub fn value(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        match self.times.partition_point(|time| *time <= t) {
            0 => self.values[0],
            n if n == self.times.len() => self.values[n - 1],
            n => self.values[n - 1] + self.slope(n) * (t - self.times[n - 1]),
        }
    }

    /// dC/dt \[1/(Pa s)\]: the slope after t.
    pub fn rate(&self, t: f64) -> f64 {
        match self.times.partition_point(|time| *time <= t) {
            0 => 0.0,
            n if n == self.times.len() => 0.0,
            n => self.slope(n),
        }
    }

    /// Integral of C from 0 to t \[s/Pa\], exact for the linear pieces; 0 for t < 0.
    pub fn integral(&self, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        match self.times.partition_point(|time| *time <= t) {
            0 => self.values[0] * t,
            n => self.integrals[n - 1] + 0.5 * (self.values[n - 1] + self.value(t)) * (t - self.times[n - 1]),
        }
    }

    /// The last time that was measured \[s\].
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// `factor` C(t).
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        CreepTable {
            times: self.times.clone(),
            values: self.values.iter().map(|v| factor * v).collect(),
            integrals: self.integrals.iter().map(|v| factor * v).collect(),
        }
    }

    fn slope(&self, n: usize) -> f64 {
        (self.values[n] - self.values[n - 1]) / (self.times[n] - self.times[n - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_straight_pieces_are_exact() {
        let table = CreepTable::new(&[1.0, 2.0, 4.0], &[1.0, 3.0, 4.0]).unwrap();
        assert_eq!([0.5, 1.0, 1.5, 3.0, 4.0, 9.0].map(|t| table.value(t)), [1.0, 1.0, 2.0, 3.5, 4.0, 4.0]);
        assert_eq!([0.5, 1.5, 3.0, 4.0].map(|t| table.rate(t)), [0.0, 2.0, 0.5, 0.0]);
        // 1 up to t = 1, then trapezia, then 4 held.
        assert_eq!([0.5, 1.0, 2.0, 4.0, 5.0].map(|t| table.integral(t)), [0.5, 1.0, 3.0, 10.0, 14.0]);
        assert_eq!((table.value(-1.0), table.integral(-1.0), table.end()), (0.0, 0.0, 4.0));
        assert_eq!(table.scaled(2.0).integral(5.0), 28.0);
    }

    #[test]
    fn a_falling_compliance_is_named() {
        let error = CreepTable::new(&[1.0, 2.0, 4.0], &[1.0, 3.0, 2.0]).unwrap_err().to_string();
        assert!(error.contains("creep compliance of point 3 (time 4e0 s) is 2e0 1/Pa"), "{error}");
        assert!(CreepTable::new(&[1.0, 2.0], &[1.0]).is_err());
        assert!(CreepTable::new(&[1.0, 2.0], &[-1.0, 1.0]).is_err());
    }
}
