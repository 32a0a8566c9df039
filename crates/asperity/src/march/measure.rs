//! The quantities of a row, taken when the row is solved.

use super::energy::{End, Energy, Flattening};
use super::{March, Past, Step};
use crate::contact::Hardness;
use crate::error::Result;
use crate::operator::Operator;
use crate::quantities::{Column, ContactStiffness, Quantity, contact_edges, densities, spot_classes};
use crate::sliding::Friction;
use crate::spots::{Spots, spans};
use asperity_sweep::{strands, sweep};

/// What takes the quantities of a march, and those of the last row.
#[derive(Default)]
pub(crate) struct Meter {
    columns: Vec<Column>,
    /// The numbers of all columns, one after the other.
    values: Vec<f64>,
    stiffness: Option<ContactStiffness>,
    energy: Option<Energy>,
}

impl Meter {
    /// For these columns, of bodies that remember in this way.
    pub(super) fn new(columns: Vec<Column>, operator: &dyn Operator, past: &Past) -> Self {
        let has = |test: &dyn Fn(Quantity) -> bool| columns.iter().any(|column| test(column.quantity));
        Meter {
            values: vec![f64::NAN; columns.iter().map(Column::width).sum()],
            stiffness: has(&|q| q == Quantity::ContactStiffness).then(|| ContactStiffness::new(operator)),
            energy: Energy::new(past).filter(|_| has(&|q| q.is_energy() || q == Quantity::DissipatedPower)),
            columns,
        }
    }

    /// For these columns of a state that is no row of a march.
    pub(crate) fn of_state(columns: Vec<Column>) -> Self {
        Meter { values: vec![f64::NAN; columns.iter().map(Column::width).sum()], columns, ..Meter::default() }
    }

    pub(super) fn columns(&self) -> &[Column] {
        &self.columns
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Work of the load, and what became of it, where energies are asked for.
    pub(super) fn energy_balance(&self) -> Option<[f64; 2]> {
        let energy = self.energy.as_ref()?;
        Some([energy.work, energy.elastic + energy.dissipated + energy.flattening])
    }

    /// The numbers of a quantity.
    pub(super) fn of(&self, quantity: Quantity) -> Option<&[f64]> {
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
    pub(super) fn clear(&mut self) {
        self.values.fill(f64::NAN);
    }

    pub(super) fn save(&self) -> Vec<f64> {
        self.energy.as_ref().map_or(vec![], Energy::save)
    }

    /// How many numbers [`save`](Self::save) gives.
    pub(super) fn saved(&self) -> usize {
        self.energy.as_ref().map_or(0, Energy::len)
    }

    /// Takes back what [`save`](Self::save) gave of the state that `past` holds; false where it does not fit.
    pub(super) fn restore(&mut self, past: &Past, numbers: &[f64]) -> bool {
        self.energy.as_mut().is_none_or(|energy| energy.restore(past, numbers))
    }
}

impl March {
    /// Takes the quantities of the row that the state was just solved for, which is `jump` where no time passed.
    pub(super) fn measure(&mut self, jump: bool) -> Result<()> {
        if self.meter.columns.is_empty() {
            return Ok(());
        }
        let mut meter = std::mem::take(&mut self.meter);
        let taken = self.take(&mut meter, jump);
        self.meter = meter;
        taken
    }

    fn take(&mut self, meter: &mut Meter, jump: bool) -> Result<()> {
        let mut stiffness = 0.0;
        if let Some(solver) = &mut meter.stiffness {
            let (pressure, simulation) = (&self.state.pressure, &self.simulation);
            let most = match simulation.plasticity {
                super::Plasticity::Cap => super::cap(simulation, &self.hardness),
                super::Plasticity::Accumulate => Hardness::Uniform(f64::INFINITY),
            };
            let bears = |k: usize| pressure[k] > 0.0 && pressure[k] < most.at(k);
            let compliance = simulation.instantaneous();
            let found = solver.of(&mut *self.operator, compliance, bears, self.interrupt.as_deref())?;
            stiffness = found.0;
            self.outcome.convolutions += found.1;
        }
        if let Some(energy) = &mut meter.energy {
            let cell_area = self.simulation.grid.cell_area();
            let overlap = cell_area * self.overlap_work();
            let end = End {
                load: cell_area * asperity_sweep::sum(&self.state.pressure),
                approach: self.state.approach,
                flattening: match self.simulation.plasticity {
                    super::Plasticity::Cap => Flattening::Held(overlap),
                    super::Plasticity::Accumulate => Flattening::Spent(overlap),
                },
                jump,
            };
            let before = energy.dissipated;
            energy.take(&self.past, self.ends(), cell_area, end);
            energy.work += self.slid.work;
            self.friction.power = match self.slid.dt > 0.0 {
                true => (energy.dissipated - before) / self.slid.dt,
                false => 0.0,
            };
        }
        let Some(step) = self.last() else { return Ok(()) };
        step.fill(meter, stiffness);
        Ok(())
    }

    /// Σ p |h| over the cells at the hardness \[m Pa\].
    fn overlap_work(&self) -> f64 {
        let (c, w) = (self.compliance, self.state.approach);
        let hardness = super::cap(&self.simulation, &self.hardness);
        let cells = (&self.state.pressure[..], &self.state.unit_displacement[..], &self.gap[..], hardness);
        sweep(cells, &|(p, u, h, hardness): (&[f64], &[f64], &[f64], Hardness)| {
            strands(p.len(), |i| {
                let overlap = if p[i] >= hardness.at(i) { (w - c * u[i] - h[i]).max(0.0) } else { 0.0 };
                [if overlap > 0.0 { p[i] * overlap } else { 0.0 }]
            })
        })[0]
    }
}

impl Step<'_> {
    /// Writes the quantities of the row into `meter`.
    pub(crate) fn fill(&self, meter: &mut Meter, stiffness: f64) {
        let Meter { columns, values, energy, .. } = meter;
        let grid = &self.simulation.grid;
        let boundary = self.simulation.boundary;
        let pressure = self.pressure();
        let spots = columns
            .iter()
            .any(|column| column.quantity.is_of_spots())
            .then(|| Spots::of(grid, boundary, pressure, |p| *p > 0.0));
        let of_spots = |of: fn(&Spots) -> f64| spots.as_ref().map_or(f64::NAN, of);
        // 1 along x, 2 along y, 3 both; on a line of cells nothing reaches along y.
        let across = |on: fn(&f64) -> bool| {
            let [x, y] = spans(boundary, pressure, on);
            f64::from(u8::from(x) + 2 * u8::from(y && !grid.is_line()))
        };
        let energy = |of: fn(&Energy) -> f64| energy.as_ref().map_or(f64::NAN, of);
        let moving = |of: fn(&Friction) -> f64| self.friction.as_ref().map_or(f64::NAN, of);
        let (c, w) = (self.compliance, self.state.approach);
        let gaps = || {
            let fields = self.state.unit_displacement.iter().zip(self.gap).zip(&self.state.pressure);
            fields.filter(|((_, h), _)| **h < f64::INFINITY).map(move |((u, h), p)| (c * u + h - w, *p))
        };
        let mut rest = &mut values[..];
        for column in columns {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(column.width());
            rest = after;
            let one = match column.quantity {
                Quantity::ContactStiffness => stiffness,
                Quantity::ContactSpots => of_spots(|s| s.len() as f64),
                Quantity::LargestSpot => of_spots(|s| s.areas.first().copied().unwrap_or(0.0)),
                Quantity::MeanSpot => of_spots(Spots::mean_area),
                Quantity::ContactPerimeter => contact_edges(pressure, boundary).length(grid),
                Quantity::ContactPercolation => across(|p| *p > 0.0),
                Quantity::GapPercolation => across(|p| *p <= 0.0),
                Quantity::RmsGap => self.rms_gap(),
                Quantity::ElasticEnergy => energy(|e| e.elastic),
                Quantity::DissipatedEnergy => energy(|e| e.dissipated),
                Quantity::FlatteningWork => energy(|e| e.flattening),
                Quantity::ExternalWork => energy(|e| e.work),
                Quantity::Velocity => moving(|f| f.velocity),
                Quantity::SlidingDistance => moving(|f| f.distance),
                Quantity::FrictionForce => moving(|f| f.force),
                Quantity::SideForce => moving(|f| f.side),
                Quantity::FrictionCoefficient => moving(|f| f.coefficient),
                Quantity::FrictionCoefficientTotal => moving(|f| f.total),
                Quantity::FrictionUncertainty => moving(|f| f.uncertainty),
                Quantity::RollingMoment => moving(|f| f.moment),
                Quantity::DissipatedPower => moving(|f| f.power),
                Quantity::SpotHistogram => {
                    if let Some(spots) = &spots {
                        spot_classes(spots, grid.cell_area(), own);
                    }
                    continue;
                }
                Quantity::PressureHistogram => {
                    let touching = self.state.pressure.iter().copied().filter(|p| *p > 0.0);
                    densities(touching, &column.edges, own);
                    continue;
                }
                Quantity::GapHistogram => {
                    let open = gaps().filter(|(_, p)| *p <= 0.0).map(|(gap, _)| gap);
                    densities(open, &column.edges, own);
                    continue;
                }
            };
            own.fill(one);
        }
    }

    /// Root of the mean square of the gap over the cells that can touch \[m\].
    fn rms_gap(&self) -> f64 {
        let (c, w) = (self.compliance, self.state.approach);
        // Where flattening stays, a cell ends its row just closed.
        let closes = self.simulation.plasticity == super::Plasticity::Accumulate;
        let cells = (&self.state.unit_displacement[..], self.gap, &self.state.pressure[..], self.hardness);
        let [square, cells] = sweep(cells, &|(u, h, p, hardness): (&[f64], &[f64], &[f64], Hardness)| {
            strands(u.len(), |i| {
                let apart = h[i] < f64::INFINITY && !(closes && p[i] >= hardness.at(i));
                let gap = if apart { c * u[i] + h[i] - w } else { 0.0 };
                [gap * gap, f64::from(u8::from(h[i] < f64::INFINITY))]
            })
        });
        (square / cells).sqrt()
    }
}
