//! Classic NetCDF: a header, the fixed variables, then one record per instant of the fields; big-endian.
//!
//! Written in the form of 64-bit offsets (CDF-2), which every reader knows; where one map of a variable
//! exceeds 4 GiB, in that of 64-bit data (CDF-5). Specification: "The NetCDF Classic Format
//! Specification", docs.unidata.ucar.edu/netcdf-c, file format specifications.

use std::io::Write;

use super::contents::{Contents, Data, DataType, FIELD_TIME, Map, Variable};
use super::error::Result;
use crate::classic::{self, Attribute, Type, padded};
use crate::output::Output;

/// Largest slab of CDF-2.
const LARGEST: u64 = (1 << 32) - 4;

/// A variable of the result, and how it is written.
type Slab<'a> = (&'a Variable, classic::Variable<'a>);

pub(super) fn write(contents: &Contents<'_>, file: &mut Output<'_>) -> Result<()> {
    let slabs: Vec<Slab<'_>> = contents.variables.iter().map(|v| slab(contents, v)).collect();
    let wide = slabs.iter().any(|(_, slab)| slab.bytes > LARGEST);
    write_slabs(contents, slabs, wide, file)
}

fn write_slabs(
    contents: &Contents<'_>,
    slabs: Vec<Slab<'_>>,
    wide: bool,
    file: &mut impl Write,
) -> Result<()> {
    let mut dimensions = contents.dimensions.clone();
    dimensions[FIELD_TIME].1 = 0; // along the records
    let (variables, slabs): (Vec<_>, Vec<_>) = slabs.into_iter().unzip();
    let records = contents.instants.len();
    file.write_all(&classic::header(records, wide, &dimensions, &contents.attributes, &slabs))?;
    let written = |record| variables.iter().zip(&slabs).filter(move |(_, slab)| slab.record == record);
    written(false).try_for_each(|(variable, slab)| write_slab(contents, variable, slab, 0, file))?;
    (0..records).try_for_each(|n| {
        written(true).try_for_each(|(variable, slab)| write_slab(contents, variable, slab, n, file))
    })
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
    let texts = [("units", variable.units), ("long_name", variable.long_name)];
    let attributes = texts.map(|(name, text)| (name, Attribute::Text(text.to_owned()))).to_vec();
    let dimensions = variable.dimensions.clone();
    (variable, classic::Variable { name: variable.name, dimensions, attributes, kind, bytes, record })
}

fn write_slab(
    contents: &Contents<'_>,
    variable: &Variable,
    slab: &classic::Variable<'_>,
    n: usize,
    file: &mut impl Write,
) -> Result<()> {
    let instants = contents.instants.len().max(1);
    let part = |length: usize| match slab.record {
        true => n * (length / instants)..(n + 1) * (length / instants),
        false => 0..length,
    };
    match &variable.data {
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
            for n in part(contents.lead(variable).iter().product()) {
                match contents.map(variable, n)? {
                    Map::Real(map) => map.iter().try_for_each(|x| file.write_all(&x.to_be_bytes()))?,
                    Map::Byte(map) => file.write_all(map.as_slice().unwrap_or_default())?,
                }
            }
        }
    }
    let padding = (padded(slab.bytes) - slab.bytes) as usize;
    Ok(file.write_all(&[0; 4][..padding])?)
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
            let fields = [Field::Real(FieldKind::Pressure, pressure.view()), Field::Contact(contact.view())];
            writer
                .append(&Row { coordinate: Coordinate::Time(step as f64), ..Row::default() }, &fields)
                .unwrap();
        }
        let reader = Reader::open(&path).unwrap();
        let contents = Contents::new(&reader, &header.fields, vec![0, 1, 2]).ok().unwrap();
        let slabs: Vec<Slab<'_>> = contents.variables.iter().map(|v| slab(&contents, v)).collect();
        let mut bytes = Vec::new();
        assert!(write_slabs(&contents, slabs, true, &mut bytes).is_ok());
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
