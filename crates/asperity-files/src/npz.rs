//! Numpy's `.npz`: a zip of `.npy` files, stored as they are: numbers hardly shrink.

use std::io::{Result, Seek, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Writes one array after the other.
pub struct Npz<W: Write + Seek>(ZipWriter<W>);

impl<W: Write + Seek> Npz<W> {
    /// An archive without arrays yet.
    pub fn new(file: W) -> Self {
        Npz(ZipWriter::new(file))
    }

    /// Starts an array of this type ("<f8") and shape; its bytes follow.
    pub fn begin(&mut self, name: &str, kind: &str, shape: &[usize]) -> Result<()> {
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
        self.0.start_file(format!("{name}.npy"), options)?;
        let lengths: String = shape.iter().map(|n| format!("{n},")).collect();
        // Version 1.0: the numbers start at a multiple of 64 bytes.
        let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({lengths}), }}");
        let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
        header.push_str(&" ".repeat(length - 1 - header.len()));
        header.push('\n');
        self.put(b"\x93NUMPY\x01\x00")?;
        self.put(&(length as u16).to_le_bytes())?;
        self.put(header.as_bytes())
    }

    /// The next bytes of the array.
    pub fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.0.write_all(bytes)
    }

    /// The next numbers of the array.
    pub fn put_reals(&mut self, reals: impl IntoIterator<Item = f64>) -> Result<()> {
        const PART: usize = 1 << 18;
        let mut bytes = Vec::with_capacity(PART);
        for real in reals {
            bytes.extend(real.to_le_bytes());
            if bytes.len() >= PART {
                self.put(&bytes)?;
                bytes.clear();
            }
        }
        self.put(&bytes)
    }

    /// An array of numbers.
    pub fn reals<'a>(
        &mut self,
        name: &str,
        shape: &[usize],
        reals: impl IntoIterator<Item = &'a f64>,
    ) -> Result<()> {
        self.begin(name, "<f8", shape)?;
        self.put_reals(reals.into_iter().copied())
    }

    /// A single text: four bytes per character.
    pub fn text(&mut self, name: &str, text: &str) -> Result<()> {
        self.begin(name, &format!("<U{}", text.chars().count()), &[])?;
        let bytes: Vec<u8> = text.chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
        self.put(&bytes)
    }

    /// Ends the file.
    pub fn finish(self) -> Result<W> {
        Ok(self.0.finish()?)
    }

    /// Leaves the file as it is: dropped, the archive would try to write again and print that it cannot.
    pub fn abandon(self) {
        std::mem::forget(self.0);
    }
}
