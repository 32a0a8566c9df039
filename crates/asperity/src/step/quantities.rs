//! The quantities of a row, taken when the row is solved: those of its state here, the others from the processes.

use std::cell::LazyCell;

use ndarray::CowArray;

use super::{Step, UndeformedGap};
use crate::process::in_contact_frame;
use crate::quantities::{Column, Quantity, contact_edges, densities, eccentricity, spot_classes};
use crate::simulation::Plasticity;
use crate::spots::{Spots, spans};
use asperity_sweep::sums;

/// The quantities of the last row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recorder {
    pub(super) columns: Vec<Column>,
    /// The numbers of all columns, one after the other.
    pub(super) values: Vec<f64>,
}

impl Recorder {
    pub(crate) fn new(columns: Vec<Column>) -> Self {
        Recorder { values: vec![f64::NAN; columns.iter().map(Column::width).sum()], columns }
    }

    /// The numbers of a quantity.
    pub(crate) fn of(&self, quantity: Quantity) -> Option<&[f64]> {
        let mut start = 0;
        for column in &self.columns {
            let end = start + column.width();
            if column.quantity == quantity {
                return self.values.get(start..end);
            }
            start = end;
        }
        None
    }

    /// A row under way has no quantities.
    pub(crate) fn clear(&mut self) {
        self.values.fill(f64::NAN);
    }
}

impl Step<'_> {
    /// Writes the quantities of the row into `recorder`.
    pub(crate) fn record(&self, recorder: &mut Recorder) {
        let Recorder { columns, values } = recorder;
        let grid = &self.simulation.grid;
        let boundary = self.simulation.boundary;
        let pressure = self.contact_pressure();
        let spots = columns
            .iter()
            .any(|column| column.quantity.is_of_spots())
            .then(|| Spots::of(grid, boundary, pressure, |p| *p > 0.0));
        let of_spots = |of: fn(&Spots) -> f64| spots.as_ref().map_or(f64::NAN, of);
        // In the frame of the stored fields, whose borders count for percolation.
        let framed = LazyCell::new(|| match self.frame_shift() {
            [0, 0] => CowArray::from(pressure),
            shift => CowArray::from(in_contact_frame(pressure, boundary, shift, 0.0)),
        });
        // 1 along x, 2 along y, 3 both; on a line of cells nothing reaches along y.
        let across = |on: fn(&f64) -> bool| {
            let [x, y] = spans(boundary, framed.view(), on);
            f64::from(u8::from(x) + 2 * u8::from(y && !grid.is_line()))
        };
        let (c, w) = (self.compliance, self.state.approach);
        let gaps = || {
            let fields = self.state.unit_displacement.iter().zip(self.gap).zip(self.contact_cells());
            fields.filter(|((_, h), _)| **h < f64::INFINITY).map(move |((u, h), p)| (c * u + h - w, *p))
        };
        let mut rest = &mut values[..];
        for column in columns {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(column.width());
            rest = after;
            let one = match column.quantity {
                Quantity::ContactSpots => of_spots(|s| s.len() as f64),
                Quantity::LargestSpot => of_spots(|s| s.areas.first().copied().unwrap_or(0.0)),
                Quantity::MeanSpot => of_spots(Spots::mean_area),
                Quantity::ContactPerimeter => contact_edges(pressure, boundary).length(grid),
                Quantity::ContactPercolation => across(|p| *p > 0.0),
                Quantity::GapPercolation => across(|p| *p <= 0.0),
                Quantity::RmsGap => self.rms_gap(),
                Quantity::WornRoughness => self.worn_roughness(),
                Quantity::ContactEccentricity => eccentricity(grid, boundary, pressure),
                Quantity::SpotHistogram => {
                    if let Some(spots) = &spots {
                        spot_classes(spots, grid.cell_area(), own);
                    }
                    continue;
                }
                Quantity::PressureHistogram => {
                    let touching = self.contact_cells().iter().copied().filter(|p| *p > 0.0);
                    densities(touching, &column.edges, own);
                    continue;
                }
                Quantity::GapHistogram => {
                    let open = gaps().filter(|(_, p)| *p <= 0.0).map(|(gap, _)| gap);
                    densities(open, &column.edges, own);
                    continue;
                }
                tangential if tangential.is_tangential() => {
                    if let Some(row) = self.slip_row() {
                        row.write(tangential, own);
                    }
                    continue;
                }
                of_process => self.of_process(of_process).unwrap_or(f64::NAN),
            };
            own.fill(one);
        }
    }

    /// Root of the mean square of the undeformed gap's deviation from its mean, over the cells that can touch \[m\].
    fn worn_roughness(&self) -> f64 {
        let gap = self.undeformed.map_or(self.gap, UndeformedGap::now);
        let [cells, sum] = sums(gap, |h| if h < f64::INFINITY { [1.0, h] } else { [0.0; 2] });
        let mean = sum / cells;
        let [square] = sums(gap, |h| if h < f64::INFINITY { [(h - mean) * (h - mean)] } else { [0.0] });
        (square / cells).sqrt()
    }

    /// Root of the mean square of the gap over the cells that can touch \[m\].
    fn rms_gap(&self) -> f64 {
        let (c, w) = (self.compliance, self.state.approach);
        // Where flattening stays, a cell ends its row just closed.
        let closes = self.simulation.plasticity == Plasticity::Accumulate;
        let cells = (&self.state.unit_displacement[..], self.gap, &self.state.pressure[..], self.hardness);
        let [square, cells] = sums(cells, |(u, h, p, hardness)| {
            let apart = h < f64::INFINITY && !(closes && p >= hardness);
            let gap = if apart { c * u + h - w } else { 0.0 };
            [gap * gap, f64::from(u8::from(h < f64::INFINITY))]
        });
        (square / cells).sqrt()
    }
}
