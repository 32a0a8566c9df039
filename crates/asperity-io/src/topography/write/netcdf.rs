//! Classic NetCDF (CDF-2) in the layout of contact.engineering: `heights` over x and y with the attribute `unit`,
//! the coordinates `x` and `y` with the attributes `length`, `periodic` and `unit`, and a `mask` of undefined points.
//!
//! The header is big-endian: lists of dimensions, attributes and variables, each variable with the offset of its
//! data. (NetCDF classic format specification, Unidata.)

use crate::topography::{Problem, Topography};

const NC_BYTE: u32 = 1;
const NC_CHAR: u32 = 2;
const NC_INT: u32 = 4;
const NC_DOUBLE: u32 = 6;
const LIST_DIMENSION: u32 = 10;
const LIST_VARIABLE: u32 = 11;
const LIST_ATTRIBUTE: u32 = 12;

/// A variable: its name, dimensions, attributes (already encoded and counted), type and data.
struct Variable {
    name: &'static str,
    dimensions: &'static [u32],
    attributes: (u32, Vec<u8>),
    kind: u32,
    data: Vec<u8>,
}

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>, Problem> {
    let (nx, ny) = topography.heights.dim();
    let [count_x, count_y] = [nx, ny].map(|n| u32::try_from(n).ok().filter(|n| *n < 1 << 31));
    let (Some(count_x), Some(count_y)) = (count_x, count_y) else {
        return Err(Problem::unsupported(
            format!("a NetCDF file of {nx} x {ny} points"),
            "write NPZ instead",
        ));
    };
    let coordinate = |name, dimensions, n: usize, length: f64| {
        let mut attributes = attribute("length", NC_DOUBLE, 1, &length.to_be_bytes());
        attributes.extend(attribute("periodic", NC_INT, 1, &0i32.to_be_bytes()));
        attributes.extend(attribute("unit", NC_CHAR, 1, b"m"));
        let data = (0..n).flat_map(|i| (i as f64 / n as f64 * length).to_be_bytes()).collect();
        Variable { name, dimensions, attributes: (3, attributes), kind: NC_DOUBLE, data }
    };
    let [lx, ly] = topography.size;
    let mut variables = vec![coordinate("x", &[0], nx, lx), coordinate("y", &[1], ny, ly)];
    let heights = &topography.heights;
    if heights.iter().any(|h| h.is_nan()) {
        let data = heights.iter().map(|h| u8::from(h.is_nan())).collect();
        variables.push(Variable {
            name: "mask",
            dimensions: &[0, 1],
            attributes: (0, Vec::new()),
            kind: NC_BYTE,
            data,
        });
    }
    // Last: only the last variable may be longer than 4 GiB.
    let data = heights.iter().flat_map(|h| h.to_be_bytes()).collect();
    let attributes = (1, attribute("unit", NC_CHAR, 1, b"m"));
    variables.push(Variable { name: "heights", dimensions: &[0, 1], attributes, kind: NC_DOUBLE, data });

    let mut bytes = b"CDF\x02".to_vec();
    words(&mut bytes, &[0, LIST_DIMENSION, 2]);
    for (dimension, count) in [("x", count_x), ("y", count_y)] {
        name(&mut bytes, dimension);
        words(&mut bytes, &[count]);
    }
    match topography.history_line() {
        // The name that the NetCDF conventions give it.
        Some(line) => {
            words(&mut bytes, &[LIST_ATTRIBUTE, 1]);
            bytes.extend(attribute(
                "history",
                NC_CHAR,
                u32::try_from(line.len()).unwrap_or(0),
                line.as_bytes(),
            ));
        }
        None => words(&mut bytes, &[0, 0]),
    }
    words(&mut bytes, &[LIST_VARIABLE, variables.len() as u32]);
    let header_length = bytes.len() + variables.iter().map(Variable::header_length).sum::<usize>();
    let mut begin = header_length as u64;
    for variable in &variables {
        variable.header(&mut bytes, begin);
        begin += padded(variable.data.len()) as u64;
    }
    for variable in variables {
        bytes.extend(variable.data);
        bytes.resize(padded(bytes.len()), 0);
    }
    Ok(bytes)
}

impl Variable {
    fn header_length(&self) -> usize {
        // Name, dimension list, attribute list, type, size, 64-bit offset.
        4 + padded(self.name.len()) + 4 + 4 * self.dimensions.len() + 8 + self.attributes.1.len() + 4 + 4 + 8
    }

    fn header(&self, bytes: &mut Vec<u8>, begin: u64) {
        name(bytes, self.name);
        words(bytes, &[self.dimensions.len() as u32]);
        words(bytes, self.dimensions);
        let (count, attributes) = &self.attributes;
        words(bytes, &[if *count == 0 { 0 } else { LIST_ATTRIBUTE }, *count]);
        bytes.extend(attributes);
        // A size that 32 bits cannot hold is written as the greatest number, and readers take it from the shape.
        let size = u32::try_from(padded(self.data.len())).unwrap_or(u32::MAX);
        words(bytes, &[self.kind, size]);
        bytes.extend(begin.to_be_bytes());
    }
}

fn attribute(label: &str, kind: u32, count: u32, value: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    name(&mut bytes, label);
    words(&mut bytes, &[kind, count]);
    bytes.extend(value);
    bytes.resize(padded(bytes.len()), 0);
    bytes
}

fn name(bytes: &mut Vec<u8>, name: &str) {
    words(bytes, &[name.len() as u32]);
    bytes.extend(name.bytes());
    bytes.resize(padded(bytes.len()), 0);
}

fn words(bytes: &mut Vec<u8>, words: &[u32]) {
    bytes.extend(words.iter().flat_map(|w| w.to_be_bytes()));
}

/// Lengths are multiples of four bytes; the file starts at one, so positions are too.
fn padded(length: usize) -> usize {
    length.next_multiple_of(4)
}
