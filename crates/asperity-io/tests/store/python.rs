//! xarray, zarr-python and NetCDF read what Rust wrote. Skips with a message where they are not installed;
//! `ASPERITY_PYTHON` names the interpreter to use (default `python3`).

use std::ffi::OsString;
use std::fs;
use std::process::Command;

use asperity_io::store::{FieldKind, Outcome, Status, Writer};
use ndarray::Array2;

use crate::{Case, place};

fn raw(map: &Array2<f64>) -> Vec<u8> {
    map.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn xarray_reads_the_bits_without_a_warning() {
    let python = std::env::var_os("ASPERITY_PYTHON").unwrap_or(OsString::from("python3"));
    let probe = Command::new(&python).args(["-c", "import numpy, xarray, zarr"]).output();
    if !probe.is_ok_and(|probe| probe.status.success()) {
        eprintln!("skipped: {} has no numpy, xarray and zarr", python.display());
        return;
    }
    let case = Case::new([300, 257], &FieldKind::ALL);
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    for step in 0..7 {
        case.append(&mut writer, step, step > 2).unwrap();
    }
    writer.checkpoint(&case.checkpoint(7)).unwrap();

    let dump = |name: &str, bytes: Vec<u8>| fs::write(directory.path().join(name), bytes).unwrap();
    dump("initial_gap", raw(&case.gap));
    dump("pressure", raw(&case.pressure(6)));
    dump("gap", raw(&case.gap(6)));
    dump("contact", case.contact(6).into_raw_vec_and_offset().0);
    dump("time", (0..7).flat_map(|step| case.row(step).time.to_le_bytes()).collect());
    dump("residual", (0..7).flat_map(|step| case.row(step).residual.to_le_bytes()).collect());

    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/python/test_store.py");
    let check = |status: &str| {
        let output = Command::new(&python)
            .args(["-W", "error", script])
            .env("ASPERITY_RESULT", &path)
            .env("ASPERITY_STATUS", status)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        eprint!("{said}");
    };
    // While it is being written, and when it is done.
    check("running");
    writer.finish(&Outcome::new(Status::Complete)).unwrap();
    check("complete");
}
