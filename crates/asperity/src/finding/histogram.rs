//! Histograms whose bins end below the largest value: what lies above counts in no bin.

use super::words::{digits, rows, si};
use super::worst::Worst;
use super::{BEYOND_HISTOGRAM, Finding};
use crate::quantities::Quantity;
use crate::step::Step;

/// The histograms with an upper end: what they count, its unit, and the key of the end.
const HISTOGRAMS: [(Quantity, &str, &str, &str); 2] = [
    (Quantity::PressureHistogram, "cells in contact", "Pa", "output.histogram.pressure"),
    (Quantity::GapHistogram, "open cells", "m", "output.histogram.gap"),
];
/// Rounding of the sum over at most 10 000 bins.
const ROUNDING: f64 = 1e-9;

/// The largest share of each histogram that lies above its last bin.
#[derive(Clone, Debug, Default)]
pub(super) struct Beyond {
    worst: [Worst; 2],
    /// Upper ends \[Pa\], \[m\].
    ends: [f64; 2],
    /// Found in an earlier session of the run.
    earlier: Vec<Finding>,
}

impl Beyond {
    /// Adds a row: the share above is 1 less the integral of the density, where any cell counts.
    pub(super) fn see(&mut self, index: usize, step: &Step<'_>) {
        for (n, (quantity, ..)) in HISTOGRAMS.iter().enumerate() {
            let column = step.columns().iter().find(|column| column.quantity == *quantity);
            let (Some(column), Some(density)) = (column, step.quantity(*quantity)) else { continue };
            let (Some(end), bins) = (column.edges.last(), density.len() as f64) else { continue };
            let above = 1.0 - density.iter().sum::<f64>() * end / bins;
            if above > ROUNDING && counts(*quantity, step) {
                self.worst[n].above(index, above, ROUNDING);
                self.ends[n] = *end;
            }
        }
    }

    /// Takes over what an earlier session found.
    pub(super) fn resume(&mut self, finding: &Finding) {
        self.earlier.push(finding.clone());
    }

    /// A finding for each histogram that leaves values out.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let found = HISTOGRAMS.iter().zip(&self.worst).zip(self.ends).map(|(((quantity, what, unit, key), worst), end)| {
            let is_same = |finding: &&Finding| finding.text.starts_with(quantity.name());
            let earlier = self.earlier.iter().find(is_same);
            let now = worst.warning(BEYOND_HISTOGRAM, |_| String::new());
            let value = earlier.iter().copied().chain(&now).filter_map(|one| one.value).fold(0.0, f64::max);
            let ranges: Vec<[usize; 2]> = earlier.iter().copied().chain(&now).filter_map(|one| one.rows).collect();
            let at = [ranges.first()?[0], ranges.last()?[1]];
            let end = earlier.and_then(|one| one.limit).unwrap_or(end);
            let text = format!(
                "{} ends at {}, but up to {} % of the {what} lie above it ({}): they count in no bin, so that the density integrates to \
                 less than 1. Raise the end ({key}).",
                quantity.name(),
                si(end, unit),
                digits(100.0 * value),
                rows(at)
            );
            Some(Finding::warning(BEYOND_HISTOGRAM, value, end, text).at(at))
        });
        found.flatten().collect()
    }
}

/// Whether every cell that the density is normalised by has a finite value, and there are such cells: a cell that can never touch has an
/// infinite gap.
fn counts(quantity: Quantity, step: &Step<'_>) -> bool {
    match quantity {
        Quantity::GapHistogram => {
            let open = step.contact_pressure().iter().any(|pressure| *pressure <= 0.0);
            open && step.simulation().gap.iter().all(|gap| gap.is_finite())
        }
        _ => step.contact_pressure().iter().any(|pressure| *pressure > 0.0),
    }
}
