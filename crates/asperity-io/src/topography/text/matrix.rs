//! Text matrices: a line of the file is one y, the values on it run along x.

use super::parse::table;
use super::{Block, Text, decode};
use crate::topography::finish::{Measured, Unit, choose};
use crate::topography::{Format, Problem, grid};

/// Reads the channel asked for; each block of numbers is one, those of no length are left out where others are.
///
/// Two columns are a profile (position, height) rather than an area, unless the header or the caller (`insists`)
/// says that they are a matrix.
pub(crate) fn read_matrix(bytes: &[u8], channel: Option<&str>, insists: bool) -> Result<Measured, Problem> {
    let bytes = decode(bytes)?;
    let text = Text::split(&bytes)?;
    let unit = |block: &&Block| block.header.scales([1, 1]).2;
    let mut blocks: Vec<&Block> = text.blocks.iter().filter(|b| !matches!(unit(b), Unit::Other(_))).collect();
    if blocks.is_empty() {
        blocks = text.blocks.iter().collect();
    }
    let name = |block: &Block| block.header.scales([1, 1]).0;
    let names: Vec<String> =
        blocks.iter().enumerate().map(|(i, b)| name(b).unwrap_or(format!("{i}"))).collect();
    if names.is_empty() {
        return Err(Problem::NoHeights { format: Format::Text, detail: "no line of numbers".into() });
    }
    let index = choose(Format::Text, &names, channel)?;
    let block = blocks[index];

    let table = table(text.dialect, block)?;
    let (nx, ny) = (table.columns, table.len());
    if nx < 2 || ny < 2 || (nx == 2 && !insists && !block.header.says_matrix()) {
        let detail = match (nx, ny) {
            (2, 2..) => format!(
                "{ny} lines of 2 values are taken for a profile (position and height), not an area; if they are a matrix, \
                 say so in its first line (\"# Width: 2 um\"), or save it as NPY"
            ),
            _ => format!(
                "{ny} x {nx} values (lines x columns) are a profile, and not an area; a surface needs 2 lines and 2 \
                 columns or more"
            ),
        };
        return Err(Problem::NoHeights { format: Format::Text, detail });
    }
    grid::points(nx as u64, ny as u64)?;
    for (axis, found, stated) in [("x", nx, block.header.points[0]), ("y", ny, block.header.points[1])] {
        if let Some(stated) = stated
            && stated != found as u64
        {
            let expected = format!("{stated} as its header says (the file may be truncated)");
            return Err(Problem::malformed(format!("the number of points along {axis}"), found, expected));
        }
    }
    let (channel, lateral, unit, scale) = block.header.scales([nx, ny]);
    let heights = grid::from_lines(nx, &table.lines().collect::<Vec<_>>(), |number| number * scale);
    let channels = if channel.is_some() || names.len() > 1 { names } else { Vec::new() };
    Ok(Measured { heights, unit, lateral, channel, channels, metadata: text.metadata(block) })
}
