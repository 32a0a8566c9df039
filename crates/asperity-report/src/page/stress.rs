//! The stress below the surface on a page: its largest values over time, and the picture of the time with the largest.

use asperity_io::readable::quantity;
use asperity_io::store::{Reader, StoreError};
use asperity_io::stress::{Below, StressError, first_yield};
use serde_json::{Value, json};

use crate::result::{PlotError, stress_figure};

/// Largest values over time; null where no stress was computed.
pub(super) fn curves(reader: &Reader) -> Result<Value, StoreError> {
    let Some(below) = Below::of(reader)? else { return Ok(Value::Null) };
    let over = |name: &str| {
        below.instants.iter().map(|instant| json!(below.number(instant, name))).collect::<Value>()
    };
    Ok(json!({
        "facts": facts(&below),
        "time": below.instants.iter().map(|instant| instant.time).collect::<Vec<f64>>(),
        "mises": over("max_mises"),
        "tresca": over("max_tresca"),
        "tension": over("max_tension"),
    }))
}

/// What was found, in words.
fn facts(below: &Below) -> Vec<[String; 2]> {
    let set = &below.set;
    let mut lines = vec![["Body".to_owned(), format!("{}, Poisson's ratio {}", set.body, set.poisson)]];
    let Some(worst) = below.worst() else { return lines };
    for (name, key) in
        [("von Mises", "max_mises"), ("shear (Tresca)", "max_tresca"), ("principal", "max_tension")]
    {
        let [value, depth] = [key.to_owned(), format!("{key}_depth")].map(|name| below.number(worst, &name));
        if depth.is_finite() {
            let at = format!("{} = {}", below.axis.symbol(), quantity(worst.time, below.axis.unit()));
            let words = format!("{} at depth {}, {at}", quantity(value, "Pa"), quantity(depth, "m"));
            lines.push([format!("Largest {name} stress"), words]);
        }
    }
    if let Some(threshold) = set.threshold {
        let volume = quantity(below.number(worst, "stressed_volume"), if set.line { "m2" } else { "m3" });
        let what = if set.line { "Area of the section" } else { "Volume" };
        lines.push([format!("{what} with a von Mises stress above {}", quantity(threshold, "Pa")), volume]);
    }
    if set.rolling.is_some() {
        let range = quantity(below.number(worst, "orthogonal_shear"), "Pa");
        lines.push(["Range of the orthogonal shear stress".into(), range]);
    }
    if let (Some(limit), Some(first)) = (set.yield_stress, first_yield(below)) {
        lines.push([format!("Yield stress {}", quantity(limit, "Pa")), first.sentence(below)]);
    }
    lines
}

/// The figure of the time with the largest von Mises stress, as SVG; `None` where there is no stress or no contact.
pub(super) fn picture(reader: &Reader) -> Result<Option<String>, StoreError> {
    let Some(below) = Below::of(reader)? else { return Ok(None) };
    let Some(worst) = below.worst() else { return Ok(None) };
    match stress_figure(reader, &below, worst.index) {
        Ok(figure) => Ok(Some(figure.to_svg())),
        // Where nothing touches there is nothing to draw.
        Err(PlotError::Stress(StressError::NoContact { .. })) => Ok(None),
        Err(PlotError::Store(error) | PlotError::Stress(StressError::Store(error))) => Err(error),
        Err(_) => Ok(None),
    }
}
