//! Stress below the surface as a VTK volume for ParaView, of one stored time.
//!
//! `.vti` is image data, whose slices are equally far apart: from the surface to the last of the depths. `.vtr` is a rectilinear
//! grid with the depths themselves. The body lies below z = 0: z is minus the depth (the components keep their signs, for an
//! axis that points into the body). Point data at the cell centres, 32-bit floating point, little-endian, appended raw.

use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::stress::{StressQuantity, automatic_depths, contact_box};

use super::error::{ExportError, Result, WriteError};
use crate::output::{self, Output};
use crate::store::{At, FieldKind, Reader};
use crate::stress::{Depths, Pressures, StressPlan};

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
    let grid = reader.header().grid;
    let boundary = crate::stress::boundary(reader);
    let mut stress = plan.poisson.transforms(grid, boundary)?;
    Pressures::new(reader, &plan.poisson)?.give(reader.index(at)?, &mut stress)?;
    let depths = match &plan.depths {
        Depths::List(list) => list.clone(),
        Depths::Auto => {
            let pressure = reader.field(FieldKind::Pressure, at)?;
            automatic_depths(&grid, boundary, contact_box(&grid, pressure.as_slice().unwrap_or_default()))
        }
    };
    let depths = if form == Form::Image { even(&depths, &grid) } else { depths };
    let header = header(&grid, &depths, quantities, form);
    let written = output::write(path, force, |file| {
        file.write_all(header.text.as_bytes())?;
        let start = header.text.len() as u64;
        for (offset, line) in &header.lines {
            write_array(file, start + offset, line)?;
        }
        let slice = 4 * grid.len() as u64;
        for (n, _) in quantities.iter().enumerate() {
            let bytes = slice * depths.len() as u64;
            file.seek(SeekFrom::Start(start + header.first + n as u64 * (8 + bytes)))?;
            file.write_all(&bytes.to_le_bytes())?;
        }
        let mut six = std::array::from_fn(|_| Vec::new());
        let mut field = vec![0.0; grid.len()];
        for (n, depth) in depths.iter().enumerate() {
            stress.at(*depth, &mut six).map_err(ExportError::from)?;
            // The deepest slice comes first: z rises.
            let place = (depths.len() - 1 - n) as u64 * slice;
            for (k, quantity) in quantities.iter().enumerate() {
                quantity.field_into(&six, &mut field);
                // z points up in the file, into the body in a result.
                if matches!(quantity, StressQuantity::Xz | StressQuantity::Yz) {
                    field.iter_mut().for_each(|stress| *stress = -*stress);
                }
                let array = start + header.first + k as u64 * (8 + slice * depths.len() as u64) + 8;
                file.seek(SeekFrom::Start(array + place))?;
                file.write_all(&x_fastest(&field, grid.cells()))?;
            }
        }
        file.seek(SeekFrom::End(0))?;
        Ok(write!(file, "\n  </AppendedData>\n</VTKFile>\n")?)
    });
    written.map_err(|error: WriteError| error.at(path))?;
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

/// The text before the appended data, and where they begin.
struct Header {
    text: String,
    /// The coordinates of a rectilinear grid, at their offsets in the appended data.
    lines: Vec<(u64, Vec<f64>)>,
    /// Offset of the first quantity.
    first: u64,
}

fn header(grid: &Grid, depths: &[f64], quantities: &[StressQuantity], form: Form) -> Header {
    let ([nx, ny], [dx, dy], nz) = (grid.cells(), grid.spacing(), depths.len());
    // A line contact is a plane of x and z at y = 0.
    let y0 = if grid.is_line() { 0.0 } else { grid.y(0) };
    let extent = format!("0 {} 0 {} 0 {}", nx - 1, ny - 1, nz - 1);
    let deepest = depths.last().copied().unwrap_or(0.0);
    let mut text = "<?xml version=\"1.0\"?>\n".to_owned();
    let mut lines = vec![];
    let mut first = 0;
    let kind = if form == Form::Image { "ImageData" } else { "RectilinearGrid" };
    text += &format!(
        "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
    );
    match form {
        Form::Image => {
            let step = if nz > 1 { (deepest - depths[0]) / (nz - 1) as f64 } else { dx };
            let origin = format!("{:e} {y0:e} {:e}", 0.5 * dx, -deepest);
            text += &format!(
                "  <ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{dx:e} {dy:e} {step:e}\">\n"
            );
        }
        Form::Rectilinear => text += &format!("  <RectilinearGrid WholeExtent=\"{extent}\">\n"),
    }
    text += &format!("    <Piece Extent=\"{extent}\">\n");
    if form == Form::Rectilinear {
        text += "      <Coordinates>\n";
        let x = (0..nx).map(|i| grid.x(i)).collect::<Vec<f64>>();
        let y = (0..ny).map(|j| if grid.is_line() { y0 } else { grid.y(j) }).collect();
        let z = depths.iter().rev().map(|depth| -depth).collect();
        for (name, line) in [("x", x), ("y", y), ("z", z)] {
            text += &format!(
                "        <DataArray type=\"Float64\" Name=\"{name}\" format=\"appended\" offset=\"{first}\"/>\n"
            );
            let bytes = 8 + 8 * line.len() as u64;
            lines.push((first, line));
            first += bytes;
        }
        text += "      </Coordinates>\n";
    }
    text += "      <PointData>\n";
    let bytes = 8 + 4 * (grid.len() * nz) as u64;
    for (n, quantity) in quantities.iter().enumerate() {
        let offset = first + n as u64 * bytes;
        text += &format!(
            "        <DataArray type=\"Float32\" Name=\"stress_{}\" format=\"appended\" offset=\"{offset}\">\n          \
             <InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">Pa</InformationKey>\n        \
             </DataArray>\n",
            quantity.name()
        );
    }
    text += &format!("      </PointData>\n    </Piece>\n  </{kind}>\n  <AppendedData encoding=\"raw\">\n_");
    Header { text, lines, first }
}

fn write_array(file: &mut Output<'_>, at: u64, numbers: &[f64]) -> Result<(), WriteError> {
    file.seek(SeekFrom::Start(at))?;
    file.write_all(&(8 * numbers.len() as u64).to_le_bytes())?;
    Ok(numbers.iter().try_for_each(|x| file.write_all(&x.to_le_bytes()))?)
}

/// A field with x fastest, as VTK has it.
fn x_fastest(field: &[f64], [nx, ny]: [usize; 2]) -> Vec<u8> {
    let cells = (0..ny).flat_map(|j| (0..nx).map(move |i| i * ny + j));
    cells.flat_map(|cell| (field[cell] as f32).to_le_bytes()).collect()
}
