//! Linear systems by Gaussian elimination with partial pivoting.

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
