//! What a run is resumed from, with the same bits: numbers and fields by name.
//!
//! Each room saves its own state under its own name ("schedule/stage", "history/displacement") and takes it back by that name,
//! so that no room knows what the others save, or in which order.

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

    pub(crate) fn number(&mut self, name: &str, number: f64) {
        self.numbers(name, vec![number]);
    }

    pub(crate) fn numbers(&mut self, name: &str, numbers: Vec<f64>) {
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

    pub(crate) fn array<const N: usize>(&self, name: &str) -> Result<[f64; N]> {
        let numbers = self.numbers(name)?;
        numbers.try_into().map_err(|_| self.foreign(format!("{} numbers of {name}", numbers.len())))
    }

    pub(crate) fn number(&self, name: &str) -> Result<f64> {
        self.array::<1>(name).map(|[number]| number)
    }

    pub(crate) fn numbers_into(&self, name: &str, to: &mut [f64]) -> Result<()> {
        self.check(name, |numbers| {
            let fits = numbers.len() == to.len();
            if fits {
                to.copy_from_slice(numbers);
            }
            fits
        })
    }

    /// Hands numbers to `take`, which says whether they fit.
    pub(crate) fn check(&self, name: &str, take: impl FnOnce(&[f64]) -> bool) -> Result<()> {
        match take(self.numbers(name)?) {
            true => Ok(()),
            false => Err(self.foreign(format!("with other {name}"))),
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
