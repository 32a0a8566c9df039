//! Where the time of a contact goes, and how far it is from what the machine can do.
//!
//! `cargo bench -p asperity --bench solver -- N ...` prints tables in Markdown. The case is that of the paper: a
//! rough sphere on PMMA with a cut-off (`examples/rough-pmma.toml`), its first steps.
//!
//! The phases are timed one by one, outside of the solver, which no clock slows; what is left of a run are its
//! sweeps over fields. Bounds are measured in the same run: the rate of a copy between arrays that no cache
//! holds, and the rate of independent multiplications and additions in registers.

use asperity::Drive;
use std::hint::black_box;
use std::time::Instant;

use asperity::drive::March;
use asperity::material::{Creep, CreepTerm};
use asperity::operator::half_space;
use asperity::simulation::Simulation;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{
    Boundary, ContactState, Control, Grid, History, Loading, Method, Prescribed, Problem, Solver,
    SolverOptions, TimeGrid,
};
use asperity_sweep::simd::{F64x8, Work, vectorize};
use rayon::prelude::*;

const HARDNESS: f64 = 300e6;
const LOAD: f64 = 0.5;
/// (1 - nu^2) C0 of PMMA \[1/Pa\].
const COMPLIANCE: f64 = 0.8556 * 4.013744989e-10;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut sizes: Vec<usize> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    if sizes.is_empty() {
        sizes = vec![256, 1024];
    }
    println!("{} threads\n", rayon::current_num_threads());
    let bytes = copy_rate();
    let flops = arithmetic_rate();
    println!("copy {:.1} GB/s (read and written), arithmetic {:.1} Gflop/s\n", bytes / 1e9, flops / 1e9);
    let runs: Vec<Size> = sizes.into_iter().map(Size::run).collect();

    println!("| N | convolution | ns per cell | of the memory bound | of the FP bound | preconditioner |");
    println!("|---|---|---|---|---|---|");
    for run in &runs {
        let cells = (run.n * run.n) as f64;
        println!(
            "| {} | {:.2} ms | {:.2} | {:.1} x | {:.1} x | {:.2} ms |",
            run.n,
            1e3 * run.convolution.least,
            1e9 * run.convolution.least / cells,
            run.convolution.least / (run.traffic() / bytes),
            run.convolution.least / (run.operations() / flops),
            1e3 * run.preconditioner.least,
        );
    }
    println!(
        "\n| N | run | time | convolutions | per row | ns per cell and iteration | convolution | preconditioner | sweeps |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for run in &runs {
        run.print("cold elastic contact", &run.elastic);
        run.print(&format!("creep, {} steps", run.creep.rows), &run.creep);
    }
    if let Some(n) = runs.iter().map(|r| r.n).filter(|n| *n <= 1024).max() {
        let [two, forty] = [2, 40].map(|terms| creep(n, terms, 5).1);
        let per = |c: &Counts| 1e3 * c.seconds / c.convolutions as f64;
        println!(
            "\n{n}: a step of a material of 40 terms takes {:.2} times one of 2 terms ({:.1} and {:.1} ms per convolution)",
            per(&forty) / per(&two),
            per(&forty),
            per(&two)
        );
    }
}

/// What was measured on N x N cells.
struct Size {
    n: usize,
    /// One convolution.
    convolution: Timed,
    preconditioner: Timed,
    elastic: Counts,
    creep: Counts,
}

#[derive(Default)]
struct Counts {
    seconds: f64,
    rows: usize,
    convolutions: usize,
    iterations: usize,
}

impl Size {
    fn run(n: usize) -> Self {
        let grid = grid(n);
        let mut operator = half_space(grid, Boundary::Free);
        let input: Vec<f64> = (0..n * n).map(|i| (i * 7919 % 1013) as f64).collect();
        let single: Vec<f32> = input.iter().map(|x| *x as f32).collect();
        let (mut output, mut rough) = (vec![0.0; n * n], vec![0.0; n * n]);
        let convolution = timed(|| operator.apply_into(&input, &mut output));
        let mut inverse = operator.approximate_inverse();
        let set = vec![0b0101_1100; (n * n).div_ceil(8)];
        let preconditioner = timed(|| inverse.apply_on_set_into(&single, &set, &mut rough));
        drop((operator, inverse, input, single, output, rough));
        let (elastic, creep) = creep(n, 2, if n > 1024 { 5 } else { 20 });
        Size { n, convolution, preconditioner, elastic, creep }
    }

    /// Bytes that a convolution moves at least: rows read and half spectrum written, read and written with the
    /// multiplier beside, read again and rows written.
    fn traffic(&self) -> f64 {
        let cells = (self.n * self.n) as f64;
        cells * (8.0 + 16.0 + (16.0 + 16.0 + 10.0) + 16.0 + 8.0)
    }

    /// 5 m log2 m operations for each complex transform of length m: N rows and N columns, there and back, columns
    /// of twice the length.
    fn operations(&self) -> f64 {
        let n = self.n as f64;
        n * 2.0 * (5.0 * n * n.log2() + 5.0 * (2.0 * n) * (2.0 * n).log2())
    }

    fn print(&self, what: &str, counts: &Counts) {
        let convolutions = self.convolution.mean * counts.convolutions as f64;
        let preconditioner = self.preconditioner.mean * counts.iterations as f64;
        let share = |seconds: f64| 100.0 * seconds / counts.seconds;
        println!(
            "| {} | {what} | {:.3} s | {} | {:.1} | {:.1} | {:.0} % | {:.0} % | {:.0} % |",
            self.n,
            counts.seconds,
            counts.convolutions,
            counts.convolutions as f64 / counts.rows as f64,
            1e9 * counts.seconds / counts.iterations as f64 / (self.n * self.n) as f64,
            share(convolutions),
            share(preconditioner),
            share(counts.seconds - convolutions - preconditioner),
        );
    }
}

fn grid(n: usize) -> Grid {
    Grid::new([n, n], [1e-4, 1e-4]).expect("a grid")
}

/// The rough sphere of `examples/rough-pmma.toml`; on coarse grids its shortest wave is two cells.
fn gap(grid: &Grid) -> ndarray::Array2<f64> {
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.05),
        longest: 50e-6,
        shortest: f64::max(0.8e-6, 2.0 * grid.spacing()[0]),
        roll_off: 50e-6,
        seed: 1,
    };
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 0.5e-3 }, center: [0.0, 0.0] };
    undeformed_gap(grid, &[sphere, Part::SelfAffine(rough)]).expect("a gap")
}

/// A cold elastic contact, and steps of 5 s of the creep after it.
fn creep(n: usize, terms: usize, steps: usize) -> (Counts, Counts) {
    let grid = grid(n);
    let gap = gap(&grid);
    let options = SolverOptions::default();
    let elastic = {
        let mut operator = half_space(grid, Boundary::Free);
        let mut solver = Solver::new(Method::ProjectedCg, &*operator);
        let mut state = ContactState::new(grid.len());
        let problem = Problem {
            gap: gap.as_slice().expect("C-order"),
            compliance: COMPLIANCE,
            hardness: HARDNESS.into(),
            prescribed: Prescribed::Load(LOAD),
        };
        let mut solve =
            || solver.solve(&mut *operator, &problem, &options, &mut state, None).expect("a contact");
        let start = Instant::now();
        let outcome = solve();
        let seconds = start.elapsed().as_secs_f64();
        Counts { seconds, rows: 1, convolutions: outcome.convolutions, iterations: outcome.iterations }
    };
    // The retarded compliance of PMMA in so many terms, from 10 to 134 s.
    let times = (0..terms).map(|k| 9.936 * 13.47_f64.powf(k as f64 / (terms - 1) as f64));
    let compliance = 0.8556 * 10.55e-11 / terms as f64;
    let terms = times.map(|time| CreepTerm { compliance, retardation_time: time }).collect();
    let mut march = March::new(Simulation {
        creep: Creep { instantaneous: COMPLIANCE, terms, fluidity: 0.0 },
        hardness: HARDNESS,
        loading: Loading { control: Control::Load, history: History::Step { value: LOAD } }.into(),
        times: TimeGrid::Uniform { end: 5.0 * steps as f64, steps },
        solver: options,
        ..Simulation::new(grid, gap)
    })
    .expect("a simulation");
    march.advance().expect("a row");
    let mut counts = Counts::default();
    let start = Instant::now();
    while let Some(step) = march.advance().expect("a row") {
        let row = step.row();
        counts.rows += 1;
        counts.convolutions += row.convolutions;
        counts.iterations += row.iterations;
    }
    counts.seconds = start.elapsed().as_secs_f64();
    (elastic, counts)
}

/// The least time of some calls: what a bound is compared with. A run is compared with their mean, for it met the same
/// neighbours.
#[derive(Clone, Copy)]
struct Timed {
    least: f64,
    mean: f64,
}

/// Times some calls \[s\].
fn timed(mut work: impl FnMut()) -> Timed {
    let once = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    let first = once(&mut work);
    let calls = (1.0 / first).clamp(3.0, 30.0) as usize;
    let times: Vec<f64> = (0..calls).map(|_| once(&mut work)).collect();
    Timed {
        least: times.iter().copied().fold(first, f64::min),
        mean: times.iter().sum::<f64>() / calls as f64,
    }
}

/// Bytes per second, read and written, of a copy of 128 MiB by all threads.
fn copy_rate() -> f64 {
    let from = vec![1.0_f64; 1 << 24];
    let mut to = vec![0.0; from.len()];
    let seconds = timed(|| {
        to.par_chunks_mut(1 << 14)
            .zip(from.par_chunks(1 << 14))
            .for_each(|(to, from)| to.copy_from_slice(from));
        black_box(&to);
    });
    16.0 * from.len() as f64 / seconds.least
}

/// Multiplications and additions per second, in registers, of all threads.
fn arithmetic_rate() -> f64 {
    const ROUNDS: usize = 1 << 16;
    struct Chains;
    impl Work for Chains {
        type Yield = f64;
        #[inline(always)]
        fn run<V: F64x8>(self) -> f64 {
            // Twelve chains keep both ports busy over the latency of four cycles; all stay near 1.
            let (by, plus) = (V::splat(black_box(0.999_999)), V::splat(black_box(1e-6)));
            let mut chains = [V::splat(1.0); 12];
            for _ in 0..ROUNDS {
                for x in &mut chains {
                    *x = *x * by + plus;
                }
            }
            chains.into_iter().fold(V::splat(0.0), |sum, x| sum + x).sum()
        }
    }
    let threads = rayon::current_num_threads();
    let seconds = timed(|| {
        (0..threads).into_par_iter().for_each(|_| {
            black_box(vectorize(Chains));
        });
    });
    (threads * ROUNDS * 12 * 8 * 2) as f64 / seconds.least
}
