//! HDF5, with dimension scales: h5py and MATLAB open it, and NetCDF-4 readers (xarray) find its dimensions.
//!
//! Data sets in one piece, so that maps go to the file one after the other, whatever their number.
//! The file is written in order: room for the superblock, data, texts, object headers, root group, and
//! then the superblock. (The writers published for Rust hold all data in memory.)

mod checksum;
mod object;

use std::io::{Seek, SeekFrom, Write};

use super::contents::{Attribute, Contents, Data, Map};
use super::error::WriteError;
use super::output::Output;
use crate::store::FieldKind;
use object::{Heap, Object, SUPERBLOCK, Type, superblock};

pub(super) fn write(contents: &Contents<'_>, file: &mut Output) -> Result<(), WriteError> {
    let mut file = Place { file, at: 0 };
    file.put(&[0; SUPERBLOCK as usize])?;

    // The numbers.
    let mut data = Vec::new();
    for variable in &contents.variables {
        file.align()?;
        data.push((kind(&variable.data), file.at));
        write_data(contents, &variable.data, &mut file)?;
    }

    // The texts; objects refer to them by their places.
    file.align()?;
    let mut texts = Heap::new(file.at);
    let mut put = |text: &str| texts.put(text.len(), text.as_bytes());
    let mut root = Object::group();
    for (name, attribute) in &contents.attributes {
        match attribute {
            Attribute::Text(text) => root.attribute(name, Type::Text, &[], &put(text)),
            Attribute::Reals(reals) => numbers(&mut root, name, Type::Float64, reals, |x| x.to_le_bytes()),
            Attribute::Counts(counts) => numbers(&mut root, name, Type::Int64, counts, |n| n.to_le_bytes()),
        }
    }
    let mut objects = Vec::new();
    for (variable, (kind, address)) in contents.variables.iter().zip(data) {
        let mut object = Object::data_set(kind, &variable.shape(contents), address);
        object.attribute("units", Type::Text, &[], &put(variable.units));
        object.attribute("long_name", Type::Text, &[], &put(variable.long_name));
        objects.push((variable, object));
    }
    file.put(&texts.bytes())?;

    // The dimensions are the variables of their names. They come first, as the others refer to them.
    let dimension_of = |name: &str| contents.dimensions.iter().position(|(other, _)| *other == name);
    let mut scales = vec![0; contents.dimensions.len()];
    for (variable, object) in &mut objects {
        let Some(dimension) = dimension_of(variable.name) else { continue };
        object.mark("CLASS", "DIMENSION_SCALE");
        object.mark("NAME", variable.name);
        object.attribute("_Netcdf4Dimid", Type::Int32, &[], &(dimension as i32).to_le_bytes());
        scales[dimension] = file.object(object)?;
        root.link(variable.name, scales[dimension]);
    }
    file.align()?;
    let mut references = Heap::new(file.at);
    let places: Vec<_> = scales.iter().map(|scale| references.put(1, &scale.to_le_bytes())).collect();
    file.put(&references.bytes())?;
    for (variable, object) in &mut objects {
        if dimension_of(variable.name).is_some() {
            continue;
        }
        let list = variable.dimensions.iter().map(|d| places[*d]).collect::<Vec<_>>().concat();
        object.attribute("DIMENSION_LIST", Type::References, &[variable.dimensions.len()], &list);
        root.link(variable.name, file.object(object)?);
    }

    let root = file.object(&root)?;
    let end = file.at;
    file.file.seek(SeekFrom::Start(0))?;
    Ok(file.file.write_all(&superblock(end, root))?)
}

fn kind(data: &Data) -> Type {
    match data {
        Data::Counts(_) => Type::Int64,
        Data::Field(FieldKind::Contact) => Type::UInt8,
        _ => Type::Float64,
    }
}

fn write_data(contents: &Contents<'_>, data: &Data, file: &mut Place<'_>) -> Result<(), WriteError> {
    match data {
        Data::Reals(reals) => reals.iter().try_for_each(|x| file.put(&x.to_le_bytes())),
        Data::Counts(counts) => counts.iter().try_for_each(|n| file.put(&n.to_le_bytes())),
        data => (0..contents.maps(data)).try_for_each(|n| match contents.map(data, n)? {
            Some(Map::Real(map)) => map.iter().try_for_each(|x| file.put(&x.to_le_bytes())),
            Some(Map::Byte(map)) => file.put(map.as_slice().unwrap_or_default()),
            None => Ok(()),
        }),
    }
}

/// An attribute of numbers: a single one without dimension.
fn numbers<T>(object: &mut Object, name: &str, kind: Type, values: &[T], bytes: impl Fn(&T) -> [u8; 8]) {
    let shape: &[usize] = if values.len() == 1 { &[] } else { &[values.len()] };
    let data: Vec<u8> = values.iter().flat_map(bytes).collect();
    object.attribute(name, kind, shape, &data);
}

/// The end of the file.
struct Place<'a> {
    file: &'a mut Output,
    at: u64,
}

impl Place<'_> {
    fn put(&mut self, bytes: &[u8]) -> Result<(), WriteError> {
        self.at += bytes.len() as u64;
        Ok(self.file.write_all(bytes)?)
    }

    /// Up to the next multiple of 8.
    fn align(&mut self) -> Result<(), WriteError> {
        let gap = self.at.next_multiple_of(8) - self.at;
        self.put(&[0; 8][..gap as usize])
    }

    /// Writes an object header; returns its address.
    fn object(&mut self, object: &Object) -> Result<u64, WriteError> {
        self.align()?;
        let address = self.at;
        self.put(&object.bytes())?;
        Ok(address)
    }
}
