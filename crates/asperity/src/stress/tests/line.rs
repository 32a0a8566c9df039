//! Line contacts: plane strain.

use std::f64::consts::{PI, TAU};

use super::{all, pressure};
use crate::grid::{Boundary, Grid};
use crate::reference::HertzLine;
use crate::stress::*;

#[test]
fn a_strip_is_an_endless_rectangle() {
    let (half, poisson, long) = (0.7, 0.3, 1e9);
    for [x, z] in [[0.0, 0.2], [0.4, 1.0], [-1.5, 0.3], [30.0, 2.0], [0.1, 50.0], [0.2, 0.0], [-1.0, 0.0]] {
        for component in Component::ALL {
            let expected = rectangle(component, [x, 0.0], z, [half, long], poisson);
            // The parts beyond the ends add 2 (1 - 2 nu) half/(pi long) to xx and less to the others.
            let found = strip(component, x, z, half, poisson);
            assert!((found - expected).abs() < 1e-9, "{component:?} {x} {z}: {found} {expected}");
        }
    }
}

#[test]
fn far_from_a_strip_every_component_is_that_of_a_line_load() {
    // A. Flamant 1892 (Johnson 1985, eqs 2.23), of the load 2 a. The next term of zz and xx is of the order (a/r)^2.
    for [x, z] in [[3e6, 4e6], [-1e8, 1e8], [2e4, 1e6]] {
        let (r2, half) = (x * x + z * z, 0.5);
        let unit = -2.0 / PI * 2.0 * half / (r2 * r2);
        let near = |found: f64, expected: f64, scale: f64| {
            assert!((found - expected).abs() < 1e-9 * scale.abs(), "{x} {z}: {found} {expected}");
        };
        let zz = unit * z * z * z;
        near(strip(Component::Zz, x, z, half, 0.3), zz, zz);
        near(strip(Component::Xx, x, z, half, 0.3), unit * x * x * z, zz);
        near(strip(Component::Xz, x, z, half, 0.3), unit * x * z * z, unit * x * z * z);
    }
}

#[test]
fn any_depth_of_a_strip_carries_its_load() {
    for depth in [0.1, 1.0, 20.0] {
        // x = z tan(angle) makes the integrand smooth and periodic: the sum over equal angles converges exponentially.
        let count = 4000;
        let sum: f64 = (0..count)
            .map(|k| {
                let angle = (f64::from(k) + 0.5) / f64::from(count) * PI - 0.5 * PI;
                let cosine = angle.cos();
                strip(Component::Zz, depth * angle.tan(), depth, 0.5, 0.3) * depth / (cosine * cosine)
            })
            .sum();
        let load = sum * PI / f64::from(count);
        // Rounding of 4000 terms whose factor reaches 1e6.
        assert!((load + 1.0).abs() < 1e-10, "{depth}: {load}");
    }
}

#[test]
fn the_convolution_on_a_line_is_the_sum_over_its_cells() {
    let grid = Grid::line(25, 5.0).unwrap();
    let (dx, p) = (grid.spacing()[0], pressure(&grid));
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    for depth in [0.0, 0.06, 0.5, 40.0] {
        let fields = all(&mut stress, &p, depth);
        for (component, field) in Component::ALL.into_iter().zip(&fields) {
            for (n, found) in field.iter().enumerate() {
                let of = |(m, p): (usize, &f64)| {
                    p * strip(component, (n as f64 - m as f64) * dx, depth, 0.5 * dx, 0.3)
                };
                let direct: f64 = p.iter().enumerate().map(of).sum();
                // A few dozen terms of size one.
                assert!((found - direct).abs() < 1e-14, "{component:?} {depth} {n}: {found} {direct}");
            }
        }
    }
}

#[test]
fn a_wave_along_a_line_is_that_of_the_closed_form() {
    let (grid, poisson) = (Grid::line(32, 2.0).unwrap(), 0.3);
    let q = TAU / 2.0;
    let p: Vec<f64> = (0..32).map(|i| 1.0 + 0.6 * (q * grid.x(i)).cos()).collect();
    let mut stress = SubsurfaceStress::new(grid, Boundary::Periodic, poisson).unwrap();
    for depth in [0.0, 0.1, 0.7] {
        let [xx, yy, zz, xy, xz, yz] = all(&mut stress, &p, depth);
        let (t, lateral) = (q * depth, poisson / (1.0 - poisson));
        for i in 0..32 {
            let (cosine, sine) = ((q * grid.x(i)).cos(), (q * grid.x(i)).sin());
            let wave = 0.6 * (-t).exp();
            let expected = [
                -lateral - wave * (1.0 - t) * cosine,
                -lateral - 2.0 * poisson * wave * cosine,
                -1.0 - wave * (1.0 + t) * cosine,
                0.0,
                -wave * t * sine,
                0.0,
            ];
            for (found, expected) in [xx[i], yy[i], zz[i], xy[i], xz[i], yz[i]].iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14, "{depth} {i}: {found} {expected}");
            }
            // Plane strain.
            assert!((yy[i] - poisson * (xx[i] + zz[i])).abs() < 1e-14);
        }
        let sum: f64 = zz.iter().sum();
        assert!((sum + p.iter().sum::<f64>()).abs() < 1e-13, "the load is carried at any depth: {sum}");
    }
}

/// The Hertz pressure on cells of a/n, a = p0 = 1, the mean over each by its antiderivative.
fn hertz(n: usize) -> (Grid, Vec<f64>) {
    let grid = Grid::line(4 * n, 4.0).unwrap();
    let dx = grid.spacing()[0];
    let whole = |x: f64| {
        let x = x.clamp(-1.0, 1.0);
        0.5 * (x * (1.0 - x * x).sqrt() + x.asin())
    };
    let mean = |i: usize| {
        let x = grid.x(i) - 2.0;
        (whole(x + 0.5 * dx) - whole(x - 0.5 * dx)) / dx
    };
    (grid, (0..4 * n).map(mean).collect())
}

#[test]
fn hertz_on_a_line_on_and_off_the_axis() {
    // a = p0 = 1: E* = 2 R, W' = pi/2.
    let exact = HertzLine::under_load(0.5, 1.0, 0.5 * PI).unwrap();
    assert!((exact.half_width - 1.0).abs() < 1e-15 && (exact.peak_pressure - 1.0).abs() < 1e-15);
    let mut errors = [0.0_f64; 2];
    for (n, worst) in [32, 64].into_iter().zip(&mut errors) {
        let (grid, p) = hertz(n);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
        for depth in [0.25, 0.5, 0.786, 1.5] {
            let [xx, yy, zz, _, xz, _] = all(&mut stress, &p, depth);
            for i in 0..p.len() {
                let [a, b, c] = exact.stress(grid.x(i) - 2.0, depth);
                for (found, expected) in [(xx[i], a), (zz[i], b), (xz[i], c), (yy[i], 0.3 * (a + b))] {
                    *worst = worst.max((found - expected).abs());
                }
            }
        }
    }
    // Second order, and 1e-3 of p0 at 32 cells to the half width.
    assert!(errors[0] < 1e-3 && errors[0] / errors[1] > 3.0, "{errors:?}");
}

#[test]
fn the_largest_shear_under_a_cylinder_is_where_hertz_has_it() {
    // 0.3002831 p0 at 0.7861514 a for any Poisson's ratio (Johnson 1985, section 4.2(c)): z^2 = (sqrt 5 - 1)/2.
    let depth = (0.5 * (5.0_f64.sqrt() - 1.0)).sqrt();
    let shear = depth - depth * depth / (1.0 + depth * depth).sqrt();
    assert!((depth - 0.786_151_4).abs() < 1e-7 && (shear - 0.300_283_1).abs() < 1e-7);
    let (grid, p) = hertz(32);
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    stress.set_pressure(&p).unwrap();
    let depths = automatic_depths(&grid, Boundary::Free, contact_box(&grid, &p));
    // The width of the contact.
    assert!((depths[24] - 2.0).abs() < 1e-12 && (depths[1] - 0.5 / 32.0).abs() < 1e-15);
    let options = SurveyOptions { threshold: Some(0.5), rolling: Some(Rolling::X) };
    let found = survey(&mut stress, &depths, &options).unwrap();
    // Half a cell off the axis, and the place between depths.
    assert!((found.tresca.value - shear).abs() < 1e-3, "{found:?}");
    assert!((found.tresca.depth - depth).abs() < 0.03, "{found:?}");
    assert!(found.unseen.is_none() && !found.unresolved);
    assert!([63, 64].contains(&found.tresca.cell));
    // Between x = +-0.87 a at z = 0.5 a: the range is 0.5 p0 (Johnson 1985, section 4.2(c)).
    let rolling = found.orthogonal_shear.unwrap().largest;
    assert!((rolling.value - 0.5).abs() < 1e-3 && (rolling.depth - 0.5).abs() < 0.03, "{rolling:?}");
    // von Mises stress above 0.5 p0: about the width of the contact times its half width.
    let area = found.stressed_volume.unwrap();
    let exact = HertzLine::under_load(0.5, 1.0, 0.5 * PI).unwrap();
    let (nx, nz) = (400, 400);
    let above = (0..nx * nz)
        .filter(|k| {
            let [x, z] = [(k / nz) as f64 + 0.5, (k % nz) as f64 + 0.5];
            let [xx, zz, xz] = exact.stress(4.0 * x / nx as f64 - 2.0, 2.0 * z / nz as f64);
            invariants([xx, 0.3 * (xx + zz), zz, 0.0, xz, 0.0]).mises > 0.5
        })
        .count();
    let expected = 8.0 * above as f64 / (nx * nz) as f64;
    // The steps of 24 depths and of the cells.
    assert!((area / expected - 1.0).abs() < 0.03, "{area} {expected}");
}

#[test]
fn a_load_on_a_long_period_is_a_free_one_but_for_the_mean() {
    // A free line load has the mean stresses -1, -2 nu and -1 over a plane at any depth, a periodic one -nu/(1 - nu) along x and y.
    let (period, cell, nu) = (4096, 2048, 0.3);
    let mean = nu / (1.0 - nu);
    let p: Vec<f64> = (0..period).map(|i| f64::from(u8::from(i == cell))).collect();
    let grid = Grid::line(period, period as f64).unwrap();
    let of = |boundary| all(&mut SubsurfaceStress::new(grid, boundary, nu).unwrap(), &p, 30.0);
    let (free, periodic) = (of(Boundary::Free), of(Boundary::Periodic));
    let expected = [1.0 - mean, 2.0 * nu - mean, 0.0, 0.0, 0.0, 0.0].map(|sum| sum / period as f64);
    for (n, expected) in expected.into_iter().enumerate() {
        let found = periodic[n][cell + 2] - free[n][cell + 2];
        // The next loads add 4 z/(pi period^2) times pi^2/6 to xx, and a cell is not a wave: a share of 1/(24 z^2).
        assert!((found - expected).abs() < 1e-5, "{:?}: {found} {expected}", Component::ALL[n]);
    }
}
