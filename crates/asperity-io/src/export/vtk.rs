//! VTK image data for ParaView: a `.vti` file per instant, and a `.pvd` collection that gives their times.
//!
//! Fields are cell data, x fastest, little-endian, appended raw. What is not finite (the gap where a punch
//! cannot touch) becomes NaN, which ParaView leaves out of its colour range. Where two instants have
//! the same time (before and after a jump), the earlier is given the next smaller number: ParaView
//! takes files of equal time as parts of one state.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::contents::{Contents, Data, DataType, Map, Variable};
use super::error::{ExportError, Result};
use super::frame::{END, Frame};
use crate::output::{Output, PartialDirectory, PartialFile};

pub(super) fn export(contents: &Contents<'_>, path: &Path, force: bool) -> Result<Vec<PathBuf>> {
    let directory = path.with_extension("");
    if directory == path {
        let what = "a collection whose name has no ending, as its directory needs that name".to_owned();
        return Err(ExportError::Limit { format: "VTK", what, hint: "name it NAME.pvd" });
    }
    let name = directory.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let list = PartialFile::filled(path, force, |file| collection(contents, &name, file))
        .map_err(|error| error.at(path))?;
    check_directory(&directory, force)?;
    images(contents, &directory).map_err(|error| error.at(&directory))?;
    list.finish().map_err(|error| ExportError::from(error).at(path))?;
    Ok(vec![path.to_owned(), directory])
}

/// Makes the directory of the images.
fn images(contents: &Contents<'_>, directory: &Path) -> Result<()> {
    let partial = PartialDirectory::new(directory)?;
    let fields: Vec<_> = contents.variables.iter().filter(|variable| variable.is_field()).collect();
    for n in 0..contents.instants.len() {
        image(contents, &partial.place().join(state_name(n)), &fields, n)?;
    }
    let gap: Vec<_> = contents.variables.iter().filter(|variable| variable.name == "initial_gap").collect();
    image(contents, &partial.place().join("initial_gap.vti"), &gap, 0)?;
    Ok(partial.finish()?)
}

fn state_name(n: usize) -> String {
    format!("state_{n:04}.vti")
}

/// Whether the directory of the images may be made: absent, or with force one that holds nothing else.
fn check_directory(directory: &Path, force: bool) -> Result<()> {
    let Ok(found) = fs::symlink_metadata(directory) else { return Ok(()) };
    let foreign =
        |found: &str| Err(ExportError::Foreign { path: directory.to_owned(), found: found.to_owned() });
    if !found.is_dir() {
        return foreign("is not a directory");
    }
    if !force {
        return Err(ExportError::Exists { path: directory.to_owned() });
    }
    let entries = fs::read_dir(directory).map_err(|error| ExportError::from(error).at(directory))?;
    for entry in entries {
        let name = entry.map_err(|error| ExportError::from(error).at(directory))?.file_name();
        let ours = name.to_str().is_some_and(|name| {
            name == "initial_gap.vti" || name.starts_with("state_") && name.ends_with(".vti")
        });
        if !ours {
            return foreign(&format!("holds other files ({})", name.display()));
        }
    }
    Ok(())
}

fn collection(contents: &Contents<'_>, directory: &str, file: &mut Output<'_>) -> Result<()> {
    writeln!(file, r#"<?xml version="1.0"?>"#)?;
    writeln!(file, r#"<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">"#)?;
    writeln!(file, "  <Collection>")?;
    let mut times: Vec<f64> =
        contents.instants.iter().map(|index| contents.reader.field_times()[*index]).collect();
    for n in (1..times.len()).rev() {
        if times[n - 1] == times[n] {
            times[n - 1] = times[n].next_down();
        }
    }
    for (n, time) in times.iter().enumerate() {
        let name = escape(&format!("{directory}/{}", state_name(n)));
        writeln!(file, r#"    <DataSet timestep="{time:e}" part="0" file="{name}"/>"#)?;
    }
    Ok(writeln!(file, "  </Collection>\n</VTKFile>")?)
}

fn image(contents: &Contents<'_>, path: &Path, variables: &[&Variable], n: usize) -> Result<()> {
    let grid = &contents.reader.header().grid;
    let ([nx, ny], [dx, dy]) = (grid.cells(), grid.spacing());
    // A line of cells has no extent along y.
    let (my, dy) = if grid.is_line() { (0, dx) } else { (ny, dy) };
    let attributes = format!(" Origin=\"0 0 0\" Spacing=\"{dx:e} {dy:e} {dx:e}\"");
    let mut frame = Frame::new("ImageData", &format!("0 {nx} 0 {my} 0 0"), &attributes);
    let cells = (nx * ny) as u64;
    let arrays = variables.iter().map(|variable| match variable.data {
        Data::Maps(DataType::UInt8) => ("UInt8", variable.name.to_owned(), variable.units, cells),
        _ => ("Float64", variable.name.to_owned(), variable.units, 8 * cells),
    });
    frame.section("CellData", arrays);
    crate::output::write(path, false, |file| {
        file.write_all(frame.text().as_bytes())?;
        for variable in variables {
            match contents.map(variable, n)? {
                Map::Real(map) => {
                    file.write_all(&(8 * cells).to_le_bytes())?;
                    for x in map.t() {
                        let x = if x.is_finite() { *x } else { f64::NAN };
                        file.write_all(&x.to_le_bytes())?;
                    }
                }
                Map::Byte(map) => {
                    file.write_all(&cells.to_le_bytes())?;
                    map.t().iter().try_for_each(|cell| file.write_all(&[*cell]))?;
                }
            }
        }
        Ok(file.write_all(END.as_bytes())?)
    })
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
