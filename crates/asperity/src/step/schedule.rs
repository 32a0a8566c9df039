//! When the next row is, and whether a step tried is taken: stages, events, step size.
//!
//! The schedule knows no contact. It proposes an interval; it sees a summary of each attempt at it and answers with another
//! interval to try, or that the attempt stands:
//!
//! ```text
//! while let Proposal::Try(interval) = schedule.propose()? {
//!     while let Some(next) = schedule.assess(&attempt(interval)) { interval = next }
//!     schedule.accept(..);
//! }
//! ```
//!
//! An adaptive step is tried shorter until its error is small enough; then a stage that ends at an event is cut where the event
//! happens.

mod steered;

use std::f64::consts::TAU;
use std::sync::Arc;

use super::event::{Enclosure, MET};
use super::interval::{Course, Interval, Piece};
use super::snapshot::{Loader, Saver, saved};
use super::step_size::StepSizeControl;
use crate::error::{Error, Result};
use crate::load::{Control, Event, History, Stage};
use crate::numbers::bisect;
use crate::quantities::RowNumber;
use crate::simulation::Simulation;
use crate::time::{Instant, SAME, SHORTEST, Span, Stop, TimeGrid, agree, stops};

/// The last equilibrium is found to this share of the step.
const CLOSEST: f64 = 1e-3;
/// Steps to the period of a sine, at least, where steps are adaptive.
const STEPS_PER_PERIOD: f64 = 40.0;

/// What an attempt at a step ended with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Summary {
    /// The row that the attempt led to; it may end before the interval proposed.
    pub(crate) instant: Instant,
    /// Estimated error of the step, where it is.
    pub(crate) error: Option<f64>,
    /// Whether contact was made or lost at its end.
    pub(crate) is_turn: bool,
    pub(crate) touches: bool,
    /// Whether a traction besides the contact acts on the surfaces: then a load of 0 says nothing of the contact.
    pub(crate) pulls: bool,
    pub(crate) reached: Response,
    /// The number of the row that the stage waits for; NaN where it waits for none.
    pub(crate) number: f64,
    /// Approach at which the surfaces without pressure would just touch \[m\].
    pub(crate) first_touch: f64,
}

/// What a row reached: a stage may end or begin with it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Response {
    pub(crate) approach: f64,
    pub(crate) load: f64,
}

/// The next row.
#[derive(Debug)]
pub(crate) enum Proposal {
    Try(Interval),
    Done(StopReason),
}

/// Why there is no further row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StopReason {
    /// The last stage has ended, or the time of the run.
    Complete,
    /// A stage waited for an event that did not come.
    Missed { stage: usize, event: Event, reached: Response, number: f64 },
}

/// What the attempts at a row are for.
#[derive(Debug)]
enum Search {
    /// A step whose error is small enough.
    Length,
    /// The event within the step.
    Event { event: Event, enclosure: Enclosure },
    /// The longest step that ends in equilibrium: lengths with and without one.
    Equilibrium { with: f64, without: f64 },
    /// The row ends where the event has just happened.
    End,
    /// It ends with the last equilibrium, without the event.
    Last,
}

pub(crate) struct Schedule {
    simulation: Arc<Simulation>,
    /// Instants at which the temperature or the path of a motion has a kink, and those besides the grid at which steps end.
    kinks: Vec<f64>,
    include: Vec<f64>,
    /// Parts of the compliance that remember.
    remember: usize,
    /// The number of the stage under way, and the value that its quantity had when it began.
    stage: usize,
    /// The stage under way, where it was prescribed between two rows.
    steered: Option<Stage>,
    started_from: f64,
    course: Course,
    stops: Vec<Stop>,
    /// The next stop.
    next: usize,
    /// A row of zero length comes next, at this value.
    jump: Option<f64>,
    size: Option<StepSizeControl>,
    /// The last row, what it reached, and whether the course goes on smoothly after it.
    last: Option<Instant>,
    reached: Response,
    touched: bool,
    is_smooth: bool,
    /// Whether the last row is the last equilibrium under the prescribed load.
    is_last: bool,
    /// The number that the stage under way waits for, in the last row, before the first one of the bodies at first touch; NaN where it waits
    /// for none.
    pub(crate) number: f64,
    /// Which side of its value the event is waited for from: -1 below, 1 above, 0 not yet known, as after a jump.
    side: f64,
    /// The largest approach and load so far.
    largest: Response,
    stopped: Option<StopReason>,
    search: Search,
}

impl Schedule {
    pub(crate) fn new(simulation: &Arc<Simulation>) -> Self {
        let course = Course { history: Arc::new(History::Step { value: 0.0 }), start: 0.0, scale: 0.0 };
        let mut schedule = Schedule {
            simulation: simulation.clone(),
            kinks: simulation.kinks(),
            include: simulation.stops(),
            remember: simulation.parts().filter(|creep| creep.remembers()).count(),
            stage: 0,
            steered: None,
            started_from: 0.0,
            course,
            stops: vec![],
            next: 0,
            jump: None,
            size: None,
            last: None,
            reached: Response::default(),
            touched: false,
            is_smooth: false,
            is_last: false,
            number: f64::NAN,
            side: 0.0,
            largest: Response::default(),
            stopped: None,
            search: Search::Length,
        };
        schedule.enter(0, 0.0, Response::default());
        schedule
    }

    pub(crate) fn finished(&self) -> bool {
        self.stopped == Some(StopReason::Complete)
    }

    fn stage(&self) -> &Stage {
        let stages = &self.simulation.loading.stages;
        self.steered.as_ref().unwrap_or(&stages[self.stage.min(stages.len() - 1)])
    }

    /// The number of a row that the stage under way waits for.
    pub(crate) fn awaited(&self) -> Option<RowNumber> {
        match self.stage().until {
            Some(Event::Number(number, _)) => Some(number),
            _ => None,
        }
    }

    /// Whether a stage was prescribed between two rows.
    pub(crate) fn is_steered(&self) -> bool {
        self.steered.is_some()
    }

    /// Ends the stage under way with the last row, in place of it and of all stages after it begins this one. `false` where there is
    /// no row yet, or none to come.
    pub(crate) fn prescribe(&mut self, stage: Stage) -> bool {
        let end = self.simulation.times.end() * (1.0 - SAME);
        let Some(last) = self.last.filter(|last| self.stopped.is_none() && last.time < end) else {
            return false;
        };
        self.steered = Some(stage);
        self.begin(self.stage + 1, last.time, self.reached);
        true
    }

    /// The smooth piece that begins with the next step, where steps are adaptive and one begins.
    pub(crate) fn piece(&self) -> Option<Piece> {
        if self.is_smooth || self.jump.is_some() || self.stopped.is_some() || self.size.is_none() {
            return None;
        }
        let last = self.last?;
        Some(Piece {
            start: last.time,
            length: self.stops.get(self.next)?.time - last.time,
            is_after_jump: last.jump,
            control: self.stage().control,
            area: self.simulation.grid.area(),
            course: self.course.clone(),
        })
    }

    /// The first step of a smooth piece may be that long.
    pub(crate) fn restart(&mut self, first: f64) {
        self.size.iter_mut().for_each(|size| size.restart(first));
    }

    /// The next row as planned.
    ///
    /// # Errors
    /// [`Error::Invalid`] where a stage begins with a jump that the material cannot follow.
    pub(crate) fn propose(&mut self) -> Result<Proposal> {
        if let Some(reason) = self.stopped {
            return Ok(Proposal::Done(reason));
        }
        self.search = Search::Length;
        let time = self.last.map_or(0.0, |last| last.time);
        if let Some(value) = self.jump {
            if self.stage > 0 && self.simulation.instantaneous() <= 0.0 {
                return Err(Error::invalid(
                    format!("jump in stage {} at t = {time} s", self.stage + 1),
                    format!("to {value:e}"),
                    "a course from the value reached: the material has no instantaneous compliance, so no \
                     contact follows a jump",
                ));
            }
            return Ok(Proposal::Try(self.interval(time, 0.0, value, true)));
        }
        let Some(stop) = self.stops.get(self.next) else { return Ok(Proposal::Done(StopReason::Complete)) };
        let rest = stop.time - time;
        let longest =
            self.size.as_ref().map(|size| size.dt.min(self.longest_linear(time, stop, size.drift())));
        Ok(Proposal::Try(match longest {
            // Not a sliver before the stop.
            Some(longest) if rest > 1.1 * longest => {
                let dt = if rest < 2.0 * longest { 0.5 * rest } else { longest };
                self.interval(time, rest, stop.before, false).of_length(dt)
            }
            _ => self.interval(stop.time, rest, stop.before, false),
        }))
    }

    fn interval(&self, time: f64, dt: f64, value: f64, jump: bool) -> Interval {
        let stage = self.stage();
        Interval {
            instant: Instant { time, dt, value, jump, control: stage.control, stage: self.stage },
            start: self.last.map_or(time, |last| last.time),
            is_smooth: self.is_smooth,
            is_adaptive: self.size.is_some(),
            held_from: self.reached.approach,
            course: self.course.clone(),
            load: super::Load::default(),
        }
    }

    /// How long a step from `time` may be until a clock has changed ln of its rate by `drift` \[s\]. A step is linear in
    /// reduced time: right where the rate is constant, and also where one clock alone runs under a held value.
    fn longest_linear(&self, time: f64, stop: &Stop, drift: f64) -> f64 {
        let rest = stop.time - time;
        let Course { history, start, scale } = &self.course;
        let held = (stop.before - history.after(time - start)).abs() <= 1e-12 * scale;
        if held && self.remember < 2 {
            return rest;
        }
        let drifts =
            |dt: f64| self.simulation.thermal.iter().map(move |body| body.clock.drift(time, time + dt));
        let most = |dt: f64| drifts(dt).fold(0.0, f64::max);
        if most(rest) <= drift {
            return rest;
        }
        // The temperature goes one way between two stops.
        bisect([0.0, rest], 40, |dt| most(dt) <= drift)[1]
    }

    /// What to try after an attempt that found no equilibrium: the longest step with one is found to a thousandth, unless an event or the error
    /// of the step ends it before. `None` where steps have given lengths and no event is waited for, or where the last row is the last
    /// equilibrium. Close to the last one the contact converges ever more slowly: an attempt of which it `is_known` only that it did not
    /// converge counts as one without, once the search is on.
    pub(crate) fn retreat(&mut self, tried: &Interval, is_known: bool) -> Option<Interval> {
        let without = tried.length();
        let with = match self.search {
            Search::Equilibrium { with, .. } => with,
            _ if is_known && (self.size.is_some() || self.stage().until.is_some()) => 0.0,
            _ => return None,
        };
        self.search = Search::Equilibrium { with, without };
        if self.is_last || without <= SHORTEST * self.simulation.times.end() {
            return None;
        }
        Some(tried.of_length(self.between().unwrap_or(with)))
    }

    /// The length to try between those with and without an equilibrium; `None` where they are close enough: the search is at its end.
    fn between(&mut self) -> Option<f64> {
        let Search::Equilibrium { with, without } = self.search else { return None };
        if without - with > CLOSEST * without {
            return Some(0.5 * (with + without));
        }
        self.search = if self.awaits_parting() { Search::End } else { Search::Last };
        None
    }

    fn awaits_parting(&self) -> bool {
        self.stage().until == Some(Event::ContactLost)
    }

    /// What to try instead of an attempt at an interval; `None` where it stands.
    pub(crate) fn assess(&mut self, tried: &Interval, attempt: &Summary) -> Option<Interval> {
        let dt = attempt.instant.dt;
        let next = match &mut self.search {
            Search::End | Search::Last => None,
            Search::Length => self.shorten(attempt),
            &mut Search::Equilibrium { without, .. } => {
                self.search = Search::Length;
                let shorter = self.shorten(attempt);
                if shorter.is_none() && matches!(self.search, Search::Length) {
                    self.search = Search::Equilibrium { with: dt, without };
                    self.between()
                } else {
                    shorter
                }
            }
            &mut Search::Event { event, mut enclosure } => {
                let (signal, tolerance) = self.signal(event, attempt);
                match met(event, signal, tolerance) {
                    true => self.end_here(),
                    false => {
                        enclosure.narrow(dt, self.side * signal);
                        self.close_in(event, enclosure, dt)
                    }
                }
            }
        };
        next.map(|dt| tried.of_length(dt))
    }

    /// The length to try next where the step is in error, or where the event happens in it; `None` where the step stands.
    fn shorten(&mut self, attempt: &Summary) -> Option<f64> {
        let Instant { dt, jump, .. } = attempt.instant;
        let size = self.size.as_ref().filter(|_| !jump);
        let shorter = size.and_then(|size| size.rejects(dt, attempt.error?));
        shorter.or_else(|| self.find_event(attempt))
    }

    /// The row ends with this attempt, where the event has just happened.
    fn end_here(&mut self) -> Option<f64> {
        self.search = Search::End;
        None
    }

    /// The next length to try for an event; `None` where it has just happened in the attempt of length `dt`.
    fn close_in(&mut self, event: Event, mut enclosure: Enclosure, dt: f64) -> Option<f64> {
        let next = enclosure.guess();
        self.search = if next.is_some() { Search::Event { event, enclosure } } else { Search::End };
        next.or(Some(enclosure.far).filter(|far| *far != dt))
    }

    /// The length to try next for an event that happens in a step whose error is small enough; `None` where the step stands.
    fn find_event(&mut self, attempt: &Summary) -> Option<f64> {
        let stage = self.stage();
        let event = match stage.until? {
            // No load is no contact, where nothing pulls.
            Event::Load(0.0) | Event::Pressure(0.0) if !attempt.pulls => Event::ContactLost,
            event => event,
        };
        let Instant { time, dt, jump, control, .. } = attempt.instant;
        let (signal, tolerance) = self.signal(event, attempt);
        let start = self.signal_at_start(event, attempt);
        if jump {
            // What a jump only passes is not reached: it counts where it ends, unless it begins there too.
            let is_counted = time > self.course.start || !stage.after_jump;
            let ends_there = match event {
                Event::ContactLost => self.touched && signal <= 0.0,
                _ => signal.abs() <= tolerance && (start.is_nan() || start.abs() > tolerance),
            };
            return if is_counted && ends_there { self.end_here() } else { None };
        }
        if start.is_nan() {
            self.side = 0.0;
        }
        if signal.is_nan() {
            return None;
        }
        if self.side == 0.0 {
            // The value must be left before it can be reached, and what never touched is not lost: from the last row on,
            // else from this one on.
            self.side = match event {
                Event::ContactLost => f64::from(u8::from(self.touched)),
                _ if start.abs() > tolerance => start.signum(),
                _ => 0.0,
            };
        }
        let side = self.side;
        if side == 0.0 || side * signal > 0.0 && !met(event, signal, tolerance) {
            return None;
        }
        if met(event, signal, tolerance) {
            return self.end_here();
        }
        let before = match (event, control) {
            // The distance between the bodies is known only of open ones.
            (Event::ContactLost, Control::Approach) if !attempt.pulls => f64::NAN,
            _ => side * start,
        };
        self.close_in(event, Enclosure::new(dt, before, side * signal), dt)
    }

    /// The quantity of an event less its value, and what counts as none.
    fn signal(&self, event: Event, attempt: &Summary) -> (f64, f64) {
        let Response { approach, load } = attempt.reached;
        let deepest = self.largest.approach.max(approach.abs());
        let heaviest = self.largest.load.max(load.abs());
        let area = self.simulation.grid.area();
        match event {
            Event::Approach(value) => (approach - value, MET * deepest.max(value.abs())),
            Event::Load(value) => (load - value, MET * heaviest.max(value.abs())),
            Event::Pressure(value) => (load / area - value, MET * value.abs().max(heaviest / area)),
            Event::Number(_, value) => (attempt.number - value, MET * value.abs().max(self.number.abs())),
            // Surfaces that pull at each other part at once.
            Event::ContactLost if attempt.pulls => (if attempt.touches { 1.0 } else { -1.0 }, 0.0),
            Event::ContactLost if attempt.instant.control == Control::Approach => {
                (approach - attempt.first_touch, MET * deepest)
            }
            // Under a load the bodies touch as long as there is any.
            Event::ContactLost if attempt.touches => (load.max(f64::MIN_POSITIVE), 0.0),
            Event::ContactLost => (0.0, 0.0),
        }
    }

    /// The same at the start of the step.
    fn signal_at_start(&self, event: Event, attempt: &Summary) -> f64 {
        let number = self.number;
        self.signal(event, &Summary { reached: self.reached, touches: self.touched, number, ..*attempt }).0
    }

    /// Takes the row that stands.
    pub(crate) fn accept(&mut self, row: &Summary) {
        let Summary { instant, error, is_turn, reached, .. } = *row;
        let is_event = matches!(self.search, Search::End);
        self.is_last = matches!(self.search, Search::Last);
        self.largest.approach = self.largest.approach.max(reached.approach.abs());
        self.largest.load = self.largest.load.max(reached.load.abs());
        self.last = Some(instant);
        (self.reached, self.touched) = (reached, row.touches);
        self.is_smooth = !instant.jump && !is_turn;
        if let Some(size) = &mut self.size
            && !instant.jump
        {
            size.accept(instant.dt, error.unwrap_or(0.0));
        }
        if instant.jump {
            // The state after it tells from where the value can be reached.
            (self.jump, self.side) = (None, 0.0);
        } else if let Some(stop) = self.stops.get(self.next)
            && instant.time >= stop.time
        {
            self.next += 1;
            self.jump = stop.after;
            if stop.bend || stop.after.is_some() {
                self.is_smooth = false;
            }
        }
        let is_over = self.jump.is_none() && self.next >= self.stops.len();
        if !is_event && !is_over {
            return;
        }
        let stage = self.stage();
        match stage.until.filter(|_| !is_event && stage.duration.is_none()) {
            Some(event) => {
                let number = row.number;
                self.stopped = Some(StopReason::Missed { stage: self.stage, event, reached, number });
            }
            None => self.enter(self.stage + 1, instant.time, reached),
        }
    }

    /// Begins a stage where the quantities have the values `reached`. After one that was prescribed between two rows they are held.
    fn enter(&mut self, stage: usize, time: f64, reached: Response) {
        let end = self.simulation.times.end() * (1.0 - SAME);
        let is_last = !self.is_steered() && stage >= self.simulation.loading.stages.len();
        if is_last || time >= end {
            self.stopped = Some(StopReason::Complete);
            return;
        }
        if let Some(steered) = &mut self.steered {
            *steered = Stage::new(steered.control, crate::load::Course::Hold);
        }
        self.begin(stage, time, reached);
    }

    /// The first row of a stage: a jump, unless it goes on from the values reached.
    fn begin(&mut self, stage: usize, time: f64, reached: Response) {
        self.is_smooth = false;
        self.stage = stage;
        let reached = match self.stage().control {
            Control::Load => reached.load,
            Control::Pressure => reached.load / self.simulation.grid.area(),
            Control::Approach => reached.approach,
        };
        self.arrive(time, reached);
        let first = self.course.history.after(0.0);
        self.jump = (stage == 0 || !agree(first, reached)).then_some(first);
        self.side = 0.0;
    }

    /// The stops of the stage under way, that started at `start`.
    fn arrive(&mut self, start: f64, reached: f64) {
        let (next, times) = (self.stage(), &self.simulation.times);
        let run_end = times.end();
        let end = next.duration.map_or(run_end, |duration| (start + duration).min(run_end));
        let history = next.course.resolve(reached);
        let (include, kinks) = (&self.include[..], &self.kinks[..]);
        let span =
            Span { history: &history, start, end, run_end, include, kinks, turns: next.until.is_some() };
        let stops = stops(&span, next.times.as_ref(), times);
        let size = match next.times.as_ref().unwrap_or(times) {
            TimeGrid::Adaptive { end, tolerance, first } => {
                let longest = longest(&history, next.control, *tolerance);
                Some(StepSizeControl::new(*tolerance, *first, *end, longest))
            }
            _ => None,
        };
        let [least, most] = history.range(end - start);
        self.course = Course { history: Arc::new(history), start, scale: least.abs().max(most.abs()) };
        (self.stops, self.next, self.size, self.started_from) = (stops, 0, size, reached);
    }

    pub(crate) fn save<'a>(&'a self, to: &mut Saver<'a>) {
        to.values("stage", &[&self.stage, &self.course.start, &self.started_from, &self.next]);
        if let Some(stage) = &self.steered {
            to.value("steered", &steered::numbers(stage));
        }
        if self.awaited().is_some() {
            to.value("number", &self.number);
        }
        self.save_own(to);
        if let Some(Instant { time, dt, value, jump, .. }) = &self.last {
            to.values("last", &[time, dt, value, jump]);
        }
        if let Some(size) = &self.size {
            to.values("step_size", &[&size.dt, &size.elapsed]);
        }
        let stopped = match self.stopped {
            None => 0usize,
            Some(StopReason::Complete) => 1,
            Some(StopReason::Missed { .. }) => 2,
        };
        to.value("stopped", &stopped);
    }

    pub(crate) fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        let (mut stage, mut start, mut reached, mut next) = (0_usize, 0.0_f64, 0.0_f64, 0_usize);
        from.values_into("stage", &mut [&mut stage, &mut start, &mut reached, &mut next])?;
        if let Ok(numbers) = from.numbers("steered") {
            let known = steered::stage(numbers).filter(|stage| stage.validate(true).is_ok());
            self.steered = Some(known.ok_or_else(|| from.foreign("another prescribed stage"))?);
        }
        if !self.is_steered() && stage >= self.simulation.loading.stages.len()
            || !(start.is_finite() && start >= 0.0 && reached.is_finite())
        {
            return Err(from.foreign("stages of another programme"));
        }
        self.stage = stage;
        self.arrive(start, reached);
        self.next = next;
        if self.next > self.stops.len() {
            return Err(from.foreign("times of another programme"));
        }
        self.load_own(from)?;
        if self.awaited().is_some() {
            self.number = from.get("number")?;
        }
        let (control, stage) = (self.stage().control, self.stage);
        let mut last = Instant { time: 0.0, dt: 0.0, value: 0.0, jump: false, control, stage };
        let Instant { time, dt, value, jump, .. } = &mut last;
        self.last = from.values_into("last", &mut [time, dt, value, jump]).ok().map(|()| last);
        if let Some(size) = &mut self.size {
            from.values_into("step_size", &mut [&mut size.dt, &mut size.elapsed])?;
        }
        self.stopped = match (from.get("stopped")?, self.stage().until) {
            (0_usize, _) => None,
            (2, Some(event)) => {
                let (reached, number) = (self.reached, self.number);
                Some(StopReason::Missed { stage: self.stage, event, reached, number })
            }
            _ => Some(StopReason::Complete),
        };
        Ok(())
    }
}

saved! {
    Schedule {
        "smooth": is_smooth;
        "last_equilibrium": is_last;
        "side": side;
        "reached": reached.approach, reached.load, touched;
        "largest": largest.approach, largest.load;
        "jump": jump;
    }
}

impl StopReason {
    /// The end of a run that is complete, or the error of one that is not.
    pub(crate) fn outcome(self, end: f64) -> Result<()> {
        match self {
            StopReason::Complete => Ok(()),
            StopReason::Missed { stage, event, reached, number } => Err(Error::Missed {
                stage: stage + 1,
                event: event.to_string(),
                number: match event {
                    Event::Number(of, _) => Some((of.name(), number)),
                    _ => None,
                },
                end,
                approach: reached.approach,
                load: reached.load,
            }),
        }
    }
}

/// No step is longer \[s\]: a prescribed load is straight within it, and leaves a sine by (2π/n)²/8 of the amplitude at n steps to a period.
/// (Under a prescribed approach this is part of the error of the step.)
fn longest(history: &History, control: Control, tolerance: f64) -> f64 {
    let History::Sine { mean, amplitude, frequency } = history else { return f64::INFINITY };
    let share = amplitude.abs() / (mean.abs() + amplitude.abs()).max(f64::MIN_POSITIVE);
    let straight = match control {
        Control::Approach => 0.0,
        Control::Load | Control::Pressure => TAU * (share / (8.0 * tolerance)).sqrt(),
    };
    1.0 / (STEPS_PER_PERIOD.max(straight) * frequency)
}

/// Whether an event is met as closely as asked for; contact is not lost before it is.
fn met(event: Event, signal: f64, tolerance: f64) -> bool {
    match event {
        Event::ContactLost => signal <= 0.0 && -signal <= tolerance,
        _ => signal.abs() <= tolerance,
    }
}

#[cfg(test)]
mod tests;
