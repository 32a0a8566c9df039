//! A case file that a program such as a form changes key by key: comments, order and blanks stay.

use toml_edit::{Document, DocumentMut, Item, TableLike, Value};

use super::overrides::Override;

/// A key of a case file with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its path, as errors and `--set` write it: "body\[0\].poisson".
    pub key: String,
    /// The value as `--set` takes it: texts without quotes, lists as TOML.
    pub value: String,
    /// Line of the file, counted from 1.
    pub line: usize,
}

/// The keys of a case, in the order of the file; `None` where it is no TOML. Lists of numbers and texts are one value.
pub fn entries(text: &str) -> Option<Vec<Entry>> {
    let document = Document::parse(text).ok()?;
    let mut found = vec![];
    of_table(document.as_table(), "", &mut |key, value| {
        let span = value.span().unwrap_or_default();
        found.push((span.start, key.to_owned(), words(value, &text[span])));
    });
    found.sort_by_key(|(start, ..)| *start);
    let (mut line, mut at) = (1, 0);
    let entry = |(start, key, value): (usize, String, String)| {
        line += text[at..start].matches('\n').count();
        at = start;
        Entry { key, value, line }
    };
    Some(found.into_iter().map(entry).collect())
}

/// The text with a key set to a value, which is TOML or else text; missing tables are made.
///
/// # Errors
/// A sentence: the text is no TOML, or the key leads nowhere.
pub fn with_key(text: &str, key: &str, value: &str) -> Result<String, String> {
    let mut document: DocumentMut =
        text.parse().map_err(|_| "the text is no TOML yet: correct it first".to_owned())?;
    Override::parse(&format!("{key}={value}"))?.apply(&mut document)?;
    Ok(document.to_string())
}

type Take<'a> = dyn FnMut(&str, &Value) + 'a;

fn of_table(table: &dyn TableLike, path: &str, take: &mut Take<'_>) {
    for (key, item) in table.iter() {
        let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        match item {
            Item::Value(value) => of_value(value, &path, take),
            Item::Table(table) => of_table(table, &path, take),
            Item::ArrayOfTables(tables) => {
                tables
                    .iter()
                    .enumerate()
                    .for_each(|(n, table)| of_table(table, &format!("{path}[{n}]"), take));
            }
            Item::None => {}
        }
    }
}

fn of_value(value: &Value, path: &str, take: &mut Take<'_>) {
    match value {
        Value::InlineTable(table) => of_table(table, path, take),
        Value::Array(list) if list.iter().any(Value::is_inline_table) => {
            list.iter().enumerate().for_each(|(n, value)| of_value(value, &format!("{path}[{n}]"), take));
        }
        value => take(path, value),
    }
}

/// A text that would be read as something else keeps its quotes.
fn words(value: &Value, written: &str) -> String {
    let is_plain = |text: &&str| text.parse::<Value>().is_err() && text.trim() == *text && !text.is_empty();
    value.as_str().filter(is_plain).unwrap_or(written).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "title = \"a b\" # the title\n[domain]\ncells = [64, 64]   # few\nrate = 1e-8\n[[body]]\nname = \"1\"\n\
                        material = { model = \"prony\", terms = [{ time = \"1 s\" }, { time = \"2 s\" }] }\n";

    fn found(text: &str) -> Vec<(String, String, usize)> {
        entries(text).unwrap().into_iter().map(|entry| (entry.key, entry.value, entry.line)).collect()
    }

    #[test]
    fn keys_have_their_values_and_lines() {
        let expected = [
            ("title", "a b", 1),
            ("domain.cells", "[64, 64]", 3),
            ("domain.rate", "1e-8", 4),
            ("body[0].name", "\"1\"", 6),
            ("body[0].material.model", "prony", 7),
            ("body[0].material.terms[0].time", "1 s", 7),
            ("body[0].material.terms[1].time", "2 s", 7),
        ];
        assert_eq!(found(CASE), expected.map(|(key, value, line)| (key.to_owned(), value.to_owned(), line)));
        assert_eq!(entries("[domain"), None);
    }

    #[test]
    fn setting_each_key_to_its_value_changes_nothing() {
        for entry in entries(CASE).unwrap() {
            assert_eq!(with_key(CASE, &entry.key, &entry.value).as_deref(), Ok(CASE), "{}", entry.key);
        }
    }

    #[test]
    fn a_value_changes_alone() {
        let changed = with_key(CASE, "domain.cells", "[128, 64]").unwrap();
        assert_eq!(changed, CASE.replace("[64, 64]", "[128, 64]"));
        let more = with_key(CASE, "solver.tolerance", "1e-8").unwrap();
        assert!(more.starts_with(CASE) && more.ends_with("[solver]\ntolerance = 1e-8\n"), "{more}");
        assert!(with_key("[domain", "a", "1").unwrap_err().contains("no TOML"));
        assert!(with_key(CASE, "body[3].name", "x").unwrap_err().contains("no element 3"));
    }
}
