//! Unreliable stress below the surface: a grid too coarse for the maximum, depths that miss it, and a body that yields.

use super::words::{digits, si};
use super::{
    Finding, STRESS_AT_DEEPEST, STRESS_DEPTHS_COARSE, STRESS_TIMES_MISS_PEAK, STRESS_UNRESOLVED,
    YIELD_EXCEEDED,
};
use crate::drive::Coordinate;

/// The codes of findings about the stress: a new stress replaces them.
pub const OF_STRESS: [&str; 5] =
    [STRESS_UNRESOLVED, STRESS_AT_DEEPEST, STRESS_DEPTHS_COARSE, STRESS_TIMES_MISS_PEAK, YIELD_EXCEEDED];

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

/// The largest pressure of the run, in the row `at` under `load` (in `unit`, "N" or "N/m"), is not among the times of the stress.
pub fn stress_times_miss_peak(at: Coordinate, load: f64, unit: &str) -> Finding {
    let text = format!(
        "The largest pressure of the run, at {} = {} under {}, is not among the {} at which the stress below the surface is \
         computed: it was larger then. Store the fields of that row too (output.every or output.times).",
        at.axis().symbol(),
        si(at.value(), at.axis().unit()),
        si(load, unit),
        at.axis().plural()
    );
    Finding::warning(STRESS_TIMES_MISS_PEAK, at.value(), at.value(), text)
}

/// The largest von Mises stress, found at `depth` \[m\], may be larger between the `unseen` depths \[m\] of
/// [`unseen_depths`](crate::stress::unseen_depths).
pub fn stress_depths(depth: f64, unseen: [f64; 2]) -> Finding {
    let place = depths_between(unseen);
    if unseen[1].is_infinite() {
        let text = format!(
            "The largest von Mises stress lies at the deepest depth, {}: it may be larger {place}. Give deeper depths, or \
             depths = \"auto\".",
            si(depth, "m")
        );
        return Finding::warning(STRESS_AT_DEEPEST, depth, depth, text);
    }
    let text = format!(
        "The depths are far apart around the largest von Mises stress, which was found at {}: it may be larger {place}. \
         Give more depths there, or depths = \"auto\".",
        si(depth, "m")
    );
    Finding::warning(STRESS_DEPTHS_COARSE, unseen[1], unseen[0], text)
}

/// Two depths \[m\] in words: "below 20 µm", "between the surface and 20 µm".
pub fn depths_between([above, below]: [f64; 2]) -> String {
    match (above > 0.0, below.is_finite()) {
        (true, true) => format!("between {} and {}", si(above, "m"), si(below, "m")),
        (true, false) => format!("below {}", si(above, "m")),
        (false, true) => format!("between the surface and {}", si(below, "m")),
        (false, false) => "at other depths".to_owned(),
    }
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
