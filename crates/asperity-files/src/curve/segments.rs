//! The segments of a table: steps or sweeps below each other, each of which begins again at its first time or frequency, or has a
//! label of its own.

use std::collections::BTreeMap;

use super::columns::Values;
use super::error::{CurveError, Remedy, Result, fault};
use super::{Kind, Role};

/// Segments have more points: shorter ones are times out of order.
const LEAST: usize = 3;
/// So many are listed.
const LISTED: usize = 6;

/// The rows of each segment, in the order of the file.
pub(super) struct Segments(Vec<Vec<usize>>);

impl Segments {
    /// By their labels, or else where the times or frequencies begin again; none where they are only out of order.
    pub(super) fn of(kind: Kind, values: &Values) -> Segments {
        let sets = by_set(values);
        if sets.len() > 1 {
            return Segments(sets);
        }
        let x = values.get(&abscissa(kind)).map(Vec::as_slice).unwrap_or_default();
        let rises = x.windows(2).filter(|pair| pair[1] > pair[0]).count();
        let falls = x.windows(2).filter(|pair| pair[1] < pair[0]).count();
        let goes_on = |a: &usize, b: &usize| if rises >= falls { x[*b] >= x[*a] } else { x[*b] <= x[*a] };
        let rows: Vec<usize> = (0..x.len()).collect();
        let found: Vec<Vec<usize>> = rows.chunk_by(goes_on).map(<[usize]>::to_vec).collect();
        Segments(if found.len() * LEAST <= x.len() { found } else { vec![rows] })
    }

    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// "3 segments (lines 2 to 41, 42 to 81 and 82 to 121)".
    pub(super) fn listed(&self, lines: &[usize]) -> String {
        let ends = |rows: &Vec<usize>| {
            rows.first().zip(rows.last()).map(|(a, b)| format!("{} to {}", lines[*a], lines[*b]))
        };
        let shown: Vec<String> = self.0.iter().filter_map(ends).take(LISTED).collect();
        let more = if self.count() > shown.len() { ", ..." } else { "" };
        format!("{} segments (lines {}{more})", self.count(), shown.join(", "))
    }

    /// The error for a table of several, which begins with what is wrong.
    pub(super) fn several(&self, why: &str, lines: &[usize]) -> CurveError {
        fault(format!("{why}: the table holds {}, each a step or a sweep of its own", self.listed(lines)))
            .remedy(Remedy::Segment(self.count()))
    }

    /// The rows of the segment of this number, from 1, and a note on it.
    ///
    /// # Errors
    /// Where there is no such segment, or its times go on from those of the one before it.
    pub(super) fn choose(
        &self,
        number: usize,
        kind: Kind,
        values: &Values,
        lines: &[usize],
    ) -> Result<(Vec<usize>, String)> {
        let rows = number.checked_sub(1).and_then(|n| self.0.get(n)).ok_or_else(|| {
            let wrong = format!("segment {number} is asked for, but the table holds {}", self.listed(lines));
            fault(wrong).remedy(Remedy::Segment(self.count()))
        })?;
        let [first, last] = [rows[0], rows[rows.len() - 1]];
        let x = values.get(&abscissa(kind)).map(Vec::as_slice).unwrap_or_default();
        let before = number.checked_sub(2).and_then(|n| self.0.get(n)).and_then(|rows| rows.last());
        if let (Some(before), true) = (before, kind != Kind::Dma)
            && x[first] >= x[*before]
        {
            return Err(fault(format!(
                "the times of segment {number} go on from those of the segment before it, {:e} s: a step needs the time since its own beginning, in \
                 a column such as \"step time [s]\"",
                x[*before]
            ))
            .at(lines[first]));
        }
        let of = self.listed(lines);
        Ok((
            rows.clone(),
            format!("segment {number}, lines {} to {}, is read of {of}", lines[first], lines[last]),
        ))
    }
}

/// The rows of a table of several quantities that are chosen.
pub(super) fn chosen(values: &Values, rows: &[usize]) -> Values {
    let pick = |column: &Vec<f64>| rows.iter().map(|row| column[*row]).collect();
    values.iter().map(|(role, column)| (*role, pick(column))).collect::<BTreeMap<_, _>>()
}

fn abscissa(kind: Kind) -> Role {
    if kind == Kind::Dma { Role::Frequency } else { Role::Time }
}

/// The rows of each set, in the order of the file.
pub(super) fn by_set(values: &Values) -> Vec<Vec<usize>> {
    let Some(sets) = values.get(&Role::Set) else { return Vec::new() };
    let count = sets.iter().copied().fold(-1.0, f64::max) as usize;
    let mut rows = vec![Vec::new(); (count + 1).min(sets.len())];
    for (row, set) in sets.iter().enumerate() {
        if let Some(rows) = rows.get_mut(*set as usize) {
            rows.push(row);
        }
    }
    rows.retain(|rows| !rows.is_empty());
    rows
}
