//! The temperature at which a material sees its own friction: a fixed point x = T(x).

use crate::error::{Error, Result};
use crate::numbers::bisect;

/// Rounds, at most: two to halve the distance between too cold and too warm. Smooth friction needs two to ten.
const ROUNDS: usize = 40;
/// Rises at which nothing holds the temperature any more \[K\].
const ENDLESS: f64 = 1e5;
/// What is left of a rise, or between the rises that are too cold and too warm, relative to it, or to a kelvin.
const TOLERANCE: f64 = 3e-3;

/// The rise x \[K\] with `rise_at(x)` = x at this velocity \[m/s\], from `start` on; `rise_at` has been called last with it.
///
/// Between rounds T(x) is taken as exponential, through the last two of them, and x kept between the largest that is too cold and the
/// least that is too warm: T(0) >= 0, so there is one. Where that does not halve their distance, their middle is next. T(x) jumps where a
/// cell leaves the contact, so it may cross x without being x.
///
/// # Errors
/// [`Error::Invalid`] where the rise is endless; those of `rise_at`.
pub(crate) fn settle(velocity: f64, start: f64, mut rise_at: impl FnMut(f64) -> Result<f64>) -> Result<f64> {
    let (mut x, mut before): (f64, Option<[f64; 2]>) = (start.max(0.0), None);
    let [mut cold, mut warm] = [0.0, f64::INFINITY];
    let (mut left, mut width) = (f64::INFINITY, f64::INFINITY);
    for round in 0..ROUNDS {
        let rise = rise_at(x)?;
        left = rise - x;
        tracing::debug!(round, x, left, "feedback");
        let is_met = left.abs() <= TOLERANCE * x.max(1.0);
        if left > 0.0 {
            cold = x
        } else {
            warm = x
        }
        if is_met || warm - cold <= TOLERANCE * x.max(1.0) {
            return Ok(x);
        }
        if x > ENDLESS {
            break;
        }
        let slope = before.map_or(0.0, |[other, its]| libm::log(rise / its) / (x - other));
        before = Some([x, rise]);
        let is_slow = warm - cold > 0.5 * width;
        width = warm - cold;
        x = match width.is_finite() && is_slow {
            true => 0.5 * (cold + warm),
            false => {
                let most = warm.min(2.0 * x.max(rise));
                bisect([cold, most], 60, |y| rise * libm::exp(slope * (y - x)) - y > 0.0)[1]
            }
        };
    }
    Err(Error::invalid(
        format!("flash temperature with its feedback at {velocity} m/s"),
        format!("{left:.2e} K from that of the material after {ROUNDS} rounds or more than {ENDLESS:e} K"),
        "one that the friction of the warmer material makes: it only gets warmer. Lower the load or the velocity, or take feedback = \"none\"",
    )
    .of("flash.feedback"))
}

/// Another rise than `x` at which the surfaces may be steady, as far as the heat tells: T in proportion to `heat`, which is 1 at x. The
/// largest of several.
pub(crate) fn another(x: f64, heat: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    // Rises over four decades to both sides of x, each ten per cent beyond the one before.
    const STEPS: i32 = 96;
    let at = |n: i32| x * libm::pow(1.1, f64::from(n));
    let is_warming = |n: i32| heat(at(n)).map(|heat| heat * x > at(n));
    // A steady state lies where less warming follows more; that of x itself is not one of these.
    let falls = |n: i32| is_warming(n) == Some(true) && is_warming(n + 1) == Some(false);
    (-STEPS..STEPS).rev().filter(|n| !(-2..=1).contains(n)).find(|n| x > 0.0 && falls(*n)).map(at)
}
