//! `asperity surface`: measured and synthetic surfaces.

mod convert;
mod generate;
mod info;
mod process;
mod profile;
mod table;

use std::path::Path;

use asperity::Grid;
use asperity::surface::Surface as Map;
use asperity_io::quantity::Length;
use asperity_io::topography::{Format, ReadOptions, Topography, read, write};

use super::free;
use crate::args::{SurfaceFile, SurfaceOutput};
use crate::failure::Failure;

/// Reads the file with what the command line says about it.
pub(super) fn open(file: &SurfaceFile) -> Result<Topography, Failure> {
    let size = file.size.as_deref().map(size).transpose()?;
    let height_unit = file.height_unit.as_deref().map(unit).transpose()?;
    let options = ReadOptions { size, height_unit, channel: file.channel.clone(), ..ReadOptions::default() };
    read(&file.file, &options).map_err(|error| Failure::input(error.to_string()))
}

/// The heights on their grid; `name` is what messages call them.
fn map(name: &str, topography: &Topography) -> Result<Map, Failure> {
    let failed = |error: asperity::Error| Failure::input(format!("{name}: {error}"));
    let (nx, ny) = topography.heights.dim();
    let grid = Grid::new([nx, ny], topography.size).map_err(failed)?;
    Map::new(grid, topography.heights.clone()).map_err(failed)
}

/// The format that `--to` or else the ending of the path names; refuses to replace a file unless told.
fn target(path: &Path, to: Option<&str>, force: bool) -> Result<Format, Failure> {
    let ending = path.extension().map(|e| e.to_string_lossy().into_owned());
    let name = to.map(str::to_owned).or(ending).unwrap_or_default();
    let format: Format = name.parse().map_err(|error| {
        Failure::input(format!("{error}; name the format to write with --to, e.g. --to gwy"))
    })?;
    if !format.is_written() {
        let names: Vec<&str> = Format::written().map(Format::name).collect();
        return Err(Failure::input(format!(
            "{format} is read, but not written; write one of {}",
            names.join(", ")
        )));
    }
    free(path, force)?;
    Ok(format)
}

/// Checks where the output goes before the work begins.
fn targets(output: &SurfaceOutput) -> Result<Format, Failure> {
    let format = target(&output.output, output.to.as_deref(), output.force)?;
    table::check_plot(output.plot.as_deref(), output.force)?;
    Ok(format)
}

/// Writes a surface where the command line says.
fn save(output: &SurfaceOutput, topography: &Topography, format: Format) -> Result<(), Failure> {
    write(&output.output, topography, format).map_err(Failure::of)
}

/// "1 mm,2 mm" in metres.
fn size(text: &str) -> Result<[f64; 2], Failure> {
    let lengths: Vec<_> = text.split(',').map(length).collect::<Result<_, _>>()?;
    match lengths[..] {
        [x, y] if x > 0.0 && y > 0.0 => Ok([x, y]),
        _ => Err(Failure::input(format!(
            "--size is \"{text}\", but must be two lengths, e.g. --size '1 mm,1 mm'"
        ))),
    }
}

/// "um" or "0.1 um" in metres.
fn unit(text: &str) -> Result<f64, Failure> {
    let value = length(&format!("1 {text}")).or_else(|_| length(text))?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(Failure::input(format!("--height-unit is \"{text}\", but must be a length, e.g. --height-unit um")))
}

fn length(text: &str) -> Result<f64, Failure> {
    let length: Length = text
        .trim()
        .parse()
        .map_err(|error| Failure::input(format!("length \"{}\": {error}", text.trim())))?;
    Ok(length.get())
}
