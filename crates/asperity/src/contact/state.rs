//! The state of a contact: what the solver overwrites and the next solve starts from.

use asperity_sweep::is_zero;

/// The share of a solver's tolerance that the rounding error of U may take.
const ROUNDING_SHARE: f64 = 1e-2;

/// Pressure, its displacement under unit modulus, and approach.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactState {
    /// p \[Pa\].
    pub pressure: Vec<f64>,
    /// U = K p \[m Pa\]; the displacement is compliance times U.
    pub unit_displacement: Vec<f64>,
    /// w \[m\].
    pub approach: f64,
    /// A bound of the rounding error of U, in those of one convolution: each is some 1e-16 of the largest U.
    pub(crate) rounding: f64,
}

impl ContactState {
    /// No contact, on a grid of `cells` cells. It takes no memory until it is written.
    pub fn new(cells: usize) -> Self {
        let [pressure, unit_displacement] = [(); 2].map(|()| vec![0.0; cells]);
        ContactState { pressure, unit_displacement, approach: 0.0, rounding: 0.0 }
    }

    /// Whether the rounding error of U stays below what a solver's `tolerance` shows.
    pub(crate) fn is_precise(&self, tolerance: f64) -> bool {
        f64::EPSILON * self.rounding <= ROUNDING_SHARE * tolerance
    }

    /// Takes over another state, without new memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.pressure.copy_from_slice(&other.pressure);
        self.unit_displacement.copy_from_slice(&other.unit_displacement);
        (self.approach, self.rounding) = (other.approach, other.rounding);
    }

    /// Whether any cell is under pressure.
    pub fn touches(&self) -> bool {
        self.pressure.iter().any(|p| *p != 0.0)
    }

    /// No contact, at the approach `approach`.
    pub(super) fn lift_off(&mut self, approach: f64) {
        for field in [&mut self.pressure, &mut self.unit_displacement] {
            if !is_zero(field) {
                field.fill(0.0);
            }
        }
        self.approach = approach;
        self.rounding = 0.0;
    }

    /// How far another state is from this one in the energy norm, of this one's.
    #[cfg(test)]
    pub(super) fn energy_distance(&self, other: &Self) -> f64 {
        let (mut energy, mut off) = (0.0, 0.0);
        for n in 0..self.pressure.len() {
            let [p, u] = [self.pressure[n], self.unit_displacement[n]];
            energy += p * u;
            off += (p - other.pressure[n]) * (u - other.unit_displacement[n]);
        }
        (off / energy).sqrt()
    }
}
