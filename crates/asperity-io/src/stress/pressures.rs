//! The stored pressures of a result, as the stress needs them: one by one, or from the beginning on where Poisson's ratio changes
//! with time.

use asperity::load::Control;
use asperity::stress::{PressureHistory, SubsurfaceStress};

use super::evaluate::StressError;
use super::{Ratio, bodies_of};
use crate::store::{At, FieldKind, Reader};

const GAPS: &str = "Poisson's ratio of the body changes with time (constant bulk modulus), so that the stress needs the pressures \
                    of all rows, but not all are stored; run the case again with output.every = 1, or give --poisson NU for an \
                    estimate with a constant one";
const UNKNOWN: &str = "the result does not say what was prescribed in each stage, which the stress of a body whose Poisson's ratio changes with \
                       time (constant bulk modulus) needs; run the case again, or give --poisson NU for an estimate with a constant one";
const MOVES: &str = "the stress of a contact that moves over a body whose Poisson's ratio changes with time (constant bulk \
                     modulus) is not computed";

/// Reads the pressures of a result.
pub(crate) struct Pressures<'a> {
    reader: &'a Reader,
    history: Option<History>,
    /// 1 for the first body, -1 for the second.
    sign: f64,
}

/// The pressures so far.
struct History {
    pressures: PressureHistory,
    /// What is prescribed in the step to each row.
    controls: Vec<Control>,
    /// The number of the next stored instant.
    next: usize,
}

impl<'a> Pressures<'a> {
    /// For this body, of this Poisson's ratio.
    ///
    /// # Errors
    /// [`StressError`] where the ratio changes, and not every row is stored or the contact moves.
    pub(crate) fn new(reader: &'a Reader, body: &str, ratio: &Ratio) -> Result<Self, StressError> {
        let is_first = bodies_of(reader).first().is_none_or(|first| first.name == body);
        let sign = if is_first { 1.0 } else { -1.0 };
        let Ratio::Changing(changing) = ratio else { return Ok(Pressures { reader, history: None, sign }) };
        let refused = |why| Err(StressError::Refused { path: reader.path().to_owned(), why });
        if reader.header().setup.contains_key("motion") {
            return refused(MOVES);
        }
        let (steps, times, rows) = (reader.field_steps(), reader.field_times(), reader.series("time")?);
        let whole = steps.iter().enumerate().all(|(n, step)| *step == n && rows.get(n) == times.get(n));
        if !whole {
            return refused(GAPS);
        }
        let pressures = changing.history(reader.header().grid)?;
        Ok(Pressures {
            reader,
            history: Some(History { pressures, controls: controls(reader)?, next: 0 }),
            sign,
        })
    }

    /// Gives the pressure of a stored instant to the transforms; where the ratio changes, no earlier instant than the last time.
    ///
    /// # Errors
    /// [`StressError`] where a pressure is not stored or damaged.
    pub(crate) fn give(&mut self, index: usize, stress: &mut SubsurfaceStress) -> Result<(), StressError> {
        let read = |index| self.reader.field(FieldKind::Pressure, At::Index(index));
        let Some(History { pressures, controls, next }) = &mut self.history else {
            stress.set_pressure(read(index)?.as_slice().unwrap_or_default())?;
            return self.give_tractions(index, stress);
        };
        while *next <= index {
            let pressure = read(*next)?;
            let control = controls.get(*next).copied().unwrap_or(Control::Load);
            let time = self.reader.field_times()[*next];
            pressures.advance(time, control, pressure.as_slice().unwrap_or_default())?;
            *next += 1;
        }
        Ok(stress.set_history(pressures)?)
    }

    /// Adds the tangential tractions, where there are any. The first body is the one that they act on; on the other one their opposite does.
    fn give_tractions(&self, index: usize, stress: &mut SubsurfaceStress) -> Result<(), StressError> {
        if !self.reader.header().slips() {
            return Ok(());
        }
        let read = |kind| self.reader.field(kind, At::Index(index));
        let tractions = [read(FieldKind::TractionX)?, read(FieldKind::TractionY)?];
        let on_body = tractions.map(|traction| traction.mapv(|q| self.sign * q));
        Ok(stress
            .add_tractions(on_body.each_ref().map(|traction| traction.as_slice().unwrap_or_default()))?)
    }
}

/// What is prescribed in the step to each row of a result.
fn controls(reader: &Reader) -> Result<Vec<Control>, StressError> {
    let stages = reader.header().controls();
    let of_stage = |stage: &f64| stages.get(*stage as usize).copied();
    let controls: Option<Vec<Control>> = reader.series("stage")?.iter().map(of_stage).collect();
    controls.ok_or_else(|| StressError::Refused { path: reader.path().to_owned(), why: UNKNOWN })
}
