//! Classic NetCDF (CDF-2) in the layout of contact.engineering: `heights` over x and y with the attribute `unit`,
//! the coordinates `x` and `y` with the attributes `length`, `periodic` and `unit`, and a `mask` of undefined points.

use crate::classic::{ATTRIBUTE, Attribute, DIMENSION, Header, Type, VARIABLE, padded};
use crate::topography::{Problem, Topography};

/// A variable: its name, dimensions, attributes, type and data.
struct Variable {
    name: &'static str,
    dimensions: &'static [u64],
    attributes: Vec<(&'static str, Attribute)>,
    kind: Type,
    data: Vec<u8>,
}

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>, Problem> {
    let (nx, ny) = topography.heights.dim();
    if [nx, ny].iter().any(|n| *n >= 1 << 31) {
        let what = format!("a NetCDF file of {nx} x {ny} points");
        return Err(Problem::unsupported(what, "write NPZ instead"));
    }
    let variables = variables(topography);
    // The length of the header does not depend on the offsets in it.
    let mut begin = header(topography, &variables, &[0; 4]).len() as u64;
    let mut begins = Vec::new();
    for variable in &variables {
        begins.push(begin);
        begin += padded(variable.data.len() as u64);
    }
    let mut bytes = header(topography, &variables, &begins);
    for variable in variables {
        bytes.extend(variable.data);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    Ok(bytes)
}

fn variables(topography: &Topography) -> Vec<Variable> {
    let unit = || ("unit", Attribute::Text("m".into()));
    let coordinate = |name, dimensions, n: usize, length: f64| {
        let attributes = vec![
            ("length", Attribute::Reals(vec![length])),
            ("periodic", Attribute::Counts(vec![0])),
            unit(),
        ];
        let data = (0..n).flat_map(|i| (i as f64 / n as f64 * length).to_be_bytes()).collect();
        Variable { name, dimensions, attributes, kind: Type::Double, data }
    };
    let ([lx, ly], heights) = (topography.size, &topography.heights);
    let (nx, ny) = heights.dim();
    let mut variables = vec![coordinate("x", &[0], nx, lx), coordinate("y", &[1], ny, ly)];
    let map = |name, attributes, kind, data| Variable { name, dimensions: &[0, 1], attributes, kind, data };
    if heights.iter().any(|h| h.is_nan()) {
        let data = heights.iter().map(|h| u8::from(h.is_nan())).collect();
        variables.push(map("mask", Vec::new(), Type::Byte, data));
    }
    // Last: only the last variable may be longer than 4 GiB.
    let data = heights.iter().flat_map(|h| h.to_be_bytes()).collect();
    variables.push(map("heights", vec![unit()], Type::Double, data));
    variables
}

fn header(topography: &Topography, variables: &[Variable], begins: &[u64]) -> Vec<u8> {
    let mut header = Header::new(0, false);
    header.list(DIMENSION, 2);
    for (name, count) in ["x", "y"].iter().zip(topography.heights.shape()) {
        header.text(name);
        header.size(*count as u64);
    }
    // The name that the NetCDF conventions give it.
    let history = topography.history_line().map(Attribute::Text);
    header.list(ATTRIBUTE, usize::from(history.is_some()));
    history.iter().for_each(|line| header.attribute("history", line));
    header.list(VARIABLE, variables.len());
    for (variable, begin) in variables.iter().zip(begins) {
        header.text(variable.name);
        header.size(variable.dimensions.len() as u64);
        variable.dimensions.iter().for_each(|dimension| header.size(*dimension));
        header.list(ATTRIBUTE, variable.attributes.len());
        variable.attributes.iter().for_each(|(name, attribute)| header.attribute(name, attribute));
        header.tag(variable.kind as u32);
        // A size that 32 bits cannot hold is written as the greatest number, and readers take it from the shape.
        header.size(padded(variable.data.len() as u64));
        header.bytes.extend(begin.to_be_bytes());
    }
    header.bytes
}
