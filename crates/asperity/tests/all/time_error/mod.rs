//! The error that each row states for its time steps, and the tolerance of adaptive steps, against the true error.

mod cases;

use asperity::drive::March;
use asperity::material::{Creep, CreepTerm, PoissonCreep};
use asperity::stress::PressureHistory;
use asperity::{Drive, Simulation, TimeGrid};
use cases::{Case, Class, Steps, case, rubber, sticky};

/// The steps of the reference are shorter by this factor: its error is smaller by the square of it.
const FINER: usize = 16;

struct Stated {
    time: f64,
    jump: bool,
    approach: f64,
    pressure: Vec<f64>,
    /// ∫ ν(t - s) dp(s) of a Poisson's ratio that rises from 0.2 to 0.5 with the retardation times of the pair.
    transverse: Vec<f64>,
    error: f64,
}

fn poisson(contact: &Creep) -> PoissonCreep {
    let sum: f64 = contact.terms.iter().map(|term| term.compliance).sum();
    let term = |term: &CreepTerm| CreepTerm { compliance: 0.3 * term.compliance / sum, ..*term };
    let ratio = Creep { instantaneous: 0.2, terms: contact.terms.iter().map(term).collect(), fluidity: 0.0 };
    PoissonCreep { confined: ratio.clone(), ratio }
}

/// The rows of these steps; `None` where the approach closes the whole gap.
fn rows(simulation: &Simulation, times: TimeGrid, finer: usize) -> Option<Vec<Stated>> {
    let mut simulation = Simulation { times, ..simulation.clone() };
    simulation.motion.iter_mut().for_each(|motion| motion.cells_per_step /= finer as f64);
    let mut history =
        PressureHistory::new(&poisson(&simulation.creep), &simulation.creep, simulation.grid).ok()?;
    let mut march = March::new(simulation).ok()?;
    let mut rows = vec![];
    while let Some(step) = march.advance().ok()? {
        let (row, pressure) = (step.row(), step.pressure().iter().copied().collect::<Vec<f64>>());
        history.advance(row.time(), step.control(), &pressure).unwrap();
        rows.push(Stated {
            time: row.time(),
            jump: step.instant().unwrap().jump,
            approach: row.approach,
            pressure,
            transverse: history.transverse(),
            error: row.time_error.unwrap(),
        });
    }
    Some(rows)
}

/// The errors of a run, each the largest of its rows.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    stated: f64,
    /// Of the load over the sum of the tractions, of the largest traction, and of the sum of the stress history.
    of_load: f64,
    of_peak: f64,
    of_stress: f64,
    /// Of the approach, over the largest one of the run.
    of_approach: f64,
    /// Of the fields of traction and stress history.
    of_field: f64,
}

impl Errors {
    fn of_numbers(&self) -> f64 {
        self.of_load.max(self.of_peak).max(self.of_stress)
    }
}

/// The errors of a run, against one that takes each step in [`FINER`].
fn errors(case: &Case) -> Option<Errors> {
    let rows_of = |times, finer| rows(&case.simulation, times, finer);
    let found = match &case.steps {
        Steps::Given(times) => rows_of(TimeGrid::List(times.clone()), 1)?,
        Steps::Adaptive(tolerance) => {
            rows_of(TimeGrid::Adaptive { end: 1.0, tolerance: *tolerance, first: 0.1 }, 1)?
        }
    };
    let parts = found.windows(2).filter(|pair| pair[1].time > pair[0].time).flat_map(|pair| {
        let [from, to] = [pair[0].time, pair[1].time];
        (1..=FINER).map(move |m| if m == FINER { to } else { from + (to - from) * m as f64 / FINER as f64 })
    });
    let fine = rows_of(TimeGrid::List(parts.collect()), FINER)?;
    Some(compare(&found, &fine))
}

fn compare(found: &[Stated], fine: &[Stated]) -> Errors {
    let largest = |p: &[f64]| p.iter().copied().fold(0.0, |most: f64, p| most.max(p.abs()));
    let total = |p: &[f64]| p.iter().sum::<f64>();
    let size = |p: &[f64]| p.iter().map(|p| p.abs()).sum::<f64>();
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>();
    let mut errors = Errors::default();
    let mut before = 0.0;
    // Of a load below a hundredth of the largest one, that hundredth.
    let least = 0.01 * fine.iter().map(|row| size(&row.pressure)).fold(0.0, f64::max);
    let deepest = fine.iter().map(|row| row.approach.abs()).fold(0.0, f64::max);
    for row in found {
        let at = |fine: &&Stated| (fine.time - row.time).abs() < 1e-12 && fine.jump == row.jump;
        let exact = fine.iter().rfind(at).unwrap();
        errors.stated = errors.stated.max(row.error);
        errors.of_approach = errors.of_approach.max((row.approach - exact.approach).abs() / deepest);
        let own = size(&exact.pressure);
        // Of a load that falls, a tenth of what it was.
        let scale = own.max(0.1 * std::mem::replace(&mut before, own)).max(least);
        if scale == 0.0 {
            continue;
        }
        let load = (total(&row.pressure) - total(&exact.pressure)).abs() / scale;
        errors.of_load = errors.of_load.max(load);
        errors.of_field = errors.of_field.max(apart(&row.pressure, &exact.pressure) / scale);
        if own == scale {
            let peak = (largest(&row.pressure) / largest(&exact.pressure) - 1.0).abs();
            errors.of_peak = errors.of_peak.max(peak);
        }
        // Half of a pressure that has been there for long, and what is left of one that has gone.
        let scale = scale.max(2.0 * size(&exact.transverse));
        let stress = (total(&row.transverse) - total(&exact.transverse)).abs() / scale;
        errors.of_stress = errors.of_stress.max(stress);
        errors.of_field = errors.of_field.max(apart(&row.transverse, &exact.transverse) / scale);
    }
    errors
}

/// Cases of a class: how many of them are covered, have a stated error that is close to the true one, have adaptive steps, and stay within their
/// tolerance.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    all: usize,
    covered: usize,
    close: usize,
    adaptive: usize,
    within: usize,
}

impl Counts {
    fn add(&mut self, case: &Case, seed: u64) {
        let Some(errors) = errors(case) else { return };
        let (stated, numbers) = (errors.stated, errors.of_numbers());
        // 1e-6: what the tolerance of the solver leaves.
        let covered = numbers <= stated || numbers < 1e-6;
        // A stated error of a thousandth is as good as none.
        let close = stated <= (10.0 * numbers.max(errors.of_field)).max(1e-3);
        if !covered {
            println!("{seed} {}: {errors:?}", case.kind());
        }
        self.all += 1;
        self.covered += usize::from(covered);
        self.close += usize::from(close);
        if let Steps::Adaptive(tolerance) = case.steps {
            self.adaptive += 1;
            self.within += usize::from(numbers <= tolerance);
        }
    }
}

#[test]
fn the_stated_error_covers_the_true_one_in_95_of_100_cases() {
    // Seeds that no number was chosen with.
    let seeds = 1000..1050;
    let counts = Class::ALL.map(|class| {
        let mut counts = Counts::default();
        seeds.clone().for_each(|seed| counts.add(&case(class, seed), seed));
        counts
    });
    for (class, Counts { all, covered, close, adaptive, within }) in Class::ALL.iter().zip(counts) {
        println!("| {} | {all} | {covered} | {close} | {adaptive} | {within} |", class.name());
    }
    for (class, Counts { all, covered, .. }) in Class::ALL.iter().zip(counts) {
        assert!(all >= 40 && covered as f64 >= 0.95 * all as f64, "{}: {covered} of {all}", class.name());
    }
    let [all, close, adaptive, within] = counts.iter().fold([0; 4], |sums, counts| {
        let own = [counts.all, counts.close, counts.adaptive, counts.within];
        std::array::from_fn(|k| sums[k] + own[k])
    });
    assert!(close as f64 >= 0.65 * all as f64, "{close} of {all}");
    assert!(within as f64 >= 0.9 * adaptive as f64, "{within} of {adaptive}");
}

#[test]
fn the_error_of_a_free_line_does_not_depend_on_the_empty_domain() {
    // The same contact on eight times the domain: the displacement has another constant, and nothing else changes.
    let steps = TimeGrid::Uniform { end: 1.0, steps: 30 };
    let [short, long] = [1, 8].map(|times| {
        let case = rubber(times, Steps::Adaptive(1.0));
        rows(&case.simulation, steps.clone(), 1).unwrap()
    });
    for (short, long) in short.iter().zip(&long) {
        // The tolerance of the solver is one of U, which is larger on the long domain.
        let same = (short.error - long.error).abs() <= 1e-4 * short.error.max(1e-5);
        assert!(same, "{} s: {} {}", short.time, short.error, long.error);
    }
    assert!(short.iter().any(|row| row.error > 1e-3));
}

#[test]
fn adaptive_steps_of_a_free_line_keep_their_tolerance_while_cells_touch() {
    for tolerance in [1.87e-3, 1e-2] {
        let errors = errors(&rubber(1, Steps::Adaptive(tolerance))).unwrap();
        println!("{tolerance}: {errors:?}");
        assert!(errors.of_numbers() <= tolerance, "{tolerance}: {errors:?}");
    }
}

#[test]
fn the_steps_of_bodies_that_attract_each_other_follow_their_error_before_they_touch() {
    let tolerance = 3e-3;
    let case = sticky(Steps::Adaptive(tolerance));
    let adaptive = TimeGrid::Adaptive { end: 1.0, tolerance, first: 0.1 };
    let apart = rows(&case.simulation, adaptive, 1).unwrap();
    // The sphere is far off, and the body moves already.
    assert!(apart.iter().filter(|row| row.approach < -1e-6).any(|row| row.error > 1e-6));
    let errors = errors(&case).unwrap();
    println!("{errors:?}");
    assert!(errors.of_load <= tolerance, "{errors:?}");
}
