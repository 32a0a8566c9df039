//! The diagnostics of a run: findings before the run, from each row, and at the end.

use ndarray::ArrayView2;

use super::contact::{Counted, Resolution, never};
use super::energy::Balance;
use super::expected::{ROOM, radius};
use super::histogram::Beyond;
use super::motion::Slides;
use super::strain::Strain;
use super::thin::Widest;
use super::worst::{Watch, extend};
use super::{
    BEYOND_HISTOGRAM, CONTACT_AT_BORDER, ENERGY_BALANCE, Finding, LARGE_SLOPE, LARGE_STRAIN,
    SPOTS_UNRESOLVED, STEPS_TOO_LONG, adhesion, domain, event, flash, fluid, material, plausible, strain,
    surface, tangential, thin, time, wear,
};
use crate::grid::{Boundary, Grid};
use crate::load::Control;
use crate::material::Body;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::sliding::{Friction, Streaming};
use crate::step::{Row, Step};
use crate::surface::{Part, Shape};

/// Information on a simulation in addition to its numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known<'a> {
    /// The parts of the gap; empty if only the gap is known.
    pub parts: &'a [Part],
    /// The bodies; empty if only the pair is known.
    pub bodies: &'a [Body],
    /// Thickness of the thinnest body that is treated as a half-space \[m\], if known.
    pub thickness: Option<f64>,
    /// Whether a surface was continued by its reflections, so that the slope of the gap changes sign at the border.
    pub mirrored: bool,
}

/// The diagnostics of one run.
///
/// ```
/// use asperity::finding::{Diagnostics, Known, CONTACT_AT_BORDER};
/// use asperity::{drive::{Drive, March}, material::Creep, surface::{Part, Shape, undeformed_gap}, *};
/// // A sphere of 10 mm under 20 N on 1 MPa: the contact fills the domain of 2 mm.
/// let grid = Grid::new([32, 32], [2e-3, 2e-3])?;
/// let parts = [Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] }];
/// let mut march = March::new(Simulation {
///     creep: Creep::elastic(1e-6),
///     loading: Loading { control: Control::Load, history: History::Step { value: 20.0 } }.into(),
///     ..Simulation::new(grid, undeformed_gap(&grid, &parts)?)
/// })?;
/// let mut diagnostics = Diagnostics::new(march.simulation(), Known { parts: &parts, ..Known::default() });
/// while let Some(step) = march.advance()? {
///     diagnostics.see(&step, &step.row());
/// }
/// let findings = diagnostics.findings(march.simulation());
/// let border = findings.iter().find(|finding| finding.code == CONTACT_AT_BORDER).expect("it fills the domain");
/// assert!(border.is_warning() && border.rows == Some([0, 1]));
/// assert!(border.limit > Some(4e-3)); // the domain that the contact would take
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct Diagnostics {
    grid: Grid,
    /// Found before the first row.
    known: Vec<Finding>,
    /// Whether contact at the border is checked, and whether a larger domain would confine it.
    free: bool,
    confined: bool,
    /// Radius of the paraboloid that approximates the gap at the border \[m\].
    radius: Option<f64>,
    border: Option<[usize; 2]>,
    /// Side of the domain that the contact would need \[m\].
    needed: f64,
    /// Rows so far.
    rows: usize,
    deepest: f64,
    resolution: Resolution,
    strain: Strain,
    slides: Slides,
    /// Of adhesion, fluid, tangential load, wear and flash temperature.
    watches: Vec<Box<dyn Watch + Send + Sync>>,
    balance: Balance,
    beyond: Beyond,
    /// Where an approach is held while cells are at the hardness, and the control of each stage.
    held: time::Held,
    controls: Vec<Control>,
    /// Errors of the time steps that are above the limit of their stage by themselves, and the largest load of the run.
    limits: Vec<f64>,
    coarse: Vec<time::Coarse>,
    heaviest: f64,
    /// Time of the last row, and whether it is the state right after a jump.
    last: Option<(f64, bool)>,
    touches: bool,
    /// Thickness of a body on a free domain, and its contacts.
    thickness: Option<f64>,
    widest: Widest,
}

impl Diagnostics {
    /// Checks everything that is known before the run.
    pub fn new(simulation: &Simulation, known: Known<'_>) -> Self {
        let Simulation { grid, gap, boundary, kernel, .. } = simulation;
        let free = *boundary == Boundary::Free;
        Diagnostics {
            known: before(simulation, known),
            free,
            confined: domain::confined(grid, gap),
            // Hertz's theory estimates the domain that a contact needs.
            radius: if free && kernel.is_half_space() { domain::radius(grid, gap) } else { None },
            border: None,
            needed: 0.0,
            rows: 0,
            deepest: 0.0,
            resolution: Resolution::default(),
            strain: Strain::new(simulation, radius(grid, known.parts)),
            slides: Slides::default(),
            watches: vec![
                Box::<adhesion::Border>::default(),
                Box::<fluid::Wet>::default(),
                Box::<tangential::Ring>::default(),
                Box::<wear::Steps>::default(),
                Box::<flash::Warm>::default(),
                Box::<flash::Rows>::default(),
                Box::<event::Waits>::default(),
            ],
            balance: Balance::default(),
            beyond: Beyond::default(),
            held: time::Held::default(),
            controls: simulation.loading.stages.iter().map(|stage| stage.control).collect(),
            limits: time::limits(simulation),
            coarse: vec![],
            heaviest: 0.0,
            last: None,
            touches: false,
            thickness: known.thickness.filter(|_| free),
            widest: Widest::default(),
            grid: *grid,
        }
    }

    /// The same for steady states of motion, whose rows have velocities in place of times.
    #[must_use]
    pub fn of_sweep(mut self, streaming: Streaming) -> Self {
        let cell = self.grid.longest_cell();
        self.strain.sweep(streaming, cell);
        self
    }

    /// Adds the rows that an earlier session of the run stored, with their friction where anything moves, and its findings.
    pub fn resume(&mut self, rows: &[Row], frictions: &[Friction], found: &[Finding]) {
        let grid = self.grid;
        for (index, row) in rows.iter().enumerate() {
            let control = self.controls.get(row.stage).copied().unwrap_or(Control::Load);
            self.take(index, row, Counted::of(&grid, row), control);
        }
        for (index, (row, friction)) in rows.iter().zip(frictions).enumerate() {
            self.slides.see(index, row.coordinate, friction);
        }
        if let Some(last) = rows.last() {
            self.watches.iter_mut().for_each(|watch| watch.recall(last));
        }
        // Findings that do not follow from rows alone; later rows are checked again.
        for finding in found {
            let Some([first, last]) = finding.rows.filter(|at| at[0] < rows.len()) else { continue };
            match finding.code.as_ref() {
                CONTACT_AT_BORDER => {
                    self.border = Some([first, last.min(rows.len() - 1)]);
                    self.needed = finding.limit.unwrap_or(0.0);
                }
                SPOTS_UNRESOLVED if grid.is_line() => {
                    let width = finding.value.unwrap_or(f64::INFINITY);
                    self.resolution.resume_line([first, last.min(rows.len() - 1)], width);
                }
                BEYOND_HISTOGRAM => self.beyond.resume(finding),
                ENERGY_BALANCE => self.balance.resume(finding),
                _ => self.watches.iter_mut().for_each(|watch| watch.resume(finding)),
            }
        }
    }

    /// Checks a row.
    pub fn see(&mut self, step: &Step<'_>, row: &Row) {
        let index = step.index();
        self.beyond.see(index, step);
        let (control, compliance) = (step.control(), step.simulation().compliance(row.coordinate.value()));
        // What is worn off is no strain.
        let worn = step.quantity(Quantity::WearDepthMax).map_or(0.0, |depth| depth[0]);
        let strained = Row { approach: row.approach - worn, ..*row };
        self.see_contact(index, &strained, step.contact_pressure(), control, compliance);
        if let Some(friction) = step.friction() {
            self.slides.see(index, row.coordinate, &friction);
        }
        self.watches.iter_mut().for_each(|watch| watch.see(step, row));
        if let Some(balance) = step.energy_balance() {
            self.balance.see(index, &balance);
        }
    }

    /// Checks a contact with this row and pressure \[Pa\], under this control, with a compliance \[1/Pa\].
    pub fn see_contact(
        &mut self,
        index: usize,
        row: &Row,
        pressure: ArrayView2<'_, f64>,
        control: Control,
        compliance: f64,
    ) {
        if self.free && row.contact_area > 0.0 && domain::touches_border(&self.grid, pressure) {
            extend(&mut self.border, index);
            let needed = ROOM
                * self.radius.map_or(0.0, |radius| match control {
                    Control::Approach => (radius * row.approach.max(0.0)).sqrt(),
                    Control::Load | Control::Pressure if self.grid.is_line() => {
                        (4.0 * radius * row.load * compliance / std::f64::consts::PI).sqrt()
                    }
                    Control::Load | Control::Pressure => (0.75 * radius * row.load * compliance).cbrt(),
                });
            self.needed = self.needed.max(needed);
        }
        let contact = match self.grid.is_line() {
            true => Counted::on_line(pressure),
            false => Counted::of(&self.grid, row),
        };
        self.take(index, row, contact, control);
    }

    fn take(&mut self, index: usize, row: &Row, contact: Counted, control: Control) {
        self.rows += 1;
        self.held.see(index, row, control == Control::Approach);
        self.deepest = self.deepest.max(row.approach);
        self.heaviest = self.heaviest.max(row.load.abs());
        self.touches |= row.contact_area > 0.0;
        let (time, load) = (row.coordinate.value(), row.load.abs());
        let is_at_once = self.last.is_none_or(|(before, _)| before == time);
        let after_jump =
            self.last.replace((time, is_at_once && load > 0.0)).is_some_and(|(_, jumped)| jumped);
        // A stage that was prescribed between two rows goes on with the steps of the run.
        let limit = self.limits.get(row.stage).or(self.limits.last()).copied().unwrap_or(f64::INFINITY);
        if let Some(error) = row.time_error.filter(|error| *error > limit) {
            self.coarse.push(time::Coarse { index, error, limit, load, after_jump });
        }
        self.resolution.see(index, contact);
        self.strain.see(index, row, contact);
        if let Some(thickness) = self.thickness {
            let radius = match self.grid.is_line() {
                true => 0.5 * row.contact_area,
                false => (row.contact_area / std::f64::consts::PI).sqrt(),
            };
            self.widest.see(index, radius, thickness);
        }
    }

    /// The findings before the run.
    pub fn known(&self) -> &[Finding] {
        &self.known
    }

    /// The findings so far, in the order of docs/findings.md: the domain, the surface, the contact, the material,
    /// the steps.
    pub fn findings(&self, simulation: &Simulation) -> Vec<Finding> {
        let mut found = self.known.clone();
        if let Some([first, last]) = self.border {
            let needed = (self.needed > 0.0).then_some(self.needed);
            let words = format!("In {} the contact", super::words::rows([first, last]));
            found.push(domain::at_border(&self.grid, self.confined, needed, &words).at([first, last]));
        }
        // The first row alone is the start of a ramp.
        if self.rows > 1 && !self.touches {
            found.push(never());
        }
        found.extend(self.resolution.findings());
        found.extend(self.beyond.findings());
        found.extend(self.strain.findings());
        let lacks = |found: &[Finding], code: &str| found.iter().all(|finding| finding.code != code);
        if lacks(&found, LARGE_STRAIN) {
            found.extend(simulation.kernel.depth().and_then(|depth| strain::compressed(self.deepest, depth)));
        }
        if lacks(&found, LARGE_SLOPE) {
            found.extend(surface::near(&self.grid, &simulation.gap, self.deepest));
        }
        if let Some(coarse) = time::coarse(simulation, &self.coarse, self.heaviest) {
            // What was expected before the run is known now.
            found.retain(|finding| finding.code != STEPS_TOO_LONG);
            found.push(coarse);
        } else if !found.iter().any(|finding| finding.code == STEPS_TOO_LONG && finding.is_warning()) {
            found.extend(self.held.finding(simulation));
        }
        found.extend(self.thickness.and_then(|thickness| self.widest.finding(thickness)));
        found.extend(self.slides.finding());
        found.extend(self.watches.iter().flat_map(|watch| watch.findings(simulation)));
        found.extend(self.balance.finding());
        found
    }
}

/// Whether a single part confines the contact within the border.
fn is_round(part: &Part) -> bool {
    match part {
        Part::Shape { shape: Shape::Sphere { radius }, .. } => radius.is_finite(),
        Part::Shape { shape: Shape::Ellipsoid { radius_x, radius_y }, .. } => {
            radius_x.is_finite() && radius_y.is_finite()
        }
        Part::Shape { shape: Shape::Cone { .. }, .. } => true,
        _ => false,
    }
}

fn before(simulation: &Simulation, known: Known<'_>) -> Vec<Finding> {
    let Simulation { grid, gap, boundary, .. } = simulation;
    let mut found = match boundary {
        // The shape of a round body confines the contact, also on a long track.
        Boundary::Free if known.parts.iter().any(is_round) => None,
        Boundary::Free => domain::unconfined(grid, gap),
        Boundary::Periodic => domain::not_periodic(grid, gap, known.mirrored),
    }
    .into_iter()
    .collect::<Vec<_>>();
    if *boundary == Boundary::Periodic {
        found.extend(known.thickness.and_then(|thickness| thin::long_waves(grid, thickness)));
    }
    if known.mirrored {
        found.extend(surface::lay_mirrored(grid, gap));
    }
    found.extend(domain::unlikely_size(grid));
    for part in known.parts {
        found.extend(surface::of_part(grid, part));
    }
    found.extend(surface::of_gap(grid, gap, known.parts.is_empty()));
    found.extend(surface::of_given_height(grid, gap, known.parts));
    let bodies = known.bodies.iter().filter_map(|body| {
        let relaxation = body.material.relaxation().ok()?;
        let name = format!("{} of {}", body.material.measure().name(), body.name);
        let instantaneous = relaxation.instantaneous();
        let modulus = if instantaneous.is_finite() { instantaneous } else { relaxation.equilibrium };
        material::unlikely_modulus(&name, modulus)
    });
    found.extend(bodies);
    if known.bodies.is_empty() {
        found.extend(material::of_pair(simulation));
    }
    found.extend(plausible::unlikely_end(simulation));
    found.extend(time::of(simulation));
    found.extend(adhesion::before(simulation));
    found.extend(fluid::before(simulation));
    found.extend(tangential::before(simulation));
    found.extend(wear::before(simulation));
    found.extend(wear::unlikely(simulation));
    found.extend(flash::unlikely(simulation));
    found.extend(flash::both_uneven(simulation));
    found
}
