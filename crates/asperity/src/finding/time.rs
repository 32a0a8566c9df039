//! Steps that are too long for the history and the material.
//!
//! A step is exact where load or approach is held and where the contact grows, however long it is. Where the load falls,
//! or the approach moves, the contact goes its own way inside of a step, and the material relaxes on the way: such a
//! course must be followed in steps. So must a load that rises, where energies are asked for: approach and area are exact then,
//! but the heat on the way there is not. A periodic load must be followed in any case: a few steps to a period show
//! another load. Adaptive steps look after themselves.

use super::words::{digits, rows, si};
use super::{ALIASED_HISTORY, Finding, STEPS_TOO_LONG};
use crate::load::{Control, Course, History, Stage};
use crate::march::Simulation;
use crate::time::{Instant, Plan};

/// Steps to a period.
const PER_PERIOD: f64 = 20.0;
/// Steps to a course that goes one way.
const PER_COURSE: usize = 10;
/// Courses that move by less than this share of the largest value are scatter of a measured history.
const SMALL: f64 = 0.05;
/// Relaxation times that carry less than this share of the modulus do not matter.
const SHARE: f64 = 0.05;
/// A material relaxes during a course if one of its times is within this factor of the steps and of the course.
const NEAR: f64 = 10.0;

/// What the steps of a run, as far as they are known, do to its history.
pub(super) fn of(simulation: &Simulation) -> Vec<Finding> {
    let plan = simulation.plan();
    let mut found = vec![];
    let mut long: Option<Piece> = None;
    let energies = simulation.quantities.list.iter().any(|quantity| quantity.is_energy());
    for (n, stage) in simulation.loading.stages.iter().enumerate() {
        if stage.times.as_ref().unwrap_or(&simulation.times).is_adaptive() {
            continue;
        }
        let first =
            plan.instants.iter().position(|instant| instant.stage == n).unwrap_or(plan.instants.len());
        let count = plan.instants[first..].iter().take_while(|instant| instant.stage == n).count();
        let instants = &plan.instants[first..first + count];
        found.extend(aliased(simulation, n, stage, instants));
        for course in courses(stage, instants, energies) {
            let course = Piece { first: first + course.first, last: first + course.last, ..course };
            let fewer = long.as_ref().is_none_or(|other| course.steps < other.steps);
            if course.steps < PER_COURSE && fewer && relaxes(simulation, &plan, &course) {
                long = Some(course);
            }
        }
    }
    found.extend(long.map(|course| too_long(&plan, &course)));
    found
}

/// A part of a stage in which the value goes one way.
struct Piece {
    /// Rows of the plan: the step that begins it, and the last.
    first: usize,
    last: usize,
    steps: usize,
    /// Sum of its steps and the shortest of them \[s\].
    length: f64,
    shortest: f64,
    /// What moves, and which way.
    moves: &'static str,
}

/// The courses of a stage that a step does not follow by itself, or whose `energies` it does not.
fn courses(stage: &Stage, instants: &[Instant], energies: bool) -> Vec<Piece> {
    if matches!(stage.course, Course::Hold | Course::Given(History::Step { .. } | History::Sine { .. })) {
        return vec![];
    }
    let largest = instants.iter().map(|i| i.value.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let mut found: Vec<(Piece, f64)> = vec![];
    let mut going = 0.0;
    let mut before = instants.first().map_or(0.0, |instant| instant.value);
    for (n, instant) in instants.iter().enumerate() {
        let change = instant.value - std::mem::replace(&mut before, instant.value);
        if instant.dt == 0.0 {
            going = 0.0;
            continue;
        }
        // What a ramp from the value reached begins at is not known yet.
        let way = if change.is_nan() {
            1.0
        } else if change == 0.0 {
            0.0
        } else {
            change.signum()
        };
        match found.last_mut().filter(|_| way == going) {
            Some((course, moved)) if way != 0.0 => {
                course.last = n;
                course.steps += 1;
                course.length += instant.dt;
                course.shortest = course.shortest.min(instant.dt);
                *moved += change;
            }
            _ if way != 0.0 => found.push((
                Piece {
                    first: n,
                    last: n,
                    steps: 1,
                    length: instant.dt,
                    shortest: instant.dt,
                    moves: match instant.control {
                        Control::Approach => "approach moves",
                        Control::Load | Control::Pressure if way < 0.0 => "load falls",
                        Control::Load | Control::Pressure => "load rises",
                    },
                },
                change,
            )),
            _ => {}
        }
        going = way;
    }
    let matters = |(course, moved): &(Piece, f64)| match instants[course.first].control {
        Control::Load | Control::Pressure if !energies => *moved < -SMALL * largest,
        _ => moved.is_nan() || moved.abs() > SMALL * largest,
    };
    found.into_iter().filter(matters).map(|(course, _)| course).collect()
}

/// Whether the material relaxes on the times of a course, on the clock of each body.
fn relaxes(simulation: &Simulation, plan: &Plan, course: &Piece) -> bool {
    let end = plan.instants[course.last].time;
    let clocks = simulation.thermal.iter().map(|body| (&body.creep, Some(&body.clock)));
    std::iter::once((&simulation.creep, None)).chain(clocks).any(|(creep, clock)| {
        let factor = clock.map_or(1.0, |clock| clock.elapsed(end - course.length, end) / course.length);
        let Ok(relaxation) = creep.to_relaxation() else { return false };
        let stiff = relaxation.instantaneous();
        relaxation.terms.iter().any(|term| {
            let matters = !stiff.is_finite() || term.modulus > SHARE * stiff;
            let times = course.shortest * factor / NEAR..NEAR * factor * course.length;
            matters && times.contains(&term.relaxation_time)
        })
    })
}

fn too_long(plan: &Plan, course: &Piece) -> Finding {
    let what = course.moves;
    let at = [course.first, course.last];
    let place = if plan.exact { format!(" ({})", rows(at)) } else { String::new() };
    let text = format!(
        "Where the {what} within {}{place} there are {} steps, less than {PER_COURSE}, while the material relaxes: load, \
         approach and energies are coarse there. Take more steps, or spacing = \"adaptive\".",
        si(course.length, "s"),
        course.steps
    );
    let finding = Finding::warning(STEPS_TOO_LONG, course.steps as f64, PER_COURSE as f64, text);
    if plan.exact { finding.at(at) } else { finding }
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
        "The sine{of} of {} has {} steps to a period, less than {PER_PERIOD}: the rows show another load than the one \
         given. Take at least {needed} steps of equal length.",
        si(frequency, "Hz"),
        digits(steps)
    );
    Some(Finding::warning(ALIASED_HISTORY, steps, PER_PERIOD, text))
}
