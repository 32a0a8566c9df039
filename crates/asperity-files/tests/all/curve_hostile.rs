//! Any file is answered as a curve: by a fit or by a sentence, in time and within memory.

use asperity::indentation::{IndentationOptions, IndentationRecord, fit_indentation};
use asperity::reference::MdrProfile;
use asperity_files::curve::{Columns, Curves, Indentation, Kind, Request, ShiftRequest};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const KINDS: [Kind; 3] = [Kind::Relaxation, Kind::Creep, Kind::Dma];

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
    for kind in KINDS {
        let Ok(curves) = Curves::parse("any".as_ref(), bytes, kind, &Columns::default()) else { continue };
        for shift in [ShiftRequest::None, ShiftRequest::Estimate(300.0)] {
            match (Request { shift, ..Request::default() }).fit(&curves) {
                Ok(fitted) => assert!(fitted.misfit.max.is_finite() && !fitted.to_toml(&curves).is_empty()),
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
}

const GOOD: &str = "# T [K]; f [Hz]; E' [MPa]; E'' [MPa]\n300; 0,1; 2,5; 0,5\n300; 1; 3; 0,7\n300; 10; 4; 0,6\n\
                    310; 0,1; 2,1; 0,3\n310; 1; 2,5; 0,5\n310; 10; 3; 0,7\n";

proptest! {
    // A fixed seed: the same cases in every run.
    #![proptest_config(ProptestConfig {
        cases: 400,
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
        place in 0..GOOD.len(), length in 0..6usize, put in "[0-9;,.\t\n#\\[\\]/'°eC-]{0,6}"
    ) {
        let mut bytes = GOOD.as_bytes().to_vec();
        let end = (place + length).min(bytes.len());
        bytes.splice(place..end, put.bytes());
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
