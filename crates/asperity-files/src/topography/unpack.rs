//! Packed files, gzip and zip, with a bound on the unpacked size of a small file.

use std::io::{Cursor, Read};

use flate2::read::MultiGzDecoder;
use zip::ZipArchive;

use super::{Problem, Result};

/// Largest number of bytes that `packed` bytes may unpack to.
///
/// Deflate reaches 1032 : 1 on a file of equal bytes, measured heights hardly 20 : 1. The ratio bounds what a
/// hostile file can ask for; the constant lets maps of 4096 x 4096 equal heights pass.
pub(super) fn most_unpacked(packed: usize) -> u64 {
    (256 << 20) + 64 * packed as u64
}

/// Reads `source` to its end, but refuses more than `most` bytes. `likely` is the length that the file states.
pub(super) fn read_bounded(source: impl Read, most: u64, likely: u64, what: &str) -> Result<Vec<u8>> {
    // The stated length may be wrong: the vector grows as the bytes come.
    let mut bytes = Vec::with_capacity(usize::try_from(likely.min(most)).unwrap_or(0));
    source.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| {
        Problem::malformed(format!("the packed stream of {what}"), e, "a whole, undamaged stream")
    })?;
    if bytes.len() as u64 > most {
        return Err(Problem::malformed(
            format!("the unpacked length of {what}"),
            format!("more than {most} bytes"),
            "no longer than the file says and 64 times its packed length; unpack it first if it is genuine",
        ));
    }
    Ok(bytes)
}

/// Whether the bytes are packed by gzip.
pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b, 8])
}

/// The unpacked bytes, or `None` where they are not packed by gzip.
pub(super) fn gunzip(bytes: &[u8]) -> Result<Option<Vec<u8>>> {
    if !is_gzip(bytes) {
        return Ok(None);
    }
    read_bounded(
        MultiGzDecoder::new(bytes),
        most_unpacked(bytes.len()),
        4 * bytes.len() as u64,
        "the gzip file",
    )
    .map(Some)
}

/// The first `most` unpacked bytes, as far as they can be unpacked.
pub(super) fn gunzip_prefix(bytes: &[u8], most: u64) -> Vec<u8> {
    let mut prefix = Vec::new();
    // A damaged stream is reported when the file is read; the bytes before the damage are enough to find the format.
    let _ = MultiGzDecoder::new(bytes).take(most).read_to_end(&mut prefix);
    prefix
}

/// A zip archive in memory.
pub(super) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Eight times the length of the archive.
    length: u64,
    left: u64,
}

impl<'a> Archive<'a> {
    /// Opens the archive.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        let zip = ZipArchive::new(Cursor::new(bytes))
            .map_err(|e| Problem::malformed("the zip archive", e, "a whole, undamaged archive"))?;
        Ok(Archive { zip, length: 8 * bytes.len() as u64, left: most_unpacked(bytes.len()) })
    }

    /// Names of the members, sorted as in the archive.
    pub(super) fn names(&self) -> Vec<String> {
        self.zip.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect()
    }

    /// Unpacks a member. All members together stay within the bound of the archive.
    pub(super) fn member(&mut self, name: &str) -> Result<Vec<u8>> {
        let file = self.zip.by_name(name).map_err(|e| broken(name, e))?;
        let likely = file.size().min(file.compressed_size().saturating_mul(8)).min(self.length);
        let bytes = read_bounded(file, self.left, likely, &format!("member {name:?}"))?;
        self.left -= bytes.len() as u64;
        Ok(bytes)
    }

    /// The first bytes of a member.
    pub(super) fn start(&mut self, name: &str, most: u64) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let file = self.zip.by_name(name).map_err(|e| broken(name, e))?;
        file.take(most).read_to_end(&mut bytes).map_err(|e| broken(name, e))?;
        Ok(bytes)
    }
}

fn broken(name: &str, error: impl std::fmt::Display) -> Problem {
    Problem::malformed(format!("member {name:?} of the zip archive"), error, "readable")
}

/// Whether the bytes are a zip archive with a member of such a name.
pub(super) fn holds_member(bytes: &[u8], is_named: impl Fn(&str) -> bool) -> bool {
    let names = || Archive::open(bytes).map(|archive| archive.names()).unwrap_or_default();
    bytes.starts_with(b"PK\x03\x04") && names().iter().any(|name| is_named(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_that_swells_is_cut_off() {
        let endless = std::io::repeat(0);
        let error = read_bounded(endless, 1000, 10, "the stream").unwrap_err().to_string();
        assert!(error.contains("more than 1000 bytes"), "{error}");
        assert_eq!(read_bounded(&b"abc"[..], 3, u64::MAX, "the stream").ok().as_deref(), Some(&b"abc"[..]));
    }

    #[test]
    fn damage_of_a_packed_file_is_found() {
        use std::io::Write;
        let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        gzip.write_all(&[7; 1000]).unwrap();
        let mut packed = gzip.finish().unwrap();
        assert_eq!(gunzip(&packed).ok().flatten().map(|b| b.len()), Some(1000));
        // The last eight bytes are the checksum and the length.
        let checksum = packed.len() - 6;
        packed[checksum] ^= 1;
        assert!(gunzip(&packed).is_err());
        assert!(gunzip(&packed[..checksum]).is_err());
    }
}
