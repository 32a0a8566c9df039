//! Finite volumes: a network of conductances between the centres of neighbouring cells.
//!
//! The flux between two cells is t (P_1 - P_2). For cells of mobility k = h^3 the conductance t is their harmonic mean, 2 k_1
//! k_2/(k_1 + k_2), times width over length of the cells, and 0 if either is closed. The harmonic mean is exact for cells in
//! series. Where elastic surfaces separate, h^3 varies as the 4.5th power of the distance from the contact, so edges of the
//! contact need no special treatment.
//!
//! A x = b is the balance of each cell: sum over its faces of t (x - x') plus g x equals b, with a conductance g to ground.

use rayon::prelude::*;

/// Smallest number of cells per task.
const TASK: usize = 8192;

/// Conductances of a rectangle of cells, C-order. Faces towards the next cell wrap around at the last cell; if the domain is not
/// periodic, they are 0 there.
#[derive(Clone, Debug)]
pub(super) struct Network {
    /// Cells along axis 0 and axis 1.
    pub cells: [usize; 2],
    /// Face to the next cell along axis 0.
    pub along: Vec<f64>,
    /// Face to the next cell along axis 1.
    pub across: Vec<f64>,
    /// Conductance to ground.
    pub ground: Vec<f64>,
}

/// The harmonic mean, without overflow.
pub(super) fn harmonic(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { 2.0 * a.min(b) / (1.0 + a.min(b) / a.max(b)) } else { 0.0 }
}

impl Network {
    /// From the mobility of the cells, without ground; `wraps` states which axes are periodic.
    pub fn of(cells: [usize; 2], spacing: [f64; 2], wraps: [bool; 2], mobility: &[f64]) -> Network {
        let [n, m] = cells;
        let aspect = spacing[1] / spacing[0];
        let ends = wraps.map(|wraps| !wraps);
        let mut along = vec![0.0; n * m];
        let mut across = vec![0.0; n * m];
        let rows = along.par_chunks_mut(m).zip(across.par_chunks_mut(m)).enumerate();
        rows.with_min_len(TASK.div_ceil(m)).for_each(|(i, (along, across))| {
            let row = |i: usize| &mobility[i * m..][..m];
            if !(ends[0] && i + 1 == n) {
                let faces = row(i).iter().zip(row((i + 1) % n));
                along.iter_mut().zip(faces).for_each(|(t, (a, b))| *t = aspect * harmonic(*a, *b));
            }
            let own = row(i);
            for j in 0..m {
                if !(ends[1] && j + 1 == m) {
                    across[j] = harmonic(own[j], own[(j + 1) % m]) / aspect;
                }
            }
        });
        Network { cells, along, across, ground: vec![0.0; n * m] }
    }

    /// Sum of all conductances of each cell, the diagonal of A; without those of a cell with itself, if a periodic axis has only
    /// one cell.
    pub fn diagonal(&self) -> Vec<f64> {
        let [n, m] = self.cells;
        let mut diagonal = vec![0.0; n * m];
        diagonal.par_chunks_mut(m).with_min_len(TASK.div_ceil(m)).enumerate().for_each(|(i, row)| {
            for (j, d) in row.iter_mut().enumerate() {
                let here = i * m + j;
                let others = self.faces(i, j).into_iter().filter(|(_, other)| *other != here);
                *d = others.map(|(t, _)| t).sum::<f64>() + self.ground[here];
            }
        });
        diagonal
    }

    /// The four faces of a cell: conductance, and the cell behind it.
    #[inline(always)]
    pub fn faces(&self, i: usize, j: usize) -> [(f64, usize); 4] {
        let [n, m] = self.cells;
        let above = if i > 0 { i - 1 } else { n - 1 };
        let below = if i + 1 < n { i + 1 } else { 0 };
        let before = if j > 0 { j - 1 } else { m - 1 };
        let after = if j + 1 < m { j + 1 } else { 0 };
        let here = i * m + j;
        [
            (self.along[above * m + j], above * m + j),
            (self.across[i * m + before], i * m + before),
            (self.across[here], i * m + after),
            (self.along[here], below * m + j),
        ]
    }

    /// The flow from a cell to the faces and the ground: (A x) of that cell.
    #[inline(always)]
    pub fn outflow(&self, x: &[f64], i: usize, j: usize) -> f64 {
        let here = i * self.cells[1] + j;
        // The differences are computed first: the flux has the same value with opposite sign on both sides of a face, so nothing
        // is lost in the sum over a region of large conductance.
        let flux = self.faces(i, j).map(|(t, other)| t * (x[here] - x[other]));
        (flux[0] + flux[3]) + (flux[1] + flux[2]) + self.ground[here] * x[here]
    }

    /// out = b - A x.
    pub fn residual(&self, b: &[f64], x: &[f64], out: &mut [f64]) {
        self.each(out, |i, j, here| b[here] - self.outflow(x, i, j));
    }

    /// out = A x.
    pub fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.each(out, |i, j, _| self.outflow(x, i, j));
    }

    /// Writes a value to every cell, from its row, its column and its number.
    pub fn each(&self, out: &mut [f64], value: impl Fn(usize, usize, usize) -> f64 + Sync) {
        let m = self.cells[1];
        out.par_chunks_mut(m).with_min_len(TASK.div_ceil(m)).enumerate().for_each(|(i, row)| {
            row.iter_mut().enumerate().for_each(|(j, out)| *out = value(i, j, i * m + j));
        });
    }

    /// Sum over all faces of t (x - x' + e)^2, with e the drop that is prescribed from a cell to the next along each axis.
    pub fn power(&self, x: &[f64], drop: [f64; 2]) -> f64 {
        let [n, m] = self.cells;
        let row = |i: usize| -> f64 {
            let below = if i + 1 < n { i + 1 } else { 0 };
            let term = |j: usize| {
                let after = if j + 1 < m { j + 1 } else { 0 };
                let (here, next, beside) = (i * m + j, below * m + j, i * m + after);
                self.along[here] * (x[here] - x[next] + drop[0]).powi(2)
                    + self.across[here] * (x[here] - x[beside] + drop[1]).powi(2)
            };
            (0..m).map(term).sum()
        };
        // One sum per row, added in order: the same bits for any number of threads.
        let rows: Vec<f64> = (0..n).into_par_iter().with_min_len(TASK.div_ceil(m)).map(row).collect();
        rows.iter().sum()
    }
}
