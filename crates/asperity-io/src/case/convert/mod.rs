//! From what is written to what is solved: the checks that need more than one key, and the conversion into
//! the objects of the solver.

mod axes;
mod body;
mod curve;
pub(super) mod domain;
mod hardness;
mod history_file;
mod layer;
pub(super) mod leakage;
mod load;
mod material;
mod motion;
mod output;
pub(super) mod prepare;
mod sample;
mod stored_times;
pub(super) mod stress;
pub(super) mod surface;
mod temperature;
mod time;

use std::ops::Range;
use std::path::{Path, PathBuf};

use asperity::kernel::Kernel;
use asperity::load::Course;
use asperity::material::Material;
use asperity::surface::Part;
use asperity::time::Plan;
use asperity::{Boundary, Grid, Scheme, TimeGrid};

use super::error::CaseError;
use super::plan::{Output, Rows, Surface, Travel};
use super::quantity::QuantityError;
use super::raw::{self, At, Document};
use super::text::{MOST_ERRORS, Text};
use super::{Case, MaterialReport};
use crate::curve::{ShiftRequest, VerticalRequest};

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
    let mut checks = Checks { text, dir, errors: Vec::new() };
    if let Some(at) = &document.title {
        let letters = at.value.chars().count();
        if letters > TITLE {
            let message = format!("the title has {letters} letters, but may have {TITLE}");
            checks.fault(&at.span, message, &format!("{TITLE} letters at most"), None);
        }
    }
    let measured = surface::files(&mut checks, &document.surface);
    let of_grid: Vec<_> = measured.iter().flatten().map(Option::as_ref).collect();
    let grid = domain::grid(&mut checks, &document.domain, &of_grid);
    let line = grid.as_ref().map(Grid::is_line).or(domain::said(&document.domain)).unwrap_or(false);
    let surfaces = surface::surfaces(&mut checks, &document.surface, &measured, grid.as_ref(), line);
    let parts = layer::parts(&mut checks, &document.body);
    let samples: Vec<_> = parts.iter().map(|part| material::sample(&mut checks, part.material)).collect();
    let temperatures = temperature::temperatures(&mut checks, document.temperature.as_ref(), &samples);
    let points = temperatures.iter().flatten().map(|t| t.points.as_slice()).next();
    let first_step = |end: f64, course: Option<&Course>| {
        time::first_step(material::shortest(&samples, points, end), course)
    };
    let stages = document.load.value.stages.as_ref().map(|list| list.value.as_slice()).unwrap_or_default();
    let own = |stage: &At<raw::Stage>| {
        stage.value.steps.is_some() || stage.value.spacing.is_some() || stage.value.time.is_some()
    };
    let all_own = !stages.is_empty() && stages.iter().all(own);
    let prescription = load::prescription(&mut checks, &document.load, line, |checks, stage, course| {
        time::of_stage(checks, stage, |end| first_step(end, course))
    });
    let programme = prescription.as_ref().map(|prescription| &prescription.programme);
    let course = programme.and_then(|programme| programme.stages.first()).map(|stage| &stage.course);
    let motion = motion::motion(&mut checks, document.motion.as_ref(), &document.surface);
    let steady = motion.iter().flatten().any(|motion| matches!(motion.travel, Travel::Steady(_)));
    if steady && text.root.contains_key("time") {
        let message = "steady states of motion have no times, but the case has a [time]".to_owned();
        checks.fault(&document.time.span, message, "[motion.steady] or [time]", Some("leave [time] out"));
    }
    let times = match (motion.iter().flatten().next(), grid.as_ref()) {
        (Some(motion), Some(grid)) if steady => motion::times(motion, grid),
        _ => time::times(&mut checks, &document.time, all_own, |end| first_step(end, course)),
    };
    let output = output::output(&mut checks, &document.output, times.as_ref(), programme, output);
    if steady {
        let sections = [
            ("stress", document.stress.as_ref().map(|at| &at.span)),
            ("leakage", document.leakage.as_ref().map(|at| &at.span)),
        ];
        for (name, span) in sections {
            if let Some(span) = span {
                let message = format!("[{name}] is not computed of steady states of motion");
                checks.fault(span, message, "a motion in time", Some("leave the section out"));
            }
        }
        if let Some(at) = &document.output.times {
            let message = "steady states of motion have no times".to_owned();
            checks.fault(&at.span, message, "`every`", Some("store the fields of every n-th velocity"));
        }
    }
    let stops = motion.iter().flatten().next().zip(grid.as_ref()).and_then(|(motion, grid)| {
        let Travel::Path(path) = &motion.travel else { return None };
        let step = motion.cells_per_step * motion.direction.cell(grid);
        checks.core(&motion.span, path.crossings(step, times.as_ref()?.end()))
    });
    let swept = match motion.iter().flatten().next().map(|motion| &motion.travel) {
        Some(Travel::Steady(velocities)) => Some(velocities.len()),
        _ => None,
    };
    let known = swept.or(stops.as_ref().map(Vec::len));
    let output = output.map(|output| match (known, &document.output.every, &document.output.times) {
        (Some(count), None, None) => Output { rows: Rows::Every((count / 10).max(1)), ..output },
        _ => output,
    });
    let grids =
        programme.iter().flat_map(|programme| &programme.stages).filter_map(|stage| stage.times.as_ref());
    let adaptive = times.iter().chain(grids).any(TimeGrid::is_adaptive);
    let layered = document.body.iter().any(|body| !body.value.layer.is_empty());
    let include = match output.as_ref().map(|output| &output.rows) {
        // States between adaptive steps are interpolated; other steps end there, and those of layers.
        Some(Rows::At(times)) if !adaptive || layered || motion.iter().flatten().next().is_some() => {
            times.clone()
        }
        _ => Vec::new(),
    };
    let mut files: Vec<_> = samples.iter().flatten().filter_map(|sample| sample.file.clone()).collect();
    files.extend(temperatures.iter().flatten().filter_map(|t| t.file.clone()));
    let hardness = hardness::of_cells(&mut checks, &document.body, grid.as_ref());
    files.extend(hardness.iter().flat_map(|hardness| hardness.files.iter().cloned()));
    files.extend(prescription.iter().flat_map(|p| p.files.clone()));
    let plan = |breaks: &[f64]| match (&times, programme) {
        (Some(times), Some(programme)) => programme
            .plan(times, &[include.as_slice(), stops.as_deref().unwrap_or_default(), breaks].concat()),
        _ => Plan { instants: Vec::new(), exact: true },
    };
    let course = body::Course {
        end: times.as_ref().map(TimeGrid::end),
        plan: &plan,
        temperatures: points,
        beyond: if steady { 1e3 } else { 1.0 },
    };
    let mut pair = match temperatures {
        Some(_) => body::pair(&mut checks, &document.body, &parts, &samples, &course),
        None => None, // a fault
    };
    if let (Some(raw), Some(motion), Some(pair)) =
        (&document.motion, motion.iter().flatten().next(), &mut pair)
    {
        if let (Some(start), Some(times)) = (&raw.value.start, &times)
            && start.value.get() >= times.end()
        {
            let message = "the motion starts when the run is over".to_owned();
            checks.fault(&start.span, message, "a time before the end", None);
        }
        motion::of_pair(&mut checks, raw, motion, &document.body, pair);
        if let Some(grid) = &grid {
            let boundary = document.domain.value.boundary.unwrap_or_default();
            let found = motion::findings(motion, &document.surface, grid, boundary, pair);
            pair.findings.extend(found);
        }
    }
    if let (Some(times), Some(prescription), Some(pair)) = (&times, &prescription, &pair) {
        load::possible(&mut checks, prescription, times, grid.as_ref(), pair);
    }
    let of_motion = |at: &&At<raw::Quantities>| matches!(at.value, raw::Quantities::One(quantity) if quantity.is_of_motion());
    if let (None, Some(at)) = (&document.motion, document.output.quantities.iter().flatten().find(of_motion))
    {
        let message = "this quantity belongs to a contact in motion, but the case has no [motion]".to_owned();
        checks.fault(
            &at.span,
            message,
            "another quantity",
            Some("leave it out, or add [motion]: its rows have it"),
        );
    }
    let free = document.domain.value.boundary.unwrap_or_default() == Boundary::Free;
    if let (true, Some(grid), Some(pair)) = (free, &grid, &pair)
        && grid.is_line()
        && pair.layers.as_ref().is_none_or(|layers| layers.depth().is_none())
    {
        output::up_to_a_constant(&mut checks, &document.output);
    }
    let scheme = document.time.value.scheme.unwrap_or_default();
    if let Some(pair) = &pair {
        let capped =
            pair.hardness.is_finite() || hardness.as_ref().is_some_and(|hardness| hardness.map.is_some());
        output::possible(&mut checks, &document.solver, &document.output, scheme, capped);
    }
    if adaptive && scheme != Scheme::Linear {
        let message =
            "adaptive steps need the scheme \"linear\", because their error estimate is derived for it"
                .to_owned();
        let help = "omit `scheme`, or use spacing = \"log\" with `steps`";
        checks.fault(&document.time.span, message, "scheme = \"linear\"", Some(help));
    }
    if pair.as_ref().is_some_and(|pair| pair.waves.is_some()) {
        layer::unsolved(&mut checks, document, scheme);
    }
    let fields = match (scheme, &pair) {
        (_, None) => 0,
        (Scheme::Direct, Some(pair)) => pair.plan.instants.len(),
        (_, Some(pair)) => pair.branches(),
    };
    let extra = output::extra_fields(&document.solver, &document.output);
    domain::memory(&mut checks, &document.domain, grid.as_ref(), fields, extra, scheme);

    if let (Some(grid), Some(body::Pair { layers: Some(layers), waves, .. })) = (&grid, &pair) {
        layer::resolved(&mut checks, &document.body, &document.domain, grid, layers, waves.as_deref());
    }

    let stress = match (&document.stress, &grid, &pair, &output, &times) {
        (Some(at), _, Some(pair), ..) if pair.layers.is_some() => {
            let message = crate::stress::LAYERED.to_owned();
            checks.fault(&at.span, message, "bodies without layers", Some("delete the section"));
            None
        }
        (Some(at), Some(grid), Some(pair), Some(output), Some(times)) => {
            let moves = document.motion.is_some();
            stress::stress(&mut checks, at, grid, &stress::bodies(pair), moves, output, times.end())
        }
        _ => None,
    };
    let boundary = document.domain.value.boundary.unwrap_or_default();
    let leakage = match (&document.leakage, &output, &times) {
        (Some(at), ..) if line => {
            let message =
                "leakage needs a gap over a plane: on a line of cells nothing flows along y".to_owned();
            let help = "delete the section, or give domain.cells and domain.size two values";
            checks.fault(&at.span, message, "a domain with two values in cells", Some(help));
            None
        }
        (Some(at), Some(output), Some(times)) => {
            leakage::section(&mut checks, at, boundary, points, output, times.end())
        }
        _ => None,
    };

    checks.errors.sort_by_key(|error| error.span.as_ref().map_or(usize::MAX, |span| span.start));
    let surfaces = surfaces.zip(hardness);
    match (checks.errors.is_empty(), grid, surfaces, pair, prescription, times, output) {
        (
            true,
            Some(grid),
            Some((surfaces, hardness)),
            Some(pair),
            Some(prescription),
            Some(times),
            Some(output),
        ) => Ok(Case {
            title: document.title.as_ref().map(|title| title.value.clone()),
            name: String::new(),
            source: text.source.to_owned(),
            grid,
            boundary,
            surfaces,
            bodies: pair.bodies,
            layers: pair.layers,
            waves: pair.waves,
            thickness: layer::thickness(&document.body),
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
            plasticity: output::plasticity(&document.solver),
            solver: output::solver(&document.solver),
            output,
            stress,
            leakage,
            motion: motion.flatten(),
            usual_rows: swept
                .unwrap_or(pair.plan.instants.len() + if adaptive { time::USUAL_STEPS } else { 0 }),
            rows: swept.or(pair.plan.exact.then_some(pair.plan.instants.len())),
            history: prescription.span,
        }),
        _ => Err(checks.errors),
    }
}

/// Bodies that stand alone, in a run of these instants.
pub fn bodies(
    text: &Text<'_>,
    bodies: &[At<raw::Body>],
    temperature: Option<&At<raw::Temperature>>,
    plan: &Plan,
) -> Result<body::Pair, Vec<CaseError>> {
    let mut checks = Checks { text, dir: Path::new(""), errors: Vec::new() };
    let parts = layer::parts(&mut checks, bodies);
    let samples: Vec<_> = parts.iter().map(|part| material::sample(&mut checks, part.material)).collect();
    let temperatures = temperature::temperatures(&mut checks, temperature, &samples);
    let points = temperatures.iter().flatten().map(|t| t.points.as_slice()).next();
    let instants = |_: &[f64]| plan.clone();
    let course = body::Course { end: None, plan: &instants, temperatures: points, beyond: 1.0 };
    match body::pair(&mut checks, bodies, &parts, &samples, &course) {
        Some(pair) if checks.errors.is_empty() => Ok(pair),
        _ => Err(checks.errors),
    }
}

/// A part of the gap that stands alone, not one of a file, on its domain.
pub fn surface_alone(
    text: &Text<'_>,
    domain: &At<raw::Domain>,
    surfaces: &[At<raw::Surface>],
) -> Result<(Grid, Part), Vec<CaseError>> {
    let mut checks = Checks { text, dir: Path::new(""), errors: Vec::new() };
    let grid = domain::grid(&mut checks, domain, &[]);
    domain::memory(&mut checks, domain, grid.as_ref(), 0, 0, Scheme::Linear);
    let line = grid.as_ref().is_some_and(Grid::is_line);
    let parts = surface::surfaces(&mut checks, surfaces, &[None], grid.as_ref(), line);
    match (grid, parts.and_then(|mut parts| parts.pop()), checks.errors.is_empty()) {
        (Some(grid), Some(Surface::Part(part)), true) => Ok((grid, part)),
        _ => Err(checks.errors),
    }
}

/// A shift that stands alone, and how moduli depend on temperature.
pub fn shift(
    text: &Text<'_>,
    at: &At<raw::Shift>,
) -> Result<(ShiftRequest, VerticalRequest), Vec<CaseError>> {
    let mut checks = Checks { text, dir: Path::new(""), errors: Vec::new() };
    let made = temperature::shift(&mut checks, at);
    made.zip(temperature::vertical(&mut checks, Some(at), None)).ok_or(checks.errors)
}

/// A material that stands alone, at its own temperature or its reference, or the faults found. Fractional models
/// become Prony sums over `window` \[s\], or four decades on either side of their time.
pub fn material_alone(
    text: &Text<'_>,
    raw: &At<raw::Material>,
    dir: &Path,
    window: Option<[f64; 2]>,
) -> Result<(Material, MaterialReport), Vec<CaseError>> {
    let mut checks = Checks { text, dir, errors: Vec::new() };
    let made =
        material::sample(&mut checks, raw).and_then(|sample| body::alone(&mut checks, raw, &sample, window));
    match made {
        Some(made) if checks.errors.is_empty() => Ok(made),
        _ => Err(checks.errors),
    }
}

/// The faults found so far, and the means to word the next one.
pub(super) struct Checks<'c, 't> {
    pub(super) text: &'c Text<'t>,
    pub(super) dir: &'c Path,
    pub(super) errors: Vec<CaseError>,
}

impl Checks<'_, '_> {
    fn push(&mut self, error: impl FnOnce(&Text<'_>) -> CaseError) {
        // Finding the key of a place takes a walk over the file: a long bad table must not take one per line.
        if self.errors.len() < MOST_ERRORS {
            self.errors.push(error(self.text));
        }
    }

    /// The value at `span` is not what is expected there.
    fn wrong(&mut self, span: &Range<usize>, expected: &str, help: Option<&str>) {
        self.push(|text| text.wrong(span, expected, help.map(str::to_owned)));
    }

    /// A sentence says best what is wrong at `span`.
    fn fault(&mut self, span: &Range<usize>, message: String, expected: &str, help: Option<&str>) {
        self.push(|text| text.fault(span, message, expected, help.map(str::to_owned)));
    }

    /// The solver's own check refuses what stands at `span`.
    fn core<T>(&mut self, span: &Range<usize>, result: asperity::Result<T>) -> Option<T> {
        let error = match result {
            Ok(value) => return Some(value),
            Err(error) => error,
        };
        self.push(|text| {
            let expected = match &error {
                asperity::Error::Invalid { expected, .. } => expected.clone(),
                _ => String::new(),
            };
            text.fault(span, error.to_string(), &expected, None)
        });
        None
    }

    /// The quantity, or its error at its place.
    fn quantity<T, Q>(&mut self, at: &At<Q>, result: Result<T, QuantityError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                self.wrong(&at.span, &error.expected, error.help.as_deref());
                None
            }
        }
    }

    /// Which of several keys is given, where exactly one must be.
    fn exactly_one<'k>(&mut self, table: &Range<usize>, keys: &[(&'k str, bool)]) -> Option<&'k str> {
        let given: Vec<&str> = keys.iter().filter(|key| key.1).map(|key| key.0).collect();
        if let [one] = given.as_slice() {
            return Some(one);
        }
        let names: Vec<String> = keys.iter().map(|key| format!("`{}`", key.0)).collect();
        let names = names.join(" or ");
        self.push(|text| {
            let path = text.path(table);
            let message = match given.is_empty() {
                true => format!("{path} needs {names}"),
                false => format!("{path} has {}, but needs only one of them", given.join(" and ")),
            };
            text.error(table, path, None, &names, None, message)
        });
        None
    }

    /// The path of an existing file, relative to the case file.
    fn file(&mut self, path: &At<String>) -> Option<PathBuf> {
        let full = self.dir.join(&path.value);
        let reason = match std::fs::metadata(&full) {
            Ok(metadata) if metadata.is_file() => return Some(full),
            Ok(_) => "is not a file".to_owned(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => "does not exist".to_owned(),
            Err(error) => format!("cannot be read: {error}"),
        };
        self.push(|text| {
            let message = format!("{} {reason}", full.display());
            let help = "paths are relative to the directory of the case file".to_owned();
            text.fault(&path.span, message, "a file", Some(help))
        });
        None
    }
}
