//! Where the frame of a map lies on paper: both axes in one unit and as long as they are in truth, the colour bar beside it.

use asperity_io::readable::{Shown, quantity, shown};

use super::axis::{Axis, Ruler, with_power};
use super::font;
use super::map::{Axes, Map, Values};
use super::scale::Bar;
use super::words::typeset;
use super::{Margins, Place, SMALL, TEXT};

/// The longer side of a frame is so many times the shorter one at most: a narrower area is stretched, so that it can be seen.
const STRIP: f64 = 8.0;
/// Least length of a colour bar, where the panel has room for it \[points\].
const BAR: f64 = 96.0;
/// Height of the names of states above the frame \[points\].
pub(super) const NAMES: f64 = SMALL + 6.0;

/// A map laid out.
pub(super) struct Layout {
    pub(super) x: Ruler,
    pub(super) y: Ruler,
    /// Left, top, right and bottom of the frame \[points\].
    pub(super) area: [f64; 4],
    /// Baselines of the vertical and of the horizontal title.
    pub(super) titles: [f64; 2],
    pub(super) bar: Option<Bar>,
    /// Values below and above the colours, in words.
    pub(super) beyond: [Option<String>; 2],
    /// Height of the panel without what is above and below the frame \[points\].
    room: f64,
}

impl Layout {
    pub(super) fn of(map: &Map, place: &Place) -> Layout {
        let ([x0, y0], [width, height]) = (place.corner, place.size);
        let (bar, beyond) = colours(map, place);
        let beside = beside(bar.as_ref(), &beyond);
        let foot = TEXT + SMALL + 12.0;
        let head = place.margins.head + place.margins.legend;
        let left = x0 + TEXT + place.margins.labels + 13.0;
        let room = [x0 + width - beside - left, height - foot - head];
        let [w, h] = match map.axes {
            Axes::Times { .. } => room,
            _ => {
                let sides = drawn(map.size);
                let points = (room[0] / sides[0]).min(room[1] / sides[1]);
                sides.map(|side| side * points)
            }
        };
        let top = y0 + head;
        let (right, bottom) = (left + w, top + h);
        let [(across, x_unit), (up, y_unit)] = axes(map);
        let x = Ruler::exactly(&across, [0.0, 1.0], 0.0, w / 42.0, x_unit).placed(left, right);
        let y = Ruler::exactly(&up, [0.0, 1.0], 0.0, h / 32.0, y_unit);
        let y = if map.goes_down() { y.placed(top, bottom) } else { y.placed(bottom, top) };
        let titles = [left - y.widest() - 10.0, bottom + foot - 5.0];
        Layout { x, y, area: [left, top, right, bottom], titles, bar, beyond, room: room[1] }
    }

    /// Upper and lower end of the colour bar: beside a strip it is longer than the frame, and words about values beyond its colours
    /// have their room above and below it.
    pub(super) fn bar_ends(&self) -> [f64; 2] {
        let room = |words: &Option<String>| if words.is_some() { SMALL + 7.0 } else { 0.0 };
        [self.area[1] + room(&self.beyond[1]), self.foot() - room(&self.beyond[0])]
    }

    /// Lower end of the frame or of the colour bar beside it.
    fn foot(&self) -> f64 {
        let [_, top, _, bottom] = self.area;
        if self.bar.is_some() { bottom.max(top + self.room.min(BAR)) } else { bottom }
    }
}

/// Width of what is to the right of the frame: the colour bar, and the words about values beyond its colours.
fn beside(bar: Option<&Bar>, beyond: &[Option<String>; 2]) -> f64 {
    let arrows = beyond.iter().flatten().map(|text| 8.0 + SMALL + font::width(text, SMALL));
    // No less than curves have there.
    (8.0 + arrows.fold(bar.map_or(0.0, Bar::width), f64::max)).max(12.0)
}

impl Map {
    /// What the map needs of its margins.
    pub(crate) fn needs(&self, size: [f64; 2]) -> Margins {
        let [_, (up, unit)] = axes(self);
        let labels = Ruler::exactly(&up, [0.0, 1.0], 0.0, size[1] / 32.0, unit).widest();
        let legend = if self.states_of_cells().is_some() { NAMES } else { 0.0 };
        let (bar, beyond) = colours(self, &Place { corner: [0.0; 2], size, margins: Margins::default() });
        // An area is as wide as its height lets it.
        let beside = if let Axes::Times { .. } = self.axes { beside(bar.as_ref(), &beyond) } else { 0.0 };
        Margins { labels, beside, legend, head: super::head(&self.title) }
    }

    /// The height that it takes of a panel of this size \[points\]: less than there is where the area is wide.
    pub(crate) fn height(&self, size: [f64; 2], margins: Margins) -> f64 {
        let layout = Layout::of(self, &Place { corner: [0.0; 2], size, margins });
        size[1] - layout.room + (layout.foot() - layout.area[1])
    }

    /// Which axis is stretched, and how many times, of an area that is too narrow to be seen.
    pub(crate) fn stretched(&self) -> Option<(&'static str, f64)> {
        let sides = drawn(self.size);
        let names = match self.axes {
            Axes::Area => ["x", "y"],
            Axes::Lags => ["the lag x", "the lag y"],
            Axes::Section { along, .. } => [along, "the depth"],
            Axes::Times { .. } => return None,
        };
        (0..2)
            .find(|axis| sides[*axis] > self.size[*axis])
            .map(|axis| (names[axis], sides[axis] / self.size[axis]))
    }

    /// Whether the second axis points downwards.
    pub(super) fn goes_down(&self) -> bool {
        matches!(self.axes, Axes::Section { .. })
    }
}

/// The sides of an area as they are drawn.
fn drawn(size: [f64; 2]) -> [f64; 2] {
    let least = size[0].max(size[1]) / STRIP;
    size.map(|side| side.max(least))
}

/// Both axes with their units, which are the same but for time.
fn axes(map: &Map) -> [(Axis, Shown); 2] {
    let (names, starts) = match map.axes {
        Axes::Area => (["x", "y"], [0.0; 2]),
        Axes::Lags => (["lag x", "lag y"], map.size.map(|side| -0.5 * side)),
        Axes::Section { along, start } => ([along, "depth"], [start, 0.0]),
        Axes::Times { start } => (["x", "time"], [0.0, start]),
    };
    let ends = [0, 1].map(|axis| [starts[axis], starts[axis] + map.size[axis]]);
    let [over_x, over_y] = ends.map(|[_, end]| end.abs());
    let unit = |unit: &str, largest: f64| with_power(&shown(unit, largest), largest);
    let units = match map.axes {
        Axes::Times { .. } => [unit("m", over_x), unit("s", over_y)],
        _ => [(); 2].map(|()| unit("m", over_x.max(over_y))),
    };
    let [x, y] = [0, 1].map(|axis| Axis::linear(names[axis], "").between(ends[axis][0], ends[axis][1]));
    let [x_unit, y_unit] = units;
    [(x, x_unit), (y, y_unit)]
}

/// The colour bar, and what lies beyond its ends; none for states, nor where all of the pressure or gap is zero.
fn colours(map: &Map, place: &Place) -> (Option<Bar>, [Option<String>; 2]) {
    let (Values::Quantity { label, unit, .. }, Some(scale)) = (&map.meaning, map.scale()) else {
        return (None, [None, None]);
    };
    if map.shows_nothing() {
        return (None, [None, None]);
    }
    let told = |value: Option<f64>| value.map(|value| typeset(&quantity(value, unit)).replace('-', "−"));
    (Some(Bar::new(scale, label, unit, place)), scale.beyond(&map.values, map.whole).map(told))
}
