//! Text matrices: each line of the file is one y; the values on it run along x.

use super::parse::{Table, table};
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
    refuse_counters(&table, block.line)?;
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

/// # Errors
/// Where the first line, or the first number of every line, counts the others or holds their coordinates, as spreadsheets and scripts write
/// them: its numbers are evenly spaced, and those of no other line (column) are.
fn refuse_counters(table: &Table, line: usize) -> Result<()> {
    /// Fewer heights may be evenly spaced by chance.
    const LEAST: usize = 6;
    let lines: Vec<&[f64]> = table.lines().collect();
    let columns = table.columns;
    let found = |what: String, numbers: &[f64]| {
        let shown: Vec<String> = numbers.iter().take(4).map(f64::to_string).collect();
        Problem::malformed(
            what,
            format!("evenly spaced ({}, ...), as no other is", shown.join(", ")),
            "heights: a counter or coordinates would become a part of the surface; take it out, or save the heights as NPY",
        )
    };
    // A corner may belong to neither.
    let (first, rest) = (&lines[0][1..], lines.get(1..).unwrap_or_default());
    if first.len() >= LEAST && is_even(first.iter()) && !rest.iter().any(|line| is_even(line[1..].iter())) {
        return Err(found(format!("the first line of numbers (line {line})"), lines[0]));
    }
    let column = |n: usize| rest.iter().map(move |line| &line[n]);
    // The first line of numbers may hold coordinates too.
    let whole = |n: usize| lines.iter().map(move |line| &line[n]);
    let is_counter = |is_even: &dyn Fn(usize) -> bool| is_even(0) && !(1..columns).any(is_even);
    let counts = rest.len() >= LEAST && is_counter(&|n| is_even(column(n)));
    if counts || (lines.len() >= LEAST && is_counter(&|n| is_even(whole(n)))) {
        return Err(found("the first column".to_owned(), &whole(0).copied().collect::<Vec<f64>>()));
    }
    Ok(())
}

/// Whether numbers rise or fall in equal steps, but for rounding.
fn is_even<'n>(numbers: impl Iterator<Item = &'n f64> + Clone) -> bool {
    let mut steps = numbers.clone().zip(numbers.skip(1)).map(|(a, b)| b - a);
    let Some(first) = steps.next().filter(|step| *step != 0.0 && step.is_finite()) else { return false };
    steps.all(|step| (step - first).abs() <= 1e-3 * first.abs())
}
