//! A run goes on where its checkpoint was taken, or says why it cannot.

use asperity_io::store::{At, FieldKind, Outcome, Reader, Status, StoreError, Writer};

use super::{Case, bits, place, row_bits};

const FIELDS: [FieldKind; 2] = [FieldKind::Pressure, FieldKind::Gap];

#[test]
fn a_resumed_run_ends_as_one_that_never_stopped() {
    resumed(&Case::new([40, 30], &FIELDS));
}

#[test]
fn a_line_contact_is_stored_and_resumed_likewise() {
    // Two chunks of a field.
    resumed(&Case::line(70_000, &FIELDS));
}

#[test]
fn only_a_result_of_a_case_file_can_be_continued() {
    let state = |case: &Case| {
        let (_directory, path) = place();
        let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
        case.run(&mut writer, 0, 2);
        writer.finish(&Outcome::new(Status::Interrupted)).unwrap();
        Reader::open(&path).unwrap().state()
    };
    let mut case = Case::new([4, 3], &FIELDS);
    assert!(state(&case).contains("asperity run --resume"));
    case.header.case_text.clear();
    assert!(!state(&case).contains("--resume"));
}

fn resumed(case: &Case) {
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 5);
    writer.checkpoint(&case.checkpoint(5)).unwrap();
    case.run(&mut writer, 5, 9);
    writer.finish(&Outcome::new(Status::Interrupted)).unwrap();

    let (mut writer, state) = Writer::resume(&path, &case.header, case.gap.view()).unwrap();
    let state = state.unwrap();
    let expected = case.checkpoint(5);
    assert_eq!(state.step, 5);
    let bits_of = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(state.numbers.len(), expected.numbers.len());
    for (numbers, expected) in state.numbers.iter().zip(&expected.numbers) {
        assert_eq!((&numbers.0, bits_of(&numbers.1)), (&expected.0, bits_of(&expected.1)));
    }
    for (field, expected) in state.fields.iter().zip(&expected.fields) {
        assert_eq!((&field.0, bits(&field.1.to_owned())), (&expected.0, bits(&expected.1.to_owned())));
    }
    // Rows 5 to 8 and the fields of rows 6 and 8 are taken back.
    let reader = Reader::open(&path).unwrap();
    assert_eq!((reader.len(), reader.field_steps().len(), reader.status()), (5, 3, Status::Running));

    case.run(&mut writer, 5, 12);
    let work = writer.finish(&Outcome::new(Status::Complete)).unwrap();
    // The steps done twice count once: sum of n, n < 12.
    assert_eq!(work.iterations, 66);
    let reader = Reader::open(&path).unwrap();
    assert_eq!(reader.len(), 12);
    for (step, row) in reader.rows().unwrap().iter().enumerate() {
        assert_eq!(row_bits(row), row_bits(&case.row(step)));
    }
    assert_eq!(reader.field_steps(), [0, 2, 4, 6, 8, 10]);
    for (index, step) in reader.field_steps().iter().enumerate() {
        let pressure = reader.field(FieldKind::Pressure, At::Index(index)).unwrap();
        assert_eq!(bits(&pressure), bits(&case.pressure(*step)));
    }
    assert!(!path.join("checkpoint").exists());
    let again = Writer::resume(&path, &case.header, case.gap.view());
    assert!(matches!(again, Err(StoreError::Complete { rows: 12, .. })));
}

#[test]
fn a_failed_checkpoint_keeps_the_one_before() {
    let case = Case::new([8, 8], &[]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 2);
    assert!(writer.checkpoint_due());
    writer.checkpoint(&case.checkpoint(2)).unwrap();
    case.run(&mut writer, 2, 4);
    // The file that the next one is first written to cannot be made.
    std::fs::create_dir(path.join("checkpoint/state.bin.partial")).unwrap();
    assert!(matches!(writer.checkpoint(&case.checkpoint(4)), Err(StoreError::Io { .. })));
    drop(writer);
    let (writer, state) = Writer::resume(&path, &case.header, case.gap.view()).unwrap();
    assert_eq!((state.unwrap().step, writer.len()), (2, 2));
}

#[test]
fn another_case_is_refused_with_what_differs() {
    let case = Case::new([40, 30], &FIELDS);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 2);
    writer.checkpoint(&case.checkpoint(2)).unwrap();
    drop(writer);
    let said = |change: &dyn Fn(&mut Case)| {
        let mut other = Case::new([40, 30], &FIELDS);
        change(&mut other);
        match Writer::resume(&path, &other.header, other.gap.view()) {
            Err(error @ StoreError::Mismatch { .. }) => error.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let message = said(&|case| case.header.case_text = case.header.case_text.replace("500 s", "600 s"));
    assert!(message.contains("line 5 of the case is `end = \"500 s\"`, now `end = \"600 s\"`"), "{message}");
    let message = said(&|case| case.header.case_text.push_str("scheme = \"direct\"\n"));
    assert!(message.contains("line 6 of the case is missing, now `scheme"), "{message}");
    let message = said(&|case| {
        case.header.setup["creep"]["instantaneous"] = serde_json::json!(4e-10);
    });
    assert!(message.contains("`creep` is {\"instantaneous\":1.33"), "{message}");
    let message = said(&|case| case.gap[[2, 7]] = 0.5);
    assert!(message.contains("gap at cell (2, 7)") && message.contains("now 5e-1 m"), "{message}");
    let message = said(&|case| *case = Case::new([30, 40], &FIELDS));
    assert!(message.contains("the grid is 40 x 30 cells"), "{message}");
    let message = said(&|case| case.header.fields = vec![FieldKind::Gap]);
    assert!(message.contains("list of fields is pressure, gap, now gap"), "{message}");
    // Nothing was taken back by the attempts.
    assert_eq!(Reader::open(&path).unwrap().len(), 2);
}

#[test]
fn versions_that_had_a_part_are_named() {
    let case = Case::new([4, 3], &[]);
    let (_directory, path) = place();
    drop(Writer::create(&path, &case.header, case.gap.view(), false).unwrap());
    let mut later = case.header.clone();
    later.version = "0.2.0".into();
    for _ in 0..2 {
        drop(Writer::resume(&path, &later, case.gap.view()).unwrap());
    }
    assert_eq!(Reader::open(&path).unwrap().header().version, "0.1.0, 0.2.0");
}

#[cfg(unix)]
#[test]
fn a_result_with_links_is_not_resumed_into() {
    let (directory, path) = place();
    let case = Case::new([4, 3], &FIELDS);
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 2);
    writer.checkpoint(&case.checkpoint(2)).unwrap();
    writer.finish(&Outcome::new(Status::Interrupted)).unwrap();
    // Rows elsewhere, as in a copy that is made of links.
    let (rows, elsewhere) = (path.join("load/c/0"), directory.path().join("rows"));
    std::fs::rename(&rows, &elsewhere).unwrap();
    std::os::unix::fs::symlink(&elsewhere, &rows).unwrap();
    let before = std::fs::read(&elsewhere).unwrap();
    let refused = Writer::resume(&path, &case.header, case.gap.view()).map(drop).unwrap_err().to_string();
    assert!(refused.contains("load/c/0") && refused.contains("it is a link"), "{refused}");
    assert_eq!(std::fs::read(&elsewhere).unwrap(), before);
}
