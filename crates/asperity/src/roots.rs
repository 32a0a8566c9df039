//! Roots that lie between two places.

/// An interval after so many halvings: its lower end goes to the middle where `is_below` holds there, else its upper end.
pub(crate) fn bisected(
    [mut low, mut high]: [f64; 2],
    halvings: usize,
    is_below: impl Fn(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    [low, high]
}
