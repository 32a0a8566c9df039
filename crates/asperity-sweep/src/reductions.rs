//! Reductions of whole fields, by name.

use crate::merge::{Min, smaller};
use crate::sweep::{strands, sweep};

/// sum of the cells.
pub fn sum(field: &[f64]) -> f64 {
    sweep(field, &|f: &[f64]| strands(f.len(), |i| [f[i]]))[0]
}

/// Smallest cell; infinity where there is none.
pub fn minimum(field: &[f64]) -> f64 {
    sweep(field, &|f: &[f64]| Min(f.iter().fold(f64::INFINITY, |m, v| smaller(*v, m)))).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_the_same_bits_for_any_number_of_threads() {
        let field: Vec<f64> = (0..100_003).map(|i| (i as f64).sin() * 10f64.powi(i % 17)).collect();
        let on = |threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| sum(&field))
        };
        assert_eq!(on(1).to_bits(), on(2).to_bits());
        assert_eq!(on(1).to_bits(), on(7).to_bits());
    }
}
