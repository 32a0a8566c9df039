//! What is exported: the result as a list of variables over named dimensions, the fields one map at a time.

use ndarray::Array2;
use serde_json::Value;

use super::error::Result;
pub(super) use crate::classic::Attribute;
pub(super) use crate::store::DataType;
use crate::store::{ArraySpec, FieldKind, Reader, Storage};

/// A result as variables over dimensions.
pub(super) struct Contents<'a> {
    pub(super) reader: &'a Reader,
    /// Numbers of the stored instants that are exported.
    pub(super) instants: Vec<usize>,
    pub(super) dimensions: Vec<(&'static str, usize)>,
    pub(super) attributes: Vec<(String, Attribute)>,
    pub(super) variables: Vec<Variable>,
}

/// A variable over its dimensions.
pub(super) struct Variable {
    pub(super) name: &'static str,
    pub(super) units: &'static str,
    pub(super) long_name: &'static str,
    /// Indices in [`Contents::dimensions`].
    pub(super) dimensions: Vec<usize>,
    pub(super) data: Data,
}

/// The numbers of a variable.
pub(super) enum Data {
    Reals(Vec<f64>),
    Counts(Vec<i64>),
    /// One map x by y for each place along the other dimensions, read when it is written.
    Maps(DataType),
}

/// A map as it is stored.
pub(super) enum Map {
    Real(Array2<f64>),
    Byte(Array2<u8>),
}

pub(super) const TIME: usize = 0;
pub(super) const FIELD_TIME: usize = 1;
/// Dimensions of the conductance, which has no coordinates in a result.
const DIRECTIONS: [(&str, &str); 2] = [
    ("flow_direction", "direction of the flow, 0 for x and 1 for y"),
    ("gradient_direction", "direction of the pressure gradient, 0 for x and 1 for y"),
];

impl<'a> Contents<'a> {
    /// Everything in `reader`, with these fields at these instants.
    pub(super) fn new(reader: &'a Reader, fields: &[FieldKind], instants: Vec<usize>) -> Result<Self> {
        let header = reader.header();
        // A damaged result is refused, also where it is the order of its rows that is wrong.
        let [row, map] = [("time", reader.rows()?.len()), ("field_time", instants.len())];
        let dimensions = [row, map].map(|(name, length)| (header.stored(name), length)).to_vec();
        let attributes =
            reader.attributes().into_iter().filter_map(|(key, value)| Some((key, attribute(&value)?)));
        let mut contents =
            Contents { attributes: attributes.collect(), reader, instants, dimensions, variables: vec![] };
        for array in reader.arrays() {
            if FieldKind::from_name(array.name()).is_none_or(|kind| fields.contains(&kind)) {
                contents.add(&array)?;
            }
        }
        for (name, long_name) in DIRECTIONS {
            if let Some(along) = contents.dimensions.iter().position(|(known, _)| *known == name) {
                let (dimensions, data) = (vec![along], Data::Counts(vec![0, 1]));
                contents.variables.push(Variable { name, units: "1", long_name, dimensions, data });
            }
        }
        Ok(contents)
    }

    /// Adds an array of the result.
    fn add(&mut self, array: &ArraySpec) -> Result<()> {
        let mut dimension = |(name, length): &(&'static str, usize)| match *name {
            "field_time" | "field_velocity" => FIELD_TIME,
            name => self.dimensions.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
                self.dimensions.push((name, *length));
                self.dimensions.len() - 1
            }),
        };
        let dimensions: Vec<usize> = array.dimensions.iter().map(&mut dimension).collect();
        let data = match (array.storage, array.data_type) {
            (Storage::Maps, kind) => Data::Maps(kind),
            (_, kind) => {
                let mut numbers = self.reader.numbers(array.name())?;
                if dimensions[0] == FIELD_TIME {
                    let width: usize = array.dimensions[1..].iter().map(|(_, length)| length).product();
                    let of = |instant: &usize| &numbers[instant * width..(instant + 1) * width];
                    numbers = self.instants.iter().flat_map(of).copied().collect();
                }
                match kind {
                    DataType::Int64 => Data::Counts(numbers.into_iter().map(|count| count as i64).collect()),
                    _ => Data::Reals(numbers),
                }
            }
        };
        let (name, units, long_name) = (array.series.name, array.series.units, array.series.long_name);
        self.variables.push(Variable { name, units, long_name, dimensions, data });
        Ok(())
    }

    /// Lengths of the dimensions of a variable before those of its maps.
    pub(super) fn lead(&self, variable: &Variable) -> Vec<usize> {
        let dimensions = variable.dimensions.iter().map(|dimension| self.dimensions[*dimension]);
        dimensions.filter(|(name, _)| !["x", "y"].contains(name)).map(|(_, length)| length).collect()
    }

    /// Place of the `n`th map of a variable along the dimensions before those of its maps.
    pub(super) fn place(&self, variable: &Variable, mut n: usize) -> Vec<usize> {
        let mut place = self.lead(variable);
        for length in place.iter_mut().rev() {
            (n, *length) = (n / *length, n % *length);
        }
        place
    }

    /// The `n`th map of a variable.
    pub(super) fn map(&self, variable: &Variable, n: usize) -> Result<Map> {
        let place = self.place(variable, n).into_iter().zip(&variable.dimensions);
        let stored = |(n, dimension): (usize, &usize)| match *dimension {
            FIELD_TIME => self.instants[n] as u64,
            _ => n as u64,
        };
        let index: Vec<u64> = place.map(stored).collect();
        Ok(match variable.data {
            Data::Maps(DataType::UInt8) => Map::Byte(self.reader.map(variable.name, &index)?),
            _ if !self.reader.has_map(variable.name, &index) => {
                Map::Real(Array2::from_elem(self.reader.header().grid.shape(), f64::NAN))
            }
            _ => Map::Real(self.reader.map(variable.name, &index)?),
        })
    }
}

impl Variable {
    /// Lengths along its dimensions.
    pub(super) fn shape(&self, contents: &Contents<'_>) -> Vec<usize> {
        self.dimensions.iter().map(|d| contents.dimensions[*d].1).collect()
    }

    /// Whether it is a field of the contact, which a result keeps over time.
    pub(super) fn is_field(&self) -> bool {
        FieldKind::from_name(self.name).is_some()
    }
}

fn attribute(value: &Value) -> Option<Attribute> {
    let reals = |values: &[Value]| values.iter().map(Value::as_f64).collect::<Option<Vec<_>>>();
    let counts = |values: &[Value]| values.iter().map(Value::as_i64).collect::<Option<Vec<_>>>();
    Some(match value {
        Value::String(text) => Attribute::Text(text.clone()),
        Value::Number(_) => {
            let one = std::slice::from_ref(value);
            counts(one).map(Attribute::Counts).or_else(|| reals(one).map(Attribute::Reals))?
        }
        // Lists of objects, or of nothing, go as JSON: formats of arrays know none.
        Value::Array(values) if values.iter().all(Value::is_object) => Attribute::Text(value.to_string()),
        Value::Array(values) => {
            counts(values).map(Attribute::Counts).or_else(|| reals(values).map(Attribute::Reals))?
        }
        _ => return None,
    })
}
