//! Where a march stands in its programme: the stage, the next instant, and what it takes to end the stage.

use crate::error::{Error, Result};
use crate::load::{Control, Event, History, Stage};
use crate::march::adaptive::Pace;
use crate::march::{Reached, Simulation};
use crate::time::{Instant, SAME, Span, Stop, TimeGrid, agree, stops};

/// Steps to the period of a sine, at least, where steps are adaptive.
const STEPS_PER_PERIOD: f64 = 40.0;

pub(super) struct Timeline {
    kinks: Vec<f64>,
    /// Instants besides those of the grid at which steps end.
    include: Vec<f64>,
    /// The stage under way, when it began, and the value that its quantity had then.
    stage: usize,
    start: f64,
    reached: f64,
    history: History,
    /// The largest size of its value.
    pub(super) scale: f64,
    /// Start and history of the stage before.
    passed: (f64, History),
    stops: Vec<Stop>,
    /// The next stop.
    next: usize,
    /// A row of zero length comes next, at this value.
    jump: Option<f64>,
    pace: Option<Pace>,
    /// The last row, and whether the course goes on smoothly after it.
    last: Option<Instant>,
    smooth: bool,
    /// Which side of its value the event is waited for from: -1 below, 1 above, 0 not yet known.
    pub(super) side: f64,
    /// The largest approach and load so far.
    pub(super) largest: Reached,
    finished: bool,
    missed: Option<Missed>,
}

/// A row that is done.
#[derive(Clone, Copy)]
pub(super) struct Accepted {
    pub(super) instant: Instant,
    /// Its estimated error, where steps are adaptive.
    pub(super) error: Option<f64>,
    /// Whether it ends its stage.
    pub(super) event: bool,
    /// Whether contact was made or lost.
    pub(super) turn: bool,
    pub(super) reached: Reached,
}

/// A smooth piece of the course that has just begun.
pub(super) struct Piece<'a> {
    /// On the clock of the run, and how long it is as far as is known \[s\].
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) after_jump: bool,
    history: &'a History,
    stage_start: f64,
}

impl Piece<'_> {
    /// Rate of the prescribed value at its start, over a time `dt`.
    pub(super) fn slope(&self, dt: f64) -> f64 {
        let inside = self.start - self.stage_start;
        (self.history.after(inside + dt) - self.history.after(inside)) / dt
    }
}

/// An event that did not come.
#[derive(Clone, Copy)]
struct Missed {
    event: Event,
    reached: Reached,
}

impl Timeline {
    pub(super) fn new(simulation: &Simulation) -> Self {
        let end = simulation.times.end();
        let mut timeline = Timeline {
            kinks: (simulation.thermal.iter().flat_map(|body| body.clock.breaks(end)))
                .chain(simulation.motion.iter().flat_map(|motion| motion.path.breaks(end)))
                .collect(),
            include: simulation.stops(),
            stage: 0,
            start: 0.0,
            reached: 0.0,
            history: History::Step { value: 0.0 },
            scale: 0.0,
            passed: (0.0, History::Step { value: 0.0 }),
            stops: vec![],
            next: 0,
            jump: None,
            pace: None,
            last: None,
            smooth: false,
            side: 0.0,
            largest: Reached::default(),
            finished: false,
            missed: None,
        };
        timeline.enter(simulation, 0, 0.0, Reached::default());
        timeline
    }

    /// The last row.
    pub(super) fn last(&self) -> Option<Instant> {
        self.last
    }

    /// Whether the last two steps and the next belong to one smooth piece.
    pub(super) fn smooth(&self) -> bool {
        self.smooth
    }

    pub(super) fn finished(&self) -> bool {
        self.finished
    }

    pub(super) fn pace(&self) -> Option<&Pace> {
        self.pace.as_ref()
    }

    /// The smooth piece that begins with the next step, where steps are adaptive and one begins.
    pub(super) fn piece(&self) -> Option<Piece<'_>> {
        if self.smooth || self.jump.is_some() || self.finished || self.pace.is_none() {
            return None;
        }
        let last = self.last?;
        Some(Piece {
            start: last.time,
            length: self.stops.get(self.next)?.time - last.time,
            after_jump: last.jump,
            history: &self.history,
            stage_start: self.start,
        })
    }

    /// The first step of a smooth piece may be that long.
    pub(super) fn restart(&mut self, first: f64) {
        self.pace.iter_mut().for_each(|pace| pace.restart(first));
    }

    /// The stage under way.
    pub(super) fn stage<'s>(&self, simulation: &'s Simulation) -> &'s Stage {
        let stages = &simulation.loading.stages;
        &stages[self.stage.min(stages.len() - 1)]
    }

    /// The next row as planned, or `None` at the end.
    pub(super) fn propose(&self, simulation: &Simulation) -> Result<Option<Instant>> {
        if let Some(Missed { event, reached }) = self.missed {
            return Err(Error::Missed {
                stage: self.stage + 1,
                event: event.to_string(),
                end: simulation.times.end(),
                approach: reached.approach,
                load: reached.load,
            });
        }
        if self.finished {
            return Ok(None);
        }
        let control = self.stage(simulation).control;
        let time = self.last.map_or(0.0, |last| last.time);
        let instant =
            |time, dt, value, jump| Some(Instant { time, dt, value, jump, control, stage: self.stage });
        if let Some(value) = self.jump {
            if self.stage > 0 && simulation.instantaneous() <= 0.0 {
                return Err(Error::invalid(
                    format!("jump in stage {} at t = {time} s", self.stage + 1),
                    format!("to {value:e}"),
                    "a course from the value reached: the material has no instantaneous compliance, so no \
                     contact follows a jump",
                ));
            }
            return Ok(instant(time, 0.0, value, true));
        }
        let Some(stop) = self.stops.get(self.next) else { return Ok(None) };
        let rest = stop.time - time;
        let longest =
            self.pace.as_ref().map(|pace| pace.dt.min(self.steady(simulation, time, stop, pace.drift())));
        Ok(match longest {
            // Not a sliver before the stop.
            Some(longest) if rest > 1.1 * longest => {
                let dt = if rest < 2.0 * longest { 0.5 * rest } else { longest };
                Some(self.inside(simulation, dt))
            }
            _ => instant(stop.time, rest, stop.before, false),
        })
    }

    /// How long a step from `time` may be until a clock has changed ln of its rate by `drift` \[s\]. A step is linear in
    /// reduced time: right where the rate is constant, and also where one clock alone runs under a held value.
    fn steady(&self, simulation: &Simulation, time: f64, stop: &Stop, drift: f64) -> f64 {
        let rest = stop.time - time;
        let held = (stop.before - self.history.after(time - self.start)).abs() <= 1e-12 * self.scale;
        let clocks =
            simulation.parts().filter(|creep| !creep.terms.is_empty() || creep.fluidity > 0.0).count();
        if held && clocks < 2 {
            return rest;
        }
        let most = |dt: f64| {
            simulation.thermal.iter().map(|body| body.clock.drift(time, time + dt)).fold(0.0, f64::max)
        };
        if most(rest) <= drift {
            return rest;
        }
        // The temperature goes one way between two stops.
        let [mut least, mut longest] = [0.0, rest];
        for _ in 0..40 {
            let middle = 0.5 * (least + longest);
            if most(middle) <= drift { least = middle } else { longest = middle }
        }
        longest
    }

    /// The instant `dt` after the last row, within the step under way.
    pub(super) fn inside(&self, simulation: &Simulation, dt: f64) -> Instant {
        let time = self.last.map_or(0.0, |last| last.time) + dt;
        Instant {
            time,
            dt,
            value: self.history.after(time - self.start),
            jump: false,
            control: self.stage(simulation).control,
            stage: self.stage,
        }
    }

    /// The prescribed value at `time`, within the step that led to the last row.
    pub(super) fn value_within(&self, row: Instant, time: f64) -> f64 {
        let (start, history) = if row.stage == self.stage {
            (self.start, &self.history)
        } else {
            (self.passed.0, &self.passed.1)
        };
        history.before(time - start)
    }

    /// Takes a row.
    pub(super) fn accept(&mut self, simulation: &Simulation, row: Accepted) {
        let Accepted { instant, error, event, turn, reached } = row;
        self.largest.approach = self.largest.approach.max(reached.approach.abs());
        self.largest.load = self.largest.load.max(reached.load);
        self.last = Some(instant);
        self.smooth = !instant.jump && !turn;
        if let Some(pace) = &mut self.pace
            && !instant.jump
        {
            pace.accept(instant.dt, error.unwrap_or(0.0));
        }
        if instant.jump {
            self.jump = None;
        } else if let Some(stop) = self.stops.get(self.next)
            && instant.time >= stop.time
        {
            self.next += 1;
            self.jump = stop.after;
            if stop.bend || stop.after.is_some() {
                self.smooth = false;
            }
        }
        let over = self.jump.is_none() && self.next >= self.stops.len();
        if !event && !over {
            return;
        }
        let stage = self.stage(simulation);
        if let Some(awaited) = stage.until
            && !event
            && stage.duration.is_none()
        {
            self.missed = Some(Missed { event: awaited, reached });
            return;
        }
        self.enter(simulation, self.stage + 1, instant.time, reached);
    }

    /// Begins a stage where the quantities have the values `reached`.
    fn enter(&mut self, simulation: &Simulation, stage: usize, time: f64, reached: Reached) {
        self.smooth = false;
        let end = simulation.times.end();
        let Some(next) = simulation.loading.stages.get(stage) else {
            self.finished = true;
            return;
        };
        if time >= end * (1.0 - SAME) {
            self.finished = true;
            return;
        }
        let reached = match next.control {
            Control::Load => reached.load,
            Control::Pressure => reached.load / simulation.grid.area(),
            Control::Approach => reached.approach,
        };
        self.arrive(simulation, stage, time, reached);
        let first = self.history.after(0.0);
        self.jump = (stage == 0 || !agree(first, reached)).then_some(first);
        self.side = 0.0;
    }

    /// The stops of a stage that starts at `start`.
    fn arrive(&mut self, simulation: &Simulation, stage: usize, start: f64, reached: f64) {
        let next = &simulation.loading.stages[stage];
        let run_end = simulation.times.end();
        let history = std::mem::replace(&mut self.history, next.course.resolve(reached));
        self.passed = (self.start, history);
        self.stage = stage;
        self.start = start;
        self.reached = reached;
        let end = next.duration.map_or(run_end, |duration| (start + duration).min(run_end));
        let span = Span {
            history: &self.history,
            start,
            end,
            run_end,
            include: &self.include,
            kinks: &self.kinks,
            turns: next.until.is_some(),
        };
        let [least, most] = self.history.range(end - start);
        self.scale = least.abs().max(most.abs());
        self.stops = stops(&span, next.times.as_ref(), &simulation.times);
        self.next = 0;
        let longest = match &self.history {
            History::Sine { frequency, .. } => 1.0 / (STEPS_PER_PERIOD * frequency),
            _ => f64::INFINITY,
        };
        self.pace = match next.times.as_ref().unwrap_or(&simulation.times) {
            TimeGrid::Adaptive { end, tolerance, first } => {
                Some(Pace::new(*tolerance, *first, *end, longest))
            }
            _ => None,
        };
    }

    /// Numbers from which [`Timeline::load`] goes on; infinite for none.
    pub(super) fn save(&self) -> Vec<f64> {
        let last =
            self.last.map_or([f64::INFINITY; 4], |i| [i.time, i.dt, i.value, f64::from(u8::from(i.jump))]);
        let pace = self.pace.as_ref().map_or([f64::INFINITY; 2], |pace| [pace.dt, pace.elapsed]);
        let flag = |yes: bool| f64::from(u8::from(yes));
        let missed = self.missed.map_or([f64::INFINITY; 2], |m| [m.reached.approach, m.reached.load]);
        let mut numbers = vec![self.stage as f64, self.start, self.reached, self.next as f64];
        numbers.extend([
            self.jump.unwrap_or(f64::INFINITY),
            flag(self.smooth),
            self.side,
            flag(self.finished),
        ]);
        numbers.extend([self.largest.approach, self.largest.load]);
        numbers.extend(last);
        numbers.extend(pace);
        numbers.extend(missed);
        numbers
    }

    /// How many numbers [`Timeline::save`] gives.
    pub(super) const SAVED: usize = 18;

    /// Takes back what [`Timeline::save`] gave; false where it does not fit.
    pub(super) fn load(&mut self, simulation: &Simulation, numbers: &[f64]) -> bool {
        let &[
            stage,
            start,
            reached,
            next,
            jump,
            smooth,
            side,
            finished,
            approach,
            load,
            time,
            dt,
            value,
            jumped,
            length,
            elapsed,
            missed_approach,
            missed_load,
        ] = numbers
        else {
            return false;
        };
        let stages = &simulation.loading.stages;
        let sound = stage >= 0.0 && stage < stages.len() as f64 && start >= 0.0 && next >= 0.0;
        if !sound || !start.is_finite() || !reached.is_finite() {
            return false;
        }
        self.arrive(simulation, stage as usize, start, reached);
        self.next = next as usize;
        if self.next > self.stops.len() {
            return false;
        }
        self.jump = (!jump.is_infinite()).then_some(jump);
        self.smooth = smooth == 1.0;
        self.side = side;
        self.finished = finished == 1.0;
        self.largest = Reached { approach, load };
        let control = self.stage(simulation).control;
        self.last = (!time.is_infinite()).then_some(Instant {
            time,
            dt,
            value,
            jump: jumped == 1.0,
            control,
            stage: self.stage,
        });
        if let Some(pace) = &mut self.pace {
            (pace.dt, pace.elapsed) = (length, elapsed);
        }
        self.missed = match self.stage(simulation).until {
            Some(event) if !missed_approach.is_infinite() => {
                Some(Missed { event, reached: Reached { approach: missed_approach, load: missed_load } })
            }
            _ => None,
        };
        true
    }
}
