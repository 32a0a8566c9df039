//! Surfaces against independent programs in Python. Skips with a message where NumPy is not installed;
//! `ASPERITY_PYTHON` names the interpreter to use (default `python3`).

use std::path::Path;
use std::process::Command;

#[test]
fn other_programs_read_our_surfaces_and_we_read_theirs() {
    let python = std::env::var_os("ASPERITY_PYTHON").unwrap_or("python3".into());
    let numpy = Command::new(&python).args(["-c", "import numpy"]).output();
    if !numpy.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no Python with NumPy");
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
