//! Nothing is overwritten unasked, nothing but a result is ever removed, nothing is left half-made.

use std::fs;
use std::path::Path;

use asperity_io::store::{FieldKind, Outcome, Reader, Status, StoreError, Writer, verify};

use super::{Case, place};

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(directory).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_result_is_replaced_by_force_only() {
    let case = Case::new([4, 3], &[FieldKind::Gap]);
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 4);
    writer.checkpoint(&case.checkpoint(4)).unwrap();
    drop(writer);
    let again = Writer::create(&path, &case.header, case.gap.view(), false);
    assert!(matches!(again, Err(StoreError::Exists { .. })));
    assert_eq!(Reader::open(&path).unwrap().len(), 4);

    drop(Writer::create(&path, &case.header, case.gap.view(), true).unwrap());
    assert_eq!(Reader::open(&path).unwrap().len(), 0);
    assert!(!path.join("checkpoint").exists());
    assert_eq!(names(directory.path()), ["result.zarr"]);
    // A path with a closing slash is the same directory.
    drop(Writer::create(&path.join(""), &case.header, case.gap.view(), true).unwrap());
    assert_eq!(names(directory.path()), ["result.zarr"]);
}

#[test]
fn what_is_not_a_result_is_left_alone() {
    let case = Case::new([4, 3], &[]);
    let (directory, path) = place();
    let refused = |what: &str| {
        for force in [false, true] {
            let error = Writer::create(&path, &case.header, case.gap.view(), force).unwrap_err();
            assert!(matches!(error, StoreError::Foreign { .. }), "{error}");
            assert!(error.to_string().contains(what), "{error}");
        }
    };
    fs::write(&path, "a file").unwrap();
    refused("is a file");
    assert_eq!(fs::read_to_string(&path).unwrap(), "a file");
    fs::remove_file(&path).unwrap();

    fs::create_dir(&path).unwrap();
    fs::write(path.join("zarr.json"), r#"{"zarr_format": 3, "node_type": "group", "attributes": {}}"#)
        .unwrap();
    refused("is a directory, but not a result");
    assert_eq!(names(&path), ["zarr.json"]);
    fs::remove_dir_all(&path).unwrap();

    #[cfg(unix)]
    {
        let target = directory.path().join("target.zarr");
        drop(Writer::create(&target, &case.header, case.gap.view(), false).unwrap());
        std::os::unix::fs::symlink(&target, &path).unwrap();
        refused("is a link");
        fs::remove_file(&path).unwrap();
        assert!(Reader::open(&target).is_ok());
        fs::remove_dir_all(&target).unwrap();
    }
    assert!(names(directory.path()).is_empty());
}

#[test]
fn a_result_that_holds_other_files_is_not_removed() {
    let case = Case::new([4, 3], &[]);
    let (_directory, path) = place();
    drop(Writer::create(&path, &case.header, case.gap.view(), false).unwrap());
    fs::write(path.join("notes.txt"), "mine").unwrap();
    let error = Writer::create(&path, &case.header, case.gap.view(), true).unwrap_err();
    assert!(error.to_string().contains("notes.txt"), "{error}");
    assert_eq!(fs::read_to_string(path.join("notes.txt")).unwrap(), "mine");
}

/// Arrays are directories that people put notes into.
#[test]
fn files_inside_the_arrays_of_a_replaced_result_are_kept() {
    let case = Case::new([4, 3], &[FieldKind::Pressure]);
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 3);
    writer.checkpoint(&case.checkpoint(3)).unwrap();
    drop(writer);
    let mine = ["pressure/notes.txt", "pressure/c/1/notes.txt", "checkpoint/notes.txt"];
    mine.iter().for_each(|name| fs::write(path.join(name), "mine").unwrap());
    drop(Writer::create(&path, &case.header, case.gap.view(), true).unwrap());
    assert_eq!(Reader::open(&path).unwrap().len(), 0);
    assert_eq!(names(directory.path()), ["result.zarr", "result.zarr.old"]);
    let old = directory.path().join("result.zarr.old");
    assert_eq!(names(&old), ["checkpoint", "pressure"]);
    for name in mine {
        assert_eq!(fs::read_to_string(old.join(name)).unwrap(), "mine");
    }
    assert_eq!(names(&old.join("pressure/c")), ["1"]);
}

#[test]
fn what_killed_starts_left_is_swept_and_what_others_hold_is_not() {
    let case = Case::new([4, 3], &[]);
    let (directory, path) = place();
    let left = |name: &str| {
        let left = directory.path().join(name);
        drop(Writer::create(&left, &case.header, case.gap.view(), false).unwrap());
        left
    };
    let dead = left(".result.zarr.partial-4194305");
    let held = left(".result.zarr.partial-7-1");
    let young = left(".result.zarr.old-8");
    let other = left(".result.zarr.partial-x");
    let old = std::time::SystemTime::now() - std::time::Duration::from_secs(60);
    let age = |path: &Path| fs::File::open(path).unwrap().set_modified(old).unwrap();
    [&dead, &held, &other].into_iter().for_each(|path| age(path));
    let lock = fs::File::open(&held).unwrap();
    lock.try_lock().unwrap();
    drop(Writer::create(&path, &case.header, case.gap.view(), false).unwrap());
    assert!(!dead.exists());
    assert!(held.exists() && young.exists() && other.exists());
}

/// Killed between putting the old result aside and putting the new one in its place.
#[test]
fn a_result_that_was_put_aside_comes_back() {
    let case = Case::new([4, 3], &[]);
    let (directory, path) = place();
    let aside = directory.path().join(".result.zarr.old-4194305");
    let mut writer = Writer::create(&aside, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 2);
    drop(writer);
    let old = std::time::SystemTime::now() - std::time::Duration::from_secs(60);
    fs::File::open(&aside).unwrap().set_modified(old).unwrap();
    let error = Writer::create(&path, &case.header, case.gap.view(), false).unwrap_err();
    assert!(matches!(error, StoreError::Exists { .. }), "{error}");
    assert_eq!(Reader::open(&path).unwrap().len(), 2);
}

#[test]
fn of_starts_at_the_same_time_one_runs_and_the_others_say_busy() {
    let case = Case::new([64, 64], &[]);
    for _ in 0..5 {
        let (directory, path) = place();
        let starts: Vec<_> = std::thread::scope(|scope| {
            let start = || Writer::create(&path, &case.header, case.gap.view(), false);
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(start)).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(starts.iter().filter(|start| start.is_ok()).count(), 1);
        for error in starts.iter().filter_map(|start| start.as_ref().err()) {
            // One that came later found the result there.
            assert!(matches!(error, StoreError::Busy { .. } | StoreError::Exists { .. }), "{error}");
        }
        assert_eq!(names(directory.path()), ["result.zarr"]);
    }
}

#[test]
fn a_name_too_long_for_its_unfinished_forms_is_refused_at_once() {
    let case = Case::new([4, 3], &[]);
    let (directory, _) = place();
    let create = |length: usize| {
        let path = directory.path().join("z".repeat(length));
        Writer::create(&path, &case.header, case.gap.view(), false).map(drop)
    };
    create(235).unwrap();
    let error = create(236).unwrap_err().to_string();
    assert!(error.contains("236 bytes long") && error.contains("at most 235"), "{error}");
}

#[test]
fn a_place_that_cannot_be_written_is_named_and_nothing_is_left() {
    let case = Case::new([4, 3], &[]);
    let (directory, path) = place();
    let error = Writer::create(&path.join("result.zarr"), &case.header, case.gap.view(), false).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("cannot write into") && message.contains("create its directory first"),
        "{message}"
    );
    fs::write(&path, "").unwrap();
    let error = Writer::create(&path.join("result.zarr"), &case.header, case.gap.view(), false).unwrap_err();
    assert!(matches!(error, StoreError::Io { .. }), "{error}");
    fs::remove_file(&path).unwrap();
    for odd in ["..", "/", ""] {
        assert!(Writer::create(Path::new(odd), &case.header, case.gap.view(), true).is_err());
    }
    assert!(names(directory.path()).is_empty());
}

#[test]
fn a_step_that_could_not_be_written_can_be_appended_again() {
    let case = Case::new([4, 3], &[FieldKind::Gap]);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 2);
    // The directory of the next map is taken by a file: as good as a full disk.
    fs::write(path.join("gap/c/1"), "").unwrap();
    let error = case.append(&mut writer, 2, true).unwrap_err();
    assert!(matches!(error, StoreError::Io { .. }), "{error}");
    let reader = Reader::open(&path).unwrap();
    assert_eq!((reader.len(), reader.field_steps().len(), writer.len()), (2, 1, 2));
    fs::remove_file(path.join("gap/c/1")).unwrap();
    case.append(&mut writer, 2, true).unwrap();
    assert_eq!(Reader::open(&path).unwrap().field_steps(), [0, 2]);
}

#[test]
fn a_complete_result_is_kept_until_the_one_that_replaces_it_is_complete() {
    let (directory, path) = place();
    let case = Case::new([4, 3], &[]);
    let written = |rows: usize, status: Option<Status>, force: bool| {
        let mut writer = Writer::create(&path, &case.header, case.gap.view(), force).unwrap();
        case.run(&mut writer, 0, rows);
        if let Some(status) = status {
            writer.finish(&Outcome::new(status)).unwrap();
        }
    };
    written(5, Some(Status::Complete), false);
    // Killed, then failed: the complete one stays.
    for status in [None, Some(Status::Failed)] {
        written(2, status, true);
        let kept = Reader::open(&path).unwrap().replaces().unwrap();
        let kept = Reader::open(&kept).unwrap();
        assert_eq!((kept.len(), kept.status()), (5, Status::Complete));
    }
    assert_eq!(names(directory.path()).len(), 2);
    written(3, Some(Status::Complete), true);
    assert!(Reader::open(&path).unwrap().replaces().is_none());
    assert_eq!(names(directory.path()).len(), 1);
}

#[cfg(unix)]
#[test]
fn a_run_whose_result_is_moved_writes_nothing_into_another_one() {
    let (directory, path) = place();
    let case = Case::new([4, 3], &[]);
    let mut first = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut first, 0, 2);
    std::fs::rename(&path, directory.path().join("elsewhere")).unwrap();
    let mut second = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut second, 0, 4);
    second.finish(&Outcome::new(Status::Complete)).unwrap();
    let refused = first.append(&case.row(2), &[]).unwrap_err().to_string();
    assert!(refused.contains("moved or removed"), "{refused}");
    assert!(first.finish(&Outcome::new(Status::Failed)).is_err());
    assert!(verify(&path).unwrap().damage.is_empty());
    assert_eq!(Reader::open(&path).unwrap().len(), 4);
}
