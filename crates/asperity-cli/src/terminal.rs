//! Pictures out of letters.

use asperity::Axis;
use asperity_report::result::is_logarithmic;
use ndarray::{Array2, ArrayView2};

use crate::format::extent;

const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Numbers of rows at their coordinates on `axis`, as a row of `width` bars from the least to the greatest.
///
/// A bar is the mean of the numbers in its part of the axis; where there are none, the value on the straight line
/// between the neighbours. The axis is logarithmic where it is in figures. Numbers that differ by rounding only are
/// half high.
pub fn sparkline(axis: Axis, rows: &[f64], values: &[f64], width: usize) -> String {
    let log = is_logarithmic(rows, axis);
    let points: Vec<[f64; 2]> = rows
        .iter()
        .zip(values)
        .filter(|(row, value)| value.is_finite() && (!log || **row > 0.0))
        .map(|(row, value)| [if log { row.log10() } else { *row }, *value])
        .collect();
    let [Some(first), Some(last)] = [points.first(), points.last()] else { return String::new() };
    let [low, high] = extent(points.iter().map(|[_, value]| *value));
    let flat = high - low <= 1e-9 * high.abs();
    let bar = |v: f64| match flat {
        true => BARS[3],
        false => BARS[((v - low) / (high - low) * 7.0).round().clamp(0.0, 7.0) as usize],
    };
    let step = (last[0] - first[0]) / width as f64;
    if step <= 0.0 {
        return bar(last[1]).into();
    }
    let part = |k: usize| {
        let from = first[0] + k as f64 * step;
        let inside = |[at, _]: &&[f64; 2]| *at >= from && (*at < from + step || k + 1 == width);
        let (sum, count) =
            points.iter().filter(inside).fold((0.0, 0.0), |(sum, count), [_, v]| (sum + v, count + 1.0));
        if count > 0.0 { sum / count } else { between(&points, from + 0.5 * step) }
    };
    (0..width).map(|k| bar(part(k))).collect()
}

/// The value at a place on the straight lines between points.
fn between(points: &[[f64; 2]], at: f64) -> f64 {
    let n = points.partition_point(|[place, _]| *place <= at).clamp(1, points.len() - 1);
    let [[x0, y0], [x1, y1]] = [points[n - 1], points[n]];
    if x1 > x0 { y0 + (y1 - y0) * (at - x0) / (x1 - x0) } else { y1 }
}

/// How much of each block of a map is true, `columns` blocks wide, as letters; x to the right, y upwards. A letter
/// is twice as high as wide.
pub fn shares(map: ArrayView2<bool>, columns: usize, aspect: f64) -> String {
    const SHADES: [char; 5] = [' ', '░', '▒', '▓', '█'];
    let (nx, ny) = map.dim();
    let columns = columns.min(nx).max(1);
    let lines = ((columns as f64 * aspect / 2.0).round() as usize).clamp(1, ny.min(columns));
    let share = Array2::from_shape_fn((columns, lines), |(a, b)| {
        let (x, y) = (a * nx / columns..(a + 1) * nx / columns, b * ny / lines..(b + 1) * ny / lines);
        let cells = (x.len() * y.len()) as f64;
        let on = x.flat_map(|i| y.clone().map(move |j| (i, j))).filter(|at| map[*at]).count();
        on as f64 / cells
    });
    // A block that touches at all shows.
    let shade =
        |share: f64| if share > 0.0 { SHADES[(share * 4.0).ceil().min(4.0) as usize] } else { SHADES[0] };
    let border = "─".repeat(columns);
    let mut text = format!("┌{border}┐\n");
    for b in (0..lines).rev() {
        text.push('│');
        text.extend((0..columns).map(|a| shade(share[[a, b]])));
        text.push_str("│\n");
    }
    text + &format!("└{border}┘\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sparkline_goes_from_the_least_to_the_greatest() {
        let even: Vec<f64> = (0..1000).map(f64::from).collect();
        let over = |values: &[f64], width| sparkline(Axis::Time, &even[..values.len()], values, width);
        assert_eq!(over(&[], 8), "");
        assert_eq!(over(&[2.0], 8), "▄");
        assert_eq!(over(&[0.0, 0.0], 2), "▄▄");
        assert_eq!(over(&[1.0, 2.0, 3.0, 8.0], 4), "▁▂▃█");
        assert_eq!(over(&[5.0, 5.0 + 1e-12, 5.0], 3), "▄▄▄");
        assert_eq!(over(&even, 8), "▁▂▃▄▅▆▇█");
    }

    #[test]
    fn a_sparkline_goes_by_time_and_not_by_row() {
        // Most rows lie in the first of four seconds, where nothing changes.
        let times = [0.0, 0.2, 0.4, 0.6, 0.8, 2.0, 3.0, 4.0];
        let values = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 7.0, 7.0];
        assert_eq!(sparkline(Axis::Time, &times, &values, 4), "▁▁▁█");
        // Rows per decade: the axis is logarithmic, and t = 0 has no place on it.
        let times: Vec<f64> = std::iter::once(0.0).chain((0..8).map(|n| 10f64.powi(n))).collect();
        let values: Vec<f64> = std::iter::once(-50.0).chain((0..8).map(f64::from)).collect();
        assert_eq!(sparkline(Axis::Time, &times, &values, 8), "▁▂▃▄▅▆▇█");
        // Between rows that are far apart it goes straight.
        assert_eq!(sparkline(Axis::Time, &[0.0, 7.0], &[0.0, 7.0], 7), "▁▃▄▅▆▇█");
    }

    #[test]
    fn a_map_of_letters_has_x_to_the_right_and_y_upwards() {
        let map = Array2::from_shape_fn((8, 8), |(i, j)| i >= 4 && j >= 4);
        assert_eq!(shares(map.view(), 4, 1.0), "┌────┐\n│  ██│\n│    │\n└────┘\n");
        let one = Array2::from_shape_fn((8, 8), |(i, j)| (i, j) == (0, 0));
        assert_eq!(shares(one.view(), 4, 1.0), "┌────┐\n│    │\n│░   │\n└────┘\n");
    }
}
