//! Broken, truncated and hostile files are answered with an error or a topography: without a panic, without a hang
//! and with memory within a small multiple of the file's length.
//!
//! One valid file of every kind is cut at every length and has every byte changed in four ways, and is then changed
//! at random places. The fuzz targets in `fuzz/` go on from here; what they found is kept in `tests/regressions`.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::samples::files;
use asperity_files::topography::{Format, ReadOptions, Topography, TopographyError, read_bytes};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// One reading at a time, or the memory of one would be counted for another.
static READING: Mutex<()> = Mutex::new(());

/// Memory beyond a fixed share: tables of the decompressors and archives, buffers of the threads.
const SHARE: usize = 8 << 20;
/// Bytes of memory per byte of the file: two bytes of text ("0 ") make a number of 8 bytes that is held twice.
const PER_BYTE: usize = 32;

fn read(bytes: &[u8], format: Option<Format>) -> Result<Topography, TopographyError> {
    let options =
        ReadOptions { size: Some([1.0, 1.0]), height_unit: Some(1.0), format, ..Default::default() };
    let _reading = READING.lock().unwrap_or_else(PoisonError::into_inner);
    // What a packed file may unpack to is bounded, but by a wider margin (see `unpack`).
    let most = SHARE + PER_BYTE * bytes.len();
    // Other tests of this program take memory meanwhile: what a reading takes is the least of several.
    let mut readings = 0;
    let (result, peak) = loop {
        MEMORY.reset_peak_usage();
        let before = MEMORY.current_usage();
        let result = read_bytes(bytes, &options);
        let peak = MEMORY.peak_usage().saturating_sub(before);
        readings += 1;
        if peak <= most || readings == 50 {
            break (result, peak);
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert!(peak <= most, "{} bytes of memory for {} bytes of {format:?}", peak, bytes.len());
    if let Ok(surface) = &result {
        assert!(!surface.heights.is_empty() && surface.heights.iter().all(|h| !h.is_infinite()));
    }
    result
}

#[test]
fn broken_files_are_answered() {
    let mut answers = [0usize; 2];
    let mut try_both = |format, bytes: &[u8]| {
        // As found from the content, and as the caller insists.
        answers[usize::from(read(bytes, None).is_ok())] += 1;
        answers[usize::from(read(bytes, Some(format)).is_ok())] += 1;
    };
    for (format, file) in files() {
        assert!(read(&file, None).is_ok(), "{format} is valid: {:?}", read(&file, None).err());
        // Long files (mostly padding): every position up to 1500 and every 61st beyond.
        let places: Vec<usize> = (0..file.len()).filter(|at| *at < 1500 || at % 61 == 0).collect();
        for at in &places {
            try_both(format, &file[..*at]);
            let mut changed = file.clone();
            for byte in [0, 0xff, file[*at] ^ 1, file[*at] ^ 0x80] {
                changed[*at] = byte;
                try_both(format, &changed);
            }
        }
        // Several changes at once, by a linear congruential sequence (Knuth's MMIX).
        let mut state = 1u64;
        let mut next = |below: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % below
        };
        for _ in 0..300 {
            let mut changed = file.clone();
            for _ in 0..1 + next(6) {
                let at = next(changed.len());
                match next(4) {
                    0 => changed[at] = next(256) as u8,
                    1 => changed[at] = [0, 0xff, 0x7f, b'9'][next(4)],
                    2 => drop(changed.drain(at..(at + 1 + next(8)).min(changed.len()))),
                    _ => {
                        changed.splice(at..at, (0..next(8)).map(|_| 0xff).collect::<Vec<u8>>()).for_each(drop)
                    }
                }
                if changed.is_empty() {
                    break;
                }
            }
            try_both(format, &changed);
        }
    }
    // Both happen, or the test tests nothing.
    assert!(answers.iter().all(|n| *n > 1000), "{answers:?}");
}

#[test]
fn findings_of_the_fuzzer_stay_mended() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        // The name starts with the format.
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let Some(format) = name.split('-').next().and_then(|f| f.parse().ok()) else { continue };
        let _ = read(&bytes, Some(format));
        let _ = read(&bytes, None);
    }
}

#[test]
fn every_other_format_is_refused_when_insisted_on() {
    for (format, file) in files() {
        for other in Format::ALL.iter().filter(|f| **f != format) {
            let _ = read(&file, Some(*other));
        }
    }
}

/// A link makes a group part of itself, or thirty groups a tree of 2^30.
#[test]
fn groups_of_hdf5_without_a_finite_small_tree_are_refused() {
    let file = |name: &str| {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions");
        std::fs::read(folder.join(name)).unwrap()
    };
    for name in ["h5-link-to-root", "h5-soft-link-to-root", "h5-cycle"] {
        let error = read(&file(name), None).unwrap_err().to_string();
        assert!(error.contains("a link to a group that it lies in"), "{name}: {error}");
    }
    for (name, what) in [("h5-fan-out", "groups and data sets"), ("h5-deep", "32 groups deep")] {
        let error = read(&file(name), None).unwrap_err().to_string();
        assert!(error.contains(what), "{name}: {error}");
    }
    // Several names of one group are no harm: the map is a channel under each.
    let surface = read(&file("h5-two-names"), None).unwrap();
    assert_eq!(surface.heights.dim(), (3, 2));
    let names = ["direct", "default/heights", "scan/heights", "soft/heights"];
    assert!(names.iter().all(|name| surface.channels.iter().any(|c| c == name)), "{:?}", surface.channels);
}
