//! Gwyddion GWY: one channel in metres. Gwyddion knows no undefined heights: masked points have the mean height.

use super::title;
use crate::topography::{HISTORY, Problem, Result, Topography};

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>> {
    let (nx, ny) = topography.heights.dim();
    let too_large = || Problem::unsupported(format!("a GWY file of {nx} x {ny} points"), "write NPZ instead");
    let container = container(topography).ok_or_else(too_large)?;
    let mut bytes = b"GWYP".to_vec();
    named(&mut bytes, "GwyContainer", &container).ok_or_else(too_large)?;
    Ok(bytes)
}

/// The contents of the file; `None` where a length needs more than 32 bits.
fn container(topography: &Topography) -> Option<Vec<u8>> {
    let mut container = Vec::new();
    string(&mut container, "/0/data/title", title(topography));
    let defined = topography.heights.iter().filter(|h| !h.is_nan());
    let mean = defined.clone().sum::<f64>() / (defined.count().max(1) as f64);
    let heights = field(topography, |h| if h.is_nan() { mean } else { h }, "m")?;
    object(&mut container, "/0/data", "GwyDataField", &heights)?;
    if topography.heights.iter().any(|h| h.is_nan()) {
        let mask = field(topography, |h| f64::from(u8::from(h.is_nan())), "")?;
        object(&mut container, "/0/mask", "GwyDataField", &mask)?;
    }
    if let Some(history) = topography.history_line() {
        let mut meta = Vec::new();
        string(&mut meta, HISTORY, &history);
        object(&mut container, "/0/meta", "GwyContainer", &meta)?;
    }
    Some(container)
}

/// Components of a GwyDataField.
fn field(topography: &Topography, value: impl Fn(f64) -> f64, unit: &str) -> Option<Vec<u8>> {
    let (nx, ny) = topography.heights.dim();
    let [lx, ly] = topography.size;
    let mut bytes = Vec::with_capacity(256 + 8 * nx * ny);
    for (name, count) in [("xres", nx), ("yres", ny)] {
        component(&mut bytes, name, b'i');
        bytes.extend(i32::try_from(count).ok()?.to_le_bytes());
    }
    for (name, length) in [("xreal", lx), ("yreal", ly), ("xoff", 0.0), ("yoff", 0.0)] {
        component(&mut bytes, name, b'd');
        bytes.extend(length.to_le_bytes());
    }
    for (name, unit) in [("si_unit_xy", "m"), ("si_unit_z", unit)] {
        let mut label = Vec::new();
        string(&mut label, "unitstr", unit);
        object(&mut bytes, name, "GwySIUnit", &label)?;
    }
    component(&mut bytes, "data", b'D');
    bytes.extend(u32::try_from(nx * ny).ok()?.to_le_bytes());
    for line in topography.heights.columns() {
        for height in line {
            bytes.extend(value(*height).to_le_bytes());
        }
    }
    Some(bytes)
}

fn component(bytes: &mut Vec<u8>, name: &str, kind: u8) {
    // A zero would end the name.
    bytes.extend(name.bytes().filter(|b| *b != 0));
    bytes.extend([0, kind]);
}

fn string(bytes: &mut Vec<u8>, name: &str, text: &str) {
    component(bytes, name, b's');
    bytes.extend(text.bytes().filter(|b| *b != 0));
    bytes.push(0);
}

fn object(bytes: &mut Vec<u8>, name: &str, kind: &str, content: &[u8]) -> Option<()> {
    component(bytes, name, b'o');
    named(bytes, kind, content)
}

/// Type, length and content of an object; `None` where the length needs more than 32 bits.
fn named(bytes: &mut Vec<u8>, kind: &str, content: &[u8]) -> Option<()> {
    bytes.extend(kind.bytes());
    bytes.push(0);
    bytes.extend(u32::try_from(content.len()).ok()?.to_le_bytes());
    bytes.extend(content);
    Some(())
}
