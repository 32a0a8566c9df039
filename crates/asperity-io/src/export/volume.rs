//! Stress below the surface as a VTK volume for ParaView, of one stored time.
//!
//! `.vti` is image data, whose slices are equally far apart: from the surface to the last of the depths. `.vtr` is a rectilinear
//! grid with the depths themselves. The body lies below z = 0: z is minus the depth (the components keep their signs, for an
//! axis that points into the body). Point data at the cell centres, 32-bit floating point, little-endian, appended raw.

use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::stress::StressQuantity;

use super::error::{ExportError, Result};
use super::frame::{END, Frame};
use crate::output;
use crate::store::{At, Reader};
use crate::stress::{Pressures, StressPlan, boundary, depths};

/// Most slices of an image whose depths are not equally far apart.
const SLICES: usize = 32;

/// How the slices of a volume follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Image,
    Rectilinear,
}

/// Writes the stress quantities of a stored time to `path`, whose ending selects the form; at the depths of the plan, or at
/// equal distances to the last of them. Returns the file.
///
/// # Errors
/// [`ExportError::Limit`] for another ending; [`ExportError::Store`] where the result holds no such pressure;
/// [`ExportError::Stress`] for depths that the grid does not allow; and those of [`export`](super::export).
pub fn volume(
    reader: &Reader,
    plan: &StressPlan,
    at: At,
    quantities: &[StressQuantity],
    path: &Path,
    force: bool,
) -> Result<Vec<PathBuf>> {
    let form = match path.extension().and_then(|ending| ending.to_str()) {
        Some("vti") => Form::Image,
        Some("vtr") => Form::Rectilinear,
        _ => {
            let what = format!("a volume in {}", path.display());
            return Err(ExportError::Limit { format: "VTK", what, hint: "name it NAME.vti or NAME.vtr" });
        }
    };
    let (grid, index) = (reader.header().grid, reader.index(at)?);
    let mut stress = plan.poisson.transforms(grid, boundary(reader))?;
    Pressures::new(reader, &plan.body, &plan.poisson)?.give(index, &mut stress)?;
    let depths = depths(reader, plan, &[index])?;
    let depths = if form == Form::Image { even(&depths, &grid) } else { depths };
    let lines = lines(&grid, &depths);
    let extent = lines.each_ref().map(|line| format!("0 {}", line.len() - 1)).join(" ");
    let mut frame = match form {
        Form::Image => {
            let origin = lines.each_ref().map(|line| format!("{:e}", line[0])).join(" ");
            let [dx, dy] = grid.spacing();
            let (deepest, count) = (-lines[2][0], depths.len());
            let step = if count > 1 { (deepest - depths[0]) / (count - 1) as f64 } else { dx };
            let attributes = format!(" Origin=\"{origin}\" Spacing=\"{dx:e} {dy:e} {step:e}\"");
            Frame::new("ImageData", &extent, &attributes)
        }
        Form::Rectilinear => Frame::new("RectilinearGrid", &extent, ""),
    };
    let coordinates = match form {
        Form::Image => vec![],
        Form::Rectilinear => {
            let arrays = ["x", "y", "z"].into_iter().zip(&lines);
            let arrays = arrays.map(|(name, line)| ("Float64", name.to_owned(), "m", 8 * line.len() as u64));
            frame.section("Coordinates", arrays)
        }
    };
    let slice = 4 * grid.len() as u64;
    let bytes = slice * depths.len() as u64;
    let arrays =
        quantities.iter().map(|quantity| ("Float32", format!("stress_{}", quantity.name()), "Pa", bytes));
    let fields = frame.section("PointData", arrays);
    let text = frame.text();
    let start = text.len() as u64;
    let written = output::write(path, force, |file| {
        file.write_all(text.as_bytes())?;
        for line in lines.iter().take(coordinates.len()) {
            file.write_all(&(8 * line.len() as u64).to_le_bytes())?;
            line.iter().try_for_each(|x| file.write_all(&x.to_le_bytes()))?;
        }
        for offset in &fields {
            file.seek(SeekFrom::Start(start + offset))?;
            file.write_all(&bytes.to_le_bytes())?;
        }
        let mut six = std::array::from_fn(|_| Vec::new());
        let mut field = vec![0.0; grid.len()];
        for (n, depth) in depths.iter().enumerate() {
            stress.at(*depth, &mut six).map_err(ExportError::from)?;
            // The deepest slice comes first: z rises.
            let place = 8 + (depths.len() - 1 - n) as u64 * slice;
            for (offset, quantity) in fields.iter().zip(quantities) {
                quantity.field_into(&six, &mut field);
                // z points up in the file, into the body in a result.
                if matches!(quantity, StressQuantity::Xz | StressQuantity::Yz) {
                    field.iter_mut().for_each(|stress| *stress = -*stress);
                }
                file.seek(SeekFrom::Start(start + offset + place))?;
                file.write_all(&x_fastest(&field, grid.cells()))?;
            }
        }
        file.seek(SeekFrom::End(0))?;
        Ok(file.write_all(END.as_bytes())?)
    });
    written.map_err(|error: ExportError| error.at(path))?;
    Ok(vec![path.to_owned()])
}

/// Depths at equal distances from the surface to the last: the given ones where they are such, else up to [`SLICES`], none
/// thinner than half a cell.
fn even(depths: &[f64], grid: &Grid) -> Vec<f64> {
    let (first, last) = (depths.first().copied().unwrap_or(0.0), depths.last().copied().unwrap_or(0.0));
    let step = (last - first) / (depths.len().max(2) - 1) as f64;
    let is_even = |(n, depth): (usize, &f64)| (depth - first - step * n as f64).abs() <= 1e-6 * step;
    if depths.iter().enumerate().all(is_even) {
        return depths.to_vec();
    }
    let cell = grid.cell_sides().fold(0.0, f64::max);
    let slabs = ((2.0 * last / cell) as usize).clamp(1, SLICES);
    (0..=slabs).map(|n| last * n as f64 / slabs as f64).collect()
}

/// The coordinates along x, y and z; z rises.
fn lines(grid: &Grid, depths: &[f64]) -> [Vec<f64>; 3] {
    let [nx, ny] = grid.cells();
    // A line contact is a plane of x and z at y = 0.
    let y = |j| if grid.is_line() { 0.0 } else { grid.y(j) };
    let z = depths.iter().rev().map(|depth| -depth);
    [(0..nx).map(|i| grid.x(i)).collect(), (0..ny).map(y).collect(), z.collect()]
}

/// A field with x fastest, as VTK has it.
fn x_fastest(field: &[f64], [nx, ny]: [usize; 2]) -> Vec<u8> {
    let cells = (0..ny).flat_map(|j| (0..nx).map(move |i| i * ny + j));
    cells.flat_map(|cell| (field[cell] as f32).to_le_bytes()).collect()
}
