//! Alicona Imaging AL3D, the files of focus-variation microscopes.
//!
//! A list of tags (20 bytes key, 30 bytes value, CR LF) gives the number of columns and rows, the pixel sizes and
//! where the depth image is: binary32 in metres, lines padded to a multiple of 8 bytes. Undefined points have the
//! tagged value (3e15) or more. (AL3D File Format Specification, version 1.0, 2005.)

use super::cursor::Cursor;
use super::entries::Entries;
use super::finish::{Lateral, Measured, Unit};
use super::grid::Layout;
use super::sample::{Kind, Order};
use super::{Problem, Reader, Request, Result};

const SIGNATURE: &[u8] = b"AliconaImaging\0\r\n";

pub(super) const AL3D: Reader = Reader::new("al3d", |bytes| bytes.starts_with(SIGNATURE), read);

/// Reads the depth image.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let mut cursor = Cursor::new(bytes, Order::Little);
    cursor.bytes(SIGNATURE.len() as u64, "the signature")?;
    let mut tags = Entries::new("the AL3D tags");
    read_tag(&mut cursor, &mut tags)?;
    read_tag(&mut cursor, &mut tags)?;
    for _ in 0..tags.whole("TagCount")? {
        read_tag(&mut cursor, &mut tags)?;
    }
    let comment = cursor.text(256, "the comment")?;

    let [nx, ny] = [tags.whole("Cols")?, tags.whole("Rows")?];
    let pixel = [tags.number("PixelSizeXMeter")?, tags.number("PixelSizeYMeter")?];
    let offset = tags.whole("DepthImageOffset")?;
    if offset == 0 {
        return Err(request.no_heights("it has no depth image"));
    }
    let image = Cursor::at(bytes, offset, Order::Little, "the depth image")?.rest();
    // The tag is written with fewer digits than the binary32 values have.
    let invalid = tags.number("InvalidPixelValue").unwrap_or(f64::NAN);
    let tolerance = 1.5e-7 * invalid.abs();
    let height = |v: f64| {
        let undefined = (v - invalid).abs() <= tolerance || (invalid > 0.0 && v > invalid);
        if undefined { f64::NAN } else { v }
    };
    let stride = nx.saturating_mul(4).checked_next_multiple_of(8).unwrap_or(u64::MAX);
    let layout = Layout { stride, ..Layout::dense([nx, ny], Kind::F32, Order::Little) };
    let heights = layout.map(image, "the depth image", height)?;
    let lateral = Lateral::Metres([nx as f64 * pixel[0].abs(), ny as f64 * pixel[1].abs()]);
    let tags = tags.into_iter().filter(|(key, _)| key != "TagCount");
    Ok(Measured::new(heights, Unit::Metres(1.0), lateral).with(tags).with([("Comment", comment)]))
}

fn read_tag(cursor: &mut Cursor, tags: &mut Entries) -> Result<()> {
    let (key, value) = (cursor.text(20, "a tag")?, cursor.text(30, "a tag")?);
    let end = cursor.bytes(2, "a tag")?;
    if end != b"\r\n" {
        return Err(Problem::malformed(format!("the end of the tag {key:?}"), format!("{end:?}"), "CR LF"));
    }
    tags.push(&key, &value);
    Ok(())
}
