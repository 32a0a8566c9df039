//! Random cases: a body, a surface, what is prescribed, and steps.

use std::f64::consts::TAU;
use std::sync::Arc;

use asperity::material::Relaxation;
use asperity::process::Motion;
use asperity::sliding::{Direction, MovingGap, Path};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::traction::Adhesion;
use asperity::{Boundary, Control, Grid, History, Loading, Simulation, SolverOptions};

/// Cells of a line, and of each side of a square domain.
const ON_LINE: usize = 48;
const ON_SIDE: usize = 18;
/// Radius of the spheres and cylinders, over the side of the domain.
const RADIUS: f64 = 2.0;
/// No contact is wider than this share of a free domain.
const WIDEST: f64 = 0.35;

/// Random numbers of a linear congruential generator (Knuth's MMIX).
pub struct Random(u64);

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

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.uniform()
    }

    fn logarithmic(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.uniform())
    }

    fn below(&mut self, count: usize) -> usize {
        (self.uniform() * count as f64) as usize
    }

    fn flips(&mut self) -> bool {
        self.below(2) == 1
    }
}

/// What kind of contact a case is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    FreeLine,
    PeriodicLine,
    MovingLine,
    Sphere,
    RoughSurface,
    Adhesion,
}

impl Class {
    pub const ALL: [Class; 6] = [
        Class::FreeLine,
        Class::PeriodicLine,
        Class::MovingLine,
        Class::Sphere,
        Class::RoughSurface,
        Class::Adhesion,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Class::FreeLine => "free lines",
            Class::PeriodicLine => "periodic lines",
            Class::MovingLine => "periodic lines, moving",
            Class::Sphere => "spheres",
            Class::RoughSurface => "rough periodic surfaces",
            Class::Adhesion => "spheres with adhesion",
        }
    }

    fn is_line(self) -> bool {
        matches!(self, Class::FreeLine | Class::PeriodicLine | Class::MovingLine)
    }

    fn is_free(self) -> bool {
        matches!(self, Class::FreeLine | Class::Sphere | Class::Adhesion)
    }
}

pub struct Case {
    pub class: Class,
    pub simulation: Simulation,
    pub steps: Steps,
}

/// Times of its rows in (0, 1], or the tolerance of adaptive steps.
pub enum Steps {
    Given(Vec<f64>),
    Adaptive(f64),
}

impl Case {
    pub fn kind(&self) -> String {
        let of = match self.simulation.loading.stages[0].control {
            Control::Approach => "approach",
            _ => "load",
        };
        let steps = if matches!(self.steps, Steps::Given(_)) { "given" } else { "adaptive" };
        format!("{}, {of}, {steps} steps", self.class.name())
    }
}

/// A body of 1 to 4 terms with E(0)/E(infinity) from 2 to `most`, and E(infinity) = 1; that ratio.
fn body(random: &mut Random, most: f64) -> (Relaxation, f64) {
    let ratio = random.logarithmic(2.0, most);
    let count = 1 + random.below(4);
    let mut weights: Vec<f64> = (0..count).map(|_| random.uniform() + 0.05).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight *= (ratio - 1.0) / sum);
    let mut times: Vec<f64> = (0..count).map(|_| random.logarithmic(1e-3, 10.0)).collect();
    times.sort_by(f64::total_cmp);
    let terms: Vec<(f64, f64)> = weights.into_iter().zip(times).collect();
    (Relaxation::absolute(1.0, &terms).unwrap(), ratio)
}

/// A cylinder or sphere, every other one rough, or waves all over a periodic square.
fn gap(random: &mut Random, class: Class, grid: &Grid) -> ndarray::Array2<f64> {
    let shape = match class.is_line() {
        true => Shape::Cylinder { radius: RADIUS },
        false => Shape::Sphere { radius: RADIUS },
    };
    let is_rough = class == Class::RoughSurface;
    let mut gap = match is_rough {
        true => ndarray::Array2::zeros(grid.shape()),
        false => undeformed_gap(grid, &[Part::Shape { shape, center: [0.0, 0.0] }]).unwrap(),
    };
    let bumps = match class {
        Class::FreeLine | Class::PeriodicLine | Class::Sphere => random.flips(),
        Class::RoughSurface => true,
        Class::MovingLine | Class::Adhesion => false,
    };
    if bumps {
        let (height, waves) = if is_rough { (0.03, 6) } else { (0.01, 3) };
        for k in 0..waves {
            let (n, phase) = ([6.0, 10.0, 16.0][k % 3], TAU * random.uniform());
            let turn = if class.is_line() { 0.0 } else { TAU * random.uniform() };
            let scale = if is_rough { 0.3 } else { 1.0 };
            let q = [turn.cos(), turn.sin()].map(|part| TAU * (scale * n * part).round());
            let amplitude = height * [1.0, 0.6, 0.4][k % 3];
            gap.indexed_iter_mut().for_each(|((i, j), h)| {
                *h += amplitude * (q[0] * grid.x(i) + q[1] * grid.y(j) + phase).sin();
            });
        }
        let low = gap.iter().copied().fold(f64::INFINITY, f64::min);
        gap.mapv_inplace(|h| h - low);
    }
    gap
}

/// Points of a course between 0.05 and 1, every other one from 0, with parts that are held and some jumps; or a sine.
fn course(random: &mut Random, top: f64, jumps: bool) -> History {
    if random.below(6) == 0 {
        let mean = top * random.between(0.4, 0.6);
        return History::Sine { mean, amplitude: 0.9 * mean, frequency: random.between(1.0, 3.0) };
    }
    let count = 1 + random.below(4);
    let mut knots: Vec<f64> = (0..count).map(|_| random.uniform()).collect();
    knots.sort_by(f64::total_cmp);
    let mut points = vec![(0.0, if random.flips() { 0.0 } else { top * random.uniform() })];
    for t in knots.into_iter().chain([1.0]) {
        let (start, last) = points[points.len() - 1];
        let held = random.below(3) == 0;
        let value = if held { last } else { top * random.between(0.05, 1.0) };
        if t - start >= 0.02 {
            points.push((t, value));
            if jumps && t < 1.0 && random.below(4) == 0 {
                points.push((t, top * random.between(0.05, 1.0)));
            }
        }
    }
    History::Table { points }
}

/// In, held, and out again, from beyond the range of the attraction.
fn visit(random: &mut Random, depth: f64) -> History {
    let start = -random.between(1.0, 3.0) * depth;
    let [there, held] = [random.between(0.2, 0.4), random.between(0.4, 0.6)];
    History::Table { points: vec![(0.0, start), (there, depth), (held, depth), (1.0, 2.0 * start)] }
}

/// Uniform or logarithmic steps that end at all points of the course, or adaptive ones of tolerance 1e-4 to 3e-2.
fn steps(random: &mut Random, history: &History, class: Class) -> Steps {
    let most = if class.is_line() { 500.0 } else { 200.0 };
    let adaptive = class != Class::MovingLine && random.flips();
    if adaptive {
        return Steps::Adaptive(random.logarithmic(if class.is_line() { 1e-4 } else { 1e-3 }, 3e-2));
    }
    let is_sine = matches!(history, History::Sine { .. });
    let count = random.logarithmic(if is_sine { 70.0 } else { 5.0 }, most) as usize;
    let logarithmic = !is_sine && random.flips();
    let time = |k: usize| match k as f64 / count as f64 {
        part if logarithmic => 1e-4_f64.powf(1.0 - part),
        part => part,
    };
    let mut times: Vec<f64> = (1..=count).map(time).chain(history.breaks(1.0)).filter(|t| *t > 0.0).collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| *a - *b < 1e-6);
    Steps::Given(times)
}

/// The case of a class with this seed.
pub fn case(class: Class, seed: u64) -> Case {
    let mut random = Random::of(seed);
    let grid = match class.is_line() {
        true => Grid::line(ON_LINE, 1.0).unwrap(),
        false => Grid::new([ON_SIDE; 2], [1.0; 2]).unwrap(),
    };
    let gap = gap(&mut random, class, &grid);
    let (relaxation, ratio) = body(&mut random, if class == Class::Adhesion { 40.0 } else { 3000.0 });
    let control = match class {
        Class::FreeLine => Control::Load,
        Class::Adhesion => Control::Approach,
        _ => [Control::Load, Control::Approach][random.below(2)],
    };
    let (a, rising) = (WIDEST, ratio.sqrt());
    let top = match (class, control) {
        (Class::FreeLine, _) => std::f64::consts::FRAC_PI_4 * a * a / RADIUS * random.logarithmic(0.1, 1.0),
        (Class::Sphere, Control::Load) => 4.0 / 3.0 * a.powi(3) / RADIUS * random.logarithmic(0.1, 1.0),
        (Class::Sphere, _) => a * a / RADIUS * random.between(0.2, 1.0),
        (Class::RoughSurface, Control::Approach) => random.between(0.02, 0.06),
        (Class::RoughSurface, _) => 0.02 * random.logarithmic(0.3, 10.0) * rising,
        (Class::Adhesion, _) => random.between(0.02, 0.05),
        (_, Control::Approach) => 0.012,
        _ => 0.02 * random.logarithmic(0.3, 3.0) * rising,
    };
    let history = match class {
        Class::Adhesion => visit(&mut random, top),
        _ => course(&mut random, top, class != Class::MovingLine),
    };
    let motion = (class == Class::MovingLine).then(|| Motion {
        path: Path::of_velocity(History::Step { value: random.logarithmic(0.01, 1.0) }, 0.0).unwrap(),
        direction: Direction::X,
        gap: MovingGap::new(
            &grid,
            Boundary::Periodic,
            &[(Part::Shape { shape: Shape::Cylinder { radius: RADIUS }, center: [0.0, 0.0] }, true)],
        )
        .unwrap(),
        cells_per_step: 1.0,
        shear_stress: None,
    });
    let adhesion = (class == Class::Adhesion).then(|| {
        let range = random.between(0.02, 0.05);
        // So weak that bodies come together and part without a jump: rows in a jump have no error that means anything.
        let work = random.between(0.02, 0.15) * range * range / (0.6 / ON_SIDE as f64);
        Arc::new(Adhesion { allow_unresolved: true, ..Adhesion::new(work, range) }) as Arc<_>
    });
    Case {
        class,
        steps: steps(&mut random, &history, class),
        simulation: Simulation {
            boundary: if class.is_free() { Boundary::Free } else { Boundary::Periodic },
            creep: relaxation.to_creep().unwrap(),
            solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
            loading: Loading { control, history }.into(),
            motion,
            traction: adhesion.map(|adhesion: Arc<dyn asperity::traction::TractionLaw>| adhesion),
            ..Simulation::new(grid, gap)
        },
    }
}

/// A cylinder of rubber under a load that falls, on a free line of 82 cells of 1 mm, `times` as long: the contact spreads by creep.
pub fn rubber(times: usize, steps: Steps) -> Case {
    let grid = Grid::line(82 * times, 1e-3 * times as f64).unwrap();
    let cylinder = Part::Shape { shape: Shape::Cylinder { radius: 5e-3 }, center: [0.0, 0.0] };
    let terms = [(6.62756e7, 0.206552), (7.84644e7, 0.00600882)];
    let points = vec![(0.0, 48.9622), (0.128572, 49.2239), (1.0, 26.3664)];
    Case {
        class: Class::FreeLine,
        steps,
        simulation: Simulation {
            creep: Relaxation::absolute(4e6, &terms).unwrap().to_creep().unwrap(),
            solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
            loading: Loading { control: Control::Load, history: History::Table { points } }.into(),
            ..Simulation::new(grid, undeformed_gap(&grid, &[cylinder]).unwrap())
        },
    }
}

/// A sphere of a soft body that creeps, brought from three ranges of the adhesion to 1.5 ranges in.
pub fn sticky(steps: Steps) -> Case {
    let grid = Grid::new([20; 2], [28e-6; 2]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 40e-6 }, center: [0.0, 0.0] };
    let points = vec![(0.0, -3e-6), (1.0, 1.5e-6)];
    Case {
        class: Class::Adhesion,
        steps,
        simulation: Simulation {
            creep: Relaxation::absolute(4e6 / 3.0, &[(2e7, 0.015)]).unwrap().to_creep().unwrap(),
            loading: Loading { control: Control::Approach, history: History::Table { points } }.into(),
            traction: Some(Arc::new(Adhesion { allow_unresolved: true, ..Adhesion::new(0.25, 1e-6) })),
            ..Simulation::new(grid, undeformed_gap(&grid, &[sphere]).unwrap())
        },
    }
}
