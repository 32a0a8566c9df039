//! How much memory a run needs.

/// Bytes per cell of a run whose bodies remember nothing: spectrum and rows of the padded transform, the solver's
/// and the march's fields, a checkpoint while it is written, what is stored. An upper bound.
const BYTES_PER_CELL: u128 = 200;
/// Bytes per cell and remembered field: the field, and its copy in a checkpoint.
const BYTES_PER_FIELD: u128 = 16;

/// Bytes that a run takes whose bodies remember `fields` fields: one per retarded term and one for flow; one per
/// row where the full hereditary sum is taken.
pub fn estimate(cells: [usize; 2], fields: usize) -> u128 {
    let cells = cells[0] as u128 * cells[1] as u128;
    cells.saturating_mul(BYTES_PER_CELL + BYTES_PER_FIELD * fields as u128)
}

/// "3.2 GB".
pub fn words(bytes: u128) -> String {
    const UNITS: [&str; 7] = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < UNITS.len() {
        value /= 1000.0;
        unit += 1;
    }
    match unit {
        0 => format!("{bytes} bytes"),
        _ if value >= 1e4 => format!("{value:.1e} {}", UNITS[unit]),
        _ => format!("{value:.3} {}", UNITS[unit]).replace(".000 ", " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::material::{Creep, CreepTerm};
    use asperity::{Boundary, Grid, Simulation};

    #[test]
    fn the_estimate_bounds_what_the_march_says_of_itself() {
        let grid = Grid::new([128, 128], [1.0, 1.0]).unwrap();
        let term = |n: usize| CreepTerm { compliance: 1.0, retardation_time: n as f64 + 1.0 };
        for (terms, fluidity) in [(0, 0.0), (2, 0.0), (40, 1.0)] {
            for boundary in [Boundary::Free, Boundary::Periodic] {
                let creep = Creep { instantaneous: 1.0, terms: (0..terms).map(term).collect(), fluidity };
                let flow = usize::from(fluidity > 0.0);
                let simulation = Simulation {
                    boundary,
                    creep,
                    ..Simulation::new(grid, ndarray::Array2::zeros((128, 128)))
                };
                // Five fields more are staged for the result, or lie in a checkpoint.
                let march = (simulation.bytes() + 128 * 128 * (8 * (terms + flow) + 5 * 8)) as u128;
                let bound = estimate([128, 128], terms + flow);
                assert!(march <= bound && bound < 2 * march, "{march} {bound}");
            }
        }
        assert_eq!(estimate([1024, 1024], 2), 232 << 20);
        assert!(estimate([usize::MAX, usize::MAX], usize::MAX) > u128::from(u64::MAX)); // no overflow
    }

    #[test]
    fn sizes_in_words() {
        assert_eq!(words(999), "999 bytes");
        assert_eq!(words(3_200_000_000), "3.200 GB");
        assert_eq!(words(200_000_000_000_000), "200 TB");
        assert!(words(u128::MAX).ends_with("EB"));
    }
}
