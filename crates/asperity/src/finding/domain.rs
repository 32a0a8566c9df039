//! The border of the domain.
//!
//! Nothing touches outside a free domain. A periodic domain repeats, so its gap must be continuous across the border.

use ndarray::{Array2, ArrayView2, Axis};

use super::plausible::SIDES;
use super::words::{digits, si};
use super::{CONTACT_AT_BORDER, Finding, GAP_NOT_PERIODIC, ROUGH_ON_FREE_DOMAIN, UNLIKELY_UNIT};
use crate::grid::Grid;
use crate::surface::Surface;

/// A gap is not periodic if its second difference across the border is larger than the largest one inside by this factor.
const JUMP: f64 = 2.0;
/// Gaps that vary by less than this fraction of their range are flat: the variation is rounding of the sum of parts.
const ROUNDING: f64 = 1e-9;
/// Smallest difference between the gap at the border and the mean gap, over the standard deviation of the gap. A sphere has 1.6,
/// a cone 1.3, a cylinder 1.1; a rough plane, a wave or a tilted plane has 0.
const CONFINED: f64 = 0.5;

/// A domain of an implausible size.
pub(super) fn unlikely_size(grid: &Grid) -> Option<Finding> {
    let [least, most] = SIDES;
    let side = grid.extents().iter().copied().find(|side| !(least..most).contains(side))?;
    let limit = if side < least { least } else { most };
    let text = format!(
        "A side of the domain is {}; domains of contacts have {} to {}. Check the unit of its size and of the heights.",
        si(side, "m"),
        si(least, "m"),
        si(most, "m")
    );
    Some(Finding::warning(UNLIKELY_UNIT, side, limit, text))
}

/// Whether any cell of the border of a field is positive.
pub(super) fn touches_border(grid: &Grid, pressure: ArrayView2<'_, f64>) -> bool {
    border(grid).any(|at| pressure[at] > 0.0)
}

/// Contact at the border of a free domain, in these rows. `needed` is the side of the domain that the contact would need \[m\],
/// if the gap determines it; `contact` begins the sentence.
pub(super) fn at_border(grid: &Grid, confined: bool, needed: Option<f64>, contact: &str) -> Finding {
    let side = grid.shortest_side();
    let times = |lengths: &[f64]| lengths.iter().map(|l| si(*l, "m")).collect::<Vec<_>>().join(" x ");
    let size = times(grid.extents());
    let cure = match needed.filter(|needed| confined && *needed > side) {
        Some(needed) => {
            let needed = times(&vec![needed; grid.dimensions()]);
            format!("Take a domain of at least {needed} (domain.size), or less load.")
        }
        None if confined => "Take a larger domain (domain.size), or less load.".to_owned(),
        None => "If the surface continues beyond the domain, use boundary = \"periodic\".".to_owned(),
    };
    let limit = needed.filter(|needed| confined && *needed > side).unwrap_or(f64::NAN);
    Finding::warning(
        CONTACT_AT_BORDER,
        side,
        limit,
        format!(
            "{contact} reaches the border of the free domain of {size}: nothing beyond it touches, so contact area, pressure and \
             approach are those of a body that ends there. {cure}"
        ),
    )
}

/// Radius of the paraboloid of the gap at the border of the domain about its lowest cell \[m\]: the mean of r²/(2 h). `None` if
/// the gap is closed or infinite there.
pub(super) fn radius(grid: &Grid, gap: &Array2<f64>) -> Option<f64> {
    let (mut lowest, mut place) = (f64::INFINITY, (0, 0));
    for (at, h) in gap.indexed_iter() {
        if *h < lowest {
            (lowest, place) = (*h, at);
        }
    }
    let (x0, y0) = (grid.x(place.0), grid.y(place.1));
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, j) in border(grid) {
        let h = gap[(i, j)] - lowest;
        let square = (grid.x(i) - x0).powi(2) + (grid.y(j) - y0).powi(2);
        if h > 0.0 && h.is_finite() && square > 0.0 {
            sum += 2.0 * h / square;
            count += 1.0;
        }
    }
    (count > 0.0 && sum > 0.0).then(|| count / sum)
}

/// Cells of the border; for a line, its ends.
fn border(grid: &Grid) -> impl Iterator<Item = (usize, usize)> {
    let [nx, ny] = grid.cells();
    let sides = if grid.is_line() { 0 } else { nx };
    let ends = (0..ny).flat_map(move |j| [(0, j), (nx - 1, j)]);
    ends.chain((0..sides).flat_map(move |i| [(i, 0), (i, ny - 1)]))
}

/// Difference between the gap at the border and the mean gap, over the standard deviation of the gap; `None` if cells cannot
/// touch, or if nothing varies (flat on flat, a punch as large as the domain).
pub(super) fn widening(grid: &Grid, gap: &Array2<f64>) -> Option<f64> {
    let cells = gap.len() as f64;
    let mean = gap.sum() / cells;
    let spread = (gap.fold(0.0, |sum, h| sum + (h - mean) * (h - mean)) / cells).sqrt();
    let (sum, count) = border(grid).fold((0.0, 0.0), |(sum, count), at| (sum + gap[at], count + 1.0));
    (mean.is_finite() && spread > ROUNDING * mean.abs()).then(|| (sum / count - mean) / spread)
}

/// Whether the contact is confined by something other than the end of the domain.
pub(super) fn confined(grid: &Grid, gap: &Array2<f64>) -> bool {
    widening(grid, gap).is_none_or(|widening| widening > CONFINED)
}

/// A surface on a free domain that only the end of the domain confines.
pub(super) fn unconfined(grid: &Grid, gap: &Array2<f64>) -> Option<Finding> {
    let widening = widening(grid, gap).filter(|widening| *widening <= CONFINED)?;
    Some(Finding::warning(
        ROUGH_ON_FREE_DOMAIN,
        widening,
        CONFINED,
        "The gap is no wider at the border of the free domain than inside it: the surface ends there like a punch, and \
         the pressure rises towards the border. For a part of a larger surface use boundary = \"periodic\". For a body \
         that ends there this is correct.",
    ))
}

/// A periodic gap that is not continuous across the border. The second differences there are compared with the largest of the
/// lines inside, cell by cell (rms) and for the line as a whole (mean). Across the seam of a surface that was `mirrored` the gap has no
/// jump, and its slope changes sign, as the continuation by reflections is made.
pub(super) fn not_periodic(grid: &Grid, gap: &Array2<f64>, mirrored: bool) -> Option<Finding> {
    let (axis, Kink { jump, slope, inside }) = worst_kink(gap.view(), mirrored)?;
    let name = ["x", "y"][axis];
    let (slope, range) = (slope / grid.spacing()[axis], range(gap.view()));
    Some(Finding::warning(
        GAP_NOT_PERIODIC,
        jump,
        inside,
        format!(
            "The gap is not continuous across the border of the periodic domain along {name}: it jumps by {}, {} times as much \
             as between neighbouring cells inside, and its slope changes by {}. The jump acts like an edge. Use boundary = \
             \"free\" for a single body. Level a measured surface and continue it by its reflections (border = \"mirror\"); a window \
             would close the passages at the border. For heights that are periodic as they are (a generated map), take level = \"none\". \
             Let the domain hold whole waves.",
            si(jump, "m"),
            digits(jump / inside.max(ROUNDING * range)),
            digits(slope)
        ),
    ))
}

/// Whether a surface continues across its borders: no jump or kink there is larger than what its cells show inside. Where neighbouring cells
/// have hardly more to do with each other than distant ones, that cannot be told, and the answer is no.
pub fn repeats(surface: &Surface) -> bool {
    let heights = surface.heights();
    worst_kink(heights, false).is_none() && [0, 1].into_iter().all(|axis| is_smooth(heights, axis))
}

/// Whether the mean square difference of neighbours is below the variance; it is twice the variance of cells that know nothing of each other.
fn is_smooth(heights: ArrayView2<'_, f64>, axis: usize) -> bool {
    let lines = heights.len_of(Axis(axis));
    if lines < 2 {
        return true;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let known: Vec<f64> = heights.iter().copied().filter(|h| h.is_finite()).collect();
    let middle = mean(&known);
    let variance = mean(&known.iter().map(|h| (h - middle).powi(2)).collect::<Vec<_>>());
    let [before, after] = [(0, lines - 1), (1, lines)]
        .map(|(from, to)| heights.slice_axis(Axis(axis), ndarray::Slice::from(from..to)));
    let steps = before.iter().zip(after).map(|(a, b)| (b - a).powi(2));
    mean(&steps.filter(|square| square.is_finite()).collect::<Vec<_>>()) <= variance
}

/// The axis across whose border the heights or gaps jump most, where they do.
fn worst_kink(heights: ArrayView2<'_, f64>, mirrored: bool) -> Option<(usize, Kink)> {
    let range = range(heights);
    let found =
        [0, 1].into_iter().filter_map(|axis| kink(heights, axis, range, mirrored).map(|kink| (axis, kink)));
    found.max_by(|a, b| a.1.jump.total_cmp(&b.1.jump))
}

/// Highest less lowest finite value.
fn range(heights: ArrayView2<'_, f64>) -> f64 {
    let finite = || heights.iter().copied().filter(|h| h.is_finite());
    finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
}

struct Kink {
    /// Largest rms or mean second difference across the border, and inside \[m\].
    jump: f64,
    inside: f64,
    /// Change of the mean first difference across the border \[m\].
    slope: f64,
}

/// The kink at the border along an axis, if there is one.
fn kink(heights: ArrayView2<'_, f64>, axis: usize, range: f64, mirrored: bool) -> Option<Kink> {
    let lines = heights.len_of(Axis(axis));
    if lines < 5 {
        return None;
    }
    let bends = bends(heights, axis);
    let (inner, mut ends) = (&bends[1..lines - 1], [bends[0], bends[lines - 1]]);
    if mirrored {
        let seam = across(heights, axis);
        ends = [seam, seam];
    }
    let size = |line: &[f64; 2], k: usize| line[k].abs();
    let largest =
        |list: &[[f64; 2]], k: usize| list.iter().fold(0.0, |most: f64, line| most.max(size(line, k)));
    let found = [0, 1].map(|k| (largest(&ends, k), largest(inner, k)));
    let (jump, inside) =
        found.into_iter().find(|(across, inside)| *across > (JUMP * inside).max(ROUNDING * range))?;
    Some(Kink { jump, inside, slope: (ends[0][1] + ends[1][1]).abs() })
}

/// Root mean square and mean of the second differences along an axis, of each line of the domain across it. Cells that
/// cannot touch, and their neighbours, are left out.
fn bends(gap: ArrayView2<'_, f64>, axis: usize) -> Vec<[f64; 2]> {
    let (nx, ny) = gap.dim();
    let lines = [nx, ny][axis];
    let mut sums = vec![[0.0_f64; 3]; lines];
    let mut add = |line: usize, before: f64, here: f64, after: f64| {
        let bend = before - 2.0 * here + after;
        if bend.is_finite() {
            let [squares, sum, count] = &mut sums[line];
            (*squares, *sum, *count) = (*squares + bend * bend, *sum + bend, *count + 1.0);
        }
    };
    for i in 0..nx {
        let row = gap.row(i);
        if axis == 0 {
            let (before, after) = (gap.row((i + nx - 1) % nx), gap.row((i + 1) % nx));
            row.iter()
                .zip(before)
                .zip(after)
                .for_each(|((here, before), after)| add(i, *before, *here, *after));
        } else {
            (0..ny).for_each(|j| add(j, row[(j + ny - 1) % ny], row[j], row[(j + 1) % ny]));
        }
    }
    sums.into_iter().map(rms_and_mean).collect()
}

/// Root mean square and mean of the first differences across the border along an axis.
fn across(heights: ArrayView2<'_, f64>, axis: usize) -> [f64; 2] {
    let line = |k: usize| heights.index_axis(Axis(axis), k);
    let last = heights.len_of(Axis(axis)) - 1;
    let jumps = line(last).into_iter().zip(line(0)).map(|(last, first)| first - last);
    let add = |[squares, sum, count]: [f64; 3], x: f64| [squares + x * x, sum + x, count + 1.0];
    rms_and_mean(jumps.filter(|jump| jump.is_finite()).fold([0.0; 3], add))
}

/// Of a sum of squares, a sum and a count; 0 of none.
fn rms_and_mean([squares, sum, count]: [f64; 3]) -> [f64; 2] {
    if count > 0.0 { [f64::sqrt(squares / count), sum / count] } else { [0.0, 0.0] }
}
