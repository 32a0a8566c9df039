//! One or two columns of text: heights along a line, with their positions or without.

use super::parse::{columns, table};
use super::plain::plain;
use super::{Block, Text, decode};
use crate::topography::finish::Unit;
use crate::topography::unit::{LoneA, metres};
use crate::topography::{Format, Problem, Result};

/// What the columns hold.
pub(crate) struct Columns {
    /// Positions, in the file's unit; `None` where there is only a column of heights.
    pub positions: Option<Vec<f64>>,
    /// Heights, in the file's unit; NaN where undefined.
    pub heights: Vec<f64>,
    /// Metres per unit of the positions, where the file states it.
    pub lateral: Option<f64>,
    /// Unit of the heights.
    pub unit: Unit,
    /// What else the file says.
    pub metadata: Vec<(String, String)>,
}

/// Whether the bytes are text whose longest block of numbers has one or two columns, and no header of a matrix.
pub(crate) fn is_profile(bytes: &[u8]) -> bool {
    let Some(text) = plain(bytes) else { return false };
    let Ok(text) = Text::split(&text) else { return false };
    let longest = longest(&text);
    longest.is_some_and(|block| columns(text.dialect, block.data) <= 2 && !block.header.says_matrix())
}

/// Reads the column or the two columns.
pub(crate) fn read_columns(bytes: &[u8]) -> Result<Columns> {
    let bytes = decode(bytes)?;
    let text = Text::split(&bytes)?;
    let Some(block) = longest(&text) else {
        return Err(Problem::NoHeights { format: Format::Text, detail: "no line of numbers".into() });
    };
    let table = table(text.dialect, block)?;
    if table.columns > 2 {
        let detail = format!(
            "its lines have {} numbers; a profile has one column of heights or two columns, position and height",
            table.columns
        );
        return Err(Problem::NoHeights { format: Format::Text, detail });
    }
    // The column of the heights; that of the positions is the one before it.
    let of_heights = table.columns - 1;
    let heights = table.lines().map(|line| line[of_heights]).collect();
    let positions = (of_heights > 0).then(|| table.lines().map(|line| line[0]).collect());
    let (lateral, mut unit) = block.header.point_units([0, 0, of_heights]);
    let named = block.header.columns();
    // "Lateral um": the unit as the last word of the name.
    let of_name = |column: usize| {
        let name = named.get(column).filter(|_| named.len() == table.columns)?;
        metres(name.name.split_whitespace().next_back()?, LoneA::Angstrom)
    };
    match &unit {
        Unit::Unstated => unit = of_name(of_heights).map_or(Unit::Unstated, Unit::Metres),
        // Heights in "A" are angstroms.
        Unit::Other(label) => {
            if let Some(angstrom) = metres(label, LoneA::Angstrom) {
                unit = Unit::Metres(angstrom);
            }
        }
        Unit::Metres(_) => {}
    }
    let lateral =
        lateral[0].as_deref().and_then(|label| metres(label, LoneA::Angstrom)).or_else(|| of_name(0));
    Ok(Columns { positions, heights, lateral, unit, metadata: text.metadata(block) })
}

/// The block with the most numbers: settings of the instrument may be numbers too.
fn longest<'t, 'a>(text: &'t Text<'a>) -> Option<&'t Block<'a>> {
    text.blocks.iter().max_by_key(|block| block.data.len())
}
