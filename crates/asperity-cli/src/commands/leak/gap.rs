//! Leakage of a map of the gap.

use std::path::Path;

use asperity::finding::LeakDiagnostics;
use asperity::{Boundary, Grid};
use asperity_io::answer::{MBAR_LITRE, Units, Validity};
use asperity_io::case::leak as checked;
use asperity_io::finding;
use asperity_io::leakage::{Fluid, Leakage};
use ndarray::Array2;
use serde_json::{Value, json};

use super::options;
use crate::args::{self, SurfaceFile};
use crate::failure::Failure;
use crate::format::quantity;
use crate::input::with_options;

/// Computes the leakage of one state and prints it.
pub fn run(args: &args::Leak, path: &Path) -> Result<(), Failure> {
    let file = |path: &Path, height_unit: Option<String>| SurfaceFile {
        file: path.to_owned(),
        size: args.size.clone(),
        height_unit,
        channel: None,
    };
    let gap = super::super::surface::open(&file(path, args.height_unit.clone()))?;
    let contact = match &args.contact {
        Some(path) => {
            let map = super::super::surface::open(&file(path, Some("m".into())))?;
            Some(map.heights.mapv(|contact| u8::from(contact > 0.0)))
        }
        None => None,
    };
    warn_of_heights(path, &gap.heights);
    let units = crate::commands::answers::units(&args.unit)?;
    if let Some(unit) = units.text("time") {
        crate::messages::message!("note: --unit time={unit} changes nothing: a map of the gap has no time");
    }
    let leak = checked(&options::keys(&args.fluid), Boundary::Periodic)
        .map_err(|message| Failure::Input(with_options(&message)))?;
    let rates: &[&str] = match leak.fluid {
        None => &[],
        Some(Fluid::Liquid { .. }) => &["m3/s"],
        Some(Fluid::Gas { .. }) => &["kg/s", "Pa m3/s"],
    };
    super::check(&units, rates)?;
    let (nx, ny) = gap.heights.dim();
    let grid = Grid::new([nx, ny], gap.size).map_err(Failure::about(path.display()))?;
    let contact = contact.as_ref().map(|contact| contact.view());
    let state = leak.of_gap(&grid, gap.heights.view(), contact, 0.0).map_err(|error| match error {
        asperity::Error::Invalid { .. } => Failure::about(path.display())(error),
        error => Failure::Solve(error.to_string()),
    })?;
    let mut diagnostics = LeakDiagnostics::default();
    let resolved = diagnostics.see(&state.alone());
    let findings = diagnostics.findings();
    let validity = Validity::of("leak_rate", findings.iter());
    if let Some(plot) = &args.plot {
        let figure = asperity_report::leak::state(&leak, &state, &validity, gap.heights.view(), grid.size());
        crate::commands::picture::write(&figure, plot, args.force)?;
    }
    super::super::findings::print(&findings);
    let text = if args.json {
        let mut object = object(&state);
        object["leakage"] = serde_json::to_value(&leak).unwrap_or_default();
        object["leak_resolved"] = json!(resolved);
        object["findings"] = finding::list(&findings);
        if let (Some(all), Value::Object(marks)) = (object.as_object_mut(), json!(validity)) {
            all.extend(marks);
        }
        format!("{object}\n")
    } else {
        format!("Leakage of {}\n\n{}", leak.words(), text(&state, &validity, &units))
    };
    crate::print(&text)
}

/// Warns of a map whose numbers are heights, above and below their mean, and not the gap between two surfaces.
fn warn_of_heights(path: &Path, map: &Array2<f64>) {
    /// A gap may be negative in a few cells, by rounding or where the bodies overlap.
    const MOST: f64 = 0.2;
    let share = map.iter().filter(|gap| **gap < 0.0).count() as f64 / map.len() as f64;
    if share > MOST {
        crate::messages::message!(
            "warning: {:.0} % of the cells of {} are below 0 and count as closed: these look like heights of a surface, not like a gap; \
             the gap is the distance of the surfaces, 0 or more",
            100.0 * share,
            path.display()
        );
    }
}

/// Numbers that are not finite become null.
fn object(state: &Leakage) -> Value {
    json!({
        "percolates": state.percolates,
        "hydraulic_gap": state.hydraulic_gap,
        "critical_gap": state.critical_gap,
        "critical_x": state.critical[0],
        "critical_y": state.critical[1],
        "critical_width": state.critical_width,
        "medium_gap": state.medium_gap,
        "open_fraction": state.open_fraction,
        "trapped_area": state.trapped_area,
        "trapped_volume": state.trapped_volume,
        "conductance": state.conductance,
        "leak_rate": state.leak_rate,
        "leak_rate_standard": state.leak_rate_standard,
        "leak_estimate_junction": state.leak_estimate_junction,
        "leak_estimate_medium": state.leak_estimate_medium,
        "knudsen_number": state.knudsen,
    })
}

fn text(state: &Leakage, validity: &Validity, units: &Units) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<22}{value}\n");
    if state.percolates {
        line("hydraulic gap", validity.mark(quantity(state.hydraulic_gap, "m")));
        let width = state.critical_width.map_or(String::new(), |cells| format!(", {cells} cells wide"));
        let place =
            format!("at ({}, {})", quantity(state.critical[0], "m"), quantity(state.critical[1], "m"));
        line("critical gap", format!("{} {place}{width}", quantity(state.critical_gap, "m")));
    } else {
        line("seal", validity.mark("tight: inlet and outlet are not connected".into()));
    }
    line("effective medium", quantity(state.medium_gap, "m"));
    line("open", format!("{:.3} % of the cells", 100.0 * state.open_fraction));
    line(
        "pockets",
        format!("{}, {}", quantity(state.trapped_area, "m2"), quantity(state.trapped_volume, "m3")),
    );
    if let Some([[xx, xy], [yx, yy]]) = state.conductance {
        line("conductance [m3]", format!("xx {xx:.6e}, xy {xy:.6e}, yx {yx:.6e}, yy {yy:.6e}"));
    }
    if let Some(rate) = state.leak_rate {
        // Of a gas, mass and standard rate are in proportion.
        let per = state.leak_rate_standard.map(|standard| if rate == 0.0 { 0.0 } else { standard / rate });
        let one = |rate: f64| match state.leak_rate_standard {
            _ if units.text("leak").is_some() => units.rate(rate, per.map(|per| per * rate)),
            Some(_) => format!("{rate:.4e} kg/s"),
            None => format!("{rate:.4e} m3/s"),
        };
        line("leak rate", validity.mark(one(rate)));
        if let (Some(standard), None) = (state.leak_rate_standard, units.text("leak")) {
            let mbar = MBAR_LITRE * standard;
            line("", format!("{standard:.4e} Pa m3/s at 0 degC, {mbar:.4e} mbar l/s"));
        }
        line("  by one junction", one(state.leak_estimate_junction.unwrap_or(f64::NAN)));
        line("  by the medium", one(state.leak_estimate_medium.unwrap_or(f64::NAN)));
    }
    if let Some(knudsen) = state.knudsen.filter(|knudsen| knudsen.is_finite()) {
        line("Knudsen number", format!("{knudsen:.3} at the constriction"));
    }
    text
}
