//! Real files of instruments and programs against what an independent reader finds in them.
//!
//! The files and `expected.json` (by SurfaceTopography 1.27.1) lie beside the checkout; the test says so and passes
//! where they are absent.

use std::path::PathBuf;

use asperity_io::topography::{Format, ReadOptions, read};
use serde_json::Value;

fn folder() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/surfaces");
    let present = folder.join("expected.json").is_file();
    if !present {
        eprintln!("skipped: no {}", folder.display());
    }
    present.then_some(folder)
}

fn metres(unit: &Value) -> Option<f64> {
    Some(match unit.as_str()? {
        "m" => 1.0,
        "mm" => 1e-3,
        "\u{b5}m" => 1e-6,
        "nm" => 1e-9,
        other => panic!("unit {other} in expected.json"),
    })
}

/// |a - b| within 1e-9 of the larger one, or of `scale` where both are small. The numbers of the other reader pass
/// through its own order of multiplications and through decimal text: some 1e-15, and 1e-12 in the sums.
fn close(a: f64, b: f64, scale: f64) -> bool {
    (a.is_nan() && b.is_nan()) || (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(scale)
}

#[test]
fn measured_files_are_read_as_an_independent_reader_reads_them() {
    let Some(folder) = folder() else { return };
    // NaN is no JSON.
    let text = std::fs::read_to_string(folder.join("expected.json")).unwrap().replace(": NaN", ": null");
    let expected: Value = serde_json::from_str(&text).unwrap();
    let mut failures = Vec::new();
    for (name, truth) in expected.as_object().unwrap() {
        let number = |key: &str| truth[key].as_f64().unwrap_or(f64::NAN);
        let pair = |key: &str| [truth[key][0].as_f64().unwrap(), truth[key][1].as_f64().unwrap()];
        let metres = metres(&truth["unit"]);
        let options = ReadOptions { height_unit: metres.is_none().then_some(1.0), ..Default::default() };
        let metres = metres.unwrap_or(1.0);
        let surface = match read(&folder.join(name), &options) {
            Ok(surface) => surface,
            Err(error) => {
                failures.push(format!("{name}: {error}"));
                continue;
            }
        };
        let mut check = |what: &str, found: f64, expected: f64, scale: f64| {
            if !close(found, expected, scale) {
                failures.push(format!("{name}: {what} is {found:e}, expected {expected:e}"));
            }
        };
        let heights = &surface.heights;
        let defined: Vec<f64> = heights.iter().copied().filter(|h| !h.is_nan()).collect();
        let n = defined.len() as f64;
        let mean = defined.iter().sum::<f64>() / n;
        let rms = (defined.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / n).sqrt();
        let (min, max) = defined.iter().fold((f64::MAX, f64::MIN), |(a, b), h| (a.min(*h), b.max(*h)));
        let range = max - min;
        for axis in 0..2 {
            check("points", heights.shape()[axis] as f64, pair("shape")[axis], 0.0);
            check("size", surface.size[axis], pair("size")[axis] * metres, 0.0);
        }
        check("undefined", surface.undefined() as f64, number("undefined"), 0.0);
        check("min", min, number("min") * metres, range);
        check("max", max, number("max") * metres, range);
        check("mean", mean, number("mean") * metres, range);
        check("rms", rms, number("rms") * metres, range);
        check("h00", heights[[0, 0]], number("h00") * metres, range);
        check("h10", heights[[1, 0]], number("h_1_0") * metres, range);
        check("h01", heights[[0, 1]], number("h_0_1") * metres, range);
        if surface.format.name() != truth["format"] {
            failures.push(format!("{name}: format {}, expected {}", surface.format, truth["format"]));
        }
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

#[test]
fn a_file_without_a_unit_asks_for_it() {
    let Some(folder) = folder() else { return };
    let error = read(&folder.join("xyz-1.txt"), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("xyz-1.txt") && error.contains("--height-unit"), "{error}");
    // Read as a matrix, the same file has no size either.
    let options = ReadOptions { format: Some(Format::Text), height_unit: Some(1e-6), ..Default::default() };
    let error = read(&folder.join("xyz-1.txt"), &options).unwrap_err().to_string();
    assert!(error.contains("--size"), "{error}");
}
