//! One figure of several results: curves in the same panels, maps side by side in the same colours.

use asperity_io::store::{At, Reader};

use super::{Options, Plot, PlotError, Rows, figure};
use crate::figure::{Axis, Curves, Figure, Panel, Series, Values};

/// The figure of each result with its name and instant, put together. Panels of curves with the same title become one, with a
/// line of each result; maps stay panels of their own.
///
/// # Errors
/// Those of [`figure`].
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
    for (name, reader, at) in results {
        let own = figure(reader, plot, &Options { at: *at, log, size: None, ..options.clone() })?;
        if !own.caption.is_empty() {
            captions.push(format!("{name}: {}", own.caption));
        }
        (whole.panel, whole.columns) = (own.panel, own.columns.max(whole.columns));
        for panel in own.panels {
            match panel {
                Panel::Curves(curves) => overlay(&mut whole, curves, name),
                Panel::Map(mut map) => {
                    map.title =
                        if map.title.is_empty() { name.clone() } else { format!("{name}: {}", map.title) };
                    whole.panels.push(Panel::Map(map));
                }
            }
        }
    }
    alike(&mut whole);
    let whole = whole.caption(captions.join(" "));
    match options.size {
        Some(size) => Ok(whole.sized(size)?),
        None => Ok(whole),
    }
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

/// Adds the curves of a result to the panel of the same title, axes and units, or as a new panel.
fn overlay(whole: &mut Figure, curves: Curves, name: &str) {
    let named = |series: Series| {
        let name = if series.name.is_empty() { name.to_owned() } else { format!("{name}: {}", series.name) };
        Series { name, ..series }
    };
    let alike = |panel: &&mut Panel| match panel {
        Panel::Curves(other) => {
            let same = |a: &Axis, b: &Axis| a.label == b.label && a.unit == b.unit;
            other.title == curves.title && same(&other.x, &curves.x) && same(&other.y, &curves.y)
        }
        Panel::Map(_) => false,
    };
    match whole.panels.iter_mut().find(alike) {
        Some(Panel::Curves(other)) => {
            for (own, new) in [(&mut other.x, &curves.x), (&mut other.y, &curves.y)] {
                own.range = own.range.zip(new.range).map(|([a, b], [c, d])| [a.min(c), b.max(d)]);
            }
            other.series.extend(curves.series.into_iter().map(named));
        }
        _ => {
            let series = curves.series.into_iter().map(named).collect();
            whole.panels.push(Curves { series, ..curves }.into());
        }
    }
}
