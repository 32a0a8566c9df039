//! Bisection, the median and the extent of numbers.

/// The ends of the interval in which `holds` changes from true to false, after this number of halvings; it is true at the first end.
pub(crate) fn bisect(
    [mut low, mut high]: [f64; 2],
    halvings: usize,
    holds: impl Fn(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    [low, high]
}

/// The median (the upper one of an even number), 0 of no values; reorders them.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    match values.len() {
        0 => 0.0,
        count => *values.select_nth_unstable_by(count / 2, f64::total_cmp).1,
    }
}

/// The smallest and the largest value.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let [low, high] = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold([low, high], |[low, high], x| [low.min(x), high.max(x)])
}
