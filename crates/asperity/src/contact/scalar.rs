//! The numbers that the image of a step is made of: f64, or f32 in mixed precision.

use asperity_convolution::Visit;
use asperity_convolution::eights::Cell;
use asperity_convolution::lanes::{Make, Sums};

use crate::operator::Operator;

/// Numbers of the convolution of a step.
pub trait Scalar: Cell {
    /// Of their rounding.
    const EPSILON: f64;
    /// u = K s of what is made, visited.
    fn apply(
        operator: &mut dyn Operator,
        make: &Make<Self>,
        u: &mut [Self],
        visit: &Visit<Self>,
    ) -> [Sums; 2];
}

impl Scalar for f64 {
    const EPSILON: f64 = f64::EPSILON;
    fn apply(operator: &mut dyn Operator, s: &Make<f64>, u: &mut [f64], visit: &Visit<f64>) -> [Sums; 2] {
        operator.apply_made_into(s, u, visit)
    }
}

/// Mixed precision: a step's error of 1e-7 is that of a small correction.
impl Scalar for f32 {
    const EPSILON: f64 = f32::EPSILON as f64;
    fn apply(operator: &mut dyn Operator, s: &Make<f32>, u: &mut [f32], visit: &Visit<f32>) -> [Sums; 2] {
        operator.apply_single_made_into(s, u, visit)
    }
}
