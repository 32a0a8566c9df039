//! MD5 of files: X3P stores it, and a resumed run recognises by it that a file has changed.

/// MD5 in hexadecimal digits.
pub fn md5(bytes: &[u8]) -> String {
    format!("{:x}", md5::compute(bytes))
}
