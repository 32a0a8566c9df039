//! Contact of a gap from a file, timed: what `cargo xtask peers` compares other programs with.
//!
//! `gap_file write FILE N` writes an N x N self-affine gap as little-endian f64; `gap_file solve FILE N BOUNDARY PRESSURE
//! TOLERANCE STEPS` prints one JSON object. The domain has side 1. Without steps: an elastic contact of E* = 1
//! at the mean PRESSURE. With steps of 1/50 of the relaxation time: a Zener solid whose E*(t) = 4 + 4 exp(-t), at four
//! times the PRESSURE. The time is that of the solve; planning is not counted.

use asperity::Drive;
use std::time::Instant;

use asperity::drive::March;

use asperity::material::{Creep, CreepTerm};
use asperity::operator::half_space;
use asperity::simulation::Simulation;
use asperity::surface::{Part, Roughness, SelfAffine, undeformed_gap};
use asperity::{
    Boundary, ContactState, Control, Grid, History, Loading, Method, Prescribed, Problem, Solver,
    SolverOptions, TimeGrid,
};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["write", file, n] => write(file, n.parse()?),
        ["solve", file, n, boundary, pressure, tolerance, steps] => {
            let options = SolverOptions { tolerance: tolerance.parse()?, ..SolverOptions::default() };
            let boundary = if boundary == "free" { Boundary::Free } else { Boundary::Periodic };
            solve(file, n.parse()?, boundary, pressure.parse()?, steps.parse()?, options)
        }
        _ => Err("write FILE N, or solve FILE N BOUNDARY PRESSURE TOLERANCE STEPS".into()),
    }
}

/// A self-affine gap, its shortest wave eight cells.
fn write(file: &str, n: usize) -> Result<()> {
    let grid = Grid::new([n, n], [1.0, 1.0])?;
    let surface = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 8.0 / n as f64,
        roll_off: 0.25,
        seed: 1,
    };
    let gap = undeformed_gap(&grid, &[Part::SelfAffine(surface)])?;
    let bytes: Vec<u8> = gap.iter().flat_map(|h| h.to_le_bytes()).collect();
    Ok(std::fs::write(file, bytes)?)
}

fn solve(
    file: &str,
    n: usize,
    boundary: Boundary,
    pressure: f64,
    steps: usize,
    options: SolverOptions,
) -> Result<()> {
    let bytes = std::fs::read(file)?;
    let heights: Vec<f64> = bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let grid = Grid::new([n, n], [1.0, 1.0])?;
    let (seconds, fraction, convolutions) = if steps == 0 {
        let problem = Problem {
            gap: &heights,
            compliance: 1.0,
            hardness: f64::INFINITY.into(),
            prescribed: Prescribed::Load(pressure),
        };
        let mut operator = half_space(grid, boundary);
        let mut solver = Solver::new(Method::ProjectedCg, &*operator);
        let mut state = ContactState::new(grid.len());
        let start = Instant::now();
        let outcome = solver.solve(&mut *operator, &problem, &options, &mut state, None)?;
        let seconds = start.elapsed().as_secs_f64();
        let touching = state.pressure.iter().filter(|p| **p > 0.0).count();
        (seconds, touching as f64 / grid.len() as f64, outcome.convolutions)
    } else {
        let gap = ndarray::Array2::from_shape_vec((n, n), heights)?;
        let terms = vec![CreepTerm { compliance: 0.125, retardation_time: 2.0 }];
        let mut march = March::new(Simulation {
            boundary,
            creep: Creep { instantaneous: 0.125, terms, fluidity: 0.0 },
            loading: Loading { control: Control::Load, history: History::Step { value: 4.0 * pressure } }
                .into(),
            times: TimeGrid::Uniform { end: 0.02 * steps as f64, steps },
            solver: options,
            ..Simulation::new(grid, gap)
        })?;
        let start = Instant::now();
        let (mut fraction, mut convolutions) = (0.0, 0);
        while let Some(step) = march.advance()? {
            let row = step.row();
            fraction = row.contact_fraction;
            convolutions += row.convolutions;
        }
        (start.elapsed().as_secs_f64(), fraction, convolutions)
    };
    let version = env!("CARGO_PKG_VERSION");
    println!(
        "{{\"seconds\": {seconds}, \"fraction\": {fraction}, \"version\": \"{version}\", \"convolutions\": {convolutions}}}"
    );
    Ok(())
}
