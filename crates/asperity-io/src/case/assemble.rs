//! From the sections to the case: the order of the conversions, and the checks that need several sections.

use std::path::{Path, PathBuf};

use asperity::kernel::Kernel;
use asperity::load::Course;
use asperity::time::Plan;
use asperity::{Boundary, Grid, Scheme, TimeGrid};

use super::body::{self, Body};
use super::document::Document;
use super::error::CaseError;
use super::hardness::{self, Hardness};
use super::material::Sample;
use super::output::Conditions;
use super::pair::{self, Pair};
use super::place::Checks;
use super::plan::{Motion, Output, Rows, Surface};
use super::temperature::{Temperature, Temperatures};
use super::text::Text;
use super::warmth;
use super::{Case, motion, time};

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
    match document.convert(&checks, text.source, output) {
        Some(case) if !checks.any() => Ok(case),
        _ => Err(checks.into_errors()),
    }
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
    let samples: Vec<Option<Sample>> =
        parts.iter().map(|part| part.material.sample(&part.at.key("material"))).collect();
    let temperatures = temperatures(&checks, temperature, &samples);
    let points = temperatures.iter().flatten().map(|read| read.points.as_slice()).next();
    let instants = |_: &[f64]| plan.clone();
    let course = warmth::Course { end: None, plan: &instants, temperatures: points, beyond: 1.0 };
    let pair = pair::pair(&checks.at("body"), bodies, &parts, &samples, &course);
    match pair {
        Some(pair) if !checks.any() => Ok(pair),
        _ => Err({
            drop((parts, samples));
            checks.into_errors()
        }),
    }
}

/// The temperatures of the run.
fn temperatures(
    checks: &Checks<'_>,
    temperature: Option<&Temperature>,
    samples: &[Option<Sample>],
) -> Optional<Temperatures> {
    optional(temperature, |temperature| {
        let depends = |sample: &Sample| sample.shift.is_some() && sample.temperature.is_none();
        let matters = samples.iter().any(|sample| sample.as_ref().is_none_or(depends));
        temperature.temperatures(&checks.at("temperature"), matters)
    })
}

/// A section that may be left out: where it has a fault, `Err`.
type Optional<T> = Result<Option<T>, ()>;

/// What is `given`, converted.
fn optional<S, T>(given: Option<&S>, convert: impl FnOnce(&S) -> Option<T>) -> Optional<T> {
    given.map(|section| convert(section).ok_or(())).transpose()
}

impl Document {
    fn convert(&self, checks: &Checks<'_>, source: &str, default_path: PathBuf) -> Option<Case> {
        let at = |section: &str| checks.at(section);
        if let Some(letters) = self.title.as_ref().map(|title| title.chars().count()).filter(|n| *n > TITLE) {
            let message = format!("the title has {letters} letters, but may have {TITLE}");
            at("title").fault::<()>(message, &format!("{TITLE} letters at most"), "");
        }
        // Where something is wrong, all the rest is looked at too.
        let (grid, line, surfaces) = self.gap(checks);
        let boundary = self.domain.boundary;
        let parts = body::parts(&at("body"), &self.body);
        let samples: Vec<Option<Sample>> =
            parts.iter().map(|part| part.material.sample(&part.at.key("material"))).collect();
        let temperatures = temperatures(checks, self.temperature.as_ref(), &samples);
        let points = temperatures.iter().flatten().map(|read| read.points.as_slice()).next();
        let first_step = |end: f64, course: Option<&Course>| {
            let shortest = samples.iter().flatten().map(|sample| sample.shortest(points, end));
            time::first_step(shortest.fold(f64::INFINITY, f64::min), course)
        };
        let prescription = self.load.prescription(&at("load"), line, &first_step);
        let programme = prescription.as_ref().map(|prescription| &prescription.programme);
        if self.motion.is_none() {
            motion::nothing_moves(&at("surface"), &self.surface);
        }
        let motion = self.motion.as_ref().and_then(|motion| motion.moving(&at("motion"), &self.surface));
        let swept = motion.as_ref().and_then(Motion::swept);
        let times = match (&motion, &grid, &self.time) {
            (Some(motion), Some(grid), _) if swept.is_some() => motion.times(grid),
            (.., Some(times)) => {
                let course =
                    programme.and_then(|programme| programme.stages.first()).map(|stage| &stage.course);
                times.grid(&at("time"), self.load.has_own_steps(), |end| first_step(end, course))
            }
            (.., None) => None,
        };
        if swept.is_some() {
            self.steady(checks);
        }
        let stops = motion.as_ref().zip(grid.as_ref()).zip(times.as_ref());
        let stops = stops.and_then(|((motion, grid), times)| motion.stops(&at("motion"), grid, times.end()));
        let output = self.output.output(&at("output"), times.as_ref(), programme, default_path);
        let known = swept.or(stops.as_ref().map(Vec::len));
        let output = output.map(|output| match known.filter(|_| self.output.is_silent_on_rows()) {
            Some(count) => Output { rows: Rows::Every((count / 10).max(1)), ..output },
            None => output,
        });
        let stages = programme.iter().flat_map(|programme| &programme.stages);
        let grids = times.iter().chain(stages.filter_map(|stage| stage.times.as_ref()));
        let adaptive = grids.into_iter().any(TimeGrid::is_adaptive);
        let layered = self.body.iter().any(|body| !body.layer.is_empty());
        let include = match output.as_ref().map(|output| &output.rows) {
            // States between adaptive steps are interpolated; other steps end there, and those of layers.
            Some(Rows::At(times)) if !adaptive || layered || motion.is_some() => times.clone(),
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
        let pair = match &temperatures {
            Ok(_) => pair::pair(&at("body"), &self.body, &parts, &samples, &course),
            Err(()) => None,
        };
        let pair = pair.map(|mut pair| {
            if let (Some(section), Some(motion)) = (&self.motion, &motion) {
                let end = times.as_ref().map_or(f64::INFINITY, TimeGrid::end);
                section.met(&at("motion"), motion, &self.body, &mut pair, end);
                if let Some(grid) = &grid {
                    let found = motion.findings(&self.surface, grid, boundary, &pair);
                    pair.findings.extend(found);
                }
            }
            pair
        });
        if let (Some(times), Some(prescription), Some(pair)) = (&times, &prescription, &pair) {
            prescription.possible(times, grid.as_ref(), pair);
        }
        let scheme = self.time.as_ref().map(|times| times.scheme).unwrap_or_default();
        if adaptive && scheme != Scheme::Linear {
            at("time").fault::<()>(
                "adaptive steps need the scheme \"linear\", because their error estimate is derived for it",
                "scheme = \"linear\"",
                "omit `scheme`, or use spacing = \"log\" with `steps`",
            );
        }
        if let Some(pair) = &pair {
            let mapped = hardness.as_ref().is_some_and(|hardness| hardness.map.is_some());
            self.possible(checks, grid.as_ref(), pair, scheme, mapped || pair.hardness.is_finite());
        }
        let fields = match (scheme, &pair) {
            (_, None) => 0,
            (Scheme::Direct, Some(pair)) => pair.plan.instants.len(),
            (_, Some(pair)) => pair.branches(),
        };
        let extra = self.output.extra_fields(self.solver.plasticity);
        self.domain.fits(&at("domain"), grid.as_ref(), fields, extra, scheme);
        let end = times.as_ref().map(TimeGrid::end);
        let stress = self.stress.as_ref().zip(grid.as_ref().zip(pair.as_ref())).zip(output.as_ref().zip(end));
        let stress = stress.and_then(|((stress, (grid, pair)), (output, end))| {
            stress.of_case(&at("stress"), grid, pair, motion.is_some(), output, end)
        });
        let leakage =
            self.leakage.as_ref().zip(output.as_ref().zip(end)).and_then(|(leakage, (output, end))| {
                if line {
                    return at("leakage").fault(
                        "leakage needs a gap over a plane: on a line of cells nothing flows along y",
                        "a domain with two values in cells",
                        "delete the section, or give domain.cells and domain.size two values",
                    );
                }
                leakage.of_case(&at("leakage"), boundary, points, output, end)
            });

        let (hardness, prescription, pair, times) = (hardness?, prescription?, pair?, times?);
        let mut files: Vec<_> = samples.iter().flatten().filter_map(Sample::file).collect();
        files.extend(temperatures.iter().flatten().filter_map(|read| read.file.clone()));
        files.extend(hardness.files);
        files.extend(prescription.files);
        let usual = pair.plan.instants.len() + if adaptive { time::USUAL_STEPS } else { 0 };
        Some(Case {
            title: self.title.clone(),
            name: String::new(),
            source: source.to_owned(),
            grid: grid?,
            boundary,
            surfaces: surfaces?,
            bodies: pair.bodies,
            layers: pair.layers,
            waves: pair.waves,
            thickness: body::thickness(&self.body),
            creep: pair.creep,
            thermal: pair.thermal,
            temperatures: points.map(<[_]>::to_vec),
            materials: pair.reports,
            findings: pair.findings,
            files,
            hardness: pair.hardness,
            hardness_map: hardness.map,
            loading: prescription.programme,
            times,
            include,
            scheme,
            plasticity: self.solver.plasticity,
            solver: self.solver.options(),
            output: output?,
            stress,
            leakage,
            motion,
            usual_rows: swept.unwrap_or(usual),
            rows: swept.or(pair.plan.exact.then_some(pair.plan.instants.len())),
            history: prescription.at.key,
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
            None => surface.part(&place(n), grid.as_ref(), line).map(Surface::Part),
        };
        let parts: Vec<_> = self.surface.iter().zip(&measured).enumerate().map(part).collect();
        let parts = parts.into_iter().collect();
        (grid, line, parts)
    }

    /// Refuses what steady states of motion do not have.
    fn steady(&self, checks: &Checks<'_>) {
        let refuse = |given: bool, key: &str, message: &str, expected: &str, help: &str| {
            if given {
                checks.at(key).fault::<()>(message, expected, help);
            }
        };
        refuse(
            self.time.is_some(),
            "time",
            "steady states of motion have no times, but the case has a [time]",
            "[motion.steady] or [time]",
            "leave [time] out",
        );
        for (key, given) in [("stress", self.stress.is_some()), ("leakage", self.leakage.is_some())] {
            let message = format!("[{key}] is not computed of steady states of motion");
            refuse(given, key, &message, "a motion in time", "leave the section out");
        }
        refuse(
            self.output.times.is_some(),
            "output.times",
            "steady states of motion have no times",
            "`every`",
            "store the fields of every n-th velocity",
        );
    }

    /// The hardness of the cells over all bodies that give it.
    fn hardness(&self, checks: &Checks<'_>, grid: Option<&Grid>) -> Option<Hardness> {
        let of_body = |(n, body): (usize, &Body)| {
            let place = |key: &str| checks.at("body").item(n).key(key);
            let file = body.hardness_file.as_ref().map(|file| {
                file.of_cells(&place("hardness_file"), grid).map(|(map, file)| (map, Some(file)))
            });
            let array = body
                .hardness_array
                .as_ref()
                .map(|name| hardness::of_array(&place("hardness_array"), name, grid).map(|map| (map, None)));
            [file, array]
        };
        let all: Vec<_> = self.body.iter().enumerate().flat_map(of_body).flatten().collect();
        let add = |hardness: Hardness, found: Option<_>| found.map(|(map, file)| hardness.and(map, file));
        all.into_iter().try_fold(Hardness::default(), add)
    }

    /// Refuses what is asked for and not solved for this pair; `capped` where there is a hardness.
    fn possible(&self, checks: &Checks<'_>, grid: Option<&Grid>, pair: &Pair, scheme: Scheme, capped: bool) {
        let deep = pair.layers.as_ref().is_none_or(|layers| layers.depth().is_none());
        let free = self.domain.boundary == Boundary::Free;
        let conditions = Conditions {
            scheme,
            up_to_a_constant: free && deep && grid.is_some_and(Grid::is_line),
            waves: pair.waves.is_some(),
            moves: self.motion.is_some(),
        };
        let plasticity = self.solver.plasticity;
        self.solver.possible(&checks.at("solver"), capped);
        self.output.possible(&checks.at("output"), plasticity, &conditions, capped);
        if pair.waves.is_some() {
            let fault = |section: &str, what: &str, expected: &str| {
                let message = format!("{what}: this is not solved for layers that creep differently");
                let help = "omit it, or give all layers and bodies the same relative creep";
                checks.at(section).fault::<()>(message, expected, help);
            };
            if scheme != Scheme::Linear {
                fault("time", "the scheme is not \"linear\"", "scheme = \"linear\"");
            }
            if self.motion.is_some() {
                fault("motion", "the contact moves", "a contact that stays in its place");
            }
        }
        if let Some(grid) = grid {
            pair.resolved(&checks.at("body"), &self.body, grid, self.domain.boundary);
        }
    }
}
