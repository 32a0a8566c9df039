//! What is exported: the result as a list of variables over named dimensions, the fields one map at a time.

use asperity::stress::StressQuantity;
use ndarray::Array2;
use serde_json::Value;

use super::error::Result;
pub(super) use crate::classic::Attribute;
use crate::store::{At, FieldKind, LeakTable, Leaks, Reader, Series, coordinates};

/// A result as variables over dimensions.
pub(super) struct Contents<'a> {
    reader: &'a Reader,
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
    /// x by y, read when it is written.
    InitialGap,
    /// One map x by y per instant, read when it is written.
    Field(FieldKind),
    /// One map x by y per instant and depth, read when it is written.
    Stress(StressQuantity),
    /// One map x by y per leak, read when it is written.
    FluidPressure,
}

/// A map as it is stored.
pub(super) enum Map {
    Real(Array2<f64>),
    Byte(Array2<u8>),
}

pub(super) const TIME: usize = 0;
pub(super) const FIELD_TIME: usize = 1;
pub(super) const X: usize = 2;
pub(super) const Y: usize = 3;

impl<'a> Contents<'a> {
    /// Everything in `reader`, with these fields at these instants.
    pub(super) fn new(reader: &'a Reader, fields: &[FieldKind], instants: Vec<usize>) -> Result<Self> {
        let grid = &reader.header().grid;
        let [nx, ny] = grid.cells();
        let rows = reader.rows()?;
        let header = reader.header();
        let [row, map] = ["time", "field_time"].map(|name| header.stored(name));
        let mut dimensions = vec![(row, rows.len()), (map, instants.len()), ("x", nx)];
        // A line has no dimension y.
        let over: &[usize] = if grid.is_line() { &[X] } else { &[X, Y] };
        if !grid.is_line() {
            dimensions.push(("y", ny));
        }
        let mut variables = Vec::new();
        let mut add = |name, units, long_name, dimensions: &[usize], data| {
            variables.push(Variable { name, units, long_name, dimensions: dimensions.to_vec(), data });
        };
        for scalar in &reader.scalars() {
            let series = reader.series(scalar.name)?;
            let data = match scalar.name {
                "iterations" => Data::Counts(rows.iter().map(|row| count(row.iterations)).collect()),
                "convolutions" => Data::Counts(rows.iter().map(|row| count(row.convolutions)).collect()),
                "stage" => Data::Counts(rows.iter().map(|row| count(row.stage)).collect()),
                _ => Data::Reals(series),
            };
            add(scalar.name, scalar.units, scalar.long_name, &[TIME], data);
        }
        for column in reader.header().quantities.iter().filter(|column| column.quantity.is_histogram()) {
            let (kind, place) = (column.quantity, dimensions.len());
            for (n, (series, numbers)) in coordinates(column, grid).into_iter().enumerate() {
                dimensions.push((series.name, numbers.len()));
                add(series.name, series.units, series.long_name, &[place + n], Data::Reals(numbers));
            }
            let (_, rows) = reader.histogram(kind)?;
            let numbers = rows.into_raw_vec_and_offset().0;
            let series = Series::of_quantity(kind, grid);
            add(series.name, series.units, series.long_name, &[TIME, place], Data::Reals(numbers));
        }
        let times = instants.iter().map(|index| reader.field_times()[*index]).collect();
        let of_fields = Series::of_fields(header);
        add(of_fields.name, of_fields.units, of_fields.long_name, &[FIELD_TIME], Data::Reals(times));
        let steps = instants.iter().map(|index| count(reader.field_steps()[*index])).collect();
        add("field_step", "1", "row of the fields", &[FIELD_TIME], Data::Counts(steps));
        let x = (0..nx).map(|i| grid.x(i)).collect();
        add("x", "m", "x, centres of the cells", &[X], Data::Reals(x));
        if !grid.is_line() {
            let y = (0..ny).map(|j| grid.y(j)).collect();
            add("y", "m", "y, centres of the cells", &[Y], Data::Reals(y));
        }
        add("initial_gap", "m", "undeformed gap", over, Data::InitialGap);
        for kind in fields {
            let over = [&[FIELD_TIME], over].concat();
            add(kind.name(), kind.units(), kind.long_name(), &over, Data::Field(*kind));
        }
        if let Some(set) = reader.stress() {
            let depth = dimensions.len();
            dimensions.push(("depth", set.depths.len()));
            add("depth", "m", "depth below the surface", &[depth], Data::Reals(set.depths.clone()));
            for series in set.scalars() {
                let all = reader.stress_series(series.name)?;
                let numbers = instants.iter().map(|index| all[*index]).collect();
                add(series.name, series.units, series.long_name, &[FIELD_TIME], Data::Reals(numbers));
            }
            for series in set.profiles() {
                let all = reader.stress_profile(series.name)?;
                let numbers = instants.iter().flat_map(|index| all.row(*index).to_vec()).collect();
                add(series.name, series.units, series.long_name, &[FIELD_TIME, depth], Data::Reals(numbers));
            }
            for (quantity, series) in set.fields() {
                let over = [&[FIELD_TIME, depth], over].concat();
                add(series.name, series.units, series.long_name, &over, Data::Stress(quantity));
            }
        }
        if let Some(table) = LeakTable::of(reader)? {
            let leak = dimensions.len();
            dimensions.push(("leak_time", table.len()));
            for series in table.series() {
                let numbers = table.get(series.name).unwrap_or_default();
                let data = match series.name {
                    "percolates" | "leak_resolved" | "leak_step" => {
                        Data::Counts(numbers.iter().map(|number| *number as i64).collect())
                    }
                    _ => Data::Reals(numbers.to_vec()),
                };
                add(series.name, series.units, series.long_name, &[leak], data);
            }
            if let Some(tensors) = table.get("conductance") {
                dimensions.extend([("flow_direction", 2), ("gradient_direction", 2)]);
                for (n, name, what) in [
                    (1, "flow_direction", "direction of the flow, 0 for x and 1 for y"),
                    (2, "gradient_direction", "direction of the pressure gradient, 0 for x and 1 for y"),
                ] {
                    add(name, "1", what, &[leak + n], Data::Counts(vec![0, 1]));
                }
                let over = [leak, leak + 1, leak + 2];
                add("conductance", "m3", "effective conductance", &over, Data::Reals(tensors.to_vec()));
            }
            if reader.leaks().is_some_and(Leaks::has_pressure) {
                add("fluid_pressure", "Pa", "pressure of the fluid", &[leak, X, Y], Data::FluidPressure);
            }
        }
        let attributes =
            reader.attributes().into_iter().filter_map(|(key, value)| Some((key, attribute(&value)?)));
        Ok(Contents { attributes: attributes.collect(), reader, instants, dimensions, variables })
    }

    /// Depths of the stress.
    fn depths(&self) -> usize {
        self.reader.stress().map_or(1, |set| set.depths.len())
    }

    /// Leaks.
    fn leaks(&self) -> usize {
        self.reader.leaks().map_or(0, |leaks| leaks.rows)
    }

    /// Number of maps that an instant has of a variable over the instants; of another variable, all of them.
    pub(super) fn maps_of_instant(&self, data: &Data) -> usize {
        match data {
            Data::Stress(_) => self.depths(),
            Data::FluidPressure => self.leaks(),
            _ => 1,
        }
    }

    /// The variable's map; for a field, that of the `n`th exported instant, for a stress field, of the `n`th instant and depth.
    pub(super) fn map(&self, data: &Data, n: usize) -> Result<Option<Map>> {
        Ok(match data {
            Data::Reals(_) | Data::Counts(_) => None,
            Data::InitialGap => Some(Map::Real(self.reader.initial_gap()?)),
            Data::FluidPressure => Some(Map::Real(self.reader.fluid_pressure(n)?)),
            Data::Stress(quantity) => {
                let (instant, depth) = (n / self.depths(), n % self.depths());
                let at = At::Index(self.instants.get(instant).copied().unwrap_or(usize::MAX));
                Some(Map::Real(self.reader.stress_field(*quantity, at, depth)?))
            }
            Data::Field(kind) => {
                let at = At::Index(self.instants.get(n).copied().unwrap_or(usize::MAX));
                Some(match kind {
                    FieldKind::Contact => Map::Byte(self.reader.contact(at)?),
                    kind => Map::Real(self.reader.field(*kind, at)?),
                })
            }
        })
    }

    /// Number of maps of a variable; 0 where it has none.
    pub(super) fn maps(&self, data: &Data) -> usize {
        match data {
            Data::Reals(_) | Data::Counts(_) => 0,
            Data::InitialGap => 1,
            Data::Field(_) => self.instants.len(),
            Data::Stress(_) => self.instants.len() * self.depths(),
            Data::FluidPressure => self.leaks(),
        }
    }

    pub(super) fn reader(&self) -> &Reader {
        self.reader
    }
}

impl Variable {
    /// Lengths along its dimensions.
    pub(super) fn shape(&self, contents: &Contents<'_>) -> Vec<usize> {
        self.dimensions.iter().map(|d| contents.dimensions[*d].1).collect()
    }
}

fn count(n: usize) -> i64 {
    i64::try_from(n).unwrap_or(i64::MAX)
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
