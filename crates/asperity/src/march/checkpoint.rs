//! What a march can be resumed from, with the same bits.

use ndarray::{Array2, CowArray, Ix2};

use super::motion::Moving;
use super::{March, Past, Reached, Simulation, Timeline, record};
use crate::error::{Error, Result};

/// Everything that the rest of a march depends on; see [`March::checkpoint`].
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint<'a> {
    /// Rows done.
    pub step: usize,
    /// Numbers that belong to the memory.
    pub scalars: Vec<f64>,
    /// Named fields of nx x ny cells; those of the march itself are lent.
    pub fields: Vec<(String, CowArray<'a, f64, Ix2>)>,
}

impl Checkpoint<'_> {
    /// With fields of its own, to be kept while the march goes on.
    pub fn into_owned(self) -> Checkpoint<'static> {
        let fields = self.fields.into_iter().map(|(name, field)| (name, field.into_owned().into()));
        Checkpoint { step: self.step, scalars: self.scalars, fields: fields.collect() }
    }
}

impl March {
    /// Everything that the rest of the march depends on. A march resumed from it gives the same bits.
    pub fn checkpoint(&self) -> Checkpoint<'_> {
        let shape = self.simulation.grid.shape();
        let field = |name: &str, cells| (name.to_string(), CowArray::from(record::to_view(shape, cells)));
        let mut fields = vec![
            field("pressure", &self.state.pressure),
            field("unit_displacement", &self.state.unit_displacement),
            field("previous_pressure", &self.previous.pressure),
            field("previous_unit_displacement", &self.previous.unit_displacement),
        ];
        if let Some(dents) = &self.dents {
            fields.push(field("dented_gap", dents.gap()));
        }
        let (memory_scalars, memory) = match &self.past {
            Past::Memory(m) => m.save(),
            Past::Waves(w) => w.save(),
            Past::Constant(c) => c.save(),
            Past::Direct(d) => d.save(),
        };
        let mut scalars = self.timeline.save();
        scalars.extend([self.reached.approach, self.reached.load]);
        scalars.extend([self.state.approach, self.previous.approach]);
        scalars.extend([self.state.rounding, self.previous.rounding]);
        scalars.extend(self.moving.as_ref().map(|_| self.friction.force));
        scalars.extend(memory_scalars);
        scalars.extend(self.meter.save());
        fields.extend(memory.into_iter().enumerate().map(|(k, cells)| {
            let cells = Array2::from_shape_vec(shape, cells).expect("as many as cells");
            (format!("memory_{k}"), cells.into())
        }));
        Checkpoint { step: self.done, scalars, fields }
    }

    /// Goes on where a checkpoint of the same simulation was taken.
    ///
    /// # Errors
    /// As [`March::new`]; [`Error::Invalid`] where the checkpoint belongs to another simulation.
    pub fn resume(simulation: Simulation, checkpoint: &Checkpoint) -> Result<Self> {
        let mut march = March::new(simulation)?;
        let foreign = |what: String| Error::invalid("checkpoint", what, "one of this simulation");
        let Some((timeline, rest)) = checkpoint.scalars.split_at_checked(Timeline::SAVED) else {
            return Err(foreign(format!("{} numbers", checkpoint.scalars.len())));
        };
        let Some(([approach, load, approaches @ .., rounding, rounding_before], scalars)) =
            rest.split_first_chunk::<6>()
        else {
            return Err(foreign(format!("{} numbers", checkpoint.scalars.len())));
        };
        if !march.timeline.load(&march.simulation, timeline) {
            return Err(foreign("of another programme".into()));
        }
        march.reached = Reached { approach: *approach, load: *load };
        if let Some(last) = march.timeline.last() {
            march.move_gap(last.time)?;
            march.moving.iter_mut().for_each(Moving::settle);
        }
        (march.state.rounding, march.previous.rounding) = (*rounding, *rounding_before);
        (march.state.approach, march.previous.approach) = (approaches[0], approaches[1]);
        let scalars = match (&mut march.moving, scalars.split_first()) {
            (None, _) => scalars,
            (Some(_), Some((force, scalars))) => {
                march.friction.force = *force;
                scalars
            }
            (Some(_), None) => return Err(foreign("one without motion".into())),
        };
        let mut fields = checkpoint.fields.iter();
        let mut next = |name: &str| -> Result<Vec<f64>> {
            match fields.next() {
                Some((found, cells)) if found == name && cells.dim() == march.simulation.grid.shape() => {
                    Ok(cells.iter().copied().collect())
                }
                Some((found, cells)) => Err(foreign(format!("field {found} of shape {:?}", cells.dim()))),
                None => Err(foreign(format!("without field {name}"))),
            }
        };
        march.state.pressure = next("pressure")?;
        march.state.unit_displacement = next("unit_displacement")?;
        march.previous.pressure = next("previous_pressure")?;
        march.previous.unit_displacement = next("previous_unit_displacement")?;
        let mut others = 4;
        if let Some(dents) = &mut march.dents {
            dents.restore(next("dented_gap")?);
            others += 1;
        }
        let memory = (0..checkpoint.fields.len().saturating_sub(others))
            .map(|k| next(&format!("memory_{k}")))
            .collect::<Result<Vec<_>>>()?;
        let Some((scalars, energies)) =
            scalars.len().checked_sub(march.meter.saved()).and_then(|n| scalars.split_at_checked(n))
        else {
            return Err(foreign("one without the energies asked for".into()));
        };
        let restored = match &mut march.past {
            Past::Memory(m) => m.restore(scalars, &memory),
            Past::Waves(w) => w.restore(scalars, &memory),
            Past::Constant(c) => c.restore(scalars, &memory),
            Past::Direct(d) => d.load(scalars, memory),
        };
        let restored = restored && march.meter.restore(&march.past, energies);
        if !restored {
            return Err(foreign("a memory of another material or scheme".into()));
        }
        march.done = checkpoint.step;
        Ok(march)
    }
}
