//! Probability densities of values, for bars.

use std::ops::RangeInclusive;

use crate::figure::{Curves, Series, Style};

/// Values of bins and the share of all values per unit in each, over a range; values beyond it count for the share and have
/// no bin. Nothing where the range has no width.
pub(crate) fn density(values: &[f64], range: RangeInclusive<f64>, bins: usize) -> (Vec<f64>, Vec<f64>) {
    let (low, high) = range.into_inner();
    let width = (high - low) / bins as f64;
    if width <= 0.0 || !width.is_finite() {
        return (vec![], vec![]);
    }
    let mut counts = vec![0usize; bins];
    for value in values.iter().filter(|value| (low..=high).contains(value)) {
        counts[(((value - low) / width) as usize).min(bins - 1)] += 1;
    }
    let middle = (0..bins).map(|k| low + (k as f64 + 0.5) * width).collect();
    let share = counts.iter().map(|count| *count as f64 / (values.len() as f64 * width)).collect();
    (middle, share)
}

/// A panel with these bars; an empty bin has none.
pub(crate) fn bars(panel: Curves, (middle, share): (Vec<f64>, Vec<f64>)) -> Curves {
    let share: Vec<f64> = share.into_iter().map(|d| if d > 0.0 { d } else { f64::NAN }).collect();
    if middle.is_empty() { panel } else { panel.with(Series::new("", Style::Bars, middle, share)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_add_up_to_the_share_of_values_in_the_range() {
        let values: Vec<f64> = (0..1000).map(|n| f64::from(n) * 1e-3).collect();
        let (middle, share) = density(&values, 0.0..=0.5, 10);
        assert!((middle[0] - 0.025).abs() < 1e-12);
        let sum: f64 = share.iter().map(|density| density * 0.05).sum();
        assert!((sum - 0.501).abs() < 1e-12, "{sum}"); // 0 to 0.5 both among them
        assert!(density(&values, 1.0..=1.0, 10).0.is_empty());
    }
}
