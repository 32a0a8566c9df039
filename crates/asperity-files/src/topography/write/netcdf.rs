//! Classic NetCDF (CDF-2) in the layout of contact.engineering: `heights` over x and y with the attribute `unit`,
//! the coordinates `x` and `y` with the attributes `length`, `periodic` and `unit`, and a `mask` of undefined points.

use crate::classic::{Attribute, Type, Variable, header};
use crate::topography::{Problem, Result, Topography};

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>> {
    let ([lx, ly], heights) = (topography.size, &topography.heights);
    let (nx, ny) = heights.dim();
    if [nx, ny].iter().any(|n| *n >= 1 << 31) {
        let what = format!("a NetCDF file of {nx} x {ny} points");
        return Err(Problem::unsupported(what, "write NPZ instead"));
    }
    let (mut variables, mut data) = (vec![], vec![]);
    let mut add = |name, dimensions: &[usize], attributes, kind, bytes: Vec<u8>| {
        let (dimensions, length) = (dimensions.to_vec(), bytes.len() as u64);
        variables.push(Variable { name, dimensions, attributes, kind, bytes: length, record: false });
        data.push(bytes);
    };
    let unit = || ("unit", Attribute::Text("m".into()));
    for (axis, (name, count, length)) in [("x", nx, lx), ("y", ny, ly)].into_iter().enumerate() {
        let periodic = ("periodic", Attribute::Counts(vec![0]));
        let attributes = vec![("length", Attribute::Reals(vec![length])), periodic, unit()];
        let places = (0..count).flat_map(|i| (i as f64 / count as f64 * length).to_be_bytes());
        add(name, &[axis], attributes, Type::Double, places.collect());
    }
    if heights.iter().any(|h| h.is_nan()) {
        add("mask", &[0, 1], vec![], Type::Byte, heights.iter().map(|h| u8::from(h.is_nan())).collect());
    }
    // Last: only the last variable may be longer than 4 GiB.
    let numbers = heights.iter().flat_map(|h| h.to_be_bytes()).collect();
    add("heights", &[0, 1], vec![unit()], Type::Double, numbers);
    // The name that the NetCDF conventions give it.
    let history = topography.history_line().map(|line| ("history".to_owned(), Attribute::Text(line)));
    let history: Vec<_> = history.into_iter().collect();
    let mut bytes = header(0, false, &[("x", nx), ("y", ny)], &history, &variables);
    for data in data {
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    Ok(bytes)
}
