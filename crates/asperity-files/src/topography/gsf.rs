//! Gwyddion simple field (.gsf): a text header and binary32 numbers, an open format that is easy to write.
//!
//! After the line `Gwyddion Simple Field 1.0` follow lines `name = value`: `XRes` and `YRes` (points), `XReal` and `YReal`
//! (lengths), `XYUnits` and `ZUnits` (without prefix, as m), `Title`. One to four zero bytes fill the header up to a multiple
//! of four bytes; the numbers follow, little-endian, line by line from the top. (Gwyddion user guide, "Gwyddion Simple Field".)

use super::cursor::text;
use super::entries::Entries;
use super::finish::{Lateral, Measured, unit_of};
use super::grid::Layout;
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request, Result};

pub(super) const GSF: Reader = Reader::new("gsf", |bytes| bytes.starts_with(SIGNATURE), read);

const SIGNATURE: &[u8] = b"Gwyddion Simple Field 1.0\n";

fn read(bytes: &[u8], _: &Request) -> Result<Measured> {
    let end = memchr::memchr(0, bytes).ok_or_else(|| {
        Problem::malformed("the end of the GSF header", "missing", "1 to 4 zero bytes after the last entry")
    })?;
    let lines = bytes[..end].split(|byte| *byte == b'\n').map(text);
    let header = Entries::from_lines("the GSF header", lines);
    let points = [header.whole("XRes")?, header.whole("YRes")?];
    let data = bytes.get(end - end % 4 + 4..).unwrap_or_default();
    let layout = Layout::dense(points, Kind::F32, Order::Little);
    let heights = layout.map(data, "the numbers of the GSF file", |height| height)?;

    // A lone A is the ampere of Gwyddion's current channels.
    let unit = |key: &str| unit_of(header.get(key).unwrap_or_default(), LoneA::Ampere);
    let lateral = match (header.get("XReal"), header.get("YReal")) {
        (Some(_), Some(_)) => Lateral::of(
            [header.number("XReal")?, header.number("YReal")?],
            [unit("XYUnits"), unit("XYUnits")],
        ),
        _ => Lateral::Unstated(String::new()),
    };
    let title = header.get("Title").unwrap_or_default().to_owned();
    Ok(Measured::new(heights, unit("ZUnits"), lateral).of_channel(vec![title], 0).with(header))
}
