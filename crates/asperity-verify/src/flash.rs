//! Flash temperature: Jaeger's band that moves.

use std::sync::Arc;

use ndarray::Array2;

use super::{Check, Checks};
use asperity::error::Result;
use asperity::flash::{Conductor, Flash, FlashSolver, Partition, Rubbing};
use asperity::grid::Grid;
use asperity::simulation::Simulation;
use asperity::sliding::Direction;

/// Péclet number v b/2χ; largest temperature over q b/k, and where, over b behind the middle (Jaeger's integral, by quadrature).
const BAND: [[f64; 3]; 3] = [
    [0.1, 2.200_330_088, 0.243_530_673],
    [1.0, 0.991_850_421_751, 0.666_447_017_904],
    [10.0, 0.348_499_748_743, 0.924_381_293_113],
];

pub(super) fn band() -> Result<Vec<Check>> {
    let mut checks = Checks::new("jaeger-band", "J. C. Jaeger, Proc. R. Soc. NSW 76 (1942) 203");
    let (cells, half) = (601, 100);
    let grid = Grid::line(cells, 3.0)?;
    let (middle, b) = (cells / 2, (half as f64 + 0.5) * 3.0 / cells as f64);
    let pressure: Vec<f64> = (0..cells).map(|i| f64::from(u8::from(i.abs_diff(middle) <= half))).collect();
    let body = Conductor { conductivity: 2.0, diffusivity: 0.5 };
    for [peclet, largest, place] in BAND {
        let velocity = peclet * 2.0 * body.diffusivity / b;
        // A heat of 1 over the band.
        let flash = Flash {
            bodies: [body; 2],
            partition: Partition::Track,
            friction: 1.0 / velocity,
            hysteresis: false,
            heated_for: None,
            feedback: None,
            on_track: false,
        };
        let simulation =
            Simulation { flash: Some(Arc::new(flash)), ..Simulation::new(grid, Array2::zeros((cells, 1))) };
        let Some(mut solver) = FlashSolver::of(&simulation, Direction::X) else { continue };
        solver.warm(Rubbing { velocity, pressure: &pressure, shear: 0.0, loss: 0.0 })?;
        let t = &solver.rise.track;
        let hottest = (0..cells).fold(0, |a, i| if t[i] > t[a] { i } else { a });
        checks.relative(
            format!("largest temperature, v b/2χ = {peclet}"),
            t[hottest] * body.conductivity / b,
            largest,
            5e-3,
        );
        let behind = (grid.x(middle) - grid.x(hottest)) / b;
        checks.absolute(
            format!("its place over the half-width, v b/2χ = {peclet}"),
            (behind - place).abs(),
            0.01,
        );
    }
    Ok(checks.list)
}
