//! From the sections to the case: the order of the conversions, and the checks that need several sections.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::finding;
use asperity::flash::Flash;
use asperity::load::Course;
use asperity::simulation::Plasticity;
use asperity::sliding::ShearStress;
use asperity::tangential::Tangential;
use asperity::time::Plan;
use asperity::traction::{OpeningPressure, TractionLaw};
use asperity::wear::Wear;
use asperity::{Boundary, Grid, Programme, Scheme, Simulation, TimeGrid};
use ndarray::Array2;

use super::body::{self, Body};
use super::document::Document;
use super::error::CaseError;
use super::hardness;
use super::history::Bodies;
use super::material::Sample;
use super::motion::MotionKind;
use super::output::Usual;
use super::pair::{self, Pair};
use super::place::{Checks, Place};
use super::plan::{Motion, Rows, Surface};
use super::temperature::Temperature;
use super::text::Text;
use super::{Case, flash, motion, shear, time, warmth};
use crate::Code;
use crate::leakage::Leak;
use crate::store::FieldKind;

/// Most letters of a title.
const TITLE: usize = 1000;

/// The case that a document describes, or the faults found.
///
/// `dir` is where its relative paths begin, `output` the result's path where it names none.
pub fn case(
    text: &Text<'_>,
    document: &Document,
    dir: &Path,
    output: PathBuf,
) -> Result<Case, Vec<CaseError>> {
    let checks = Checks::new(text, dir);
    checks.finish(document.convert(&checks, text.source, output))
}

/// Bodies that stand alone, in a run of these instants.
pub fn bodies(
    text: &Text<'_>,
    bodies: &[Body],
    temperature: Option<&Temperature>,
    plan: &Plan,
) -> Result<Pair, Vec<CaseError>> {
    let checks = Checks::new(text, Path::new(""));
    let parts = body::parts(&checks.at("body"), bodies);
    let temperatures = temperatures(&checks, temperature, &parts);
    let points = temperatures.as_ref().and_then(Option::as_deref);
    let instants = |_: &[f64]| plan.clone();
    let course = warmth::Course { end: None, plan: &instants, temperatures: points, beyond: 1.0 };
    checks.finish(pair::pair(&checks.at("body"), bodies, &parts, &course))
}

/// The temperatures of the run as (time [s], temperature [K]); the inner `None` where the case gives none.
fn temperatures(
    checks: &Checks<'_>,
    temperature: Option<&Temperature>,
    parts: &[body::Part<'_>],
) -> Option<Option<Vec<(f64, f64)>>> {
    let Some(temperature) = temperature else { return Some(None) };
    let depends = |sample: &&Sample| sample.shift.is_some() && sample.temperature.is_none();
    // A material that is wrong may depend on it.
    let unknown = parts.iter().any(|part| part.sample.is_none());
    let shifts: Vec<_> = parts
        .iter()
        .filter_map(|part| Some((part.name.as_str(), part.sample.as_ref().filter(depends)?.shift.as_ref()?)))
        .collect();
    temperature.temperatures(&checks.at("temperature"), &shifts, unknown).map(Some)
}

impl Document {
    fn convert(&self, checks: &Checks<'_>, source: &str, default_path: PathBuf) -> Option<Case> {
        let at = |section: &str| checks.at(section);
        if let Some(letters) = self.title.as_ref().map(|title| title.chars().count()).filter(|n| *n > TITLE) {
            let message = format!("the title has {letters} letters, but may have {TITLE}");
            at("title").refuse::<()>(Code::OutOfRange, message, &format!("{TITLE} letters at most"), "");
        }
        // Where something is wrong, all the rest is looked at too.
        let (grid, line, surfaces) = self.gap(checks);
        let boundary = self.domain.boundary;
        let parts = body::parts(&at("body"), &self.body);
        let temperatures = temperatures(checks, self.temperature.as_ref(), &parts);
        let samples = || parts.iter().filter_map(|part| part.sample.as_ref());
        let points = temperatures.as_ref().and_then(Option::as_deref);
        let first_step = |end: f64, course: Option<&Course>| {
            let shortest = samples().map(|sample| sample.shortest(points, end));
            time::first_step(shortest.fold(f64::INFINITY, f64::min), course)
        };
        let adhesion = self.adhesion.as_ref().map(|adhesion| adhesion.law(&at("adhesion")));
        let bodies = Bodies { line, adhere: adhesion.is_some() };
        let loading = self.load.programme(&at("load"), bodies, &first_step);
        let programme = loading.as_ref();
        if self.motion.is_none() {
            motion::nothing_moves(&at("surface"), &self.surface);
        }
        let motion = self.motion.as_ref().and_then(|motion| motion.moving(&at("motion"), &self.surface));
        let motion = motion.and_then(|motion| warmed(checks, motion, &parts, points));
        let acts = self.leakage.as_ref().is_some_and(|leakage| leakage.acts());
        let flows = self.leakage.as_ref().is_some_and(|leakage| leakage.flows_with_the_contact());
        if self.motion.is_some() && flows {
            let help = "set leakage.coupling = \"one-way\" or \"uniform\", or delete [motion]";
            let message = "the flow that a sliding surface drags along is not solved";
            at("motion").fault::<()>(message, "no fluid whose flow acts on the surfaces", help);
        }
        let swept = motion.as_ref().and_then(Motion::swept);
        let times = match (&motion, &grid, &self.time) {
            (Some(motion), Some(grid), _) if swept.is_some() => motion.times(&at("motion"), grid),
            (.., Some(times)) => {
                let first = programme.and_then(|programme| programme.stages.first());
                let first_step = |end| first_step(end, first.map(|stage| &stage.course));
                times.grid(&at("time"), self.load.has_own_steps(), first_step)
            }
            (.., None) => None,
        };
        if swept.is_some() {
            let why = "belongs to a motion in time, but the case asks for steady states";
            checks.root().without(&["time"], why, "[motion.steady] alone", "leave the section out");
            let help = "store the fields of every n-th velocity by `every`";
            at("output").without(&["times"], why, "`every`", help);
            let help = "leave it out: all stored velocities are computed";
            at("stress").without(&["times"], why, "none", help);
            at("leakage").without(&["times"], why, "none", help);
        }
        let stops = motion.as_ref().zip(grid.as_ref()).zip(times.as_ref());
        let stops = stops.and_then(|((motion, grid), times)| motion.stops(&at("motion"), grid, times.end()));
        let usual = Usual {
            path: default_path,
            fields: self.usual_fields(acts),
            count: swept.or(stops.as_ref().map(Vec::len)),
        };
        let mut output = self.output.output(&at("output"), times.as_ref(), programme, usual);
        let stages = programme.iter().flat_map(|programme| &programme.stages);
        let mut grids = times.iter().chain(stages.filter_map(|stage| stage.times.as_ref()));
        let adaptive = grids.any(TimeGrid::is_adaptive);
        let include = match output.as_ref().map(|output| &output.rows) {
            // Steps end there.
            Some(Rows::At(times)) => times.clone(),
            _ => Vec::new(),
        };
        let plan = |breaks: &[f64]| match (&times, programme) {
            (Some(times), Some(programme)) => {
                let stops = stops.as_deref().unwrap_or_default();
                programme.plan(times, &[include.as_slice(), stops, breaks].concat())
            }
            _ => Plan { instants: Vec::new(), exact: true },
        };
        let course = warmth::Course {
            end: times.as_ref().map(TimeGrid::end),
            plan: &plan,
            temperatures: points,
            beyond: if swept.is_some() { 1e3 } else { 1.0 },
        };
        let hardness = self.hardness(checks, grid.as_ref());
        let mut pair =
            temperatures.as_ref().and_then(|_| pair::pair(&at("body"), &self.body, &parts, &course));
        if let (Some(section), Some(motion), Some(pair)) = (&self.motion, &motion, &mut pair) {
            let end = times.as_ref().map_or(f64::INFINITY, TimeGrid::end);
            section.met(&at("motion"), motion, &self.body, pair, end);
            if let Some(grid) = &grid {
                let found = {
                    // The heat of friction has a friction of its own, dents that stay are ploughed.
                    let rubs = self.flash.is_some() || self.solver.plasticity == Plasticity::Accumulate;
                    motion.findings(&self.surface, grid, boundary, pair, rubs)
                };
                pair.findings.extend(found);
            }
        }
        let end = times.as_ref().map(TimeGrid::end);
        let leakage = self.leakage.as_ref().zip(output.as_ref().zip(end));
        let leakage = leakage.and_then(|(leakage, (output, end))| match line {
            true => at("leakage").fault(
                "leakage needs a gap over a plane: on a line of cells nothing flows along y",
                "a domain with two values in cells",
                "delete the section, or give domain.cells and domain.size two values",
            ),
            false => leakage.of_case(&at("leakage"), boundary, points, output, end),
        });
        if let (Some(motion), Some(_)) = (&motion, &leakage) {
            self.leaks_in_motion(&at("leakage"), motion, boundary, &mut pair);
        }
        let fluid = leakage.as_ref().and_then(|leak| at("leakage").core(leak.traction())).flatten();
        if fluid.is_some() && (self.adhesion.is_some() || self.seal.is_some()) {
            let help = "set coupling = \"one-way\", or delete the other section";
            let why = match self.seal.is_some() {
                true => "the patch of a [seal] is computed one-way: the seal adds the pressure of the fluid",
                false => "a fluid does not act on surfaces that adhere here",
            };
            at("leakage").key("coupling").fault::<()>(why, "\"one-way\"", help);
        }
        let fluid = fluid.map(|fluid| Arc::new(fluid) as Arc<dyn TractionLaw>);
        let law = match adhesion {
            None => Some(fluid),
            Some(adhesion) => adhesion.map(|law| Some(Arc::new(law) as Arc<dyn TractionLaw>)),
        };
        let tangential = self.tangential(checks, grid.as_ref(), pair.as_ref());
        let wear = self.wear(checks, grid.as_ref(), swept.is_some());
        let flash = self.flash(checks, motion.as_ref(), &parts, pair.as_ref(), points);
        let conditions =
            self.conditions(grid, pair.as_ref(), programme, times.as_ref(), hardness.as_ref(), include);
        let dents_move = match (&self.motion, &pair, &hardness) {
            (Some(motion), Some(pair), Some(map)) if self.solver.plasticity == Plasticity::Accumulate => {
                motion.dents_move(&at("motion"), &self.body, pair, map.as_ref())
            }
            _ => Some(false),
        };
        let conditions = law.zip(conditions).zip(dents_move).map(|((traction, conditions), dents_move)| {
            Simulation { dents_move, traction, tangential, wear, flash, ..conditions }
        });
        if let Some(conditions) = &conditions {
            for error in conditions.faults() {
                checks.root().core::<()>(Err(error));
            }
            if self.motion.is_none() {
                checks.root().core(conditions.awaited());
            }
            // A faulty fluid, or a faulty load along the surfaces, is reported already.
            let slips = self.tangential.is_some() || self.friction.is_some();
            let wears = conditions.wear.is_some() || self.wear.is_none();
            let wears = wears && (conditions.flash.is_some() || self.flash.is_none());
            if (leakage.is_some() || !acts) && (conditions.tangential.is_some() || !slips) && wears {
                self.output.possible(&at("output"), conditions, motion.is_some());
            }
        }
        if let (Some(conditions), Some(Leak { opening: true, .. })) = (&conditions, &leakage) {
            checks.root().core::<()>(OpeningPressure::check(conditions));
        }
        if let (Some(pair), Some(grid)) = (&pair, &grid) {
            pair.resolved(&at("body"), &self.body, grid, boundary);
        }
        let stress = self.stress.as_ref().zip(grid.as_ref().zip(pair.as_ref())).zip(output.as_mut().zip(end));
        let stress = stress.and_then(|((stress, (grid, pair)), (output, end))| {
            let kinds = [motion.is_some(), self.tangential.is_some()];
            stress.of_case(&at("stress"), grid, pair, kinds, output, end)
        });
        let seal = match &self.seal {
            // A faulty [leakage] is reported already.
            Some(seal) if self.leakage.is_none() || leakage.is_some() => {
                Some(seal.plan(&at("seal"), &self.load, &self.surface, leakage.as_ref())?)
            }
            _ => None,
        };
        let pair = pair?;
        let usual = pair.plan.instants.len() + if adaptive { time::USUAL_STEPS } else { 0 };
        let mut case = Case {
            title: self.title.clone(),
            name: String::new(),
            source: source.to_owned(),
            conditions: conditions?,
            surfaces: surfaces?,
            bodies: pair.bodies,
            layers: pair.layers,
            thickness: body::thickness(&self.body),
            temperatures: points.map(<[_]>::to_vec),
            materials: pair.reports,
            findings: pair.findings,
            files: checks.files(),
            output: output?,
            stress,
            leakage,
            seal,
            motion,
            usual_rows: swept.unwrap_or(usual),
            rows: swept.or(pair.plan.exact.then_some(pair.plan.instants.len())),
        };
        if case.leakage.is_some() {
            case.read_surfaces();
            let windowed = case.windowed();
            case.findings.extend(finding::window_in_leak(&windowed));
            if let Some(seal) = &mut case.seal {
                seal.windowed = windowed;
            }
        }
        let or = match case.conditions.scheme {
            Scheme::Direct => {
                " or steps, or scheme = \"linear\": the direct scheme keeps all pressure fields"
            }
            Scheme::Linear | Scheme::Constant => "",
        };
        self.domain.fits(&at("domain"), case.conditions.grid.cells(), case.memory_of_run(), or)?;
        Some(case)
    }

    /// What is wrong or uncertain of a leak through a contact that moves.
    fn leaks_in_motion(&self, at: &Place<'_>, motion: &Motion, boundary: Boundary, pair: &mut Option<Pair>) {
        const WHY: &str = "the flow that a moving surface drags along is not solved";
        if self.leakage.as_ref().is_some_and(|leakage| leakage.opening == Some(true)) {
            at.key("opening").fault::<()>(
                WHY,
                "a contact that does not move",
                "leave opening or [motion] out",
            );
        }
        if boundary == Boundary::Free && motion.moves.contains(&true) {
            let message = "the gap of a free domain in motion is not known beyond the ends of its track, so its leak is not either";
            at.fault::<()>(
                message,
                "boundary = \"periodic\"",
                "take a periodic domain, or delete one of the two sections",
            );
        }
        pair.iter_mut().for_each(|pair| pair.findings.push(finding::leak_in_motion()));
    }

    /// The fields that are stored where the case names none; `acts` tells whether a fluid acts on the surfaces.
    fn usual_fields(&self, acts: bool) -> Vec<FieldKind> {
        use FieldKind::{Contact, ContactPressure, FlashTemperature, Gap, Pressure, TractionX, TractionY};
        let mut fields = vec![Pressure, Gap];
        fields.extend(self.tangential.iter().flat_map(|_| [Contact, TractionX, TractionY]));
        fields.extend(self.flash.as_ref().map(|_| FlashTemperature));
        fields.extend((self.adhesion.is_some() || acts).then_some(ContactPressure));
        fields
    }

    /// The load along the surfaces.
    fn tangential(
        &self,
        checks: &Checks<'_>,
        grid: Option<&Grid>,
        pair: Option<&Pair>,
    ) -> Option<Arc<Tangential>> {
        let at = |section: &str| checks.at(section);
        let (friction, tangential) = match (&self.friction, &self.tangential) {
            (Some(friction), Some(tangential)) => (friction, tangential),
            (None, None) => return None,
            (Some(_), None) => {
                let help = "add [tangential], or delete [friction]";
                let message = "[friction] does nothing without [tangential]";
                return at("friction").fault(message, "both sections", help);
            }
            (None, Some(_)) => {
                let help = "add [friction], or delete [tangential]";
                let message = "nothing holds [tangential] without [friction]";
                return at("tangential").fault(message, "both sections", help);
            }
        };
        let others = [("motion", self.motion.is_some()), ("seal", self.seal.is_some())];
        for (section, _) in others.into_iter().filter(|(_, given)| *given) {
            let message = format!("a load along the surfaces is not solved together with [{section}]");
            at("tangential").fault::<()>(message, "one of the two sections", "delete one of them");
        }
        let bodies = (&at("body"), &pair?.bodies[..]);
        tangential.law(&at("tangential"), (&at("friction"), friction), grid, bodies).map(Arc::new)
    }

    /// The heat of friction.
    fn flash(
        &self,
        checks: &Checks<'_>,
        motion: Option<&Motion>,
        parts: &[body::Part<'_>],
        pair: Option<&Pair>,
        temperatures: Option<&[(f64, f64)]>,
    ) -> Option<Arc<Flash>> {
        let (section, at) = (self.flash.as_ref()?, checks.at("flash"));
        if self.motion.is_none() {
            let help = "add [motion] with a velocity, a path or steady states, or delete the section";
            let message = match self.tangential {
                Some(_) => "the heat of slip under a tangential load is not computed",
                None => "nothing slides, so nothing makes heat",
            };
            return at.fault(message, "a section [motion]", help);
        }
        section.law(&at, motion?, parts, pair?, temperatures).map(Arc::new)
    }

    /// The wear of the surfaces; `steady` where the case asks for steady states of motion.
    fn wear(&self, checks: &Checks<'_>, grid: Option<&Grid>, steady: bool) -> Option<Arc<Wear>> {
        let (wear, at) = (self.wear.as_ref()?, checks.at("wear"));
        let refuse = |message: &str, expected: &str, help: &str| at.fault::<()>(message, expected, help);
        if steady {
            let help = "give [motion] a velocity and the case a [time], or wear the contact in its own frame by [wear] velocity";
            refuse("a steady state does not wear: its surfaces stay as they are", "a motion in time", help);
        } else if self.motion.as_ref().is_some_and(|motion| motion.kind == MotionKind::Roll) {
            refuse("surfaces that roll do not slide, so they do not wear here", "kind = \"slide\"", "");
        } else if self.seal.is_some() {
            let message = "a [seal] is computed from patches that do not wear";
            refuse(message, "one of the two sections", "delete one of them");
        }
        let slides = [("motion", self.motion.is_some()), ("tangential", self.tangential.is_some())];
        let slides = slides.into_iter().find(|(_, given)| *given).map(|(section, _)| section);
        wear.law(&at, grid, slides).map(Arc::new)
    }

    /// The simulation as far as the sections give it: without gap and motion.
    fn conditions(
        &self,
        grid: Option<Grid>,
        pair: Option<&Pair>,
        programme: Option<&Programme>,
        times: Option<&TimeGrid>,
        hardness: Option<&Option<Array2<f64>>>,
        include: Vec<f64>,
    ) -> Option<Simulation> {
        let pair = pair?;
        Some(Simulation {
            boundary: self.domain.boundary,
            kernel: pair.kernel(),
            layers: pair.waves.clone(),
            creep: pair.creep.clone(),
            thermal: pair.thermal.clone(),
            hardness: pair.hardness,
            hardness_map: hardness?.clone(),
            plasticity: self.solver.plasticity,
            loading: programme?.clone(),
            times: times?.clone(),
            include,
            scheme: self.time.as_ref().map(|times| times.scheme).unwrap_or_default(),
            solver: self.solver.options(),
            quantities: self.output.quantities(),
            ..Simulation::new(grid?, Array2::default((0, 0)))
        })
    }

    /// The grid, whether it is a line, and the parts of the gap.
    fn gap(&self, checks: &Checks<'_>) -> (Option<Grid>, bool, Option<Vec<Surface>>) {
        let place = |n: usize| checks.at("surface").item(n);
        let measured: Vec<_> =
            self.surface.iter().enumerate().map(|(n, surface)| surface.measured(&place(n))).collect();
        let of_grid: Vec<_> = measured.iter().flatten().map(Option::as_ref).collect();
        let grid = self.domain.grid(&checks.at("domain"), &of_grid);
        let line = grid.as_ref().map(Grid::is_line).or(self.domain.is_line()).unwrap_or(false);
        let part = |(n, (surface, file)): (usize, (&super::surface::Surface, &Option<_>))| match file {
            Some(file) => Option::clone(file).map(Surface::File),
            None => surface.part(&place(n), grid.as_ref(), line).map(|part| match surface.history() {
                [] => Surface::Part(part),
                history => Surface::Given(part, history.to_vec()),
            }),
        };
        let parts: Vec<_> = self.surface.iter().zip(&measured).enumerate().map(part).collect();
        let parts = parts.into_iter().collect();
        (grid, line, parts)
    }

    /// The hardness of the cells over all bodies that give it; the inner `None` where none does.
    fn hardness(&self, checks: &Checks<'_>, grid: Option<&Grid>) -> Option<Option<Array2<f64>>> {
        let of_body = |(n, body): (usize, &Body)| {
            let place = |key: &str| checks.at("body").item(n).key(key);
            let file = body.hardness_file.as_ref().map(|file| file.of_cells(&place("hardness_file"), grid));
            let array = body.hardness_array.as_ref();
            [file, array.map(|name| hardness::of_array(&place("hardness_array"), name, grid))]
        };
        let all: Vec<_> = self.body.iter().enumerate().flat_map(of_body).flatten().collect();
        let maps = all.into_iter().collect::<Option<Vec<_>>>()?;
        Some(maps.into_iter().reduce(hardness::softer))
    }
}

/// The motion at the temperature of the run.
fn warmed(
    checks: &Checks<'_>,
    motion: Motion,
    parts: &[body::Part<'_>],
    temperatures: Option<&[(f64, f64)]>,
) -> Option<Motion> {
    let Some(law @ ShearStress::Gaussian { .. }) = motion.shear_stress else { return Some(motion) };
    let at = checks.at("motion").key("shear_stress");
    let law = shear::shifted(law, flash::shift_factor(&at, parts, temperatures)?);
    Some(Motion { shear_stress: Some(law), ..motion })
}
