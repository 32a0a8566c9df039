//! Results in the formats of other programs.
//!
//! | format | opened by | holds |
//! |---|---|---|
//! | [`Format::NetCdf`] | xarray, ncview, scipy | everything; classic NetCDF with 64-bit offsets |
//! | [`Format::Hdf5`] | h5py, MATLAB, xarray | everything, with dimension scales |
//! | [`Format::Npz`] | numpy | everything; attributes as JSON text |
//! | [`Format::Vtk`] | ParaView | fields over time: a `.pvd` file and a directory of `.vti` files |
//! | [`Format::Csv`] | spreadsheets | the numbers of steps, stress and leaks; chosen fields as matrices |
//!
//! Numbers keep their bits (CSV: the shortest text that reads back to them). Fields go through memory one map
//! at a time. A file appears whole or not at all.

mod contents;
mod csv;
mod error;
mod frame;
mod hdf5;
mod netcdf;
mod npz;
mod volume;
mod vtk;

use std::path::{Path, PathBuf};

pub use error::{ExportError, Result};
pub use volume::volume;

use serde::Deserialize;

use crate::choice;
use crate::output::{self, PartialFile};
use crate::store::{At, FieldKind, Leaks, Reader, StoreError};
use contents::Contents;

/// A format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Classic NetCDF with 64-bit offsets, or the 64-bit data form where a map exceeds 4 GiB.
    NetCdf,
    /// HDF5.
    Hdf5,
    /// Numpy's zip of arrays.
    Npz,
    /// VTK image data with a ParaView collection.
    Vtk,
    /// Comma-separated values.
    Csv,
}

/// What of a result is exported.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Options {
    /// Fields; `None` for those that the result holds (CSV: for none).
    pub fields: Option<Vec<FieldKind>>,
    /// Instants of the fields; `None` for all.
    pub instants: Option<Vec<At>>,
    /// Whether an output that exists is replaced.
    pub force: bool,
}

impl Format {
    /// Every format.
    pub const ALL: [Format; 5] = [Format::NetCdf, Format::Hdf5, Format::Npz, Format::Vtk, Format::Csv];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        choice::word(&self)
    }

    /// The format of that name.
    pub fn from_name(name: &str) -> Option<Format> {
        choice::parse(name)
    }

    /// What of the stress and the leakage of a result it does not hold, as a sentence; `None` where it holds all.
    pub fn left_out(self, reader: &Reader) -> Option<String> {
        const VOLUME: &str = "the stress below the surface (asperity stress RESULT -o VOLUME.vtr writes it)";
        let fields: Vec<_> =
            reader.stress().iter().flat_map(|set| set.fields()).map(|field| field.1.name).collect();
        let pressure = reader.leaks().is_some_and(Leaks::has_pressure);
        let absent = match self {
            Format::Vtk => {
                [reader.stress().map(|_| VOLUME.to_owned()), reader.leaks().map(|_| "the leakage".to_owned())]
            }
            Format::Csv => [
                (!fields.is_empty()).then(|| format!("the stress fields {}", fields.join(", "))),
                pressure.then(|| "the field fluid_pressure".to_owned()),
            ],
            _ => [None, None],
        };
        let absent = absent.into_iter().flatten().reduce(|first, second| format!("{first} and {second}"))?;
        Some(format!("{} does not hold {absent}; netcdf, hdf5 and npz do", self.name()))
    }

    /// The usual ending of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Format::NetCdf => "nc",
            Format::Hdf5 => "h5",
            Format::Npz => "npz",
            Format::Vtk => "pvd",
            Format::Csv => "csv",
        }
    }
}

/// Exports a result to `path`; returns the files and directories made.
///
/// VTK makes the collection `path` and a directory beside it, named as `path` without its ending, for
/// `pressure_0000.vti` and so on. CSV with chosen fields makes a file beside `path` for each map.
///
/// # Errors
/// [`ExportError::Store`] where the result is damaged or holds no such field or instant;
/// [`ExportError::Exists`] and [`ExportError::Foreign`] where the output is there already;
/// [`ExportError::Limit`] where the format cannot hold the result; [`ExportError::Io`] where the system
/// refuses.
///
/// ```no_run
/// use asperity_io::{export::{Format, Options, export}, store::Reader};
///
/// let reader = Reader::open("rough_pmma.zarr".as_ref())?;
/// export(&reader, Format::NetCdf, "rough_pmma.nc".as_ref(), &Options::default())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn export(reader: &Reader, format: Format, path: &Path, options: &Options) -> Result<Vec<PathBuf>> {
    if reader.is_empty() {
        return Err(reader.no_rows().into());
    }
    let kept = &reader.header().fields;
    let mut fields = match &options.fields {
        Some(fields) => fields.clone(),
        None if format == Format::Csv => Vec::new(),
        None => kept.clone(),
    };
    if let Some(absent) = fields.iter().find(|kind| !kept.contains(kind)) {
        return Err(reader.no_field(*absent).into());
    }
    fields.sort_by_key(|kind| FieldKind::ALL.iter().position(|k| k == kind));
    fields.dedup();
    let mut instants: Vec<usize> = match &options.instants {
        Some(instants) => instants.iter().map(|at| reader.index(*at)).collect::<Result<_, StoreError>>()?,
        None => (0..reader.field_times().len()).collect(),
    };
    instants.sort_unstable();
    instants.dedup();
    let contents = Contents::new(reader, &fields, instants)?;
    let force = options.force;
    let written = match format {
        Format::NetCdf => output::write(path, force, |file| netcdf::write(&contents, file)),
        Format::Hdf5 => hdf5(&contents, path, force),
        Format::Npz => output::write(path, force, |file| npz::write(&contents, file)),
        Format::Vtk => return vtk::export(&contents, path, force),
        Format::Csv => return csv::export(&contents, path, force),
    };
    written.map_err(|error| error.at(path))?;
    Ok(vec![path.to_owned()])
}

fn hdf5(contents: &Contents<'_>, path: &Path, force: bool) -> Result<()> {
    let partial = PartialFile::new(path, force)?;
    hdf5::write(contents, partial.place())?;
    Ok(partial.finish()?)
}
