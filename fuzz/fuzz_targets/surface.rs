#![no_main]

//! Every reader of surfaces: the first line of the input names the format, the rest is the file.

use asperity_files::topography::{Format, ReadOptions, detect, read_bytes};

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    let Some(end) = input.iter().position(|byte| *byte == b'\n') else { return };
    let format = std::str::from_utf8(&input[..end]).ok().and_then(|name| name.parse().ok());
    if let Some(format) = format {
        read(format, &input[end + 1..]);
    }
});

/// Reads `data` as this format: it must be answered, and a topography must not be larger than the file allows.
fn read(format: Format, data: &[u8]) {
    let _ = detect(data);
    let options = ReadOptions {
        size: Some([1.0, 1.0]),
        height_unit: Some(1.0),
        format: Some(format),
        ..ReadOptions::default()
    };
    if let Ok(surface) = read_bytes(data, &options) {
        assert!(surface.heights.iter().all(|h| !h.is_infinite()));
        // Packed formats may swell 64 times beyond 256 MiB (see `unpack`); points of a list span up to 8 each.
        let most = (256 << 20) + 64 * data.len();
        assert!(!surface.heights.is_empty() && surface.heights.len() <= most);
    }
    // Nothing given: size and unit come from the file or are asked for.
    if let Ok(surface) = read_bytes(data, &ReadOptions { format: Some(format), ..ReadOptions::default() }) {
        assert!(surface.size.iter().all(|length| length.is_finite() && *length > 0.0));
    }
}
