//! A quantity in several columns: the one whose unit is known is taken, and the others must agree with it.

use asperity::material::Modulus;
use asperity_files::curve::{Column, Columns, CurveError, Curves, ForceTable, Kind, Remedy, Role};

fn parse(text: &str, kind: Kind, columns: &Columns) -> Result<Curves, CurveError> {
    Curves::parse("x.csv".as_ref(), text.as_bytes(), kind, columns)
}

fn named(pairs: &[(Role, usize)]) -> Columns {
    Columns {
        columns: pairs.iter().map(|(role, n)| (*role, Column::Number(*n))).collect(),
        ..Columns::default()
    }
}

/// Points at 0.1, 1 and 10 Hz: `row` of the frequency in Hz and of storage and loss modulus in MPa.
fn dma(header: &str, row: impl Fn(f64, f64, f64) -> String) -> String {
    let rows = [(0.1, 2.0, 0.5), (1.0, 3.0, 0.6), (10.0, 4.0, 0.4)].map(|(f, s, l)| row(f, s, l));
    format!("{header}\n{}\n", rows.join("\n"))
}

const OMEGA: [f64; 3] = [0.2 * std::f64::consts::PI, 2.0 * std::f64::consts::PI, 20.0 * std::f64::consts::PI];

fn assert_read(text: &str) {
    let curves =
        parse(text, Kind::Dma, &Columns::default()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let sweep = &curves.sweeps[0];
    for n in 0..3 {
        let expected = [OMEGA[n], [2e6, 3e6, 4e6][n], [0.5e6, 0.6e6, 0.4e6][n]];
        for (found, expected) in [sweep.x[n], sweep.curves[0][n], sweep.curves[1][n]].iter().zip(expected) {
            // Five digits of an angular frequency.
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected} {text}");
        }
    }
}

fn refused(text: &str, kind: Kind, words: &[&str], remedy: &Remedy) {
    let error = parse(text, kind, &Columns::default()).expect_err(text);
    assert!(words.iter().all(|word| error.message.contains(word)), "{error}");
    assert_eq!(error.remedy.as_ref(), Some(remedy), "{error}");
}

#[test]
fn columns_that_hold_the_same_are_one() {
    let tau = std::f64::consts::TAU;
    for text in [
        dma("Frequency [Hz],Angular frequency [rad/s],G' [MPa],G'' [MPa]", |f, s, l| {
            format!("{f},{:.4},{s},{l}", tau * f)
        }),
        // The unit decides.
        dma("Frequency,Angular frequency [rad/s],G' [MPa],G'' [MPa]", |f, s, l| {
            format!("{f},{:.5},{s},{l}", tau * f)
        }),
        dma(
            "f [Hz],Storage modulus [Pa],Loss modulus [Pa],Storage modulus [MPa],Loss modulus [MPa]",
            |f, s, l| format!("{f},{},{},{s},{l}", 1e6 * s, 1e6 * l),
        ),
        // A raw signal is no modulus, and a column without numbers none either.
        dma("f [Hz],G' [V],G' [MPa],G'' [MPa],Loss modulus [MPa]", |f, s, l| format!("{f},0.3,{s},{l},-")),
        // Rounded to a tenth of a megapascal.
        dma("f [Hz],G' [kPa],Storage modulus [MPa],G'' [MPa]", |f, s, l| {
            format!("{f},{},{:.1},{l}", 1e3 * s, s + 0.04)
        }),
        dma("f [Hz],G' [MPa],G'' [MPa],tan delta", |f, s, l| format!("{f},{s},{l},{:.2}", l / s)),
    ] {
        assert_read(&text);
    }
}

#[test]
fn columns_that_contradict_each_other_are_refused_by_name() {
    let both = dma("f [Hz],G' [Pa],G'' [Pa],E' [Pa],E'' [Pa]", |f, s, l| {
        format!("{f},{},{},{},{}", 1e6 * s, 1e6 * l, 3e6 * s, 3e6 * l)
    });
    refused(
        &both,
        Kind::Dma,
        &["column 2, \"G' [Pa]\"", "column 4, \"E' [Pa]\"", "2.000000e6", "6.000000e6 Pa"],
        &Remedy::Column(Role::Storage),
    );
    // The caller says which.
    let young = parse(&both, Kind::Dma, &named(&[(Role::Storage, 4), (Role::Loss, 5)])).unwrap();
    assert_eq!((young.measure, young.sweeps[0].curves[1][0]), (Some(Modulus::Young), 1.5e6));
    refused(
        &dma("Frequency [rad/s],Angular frequency [rad/s],G' [MPa],G'' [MPa]", |f, s, l| {
            format!("{f},{},{s},{l}", 6.0 * f)
        }),
        Kind::Dma,
        &["column 1", "column 2", "are both named as frequency"],
        &Remedy::Column(Role::Frequency),
    );
    refused(
        "Time [s],Time [min],E [MPa]\n1,1,3\n2,2,2\n3,3,1\n",
        Kind::Relaxation,
        &["column 1, \"Time [s]\"", "column 2, \"Time [min]\"", "1.000000e0 and 6.000000e1 s"],
        &Remedy::Column(Role::Time),
    );
    // The loss modulus is in MPa.
    let wrong = dma("f [Hz],G' [MPa],G'' [Pa],tan delta", |f, s, l| format!("{f},{s},{l},{:.4}", l / s));
    refused(&wrong, Kind::Dma, &["column 3", "column 2", "column 4"], &Remedy::Unit(Role::Loss));
    let said = Columns { units: [(Role::Loss, "MPa".to_owned())].into(), ..Columns::default() };
    assert_eq!(parse(&wrong, Kind::Dma, &said).unwrap().sweeps[0].curves[1], [0.5e6, 0.6e6, 0.4e6]);
    // A force curve.
    let text = "Displacement [nm],Depth [nm],Load [mN]\n2.5,1,1\n3.5,2,2\n4.5,3,3\n";
    let force = |columns: &Columns| ForceTable::parse("x.csv".as_ref(), text.as_bytes(), columns, None);
    assert_eq!(force(&Columns::default()).unwrap_err().remedy, Some(Remedy::Column(Role::Depth)));
    assert_eq!(force(&named(&[(Role::Depth, 2)])).unwrap().depths[0], 1e-9);
}

#[test]
fn the_time_of_the_step_is_not_that_of_the_test() {
    for header in ["Time [s],Step time [s],E [MPa]", "Total time [s],Step time [s],E [MPa]"] {
        let text = format!("{header}\n1001,1,3\n1002,2,2\n1004,4,1\n");
        let curves = parse(&text, Kind::Relaxation, &Columns::default()).unwrap();
        assert_eq!(curves.sweeps[0].x, [1.0, 2.0, 4.0], "{header}");
        assert!(
            curves.notes.iter().any(|note| note.contains("time is that of column 2")),
            "{:?}",
            curves.notes
        );
    }
}

#[test]
fn a_frequency_without_a_unit_lists_the_columns() {
    let text = dma("frequency,G' [MPa],G'' [MPa]", |f, s, l| format!("{f},{s},{l}"));
    refused(
        &text,
        Kind::Dma,
        &["has no unit", "1 \"frequency\", 2 \"G' [MPa]\", 3 \"G'' [MPa]\""],
        &Remedy::Unit(Role::Frequency),
    );
}
