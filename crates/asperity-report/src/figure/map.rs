//! A panel of a map: values over the area in colours, with colour bar and scale bar.

use asperity_io::readable::{quantity, shown};
use ndarray::{Array2, ArrayView2};

use super::axis::{Axis, Ruler};
use super::colours::Colours;
use super::curves::frame;
use super::drawing::{Anchor, Drawing, INK, Paint, Pen, Pixels};
use super::font;
use super::raster::{self, BLANK};
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
}

/// The axes of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// x to the right and y upwards, from 0.
    Area,
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
        }
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

    pub(super) fn draw(&self, drawing: &mut Drawing, place: &Place) {
        let [x0, y0] = place.corner;
        let [width, height] = place.size;
        let bar = match &self.meaning {
            Values::Quantity { label, unit, colours, range } => {
                let whole = extent(&self.values);
                let ends = range.unwrap_or_else(|| colours.ends(robust(&self.values, *colours, whole)));
                let axis = Axis::linear(label.clone(), unit.clone()).between(ends[0], ends[1]);
                let beyond = [0, 1].map(|end| {
                    let out = if end == 0 { whole[0] < ends[0] } else { whole[1] > ends[1] };
                    out.then(|| quantity(whole[end], unit))
                });
                Some((Ruler::new(&axis, ends, 0.0, (height - 2.0 * TEXT) / 32.0), ends, *colours, beyond))
            }
            Values::States(_) => None,
        };
        let bar_labels = bar.as_ref().map_or(0.0, |(ruler, ..)| {
            ruler.ticks.iter().map(|(_, text)| font::width(text, SMALL)).fold(0.0, f64::max)
        });
        let legend = bar.as_ref().map_or(0.0, |_| 8.0 + 10.0 + 6.0 + bar_labels + TEXT + 6.0);
        let foot = TEXT + SMALL + 12.0;
        let head = if self.title.is_empty() { 8.0 } else { TEXT + 9.0 };

        // Both axes in the same unit, and as long on paper as they are in truth; but for time.
        let (names, starts) = match self.axes {
            Axes::Area => (["x", "y"], [0.0; 2]),
            Axes::Section { along, start } => ([along, "depth"], [start, 0.0]),
            Axes::Times { start } => (["x", "time"], [0.0, start]),
        };
        let [over_x, over_y] = [0, 1].map(|axis| starts[axis] + self.size[axis]);
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
            drawing.text([left, top - 6.0], TEXT, Anchor::Start, &self.title);
        }
        frame(drawing, &x, &y, [left, top, right, bottom], [left - labels - 10.0, bottom + foot - 5.0]);
        let picture = match (&self.meaning, &bar) {
            (Values::States(states), _) => raster::state_picture(&self.values, states),
            (_, Some((_, ends, colours, _))) if down => {
                raster::quantity(&self.values.slice(ndarray::s![.., ..;-1]).to_owned(), *ends, *colours)
            }
            (_, Some((_, ends, colours, _))) => raster::quantity(&self.values, *ends, *colours),
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
        if let Some((ruler, ends, colours, beyond)) = bar {
            // Beside a strip the bar is longer than the map.
            let more = 0.5 * (room_y.min(110.0) - h).max(0.0);
            let (top, bottom) = (top - more, bottom + more);
            colour_bar(
                drawing,
                &ruler.placed(bottom, top),
                ends,
                colours,
                [right + 8.0, top, bottom],
                bar_labels,
            );
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
        for (name, colour) in states.iter().rev() {
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

fn colour_bar(
    drawing: &mut Drawing,
    ruler: &Ruler,
    ends: [f64; 2],
    colours: Colours,
    [left, top, bottom]: [f64; 3],
    labels: f64,
) {
    let right = left + 10.0;
    let column = Array2::from_shape_fn((1, 256), |(_, j)| ends[0] + (ends[1] - ends[0]) * j as f64 / 255.0);
    drawing.image([left, top], [10.0, bottom - top], raster::quantity(&column, ends, colours), true);
    drawing.rect([left, top], [10.0, bottom - top], Paint::outline(Pen::new(INK, 0.6)));
    for (value, text) in &ruler.ticks {
        if let Some(at) = ruler.place(*value) {
            drawing.line([right, at], [right + 3.0, at], Pen::new(INK, 0.7));
            drawing.text([right + 5.0, at + 0.36 * SMALL], SMALL, Anchor::Start, text);
        }
    }
    drawing.upward_text([right + 5.0 + labels + TEXT + 1.0, 0.5 * (top + bottom)], TEXT, &ruler.title);
}

/// Share of the values that may lie beyond either end of the colours.
const OUTLIERS: f64 = 1e-3;

/// The range of the colours: least and greatest value, or the quantiles at a thousandth and at all but a thousandth where a few
/// pits or spikes would take more than a third of the colours.
fn robust(values: &Array2<f64>, colours: Colours, whole: [f64; 2]) -> [f64; 2] {
    if !matches!(colours, Colours::Sequential | Colours::Diverging) {
        return whole;
    }
    let mut finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let last = finite.len().saturating_sub(1);
    let few = (OUTLIERS * last as f64).ceil() as usize;
    if last < 1000 {
        return whole;
    }
    let low = *finite.select_nth_unstable_by(few, f64::total_cmp).1;
    let high = *finite.select_nth_unstable_by(last - few, f64::total_cmp).1;
    if high > low && whole[1] - whole[0] > 1.5 * (high - low) { [low, high] } else { whole }
}

/// Least and greatest of the finite values.
fn extent(values: &Array2<f64>) -> [f64; 2] {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// The colour of undefined values, for captions.
pub const UNDEFINED: [u8; 3] = BLANK;
