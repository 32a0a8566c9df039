//! Windows: a measured surface is not periodic, and the jump from edge to edge would dominate the spectrum as q^-2. A window
//! reduces the heights to zero towards the edges before the spectrum is computed.

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

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Window::Hann => write!(f, "Hann window"),
            Window::Tukey { share } => write!(f, "Tukey window over {} % of the length", 100.0 * share),
        }
    }
}

/// Heights times the window, which is scaled to mean square 1 so that the power of a random surface is
/// kept (T. D. B. Jacobs et al., Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, section 3.4). Level the
/// surface first: a window turns a mean or a tilt into long waves.
///
/// # Errors
/// [`Error::Invalid`] if the share of Tukey's window is not in \[0, 1\].
pub fn window(surface: &Surface, shape: Window) -> Result<Surface> {
    if let Window::Tukey { share } = shape
        && !(0.0..=1.0).contains(&share)
    {
        return Err(Error::invalid("share of the Tukey window", share, "between 0 and 1"));
    }
    let [along_x, along_y] = surface.grid().cells().map(|n| weights(shape, n));
    let mut windowed = surface.clone();
    windowed.heights.outer_iter_mut().into_par_iter().zip(along_x).for_each(|(mut row, at_x)| {
        row.iter_mut().zip(&along_y).for_each(|(z, at_y)| *z *= at_x * at_y);
    });
    Ok(windowed)
}

/// The window at n cell centres, mean square 1.
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
    let mut weights: Vec<f64> = (0..n).map(at).collect();
    let rms = (weights.iter().map(|w| w * w).sum::<f64>() / n as f64).sqrt();
    weights.iter_mut().for_each(|w| *w /= rms);
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::Array2;

    #[test]
    fn windows_keep_the_mean_square_and_fade() {
        for n in [1, 2, 7, 64] {
            for shape in [Window::Hann, Window::Tukey { share: 0.25 }, Window::Tukey { share: 0.0 }] {
                let w = weights(shape, n);
                let square: f64 = w.iter().map(|w| w * w).sum::<f64>() / n as f64;
                assert!((square - 1.0).abs() < 1e-14 && w[0] <= w[n / 2]);
                assert!((w[0] - w[n - 1]).abs() < 1e-14);
            }
        }
        // The mean square of Hann's window is 3/8.
        assert!((weights(Window::Hann, 1000)[499] - (8.0f64 / 3.0).sqrt()).abs() < 1e-5);
        let (tukey, hann) = (weights(Window::Tukey { share: 1.0 }, 9), weights(Window::Hann, 9));
        assert!(tukey.iter().zip(&hann).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    #[test]
    fn a_windowed_surface_is_the_product() {
        let grid = Grid::new([8, 6], [1.0, 1.0]).unwrap();
        let surface = Surface::new(grid, Array2::from_elem((8, 6), 2.0)).unwrap();
        let faded = window(&surface, Window::Hann).unwrap();
        let (wx, wy) = (weights(Window::Hann, 8), weights(Window::Hann, 6));
        assert_eq!(faded.heights()[[3, 1]], 2.0 * (wx[3] * wy[1]));
        assert!(window(&surface, Window::Tukey { share: 1.5 }).is_err());
    }
}
