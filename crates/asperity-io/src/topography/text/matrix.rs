//! Text matrices: a line of the file is one y, the values on it run along x.

use super::parse::table;
use super::{Block, Text, decode};
use crate::topography::finish::{Measured, Unit, choose};
use crate::topography::{Format, Problem, grid};

/// Reads the channel asked for; each block of numbers is one, those of no length are left out where others are.
pub(crate) fn read_matrix(bytes: &[u8], channel: Option<&str>) -> Result<Measured, Problem> {
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
    let (nx, ny) = (table.columns, table.lines);
    if nx < 2 || ny < 2 {
        let detail = format!("{ny} lines of {nx} values, a profile and not an area");
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
    let mut heights = grid::from_lines(nx, ny, &table.values);
    let (channel, lateral, unit, scale) = block.header.scales([nx, ny]);
    if scale != 1.0 {
        heights.par_mapv_inplace(|h| h * scale);
    }
    let channels = if channel.is_some() || names.len() > 1 { names } else { Vec::new() };
    Ok(Measured { heights, unit, lateral, channel, channels, metadata: block.header.metadata.clone() })
}
