//! The same axes and colours in several figures, so that they can be compared and follow one another as frames.

use asperity_io::store::{At, Reader};

use super::{Options, Plot, PlotError, figure};
use crate::figure::{Curves, Figure, Map, Margins, Panel, Values};

/// What figures of the same panels have in common.
#[derive(Clone, Debug, Default)]
pub(crate) struct Common {
    /// By the place of the panel; at one place different figures may show different quantities.
    panels: Vec<Vec<Shared>>,
    paper: [f64; 2],
}

/// Of a panel: what it shows, the ends of its axes or of its colours, and what any of the figures has above the frame.
#[derive(Clone, Debug)]
struct Shared {
    label: String,
    across: [f64; 2],
    up: [f64; 2],
    names_above: bool,
    titled: bool,
}

/// No end yet.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl Common {
    /// Takes in one more figure.
    pub(crate) fn add(&mut self, figure: &Figure) {
        self.panels.resize(self.panels.len().max(figure.panels.len()), vec![]);
        for (panel, known) in figure.panels.iter().zip(&mut self.panels) {
            let label = label(panel).to_owned();
            let own = match panel {
                Panel::Map(map) => Shared {
                    label,
                    across: NOTHING,
                    up: map.ends().unwrap_or(NOTHING),
                    names_above: false,
                    titled: !map.title.is_empty(),
                },
                Panel::Curves(curves) => {
                    let [across, up] = curves.ends();
                    let names_above = curves.needs(figure.panel, Margins::default()).legend > 0.0;
                    Shared { label, across, up, names_above, titled: !curves.title.is_empty() }
                }
            };
            match known.iter_mut().find(|shared| shared.label == own.label) {
                Some(shared) => shared.join(own),
                None => known.push(own),
            }
        }
        let paper = figure.paper();
        self.paper = [0, 1].map(|side| self.paper[side].max(paper[side]));
    }

    /// Gives a figure the common axes, colours and paper.
    pub(crate) fn apply(&self, figure: &mut Figure) {
        for (panel, known) in figure.panels.iter_mut().zip(&self.panels) {
            let Some(shared) = known.iter().find(|shared| shared.label == label(panel)) else { continue };
            // A blank title keeps the frame where that of the others is.
            let (Panel::Map(Map { title, .. }) | Panel::Curves(Curves { title, .. })) = panel;
            if title.is_empty() && known.iter().any(|shared| shared.titled) {
                title.push(' ');
            }
            match panel {
                Panel::Map(map) => {
                    map.range = range_of(shared.up).or(map.range);
                }
                Panel::Curves(curves) => {
                    curves.names_above |= shared.names_above;
                    curves.x.range = range_of(shared.across).or(curves.x.range);
                    curves.y.range = range_of(shared.up).or(curves.y.range);
                }
            }
        }
        figure.size = figure.size.or(Some(self.paper));
    }
}

impl Shared {
    fn join(&mut self, other: Shared) {
        let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.across = join(self.across, other.across);
        self.up = join(self.up, other.up);
        self.names_above |= other.names_above;
        self.titled |= other.titled;
    }
}

/// The quantity that a panel shows; of states nothing.
fn label(panel: &Panel) -> &str {
    match panel {
        Panel::Curves(curves) => &curves.y.label,
        Panel::Map(Map { meaning: Values::Quantity { label, .. }, .. }) => label,
        Panel::Map(_) => "",
    }
}

fn range_of(ends: [f64; 2]) -> Option<[f64; 2]> {
    (ends[0] < ends[1] && ends.iter().all(|end| end.is_finite())).then_some(ends)
}

/// The ends of the colours that hold the values of all stored instants of all results; `None` where nothing is stored.
///
/// # Errors
/// Those of [`figure`].
pub fn common_limits(
    results: &[&Reader],
    plot: Plot,
    options: &Options,
) -> Result<Option<[f64; 2]>, PlotError> {
    let mut ends = NOTHING;
    for reader in results {
        let count = if plot == Plot::InitialGap { 1 } else { reader.field_times().len() };
        for n in 0..count {
            let at = if plot == Plot::InitialGap { At::Last } else { At::Index(n) };
            let figure = figure(reader, plot, &Options { at, size: None, ..options.clone() })?;
            for panel in &figure.panels {
                let own = match panel {
                    Panel::Map(map) => map.ends(),
                    Panel::Curves(curves) if plot.unit() == Some(curves.y.unit.as_str()) => {
                        Some(curves.ends()[1])
                    }
                    Panel::Curves(_) => None,
                };
                if let Some([low, high]) = own {
                    ends = [ends[0].min(low), ends[1].max(high)];
                }
            }
        }
    }
    Ok(range_of(ends))
}
