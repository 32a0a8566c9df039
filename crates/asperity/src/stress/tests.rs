//! The stress against closed forms and quadrature that share no code with it.

use std::f64::consts::TAU;

use super::*;
use crate::grid::{Boundary, Grid};

mod line;

/// A row of reference numbers; components in the order of [`Component::ALL`].
type Rectangle = ([f64; 2], f64, [f64; 3], [f64; 6]);
type Sinusoid = (f64, [f64; 2], f64, [f64; 6]);
/// r, z, (rr, tt, zz, rz), von Mises, Tresca.
type Hertz = (f64, f64, [f64; 4], f64, f64);

/// Unit pressure on a rectangle of these half sides, by Gauss quadrature of the point load with 192 x 192 points.
#[rustfmt::skip]
const RECTANGLES: [Rectangle; 16] = [
    ([1.0, 1.0], 0.3, [0.0, 0.0, 0.5], [-0.30250230385003146, -0.30250230385003146, -0.9298650158644431, 0.0, 0.0, 0.0]),
    ([1.0, 1.0], 0.3, [0.0, 0.0, 1.0], [-0.08289036819273597, -0.08289036819273597, -0.7008859302811946, 0.0, 0.0, 0.0]),
    ([1.0, 1.0], 0.3, [1.0, 0.7, 0.25], [-0.2470143099847649, -0.2152469993738257, -0.4671958378562249, -0.01763183867917435, -0.277788489919835, -0.06146303414509693]),
    ([1.0, 1.0], 0.3, [1.7, -0.6, 0.35], [-0.07982280055611995, -0.055251037241641765, -0.014529979915294871, 0.002285713235379485, -0.0413650895728531, 0.009391756743510105]),
    ([1.0, 1.0], 0.5, [0.0, 0.0, 0.5], [-0.420569197970378, -0.420569197970378, -0.9298650158644431, 0.0, 0.0, 0.0]),
    ([1.0, 1.0], 0.5, [0.0, 0.0, 1.0], [-0.14955703485940264, -0.14955703485940264, -0.7008859302811946, 0.0, 0.0, 0.0]),
    ([1.0, 1.0], 0.5, [1.0, 0.7, 0.25], [-0.3419705501362773, -0.263284166486131, -0.4671958378562249, -0.07429679599475521, -0.277788489919835, -0.06146303414509693]),
    ([1.0, 1.0], 0.5, [1.7, -0.6, 0.35], [-0.1304703723265194, -0.027619437427097163, -0.014529979915294871, 0.029500566473787706, -0.0413650895728531, 0.009391756743510105]),
    ([1.0, 0.7], 0.3, [0.0, 0.0, 0.5], [-0.265704061410669, -0.20119629486932106, -0.8823376735579772, 0.0, 0.0, 0.0]),
    ([1.0, 0.7], 0.3, [0.0, 0.0, 1.0], [-0.06747651031991282, -0.027070032341266537, -0.5965452403826805, 0.0, 0.0, 0.0]),
    ([1.0, 0.7], 0.3, [1.0, 0.7, 0.25], [-0.15257492657656774, -0.15887537094439533, -0.24929028657738964, -0.06205748329949769, -0.15527967558372263, -0.15391769368550198]),
    ([1.0, 0.7], 0.3, [1.7, -0.6, 0.35], [-0.057580292936685734, -0.0410099998169492, -0.01053907673811336, 0.006221729473403029, -0.030075081844225523, 0.010612330402495746]),
    ([1.0, 0.7], 0.5, [0.0, 0.0, 0.5], [-0.3838040466818907, -0.29067139111163276, -0.8823376735579772, 0.0, 0.0, 0.0]),
    ([1.0, 0.7], 0.5, [0.0, 0.0, 1.0], [-0.1246000461004979, -0.07626830933665991, -0.5965452403826805, 0.0, 0.0, 0.0]),
    ([1.0, 0.7], 0.5, [1.0, 0.7, 0.25], [-0.20449474202706475, -0.1932233376628757, -0.24929028657738964, -0.1276495647489505, -0.15527967558372263, -0.15391769368550198]),
    ([1.0, 0.7], 0.5, [1.7, -0.6, 0.35], [-0.09509518573044062, -0.0202842407911556, -0.01053907673811336, 0.031908921603838084, -0.030075081844225523, 0.010612330402495746]),
];

/// p = 1 + 0.6 cos(2 pi x) cos(4 pi y), closed form.
#[rustfmt::skip]
const SINUSOID: [Sinusoid; 6] = [
    (0.3, [0.1, 0.07], 0.0, [-0.6389716594256493, -0.7132305644330212, -1.3094121041973832, 0.04347804679676727, 0.0, 0.0]),
    (0.3, [0.1, 0.07], 0.05, [-0.5112604597742717, -0.4834438946032816, -1.2609371210023874, -0.016286395848545982, -0.034983590866282506, -0.11640859385098444]),
    (0.3, [0.1, 0.07], 0.2, [-0.4307699896916898, -0.4038325120002512, -1.0709771436374593, -0.015771696546548496, -0.01700876944859757, -0.05659701836254713]),
    (0.5, [0.1, 0.07], 0.0, [-1.3094121041973834, -1.3094121041973834, -1.3094121041973832, 0.0, 0.0, 0.0]),
    (0.5, [0.1, 0.07], 0.05, [-1.1317350149858687, -1.0671339619776095, -1.2609371210023874, -0.03782344495296164, -0.034983590866282506, -0.11640859385098444]),
    (0.5, [0.1, 0.07], 0.2, [-1.0081600119739895, -0.9767514461422547, -1.0709771436374593, -0.018389486014047038, -0.01700876944859757, -0.05659701836254713]),
];

/// Hertz, a = p0 = 1, nu = 0.3: Hankel integrals by adaptive quadrature.
#[rustfmt::skip]
const HERTZ: [Hertz; 4] = [
    (0.5, 0.25, [-0.32045744327007236, -0.3258124394719697, -0.7929590344741535, -0.11923536846788377], 0.5132323106834162, 0.2646346755742134),
    (0.5, 0.5, [-0.16294716161087586, -0.1423096536356295, -0.6508508260346444, -0.15364503815606598], 0.5651242354643835, 0.2883041695666476),
    (1.0, 0.5, [-0.15909143638968454, -0.06410036578834265, -0.23663586024436462, -0.18475969658801242], 0.35328586931258216, 0.18878408275337455),
    (1.5, 0.5, [-0.09025550577736913, -0.029019164901613888, -0.03267342917179179, -0.061050860855906594], 0.12133050792134305, 0.06749912220021763),
];

#[test]
fn a_loaded_rectangle_is_that_of_the_quadrature() {
    for (half, poisson, [x, y, z], expected) in RECTANGLES {
        for (component, expected) in Component::ALL.into_iter().zip(expected) {
            let found = rectangle(component, [x, y], z, half, poisson);
            assert!(
                (found - expected).abs() < 1e-12,
                "{component:?} {half:?} {poisson} {x} {y} {z}: {found} {expected}"
            );
        }
    }
}

fn all(stress: &mut SubsurfaceStress, p: &[f64], depth: f64) -> [Vec<f64>; 6] {
    let mut fields = std::array::from_fn(|_| Vec::new());
    stress.set_pressure(p).unwrap();
    stress.at(depth, &mut fields).unwrap();
    fields
}

#[test]
fn a_wave_is_that_of_the_closed_form() {
    // (0.1, 0.07) is a cell centre of it.
    let grid = Grid::new([25, 50], [1.0, 1.0]).unwrap();
    let p: Vec<f64> = (0..grid.len())
        .map(|n| 1.0 + 0.6 * (TAU * grid.x(n / 50)).cos() * (2.0 * TAU * grid.y(n % 50)).cos())
        .collect();
    for (poisson, [x, y], depth, expected) in SINUSOID {
        let mut stress = SubsurfaceStress::new(grid, Boundary::Periodic, poisson).unwrap();
        let cell = (0..grid.len())
            .find(|n| (grid.x(n / 50) - x).abs() < 1e-9 && (grid.y(n % 50) - y).abs() < 1e-9)
            .unwrap();
        let fields = all(&mut stress, &p, depth);
        for (k, expected) in expected.into_iter().enumerate() {
            // Rounding of transforms of a thousand cells.
            assert!(
                (fields[k][cell] - expected).abs() < 1e-13,
                "{k} {poisson} {depth}: {} {expected}",
                fields[k][cell]
            );
        }
    }
}

/// A pressure for any grid.
fn pressure(grid: &Grid) -> Vec<f64> {
    (0..grid.len()).map(|n| ((n * 37 % 11) as f64 - 3.0).max(0.0) / 7.0).collect()
}

fn under_tractions(grid: Grid, boundary: Boundary, tractions: [&[f64]; 2], depth: f64) -> [Vec<f64>; 6] {
    let mut stress = SubsurfaceStress::new(grid, boundary, 0.3).unwrap();
    stress.set_pressure(&vec![0.0; grid.len()]).unwrap();
    stress.add_tractions(tractions).unwrap();
    let mut fields = std::array::from_fn(|_| Vec::new());
    stress.at(depth, &mut fields).unwrap();
    fields
}

/// Stress at (0.7, 0.4, 0.9) under a unit force along x at the origin, nu = 0.3, times 2 pi: derivatives of the potentials by a
/// computer algebra system, which also confirmed equilibrium and compatibility.
const POINT: [f64; 6] = [
    -0.359643806773782,
    -0.0116063108287630,
    -0.660422976408626,
    -0.236626412688174,
    -0.513662314984487,
    -0.293521322848278,
];

#[test]
fn a_tangential_force_is_that_of_the_closed_form() {
    // A cell of unit traction at the middle, the point 7, 4 and 9 tenths away; of a cell of 1e-3 the force is 1e-6.
    let spacing = 2e-3;
    let grid = Grid::new([800, 500], [800.0 * spacing, 500.0 * spacing]).unwrap();
    let cell = |i: usize, j: usize| i * 500 + j;
    let mut q = vec![0.0; grid.len()];
    q[cell(400, 250)] = 1.0 / spacing.powi(2);
    let (none, at) = (vec![0.0; grid.len()], cell(750, 450));
    let along_x = under_tractions(grid, Boundary::Free, [&q, &none], 0.9);
    for (field, expected) in along_x.iter().zip(POINT) {
        // The cell is 2e-3 of the distance wide: 1e-6 of it. The four corners cancel to 1e-16 * 1e6.
        assert!((TAU * field[at] - expected).abs() < 2e-6, "{} {expected}", TAU * field[at]);
    }
}

#[test]
fn tractions_along_y_are_those_along_x_with_the_axes_exchanged() {
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let (one, other) =
            (Grid::new([10, 14], [3.0, 2.0]).unwrap(), Grid::new([14, 10], [2.0, 3.0]).unwrap());
        let q = pressure(&one);
        let exchanged: Vec<f64> = (0..140).map(|n| q[(n % 10) * 14 + n / 10]).collect();
        let none = vec![0.0; 140];
        for depth in [0.0, 0.4] {
            let x = under_tractions(one, boundary, [&q, &none], depth);
            let y = under_tractions(other, boundary, [&none, &exchanged], depth);
            for (k, l) in [1, 0, 2, 3, 5, 4].into_iter().enumerate() {
                for n in 0..140 {
                    let (a, b) = (x[k][n], y[l][(n % 14) * 10 + n / 14]);
                    assert!((a - b).abs() < 1e-13, "{boundary:?} {depth} {k} {n}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_small_periodic_patch_is_that_of_a_free_domain_and_the_surface_bears_the_traction() {
    let n = 128;
    let grid = Grid::new([n, n], [64.0, 64.0]).unwrap();
    // Without force in all: the rest of the periodic array is far away.
    let hill = |n: usize| {
        let (x, y) = ((grid.x(n / 128) - 32.0) / 2.0, (grid.y(n % 128) - 32.0) / 2.0);
        x * (-0.5 * (x * x + y * y)).exp()
    };
    let q: Vec<f64> = (0..n * n).map(hill).collect();
    let none = vec![0.0; n * n];
    let [free, periodic] =
        [Boundary::Free, Boundary::Periodic].map(|b| under_tractions(grid, b, [&q, &none], 1.0));
    let most = free.iter().flatten().fold(0.0f64, |most, s| most.max(s.abs()));
    for (a, b) in free.iter().flatten().zip(periodic.iter().flatten()) {
        // Cells against waves, a quarter of a standard deviation wide (h^2/24 of the curvature), and images 32 of them away.
        assert!((a - b).abs() < 5e-3 * most, "{a} {b}");
    }
    let surface = under_tractions(grid, Boundary::Free, [&q, &none], 0.0);
    for (k, field) in surface.iter().enumerate().filter(|(k, _)| [2, 4, 5].contains(k)) {
        for (found, q) in field.iter().zip(&q) {
            // zz and yz vanish, xz is the traction.
            let expected = if k == 4 { -q } else { 0.0 };
            assert!((found - expected).abs() < 1e-13, "{k}: {found}");
        }
    }
}

#[test]
fn a_line_of_tractions_is_that_of_a_wide_plane() {
    let (cells, rows) = (24, 181);
    let line = Grid::line(cells, 12.0).unwrap();
    // The middle of a long strip sees plane strain.
    let plane = Grid::new([cells, rows], [12.0, 2.0 * rows as f64]).unwrap();
    let q: Vec<f64> = (0..cells).map(|n| ((n * 5 % 7) as f64 - 2.0) / 3.0).collect();
    let mean = q.iter().sum::<f64>() / cells as f64;
    let q: Vec<f64> = q.into_iter().map(|q| q - mean).collect();
    let spread: Vec<f64> = q.iter().flat_map(|q| vec![*q; rows]).collect();
    for axis in 0..2 {
        let none = vec![0.0; rows * cells];
        let along = |q: &[f64], none: &[f64], grid, depth| {
            let tractions = if axis == 0 { [q, none] } else { [none, q] };
            under_tractions(grid, Boundary::Free, tractions, depth)
        };
        for depth in [0.0, 0.6, 3.0] {
            let (one, other) = (along(&q, &none[..cells], line, depth), along(&spread, &none, plane, depth));
            for (k, (one, other)) in one.iter().zip(&other).enumerate() {
                for n in 0..cells {
                    // The ends of the strip are fifteen times its width away.
                    let (a, b) = (one[n], other[rows * n + rows / 2]);
                    assert!((a - b).abs() < 2e-3, "{axis} {depth} {k} {n}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn the_convolution_is_the_sum_over_the_loaded_cells() {
    let grid = Grid::new([12, 20], [6.0, 5.0]).unwrap();
    let ([dx, dy], p) = (grid.spacing(), pressure(&grid));
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    for depth in [0.0, 0.3, 2.0, 40.0] {
        let fields = all(&mut stress, &p, depth);
        for (component, field) in Component::ALL.into_iter().zip(&fields) {
            for (n, found) in field.iter().enumerate() {
                let direct: f64 = p
                    .iter()
                    .enumerate()
                    .map(|(m, p)| {
                        let x = (n / 20) as f64 - (m / 20) as f64;
                        let y = (n % 20) as f64 - (m % 20) as f64;
                        p * rectangle(component, [x * dx, y * dy], depth, [0.5 * dx, 0.5 * dy], 0.3)
                    })
                    .sum();
                // A few hundred terms of size one.
                assert!((found - direct).abs() < 1e-13, "{component:?} {depth} {n}: {found} {direct}");
            }
        }
    }
}

#[test]
fn identities_at_the_surface_and_in_the_mean() {
    for (boundary, cells) in
        [(Boundary::Free, [9, 14]), (Boundary::Periodic, [9, 14]), (Boundary::Periodic, [16, 15])]
    {
        let grid = Grid::new(cells, [1.0, 2.0]).unwrap();
        let (p, poisson) = (pressure(&grid), 0.2);
        let mut stress = SubsurfaceStress::new(grid, boundary, poisson).unwrap();
        let [xx, yy, zz, _, xz, yz] = all(&mut stress, &p, 0.0);
        let mean = p.iter().sum::<f64>() / p.len() as f64;
        // The uniform part of a periodic pressure has no lateral strain: instead, its xx + yy is -2 nu/(1 - nu) times it.
        let lateral = if boundary == Boundary::Periodic {
            2.0 * poisson / (1.0 - poisson)
        } else {
            1.0 + 2.0 * poisson
        };
        for n in 0..p.len() {
            assert!((zz[n] + p[n]).abs() < 1e-13, "{boundary:?} {n}");
            assert!(xz[n].abs() < 1e-13 && yz[n].abs() < 1e-13);
            let expected = -(1.0 + 2.0 * poisson) * (p[n] - mean) - lateral * mean;
            let expected = if boundary == Boundary::Free { -(1.0 + 2.0 * poisson) * p[n] } else { expected };
            assert!(
                (xx[n] + yy[n] - expected).abs() < 2e-13,
                "{boundary:?} {n}: {} {expected}",
                xx[n] + yy[n]
            );
        }
        if boundary == Boundary::Periodic {
            let [_, _, zz, ..] = all(&mut stress, &p, 0.3);
            let sum: f64 = zz.iter().sum::<f64>() + p.iter().sum::<f64>();
            assert!(sum.abs() < 1e-12, "the load is carried at any depth: {sum}");
        }
    }
}

#[test]
fn exchanging_the_axes_exchanges_the_components() {
    let grid = Grid::new([10, 7], [2.0, 1.0]).unwrap();
    let turned = Grid::new([7, 10], [1.0, 2.0]).unwrap();
    let p = pressure(&grid);
    let transposed = |field: &[f64]| -> Vec<f64> { (0..70).map(|n| field[n % 10 * 7 + n / 10]).collect() };
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let mut stress = SubsurfaceStress::new(grid, boundary, 0.4).unwrap();
        let [xx, _, _, xy, xz, _] = all(&mut stress, &p, 0.15);
        let mut stress = SubsurfaceStress::new(turned, boundary, 0.4).unwrap();
        let [_, yy, _, yx, _, yz] = all(&mut stress, &transposed(&p), 0.15);
        for (a, b) in [(&xx, &yy), (&xy, &yx), (&xz, &yz)] {
            for (a, b) in transposed(a).iter().zip(b) {
                assert!((a - b).abs() < 1e-13, "{boundary:?}");
            }
        }
    }
}

/// The Hertz pressure on cells of a/n, the mean over each by 4 x 4 points.
fn hertz(n: usize) -> (Grid, Vec<f64>) {
    let cells = 4 * n;
    let grid = Grid::new([cells, cells], [4.0, 4.0]).unwrap();
    let dx = grid.spacing()[0];
    let p = (0..grid.len())
        .map(|k| {
            let (x, y) = (grid.x(k / cells) - 2.0, grid.y(k % cells) - 2.0);
            let points = (0..16).map(|m| {
                let (u, v) = (x + dx * ((m / 4) as f64 - 1.5) / 4.0, y + dx * ((m % 4) as f64 - 1.5) / 4.0);
                (1.0 - u * u - v * v).max(0.0).sqrt()
            });
            points.sum::<f64>() / 16.0
        })
        .collect();
    (grid, p)
}

#[test]
fn hertz_off_the_axis() {
    let (grid, p) = hertz(32);
    let cells = grid.cells()[0];
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    for (r, depth, [rr, tt, zz, rz], mises, tresca) in HERTZ {
        let fields = all(&mut stress, &p, depth);
        // The point (r, 0) is a corner of four cells: their mean, to second order.
        let i = (cells / 2) as f64 + r / grid.spacing()[0];
        let at = |field: &[f64]| {
            let (i, j) = (i.round() as usize, cells / 2);
            [(i - 1, j - 1), (i - 1, j), (i, j - 1), (i, j)]
                .iter()
                .map(|(i, j)| field[i * cells + j])
                .sum::<f64>()
                / 4.0
        };
        let found: [f64; 6] = std::array::from_fn(|k| at(&fields[k]));
        // 1e-3 of p0 at 32 cells per radius.
        for (found, expected) in [(found[0], rr), (found[1], tt), (found[2], zz), (found[4], rz)] {
            assert!((found - expected).abs() < 1e-3, "{r} {depth}: {found} {expected}");
        }
        let whole = invariants(found);
        assert!(
            (whole.mises - mises).abs() < 2e-3 && (whole.tresca - tresca).abs() < 1e-3,
            "{r} {depth}: {whole:?}"
        );
    }
}

#[test]
fn depths_apart_by_three_find_the_largest_stress_below_a_sphere() {
    let (grid, p) = hertz(8);
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    stress.set_pressure(&p).unwrap();
    // On the axis the radial stress is (1 + nu) (z atan(1/z) - 1) + 1/2 (1 + z^2)^-1, the normal stress -(1 + z^2)^-1
    // (Johnson 1985, eq. 3.45); a search over z finds the largest difference.
    let on_axis = |z: f64| 1.3 * (1.0 - z * (1.0 / z).atan()) - 1.5 / (1.0 + z * z);
    let exact = (1..400).map(|n| on_axis(0.005 * f64::from(n)).abs()).fold(0.0, f64::max);
    for first in [0.035, 0.045, 0.06, 0.075, 0.095] {
        let depths: Vec<f64> = (0..5).map(|n| first * 3f64.powi(n)).collect();
        let found = survey(&mut stress, &depths, &SurveyOptions::default()).unwrap();
        assert_eq!(found.unseen, None, "{first}");
        // 0.5 % from the depths, and 1 % from 8 cells to the radius (second order in the cell).
        assert!((found.mises.value / exact - 1.0).abs() < 0.015, "{first}: {} {exact}", found.mises.value);
    }
    // The surface and a depth of 4 radii tell nothing of what is between them.
    let found = survey(&mut stress, &[0.0, 4.0], &SurveyOptions::default()).unwrap();
    assert!(found.mises.value < 0.5 * exact && found.unseen == Some([0.0, 4.0]), "{found:?}");
}

#[test]
fn the_largest_shear_under_a_sphere_is_where_hertz_has_it() {
    // 0.3100205 p0 at 0.4808645 a for nu = 0.3 (Johnson 1985, eq. 4.24 and its extreme).
    let mut errors = vec![];
    for n in [8, 16] {
        let (grid, p) = hertz(n);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
        stress.set_pressure(&p).unwrap();
        let depths = automatic_depths(&grid, Boundary::Free, contact_box(&grid, &p));
        assert!(depths[0] == 0.0 && depths.len() == 25 && depths[24] > 2.0);
        let found =
            survey(&mut stress, &depths, &SurveyOptions { threshold: Some(0.5), rolling: None }).unwrap();
        errors.push((found.tresca.value - 0.310_020_5).abs());
        assert!((found.mises.value - 2.0 * found.tresca.value).abs() < 1e-3, "{found:?}");
        assert!((found.tresca.depth - 0.4808645).abs() < 0.03, "{found:?}");
        assert!(found.unseen.is_none() && !found.unresolved);
        let middle = [n * 2 - 1, n * 2];
        assert!(
            middle.contains(&(found.tresca.cell / (4 * n)))
                && middle.contains(&(found.tresca.cell % (4 * n)))
        );
        // On the axis mises > 0.5 from 0.2 to 0.95 a; the volume has about this width.
        let volume = found.stressed_volume.unwrap();
        assert!(volume > 0.2 && volume < 1.5, "{volume}");
    }
    // Second order.
    assert!(errors[1] < 4e-3 && errors[0] / errors[1] > 3.0, "{errors:?}");
}

#[test]
fn invariants_do_not_depend_on_the_axes() {
    // diag(3, 1, -2), turned about z by 30 degrees and as it is.
    let (c, s) = (0.75_f64.sqrt(), 0.5);
    let turned = [3.0 * c * c + s * s, 3.0 * s * s + c * c, -2.0, (3.0 - 1.0) * s * c, 0.0, 0.0];
    for tensor in [[3.0, 1.0, -2.0, 0.0, 0.0, 0.0], turned] {
        let found = invariants(tensor);
        assert!((found.tension - 3.0).abs() < 1e-14 && (found.tresca - 2.5).abs() < 1e-14, "{found:?}");
        assert!((found.mises - 19.0_f64.sqrt()).abs() < 1e-14 && (found.pressure + 2.0 / 3.0).abs() < 1e-15);
    }
    let even = invariants([-4.0, -4.0, -4.0, 0.0, 0.0, 0.0]);
    assert_eq!((even.mises, even.tresca, even.tension, even.pressure), (0.0, 0.0, -4.0, 4.0));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let grid = Grid::new([4, 4], [4.0, 4.0]).unwrap();
    assert!(SubsurfaceStress::new(grid, Boundary::Free, 0.6).is_err());
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    assert!(stress.set_pressure(&[0.0; 15]).is_err() && stress.set_pressure(&[f64::NAN; 16]).is_err());
    for depth in [-1.0, 0.1, 1e300, f64::INFINITY, f64::NAN] {
        assert!(stress.component_into(Component::Zz, depth, &mut [0.0; 16]).is_err(), "{depth}");
    }
    for depths in [&[1.0, 0.5][..], &[1.0, 1.0], &[], &[0.0, 0.1], &[f64::NAN]] {
        assert!(survey(&mut stress, depths, &SurveyOptions::default()).is_err(), "{depths:?}");
    }
}

#[test]
fn the_orthogonal_shear_of_a_rolling_ball_is_that_of_huber() {
    // M. T. Huber, Annalen der Physik 319 (1904): with m = r^2 + z^2 - 1, u = (m + sqrt(m^2 + 4 z^2))/2 the shear stress is
    // -r z^2 sqrt(u)/((u^2 + z^2)(1 + u)); twice its largest value is 0.4277818 p0 at a depth of 0.3508641 a.
    for n in [8, 16, 32] {
        let (grid, p) = hertz(n);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
        stress.set_pressure(&p).unwrap();
        let depths = spaced_depths([0.2, 0.8], 5, true, true);
        let along = |stress: &mut SubsurfaceStress, rolling| {
            let options = SurveyOptions { threshold: None, rolling: Some(rolling) };
            survey(stress, &depths, &options).unwrap().orthogonal_shear.unwrap()
        };
        let [x, y] = [Rolling::X, Rolling::Y].map(|rolling| along(&mut stress, rolling));
        assert!((x.largest.value - y.largest.value).abs() < 1e-12, "the contact is round");
        assert_eq!(x.by_depth.len(), depths.len());
        let middle = [2 * n - 1, 2 * n];
        assert!(middle.contains(&(x.largest.cell % (4 * n))) && middle.contains(&(y.largest.cell / (4 * n))));
        // Second order: cells lie up to half their side from the position of the maximum in each direction, and the stress falls
        // by about twice the square of the distance.
        let error = (x.largest.value - 0.427_781_8).abs();
        assert!(error < 1.0 / (n * n) as f64, "{n}: {error}");
        // If the stress is flat, the position is known to the square root of that.
        assert!((x.largest.depth - 0.350_864_1).abs() < 0.03, "{x:?}");
    }
}

#[test]
fn a_maximum_between_coarse_depths_is_found() {
    let (grid, p) = hertz(16);
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
    stress.set_pressure(&p).unwrap();
    let mut at = |depths: &[f64]| survey(&mut stress, depths, &SurveyOptions::default()).unwrap();
    let (coarse, fine) = (at(&[0.2, 0.4, 0.8, 1.6]), at(&spaced_depths([0.3, 0.7], 41, false, false)));
    assert!(fine.tresca.value > coarse.tresca_by_depth[1] * 1.005, "the depths alone miss it");
    // A change of a hundredth of the depth changes the maximum by a ten-thousandth.
    assert!((coarse.tresca.value / fine.tresca.value - 1.0).abs() < 1e-3, "{coarse:?} {fine:?}");
    assert_eq!(coarse.mises_by_depth.len(), 4);
}

#[test]
fn the_hertz_error_on_the_axis_is_of_second_order_in_every_component() {
    // Johnson 1985, eq. 3.45 with nu = 0.3: (r, z) = (0, 0.48 a).
    let z = 0.48_f64;
    let zz = -1.0 / (1.0 + z * z);
    let xx = -1.3 * (1.0 - z * (1.0 / z).atan()) + 0.5 / (1.0 + z * z);
    let mut errors = vec![];
    for n in [16, 32] {
        let (grid, p) = hertz(n);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
        let fields = all(&mut stress, &p, z);
        let cells = grid.cells()[0];
        let cell = (cells / 2) * cells + cells / 2;
        errors.push([
            (fields[0][cell] - xx).abs(),
            (fields[1][cell] - xx).abs(),
            (fields[2][cell] - zz).abs(),
        ]);
    }
    for (coarse, fine) in errors[0].iter().zip(errors[1]) {
        // 1e-3 of p0 at 32 cells per radius.
        assert!(fine < 1e-3 && coarse / fine > 3.0, "{errors:?}");
    }
}

#[test]
fn grids_of_one_cell_and_strips_are_grids() {
    for cells in [[1, 1], [1, 5], [6, 1], [2, 2]] {
        let grid = Grid::new(cells, [1.0, 3.0]).unwrap();
        let ([dx, dy], p) = (grid.spacing(), vec![2.0; grid.len()]);
        let mut stress = SubsurfaceStress::new(grid, Boundary::Periodic, 0.25).unwrap();
        let [xx, yy, zz, xy, xz, yz] = all(&mut stress, &p, 3.0);
        for n in 0..grid.len() {
            assert!(
                (zz[n] + 2.0).abs() < 1e-14
                    && (xx[n] + 2.0 / 3.0).abs() < 1e-14
                    && (yy[n] - xx[n]).abs() < 1e-14
            );
            assert!([xy[n], xz[n], yz[n]].iter().all(|s| s.abs() < 1e-14));
        }
        let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.25).unwrap();
        let fields = all(&mut stress, &p, 3.0);
        for (component, field) in Component::ALL.into_iter().zip(&fields) {
            // The whole loaded rectangle, seen from the first cell.
            let from = [0.5 * dx - 0.5, 0.5 * dy - 1.5];
            let whole = 2.0 * rectangle(component, from, 3.0, [0.5, 1.5], 0.25);
            assert!((field[0] - whole).abs() < 1e-13, "{cells:?} {component:?}: {} {whole}", field[0]);
        }
    }
}

#[test]
fn quantities_are_those_of_the_tensor() {
    let six: [Vec<f64>; 6] = std::array::from_fn(|k| vec![1.0 + k as f64, -0.5 * k as f64]);
    let mut out = [0.0; 2];
    for quantity in StressQuantity::ALL {
        quantity.field_into(&six, &mut out);
        let whole = invariants(std::array::from_fn(|k| six[k][1]));
        let expected = match quantity {
            StressQuantity::Mises => whole.mises,
            StressQuantity::Tresca => whole.tresca,
            StressQuantity::Tension => whole.tension,
            StressQuantity::Pressure => whole.pressure,
            component => six[StressQuantity::ALL.iter().position(|q| *q == component).unwrap() - 4][1],
        };
        assert_eq!(out[1], expected, "{quantity:?}");
        assert_eq!(StressQuantity::from_name(quantity.name()), Some(quantity));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let grid = Grid::new([130, 110], [1.0, 1.0]).unwrap();
    let p = pressure(&grid);
    let on = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut stress = SubsurfaceStress::new(grid, Boundary::Free, 0.3).unwrap();
            stress.set_pressure(&p).unwrap();
            let options = SurveyOptions { threshold: Some(0.2), rolling: Some(Rolling::X) };
            survey(&mut stress, &[0.0, 0.02, 0.05, 0.2], &options).unwrap()
        })
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn far_below_the_domain_a_cell_is_a_point_load() {
    // One loaded cell, seen from a depth of 1e7 domains. J. Boussinesq's point load (Johnson, Contact Mechanics, 3.19).
    let (grid, poisson, z) = (Grid::new([8, 8], [1.0, 1.0]).unwrap(), 0.3, 1e7);
    let mut p = vec![0.0; 64];
    p[2 * 8 + 3] = 1.0;
    let mut stress = SubsurfaceStress::new(grid, Boundary::Free, poisson).unwrap();
    stress.set_pressure(&p).unwrap();
    let found = all(&mut stress, &p, z);
    let (x, y, load) = (4.0 / 8.0, -2.0 / 8.0, grid.cell_area());
    let unit = load / (TAU * z * z);
    let expected = [-unit * (poisson - 0.5), -unit * (poisson - 0.5), -3.0 * unit];
    let at = 6 * 8 + 1;
    for (field, expected) in found.iter().zip(expected) {
        // The point's own terms of x/z are 1e-14; the rounding grows with the square of the cells along a side.
        assert!((field[at] - expected).abs() < 1e-11 * unit, "{} {expected}", field[at]);
    }
    for (field, across) in [(&found[4], x), (&found[5], y)] {
        let expected = -3.0 * unit * across / z;
        assert!((field[at] / expected - 1.0).abs() < 1e-9, "{} {expected}", field[at]);
    }
    // Of the order (x/z)^2.
    assert!(found[3][at].abs() < 1e-12 * unit, "{}", found[3][at]);
}
