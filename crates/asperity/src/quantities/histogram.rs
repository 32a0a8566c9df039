//! Histograms of a row: densities over bins of one width, and spots by powers of two of their cells.

use crate::spots::Spots;

/// Probability density of `values` over bins of one width from 0 to the last of `edges`; the last bin holds its upper
/// end too, and what is below 0 (a gap within the solver's tolerance) is in the first. Values beyond the last bin count
/// in no bin but in the whole, so that the integral over the bins is the share of values that they hold.
pub(crate) fn densities(values: impl Iterator<Item = f64>, edges: &[f64], density: &mut [f64]) {
    let bins = density.len();
    let top = edges.last().copied().unwrap_or(0.0);
    let width = top / bins as f64;
    density.fill(0.0);
    let mut all = 0u64;
    for value in values {
        all += 1;
        if value <= top {
            let bin = (value / width).max(0.0) as usize;
            if let Some(count) = density.get_mut(bin.min(bins - 1)) {
                *count += 1.0;
            }
        }
    }
    let whole = if all > 0 { all as f64 * width } else { 1.0 };
    density.iter_mut().for_each(|count| *count /= whole);
}

/// Number of spots of 2^k to 2^(k+1) - 1 cells, k from 0.
pub(crate) fn spot_classes(spots: &Spots, cell_area: f64, numbers: &mut [f64]) {
    numbers.fill(0.0);
    for area in &spots.areas {
        let cells = (area / cell_area).round().max(1.0) as u64;
        if let Some(number) = numbers.get_mut(cells.ilog2() as usize) {
            *number += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_density_integrates_to_the_share_inside() {
        let edges = [0.0, 1.0, 2.0, 3.0, 4.0];
        let mut density = [0.0; 4];
        let values = [-1e-9, 0.5, 1.0, 3.5, 4.0, 4.1, 9.0, f64::INFINITY];
        densities(values.into_iter(), &edges, &mut density);
        assert_eq!(density.map(|d| d * 8.0), [2.0, 1.0, 0.0, 2.0]);
        densities(std::iter::empty(), &edges, &mut density);
        assert_eq!(density, [0.0; 4]);
    }

    #[test]
    fn spots_are_sorted_by_powers_of_two() {
        let spots = Spots { areas: [9.0, 8.0, 7.0, 4.0, 3.0, 1.0, 1.0].map(|cells| 0.1 * cells).to_vec() };
        let mut numbers = [0.0; 5];
        spot_classes(&spots, 0.1, &mut numbers);
        assert_eq!(numbers, [2.0, 1.0, 2.0, 2.0, 0.0]);
    }
}
