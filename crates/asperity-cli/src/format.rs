//! Numbers as a person reads them.

use asperity::step::Row;
pub use asperity_io::readable::{bytes, coordinate, counted, duration, quantity};
pub use asperity_report::figure::extent;

/// Rows of cells, the first one the head, in columns that are as wide as their cells. A row that ends early may end in a longer text.
pub fn columns(rows: &[Vec<String>], indent: &str) -> String {
    let count = rows.first().map_or(0, Vec::len);
    let cells = |n: usize| rows.iter().filter(move |row| n + 1 < row.len() || row.len() == count);
    let width = |n: usize| cells(n).map(|row| row[n].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..count).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("{indent}{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

/// The pressures of a row: nominal mean, mean in the contact, 0 if nothing touches, and largest.
pub fn pressures(row: &Row, in_contact: f64) -> String {
    let touching = if in_contact.is_nan() { 0.0 } else { in_contact };
    let [nominal, touching, largest] =
        [row.mean_pressure, touching, row.max_pressure].map(|pressure| quantity(pressure, "Pa"));
    format!("nominal mean {nominal}, in the contact {touching}, largest {largest}")
}

/// The mean gap \[m\] of a row, 0 where it is the rounding error of a full contact.
pub fn mean_gap(row: &Row) -> f64 {
    const ROUNDING: f64 = 1e-12;
    if row.mean_gap.abs() < ROUNDING * row.approach.abs() { 0.0 } else { row.mean_gap }
}
