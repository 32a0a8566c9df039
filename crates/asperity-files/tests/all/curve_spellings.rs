//! Spellings of tables that were read wrongly or refused: the values follow from the numbers that the tests write.

use asperity::material::{FitOptions, Moduli, Modulus, Relaxation, Shift};
use asperity_files::curve::{Columns, CurveError, Curves, Kind, Remedy, Request, Role, Series, ShiftRequest};

fn parse(text: &str, kind: Kind) -> Result<Curves, CurveError> {
    Curves::parse("x.csv".as_ref(), text.as_bytes(), kind, &Columns::default())
}

fn read(text: &str, kind: Kind) -> Curves {
    parse(text, kind).unwrap_or_else(|error| panic!("{error}:\n{text:.300}"))
}

fn kind_of(text: &str) -> Result<Kind, CurveError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.csv");
    std::fs::write(&path, text).unwrap();
    Curves::kind_of(&path, None)
}

/// Every way to write a number that is missing.
const MISSING: [&str; 14] =
    ["", "-", "--", "---", "n/a", "N/A", "NaN", "OL", "***", "#N/A", "#DIV/0!", "overflow", "null", "inf"];

/// 0.01 min is 0.6 s, 4 MPa are 4e6 Pa: whatever the first point lacks, its line is no heading.
#[test]
fn a_first_point_that_lacks_numbers_does_not_take_the_place_of_the_heading() {
    let headings = [
        ("Time [min]", "Relaxation Modulus E [MPa]", None),
        ("Time", "E(t)", Some(("min", "MPa"))),
        ("Zeit/min", "Relaxationsmodul/MPa", None),
        ("t", "E", Some(("[min]", "[MPa]"))),
        // Dashes below the names take nothing from the units behind them.
        ("Time [min]", "Modulus [MPa]", Some(("-", "-"))),
    ];
    for (separator, comma) in [(",", false), (";", false), (";", true), ("\t", false), ("\t", true)] {
        for (time, modulus, units) in headings {
            for missing in MISSING {
                for first in [format!("0{separator}{missing}"), format!("{missing}{separator}4,5")] {
                    let first = if comma { first } else { first.replace("4,5", "4.5") };
                    let decimal = |text: &str| if comma { text.replace('.', ",") } else { text.to_owned() };
                    let mut lines = vec!["Sample: A 12".to_owned(), format!("{time}{separator}{modulus}")];
                    lines.extend(units.map(|(a, b)| format!("{a}{separator}{b}")));
                    for _ in 0..2 {
                        lines.push(first.clone());
                    }
                    lines.extend((1..8).map(|k| {
                        format!(
                            "{}{separator}{}",
                            decimal(&format!("{:?}", 0.01 * f64::from(k))),
                            decimal(&format!("{:?}", 4.5 - 0.1 * f64::from(k)))
                        )
                    }));
                    let text = lines.join("\n") + "\n";
                    let curves = read(&text, Kind::Relaxation);
                    let sweep = &curves.sweeps[0];
                    assert_eq!(sweep.x.len(), 7, "{text}");
                    assert!((sweep.x[0] / 0.6 - 1.0).abs() < 1e-12, "{text} {:?}", sweep.x);
                    assert!((sweep.curves[0][0] / 4.4e6 - 1.0).abs() < 1e-12, "{text}");
                    // A line of separators only is blank.
                    let blank = first.chars().all(|c| c.is_whitespace() || separator.contains(c));
                    assert_eq!(curves.left_out, if blank { 0 } else { 2 }, "{text}");
                }
            }
        }
    }
}

#[test]
fn dma_and_spreadsheets_keep_their_heading_above_points_that_lack_numbers() {
    for first in ["0.05,,", "0.05,-,-", "0.05,n/a,n/a", ",,0.2", "0.05,1.0,", "1,-,-", ",-,-"] {
        let text = format!(
            "frequency [rad/s],G' [kPa],G'' [kPa]\n{first}\n0.1,1.02,0.198\n0.2,1.05,0.28\n0.4,1.1,0.4\n"
        );
        let curves = read(&text, Kind::Dma);
        let sweep = &curves.sweeps[0];
        assert_eq!(sweep.x, [0.1, 0.2, 0.4], "{first}");
        assert!((sweep.curves[0][0] / 1020.0 - 1.0).abs() < 1e-12 && curves.measure == Some(Modulus::Shear));
    }
}

#[test]
fn lines_between_names_and_points_hide_no_units() {
    // A remark, and units above the names or between names and symbols.
    for heading in [
        "Time [min],E [MPa]\n# the first points are bad",
        "Time [min],E [MPa]\nstart of the step",
        "min,MPa\nTime,E",
        "Time,Modulus\nmin,MPa\nt,E",
        "Time,Modulus\nt,E\nmin,MPa",
    ] {
        let curves = read(&format!("{heading}\n0.01,4\n0.02,3\n0.04,2\n"), Kind::Relaxation);
        assert!((curves.sweeps[0].x[0] / 0.6 - 1.0).abs() < 1e-12, "{heading}");
        assert!((curves.sweeps[0].curves[0][0] / 4e6 - 1.0).abs() < 1e-12, "{heading}");
    }
    // Words that are not understood may be units.
    let error = parse("Time,E\nMinuten,Megapascal\n0.01,4\n0.02,3\n", Kind::Relaxation).unwrap_err();
    assert!(
        error.message.contains("\"Minuten,Megapascal\"") && error.remedy == Some(Remedy::Unit(Role::Time)),
        "{error}"
    );
    let error = parse("Time [min] Modulus [MPa] measured\n0.01 4\n0.02 3\n", Kind::Relaxation).unwrap_err();
    assert!(error.message.contains("may hold a unit"), "{error}");
}

/// J = 1/4 + (1/4) (1 - exp(-t/3 s)) 1/MPa, and its reciprocal.
fn creep(columns: &str, row: impl Fn(f64, f64) -> String) -> String {
    let mut text = format!("{columns}\n");
    for k in 0..60 {
        let t = 10f64.powf(-2.0 + 0.07 * f64::from(k));
        text += &format!("{}\n", row(t, 0.25 + 0.25 * (1.0 - (-t / 3.0).exp())));
    }
    text
}

#[test]
fn a_reciprocal_of_a_compliance_is_not_taken_for_a_relaxation_modulus() {
    let both = |above: &str| {
        let head = format!("{above}Step time [s],Strain [%],Compliance [1/MPa],Modulus [MPa]");
        creep(&head, |t, j| format!("{t:e},{:e},{j:e},{:e}", 5.0 * j, 1.0 / j))
    };
    let error = kind_of(&both("")).unwrap_err();
    assert_eq!(error.remedy, Some(Remedy::Kind));
    assert!(error.message.contains("reciprocal") && error.message.contains("as in creep"), "{error}");
    // The step's own name.
    let text = both("Step: Creep - 1\n");
    assert_eq!(kind_of(&text), Ok(Kind::Creep));
    let fitted = Request::default().fit(&read(&text, Kind::Creep)).unwrap();
    let Series::Creep(function) = &fitted.series else { panic!("{:?}", fitted.series) };
    // One term at 3 s; six digits would be lost by rounding, these are sixteen.
    assert_eq!(function.terms.len(), 1);
    assert!((function.terms[0].retardation_time / 3.0 - 1.0).abs() < 1e-3, "{:?}", function.terms);
    // A name that the columns contradict is asked about.
    let error = kind_of(&both("Step: Stress relaxation - 1\n")).unwrap_err();
    assert!(error.message.contains("called one of relaxation"), "{error}");
    // "Modulus" alone, of a step whose stress is constant.
    let alone = creep("Step time [s],Stress [Pa],Strain [%],Modulus [MPa]", |t, j| {
        format!("{t:e},5e4,{:e},{:e}", 5.0 * j, 1.0 / j)
    });
    let error = kind_of(&alone).unwrap_err();
    assert!(error.message.contains("a step of creep") && error.remedy == Some(Remedy::Kind), "{error}");
    // A relaxation test has a constant strain.
    let held = creep("Step time [s],Stress [Pa],Strain [%],Modulus [MPa],Compliance [1/MPa]", |t, j| {
        format!("{t:e},{:e},1.0,{:e},{j:e}", 1e4 / j, 1.0 / j)
    });
    assert!(kind_of(&held).unwrap_err().message.contains("as in relaxation"));
    assert_eq!(kind_of(&held.replace("Modulus", "Relaxation modulus")), Ok(Kind::Relaxation));
}

fn rubber() -> Relaxation {
    Relaxation::absolute(1e6, &[(5e8, 1e-4), (8e7, 1e-2), (3e6, 2.0)]).unwrap()
}

/// The rubber over angular frequency: `row` of frequency, storage, loss and the number of the point.
fn dma(header: &str, row: impl Fn(f64, f64, f64, usize) -> String) -> String {
    let mut text = format!("{header}\n");
    for k in 0..60 {
        let omega = 10f64.powf(-2.0 + 0.1 * k as f64);
        let (storage, loss) = rubber().complex(omega);
        text += &format!("{}\n", row(omega, storage, loss, k));
    }
    text
}

#[test]
fn a_storage_modulus_alone_is_fitted_where_that_is_asked_for() {
    let text = dma("Freq (rad/s),Storage Modulus (MPa)", |w, s, _, _| format!("{w:e},{:e}", 1e-6 * s));
    assert_eq!(kind_of(&text), Ok(Kind::Dma));
    let curves = read(&text, Kind::Dma);
    let error = Request::default().fit(&curves).unwrap_err();
    assert!(error.message.contains("loss modulus") && error.remedy == Some(Remedy::Loss), "{error}");
    let options = FitOptions { moduli: Moduli::Storage, ..FitOptions::default() };
    let fitted = Request { options, ..Request::default() }.fit(&curves).unwrap();
    assert!(fitted.misfit.max < 1e-3 && fitted.columns.len() == 1 && fitted.other().is_none());
    assert!(
        !fitted.to_toml(&curves).is_empty() && fitted.findings("x").iter().all(|f| f.code != "contradiction")
    );
}

#[test]
fn a_negative_loss_modulus_is_left_out_and_named() {
    let spoiled = |bad: std::ops::Range<usize>| {
        dma("w [rad/s],E' [Pa],E'' [Pa]", move |w, s, l, k| {
            format!("{w:e},{s:e},{:e}", if bad.contains(&k) { -l } else { l })
        })
    };
    let fitted = Request::default().fit(&read(&spoiled(30..31), Kind::Dma)).unwrap();
    assert_eq!((fitted.left_out, fitted.data.x.len()), (1, 59));
    assert!(fitted.misfit.max < 1e-3, "{:?}", fitted.misfit);
    let note = fitted.notes.iter().find(|note| note.contains("loss")).unwrap();
    assert!(note.contains("column 3, \"E'' [Pa]\"") && note.contains("line 32"), "{note}");
    // Many are no stray points.
    let many = read(&spoiled(10..40), Kind::Dma);
    let error = Request::default().fit(&many).unwrap_err();
    assert!(
        error.message.contains("30 of 60 loss moduli (column 3") && error.remedy == Some(Remedy::Moduli),
        "{error}"
    );
    assert_eq!(error.line, Some(12));
    // The storage modulus does not depend on them.
    let options = FitOptions { moduli: Moduli::Storage, ..FitOptions::default() };
    let fitted = Request { options, ..Request::default() }.fit(&many).unwrap();
    assert!(fitted.misfit.max < 1e-3 && fitted.data.x.len() == 60);
}

/// The rubber at three temperatures by the WLF law about 20 °C; the coldest sweep holds nonsense.
#[test]
fn a_bad_isotherm_outside_the_window_is_not_judged() {
    let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let mut text = "T [°C],w [rad/s],E' [Pa],E'' [Pa]\n".to_owned();
    for celsius in [-20.0, 20.0, 40.0] {
        let factor = shift.factor(celsius + 273.15).unwrap();
        for k in 0..20 {
            let omega = 10f64.powf(-1.0 + 0.15 * f64::from(k));
            let (storage, loss) = rubber().complex(omega * factor);
            let sign = if celsius < 0.0 { -1.0 } else { 1.0 };
            text += &format!("{celsius},{omega:e},{:e},{:e}\n", sign * storage, sign * loss);
        }
    }
    let curves = read(&text, Kind::Dma);
    let given = Request { shift: ShiftRequest::Given(shift), ..Request::default() };
    let error = given.fit(&curves).unwrap_err();
    assert!(error.message.contains("20 of 60 loss moduli (column 4") && error.line == Some(2), "{error}");
    // a_T is 6e5 at -20 °C and 0.03 at 40 °C: below 30 rad/s there are points of the two others only.
    let fitted = Request { window: Some([1e-2, 30.0]), ..given }.fit(&curves).unwrap();
    assert!(
        fitted.misfit.max < 1e-2 && fitted.data.x.len() > 25,
        "{:?} {}",
        fitted.misfit,
        fitted.data.x.len()
    );
    assert!(fitted.notes.iter().any(|note| note.contains("1 of 3 temperatures")), "{:?}", fitted.notes);
}

#[test]
fn noise_at_the_end_of_a_relaxation_proposes_a_window() {
    let noise = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut text = "t [s],E [Pa]\n".to_owned();
    for k in 0..80 {
        let t = 10f64.powf(-2.0 + 0.05 * k as f64);
        text += &format!("{t:e},{:e}\n", 1e6 * (-t / 5.0).exp() + 2e3 * noise(k));
    }
    let curves = read(&text, Kind::Relaxation);
    let error = Request::default().fit(&curves).unwrap_err();
    let Some(Remedy::Window(first, last)) = &error.remedy else { panic!("{error:?}") };
    let seconds = |text: &str| text.trim_end_matches(" s").parse::<f64>().unwrap();
    let window = [seconds(first), seconds(last)];
    // The modulus is three times the noise at 5 s ln(1e6/6e3) = 25.6 s.
    assert!(window[0] < 0.02 && (15.0..30.0).contains(&window[1]), "{window:?}");
    let fitted = Request { window: Some(window), ..Request::default() }.fit(&curves).unwrap();
    let Series::Relaxation(function) = &fitted.series else { panic!() };
    assert!((function.value(1.0) / (1e6 * (-0.2f64).exp()) - 1.0).abs() < 0.02);
}

#[test]
fn names_with_underscores_symbols_and_angles_are_understood() {
    for (header, storage) in [
        ("freq_hz,temperature_C,G_storage_pa,G_loss_pa", 3),
        ("frequency_Hz,temp_degC,E_storage_Pa,E_loss_Pa", 3),
        ("omega_rad_s,T_C,E'_Pa,E''_Pa", 3),
        ("Angular frequency ω [rad/s],Temperature T [°C],Storage modulus E' [Pa],Loss modulus E'' [Pa]", 3),
    ] {
        let text = dma(header, |w, s, l, _| format!("{w:e},25,{s:e},{l:e}"));
        let curves = read(&text, Kind::Dma);
        assert_eq!(
            curves.columns.iter().find(|place| place.role == Role::Storage).unwrap().column,
            storage,
            "{header}"
        );
        assert_eq!(curves.sweeps[0].temperature, Some(298.15), "{header}");
        let scale = if header.starts_with("freq") { std::f64::consts::TAU } else { 1.0 };
        assert!((curves.sweeps[0].x[0] / (0.01 * scale) - 1.0).abs() < 1e-12, "{header}");
    }
    for (header, measure) in [
        ("Time, t [s];Relaxation Modulus, E [MPa]", Modulus::Young),
        ("Time [s];Modulus G(t) [MPa]", Modulus::Shear),
        ("Time [s];Modulus E(t) [MPa]", Modulus::Young),
        ("Time t [s];Relaxation modulus (G) [MPa]", Modulus::Shear),
        ("Zeit [s];Relaxationsmodul E(t) [MPa]", Modulus::Young),
    ] {
        let curves = read(&format!("{header}\n0.1;4\n0.2;3\n0.5;2\n"), Kind::Relaxation);
        assert_eq!((curves.measure, curves.sweeps[0].curves[0][0]), (Some(measure), 4e6), "{header}");
    }
    // An angular frequency without a unit is not proposed to be in Hz.
    for name in ["Angular Frequency", "omega", "w", "ω", "Ang. frequency"] {
        let error =
            parse(&dma(&format!("{name},G',G''"), |w, s, l, _| format!("{w:e},{s:e},{l:e}")), Kind::Dma)
                .unwrap_err();
        assert_eq!(error.remedy, Some(Remedy::Radians), "{name}");
        assert!(error.to_string().contains("rad/s\" }"), "{error}");
    }
    let error =
        parse(&dma("Frequency,G',G''", |w, s, l, _| format!("{w:e},{s:e},{l:e}")), Kind::Dma).unwrap_err();
    assert_eq!(error.remedy, Some(Remedy::Unit(Role::Frequency)));
}

#[test]
fn temperatures_above_blocks_of_columns_may_lack_their_unit() {
    let table =
        |above: &str| format!("{above}\nf [Hz],E' [MPa],f [Hz],E' [MPa]\n0.1,5,0.1,4\n1,6,1,5\n10,7,10,6\n");
    let parsed = |above: &str, columns: &Columns| {
        Curves::parse("x.csv".as_ref(), table(above).as_bytes(), Kind::Dma, columns)
    };
    let error = parsed("20,,25,", &Columns::default()).unwrap_err();
    assert_eq!(error.remedy, Some(Remedy::Unit(Role::Temperature)), "{error}");
    let said = Columns { units: [(Role::Temperature, "°C".to_owned())].into(), ..Columns::default() };
    let kelvin =
        |curves: Curves| curves.sweeps.iter().map(|sweep| sweep.temperature.unwrap()).collect::<Vec<f64>>();
    assert_eq!(kelvin(parsed("20,,25,", &said).unwrap()), [293.15, 298.15]);
    assert_eq!(kelvin(parsed("20 °C,,25 °C,", &Columns::default()).unwrap()), [293.15, 298.15]);
}

#[test]
fn empty_and_binary_files_are_named() {
    for (bytes, words) in [
        (&b""[..], "the file is empty"),
        (b" \n\n", "the file is empty"),
        (b"II*\0\x08\0\0\0\x01\x02", "binary"),
    ] {
        let error = Curves::parse("x".as_ref(), bytes, Kind::Dma, &Columns::default()).unwrap_err();
        assert!(error.message.contains(words), "{error}");
    }
}

/// E' = 10 MPa, E'' = 2 MPa at 1, 2 and 4 Hz.
#[test]
fn names_of_other_languages_and_rheometers_are_known() {
    let tau = std::f64::consts::TAU;
    for (head, row, shear) in [
        (
            "Fréquence (Hz);Module de conservation E' (MPa);Module de perte E'' (MPa);Température (°C)",
            (|f| format!("{f};10,0;2;25")) as fn(f64) -> String,
            Some(Modulus::Young),
        ),
        (
            "Pulsation (1/s);Module de stockage G' (kPa);Module de perte G'' (kPa)",
            |f| format!("{:?};10000;2000", f * std::f64::consts::TAU).replace('.', ","),
            Some(Modulus::Shear),
        ),
        (
            "Fréquence [Hz];Module complexe [MPa];Angle de perte [°]",
            |f| format!("{f};10,198039;11,3099325"),
            None,
        ),
        (
            "Angular frequency(rad/s);Shear modulus (elastic component)(Pa);Shear modulus (viscous component)(Pa)",
            |f| format!("{:?};1.0e7;2e6", f * std::f64::consts::TAU),
            Some(Modulus::Shear),
        ),
    ] {
        let text = [1.0, 2.0, 4.0].map(row).join("\n");
        let curves = read(&format!("{head}\n{text}\n"), Kind::Dma);
        assert_eq!(
            (kind_of(&format!("{head}\n{text}\n")).unwrap(), curves.measure),
            (Kind::Dma, shear),
            "{head}"
        );
        let sweep = &curves.sweeps[0];
        for (n, wanted) in [tau, 2.0 * tau, 4.0 * tau].into_iter().enumerate() {
            assert!((sweep.x[n] / wanted - 1.0).abs() < 1e-12, "{head}: {:?}", sweep.x);
            // The angle is written with 9 digits.
            assert!((sweep.curves[0][n] / 10e6 - 1.0).abs() < 1e-7, "{head}: {:?}", sweep.curves);
            assert!((sweep.curves[1][n] / 2e6 - 1.0).abs() < 1e-7, "{head}: {:?}", sweep.curves);
        }
    }
    for (head, kind, value) in [
        ("Temps [heures];Module de relaxation [MPa]", Kind::Relaxation, 4e6),
        ("Durée [h];Complaisance de fluage [1/MPa]", Kind::Creep, 4e-6),
        ("Zeit [h];Kriechnachgiebigkeit [1/MPa]", Kind::Creep, 4e-6),
    ] {
        let text = format!("{head}\n0,5;4\n1;4\n2;4\n");
        assert_eq!(kind_of(&text).unwrap(), kind, "{head}");
        let sweep = read(&text, kind).sweeps.remove(0);
        assert!(
            sweep.x[0] == 1800.0 && (sweep.curves[0][0] / value - 1.0).abs() < 1e-12,
            "{head}: {sweep:?}"
        );
    }
}

#[test]
fn a_creep_modulus_is_no_relaxation_modulus() {
    for name in ["Creep modulus", "Kriechmodul", "Module de fluage", "Kriechmodul E_c(t)"] {
        let text = format!("Zeit [s];{name} [MPa]\n1;3\n2;2,5\n4;2\n");
        let error = kind_of(&text).unwrap_err();
        assert!(error.message.contains("reciprocal is the creep compliance"), "{error}");
        // Nor if the caller says so.
        let said = Columns {
            columns: [(Role::Modulus, asperity_files::curve::Column::Number(2))].into(),
            ..Columns::default()
        };
        let error = Curves::parse("x".as_ref(), text.as_bytes(), Kind::Relaxation, &said).unwrap_err();
        assert!(error.message.contains("reciprocal is the creep compliance"), "{error}");
    }
}

#[test]
fn a_title_above_a_repeated_heading_is_no_point() {
    let block = |n: i32| format!("Messung {n}\nZeit [s]\tE(t) [MPa]\n1\t{n}\n2\t{n}\n3\t{n}\n4\t{n}\n\n");
    let error = parse(&(block(2) + &block(1)), Kind::Relaxation).unwrap_err();
    assert_eq!((error.line, error.remedy.clone()), (Some(10), Some(Remedy::Segment(2))), "{error}");
    let said = Columns { segment: Some(2), ..Columns::default() };
    let curves =
        Curves::parse("x".as_ref(), (block(2) + &block(1)).as_bytes(), Kind::Relaxation, &said).unwrap();
    assert_eq!(curves.sweeps[0].curves[0], [1e6; 4]);
}
