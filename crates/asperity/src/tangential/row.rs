//! The numbers of a row with friction.

use crate::quantities::Quantity;

/// What friction does in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlipRow {
    /// Tangential force along x and y \[N\].
    pub force: [f64; 2],
    /// Displacement of the bodies against each other along x and y since t = 0 \[m\].
    pub displacement: [f64; 2],
    /// Area of the cells in contact that stick \[m^2\].
    pub stick_area: f64,
    /// Area of the cells in contact whose traction is at the limit of friction \[m^2\].
    pub slip_area: f64,
    /// Work of friction since t = 0 \[J\]: heat in the surfaces. Of elastic bodies it grows over a closed loop by the area of the loop.
    pub work: f64,
    /// Change of the force in the step over that of the displacement, along the displacement \[N/m\]; NaN where nothing moves.
    pub stiffness: f64,
    /// How the tractions were solved.
    pub outcome: SlipOutcome,
}

impl SlipRow {
    /// Writes a quantity: one number, or two along x and y.
    pub(crate) fn write(&self, quantity: Quantity, to: &mut [f64]) {
        let one = match quantity {
            Quantity::TangentialForce => return to.copy_from_slice(&self.force),
            Quantity::TangentialDisplacement => return to.copy_from_slice(&self.displacement),
            Quantity::TangentialStiffness => self.stiffness,
            Quantity::StickArea => self.stick_area,
            Quantity::SlipArea => self.slip_area,
            Quantity::SlipWork => self.work,
            Quantity::FrictionIterations => self.outcome.iterations as f64,
            Quantity::FrictionCertificate => self.outcome.certificate,
            _ => f64::NAN,
        };
        to.fill(one);
    }
}

/// How well the tractions of a step are solved, and the work of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlipOutcome {
    /// Iterations of the solver.
    pub iterations: usize,
    /// Applications of K.
    pub convolutions: usize,
    /// Largest violation of the conditions over the displacement under the tractions, weighted by them.
    pub residual: f64,
    /// Certified error of the traction of the step in the energy norm, relative to the largest traction so far.
    pub certificate: f64,
    /// q c K q \[Pa m\], the sum over the cells: the square of that norm.
    pub(crate) energy: f64,
}

impl SlipOutcome {
    /// That of a further solve of the same row: its work adds up.
    pub(crate) fn then(self, next: SlipOutcome) -> SlipOutcome {
        SlipOutcome {
            iterations: self.iterations + next.iterations,
            convolutions: self.convolutions + next.convolutions,
            ..next
        }
    }
}
