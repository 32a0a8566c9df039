//! The result: one Zarr v3 group, a directory that xarray opens with `open_zarr`.
//!
//! | array | dimensions | |
//! |---|---|---|
//! | the [`SCALARS`], with the coordinate `time` | `time` | one number per step |
//! | the quantities asked for | `time`, of histograms also `spot_bin`, `pressure_bin` or `gap_bin` | |
//! | `spot_edge`, `pressure_edge`, `gap_edge` | | ends of the bins |
//! | `pressure`, `gap`, `displacement`, `contact`, `flattening` | `field_time`, `x`, `y` | fields of the chosen steps |
//! | `field_time`, `field_step` | `field_time` | time and row of each stored field; of a field between two rows the later |
//! | `initial_gap` | `x`, `y` | undeformed gap |
//! | `leak_rate`, `hydraulic_gap`, ... | `leak_time` | leakage, where it was asked for |
//! | `x`, `y` | | centres of the cells |
//! | `max_mises`, `max_mises_depth`, ... | `field_time` | the stress below the surface, where it was computed ([`StressSet`]) |
//! | `mises_by_depth`, ... | `field_time`, `depth` | its largest values at each depth |
//! | `stress_mises`, ... | `field_time`, `depth`, `x`, `y` | stress fields that were asked for |
//!
//! A line contact has no dimension `y`: its fields are over (`field_time`, `x`) and `initial_gap` over `x`, forces and areas are
//! per length along y, and the attributes `cells` and `size` hold one number each.
//!
//! Numbers keep their bits. Each array has `units` and `long_name`; the attributes of the group hold
//! the case file as text (`case`), its numbers as JSON text (`setup`), the `version`, the `status` and the
//! work done. `checkpoint` holds the state from which a stopped run goes on.
//!
//! A step is visible once it is whole: rows and fields are written first, then the group's document,
//! which counts them, is replaced as a whole. What a killed process leaves is the result up
//! to the last step appended.
//!
//! ```
//! use asperity::{Coordinate, Grid};
//! use asperity_io::store::{At, Field, FieldKind, Header, Outcome, Reader, Row, Status, Writer};
//! use ndarray::Array2;
//!
//! # let directory = tempfile::tempdir()?;
//! # let path = directory.path().join("result.zarr");
//! let header = Header {
//!     title: "a punch".into(),
//!     case_text: String::new(),
//!     version: "0.1.0".into(),
//!     grid: Grid::new([4, 3], [4e-3, 3e-3])?,
//!     fields: vec![FieldKind::Pressure],
//!     quantities: vec![],
//!     rows_expected: Some(1),
//!     setup: Default::default(),
//! };
//! let mut writer = Writer::create(&path, &header, Array2::zeros((4, 3)).view(), false)?;
//! let row = Row { coordinate: Coordinate::Time(0.0), load: 12.0, ..Row::default() };
//! writer.append(&row, &[Field::Real(FieldKind::Pressure, Array2::from_elem((4, 3), 1e6).view())])?;
//! writer.finish(&Outcome::new(Status::Complete))?;
//!
//! let reader = Reader::open(&path)?;
//! assert_eq!(reader.series("load")?, [12.0]);
//! assert_eq!(reader.field(FieldKind::Pressure, At::Last)?[[3, 2]], 1e6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod checkpoint;
mod checksum;
mod chunks;
mod codec;
mod column;
mod create;
mod document;
mod error;
mod field_kind;
mod header;
mod layout;
mod leak;
mod leftovers;
mod reader;
mod replace;
mod resume;
mod stress;
mod sync;
mod verify;
mod writer;

pub use asperity::step::{Checkpoint, Row};
pub use document::store_error_bars;
pub use error::{Result, StoreError};
pub use field_kind::{FieldKind, Look};
pub use header::{Header, Status, Work};
pub(crate) use layout::{ArraySpec, DataType, Storage, array_document};
pub use layout::{SCALARS, Scalar, Series, coordinates};
pub use leak::{LeakTable, LeakWriter, Leaks, leak_series};
pub use reader::{At, Reader};
pub use stress::{StressSet, StressWriter};
pub use verify::{Damage, Verification, verify};
pub use writer::{Field, Outcome, Writer};
