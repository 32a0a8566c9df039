//! Topographies into files that other programs read: NPZ, GWY, X3P, SDF, NetCDF and text.
//!
//! Every writer states size and unit (metres), keeps all digits of the heights and marks undefined points in the
//! way of the format, so that reading gives the same topography back.

pub(super) mod gwy;
pub(super) mod netcdf;
pub(super) mod npz;
pub(super) mod sdf;
pub(super) mod text;
pub(super) mod x3p;

use std::io::Write;
use std::path::Path;

use rayon::prelude::*;

use crate::output;

use super::finish::is_positive;
use super::format::list;
use super::{Format, Problem, Result, Topography, TopographyError};

/// Writes a topography into a file; an existing one is replaced. It appears whole or not at all.
///
/// # Errors
/// As [`to_bytes`], and where the file cannot be written.
pub fn write(path: &Path, topography: &Topography, format: Format) -> Result<(), TopographyError> {
    let in_file = TopographyError::at(path);
    let bytes = encode(topography, format).map_err(&in_file)?;
    output::write(path, true, |file| file.write_all(&bytes)).map_err(|e| in_file(Problem::Io(e)))
}

/// The bytes of a file that holds a topography.
///
/// ```
/// use asperity_files::topography::{Format, ReadOptions, read_bytes, to_bytes};
///
/// let text = b"# Channel: Z\n# Width: 3 um\n# Height: 2 um\n# Value units: nm\n1 2 3\n4 5 nan\n";
/// let surface = read_bytes(text, &ReadOptions::default())?;
/// let again = read_bytes(&to_bytes(&surface, Format::X3p)?, &ReadOptions::default())?;
/// assert_eq!(again.format, Format::X3p);
/// assert_eq!(again.heights[[0, 1]], 4e-9);
/// assert_eq!(again.undefined(), 1);
/// # Ok::<(), asperity_files::topography::TopographyError>(())
/// ```
///
/// # Errors
/// [`Problem::Option`] where the format is not [written](Format::is_written),
/// [`Problem::Unsupported`] where the format cannot hold so many points, [`Problem::Malformed`] where heights or
/// size are empty or no numbers.
pub fn to_bytes(topography: &Topography, format: Format) -> Result<Vec<u8>, TopographyError> {
    Ok(encode(topography, format)?)
}

fn encode(topography: &Topography, format: Format) -> Result<Vec<u8>> {
    let (nx, ny) = topography.heights.dim();
    super::grid::points(nx as u64, ny as u64)?;
    let [lx, ly] = topography.size;
    if !topography.size.into_iter().all(is_positive) {
        let value = format!("{lx:e} m x {ly:e} m");
        return Err(Problem::malformed("the physical size", value, "positive and finite"));
    }
    let encode = format.reader().write.ok_or_else(|| Problem::Option {
        what: "the format to write",
        value: format.to_string(),
        expected: format!("one of {}", list(Format::written())),
    })?;
    encode(topography)
}

/// Name of the channel, as a file states it.
fn title(topography: &Topography) -> &str {
    match topography.channel.as_deref().map(str::trim) {
        None | Some("") => "heights",
        Some(name) => name,
    }
}

/// Heights line by line (x runs fastest) as little-endian bytes, undefined points as NaN.
fn lines(topography: &Topography) -> Vec<u8> {
    let heights = &topography.heights;
    let nx = heights.nrows();
    let mut bytes = vec![0; 8 * heights.len()];
    // Several lines at once, for neighbours along y share a cache line.
    const LINES: usize = 16;
    bytes.par_chunks_mut(8 * nx * LINES).enumerate().for_each(|(block, out)| {
        for (x, column) in heights.rows().into_iter().enumerate() {
            for (y, line) in out.chunks_exact_mut(8 * nx).enumerate() {
                line[8 * x..8 * x + 8].copy_from_slice(&column[block * LINES + y].to_le_bytes());
            }
        }
    });
    bytes
}
