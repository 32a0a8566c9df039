//! Steps that are too long for the history and the material.
//!
//! A step of any length is exact while load or approach is held below the hardness. If the load falls or the approach changes,
//! the contact changes within a step while the material relaxes: this needs several steps. Under a rising load approach and area
//! are exact, but pressures and energies are not. Under a held approach the displacement of cells at the hardness still changes.
//! A temperature that changes the rate of a material within a step is exact for this material, but not for a changing load or
//! approach, nor for the other body. A periodic load always needs several steps per period, because a few steps represent a
//! different load. Adaptive steps need no check.

use super::words::{digits, rows, si};
use super::worst::Worst;
use super::{ALIASED_HISTORY, Finding, STEPS_TOO_LONG};
use crate::drive::Coordinate;
use crate::error::significant;
use crate::load::{Control, Course, History, Stage};
use crate::simulation::Simulation;
use crate::step::Row;
use crate::time::{Instant, Plan, TimeGrid};

/// Steps per period.
const PER_PERIOD: f64 = 20.0;
/// Steps per monotone part of the history.
const PER_COURSE: usize = 10;
/// Steps per rising part of the load, if no energies are requested.
const PER_RISE: usize = 4;
/// Largest change of ln of the rate of a material in a step: the error is about 0.15 times its square.
const DRIFT: f64 = 0.5;
/// Changes by less than this fraction of the largest value are scatter of a measured history.
const SMALL: f64 = 0.05;
/// Largest estimated error of the stress; of adaptive steps also this many tolerances.
const COARSE: f64 = 0.05;
const MISSED: f64 = 2.0;
/// Relaxation times with less than this fraction of the modulus are ignored.
const SHARE: f64 = 0.05;
/// A material relaxes during a change of the load if one of its times is within this factor of the steps and of the change's
/// duration.
const NEAR: f64 = 10.0;

/// The findings from the steps of a run, as far as they are known.
pub(super) fn of(simulation: &Simulation) -> Vec<Finding> {
    let plan = simulation.plan();
    let mut found = vec![];
    let mut long: Option<Piece> = None;
    let energies = simulation.quantities.has_energy();
    let mut next = 0;
    for instants in plan.instants.chunk_by(|a, b| a.stage == b.stage) {
        let (n, first) = (instants[0].stage, next);
        next += instants.len();
        let stage = &simulation.loading.stages[n];
        if stage.times.as_ref().unwrap_or(&simulation.times).is_adaptive() {
            continue;
        }
        found.extend(aliased(simulation, n, stage, instants));
        for course in courses(stage, instants, first, energies) {
            // The part that lacks the most steps.
            let fewer =
                long.as_ref().is_none_or(|other| course.steps * other.least < other.steps * course.least);
            if course.steps < course.least && fewer && relaxes(simulation, &course) {
                long = Some(course);
            }
        }
        found.extend(drifting(simulation, &plan, instants, first));
    }
    found.extend(long.map(|course| too_long(simulation, &course, plan.exact)));
    found
}

/// A row whose estimated error is large by itself.
pub(super) struct Coarse {
    pub index: usize,
    pub error: f64,
    pub limit: f64,
    pub load: f64,
    /// Whether its step begins at a jump.
    pub after_jump: bool,
}

/// The largest error of a row that is not reported, in each stage.
pub(super) fn limits(simulation: &Simulation) -> Vec<f64> {
    let grids =
        simulation.loading.stages.iter().map(|stage| stage.times.as_ref().unwrap_or(&simulation.times));
    let limit = |grid: &TimeGrid| match grid {
        TimeGrid::Adaptive { tolerance, .. } => COARSE.min(MISSED * tolerance),
        _ => COARSE,
    };
    grids.map(limit).collect()
}

/// The finding for steps whose estimated error is too large for the largest load of the run. (In the first step of a load that grows from 0
/// the error is large for the load of that moment, whatever the length of the step.)
pub(super) fn coarse(simulation: &Simulation, rows: &[Coarse], heaviest: f64) -> Option<Finding> {
    let mut worst = Worst::default();
    let mut after_jump = false;
    for row in rows.iter().filter(|row| row.error * row.load > row.limit * heaviest) {
        if row.error / row.limit > worst.excess {
            after_jump = row.after_jump;
        }
        worst.above(row.index, row.error, row.limit);
    }
    let factor = worst.excess.sqrt();
    worst.warning(STEPS_TOO_LONG, |error| {
        format!(
            "The time steps are long for the history and the material{}: the pressures may be off by up to {} % of their sum (load and \
             approach are often more accurate, single cells less). {}",
            error.place(),
            digits(100.0 * error.value),
            shorter(simulation, factor, after_jump)
        )
    })
}

/// What brings an estimated error down to the limit, where that takes `factor` times as many steps: it falls with the square of the step, and with the tolerance of adaptive steps; the
/// creep right after a jump may be far faster than any step of given length.
fn shorter(simulation: &Simulation, factor: f64, after_jump: bool) -> String {
    let after_jump = after_jump && simulation.tangential.is_none();
    let advice = match &simulation.times {
        TimeGrid::Adaptive { tolerance, .. } => {
            format!(
                "Use a smaller tolerance: {} in place of {tolerance}.",
                rounded_down(tolerance / factor.powi(2))
            )
        }
        TimeGrid::List(_) if after_jump => format!("Set `end`, {ADAPTIVE} `times`: {AFTER_JUMP}."),
        _ if after_jump => format!("Set {ADAPTIVE} `steps`: {AFTER_JUMP}."),
        _ => more_steps(simulation, factor),
    };
    match &simulation.motion {
        Some(motion) => {
            let cells = rounded_down(motion.cells_per_step / factor);
            format!("{advice} While the contact moves, cells_per_step = {cells} has the same effect.")
        }
        None => advice,
    }
}

const ADAPTIVE: &str = "spacing = \"adaptive\" and leave out";
const AFTER_JUMP: &str = "right after a jump the material creeps far faster than later, and more steps of given length do not follow it";

/// "Take 70 steps in place of 40, ...", for `factor` times as many steps.
fn more_steps(simulation: &Simulation, factor: f64) -> String {
    let times = significant((10.0 * factor).ceil() / 10.0, 2);
    // Under a tangential load there are no adaptive steps.
    let or = |what: &str| match simulation.tangential {
        None => format!(", or set {what}"),
        Some(_) => String::new(),
    };
    match &simulation.times {
        _ if simulation.loading.stages.iter().any(|stage| stage.times.is_some()) => {
            format!("Take {times} times as many steps there{}.", or(&format!("{ADAPTIVE} `steps`")))
        }
        TimeGrid::Uniform { steps, .. } | TimeGrid::Logarithmic { steps, .. } => {
            let needed = (*steps as f64 * factor).ceil();
            format!("Take {needed} steps in place of {steps}{}.", or(&format!("{ADAPTIVE} `steps`")))
        }
        TimeGrid::List(_) | TimeGrid::Adaptive { .. } => {
            format!("Give {times} times as many times there{}.", or(&format!("`end`, {ADAPTIVE} `times`")))
        }
    }
}

/// One digit, not above the number.
fn rounded_down(number: f64) -> f64 {
    let power = 10f64.powf(number.log10().floor());
    let down = (number / power * (1.0 + 1e-9)).floor() * power;
    significant(down, 2).parse().unwrap_or(down)
}

/// The parts of a run in which an approach is held while cells are at the hardness, from its rows: what a stage holds, or what is prescribed
/// between two rows, is not known before.
#[derive(Default)]
pub(super) struct Held {
    pieces: Vec<Piece>,
    /// Time \[s\] and approach \[m\] of the last row, and whether it belongs to the last piece.
    last: Option<(f64, f64)>,
    holds: bool,
}

impl Held {
    /// Takes in a row in time, and whether its approach is prescribed.
    pub(super) fn see(&mut self, index: usize, row: &Row, is_prescribed: bool) {
        let Coordinate::Time(time) = row.coordinate else { return };
        let Some((before, approach)) = self.last.replace((time, row.approach)) else { return };
        let dt = time - before;
        // A row of no duration at the same approach ends nothing.
        let holds =
            is_prescribed && row.approach == approach && (row.capped_area > 0.0 || dt == 0.0 && self.holds);
        match self.pieces.last_mut().filter(|_| self.holds) {
            _ if !holds || dt == 0.0 => {}
            Some(piece) => piece.add(index, time, dt),
            None => {
                let what = "approach is held while cells are at the hardness";
                self.pieces.push(Piece::new(row.stage, index, time, dt, PER_COURSE, what));
            }
        }
        self.holds = holds && (self.holds || dt > 0.0);
    }

    /// The finding for the part with the fewest steps, where they are fixed and too few.
    pub(super) fn finding(&self, simulation: &Simulation) -> Option<Finding> {
        let own = |stage: usize| simulation.loading.stages.get(stage).and_then(|stage| stage.times.as_ref());
        let fixed = |stage: usize| !own(stage).unwrap_or(&simulation.times).is_adaptive();
        let long = self
            .pieces
            .iter()
            .filter(|piece| fixed(piece.stage) && piece.steps < piece.least && relaxes(simulation, piece));
        long.min_by_key(|piece| piece.steps).map(|piece| too_long(simulation, piece, true))
    }
}

/// A step in which the temperature changes the rate of a material while the load or approach changes or the other body has
/// another reduced time.
fn drifting(simulation: &Simulation, plan: &Plan, instants: &[Instant], first: usize) -> Option<Finding> {
    let clocks = simulation.parts().filter(|creep| !creep.terms.is_empty() || creep.fluidity > 0.0).count();
    let mut worst = (DRIFT, 0);
    for (n, pair) in instants.windows(2).enumerate() {
        let [before, now] = [pair[0], pair[1]];
        if now.dt == 0.0 || (before.value == now.value && clocks < 2) {
            continue;
        }
        for body in simulation.thermal.iter().filter(|body| !body.creep.terms.is_empty()) {
            let drift = body.clock.drift(now.time - now.dt, now.time);
            if drift > worst.0 {
                worst = (drift, first + n + 1);
            }
        }
    }
    let (drift, row) = worst;
    (row > 0).then(|| {
        let factor = libm::exp(drift);
        let text = format!(
            "The temperature changes the rate of a material by a factor of {} within one step ({}): load and approach are \
             off there. {}",
            digits(factor),
            rows([row; 2]),
            more_steps(simulation, drift / DRIFT)
        );
        Finding::warning(STEPS_TOO_LONG, factor, libm::exp(DRIFT), text).at(plan.exact.then_some([row; 2]))
    })
}

/// A part of a stage in which the value is monotone.
struct Piece {
    /// The stage that it begins in.
    stage: usize,
    /// Rows of the plan: the step that begins it, and the last.
    first: usize,
    last: usize,
    steps: usize,
    /// Its end, the sum of its steps and the shortest of them \[s\].
    end: f64,
    length: f64,
    shortest: f64,
    /// Its number of steps.
    least: usize,
    /// The change of the value.
    what: &'static str,
}

impl Piece {
    fn new(stage: usize, row: usize, end: f64, dt: f64, least: usize, what: &'static str) -> Self {
        Piece { stage, first: row, last: row, steps: 1, end, length: dt, shortest: dt, least, what }
    }

    fn add(&mut self, row: usize, end: f64, dt: f64) {
        self.last = row;
        self.end = end;
        self.steps += 1;
        self.length += dt;
        self.shortest = self.shortest.min(dt);
    }
}

/// The parts of a stage for which a single step is not exact; `first` is the row of its first instant.
fn courses(stage: &Stage, instants: &[Instant], first: usize, energies: bool) -> Vec<Piece> {
    if matches!(stage.course, Course::Hold | Course::Given(History::Step { .. } | History::Sine { .. })) {
        return vec![];
    }
    let largest = instants.iter().map(|i| i.value.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let mut found: Vec<(Piece, f64)> = vec![];
    let mut going = 0.0;
    let mut before = instants.first().map_or(0.0, |instant| instant.value);
    for (row, instant) in (first..).zip(instants) {
        let change = instant.value - std::mem::replace(&mut before, instant.value);
        if instant.dt == 0.0 {
            going = 0.0;
            continue;
        }
        // The start value of a ramp from the value reached is not known yet.
        let way = match change {
            0.0 => 0.0,
            _ if change.is_nan() => 1.0,
            _ => change.signum(),
        };
        match found.last_mut().filter(|_| way == going) {
            Some((course, moved)) if way != 0.0 => {
                course.add(row, instant.time, instant.dt);
                *moved += change;
            }
            _ if way != 0.0 => {
                let (least, what) = match instant.control {
                    Control::Approach => (PER_COURSE, "approach moves"),
                    Control::Load | Control::Pressure if way < 0.0 => (PER_COURSE, "load falls"),
                    _ if energies => (PER_COURSE, "load rises"),
                    _ => (PER_RISE, "load rises"),
                };
                let piece = Piece::new(instant.stage, row, instant.time, instant.dt, least, what);
                found.push((piece, change));
            }
            _ => {}
        }
        going = way;
    }
    let matters = |(_, moved): &(Piece, f64)| moved.is_nan() || moved.abs() > SMALL * largest;
    found.into_iter().filter(matters).map(|(course, _)| course).collect()
}

/// Whether the material relaxes within the times of a part, in the reduced time of each body.
fn relaxes(simulation: &Simulation, course: &Piece) -> bool {
    let end = course.end;
    let thermal = simulation.thermal.iter().map(|body| (&body.creep, Some(&body.clock)));
    std::iter::once((&simulation.creep, None)).chain(thermal).any(|(creep, clock)| {
        let factor = clock.map_or(1.0, |clock| clock.elapsed(end - course.length, end) / course.length);
        let times = course.shortest * factor / NEAR..NEAR * factor * course.length;
        let Ok(relaxation) = creep.to_relaxation() else { return false };
        let stiff = relaxation.instantaneous();
        if !stiff.is_finite() {
            // A dashpot: the relevant times are those of the springs beside it.
            return creep.terms.iter().any(|term| times.contains(&term.retardation_time));
        }
        let relaxing = relaxation.terms.iter().filter(|term| times.contains(&term.relaxation_time));
        relaxing.map(|term| term.modulus).sum::<f64>() > SHARE * stiff
    })
}

/// `located` if the rows of the part are those of the run.
fn too_long(simulation: &Simulation, course: &Piece, located: bool) -> Finding {
    let at = [course.first, course.last];
    let place = if located { format!(" ({})", rows(at)) } else { String::new() };
    let coarse =
        if course.what == "load rises" { "pressures and energies" } else { "load, approach and energies" };
    let text = format!(
        "Where the {} within {}{place} the run has {}, less than {}, while the material relaxes: {coarse} are coarse \
         there. {}",
        course.what,
        si(course.length, "s"),
        if course.steps == 1 { "1 step".to_owned() } else { format!("{} steps", course.steps) },
        course.least,
        more_steps(simulation, course.least as f64 / course.steps as f64)
    );
    let finding = Finding::warning(STEPS_TOO_LONG, course.steps as f64, course.least as f64, text);
    let finding = finding.at(located.then_some(at));
    if course.least == PER_RISE { finding.as_note() } else { finding }
}

/// A sine with few steps to a period.
fn aliased(simulation: &Simulation, n: usize, stage: &Stage, instants: &[Instant]) -> Option<Finding> {
    let Course::Given(History::Sine { frequency, amplitude, .. }) = stage.course else { return None };
    let longest = instants.iter().map(|instant| instant.dt).fold(0.0, f64::max);
    let steps = 1.0 / (frequency * longest);
    if amplitude == 0.0 || steps >= PER_PERIOD * (1.0 - 1e-9) {
        return None;
    }
    let lasts = instants.iter().map(|instant| instant.dt).sum::<f64>();
    let needed = (PER_PERIOD * frequency * lasts * (1.0 - 1e-9)).ceil();
    let of = if simulation.loading.stages.len() > 1 { format!(" of stage {}", n + 1) } else { String::new() };
    let text = format!(
        "The sine{of} of {} has {} steps per period, less than {PER_PERIOD}: the rows represent a different load. Use at \
         least {needed} steps of equal length.",
        si(frequency, "Hz"),
        digits(steps)
    );
    Some(Finding::warning(ALIASED_HISTORY, steps, PER_PERIOD, text))
}
