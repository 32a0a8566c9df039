//! The convolution of the pressure with the stress of a cell or of a wave.
//!
//! The rows of the pressure are transformed once. For each component and depth the columns are transformed, multiplied by the
//! spectrum of the component, and transformed back. Each component is even or odd in either direction, so a quarter of its
//! spectrum, as real numbers, is sufficient; it is computed column by column. The work memory is five fields on a free domain.

use std::f64::consts::TAU;
use std::sync::Arc;

use asperity_convolution::fft;
use asperity_convolution::plane::RealPlane;
use ndarray::{Array1, Array2, ArrayViewMut1, Axis};
use rayon::prelude::*;
use realfft::RealToComplex;
use rustfft::num_complex::Complex64;

use super::Component;
use super::depths::check_depth;
use super::history::{PressureHistory, check_pressure, mean};
use super::shear::Action;
use crate::convolution::Convolution;
use crate::error::{Result, require};
use crate::grid::{Boundary, Grid};

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
    /// Poisson's ratio of [`set_pressure`](Self::set_pressure).
    poisson: f64,
    plane: RealPlane,
    /// Columns and rows of the real coefficients of a cell.
    coefficients: [Arc<dyn RealToComplex<f64>>; 2],
    /// The stress is the sum of those under these pressures.
    sources: Vec<Source>,
    /// Additional uniform stress xx and yy \[Pa\].
    lateral: f64,
    /// Transformed rows of a component.
    work: Vec<Complex64>,
}

/// A pressure or a traction, and the Poisson's ratio of the body that it acts on.
struct Source {
    action: Action,
    poisson: f64,
    /// Its transformed rows.
    rows: Vec<Complex64>,
}

impl SubsurfaceStress {
    /// Plans the transforms. `poisson` is that of the body whose stress is computed.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for a Poisson's ratio that is not between 0 and 0.5.
    pub fn new(grid: Grid, boundary: Boundary, poisson: f64) -> Result<Self> {
        require((0.0..=0.5).contains(&poisson), "Poisson's ratio", poisson, "between 0 and 0.5")?;
        let lengths = match boundary {
            Boundary::Free => grid.cells().map(|n| Convolution::good_length(2 * n - 1)),
            Boundary::Periodic => grid.cells(),
        };
        let plane = RealPlane::new(grid.cells(), lengths);
        Ok(SubsurfaceStress {
            coefficients: lengths.map(fft::real_forward),
            sources: vec![],
            lateral: 0.0,
            work: plane.columns(),
            plane,
            grid,
            boundary,
            poisson,
        })
    }

    /// The grid of the pressure.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Sets the pressure p \[Pa\] on the surface, nx ny cells in C-order.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the number of cells differs or a value is not finite.
    pub fn set_pressure(&mut self, p: &[f64]) -> Result<()> {
        check_pressure(p, self.grid.len())?;
        self.sources.clear();
        self.lateral = 0.0;
        self.add(Action::Pressure, p, self.poisson);
        Ok(())
    }

    /// Sets a history of the pressure in place of a pressure, for a body whose Poisson's ratio changes with time.
    ///
    /// # Errors
    /// As [`set_transverse`](Self::set_transverse).
    pub fn set_history(&mut self, history: &PressureHistory) -> Result<()> {
        self.set_transverse(history.pressure(), &history.transverse(), history.confined())
    }

    /// Sets the pressure p, P = int nu(t - s) dp(s) in each cell, and the lateral pressure \[Pa\] due to the mean pressure of a
    /// periodic domain ([`PressureHistory`]). The stress is linear in the ratio. It is therefore the sum of the stress of p - 2 P
    /// on a body of ratio 0 and that of 2 P on one of ratio 1/2.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if their number differs from that of the cells, or one is not finite.
    pub fn set_transverse(&mut self, p: &[f64], transverse: &[f64], confined: f64) -> Result<()> {
        for field in [p, transverse] {
            check_pressure(field, self.grid.len())?;
        }
        let rest: Vec<f64> = p.iter().zip(transverse).map(|(p, t)| p - 2.0 * t).collect();
        let twice: Vec<f64> = transverse.iter().map(|t| 2.0 * t).collect();
        self.sources.clear();
        // The mean of a periodic pressure acts without lateral strain, so it does not depend on the ratio itself.
        self.lateral = match self.boundary {
            Boundary::Free => 0.0,
            Boundary::Periodic => mean(&twice) - confined,
        };
        self.add(Action::Pressure, &rest, 0.0);
        self.add(Action::Pressure, &twice, 0.5);
        Ok(())
    }

    /// Adds the tangential tractions along x and y \[Pa\] with which the other body acts on this one to the pressure that was set.
    ///
    /// ```
    /// use asperity::{Boundary, Grid, stress::{Component, SubsurfaceStress}};
    /// // An even traction on a periodic domain is the shear stress at any depth.
    /// let mut stress = SubsurfaceStress::new(Grid::new([8, 6], [1.0, 1.0])?, Boundary::Periodic, 0.3)?;
    /// stress.set_pressure(&[0.0; 48])?;
    /// stress.add_tractions([&[2e6; 48], &[0.0; 48]])?;
    /// let mut xz = vec![0.0; 48];
    /// stress.component_into(Component::Xz, 0.1, &mut xz)?;
    /// assert!(xz.iter().all(|s| (s + 2e6).abs() < 1e-6));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`set_pressure`](Self::set_pressure).
    pub fn add_tractions(&mut self, [qx, qy]: [&[f64]; 2]) -> Result<()> {
        for (action, traction) in [(Action::ShearX, qx), (Action::ShearY, qy)] {
            check_pressure(traction, self.grid.len())?;
            self.add(action, traction, self.poisson);
        }
        Ok(())
    }

    /// Adds what acts on a body of this Poisson's ratio.
    fn add(&mut self, action: Action, p: &[f64], poisson: f64) {
        let mut rows = self.plane.columns();
        self.plane.rows_forward(p, &mut rows);
        self.sources.push(Source { action, poisson, rows });
    }

    /// Bytes of the transforms, of the six fields of [`at`](Self::at), and with tangential tractions of these and their transforms.
    pub fn bytes(grid: &Grid, boundary: Boundary, tractions: bool) -> usize {
        let [nx, ny] = grid.cells();
        let (length, coefficients) = match boundary {
            Boundary::Free => (Convolution::good_length(2 * ny - 1), 1),
            Boundary::Periodic => (ny, 0),
        };
        let more = if tractions { 4 * (length / 2 + 1) + 2 * ny } else { 0 };
        8 * nx * ((4 + coefficients) * (length / 2 + 1) + 6 * ny + more)
    }

    /// One component \[Pa\] at `depth` >= 0 \[m\] below every cell centre.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for a depth that is negative, or between 0 and a quarter of a cell.
    pub fn component_into(&mut self, component: Component, depth: f64, out: &mut [f64]) -> Result<()> {
        check_depth(&self.grid, depth)?;
        self.work.fill(Complex64::ZERO);
        for source in 0..self.sources.len() {
            let Source { action, poisson, .. } = self.sources[source];
            let spectrum = match self.boundary {
                Boundary::Free => Spectrum::Cell(self.transformed_rows(action, component, depth, poisson)),
                Boundary::Periodic => Spectrum::Wave(depth, poisson),
            };
            self.add_product(component, &spectrum, source);
        }
        self.plane.rows_back(&self.work, out);
        if matches!(component, Component::Xx | Component::Yy) {
            out.iter_mut().for_each(|stress| *stress += self.lateral);
        }
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

    /// The stress at the offsets (i dx, j dy), i < nx and j < ny, from a cell under unit pressure, transformed along y: (i, ky).
    fn transformed_rows(
        &self,
        action: Action,
        component: Component,
        depth: f64,
        poisson: f64,
    ) -> Array2<f64> {
        let ([nx, ny], [dx, dy]) = (self.grid.cells(), self.grid.spacing());
        let (fft, odd) = (&self.coefficients[1], action.is_odd(component)[1]);
        let is_far = depth > (nx as f64 * dx).max(ny as f64 * dy);
        let at = |i: usize, j: usize| {
            action.corner(component, [(i as f64 - 0.5) * dx, (j as f64 - 0.5) * dy, depth], poisson, is_far)
        };
        let mut rows = Array2::zeros((nx, self.plane.waves_along_y()));
        if self.grid.is_line() {
            // The transform of one cell along y is constant.
            let of = |i: usize| action.strip(component, i as f64 * dx, depth, 0.5 * dx, poisson);
            rows.outer_iter_mut().enumerate().for_each(|(i, mut row)| row.fill(of(i)));
            return rows;
        }
        let strips = rows.axis_chunks_iter_mut(Axis(0), STRIP).into_par_iter();
        strips.enumerate().for_each_init(
            || Half::new(fft),
            |half, (n, mut strip)| {
                let corners = |i: usize| (0..=ny).map(|j| at(STRIP * n + i, j)).collect::<Vec<f64>>();
                let mut low = corners(0);
                for (i, row) in strip.outer_iter_mut().enumerate() {
                    let high = corners(i + 1);
                    let cell = |j: usize| ((high[j + 1] - low[j + 1]) - (high[j] - low[j])) / TAU;
                    half.transform(fft, odd, (0..ny).map(cell), row);
                    low = high;
                }
            },
        );
        rows
    }

    /// work += the columns of the pressure of a source times the spectrum, transformed back along x.
    fn add_product(&mut self, component: Component, spectrum: &Spectrum, source: usize) {
        let (lengths, nx) = (self.plane.lengths(), self.grid.cells()[0]);
        let mx = lengths[0];
        let scale = 1.0 / (mx as f64 * lengths[1] as f64);
        let action = self.sources[source].action;
        let odd = action.is_odd(component);
        let unit = match odd {
            [false, false] => Complex64::new(scale, 0.0),
            [true, true] => Complex64::new(-scale, 0.0),
            _ => Complex64::new(0.0, scale),
        };
        let (plane, half, size) = (&self.plane, &self.coefficients[0], self.grid.size());
        let pressure = self.sources[source].rows.par_chunks(nx);
        self.work.par_chunks_mut(nx).zip(pressure).enumerate().for_each_init(
            || (plane.column(), Array1::zeros(mx / 2 + 1), Half::new(half)),
            |(transforms, factors, halves), (ky, (work, pressure))| {
                match spectrum {
                    Spectrum::Cell(rows) => {
                        let column = rows.column(ky);
                        halves.transform(half, odd[0], column.iter().copied(), factors.view_mut());
                    }
                    Spectrum::Wave(depth, poisson) => {
                        factors.iter_mut().enumerate().for_each(|(kx, factor)| {
                            // The shortest wave of an even number of cells has no sine.
                            let vanishes = odd[0] && 2 * kx == lengths[0] || odd[1] && 2 * ky == lengths[1];
                            let q = [TAU * kx as f64 / size[0], TAU * ky as f64 / size[1]];
                            *factor =
                                if vanishes { 0.0 } else { action.wave(component, q, *depth, *poisson) };
                        })
                    }
                }
                for (k, x) in transforms.forward(pressure).iter_mut().enumerate() {
                    let mirrored = 2 * k > mx;
                    let factor = factors[if mirrored { mx - k } else { k }];
                    *x *= unit * if mirrored && odd[0] { -factor } else { factor };
                }
                work.iter_mut().zip(transforms.back()).for_each(|(work, x)| *work += *x);
            },
        );
    }
}

/// The source of the spectrum of a component.
enum Spectrum {
    /// The coefficients of a cell, transformed along y: (i, ky).
    Cell(Array2<f64>),
    /// The closed form of a wave at this depth \[m\], with this Poisson's ratio.
    Wave(f64, f64),
}

/// Buffers of the transform of an even or odd sequence.
struct Half {
    input: Vec<f64>,
    output: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Half {
    fn new(fft: &Arc<dyn RealToComplex<f64>>) -> Self {
        Half { input: fft.make_input_vec(), output: fft.make_output_vec(), scratch: fft.make_scratch_vec() }
    }

    /// The transform of the even or odd continuation of `values` to the length of `fft`: the real part, or the imaginary part
    /// over i.
    fn transform(
        &mut self,
        fft: &Arc<dyn RealToComplex<f64>>,
        odd: bool,
        values: impl Iterator<Item = f64>,
        mut out: ArrayViewMut1<f64>,
    ) {
        let length = self.input.len();
        self.input.fill(0.0);
        let sign = if odd { -1.0 } else { 1.0 };
        for (j, x) in values.enumerate() {
            if j == 0 {
                // An odd sequence begins with zero.
                self.input[0] = if odd { 0.0 } else { x };
            } else {
                self.input[j] = x;
                self.input[length - j] = sign * x;
            }
        }
        let done = fft.process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch);
        debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
        out.iter_mut().zip(&self.output).for_each(|(to, x)| *to = if odd { x.im } else { x.re });
    }
}
