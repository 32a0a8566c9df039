//! The tori that the preconditioner works on.

use asperity_convolution::lanes::Lanes;

use super::neighbours::margins;
use crate::grid::{Boundary, Grid};
use crate::operator::{APART, ApproximateInverse};

/// The spectra of a plan: M, the symbol |q|/2, and G, the symbol 1/(|q|/2 + c).
pub(super) const M: usize = 0;
pub(super) const G: usize = 1;

/// Plans of M and G. What is free may not see itself around a torus: the ends of a set are to be kept apart. Where its own
/// margins do that, a torus of little more than the domain's cells will do, of a fifth fewer cells at 1024 x 1024.
///
/// Which torus is used depends on the set alone. Each is planned when it is first wanted.
pub(super) struct Tori {
    grid: Grid,
    /// For sets with margins, and for any.
    close: Torus,
    wide: Torus,
}

struct Torus {
    lengths: [usize; 2],
    plan: Option<Lanes<f32>>,
}

impl Tori {
    pub(super) fn new(grid: &Grid, boundary: Boundary) -> Self {
        let torus = |apart| Torus { lengths: ApproximateInverse::lengths(grid, boundary, apart), plan: None };
        Tori { grid: *grid, close: torus(0), wide: torus(APART) }
    }

    /// The plan for a set of cells.
    pub(super) fn around(&mut self, set: &[u8]) -> &mut Lanes<f32> {
        let torus = if self.is_apart(set) { &mut self.close } else { &mut self.wide };
        let planned = || ApproximateInverse::on(&self.grid, torus.lengths).plan_with_screened();
        torus.plan.get_or_insert_with(planned)
    }

    /// True where the close torus differs from the wide one and keeps the ends of the set apart.
    fn is_apart(&self, set: &[u8]) -> bool {
        let (cells, lengths) = (self.grid.cells(), self.close.lengths);
        let margins = || margins(set, cells, APART);
        lengths != self.wide.lengths
            && margins().iter().zip(lengths).zip(cells).all(|((margin, m), n)| margin + m - n >= APART)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Which tori are planned after a set of so many empty rows at the top, and the others at the bottom.
    fn planned(
        boundary: Boundary,
        cells: [usize; 2],
        rows: std::ops::Range<usize>,
        left: usize,
    ) -> [bool; 2] {
        let [nx, ny] = cells;
        let mut set = vec![0; (nx * ny).div_ceil(8)];
        for n in rows.flat_map(|i| (left..ny - left).map(move |j| i * ny + j)) {
            set[n / 8] |= 1 << (n % 8);
        }
        let mut tori = Tori::new(&Grid::new(cells, [1.0, 1.0]).unwrap(), boundary);
        tori.around(&set);
        [tori.close, tori.wide].map(|torus| torus.plan.is_some())
    }

    #[test]
    fn a_set_that_keeps_clear_of_the_rim_needs_no_room_beyond_it() {
        let (close, wide) = ([true, false], [false, true]);
        assert_eq!(planned(Boundary::Free, [128, 64], 8..120, 8), close);
        assert_eq!(planned(Boundary::Free, [128, 64], 16..128, 8), close);
        assert_eq!(planned(Boundary::Free, [128, 64], 15..128, 8), wide);
        assert_eq!(planned(Boundary::Free, [128, 64], 8..120, 7), wide);
        // 120 rows are transformed as 128 anyway.
        assert_eq!(planned(Boundary::Free, [120, 64], 4..116, 8), close);
        assert_eq!(planned(Boundary::Free, [112, 48], 0..112, 0), wide);
        assert_eq!(planned(Boundary::Periodic, [128, 64], 20..100, 20), wide);
    }
}
