//! One figure of several results: curves in the same panels, maps side by side in the same colours. Each result has a colour, each
//! quantity of a panel a style of line.

use asperity_io::store::{At, Reader};

use super::{Options, Plot, PlotError, Rows, finished, panels};
use crate::figure::{Axis, COLOURS, Curves, Figure, INK, Panel, Series, Style, Values};

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
    let mut log = options.log;
    for (_, reader, _) in results {
        // One axis for all: logarithmic where one of them asks for it.
        log = log.or(Rows::of(reader)?.log.then_some(true));
    }
    let mut whole = Figure::new(options.title.clone().unwrap_or_default());
    let mut captions = vec![];
    let mut all: Vec<Together> = vec![];
    for ((name, reader, at), colour) in results.iter().zip(COLOURS.iter().cycle()) {
        let own = panels(reader, plot, &Options { at: *at, log, ..options.clone() })?;
        if !own.caption.is_empty() {
            captions.push(format!("{name}: {}", own.caption));
        }
        (whole.panel, whole.columns) = (own.panel, own.columns);
        for panel in own.panels {
            match panel {
                Panel::Curves(curves) => match all.iter_mut().find(|other| other.is_like(&curves)) {
                    Some(other) => other.add(curves, name, colour),
                    None => {
                        // A place in the figure, which is filled when all results are in.
                        let empty = Curves { series: vec![], ..curves.clone() };
                        let mut new = Together::new(empty, whole.panels.len());
                        whole.panels.push(new.panel.clone().into());
                        new.add(curves, name, colour);
                        all.push(new);
                    }
                },
                Panel::Map(mut map) => {
                    map.title =
                        if map.title.is_empty() { name.clone() } else { format!("{name}: {}", map.title) };
                    whole.panels.push(Panel::Map(map));
                }
            }
        }
    }
    for one in all {
        let place = one.place;
        whole.panels[place] = one.finished().into();
    }
    alike(&mut whole);
    finished(whole.caption(captions.join(" ")), options)
}

/// Gives the maps of a quantity the same colours.
fn alike(whole: &mut Figure) {
    let ends = |panel: &Panel| match panel {
        Panel::Map(map) => match &map.meaning {
            Values::Quantity { label, .. } => map.ends().map(|ends| (label.clone(), ends)),
            Values::States(_) => None,
        },
        Panel::Curves(_) => None,
    };
    let all: Vec<(String, [f64; 2])> = whole.panels.iter().filter_map(ends).collect();
    for panel in &mut whole.panels {
        if let Panel::Map(map) = panel
            && let Values::Quantity { label, range, .. } = &mut map.meaning
        {
            let same = all.iter().filter(|(other, _)| other == label).map(|(_, ends)| *ends);
            *range = same.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        }
    }
}

/// A panel of curves of several results.
struct Together {
    panel: Curves,
    /// Its number in the figure.
    place: usize,
    /// Names and colours of the results in it.
    results: Vec<(String, &'static str)>,
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
    fn add(&mut self, curves: Curves, name: &str, colour: &'static str) {
        for (own, new) in [(&mut self.panel.x, &curves.x), (&mut self.panel.y, &curves.y)] {
            own.range = own.range.zip(new.range).map(|([a, b], [c, d])| [a.min(c), b.max(d)]);
        }
        self.results.push((name.to_owned(), colour));
        for series in curves.series {
            let style = self.style(&series);
            self.panel.series.push(Series { name: String::new(), style, ..series }.in_colour(colour));
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
        let results = self.results.into_iter().map(|(name, colour)| entry(name, of_result, colour));
        let quantities = self.quantities.into_iter().filter(|_| several);
        let quantities = quantities.map(|(name, style)| entry(name, style, INK));
        let legend: Vec<Series> = results.chain(quantities).collect();
        legend.into_iter().fold(self.panel, Curves::with)
    }
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
        both.add(panel(&["mean", "largest"]), "a", "#111111");
        both.add(panel(&["largest", "least"]), "b", "#222222");
        assert!(both.is_like(&panel(&[])));
        let series = both.finished().series;
        let drawn: Vec<(&str, Style)> =
            series[..4].iter().map(|s| (s.colour.as_deref().unwrap(), s.style)).collect();
        let [line, dashed, dotted] = [Style::Line, Style::Dashed, Style::Dotted];
        let expected = [("#111111", line), ("#111111", dashed), ("#222222", dashed), ("#222222", dotted)];
        assert_eq!(drawn, expected);
        let names: Vec<&str> = series[4..].iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names, ["a", "b", "mean", "largest", "least"]);
    }

    #[test]
    fn results_with_one_quantity_have_no_styles_to_tell() {
        let mut both = Together::new(panel(&[]), 0);
        both.add(panel(&[""]), "a", "#111111");
        both.add(panel(&[""]), "b", "#222222");
        let names: Vec<String> = both.finished().series.into_iter().map(|s| s.name).collect();
        assert_eq!(names, ["", "", "a", "b"]);
    }
}
