//! The cells of a sheet. A file of a few bytes may claim any number of them at any place, so their number is bounded.

use super::Rows;
use crate::curve::error::{Result, fault};

/// Most cells of all sheets, empty ones between others included.
pub(super) const MOST_CELLS: usize = 4_000_000;
/// Most bytes of text of a sheet.
const MOST_TEXT: usize = 64 << 20;

/// The cells of a sheet that are not empty, in any order.
#[derive(Default)]
pub(super) struct Cells {
    found: Vec<(u32, u32, String)>,
    bytes: usize,
}

impl Cells {
    /// Adds the cell of a row and a column, from 0; those without text are left out.
    pub(super) fn push(&mut self, row: u32, column: u32, text: &str) -> Result<()> {
        let text = text.trim();
        if text.is_empty() {
            return Ok(());
        }
        self.bytes += text.len();
        if self.found.len() == MOST_CELLS || self.bytes > MOST_TEXT {
            return Err(fault(format!(
                "a sheet holds more than {MOST_CELLS} cells or {} MB of text; save its columns of measured numbers as text \
                 (csv)",
                MOST_TEXT >> 20
            )));
        }
        // The separators of the table that the rows become.
        self.found.push((row, column, text.replace([';', '\n', '\r'], " ")));
        Ok(())
    }

    /// The rows from the first of the sheet, with the columns from the first that holds anything; of the number of cells
    /// that is left for all sheets.
    pub(super) fn rows(self, left: &mut usize) -> Result<Rows> {
        let Some(first) = self.found.iter().map(|(_, column, _)| *column).min() else {
            return Ok(Rows::new());
        };
        let last = self.found.iter().map(|(_, column, _)| *column).max().unwrap_or(first);
        let bottom = self.found.iter().map(|(row, ..)| *row).max().unwrap_or(0);
        let (height, width) = (bottom as usize + 1, (last - first) as usize + 1);
        let Some(after) = height.checked_mul(width).and_then(|cells| left.checked_sub(cells)) else {
            return Err(fault(format!(
                "a sheet spans {height} rows and {width} columns, and all sheets together more than {MOST_CELLS} cells; clear \
                 what stands far from the table, or save the table as text (csv)"
            )));
        };
        *left = after;
        let mut rows = vec![vec![String::new(); width]; height];
        for (row, column, text) in self.found {
            rows[row as usize][(column - first) as usize] = text;
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_far_away_are_refused_before_the_memory_of_all_between_is_taken() {
        let mut cells = Cells::default();
        cells.push(0, 0, "f").unwrap();
        cells.push(1_048_575, 16_383, "1").unwrap();
        assert!(
            cells.rows(&mut { MOST_CELLS }).unwrap_err().message.contains("1048576 rows and 16384 columns")
        );
    }

    #[test]
    fn rows_begin_with_the_first_and_columns_with_the_first_used() {
        let mut cells = Cells::default();
        for (row, column, text) in [(2, 4, "b;c"), (1, 3, " a "), (9, 9, " ")] {
            cells.push(row, column, text).unwrap();
        }
        let empty = || vec![String::new(); 2];
        assert_eq!(
            cells.rows(&mut { MOST_CELLS }).unwrap(),
            [empty(), vec!["a".into(), String::new()], vec![String::new(), "b c".into()]]
        );
    }
}
