//! What a format is, and how a file's format is found: by content, never by the file's name.

use std::{fmt, str::FromStr};

use super::finish::Measured;
use super::{Format, Request, Result, Topography, unpack};

/// A format: its names, how to tell it, and how to read and write it.
pub(super) struct Reader {
    /// Its name, usually the ending of the file name.
    pub name: &'static str,
    /// Other names that a user may give it.
    pub aliases: &'static [&'static str],
    /// Whether the content, not packed by gzip, is of this format.
    pub sniff: fn(&[u8]) -> bool,
    /// Heights in the file's unit.
    pub read: fn(&[u8], &Request) -> Result<Measured>,
    /// The bytes of a file, where the format is written too.
    pub write: Option<Write>,
}

impl Reader {
    /// Of a format that is only read.
    pub(super) const fn new(
        name: &'static str,
        sniff: fn(&[u8]) -> bool,
        read: fn(&[u8], &Request) -> Result<Measured>,
    ) -> Reader {
        Reader { name, aliases: &[], sniff, read, write: None }
    }

    pub(super) const fn also_called(self, aliases: &'static [&'static str]) -> Reader {
        Reader { aliases, ..self }
    }

    pub(super) const fn written_by(self, write: Write) -> Reader {
        Reader { write: Some(write), ..self }
    }
}

/// Writes a surface as the bytes of a file.
pub(super) type Write = fn(&Topography) -> Result<Vec<u8>>;

/// Makes the enum of the formats from a table of readers.
macro_rules! formats {
    ($(#[$doc:meta])* pub enum Format; $($(#[$entry:meta])* $format:ident: $reader:path;)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Format {
            $($(#[$entry])* $format,)*
        }

        impl Format {
            /// Every format, in the order in which they are looked for.
            pub const ALL: &[Format] = &[$(Format::$format,)*];

            fn reader(self) -> &'static Reader {
                match self {
                    $(Format::$format => &$reader,)*
                }
            }
        }
    };
}
pub(super) use formats;

impl Format {
    /// Name of the format.
    pub fn name(self) -> &'static str {
        self.reader().name
    }

    /// Names of the formats that [`write()`](fn@super::write) takes.
    pub fn written() -> impl Iterator<Item = Format> {
        Format::ALL.iter().copied().filter(|format| format.is_written())
    }

    /// Whether [`write()`](fn@super::write) takes it.
    pub fn is_written(self) -> bool {
        self.reader().write.is_some()
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let lower = name.to_ascii_lowercase();
        let is_named = |format: &Format| {
            let reader = format.reader();
            reader.name == lower || reader.aliases.contains(&lower.as_str())
        };
        Format::ALL.iter().copied().find(is_named).ok_or_else(|| {
            let names = list(Format::ALL.iter().copied());
            format!("unknown topography format {name:?}; expected one of {names}")
        })
    }
}

/// Names with commas between them.
pub(super) fn list(formats: impl Iterator<Item = Format>) -> String {
    formats.map(Format::name).collect::<Vec<_>>().join(", ")
}

/// The format of a file with this content, also of one packed by gzip; `None` for an unknown format.
pub fn detect(bytes: &[u8]) -> Option<Format> {
    let sniff = |bytes: &[u8]| Format::ALL.iter().copied().find(|format| (format.reader().sniff)(bytes));
    if unpack::is_gzip(bytes) {
        // The signatures and the first lines of text are near the start; a zip archive inside gzip is not looked for.
        return sniff(&unpack::gunzip_prefix(bytes, 1 << 20));
    }
    sniff(bytes)
}
