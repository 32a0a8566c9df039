//! The autocorrelation function and the spatial parameters of ISO 25178-2 (section 4.2).
//!
//! ```text
//! f(tx, ty) = <z(x, y) z(x + tx, y + ty)> / <z^2>      z about its mean
//! ```
//!
//! By the Wiener-Khinchin theorem it is the transform of |A_q|^2. A surface that is not periodic is padded with zeros, and the
//! result is divided by the number of pairs at each lag. Sal is the shortest lag at which f falls to 0.2 in any direction, Str
//! the ratio of the shortest to the longest such lag: 1 isotropic, near 0 with a lay.

use std::f64::consts::PI;

use ndarray::{Array2, s};

use super::super::Surface;
use super::super::spectrum::{check_defined, inverse, transform};
use super::heights::mean;
use crate::error::{Result, require};
use crate::grid::Grid;

/// Whether the surface is periodic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// Periodic: synthetic surfaces.
    Periodic,
    /// Not periodic: measured surfaces.
    Finite,
}

/// Autocorrelation at lags up to half the size.
#[derive(Clone, Debug, PartialEq)]
pub struct Autocorrelation {
    /// f at the lag ((i - nx/2) dx, (j - ny/2) dy), shape (nx, ny); 1 at (nx/2, ny/2), integer division.
    pub values: Array2<f64>,
    spacing: [f64; 2],
}

/// f at which a lag counts as the autocorrelation length (ISO 25178-2).
const LEVEL: f64 = 0.2;

impl Autocorrelation {
    /// From a surface whose points are all defined.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a point is undefined or the surface is flat.
    pub fn of(surface: &Surface, extent: Extent) -> Result<Self> {
        let (grid, heights) = (*surface.grid(), surface.heights());
        check_defined(heights.iter())?;
        let mean = mean(heights)?;
        let [nx, ny] = grid.cells();
        // Padded by the longest lag, so that no pair wraps around.
        let cells = match extent {
            Extent::Periodic => [nx, ny],
            Extent::Finite => [nx + nx / 2, ny + ny / 2],
        };
        let padded =
            Grid::new(cells, [grid.spacing()[0] * cells[0] as f64, grid.spacing()[1] * cells[1] as f64])?;
        let mut centred = Array2::zeros(padded.shape());
        centred.slice_mut(s![..nx, ..ny]).assign(&heights.mapv(|z| z - mean));
        let power = transform(&padded, centred.view())?.mapv(|a| (a * a.conj()).re.into());
        // Mean over the padded cells of z z(+lag).
        let products = inverse(&padded, power);
        let variance = products[[0, 0]];
        require(variance > 0.0, "rms height", "0 m", "more than 0 m, to have an autocorrelation")?;
        let values = Array2::from_shape_fn((nx, ny), |(i, j)| {
            let (lag_x, lag_y) = (i as i64 - (nx / 2) as i64, j as i64 - (ny / 2) as i64);
            let at = [lag_x.rem_euclid(cells[0] as i64) as usize, lag_y.rem_euclid(cells[1] as i64) as usize];
            let pairs = match extent {
                Extent::Periodic => 1.0,
                Extent::Finite => {
                    (1.0 - lag_x.unsigned_abs() as f64 / nx as f64)
                        * (1.0 - lag_y.unsigned_abs() as f64 / ny as f64)
                }
            };
            products[at] / (variance * pairs)
        });
        Ok(Autocorrelation { values, spacing: grid.spacing() })
    }

    /// f at any lag (tx, ty) \[m\], bilinear; `None` beyond the known lags.
    pub fn at(&self, tx: f64, ty: f64) -> Option<f64> {
        let (nx, ny) = self.values.dim();
        let place = |t: f64, n: usize, spacing: f64| {
            let x = t / spacing + (n / 2) as f64;
            (x >= 0.0 && x <= (n - 1) as f64).then(|| ((x as usize).min(n.saturating_sub(2)), x))
        };
        let (i, x) = place(tx, nx, self.spacing[0])?;
        let (j, y) = place(ty, ny, self.spacing[1])?;
        let (sx, sy) = (x - i as f64, y - j as f64);
        let value = |i: usize, j: usize| self.values[[i.min(nx - 1), j.min(ny - 1)]];
        let along = |j: usize| (1.0 - sx) * value(i, j) + sx * value(i + 1, j);
        Some((1.0 - sy) * along(j) + sy * along(j + 1))
    }

    /// Mean of f over rings of lags, one cell (the smaller side) wide: (mean lag \[m\], f).
    pub fn radial(&self) -> (Vec<f64>, Vec<f64>) {
        let (nx, ny) = self.values.dim();
        let [dx, dy] = self.spacing;
        let width = dx.min(dy);
        let longest = (dx * ((nx - 1) / 2) as f64).min(dy * ((ny - 1) / 2) as f64);
        let mut sums = vec![(0.0, 0.0, 0usize); (longest / width).round() as usize + 1];
        for ((i, j), f) in self.values.indexed_iter() {
            let (tx, ty) = (dx * (i as f64 - (nx / 2) as f64), dy * (j as f64 - (ny / 2) as f64));
            let lag = (tx * tx + ty * ty).sqrt();
            if let Some(sum) = sums.get_mut((lag / width).round() as usize) {
                *sum = (sum.0 + lag, sum.1 + f, sum.2 + 1);
            }
        }
        sums.into_iter().filter(|s| s.2 > 0).map(|(lag, f, n)| (lag / n as f64, f / n as f64)).unzip()
    }

    /// Sal, the shortest lag at which f falls to 0.2 \[m\]; `None` if it does not within the known lags.
    pub fn length(&self) -> Option<f64> {
        self.fastest_decay().map(|(_, length)| length)
    }

    /// The direction in which f falls to 0.2 first, an angle from x to y in 0 to pi \[rad\], and the lag at which it does \[m\]: Sal.
    /// `None` if f does not fall that far within the known lags.
    pub fn fastest_decay(&self) -> Option<(f64, f64)> {
        let found = self.lengths().enumerate().filter_map(|(n, lag)| Some((n, lag?)));
        let (degree, lag) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((PI * degree as f64 / 180.0, lag))
    }

    /// Str, the shortest over the longest of the lags at which f falls to 0.2; `None` if it does not
    /// in some direction.
    pub fn texture_aspect_ratio(&self) -> Option<f64> {
        let lengths: Option<Vec<f64>> = self.lengths().collect();
        let lengths = lengths?;
        let shortest = lengths.iter().copied().min_by(f64::total_cmp)?;
        let longest = lengths.iter().copied().max_by(f64::total_cmp)?;
        Some(shortest / longest)
    }

    /// Lag at which f first falls to 0.2, by direction: one degree apart over a half turn.
    fn lengths(&self) -> impl Iterator<Item = Option<f64>> {
        let step = 0.5 * self.spacing[0].min(self.spacing[1]);
        (0..180).map(move |degree| {
            let (sin, cos) = (PI * f64::from(degree) / 180.0).sin_cos();
            let mut before = 1.0;
            for n in 1.. {
                let f = self.at(n as f64 * step * cos, n as f64 * step * sin)?;
                if f <= LEVEL {
                    return Some(step * (n as f64 - (LEVEL - f) / (before - f)));
                }
                before = f;
            }
            None
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(cells: [usize; 2]) -> Surface {
        let grid = Grid::new(cells, [1.0, 1.0]).unwrap();
        let heights = Array2::from_shape_fn(grid.shape(), |(i, _)| 3.0 + (TAU * 2.0 * grid.x(i)).cos());
        Surface::new(grid, heights).unwrap()
    }

    #[test]
    fn a_wave_correlates_as_a_wave() {
        let f = Autocorrelation::of(&wave([32, 9]), Extent::Periodic).unwrap();
        for ((i, j), value) in f.values.indexed_iter() {
            let lag = (i as f64 - 16.0) / 32.0;
            assert!((value - (TAU * 2.0 * lag).cos()).abs() < 1e-13, "{i} {j}");
        }
        assert_eq!(f.texture_aspect_ratio(), None); // never falls along y
        // cos(4 pi t) = 0.2; bilinear between cells of a sixteenth of a wave
        let exact = 0.2f64.acos() / (2.0 * TAU);
        assert!((f.length().unwrap() / exact - 1.0).abs() < 0.02, "{:?}", f.length());
        assert_eq!(f.fastest_decay(), f.length().map(|length| (0.0, length)));
    }

    #[test]
    fn a_finite_surface_counts_its_pairs() {
        // Compared with the defining sum at every lag.
        let grid = Grid::new([7, 6], [1.0, 1.0]).unwrap();
        let heights = Array2::from_shape_fn((7, 6), |(i, j)| ((i * i * 5 + j * 3) % 11) as f64);
        let f = Autocorrelation::of(&Surface::new(grid, heights.clone()).unwrap(), Extent::Finite).unwrap();
        let mean = heights.mean().unwrap();
        let product = |lag_x: i64, lag_y: i64| {
            let pairs: Vec<f64> = heights
                .indexed_iter()
                .filter_map(|((i, j), z)| {
                    let (a, b) = (i as i64 + lag_x, j as i64 + lag_y);
                    let other = heights.get((usize::try_from(a).ok()?, usize::try_from(b).ok()?))?;
                    Some((z - mean) * (other - mean))
                })
                .collect();
            pairs.iter().sum::<f64>() / pairs.len() as f64
        };
        for ((i, j), value) in f.values.indexed_iter() {
            let exact = product(i as i64 - 3, j as i64 - 3) / product(0, 0);
            assert!((value - exact).abs() < 1e-12, "{i} {j}: {value} {exact}");
        }
    }

    #[test]
    fn a_gaussian_correlation_has_its_length_and_no_direction() {
        // Periodic surface with |A|^2 ~ exp(-q^2 s^2): f = exp(-t^2/(4 s^2)), f = 0.2 at 2 s sqrt(ln 5).
        let (n, s) = (64, 0.05);
        let grid = Grid::new([n, n], [1.0, 1.0]).unwrap();
        let mut heights = Array2::zeros((n, n));
        // A bump of that transform: its correlation is the bump's own, twice as wide in variance.
        heights.indexed_iter_mut().for_each(|((i, j), z)| {
            let (x, y) = (grid.x(i) - 0.5, grid.y(j) - 0.5);
            *z = (-(x * x + y * y) / (2.0 * s * s)).exp();
        });
        let f = Autocorrelation::of(&Surface::new(grid, heights).unwrap(), Extent::Periodic).unwrap();
        // Subtracting the mean lowers f by (2 sqrt(pi) s)^2 = 3 %.
        let offset = 4.0 * PI * s * s;
        let exact = 2.0 * s * (1.0 / (LEVEL * (1.0 - offset) + offset)).ln().sqrt();
        assert!((f.length().unwrap() / exact - 1.0).abs() < 0.01, "{:?} {exact}", f.length());
        assert!(f.texture_aspect_ratio().unwrap() > 0.98);
        let (lags, values) = f.radial();
        assert!(lags[0] == 0.0 && values[0] > 0.999 && values.windows(2).take(10).all(|w| w[1] < w[0]));
    }

    #[test]
    fn flats_and_holes_are_refused() {
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let of = |z: f64| {
            Autocorrelation::of(&Surface::new(grid, Array2::from_elem((4, 4), z)).unwrap(), Extent::Finite)
        };
        assert!(of(1.0).unwrap_err().to_string().contains("rms height"));
        assert!(of(f64::NAN).unwrap_err().to_string().contains("undefined"));
    }
}
