//! How the heat divides between slider and track.

use rustfft::num_complex::Complex64;

use super::conduction::Conduction;
use super::{Flash, Partition};
use crate::convolution::torus::Spectrum;
use crate::error::{Error, Result};
use crate::linear::{Limits, gmres};

/// Tolerance of the temperatures in [`Partition::Local`], relative, and the vectors and restarts that may reach it.
const TOLERANCE: f64 = 1e-8;
pub(super) const VECTORS: usize = 60;
const RESTARTS: usize = 10;

/// What takes up the heat.
pub(super) struct Faces<'a> {
    pub(super) flash: &'a Flash,
    pub(super) conduction: &'a mut Conduction,
    /// Of slider and track; `None` of one that takes none.
    pub(super) spectra: [Option<&'a Spectrum>; 2],
}

impl Faces<'_> {
    /// The temperatures of slider and track under this heat, which is 0 off the `contact`, and the share of the slider.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the faces do not come to one temperature.
    pub(super) fn warm(&mut self, heat: &[f64], contact: &[usize]) -> Result<([Vec<f64>; 2], f64)> {
        let spectra = self.spectra;
        let mut alone = spectra.map(|spectrum| match spectrum {
            Some(spectrum) => self.image(spectrum, heat),
            None => vec![0.0; heat.len()],
        });
        let shares = match (alone.each_ref().map(|t| mean(t, contact)), spectra) {
            ([slider, track], [Some(_), Some(_)]) => [track, slider].map(|t| t / (slider + track)),
            (_, [slider, _]) => {
                if slider.is_some() {
                    [1.0, 0.0]
                } else {
                    [0.0, 1.0]
                }
            }
        };
        if let ([Some(slider), Some(track)], Partition::Local) = (spectra, self.flash.partition) {
            // The flux of the body that takes less is found, so that the tolerance is one of it.
            let is_slider = shares[0] < shares[1];
            let ([less, more], wanted) =
                if is_slider { ([slider, track], &alone[1]) } else { ([track, slider], &alone[0]) };
            let (share, less, more) = self.warm_locally([less, more], wanted, heat, contact)?;
            return Ok(if is_slider { ([less, more], share) } else { ([more, less], 1.0 - share) });
        }
        alone.iter_mut().zip(shares).for_each(|(t, share)| t.iter_mut().for_each(|t| *t *= share));
        Ok((alone, shares[0]))
    }

    /// (K + K_more) q = K_more q_all, `wanted`, on the contact: the share of the body that takes less, and both temperatures.
    fn warm_locally(
        &mut self,
        [less, more]: [&Spectrum; 2],
        wanted: &[f64],
        heat: &[f64],
        contact: &[usize],
    ) -> Result<(f64, Vec<f64>, Vec<f64>)> {
        let cells = heat.len();
        let on = |field: &[f64]| contact.iter().map(|cell| field[*cell]).collect::<Vec<f64>>();
        let off = |on: &[f64]| {
            let mut field = vec![0.0; cells];
            contact.iter().zip(on).for_each(|(cell, x)| field[*cell] = *x);
            field
        };
        let both = Spectrum(less.0.iter().zip(&more.0).map(|(a, b)| a + b).collect());
        let inverse = Spectrum(both.0.iter().map(inverse).collect());
        let wanted = on(wanted);
        let mut own = vec![0.0; contact.len()];
        let mut left = 1.0;
        for _ in 0..RESTARTS {
            let done = on(&self.image(&both, &off(&own)));
            let right: Vec<f64> = wanted.iter().zip(&done).map(|(a, b)| a - b).collect();
            left = size(&right) / size(&wanted).max(f64::MIN_POSITIVE);
            if left <= TOLERANCE {
                break;
            }
            let limits = Limits { reduction: 0.5 * TOLERANCE / left, vectors: VECTORS };
            let (change, _) = gmres(&right, limits, |v| {
                let z = on(&self.image(&inverse, &off(v)));
                let y = on(&self.image(&both, &off(&z)));
                Ok([z, y])
            })?;
            own.iter_mut().zip(&change).for_each(|(own, change)| *own += change);
        }
        if left > TOLERANCE {
            return Err(Error::invalid(
                "difference of the temperatures of both faces over their size",
                format!("{left:.1e}"),
                format!("at most {TOLERANCE:e}; take partition = \"mean\""),
            )
            .of("flash.partition"));
        }
        let own = off(&own);
        let other: Vec<f64> = heat.iter().zip(&own).map(|(all, own)| all - own).collect();
        let share = own.iter().sum::<f64>() / heat.iter().sum::<f64>();
        Ok((share, self.image(less, &own), self.image(more, &other)))
    }

    fn image(&mut self, spectrum: &Spectrum, heat: &[f64]) -> Vec<f64> {
        let mut to = vec![0.0; heat.len()];
        self.conduction.apply_into(spectrum, heat, &mut to);
        to
    }
}

/// 1/s, where the real part of a contact on a torus may be too small to invert: that of its size.
fn inverse(s: &Complex64) -> Complex64 {
    let size = s.norm();
    if s.re > 0.1 * size { s.inv() } else { Complex64::new(1.0 / size.max(f64::MIN_POSITIVE), 0.0) }
}

fn size(field: &[f64]) -> f64 {
    field.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Over these cells.
pub(super) fn mean(field: &[f64], cells: &[usize]) -> f64 {
    cells.iter().map(|cell| field[*cell]).sum::<f64>() / cells.len().max(1) as f64
}
