//! From the answers of several runs to their errors.
//!
//! With h the size of the cells and Q(h) an answer whose error falls as h, Q(h) - Q(0) is
//!
//! ```text
//! |Q(a h) - Q(b h)|/(b - a)        for any two grids with cells of a h and b h
//! ```
//!
//! and the estimate is the largest of these over all pairs with b >= 3/2 a: two grids that agree by chance do not hide what a third one
//! shows. It is no less than what is known without other grids: what whole cells at the edge of the contact leave open
//! ([`Answer::of_cells`]). With cells of h, 2h and 4h the observed order p = log2(|Q(2h) - Q(4h)|/|Q(h) - Q(2h)|) counts where it is below 1: then
//! the error is |Q(h) - Q(2h)|/(2^p - 1), with p = 1/2 at least. A pressure that changes by as much from h to 2h as from 2h to 4h or more
//! (p near 0 or below) shows no limit, so its error is not known.
//!
//! With a finer grid the observed order, between 1/2 and 2, extrapolates: Q(h/2) + (Q(h/2) - Q(h))/(2^p - 1).
//!
//! The estimate of the grid is multiplied by a factor of safety. What the steps and the tolerance cause is how much the answer moves with
//! steps of twice the length and ten times the tolerance: from above, as the errors of the run itself are smaller than those of the
//! coarser one. With steps of half the length it is twice what the answer moves: an error that falls as the power p of the length is
//! |Q(t) - Q(t/2)|/(1 - 2^-p), which is twice the difference for p = 1 and less for a larger p. The error is the root of the sum of the
//! three squares.

use super::ErrorBar;
use crate::answer::Answer;

/// Factor of safety on the estimate with cells of h, 2h and 4h, with three grids that are closer to each other, and with two (Roache 1994:
/// 1.25 with three and 3 with two).
const SAFETY: [f64; 3] = [1.25, 2.0, 3.0];
/// The order is taken between these.
const ORDERS: [f64; 2] = [0.5, 2.0];
/// A pair of grids says something if its cells differ by this factor.
const APART: f64 = 1.5;
/// A pressure shows no limit where halving the cells moves it by more than this share, and by more than this share of what an answer does that
/// goes with the logarithm of the cells.
const GROWS: [f64; 2] = [0.05, 0.9];

/// Rounding of an answer, relative.
const ROUNDING: f64 = 1e-12;

/// The answers of the variations.
pub(super) struct Runs {
    pub half: Option<Vec<Answer>>,
    pub quarter: Option<Vec<Answer>>,
    pub three_quarters: Option<Vec<Answer>>,
    pub double: Option<Vec<Answer>>,
    /// Other steps and the looser tolerance, on the coarser grid where there is one.
    pub steps: Steps,
    pub loose: Option<Vec<Answer>>,
}

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

/// The error of an answer; `singular` says why it has no value on ever finer grids, where it has none.
pub(super) fn bar(answer: &Answer, singular: Option<&str>, runs: &Runs, extrapolate: bool) -> ErrorBar {
    let name = answer.name.as_str();
    let grids = Grids::of(answer, runs);
    let [half, double] = [2.0, 0.5].map(|size| grids.at(size));
    let own = answer.value;
    let mut note = String::new();
    // A value that the answer has on one grid and not on the other.
    if runs.half.is_some() && half.is_none() && own.is_finite() {
        note = "a coarser grid has no such answer".into();
    }
    let (mut value, mut order) = (own, None);
    let mut grid = grids.error();
    if let (Some(half), Some(double), true) = (half, double, extrapolate) {
        let (coarse, fine) = ((own - half).abs(), (double - own).abs());
        let p = if fine > 0.0 { (coarse / fine).log2().clamp(ORDERS[0], ORDERS[1]) } else { ORDERS[1] };
        let rest = (double - own) / (p.exp2() - 1.0);
        (value, order) = (double + rest, Some(p));
        // The extrapolated value is off by no more than the step from the finest grid.
        grid = Some(rest.abs().max(fine / 2.0));
    }
    let grows = answer.unit == "Pa" && grids.show_no_limit(answer.of_cells);
    let growing = grows.then_some("it changes from grid to grid without a sign of a limit");
    if let Some(why) = singular.or(growing) {
        (grid, value, order) = (None, own, None);
        note = format!("not resolved: {why}");
    }
    grid = grid.map(|grid| grids.safety() * grid.max(answer.of_cells));
    // The steps and the tolerance are varied on the coarser grid.
    let from = if runs.half.is_some() { half } else { Some(own) };
    let moved =
        |run: Option<&Vec<Answer>>| Some((of(run, name).filter(|value| value.is_finite())? - from?).abs());
    let time = match &runs.steps {
        Steps::Nothing => Some(answer.of_rows),
        Steps::Unknown => None,
        Steps::Varied { answers, factor } => {
            moved(Some(answers)).map(|time| (factor * time).max(answer.of_rows))
        }
    };
    let time = time.filter(|time| time.is_finite());
    if answer.of_rows == f64::INFINITY {
        note = format!("not resolved: {}", answer.note);
    } else if time.is_none() && note.is_empty() {
        note = "the steps were not varied: their error is not known".into();
    }
    let solver = moved(runs.loose.as_ref()).map(|solver| solver.max(ROUNDING * own.abs()));
    let error = match (grid, time, solver) {
        (Some(grid), Some(time), Some(solver)) => Some((grid * grid + time * time + solver * solver).sqrt()),
        _ => None,
    };
    let known = |number: f64| Some(number).filter(|number| number.is_finite());
    let (value, error) = (known(value), error.and_then(known));
    ErrorBar { value, error, grid, time, solver, order, note, ..ErrorBar::of(answer, f64::NAN) }
}

/// An answer on several grids: the size of the cells over that of the case, and its value; the finest first.
struct Grids(Vec<(f64, f64)>);

impl Grids {
    fn of(answer: &Answer, runs: &Runs) -> Grids {
        let own = Some(answer.value);
        let at = |run: &Option<Vec<Answer>>| of(run.as_ref(), &answer.name);
        let all = [
            (0.5, at(&runs.double)),
            (1.0, own),
            (4.0 / 3.0, at(&runs.three_quarters)),
            (2.0, at(&runs.half)),
            (4.0, at(&runs.quarter)),
        ];
        let known =
            all.into_iter().filter_map(|(size, value)| Some((size, value.filter(|x| x.is_finite())?)));
        Grids(known.collect())
    }

    fn at(&self, size: f64) -> Option<f64> {
        self.0.iter().find(|grid| grid.0 == size).map(|grid| grid.1)
    }

    /// The error of the case's own grid; `None` where no other grid has the answer.
    fn error(&self) -> Option<f64> {
        self.at(1.0)?;
        let pairs = self.0.iter().flat_map(|a| self.0.iter().map(move |b| (a, b)));
        let apart = pairs.filter(|((a, _), (b, _))| *b >= APART * a);
        let linear = apart.map(|((a, own), (b, other))| (own - other).abs() / (b - a)).reduce(f64::max)?;
        let slower = self.at(2.0).zip(self.at(1.0)).map_or(0.0, |(half, own)| {
            (own - half).abs() / (self.order().clamp(ORDERS[0], 1.0).exp2() - 1.0)
        });
        Some(linear.max(slower))
    }

    /// What the coarsest three grids from the case's own on say: by how much the finer pair differs over what the coarser one does, and
    /// this ratio for an answer that goes with the logarithm of the cells. `None` without three grids, or where the answer goes up and down.
    fn ratio(&self) -> Option<[f64; 2]> {
        let coarser: Vec<_> = self.0.iter().filter(|grid| grid.0 >= 1.0).collect();
        let [(a, fine), (b, middle), (c, coarse)] = coarser[..] else { return None };
        let [finer, coarser] = [fine - middle, middle - coarse];
        (finer * coarser > 0.0).then(|| [finer / coarser, (b / a).ln() / (c / b).ln()])
    }

    /// The observed order of convergence; 1 where the grids say nothing else.
    fn order(&self) -> f64 {
        match self.ratio() {
            Some([ratio, _]) if self.at(4.0).is_some() => -ratio.log2(),
            Some([ratio, logarithmic]) if ratio >= GROWS[1] * logarithmic => ORDERS[0],
            _ => 1.0,
        }
    }

    /// Whether the answer changes from grid to grid as one that has no limit; `noise` is a change that means nothing.
    fn show_no_limit(&self, noise: f64) -> bool {
        let Some(([ratio, logarithmic], (own, half))) = self.ratio().zip(self.at(1.0).zip(self.at(2.0)))
        else {
            return false;
        };
        let change = (own - half).abs();
        ratio >= GROWS[1] * logarithmic && change > (GROWS[0] * own.abs()).max(noise)
    }

    fn safety(&self) -> f64 {
        match (self.0.len(), self.at(4.0)) {
            (_, Some(_)) => SAFETY[0],
            (3.., None) => SAFETY[1],
            _ => SAFETY[2],
        }
    }
}
