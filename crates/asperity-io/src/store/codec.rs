//! The bytes of a chunk, by the codecs of Zarr that a result uses: `bytes` (little-endian), `gzip` and `crc32c`.

use std::io::{Read, Write};

use flate2::read::GzDecoder;
use flate2::write::GzEncoder;

use super::layout::{ArraySpec, LEVEL, Storage};

/// A number of a map.
pub(crate) trait Number: Copy + Default + PartialEq + Send + Sync {
    /// The bytes of numbers, one after the other.
    fn to_bytes(numbers: &[Self]) -> Vec<u8>;
    /// The inverse of [`to_bytes`](Self::to_bytes).
    fn from_bytes(bytes: &[u8]) -> Vec<Self>;
}

macro_rules! number {
    ($($number:ty)*) => { $(
        impl Number for $number {
            fn to_bytes(numbers: &[Self]) -> Vec<u8> {
                numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
            }

            fn from_bytes(bytes: &[u8]) -> Vec<Self> {
                bytes.as_chunks().0.iter().map(|bytes| <$number>::from_le_bytes(*bytes)).collect()
            }
        }
    )* };
}

number!(f64 u8);

/// How the chunks of an array are encoded.
pub(super) struct Codec {
    /// Bytes of the numbers of a chunk.
    length: usize,
    compressed: bool,
    summed: bool,
}

impl Codec {
    pub(super) fn of(spec: &ArraySpec) -> Codec {
        let length = spec.chunk().iter().product::<usize>() * spec.data_type.width();
        Codec { length, compressed: spec.storage == Storage::Maps, summed: spec.summed }
    }

    /// The file of a chunk is no longer than this \[bytes\].
    pub(super) fn longest(&self) -> u64 {
        (self.length + self.length / 4 + 1024) as u64
    }

    /// The file of a chunk of a map with these numbers.
    pub(super) fn encode<T: Number>(&self, numbers: &[T]) -> std::io::Result<Vec<u8>> {
        // Numbers that differ from cell to cell do not deflate: they are only wrapped, which is thirty times as fast.
        // Repeated ones (no pressure, pressure at the hardness, no contact) do.
        let repeated = numbers.windows(2).filter(|pair| pair[0] == pair[1]).count();
        let level = if repeated >= numbers.len() / 8 { LEVEL } else { 0 };
        self.encode_bytes(T::to_bytes(numbers), level)
    }

    /// The file of a chunk with the bytes of its numbers, deflated with `level` where the array is compressed.
    pub(super) fn encode_bytes(&self, mut bytes: Vec<u8>, level: u8) -> std::io::Result<Vec<u8>> {
        if self.compressed {
            let mut gzip = GzEncoder::new(Vec::new(), flate2::Compression::new(level.into()));
            gzip.write_all(&bytes)?;
            bytes = gzip.finish()?;
        }
        if self.summed {
            bytes.extend(crc32c::crc32c(&bytes).to_le_bytes());
        }
        Ok(bytes)
    }

    /// The bytes of the numbers in the file of a chunk. No more memory is allocated than its numbers need.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub(super) fn decode(&self, mut bytes: Vec<u8>) -> Result<Vec<u8>, String> {
        if self.summed {
            let sum = bytes.split_last_chunk().map(|(_, sum)| u32::from_le_bytes(*sum));
            bytes.truncate(bytes.len().saturating_sub(4));
            if sum != Some(crc32c::crc32c(&bytes)) {
                return Err("its checksum is wrong".into());
            }
        }
        if self.compressed {
            let mut plain = Vec::with_capacity(self.length);
            let unpacked = GzDecoder::new(&bytes[..]).take(self.length as u64 + 1).read_to_end(&mut plain);
            unpacked.map_err(|error| error.to_string())?;
            bytes = plain;
        }
        if bytes.len() != self.length {
            let more = if bytes.len() > self.length { "more" } else { "fewer" };
            return Err(format!("it holds {more} than the {} bytes of its numbers", self.length));
        }
        Ok(bytes)
    }
}
