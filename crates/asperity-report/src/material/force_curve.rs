//! A force curve and the model fitted to it.

use asperity::force_curve::ForceFit;
use asperity_io::choice;
use asperity_io::curve::ForceTable;

use crate::figure::{Axis, Curves, Figure, Series, Style};

/// Load over depth from first touch, without the baseline: record and model of the fitted rows.
pub fn force_curve(title: &str, table: &ForceTable, fit: &ForceFit) -> Figure {
    let pick = |column: &[f64]| -> Vec<f64> {
        fit.rows.iter().filter_map(|row| column.get(*row).copied()).collect()
    };
    let depths: Vec<f64> = pick(&table.depths).iter().map(|depth| depth - fit.touch.value).collect();
    let pressed = |loads: &[f64]| -> Vec<f64> {
        let line = |depth: &f64| fit.baseline.value + fit.tilt.value * depth;
        loads.iter().zip(&depths).map(|(load, depth)| load - line(depth)).collect()
    };
    let (loads, model) = (pressed(&pick(&table.loads)), pressed(&fit.predicted));
    let over_depth = Curves::new("Load over depth", Axis::linear("depth", "m"), Axis::linear("load", "N"))
        .with(Series::new("measured", Style::Points, &depths, loads))
        .with(Series::new("model", Style::Line, &depths, model));
    let caption = format!(
        "Model {}; misfit {:.2} % of the range (rms).",
        choice::word(&fit.model),
        100.0 * fit.relative_rms
    );
    Figure::new(title).with(over_depth).caption(caption)
}
