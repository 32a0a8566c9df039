//! Sweeps beside each other, put one below the other.
//!
//! ```text
//! 20 °C;     ;      ;30 °C;    ;             columns that are repeated, with a temperature above each block
//! f;    E';  E'';   f;    E';  E''
//!
//! f;  E' 20°C [MPa];  E'' 20°C [MPa];  E' 30°C [MPa]; ...         temperatures in the names of the columns
//! T;  E'(1.000 Hz)/MPa;  E'(10.000 Hz)/MPa; ...                   or frequencies
//! ```
//!
//! Either becomes a table with one point per line, and a column of its temperature or frequency.

use std::ops::Range;

use super::error::{Result, fault};
use super::names::split_unit;
use super::role::{Role, unnumbered};
use super::table::{Heading, MOST_ROWS, Row, Table, cells, is_missing, parse_number};
use super::units::tidy;

/// The columns that belong together, and the value that they were measured at.
struct Block {
    columns: Vec<usize>,
    value: Option<Value>,
}

/// A temperature or a frequency in a text.
#[derive(Clone, PartialEq)]
struct Value {
    number: f64,
    unit: &'static str,
    /// Bytes of the text.
    span: Range<usize>,
}

impl Value {
    /// What it is a value of.
    fn name(&self) -> &'static str {
        if matches!(self.unit, "Hz" | "rad/s") { "f" } else { "Temperature" }
    }
}

/// The table with its sweeps below each other; as it is where they are already.
///
/// # Errors
/// If columns are repeated and no temperatures are given for them.
pub(super) fn long(table: Table) -> Result<Table> {
    if let Some(blocks) = repeated(&table)? {
        let headers = blocks[0].columns.iter().map(|column| header(&table, *column, None)).collect();
        return stacked(&table, headers, &blocks);
    }
    match by_name(&table) {
        Some((headers, blocks)) => stacked(&table, headers, &blocks),
        None => Ok(table),
    }
}

/// The blocks of a table whose columns are repeated, with the temperature above each.
fn repeated(table: &Table) -> Result<Option<Vec<Block>>> {
    let columns = table.headings.len();
    let plain: Vec<String> = table.headings.iter().map(|heading| unnumbered(&heading.header)).collect();
    let name = |column: usize| plain.get(column).map_or("", String::as_str);
    let repeats = |period: usize| {
        // The last block may lack the empty column that separates the blocks.
        let whole = columns.is_multiple_of(period)
            || (columns + 1).is_multiple_of(period) && name(period - 1).is_empty();
        let named = (0..period).filter(|column| !name(*column).is_empty()).count() >= 2;
        whole && named && (period..columns).all(|column| name(column) == name(column - period))
    };
    let Some(period) = (2..=columns.div_ceil(2)).find(|period| repeats(*period)) else { return Ok(None) };
    let count = columns.div_ceil(period);
    let own: Vec<usize> = (0..period).filter(|column| !name(*column).is_empty()).collect();
    let of = |block: usize| own.iter().map(|column| block * period + column).collect();
    let is_temperature = |name: &str| name == "T" || Role::Temperature.is_called(name);
    if own.iter().any(|column| is_temperature(&table.headings[*column].name)) {
        return Ok(Some((0..count).map(|block| Block { columns: of(block), value: None }).collect()));
    }
    let temperatures = |line: &str| -> Option<Vec<Block>> {
        let cells = cells(line, table.separator);
        let block = |block: usize| {
            let own = cells.get(block * period..)?.iter().take(period);
            let value = own.filter_map(|cell| value_in(cell)).find(|value| value.name() != "f")?;
            Some(Block { columns: of(block), value: Some(value) })
        };
        // "20,,25,,": one number above each block, in the unit of a label if there is one.
        let unit = cells.iter().find_map(|cell| {
            let (name, unit) = split_unit(cell);
            is_temperature(name).then(|| tidy(Role::Temperature, "", unit))
        });
        let unit = ["°C", "K", "°F"].into_iter().find(|known| unit.as_deref() == Some(*known)).unwrap_or("");
        let bare = |block: usize| {
            let own = cells.get(block * period..)?.iter().take(period);
            let mut numbers = own.filter_map(|cell| parse_number(cell, table.decimal_comma));
            let number = numbers.next().filter(|_| numbers.next().is_none())?;
            Some(Block { columns: of(block), value: Some(Value { number, unit, span: 0..0 }) })
        };
        let blocks = |of: &dyn Fn(usize) -> Option<Block>| (0..count).map(of).collect::<Option<Vec<Block>>>();
        blocks(&block).or_else(|| blocks(&bare))
    };
    let found = table.above().rev().find_map(temperatures);
    found.map(Some).ok_or_else(|| {
        fault(format!(
            "columns 1 to {period} are repeated {count} times, and no line above names their temperatures; write one above each block, as \
             in \"20 °C\", or put the sweeps below each other with a column of temperatures"
        ))
    })
}

/// The headers and blocks of a table whose columns are named with the value that they were measured at.
fn by_name(table: &Table) -> Option<(Vec<String>, Vec<Block>)> {
    let values: Vec<Option<Value>> = table.headings.iter().map(|heading| value_in(&heading.header)).collect();
    let shared: Vec<usize> = (0..values.len()).filter(|column| values[*column].is_none()).collect();
    let (mut blocks, mut names): (Vec<Block>, Vec<Vec<String>>) = (Vec::new(), Vec::new());
    for (column, value) in values.iter().enumerate() {
        let Some(value) = value else { continue };
        let same = |block: &Block| {
            block.value.as_ref().is_some_and(|own| (own.number, own.unit) == (value.number, value.unit))
        };
        let place = blocks.iter().position(same).unwrap_or_else(|| {
            blocks.push(Block { columns: shared.clone(), value: Some(value.clone()) });
            names.push(Vec::new());
            blocks.len() - 1
        });
        blocks[place].columns.push(column);
        names[place].push(header(table, column, Some(value)));
    }
    let units_agree = |pair: &[Block]| {
        let unit = |block: &Block| block.value.as_ref().map(|value| value.unit);
        unit(&pair[0]) == unit(&pair[1])
    };
    let alike = blocks.len() >= 2
        && !shared.is_empty()
        && names.windows(2).all(|pair| pair[0] == pair[1])
        && blocks.windows(2).all(units_agree);
    if !alike {
        return None;
    }
    let headers = shared.iter().map(|column| header(table, *column, None)).chain(names.swap_remove(0));
    Some((headers.collect(), blocks))
}

/// The header of a column with its unit, without the value in it.
fn header(table: &Table, column: usize, value: Option<&Value>) -> String {
    let Heading { header: whole, unit, .. } = &table.headings[column];
    let text = match value {
        None => whole.to_owned(),
        Some(value) => {
            let (before, after) = (&whole[..value.span.start], &whole[value.span.end..]);
            let (before, after) = (before.trim_end(), after.trim_start());
            let pairs = [('(', ')'), ('[', ']')];
            let inner = pairs
                .iter()
                .find_map(|(open, close)| Some((before.strip_suffix(*open)?, after.strip_prefix(*close)?)));
            let (before, after) = inner.unwrap_or((before, after));
            format!("{}{after}", before.trim_end_matches([' ', '@', ',', '_', '=']))
        }
    };
    // The unit of a line of its own.
    match !unit.is_empty() && split_unit(whole).1.is_empty() {
        true => format!("{text} [{unit}]"),
        false => text,
    }
}

/// The blocks below each other, with the columns of `headers`, and of the values if there are any.
fn stacked(table: &Table, headers: Vec<String>, blocks: &[Block]) -> Result<Table> {
    if table.rows.len() * blocks.len() > MOST_ROWS {
        return Err(fault(format!("there are more than {MOST_ROWS} points")));
    }
    let plain = |cell: &str| cell.replace([';', '\n', '\r'], " ");
    let value = |block: &Block| block.value.as_ref().map(|value| number(value.number, table.decimal_comma));
    let named = blocks.first().and_then(|block| block.value.as_ref());
    let mut lines = vec![line(
        headers.iter().map(|header| plain(header)),
        named.map(|value| match value.unit {
            "" => value.name().to_owned(),
            unit => format!("{} [{unit}]", value.name()),
        }),
    )];
    let mut places = Vec::new();
    for block in blocks {
        for row in &table.rows {
            let cells = || block.columns.iter().map(|column| table.cell(row, *column));
            // Sweeps of fewer points end earlier.
            if cells().filter(|cell| !is_missing(cell)).count() >= 2 {
                lines.push(line(cells().map(plain), value(block)));
                places.push(row.line);
            }
        }
    }
    let mut long = Table::split(lines.join("\n"), Some(';'), table.decimal_comma)?;
    // The points follow the line of headers, line 1.
    for Row { line, .. } in &mut long.rows {
        *line = places.get(line.saturating_sub(2)).copied().unwrap_or(*line);
    }
    Ok(long)
}

fn line(cells: impl Iterator<Item = String>, value: Option<String>) -> String {
    cells.chain(value).collect::<Vec<_>>().join(";")
}

fn number(value: f64, decimal_comma: bool) -> String {
    let text = format!("{value:?}");
    if decimal_comma { text.replace('.', ",") } else { text }
}

/// Whether a text holds a temperature or a frequency.
pub(super) fn tells_value(text: &str) -> bool {
    value_in(text).is_some()
}

/// Other numbers before a K are no temperatures but thousands: a molecular weight of 44.1 K.
const PLAUSIBLE_KELVIN: Range<f64> = 100.0..2000.0;

/// The temperature or frequency in a text: "-20 °C", "E'(0.100 Hz)/MPa".
fn value_in(text: &str) -> Option<Value> {
    const UNITS: [(&str, &str); 8] = [
        ("°C", "°C"),
        ("ºC", "°C"),
        ("degC", "°C"),
        ("°F", "°F"),
        ("rad/s", "rad/s"),
        ("Hz", "Hz"),
        ("K", "K"),
        ("C", "°C"),
    ];
    let is_digit = |c: char| c.is_ascii_digit();
    let mut from = 0;
    while let Some(start) = text[from..].find(is_digit).map(|at| from + at) {
        let end = text[start..]
            .find(|c: char| !is_digit(c) && c != '.' && c != ',')
            .map_or(text.len(), |at| start + at);
        from = end;
        let signed = text[..start].strip_suffix(['-', '+', '−']).map_or(start, str::len);
        // The digit of a name: E1.
        if text[..signed].ends_with(char::is_alphanumeric) {
            continue;
        }
        let rest = text[end..].trim_start();
        let Some((written, unit)) = UNITS.iter().find(|(written, _)| rest.starts_with(written)) else {
            continue;
        };
        let rest = &rest[written.len()..];
        // "5 K/min" is a rate.
        if rest.starts_with(char::is_alphanumeric)
            || ["/min", "/s", "/h"].iter().any(|per| rest.starts_with(per))
        {
            continue;
        }
        let digits = text[signed..end].replace(',', ".").replace('−', "-");
        let is_likely = |number: &f64| unit != &"K" || PLAUSIBLE_KELVIN.contains(number);
        if let Some(number) = digits.parse::<f64>().ok().filter(is_likely) {
            return Some(Value { number, unit, span: signed..text.len() - rest.len() });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table> {
        long(Table::parse(text.as_bytes()).unwrap())
    }

    /// Names, units, all numbers by columns, and the lines of the points.
    fn found(text: &str) -> (Vec<String>, Vec<String>, Vec<Vec<f64>>, Vec<usize>) {
        let table = read(text).unwrap();
        let columns = (0..table.headings.len()).map(|column| table.numbers(column).unwrap()).collect();
        let lines = table.rows.iter().map(|row| row.line).collect();
        let (names, units) = table.headings.into_iter().map(|heading| (heading.name, heading.unit)).unzip();
        (names, units, columns, lines)
    }

    #[test]
    fn blocks_of_columns_stand_below_each_other_with_the_temperature_above_them() {
        let (names, units, columns, lines) = found(
            "-20 °C;;;;T = 30,5 °C;;\nf;E';E'';;f;E';E''\nHz;MPa;MPa;;Hz;MPa;MPa\n0,1;10;1;;0,1;5;2\n1;11;1,5;;;;\n",
        );
        assert_eq!(names, ["f", "E'", "E''", "Temperature"]);
        assert_eq!(units, ["Hz", "MPa", "MPa", "°C"]);
        let expected: [&[f64]; 4] =
            [&[0.1, 1.0, 0.1], &[10.0, 11.0, 5.0], &[1.0, 1.5, 2.0], &[-20.0, -20.0, 30.5]];
        assert_eq!(columns, expected);
        assert_eq!(lines, [4, 5, 4]);
    }

    #[test]
    fn blocks_may_hold_their_temperature() {
        let (names, _, columns, _) =
            found("T [°C],f [Hz],E' [Pa],T [°C],f [Hz],E' [Pa]\n20,1,5,30,1,4\n20,2,6,30,2,5\n");
        assert_eq!(names, ["T", "f", "E'"]);
        assert_eq!(columns[0], [20.0, 20.0, 30.0, 30.0]);
    }

    #[test]
    fn repeated_columns_without_temperatures_are_refused() {
        let error = read("f [Hz],E' [Pa],f [Hz],E' [Pa]\n1,5,1,4\n2,6,2,5\n").unwrap_err();
        assert!(error.message.contains("columns 1 to 2 are repeated 2 times"), "{error:?}");
    }

    #[test]
    fn temperatures_and_frequencies_are_taken_from_the_names() {
        let (names, units, columns, _) = found(
            "f [Hz]\tE' -5°C [MPa]\tE' 10°C [MPa]\tE'' -5°C [MPa]\tE'' 10°C [MPa]\n0.1\t9\t8\t2\t1\n1\t10\t9\t3\t2\n",
        );
        assert_eq!(
            (names.join(" "), units.join(" ")),
            ("f E' E'' Temperature".into(), "Hz MPa MPa °C".into())
        );
        assert_eq!(columns[1], [9.0, 10.0, 8.0, 9.0]);
        assert_eq!(columns[3], [-5.0, -5.0, 10.0, 10.0]);
        let (names, units, columns, _) = found(
            "##Temp./°C;E'(0.100 Hz)/MPa;E'(10.000 Hz)/MPa;E\"(0.100 Hz)/MPa;E\"(10.000 Hz)/MPa\n-20;9;12;2;3\n0;5;8;1;2\n",
        );
        assert_eq!((names.join(" "), units.join(" ")), ("Temp. E' E\" f".into(), "°C MPa MPa Hz".into()));
        assert_eq!(columns[1], [9.0, 5.0, 12.0, 8.0]);
        assert_eq!(columns[3], [0.1, 0.1, 10.0, 10.0]);
    }

    #[test]
    fn other_tables_stay_as_they_are() {
        for text in [
            "f [Hz],E' [MPa],E'' [MPa],T [°C]\n1,2,3,4\n2,3,4,4\n",
            "t [s],E1 20°C [MPa]\n1,2\n2,1\n",
            "f [Hz],E' 20°C [MPa],E'' 30°C [MPa]\n1,2,3\n2,3,4\n",
            "1 2 1 2\n2 3 2 3\n",
        ] {
            let table = read(text).unwrap();
            assert_eq!(table.rows.len(), 2, "{text}");
        }
        // A rate is no temperature, and the digit of a name no number.
        assert!(value_in("ramp 5 K/min").is_none() && value_in("E1 K").is_none() && value_in("20").is_none());
        // Nor is a molecular weight in thousands.
        assert!(value_in("44.1 K, Nen=19.44").is_none() && value_in("293.15 K").is_some());
    }
}
