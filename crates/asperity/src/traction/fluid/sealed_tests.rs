//! Sealed pockets against closed forms, and the conservation of what is in them.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use ndarray::Array2;

use super::beside::Beside;
use super::tests::{liquid, on_rough, wave};
use super::{Action, FluidPressure, Pockets};
use crate::drive::{Drive, March};
use crate::leakage::{CellKind, Direction, Gas, Opening, Passages, Rarefaction, Sides};
use crate::load::{Control, History, Loading};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::Step;
use crate::time::TimeGrid;

const GAS: Option<(Gas, Rarefaction)> =
    Some((Gas { viscosity: 1.0, molar_mass: 0.03, temperature: 300.0 }, Rarefaction::Continuum));

/// A liquid that is at this pressure everywhere before pockets are sealed.
fn sealed(bulk_modulus: f64, pressure: f64) -> FluidPressure {
    FluidPressure {
        action: Action::Gaps(Pockets::Sealed),
        bulk_modulus: Some(bulk_modulus),
        direction: Direction::Y,
        reference: pressure,
        ..liquid(pressure, pressure)
    }
}

/// A valley between crests that close it towards both reservoirs, under mean pressures or approaches at t = 0, 1, 2 ...
fn valley(control: Control, course: &[f64], fluid: FluidPressure) -> Simulation {
    let points: Vec<(f64, f64)> = (0..course.len()).map(|n| (n as f64, course[n])).collect();
    Simulation {
        loading: Loading { control, history: History::Table { points } }.into(),
        times: TimeGrid::Uniform { end: course.len() as f64 - 1.0, steps: course.len() - 1 },
        ..wave([4, 512], 1.0, 1.0, fluid)
    }
}

/// Gap of the valley over that without load, where the fluid carries all but m of the mean pressure.
fn room(m: f64) -> f64 {
    1.0 - m + m * m.ln()
}

/// Pressure of the pocket above the reference, fraction of contact, mean gap over that without load, vapour.
fn last(simulation: Simulation) -> [f64; 4] {
    let reference = simulation.traction.as_ref().unwrap().as_fluid().unwrap().reference;
    let mut march = March::new(simulation).unwrap();
    while march.advance().unwrap().is_some() {}
    let step = march.last().unwrap();
    let row = step.row();
    let of = |quantity| step.quantity(quantity).unwrap()[0];
    // No pass more than extrapolation needs for one unknown, and none held.
    assert!(of(Quantity::OuterIterations) < 40.0 && of(Quantity::LatchedCells) == 0.0);
    let pressure = of(Quantity::PocketPressureMax) - reference;
    [pressure, row.contact_fraction, PI * row.mean_gap, PI * of(Quantity::PocketVapour)]
}

#[test]
fn a_liquid_in_a_valley_is_pressed_together() {
    // Mean pressure at which the valley is sealed, bulk modulus, mean pressure, and pressure of the liquid, fraction of contact, mean gap over
    // that without load: V = D (1 - m + m ln m) depends on m = p0 - p only.
    for [sealed_at, modulus, mean, pressure, fraction, gap] in [
        [0.05, 0.5, 0.18899331092375707, 0.08899331092375708, 0.20483276469913345, 0.6697414907005954],
        [0.05, 0.5, 1.6734337583868018, 1.0734337583868019, 0.564094216848975, 0.09350462574040559],
        [0.05, 5.0, 0.9899331092375707, 0.8899331092375707, 0.20483276469913345, 0.6697414907005954],
        [0.05, 5.0, 11.334337583868018, 10.734337583868019, 0.564094216848975, 0.09350462574040559],
        [0.2, 1.0, 0.6444118442588828, 0.3444118442588828, 0.36901011956554536, 0.3388081587022192],
        [0.2, 50.0, 17.52059221294414, 17.22059221294414, 0.36901011956554536, 0.3388081587022192],
        [0.2, 50.0, 82.19174898459568, 81.59174898459568, 0.564094216848975, 0.09350462574040559],
        // All but incompressible: the contact stays as it was.
        [0.05, 1e9, 0.3, 0.25, 0.14356629312870627, 0.8002133863223005],
        [0.5, 1e9, 0.6, 0.1, 0.5, 0.1534264097200273],
    ] {
        let got = last(valley(Control::Pressure, &[sealed_at, mean], sealed(modulus, 0.0)));
        // The loop ends at 1e-5 of the forces, of which the fluid has a third at least in all rows; cells at the edges take 1e-5 of the gap.
        assert!((got[0] / pressure - 1.0).abs() < 5e-5, "{got:?} {pressure}");
        assert!((got[1] - fraction).abs() < 2.0 / 512.0, "{got:?} {fraction}");
        assert!((got[2] / gap - 1.0).abs() < 5e-5 && got[3] == 0.0, "{got:?} {gap}");
    }
}

#[test]
fn a_gas_in_a_valley_is_compressed() {
    // Absolute pressure at first, m, and the pressure above it.
    for [absolute, m, pressure] in
        [[0.01, 0.3, 0.013618480422297428], [0.1, 0.3, 0.1361848042229743], [0.1, 0.6, 0.7558008547554766]]
    {
        let fluid = FluidPressure { gas: GAS, bulk_modulus: None, ..sealed(1.0, absolute) };
        let got = last(valley(Control::Pressure, &[0.05, m + pressure], fluid));
        assert!((got[0] / pressure - 1.0).abs() < 5e-5, "{got:?} {pressure}");
    }
}

#[test]
fn a_pocket_that_a_pass_closes_is_pressed_open_again() {
    // The approach fixes the mean gap, and that the pressure; between the rows it closes more than the valley has left under its old pressure.
    for m in [0.3, 0.6, 0.9] {
        let approaches = [0.05, m].map(|m| (1.0 - room(m)) / PI);
        let got = last(valley(Control::Approach, &approaches, sealed(0.5, 0.0)));
        let pressure = 0.5 * (room(0.05) / room(m)).ln();
        // The volume of the valley is known to 1e-5 of the gap without load, and with it p to B over what is left of it: 0.005 at m = 0.9.
        assert!((got[0] - pressure).abs() < 0.5 * 2e-5 / room(m) + 1e-5, "{got:?} {pressure}");
    }
}

#[test]
fn a_liquid_without_stiffness_carries_nothing() {
    let soft = last(valley(Control::Pressure, &[0.05, 0.6], sealed(1e-9, 0.0)));
    let drained =
        FluidPressure { action: Action::Gaps(Pockets::Drained), bulk_modulus: None, ..sealed(1.0, 0.0) };
    let drained = last(valley(Control::Pressure, &[0.05, 0.6], drained));
    assert!(soft[0] < 1e-7 && (soft[2] / drained[2] - 1.0).abs() < 1e-6, "{soft:?} {drained:?}");
}

#[test]
fn a_liquid_with_more_room_than_it_fills_leaves_vapour_and_fills_it_again() {
    let fluid = || sealed(50.0, 0.1);
    // Without pressure it pulls by the 0.1 of the reference: m = 0.15 + 0.1.
    let got = last(valley(Control::Pressure, &[0.3, 0.15], fluid()));
    let vapour = room(0.25) - room(0.3) * libm::exp(0.1 / 50.0);
    assert!((got[0] + 0.1).abs() < 1e-12 && (got[2] / room(0.25) - 1.0).abs() < 5e-5, "{got:?}");
    // The volumes are known to 1e-5 of the gap without load.
    assert!((got[3] - vapour).abs() < 5e-5, "{got:?} {vapour}");
    let again = last(valley(Control::Pressure, &[0.3, 0.15, 0.3], fluid()));
    assert!(again[0].abs() < 5e-5 && again[3] == 0.0, "{again:?}");
}

/// The cells of a row: number of its pocket, whether a reservoir reaches it, pressure, mass per area.
struct Cells {
    pockets: Vec<Option<usize>>,
    reached: Vec<bool>,
    pressures: Vec<f64>,
    masses: Vec<f64>,
}

impl Cells {
    fn of(step: &Step<'_>, beside: &Beside, density: impl Fn(f64) -> f64) -> Cells {
        let (grid, law) = (step.simulation().grid, step.simulation().traction.as_ref().unwrap());
        let law = law.as_fluid().unwrap();
        let (mut gap, mut contact) = (Array2::zeros(grid.shape()), Array2::zeros(grid.shape()));
        step.gap_into(&mut gap);
        step.contact_into(&mut contact);
        let opening =
            Opening::new(&grid, gap.view(), Some(contact.view()), law.direction, Sides::Periodic, 0.0)
                .unwrap();
        let kinds = Passages::of(&opening).map(&opening);
        let is_pocket: Vec<bool> = kinds.iter().map(|kind| *kind == CellKind::Pocket).collect();
        let mut forest = beside.joined(&is_pocket);
        let cells = 0..is_pocket.len();
        let pressures: Vec<f64> = step.pressure().iter().copied().collect();
        let masses = gap.iter().zip(&pressures).map(|(g, p)| g * density(*p)).collect();
        Cells {
            pockets: cells.map(|cell| is_pocket[cell].then(|| forest.root(cell))).collect(),
            reached: kinds.iter().map(|kind| !matches!(kind, CellKind::Pocket | CellKind::Closed)).collect(),
            pressures,
            masses,
        }
    }

    /// The masses before and now of pockets that a reservoir reached in neither row and that are full, of all together; the sum of their
    /// differences; and how many of them have become one, or were one.
    fn compare(&self, before: &Cells) -> ([f64; 2], usize) {
        // Pockets of both rows that share a cell belong together.
        let mut group: BTreeMap<(bool, usize), usize> = BTreeMap::new();
        let mut members: Vec<Vec<(bool, usize)>> = vec![];
        for cell in 0..self.pockets.len() {
            let keys = [before.pockets[cell].map(|n| (false, n)), self.pockets[cell].map(|n| (true, n))];
            let mut here: Vec<usize> = vec![];
            for key in keys.into_iter().flatten() {
                here.push(*group.entry(key).or_insert_with(|| {
                    members.push(vec![key]);
                    members.len() - 1
                }));
            }
            if let [a, b] = here[..]
                && a != b
            {
                let moved = std::mem::take(&mut members[b]);
                moved.iter().for_each(|key| *group.entry(*key).or_default() = a);
                members[a].extend(moved);
            }
        }
        let mut spoiled = BTreeSet::new();
        let mut masses = vec![[0.0; 2]; members.len()];
        for cell in 0..self.pockets.len() {
            for (own, row, other) in [(false, before, self), (true, self, before)] {
                let Some(number) = row.pockets[cell].map(|n| group[&(own, n)]) else { continue };
                masses[number][usize::from(own)] += row.masses[cell];
                if other.reached[cell] || row.pressures[cell] <= 0.0 {
                    spoiled.insert(number);
                }
            }
        }
        let counted = (0..members.len()).filter(|n| members[*n].len() > 1 && !spoiled.contains(n));
        let (mut sums, mut joined) = ([0.0; 2], 0);
        for number in counted {
            let [then, now] = masses[number];
            sums[0] += then;
            sums[1] += (now - then).abs();
            joined += usize::from(members[number].len() > 2);
        }
        (sums, joined)
    }
}

/// A rough contact under a mean pressure that rises and falls.
fn rough_up_and_down(bulk_modulus: f64) -> Simulation {
    let history = History::Table { points: vec![(0.0, 1.0), (1.0, 9.0), (1.75, 3.0)] };
    let fluid = FluidPressure {
        inlet: History::Step { value: 0.2 },
        direction: Direction::X,
        ..sealed(bulk_modulus, 0.0)
    };
    Simulation {
        loading: Loading { control: Control::Pressure, history }.into(),
        times: TimeGrid::Uniform { end: 1.75, steps: 28 },
        ..on_rough(48, 1.0, Some(fluid))
    }
}

/// Runs a simulation whose mean pressure rises and falls by equal steps; the most pockets, how many have become one or were one, and the largest
/// pressure in a pocket of each row.
fn conserving(simulation: Simulation, modulus: f64) -> (usize, usize, Vec<f64>) {
    let law = simulation.traction.as_ref().unwrap().as_fluid().unwrap().clone();
    let mut march = March::new(simulation).unwrap();
    let beside = Beside::new(&march.simulation().grid, law.direction, true);
    let (mut before, mut joined, mut most, mut largest) = (None, 0, 0, vec![]);
    while let Some(step) = march.advance().unwrap() {
        let cells = Cells::of(&step, &beside, |p| libm::exp(p / modulus));
        if let Some(before) = &before {
            let ([mass, change], more) = cells.compare(before);
            // The solver takes 1e-4 of the volume of all pockets, of which these are a part.
            assert!(change <= 1e-3 * mass, "{modulus} {change:e} {mass:e} at {:?}", step.instant());
            joined += more;
        }
        most = most.max(cells.pockets.iter().flatten().collect::<BTreeSet<_>>().len());
        largest.push(step.quantity(Quantity::PocketPressureMax).unwrap()[0]);
        before = Some(cells);
    }
    (most, joined, largest)
}

#[test]
fn what_is_in_many_pockets_stays_in_them() {
    for modulus in [3.0, 1e4] {
        let (pockets, _, largest) = conserving(rough_up_and_down(modulus), modulus);
        assert!(pockets > 10, "{pockets}");
        // Nothing is lost: the same mean pressure has the same pressures on the way back. The loop ends at 1e-5 of the forces.
        for n in 8..16 {
            assert!((largest[n] - largest[32 - n]).abs() < 0.01, "{modulus} {n} {largest:?}");
        }
    }
}

#[test]
fn a_pocket_that_parts_and_becomes_one_again_holds_what_it_held() {
    // A bump in the valley, not in its middle, parts it under load.
    let course: Vec<f64> = (0..=16).map(|n: i32| 0.1 + 0.2 * f64::from(8 - (n - 8).abs())).collect();
    let base = valley(Control::Pressure, &course, sealed(0.3, 0.0));
    let bump = |y: f64| 0.35 * libm::exp(-((y - 0.45) / 0.05).powi(2));
    let gap = Array2::from_shape_fn(base.gap.dim(), |(i, j)| base.gap[[i, j]] - bump(base.grid.y(j)));
    let (pockets, joined, largest) = conserving(Simulation { gap, ..base }, 0.3);
    assert_eq!((pockets, joined), (2, 2));
    for n in 0..8 {
        assert!((largest[n] - largest[16 - n]).abs() < 1e-3, "{largest:?}");
    }
}

#[test]
fn sealed_pockets_go_on_from_a_checkpoint_with_the_same_bits() {
    let mut whole = March::new(rough_up_and_down(100.0)).unwrap();
    for _ in 0..18 {
        whole.advance().unwrap();
    }
    let checkpoint = whole.checkpoint().into_owned();
    let mut resumed = March::resume(rough_up_and_down(100.0), &checkpoint).unwrap();
    while whole.advance().unwrap().is_some() {
        resumed.advance().unwrap();
        let (a, b) = (whole.last().unwrap(), resumed.last().unwrap());
        assert_eq!((a.pressure(), a.quantities()), (b.pressure(), b.quantities()));
    }
}
