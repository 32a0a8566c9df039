//! Any file is answered as a curve: by a fit or by a sentence, in time and within memory.

use asperity::indentation::{IndentationOptions, IndentationRecord, fit_indentation};
use asperity::material::{FitOptions, Moduli};
use asperity::reference::MdrProfile;
use asperity_files::curve::{
    Cantilever, Columns, Curves, ForceTable, Indentation, Kind, Request, ShiftRequest,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const KINDS: [Kind; 3] = [Kind::Relaxation, Kind::Creep, Kind::Dma];

/// How often each property is tried; `ASPERITY_CASES` asks for more.
fn cases() -> u32 {
    std::env::var("ASPERITY_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(400)
}

/// Reads and fits the bytes in every way; nothing may panic.
fn answer(bytes: &[u8]) {
    if let Ok(record) = Indentation::parse("any".as_ref(), bytes, &Columns::default()) {
        let taken = IndentationRecord { times: &record.times, loads: &record.loads, depths: &record.depths };
        let options = IndentationOptions { springs: 20, terms: Some(1), ..IndentationOptions::default() };
        match fit_indentation(MdrProfile::Paraboloid { radius: 1.0 }, &taken, &options) {
            Ok(fit) => assert!(fit.rms.is_finite()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    for cantilever in [None, Some(Cantilever { spring_constant: 0.5, sensitivity: Some(50e-9) })] {
        match ForceTable::parse("any".as_ref(), bytes, &Columns::default(), cantilever) {
            Ok(table) => assert!(table.loads.len() == table.depths.len()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    match Curves::kind_of_bytes("any".as_ref(), bytes, None) {
        Ok(kind) => assert!(!kind.name().is_empty()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    for kind in KINDS {
        let Ok(curves) = Curves::parse("any".as_ref(), bytes, kind, &Columns::default()) else { continue };
        let storage = FitOptions { moduli: Moduli::Storage, ..FitOptions::default() };
        let window = Some([0.5, 500.0]);
        for request in [
            Request::default(),
            Request { shift: ShiftRequest::Estimate(300.0), ..Request::default() },
            Request { options: storage, window, ..Request::default() },
        ] {
            match request.fit(&curves) {
                Ok(fitted) => assert!(fitted.misfit.max.is_finite() && !fitted.to_toml(&curves).is_empty()),
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
}

const GOOD: &str = "# T [K]; f [Hz]; E' [MPa]; E'' [MPa]\n300; 0,1; 2,5; 0,5\n300; 1; 3; 0,7\n300; 10; 4; 0,6\n\
                    310; 0,1; 2,1; 0,3\n310; 1; 2,5; 0,5\n310; 10; 3; 0,7\n";

/// Tables of other forms: points that lack numbers, blocks of columns, both functions of a step, values below 0.
const FORMS: [&str; 8] = [
    GOOD,
    "\"f [Hz]\",\"G' [Pa]\",\"Storage modulus [kPa]\",\"G'' [Pa]\",\"tan d\"\n\"0,1\",\"4000\",\"4\",\"1000\",\"0,25\"\n\"1\",\"5000\",\"5\",\"1000\",\"0,2\"\n\"10\",\"6000\",\"6\",\"600\",\"0,1\"\n",
    "#  Time/s  Step time/s  Relaxation modulus/MPa\n1  1.D+01  1.0D+00  4.0\n2  1.1D+01  2.0D+00  3.0\n3  1.3D+01  4.0D+00  2.5\n4  1.7D+01  8.0D+00  2.2\n",
    "Time [min];E [MPa];Strain [%]\n-;-;-\n0;;1\n0,1;4;1\n0,2;3;1\n0,4;2,5;1\n0,8;2,2;1\n1,6;2,1;1\n",
    "20,,25,\nf [Hz],E' [MPa],f [Hz],E' [MPa]\n0.1,5,0.1,4\n1,6,1,5\n10,7,10,6\n",
    "Step: creep\nt [s]\tStrain [%]\tJ [1/MPa]\tG [MPa]\n\t1\t\t\n0.1\t1\t1\t1\n1\t2\t2\t0.5\n10\t3\t3\t0.3333\n100\t4\t4\t0.25\n",
    "freq_hz,temperature_C,G_storage_pa,G_loss_pa\n1,20,5e5,1e5\n2,20,6e5,-1e5\n4,20,7e5,1e5\n1,30,4e5,1e5\n2,30,5e5,1e5\n4,30,6e5,0\n",
    "t [s],E [Pa]\n1,1e6\n2,5e5\n4,1e5\n8,1e4\n16,-2e3\n32,3e3\n64,-1e3\n",
];

proptest! {
    // A fixed seed: the same cases in every run.
    #![proptest_config(ProptestConfig {
        cases: cases(),
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_bytes_are_answered(bytes in vec(any::<u8>(), 0..200)) {
        answer(&bytes);
    }

    #[test]
    fn any_table_of_numbers_is_answered(rows in vec(vec("[0-9]{1,3}|-1|1e-?[0-9]{1,3}|nan|x|", 2..5), 0..12)) {
        let text: Vec<String> = rows.iter().map(|cells| cells.join(",")).collect();
        answer(format!("f [Hz], E' [Pa], E'' [Pa]\n{}", text.join("\n")).as_bytes());
        answer(text.join("\n").as_bytes());
        answer(format!("t [s], h [m], P [N]\n{}", text.join("\n")).as_bytes());
    }

    #[test]
    fn a_mutated_table_is_answered(
        form in 0..FORMS.len(),
        changes in vec((0.0..1.0f64, 0..6usize, "[0-9;,.\t\n#\\[\\]/'°eC-]{0,6}|OL|n/a|NaN|%|-1"), 1..4)
    ) {
        let mut bytes = FORMS[form].as_bytes().to_vec();
        for (place, length, put) in changes {
            let place = (place * bytes.len() as f64) as usize;
            let end = (place + length).min(bytes.len());
            bytes.splice(place..end, put.bytes());
        }
        answer(&bytes);
    }
}

#[test]
fn long_and_wide_tables_are_answered() {
    // More rows than a curve has, more columns than a table has, one endless line.
    let refused = |bytes: &[u8], words: &str| {
        let parsed = Curves::parse("any".as_ref(), bytes, Kind::Relaxation, &Columns::default());
        let message = parsed.unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    };
    refused("1,1\n".repeat(2_000_001).as_bytes(), "line 2000001: there are more than 2000000 points");
    refused("1,".repeat(100_000).as_bytes(), "100000 columns");
    refused(&vec![b'7'; 4_000_000], "the line is longer than 1048576 bytes");
    // Sixty-one decades, and as many times as nobody needs.
    answer(b"t [s], E [Pa]\n1e-30, 2\n1e31, 1\n");
}
