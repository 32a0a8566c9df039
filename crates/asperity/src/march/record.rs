//! What a row of the result tells: numbers of the contact, and the fields on request.

use asperity_sweep::simd::{F64x8, Work, vectorize};
use ndarray::{Array2, ArrayView2};

use crate::contact::{ContactState, Hardness, Outcome};
use crate::grid::{Boundary, Grid};
use crate::march::dents::Dents;
use crate::march::measure::Meter;
use crate::march::{Past, Simulation};
use crate::quantities::{Column, Quantity, contact_edges};
use crate::sliding::Friction;
use crate::time::Instant;
use asperity_sweep::{Max, sweep};

/// The numbers of one row.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Row {
    /// t \[s\].
    pub time: f64,
    /// W = cell area times sum p \[N\].
    pub load: f64,
    /// w \[m\], zero at first touch of the undeformed bodies. Of a free line contact of half-spaces it is measured from the end of the domain,
    /// x = L: a half-space under a load on a line moves endlessly against points at infinity.
    pub approach: f64,
    /// Area of the cells with p > 0 \[m^2\].
    pub contact_area: f64,
    /// Contact area less the share of its perimeter (Yastrebov, Anciaux & Molinari 2017) \[m^2\].
    pub contact_area_corrected: f64,
    /// Contact area over the domain's.
    pub contact_fraction: f64,
    /// Area of the cells at the hardness \[m^2\].
    pub capped_area: f64,
    /// W over the domain's area \[Pa\].
    pub mean_pressure: f64,
    /// Largest p \[Pa\].
    pub max_pressure: f64,
    /// Mean gap of the cells that can touch \[m\]; flattened overlap counts as negative.
    pub mean_gap: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Applications of K.
    pub convolutions: usize,
    /// Largest violation of the contact conditions over the pressure-weighted mean displacement.
    pub residual: f64,
    /// Certified relative energy-norm error of the pressure.
    pub certificate: f64,
    /// Estimated error of the stress at the end of the step, relative, where steps are adaptive or layers creep differently; 0 of
    /// a jump, and where nothing touches.
    pub time_error: Option<f64>,
    /// Number of the stage, from 0.
    pub stage: usize,
}

/// (pi - 1 + ln 2)/24: the mean excess of a counted area per perimeter and cell.
pub(crate) const PERIMETER_SHARE: f64 = (std::f64::consts::PI - 1.0 + std::f64::consts::LN_2) / 24.0;

/// One row of a march: the state, lent until the march goes on.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    pub(super) index: usize,
    pub(super) instant: Instant,
    pub(super) simulation: &'a Simulation,
    pub(super) hardness: Hardness<'a>,
    pub(super) state: &'a ContactState,
    /// h0 + g.
    pub(super) gap: &'a [f64],
    /// c: u = c U + g.
    pub(super) compliance: f64,
    pub(super) outcome: Outcome,
    pub(super) remembered: Remembered<'a>,
    pub(super) time_error: Option<f64>,
    pub(super) dents: Option<&'a Dents>,
    /// The quantities of the row; `None` between rows.
    pub(super) meter: Option<&'a Meter>,
    /// The displacement that displacements and approach are measured from \[m\].
    pub(super) datum: f64,
    /// The forces of a contact in motion.
    pub(super) friction: Option<Friction>,
}

/// A state that no march made, with the numbers of its solve.
pub(crate) struct Lone<'a> {
    pub(crate) index: usize,
    pub(crate) instant: Instant,
    pub(crate) simulation: &'a Simulation,
    pub(crate) state: &'a ContactState,
    /// Undeformed gap \[m\].
    pub(crate) gap: &'a [f64],
    /// u = compliance U.
    pub(crate) compliance: f64,
    pub(crate) outcome: Outcome,
    pub(crate) friction: Friction,
    pub(crate) datum: f64,
}

impl<'a> Lone<'a> {
    /// As a row, with the quantities in `meter` where they are taken.
    pub(crate) fn row(self, meter: Option<&'a Meter>) -> Step<'a> {
        let Lone { index, instant, simulation, state, gap, compliance, outcome, friction, datum } = self;
        Step {
            index,
            instant,
            simulation,
            hardness: Hardness::Uniform(simulation.hardness),
            state,
            gap,
            compliance,
            outcome,
            remembered: Remembered::Nothing,
            time_error: None,
            dents: None,
            meter,
            datum,
            friction: Some(friction),
        }
    }
}

/// g, the displacement that the past leaves.
#[derive(Clone, Copy)]
pub(super) enum Remembered<'a> {
    /// Of the step under way.
    Past(&'a Past),
    /// Itself.
    Field(&'a [f64]),
    /// None.
    Nothing,
}

impl<'a> Step<'a> {
    /// Number of the row; 0 is t = 0+.
    pub fn index(&self) -> usize {
        self.index
    }

    /// What is simulated.
    pub fn simulation(&self) -> &'a Simulation {
        self.simulation
    }

    /// Work of the load, and the sum of the energies stored, lost and spent on flattening \[J\]; `None` where no energy is
    /// asked for.
    pub(crate) fn energy_balance(&self) -> Option<[f64; 2]> {
        self.meter?.energy_balance()
    }

    /// Time, length of the step, prescribed value.
    pub fn instant(&self) -> Instant {
        self.instant
    }

    /// True where every touching cell is at the hardness: the approach is only bounded from below.
    pub fn saturated(&self) -> bool {
        self.outcome.saturated
    }

    /// The forces of a contact in motion.
    pub fn friction(&self) -> Option<Friction> {
        self.friction
    }

    /// Pressure \[Pa\], shape (nx, ny).
    pub fn pressure(&self) -> ArrayView2<'a, f64> {
        to_view(self.simulation.grid.shape(), &self.state.pressure)
    }

    /// Gap h = h0 + u - w \[m\]: 0 in contact, negative where capped cells are flattened.
    pub fn gap_into(&self, gap: &mut Array2<f64>) {
        let (c, w) = (self.compliance, self.state.approach);
        let cells = self.state.unit_displacement.iter().zip(self.gap);
        gap.iter_mut().zip(cells).for_each(|(gap, (u, h))| *gap = c * u + h - w);
    }

    /// Normal displacement u = integral C d(Kp) of both surfaces together \[m\]; of a free line contact against the end of the
    /// domain, x = L.
    pub fn displacement_into(&self, displacement: &mut Array2<f64>) {
        if let Some(displacement) = displacement.as_slice_mut() {
            match self.remembered {
                Remembered::Past(past) => past.remembered(displacement),
                Remembered::Field(g) => displacement.copy_from_slice(g),
                Remembered::Nothing => displacement.fill(0.0),
            }
        }
        let cells = displacement.iter_mut().zip(&self.state.unit_displacement);
        cells.for_each(|(g, u)| *g += self.compliance * u - self.datum);
    }

    /// 0 out of contact, 1 in contact, 2 at the hardness.
    pub fn contact_into(&self, contact: &mut Array2<u8>) {
        let state = |p: f64, hardness: f64| u8::from(p > 0.0) + u8::from(p >= hardness);
        let cells = contact.iter_mut().zip(&self.state.pressure).enumerate();
        cells.for_each(|(n, (c, p))| *c = state(*p, self.hardness.at(n)));
    }

    /// The numbers of the row.
    pub fn row(&self) -> Row {
        let Simulation { grid, boundary, .. } = self.simulation;
        let bodies = (self.gap, self.hardness, self.compliance);
        let contact = Row::of_contact(grid, *boundary, bodies, self.state, &self.outcome);
        Row {
            time: self.instant.time,
            approach: self.state.approach - self.datum,
            time_error: self.time_error,
            stage: self.instant.stage,
            ..contact
        }
    }

    /// Permanent flattening \[m\] since t = 0, 0 or more: what [`Plasticity::Accumulate`](super::Plasticity) has added to the
    /// undeformed gap. 0 everywhere with the reversible cut-off.
    pub fn flattening_into(&self, flattening: &mut Array2<f64>) {
        let undeformed = &self.simulation.gap;
        match self.dents {
            Some(dents) => {
                let cells = flattening.iter_mut().zip(dents.gap().iter().zip(undeformed));
                cells.for_each(|(f, (now, then))| *f = if now > then { now - then } else { 0.0 });
            }
            None => flattening.fill(0.0),
        }
    }

    /// The quantities asked for, with the ends of their bins; none of a state between rows.
    pub fn columns(&self) -> &'a [Column] {
        self.meter.map_or(&[], Meter::columns)
    }

    /// The numbers of all [`columns`](Self::columns), one after the other. NaN after a solve that failed.
    pub fn quantities(&self) -> &'a [f64] {
        self.meter.map_or(&[], Meter::values)
    }

    /// A quantity of this row: one number, or one per bin; `None` where it was not asked for.
    pub fn quantity(&self, quantity: Quantity) -> Option<&'a [f64]> {
        self.meter?.of(quantity)
    }
}

impl Row {
    /// The numbers of one elastic contact, at the time 0: of a state that solves the problem of this gap \[m\], hardness and
    /// compliance \[1/Pa\], each cell of the grid.
    pub fn of_contact(
        grid: &Grid,
        boundary: Boundary,
        (gap, hardness, compliance): (&[f64], Hardness<'_>, f64),
        state: &ContactState,
        outcome: &Outcome,
    ) -> Row {
        let (c, w) = (compliance, state.approach);
        let ([pressure, touching, capped, gap, touchable], Max(peak)) = sweep(
            (&state.pressure[..], &state.unit_displacement[..], gap, hardness),
            &|(p, u, h, hardness): (&[f64], &[f64], &[f64], Hardness)| {
                vectorize(Survey { p, u, h, hardness, c, w })
            },
        );
        // The border of a free domain is no edge of the contact, and the ends of a line contact are points.
        let edges = match grid.is_line() {
            true => 0,
            false => contact_edges(to_view(grid.shape(), &state.pressure), boundary).number(),
        };
        let cell = grid.cell_area();
        let contact_area = touching * cell;
        Row {
            time: 0.0,
            load: pressure * cell,
            approach: w,
            contact_area,
            contact_area_corrected: contact_area - PERIMETER_SHARE * edges as f64 * cell,
            contact_fraction: touching / grid.len() as f64,
            capped_area: capped * cell,
            mean_pressure: pressure / grid.len() as f64,
            max_pressure: peak,
            mean_gap: gap / touchable,
            iterations: outcome.iterations,
            convolutions: outcome.convolutions,
            residual: outcome.residual,
            certificate: outcome.certificate,
            time_error: None,
            stage: 0,
        }
    }
}

/// The sums of p, of touching cells, of capped ones, of gaps, and of cells that can touch; and the largest p.
struct Survey<'a> {
    p: &'a [f64],
    u: &'a [f64],
    h: &'a [f64],
    hardness: Hardness<'a>,
    c: f64,
    w: f64,
}

impl Work for Survey<'_> {
    type Yield = ([f64; 5], Max);

    #[inline(always)]
    fn run<V: F64x8>(self) -> ([f64; 5], Max) {
        let [zero, c, w] = [0.0, self.c, self.w].map(V::splat);
        let (mut sums, mut peak) = ([zero; 5], zero);
        for n in (0..self.p.len()).step_by(8) {
            let [p, u] = [self.p, self.u].map(|field| V::load(field, n, 0.0));
            let h = V::load(self.h, n, f64::INFINITY);
            let can_touch = h.less(V::splat(f64::INFINITY));
            let capped = self.hardness.load::<V>(n).at_most(p);
            let gap = (c * u + h - w).only(can_touch);
            let terms = [p, V::count(zero.less(p)), V::count(capped), gap, V::count(can_touch)];
            sums = std::array::from_fn(|k| sums[k] + terms[k]);
            peak = p.larger(peak);
        }
        (sums.map(V::sum), Max(peak.largest()))
    }
}

/// The cells as a field.
pub(super) fn to_view(shape: (usize, usize), cells: &[f64]) -> ArrayView2<'_, f64> {
    ArrayView2::from_shape(shape, cells).expect("fields of a march have the shape of its grid")
}
