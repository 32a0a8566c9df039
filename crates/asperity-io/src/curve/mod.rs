//! Measured curves of materials: relaxation tests, creep tests and DMA sweeps from text tables.
//!
//! ```text
//! file --Table--> names, units, cells --Columns--> quantities in SI --Curves--> sweeps, one per temperature
//!      --Request::fit--> master curve --> Prony series with its misfit
//! ```
//!
//! Separator and decimal mark are found from the file; which column is what, from its header or as told; a unit
//! stands in the header or is told. What does not fit is refused with the line.
//!
//! ```
//! use asperity_io::curve::{Columns, Curves, Kind, Request};
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

mod block;
mod columns;
mod error;
mod fit;
mod indentation;
mod table;

use std::io::Read;
use std::path::{Path, PathBuf};

pub use columns::{Column, Columns, Role, angular_frequency};
pub use error::CurveError;
pub use fit::{Fitted, Request, Series, ShiftRequest};
pub use indentation::{Indentation, MaterialOf, indentation_block};

use asperity::material::Modulus;
use serde::Deserialize;

use crate::choice;
use columns::Values;
use error::{Fault, fault};
use table::Table;

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

    /// The quantities that a file has or may have, in the order of its columns.
    fn roles(self) -> &'static [Role] {
        match self {
            Kind::Relaxation => &[Role::Time, Role::Modulus, Role::Temperature],
            Kind::Creep => &[Role::Time, Role::Compliance, Role::Temperature],
            Kind::Dma => &[Role::Frequency, Role::Storage, Role::Loss, Role::TanDelta, Role::Temperature],
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

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// The file.
    pub path: PathBuf,
    /// What was measured.
    pub kind: Kind,
    /// Whether its header names Young's moduli (E, D) or shear moduli (G, J).
    pub measure: Option<Modulus>,
    /// One sweep per temperature, the coldest first.
    pub sweeps: Vec<Sweep>,
    /// What was assumed about the file.
    pub notes: Vec<String>,
    /// MD5 of its bytes: another file has another one.
    pub digest: String,
}

/// A larger file is no curve.
const MOST_BYTES: u64 = 64 << 20;
/// Temperatures closer than this belong to one sweep \[K\]: chambers hold no better.
const SAME_TEMPERATURE: f64 = 1.0;
/// Temperatures of one sweep spread by no more \[K\].
const SPREAD: f64 = 3.0;
/// More sweeps than anybody measures.
const MOST_SWEEPS: usize = 1000;

impl Curves {
    /// Reads a text table.
    ///
    /// # Errors
    /// [`CurveError`] with the line: no table, a column that is not there, a cell that is no number, a unit of
    /// another quantity, temperatures that form no sweeps.
    pub fn read(path: &Path, kind: Kind, columns: &Columns) -> Result<Curves, CurveError> {
        Curves::parse(path, &bytes(path)?, kind, columns)
    }

    /// What a file holds, where its header tells it.
    ///
    /// # Errors
    /// [`CurveError`] where the file cannot be read or holds no table.
    pub fn kind_of(path: &Path) -> Result<Option<Kind>, CurveError> {
        let table = Table::parse(&bytes(path)?).map_err(|fault| fault.of(path))?;
        Ok([Kind::Dma, Kind::Relaxation, Kind::Creep].into_iter().find(|kind| columns::named(&table, *kind)))
    }

    /// From the bytes of a text table that is called `path` in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(path: &Path, bytes: &[u8], kind: Kind, columns: &Columns) -> Result<Curves, CurveError> {
        let digest = crate::digest::md5(bytes);
        let parsed = Table::parse(bytes).and_then(|table| {
            let (values, notes) = columns::values(&table, kind.into(), columns)?;
            let lines: Vec<usize> = table.rows.iter().map(|row| row.line).collect();
            let measure = columns::measure(&table, kind.into(), columns);
            Ok((sweeps(kind, &values, &lines)?, measure, notes))
        });
        let (sweeps, measure, notes) = parsed.map_err(|fault| fault.of(path))?;
        Ok(Curves { path: path.to_owned(), kind, measure, sweeps, notes, digest })
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.sweeps.iter().map(|sweep| sweep.x.len()).sum()
    }
}

fn bytes(path: &Path) -> Result<Vec<u8>, CurveError> {
    let mut bytes = Vec::new();
    crate::resources::open(path)
        .and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| fault(format!("cannot be read: {error}")).of(path))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(fault(format!("the file is larger than {} MB", MOST_BYTES >> 20)).of(path));
    }
    Ok(bytes)
}

/// The rows by temperature; each sweep in the order of the file, or the reverse where that goes down.
fn sweeps(kind: Kind, values: &Values, lines: &[usize]) -> Result<Vec<Sweep>, Fault> {
    let of = |role: Role| values.get(&role).cloned().unwrap_or_default();
    let (x, curves) = match kind {
        Kind::Relaxation => (of(Role::Time), vec![of(Role::Modulus)]),
        Kind::Creep => (of(Role::Time), vec![of(Role::Compliance)]),
        Kind::Dma => {
            let (storage, tan_delta) = (of(Role::Storage), of(Role::TanDelta));
            let loss = match values.get(&Role::Loss) {
                Some(loss) => loss.clone(),
                None => storage.iter().zip(&tan_delta).map(|(storage, tan)| storage * tan).collect(),
            };
            (of(Role::Frequency), vec![storage, loss])
        }
    };
    let sweep = |temperature: Option<f64>, rows: &[usize]| {
        let mut rows = rows.to_vec();
        let falls = rows.len() > 1 && rows.windows(2).all(|pair| x[pair[1]] < x[pair[0]]);
        if falls {
            rows.reverse();
        }
        let pick = |column: &Vec<f64>| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        Sweep {
            temperature,
            x: pick(&x),
            curves: curves.iter().map(pick).collect(),
            lines: rows.iter().map(|row| lines[*row]).collect(),
        }
    };
    let Some(temperatures) = values.get(&Role::Temperature) else {
        let rows: Vec<usize> = (0..x.len()).collect();
        return Ok(vec![sweep(None, &rows)]);
    };
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|a, b| temperatures[*a].total_cmp(&temperatures[*b]));
    let same = |a: &usize, b: &usize| temperatures[*b] - temperatures[*a] <= SAME_TEMPERATURE;
    let mut found = Vec::new();
    for group in order.chunk_by(same) {
        let (coldest, warmest) = (temperatures[group[0]], temperatures[group[group.len() - 1]]);
        if warmest - coldest > SPREAD {
            return Err(fault(format!(
                "the temperatures from {coldest} K to {warmest} K follow each other within {SAME_TEMPERATURE} K; \
                 sweeps at held temperatures are needed"
            )));
        }
        if found.len() == MOST_SWEEPS {
            return Err(fault(format!("there are more than {MOST_SWEEPS} temperatures")));
        }
        let mean =
            coldest + group.iter().map(|row| temperatures[*row] - coldest).sum::<f64>() / group.len() as f64;
        let mut rows = group.to_vec();
        rows.sort_unstable();
        found.push(sweep(Some(mean), &rows));
    }
    Ok(found)
}
