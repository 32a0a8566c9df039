//! `asperity material show FILE` of measured data: what is found in a file, before anything is fitted.

use std::path::Path;

use asperity::material::Modulus;
use asperity_io::curve::{Curves, Kind, Sweep};
use asperity_report::material as pictures;
use serde_json::{Value, json};

use super::{celsius, law, options};
use crate::args::Show;
use crate::failure::{Failure, refuse};
use crate::format::{counted, extent, quantity};

/// Whether a file is one of measured data, not a case or a material.
pub fn is_data(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_none_or(|ending| ending != "toml")
}

/// Prints, and draws, what the file holds.
pub fn show(args: &Show) -> Result<(), Failure> {
    if args.from.is_some() || args.to.is_some() || !args.set.is_empty() {
        let path = args.file.display();
        refuse!("{path} holds measured data: --from, --to and --set are for materials");
    }
    let curves = options::curves(&args.file, &args.table)?;
    if let Some(path) = &args.plot {
        let figure = pictures::isotherms(&crate::commands::title(&args.file), &curves);
        crate::commands::picture::write(&figure, path, args.force)?;
    }
    let text = if args.json { format!("{}\n", object(&curves)) } else { text(&curves) };
    crate::print(&text)
}

fn text(curves: &Curves) -> String {
    let sheet = curves.sheet.as_ref().map_or(String::new(), |name| format!(", sheet \"{name}\""));
    let kind = match curves.kind {
        Kind::Relaxation => "relaxation modulus over time",
        Kind::Creep => "creep compliance over time",
        Kind::Dma => "storage and loss modulus over frequency",
    };
    let measure = match curves.measure {
        Some(Modulus::Young) => "Young's (E)",
        Some(Modulus::Shear) => "shear (G)",
        None => "not stated: Young's unless --modulus shear says otherwise",
    };
    let mut text = format!("{}{sheet}: {} ({kind})\n\n", curves.path.display(), curves.kind.name());
    for place in &curves.columns {
        text += &format!(
            "  column {:<3} {:<22} {:<20} [{}]\n",
            place.column,
            format!("\"{}\"", place.header),
            place.role.name(),
            place.unit
        );
    }
    if !curves.unused.is_empty() {
        text += &format!("  not used: {}\n", curves.unused.join(", "));
    }
    text += &format!("  modulus: {measure}\n\n");
    let names: &[&str] = match curves.kind {
        Kind::Relaxation => &["modulus"],
        Kind::Creep => &["compliance"],
        Kind::Dma => &["storage", "loss"],
    };
    if curves.is_over_temperature() {
        let rows = counted(curves.sweeps.len(), "temperature");
        text += &format!(
            "  a temperature ramp, {}: {rows}, {}, {}\n",
            curves.temperatures(),
            counted(curves.points(), "point"),
            frequencies(curves)
        );
    }
    for sweep in curves.sweeps.iter().filter(|_| !curves.is_over_temperature()) {
        let at = sweep.temperature.map_or(String::new(), |kelvin| format!("{:7.1} °C: ", celsius(kelvin)));
        text += &format!("  {at}{}", counted(sweep.x.len(), "point"));
        text += &format!(", {}", range(&abscissae(curves.kind, sweep), abscissa_unit(curves.kind)));
        for (name, curve) in names.iter().zip(&sweep.curves) {
            let unit = if curves.kind == Kind::Creep { "1/Pa" } else { "Pa" };
            text += &format!(", {name} {}", range(curve, unit));
        }
        text.push('\n');
    }
    for (name, shift) in [("list", &curves.held.list), ("constants", &curves.held.wlf)] {
        if let Some(shift) = shift {
            text += &format!("\n  shift of the file ({name}): {}\n", law(shift));
        }
    }
    curves.notes.iter().for_each(|note| text += &format!("\n  note: {note}\n"));
    text
}

/// "1 Hz", or the ends of several.
fn frequencies(curves: &Curves) -> String {
    let all: Vec<f64> = curves.sweeps.iter().flat_map(|sweep| abscissae(curves.kind, sweep)).collect();
    let [least, most] = extent(all.iter().copied()).map(|end| quantity(end, "Hz"));
    if least == most { least } else { format!("{least} to {most}") }
}

fn abscissa_unit(kind: Kind) -> &'static str {
    if kind == Kind::Dma { "Hz" } else { "s" }
}

/// Times, or frequencies in Hz.
fn abscissae(kind: Kind, sweep: &Sweep) -> Vec<f64> {
    let scale = if kind == Kind::Dma { std::f64::consts::TAU } else { 1.0 };
    sweep.x.iter().map(|x| x / scale).collect()
}

fn range(values: &[f64], unit: &str) -> String {
    let [least, most] = extent(values.iter().copied()).map(|end| quantity(end, unit));
    format!("{least} to {most}")
}

fn object(curves: &Curves) -> Value {
    let columns: Vec<Value> = curves
        .columns
        .iter()
        .map(|p| json!({ "quantity": p.role.name(), "column": p.column, "header": p.header, "unit": p.unit }))
        .collect();
    let sweeps: Vec<Value> = curves
        .sweeps
        .iter()
        .map(|sweep| json!({ "temperature": sweep.temperature, "x": sweep.x, "curves": sweep.curves }))
        .collect();
    json!({
        "kind": curves.kind.name(),
        "modulus": curves.measure,
        "sheet": curves.sheet,
        "columns": columns,
        "unused": curves.unused,
        "sweeps": sweeps,
        "shift_list": curves.held.list.as_ref().map(law),
        "shift_law": curves.held.wlf.as_ref().map(law),
        "notes": curves.notes,
    })
}
