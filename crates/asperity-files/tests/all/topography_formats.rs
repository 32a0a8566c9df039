//! Formats against files built by hand after their descriptions: orientation, scale, unit, undefined points and the
//! choice of a channel.

use crate::samples::{NUMBERS, Sur, X3p};
use asperity_files::topography::{Format, Problem, ReadOptions, Topography, read_bytes};

const UM: f64 = 1e-6;
const NM: f64 = 1e-9;

fn read(bytes: &[u8]) -> Topography {
    read_bytes(bytes, &ReadOptions::default()).unwrap()
}

fn channel(bytes: &[u8], name: &str) -> Topography {
    read_bytes(bytes, &ReadOptions { channel: Some(name.into()), ..Default::default() }).unwrap()
}

/// Heights `unit` times the numbers of the samples at their places, the number 60 undefined where said; equal up to
/// the roundings of a few products.
fn assert_map(surface: &Topography, format: Format, unit: f64, size: [f64; 2], last_undefined: bool) {
    assert_eq!(surface.format, format);
    assert_eq!(surface.heights.dim(), (3, 2));
    assert!(surface.heights.is_standard_layout());
    for ((x, y), h) in surface.heights.indexed_iter() {
        let expected = f64::from(NUMBERS[3 * y + x]) * unit;
        if last_undefined && (x, y) == (2, 1) {
            assert!(h.is_nan(), "{format}: the last point is {h:e}");
        } else {
            assert!(
                (h - expected).abs() <= 1e-12 * expected.abs(),
                "{format}: {h:e} at ({x}, {y}), not {expected:e}"
            );
        }
    }
    for (found, expected) in surface.size.iter().zip(size) {
        // Binary32 spacings in some formats.
        assert!((found / expected - 1.0).abs() < 1e-7, "{format}: size {found:e}, not {expected:e}");
    }
}

#[test]
fn sur_is_read_plain_and_packed() {
    let size = [6e-3, 6e-3];
    for bits in [16, 32] {
        for packed in [false, true] {
            let surface = read(&Sur { bits, packed, ..Sur::default() }.bytes());
            assert_map(&surface, Format::Sur, 0.25 * UM, size, false);
            assert_eq!(surface.channel.as_deref(), Some("sample"));
            assert!(surface.metadata.contains(&("comment".into(), "comment".into())));
            assert!(surface.metadata.contains(&("date".into(), "2026-05-04 03:02:01".into())));
        }
    }
    // Points that were not measured have the least height minus 2.
    let numbers = [10, 20, 30, 40, 50, 8];
    let holes = Sur { numbers, special: true, ..Sur::default() };
    assert_map(&read(&holes.bytes()), Format::Sur, 0.25 * UM, size, true);
    let no_holes = read(&Sur { special: false, ..holes }.bytes());
    assert_eq!(no_holes.heights[[2, 1]], 2.0 * UM);
}

#[test]
fn the_inversion_of_sur_is_undone() {
    let inverted = |inversion| read(&Sur { inversion, ..Sur::default() }.bytes()).heights / (-0.25 * UM);
    assert_eq!(inverted(1)[[0, 0]].round(), 10.0);
    assert_eq!(inverted(2)[[0, 0]].round(), 30.0);
    assert_eq!(inverted(3)[[0, 0]].round(), 40.0);
}

#[test]
fn the_offset_of_sur_counts_on_an_absolute_axis_only() {
    let height = |absolute| read(&Sur { absolute, offset: 5.0, ..Sur::default() }.bytes()).heights[[0, 0]];
    assert!((height(false) - 2.5 * UM).abs() < 1e-18);
    assert!((height(true) - 7.5 * UM).abs() < 1e-18);
}

#[test]
fn a_sur_file_of_several_objects_has_channels() {
    let series = Sur { kind: 5, objects: 2, ..Sur::default() };
    let second = Sur { numbers: NUMBERS.map(|n| 2 * n), ..series.clone() };
    let bytes = [series.bytes(), second.bytes()].concat();
    assert_eq!(read(&bytes).channels, ["sample 0", "sample 1"]);
    assert_map(&read(&bytes), Format::Sur, 0.25 * UM, [6e-3, 6e-3], false);
    assert_map(&channel(&bytes, "1"), Format::Sur, 0.5 * UM, [6e-3, 6e-3], false);
    // A surface with its image: the image is no channel.
    let surface = Sur { kind: 11, objects: 2, ..Sur::default() };
    let image = Sur { kind: 10, name: "image", ..Sur::default() };
    assert_eq!(read(&[surface.bytes(), image.bytes()].concat()).channels, ["sample"]);
    // An image alone is no surface.
    let error = read_bytes(&image.bytes(), &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::NoHeights { .. }), "{error}");
}

#[test]
fn al3d_lines_are_padded_and_the_invalid_value_is_undefined() {
    let surface = read(&crate::samples::al3d());
    assert_map(&surface, Format::Al3d, 1.0, [1.5e-6, 0.5e-6], true);
    assert!(surface.metadata.contains(&("Comment".into(), "a comment".into())));
}

#[test]
fn opd_is_turned_and_scaled_by_the_wavelength() {
    for (width, has_mark) in [(1, false), (2, true), (4, true)] {
        let surface = read(&crate::samples::opd(width));
        // Pixel_size and Aspect are binary32.
        assert_map(&surface, Format::Opd, 300.0 * NM, [30e-6, 10e-6], has_mark);
        assert_eq!(surface.channels, ["RAW_DATA"]);
        assert!(surface.metadata.contains(&("Title".into(), "some steel".into())));
    }
}

#[test]
fn bcr_is_read_in_both_widths() {
    // "bit2nm" scales integers to the unit of the heights.
    assert_map(&read(&crate::samples::bcr(false)), Format::Bcr, 0.5e-12, [6e-6, 4e-6], true);
    assert_map(&read(&crate::samples::bcr(true)), Format::Bcr, 1e-12, [6e-6, 4e-6], true);
}

#[test]
fn sdf_is_read_as_text_and_as_binary_of_every_type() {
    let size = [3e-6, 4e-6];
    assert_map(&read(&crate::samples::sdf_text()), Format::Sdf, NM, size, true);
    for data_type in 0..8 {
        let surface = read(&crate::samples::sdf_binary(data_type));
        assert_map(&surface, Format::Sdf, NM, size, data_type != 0);
        assert!(surface.metadata.contains(&("ManufacID".into(), "maker".into())));
    }
    let mut packed = crate::samples::sdf_binary(7);
    packed[8 + 10 + 24 + 4 + 32] = 1;
    let error = read_bytes(&packed, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::Unsupported { .. }), "{error}");
}

#[test]
fn x3p_is_read_masked_as_a_list_and_in_layers() {
    let size = [3e-6, 4e-6];
    let masked = read(&crate::samples::x3p(X3p::Masked));
    // The offset of -10 nm makes the first height 0.
    assert_eq!(
        masked.heights.map(|h| (h / NM).round()).into_raw_vec_and_offset().0[..5],
        [0., 30., 10., 40., 20.]
    );
    assert!(masked.heights[[2, 1]].is_nan());
    assert!(masked.metadata.contains(&("Comment".into(), "3 < 4 & 5".into())));
    assert_map(&read(&crate::samples::x3p(X3p::List)), Format::X3p, NM, size, true);
    let layers = crate::samples::x3p(X3p::Layers);
    assert_map(&read(&layers), Format::X3p, NM, size, false);
    assert_map(&channel(&layers, "layer 1"), Format::X3p, 2.0 * NM, size, false);
}

/// The members of an X3P file of 2 x 2 points below a folder: heights of 1, 2, 3, 4 um as `points`.
fn x3p_members(folder: &str, axis: &str, points: Vec<u8>, link: &str) -> Vec<u8> {
    let xml = format!(
        "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><FeatureType>SUR</FeatureType><Axes>\
         <CX><AxisType>I</AxisType><Increment>1e-6</Increment></CX><CY><AxisType>I</AxisType><Increment>1e-6</Increment></CY>\
         <CZ>{axis}</CZ></Axes></Record1><Record3><MatrixDimension><SizeX>2</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
         <DataLink><PointDataLink>{link}</PointDataLink></DataLink></Record3></p:ISO5436_2>"
    );
    let names = [format!("{folder}main.xml"), format!("{folder}bindata/data.bin")];
    crate::samples::zip(&[(names[0].as_str(), xml.into_bytes()), (names[1].as_str(), points)])
}

/// The schema: "Increment: needed for incremental axis and integer data types".
#[test]
fn heights_of_x3p_are_multiplied_by_an_increment_only_where_they_count_it() {
    let doubles = |unit: f64| [1.0, 2.0, 3.0, 4.0].map(|n: f64| (n * unit).to_le_bytes()).concat();
    let floats = |unit: f32| [1.0, 2.0, 3.0, 4.0].map(|n: f32| (n * unit).to_le_bytes()).concat();
    let ints = || [1i32, 2, 3, 4].map(i32::to_le_bytes).concat();
    let shorts = || [1i16, 2, 3, 4].map(i16::to_le_bytes).concat();
    let axis = |kind: &str, data: &str, rest: &str| {
        format!("<AxisType>{kind}</AxisType><DataType>{data}</DataType>{rest}")
    };
    let step = "<Increment>1e-6</Increment><Offset>0</Offset>";
    for (axis, points) in [
        (axis("A", "D", step), doubles(1e-6)),
        (axis("A", "F", step), floats(1e-6)),
        (axis("A", "D", "<Increment>0</Increment>"), doubles(1e-6)),
        (axis("A", "D", ""), doubles(1e-6)),
        (axis("A", "L", step), ints()),
        (axis("A", "I", step), shorts()),
        (axis("I", "L", step), ints()),
        (axis("I", "D", step), doubles(1.0)),
    ] {
        let surface = read(&x3p_members("", &axis, points, "bindata/data.bin"));
        for (h, wanted) in surface.heights.iter().zip([1e-6, 3e-6, 2e-6, 4e-6]) {
            // Seven digits of binary32.
            assert!((h / wanted - 1.0).abs() < 1e-6, "{axis}: {h:e}");
        }
    }
}

#[test]
fn an_x3p_archive_may_hold_its_folder() {
    let axis = "<AxisType>A</AxisType><DataType>D</DataType>";
    let points = || [1e-6, 2e-6, 3e-6, 4e-6].map(f64::to_le_bytes).concat();
    let plain = read(&x3p_members("", axis, points(), "bindata/data.bin"));
    for (folder, link) in [
        ("scan/", "bindata/data.bin"),
        ("a/b c/", "bindata/data.bin"),
        ("scan\\", "bindata/data.bin"),
        ("scan/", "bindata\\data.bin"),
        ("", "./bindata/data.bin"),
        ("scan/", "/bindata/data.bin"),
        ("", "bindata/DATA.bin"),
    ] {
        let surface = read(&x3p_members(folder, axis, points(), link));
        assert_eq!((surface.format, &surface.heights), (Format::X3p, &plain.heights), "{folder} {link}");
    }
    let two = crate::samples::zip(&[("a/main.xml", b"<a/>".to_vec()), ("b/main.xml", b"<a/>".to_vec())]);
    let error = read_bytes(&two, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("2 folders (a/, b/)"), "{error}");
}

#[test]
fn gwy_channels_of_heights_come_in_their_order_with_units_and_masks() {
    let bytes = crate::samples::gwy();
    let surface = read(&bytes);
    // The amplitude is the first channel, but no height.
    assert_eq!(surface.channels, ["Amplitude", "Height", "Height (back)"]);
    assert_map(&surface, Format::Gwy, NM, [6e-6, 4e-6], true);
    assert_eq!(surface.metadata, [("Tip".to_owned(), "sharp".to_owned())]);
    assert_map(&channel(&bytes, "height (BACK)"), Format::Gwy, 10.0 * NM, [6e-6, 4e-6], false);
    assert_map(&channel(&bytes, "2"), Format::Gwy, 10.0 * NM, [6e-6, 4e-6], false);
    let wanted = |name: &str| ReadOptions { channel: Some(name.into()), ..Default::default() };
    let error = read_bytes(&bytes, &wanted("Current")).unwrap_err().to_string();
    assert!(error.contains("\"Current\"") && error.contains("2: \"Height (back)\""), "{error}");
    let error = read_bytes(&bytes, &wanted("Amplitude")).unwrap_err().to_string();
    assert!(error.contains("\"Amplitude\"") && error.contains("\"V\""), "{error}");
}

#[test]
fn a_gwy_file_of_currents_asks_for_the_unit_of_heights() {
    let field = crate::samples::gwy_field(NUMBERS.map(f64::from), "m", "A");
    let container =
        crate::samples::gwy_object("GwyContainer", &crate::samples::gwy_component("/0/data", b'o', &field));
    let bytes = [b"GWYP", &container[..]].concat();
    let error = read_bytes(&bytes, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingHeightUnit { .. }), "{error}");
    assert!(error.to_string().contains("\"A\"") && error.to_string().contains("--height-unit"), "{error}");
    let surface = read_bytes(&bytes, &ReadOptions { height_unit: Some(2.0), ..Default::default() }).unwrap();
    assert_map(&surface, Format::Gwy, 2.0, [6.0, 4.0], false);
}

/// (4 x + y)^2, the numbers of the files in tests/data.
fn square(x: usize, y: usize) -> f64 {
    ((4 * x + y) as f64).powi(2)
}

#[test]
fn netcdf_4_of_the_reference_library_is_read() {
    let surface = read(&crate::samples::netcdf4());
    assert_eq!((surface.format, surface.heights.dim()), (Format::NetCdf, (5, 4)));
    assert_eq!(surface.size, [10.0 * UM, 6.0 * UM]);
    assert_eq!(surface.undefined(), 1);
    for ((x, y), h) in surface.heights.indexed_iter() {
        if (x, y) == (0, 3) {
            assert!(h.is_nan());
        } else {
            assert_eq!(*h, square(x, y) * UM);
        }
    }
    assert!(surface.metadata.iter().any(|(key, value)| key == "json" && value.contains("AFM")));
}

#[test]
fn any_map_of_an_hdf5_file_is_a_channel() {
    let bytes = crate::samples::hdf5();
    let options = |channel: Option<&str>| ReadOptions {
        size: Some([1.0, 2.0]),
        height_unit: Some(NM),
        channel: channel.map(Into::into),
        format: None,
    };
    let surface = read_bytes(&bytes, &options(None)).unwrap();
    assert_eq!(surface.format, Format::Hdf5);
    assert_eq!(surface.channels, ["surface", "group/other"]);
    assert!(surface.heights.indexed_iter().all(|((x, y), h)| *h == square(x, y) * NM));
    let other = read_bytes(&bytes, &options(Some("group/other"))).unwrap();
    assert!(other.heights.indexed_iter().all(|((x, y), h)| *h == 2.0 * square(x, y) * NM));
    let error =
        read_bytes(&bytes, &ReadOptions { size: Some([1.0, 2.0]), ..Default::default() }).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingHeightUnit { .. }), "{error}");
}

#[test]
fn any_file_may_be_packed_by_gzip() {
    assert_map(&read(&crate::samples::gzip(&crate::samples::gwy())), Format::Gwy, NM, [6e-6, 4e-6], true);
    assert_map(
        &read(&crate::samples::gzip(&crate::samples::sdf_text())),
        Format::Sdf,
        NM,
        [3e-6, 4e-6],
        true,
    );
}

#[test]
fn the_caller_replaces_what_the_file_says() {
    let options = ReadOptions { size: Some([1.0, 2.0]), height_unit: Some(1e-3), ..Default::default() };
    let surface = read_bytes(&crate::samples::gwy(), &options).unwrap();
    assert_map(&surface, Format::Gwy, 1e-3, [1.0, 2.0], true);
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        let options = ReadOptions { height_unit: Some(bad), ..Default::default() };
        let error = read_bytes(&crate::samples::gwy(), &options).unwrap_err();
        assert!(matches!(error.problem, Problem::Option { .. }), "{error}");
        let options = ReadOptions { size: Some([1.0, bad]), ..Default::default() };
        let error = read_bytes(&crate::samples::gwy(), &options).unwrap_err();
        assert!(matches!(error.problem, Problem::Option { .. }), "{error}");
    }
}

#[test]
fn a_gwyddion_simple_field_is_read_with_its_units() {
    let file = crate::samples::gsf();
    let surface = read(&file);
    assert_map(&surface, Format::Gsf, NM, [6e-6, 4e-6], true);
    assert_eq!(surface.channel.as_deref(), Some("Topography"));
    // The lengths have a default of 1 without a unit, which says nothing.
    let text = String::from_utf8_lossy(&file[..file.iter().position(|b| *b == 0).unwrap()]).into_owned();
    let mut bare = text.replace("XReal", "Xreal-").into_bytes();
    bare.resize(bare.len() / 4 * 4 + 4, 0);
    bare.extend(NUMBERS.iter().flat_map(|n| (*n as f32).to_le_bytes()));
    let error = read_bytes(&bare, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingSize { format: Format::Gsf, .. }), "{error}");
    let error = read_bytes(text.as_bytes(), &ReadOptions::default()).unwrap_err();
    assert!(matches!(error.problem, Problem::Malformed { .. }), "{error}");
}
