//! What a run computes beside the leaks of its stored gaps, because it has the bodies: the pressure that opens the contact, and the leak
//! that it would have if the fluid did not act on the surfaces. A later leakage of the same flow takes them over.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::traction::OpeningPressure;
use asperity::{Error, Result, Simulation, drive};
use ndarray::Array2;

use super::Leak;
use super::result::LeakError;
use crate::store::{At, FieldKind, LeakTable, Reader, StoreError};

/// Times that differ by less than this share are equal.
const SAME: f64 = 1e-9;

/// What is computed beside the leaks; nothing by default.
#[derive(Default)]
pub struct Beside {
    opening: Option<OpeningPressure>,
    /// The leaks of the rows that have stored fields, where the fluid does not act.
    one_way: Option<Vec<Rate>>,
    /// An earlier leakage of the same rows, which has these numbers.
    earlier: Option<LeakTable>,
}

/// The leak rate of a row, which its time and its number among the rows of that time tell: two rows have the time of a jump.
struct Rate {
    time: f64,
    number: usize,
    rate: f64,
}

impl Beside {
    /// Of the run of a simulation, whose result is complete.
    ///
    /// # Errors
    /// [`LeakError`]: the run without the pressure of the fluid failed, or was interrupted.
    pub fn of(
        leak: &Leak,
        simulation: impl FnOnce() -> Result<Simulation>,
        reader: &Reader,
        interrupt: &Arc<AtomicBool>,
    ) -> Result<Self, LeakError> {
        if !(leak.opening || leak.one_way) {
            return Ok(Beside::default());
        }
        let simulation = simulation().map_err(failed)?;
        // The run first: it gives its memory back.
        let one_way = match leak.one_way {
            true => Some(one_way(leak, simulation.clone(), reader, interrupt)?),
            false => None,
        };
        let opening = leak.opening.then(|| OpeningPressure::new(leak.opening_traction()?, &simulation));
        let opening = opening.transpose().map_err(failed)?;
        Ok(Beside { opening, one_way, earlier: None })
    }

    /// Whether there is nothing.
    pub(super) fn is_none(&self) -> bool {
        self.opening.is_none() && self.one_way.is_none() && self.earlier.is_none()
    }

    /// Of a result whose leakage has been computed with its run.
    ///
    /// # Errors
    /// [`StoreError`] where it is damaged.
    pub fn of_result(reader: &Reader) -> Result<Self, StoreError> {
        Ok(Beside { earlier: LeakTable::of(reader)?, ..Beside::default() })
    }

    /// The number of a row in the earlier leakage.
    fn of_earlier(&self, name: &str, time: f64, row: usize) -> Option<f64> {
        let table = self.earlier.as_ref()?;
        let [numbers, times, rows] = [name, "leak_time", "leak_step"].map(|name| table.get(name));
        let (numbers, times, rows) = (numbers?, times?, rows?);
        let at = |n: &usize| same(times[*n], time);
        let n = (0..times.len()).find(|n| at(n) && rows[*n] == row as f64);
        n.or_else(|| (0..times.len()).find(at)).map(|n| numbers[n])
    }

    /// The pressure that opens the contact at a stored instant.
    pub(super) fn opening_pressure(
        &mut self,
        reader: &Reader,
        index: usize,
        [approach, load]: [f64; 2],
        interrupt: &AtomicBool,
    ) -> Result<Option<f64>, LeakError> {
        let (at, time, row) = (At::Index(index), reader.field_times()[index], reader.field_steps()[index]);
        let earlier = self.of_earlier("opening_pressure", time, row);
        let Some(opening) = &mut self.opening else { return Ok(earlier) };
        let (gap, traction) = (reader.field(FieldKind::Gap, at)?, reader.field(FieldKind::Pressure, at)?);
        match opening.of(gap.view(), traction.view(), approach, load, Some(interrupt)) {
            Ok(pressure) => Ok(Some(pressure)),
            Err(Error::Interrupted) => Err(LeakError::Interrupted),
            Err(source) => Err(LeakError::Solve { source, time }),
        }
    }

    /// The leak without the pressure of the fluid at a row; NaN where that run has no such row.
    pub(super) fn leak_rate_one_way(&self, times: &[f64], row: usize) -> Option<f64> {
        let (time, number) = (times[row], number_among(times, row));
        let is_same = |of: &&Rate| same(of.time, time) && of.number == number;
        let earlier = self.of_earlier("leak_rate_one_way", time, row);
        let own = self.one_way.as_ref();
        own.map(|rates| rates.iter().find(is_same).map_or(f64::NAN, |of| of.rate)).or(earlier)
    }
}

fn failed(source: Error) -> LeakError {
    match source {
        Error::Interrupted => LeakError::Interrupted,
        source => LeakError::Beside { source },
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// How many rows of its time are before a row.
fn number_among(times: &[f64], row: usize) -> usize {
    times[..row].iter().rev().take_while(|time| same(**time, times[row])).count()
}

/// The leak rates of the run whose fluid does not act on the surfaces, at the times of the stored fields.
fn one_way(
    leak: &Leak,
    simulation: Simulation,
    reader: &Reader,
    interrupt: &Arc<AtomicBool>,
) -> Result<Vec<Rate>, LeakError> {
    let stored = reader.field_times().to_vec();
    let mut dry = Simulation { traction: None, include: stored.clone(), ..simulation };
    dry.quantities.list.clear();
    let grid = dry.grid;
    let mut drive = drive::of(dry, None).map_err(failed)?;
    drive.interrupt_with(interrupt.clone());
    let (mut gap, mut contact) = (Array2::zeros(grid.shape()), Array2::zeros(grid.shape()));
    let (mut times, mut rates) = (vec![], vec![]);
    while let Some(step) = drive.advance().map_err(failed)? {
        let time = step.row().time();
        times.push(time);
        if !stored.iter().any(|at| same(*at, time)) {
            continue;
        }
        if interrupt.load(Ordering::Relaxed) {
            return Err(LeakError::Interrupted);
        }
        step.gap_into(&mut gap);
        step.contact_into(&mut contact);
        let solved = leak.of_gap(&grid, gap.view(), Some(contact.view()), time);
        let state = solved.map_err(|source| LeakError::Solve { source, time })?;
        let number = number_among(&times, times.len() - 1);
        rates.push(Rate { time, number, rate: state.leak_rate.unwrap_or(f64::NAN) });
    }
    Ok(rates)
}
