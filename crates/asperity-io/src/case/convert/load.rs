//! What is prescribed over time, and whether bodies and times can follow it.

use std::ops::Range;

use asperity::{Control, Course, Event, Grid, History, Programme, Stage, TimeGrid};

use super::body::Pair;
use super::{Checks, history_file};
use crate::case::quantity::range::{Finite, NonNegative};
use crate::case::quantity::{Prescribed, QuantityError, dimension};
use crate::case::raw::{self, At, Two};
use crate::case::words::{missing_key, number};

/// What is prescribed, and where in the case it stands.
pub struct Prescription {
    pub programme: Programme,
    /// Of each stage.
    places: Vec<Place>,
    /// Path as written and MD5 of the files that hold histories.
    pub files: Vec<(String, String)>,
    /// Where the load is described.
    pub span: Range<usize>,
}

/// Where in the case a history stands, and its largest value.
struct Place {
    history: Range<usize>,
    largest: Range<usize>,
}

/// On a `line` loads are per length. `times` makes the grid of a stage from its keys and its course.
pub fn prescription(
    checks: &mut Checks<'_, '_>,
    load: &At<raw::Load>,
    line: bool,
    mut times: impl FnMut(&mut Checks<'_, '_>, &At<raw::Stage>, Option<&Course>) -> Option<Option<TimeGrid>>,
) -> Option<Prescription> {
    let raw = &load.value;
    let mut files = vec![];
    if let Some(list) = &raw.stages {
        let beside = [
            ("control", raw.control.as_ref().map(|at| &at.span)),
            ("history", raw.history.as_ref().map(|at| &at.span)),
        ];
        for (key, span) in beside {
            if let Some(span) = span {
                let message = format!("`{key}` cannot be combined with `stages`; each stage has its own");
                checks.fault(span, message, "one of the two", Some("leave one of them out"));
                return None;
            }
        }
        if list.value.is_empty() {
            checks.wrong(&list.span, "a list of one stage at least", None);
            return None;
        }
        let last = list.value.len() - 1;
        let made: Vec<_> = list
            .value
            .iter()
            .enumerate()
            .map(|(n, at)| {
                let made = stage(checks, at, line, n == last, &mut files);
                let own = times(checks, at, made.as_ref().map(|(stage, _)| &stage.course));
                let made = made?;
                Some((Stage { times: own?, ..made.0 }, made.1))
            })
            .collect();
        let (stages, places) = made.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
        let programme = Programme::new(stages);
        let programme = checks.core(&list.span, programme.validate().map(|()| programme))?;
        return Some(Prescription { programme, places, files, span: list.span.clone() });
    }
    for (key, missing) in [("control", raw.control.is_none()), ("history", raw.history.is_none())] {
        if missing {
            checks.push(|text| missing_key(text, &load.span, key));
        }
    }
    let (control, at) = (raw.control.as_ref()?.value, raw.history.as_ref()?);
    if let raw::History::Hold(_) = at.value {
        let help =
            "kind = \"hold\" is only possible in a stage; to apply a load from the start use kind = \"step\"";
        checks.fault(&at.span, "there is no earlier value to hold".to_owned(), "another kind", Some(help));
        return None;
    }
    let (course, place) = course(checks, Kind { control, line }, at, &mut files)?;
    let programme = Programme::new(vec![Stage::new(control, course)]);
    let programme = checks.core(&at.span, programme.validate().map(|()| programme))?;
    Some(Prescription { programme, places: vec![place], files, span: at.span.clone() })
}

fn stage(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Stage>,
    line: bool,
    last: bool,
    files: &mut Vec<(String, String)>,
) -> Option<(Stage, Place)> {
    let raw = &at.value;
    if !last && raw.duration.is_none() && raw.until.is_none() {
        let message = "this stage never ends, so the stages after it never begin".to_owned();
        let help = "give it duration = \"10 s\", or until = { approach = \"2 um\" }, { load = \"0.1 N\" } or \
                    \"contact-lost\"";
        checks.fault(&at.span, message, "`duration` or `until`", Some(help));
        return None;
    }
    let control = raw.control;
    let (course, place) = course(checks, Kind { control, line }, &raw.history, files)?;
    let until = match raw.until.as_ref().map(|at| &at.value) {
        None => None,
        Some(raw::Until::ContactLost) => Some(Event::ContactLost),
        Some(raw::Until::Approach(value)) => Some(Event::Approach(value.get())),
        Some(raw::Until::Pressure(value)) => Some(Event::Pressure(value.get())),
        Some(raw::Until::Load(at)) => {
            let load = Kind { control: Control::Load, line };
            Some(Event::Load(checks.quantity(at, load.resolve(&at.value))?))
        }
    };
    let stage = Stage {
        duration: raw.duration.as_ref().map(|at| at.value.get()),
        until,
        after_jump: raw.after_jump,
        ..Stage::new(control, course)
    };
    Some((stage, place))
}

/// The course, checked.
fn course(
    checks: &mut Checks<'_, '_>,
    kind: Kind,
    at: &At<raw::History>,
    files: &mut Vec<(String, String)>,
) -> Option<(Course, Place)> {
    let (course, largest) = match &at.value {
        raw::History::Hold(_) => (Course::Hold, at.span.clone()),
        raw::History::Ramp(ramp) if ramp.from == raw::From::Current => {
            let value = checks.quantity(&ramp.value, kind.resolve(&ramp.value.value))?;
            (Course::RampTo { value, duration: ramp.duration.get() }, ramp.value.span.clone())
        }
        _ => {
            let mut file = None;
            let (history, largest) = history(checks, kind, at, &mut file)?;
            files.extend(file);
            let history = checks.core(&at.span, history.validate().map(|()| history))?;
            (Course::Given(history), largest)
        }
    };
    Some((course, Place { history: at.span.clone(), largest }))
}

/// Whether the bodies can follow what is prescribed.
pub fn possible(
    checks: &mut Checks<'_, '_>,
    prescription: &Prescription,
    times: &TimeGrid,
    grid: Option<&Grid>,
    pair: &Pair,
) {
    let stages = prescription.programme.stages.iter().zip(&prescription.places);
    for (n, (stage, place)) in stages.enumerate() {
        let end = stage.duration.unwrap_or(times.end()).min(times.end());
        if let Some(grid) = grid {
            bearable(checks, stage, &place.largest, end, grid, pair);
        }
        let line = grid.is_some_and(Grid::is_line);
        jumps(checks, stage, Kind { control: stage.control, line }, n == 0, &place.history, end, pair);
    }
}

/// The history, and the place of its largest value.
fn history(
    checks: &mut Checks<'_, '_>,
    kind: Kind,
    at: &At<raw::History>,
    read: &mut Option<(String, String)>,
) -> Option<(History, Range<usize>)> {
    let one = |checks: &mut Checks<'_, '_>, value: &At<Prescribed>| {
        checks.quantity(value, kind.resolve(&value.value))
    };
    Some(match &at.value {
        raw::History::Step(step) => {
            (History::Step { value: one(checks, &step.value)? }, step.value.span.clone())
        }
        // A hold is a course that needs no history.
        raw::History::Hold(_) => return None,
        raw::History::Ramp(ramp) => {
            let value = one(checks, &ramp.value)?;
            (History::Ramp { value, duration: ramp.duration.get() }, ramp.value.span.clone())
        }
        raw::History::Triangle(triangle) => {
            let peak = one(checks, &triangle.peak)?;
            let [rise, fall] = [triangle.rise.get(), triangle.fall.get()];
            (History::Triangle { peak, rise, fall }, triangle.peak.span.clone())
        }
        raw::History::Trapezoid(trapezoid) => {
            let peak = one(checks, &trapezoid.peak)?;
            let [rise, hold, fall] = [trapezoid.rise.get(), trapezoid.hold.get(), trapezoid.fall.get()];
            (History::Trapezoid { peak, rise, hold, fall }, trapezoid.peak.span.clone())
        }
        raw::History::Sine(sine) => (sinusoid(checks, kind, sine)?, sine.mean.span.clone()),
        raw::History::Table(table) => table_points(checks, kind, table)?,
        raw::History::File(file) => {
            let path = checks.file(&file.path)?;
            match history_file::read(&path, |value| kind.resolve(value)) {
                Ok(history) => {
                    *read = Some((file.path.value.clone(), history.digest));
                    (History::Table { points: history.points }, file.path.span.clone())
                }
                Err(reason) => {
                    let message = format!("{}: {reason}", path.display());
                    checks.fault(&file.path.span, message, "a file of two columns, time and value", None);
                    return None;
                }
            }
        }
    })
}

/// What a prescribed value is: load, pressure or approach, and whether loads are per length.
#[derive(Clone, Copy)]
struct Kind {
    control: Control,
    line: bool,
}

impl Kind {
    /// The value in SI, in the dimension that the control has. A load presses; an approach may be negative.
    fn resolve(self, value: &Prescribed) -> Result<f64, QuantityError> {
        let si = match self.control {
            Control::Load if self.line => {
                value.resolve::<dimension::ForcePerLength, NonNegative>().map(|v| v.get())
            }
            Control::Load => value.resolve::<dimension::Force, NonNegative>().map(|v| v.get()),
            Control::Pressure => value.resolve::<dimension::Pressure, NonNegative>().map(|v| v.get()),
            Control::Approach => value.resolve::<dimension::Length, Finite>().map(|v| v.get()),
        };
        si.map_err(|QuantityError { expected, help }| {
            let help = match (self.control, help) {
                (Control::Load, Some(help)) if self.line && help.contains("unit of a force;") => {
                    format!("{help}; the domain is a line of cells, so the load is per length along y")
                }
                (Control::Load, Some(help)) if !self.line && help.contains("unit of a force per length") => {
                    format!(
                        "{help}; loads per length are for a line contact, with cells = [N] and size = [\"L\"]"
                    )
                }
                (Control::Load | Control::Pressure, None) => {
                    "there is no adhesion; to pull the bodies apart prescribe the approach".to_owned()
                }
                (_, help) => return QuantityError { expected, help },
            };
            QuantityError { expected, help: Some(help) }
        })
    }

    /// Its SI unit.
    fn unit(self) -> &'static str {
        match self.control {
            Control::Load if self.line => "N/m",
            Control::Load => "N",
            Control::Pressure => "Pa",
            Control::Approach => "m",
        }
    }
}

fn sinusoid(checks: &mut Checks<'_, '_>, kind: Kind, sine: &raw::Sine) -> Option<History> {
    let mean = checks.quantity(&sine.mean, kind.resolve(&sine.mean.value));
    let amplitude = checks.quantity(&sine.amplitude, kind.resolve(&sine.amplitude.value));
    let (mean, amplitude) = (mean?, amplitude?);
    if kind.control != Control::Approach && amplitude > mean {
        let help = "the load would become negative; raise the mean or lower the amplitude";
        checks.wrong(
            &sine.amplitude.span,
            &format!("at most the mean, {} {}", number(mean), kind.unit()),
            Some(help),
        );
        return None;
    }
    Some(History::Sine { mean, amplitude, frequency: sine.frequency.get() })
}

fn table_points(
    checks: &mut Checks<'_, '_>,
    kind: Kind,
    table: &raw::Table,
) -> Option<(History, Range<usize>)> {
    let mut points = Vec::with_capacity(table.points.value.len());
    let mut good = true;
    let mut largest = (f64::NEG_INFINITY, table.points.span.clone());
    for point in &table.points.value {
        let Two(time, value) = &point.value;
        let time = time.get();
        if let Some((before, _)) = points.last()
            && time < *before
        {
            good = false;
            let expected = format!("a point at {} s or later, as the point before it", number(*before));
            checks.wrong(&point.span, &expected, Some("list the points in order of time"));
        }
        match checks.quantity(value, kind.resolve(&value.value)) {
            Some(value_si) => {
                if value_si > largest.0 {
                    largest = (value_si, value.span.clone());
                }
                points.push((time, value_si));
            }
            None => good = false,
        }
    }
    if let (Some(first), Some((time, _))) = (table.points.value.first(), points.first())
        && good
        && *time != 0.0
    {
        good = false;
        checks.wrong(&first.span, "a point at 0 s", Some("give the value at the start"));
    }
    good.then_some((History::Table { points }, largest.1))
}

/// No solution exists above hardness times area.
fn bearable(
    checks: &mut Checks<'_, '_>,
    stage: &Stage,
    place: &Range<usize>,
    end: f64,
    grid: &Grid,
    pair: &Pair,
) {
    let limit = match stage.control {
        Control::Load => pair.hardness * grid.area(),
        Control::Pressure => pair.hardness,
        Control::Approach => return,
    };
    let largest = match &stage.course {
        Course::Given(history) => history.range(end)[1],
        Course::RampTo { value, .. } => *value,
        Course::Hold => return,
    };
    // Equality within rounding is the limit itself, which has a solution.
    if largest <= limit * (1.0 + 1e-12) {
        return;
    }
    let unit = Kind { control: stage.control, line: grid.is_line() }.unit();
    let [reached, limit, hardness] = [largest, limit, pair.hardness].map(number);
    let area = match stage.control {
        Control::Load if grid.is_line() => format!(" times the length {} m", number(grid.area())),
        Control::Load => format!(" times the area {} m^2", number(grid.area())),
        _ => String::new(),
    };
    let message = format!(
        "the history reaches {reached} {unit}, but the bodies can carry at most {limit} {unit}, the hardness \
         {hardness} Pa{area}"
    );
    let help = "lower the load, raise the hardness or enlarge the domain";
    checks.fault(place, message, &format!("{limit} {unit} at most"), Some(help));
}

/// Without instantaneous compliance there is no solution right after a jump.
fn jumps(
    checks: &mut Checks<'_, '_>,
    stage: &Stage,
    kind: Kind,
    first: bool,
    place: &Range<usize>,
    end: f64,
    pair: &Pair,
) {
    let (Course::Given(history), false) = (&stage.course, pair.instantaneous() > 0.0) else { return };
    // What a later stage starts from is known only as the run goes.
    let instants = first.then_some(0.0).into_iter().chain(history.breaks(end));
    let jump = instants.map(|t| (t, history.before(t), history.after(t))).find(|(_, b, a)| a != b);
    let Some((t, before, after)) = jump else { return };
    let unit = kind.unit();
    let [t, before, after] = [t, before, after].map(number);
    let message = format!(
        "the history jumps from {before} to {after} {unit} at t = {t} s, but the bodies have no instantaneous \
         compliance (Kelvin-Voigt), so there is no solution right after the jump"
    );
    let help = "use a ramp, or a material with an instantaneous modulus (zener, prony)";
    checks.fault(place, message, "a history without jumps", Some(help));
}
