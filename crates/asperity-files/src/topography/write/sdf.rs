//! ISO 25178-71 SDF, binary, with heights in metres as binary64; undefined points are NaN.
//!
//! Version 1.0 counts up to 65535 points along x and y, version 2.0 up to 2^32 - 1.

use super::lines;
use crate::topography::{Problem, Result, Topography};

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>> {
    let (nx, ny) = topography.heights.dim();
    let [lx, ly] = topography.size;
    let narrow = u16::try_from(nx).ok().zip(u16::try_from(ny).ok());
    let mut bytes = Vec::with_capacity(96 + 8 * nx * ny);
    bytes.extend(if narrow.is_some() { b"bISO-1.0" } else { b"bISO-2.0" });
    // Manufacturer; creation and change, "DDMMYYYYhhmm", zeros where they are not known.
    bytes.extend(b"asperity  000000000000000000000000");
    match narrow {
        Some((nx, ny)) => bytes.extend([nx.to_le_bytes(), ny.to_le_bytes()].concat()),
        None => {
            for count in [nx, ny] {
                let count = u32::try_from(count).map_err(|_| {
                    Problem::unsupported(format!("an SDF file of {nx} x {ny} points"), "write NPZ instead")
                })?;
                bytes.extend(count.to_le_bytes());
            }
        }
    }
    // Scales in metres; the resolution of the instrument is not known (negative).
    for scale in [lx / nx as f64, ly / ny as f64, 1.0, -1.0] {
        bytes.extend(scale.to_le_bytes());
    }
    const COMPRESSION_NONE: u8 = 0;
    const DATA_TYPE_BINARY64: u8 = 7;
    const CHECK_NONE: u8 = 0;
    bytes.extend([COMPRESSION_NONE, DATA_TYPE_BINARY64, CHECK_NONE]);
    bytes.extend(lines(topography));
    Ok(bytes)
}
