//! Unreliable stress below the surface: a grid too coarse for the maximum, depths that end above it, and a body that yields.

use super::words::{digits, si};
use super::{Finding, STRESS_AT_DEEPEST, STRESS_TIMES_MISS_PEAK, STRESS_UNRESOLVED, YIELD_EXCEEDED};

/// Smallest depth in cells of a maximum that the grid resolves.
const CELLS: f64 = 2.0;

/// The largest von Mises stress lies `depth` below the surface, less than two cells of side `cell` \[m\].
pub fn stress_unresolved(depth: f64, cell: f64) -> Finding {
    let text = format!(
        "The largest von Mises stress lies {} below the surface, which is {} cells: the grid is too coarse for it, and the true \
         stress may be higher. Refine the grid.",
        si(depth, "m"),
        digits(depth / cell)
    );
    Finding::warning(STRESS_UNRESOLVED, depth / cell, CELLS, text)
}

/// The largest pressure of the run, at `time` \[s\] under `load` (in `unit`, "N" or "N/m"), is not among the times of the stress.
pub fn stress_times_miss_peak(time: f64, load: f64, unit: &str) -> Finding {
    let text = format!(
        "The largest pressure of the run, at t = {} under {}, is not among the times at which the stress below the surface is \
         computed: it was larger then. Store the fields at that time too (output.every or output.times).",
        si(time, "s"),
        si(load, unit)
    );
    Finding::warning(STRESS_TIMES_MISS_PEAK, time, time, text)
}

/// The largest von Mises stress lies at the deepest of several depths \[m\].
pub fn stress_at_deepest(deepest: f64) -> Finding {
    let text = format!(
        "The largest von Mises stress lies at the deepest depth, {}: it may be larger below. Give deeper depths, or depths = \
         \"auto\".",
        si(deepest, "m")
    );
    Finding::warning(STRESS_AT_DEEPEST, deepest, deepest, text)
}

/// The largest von Mises stress exceeds the yield stress of the body \[Pa\].
pub fn yield_exceeded(mises: f64, yield_stress: f64) -> Finding {
    let text = format!(
        "The largest von Mises stress, {}, exceeds the yield stress, {}: the body yields below the surface, and the stress \
         there is an estimate only. (The hardness, which limits the pressure, is another number: about 2.8 times the yield \
         stress of a metal.)",
        si(mises, "Pa"),
        si(yield_stress, "Pa")
    );
    Finding::warning(YIELD_EXCEEDED, mises, yield_stress, text)
}
