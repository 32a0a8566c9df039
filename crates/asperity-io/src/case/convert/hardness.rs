//! The hardness of each cell, from a file or an array.

use asperity::Grid;
use ndarray::Array2;

use super::Checks;
use crate::case::given::of_grid;
use crate::case::raw::{At, Body, HardnessFile};
use crate::digest::md5;
use crate::topography::{Format, ReadOptions, read};

/// The cut-off of each cell \[Pa\] over all bodies that have one, and the files with their MD5.
pub struct Hardness {
    pub map: Option<Array2<f64>>,
    pub files: Vec<(String, String)>,
}

/// The softer body decides in each cell; `None` after a fault.
pub fn of_cells(checks: &mut Checks<'_, '_>, bodies: &[At<Body>], grid: Option<&Grid>) -> Option<Hardness> {
    let mut all = Hardness { map: None, files: Vec::new() };
    let mut good = true;
    for body in bodies {
        let of_file = body.value.hardness_file.as_ref().map(|at| of_file(checks, at, grid));
        let of_array = body.value.hardness_array.as_ref().map(|at| Some((of_array(checks, at, grid)?, None)));
        for found in of_file.into_iter().chain(of_array) {
            let Some((map, file)) = found else {
                good = false;
                continue;
            };
            all.map = Some(match all.map.take() {
                Some(softer) => ndarray::Zip::from(&softer).and(&map).map_collect(|a, b| a.min(*b)),
                None => map,
            });
            all.files.extend(file);
        }
    }
    good.then_some(all)
}

fn of_array(checks: &mut Checks<'_, '_>, at: &At<String>, grid: Option<&Grid>) -> Option<Array2<f64>> {
    match of_grid(checks.text.arrays, &at.value, grid?) {
        Ok(map) => positive(checks, at, map.as_standard_layout().into_owned(), "the array"),
        Err((message, expected)) => {
            checks.fault(&at.span, message, &expected, None);
            None
        }
    }
}

/// The map, where every cell has a hardness.
fn positive(
    checks: &mut Checks<'_, '_>,
    at: &At<String>,
    map: Array2<f64>,
    holder: &str,
) -> Option<Array2<f64>> {
    if let Some(((i, j), hardness)) = map.indexed_iter().find(|(_, h)| !(h.is_finite() && **h > 0.0)) {
        let what = format!("the hardness of cell ({i}, {j}) in {holder} is {hardness} Pa");
        checks.fault(&at.span, what, "finite and greater than 0 in every cell", None);
        return None;
    }
    Some(map)
}

fn of_file(
    checks: &mut Checks<'_, '_>,
    at: &At<HardnessFile>,
    grid: Option<&Grid>,
) -> Option<(Array2<f64>, Option<(String, String)>)> {
    let HardnessFile { path, unit } = &at.value;
    let full = checks.file(path)?;
    let digest = match std::fs::read(&full) {
        Ok(bytes) => md5(&bytes),
        Err(error) => {
            checks.fault(&path.span, format!("{} cannot be read: {error}", full.display()), "a file", None);
            return None;
        }
    };
    // The readers of heights read numbers of any kind, where the file does not call them heights.
    let options = ReadOptions { size: Some([1.0, 1.0]), height_unit: Some(1.0), ..ReadOptions::default() };
    let numbers = match read(&full, &options) {
        Ok(numbers) => numbers,
        Err(error) => {
            checks.fault(&path.span, error.to_string(), "an array of nx x ny numbers", None);
            return None;
        }
    };
    if !matches!(numbers.format, Format::Npy | Format::Npz | Format::Text | Format::Csv) {
        let what = format!("{} is a file of heights ({})", full.display(), numbers.format);
        checks.fault(&path.span, what, "an NPY or NPZ file or a text matrix", None);
        return None;
    }
    let grid = grid?;
    if numbers.heights.dim() != grid.shape() {
        let ((mx, my), [nx, ny]) = (numbers.heights.dim(), grid.cells());
        let what =
            format!("{} holds {mx} x {my} numbers, but the domain has {nx} x {ny} cells", full.display());
        checks.fault(&path.span, what, "one number for each cell", Some("axis 0 of an array is x"));
        return None;
    }
    let unit = unit.map_or(1.0, |unit| unit.get());
    let map = numbers.heights.mapv(|number| number * unit);
    let map = positive(checks, path, map, &full.display().to_string())?;
    Some((map, Some((path.value.clone(), digest))))
}
