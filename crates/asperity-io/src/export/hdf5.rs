//! HDF5, with dimension scales: h5py and MATLAB open it, and NetCDF-4 readers (xarray) find its dimensions.
//!
//! Data sets are contiguous, and maps are written one after the other: memory holds one of them.

use std::path::Path;

use rust_hdf5::{H5Dataset, H5File, H5Type, Hdf5Error, VarLenUnicode};

use super::contents::{Attribute, Contents, Data, DataType, Map, Variable};
use super::error::Result;

/// Fills the file at `path`, which is made anew.
pub(super) fn write(contents: &Contents<'_>, path: &Path) -> Result<()> {
    // Nobody else knows the path yet; and some network file systems have no locks.
    let file = H5File::options().no_locking().create(path)?;
    for (name, attribute) in &contents.attributes {
        match attribute {
            Attribute::Text(text) => file.set_attr_string(name, text)?,
            Attribute::Reals(reals) => numbers(&file, name, reals)?,
            Attribute::Counts(counts) => numbers(&file, name, counts)?,
        }
    }
    let mut data_sets = Vec::with_capacity(contents.variables.len());
    for variable in &contents.variables {
        let data_set = create(&file, contents, variable)?;
        data_set.new_attr::<VarLenUnicode>().create("units")?.write_string(variable.units)?;
        data_set.new_attr::<VarLenUnicode>().create("long_name")?.write_string(variable.long_name)?;
        write_data(contents, variable, &data_set)?;
        data_sets.push((variable, data_set));
    }
    // The dimensions are the variables of their names.
    let scales: Vec<_> = contents
        .dimensions
        .iter()
        .map(|(name, _)| data_sets.iter().find(|(variable, _)| variable.name == *name))
        .collect();
    for (scale, data_set) in scales.iter().flatten() {
        data_set.set_scale(Some(scale.name))?;
    }
    for (variable, data_set) in &data_sets {
        if contents.dimensions.iter().any(|(name, _)| *name == variable.name) {
            continue;
        }
        for (axis, dimension) in variable.dimensions.iter().enumerate() {
            if let Some((_, scale)) = scales[*dimension] {
                data_set.attach_scale(axis, scale)?;
            }
        }
    }
    Ok(file.close()?)
}

/// An attribute of numbers: a single one without dimension.
fn numbers<T: H5Type>(file: &H5File, name: &str, values: &[T]) -> Result<(), Hdf5Error> {
    match values {
        [one] => file.set_attr_numeric(name, one),
        many => file.set_attr_array_numeric(name, many),
    }
}

fn create(file: &H5File, contents: &Contents<'_>, variable: &Variable) -> Result<H5Dataset, Hdf5Error> {
    let shape = variable.shape(contents);
    match &variable.data {
        Data::Counts(_) => file.new_dataset::<i64>().shape(shape).create(variable.name),
        Data::Maps(DataType::UInt8) => file.new_dataset::<u8>().shape(shape).create(variable.name),
        _ => file.new_dataset::<f64>().shape(shape).create(variable.name),
    }
}

fn write_data(contents: &Contents<'_>, variable: &Variable, data_set: &H5Dataset) -> Result<()> {
    if data_set.total_elements() == 0 {
        return Ok(()); // no instant is exported: a data set without numbers takes no write
    }
    match &variable.data {
        Data::Reals(reals) => data_set.write_raw(reals)?,
        Data::Counts(counts) => data_set.write_raw(counts)?,
        Data::Maps(_) => {
            for n in 0..contents.lead(variable).iter().product() {
                let place = contents.place(variable, n);
                match contents.map(variable, n)? {
                    Map::Real(map) => write_map(data_set, &place, map.as_slice().unwrap_or_default())?,
                    Map::Byte(map) => write_map(data_set, &place, map.as_slice().unwrap_or_default())?,
                }
            }
        }
    }
    Ok(())
}

/// Writes one map of a data set: its part at `place` along its first axes.
fn write_map<T: H5Type>(data_set: &H5Dataset, place: &[usize], map: &[T]) -> Result<(), Hdf5Error> {
    let shape = data_set.shape();
    let (mut starts, mut counts) = (vec![0; shape.len()], vec![1; place.len()]);
    starts[..place.len()].copy_from_slice(place);
    counts.extend(&shape[place.len()..]);
    data_set.write_slice(&starts, &counts, map)
}
