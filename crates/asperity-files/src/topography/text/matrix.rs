//! Text matrices: each line of the file is one y; the values on it run along x.

use super::parse::table;
use super::{Block, Text, decode};
use crate::topography::finish::{Measured, Unit};
use crate::topography::{Problem, Request, Result, grid};

/// Reads the channel asked for. Each block of numbers is a channel; blocks that are not lengths are left out if there are others.
///
/// Two columns are a profile (position, height) rather than an area, unless the header or the caller says that they
/// are a matrix.
pub(super) fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
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
        return Err(request.no_heights("no line of numbers"));
    }
    let index = request.choose(&names)?;
    let block = blocks[index];

    let table = table(text.dialect, block)?;
    let (nx, ny) = (table.columns, table.len());
    if nx < 2 || ny < 2 || (nx == 2 && !request.insists && !block.header.says_matrix()) {
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
        return Err(request.no_heights(detail));
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
    let metadata = text.metadata(block);
    Ok(Measured { channel, channels, metadata, ..Measured::new(heights, unit, lateral) })
}
