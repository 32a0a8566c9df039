//! Force curves from text tables: load and depth, or deflection and height of a cantilever, in the order of the measurement.
//!
//! ```
//! use asperity_files::curve::{Cantilever, Columns, ForceTable};
//! // depth = height less deflection, load = spring constant times deflection
//! let spring = Cantilever { spring_constant: 0.5, sensitivity: Some(50e-9) };
//! let text = "height [um],deflection [V]\n0,0\n1,4\n";
//! let table = ForceTable::parse("curve.csv".as_ref(), text.as_bytes(), &Columns::default(), Some(spring))?;
//! assert!((table.loads[1] - 100e-9).abs() < 1e-15 && (table.depths[1] - 0.8e-6).abs() < 1e-15);
//! # Ok::<(), asperity_files::curve::CurveError>(())
//! ```

use std::path::Path;

use super::columns::{self, Columns, Form};
use super::error::{CurveError, Remedy, fault};
use super::role::Role;
use super::workbook::sheets;
use super::{bytes, units};

const LOADS: Form = Form {
    name: "force curve",
    needed: &[Role::Depth, Role::Load],
    pairs: &[],
    optional: &[Role::Time],
    t: Role::Time,
};
const DEFLECTIONS: Form = Form { needed: &[Role::Height, Role::Deflection], ..LOADS };

/// The cantilever whose deflection was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cantilever {
    /// Spring constant \[N/m\].
    pub spring_constant: f64,
    /// Deflection per volt \[m/V\], where the column is in volts.
    pub sensitivity: Option<f64>,
}

/// A force curve in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTable {
    /// Loads \[N\].
    pub loads: Vec<f64>,
    /// Depths \[m\].
    pub depths: Vec<f64>,
    /// What was assumed about the file.
    pub notes: Vec<String>,
}

impl ForceTable {
    /// Reads columns of load and depth, or of deflection and height with a cantilever.
    ///
    /// # Errors
    /// [`CurveError`] with the line: no table, a column that is not there, a cell that is no number, a unit of another quantity, or a
    /// deflection in volts without a sensitivity.
    pub fn read(
        path: &Path,
        columns: &Columns,
        cantilever: Option<Cantilever>,
    ) -> Result<ForceTable, CurveError> {
        ForceTable::parse(path, &bytes(path)?, columns, cantilever)
    }

    /// From the bytes of a text table that is called `path` in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(
        path: &Path,
        bytes: &[u8],
        columns: &Columns,
        cantilever: Option<Cantilever>,
    ) -> Result<ForceTable, CurveError> {
        let form = if cantilever.is_some() { DEFLECTIONS } else { LOADS };
        let read = || {
            let sheet = sheets(bytes, columns.sheet.as_deref())?.into_iter().next();
            let table = sheet.ok_or_else(|| fault("the file holds no table"))?.table?;
            let columns::Read { mut values, places, notes, .. } = columns::values(&table, form, columns)?;
            let mut take = |role: Role| values.remove(&role).unwrap_or_default();
            let Some(Cantilever { spring_constant, sensitivity }) = cantilever else {
                return Ok(ForceTable { loads: take(Role::Load), depths: take(Role::Depth), notes });
            };
            let [height, deflection] = [Role::Height, Role::Deflection].map(&mut take);
            let unit =
                places.iter().find(|place| place.role == Role::Deflection).map_or("", |place| &place.unit);
            let wrong = |why: &str| {
                Err(fault(format!("deflection is in {unit}{why}")).remedy(Remedy::Unit(Role::Deflection)))
            };
            let scale = match (units::is_voltage(unit), sensitivity) {
                (true, Some(scale)) => scale,
                (false, None) => 1.0,
                (true, None) => return wrong(": give the sensitivity, the deflection per volt"),
                (false, Some(_)) => return wrong(", but a sensitivity is that of volts"),
            };
            let bent: Vec<f64> = deflection.iter().map(|x| scale * x).collect();
            Ok(ForceTable {
                loads: bent.iter().map(|x| spring_constant * x).collect(),
                depths: height.iter().zip(&bent).map(|(height, bent)| height - bent).collect(),
                notes,
            })
        };
        read().map_err(|fault: super::error::CurveError| fault.of(path))
    }
}
