//! Names, units, dimensions and chunks of the arrays of a result.

pub(super) use asperity::quantities::Entry;
use asperity::quantities::{Column as Quantity, Quantity as Kind};
pub use asperity::quantities::{ROW_COLUMNS as SCALARS, RowColumn as Scalar};
use asperity::step::Row;
use asperity::{Axis, Grid};
use serde_json::{Value, json};

use super::field_kind::FieldKind;
use super::header::Header;

/// Rows per chunk of the per-step arrays: 32 KiB, one file each for all but the longest runs.
pub(super) const ROWS_PER_CHUNK: usize = 4096;
/// Rows per chunk of the histograms.
const HISTOGRAMS_PER_CHUNK: usize = 256;
/// Longest side of a field's chunk: 512 KiB of doubles, enough chunks of a map for every core.
const LONGEST_SIDE: usize = 256;
/// Longest chunk of a field on a line: as many bytes.
const LONGEST_LINE: usize = LONGEST_SIDE * LONGEST_SIDE;

/// A per-step number that a result has, whether every result has it or it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Series {
    /// Its name in results.
    pub name: &'static str,
    /// Its unit; "1" where it has none.
    pub units: &'static str,
    /// What it is, for axes and legends.
    pub long_name: &'static str,
}

impl Series {
    /// A scalar of a result: on a line forces and areas are per length, and what is measured from the end of the domain says so.
    pub(super) fn of_scalar(scalar: &Scalar, header: &Header) -> Series {
        let (units, long_name) = match scalar.name {
            "time" => (header.axis().unit(), header.axis().name()),
            "approach" if header.is_up_to_a_constant() => (
                scalar.units,
                "rigid-body approach, measured from the end of the domain (known up to a constant on a free line)",
            ),
            _ => (header.grid.units(scalar.units), scalar.long_name_on(header.grid.is_line())),
        };
        Series { name: header.stored(scalar.name), units, long_name }
    }

    /// The coordinate of the fields.
    pub(crate) fn of_fields(header: &Header) -> Series {
        let (units, long_name) = match header.axis() {
            Axis::Velocity => (Axis::Velocity.unit(), "velocity of the fields"),
            Axis::Time | Axis::None => (Axis::Time.unit(), "time of the fields"),
        };
        Series { name: header.stored("field_time"), units, long_name }
    }

    /// A quantity of a result.
    pub(crate) fn of_quantity(kind: Kind, grid: &Grid) -> Series {
        Series { name: kind.name(), units: kind.units_on(grid), long_name: kind.long_name_on(grid) }
    }
}

/// The dimension of a histogram and the coordinates along it: the middles of its bins and their ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    pub(crate) middles: Series,
    pub(crate) edges: Series,
}

/// The bins of a histogram.
pub(crate) fn bins(kind: Kind) -> Option<Bins> {
    let bins = |[middles, edges]: [&'static str; 2], units, [middle, end]: [&'static str; 2]| Bins {
        middles: Series { name: middles, units, long_name: middle },
        edges: Series { name: edges, units, long_name: end },
    };
    Some(match kind {
        Kind::SpotHistogram => bins(
            ["spot_bin", "spot_edge"],
            "m2",
            ["geometric mean of the ends of a class of spots", "ends of the classes of spots"],
        ),
        Kind::PressureHistogram => bins(
            ["pressure_bin", "pressure_edge"],
            "Pa",
            ["middle of a bin of the pressure", "ends of the bins of the pressure"],
        ),
        Kind::GapHistogram => {
            bins(["gap_bin", "gap_edge"], "m", ["middle of a bin of the gap", "ends of the bins of the gap"])
        }
        _ => return None,
    })
}

/// The coordinates of a histogram, with their numbers: middles, then ends.
pub fn coordinates(column: &Quantity, grid: &Grid) -> Vec<(Series, Vec<f64>)> {
    let Some(Bins { middles: of_middles, edges: of_edges }) = bins(column.quantity) else { return vec![] };
    let on = |series: Series| Series { units: grid.units(series.units), ..series };
    let middle = |pair: &[f64]| match column.quantity {
        Kind::SpotHistogram => (pair[0] * pair[1]).sqrt(),
        _ => 0.5 * (pair[0] + pair[1]),
    };
    let middles = column.edges.windows(2).map(middle).collect();
    vec![(on(of_middles), middles), (on(of_edges), column.edges.clone())]
}

/// How a number of a row is stored.
pub(super) trait Stored {
    fn data_type(self) -> DataType;

    /// The eight bytes that stand for it in the store.
    fn to_bytes(self, row: &Row) -> [u8; 8];

    /// Sets it from those bytes; `None` where they hold no count.
    fn set(self, row: &mut Row, bytes: [u8; 8]) -> Option<()>;
}

impl Stored for Entry {
    fn data_type(self) -> DataType {
        match self {
            Entry::Coordinate | Entry::Real(_) | Entry::Maybe(_) => DataType::Float64,
            Entry::Count(_) => DataType::Int64,
        }
    }

    fn to_bytes(self, row: &Row) -> [u8; 8] {
        let mut row = *row;
        match self {
            Entry::Coordinate => row.coordinate.value().to_le_bytes(),
            Entry::Real(entry) => entry(&mut row).to_le_bytes(),
            Entry::Maybe(entry) => entry(&mut row).unwrap_or(f64::NAN).to_le_bytes(),
            Entry::Count(entry) => i64::try_from(*entry(&mut row)).unwrap_or(i64::MAX).to_le_bytes(),
        }
    }

    fn set(self, row: &mut Row, bytes: [u8; 8]) -> Option<()> {
        match self {
            Entry::Coordinate => row.coordinate = row.coordinate.axis().at(f64::from_le_bytes(bytes)),
            Entry::Real(entry) => *entry(row) = f64::from_le_bytes(bytes),
            Entry::Maybe(entry) => {
                *entry(row) = Some(f64::from_le_bytes(bytes)).filter(|number| !number.is_nan())
            }
            Entry::Count(entry) => *entry(row) = usize::try_from(i64::from_le_bytes(bytes)).ok()?,
        }
        Some(())
    }
}

/// Type of the numbers of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DataType {
    Float64,
    Int64,
    UInt8,
}

impl DataType {
    /// Bytes of a number.
    pub(super) fn width(self) -> usize {
        match self {
            DataType::Float64 | DataType::Int64 => 8,
            DataType::UInt8 => 1,
        }
    }
}

/// One array of the group.
#[derive(Clone, Debug)]
pub(super) struct ArraySpec {
    pub(super) name: &'static str,
    pub(super) data_type: DataType,
    pub(super) dimensions: &'static [&'static str],
    pub(super) shape: Vec<usize>,
    pub(super) chunk: Vec<usize>,
    pub(super) compressed: bool,
    /// Whether each chunk ends with its CRC-32C. Chunks that grow row by row have none: the group's document holds the
    /// checksum of all rows (see [`super::checksum`]).
    pub(super) summed: bool,
    pub(super) attributes: Value,
}

impl ArraySpec {
    /// A coordinate \[its unit\] along the dimension of its name.
    pub(super) fn coordinate_of(
        series: &Series,
        dimensions: &'static [&'static str],
        length: usize,
    ) -> ArraySpec {
        ArraySpec {
            name: series.name,
            data_type: DataType::Float64,
            dimensions,
            shape: vec![length],
            chunk: vec![length],
            compressed: false,
            summed: true,
            attributes: json!({"units": series.units, "long_name": series.long_name}),
        }
    }

    /// A number of each instant of the fields.
    pub(super) fn of_instants(series: &Series, maps: usize) -> ArraySpec {
        self::series(series.name, DataType::Float64, "field_time", maps, series.units, series.long_name)
    }

    /// A row of numbers of each instant.
    pub(super) fn profile_of(
        series: &Series,
        dimensions: &'static [&'static str],
        shape: [usize; 2],
    ) -> ArraySpec {
        ArraySpec {
            chunk: vec![HISTOGRAMS_PER_CHUNK, shape[1]],
            shape: shape.to_vec(),
            summed: false,
            ..ArraySpec::coordinate_of(series, dimensions, 0)
        }
    }

    /// Fields at the depths of each instant.
    pub(super) fn volume_of(
        series: &Series,
        dimensions: &'static [&'static str],
        shape: &[usize],
    ) -> ArraySpec {
        let chunk = match shape {
            [_, _, line] => vec![1, 1, of_line(*line)],
            _ => shape.iter().enumerate().map(|(n, cells)| if n < 2 { 1 } else { side(*cells) }).collect(),
        };
        ArraySpec {
            chunk,
            shape: shape.to_vec(),
            compressed: true,
            ..ArraySpec::coordinate_of(series, dimensions, 0)
        }
    }

    /// Whether it grows row by row.
    pub(super) fn grows(&self) -> bool {
        (is_of_rows(self.dimensions[0]) || is_of_maps(self.dimensions[0])) && !self.compressed
    }

    /// The same array as results of form 1 have it, without checksums.
    pub(super) fn of_form(mut self, form: u64) -> ArraySpec {
        self.summed &= form > 1;
        self
    }

    /// Metadata document (`zarr.json`) of the array, its chunks deflated with `level`.
    pub(super) fn document(&self, level: u8) -> Value {
        let mut codecs = vec![match self.data_type {
            DataType::UInt8 => json!({"name": "bytes"}),
            _ => json!({"name": "bytes", "configuration": {"endian": "little"}}),
        }];
        if self.compressed {
            codecs.push(json!({"name": "gzip", "configuration": {"level": level}}));
        }
        if self.summed {
            codecs.push(json!({"name": "crc32c"}));
        }
        // Filled with what no run produces, so that a lost chunk cannot pass for data.
        let (data_type, fill_value) = match self.data_type {
            DataType::Float64 => ("float64", json!("NaN")),
            DataType::Int64 => ("int64", json!(-1)),
            DataType::UInt8 => ("uint8", json!(255)),
        };
        json!({
            "zarr_format": 3,
            "node_type": "array",
            "shape": self.shape,
            "data_type": data_type,
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": self.chunk}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
            "fill_value": fill_value,
            "codecs": codecs,
            "attributes": self.attributes,
            "dimension_names": self.dimensions,
        })
    }
}

/// Level of the deflated chunks and of the metadata.
pub(super) const LEVEL: u8 = 1;

/// Whether a dimension is that of the rows, or that of the fields.
pub(super) fn is_of_rows(dimension: &str) -> bool {
    matches!(dimension, "time" | "velocity")
}

pub(super) fn is_of_maps(dimension: &str) -> bool {
    matches!(dimension, "field_time" | "field_velocity")
}

/// All arrays of a result with `rows` rows and `maps` instants of its fields.
pub(super) fn arrays(header: &Header, rows: usize, maps: usize) -> Vec<ArraySpec> {
    let mut arrays = over_time(header, rows, maps);
    if header.axis() == Axis::Velocity {
        for array in &mut arrays {
            array.name = header.stored(array.name);
            array.dimensions = match *array.dimensions {
                ["time"] => &["velocity"],
                ["field_time"] => &["field_velocity"],
                ["field_time", "x"] => &["field_velocity", "x"],
                ["field_time", "x", "y"] => &["field_velocity", "x", "y"],
                ["time", "spot_bin"] => &["velocity", "spot_bin"],
                ["time", "pressure_bin"] => &["velocity", "pressure_bin"],
                ["time", "gap_bin"] => &["velocity", "gap_bin"],
                _ => array.dimensions,
            };
        }
    }
    arrays
}

/// The arrays of a run in time.
fn over_time(header: &Header, rows: usize, maps: usize) -> Vec<ArraySpec> {
    let grid = &header.grid;
    let [nx, ny] = grid.cells();
    let mut arrays: Vec<_> = SCALARS
        .iter()
        .map(|s| {
            let Series { name, units, long_name } = Series::of_scalar(s, header);
            series(name, s.entry.data_type(), "time", rows, units, long_name)
        })
        .collect();
    for column in &header.quantities {
        let kind = column.quantity;
        let Series { name, units, long_name } = Series::of_quantity(kind, grid);
        match dimensions(kind) {
            None => arrays.push(series(name, DataType::Float64, "time", rows, units, long_name)),
            Some(dimensions) => {
                arrays.push(ArraySpec {
                    name,
                    data_type: DataType::Float64,
                    dimensions,
                    shape: vec![rows, column.width()],
                    chunk: vec![HISTOGRAMS_PER_CHUNK, column.width()],
                    compressed: false,
                    summed: false,
                    attributes: json!({"units": units, "long_name": long_name}),
                });
                arrays.extend(
                    coordinates(column, grid)
                        .into_iter()
                        .map(|(series, numbers)| line(&series, numbers.len())),
                );
            }
        }
    }
    let of_fields = Series::of_fields(header);
    arrays.push(series(
        "field_time",
        DataType::Float64,
        "field_time",
        maps,
        of_fields.units,
        of_fields.long_name,
    ));
    arrays.push(series("field_step", DataType::Int64, "field_time", maps, "1", "row of the fields"));
    arrays.push(coordinate("x", nx, "x, centres of the cells"));
    // Nothing changes along y of a line: it has no such dimension.
    let (shape, chunk) = match grid.is_line() {
        true => (vec![nx], vec![of_line(nx)]),
        false => (vec![nx, ny], vec![side(nx), side(ny)]),
    };
    if !grid.is_line() {
        arrays.push(coordinate("y", ny, "y, centres of the cells"));
    }
    arrays.push(ArraySpec {
        name: "initial_gap",
        data_type: DataType::Float64,
        dimensions: if grid.is_line() { &["x"] } else { &["x", "y"] },
        shape: shape.clone(),
        chunk: chunk.clone(),
        compressed: true,
        summed: true,
        attributes: json!({"units": "m", "long_name": "undeformed gap"}),
    });
    for kind in FieldKind::ALL.into_iter().filter(|kind| header.fields.contains(kind)) {
        let mut attributes = json!({"units": kind.units(), "long_name": kind.long_name()});
        if kind == FieldKind::Displacement && header.is_up_to_a_constant() {
            attributes["long_name"] = json!("normal displacement, measured from the end of the domain");
        }
        if kind == FieldKind::Contact {
            attributes["flag_values"] = json!([0, 1, 2]);
            attributes["flag_meanings"] = json!("out_of_contact in_contact at_hardness");
        }
        arrays.push(ArraySpec {
            name: kind.name(),
            data_type: if kind == FieldKind::Contact { DataType::UInt8 } else { DataType::Float64 },
            dimensions: if grid.is_line() { &["field_time", "x"] } else { &["field_time", "x", "y"] },
            shape: [&[maps], shape.as_slice()].concat(),
            chunk: [&[1], chunk.as_slice()].concat(),
            compressed: true,
            summed: true,
            attributes,
        });
    }
    arrays
}

/// Dimensions of a histogram.
fn dimensions(kind: Kind) -> Option<&'static [&'static str]> {
    Some(match kind {
        Kind::SpotHistogram => &["time", "spot_bin"],
        Kind::PressureHistogram => &["time", "pressure_bin"],
        Kind::GapHistogram => &["time", "gap_bin"],
        _ => return None,
    })
}

/// A coordinate along the dimension of its name.
fn line(series: &Series, length: usize) -> ArraySpec {
    let dimensions: &[&str] = match series.name {
        "spot_bin" => &["spot_bin"],
        "spot_edge" => &["spot_edge"],
        "pressure_bin" => &["pressure_bin"],
        "pressure_edge" => &["pressure_edge"],
        "gap_bin" => &["gap_bin"],
        _ => &["gap_edge"],
    };
    ArraySpec {
        name: series.name,
        data_type: DataType::Float64,
        dimensions,
        shape: vec![length],
        chunk: vec![length],
        compressed: false,
        summed: true,
        attributes: json!({"units": series.units, "long_name": series.long_name}),
    }
}

fn series(
    name: &'static str,
    data_type: DataType,
    dimension: &'static str,
    length: usize,
    units: &str,
    long_name: &str,
) -> ArraySpec {
    ArraySpec {
        name,
        data_type,
        dimensions: if dimension == "time" { &["time"] } else { &["field_time"] },
        shape: vec![length],
        chunk: vec![ROWS_PER_CHUNK],
        compressed: false,
        summed: false,
        attributes: json!({"units": units, "long_name": long_name}),
    }
}

fn coordinate(name: &'static str, cells: usize, long_name: &str) -> ArraySpec {
    ArraySpec {
        name,
        data_type: DataType::Float64,
        dimensions: if name == "x" { &["x"] } else { &["y"] },
        shape: vec![cells],
        chunk: vec![cells],
        compressed: false,
        summed: true,
        attributes: json!({"units": "m", "long_name": long_name}),
    }
}

/// Cells of a chunk along a line.
fn of_line(cells: usize) -> usize {
    cells.div_ceil(cells.div_ceil(LONGEST_LINE).max(1))
}

/// Side of a chunk: equal pieces no longer than [`LONGEST_SIDE`], so that little is padded.
pub(super) fn side(cells: usize) -> usize {
    cells.div_ceil(cells.div_ceil(LONGEST_SIDE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_a_side_with_less_than_one_cell_of_padding_per_chunk() {
        for cells in 1..2000 {
            let side = side(cells);
            let chunks = cells.div_ceil(side);
            assert!(side <= LONGEST_SIDE && side * chunks >= cells && side * chunks < cells + chunks);
        }
    }

    #[test]
    fn a_scalar_keeps_the_bits_of_its_row() {
        let row = Row {
            load: -0.0,
            residual: f64::NAN,
            certificate: f64::INFINITY,
            iterations: 7,
            ..Row::default()
        };
        let mut back = Row::default();
        for scalar in SCALARS {
            scalar.entry.set(&mut back, scalar.entry.to_bytes(&row)).unwrap();
        }
        assert_eq!(back.load.to_bits(), row.load.to_bits());
        assert!(back.residual.is_nan());
        assert_eq!((back.certificate, back.iterations), (f64::INFINITY, 7));
    }

    #[test]
    fn a_negative_count_is_refused() {
        let iterations = SCALARS.iter().find(|s| s.name == "iterations").unwrap();
        assert!(iterations.entry.set(&mut Row::default(), (-1i64).to_le_bytes()).is_none());
    }
}
