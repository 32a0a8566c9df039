//! The largest stresses of one depth.

use rayon::prelude::*;

use super::{Invariants, Rolling, SurveyOptions, invariants};
use crate::grid::Grid;
use asperity_sweep::{Merge, sweep};

/// The first largest value of a field.
#[derive(Clone, Copy)]
pub(super) struct First {
    pub(super) value: f64,
    pub(super) cell: usize,
}

const NOTHING: First = First { value: f64::NEG_INFINITY, cell: 0 };

impl First {
    fn or(self, next: Self) -> Self {
        if next.value > self.value { next } else { self }
    }
}

/// The stresses whose maxima are found: von Mises, Tresca, the largest principal stress, and the range of the orthogonal shear
/// stress.
pub(super) const MISES: usize = 0;
pub(super) const TRESCA: usize = 1;
pub(super) const TENSION: usize = 2;
pub(super) const SHEAR: usize = 3;

/// Maxima of one depth, and the cells above a threshold.
#[derive(Clone, Copy)]
pub(super) struct Slab {
    pub(super) maxima: [First; 4],
    /// Number of cells above the threshold.
    pub(super) above: f64,
    /// Number of cells processed: the cells of the next part begin there.
    cells: usize,
}

impl Merge for Slab {
    fn merge(self, next: Self) -> Self {
        let later = |first: First| First { cell: self.cells + first.cell, ..first };
        Slab {
            maxima: std::array::from_fn(|k| self.maxima[k].or(later(next.maxima[k]))),
            above: self.above + next.above,
            cells: self.cells + next.cells,
        }
    }
}

/// Six slices of one length.
type Six<'a> = (&'a [f64], &'a [f64], &'a [f64], &'a [f64], &'a [f64], &'a [f64]);

impl Slab {
    pub(super) fn of(grid: &Grid, fields: &[Vec<f64>; 6], options: &SurveyOptions) -> Slab {
        let [xx, yy, zz, xy, xz, yz] = fields.each_ref().map(Vec::as_slice);
        let threshold = options.threshold.unwrap_or(f64::INFINITY);
        let mut found = sweep((xx, yy, zz, xy, xz, yz), &|(xx, yy, zz, xy, xz, yz): Six<'_>| {
            let mut found = Slab { maxima: [NOTHING; 4], above: 0.0, cells: xx.len() };
            for cell in 0..xx.len() {
                let tensor = [xx[cell], yy[cell], zz[cell], xy[cell], xz[cell], yz[cell]];
                let Invariants { mises, tresca, tension, .. } = invariants(tensor);
                for (most, value) in found.maxima.iter_mut().zip([mises, tresca, tension]) {
                    *most = most.or(First { value, cell });
                }
                found.above += f64::from(u8::from(mises > threshold));
            }
            found
        });
        found.maxima[SHEAR] = match options.rolling {
            Some(Rolling::X) => range_along_x(xz, grid.cells()[1]),
            Some(Rolling::Y) => range_along_y(yz, grid.cells()[1]),
            None => NOTHING,
        };
        found
    }
}

/// Largest minus smallest value of each line along y; returns the first largest, with the cell at which the line begins.
fn range_along_y(field: &[f64], ny: usize) -> First {
    let ranges: Vec<f64> = field
        .par_chunks(ny)
        .map(|line| {
            let [low, high] =
                line.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
            high - low
        })
        .collect();
    first(&ranges, |line| line * ny)
}

/// The same for the lines along x.
fn range_along_x(field: &[f64], ny: usize) -> First {
    let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; ny];
    for row in field.chunks(ny) {
        ends.iter_mut().zip(row).for_each(|([low, high], v)| (*low, *high) = (low.min(*v), high.max(*v)));
    }
    let ranges: Vec<f64> = ends.iter().map(|[low, high]| high - low).collect();
    first(&ranges, |line| line)
}

fn first(ranges: &[f64], cell: impl Fn(usize) -> usize) -> First {
    let firsts = ranges.iter().enumerate().map(|(line, value)| First { value: *value, cell: cell(line) });
    firsts.fold(NOTHING, First::or)
}
