//! The convolution of the pressure with the stress of a cell or of a wave.
//!
//! The rows of the pressure are transformed once. For each component and depth the columns are transformed, multiplied by the
//! stored quarter of the spectrum with the signs that its symmetry asks for, and transformed back. Work memory is six fields.

use std::f64::consts::TAU;
use std::sync::Arc;

use ndarray::Array2;
use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::Component;
use super::coefficients::{corner, wave};
use crate::convolution::Convolution;
use crate::error::{Error, Result};
use crate::grid::{Boundary, Grid};

/// Depths between 0 and this share of a cell are refused: they show the steps of the pressure from cell to cell.
const SHALLOWEST: f64 = 0.25;
/// Rows of coefficients that a task computes together: their corners are shared.
const STRIP: usize = 16;

/// Computes the stress at any depth below a pressure on a grid.
///
/// ```
/// use asperity::{Boundary, Grid, stress::{Component, SubsurfaceStress}};
/// // Under an even pressure on a periodic domain s_zz is that pressure at any depth.
/// let mut stress = SubsurfaceStress::new(Grid::new([8, 6], [1.0, 1.0])?, Boundary::Periodic, 0.3)?;
/// stress.set_pressure(&[2e6; 48])?;
/// let mut zz = vec![0.0; 48];
/// stress.component_into(Component::Zz, 0.1, &mut zz)?;
/// assert!(zz.iter().all(|s| (s + 2e6).abs() < 1e-6));
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct SubsurfaceStress {
    grid: Grid,
    boundary: Boundary,
    poisson: f64,
    /// Lengths of the transforms.
    lengths: [usize; 2],
    rows_forward: Arc<dyn RealToComplex<f64>>,
    rows_inverse: Arc<dyn ComplexToReal<f64>>,
    columns_forward: Arc<dyn Fft<f64>>,
    columns_inverse: Arc<dyn Fft<f64>>,
    /// Transforms of the rows of the pressure, and of a component: (ky, row).
    pressure: Array2<Complex64>,
    work: Array2<Complex64>,
}

impl SubsurfaceStress {
    /// Plans the transforms. `poisson` is that of the body whose stress is wanted.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a Poisson's ratio that is not within 0 and 0.5.
    pub fn new(grid: Grid, boundary: Boundary, poisson: f64) -> Result<Self> {
        if !(0.0..=0.5).contains(&poisson) {
            return Err(Error::invalid("Poisson's ratio", poisson, "between 0 and 0.5"));
        }
        let lengths = match boundary {
            Boundary::Free => grid.cells().map(|n| Convolution::good_length(2 * n - 1)),
            Boundary::Periodic => grid.cells(),
        };
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        let columns = (lengths[1] / 2 + 1, grid.cells()[0]);
        Ok(SubsurfaceStress {
            rows_forward: real.plan_fft_forward(lengths[1]),
            rows_inverse: real.plan_fft_inverse(lengths[1]),
            columns_forward: complex.plan_fft_forward(lengths[0]),
            columns_inverse: complex.plan_fft_inverse(lengths[0]),
            pressure: Array2::zeros(columns),
            work: Array2::zeros(columns),
            grid,
            boundary,
            poisson,
            lengths,
        })
    }

    /// The grid of the pressure.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Takes the pressure p \[Pa\] of the surface, nx ny cells in C-order.
    ///
    /// # Errors
    /// [`Error::Invalid`] where their number differs or one is not finite.
    pub fn set_pressure(&mut self, p: &[f64]) -> Result<()> {
        let [nx, ny] = self.grid.cells();
        if p.len() != nx * ny {
            return Err(Error::invalid(
                "number of pressures",
                p.len(),
                format!("{}, one for each cell", nx * ny),
            ));
        }
        if let Some(p) = p.iter().find(|p| !p.is_finite()) {
            return Err(Error::invalid("pressure", format!("{p} Pa"), "finite in every cell"));
        }
        let fft = &self.rows_forward;
        let rows: Vec<Vec<Complex64>> = p
            .par_chunks(ny)
            .map(|row| {
                let (mut input, mut output) = (fft.make_input_vec(), fft.make_output_vec());
                input[..ny].copy_from_slice(row);
                let done = fft.process(&mut input, &mut output);
                debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                output
            })
            .collect();
        self.pressure.outer_iter_mut().into_par_iter().enumerate().for_each(|(ky, mut column)| {
            column.iter_mut().zip(&rows).for_each(|(x, row)| *x = row[ky]);
        });
        Ok(())
    }

    /// One component \[Pa\] at `depth` >= 0 \[m\] below every cell centre.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a depth that is negative, or between 0 and a quarter of a cell.
    pub fn component_into(&mut self, component: Component, depth: f64, out: &mut [f64]) -> Result<()> {
        let [dx, dy] = self.grid.spacing();
        let shallowest = SHALLOWEST * dx.max(dy);
        if !(depth == 0.0 || depth >= shallowest && depth.is_finite()) {
            let expected = format!(
                "0, or at least {shallowest:e} m, a quarter of a cell (nearer to the surface the stress shows the \
                 steps of the pressure from cell to cell)"
            );
            return Err(Error::invalid("depth", format!("{depth:e} m"), expected));
        }
        let factors = match self.boundary {
            Boundary::Free => self.cell_factors(component, depth),
            Boundary::Periodic => self.wave_factors(component, depth),
        };
        self.multiply(&factors, component.is_odd());
        self.rows_back(out);
        Ok(())
    }

    /// All six components at `depth`, in the order of [`Component::ALL`]; each has nx ny cells.
    ///
    /// # Errors
    /// As [`component_into`](Self::component_into).
    pub fn at(&mut self, depth: f64, out: &mut [Vec<f64>; 6]) -> Result<()> {
        for (component, out) in Component::ALL.into_iter().zip(out) {
            out.resize(self.grid.len(), 0.0);
            self.component_into(component, depth, out)?;
        }
        Ok(())
    }

    /// The quarter of the spectrum on the waves of a periodic domain: (kx, ky).
    fn wave_factors(&self, component: Component, depth: f64) -> Array2<f64> {
        let ([mx, my], [lx, ly]) = (self.lengths, self.grid.size());
        let odd = component.is_odd();
        let mut factors = Array2::zeros((mx / 2 + 1, my / 2 + 1));
        factors.outer_iter_mut().into_par_iter().enumerate().for_each(|(kx, mut row)| {
            for (ky, factor) in row.iter_mut().enumerate() {
                // The shortest wave of an even number of cells has no sine.
                let vanishes = odd[0] && 2 * kx == mx || odd[1] && 2 * ky == my;
                let q = [TAU * kx as f64 / lx, TAU * ky as f64 / ly];
                *factor = if vanishes { 0.0 } else { wave(component, q, depth, self.poisson) };
            }
        });
        factors
    }

    /// The quarter of the spectrum of the stress under one loaded cell of a free domain: (kx, ky).
    fn cell_factors(&self, component: Component, depth: f64) -> Array2<f64> {
        let [mx, my] = self.lengths;
        let [odd_x, odd_y] = component.is_odd();
        let cells = self.coefficients(component, depth);
        // Along y, and with the axes exchanged along x.
        let along_y = half_transform(&cells, my, odd_y);
        half_transform(&along_y.reversed_axes().as_standard_layout().into_owned(), mx, odd_x)
            .reversed_axes()
            .as_standard_layout()
            .into_owned()
    }

    /// The stress at the offsets (i dx, j dy), i < nx and j < ny, from a cell under unit pressure.
    fn coefficients(&self, component: Component, depth: f64) -> Array2<f64> {
        let ([nx, ny], [dx, dy]) = (self.grid.cells(), self.grid.spacing());
        let at = |i: usize, j: usize| {
            corner(component, (i as f64 - 0.5) * dx, (j as f64 - 0.5) * dy, depth, self.poisson)
        };
        let mut cells = Array2::zeros((nx, ny));
        let strips = cells.axis_chunks_iter_mut(ndarray::Axis(0), STRIP).into_par_iter();
        strips.enumerate().for_each(|(n, mut strip)| {
            let corners: Vec<Vec<f64>> =
                (0..=strip.nrows()).map(|i| (0..=ny).map(|j| at(STRIP * n + i, j)).collect()).collect();
            for (i, mut row) in strip.outer_iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    let [low, high] = [&corners[i], &corners[i + 1]];
                    *cell = ((high[j + 1] - low[j + 1]) - (high[j] - low[j])) / TAU;
                }
            }
        });
        cells
    }

    /// work = the columns of the pressure times the spectrum, transformed back along x.
    fn multiply(&mut self, factors: &Array2<f64>, [odd_x, odd_y]: [bool; 2]) {
        let (mx, nx) = (self.lengths[0], self.grid.cells()[0]);
        let scale = 1.0 / (mx as f64 * self.lengths[1] as f64);
        let unit = match (odd_x, odd_y) {
            (false, false) => Complex64::new(scale, 0.0),
            (true, true) => Complex64::new(-scale, 0.0),
            _ => Complex64::new(0.0, scale),
        };
        let (forward, inverse) = (&self.columns_forward, &self.columns_inverse);
        let columns = self.work.outer_iter_mut().into_par_iter().zip(self.pressure.outer_iter());
        columns.enumerate().for_each_init(
            || {
                let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
                (vec![Complex64::ZERO; mx], vec![Complex64::ZERO; scratch])
            },
            |(buffer, scratch), (ky, (mut work, pressure))| {
                buffer[nx..].fill(Complex64::ZERO);
                buffer.iter_mut().zip(pressure).for_each(|(x, p)| *x = *p);
                forward.process_with_scratch(buffer, scratch);
                for (k, x) in buffer.iter_mut().enumerate() {
                    let mirrored = 2 * k > mx;
                    let factor = factors[(if mirrored { mx - k } else { k }, ky)];
                    *x *= unit * if mirrored && odd_x { -factor } else { factor };
                }
                inverse.process_with_scratch(buffer, scratch);
                work.iter_mut().zip(&buffer[..nx]).for_each(|(work, x)| *work = *x);
            },
        );
    }

    fn rows_back(&self, out: &mut [f64]) {
        let (ny, my) = (self.grid.cells()[1], self.lengths[1]);
        let (fft, work) = (&self.rows_inverse, &self.work);
        out.par_chunks_mut(ny).enumerate().for_each_init(
            || (fft.make_input_vec(), fft.make_output_vec(), fft.make_scratch_vec()),
            |(spectrum, row, scratch), (i, out)| {
                spectrum.iter_mut().enumerate().for_each(|(ky, x)| *x = work[(ky, i)]);
                // The ends of a real signal's spectrum are real; rounding left a trace.
                spectrum[0].im = 0.0;
                if my.is_multiple_of(2) {
                    spectrum[my / 2].im = 0.0;
                }
                let done = fft.process_with_scratch(spectrum, row, scratch);
                debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                out.copy_from_slice(&row[..ny]);
            },
        );
    }
}

/// For each row, the transform of its even or odd continuation to `length` numbers: the real part, or the imaginary part over
/// i, at the frequencies 0..=length/2.
fn half_transform(rows: &Array2<f64>, length: usize, odd: bool) -> Array2<f64> {
    let fft = RealFftPlanner::new().plan_fft_forward(length);
    let mut out = Array2::zeros((rows.nrows(), length / 2 + 1));
    let pairs = out.outer_iter_mut().into_par_iter().zip(rows.outer_iter());
    pairs.for_each_init(
        || (fft.make_input_vec(), fft.make_output_vec(), fft.make_scratch_vec()),
        |(input, output, scratch), (mut out, row)| {
            input.fill(0.0);
            let sign = if odd { -1.0 } else { 1.0 };
            for (j, x) in row.iter().enumerate() {
                if j == 0 {
                    // An odd sequence begins with zero.
                    input[0] = if odd { 0.0 } else { *x };
                } else {
                    input[j] = *x;
                    input[length - j] = sign * x;
                }
            }
            let done = fft.process_with_scratch(input, output, scratch);
            debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
            out.iter_mut().zip(output.iter()).for_each(|(to, x)| *to = if odd { x.im } else { x.re });
        },
    );
    out
}
