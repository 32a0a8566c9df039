//! The undeformed gap of bodies of which one moves: h(x, t) = still parts + moving parts at x - X(t).
//!
//! Shapes are evaluated at their place. Heights on a periodic domain are turned in Fourier space, e^(-i q.X), which is exact for
//! the waves that the grid holds; on a free domain they are interpolated by cubics along the motion, exact at whole cells, and
//! cells beyond their ends cannot touch.

use ndarray::Array2;
use rustfft::num_complex::Complex64;

use super::slopes::derivatives;
use super::{Direction, Slopes};
use crate::convolution::torus::{Spectrum, Torus};
use crate::error::{Result, require};
use crate::grid::{Boundary, Grid};
use crate::surface::{Part, Shape, gap_of, undeformed_gap};

/// A gap whose moving parts can be anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingGap {
    grid: Grid,
    boundary: Boundary,
    /// The gap of what stands still.
    still: Array2<f64>,
    shapes: Vec<(Shape, [f64; 2])>,
    /// Heights that move, and their slopes: z, dz/dx, dz/dy.
    heights: Option<[Array2<f64>; 3]>,
    /// Their spectra, on a periodic domain.
    spectra: Option<[Spectrum; 3]>,
    /// The smallest gap at the start, which counts as 0.
    lowest: f64,
    centre: [f64; 2],
    /// The middle of a shape; `None` of heights alone on a periodic domain, which have none.
    middle: Option<[f64; 2]>,
    follows: bool,
}

/// Offsets that are whole cells to this share are taken as such.
const WHOLE: f64 = 1e-6;

impl MovingGap {
    /// Of these parts; each with whether it moves.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) as [`undeformed_gap`], and for a flat punch.
    pub fn new(grid: &Grid, boundary: Boundary, parts: &[(Part, bool)]) -> Result<Self> {
        let all: Vec<Part> = parts.iter().map(|(part, _)| part.clone()).collect();
        let (middle, lowest) = places(grid, &all, &undeformed_gap(grid, &all)?)?;
        let centre = middle.unwrap_or(lowest);
        let middle = if boundary == Boundary::Free { Some(centre) } else { middle };
        let stays = || parts.iter().filter(|(_, moves)| !moves).map(|(part, _)| part);
        let still = gap_of(grid, stays())?;
        // A wave has no middle, as roughness.
        let has_middle =
            |part: &&Part| matches!(part, Part::Shape { shape, .. } if !matches!(shape, Shape::Wave { .. }));
        let shapes_stay = is_uneven(&gap_of(grid, stays().filter(has_middle))?);
        let mut goes = parts.iter().filter(|(_, moves)| *moves).map(|(part, _)| part);
        let follows = goes.clone().any(|part| has_middle(&part)) || goes.next().is_some() && !shapes_stay;
        let [x0, y0] = grid.centre();
        let (mut shapes, mut rough) = (vec![], vec![]);
        for part in parts.iter().filter(|(_, moves)| *moves).map(|(part, _)| part) {
            match part {
                Part::Shape { shape, center } => shapes.push((*shape, [x0 + center[0], y0 + center[1]])),
                part => rough.push(part),
            }
        }
        let heights = if rough.is_empty() { None } else { Some(-gap_of(grid, rough)?) };
        let heights = heights.map(|z| {
            let [x, y] = derivatives(grid, boundary, &z);
            [z, x, y]
        });
        let mut torus = Torus::new(grid.cells(), grid.cells());
        let spectra = heights
            .as_ref()
            .filter(|_| boundary == Boundary::Periodic)
            .map(|fields| [0, 1, 2].map(|k| torus.transform(fields[k].as_slice().unwrap_or_default())));
        let mut moving = MovingGap {
            grid: *grid,
            boundary,
            still,
            shapes,
            heights,
            spectra,
            lowest: 0.0,
            centre,
            middle,
            follows,
        };
        let (start, _) = moving.at(0.0, Direction::X);
        moving.lowest = start.iter().fold(f64::INFINITY, |low, h| low.min(*h));
        require(moving.lowest.is_finite(), "area that can touch", "no cell", "one cell at least")?;
        Ok(moving)
    }

    /// The middle of the shapes, or the cell of the smallest gap, before anything has moved \[m\].
    pub fn centre(&self) -> [f64; 2] {
        self.centre
    }

    /// Whether any part moves, and whether any part that is not flat stands still.
    pub(crate) fn moves_and_stands(&self) -> [bool; 2] {
        [!self.shapes.is_empty() || self.heights.is_some(), is_uneven(&self.still)]
    }

    /// Whether the contact goes with the moving parts: where a shape with a middle moves, or where parts move and no such shape stays.
    pub fn follows(&self) -> bool {
        self.follows
    }

    /// The gap \[m\] and its slopes when the moving parts have gone `distance` \[m\]. The slopes are those of the moving parts alone:
    /// they take the force.
    pub fn at(&self, distance: f64, direction: Direction) -> (Array2<f64>, Slopes) {
        let grid = &self.grid;
        let offset = direction.unit().map(|c| c * distance);
        let mut gap = self.still.clone();
        let gone = if self.follows { offset } else { [0.0; 2] };
        let centre = self.middle.map_or([f64::NAN; 2], |at| [at[0] + gone[0], at[1] + gone[1]]);
        let mut slopes = Slopes { x: Array2::zeros(grid.shape()), y: Array2::zeros(grid.shape()), centre };
        for (shape, place) in &self.shapes {
            for ((i, j), h) in gap.indexed_iter_mut() {
                let from = |x: f64, axis: usize| self.nearest(x - place[axis] - offset[axis], axis, shape);
                let (x, y) = (from(grid.x(i), 0), from(grid.y(j), 1));
                *h += shape.gap(x, y);
                let [sx, sy] = shape.slope_over(x, y, grid.spacing());
                slopes.x[(i, j)] += sx;
                slopes.y[(i, j)] += sy;
            }
        }
        if self.heights.is_some() {
            let [z, zx, zy] = self.moved(offset);
            gap -= &z;
            slopes.x -= &zx;
            slopes.y -= &zy;
        }
        gap.mapv_inplace(|h| if h.is_nan() { f64::INFINITY } else { h - self.lowest });
        for slope in [&mut slopes.x, &mut slopes.y] {
            slope.mapv_inplace(|s| if s.is_finite() { s } else { 0.0 });
        }
        (gap, slopes)
    }

    /// The place from the nearest image of a shape on a periodic domain. (Waves go on by themselves.)
    fn nearest(&self, x: f64, axis: usize, shape: &Shape) -> f64 {
        let length = self.grid.size()[axis];
        let repeats = self.boundary == Boundary::Periodic && !(self.grid.is_line() && axis == 1);
        if !repeats || matches!(shape, Shape::Wave { .. }) {
            return x;
        }
        x - length * (x / length).round()
    }

    /// z(x - offset) and its slopes.
    fn moved(&self, offset: [f64; 2]) -> [Array2<f64>; 3] {
        let Some(fields) = &self.heights else { return [0; 3].map(|_| self.still.clone()) };
        let grid = &self.grid;
        let cells: Vec<f64> = offset.iter().zip(grid.spacing()).map(|(x, d)| x / d).collect();
        let whole = cells.iter().all(|c| (c - c.round()).abs() < WHOLE);
        match &self.spectra {
            Some(spectra) if !whole => {
                let mut torus = Torus::new(grid.cells(), grid.cells());
                let fundamental = grid.size().map(|length| std::f64::consts::TAU / length);
                let counts = grid.cells();
                let phase = torus.spectrum(|kx, ky| {
                    let mut shift = Complex64::ONE;
                    for (axis, k) in [kx, ky].into_iter().enumerate() {
                        let angle = -fundamental[axis] * k as f64 * offset[axis];
                        // The wave of two cells is the mean of its two directions.
                        let alternates = 2 * k.unsigned_abs() as usize == counts[axis];
                        shift *= if alternates { libm::cos(angle).into() } else { unit(angle) };
                    }
                    shift
                });
                [0, 1, 2].map(|k| {
                    let mut out = Array2::zeros(grid.shape());
                    if let Some(out) = out.as_slice_mut() {
                        torus.back_from(&spectra[k], &phase, out);
                    }
                    out
                })
            }
            _ => [0, 1, 2].map(|k| self.shifted(&fields[k], [cells[0], cells[1]])),
        }
    }

    /// A field moved by cells: rolled on a periodic domain, interpolated by cubics on a free one (NaN beyond its ends).
    fn shifted(&self, field: &Array2<f64>, cells: [f64; 2]) -> Array2<f64> {
        let mut field = field.clone();
        for (axis, moved) in cells.into_iter().enumerate().take(self.grid.dimensions()) {
            let count = self.grid.cells()[axis];
            let whole = (moved + WHOLE).floor();
            let part = (moved - whole).max(0.0);
            let part = if part < 2.0 * WHOLE { 0.0 } else { part };
            if whole == 0.0 && part == 0.0 {
                continue;
            }
            let from = field.clone();
            let at = |n: isize, other: usize| {
                let Some(n) = self.boundary.beside(0, n, count) else { return f64::NAN };
                if axis == 0 { from[(n, other)] } else { from[(other, n)] }
            };
            for ((i, j), to) in field.indexed_iter_mut() {
                let (n, other) = if axis == 0 { (i, j) } else { (j, i) };
                let n = n as isize - whole as isize;
                *to = if part == 0.0 {
                    at(n, other)
                } else {
                    cubic([-2, -1, 0, 1].map(|k| at(n + k, other)), 1.0 - part)
                };
            }
        }
        field
    }
}

fn is_uneven(gap: &Array2<f64>) -> bool {
    gap.iter().any(|h| *h != gap[(0, 0)])
}

/// The middle of the first shape that has one, and the cell of the smallest gap \[m\].
fn places(grid: &Grid, parts: &[Part], gap: &Array2<f64>) -> Result<(Option<[f64; 2]>, [f64; 2])> {
    let has_edge = |part: &Part| match part {
        Part::Shape { shape, .. } => matches!(shape, Shape::FlatPunch(_)),
        Part::Heights { heights, .. } => heights.iter().any(|z| z.is_infinite()),
        Part::SelfAffine(_) | Part::Synthesis(_) => false,
    };
    let has_slopes = !parts.iter().any(has_edge);
    let expected = "a shape with slopes: the force on the edge of a punch cannot be computed from its slope";
    require(has_slopes, "surface of a contact in motion", "a flat punch", expected)?;
    let ([x0, y0], none) = (grid.centre(), ((0, 0), f64::INFINITY));
    let middle = parts.iter().find_map(|part| match part {
        Part::Shape { shape: Shape::Wave { .. }, .. } => None,
        Part::Shape { center, .. } => Some([x0 + center[0], y0 + center[1]]),
        _ => None,
    });
    let lower = |low: ((usize, usize), f64), (cell, h): ((usize, usize), &f64)| match *h < low.1 {
        true => (cell, *h),
        false => low,
    };
    let ((i, j), _) = gap.indexed_iter().fold(none, lower);
    Ok((middle, [grid.x(i), grid.y(j)]))
}

/// The cubic through four neighbours at t between the second and the third; a straight line beside an end.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let [a, d] = [if a.is_nan() { 2.0 * b - c } else { a }, if d.is_nan() { 2.0 * c - b } else { d }];
    b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
}

fn unit(angle: f64) -> Complex64 {
    let (sin, cos) = libm::sincos(angle);
    Complex64::new(cos, sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_cannot_touch_do_not_move() {
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let mut heights = Array2::zeros((4, 4));
        heights[[1, 2]] = f64::NEG_INFINITY;
        let parts = [(Part::Heights { name: "punch".into(), heights }, true)];
        let refused = MovingGap::new(&grid, Boundary::Free, &parts).unwrap_err().to_string();
        assert!(refused.contains("flat punch"), "{refused}");
    }

    #[test]
    fn the_contact_goes_with_a_shape_before_roughness_and_with_roughness_before_nothing() {
        let grid = Grid::new([8, 8], [1.0, 1.0]).unwrap();
        let shape = |shape| Part::Shape { shape, center: [0.0, 0.0] };
        let ball = || shape(Shape::Sphere { radius: 1.0 });
        let flat = || shape(Shape::Sphere { radius: f64::INFINITY });
        let wave = || shape(Shape::Wave { amplitude: 0.1, wavelength: [0.5, 0.5] });
        let follows =
            |parts: &[(Part, bool)]| MovingGap::new(&grid, Boundary::Periodic, parts).unwrap().follows();
        assert!(follows(&[(ball(), true), (wave(), false)]) && follows(&[(wave(), true)]));
        assert!(follows(&[(flat(), false), (wave(), true)]));
        assert!(!follows(&[(ball(), false), (wave(), true)]) && !follows(&[(ball(), false)]));
    }

    #[test]
    fn waves_move_exactly_by_any_distance() {
        let grid = Grid::new([16, 10], [1.6, 1.0]).unwrap();
        let tau = std::f64::consts::TAU;
        let wave = |x: f64, y: f64| (tau * (2.0 * x / 1.6 + y)).cos();
        let heights = Array2::from_shape_fn((16, 10), |(i, j)| wave(grid.x(i), grid.y(j)));
        let parts = [(Part::Heights { name: "wave".into(), heights }, true)];
        let moving = MovingGap::new(&grid, Boundary::Periodic, &parts).unwrap();
        let (start, _) = moving.at(0.0, Direction::X);
        for (distance, direction) in
            [(0.3, Direction::X), (0.137, Direction::X), (-0.4, Direction::Y), (0.2, Direction::Angle(0.5))]
        {
            let [dx, dy] = direction.unit().map(|c| c * distance);
            let (gap, slopes) = moving.at(distance, direction);
            for ((i, j), h) in gap.indexed_iter() {
                let (x, y) = (grid.x(i) - dx, grid.y(j) - dy);
                let exact = start[(0, 0)] + wave(grid.x(0), grid.y(0)) - wave(x, y);
                // roundings of transforms
                assert!((h - exact).abs() < 1e-13);
                let slope = tau * 2.0 / 1.6 * (tau * (2.0 * x / 1.6 + y)).sin();
                assert!((slopes.x[(i, j)] - slope).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn shapes_wrap_on_a_periodic_domain_and_leave_a_free_one() {
        let grid = Grid::line(20, 2.0).unwrap();
        let parts = [(Part::Shape { shape: Shape::Cylinder { radius: 1.0 }, center: [0.0, 0.0] }, true)];
        let there = |boundary, distance| {
            MovingGap::new(&grid, boundary, &parts).unwrap().at(distance, Direction::X).0
        };
        let (home, round) = (there(Boundary::Periodic, 0.0), there(Boundary::Periodic, 2.0));
        assert!(home.iter().zip(&round).all(|(a, b)| (a - b).abs() < 1e-13));
        let away = there(Boundary::Free, 5.0);
        assert!(away.iter().all(|h| *h > 1.0));
    }

    #[test]
    fn heights_on_a_free_domain_are_interpolated_and_end() {
        let grid = Grid::line(40, 4.0).unwrap();
        let z = |x: f64| 0.3 * x - 0.1 * x * x;
        let heights = Array2::from_shape_fn((40, 1), |(i, _)| z(grid.x(i)));
        let moving =
            MovingGap::new(&grid, Boundary::Free, &[(Part::Heights { name: "p".into(), heights }, true)])
                .unwrap();
        let (start, _) = moving.at(0.0, Direction::X);
        for distance in [0.5, 0.33, -0.21] {
            let (gap, _) = moving.at(distance, Direction::X);
            let open = gap.iter().filter(|h| h.is_infinite()).count();
            assert!((2..=6).contains(&open), "{distance}: {open}");
            for i in 8..32 {
                let exact = start[(0, 0)] + z(grid.x(0)) - z(grid.x(i) - distance);
                // A cubic through four points of a parabola is that parabola.
                assert!((gap[(i, 0)] - exact).abs() < 1e-12, "{distance} {i}");
            }
        }
    }
}
