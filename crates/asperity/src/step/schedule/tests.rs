//! The schedule alone: attempts are answered by functions of time, without a contact.

use super::*;
use crate::grid::Grid;
use crate::load::{Course as Prescribed, Programme};
use ndarray::Array2;

fn plan(stages: Vec<Stage>, times: TimeGrid) -> Schedule {
    let grid = Grid::new([1, 1], [2.0, 1.0]).unwrap();
    let loading = Programme::new(stages);
    Schedule::new(&Arc::new(Simulation { loading, times, ..Simulation::new(grid, Array2::zeros((1, 1))) }))
}

/// Rows and attempts of a schedule whose attempts end as `answer` says.
fn run(mut schedule: Schedule, answer: impl Fn(&Interval) -> Summary) -> (Vec<Instant>, usize, StopReason) {
    let (mut rows, mut attempts) = (vec![], 0);
    loop {
        let mut step = match schedule.propose().unwrap() {
            Proposal::Try(step) => step,
            Proposal::Done(reason) => return (rows, attempts, reason),
        };
        loop {
            attempts += 1;
            let attempt = answer(&step);
            match schedule.assess(&step, &attempt) {
                Some(next) => step = next,
                None => {
                    schedule.accept(&attempt);
                    rows.push(attempt.instant);
                    break;
                }
            }
        }
    }
}

/// An attempt that reaches this load, without error.
fn reaches(step: &Interval, load: f64) -> Summary {
    Summary {
        instant: step.instant,
        error: step.is_adaptive.then_some(0.0),
        is_turn: false,
        touches: load != 0.0,
        pulls: false,
        reached: Response { approach: 1.0, load },
        number: f64::NAN,
        first_touch: 0.0,
    }
}

#[test]
fn given_steps_are_proposed_once_each() {
    let stage = Stage::new(Control::Load, History::Ramp { value: 3.0, duration: 2.0 });
    let (rows, attempts, reason) = run(plan(vec![stage], TimeGrid::Uniform { end: 4.0, steps: 4 }), |step| {
        reaches(step, step.instant.value)
    });
    let shown: Vec<_> = rows.iter().map(|row| (row.time, row.value)).collect();
    assert_eq!(shown, [(0.0, 0.0), (1.0, 1.5), (2.0, 3.0), (3.0, 3.0), (4.0, 3.0)]);
    assert_eq!((attempts, reason), (5, StopReason::Complete));
}

#[test]
fn adaptive_steps_are_tried_shorter_until_their_error_is_small_enough() {
    // The error of a step is its length squared.
    let times = TimeGrid::Adaptive { end: 10.0, tolerance: 0.125, first: 5.0 };
    let stage = Stage::new(Control::Load, History::Step { value: 1.0 });
    let (rows, attempts, _) = run(plan(vec![stage], times), |step| {
        let error = Some(step.length() * step.length());
        Summary { error, ..reaches(step, 1.0) }
    });
    // A step may take 0.08 of the tolerance: 0.1 s.
    assert!(rows.iter().all(|row| row.dt <= 0.1 + 1e-12));
    assert!(rows.last().unwrap().time == 10.0 && rows.len() < 150 && attempts < rows.len() + 10);
}

#[test]
fn a_stage_ends_where_its_event_happens_and_the_next_goes_on_from_there() {
    // The load relaxes as exp(-t) and is to fall to 0.3; the approach is held after that.
    let relax = Stage {
        until: Some(Event::Load(0.3)),
        after_jump: true,
        ..Stage::new(Control::Approach, History::Step { value: 1.0 })
    };
    let rest = Stage::new(Control::Approach, Prescribed::Hold);
    let (rows, _, reason) = run(plan(vec![relax, rest], TimeGrid::Uniform { end: 3.0, steps: 3 }), |step| {
        reaches(step, (-step.instant.time).exp())
    });
    let found = rows.iter().rfind(|row| row.stage == 0).unwrap();
    // To a millionth of the largest load.
    assert!(((-found.time).exp() - 0.3).abs() < 1e-6, "{}", found.time);
    assert!(rows.iter().any(|row| row.stage == 1 && row.value == 1.0) && reason == StopReason::Complete);
}

#[test]
fn what_never_happens_is_a_reason_to_stop() {
    let wait = Stage {
        until: Some(Event::Load(9.0)),
        ..Stage::new(Control::Approach, History::Step { value: 1.0 })
    };
    let (rows, _, reason) =
        run(plan(vec![wait], TimeGrid::Uniform { end: 3.0, steps: 3 }), |step| reaches(step, 2.0));
    let reached = Response { approach: 1.0, load: 2.0 };
    assert_eq!(reason, StopReason::Missed { stage: 0, event: Event::Load(9.0), reached });
    assert!(rows.len() == 4 && reason.outcome(3.0).is_err());
}

#[test]
fn a_load_of_nothing_is_lost_contact_only_where_nothing_pulls() {
    for pulls in [false, true] {
        let unload = Stage {
            until: Some(Event::Load(0.0)),
            ..Stage::new(Control::Load, History::Ramp { value: -1.0, duration: 2.0 })
        };
        let answer = |step: &Interval| {
            let load = 0.5 + step.instant.value;
            let touches = pulls || load > 0.0;
            Summary { pulls, touches, ..reaches(step, if touches { load } else { 0.0 }) }
        };
        let (rows, _, _) = run(plan(vec![unload], TimeGrid::Uniform { end: 2.0, steps: 2 }), answer);
        let last = rows.last().unwrap();
        assert!((last.time - 1.0).abs() < 1e-5, "{pulls}: {}", last.time);
    }
}

#[test]
fn a_sine_of_load_has_as_many_adaptive_steps_as_the_tolerance_asks_for() {
    let sine = |mean: f64| History::Sine { mean, amplitude: 1.0, frequency: 0.5 };
    let steps =
        |history: &History, control: Control, tolerance: f64| 2.0 / longest(history, control, tolerance);
    // (2 pi/n)²/8 of the amplitude over the largest load.
    assert!((steps(&sine(1.0), Control::Load, 1e-4) - TAU * (0.5_f64 / 8e-4).sqrt()).abs() < 1e-9);
    assert!((steps(&sine(1.0), Control::Load, 1e-2) - STEPS_PER_PERIOD).abs() < 1e-9);
    assert!((steps(&sine(1.0), Control::Approach, 1e-4) - STEPS_PER_PERIOD).abs() < 1e-9);
    assert_eq!(longest(&History::Step { value: 1.0 }, Control::Load, 1e-4), f64::INFINITY);
}
