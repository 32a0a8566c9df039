//! The names of curves: in a corner of the frame that no curve crosses, else above the frame.

use super::SMALL;
use super::curves::{Curves, Layout};
use super::drawing::{Anchor, Drawing, Paint};
use super::font;
use super::series::{Series, Style, pen, sign};
use super::words;

/// Room of the sign before a name \[points\].
const SIGN: f64 = 26.0;
/// Distance of the legend to the frame, and at least to the curves \[points\]: more than half of a line or of a sign.
const GAP: f64 = 4.0;

/// The series that have a name, with their colours.
pub(super) struct Legend<'a> {
    named: Vec<(&'a Series, &'a str)>,
}

impl<'a> Legend<'a> {
    /// Height of a row \[points\].
    const ROW: f64 = SMALL + 3.5;

    pub(super) fn of(panel: &'a Curves) -> Self {
        Legend { named: panel.coloured().filter(|(series, _)| !series.name.is_empty()).collect() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.named.is_empty()
    }

    /// Width of the longest name with its sign \[points\].
    pub(super) fn width(&self) -> f64 {
        self.named.iter().map(|(series, _)| wide(&series.name)).fold(0.0, f64::max)
    }

    /// Width and height as a column of names.
    pub(super) fn size(&self) -> [f64; 2] {
        let text = self.named.iter().map(|(s, _)| font::width(&s.name, SMALL)).fold(0.0, f64::max);
        [text + SIGN + 4.0, Self::ROW * self.named.len() as f64 + 5.0]
    }

    /// The upper left point of the first corner in which the names hide no curve.
    pub(super) fn corner(&self, panel: &Curves, layout: &Layout) -> Option<[f64; 2]> {
        let [left, top, right, bottom] = layout.area;
        let [width, height] = self.size();
        let corners = [
            [right - width - GAP, top + GAP],
            [left + GAP, top + GAP],
            [right - width - GAP, bottom - height - GAP],
            [left + GAP, bottom - height - GAP],
        ];
        let free = |[x, y]: &[f64; 2]| {
            let beside = |at: f64, from: f64, length: f64| at > from - GAP && at < from + length + GAP;
            let under = |p: [f64; 2]| beside(p[0], *x, width) && beside(p[1], *y, height);
            *x > left
                && x + width < right
                && *y > top
                && !panel.series.iter().any(|series| covers(series, layout, &under))
        };
        corners.into_iter().find(free)
    }

    /// Height of the names above a frame of this width \[points\].
    pub(super) fn height_above(&self, width: f64) -> f64 {
        if self.is_empty() { 0.0 } else { Self::ROW * self.rows(width).len() as f64 + 3.0 }
    }

    /// The names in rows of this width.
    fn rows(&self, width: f64) -> Vec<Vec<(&'a Series, &'a str)>> {
        let mut rows: Vec<Vec<_>> = vec![];
        let mut used = f64::INFINITY;
        for entry in &self.named {
            let own = wide(&entry.0.name);
            if used + own > width {
                rows.push(vec![]);
                used = 0.0;
            }
            used += own;
            if let Some(row) = rows.last_mut() {
                row.push(*entry);
            }
        }
        rows
    }

    pub(super) fn draw_inside(&self, drawing: &mut Drawing, [x, y]: [f64; 2]) {
        drawing.rounded([x, y], self.size(), 2.0, Paint::fill("#fff", 0.85));
        for (n, entry) in self.named.iter().enumerate() {
            draw(drawing, *entry, [x, y + Self::ROW * (n as f64 + 0.5) + 2.5], f64::INFINITY);
        }
    }

    /// Above a frame with this upper left corner and right side; a row that is longer begins before it, at `edge` at the earliest.
    pub(super) fn draw_above(&self, drawing: &mut Drawing, [left, top]: [f64; 2], right: f64, edge: f64) {
        let rows = self.rows(right - left);
        let first = top - 3.0 - Self::ROW * rows.len() as f64;
        for (n, row) in rows.iter().enumerate() {
            let whole: f64 = row.iter().map(|(series, _)| wide(&series.name)).sum();
            let mut x = (left - 5.0).min(right - whole).max(edge);
            for entry in row {
                draw(drawing, *entry, [x, first + Self::ROW * (n as f64 + 0.5)], right);
                x += wide(&entry.0.name);
            }
        }
    }
}

/// Width of a name with its sign \[points\].
fn wide(name: &str) -> f64 {
    SIGN + font::width(name, SMALL) + 3.0
}

/// Whether any of a series lies `under` something; of a line also between its points, of a bar all of it.
fn covers(series: &Series, layout: &Layout, under: &impl Fn([f64; 2]) -> bool) -> bool {
    let places: Vec<[f64; 2]> = series.points().filter_map(|point| layout.at(point)).collect();
    let between = |from: [f64; 2], to: [f64; 2]| {
        let parts = (f64::hypot(to[0] - from[0], to[1] - from[1]) / GAP).ceil().max(1.0);
        (0..=parts as usize).any(|k| under([0, 1].map(|i| from[i] + (to[i] - from[i]) * k as f64 / parts)))
    };
    match series.style {
        Style::Bars => places.iter().any(|place| between(*place, [place[0], layout.area[3]])),
        style if style.is_of_points() => places.iter().any(|place| under(*place)),
        _ => places.windows(2).any(|pair| between(pair[0], pair[1])),
    }
}

/// The sign of a series and its name, from `x` to `right` at most, in the `middle` of the row.
fn draw(drawing: &mut Drawing, (series, colour): (&Series, &str), [x, middle]: [f64; 2], right: f64) {
    match series.style {
        Style::Bars => {
            drawing.rect([x + 7.0, middle - 3.5], [12.0, 7.0], Paint::fill(colour, 0.55));
        }
        style if style.is_of_points() => sign(drawing, style, [x + 13.0, middle], colour),
        style => {
            drawing.line([x + 5.0, middle], [x + 21.0, middle], pen(style, colour, 0.0));
        }
    }
    let name = words::shortened(&series.name, SMALL, right + 4.0 - x - SIGN);
    drawing.text([x + SIGN, middle + 0.36 * SMALL], SMALL, Anchor::Start, &name);
}
