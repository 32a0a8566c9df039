//! Alicona Imaging AL3D, the files of focus-variation microscopes.
//!
//! A list of tags (20 bytes key, 30 bytes value, CR LF) gives the number of columns and rows, the pixel sizes and
//! where the depth image is: binary32 in metres, lines padded to a multiple of 8 bytes. Undefined points have the
//! tagged value (3e15) or more. (AL3D File Format Specification, version 1.0, 2005.)

use super::Problem;
use super::cursor::Cursor;
use super::finish::{Lateral, Measured, Unit};
use super::grid::Layout;
use super::sample::{Kind, Order};

const SIGNATURE: &[u8] = b"AliconaImaging\0\r\n";

/// Whether the bytes are an AL3D file.
pub(super) fn is_al3d(bytes: &[u8]) -> bool {
    bytes.starts_with(SIGNATURE)
}

/// Reads the depth image.
pub(super) fn read_al3d(bytes: &[u8]) -> Result<Measured, Problem> {
    let mut cursor = Cursor::new(bytes, Order::Little);
    cursor.bytes(SIGNATURE.len() as u64, "the signature")?;
    let mut tags = vec![tag(&mut cursor)?, tag(&mut cursor)?];
    let count: u32 = number(&tags, "TagCount")?;
    for _ in 0..count {
        tags.push(tag(&mut cursor)?);
    }
    let comment = cursor.text(256, "the comment")?;

    let [nx, ny] = [number::<u64>(&tags, "Cols")?, number(&tags, "Rows")?];
    let pixel = [number::<f64>(&tags, "PixelSizeXMeter")?, number(&tags, "PixelSizeYMeter")?];
    let offset: u64 = number(&tags, "DepthImageOffset")?;
    if offset == 0 {
        let detail = "it has no depth image".to_owned();
        return Err(Problem::NoHeights { format: super::Format::Al3d, detail });
    }
    let image = Cursor::at(bytes, offset, Order::Little, "the depth image")?.rest();
    // The tag is written with fewer digits than the binary32 values have.
    let invalid: f64 = number(&tags, "InvalidPixelValue").unwrap_or(f64::NAN);
    let tolerance = 1.5e-7 * invalid.abs();
    let height = |v: f64| {
        let undefined = (v - invalid).abs() <= tolerance || (invalid > 0.0 && v > invalid);
        if undefined { f64::NAN } else { v }
    };
    let stride = nx.saturating_mul(4).checked_next_multiple_of(8).unwrap_or(u64::MAX);
    let layout = Layout { points: [nx, ny], kind: Kind::F32, order: Order::Little, stride };
    let heights = layout.map(image, "the depth image", height)?;
    let mut metadata: Vec<_> = tags.into_iter().filter(|(key, _)| key != "TagCount").collect();
    if !comment.is_empty() {
        metadata.push(("Comment".to_owned(), comment));
    }
    Ok(Measured {
        heights,
        unit: Unit::Metres(1.0),
        lateral: Lateral::Metres([nx as f64 * pixel[0].abs(), ny as f64 * pixel[1].abs()]),
        channel: None,
        channels: Vec::new(),
        metadata,
    })
}

fn tag(cursor: &mut Cursor) -> Result<(String, String), Problem> {
    let (key, value) = (cursor.text(20, "a tag")?, cursor.text(30, "a tag")?);
    let end = cursor.bytes(2, "a tag")?;
    if end != b"\r\n" {
        return Err(Problem::malformed(format!("the end of the tag {key:?}"), format!("{end:?}"), "CR LF"));
    }
    Ok((key, value))
}

fn number<T: std::str::FromStr>(tags: &[(String, String)], key: &str) -> Result<T, Problem> {
    let value = tags.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str());
    let value = value.ok_or_else(|| Problem::malformed(format!("the tag {key}"), "missing", "present"))?;
    value.parse().map_err(|_| Problem::malformed(format!("the tag {key}"), value, "a number"))
}
