//! A case file that a program such as a form changes key by key: comments, order and blanks stay.

use std::ops::Range;

use toml::de::DeValue;
use toml_edit::{DocumentMut, Value};

use super::overrides::Override;
use super::text::Text;

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
pub fn entries(source: &str) -> Option<Vec<Entry>> {
    let mut found: Vec<(Range<usize>, String, String)> = vec![];
    Text::parse(source).ok()?.visit(&mut |path, _, value| {
        let holds_tables = match value.get_ref() {
            DeValue::Table(_) => true,
            DeValue::Array(list) => list.iter().any(|element| element.get_ref().is_table()),
            _ => false,
        };
        let span = value.span();
        let is_of_list = found.last().is_some_and(|(list, ..)| list.contains(&span.start));
        if !holds_tables && !is_of_list {
            let words = words(value.get_ref(), &source[span.clone()]);
            found.push((span, path.to_owned(), words));
        }
    });
    found.sort_by_key(|(span, ..)| span.start);
    let (mut line, mut at) = (1, 0);
    let entry = |(span, key, value): (Range<usize>, String, String)| {
        line += source[at..span.start].matches('\n').count();
        at = span.start;
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

/// A text that would be read as something else keeps its quotes.
fn words(value: &DeValue<'_>, written: &str) -> String {
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
