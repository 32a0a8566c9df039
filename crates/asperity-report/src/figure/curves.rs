//! A panel of curves over two axes.

use asperity_io::readable::Shown;

use super::axis::{Axis, Ruler, Scale};
use super::colours::{Colours, Palette};
use super::drawing::{Anchor, Drawing, GRID, INK, Paint, Pen};
use super::font;
use super::legend::Legend;
use super::scale::{Bar, ColourScale};
use super::series::{Series, Style, dots, sign, spacing};
use super::{EDGE, Margins, Place, SMALL, TEXT};

/// Colours that people with any kind of colour vision tell apart (Okabe & Ito 2008), dark ones first.
pub(crate) const COLOURS: [&str; 7] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#222222"];

/// Room between the data and the frame, as shares of what the axes x and y show: no curve and no sign of a point lies on the frame.
const ROOM: [f64; 2] = [0.03, 0.06];

/// A panel of curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// A short title over the panel; may be empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the first below the others.
    pub series: Vec<Series>,
    /// The horizontal axis in another unit too, above the frame.
    pub beside: Option<Beside>,
    /// What the colours of the points stand for, as a colour bar.
    pub key: Option<Key>,
    /// Why there is nothing to draw, for axes that are empty.
    pub empty: String,
    /// Whether the names stand above the frame, also where a corner inside is free.
    pub names_above: bool,
}

/// Another unit of a horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The unit, `Hz`.
    pub unit: String,
    /// So many of it are one of the axis's own unit.
    pub factor: f64,
}

/// What colours of points stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// The quantity, `temperature`.
    pub label: String,
    /// Its unit.
    pub unit: String,
    /// The colours.
    pub palette: Palette,
    /// Values at the ends of the colours.
    pub ends: [f64; 2],
}

impl Key {
    /// The colour of a value, "#rrggbb".
    pub fn colour(&self, value: f64) -> String {
        let [low, high] = self.ends;
        let share = if high > low { (value - low) / (high - low) } else { 0.5 };
        let [r, g, b] = self.palette.at(share);
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    fn bar(&self, place: &Place) -> Bar {
        let (palette, ends) = (self.palette, self.ends);
        let scale = ColourScale { colours: Colours::Sequential, palette, ends, log: false };
        Bar::new(scale, &self.label, &self.unit, place)
    }
}

/// A panel laid out: its rulers, and left, top, right and bottom of its frame \[points\].
pub(super) struct Layout {
    x: Ruler,
    y: Ruler,
    pub(super) area: [f64; 4],
}

impl Layout {
    /// Where a point lies on the paper; `None` for one that the scales cannot show.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x.place(x)?, self.y.place(y)?])
    }
}

impl Curves {
    /// A panel without curves yet.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Curves {
        Curves {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            beside: None,
            key: None,
            empty: "no values to show".into(),
            names_above: false,
        }
    }

    /// The same panel with one more series on top.
    pub fn with(mut self, series: Series) -> Curves {
        self.series.push(series);
        self
    }

    /// What the panel needs of its margins where it has these already: width of the numbers at the vertical axis, and height of a
    /// legend above the frame, where no corner inside is free of curves.
    pub(crate) fn needs(&self, size: [f64; 2], given: Margins) -> Margins {
        let labels = self.rulers(size, given).1.widest();
        let layout = self.layout(&Place { corner: [0.0, 0.0], size, margins: given });
        let legend = Legend::of(self);
        let [left, _, right, _] = layout.area;
        let is_above = !legend.is_empty() && self.corner(&legend, &layout).is_none();
        let legend = if is_above { legend.height_above(right - left) } else { 0.0 };
        Margins { labels, beside: 0.0, legend, head: super::head(&self.title) }
    }

    /// Where the names stand inside of the frame; `None` above it.
    fn corner(&self, legend: &Legend, layout: &Layout) -> Option<[f64; 2]> {
        if self.names_above { None } else { legend.corner(self, layout) }
    }

    /// The same panel with its horizontal axis in another unit too.
    pub fn beside(mut self, unit: &str, factor: f64) -> Curves {
        self.beside = Some(Beside { unit: unit.into(), factor });
        self
    }

    /// The same panel with what it says where it has nothing to draw.
    pub fn or_say(mut self, why: impl Into<String>) -> Curves {
        self.empty = why.into();
        self
    }

    /// Ends of the data that the panel shows, by axis.
    pub(crate) fn ends(&self) -> [[f64; 2]; 2] {
        let [across, up] = self.extent();
        [self.x.range.unwrap_or(across), self.y.range.unwrap_or(up)]
    }

    /// Whether a value at zero is left out because the horizontal axis is logarithmic.
    pub(crate) fn leaves_out_zero(&self) -> bool {
        let at_zero = |[x, y]: [f64; 2]| x == 0.0 && y.is_finite();
        self.x.scale == Scale::Log && self.series.iter().flat_map(Series::points).any(at_zero)
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, place: &Place) {
        let layout = self.layout(place);
        let [left, top, right, bottom] = layout.area;
        let [x0, y0] = place.corner;
        frame(drawing, &layout.x, &layout.y, layout.area, [x0 + TEXT, y0 + place.size[1] - 5.0]);
        let legend = Legend::of(self);
        let corner = self.corner(&legend, &layout);
        let above = if corner.is_some() { 0.0 } else { legend.height_above(right - left) };
        if !self.title.is_empty() {
            let at = [left, top - self.height_beside() - above - 7.0];
            drawing.text(at, TEXT, Anchor::Start, &self.title);
        }
        if let Some(beside) = &self.beside {
            self.draw_beside(drawing, &layout, beside);
        }
        if let Some(key) = &self.key {
            key.bar(place).draw(drawing, [right + 8.0, top, bottom]);
        }
        if !self.extent()[0][0].is_finite() {
            let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
            drawing.text(middle, SMALL, Anchor::Middle, &self.empty);
        }
        let at = |point| layout.at(point);
        let inside = |[x, y]: &[f64; 2]| {
            let room = 0.01;
            *x >= left - room && *x <= right + room && *y >= top - room && *y <= bottom + room
        };
        for (series, colour) in self.coloured() {
            // A sign at the edge of the frame is drawn whole.
            let mut signs = |style: Style, places: Vec<[f64; 2]>| {
                places.into_iter().filter(inside).for_each(|place| sign(drawing, style, place, colour));
            };
            if series.style.is_of_points() {
                signs(series.style, series.points().filter_map(at).collect());
                continue;
            }
            if series.style != Style::Bars {
                signs(Style::Points, dots(series.points().map(at)));
            }
            drawing.clipped([left, top], [right - left, bottom - top], |drawing| {
                series.draw(drawing, colour, &at, bottom, layout.y.place(0.0));
            });
        }
        match corner {
            _ if legend.is_empty() => {}
            Some(corner) => legend.draw_inside(drawing, corner),
            None => legend.draw_above(drawing, [left, top - self.height_beside()], right, x0),
        }
    }

    /// Left, top, right and bottom of the frame \[points\].
    pub(super) fn frame(&self, place: &Place) -> [f64; 4] {
        self.layout(place).area
    }

    /// Whether titles and names end inside of the panel.
    pub(super) fn has_room_for_words(&self, place: &Place) -> bool {
        let layout = self.layout(place);
        let [left, top, right, bottom] = layout.area;
        let ([x0, y0], [width, height]) = (place.corner, place.size);
        let fits = |text: &str, room: f64| font::width(text, TEXT) <= room;
        fits(&self.title, x0 + width + EDGE - left)
            && fits(&layout.x.title, around([left, right], [x0, x0 + width + EDGE]))
            && fits(&layout.y.title, around([top, bottom], [y0, y0 + height]))
            && Legend::of(self).width() <= right - x0
    }

    /// Height of the other unit above the frame.
    fn height_beside(&self) -> f64 {
        if self.beside.is_some() { SMALL + 8.0 } else { 0.0 }
    }

    /// Ticks of the other unit above the frame, and the unit at the right.
    fn draw_beside(&self, drawing: &mut Drawing, layout: &Layout, beside: &Beside) {
        let [_, top, right, _] = layout.area;
        let reach = layout.x.reach().map(|end| end * beside.factor);
        let axis = Axis { unit: beside.unit.clone(), ..self.x.clone() }.between(reach[0], reach[1]);
        let ruler = Ruler::new(&axis, reach, 0.0, layout.x.ticks.len() as f64);
        let unit = ruler.unit.text.clone();
        let free = right - font::width(&unit, SMALL) - 6.0;
        drawing.text([right, top - 5.0], SMALL, Anchor::End, &unit);
        for (value, text) in &ruler.ticks {
            let Some(at) = layout.x.place(value / beside.factor) else { continue };
            drawing.line([at, top - 3.5], [at, top], Pen::new(INK, 0.7));
            if at + 0.5 * font::width(text, SMALL) < free {
                drawing.text([at, top - 5.0], SMALL, Anchor::Middle, text);
            }
        }
    }

    /// Rulers without places, and the height of what is above and below the frame.
    fn rulers(&self, [width, height]: [f64; 2], margins: Margins) -> (Ruler, Ruler, [f64; 2]) {
        let bars = self.series.iter().any(|series| series.style == Style::Bars);
        let [mut across, mut up] = self.extent();
        if bars {
            let half = 0.5 * self.series.iter().map(|s| spacing(&s.x)).fold(0.0, f64::max);
            across = [across[0] - half, across[1] + half];
            if self.y.scale == Scale::Linear {
                up = [up[0].min(0.0), up[1].max(0.0)];
            }
        }
        let foot = TEXT + SMALL + 12.0;
        let head = margins.head + margins.legend + self.height_beside();
        let x = Ruler::new(&self.x, across, ROOM[0], (width - margins.labels - TEXT - 25.0) / 48.0);
        let mut y = self.y.clone();
        // A density over a length in µm is one per µm.
        if y.unit == format!("1/{}", self.x.unit) {
            y.chosen = Some(Shown { factor: 1.0 / x.unit.factor, text: format!("1/{}", x.unit.text) });
        }
        let y = Ruler::new(&y, up, ROOM[1], (height - foot - head) / 32.0);
        (x, y, [head, foot])
    }

    fn layout(&self, place: &Place) -> Layout {
        let ([x0, y0], [width, height]) = (place.corner, place.size);
        let (x, y, [head, foot]) = self.rulers(place.size, place.margins);
        let left = x0 + TEXT + place.margins.labels + 13.0;
        let key = self.key.as_ref().map_or(0.0, |key| key.bar(place).width());
        let (right, top, bottom) =
            (x0 + width - (12.0 + key).max(place.margins.beside), y0 + head, y0 + height - foot);
        Layout { x: x.placed(left, right), y: y.placed(bottom, top), area: [left, top, right, bottom] }
    }

    /// The series with their colours.
    pub(super) fn coloured(&self) -> impl Iterator<Item = (&Series, &str)> {
        let mut colours = COLOURS.iter().copied().cycle();
        self.series.iter().map(move |series| match (&series.colour, series.style) {
            (Some(own), _) => (series, own.as_str()),
            (None, Style::Reference) => (series, INK),
            (None, _) => (series, colours.next().unwrap_or(INK)),
        })
    }

    /// Least and greatest of the finite places and values that the scales can show.
    fn extent(&self) -> [[f64; 2]; 2] {
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let shows = |scale: Scale, v: f64| v.is_finite() && (scale == Scale::Linear || v > 0.0);
        let inside = |x: f64| self.x.range.is_none_or(|[from, to]| from <= x && x <= to);
        for [x, y] in self.series.iter().flat_map(Series::points) {
            if shows(self.x.scale, x) && shows(self.y.scale, y) && inside(x) {
                for (range, v) in extent.iter_mut().zip([x, y]) {
                    *range = [range[0].min(v), range[1].max(v)];
                }
            }
        }
        extent
    }
}

/// Room of a text at the middle of a side, between these limits.
pub(super) fn around([from, to]: [f64; 2], [first, last]: [f64; 2]) -> f64 {
    let middle = 0.5 * (from + to);
    2.0 * (middle - first).min(last - middle)
}

/// Frame, ticks, grid and titles; `titles` holds the baseline of the vertical and of the horizontal title.
pub(super) fn frame(drawing: &mut Drawing, x: &Ruler, y: &Ruler, area: [f64; 4], titles: [f64; 2]) {
    let [left, top, right, bottom] = area;
    // A number that would touch the one before it is left out.
    let mut free = f64::NEG_INFINITY;
    for (value, text) in &x.ticks {
        if let Some(at) = x.place(*value) {
            drawing.line([at, top], [at, bottom], Pen::new(GRID, 0.5));
            drawing.line([at, bottom], [at, bottom + 3.5], Pen::new(INK, 0.7));
            let half = 0.5 * font::width(text, SMALL);
            if at - half >= free {
                drawing.text([at, bottom + 5.0 + SMALL], SMALL, Anchor::Middle, text);
                free = at + half + 2.0;
            }
        }
    }
    let mut last = f64::INFINITY;
    for (value, text) in &y.ticks {
        if let Some(at) = y.place(*value) {
            drawing.line([left, at], [right, at], Pen::new(GRID, 0.5));
            drawing.line([left - 3.5, at], [left, at], Pen::new(INK, 0.7));
            if (last - at).abs() >= SMALL {
                drawing.text([left - 5.5, at + 0.36 * SMALL], SMALL, Anchor::End, text);
                last = at;
            }
        }
    }
    for at in x.minor.iter().filter_map(|value| x.place(*value)) {
        drawing.line([at, bottom], [at, bottom + 2.0], Pen::new(INK, 0.5));
    }
    for at in y.minor.iter().filter_map(|value| y.place(*value)) {
        drawing.line([left - 2.0, at], [left, at], Pen::new(INK, 0.5));
    }
    drawing.rect([left, top], [right - left, bottom - top], Paint::outline(Pen::new(INK, 0.8)));
    drawing.text([0.5 * (left + right), titles[1]], TEXT, Anchor::Middle, &x.title);
    drawing.upward_text([titles[0], 0.5 * (top + bottom)], TEXT, &y.title);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of a sign, and more than half of a line \[points\].
    const SIGN: f64 = 2.0;

    fn place(panel: &Curves) -> Place {
        super::super::Figure::new("").with(panel.clone()).places().remove(0)
    }

    #[test]
    fn no_point_lies_on_the_frame() {
        let x = [0.0, 1.0, 3.0, 100.0];
        for y in [[0.0, 0.0, 5.0, 0.0], [-3.0, 0.0, 0.0, 0.0], [1e-9, 1e-7, 1e-8, 1e-9]] {
            for (log_x, log_y) in [(false, false), (true, false), (false, true), (true, true)] {
                let axis = |log: bool| if log { Axis::log("a", "s") } else { Axis::linear("a", "s") };
                for across in [axis(log_x), axis(log_x).spanning(1.0, 100.0)] {
                    let panel =
                        Curves::new("", across, axis(log_y)).with(Series::new("", Style::Points, x, y));
                    let layout = panel.layout(&place(&panel));
                    let [left, top, right, bottom] = layout.area;
                    // Places before a window are not drawn.
                    let seen = |p: &[f64; 2]| panel.x.range.is_none_or(|ends| p[0] >= ends[0]);
                    for [x, y] in panel.series[0].points().filter(seen).filter_map(|point| layout.at(point)) {
                        assert!(x > left + SIGN && x < right - SIGN, "{panel:?}");
                        assert!(y > top + SIGN && y < bottom - SIGN, "{panel:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn names_stand_where_no_curve_comes_near_or_above_the_frame() {
        let x: Vec<f64> = (0..=400).map(|k| f64::from(k) / 400.0).collect();
        for k in 0..60 {
            let turn = f64::from(k) / 9.0;
            let panel = ["a curve", "another one with a long name"].iter().zip([0.0, 0.6]).fold(
                Curves::new("", Axis::linear("x", "m"), Axis::linear("y", "m")),
                |panel, (name, shift)| {
                    panel.with(Series::of(*name, Style::Line, &x, |x| (turn * x + turn + shift).sin()))
                },
            );
            let place = place(&panel);
            let (layout, legend) = (panel.layout(&place), Legend::of(&panel));
            let Some([left, top]) = panel.corner(&legend, &layout) else {
                assert!(place.margins.legend > 0.0, "{k}");
                continue;
            };
            let [width, height] = legend.size();
            for [x, y] in panel.series.iter().flat_map(Series::points).filter_map(|point| layout.at(point)) {
                let apart =
                    x + SIGN < left || x - SIGN > left + width || y + SIGN < top || y - SIGN > top + height;
                assert!(apart, "{k}: {x} {y} {left} {top} {width} {height}");
            }
        }
    }
}
