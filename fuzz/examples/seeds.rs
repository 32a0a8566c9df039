//! Writes valid files of every format into the corpora of the fuzz targets: `cargo run --example seeds` in `fuzz/`.

#[path = "../../crates/asperity-io/tests/samples/mod.rs"]
mod samples;

use std::path::Path;

fn main() -> std::io::Result<()> {
    for (i, (format, bytes)) in samples::files().into_iter().enumerate() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(format.name());
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(format!("seed-{i}")), bytes)?;
    }
    Ok(())
}
