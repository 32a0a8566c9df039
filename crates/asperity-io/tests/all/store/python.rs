//! xarray, zarr-python and NetCDF read what Rust wrote. Skipped with a message where they are not installed, but not
//! under `cargo xtask test`; `ASPERITY_PYTHON` names the interpreter to use (default `python3`).

use std::fs;

use asperity_io::store::{FieldKind, Outcome, Status, Writer};

use super::{Case, le_bytes, place, python, run_python};

#[test]
fn xarray_reads_the_bits_without_a_warning() {
    let Some(python) = python("numpy, xarray, zarr, scipy") else { return };
    let case = Case::new([300, 257], &FieldKind::ALL);
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    for step in 0..7 {
        case.append(&mut writer, step, step > 2).unwrap();
    }
    writer.checkpoint(&case.checkpoint(7)).unwrap();

    let dump = |name: &str, bytes: Vec<u8>| fs::write(directory.path().join(name), bytes).unwrap();
    dump("initial_gap", le_bytes(&case.gap));
    dump("pressure", le_bytes(&case.pressure(6)));
    dump("gap", le_bytes(&case.gap(6)));
    dump("contact", case.contact(6).into_raw_vec_and_offset().0);
    dump("time", (0..7).flat_map(|step| case.row(step).time().to_le_bytes()).collect());
    dump("residual", (0..7).flat_map(|step| case.row(step).residual.to_le_bytes()).collect());

    let fields = FieldKind::ALL.map(FieldKind::name).join(" ");
    let check = |status: &str| {
        let variables = [
            ("ASPERITY_RESULT", path.as_os_str()),
            ("ASPERITY_STATUS", status.as_ref()),
            ("ASPERITY_FIELDS", fields.as_ref()),
        ];
        run_python(&python, "test_store.py", &variables);
    };
    // While it is being written, and when it is done.
    check("running");
    writer.finish(&Outcome::new(Status::Complete)).unwrap();
    check("complete");
}
