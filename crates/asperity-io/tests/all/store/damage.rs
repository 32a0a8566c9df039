//! Damaged and hostile results are answered: no panic, no hang, no number that was not written.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_io::store::{At, FieldKind, Outcome, Reader, Result, Status, StoreError, Writer, verify};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};

use super::{Case, bits, place};

const FIELDS: [FieldKind; 2] = [FieldKind::Pressure, FieldKind::Contact];

fn case() -> Case {
    Case::new([40, 30], &FIELDS)
}

fn write(path: &Path) {
    let case = case();
    let mut writer = Writer::create(path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 4);
    writer.checkpoint(&case.checkpoint(4)).unwrap();
}

/// Reads all there is.
fn read_all(path: &Path) -> Result<()> {
    let reader = Reader::open(path)?;
    reader.rows()?;
    reader.initial_gap()?;
    for index in 0..reader.field_times().len() {
        for kind in reader.header().fields.clone() {
            reader.field(kind, At::Index(index))?;
        }
    }
    Ok(())
}

fn edit(path: &Path, change: impl Fn(&mut serde_json::Value)) {
    let file = path.join("zarr.json");
    let mut document = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
    change(&mut document);
    fs::write(&file, document.to_string()).unwrap();
}

/// The error after a change of the group's document.
fn after(change: impl Fn(&mut serde_json::Value)) -> StoreError {
    let (_directory, path) = place();
    write(&path);
    edit(&path, change);
    read_all(&path).unwrap_err()
}

#[test]
fn what_is_no_result_is_said_to_be_none() {
    let (directory, path) = place();
    let why = |path: &Path| match Reader::open(path) {
        Err(StoreError::NotAResult { why, .. }) => why,
        other => panic!("{other:?}"),
    };
    assert!(why(&path).starts_with("there is no such file or directory"));
    assert_eq!(why(directory.path()), "it has no zarr.json");
    fs::write(&path, "x").unwrap();
    assert_eq!(why(&path), "it is a file, a result is a directory");
    fs::remove_file(&path).unwrap();
    write(&path);
    assert_eq!(why(&path.join("load")), "its Zarr group lacks the attribute format = \"asperity-result\"");
}

#[test]
fn a_later_form_is_said_to_be_later() {
    let error = after(|document| {
        document["attributes"]["schema"] = 3.into();
        document["attributes"]["version"] = "7.1.0".into();
    });
    assert!(matches!(error, StoreError::Newer { schema: 3, known: 2, .. }));
    assert!(error.to_string().ends_with(
        "was written by asperity 7.1.0 in format version 3; this version reads up to 2; update asperity"
    ));
}

#[test]
fn attributes_out_of_order_are_named() {
    for key in ["title", "version", "schema", "case", "setup", "status", "cells", "size", "fields"] {
        for value in [serde_json::Value::Null, "7".into(), serde_json::json!([-1, 2]), serde_json::json!({})]
        {
            if (key, &value) == ("title", &"7".into()) || [("version"), "case"].contains(&key) && value == "7"
            {
                continue; // any text will do
            }
            let error = after(|document| document["attributes"][key] = value.clone());
            assert!(matches!(error, StoreError::Corrupt { .. }), "{key} = {value}: {error}");
            assert!(error.to_string().contains(key), "{error}");
        }
    }
}

#[test]
fn absurd_sizes_ask_for_no_memory() {
    let shape = |name: &str, n: u64| {
        let pointer = format!("/consolidated_metadata/metadata/{name}/shape/0");
        move |document: &mut serde_json::Value| *document.pointer_mut(&pointer).unwrap() = n.into()
    };
    for n in [5000, 1 << 40, u64::MAX] {
        assert!(matches!(after(shape("time", n)), StoreError::Corrupt { .. }));
        assert!(matches!(after(shape("field_time", n)), StoreError::Corrupt { .. }));
    }
    // A grid of 2^31 cells, all arrays in accord, but hardly any file.
    let error = after(|document| {
        let (nx, ny) = (1u64 << 16, 1u64 << 15);
        without_checksums(document);
        document["attributes"]["cells"] = serde_json::json!([nx, ny]);
        let arrays = document["consolidated_metadata"]["metadata"].as_object_mut().unwrap();
        for (name, array) in arrays {
            let lead =
                array["shape"].as_array().unwrap().len() - 2.min(array["shape"].as_array().unwrap().len());
            match name.as_str() {
                "x" | "y" => {
                    let n = if name == "x" { nx } else { ny };
                    array["shape"] = serde_json::json!([n]);
                    array["chunk_grid"]["configuration"]["chunk_shape"] = serde_json::json!([n]);
                }
                "initial_gap" | "pressure" | "contact" => {
                    for (k, n) in [(lead, nx), (lead + 1, ny)] {
                        array["shape"][k] = n.into();
                        array["chunk_grid"]["configuration"]["chunk_shape"][k] = 256.into();
                    }
                }
                _ => {}
            }
        }
    });
    assert!(error.to_string().contains("the chunk is missing"), "{error}");
}

#[test]
fn a_lost_chunk_is_not_taken_for_data() {
    for chunk in ["load/c/0", "field_step/c/0", "initial_gap/c/0/0", "pressure/c/1/0/0", "contact/c/0/0/0"] {
        let (_directory, path) = place();
        write(&path);
        fs::remove_file(path.join(chunk)).unwrap();
        let error = read_all(&path).unwrap_err();
        assert!(error.to_string().contains(chunk) && error.to_string().contains("missing"), "{error}");
    }
}

#[test]
fn rows_that_never_reached_the_disk_are_found() {
    let (_directory, path) = place();
    write(&path);
    let mut time = fs::read(path.join("time/c/0")).unwrap();
    time[16..32].fill(0);
    fs::write(path.join("time/c/0"), time).unwrap();
    let error = read_all(&path).unwrap_err();
    assert!(error.to_string().contains("do not have the checksum"), "{error}");
    // Without checksums it is the order of the times that tells.
    edit(&path, without_checksums);
    let error = Reader::open(&path).unwrap().rows().unwrap_err();
    assert!(error.to_string().contains("times decrease after row 1"), "{error}");
}

#[test]
fn a_damaged_map_is_found_by_its_checksum() {
    let (_directory, path) = place();
    write(&path);
    for chunk in ["initial_gap/c/0/0", "pressure/c/1/0/0", "contact/c/0/0/0"] {
        let file = path.join(chunk);
        let sound = fs::read(&file).unwrap();
        for position in (0..sound.len()).step_by(1 + sound.len() / 50) {
            let mut damaged = sound.clone();
            damaged[position] ^= 0x10;
            fs::write(&file, &damaged).unwrap();
            let error = read_all(&path).unwrap_err();
            assert!(
                matches!(error, StoreError::Corrupt { .. }) && error.to_string().contains(chunk),
                "{error}"
            );
            assert_eq!(verify(&path).unwrap().damage.len(), 1);
        }
        fs::write(&file, &sound).unwrap();
    }
    read_all(&path).unwrap();
}

#[test]
fn a_whole_file_of_another_place_is_found() {
    let (_directory, path) = place();
    write(&path);
    let damage = || verify(&path).unwrap().damage.iter().map(|one| one.what.clone()).collect::<Vec<_>>();
    assert!(damage().is_empty());
    let [first, second] = ["0/0/0", "1/0/0"].map(|index| path.join("pressure/c").join(index));
    let own = fs::read(&second).unwrap();
    fs::copy(&first, &second).unwrap();
    assert!(damage()[0].contains("comes from another time or result"), "{:?}", damage());
    fs::remove_file(&second).unwrap();
    fs::create_dir(&second).unwrap();
    assert_eq!(damage(), ["it is a directory, not a file"]);
    fs::remove_dir(&second).unwrap();
    fs::write(&second, own).unwrap();
    // The documents of arrays, which readers without consolidated metadata use.
    let file = path.join("load/zarr.json");
    let own = fs::read_to_string(&file).unwrap();
    for other in ["garbage".to_owned(), "[]".into(), "{}".into(), own.replace("\"N\"", "\"MN\"")] {
        fs::write(&file, other).unwrap();
        assert_eq!(damage().len(), 1);
    }
    fs::write(&file, own).unwrap();
    edit(&path, |document| {
        document["consolidated_metadata"]["metadata"]["load"]["attributes"]["units"] = "MN".into();
    });
    assert_eq!(damage().len(), 1);
}

#[test]
fn a_flipped_bit_in_a_row_is_found_by_readers_and_before_a_run_goes_on() {
    let (_directory, path) = place();
    write(&path);
    let case = case();
    for array in ["time", "max_pressure", "iterations", "field_time", "field_step", "stage"] {
        let file = path.join(array).join("c/0");
        let sound = fs::read(&file).unwrap();
        let mut damaged = sound.clone();
        damaged[8] ^= 1; // the least bit of the second row
        fs::write(&file, &damaged).unwrap();
        let errors =
            [read_all(&path).unwrap_err(), Writer::resume(&path, &case.header, case.gap.view()).unwrap_err()];
        for error in errors {
            assert!(
                matches!(error, StoreError::Corrupt { .. }) && error.to_string().contains(array),
                "{error}"
            );
        }
        let found = verify(&path).unwrap();
        assert!(found.damage.len() == 1 && found.damage[0].path.ends_with(array), "{:?}", found.damage);
        fs::write(&file, &sound).unwrap();
    }
    assert!(verify(&path).unwrap().damage.is_empty());
}

#[test]
fn a_run_does_not_go_on_with_a_damaged_field() {
    let (_directory, path) = place();
    write(&path);
    let file = path.join("contact/c/0/0/0");
    let mut damaged = fs::read(&file).unwrap();
    damaged[3] ^= 1;
    fs::write(&file, &damaged).unwrap();
    let case = case();
    let error = Writer::resume(&path, &case.header, case.gap.view()).unwrap_err();
    assert!(error.to_string().contains("its checksum is wrong"), "{error}");
}

#[test]
fn a_changed_attribute_that_numbers_depend_on_is_found_and_the_title_may_be_edited() {
    let error = after(|document| document["attributes"]["setup"] = "{\"boundary\":\"periodic\"}".into());
    assert!(error.to_string().contains("attributes do not have the checksum"), "{error}");
    let (_directory, path) = place();
    write(&path);
    edit(&path, |document| document["attributes"]["title"] = "another".into());
    read_all(&path).unwrap();
}

/// The document as form 1 had it.
fn without_checksums(document: &mut serde_json::Value) {
    document["attributes"]["schema"] = 1.into();
    document["attributes"].as_object_mut().unwrap().remove("checksums");
    let arrays = document["consolidated_metadata"]["metadata"].as_object_mut().unwrap();
    for array in arrays.values_mut() {
        array["codecs"].as_array_mut().unwrap().retain(|codec| codec["name"] != "crc32c");
    }
}

#[test]
fn results_without_checksums_are_read_and_continued_as_before() {
    let (_directory, path) = place();
    write(&path);
    let summed = ["initial_gap", "x", "y", "pressure", "contact"];
    for file in files(&path) {
        let name = file.strip_prefix(&path).unwrap().components().next().unwrap().as_os_str();
        let is_chunk = file.components().any(|part| part.as_os_str() == "c");
        if is_chunk && summed.iter().any(|array| name == *array) {
            let bytes = fs::read(&file).unwrap();
            fs::write(&file, &bytes[..bytes.len() - 4]).unwrap();
        }
    }
    edit(&path, without_checksums);
    for file in files(&path).into_iter().filter(|file| file.ends_with("zarr.json")) {
        let mut document: serde_json::Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
        let Some(codecs) = document["codecs"].as_array_mut() else { continue };
        codecs.retain(|codec| codec["name"] != "crc32c");
        fs::write(&file, document.to_string()).unwrap();
    }
    read_all(&path).unwrap();
    let found = verify(&path).unwrap();
    assert!(found.damage.is_empty() && !found.has_checksums, "{:?}", found.damage);
    let case = case();
    let (mut writer, state) = Writer::resume(&path, &case.header, case.gap.view()).unwrap();
    assert_eq!(state.unwrap().step, 4);
    case.run(&mut writer, 4, 8);
    read_all(&path).unwrap();
    let pressure = Reader::open(&path).unwrap().field(FieldKind::Pressure, At::Last).unwrap();
    assert_eq!(bits(&pressure), bits(&case.pressure(6)));
}

#[test]
fn a_chunk_that_unpacks_to_more_than_its_numbers_is_refused() {
    use std::io::Write;
    let case = Case::new([256, 256], &FIELDS);
    let (_directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 1);
    let mut bomb = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    let zeros = vec![0; 1 << 20];
    (0..64).for_each(|_| bomb.write_all(&zeros).unwrap());
    let mut bomb = bomb.finish().unwrap();
    bomb.extend(crc32c::crc32c(&bomb).to_le_bytes());
    fs::write(path.join("pressure/c/0/0/0"), bomb).unwrap();
    let error = read_all(&path).unwrap_err().to_string();
    assert!(error.contains("it holds more than the 524288 bytes of its numbers"), "{error}");
}

/// What a loss of power may leave of a text that was written last.
#[test]
fn a_result_whose_document_is_cut_is_as_it_was_at_its_checkpoint() {
    let (_directory, path) = place();
    write(&path);
    fs::copy(path.join("zarr.json"), path.join("checkpoint/group.json")).unwrap();
    for text in ["", "{\"zarr_format\": 3, "] {
        fs::write(path.join("zarr.json"), text).unwrap();
        assert_eq!(Reader::open(&path).unwrap().len(), 4);
        read_all(&path).unwrap();
    }
    let case = case();
    assert!(Writer::resume(&path, &case.header, case.gap.view()).is_ok());
    fs::write(path.join("zarr.json"), "").unwrap();
    fs::write(path.join("checkpoint/group.json"), "").unwrap();
    assert!(matches!(read_all(&path), Err(StoreError::Corrupt { .. })));
}

#[test]
fn a_damaged_checkpoint_is_not_resumed_from() {
    let (_directory, path) = place();
    write(&path);
    let (file, case) = (path.join("checkpoint/state.bin"), case());
    let sound = fs::read(&file).unwrap();
    let mut copies: Vec<Vec<u8>> = (0..sound.len())
        .step_by(1 + sound.len() / 60)
        .map(|position| {
            let mut damaged = sound.clone();
            damaged[position] ^= 0x04;
            damaged
        })
        .collect();
    copies.extend((0..sound.len()).step_by(1 + sound.len() / 20).map(|length| sound[..length].to_vec()));
    copies.push([&sound[..], &[0]].concat());
    for damaged in copies {
        fs::write(&file, damaged).unwrap();
        let error = Writer::resume(&path, &case.header, case.gap.view()).unwrap_err();
        assert!(matches!(error, StoreError::Corrupt { .. }), "{error}");
        assert!(error.to_string().contains("remove it, then --resume starts from the beginning"), "{error}");
    }
    assert_eq!(Reader::open(&path).unwrap().len(), 4);
    fs::remove_file(&file).unwrap();
    let (writer, state) = Writer::resume(&path, &case.header, case.gap.view()).unwrap();
    assert!(state.is_none() && writer.is_empty());
}

#[test]
fn a_checkpoint_of_an_earlier_form_is_refused_and_nothing_is_lost() {
    let (_directory, path) = place();
    write(&path);
    let (file, case) = (path.join("checkpoint/state.bin"), case());
    let mut earlier = fs::read(&file).unwrap();
    earlier[7] = 1;
    fs::write(&file, earlier).unwrap();
    let error = Writer::resume(&path, &case.header, case.gap.view()).unwrap_err();
    assert!(
        matches!(&error, StoreError::FormerCheckpoint { rows: 4, version, .. } if *version == case.header.version)
    );
    assert!(error.to_string().contains("the rows stored (4) are kept"), "{error}");
    assert!(error.to_string().ends_with("or run the case again with --force"), "{error}");
    assert_eq!((Reader::open(&path).unwrap().len(), verify(&path).unwrap().damage), (4, vec![]));
}

#[test]
fn a_checkpoint_of_rows_that_are_not_there_is_refused() {
    let (_directory, path) = place();
    write(&path);
    let state = fs::read(path.join("checkpoint/state.bin")).unwrap();
    let case = case();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), true).unwrap();
    case.run(&mut writer, 0, 2);
    writer.checkpoint(&case.checkpoint(2)).unwrap();
    drop(writer);
    fs::write(path.join("checkpoint/state.bin"), state).unwrap();
    let error = Writer::resume(&path, &case.header, case.gap.view()).unwrap_err();
    assert!(error.to_string().contains("it is of row 4, but 2 rows are stored"), "{error}");
}

fn files(directory: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut entries: Vec<_> = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() { found.extend(files(&path)) } else { found.push(path) }
    }
    found
}

/// Any file cut, grown or with bytes changed gets an answer.
#[test]
fn any_damage_is_answered() {
    let (_directory, path) = place();
    write(&path);
    let sound: Vec<_> = files(&path).into_iter().map(|file| (fs::read(&file).unwrap(), file)).collect();
    let case = case();
    let damage = (
        any::<prop::sample::Index>(),
        any::<prop::sample::Index>(),
        prop::collection::vec(any::<u8>(), 0..9),
        any::<bool>(),
    );
    let config = ProptestConfig { cases: 50, failure_persistence: None, ..ProptestConfig::default() };
    let mut runner = proptest::test_runner::TestRunner::new_with_rng(
        config,
        TestRng::deterministic_rng(RngAlgorithm::ChaCha),
    );
    let answered = runner.run(&damage, |(which, at, bytes, cut)| {
        let (contents, file) = which.get(&sound);
        let mut contents = contents.clone();
        let position = at.index(contents.len().max(1));
        if cut {
            contents.truncate(position);
        }
        let end = contents.len().min(position + bytes.len());
        contents.splice(position.min(end)..end, bytes);
        fs::write(file, &contents).unwrap();
        let _ = read_all(&path);
        if Writer::resume(&path, &case.header, case.gap.view()).is_ok() {
            // It has taken rows back.
            fs::remove_dir_all(&path).unwrap();
            for (contents, file) in &sound {
                fs::create_dir_all(file.parent().unwrap()).unwrap();
                fs::write(file, contents).unwrap();
            }
        }
        fs::write(file, which.get(&sound).0.as_slice()).unwrap();
        read_all(&path).map_err(|error| TestCaseError::fail(error.to_string()))
    });
    answered.unwrap();
}

#[test]
fn a_result_is_the_same_for_any_number_of_threads() {
    let case = Case::new([600, 300], &FIELDS);
    let mut all = Vec::new();
    for threads in [1, 3] {
        let (_directory, path) = place();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
            case.run(&mut writer, 0, 1);
        });
        let chunks: Vec<_> =
            files(&path).into_iter().filter(|file| !file.to_string_lossy().contains(".json")).collect();
        let contents: Vec<_> = chunks.iter().map(|file| fs::read(file).unwrap()).collect();
        let read =
            pool.install(|| Reader::open(&path).unwrap().field(FieldKind::Pressure, At::Last).unwrap());
        assert_eq!(bits(&read), bits(&case.pressure(0)));
        all.push(contents);
    }
    assert_eq!(all[0], all[1]);
}

/// A pipe would wait for its other end forever.
#[cfg(unix)]
#[test]
fn a_pipe_in_place_of_a_file_is_refused() {
    for (name, checkpoint) in
        [("zarr.json", false), ("load/c/0", false), ("pressure/c/0/0/0", false), ("", true)]
    {
        let (_directory, path) = place();
        write(&path);
        let file = match checkpoint {
            false => path.join(name),
            true => files(&path).into_iter().find(|file| file.ends_with("checkpoint/state.bin")).unwrap(),
        };
        fs::remove_file(&file).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&file).status().unwrap().success());
        let refused = match checkpoint {
            false => read_all(&path).map(drop),
            true => Writer::resume(&path, &case().header, case().gap.view()).map(drop),
        };
        assert!(refused.unwrap_err().to_string().contains("a pipe, not a file"), "{}", file.display());
    }
}

#[test]
fn an_array_without_its_checksum_is_damage() {
    let (_directory, path) = place();
    write(&path);
    let whole = fs::read(path.join("zarr.json")).unwrap();
    for name in ["load", "time", "field_time", "certificate"] {
        edit(&path, |document| {
            let sums = document["attributes"]["checksums"].as_str().unwrap();
            let mut sums: serde_json::Value = serde_json::from_str(sums).unwrap();
            sums.as_object_mut().unwrap().remove(name).unwrap();
            document["attributes"]["checksums"] = sums.to_string().into();
        });
        let damage = verify(&path).unwrap().damage;
        assert!(damage.len() == 1 && damage[0].what.contains(&format!("`{name}`")), "{damage:?}");
        fs::write(path.join("zarr.json"), &whole).unwrap();
    }
    assert!(verify(&path).unwrap().damage.is_empty());
}

#[test]
fn a_document_of_an_array_that_counts_other_rows_is_damage() {
    let (_directory, path) = place();
    write(&path);
    let count = |rows: u64| {
        let array = path.join("load");
        edit(&array, |document| document["shape"][0] = rows.into());
        verify(&path).unwrap().damage.into_iter().map(|damage| damage.path).collect::<Vec<_>>()
    };
    // After a kill it may lag behind the document of the group, but not count more.
    assert!(count(3).is_empty());
    assert_eq!(count(5), [path.join("load").join("zarr.json")]);
    assert!(count(4).is_empty());
    let (header, gap) = (case().header, case().gap);
    let (writer, _) = Writer::resume(&path, &header, gap.view()).unwrap();
    writer.finish(&Outcome::new(Status::Complete)).unwrap();
    assert!(verify(&path).unwrap().damage.is_empty());
    assert_eq!(count(3), [path.join("load").join("zarr.json")]);
}
