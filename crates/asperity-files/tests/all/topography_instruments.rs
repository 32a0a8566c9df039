//! Files of instruments built by hand after the formats' descriptions: orientation, scale, unit, undefined points,
//! channels; and what is said of formats that are not read.

use crate::samples::instruments::{self, Nanoscope};
use crate::samples::{NUMBERS, gzip, zip};
use asperity_files::topography::{Format, Problem, ReadOptions, Topography, read_bytes};

const UM: f64 = 1e-6;
const NM: f64 = 1e-9;

fn read(bytes: &[u8]) -> Topography {
    read_bytes(bytes, &ReadOptions::default()).unwrap()
}

fn channel(bytes: &[u8], name: &str) -> Result<Topography, Problem> {
    read_bytes(bytes, &ReadOptions { channel: Some(name.into()), ..Default::default() })
        .map_err(|e| e.problem)
}

/// Heights `unit` times the numbers of the samples at their places plus `offset`; the number 60 undefined where said.
fn assert_map(
    surface: &Topography,
    format: Format,
    [unit, offset]: [f64; 2],
    size: [f64; 2],
    last_undefined: bool,
) {
    assert_eq!(surface.format, format);
    assert_eq!(surface.heights.dim(), (3, 2));
    assert!(surface.heights.is_standard_layout());
    for ((x, y), h) in surface.heights.indexed_iter() {
        let expected = f64::from(NUMBERS[3 * y + x]) * unit + offset;
        if last_undefined && (x, y) == (2, 1) {
            assert!(h.is_nan(), "{format}: the last point is {h:e}");
        } else {
            // A few products are rounded.
            assert!(
                (h - expected).abs() <= 1e-12 * expected.abs(),
                "{format}: {h:e} at ({x}, {y}), not {expected:e}"
            );
        }
    }
    for (found, expected) in surface.size.iter().zip(size) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{format}: size {found:e}, not {expected:e}");
    }
}

#[test]
fn nanoscope_images_are_scaled_by_their_sensitivity_in_all_widths() {
    let size = [3.0 * UM, 2.0 * UM];
    let default = Nanoscope::default();
    for file in [
        default,
        Nanoscope { bytes: 4, width: 4, ..default },
        // From version 9.2 numbers have 32 bits, but the scale is that of 16.
        Nanoscope { version: "0x09200000", width: 4, ..default },
    ] {
        let surface = read(&file.file());
        assert_eq!(surface.channel.as_deref(), Some("ZSensor"));
        assert_eq!(surface.channels, ["DeflectionError", "ZSensor", "Phase"]);
        assert_map(&surface, Format::Nanoscope, [0.5 * NM, 0.0], size, false);
        assert!(surface.metadata.contains(&("Description".into(), "Dimension Icon".into())));
    }
    // One length is that of a square; a slow axis with an entry of its own counts more.
    assert_eq!(
        read(&Nanoscope { size: "3 um", ..default }.file()).size.map(|l| (l / NM).round()),
        [3000.0; 2]
    );
    let slow = Nanoscope { scan: "\\Scan Size: 4 um\r\n\\Slow Axis Size: 5000 nm\r\n", ..default };
    assert_eq!(read(&slow.file()).size.map(|l| (l / NM).round()), [4000.0, 5000.0]);
}

/// The scan of the sample has 3 x 2 points. Expected lengths follow from square cells, and from the share of the lines that were recorded.
#[test]
fn nanoscope_images_that_are_not_square_have_the_height_of_their_lines() {
    let nm = |file: Nanoscope| read(&file.file()).size.map(|l| (l / NM * 1e3).round() / 1e3);
    let square = Nanoscope { size: "3 3 ~m", ..Nanoscope::default() };
    for aspect in ["3:2", "1.5:1", "0.666667", "1.50", "3 : 2"] {
        let line: &'static str = Box::leak(format!("\\Aspect Ratio: {aspect}\r\n").into_boxed_str());
        let scan: &'static str = Box::leak(format!("\\Scan Size: 3000 nm\r\n{line}").into_boxed_str());
        for file in [
            Nanoscope { aspect: line, scan, ..square },
            // The image has the ratio of its scan, or the scan is not described.
            Nanoscope { aspect: "", scan, ..square },
            Nanoscope { aspect: line, scan: "\\Scan Size: 3000 nm\r\n", ..square },
            Nanoscope { aspect: line, scan, size: "3 ~m", ..square },
            Nanoscope { aspect: line, scan, size: "3 2 ~m", ..square },
        ] {
            assert_eq!(nm(file), [3000.0, 2000.0], "{aspect} {} {}", file.scan, file.size);
        }
    }
    let stopped =
        |scan: &'static str, aspect: &'static str, size| nm(Nanoscope { aspect, scan, size, ..square });
    // Two of three lines of a square scan, and two of four of a scan of 3:4.
    let square_scan = "\\Aspect Ratio: 1:1\r\n\\Lines: 3\r\n";
    let high_scan = "\\Aspect Ratio: 3:4\r\n\\Lines: 4\r\n";
    assert_eq!(stopped(square_scan, "\\Aspect Ratio: 3:2\r\n", "3 3 ~m"), [3000.0, 2000.0]);
    assert_eq!(stopped(square_scan, "\\Aspect Ratio: 3:2\r\n", "3 2 ~m"), [3000.0, 2000.0]);
    assert_eq!(stopped(high_scan, "\\Aspect Ratio: 3:2\r\n", "3 3 ~m"), [3000.0, 2000.0]);
    assert_eq!(stopped(high_scan, "\\Aspect Ratio: 3:2\r\n", "3 4 ~m"), [3000.0, 2000.0]);
    // Cells of a square scan need not be square.
    assert_eq!(stopped("", "\\Aspect Ratio: 1:1\r\n", "3 3 ~m"), [3000.0, 3000.0]);
    // What contradicts itself is asked for.
    for (scan, aspect) in
        [("\\Aspect Ratio: 3:2\r\n", "\\Aspect Ratio: 1:1\r\n"), ("", "\\Aspect Ratio: 8:1\r\n")]
    {
        let error =
            read_bytes(&Nanoscope { scan, aspect, ..square }.file(), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("3 x 2 points; give the lengths"), "{error}");
    }
}

#[test]
fn nanoscope_channels_have_names_labels_and_numbers() {
    let file = Nanoscope::default().file();
    for name in ["ZSensor", "zsensor", "Height Sensor", "1"] {
        assert_eq!(channel(&file, name).unwrap().heights, read(&file).heights, "{name}");
    }
    // A deflection is a length, but not the default.
    assert!((channel(&file, "0").unwrap().heights[[0, 0]] - 110.0 * 15.0 * NM).abs() < 1e-18);
    let error = channel(&file, "Phase").unwrap_err().to_string();
    assert!(error.contains("Phase") && error.contains('\u{ba}'), "{error}");
    let error = channel(&file, "Current").unwrap_err().to_string();
    assert!(error.contains("1: \"ZSensor\""), "{error}");
}

#[test]
fn nanoscope_files_without_a_map_are_refused_by_name() {
    let file = String::from_utf8_lossy(&Nanoscope::default().file()).into_owned();
    for (from, to, word) in [
        ("OL2", "FOL", "force curves"),
        ("\\*File list\r", "\\*Force file list\r", "force curves"),
        ("\\*File list\r", "?*File list\r", "written as text"),
        ("@2:Z scale", "Z scale", "before version 4.3"),
        ("\\Data length: 12", "\\Data length: 11", "truncated"),
        ("\\Bytes/pixel: 2", "\\Bytes/pixel: 3", "2 or 4"),
    ] {
        let error =
            read_bytes(file.replace(from, to).as_bytes(), &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(word), "{from} -> {to}: {error}");
    }
}

#[test]
fn metropro_phases_are_scaled_by_the_wavelength() {
    let pixel = 2f64.powi(-20);
    let unit = 2f64.powi(-33);
    for long_header in [false, true] {
        let surface = read(&instruments::metropro(0, long_header));
        assert_map(&surface, Format::MetroPro, [unit, 0.0], [3.0 * pixel, 2.0 * pixel], true);
        assert!(surface.metadata.contains(&("Objective".into(), "20X Mirau".into())));
    }
    assert_eq!(read(&instruments::metropro(1, false)).heights[[0, 0]], -10.0 * unit);
    let mut uncalibrated = instruments::metropro(0, false);
    uncalibrated[184..188].fill(0);
    let error = read_bytes(&uncalibrated, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingSize { .. }), "{error}");
    // Twice as fine: resolution 1 instead of 0 means 32768 steps.
    let mut fine = instruments::metropro(0, false);
    fine[219] = 1;
    assert_eq!(read(&fine).heights[[0, 0]], 10.0 * unit / 8.0);
}

#[test]
fn plu_has_layers_and_no_other_kind_is_taken_for_a_surface() {
    let file = instruments::plu(3);
    assert_map(&read(&file), Format::Plu, [UM, 0.0], [6.0 * UM, 6.0 * UM], true);
    assert_eq!(read(&file).channels, ["layer0", "layer1"]);
    assert_map(&channel(&file, "layer1").unwrap(), Format::Plu, [2.0 * UM, 0.0], [6.0 * UM, 6.0 * UM], true);
    let error = read_bytes(&instruments::plu(1), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("a profile"), "{error}");
}

#[test]
fn mnt_is_unpacked_from_its_document_and_masked() {
    for masked in [false, true] {
        let surface = read(&instruments::mnt(masked));
        assert_map(&surface, Format::Mnt, [0.25 * UM, 5.0 * UM], [6.0 * UM, 6.0 * UM], masked);
        assert_eq!(surface.channels, ["Steel"]);
        assert!(surface.metadata.contains(&("Title".into(), "Steel, ground".into())));
    }
    let other = instruments::compound("WordDocument", &[0; 5000]);
    let error = read_bytes(&other, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::Foreign { .. }), "{error}");
}

#[test]
fn igor_waves_of_both_orders_have_layers_with_units_of_their_own() {
    for big in [false, true] {
        let file = instruments::ibw(big, true);
        let surface = read(&file);
        assert_eq!(surface.channels, ["DeflectionRetrace", "HeightRetrace", "PhaseRetrace"]);
        assert_eq!(surface.channel.as_deref(), Some("HeightRetrace"));
        assert_map(&surface, Format::Ibw, [1.0, 0.0], [3e-6, 4e-6], true);
        let error = channel(&file, "PhaseRetrace").unwrap_err().to_string();
        assert!(error.contains("deg"), "{error}");
        assert_eq!(channel(&file, "0").unwrap().heights[[0, 0]], 110.0);
        // Bare numbers: one unit for the lengths and the heights.
        let bare = instruments::ibw(big, false);
        let error = read_bytes(&bare, &ReadOptions::default()).unwrap_err();
        assert!(matches!(error.problem, Problem::MissingHeightUnit { .. }), "{error}");
        let options = ReadOptions { height_unit: Some(UM), ..Default::default() };
        assert_map(&read_bytes(&bare, &options).unwrap(), Format::Ibw, [UM, 0.0], [3e-12, 4e-12], true);
    }
}

#[test]
fn nanosurf_numbers_span_the_range_of_their_data_set() {
    for signed in [true, false] {
        let file = instruments::nid(signed);
        let surface = read(&file);
        assert_eq!(surface.channels, ["Scan forward (Deflection)", "Scan forward (Z-Axis)"]);
        assert_map(&surface, Format::Nid, [0.5 * UM, 0.0], [3.0 * UM, 2.0 * UM], false);
        assert!(surface.metadata.contains(&("Image size".into(), "3\u{b5}m".into())));
        let error = channel(&file, "0").unwrap_err().to_string();
        assert!(error.contains("\"N\""), "{error}");
    }
}

#[test]
fn frt_is_read_in_both_versions_with_its_images() {
    for wide in [false, true] {
        let file = instruments::frt(wide);
        let surface = read(&file);
        assert_map(&surface, Format::Frt, [0.25 * UM, 0.0], [6.0 * UM, 4.0 * UM], true);
        assert_eq!(surface.channels, ["default", "Thickness (top sensor) 1"]);
        assert_map(&channel(&file, "1").unwrap(), Format::Frt, [0.5 * UM, 0.0], [6.0 * UM, 4.0 * UM], true);
    }
}

#[test]
fn a_format_that_is_not_read_is_named_with_its_instrument_and_a_way() {
    let member = |name| zip(&[(name, vec![0; 10])]);
    let plux = zip(&[("index.xml", vec![0; 10]), ("LAYER_0.raw", vec![0; 10])]);
    let files: [(&str, Vec<u8>); 9] = [
        ("Keyence VK4", b"VK4_\0\0\0\0".to_vec()),
        ("Keyence ZON", b"KPK0\0\0\0\0".to_vec()),
        ("Sensofar PLUX", plux),
        ("Bruker OPDx", b"VCA DATA\x01\0\0\x55".to_vec()),
        ("JPK", b"II*\0\x08\0\0\0jpk-data-file".to_vec()),
        ("Olympus LEXT", b"II*\0\x08\0\0\0<TiffTagDescData>".to_vec()),
        ("Olympus POIR", member("matlmeasurement.xml")),
        ("NT-MDT", b"\x01\xb0\x93\xff\0\0".to_vec()),
        ("zip archive", member("readme")),
    ];
    for (name, bytes) in files {
        for bytes in [gzip(&bytes), bytes] {
            let error = read_bytes(&bytes, &ReadOptions::default()).unwrap_err();
            assert!(matches!(error.problem, Problem::Foreign { .. }), "{name}: {error}");
            let error = error.to_string();
            assert!(error.contains(name) && error.contains("export"), "{error}");
        }
    }
}

#[test]
fn numbers_in_two_or_three_columns_are_refused_with_a_way_that_works() {
    let read = |text: String| {
        let options = ReadOptions { size: Some([1.0; 2]), height_unit: Some(1.0), ..Default::default() };
        read_bytes(text.as_bytes(), &options)
    };
    for matrix in ["1 2\n3 4\n5 6\n", "1 2 3\n1 2 6\n7 8 9\n"] {
        let error = read(matrix.into()).unwrap_err().to_string();
        assert!(error.contains("# Width:") && !error.contains("format"), "{error}");
        assert!(read(format!("# Width: 2 um\n{matrix}")).is_ok(), "what the message says works");
    }
    for line in ["1 2 3 4 5\n", "1\n2\n3\n"] {
        let error = read(line.into()).unwrap_err().to_string();
        assert!(error.contains("a profile") && error.contains("2 lines"), "{error}");
    }
}

/// A TIFF with the tags of its first directory, in either byte order.
fn tiff(big: bool, tags: &[u16], rest: &[u8]) -> Vec<u8> {
    let short = |n: u16| if big { n.to_be_bytes() } else { n.to_le_bytes() };
    let long = |n: u32| if big { n.to_be_bytes() } else { n.to_le_bytes() };
    let mut bytes = if big { b"MM\0*".to_vec() } else { b"II*\0".to_vec() };
    bytes.extend(long(8));
    bytes.extend(short(tags.len() as u16));
    for tag in tags {
        bytes.extend(short(*tag));
        bytes.extend([0; 10]);
    }
    bytes.extend(long(0));
    bytes.extend(rest);
    bytes
}

#[test]
fn pictures_and_containers_are_called_by_their_tags() {
    let all: Vec<u8> = (0..=u16::MAX).flat_map(u16::to_le_bytes).collect();
    for big in [false, true] {
        for (tags, name) in [
            (&[256, 257, 0x8000, 0x8001, 0x8030][..], "JPK TIFF"),
            (&[256, 257, 50432, 50433, 50434][..], "Park Systems TIFF"),
            (&[256, 257, 273][..], "format is not read: TIFF"),
        ] {
            // The numbers of a picture may be those of any tag.
            let error = read_bytes(&tiff(big, tags, &all), &ReadOptions::default()).unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
        }
    }
    let error = read_bytes(b"", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("the file is empty"), "{error}");
    // The names of the groups of JPK's fast scans.
    let mut jpk = crate::samples::hdf5();
    jpk.extend(b"Measurement_000 Channel_000");
    let error = read_bytes(&jpk, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("JPK HDF5"), "{error}");
}
