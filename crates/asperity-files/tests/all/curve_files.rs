//! Files of measured curves as instruments and people write them.

use std::f64::consts::TAU;
use std::io::{Cursor, Write};

use asperity::material::{Modulus, Relaxation, Shift};
use asperity_files::curve::{
    Column, Columns, Curves, Kind, Remedy, Request, Role, ShiftRequest, VerticalRequest,
};

fn rubber() -> Relaxation {
    Relaxation::absolute(1e6, &[(5e8, 1e-4), (8e7, 1e-2), (3e6, 2.0)]).unwrap()
}

/// A table of the rubber over frequency in Hz, with the columns that `row` makes of (f, storage, loss).
fn table(header: &str, mut row: impl FnMut(f64, f64, f64) -> String) -> String {
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
        // A double quote of CSV for the double prime, and units in capital letters.
        (
            table("\"f [HZ]\",\"E' [MPA]\",\"E\"\" [MPA]\"", |f, s, l| {
                format!("{f},{},{}", mega(s), mega(l))
            }),
            Some(Modulus::Young),
        ),
        (
            table("omega,E',phase\nrad/sec,MPA,mrad", |f, s, l| {
                format!("{},{},{}", TAU * f, mega(s), 1e3 * l.atan2(s))
            }),
            Some(Modulus::Young),
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

#[test]
fn logarithms_other_symbols_and_other_units_are_the_same_moduli() {
    let mega = |value: f64| 1e-6 * value;
    let psi = |value: f64| value / 6_894.757_293_168_361;
    for (text, measure) in [
        (
            table("log f [Hz];lg(E' [Pa]);log10(E'')\n", |f, s, l| {
                format!("{};{};{}", f.log10(), s.log10(), l.log10())
            }),
            Some(Modulus::Young),
        ),
        (
            table("ln(omega) (rad/s)\tlog G' (Pa)\tlog G'' (Pa)", |f, s, l| {
                format!("{}\t{}\t{}", (TAU * f).ln(), s.log10(), l.log10())
            }),
            Some(Modulus::Shear),
        ),
        (table("f_Hz,E1_MPa,E2_MPa", |f, s, l| format!("{f},{},{}", mega(s), mega(l))), Some(Modulus::Young)),
        (
            table("f [Hz],Re(E*) [Pa],Im(E*) [psi]", |f, s, l| format!("{f},{s},{}", psi(l))),
            Some(Modulus::Young),
        ),
        (
            table("f [Hz],|G*| [ksi],delta (°)", |f, s, l| {
                format!("{f},{},{}", 1e-3 * psi(s.hypot(l)), l.atan2(s).to_degrees())
            }),
            Some(Modulus::Shear),
        ),
        (
            table(
                "   Index    t    Frequency    Modulus    E'    Tan Delta\n   []    [s]    [Hz]    [MPa]    [MPa]    []",
                |f, s, l| format!("   1    7.5    {f}    {}    {}    {}", mega(s.hypot(l)), mega(s), l / s),
            ) + "Results:\n  Sample:\n    rubber, 12.3 mg\n",
            Some(Modulus::Young),
        ),
        (
            table("f [Hz];|eta*| [Pa.s];tan(delta) [-]", |f, s, l| {
                format!("{f};{};{}", s.hypot(l) / (TAU * f), l / s)
            }),
            Some(Modulus::Shear),
        ),
    ] {
        is_the_rubber(&text, measure);
    }
    let mixed = "f [Hz];E' [Pa];G'' [Pa]\n1;2e6;1e5\n100;3e6;1e5\n";
    let refused = Curves::parse("x.csv".as_ref(), mixed.as_bytes(), Kind::Dma, &Columns::default());
    assert!(refused.unwrap_err().to_string().contains("cannot be fitted together"));
    let linear = "log f [Hz];E' [Pa];E'' [Pa]\n1;2e6;1e5\n100;3e6;1e5\n";
    let refused = Curves::parse("x.csv".as_ref(), linear.as_bytes(), Kind::Dma, &Columns::default());
    assert!(refused.unwrap_err().to_string().contains("100 decades"));
}

#[test]
fn points_without_a_number_are_left_out_and_repeated_ones_averaged() {
    let mut n = 0;
    let text = table("f [Hz];E' [MPa];E'' [MPa];remark", |f, s, l| {
        n += 1;
        match n {
            4 => format!("{f};NaN;{l};slip"),
            9 => format!("{f};;{l};slip"),
            // Twice, 1 % apart: the mean is the value.
            20 => format!("{f};{};{};\n{f};{};{};", 0.995e-6 * s, 1e-6 * l, 1.005e-6 * s, 1e-6 * l),
            _ => format!("{f};{};{};", 1e-6 * s, 1e-6 * l),
        }
    });
    is_the_rubber(&text, Some(Modulus::Young));
    let read = |text: &str| Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Dma, &Columns::default());
    let curves = read(&text).unwrap();
    assert_eq!((curves.left_out, curves.points()), (2, 38));
    let notes = curves.notes.join("\n");
    assert!(notes.contains("2 of 41 points lack a number and are left out (lines 5, 10)"), "{notes}");
    assert!(notes.contains("1 point repeats a frequency, the first on line 22"), "{notes}");
    assert_eq!(Request::default().fit(&curves).unwrap().left_out, 2);
    // Sweeps at several temperatures without a column that says so.
    let twice = "f [Hz],E' [MPa],E'' [MPa]\n1,10,1\n2,12,1\n1,5,1\n2,6,1\n";
    let refused = read(twice).unwrap_err();
    assert_eq!(refused.line, Some(4));
    assert!(refused.to_string().contains("column of temperatures"), "{refused}");
    let mostly = "f [Hz],E' [MPa],E'' [MPa]\n1,10,1\n2,,1\n3,,1\n4,6,1\n5,nan,1\n";
    assert!(read(mostly).unwrap_err().to_string().contains("3 of 5 points lack a number"));
}

/// Sweeps of the rubber at temperatures \[°C\], whose moduli grow as `factor`.
fn sweeps(factor: impl Fn(f64) -> f64) -> Curves {
    let law = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let mut text = "T [°C];f [Hz];E' [Pa];E'' [Pa]\n".to_owned();
    for celsius in [0.0, 10.0, 20.0, 30.0, 45.0, 60.0] {
        let a = law.factor(celsius + 273.15).unwrap();
        for k in 0..21 {
            let f = 10f64.powf(-2.0 + 0.2 * f64::from(k));
            let (storage, loss) = rubber().complex(TAU * f * a);
            let factor = factor(celsius + 273.15);
            text += &format!("{celsius};{f:.9e};{:.9e};{:.9e}\n", factor * storage, factor * loss);
        }
    }
    Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Dma, &Columns::default()).unwrap()
}

#[test]
fn moduli_that_grow_with_temperature_are_brought_to_the_reference() {
    let curves = sweeps(|kelvin| kelvin / 293.15);
    let shift = ShiftRequest::Given(Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 });
    let plain = Request { shift: shift.clone(), ..Request::default() }.fit(&curves).unwrap();
    // 7 % too low at 0 °C, 14 % too high at 60 °C.
    assert!(plain.misfit.max > 0.03 && plain.vertical.is_none(), "{:?}", plain.misfit);
    for vertical in [VerticalRequest::Density { expansion: 0.0 }, VerticalRequest::Free] {
        let free = vertical == VerticalRequest::Free;
        let fitted = Request { shift: shift.clone(), vertical, ..Request::default() }.fit(&curves).unwrap();
        // Ten digits; factors from polynomials through sweeps of two decades and more in common.
        let most = if free { 0.01 } else { 1e-4 };
        assert!(fitted.misfit.max < most, "{free} {:?}", fitted.misfit);
        assert_eq!(fitted.vertical_factors.len(), 6);
        for [kelvin, factor, uncertainty] in &fitted.vertical_factors {
            assert!((factor * kelvin / 293.15 - 1.0).abs() < most, "{free} {kelvin}: {factor}");
            assert!(*uncertainty < 0.02 && (free || *uncertainty == 0.0));
        }
        let block = fitted.to_toml(&curves);
        let said = if free { "vertical = [[\"273.15 K\", " } else { "vertical = \"density\" } }" };
        assert!(block.contains(said), "{block}");
    }
    // Factors of both kinds at once, from the sweeps alone.
    let curves = sweeps(|kelvin| 1.0 + 0.004 * (kelvin - 293.15));
    let request = Request {
        shift: ShiftRequest::Estimate(293.15),
        vertical: VerticalRequest::Free,
        ..Request::default()
    };
    let fitted = request.fit(&curves).unwrap();
    for [kelvin, factor, uncertainty] in &fitted.vertical_factors {
        let error = factor * (1.0 + 0.004 * (kelvin - 293.15)) - 1.0;
        // Three standard deviations, and what a law within 0.1 decades of the factors does to moduli of a slope of a half.
        assert!(error.abs() < 3.0 * uncertainty + 0.05, "{kelvin}: {error} {uncertainty}");
    }
    let one = Request { vertical: VerticalRequest::Free, ..Request::default() };
    let refused = one.fit(&Curves { sweeps: curves.sweeps[..1].to_vec(), ..curves }).unwrap_err().to_string();
    assert!(refused.contains("two temperatures"), "{refused}");
}

#[test]
fn a_file_without_a_curve_is_told_by_its_columns() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    for (text, words) in [
        ("Zeit [s],Dehnung [%]\n1,2\n2,3\n", "the file has 1 \"Zeit [s]\", 2 \"Dehnung [%]\""),
        ("T [°C],log_aT\n0,1\n20,0\n", "shift factors and no measured curve"),
        ("t [s],E' [MPa],E'' [MPa]\n1,2,3\n2,3,4\n", "need a column of frequencies"),
    ] {
        std::fs::write(&path, text).unwrap();
        let told = Curves::kind_of(&path, None).unwrap_err().to_string();
        assert!(told.contains(words), "{told}");
    }
}

#[test]
fn columns_without_names_are_taken_in_order_only_where_there_are_as_many_as_needed() {
    // A counter before the time: E(t) = 1 MPa + 2 MPa exp(-t/10 s).
    let modulus = |t: f64| 1e6 + 2e6 * (-t / 10.0).exp();
    let rows = |row: &dyn Fn(i32, f64) -> String| -> String {
        (0..40).map(|k| row(k, 10f64.powf(-1.0 + 0.1 * f64::from(k)))).collect()
    };
    let read =
        |text: &str, said: &Columns| Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Relaxation, said);
    let two = rows(&|_, t| format!("{t:.12e} {:.12e}\n", modulus(t)));
    let kept = read(&two, &Columns::default()).unwrap();
    assert!((kept.sweeps[0].curves[0][5] / modulus(kept.sweeps[0].x[5]) - 1.0).abs() < 1e-9); // twelve digits in the file
    for three in [
        rows(&|k, t| format!("{k} {t:.12e} {:.12e}\n", modulus(t))),
        format!("a;b;c\n{}", rows(&|k, t| format!("{k};{t:.12e};{:.12e}\n", modulus(t)))),
    ] {
        let error = read(&three, &Columns::default()).unwrap_err();
        assert!(error.message.contains("there are 3, more than the 2"), "{error}");
        assert_eq!(error.remedy, Some(Remedy::Column(Role::Time)));
        let said = Columns {
            columns: [(Role::Time, Column::Number(2)), (Role::Modulus, Column::Number(3))].into(),
            ..Columns::default()
        };
        assert_eq!(read(&three, &said).unwrap().sweeps[0].curves, kept.sweeps[0].curves);
    }
}

/// A temperature ramp of the rubber at 1 Hz in steps of 0.5 K, with the shift factor `ln_factor` of the temperature.
fn ramp(ln_factor: impl Fn(f64) -> f64) -> Curves {
    let mut text = "T [°C];f [Hz];E' [Pa];E'' [Pa]\n".to_owned();
    for k in 0..161 {
        let celsius = -20.0 + 0.5 * f64::from(k);
        // Without the rounding of the sum, which leaves a table at its end.
        let kelvin = ((celsius + 273.15) * 1e9).round() / 1e9;
        let (storage, loss) = rubber().complex(TAU * ln_factor(kelvin).exp());
        text += &format!("{celsius};1;{storage:.12e};{loss:.12e}\n");
    }
    Curves::parse("ramp.csv".as_ref(), text.as_bytes(), Kind::Dma, &Columns::default()).unwrap()
}

#[test]
fn a_temperature_ramp_at_one_frequency_becomes_a_master_curve_by_a_given_shift() {
    let wlf = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let table = Shift::Table {
        points: (0..9)
            .map(|k| 253.15 + 10.0 * f64::from(k))
            .map(|t| (t, wlf.ln_factor(t).unwrap()))
            .collect(),
    };
    for shift in [wlf, table] {
        let curves = ramp(|kelvin| shift.ln_factor(kelvin).unwrap());
        assert!(curves.is_ramp() && curves.points() == 161);
        let request = Request { shift: ShiftRequest::Given(shift), ..Request::default() };
        let fitted = request.fit(&curves).unwrap();
        // Each row at its own temperature: the closed form at its reduced frequency, to the twelve digits of the file.
        for (n, omega) in fitted.data.x.iter().enumerate() {
            let (storage, loss) = rubber().complex(*omega);
            assert!((fitted.data.curves[0][n] / storage - 1.0).abs() < 1e-9, "{omega}");
            assert!((fitted.data.curves[1][n] / loss - 1.0).abs() < 1e-9, "{omega}");
        }
        let decades = (fitted.data.x[160] / fitted.data.x[0]).log10();
        assert!(decades > 8.0, "{decades}"); // 8.86 (40/61.6 + 40/141.6) = 8.25 by the law
        // Data without scatter: the fit is far closer than the misfit that is told (5 %).
        assert!(fitted.misfit.max < 0.01, "{}", fitted.misfit.max);
    }
}

#[test]
fn a_ramp_does_not_tell_its_shift() {
    let wlf = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let curves = ramp(|kelvin| wlf.ln_factor(kelvin).unwrap());
    let free =
        Request { shift: ShiftRequest::Given(wlf), vertical: VerticalRequest::Free, ..Request::default() };
    let estimate = Request { shift: ShiftRequest::Estimate(293.15), ..Request::default() };
    for request in [Request::default(), estimate, free] {
        let error = request.fit(&curves).unwrap_err();
        assert!(error.message.contains("ramp"), "{error}");
        assert_eq!(error.remedy, Some(Remedy::KnownShift));
    }
}
