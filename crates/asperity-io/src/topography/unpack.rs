//! Packed files: gzip and zip, with a bound on what a small file may swell to.

use std::io::{Cursor, Read};

use flate2::read::MultiGzDecoder;
use zip::ZipArchive;

use super::{Format, Problem};

/// Most bytes that `packed` bytes may unpack to.
///
/// Deflate reaches 1032 : 1 on a file of equal bytes, measured heights hardly 20 : 1. The ratio bounds what a
/// hostile file can ask for; the constant lets small synthetic maps of equal heights pass.
pub(super) fn most_unpacked(packed: usize) -> u64 {
    (64 << 20) + 256 * packed as u64
}

/// Reads `source` to its end, but refuses more than `most` bytes.
pub(super) fn read_bounded(source: impl Read, most: u64, what: &str) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    source.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| {
        Problem::malformed(format!("the packed stream of {what}"), e, "a whole, undamaged stream")
    })?;
    if bytes.len() as u64 > most {
        return Err(Problem::malformed(
            format!("the unpacked length of {what}"),
            format!("more than {most} bytes"),
            "no longer than the file says and 256 times its packed length; unpack it first if it is genuine",
        ));
    }
    Ok(bytes)
}

/// Whether the bytes are packed by gzip.
pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b, 8])
}

/// The unpacked bytes, or `None` where they are not packed by gzip.
pub(super) fn gunzip(bytes: &[u8]) -> Result<Option<Vec<u8>>, Problem> {
    if !is_gzip(bytes) {
        return Ok(None);
    }
    read_bounded(MultiGzDecoder::new(bytes), most_unpacked(bytes.len()), "the gzip file").map(Some)
}

/// The first `most` unpacked bytes, as far as they can be unpacked.
pub(super) fn gunzip_prefix(bytes: &[u8], most: u64) -> Vec<u8> {
    let mut prefix = Vec::new();
    // A damaged stream is answered when the file is read; what came before the damage tells the format.
    let _ = MultiGzDecoder::new(bytes).take(most).read_to_end(&mut prefix);
    prefix
}

/// A zip archive in memory.
pub(super) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    left: u64,
}

impl<'a> Archive<'a> {
    /// Opens the archive.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Problem> {
        let zip = ZipArchive::new(Cursor::new(bytes))
            .map_err(|e| Problem::malformed("the zip archive", e, "a whole, undamaged archive"))?;
        Ok(Archive { zip, left: most_unpacked(bytes.len()) })
    }

    /// Names of the members, sorted as in the archive.
    pub(super) fn names(&self) -> Vec<String> {
        self.zip.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect()
    }

    /// Unpacks a member. All members together stay within the bound of the archive.
    pub(super) fn member(&mut self, name: &str) -> Result<Vec<u8>, Problem> {
        let broken = |e| Problem::malformed(format!("member {name:?} of the zip archive"), e, "readable");
        let file = self.zip.by_name(name).map_err(|e| broken(e.to_string()))?;
        let bytes = read_bounded(file, self.left, &format!("member {name:?}"))?;
        self.left -= bytes.len() as u64;
        Ok(bytes)
    }
}

/// Which format a zip archive is.
pub(super) fn zip_format(bytes: &[u8]) -> Option<Format> {
    let names = Archive::open(bytes).ok()?.names();
    if names.iter().any(|n| n == "main.xml") {
        Some(Format::X3p)
    } else {
        names.iter().any(|n| n.ends_with(".npy")).then_some(Format::Npz)
    }
}
