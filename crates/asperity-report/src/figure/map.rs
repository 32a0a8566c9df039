//! A panel of a map: values over the area in colours, with colour bar and scale bar.

use asperity_io::readable::shown;
use ndarray::{Array2, ArrayView2};

use super::colours::{Colours, Palette};
use super::curves::{around, frame};
use super::drawing::{Anchor, Drawing, INK, Paint, Pen, Pixels};
use super::font;
use super::frame::{Layout, NAMES};
use super::raster::{self, BLANK};
use super::scale::{ColourScale, extent};
use super::{Place, SMALL, TEXT};

/// A state of a cell: its name and its colour.
pub type State = (&'static str, [u8; 3]);

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
    },
    /// States 0, 1, 2 ...
    States(&'static [State]),
}

/// A panel of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// A short title over the panel; may be empty.
    pub title: String,
    /// Values at the cell centres (axes x and y: x to the right, y upwards).
    pub values: Array2<f64>,
    /// Least and greatest of the values of all cells, also of those that are shown as means over blocks.
    pub whole: [f64; 2],
    /// What they are.
    pub meaning: Values,
    /// States that hide the values of their cells; state 0, without a name, shows them.
    pub cover: Option<(&'static [State], Array2<f64>)>,
    /// Values at the ends of the colour bar of a quantity; `None` for the least and the greatest.
    pub range: Option<[f64; 2]>,
    /// Lengths of the area along x and y \[m\].
    pub size: [f64; 2],
    /// What its axes are.
    pub axes: Axes,
    /// Places x, y that a circle marks \[m\].
    pub marks: Vec<[f64; 2]>,
    /// Where a line crosses it, along its second axis \[m, of a map over time s\].
    pub line: Option<f64>,
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
        let meaning = Values::Quantity { label: label.into(), unit: unit.into(), colours };
        let whole = extent(values.iter().copied());
        Map { whole, ..Map::of(title.into(), raster::means(values, raster::block(values)), meaning, size) }
    }

    fn of(title: String, values: Array2<f64>, meaning: Values, size: [f64; 2]) -> Map {
        let (axes, marks, whole) = (Axes::Area, vec![], extent(values.iter().copied()));
        Map {
            title,
            values,
            whole,
            meaning,
            cover: None,
            range: None,
            size,
            axes,
            marks,
            line: None,
            palette: None,
            log: false,
        }
    }

    /// The same map over these axes; over the time, its size along the second one is a duration \[s\].
    pub fn over(self, axes: Axes) -> Map {
        Map { axes, ..self }
    }

    /// A map of states.
    pub fn states(
        title: impl Into<String>,
        states: &'static [State],
        values: ArrayView2<f64>,
        size: [f64; 2],
    ) -> Map {
        let values = raster::states(values, raster::block(values));
        Map::of(title.into(), values, Values::States(states), size)
    }

    /// The same map with states that hide the values of their cells, where they are not 0.
    pub fn covered(self, states: &'static [State], cells: ArrayView2<f64>) -> Map {
        Map { cover: Some((states, raster::states(cells, raster::block(cells)))), ..self }
    }

    /// The states that have names, and the cells that they are of.
    pub(super) fn states_of_cells(&self) -> Option<(&'static [State], &Array2<f64>)> {
        match (&self.meaning, &self.cover) {
            (Values::States(states), _) => Some((states, &self.values)),
            (_, Some((states, cells))) => Some((states, cells)),
            _ => None,
        }
    }

    /// The same map with a circle around a place x, y \[m\].
    pub fn marked(mut self, place: [f64; 2]) -> Map {
        self.marks.push(place);
        self
    }

    /// The same map with these values at the ends of its colours.
    pub fn between(self, ends: [f64; 2]) -> Map {
        Map { range: Some(ends), ..self }
    }

    /// How its values become colours; `None` for states.
    pub(super) fn scale(&self) -> Option<ColourScale> {
        let Values::Quantity { colours, .. } = self.meaning else { return None };
        Some(ColourScale::of(&self.values, self.whole, colours, self.palette, self.range, self.log))
    }

    /// The values at the ends of its colours; `None` for states, and where it shows nothing.
    pub(crate) fn ends(&self) -> Option<[f64; 2]> {
        self.scale().filter(|_| !self.shows_nothing()).map(|scale| scale.ends)
    }

    /// Whether no ends of its colours are given and all values are 0; of a pressure by its logarithm whether none is positive.
    pub(super) fn shows_nothing(&self) -> bool {
        let Values::Quantity { colours, .. } = self.meaning else { return false };
        let shows = |value: &f64| match colours.leave_out_zero() {
            true => *value > 0.0 || (*value < 0.0 && !self.log),
            false => *value != 0.0,
        };
        self.range.is_none() && !self.values.iter().any(shows)
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, place: &Place) {
        let layout = Layout::of(self, place);
        let [left, top, right, bottom] = layout.area;
        let [w, h] = [right - left, bottom - top];
        let states = self.states_of_cells();
        if !self.title.is_empty() {
            let over = if states.is_some() { NAMES } else { 0.0 };
            drawing.text([left, top - 6.0 - over], TEXT, Anchor::Start, &self.title);
        }
        frame(drawing, &layout.x, &layout.y, layout.area, layout.titles);
        // The slabs of a section are thicker than its cells.
        let smooth = self.goes_down() || self.values.dim().0 > w as usize;
        drawing.image([left, top], [w, h], self.picture(), smooth);
        drawing.rect([left, top], [w, h], Paint::outline(Pen::new(INK, 0.8)));
        if let Some(place) = self.line {
            let start = if let Axes::Times { start } = self.axes { start } else { 0.0 };
            let y = bottom - h * (place - start) / self.size[1];
            drawing.line([left, y], [right, y], Pen::new("#fff", 2.4));
            drawing.line([left, y], [right, y], Pen::new(INK, 1.0));
        }
        for [x, y] in &self.marks {
            let at = [left + w * x / self.size[0], bottom - h * y / self.size[1]];
            drawing.circle(at, 5.0, Paint::outline(Pen::new("#fff", 3.0)));
            drawing.circle(at, 5.0, Paint::outline(Pen::new("#d62728", 1.5)));
        }
        if h > SCALED && self.keeps_its_shape() && self.stretched().is_none() {
            scale_bar(drawing, [left, bottom], w, self.size[0]);
        }
        // Values beyond the ends of the colours, below and above the bar.
        let [first, last] = layout.bar_ends();
        let places = [last + SMALL + 6.0, first - 7.0];
        for ((value, y), arrow) in layout.beyond.iter().zip(places).zip(["↓", "↑"]) {
            if let Some(value) = value {
                drawing.text([right + 6.0, y], SMALL, Anchor::Start, &format!("{arrow} {value}"));
            }
        }
        if let Some(bar) = layout.bar {
            bar.draw(drawing, [right + 8.0, first, last]);
        }
        if let Some((states, cells)) = states {
            names(drawing, states, cells, [left, top]);
        }
    }

    /// Whether both axes have one scale, but for a narrow area.
    pub(super) fn keeps_its_shape(&self) -> bool {
        !matches!(self.axes, Axes::Times { .. })
    }

    /// A map of two values at most that takes the same room on the paper.
    pub(super) fn thumbnail(&self) -> Map {
        let mut small = Map::of(self.title.clone(), Array2::zeros((1, 1)), self.meaning.clone(), self.size);
        if let (Some(ends), Some(scale)) = (self.ends(), self.scale()) {
            let [low, high] = scale.beyond(&self.values, self.whole);
            small.whole = [low.unwrap_or(ends[0]), high.unwrap_or(ends[1])];
            small.values = ndarray::arr2(&[[small.whole[0]], [small.whole[1]]]);
            small.range = Some(ends);
        } else {
            small.range = self.range;
        }
        let Map { axes, line, palette, log, .. } = *self;
        let cover = self.cover.as_ref().map(|(states, _)| (*states, Array2::zeros(small.values.dim())));
        Map { axes, line, palette, log, cover, marks: self.marks.clone(), ..small }
    }

    /// Left, top, right and bottom of the frame \[points\].
    pub(super) fn frame(&self, place: &Place) -> [f64; 4] {
        Layout::of(self, place).area
    }

    /// Whether titles and names end inside of the panel.
    pub(super) fn has_room_for_words(&self, place: &Place) -> bool {
        let layout = Layout::of(self, place);
        let [left, top, right, bottom] = layout.area;
        let ([x0, y0], [width, height]) = (place.corner, place.size);
        let fits = |text: &str, room: f64| font::width(text, TEXT) <= room;
        let room = x0 + width - left;
        let states = self.states_of_cells().map_or(&[][..], |(states, _)| states);
        let names: f64 = named(states).map(|(_, (name, _))| 19.0 + font::width(name, SMALL)).sum();
        // The title of the map stands above the frame, and that of the bar must not touch it.
        let first = if self.title.is_empty() { y0 } else { top - 4.0 };
        let along = around(layout.bar_ends(), [first, y0 + height]);
        fits(&self.title, room)
            && names <= room
            && fits(&layout.x.title, around([left, right], [x0, x0 + width]))
            && fits(&layout.y.title, around([top, bottom], [y0, y0 + height]))
            && layout.bar.is_none_or(|bar| fits(bar.title(), along))
    }

    /// The map with blocks of cells as one, so that no side has more than `side`.
    pub(super) fn reduced(&self, side: usize) -> Map {
        let (nx, ny) = self.values.dim();
        let by = nx.max(ny).div_ceil(side.max(1)).max(1);
        let values = match self.meaning {
            Values::States(_) => raster::states(self.values.view(), by),
            Values::Quantity { .. } => raster::means(self.values.view(), by),
        };
        Map { values, ..self.clone() }
    }

    /// The values in their colours.
    pub(super) fn picture(&self) -> Pixels {
        let (scale, [nx, ny]) = (self.scale(), self.values.dim().into());
        raster::coloured([nx, ny], |[i, j]| {
            let cell = [i, if self.goes_down() { ny - 1 - j } else { j }];
            let value = self.values[cell];
            let covering = self.cover.as_ref().filter(|(_, cells)| cells[cell] > 0.0);
            let state = match (&self.meaning, covering) {
                (Values::States(states), _) => states.get(value as usize).filter(|_| value.is_finite()),
                (_, Some((states, cells))) => states.get(cells[cell] as usize),
                _ => None,
            };
            let of_value = || scale.map_or(BLANK, |scale| scale.at(value));
            state.map_or_else(of_value, |(_, colour)| *colour)
        })
    }
}

/// The states that have a name, with their numbers.
fn named(states: &[State]) -> impl Iterator<Item = (usize, &State)> {
    states.iter().enumerate().filter(|(_, (name, _))| !name.is_empty())
}

/// Names of the states that occur, with their colours, above the map.
fn names(drawing: &mut Drawing, states: &[State], cells: &Array2<f64>, [left, top]: [f64; 2]) {
    let mut x = left;
    let occurs = |state: usize| cells.iter().any(|cell| *cell == state as f64);
    for (_, (name, colour)) in named(states).filter(|(state, _)| occurs(*state)) {
        let paint = Paint { fill: Some((*colour, 1.0)), pen: Some(Pen::new(INK, 0.4)) };
        drawing.rect([x, top - 12.0], [7.5, 7.5], paint);
        drawing.text([x + 11.0, top - 5.5], SMALL, Anchor::Start, name);
        x += 19.0 + font::width(name, SMALL);
    }
}

/// Least height of a map with a scale bar \[points\]: of a lower one it hides too much.
const SCALED: f64 = 100.0;

/// A round length, in black on white in the lower left corner of a map that has room for it.
fn scale_bar(drawing: &mut Drawing, [left, bottom]: [f64; 2], width: f64, length: f64) {
    let rough = 0.27 * length;
    let tens = 10f64.powf((rough.log10() + 1e-9).floor());
    let round =
        [5.0, 2.0, 1.0].into_iter().find(|digit| digit * tens <= rough * (1.0 + 1e-9)).unwrap_or(1.0) * tens;
    let unit = shown("m", round);
    let text = format!("{} {}", (round * unit.factor * 1e6).round() / 1e6, unit.text);
    let bar = width * round / length;
    let wide = bar.max(font::width(&text, SMALL)) + 10.0;
    if wide + 10.0 > width {
        return;
    }
    let (x, y) = (left + 5.0, bottom - 5.0);
    drawing.rounded([x, y - SMALL - 12.0], [wide, SMALL + 12.0], 2.0, Paint::fill("#fff", 0.8));
    drawing.rect([x + 0.5 * (wide - bar), y - 7.0], [bar, 3.0], Paint::fill(INK, 1.0));
    drawing.text([x + 0.5 * wide, y - 10.0], SMALL, Anchor::Middle, &text);
}

/// The colour of undefined values, for captions.
pub const UNDEFINED: [u8; 3] = BLANK;
