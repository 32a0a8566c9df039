//! Windows: opposite edges of a measured surface do not match. A window reduces the heights to zero towards the edges, so that
//! the surface can be continued periodically, in a contact or in a spectrum, where the jump would dominate as q^-2.

use std::f64::consts::{PI, TAU};
use std::fmt;

use ndarray::parallel::prelude::*;

use super::Surface;
use crate::error::{Error, Result};

/// The window along each axis; the two are multiplied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Window {
    /// (1 - cos(2 pi x / L)) / 2.
    Hann,
    /// Hann's flanks over this fraction of the length (half of it at each end), constant between; 1 is Hann.
    Tukey {
        /// Fraction of the length, 0 to 1.
        share: f64,
    },
}

/// How the sentence of a Hann window begins in a history, and that of Tukey's.
const HANN: &str = "Hann window";
const TUKEY: &str = "Tukey window over";

impl Window {
    /// Whether a sentence of a history says that the surface was windowed.
    pub(super) fn is_told_by(sentence: &str) -> bool {
        sentence.starts_with(HANN) || sentence.starts_with(TUKEY)
    }
}

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Window::Hann => f.write_str(HANN),
            Window::Tukey { share } => write!(f, "{TUKEY} {} % of the length", 100.0 * share),
        }
    }
}

/// Heights times the window, whose largest value is 1: no height grows. Level the surface first: a window turns a mean or a tilt
/// into long waves.
///
/// # Errors
/// [`Error::Invalid`] if the share of Tukey's window is not in \[0, 1\].
pub fn window(surface: &Surface, shape: Window) -> Result<Surface> {
    if let Window::Tukey { share } = shape
        && !(0.0..=1.0).contains(&share)
    {
        return Err(Error::invalid("share of the Tukey window", share, "between 0 and 1"));
    }
    Ok(times(surface, |n| weights(shape, n)))
}

/// Heights times Hann's window, scaled to mean square 1 so that the power of a random surface is kept (T. D. B. Jacobs et al.,
/// Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, section 3.4). For spectra only: heights in the middle grow 8/3 times.
pub fn window_for_spectrum(surface: &Surface) -> Surface {
    times(surface, |n| {
        let weights = weights(Window::Hann, n);
        let rms = (weights.iter().map(|w| w * w).sum::<f64>() / n as f64).sqrt();
        weights.into_iter().map(|w| w / rms).collect()
    })
}

/// Heights times the weights of n cells along each axis.
fn times(surface: &Surface, weights: impl Fn(usize) -> Vec<f64>) -> Surface {
    let [along_x, along_y] = surface.grid().cells().map(weights);
    let mut windowed = surface.clone();
    windowed.heights.outer_iter_mut().into_par_iter().zip(along_x).for_each(|(mut row, at_x)| {
        row.iter_mut().zip(&along_y).for_each(|(z, at_y)| *z *= at_x * at_y);
    });
    windowed
}

/// The window at n cell centres.
fn weights(shape: Window, n: usize) -> Vec<f64> {
    let at = |i: usize| {
        let x = (i as f64 + 0.5) / n as f64;
        match shape {
            Window::Hann => 0.5 - 0.5 * (TAU * x).cos(),
            Window::Tukey { share } => {
                let from_edge = x.min(1.0 - x);
                if from_edge < 0.5 * share { 0.5 - 0.5 * (PI * from_edge / (0.5 * share)).cos() } else { 1.0 }
            }
        }
    };
    (0..n).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::Array2;

    fn flat(cells: [usize; 2], height: f64) -> Surface {
        Surface::new(Grid::new(cells, [1.0, 1.0]).unwrap(), Array2::from_elem(cells, height)).unwrap()
    }

    #[test]
    fn windows_fade_and_let_no_height_grow() {
        for n in [1, 2, 7, 64] {
            for shape in [Window::Hann, Window::Tukey { share: 0.25 }, Window::Tukey { share: 0.0 }] {
                let w = weights(shape, n);
                assert!(w.iter().all(|w| (0.0..=1.0).contains(w)) && w[0] <= w[n / 2]);
                assert!((w[0] - w[n - 1]).abs() < 1e-14);
            }
        }
        // Tukey's window is 1 between its flanks: the first 8 of 64 cells and the last 8.
        let tukey = weights(Window::Tukey { share: 0.25 }, 64);
        assert!(tukey[8..56].iter().all(|&w| w == 1.0) && tukey[7] < 1.0 && tukey[56] < 1.0);
        let (tukey, hann) = (weights(Window::Tukey { share: 1.0 }, 9), weights(Window::Hann, 9));
        assert!(tukey.iter().zip(&hann).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    #[test]
    fn the_window_of_a_spectrum_keeps_the_mean_square() {
        for cells in [[1, 1], [2, 1], [7, 5], [64, 48]] {
            let faded = window_for_spectrum(&flat(cells, 1.0));
            let square = faded.heights().iter().map(|z| z * z).sum::<f64>() / faded.grid().len() as f64;
            assert!((square - 1.0).abs() < 1e-14);
        }
        // The mean square of Hann's window is 3/8 along each axis; half a cell from the middle it is lower by (pi/1000)^2 / 4.
        let middle = window_for_spectrum(&flat([1000, 1000], 1.0)).heights()[[499, 499]];
        assert!((middle - 8.0 / 3.0).abs() < 1e-4);
    }

    #[test]
    fn a_windowed_surface_is_the_product() {
        let surface = flat([8, 6], 2.0);
        let faded = window(&surface, Window::Hann).unwrap();
        let (wx, wy) = (weights(Window::Hann, 8), weights(Window::Hann, 6));
        assert_eq!(faded.heights()[[3, 1]], 2.0 * (wx[3] * wy[1]));
        assert!(window(&surface, Window::Tukey { share: 1.5 }).is_err());
    }
}
