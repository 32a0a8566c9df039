//! Exact channels, duality, monotonicity, unusual maps.

use ndarray::Array2;

use super::network::Network;
use super::tensor::network_conductance;
use super::*;
use crate::Grid;

const CELL: f64 = 1.0;

/// Pseudo-random numbers between 0 and 1, the same on every machine.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn opening(gap: &Array2<f64>, spacing: [f64; 2], direction: Direction, sides: Sides) -> Opening {
    let (nx, ny) = gap.dim();
    let grid = Grid::new([nx, ny], [nx as f64 * spacing[0], ny as f64 * spacing[1]]).unwrap();
    Opening::new(&grid, gap.view(), None, direction, sides, 0.0).unwrap()
}

fn transmissivity_with(gap: &Array2<f64>, direction: Direction, sides: Sides, options: &FlowOptions) -> f64 {
    let opening = opening(gap, [CELL; 2], direction, sides);
    liquid(&opening, &Passages::of(&opening), options).unwrap().transmissivity
}

fn transmissivity(gap: &Array2<f64>, sides: Sides) -> f64 {
    transmissivity_with(gap, Direction::X, sides, &FlowOptions::default())
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64) {
    assert!(
        (found / exact - 1.0).abs() <= tolerance,
        "{found:e} is not {exact:e}: off by {:e}",
        found / exact - 1.0
    );
}

#[test]
fn channels_in_series_and_in_parallel() {
    // The sum over cells is the midpoint rule over whole periods, which is exact to rounding for 1/h^3 at this number of cells.
    let wave = |i: usize| 1.0 + 0.5 * (std::f64::consts::TAU * (i as f64 + 0.5) / 128.0).cos();
    let series = Array2::from_shape_fn((128, 3), |(i, _)| wave(i));
    near(transmissivity(&series, Sides::Periodic), 0.433_012_701_892_219_3, 1e-12);
    let parallel = Array2::from_shape_fn((2, 128), |(_, j)| wave(j));
    near(transmissivity(&parallel, Sides::Periodic), 1.375, 1e-12);
    near(transmissivity(&parallel, Sides::Closed), 1.375, 1e-12);
}

#[test]
fn a_plate_is_exact_whatever_the_cells() {
    for (shape, spacing) in
        [((1, 1), [1.0, 1.0]), ((1, 7), [2.0, 0.1]), ((9, 1), [0.3, 20.0]), ((2, 2), [1.0, 3.0])]
    {
        let gap = Array2::from_elem(shape, 0.7);
        for direction in [Direction::X, Direction::Y] {
            for sides in [Sides::Periodic, Sides::Closed] {
                let opening = opening(&gap, spacing, direction, sides);
                let flow = liquid(&opening, &Passages::of(&opening), &FlowOptions::default()).unwrap();
                near(flow.transmissivity, 0.343, 1e-13);
                near(flow.hydraulic_gap(), 0.7, 1e-13);
            }
        }
        let k = conductance(&opening(&gap, spacing, Direction::Y, Sides::Periodic), &FlowOptions::default())
            .unwrap();
        near(k[0][0], 0.343, 1e-13);
        near(k[1][1], 0.343, 1e-13);
        assert!(k[0][1].abs() < 1e-15 && k[1][0].abs() < 1e-15);
    }
}

/// Every face t of a torus is crossed by a face 1/t of the dual torus; then K* = R^T K^-1 R, R the rotation by 90 degrees.
#[test]
fn the_conductance_of_the_dual_network_is_the_inverse() {
    let mut random = noise(7);
    for cells in [[12, 12], [5, 8], [3, 2], [2, 2]] {
        let [n, m] = cells;
        let mut face = || 10f64.powf(4.0 * random() - 2.0);
        let along: Vec<f64> = (0..n * m).map(|_| face()).collect();
        let across: Vec<f64> = (0..n * m).map(|_| face()).collect();
        let primal = Network { cells, along, across, ground: vec![0.0; n * m] };
        // Dual cell (i, j) lies at the corner between cells (i, j) and (i + 1, j + 1). Its face to (i + 1, j) crosses the face
        // between (i + 1, j) and (i + 1, j + 1); its face to (i, j + 1) that between (i, j + 1) and (i + 1, j + 1).
        let at = |i: usize, j: usize| (i % n) * m + j % m;
        let mut dual = Network { along: vec![0.0; n * m], across: vec![0.0; n * m], ..primal.clone() };
        for i in 0..n {
            for j in 0..m {
                dual.along[at(i, j)] = primal.across[at(i + 1, j)].recip();
                dual.across[at(i, j)] = primal.along[at(i, j + 1)].recip();
            }
        }
        let options = FlowOptions::default();
        let k = network_conductance(primal, &options).unwrap();
        let [[a, b], [c, d]] = network_conductance(dual, &options).unwrap();
        let determinant = k[0][0] * k[1][1] - k[0][1] * k[1][0];
        // R^T K^-1 R = K/det K for a symmetric K. Rounding of conductances that span four decades.
        let expected = [[k[0][0], k[0][1]], [k[1][0], k[1][1]]].map(|row| row.map(|k| k / determinant));
        let size = expected[0][0].max(expected[1][1]);
        for (found, exact) in [a, b, c, d].into_iter().zip(expected.concat()) {
            assert!((found - exact).abs() < 1e-11 * size, "{cells:?}: {found:e} is not {exact:e}");
        }
    }
}

#[test]
fn connected_exactly_where_fluid_flows() {
    let mut random = noise(3);
    let (mut tight, mut open) = (0, 0);
    for trial in 0..200 {
        let share = 0.5 + 0.2 * (trial as f64 / 200.0);
        let shape = (4 + trial % 9, 3 + trial % 7);
        let gap = Array2::from_shape_fn(shape, |_| if random() < share { 0.2 + random() } else { 0.0 });
        for sides in [Sides::Periodic, Sides::Closed] {
            let opening = opening(&gap, [CELL; 2], Direction::X, sides);
            let passages = Passages::of(&opening);
            let flow = liquid(&opening, &passages, &FlowOptions::default()).unwrap();
            assert_eq!(passages.percolates(), flow.transmissivity > 0.0);
            if !passages.percolates() {
                tight += 1;
                assert_eq!(flow.transmissivity, 0.0);
                continue;
            }
            open += 1;
            // The flow does not depend on the orientation, and closing a cell reduces it.
            let turned = gap.t().to_owned();
            near(
                transmissivity_with(&turned, Direction::Y, sides, &FlowOptions::default()),
                flow.transmissivity,
                1e-12,
            );
            let mut less = gap.clone();
            less[passages.constriction.unwrap().cell] = 0.0;
            assert!(transmissivity(&less, sides) <= flow.transmissivity * (1.0 + 1e-12));
            // Rayleigh, Wiener: no more than all cells side by side.
            assert!(flow.transmissivity <= gap.mapv(|h| h.powi(3)).mean().unwrap());
            // Closing every cell below the critical gap leaves a path, closing that gap too does not.
            let critical = passages.constriction.unwrap().gap;
            let above = |least: f64| gap.mapv(|h| if h >= least { h } else { 0.0 });
            assert!(transmissivity(&above(critical), sides) > 0.0);
            assert_eq!(transmissivity(&above(critical * (1.0 + 1e-12)), sides), 0.0);
        }
    }
    assert!(tight > 50 && open > 50);
}

#[test]
fn corners_do_not_connect_and_pockets_are_told() {
    let gap = ndarray::array![
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 2.0, 2.0, 0.0],
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ];
    let opening = opening(&gap, [2.0, 3.0], Direction::X, Sides::Closed);
    let passages = Passages::of(&opening);
    assert!(!passages.percolates());
    assert_eq!((passages.trapped_area, passages.trapped_volume), (12.0, 24.0));
    let kinds = passages.map(&opening);
    assert_eq!(kinds[(0, 1)], CellKind::AtInlet);
    assert_eq!(kinds[(1, 0)], CellKind::AtOutlet);
    assert_eq!(kinds[(1, 4)], CellKind::Pocket);
    let flow = liquid(&opening, &passages, &FlowOptions::default()).unwrap();
    assert_eq!((flow.transmissivity, flow.pressure[(0, 1)], flow.pressure[(2, 0)]), (0.0, 1.0, 0.0));
    assert!(flow.pressure[(1, 3)].is_nan() && flow.pressure[(0, 0)].is_nan());
}

#[test]
fn lakes_behind_narrow_necks_do_not_hide_the_leak() {
    // Inlet, neck, lake, neck, outlet in series: each neck is a cell of resistance 1/h^3, the lakes have none. Besides, a lake
    // that is a dead end. The gaps span twelve decades, their cubes 36.
    for neck in [1e-3, 1e-6, 1e-12] {
        let mut gap = Array2::zeros((40, 20));
        for (i, j, h) in (0..40).flat_map(|i| (0..20).map(move |j| (i, j, 1.0))) {
            gap[(i, j)] = if j < 12 { h } else { 0.0 };
        }
        for j in 0..20 {
            gap[(10, j)] = 0.0;
            gap[(30, j)] = 0.0;
        }
        (gap[(10, 5)], gap[(30, 5)]) = (neck, neck);
        gap.slice_mut(ndarray::s![14..18, 14..18]).fill(1.0);
        (gap[(15, 12)], gap[(15, 13)]) = (neck, neck);
        let found = transmissivity(&gap, Sides::Closed);
        // Two necks of two half cells each; the flow spreads in the lakes, where the drop is below (neck)^3.
        let exact = neck.powi(3) / 2.0 * 40.0 / 20.0;
        near(found, exact, 1e-8_f64.max(10.0 * neck.powi(3)));
    }
}

#[test]
fn multigrid_agrees_with_the_factorisation() {
    // Rough gap with contact: the lowest waves of a random sum, cut at 20 % of its cells.
    let mut random = noise(11);
    let waves: Vec<[f64; 4]> = (0..40)
        .map(|_| [(random() * 9.0).floor(), (random() * 17.0).floor() - 8.0, random(), random()])
        .collect();
    for (n, m) in [(96, 96), (63, 50)] {
        let height = |i: usize, j: usize| -> f64 {
            let wave = |[kx, ky, a, phase]: &[f64; 4]| {
                let angle = kx * i as f64 / n as f64 + ky * j as f64 / m as f64 + phase;
                a / (1.0 + kx.hypot(*ky)) * (std::f64::consts::TAU * angle).cos()
            };
            waves.iter().map(wave).sum()
        };
        let heights = Array2::from_shape_fn((n, m), |(i, j)| height(i, j));
        let mut sorted: Vec<f64> = heights.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let level = sorted[sorted.len() / 5];
        let gap = heights.mapv(|h| (h - level).max(0.0));
        for direction in [Direction::X, Direction::Y] {
            let exact = transmissivity_with(&gap, direction, Sides::Periodic, &FlowOptions::default());
            let iterative = FlowOptions { memory: 0.0, ..FlowOptions::default() };
            let found = transmissivity_with(&gap, direction, Sides::Periodic, &iterative);
            assert!(exact > 0.0);
            // The power settles to 1e-8 over ten iterations.
            near(found, exact, 1e-6);
        }
    }
}

#[test]
fn the_noise_of_a_contact_is_closed_where_the_contact_is_not_given() {
    // Nine tenths of the cells touch, with gaps that are off by up to 1e-12 to both sides, around channels that end.
    let (n, mut next) = (40, noise(7));
    let errors = Array2::from_shape_fn((n, n), |_| 1e-12 * (2.0 * next() - 1.0));
    let is_channel = |i: usize, j: usize| i < n - 4 && j % 10 == 3;
    let gap = Array2::from_shape_fn((n, n), |(i, j)| if is_channel(i, j) { 1e-6 } else { errors[(i, j)] });
    let map = opening(&gap, [CELL; 2], Direction::X, Sides::Periodic);
    let passages = Passages::of(&map);
    let (error, closed) = map.closed();
    assert!(!passages.percolates() && passages.open_fraction() < 0.1, "{}", passages.open_fraction());
    assert!(error <= 1e-12 && error > 0.99e-12 && closed > n * n / 3, "{error} {closed}");
    // Deep negative gaps are surfaces that overlap: they say nothing of the others.
    let mut overlap = gap.clone();
    overlap[(0, 0)] = -1e-7;
    assert_eq!(opening(&overlap, [CELL; 2], Direction::X, Sides::Periodic).closed().1, 0);
}

#[test]
fn what_lies_behind_a_vanishing_throat_is_a_pocket() {
    // A wide channel along x, and beside it a chamber that only a throat joins.
    let gap = |throat: f64| {
        let mut gap = Array2::zeros((8, 8));
        gap.slice_mut(ndarray::s![.., 0..3]).fill(1e-4);
        gap.slice_mut(ndarray::s![3..6, 4..7]).fill(1e-5);
        gap[(4, 3)] = throat;
        gap
    };
    for (throat, kind) in [(7e-11, CellKind::Pocket), (7e-10, CellKind::Through)] {
        let map = opening(&gap(throat), [CELL; 2], Direction::X, Sides::Closed);
        let passages = Passages::of(&map);
        let flow = liquid(&map, &passages, &FlowOptions::default()).unwrap();
        assert_eq!(passages.map(&map)[(4, 5)], kind);
        // Every cell through which fluid flows has a pressure, and no other one.
        let has = flow.pressure.map(|p| p.is_finite());
        assert_eq!(has, passages.map(&map).map(|kind| *kind == CellKind::Through));
    }
}

#[test]
fn bad_maps_are_refused_and_thin_ones_solved() {
    let grid = Grid::new([2, 3], [1.0, 1.0]).unwrap();
    let mut gap = Array2::from_elem((2, 3), 1.0);
    let said = |gap: &Array2<f64>, smallest: f64| {
        Opening::new(&grid, gap.view(), None, Direction::X, Sides::Closed, smallest).unwrap_err().to_string()
    };
    gap[(1, 2)] = f64::NAN;
    assert!(said(&gap, 0.0).contains("gap of cell (1, 2)"));
    gap[(1, 2)] = f64::INFINITY;
    assert!(said(&gap, 0.0).contains("without end"));
    gap[(1, 2)] = -1.0;
    assert!(said(&gap, -1.0).contains("smallest gap"));
    assert!(said(&Array2::zeros((3, 2)), 0.0).contains("3 x 2"));
    // A negative gap is closed, and so is one below the smallest gap.
    let opening = Opening::new(&grid, gap.view(), None, Direction::X, Sides::Closed, 1.0).unwrap();
    assert_eq!(opening.open_fraction(), 0.0);
    assert!(!Passages::of(&opening).percolates());
    assert_eq!(effective_medium(&opening), 0.0);
    assert_eq!(conductance(&opening, &FlowOptions::default()).unwrap(), [[0.0; 2]; 2]);
    let drop = Flow { transmissivity: 1.0, pressure: gap, iterations: 0 };
    assert!(drop.leak_rate(&opening, 0.0, 1.0).is_err() && drop.leak_rate(&opening, 1.0, 0.0).is_err());
}

#[test]
fn only_what_winds_around_the_torus_conducts() {
    // A diagonal channel winds once in each direction: K is of rank one.
    let gap = Array2::from_shape_fn((12, 12), |(i, j)| if (i + 12 - j) % 12 < 2 { 1.0 } else { 0.0 });
    let k = conductance(&opening(&gap, [CELL; 2], Direction::X, Sides::Periodic), &FlowOptions::default())
        .unwrap();
    near(k[0][0], k[1][1], 1e-12);
    near(k[0][1], k[0][0], 1e-12);
    assert!(k[0][0] > 0.01);
    // The same cut open at one place percolates from border to border, but does not wind.
    let mut cut = gap.clone();
    (cut[(0, 0)], cut[(0, 11)], cut[(1, 0)]) = (0.0, 0.0, 0.0);
    let k = conductance(&opening(&cut, [CELL; 2], Direction::X, Sides::Periodic), &FlowOptions::default())
        .unwrap();
    assert_eq!(k, [[0.0; 2]; 2]);
}

#[test]
fn the_effective_medium_of_two_phases_is_known() {
    // Half of the cells h1, half h2: T = (h1 h2)^1.5, by Dykhne's theorem and by Bruggeman.
    let gap = Array2::from_shape_fn((4, 5), |(i, _)| if i % 2 == 0 { 2.0 } else { 0.01 });
    near(effective_medium(&opening(&gap, [CELL; 2], Direction::X, Sides::Closed)), 0.02_f64.powf(1.5), 1e-10);
    // Open share f of one gap: T = (2 f - 1) h^3.
    let gap = Array2::from_shape_fn((4, 5), |(i, j)| if 5 * i + j < 13 { 3.0 } else { 0.0 });
    near(effective_medium(&opening(&gap, [CELL; 2], Direction::X, Sides::Closed)), 0.3 * 27.0, 1e-10);
    let closed = gap.mapv(|h| if h > 0.0 { 0.0 } else { 1.0 });
    assert_eq!(effective_medium(&opening(&closed, [CELL; 2], Direction::X, Sides::Closed)), 0.0);
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let mut random = noise(5);
    let gap = Array2::from_shape_fn((150, 170), |_| if random() < 0.8 { random() } else { 0.0 });
    for memory in [4e9, 0.0] {
        let options = FlowOptions { memory, ..FlowOptions::default() };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| transmissivity_with(&gap, Direction::X, Sides::Periodic, &options))
        };
        assert_eq!(on(1).to_bits(), on(2).to_bits());
        assert_eq!(on(1).to_bits(), on(5).to_bits());
    }
}

/// Two basins that meet in one cell between closed ones at two of its corners: its rows along the axes are long, its neck is one
/// cell wide.
#[test]
fn a_neck_across_a_diagonal_is_as_narrow_as_it_is() {
    let n = 16;
    let gap = Array2::from_shape_fn((n, n), |(i, j)| match (i + j == n - 1, (i, j)) {
        (true, (7, 8)) => 0.5e-6,
        (true, _) => 0.0,
        _ => 1e-6,
    });
    let constriction =
        Passages::of(&opening(&gap, [1e-6; 2], Direction::X, Sides::Closed)).constriction.unwrap();
    assert_eq!((constriction.cell, constriction.width), ([7, 8], Some(1)));
}
