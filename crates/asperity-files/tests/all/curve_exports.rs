//! Exports of programs and spreadsheets of other languages: the same points, however they are written.

use asperity_files::curve::{Columns, CurveError, Curves, Kind};

fn parse(bytes: &[u8], kind: Kind) -> Result<Curves, CurveError> {
    Curves::parse("x.csv".as_ref(), bytes, kind, &Columns::default())
}

/// Each is a relaxation test of 4.5, 3 and 2.25 MPa at 0.5, 1.5 and 60 s.
#[test]
fn numbers_and_units_of_a_step_are_read_in_every_spelling() {
    for text in [
        "t [s] E(t) [MPa]\n0.5D+00 4.5D+00\n1.5D+00 3.0D+00\n6.0D+01 2.25D+00\n",
        "t [s],E [MPa]\n5.D-1,45.d-1\n1.5,3.\n60,2.25\n",
        "t [s];E [MPa]\n5,0E-01;4,5E+00\n1,5E+00;3,0E+00\n6,0E+01;2,25E+00\n",
        "\"t [s]\",\"E [MPa]\"\n\"0,5\",\"4,5\"\n\"1,5\",\"3,0\"\n\"60\",\"2,25\"\n",
        "\"t [s]\"; \"E [MPa]\"\n\n\"0.5\"; \"4.5\"\n\n\"1.5\"; \"3.0\"\n\n\"60\"; \"2.25\"\n\n",
        "t [s]\tE [Pa]\n0.5\t4,500,000.0\n1.5\t3,000,000.0\n60\t2,250,000.0\n",
        "t [s]\tE [MPa]\r0.5\t4.5\r1.5\t3\r60\t2.25\r",
        "log t [s],E [MPa]\n\u{2212}0.30102999566,4.5\n0.17609125906,3\n1.77815125038,2.25\n",
        "Time (minutes),E (MPa)\n0.008333333333333333,4.5\n0.025,3\n1,2.25\n",
        "Zeit (Stunden);E (MPa)\n0,0001388888888888889;4,5\n0,0004166666666666667;3\n0,016666666666666666;2,25\n",
    ] {
        let curves =
            parse(text.as_bytes(), Kind::Relaxation).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let sweep = &curves.sweeps[0];
        for (found, expected) in
            sweep.x.iter().chain(&sweep.curves[0]).zip([0.5, 1.5, 60.0, 4.5e6, 3e6, 2.25e6])
        {
            // Eleven digits of a logarithm.
            assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected} {text}");
        }
    }
    // Primes of the code of Windows.
    let mut bytes = b"f [Hz];G\x92 [MPa];G\x94 [MPa]\n".to_vec();
    bytes.extend(b"1;4;2\n2;5;1\n");
    assert_eq!(parse(&bytes, Kind::Dma).unwrap().sweeps[0].curves, [[4e6, 5e6], [2e6, 1e6]]);
}

#[test]
fn cells_that_are_no_numbers_are_named() {
    for (text, line, words) in [
        ("t;E\n0,5 s;4,5 MPa\n1,5 s;3 MPa\n", 2, "\"0,5 s\" (column 1)"),
        ("t [s];E [Pa]\n0,5;4 500 000,0\n1,5;3 000 000,0\n", 2, "\"4 500 000,0\" (column 2)"),
        ("t [s];E [Pa]\n0,5;4'500'000,0\n1,5;3'000'000,0\n", 2, "column 2"),
        ("t [s];E [Pa]\n0,5;4.500.000,0\n1,5;3.000.000,0\n", 2, "\"4.500.000,0\" (column 2)"),
        ("t;E [MPa]\n00:00:01;4\n00:00:02;3\n", 2, "\"00:00:01\" (column 1)"),
    ] {
        let error = parse(text.as_bytes(), Kind::Relaxation).unwrap_err();
        assert!(error.line == Some(line) && error.message.contains(words), "{error}");
    }
    let error = parse(b"t [s];E [Pa]\n0,5;4.500,5\n1,5;3.000,5\n", Kind::Relaxation).unwrap_err();
    assert!(
        error.message.contains("as in \"4.500,5\"") && error.message.contains("nothing between thousands"),
        "{error}"
    );
}

/// A heading of more names than the points have columns says nothing about any of them.
#[test]
fn a_heading_of_another_width_names_no_column() {
    let text = "T=80;chem=PI;\nFreq\tG'\tG\"\tTemp\tPhaseAngle\tTemp\tStress\nrad/s\tPa\tPa\t°C\t°\t°C\tPa\n\
                31.6  3.8E5  52512  80.02\n15.6  3.5E5  41512  80.01\n7.6  3.1E5  31512  80.02\n";
    let error = Curves::kind_of_bytes("x.osc".as_ref(), text.as_bytes(), None).unwrap_err();
    assert!(error.message.contains("1, 2, 3, 4, which the line above them, \"rad/s"), "{error}");
    let error = parse(text.as_bytes(), Kind::Dma).unwrap_err();
    assert!(error.message.contains("may hold a unit"), "{error}");
}

#[test]
fn a_last_column_that_begins_later_is_one() {
    let text = "f [Hz];G' [MPa];G'' [MPa];\n1;4;2;\n2;5;1;7\n";
    let curves = parse(text.as_bytes(), Kind::Dma).unwrap();
    assert_eq!(curves.sweeps[0].curves[1], [2e6, 1e6]);
    // Moduli at different frequencies below each other.
    let text = "w [rad/s];G' [Pa];G'' [Pa]\n1;4;\n2;5;\n3;6;\n1.5;;2\n2.5;;3\n3.5;;2\n";
    let error = parse(text.as_bytes(), Kind::Dma).unwrap_err();
    assert!(
        error.message.contains("6 of 6 points") && error.message.contains("3 of them that of"),
        "{error}"
    );
}

/// The units behind "in" and "_" are those of every quantity, and a labelled number below the table is no point.
#[test]
fn words_before_units_belong_to_no_name() {
    for text in [
        "f in Hz,G' in MPa,phase in rad,T in C\n1,4,0.5,25\n2,5,0.4,25\n",
        "f_Hz;G'_MPa;phase_rad;T_in_C\n1;4;0,5;25\n2;5;0,4;25\nSample: 12\n",
        "f in Hz\tG' in MPa\tphase in rad\tTemp. in °C\n1\t4\t0.5\t25\n2\t5\t0.4\t25\n\nMean: 12\n",
    ] {
        let curves = parse(text.as_bytes(), Kind::Dma).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let sweep = &curves.sweeps[0];
        assert_eq!((sweep.temperature, sweep.x.len(), sweep.curves[0][0]), (Some(298.15), 2, 4e6), "{text}");
        assert!((sweep.curves[1][0] / 4e6 - 0.5f64.tan()).abs() < 1e-12, "{text}");
    }
    for (time, seconds) in
        [("t in sec", 1.0), ("Step time in min", 60.0), ("Zeit_sec", 1.0), ("Zeit in h", 3600.0)]
    {
        let text = format!("{time},E in MPa\n1,4\n2,3\n");
        assert_eq!(parse(text.as_bytes(), Kind::Relaxation).unwrap().sweeps[0].x[0], seconds, "{time}");
    }
    // The secant modulus has no unit of time.
    let error = Curves::kind_of_bytes("x".as_ref(), b"t [s],E sec\n1,4\n2,3\n", None).unwrap_err();
    assert!(error.message.contains("\"E sec\""), "{error}");
}

/// Blanks part the columns and the words of a name; the first column counts the points.
#[test]
fn names_of_several_words_are_not_cut_into_names_of_several_columns() {
    let points = "0  1.0  0.5  4.0\n1  2.0  0.4  5.0\n2  4.0  0.3  6.0\n";
    let curves =
        parse(format!("#  f/Hz  phase/rad  Storage modulus/MPa\n{points}").as_bytes(), Kind::Dma).unwrap();
    assert_eq!(curves.columns.iter().map(|place| place.column).max(), Some(4));
    assert_eq!(curves.sweeps[0].curves[0], [4e6, 5e6, 6e6]);
    // Without a name above the counter, nothing says which column is the unnamed one.
    for heading in ["   f/Hz  phase/rad  Storage modulus/MPa", "f/Hz phase/rad Storage modulus/MPa"] {
        let error = parse(format!("{heading}\n{points}").as_bytes(), Kind::Dma).unwrap_err();
        assert!(error.message.contains("Storage modulus"), "{error}");
    }
}
