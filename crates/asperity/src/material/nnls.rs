//! Least squares with non-negative unknowns: minimise |A x - b| over x >= 0.
//!
//! The active-set method of C. L. Lawson & R. J. Hanson, Solving Least Squares Problems (1974),
//! chapter 23, after one orthogonal reduction of A and b to a triangle (Householder), which keeps all
//! scalar products and makes the later small solves independent of the number of data.

/// The x >= 0 that minimises |sum_k x_k columns_k - b|. Columns that are zero or depend on others get 0.
pub(crate) fn solve(columns: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let norms: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    let scaled: Vec<Vec<f64>> = columns
        .iter()
        .zip(&norms)
        .map(|(c, n)| if *n > 0.0 { c.iter().map(|v| v / n).collect() } else { c.clone() })
        .collect();
    let (columns, b) = reduce(&scaled, b);
    let x = active_set(&columns, &b);
    x.iter().zip(&norms).map(|(x, n)| if *n > 0.0 { x / n } else { 0.0 }).collect()
}

/// The same problem in at most n + 1 rows: Householder reflections turn A into a triangle, and the part of b outside its range
/// into one number.
pub(super) fn reduce(columns: &[Vec<f64>], b: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let (n, rows) = (columns.len(), b.len());
    if rows <= n + 1 {
        return (columns.to_vec(), b.to_vec());
    }
    let (mut columns, mut b) = (columns.to_vec(), b.to_vec());
    for k in 0..n {
        let (before, after) = columns.split_at_mut(k + 1);
        let Some(reflector) = Reflector::new(&mut before[k], k) else { continue };
        for column in after {
            reflector.apply(column);
        }
        reflector.apply(&mut b);
    }
    let outside = dot(&b[n..], &b[n..]).sqrt();
    for column in &mut columns {
        column.truncate(n + 1);
        column[n] = 0.0;
    }
    b.truncate(n + 1);
    b[n] = outside;
    (columns, b)
}

/// Lawson & Hanson, algorithm NNLS (23.10); the columns have length 1 or 0.
fn active_set(columns: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let n = columns.len();
    let mut x = vec![0.0; n];
    let mut passive: Vec<usize> = vec![];
    let mut refused = vec![false; n];
    // A gradient below the rounding of the scalar products is zero.
    let tolerance = 1e-14 * dot(b, b).sqrt();
    // The method terminates; only rounding could make it cycle, and x is feasible at any time.
    for _ in 0..20 * n {
        let residual = residual(columns, b, &x);
        let steepest = (0..n)
            .filter(|j| !refused[*j] && !passive.contains(j))
            .map(|j| (j, dot(&columns[j], &residual)))
            .filter(|(_, gradient)| *gradient > tolerance)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((entering, _)) = steepest else { break };
        passive.push(entering);
        match least_squares(columns, &passive, b) {
            Some(z) if z[z.len() - 1] > 0.0 => move_towards(columns, b, &mut x, &mut passive, z),
            // Dependent on the others, or changed in the wrong direction by rounding.
            _ => {
                passive.pop();
                refused[entering] = true;
                continue;
            }
        }
        refused.fill(false);
    }
    x
}

/// Moves x to the unconstrained solution z of the passive set, and removes unknowns that reach zero.
fn move_towards(columns: &[Vec<f64>], b: &[f64], x: &mut [f64], passive: &mut Vec<usize>, mut z: Vec<f64>) {
    loop {
        let blocking = passive
            .iter()
            .zip(&z)
            .filter(|(_, z)| **z <= 0.0)
            .map(|(j, z)| (*j, x[*j] / (x[*j] - z)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let step = blocking.map_or(1.0, |(_, step)| step);
        for (j, z) in passive.iter().zip(&z) {
            x[*j] += step * (z - x[*j]);
        }
        let Some((blocked, _)) = blocking else { return };
        x[blocked] = 0.0;
        passive.retain(|j| x[*j] > 0.0);
        for (j, value) in x.iter_mut().enumerate() {
            if !passive.contains(&j) {
                *value = 0.0;
            }
        }
        match least_squares(columns, passive, b) {
            Some(next) => z = next,
            None => return,
        }
    }
}

/// Least squares over some of the columns by Householder QR; `None` if they are dependent.
fn least_squares(columns: &[Vec<f64>], chosen: &[usize], b: &[f64]) -> Option<Vec<f64>> {
    if chosen.len() > b.len() {
        return None;
    }
    let mut a: Vec<Vec<f64>> = chosen.iter().map(|j| columns[*j].clone()).collect();
    let mut b = b.to_vec();
    for k in 0..a.len() {
        let (before, after) = a.split_at_mut(k + 1);
        let reflector = Reflector::new(&mut before[k], k)?;
        if reflector.diagonal.abs() < 1e-11 {
            return None;
        }
        for column in after {
            reflector.apply(column);
        }
        reflector.apply(&mut b);
    }
    for k in (0..a.len()).rev() {
        b[k] /= a[k][k];
        let z = b[k];
        for (row, value) in b[..k].iter_mut().enumerate() {
            *value -= z * a[k][row];
        }
    }
    b.truncate(a.len());
    Some(b)
}

/// The reflection that maps a vector's entries from row `from` on to (diagonal, 0, 0, ...).
struct Reflector {
    from: usize,
    diagonal: f64,
    direction: Vec<f64>,
    scale: f64,
}

impl Reflector {
    /// Builds the reflection and applies it to `column` itself; `None` for a zero vector.
    fn new(column: &mut [f64], from: usize) -> Option<Self> {
        let norm = dot(&column[from..], &column[from..]).sqrt();
        if norm == 0.0 {
            return None;
        }
        let diagonal = -norm.copysign(column[from]);
        let mut direction = column[from..].to_vec();
        direction[0] -= diagonal;
        let scale = 2.0 / dot(&direction, &direction);
        column[from..].fill(0.0);
        column[from] = diagonal;
        Some(Reflector { from, diagonal, direction, scale })
    }

    fn apply(&self, column: &mut [f64]) {
        let tail = &mut column[self.from..];
        let along = self.scale * dot(&self.direction, tail);
        for (value, direction) in tail.iter_mut().zip(&self.direction) {
            *value -= along * direction;
        }
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn residual(columns: &[Vec<f64>], b: &[f64], x: &[f64]) -> Vec<f64> {
    let mut residual = b.to_vec();
    for (column, x) in columns.iter().zip(x).filter(|(_, x)| **x != 0.0) {
        for (r, value) in residual.iter_mut().zip(column) {
            *r -= x * value;
        }
    }
    residual
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::series::tests::random;

    #[test]
    fn an_unconstrained_optimum_inside_the_orthant_is_found() {
        // The line of regression through (0, 1), (1, 1), (2, 2) is 5/6 + x/2.
        let columns = [vec![1.0; 3], vec![0.0, 1.0, 2.0]];
        let x = solve(&columns, &[1.0, 1.0, 2.0]);
        assert!((x[0] - 5.0 / 6.0).abs() < 1e-14 && (x[1] - 0.5).abs() < 1e-14, "{x:?}");
    }

    #[test]
    fn the_optimality_conditions_hold_on_random_problems() {
        let mut random = random(3);
        for trial in 0..200 {
            let (rows, n) = (1 + trial % 40, 1 + (7 * trial) % 25);
            let mut vector = |len: usize| (0..len).map(|_| random() - 0.3).collect::<Vec<f64>>();
            let columns: Vec<_> = (0..n).map(|_| vector(rows)).collect();
            let b = vector(rows);
            let x = solve(&columns, &b);
            let r = residual(&columns, &b, &x);
            for (x, column) in x.iter().zip(&columns) {
                let gradient = dot(column, &r);
                // Karush-Kuhn-Tucker to rounding: entries are of order 1, conditions up to 1e3.
                assert!(*x >= 0.0 && gradient < 1e-11 && (*x == 0.0 || gradient > -1e-11), "{trial}");
            }
        }
    }

    #[test]
    fn equal_and_zero_columns_do_no_harm() {
        let columns = [vec![0.0; 4], vec![1.0; 4], vec![1.0; 4], vec![2.0; 4]];
        let x = solve(&columns, &[3.0; 4]);
        let sum = x[1] + x[2] + 2.0 * x[3];
        assert!(x[0] == 0.0 && (sum - 3.0).abs() < 1e-14, "{x:?}");
    }
}
