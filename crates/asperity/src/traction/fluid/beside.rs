//! What lies beside a cell: the four cells that share an edge with it, and the reservoirs at the borders of the flow.

use crate::grid::Grid;
use crate::leakage::Direction;
use crate::spots::Forest;

/// What a face of a cell leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Other {
    Cell(usize),
    /// 0 the inlet, 1 the outlet.
    Reservoir(usize),
}

/// The faces of the cells of a grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    cells: [usize; 2],
    /// Axis of the flow.
    along: usize,
    /// Whether opposite sides across the flow are neighbours.
    wraps: bool,
    /// Width over length of the faces along x and y.
    weights: [f64; 2],
}

impl Beside {
    pub(super) fn new(grid: &Grid, direction: Direction, wraps: bool) -> Self {
        let [dx, dy] = grid.spacing();
        Beside {
            cells: grid.cells(),
            along: if direction == Direction::X { 0 } else { 1 },
            wraps,
            weights: [dy / dx, dx / dy],
        }
    }

    /// Width over length of each face of a cell, and what lies behind it. These are the shares with which a cell that opens by a very
    /// small gap takes the pressures around it: conductances are harmonic means, there those of the cell itself.
    pub(super) fn of(&self, cell: usize) -> impl Iterator<Item = (f64, Other)> {
        let at = [cell / self.cells[1], cell % self.cells[1]];
        let strides = [self.cells[1], 1];
        let own = *self;
        [(0, false), (0, true), (1, false), (1, true)].into_iter().filter_map(move |(axis, forward)| {
            let (n, i, stride) = (own.cells[axis], at[axis], strides[axis]);
            let is_last = if forward { i + 1 == n } else { i == 0 };
            let other = match (is_last, forward) {
                (false, true) => Other::Cell(cell + stride),
                (false, false) => Other::Cell(cell - stride),
                (true, _) if axis == own.along => Other::Reservoir(usize::from(forward)),
                (true, _) if !own.wraps || n < 2 => return None,
                (true, true) => Other::Cell(cell - (n - 1) * stride),
                (true, false) => Other::Cell(cell + (n - 1) * stride),
            };
            Some((own.weights[axis], other))
        })
    }

    /// The cells of `marked`, joined with their neighbours.
    pub(super) fn joined(&self, marked: &[bool]) -> Forest {
        let mut forest = Forest::new(marked.len());
        for cell in (0..marked.len()).filter(|cell| marked[*cell]) {
            for (_, other) in self.of(cell) {
                if let Other::Cell(other) = other
                    && marked[other]
                {
                    forest.join(cell, other);
                }
            }
        }
        forest
    }

    /// Length of the edges of a cell beyond which nothing is `marked`, on cells of this area.
    pub(super) fn edges(&self, cell: usize, marked: &[bool], cell_area: f64) -> f64 {
        let faces = self.of(cell).filter(|(_, other)| !matches!(other, Other::Cell(other) if marked[*other]));
        faces.map(|(weight, _)| (weight * cell_area).sqrt()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cell_has_the_faces_of_its_place() {
        let grid = Grid::new([3, 4], [3.0, 8.0]).unwrap();
        let faces = |direction, wraps, cell| -> Vec<(f64, Other)> {
            Beside::new(&grid, direction, wraps).of(cell).collect()
        };
        use Other::{Cell, Reservoir};
        // Cells of 1 x 2: faces along x are 2 wide and 1 long.
        assert_eq!(
            faces(Direction::X, true, 0),
            [(2.0, Reservoir(0)), (2.0, Cell(4)), (0.5, Cell(3)), (0.5, Cell(1))]
        );
        assert_eq!(faces(Direction::X, false, 3), [(2.0, Reservoir(0)), (2.0, Cell(7)), (0.5, Cell(2))]);
        assert_eq!(
            faces(Direction::Y, true, 11),
            [(2.0, Cell(7)), (2.0, Cell(3)), (0.5, Cell(10)), (0.5, Reservoir(1))]
        );
    }
}
