//! Zygo MetroPro (.dat), the files of Zygo's interferometers.
//!
//! A header of 834 or 4096 bytes, big-endian, then images of intensity (16 bits), then the phases (32 bits):
//!
//! ```text
//! height = n S O w / R,   S: scale factor, O: obliquity factor, w: wavelength, R: 4096, 32768 or 131072
//! ```
//!
//! Phases from 2147483640 on are undefined; a lateral resolution of 0 means that none was calibrated. (Zygo, "MetroPro
//! reference guide", OMP-0347, chapter 12.)

use super::cursor::Cursor;
use super::finish::{Lateral, Measured, Unit};
use super::grid::Layout;
use super::sample::{Kind, Order};
use super::{Problem, Reader, Request, Result};

pub(super) const METROPRO: Reader =
    Reader::new("metropro", |bytes| header_length(bytes).is_some(), read).also_called(&["dat"]);

/// Phases from this number on are undefined.
const UNDEFINED: f64 = 2_147_483_640.0;
/// Name of the only channel.
const NAME: &str = "Default";

/// Length of the header by the signature; `None` for another file.
fn header_length(bytes: &[u8]) -> Option<u32> {
    match bytes {
        [0x88, 0x1b, 0x03, 0x6f | 0x70, ..] => Some(834),
        [0x88, 0x1b, 0x03, 0x71, ..] => Some(4096),
        _ => None,
    }
}

/// Reads the phases.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    const H: &str = "the MetroPro header";
    let expected = header_length(bytes).ok_or_else(|| {
        Problem::malformed("the signature", "something else", "881b036f, 881b0370 or 881b0371")
    })?;
    let at = |offset: u64| Cursor::at(bytes, offset, Order::Big, H);
    let header = at(6)?.u32(H)?;
    if header != expected {
        let expected = format!("{expected} bytes");
        return Err(Problem::malformed("the length of the MetroPro header", header, expected));
    }
    let date = at(12)?.text(30, H)?;
    let intensities = at(60)?.u32(H)?;
    let mut c = at(68)?;
    let [nx, ny] = [u64::from(c.u16(H)?), u64::from(c.u16(H)?)];
    let phases = c.u32(H)?;
    if nx == 0 || ny == 0 || phases == 0 {
        return Err(request.no_heights("no phases, only images of intensity"));
    }
    if u64::from(phases) != 4 * nx * ny {
        let expected = format!("{} bytes for {nx} x {ny} points", 4 * nx * ny);
        return Err(Problem::malformed("the length of the phases", phases, expected));
    }
    let comment = at(80)?.text(82, H)?;
    let mut c = at(164)?;
    let [scale, wavelength, _aperture, obliquity, _magnification, pixel] =
        [c.f32(H)?, c.f32(H)?, c.f32(H)?, c.f32(H)?, c.f32(H)?, c.f32(H)?].map(f64::from);
    let resolution = match at(218)?.u16(H)? {
        0 => 4096.0,
        1 => 32768.0,
        2 => 131_072.0,
        other => return Err(Problem::malformed("the phase resolution", other, "0, 1 or 2")),
    };
    let sign = if at(232)?.u16(H)? == 0 { 1.0 } else { -1.0 };
    let [objective, part] = [at(246)?.text(12, H)?, at(258)?.text(40, H)?];
    let unit = sign * scale * obliquity * wavelength / resolution;
    if !(unit.is_finite() && unit != 0.0) {
        let value = format!("{scale} x {obliquity} x {wavelength} m");
        return Err(Problem::malformed("the scale of the phases", value, "a length that is not 0"));
    }

    let what = "the phases of the MetroPro file";
    let data = at(u64::from(header) + u64::from(intensities))?.rest();
    let height = |n: f64| if n >= UNDEFINED { f64::NAN } else { n * unit };
    let heights = Layout::dense([nx, ny], Kind::I32, Order::Big).map(data, what, height)?;
    let lateral = match pixel > 0.0 {
        true => Lateral::Metres([nx as f64 * pixel, ny as f64 * pixel]),
        false => Lateral::Unstated(" (its lateral resolution was not calibrated)".into()),
    };
    let metadata = [("Date", date), ("Comment", comment), ("Objective", objective), ("Part", part)];
    let measured = Measured::new(heights, Unit::Metres(1.0), lateral).of_channel(vec![NAME.into()], 0);
    Ok(measured.with(metadata))
}
