//! The contact conditions of a solution, checked with U = K p by the full matrix, and the distance of two pressures.

use asperity::operator::Operator;
use asperity::reference::Dense;
use asperity::{ContactState, Outcome, Prescribed, Problem};

/// What a state violates, as text: bounds, load, displacement, gap, and whether the residual reported is the true one.
///
/// With g = c U + h - w: g >= 0 where p = 0, g = 0 where 0 < p < H, g <= 0 where p = H, each to `tolerance` of the
/// pressure-weighted mean displacement and some roundings of w and of the largest displacement.
pub fn violation(
    operator: &mut Dense,
    problem: &Problem,
    tolerance: f64,
    state: &ContactState,
    outcome: &Outcome,
) -> Result<(), String> {
    let p = &state.pressure;
    let sum: f64 = p.iter().sum();
    for (n, p) in p.iter().enumerate() {
        let most = if problem.gap[n].is_finite() { problem.hardness.at(n) } else { 0.0 };
        if !(0.0..=most).contains(p) {
            return Err(format!("pressure {p} of cell {n} is not between 0 and {most}"));
        }
    }
    match problem.prescribed {
        Prescribed::Load(load) => {
            let carried = sum * operator.grid().cell_area();
            // The sum of some hundred pressures, each rounded.
            if (carried / load - 1.0).abs() > 1e-12 {
                return Err(format!("the load is {carried}, not {load}"));
            }
        }
        Prescribed::Approach(w) if state.approach != w => {
            return Err(format!("the approach is {}, not {w}", state.approach));
        }
        Prescribed::Approach(_) => {}
    }

    let mut u = vec![0.0; p.len()];
    operator.apply_into(p, &mut u);
    let largest = u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let off = u.iter().zip(&state.unit_displacement).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let peak = p.iter().copied().fold(0.0, f64::max);
    let [lx, ly] = operator.grid().size();
    let extent = peak * lx.max(ly);
    // The solvers promise a hundredth of the tolerance; two sums of some hundred terms differ by 1e-14 of the largest U, or
    // of what the terms are where these cancel (an even pressure on a periodic domain).
    if off > (0.01 * tolerance).max(1e-13) * largest + 16.0 * f64::EPSILON * extent {
        return Err(format!("U is off by {off:e} of {largest:e}"));
    }

    let c = problem.compliance;
    let mean = if sum > 0.0 { c * p.iter().zip(&u).map(|(p, u)| p * u).sum::<f64>() / sum } else { 0.0 };
    let rounding = 16.0 * f64::EPSILON * (state.approach.abs() + c * extent) + c * off;
    let mut worst = 0.0_f64;
    for n in (0..p.len()).filter(|n| problem.gap[*n].is_finite()) {
        let g = c * u[n] + problem.gap[n] - state.approach;
        worst = worst.max(if p[n] == 0.0 {
            -g
        } else if p[n] == problem.hardness.at(n) {
            g
        } else {
            g.abs()
        });
    }
    if worst > tolerance * mean.max(0.0) + rounding {
        return Err(format!("a gap is off by {worst:e}: more than {tolerance:e} of {mean:e}"));
    }
    // The mean displacement of the two U differs by `off` at most.
    if mean > 0.0 && outcome.residual * (mean + c * off + rounding / tolerance) < 0.99 * worst - rounding {
        return Err(format!(
            "residual {:e} reported, but a gap is off by {worst:e} of {mean:e}",
            outcome.residual
        ));
    }
    Ok(())
}

/// |p - q|_K / |p|_K.
pub fn apart(operator: &mut dyn Operator, p: &[f64], q: &[f64]) -> f64 {
    let mut norm = |p: &[f64]| {
        let mut u = vec![0.0; p.len()];
        operator.apply_into(p, &mut u);
        p.iter().zip(&u).map(|(p, u)| p * u).sum::<f64>().max(0.0).sqrt()
    };
    let difference: Vec<f64> = p.iter().zip(q).map(|(p, q)| p - q).collect();
    norm(&difference) / norm(p)
}
