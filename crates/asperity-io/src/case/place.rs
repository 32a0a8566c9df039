//! Where faults are reported: places of the case file by the path of their key.

use std::cell::RefCell;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use asperity::{Error, Grid};
use ndarray::Array2;

use super::error::CaseError;
use super::text::{MOST_ERRORS, Spot, Text, in_order, join};
use super::words;
use crate::digest::md5;
use crate::quantity::QuantityError;
use crate::resources::{open, why};
use crate::{Code, choice};

/// The text of a case, and the faults found so far.
pub struct Checks<'c> {
    text: &'c Text<'c>,
    /// Where relative paths begin.
    dir: &'c Path,
    errors: RefCell<Vec<CaseError>>,
    files: RefCell<Vec<Origin>>,
}

/// Path of a file as the case writes it, and its MD5.
pub type Origin = (String, String);

impl<'c> Checks<'c> {
    pub fn new(text: &'c Text<'c>, dir: &'c Path) -> Self {
        Checks { text, dir, errors: RefCell::default(), files: RefCell::default() }
    }

    /// The place of the document itself.
    pub fn root(&'c self) -> Place<'c> {
        self.at("")
    }

    /// The place of a section.
    pub fn at(&'c self, section: &str) -> Place<'c> {
        Place { checks: self, key: section.to_owned() }
    }

    /// What was made, where nothing is wrong; otherwise the faults in the order of their places.
    pub fn finish<T>(&self, made: Option<T>) -> Result<T, Vec<CaseError>> {
        let mut errors = self.errors.take();
        in_order(&mut errors);
        made.filter(|_| errors.is_empty()).ok_or(errors)
    }

    /// The files of numbers that were read.
    pub fn files(&self) -> Vec<Origin> {
        self.files.take()
    }
}

/// A key of the case, or the table or list that it is. What reports a fault returns `None`.
#[derive(Clone)]
pub struct Place<'c> {
    checks: &'c Checks<'c>,
    /// Path of the key ("body[0].material").
    pub key: String,
}

impl<'c> Place<'c> {
    /// The place of a key of this table.
    pub fn key(&self, name: &str) -> Place<'c> {
        Place { checks: self.checks, key: join(&self.key, name) }
    }

    /// The place of any other key of the case.
    pub fn sibling(&self, key: &str) -> Place<'c> {
        self.checks.at(key)
    }

    /// The place of an element of this list.
    pub fn item(&self, n: usize) -> Place<'c> {
        Place { checks: self.checks, key: format!("{}[{n}]", self.key) }
    }

    /// Whether the file gives this key of the table.
    pub fn has(&self, name: &str) -> bool {
        self.checks.text.has(&join(&self.key, name))
    }

    /// The array of this name, which a program gives beside the case: a number for each cell of the grid.
    pub fn array(&self, name: &str, grid: &Grid) -> Option<Array2<f64>> {
        match self.checks.text.arrays.and_then(|arrays| arrays.get(name)) {
            None => self.fault(
                format!("there is no array \"{name}\""),
                "the name of an array that a program gives beside the case",
                "",
            ),
            Some(array) if array.dim() != grid.shape() => {
                let expected = format!("shape {:?}, a number for each cell", grid.shape());
                self.fault(format!("the array has shape {:?}", array.dim()), &expected, "")
            }
            Some(array) => Some(array.as_standard_layout().into_owned()),
        }
    }

    fn push<T>(&self, error: impl FnOnce(&Text<'_>, Spot) -> CaseError) -> Option<T> {
        let mut errors = self.checks.errors.borrow_mut();
        // Many alike have one cause.
        if errors.len() < MOST_ERRORS {
            errors.push(error(self.checks.text, self.checks.text.of(&self.key)));
        }
        None
    }

    /// Keys that do not go together: a sentence says best what is wrong. No `help` is an empty one.
    pub fn fault<T>(&self, message: impl Display, expected: &str, help: &str) -> Option<T> {
        self.refuse(Code::Conflict, message, expected, help)
    }

    /// Any fault that a sentence says best.
    pub fn refuse<T>(&self, code: Code, message: impl Display, expected: &str, help: &str) -> Option<T> {
        self.push(|text, spot| text.fault(code, spot, &message.to_string(), expected, help))
    }

    /// The value is not what is expected.
    pub fn wrong<T>(&self, expected: impl Display, help: &str) -> Option<T> {
        self.push(|text, spot| text.wrong(Code::OutOfRange, spot, &expected.to_string(), help))
    }

    /// Keys of the table that are needed, or do not go together; the message names the table itself.
    pub fn error<T>(&self, code: Code, message: impl Display, expected: &str, help: &str) -> Option<T> {
        self.push(|text, spot| {
            let value = Some(text.value(&spot));
            text.error(code, spot, value, expected, help, message.to_string())
        })
    }

    /// The table needs this key; `why` ends the message.
    pub fn missing<T>(&self, name: &str, why: &str) -> Option<T> {
        self.push(|text, Spot { key, span }| {
            let mut error = words::missing(text, Spot { key: join(&key, name), span }, name);
            error.message.push_str(why);
            error
        })
    }

    /// The solver's own check refuses the value, or a key inside that it names.
    pub fn core<T>(&self, result: asperity::Result<T>) -> Option<T> {
        let error = match result {
            Ok(value) => return Some(value),
            Err(error) => error,
        };
        let expected = match &error {
            Error::Invalid { expected, .. } => expected.split(". ").next().unwrap_or_default(),
            _ => "",
        };
        let code = choice::parse(error.code()).unwrap_or(Code::OutOfRange);
        self.given(error.parameter()).refuse(code, &error, expected, "")
    }

    /// The key with this path inside the table, or the innermost one on the way to it that the case gives.
    fn given(&self, path: &str) -> Place<'c> {
        // A single stage stands in [load] itself.
        let path = match path.strip_prefix("load.stages[0]") {
            Some(rest) if !self.has("load.stages") => format!("load{rest}"),
            _ => path.to_owned(),
        };
        let ends = path.rmatch_indices(['.', '[']).map(|(end, _)| end);
        let found = std::iter::once(path.len()).chain(ends).find(|end| self.has(&path[..*end]));
        found.map_or_else(|| self.clone(), |end| self.key(&path[..end]))
    }

    /// What was read from the file that the key names.
    pub fn data<T>(&self, result: Result<T, impl Display>, expected: &str) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => self.refuse(Code::Data, error, expected, ""),
        }
    }

    pub fn quantity<T>(&self, result: Result<T, QuantityError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(QuantityError { code, expected, help }) => {
                self.push(|text, spot| text.wrong(code, spot, &expected, help.as_deref().unwrap_or_default()))
            }
        }
    }

    /// Which of several keys is given, where exactly one must be.
    pub fn exactly_one<'k>(&self, keys: &[&'k str]) -> Option<&'k str> {
        let given: Vec<&str> = keys.iter().copied().filter(|key| self.has(key)).collect();
        self.only_one(keys, &given)
    }

    /// The same where the caller knows which are given.
    pub fn only_one<'k>(&self, keys: &[&str], given: &[&'k str]) -> Option<&'k str> {
        if let [one] = given {
            return Some(one);
        }
        let names: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
        let (path, names) = (&self.key, names.join(" or "));
        let (code, message, expected) = match given.is_empty() {
            true => (Code::MissingKey, format!("{path} needs {names}"), names),
            false => {
                let message = format!("{path} has {}, but needs only one of them", given.join(" and "));
                (Code::Conflict, message, format!("only one of {names}"))
            }
        };
        self.push(|text, spot| text.error(code, spot, None, &expected, "", message))
    }

    /// Refuses keys of the table that something else excludes; `None` where one is given. `why` ends the message
    /// "`KEY` ...".
    pub fn without(&self, keys: &[&str], why: &str, expected: &str, help: &str) -> Option<()> {
        let given: Vec<&&str> = keys.iter().filter(|key| self.has(key)).collect();
        for key in &given {
            self.key(key).fault::<()>(format!("`{key}` {why}"), expected, help);
        }
        given.is_empty().then_some(())
    }

    /// The path of an existing file, relative to the case file.
    pub fn file(&self, path: &str) -> Option<PathBuf> {
        let full = self.checks.dir.join(path);
        let Err(error) = open(&full) else { return Some(full) };
        let message = format!("\"{path}\": {} (looked for {})", why(&error), full.display());
        let help =
            "correct the path, which is relative to the directory of the case file, or move the file there";
        self.refuse(Code::File, message, "a file", help)
    }

    /// Keeps the MD5 of a file of numbers that the case names.
    pub fn note_file(&self, path: &str, digest: String) {
        self.checks.files.borrow_mut().push((path.to_owned(), digest));
    }

    /// Keeps the MD5 of a file that its reader does not give; one that cannot be read is told by its reader.
    pub fn note_read(&self, path: &str, full: &Path) {
        if let Ok(bytes) = std::fs::read(full) {
            self.note_file(path, md5(&bytes));
        }
    }

    /// The values, where each is larger than the one before.
    pub fn increasing(&self, times: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
        let times: Vec<f64> = times.collect();
        match times.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Some(times),
            Some(n) => self.item(n + 1).wrong(
                format!("later than the time before it, {} s", words::number(times[n])),
                "list the times in increasing order, each once",
            ),
        }
    }
}
