//! Quantities of each row against closed forms, the energy balance, and what other rooms say.

use asperity::Drive;
use std::f64::consts::PI;

use asperity::drive::March;

use asperity::material::{Creep, CreepTerm};
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::{Scheme, Simulation};
use asperity::spots::Spots;
use asperity::surface::{Part, Punch, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, Plasticity, Programme, SolverOptions, TimeGrid};
use ndarray::Array2;

fn burgers() -> Creep {
    let term = |compliance, retardation_time| CreepTerm { compliance, retardation_time };
    Creep { instantaneous: 0.25, terms: vec![term(0.25, 1.0), term(0.1, 0.2)], fluidity: 0.05 }
}

fn shape(shape: Shape, n: usize, size: f64) -> Simulation {
    let grid = Grid::new([n, n], [size, size]).unwrap();
    let gap = undeformed_gap(&grid, &[Part::Shape { shape, center: [0.0, 0.0] }]).unwrap();
    let solver = SolverOptions { tolerance: 1e-10, ..SolverOptions::default() };
    Simulation { creep: burgers(), solver, ..Simulation::new(grid, gap) }
}

fn sphere(n: usize, size: f64) -> Simulation {
    shape(Shape::Sphere { radius: 1.0 }, n, size)
}

fn load(history: History) -> Programme {
    Loading { control: Control::Load, history }.into()
}

/// Every quantity that the simulation can have, at every row: (time, load, approach, values by name).
fn run(simulation: Simulation, list: &[Quantity]) -> Vec<Taken> {
    let simulation = Simulation { quantities: Quantities::of(list.iter().copied()), ..simulation };
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        let values = list.iter().map(|q| step.quantity(*q).unwrap().to_vec()).collect();
        rows.push(Taken {
            load: row.load,
            approach: row.approach,
            area: row.contact_area,
            list: list.to_vec(),
            values,
        });
    }
    rows
}

struct Taken {
    load: f64,
    approach: f64,
    area: f64,
    list: Vec<Quantity>,
    values: Vec<Vec<f64>>,
}

impl Taken {
    fn get(&self, quantity: Quantity) -> f64 {
        let n = self.list.iter().position(|q| *q == quantity).unwrap();
        self.values[n][0]
    }
}

const ENERGIES: [Quantity; 4] =
    [Quantity::ElasticEnergy, Quantity::DissipatedEnergy, Quantity::FlatteningWork, Quantity::ExternalWork];

#[test]
fn hertz_stores_two_fifths_of_load_times_approach_and_is_as_stiff_as_its_radius_says() {
    let elastic = Simulation {
        creep: Creep::elastic(0.25),
        loading: load(History::Step { value: 0.02 }),
        times: TimeGrid::Uniform { end: 1.0, steps: 1 },
        ..sphere(129, 0.5)
    };
    let list = [&ENERGIES[..], &[Quantity::ContactStiffness]].concat();
    let rows = run(elastic, &list);
    let row = &rows[0];
    // a^3 = 3 R W/(4 E*), w = a^2/R, dW/dw = 2 a E*; 40 cells across the contact: 1 % of a ring of half cells.
    let a = (0.75f64 * 0.02 / 4.0).cbrt();
    assert!((row.get(Quantity::ContactStiffness) / (2.0 * a * 4.0) - 1.0).abs() < 0.01);
    assert!((row.get(Quantity::ElasticEnergy) / (0.4 * row.load * row.approach) - 1.0).abs() < 5e-3);
    assert!((row.approach / (a * a) - 1.0).abs() < 5e-3);
    // The jump at 0+ is exact, and nothing is lost: to the solver's tolerance and rounding.
    assert!((row.get(Quantity::ExternalWork) / row.get(Quantity::ElasticEnergy) - 1.0).abs() < 1e-12);
    assert_eq!(row.get(Quantity::DissipatedEnergy), 0.0);
    assert_eq!(row.get(Quantity::FlatteningWork), 0.0);
}

#[test]
fn the_work_on_elastic_bodies_is_that_of_hertz_in_a_few_long_steps() {
    // W ~ w^1.5, so that the work is (2/5) W w; pressed and released in nine adaptive rows.
    let top = (4.0 / 3.0) * 0.1_f64.powf(1.5);
    for (control, peak) in [(Control::Load, top), (Control::Approach, 0.1)] {
        let rows = run(
            Simulation {
                creep: Creep::elastic(1.0),
                loading: Loading { control, history: History::Triangle { peak, rise: 0.5, fall: 0.5 } }
                    .into(),
                times: TimeGrid::Adaptive { end: 1.0, tolerance: 1e-2, first: 0.1 },
                ..sphere(48, 1.0)
            },
            &ENERGIES,
        );
        assert!(rows.len() < 20, "{}", rows.len());
        for row in rows.iter().filter(|row| row.approach > 0.05) {
            let exact = 0.4 * row.load * row.approach;
            // 10 cells to the radius and more: at most 1 % of a ring of half cells, as above. (Chords of W over w: 2 %.)
            assert!((row.get(Quantity::ExternalWork) / exact - 1.0).abs() < 5e-3, "{control:?}");
        }
        // All is given back, to the tolerance of the solver.
        let last = rows.last().unwrap().get(Quantity::ExternalWork);
        assert!(last.abs() < 1e-8 * top * 0.1, "{control:?}: {last:e}");
    }
}

#[test]
fn the_stiffness_is_the_slope_of_load_over_approach() {
    // Rough, periodic: load over approach is smooth where the set changes by single cells, so that a central
    // difference of 2e-5 in the approach meets the slope to the set's granularity.
    let grid = Grid::new([48, 40], [1.0, 1.0]).unwrap();
    let roughness = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 0.1,
        roll_off: 0.5,
        seed: 3,
    };
    let gap = undeformed_gap(&grid, &[Part::SelfAffine(roughness)]).unwrap();
    let middle = 0.01;
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let at = |approach: f64| {
            let simulation = Simulation {
                boundary,
                creep: Creep::elastic(0.5),
                loading: Loading { control: Control::Approach, history: History::Step { value: approach } }
                    .into(),
                solver: SolverOptions { tolerance: 1e-11, ..SolverOptions::default() },
                ..Simulation::new(grid, gap.clone())
            };
            let rows = run(simulation, &[Quantity::ContactStiffness]);
            (rows[0].load, rows[0].get(Quantity::ContactStiffness))
        };
        let (up, down, stiffness) = (at(middle * 1.00001).0, at(middle * 0.99999).0, at(middle).1);
        let slope = (up - down) / (2e-5 * middle);
        assert!((stiffness / slope - 1.0).abs() < 2e-3, "{boundary:?}: {stiffness} {slope}");
    }
}

#[test]
fn a_flat_punch_stores_and_loses_what_a_chain_of_springs_and_dashpots_does() {
    // The contact never changes: p = P s, U = P K s, for any history. C = C0 + sum Cj (1 - exp(-t/lj)) + t/eta.
    let creep = burgers();
    let punch = |history, scheme| Simulation {
        loading: load(history),
        times: TimeGrid::Uniform { end: 2.0, steps: 7 },
        scheme,
        ..shape(Shape::FlatPunch(Punch::Circle { radius: 0.3 }), 24, 1.0)
    };
    for scheme in [Scheme::Linear, Scheme::Constant] {
        let rows = run(punch(History::Step { value: 1.0 }, scheme), &ENERGIES);
        // <p, Kp> dx dy from the state at 0+.
        let norm = 2.0 * rows[0].get(Quantity::ElasticEnergy) / creep.instantaneous;
        for (n, row) in rows.iter().enumerate() {
            let t = 2.0 * n as f64 / 7.0;
            let fade = |time: f64| (-t / time).exp();
            let terms = creep.terms.iter().map(|c| (c.compliance, fade(c.retardation_time)));
            let stored = creep.instantaneous + terms.clone().map(|(c, e)| c * (1.0 - e).powi(2)).sum::<f64>();
            let lost = terms.map(|(c, e)| c * (1.0 - e * e)).sum::<f64>() + 2.0 * creep.fluidity * t;
            // A pressure that is held is both linear and constant: exact, to rounding and the solver's tolerance.
            let meets = |q, value: f64| (row.get(q) - 0.5 * norm * value).abs() < 1e-9 * norm;
            assert!(meets(Quantity::ElasticEnergy, stored), "{scheme:?} {n}");
            assert!(meets(Quantity::DissipatedEnergy, lost), "{scheme:?} {n}");
            assert!(meets(Quantity::ExternalWork, stored + lost), "{scheme:?} {n}");
        }
    }
    // A ramp of the load, P = t/2: each element lags as q = (t - l (1 - exp(-t/l)))/2.
    let rows = run(punch(History::Ramp { value: 1.0, duration: 2.0 }, Scheme::Linear), &ENERGIES);
    let last = rows.last().unwrap();
    let t: f64 = 2.0;
    let norm = 2.0
        * run(punch(History::Step { value: 1.0 }, Scheme::Linear), &ENERGIES)[0].get(Quantity::ElasticEnergy)
        / creep.instantaneous;
    let (mut stored, mut lost) = (creep.instantaneous, 2.0 * creep.fluidity * t / 3.0);
    for term in &creep.terms {
        let (c, l) = (term.compliance, term.retardation_time);
        let e = (-t / l).exp();
        stored += c * ((t - l * (1.0 - e)) / t).powi(2);
        // (2 C/l) int (p - q)^2 dt, p - q = (l/t) (1 - exp(-s/l))
        lost += 2.0 * c * l / (t * t) * (t - 2.0 * l * (1.0 - e) + 0.5 * l * (1.0 - e * e));
    }
    assert!((last.get(Quantity::ElasticEnergy) / (0.5 * norm * stored) - 1.0).abs() < 1e-9);
    assert!((last.get(Quantity::DissipatedEnergy) / (0.5 * norm * lost) - 1.0).abs() < 1e-9);
}

/// Work less what is stored and lost, over the work, at the end of a sphere's history.
fn imbalance(points: &[(f64, f64)], steps: usize, scheme: Scheme) -> f64 {
    let rows = run(
        Simulation {
            loading: load(History::Table { points: points.to_vec() }),
            times: TimeGrid::Uniform { end: points.last().unwrap().0, steps },
            scheme,
            ..sphere(32, 0.5)
        },
        &ENERGIES,
    );
    // Heat never goes back.
    let heat: Vec<f64> = rows.iter().map(|r| r.get(Quantity::DissipatedEnergy)).collect();
    assert!(heat.windows(2).all(|pair| pair[1] >= pair[0]));
    let last = rows.last().unwrap();
    let sum = last.get(Quantity::ElasticEnergy) + last.get(Quantity::DissipatedEnergy);
    (last.get(Quantity::ExternalWork) - sum).abs() / last.get(Quantity::ExternalWork)
}

#[test]
fn work_is_what_is_stored_and_lost_to_the_order_of_the_scheme() {
    // A sphere pressed at once and then more: the imbalance falls with the order of the scheme.
    let up = [(0.0, 0.005), (2.0, 0.02)];
    let [coarse, middle, fine] = [5, 10, 20].map(|steps| imbalance(&up, steps, Scheme::Linear));
    assert!(coarse < 0.02 && middle < coarse / 3.4 && fine < middle / 3.4, "{coarse} {middle} {fine}");
    let [coarse, fine] = [20, 40].map(|steps| imbalance(&up, steps, Scheme::Constant));
    assert!(fine < coarse / 1.8, "{coarse} {fine}");
    // Released on the way, by a jump and a ramp: there cells leave one ring after the other, and rates are unbounded
    // just after each break, so that the error falls less regularly.
    let down = [(0.0, 0.005), (1.0, 0.02), (1.0, 0.015), (2.0, 0.015), (3.0, 0.0)];
    assert!(imbalance(&down, 120, Scheme::Linear) < 3e-3);
    assert!(imbalance(&down, 480, Scheme::Linear) < 6e-4);
}

#[test]
fn a_reversible_cut_off_gives_its_work_back_and_a_lasting_one_does_not() {
    let cycle = |plasticity| {
        let rows = run(
            Simulation {
                creep: Creep::elastic(0.25),
                hardness: 0.15,
                plasticity,
                loading: load(History::Triangle { peak: 0.02, rise: 1.0, fall: 1.0 }),
                times: TimeGrid::Uniform { end: 2.0, steps: 160 },
                ..sphere(32, 0.5)
            },
            &ENERGIES,
        );
        let peak = rows.iter().map(|row| row.get(Quantity::ExternalWork)).fold(0.0, f64::max);
        let last = rows.last().unwrap();
        assert!(last.get(Quantity::ElasticEnergy).abs() < 1e-9 * peak);
        assert_eq!(last.get(Quantity::DissipatedEnergy), 0.0);
        (last.get(Quantity::ExternalWork) / peak, last.get(Quantity::FlatteningWork) / peak)
    };
    // The trapezoidal rule leaves 1e-3 of the work at 80 steps up and 80 down.
    let (work, flattening) = cycle(Plasticity::Cap);
    assert!(work.abs() < 2e-3 && flattening.abs() < 1e-9, "{work} {flattening}");
    let (work, flattening) = cycle(Plasticity::Accumulate);
    assert!(flattening > 0.1 && (work - flattening).abs() < 2e-3, "{work} {flattening}");
}

#[test]
fn spots_perimeter_and_histograms_agree_with_the_fields() {
    let grid = Grid::new([48, 40], [1.2, 1.0]).unwrap();
    let roughness = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.3),
        longest: 0.4,
        shortest: 0.1,
        roll_off: 0.4,
        seed: 3,
    };
    let gap = undeformed_gap(&grid, &[Part::SelfAffine(roughness)]).unwrap();
    // Nothing is flattened for good with "cap".
    let list: Vec<Quantity> = Quantity::at_rest().filter(|own| *own != Quantity::PlasticVolume).collect();
    let simulation = Simulation {
        boundary: Boundary::Periodic,
        creep: burgers(),
        hardness: 1.0,
        loading: load(History::Step { value: 0.05 }),
        times: TimeGrid::Uniform { end: 1.0, steps: 2 },
        quantities: Quantities { bins: 20, largest_gap: Some(0.02), ..Quantities::of(list) },
        ..Simulation::new(grid, gap)
    };
    let mut march = March::new(simulation).unwrap();
    let mut convolutions = 0;
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        let one = |quantity| step.quantity(quantity).unwrap()[0];
        let pressure = step.pressure();
        let spots = Spots::of(&grid, Boundary::Periodic, pressure, |p| *p > 0.0);
        assert!(spots.len() > 5);
        assert_eq!(one(Quantity::ContactSpots), spots.len() as f64);
        assert_eq!(one(Quantity::LargestSpot), spots.areas[0]);
        // A contact of a few per cent is made of islands in an open sea.
        assert_eq!([one(Quantity::ContactPercolation), one(Quantity::GapPercolation)], [0.0, 3.0]);
        assert!((one(Quantity::MeanSpot) * spots.len() as f64 / row.contact_area - 1.0).abs() < 1e-12);
        let classes = step.quantity(Quantity::SpotHistogram).unwrap();
        assert_eq!(classes.iter().sum::<f64>(), spots.len() as f64);
        // Square cells: the corrected area tells the number of edges.
        let share = (PI - 1.0 + 2f64.ln()) / 24.0;
        let edges = (row.contact_area - row.contact_area_corrected) / share / grid.cell_area();
        assert!((one(Quantity::ContactPerimeter) / (edges * grid.spacing()[0]) - 1.0).abs() < 1e-12);
        // Densities: all of the pressure lies below the hardness; of the gap a part lies beyond 0.02.
        let density = step.quantity(Quantity::PressureHistogram).unwrap();
        assert!((density.iter().sum::<f64>() * 1.0 / 20.0 - 1.0).abs() < 1e-12);
        let capped = pressure.iter().filter(|p| **p >= 0.95).count() as f64;
        let touching = pressure.iter().filter(|p| **p > 0.0).count() as f64;
        assert!((density[19] / 20.0 - capped / touching).abs() < 1e-12);
        let mut gap = Array2::zeros(grid.shape());
        step.gap_into(&mut gap);
        let open = gap.iter().zip(&pressure).filter(|(_, p)| **p == 0.0).map(|(gap, _)| *gap);
        let (inside, all) = open
            .fold((0.0, 0.0), |(inside, all), gap| (inside + f64::from(u8::from(gap <= 0.02)), all + 1.0));
        let density = step.quantity(Quantity::GapHistogram).unwrap();
        assert!((density.iter().sum::<f64>() * 0.02 / 20.0 - inside / all).abs() < 1e-12);
        let square = gap.iter().map(|gap| gap * gap).sum::<f64>() / gap.len() as f64;
        assert!((one(Quantity::RmsGap) / square.sqrt() - 1.0).abs() < 1e-12);
        convolutions += row.convolutions;
        assert_eq!(step.quantities().len(), step.columns().iter().map(|c| c.width()).sum::<usize>());
    }
    // The stiffness costs convolutions, which are counted.
    let plain = Simulation { quantities: Quantities::default(), ..march.simulation().clone() };
    let mut march = March::new(plain).unwrap();
    let mut without = 0;
    while let Some(step) = march.advance().unwrap() {
        without += step.row().convolutions;
    }
    assert!(convolutions > without + 3 * 4 && convolutions < without + 3 * 25, "{convolutions} {without}");
}

#[test]
fn a_resumed_march_takes_the_same_bits() {
    let simulation = Simulation {
        hardness: 0.15,
        plasticity: Plasticity::Accumulate,
        loading: load(History::Triangle { peak: 0.02, rise: 1.0, fall: 1.0 }),
        times: TimeGrid::Uniform { end: 3.0, steps: 12 },
        quantities: Quantities::of(Quantity::at_rest()),
        ..sphere(24, 0.5)
    };
    let mut march = March::new(simulation.clone()).unwrap();
    for _ in 0..6 {
        march.advance().unwrap();
    }
    let checkpoint = march.checkpoint().into_owned();
    let mut resumed = March::resume(simulation.clone(), &checkpoint).unwrap();
    let mut flattening = [Array2::zeros((24, 24)), Array2::zeros((24, 24))];
    while let Some(step) = march.advance().unwrap() {
        step.flattening_into(&mut flattening[0]);
        let bits: Vec<u64> = step.quantities().iter().map(|q| q.to_bits()).collect();
        let again = resumed.advance().unwrap().unwrap();
        again.flattening_into(&mut flattening[1]);
        assert_eq!(bits, again.quantities().iter().map(|q| q.to_bits()).collect::<Vec<_>>());
        assert_eq!(flattening[0], flattening[1]);
        assert!(bits.iter().all(|bits| !f64::from_bits(*bits).is_nan()));
    }
    // Another list of quantities has another checkpoint.
    let other = Simulation { quantities: Quantities::default(), ..simulation };
    assert!(March::resume(other, &checkpoint).is_err());
}

#[test]
fn what_cannot_be_taken_is_refused_with_the_reason() {
    let said = |change: &dyn Fn(&mut Simulation)| {
        let mut simulation = sphere(8, 0.5);
        change(&mut simulation);
        simulation.validate().unwrap_err().to_string()
    };
    let words = said(&|s| {
        s.scheme = Scheme::Direct;
        s.quantities = Quantities::of([Quantity::RmsGap, Quantity::ElasticEnergy]);
    });
    assert!(words.contains("elastic_energy") && words.contains("direct"), "{words}");
    let words = said(&|s| s.quantities = Quantities::of([Quantity::PressureHistogram]));
    assert!(words.contains("largest pressure"), "{words}");
    let words = said(&|s| s.quantities = Quantities { bins: 0, ..Quantities::default() });
    assert!(words.contains("bins"), "{words}");
    let words = said(&|s| s.plasticity = Plasticity::Accumulate);
    assert!(words.contains("hardness"), "{words}");
    // A body without instantaneous compliance is infinitely stiff against what is sudden.
    let mut simulation = sphere(16, 0.5);
    simulation.creep = Creep { instantaneous: 0.0, ..burgers() };
    simulation.loading = load(History::Ramp { value: 0.01, duration: 1.0 });
    let rows = run(simulation, &[Quantity::ContactStiffness]);
    assert_eq!(rows[0].get(Quantity::ContactStiffness), 0.0);
    assert!(rows[1].area > 0.0 && rows[1].get(Quantity::ContactStiffness) == f64::INFINITY);
}
