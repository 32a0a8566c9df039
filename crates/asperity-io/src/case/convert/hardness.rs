//! The hardness of each cell, from a file.

use asperity::Grid;
use ndarray::Array2;

use super::Checks;
use crate::case::raw::{At, HardnessFile};
use crate::digest::md5;
use crate::topography::{Format, ReadOptions, read};

/// The cut-off of each cell \[Pa\] over all bodies that have one, and the files with their MD5.
pub struct Hardness {
    pub map: Option<Array2<f64>>,
    pub files: Vec<(String, String)>,
}

/// The softer body decides in each cell; `None` after a fault.
pub fn of_cells<'a>(
    checks: &mut Checks<'_, '_>,
    files: impl Iterator<Item = &'a At<HardnessFile>>,
    grid: Option<&Grid>,
) -> Option<Hardness> {
    let mut all = Hardness { map: None, files: Vec::new() };
    let mut good = true;
    for at in files {
        match one(checks, at, grid) {
            Some((map, file)) => {
                all.map = Some(match all.map.take() {
                    Some(softer) => ndarray::Zip::from(&softer).and(&map).map_collect(|a, b| a.min(*b)),
                    None => map,
                });
                all.files.push(file);
            }
            None => good = false,
        }
    }
    good.then_some(all)
}

fn one(
    checks: &mut Checks<'_, '_>,
    at: &At<HardnessFile>,
    grid: Option<&Grid>,
) -> Option<(Array2<f64>, (String, String))> {
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
    if let Some(((i, j), hardness)) = map.indexed_iter().find(|(_, h)| !(h.is_finite() && **h > 0.0)) {
        let what = format!("the hardness of cell ({i}, {j}) in {} is {hardness} Pa", full.display());
        checks.fault(&path.span, what, "finite and greater than 0 in every cell", None);
        return None;
    }
    Some((map, (path.value.clone(), digest)))
}
