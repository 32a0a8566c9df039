//! A run of steady states of motion: one row for each velocity.

use std::sync::atomic::Ordering;

use asperity::Error;
use asperity::sliding::{Steady, SteadyMotion};

use super::{Earlier, Known, Maps, Progress, Record, RunError, RunOptions, Summary, header};
use crate::case::Case;
use crate::store::{Outcome, Status, StoreError, Writer};
use asperity::Simulation;
use asperity::finding::Judge;
use asperity::march::Checkpoint;
use asperity::surface::Part;
use ndarray::Array2;

/// As [`super::run`], for steady states.
pub(super) fn run(
    case: &Case,
    parts: &[Part],
    simulation: Simulation,
    motion: SteadyMotion,
    options: &RunOptions,
    observe: &mut (dyn FnMut(Progress) + Send),
) -> Result<Summary, RunError> {
    let known = Known { parts, bodies: &case.bodies, thickness: case.thickness };
    let judge = Judge::new(&simulation, known);
    let total = motion.velocities.len();
    let header = crate::store::Header { rows_expected: Some(total), ..header(case, &simulation) };
    let path = options.output.clone().unwrap_or_else(|| case.output.path.clone());
    let (writer, checkpoint, earlier) = if options.resume {
        let earlier = super::earlier(&path).map_err(RunError::Output)?;
        let (writer, checkpoint) = match Writer::resume(&path, &header, simulation.gap.view()) {
            Err(complete @ StoreError::Complete { .. }) => {
                return super::ended(case, &complete, &path, options);
            }
            resumed => resumed.map_err(RunError::Output)?,
        };
        (writer, checkpoint, earlier)
    } else {
        let writer = Writer::create(&path, &header, simulation.gap.view(), options.force);
        (writer.map_err(RunError::Output)?, None, Earlier::default())
    };
    let mut record = Record { case, writer, judge, path: &path, last: None, friction: None, stress: None };
    let last_velocity = motion.velocities.last().copied().unwrap_or_default();
    let steady = Steady::new(simulation, motion).and_then(|mut steady| {
        if let Some(checkpoint) = &checkpoint {
            let pressure =
                checkpoint.fields.first().map(|(_, field)| field.iter().copied().collect::<Vec<f64>>());
            steady.resume(checkpoint.step, &pressure.unwrap_or_default())?;
        }
        Ok(steady)
    });
    let mut steady = match steady {
        Ok(steady) => steady,
        Err(source) => return Err(record.fail(None, None, source)),
    };
    record.judge = record.judge.of_sweep(steady.streaming().clone());
    if let Some(checkpoint) = &checkpoint {
        record.judge.resume(earlier.rows.get(..checkpoint.step).unwrap_or_default(), &earlier.findings);
    }
    steady.interrupt_with(options.interrupt.clone());
    let resumed = steady.done();
    let mut maps = Maps::new(case, steady.simulation().grid.shape());
    loop {
        let finished = steady.done() + 1 == total;
        let stored = match steady.advance() {
            Ok(None) => break,
            Ok(Some(step)) => {
                let row = step.row();
                let keeps = case.output.rows.holds(step.index(), finished, row.time);
                let fields = if keeps { maps.of(&step) } else { vec![] };
                record.judge.see(&step, &row);
                record.last = Some(row);
                record.friction = step.friction();
                record.writer.append_with(&row, step.quantities(), &fields).map(|()| row)
            }
            Err(Error::Interrupted) => {
                return record.end(Some(steady.simulation()), Outcome::new(Status::Interrupted));
            }
            Err(source) => {
                let best = steady.last().map(|step| Box::new(step.row()));
                return Err(record.fail(Some(steady.simulation()), best, source));
            }
        };
        let row = match stored {
            Ok(row) => row,
            Err(source) => return Err(record.stop_storing(Some(steady.simulation()), source)),
        };
        observe(Progress {
            row: &row,
            friction: record.friction,
            sweep: true,
            done: steady.done(),
            resumed,
            total: Some(total),
            end: last_velocity,
            finished,
            stress: None,
        });
        // Between two velocities an interruption loses nothing.
        let stops = options.interrupt.load(Ordering::Relaxed) && !finished;
        let due = case.output.checkpoint && !finished && (stops || record.writer.checkpoint_due());
        if due {
            let found = record.findings(Some(steady.simulation()));
            let kept =
                record.writer.note(found).and_then(|()| record.writer.checkpoint(&checkpoint_of(&steady)));
            if let Err(source) = kept {
                return Err(record.stop_storing(Some(steady.simulation()), source));
            }
        }
        if stops {
            return record.end(Some(steady.simulation()), Outcome::new(Status::Interrupted));
        }
    }
    record.end(Some(steady.simulation()), Outcome::new(Status::Complete))
}

/// The velocities done, and the pressure that the next one starts from.
fn checkpoint_of(steady: &Steady) -> Checkpoint<'static> {
    let shape = steady.simulation().grid.shape();
    let pressure = steady.last().map_or_else(|| Array2::zeros(shape), |step| step.pressure().to_owned());
    Checkpoint { step: steady.done(), scalars: vec![], fields: vec![("pressure".into(), pressure.into())] }
}
