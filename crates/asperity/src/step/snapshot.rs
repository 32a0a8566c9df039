//! What a run is resumed from, with the same bits: numbers and fields by name.
//!
//! Each room saves its own state under its own name ("schedule/stage", "history/displacement") and takes it back by that name,
//! so that no room knows what the others save, or in which order.

use std::slice::Iter;

use ndarray::{Array2, ArrayView2, CowArray, Ix2};

use crate::error::{Error, Result};

/// Everything that the rest of a run depends on; see [`Drive::checkpoint`](crate::Drive::checkpoint).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checkpoint<'a> {
    /// Rows done.
    pub step: usize,
    /// Named lists of numbers.
    pub numbers: Vec<(String, Vec<f64>)>,
    /// Named fields of nx x ny cells; those of the run itself are lent.
    pub fields: Vec<(String, CowArray<'a, f64, Ix2>)>,
}

impl Checkpoint<'_> {
    /// With fields of its own, to be kept while the run goes on.
    pub fn into_owned(self) -> Checkpoint<'static> {
        let fields = self.fields.into_iter().map(|(name, field)| (name, field.into_owned().into()));
        Checkpoint { step: self.step, numbers: self.numbers, fields: fields.collect() }
    }
}

/// What a checkpoint holds as numbers.
pub(crate) trait Saved {
    fn save(&self, to: &mut Vec<f64>);

    /// Takes its numbers back from the first ones left; `None` where they do not fit.
    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()>;
}

impl Saved for f64 {
    fn save(&self, to: &mut Vec<f64>) {
        to.push(*self);
    }
    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()> {
        from.next().map(|number| *self = *number)
    }
}

impl Saved for bool {
    fn save(&self, to: &mut Vec<f64>) {
        to.push(f64::from(u8::from(*self)));
    }
    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()> {
        from.next().map(|number| *self = *number == 1.0)
    }
}

impl Saved for usize {
    fn save(&self, to: &mut Vec<f64>) {
        to.push(*self as f64);
    }
    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()> {
        from.next().filter(|number| **number >= 0.0).map(|number| *self = *number as usize)
    }
}

impl<T: Saved, const N: usize> Saved for [T; N] {
    fn save(&self, to: &mut Vec<f64>) {
        self.iter().for_each(|value| value.save(to));
    }

    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()> {
        self.iter_mut().try_for_each(|value| value.load(from))
    }
}

/// As many as there are.
impl<T: Saved> Saved for Vec<T> {
    fn save(&self, to: &mut Vec<f64>) {
        self.iter().for_each(|value| value.save(to));
    }
    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()> {
        self.iter_mut().try_for_each(|value| value.load(from))
    }
}

/// The last of its list.
impl<T: Saved + Default> Saved for Option<T> {
    fn save(&self, to: &mut Vec<f64>) {
        self.iter().for_each(|value| value.save(to));
    }
    fn load(&mut self, from: &mut Iter<'_, f64>) -> Option<()> {
        *self = (from.len() > 0).then(T::default);
        self.iter_mut().try_for_each(|value| value.load(from))
    }
}

/// Declares once what of a state is saved and taken back, by name: numbers, several values to a list, and fields.
macro_rules! saved {
    ($state:ty { $($name:literal: $($value:tt $(. $part:tt)* $([$index:literal])?),+;)* }
     $(fields { $($field_name:literal: $field:tt $(. $field_part:tt)*;)* })?) => {
        impl $state {
            pub(crate) fn save_own<'a>(&'a self, to: &mut crate::step::Saver<'a>) {
                $(to.values($name, &[$(&self.$value $(. $part)* $([$index])?),+]);)*
                $($(to.field($field_name, &self.$field $(. $field_part)*);)*)?
            }

            pub(crate) fn load_own(&mut self, from: &crate::step::Loader<'_>) -> crate::error::Result<()> {
                $(from.values_into($name, &mut [$(&mut self.$value $(. $part)* $([$index])?),+])?;)*
                $($(from.field_into($field_name, &mut self.$field $(. $field_part)*)?;)*)?
                Ok(())
            }
        }
    };
}
pub(crate) use saved;

/// Writes a checkpoint, room by room.
pub(crate) struct Saver<'a> {
    shape: (usize, usize),
    room: String,
    checkpoint: Checkpoint<'a>,
}

impl<'a> Saver<'a> {
    /// After `step` rows of fields of this shape.
    pub(crate) fn new(step: usize, shape: (usize, usize)) -> Self {
        Saver { shape, room: String::new(), checkpoint: Checkpoint { step, ..Checkpoint::default() } }
    }

    pub(crate) fn finish(self) -> Checkpoint<'a> {
        self.checkpoint
    }

    /// What `save` saves is in the room `name`.
    pub(crate) fn within(&mut self, name: &str, save: impl FnOnce(&mut Self)) {
        let outer = self.room.clone();
        self.room = format!("{outer}{name}/");
        save(self);
        self.room = outer;
    }

    pub(crate) fn value(&mut self, name: &str, value: &dyn Saved) {
        self.values(name, &[value]);
    }

    /// Several values as one list.
    pub(crate) fn values(&mut self, name: &str, values: &[&dyn Saved]) {
        let mut numbers = vec![];
        values.iter().for_each(|value| value.save(&mut numbers));
        self.checkpoint.numbers.push((format!("{}{name}", self.room), numbers));
    }

    /// A field that is lent.
    pub(crate) fn field(&mut self, name: &str, cells: &'a [f64]) {
        if let Ok(field) = ArrayView2::from_shape(self.shape, cells) {
            self.checkpoint.fields.push((format!("{}{name}", self.room), field.into()));
        }
    }

    /// A field that was made for the checkpoint.
    pub(crate) fn owned_field(&mut self, name: &str, cells: Vec<f64>) {
        if let Ok(field) = Array2::from_shape_vec(self.shape, cells) {
            self.checkpoint.fields.push((format!("{}{name}", self.room), field.into()));
        }
    }
}

/// Reads a checkpoint, room by room.
pub(crate) struct Loader<'a> {
    shape: (usize, usize),
    room: String,
    numbers: &'a [(String, Vec<f64>)],
    fields: Vec<(&'a str, ArrayView2<'a, f64>)>,
}

impl<'a> Loader<'a> {
    /// Of fields of this shape.
    pub(crate) fn new(checkpoint: &'a Checkpoint<'_>, shape: (usize, usize)) -> Self {
        let fields = checkpoint.fields.iter().map(|(name, cells)| (&name[..], cells.view())).collect();
        Loader { shape, room: String::new(), numbers: &checkpoint.numbers, fields }
    }

    /// The error of a checkpoint that belongs to another run.
    pub(crate) fn foreign(&self, what: impl std::fmt::Display) -> Error {
        let room = self.room.trim_end_matches('/');
        let of = if room.is_empty() { String::new() } else { format!(" ({room})") };
        Error::invalid("checkpoint", format!("{what}{of}"), "one of this simulation")
    }

    /// What `load` reads is in the room `name`.
    pub(crate) fn within<T>(&mut self, name: &str, load: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let outer = self.room.clone();
        self.room = format!("{outer}{name}/");
        let loaded = load(self);
        self.room = outer;
        loaded
    }

    /// Whether nothing was saved in this room.
    pub(crate) fn is_empty(&self) -> bool {
        !self.numbers.iter().any(|(name, _)| name.starts_with(&self.room))
    }

    pub(crate) fn numbers(&self, name: &str) -> Result<&'a [f64]> {
        let name = format!("{}{name}", self.room);
        let found = self.numbers.iter().find(|(own, _)| *own == name);
        found.map(|(_, numbers)| &numbers[..]).ok_or_else(|| self.foreign(format!("without {name}")))
    }

    pub(crate) fn get<T: Saved + Default>(&self, name: &str) -> Result<T> {
        let mut value = T::default();
        self.values_into(name, &mut [&mut value])?;
        Ok(value)
    }

    /// Takes the values of one list back.
    pub(crate) fn values_into(&self, name: &str, to: &mut [&mut dyn Saved]) -> Result<()> {
        let found = self.numbers(name);
        let mut numbers = found.as_ref().map_or(&[][..], |numbers| numbers).iter();
        let taken = to.iter_mut().try_for_each(|value| value.load(&mut numbers));
        match taken.filter(|()| numbers.len() == 0) {
            Some(()) => Ok(()),
            None => Err(found.err().unwrap_or_else(|| self.foreign(format!("with other {name}")))),
        }
    }

    /// A copy of a field.
    pub(crate) fn field(&self, name: &str) -> Result<Vec<f64>> {
        let name = format!("{}{name}", self.room);
        match self.fields.iter().find(|(own, _)| *own == name) {
            Some((_, cells)) if cells.dim() == self.shape => Ok(cells.iter().copied().collect()),
            Some((_, cells)) => Err(self.foreign(format!("field {name} of shape {:?}", cells.dim()))),
            None => Err(self.foreign(format!("without field {name}"))),
        }
    }

    pub(crate) fn field_into(&self, name: &str, to: &mut [f64]) -> Result<()> {
        to.copy_from_slice(&self.field(name)?);
        Ok(())
    }
}
