//! The typeface of the figures: DejaVu Sans, a part of it shipped with the crate, so that a figure looks the same on every
//! machine. Widths and outlines are read from the file's tables, by the OpenType specification (cmap of format 4, hmtx, loca,
//! glyf): the file is ours and fixed, and needs neither hinting nor shaping.

use std::sync::OnceLock;

use tiny_skia::PathBuilder;

/// Latin, Greek and the signs of mathematics.
pub(super) static DATA: &[u8] = include_bytes!("../../fonts/DejaVuSans.ttf");

/// Families in the order in which a viewer of the SVG tries them.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// Units of the design to an em.
pub(super) const EM: f64 = 2048.0;
/// The glyph in place of a sign that the typeface lacks. It has a width and no outline; [`BOX`] is drawn for it.
pub(super) const LACKING: u16 = 0;
/// Left, top, right and bottom of the box for a sign that the typeface lacks \[em\], y downwards from the line.
pub(super) const BOX: [f64; 4] = [0.07, -0.7, 0.53, 0.0];
/// Width of a glyph that the file does not tell \[em\].
const MISSING: f64 = 0.6;
/// Parts of a glyph are glyphs themselves, of one level in this typeface.
const DEEPEST: usize = 4;

/// Width of a text \[points\] at a size \[points\].
pub(super) fn width(text: &str, size: f64) -> f64 {
    size * letters(text).map(|(_, advance)| advance).sum::<f64>()
}

/// The glyphs of a text, with a box for a sign that the typeface lacks, and their widths \[em\].
pub(super) fn letters(text: &str) -> impl Iterator<Item = (u16, f64)> + '_ {
    text.chars().map(|c| glyph(c).unwrap_or(LACKING)).map(|glyph| (glyph, advance(glyph)))
}

/// The glyph of a sign; `None` where the typeface lacks it.
pub(super) fn glyph(c: char) -> Option<u16> {
    let font = tables()?;
    let code = u16::try_from(u32::from(c)).ok()?;
    // Segments of codes: the last code of each, a pad, the first codes, offsets, and places in a list of glyphs.
    let table = font.cmap;
    let segments = usize::from(u16_at(table, 6)?) / 2;
    let column = |n: usize, segment: usize| 14 + 2 * (n * segments + segment) + if n > 0 { 2 } else { 0 };
    let segment = (0..segments).find(|s| u16_at(table, column(0, *s)).is_some_and(|last| code <= last))?;
    let first = u16_at(table, column(1, segment))?;
    if code < first {
        return None;
    }
    let delta = u16_at(table, column(2, segment))?;
    let place = column(3, segment);
    let found = match u16_at(table, place)? {
        0 => code.wrapping_add(delta),
        offset => match u16_at(table, place + usize::from(offset) + 2 * usize::from(code - first))? {
            0 => 0,
            listed => listed.wrapping_add(delta),
        },
    };
    (found > 0).then_some(found)
}

/// Width of a glyph \[em\].
pub(super) fn advance(glyph: u16) -> f64 {
    let units = tables().and_then(|font| u16_at(font.hmtx, 4 * usize::from(glyph)));
    units.map_or(MISSING, |units| f64::from(units) / EM)
}

/// Adds the closed outlines of a glyph to a path; `to` places points in units of the design, y upwards, on the paper.
pub(super) fn outline(path: &mut PathBuilder, glyph: u16, to: &impl Fn([f64; 2]) -> [f32; 2]) {
    // A typeface whose tables cannot be read has no outlines; the tests read all of ours.
    let _ = add(path, glyph, to, DEEPEST);
}

fn add(path: &mut PathBuilder, glyph: u16, to: &dyn Fn([f64; 2]) -> [f32; 2], depth: usize) -> Option<()> {
    let data = description(glyph)?;
    if data.is_empty() {
        return Some(());
    }
    let contours = i16_at(data, 0)?;
    if contours >= 0 {
        return simple(path, data, usize::from(contours.unsigned_abs()), to);
    }
    // Parts with an offset each.
    let (mut place, words, more) = (10, 1, 32);
    if depth == 0 {
        return Some(());
    }
    loop {
        let flags = u16_at(data, place)?;
        let part = u16_at(data, place + 2)?;
        let offset = match flags & words {
            0 => [0, 1].map(|i| data.get(place + 4 + i).map(|byte| f64::from(*byte as i8))),
            _ => [0, 1].map(|i| i16_at(data, place + 4 + 2 * i).map(f64::from)),
        };
        let [right, up] = [offset[0]?, offset[1]?];
        add(path, part, &|[x, y]| to([x + right, y + up]), depth - 1)?;
        if flags & more == 0 {
            return Some(());
        }
        place += if flags & words == 0 { 6 } else { 8 };
    }
}

/// Contours of points on and off the curve: last points, instructions, flags with repeats, then x and y as differences.
fn simple(
    path: &mut PathBuilder,
    data: &[u8],
    contours: usize,
    to: &dyn Fn([f64; 2]) -> [f32; 2],
) -> Option<()> {
    let lasts =
        (0..contours).map(|n| u16_at(data, 10 + 2 * n).map(usize::from)).collect::<Option<Vec<_>>>()?;
    let count = lasts.last()? + 1;
    let mut place = 10 + 2 * contours;
    place += 2 + usize::from(u16_at(data, place)?);
    let mut flags = Vec::with_capacity(count);
    while flags.len() < count {
        let flag = *data.get(place)?;
        let repeats = if flag & 8 == 0 { 0 } else { usize::from(*data.get(place + 1)?) };
        flags.extend(std::iter::repeat_n(flag, 1 + repeats));
        place += if flag & 8 == 0 { 1 } else { 2 };
    }
    let mut points = vec![[0.0; 2]; count];
    for axis in [0, 1] {
        let (short, same) = (2u8 << axis, 16u8 << axis);
        let mut value = 0.0;
        for (point, flag) in points.iter_mut().zip(&flags) {
            if flag & short != 0 {
                let step = f64::from(*data.get(place)?);
                value += if flag & same == 0 { -step } else { step };
                place += 1;
            } else if flag & same == 0 {
                value += f64::from(i16_at(data, place)?);
                place += 2;
            }
            point[axis] = value;
        }
    }
    let mut first = 0;
    for last in lasts {
        let on: Vec<bool> = flags.get(first..=last)?.iter().map(|flag| flag & 1 == 1).collect();
        contour(path, points.get(first..=last)?, &on, to);
        first = last + 1;
    }
    Some(())
}

/// Between two points off the curve lies one on it, in the middle.
fn contour(path: &mut PathBuilder, points: &[[f64; 2]], on: &[bool], to: &dyn Fn([f64; 2]) -> [f32; 2]) {
    let n = points.len();
    let middle = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|i| 0.5 * (a[i] + b[i]));
    let curve = |path: &mut PathBuilder, control: [f64; 2], end: [f64; 2]| {
        let ([x1, y1], [x, y]) = (to(control), to(end));
        path.quad_to(x1, y1, x, y);
    };
    let start = on.iter().position(|on| *on);
    let begin = start.map_or_else(|| middle(points[n - 1], points[0]), |start| points[start]);
    let from = start.map_or(0, |start| start + 1);
    let [x, y] = to(begin);
    path.move_to(x, y);
    let mut control = None;
    for k in (from..n).chain(0..from) {
        match (control, on[k]) {
            (None, true) => {
                let [x, y] = to(points[k]);
                path.line_to(x, y);
            }
            (Some(c), true) => curve(path, c, points[k]),
            (Some(c), false) => curve(path, c, middle(c, points[k])),
            (None, false) => {}
        }
        control = (!on[k]).then_some(points[k]);
    }
    if let Some(c) = control {
        curve(path, c, begin);
    }
    path.close();
}

/// The tables of the file that are read.
struct Tables {
    cmap: &'static [u8],
    hmtx: &'static [u8],
    loca: &'static [u8],
    glyf: &'static [u8],
}

fn tables() -> Option<&'static Tables> {
    static TABLES: OnceLock<Option<Tables>> = OnceLock::new();
    TABLES.get_or_init(read).as_ref()
}

fn read() -> Option<Tables> {
    let count = usize::from(u16_at(DATA, 4)?);
    let table = |name: &[u8; 4]| {
        let entry = (0..count).map(|n| 12 + 16 * n).find(|at| DATA.get(*at..at + 4) == Some(name))?;
        let start = u32_at(DATA, entry + 8)?;
        DATA.get(start..start + u32_at(DATA, entry + 12)?)
    };
    let cmap = table(b"cmap")?;
    // The first encoding in format 4.
    let encodings = usize::from(u16_at(cmap, 2)?);
    let starts = (0..encodings).filter_map(|n| u32_at(cmap, 8 + 8 * n));
    let cmap = starts.filter_map(|start| cmap.get(start..)).find(|table| u16_at(table, 0) == Some(4))?;
    Some(Tables { cmap, hmtx: table(b"hmtx")?, loca: table(b"loca")?, glyf: table(b"glyf")? })
}

/// The description of a glyph; its places are stored halved.
fn description(glyph: u16) -> Option<&'static [u8]> {
    let font = tables()?;
    let place = |n: usize| u16_at(font.loca, 2 * n).map(|half| 2 * usize::from(half));
    font.glyf.get(place(usize::from(glyph))?..place(usize::from(glyph) + 1)?)
}

fn u16_at(data: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(data.get(at..at + 2)?.try_into().ok()?))
}

fn i16_at(data: &[u8], at: usize) -> Option<i16> {
    u16_at(data, at).map(|value| value as i16)
}

fn u32_at(data: &[u8], at: usize) -> Option<usize> {
    Some(u32::from_be_bytes(data.get(at..at + 4)?.try_into().ok()?) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_typeface_has_every_sign_that_figures_use() {
        for c in "AZaz09 αβδεηλμνρστφωΔΓΩµ°²³⁴⁻⁰¹⁹×·−±≤≥≈∞√∂∫→–—'”/%[]()éüñčß".chars()
        {
            assert!(glyph(c).is_some(), "{c}");
        }
        assert_eq!(glyph('漢'), None);
        assert_eq!(glyph('😀'), None);
        // The box lies inside of the width that it is given.
        let mut path = PathBuilder::new();
        outline(&mut path, LACKING, &|_| [0.0; 2]);
        assert!(path.is_empty() && advance(LACKING) > BOX[2]);
    }

    #[test]
    fn a_text_is_as_wide_as_its_letters() {
        // The width of a digit of this typeface is 1303 / 2048 of the size.
        assert!((width("0123", 10.0) - 40.0 * 1303.0 / 2048.0).abs() < 1e-9);
    }

    #[test]
    fn outlines_fill_the_boxes_that_the_file_gives() {
        let mut drawn = 0;
        for glyph in 0..701 {
            let data = description(glyph).unwrap();
            let mut path = PathBuilder::new();
            outline(&mut path, glyph, &|point| point.map(|v| v as f32));
            // The bounds are those of all points, as in the file; control points of round letters lie on its box too.
            let path = path.finish();
            let found = path.map(|path| path.bounds());
            let found = found.map(|b| [b.left(), b.top(), b.right(), b.bottom()].map(f64::from));
            let found = found.unwrap_or_default();
            if !data.is_empty() {
                let told = [2, 4, 6, 8].map(|at| f64::from(i16_at(data, at).unwrap()));
                // Boxes of composed glyphs are off by up to two units of the design, a thousandth of an em.
                let off = found.iter().zip(told).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off <= 2.0, "glyph {glyph}: {found:?}, told {told:?}");
                drawn += 1;
            }
        }
        assert!(drawn > 650, "{drawn}");
    }
}
