//! The error that each row states for its time steps, against the true one: random bodies, histories and steps.

use asperity::drive::March;
use asperity::material::Relaxation;
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Boundary, Control, Drive, Grid, History, Loading, Simulation, SolverOptions, TimeGrid};

const CELLS: usize = 48;
/// The steps of the reference are shorter by this factor: its error is smaller by the square of it.
const FINER: usize = 16;

/// Random numbers of a linear congruential generator (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn of(seed: u64) -> Self {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 12345);
        (0..5).for_each(|_| _ = random.uniform());
        random
    }

    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn logarithmic(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.uniform())
    }

    fn below(&mut self, count: usize) -> usize {
        (self.uniform() * count as f64) as usize
    }
}

struct Case {
    simulation: Simulation,
    /// Times of its rows in (0, 1].
    times: Vec<f64>,
}

/// A cylinder, every other one rough, on a body of 1 to 4 terms with E(0)/E(inf) from 2 to 3000, under a load or an approach that runs
/// straight between 2 to 5 points, in 5 to 500 uniform or logarithmic steps.
fn case(seed: u64) -> Case {
    let mut random = Random::of(seed);
    let grid = Grid::line(CELLS, 1.0).unwrap();
    let cylinder = Part::Shape { shape: Shape::Cylinder { radius: 2.0 }, center: [0.0, 0.0] };
    let mut gap = undeformed_gap(&grid, &[cylinder]).unwrap();
    if random.below(2) == 1 {
        let phases = [0; 3].map(|_| 6.0 * random.uniform());
        for i in 0..CELLS {
            let waves = [(37.7, 1.0), (62.8, 0.6), (100.5, 0.4)].into_iter().zip(phases);
            gap[(i, 0)] += 0.01 * waves.map(|((q, a), phase)| a * (q * grid.x(i) + phase).sin()).sum::<f64>();
        }
        let low = gap.iter().copied().fold(f64::INFINITY, f64::min);
        gap.mapv_inplace(|h| h - low);
    }
    let ratio = random.logarithmic(2.0, 3000.0);
    let count = 1 + random.below(4);
    let mut weights: Vec<f64> = (0..count).map(|_| random.uniform() + 0.05).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight *= (ratio - 1.0) / sum);
    let mut times: Vec<f64> = (0..count).map(|_| random.logarithmic(1e-3, 10.0)).collect();
    times.sort_by(f64::total_cmp);
    let terms: Vec<(f64, f64)> = weights.into_iter().zip(times).collect();
    let control = [Control::Load, Control::Approach][random.below(2)];
    let top = match control {
        Control::Approach => 0.012,
        _ => 0.02 * random.logarithmic(0.3, 3.0) * ratio.sqrt(),
    };
    let knots = 1 + random.below(4);
    let mut knots: Vec<f64> = (0..knots).map(|_| random.uniform()).collect();
    knots.sort_by(f64::total_cmp);
    let mut points = vec![(0.0, if random.below(2) == 0 { 0.0 } else { top * random.uniform() })];
    for t in knots.into_iter().chain([1.0]) {
        let (start, last) = points[points.len() - 1];
        let held = random.below(3) == 0;
        let value = if held { last } else { top * (0.05 + 0.95 * random.uniform()) };
        if t - start >= 0.02 {
            points.push((t, value));
        }
    }
    let steps = random.logarithmic(5.0, 500.0) as usize;
    let logarithmic = random.below(2) == 1;
    let time = |k: usize| match k as f64 / steps as f64 {
        part if logarithmic => 1e-4_f64.powf(1.0 - part),
        part => part,
    };
    let mut times: Vec<f64> = (1..=steps).map(time).chain(points[1..].iter().map(|point| point.0)).collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| *a - *b < 1e-6);
    Case {
        simulation: Simulation {
            boundary: Boundary::Periodic,
            creep: Relaxation::absolute(1.0, &terms).unwrap().to_creep().unwrap(),
            solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
            loading: Loading { control, history: History::Table { points } }.into(),
            ..Simulation::new(grid, gap)
        },
        times,
    }
}

/// Time, load, pressure and stated error of a row.
type Stated = (f64, f64, Vec<f64>, f64);

/// The rows with this many steps in place of each; `None` where the approach closes the whole gap.
fn rows(case: &Case, finer: usize) -> Option<Vec<Stated>> {
    let starts = std::iter::once(0.0).chain(case.times.iter().copied());
    let parts = |(from, to): (f64, &f64)| {
        let to = *to;
        (1..=finer).map(move |m| from + (to - from) * m as f64 / finer as f64)
    };
    let times = TimeGrid::List(starts.zip(&case.times).flat_map(parts).collect());
    let mut march = March::new(Simulation { times, ..case.simulation.clone() }).ok()?;
    let mut rows = vec![];
    while let Some(step) = march.advance().ok()? {
        let row = step.row();
        rows.push((row.time(), row.load, step.pressure().iter().copied().collect(), row.time_error.unwrap()));
    }
    Some(rows)
}

/// The largest stated error of a run, its largest error of load and largest pressure, and of the pressure field.
fn errors(case: &Case) -> Option<[f64; 3]> {
    let (rows, fine) = (rows(case, 1)?, rows(case, FINER)?);
    let largest = |p: &[f64]| p.iter().copied().fold(0.0, f64::max);
    let [mut stated, mut of_numbers, mut of_field] = [0.0_f64; 3];
    let mut before = 0.0;
    for (time, load, pressure, error) in &rows {
        let (_, exact, field, _) = fine.iter().rfind(|row| (row.0 - time).abs() < 1e-12).unwrap();
        stated = stated.max(*error);
        // Of a load that falls, a tenth of what it was.
        let scale = exact.max(0.1 * std::mem::replace(&mut before, *exact));
        if scale > 0.0 {
            let apart: f64 = pressure.iter().zip(field).map(|(a, b)| (a - b).abs()).sum();
            of_numbers = of_numbers.max((load - exact).abs() / scale);
            of_field = of_field.max(apart / CELLS as f64 / scale);
        }
        if *exact == scale && scale > 0.0 {
            of_numbers = of_numbers.max((largest(pressure) / largest(field) - 1.0).abs());
        }
    }
    Some([stated, of_numbers, of_field])
}

#[test]
fn the_stated_error_covers_the_true_one_in_95_of_100_cases_and_is_within_ten_times_it_in_90() {
    let found: Vec<[f64; 3]> = (0..200).filter_map(|seed| errors(&case(seed))).collect();
    assert!(found.len() > 190, "{} cases", found.len());
    let of = |share: f64| share * found.len() as f64;
    // 1e-6: what the tolerance of the solver leaves.
    let covered = found.iter().filter(|[stated, number, _]| number <= stated || *number < 1e-6).count();
    assert!(covered as f64 >= of(0.95), "{covered} of {}", found.len());
    let close =
        found.iter().filter(|[stated, number, field]| *stated <= (10.0 * number.max(*field)).max(1e-4));
    let close = close.count();
    assert!(close as f64 >= of(0.9), "{close} of {}", found.len());
}
