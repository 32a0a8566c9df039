//! Kinds of faults of an input: words that stay the same when the wording of messages changes.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::choice;

/// What kind of fault an input has. It is written as a word: "unknown-key".
///
/// ```
/// use asperity_files::Code;
/// assert_eq!(Code::WrongUnit.to_string(), "wrong-unit");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Code {
    /// The text is not TOML, or an override is not KEY=VALUE.
    Syntax,
    /// The table has no such key.
    UnknownKey,
    /// A key or a section is needed.
    MissingKey,
    /// The key takes one of several words, and this is none of them.
    UnknownKind,
    /// A text where a list belongs, a number where a table belongs.
    WrongType,
    /// The unit is unknown, or belongs to another dimension.
    WrongUnit,
    /// The value is outside the range that the key, or the numerics, accept.
    OutOfRange,
    /// Keys or sections exclude each other, or what is asked for is not solved together.
    Conflict,
    /// The load exceeds what the hardness can carry.
    Infeasible,
    /// The problem needs more memory than the machine has.
    TooLarge,
    /// A file does not exist or cannot be read.
    File,
    /// What a file or an array holds is not what the case needs.
    Data,
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(choice::word(self))
    }
}
