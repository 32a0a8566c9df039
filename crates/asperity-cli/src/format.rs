//! Numbers as a person reads them.

use asperity::step::Row;
pub use asperity_io::readable::{bytes, coordinate, counted, duration, quantity};

/// The mean pressure over the contact [Pa]; 0 where nothing touches.
pub fn in_contact(row: &Row) -> f64 {
    if row.contact_fraction > 0.0 { row.mean_pressure / row.contact_fraction } else { 0.0 }
}

/// The mean gap \[m\] of a row, 0 where it is the rounding error of a full contact.
pub fn mean_gap(row: &Row) -> f64 {
    const ROUNDING: f64 = 1e-12;
    if row.mean_gap.abs() < ROUNDING * row.approach.abs() { 0.0 } else { row.mean_gap }
}
