//! What ends a command early, how it is printed, and its exit code.

use std::io::IsTerminal;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use asperity_io::case::{CaseError, CaseErrors};
use asperity_io::readable::counted;

/// Why a command did not do what was asked.
#[derive(Debug)]
pub enum Failure {
    /// The case file is wrong.
    Case(CaseErrors),
    /// Any other input is wrong.
    Input(String),
    /// The solve failed.
    Solve(String),
    /// The system refuses what the program needs.
    System(String),
    /// Warnings, where they are to be errors.
    Strict(usize),
    /// Somebody pressed Ctrl-C; the message says how to go on.
    Interrupted(String),
}

/// Ends a function with a sentence about wrong input.
macro_rules! refuse {
    ($($sentence:tt)*) => { return Err($crate::failure::Failure::Input(format!($($sentence)*))) };
}
pub(crate) use refuse;

impl Failure {
    /// Wrong input, in one sentence.
    pub fn input(message: impl Into<String>) -> Self {
        Failure::Input(message.into())
    }

    /// Wrong input, which an error describes, of what has this name.
    pub fn about<E: std::fmt::Display>(name: impl std::fmt::Display) -> impl Fn(E) -> Failure {
        move |error| Failure::Input(format!("{name}: {error}"))
    }

    /// 1 the solve or the system failed, or there are warnings under --strict; 2 the input is wrong; 130 interrupted.
    pub fn code(&self) -> u8 {
        match self {
            Failure::Solve(_) | Failure::System(_) | Failure::Strict(_) => 1,
            Failure::Case(_) | Failure::Input(_) => 2,
            Failure::Interrupted(_) => 130,
        }
    }

    /// Prints it on stderr.
    pub fn print(&self) {
        match self {
            Failure::Case(errors) => print_case(errors),
            Failure::Input(message) | Failure::Solve(message) | Failure::System(message) => {
                crate::messages::message!("error: {message}");
            }
            Failure::Strict(warnings) => {
                crate::messages::message!("error: {} (--strict)", counted(*warnings, "warning"));
            }
            Failure::Interrupted(message) => crate::messages::message!("interrupted: {message}"),
        }
    }
}

/// An error is wrong input, unless the disk is full or fails.
impl<E: std::error::Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        use std::io::{Error, ErrorKind};
        let error: Box<dyn std::error::Error> = match Box::<dyn std::error::Error>::from(error).downcast() {
            Ok(errors) => return Failure::Case(*errors),
            Err(other) => other,
        };
        let causes = std::iter::successors(Some(&*error), |cause| cause.source());
        let mut of_system = causes.filter_map(|cause| cause.downcast_ref::<Error>());
        let fails = |error: &Error| {
            let full = [ErrorKind::StorageFull, ErrorKind::QuotaExceeded, ErrorKind::FileTooLarge];
            full.contains(&error.kind())
        };
        match of_system.any(fails) {
            true => Failure::System(error.to_string()),
            false => Failure::Input(error.to_string()),
        }
    }
}

/// Each fault with the lines of the case that it is in.
fn print_case(errors: &CaseErrors) {
    let source = masked(&errors.source);
    let short = source.lines().all(|line| line.len() <= LONGEST_LINE);
    for error in &errors.errors {
        if short && let Some(text) = drawn(error, &errors.name, &source) {
            crate::messages::write(&format!("{text}\n\n"));
        } else {
            let text = format!("{}: {error}", errors.name);
            let cut = text.char_indices().nth(LONGEST_LINE).map_or(text.as_str(), |(end, _)| &text[..end]);
            crate::messages::message!("error: {cut}{}", if cut.len() < text.len() { " ..." } else { "" });
        }
    }
}

/// A fault below its line of the source; `None` where it has no place there.
fn drawn(error: &CaseError, name: &str, source: &str) -> Option<String> {
    let span = error.span.clone().filter(|span| source.get(span.clone()).is_some())?;
    let label = match error.expected.as_str() {
        // The message says it.
        expected if expected.is_empty() || expected.len() > LONGEST_LABEL => "here".to_owned(),
        expected => format!("expected {expected}"),
    };
    let line = error.line.map_or(String::new(), |line| format!("line {line}: "));
    // Lines that overrides added are not counted: the line at the place has its number in the file.
    let counted_lines = 1 + source[..span.start].matches('\n').count();
    let added = error.line.map_or(0, |line| counted_lines.saturating_sub(line));
    let start = source.match_indices('\n').nth(added.wrapping_sub(1)).map_or(0, |(end, _)| end + 1);
    // The place may be in an added line itself.
    let start = start.min(source[..span.start].rfind('\n').map_or(0, |end| end + 1));
    let (source, span) = (&source[start..], span.start - start..span.end - start);
    let place =
        Snippet::source(source).path(name).annotation(AnnotationKind::Primary.span(span).label(label));
    let mut report = Level::ERROR.primary_title(format!("{line}{}", error.message)).element(place);
    if let Some(help) = &error.help {
        report = report.element(Level::HELP.message(help));
    }
    let coloured = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let renderer = if coloured { Renderer::styled() } else { Renderer::plain() };
    Some(renderer.term_width(terminal_width()).render(&[report]))
}

/// Longer words below a place of a case file are left out \[bytes\].
const LONGEST_LABEL: usize = 120;

/// Lines of a case file that are longer \[bytes\] are not drawn: they would bury the message.
const LONGEST_LINE: usize = 1000;

/// The source with its control characters replaced by question marks, as many bytes each.
fn masked(source: &str) -> String {
    // A carriage return may end a line.
    let mask = |c: char| crate::messages::hidden(c) && c != '\r';
    let mut text = String::with_capacity(source.len());
    for c in source.chars() {
        if mask(c) {
            text.extend(std::iter::repeat_n('?', c.len_utf8()));
        } else {
            text.push(c);
        }
    }
    text
}

fn terminal_width() -> usize {
    std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok()).unwrap_or(100)
}

#[cfg(test)]
mod tests {
    use std::io::{Error, ErrorKind};

    use asperity_io::store::StoreError;

    use super::*;

    #[test]
    fn a_full_disk_is_no_wrong_input() {
        let code = |kind: ErrorKind| {
            let (path, source) = ("a".into(), Error::from(kind));
            Failure::from(StoreError::Io { path, action: "write", source }).code()
        };
        assert_eq!([ErrorKind::StorageFull, ErrorKind::NotFound].map(code), [1, 2]);
        assert_eq!(Failure::from(Error::from(ErrorKind::FileTooLarge)).code(), 1);
    }
}
