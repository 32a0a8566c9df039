//! The text of a case file with its tree: from a place in the text to the key, the line and the value there.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::CaseError;
use super::given::Arrays;
use crate::Code;

/// A case file's text, its TOML tree, and, where a program gives the case, the arrays beside it.
pub struct Text<'t> {
    pub source: &'t str,
    pub root: DeTable<'t>,
    pub arrays: Option<&'t Arrays>,
}

impl<'t> Text<'t> {
    /// Parses the text.
    ///
    /// # Errors
    /// The faults of the TOML grammar, in order.
    pub fn parse(source: &'t str) -> Result<Self, Vec<CaseError>> {
        let (root, errors) = DeTable::parse_recoverable(source);
        let text = Text { source, root: root.into_inner(), arrays: None };
        if errors.is_empty() {
            return Ok(text);
        }
        Err(errors.iter().take(MOST_ERRORS).map(|error| text.grammar(error)).collect())
    }

    fn grammar(&self, error: &toml::de::Error) -> CaseError {
        let span = error.span().map(|span| self.inside(span));
        let found = error.message();
        let help = if found.contains("duplicate key") {
            "write each key and each table once; several bodies, surfaces or stages begin each with a line in double \
             brackets: [[body]]"
        } else if found.contains("string values must be quoted") {
            "write texts and values with a unit between quotes: value = \"50 N\""
        } else {
            ""
        };
        let message = format!("this is not TOML: {}", found.replace('\n', ", "));
        self.error(Code::Syntax, Spot { key: String::new(), span }, None, "TOML", help, message)
    }

    /// Line of the byte, from 1.
    pub fn line(&self, byte: usize) -> usize {
        let before = self.source.as_bytes().iter().take(byte);
        1 + before.filter(|b| **b == b'\n').count()
    }

    /// What is written at the spot, shortened where it is long.
    pub fn value(&self, spot: &Spot) -> String {
        let text = spot.span.clone().and_then(|span| self.source.get(span)).unwrap_or_default();
        match text.char_indices().nth(MOST_CHARACTERS) {
            Some((end, _)) => format!("{}...", &text[..end]),
            None => text.to_owned(),
        }
    }

    /// The spot whose value, key or table header stands at these bytes: the smallest that holds them.
    pub fn at(&self, span: &Range<usize>) -> Spot {
        let mut best = (usize::MAX, String::new());
        self.visit(&mut |path, key, value| {
            for place in [key, Some(value.span())].into_iter().flatten() {
                let holds = place.start <= span.start && span.end <= place.end;
                // The deepest where places are equal.
                if holds && place.len() <= best.0 {
                    best = (place.len(), path.to_owned());
                }
            }
        });
        Spot { key: best.1, span: Some(span.clone()) }
    }

    /// The spot of the key with this path; where the text does not have it, in the innermost table that leads to it.
    pub fn of(&self, key: &str) -> Spot {
        Spot { key: key.to_owned(), span: self.walk(key).0 }
    }

    /// Whether the text has the key with this path.
    pub fn has(&self, key: &str) -> bool {
        self.walk(key).1
    }

    fn walk(&self, key: &str) -> (Option<Range<usize>>, bool) {
        let mut here: Option<&Spanned<DeValue<'t>>> = None;
        for name in key.split(['.', '[']) {
            let next = match (name.strip_suffix(']'), here.map(Spanned::get_ref)) {
                (Some(n), Some(DeValue::Array(array))) => n.parse().ok().and_then(|n: usize| array.get(n)),
                (None, Some(DeValue::Table(table))) => table.get(name),
                (None, None) => self.root.get(name),
                _ => None,
            };
            if next.is_none() {
                return (here.map(Spanned::span), false);
            }
            here = next;
        }
        (here.map(Spanned::span), true)
    }

    /// Paths of all tables whose place is `span`: a header `[load.history]` stands for two.
    pub fn tables(&self, span: &Range<usize>) -> Vec<String> {
        let mut paths = Vec::new();
        self.visit(&mut |path, _, value| {
            if value.span() == *span && value.get_ref().is_table() {
                paths.push(path.to_owned());
            }
        });
        paths
    }

    /// Visits every value, a table before what it holds: its path, the place of its key, and itself.
    pub fn visit(&self, visitor: Visitor<'_, 't>) {
        visit_table(&self.root, "", visitor);
    }

    fn inside(&self, span: Range<usize>) -> Range<usize> {
        let end = span.end.min(self.source.len());
        span.start.min(end)..end
    }

    /// The value at the spot is not what is expected there.
    pub fn wrong(&self, code: Code, spot: Spot, expected: &str, help: &str) -> CaseError {
        let (key, value) = (&spot.key, self.value(&spot));
        let message = match value.contains('\n') {
            true => format!("{key} must be {expected}"),
            false => format!("{key} is {value}, but must be {expected}"),
        };
        self.error(code, spot, Some(value), expected, help, message)
    }

    /// Something is wrong with the value at the spot that a sentence says best; the key is put before it.
    pub fn fault(&self, code: Code, spot: Spot, message: &str, expected: &str, help: &str) -> CaseError {
        let value = self.value(&spot);
        let message =
            if spot.key.is_empty() { message.to_owned() } else { format!("{}: {message}", spot.key) };
        self.error(code, spot, Some(value), expected, help, message)
    }

    /// The same with a message that names the key itself. No `help` is an empty one.
    pub fn error(
        &self,
        code: Code,
        spot: Spot,
        value: Option<String>,
        expected: &str,
        help: &str,
        message: String,
    ) -> CaseError {
        let line = spot.span.as_ref().map(|span| self.line(span.start));
        let help = (!help.is_empty()).then(|| help.to_owned());
        CaseError {
            code,
            key: spot.key,
            span: spot.span,
            line,
            value,
            expected: expected.to_owned(),
            help,
            message,
        }
    }
}

/// Sorts faults by their places.
pub fn in_order(errors: &mut [CaseError]) {
    errors.sort_by_key(|error| error.span.as_ref().map_or(usize::MAX, |span| span.start));
}

/// A case file with more faults than this has one cause.
pub const MOST_ERRORS: usize = 20;
/// Longer values are cut in messages.
const MOST_CHARACTERS: usize = 60;

/// A spot of the text: the path of a key, and its bytes.
#[derive(Clone, Debug)]
pub struct Spot {
    pub key: String,
    pub span: Option<Range<usize>>,
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
