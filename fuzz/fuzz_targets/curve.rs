#![no_main]

use asperity_files::curve::{Calibration, Cantilever, Columns, Curves, ForceTable, Indentation, Kind, read_curves};

// Text tables and spreadsheets (.xls, .xlsx), as each kind of measurement, and the force curves of Nanoscope files.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = Curves::kind_of_bytes("curve".as_ref(), data, None);
    for kind in [Kind::Dma, Kind::Relaxation, Kind::Creep] {
        if let Ok(curves) = Curves::parse("curve".as_ref(), data, kind, &Columns::default()) {
            let numbers =
                curves.sweeps.iter().flat_map(|sweep| sweep.curves.iter().flatten().chain(&sweep.x));
            assert!(numbers.into_iter().all(|number| number.is_finite()));
        }
    }
    for curve in read_curves(data, Calibration::default()).unwrap_or_default() {
        assert!(curve.height.len() == curve.deflection.len() && curve.approach <= curve.height.len());
        assert!(curve.height.iter().chain(&curve.deflection).all(|number| number.is_finite()));
    }
    let _ = Indentation::parse("record".as_ref(), data, &Columns::default());
    for cantilever in [None, Some(Cantilever { spring_constant: 0.5, sensitivity: Some(50e-9) })] {
        if let Ok(table) = ForceTable::parse("record".as_ref(), data, &Columns::default(), cantilever) {
            assert!(table.loads.iter().chain(&table.depths).all(|number| number.is_finite()));
        }
    }
});
