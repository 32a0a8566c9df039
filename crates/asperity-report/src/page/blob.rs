//! Maps as bytes of a page: 16-bit numbers between the ends of the map, packed.
//!
//! ```text
//! f64 min, f64 max, u32 nx, u32 ny        little-endian
//! deflate (zlib) of nx ny high bytes, then nx ny low bytes, of
//!     d_ij = q_ij - q_i,j-1 modulo 2^16,  q_i,-1 = 0
//!     q = 65534 (v - min)/(max - min), rounded; 65535 where v is undefined
//! ```

use flate2::Compression;
use flate2::write::ZlibEncoder;
use ndarray::ArrayView2;
use std::io::Write;

use crate::figure::extent;

const UNDEFINED: u16 = u16::MAX;
const HIGHEST: f64 = 65534.0;

/// A map of finite and undefined values.
pub(super) fn packed(values: ArrayView2<f64>) -> Vec<u8> {
    let ends = extent(values.iter().copied());
    let [min, max] = if ends[0] <= ends[1] { ends } else { [0.0; 2] };
    let step = (max - min) / HIGHEST;
    let (nx, ny) = values.dim();
    let mut planes = vec![0; 2 * nx * ny];
    let (high, low) = planes.split_at_mut(nx * ny);
    let mut n = 0;
    for row in values.rows() {
        let mut last = 0u16;
        for v in row {
            let level = match v.is_finite() {
                false => UNDEFINED,
                true if step > 0.0 => ((v - min) / step).round().clamp(0.0, HIGHEST) as u16,
                true => 0,
            };
            [high[n], low[n]] = level.wrapping_sub(last).to_be_bytes();
            last = level;
            n += 1;
        }
    }
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes();
    let mut bytes = [min.to_le_bytes().as_slice(), &max.to_le_bytes(), &side(nx), &side(ny)].concat();
    let mut encoder = ZlibEncoder::new(&mut bytes, Compression::default());
    // Writing to memory cannot fail.
    let _ = encoder.write_all(&planes).and_then(|()| encoder.finish().map(drop));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn a_packed_map_reads_back_to_a_step_of_its_range() {
        let values = ndarray::Array2::from_shape_fn((5, 7), |(i, j)| match (i, j) {
            (2, 3) => f64::INFINITY,
            _ => -1.0 + (i * 7 + j) as f64 * 0.3,
        });
        let bytes = packed(values.view());
        let number = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
        let [min, max] = [number(0), number(8)];
        assert_eq!([min, max], extent(values.iter().copied()));
        assert_eq!(bytes[16..24], [5, 0, 0, 0, 7, 0, 0, 0]);
        let mut planes = Vec::new();
        flate2::read::ZlibDecoder::new(&bytes[24..]).read_to_end(&mut planes).unwrap();
        for i in 0..5 {
            let mut level = 0u16;
            for j in 0..7 {
                let n = i * 7 + j;
                level = level.wrapping_add(u16::from_be_bytes([planes[n], planes[35 + n]]));
                let value = min + f64::from(level) * (max - min) / HIGHEST;
                match values[[i, j]] {
                    v if v.is_finite() => assert!((value - v).abs() <= (max - min) / HIGHEST),
                    _ => assert_eq!(level, UNDEFINED),
                }
            }
        }
    }

    #[test]
    fn maps_without_range_or_values_pack() {
        for value in [0.0, 3.0, f64::NAN] {
            assert!(packed(ndarray::Array2::from_elem((3, 2), value).view()).len() > 24);
        }
    }
}
