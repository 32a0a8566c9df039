//! Files of measured curves as instruments and people write them.

use std::f64::consts::TAU;
use std::io::{Cursor, Write};

use asperity::material::{Modulus, Relaxation, Shift};
use asperity_io::curve::{Columns, Curves, Kind, Request};

fn rubber() -> Relaxation {
    Relaxation::absolute(1e6, &[(5e8, 1e-4), (8e7, 1e-2), (3e6, 2.0)]).unwrap()
}

/// A table of the rubber over frequency in Hz, with the columns that `row` makes of (f, storage, loss).
fn table(header: &str, row: impl Fn(f64, f64, f64) -> String) -> String {
    let mut text = format!("{header}\n");
    for k in 0..40 {
        let f = 10f64.powf(-2.0 + 0.15 * f64::from(k));
        let (storage, loss) = rubber().complex(TAU * f);
        text += &format!("{}\n", row(f, storage, loss));
    }
    text
}

#[track_caller]
fn is_the_rubber(text: &str, measure: Option<Modulus>) {
    let curves = Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Dma, &Columns::default());
    let curves = curves.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(curves.measure, measure, "{text:.80}");
    let sweep = &curves.sweeps[0];
    for (n, omega) in sweep.x.iter().enumerate() {
        let (storage, loss) = rubber().complex(*omega);
        // Twelve digits in the file.
        assert!((sweep.curves[0][n] / storage - 1.0).abs() < 1e-9, "{text:.80}");
        assert!((sweep.curves[1][n] / loss - 1.0).abs() < 1e-9, "{text:.80}");
    }
}

#[test]
fn what_instruments_give_in_place_of_the_moduli_becomes_them() {
    let mega = |value: f64| 1e-6 * value;
    for (text, measure) in [
        (
            table("f,E_stor,E_loss\nHz,MPa,MPa", |f, s, l| format!("{f},{},{}", mega(s), mega(l))),
            Some(Modulus::Young),
        ),
        // The mark of inches for the double prime, not in the last column; and quotes around a name.
        (
            table("f (Hz);E' (MPa);E\" (MPa);\"T; in °C\"", |f, s, l| {
                format!("{f};{};{};20", mega(s), mega(l))
            }),
            Some(Modulus::Young),
        ),
        (
            table("f\tG\"\tG'\nHz\tMPa\tMPa", |f, s, l| format!("{f}\t{}\t{}", mega(l), mega(s))),
            Some(Modulus::Shear),
        ),
        (
            table("Frequenz [Hz];Speichermodul G' [Pa];Verlustfaktor", |f, s, l| {
                format!("{f};{s};{}", l / s)
            }),
            Some(Modulus::Shear),
        ),
        (
            table("Ang. frequency\tComplex Modulus\tPhase angle\nrad/s\tMPa\t°", |f, s, l| {
                format!("{}\t{}\t{}", TAU * f, mega(s.hypot(l)), l.atan2(s).to_degrees())
            }),
            None,
        ),
        (
            table("omega (rad/s);J' (1/Pa);J'' (1/Pa)", |f, s, l| {
                let squares = s * s + l * l;
                format!("{};{};{}", TAU * f, s / squares, l / squares)
            }),
            Some(Modulus::Shear),
        ),
        (
            table(
                "Point No.;Angular Frequency;Complex Viscosity;Loss Factor\n;[rad/s];[Pa·s];[1]",
                |f, s, l| {
                    let omega = TAU * f;
                    format!("1;{omega};{};{}", s.hypot(l) / omega, l / s)
                },
            ),
            Some(Modulus::Shear),
        ),
        (
            table("f [Hz];η' [Pa s];η'' [Pa s]", |f, s, l| {
                format!("{f};{};{}", l / (TAU * f), s / (TAU * f))
            }),
            Some(Modulus::Shear),
        ),
    ] {
        is_the_rubber(&text, measure);
    }
}

/// A spreadsheet of the given sheets, texts and numbers.
fn xlsx(sheets: &[(&str, Vec<Vec<String>>)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let mut put = |name: String, text: String| {
        zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    };
    let head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>";
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let package = "http://schemas.openxmlformats.org/package/2006";
    let mut types = String::new();
    let (mut names, mut relations) = (String::new(), String::new());
    for (n, (name, rows)) in sheets.iter().enumerate() {
        let n = n + 1;
        names += &format!("<sheet name=\"{name}\" sheetId=\"{n}\" r:id=\"r{n}\"/>");
        relations += &format!(
            "<Relationship Id=\"r{n}\" Type=\"{office}/worksheet\" Target=\"worksheets/sheet{n}.xml\"/>"
        );
        types += &format!(
            "<Override PartName=\"/xl/worksheets/sheet{n}.xml\" ContentType=\"application/vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml\"/>"
        );
        let mut data = String::new();
        for (r, row) in rows.iter().enumerate() {
            data += &format!("<row r=\"{}\">", r + 1);
            for (c, cell) in row.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
                let place = format!("{}{}", char::from(b'A' + c as u8), r + 1);
                data += &match cell.parse::<f64>() {
                    Ok(value) => format!("<c r=\"{place}\"><v>{value}</v></c>"),
                    Err(_) => format!("<c r=\"{place}\" t=\"inlineStr\"><is><t>{cell}</t></is></c>"),
                };
            }
            data += "</row>";
        }
        put(
            format!("xl/worksheets/sheet{n}.xml"),
            format!("{head}<worksheet xmlns=\"{main}\"><sheetData>{data}</sheetData></worksheet>"),
        );
    }
    put(
        "xl/workbook.xml".into(),
        format!("{head}<workbook xmlns=\"{main}\" xmlns:r=\"{office}\"><sheets>{names}</sheets></workbook>"),
    );
    put(
        "xl/_rels/workbook.xml.rels".into(),
        format!("{head}<Relationships xmlns=\"{package}/relationships\">{relations}</Relationships>"),
    );
    put(
        "_rels/.rels".into(),
        format!(
            "{head}<Relationships xmlns=\"{package}/relationships\"><Relationship Id=\"a\" Type=\"{office}/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"
        ),
    );
    put(
        "[Content_Types].xml".into(),
        format!(
            "{head}<Types xmlns=\"{package}/content-types\"><Default Extension=\"xml\" ContentType=\"application/xml\"/>{types}</Types>"
        ),
    );
    zip.finish().unwrap().into_inner()
}

fn row(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).to_owned()).collect()
}

/// The workbook of an instrument: shift list with WLF constants, the points with other columns, a page of remarks.
fn workbook() -> Vec<u8> {
    let shift = vec![
        row(&["Ref.Temp.", "25.0 °C"]),
        row(&["WLF", "C1 : 13.50", "C2 : 141.19 K"]),
        row(&["Temp.", "Shift"]),
        row(&["50", "-1.8"]),
        row(&["25", "0"]),
        row(&["0", "3"]),
    ];
    let mut points = vec![
        row(&["Nr", "F stat.", "Time", "f", "T", "E'", "E''", "|E*|", "tan delta", "T2"]),
        row(&["", "N", "s", "Hz", "°C", "MPa", "MPa", "MPa", "", "°C"]),
    ];
    for k in 0..40 {
        let f = 10f64.powf(-2.0 + 0.15 * f64::from(k));
        let (storage, loss) = rubber().complex(TAU * f);
        let numbers = [
            f64::from(k),
            -0.4,
            100.0,
            f,
            25.0,
            1e-6 * storage,
            1e-6 * loss,
            1e-6 * storage.hypot(loss),
            loss / storage,
            0.0,
        ];
        points.push(numbers.map(|number| format!("{number:?}")).to_vec());
    }
    let remarks = vec![row(&["Operator", "x"]), row(&["Width", "2.0", "mm"])];
    xlsx(&[("Shiftlist", shift), ("Exported Data", points), ("Data header", remarks)])
}

#[test]
fn a_workbook_of_an_instrument_gives_curve_and_shift() {
    let bytes = workbook();
    let read = |columns: &Columns| Curves::parse("e.xlsx".as_ref(), &bytes, Kind::Dma, columns);
    let curves = read(&Columns::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((curves.sheet.as_deref(), curves.measure), (Some("Exported Data"), Some(Modulus::Young)));
    assert!(curves.unused.contains(&"F stat.".to_owned()), "{:?}", curves.unused);
    let fitted = Request::default().fit(&curves).unwrap_or_else(|error| panic!("{error}"));
    assert!(fitted.misfit.max < 1e-4, "{:?}", fitted.misfit);
    let Some(Shift::Table { points }) = &fitted.shift else { panic!("{:?}", fitted.shift) };
    assert!(points.len() == 3 && (points[0].0 - 273.15).abs() < 1e-9, "{points:?}");
    assert!(matches!(curves.held.wlf, Some(Shift::Wlf { c1: 13.5, c2: 141.19, .. })), "{:?}", curves.held);
    assert!(fitted.notes.iter().any(|note| note.contains("WLF constants")), "{:?}", fitted.notes);
    // A sheet of its own choice, and one that is not there.
    let named = |name: &str| Columns { sheet: Some(name.to_owned()), ..Columns::default() };
    assert_eq!(read(&named("Exported Data")).unwrap().held, curves.held);
    let refused = read(&named("Data")).unwrap_err().to_string();
    assert!(refused.contains("no sheet \"Data\"") && refused.contains("\"Exported Data\""), "{refused}");
}

#[test]
fn a_damaged_workbook_is_refused() {
    let bytes = workbook();
    // Cut off, and with single bytes changed; none may panic through.
    for end in (0..bytes.len()).step_by(97) {
        let _ = Curves::parse("e.xlsx".as_ref(), &bytes[..end], Kind::Dma, &Columns::default());
    }
    for place in (0..bytes.len()).step_by(53) {
        let mut changed = bytes.clone();
        changed[place] ^= 0x55;
        let _ = Curves::parse("e.xlsx".as_ref(), &changed, Kind::Dma, &Columns::default());
    }
    let mut old = vec![0xd0, 0xcf, 0x11, 0xe0, 0xa1, 0xb1, 0x1a, 0xe1];
    old.extend(std::iter::repeat_n(0, 4096));
    assert!(Curves::parse("e.xls".as_ref(), &old, Kind::Dma, &Columns::default()).is_err());
}
