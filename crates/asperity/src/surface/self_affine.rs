//! Synthetic self-affine roughness.
//!
//! A Gaussian surface is a sum of plane waves with independent complex normal amplitudes,
//!
//! ```text
//! z(x, y) = sum over k of A_k exp(i q.x),   q = 2 pi (kx / Lx, ky / Ly),   <|A_k|^2> ~ C(|q|),
//! ```
//!
//! with the power spectrum of a self-affine surface: flat from the longest wavelength to the roll-off, then C ~ q^(-2 (1 + H))
//! down to the shortest, and zero beyond either end (B. N. J. Persson et al., J. Phys.: Condens. Matter 17 (2005) R1, section 4;
//! T. D. B. Jacobs et al., Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, section 3). The sum is scaled so that this surface, not
//! the ensemble, has the requested rms gradient or rms height.
//!
//! On a line of cells the surface is a profile, and its spectrum that of a profile: C ~ q^-(1 + 2 H).
//!
//! The random number of a wave depends only on the seed and on (kx, ky). Therefore the same seed on a finer grid samples the same
//! surface, a smaller `shortest` adds waves and keeps the long ones in proportion, and every machine and number of threads gives
//! the same bits.

use std::f64::consts::TAU;

use ndarray::Array2;

use super::waves::{SAME, Waves};
use crate::error::{Result, positive, require};
use crate::grid::Grid;

/// The roughness of a synthetic surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roughness {
    /// Root mean square of |grad z| (spectral derivative, whole domain).
    RmsGradient(f64),
    /// Root mean square of z \[m\]; the mean is zero.
    RmsHeight(f64),
}

/// An isotropic self-affine Gaussian surface, periodic on the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H, 0 < H <= 1; the fractal dimension is 3 - H.
    pub hurst: f64,
    /// Exact rms gradient or rms height of the surface.
    pub roughness: Roughness,
    /// Longest wavelength \[m\]; at most the longer side of the domain.
    pub longest: f64,
    /// Shortest wavelength \[m\]; at least two cells.
    pub shortest: f64,
    /// Wavelength at which the flat part ends \[m\], between `shortest` and `longest`; equal to
    /// `longest` there is no flat part.
    pub roll_off: f64,
    /// Seed of the random amplitudes.
    pub seed: u64,
}

impl SelfAffine {
    /// Side of the square domain of the Contact Mechanics Challenge \[m\].
    pub const CHALLENGE_SIZE: f64 = 1e-4;

    /// The roughness of the Contact Mechanics Challenge (M. H. Mueser et al., Tribol. Lett. 65 (2017) 118): 0.1 mm x 0.1 mm,
    /// Hurst exponent 0.8, roll-off at 20 um, cut-off at 0.1 um, rms gradient 1; the same statistics, not the same random
    /// numbers. It needs 2000 cells per side. For a coarser grid raise `shortest`; the gradient of 1 then comes from longer
    /// waves.
    ///
    /// ```
    /// use asperity::surface::{Roughness, SelfAffine};
    /// let surface = SelfAffine::contact_mechanics_challenge(1);
    /// assert_eq!((surface.hurst, surface.longest, surface.roll_off), (0.8, 1e-4, 2e-5));
    /// assert_eq!(surface.roughness, Roughness::RmsGradient(1.0));
    /// ```
    pub fn contact_mechanics_challenge(seed: u64) -> Self {
        SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsGradient(1.0),
            longest: Self::CHALLENGE_SIZE,
            shortest: 1e-7,
            roll_off: 2e-5,
            seed,
        }
    }

    /// Heights at the cell centres \[m\], shape (nx, ny), mean zero.
    ///
    /// Waves exactly at the Nyquist frequency of the grid along an axis are left out: a grid does not determine their phase.
    ///
    /// ```
    /// use asperity::{Grid, surface::{Roughness, SelfAffine, statistics}};
    ///
    /// let grid = Grid::new([64, 64], [1e-3, 1e-3])?;
    /// let surface = SelfAffine {
    ///     hurst: 0.8,
    ///     roughness: Roughness::RmsGradient(0.1),
    ///     longest: 5e-4,
    ///     shortest: 6e-5,
    ///     roll_off: 2e-4,
    ///     seed: 1,
    /// };
    /// let heights = surface.heights(&grid)?;
    /// let gradient = statistics::rms_gradient(&grid, heights.view())?;
    /// assert!((gradient - 0.1).abs() < 1e-12);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the exponent, the roughness or a wavelength is outside its domain, the wavelengths are out of order
    /// or do not fit the grid, or the domain has no wave between them.
    pub fn heights(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.heights_where(grid, |qx, qy| (qx * qx + qy * qy).sqrt())
    }

    /// The same with the spectrum taken at `seen(qx, qy)` >= |q| instead of at |q|.
    pub(super) fn heights_where(
        &self,
        grid: &Grid,
        seen: impl Fn(f64, f64) -> f64 + Sync,
    ) -> Result<Array2<f64>> {
        self.validate(grid)?;
        let waves = Waves::new(grid, TAU / self.shortest);
        // Along a line the waves of a surface of exponent -2 (1 + H) have the exponent -(1 + 2 H).
        let exponent = if grid.is_line() { -1.0 - 2.0 * self.hurst } else { -2.0 * (1.0 + self.hurst) };
        let amplitude = |qx: f64, qy: f64| self.spectrum(seen(qx, qy), exponent).sqrt();
        let (mut columns, [height, gradient]) = waves.amplitudes(self.seed, amplitude);
        require(
            height > 0.0,
            "band of wavelengths",
            format!("{:e} m to {:e} m", self.shortest, self.longest),
            "wide enough to hold a wave that fits the domain (size over an integer along x and y)",
        )?;
        let scale = match self.roughness {
            Roughness::RmsHeight(wanted) => wanted / height.sqrt(),
            Roughness::RmsGradient(wanted) => wanted / gradient.sqrt(),
        };
        let heights = waves.sum(&mut columns, scale);
        require(
            heights.iter().all(|z| z.is_finite()),
            "height of the self-affine surface",
            "too large for a number",
            "finite; check the roughness and its unit",
        )?;
        Ok(heights)
    }

    /// Power spectrum up to a factor: 1 on the flat part, (q / q_rolloff)^exponent beyond.
    fn spectrum(&self, q: f64, exponent: f64) -> f64 {
        if q < TAU / self.longest * (1.0 - SAME) || q > TAU / self.shortest * (1.0 + SAME) {
            return 0.0;
        }
        libm::pow((q * self.roll_off / TAU).max(1.0), exponent)
    }

    /// Checks the numbers, also against the grid.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) as [`heights`](Self::heights).
    pub fn validate(&self, grid: &Grid) -> Result<()> {
        require(
            self.hurst > 0.0 && self.hurst <= 1.0,
            "Hurst exponent",
            self.hurst,
            "greater than 0 and at most 1",
        )?;
        match self.roughness {
            Roughness::RmsGradient(g) => positive("rms gradient", g, "")?,
            Roughness::RmsHeight(h) => positive("rms height", h, "m")?,
        };
        positive("longest wavelength", self.longest, "m")?;
        positive("shortest wavelength", self.shortest, "m")?;
        positive("roll-off wavelength", self.roll_off, "m")?;
        let meters = |l: f64| format!("{l:e} m");
        let (two_cells, domain) = (2.0 * grid.longest_cell(), grid.longest_side());
        require(
            self.shortest >= two_cells * (1.0 - SAME),
            "shortest wavelength",
            meters(self.shortest),
            format!("at least two cells, {}; refine the grid or cut longer waves off", meters(two_cells)),
        )
        .map_err(|error| error.of("shortest"))?;

        require(
            self.longest <= domain * (1.0 + SAME),
            "longest wavelength",
            meters(self.longest),
            format!("at most the size of the domain, {}", meters(domain)),
        )
        .map_err(|error| error.of("longest"))?;

        require(
            self.shortest <= self.roll_off && self.roll_off <= self.longest,
            "roll-off wavelength",
            meters(self.roll_off),
            format!(
                "between the shortest, {}, and the longest, {}",
                meters(self.shortest),
                meters(self.longest)
            ),
        )
        .map_err(|error| error.of("roll_off"))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::statistics;

    fn surface() -> SelfAffine {
        SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsGradient(0.1),
            longest: 1e-3,
            shortest: 1e-4,
            roll_off: 4e-4,
            seed: 7,
        }
    }

    fn grid(cells: [usize; 2]) -> Grid {
        Grid::new(cells, [1e-3, 1e-3]).unwrap()
    }

    /// Rounding error of transforms that add a few hundred waves, relative to the largest height.
    const ROUNDING: f64 = 1e-13;

    #[test]
    fn the_roughness_is_exact_on_the_grid() {
        for cells in [[64, 64], [50, 33], [21, 128]] {
            let heights = surface().heights(&grid(cells)).unwrap();
            let gradient = statistics::rms_gradient(&grid(cells), heights.view()).unwrap();
            assert!((gradient / 0.1 - 1.0).abs() < ROUNDING, "{gradient}");
            let given = SelfAffine { roughness: Roughness::RmsHeight(3e-6), ..surface() };
            let heights = given.heights(&grid(cells)).unwrap();
            let rms = statistics::rms_height(heights.view()).unwrap();
            assert!((rms / 3e-6 - 1.0).abs() < ROUNDING, "{rms}");
            assert!(heights.mean().unwrap().abs() < ROUNDING * 3e-6);
        }
    }

    #[test]
    fn a_finer_grid_samples_the_same_surface() {
        // Every third cell centre of the fine grid is a cell centre of the coarse one.
        let (coarse, fine) = (grid([30, 28]), grid([90, 84]));
        let (coarse, fine) = (surface().heights(&coarse).unwrap(), surface().heights(&fine).unwrap());
        let largest = coarse.iter().fold(0.0f64, |m, z| m.max(z.abs()));
        for ((i, j), z) in coarse.indexed_iter() {
            assert!((z - fine[[3 * i + 1, 3 * j + 1]]).abs() < ROUNDING * largest);
        }
    }

    #[test]
    fn the_spectrum_is_flat_then_falls_and_ends() {
        // |A_k|^2 averaged over 200 seeds follows C(q): its mean is exponential with 1/sqrt(200 x
        // waves in the ring) scatter, under 2 % for rings of 20 waves and more; 5 sigma = 8 %.
        let grid = grid([64, 64]);
        let waves = Waves::new(&grid, TAU / 1e-4);
        let ring = |k: i64| {
            let (mut power, mut count) = (0.0, 0);
            for seed in 0..200 {
                let s = SelfAffine { seed, ..surface() };
                let exponent = -2.0 * (1.0 + s.hurst);
                let (columns, _) = waves.amplitudes(seed, |qx, qy| s.spectrum(qx.hypot(qy), exponent).sqrt());
                for (ky, column) in columns.iter().enumerate() {
                    for (i, a) in column.iter().enumerate() {
                        let kx = if i < 32 { i as i64 } else { i as i64 - 64 };
                        let r = ((kx * kx + (ky * ky) as i64) as f64).sqrt();
                        if (r - k as f64).abs() < 0.5 && (ky > 0 || kx > 0) {
                            let q = r * TAU / 1e-3;
                            let flat = TAU / 4e-4;
                            let c = if q <= flat { 1.0 } else { (q / flat).powf(-3.6) };
                            power += a.norm_sqr() / (2.0 * c);
                            count += 1;
                        }
                    }
                }
            }
            power / count as f64
        };
        for k in [3, 6, 9] {
            assert!((ring(k) - 1.0).abs() < 0.08, "ring {k}: {}", ring(k));
        }
        let heights = surface().heights(&grid).unwrap();
        assert_eq!(waves.reach(1, TAU / 1e-4 * (1.0 + SAME)), 10); // nothing beyond 1 mm / 0.1 mm
        assert_eq!(heights.dim(), (64, 64));
    }

    #[test]
    fn seeds_differ_and_repeat() {
        let of = |seed| SelfAffine { seed, ..surface() }.heights(&grid([32, 32])).unwrap();
        assert_eq!(of(1), of(1));
        assert_ne!(of(1), of(2));
    }

    #[test]
    fn the_bits_are_these_on_every_machine() {
        let heights = surface().heights(&grid([24, 20])).unwrap();
        let bits = [[0, 0], [5, 11], [23, 19]].map(|at| heights[at].to_bits());
        assert_eq!(bits, [13748743255368971658, 13745790284808236751, 13745802750176475578]);
    }

    #[test]
    fn numbers_outside_their_domain_are_named() {
        for (surface, word) in [
            (SelfAffine { hurst: 0.0, ..surface() }, "Hurst"),
            (SelfAffine { hurst: f64::NAN, ..surface() }, "Hurst"),
            (SelfAffine { hurst: 1.1, ..surface() }, "Hurst"),
            (SelfAffine { roughness: Roughness::RmsHeight(-1.0), ..surface() }, "rms height"),
            (SelfAffine { shortest: 1e-5, ..surface() }, "two cells"),
            (SelfAffine { longest: 2e-3, ..surface() }, "size of the domain"),
            (SelfAffine { roll_off: 5e-5, ..surface() }, "roll-off"),
            (SelfAffine { longest: f64::INFINITY, ..surface() }, "longest"),
            // 1 mm / 2.5 lies between the waves 2 and sqrt(5); 1 mm / 2.1 holds none of them.
            (
                SelfAffine { longest: 1e-3 / 2.05, roll_off: 1e-3 / 2.1, shortest: 1e-3 / 2.1, ..surface() },
                "band",
            ),
            (SelfAffine { roughness: Roughness::RmsHeight(1e308), ..surface() }, "too large"),
        ] {
            let message = surface.heights(&grid([64, 64])).unwrap_err().to_string();
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
