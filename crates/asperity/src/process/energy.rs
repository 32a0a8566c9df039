//! The energy of the bodies: work of the load, springs, dashpots, flattening (docs/theory.md, "Energy and other quantities").
//!
//! ```text
//! springs     (A/2) [ E_inf <u, u> + Σ E_i <u - q_i, u - q_i> ],     <a, b> = Σ a K⁻¹ b,  A the area of a cell
//! dashpots    the work of the pressure on the bodies less what the springs take
//! flattening  A Σ p |h| over the cells at the hardness
//! work        ∫ W dw  =  the sum of the three, and of what wear takes: A Σ ∫ p dz
//! ```
//!
//! Springs and dashpots are those of the scheme, exactly ([`History::exchange`]). The work is taken from load and approach
//! alone: the mean of W over the step, on the clock in which u runs, times the change of w. Only where that is not known is it what
//! the bodies take: in a jump, at a first touch, and of elastic bodies, whose steps may have any length.
//!
//! Surfaces that adhere lose energy where they jump into contact or off it, so what the bodies take is no measure of the work. Where in
//! the step they jump is not known: with x prescribed and its response y, the work of the step lies between those of a jump at its start
//! and at its end, and is known to half of |Δx (Δy - y' Δx)|, y' Δx being the change without a jump. In a jump of x they may lose as much
//! as their attraction has gained or lost.

use super::{Process, Solved};
use crate::error::Result;
use crate::history::History;
use crate::load::Control;
use crate::material::Creep;
use crate::quantities::Quantity;
use crate::simulation::{Plasticity, Simulation};
use crate::step::{Loader, Saver, UndeformedGap, saved};
use asperity_sweep::sums;

/// The energies at the end of the last row \[J\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Energy {
    /// Of the springs.
    elastic: f64,
    /// Heat since t = 0.
    dissipated: f64,
    /// Work on the cells at the hardness: held there where the cut-off is reversible, spent where it stays.
    flattening: f64,
    /// ∫ W dw, and the work of friction, since t = 0.
    work: f64,
    /// w \[m\].
    approach: f64,
    /// Of the attraction between the surfaces \[J\].
    potential: f64,
    /// What is not known of the work, because surfaces that adhere jump.
    unknown: f64,
    /// dy/dx of the last step, x being prescribed and y its response; 0 after a jump.
    slope: f64,
    /// Heat per time in the last step \[W\].
    power: f64,
    /// Whether the load alone works on bodies that remember nothing: ∫ W dw is then the change of their energy, in steps of any length.
    is_conservative: bool,
}

impl Energy {
    /// `None` where no energy is asked for, or the history knows no springs and dashpots.
    pub(super) fn of(simulation: &Simulation, history: &mut dyn History) -> Option<Self> {
        let is_wanted = |q: &Quantity| q.is_energy() || *q == Quantity::DissipatedPower;
        let wanted = simulation.quantities.list.iter().any(is_wanted);
        let other_work = simulation.motion.is_some() || simulation.traction.is_some();
        let is_conservative = !other_work && !simulation.parts().any(Creep::remembers);
        (wanted && history.track_energy()).then_some(Energy { is_conservative, ..Energy::default() })
    }
}

saved! {
    Energy { "energies": elastic, dissipated, flattening, work, approach, potential, unknown, slope; }
}

impl Process for Energy {
    fn accept(&mut self, row: &mut Solved<'_>) {
        let Some(step) = row.exchange else { return };
        let cell_area = row.simulation.grid.cell_area();
        let overlap = cell_area * overlap_work(row);
        let flattened = match row.simulation.plasticity {
            Plasticity::Cap => overlap - self.flattening,
            Plasticity::Accumulate => overlap,
        };
        // A jump is elastic against what the bodies remember, and the course of W over w at a first touch is not known: there
        // the work is what the bodies take.
        let jump = row.step.length() == 0.0;
        let adheres = row.simulation.traction.is_some();
        if adheres {
            // The state right after t = 0 is where the work begins to count.
            self.unknown += match jump {
                true if row.step.instant.time == 0.0 => 0.0,
                true => (row.potential - self.potential).abs(),
                false => self.of_course(row) + row.unknown_work,
            };
            self.slope = if jump { 0.0 } else { self.slope };
        }
        self.work += match jump || self.is_conservative || !adheres && !row.before.touches() {
            true => cell_area * step.work + flattened + row.potential - self.potential + row.worn_work,
            false => step.mean_load * (row.now.approach - self.approach),
        };
        let before = self.dissipated;
        self.elastic = cell_area * step.stored;
        self.dissipated += cell_area * step.heat;
        self.flattening += flattened;
        self.approach = row.now.approach;
        self.potential = row.potential;
        self.work += row.other_work;
        self.power = if jump { 0.0 } else { (self.dissipated - before) / row.step.length() };
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::ElasticEnergy => Some(self.elastic),
            Quantity::DissipatedEnergy => Some(self.dissipated),
            Quantity::FlatteningWork => Some(self.flattening),
            Quantity::ExternalWork => Some(self.work),
            Quantity::DissipatedPower => Some(self.power),
            _ => None,
        }
    }

    fn unknown_work(&self) -> f64 {
        self.unknown
    }

    fn name(&self) -> &'static str {
        "energy"
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>, _gap: &'a UndeformedGap) {
        self.save_own(to);
    }

    fn load(&mut self, from: &mut Loader<'_>, _gap: &mut UndeformedGap) -> Result<()> {
        self.power = f64::NAN;
        self.load_own(from)
    }
}

impl Energy {
    /// What is not known of the work in a step, as the surfaces may jump anywhere in it. Right after a jump the slope is another one: so
    /// they may also stay as they are.
    fn of_course(&mut self, row: &Solved<'_>) -> f64 {
        let rise = row.loads[1] - row.loads[0];
        let advance = row.now.approach - self.approach;
        let (given, response) = match row.step.instant.control {
            Control::Approach => (advance, rise),
            Control::Load | Control::Pressure => (rise, advance),
        };
        let unexpected = (response - self.slope * given).abs().min(response.abs());
        if given != 0.0 {
            self.slope = response / given;
        }
        0.5 * given.abs() * unexpected
    }
}

/// Σ p |h| over the cells at the hardness \[m Pa\].
fn overlap_work(row: &Solved<'_>) -> f64 {
    let (c, w) = (row.compliance, row.now.approach);
    let cells = (&row.contact.pressure[..], &row.now.unit_displacement[..], row.gap(), row.hardness);
    sums(cells, |(p, u, h, hardness)| {
        let overlap = if p >= hardness { (w - c * u - h).max(0.0) } else { 0.0 };
        [if overlap > 0.0 { p * overlap } else { 0.0 }]
    })[0]
}
