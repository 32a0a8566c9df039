//! Creep under a changing temperature, in the reduced time of the material.
//!
//! A thermorheologically simple material responds in reduced time (L. W. Morland & E. H. Lee, Trans. Soc. Rheology 4 (1960) 233):
//! u(t) = int C(xi(t) - xi(s)) dU(s) with d xi = dt / a_T(T(t)). Temperature changes the rate of creep, not its amount: moduli
//! keep their values, and there is no thermal expansion.

use crate::material::{Creep, ReducedTime};

/// A contact creep compliance in the reduced time of its body: C(xi(t) - xi(s)).
///
/// ```
/// use asperity::material::{Creep, CreepTerm, ReducedTime, Shift, ThermalCreep};
/// let terms = vec![CreepTerm { compliance: 1e-9, retardation_time: 100.0 }];
/// let creep = Creep { instantaneous: 1e-9, terms, fluidity: 0.0 };
/// // Glassy for 60 s, then 20 K warmer.
/// let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 };
/// let clock = ReducedTime::new(shift.clone(), &[(0.0, 300.0), (60.0, 300.0), (60.0, 320.0)])?;
/// let body = ThermalCreep { creep: creep.clone(), clock };
/// let reduced = 60.0 + 10.0 / shift.factor(320.0)?;
/// assert!((body.value(0.0, 70.0) / creep.value(reduced) - 1.0).abs() < 1e-13);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalCreep {
    /// C over reduced time \[1/Pa\].
    pub creep: Creep,
    /// The reduced time of the temperature history.
    pub clock: ReducedTime,
}

impl ThermalCreep {
    /// C(xi(t) - xi(s)) \[1/Pa\]: the compliance at t for a load applied at s.
    pub fn value(&self, s: f64, t: f64) -> f64 {
        if t < s {
            return 0.0;
        }
        self.creep.value(self.clock.elapsed(s, t))
    }
}
