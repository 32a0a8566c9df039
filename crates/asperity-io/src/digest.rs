//! MD5 of files: another file has another one. X3P asks for it, and a resumed run notices a change by it.

/// MD5 in hexadecimal digits.
pub(crate) fn md5(bytes: &[u8]) -> String {
    format!("{:x}", md5::compute(bytes))
}
