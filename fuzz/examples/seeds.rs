//! Writes valid files of every format, and those that once broke a reader, into the corpora of the fuzz targets:
//! `cargo run --example seeds` in `fuzz/`.

#[path = "../../crates/asperity-io/tests/samples/mod.rs"]
mod samples;

use std::path::Path;

fn main() -> std::io::Result<()> {
    for (i, (format, bytes)) in samples::files().into_iter().enumerate() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(format.name());
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(format!("seed-{i}")), bytes)?;
    }
    // The name starts with the format.
    let broken = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/asperity-io/tests/regressions");
    for entry in std::fs::read_dir(&broken)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if let Some((format, _)) = name.split_once('-') {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(format);
            std::fs::create_dir_all(&folder)?;
            std::fs::copy(broken.join(&name), folder.join(&name))?;
        }
    }
    Ok(())
}
