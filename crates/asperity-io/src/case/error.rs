//! What is wrong with a case file: which key, on which line, its value, what was expected, what to do.

use std::fmt;
use std::ops::Range;

use crate::Code;

/// One fault of a case file.
///
/// `message` is a sentence by itself; the other fields serve programs and renderers that point into the
/// source (the `span` counts bytes of [`CaseErrors::source`]).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct CaseError {
    /// What kind of fault it is.
    pub code: Code,
    /// Path of the key ("body\[0\].poisson"); empty for the file as a whole.
    pub key: String,
    /// Where in the source.
    pub span: Option<Range<usize>>,
    /// Line of the file, counted from 1: of the source without the lines that overrides added.
    pub line: Option<usize>,
    /// The value as written, if there is one.
    pub value: Option<String>,
    /// What was expected there.
    pub expected: String,
    /// What to do about it, if more can be said.
    pub help: Option<String>,
    /// The fault in one sentence.
    pub message: String,
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        write!(f, "{}", self.message)?;
        self.help.iter().try_for_each(|help| write!(f, " ({help})"))
    }
}

/// All faults found in one case file, with the text that they point into.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseErrors {
    /// The file's name.
    pub name: String,
    /// The text after the overrides were applied; empty where the file could not be read.
    pub source: String,
    /// The faults, in order of their place; never empty.
    pub errors: Vec<CaseError>,
}

impl fmt::Display for CaseErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (n, error) in self.errors.iter().enumerate() {
            let newline = if n == 0 { "" } else { "\n" };
            write!(f, "{newline}{}: {error}", self.name)?;
        }
        Ok(())
    }
}

impl std::error::Error for CaseErrors {}

impl CaseErrors {
    /// Errors that concern no place in the text: `message`, and what to do.
    pub(crate) fn without_place(
        code: Code,
        name: &str,
        message: String,
        expected: &str,
        help: Option<String>,
    ) -> Self {
        let error = CaseError {
            code,
            key: String::new(),
            span: None,
            line: None,
            value: None,
            expected: expected.to_owned(),
            help,
            message,
        };
        CaseErrors { name: name.to_owned(), source: String::new(), errors: vec![error] }
    }
}
