//! Figures: panels of curves and maps, with units, on paper.
//!
//! ```
//! use asperity_report::figure::{Axis, Curves, Figure, Series, Style};
//!
//! let time: Vec<f64> = (0..=50).map(|i| f64::from(i) * 10.0).collect();
//! let approach: Vec<f64> = time.iter().map(|t| 2e-6 * (1.0 - 0.5 * (-t / 100.0).exp())).collect();
//! let panel = Curves::new("Creep", Axis::linear("time", "s"), Axis::linear("approach", "m"))
//!     .with(Series::new("PMMA", Style::Line, time, approach));
//! let svg = Figure::new("Approach under a constant load").with(panel).to_svg();
//! assert!(svg.contains("approach [µm]"));
//! ```

mod axis;
mod colours;
mod curves;
mod dots;
mod drawing;
mod font;
mod frame;
mod legend;
mod map;
mod outline;
mod paper;
mod pdf;
mod raster;
mod scale;
mod series;
mod svg;
mod words;
mod write;

pub use axis::{Axis, Scale};
pub(crate) use colours::OPEN;
pub use colours::{Colours, Palette};
pub(crate) use curves::COLOURS;
pub use curves::{Beside, Curves, Key};
pub use map::{Axes, Map, State, UNDEFINED, Values};
pub(crate) use raster::{block, means, states};
pub use scale::extent;
pub(crate) use scale::robust;
pub use series::{Series, Style};
pub(crate) use words::typeset;
pub(crate) use write::PANELS;
pub use write::{FigureError, Form};

pub(crate) use drawing::INK;
pub(crate) use drawing::Pixels;
use drawing::{Anchor, Drawing};

/// Sizes of text \[points\].
const TEXT: f64 = 9.0;
const SMALL: f64 = 8.0;
const LARGE: f64 = 11.0;
/// The paper's edge that stays free \[points\].
const EDGE: f64 = 6.0;

/// One part of a figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Panel {
    /// Curves over two axes.
    Curves(Curves),
    /// Values over the area.
    Map(Map),
}

impl Panel {
    pub(crate) fn curves(&self) -> Option<&Curves> {
        if let Panel::Curves(curves) = self { Some(curves) } else { None }
    }

    pub(crate) fn map(&self) -> Option<&Map> {
        if let Panel::Map(map) = self { Some(map) } else { None }
    }
}

impl From<Curves> for Panel {
    fn from(curves: Curves) -> Panel {
        Panel::Curves(curves)
    }
}

impl From<Map> for Panel {
    fn from(map: Map) -> Panel {
        Panel::Map(map)
    }
}

/// Panels in rows, with a title above and a caption below.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The title; may be empty.
    pub title: String,
    /// Sentences below the panels, wrapped to the width; may be empty.
    pub caption: String,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row.
    pub columns: usize,
    /// Width and height of a panel \[points, 1/72 inch\].
    pub panel: [f64; 2],
    /// Width and height of the paper \[points\]; `None` for as much as the panels take.
    pub size: Option<[f64; 2]>,
    /// Texts, lines and panels are drawn so many times as large as told: less than 1 on small paper.
    pub zoom: f64,
}

/// Where a panel lies on the paper \[points\].
struct Place {
    corner: [f64; 2],
    size: [f64; 2],
    margins: Margins,
}

/// What panels need around their frames; those in a column share the width of the numbers and of what is beside them, those in a
/// row the height of titles and legends above the frames, so that the frames are aligned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Margins {
    /// Width of the numbers at the vertical axis \[points\].
    pub(crate) labels: f64,
    /// Width of what is to the right of the frame, where curves below or above are to end with it \[points\].
    pub(crate) beside: f64,
    /// Height of a legend above the frame \[points\].
    pub(crate) legend: f64,
    /// Height of the title above the frame \[points\].
    pub(crate) head: f64,
}

impl Margins {
    /// The larger one of each.
    fn or(self, other: Margins) -> Margins {
        Margins {
            labels: self.labels.max(other.labels),
            beside: self.beside.max(other.beside),
            legend: self.legend.max(other.legend),
            head: self.head.max(other.head),
        }
    }
}

/// Height of a panel's title above its frame \[points\].
fn head(title: &str) -> f64 {
    if title.is_empty() { 8.0 } else { TEXT + 9.0 }
}

impl Figure {
    /// A figure without panels yet; two of them go in a row, each 3.6 by 2.8 inches.
    pub fn new(title: impl Into<String>) -> Figure {
        Figure {
            title: title.into(),
            caption: String::new(),
            panels: Vec::new(),
            columns: 2,
            panel: [259.0, 202.0],
            size: None,
            zoom: 1.0,
        }
    }

    /// The same figure with one more panel.
    pub fn with(mut self, panel: impl Into<Panel>) -> Figure {
        self.panels.push(panel.into());
        self
    }

    /// The same figure with so many panels in a row.
    pub fn columns(self, columns: usize) -> Figure {
        Figure { columns: columns.max(1), ..self }
    }

    /// The same figure with these panels too.
    pub fn with_all(self, panels: impl IntoIterator<Item: Into<Panel>>) -> Figure {
        panels.into_iter().fold(self, Figure::with)
    }

    /// The same figure with panels of this width and height \[points\].
    pub fn panel_size(self, panel: [f64; 2]) -> Figure {
        Figure { panel, ..self }
    }

    /// The same figure with sentences below the panels.
    pub fn caption(self, caption: impl Into<String>) -> Figure {
        Figure { caption: caption.into(), ..self }
    }

    /// The figure as SVG.
    pub fn to_svg(&self) -> String {
        let title = if self.title.is_empty() { "Figure" } else { &self.title };
        svg::write(&self.drawing(), self.paper(), self.zoom, title)
    }

    /// What the figure consists of, before the zoom.
    fn drawing(&self) -> Drawing {
        let mut drawing = Drawing::default();
        let lines = |drawing: &mut Drawing, lines: Vec<String>, top: f64, size: f64| {
            for (n, line) in lines.iter().enumerate() {
                let at = [EDGE + 4.0, top + size + (size + 3.0) * n as f64];
                drawing.text(at, size, Anchor::Start, line);
            }
        };
        lines(&mut drawing, self.title_lines(), EDGE, LARGE);
        let places = self.places();
        for (panel, place) in self.panels.iter().zip(&places) {
            match panel {
                Panel::Curves(curves) => curves.draw(&mut drawing, place),
                Panel::Map(map) => map.draw(&mut drawing, place),
            }
        }
        lines(&mut drawing, self.caption_lines(), self.top() + self.heights().iter().sum::<f64>(), SMALL);
        drawing
    }

    /// Where each panel lies.
    fn places(&self) -> Vec<Place> {
        let (heights, margins) = (self.heights(), self.margins());
        let place = |n: usize| {
            let (row, column) = (n / self.columns, n % self.columns);
            let above: f64 = heights.iter().take(row).sum();
            let corner = [EDGE + column as f64 * self.panel[0], self.top() + above];
            Place { corner, size: [self.panel[0], heights[row]], margins: margins[n] }
        };
        (0..self.panels.len()).map(place).collect()
    }

    /// The height of each row \[points\]: a legend above the frames adds to it, and a row of wide maps takes less.
    fn heights(&self) -> Vec<f64> {
        let margins = self.margins();
        let rows =
            self.panels.chunks(self.columns).zip(margins.chunks(self.columns)).map(|(panels, margins)| {
                let each = panels.iter().zip(margins).map(|(panel, margins)| {
                    let size = [self.panel[0], self.panel[1] + margins.legend];
                    match panel {
                        Panel::Curves(_) => size[1],
                        Panel::Map(map) => map.height(size, *margins),
                    }
                });
                each.fold(0.0, f64::max)
            });
        rows.collect()
    }

    /// The margins of each panel: what its column and its row need. Where a legend fits depends on the margins, so they grow until
    /// every panel has what it needs within them.
    fn margins(&self) -> Vec<Margins> {
        let count = self.panels.len();
        let mut all = vec![Margins::default(); count];
        loop {
            let own: Vec<Margins> = (0..count).map(|n| self.needs(n, all[n]).or(all[n])).collect();
            let of = |n: usize| {
                let rest = |other: &usize| other % self.columns == n % self.columns;
                let column = (0..count).filter(rest).fold(Margins::default(), |most, k| most.or(own[k]));
                let row = n / self.columns * self.columns;
                let row = own[row..count.min(row + self.columns)].iter();
                let row = row.fold(Margins::default(), |most, one| most.or(*one));
                Margins { labels: column.labels, beside: column.beside, ..row }
            };
            let grown: Vec<Margins> = (0..count).map(of).collect();
            if grown == all {
                return all;
            }
            all = grown;
        }
    }

    /// What a panel needs of its margins where it has these already.
    fn needs(&self, n: usize, given: Margins) -> Margins {
        let size = [self.panel[0], self.panel[1] + given.legend];
        match &self.panels[n] {
            Panel::Curves(curves) => curves.needs(size, given),
            Panel::Map(map) => map.needs(self.panel),
        }
    }
}

#[cfg(test)]
mod tests;
