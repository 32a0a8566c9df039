//! Reading, statistics and cleaning of a large surface: `cargo bench -p asperity-files --bench surfaces -- [CELLS]`.
//!
//! Prints a table with the best of three times; the surface has CELLS x CELLS points (4096 where none is given).

use std::hint::black_box;
use std::time::Instant;

use asperity::Grid;
use asperity::surface::process::{Outliers, remove_outliers};
use asperity::surface::statistics::{Extent, HeightStatistics, SlopeStatistics, Summary};
use asperity::surface::{Fill, Level, Surface, fill, level};
use asperity_files::topography::{Format, ReadOptions, Topography, read_bytes, to_bytes};
use ndarray::Array2;

fn best<T>(mut work: impl FnMut() -> T) -> f64 {
    let times = (0..3).map(|_| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

fn main() {
    let cells = std::env::args().skip(1).find_map(|a| a.parse::<usize>().ok()).unwrap_or(4096);
    // Rough at every length, so that no branch is predictable: a Weyl sequence on a wave.
    let heights = Array2::from_shape_fn((cells, cells), |(i, j)| {
        let noise = ((i * 7919 + j) as f64 * 0.618_033_988_749_895).fract() - 0.5;
        1e-6 * ((i as f64 * 0.01).sin() * (j as f64 * 0.013).cos() + 0.1 * noise)
    });
    let topography = Topography {
        format: Format::Npz,
        heights,
        size: [1e-3, 1e-3],
        channel: None,
        channels: Vec::new(),
        metadata: Vec::new(),
    };
    println!("{cells} x {cells} points, {} threads\n", rayon::current_num_threads());
    println!("| | s | MB/s |\n|---|---|---|");
    for format in [Format::Npz, Format::Sdf, Format::Gwy, Format::NetCdf, Format::X3p, Format::Text] {
        let bytes = to_bytes(&topography, format).unwrap_or_else(|e| panic!("{format}: {e}"));
        let seconds = best(|| read_bytes(&bytes, &ReadOptions::default()).map(|s| s.undefined()));
        let rate = bytes.len() as f64 / seconds / 1e6;
        println!("| read {format} ({:.0} MB) | {seconds:.2} | {rate:.0} |", bytes.len() as f64 / 1e6);
    }
    let grid = Grid::new([cells, cells], topography.size).expect("a grid");
    let surface = Surface::new(grid, topography.heights).expect("a surface");
    let tell = |what: &str, seconds: f64| println!("| {what} | {seconds:.2} | |");
    tell("heights: Sa, Sq, Ssk, Sku, Sz", best(|| HeightStatistics::of(&surface)));
    tell("slopes: Sdq, Sdr", best(|| SlopeStatistics::of(&surface)));
    tell("all statistics, periodic", best(|| Summary::of(&surface, Extent::Periodic)));
    tell("all statistics, levelled and windowed", best(|| Summary::of(&surface, Extent::Finite)));
    tell("level by a plane", best(|| level(surface.heights(), Level::Plane)));
    let mut holed = surface.heights().to_owned();
    holed.iter_mut().step_by(37).for_each(|z| *z = f64::NAN);
    tell("fill 3 % (harmonic)", best(|| fill(&grid, holed.view(), Fill::Harmonic, 0.25)));
    tell("remove outliers", best(|| remove_outliers(&surface, Outliers::default())));
}
