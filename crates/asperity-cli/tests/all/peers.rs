//! Surfaces against independent programs in Python. Skipped with a message where NumPy, h5py and netCDF4 are not installed,
//! but not under `cargo xtask test`; `ASPERITY_PYTHON` names the interpreter to use (default `python3`).

use std::path::Path;
use std::process::Command;

#[test]
fn other_programs_read_our_surfaces_and_we_read_theirs() {
    let named = std::env::var_os("ASPERITY_PYTHON");
    let must_run = named.is_some() || std::env::var_os("CI").is_some();
    let python = named.unwrap_or("python3".into());
    let needed = Command::new(&python).args(["-c", "import numpy, h5py, netCDF4"]).output();
    if !needed.is_ok_and(|output| output.status.success()) {
        assert!(!must_run, "{} does not import numpy, h5py and netCDF4", python.display());
        eprintln!("skipped: {} does not import numpy, h5py and netCDF4", python.display());
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/test_surfaces.py");
    let output = Command::new(&python)
        .arg(script)
        .current_dir(dir.path())
        .env("ASPERITY_COMMAND", env!("CARGO_BIN_EXE_asperity"))
        .env("PYTHONUTF8", "1")
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    eprint!("{}", String::from_utf8_lossy(&output.stdout));
}
