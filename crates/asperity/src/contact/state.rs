//! The state of a contact: what the solver overwrites and the next solve starts from.

use crate::field::zeros;

/// Pressure, its displacement under unit modulus, and approach.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactState {
    /// p \[Pa\].
    pub pressure: Vec<f64>,
    /// U = K p \[m Pa\]; the displacement is compliance times U.
    pub unit_displacement: Vec<f64>,
    /// w \[m\].
    pub approach: f64,
}

impl ContactState {
    /// No contact, on a grid of `cells` cells.
    pub fn new(cells: usize) -> Self {
        ContactState { pressure: zeros(cells), unit_displacement: zeros(cells), approach: 0.0 }
    }

    /// No contact, at the approach `approach`.
    pub(super) fn lift_off(&mut self, approach: f64) {
        self.pressure.fill(0.0);
        self.unit_displacement.fill(0.0);
        self.approach = approach;
    }
}
