//! What friction costs: `cargo bench -p asperity --bench sliding -- N ...` prints a table in Markdown.
//!
//! Steady states at 31 velocities over six decades of a periodic rough surface of N x N cells on a rubber of 15 terms.

use asperity::Drive;
use std::time::Instant;

use asperity::load::{Control, History, Loading};
use asperity::material::{Creep, Relaxation};
use asperity::simulation::Simulation;
use asperity::sliding::{Direction, Slopes, Steady, SteadyMotion};
use asperity::surface::{Part, Roughness, SelfAffine, undeformed_gap};
use asperity::{Boundary, Grid, SolverOptions};

const VELOCITIES: usize = 31;
/// Fine enough for the friction to three digits.
const TOLERANCE: f64 = 1e-4;

fn main() {
    let mut sizes: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    if sizes.is_empty() {
        sizes = vec![256, 512];
    }
    println!("{} threads\n", rayon::current_num_threads());
    println!("| N | steady states, {VELOCITIES} velocities | convolutions per velocity: median | most |");
    println!("|---|---|---|---|");
    for n in sizes {
        let (seconds, mut work) = steady(n);
        work.sort_unstable();
        println!("| {n} | {seconds:.1} s | {} | {} |", work[work.len() / 2], work[work.len() - 1]);
    }
}

/// Seconds, and convolutions of each velocity.
fn steady(n: usize) -> (f64, Vec<usize>) {
    let grid = Grid::new([n, n], [1.0, 1.0]).expect("a grid");
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 8.0 / n as f64,
        roll_off: 0.25,
        seed: 1,
    };
    let parts = [Part::SelfAffine(rough)];
    let gap = undeformed_gap(&grid, &parts).expect("a gap");
    let slopes = Slopes::of(&grid, Boundary::Periodic, &parts).expect("slopes");
    let simulation = Simulation {
        boundary: Boundary::Periodic,
        creep: rubber(),
        loading: Loading { control: Control::Load, history: History::Step { value: 0.03 } }.into(),
        solver: SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() },
        ..Simulation::new(grid, gap)
    };
    let velocities = (0..VELOCITIES).map(|k| 10f64.powf(3.0 - 0.2 * k as f64)).collect();
    let motion = SteadyMotion { direction: Direction::X, velocities, slopes, shear_stress: None };
    let start = Instant::now();
    let mut steady = Steady::new(simulation, motion).expect("a sweep");
    let mut work = vec![];
    while let Some(step) = steady.advance().expect("a steady state") {
        work.push(step.row().convolutions);
    }
    (start.elapsed().as_secs_f64(), work)
}

/// 15 terms over 14 decades, 1000 times stiffer at once than relaxed.
fn rubber() -> Creep {
    let terms: Vec<(f64, f64)> =
        (0..15).map(|k| (10f64.powf(3.0 - 0.2 * f64::from(k)), 10f64.powi(k - 10))).collect();
    let total: f64 = terms.iter().map(|term| term.0).sum();
    let scaled: Vec<(f64, f64)> =
        terms.iter().map(|(modulus, time)| (999.0 * modulus / total, *time)).collect();
    Relaxation::absolute(1.0, &scaled).and_then(|e| e.to_creep()).expect("a solid")
}
