//! Against closed forms: an exponential conductance, whose flow is known for every profile, and a power law with a sealing pressure; gases
//! between parallel plates.

use super::*;
use crate::leakage::{Gas, Rarefaction, Species, plate};

/// exp(-p/p1) from 1e-4 to 5; its logarithm is straight, which the cubic keeps.
fn exponential(p1: f64) -> Conductance {
    let sweep: Vec<_> =
        (0..=40).map(|n| 1e-4 * 5e4f64.powf(f64::from(n) / 40.0)).map(|p| (p, (-p / p1).exp())).collect();
    Conductance::new(&sweep).unwrap()
}

fn profile(name: &str, peak: f64) -> Profile {
    let width = 2.0;
    let shape = match name {
        "uniform" => Shape::Uniform { peak, width },
        "hertz" => Shape::Hertz { peak, width },
        _ => Shape::Parabola { peak, width },
    };
    Profile { shape, energising: 0.0 }
}

/// Half width 1: resistance int exp(p0/p1) over |u| > edge, on one side.
fn edge(name: &str, peak: f64, p1: f64, below: f64) -> f64 {
    let p0 = |u: f64| match name {
        "uniform" => peak,
        "hertz" => peak * (1.0 - u * u).sqrt(),
        _ => peak * (1.0 - u * u),
    };
    const N: usize = 400_000;
    let places = (0..N).map(|n| (n as f64 + 0.5) / N as f64).map(p0).filter(|p| *p < below);
    places.map(|p| (p / p1).exp() / N as f64).sum()
}

/// Resistance of the whole profile from -1 to 1 and the flow are those of the closed forms (modified Bessel, Struve and error functions).
/// There the conductance goes on to p < 0; a seal is open instead where p0 < P_in at the inlet, p0 < P_out at the outlet.
#[test]
fn an_exponential_conductance_leaks_as_its_closed_form_for_every_profile() {
    let rows = [
        ("uniform", 1.0, 0.25, 0.1, 0.0, 109.19630006628849, 0.0011260104448197975),
        ("uniform", 2.0, 0.25, 1.5, 0.5, 5961.915974083457, 0.01660706638249329),
        ("uniform", 4.0, 0.5, 3.9, 0.0, 5961.915974083457, 0.20459882261251983),
        ("hertz", 1.0, 0.25, 0.8, 0.0, 61.46639984192563, 0.09571298407596844),
        ("hertz", 2.0, 0.25, 1.5, 0.5, 2512.5102381532965, 0.03940677846599493),
        ("parabola", 1.0, 0.25, 0.1, 0.0, 48.16001211429123, 0.0025530760689703186),
        ("parabola", 1.0, 0.25, 0.8, 0.0, 48.16001211429123, 0.12215803715571634),
        ("parabola", 4.0, 0.5, 3.9, 0.0, 1867.9200677600202, 0.6530263311936122),
    ];
    for (name, peak, p1, inlet, outlet, resistance, exact) in rows {
        let open = edge(name, peak, p1, inlet) + edge(name, peak, p1, outlet);
        let exact = exact * resistance / (resistance - open);
        let found = flow(&exponential(p1), &profile(name, peak), [inlet, outlet]).unwrap();
        assert_eq!(found.state, SealState::Leaks);
        // A uniform profile has no error of the cells; in others an edge of the contact is known to a cell, 1/400 of the width.
        let tolerance = if name == "uniform" { 1e-6 } else { 4e-3 };
        assert!(
            (found.flow / exact - 1.0).abs() < tolerance,
            "{name} {peak} {inlet}: {} {exact}",
            found.flow
        );
        assert_eq!([found.pressure[0], (found.pressure[CELLS] / 1e-9).round() * 1e-9], [inlet, outlet]);
        assert!(found.pressure.windows(2).all(|pair| pair[1] <= pair[0]));
        if name == "uniform" {
            let centre = p1 * (0.5 * ((inlet / p1).exp() + (outlet / p1).exp())).ln();
            assert!((found.pressure[CELLS / 2] / centre - 1.0).abs() < 1e-6);
            let one_way = (inlet - outlet) / resistance;
            assert!((found.one_way / one_way - 1.0).abs() < 1e-9);
        }
    }
}

/// (1 - p/p_s)^3.45 up to the sealing pressure 1: the flow is the integral of sigma, (1-p)^4.45/4.45, over the width.
#[test]
fn a_seal_chokes_opens_and_is_tight_as_the_power_law_says() {
    let sweep: Vec<_> =
        (1..=400).map(|n| f64::from(n) / 400.0).map(|p| (p, (1.0 - p).max(0.0).powf(3.45))).collect();
    let sigma = Conductance::new(&sweep).unwrap();
    for (peak, inlet, exact) in [(0.6, 0.3, 0.02107267356374089), (1.2, 0.5, 0.0005294190651928427)] {
        let found = flow(&sigma, &profile("uniform", peak), [inlet, 0.0]).unwrap();
        // The cubic of ln sigma between 400 points.
        assert!((found.flow / exact - 1.0).abs() < 1e-4, "{peak}: {}", found.flow);
    }
    let lower = flow(&sigma, &profile("uniform", 1.2), [0.5, 0.15]).unwrap();
    let upper = flow(&sigma, &profile("uniform", 1.2), [0.5, 0.0]).unwrap();
    // The outlet is choked: its pressure does not matter once 1.2 - P_out > 1.
    assert!((lower.flow / upper.flow - 1.0).abs() < 1e-9);
    assert!(upper.choke.unwrap().x > 1.99);
    let Opens::Between(low, high) = opening(&sigma, &profile("uniform", 1.2), 0.0) else { panic!() };
    assert!((low - 0.2).abs() < 1e-12 && (high - 0.2025).abs() < 1e-12, "{low} {high}");
    let tight = flow(&sigma, &profile("uniform", 1.2), [0.19, 0.0]).unwrap();
    assert_eq!((tight.state, tight.flow, tight.one_way), (SealState::Tight, 0.0, 0.0));
    assert_eq!(opening(&sigma, &profile("uniform", 0.9), 0.0), Opens::Always);
    let energised = |energising| opening(&sigma, &Profile { energising, ..profile("uniform", 1.2) }, 0.0);
    assert!(matches!(energised(0.5), Opens::Between(low, _) if (low - 0.4).abs() < 1e-12));
    assert_eq!(energised(1.0), Opens::Never);
    let lifted = flow(&sigma, &profile("hertz", 1.2), [1.2, 0.0]).unwrap();
    assert_eq!((lifted.state, lifted.flow), (SealState::Lifted, f64::INFINITY));
}

/// The flow through a stack of n equal seals, each with the pressures that the stack has at its ends, is that of the stack: the march does
/// not know where it begins.
#[test]
fn a_part_of_a_seal_between_its_own_pressures_has_the_flow_of_the_whole() {
    let sigma = exponential(0.3);
    let whole = flow(&sigma, &profile("uniform", 2.0), [1.1, 0.2]).unwrap();
    for part in [[0, CELLS / 4], [CELLS / 4, CELLS]] {
        let width = 2.0 * (part[1] - part[0]) as f64 / CELLS as f64;
        let profile = Profile { shape: Shape::Uniform { peak: 2.0, width }, energising: 0.0 };
        let ends = part.map(|n| whole.pressure[n]);
        assert!((flow(&sigma, &profile, ends).unwrap().flow / whole.flow - 1.0).abs() < 1e-8);
    }
}

#[test]
fn the_conductance_passes_through_the_sweep_and_is_held_outside_of_it() {
    let sweep = [(0.1, 1.0), (0.3, 0.4), (0.5, 0.41), (1.0, 1e-4), (2.0, 0.0)];
    let sigma = Conductance::new(&sweep).unwrap();
    for (p, known) in sweep {
        assert!((sigma.at(p) - known).abs() <= 1e-15, "{p}");
    }
    assert_eq!((sigma.at(0.0), sigma.at(2.5), sigma.sealing_pressure()), (sigma.at(0.1), 0.0, Some(2.0)));
    assert_eq!(sigma.with_below(2.0).at(0.05), 2.0 * sigma.at(0.05));
    assert!((sigma.at(1.5) / (1e-4 * 0.5f64.powf(3.45)) - 1.0).abs() < 1e-12);
}

#[test]
fn what_the_sweep_does_not_tell_is_not_made_up() {
    let tight = Conductance::new(&[(0.5, 0.0), (1.0, 0.0)]).unwrap();
    assert_eq!(flow(&tight, &profile("uniform", 0.6), [0.05, 0.0]).unwrap().state, SealState::Tight);
    let unknown = flow(&tight, &profile("uniform", 0.6), [0.2, 0.0]).unwrap();
    assert!(unknown.state == SealState::Unknown && unknown.flow.is_nan());
    let Opens::Between(low, high) = opening(&tight, &profile("uniform", 0.6), 0.0) else { panic!() };
    assert!((low - 0.1).abs() < 1e-12 && (high - 0.6).abs() < 1e-12);
    let leaks = Conductance::new(&[(0.5, 1.0), (1.0, 0.5)]).unwrap();
    assert_eq!(opening(&leaks, &profile("uniform", 1.5), 0.0), Opens::Unknown);
    assert_eq!(opening(&leaks, &profile("uniform", 0.9), 0.0), Opens::Always);
}

#[test]
fn a_profile_from_a_table_is_straight_between_places_and_inlet_pressures() {
    let table = |inlet, top| Table { inlet, points: vec![(1.0, 0.0), (2.0, top), (3.0, 0.0)] };
    let shape = Shape::Table(vec![table(0.0, 1.0), table(1.0, 2.0)]);
    let profile = Profile { shape, energising: 0.0 };
    profile.validate().unwrap();
    assert_eq!(
        (profile.width(), profile.pressures(4, 0.5).unwrap()),
        (2.0, vec![0.375, 1.125, 1.125, 0.375])
    );
    assert_eq!(profile.pressures(4, 1.1), None);
    assert!(flow(&exponential(0.3), &profile, [1.1, 0.0]).is_err());
    let bad = |points| {
        Profile { shape: Shape::Table(vec![Table { inlet: 0.0, points }]), energising: 0.0 }.validate()
    };
    for points in [
        vec![(0.0, 1.0)],
        vec![(0.0, 1.0), (0.0, 1.0)],
        vec![(1.0, 1.0), (0.0, 1.0)],
        vec![(0.0, 1.0), (1.0, -1.0)],
        vec![(0.0, 0.0), (1.0, 0.0)],
        vec![(0.0, f64::NAN), (1.0, 1.0)],
    ] {
        assert!(bad(points).is_err());
    }
}

#[test]
fn wrong_pressures_are_refused() {
    let sigma = exponential(0.3);
    for ends in [[1.0, 1.0], [0.5, 1.0], [f64::NAN, 0.0], [1.0, f64::NEG_INFINITY]] {
        assert!(flow(&sigma, &profile("uniform", 2.0), ends).is_err());
    }
    // A vacuum at the outlet.
    assert_eq!(flow(&sigma, &profile("uniform", 2.0), [1.0, -1.0]).unwrap().state, SealState::Leaks);
    for sweep in
        [vec![], vec![(0.0, 1.0)], vec![(1.0, -1.0)], vec![(1.0, f64::NAN)], vec![(2.0, 1.0), (1.0, 1.0)]]
    {
        assert!(Conductance::new(&sweep).is_err());
    }
    let energised = Profile { energising: 1.5, ..profile("uniform", 2.0) };
    assert_eq!(flow(&sigma, &energised, [1.0, 0.0]).unwrap_err().parameter(), "energising");
}

/// Near the pressure at which it is tight a seal conducts 1e-17 of what it does without pressure; its leak is as accurate as any other.
#[test]
fn a_leak_is_accurate_where_the_conductance_spans_many_decades() {
    let p1 = 0.05;
    for (peak, inlet, outlet) in [(2.0, 0.05, 0.0), (2.0, 1.9, 0.0), (4.0, 0.1, -1.0)] {
        let exact = p1 * (f64::exp((inlet - peak) / p1) - f64::exp((outlet - peak) / p1)) / 2.0;
        let found = flow(&exponential(p1), &profile("uniform", peak), [inlet, outlet]).unwrap();
        // Eight points in each interval of the sweep, over which sigma falls by up to 24 powers of e.
        assert!((found.flow / exact - 1.0).abs() < 1e-6, "{inlet}: {} {exact}", found.flow);
    }
}

#[test]
fn opening_pressures_count_from_the_outlet() {
    let sigma = Conductance::new(&[(0.5, 1.0), (1.0, 0.5), (1.1, 0.0)]).unwrap();
    let at = |peak, outlet| opening(&sigma, &profile("uniform", peak), outlet);
    // A vacuum at the outlet: tight while 0.9 - P is 1.1 at least.
    let Opens::Between(low, high) = at(0.9, -1.0) else { panic!() };
    assert!((low + 0.2).abs() < 1e-12 && (high + 0.1).abs() < 1e-12, "{low} {high}");
    assert_eq!(at(0.9, 0.0), Opens::Always);
    // Every inlet pressure above this outlet leaks.
    assert_eq!(at(1.5, 0.6), Opens::Always);
    assert!(matches!(at(1.5, 0.45), Opens::Between(low, _) if low == 0.45));
}

/// Contact pressures 1.5, 1.2, 2.5 at the inlet pressures 0.2, 0.6, 1: p0 - P falls to 0.6 and rises again.
#[test]
fn a_seal_that_opens_and_closes_again_has_its_first_opening_pressure() {
    let table = |inlet, top| Table { inlet, points: vec![(0.0, 0.0), (0.51, top), (1.0, 0.0)] };
    let shape = Shape::Table(vec![table(0.2, 1.5), table(0.6, 1.2), table(1.0, 2.5)]);
    let profile = Profile { shape, energising: 0.0 };
    // The largest pressure lies at a point of the table, not in the middle of a cell.
    assert_eq!(profile.largest(0.2), Some(1.5));
    let of = |leaks, tight| {
        let sigma = Conductance::new(&[(0.5 * leaks, 1.0), (leaks, 0.5), (tight, 0.0)]).unwrap();
        opening(&sigma, &profile, 0.0)
    };
    // 1.3 - 1.75 (P - 0.2) is 1.0 at P = 0.2 + 0.3/1.75.
    let Opens::Between(low, _) = of(0.9, 1.0) else { panic!() };
    assert!((low - (0.2 + 0.3 / 1.75)).abs() < 1e-12, "{low}");
    assert_eq!(of(0.4, 0.5), Opens::Never);
    assert_eq!(of(1.3, 1.4), Opens::Always);
    // Below the tables nothing is known.
    assert!(matches!(of(1.2, 1.4), Opens::Between(low, _) if low == 0.0));
}

#[test]
fn tables_over_the_inlet_pressure_are_not_energised_again() {
    let table = |inlet| Table { inlet, points: vec![(0.0, 1.0), (1.0, 1.0)] };
    let shape = Shape::Table(vec![table(0.0), table(1.0)]);
    assert_eq!(Profile { shape, energising: 0.5 }.validate().unwrap_err().parameter(), "energising");
}

fn air() -> Gas {
    Gas::of(Species::Air, 293.15).unwrap()
}

/// A patch of parallel plates at these gaps \[m\] under these pressures \[Pa\].
fn plates(gaps: &[(f64, f64)], law: Rarefaction, reference: f64) -> Conductance {
    let (size, ends) = ([1e-4, 1e-4], [3e5, 1e5]);
    let points: Vec<GasPoint> = gaps
        .iter()
        .map(|(pressure, gap)| GasPoint {
            pressure: *pressure,
            sigma: gap.powi(3),
            critical_gap: *gap,
            leak_rate: plate(&air(), law, *gap, size, ends).unwrap(),
        })
        .collect();
    let sweep: Vec<_> = points.iter().map(|point| (point.pressure, point.sigma)).collect();
    Conductance::new(&sweep)
        .unwrap()
        .of_gas(SealGas::new(air(), law, reference, &points, size, ends).unwrap())
}

/// sigma = exp(-p/p1) in the continuum: F = p1 [(P_a - p1) e^(P/p1)] between outlet and inlet, over int e^(p0/p1) dx.
#[test]
fn a_gas_in_the_continuum_leaks_as_the_closed_form() {
    let (p1, peak, reference) = (0.25e6, 1e6, 1e5);
    let gaps: Vec<_> = (0..=20)
        .map(|n| 1e3 * 2e3f64.powf(f64::from(n) / 20.0))
        .map(|p| (p, 1e-6 * (-p / (3.0 * p1)).exp()))
        .collect();
    let sigma = plates(&gaps, Rarefaction::Continuum, reference);
    for (inlet, outlet) in [(8e5, 0.0), (1e5, 0.0), (9e5, -1e5)] {
        let part = |p: f64| p1 * (p + reference - p1) * (p / p1).exp();
        let exact = 1e-18 * (part(inlet) - part(outlet)) / ((peak / p1).exp() * 2.0);
        let found = flow(&sigma, &profile("uniform", peak), [inlet, outlet]).unwrap();
        assert!((found.flow / exact - 1.0).abs() < 1e-9, "{inlet}: {} {exact}", found.flow);
    }
}

/// A contact that the pressure of the gas does not open leaks as parallel plates, and as two of them in series, at every law; the vacuum
/// at the outlet included.
#[test]
fn a_rarefied_gas_leaks_as_between_plates() {
    let leak = |flow: f64| flow / (12.0 * air().viscosity * air().specific_energy());
    for law in [Rarefaction::Continuum, Rarefaction::Slip, Rarefaction::Boltzmann] {
        for (ends, gap) in [([1e5, 0.0], 1e-7), ([1e5, -1e5], 3e-8)] {
            let sigma = plates(&[(1e6, gap), (1e7, gap)], law, 1e5);
            let found = flow(&sigma, &profile("uniform", 5e6), ends).unwrap();
            let exact = plate(&air(), law, gap, [2.0, 1.0], ends.map(|p| p + 1e5)).unwrap();
            // The quadrature does not know where the fit of Q jumps by 0.3 % between its pieces, nor the logarithm towards a vacuum.
            assert!(
                (leak(found.flow) / exact - 1.0).abs() < 1e-5,
                "{law:?} {gap}: {} {exact}",
                leak(found.flow)
            );
            assert!((found.one_way / found.flow - 1.0).abs() < 1e-9);
        }
    }
    // 1 um and 0.2 um, each 0.5 mm long, in an independent solution.
    let step =
        Table { inlet: 0.0, points: vec![(0.0, 1e9), (0.4999e-3, 1e9), (0.5001e-3, 2e9), (1e-3, 2e9)] };
    let profile = Profile { shape: Shape::Table(vec![step]), energising: 0.0 };
    let exact = [
        (Rarefaction::Continuum, 1.295_516_732_778_094e-8),
        (Rarefaction::Slip, 2.994_212_833_885_088e-8),
        (Rarefaction::Boltzmann, 3.551_748_419_964_744e-8),
    ];
    for (law, exact) in exact {
        let sigma = plates(&[(1e9, 1e-6), (2e9, 2e-7)], law, 1e5);
        let found = flow(&sigma, &profile, [1e5, 0.0]).unwrap();
        // One way: the pressures 1 bar and 1 GPa differ.
        assert!((leak(found.one_way) / exact - 1.0).abs() < 1e-5, "{law:?}: {} {exact}", leak(found.one_way));
    }
}

/// (1 - p)^3.45 as a sweep knows it.
fn closing(pressures: &[f64]) -> Conductance {
    let mut pressures = pressures.to_vec();
    pressures.sort_by(f64::total_cmp);
    Conductance::new(&pressures.into_iter().map(|p| (p, (1.0 - p).max(0.0).powf(3.45))).collect::<Vec<_>>())
        .unwrap()
}

/// Twelve pressures equally far apart in their logarithm, as a sweep begins.
fn first_pressures(most: f64) -> Vec<f64> {
    (0..12).map(|n| most / 300f64.powf(1.0 - f64::from(n) / 11.0)).collect()
}

/// The power law, which chokes near its sealing pressure, is known in closed form under a uniform contact pressure: the integral of sigma,
/// [(1 - p)^4.45/4.45]. A sweep of twelve pressures leaves the leak open by orders of magnitude; the bounds contain it, and a dozen
/// further pressures leave 5 % of it open.
#[test]
fn pressures_are_added_where_the_flow_chokes_until_the_leak_stands() {
    let mut widest = 1.0f64;
    for (peak, inlet) in [(0.98, 0.05), (1.1, 0.15), (1.3, 0.9)] {
        let to = 1.0 - peak + inlet;
        let exact = (f64::powf(to, 4.45) - f64::max(1.0 - peak, 0.0).powf(4.45)) / 4.45 / 2.0;
        let profile = profile("uniform", peak);
        let mut pressures = first_pressures(peak);
        let mut more = 0;
        loop {
            let sigma = closing(&pressures);
            let [low, high] = bounds(&sigma, &profile, [inlet, 0.0]).unwrap();
            let likely = flow(&sigma, &profile, [inlet, 0.0]).unwrap().flow;
            // Rounding, and the quadrature of eight points where the bounds bend.
            assert!(
                low <= exact * 1.001 && exact <= high * 1.001,
                "{peak} {inlet} {more}: {low} {exact} {high}"
            );
            assert!(low <= likely * 1.001 && likely <= high * 1.001, "{peak} {inlet}: {low} {likely} {high}");
            widest = widest.max(high / low);
            if low > 0.95 * high {
                break;
            }
            pressures.push(refinement(&sigma, &profile, [inlet, 0.0]).unwrap().unwrap());
            more += 1;
            assert!(more <= 16, "{peak} {inlet}: {low} {exact} {high}");
        }
    }
    assert!(widest > 10.0, "the first pressures leave little open: {widest}");
}

/// A passage closes at once between two pressures of the sweep: the bounds contain every place where it may.
#[test]
fn the_bounds_contain_a_step_between_two_pressures() {
    for step in [0.61, 0.7, 0.79] {
        let sigma = |p: f64| (-2.0 * p).exp() * if p > step { 0.05 } else { 1.0 };
        let sweep: Vec<_> = (1..=10).map(|n| 0.2 * f64::from(n)).map(|p| (p, sigma(p))).collect();
        let known = Conductance::new(&sweep).unwrap();
        for p in (0..200).map(|n| 0.2 + 0.009 * f64::from(n)) {
            let [low, high] = [known.low().at(p), known.high().at(p)];
            // Rounding.
            assert!(
                low <= sigma(p) * (1.0 + 1e-9) && sigma(p) <= high * (1.0 + 1e-9),
                "{step} {p}: {low} {high}"
            );
            assert!(low <= known.at(p) * (1.0 + 1e-9) && known.at(p) <= high * (1.0 + 1e-9), "{step} {p}");
        }
    }
}

#[test]
fn a_tight_or_lifted_seal_needs_no_further_pressure() {
    let sigma = closing(&[0.1, 0.5, 0.9, 0.99, 1.0]);
    let next = |peak: f64, inlet: f64| refinement(&sigma, &profile("uniform", peak), [inlet, 0.0]).unwrap();
    assert_eq!((next(1.2, 0.1), next(0.5, 0.6)), (None, None));
    assert_eq!(bounds(&sigma, &profile("uniform", 1.2), [0.1, 0.0]).unwrap(), [0.0, 0.0]);
    // Between the last pressure that leaks and the first tight one it may be tight.
    let [low, high] = bounds(&sigma, &profile("uniform", 1.2), [0.205, 0.0]).unwrap();
    assert!(low == 0.0 && high > 0.0);
}
