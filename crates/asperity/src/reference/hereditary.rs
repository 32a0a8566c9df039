//! The hereditary integral of a history: L(t) = int_(0-)^(t+) C(t - s) dW(s), the load history convolved with the creep function.
//! There is a closed form for every [`History`].
//!
//! A linear piece of slope k over \[t0, t1\] gives k (I(t - t0) - I(t - t1)) with I(t) = int_0^t C, a jump
//! by dW at t0 gives dW C(t - t0), and the sine (A sin(w t) + mean) gives
//! C(t) mean + sum over the terms of A w int_0^t C_j(t - s) cos(w s) ds.

use std::f64::consts::TAU;

use crate::load::History;
use crate::material::Creep;

/// L(t-), without a jump of the history at t.
pub(super) fn hereditary_before(creep: &Creep, history: &History, t: f64) -> f64 {
    let jump = if t < 0.0 { 0.0 } else { history.after(t) - history.before(t) };
    hereditary(creep, history, t) - creep.instantaneous * jump
}

/// L(t+) for a valid history and creep function; 0 before t = 0.
pub(super) fn hereditary(creep: &Creep, history: &History, t: f64) -> f64 {
    if t < 0.0 {
        return 0.0;
    }
    if let History::Sine { mean, amplitude, frequency } = history {
        return mean * creep.value(t) + amplitude * through_sine(creep, TAU * frequency, t);
    }
    let mut sum = 0.0;
    let mut add_jump = |s: f64| {
        let jump = history.after(s) - history.before(s);
        if jump != 0.0 {
            sum += jump * creep.value(t - s);
        }
    };
    let breaks = history.breaks(t);
    add_jump(0.0);
    breaks.iter().for_each(|s| add_jump(*s));
    if t > 0.0 {
        add_jump(t);
    }
    let mut start = 0.0;
    for end in breaks.into_iter().chain([t]) {
        if end > start {
            let slope = (history.before(end) - history.after(start)) / (end - start);
            if slope != 0.0 {
                sum += slope * (creep.integral(t - start) - creep.integral(t - end));
            }
        }
        start = end;
    }
    sum
}

/// int_0^t C(t - s) w cos(w s) ds.
fn through_sine(creep: &Creep, w: f64, t: f64) -> f64 {
    let (sin, cos) = (w * t).sin_cos();
    let flow = if creep.fluidity > 0.0 { creep.fluidity * (1.0 - cos) / w } else { 0.0 };
    let retarded = |compliance: f64, time: f64| {
        // int_0^t exp(-(t-s)/time) w cos(w s) ds
        let fading = w * time * (cos - (-t / time).exp() + w * time * sin) / (1.0 + (w * time).powi(2));
        compliance * (sin - fading)
    };
    let terms = creep.terms.iter().map(|c| retarded(c.compliance, c.retardation_time));
    creep.instantaneous * sin + terms.sum::<f64>() + flow
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use crate::material::CreepTerm;

    #[test]
    fn it_is_the_integral_by_parts() {
        // L = C(0) W(t) + int_0^t C'(t - s) W(s) ds, by quadrature between the breaks.
        let creep = Creep {
            instantaneous: 0.5,
            terms: vec![
                CreepTerm { compliance: 0.2, retardation_time: 0.3 },
                CreepTerm { compliance: 1.5, retardation_time: 4.0 },
            ],
            fluidity: 0.1,
        };
        let jumps = vec![(0.0, 1.0), (0.5, 3.0), (0.5, 2.0), (1.25, 0.5), (2.0, 0.5), (2.0, 4.0)];
        for history in [
            History::Step { value: 2.0 },
            History::Ramp { value: 2.0, duration: 1.0 },
            History::Triangle { peak: 3.0, rise: 1.0, fall: 0.5 },
            History::Trapezoid { peak: 3.0, rise: 1.0, hold: 0.25, fall: 0.5 },
            History::Sine { mean: 2.0, amplitude: 1.0, frequency: 0.7 },
            History::Table { points: jumps },
        ] {
            for t in [0.0, 0.1, 0.5, 1.0, 1.3, 2.0, 5.0] {
                let mut sum = creep.instantaneous * history.after(t);
                let mut start = 0.0;
                for end in history.breaks(t).into_iter().chain([t]) {
                    sum += integrate(start, end, |s| creep.rate(t - s) * history.after(s));
                    start = end;
                }
                let got = hereditary(&creep, &history, t);
                assert!((got - sum).abs() < 1e-13 * (1.0 + sum.abs()), "{history:?} {t}: {got} {sum}");
            }
        }
    }
}
