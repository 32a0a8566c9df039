//! Force curves in files of instruments.

use std::path::Path;

use asperity_io::curve::{Calibration, ForceTable, Indentation, InstrumentCurve, read_curve_file};
use asperity_io::quantity::Quantity;

use crate::args::FitIndentation;
use crate::failure::{Failure, refuse};

/// Endings of files that the Python package reads by another one.
const BY_PYTHON: [&str; 7] =
    ["jpk-force", "jpk-force-map", "jpk-qi-data", "jpk-qi-series", "ibw", "h5", "tab"];

/// The force curve of a file of an instrument; `None` of a text table.
fn read(args: &FitIndentation) -> Result<Option<InstrumentCurve>, Failure> {
    let path: &Path = &args.record;
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    if BY_PYTHON.iter().any(|known| ending.eq_ignore_ascii_case(known)) {
        refuse!(
            "{}: force curves of this kind are read by the Python package (pip install 'asperity[afm]'): \
             curve = asperity.read_force_curves(file)[0], then asperity.fit_indentation(curve, ...); or export the file as text, with columns of \
             time, load and depth",
            path.display()
        );
    }
    let calibration = Calibration {
        spring_constant: args.curve.spring_constant.map(Quantity::get),
        sensitivity: args.curve.sensitivity.map(Quantity::get),
    };
    // What cannot be opened is told by the reader of tables.
    if !path.is_file() {
        return Ok(None);
    }
    let curves = read_curve_file(path, calibration).map_err(|error| Failure::input(error.to_string()))?;
    let Some(curves) = curves else { return Ok(None) };
    let count = curves.len();
    match <[InstrumentCurve; 1]>::try_from(curves) {
        Ok([curve]) => Ok(Some(curve)),
        Err(_) => refuse!(
            "{} holds {count} force curves: asperity.fit_force_map(asperity.read_force_curves(file), ...) of the Python package fits all of them",
            path.display()
        ),
    }
}

/// Loads and depths of the file of an instrument.
pub fn table(args: &FitIndentation) -> Result<Option<ForceTable>, Failure> {
    let of =
        |curve: InstrumentCurve| ForceTable { loads: curve.loads(), depths: curve.depths(), notes: vec![] };
    Ok(read(args)?.map(of))
}

/// The approach of the file of an instrument.
pub fn record(args: &FitIndentation) -> Result<Option<Indentation>, Failure> {
    let Some(curve) = read(args)? else { return Ok(None) };
    let Some(times) = &curve.time else {
        refuse!(
            "{} does not state the velocity of the ramp, from which its times follow",
            args.record.display()
        )
    };
    let first = |column: Vec<f64>| column[..curve.approach].to_vec();
    Ok(Some(Indentation {
        path: args.record.clone(),
        times: first(times.clone()),
        loads: first(curve.loads()),
        depths: first(curve.depths()),
        notes: vec!["the approach is fitted, with the depth of first touch".to_owned()],
    }))
}
