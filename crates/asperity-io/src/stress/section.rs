//! A closer look at one time: sections through the place of the largest von Mises stress, at equal distances of depth.

use std::sync::atomic::AtomicBool;

use asperity::stress::StressQuantity;
use ndarray::Array2;

use super::evaluate::{StressError, boundary, of_result};
use super::{Below, Depths, Instant, Pressures, StressPlan};
use crate::readable::coordinate;
use crate::store::{At, Reader};

/// Slabs of a section, and of one below a line, where they cost little.
const DEPTHS: usize = 32;
const LINE_DEPTHS: usize = 96;
/// A section reaches this many times as deep as its maximum, and a few cells at least.
const REACH: f64 = 5.0;
const CELLS: f64 = 8.0;

/// Sections of the von Mises stress and maps about the depth of its maximum.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Number of the stored instant.
    pub index: usize,
    /// Depth, x and y of the largest von Mises stress \[m\]; y is NaN on a line.
    pub place: [f64; 3],
    /// The largest von Mises stress \[Pa\].
    pub largest: f64,
    /// Depth that the sections reach \[m\]; their slabs are equally thick.
    pub reach: f64,
    /// von Mises stress in the plane y = const through the place, shape (x, depth) \[Pa\].
    pub along_x: Array2<f64>,
    /// The same in the plane x = const, shape (y, depth) \[Pa\]; of a line there is none.
    pub along_y: Option<Array2<f64>>,
    /// von Mises stress above, at and below the depth of the place: depths \[m\], and maps of shape (x, y) \[Pa\]; empty for a line.
    pub maps: Vec<(f64, Array2<f64>)>,
}

/// The stress at the stored instant `at`: the stored one if it was computed by the same plan, otherwise it is computed by `plan`.
///
/// # Errors
/// [`StressError`] where the result holds no such pressure.
pub fn below_at(reader: &Reader, plan: &StressPlan, at: At) -> Result<Below, StressError> {
    let index = reader.index(at)?;
    let stored = Below::of(reader)?.filter(|below| {
        let same = StressPlan { times: plan.times.clone(), ..StressPlan::of(&below.set, reader) };
        let depths = plan.depths == Depths::Auto || plan.depths == same.depths;
        depths && StressPlan { depths: plan.depths.clone(), ..same } == *plan
    });
    if let Some(mut below) = stored
        && let Some(instant) = below.instants.iter().find(|instant| instant.index == index)
    {
        below.instants = vec![instant.clone()];
        return Ok(below);
    }
    let one = StressPlan { times: Some(vec![reader.field_times()[index]]), ..plan.clone() };
    of_result(reader, &one, &AtomicBool::new(false))
}

/// Sections through the place of the largest von Mises stress of an instant of `below`, no deeper than its depths.
///
/// # Errors
/// [`StressError`] where the result holds no such pressure, or nothing touches.
pub fn section(reader: &Reader, below: &Below, instant: &Instant) -> Result<Section, StressError> {
    let grid = reader.header().grid;
    let ([nx, ny], [dx, dy]) = (grid.cells(), grid.spacing());
    let line = grid.is_line();
    let number = |name| below.number(instant, name);
    let place = ["max_mises_depth", "max_mises_x", "max_mises_y"].map(number);
    if place[..1 + grid.dimensions()].iter().any(|length| !length.is_finite()) {
        let when = coordinate(reader.header().axis().at(instant.time));
        return Err(StressError::NoContact { path: reader.path().to_owned(), when });
    }
    let mut stress = below.set.poisson.transforms(grid, boundary(reader))?;
    Pressures::new(reader, &below.set.body, &below.set.poisson)?.give(instant.index, &mut stress)?;
    let cell = grid.cell_sides().fold(0.0, f64::max);
    let least = CELLS * cell;
    let deepest = below.set.depths.last().copied().unwrap_or(least);
    let reach = f64::max(REACH * place[0], least).min(deepest.max(least));
    let [i, j] = [((place[1] / dx) as usize).min(nx - 1), ((place[2] / dy) as usize).min(ny - 1)];
    // No slab is thinner than half a cell, so that no middle is nearer to the surface than a quarter.
    let count = ((2.0 * reach / cell) as usize).clamp(1, if line { LINE_DEPTHS } else { DEPTHS });
    let (mut along_x, mut along_y) = (Array2::zeros((nx, count)), Array2::zeros((ny, count)));
    let mut six = std::array::from_fn(|_| Vec::new());
    let mut field = vec![0.0; grid.len()];
    for n in 0..count {
        stress.at(reach * (n as f64 + 0.5) / count as f64, &mut six)?;
        StressQuantity::Mises.field_into(&six, &mut field);
        (0..nx).for_each(|i| along_x[(i, n)] = field[i * ny + j]);
        (0..ny).for_each(|j| along_y[(j, n)] = field[i * ny + j]);
    }
    let mut maps = vec![];
    let depths = map_depths(place[0], cell);
    for depth in depths.into_iter().filter(|_| !line) {
        stress.at(depth, &mut six)?;
        let mut map = Array2::zeros(grid.shape());
        if let Some(field) = map.as_slice_mut() {
            StressQuantity::Mises.field_into(&six, field);
        }
        maps.push((depth, map));
    }
    let along_y = (!line).then_some(along_y);
    Ok(Section { index: instant.index, place, largest: number("max_mises"), reach, along_x, along_y, maps })
}

/// Half, once and twice the depth of the largest stress; below a largest stress at the surface one and two cells.
fn map_depths(depth: f64, cell: f64) -> [f64; 3] {
    match depth > 0.0 {
        true if 0.5 * depth < 0.25 * cell => [0.0, depth, 2.0 * depth],
        true => [0.5 * depth, depth, 2.0 * depth],
        false => [0.0, cell, 2.0 * cell],
    }
}
