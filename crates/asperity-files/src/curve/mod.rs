//! Measured curves of materials: relaxation tests, creep tests and DMA sweeps from text tables and spreadsheets.
//!
//! ```text
//! file --Table--> names, units, cells --Columns--> quantities in SI --Curves--> sweeps, one per temperature
//!      --Request::fit--> master curve --> Prony series with its misfit
//! ```
//!
//! Separator and decimal mark are found from the file. The meaning and the unit of each column come from its header or from the
//! caller. A spreadsheet may hold shift factors as well. An error names the line that does not fit.
//!
//! ```
//! use asperity_files::curve::{Columns, Curves, Kind, Request};
//! // E(t) = 1 MPa + 2 MPa exp(-t/10 s), as a relaxation test saves it.
//! let mut text = "time [s]; E [MPa]\n".to_owned();
//! for k in 0..40 {
//!     let t = 10f64.powf(-1.0 + 0.1 * k as f64);
//!     text += &format!("{t:.6e}; {:.6}\n", 1.0 + 2.0 * (-t / 10.0).exp()).replace('.', ",");
//! }
//! let curves = Curves::parse("test.csv".as_ref(), text.as_bytes(), Kind::Relaxation, &Columns::default())?;
//! let fitted = Request::default().fit(&curves)?;
//! let relaxation = fitted.material.relaxation().map_err(|e| e.to_string())?;
//! assert!((relaxation.instantaneous() / 3e6 - 1.0).abs() < 1e-4 && fitted.misfit.max < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod alternatives;
mod below;
mod block;
mod clean;
mod columns;
mod error;
mod factors;
mod fit;
mod force;
mod heading;
mod indentation;
mod isotherms;
mod kind;
mod names;
mod role;
mod segments;
mod sweeps;
mod table;
mod thin;
mod units;
mod vertical;
mod whole;
mod wide;
mod workbook;

use std::path::{Path, PathBuf};

pub use crate::topography::{
    Calibration, InstrumentCurve, Place as GridPlace, holds_curves, read_curve_file, read_curves,
};
pub use columns::{Column, Columns, Place};
pub use error::{CurveError, Remedy, Words};
pub use factors::{HeldShift, read_shift_table};
pub use fit::{Fitted, Request, Series, ShiftRequest};
pub use force::{Cantilever, ForceTable};
pub use indentation::{Indentation, IndentationTest, MaterialOf, indentation_block, power_law_block};
pub use role::Role;
pub use thin::thinned;
pub use units::angular_frequency;
pub use vertical::{VerticalRequest, VerticalWord};
pub use whole::Whole;

use asperity::material::Modulus;
use serde::Deserialize;

use crate::choice;
use error::fault;
use segments::Segments;
use table::Table;
use workbook::{Sheet, listed};

/// What was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Relaxation modulus over time.
    #[default]
    Relaxation,
    /// Creep compliance over time.
    Creep,
    /// Storage and loss modulus over frequency.
    Dma,
}

impl Kind {
    /// "relaxation", "creep" or "dma".
    pub fn name(self) -> &'static str {
        choice::word(&self)
    }

    /// The names of its curves.
    fn columns(self) -> &'static [&'static str] {
        match self {
            Kind::Relaxation => &["relaxation modulus"],
            Kind::Creep => &["creep compliance"],
            Kind::Dma => &["storage", "loss"],
        }
    }
}

/// The points measured at one temperature, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Mean temperature \[K\]; `None` where the file holds none.
    pub temperature: Option<f64>,
    /// Times \[s\] or angular frequencies \[rad/s\], in order.
    pub x: Vec<f64>,
    /// The modulus \[Pa\], the compliance \[1/Pa\], or storage and loss modulus \[Pa\].
    pub curves: Vec<Vec<f64>>,
    /// The line of the file of each point.
    pub lines: Vec<usize>,
}

impl Sweep {
    /// Its temperature in words: "-20.0 °C".
    fn celsius(&self) -> Option<String> {
        self.temperature.map(|kelvin| format!("{:.1} °C", kelvin - 273.15))
    }
}

/// What a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// The file.
    pub path: PathBuf,
    /// What was measured.
    pub kind: Kind,
    /// Whether its header names Young's moduli (E, D) or shear moduli (G, J).
    pub measure: Option<Modulus>,
    /// One sweep per temperature, the coldest first.
    pub sweeps: Vec<Sweep>,
    /// Points that lack a number and were left out.
    pub left_out: usize,
    /// The sheet of a spreadsheet that was read.
    pub sheet: Option<String>,
    /// The columns that were read.
    pub columns: Vec<Place>,
    /// Headers of the columns that were not.
    pub unused: Vec<String>,
    /// What the other sheets of a spreadsheet say of the shift.
    pub held: HeldShift,
    /// What was assumed about the file.
    pub notes: Vec<String>,
    /// MD5 of its bytes: another file has another one.
    pub digest: String,
}

/// A larger file is no curve.
const MOST_BYTES: u64 = 64 << 20;

impl Curves {
    /// Reads a text table or a sheet of a spreadsheet.
    ///
    /// # Errors
    /// [`CurveError`] with the line: no table, a column that is not there, a cell that is no number, a unit of
    /// another quantity, temperatures that form no sweeps.
    pub fn read(path: &Path, kind: Kind, columns: &Columns) -> Result<Curves, CurveError> {
        Curves::parse(path, &bytes(path)?, kind, columns)
    }

    /// What a file, or a sheet of it, holds according to its header.
    ///
    /// # Errors
    /// [`CurveError`] if the file cannot be read, holds no table, or its header does not say what was measured.
    pub fn kind_of(path: &Path, sheet: Option<&str>) -> Result<Kind, CurveError> {
        Curves::kind_of_bytes(path, &bytes(path)?, sheet)
    }

    /// What the bytes of a file that is called `path` in messages hold.
    ///
    /// # Errors
    /// As [`kind_of`](Self::kind_of).
    pub fn kind_of_bytes(path: &Path, bytes: &[u8], sheet: Option<&str>) -> Result<Kind, CurveError> {
        let kind = || -> Result<Kind, CurveError> {
            let (mut tables, mut refused) = (Vec::new(), None);
            for sheet in workbook::sheets(bytes, sheet)? {
                match sheet.table {
                    Ok(table) => tables.push((sheet.name, table)),
                    Err(fault) => refused = refused.or(Some(fault)),
                }
            }
            for (name, table) in &tables {
                if let Some(kind) = kind::of(table, name.as_deref())? {
                    return Ok(kind);
                }
            }
            let tables: Vec<Table> = tables.into_iter().map(|(_, table)| table).collect();
            let dynamic = tables.iter().find(|table| columns::is_dynamic(table));
            Err(match (dynamic, tables.first(), refused) {
                (Some(table), ..) => fault(format!(
                    "storage and loss modulus need a column of frequencies; the file has {}",
                    table.listed()
                ))
                .remedy(Remedy::Column(Role::Frequency))
                .whole(Whole::of(table, Kind::Dma, &Columns::default(), false)),
                (None, Some(table), _) if factors::told_by(table) => {
                    fault("the file holds shift factors and no measured curve; it is the shift table of one (--shift-table)")
                }
                (None, _, Some(fault)) => fault,
                (None, table, None) => fault(format!(
                    "the header does not state what was measured: a relaxation test has a modulus over time, a creep test a \
                     compliance over time, a DMA storage and loss modulus over frequency; the file has {}",
                    table.map_or_else(|| "no table".to_owned(), Table::listed)
                ))
                .remedy(Remedy::Kind)
                .whole(table.and_then(|table| Whole::of(table, kind::likely(table), &Columns::default(), true))),
            })
        };
        kind().map_err(|fault| fault.of(path))
    }

    /// From the bytes of a file that is called `path` in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(path: &Path, bytes: &[u8], kind: Kind, columns: &Columns) -> Result<Curves, CurveError> {
        let parse = || -> Result<Curves, CurveError> {
            let sheets = workbook::sheets(bytes, columns.sheet.as_deref())?;
            let held = match sheets.as_slice() {
                [Sheet { name: None, .. }] => HeldShift::default(),
                // The shift may stand on another sheet than the one that is read.
                _ if columns.sheet.is_some() => factors::held(&workbook::sheets(bytes, None)?),
                sheets => factors::held(sheets),
            };
            let (sheet, table, also) = chosen(sheets, kind)?;
            let columns::Read { values, places: used, lines, left_out, mut notes } =
                columns::values(&table, kind.into(), columns)?;
            notes.extend(also);
            let measure = columns::measure(&used, &table)?;
            let is_used = |column: usize| used.iter().any(|place| place.column == column);
            let headers = (1..).zip(&table.headings).filter(|(n, _)| !is_used(*n));
            let unused = headers.map(|(_, heading)| heading.header.clone()).filter(|name| !name.is_empty());
            let unused = unused.collect();
            let (values, lines) = match columns.segment {
                Some(number) => {
                    let (rows, note) = Segments::of(kind, &values).choose(number, kind, &values, &lines)?;
                    notes.push(note);
                    let values = segments::chosen(&values, &rows);
                    (values, rows.iter().map(|row| lines[*row]).collect())
                }
                None => (values, lines),
            };
            let (sweeps, repeated) = sweeps::sweeps(kind, &values, &lines)?;
            notes.extend(repeated);
            Ok(Curves {
                path: path.to_owned(),
                kind,
                measure,
                sweeps,
                left_out,
                sheet,
                unused,
                columns: used,
                held,
                notes,
                digest: crate::digest::md5(bytes),
            })
        };
        parse().map_err(|fault| fault.of(path))
    }

    /// Curves that no file holds; `name` is what messages call them.
    pub fn of(name: &str, kind: Kind, sweeps: Vec<Sweep>) -> Curves {
        Curves { path: PathBuf::from(name), kind, sweeps, ..Curves::default() }
    }

    /// Whether each row was measured at a temperature of its own, during a temperature ramp.
    pub fn is_ramp(&self) -> bool {
        sweeps::is_ramp(self.sweeps.iter().filter_map(|sweep| sweep.temperature))
    }

    /// Whether a DMA was measured over temperature rather than over frequency: each row, or each single point of a frequency, has a
    /// temperature of its own.
    pub fn is_over_temperature(&self) -> bool {
        let single = |sweep: &Sweep| sweep.x.len() == 1 && sweep.temperature.is_some();
        self.kind == Kind::Dma && (self.is_ramp() || self.sweeps.len() > 2 && self.sweeps.iter().all(single))
    }

    /// The lowest and the highest temperature in words: "-20.0 °C to 60.0 °C"; empty where the file holds none.
    pub fn temperatures(&self) -> String {
        let [first, last] = [self.sweeps.first(), self.sweeps.last()];
        let ends = first.and_then(Sweep::celsius).zip(last.and_then(Sweep::celsius));
        ends.map_or(String::new(), |(coldest, warmest)| format!("{coldest} to {warmest}"))
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.sweeps.iter().map(|sweep| sweep.x.len()).sum()
    }
}

fn bytes(path: &Path) -> Result<Vec<u8>, CurveError> {
    crate::resources::bytes(path, MOST_BYTES).map_err(|why| fault(why).of(path))
}

/// The first sheet whose header names a curve of the kind, or the only one with a table; and a note on others like it.
fn chosen(sheets: Vec<Sheet>, kind: Kind) -> Result<(Option<String>, Table, Option<String>), CurveError> {
    let (mut named, mut other, mut refused, mut names) = (Vec::new(), Vec::new(), None, Vec::new());
    for sheet in sheets {
        names.extend(sheet.name.clone());
        match sheet.table {
            Ok(table) if columns::named(&table, kind) => named.push((sheet.name, table)),
            Ok(table) => other.push((sheet.name, table)),
            Err(fault) => refused = Some(fault),
        }
    }
    if !named.is_empty() {
        let more: Vec<String> = named.iter().skip(1).filter_map(|(name, _)| name.clone()).collect();
        let (name, table) = named.swap_remove(0);
        let note = (!more.is_empty()).then(|| {
            let (first, more) = (name.as_deref().unwrap_or_default(), listed(&more));
            format!("sheet \"{first}\" is read, and others like it are not: {more}; sheet = \"...\" (--sheet) says which")
        });
        return Ok((name, table, note));
    }
    match (other.len(), other.pop(), refused) {
        (1, Some((name, table)), _) => Ok((name, table, None)),
        (0, _, Some(refused)) => Err(refused),
        _ => {
            let message = format!("no sheet names the columns of a {} file", kind.name());
            Err(fault(message).remedy(Remedy::Sheet(listed(&names))))
        }
    }
}
