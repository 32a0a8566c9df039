//! Leakage of a stored result: at the times of its fields, into the result.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::finding::{self, Finding, LeakDiagnostics, LeakState};
use asperity::leakage::Sides;
use asperity::surface::process::Border;
use serde_json::Value;
use thiserror::Error;

use super::{Beside, Fluid, Leak, LeakDirection, words};
use crate::answer::{Units, Validity};
use crate::case::Preparation;
use crate::instants;
use crate::preparation::border;
use crate::readable::quantity;
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
    /// What is computed beside the leaks failed.
    #[error("the run without the pressure of the fluid, or the opening pressure: {source}")]
    Beside {
        /// What failed.
        source: asperity::Error,
    },
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// The leaks of a result over time.
#[derive(Clone, Debug)]
pub struct LeakHistory {
    /// What was asked for.
    pub leak: Leak,
    /// The numbers.
    pub table: LeakTable,
    /// The findings about them.
    pub findings: Vec<Finding>,
    /// Those about the contact that concern its leaks too.
    pub of_contact: Vec<Finding>,
    /// Sides of the domain along x and y \[m\].
    pub size: [f64; 2],
}

impl LeakHistory {
    /// The leaks that a result holds; `None` where it holds none.
    ///
    /// # Errors
    /// [`StoreError`] where the result is damaged.
    pub fn of(reader: &Reader) -> Result<Option<LeakHistory>, StoreError> {
        let (Some(table), Some(leak)) = (LeakTable::of(reader)?, settings(reader)) else { return Ok(None) };
        let findings = reader.findings().iter().filter(|finding| LeakTable::is_judged_by(&finding.code));
        let (findings, size) = (findings.cloned().collect(), reader.header().grid.size());
        Ok(Some(LeakHistory { leak, table, findings, of_contact: of_contact(reader), size }))
    }

    /// All findings that concern the leaks.
    pub fn all_findings(&self) -> impl Iterator<Item = &Finding> + Clone {
        self.findings.iter().chain(&self.of_contact)
    }

    /// The numbers of a column; empty if there is none of that name.
    pub fn column(&self, name: &str) -> &[f64] {
        self.table.get(name).unwrap_or_default()
    }

    /// The last number of a column; NaN if there is none.
    pub fn last(&self, name: &str) -> f64 {
        self.column(name).last().copied().unwrap_or(f64::NAN)
    }

    /// The last leak and when the seal is tight, in a sentence without its full stop, with what the findings say of it.
    pub fn sentence(&self, units: &Units) -> String {
        let [last, tight] = ["leak_rate", "tight_from"].map(|name| self.validity(name));
        (if last.is_valid() { tight } else { last }).mark(self.unmarked(units))
    }

    /// What the findings say of an answer about the last leak.
    pub fn validity(&self, name: &str) -> Validity {
        match name {
            "tight_from" => Validity::of(name, self.all_findings()),
            _ => Validity::at_row(name, self.last("leak_step") as usize, self.all_findings()),
        }
    }

    /// What the findings say of the leak at each of its times.
    pub fn of_each_time(&self) -> Vec<Validity> {
        let rows = self.column("leak_step").iter();
        rows.map(|row| Validity::at_row("leak_rate", *row as usize, self.all_findings())).collect()
    }

    fn unmarked(&self, units: &Units) -> String {
        if self.last("percolates") == 0.0 {
            let tight = self.tight(units);
            return format!("{tight} ({})", self.leak.fluid_words());
        }
        let name = match self.leak.fluid {
            Some(_) if self.table.get("leak_rate_standard").is_some() => "leak_rate_standard",
            Some(_) => "leak_rate",
            None => "hydraulic_gap",
        };
        let unit = self.table.series().into_iter().find(|series| series.name == name).map_or("", |s| s.units);
        let at = units.moment(self.table.axis.at(self.last("leak_time")));
        let tight = self.tight(units);
        let tight = if tight.is_empty() { tight } else { format!("; {tight}") };
        format!("{} at {at} ({}){tight}", units.number(self.last(name), unit), self.note(units))
    }

    /// When the seal is tight, in a sentence without its full stop; empty if it leaks at all times.
    pub fn tight(&self, units: &Units) -> String {
        let moments: Vec<_> =
            self.column("leak_time").iter().map(|value| self.table.axis.at(*value)).collect();
        words::tight(&moments, self.column("percolates"), units)
    }

    /// What must be known beside the last leak: the fluid, and of which patch it is.
    pub fn note(&self, units: &Units) -> String {
        let patch = self.patch(units).map_or(String::new(), |words| format!("; {words}"));
        format!("{}{patch}", self.leak.fluid_words())
    }

    /// That the leak is one of the patch that was computed, and, where the seal goes on beyond its sides, the last leak Q over the width w
    /// of the patch across the flow \[m³/s per m; gas kg/s per m\]: "of a patch 400 µm wide and 200 µm along the flow; per m of such a seal
    /// 2.5e-9 m³/s". Without a fluid, or where it is tight, there is nothing to say.
    pub fn patch(&self, units: &Units) -> Option<String> {
        let rate = self.last("leak_rate");
        if !rate.is_finite() || rate == 0.0 {
            return None;
        }
        let [x, y] = self.size;
        let [along, across] = if self.leak.direction == LeakDirection::Y { [y, x] } else { [x, y] };
        let patch =
            format!("of a patch {} wide and {} along the flow", quantity(across, "m"), quantity(along, "m"));
        if self.leak.sides == Sides::Closed {
            return Some(patch);
        }
        let standard = self.table.get("leak_rate_standard").map(|_| self.last("leak_rate_standard") / across);
        Some(format!("{patch}; per m of such a seal {}", units.rate(rate / across, standard)))
    }
}

/// The settings of the stored leakage, or else those of the case of the result; `None` without both.
pub fn settings(reader: &Reader) -> Option<Leak> {
    let last = reader.leaks().map(|leaks| leaks.settings.clone());
    let of_case = || reader.header().setup.get("leakage").cloned();
    serde_json::from_value(last.or_else(of_case)?).ok()
}

/// Computes the leakage at the times asked for and stores it in the result at `path`, in place of an earlier one. `observe`
/// gets the number of times done and of all times.
///
/// # Errors
/// [`LeakError`]; the result is then as it was.
pub fn store(
    path: &Path,
    leak: &Leak,
    beside: Beside,
    interrupt: &AtomicBool,
    mut observe: impl FnMut(usize, usize),
) -> Result<LeakHistory, LeakError> {
    let reader = Reader::open(path)?;
    let writer = LeakWriter::new(path, leak.field)?;
    let history = evaluate(&reader, leak, beside, interrupt, &mut observe, Some(&writer))?;
    let settings = serde_json::to_value(leak).unwrap_or_default();
    writer.finish(&history.table, settings, &history.findings)?;
    Ok(history)
}

/// The same for a result that is only read: nothing is stored.
///
/// # Errors
/// [`LeakError`].
pub fn compute(
    reader: &Reader,
    leak: &Leak,
    interrupt: &AtomicBool,
    mut observe: impl FnMut(usize, usize),
) -> Result<LeakHistory, LeakError> {
    evaluate(reader, leak, Beside::default(), interrupt, &mut observe, None)
}

/// What is found of a leak whose `setup` says that surfaces of its contact were windowed.
pub fn through_windows(setup: &serde_json::Map<String, Value>) -> Option<Finding> {
    let prepared: Vec<Preparation> = serde_json::from_value(setup.get("preparation")?.clone()).ok()?;
    let windowed = prepared.into_iter().filter(|one| border(&one.steps) == Border::Windowed);
    finding::window_in_leak(&windowed.map(|one| one.surface).collect::<Vec<_>>())
}

fn evaluate(
    reader: &Reader,
    leak: &Leak,
    beside: Beside,
    interrupt: &AtomicBool,
    observe: &mut dyn FnMut(usize, usize),
    writer: Option<&LeakWriter>,
) -> Result<LeakHistory, LeakError> {
    if !reader.header().fields.contains(&FieldKind::Gap) {
        return Err(reader.no_field(FieldKind::Gap).into());
    }
    if reader.header().grid.is_line() {
        return Err(reader.on_line("gap over a plane, which leakage needs").into());
    }
    let instants = instants::stored(reader, leak.times.as_deref())?;
    let grid = reader.header().grid;
    let (rows, times) = (reader.rows()?, reader.series("time")?);
    let tolerance = reader.header().setup.get("solver_tolerance").and_then(Value::as_f64).unwrap_or(1e-6);
    let initial = reader.initial_gap()?;
    // Without the bodies those of the earlier leakage are kept.
    let mut beside = if beside.is_none() { Beside::of_result(reader)? } else { beside };
    let windows = through_windows(&reader.header().setup);
    let mut diagnostics = LeakDiagnostics::default();
    let mut table = LeakTable::new(reader.header().axis());
    for (done, index) in instants.iter().copied().enumerate() {
        if interrupt.load(Ordering::Relaxed) {
            return Err(LeakError::Interrupted);
        }
        let (at, time) = (At::Index(index), reader.field_times()[index]);
        let gap = reader.field(FieldKind::Gap, at)?;
        let contact = reader.contact_states(at)?;
        let solved = leak.of_gap(&grid, gap.view(), Some(contact.view()), time);
        let mut state = solved.map_err(|source| LeakError::Solve { source, time })?;
        let step = reader.field_steps()[index];
        let row = rows[step];
        if leak.one_way {
            state.leak_rate_one_way = beside.leak_rate_one_way(&times, step);
        }
        if leak.opening {
            state.opening_pressure =
                beside.opening_pressure(reader, index, [row.approach, row.load], interrupt)?;
        }
        // The mean displacement in the contact, to which the tolerance is relative: what the gap has gained, and the approach.
        let touching = gap.iter().zip(&initial).zip(&contact).filter(|(_, contact)| **contact > 0);
        let (sum, count) =
            touching.fold((0.0, 0.0), |(sum, count), ((h, h0), _)| (sum + (h - h0), count + 1.0));
        let displacement = if count > 0.0 { sum / count + row.approach } else { 0.0 };
        let sound = diagnostics.see(&LeakState {
            row: Some(step),
            gap_error: tolerance * displacement.abs(),
            // A fluid that acts on the surfaces has opened the gap already.
            pressure_drop: leak.fluid.as_ref().filter(|_| leak.coupling.is_none()).map(Fluid::pressure_drop),
            mean_pressure: row.mean_pressure,
            ..state.alone()
        });
        let resolved = sound && windows.is_none();
        if let Some(writer) = writer.filter(|_| leak.field) {
            writer.put_pressure(done, state.pressure.view())?;
        }
        table.push(time, step, &state, resolved);
        observe(done + 1, instants.len());
    }
    let mut findings = diagnostics.findings();
    findings.extend(windows);
    // The findings of a case with [leakage] have it already.
    let moving = finding::leak_in_motion();
    if reader.header().moves() && reader.findings().iter().all(|found| found.code != moving.code) {
        findings.push(moving);
    }
    Ok(LeakHistory { leak: leak.clone(), table, findings, of_contact: of_contact(reader), size: grid.size() })
}

/// The findings of a result about its contact that concern its leaks.
fn of_contact(reader: &Reader) -> Vec<Finding> {
    let concerns = |finding: &&Finding| {
        !LeakTable::is_judged_by(&finding.code)
            && Validity::of("leak_rate", std::iter::once(*finding)) != Validity::Holds
    };
    reader.findings().iter().filter(concerns).cloned().collect()
}
