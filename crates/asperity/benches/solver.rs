//! Where the time of a contact goes: `cargo bench -p asperity --bench solver -- [creep STEPS] N ...`.
use asperity::convolution::lanes::Lanes;
use asperity::march::{March, Simulation};
use asperity::material::{Creep, CreepTerm};
use asperity::operator::half_space;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, TimeGrid};
use std::time::Instant;

fn least(mut f: impl FnMut(), n: usize) -> f64 {
    (0..n)
        .map(|_| {
            let t = Instant::now();
            f();
            t.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn main() {
    let arguments: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let steps = arguments.first().copied().unwrap_or(20);
    let capped = std::env::var("CAP").map_or(300e6, |c| c.parse().unwrap());
    let precision = std::env::var("MIXED").is_ok();
    for &n in &arguments[1..] {
        let grid = Grid::new([n, n], [1e-4, 1e-4]).unwrap();
        let rough = SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsGradient(0.05),
            longest: 50e-6,
            shortest: 0.8e-6,
            roll_off: 50e-6,
            seed: 1,
        };
        let gap = undeformed_gap(
            &grid,
            &[
                Part::Shape { shape: Shape::Sphere { radius: 0.5e-3 }, center: [0.0, 0.0] },
                Part::SelfAffine(rough),
            ],
        )
        .unwrap();
        let boundary = if std::env::var("PERIODIC").is_ok() { Boundary::Periodic } else { Boundary::Free };
        let mut operator = half_space(grid, boundary);
        let p: Vec<f64> = gap.iter().map(|h| 1e-6 - h).collect();
        let mut u = vec![0.0; p.len()];
        let tk = least(|| operator.apply_into(&p, &mut u), 10);
        let ones = ndarray::Array2::ones((n / 2 + 1, n / 2 + 1));
        let mut inverse = Lanes::<f32>::new([n, n], [n, n], ones.view());
        let (ps, mut us) = (vec![1.0f32; n * n], vec![0.0f32; n * n]);
        let tm = least(|| inverse.apply_into(&ps, &mut us), 10);
        drop(operator);
        let terms = vec![
            CreepTerm { compliance: 0.8556 * 4.474062327e-11, retardation_time: 9.936295903 },
            CreepTerm { compliance: 0.8556 * 6.072724980e-11, retardation_time: 133.8704875 },
        ];
        let mut march = March::new(Simulation {
            boundary,
            creep: Creep { instantaneous: 0.8556 * 4.013744989e-10, terms, fluidity: 0.0 },
            hardness: capped,
            solver: asperity::SolverOptions {
                precision: if precision { asperity::Precision::Mixed } else { asperity::Precision::Double },
                ..Default::default()
            },
            loading: Loading { control: Control::Load, history: History::Step { value: 0.5 } },
            times: TimeGrid::Uniform { end: 5.0 * steps as f64, steps },
            ..Simulation::new(grid, gap)
        })
        .unwrap();
        let (mut iterations, mut convolutions, mut counts) = (0, 0, vec![]);
        let mut first = 0.0;
        let mut start = Instant::now();
        let mut rows = 0.0;
        loop {
            let Some(step) = march.advance().unwrap() else { break };
            let t = Instant::now();
            let row = step.row();
            rows += t.elapsed().as_secs_f64();
            counts.push(row.convolutions);
            if counts.len() == 1 {
                first = start.elapsed().as_secs_f64();
                start = Instant::now();
                println!("first {:?}", row);
                continue;
            }
            iterations += row.iterations;
            convolutions += row.convolutions;
        }
        let total = start.elapsed().as_secs_f64();
        let rest = total - tk * convolutions as f64 - tm * iterations as f64 - rows;
        println!(
            "{n}: K {:.2} ms, M {:.2} ms; first {:.2} s, total {:.3} s, iter {iterations}, conv {convolutions}: per iteration {:.2} ms, sweeps {:.2} ms per iteration, rows {:.2} ms each",
            tk * 1e3,
            tm * 1e3,
            first,
            total,
            total / iterations as f64 * 1e3,
            rest / iterations as f64 * 1e3,
            rows / counts.len() as f64 * 1e3
        );
        println!("{counts:?} {precision}");
    }
}
