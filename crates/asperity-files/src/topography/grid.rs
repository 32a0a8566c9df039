//! From the order of a file to axis 0 = x.

use ndarray::Array2;
use rayon::prelude::*;

use super::sample::{FEW, Kind, Order, decode_into};
use super::{Problem, Result};

/// Most points of a topography, as of a grid.
pub(super) const MOST_POINTS: usize = 1 << 31;

/// Columns and lines of the tiles in which a map is transposed: a tile of binary64 fits the innermost cache.
const TILE: usize = 32;

/// Number of points nx ny, refused where it is 0 or absurd.
pub(super) fn points(nx: u64, ny: u64) -> Result<usize> {
    match nx.checked_mul(ny) {
        Some(n) if n > 0 && n <= MOST_POINTS as u64 => Ok(n as usize),
        _ => Err(Problem::malformed(
            "the number of points",
            format!("{nx} x {ny}"),
            "at least 1 along x and y and at most 2^31 in all",
        )),
    }
}

/// How a file of binary numbers holds a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Points along x and y.
    pub points: [u64; 2],
    /// Type of the numbers.
    pub kind: Kind,
    /// Order of their bytes.
    pub order: Order,
    /// Bytes from the start of a line to that of the next.
    pub stride: u64,
    /// Whether the lines are in the order of falling y.
    pub bottom_up: bool,
}

impl Layout {
    /// Lines (x runs fastest) without padding between them.
    pub(super) fn dense(points: [u64; 2], kind: Kind, order: Order) -> Self {
        let stride = points[0].saturating_mul(kind.width() as u64);
        Layout { points, kind, order, stride, bottom_up: false }
    }

    /// The same with lines in the order of falling y.
    pub(super) fn bottom_up(self) -> Self {
        Layout { bottom_up: true, ..self }
    }

    /// The map with axis 0 = x, each number replaced by `value` of it. The padding of the last line may be missing.
    ///
    /// # Errors
    /// An absurd number of points, or [`Problem::Truncated`]; nothing is allocated then.
    pub(super) fn map(
        self,
        bytes: &[u8],
        what: &str,
        value: impl Fn(f64) -> f64 + Sync,
    ) -> Result<Array2<f64>> {
        self.read(bytes, what, &|line| line.iter_mut().for_each(|v| *v = value(*v)))
    }

    /// `values` replaces the numbers of a part of a line.
    fn read(self, bytes: &[u8], what: &str, values: &(dyn Fn(&mut [f64]) + Sync)) -> Result<Array2<f64>> {
        let [nx, ny] = self.points;
        points(nx, ny)?;
        let line = nx.saturating_mul(self.kind.width() as u64);
        let needed = self.stride.saturating_mul(ny - 1).saturating_add(line);
        if self.stride < line {
            return Err(Problem::truncated(what, needed.max(line), bytes.len() as u64));
        }
        Problem::check_length(what, needed, bytes.len())?;
        // In range: checked against the length of `bytes`.
        let (nx, ny, stride) = (nx as usize, ny as usize, self.stride as usize);
        let width = self.kind.width();
        Ok(transposed(nx, ny, &|y, columns, out| {
            let y = if self.bottom_up { ny - 1 - y } else { y };
            let line = &bytes[y * stride..][columns.start * width..columns.end * width];
            decode_into(out, line, self.kind, self.order);
            values(out);
        }))
    }
}

/// Values given line by line (x runs fastest) as an array with axis 0 = x, each replaced by `value` of it.
pub(super) fn from_lines(nx: usize, lines: &[&[f64]], value: impl Fn(f64) -> f64 + Sync) -> Array2<f64> {
    transposed(nx, lines.len(), &|y, columns, out| {
        for (number, out) in lines[y][columns].iter().zip(out) {
            *out = value(*number);
        }
    })
}

/// Replaces every value.
pub(super) fn replace(map: &mut Array2<f64>, value: impl Fn(f64) -> f64 + Sync + Send) {
    if map.len() < FEW { map.mapv_inplace(value) } else { map.par_mapv_inplace(value) }
}

/// Marks the points as undefined whose number in the mask is `masked`.
pub(super) fn undefine(map: &mut Array2<f64>, mask: &Array2<f64>, masked: impl Fn(f64) -> bool) {
    map.zip_mut_with(mask, |value, mask| {
        if masked(*mask) {
            *value = f64::NAN;
        }
    });
}

/// Writes the values of line y between two columns.
type Line<'a> = dyn Fn(usize, std::ops::Range<usize>, &mut [f64]) + Sync + 'a;

/// The map whose line y, between two columns, is what `line` writes.
fn transposed(nx: usize, ny: usize, line: &Line<'_>) -> Array2<f64> {
    let mut map = vec![0.0; nx * ny];
    let fill = |(band, out): (usize, &mut [f64])| {
        let columns = band * TILE..band * TILE + out.len() / ny;
        // One column more than the tile has keeps its columns out of one cache set.
        let mut tile = [0.0; TILE * (TILE + 1)];
        for first in (0..ny).step_by(TILE) {
            let last = (first + TILE).min(ny);
            for y in first..last {
                let start = (y - first) * (TILE + 1);
                line(y, columns.clone(), &mut tile[start..start + columns.len()]);
            }
            for (x, column) in out.chunks_exact_mut(ny).enumerate() {
                for (y, out) in column[first..last].iter_mut().enumerate() {
                    *out = tile[y * (TILE + 1) + x];
                }
            }
        }
    };
    let band = TILE * ny.max(1);
    if map.len() < FEW {
        map.chunks_mut(band).enumerate().for_each(fill);
    } else {
        map.par_chunks_mut(band).enumerate().for_each(fill);
    }
    // The lengths agree by construction.
    Array2::from_shape_vec((nx, ny), map).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_the_file_runs_along_axis_0() {
        // Neither a multiple of a tile nor square.
        for (nx, ny) in [(1, 1), (70, 33), (5, 129), (32, 64)] {
            let values: Vec<f64> = (0..nx * ny).map(|k| k as f64).collect();
            let heights = from_lines(nx, &values.chunks(nx).collect::<Vec<_>>(), |v| v + 1.0);
            assert_eq!(heights.dim(), (nx, ny));
            for ((x, y), h) in heights.indexed_iter() {
                assert_eq!(*h, (y * nx + x) as f64 + 1.0);
            }
        }
    }

    #[test]
    fn padded_lines_of_every_order_are_read() {
        // Lines of three 16-bit numbers, padded to 8 bytes except the last.
        let numbers = |to: fn(i16) -> [u8; 2]| {
            let mut bytes = Vec::new();
            for y in 0..40 {
                (0..3).for_each(|x| bytes.extend(to(10 * y + x)));
                bytes.extend([9, 9]);
            }
            bytes.truncate(bytes.len() - 2);
            bytes
        };
        for (order, bytes) in
            [(Order::Little, numbers(i16::to_le_bytes)), (Order::Big, numbers(i16::to_be_bytes))]
        {
            let layout = Layout { stride: 8, ..Layout::dense([3, 40], Kind::I16, order) };
            let map = layout.map(&bytes, "the map", |v| -v).unwrap();
            assert!(map.indexed_iter().all(|((x, y), v)| *v == -((10 * y + x) as f64)));
            let error = layout.map(&bytes[1..], "the map", |v| v).unwrap_err();
            assert!(matches!(error, Problem::Truncated { needed: 318, available: 317, .. }), "{error}");
        }
        let layout = Layout::dense([2, 3], Kind::U8, Order::Little);
        let map = layout.bottom_up().map(&[4, 5, 2, 3, 0, 1], "the map", |v| v).unwrap();
        assert!(map.indexed_iter().all(|((x, y), v)| *v == (2 * y + x) as f64), "{map}");
        let absurd = Layout::dense([u64::MAX, 1], Kind::F64, Order::Big);
        assert!(absurd.map(&[], "the map", |v| v).is_err());
    }

    #[test]
    fn absurd_shapes_are_refused() {
        assert!(
            points(0, 5).is_err() && points(1 << 16, 1 << 16).is_err() && points(u64::MAX, u64::MAX).is_err()
        );
        assert_eq!(points(1 << 15, 1 << 16).ok(), Some(1 << 31));
    }
}
