//! Does the Hurst exponent lie within its stated error of the true one as often as a standard error promises?

use asperity::Grid;
use asperity::surface::statistics::{Extent, SpectralLay, Summary};
use asperity::surface::{HeightDistribution, Lay, Roughness, SelfAffine, Surface, Synthesis};

/// Random surfaces on a square of 1 m.
#[derive(Clone, Copy, Debug)]
struct Case {
    cells: usize,
    hurst: f64,
    roll_off: f64,
    longest: f64,
    /// In cells.
    shortest: f64,
    lay: f64,
    /// A part of a surface of twice the size, as a measurement is; else periodic.
    part: bool,
}

const ANGLE: f64 = 0.4;

fn surface(case: &Case, seed: u64) -> Surface {
    let scale = if case.part { 2 } else { 1 };
    let cells = scale * case.cells;
    let grid = Grid::new([cells, cells], [scale as f64, scale as f64]).unwrap();
    let spectrum = SelfAffine {
        hurst: case.hurst,
        roughness: Roughness::RmsGradient(0.1),
        longest: case.longest,
        shortest: case.shortest / case.cells as f64,
        roll_off: case.roll_off,
        seed,
    };
    let lay = (case.lay > 1.0).then_some(Lay { angle: ANGLE, ratio: case.lay });
    let heights =
        Synthesis { spectrum, lay, distribution: HeightDistribution::Gaussian }.heights(&grid).unwrap();
    let part = heights.slice(ndarray::s![..case.cells, ..case.cells]).to_owned();
    Surface::new(Grid::new([case.cells, case.cells], [1.0, 1.0]).unwrap(), part).unwrap()
}

/// Shares of surfaces whose H is within one and two errors of the true one, the mean of H less the true one, and the lays.
fn study(case: &Case, seeds: u64) -> ([f64; 2], f64, Vec<SpectralLay>) {
    let extent = if case.part { Extent::Finite } else { Extent::Periodic };
    let (mut within, mut bias, mut lays) = ([0.0; 2], 0.0, vec![]);
    for seed in 0..seeds {
        let waves = Summary::of(&surface(case, seed), extent).unwrap().waves.unwrap();
        let fit = waves.fit.unwrap();
        for (k, share) in within.iter_mut().enumerate() {
            let limit = (k + 1) as f64 * fit.error;
            *share += f64::from(u8::from((fit.hurst - case.hurst).abs() <= limit)) / seeds as f64;
        }
        bias += (fit.hurst - case.hurst) / seeds as f64;
        lays.push(waves.lay);
    }
    (within, bias, lays)
}

const MEASURED: Case =
    Case { cells: 128, hurst: 0.8, roll_off: 0.25, longest: 1.0, shortest: 2.0, lay: 1.0, part: true };
const GROUND: Case = Case { roll_off: 0.1, longest: 0.5, lay: 4.0, ..MEASURED };

#[test]
fn the_error_of_the_hurst_exponent_is_a_standard_error() {
    for case in [MEASURED, GROUND] {
        let ([one, two], bias, lays) = study(&case, 40);
        // 68 and 95 % of 40 lie within one and two standard errors if these are right: 27 +- 3 and 38 +- 1.4. With
        // errors 1.5 times too small it would be 20 and 33, with errors twice as large 38 and 40.
        assert!((0.525..=0.9).contains(&one) && two >= 0.875, "{case:?}: {one} {two}");
        assert!(bias.abs() < 0.05, "{case:?}: {bias}");
        for lay in lays {
            // The slope tensor of the isotropic surfaces scatters by a tenth; a lay of 4 is found to a third in lengths that
            // fit 5 times into the surface, and its angle to 0.1.
            assert_eq!(lay.is_clear(), case.lay > 1.0, "{case:?} {lay:?}");
            if case.lay > 1.0 {
                assert!((lay.ratio / 4.0).ln().abs() < 0.4 && (lay.angle - ANGLE).abs() < 0.1, "{lay:?}");
            }
        }
    }
}

#[test]
#[ignore = "a minute: 1100 surfaces"]
fn the_error_of_the_hurst_exponent_is_right_for_all_kinds_of_surfaces() {
    let cases = [
        MEASURED,
        Case { roll_off: 1.0, ..MEASURED },
        Case { roll_off: 2.0, longest: 2.0, ..MEASURED },
        Case { hurst: 0.3, ..MEASURED },
        // Two octaves between roll-off and cut-off only.
        Case { shortest: 8.0, ..MEASURED },
        Case { cells: 256, roll_off: 0.1, ..MEASURED },
        Case { cells: 256, roll_off: 0.5, shortest: 8.0, ..MEASURED },
        GROUND,
        Case { cells: 256, shortest: 4.0, ..GROUND },
        Case { part: false, ..MEASURED },
        Case { part: false, ..GROUND },
    ];
    for case in cases {
        let ([one, two], bias, _) = study(&case, 100);
        println!("{case:?}: within one error {one:.2}, within two {two:.2}, bias {bias:.3}");
        // 68 +- 5 and 95 +- 2 of 100; periodic surfaces, without a window, have errors that are up to 1.4 times too large.
        assert!((0.55..=0.9).contains(&one) && two >= 0.88, "{case:?}: {one} {two}");
    }
}
