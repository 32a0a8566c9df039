//! NPZ: the arrays `heights` (nx, ny), `size` (Lx, Ly), the text `unit` = "m" of both, and the text `history` where
//! there is one, for `numpy.load`.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::topography::{Problem, Topography};

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>, Problem> {
    let (nx, ny) = topography.heights.dim();
    let heights: Vec<u8> = topography.heights.iter().flat_map(|h| h.to_le_bytes()).collect();
    let size: Vec<u8> = topography.size.iter().flat_map(|l| l.to_le_bytes()).collect();
    let unit = u32::from('m').to_le_bytes();
    let mut zip = ZipWriter::new(Cursor::new(Vec::with_capacity(heights.len() + 1024)));
    // Measured heights hardly shrink: stored, as `numpy.savez` does.
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let failed = |e: zip::result::ZipError| Problem::Io(std::io::Error::other(e));
    let text = |text: &str| text.chars().flat_map(|c| u32::from(c).to_le_bytes()).collect::<Vec<u8>>();
    let history = topography.history_line().map(|line| (format!("<U{}", line.chars().count()), text(&line)));
    let mut members: Vec<(&str, &str, String, &[u8])> = vec![
        ("heights.npy", "<f8", format!("({nx}, {ny})"), &heights),
        ("size.npy", "<f8", "(2,)".to_owned(), &size),
        ("unit.npy", "<U1", "()".to_owned(), &unit),
    ];
    if let Some((descr, line)) = &history {
        members.push(("history.npy", descr, "()".to_owned(), line));
    }
    for (name, descr, shape, data) in members {
        zip.start_file(name, stored.large_file(data.len() > 1 << 31)).map_err(failed)?;
        zip.write_all(&header(descr, &shape))?;
        zip.write_all(data)?;
    }
    Ok(zip.finish().map_err(failed)?.into_inner())
}

/// NPY header, version 1.0, padded so that the data start at a multiple of 64 bytes.
fn header(descr: &str, shape: &str) -> Vec<u8> {
    const PREFIX: usize = 10;
    let mut dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (PREFIX + dictionary.len() + 1).next_multiple_of(64) - PREFIX;
    dictionary.push_str(&" ".repeat(length - 1 - dictionary.len()));
    dictionary.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    // The dictionary has some 100 bytes.
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(dictionary.bytes());
    bytes
}
