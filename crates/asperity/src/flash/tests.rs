//! Against Jaeger's band, sources that stand still or move fast, and facts that hold on any grid.

use std::f64::consts::PI;
use std::sync::Arc;

use ndarray::Array2;

use super::conduction::Conduction;
use super::*;
use crate::grid::Grid;
use crate::sliding::Direction;

const BODY: Conductor = Conductor { conductivity: 2.0, diffusivity: 0.5 };

/// T of a body over which this heat moves.
fn rise(grid: &Grid, boundary: Boundary, direction: Direction, velocity: f64, heat: &[f64]) -> Vec<f64> {
    let mut conduction = Conduction::new(grid, boundary, direction, None);
    let spectrum = conduction.spectrum(BODY, velocity);
    let mut to = vec![0.0; heat.len()];
    conduction.apply_into(&spectrum, heat, &mut to);
    to
}

/// The band of J. C. Jaeger (1942) by quadrature of exp(u) K0(|u|) in 20 digits: v b/2χ, largest T k/(q b), its place behind the
/// middle over b, T k/(q b) in the middle.
const BAND: [[f64; 4]; 3] = [
    [0.1, 2.200_330_088_35, 0.243_530_673_233, 2.181_213_461_25],
    [1.0, 0.991_850_421_751, 0.666_447_017_904, 0.863_916_428_677],
    [10.0, 0.348_499_748_743, 0.924_381_293_113, 0.255_411_376_798],
];

#[test]
fn a_band_that_moves_is_that_of_jaeger_and_hottest_behind_its_middle() {
    let (cells, half) = (601, 100);
    let grid = Grid::line(cells, 3.0).unwrap();
    let (middle, b) = (cells / 2, (half as f64 + 0.5) * 3.0 / cells as f64);
    let heat: Vec<f64> = (0..cells).map(|i| f64::from(u8::from(i.abs_diff(middle) <= half))).collect();
    for [peclet, largest, place, centre] in BAND {
        for sign in [1.0, -1.0] {
            let velocity = sign * peclet * 2.0 * BODY.diffusivity / b;
            let t = rise(&grid, Boundary::Free, Direction::X, velocity, &heat);
            let over = |t: f64| t * BODY.conductivity / b;
            let hottest = (0..cells).max_by(|i, j| t[*i].total_cmp(&t[*j])).unwrap();
            // The integral over the cells is that over the band; the rule for s has 1e-8.
            assert!((over(t[middle]) / centre - 1.0).abs() < 1e-7, "{peclet}: {}", over(t[middle]));
            // The largest of cells of b/100 lies a quarter of a cell off, where T is flat to a square.
            assert!((over(t[hottest]) / largest - 1.0).abs() < 1e-4, "{peclet}: {}", over(t[hottest]));
            let behind = sign * (grid.x(middle) - grid.x(hottest)) / b;
            assert!((behind - place).abs() < 0.01, "{peclet}: {behind}");
        }
    }
}

#[test]
fn a_square_that_stands_still_has_its_closed_form() {
    // ∫ dA/(2π r) over a square of sides 2l is (4 l/π) asinh 1.
    let grid = Grid::new([25, 21], [2.5, 2.1]).unwrap();
    let inside = |i: usize, j: usize| i.abs_diff(12) <= 4 && j.abs_diff(10) <= 4;
    let heat: Vec<f64> = (0..grid.len()).map(|n| f64::from(u8::from(inside(n / 21, n % 21)))).collect();
    let t = rise(&grid, Boundary::Free, Direction::X, 0.0, &heat);
    let exact = 4.0 * 0.45 / PI * libm::asinh(1.0) / BODY.conductivity;
    // Panels of 35 % with eight points, and (L/S)² of the end of the moments.
    assert!((t[12 * 21 + 10] / exact - 1.0).abs() < 1e-7, "{}", t[12 * 21 + 10] / exact);
}

#[test]
fn a_disc_that_stands_still_has_q_a_over_k_in_its_middle() {
    let n = 129;
    let grid = Grid::new([n, n], [2.2, 2.2]).unwrap();
    let middle = n / 2;
    let inside = |i: usize, j: usize| libm::hypot(grid.x(i) - 1.1, grid.y(j) - 1.1) <= 1.0;
    let heat: Vec<f64> = (0..grid.len()).map(|k| f64::from(u8::from(inside(k / n, k % n)))).collect();
    let t = rise(&grid, Boundary::Free, Direction::X, 0.0, &heat)[middle * n + middle];
    // The steps of the rim: a share of a cell in the radius.
    assert!((t * BODY.conductivity - 1.0).abs() < 0.2 * 2.2 / n as f64, "{t}");
}

/// The mean over a cell that is `x` away of what an even cell has spread, once in time s = √(4χt), in one direction and over its images.
fn spread(x: f64, side: f64, length: f64, s: f64) -> f64 {
    let ramp = |x: f64| x * libm::erf(x / s) + s / PI.sqrt() * libm::exp(-(x / s).powi(2));
    let images = (-40..=40).map(|n| x + f64::from(n) * length);
    images.map(|x| (ramp(x + side) - 2.0 * ramp(x) + ramp(x - side)) / side).sum()
}

#[test]
fn on_a_periodic_domain_a_cell_warms_by_the_sum_over_its_past() {
    // T = 1/(4k√π) ∫ ds X(s) Y(s) up to √(4χt), with the source s² v/4χ ahead.
    let (grid, time) = (Grid::new([8, 6], [8.0, 3.0]).unwrap(), 3.0);
    for (angle, velocity) in [(0.0, 0.0), (0.0, 3.0), (0.0, -40.0), (0.5, 10.0)] {
        let mut conduction = Conduction::new(&grid, Boundary::Periodic, Direction::Angle(angle), Some(time));
        let spectrum = conduction.spectrum(BODY, velocity);
        let (mut heat, mut t) = (vec![0.0; 48], vec![0.0; 48]);
        heat[0] = 1.0;
        conduction.apply_into(&spectrum, &heat, &mut t);
        let end = (4.0 * BODY.diffusivity * time).sqrt();
        let steps = 4000;
        let largest = t.iter().copied().fold(0.0, f64::max);
        for (i, j) in [(0, 0), (3, 2), (7, 0), (6, 5)] {
            let exact: f64 = (0..steps)
                .map(|n| end * (f64::from(n) + 0.5) / f64::from(steps))
                .map(|s| {
                    let moved = velocity * s * s / (4.0 * BODY.diffusivity);
                    let x = i as f64 + moved * libm::cos(angle);
                    let y = 0.5 * j as f64 + moved * libm::sin(angle);
                    spread(x.rem_euclid(8.0), 1.0, 8.0, s) * spread(y.rem_euclid(3.0), 0.5, 3.0, s)
                })
                .sum::<f64>()
                * end
                / f64::from(steps)
                / (4.0 * PI.sqrt() * BODY.conductivity);
            // Waves beyond the third shortest are a density.
            assert!(
                (t[i * 6 + j] - exact).abs() < 2e-3 * largest,
                "{velocity} {i} {j}: {} {exact}",
                t[i * 6 + j]
            );
        }
    }
}

#[test]
fn a_short_heating_of_a_periodic_domain_cools_nothing() {
    let grid = Grid::new([64, 64], [20e-3, 20e-3]).unwrap();
    let rubber = Conductor { conductivity: 0.3, diffusivity: 1e-7 };
    let heat: Vec<f64> = (0..grid.len()).map(|n| f64::from(u8::from((n * 7919) % 64 < 40))).collect();
    for time in [1e-6, 1e-5, 1e-4, 1e-2] {
        let mut conduction = Conduction::new(&grid, Boundary::Periodic, Direction::X, Some(time));
        let spectrum = conduction.spectrum(rubber, 10.0);
        let mut t = vec![0.0; heat.len()];
        conduction.apply_into(&spectrum, &heat, &mut t);
        let [least, most] = t.iter().fold([0.0f64; 2], |[a, b], t| [a.min(*t), b.max(*t)]);
        assert!(least > -1e-3 * most, "{time}: {least} {most}");
    }
}

#[test]
fn a_fast_source_leaves_the_layer_of_an_even_flux() {
    // At a distance x behind its edge a wide source has heated the surface for x/v: T = (2 q/k) √(χ x/(π v)).
    let grid = Grid::new([40, 9], [4.0, 90.0]).unwrap();
    let heat = vec![1.0; grid.len()];
    for peclet in [1e1, 1e3, 1e6, 1e12] {
        let velocity = peclet * 2.0 * BODY.diffusivity / 0.1;
        let t = rise(&grid, Boundary::Free, Direction::X, velocity, &heat);
        for i in [0, 5, 20, 37] {
            let x = 4.0 - grid.x(i);
            let exact = 2.0 / BODY.conductivity * (BODY.diffusivity * x / (PI * velocity)).sqrt();
            // The edge of the source is a diffusion length wide, 1/(v/2χ x) of the place; edges that are not resolved have less.
            let tolerance = (2.0 / (peclet * x / 0.1)).max(2e-4);
            let found = t[i * 9 + 4];
            assert!((found / exact - 1.0).abs() < tolerance, "{peclet} {i}: {}", found / exact);
        }
    }
}

#[test]
fn far_cells_are_points_and_the_axes_are_alike() {
    let grid = Grid::new([24, 17], [2.4, 1.7]).unwrap();
    let mut heat = vec![0.0; grid.len()];
    heat[20 * 17 + 8] = 1.0;
    let velocity = 3.0;
    let t = rise(&grid, Boundary::Free, Direction::X, velocity, &heat);
    let a = velocity / (2.0 * BODY.diffusivity);
    for (i, j) in [(4, 8), (3, 12), (10, 2)] {
        let (x, y) = (grid.x(i) - grid.x(20), grid.y(j) - grid.y(8));
        let r = libm::hypot(x, y);
        let point = 0.01 * libm::exp(-a * (r + x)) / (2.0 * PI * BODY.conductivity * r);
        // The cell is a tenth of the distance: second order.
        assert!((t[i * 17 + j] / point - 1.0).abs() < 0.01, "{i} {j}: {}", t[i * 17 + j] / point);
    }
    // A source that moves along -y over the turned grid.
    let turned = Grid::new([17, 24], [1.7, 2.4]).unwrap();
    let mut heat = vec![0.0; grid.len()];
    heat[8 * 24 + 3] = 1.0;
    let same = rise(&turned, Boundary::Free, Direction::Y, -velocity, &heat);
    // Roundings of the transforms.
    let apart = (0..grid.len()).map(|n| (t[n] - same[(n % 17) * 24 + 23 - n / 17]).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-14, "{apart}");
}

/// A patch of 12 x 12 cells in contact, part of it pressed harder.
fn patch() -> (Grid, Vec<f64>) {
    let grid = Grid::new([32, 32], [32.0, 32.0]).unwrap();
    let p =
        |i: usize, j: usize| if (10..22).contains(&i) && (8..20).contains(&j) { 1.0 + i as f64 } else { 0.0 };
    (grid, (0..grid.len()).map(|n| p(n / 32, n % 32)).collect())
}

fn warmed(flash: Flash, boundary: Boundary, velocity: f64) -> FlashSolver {
    let (grid, pressure) = patch();
    let flash = Some(Arc::new(flash));
    let simulation = Simulation { flash, boundary, ..Simulation::new(grid, Array2::zeros((32, 32))) };
    simulation.flash.as_ref().unwrap().validate(&simulation).unwrap();
    let mut solver = FlashSolver::of(&simulation, Direction::X).unwrap();
    solver.warm(Rubbing { velocity, pressure: &pressure, shear: 0.5, loss: 0.0 }).unwrap();
    solver
}

fn flash(partition: Partition, heated_for: Option<f64>) -> Flash {
    let other = Conductor { conductivity: 0.3, diffusivity: 2.0 };
    let bodies = [other, BODY];
    Flash { bodies, partition, friction: 0.4, hysteresis: false, heated_for, feedback: None, on_track: false }
}

#[test]
fn both_faces_are_equally_warm_in_the_mean_or_in_each_cell() {
    let (_, pressure) = patch();
    let contact: Vec<usize> = (0..pressure.len()).filter(|n| pressure[*n] > 0.0).collect();
    let mean = |t: &[f64]| partition::mean(t, &contact);
    for (boundary, heated_for) in [(Boundary::Free, None), (Boundary::Periodic, Some(3.0))] {
        let solver = warmed(flash(Partition::Mean, heated_for), boundary, 0.7);
        let Rise { slider, track, row } = &solver.rise;
        assert!((mean(slider) / mean(track) - 1.0).abs() < 1e-12);
        let heat: f64 = pressure.iter().filter(|p| **p > 0.0).map(|p| 0.7 * (0.4 * p + 0.5)).sum();
        assert!((row.power / heat - 1.0).abs() < 1e-12 && row.share > 0.0 && row.share < 1.0);
        let of_means = row.share;

        let solver = warmed(flash(Partition::Local, heated_for), boundary, 0.7);
        let Rise { slider, track, row } = &solver.rise;
        let apart = contact.iter().map(|n| (slider[*n] - track[*n]).abs()).fold(0.0, f64::max);
        // The tolerance of the partition is that of the root of the sum of squares.
        assert!(apart < 1e-7 * row.max, "{apart} of {}", row.max);
        // The shares differ by what the faces differ locally.
        assert!((row.share / of_means - 1.0).abs() < 0.2, "{} {of_means}", row.share);
    }
    // The whole and the parts: with one body alone the other stays cold.
    let all = warmed(flash(Partition::Track, None), Boundary::Free, 0.7);
    assert!(all.rise.row.share == 0.0 && all.rise.slider.iter().all(|t| *t == 0.0));
}

#[test]
fn nothing_is_warm_at_rest_and_the_motion_mirrors() {
    for partition in [Partition::Mean, Partition::Track] {
        let still = warmed(flash(partition, None), Boundary::Free, 0.0);
        assert!(still.rise.row.max == 0.0 && still.rise.row.power == 0.0);
    }
    let (grid, pressure) = patch();
    let [there, back] = [0.7, -0.7].map(|v| rise(&grid, Boundary::Free, Direction::X, v, &pressure));
    let middle = |t: &[f64]| {
        let sum = t.iter().enumerate().map(|(n, t)| t * (n / 32) as f64).sum::<f64>();
        sum / t.iter().sum::<f64>()
    };
    assert!(middle(&there) < 14.0 && middle(&back) > 17.0, "{} {}", middle(&there), middle(&back));
}

#[test]
fn where_no_surface_moves_the_source_stands_still_in_the_track() {
    let rise_of = |moves: bool, bodies: [Conductor; 2], velocity: f64| {
        let flash = Flash { bodies, on_track: !moves, ..flash(Partition::Mean, None) };
        warmed(flash, Boundary::Free, velocity).rise
    };
    let [a, b] = flash(Partition::Mean, None).bodies;
    // The same rubbing, seen from the other body.
    let (still, moving) = (rise_of(false, [a, b], 0.7), rise_of(true, [b, a], -0.7));
    assert_eq!(still.track, moving.slider);
    assert_eq!(still.slider, moving.track);
    assert!((still.row.share - (1.0 - moving.row.share)).abs() < 1e-15);
    assert!((still.row.mean / rise_of(true, [a, b], 0.7).row.mean - 1.0).abs() > 0.01);
}

#[test]
fn an_even_flux_on_a_periodic_domain_divides_as_the_effusivities() {
    let grid = Grid::new([8, 8], [8.0, 8.0]).unwrap();
    let flash = flash(Partition::Local, Some(5.0));
    let [slider, track] = flash.bodies.map(|body| body.conductivity / body.diffusivity.sqrt());
    let simulation = Simulation {
        flash: Some(Arc::new(flash)),
        boundary: Boundary::Periodic,
        ..Simulation::new(grid, Array2::zeros((8, 8)))
    };
    let mut solver = FlashSolver::of(&simulation, Direction::Angle(0.4)).unwrap();
    solver.warm(Rubbing { velocity: 2.0, pressure: &[1.0; 64], shear: 0.0, loss: 0.0 }).unwrap();
    let row = solver.rise.row;
    assert!((row.share / (slider / (slider + track)) - 1.0).abs() < 1e-7);
    // T = 2 q √(t/π)/(e1 + e2)
    let exact = 2.0 * 0.4 * 2.0 * (5.0 / PI).sqrt() / (slider + track);
    assert!((row.mean / exact - 1.0).abs() < 1e-7 && (row.max / exact - 1.0).abs() < 1e-7);
}

#[test]
fn feedback_settles_or_says_so() {
    // T falls with the temperature of the material, steeply.
    for steepness in [0.0, 0.01, 0.1, 1.0] {
        let mut rounds = 0;
        let x = settle(1.0, 0.0, |x| {
            rounds += 1;
            Ok(100.0 * libm::exp(-steepness * x))
        });
        let x = x.unwrap();
        assert!((100.0 * libm::exp(-steepness * x) - x).abs() <= 3e-3 * x.max(1.0) && rounds <= 10);
    }
    assert!(settle(1.0, 0.0, |x| Ok(2.0 * x + 1.0)).is_err());
    // A step that heats from 20 K on: from below it settles at 10 K, from above at 70 K, and each sees the other one.
    let step = |x: f64| 10.0 + 60.0 / (1.0 + libm::exp(20.0 - x));
    let [cold, warm] = [0.0, 100.0].map(|start| settle(1.0, start, |x| Ok(step(x))).unwrap());
    assert!((cold - 10.0).abs() < 0.05 && (warm - 70.0).abs() < 0.3, "{cold} {warm}");
    let other = |x: f64| another(x, |y| Some(step(y) / step(x)));
    assert!(
        (other(cold).unwrap() / 70.0 - 1.0).abs() < 0.1 && (other(warm).unwrap() / 10.0 - 1.0).abs() < 0.1
    );
    assert!(another(30.0, |y| Some(30.0 / y)).is_none());
}
