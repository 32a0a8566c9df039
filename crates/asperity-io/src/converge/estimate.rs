//! From the answers of several runs to their errors.
//!
//! With h the size of the cells and Q(h) an answer whose error falls as h^p, the error of Q(h) is |Q(h) - Q(2h)|/(2^p - 1). The order
//! of contact areas is about 1 and scatters, because whole cells join the contact; so p = 1 is assumed, and the estimate is the largest
//! of |Q(h) - Q(2h)|, |Q(2h) - Q(4h)|/2 and what whole cells at the edge of the contact leave open ([`Answer::resolution`]). With a finer grid the observed order p = log2(|Q(h) - Q(2h)|/|Q(h/2) - Q(h)|), between
//! 1/2 and 2, extrapolates: Q(h/2) + (Q(h/2) - Q(h))/(2^p - 1).
//!
//! The estimate of the grid is multiplied by a factor of safety. What the steps and the tolerance cause is how much the answer moves with
//! steps of twice the length and ten times the tolerance: from above, as the errors of the run itself are smaller than those of the
//! coarser one. With steps of half the length it is twice what the answer moves: an error that falls as the power p of the length is
//! |Q(t) - Q(t/2)|/(1 - 2^-p), which is twice the difference for p = 1 and less for a larger p. The error is the root of the sum of the
//! three squares.

use super::ErrorBar;
use crate::answer::Answer;

/// Factor of safety on the estimate with three grids, and on one with two (Roache 1994: 1.25 and 3).
const SAFETY: [f64; 2] = [1.25, 3.0];
/// The order is taken between these.
const ORDERS: [f64; 2] = [0.5, 2.0];

/// The answers of the variations.
pub(super) struct Runs {
    pub half: Option<Vec<Answer>>,
    pub quarter: Option<Vec<Answer>>,
    pub double: Option<Vec<Answer>>,
    /// Other steps and the looser tolerance, on the coarser grid where there is one.
    pub steps: Steps,
    pub loose: Option<Vec<Answer>>,
    /// Whether the pressure grows without end somewhere as the cells shrink.
    pub is_singular: bool,
}

/// Answers that have no value on ever finer grids where the pressure is singular, by how their names begin.
const OF_LARGEST_PRESSURE: [&str; 3] = ["max_pressure", "max_mises", "first_yield"];

/// What the steps in time cause.
pub(super) enum Steps {
    /// No error.
    Nothing,
    /// It is not known: they could be made neither longer nor shorter.
    Unknown,
    /// An error as large as the distance from these answers times `factor`.
    Varied { answers: Vec<Answer>, factor: f64 },
}

/// The answer of a run by its name; NaN if the run has it without a value.
fn of(run: Option<&Vec<Answer>>, name: &str) -> Option<f64> {
    run?.iter().find(|answer| answer.name == name).map(|answer| answer.value)
}

/// The error of each answer.
pub(super) fn bars(answers: &[Answer], runs: &Runs, extrapolate: bool) -> Vec<ErrorBar> {
    answers.iter().map(|answer| bar(answer, runs, extrapolate)).collect()
}

fn bar(answer: &Answer, runs: &Runs, extrapolate: bool) -> ErrorBar {
    let name = answer.name.as_str();
    let at = |run: &Option<Vec<Answer>>| of(run.as_ref(), name).filter(|value| value.is_finite());
    let [half, quarter, double] = [&runs.half, &runs.quarter, &runs.double].map(at);
    let own = answer.value;
    let mut note = String::new();
    // A value that the answer has on one grid and not on the other.
    if runs.half.is_some() && half.is_none() && own.is_finite() {
        note = "a coarser grid has no such answer".into();
    }
    let (mut value, mut order) = (own, None);
    let mut grid = grid_error(own, [half, quarter, double]);
    if let (Some(half), Some(double), true) = (half, double, extrapolate) {
        let (coarse, fine) = ((own - half).abs(), (double - own).abs());
        let p = if fine > 0.0 { (coarse / fine).log2().clamp(ORDERS[0], ORDERS[1]) } else { ORDERS[1] };
        let rest = (double - own) / (p.exp2() - 1.0);
        (value, order) = (double + rest, Some(p));
        // The extrapolated value is off by no more than the step from the finest grid.
        grid = Some(rest.abs().max(fine / 2.0));
    }
    if runs.is_singular && OF_LARGEST_PRESSURE.iter().any(|begin| name.starts_with(begin)) {
        (grid, value, order) = (None, own, None);
        note =
            "not resolved: at a sharp edge or tip the pressure grows without end as the cells shrink".into();
    }
    let grids = [half, quarter, double].iter().flatten().count();
    let safety = SAFETY[usize::from(grids < 2)];
    // Times, velocities and extremes are known to what the distance of the rows leaves open, areas to the cells.
    let [of_cells, of_rows] = [answer.resolution, answer.between_rows];
    grid = grid.map(|grid| safety * grid.max(of_cells));
    // The steps and the tolerance are varied on the coarser grid.
    let from = if runs.half.is_some() { half } else { Some(own) };
    let moved =
        |run: Option<&Vec<Answer>>| Some((of(run, name).filter(|value| value.is_finite())? - from?).abs());
    let time = match &runs.steps {
        Steps::Nothing => Some(of_rows),
        Steps::Unknown => None,
        Steps::Varied { answers, factor } => moved(Some(answers)).map(|time| (factor * time).max(of_rows)),
    };
    if time.is_none() && note.is_empty() {
        note = "the steps were not varied: their error is not known".into();
    }
    let solver = moved(runs.loose.as_ref());
    let error = match (grid, time, solver) {
        (Some(grid), Some(time), Some(solver)) => Some((grid * grid + time * time + solver * solver).sqrt()),
        _ => None,
    };
    let known = |number: f64| Some(number).filter(|number| number.is_finite());
    let (value, error) = (known(value), error.and_then(known));
    ErrorBar { value, error, grid, time, solver, order, note, ..ErrorBar::of(answer, f64::NAN) }
}

/// What the grid causes, from the same answer with half, a quarter or twice the cells.
fn grid_error(own: f64, [half, quarter, double]: [Option<f64>; 3]) -> Option<f64> {
    if !own.is_finite() {
        return None;
    }
    let coarser = half.map(|half| {
        let before = quarter.map_or(0.0, |quarter| 0.5 * (half - quarter).abs());
        (own - half).abs().max(before)
    });
    // Of first order the grid itself is off by twice what halving its cells moves the answer.
    let finer = double.map(|double| 2.0 * (own - double).abs());
    match (coarser, finer) {
        (Some(coarser), _) => Some(coarser),
        (None, finer) => finer,
    }
}
