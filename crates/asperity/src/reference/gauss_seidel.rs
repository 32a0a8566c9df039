//! The slow reference: projected Gauss-Seidel on the influence matrix, for small grids.

use super::Dense;
use crate::contact::{ContactState, Prescribed, Problem};
use crate::operator::Operator;

/// Solves a contact cell by cell: p_i <- clip(p_i - r_i/(c K_ii), 0, H), repeated until no cell changes.
///
/// Under load control the approach is found by bisection around it. O(N^2) memory: grids of a few hundred cells. It shares
/// neither method nor influence coefficients with the solvers that it checks (Bortz; Vollebregt, Comput. Mech. 54, 2014,
/// gives the history).
pub fn gauss_seidel(operator: &mut Dense, problem: &Problem) -> ContactState {
    let n = operator.grid().len();
    let mut state = ContactState::new(n);
    match problem.prescribed {
        Prescribed::Approach(w) => relax(operator, problem, w, &mut state),
        Prescribed::Load(load) => {
            let target = load / operator.grid().cell_area();
            let mut low = problem.gap.iter().copied().fold(f64::INFINITY, f64::min);
            let mut high = if !operator.determines_mean() && problem.hardness.is_infinite() {
                // Beyond the mean gap a periodic pressure is unbounded.
                problem.gap.iter().sum::<f64>() / n as f64
            } else {
                carrying(operator, problem, target, low, &mut state)
            };
            while high - low > 4.0 * f64::EPSILON * high.abs() {
                let w = 0.5 * (low + high);
                if w <= low || w >= high {
                    break;
                }
                relax(operator, problem, w, &mut state);
                if state.pressure.iter().sum::<f64>() < target { low = w } else { high = w }
            }
        }
    }
    operator.apply_into(&state.pressure, &mut state.unit_displacement);
    state
}

/// An approach above `low` at which the bodies carry at least `target`.
fn carrying(operator: &Dense, problem: &Problem, target: f64, low: f64, state: &mut ContactState) -> f64 {
    let mut overlap = problem.compliance * target * operator.self_influence();
    loop {
        overlap *= 2.0;
        relax(operator, problem, low + overlap, state);
        if state.pressure.iter().sum::<f64>() >= target {
            return low + overlap;
        }
    }
}

fn relax(operator: &Dense, problem: &Problem, w: f64, state: &mut ContactState) {
    state.approach = w;
    let p = &mut state.pressure;
    for _ in 0..20_000 {
        let mut largest = 0.0f64;
        let mut change = 0.0f64;
        for i in 0..p.len() {
            if problem.gap[i] == f64::INFINITY {
                continue;
            }
            let row = operator.row(i);
            let u: f64 = row.iter().zip(p.iter()).map(|(k, p)| k * p).sum();
            let r = problem.compliance * u + problem.gap[i] - w;
            let new = (p[i] - r / (problem.compliance * row[i])).clamp(0.0, problem.hardness.at(i));
            change = change.max((new - p[i]).abs());
            largest = largest.max(new);
            p[i] = new;
        }
        if change <= 1e-14 * largest {
            break;
        }
    }
}
