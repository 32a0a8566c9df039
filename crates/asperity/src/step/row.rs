//! What a row of the result tells: numbers of the contact, and the fields on request.

use ndarray::{Array2, ArrayView2};

use super::state::StepState;
use super::{Recorder, Stepper, UndeformedGap};
use crate::contact::{ContactState, Hardness, Outcome};
use crate::drive::Coordinate;
use crate::flash::{FlashRow, Rise};
use crate::history::History;
use crate::kernel::strip_at;
use crate::load::Control;
use crate::process::{Process, SlipFields, cells};
use crate::quantities::{Column, Quantity, contact_edges};
use crate::simulation::Simulation;
use crate::sliding::Friction;
use crate::tangential::SlipRow;
use crate::time::Instant;
use crate::traction::TractionSolver;
use asperity_sweep::{Max, kernel, run};

/// The numbers of one row.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Row {
    /// Where it stands among the rows of its run.
    pub coordinate: Coordinate,
    /// W = cell area times sum p \[N\].
    pub load: f64,
    /// w \[m\], zero at first touch of the undeformed bodies. Of a free line contact of half-spaces it is measured from the end of the domain,
    /// x = L: a half-space under a load on a line moves endlessly against points at infinity.
    pub approach: f64,
    /// Area of the cells in contact, with a contact pressure > 0 \[m^2\].
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
    /// Estimated error of the stress because of the time steps, relative; 0 where nothing touches, `None` with the schemes constant and
    /// direct.
    pub time_error: Option<f64>,
    /// Number of the stage, from 0.
    pub stage: usize,
}

/// The energies of a row \[J\].
pub(crate) struct EnergyBalance {
    /// Of the load.
    pub(crate) work: f64,
    /// The sum of those stored, lost and spent on flattening.
    pub(crate) energies: f64,
    /// How far the work is off, or may be off.
    pub(crate) error: f64,
    /// Whether the surfaces adhere.
    pub(crate) adheres: bool,
}

/// (pi - 1 + ln 2)/24: the mean excess of a counted area per perimeter and cell.
pub(crate) const PERIMETER_SHARE: f64 = (std::f64::consts::PI - 1.0 + std::f64::consts::LN_2) / 24.0;

/// One row of a run: the state, lent until the run goes on.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    pub(crate) index: usize,
    pub(crate) coordinate: Coordinate,
    /// Of a row in time.
    pub(crate) instant: Option<Instant>,
    pub(crate) control: Control,
    pub(crate) simulation: &'a Simulation,
    pub(crate) hardness: Hardness<'a>,
    pub(crate) state: &'a ContactState,
    /// A traction besides the contact.
    pub(crate) traction: Option<&'a TractionSolver>,
    /// h0 + g.
    pub(crate) gap: &'a [f64],
    /// c: u = c U + g.
    pub(crate) compliance: f64,
    pub(crate) outcome: Outcome,
    /// What the past leaves, g; `None` for none.
    pub(crate) recalled: Option<&'a dyn History>,
    pub(crate) time_error: Option<f64>,
    /// The undeformed gap, where processes may have changed it.
    pub(crate) undeformed: Option<&'a UndeformedGap>,
    pub(crate) processes: &'a [Box<dyn Process>],
    /// The quantities of the row; `None` between rows.
    pub(crate) recorder: Option<&'a Recorder>,
    /// The number that the stage of the row waits for; `None` where it waits for none.
    pub(crate) awaited: Option<f64>,
    /// The forces of a steady state of motion.
    pub(crate) friction: Option<Friction>,
    /// How warm the surfaces of a steady state of motion are.
    pub(crate) rise: Option<&'a Rise>,
}

impl<'a> Step<'a> {
    /// The state of a contact, of no time and velocity yet.
    pub(crate) fn of(
        simulation: &'a Simulation,
        hardness: Hardness<'a>,
        (state, outcome): (&'a ContactState, Outcome),
        (gap, compliance): (&'a [f64], f64),
    ) -> Self {
        Step {
            index: 0,
            coordinate: Coordinate::None,
            instant: None,
            control: Control::Load,
            simulation,
            hardness,
            state,
            traction: None,
            gap,
            compliance,
            outcome,
            recalled: None,
            time_error: None,
            undeformed: None,
            processes: &[],
            recorder: None,
            awaited: None,
            friction: None,
            rise: None,
        }
    }

    /// Number of the row; 0 is t = 0+.
    pub fn index(&self) -> usize {
        self.index
    }

    /// What is simulated.
    pub fn simulation(&self) -> &'a Simulation {
        self.simulation
    }

    /// The energies of the row; `None` where none is asked for.
    pub(crate) fn energy_balance(&self) -> Option<EnergyBalance> {
        let energy = |quantity| self.of_process(quantity);
        // What the pressure does on the slopes of a worn track is not known.
        if self.simulation.wear.is_some() && self.simulation.motion.is_some() {
            return None;
        }
        let work = energy(Quantity::ExternalWork)?;
        let adheres = self.traction.is_some();
        // The dissipated energy of surfaces that adhere, which each row has, does not need it.
        if adheres && !self.simulation.takes(Quantity::ExternalWork) {
            return None;
        }
        let attraction = if adheres { energy(Quantity::AdhesionEnergy)? } else { 0.0 };
        let sum =
            |of: fn(&dyn Process) -> f64| self.processes.iter().map(|process| of(&**process)).sum::<f64>();
        let kept = energy(Quantity::ElasticEnergy)? + energy(Quantity::DissipatedEnergy)? + attraction;
        let rubbed = self.slip_row().map_or(0.0, |row| row.work);
        let energies = kept + energy(Quantity::FlatteningWork)? + sum(|process| process.worn_work()) + rubbed;
        // Surfaces that jump into contact or off it lose energy besides, and gain none.
        let error = match adheres {
            true => sum(|process| process.unknown_work()).max(energies - work),
            false => (work - energies).abs(),
        };
        Some(EnergyBalance { work, energies, error, adheres })
    }

    /// A quantity that a process tells of this row.
    pub(crate) fn of_process(&self, quantity: Quantity) -> Option<f64> {
        let of_friction = || self.friction.and_then(|friction| friction.quantity(quantity));
        let of_traction = || self.traction?.quantity(quantity, self.simulation.grid.cell_area());
        let of_process = self.processes.iter().find_map(|process| process.quantity(quantity));
        let of_heat = || self.rise?.row.quantity(quantity);
        of_process.or_else(of_friction).or_else(of_heat).or_else(of_traction)
    }

    /// The number that the stage of the row waits for, NaN where the row has none; `None` where the stage waits for none.
    pub(crate) fn awaited(&self) -> Option<f64> {
        self.awaited
    }

    /// Time, length of the step, prescribed value; `None` of a steady state.
    pub fn instant(&self) -> Option<Instant> {
        self.instant
    }

    /// Time or velocity.
    pub fn coordinate(&self) -> Coordinate {
        self.coordinate
    }

    /// What is prescribed.
    pub fn control(&self) -> Control {
        self.control
    }

    /// True where every touching cell is at the hardness: the approach is only bounded from below.
    pub fn saturated(&self) -> bool {
        self.outcome.saturated
    }

    /// The forces of a contact in motion.
    pub fn friction(&self) -> Option<Friction> {
        Friction::from_quantities(|quantity| self.of_process(quantity))
    }

    /// Cells along x and y that the contact has moved, rounded: fields in its frame are taken there (see
    /// [`in_contact_frame`](crate::process::in_contact_frame)). 0 where nothing moves, and where the contact stays on the track.
    pub fn frame_shift(&self) -> [isize; 2] {
        match (&self.simulation.motion, self.of_process(Quantity::SlidingDistance)) {
            (Some(motion), Some(distance)) if motion.gap.follows() => {
                cells(motion.direction, self.simulation.grid.spacing(), distance)
            }
            _ => [0; 2],
        }
    }

    /// Pressure \[Pa\], shape (nx, ny): all of it, negative where the surfaces pull at each other.
    pub fn pressure(&self) -> ArrayView2<'a, f64> {
        to_view(self.simulation.grid.shape(), &self.state.pressure)
    }

    /// Contact pressure \[Pa\], 0 or more, shape (nx, ny): all of the pressure where no other traction acts.
    pub fn contact_pressure(&self) -> ArrayView2<'a, f64> {
        to_view(self.simulation.grid.shape(), self.contact_cells())
    }

    pub(crate) fn contact_cells(&self) -> &'a [f64] {
        self.traction.map_or(&self.state.pressure, TractionSolver::pressing)
    }

    /// The traction besides the contact \[Pa\], shape (nx, ny): negative where the surfaces pull at each other.
    pub(crate) fn other_traction(&self) -> Option<ArrayView2<'a, f64>> {
        self.traction.map(|traction| to_view(self.simulation.grid.shape(), traction.bound()))
    }

    /// Attraction between the surfaces \[Pa\], 0 or more: contact pressure less pressure.
    pub fn adhesive_traction_into(&self, traction: &mut Array2<f64>) {
        traction.fill(0.0);
        if let Some(bound) = self.other_traction() {
            traction.zip_mut_with(&bound, |t, b| *t = -b);
        }
    }

    /// Gap h = h0 + u - w \[m\]: 0 in contact, negative where capped cells are flattened.
    pub fn gap_into(&self, gap: &mut Array2<f64>) {
        let (c, w) = (self.compliance, self.state.approach);
        let cells = self.state.unit_displacement.iter().zip(self.gap);
        gap.iter_mut().zip(cells).for_each(|(gap, (u, h))| *gap = c * u + h - w);
        // Where other tractions act, contact is known to their tolerance only.
        if let Some(traction) = self.traction {
            let closed = traction.closed();
            if closed > 0.0 {
                gap.mapv_inplace(|gap| if gap.abs() <= closed { 0.0 } else { gap });
            }
            let cells = gap.iter_mut().zip(self.contact_cells()).enumerate();
            cells
                .filter(|(n, (_, q))| **q > 0.0 && **q < self.hardness.at(*n))
                .for_each(|(_, (gap, _))| *gap = 0.0);
        }
    }

    /// Normal displacement u = integral C d(Kp) of both surfaces together \[m\]; of a free line contact against the end of the
    /// domain, x = L.
    pub fn displacement_into(&self, displacement: &mut Array2<f64>) {
        let datum = self.datum();
        if let Some(displacement) = displacement.as_slice_mut() {
            self.recall(displacement);
        }
        let cells = displacement.iter_mut().zip(&self.state.unit_displacement);
        cells.for_each(|(g, u)| *g += self.compliance * u - datum);
    }

    /// 0 out of contact, 1 in contact, 2 at the hardness; 3 where it slips under a tangential load, at the hardness or not.
    pub fn contact_into(&self, contact: &mut Array2<u8>) {
        let state = |p: f64, hardness: f64| u8::from(p > 0.0) + u8::from(p >= hardness);
        let cells = contact.iter_mut().zip(self.contact_cells()).enumerate();
        cells.for_each(|(n, (c, p))| *c = state(*p, self.hardness.at(n)));
        if let Some(SlipFields { slips, .. }) = self.slip_fields() {
            contact.iter_mut().zip(slips).filter(|(_, slips)| **slips).for_each(|(c, _)| *c = 3);
        }
    }

    /// What friction does in this row; `None` without a tangential load.
    pub fn slip_row(&self) -> Option<SlipRow> {
        Some(self.slip_fields()?.numbers)
    }

    fn slip_fields(&self) -> Option<SlipFields<'a>> {
        self.processes.iter().find_map(|process| process.slip())
    }

    /// Tangential traction along an axis, 0 for x and 1 for y \[Pa\]; 0 everywhere without friction.
    pub fn tangential_traction_into(&self, axis: usize, traction: &mut Array2<f64>) {
        component_into(self.slip_fields().map(|fields| fields.traction), axis, traction);
    }

    /// Slip along an axis since t = 0, of each cell while it was in contact \[m\]; 0 everywhere without friction.
    pub fn slip_into(&self, axis: usize, slip: &mut Array2<f64>) {
        component_into(self.slip_fields().map(|fields| fields.slip), axis, slip);
    }

    /// Length of the path of the slip of each cell since t = 0 \[m\]; 0 everywhere without friction.
    pub fn slip_path_into(&self, path: &mut Array2<f64>) {
        copy_into(self.slip_fields().map(|fields| fields.path), path);
    }

    /// Energy per area that friction has turned into heat in each cell since t = 0 \[J/m^2\]; 0 everywhere without friction.
    pub fn friction_work_into(&self, work: &mut Array2<f64>) {
        copy_into(self.slip_fields().map(|fields| fields.heat), work);
    }

    /// Depth that wear has taken off the body (0), in the frame of what moves, or the counterbody (1), in that of the grid \[m\]; 0 without wear.
    pub fn wear_depth_into(&self, body: usize, depth: &mut Array2<f64>) {
        let worn = self.processes.iter().find_map(|process| process.worn());
        copy_into(worn.map(|worn| &worn[body][..]), depth);
    }

    /// The undeformed gap h0 of the row \[m\]: moved, flattened and worn; least value of the start 0.
    pub fn undeformed_gap_into(&self, gap: &mut Array2<f64>) {
        let now = self.undeformed.map_or(self.gap, UndeformedGap::now);
        copy_into(Some(now), gap);
    }

    /// How warm friction makes the surfaces of a contact in motion; `None` where that is not asked for.
    pub fn flash(&self) -> Option<FlashRow> {
        self.warm_surfaces().map(|rise| rise.row)
    }

    /// Temperature rise of the surface of the track by friction \[K\]; 0 everywhere without.
    pub fn flash_temperature_into(&self, temperature: &mut Array2<f64>) {
        copy_into(self.warm_surfaces().map(|rise| &rise.track[..]), temperature);
    }

    /// The same of the surface of the slider, where it touches the track \[K\].
    pub fn flash_temperature_of_slider_into(&self, temperature: &mut Array2<f64>) {
        copy_into(self.warm_surfaces().map(|rise| &rise.slider[..]), temperature);
    }

    fn warm_surfaces(&self) -> Option<&'a Rise> {
        self.rise.or_else(|| self.processes.iter().find_map(|process| process.rise()))
    }

    /// The numbers of the row.
    pub fn row(&self) -> Row {
        let Step { state, outcome, hardness, .. } = self;
        let Simulation { grid, boundary, .. } = self.simulation;
        let survey = Survey {
            p: &state.pressure,
            q: self.contact_cells(),
            u: &state.unit_displacement,
            h: self.gap,
            hardness: *hardness,
            c: self.compliance,
            w: state.approach,
        };
        let ([pressure, touching, capped, gap, touchable], Max(max_pressure)) = run(survey);
        // The border of a free domain is no edge of the contact, and the ends of a line contact are points.
        let edges =
            if grid.is_line() { 0 } else { contact_edges(self.contact_pressure(), *boundary).number() };
        let cell = grid.cell_area();
        Row {
            coordinate: self.coordinate,
            load: pressure * cell,
            approach: state.approach - self.datum(),
            contact_area: touching * cell,
            contact_area_corrected: touching * cell - PERIMETER_SHARE * edges as f64 * cell,
            contact_fraction: touching / grid.len() as f64,
            capped_area: capped * cell,
            mean_pressure: pressure / grid.len() as f64,
            max_pressure,
            mean_gap: gap / touchable,
            iterations: outcome.iterations,
            convolutions: outcome.convolutions,
            residual: outcome.residual,
            certificate: outcome.certificate,
            time_error: self.time_error,
            stage: self.instant.map_or(0, |instant| instant.stage),
        }
    }

    /// Writes g.
    fn recall(&self, g: &mut [f64]) {
        match self.recalled {
            Some(history) => history.recalled(g),
            None => g.fill(0.0),
        }
    }

    /// What displacements and approach are measured from \[m\]: where they are known up to a constant, the displacement of the domain's
    /// end, x = L; else 0. Between the last cell and the end u falls as the potential of the pressures of a half-space, in the ratio that
    /// both have between the last two cells. Where a traction reaches the last cell, it is on the straight line through the last two.
    fn datum(&self) -> f64 {
        if !self.simulation.is_up_to_a_constant() {
            return 0.0;
        }
        let mut u = vec![0.0; self.state.unit_displacement.len()];
        self.recall(&mut u);
        u.iter_mut().zip(&self.state.unit_displacement).for_each(|(g, unit)| *g += self.compliance * unit);
        let [.., before, last] = u[..] else { return 0.0 };
        let [between, beyond] = self.falls_at_end();
        match beyond > 0.0 && between > 0.0 {
            true => last - (before - last) * (beyond / between),
            false => last + 0.5 * (last - before),
        }
    }

    /// By how much the potential of the pressures falls between the last two cells of a line, and from the middle of the last one to its end;
    /// 0 where nothing presses, or something on the last one.
    fn falls_at_end(&self) -> [f64; 2] {
        let pressure = &self.state.pressure[..];
        let dx = self.simulation.grid.spacing()[0];
        let mut falls = [0.0; 2];
        for (cells, p) in pressure.iter().rev().enumerate().filter(|(_, p)| **p != 0.0) {
            if cells == 0 {
                return [0.0; 2];
            }
            let x = cells as f64 * dx;
            let [before, last, end] = [x - dx, x, x + 0.5 * dx].map(|x| strip_at(x, dx));
            falls = [falls[0] + p * (before - last), falls[1] + p * (last - end)];
        }
        falls
    }

    /// Permanent flattening \[m\] since t = 0, 0 or more: what [`Plasticity::Accumulate`](crate::Plasticity) has added to the
    /// undeformed gap, in motion in the frame of the body that is dented. 0 everywhere with the reversible cut-off.
    pub fn flattening_into(&self, flattening: &mut Array2<f64>) {
        flattening.fill(0.0);
        let Some(gap) = self.undeformed else { return };
        if self.simulation.motion.is_some() {
            flattening.iter_mut().zip(&gap.dents).for_each(|(f, dent)| *f = *dent);
        } else {
            let cells = flattening.iter_mut().zip(gap.now().iter().zip(gap.at_start()));
            cells.for_each(|(f, (now, then))| *f = if now > then { now - then } else { 0.0 });
            if let Some(worn) = self.processes.iter().find_map(|process| process.worn()) {
                for depth in worn {
                    flattening.iter_mut().zip(depth).for_each(|(f, z)| *f = (*f - z).max(0.0));
                }
            }
        }
    }

    /// The quantities asked for, with the ends of their bins; none of a state between rows.
    pub fn columns(&self) -> &'a [Column] {
        self.recorder.map_or(&[], |recorder| &recorder.columns)
    }

    /// The numbers of all [`columns`](Self::columns), one after the other. NaN after a solve that failed.
    pub fn quantities(&self) -> &'a [f64] {
        self.recorder.map_or(&[], |recorder| &recorder.values)
    }

    /// A quantity of this row: one number, or one per bin; `None` where it was not asked for.
    pub fn quantity(&self, quantity: Quantity) -> Option<&'a [f64]> {
        self.recorder?.of(quantity)
    }
}

impl Stepper {
    /// The state as a row of no time yet.
    pub(crate) fn row(&self) -> Step<'_> {
        let StepState { now, compliance, undeformed, .. } = &self.state;
        let gap = self.state.gap();
        Step {
            recalled: Some(&*self.history),
            undeformed: Some(undeformed),
            processes: &self.processes,
            traction: self.contact.traction.as_ref(),
            ..Step::of(&self.simulation, self.contact.hardness(), (now, self.outcome), (gap, *compliance))
        }
    }
}

impl Row {
    /// t \[s\]; NaN of a row that has no time.
    pub fn time(&self) -> f64 {
        match self.coordinate {
            Coordinate::Time(t) => t,
            _ => f64::NAN,
        }
    }
}

kernel! {
    /// The sums of p, of touching cells (contact pressure q > 0), of capped ones, of gaps, and of cells that can touch; and the largest p.
    struct Survey<'a> {
        cells { p: &'a [f64], q: &'a [f64], u: &'a [f64], h: &'a [f64], hardness: Hardness<'a> }
        numbers { c: f64, w: f64 }
    }
    fn run<V>(self) -> ([f64; 5], Max) {
        let [zero, c, w] = [0.0, self.c, self.w].map(V::splat);
        let (mut sums, mut peak) = ([zero; 5], zero);
        for n in (0..self.p.len()).step_by(8) {
            let [p, q, u] = [self.p, self.q, self.u].map(|field| V::load(field, n, 0.0));
            let h = V::load(self.h, n, f64::INFINITY);
            let can_touch = h.less(V::splat(f64::INFINITY));
            let capped = self.hardness.load::<V>(n).at_most(q);
            let gap = (c * u + h - w).only(can_touch);
            let terms = [p, V::count(zero.less(q)), V::count(capped), gap, V::count(can_touch)];
            sums = std::array::from_fn(|k| sums[k] + terms[k]);
            peak = p.larger(peak);
        }
        (sums.map(V::sum), Max(peak.largest()))
    }
}

/// A component of a field of vectors; 0 without one.
fn component_into(field: Option<&[[f64; 2]]>, axis: usize, to: &mut Array2<f64>) {
    to.fill(0.0);
    to.iter_mut().zip(field.unwrap_or_default()).for_each(|(to, v)| *to = v[axis]);
}

/// A field of numbers; 0 without one.
fn copy_into(field: Option<&[f64]>, to: &mut Array2<f64>) {
    to.fill(0.0);
    to.iter_mut().zip(field.unwrap_or_default()).for_each(|(to, value)| *to = *value);
}

/// The cells as a field.
pub(crate) fn to_view(shape: (usize, usize), cells: &[f64]) -> ArrayView2<'_, f64> {
    ArrayView2::from_shape(shape, cells).expect("fields of a run have the shape of its grid")
}
