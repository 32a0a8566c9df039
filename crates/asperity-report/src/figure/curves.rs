//! A panel of curves over two axes.

use super::axis::{Axis, Ruler, Scale};
use super::font;
use super::svg::{Anchor, Drawing, GRID, INK};
use super::{Place, SMALL, TEXT};

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

impl Series {
    /// A series of places and values.
    pub fn new(
        name: impl Into<String>,
        style: Style,
        x: impl Into<Vec<f64>>,
        y: impl Into<Vec<f64>>,
    ) -> Series {
        Series { name: name.into(), x: x.into(), y: y.into(), style }
    }

    fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
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

    pub(super) fn draw(&self, drawing: &mut Drawing, place: &Place) {
        let bars = self.series.iter().any(|series| series.style == Style::Bars);
        let [mut across, mut up] = self.extent();
        if bars {
            let half = 0.5 * self.series.iter().map(|s| spacing(&s.x)).fold(0.0, f64::max);
            across = [across[0] - half, across[1] + half];
            if self.y.scale == Scale::Linear {
                up = [up[0].min(0.0), up[1].max(0.0)];
            }
        }
        let [x0, y0] = place.corner;
        let [width, height] = place.size;
        let foot = TEXT + SMALL + 12.0;
        let head = if self.title.is_empty() { 8.0 } else { TEXT + 9.0 };
        let y = Ruler::new(&self.y, up, 0.06, (height - foot - head) / 32.0);
        let labels = y.ticks.iter().map(|(_, text)| font::width(text, SMALL)).fold(0.0, f64::max);
        let left = x0 + TEXT + labels + 13.0;
        let (right, top, bottom) = (x0 + width - 12.0, y0 + head, y0 + height - foot);
        let margin = if bars || self.x.scale == Scale::Linear { 0.0 } else { 0.01 };
        let x = Ruler::new(&self.x, across, margin, (right - left) / 48.0).placed(left, right);
        let y = y.placed(bottom, top);

        frame(drawing, &x, &y, [left, top, right, bottom], [x0 + TEXT, y0 + height - 5.0]);
        if !self.title.is_empty() {
            drawing.text([left, y0 + TEXT + 1.0], TEXT, Anchor::Start, "", &self.title);
        }
        let at = |[a, b]: [f64; 2]| Some([x.place(a)?, y.place(b)?]);
        drawing.clipped([left, top], [right - left, bottom - top], |drawing| {
            let mut colours = COLOURS.iter().cycle();
            for series in &self.series {
                let colour =
                    if series.style == Style::Reference { INK } else { colours.next().unwrap_or(&INK) };
                draw_series(drawing, series, colour, &at, bottom, y.place(0.0));
            }
        });
        self.legend(drawing, &at, [left, top, right, bottom]);
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

    /// The names, in the corner where they hide least.
    fn legend(&self, drawing: &mut Drawing, at: &impl Fn([f64; 2]) -> Option<[f64; 2]>, area: [f64; 4]) {
        let mut colours = COLOURS.iter().cycle();
        let named: Vec<_> = self
            .series
            .iter()
            .map(|s| (s, if s.style == Style::Reference { INK } else { colours.next().unwrap_or(&INK) }))
            .filter(|(s, _)| !s.name.is_empty())
            .collect();
        if named.is_empty() {
            return;
        }
        let [left, top, right, bottom] = area;
        let row = SMALL + 3.5;
        let text = named.iter().map(|(s, _)| font::width(&s.name, SMALL)).fold(0.0, f64::max);
        let (width, height) = (text + 30.0, row * named.len() as f64 + 5.0);
        let corners = [
            [right - width - 4.0, top + 4.0],
            [left + 4.0, top + 4.0],
            [right - width - 4.0, bottom - height - 4.0],
            [left + 4.0, bottom - height - 4.0],
        ];
        let hidden = |[x, y]: [f64; 2]| {
            let under = |p: &[f64; 2]| p[0] > x && p[0] < x + width && p[1] > y && p[1] < y + height;
            // Lines hide between their points as well.
            let on_lines = |s: &Series| {
                let places: Vec<_> = s.points().filter_map(at).collect();
                let between = places.windows(2).flat_map(|pair| {
                    (0..8)
                        .map(|k| [0, 1].map(|i| pair[0][i] + (pair[1][i] - pair[0][i]) * f64::from(k) / 8.0))
                });
                between.filter(under).count() as f64 / (8.0 * places.len().max(1) as f64)
            };
            self.series.iter().map(on_lines).sum::<f64>()
        };
        let mut best = (f64::INFINITY, corners[0]);
        for corner in corners {
            let cost = hidden(corner);
            if cost < best.0 {
                best = (cost, corner);
            }
        }
        let [x, y] = best.1;
        drawing.rect([x, y], [width, height], "fill=\"#fff\" fill-opacity=\"0.85\" rx=\"2\"");
        for (n, (series, colour)) in named.into_iter().enumerate() {
            let middle = y + row * (n as f64 + 0.5) + 2.5;
            let (from, to) = ([x + 5.0, middle], [x + 21.0, middle]);
            match series.style {
                Style::Bars => {
                    let style = format!("fill=\"{colour}\" fill-opacity=\"0.55\"");
                    drawing.rect([x + 7.0, middle - 3.5], [12.0, 7.0], &style);
                }
                Style::Points => {
                    drawing.circle([x + 13.0, middle], 2.4, &format!("fill=\"none\" stroke=\"{colour}\""));
                }
                style => drawing.line(from, to, colour, weight(style, 0.0), dashes(style)),
            }
            drawing.text([x + 26.0, middle + 0.36 * SMALL], SMALL, Anchor::Start, "", &series.name);
        }
    }
}

/// Frame, ticks, grid and titles; `titles` holds the baseline of the vertical and of the horizontal title.
pub(super) fn frame(drawing: &mut Drawing, x: &Ruler, y: &Ruler, area: [f64; 4], titles: [f64; 2]) {
    let [left, top, right, bottom] = area;
    for (value, text) in &x.ticks {
        if let Some(at) = x.place(*value) {
            drawing.line([at, top], [at, bottom], GRID, 0.5, "");
            drawing.line([at, bottom], [at, bottom + 3.5], INK, 0.7, "");
            drawing.text([at, bottom + 5.0 + SMALL], SMALL, Anchor::Middle, "", text);
        }
    }
    for (value, text) in &y.ticks {
        if let Some(at) = y.place(*value) {
            drawing.line([left, at], [right, at], GRID, 0.5, "");
            drawing.line([left - 3.5, at], [left, at], INK, 0.7, "");
            drawing.text([left - 5.5, at + 0.36 * SMALL], SMALL, Anchor::End, "", text);
        }
    }
    for at in x.minor.iter().filter_map(|value| x.place(*value)) {
        drawing.line([at, bottom], [at, bottom + 2.0], INK, 0.5, "");
    }
    for at in y.minor.iter().filter_map(|value| y.place(*value)) {
        drawing.line([left - 2.0, at], [left, at], INK, 0.5, "");
    }
    let style = format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"0.8\"");
    drawing.rect([left, top], [right - left, bottom - top], &style);
    drawing.text([0.5 * (left + right), titles[1]], TEXT, Anchor::Middle, "", &x.title);
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
            let style = format!("fill=\"{colour}\" fill-opacity=\"0.55\"");
            for [x, y] in series.points() {
                if let (Some([a, top]), Some([b, _])) = (at([x - half, y]), at([x + half, y])) {
                    drawing.rect([a, top.min(foot)], [b - a, (foot - top).abs()], &style);
                }
            }
        }
        Style::Points => {
            let style = format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"0.9\"");
            points().flatten().for_each(|point| drawing.circle(point, 2.0, &style));
        }
        style => {
            let pen = format!(
                "stroke=\"{colour}\" stroke-width=\"{}\" stroke-linejoin=\"round\" {}",
                weight(style, length(points())),
                dashes(style)
            );
            drawing.path(points(), &pen);
        }
    }
}

/// Thinner where a line runs to and fro so often that it would cover itself.
fn weight(style: Style, length: f64) -> f64 {
    /// Some five times across a panel.
    const LONG: f64 = 2000.0;
    match style {
        Style::Reference => 1.0,
        _ if length > LONG => 0.7,
        _ => 1.5,
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

fn dashes(style: Style) -> &'static str {
    match style {
        Style::Dashed => "stroke-dasharray=\"5 2.5\"",
        Style::Reference => "stroke-dasharray=\"1.5 1.8\"",
        _ => "",
    }
}

/// The least distance of neighbouring places.
fn spacing(x: &[f64]) -> f64 {
    let least = x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}
