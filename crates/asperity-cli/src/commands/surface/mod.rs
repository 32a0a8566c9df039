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
use asperity::surface::process::Border;
use asperity::surface::statistics::Extent;
use asperity_io::case::fragment;
use asperity_io::preparation::{Prepared, Step, border, prepare};
use asperity_io::quantity::Length;
use asperity_io::quantity::range::Positive;
use asperity_io::topography::{Format, ReadOptions, Topography, read, write};
use ndarray::Array2;

use self::table::SurfaceSummary;
use crate::args::{SurfaceFile, SurfaceOutput};
use crate::failure::{Failure, refuse};
use crate::input::read as parsed;

/// Reads the file with what the command line says about it.
pub(super) fn open(file: &SurfaceFile) -> Result<Topography, Failure> {
    let size = file.size.as_deref().map(|text| size("--size", text)).transpose()?;
    let height_unit = file.height_unit.as_deref().map(unit).transpose()?;
    let options = ReadOptions { size, height_unit, channel: file.channel.clone(), ..ReadOptions::default() };
    Ok(read(&file.file, &options)?)
}

/// Whether the file holds a profile: two columns of text.
pub(super) fn is_profile(file: &SurfaceFile) -> Result<bool, Failure> {
    Ok(profile::open(file)?.is_some())
}

/// The name of a file without its folder.
pub(super) fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The heights on their grid; `name` is what messages call them.
pub(super) fn map(name: &str, topography: &Topography) -> Result<Map, Failure> {
    let failed = Failure::about(name);
    let (nx, ny) = topography.heights.dim();
    let grid = Grid::new([nx, ny], topography.size).map_err(&failed)?;
    Map::new(grid, topography.heights.clone()).map_err(failed)
}

/// The format that `--to` names, or else the extension of the path.
fn target(path: &Path, to: Option<&str>) -> Result<Format, Failure> {
    let ending = path.extension().map(|e| e.to_string_lossy().into_owned());
    let name = to.map(str::to_owned).or(ending).unwrap_or_default();
    let format: Format = name.parse().map_err(|error| {
        Failure::input(format!("{error}; name the format to write with --to, e.g. --to gwy"))
    })?;
    if !format.is_written() {
        let names: Vec<&str> = Format::written().map(Format::name).collect();
        refuse!("{format} is read, but not written; write one of {}", names.join(", "));
    }
    Ok(format)
}

/// Whether a surface repeats: where its user says so, or its history that it was continued by its reflections.
fn extent(topography: &Topography, periodic: bool) -> Extent {
    let history: Vec<&str> = topography.history().collect();
    if periodic || border(&history) == Border::Mirrored { Extent::Periodic } else { Extent::Finite }
}

/// Writes a surface where the command line says, and prints its statistics.
fn finish(
    output: &SurfaceOutput,
    topography: &Topography,
    extent: Extent,
    fitted: impl FnOnce(SurfaceSummary<'_>) -> SurfaceSummary<'_>,
) -> Result<(), Failure> {
    write(&output.output, topography, topography.format)?;
    let name = output.output.display().to_string();
    fitted(SurfaceSummary::of(&name, topography, extent)?).print(
        output.json,
        output.plot.as_deref(),
        output.force,
    )
}

/// A roughness that is made, on its way to a file.
fn roughness(format: Format, heights: Array2<f64>, size: [f64; 2], history: Vec<String>) -> Topography {
    let channel = Some("roughness".to_owned());
    let mut made = Topography { format, heights, size, channel, channels: Vec::new(), metadata: Vec::new() };
    made.record(history);
    made
}

/// The steps of --op.
fn steps(op: &[String]) -> Result<Vec<Step>, Failure> {
    let step =
        |words: &String| fragment::step(words).map_err(|reason| Failure::input(format!("--op {reason}")));
    op.iter().map(step).collect()
}

/// Does the steps of --op; `name` is what messages call the surface.
fn prepared(name: &str, surface: Map, steps: &[Step]) -> Result<Prepared, Failure> {
    prepare(surface, steps, None).map_err(|error| {
        // There is no domain here.
        let reason = error
            .to_string()
            .replace("as `cells` of the step or as `domain.cells` of the case", "cells=NX,NY");
        Failure::input(format!("{name}: {reason}"))
    })
}

/// "1 mm,2 mm", or "1 mm" for a square, in metres.
fn size(option: &str, text: &str) -> Result<[f64; 2], Failure> {
    let lengths: Vec<_> = text.split(',').map(|side| length(option, side)).collect::<Result<_, _>>()?;
    match lengths[..] {
        [x, y] if x > 0.0 && y > 0.0 => Ok([x, y]),
        [side] if side > 0.0 => Ok([side; 2]),
        _ => refuse!(
            "{option} is \"{text}\", but must be one length (of a square) or two, greater than 0, e.g. {option} '1 mm,1 mm'"
        ),
    }
}

/// "um" or "0.1 um" in metres.
fn unit(text: &str) -> Result<f64, Failure> {
    let text = text.trim();
    let length: Result<Length<Positive>, _> = format!("1 {text}").parse().or_else(|_| text.parse());
    length.map(Length::get).map_err(|_| {
        Failure::input(format!(
            "--height-unit is \"{text}\", but must be a unit of length, e.g. --height-unit um"
        ))
    })
}

fn length(option: &str, text: &str) -> Result<f64, Failure> {
    Ok(parsed::<Length>(option, text)?.get())
}
