//! The stored pressures of a result, as the stress needs them: one by one, or from the beginning on where Poisson's ratio changes
//! with time.

use asperity::stress::{PressureHistory, SubsurfaceStress};

use super::Ratio;
use super::evaluate::StressError;
use crate::store::{At, FieldKind, Reader};

const GAPS: &str = "Poisson's ratio of the body changes with time (constant bulk modulus), so that the stress needs the pressures \
                    of all rows, but not all are stored; run the case again with output.every = 1, or give --poisson NU for an \
                    estimate with a constant one";
const MOVES: &str = "the stress of a contact that moves over a body whose Poisson's ratio changes with time (constant bulk \
                     modulus) is not computed";

/// Reads the pressures of a result.
pub(crate) struct Pressures<'a> {
    reader: &'a Reader,
    /// The pressures so far, and the number of the next stored instant.
    history: Option<(PressureHistory, usize)>,
}

impl<'a> Pressures<'a> {
    /// For a body of this Poisson's ratio.
    ///
    /// # Errors
    /// [`StressError`] where the ratio changes, and not every row is stored or the contact moves.
    pub(crate) fn new(reader: &'a Reader, ratio: &Ratio) -> Result<Self, StressError> {
        let Ratio::Changing(creep) = ratio else { return Ok(Pressures { reader, history: None }) };
        let refused = |why| Err(StressError::Refused { path: reader.path().to_owned(), why });
        if reader.header().setup.contains_key("motion") {
            return refused(MOVES);
        }
        let (steps, times, rows) = (reader.field_steps(), reader.field_times(), reader.series("time")?);
        let whole = steps.iter().enumerate().all(|(n, step)| *step == n && rows.get(n) == times.get(n));
        if !whole {
            return refused(GAPS);
        }
        let history = PressureHistory::new(creep.clone(), reader.header().grid.len());
        Ok(Pressures { reader, history: Some((history, 0)) })
    }

    /// Gives the pressure of a stored instant to the transforms; where the ratio changes, no earlier instant than the last time.
    ///
    /// # Errors
    /// [`StressError`] where a pressure is not stored or damaged.
    pub(crate) fn give(&mut self, index: usize, stress: &mut SubsurfaceStress) -> Result<(), StressError> {
        let read = |index| self.reader.field(FieldKind::Pressure, At::Index(index));
        let Some((history, next)) = &mut self.history else {
            stress.set_pressure(read(index)?.as_slice().unwrap_or_default())?;
            return Ok(());
        };
        while *next <= index {
            let pressure = read(*next)?;
            history.advance(self.reader.field_times()[*next], pressure.as_slice().unwrap_or_default())?;
            *next += 1;
        }
        Ok(stress.set_history(history)?)
    }
}
