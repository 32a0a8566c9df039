//! Measured topographies: heights over a rectangle, from the files of instruments and programs.
//!
//! [`read`] finds the format from the content and gives heights in metres on a grid with axis 0 = x, undefined
//! points as NaN, the physical size in metres, and what else the file says. Size and unit are never guessed: where
//! a file does not state them, the error asks for them by name.
//!
//! [`Format`] lists what is read; the table of the readers follows the modules. Every format may be packed by gzip.
//! Profiles along a line, two columns of text, are read by [`read_profile`].

mod al3d;
mod bcr;
pub(crate) mod compound;
mod cursor;
mod entries;
mod error;
mod finish;
mod foreign;
mod format;
mod frt;
mod grid;
mod groups;
mod gsf;
mod gwy;
mod ibw;
mod metropro;
mod mnt;
mod nanoscope;
mod netcdf;
mod nid;
mod npy;
mod opd;
mod plu;
mod profile;
mod request;
mod sample;
mod sdf;
mod sur;
mod text;
mod unit;
mod unpack;
mod write;
mod x3p;

use std::io::Read;
use std::path::Path;

use ndarray::Array2;

use error::Result;
pub use error::{Problem, TopographyError};
pub use format::detect;
pub use nanoscope::curves::{
    Calibration, InstrumentCurve, Place, holds_curves, read_curve_file, read_curves,
};
pub use profile::{Profile, profile_of, read_profile};
pub use write::{to_bytes, write};

use crate::resources;
use finish::finish;
use format::{Reader, formats};
use request::Request;
pub(crate) use text::{dialect, is_numbers, leading_number, to_text};

formats! {
    /// A file format.
    ///
    /// Its name, as `Display` writes it and `FromStr` takes it, is the usual ending of the file name; text matrices are
    /// `asc`, Nanoscope files (whose names end in .spm or a number too) `di`, MetroPro files (.dat) `metropro`.
    ///
    /// The order is that in which the formats are looked for: those with a signature first.
    pub enum Format;

    /// One NumPy array.
    Npy: npy::NPY;
    /// ISO 25178-72.
    X3p: x3p::X3P;
    /// Zip of NumPy arrays.
    Npz: npy::NPZ;
    /// Digital Surf (MountainsMap).
    Sur: sur::SUR;
    /// Gwyddion.
    Gwy: gwy::GWY;
    /// Gwyddion simple field.
    Gsf: gsf::GSF;
    /// Alicona Imaging.
    Al3d: al3d::AL3D;
    /// Wyko.
    Opd: opd::OPD;
    /// Digital Instruments, Veeco and Bruker Nanoscope.
    Nanoscope: nanoscope::NANOSCOPE;
    /// Zygo MetroPro.
    MetroPro: metropro::METROPRO;
    /// MountainsMap document.
    Mnt: mnt::MNT;
    /// Igor Pro binary wave (Asylum Research).
    Ibw: ibw::IBW;
    /// Nanosurf.
    Nid: nid::NID;
    /// FRT MicroProf.
    Frt: frt::FRT;
    /// ISO 25178-71 surface data file, text or binary.
    Sdf: sdf::SDF;
    /// BCR-STM or BCRF.
    Bcr: bcr::BCR;
    /// NetCDF, classic or NetCDF-4.
    NetCdf: netcdf::NETCDF;
    /// Other HDF5.
    Hdf5: netcdf::HDF5;
    /// Sensofar PLU and APX.
    Plu: plu::PLU;
    /// Lines of x, y and height.
    Xyz: text::XYZ;
    /// Text matrix with values parted by commas or semicolons.
    Csv: text::CSV;
    /// Text matrix: one line per y, values along x.
    Text: text::TEXT;
}

/// Heights over a rectangle, with what the file says about them.
///
/// Point (i, j) stands for the cell with its centre at ((i + 1/2) Lx/nx, (j + 1/2) Ly/ny).
#[derive(Clone, Debug)]
pub struct Topography {
    /// Where it came from.
    pub format: Format,
    /// Heights \[m\], shape (nx, ny), axis 0 = x, C order; NaN where the file says that there is no value.
    pub heights: Array2<f64>,
    /// Physical size \[Lx, Ly\] in metres.
    pub size: [f64; 2],
    /// Name of the channel, where the file names it.
    pub channel: Option<String>,
    /// Names of all channels, in the order of the file. Those that are no lengths can be read with a `height_unit`.
    pub channels: Vec<String>,
    /// What else the file says (instrument, date, comment, ...), in the order of the file.
    pub metadata: Vec<(String, String)>,
}

impl Topography {
    /// Number of undefined points.
    pub fn undefined(&self) -> usize {
        self.heights.iter().filter(|h| h.is_nan()).count()
    }

    /// The steps by which the heights were changed since they were measured or made, from the file and [`record`](Self::record).
    pub fn history(&self) -> impl Iterator<Item = &str> {
        let entries = self.metadata.iter().filter(|(key, _)| key.eq_ignore_ascii_case(HISTORY));
        entries
            .flat_map(|(_, steps)| steps.split(BETWEEN_STEPS).map(str::trim).filter(|step| !step.is_empty()))
    }

    /// Notes steps in the history; [`write()`](fn@write) keeps it in the formats that can hold it (all but SDF).
    ///
    /// ```
    /// use asperity_files::topography::{Format, ReadOptions, read_bytes, to_bytes};
    ///
    /// let file = b"# Width: 2 um\n# Height: 2 um\n# Value units: nm\n1 2\n4 5\n";
    /// let mut surface = read_bytes(file, &ReadOptions::default())?;
    /// surface.record(["invert".to_owned(), "flip along x".to_owned()]);
    /// let again = read_bytes(&to_bytes(&surface, Format::Npz)?, &ReadOptions::default())?;
    /// assert_eq!(again.history().collect::<Vec<_>>(), ["invert", "flip along x"]);
    /// # Ok::<(), asperity_files::topography::TopographyError>(())
    /// ```
    pub fn record(&mut self, steps: impl IntoIterator<Item = String>) {
        let all: Vec<String> = self.history().map(str::to_owned).chain(steps).collect();
        self.metadata.retain(|(key, _)| !key.eq_ignore_ascii_case(HISTORY));
        if !all.is_empty() {
            self.metadata.push((HISTORY.to_owned(), all.join(BETWEEN_STEPS)));
        }
    }

    /// The history as one line; `None` without a history.
    fn history_line(&self) -> Option<String> {
        // A line break would end the entry in a text file.
        let steps: Vec<String> = self.history().map(|step| step.replace(['\n', '\r'], " ")).collect();
        (!steps.is_empty()).then(|| steps.join(BETWEEN_STEPS))
    }
}

/// Key of the history among the metadata.
const HISTORY: &str = "History";
const BETWEEN_STEPS: &str = "; ";

/// What the caller knows about a file.
///
/// The defaults take everything from the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Physical size \[Lx, Ly\] in metres; replaces that of the file. Default: the file's.
    pub size: Option<[f64; 2]>,
    /// Metres per unit of the heights; replaces that of the file. Where a file gives lateral coordinates without a
    /// unit and `size` is not given either, it is their unit too. Default: the file's.
    pub height_unit: Option<f64>,
    /// Name (any case) or number (from 0, in the order of [`Topography::channels`]) of the channel. Default: the
    /// first that holds heights.
    pub channel: Option<String>,
    /// Format. Default: found from the content.
    pub format: Option<Format>,
}

/// Reads a topography from a file.
///
/// # Errors
/// [`TopographyError`] with the path: no access, an unknown, broken or truncated file, no such channel, or a size or
/// unit that neither the file nor `options` state.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Topography, TopographyError> {
    let bytes = bytes_of(path, options).map_err(TopographyError::at(path))?;
    parse(&bytes, options).map_err(TopographyError::at(path))
}

/// Bytes at the start of a file that are enough to find its format.
const HEAD: u64 = 1 << 20;
/// Memory that reading takes, per byte of the file: the file, its numbers, and their copy on the grid.
const MEMORY_PER_BYTE: u64 = 3;

/// The bytes of a file. A large file is read whole only if its start is that of a known format and there is enough memory.
fn bytes_of(path: &Path, options: &ReadOptions) -> Result<Vec<u8>> {
    let mut file = resources::open(path)?;
    let length = file.metadata()?.len();
    let mut bytes = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < HEAD {
        return Ok(bytes);
    }
    if options.format.is_none() && detect(&bytes).is_none() && !foreign::is_known_by_end(&bytes) {
        return Err(foreign::unread(&bytes));
    }
    resources::check_memory("the contents of the file", length.saturating_mul(MEMORY_PER_BYTE))
        .map_err(Problem::TooLarge)?;
    bytes.reserve_exact(usize::try_from(length.saturating_sub(HEAD)).unwrap_or(0));
    // The file may grow meanwhile: no more is read than the length above.
    file.take(length.saturating_sub(HEAD)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a topography from the bytes of a file; see [`read`].
///
/// ```
/// use asperity_files::topography::{read_bytes, ReadOptions};
///
/// let file = b"# Channel: Z\n# Width: 3 um\n# Height: 2 um\n# Value units: nm\n1 2 3\n4 5 nan\n";
/// let surface = read_bytes(file, &ReadOptions::default())?;
/// assert_eq!(surface.heights.dim(), (3, 2));
/// assert_eq!(surface.heights[[1, 0]], 2e-9); // axis 0 = x runs along a line of the file
/// assert_eq!(surface.size, [3e-6, 2e-6]);
/// assert_eq!(surface.undefined(), 1);
/// # Ok::<(), asperity_files::topography::TopographyError>(())
/// ```
///
/// # Errors
/// As [`read`], without a path.
pub fn read_bytes(bytes: &[u8], options: &ReadOptions) -> Result<Topography, TopographyError> {
    Ok(parse(bytes, options)?)
}

fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Topography> {
    let unpacked = unpack::gunzip(bytes)?;
    let bytes = unpacked.as_deref().unwrap_or(bytes);
    let format = match options.format {
        Some(format) => format,
        None => detect(bytes).ok_or_else(|| foreign::unread(bytes))?,
    };
    let channel = options.channel.as_deref();
    let request = Request { format, channel, insists: options.format.is_some() };
    let measured = (format.reader().read)(bytes, &request)?;
    if let Some(wanted) = channel
        && measured.channels.is_empty()
        && wanted != "0"
    {
        return Err(Problem::NoChannel { wanted: wanted.into(), available: Vec::new() });
    }
    finish(format, measured, options)
}
