//! The formats and how to tell them apart: by content, never by the file's name.

use std::{fmt, str::FromStr};

use super::{
    al3d, bcr, compound, frt, gwy, ibw, metropro, nanoscope, netcdf, nid, opd, plu, sdf, sur, text, unpack,
};

/// A file format.
///
/// Its name, as `Display` writes it and `FromStr` takes it, is the usual ending of the file name; text matrices are
/// `asc`, Nanoscope files (whose names end in .spm or a number too) `di`, MetroPro files (.dat) `metropro`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Text matrix: one line per y, values along x.
    Text,
    /// Text matrix with values parted by commas or semicolons.
    Csv,
    /// Lines of x, y and height.
    Xyz,
    /// One NumPy array.
    Npy,
    /// Zip of NumPy arrays.
    Npz,
    /// ISO 25178-71 surface data file, text or binary.
    Sdf,
    /// BCR-STM or BCRF.
    Bcr,
    /// ISO 25178-72.
    X3p,
    /// Digital Surf (MountainsMap).
    Sur,
    /// Gwyddion.
    Gwy,
    /// Alicona Imaging.
    Al3d,
    /// Wyko.
    Opd,
    /// Digital Instruments, Veeco and Bruker Nanoscope.
    Nanoscope,
    /// Zygo MetroPro.
    MetroPro,
    /// Sensofar PLU and APX.
    Plu,
    /// MountainsMap document.
    Mnt,
    /// Igor Pro binary wave (Asylum Research).
    Ibw,
    /// Nanosurf.
    Nid,
    /// FRT MicroProf.
    Frt,
    /// NetCDF, classic or NetCDF-4.
    NetCdf,
    /// Other HDF5.
    Hdf5,
}

impl Format {
    /// Every format.
    pub const ALL: [Format; 21] = [
        Format::Text,
        Format::Csv,
        Format::Xyz,
        Format::Npy,
        Format::Npz,
        Format::Sdf,
        Format::Bcr,
        Format::X3p,
        Format::Sur,
        Format::Gwy,
        Format::Al3d,
        Format::Opd,
        Format::Nanoscope,
        Format::MetroPro,
        Format::Plu,
        Format::Mnt,
        Format::Ibw,
        Format::Nid,
        Format::Frt,
        Format::NetCdf,
        Format::Hdf5,
    ];

    /// Name of the format.
    pub fn name(self) -> &'static str {
        match self {
            Format::Text => "asc",
            Format::Csv => "csv",
            Format::Xyz => "xyz",
            Format::Npy => "npy",
            Format::Npz => "npz",
            Format::Sdf => "sdf",
            Format::Bcr => "bcr",
            Format::X3p => "x3p",
            Format::Sur => "sur",
            Format::Gwy => "gwy",
            Format::Al3d => "al3d",
            Format::Opd => "opd",
            Format::Nanoscope => "di",
            Format::MetroPro => "metropro",
            Format::Plu => "plu",
            Format::Mnt => "mnt",
            Format::Ibw => "ibw",
            Format::Nid => "nid",
            Format::Frt => "frt",
            Format::NetCdf => "nc",
            Format::Hdf5 => "h5",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let lower = name.to_ascii_lowercase();
        let lower = match lower.as_str() {
            "text" | "txt" | "matrix" => "asc",
            "bcrf" => "bcr",
            "spm" | "nanoscope" => "di",
            "dat" => "metropro",
            "apx" => "plu",
            "ezd" => "nid",
            "netcdf" => "nc",
            "hdf5" => "h5",
            other => other,
        };
        Format::ALL.into_iter().find(|f| f.name() == lower).ok_or_else(|| {
            let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
            format!("unknown topography format {name:?}; expected one of {}", names.join(", "))
        })
    }
}

/// The format of a file with this content (looking into gzip), or `None` where it is none of the known.
pub fn detect(bytes: &[u8]) -> Option<Format> {
    if unpack::is_gzip(bytes) {
        // The signatures and the first lines of text are near the start; a zip archive inside gzip is not looked for.
        return detect_plain(&unpack::gunzip_prefix(bytes, 1 << 20));
    }
    detect_plain(bytes)
}

fn detect_plain(bytes: &[u8]) -> Option<Format> {
    if bytes.starts_with(b"\x93NUMPY") {
        Some(Format::Npy)
    } else if bytes.starts_with(b"PK\x03\x04") {
        unpack::zip_format(bytes)
    } else if sur::is_sur(bytes) {
        Some(Format::Sur)
    } else if gwy::is_gwy(bytes) {
        Some(Format::Gwy)
    } else if al3d::is_al3d(bytes) {
        Some(Format::Al3d)
    } else if opd::is_opd(bytes) {
        Some(Format::Opd)
    } else if nanoscope::is_nanoscope(bytes) {
        Some(Format::Nanoscope)
    } else if metropro::is_metropro(bytes) {
        Some(Format::MetroPro)
    } else if compound::is_compound(bytes) {
        // Other documents are refused by the reader.
        Some(Format::Mnt)
    } else if ibw::is_ibw(bytes) {
        Some(Format::Ibw)
    } else if nid::is_nid(bytes) {
        Some(Format::Nid)
    } else if frt::is_frt(bytes) {
        Some(Format::Frt)
    } else if sdf::is_sdf(bytes) {
        Some(Format::Sdf)
    } else if bcr::is_bcr(bytes) {
        Some(Format::Bcr)
    } else if let Some(format) = netcdf::detect(bytes) {
        Some(format)
    } else if plu::is_plu(bytes) {
        // The least certain sign: there is no signature.
        Some(Format::Plu)
    } else {
        text::detect(bytes)
    }
}
