//! The paper of a figure: as large as its panels, or of a given size that its panels fill.
//!
//! Where panels would have no room for their frames or their words, fewer or more of them go in a row, or all is drawn smaller.

use super::{EDGE, Figure, FigureError, LARGE, Panel, Place, SMALL, words};

/// So many times as large as usual texts may be: titles of panels have 9 to 4.5 points then.
const ZOOMS: [f64; 9] = [1.0, 0.94, 0.88, 0.82, 0.76, 0.7, 0.625, 0.56, 0.5];
/// Largest paper that is told to be large enough, in sizes asked for.
const MOST: f64 = 50.0;

impl Figure {
    /// The same figure on paper of this width and height \[points\], with panels that fill it.
    ///
    /// # Errors
    /// [`FigureError::Size`] where panels would be too small to read; [`FigureError::Panels`] and [`FigureError::Title`] where there
    /// are too many panels or letters.
    pub fn sized(self, size: [f64; 2]) -> Result<Figure, FigureError> {
        self.check()?;
        // Many arrangements are tried, and of maps only the ends of their values matter.
        let panels = self.panels.iter().map(|panel| match panel {
            Panel::Map(map) => Panel::Map(map.thumbnail()),
            Panel::Curves(curves) => Panel::Curves(curves.clone()),
        });
        let small = Figure {
            panels: panels.collect(),
            title: self.title.clone(),
            caption: self.caption.clone(),
            ..self
        };
        let whole = small.whole(&small.places());
        match small.filling(size, whole) {
            Some(Figure { columns, panel, size, zoom, .. }) => {
                Ok(Figure { columns, panel, size, zoom, ..self })
            }
            None => {
                let larger = |by: &f64| size.map(|side| side * by);
                let grown: Vec<f64> = (1..).map(|n| 1.05f64.powi(n)).take_while(|by| *by < MOST).collect();
                let first = grown.partition_point(|by| small.filling(larger(by), whole).is_none());
                let by = grown.get(first).unwrap_or(&MOST);
                Err(FigureError::Size { asked: size, needed: larger(by) })
            }
        }
    }

    /// Number of panels at these places that have their words whole.
    pub(super) fn whole(&self, places: &[Place]) -> usize {
        self.panels.iter().zip(places).filter(|(panel, place)| panel.has_room_for_words(place)).count()
    }

    /// The figure that fills paper of this size with so many panels that have their words whole, or more; of these the one whose
    /// panels are most like those of the figure, with the largest texts.
    fn filling(&self, size: [f64; 2], whole: usize) -> Option<Figure> {
        let panels = self.panels.len().max(1);
        let own = self.columns.min(panels);
        let with = |columns: Vec<usize>| {
            ZOOMS.into_iter().flat_map(move |zoom| columns.clone().into_iter().map(move |n| (n, zoom)))
        };
        // More panels in a row than usual come last: the figure is no longer what its caption may describe.
        let all = with((1..=own).rev().collect()).chain(with((own + 1..=panels).collect()));
        let mut filled = all.filter_map(|(columns, zoom)| self.filled(size, columns, zoom));
        filled.find(|figure| figure.whole(&figure.places()) >= whole)
    }

    /// With so many panels in a row and this zoom; `None` where its frames are too small.
    fn filled(&self, size: [f64; 2], columns: usize, zoom: f64) -> Option<Figure> {
        let mut figure = Figure { columns, zoom, size: Some(size), ..self.clone() };
        let [width, height] = size.map(|side| side / zoom);
        let rows = figure.panels.len().div_ceil(columns).max(1) as f64;
        figure.panel[0] = (width - 2.0 * EDGE) / columns as f64;
        // Where a legend stands depends on the height of its panel, and wide maps take less than they are given.
        for _ in 0..16 {
            let before = figure.panel[1];
            figure.panel[1] = (before + (height - figure.needed()[1]) / rows).max(LOWEST);
            if figure.panel[1] == before {
                break;
            }
        }
        let fits = figure.needed()[1] <= height + 0.5;
        let frames = || figure.panels.iter().zip(figure.places());
        (fits && frames().all(|(panel, place)| panel.has_room_for_frame(&place))).then_some(figure)
    }

    /// Width and height of the paper \[points\].
    pub(crate) fn paper(&self) -> [f64; 2] {
        self.size.unwrap_or_else(|| self.needed().map(|side| side * self.zoom))
    }

    /// Width and height that title, panels and caption take before the zoom \[points\].
    fn needed(&self) -> [f64; 2] {
        let caption = self.caption_lines().len() as f64 * (SMALL + 3.0);
        let height = self.top() + self.heights().iter().sum::<f64>() + caption + EDGE;
        [self.width() + 2.0 * EDGE, height]
    }

    /// Width of all panels of a row \[points\].
    fn width(&self) -> f64 {
        self.columns.min(self.panels.len().max(1)) as f64 * self.panel[0]
    }

    /// Where the panels begin \[points\].
    pub(super) fn top(&self) -> f64 {
        match self.title_lines().len() {
            0 => EDGE,
            lines => EDGE + (LARGE + 3.0) * lines as f64 + 6.0,
        }
    }

    /// The title in lines that fit.
    pub(super) fn title_lines(&self) -> Vec<String> {
        words::lines(&self.title, LARGE, self.width() - 8.0)
    }

    /// The caption in lines that fit.
    pub(super) fn caption_lines(&self) -> Vec<String> {
        words::lines(&words::typeset(&self.caption), SMALL, self.width() - 8.0)
    }
}

/// Least height of a panel while its height is sought \[points\].
const LOWEST: f64 = 40.0;
/// Least width and height of a frame \[points\]: less has no room for two numbers at each axis.
const FRAME: [f64; 2] = [42.0, 26.0];
/// Least length of the longer side of a map that keeps its shape \[points\].
const SIDE: f64 = 42.0;

impl Panel {
    fn has_room_for_frame(&self, place: &Place) -> bool {
        let [left, top, right, bottom] = match self {
            Panel::Curves(curves) => curves.frame(place),
            Panel::Map(map) => map.frame(place),
        };
        let [width, height] = [right - left, bottom - top];
        match self {
            Panel::Map(map) if map.keeps_its_shape() => width.max(height) >= SIDE,
            _ => width >= FRAME[0] && height >= FRAME[1],
        }
    }

    fn has_room_for_words(&self, place: &Place) -> bool {
        match self {
            Panel::Curves(curves) => curves.has_room_for_words(place),
            Panel::Map(map) => map.has_room_for_words(place),
        }
    }
}
