//! A march allocates nothing per step after the first ones.

#![allow(unsafe_code)] // a counting allocator is an unsafe trait

use asperity::Drive;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use asperity::drive::March;

use asperity::material::{Creep, CreepTerm};
use asperity::simulation::Simulation;
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Control, Grid, History, Loading, TimeGrid};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn steps_allocate_nothing_after_the_first() {
    // Inside a pool: a call from outside queues work for it, which allocates now and then.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    pool.install(|| {
        let grid = Grid::new([128, 128], [2e-3, 2e-3]).unwrap();
        let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
        let gap = undeformed_gap(&grid, &[sphere]).unwrap();
        let terms = vec![CreepTerm { compliance: 1e-8, retardation_time: 1.0 }];
        let mut march = March::new(Simulation {
            creep: Creep { instantaneous: 1e-8, terms, fluidity: 1e-9 },
            hardness: 3e6,
            loading: Loading { control: Control::Load, history: History::Step { value: 1.0 } }.into(),
            times: TimeGrid::Uniform { end: 10.0, steps: 20 },
            ..Simulation::new(grid, gap)
        })
        .unwrap();
        // Rows 0 and 1: the workers' queues grow to their size.
        for _ in 0..2 {
            march.advance().unwrap();
        }
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        let mut rows = 0;
        while let Some(step) = march.advance().unwrap() {
            rows += usize::from(step.row().contact_area > 0.0);
        }
        let allocated = ALLOCATIONS.load(Ordering::Relaxed) - before;
        assert_eq!((rows, allocated), (19, 0));
    });
}
