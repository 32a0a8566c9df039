//! Names, units, dimensions and chunks of the arrays of a result.

use asperity::quantities::{Column as Quantity, Quantity as Kind};
pub use asperity::quantities::{ROW_COLUMNS as SCALARS, RowColumn as Scalar};
use asperity::{Axis, Grid};
use serde_json::{Value, json};

use super::field_kind::FieldKind;
use super::header::Header;

/// Rows per chunk of arrays with one number per row: 32 KiB, one file each for all but the longest runs.
pub(super) const ROWS_PER_CHUNK: usize = 4096;
/// Rows per chunk of arrays with several numbers per row, such as histograms.
const WIDE_ROWS_PER_CHUNK: usize = 256;
/// Longest side of a field's chunk: 512 KiB of doubles, enough chunks of a map for every core.
const LONGEST_SIDE: usize = 256;
/// Longest chunk of a field on a line: as many bytes.
const LONGEST_LINE: usize = LONGEST_SIDE * LONGEST_SIDE;
/// Level of the deflated chunks and of the metadata.
pub(super) const LEVEL: u8 = 1;

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
    pub(super) const fn new(name: &'static str, units: &'static str, long_name: &'static str) -> Series {
        Series { name, units, long_name }
    }

    /// A scalar of a result. On a line, forces and areas are per length; a length that is measured from the end of the domain
    /// says so.
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
    fn of_fields(header: &Header) -> Series {
        let (units, long_name) = match header.axis() {
            Axis::Velocity => (Axis::Velocity.unit(), "velocity of the fields"),
            Axis::Time | Axis::None => (Axis::Time.unit(), "time of the fields"),
        };
        Series { name: header.stored("field_time"), units, long_name }
    }

    /// A quantity of a result.
    pub(super) fn of_quantity(kind: Kind, grid: &Grid) -> Series {
        Series { name: kind.name(), units: kind.units_on(grid), long_name: kind.long_name_on(grid) }
    }

    /// What a quantity of a result has one number of in each row: itself, its components, or nothing.
    pub(super) fn of_numbers(kind: Kind, grid: &Grid) -> Vec<Series> {
        let whole = Series::of_quantity(kind, grid);
        match kind.components() {
            Some(parts) => parts.map(|[name, long_name]| Series { name, long_name, ..whole }).to_vec(),
            None if kind.is_histogram() => vec![],
            None => vec![whole],
        }
    }

    fn of_field(kind: FieldKind, header: &Header) -> Series {
        let long_name = match kind {
            FieldKind::Displacement if header.is_up_to_a_constant() => {
                "normal displacement, measured from the end of the domain"
            }
            _ => kind.long_name(),
        };
        Series { name: kind.name(), units: kind.units(), long_name }
    }
}

/// The coordinates along the bins of each histogram: the middles of the bins, which name its dimension, and their ends.
pub(super) const BINS: [(Kind, [Series; 2]); 3] = [
    (
        Kind::SpotHistogram,
        [
            Series::new("spot_bin", "m2", "geometric mean of the ends of a class of spots"),
            Series::new("spot_edge", "m2", "ends of the classes of spots"),
        ],
    ),
    (
        Kind::PressureHistogram,
        [
            Series::new("pressure_bin", "Pa", "middle of a bin of the pressure"),
            Series::new("pressure_edge", "Pa", "ends of the bins of the pressure"),
        ],
    ),
    (
        Kind::GapHistogram,
        [
            Series::new("gap_bin", "m", "middle of a bin of the gap"),
            Series::new("gap_edge", "m", "ends of the bins of the gap"),
        ],
    ),
];

/// The coordinate along the components of a vector.
pub(super) const AXIS: Series = Series::new("axis", "1", "0 along x, 1 along y");

/// The coordinates of a histogram with their numbers, middles, then ends; of a vector its axes. Another quantity has none.
pub fn coordinates(column: &Quantity, grid: &Grid) -> Vec<(Series, Vec<f64>)> {
    if column.quantity.components().is_some() {
        return vec![(AXIS, vec![0.0, 1.0])];
    }
    let Some((_, series)) = BINS.iter().find(|(kind, _)| *kind == column.quantity) else { return vec![] };
    let middle = |pair: &[f64]| match column.quantity {
        Kind::SpotHistogram => (pair[0] * pair[1]).sqrt(),
        _ => 0.5 * (pair[0] + pair[1]),
    };
    let numbers = [column.edges.windows(2).map(middle).collect(), column.edges.clone()];
    let on_grid = series.map(|series| Series { units: grid.units(series.units), ..series });
    on_grid.into_iter().zip(numbers).collect()
}

/// Type of the numbers of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DataType {
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

    /// The eight bytes of a number in the store.
    pub(super) fn to_bytes(self, number: f64) -> [u8; 8] {
        match self {
            DataType::Int64 => (number as i64).to_le_bytes(),
            _ => number.to_le_bytes(),
        }
    }

    /// The inverse of [`to_bytes`](Self::to_bytes).
    pub(super) fn number(self, bytes: [u8; 8]) -> f64 {
        match self {
            DataType::Int64 => i64::from_le_bytes(bytes) as f64,
            _ => f64::from_le_bytes(bytes),
        }
    }
}

/// How the numbers of an array lie in its files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Storage {
    /// Written once, as one chunk.
    Whole,
    /// Grows by one row at a time. Its chunks have no checksum: the group's document holds that of all rows (see
    /// [`super::checksum`]).
    Rows,
    /// Maps of the grid, compressed.
    Maps,
}

/// One array of the group.
#[derive(Clone, Debug)]
pub(crate) struct ArraySpec {
    pub(crate) series: Series,
    pub(crate) data_type: DataType,
    /// Names and lengths of its dimensions.
    pub(crate) dimensions: Vec<(&'static str, usize)>,
    pub(crate) storage: Storage,
    /// Whether each chunk ends with its CRC-32C.
    pub(super) summed: bool,
}

impl ArraySpec {
    pub(super) fn new(series: Series, storage: Storage, dimensions: &[(&'static str, usize)]) -> ArraySpec {
        ArraySpec {
            series,
            data_type: DataType::Float64,
            dimensions: dimensions.to_vec(),
            storage,
            summed: storage != Storage::Rows,
        }
    }

    /// The same array with numbers of another type.
    pub(super) fn of_type(self, data_type: DataType) -> ArraySpec {
        ArraySpec { data_type, ..self }
    }

    /// The same array as results of form 1 have it, without checksums.
    pub(super) fn of_form(mut self, form: u64) -> ArraySpec {
        self.summed &= form > 1;
        self
    }

    pub(crate) fn name(&self) -> &'static str {
        self.series.name
    }

    /// Lengths along its dimensions.
    pub(super) fn shape(&self) -> Vec<usize> {
        self.dimensions.iter().map(|(_, length)| *length).collect()
    }

    /// Lengths of a chunk.
    pub(super) fn chunk(&self) -> Vec<usize> {
        let is_line = !self.dimensions.iter().any(|(name, _)| *name == "y");
        let rows = if self.dimensions.len() == 1 { ROWS_PER_CHUNK } else { WIDE_ROWS_PER_CHUNK };
        let length = |(n, (name, cells)): (usize, &(&str, usize))| match (self.storage, *name) {
            (Storage::Whole, _) => (*cells).max(1),
            (Storage::Rows, _) if n == 0 => rows,
            (Storage::Rows, _) => *cells,
            (Storage::Maps, "x") if is_line => pieces(*cells, LONGEST_LINE),
            (Storage::Maps, "x" | "y") => pieces(*cells, LONGEST_SIDE),
            (Storage::Maps, _) => 1,
        };
        self.dimensions.iter().enumerate().map(length).collect()
    }

    /// Metadata document (`zarr.json`) of the array.
    pub(super) fn document(&self) -> Value {
        let mut codecs = vec![match self.data_type {
            DataType::UInt8 => json!({"name": "bytes"}),
            _ => json!({"name": "bytes", "configuration": {"endian": "little"}}),
        }];
        if self.storage == Storage::Maps {
            codecs.push(json!({"name": "gzip", "configuration": {"level": LEVEL}}));
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
        let mut attributes = json!({"units": self.series.units, "long_name": self.series.long_name});
        if self.data_type == DataType::UInt8 {
            attributes["flag_values"] = json!([0, 1, 2, 3]);
            attributes["flag_meanings"] = json!("out_of_contact in_contact at_hardness slipping");
        }
        let dimensions: Vec<_> = self.dimensions.iter().map(|(name, _)| *name).collect();
        let (shape, chunk) = (self.shape(), self.chunk());
        array_document([&shape, &chunk], (data_type, fill_value), codecs, attributes, &dimensions)
    }
}

/// The metadata document of an array of these lengths, in chunks of those, with numbers of a type and what lost ones are filled with.
pub(crate) fn array_document(
    [shape, chunk]: [&[usize]; 2],
    (data_type, fill_value): (&str, Value),
    codecs: Vec<Value>,
    attributes: Value,
    dimensions: &[impl AsRef<str>],
) -> Value {
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": shape,
        "data_type": data_type,
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": fill_value,
        "codecs": codecs,
        "attributes": attributes,
        "dimension_names": dimensions.iter().map(AsRef::as_ref).collect::<Vec<_>>(),
    })
}

/// The dimensions of a map and their lengths. Nothing changes along y of a line: it has no such dimension.
pub(super) fn cells(grid: &Grid) -> Vec<(&'static str, usize)> {
    ["x", "y"].into_iter().zip(grid.cells()).take(grid.dimensions()).collect()
}

/// All arrays of a result with `rows` rows and `maps` instants of its fields, except those of stress and leakage.
pub(super) fn arrays(header: &Header, rows: usize, maps: usize) -> Vec<ArraySpec> {
    let grid = &header.grid;
    let [row, map] = [(header.stored("time"), rows), (header.stored("field_time"), maps)];
    let cells = cells(grid);
    let mut arrays = vec![];
    for scalar in &SCALARS {
        let data_type = if scalar.is_count() { DataType::Int64 } else { DataType::Float64 };
        let series = Series::of_scalar(scalar, header);
        arrays.push(ArraySpec::new(series, Storage::Rows, &[row]).of_type(data_type));
    }
    for column in &header.quantities {
        let coordinates = coordinates(column, grid);
        let bins = coordinates.first().map(|(series, middles)| (series.name, middles.len()));
        let over: Vec<_> = [row].into_iter().chain(bins).collect();
        arrays.push(ArraySpec::new(Series::of_quantity(column.quantity, grid), Storage::Rows, &over));
        for (series, numbers) in coordinates {
            // Vectors share their axes.
            if !arrays.iter().any(|array: &ArraySpec| array.name() == series.name) {
                arrays.push(ArraySpec::new(series, Storage::Whole, &[(series.name, numbers.len())]));
            }
        }
    }
    arrays.push(ArraySpec::new(Series::of_fields(header), Storage::Rows, &[map]));
    let step = Series::new("field_step", "1", "row of the fields");
    arrays.push(ArraySpec::new(step, Storage::Rows, &[map]).of_type(DataType::Int64));
    for (along, long_name) in cells.iter().zip(["x, centres of the cells", "y, centres of the cells"]) {
        arrays.push(ArraySpec::new(Series::new(along.0, "m", long_name), Storage::Whole, &[*along]));
    }
    arrays.push(ArraySpec::new(Series::new("initial_gap", "m", "undeformed gap"), Storage::Maps, &cells));
    for kind in FieldKind::ALL.into_iter().filter(|kind| header.fields.contains(kind)) {
        let over = [&[map], cells.as_slice()].concat();
        let field = ArraySpec::new(Series::of_field(kind, header), Storage::Maps, &over);
        arrays.push(field.of_type(kind.data_type()));
    }
    arrays
}

/// Length of the pieces that a side of so many cells is cut into: all about equal, so that little is padded.
fn pieces(cells: usize, longest: usize) -> usize {
    cells.div_ceil(cells.div_ceil(longest).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Row;

    #[test]
    fn chunks_cover_a_side_with_less_than_one_cell_of_padding_per_chunk() {
        for cells in 1..2000 {
            let side = pieces(cells, LONGEST_SIDE);
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
            let data_type = if scalar.is_count() { DataType::Int64 } else { DataType::Float64 };
            scalar.set(&mut back, data_type.number(data_type.to_bytes(scalar.of(&row))));
        }
        assert_eq!(back.load.to_bits(), row.load.to_bits());
        assert!(back.residual.is_nan());
        assert_eq!((back.certificate, back.iterations), (f64::INFINITY, 7));
    }
}
