//! Linear systems: small ones by Gaussian elimination with partial pivoting, operators by right-preconditioned GMRES
//! (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856).

use asperity_sweep::{add, dot, sweep};

use crate::error::Result;

/// The solutions for `K` right-hand sides, with which each row ends.
pub(crate) fn solve<const K: usize>(mut rows: Vec<Vec<f64>>) -> [Vec<f64>; K] {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs())).unwrap_or(k);
        rows.swap(k, pivot);
        let (done, rest) = rows.split_at_mut(k + 1);
        for row in rest {
            let factor = row[k] / done[k][k];
            row[k..].iter_mut().zip(&done[k][k..]).for_each(|(a, b)| *a -= factor * b);
        }
    }
    std::array::from_fn(|side| {
        let mut x = vec![0.0; n];
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|c| rows[k][c] * x[c]).sum();
            x[k] = (rows[k][n + side] - known) / rows[k][k];
        }
        x
    })
}

/// When GMRES stops: the residual over that of 0, and a number of vectors.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) reduction: f64,
    pub(crate) vectors: usize,
}

/// x with A x = `right`, roughly, and the residual that is left over that of 0. `apply` gives z = P v and A z, with P an approximate inverse.
///
/// # Errors
/// Those of `apply`.
pub(crate) fn gmres(
    right: &[f64],
    limits: Limits,
    mut apply: impl FnMut(&[f64]) -> Result<[Vec<f64>; 2]>,
) -> Result<(Vec<f64>, f64)> {
    let mut v = right.to_vec();
    let size = norm(&v);
    if size == 0.0 {
        return Ok((v, 0.0));
    }
    scale(&mut v, 1.0 / size);
    let mut basis = vec![v];
    let mut preconditioned: Vec<Vec<f64>> = vec![];
    // Columns of the triangular factor, rotations, and the rotated right-hand side.
    let (mut triangle, mut rotations): (Vec<Vec<f64>>, Vec<[f64; 2]>) = (vec![], vec![]);
    let mut rotated = vec![size];
    for k in 0..limits.vectors.min(right.len()) {
        let [z, mut y] = apply(&basis[k])?;
        preconditioned.push(z);
        let mut column = Vec::with_capacity(k + 2);
        for v in &basis {
            let product = dot(v, &y);
            add(&mut y, -product, v);
            column.push(product);
        }
        let length = norm(&y);
        column.push(length);
        for (i, [c, s]) in rotations.iter().enumerate() {
            let [a, b] = [column[i], column[i + 1]];
            (column[i], column[i + 1]) = (c * a + s * b, c * b - s * a);
        }
        let radius = libm::hypot(column[k], length);
        if !(radius > 0.0 && radius.is_finite()) {
            preconditioned.pop();
            break;
        }
        let [c, s] = [column[k] / radius, length / radius];
        column[k] = radius;
        column.truncate(k + 1);
        rotations.push([c, s]);
        triangle.push(column);
        let last = rotated[k];
        rotated[k] = c * last;
        rotated.push(-s * last);
        if rotated[k + 1].abs() <= limits.reduction * size || length <= f64::EPSILON * radius {
            break;
        }
        scale(&mut y, 1.0 / length);
        basis.push(y);
    }
    let mut weights = vec![0.0; triangle.len()];
    for i in (0..triangle.len()).rev() {
        let known: f64 = (i + 1..triangle.len()).map(|j| triangle[j][i] * weights[j]).sum();
        weights[i] = (rotated[i] - known) / triangle[i][i];
    }
    let mut x = vec![0.0; right.len()];
    for (z, weight) in preconditioned.iter().zip(&weights) {
        add(&mut x, *weight, z);
    }
    Ok((x, rotated[triangle.len()].abs() / size))
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn scale(a: &mut [f64], factor: f64) {
    sweep(a, &|a: &mut [f64]| a.iter_mut().for_each(|a| *a *= factor));
}
