//! The fields of a memory's branches, and what is done with them cell by cell.
//!
//! The blocks of the fields lie side by side, \[block\]\[branch\]\[cell\], so that a sweep's block is one slice, and each field is
//! read and written once per step.

use crate::error::Result;
use crate::step::{Loader, Saver};
use asperity_sweep::{BLOCK, Cells, strands, sweep};

/// Cells that are worked on together: their branches stay in the first caches.
const CHUNK: usize = 512;

/// What a branch field becomes over a step: q' = keep q + old u + new u'.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Update {
    pub(crate) keep: f64,
    pub(crate) old: f64,
    pub(crate) new: f64,
}

/// A sum over the branches and u: Σ weights\[i\] q_i + own u.
#[derive(Clone, Copy)]
pub(crate) struct Combination<'a> {
    pub(crate) weights: &'a [f64],
    pub(crate) own: f64,
}

/// The step that ends: u' = compliance U + recalled, then the updates.
#[derive(Clone, Copy)]
pub(crate) struct Ending<'a> {
    pub(crate) compliance: f64,
    pub(crate) recalled: Combination<'a>,
    pub(crate) updates: &'a [Update],
}

/// Branch fields of a grid.
pub(crate) struct Branches {
    cells: usize,
    count: usize,
    data: Vec<f64>,
}

impl Branches {
    pub(crate) fn new(count: usize, cells: usize) -> Self {
        Branches { cells, count, data: vec![0.0; count * cells] }
    }

    fn blocks(&mut self) -> Interleaved<&mut [f64]> {
        Interleaved { cells: self.cells, branches: self.count, data: &mut self.data }
    }

    fn lent(&self) -> Interleaved<&[f64]> {
        Interleaved { cells: self.cells, branches: self.count, data: &self.data }
    }

    /// Ends a step that began with `u`: writes u' to `fresh` and updates the branches. Then writes `gap` = `rigid` + `next`, where
    /// these are given.
    pub(crate) fn end(
        &mut self,
        ending: Ending<'_>,
        unit: &[f64],
        u: &[f64],
        fresh: &mut [f64],
        next: Option<(Combination<'_>, &[f64], &mut [f64])>,
    ) {
        let (combination, gaps) = match next {
            Some((combination, rigid, gap)) => (Some(combination), Some((rigid, gap))),
            None => (None, None),
        };
        let kernel = |(q, unit, u, fresh, gaps): (
            Interleaved<&mut [f64]>,
            &[f64],
            &[f64],
            &mut [f64],
            Option<(&[f64], &mut [f64])>,
        )| {
            let (n, mut gaps) = (u.len(), gaps);
            for start in (0..n).step_by(CHUNK) {
                let own = start..n.min(start + CHUNK);
                let (unit, u, fresh) = (&unit[own.clone()], &u[own.clone()], &mut fresh[own.clone()]);
                fresh.fill(0.0);
                ending.recalled.add(fresh, u, |i| &q.data[i * n..][own.clone()]);
                fresh.iter_mut().zip(unit).for_each(|(f, unit)| *f += ending.compliance * unit);
                let mut gap = gaps.as_mut().map(|(rigid, gap)| {
                    let gap = &mut gap[own.clone()];
                    gap.copy_from_slice(&rigid[own.clone()]);
                    gap
                });
                for (i, update) in ending.updates.iter().enumerate() {
                    let q = &mut q.data[i * n..][own.clone()];
                    for (q, (u, fresh)) in q.iter_mut().zip(u.iter().zip(&*fresh)) {
                        *q = update.keep * *q + update.old * u + update.new * fresh;
                    }
                    if let (Some(gap), Some(next)) = (&mut gap, combination) {
                        let weight = next.weights[i];
                        gap.iter_mut().zip(&*q).for_each(|(g, q)| *g += weight * q);
                    }
                }
                if let (Some(gap), Some(next)) = (gap, combination) {
                    gap.iter_mut().zip(fresh).for_each(|(g, u)| *g += next.own * *u);
                }
            }
        };
        sweep((self.blocks(), unit, u, fresh, gaps), &kernel);
    }

    /// Writes `sum` = `base` + the combination; 0 in place of no base.
    pub(crate) fn combine(&self, of: Combination<'_>, u: &[f64], base: Option<&[f64]>, sum: &mut [f64]) {
        sweep((self.lent(), u, sum, base), &|(q, u, sum, base): (
            Interleaved<&[f64]>,
            &[f64],
            &mut [f64],
            Option<&[f64]>,
        )| {
            let n = u.len();
            match base {
                Some(base) => sum.copy_from_slice(base),
                None => sum.fill(0.0),
            }
            of.add(sum, u, |i| &q.data[i * n..(i + 1) * n]);
        });
    }

    /// q' = `matrix` (q, u), rows of as many numbers as branches and one more; u' = the last row, where there is one.
    pub(crate) fn recast(&mut self, matrix: &[Vec<f64>], u: &mut [f64]) {
        let count = self.count;
        sweep((self.blocks(), u), &|(q, u): (Interleaved<&mut [f64]>, &mut [f64])| {
            let n = u.len();
            let mut cell = vec![0.0; count + 1];
            for (k, u) in u.iter_mut().enumerate() {
                cell[..count].iter_mut().enumerate().for_each(|(i, state)| *state = q.data[i * n + k]);
                cell[count] = *u;
                for (i, row) in matrix.iter().enumerate() {
                    let sum = row.iter().zip(&cell).map(|(a, b)| a * b).sum();
                    if i < count {
                        q.data[i * n + k] = sum;
                    } else {
                        *u = sum;
                    }
                }
            }
        });
    }

    /// The products Σ q_i p over the cells, and Σ u p.
    pub(crate) fn products(&self, u: &[f64], pressure: &[f64]) -> Vec<f64> {
        use rayon::prelude::*;
        let count = self.count;
        let product = |a: &[f64], p: &[f64]| strands(p.len(), |k| [a[k] * p[k]])[0];
        // One block after the other, summed in their order: the same bits on any number of threads.
        let blocks: Vec<Vec<f64>> = (u.par_chunks(BLOCK).zip(pressure.par_chunks(BLOCK)).enumerate())
            .map(|(block, (u, p))| {
                let n = u.len();
                let q = &self.data[block * BLOCK * count..][..n * count];
                let mut sums: Vec<f64> = q.chunks(n).map(|q| product(q, p)).collect();
                sums.push(product(u, p));
                sums
            })
            .collect();
        (0..=count).map(|i| blocks.iter().map(|sums| sums[i]).sum()).collect()
    }

    /// Saves the fields `name`_0, `name`_1 and so on.
    pub(crate) fn save(&self, to: &mut Saver<'_>, name: &str) {
        let mut fields = vec![Vec::with_capacity(self.cells); self.count];
        for block in self.data.chunks(BLOCK * self.count.max(1)) {
            let parts = block.chunks(block.len() / self.count);
            fields.iter_mut().zip(parts).for_each(|(field, part)| field.extend_from_slice(part));
        }
        fields.into_iter().enumerate().for_each(|(k, field)| to.owned_field(&format!("{name}_{k}"), field));
    }

    /// Takes back what [`Branches::save`] gave.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) where it does not fit.
    pub(crate) fn load(&mut self, from: &Loader<'_>, name: &str) -> Result<()> {
        let fields = (0..self.count).map(|k| from.field(&format!("{name}_{k}")));
        let fields = fields.collect::<Result<Vec<_>>>()?;
        self.data.clear();
        for start in (0..self.cells).step_by(BLOCK) {
            let end = self.cells.min(start + BLOCK);
            fields.iter().for_each(|f| self.data.extend_from_slice(&f[start..end]));
        }
        Ok(())
    }
}

impl Combination<'_> {
    fn add<'q>(self, sum: &mut [f64], u: &[f64], branch: impl Fn(usize) -> &'q [f64]) {
        for (i, weight) in self.weights.iter().enumerate() {
            sum.iter_mut().zip(branch(i)).for_each(|(s, q)| *s += weight * q);
        }
        sum.iter_mut().zip(u).for_each(|(s, u)| *s += self.own * u);
    }
}

/// Branch fields, or a part of them, in a sweep.
struct Interleaved<D> {
    cells: usize,
    branches: usize,
    data: D,
}

impl<D: Cells> Cells for Interleaved<D> {
    fn cells(&self) -> usize {
        self.cells
    }

    fn split(self, mid: usize) -> (Self, Self) {
        let (branches, rest) = (self.branches, self.cells - mid);
        let (first, second) = self.data.split(mid * branches);
        (
            Interleaved { cells: mid, branches, data: first },
            Interleaved { cells: rest, branches, data: second },
        )
    }
}
