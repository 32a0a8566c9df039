//! One figure of several results: curves in the same panels, maps side by side, in the same colours where one scale suits
//! them. Each result has a colour, each quantity of a panel a style of line. Panels over time and panels over velocity are
//! separate, each with an axis of its own.

use asperity_io::store::{At, Reader};

use super::{NO_CONTACT, Options, Plot, PlotError, finished, panels};
use crate::figure::{
    Axis, COLOURS, Curves, Figure, FigureError, INK, Map, PANELS, Palette, Panel, Scale, Series, Style,
    Values,
};

/// The figure of each result with its name and instant, put together. Panels of curves with the same title become one, with a
/// line of each result; maps stay panels of their own.
///
/// # Errors
/// Those of [`figure`](super::figure()).
pub fn together(
    results: &[(String, Reader, At)],
    plot: Plot,
    options: &Options,
) -> Result<Figure, PlotError> {
    let mut whole = Figure::new(options.title.clone().unwrap_or_default());
    let mut captions = vec![];
    let mut all: Vec<Together> = vec![];
    for (n, (name, reader, at)) in results.iter().enumerate() {
        let colour = colour(n, results.len());
        let own = panels(reader, plot, &Options { at: *at, ..options.clone() })?;
        let maps = own.panels.iter().filter_map(Panel::map).count() * results.len();
        if maps > PANELS {
            return Err(FigureError::Panels { found: maps }.into());
        }
        if !own.caption.is_empty() {
            captions.push(format!("{name}: {}", own.caption));
        }
        (whole.panel, whole.columns) = (own.panel, own.columns);
        for panel in own.panels {
            match panel {
                Panel::Curves(mut curves) => {
                    // The caption says it, and the curves of all results stay in one panel.
                    if curves.title.starts_with(NO_CONTACT) {
                        curves.title.clear();
                    }
                    match all.iter_mut().find(|other| other.is_like(&curves)) {
                        Some(other) => other.add(curves, name, &colour),
                        None => {
                            // A place in the figure, which is filled when all results are in.
                            let empty = Curves { series: vec![], ..curves.clone() };
                            let mut new = Together::new(empty, whole.panels.len());
                            whole.panels.push(new.panel.clone().into());
                            new.add(curves, name, &colour);
                            all.push(new);
                        }
                    }
                }
                Panel::Map(mut map) => {
                    map.title =
                        if map.title.is_empty() { name.clone() } else { format!("{name}: {}", map.title) };
                    whole.panels.push(Panel::Map(map));
                }
            }
        }
    }
    for one in all {
        if one.results.len() > MOST {
            return Err(PlotError::Refused(format!(
                "the figure {} is for at most {MOST} results, but {} are given; give fewer",
                plot.name(),
                one.results.len()
            )));
        }
        let place = one.place;
        whole.panels[place] = one.finished().into();
    }
    let colours = alike(&mut whole);
    finished(whole.caption(captions.join(" ") + colours), options)
}

/// Ranges of maps that differ by more than this factor have no common colours: the smaller ones would be one colour.
const COMMON: f64 = 10.0;

/// Gives the maps of a quantity the same colours where their ranges are of one size, and says which it is; empty for one map and
/// none.
fn alike(whole: &mut Figure) -> &'static str {
    let ends = |map: &Map| match &map.meaning {
        Values::Quantity { label, .. } => map.ends().map(|ends| (label.clone(), ends)),
        Values::States(_) => None,
    };
    let maps = whole.panels.iter().filter_map(Panel::map);
    let all: Vec<(String, [f64; 2])> = maps.filter_map(ends).collect();
    if all.len() < 2 {
        return "";
    }
    let sizes = || all.iter().map(|(_, [low, high])| low.abs().max(high.abs())).filter(|size| *size > 0.0);
    if sizes().fold(0.0, f64::max) > COMMON * sizes().fold(f64::INFINITY, f64::min) {
        return " Each map has colours of its own.";
    }
    for panel in &mut whole.panels {
        if let Panel::Map(map) = panel
            && let Values::Quantity { label, .. } = &map.meaning
        {
            let same = all.iter().filter(|(other, _)| other == label).map(|(_, ends)| *ends);
            map.range = same.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        }
    }
    " The maps have the same colours."
}

/// Results in one panel at most: of more the names take more room than the curves.
const MOST: usize = 48;

/// The colour of a result by its number among `count`: one that nobody mixes up with another or, of more results than there are such
/// colours, one of a scale from the first result (dark) to the last (bright).
pub(crate) fn colour(n: usize, count: usize) -> String {
    /// The brightest colours are hard to see on white.
    const BRIGHTEST: f64 = 0.9;
    if count <= COLOURS.len() {
        return COLOURS[n % COLOURS.len()].to_owned();
    }
    let [r, g, b] = Palette::Viridis.at(BRIGHTEST * n as f64 / (count - 1) as f64);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A panel of curves of several results.
struct Together {
    panel: Curves,
    /// Its number in the figure.
    place: usize,
    /// Names and colours of the results in it.
    results: Vec<(String, String)>,
    /// Names and styles of the quantities.
    quantities: Vec<(String, Style)>,
}

impl Together {
    fn new(panel: Curves, place: usize) -> Together {
        Together { panel, place, results: vec![], quantities: vec![] }
    }

    /// Whether curves belong here: the same title, axes and units.
    fn is_like(&self, curves: &Curves) -> bool {
        let same = |a: &Axis, b: &Axis| a.label == b.label && a.unit == b.unit;
        self.panel.title == curves.title && same(&self.panel.x, &curves.x) && same(&self.panel.y, &curves.y)
    }

    /// Adds the curves of a result.
    fn add(&mut self, curves: Curves, name: &str, colour: &str) {
        join(&mut self.panel.x, &curves.x);
        join(&mut self.panel.y, &curves.y);
        self.results.push((name.to_owned(), colour.to_owned()));
        for series in curves.series {
            let style = self.style(&series);
            let plain = Series { name: String::new(), style, ..series };
            self.panel.series.push(plain.in_colour(colour));
        }
    }

    /// The style of a quantity: the one that it has already, or the next. One without a name is the only one of its result.
    fn style(&mut self, series: &Series) -> Style {
        if series.name.is_empty() {
            return series.style;
        }
        if let Some((_, style)) = self.quantities.iter().find(|(name, _)| *name == series.name) {
            return *style;
        }
        let among = |of: &[Style]| {
            let before = self.quantities.iter().filter(|(_, style)| of.contains(style)).count();
            of[before % of.len()]
        };
        let style = match series.style {
            Style::Bars | Style::Reference => series.style,
            style if style.is_of_points() => among(&Style::SIGNS),
            _ => among(&Style::LINES),
        };
        self.quantities.push((series.name.clone(), style));
        style
    }

    /// The panel with its legend: the results in their colours and, where there are several quantities, their styles in black.
    fn finished(self) -> Curves {
        let entry =
            |name: String, style, colour: &str| Series::new(name, style, vec![], vec![]).in_colour(colour);
        let several = self.quantities.len() > 1;
        let only = self.panel.series.first().map_or(Style::Line, |series| series.style);
        let of_result = if several { Style::Line } else { only };
        let results = self.results.into_iter().map(|(name, colour)| entry(name, of_result, &colour));
        let quantities = self.quantities.into_iter().filter(|_| several);
        let quantities = quantities.map(|(name, style)| entry(name, style, INK));
        let legend: Vec<Series> = results.chain(quantities).collect();
        legend.into_iter().fold(self.panel, Curves::with)
    }
}

/// Makes one axis of two: logarithmic where one of them is, from the first to the last of their ends.
fn join(own: &mut Axis, new: &Axis) {
    if new.scale == Scale::Log {
        own.scale = Scale::Log;
    }
    let scale = own.scale;
    let shows = |end: f64| scale == Scale::Linear || end > 0.0;
    own.range = own.range.zip(new.range).map(|([a, b], [c, d])| {
        let first = [a, c].into_iter().filter(|end| shows(*end)).fold(f64::INFINITY, f64::min);
        [first, b.max(d)]
    });
    own.exact &= own.range.is_some();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(names: &[&str]) -> Curves {
        let series = |name: &&str| Series::new(*name, Style::Line, vec![0.0, 1.0], vec![0.0, 1.0]);
        let empty = Curves::new("Pressure", Axis::linear("time", "s"), Axis::linear("pressure", "Pa"));
        names.iter().map(series).fold(empty, Curves::with)
    }

    #[test]
    fn a_result_has_one_colour_and_a_quantity_one_style() {
        let mut both = Together::new(panel(&[]), 0);
        both.add(panel(&["mean", "largest"]), "a", COLOURS[0]);
        both.add(panel(&["largest", "least"]), "b", COLOURS[1]);
        assert!(both.is_like(&panel(&[])));
        let series = both.finished().series;
        let drawn: Vec<(&str, Style)> =
            series[..4].iter().map(|s| (s.colour.as_deref().unwrap(), s.style)).collect();
        let [line, dashed, dotted] = [Style::Line, Style::Dashed, Style::Dotted];
        let expected = [(COLOURS[0], line), (COLOURS[0], dashed), (COLOURS[1], dashed), (COLOURS[1], dotted)];
        assert_eq!(drawn, expected);
        let names: Vec<&str> = series[4..].iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names, ["a", "b", "mean", "largest", "least"]);
    }

    #[test]
    fn results_with_one_quantity_have_no_styles_to_tell() {
        let mut both = Together::new(panel(&[]), 0);
        both.add(panel(&[""]), "a", COLOURS[0]);
        both.add(panel(&[""]), "b", COLOURS[1]);
        let names: Vec<String> = both.finished().series.into_iter().map(|s| s.name).collect();
        assert_eq!(names, ["", "", "a", "b"]);
    }

    #[test]
    fn every_result_of_a_panel_looks_different() {
        let mut all = Together::new(panel(&[]), 0);
        (0..MOST).for_each(|n| all.add(panel(&["mean", "largest"]), &n.to_string(), &colour(n, MOST)));
        let legend = all.finished().series.split_off(2 * MOST);
        let colours: Vec<_> = legend[..MOST].iter().map(|s| s.colour.clone()).collect();
        assert!((1..MOST).all(|n| !colours[..n].contains(&colours[n])));
        // Few results have colours that nobody mixes up.
        assert!((0..7).all(|n| colour(n, 7) == COLOURS[n]));
    }

    #[test]
    fn an_axis_is_logarithmic_where_one_of_its_results_asks_for_it() {
        let mut axis = Axis::linear("time", "s").between(0.0, 5.0);
        join(&mut axis, &Axis::log("time", "s").between(1e-3, 2.0));
        assert_eq!((axis.scale, axis.range), (Scale::Log, Some([1e-3, 5.0])));
        let sweep = Curves::new("Pressure", Axis::log("velocity", "m/s"), Axis::linear("pressure", "Pa"));
        assert!(!Together::new(panel(&[]), 0).is_like(&sweep));
    }
}
