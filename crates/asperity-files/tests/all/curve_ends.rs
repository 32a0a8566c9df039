//! Where a table ends, and where the steps within it do: rows that sum it up, text below it, and times that begin again.

use asperity_files::curve::{Columns, CurveError, Curves, Kind, Remedy, Role, Words};

fn parse(text: &str, kind: Kind) -> Result<Curves, CurveError> {
    Curves::parse("x.csv".as_ref(), text.as_bytes(), kind, &Columns::default())
}

fn read(text: &str, kind: Kind) -> Curves {
    parse(text, kind).unwrap_or_else(|error| panic!("{error}:\n{text}"))
}

/// Twenty points of E' = 10 MPa, E'' = 1 MPa at 0.1, 0.2, ... Hz, and the names above them.
fn dma(separator: &str, comma: bool, first: &str) -> String {
    let names = ["f [Hz]", "E' [MPa]", "E'' [MPa]"].join(separator);
    let head = if first.is_empty() { String::new() } else { format!("{first}{separator}") };
    let row = |k: i32| {
        let f = format!("{:.1}", 0.1 * f64::from(k));
        let f = if comma { f.replace('.', ",") } else { f };
        let label = match first {
            "" => String::new(),
            "Probe" => format!("A12{separator}"),
            _ => format!("{k}{separator}"),
        };
        format!("{label}{f}{separator}10{separator}1\n")
    };
    format!("{head}{names}\n{}", (1..=20).map(row).collect::<String>())
}

#[test]
fn rows_that_sum_up_a_table_and_text_below_it_are_no_points() {
    let labels = [
        "Mean",
        "Std. dev.",
        "Mittelwert",
        "Écart type",
        "\"Mean\"",
        "Max",
        "SD",
        "Average of 20",
        "Standardabweichung",
    ];
    for (separator, comma) in [(",", false), (";", false), (";", true), ("\t", true)] {
        for first in ["", "Punkt", "Probe"] {
            let table = dma(separator, comma, first);
            for label in labels {
                // A word that another program writes below numbers is told from them as well.
                let number = if comma { "0,7" } else { "0.7" };
                let row = [label, number, "6", "4"][..if first.is_empty() { 3 } else { 4 }].join(separator);
                let footers = [
                    format!("{row}\n"),
                    format!("\n{row}\n{row}\nEnd of data\n"),
                    format!("{row}{separator}5\n"),
                    format!("\n{row}\n\nRemarks{separator} none{separator} at all{separator}\nA 12\n"),
                    format!("{row}\n# end\n"),
                ];
                for footer in footers {
                    let curves = read(&format!("{table}{footer}"), Kind::Dma);
                    let sweep = &curves.sweeps[0];
                    assert_eq!((curves.sweeps.len(), sweep.x.len()), (1, 20), "{table}{footer}");
                    assert!(sweep.curves[0].iter().all(|e| (e / 10e6 - 1.0).abs() < 1e-12));
                    assert!(curves.notes.iter().any(|note| note.contains("not read")), "{:?}", curves.notes);
                }
            }
        }
    }
    // Text without a number is no news.
    for footer in ["END\n", "Remarks, none, at all\n", "\nend,,\n", "# Mean: 12, 13\n"] {
        let curves = read(&(dma(",", false, "") + footer), Kind::Dma);
        assert_eq!((curves.points(), curves.notes.len()), (20, 0), "{footer} {:?}", curves.notes);
    }
}

#[test]
fn means_between_sweeps_are_left_out_and_told() {
    let sweep = |celsius: i32, factor: i32| {
        let row = |k: i32| format!("{celsius},{k},{},{}\n", 10 * factor * k, factor * k);
        (1..=6).map(row).collect::<String>() + "Mean,3.5,35,3.5\n"
    };
    let text = format!("T [°C],f [Hz],E' [MPa],E'' [MPa]\n{}{}", sweep(20, 2), sweep(40, 1));
    let curves = read(&text, Kind::Dma);
    assert_eq!(curves.sweeps.iter().map(|sweep| sweep.x.len()).collect::<Vec<_>>(), [6, 6]);
    assert!(curves.notes.iter().any(|note| note.contains("line 8")), "{:?}", curves.notes);
    // Other words between points are faults, as they were.
    let error = parse(&text.replacen("Mean", "Ende", 1), Kind::Dma).unwrap_err();
    assert_eq!(error.line, Some(8), "{error}");
    // Points of which each has such a name are points.
    let named = "Name,f [Hz],E' [MPa],E'' [MPa]\nMean,1,10,1\nMean,2,11,1\nMean,3,12,1\n";
    assert_eq!(read(named, Kind::Dma).points(), 3);
}

#[test]
fn rows_without_a_label_are_not_taken_for_points_in_silence() {
    // The counter of the points is missing.
    let curves = read(&(dma(",", false, "Punkt") + ",0.7,6,4\n,0.8,2,1\n"), Kind::Dma);
    assert_eq!(curves.points(), 20);
    assert!(curves.notes.iter().any(|note| note.contains("lines 22 to 23")), "{:?}", curves.notes);
    // Below a blank line, at a frequency that does not go on.
    let error = parse(&(dma(",", false, "") + "\n0.75,6,4\n"), Kind::Dma).unwrap_err();
    assert!(error.line == Some(23) && error.message.contains("sum the points up"), "{error}");
    // Points that go on below a blank line are points; so are those of sweeps between blank lines.
    assert_eq!(read(&(dma(",", false, "") + "\n2.1,10,1\n2.2,10,1\n"), Kind::Dma).points(), 22);
    let sweeps = "T [°C],f [Hz],E' [MPa],E'' [MPa]\n".to_owned()
        + &[20, 40, 60]
            .map(|t| (1..=12).map(|f| format!("{t},{f},{},1\n", 100 - t + f)).collect::<String>() + "\n")
            .concat()
        + "80,1,5,1\n80,2,6,1\n";
    assert_eq!(read(&sweeps, Kind::Dma).points(), 38);
}

#[test]
fn a_table_below_the_table_is_told_or_refused() {
    let factors = read(&(dma(",", false, "") + "\nT,log_aT\n20,0\n30,-1\n"), Kind::Dma);
    assert!(factors.points() == 20 && factors.notes.iter().any(|note| note.contains("another table")));
    let wider = dma(",", false, "") + "\nStep 2\nf [Hz],E' [MPa],E'' [MPa],T [°C]\n1,2,3,4\n2,3,4,5\n";
    assert!(parse(&wider, Kind::Dma).is_err());
}

/// Steps of 12 points of E = `level` MPa each, at 1, 2, ... s.
fn steps(levels: &[f64], column: bool) -> String {
    let rows = levels.iter().enumerate().flat_map(|(n, level)| {
        let label = if column { format!("{},", n + 1) } else { String::new() };
        (1..=12).map(move |t| format!("{label}{t},{level}\n"))
    });
    format!("{}Time [s],E(t) [MPa]\n{}", if column { "Segment," } else { "" }, rows.collect::<String>())
}

#[test]
fn a_time_that_begins_again_names_the_segments_and_one_can_be_chosen() {
    for column in [false, true] {
        let text = steps(&[3.0, 2.0, 1.0], column);
        let error = parse(&text, Kind::Relaxation).unwrap_err();
        assert_eq!(error.remedy, Some(Remedy::Segment(3)), "{error}");
        assert!(error.message.contains("3 segments (lines 2 to 13, 14 to 25, 26 to 37)"), "{error}");
        assert_eq!(error.line, (!column).then_some(14), "{error}");
        assert!(error.told(Words::Command).contains("--segment N"), "{error}");
        for (segment, level) in [(1, 3e6), (2, 2e6), (3, 1e6)] {
            let said = Columns { segment: Some(segment), ..Columns::default() };
            let curves = Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Relaxation, &said).unwrap();
            let sweep = &curves.sweeps[0];
            assert!(sweep.x.len() == 12 && sweep.curves[0].iter().all(|e| *e == level), "{sweep:?}");
            assert!(curves.notes.iter().any(|note| note.contains(&format!("segment {segment}"))));
        }
        for segment in [0, 4] {
            let said = Columns { segment: Some(segment), ..Columns::default() };
            let error =
                Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Relaxation, &said).unwrap_err();
            assert_eq!(error.remedy, Some(Remedy::Segment(3)));
        }
    }
    // One temperature for all rows does not tell them apart either.
    let warm = steps(&[3.0, 2.0], false)
        .replace(']', "],T [°C]")
        .replace("],T [°C],E(t) [MPa],T [°C]", "],E(t) [MPa],T [°C]");
    let warm = warm
        .lines()
        .enumerate()
        .map(|(n, line)| if n == 0 { format!("{line}\n") } else { format!("{line},25\n") });
    let error = parse(&warm.collect::<String>(), Kind::Relaxation).unwrap_err();
    assert_eq!((error.line, error.remedy.clone()), (Some(14), Some(Remedy::Segment(2))), "{error}");
}

#[test]
fn times_that_go_on_from_one_step_to_the_next_are_not_those_of_a_step() {
    let rows: String = (1..=12).map(|t| format!("{},{t},3\n", if t <= 6 { "a" } else { "b" })).collect();
    let text = format!("Segment,Time [s],E(t) [MPa]\n{rows}");
    let said = |segment| Columns { segment: Some(segment), ..Columns::default() };
    let parse = |segment| Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Relaxation, &said(segment));
    assert_eq!(parse(1).unwrap().points(), 6);
    let error = parse(2).unwrap_err();
    assert!(error.line == Some(8) && error.message.contains("its own beginning"), "{error}");
}

#[test]
fn a_point_out_of_order_is_no_segment() {
    let text = "Time [s],E(t) [MPa]\n1,5\n2,4\n4,3\n3,3.5\n5,2\n";
    let curves = read(text, Kind::Relaxation);
    assert_eq!(curves.sweeps[0].x, [1.0, 2.0, 4.0, 3.0, 5.0], "the fit names the point");
}

#[test]
fn sweeps_of_a_dma_below_each_other_are_chosen_too() {
    let row = |f: i32, e: i32| format!("{f},{e},1\n");
    let rows = |e: i32| (1..=8).map(|f| row(f, e)).collect::<String>();
    let text = format!("f [Hz],E' [MPa],E'' [MPa]\n{}{}", rows(10), rows(20));
    let error = parse(&text, Kind::Dma).unwrap_err();
    assert_eq!(error.remedy, Some(Remedy::Segment(2)), "{error}");
    let said = Columns { segment: Some(2), ..Columns::default() };
    let curves = Curves::parse("x.csv".as_ref(), text.as_bytes(), Kind::Dma, &said).unwrap();
    assert!(curves.points() == 8 && curves.sweeps[0].curves[0].iter().all(|e| *e == 20e6));
}

#[test]
fn everything_that_a_file_leaves_open_is_asked_for_at_once() {
    let command = |text: &str, kind: Option<Kind>| {
        let kind = kind.map_or_else(|| Curves::kind_of_bytes("my x.csv".as_ref(), text.as_bytes(), None), Ok);
        let read = kind
            .and_then(|kind| Curves::parse("my x.csv".as_ref(), text.as_bytes(), kind, &Columns::default()));
        read.unwrap_err().told(Words::Command)
    };
    for (text, kind, wanted) in [
        (
            "0.1,10,1\n0.2,11,1\n",
            None,
            "asperity material fit 'my x.csv' --kind dma --unit frequency=Hz --unit storage=MPa --unit loss=MPa",
        ),
        (
            "0.1,10,1\n0.2,11,1\n",
            Some(Kind::Dma),
            "--kind dma --unit frequency=Hz --unit storage=MPa --unit loss=MPa",
        ),
        ("0.1,10\n0.2,11\n", None, "--kind relaxation --unit time=s --unit modulus=MPa"),
        (
            "1,0.1,10,1,25\n2,0.2,11,1,25\n",
            Some(Kind::Dma),
            "--column frequency=N --column storage=N --column loss=N --unit frequency=Hz --unit storage=MPa --unit loss=MPa, N the number",
        ),
        (
            "omega,G',G''\n1,2,3\n2,3,4\n",
            None,
            "--kind dma --unit frequency=rad/s --unit storage=MPa --unit loss=MPa",
        ),
        (
            "f [Hz],A,B\n1,2,3\n2,3,4\n",
            Some(Kind::Dma),
            "--kind dma --column storage=N --column loss=N, N the number",
        ),
    ] {
        let told = command(text, kind);
        assert!(told.contains(wanted), "{told}");
    }
    // The command that the message gives works.
    let units = [(Role::Frequency, "Hz"), (Role::Storage, "MPa"), (Role::Loss, "MPa")]
        .map(|(role, unit)| (role, unit.to_owned()));
    let said = Columns { units: units.into(), ..Columns::default() };
    let curves = Curves::parse("x".as_ref(), b"0.1,10,1\n0.2,11,1\n", Kind::Dma, &said).unwrap();
    assert!((curves.sweeps[0].curves[0][0] / 10e6 - 1.0).abs() < 1e-12);
}

#[test]
fn text_of_two_bytes_a_character_needs_no_mark() {
    let text = dma(";", true, "") + "Mittelwert;0,7;µ;Ω\n";
    for unit in [u16::to_le_bytes, u16::to_be_bytes] {
        let bytes: Vec<u8> = text.encode_utf16().flat_map(unit).collect();
        let curves = Curves::parse("x.csv".as_ref(), &bytes, Kind::Dma, &Columns::default()).unwrap();
        assert!(curves.points() == 20 && (curves.sweeps[0].curves[0][0] / 10e6 - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_record_whose_time_begins_again_names_the_line() {
    use asperity_files::curve::Indentation;
    let parse = |text: &str| Indentation::parse("x.csv".as_ref(), text.as_bytes(), &Columns::default());
    let head = "Zeit [s];Eindringtiefe [µm];Kraft [mN]\n";
    let error = parse(&format!("{head}0;0;0\n1;1;1\n0,5;1;0,9\n1;1;0,8\n")).unwrap_err();
    assert!(error.line == Some(4) && error.message.contains("segments"), "{error}");
    // Names of a nanoindenter and of a universal testing machine; a row that sums up the others is none of them.
    for (head, row) in [
        ("\"Time On Sample\";\"Displacement Into Surface\";\"Load On Sample\"\ns;nm;mN", ["2000", "3"]),
        ("Zeit [s];Weg in µm;Standardkraft [mN]", ["2", "3"]),
        ("Temps (s);Profondeur (nm);Charge (µN)", ["2000", "3000"]),
    ] {
        let [depth, load] = row;
        let text = format!("{head}\n0;0;0\n1;{depth};{load}\n2;{depth};{load}\nMittelwert;1;2\n");
        let record = parse(&text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(record.times, [0.0, 1.0, 2.0], "{head}");
        assert!(
            (record.depths[1] / 2e-6 - 1.0).abs() < 1e-12 && (record.loads[1] / 3e-3 - 1.0).abs() < 1e-12
        );
        assert_eq!(record.notes.len(), 1, "{:?}", record.notes);
    }
    // Names that nobody knows are told.
    let record = parse("Alpha [s];Beta [mN];Gamma [um]\n0;0;0\n1;1;1\n").unwrap();
    assert!(
        record.notes.iter().any(|note| note.contains("no name of a column is known")),
        "{:?}",
        record.notes
    );
}
