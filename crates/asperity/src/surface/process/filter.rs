//! High-, low- and band-pass filters by wavelength.
//!
//! The surface is taken as periodic; level a measured one first, and mirror or window it. Sharp edges keep or drop a wave; Gaussian edges
//! multiply its amplitude by the areal Gaussian filter of ISO 16610-61, which passes half of it at the cut-off wavelength L:
//!
//! ```text
//! low-pass  2^(-(L/l)^2)          high-pass  1 - 2^(-(L/l)^2)
//! ```

use std::f64::consts::TAU;
use std::fmt;

use super::super::spectrum;
use super::Surface;
use crate::error::{Error, Result, positive};
use crate::grid::Grid;

/// The ends of the band of a filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Edge {
    /// Waves inside the band are kept unchanged, others are removed.
    #[default]
    Sharp,
    /// Gaussian, half of the amplitude at the cut-off (ISO 16610-61).
    Gaussian,
}

/// The wavelengths that are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Longest wavelength \[m\]; `None` keeps all long waves and the mean.
    pub longest: Option<f64>,
    /// Shortest wavelength \[m\]; `None` keeps all short waves.
    pub shortest: Option<f64>,
    /// The ends of the band.
    pub edge: Edge,
}

impl fmt::Display for Band {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let edge = match self.edge {
            Edge::Sharp => "sharp",
            Edge::Gaussian => "Gaussian",
        };
        match (self.longest, self.shortest) {
            (None, None) => write!(f, "keep all wavelengths"),
            (Some(longest), None) => write!(f, "keep wavelengths up to {longest:e} m ({edge})"),
            (None, Some(shortest)) => write!(f, "keep wavelengths from {shortest:e} m on ({edge})"),
            (Some(longest), Some(shortest)) => {
                write!(f, "keep wavelengths from {shortest:e} m to {longest:e} m ({edge})")
            }
        }
    }
}

impl Band {
    /// Fraction of the amplitude of a wave that is kept.
    fn share(&self, q: f64) -> f64 {
        let low_pass = |cut_off: f64| match self.edge {
            Edge::Sharp => f64::from(u8::from(q * cut_off <= TAU * (1.0 + 1e-9))),
            Edge::Gaussian => (-(q * cut_off / TAU).powi(2)).exp2(),
        };
        // A sharp band includes both of its ends.
        let high_pass = |cut_off: f64| match self.edge {
            Edge::Sharp => f64::from(u8::from(q * cut_off >= TAU * (1.0 - 1e-9))),
            Edge::Gaussian => 1.0 - low_pass(cut_off),
        };
        self.longest.map_or(1.0, high_pass) * self.shortest.map_or(1.0, low_pass)
    }
}

/// The waves of the surface within the band.
///
/// ```
/// use asperity::{Grid, surface::{Surface, process::{Band, Edge, filter}}};
/// let grid = Grid::new([64, 1], [1e-3, 1e-3])?;
/// let wave = |n: f64, i: usize| (std::f64::consts::TAU * n * (i as f64 + 0.5) / 64.0).cos();
/// let heights = ndarray::Array2::from_shape_fn((64, 1), |(i, _)| wave(2.0, i) + wave(20.0, i));
/// let band = Band { longest: None, shortest: Some(1e-4), edge: Edge::Sharp };
/// let smooth = filter(&Surface::new(grid, heights)?, band)?;
/// assert!((smooth.heights()[[5, 0]] - wave(2.0, 5)).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if a height is undefined, or a wavelength is not positive, the longest is below the shortest, the longest is
/// above the longer side of the surface, or the shortest below two cells: the surface holds no such waves.
pub fn filter(surface: &Surface, band: Band) -> Result<Surface> {
    for (name, cut_off) in [("longest wavelength", band.longest), ("shortest wavelength", band.shortest)] {
        if let Some(cut_off) = cut_off {
            positive(name, cut_off, "m")?;
        }
    }
    if let (Some(longest), Some(shortest)) = (band.longest, band.shortest)
        && longest < shortest
    {
        return Err(Error::invalid(
            "longest wavelength",
            format!("{longest:e} m"),
            format!("at least the shortest, {shortest:e} m"),
        ));
    }
    let grid = *surface.grid();
    require_effect(&grid, band)?;
    let mut amplitudes = spectrum::transform(&grid, surface.heights())?;
    amplitudes.indexed_iter_mut().for_each(|(at, a)| {
        let [qx, qy] = spectrum::wave_vector(&grid, at);
        *a *= band.share((qx * qx + qy * qy).sqrt());
    });
    Surface::new(grid, spectrum::inverse(&grid, amplitudes))
}

/// Refuses a cut-off beyond the waves that the surface holds: it would leave the surface as it is, or take all away.
fn require_effect(grid: &Grid, band: Band) -> Result<()> {
    let longest = grid.longest_side();
    let shortest = 2.0 * grid.cell_sides().fold(f64::INFINITY, f64::min);
    let known = shortest * (1.0 - 1e-9)..=longest * (1.0 + 1e-9);
    for (name, cut_off) in [("longest wavelength", band.longest), ("shortest wavelength", band.shortest)] {
        if let Some(cut_off) = cut_off
            && !known.contains(&cut_off)
        {
            return Err(Error::invalid(
                name,
                format!("{cut_off:e} m"),
                format!(
                    "between {shortest:e} m (two cells) and {longest:e} m (the longer side): the surface has no waves beyond; leave it out"
                ),
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::Array2;

    fn surface() -> Surface {
        let grid = Grid::new([30, 21], [3.0, 2.1]).unwrap();
        let heights = Array2::from_shape_fn((30, 21), |(i, j)| ((i * 7 + j * j * 3) % 17) as f64 - 5.0);
        Surface::new(grid, heights).unwrap()
    }

    #[test]
    fn the_bands_add_up_to_the_surface() {
        for edge in [Edge::Sharp, Edge::Gaussian] {
            // 0.5123 is not a wavelength of the grid, so a sharp band does not count a wave twice.
            let low = filter(&surface(), Band { longest: None, shortest: Some(0.5123), edge }).unwrap();
            let high = filter(&surface(), Band { longest: Some(0.5123), shortest: None, edge }).unwrap();
            let sum = &low.heights() + &high.heights();
            assert!(sum.iter().zip(surface().heights()).all(|(a, b)| (a - b).abs() < 1e-13));
        }
    }

    #[test]
    fn a_gaussian_edge_passes_half_at_the_cut_off() {
        let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
        let wave = Array2::from_shape_fn((32, 32), |(i, _)| (TAU * 4.0 * grid.x(i)).cos());
        let band = Band { longest: None, shortest: Some(0.25), edge: Edge::Gaussian };
        let half = filter(&Surface::new(grid, wave.clone()).unwrap(), band).unwrap();
        assert!(half.heights().iter().zip(&wave).all(|(a, b)| (a - 0.5 * b).abs() < 1e-14));
    }

    #[test]
    fn a_high_pass_takes_the_mean_away_and_sharp_bands_are_projections() {
        let band = Band { longest: Some(1.0), shortest: Some(0.3), edge: Edge::Sharp };
        let once = filter(&surface(), band).unwrap();
        assert!(once.heights().mean().unwrap().abs() < 1e-14);
        let twice = filter(&once, band).unwrap();
        assert!(once.heights().iter().zip(twice.heights()).all(|(a, b)| (a - b).abs() < 1e-13));
    }

    #[test]
    fn absurd_bands_are_named() {
        let bad = |longest, shortest| {
            filter(&surface(), Band { longest, shortest, edge: Edge::Sharp }).unwrap_err().to_string()
        };
        assert!(bad(Some(0.0), None).contains("longest"));
        assert!(bad(None, Some(f64::NAN)).contains("shortest"));
        assert!(bad(Some(1.0), Some(2.0)).contains("at least the shortest"));
    }

    #[test]
    fn a_cut_off_beyond_the_waves_of_the_surface_is_refused() {
        // 3 m x 2.1 m in cells of 0.1 m.
        let with = |longest: Option<f64>, shortest: Option<f64>| {
            filter(&surface(), Band { longest, shortest, edge: Edge::Gaussian })
        };
        for (longest, shortest) in
            [(Some(3.01), None), (None, Some(0.19)), (None, Some(3.5)), (Some(0.1), None)]
        {
            let error = with(longest, shortest).unwrap_err().to_string();
            assert!(error.contains("wavelength") && error.contains("two cells"), "{error}");
        }
        assert!(with(Some(3.0), Some(0.2)).is_ok());
    }
}
