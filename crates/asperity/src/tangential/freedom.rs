//! Which way the traction of a cell may move.

use super::vector::{Vector, inner, length, times};

/// A traction this share short of the edge of its disc is inside. A step along a chord leaves the edge by the square of its angle.
pub(crate) const EDGE: f64 = 1e-6;

/// Of a cell, to first order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Freedom {
    /// Nowhere: no pressure.
    #[default]
    Fixed,
    /// Anywhere: it sticks, or is pulled back inside.
    Free,
    /// Along the edge of its disc: it slips. The Hessian of the Lagrangian is larger there by the pull outwards over the radius;
    /// `weight` scales that away.
    Along { tangent: Vector, weight: f64 },
}

impl Freedom {
    /// By the place in the disc alone.
    pub(super) fn in_disc(q: Vector, radius: f64) -> Self {
        if radius == 0.0 {
            return Freedom::Fixed;
        }
        match outward(q, radius) {
            Some([nx, ny]) => Freedom::Along { tangent: [-ny, nx], weight: 1.0 },
            None => Freedom::Free,
        }
    }

    /// With the gradient r: a cell at the edge that is pulled inwards is free. `own` is the compliance of a cell by itself.
    pub(super) fn under(q: Vector, radius: f64, r: Vector, own: f64) -> Self {
        match Self::in_disc(q, radius) {
            Freedom::Along { tangent, .. } => {
                let outwards = -inner(r, [tangent[1], -tangent[0]]);
                let weight = (1.0 + outwards / (radius * own)).sqrt().recip();
                if outwards < 0.0 { Freedom::Free } else { Freedom::Along { tangent, weight } }
            }
            other => other,
        }
    }

    /// The part of a vector that may be.
    pub(super) fn project(self, v: Vector) -> Vector {
        match self {
            Freedom::Fixed => [0.0; 2],
            Freedom::Free => v,
            Freedom::Along { tangent, .. } => times(inner(tangent, v), tangent),
        }
    }

    /// The projection as a tensor.
    pub(super) fn tensor(self) -> [f64; 3] {
        match self {
            Freedom::Fixed => [0.0; 3],
            Freedom::Free => [1.0, 0.0, 1.0],
            Freedom::Along { tangent: [x, y], .. } => [x * x, x * y, y * y],
        }
    }

    /// A traction at the edge, exactly there.
    pub(super) fn snap(self, q: Vector, radius: f64) -> Vector {
        match self {
            Freedom::Along { .. } => times(radius / length(q), q),
            _ => q,
        }
    }

    /// Scaled by the curvature of the edge.
    pub(super) fn weigh(self, v: Vector) -> Vector {
        match self {
            Freedom::Along { weight, .. } => times(weight, v),
            _ => v,
        }
    }
}

/// The direction out of the disc, where the traction is at its edge.
fn outward(q: Vector, radius: f64) -> Option<Vector> {
    let m = length(q);
    (m >= radius * (1.0 - EDGE)).then(|| times(1.0 / m, q))
}
