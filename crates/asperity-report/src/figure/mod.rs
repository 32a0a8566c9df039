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
mod legend;
mod map;
mod pdf;
mod raster;
mod svg;
mod write;

pub use axis::{Axis, Scale};
pub use colours::Colours;
pub(crate) use colours::OPEN;
pub use curves::{Curves, Series, Style};
pub use map::{Axes, Map, UNDEFINED, Values};
pub(crate) use raster::{means, states};
pub use write::{FigureError, Form};

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
}

/// Where a panel lies on the paper \[points\].
struct Place {
    corner: [f64; 2],
    size: [f64; 2],
    margins: Margins,
}

/// What panels of curves need around their frames; those in a column share the width of the numbers, those in a row the height of
/// legends above the frames, so that the frames are aligned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Margins {
    /// Width of the numbers at the vertical axis \[points\].
    labels: f64,
    /// Height of a legend above the frame \[points\].
    legend: f64,
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

    /// The same figure with sentences below the panels.
    pub fn caption(self, caption: impl Into<String>) -> Figure {
        Figure { caption: caption.into(), ..self }
    }

    /// The figure as SVG.
    pub fn to_svg(&self) -> String {
        let title = if self.title.is_empty() { "Figure" } else { &self.title };
        svg::write(&self.drawing(), self.paper(), title)
    }

    /// What the figure consists of.
    fn drawing(&self) -> Drawing {
        let mut drawing = Drawing::default();
        let heights = self.heights();
        let [_, height] = self.paper();
        let top = self.top();
        if !self.title.is_empty() {
            drawing.text([EDGE + 4.0, EDGE + LARGE], LARGE, Anchor::Start, &self.title);
        }
        for (n, panel) in self.panels.iter().enumerate() {
            let (row, column) = (n / self.columns, n % self.columns);
            let margins = self.margins(row, column);
            let above: f64 = heights.iter().take(row).sum();
            let corner = [EDGE + column as f64 * self.panel[0], top + above];
            let place = Place { corner, size: [self.panel[0], heights[row]], margins };
            match panel {
                Panel::Curves(curves) => curves.draw(&mut drawing, &place),
                Panel::Map(map) => map.draw(&mut drawing, &place),
            }
        }
        let caption = self.wrapped();
        let first = height - EDGE - (SMALL + 3.0) * caption.len() as f64 + SMALL;
        for (n, line) in caption.iter().enumerate() {
            let at = [EDGE + 4.0, first + (SMALL + 3.0) * n as f64];
            drawing.text(at, SMALL, Anchor::Start, line);
        }
        drawing
    }

    /// The height of each row \[points\]: a legend above the frames adds to it.
    fn heights(&self) -> Vec<f64> {
        let rows = self.panels.len().div_ceil(self.columns).max(1);
        (0..rows).map(|row| self.panel[1] + self.margins(row, 0).legend).collect()
    }

    /// The margins of the panels in this row and column.
    fn margins(&self, row: usize, column: usize) -> Margins {
        let mut margins = Margins::default();
        for (n, panel) in self.panels.iter().enumerate() {
            let Panel::Curves(curves) = panel else { continue };
            let own = curves.needs(self.panel);
            if n % self.columns == column {
                margins.labels = margins.labels.max(own.labels);
            }
            if n / self.columns == row {
                margins.legend = margins.legend.max(own.legend);
            }
        }
        margins
    }

    /// Width and height of the paper \[points\].
    fn paper(&self) -> [f64; 2] {
        let columns = self.columns.min(self.panels.len().max(1));
        let caption = self.wrapped().len() as f64 * (SMALL + 3.0);
        let title = if self.title.is_empty() { 0.0 } else { font::width(&self.title, LARGE * 1.12) + 8.0 };
        let width = (columns as f64 * self.panel[0]).max(title.min(columns as f64 * self.panel[0] * 1.5));
        [width + 2.0 * EDGE, self.top() + self.heights().iter().sum::<f64>() + caption + EDGE]
    }

    fn top(&self) -> f64 {
        if self.title.is_empty() { EDGE } else { EDGE + LARGE + 9.0 }
    }

    /// The caption in lines that fit.
    fn wrapped(&self) -> Vec<String> {
        let room = self.columns.min(self.panels.len().max(1)) as f64 * self.panel[0] - 8.0;
        let mut lines: Vec<String> = Vec::new();
        for word in self.caption.split_whitespace() {
            match lines.last_mut() {
                Some(line) if font::width(line, SMALL) + font::width(word, SMALL) + 3.0 <= room => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests;
