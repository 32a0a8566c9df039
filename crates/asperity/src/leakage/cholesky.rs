//! Sparse Cholesky factorisation of a network by faer (supernodal, minimum-degree ordering).
//!
//! The matrix is scaled to a diagonal of 1. If rounding makes a pivot too small, it is replaced (a region of large gaps behind a
//! narrow passage is disconnected to within rounding), so the factorisation never fails. The conjugate gradients around it
//! (`solve`) remove the resulting error.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::network::Network;

/// Pivots of the scaled matrix below this value are replaced by it.
const SMALLEST_PIVOT: f64 = 1e-14;

/// The factor of a network.
pub(super) struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    /// Number in the network of each unknown.
    cells: Vec<u32>,
    /// One over the square root of the diagonal, for each unknown.
    scale: Vec<f64>,
    right: Vec<f64>,
    work: MemBuffer,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Cholesky of {} unknowns", self.cells.len())
    }
}

/// Approximate memory of a factorisation for this number of open cells \[bytes\]; measured: 630 per cell at 2^20, 750 at 2^22.
pub fn factor_bytes(unknowns: usize) -> f64 {
    34.0 * unknowns as f64 * (unknowns.max(2) as f64).log2()
}

impl Cholesky {
    /// Factorises the matrix; `None` if the memory is not sufficient.
    pub fn new(network: &Network) -> Option<Cholesky> {
        let m = network.cells[1];
        let diagonal = network.diagonal();
        let cells: Vec<u32> =
            (0..diagonal.len() as u32).filter(|cell| diagonal[*cell as usize] > 0.0).collect();
        let scale: Vec<f64> = cells.iter().map(|cell| diagonal[*cell as usize].sqrt().recip()).collect();
        let mut number = vec![u32::MAX; diagonal.len()];
        (0u32..).zip(&cells).for_each(|(k, cell)| number[*cell as usize] = k);
        drop(diagonal);
        // The lower triangle by columns: for each unknown, itself and its neighbours with a larger number.
        let mut starts = Vec::with_capacity(cells.len() + 1);
        let mut rows: Vec<u32> = Vec::with_capacity(3 * cells.len());
        let mut values = Vec::with_capacity(3 * cells.len());
        starts.push(0u32);
        for (k, cell) in (0u32..).zip(&cells) {
            let cell = *cell as usize;
            rows.push(k);
            values.push(1.0);
            let mut faces = network.faces(cell / m, cell % m).map(|(t, other)| (number[other], t));
            faces.sort_unstable_by_key(|(other, _)| *other);
            let first = rows.len();
            for (other, t) in faces.into_iter().filter(|(other, t)| *t > 0.0 && *other > k) {
                let value = -t * scale[k as usize] * scale[other as usize];
                // Two cells share two faces if a periodic axis has two cells.
                if rows.len() > first && rows.last() == Some(&other) {
                    *values.last_mut()? += value;
                } else {
                    rows.push(other);
                    values.push(value);
                }
            }
            starts.push(u32::try_from(rows.len()).ok()?);
        }
        drop(number);
        let n = cells.len();
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        let ordering = SymmetricOrdering::Amd;
        let symbolic =
            factorize_symbolic_cholesky(pattern, Side::Lower, ordering, CholeskySymbolicParams::default())
                .ok()?;
        let mut factor = Vec::new();
        factor.try_reserve_exact(symbolic.len_val()).ok()?;
        factor.resize(symbolic.len_val(), 0.0);
        let params = Default::default();
        let request = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, params);
        let mut work = MemBuffer::try_new(request).ok()?;
        let floor = LltRegularization {
            dynamic_regularization_delta: SMALLEST_PIVOT,
            dynamic_regularization_epsilon: SMALLEST_PIVOT,
        };
        let matrix = SparseColMatRef::new(pattern, &values);
        let stack = MemStack::new(&mut work);
        symbolic
            .factorize_numeric_llt(&mut factor, matrix, Side::Lower, floor, Par::Seq, stack, params)
            .ok()?;
        let work = MemBuffer::try_new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)).ok()?;
        Some(Cholesky { symbolic, values: factor, right: vec![0.0; n], cells, scale, work })
    }

    /// The numbers of its cells in the network.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        self.cells.iter().map(|cell| *cell as usize)
    }

    /// out = A^-1 b, and 0 for cells that are not unknowns.
    pub fn solve(&mut self, b: &[f64], out: &mut [f64]) {
        for ((right, cell), scale) in self.right.iter_mut().zip(&self.cells).zip(&self.scale) {
            *right = b[*cell as usize] * scale;
        }
        let n = self.right.len();
        let right = MatMut::from_column_major_slice_mut(&mut self.right, n, 1);
        let factor = LltRef::new(&self.symbolic, &self.values);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, MemStack::new(&mut self.work));
        out.fill(0.0);
        for ((right, cell), scale) in self.right.iter().zip(&self.cells).zip(&self.scale) {
            out[*cell as usize] = right * scale;
        }
    }
}
