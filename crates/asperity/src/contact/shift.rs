//! The projection that keeps the load: clip(y + lambda, 0, H) with the sum given.
//!
//! The sum is a piecewise linear, non-decreasing function of lambda; Newton's method with a bracket
//! finds its root in a few sweeps.

use crate::field::{Max, Min, larger, smaller, strands, sweep};

/// Cells that take part in a projection; the others keep their pressure.
pub(super) const FREE: u8 = 1;

/// y clipped to \[0, H\].
#[inline(always)]
pub(super) fn clip(y: f64, hardness: f64) -> f64 {
    let y = if y > 0.0 { y } else { 0.0 };
    if y < hardness { y } else { hardness }
}

/// Moves y by a common shift so that sum over the free cells of clip(y, 0, H) = `target`; `None` where no
/// shift has it. The caller clips.
pub(super) fn shift_to_sum(y: &mut [f64], free: &[u8], hardness: f64, target: f64) -> Option<()> {
    let (lambda, excess, inside) = shift(y, free, hardness, target)?;
    // A shift that cancels most of y leaves the rounding of y in the sum: the cells inside take it back.
    let rest = if inside > 0.0 { excess / inside } else { 0.0 };
    sweep((y, free), &|(y, free): (&mut [f64], &[u8])| {
        for (y, free) in y.iter_mut().zip(free) {
            let moved = clip(*y + lambda, hardness);
            let corrected =
                if moved > 0.0 && moved < hardness { clip(moved - rest, hardness) } else { moved };
            *y = if *free == FREE { corrected } else { *y };
        }
    });
    Some(())
}

/// lambda with sum over the free cells of clip(y + lambda, 0, H) = `target`, by how much it misses, and
/// the number of cells inside the bounds.
fn shift(y: &[f64], free: &[u8], hardness: f64, target: f64) -> Option<(f64, f64, f64)> {
    if target <= 0.0 {
        return None;
    }
    let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
    let mut best = (0.0, f64::INFINITY, 0.0);
    let mut lambda = 0.0;
    for _ in 0..200 {
        let [sum, slope] = clipped_sum(y, free, hardness, lambda);
        let excess = sum - target;
        if excess.abs() < f64::abs(best.1) {
            best = (lambda, excess, slope);
        }
        if excess.abs() <= 2e-15 * target {
            break;
        }
        bracket[usize::from(excess > 0.0)] = lambda;
        let newton = lambda - excess / slope;
        let next = if slope > 0.0 && newton > bracket[0] && newton < bracket[1] {
            newton
        } else if bracket[0].is_finite() && bracket[1].is_finite() {
            0.5 * (bracket[0] + bracket[1])
        } else if slope > 0.0 {
            break; // Newton's step moves by less than rounding
        } else {
            // A flat piece: go to where the nearest cell starts to move.
            nearest_bend(y, free, hardness, lambda, excess < 0.0)?
        };
        if next == lambda {
            break;
        }
        lambda = next;
    }
    Some(best)
}

fn clipped_sum(y: &[f64], free: &[u8], hardness: f64, lambda: f64) -> [f64; 2] {
    sweep((y, free), &|(y, free): (&[f64], &[u8])| {
        let n = y.len();
        let free = &free[..n];
        strands(n, |i| {
            let moved = y[i] + lambda;
            let inside = free[i] == FREE && moved > 0.0 && moved < hardness;
            [if free[i] == FREE { clip(moved, hardness) } else { 0.0 }, f64::from(u8::from(inside))]
        })
    })
}

/// A shift beyond the nearest bend of the sum above (or below) `lambda`, where some cell moves.
fn nearest_bend(y: &[f64], free: &[u8], hardness: f64, lambda: f64, above: bool) -> Option<f64> {
    let (up, down) = sweep((y, free), &|(y, free): (&[f64], &[u8])| {
        let mut up = f64::INFINITY;
        let mut down = f64::NEG_INFINITY;
        for (y, free) in y.iter().zip(free) {
            if *free == FREE && y.is_finite() {
                if y + lambda <= 0.0 {
                    up = smaller(-y, up);
                } else if y + lambda >= hardness {
                    down = larger(hardness - y, down);
                }
            }
        }
        (Min(up), Max(down))
    });
    let bend = if above { up.0 } else { down.0 };
    // Past the bend by a little of the shift or of the pressure there, so that the slope is not zero.
    let past = 1e-3 * bend.abs().max(f64::MIN_POSITIVE);
    bend.is_finite().then_some(if above { bend + past } else { bend - past })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(y: &[f64], free: &[u8], hardness: f64, target: f64) {
        let mut shifted = y.to_vec();
        shift_to_sum(&mut shifted, free, hardness, target).unwrap();
        let sum: f64 =
            shifted.iter().zip(free).filter(|(_, f)| **f == FREE).map(|(y, _)| clip(*y, hardness)).sum();
        assert!((sum / target - 1.0).abs() < 1e-14, "{y:?} {target}: {sum}");
    }

    #[test]
    fn the_load_is_kept_whatever_is_clipped() {
        check(&[1.0, 2.0, -3.0, 0.5], &[1, 1, 1, 0], f64::INFINITY, 4.0);
        check(&[1.0, 2.0, -3.0, 0.5], &[1, 1, 1, 1], 1.5, 5.9);
        check(&[-5.0, -7.0], &[1, 1], f64::INFINITY, 1.0);
        check(&[9.0, 8.0, 7.0], &[1, 1, 1], 2.0, 1.0);
        check(&[1e-300, 1.0], &[1, 1], f64::INFINITY, 1e-9);
    }

    #[test]
    fn no_shift_carries_more_than_the_hardness() {
        assert_eq!(shift_to_sum(&mut [1.0, 1.0], &[1, 0], 1.0, 1.5), None);
        assert_eq!(shift_to_sum(&mut [1.0], &[0], 1.0, 0.5), None);
    }
}
