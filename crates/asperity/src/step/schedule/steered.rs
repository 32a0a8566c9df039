//! A stage that is prescribed between two rows, as numbers of a checkpoint.
//!
//! ```text
//! control, duration, whether the event counts after the jump | kind of the event, its number, its value |
//! kind of the times, how many numbers, these | kind of the course, its numbers
//! ```
//!
//! NaN stands for none.

use crate::load::{Control, Course, Event, History, Stage};
use crate::quantities::RowNumber;
use crate::time::TimeGrid;

const CONTROLS: [Control; 3] = [Control::Load, Control::Pressure, Control::Approach];

/// The numbers of a stage.
pub(super) fn numbers(stage: &Stage) -> Vec<f64> {
    let control = CONTROLS.iter().position(|control| *control == stage.control).unwrap_or_default();
    let head = [control as f64, stage.duration.unwrap_or(f64::NAN), f64::from(u8::from(stage.after_jump))];
    let (kind, times) = numbers_of_times(stage.times.as_ref());
    let times = [vec![kind, times.len() as f64], times].concat();
    [head.to_vec(), numbers_of_event(stage.until).to_vec(), times, numbers_of_course(&stage.course)].concat()
}

fn numbers_of_event(event: Option<Event>) -> [f64; 3] {
    match event {
        None => [0.0, f64::NAN, f64::NAN],
        Some(Event::ContactLost) => [1.0, f64::NAN, f64::NAN],
        Some(Event::Approach(value)) => [2.0, f64::NAN, value],
        Some(Event::Load(value)) => [3.0, f64::NAN, value],
        Some(Event::Pressure(value)) => [4.0, f64::NAN, value],
        Some(Event::Number(number, value)) => {
            let index = RowNumber::all().position(|own| own.name() == number.name());
            [5.0, index.map_or(f64::NAN, |index| index as f64), value]
        }
    }
}

/// The inner `None` is no event.
fn event([kind, index, value]: [f64; 3]) -> Option<Option<Event>> {
    Some(match kind as u8 {
        0 => None,
        1 => Some(Event::ContactLost),
        2 => Some(Event::Approach(value)),
        3 => Some(Event::Load(value)),
        4 => Some(Event::Pressure(value)),
        5 => Some(Event::Number(RowNumber::all().nth(index as usize)?, value)),
        _ => return None,
    })
}

fn numbers_of_times(times: Option<&TimeGrid>) -> (f64, Vec<f64>) {
    match times {
        None => (0.0, vec![]),
        Some(TimeGrid::Uniform { end, steps }) => (1.0, vec![*end, *steps as f64]),
        Some(TimeGrid::Logarithmic { end, steps, first }) => (2.0, vec![*end, *steps as f64, *first]),
        Some(TimeGrid::List(times)) => (3.0, times.clone()),
        Some(TimeGrid::Adaptive { end, tolerance, first }) => (4.0, vec![*end, *tolerance, *first]),
    }
}

/// The inner `None` are the times of the run.
fn times(kind: f64, own: &[f64]) -> Option<Option<TimeGrid>> {
    Some(match (kind as u8, own) {
        (0, []) => None,
        (1, &[end, steps]) => Some(TimeGrid::Uniform { end, steps: steps as usize }),
        (2, &[end, steps, first]) => Some(TimeGrid::Logarithmic { end, steps: steps as usize, first }),
        (3, times) => Some(TimeGrid::List(times.to_vec())),
        (4, &[end, tolerance, first]) => Some(TimeGrid::Adaptive { end, tolerance, first }),
        _ => return None,
    })
}

fn numbers_of_course(course: &Course) -> Vec<f64> {
    let (kind, own) = match course {
        Course::Hold => (0, vec![]),
        Course::RampTo { value, duration } => (1, vec![*value, *duration]),
        Course::Given(history) => match history {
            History::Step { value } => (2, vec![*value]),
            History::Ramp { value, duration } => (3, vec![*value, *duration]),
            History::Triangle { peak, rise, fall } => (4, vec![*peak, *rise, *fall]),
            History::Trapezoid { peak, rise, hold, fall } => (5, vec![*peak, *rise, *hold, *fall]),
            History::Sine { mean, amplitude, frequency } => (6, vec![*mean, *amplitude, *frequency]),
            History::Table { points } => (7, points.iter().flat_map(|point| [point.0, point.1]).collect()),
        },
    };
    [vec![f64::from(kind)], own].concat()
}

/// The stage of these numbers; `None` where they are of none.
pub(super) fn stage(numbers: &[f64]) -> Option<Stage> {
    let [control, duration, after_jump, happens, number, value, spacing, count, rest @ ..] = numbers else {
        return None;
    };
    let (own_times, [kind, own @ ..]) = rest.split_at_checked(*count as usize)? else { return None };
    let course = match (*kind as u8, own) {
        (0, []) => Course::Hold,
        (1, &[value, duration]) => Course::RampTo { value, duration },
        (2, &[value]) => History::Step { value }.into(),
        (3, &[value, duration]) => History::Ramp { value, duration }.into(),
        (4, &[peak, rise, fall]) => History::Triangle { peak, rise, fall }.into(),
        (5, &[peak, rise, hold, fall]) => History::Trapezoid { peak, rise, hold, fall }.into(),
        (6, &[mean, amplitude, frequency]) => History::Sine { mean, amplitude, frequency }.into(),
        (7, points) => {
            History::Table { points: points.chunks_exact(2).map(|point| (point[0], point[1])).collect() }
                .into()
        }
        _ => return None,
    };
    Some(Stage {
        duration: Some(*duration).filter(|duration| !duration.is_nan()),
        until: event([*happens, *number, *value])?,
        after_jump: *after_jump == 1.0,
        times: times(*spacing, own_times)?,
        ..Stage::new(*CONTROLS.get(*control as usize)?, course)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_course_comes_back() {
        let courses: [Course; 8] = [
            Course::Hold,
            Course::RampTo { value: -1.5, duration: 2.0 },
            History::Step { value: 0.1 }.into(),
            History::Ramp { value: 0.3, duration: 2.0 }.into(),
            History::Triangle { peak: 1.0, rise: 2.0, fall: 3.0 }.into(),
            History::Trapezoid { peak: 1.0, rise: 2.0, hold: 3.0, fall: 4.0 }.into(),
            History::Sine { mean: 1.0, amplitude: 0.5, frequency: 7.0 }.into(),
            History::Table { points: vec![(0.0, 1.0), (1.0, 2.0), (1.0, 3.0)] }.into(),
        ];
        for (course, control) in courses.into_iter().zip(CONTROLS.into_iter().cycle()) {
            let given = Stage::new(control, course);
            assert_eq!(stage(&numbers(&given)), Some(given));
        }
        let held = numbers(&Stage::new(Control::Load, Course::Hold));
        for (place, number) in [(0, 3.0), (3, 6.0), (6, 5.0), (7, 9.0), (8, 2.0)] {
            let mut foreign = held.clone();
            foreign[place] = number;
            assert_eq!(stage(&foreign), None, "{place}");
        }
        assert_eq!(stage(&held[..8]), None);
    }

    #[test]
    fn every_event_and_all_times_come_back() {
        let fraction = RowNumber::from_name("contact_fraction").unwrap();
        let events = [
            Event::ContactLost,
            Event::Approach(1.0),
            Event::Load(2.0),
            Event::Pressure(3.0),
            Event::Number(fraction, 0.1),
        ];
        let grids = [
            TimeGrid::Uniform { end: 1.0, steps: 3 },
            TimeGrid::Logarithmic { end: 1.0, steps: 3, first: 0.1 },
            TimeGrid::List(vec![0.1, 0.5]),
            TimeGrid::Adaptive { end: 2.0, tolerance: 1e-3, first: 1e-2 },
        ];
        for (event, times) in events.into_iter().zip(grids.into_iter().cycle()) {
            let given = Stage {
                until: Some(event),
                duration: Some(4.0),
                after_jump: true,
                times: Some(times),
                ..Stage::new(Control::Approach, Course::RampTo { value: 1.0, duration: 2.0 })
            };
            assert_eq!(stage(&numbers(&given)), Some(given));
        }
    }
}
