//! Classic NetCDF: a header, the fixed variables, then one record per instant of the fields; big-endian.
//!
//! Written in the form of 64-bit offsets (CDF-2), which every reader knows; where one map of a variable
//! exceeds 4 GiB, in that of 64-bit data (CDF-5). Specification: "The NetCDF Classic Format
//! Specification", docs.unidata.ucar.edu/netcdf-c, file format specifications.

use std::io::Write;

use super::contents::{Contents, Data, DataType, FIELD_TIME, Map, Variable};
use super::error::WriteError;
use crate::classic::{ATTRIBUTE, Attribute, DIMENSION, Header, Type, VARIABLE, padded};
use crate::output::Output;

/// Largest slab of CDF-2.
const LARGEST: u64 = (1 << 32) - 4;

/// A variable with its type and the bytes of one slab: the whole of it, or one record.
struct Slab<'a> {
    variable: &'a Variable,
    kind: Type,
    record: bool,
    bytes: u64,
}

pub(super) fn write(contents: &Contents<'_>, file: &mut Output<'_>) -> Result<(), WriteError> {
    let slabs: Vec<Slab<'_>> = contents.variables.iter().map(|v| slab(contents, v)).collect();
    let wide = slabs.iter().any(|slab| slab.bytes > LARGEST);
    write_slabs(contents, &slabs, wide, file)
}

fn write_slabs(
    contents: &Contents<'_>,
    slabs: &[Slab<'_>],
    wide: bool,
    file: &mut impl Write,
) -> Result<(), WriteError> {
    // The header's length does not depend on the offsets in it.
    let zeros = vec![0; slabs.len()];
    let mut end = header(contents, slabs, wide, &zeros).len() as u64;
    let mut begins = zeros;
    for record in [false, true] {
        for (slab, begin) in slabs.iter().zip(&mut begins).filter(|(slab, _)| slab.record == record) {
            *begin = end;
            end += padded(slab.bytes);
        }
    }
    file.write_all(&header(contents, slabs, wide, &begins))?;
    for slab in slabs.iter().filter(|slab| !slab.record) {
        write_slab(contents, slab, 0, file)?;
    }
    for n in 0..contents.instants.len() {
        for slab in slabs.iter().filter(|slab| slab.record) {
            write_slab(contents, slab, n, file)?;
        }
    }
    Ok(())
}

fn slab<'a>(contents: &Contents<'_>, variable: &'a Variable) -> Slab<'a> {
    let kind = match &variable.data {
        Data::Maps(DataType::UInt8) => Type::Byte,
        Data::Reals(_) | Data::Maps(_) => Type::Double,
        // Counts beyond 2^31 are exact as doubles up to 2^53.
        Data::Counts(counts) if counts.iter().all(|n| i32::try_from(*n).is_ok()) => Type::Int,
        Data::Counts(_) => Type::Double,
    };
    let record = variable.dimensions.first() == Some(&FIELD_TIME);
    let lengths = variable.shape(contents).into_iter().skip(usize::from(record));
    let bytes = lengths.fold(kind.size(), |bytes, n| bytes.saturating_mul(n as u64));
    Slab { variable, kind, record, bytes }
}

fn write_slab(
    contents: &Contents<'_>,
    slab: &Slab<'_>,
    n: usize,
    file: &mut impl Write,
) -> Result<(), WriteError> {
    let instants = contents.instants.len().max(1);
    let part = |length: usize| match slab.record {
        true => n * (length / instants)..(n + 1) * (length / instants),
        false => 0..length,
    };
    match &slab.variable.data {
        Data::Reals(reals) => {
            reals[part(reals.len())].iter().try_for_each(|x| file.write_all(&x.to_be_bytes()))?;
        }
        Data::Counts(counts) => {
            for count in &counts[part(counts.len())] {
                match (slab.kind, i32::try_from(*count)) {
                    (Type::Int, Ok(count)) => file.write_all(&count.to_be_bytes())?,
                    _ => file.write_all(&(*count as f64).to_be_bytes())?,
                }
            }
        }
        Data::Maps(_) => {
            for n in part(contents.lead(slab.variable).iter().product()) {
                match contents.map(slab.variable, n)? {
                    Map::Real(map) => map.iter().try_for_each(|x| file.write_all(&x.to_be_bytes()))?,
                    Map::Byte(map) => file.write_all(map.as_slice().unwrap_or_default())?,
                }
            }
        }
    }
    let padding = (padded(slab.bytes) - slab.bytes) as usize;
    Ok(file.write_all(&[0; 4][..padding])?)
}

fn header(contents: &Contents<'_>, slabs: &[Slab<'_>], wide: bool, begins: &[u64]) -> Vec<u8> {
    let mut header = Header::new(contents.instants.len() as u64, wide);
    header.list(DIMENSION, contents.dimensions.len());
    for (index, (name, length)) in contents.dimensions.iter().enumerate() {
        header.text(name);
        header.size(if index == FIELD_TIME { 0 } else { *length as u64 }); // 0: along the records
    }
    header.list(ATTRIBUTE, contents.attributes.len());
    for (name, attribute) in &contents.attributes {
        header.attribute(name, attribute);
    }
    header.list(VARIABLE, slabs.len());
    for (slab, begin) in slabs.iter().zip(begins) {
        let variable = slab.variable;
        header.text(variable.name);
        header.size(variable.dimensions.len() as u64);
        variable.dimensions.iter().for_each(|d| header.size(*d as u64));
        header.list(ATTRIBUTE, 2);
        header.attribute("units", &Attribute::Text(variable.units.into()));
        header.attribute("long_name", &Attribute::Text(variable.long_name.into()));
        header.tag(slab.kind as u32);
        header.size(padded(slab.bytes));
        header.bytes.extend(begin.to_be_bytes());
    }
    header.bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{At, Field, FieldKind, Header as ResultHeader, Reader, Row, Writer};
    use asperity::Coordinate;
    use ndarray::{Array2, Axis};
    use netcdf_reader::NcFile;

    /// Maps beyond 4 GiB would take hours to test with; their form does not depend on the size.
    #[test]
    fn the_wide_form_holds_the_same_numbers() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("result.zarr");
        let grid = asperity::Grid::new([5, 3], [1.0, 1.0]).unwrap();
        let header = ResultHeader {
            title: "t".into(),
            case_text: "c".into(),
            version: "0".into(),
            grid,
            fields: vec![FieldKind::Pressure, FieldKind::Contact],
            quantities: vec![],
            rows_expected: None,
            setup: Default::default(),
        };
        let mut writer = Writer::create(&path, &header, Array2::zeros((5, 3)).view(), false).unwrap();
        for step in 0..3 {
            let pressure = Array2::from_shape_fn((5, 3), |(i, j)| (step * 15 + i * 3 + j) as f64 / 3.0);
            let contact = Array2::from_elem((5, 3), step as u8);
            let fields = [Field::Pressure(pressure.view()), Field::Contact(contact.view())];
            writer
                .append(&Row { coordinate: Coordinate::Time(step as f64), ..Row::default() }, &fields)
                .unwrap();
        }
        let reader = Reader::open(&path).unwrap();
        let contents = Contents::new(&reader, &header.fields, vec![0, 1, 2]).ok().unwrap();
        let slabs: Vec<Slab<'_>> = contents.variables.iter().map(|v| slab(&contents, v)).collect();
        let mut bytes = Vec::new();
        assert!(write_slabs(&contents, &slabs, true, &mut bytes).is_ok());
        assert_eq!(&bytes[..4], b"CDF\x05");
        let file = NcFile::from_bytes(&bytes).unwrap();
        let pressure = file.read_variable::<f64>("pressure").unwrap();
        let contact = file.read_variable_as_f64("contact").unwrap();
        for n in 0..3 {
            let at = At::Index(n);
            let map = |array: &ndarray::ArrayD<f64>| array.index_axis(Axis(0), n).to_owned();
            assert_eq!(map(&pressure), reader.field(FieldKind::Pressure, at).unwrap().into_dyn());
            assert_eq!(map(&contact), reader.field(FieldKind::Contact, at).unwrap().into_dyn());
        }
    }
}
