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
fn run(schedule: Schedule, answer: impl Fn(&Interval) -> Summary) -> (Vec<Instant>, usize, StopReason) {
    let (rows, attempts, reason) = run_to_the_end(schedule, |step| Some(answer(step)));
    (rows, attempts, reason.unwrap())
}

/// The same, where attempts may find no equilibrium; no reason where no other attempt is left.
fn run_to_the_end(
    mut schedule: Schedule,
    answer: impl Fn(&Interval) -> Option<Summary>,
) -> (Vec<Instant>, usize, Option<StopReason>) {
    let (mut rows, mut attempts) = (vec![], 0);
    loop {
        let mut step = match schedule.propose().unwrap() {
            Proposal::Try(step) => step,
            Proposal::Done(reason) => return (rows, attempts, Some(reason)),
        };
        loop {
            attempts += 1;
            let Some(attempt) = answer(&step) else {
                match schedule.retreat(&step, true) {
                    Some(shorter) => step = shorter,
                    None => return (rows, attempts, None),
                }
                continue;
            };
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
    let StopReason::Missed { stage: 0, event: Event::Load(9.0), reached: at_end, .. } = reason else {
        panic!("{reason:?}")
    };
    assert_eq!(at_end, reached);
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
fn an_event_before_the_last_equilibrium_is_found() {
    // A pull that grows as t has no equilibrium beyond t = 1.3; the approach falls as sqrt(1.3 - t).
    let answer = |step: &Interval| {
        let time = step.instant.time;
        let reached = Response { approach: (1.3 - time).max(0.0).sqrt(), load: -time };
        let error = step.is_adaptive.then_some(1e-9);
        (time < 1.3).then_some(Summary { pulls: true, touches: true, error, reached, ..reaches(step, 1.0) })
    };
    let pull =
        |until| Stage { until, ..Stage::new(Control::Load, History::Ramp { value: -2.0, duration: 2.0 }) };
    let adaptive = TimeGrid::Adaptive { end: 2.0, tolerance: 1e-3, first: 0.5 };
    for times in [TimeGrid::Uniform { end: 2.0, steps: 4 }, adaptive] {
        let (rows, _, reason) =
            run_to_the_end(plan(vec![pull(Some(Event::Approach(0.3)))], times.clone()), answer);
        let last = rows.last().unwrap().time;
        // To a millionth of the largest approach, 1.14: 7e-7 of the time.
        assert!((last - (1.3 - 0.09)).abs() < 1e-6, "{last}");
        assert_eq!(reason, Some(StopReason::Complete));
        // What is never reached ends with the last equilibrium, and the end of contact is met there.
        let (rows, attempts, reason) =
            run_to_the_end(plan(vec![pull(Some(Event::Approach(-1.0)))], times.clone()), answer);
        assert!(reason.is_none() && attempts < rows.len() + 40, "{attempts}");
        assert!((rows.last().unwrap().time - 1.3).abs() < 1e-3);
        let (rows, _, reason) = run_to_the_end(plan(vec![pull(Some(Event::ContactLost))], times), answer);
        assert_eq!(reason, Some(StopReason::Complete));
        assert!((rows.last().unwrap().time - 1.3).abs() < 1e-3);
    }
}

#[test]
fn an_error_of_the_step_counts_while_the_last_equilibrium_is_sought() {
    let answer = |step: &Interval| {
        let error = Some(step.length() * step.length());
        (step.instant.time < 1.3).then_some(Summary { pulls: true, error, ..reaches(step, -1.0) })
    };
    let times = TimeGrid::Adaptive { end: 2.0, tolerance: 0.125, first: 1.9 };
    let pull = Stage::new(Control::Load, History::Ramp { value: -2.0, duration: 2.0 });
    let (rows, _, reason) = run_to_the_end(plan(vec![pull], times), answer);
    // A step may take 0.08 of the tolerance: 0.1 s.
    assert!(reason.is_none() && rows.iter().all(|row| row.dt <= 0.1 + 1e-12), "{rows:?}");
    assert!((rows.last().unwrap().time - 1.3).abs() < 1e-3);
}

#[test]
fn events_are_met_from_where_the_last_jump_has_led() {
    // Random tables with jumps under control of the approach; the load is that of a body that relaxes, or the approach itself.
    let mut state = 7_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut met, mut missed) = (0, 0);
    for case in 0..200 {
        let mut points = vec![(0.0, 0.2 + random())];
        for n in 1..5 {
            let time = f64::from(n) * 0.8;
            points.push((time, 0.2 + random()));
            if random() < 0.5 {
                points.push((time, 0.2 + random()));
            }
        }
        let history = History::Table { points: points.clone() };
        let relaxes = case % 2 == 0;
        let load = |time: f64, value: f64| if relaxes { value * (0.4 + 0.6 * (-time).exp()) } else { value };
        let value = 0.2 + random();
        let stage =
            Stage { until: Some(Event::Load(value)), ..Stage::new(Control::Approach, history.clone()) };
        let times = match case % 3 {
            0 => TimeGrid::Uniform { end: 4.0, steps: 40 },
            1 => TimeGrid::Uniform { end: 4.0, steps: 400 },
            _ => TimeGrid::Adaptive { end: 4.0, tolerance: 1e-3, first: 0.01 },
        };
        let (rows, _, reason) = run(plan(vec![stage], times), |step| {
            let Instant { time, value, .. } = step.instant;
            let error = step.is_adaptive.then_some(0.05 * step.length() * step.length());
            Summary {
                error,
                reached: Response { approach: value, load: load(time, value) },
                ..reaches(step, 1.0)
            }
        });
        let last = rows.last().unwrap();
        let signals: Vec<f64> = rows.iter().map(|row| load(row.time, row.value) - value).collect();
        // To a millionth of the largest load, at most 1.2.
        let tolerance = 1.3e-6;
        let end = rows.len() - usize::from(reason == StopReason::Complete);
        let mut side = 0.0;
        for (row, signal) in rows.iter().zip(&signals).take(end) {
            side = if row.jump || side == 0.0 { signal.signum() } else { side };
            assert!(side * signal > -tolerance, "case {case}: the value is passed at {} s", row.time);
        }
        match reason {
            StopReason::Complete => {
                met += 1;
                assert!(signals[end].abs() <= tolerance, "case {case}: {last:?} {}", signals[end]);
            }
            StopReason::Missed { .. } => {
                missed += 1;
                assert_eq!(last.time, 4.0);
            }
        }
    }
    assert!(met > 50 && missed > 20, "{met} {missed}");
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
