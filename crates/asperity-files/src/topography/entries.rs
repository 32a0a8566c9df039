//! Keys and values of a header, with the same errors for every format.

use super::{Problem, Result};

/// Keys and values in the order of the file; keys compare without case.
#[derive(Clone, Debug)]
pub(super) struct Entries {
    /// What holds them: "the BCR header", or the title of a section.
    pub title: String,
    list: Vec<(String, String)>,
}

impl Entries {
    /// None yet.
    pub(super) fn new(title: impl Into<String>) -> Self {
        Entries { title: title.into(), list: Vec::new() }
    }

    /// The lines of "key = value"; others are left out.
    pub(super) fn from_lines(title: impl Into<String>, lines: impl Iterator<Item = impl AsRef<str>>) -> Self {
        let mut entries = Entries::new(title);
        for line in lines {
            if let Some((key, value)) = line.as_ref().split_once('=') {
                entries.push(key, value);
            }
        }
        entries
    }

    /// Adds an entry, without surrounding blanks.
    pub(super) fn push(&mut self, key: &str, value: &str) {
        self.list.push((key.trim().to_owned(), value.trim().to_owned()));
    }

    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// Keys and values.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.list.iter().map(|(key, value)| (key.as_str(), value.as_str()))
    }

    /// The first value of the key.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.iter().find(|(k, _)| k.eq_ignore_ascii_case(key)).map(|(_, value)| value)
    }

    /// A finite number.
    pub(super) fn number(&self, key: &str) -> Result<f64> {
        let number = self.get(key).and_then(|v| v.parse().ok()).filter(|v: &f64| v.is_finite());
        number.ok_or_else(|| self.wrong(key, "a number"))
    }

    /// A whole number.
    pub(super) fn whole(&self, key: &str) -> Result<u64> {
        self.get(key).and_then(|v| v.parse().ok()).ok_or_else(|| self.wrong(key, "a whole number"))
    }

    /// The value of the key is not what is expected, or missing.
    pub(super) fn wrong(&self, key: &str, expected: &str) -> Problem {
        Problem::malformed(format!("{key} of {}", self.title), self.get(key).unwrap_or("missing"), expected)
    }
}

impl IntoIterator for Entries {
    type Item = (String, String);
    type IntoIter = std::vec::IntoIter<(String, String)>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}
