//! A process killed at any instant leaves every step that it appended.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

use asperity_io::store::{At, FieldKind, Reader, Status, StoreError, Writer};

use super::{Case, bits, place, row_bits};

const FIELDS: [FieldKind; 2] = [FieldKind::Pressure, FieldKind::Contact];
const PATH: &str = "ASPERITY_TEST_STORE_TO_BE_KILLED";

/// Not a fact of its own: the process that the next test kills. Says how many rows it has appended.
#[test]
fn process_to_be_killed() {
    let Some(path) = std::env::var_os(PATH) else { return };
    let case = Case::new([40, 30], &FIELDS);
    let mut writer = Writer::create(path.as_ref(), &case.header, case.gap.view(), false).unwrap();
    for step in 0.. {
        case.append(&mut writer, step, true).unwrap();
        println!("appended {}", step + 1);
        if writer.checkpoint_due() {
            writer.checkpoint(&case.checkpoint(step + 1)).unwrap();
            println!("checkpoint {}", step + 1);
        }
    }
}

#[test]
fn a_killed_process_leaves_every_step_that_it_appended() {
    let case = Case::new([40, 30], &FIELDS);
    for wait in [1, 7, 30, 100] {
        let (_directory, path) = place();
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "store::killed::process_to_be_killed", "--nocapture"])
            .env(PATH, &path)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map_while(Result::ok);
        let number = |line: &str, word: &str| line.split_once(word)?.1.trim().parse::<usize>().ok();
        let (mut appended, mut checkpoint) = (0, 0);
        let mut heard = |line: &str| {
            appended = number(line, "appended ").unwrap_or(appended);
            checkpoint = number(line, "checkpoint ").unwrap_or(checkpoint);
            appended
        };
        while lines.next().is_some_and(|line| heard(&line) < wait) {}
        child.kill().unwrap(); // SIGKILL
        child.wait().unwrap();
        lines.for_each(|line| {
            heard(&line);
        });
        assert!(appended >= wait);

        let reader = Reader::open(&path).unwrap();
        assert_eq!(reader.status(), Status::Running);
        assert!(!reader.is_being_written());
        assert!(reader.len() >= appended, "{} rows stored, {appended} appended", reader.len());
        for (step, row) in reader.rows().unwrap().iter().enumerate() {
            assert_eq!(row_bits(row), row_bits(&case.row(step)));
        }
        assert_eq!(reader.field_times().len(), reader.len());
        let last = reader.len() - 1;
        assert_eq!(bits(&reader.field(FieldKind::Pressure, At::Last).unwrap()), bits(&case.pressure(last)));

        let (mut writer, state) = Writer::resume(&path, &case.header, case.gap.view()).unwrap();
        let first = state.map_or(0, |state| state.step);
        assert!(first >= checkpoint);
        assert_eq!(writer.len(), first);
        case.run(&mut writer, first, first + 3);
        assert_eq!(Reader::open(&path).unwrap().len(), first + 3);
    }
}

#[test]
fn what_an_interrupted_write_leaves_is_not_seen_and_is_overwritten() {
    let case = Case::new([40, 30], &FIELDS);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 3);
    drop(writer);
    // Row 3 written but not counted; a map begun; documents cut short.
    let mut time = std::fs::read(path.join("time/c/0")).unwrap();
    time[24..32].copy_from_slice(&99.0f64.to_le_bytes());
    std::fs::write(path.join("time/c/0"), time).unwrap();
    std::fs::create_dir_all(path.join("pressure/c/2/0")).unwrap();
    std::fs::write(path.join("pressure/c/2/0/0"), b"\x1f\x8bhalf").unwrap();
    std::fs::write(path.join("x/group.json.partial"), b"{\"zarr_for").unwrap();
    std::fs::write(path.join("load/zarr.json.partial"), b"").unwrap();

    let reader = Reader::open(&path).unwrap();
    assert_eq!((reader.len(), reader.field_times().len()), (3, 2));
    assert_eq!(reader.series("time").unwrap().last(), Some(&case.row(2).time()));

    let (mut writer, state) = Writer::resume(&path, &case.header, case.gap.view()).unwrap();
    assert!(state.is_none());
    assert!(writer.is_empty());
    assert!(!path.join("pressure/c/2").exists());
    case.run(&mut writer, 0, 6);
    let reader = Reader::open(&path).unwrap();
    assert_eq!(reader.field_steps(), [0, 2, 4]);
    assert_eq!(row_bits(&reader.rows().unwrap()[3]), row_bits(&case.row(3)));
}

#[test]
fn a_reader_beside_the_writer_sees_whole_steps_only() {
    let case = Case::new([5, 4], &FIELDS);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let watch = scope.spawn(|| {
            let mut seen = 0;
            while !done.load(Ordering::Relaxed) {
                let reader = Reader::open(&path).unwrap();
                assert!(reader.len() >= seen);
                seen = reader.len();
                assert_eq!(reader.field_steps().len(), seen.div_ceil(2));
                if let Some(row) = reader.rows().unwrap().last() {
                    assert_eq!(row_bits(row), row_bits(&case.row(seen - 1)));
                }
            }
        });
        case.run(&mut writer, 0, 500);
        done.store(true, Ordering::Relaxed);
        watch.join().unwrap();
    });
}

#[test]
fn two_processes_do_not_write_one_result() {
    let case = Case::new([5, 4], &FIELDS);
    let (_directory, path) = place();
    let writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    assert!(Reader::open(&path).unwrap().is_being_written());
    let resumed = Writer::resume(&path, &case.header, case.gap.view());
    assert!(matches!(resumed, Err(StoreError::Busy { .. })));
    let replaced = Writer::create(&path, &case.header, case.gap.view(), true);
    assert!(matches!(replaced, Err(StoreError::Busy { .. })));
    drop(writer);
    assert!(!Reader::open(&path).unwrap().is_being_written());
    assert!(Writer::resume(&path, &case.header, case.gap.view()).is_ok());
}
