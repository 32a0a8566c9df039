//! Where the frame of a map lies on paper: both axes in one unit and as long as they are in truth, the colour bar beside it.

use asperity_io::readable::{quantity, shown};

use super::axis::{Axis, Ruler};
use super::font;
use super::map::{Axes, Map, Values};
use super::scale::Bar;
use super::{Margins, Place, SMALL, TEXT};

/// Least length of a side of a frame \[points\]: a strip keeps a visible breadth.
const STRIP: f64 = 12.0;
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
        let arrows = beyond.iter().flatten().map(|text| 8.0 + SMALL + font::width(text, SMALL));
        let beside = arrows.fold(bar.as_ref().map_or(0.0, Bar::width), f64::max);
        let [across, up] = axes(map);
        let foot = TEXT + SMALL + 12.0;
        let head = place.margins.head + place.margins.legend;
        let left = x0 + TEXT + place.margins.labels + 13.0;
        let room = [x0 + width - 8.0 - beside - left, height - foot - head];
        let [w, h] = match map.axes {
            Axes::Times { .. } => room,
            _ => {
                let points = (room[0] / map.size[0]).min(room[1] / map.size[1]);
                [0, 1].map(|axis| (map.size[axis] * points).max(STRIP).min(room[axis]))
            }
        };
        let top = y0 + head;
        let (right, bottom) = (left + w, top + h);
        let x = Ruler::new(&across, [0.0, 1.0], 0.0, w / 42.0).placed(left, right);
        let y = Ruler::new(&up, [0.0, 1.0], 0.0, h / 32.0);
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

impl Map {
    /// What the map needs of its margins.
    pub(crate) fn needs(&self, size: [f64; 2]) -> Margins {
        let [_, up] = axes(self);
        let labels = Ruler::new(&up, [0.0, 1.0], 0.0, size[1] / 32.0).widest();
        let legend = if matches!(self.meaning, Values::States(_)) { NAMES } else { 0.0 };
        Margins { labels, legend, head: super::head(&self.title) }
    }

    /// The height that it takes of a panel of this size \[points\]: less than there is where the area is wide.
    pub(crate) fn height(&self, size: [f64; 2], margins: Margins) -> f64 {
        let layout = Layout::of(self, &Place { corner: [0.0; 2], size, margins });
        size[1] - layout.room + (layout.foot() - layout.area[1])
    }

    /// Whether the second axis points downwards.
    pub(super) fn goes_down(&self) -> bool {
        matches!(self.axes, Axes::Section { .. })
    }
}

/// Both axes in their units, which are the same but for time.
fn axes(map: &Map) -> [Axis; 2] {
    let (names, starts) = match map.axes {
        Axes::Area => (["x", "y"], [0.0; 2]),
        Axes::Lags => (["lag x", "lag y"], map.size.map(|side| -0.5 * side)),
        Axes::Section { along, start } => ([along, "depth"], [start, 0.0]),
        Axes::Times { start } => (["x", "time"], [0.0, start]),
    };
    let [over_x, over_y] = [0, 1].map(|axis| (starts[axis] + map.size[axis]).abs());
    let units = match map.axes {
        Axes::Times { .. } => [shown("m", over_x), shown("s", over_y)],
        _ => [(); 2].map(|()| shown("m", over_x.max(over_y))),
    };
    [0, 1].map(|axis| {
        let (unit, start) = (&units[axis], starts[axis]);
        let label = format!("{} [{}]", names[axis], unit.text);
        Axis::linear(label, "").between(start * unit.factor, (start + map.size[axis]) * unit.factor)
    })
}

/// The colour bar, and what lies beyond its ends; none for states, nor where all of the pressure is zero.
fn colours(map: &Map, place: &Place) -> (Option<Bar>, [Option<String>; 2]) {
    let (Values::Quantity { label, unit, .. }, Some(scale)) = (&map.meaning, map.scale()) else {
        return (None, [None, None]);
    };
    if map.shows_no_pressure() {
        return (None, [None, None]);
    }
    let told = |value: Option<f64>| value.map(|value| quantity(value, unit).replace('-', "−"));
    (Some(Bar::new(scale, label, unit, place)), scale.beyond(&map.values).map(told))
}
