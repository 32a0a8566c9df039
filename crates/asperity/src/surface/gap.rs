//! The undeformed gap: the sum of the gaps of the shapes minus the heights, with smallest value zero.

use ndarray::{Array2, Zip};

use super::{SelfAffine, Shape, Synthesis};
use crate::error::{Error, Result, require};
use crate::grid::Grid;

/// One contribution to the undeformed gap.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// A smooth shape.
    Shape {
        /// The shape.
        shape: Shape,
        /// Its centre, from the centre of the domain \[m\].
        center: [f64; 2],
    },
    /// Synthetic roughness, Gaussian and isotropic.
    SelfAffine(SelfAffine),
    /// Synthetic roughness with a lay or a prescribed height distribution.
    Synthesis(Synthesis),
    /// Given heights \[m\], one per cell of the grid, pointing out of their body.
    Heights {
        /// Name of the heights in messages (a file name).
        name: String,
        /// Heights of shape (nx, ny) \[m\]; every one finite, or minus infinity where nothing can touch.
        heights: Array2<f64>,
    },
}

impl Part {
    /// "sphere", "self-affine", the name of the heights.
    pub fn name(&self) -> &str {
        match self {
            Part::Shape { shape, .. } => shape.name(),
            Part::SelfAffine(_) | Part::Synthesis(_) => "self-affine",
            Part::Heights { name, .. } => name,
        }
    }

    /// The heights of a rough part at the cells of the grid \[m\]; `None` for a smooth shape.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the roughness does not fit the grid.
    pub fn heights(&self, grid: &Grid) -> Result<Option<Array2<f64>>> {
        match self {
            Part::Shape { .. } => Ok(None),
            Part::SelfAffine(surface) => surface.heights(grid).map(Some),
            Part::Synthesis(surface) => surface.heights(grid).map(Some),
            Part::Heights { heights, .. } => Ok(Some(heights.clone())),
        }
    }
}

/// The undeformed gap h0 at the cell centres \[m\], shape (nx, ny), smallest value 0;
/// `+INFINITY` in the cells that a flat punch keeps from touching.
///
/// ```
/// use asperity::{Grid, surface::{Part, Shape, undeformed_gap}};
///
/// let grid = Grid::new([3, 3], [3e-3, 3e-3])?; // cells of 1 mm
/// let sphere = Part::Shape { shape: Shape::Sphere { radius: 0.1 }, center: [0.0, 0.0] };
/// let gap = undeformed_gap(&grid, &[sphere])?;
/// assert_eq!(gap[[1, 1]], 0.0);
/// assert!((gap[[0, 1]] - 1e-6 / 0.2).abs() < 1e-18); // r^2 / (2 R)
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if a part is outside its domain, heights do not have the shape of the grid or are not finite, the sum
/// overflows, or no cell can touch. Without any part the gap is 0 (flat on flat).
pub fn undeformed_gap(grid: &Grid, parts: &[Part]) -> Result<Array2<f64>> {
    let mut gap = gap_of(grid, parts)?;
    let lowest = gap.fold(f64::INFINITY, |low, h| low.min(*h));
    require(
        lowest.is_finite(),
        "area that can touch",
        "no cell",
        "one cell centre at least inside the flat punch; enlarge the punch, move it or refine the grid",
    )?;
    gap.par_mapv_inplace(|h| h - lowest);
    Ok(gap)
}

/// The sum of the gaps of the shapes less the heights \[m\].
pub(crate) fn gap_of<'a>(grid: &Grid, parts: impl IntoIterator<Item = &'a Part>) -> Result<Array2<f64>> {
    let mut gap = Array2::zeros(grid.shape());
    for (n, part) in parts.into_iter().enumerate() {
        add(&mut gap, grid, part).map_err(|error| error.of(&format!("surface[{n}]")))?;
    }
    Ok(gap)
}

fn add(gap: &mut Array2<f64>, grid: &Grid, part: &Part) -> Result<()> {
    match part {
        Part::Shape { shape, center } => add_shape(gap, grid, shape, *center),
        Part::SelfAffine(surface) => subtract(gap, "self-affine heights", &surface.heights(grid)?),
        Part::Synthesis(surface) => subtract(gap, "synthetic heights", &surface.heights(grid)?),
        Part::Heights { name, heights } => {
            if heights.dim() != grid.shape() {
                let (of_heights, of_grid) = (heights.dim(), grid.shape());
                return Err(Error::invalid(
                    format!("shape of the heights of {name}"),
                    format!("{} x {}", of_heights.0, of_heights.1),
                    format!(
                        "that of the grid, {} x {} cells; crop or resample the heights or change the grid",
                        of_grid.0, of_grid.1
                    ),
                ));
            }
            subtract(gap, name, heights)
        }
    }
}

/// Heights and gaps beyond this mean a wrong unit \[m\]; below it no sum of parts overflows.
const LARGEST_HEIGHT: f64 = 1e100;

fn subtract(gap: &mut Array2<f64>, name: &str, heights: &Array2<f64>) -> Result<()> {
    let usable = |h: &f64| h.abs() <= LARGEST_HEIGHT || *h == f64::NEG_INFINITY;
    if let Some(((i, j), value)) = heights.indexed_iter().find(|(_, h)| !usable(h)) {
        let count = heights.iter().filter(|h| !usable(h)).count();
        return Err(Error::invalid(
            format!("height of {name} at cell ({i}, {j})"),
            format!("{value:e} m"),
            format!("finite ({count} of {} are not); fill the undefined points first", heights.len()),
        ));
    }
    Zip::from(gap).and(heights).par_for_each(|h, z| *h -= z);
    Ok(())
}

fn add_shape(gap: &mut Array2<f64>, grid: &Grid, shape: &Shape, center: [f64; 2]) -> Result<()> {
    shape.validate()?;
    for (offset, axis) in center.iter().zip(["x", "y"]) {
        let what = format!("centre of the {} along {axis}", shape.name());
        require(offset.is_finite(), what, offset, "finite")?;
    }
    let [x0, y0] = [grid.centre()[0] + center[0], grid.centre()[1] + center[1]];
    let under = |i, j| shape.gap(grid.x(i) - x0, grid.y(j) - y0);
    // Every shape except the punch, the only one with cells that never touch, has its largest gap at a corner.
    if !matches!(shape, Shape::FlatPunch(_)) {
        let [i, j] = grid.cells().map(|n| n - 1);
        let widest = [(0, 0), (0, j), (i, 0), (i, j)].map(|(i, j)| under(i, j));
        if let Some(h) = widest.iter().find(|h| h.is_nan() || **h > LARGEST_HEIGHT) {
            return Err(Error::invalid(
                format!("gap under the {} at a corner of the domain", shape.name()),
                format!("{h:e} m"),
                "below 1e100 m; check the radius, slope or amplitude and its unit",
            ));
        }
    }
    Zip::indexed(gap).par_for_each(|(i, j), h| *h += under(i, j));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::Punch;
    use super::*;
    use ndarray::array;

    fn grid() -> Grid {
        Grid::new([4, 6], [4.0, 3.0]).unwrap()
    }

    fn centred(shape: Shape) -> Part {
        Part::Shape { shape, center: [0.0, 0.0] }
    }

    #[test]
    fn the_gap_is_the_sum_of_shapes_minus_heights_and_touches_zero() {
        let grid = Grid::new([2, 3], [2.0, 3.0]).unwrap();
        let heights = array![[0.0, 3.0, 1.0], [2.0, -1.0, 0.5]];
        let parts = [
            centred(Shape::Cone { slope: 2.0 }),
            Part::Heights { name: "plate.txt".into(), heights: heights.clone() },
        ];
        let gap = undeformed_gap(&grid, &parts).unwrap();
        let raw = Array2::from_shape_fn((2, 3), |(i, j)| {
            2.0 * ((i as f64 - 0.5).powi(2) + (j as f64 - 1.0).powi(2)).sqrt() - heights[[i, j]]
        });
        let low = raw.iter().copied().fold(f64::INFINITY, f64::min);
        for (h, r) in gap.iter().zip(&raw) {
            assert!((h - (r - low)).abs() < 1e-15, "{gap} {raw}"); // rounding of the sums
        }
        assert_eq!(gap.iter().copied().fold(f64::INFINITY, f64::min), 0.0);
    }

    #[test]
    fn an_offset_moves_a_shape_from_the_centre_of_the_domain() {
        let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.5, 0.75] };
        let gap = undeformed_gap(&grid(), &[part]).unwrap();
        assert_eq!(gap[[2, 4]], 0.0); // cell centre (2.5, 2.25), the domain's is (2, 1.5)
        assert_eq!(gap[[1, 4]], 0.5);
    }

    #[test]
    fn outside_a_flat_punch_nothing_touches() {
        let punch = Punch::Rectangle { size: [2.0, 1.0] };
        let parts = [centred(Shape::Sphere { radius: 1.0 }), centred(Shape::FlatPunch(punch))];
        let gap = undeformed_gap(&grid(), &parts).unwrap();
        assert_eq!(gap.iter().filter(|h| h.is_finite()).count(), 2 * 2); // cells of 1 x 0.5
        assert_eq!(gap[[0, 0]], f64::INFINITY);
        assert_eq!(gap[[1, 2]], 0.0);
    }

    #[test]
    fn bad_parts_are_refused_with_their_numbers() {
        let says = |parts: &[Part], words: &[&str]| {
            let message = undeformed_gap(&grid(), parts).unwrap_err().to_string();
            for word in words {
                assert!(message.contains(word), "{message:?} lacks {word:?}");
            }
        };
        let heights = |heights| [Part::Heights { name: "b.sdf".into(), heights }];
        says(&heights(Array2::zeros((6, 4))), &["b.sdf", "6 x 4", "4 x 6"]);
        let mut holes = Array2::zeros((4, 6));
        holes[[1, 2]] = f64::NAN;
        holes[[3, 5]] = f64::INFINITY;
        says(&heights(holes), &["b.sdf", "(1, 2)", "2 of 24", "fill"]);
        says(&[centred(Shape::Sphere { radius: 1e-310 })], &["sphere", "unit"]);
        let nowhere = Shape::FlatPunch(Punch::Circle { radius: 1e-9 });
        says(&[centred(nowhere)], &["no cell", "punch"]);
        says(
            &[Part::Shape { shape: Shape::Cone { slope: 1.0 }, center: [f64::NAN, 0.0] }],
            &["centre of the cone"],
        );
    }

    #[test]
    fn no_part_at_all_is_flat_on_flat() {
        assert!(undeformed_gap(&grid(), &[]).unwrap().iter().all(|h| *h == 0.0));
    }
}
