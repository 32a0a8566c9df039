//! A closer look at one time: sections through the place of the largest von Mises stress, at equal distances of depth.

use asperity::stress::{
    StressQuantity, SubsurfaceStress, SurveyOptions, automatic_depths, contact_box, spaced_depths, survey,
};
use ndarray::Array2;

use super::evaluate::{StressError, boundary};
use super::{Below, Depths, StressPlan};
use crate::store::{At, FieldKind, Reader};

/// Depths of a section.
const DEPTHS: usize = 24;
/// Depths of the search for the maximum, where it is not stored.
const SEARCH: usize = 12;
/// A section reaches this many times as deep as its maximum, and a few cells at least.
const REACH: f64 = 5.0;
const CELLS: f64 = 8.0;

/// Sections of the von Mises stress and the map at the depth of its maximum.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Number of the stored instant.
    pub index: usize,
    /// Depth, x and y of the largest von Mises stress \[m\].
    pub place: [f64; 3],
    /// The largest von Mises stress \[Pa\].
    pub largest: f64,
    /// Depth that the sections reach \[m\]; their slabs are equally thick.
    pub reach: f64,
    /// von Mises stress in the plane y = const through the place, shape (x, depth) \[Pa\].
    pub along_x: Array2<f64>,
    /// The same in the plane x = const, shape (y, depth) \[Pa\].
    pub along_y: Array2<f64>,
    /// von Mises stress at the depth of the place, shape (x, y) \[Pa\].
    pub map: Array2<f64>,
}

/// Sections of a stored instant, for the Poisson's ratio of the plan; no deeper than its depths. The place is the stored one,
/// where the stress was computed with this Poisson's ratio.
///
/// # Errors
/// [`StressError`] where the result holds no such pressure.
pub fn section(reader: &Reader, plan: &StressPlan, at: At) -> Result<Section, StressError> {
    let grid = reader.header().grid;
    let [nx, ny] = grid.cells();
    let index = reader.index(at)?;
    let pressure = reader.field(FieldKind::Pressure, At::Index(index))?;
    let pressure = pressure.as_slice().unwrap_or_default();
    let mut stress = SubsurfaceStress::new(grid, boundary(reader), plan.poisson)?;
    stress.set_pressure(pressure)?;
    let automatic = automatic_depths(&grid, boundary(reader), contact_box(&grid, pressure));
    let cell = grid.spacing()[0].max(grid.spacing()[1]);
    let deepest = match &plan.depths {
        Depths::List(list) => list.last().copied(),
        Depths::Auto => automatic.last().copied(),
    };
    let (largest, place) = match stored(reader, plan, index)? {
        Some(known) => known,
        None => {
            let ends = [0.5 * cell, automatic.last().copied().unwrap_or(cell)];
            let found = survey(&mut stress, &spaced_depths(ends, SEARCH, true, true), &SurveyOptions::default())?;
            let [i, j] = [found.mises.cell / ny, found.mises.cell % ny];
            (found.mises.value, [found.mises.depth, grid.x(i), grid.y(j)])
        }
    };
    let least = CELLS * cell;
    let reach = f64::max(REACH * place[0], least).min(deepest.unwrap_or(least).max(least));
    let [i, j] = [(place[1] / grid.spacing()[0]) as usize, (place[2] / grid.spacing()[1]) as usize];
    // No slab is thinner than half a cell, so that no middle is nearer to the surface than a quarter.
    let count = ((2.0 * reach / cell) as usize).clamp(1, DEPTHS);
    let (mut along_x, mut along_y) = (Array2::zeros((nx, count)), Array2::zeros((ny, count)));
    let mut six = std::array::from_fn(|_| Vec::new());
    let mut field = vec![0.0; grid.len()];
    for n in 0..count {
        stress.at(reach * (n as f64 + 0.5) / count as f64, &mut six)?;
        StressQuantity::Mises.field_into(&six, &mut field);
        (0..nx).for_each(|i| along_x[(i, n)] = field[i * ny + j]);
        (0..ny).for_each(|j| along_y[(j, n)] = field[i * ny + j]);
    }
    stress.at(place[0], &mut six)?;
    StressQuantity::Mises.field_into(&six, &mut field);
    let map = Array2::from_shape_vec(grid.shape(), field).unwrap_or_default();
    Ok(Section { index, place, largest, reach, along_x, along_y, map })
}

/// The largest von Mises stress of a stored instant and its place (depth, x, y), where it is stored.
fn stored(reader: &Reader, plan: &StressPlan, index: usize) -> Result<Option<(f64, [f64; 3])>, StressError> {
    let Some(below) = Below::of(reader)?.filter(|below| below.set.poisson == plan.poisson) else { return Ok(None) };
    let Some(instant) = below.instants.iter().find(|instant| instant.index == index) else { return Ok(None) };
    let number = |name| below.number(instant, name);
    let place = ["max_mises_depth", "max_mises_x", "max_mises_y"].map(number);
    Ok(place.iter().all(|length| length.is_finite()).then(|| (number("max_mises"), place)))
}
