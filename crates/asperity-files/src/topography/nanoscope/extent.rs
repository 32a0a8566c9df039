//! Lengths of a Nanoscope image along x and y.
//!
//! `Scan Size: 10 10 ~m` of an image often repeats the width where the scan is not square; `Aspect Ratio` says so, as "2:1" (width to
//! height) or as a number. The whole scan of `Samps/line` nx and `Lines` ny then has square cells, and an image that was stopped before
//! all lines were recorded has as much of the height as it has of the lines:
//!
//! ```text
//! width X, height Y of the whole scan:  Y = `Slow Axis Size`, or X where the aspect ratio is 1:1, or X ny/nx
//! height of an image of n lines:        Y n/ny
//! ```
//!
//! A height that differs from the width is that of the image, or of the whole scan, as its ratio to the width says.

use super::super::Result;
use super::super::entries::Entries;
use super::super::finish::Lateral;
use super::super::unit::{LoneA, metres};
use super::Header;

/// Lengths are equal to this share: files round them to six digits.
const SAME: f64 = 1e-4;

impl Header {
    /// Lengths of an image of these points, of which its section states `stated`.
    pub(super) fn lateral(&self, image: &Entries, stated: [u64; 2], points: [u64; 2]) -> Result<Lateral> {
        let [mut x, mut y] = size(image, "Scan Size")?;
        let scan = self.scan_points();
        let square = self.is_square(image)?;
        // An image has fewer lines than the scan where that was stopped, or where every second one was kept: the aspect ratio tells.
        let recorded = match scan {
            Some([_, lines]) if !square && points[1] < lines => points[1] as f64 / lines as f64,
            _ => 1.0,
        };
        if let Some([width, height]) = self.slow_axis() {
            return Ok(Lateral::Metres([width, height * recorded]));
        }
        if points != stated {
            x *= points[0] as f64 / stated[0] as f64;
            y *= points[1] as f64 / stated[1] as f64;
            return Ok(Lateral::Metres([x, y]));
        }
        let [nx, ny] = scan.unwrap_or(points);
        let uncertain = || {
            let text = |list: Option<&str>| list.unwrap_or("missing").to_owned();
            Ok(Lateral::Unstated(format!(
                " that is certain: the scan size of the image is {:?}, its aspect ratio {:?} and that of the scan {:?}, and the scan has \
                 {nx} x {ny} points",
                text(image.get("Scan Size")),
                text(image.get("Aspect Ratio")),
                text(self.get("scan list", "Aspect Ratio")),
            )))
        };
        let of_scan = self.get("scan list", "Aspect Ratio").and_then(ratio);
        if square {
            let differs =
                of_scan.is_some_and(|ratio| !same(ratio, 1.0)) && same(x, y) && points[0] != points[1];
            return if differs { uncertain() } else { Ok(Lateral::Metres([x, y])) };
        }
        let whole = match of_scan {
            Some(ratio) if same(ratio, 1.0) => x,
            _ => x * ny as f64 / nx as f64,
        };
        let stands = !same(y, x) && (recorded == 1.0 || !same(y, whole));
        if stands {
            return Ok(Lateral::Metres([x, y]));
        }
        let height = whole * recorded;
        match self.agrees(image, height / x, [x, whole]) {
            true => Ok(Lateral::Metres([x, height])),
            false => uncertain(),
        }
    }

    /// Whether the aspect ratio of an image, or of its scan where the image has none, is 1:1.
    fn is_square(&self, image: &Entries) -> Result<bool> {
        let Some(text) = image.get("Aspect Ratio").or(self.get("scan list", "Aspect Ratio")) else {
            return Ok(true);
        };
        let ratio = ratio(text).ok_or_else(|| image.wrong("Aspect Ratio", "like \"2:1\" or \"0.5\""))?;
        Ok(same(ratio, 1.0))
    }

    /// Whether one of the aspect ratios is that of this image, or of the whole scan, in one of the two ways in which they are written; lines
    /// are whole, so that they round the ratio.
    fn agrees(&self, image: &Entries, found: f64, [width, whole]: [f64; 2]) -> bool {
        let lines = self.scan_points().map_or(1.0, |[nx, _]| 1.0 / nx as f64).min(0.1);
        let texts = [image.get("Aspect Ratio"), self.get("scan list", "Aspect Ratio")];
        let ratios = texts.into_iter().flatten().filter_map(ratio);
        let near = |a: f64, b: f64| (a - b).abs() <= lines + SAME * b;
        let mut wanted = ratios.flat_map(|ratio| [1.0 / ratio, ratio]);
        wanted.any(|ratio| near(found, ratio) || near(whole / width, ratio))
    }

    /// Lengths of the whole scan \[m\], where the slow axis has an entry of its own.
    fn slow_axis(&self) -> Option<[f64; 2]> {
        let list = self
            .sections
            .iter()
            .find(|s| s.title.ends_with("scan list") && s.get("slow axis size").is_some())?;
        let [width, _] = size(list, "Scan Size").ok()?;
        let [height, _] = size(list, "Slow Axis Size").ok()?;
        Some([width, height])
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * b.abs()
}

/// "500 500 nm", "10 10 ~m" or, for a square, "500 nm": both lengths \[m\].
fn size(section: &Entries, key: &str) -> Result<[f64; 2]> {
    let text = section.get(key).unwrap_or("missing");
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || matches!(c, ',' | 'x' | 'X'))
        .filter(|w| !w.is_empty())
        .collect();
    let number = |i: usize| words.get(i).and_then(|w| w.parse::<f64>().ok());
    let (x, y, label) = match (number(0), number(1)) {
        (Some(x), Some(y)) => (x, y, words.get(2)),
        (Some(x), None) => (x, x, words.get(1)),
        _ => return Err(section.wrong(key, "like \"500 500 nm\"")),
    };
    let unit = label.and_then(|l| metres(l, LoneA::Angstrom));
    let unit = unit.ok_or_else(|| section.wrong(key, "two lengths and a unit of length"))?;
    Ok([x * unit, y * unit])
}

/// Width over height of "2:1" or "0.5:1", or the number of an aspect ratio that is one; `None` where it is neither.
fn ratio(text: &str) -> Option<f64> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite() && *n > 0.0);
    match text.split_once([':', '/']) {
        Some((width, height)) => Some(number(width)? / number(height)?),
        None => number(text),
    }
}
