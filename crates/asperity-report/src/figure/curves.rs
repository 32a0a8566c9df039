//! A panel of curves over two axes.

use super::axis::{Axis, Ruler, Scale};
use super::drawing::{Anchor, Drawing, GRID, INK, Paint, Pen};
use super::legend::Legend;
use super::{Margins, Place, SMALL, TEXT};

/// Colours that people with any kind of colour vision tell apart (Okabe & Ito 2008), dark ones first.
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#222222"];

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line through the points.
    Line,
    /// A dashed line through the points.
    Dashed,
    /// A thin dotted line through the points, in black: something to compare with.
    Reference,
    /// A circle at each point.
    Points,
    /// Bars from zero (or from the foot of the axis) to the value, as wide as the distance of the points.
    Bars,
}

/// Numbers to draw \[SI\].
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend says; empty for a series without a line in the legend.
    pub name: String,
    /// Places along the horizontal axis.
    pub x: Vec<f64>,
    /// Values, as many as there are places; a value that is not finite leaves a gap.
    pub y: Vec<f64>,
    /// How it is drawn.
    pub style: Style,
    /// Its colour, "#rrggbb"; `None` for the next one of the panel.
    pub colour: Option<String>,
}

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

impl Series {
    /// A series of places and values.
    pub fn new(
        name: impl Into<String>,
        style: Style,
        x: impl Into<Vec<f64>>,
        y: impl Into<Vec<f64>>,
    ) -> Series {
        Series { name: name.into(), x: x.into(), y: y.into(), style, colour: None }
    }

    /// The same in a colour of its own, "#rrggbb".
    pub fn in_colour(mut self, colour: impl Into<String>) -> Series {
        self.colour = Some(colour.into());
        self
    }

    pub(super) fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.x.iter().zip(&self.y).map(|(x, y)| [*x, *y])
    }
}

impl Curves {
    /// A panel without curves yet.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Curves {
        Curves { title: title.into(), x, y, series: Vec::new() }
    }

    /// The same panel with one more series on top.
    pub fn with(mut self, series: Series) -> Curves {
        self.series.push(series);
        self
    }

    /// What the panel needs of its margins: width of the numbers at the vertical axis, and height of a legend above the frame,
    /// where no corner inside is free of curves.
    pub(super) fn needs(&self, size: [f64; 2]) -> Margins {
        let labels = self.rulers(size, Margins::default()).1.widest();
        let own = Margins { labels, legend: 0.0 };
        let layout = self.layout(&Place { corner: [0.0, 0.0], size, margins: own });
        let legend = Legend::of(self);
        if legend.is_empty() || legend.corner(self, &layout).is_some() {
            return own;
        }
        let [left, _, right, _] = layout.area;
        Margins { legend: legend.rows(right - left).len() as f64 * Legend::ROW + 3.0, ..own }
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, place: &Place) {
        let layout = self.layout(place);
        let [left, top, right, bottom] = layout.area;
        let [x0, y0] = place.corner;
        frame(drawing, &layout.x, &layout.y, layout.area, [x0 + TEXT, y0 + place.size[1] - 5.0]);
        if !self.title.is_empty() {
            drawing.text([left, y0 + TEXT + 1.0], TEXT, Anchor::Start, &self.title);
        }
        let at = |point| layout.at(point);
        drawing.clipped([left, top], [right - left, bottom - top], |drawing| {
            for (series, colour) in self.coloured() {
                draw_series(drawing, series, colour, &at, bottom, layout.y.place(0.0));
            }
        });
        let legend = Legend::of(self);
        match legend.corner(self, &layout) {
            _ if legend.is_empty() => {}
            Some(corner) => legend.draw_inside(drawing, corner),
            None => legend.draw_above(drawing, [left, top], right - left),
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
        let head = if self.title.is_empty() { 8.0 } else { TEXT + 9.0 } + margins.legend;
        let y = Ruler::new(&self.y, up, 0.06, (height - foot - head) / 32.0);
        let margin = if bars || self.x.scale == Scale::Linear { 0.0 } else { 0.01 };
        let x = Ruler::new(&self.x, across, margin, (width - margins.labels - TEXT - 25.0) / 48.0);
        (x, y, [head, foot])
    }

    fn layout(&self, place: &Place) -> Layout {
        let ([x0, y0], [width, height]) = (place.corner, place.size);
        let (x, y, [head, foot]) = self.rulers(place.size, place.margins);
        let left = x0 + TEXT + place.margins.labels + 13.0;
        let (right, top, bottom) = (x0 + width - 12.0, y0 + head, y0 + height - foot);
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
        for [x, y] in self.series.iter().flat_map(Series::points) {
            if shows(self.x.scale, x) && shows(self.y.scale, y) {
                for (range, v) in extent.iter_mut().zip([x, y]) {
                    *range = [range[0].min(v), range[1].max(v)];
                }
            }
        }
        extent
    }
}

/// Frame, ticks, grid and titles; `titles` holds the baseline of the vertical and of the horizontal title.
pub(super) fn frame(drawing: &mut Drawing, x: &Ruler, y: &Ruler, area: [f64; 4], titles: [f64; 2]) {
    let [left, top, right, bottom] = area;
    for (value, text) in &x.ticks {
        if let Some(at) = x.place(*value) {
            drawing.line([at, top], [at, bottom], Pen::new(GRID, 0.5));
            drawing.line([at, bottom], [at, bottom + 3.5], Pen::new(INK, 0.7));
            drawing.text([at, bottom + 5.0 + SMALL], SMALL, Anchor::Middle, text);
        }
    }
    for (value, text) in &y.ticks {
        if let Some(at) = y.place(*value) {
            drawing.line([left, at], [right, at], Pen::new(GRID, 0.5));
            drawing.line([left - 3.5, at], [left, at], Pen::new(INK, 0.7));
            drawing.text([left - 5.5, at + 0.36 * SMALL], SMALL, Anchor::End, text);
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

fn draw_series(
    drawing: &mut Drawing,
    series: &Series,
    colour: &str,
    at: &impl Fn([f64; 2]) -> Option<[f64; 2]>,
    bottom: f64,
    zero: Option<f64>,
) {
    let points = || series.points().map(at);
    match series.style {
        Style::Bars => {
            let half = 0.5 * spacing(&series.x);
            let foot = zero.unwrap_or(bottom).min(bottom);
            let paint = Paint::fill(colour, 0.55);
            for [x, y] in series.points() {
                if let (Some([a, top]), Some([b, _])) = (at([x - half, y]), at([x + half, y]))
                    && top != foot
                {
                    drawing.rect([a, top.min(foot)], [b - a, (foot - top).abs()], paint);
                }
            }
        }
        Style::Points => {
            let paint = Paint::outline(Pen::new(colour, 0.9));
            points().flatten().for_each(|point| drawing.circle(point, 2.0, paint));
        }
        style => drawing.path(points(), pen(style, colour, length(points()))),
    }
}

/// The pen of a line of this length \[points\]: thinner where it runs to and fro so often that it would cover itself.
pub(super) fn pen(style: Style, colour: &str, length: f64) -> Pen {
    /// Some five times across a panel.
    const LONG: f64 = 2000.0;
    let width = if length > LONG { 0.7 } else { 1.5 };
    match style {
        Style::Reference => Pen::new(colour, 1.0).dashed(&[1.5, 1.8]),
        Style::Dashed => Pen::new(colour, width).dashed(&[5.0, 2.5]),
        _ => Pen::new(colour, width),
    }
}

/// Length of a line as it is drawn.
fn length(points: impl Iterator<Item = Option<[f64; 2]>>) -> f64 {
    let mut last = None;
    points
        .map(|now| {
            let from = std::mem::replace(&mut last, now);
            from.zip(now).map_or(0.0, |([a, b], [c, d])| f64::hypot(c - a, d - b))
        })
        .sum()
}

/// The least distance of neighbouring places.
fn spacing(x: &[f64]) -> f64 {
    let least = x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}
