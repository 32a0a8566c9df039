//! Facts about the row of springs.

use super::super::{HertzSphere, SneddonCone, Ting};
use super::{Mdr, MdrOptions, MdrProfile, MdrState, MdrTarget};
use crate::load::{Control, History, Loading};
use crate::material::Relaxation;

const SPHERE: MdrProfile = MdrProfile::Paraboloid { radius: 1.0 };
const CONE: MdrProfile = MdrProfile::Cone { slope: 0.1 };

/// E*(t) = 2 + 2 exp(-t/0.5); C(t) = 1/4 + (1 - exp(-t))/4.
fn zener() -> Relaxation {
    Relaxation::absolute(2.0, &[(2.0, 0.5)]).unwrap()
}

fn march(
    profile: MdrProfile,
    relaxation: &Relaxation,
    control: Control,
    history: History,
    times: &[f64],
    substeps: usize,
) -> Vec<MdrState> {
    let options = MdrOptions { substeps, ..MdrOptions::default() };
    Mdr::march(profile, relaxation, &Loading { control, history }, times, options).unwrap()
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs()
}

#[test]
fn an_elastic_row_is_hertz_and_sneddon_under_any_history() {
    // q is linear in g, so there is no error of discretisation: rounding of a thousand cells.
    let elastic = Relaxation::absolute(3.0, &[]).unwrap();
    let points = vec![(0.0, 0.0), (1.0, 2.0), (2.0, 0.5), (2.0, 1.0), (3.0, 0.1), (4.0, 3.0), (5.0, 0.0)];
    let history = History::Table { points };
    let times = [0.5, 1.5, 2.5, 2.8, 3.7, 4.5];
    for state in march(SPHERE, &elastic, Control::Load, history.clone(), &times, 3) {
        let hertz = HertzSphere::under_load(1.0, 3.0, state.load).unwrap();
        assert!((state.approach - hertz.approach).abs() < 1e-12, "{state:?}");
        assert!((state.contact_radius - hertz.contact_radius).abs() < 1e-12);
    }
    for state in march(CONE, &elastic, Control::Load, history, &times, 3) {
        let cone = SneddonCone::under_load(0.1, 3.0, state.load).unwrap();
        assert!((state.approach - cone.approach).abs() < 1e-12, "{state:?}");
        assert!((state.contact_radius - cone.contact_radius).abs() < 1e-12);
    }
}

#[test]
fn elastic_pressures_and_displacements_are_those_of_hertz_and_sneddon() {
    let elastic = Relaxation::absolute(3.0, &[]).unwrap();
    let mut row = Mdr::new(SPHERE, &elastic, 1.0, 777).unwrap();
    let state = row.step(0.0, MdrTarget::Load(1.3)).unwrap();
    let hertz = HertzSphere::under_load(1.0, 3.0, 1.3).unwrap();
    for share in [0.0, 0.3, 0.7, 0.99, 1.2, 3.0] {
        let r = share * state.contact_radius;
        assert!((row.pressure(r) - hertz.pressure(r)).abs() < 1e-11 * hertz.peak_pressure);
        // Outside, u is linear in g across the edge cell instead of ending in it: (dx/a)^2 of u.
        let tolerance = if share < 1.0 { 1e-12 } else { 1e-5 };
        assert!((row.displacement(r) - hertz.displacement(r)).abs() < tolerance * hertz.approach, "{share}");
    }
    let mut row = Mdr::new(CONE, &elastic, 2.0, 777).unwrap();
    let state = row.step(0.0, MdrTarget::Load(1.3)).unwrap();
    let cone = SneddonCone::under_load(0.1, 3.0, 1.3).unwrap();
    assert!(near(state.contact_radius, cone.contact_radius, 1e-12));
    for share in [0.1, 0.7, 1.5] {
        let r = share * state.contact_radius;
        assert!((row.pressure(r) - cone.pressure(r)).abs() < 1e-11, "{share}");
        assert!((row.displacement(r) - cone.displacement(r)).abs() < 1e-5 * cone.approach, "{share}");
    }
}

#[test]
fn a_held_approach_relaxes_as_the_modulus() {
    // The approach is piecewise linear, so there is no error in time. The previous contact ends at the edge, within a cell: the
    // error of the edge is a fraction of a cell, dx/a = 1e-3, and that of the load is its square.
    let times = [0.1, 0.5, 1.0, 2.0, 10.0];
    let history = History::Step { value: 0.04 };
    let states = march(SPHERE, &zener(), Control::Approach, history, &times, 1);
    for state in states {
        let modulus = 2.0 + 2.0 * (-state.time / 0.5f64).exp();
        let load = 4.0 / 3.0 * 0.04f64.powf(1.5) * modulus;
        assert!(near(state.load, load, 1e-6), "{state:?} {load}");
        assert!(near(state.contact_radius, 0.2, 1e-3));
    }
}

#[test]
fn a_ramped_approach_follows_the_hereditary_integral() {
    // W = (4/3R) int E*(t - s) d(R v s)^1.5 with v = 0.04, held from t = 1; 15 digits. Springs that
    // start within a step make the error second order: 400 steps to t = 1.
    let history = History::Ramp { value: 0.04, duration: 1.0 };
    let rows = [
        (0.1, 0.001298220672586881),
        (0.25, 0.004868438994610056),
        (0.5, 0.012768506141152753),
        (1.0, 0.03221342873681006),
        (1.5, 0.025335896750256333),
        (2.0, 0.02280579412640422),
        (4.0, 0.021360302393497035),
        (10.0, 0.021333333499036967),
    ];
    let times: Vec<f64> = rows.iter().map(|r| r.0).collect();
    let error = |substeps| {
        let states = march(SPHERE, &zener(), Control::Approach, history.clone(), &times, substeps);
        states[1..].iter().zip(&rows).map(|(s, r)| (s.load / r.1 - 1.0).abs()).fold(0.0, f64::max)
    };
    let [coarse, fine] = [error(25), error(100)];
    assert!(fine < 2e-6, "{fine:e}");
    assert!(coarse / fine > 8.0, "second order: {coarse:e} {fine:e}");
}

#[test]
fn a_triangle_agrees_with_ting_up_and_down() {
    let history = History::Triangle { peak: 1.0, rise: 1.0, fall: 1.0 };
    let ting = Ting::new(1.0, &zener().to_creep().unwrap(), &history, 2.0).unwrap();
    let times = [0.25, 0.5, 0.75, 1.0, 1.1, 1.25, 1.5, 1.75, 1.9, 1.98];
    let states = march(SPHERE, &zener(), Control::Load, history.clone(), &times, 100);
    let mut dissipated = 0.0;
    for state in &states[1..] {
        let exact = ting.at(state.time).unwrap();
        // Second order in a step of 0.0025 tau and less.
        assert!(near(state.approach, exact.approach, 1e-5), "{state:?} {exact:?}");
        assert!(near(state.contact_radius, exact.contact_radius, 3e-5), "{state:?} {exact:?}");
        assert!(near(state.load, exact.load, 1e-12));
    }
    let dense: Vec<f64> = (1..=400).map(|n| f64::from(n) / 200.0).collect();
    let states = march(SPHERE, &zener(), Control::Load, history, &dense, 4);
    for pair in states.windows(2) {
        dissipated += 0.5 * (pair[0].load + pair[1].load) * (pair[1].approach - pair[0].approach);
    }
    // int W d(approach) over the cycle, 13 digits; the trapezia of the start are as good as 1/400^1.5.
    assert!(near(dissipated, 0.0848649604203858, 2e-3), "{dissipated}");
}

#[test]
fn pressures_in_an_unloading_contact_are_tings() {
    let history = History::Triangle { peak: 1.0, rise: 1.0, fall: 1.0 };
    let ting = Ting::new(1.0, &zener().to_creep().unwrap(), &history, 2.0).unwrap();
    let mut row = Mdr::new(SPHERE, &zener(), 0.7, 2000).unwrap();
    row.step(0.0, MdrTarget::Load(0.0)).unwrap();
    for n in 1..=600 {
        let (t, before) = (f64::from(n) / 400.0, f64::from(n - 1) / 400.0);
        row.step(t - before, MdrTarget::Load(history.before(t))).unwrap();
    }
    let peak = ting.at(1.5).unwrap().peak_pressure;
    for r in [0.0, 0.1, 0.3, 0.5, 0.54] {
        let (got, exact) = (row.pressure(r), ting.pressure(r, 1.5).unwrap());
        assert!((got - exact).abs() < 1e-3 * peak, "{r}: {got} {exact}"); // first order at the edge
    }
}

#[test]
fn a_growing_cone_is_sneddons_with_the_creep_function() {
    // a^2 = (2 / (pi slope)) int C dW; under a step C(t) W.
    let creep = zener().to_creep().unwrap();
    let times = [0.2, 1.0, 5.0];
    for state in march(CONE, &zener(), Control::Load, History::Step { value: 1.0 }, &times, 200) {
        let cone = SneddonCone::under_load(0.1, 1.0 / creep.value(state.time), 1.0).unwrap();
        assert!(near(state.approach, cone.approach, 1e-5), "{state:?}");
        assert!(near(state.contact_radius, cone.contact_radius, 1e-5), "{state:?}");
    }
}

#[test]
fn a_rested_body_has_forgotten_and_a_hurried_one_has_not() {
    // The same triangle again after a rest of 1 and of 40 retardation times.
    let again = |rest: f64| {
        let start = 2.0 + rest;
        let points =
            vec![(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (start, 0.0), (start + 1.0, 1.0), (start + 2.0, 0.0)];
        let history = History::Table { points };
        let times = [1.0, 1.5, start + 1.0, start + 1.5];
        let states = march(SPHERE, &zener(), Control::Load, history, &times, 100);
        let at = |t: f64| *states.iter().find(|s| s.time == t).unwrap();
        (at(1.0), at(1.5), at(start + 1.0), at(start + 1.5))
    };
    let (up, down, up_again, down_again) = again(40.0);
    // The remainder of the first cycle is exp(-40); both cycles have the same steps except for a rounded start time.
    assert!(near(up_again.approach, up.approach, 1e-9) && near(down_again.approach, down.approach, 1e-9));
    assert!(near(down_again.contact_radius, down.contact_radius, 1e-9));
    let (up, _, up_again, _) = again(1.0);
    assert!(up_again.approach > 1.01 * up.approach, "{up:?} {up_again:?}");
}

#[test]
fn loading_again_converges_with_the_step() {
    // Unloaded to a tenth and loaded again: no closed form, so successive refinements must shrink by
    // the square of the step.
    let points = vec![(0.0, 0.0), (1.0, 1.0), (1.6, 0.1), (2.4, 1.2), (3.0, 1.2)];
    let run = |substeps| {
        let history = History::Table { points: points.clone() };
        let states = march(SPHERE, &zener(), Control::Load, history, &[0.5, 1.3, 2.0, 3.0], substeps);
        states.iter().map(|s| s.approach).collect::<Vec<_>>()
    };
    let (coarse, middle, fine) = (run(20), run(40), run(80));
    let change = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let (first, second) = (change(&coarse, &middle), change(&middle, &fine));
    assert!(first < 1e-4 && first / second > 2.5, "{first:e} {second:e}");
}

#[test]
fn after_a_drop_to_a_constant_load_the_area_never_shrinks() {
    let points = vec![(0.0, 1.0), (1.0, 1.0), (1.0, 0.3), (6.0, 0.3)];
    let times: Vec<f64> = (1..=60).map(|n| f64::from(n) / 10.0).collect();
    let states = march(SPHERE, &zener(), Control::Load, History::Table { points }, &times, 10);
    let held: Vec<_> = states.iter().skip_while(|s| !near(s.load, 0.3, 1e-12)).collect();
    assert!(held.len() > 50);
    assert!(held.windows(2).all(|w| w[1].contact_radius >= w[0].contact_radius * (1.0 - 1e-9)));
    // At the end the body has relaxed: Hertz with E_inf.
    let relaxed = HertzSphere::under_load(1.0, 2.0, 0.3).unwrap();
    assert!(near(states.last().unwrap().contact_radius, relaxed.contact_radius, 5e-3)); // exp(-5)
}

#[test]
fn a_kelvin_voigt_body_creeps_from_zero() {
    // E*(t) = 2 + 3 delta(t): C(t) = (1 - exp(-t/1.5))/2; W ramps to 1 and holds. Implicit Euler is
    // first order in the step.
    let body = Relaxation { equilibrium: 2.0, terms: vec![], viscosity: 3.0 };
    let history = History::Ramp { value: 1.0, duration: 1.0 };
    let ting = super::super::hereditary::hereditary(&body.to_creep().unwrap(), &history, 2.0);
    let states = march(SPHERE, &body, Control::Load, history, &[1.0, 2.0], 800);
    let last = states.last().unwrap();
    assert!(near(last.contact_radius, (0.75 * ting).cbrt(), 1e-3), "{last:?}");
    let jump = Loading { control: Control::Load, history: History::Step { value: 1.0 } };
    let message = Mdr::march(SPHERE, &body, &jump, &[1.0], MdrOptions::default()).unwrap_err().to_string();
    assert!(message.contains("jump"), "{message}");
}

#[test]
fn the_row_grows_with_the_contact() {
    let mut row = Mdr::new(SPHERE, &zener(), 0.05, 100).unwrap();
    let state = row.step(0.0, MdrTarget::Load(1.0)).unwrap();
    let hertz = HertzSphere::under_load(1.0, 4.0, 1.0).unwrap();
    assert!(near(state.contact_radius, hertz.contact_radius, 1e-12));
    let message = row.step(0.0, MdrTarget::Load(1e9)).unwrap_err().to_string();
    assert!(message.contains("contact radius"), "{message}");
}

#[test]
fn absurd_numbers_are_named() {
    let bad = |control, history, times: &[f64]| {
        let loading = Loading { control, history };
        Mdr::march(SPHERE, &zener(), &loading, times, MdrOptions::default()).unwrap_err().to_string()
    };
    let step = History::Step { value: 1.0 };
    assert!(bad(Control::Pressure, step.clone(), &[1.0]).contains("mean pressure"));
    assert!(bad(Control::Load, History::Step { value: -1.0 }, &[1.0]).contains("smallest load"));
    assert!(bad(Control::Load, step.clone(), &[]).contains("times"));
    assert!(bad(Control::Load, step.clone(), &[1.0, 1.0]).contains("time 2"));
    assert!(bad(Control::Load, step, &[f64::NAN]).contains("time 1"));
    assert!(Mdr::new(SPHERE, &zener(), 0.0, 10).is_err() && Mdr::new(SPHERE, &zener(), 1.0, 1).is_err());
    let flat = MdrProfile::Cone { slope: 0.0 };
    assert!(Mdr::new(flat, &zener(), 1.0, 10).unwrap_err().to_string().contains("slope"));
    let mut row = Mdr::new(SPHERE, &zener(), 1.0, 10).unwrap();
    assert!(row.step(-1.0, MdrTarget::Load(1.0)).is_err());
    assert!(row.step(1.0, MdrTarget::Approach(f64::NAN)).is_err());
}

#[test]
fn the_ball_has_sneddons_numbers() {
    // (d, a, W/E*) of R = 1: a from d = (a/2) ln((1 + a)/(1 - a)) by bracketing, W = ((1 + a²)/2) ln((1 + a)/(1 - a)) - a, in another program.
    for (depth, a, load) in [
        (1e-3, 0.031617506051082836, 4.2159485714954315e-05),
        (0.1, 0.31094923331193713, 0.041741594710428875),
        (0.3, 0.520235228514488, 0.2124975565849313),
        (1.0, 0.8335565596009646, 1.1996786402577333),
    ] {
        let ball = MdrProfile::Sphere { radius: 1.0 };
        // The bracketing ends at 2e-12; the closed form of the load at 1e-3 cancels four digits in that program.
        assert!(near(ball.reach(depth), a, 1e-11) && near(ball.unit_load(depth), load, 1e-10), "{depth}");
        // A row of springs, exact but for Gauss' rule over cells.
        let elastic = Relaxation::absolute(3.0, &[]).unwrap();
        let mut row = Mdr::new(ball, &elastic, 0.9, 900).unwrap();
        let state = row.step(0.0, MdrTarget::Approach(depth)).unwrap();
        assert!(near(state.load, 3.0 * load, 1e-9) && near(state.contact_radius, a, 1e-9), "{state:?}");
        let again =
            Mdr::new(ball, &elastic, 0.9, 900).unwrap().step(0.0, MdrTarget::Load(3.0 * load)).unwrap();
        assert!(near(again.approach, depth, 1e-9), "{again:?}");
        // The pressure carries the load, and below the ball the surface has its shape.
        if depth > 0.01 {
            let n = 4000;
            let ring = |k: usize| {
                let r = a * ((k as f64 + 0.5) / n as f64).sqrt();
                row.pressure(r) * std::f64::consts::PI * a * a / n as f64
            };
            let carried: f64 = (0..n).map(ring).sum();
            // The pressure falls as a root at the edge: rings of 1/4000 of the area.
            assert!(near(carried, state.load, 1e-4), "{carried} {state:?}");
            for share in [0.2, 0.7, 0.95] {
                let r = share * a;
                let shape = depth - (1.0 - (1.0 - r * r).sqrt());
                assert!((row.displacement(r) - shape).abs() < 1e-5 * depth, "{share}");
            }
        }
    }
    // A deep ball follows its profile beyond the equator without a break.
    let ball = MdrProfile::Sphere { radius: 2.0 };
    for depth in [7.5, 7.7, 9.0] {
        let (h, slope) = (1e-6, 2.0 * ball.reach(depth));
        assert!(
            near((ball.unit_load(depth + h) - ball.unit_load(depth - h)) / (2.0 * h), slope, 1e-5),
            "{depth}"
        );
        assert!(near(ball.height(ball.reach(depth)), depth, 1e-12), "{depth}");
    }
}
