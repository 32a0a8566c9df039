//! Pictures out of letters.

use ndarray::{Array2, ArrayView2};

/// Numbers as a row of bars from the least to the greatest, the mean of neighbours where there are more than
/// `width`; numbers that differ by rounding only are half high.
pub fn sparkline(values: &[f64], width: usize) -> String {
    const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let [low, high] =
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
    let letters = values.len().min(width);
    let part = |k: usize| &values[k * values.len() / letters..(k + 1) * values.len() / letters];
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let flat = high - low <= 1e-9 * high.abs();
    let bar =
        |v: f64| if flat { 3 } else { ((v - low) / (high - low) * 7.0).round().clamp(0.0, 7.0) as usize };
    (0..letters).map(|k| BARS[bar(mean(part(k)))]).collect()
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
        assert_eq!(sparkline(&[], 8), "");
        assert_eq!(sparkline(&[0.0, 0.0], 8), "▄▄");
        assert_eq!(sparkline(&[1.0, 2.0, 3.0, 8.0], 8), "▁▂▃█");
        assert_eq!(sparkline(&[5.0, 5.0 + 1e-12, 5.0], 16), "▄▄▄");
        let long: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(sparkline(&long, 8), "▁▂▃▄▅▆▇█");
    }

    #[test]
    fn a_map_of_letters_has_x_to_the_right_and_y_upwards() {
        let map = Array2::from_shape_fn((8, 8), |(i, j)| i >= 4 && j >= 4);
        assert_eq!(shares(map.view(), 4, 1.0), "┌────┐\n│  ██│\n│    │\n└────┘\n");
        let one = Array2::from_shape_fn((8, 8), |(i, j)| (i, j) == (0, 0));
        assert_eq!(shares(one.view(), 4, 1.0), "┌────┐\n│    │\n│░   │\n└────┘\n");
    }
}
