//! The pictures of the starter cases: `ASPERITY_PICTURES=write` runs every case without a picture and draws it, some minutes in all.

use std::path::Path;

use asperity_examples::TEMPLATES;
use asperity_io::store::Reader;
use asperity_report::thumbnail;

use crate::asperity;

#[test]
fn every_starter_case_has_a_picture_of_its_result() {
    let place = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/pictures");
    let write = std::env::var_os("ASPERITY_PICTURES").is_some_and(|value| value == "write");
    for template in TEMPLATES {
        let path = place.join(format!("{}.png", template.name));
        // Width and height stand at the 16th byte of a PNG.
        let is_drawn =
            |png: &[u8]| png.len() > 24 && png[16..20] > [0, 0, 0, 15][..] && png[20..24] > [0, 0, 0, 7][..];
        if write && !is_drawn(&std::fs::read(&path).unwrap_or_default()) {
            let directory = tempfile::tempdir().unwrap();
            assert!(asperity(directory.path(), &["new", template.name, "a.toml"]).status.success());
            let run = asperity(directory.path(), &["run", "a.toml", "-q", "-o", "a.zarr"]);
            assert!(run.status.success(), "{}: {}", template.name, String::from_utf8_lossy(&run.stderr));
            let picture = thumbnail(&Reader::open(&directory.path().join("a.zarr")).unwrap()).unwrap();
            std::fs::write(&path, picture).unwrap();
        }
        let png = std::fs::read(&path).unwrap();
        assert!(is_drawn(&png), "{}: an empty picture", template.name);
        assert!(png.len() < 40_000, "{}: {} bytes for a small picture", template.name, png.len());
    }
}
