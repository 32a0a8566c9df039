//! The numbers that a step is convolved in: f64, or f32 in mixed precision.

use asperity_convolution::eights::Cell;
use asperity_convolution::lanes::{Journey, Sums};

use crate::operator::Operator;

/// Numbers of the convolution of a step.
pub(super) trait Scalar: Cell {
    /// Of their rounding.
    const EPSILON: f64;
    /// A step and its image on the way.
    fn carry(operator: &mut dyn Operator, journey: Journey<Self>) -> Option<Sums>;
}

impl Scalar for f64 {
    const EPSILON: f64 = f64::EPSILON;
    fn carry(operator: &mut dyn Operator, journey: Journey<f64>) -> Option<Sums> {
        operator.carry(journey)
    }
}

/// Mixed precision: a step's error of 1e-7 is that of a small correction.
impl Scalar for f32 {
    const EPSILON: f64 = f32::EPSILON as f64;
    fn carry(operator: &mut dyn Operator, journey: Journey<f32>) -> Option<Sums> {
        operator.carry_single(journey)
    }
}
