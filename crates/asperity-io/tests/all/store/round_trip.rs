//! What is written is what is read, bit by bit.

use asperity::Coordinate;
use asperity_io::store::{At, Field, FieldKind, Outcome, Reader, Row, SCALARS, Status, StoreError, Writer};
use ndarray::Array2;

use super::{Case, bits, place, row_bits};
use crate::common::zarr::Array;

/// Sides that are a multiple of no chunk, one chunk, one cell, and long and thin.
const GRIDS: [[usize; 2]; 5] = [[300, 257], [64, 64], [1, 1], [3, 700], [513, 2]];

#[test]
fn rows_and_fields_keep_their_bits_on_any_grid() {
    for cells in GRIDS {
        let case = Case::new(cells, &FieldKind::ALL);
        let (_directory, path) = place();
        let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
        case.run(&mut writer, 0, 7);
        let work = writer.finish(&Outcome::new(Status::Complete)).unwrap();
        assert_eq!((work.iterations, work.convolutions), (21, 49)); // sums of n and 2n+1, n < 7

        let reader = Reader::open(&path).unwrap();
        assert_eq!(reader.header(), &case.header);
        assert_eq!(reader.work(), &work);
        assert_eq!(reader.status(), Status::Complete);
        let rows = reader.rows().unwrap();
        assert_eq!(rows.len(), 7);
        for (step, row) in rows.iter().enumerate() {
            assert_eq!(row_bits(row), row_bits(&case.row(step)));
        }
        assert_eq!(reader.field_steps(), [0, 2, 4, 6]);
        assert_eq!(bits(&reader.initial_gap().unwrap()), bits(&case.gap));
        for (index, step) in [0, 2, 4, 6].into_iter().enumerate() {
            let at = At::Index(index);
            let field = |kind| bits(&reader.field(kind, at).unwrap());
            assert_eq!(field(FieldKind::Pressure), bits(&case.pressure(step)));
            assert_eq!(field(FieldKind::Gap), bits(&case.gap(step)));
            assert_eq!(field(FieldKind::Displacement), bits(&(case.gap(step) * 0.5)));
            assert_eq!(reader.contact(at).unwrap(), case.contact(step));
            assert_eq!(reader.field(FieldKind::Contact, at).unwrap(), case.contact(step).mapv(f64::from));
        }
    }
}

#[test]
fn series_run_over_the_end_of_a_chunk() {
    let case = Case::new([2, 2], &[]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    let steps = 4096 + 3;
    for step in 0..steps {
        writer
            .append(
                &Row { coordinate: Coordinate::Time(step as f64), iterations: step, ..Row::default() },
                &[],
            )
            .unwrap();
    }
    drop(writer);
    let reader = Reader::open(&path).unwrap();
    let times = reader.series("time").unwrap();
    assert_eq!(times, (0..steps).map(|n| n as f64).collect::<Vec<_>>());
    assert_eq!(reader.series("iterations").unwrap(), times);
    assert_eq!(reader.rows().unwrap()[4097].iterations, 4097);
}

#[test]
fn every_array_is_read_by_its_own_document() {
    let case = Case::new([300, 257], &FieldKind::ALL);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 3);
    writer.finish(&Outcome::new(Status::Complete)).unwrap();

    let read = |name: &str| Array::read(&path.join(name)).unwrap();
    for (n, scalar) in SCALARS.iter().enumerate() {
        let array = read(scalar.name);
        assert_eq!(array.shape, [3]);
        assert_eq!(array.document["attributes"]["units"], scalar.units);
        assert_eq!(scalar.name == "time", n == 0);
    }
    assert_eq!(read("load").values, (0..3).map(|step| case.row(step).load).collect::<Vec<_>>());
    let cells = 300 * 257;
    let pressure = read("pressure");
    assert_eq!(pressure.shape, [2, 300, 257]);
    assert_eq!(pressure.values[cells..], case.pressure(2).into_raw_vec_and_offset().0);
    let first = case.contact(0).mapv(f64::from).into_raw_vec_and_offset().0;
    assert_eq!(read("contact").values[..cells], first);
    assert_eq!(read("x").values[299], case.header.grid.x(299));
}

#[test]
fn maps_of_no_pressure_take_little_room() {
    let case = Case::new([256, 256], &[FieldKind::Pressure]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    writer
        .append(&case.row(0), &[Field::Real(FieldKind::Pressure, Array2::zeros((256, 256)).view())])
        .unwrap();
    let size = std::fs::metadata(path.join("pressure/c/0/0/0")).unwrap().len();
    // 512 KiB of one value: deflate reaches about 1000 : 1 (a match of 258 bytes in 2 bits).
    assert!(size < 8192, "{size} bytes");
}

#[test]
fn an_instant_is_found_by_number_and_by_time() {
    let case = Case::new([4, 3], &[FieldKind::Pressure]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    assert!(matches!(Reader::open(&path).unwrap().index(At::Last), Err(StoreError::Missing { .. })));
    for step in 0..7 {
        case.append(&mut writer, step, true).unwrap();
    }
    let reader = Reader::open(&path).unwrap();
    // Steps 4 and 5 have the same time; the state after the jump is meant.
    assert_eq!(reader.field_times()[4], reader.field_times()[5]);
    assert_eq!(reader.index(At::Time(4.0 / 3.0)).unwrap(), 5);
    assert_eq!(reader.index(At::Time(0.1)).unwrap(), 0);
    assert_eq!(reader.index(At::Time(5.0 / 3.0)).unwrap(), 6);
    assert_eq!(reader.index(At::Time(0.0)).unwrap(), 0);
    assert_eq!(reader.index(At::Last).unwrap(), 6);
    for at in [At::Index(7), At::Time(f64::NAN), At::Time(f64::INFINITY), At::Time(1.7), At::Time(-0.1)] {
        let message = reader.index(at).unwrap_err().to_string();
        assert!(message.contains("fields at 7 times from 0 s to"), "{message}");
    }
}

#[test]
fn what_is_not_kept_is_said_with_what_is() {
    let case = Case::new([4, 3], &[FieldKind::Gap, FieldKind::Contact]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 1);
    let reader = Reader::open(&path).unwrap();
    let message = reader.field(FieldKind::Pressure, At::Last).unwrap_err().to_string();
    assert!(message.contains("holds no field `pressure`; it holds the fields gap, contact"), "{message}");
    let message = reader.series("laod").unwrap_err().to_string();
    assert!(message.contains("no series `laod`") && message.contains("approach"), "{message}");
}

#[test]
fn what_does_not_fit_the_result_is_refused_and_leaves_it_as_it_was() {
    let case = Case::new([4, 3], &[FieldKind::Gap, FieldKind::Pressure]);
    let (_directory, path) = place();
    let wrong = Array2::zeros((3, 4));
    assert!(matches!(
        Writer::create(&path, &case.header, wrong.view(), false),
        Err(StoreError::Input { .. })
    ));
    assert!(!path.exists());
    let mut twice = case.header.clone();
    twice.fields.push(FieldKind::Gap);
    assert!(matches!(Writer::create(&path, &twice, case.gap.view(), false), Err(StoreError::Input { .. })));

    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 4);
    let (gap, contact) = (case.gap(0), case.contact(0));
    let row = case.row(6);
    for fields in [
        vec![Field::Real(FieldKind::Gap, gap.view())],
        vec![Field::Real(FieldKind::Gap, gap.view()), Field::Real(FieldKind::Gap, gap.view())],
        vec![Field::Real(FieldKind::Gap, gap.view()), Field::Contact(contact.view())],
        vec![Field::Real(FieldKind::Gap, gap.view()), Field::Real(FieldKind::Pressure, wrong.view())],
    ] {
        assert!(matches!(writer.append(&row, &fields), Err(StoreError::Input { .. })));
    }
    for time in [0.5, f64::NAN] {
        assert!(matches!(
            writer.append(&Row { coordinate: Coordinate::Time(time), ..row }, &[]),
            Err(StoreError::Input { .. })
        ));
    }
    assert!(matches!(writer.checkpoint(&case.checkpoint(3)), Err(StoreError::Input { .. })));
    assert_eq!(Reader::open(&path).unwrap().len(), 4);
    case.run(&mut writer, 4, 5);
    assert_eq!(Reader::open(&path).unwrap().len(), 5);
}

#[test]
fn an_end_before_the_end_says_why() {
    let case = Case::new([4, 3], &[]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 3);
    let outcome = Outcome {
        status: Status::Failed,
        message: Some("not converged at t = 1 s".into()),
        peak_memory_bytes: Some(1 << 40),
        threads: Some(2),
    };
    writer.finish(&outcome).unwrap();
    let reader = Reader::open(&path).unwrap();
    assert_eq!(reader.status(), Status::Failed);
    assert_eq!(reader.work().message.as_deref(), Some("not converged at t = 1 s"));
    assert_eq!((reader.work().peak_memory_bytes, reader.work().threads), (Some(1 << 40), Some(2)));
}
