//! Contact spots: the connected parts of the contact area.
//!
//! Two cells belong to the same spot if they share an edge and are both in contact; on a periodic domain cells at opposite
//! borders share their edges. The labelling is a union-find method on two rows at a time (C. Fiorio & J. Gustedt, Theor. Comput.
//! Sci. 154 (1996) 165).

use ndarray::{Array2, ArrayView2};

use crate::grid::{Boundary, Grid};

/// The spots of one contact, largest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Spots {
    /// Area of each spot \[m^2\].
    pub areas: Vec<f64>,
}

impl Spots {
    /// Largest number of bytes needed to find them: the forest of cells and its counts.
    pub(crate) fn bytes(grid: &Grid) -> usize {
        16 * grid.len()
    }

    /// Spots of the cells where `touches` is true.
    ///
    /// ```
    /// use asperity::{Boundary, Grid, spots::Spots};
    /// let grid = Grid::new([3, 4], [3.0, 4.0])?;
    /// let p = ndarray::array![[1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 0.0, 0.0], [0.0, 3.0, 4.0, 0.0]];
    /// let free = Spots::of(&grid, Boundary::Free, p.view(), |p| *p > 0.0);
    /// assert_eq!(free.areas, [2.0, 1.0, 1.0]);
    /// // The two corners touch each other across the border.
    /// let periodic = Spots::of(&grid, Boundary::Periodic, p.view(), |p| *p > 0.0);
    /// assert_eq!(periodic.areas, [2.0, 2.0]);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// `cells` has the shape of the grid.
    pub fn of<T>(
        grid: &Grid,
        boundary: Boundary,
        cells: ArrayView2<T>,
        touches: impl Fn(&T) -> bool,
    ) -> Spots {
        let (_, counts) = roots(boundary, cells, touches);
        let mut counts: Vec<usize> = counts.into_iter().filter(|count| *count > 0).collect();
        counts.sort_unstable_by(|a, b| b.cmp(a));
        Spots { areas: counts.into_iter().map(|count| count as f64 * grid.cell_area()).collect() }
    }

    /// Number of spots.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    /// Whether there is no contact.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Mean area of a spot \[m^2\]; 0 if there is no contact.
    pub fn mean_area(&self) -> f64 {
        if self.areas.is_empty() { 0.0 } else { self.areas.iter().sum::<f64>() / self.areas.len() as f64 }
    }
}

/// The number of the spot of each cell, 1 for the largest, and 0 outside the contact. Of two spots of the same size, the one with
/// the earlier cell comes first.
///
/// ```
/// use asperity::{Boundary, spots::labels};
/// let p = ndarray::array![[1, 0, 1], [0, 0, 1]];
/// assert_eq!(labels(Boundary::Free, p.view(), |p| *p > 0), ndarray::array![[2, 0, 1], [0, 0, 1]]);
/// ```
pub fn labels<T>(boundary: Boundary, cells: ArrayView2<T>, touches: impl Fn(&T) -> bool) -> Array2<u32> {
    let (roots, counts) = roots(boundary, cells.view(), touches);
    let mut spots: Vec<usize> = (0..counts.len()).filter(|root| counts[*root] > 0).collect();
    spots.sort_by(|a, b| counts[*b].cmp(&counts[*a]).then(a.cmp(b)));
    let mut numbers = vec![0; counts.len()];
    spots.iter().zip(1..).for_each(|(root, number)| numbers[*root] = number);
    let mut labels = Array2::zeros(cells.dim());
    labels.iter_mut().zip(roots).for_each(|(label, root)| *label = root.map_or(0, |root| numbers[root]));
    labels
}

/// The representative cell of the spot of each cell, `None` outside the contact, and the number of cells of each spot.
fn roots<T>(
    boundary: Boundary,
    cells: ArrayView2<T>,
    touches: impl Fn(&T) -> bool,
) -> (Vec<Option<usize>>, Vec<usize>) {
    let (nx, ny) = cells.dim();
    let at = |i: usize, j: usize| i * ny + j;
    let on = |i: usize, j: usize| touches(&cells[[i, j]]);
    let mut forest = Forest::of([nx, ny], [boundary == Boundary::Periodic; 2], on);
    let mut counts = vec![0usize; nx * ny];
    let mut roots = vec![None; nx * ny];
    for i in 0..nx {
        for j in (0..ny).filter(|j| on(i, *j)) {
            let root = forest.root(at(i, j));
            counts[root] += 1;
            roots[at(i, j)] = Some(root);
        }
    }
    (roots, counts)
}

/// Whether connected cells reach from one border of the domain to the opposite one, along x and along y. Cells that share an
/// edge are connected; on a periodic domain also across the borders at the sides of the path.
///
/// ```
/// use asperity::{Boundary, spots::spans};
/// let p = ndarray::array![[0, 1, 0], [0, 1, 1], [0, 0, 1]];
/// assert_eq!(spans(Boundary::Free, p.view(), |p| *p > 0), [true, false]);
/// assert_eq!(spans(Boundary::Free, p.view(), |p| *p == 0), [true, false]);
/// ```
pub fn spans<T>(boundary: Boundary, cells: ArrayView2<T>, on: impl Fn(&T) -> bool) -> [bool; 2] {
    [spans_x(boundary, cells.view(), &on), spans_x(boundary, cells.reversed_axes(), &on)]
}

fn spans_x<T>(boundary: Boundary, cells: ArrayView2<T>, on: impl Fn(&T) -> bool) -> bool {
    let (nx, ny) = cells.dim();
    let at = |i: usize, j: usize| i * ny + j;
    let on = |i: usize, j: usize| on(&cells[[i, j]]);
    let mut forest = Forest::of([nx, ny], [false, boundary == Boundary::Periodic], on);
    let mut reached = vec![false; nx * ny];
    for j in (0..ny).filter(|j| nx > 0 && on(0, *j)) {
        reached[forest.root(at(0, j))] = true;
    }
    (0..ny).any(|j| nx > 0 && on(nx - 1, j) && reached[forest.root(at(nx - 1, j))])
}

/// Cells that point to another cell of their spot; the first cell of a spot points to itself.
pub(crate) struct Forest(Vec<usize>);

impl Forest {
    /// Cells that are all separate.
    pub(crate) fn new(cells: usize) -> Self {
        Forest((0..cells).collect())
    }

    /// The cells of an nx x ny grid that are `on`, joined with their neighbours, also across the borders of the axes that wrap around.
    pub(crate) fn of([nx, ny]: [usize; 2], wraps: [bool; 2], on: impl Fn(usize, usize) -> bool) -> Self {
        let mut forest = Forest::new(nx * ny);
        for i in 0..nx {
            for j in (0..ny).filter(|j| on(i, *j)) {
                let neighbours = [
                    (i > 0).then(|| (i - 1, j)),
                    (j > 0).then(|| (i, j - 1)),
                    (wraps[0] && i + 1 == nx).then_some((0, j)),
                    (wraps[1] && j + 1 == ny).then_some((i, 0)),
                ];
                for (k, l) in neighbours.into_iter().flatten().filter(|(k, l)| on(*k, *l)) {
                    forest.join(k * ny + l, i * ny + j);
                }
            }
        }
        forest
    }

    /// The representative cell of its spot.
    pub(crate) fn root(&mut self, mut cell: usize) -> usize {
        while self.0[cell] != cell {
            // Halve the path on the way.
            self.0[cell] = self.0[self.0[cell]];
            cell = self.0[cell];
        }
        cell
    }

    /// Merges the spots of two cells.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(rows: &[&str], boundary: Boundary) -> Vec<f64> {
        let (nx, ny) = (rows.len(), rows[0].len());
        let grid = Grid::new([nx, ny], [nx as f64, ny as f64]).unwrap();
        let cells = ndarray::Array2::from_shape_fn((nx, ny), |(i, j)| rows[i].as_bytes()[j]);
        Spots::of(&grid, boundary, cells.view(), |c| *c == b'#').areas
    }

    #[test]
    fn a_spiral_is_one_spot_and_corners_do_not_connect() {
        let spiral = ["#######", "......#", "#####.#", "#...#.#", "#.###.#", "#.....#", "#######"];
        assert_eq!(count(&spiral, Boundary::Free), [31.0]);
        assert_eq!(count(&["#.#", ".#.", "#.#"], Boundary::Free), [1.0; 5]);
        assert_eq!(count(&["...", "..."], Boundary::Free), [0.0; 0]);
    }

    #[test]
    fn a_periodic_spot_may_wrap_in_both_directions() {
        assert_eq!(count(&["#..#", "....", "#..#"], Boundary::Periodic), [4.0]);
        assert_eq!(count(&["#..#", "....", "#..#"], Boundary::Free), [1.0; 4]);
        // A comb whose teeth meet only across the border.
        assert_eq!(count(&["#.#.", "#.#.", "####"], Boundary::Periodic), [8.0]);
        assert_eq!(count(&["#.#.", "....", "#.#."], Boundary::Periodic), [2.0, 2.0]);
    }

    #[test]
    fn a_path_spans_the_domain_from_border_to_border() {
        let spans = |rows: &[&str], boundary| {
            let cells =
                ndarray::Array2::from_shape_fn((rows.len(), rows[0].len()), |(i, j)| rows[i].as_bytes()[j]);
            super::spans(boundary, cells.view(), |c| *c == b'#')
        };
        // Rows run along y.
        let across = ["....", "####", "...."];
        assert_eq!(spans(&across, Boundary::Free), [false, true]);
        // A path along x that continues across the side: only a periodic domain has it.
        let around = ["#...", "#..#", "...#"];
        assert_eq!(spans(&around, Boundary::Free), [false, false]);
        assert_eq!(spans(&around, Boundary::Periodic), [true, false]);
        // The border that the path must reach is not periodic: a gap in the middle remains a gap.
        assert_eq!(spans(&["##", "..", "##"], Boundary::Periodic), [false, true]);
        assert_eq!(spans(&["#.", ".#"], Boundary::Free), [false, false]);
        assert_eq!(spans(&["..", ".."], Boundary::Periodic), [false, false]);
    }

    #[test]
    fn areas_add_up_to_the_contact() {
        // A fixed pattern of many spots.
        let grid = Grid::new([50, 41], [5.0, 8.2]).unwrap();
        let p = ndarray::Array2::from_shape_fn((50, 41), |(i, j)| (i * i * 7 + j * j * 13 + i * j) % 10);
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let spots = Spots::of(&grid, boundary, p.view(), |p| *p < 4);
            let cells = p.iter().filter(|p| **p < 4).count() as f64;
            let sum: f64 = spots.areas.iter().sum();
            assert!((sum / grid.cell_area() - cells).abs() < 1e-9);
            assert!(spots.areas.windows(2).all(|pair| pair[0] >= pair[1]));
            assert!((spots.mean_area() * spots.len() as f64 - sum).abs() < 1e-9);
        }
    }
}
