//! `hardness_file` of a body: the hardness of each cell.

use super::keys::*;

use asperity::Grid;
use ndarray::{Array2, Zip};

use crate::Code;
use crate::digest::md5;
use crate::topography::{Format, ReadOptions, read};

/// A number for each cell of the domain.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HardnessFile {
    /// The file, relative to the case file: an array of shape (nx, ny) as NPY or NPZ, or a text matrix with a line for
    /// each y and values along x.
    #[schemars(example = "hardness.npy")]
    path: String,
    /// Unit of the numbers in the file; 1 Pa if not given.
    #[schemars(example = "1 MPa")]
    unit: Option<Pressure<Positive>>,
}

impl HardnessFile {
    /// The cut-off of each cell \[Pa\].
    pub fn of_cells(&self, at: &Place<'_>, grid: Option<&Grid>) -> Option<Array2<f64>> {
        let at = at.key("path");
        let numbers = numbers_of_cells(&at, &self.path, grid)?;
        let unit = self.unit.map_or(1.0, Pressure::get);
        positive(&at, numbers.mapv(|number| number * unit), &self.path)
    }
}

/// A number for each cell from a file.
pub fn numbers_of_cells(at: &Place<'_>, path: &str, grid: Option<&Grid>) -> Option<Array2<f64>> {
    let full = at.file(path)?;
    let name = full.display();
    let digest = match std::fs::read(&full) {
        Ok(bytes) => md5(&bytes),
        Err(error) => {
            return at.refuse(Code::File, format!("{name} cannot be read: {error}"), "a file", "");
        }
    };
    // The readers of heights read numbers of any kind, where the file does not call them heights.
    let options = ReadOptions { size: Some([1.0, 1.0]), height_unit: Some(1.0), ..ReadOptions::default() };
    let numbers = at.data(read(&full, &options), "an array of nx x ny numbers")?;
    if !matches!(numbers.format, Format::Npy | Format::Npz | Format::Text | Format::Csv) {
        let what = format!("{name} is a file of heights ({})", numbers.format);
        return at.refuse(Code::Data, what, "an NPY or NPZ file or a text matrix", "");
    }
    let grid = grid?;
    if numbers.heights.dim() != grid.shape() {
        let ((mx, my), [nx, ny]) = (numbers.heights.dim(), grid.cells());
        let what = format!("{name} holds {mx} x {my} numbers, but the domain has {nx} x {ny} cells");
        let help = match [nx, ny] == [2 * mx, 2 * my] {
            true => "the domain is that of a mirrored surface: continue the numbers by their reflections too",
            false => "axis 0 of an array is x",
        };
        return at.refuse(Code::Data, what, "one number for each cell", help);
    }
    at.note_file(path, digest);
    Some(numbers.heights)
}

/// The cut-off of each cell \[Pa\], of the array of this name.
pub fn of_array(at: &Place<'_>, name: &str, grid: Option<&Grid>) -> Option<Array2<f64>> {
    positive(at, at.array(name, grid?)?, "the array")
}

/// The cut-off of each cell of two bodies: the softer one decides.
pub fn softer(one: Array2<f64>, other: Array2<f64>) -> Array2<f64> {
    Zip::from(&one).and(&other).map_collect(|a, b| a.min(*b))
}

/// The map, where every cell has a hardness.
fn positive(at: &Place<'_>, map: Array2<f64>, holder: &str) -> Option<Array2<f64>> {
    if let Some(((i, j), hardness)) = map.indexed_iter().find(|(_, h)| !(h.is_finite() && **h > 0.0)) {
        let what = format!("the hardness of cell ({i}, {j}) in {holder} is {hardness} Pa");
        return at.refuse(Code::Data, what, "finite and greater than 0 in every cell", "");
    }
    Some(map)
}
