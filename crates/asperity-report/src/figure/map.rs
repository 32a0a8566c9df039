//! A panel of a map: values over the area in colours, with colour bar and scale bar.

use asperity_io::readable::{quantity, shown};
use ndarray::{Array2, ArrayView2};

use super::axis::{Axis, Ruler};
use super::colours::{Colours, OPEN, Palette};
use super::curves::frame;
use super::drawing::{Anchor, Drawing, INK, Paint, Pen, Pixels};
use super::font;
use super::raster::{self, BLANK};
use super::scale::{Bar, ColourScale, extent};
use super::{Place, SMALL, TEXT};

/// What the values of a map are.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers of a quantity \[SI\]; NaN where it is undefined.
    Quantity {
        /// The quantity, `height`.
        label: String,
        /// Its SI unit, see [`shown`](shown()).
        unit: String,
        /// The colours.
        colours: Colours,
        /// Values at the ends of the colour bar; `None` for the least and the greatest.
        range: Option<[f64; 2]>,
    },
    /// States 0, 1, 2 ..., each with its name and colour.
    States(Vec<(String, [u8; 3])>),
}

/// A panel of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// A short title over the panel; may be empty.
    pub title: String,
    /// Values at the cell centres (axes x and y: x to the right, y upwards).
    pub values: Array2<f64>,
    /// What they are.
    pub meaning: Values,
    /// Lengths of the area along x and y \[m\].
    pub size: [f64; 2],
    /// What its axes are.
    pub axes: Axes,
    /// Places x, y that a circle marks \[m\].
    pub marks: Vec<[f64; 2]>,
    /// Colours instead of the usual ones of the quantity.
    pub palette: Option<Palette>,
    /// Whether the colours go by the logarithm of the values; values that are not positive are light then.
    pub log: bool,
}

/// The axes of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// x to the right and y upwards, from 0.
    Area,
    /// Lags x and y from the middle, where they are 0.
    Lags,
    /// x or y to the right, from `start` \[m\], and the depth downwards: a section of the body.
    Section {
        /// "x" or "y".
        along: &'static str,
        /// Where the section begins \[m\].
        start: f64,
    },
    /// x to the right, and the time upwards, not to one scale.
    Times {
        /// Where the time begins \[s\].
        start: f64,
    },
}

impl Map {
    /// A map of a quantity from its least to its greatest value.
    pub fn new(
        title: impl Into<String>,
        [label, unit]: [&str; 2],
        colours: Colours,
        values: ArrayView2<f64>,
        size: [f64; 2],
    ) -> Map {
        let meaning = Values::Quantity { label: label.into(), unit: unit.into(), colours, range: None };
        Map {
            title: title.into(),
            values: raster::means(values, raster::block(values)),
            meaning,
            size,
            axes: Axes::Area,
            marks: vec![],
            palette: None,
            log: false,
        }
    }

    /// The same map of something over lags in both directions.
    pub fn over_lags(self) -> Map {
        Map { axes: Axes::Lags, ..self }
    }

    /// The same map as a section whose second axis is the depth.
    pub fn section(self, along: &'static str, start: f64) -> Map {
        Map { axes: Axes::Section { along, start }, ..self }
    }

    /// The same map with the time \[s\] as its second axis, from `start` on; its size along that axis is a duration \[s\].
    pub fn over_time(self, start: f64) -> Map {
        Map { axes: Axes::Times { start }, ..self }
    }

    /// A map of states.
    pub fn states(
        title: impl Into<String>,
        names: Vec<(String, [u8; 3])>,
        values: ArrayView2<f64>,
        size: [f64; 2],
    ) -> Map {
        Map {
            title: title.into(),
            values: raster::states(values, raster::block(values)),
            meaning: Values::States(names),
            size,
            axes: Axes::Area,
            marks: vec![],
            palette: None,
            log: false,
        }
    }

    /// The same map with a circle around a place x, y \[m\].
    pub fn marked(mut self, place: [f64; 2]) -> Map {
        self.marks.push(place);
        self
    }

    /// The same map with these values at the ends of its colours.
    pub fn between(mut self, ends: [f64; 2]) -> Map {
        if let Values::Quantity { range, .. } = &mut self.meaning {
            *range = Some(ends);
        }
        self
    }

    /// How its values become colours; `None` for states.
    fn scale(&self) -> Option<ColourScale> {
        let Values::Quantity { colours, range, .. } = &self.meaning else { return None };
        Some(ColourScale::of(&self.values, *colours, self.palette, *range, self.log))
    }

    /// The values at the ends of its colours; `None` for states.
    pub(crate) fn ends(&self) -> Option<[f64; 2]> {
        self.scale().map(|scale| scale.ends)
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, place: &Place) {
        let [x0, y0] = place.corner;
        let [width, height] = place.size;
        let scale = self.scale();
        let bar = match &self.meaning {
            Values::Quantity { label, unit, .. } => scale.map(|scale| {
                let whole = extent(&self.values);
                let out = [whole[0] < scale.ends[0], whole[1] > scale.ends[1]];
                // What is beyond the ends of the colours; no gap and no pressure have a colour of their own.
                let own = scale.at(whole[0]) == OPEN;
                let beyond = [0, 1].map(|n| (out[n] && !(n == 0 && own)).then(|| quantity(whole[n], unit)));
                (Bar::new(scale, label, unit, place), beyond)
            }),
            Values::States(_) => None,
        };
        let arrows = |beyond: &[Option<String>; 2]| {
            beyond.iter().flatten().map(|text| 8.0 + SMALL + font::width(text, SMALL)).fold(0.0, f64::max)
        };
        let legend = bar.as_ref().map_or(0.0, |(bar, beyond)| bar.width().max(arrows(beyond)));
        let foot = TEXT + SMALL + 12.0;
        // The title, and the names of states, in lines of their own.
        let named = matches!(self.meaning, Values::States(_));
        let over = if named { SMALL + 6.0 } else { 0.0 };
        let head = if self.title.is_empty() { 8.0 } else { TEXT + 9.0 } + over;

        // Both axes in the same unit, and as long on paper as they are in truth; but for time.
        let (names, starts) = match self.axes {
            Axes::Area => (["x", "y"], [0.0; 2]),
            Axes::Lags => (["lag x", "lag y"], self.size.map(|side| -0.5 * side)),
            Axes::Section { along, start } => ([along, "depth"], [start, 0.0]),
            Axes::Times { start } => (["x", "time"], [0.0, start]),
        };
        let [over_x, over_y] = [0, 1].map(|axis| (starts[axis] + self.size[axis]).abs());
        let of_times = matches!(self.axes, Axes::Times { .. });
        let units = match of_times {
            true => [shown("m", over_x), shown("s", over_y)],
            false => [(); 2].map(|()| shown("m", over_x.max(over_y))),
        };
        let [across, up] = [0, 1].map(|axis| {
            let (unit, start) = (&units[axis], starts[axis]);
            let label = format!("{} [{}]", names[axis], unit.text);
            Axis::linear(label, "").between(start * unit.factor, (start + self.size[axis]) * unit.factor)
        });
        let room_y = height - foot - head;
        let y = Ruler::new(&up, [0.0, 1.0], 0.0, room_y / 32.0);
        let labels = y.ticks.iter().map(|(_, text)| font::width(text, SMALL)).fold(0.0, f64::max);
        let margin = TEXT + labels + 13.0;
        let room_x = width - margin - 8.0 - legend;
        let points = (room_x / self.size[0]).min(room_y / self.size[1]);
        let [w, h] = match of_times {
            true => [room_x, room_y],
            // A strip keeps a visible breadth.
            false => [0, 1].map(|axis| (self.size[axis] * points).max(12.0).min([room_x, room_y][axis])),
        };
        let left = x0 + margin;
        let (right, top) = (left + w, y0 + head + 0.5 * (room_y - h));
        let bottom = top + h;
        let x = Ruler::new(&across, [0.0, 1.0], 0.0, w / 42.0).placed(left, right);
        let y = Ruler::new(&up, [0.0, 1.0], 0.0, h / 32.0);
        let down = matches!(self.axes, Axes::Section { .. });
        let y = if down { y.placed(top, bottom) } else { y.placed(bottom, top) };

        if !self.title.is_empty() {
            drawing.text([left, top - 6.0 - over], TEXT, Anchor::Start, &self.title);
        }
        frame(drawing, &x, &y, [left, top, right, bottom], [left - labels - 10.0, bottom + foot - 5.0]);
        let picture = match (&self.meaning, scale) {
            (Values::States(states), _) => raster::state_picture(&self.values, states),
            (_, Some(scale)) => {
                let flipped = self.values.slice(ndarray::s![.., ..;-1]).to_owned();
                raster::coloured(if down { &flipped } else { &self.values }, |value| scale.at(value))
            }
            (_, None) => Pixels { size: [0, 0], rgb: vec![] },
        };
        // The slabs of a section are thicker than its cells.
        let smooth = down || self.values.dim().0 > w as usize;
        drawing.image([left, top], [w, h], picture, smooth);
        drawing.rect([left, top], [w, h], Paint::outline(Pen::new(INK, 0.8)));
        for [x, y] in &self.marks {
            let at = [left + w * x / self.size[0], bottom - h * y / self.size[1]];
            drawing.circle(at, 5.0, Paint::outline(Pen::new("#fff", 3.0)));
            drawing.circle(at, 5.0, Paint::outline(Pen::new("#d62728", 1.5)));
        }
        if h > 50.0 && !of_times {
            scale_bar(drawing, [left, bottom], w, self.size[0]);
        }
        if let Some((bar, beyond)) = bar {
            // Beside a strip the bar is longer than the map.
            let more = 0.5 * (room_y.min(110.0) - h).max(0.0);
            let (top, bottom) = (top - more, bottom + more);
            bar.draw(drawing, [right + 8.0, top, bottom]);
            // Values beyond the ends of the colours, above and below the bar.
            let places = [bottom + SMALL + 2.0, top - 4.0];
            for ((value, y), arrow) in beyond.into_iter().zip(places).zip(["↓", "↑"]) {
                if let Some(value) = value {
                    drawing.text([right + 6.0, y], SMALL, Anchor::Start, &format!("{arrow} {value}"));
                }
            }
        }
        if let Values::States(states) = &self.meaning {
            self.names(drawing, states, [left, top], w);
        }
    }

    /// Names of the states with their colours and shares of the area, above the map at the right.
    fn names(&self, drawing: &mut Drawing, states: &[(String, [u8; 3])], [left, top]: [f64; 2], width: f64) {
        let mut right = left + width;
        let shown = |state: &usize| self.values.iter().any(|value| *value == *state as f64);
        for (_, (name, colour)) in states.iter().enumerate().rev().filter(|(state, _)| shown(state)) {
            right -= font::width(name, SMALL);
            drawing.text([right, top - 5.5], SMALL, Anchor::Start, name);
            right -= 11.0;
            let paint = Paint { fill: Some((*colour, 1.0)), pen: Some(Pen::new(INK, 0.4)) };
            drawing.rect([right, top - 12.0], [7.5, 7.5], paint);
            right -= 8.0;
        }
    }
}

/// A round length, in black on white in the lower left corner.
fn scale_bar(drawing: &mut Drawing, [left, bottom]: [f64; 2], width: f64, length: f64) {
    let rough = 0.27 * length;
    let tens = 10f64.powf((rough.log10() + 1e-9).floor());
    let round =
        [5.0, 2.0, 1.0].into_iter().find(|digit| digit * tens <= rough * (1.0 + 1e-9)).unwrap_or(1.0) * tens;
    let unit = shown("m", round);
    let text = format!("{} {}", (round * unit.factor * 1e6).round() / 1e6, unit.text);
    let bar = width * round / length;
    let wide = bar.max(font::width(&text, SMALL)) + 10.0;
    let (x, y) = (left + 5.0, bottom - 5.0);
    drawing.rounded([x, y - SMALL - 12.0], [wide, SMALL + 12.0], 2.0, Paint::fill("#fff", 0.8));
    drawing.rect([x + 0.5 * (wide - bar), y - 7.0], [bar, 3.0], Paint::fill(INK, 1.0));
    drawing.text([x + 0.5 * wide, y - 10.0], SMALL, Anchor::Middle, &text);
}

/// The colour of undefined values, for captions.
pub const UNDEFINED: [u8; 3] = BLANK;
