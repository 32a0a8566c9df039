//! The text of a case file with its tree: from a place in the text to the key, the line and the value there.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::CaseError;
use super::given::Arrays;

/// A case file's text, its TOML tree, and the arrays that a program gives beside it.
pub struct Text<'t> {
    pub source: &'t str,
    pub root: DeTable<'t>,
    pub arrays: &'t Arrays,
}

impl<'t> Text<'t> {
    /// Parses the text.
    ///
    /// # Errors
    /// The faults of the TOML grammar, in order.
    pub fn parse(source: &'t str) -> Result<Self, Vec<CaseError>> {
        let (root, errors) = DeTable::parse_recoverable(source);
        let text = Text { source, root: root.into_inner(), arrays: &NO_ARRAYS };
        if errors.is_empty() {
            return Ok(text);
        }
        Err(errors.iter().take(MOST_ERRORS).map(|error| text.grammar(error)).collect())
    }

    fn grammar(&self, error: &toml::de::Error) -> CaseError {
        let span = error.span().map(|span| self.inside(span));
        let found = error.message();
        let help = match () {
            () if found.contains("duplicate key") => Some(
                "write each key and each table once; several bodies, surfaces or stages begin each with a line \
                 in double brackets: [[body]]",
            ),
            () if found.contains("string values must be quoted") => {
                Some("write texts and values with a unit between quotes: value = \"50 N\"")
            }
            () => None,
        };
        CaseError {
            key: String::new(),
            line: span.as_ref().map(|span| self.line(span.start)),
            value: None,
            expected: "TOML".into(),
            help: help.map(str::to_owned),
            message: format!("this is not TOML: {}", found.replace('\n', ", ")),
            span,
        }
    }

    /// Line of the byte, from 1.
    pub fn line(&self, byte: usize) -> usize {
        let before = self.source.as_bytes().iter().take(byte);
        1 + before.filter(|b| **b == b'\n').count()
    }

    /// What is written at the place, shortened where it is long.
    pub fn value(&self, span: &Range<usize>) -> String {
        let text = self.source.get(span.clone()).unwrap_or_default();
        match text.char_indices().nth(MOST_CHARACTERS) {
            Some((end, _)) => format!("{}...", &text[..end]),
            None => text.to_owned(),
        }
    }

    /// Path of the value, the key or the table header at the place: "body[0].poisson".
    pub fn path(&self, span: &Range<usize>) -> String {
        self.find(span).map(|place| place.path).unwrap_or_default()
    }

    /// Paths of all tables whose place is `span`: a header `[load.history]` stands for two.
    pub fn tables(&self, span: &Range<usize>) -> Vec<String> {
        let mut paths = Vec::new();
        visit_table(&self.root, "", &mut |path, _, value| {
            if value.span() == *span && value.get_ref().is_table() {
                paths.push(path.to_owned());
            }
        });
        paths
    }

    fn find(&self, span: &Range<usize>) -> Option<Place> {
        let mut best: Option<Place> = None;
        visit_table(&self.root, "", &mut |path, key, value| {
            for place in [key, Some(value.span())].into_iter().flatten() {
                let holds = place.start <= span.start && span.end <= place.end;
                let size = place.len();
                // The smallest place that holds the span; the deepest where places are equal.
                if holds && best.as_ref().is_none_or(|best| size <= best.size) {
                    best = Some(Place { path: path.to_owned(), size });
                }
            }
        });
        best
    }

    fn inside(&self, span: Range<usize>) -> Range<usize> {
        let end = span.end.min(self.source.len());
        span.start.min(end)..end
    }

    /// The value at the place is not what is expected there.
    pub fn wrong(&self, span: &Range<usize>, expected: &str, help: Option<String>) -> CaseError {
        let key = self.path(span);
        let value = self.value(span);
        let message = match value.contains('\n') {
            true => format!("{key} must be {expected}"),
            false => format!("{key} is {value}, but must be {expected}"),
        };
        self.error(span, key, Some(value), expected, help, message)
    }

    /// Something is wrong with the value at the place that a sentence says best; the key is put before it.
    pub fn fault(
        &self,
        span: &Range<usize>,
        message: String,
        expected: &str,
        help: Option<String>,
    ) -> CaseError {
        let key = self.path(span);
        let message = format!("{key}: {message}");
        self.error(span, key, Some(self.value(span)), expected, help, message)
    }

    pub fn error(
        &self,
        span: &Range<usize>,
        key: String,
        value: Option<String>,
        expected: &str,
        help: Option<String>,
        message: String,
    ) -> CaseError {
        let line = Some(self.line(span.start));
        CaseError { key, span: Some(span.clone()), line, value, expected: expected.to_owned(), help, message }
    }
}

static NO_ARRAYS: Arrays = Arrays::new();

/// A case file with more faults than this has one cause.
pub const MOST_ERRORS: usize = 20;
/// Longer values are cut in messages.
const MOST_CHARACTERS: usize = 60;

struct Place {
    path: String,
    size: usize,
}

/// Path of `key` inside the table at `path`.
pub fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

type Visitor<'v, 't> = &'v mut dyn FnMut(&str, Option<Range<usize>>, &Spanned<DeValue<'t>>);

fn visit_table<'t>(table: &DeTable<'t>, path: &str, visitor: Visitor<'_, 't>) {
    for (key, value) in table.iter() {
        let path = join(path, key.get_ref());
        visitor(&path, Some(key.span()), value);
        visit_value(value.get_ref(), &path, visitor);
    }
}

fn visit_value<'t>(value: &DeValue<'t>, path: &str, visitor: Visitor<'_, 't>) {
    match value {
        DeValue::Table(table) => visit_table(table, path, visitor),
        DeValue::Array(array) => {
            for (n, element) in array.iter().enumerate() {
                let path = format!("{path}[{n}]");
                visitor(&path, None, element);
                visit_value(element.get_ref(), &path, visitor);
            }
        }
        _ => {}
    }
}
