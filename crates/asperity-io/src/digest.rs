//! MD5 of files: another file has another one. X3P asks for it, and a resumed run notices a change by it.

use md5::{Digest, Md5};

/// MD5 in hexadecimal digits.
pub(crate) fn md5(bytes: &[u8]) -> String {
    Md5::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
