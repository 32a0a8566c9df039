//! Vectors in the plane of the surface, and symmetric tensors of them.

/// x and y.
pub(crate) type Vector = [f64; 2];

pub(crate) fn plus([ax, ay]: Vector, [bx, by]: Vector) -> Vector {
    [ax + bx, ay + by]
}

pub(crate) fn minus([ax, ay]: Vector, [bx, by]: Vector) -> Vector {
    [ax - bx, ay - by]
}

pub(crate) fn times(t: f64, [x, y]: Vector) -> Vector {
    [t * x, t * y]
}

pub(crate) fn inner([ax, ay]: Vector, [bx, by]: Vector) -> f64 {
    ax * bx + ay * by
}

pub(crate) fn length(a: Vector) -> f64 {
    inner(a, a).sqrt()
}

/// The solution of T x = b for the symmetric, positive definite T = \[xx, xy, yy\].
pub(crate) fn solve([xx, xy, yy]: [f64; 3], [bx, by]: Vector) -> Vector {
    let determinant = xx * yy - xy * xy;
    [(yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant]
}
