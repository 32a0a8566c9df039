//! The numbers of a panel of curves, and how they are drawn.

use super::drawing::{Drawing, Paint, Pen, rgb};

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line through the points.
    Line,
    /// A dashed line through the points.
    Dashed,
    /// A dotted line through the points.
    Dotted,
    /// A line of dashes and dots through the points.
    DashDotted,
    /// A thin dotted line through the points, in black: something to compare with.
    Reference,
    /// A circle at each point.
    Points,
    /// A cross at each point.
    Crosses,
    /// A square at each point.
    Squares,
    /// Bars from zero (or from the foot of the axis) to the value, as wide as the distance of the points.
    Bars,
}

impl Style {
    /// The styles of lines, for several quantities in one colour.
    pub(crate) const LINES: [Style; 4] = [Style::Line, Style::Dashed, Style::Dotted, Style::DashDotted];
    /// The signs of points, likewise.
    pub(crate) const SIGNS: [Style; 3] = [Style::Points, Style::Crosses, Style::Squares];

    /// Whether each point has a sign of its own, with no line between them.
    pub(crate) fn is_of_points(self) -> bool {
        Style::SIGNS.contains(&self)
    }
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

impl Series {
    /// A series of places and values.
    pub fn new(name: impl Into<String>, style: Style, x: impl AsRef<[f64]>, y: impl AsRef<[f64]>) -> Series {
        let [x, y] = [x.as_ref(), y.as_ref()].map(<[f64]>::to_vec);
        Series { name: name.into(), x, y, style, colour: None }
    }

    /// A series of points (place, value).
    pub fn through(
        name: impl Into<String>,
        style: Style,
        points: impl IntoIterator<Item = [f64; 2]>,
    ) -> Series {
        let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().map(|[x, y]| (x, y)).unzip();
        Series::new(name, style, x, y)
    }

    /// A series of the values of a function at places.
    pub fn of(name: impl Into<String>, style: Style, x: &[f64], f: impl Fn(f64) -> f64) -> Series {
        Series::through(name, style, x.iter().map(|x| [*x, f(*x)]))
    }

    /// The same with each value held until the next place: steps.
    pub fn stepped(self) -> Series {
        let mut steps: Vec<[f64; 2]> = vec![];
        for [x, y] in self.points() {
            steps.extend(steps.last().map(|last| [x, last[1]]));
            steps.push([x, y]);
        }
        Series { colour: self.colour, ..Series::through(self.name, self.style, steps) }
    }

    /// The same in a colour of its own, "#rrggbb".
    pub fn in_colour(mut self, colour: impl Into<String>) -> Series {
        self.colour = Some(colour.into());
        self
    }

    pub(super) fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.x.iter().zip(&self.y).map(|(x, y)| [*x, *y])
    }

    /// Draws a line or bars; `at` places points, and `bottom` and `zero` are places of the vertical axis.
    pub(super) fn draw(
        &self,
        drawing: &mut Drawing,
        colour: &str,
        at: &impl Fn([f64; 2]) -> Option<[f64; 2]>,
        bottom: f64,
        zero: Option<f64>,
    ) {
        let points = || self.points().map(at);
        match self.style {
            Style::Bars => {
                let half = 0.5 * spacing(&self.x);
                let foot = zero.unwrap_or(bottom).min(bottom);
                let paint = Paint::fill(colour, 0.55);
                for [x, y] in self.points() {
                    if let (Some([a, top]), Some([b, _])) = (at([x - half, y]), at([x + half, y]))
                        && top != foot
                    {
                        drawing.rect([a, top.min(foot)], [b - a, (foot - top).abs()], paint);
                    }
                }
            }
            style => {
                let length = length(points());
                if length > 0.0 {
                    drawing.path(points(), pen(style, colour, length));
                }
            }
        }
    }
}

/// Places of the parts of a line that have no length: a line that stays at one place, or a point between gaps.
pub(super) fn dots(points: impl Iterator<Item = Option<[f64; 2]>>) -> Vec<[f64; 2]> {
    /// Shorter lines are hidden in their own width \[points\].
    const SHORT: f64 = 0.5;
    let places: Vec<Option<[f64; 2]>> = points.collect();
    let parts = places.split(|place| place.is_none()).filter(|part| !part.is_empty());
    parts.filter(|part| length(part.iter().copied()) < SHORT).filter_map(|part| part[0]).collect()
}

/// The sign of a series of points at a place.
pub(super) fn sign(drawing: &mut Drawing, style: Style, [x, y]: [f64; 2], colour: &str) {
    const HALF: f64 = 2.0;
    match style {
        Style::Crosses => {
            let arm = |up: f64| [Some([x - HALF, y - up]), Some([x + HALF, y + up]), None];
            drawing.path(arm(HALF).into_iter().chain(arm(-HALF)), Pen::new(colour, 1.1));
        }
        Style::Squares => drawing.rect([x - HALF, y - HALF], [2.0 * HALF; 2], spot(colour)),
        _ => drawing.circle([x, y], HALF, spot(colour)),
    }
}

/// Filled with its colour in part: many signs on top of one another stay dark.
fn spot(colour: &str) -> Paint {
    Paint { fill: Some((rgb(colour), 0.35)), pen: Some(Pen::new(colour, 0.9)) }
}

/// The pen of a line of this length \[points\]: thinner where it runs to and fro so often that it would cover itself.
pub(super) fn pen(style: Style, colour: &str, length: f64) -> Pen {
    /// Some five times across a panel.
    const LONG: f64 = 2000.0;
    let width = if length > LONG { 0.7 } else { 1.5 };
    match style {
        Style::Reference => Pen::new(colour, 1.0).dashed(&[1.5, 1.8]),
        Style::Dashed => Pen::new(colour, width).dashed(&[5.0, 2.5]),
        Style::Dotted => Pen::new(colour, width).dashed(&[1.6, 2.2]),
        Style::DashDotted => Pen::new(colour, width).dashed(&[6.0, 2.0, 1.6, 2.0]),
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
pub(super) fn spacing(x: &[f64]) -> f64 {
    let least = x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_length_is_a_dot() {
        let line = [
            Some([1.0, 1.0]),
            Some([5.0, 1.0]),
            None,
            Some([7.0, 2.0]),
            None,
            Some([9.0, 3.0]),
            Some([9.0, 3.0]),
        ];
        assert_eq!(dots(line.into_iter()), [[7.0, 2.0], [9.0, 3.0]]);
        assert!(dots([None, None].into_iter()).is_empty());
    }
}
