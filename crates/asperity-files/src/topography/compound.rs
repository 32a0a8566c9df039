//! Compound documents (OLE), which hold files ("streams") inside one file: .mnt and .xls.

use std::io::{Cursor, ErrorKind, Read};

/// Whether the bytes are a compound document.
pub(crate) fn is_compound(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")
}

/// The stream of this name at the top level of a compound document; `None` if there is none.
///
/// # Errors
/// What is damaged.
pub(crate) fn stream(bytes: &[u8], name: &str) -> std::io::Result<Option<Vec<u8>>> {
    let mut document = cfb::CompoundFile::open(Cursor::new(bytes))?;
    let stream = match document.open_stream(name) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        stream => stream?,
    };
    let mut content = Vec::new();
    // A damaged one may say that it is longer than the document.
    stream.take(bytes.len() as u64).read_to_end(&mut content)?;
    Ok(Some(content))
}
