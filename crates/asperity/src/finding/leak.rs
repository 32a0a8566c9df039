//! Unreliable leaks: gaps below the error of the solver, constrictions of a few cells, fluid pressures that would move the
//! bodies.

use super::words::{digits, si};
use super::worst::Worst;
use super::{
    CONSTRICTION_UNRESOLVED, FLUID_UNCOUPLED, Finding, GAPS_BELOW_ERROR, LEAK_BELOW_GAP_ERROR, WINDOW_IN_LEAK,
};

/// Smallest ratio of the critical gap to its error: the leak is proportional to the third power of the gap, so an error of 1/30
/// means 10 %.
const ABOVE_ERROR: f64 = 30.0;
/// Smallest number of cells across the critical constriction.
const ACROSS: f64 = 4.0;
/// Largest ratio of the drop of the fluid pressure to the mean pressure.
const PRESSURE_SHARE: f64 = 0.02;
/// Mean pressure over the pressure p1 in the conductance exp(-p/p1): 3 where a fifth of the area touches, 19 near sealing.
const STEEPNESS: [f64; 2] = [3.0, 19.0];

/// By how much a fluid that opens the contact leaks more, (e^x - 1)/x with x = drop/p1, of a drop over the mean pressure.
fn opened(share: f64) -> [f64; 2] {
    STEEPNESS.map(|steepness| (steepness * share).exp_m1() / (steepness * share))
}

/// The data for the check of a leak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeakState {
    /// Row that the gap belongs to; `None` for a gap of no run.
    pub row: Option<usize>,
    /// Gap at the critical constriction \[m\], and open cells across it if it is bounded; `None` if the seal is tight.
    pub constriction: Option<(f64, Option<usize>)>,
    /// Error of the gap due to the tolerance of the solver \[m\]: the tolerance times the mean displacement.
    pub gap_error: f64,
    /// Cells whose gap is not above its error, which count as closed.
    pub closed: usize,
    /// Drop of the fluid pressure \[Pa\], if the fluid is known.
    pub pressure_drop: Option<f64>,
    /// Load over the area of the domain \[Pa\]; 0 if it is not known, and then not checked.
    pub mean_pressure: f64,
}

/// The diagnostics of the leaks of one run.
#[derive(Clone, Debug, Default)]
pub struct LeakDiagnostics {
    below_error: Worst,
    closed: Worst,
    /// The error of the gap where cells are closed because of it [m].
    error: f64,
    narrow: Worst,
    pressure: Worst,
}

impl LeakDiagnostics {
    /// Checks a leak; true if there is no finding against it. A tight seal has no constriction to check.
    pub fn see(&mut self, state: &LeakState) -> bool {
        let mut unresolved = false;
        if self.closed.above(state.row, state.closed as f64, 0.5) {
            self.error = self.error.max(state.gap_error);
        }
        if let Some((gap, width)) = state.constriction {
            unresolved |= self.below_error.below(state.row, gap, ABOVE_ERROR * state.gap_error);
            unresolved |= width.is_some_and(|cells| self.narrow.below(state.row, cells as f64, ACROSS));
        }
        if let Some(drop) = state.pressure_drop.filter(|_| state.mean_pressure > 0.0) {
            unresolved |= self.pressure.above(state.row, drop, PRESSURE_SHARE * state.mean_pressure);
        }
        !unresolved
    }

    /// The findings.
    pub fn findings(&self) -> Vec<Finding> {
        let below = self.below_error.warning(LEAK_BELOW_GAP_ERROR, |worst| {
            format!(
                "The gap at the critical constriction is {}{}, less than 30 times the error of the gap, {}. The leak there is \
                 only an estimate of the order of magnitude. Lower solver.tolerance, which costs only iterations, and refine \
                 the grid.",
                si(worst.value, "m"),
                worst.place(),
                si(worst.limit / ABOVE_ERROR, "m")
            )
        });
        let closed = self.closed.warning(GAPS_BELOW_ERROR, |worst| {
            format!(
                "{} cells{} have gaps above 0 that are not above the error of the gap, {}: they count as closed. The error is the rounding of the \
                 largest gap, and without a contact also the deepest negative gap. Give the contact beside the gap, or a gap that is 0 where the surfaces touch.",
                digits(worst.value),
                worst.place(),
                si(self.error, "m")
            )
        });
        let narrow = self.narrow.warning(CONSTRICTION_UNRESOLVED, |worst| {
            format!(
                "The critical constriction is {} {} wide{}, less than {}, so the leak depends on the grid. Refine the grid \
                 (domain.cells), or leave out short waves.",
                digits(worst.value),
                if worst.value == 1.0 { "cell" } else { "cells" },
                worst.place(),
                worst.limit
            )
        });
        let pressure = self.pressure.warning(FLUID_UNCOUPLED, |worst| {
            let mean = worst.limit / PRESSURE_SHARE;
            let [low, high] = opened(worst.value / mean).map(digits);
            let then = if worst.value < mean {
                format!(
                    "the true leak is about {low} times as large far from sealing (a fifth of the area in contact), and {high} times close to it"
                )
            } else {
                "so large a drop may lift them off each other altogether".to_owned()
            };
            format!(
                "The fluid pressure drops by {}{}, more than 0.02 of the mean pressure, {}. It would push the bodies apart, which is not \
                 computed here: {then}. leakage.coupling = \"two-way\" and `asperity seal` compute it.",
                si(worst.value, "Pa"),
                worst.place(),
                si(mean, "Pa"),
            )
        });
        [below, closed.map(Finding::as_note), narrow, pressure].into_iter().flatten().collect()
    }
}

/// A leak through surfaces of these names, which were windowed.
pub fn window_in_leak(names: &[String]) -> Option<Finding> {
    let (which, it) = match names {
        [] => return None,
        [name] => (format!("The surface {name} is"), "it"),
        names => (format!("The surfaces {} are", names.join(" and ")), "them"),
    };
    let text = format!(
        "{which} windowed: the heights fall to zero towards the borders, and the flat border is a dam across the flow. The leak is too small, \
         and may be zero where the true surface leaks. Continue {it} by reflections (border = \"mirror\", step border=mirror) in place of \
         the window."
    );
    Some(Finding::warning(WINDOW_IN_LEAK, f64::NAN, f64::NAN, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaks_are_judged_by_gap_width_and_pressure() {
        let good = LeakState {
            row: Some(0),
            constriction: Some((31.0, Some(4))),
            gap_error: 1.0,
            closed: 0,
            pressure_drop: Some(1e5),
            mean_pressure: 1e7,
        };
        let mut diagnostics = LeakDiagnostics::default();
        assert!(diagnostics.see(&good));
        assert!(diagnostics.see(&LeakState { constriction: None, gap_error: 100.0, ..good }));
        assert!(diagnostics.see(&LeakState { constriction: Some((1e3, None)), pressure_drop: None, ..good }));
        assert!(diagnostics.findings().is_empty());
        assert!(!diagnostics.see(&LeakState { row: Some(2), constriction: Some((20.0, Some(9))), ..good }));
        assert!(!diagnostics.see(&LeakState { row: Some(3), constriction: Some((10.0, Some(3))), ..good }));
        assert!(!diagnostics.see(&LeakState { row: Some(4), constriction: Some((25.0, Some(9))), ..good }));
        assert!(!diagnostics.see(&LeakState { row: Some(5), pressure_drop: Some(2e6), ..good }));
        let found = diagnostics.findings();
        let numbers: Vec<_> = found.iter().map(|f| (f.code.as_ref(), f.value, f.limit, f.rows)).collect();
        assert_eq!(
            numbers,
            [
                (LEAK_BELOW_GAP_ERROR, Some(10.0), Some(30.0), Some([2, 4])),
                (CONSTRICTION_UNRESOLVED, Some(3.0), Some(4.0), Some([3, 3])),
                (FLUID_UNCOUPLED, Some(2e6), Some(2e5), Some([5, 5])),
            ]
        );
        // 0.2 of the mean pressure: (e^0.6 - 1)/0.6 = 1.370, (e^3.8 - 1)/3.8 = 11.50.
        assert!(
            found[2].text.contains("1.37 times") && found[2].text.contains("11.5 times"),
            "{}",
            found[2].text
        );
        assert!(found[0].text.contains("10 m") && found[0].text.contains("rows 2 to 4"), "{}", found[0].text);
    }
}
