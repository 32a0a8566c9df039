//! The tractions that friction allows, |q| <= R = μ p in each cell, and the projection onto them that keeps the force.

use asperity_sweep::sums;

use super::vector::{Vector, inner, length, plus, solve, times};

/// A sum of tractions is met to this share of that of all radii.
const SUM_TOLERANCE: f64 = 1e-13;
/// A shift that misses the sum by more than this share is none.
const LARGEST_MISS: f64 = 1e-9;
/// Steps of Newton's method, and halvings of one, at most; a handful are usual.
const MOST_STEPS: usize = 60;
const MOST_HALVINGS: usize = 40;

/// The point of the disc of this radius that is nearest to y.
pub(super) fn clip(y: Vector, radius: f64) -> Vector {
    let m = length(y);
    if m <= radius { y } else { times(radius / m, y) }
}

/// λ for which the tractions clip(y + λ) have the given sum; `None` where no λ is found.
///
/// Σ clip(y + λ) is the gradient of a convex function of λ, whose minimum Newton's method finds, damped.
pub(super) fn shift_to_sum(y: &[Vector], radius: &[f64], sum: Vector) -> Option<Vector> {
    let [most] = sums(radius, |radius| [radius]);
    let (mut lambda, mut now) = ([0.0; 2], Clipped::of(y, radius, [0.0; 2], sum));
    for _ in 0..MOST_STEPS {
        let miss = length(now.miss);
        if miss <= SUM_TOLERANCE * most {
            break;
        }
        // Where all cells are clipped the tensor is singular along their mean direction.
        let [xx, xy, yy] = now.tensor;
        let ridge = (0.1 * miss / most + 1e-14) * (xx + yy) + 1e-14 * radius.len() as f64;
        let step = times(-1.0, solve([xx + ridge, xy, yy + ridge], now.miss));
        let slope = inner(now.miss, step);
        let shortened = (0..MOST_HALVINGS).find_map(|n| {
            let t = 0.5f64.powi(n as i32);
            let trial = plus(lambda, times(t, step));
            let next = Clipped::of(y, radius, trial, sum);
            let falls = next.potential <= now.potential + 1e-4 * t * slope || length(next.miss) <= 0.5 * miss;
            falls.then_some((trial, next))
        });
        match shortened {
            Some(next) => (lambda, now) = next,
            None => break,
        }
    }
    (length(now.miss) <= LARGEST_MISS * most).then_some(lambda)
}

/// Of Σ clip(y + λ): what it has beyond the sum wanted, its derivative, and the function whose gradient it is.
struct Clipped {
    miss: Vector,
    tensor: [f64; 3],
    potential: f64,
}

impl Clipped {
    fn of(y: &[Vector], radius: &[f64], lambda: Vector, sum: Vector) -> Self {
        let [x, y, xx, xy, yy, potential] = sums((y, radius), |(y, radius)| {
            let moved = plus(y, lambda);
            let m = length(moved);
            if radius == 0.0 {
                [0.0; 6]
            } else if m <= radius {
                [moved[0], moved[1], 1.0, 0.0, 1.0, 0.5 * m * m]
            } else {
                let ([nx, ny], share) = (times(1.0 / m, moved), radius / m);
                let q = times(share, moved);
                let [xx, xy, yy] = [share * ny * ny, -share * nx * ny, share * nx * nx];
                [q[0], q[1], xx, xy, yy, radius * (m - 0.5 * radius)]
            }
        });
        Clipped {
            miss: [x - sum[0], y - sum[1]],
            tensor: [xx, xy, yy],
            potential: potential - inner(lambda, sum),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_sum_that_the_discs_hold_is_met() {
        let y: Vec<Vector> = (0..200).map(|n| [(n as f64).sin() * 3.0, (1.7 * n as f64).cos()]).collect();
        let radius: Vec<f64> = (0..200).map(|n| f64::from(n % 5)).collect();
        let most: f64 = radius.iter().sum();
        for scale in [1e-3, 1.0, 1e4] {
            let y: Vec<Vector> = y.iter().map(|y| times(scale, *y)).collect();
            for (share, angle) in [(0.0, 0.0), (0.5, 1.0), (0.99, 2.0), (0.999_999, 4.0)] {
                let sum = times(share * most, [f64::cos(angle), f64::sin(angle)]);
                let lambda = shift_to_sum(&y, &radius, sum).unwrap();
                let found =
                    y.iter().zip(&radius).fold([0.0; 2], |sum, (y, r)| plus(sum, clip(plus(*y, lambda), *r)));
                let miss = length([found[0] - sum[0], found[1] - sum[1]]);
                assert!(miss <= LARGEST_MISS * most, "{scale} {share}: {miss:e}");
            }
            // More than the discs hold.
            assert!(shift_to_sum(&y, &radius, [1.001 * most, 0.0]).is_none());
        }
    }
}
