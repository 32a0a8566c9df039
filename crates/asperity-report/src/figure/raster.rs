//! Pictures of cells: a colour each, as PNG.

use ndarray::{Array2, ArrayView2, s};

use super::drawing::Pixels;

/// Most cells of a side that a figure holds: a hand's breadth at 300 dots per inch.
const FINEST: usize = 1024;
/// The colour of a value that is not finite: a grey that no gradient has.
pub(super) const BLANK: [u8; 3] = [200, 200, 200];

/// Cells of a side of the blocks that make a map fit for a figure.
pub(crate) fn block(values: ArrayView2<f64>) -> usize {
    let (nx, ny) = values.dim();
    nx.max(ny).div_ceil(FINEST).max(1)
}

/// Means over blocks of `block` by `block` cells; a block is undefined where no value of it is finite.
pub(crate) fn means(values: ArrayView2<f64>, block: usize) -> Array2<f64> {
    blocks(values, block, |cells| {
        let finite = cells.iter().filter(|v| v.is_finite());
        let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
        if count > 0.0 { sum / count } else { f64::NAN }
    })
}

/// The commonest state of each block; of two as common the higher one.
pub(crate) fn states(values: ArrayView2<f64>, block: usize) -> Array2<f64> {
    blocks(values, block, |cells| {
        let mut counts = [0usize; 8];
        cells.iter().filter(|v| (0.0..8.0).contains(*v)).for_each(|v| counts[*v as usize] += 1);
        (0..8).max_by_key(|state| counts[*state]).map_or(0.0, |state| state as f64)
    })
}

fn blocks(values: ArrayView2<f64>, block: usize, one: impl Fn(ArrayView2<f64>) -> f64) -> Array2<f64> {
    if block <= 1 {
        return values.to_owned();
    }
    let (nx, ny) = values.dim();
    Array2::from_shape_fn((nx.div_ceil(block), ny.div_ceil(block)), |(i, j)| {
        let rows = i * block..((i + 1) * block).min(nx);
        let columns = j * block..((j + 1) * block).min(ny);
        one(values.slice(s![rows, columns]))
    })
}

/// Cells in their colours: axis 0 to the right, axis 1 upwards.
pub(super) fn coloured([nx, ny]: [usize; 2], colour: impl FnMut([usize; 2]) -> [u8; 3]) -> Pixels {
    let cells = (0..ny).rev().flat_map(|j| (0..nx).map(move |i| [i, j]));
    Pixels { size: [nx, ny], rgb: cells.flat_map(colour).collect() }
}

/// The pixels as a PNG. Fails only where a side is 0 or beyond 2^31: no figure has these.
pub(super) fn png(pixels: &Pixels) -> Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let [width, height] = pixels.size.map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels.rgb)?;
    writer.finish()?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::{Colours, Map, State};
    use super::*;

    #[test]
    fn a_png_holds_the_pixels() {
        let pixels = Pixels { size: [2, 1], rgb: vec![1, 2, 3, 250, 251, 252] };
        let mut reader = png::Decoder::new(std::io::Cursor::new(png(&pixels).unwrap())).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!((info.width, info.height, rgb), (2, 1, pixels.rgb));
    }

    #[test]
    fn x_goes_right_and_y_goes_up() {
        const NAMES: [State; 3] = [("", [1; 3]), ("", [2; 3]), ("", [3; 3])];
        let values = ndarray::array![[0.0, 1.0], [2.0, f64::NAN], [7.0, 0.0]];
        let pixels = Map::states("", &NAMES, values.view(), [1.0; 2]).picture();
        assert_eq!(pixels.size, [3, 2]);
        assert_eq!(pixels.rgb, [[2, 2, 2], BLANK, [1, 1, 1], [1, 1, 1], [3, 3, 3], BLANK].concat());
    }

    #[test]
    fn states_other_than_0_hide_the_values() {
        const NAMES: [State; 3] = [("", [0; 3]), ("contact", [1; 3]), ("pocket", [2; 3])];
        let values = ndarray::array![[5.0, f64::NAN], [6.0, 7.0]];
        let cells = ndarray::array![[0.0, 1.0], [2.0, 0.0]];
        let map = Map::new("", ["height", "m"], Colours::Sequential, values.view(), [1.0; 2]);
        let scale = map.scale().unwrap();
        let pixels = map.covered(&NAMES, cells.view()).picture();
        assert_eq!(pixels.rgb, [[1; 3], scale.at(7.0), scale.at(5.0), [2; 3]].concat());
    }

    #[test]
    fn large_maps_become_means_of_blocks() {
        let mut values = Array2::from_shape_fn((2050, 7), |(i, j)| (i + j) as f64);
        values[[0, 0]] = f64::NAN;
        let small = means(values.view(), block(values.view()));
        assert_eq!(small.dim(), (684, 3));
        // Rows and columns 0..3 without the corner: the sum of i + j is 18 over 8 cells.
        assert_eq!(small[[0, 0]], 18.0 / 8.0);
        assert_eq!(small[[683, 2]], 2049.0 + 6.0);
        // Two of three rows of each block are in state 1.
        let rows = Array2::from_shape_fn((2049, 6), |(i, _)| f64::from(u8::from(i % 3 > 0)));
        assert!(states(rows.view(), 3).iter().all(|state| *state == 1.0));
    }
}
