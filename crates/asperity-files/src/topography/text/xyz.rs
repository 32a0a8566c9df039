//! Points (x, y, height) of a regular grid, in any order; missing points are undefined.
//!
//! The spacing is found from the sorted coordinates: values that differ by rounding only are one position, the
//! smallest step between positions is the spacing, and every position must lie on a multiple of it.

use ndarray::Array2;
use rayon::prelude::*;

use super::header::Column;
use super::parse::{Table, table};
use super::{Text, decode};
use crate::topography::finish::{Lateral, Measured, unit_of};
use crate::topography::unit::LoneA;
use crate::topography::{Format, Problem, Request, Result, grid};

/// Most grid points per point of the file: a file that covers less is no grid.
const MOST_CELLS_PER_POINT: usize = 8;

/// Three columns are taken for points.
const HINT: &str = "three columns are taken for x, y and height; if this is a matrix, say so in its first line \
                    (\"# Width: 3 um\"), or save it as NPY; if it is a profile, keep two columns, position and height";

/// Positions of the x and y columns, where a row of names gives them.
pub(super) fn named_columns(columns: &[Column]) -> Option<[usize; 2]> {
    let axis = |letter: char| columns.iter().position(|column| is_axis(&column.name, letter));
    Some([axis('x')?, axis('y')?])
}

/// Whether a name is that of an axis: "x", "X coordinate", "pos_x".
fn is_axis(name: &str, letter: char) -> bool {
    let name = name.to_lowercase();
    let says = |text: &str| ["coord", "pos", "axis"].iter().any(|word| text.contains(word));
    let start = name.strip_suffix(letter).filter(|start| start.ends_with([' ', '_', '-', '.']));
    name.strip_prefix(letter).is_some_and(|rest| rest.is_empty() || says(rest)) || start.is_some_and(says)
}

/// Reads points.
pub(super) fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let bytes = decode(bytes)?;
    let text = Text::split(&bytes)?;
    let block = match text.blocks.as_slice() {
        [] => return Err(request.no_heights("no line of numbers")),
        [block] => block,
        more => {
            return Err(request.no_heights(format!("{} blocks of numbers between other lines", more.len())));
        }
    };
    let table = table(text.dialect, block)?;
    let header = &block.header;
    if table.columns < 3 {
        return Err(
            request.no_heights(format!("its lines have {} values, not x, y and a height", table.columns))
        );
    }
    let columns = header.columns();
    let named = named_columns(&columns).filter(|_| columns.len() == table.columns);
    // Of more columns than three the first ones may be a counter and a time.
    if named.is_none() && table.columns > 3 {
        return Err(Problem::malformed(
            format!("the line above the {} columns of points", table.columns),
            if columns.is_empty() {
                "missing".to_owned()
            } else {
                columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ")
            },
            "one name for each column, x and y among them, with their units, as in \"index, x [mm], y [mm], z [um]\"",
        ));
    }
    let [x, y] = named.unwrap_or([0, 1]);
    let heights: Vec<usize> = (0..table.columns).filter(|c| *c != x && *c != y).collect();
    let names: Vec<String> = match named {
        Some(_) => heights.iter().map(|c| columns[*c].name.clone()).collect(),
        None => heights.iter().map(|c| format!("column {}", c + 1)).collect(),
    };
    let z = heights[chosen(request, &columns, &heights, &names)?];

    let [x_axis, y_axis] = [(x, "x"), (y, "y")].map(|(column, name)| Axis::of(&table, column, name));
    let (x_axis, y_axis) = (x_axis?, y_axis?);
    // Lines of a map share their coordinates; a counter and a line across the surface do not.
    for (axis, name) in [(&x_axis, "x"), (&y_axis, "y")] {
        if table.len() > 3 && axis.positions == table.len() {
            return Err(Problem::malformed(
                format!("the column taken for {name}"),
                format!("another number in each of the {} points", table.len()),
                format!(
                    "a coordinate that the points of a line of the map share: a counter, or a line across the surface, is no map. Name the columns, as \
                     in \"index, x [mm], y [mm], z [um]\"; {HINT}"
                ),
            ));
        }
    }
    let map = gridded(&table, [x, y, z], &x_axis, &y_axis, block.line)?;
    let size = [x_axis.size(), y_axis.size()];
    let (units, unit) = header.point_units([x, y, z]);
    let lateral = Lateral::of(size, units.map(|u| unit_of(&u.unwrap_or_default(), LoneA::Ampere)));
    let (channel, channels) = match named {
        Some(_) => (Some(columns[z].name.clone()), names),
        None => (header.channel.clone(), Vec::new()),
    };
    let metadata = text.metadata(block);
    Ok(Measured { channel, channels, metadata, ..Measured::new(map, unit, lateral) })
}

/// The column of heights: the one asked for, else z, else one with a name or unit of heights.
fn chosen(request: &Request, columns: &[Column], heights: &[usize], names: &[String]) -> Result<usize> {
    let z = names.iter().position(|name| is_axis(name, 'z'));
    match (request.channel, z) {
        (None, Some(z)) => Ok(z),
        _ => request.choose_heights(names, |n| {
            let unit = columns.get(heights[n]).and_then(|column| column.unit.as_deref());
            unit_of(unit.unwrap_or_default(), LoneA::Ampere)
        }),
    }
}

/// Equally spaced positions.
struct Axis {
    first: f64,
    spacing: f64,
    points: usize,
    /// Different coordinates in the file.
    positions: usize,
}

impl Axis {
    fn size(&self) -> f64 {
        self.spacing * self.points as f64
    }

    fn index(&self, coordinate: f64) -> usize {
        // In range because `first` is the least and the last point the greatest coordinate.
        ((coordinate - self.first) / self.spacing).round() as usize
    }

    fn of(table: &Table, column: usize, name: &str) -> Result<Self> {
        let mut sorted: Vec<f64> = table.lines().map(|point| point[column]).collect();
        if sorted.iter().any(|v| v.is_nan()) {
            let expected = format!("a number; {HINT}");
            return Err(Problem::malformed(format!("a {name} coordinate"), "undefined", expected));
        }
        sorted.par_sort_unstable_by(f64::total_cmp);
        let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
            return Err(Problem::NoHeights { format: Format::Xyz, detail: "no points".into() });
        };
        let range = last - first;
        if !(range > 0.0 && range.is_finite()) {
            let detail = format!("all points have {name} = {first}, a profile and not an area");
            return Err(Problem::NoHeights { format: Format::Xyz, detail });
        }
        // Rounding of the coordinates in the file: from 15 digits to 4.
        (4..=12)
            .rev()
            .find_map(|digits| Axis::with_tolerance(&sorted, range * 10f64.powi(-digits)))
            .ok_or_else(|| irregular(name))
    }

    fn with_tolerance(sorted: &[f64], tolerance: f64) -> Option<Self> {
        // Positions: means of runs without a step above the tolerance.
        let mut positions = Vec::new();
        for run in sorted.chunk_by(|a, b| b - a <= tolerance) {
            positions.push(run[0] + run.iter().map(|v| v - run[0]).sum::<f64>() / run.len() as f64);
        }
        let (first, last) = (*positions.first()?, *positions.last()?);
        let least = positions.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let steps = ((last - first) / least).round();
        if !(steps >= 1.0 && steps < (MOST_CELLS_PER_POINT * sorted.len()) as f64) {
            return None;
        }
        let (spacing, points) = ((last - first) / steps, steps as usize + 1);
        let axis = Axis { first, spacing, points, positions: positions.len() };
        // Between grid points at most a tenth of the spacing: more is no rounding but another grid.
        let on_grid = |v: &f64| {
            let steps = (v - first) / axis.spacing;
            (steps - steps.round()).abs() < 0.1
        };
        (sorted.iter().all(on_grid)).then_some(axis)
    }
}

fn irregular(name: &str) -> Problem {
    Problem::unsupported(
        format!("a set of points whose {name} coordinates are not equally spaced"),
        format!("resample it to a regular grid along x and y first; {HINT}"),
    )
}

fn gridded(
    table: &Table,
    [x, y, z]: [usize; 3],
    x_axis: &Axis,
    y_axis: &Axis,
    first_line: usize,
) -> Result<Array2<f64>> {
    let cells = grid::points(x_axis.points as u64, y_axis.points as u64)?;
    if cells > MOST_CELLS_PER_POINT * table.len() {
        return Err(irregular("x and y"));
    }
    let mut heights = Array2::from_elem((x_axis.points, y_axis.points), f64::NAN);
    let mut seen = Array2::from_elem((x_axis.points, y_axis.points), false);
    for (line, point) in table.lines().enumerate() {
        let cell = [x_axis.index(point[x]), y_axis.index(point[y])];
        if let (Some(height), Some(seen)) = (heights.get_mut(cell), seen.get_mut(cell)) {
            if std::mem::replace(seen, true) {
                return Err(Problem::malformed(
                    format!("point {} of the list (from line {first_line})", line + 1),
                    format!("again at x = {}, y = {}", point[x], point[y]),
                    format!("at a place of its own; {HINT}"),
                ));
            }
            *height = point[z];
        }
    }
    Ok(heights)
}
