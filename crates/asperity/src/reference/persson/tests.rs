use std::f64::consts::{PI, TAU};

use ndarray::Array2;

use super::*;
use crate::Grid;
use crate::material::CreepTerm;
use crate::reference::full_contact_friction;
use crate::surface::statistics::{RadialSpectrum, Rings};
use crate::surface::{Roughness, SelfAffine};

fn solid(instantaneous: f64, terms: &[(f64, f64)]) -> Creep {
    let term = |&(compliance, retardation_time)| CreepTerm { compliance, retardation_time };
    Creep { instantaneous, terms: terms.iter().map(term).collect(), fluidity: 0.0 }
}

/// A rubber of 13 terms over 13 decades, compliance 1 at short times and 1000 at long ones.
fn rubber() -> Creep {
    let terms: Vec<_> = (0..13).map(|n| (1.78f64.powi(n) * 0.44, 10f64.powi(n - 8))).collect();
    solid(1.0, &terms)
}

fn rough(cells: [usize; 2], seed: u64) -> Surface {
    let grid = Grid::new(cells, [1.0, cells[1] as f64 / cells[0] as f64]).unwrap();
    let (roughness, longest) = (Roughness::RmsGradient(0.2), 0.5);
    let made = SelfAffine { hurst: 0.8, roughness, longest, roll_off: longest, shortest: 0.06, seed };
    Surface::new(grid, made.heights(&grid).unwrap()).unwrap()
}

fn theory(surface: &Surface, creep: &Creep, pressure: f64) -> Persson {
    Persson::of_surface(surface, Direction::X, creep, pressure, Correction::YangPersson).unwrap()
}

#[test]
fn in_full_contact_it_is_the_exact_sum_over_the_waves() {
    // Waves of all directions and phases, without any isotropy.
    let height = |(i, j): (usize, usize)| ((i * i + 3 * i * j + 7 * j) % 23) as f64 * 1e-3;
    for cells in [[24, 30], [15, 8]] {
        let grid = Grid::new(cells, [1.0, 1.3]).unwrap();
        let surface = Surface::new(grid, Array2::from_shape_fn(grid.shape(), height)).unwrap();
        for direction in [Direction::X, Direction::Y, Direction::Angle(0.3), Direction::Angle(2.0)] {
            for v in [1e-3, 1.0, 50.0] {
                // So high a pressure that erf is 1 to the last bit.
                let (creep, pressure) = (rubber(), 1e3);
                let full = full_contact_friction(&surface, &creep, v, direction).unwrap();
                for correction in [Correction::None, Correction::YangPersson] {
                    let theory =
                        Persson::of_surface(&surface, direction, &creep, pressure, correction).unwrap();
                    let found = theory.at(v).unwrap();
                    assert_eq!(found.contact_fraction, 1.0);
                    // Another order of the same sum.
                    assert!(
                        (found.friction_coefficient * pressure / full - 1.0).abs() < 1e-12,
                        "{cells:?} {direction:?} {v}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_friction_of_an_isotropic_spectrum_is_its_closed_form_in_full_contact() {
    // C = c q^-4 from 1 to 10; E'' = dE x/(1 + x^2), x = w tau. Around the circle
    // int cos f E''(q v cos f) df = (2 pi dE / a) (1 - 1/sqrt(1 + a^2)), a = q v tau.
    let (glassy, rubbery, tau, c) = (4.0, 1.0, 0.7, 1e-4);
    // C0 = 1/E0, C1 = 1/E_inf - 1/E0, lambda = tau E0/E_inf.
    let creep = solid(1.0 / glassy, &[(1.0 / rubbery - 1.0 / glassy, tau * glassy / rubbery)]);
    let (q, power) = ([1.0, 3.0, 10.0], [c, c / 81.0, c / 1e4]);
    for v in [0.01, 0.5, 40.0] {
        let b = v * tau;
        let integral = |q: f64| ((1.0 + b * b * q * q).sqrt() - 1.0) / q;
        let stress = 0.5 * c / TAU.powi(2) * TAU * (glassy - rubbery) / b * (integral(10.0) - integral(1.0));
        let theory = Persson::of_spectrum(&q, &power, &creep, 1e3, Correction::YangPersson).unwrap();
        let got = theory.at(v).unwrap().friction_coefficient * 1e3;
        // Two points per shell of 0.005 in ln q, and a step of 0.4 around the circle: about 1e-8.
        assert!((got / stress - 1.0).abs() < 1e-7, "{v}: {got} {stress}");
    }
}

#[test]
fn finer_shells_and_circles_change_nothing() {
    // Flat, then falling as q^-3.6; also a spectrum that starts and ends at 0.
    let q: Vec<f64> = (0..=30).map(|n| 10f64.powf(f64::from(n) / 10.0)).collect();
    let falling: Vec<f64> = q.iter().map(|q| 1e-4 * q.max(5.0).powf(-3.6)).collect();
    let mut ending = falling.clone();
    (ending[0], ending[30]) = (0.0, 0.0);
    for power in [falling, ending] {
        for pressure in [1e-4, 1e-3, 1e-2] {
            let with = |shell: f64, circle: f64| {
                let spectrum = Isotropic::new(&q, &power, Fineness { shell, circle }).unwrap();
                Persson::new(Arc::new(spectrum), &rubber(), pressure, Correction::YangPersson).unwrap()
            };
            let Fineness { shell, circle } = Fineness::default();
            let (usual, fine) = (with(shell, circle), with(0.5 * shell, 0.5 * circle));
            for v in [1e-6, 1e-2, 1e2] {
                let (usual, fine) = (usual.at(v).unwrap(), fine.at(v).unwrap());
                let change = |of: fn(&PerssonFriction) -> f64| (of(&usual) / of(&fine) - 1.0).abs();
                assert!(change(|f| f.contact_fraction) < 1e-6, "{pressure} {v}: {usual:?} {fine:?}");
                assert!(change(|f| f.friction_coefficient) < 1e-6, "{pressure} {v}: {usual:?} {fine:?}");
            }
        }
    }
}

#[test]
fn the_waves_of_a_grid_and_their_averaged_spectrum_agree() {
    let surface = rough([128, 128], 3);
    let spectrum = RadialSpectrum::of(&surface, Rings::Linear).unwrap();
    let within: Vec<usize> =
        (0..spectrum.power.len()).filter(|n| spectrum.power[*n] > 1e-12 * spectrum.power[1]).collect();
    let pick = |values: &[f64]| within.iter().map(|n| values[*n]).collect::<Vec<f64>>();
    let (q, power) = (pick(&spectrum.wave_number), pick(&spectrum.power));
    for pressure in [1e-4, 1e-3] {
        let of_rings =
            Persson::of_spectrum(&q, &power, &rubber(), pressure, Correction::YangPersson).unwrap();
        for v in [1e-4, 1.0] {
            let (grid, rings) =
                (theory(&surface, &rubber(), pressure).at(v).unwrap(), of_rings.at(v).unwrap());
            // The first and the last ring count only half as intervals between points: 3 and 17 of the latter.
            assert!((grid.contact_fraction / rings.contact_fraction - 1.0).abs() < 0.1, "{grid:?} {rings:?}");
            assert!(
                (grid.friction_coefficient / rings.friction_coefficient - 1.0).abs() < 0.15,
                "{grid:?} {rings:?}"
            );
        }
    }
}

#[test]
fn the_mean_over_a_shell_is_the_integral_over_g() {
    // int_0^G P dG = G P + sqrt(G/pi) e^(-1/(4G)) - erfc(1/(2 sqrt G))/2.
    let surface = rough([40, 40], 1);
    let plain = Persson::of_surface(&surface, Direction::X, &rubber(), 1.0, Correction::None).unwrap();
    let integral = |r: f64| {
        let g = r * r;
        g * libm::erf(0.5 / r) + r / PI.sqrt() * (-0.25 / g).exp() - 0.5 * libm::erfc(0.5 / r)
    };
    for (from, to) in [(1e-3, 0.2), (0.2, 0.7), (1e-9, 3.0), (1.0, 1e4), (0.4, 0.4009)] {
        let exact = (integral(to) - integral(from)) / (to * to - from * from);
        // 16 points on pieces of half a unit or an octave, and cancellation in the difference; the error of the middle of a
        // narrow shell is width^2/24 of the curvature, which is below ten times the value.
        let room = if to - from < 1e-3 { 4e-7 } else { 1e-9 };
        assert!(
            (plain.mean_share(from, to) / exact - 1.0).abs() < room,
            "{from} {to}: {}",
            plain.mean_share(from, to) / exact - 1.0
        );
    }
    assert_eq!((plain.mean_share(0.0, 0.0), plain.mean_share(0.0, 1e-4)), (1.0, 1.0));
}

#[test]
fn an_elastic_body_has_no_friction_and_the_contact_of_its_modulus() {
    let surface = rough([48, 36], 2);
    let found = theory(&surface, &Creep::elastic(0.5), 0.01).at(3.0).unwrap();
    assert_eq!(found.friction_coefficient, 0.0);
    let gradient = crate::surface::statistics::rms_gradient(surface.grid(), surface.heights()).unwrap();
    let g = (2.0 * gradient / 0.01).powi(2) / 8.0;
    assert!((found.contact_fraction / libm::erf(0.5 / g.sqrt()) - 1.0).abs() < 1e-12); // rounding
}

#[test]
fn friction_depends_on_the_amount_of_speed_times_time() {
    let surface = rough([40, 40], 5);
    let (usual, slower) =
        (theory(&surface, &rubber(), 1e-3), theory(&surface, &rubber().stretched(10.0), 1e-3));
    for v in [1e-5, 0.02, 7.0] {
        let found = usual.at(v).unwrap();
        let mirrored = usual.at(-v).unwrap();
        assert_eq!((mirrored.friction_coefficient, mirrored.velocity), (found.friction_coefficient, -v));
        let shifted = slower.at(0.1 * v).unwrap();
        assert!((shifted.friction_coefficient / found.friction_coefficient - 1.0).abs() < 1e-12); // rounding
        assert!((shifted.contact_fraction / found.contact_fraction - 1.0).abs() < 1e-12);
    }
    assert_eq!(usual.at(0.0).unwrap().friction_coefficient, 0.0);
    let velocities = [1e-5, 0.02, -7.0];
    let each: Vec<_> = velocities.iter().map(|v| usual.at(*v).unwrap()).collect();
    assert_eq!(usual.sweep(&velocities).unwrap(), each);
}

#[test]
fn the_contact_shrinks_from_the_relaxed_to_the_glassy_one() {
    let (q, power) = ([10.0, 100.0], [1e-6, 1e-10]);
    let isotropic =
        |creep: &Creep| Persson::of_spectrum(&q, &power, creep, 1e-3, Correction::YangPersson).unwrap();
    let surface = rough([40, 40], 7);
    // Oblique, so that all waves have slopes along the motion.
    let of_waves = |creep: &Creep| {
        Persson::of_surface(&surface, Direction::Angle(0.3), creep, 1e-3, Correction::YangPersson).unwrap()
    };
    let of: [&dyn Fn(&Creep) -> Persson; 2] = [&isotropic, &of_waves];
    for theory in of {
        let moving = theory(&rubber());
        let at_rest = |compliance: f64| theory(&Creep::elastic(compliance)).at(0.0).unwrap().contact_fraction;
        let (relaxed, glassy) = (at_rest(rubber().long_time()), at_rest(1.0));
        let contact: Vec<f64> =
            (-14..=14).map(|n| moving.at(10f64.powi(n)).unwrap().contact_fraction).collect();
        assert!(contact.windows(2).all(|w| w[1] <= w[0]), "{contact:?}");
        // Six decades beyond the slowest and the fastest frequency.
        assert!((contact[0] / relaxed - 1.0).abs() < 1e-6, "{contact:?} {relaxed}");
        assert!((contact[28] / glassy - 1.0).abs() < 1e-4, "{contact:?} {glassy}");
        assert!((moving.at(0.0).unwrap().contact_fraction / relaxed - 1.0).abs() < 1e-12); // rounding
    }
}

#[test]
fn the_correction_lowers_the_friction_and_the_magnification_ends_at_it() {
    let surface = rough([40, 40], 9);
    let with = |correction| Persson::of_surface(&surface, Direction::X, &rubber(), 1e-3, correction).unwrap();
    let (none, half) = (with(Correction::None), with(Correction::YangPersson));
    for v in [1e-4, 1.0] {
        let (all, found) = (none.at(v).unwrap(), half.at(v).unwrap());
        // S is between 1/2 and 1.
        let ratio = found.friction_coefficient / all.friction_coefficient;
        assert!(ratio > 0.5 && ratio < 1.0 && found.contact_fraction == all.contact_fraction, "{ratio}");
        let curve = half.magnification(v).unwrap();
        assert_eq!(curve.friction_coefficient.last(), Some(&found.friction_coefficient));
        assert_eq!(curve.contact_fraction.last(), Some(&found.contact_fraction));
        assert!(curve.wave_number.windows(2).all(|w| w[0] < w[1]));
        assert!(curve.contact_fraction.windows(2).all(|w| w[1] <= w[0]));
        assert!(curve.friction_coefficient.windows(2).all(|w| w[1] >= w[0]));
    }
}

#[test]
fn absurd_numbers_are_named() {
    let surface = rough([40, 40], 1);
    let flat = Surface::new(*surface.grid(), Array2::from_elem((40, 40), 3.0)).unwrap();
    let made = |surface: &Surface, direction: Direction, creep: &Creep, pressure: f64| {
        Persson::of_surface(surface, direction, creep, pressure, Correction::None).map(drop)
    };
    let spectrum =
        |q: &[f64], c: &[f64]| Persson::of_spectrum(q, c, &rubber(), 1.0, Correction::None).map(drop);
    let fluid = Creep { fluidity: 1.0, ..rubber() };
    let tiny = theory(&surface, &solid(1e-200, &[(1e-200, 1.0)]), 1e-300);
    for (result, word) in [
        (made(&flat, Direction::X, &rubber(), 1.0), "rms roughness of the surface is 0"),
        (made(&surface, Direction::Angle(f64::NAN), &rubber(), 1.0), "direction"),
        (made(&surface, Direction::X, &fluid, 1.0), "a fluid has no steady state"),
        (made(&surface, Direction::X, &Creep::elastic(0.0), 1.0), "compliance at long times"),
        (made(&surface, Direction::X, &rubber(), 0.0), "nominal pressure"),
        (made(&surface, Direction::X, &rubber(), -1.0), "nominal pressure"),
        (theory(&surface, &rubber(), 1.0).at(f64::INFINITY).map(drop), "velocity"),
        (tiny.at(1.0).map(drop), "large enough for the modulus"),
        (spectrum(&[1.0], &[1.0]), "number of points"),
        (spectrum(&[1.0, 2.0], &[1.0]), "number of points"),
        (spectrum(&[1.0, 1.0], &[1.0, 1.0]), "greater than the one before"),
        (spectrum(&[0.0, 1.0], &[1.0, 1.0]), "wave number"),
        (spectrum(&[1.0, 2.0], &[1.0, -1.0]), "value of the spectrum"),
        (spectrum(&[1.0, 2.0], &[0.0, 0.0]), "rms roughness"),
    ] {
        let message = result.unwrap_err().to_string();
        assert!(message.contains(word), "{message:?} lacks {word:?}");
    }
}
