//! Leakage of a stored result: at the times of its fields, into the result.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::finding::{Finding, LeakJudge, LeakState};
use serde_json::Value;
use thiserror::Error;

use super::Leak;
use crate::store::{At, FieldKind, LeakTable, LeakWriter, Reader, StoreError};

/// Why the leakage of a result was not computed.
#[derive(Debug, Error)]
pub enum LeakError {
    /// The result cannot be read or written, or lacks the gap.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The flow at a time was not solved.
    #[error("the leakage at t = {time} s: {source}")]
    Solve {
        /// What failed.
        source: asperity::Error,
        /// Time of the fields \[s\].
        time: f64,
    },
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// The leakage that the case of a result asks for, or that was asked for last; `None` where neither.
pub fn settings(reader: &Reader) -> Option<Leak> {
    let last = reader.leaks().map(|leaks| leaks.settings.clone());
    let of_case = || reader.header().setup.get("leakage").cloned();
    serde_json::from_value(last.or_else(of_case)?).ok()
}

/// Computes the leakage at the times of the stored fields and stores it in the result at `path`, in place of an earlier one.
/// Returns what was found against the leaks, and the table. `observe` hears of each time.
///
/// # Errors
/// [`LeakError`]; the result is then as it was.
pub fn of_result(
    path: &Path,
    leak: &Leak,
    interrupt: &AtomicBool,
    mut observe: impl FnMut(usize, usize),
) -> Result<(LeakTable, Vec<Finding>), LeakError> {
    let reader = Reader::open(path)?;
    if !reader.header().fields.contains(&FieldKind::Gap) {
        return Err(reader.no_field(FieldKind::Gap).into());
    }
    if reader.header().grid.is_line() {
        return Err(reader.on_line("gap over a plane, which leakage needs").into());
    }
    let times = reader.field_times().to_vec();
    if times.is_empty() {
        return Err(reader.no_rows().into());
    }
    let grid = reader.header().grid;
    let rows = reader.rows()?;
    let tolerance = reader.header().setup.get("solver_tolerance").and_then(Value::as_f64).unwrap_or(1e-6);
    let initial = reader.initial_gap()?;
    let writer = LeakWriter::new(path, &grid, leak.field)?;
    let mut judge = LeakJudge::default();
    let mut table = LeakTable::new(
        leak.fluid.as_ref().map(super::Fluid::is_gas),
        leak.direction == super::LeakDirection::Both,
    );
    for (index, time) in times.iter().copied().enumerate() {
        if interrupt.load(Ordering::Relaxed) {
            return Err(LeakError::Interrupted);
        }
        let at = At::Index(index);
        let gap = reader.field(FieldKind::Gap, at)?;
        let contact = reader.contact_states(at)?;
        let solved = leak.of_gap(&grid, gap.view(), Some(contact.view()), time);
        let state = solved.map_err(|source| LeakError::Solve { source, time })?;
        let step = reader.field_steps()[index];
        let row = rows[step];
        // The mean displacement in the contact, to which the tolerance is relative: what the gap has gained, and the approach.
        let touching = gap.iter().zip(&initial).zip(&contact).filter(|(_, contact)| **contact > 0);
        let (sum, count) =
            touching.fold((0.0, 0.0), |(sum, count), ((h, h0), _)| (sum + (h - h0), count + 1.0));
        let displacement = if count > 0.0 { sum / count + row.approach } else { 0.0 };
        let resolved = judge.see(&LeakState {
            row: step,
            constriction: state.percolates.then_some((state.critical_gap, state.critical_width)),
            gap_error: tolerance * displacement.abs(),
            pressure_drop: leak.fluid.as_ref().map(super::Fluid::pressure_drop),
            contact_pressure: if row.contact_area > 0.0 { row.load / row.contact_area } else { 0.0 },
        });
        if leak.field {
            writer.put_pressure(index, state.pressure.view())?;
        }
        table.push(time, step, &state, resolved);
        observe(index + 1, times.len());
    }
    let findings = judge.findings();
    let settings = serde_json::to_value(leak).unwrap_or_default();
    writer.finish(&table, settings, &findings)?;
    Ok((table, findings))
}
