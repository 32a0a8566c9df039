//! The memory of a run, counted by the allocator of this program: no other test may run beside it.

use asperity::material::{Creep, CreepTerm};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Boundary, Control, Drive, Grid, History, Loading, March, Simulation, TimeGrid};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Cells along a side, and threads: their buffers, which are not in what is expected, take 2 bytes per cell.
const SIDE: usize = 1024;
const THREADS: usize = 2;
/// Pressure and displacement of the row before: reserved, and not written before a second row is in contact.
const ROW_BEFORE: f64 = 16.0;

/// A sphere pressed on a body in one row, or in two of a creep with one term.
fn simulation(boundary: Boundary, creeps: bool) -> Simulation {
    let grid = Grid::new([SIDE, SIDE], [1e-3, 1e-3]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
    let term = CreepTerm { compliance: 1e-8, retardation_time: 1.0 };
    let terms = if creeps { vec![term] } else { vec![] };
    let history = History::Ramp { value: 0.1, duration: 1.0 };
    Simulation {
        boundary,
        creep: Creep { instantaneous: 1e-8, terms, fluidity: 0.0 },
        loading: Loading { control: Control::Load, history }.into(),
        times: TimeGrid::Uniform { end: 1.0, steps: if creeps { 2 } else { 1 } },
        ..Simulation::new(grid, undeformed_gap(&grid, &[sphere]).unwrap())
    }
}

/// Bytes per cell at the peak of a run, and those that were expected.
fn taken(boundary: Boundary, creeps: bool) -> [f64; 2] {
    let per_cell = |bytes: usize| bytes as f64 / (SIDE * SIDE) as f64;
    let before = MEMORY.current_usage();
    let simulation = simulation(boundary, creeps);
    let expected = per_cell(simulation.bytes());
    MEMORY.reset_peak_usage();
    let mut march = March::new(simulation).unwrap();
    while march.advance().unwrap().is_some() {}
    [per_cell(MEMORY.peak_usage() - before), expected]
}

#[test]
fn a_run_takes_little_memory_and_as_much_as_was_expected() {
    for (boundary, creeps, most) in [
        (Boundary::Free, false, 80.0),
        (Boundary::Periodic, false, 64.0),
        (Boundary::Free, true, 80.0 + 48.0),
        (Boundary::Periodic, true, 64.0 + 48.0),
    ] {
        let threads = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build().unwrap();
        let [taken, expected] = threads.install(|| taken(boundary, creeps));
        let taken = if creeps { taken } else { taken - ROW_BEFORE };
        assert!(taken <= most, "{boundary:?} {creeps}: {taken} bytes per cell");
        // What is expected of a free domain has room for a contact that comes close to the border: its preconditioner is larger.
        assert!((0.95..1.15).contains(&(expected / taken)), "{boundary:?} {creeps}: {expected} {taken}");
    }
}
