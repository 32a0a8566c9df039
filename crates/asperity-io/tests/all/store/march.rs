//! A march that was stopped and resumed by way of its result ends with the bits of one that was not.

use asperity::Drive;
use asperity::drive::March;
use asperity::material::{Creep, CreepTerm};
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::Simulation;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::time::TimeGrid;
use asperity::{Control, Grid, History, Loading, Plasticity};
use asperity_io::store::{At, Field, FieldKind, Outcome, Reader, Status, Writer};
use ndarray::Array2;

use super::{Case, bits, place, row_bits};

const FIELDS: [FieldKind; FieldKind::ALL.len()] = FieldKind::ALL;

/// A rough sphere on a Zener solid under a load that jumps, cut off by a hardness.
fn simulation() -> Simulation {
    let grid = Grid::new([32, 24], [1e-3, 0.75e-3]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
    let roughness = Part::SelfAffine(SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsHeight(2e-7),
        longest: 5e-4,
        shortest: 1e-4,
        roll_off: 5e-4,
        seed: 1,
    });
    let terms = vec![CreepTerm { compliance: 1e-8, retardation_time: 1.0 }];
    let points = vec![(0.0, 0.2), (1.0, 0.4), (1.0, 0.1), (2.0, 0.3)];
    Simulation {
        creep: Creep { instantaneous: 1e-8, terms, fluidity: 1e-9 },
        hardness: 2e6,
        plasticity: Plasticity::Accumulate,
        quantities: Quantities::of(Quantity::at_rest()),
        loading: Loading { control: Control::Load, history: History::Table { points } }.into(),
        times: TimeGrid::Uniform { end: 3.0, steps: 12 },
        ..Simulation::new(grid, undeformed_gap(&grid, &[sphere, roughness]).unwrap())
    }
}

/// Advances and stores up to row `end`; the fields of every third row.
fn go(march: &mut March, writer: &mut Writer, end: usize) {
    let shape = march.simulation().grid.shape();
    let mut contact = Array2::zeros(shape);
    while writer.len() < end {
        let Some(step) = march.advance().unwrap() else { break };
        step.contact_into(&mut contact);
        let real = FIELDS.into_iter().filter(|kind| *kind != FieldKind::Contact).map(|kind| {
            let mut field = Array2::zeros(shape);
            kind.of_step(&step, &mut field);
            (kind, field)
        });
        let real: Vec<_> = real.collect();
        let fields = real.iter().map(|(kind, field)| Field::Real(*kind, field.view()));
        let fields: Vec<_> = fields.chain([Field::Contact(contact.view())]).collect();
        let kept = if step.index() % 3 == 0 { &fields[..] } else { &[] };
        writer.append_with(&step.row(), step.quantities(), kept).unwrap();
    }
}

#[test]
fn a_resumed_march_ends_with_the_same_bits() {
    let mut header = Case::new([1, 1], &FIELDS).header;
    header.grid = simulation().grid;
    header.quantities = simulation().columns().unwrap();
    let (_directory, whole) = place();
    let mut march = March::new(simulation()).unwrap();
    let mut writer = Writer::create(&whole, &header, march.simulation().gap.view(), false).unwrap();
    go(&mut march, &mut writer, usize::MAX);
    writer.finish(&Outcome::new(Status::Complete)).unwrap();

    let (_directory, parts) = place();
    let mut march = March::new(simulation()).unwrap();
    let mut writer = Writer::create(&parts, &header, march.simulation().gap.view(), false).unwrap();
    go(&mut march, &mut writer, 5);
    writer.checkpoint(&march.checkpoint()).unwrap();
    go(&mut march, &mut writer, 8);
    drop((march, writer));

    let simulation = simulation();
    let (mut writer, checkpoint) = Writer::resume(&parts, &header, simulation.gap.view()).unwrap();
    let mut march = March::resume(simulation, &checkpoint.unwrap()).unwrap();
    go(&mut march, &mut writer, usize::MAX);
    writer.finish(&Outcome::new(Status::Complete)).unwrap();

    let (whole, parts) = (Reader::open(&whole).unwrap(), Reader::open(&parts).unwrap());
    assert_eq!(parts.len(), whole.len());
    assert!(parts.len() > 13); // the jump is a row of its own
    for (one, other) in parts.rows().unwrap().iter().zip(whole.rows().unwrap()) {
        assert_eq!(row_bits(one), row_bits(&other));
    }
    for series in whole.scalars() {
        let [one, other] = [&parts, &whole].map(|r| r.series(series.name).unwrap());
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&one), bits(&other), "{}", series.name);
    }
    for quantity in Quantity::ALL.into_iter().filter(|quantity| quantity.is_histogram()) {
        let [(edges, one), (_, other)] = [&parts, &whole].map(|r| r.histogram(quantity).unwrap());
        assert_eq!((one.nrows(), one.ncols()), (whole.len(), edges.len() - 1));
        assert_eq!(bits(&one), bits(&other), "{quantity}");
        assert!(one.sum() > 0.0, "{quantity}");
    }
    assert_eq!(parts.field_steps(), whole.field_steps());
    for index in 0..whole.field_steps().len() {
        for kind in FIELDS {
            let [one, other] = [&parts, &whole].map(|r| bits(&r.field(kind, At::Index(index)).unwrap()));
            assert_eq!(one, other, "{kind} {index}");
        }
    }
}
