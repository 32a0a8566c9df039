//! A stage that is prescribed between two rows, as numbers of a checkpoint.
//!
//! The list begins with the control and the kind of the course, and ends with the numbers of the course.

use crate::load::{Control, Course, History, Stage};

const CONTROLS: [Control; 3] = [Control::Load, Control::Pressure, Control::Approach];

/// The numbers of a stage without an end.
pub(super) fn numbers(stage: &Stage) -> Vec<f64> {
    let control = CONTROLS.iter().position(|control| *control == stage.control).unwrap_or_default();
    let (kind, own) = match &stage.course {
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
    [vec![control as f64, f64::from(kind)], own].concat()
}

/// The stage of these numbers; `None` where they are of none.
pub(super) fn stage(numbers: &[f64]) -> Option<Stage> {
    let [control, kind, own @ ..] = numbers else { return None };
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
    Some(Stage::new(*CONTROLS.get(*control as usize)?, course))
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
        for foreign in [&[][..], &[0.0, 9.0], &[3.0, 0.0], &[0.0, 2.0]] {
            assert_eq!(stage(foreign), None);
        }
    }
}
