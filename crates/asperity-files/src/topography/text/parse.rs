//! The numbers of a block, in parallel by runs of lines.

use memchr::{memchr, memchr_iter};
use rayon::prelude::*;

use super::dialect::{Dialect, Separator, is_undefined};
use super::{Block, encoding};
use crate::topography::{Problem, Result};

/// The numbers of a block in runs of whole lines.
pub(super) struct Table {
    pub(super) columns: usize,
    runs: Vec<Vec<f64>>,
}

impl Table {
    /// The lines.
    pub(super) fn lines(&self) -> impl Iterator<Item = &[f64]> {
        self.runs.iter().flat_map(|run| run.chunks_exact(self.columns.max(1)))
    }

    /// Number of the lines.
    pub(super) fn len(&self) -> usize {
        self.runs.iter().map(Vec::len).sum::<usize>() / self.columns.max(1)
    }
}

/// Number of values on the lines of a block, from its first lines.
pub(super) fn columns(dialect: Dialect, data: &[u8]) -> usize {
    let mut lines = data.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).filter(|l| !l.is_empty());
    let first = lines.next().unwrap_or_default();
    match dialect.separator {
        Separator::Blank => first.split(u8::is_ascii_whitespace).filter(|t| !t.is_empty()).count(),
        Separator::Byte(byte) => {
            let fields = first.split(|b| *b == byte).count();
            // A separator that ends every line stands after the last value, else before an undefined one.
            let trailing = |line: &[u8]| {
                line.iter()
                    .rev()
                    .take_while(|b| **b == byte || b.is_ascii_whitespace())
                    .filter(|b| **b == byte)
                    .count()
            };
            let ends = lines.take(100).map(trailing).fold(trailing(first), usize::min);
            // Rows of a profile may end in several.
            if fields == ends + 2 { 2 } else { fields - ends.min(1) }
        }
    }
}

/// Parses the block: lines of equally many numbers.
pub(super) fn table(dialect: Dialect, block: &Block) -> Result<Table> {
    let columns = columns(dialect, block.data);
    Ok(Table { columns, runs: parse(dialect, Some(columns), block.data, block.line)? })
}

/// The numbers of lines of any length, separated by blanks, from this line of the file on.
pub(crate) fn numbers(data: &[u8], first_line: usize) -> Result<Vec<f64>> {
    let dialect = Dialect { separator: Separator::Blank, decimal_comma: false };
    Ok(parse(dialect, None, data, first_line)?.concat())
}

fn parse(dialect: Dialect, columns: Option<usize>, data: &[u8], first_line: usize) -> Result<Vec<Vec<f64>>> {
    let runs = runs(data);
    let parsed: Vec<_> = match runs.as_slice() {
        [run] => vec![parse_run(dialect, columns, run)],
        runs => runs.par_iter().map(|run| parse_run(dialect, columns, run)).collect(),
    };
    let lines = |runs: &[&[u8]]| runs.iter().map(|run| memchr_iter(b'\n', run).count()).sum::<usize>();
    let located = parsed
        .into_iter()
        .enumerate()
        .map(|(i, run)| run.map_err(|fault| fault.problem(first_line + lines(&runs[..i]), runs[i])));
    located.collect()
}

/// The block cut at line ends into runs that keep the threads busy.
fn runs(mut data: &[u8]) -> Vec<&[u8]> {
    const LENGTH: usize = 1 << 20;
    let mut runs = Vec::with_capacity(data.len() / LENGTH + 1);
    while data.len() > LENGTH {
        let end = memchr(b'\n', &data[LENGTH..]).map_or(data.len(), |n| LENGTH + n + 1);
        let (run, rest) = data.split_at(end);
        runs.push(run);
        data = rest;
    }
    runs.push(data);
    runs
}

/// What is wrong in a run, at which byte of it.
enum Fault {
    Number { at: usize, length: usize },
    Columns { at: usize, found: usize, columns: usize },
}

impl Fault {
    fn problem(self, first_line: usize, run: &[u8]) -> Problem {
        let line = |at: usize| first_line + memchr_iter(b'\n', &run[..at]).count();
        match self {
            Fault::Number { at, length } => Problem::malformed(
                format!("line {}", line(at)),
                format!("{:?} where a number was expected", encoding::label(&run[at..at + length])),
                "all finite numbers, or marks of undefined points such as nan",
            ),
            Fault::Columns { at, found, columns } => Problem::malformed(
                format!("line {}", line(at)),
                format!("{found} values long"),
                format!("{columns} values long as the lines before it (the file may be truncated)"),
            ),
        }
    }
}

fn parse_run(dialect: Dialect, columns: Option<usize>, run: &[u8]) -> Result<Vec<f64>, Fault> {
    let mut values = Vec::new();
    let mut at = 0;
    while at < run.len() {
        let end = memchr(b'\n', &run[at..]).map_or(run.len(), |n| at + n);
        let before = values.len();
        match dialect.separator {
            Separator::Blank => blank_line(dialect.decimal_comma, run, at, end, &mut values)?,
            Separator::Byte(byte) => {
                delimited_line(byte, dialect.decimal_comma, columns, run, at, end, &mut values)?
            }
        }
        let found = values.len() - before;
        if let Some(columns) = columns
            && found != columns
            && found != 0
        {
            return Err(Fault::Columns { at, found, columns });
        }
        at = end + 1;
    }
    Ok(values)
}

/// A line of numbers that are separated by blanks.
fn blank_line(
    comma: bool,
    run: &[u8],
    mut at: usize,
    end: usize,
    values: &mut Vec<f64>,
) -> Result<(), Fault> {
    loop {
        while at < end && is_blank(run[at]) {
            at += 1;
        }
        if at >= end {
            return Ok(());
        }
        if !comma
            && let Ok((value, length)) = fast_float2::parse_partial::<f64, _>(&run[at..end])
            && value.is_finite()
            && run.get(at + length).is_none_or(|b| is_blank(*b) || *b == b'\n')
        {
            values.push(value);
            at += length;
            continue;
        }
        let length = run[at..end].iter().position(|b| is_blank(*b)).unwrap_or(end - at);
        values.push(token(comma, &run[at..at + length]).ok_or(Fault::Number { at, length })?);
        at += length;
    }
}

/// A line of numbers that are separated by a comma or semicolon.
fn delimited_line(
    separator: u8,
    comma: bool,
    columns: Option<usize>,
    run: &[u8],
    start: usize,
    end: usize,
    values: &mut Vec<f64>,
) -> Result<(), Fault> {
    if run[start..end].trim_ascii().is_empty() {
        return Ok(());
    }
    let mut at = start;
    let mut found = 0;
    loop {
        let stop = memchr(separator, &run[at..end]).map_or(end, |n| at + n);
        let field = run[at..stop].trim_ascii();
        // Separators at the end of the line end the last value.
        if columns == Some(found) && run[at..end].iter().all(|b| *b == separator || is_blank(*b)) {
            return Ok(());
        }
        values.push(token(comma, field).ok_or(Fault::Number { at, length: stop - at })?);
        found += 1;
        if stop == end {
            return Ok(());
        }
        at = stop + 1;
    }
}

fn is_blank(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x1a
}

/// One number, NaN for a mark of an undefined point, `None` for anything else.
fn token(comma: bool, token: &[u8]) -> Option<f64> {
    const LONGEST: usize = 64;
    if !comma
        && let Ok(value) = fast_float2::parse::<f64, _>(token)
        && value.is_finite()
    {
        return Some(value);
    }
    if is_undefined(token) {
        return Some(f64::NAN);
    }
    // Decimal commas, and the exponents of Fortran (1.5D-3).
    let mut plain = [0; LONGEST];
    let plain = plain.get_mut(..token.len())?;
    for (to, from) in plain.iter_mut().zip(token) {
        *to = match from {
            b',' if comma => b'.',
            b'd' | b'D' => b'e',
            other => *other,
        };
    }
    fast_float2::parse::<f64, _>(&*plain).ok().filter(|v| v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::text::header::Header;

    fn parse(text: &str) -> Result<Table, Problem> {
        let block = Block { header: Header::default(), data: text.as_bytes(), line: 5, metadata: 0 };
        table(Dialect::of([block.data].into_iter())?, &block)
    }

    #[test]
    fn numbers_of_every_spelling_are_read() {
        let table = parse("1 -2.5e-003\t+.5\r\n\n 1.5D2  nan 3.\n").unwrap();
        let values = table.runs.concat();
        assert_eq!((table.columns, table.len()), (3, 2));
        assert_eq!(values[..4], [1.0, -2.5e-3, 0.5, 150.0]);
        assert!(values[4].is_nan() && values[5] == 3.0);
        let table = parse("1,5;;-,25;\n2;3;4;\n").unwrap();
        let values = table.runs.concat();
        assert_eq!((table.columns, table.len()), (3, 2));
        assert_eq!((values[0], values[2]), (1.5, -0.25));
        assert!(values[1].is_nan());
    }

    #[test]
    fn a_fault_is_named_with_its_line() {
        for (text, line) in [("1 2\n3 4x\n", "line 6"), ("1 2\n\n3\n", "line 7"), ("1 1e999\n", "line 5")] {
            let message = parse(text).err().unwrap().to_string();
            assert!(message.contains(line), "{message}");
        }
    }

    #[test]
    fn runs_of_lines_join_without_loss() {
        // More than two runs of 1 MiB; integers are exact.
        let (nx, ny) = (300, 2000);
        let text: String = (0..ny)
            .map(|y| (0..nx).map(|x| format!("{}", y * nx + x)).collect::<Vec<_>>().join(" ") + "\n")
            .collect();
        assert!(text.len() > 3 << 20);
        let table = parse(&text).unwrap();
        assert!(table.runs.len() > 2);
        assert!(table.lines().flatten().enumerate().all(|(k, v)| *v == k as f64));
        assert_eq!((table.columns, table.len()), (nx, ny));
    }
}
