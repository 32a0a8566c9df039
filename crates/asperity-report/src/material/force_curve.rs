//! A force curve and the model fitted to it.

use asperity::force_curve::ForceFit;
use asperity_io::choice;
use asperity_io::curve::ForceTable;

use crate::figure::{Axis, Curves, Figure, Series, Style};

/// Load over depth from first touch, without the baseline: record and model of the fitted rows.
pub fn force_curve(title: &str, table: &ForceTable, fit: &ForceFit) -> Figure {
    let (touch, baseline) = (fit.touch.value, fit.baseline.value);
    let pick = |column: &[f64], zero: f64| -> Vec<f64> {
        fit.rows.iter().filter_map(|row| column.get(*row).map(|x| x - zero)).collect()
    };
    let depths = pick(&table.depths, touch);
    let loads = pick(&table.loads, baseline);
    let model: Vec<f64> = fit.predicted.iter().map(|w| w - baseline).collect();
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
