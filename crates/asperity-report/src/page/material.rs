//! Curves of the pair's material, from the creep function that the result holds.

use std::f64::consts::TAU;

use asperity_io::store::Reader;
use serde_json::{Value, json};

use crate::figure::extent;
use crate::result::{creep, creep_over_reduced_time};

/// Points to a decade of time.
const FINE: i32 = 12;

/// C(t), E*(t), E', E'' and tan delta, from a decade below the shortest time to a decade above the longest; for bodies whose
/// temperature changes at the reference temperature of their shift. `Null` for an elastic pair or where the result does not say.
pub(super) fn curves(reader: &Reader) -> Value {
    let reduced = creep_over_reduced_time(reader);
    let parts = creep(reader).into_iter().chain(reduced.iter().cloned());
    let Some(creep) = parts.reduce(|sum, part| sum.sum(&part)) else { return Value::Null };
    let mut times: Vec<f64> = creep.terms.iter().map(|term| term.retardation_time).collect();
    if creep.fluidity > 0.0 && creep.instantaneous > 0.0 {
        times.push(creep.instantaneous / creep.fluidity);
    }
    let ends = extent(times.iter().copied());
    if times.is_empty() || ends[0] <= 0.0 {
        return Value::Null;
    }
    let [first, last] = [(ends[0].log10() - 1.5).floor() as i32, (ends[1].log10() + 1.5).ceil() as i32];
    let time: Vec<f64> =
        (first * FINE..=last * FINE).map(|n| 10f64.powf(f64::from(n) / f64::from(FINE))).collect();
    let omega: Vec<f64> = time.iter().rev().map(|t| TAU / t).collect();
    let complex: Vec<(f64, f64)> = omega.iter().map(|w| creep.modulus(*w)).collect();
    let column = |of: fn(&(f64, f64)) -> f64| complex.iter().map(of).collect::<Vec<f64>>();
    let relaxation = creep.to_relaxation().ok();
    let modulus = relaxation.map(|e| time.iter().map(|t| e.value(*t)).collect::<Vec<f64>>());
    let decades = modulus.as_ref().map(|e| match (e.first(), e.last()) {
        (Some(first), Some(last)) if *last > 0.0 => (first / last).log10(),
        _ => 0.0,
    });
    json!({
        "reduced": !reduced.is_empty(),
        "time": time,
        "creep": time.iter().map(|t| creep.value(*t)).collect::<Vec<f64>>(),
        "relaxation": modulus,
        "decades": decades,
        "frequency": omega.iter().map(|w| w / TAU).collect::<Vec<f64>>(),
        "storage": column(|(stored, _)| *stored),
        "loss": column(|(_, lost)| *lost),
        "tangent": column(|(stored, lost)| lost / stored),
    })
}
