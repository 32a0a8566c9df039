//! Text files as programs and people write them: headers, separators, decimal marks, lists of points.

use asperity_files::topography::{
    Format, Problem, ReadOptions, Topography, TopographyError, detect, profile_of, read_bytes, read_profile,
};
use ndarray::{Array2, array};

const UM: f64 = 1e-6;
const NM: f64 = 1e-9;

/// Heights \[nm\] of the matrices below: axis 0 = x runs along a line.
fn heights() -> Array2<f64> {
    array![[1.0, 4.0], [2.5, f64::NAN], [-3.0, 6e3]]
}

fn read(text: &str) -> Result<Topography, TopographyError> {
    read_bytes(text.as_bytes(), &ReadOptions::default())
}

fn with(text: &str, size: Option<[f64; 2]>, height_unit: Option<f64>) -> Result<Topography, TopographyError> {
    read_bytes(text.as_bytes(), &ReadOptions { size, height_unit, ..Default::default() })
}

/// Equal up to the rounding of the unit.
fn assert_heights(surface: &Topography, expected: &Array2<f64>, unit: f64) {
    assert_eq!(surface.heights.dim(), expected.dim());
    for (h, e) in surface.heights.iter().zip(expected) {
        assert!(
            (h.is_nan() && e.is_nan()) || (h - e * unit).abs() <= 1e-15 * unit * e.abs(),
            "{h:e} for {e} units"
        );
    }
}

fn assert_size(surface: &Topography, expected: [f64; 2]) {
    for (length, expected) in surface.size.iter().zip(expected) {
        assert!((length / expected - 1.0).abs() < 1e-14, "{length:e} m, not {expected:e} m");
    }
}

#[test]
fn a_matrix_is_read_with_every_separator_and_decimal_mark() {
    for text in [
        "1 2.5 -3\n4 nan 6e3\n",
        "1\t2.5\t-3\r\n4\tBAD\t6.0E+003\r\n",
        "1,2.5,-3\n4,,6e3\n",
        "1, 2.5, -3,\n4, NaN, 6e3,\n",
        "1;2,5;-3;\n4;;6000;\n",
        "1,0 2,5 -3,0\n4,0 --- 6e3",
        "\n# a remark\n\n  1   2.5   -3  \n\n  4   ***   6D3  \n\n",
    ] {
        // Three columns without a header could be points.
        let options = ReadOptions {
            size: Some([3e-6, 2e-6]),
            height_unit: Some(NM),
            format: Some(Format::Text),
            ..Default::default()
        };
        let surface = read_bytes(text.as_bytes(), &options).unwrap_or_else(|e| panic!("{text:?}: {e}"));
        assert_heights(&surface, &heights(), NM);
        assert_size(&surface, [3e-6, 2e-6]);
    }
}

#[test]
fn gwyddion_headers_are_understood_in_any_language() {
    for header in [
        "# Channel: Z\n# Width: 3.00 µm\n# Height: 2000 nm\n# Value units: nm\n",
        "# Kanal: Z\n# Breite: 3,00 µm\n# Höhe: 2000,0 nm\n# Einheiten: nm\n",
        "# Canal : Z\r\n# Largeur : 3,00 µm\r\n# Hauteur : 2,00 µm\r\n# Unités : nm\r\n",
        "# チャネル： Z\n# 幅： 3.00 µm\n# 高さ： 2.00 µm\n# 値の単位： nm\n",
        // No label of this language is known: the order tells.
        "# Kanava: Z\n# Leveys: 3,00 μm\n# Korkeus: 2,00 μm\n# Arvojen yksiköt: nm\n",
    ] {
        let text = format!("{header}1 2.5 -3\n4 nan 6e3\n");
        let utf16: Vec<u8> =
            [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
        for bytes in [text.as_bytes(), &utf16, format!("\u{feff}{text}").as_bytes()] {
            let surface =
                read_bytes(bytes, &ReadOptions::default()).unwrap_or_else(|e| panic!("{header}: {e}"));
            assert_heights(&surface, &heights(), NM);
            assert_size(&surface, [3.0 * UM, 2.0 * UM]);
            assert_eq!((surface.format, surface.channel.as_deref()), (Format::Text, Some("Z")));
        }
    }
}

#[test]
fn headers_of_other_programs_are_understood() {
    let body = "1 2.5 -3\n4 nan 6e3\n";
    let spip = "# File Format = ASCII\n# Created by SPIP\n# x-pixels = 3\n# y-pixels = 2\n# x-length = 3000\n\
                # y-length = 2000\n# Bit2nm = 0.5\n# Start of Data:\n";
    let surface = read(&format!("{spip}{body}")).unwrap();
    assert_heights(&surface, &heights(), 0.5 * NM);
    assert_size(&surface, [3.0 * UM, 2.0 * UM]);

    let nova = "File Format = ASCII\nNX = 3\nNY = 2\nScale X = 0.5\nScale Y = 0.25\nUnit X = um\nUnit Y = um\nUnit Data = nm\n";
    let surface = read(&format!("{nova}{body}")).unwrap();
    assert_heights(&surface, &heights(), NM);
    assert_size(&surface, [1.5 * UM, 0.5 * UM]);

    let interferometer =
        "h=2 w=3\npixel size=1.0e-006 m\ndata unit=rad\nheight conversion factor (-> m)=2.0e-008\n";
    let surface = read(&format!("{interferometer}{body}")).unwrap();
    assert_heights(&surface, &heights(), 2e-8);
    assert_size(&surface, [3.0 * UM, 2.0 * UM]);

    // A line of the file is one position along Wyko's "X": heights in wavelengths / Mult, pixels in mm.
    let wyko = "Wyko ASCII Data File Format\t0\t0\t1\nX Size\t2\nY Size\t3\nBlock Name\tType\tLength\tValue\n\
                Wavelength\t7\t4\t600\nAspect\t7\t4\t0.5\nPixel_size\t7\t4\t0.001\nMult\t6\t2\t3\nRAW_DATA\t3\t24\n";
    let surface = read(&format!("{wyko}{body}")).unwrap();
    assert_heights(&surface, &heights(), 200.0 * NM);
    assert_size(&surface, [1.5 * UM, 2.0 * UM]);
    assert_eq!(surface.channel.as_deref(), Some("RAW_DATA"));

    // The header counts the points: a truncated file is found out.
    let error = read(&format!("{nova}1 2 3\n")).unwrap_err();
    assert!(matches!(error.problem, Problem::NoHeights { .. }), "{error}");
    let error = read(&format!("{nova}{body}1 2 3\n")).unwrap_err().to_string();
    assert!(
        error.contains("number of points along y is 3") && error.contains("2 as its header says"),
        "{error}"
    );
}

#[test]
fn a_file_of_several_images_has_channels() {
    let block = |name: &str, width: &str, unit: &str, numbers: &str| {
        format!(
            "# Channel: {name}\n# Width: {width} µm\n# Height: 2 µm\n# Value units: {unit}\n{numbers}\n\n"
        )
    };
    let text = block("Topo", "3", "nm", "1 2.5 -3\n4 nan 6e3")
        + &block("Phase", "3", "deg", "9 9 9\n9 9 9")
        + &block("Back", "6", "um", "1 2.5 -3\n4 nan 6e3");
    let surface = read(&text).unwrap();
    assert_eq!(surface.channels, ["Topo", "Back"]);
    assert_heights(&surface, &heights(), NM);
    let back = ReadOptions { channel: Some("back".into()), ..Default::default() };
    let surface = read_bytes(text.as_bytes(), &back).unwrap();
    assert_heights(&surface, &heights(), UM);
    assert_size(&surface, [6.0 * UM, 2.0 * UM]);
    // A phase alone is no height.
    let error = read(&block("Phase", "3", "deg", "9 9 9\n9 9 9")).unwrap_err().to_string();
    assert!(
        error.contains("\"deg\"") && error.contains("\"Phase\"") && error.contains("--height-unit"),
        "{error}"
    );
}

#[test]
fn what_the_file_does_not_say_is_asked_for() {
    let text = "1 2 3 4\n5 6 7 8\n";
    let error = read(text).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingSizeAndHeightUnit { .. }), "{error}");
    assert!(error.to_string().contains("--size '100 um, 100 um' --height-unit nm"), "{error}");
    let error = with(text, Some([1.0, 1.0]), None).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingHeightUnit { .. }), "{error}");
    let error = with(text, None, Some(NM)).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingSize { .. }), "{error}");
    assert!(with(text, Some([1.0, 1.0]), Some(NM)).is_ok());
    // An ampere is not an ångström.
    let error =
        read("# Channel: I\n# Width: 3 um\n# Height: 2 um\n# Value units: A\n1 2\n3 4\n").unwrap_err();
    assert!(matches!(error.problem, Problem::MissingHeightUnit { .. }), "{error}");
}

#[test]
fn what_could_be_read_in_two_ways_is_refused() {
    for (text, why) in [
        ("1,5, 2,5\n3,5, 4,5\n", "commas"),
        ("1 2\n3 4\n5 6\n", "profile"),
        ("1\n2\n3\n", "profile"),
        ("1 2 3\n7 7 9\n4 1 2\n0 9 9.5\n", "# Width:"),
        ("0 0 1\n0 0 2\n1 1 3\n", "again at x = 0, y = 0"),
        ("1 2 3 4\n5 6 7\n", "line 2"),
        ("1 2 3 4\n5 6 seven 8\n", "\"seven\""),
    ] {
        let error = with(text, Some([1.0, 1.0]), Some(1.0)).unwrap_err().to_string();
        assert!(error.contains(why), "{text:?}: {error}");
    }
    // Where the caller says that it is a matrix, it is.
    let options = ReadOptions {
        size: Some([1.0, 1.0]),
        height_unit: Some(1.0),
        format: Some(Format::Text),
        ..Default::default()
    };
    assert_eq!(read_bytes(b"1 2\n3 4\n5 6\n", &options).unwrap().heights.dim(), (2, 3));
    assert_eq!(read_bytes(b"1 2 3\n7 7 9\n", &options).unwrap().heights.dim(), (3, 2));
}

#[test]
fn points_come_in_any_order_and_may_be_missing() {
    // Heights [nm] at x = 10, 10.5, 11, 11.5 um and y = -1, 1, 3 um; the point (11, 1) is missing.
    let expected = array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, f64::NAN, 9.0], [10.0, 11.0, 12.0]];
    let mut points = Vec::new();
    for ((i, j), h) in expected.indexed_iter().filter(|(_, h)| !h.is_nan()) {
        points.push((10.0 + 0.5 * i as f64, -1.0 + 2.0 * j as f64, *h));
    }
    // Every fourth, then the next of them: neither sorted by x nor by y.
    let shuffled: Vec<_> = (0..4).flat_map(|k| points.iter().skip(k).step_by(4)).collect();
    let size = [4.0 * 0.5 * UM, 3.0 * 2.0 * UM];
    let list = |separator: &str, factor: f64| -> String {
        shuffled.iter().map(|(x, y, h)| format!("{x}{separator}{y}{separator}{}\n", h * factor)).collect()
    };
    for (header, body) in [
        ("X [µm]\tY [µm]\tZ [nm]\n", list("\t", 1.0)),
        ("\"x (um)\",\"y (um)\",\"height (um)\"\n", list(",", 1e-3)),
        ("x;y;z\nµm;µm;nm\n", list(";", 1.0).replace('.', ",")),
        ("# Channel: Z\n# Lateral units: µm\n# Value units: nm\n", list(" ", 1.0)),
        ("# Kanava: Z\n# Sivusuunta: µm\n# Arvot: nm\n", list(" ", 1.0)),
    ] {
        let surface = read(&format!("{header}{body}")).unwrap_or_else(|e| panic!("{header}: {e}"));
        assert_eq!(surface.format, Format::Xyz);
        for (h, e) in surface.heights.iter().zip(&expected) {
            // A decimal number of micrometres and the rounding of the unit.
            assert!((h.is_nan() && e.is_nan()) || (h - e * NM).abs() < 1e-15 * UM, "{header}: {h:e}");
        }
        assert_size(&surface, size);
    }
    // One unit for all numbers, where only that of the heights is given.
    let surface = with(&list(" ", 1e-3), None, Some(UM)).unwrap();
    assert_size(&surface, size);
    // The unit of the heights says nothing about the lengths where the file says the one and not the other.
    let error = read(&format!("x;y;z [nm]\n{}", list(";", 1.0))).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingSize { .. }), "{error}");
    // A column more, chosen by its name.
    let more: String = list(",", 1.0).lines().map(|l| format!("{l},7\n")).collect();
    let text = format!("x [um],y [um],z [nm],other [nm]\n{more}");
    assert_eq!(read(&text).unwrap().channels, ["z", "other"]);
    let other = ReadOptions { channel: Some("other".into()), ..Default::default() };
    assert_eq!(read_bytes(text.as_bytes(), &other).unwrap().heights[[0, 0]], 7.0 * NM);
}

#[test]
fn a_counter_of_points_is_no_coordinate() {
    // 4 x 3 points, 5 x 10 um apart, behind a counter.
    let list = |head: &str, separator: &str| -> String {
        let point = |n: usize| {
            [n as f64, 0.005 * (n % 4) as f64, 0.01 * (n / 4) as f64, n as f64]
                .map(|v| v.to_string())
                .join(separator)
        };
        format!("{head}\n{}\n", (0..12).map(point).collect::<Vec<_>>().join("\n"))
    };
    for (head, separator) in [
        ("index,x in mm,y in mm,z in um", ","),
        ("index;x [mm];y [mm];z [um]", ";"),
        ("Nr\tX/mm\tY/mm\tZ/um", "\t"),
        ("no,x_mm,y_mm,z_um", ","),
        ("point,X coordinate (mm),Y coordinate (mm),Height (um)", ","),
        ("index,pos_x [mm],pos_y [mm],z [um]", ","),
        ("index x mm y mm z um", " "),
        ("index x [mm] y [mm] z [um]", " "),
    ] {
        let options = ReadOptions { channel: None, ..Default::default() };
        let surface =
            read_bytes(list(head, separator).as_bytes(), &options).unwrap_or_else(|e| panic!("{head}: {e}"));
        assert_eq!((surface.heights.dim(), surface.undefined()), ((4, 3), 0), "{head}");
        assert_size(&surface, [20.0 * UM, 30.0 * UM]);
        assert!((surface.heights[[1, 2]] - 9.0 * UM).abs() < 1e-18, "{head}");
    }
    // Without names of x and y the first columns are not taken, whatever else is given.
    for options in [
        ReadOptions { height_unit: Some(UM), ..Default::default() },
        ReadOptions { height_unit: Some(UM), format: Some(Format::Xyz), ..Default::default() },
    ] {
        for head in ["index,a,b,c", "# list of points"] {
            let error = read_bytes(list(head, ",").as_bytes(), &options).unwrap_err().to_string();
            assert!(error.contains("x and y among them") || error.contains("--size"), "{head}: {error}");
        }
    }
    // A counter in place of x, and a line across the surface.
    for text in ["0 0 1\n1 0 2\n2 1 3\n3 1 4\n", "0 0 1\n1 1 2\n2 2 3\n3 3 4\n"] {
        let error = with(text, None, Some(UM)).unwrap_err().to_string();
        assert!(error.contains("the column taken for x"), "{error}");
    }
}

#[test]
fn lengths_without_a_unit_say_in_which_they_are_taken() {
    let surface = with("0 0 1\n0 1 1\n1 0 1\n1 1 2\n", None, Some(UM)).unwrap();
    assert!(surface.history().any(|step| step.contains("without a unit") && step.contains("1e-6 m")));
    let stated = read("x [um] y [um] z [nm]\n0 0 1\n0 1 1\n1 0 1\n1 1 2\n").unwrap();
    assert_eq!(stated.history().count(), 0);
}

#[test]
fn rows_of_a_profile_may_end_in_several_separators() {
    for end in ["", ",", ",,", ",,,", " , ,"] {
        let text = format!(
            "Scan Data\nLateral um,Raw Micrometer,\n0.000,0.5{end}\n0.156,1.5{end}\n0.312,0.25{end}\n"
        );
        let profile =
            profile_of(text.as_bytes(), &ReadOptions::default()).unwrap_or_else(|e| panic!("{text}: {e}"));
        let heights: Vec<f64> =
            profile.surface.heights().iter().map(|z| (z / UM * 100.0).round() / 100.0).collect();
        assert_eq!(heights, [0.5, 1.5, 0.25], "{text}");
        assert!((profile.surface.grid().size()[0] / (0.468 * UM) - 1.0).abs() < 1e-12, "{text}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.csv");
        std::fs::write(&path, &text).unwrap();
        assert!(read_profile(&path, &ReadOptions::default()).unwrap().is_some(), "{text}");
    }
}

#[test]
fn points_without_a_unit_ask_for_it() {
    let text = "0 0 1\n0 1 1\n1 0 1\n1 1 2\n";
    let error = read(text).unwrap_err().to_string();
    assert!(error.contains("--height-unit"), "{error}");
    // Read as a matrix, the same text has no size either.
    let options = ReadOptions { format: Some(Format::Text), height_unit: Some(UM), ..Default::default() };
    let error = read_bytes(text.as_bytes(), &options).unwrap_err().to_string();
    assert!(error.contains("--size"), "{error}");
}

#[test]
fn rounded_coordinates_are_one_position() {
    // 30 x 20 points of spacing 1/3, written with five digits: 9.6667, not 9.666666...
    let text: String = (0..600)
        .map(|k| format!("{:.4} {:.4} {k}\n", (k % 30) as f64 / 3.0, (k / 30) as f64 / 3.0))
        .collect();
    let surface = with(&text, None, Some(1.0)).unwrap();
    assert_eq!(surface.heights.dim(), (30, 20));
    assert!(surface.heights.indexed_iter().all(|((x, y), h)| *h == (30 * y + x) as f64));
    // Five digits of the last coordinate.
    assert!((surface.size[0] / 10.0 - 1.0).abs() < 1e-5, "{}", surface.size[0]);
}

#[test]
fn binary_bytes_are_no_text() {
    assert_eq!(detect(b"\x00\x01\x02\x03"), None);
    assert_eq!(detect(b""), None);
    assert_eq!(detect(b"only words here\n"), None);
    assert_eq!(detect(b"1 2 3 4\n"), Some(Format::Text));
    assert_eq!(detect(b"1,2,3,4\n"), Some(Format::Csv));
    assert_eq!(detect(b"0 0 5\n0 1 6\n"), Some(Format::Xyz));
}

#[test]
fn files_of_many_blocks_or_remarks_are_refused_in_time() {
    // A header of its own for each of a million blocks would need hours and gigabytes.
    for text in ["a\n1 2\n".repeat(200_000), "remark\n".repeat(200_000) + "1 2 3 4\n5 6 7 8\n"] {
        assert!(with(&text, Some([1.0, 1.0]), Some(1.0)).is_err());
    }
}

#[test]
fn an_infinite_height_is_no_empty_cell() {
    for word in ["inf", "-inf", "Infinity", "1.#INF"] {
        let error = read(&format!("# Width: 3 um\n# Height: 2 um\n# Value units: nm\n1 2 3\n4 {word} 6\n"))
            .unwrap_err();
        assert!(
            matches!(&error.problem, Problem::Malformed { what, value, .. } if what == "line 5" && value.contains(word)),
            "{error}"
        );
    }
}

#[test]
fn quotes_carriage_returns_and_the_minus_of_typography_change_no_number() {
    for text in [
        "\"1\",\"2.5\",\"-3\"\n\"4\",\"nan\",\"6e3\"\n",
        "\"1\",\"2,5\",\"-3\"\r\n\"4\",\"nan\",\"6e3\"\r\n",
        "1 2.5 -3\r4 nan 6e3\r",
        "1\t2.5\t\u{2212}3\n4\tnan\t6e3\n",
    ] {
        let options = ReadOptions {
            size: Some([3.0, 2.0]),
            height_unit: Some(NM),
            format: Some(Format::Text),
            ..Default::default()
        };
        let surface = read_bytes(text.as_bytes(), &options).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_heights(&surface, &heights(), NM);
    }
    // The names of the columns stay above lines after the last point.
    let points = "x [um],y [um],z [nm]\n0,0,1\n1,0,2\n0,1,3\n1,1,4\nEnd of data\nexported: today\n";
    let surface = read(points).unwrap();
    assert_size(&surface, [2.0 * UM, 2.0 * UM]);
    assert_heights(&surface, &array![[1.0, 3.0], [2.0, 4.0]], NM);
    let profile =
        b"\"Lateral um\",\"Total Profile nm\"\n\"0.0\",\"1.0\"\n\"0.5\",\"2.0\"\n\"1.0\",\"1.0\"\n\nEnd\n";
    let profile = profile_of(profile, &ReadOptions::default()).unwrap();
    assert!((profile.surface.heights()[[1, 0]] / 2e-9 - 1.0).abs() < 1e-12);
    assert!((profile.surface.grid().size()[0] / 1.5e-6 - 1.0).abs() < 1e-12);
}

/// The heights i² + 3 j² - i j of a map, whose lines and columns are not evenly spaced, with numbers put before them.
#[test]
fn counters_and_coordinates_beside_a_matrix_are_no_heights() {
    let line = |j: i32| (0..8).map(|i| (i * i + 3 * j * j - i * j).to_string()).collect::<Vec<_>>().join(",");
    let lines: Vec<String> = (0..9).map(line).collect();
    let (size, unit) = (Some([8e-6, 9e-6]), Some(NM));
    assert!(with(&lines.join("\n"), size, unit).is_ok());
    let numbered = |from: i32, step: f64| {
        let rows = lines.iter().zip(0..).map(|(line, j)| format!("{},{line}", f64::from(from + j) * step));
        rows.collect::<Vec<_>>().join("\n")
    };
    for (text, words) in [
        (format!("0,1,2,3,4,5,6,7\n{}", lines.join("\n")), "first line"),
        (format!("0,0.1,0.2,0.3,0.4,0.5,0.6,0.7\n{}", lines.join("\n")), "first line"),
        (numbered(1, 1.0), "first column"),
        // Coordinates of both axes.
        (format!("0,0,2,4,6,8,10,12,14\n{}", numbered(0, 0.25)), "first line"),
    ] {
        let error = with(&text, size, unit).unwrap_err().to_string();
        assert!(
            error.contains(words) && error.contains("evenly spaced") && error.contains("take it out"),
            "{error}"
        );
    }
    // A plane is evenly spaced everywhere, and so is a wedge.
    let plane = |i: i32, j: i32| (2 * i + j).to_string();
    let rows = (0..9).map(|j| (0..8).map(|i| plane(i, j)).collect::<Vec<_>>().join(","));
    assert!(with(&rows.collect::<Vec<_>>().join("\n"), size, unit).is_ok());
}

/// Numbers of these files are pixels, phases, or mark what was not measured.
#[test]
fn text_of_other_formats_is_no_matrix_and_no_list_of_points() {
    let zygo = "Zygo XYZ Data File - Format 1\n1 8 3 0 \"today\"\n#\n0 0 0.5\n1 0 0.4\n0 1 0.6\n1 1 0.7\n#\n";
    let ascii = "Zygo ASCII Data File - Format 2\n0 1 2 3\n4 5 6 2147483640\n7 8 9 10\n";
    let esri = "ncols 3\nnrows 2\ncellsize 2\nNODATA_value -9999\n1 2 3\n4 -9999 6\n";
    for (text, name) in
        [(zygo, "Zygo XYZ"), (ascii, "Zygo ASCII"), (esri, "ESRI"), ("DSAA\n2 2\n0 1\n0 1\n", "Surfer")]
    {
        let error = with(text, Some([1e-6, 1e-6]), Some(NM)).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("export"), "{error}");
        let options = ReadOptions { height_unit: Some(NM), ..ReadOptions::default() };
        assert!(profile_of(text.as_bytes(), &options).is_err());
    }
}

#[test]
fn sections_units_in_remarks_and_coordinates_are_no_heights() {
    // A section is no unit; both things that are missing are asked for.
    let error = read("[HEADER]\nPitch=0.25\n[DATA]\n1 2 3 5\n4 5 7 6\n").unwrap_err().to_string();
    assert!(error.contains("--size A,B --height-unit U") && !error.contains("DATA"), "{error}");
    // x and y are in mm, whatever the unit of the heights is.
    let error = with("# x and y in mm\n0 0 1\n0 1 2\n1 0 3\n1 1 5\n", None, Some(NM)).unwrap_err();
    assert!(matches!(error.problem, Problem::MissingSize { .. }), "{error}");
    assert!(error.to_string().contains("x and y in mm"), "{error}");
    // Coordinates beside six lines of heights, and above them with a word in the corner.
    let row = |y: u32| format!("{};3;1;{};2\n", 0.5 * f64::from(y), (y * y) % 5);
    let text = format!("y\\x [µm];0;0.5;1;1.5\n{}", (0..6).map(row).collect::<String>());
    let error = with(&text, Some([1.0, 1.0]), Some(NM)).unwrap_err().to_string();
    assert!(error.contains("the first column is evenly spaced"), "{error}");
    // The lines of Igor's text run along y.
    let igor = "IGOR\nWAVES/D/N=(2,3) height\nBEGIN\n1 2 3\n4 5 6\nEND\n";
    let error = with(igor, Some([1.0, 1.0]), Some(NM)).unwrap_err().to_string();
    assert!(error.contains("Igor text") && error.contains(".ibw"), "{error}");
}
