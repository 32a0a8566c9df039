//! The temperatures of the rows of a run.

use super::Flash;
use super::conduction::Conduction;
use super::partition::{Faces, VECTORS, mean};
use crate::convolution::torus::Spectrum;
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::sliding::Direction;

/// The numbers of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlashRow {
    /// Largest temperature rise of the two faces \[K\].
    pub max: f64,
    /// Mean over the contact of the faces that are heated \[K\].
    pub mean: f64,
    /// Share of the heat that goes into the slider.
    pub share: f64,
    /// All of the heat \[W\].
    pub power: f64,
    /// Temperature at which the material was taken \[K\]; NaN without feedback.
    pub material: f64,
    /// Another mean with which this row would be steady, about \[K\]; NaN where none is seen.
    pub other: f64,
}

impl FlashRow {
    /// The quantity of a row that is one of these.
    pub(crate) fn quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::FlashTemperatureMax => Some(self.max),
            Quantity::FlashTemperatureMean => Some(self.mean),
            Quantity::HeatShare => Some(self.share),
            Quantity::HeatPower => Some(self.power),
            Quantity::MaterialTemperature => Some(self.material),
            _ => None,
        }
    }
}

/// How warm the surfaces of a row are above their surroundings \[K\], and its numbers.
#[derive(Clone, Debug)]
pub struct Rise {
    /// Of the body that carries the surfaces that move.
    pub slider: Vec<f64>,
    /// Of the other body.
    pub track: Vec<f64>,
    pub(crate) row: FlashRow,
}

/// What rubs in a row.
#[derive(Clone, Copy)]
pub struct Rubbing<'a> {
    /// Of the contact over the track, along the direction of motion \[m/s\].
    pub velocity: f64,
    /// Contact pressure \[Pa\].
    pub pressure: &'a [f64],
    /// Shear stress on the area in contact \[Pa\].
    pub shear: f64,
    /// Friction coefficient of the loss in the bodies.
    pub loss: f64,
}

/// Memory that the temperatures take \[bytes\]: heat, two fields, those of the partition, and three spectra.
pub(crate) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
    let on_torus = if boundary == Boundary::Free { 4 } else { 1 };
    8 * grid.len() * (3 + 2 * VECTORS) + 5 * 16 * on_torus * (grid.len() / 2 + grid.cells()[0])
}

/// The temperatures under given pressures: what the rows of a run need.
pub struct FlashSolver {
    flash: Flash,
    cell: f64,
    conduction: Conduction,
    /// Of slider and track, with the velocity of the source over it; `None` of one that takes no heat.
    spectra: [Option<(f64, Spectrum)>; 2],
    /// The temperatures found last.
    pub rise: Rise,
}

impl FlashSolver {
    /// `None` where nothing warms the surfaces.
    pub fn of(simulation: &Simulation, direction: Direction) -> Option<Self> {
        let (flash, grid) = (simulation.flash.as_deref()?.clone(), &simulation.grid);
        let conduction = Conduction::new(grid, simulation.boundary, direction, flash.heated_for);
        let cold = || vec![0.0; grid.len()];
        Some(FlashSolver {
            spectra: [None, None],
            cell: grid.cell_area(),
            conduction,
            rise: Rise { slider: cold(), track: cold(), row: FlashRow::default() },
            flash,
        })
    }

    /// Finds the temperatures under this rubbing; the surfaces are cold without.
    ///
    /// # Errors
    /// As the partition.
    pub fn warm(&mut self, rubbing: Rubbing<'_>) -> Result<()> {
        let Rubbing { velocity, pressure, shear, loss } = rubbing;
        let coefficient = self.flash.friction + if self.flash.hysteresis { loss.max(0.0) } else { 0.0 };
        let speed = velocity.abs();
        let heat_of = |p: f64| if p > 0.0 { (coefficient * p + shear) * speed } else { 0.0 };
        let heat: Vec<f64> = pressure.iter().map(|p| heat_of(*p)).collect();
        let power = self.cell * heat.iter().sum::<f64>();
        if power == 0.0 {
            self.rise.slider.fill(0.0);
            self.rise.track.fill(0.0);
            self.rise.row = FlashRow { material: f64::NAN, other: f64::NAN, ..FlashRow::default() };
            return Ok(());
        }
        let contact: Vec<usize> = (0..pressure.len()).filter(|cell| pressure[*cell] > 0.0).collect();
        // Of the source over slider and track.
        let velocities = if self.flash.still() == 0 { [0.0, velocity] } else { [-velocity, 0.0] };
        for (k, velocity) in velocities.into_iter().enumerate() {
            if self.flash.heats()[k] && self.spectra[k].as_ref().is_none_or(|(of, _)| *of != velocity) {
                let spectrum = self.conduction.spectrum(self.flash.bodies[k], velocity);
                self.spectra[k] = Some((velocity, spectrum));
            }
        }
        let mut faces = Faces {
            flash: &self.flash,
            conduction: &mut self.conduction,
            spectra: self.spectra.each_ref().map(|of| of.as_ref().map(|(_, spectrum)| spectrum)),
        };
        let ([slider, track], share) = faces.warm(&heat, &contact)?;
        let heated = if self.flash.heats()[1] { &track } else { &slider };
        let row = FlashRow {
            max: slider.iter().chain(&track).copied().fold(0.0, f64::max),
            mean: mean(heated, &contact),
            share,
            power,
            material: f64::NAN,
            other: f64::NAN,
        };
        self.rise = Rise { slider, track, row };
        Ok(())
    }
}
